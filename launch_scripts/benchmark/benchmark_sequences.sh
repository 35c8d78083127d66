#!/bin/bash
# Runs every sequence with people off, mask_only and on, and prints a table: frames with a pose, errors, ms per frame.
#
# Usage: launch_scripts/benchmark/benchmark_sequences.sh FOLDER… [--modes "off mask_only on"] [--run-dir FOLDER] [--set P:S.K=V]…
#   FOLDER…           sequences, each in TartanAir-Shibuya or KITTI odometry layout
#   --modes LIST      out of off, mask_only, on (default: all three)
#   --run-dir FOLDER  folder for maps, trajectories and pictures (default logs/runs/benchmark)
#   --set P:S.K=V     passed to airdos-replay: overrides a value in process P's configuration (repeatable)
#   --help            this text
#
# ATE: RMS after SE(3) alignment without scale, over all frames. Drift: of the end point, in % of the path length.
# ms: mean CPU time per frame of frontend / human tracker / optimizer, one thread each.
set -euo pipefail
# shellcheck source=launch_scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"
# shellcheck source=launch_scripts/benchmark/benchmark_common.sh
source "$(dirname "${BASH_SOURCE[0]}")/benchmark_common.sh"

modes='off mask_only on' run_dir=$AIRDOS_RUNS/benchmark
parse_options 'modes run-dir set' "$@"
folders=("${operands[@]}")
need_modes "$modes"
need_sequences "${folders[@]}"
need_benchmark_programs

# run_one FOLDER MODE: one row of the table.
run_one() {
  local folder=$1 mode=$2 name=${1##*/} run evaluation timing
  run=$(run_of "$@")
  replay_sequence "$name, $mode" "$folder" "$run" --people "$mode" --out "$run/output.lcm" "${replay_options[@]}"
  evaluate_run "$name, $mode" "$run"
  evaluation=$run/evaluation.json timing=$run/timing.json
  printf '| %s | %s | %s / %s | %.4f | %.4f | %.4f | %.2f | %.0f / %.0f / %.0f |\n' "$name" "$mode" \
    "$(number_of poses_matched "$evaluation")" "$(number_of poses_ground_truth "$evaluation")" \
    "$(number_of ate_se3_m.rmse "$evaluation")" "$(number_of rpe_translation_per_frame_m.rmse "$evaluation")" \
    "$(number_of rpe_rotation_per_frame_deg.rmse "$evaluation")" "$(number_of end_point_drift_percent "$evaluation")" \
    "$(number_of processes.frontend.cpu_ms.mean "$timing")" \
    "$(number_of processes.human_tracker.cpu_ms.mean "$timing")" \
    "$(number_of processes.optimizer.cpu_ms.mean "$timing")"
}

echo '| sequence | people | frames posed | ATE m | RPE m | RPE deg | drift % | ms |'
echo '|---|---|---|---|---|---|---|---|'
for_each folders mode_list -- run_one
