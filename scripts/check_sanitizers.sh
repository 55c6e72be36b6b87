#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds tests with sanitizers and runs them. Any fault that a sanitizer finds fails its test.
# CTEST_PARALLEL_LEVEL is the number of tests at a time.
set -euo pipefail

script_name=check_sanitizers
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/lib/messages.sh
source "$root/scripts/lib/messages.sh"
# shellcheck source=scripts/lib/lavapipe.sh
source "$root/scripts/lib/lavapipe.sh"
# shellcheck source=scripts/lib/llvm_tools.sh
source "$root/scripts/lib/llvm_tools.sh"

# Those of SHUTTER_SANITIZED_LABELS in tests/CMakeLists.txt.
labels='^(unit|graph|robustness)$'
# Those that draw, by linking to what they test or by running the program.
drawing_labels='^(gpu|image|stability)$'
program_labels='^cli$'
# Loaders close it before leaks are searched, and what it allocated has no names then.
validation_layer=libVkLayer_khronos_validation.so

# The programs of the short run: what reads files, keeps memory or sorts passes.
short=(test_graph test_unit_{core,ecs,flythrough,gltf,image,io,json,math,scene})

usage() {
    cat <<'TEXT'
usage: scripts/check_sanitizers.sh [--short | --thread | --drawing] [CTEST OPTION...]
Builds and runs tests with sanitizers:
  (nothing)  those that need no device, with the address and undefined-behaviour sanitizers, in
             build/asan: an hour on two cores
  --short    only the programs of the rooms that read files, keep memory or sort passes: some five
             minutes; where there is a clang++ with libFuzzer, in build/fuzz, which
             scripts/check_fuzzers.sh builds too, otherwise in build/asan
  --drawing  those that draw, on lavapipe, with the same sanitizers: hours. Leaks are reported at the
             end of each program, except for what tests/sanitizers/leaks.txt explains; not of
             those that run the program (cli)
  --thread   those that need no device, with the thread sanitizer, in build/tsan. Those that draw are
             left out: the driver's threads and the code that it compiles are unknown to the sanitizer
Exit status: 0 all pass, otherwise not. scripts/setup.sh --with-tests installs what the build needs.
TEXT
}

# Builds the target with the preset and runs its tests. PRESET TARGET LABELS CTEST-OPTION...
run_tests() {
    local preset=$1 target=$2 wanted=$3
    shift 3
    cmake --build --preset "$preset" --target "$target"
    ctest --preset "$preset" -L "$wanted" -j "${CTEST_PARALLEL_LEVEL:-2}" "$@"
}

# Each program as a whole: a process for each of its cases would take minutes to start them.
run_short() {
    local program clang preset=asan
    clang=$(find_fuzzing_clang)
    if [[ -n $clang ]]; then
        # What the programs and the fuzzers share is then compiled once.
        preset=fuzz
        cmake --preset fuzz -DCMAKE_CXX_COMPILER="$clang" >/dev/null
    else
        cmake --preset asan
    fi
    cmake --build "build/$preset" --target "${short[@]}"
    for program in "${short[@]}"; do
        say "$program"
        (cd "build/$preset" && "./$program" --gtest_brief=1)
    done
    say "${#short[@]} test programs pass with the sanitizers"
}

main() {
    local mode=${1:-}
    case $mode in
    -h | --help)
        usage
        return
        ;;
    --short | --thread | --drawing) shift ;;
    *) mode= ;;
    esac
    cd "$root"
    # Halting makes a fault of undefined behaviour end the test; by itself it is only printed. CMake
    # runs each test program after it is linked, to ask for its cases.
    export ASAN_OPTIONS=detect_stack_use_after_return=1:check_initialization_order=1${ASAN_OPTIONS:+:$ASAN_OPTIONS}
    export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1${UBSAN_OPTIONS:+:$UBSAN_OPTIONS}
    export LSAN_OPTIONS=suppressions=$root/tests/sanitizers/leaks.txt:print_suppressions=0${LSAN_OPTIONS:+:$LSAN_OPTIONS}
    if [[ $mode == --thread ]]; then
        cmake --preset tsan
        run_tests tsan sanitized_tests "$labels" "$@"
        say "the tests that need no device pass with the thread sanitizer"
        return
    fi
    if [[ $mode == --short ]]; then
        run_short
        return
    fi
    cmake --preset asan
    case $mode in
    --drawing)
        force_lavapipe
        # For the tests alone: what the build runs has no sanitizer, and needs none.
        cmake --build --preset asan
        LD_PRELOAD="$(gcc -print-file-name=libasan.so) $validation_layer" \
            ctest --preset asan -L "$drawing_labels" -j "${CTEST_PARALLEL_LEVEL:-2}" "$@"
        # Programs that these tests run, ffmpeg for one, are not built with the sanitizer.
        ASAN_OPTIONS+=:detect_leaks=0 run_tests asan all "$program_labels" "$@"
        say "the tests that draw pass with the sanitizers"
        ;;
    *)
        run_tests asan sanitized_tests "$labels" "$@"
        say "the tests that need no device pass with the sanitizers"
        ;;
    esac
}

main "$@"
