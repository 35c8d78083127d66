#!/bin/bash
# Runs the processes for a long time as on a robot: in realtime pace, playing a sequence at 10 Hz repeatedly as one long session; or
# in lockstep, as fast as the machine allows, which only shows that everything keeps working. Prints what was lost, how long frames
# took and how much memory each process uses (Markdown).
#
# Usage: launch_scripts/long_run.sh [FOLDER|LOG] [--minutes N] [--pace realtime|lockstep] [--max-lost PERCENT]
#                                  [--run-dir FOLDER]
#   FOLDER|LOG        what to play (default: the sample log)
#   --minutes N       duration (default 30)
#   --pace realtime|lockstep
#                     lockstep: each frame waits until the previous one is done, so nothing is lost, however slow the machine is
#   --max-lost PERCENT
#                     share of its frames that a process may skip, miss or complete without an input (default 0)
#   --run-dir FOLDER  folder for the results (default logs/runs/long): long_run.md, memory.tsv (every 5 s: seconds, memory (RSS)
#                     of each process in kB) and the output of run_live.sh
#   --help            this text
#
# Memory growth: the maximum of the second half divided by the maximum of the second quarter; the first quarter fills the maps. Exit
# code 1 if more than allowed was lost, if any camera image was lost in transit (regardless of --max-lost, which allows for slow
# machines), or if a process grew by more than 10 % (30 % in less than three minutes, because the frontend's map takes its time to
# fill). On a machine that is fast enough and otherwise idle, nothing is lost.
set -euo pipefail
# shellcheck source=launch_scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

readonly processes=(frontend human-tracker optimizer map-recorder)
readonly sample_period_s=5

data='' minutes=30 pace=realtime max_lost=0 run_dir=$AIRDOS_RUNS/long
while (($# > 0)); do
  case $1 in
    --minutes | --pace | --max-lost | --run-dir)
      need_value "$@"
      name=${1#--}
      printf -v "${name//-/_}" '%s' "$2"
      shift
      ;;
    --help | -h)
      print_help
      exit 0
      ;;
    -*) die_usage "unknown option '$1' (see --help)" ;;
    *)
      [[ -z $data ]] || die_usage "one folder or log, not '$data' and '$1'"
      data=$1
      ;;
  esac
  shift
done
data=${data:-$AIRDOS_ROOT/logs/road_crossing06.lcm}
[[ -e $data ]] || die_usage "no folder or log '$data'"
[[ $minutes =~ ^[1-9][0-9]*$ ]] || die_usage "--minutes: not a whole number above 0: '$minutes'"
[[ $pace == realtime || $pace == lockstep ]] || die_usage "--pace: neither realtime nor lockstep: '$pace'"
[[ $max_lost =~ ^(100|[0-9]{1,2})$ ]] || die_usage "--max-lost: not a whole number from 0 to 100: '$max_lost'"
need_program airdos-stereo-player
max_growth_percent=$((minutes < 3 ? 30 : 10))

# More rounds, of at least 1 s each, than there is time for; the run is stopped when the time is up.
loops=$((minutes * 60))
if [[ $pace == lockstep ]]; then loops=$((100 * loops)); fi # a round takes as long as the machine needs

mkdir -p "$run_dir"
rm -f "$run_dir"/{memory.tsv,long_run.md}
"$(dirname "$0")/run_live.sh" --data "$data" --loop "$loops" --pace "$pace" --run-dir "$run_dir" > "$run_dir/run_live.log" 2>&1 &
live_pid=$!
trap 'kill -TERM "$live_pid" 2> /dev/null || true' EXIT

# Appends a row to memory.tsv, unless a process is missing.
sample() {
  local process pid kb row=$SECONDS
  for process in "${processes[@]}"; do
    pid=$(state_of "$process" "$run_dir" 2> /dev/null) || return 0
    kb=$(awk '/^VmRSS:/ { print $2 }' "/proc/$pid/status" 2> /dev/null) || return 0
    [[ -n $kb ]] || return 0
    row+=$'\t'$kb
  done
  echo "$row" >> "$run_dir/memory.tsv"
}

# die_of TEXT: with what run_live.sh said last.
die_of() {
  tail -n 5 "$run_dir/run_live.log" >&2
  die "$1: see $run_dir/run_live.log"
}

SECONDS=0
while ((SECONDS < minutes * 60)) && kill -0 "$live_pid" 2> /dev/null; do
  sleep "$sample_period_s"
  sample
done
kill -0 "$live_pid" 2> /dev/null || die_of "the run ended early"
kill -TERM "$live_pid"
code=0
wait "$live_pid" || code=$?
trap - EXIT
((code == 0)) || die_of "a process ended badly"
[[ -s $run_dir/memory.tsv ]] || die_of "nothing was measured"

# number PROCESS REGEX: the number after REGEX in a process' final messages; the sum if there are several.
number() { sed -n "s/^[^ ]* airdos-$1: info: .*$2\([0-9.]*\).*/\1/p" "$run_dir/$1.log" | awk '{ sum += $1 } END { print sum + 0 }'; }

# growth COLUMN: MB at the start and at the end, and growth in %.
growth() {
  awk -F'\t' -v i="$1" '
    { mb[NR] = $i / 1024 }
    END {
      for (k = 1; k <= NR; ++k) {
        if (4 * k > NR && 2 * k <= NR && mb[k] > early) early = mb[k]
        if (2 * k > NR && mb[k] > late) late = mb[k]
      }
      printf "%.1f %.1f %.1f\n", mb[1], mb[NR], (early > 0 ? 100 * (late / early - 1) : 0)
    }' "$run_dir/memory.tsv"
}

failed=no
{
  echo "| process | frames done | incomplete | skipped | messages missing | latency ms p50 | p99 | MB at the start | at the end | growth % |"
  echo "|---|---|---|---|---|---|---|---|---|---|"
  column=2
  for process in "${processes[@]}"; do
    read -r first last percent <<< "$(growth "$column")"
    incomplete=$(number "$process" 'incomplete ') skipped=$(number "$process" 'skipped ') missing=$(number "$process" 'missing ')
    num_done=$(number "$process" 'frames done ')
    echo "| $process | $num_done | $incomplete | $skipped | $missing | $(number "$process" 'p50 ') |" \
      "$(number "$process" 'p99 ') | $first | $last | $percent |"
    # Of the images that frames were done without, these did arrive, but too late.
    images_late=$(number "$process" 'CAMERA_[A-Z]*: received [0-9]*, missing [0-9]*, duplicate ')
    images_lost=$(($(number "$process" 'CAMERA_[A-Z]*: received [0-9]*, missing ') - images_late))
    ((num_done > 0)) || failed=idle
    ((100 * (incomplete + skipped + missing) <= max_lost * (num_done + skipped))) || failed=lost
    ((images_lost <= 0)) || failed=images
    awk "BEGIN { exit !($percent > $max_growth_percent) }" && failed=grown
    column=$((column + 1))
  done
} > "$run_dir/long_run.md"
cat "$run_dir/long_run.md"
case $failed in
  idle) die "a process did nothing (logs: $run_dir)" ;;
  images) die "camera images were lost in transit: see airdos-doctor (logs: $run_dir)" ;;
  lost) die "frames or messages were lost: is the machine fast enough, and idle? (logs: $run_dir)" ;;
  grown) die "a process grew by more than $max_growth_percent %" ;;
esac
