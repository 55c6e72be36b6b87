#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# `shutter film`: draws the frames of a sequence by several processes, each a part of them
# (`shutter render --part K/N`), on this machine or by Slurm, and then encodes the film by one.
set -euo pipefail

shutter=$(dirname "$(readlink -f "$0")")/shutter
words=() restart=() sbatch=() devices=()
jobs=1 parts='' slurm='' wait=''

usage() {
    cat <<'TEXT'
usage: shutter film SCENE --out FILE.mp4|PATTERN [OPTION ...]
Draws a film in parts, by many processes. Takes the options of `shutter render`, and:
  --jobs N          processes that draw at once on this machine; default 1
  --parts N         parts to draw the film in; default: one for each of --jobs, 16 with --slurm
  --devices A,B     devices that the processes of --jobs take in turn
  --slurm           submit the parts to Slurm, and a job after them that makes the film; print their ids
  --sbatch OPTION   with --slurm: an option for sbatch, e.g. partition=films (repeatable)
  --wait            with --slurm: wait until the film is finished
TEXT
}

# Ends with status $1 and one sentence, as `shutter` does.
fail() {
    local status=$1
    shift
    printf 'shutter: %s\n' "$*" >&2
    exit "$status"
}

read_arguments() {
    local option value
    while (($#)); do
        option=${1%%=*}
        case $option in
            --jobs | --parts | --devices | --sbatch)
                if [[ $1 == *=* ]]; then
                    value=${1#*=}
                else
                    (($# > 1)) || fail 2 "$option needs a value"
                    value=$2
                    shift
                fi
                case $option in
                    --jobs) jobs=$value ;;
                    --parts) parts=$value ;;
                    --devices) IFS=, read -ra devices <<<"$value" ;;
                    --sbatch) sbatch+=("--${value#--}") ;;
                esac
                ;;
            --slurm) slurm=yes ;;
            --wait) wait=yes ;;
            --restart) restart=(--restart) ;;
            --part | --dry-run) fail 2 "$option belongs to shutter render" ;;
            -h | --help)
                usage
                exit 0
                ;;
            *) words+=("$1") ;;
        esac
        shift
    done
}

check_arguments() {
    [[ $jobs =~ ^[1-9][0-9]{0,2}$ ]] || fail 2 "--jobs $jobs is not a number from 1 to 999"
    if [[ -z $slurm ]]; then
        ((${#sbatch[@]} == 0)) || fail 2 "--sbatch needs --slurm"
        [[ -z $wait ]] || fail 2 "--wait needs --slurm"
    else
        ((jobs == 1)) || fail 2 "--jobs and --slurm exclude each other"
        ((${#devices[@]} == 0)) || fail 2 "--devices and --slurm exclude each other"
    fi
    [[ -n $parts ]] || parts=$([[ -n $slurm ]] && echo 16 || echo "$jobs")
    [[ $parts =~ ^[1-9][0-9]{0,4}$ ]] || fail 2 "--parts $parts is not a number from 1 to 99999"
}

# Has `shutter render` check options and files; sets frames, journal and work.
plan() {
    local printed
    printed=$({
        "$shutter" render "${words[@]}" --part "1/$parts" --dry-run 2>&1 >&3 |
            sed -E 's/\b(of|for|command|shutter) render\b/\1 film/g' >&2
    } 3>&1) || exit $?
    frames=$(sed -n 's/^frames: //p' <<<"$printed")
    journal=$(realpath -m "$(sed -n 's/^journal: //p' <<<"$printed")")
    work=$(realpath -m "$(sed -n 's/^work: //p' <<<"$printed")") # of logs, and the ids of jobs
    ((parts <= frames)) || parts=$frames
    mkdir -p "$work" || exit 1
}

# The last sentence of log $1, without the program's name.
last_sentence() {
    local printed
    printed=$(tail -n 1 "$1" 2>/dev/null || true)
    printf '%s' "${printed#shutter: }"
}

# Prints how many frames the parts' journals hold.
count_drawn() {
    cat "$journal".part_* 2>/dev/null | grep -c '"frame"' || true
}

# Prints progress for as long as it runs: on a terminal every second, else a line every ten.
report_progress() {
    local pause=10 ends='\n' begun=$SECONDS before drawn left
    [[ ! -t 2 ]] || pause=1 ends='\r'
    before=$(count_drawn)
    # No child such as `sleep` outlives this process and holds stderr open.
    while ! read -rt "$pause" <> <(:); do
        drawn=$(count_drawn) left='?'
        ((drawn <= before)) || left=$(((SECONDS - begun) * (frames - drawn) / (drawn - before)))
        printf "shutter: rendering: %s of %s frames are drawn, %s s left$ends" "$drawn" "$frames" "$left" >&2
    done
}

# Draws every --jobs-th part from the $1-th on, until one fails anywhere; writes why to the file failed.
work_here() {
    local part child status device=()
    ((${#devices[@]} == 0)) || device=(--device "${devices[$1 % ${#devices[@]}]}")
    trap '{ kill "$child"; wait "$child"; } 2>/dev/null; exit 1' TERM
    for ((part = $1 + 1; part <= parts; part += jobs)); do
        [[ ! -e $work/failed ]] || return 0
        "$shutter" render "${words[@]}" "${device[@]}" "${restart[@]}" --part "$part/$parts" \
            >"$work/part_$part.log" 2>&1 &
        child=$!
        status=0
        wait "$child" 2>/dev/null || status=$?
        ((status != 0)) || continue
        if ((status == 1)); then
            printf 'part %s: %s' "$part" "$(last_sentence "$work/part_$part.log")" >"$work/failed"
        else
            printf 'part %s ended with status %s' "$part" "$status" >"$work/failed"
        fi
        return 0
    done
}

# Draws the parts by --jobs processes at a time, and makes the film.
draw_here() {
    local workers=() reporter place
    rm -f "$work/failed"
    for ((place = 0; place < jobs; ++place)); do
        work_here "$place" &
        workers+=($!)
    done
    report_progress &
    reporter=$!
    # The processes end with this one.
    trap 'kill "$reporter" "${workers[@]}" 2>/dev/null; wait; exit 130' INT TERM
    wait "${workers[@]}" || true
    kill "$reporter" && { wait "$reporter" 2>/dev/null || true; }
    [[ ! -t 2 ]] || printf '\r\033[K' >&2
    [[ ! -e $work/failed ]] || fail 1 "$(<"$work/failed"); the same command goes on where it stopped"
    "$shutter" render "${words[@]}" >"$work/finish.log" 2>&1 ||
        fail 1 "$(last_sentence "$work/finish.log")"
    grep 'is complete, so it is skipped' "$work/finish.log" || true
    rm -rf "$work"
}

# Submits a job by sbatch's options and prints its id.
submit() {
    local printed status=0
    printed=$(sbatch --parsable --job-name="$(basename "$work" .parts)" --chdir="$PWD" --requeue \
        --open-mode=append "$@" "${sbatch[@]}" 2>"$work/sbatch.log") || status=$?
    ((status == 0)) || fail 1 "sbatch ended with status $status: $(last_sentence "$work/sbatch.log")"
    printed=${printed##*$'\n'} printed=${printed%%;*} # without the name of a cluster
    [[ $printed =~ ^[0-9]+$ ]] || fail 1 "sbatch printed '$printed' and no job's id"
    printf '%s' "$printed"
}

# The words for a shell of any kind.
quote() {
    local word
    for word in "$@"; do
        printf "'%s' " "${word//\'/\'\\\'\'}"
    done
}

# Submits the array of the parts and the job that makes the film; writes their ids into the file jobs.
submit_film() {
    local render again='' array finish
    render=$(quote "$shutter" render "${words[@]}")
    # A part that is started again goes on.
    ((${#restart[@]} == 0)) || again="\$([ \${SLURM_RESTART_COUNT:-0} != 0 ] || echo --restart) "
    array=$(submit --array="1-$parts" --output="${work//%/%%}/part_%a.log" \
        --wrap="exec $render $again--part \$SLURM_ARRAY_TASK_ID/$parts") || exit 1
    # Without the second option it would wait for ever where a part failed.
    finish=$(submit --output="${work//%/%%}/finish.log" --dependency="afterok:$array" \
        --kill-on-invalid-dep=yes --wrap="$render&& { rm -rf $(quote "$work"); true; }") || {
        scancel "$array" || true
        exit 1
    }
    printf '%s %s\n' "$array" "$finish" >"$work/jobs"
    printf 'job %s: parts 1-%s\njob %s: finishes the film\n' "$array" "$parts" "$finish"
}

# Whether squeue lists any of the jobs $1, comma-separated. Status 2: not known.
are_queued() {
    local printed status=0
    printed=$(squeue --noheader --format=%i --jobs="$1" 2>&1) || status=$?
    if ((status == 0)); then
        [[ -n $printed ]]
    elif [[ $printed == *'Invalid job id'* ]]; then # Slurm forgets jobs some minutes after their end
        return 1
    else
        return 2
    fi
}

# Waits until the jobs $1 have left the queue, and fails unless the film is finished then.
follow() {
    local failures=0 status log printed
    while true; do
        status=0
        are_queued "$1" || status=$?
        ((status != 1)) || break
        # A controller that restarts is back within a minute.
        failures=$((status == 0 ? 0 : failures + 1))
        ((failures < 30)) || fail 1 "squeue does not answer"
        [[ ! -t 2 ]] || printf '\r%s of %s frames are drawn' "$(count_drawn)" "$frames" >&2
        sleep 2
    done
    [[ ! -t 2 ]] || printf '\r\033[K' >&2
    [[ -e $work/jobs ]] || return 0
    printed='a job was ended and printed nothing'
    for log in "$work"/part_*.log "$work/finish.log"; do
        if [[ $(tail -n 1 "$log" 2>/dev/null | grep -v '^shutter: rendering:') == 'shutter: '* ]]; then
            printed="$(basename "$log" .log | tr _ ' ') reports: $(last_sentence "$log")"
            break
        fi
    done
    fail 1 "the film is not finished: $printed; the same command goes on where it stopped"
}

draw_by_slurm() {
    local program jobs_before
    for program in sbatch squeue scancel; do
        command -v "$program" >/dev/null || fail 1 "--slurm needs Slurm's program $program, which is not on PATH"
    done
    jobs_before=$(tr ' ' , 2>/dev/null <"$work/jobs" || true)
    if [[ -n $jobs_before ]] && are_queued "$jobs_before"; then
        printf 'the jobs %s draw this film already\n' "${jobs_before/,/ }"
    else
        submit_film
    fi
    [[ -z $wait ]] || follow "$(tr ' ' , <"$work/jobs")"
}

main() {
    read_arguments "$@"
    check_arguments
    plan
    if [[ -n $slurm ]]; then draw_by_slurm; else draw_here; fi
}

main "$@"
