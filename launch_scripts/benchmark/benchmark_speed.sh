#!/bin/bash
# How fast the chain is on each sequence, in airdos-replay and live, and how its solver scales with people and window: prints
# tables (Markdown), writes them as JSON and plots them.
#
# Usage: launch_scripts/benchmark/benchmark_speed.sh FOLDER… [--people MODE] [--live yes|no] [--solver yes|no] [--run-dir FOLDER] [--set P:S.K=V]…
#   FOLDER…           sequences, each in a layout that airdos-replay knows
#   --people MODE     passed to airdos-replay: off, mask_only or on (default: as configured, as in live runs)
#   --live yes|no     also run the four processes in lockstep, over LCM in their own network (default yes)
#   --solver yes|no   also run airdos_solver_benchmark, if it has been built (default yes)
#   --run-dir FOLDER  folder for the results (default logs/runs/speed): speed.md, speed.json, speed.png, runs.jsonl, solver.json
#                     and a folder per sequence
#   --set P:S.K=V     passed to airdos-replay: overrides a value in process P's configuration (repeatable)
#   --help            this text
#
# ms: CPU time per frame, in one thread. MB: peak resident memory of a process (live) or of all in one (replay, parallel). Frames per
# second: wall time, including input and output. Messages: of frames, inputs and outputs. One run at a time, because other load
# distorts everything but CPU times.
set -euo pipefail
# shellcheck source=launch_scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"
# shellcheck source=launch_scripts/benchmark/benchmark_common.sh
source "$(dirname "${BASH_SOURCE[0]}")/benchmark_common.sh"

people='' live=yes solver=yes run_dir=$AIRDOS_RUNS/speed
parse_options 'people live solver run-dir set' "$@"
folders=("${operands[@]}")
if [[ -n $people ]]; then
  need_modes "$people" --people
  replay_options+=(--people "$people")
fi
for name in live solver; do
  [[ ${!name} == yes || ${!name} == no ]] || die_usage "--$name: '${!name}' is neither yes nor no"
done
need_sequences "${folders[@]}"
need_benchmark_programs
if [[ $live == yes ]]; then need_program airdos-stereo-player; fi

# run_replay NAME FOLDER RUN THREADS
run_replay() {
  local name=$1 folder=$2 run=$3 threads=$4
  "$AIRDOS_BIN/airdos-replay" "$folder" --run-dir "$run/$threads" --timing "$run/$threads.json" --out /dev/null --all \
    --no-progress --threads "$threads" "${replay_options[@]}" > "$run/$threads.log" 2>&1 ||
    die "$name: airdos-replay failed (log: $run/$threads.log)"
}

# run_live NAME FOLDER RUN: writes live.json: frames per second and peak memory (kB) of each process.
run_live() {
  local name=$1 folder=$2 run=$3/live live_pid process pid peak published
  local -A peaks=()
  rm -rf "$run"
  mkdir -p "$run"
  start_job 1 "$AIRDOS_ROOT/launch_scripts/run_live.sh" --data "$folder" --run-dir "$run" > "$run/run_live.log" 2>&1
  live_pid=$!
  while kill -0 "$live_pid" 2> /dev/null; do
    for process in frontend human-tracker optimizer map-recorder; do
      pid=$(state_of "$process" "$run" 2> /dev/null) || continue
      peak=$(awk '/^VmHWM:/ { print $2 }' "/proc/${pid:-none}/status" 2> /dev/null) || continue
      [[ -z $peak ]] || peaks[${process//-/_}]=$peak
    done
    sleep 0.2
  done
  wait_for_jobs
  ((failed_jobs == 0)) || die "$name: run_live.sh failed (log: $run/run_live.log)"
  published=$(sed -n 's/.*published \([0-9]*\) frames in \([0-9.e+]*\) s.*/\1 \2/p' "$run/player.log")
  [[ -n $published ]] || die "$name: the player failed (log: $run/player.log)"
  for process in "${!peaks[@]}"; do echo "$process ${peaks[$process]}"; done |
    jq -R -s --arg published "$published" '($published | split(" ") | map(tonumber)) as [$frames, $seconds]
      | {fps: ($frames / $seconds), peaks: ([split("\n")[] | select(. != "") | split(" ") | {(.[0]): (.[1] | tonumber / 1024)}] | add)}' \
      > "$3/live.json"
}

# run_one FOLDER: writes the row of runs.jsonl to the run's folder.
run_one() {
  local folder=$1 name=${1##*/} run
  run=$(run_of "$folder")
  mkdir -p "$run"
  run_replay "$name" "$folder" "$run" 1
  run_replay "$name" "$folder" "$run" auto
  echo '{}' > "$run/live.json"
  if [[ $live == yes ]]; then run_live "$name" "$folder" "$run"; fi
  jq -c -n --arg sequence "$name" --slurpfile serial "$run/1.json" --slurpfile parallel "$run/auto.json" \
    --slurpfile live "$run/live.json" '$serial[0] as $s | $parallel[0] as $p | $live[0] as $l | {
      sequence: $sequence, num_frames: $s.num_frames,
      processes: ($s.processes | with_entries(.value = {p50_ms: .value.cpu_ms.p50, p99_ms: .value.cpu_ms.p99,
        peak_memory_mb: $l.peaks[.key]})),
      serial_fps: ($s.num_frames / $s.wall_s), parallel_fps: ($p.num_frames / $p.wall_s),
      replay_memory_mb: $p.peak_memory_mb, live_fps: $l.fps,
      messages_per_s: (if $l.fps then $p.num_events / $p.num_frames * $l.fps else null end)
    }' > "$run/row.json"
}

mkdir -p "$run_dir"
trap end_jobs EXIT
for_each folders -- run_one
collect_rows folders

solver_options=()
if [[ $solver == yes && -x $AIRDOS_BIN/airdos_solver_benchmark ]]; then
  "$AIRDOS_BIN/airdos_solver_benchmark" --benchmark_out="$run_dir/solver.json" --benchmark_out_format=json \
    > "$run_dir/solver.log" 2>&1 || die "airdos_solver_benchmark failed (log: $run_dir/solver.log)"
  solver_options=(--solver "$run_dir/solver.json")
elif [[ $solver == yes ]]; then
  say "airdos_solver_benchmark is not built (it needs libbenchmark-dev): no figures for the solver" >&2
fi
"$AIRDOS_BIN/airdos-evaluate" speed --runs "$run_dir/runs.jsonl" "${solver_options[@]}" --json "$run_dir/speed.json" \
  --plot "$run_dir/speed.png" > "$run_dir/speed.md" || die "airdos-evaluate speed failed"
cat "$run_dir/speed.md"
say "picture: $run_dir/speed.png, figures: $run_dir/speed.json"
