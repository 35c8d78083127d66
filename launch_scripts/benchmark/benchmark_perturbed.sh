#!/bin/bash
# How much of a figure is luck: runs each sequence once as configured and five times with one setting changed, in each mode. Prints
# a row per run, then the median and the worst ATE of each sequence and mode (Markdown).
#
# Usage: launch_scripts/benchmark/benchmark_perturbed.sh FOLDER… [--modes "mask_only on"] [--jobs N] [--run-dir FOLDER] [--set P:S.K=V]…
#   FOLDER…           sequences, each in a layout that airdos-replay knows
#   --modes LIST      out of off, mask_only, on (default: mask_only and on)
#   --jobs N          number of parallel runs (default: the number of cores)
#   --run-dir FOLDER  folder for the results (default logs/runs/perturbed): runs.jsonl and a folder per run
#   --set P:S.K=V     passed to airdos-replay: overrides a value in process P's configuration (repeatable)
#   --help            this text
#
# The perturbations (of the frontend's settings; as configured: threshold 8, dilation 8, 300 features):
#   fast_7, fast_10          features.fast_threshold, grey levels: other corners
#   dilation_6, dilation_10  masks.dilation_px: other features near people
#   features_250             tracking.max_observations: fewer features per frame
# ATE: RMS after SE(3) alignment without scale, over all frames. Lost: frames without a pose, or whose step is wrong by more than
# 0.10 m or 2 degrees.
set -euo pipefail
# shellcheck source=launch_scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"
# shellcheck source=launch_scripts/benchmark/benchmark_common.sh
source "$(dirname "${BASH_SOURCE[0]}")/benchmark_common.sh"

# shellcheck disable=SC2034 # start_runs reads it
readonly variants=(plain fast_7 fast_10 dilation_6 dilation_10 features_250)
declare -A setting_of=(
  [fast_7]=features.fast_threshold=7
  [fast_10]=features.fast_threshold=10
  [dilation_6]=masks.dilation_px=6
  [dilation_10]=masks.dilation_px=10
  [features_250]=tracking.max_observations=250
)

modes='mask_only on' run_dir=$AIRDOS_RUNS/perturbed jobs=$(num_cores)
parse_options 'modes jobs run-dir set' "$@"
folders=("${operands[@]}")
need_number --jobs "$jobs"
need_modes "$modes"
need_sequences "${folders[@]}"
need_benchmark_programs

# run_one FOLDER MODE VARIANT: writes the row of runs.jsonl to the run's folder.
run_one() {
  local folder=$1 mode=$2 variant=$3 name=${1##*/} run options=("${replay_options[@]}")
  run=$(run_of "$@")
  [[ -z ${setting_of[$variant]:-} ]] || options+=(--set "frontend:${setting_of[$variant]}")
  run_with_axes_of "$(run_of "$folder" mask_only plain)" "$name, $mode, $variant" "$folder" "$run" --people "$mode" "${options[@]}"
  jq -c --arg sequence "$name" --arg mode "$mode" --arg variant "$variant" '{
      sequence: $sequence, mode: $mode, variant: $variant, frames, frames_lost, poses_matched,
      ate_m: .ate_se3_m.rmse, rpe_rmse_m: .rpe_translation_per_frame_m.rmse
    }' "$run/evaluation.json" > "$run/row.json"
}

mkdir -p "$run_dir"
trap end_jobs EXIT
start_runs finish_jobs 'mask_only plain' folders mode_list variants
collect_rows folders mode_list variants

echo '| sequence | people | run | frames posed | lost | ATE m | RPE m |'
echo '|---|---|---|---|---|---|---|'
jq -r '[.sequence, .mode, .variant, .poses_matched, .frames, .frames_lost, .ate_m, .rpe_rmse_m] | @tsv' \
  "$run_dir/runs.jsonl" |
  while IFS=$'\t' read -r name mode variant posed frames lost ate rpe; do
    printf '| %s | %s | %s | %d / %d | %d | %.4f | %.4f |\n' "$name" "$mode" "$variant" "$posed" "$frames" "$lost" "$ate" "$rpe"
  done
echo
echo '| sequence | people | median ATE m | worst ATE m | worst run | most frames lost |'
echo '|---|---|---|---|---|---|'
jq -rs 'def median: sort | (.[(length - 1) / 2 | floor] + .[length / 2 | floor]) / 2;
  group_by(.sequence, .mode)[] | max_by(.ate_m) as $worst
  | [.[0].sequence, .[0].mode, (map(.ate_m) | median), $worst.ate_m, $worst.variant, (map(.frames_lost) | max)]
  | @tsv' "$run_dir/runs.jsonl" |
  while IFS=$'\t' read -r name mode median worst variant lost; do
    printf '| %s | %s | %.4f | %.4f | %s | %d |\n' "$name" "$mode" "$median" "$worst" "$variant" "$lost"
  done
say "all figures: $run_dir/runs.jsonl"
