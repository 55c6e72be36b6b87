#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Feeds the readers of files with damaged ones, by libFuzzer, under the address and undefined-behaviour
# sanitizers. A crash, an input that takes over 5 seconds and a report of a sanitizer are failures; the
# input that failed is kept.
set -euo pipefail

script_name=check_fuzzers
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/lib/messages.sh
source "$root/scripts/lib/messages.sh"
# shellcheck source=scripts/lib/llvm_tools.sh
source "$root/scripts/lib/llvm_tools.sh"

build=$root/build/fuzz
failed_folder=$build/failed

# What a run takes of each reader, in thousands of inputs: the short one, and the long one, a million
# together. Readers that are quick or that have more to get wrong take more.
readers=(
    'uri 20 120' 'gltf 4 100' 'texture 3 50' 'image 2 40' 'environment 2 50' 'flythrough 8 130' 'input_script 5 120'
    'settings 5 120' 'pipeline_cache 10 60' 'sequence_journal 2 60' 'bench_journal 5 90'
    'dump 5 60'
)

usage() {
    cat <<'TEXT'
usage: scripts/check_fuzzers.sh [--short | --runs N] [READER...]
  --short   a fixed number of inputs from a fixed seed, less than a minute after the build
  --runs N  N inputs for each reader
Without either: a million inputs over all readers, some ten minutes, from a new seed that is printed.
READER is one of those that tests/fuzz holds a file for; without any: all. Builds in build/fuzz. Exit
status: 0 no reader failed, 1 one did, 77 not checked because there is no clang++ with libFuzzer.
FUZZ_BUILD_JOBS is the number of files compiled at a time.
TEXT
}

# Copies what reader $1 begins with to folder $2: the seeds of the tree and, where they exist,
# damaged scenes with the files that they name.
gather_seeds() {
    local seeds=$root/tests/fuzz/seeds/$1 shared=$root/../shared/gltf-malformed
    [[ ! -d $seeds ]] || cp "$seeds"/* "$2"
    [[ $1 == gltf ]] || return 0
    if [[ ! -d $shared ]]; then
        say "gltf: ../shared/gltf-malformed is missing, only the seeds of the tree are used"
        return
    fi
    find "$shared" \( -name '*.gltf' -o -name '*.glb' \) -size -64k -print0 |
        while IFS= read -r -d '' file; do
            cp "$file" "$2/$(sha1sum <"$file" | cut -c1-16)"
        done
    find "$shared" \( -name '*.bin' -o -name '*.png' -o -name '*.jpg' \) -size -64k \
        -exec cp {} "$2/.." \;
}

# Runs reader $1 for $2 inputs from seed $3.
fuzz() {
    local reader=$1 runs=$2 seed=$3 log=$work/log status=0 largest=4096
    [[ $reader != gltf && $reader != dump ]] || largest=32768
    rm -rf "$work/run"
    mkdir -p "$work/run/corpus"
    gather_seeds "$reader" "$work/run/corpus"
    # The readers write next to their input and print their verdict.
    (
        cd "$work/run"
        "$build/fuzz_$reader" corpus -runs="$runs" -seed="$seed" -max_len="$largest" -timeout=5 \
            -rss_limit_mb=2048 -malloc_limit_mb=1024 -print_final_stats=1 \
            -artifact_prefix="$failed_folder/$reader-" >"$log" 2>&1
    ) || status=$?
    if ((status != 0)); then
        grep -vE '^#[0-9]+' "$log" | tail -n 60 >&2
        say "$reader FAILED (seed $seed); its input is in $failed_folder" >&2
        return 1
    fi
    say "$reader: $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") inputs," \
        "$(sed -n 's/^stat::average_exec_per_sec: *//p' "$log") a second," \
        "$(sed -n 's/^stat::peak_rss_mb: *//p' "$log") MB"
}

main() {
    local form=long runs='' row reader short long count seed=$RANDOM failed=0 targets=() clang
    while (($#)); do
        case $1 in
            --short) form=short ;;
            --runs)
                (($# > 1)) || die_of_usage "$1 needs a value"
                runs=$2
                shift
                ;;
            -h | --help)
                usage
                return
                ;;
            -*)
                usage >&2
                die_of_usage "unknown option $1"
                ;;
            *) break ;;
        esac
        shift
    done
    for reader in "$@"; do
        [[ -e $root/tests/fuzz/${reader}_fuzz.cpp ]] || die_of_usage "there is no reader '$reader'"
    done
    clang=$(find_fuzzing_clang)
    if [[ -z $clang ]]; then
        say "skipped: there is no clang++ with libFuzzer;" \
            "Debian has it in clang-$llvm_version and libclang-rt-$llvm_version-dev" >&2
        exit "$not_checked"
    fi
    cd "$root"
    cmake --preset fuzz -DCMAKE_CXX_COMPILER="$clang" >/dev/null
    for reader in "$@"; do
        targets+=("fuzz_$reader")
    done
    cmake --build "$build" --target "${targets[@]:-fuzzers}" -j "${FUZZ_BUILD_JOBS:-2}"
    export ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=0${ASAN_OPTIONS:+:$ASAN_OPTIONS}
    export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1${UBSAN_OPTIONS:+:$UBSAN_OPTIONS}
    mkdir -p "$failed_folder"
    work=$(mktemp -d "$([[ -w /dev/shm ]] && echo /dev/shm || echo /tmp)/shutter_fuzz_XXXXXX")
    trap 'rm -rf "$work"' EXIT
    [[ $form == long ]] || seed=1
    say "seed $seed"
    for row in "${readers[@]}"; do
        read -r reader short long <<<"$row"
        [[ $# -eq 0 || " $* " == *" $reader "* ]] || continue
        count=$((long * 1000))
        [[ $form == long ]] || count=$((short * 1000))
        fuzz "$reader" "${runs:-$count}" "$seed" || failed=1
    done
    ((failed == 0)) || die "a reader failed"
    say "no reader failed"
}

main "$@"
