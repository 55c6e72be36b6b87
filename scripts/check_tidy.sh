#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks the C++ files for the faults that .clang-tidy lists, compiled as the build folder compiles
# them.
set -euo pipefail

script_name=check_tidy
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/lib/messages.sh
source "$root/scripts/lib/messages.sh"
# shellcheck source=scripts/lib/llvm_tools.sh
source "$root/scripts/lib/llvm_tools.sh"

usage() {
    cat <<'TEXT'
usage: scripts/check_tidy.sh [--since REF] [--build FOLDER] [PATH...]
  --since REF      only files that differ from those of the git revision REF, and files that
                   include a header that does
  --build FOLDER   a build folder with compile_commands.json, built (default build/release)
PATH is a file or a folder, from the root of the repository; without any: all .cpp files. Exit
status: 0 no fault, 1 faults, 77 not checked because clang-tidy is not installed in the version that
the tree is held to.
TEXT
}

# Prints the .cpp files of the repository, one per line, except for the examples: the install test
# compiles them, this build does not.
list_sources() {
    list_cpp_files | grep '\.cpp$' | grep -v '^game/examples/'
}

# Prints those of them that lie in, or are, one of the paths that follow; without any, all.
list_sources_in() {
    local path
    (($#)) || set -- ''
    for path in "$@"; do
        if [[ -f $path ]]; then
            printf '%s\n' "$path"
        else
            list_sources | grep -- "^${path:+${path%/}/}" || die "there is no .cpp file in $path"
        fi
    done
}

# Prints those that differ from revision $1 or include a header that does.
list_sources_since() {
    local headers=() header
    # Two ways for a file to be meant, one sorted list.
    {
        list_changed_files "$1" | grep '\.cpp$' || true
        mapfile -t headers < <(list_changed_files "$1" | grep '\.h$')
        for header in "${headers[@]}"; do
            list_sources | xargs -d '\n' grep -lE \
                "#include \"(${header//./\\.}|${header##*/})\"" || true
        done
    } | sort -u
}

# Prints the C++ files that differ from revision $1.
list_changed_files() {
    comm -12 <(list_cpp_files | sort) <(
        {
            git diff --name-only "$1"
            git ls-files --others --exclude-standard
        } | sort
    )
}

# Checks file $1; prints the findings as a whole, so that files checked at the same time do not mix.
# The compiler's own warnings are g++'s to give.
check_file() {
    local found
    found=$("$clang_tidy" -p "$database" --config-file="$root/.clang-tidy" --quiet --extra-arg=-w \
        "$1" 2>&1) && return
    sed -E '/^[0-9]+ (warnings?|errors?)[a-z0-9 ]* generated\.$/d; /^Error while processing/d' \
        <<<"$found" >&2
    printf '%s\n' "$1"
}

main() {
    local since='' files faulty count
    build=build/release
    while (($#)); do
        case $1 in
            --since | --build)
                (($# > 1)) || die_of_usage "$1 needs a value"
                if [[ $1 == --since ]]; then since=$2; else build=$2; fi
                shift
                ;;
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
    [[ -z $since || $# -eq 0 ]] || die_of_usage "--since chooses the files itself"
    clang_tidy=$(require_llvm_tool clang-tidy)
    cd "$root"
    if [[ -n $since ]]; then
        git rev-parse --quiet --verify "$since^{commit}" >/dev/null ||
            die "$since is no revision of this repository"
        files=$(list_sources_since "$since")
    else
        files=$(list_sources_in "$@")
    fi
    mapfile -t files < <(printf '%s' "$files")
    if ((${#files[@]} == 0)); then
        say "no file to check"
        return
    fi
    [[ -e $build/compile_commands.json ]] ||
        die "$build is not configured; scripts/setup.sh --with-tests builds the checked files"
    database=$(mktemp -d)
    trap 'rm -rf "$database"' EXIT
    cp "$build/compile_commands.json" "$database/all.json"
    # Where several sources are compiled as one, a build that is only configured knows each one's
    # command; generated files are in the one that was built.
    if grep -q '/Unity/unity_' "$database/all.json"; then
        cmake --preset release -B "$database/plain" -DCMAKE_UNITY_BUILD=OFF >/dev/null
        sed "s#$database/plain/generated#$root/$build/generated#g" \
            "$database/plain/compile_commands.json" >"$database/all.json"
    fi
    # clang-tidy can read no header that GCC has precompiled: each file's own includes must do.
    sed -E 's/ -Winvalid-pch -include [^ ]+cmake_pch\.hxx//; s/ -fpch-preprocess//' \
        "$database/all.json" >"$database/compile_commands.json"
    export root database clang_tidy
    export -f check_file
    # The argument is the inner shell's to expand.
    # shellcheck disable=SC2016
    faulty=$(
        printf '%s\0' "${files[@]}" |
            xargs -0 -n 1 -P "$(nproc)" bash -c 'check_file "$1"' check_file
    )
    if [[ -n $faulty ]]; then
        count=$(wc -l <<<"$faulty")
        die "$count of ${#files[@]} files have faults: ${faulty//$'\n'/ }"
    fi
    say "${#files[@]} files have none of the faults that .clang-tidy lists"
}

main "$@"
