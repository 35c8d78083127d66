#!/bin/bash
# How well airdos-person-detector finds people, and what it does for camera and tracks, beside the data set's own keypoints without
# masks: prints tables (Markdown).
#
# Usage: launch_scripts/benchmark/benchmark_detector.sh FOLDER… [--every LIST] [--jobs N] [--run-dir FOLDER] [--set P:S.K=V]…
#   FOLDER…           sequences, each in a layout that airdos-replay knows; people are judged where there are joints_gt.json.gz and
#                     gt_tum_optical.txt
#   --every LIST      values of the detector's detect_every (default "1 2 3")
#   --jobs N          number of parallel runs (default 1, for the CPU times)
#   --run-dir FOLDER  folder for the results (default logs/runs/detector): detector.md and a folder per run
#   --set P:S.K=V     passed to airdos-replay: overrides a value in process P's configuration (repeatable)
#   --help            this text
#
# ATE: RMS after SE(3) alignment without scale, over all frames. States: of people who are to be seen, summed over frames. CPU: of
# the detector, mean per frame, one thread. Recall and false people: of the left image (airdos-evaluate detections).
set -euo pipefail
# shellcheck source=launch_scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"
# shellcheck source=launch_scripts/benchmark/benchmark_common.sh
source "$(dirname "${BASH_SOURCE[0]}")/benchmark_common.sh"

every='1 2 3' run_dir=$AIRDOS_RUNS/detector jobs=1
parse_options 'every jobs run-dir set' "$@"
folders=("${operands[@]}")
need_number --jobs "$jobs"
# shellcheck disable=SC2206 # words
variants=(given $every)
for name in "${variants[@]:1}"; do need_number --every "$name"; done
need_sequences "${folders[@]}"
need_benchmark_programs

has_truth() { [[ -f $1/joints_gt.json.gz && -f $1/gt_tum_optical.txt ]]; }

# run_one FOLDER VARIANT
run_one() {
  local folder=$1 variant=$2 name="${1##*/}, $2" run
  local -a options
  run=$(run_of "$@")
  if [[ $variant == given ]]; then
    options=(--people on --masks off)
  else
    options=(--detect --out "$run/output.lcm" --set "person_detector:time.detect_every=$variant")
  fi
  replay_sequence "$name" "$folder" "$run" "${options[@]}" "${replay_options[@]}"
  evaluate_run "$name" "$run"
  if has_truth "$folder"; then
    "$AIRDOS_BIN/airdos-evaluate" people --people "$run/people.jsonl" --joints "$folder/joints_gt.json.gz" --estimate "$run/trajectory.tum" \
      --ground-truth "$folder/gt_tum_optical.txt" --json "$run/people.json" --force > "$run/people.txt" 2>&1 ||
      die "$name: airdos-evaluate people failed (log: $run/people.txt)"
  fi
  [[ $variant != given ]] || return 0
  "$AIRDOS_BIN/airdos-evaluate" detections --log "$run/output.lcm" --data "$folder" --json "$run/detections.json" --force \
    > "$run/detections.txt" 2>&1 || die "$name: airdos-evaluate detections failed (log: $run/detections.txt)"
}

# rounded DECIMALS PATH FILE: a number from one of our JSON files, - where there is none.
rounded() {
  local value=null
  [[ ! -e $3 ]] || value=$(number_of "$2" "$3")
  if [[ $value == null ]]; then echo -; else printf "%.$1f\n" "$value"; fi
}

# camera_row FOLDER VARIANT
camera_row() {
  local run people
  run=$(run_of "$@")
  people=$run/people.json
  table_row "${1##*/}" "$2" \
    "$(number_of poses_matched "$run/evaluation.json") / $(number_of poses_ground_truth "$run/evaluation.json")" \
    "$(rounded 4 ate_se3_m.rmse "$run/evaluation.json")" \
    "$(rounded 0 states_to_be_seen_found "$people") / $(rounded 0 states_to_be_seen "$people")" "$(rounded 2 idf1 "$people")" \
    "$(rounded 2 joint_error.measured_m.median "$people")" "$(rounded 0 processes.person_detector.cpu_ms.mean "$run/timing.json")"
}

# detection_row FOLDER VARIANT: against the truth, or where there is none against the given people.
detection_row() {
  local file against=.detected.left people=to_be_seen false_people=false_per_image
  [[ $2 != given ]] || return 0
  file=$(run_of "$@")/detections.json
  if ! has_truth "$1"; then
    against=.detected_against_given.left people=given false_people=without_given_per_image
  fi
  against=${against#.}
  table_row "${1##*/}$([[ $people == given ]] && echo ' (against the given)')" "$2" "$(rounded 0 "$against.$people.recall_percent" "$file")" \
    "$(rounded 0 "$against.${people}_by_depth[\"below 6 m\"].recall_percent" "$file")" \
    "$(rounded 0 "$against.${people}_by_depth[\"6 to 12 m\"].recall_percent" "$file")" \
    "$(rounded 0 "$against.${people}_by_depth[\"from 12 m\"].recall_percent" "$file")" \
    "$(rounded 2 "$against.$false_people" "$file")" "$(rounded 1 "$against.joint_error_px.median" "$file")" \
    "$(rounded 2 detected.disparity_error_px.median "$file")"
}

trap end_jobs EXIT
mkdir -p "$run_dir"
start_runs finish_jobs '' folders variants
{
  table_row sequence "people: given, or every" 'frames posed' 'ATE m' 'states found' IDF1 'joints, median m' 'CPU ms'
  echo '|---|---|---|---|---|---|---|---|'
  for_each folders variants -- camera_row
  echo
  table_row sequence 'every' 'recall %' 'below 6 m' '6 to 12 m' 'from 12 m' 'false an image' 'joints, median px' 'disparity, median px'
  echo '|---|---|---|---|---|---|---|---|---|'
  for_each folders variants -- detection_row
} | tee "$run_dir/detector.md"
