#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Sets up, renders the generated scenes with every method and compares each with `accumulate`.
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
failed=()

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
    say "$(basename "$scene"), method $method"
    # What an earlier run left must not be taken for this run's.
    rm -f "$stem.png" "$stem.json"
    "$shutter" render "$scene" --method "$method" --size "$size" --out "$stem.png" \
        --stats "$stem.json" "${rays[@]}" "$@"
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
    "$root/scripts/setup.sh"
    cd "$root"
    mkdir -p "$out"
    mapfile -t methods < <("$shutter" info --methods)
    ((${#methods[@]})) || die "\`$shutter info --methods\` names no method"
    for scene in "${scenes[@]}"; do
        [[ -e $scene ]] || die "$scene is missing although the build went through"
        for method in "${methods[@]}"; do
            render "$scene" "$method" "${extra[@]}" || failed+=("$(basename "$scene" .glb) $method")
        done
    done
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
