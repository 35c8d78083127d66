#!/bin/bash
# The curve of when people help: every sequence with the static features a frame capped ever lower, with people only masked
# (mask_only) and with people in the estimate (on). Prints tables (Markdown), writes them as JSON and draws the curve.
#
# Usage: launch_scripts/benchmark/benchmark_people_help.sh FOLDER… [--caps LIST] [--jobs N] [--run-dir FOLDER] [--set P:S.K=V]…
#   FOLDER…           sequences, each in a layout that airdos-replay knows
#   --caps LIST       static features a frame at most (default "3 5 8 15 30 100 uncapped"; uncapped: as configured)
#   --jobs N          runs at a time (default: as many as there are cores)
#   --run-dir FOLDER  where everything goes (default logs/runs/people_help): help.md, help.json, help.png, runs.jsonl and a
#                     folder a run
#   --set P:S.K=V     of airdos-replay: another value in process P's configuration (again for more)
#   --help            this text
#
# The cap is frontend:tracking.max_observations. ATE: root mean square after SE(3) alignment without scale. RPE-T: error of
# the step from frame to frame. Lost: frames without a pose, or whose step is wrong by more than 0.10 m or 2 degrees
# (common/evaluation/trajectory_error.h). All of the refined trajectory.
set -euo pipefail
# shellcheck source=launch_scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"
# shellcheck source=launch_scripts/benchmark/benchmark_common.sh
source "$(dirname "${BASH_SOURCE[0]}")/benchmark_common.sh"

caps='3 5 8 15 30 100 uncapped' run_dir=$AIRDOS_RUNS/people_help jobs=$(num_cores)
parse_options 'caps jobs run-dir set' "$@"
folders=("${operands[@]}")
need_number --jobs "$jobs"
[[ $caps =~ [^[:space:]] ]] || die_usage "--caps: the list is empty"
for cap in $caps; do [[ $cap == uncapped ]] || need_number --caps "$cap"; done
need_sequences "${folders[@]}"
need_benchmark_programs

# run_of FOLDER CAP MODE: the folder of that run.
run_of() { echo "$run_dir/$(basename "$1")/$2/$3"; }

# run_one FOLDER CAP MODE: leaves the row of runs.jsonl in the run's folder. With few features the estimate may be too bad
# to tell the axes of the ground truth: they come from the uncapped run.
run_one() {
  local folder=$1 cap=$2 mode=$3 name run reference axes=auto options=("${replay_options[@]}")
  name=$(basename "$folder")
  run=$(run_of "$folder" "$cap" "$mode")
  reference=$(run_of "$folder" uncapped mask_only)
  [[ $cap == uncapped ]] || options+=(--set "frontend:tracking.max_observations=$cap")
  [[ $run == "$reference" ]] || axes=$(axes_of "$reference/evaluation.json")
  replay_sequence "$name, $cap, $mode" "$folder" "$run" --people "$mode" "${options[@]}"
  evaluate_run "$name, $cap, $mode" "$run" --gt-axes "$axes"
  jq -c --arg sequence "$name" --arg mode "$mode" --arg cap "$cap" '{
      sequence: $sequence, mode: $mode,
      max_observations: (if $cap == "uncapped" then null else $cap | tonumber end),
      frames, frames_lost, poses_matched,
      ate_m: .ate_se3_m.rmse,
      rpe_median_m: .rpe_translation_per_frame_m.median, rpe_rmse_m: .rpe_translation_per_frame_m.rmse,
      rpe_median_deg: .rpe_rotation_per_frame_deg.median, rpe_rmse_deg: .rpe_rotation_per_frame_deg.rmse
    }' "$run/evaluation.json" > "$run/row.json"
}

mkdir -p "$run_dir"
trap end_jobs EXIT
for folder in "${folders[@]}"; do start_job "$jobs" run_one "$folder" uncapped mask_only; done
finish_jobs
for folder in "${folders[@]}"; do
  for cap in $caps; do
    for mode in mask_only on; do
      [[ $cap-$mode == uncapped-mask_only ]] || start_job "$jobs" run_one "$folder" "$cap" "$mode"
    done
  done
done
finish_jobs

rows=()
for folder in "${folders[@]}"; do
  for cap in $caps; do
    for mode in mask_only on; do rows+=("$(run_of "$folder" "$cap" "$mode")/row.json"); done
  done
done
cat "${rows[@]}" > "$run_dir/runs.jsonl"
"$AIRDOS_BIN/airdos-evaluate" curve --runs "$run_dir/runs.jsonl" --json "$run_dir/help.json" --plot "$run_dir/help.png" \
  > "$run_dir/help.md" || die "airdos-evaluate curve failed"
cat "$run_dir/help.md"
say "curve: $run_dir/help.png, figures: $run_dir/help.json"
