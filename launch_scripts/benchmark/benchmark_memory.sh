#!/bin/bash
# Tests whether memory is bounded: plays a sequence repeatedly to the processes as one long session (in lockstep) and prints how
# much memory each of them uses and how much disk space the map takes as the run gets longer (Markdown).
#
# Usage: launch_scripts/benchmark/benchmark_memory.sh FOLDER|LOG [--loops N] [--warm-up N] [--run-dir FOLDER]
#   FOLDER|LOG        what to play, as one session: image numbers and times continue, the scene jumps at each seam
#   --loops N         how often (default 400: 20,000 frames of the sample log)
#   --warm-up N       frame from which growth counts (default 2000)
#   --run-dir FOLDER  folder for the results (default logs/runs/memory): memory.md, memory.tsv (a row every 500 frames: frame,
#                     memory (RSS) of each process in kB, size of map.airdos in bytes) and the output of run_live.sh
#   --help            this text
#
# Growth: the maximum memory after the warm-up divided by the maximum in the second half of the warm-up. Exit code 1 if any is above
# 10 %.
set -euo pipefail
# shellcheck source=launch_scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"
# shellcheck source=launch_scripts/benchmark/benchmark_common.sh
source "$(dirname "${BASH_SOURCE[0]}")/benchmark_common.sh"

readonly processes=(frontend human-tracker optimizer map-recorder)
readonly max_growth_percent=10

loops=400 warm_up=2000 run_dir=$AIRDOS_RUNS/memory
parse_options 'loops warm-up run-dir' "$@"
((${#operands[@]} == 1)) || die_usage "one folder or log is required (see --help)"
[[ -e ${operands[0]} ]] || die_usage "no folder '${operands[0]}'"
need_number --loops "$loops"
need_number --warm-up "$warm_up"
need_program airdos-stereo-player

# sample FRAME: appends a row to memory.tsv, unless a process has ended.
sample() {
  local name pid row=$1
  for name in "${processes[@]}"; do
    pid=$(state_of "$name" "$run_dir")
    row+=$'\t'$(awk '/^VmRSS:/ { print $2 }' "/proc/$pid/status" 2> /dev/null) || return 0
  done
  printf '%s\t%s\n' "$row" "$(stat -c %s "$run_dir/map.airdos" 2> /dev/null || echo 0)" >> "$run_dir/memory.tsv"
}

mkdir -p "$run_dir"
rm -f "$run_dir"/{memory.tsv,memory.md,player.log,map.airdos}
trap end_jobs EXIT
start_job 1 "$AIRDOS_ROOT/launch_scripts/run_live.sh" --data "${operands[0]}" --loop "$loops" --run-dir "$run_dir" > "$run_dir/run_live.log"
live_pid=$!
last_frame=''
while kill -0 "$live_pid" 2> /dev/null; do
  frame=$(sed -n 's/.*: \([0-9]*\) frames published$/\1/p' "$run_dir/player.log" 2> /dev/null | tail -n 1) || frame=''
  if [[ -n $frame && $frame != "$last_frame" ]]; then
    sample "$frame"
    last_frame=$frame
  fi
  sleep 0.5
done
finish_jobs

[[ -s $run_dir/memory.tsv ]] || die "fewer than 500 frames: nothing was measured (log: $run_dir/run_live.log)"
code=0
awk -F'\t' -v warm_up="$warm_up" -v limit="$max_growth_percent" -v names="${processes[*]}" '
  {
    frame[NR] = $1
    for (i = 2; i <= 6; ++i) value[NR, i] = $i
    for (i = 2; i <= 5; ++i) {
      if ($1 > warm_up) { if ($i > late[i]) late[i] = $i }
      else if ($1 > warm_up / 2 && $i > early[i]) early[i] = $i
    }
  }
  END {
    split(names, name, " ")
    bad = 0
    print "| process | MB at frame " frame[1] " | most up to frame " warm_up " | most after it | at frame " frame[NR] " | growth % |"
    print "|---|---|---|---|---|---|"
    for (i = 2; i <= 5; ++i) {
      growth = early[i] > 0 && late[i] > 0 ? 100 * (late[i] / early[i] - 1) : 0
      if (growth > limit) bad = 1
      printf "| %s | %.1f | %.1f | %.1f | %.1f | %.1f |\n", name[i - 1], value[1, i] / 1024, early[i] / 1024, late[i] / 1024, value[NR, i] / 1024, growth
    }
    middle = int((NR + 1) / 2)
    if (NR >= 3)
      printf "\nmap.airdos: %.0f bytes a frame in the first half, %.0f in the second\n",
        (value[middle, 6] - value[1, 6]) / (frame[middle] - frame[1]), (value[NR, 6] - value[middle, 6]) / (frame[NR] - frame[middle])
    exit bad
  }' "$run_dir/memory.tsv" > "$run_dir/memory.md" || code=1
cat "$run_dir/memory.md"
((code == 0)) || die "a process grew by more than $max_growth_percent % after frame $warm_up"
