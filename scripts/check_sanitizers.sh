#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the tests that need no device with the address and undefined-behaviour sanitizers and runs
# them. Any fault that a sanitizer finds fails its test. CTEST_PARALLEL_LEVEL is the number of tests at
# a time.
set -euo pipefail

script_name=check_sanitizers
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/lib/messages.sh
source "$root/scripts/lib/messages.sh"

# Those of SHUTTER_SANITIZED_LABELS in tests/CMakeLists.txt.
labels='^(unit|graph|robustness)$'

# The programs of the short run: what reads files, keeps memory or sorts passes.
short=(test_graph test_unit_{core,ecs,flythrough,gltf,image,io,json,math,scene})

usage() {
    cat <<'TEXT'
usage: scripts/check_sanitizers.sh [--short | CTEST OPTION...]
  --short   only the programs of the rooms that read files, keep memory or sort passes: some five
            minutes on two cores, where all take an hour
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
    if [[ ${1:-} == --short ]]; then
        cmake --build --preset asan --target "${short[@]}"
        run_short
    else
        cmake --build --preset asan --target sanitized_tests
        ctest --preset asan -L "$labels" -j "${CTEST_PARALLEL_LEVEL:-2}" "$@"
        say "the tests that need no device pass with the sanitizers"
    fi
}

# Each program as a whole: a process for each of its cases would take minutes to start them.
run_short() {
    local program
    for program in "${short[@]}"; do
        say "$program"
        (cd build/asan && "./$program" --gtest_brief=1)
    done
    say "${#short[@]} test programs pass with the sanitizers"
}

main "$@"
