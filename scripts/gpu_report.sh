#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Measures the motion blur on a graphics card and writes one file to send: the card, milliseconds
# and megabytes of each pass at three sizes, validation messages, and how far the pictures are from
# those of Mesa's software device.
set -euo pipefail

script_name=gpu_report
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/lib/messages.sh
source "$root/scripts/lib/messages.sh"

# Shots of modules/motion_blur/gpu.md; of the one in the middle each pass has its row.
shots=(vase courtyard pan)
methods=(gather hybrid resolved)
sizes=(1920x1080 2560x1440 3840x2160)
repeat=20
software=llvmpipe
# The software device keeps a picture of 1080p and its intermediates in main memory.
software_mebibytes=2048
program=
scenes=
device=()
out=gpu_report.md
work=

usage() {
    cat <<TEXT
usage: scripts/gpu_report.sh [--out FILE.md] [--device NAME|INDEX] [--short]
  --out FILE.md     the report (default $out)
  --device D        a device of \`shutter info --devices\`; default: the one that \`render\` takes
  --short           small pictures and few repetitions: shows that all works, and measures nothing
  --program FILE    a built program, instead of setting up and building this tree's;
  --scenes FOLDER   then also where vase.glb and courtyard.glb are
It takes a few minutes on a card. The report names the card, its driver and the system's release, and
nothing else of the machine.
TEXT
}

# A file of the work folder that holds what failed, for shot $1, method or step $2 and size $3.
failure_file() { printf '%s/%s_%s_%s.error' "$work" "$1" "$2" "$3"; }

# Draws shot $1 with method $2 at size $3 into $4, with the options that follow. The program's
# messages go to the failure file, which remains on failure.
draw() {
    local shot=$1 method=$2 size=$3 picture=$4 said
    local options=(--unlit --exposure 0.016666667 --fps 30)
    shift 4
    case $shot in
        vase) options+=("$scenes/vase.glb") ;;
        courtyard) options+=("$scenes/courtyard.glb" --time 0.5) ;;
        pan) options+=("$scenes/courtyard.glb" --time 0.5 --camera pan) ;;
    esac
    said=$(failure_file "$shot" "$method" "$size")
    if "$program" render "${options[@]}" --method "$method" --size "$size" --out "$picture" \
        "${device[@]}" "$@" >"$said" 2>&1; then
        rm "$said"
    else
        say "$shot by $method at $size failed: $(tail -n 1 "$said")"
        return 1
    fi
}

measure_times() {
    local shot method size
    for size in "${sizes[@]}"; do
        for shot in "${shots[@]}"; do
            for method in "${methods[@]}"; do
                say "$shot by $method at $size"
                draw "$shot" "$method" "$size" "$work/picture.exr" --repeat "$repeat" \
                    --stats "$work/${shot}_${method}_$size.json" || true
            done
        done
        measure_blur "$size"
    done
}

# How long the smears are at size $1, pixels: the length of the motion's two channels.
measure_blur() {
    local size=$1
    draw courtyard gather "$size" "$work/blur.exr" --aov motion || return 0
    oiiotool "$work/blur.motion.exr" --ch motion.x,motion.y --dup --mul --chsum:weight=1,1 \
        --powc 0.5 --printstats >"$work/blur_$size.stats" 2>&1 || rm -f "$work/blur_$size.stats"
}

print_system() {
    printf '# Motion blur on a graphics card\n\n'
    printf 'Shutter %s, %s.\n\n' "$(git -C "$root" describe --always --dirty 2>/dev/null ||
        printf 'without a repository')" "$(uname -srm)"
    printf '## Devices\n\n```\n'
    "$program" info --devices 2>&1 || true
    printf '```\n\n'
}

print_validation() {
    local method said messages=
    printf '## Validation\n\n'
    for method in "${methods[@]}"; do
        draw courtyard "$method" "${sizes[0]}" "$work/picture.exr" --validate ||
            messages+="${method}: $(<"$(failure_file courtyard "$method" "${sizes[0]}")")"$'\n'
    done
    if [[ -n $messages ]]; then
        printf '```\n%s```\n\n' "$messages"
    else
        printf 'No message of core or synchronization validation in %s.\n\n' \
            "$(join_words "${methods[@]}")"
    fi
}

join_words() {
    local list
    printf -v list '%s, ' "$@"
    printf '%s' "${list%, }"
}

available_mebibytes() {
    awk '/^MemAvailable:/ { print int($2 / 1024) }' /proc/meminfo 2>/dev/null || printf '0\n'
}

print_pictures() {
    local method size=${sizes[0]} chosen=("${device[@]}") compared
    printf '## Pictures against those of %s\n\n' "$software"
    if ! "$program" info --devices 2>/dev/null | grep -q "$software"; then
        printf 'Left out: %s is not installed (package mesa-vulkan-drivers).\n\n' "$software"
        return
    fi
    if (($(available_mebibytes) < software_mebibytes)); then
        printf 'Left out: less than %s MiB of main memory are free.\n\n' "$software_mebibytes"
        return
    fi
    printf '| method | size | difference |\n|---|---|---|\n'
    for method in "${methods[@]}"; do
        device=("${chosen[@]}")
        draw courtyard "$method" "$size" "$work/card.png" || continue
        device=(--device "$software")
        draw courtyard "$method" "$size" "$work/software.png" || continue
        compared=$("$program" compare "$work/card.png" "$work/software.png" 2>&1) ||
            compared="compare failed: $compared"
        printf '| %s | %s | %s |\n' "$method" "$size" "$compared"
    done
    device=("${chosen[@]}")
    printf '\n'
}

write_report() {
    print_system
    python3 "$root/scripts/lib/gpu_report_tables.py" "$work" "${shots[@]}" -- "${methods[@]}" -- \
        "${sizes[@]}"
    print_validation
    print_pictures
}

read_arguments() {
    while (($#)); do
        case $1 in
            --out | --device | --program | --scenes)
                (($# > 1)) || die_of_usage "$1 needs a value"
                case $1 in
                    --out) out=$2 ;;
                    --device) device=(--device "$2") ;;
                    --program) program=$2 ;;
                    --scenes) scenes=$2 ;;
                esac
                shift
                ;;
            --short)
                sizes=(160x90 192x108 320x180)
                repeat=2
                ;;
            -h | --help)
                usage
                exit 0
                ;;
            *) die_of_usage "$1 is no option; --help lists them" ;;
        esac
        shift
    done
}

main() {
    local scene
    read_arguments "$@"
    if [[ -z $program ]]; then
        "$root/scripts/setup.sh"
        program=$root/build/release/shutter
        scenes=$root/build/release/assets
    fi
    [[ -x $program ]] || die "--program $program cannot be run"
    for scene in vase courtyard; do
        [[ -e $scenes/$scene.glb ]] || die "--scenes '$scenes' holds no $scene.glb"
    done
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
    measure_times
    write_report >"$work/report.md"
    mv "$work/report.md" "$out"
    say "the report is $out"
}

main "$@"
