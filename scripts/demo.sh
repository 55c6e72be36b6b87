#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Sets up, renders the generated scenes with every method, the pictures to compare first, and measures
# each against `accumulate`. Prints what each step took and what is left.
set -euo pipefail

script_name=demo
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/lib/messages.sh
source "$root/scripts/lib/messages.sh"

scenes=(build/release/assets/vase.glb build/release/assets/courtyard.glb)
reference=accumulate
shutter=build/release/shutter
out=build/demo
size=1280x720
first=(resolved sharp accumulate jimenez2014) # the default, no blur, the truth, a filter that engines ship
failed=()
begun=0 drawn=0 total=0

usage() {
    cat <<TEXT
usage: scripts/demo.sh [--size WxH] [RENDER OPTION ...]
  --size WxH      size of the pictures (default $size)
  RENDER OPTION   anything else goes to \`shutter render\`, e.g. --device 1 --seed 7
The pictures and their statistics are left in $out.
TEXT
}

# Renders scene $1 with method $2 and the options that follow.
render() {
    local scene=$1 method=$2 stem rays=()
    shift 2
    # Its 256 take minutes on a software device; 16 show what it is.
    [[ $method != truth ]] || rays=(--samples 16)
    stem=$out/$(basename "$scene" .glb)_$method
    drawn=$((drawn + 1))
    say "picture $drawn of $total: $(basename "$scene"), method $method$(describe_time_left)"
    # What an earlier run left must not be taken for this run's.
    rm -f "$stem.png" "$stem.json"
    local start=$SECONDS
    "$shutter" render "$scene" --method "$method" --size "$size" --out "$stem.png" \
        --stats "$stem.json" "${rays[@]}" "$@" || return
    say "$root/$stem.png after $((SECONDS - start)) s"
}

# Prints the methods that follow, those of `first` before the others.
list_methods() {
    local method other
    for method in "${first[@]}"; do
        for other in "$@"; do
            [[ $method != "$other" ]] || printf '%s\n' "$method"
        done
    done
    for method in "$@"; do
        [[ " ${first[*]} " == *" $method "* ]] || printf '%s\n' "$method"
    done
}

# What pictures take differs by method, so this is known about.
describe_time_left() {
    ((drawn > 2)) || return 0
    local left=$(((SECONDS - begun) * (total - drawn + 1) / (drawn - 1)))
    printf ' (about %d:%02d min left)' $((left / 60)) $((left % 60))
}

# Draws scene $1 with the method that $2 names and the options that follow, and goes on where it fails.
try() {
    render "$@" || failed+=("$(basename "$1" .glb) $2")
}

# Compares every picture of scene $1 that was rendered with the reference's.
compare_methods() {
    local stem method
    stem=$out/$(basename "$1" .glb)
    shift
    [[ -e ${stem}_$reference.png ]] || return 0
    for method in "$@"; do
        if [[ $method != "$reference" && -e ${stem}_$method.png ]]; then
            printf '\n%s against %s:\n' "${stem}_$method.png" "$reference"
            "$shutter" compare "${stem}_$method.png" "${stem}_$reference.png" ||
                failed+=("compare ${stem##*/} $method")
        fi
    done
}

main() {
    local extra=() methods scene method list
    while (($#)); do
        case $1 in
            --size)
                (($# > 1)) || die_of_usage "--size needs a value such as 1280x720"
                size=$2
                shift
                ;;
            --size=*) size=${1#--size=} ;;
            -h | --help)
                usage
                exit 0
                ;;
            *) extra+=("$1") ;;
        esac
        shift
    done
    [[ $size =~ ^[1-9][0-9]*x[1-9][0-9]*$ ]] || die_of_usage "--size $size is not WIDTHxHEIGHT"
    say "step 1 of 3: setup and build, up to 12 minutes on two cores the first time"
    begun=$SECONDS
    "$root/scripts/setup.sh"
    say "setup and build took $((SECONDS - begun)) s"
    cd "$root"
    mkdir -p "$out"
    mapfile -t methods < <("$shutter" info --methods)
    ((${#methods[@]})) || die "\`$shutter info --methods\` names no method"
    for scene in "${scenes[@]}"; do
        [[ -e $scene ]] || die "$scene is missing although the build went through"
    done
    mapfile -t methods < <(list_methods "${methods[@]}")
    total=$((${#scenes[@]} * ${#methods[@]}))
    say "step 2 of 3: $total pictures, some 3 minutes on two idle cores at 1280x720"
    begun=$SECONDS
    for scene in "${scenes[@]}"; do
        for method in "${methods[@]}"; do
            try "$scene" "$method" "${extra[@]}"
        done
    done
    say "step 3 of 3: PSNR, SSIM and FLIP of each against $reference, some seconds"
    for scene in "${scenes[@]}"; do
        compare_methods "$scene" "${methods[@]}"
    done
    printf '\n'
    say "the pictures are in $root/$out:"
    ls "$out"
    if ((${#failed[@]})); then
        printf -v list '%s, ' "${failed[@]}"
        die "failed: ${list%, }"
    fi
}

main "$@"
