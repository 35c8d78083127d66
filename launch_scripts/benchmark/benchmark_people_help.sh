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
# shellcheck disable=SC2206 # words
cap_list=($caps)
need_modes 'mask_only on'
for cap in "${cap_list[@]}"; do [[ $cap == uncapped ]] || need_number --caps "$cap"; done
need_sequences "${folders[@]}"
need_benchmark_programs

# run_one FOLDER CAP MODE: leaves the row of runs.jsonl in the run's folder.
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
