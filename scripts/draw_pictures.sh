#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Draws the pairs of pictures in docs/: a frame without anything, and blurred, lit and anti-aliased.
set -euo pipefail

script_name=draw_pictures
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/lib/messages.sh
source "$root/scripts/lib/messages.sh"

shutter=$root/build/release/shutter
assets=$root/build/release/assets
flights=$root/assets/flythroughs
size=640x360
# What the right halves have and the left ones do not. Skies of pictures are brighter than real ones.
light=(--sky 2.2 --environment-intensity 2 --shadows blurred --shadow-map-size 2048 --bloom 0.04)

usage() {
    cat <<'TEXT'
usage: scripts/draw_pictures.sh [FOLDER [PINK_ROOM]]
  FOLDER      where the pictures are left; default: docs
  PINK_ROOM   the Pink Room with its clips, pink_room_lite_animated.glb; default: its picture is left out
Requires scripts/setup.sh to have run, and ffmpeg.
TEXT
}

# Draws scene $2 by the options that follow into $1, plain on the left and with everything on the right.
draw_pair() {
    local name=$1 scene=$2 number=
    shift 2
    [[ $scene == *.glb ]] || scene=$assets/$scene.glb
    say "$name"
    # Frames of a flight are numbered in their names; there is one of them.
    [[ $* != *--frames* ]] || number=_%d
    rm -rf "$work" && mkdir "$work"
    "$shutter" render "$scene" --size "$size" --method sharp "$@" --out "$work/left$number.png"
    "$shutter" render "$scene" --size "$size" --method resolved --aa box "${light[@]}" "$@" \
        --out "$work/right$number.png"
    ffmpeg -v error -y -i "$work"/left*.png -i "$work"/right*.png -filter_complex hstack -q:v 3 \
        "$folder/$name.jpg"
}

main() {
    case ${1:-} in
        -h | --help)
            usage
            exit 0
            ;;
        -*)
            usage >&2
            die_of_usage "unknown option $1"
            ;;
    esac
    folder=${1:-$root/docs}
    [[ -d $folder ]] || die_of_usage "$folder is no folder"
    [[ -x $shutter ]] || die "there is no $shutter: run scripts/setup.sh"
    command -v ffmpeg >/dev/null || die "ffmpeg is missing (package ffmpeg)"
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
    draw_pair lit_courtyard courtyard --time 0.5 --exposure 0.04
    draw_pair lit_vase vase --time 0.2 --exposure 0.04
    draw_pair lit_rally rally --flythrough "$flights/rally.json" --frames 54:54
    draw_pair lit_gallery gallery --flythrough "$flights/gallery.json" --frames 60:60
    draw_pair lit_spin spin --flythrough "$flights/spin.json" --frames 12:12
    [[ -n ${2:-} ]] || return 0
    # Its one lamp is inside of a closed mesh and the sky outside: neither would light it.
    light=(--bloom 0.04)
    draw_pair lit_pink_room "$2" --time 0.2 --exposure 0.04 --clip vase_slide_linear \
        --clip cushion_spin_linear --clip twigs_sway_linear --clip ball_bounce_and_grow
}

main "$@"
