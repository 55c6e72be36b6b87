# shellcheck shell=bash
# SPDX-License-Identifier: MIT
# Finds LLVM's tools: clang-format and clang-tidy in the one version that judges this tree, since
# other versions format differently and know other checks, and any clang++ that can fuzz. Needs
# messages.sh.

llvm_version=14

# What the checks exit with where their tool is missing: neither passed nor failed.
not_checked=77

# Prints the command that runs tool $1 (clang-format, clang-tidy) in that version. If there is none,
# prints the available ones and exits with status $not_checked.
require_llvm_tool() {
    local name=$1 candidate version found='is not installed'
    for candidate in "$name-$llvm_version" "$name"; do
        command -v "$candidate" >/dev/null || continue
        version=$("$candidate" --version | sed -nE 's/.*version ([0-9]+)\..*/\1/p')
        if [[ $version == "$llvm_version" ]]; then
            printf '%s\n' "$candidate"
            return
        fi
        found="is installed in version $version only"
    done
    say "skipped: the tree is held to $name $llvm_version; here $name $found" >&2
    exit "$not_checked"
}

# Prints a clang++ that has libFuzzer and the sanitizers; nothing where there is none.
find_fuzzing_clang() {
    local clang empty='extern "C" int LLVMFuzzerTestOneInput(const unsigned char*, unsigned long) { return 0; }'
    for clang in clang++ "clang++-$llvm_version"; do # the preset's first
        if command -v "$clang" >/dev/null &&
            "$clang" -x c++ -fsanitize=fuzzer,address - -o /dev/null <<<"$empty" 2>/dev/null; then
            printf '%s\n' "$clang"
            return
        fi
    done
}

# Prints the C++ files of the repository, one per line: those that git knows or would take up.
list_cpp_files() {
    local file
    git ls-files --cached --others --exclude-standard '*.cpp' '*.h' '*.hpp' | while read -r file; do
        [[ ! -e $file ]] || printf '%s\n' "$file"
    done
}
