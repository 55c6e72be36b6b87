#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks that the C++ files are formatted by .clang-format; with --fix, formats them.
set -euo pipefail

script_name=check_format
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/lib/messages.sh
source "$root/scripts/lib/messages.sh"
# shellcheck source=scripts/lib/llvm_tools.sh
source "$root/scripts/lib/llvm_tools.sh"

usage() {
    cat <<'TEXT'
usage: scripts/check_format.sh [--fix] [FILE...]
  --fix   format the files instead of naming them
Without FILE: all C++ files of the repository. Exit status: 0 formatted, 1 not, 77 not checked
because clang-format is not installed in the version that the tree is held to.
TEXT
}

main() {
    local fix=no files unformatted clang_format warnings
    while (($#)); do
        case $1 in
            --fix) fix=yes ;;
            -h | --help)
                usage
                exit 0
                ;;
            -*)
                usage >&2
                die_of_usage "unknown option $1"
                ;;
            *) break ;;
        esac
        shift
    done
    files=("$@")
    if ((${#files[@]} == 0)); then
        cd "$root"
        mapfile -t files < <(list_cpp_files)
    fi
    clang_format=$(require_llvm_tool clang-format)
    if [[ $fix == yes ]]; then
        "$clang_format" -i "${files[@]}"
        return
    fi
    warnings=$("$clang_format" --dry-run "${files[@]}" 2>&1) || die "$warnings"
    mapfile -t unformatted < <(
        sed -nE 's/^(.+):[0-9]+:[0-9]+: warning: code should be clang-formatted.*/\1/p' \
            <<<"$warnings" | sort -u
    )
    if ((${#unformatted[@]})); then
        printf '%s\n' "${unformatted[@]}" >&2
        die "${#unformatted[@]} of ${#files[@]} files are not formatted;" \
            "scripts/check_format.sh --fix formats them"
    fi
    say "${#files[@]} files are formatted"
}

main "$@"
