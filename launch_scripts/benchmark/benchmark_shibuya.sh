#!/bin/bash
# The paper's Table II: ATE on the sequences of TartanAir-Shibuya, ours (people off, mask_only, on) beside the published
# figures of AirDOS, ORB-SLAM and VDO-SLAM.
#
# Usage: launch_scripts/benchmark/benchmark_shibuya.sh DATASET_DIR [--modes "off mask_only on"] [--jobs N] [--run-dir FOLDER] [--set P:S.K=V]…
#   DATASET_DIR       folder with the sequences, up to three folders deep; a sequence is a folder with image_0 and image_1,
#                     recognised by its name (Standing01, roadcrossing_03 …). Sequences of the paper that are missing are
#                     reported; others are run as well.
#   --modes LIST      out of off, mask_only, on (default: all three)
#   --jobs N          number of parallel runs (default: the number of cores)
#   --run-dir FOLDER  folder for the results (default logs/runs/shibuya): shibuya.md and a folder per run
#   --set P:S.K=V     passed to airdos-replay: overrides a value in process P's configuration (repeatable)
#   --help            this text
#
# ATE: RMS in m after SE(3) alignment without scale, over all frames; if some frames have no pose, followed by the share that has
# one. The axes of gt_pose.txt (any, including left-handed ones) are detected for each sequence from the motion in the run with
# masks, and reported. If the motion fits several, the errors for all of them are printed; if it fits none, no figure is.
set -euo pipefail
# shellcheck source=launch_scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"
# shellcheck source=launch_scripts/benchmark/benchmark_common.sh
source "$(dirname "${BASH_SOURCE[0]}")/benchmark_common.sh"

readonly paper_sequences=(Standing01 Standing02 RoadCrossing03 RoadCrossing04 RoadCrossing05 RoadCrossing06 RoadCrossing07)
readonly published_airdos='0.0606 0.0193 0.0951 0.0331 0.0206 0.2230 0.5625'
readonly published_orb_slam='0.0788 0.0060 0.0657 0.0196 0.0148 1.0984 0.8476'
readonly published_vdo_slam='0.0994 0.6129 0.3813 0.3879 0.2175 0.2400 0.6628'

modes='off mask_only on' run_dir=$AIRDOS_RUNS/shibuya jobs=$(num_cores)
parse_options 'modes jobs run-dir set' "$@"
need_dataset
need_number --jobs "$jobs"
need_modes "$modes"
need_benchmark_programs

# plain_name NAME: lower-case letters and digits only.
plain_name() { tr '[:upper:]' '[:lower:]' <<< "$1" | tr -cd 'a-z0-9'; }

# Finds the sequences: the paper's in its order, then the others by name.
declare -A folder_of=()
find_sequences() {
  local folder name paper
  while IFS= read -r folder; do
    folder=$(dirname "$folder")
    [[ -d $folder/image_1 ]] || continue
    name=$(basename "$folder")
    for paper in "${paper_sequences[@]}"; do
      [[ $(plain_name "$name") != $(plain_name "$paper") ]] || name=$paper
    done
    [[ -z ${folder_of[$name]:-} ]] || die_usage "'$name' exists twice: ${folder_of[$name]} and $folder"
    folder_of[$name]=$folder
  done < <(find -L "$dataset" -mindepth 1 -maxdepth 4 -type d -name image_0 | sort)
  ((${#folder_of[@]} > 0)) || die_usage "'$dataset' contains no sequence: no folder with image_0 and image_1"
}
find_sequences
sequences=("${paper_sequences[@]}") missing=()
for name in "${paper_sequences[@]}"; do [[ -n ${folder_of[$name]:-} ]] || missing+=("$name"); done
while IFS= read -r name; do
  [[ " ${paper_sequences[*]} " == *" $name "* ]] || sequences+=("$name")
done < <(printf '%s\n' "${!folder_of[@]}" | sort)

is_there() { [[ -n ${folder_of[$1]:-} ]]; }

# run_one NAME MODE
run_one() {
  run_with_axes_of "$run_dir/$1/mask_only" "$1, $2" "${folder_of[$1]}" "$run_dir/$1/$2" \
    --calibration tartanair-shibuya --people "$2" "${replay_options[@]}"
}

# The axes detected, with the errors for other axes if the motion fits these as well.
print_axes() {
  local name file
  for name in "${sequences[@]}"; do
    is_there "$name" || continue
    file=$run_dir/$name/mask_only/evaluation.json
    if [[ ! -e $file ]]; then
      echo "- $name: not found out (see $run_dir/$name/mask_only/evaluation.txt)"
      continue
    fi
    jq -r --arg name "$name" '"- \($name): \(.ground_truth_axes), \(if .ground_truth_right_handed then "right" else "left" end)-handed"
      + (if (.ground_truth_axes_alternatives | length) == 0 then "" else
         "; AMBIGUOUS, with masks this gives \(.ate_se3_m.rmse * 10000 | round / 10000) m, but as well fit " +
         ([.ground_truth_axes_alternatives[] | "\(.axes) with \(.ate_se3_m.rmse * 10000 | round / 10000) m"] | join(", ")) end)' "$file"
  done
}

mkdir -p "$run_dir"
trap end_jobs EXIT
# shellcheck disable=SC2034 # start_runs reads it
present=("${!folder_of[@]}")
start_runs wait_for_jobs mask_only present mode_list

{
  ate_table 'ATE m' 4 "AirDOS $published_airdos" "ORB-SLAM $published_orb_slam" "VDO-SLAM $published_vdo_slam"
  echo
  echo 'Axes of the ground truth (where right, down and forward lie):'
  print_axes
} > "$run_dir/shibuya.md"
cat "$run_dir/shibuya.md"
((${#missing[@]} == 0)) || say "not in '$dataset': ${missing[*]}"
finish_jobs
