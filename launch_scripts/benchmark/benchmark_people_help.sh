#!/bin/bash
# When do people help? Runs every sequence with fewer and fewer static features per frame, with people only masked (mask_only) and
# with people in the estimate (on). Prints tables (Markdown), writes them as JSON and plots the curve.
#
# Usage: launch_scripts/benchmark/benchmark_people_help.sh FOLDER… [--caps LIST] [--jobs N] [--run-dir FOLDER] [--set P:S.K=V]…
#   FOLDER…           sequences, each in a layout that airdos-replay knows
#   --caps LIST       limits of static features per frame (default "3 5 8 15 30 100 uncapped"; uncapped: as configured)
#   --jobs N          number of parallel runs (default: the number of cores)
#   --run-dir FOLDER  folder for the results (default logs/runs/people_help): help.md, help.json, help.png, runs.jsonl and a
#                     folder per run
#   --set P:S.K=V     passed to airdos-replay: overrides a value in process P's configuration (repeatable)
#   --help            this text
#
# The cap is frontend:tracking.max_observations. ATE: RMS after SE(3) alignment without scale. RPE-T: translation error of the step
# from frame to frame. Lost: frames without a pose, or whose step is wrong by more than 0.10 m or 2 degrees
# (common/evaluation/trajectory_error.h). All for the refined trajectory.
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
# shellcheck disable=SC2206 # words
cap_list=($caps)
need_modes 'mask_only on'
for cap in "${cap_list[@]}"; do [[ $cap == uncapped ]] || need_number --caps "$cap"; done
need_sequences "${folders[@]}"
need_benchmark_programs

# run_one FOLDER CAP MODE: writes the row of runs.jsonl to the run's folder.
run_one() {
  local folder=$1 cap=$2 mode=$3 name=${1##*/} run options=("${replay_options[@]}")
  run=$(run_of "$@")
  [[ $cap == uncapped ]] || options+=(--set "frontend:tracking.max_observations=$cap")
  run_with_axes_of "$(run_of "$folder" uncapped mask_only)" "$name, $cap, $mode" "$folder" "$run" --people "$mode" "${options[@]}"
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
start_runs finish_jobs 'uncapped mask_only' folders cap_list mode_list
collect_rows folders cap_list mode_list
"$AIRDOS_BIN/airdos-evaluate" curve --runs "$run_dir/runs.jsonl" --json "$run_dir/help.json" --plot "$run_dir/help.png" \
  > "$run_dir/help.md" || die "airdos-evaluate curve failed"
cat "$run_dir/help.md"
say "curve: $run_dir/help.png, figures: $run_dir/help.json"
