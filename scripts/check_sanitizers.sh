#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the tests that need no device with the address and undefined-behaviour sanitizers and runs
# them; arguments go to ctest, e.g. -R Json. Any fault that a sanitizer finds fails its test.
# CTEST_PARALLEL_LEVEL is the number of tests at a time.
set -euo pipefail

script_name=check_sanitizers
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/lib/messages.sh
source "$root/scripts/lib/messages.sh"

# Those of SHUTTER_SANITIZED_LABELS in tests/CMakeLists.txt.
labels='^(unit|graph|robustness)$'

usage() {
    cat <<'TEXT'
usage: scripts/check_sanitizers.sh [CTEST OPTION...]
Builds and runs the tests that need no device in build/asan. Exit status: 0 all pass, otherwise not.
scripts/setup.sh --with-tests installs what the build needs.
TEXT
}

main() {
    if [[ ${1:-} == -h || ${1:-} == --help ]]; then
        usage
        return
    fi
    cd "$root"
    cmake --preset asan
    # Halting makes a fault of undefined behaviour end the test; by itself it is only printed. CMake
    # runs each test program after it is linked, to ask for its cases.
    export ASAN_OPTIONS=detect_stack_use_after_return=1:check_initialization_order=1${ASAN_OPTIONS:+:$ASAN_OPTIONS}
    export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1${UBSAN_OPTIONS:+:$UBSAN_OPTIONS}
    cmake --build --preset asan --target sanitized_tests
    ctest --preset asan -L "$labels" -j "${CTEST_PARALLEL_LEVEL:-2}" "$@"
    say "the tests that need no device pass with the sanitizers"
}

main "$@"
