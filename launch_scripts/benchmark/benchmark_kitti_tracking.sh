#!/bin/bash
# The paper's Table I: ATE on sequences of KITTI tracking, with masks: ours (people mask_only, on) beside the published figures
# of ORB-SLAM and AirDOS.
#
# Usage: launch_scripts/benchmark/benchmark_kitti_tracking.sh DATASET_DIR [--modes "mask_only on"] [--jobs N] [--run-dir FOLDER] [--set P:S.K=V]…
#   DATASET_DIR       folder with training/ and testing/, each with image_02/NNNN, image_03/NNNN, calib/NNNN.txt, oxts/NNNN.txt
#                     and, for people, alphapose_0/NNNN, alphapose_1/NNNN, rcnnseg_image_0/NNNN in the file formats of
#                     TartanAir-Shibuya. Sequences that are missing, or that have no files of people, are reported.
#   --modes LIST      out of off, mask_only, on (default: mask_only and on)
#   --jobs N          number of parallel runs (default: the number of cores)
#   --run-dir FOLDER  folder for the results (default logs/runs/kitti_tracking): kitti_tracking.md and a folder per run
#   --set P:S.K=V     passed to airdos-replay: overrides a value in process P's configuration (repeatable)
#   --help            this text
#
# The sequences are 18 28 13 14 15 19, in the paper's order. Training has 0 to 20 and testing 0 to 28, so 28 must be from testing;
# 18, listed next to it at the front, is taken from testing as well, and 13 14 15 19 from training. ATE: RMS in m after SE(3)
# alignment without scale, over all frames, of the left colour camera; the ground truth is GPS/IMU in the Mercator projection, as
# in KITTI's development kit.
set -euo pipefail
# shellcheck source=launch_scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"
# shellcheck source=launch_scripts/benchmark/benchmark_common.sh
source "$(dirname "${BASH_SOURCE[0]}")/benchmark_common.sh"

readonly sequences=(testing/0018 testing/0028 training/0013 training/0014 training/0015 training/0019)
readonly published_orb_slam='0.933 2.033 1.547 0.176 0.240 2.633'
readonly published_airdos='0.934 2.027 1.618 0.172 0.234 2.760'

modes='mask_only on' run_dir=$AIRDOS_RUNS/kitti_tracking jobs=$(num_cores)
parse_options 'modes jobs run-dir set' "$@"
need_dataset
need_number --jobs "$jobs"
need_modes "$modes"

# folder_of SPLIT/NNNN: folder of the left images, which identifies a sequence to the programs.
folder_of() { echo "$dataset/${1%/*}/image_02/${1#*/}"; }

present=() missing=() without_people=()
for name in "${sequences[@]}"; do
  if [[ -d $(folder_of "$name") ]]; then
    present+=("$name")
    for kind in alphapose_0 alphapose_1 rcnnseg_image_0; do
      [[ -d $dataset/${name%/*}/$kind/${name#*/} ]] || without_people+=("${name%/*}/$kind/${name#*/}")
    done
  else
    missing+=("$name")
  fi
done
((${#present[@]} > 0)) ||
  die_usage "'$dataset' contains none of the sequences: no training/image_02/0013 … (see --help)"
need_benchmark_programs

is_there() { [[ -d $(folder_of "$1") ]]; }

# run_one SPLIT/NNNN MODE. The reader returns the ground truth in optical axes.
run_one() {
  local name=$1 mode=$2 run=$run_dir/$1/$2
  replay_sequence "$name, $mode" "$(folder_of "$name")" "$run" --people "$mode" "${replay_options[@]}"
  evaluate_run "$name, $mode" "$run" --gt-axes optical
}

mkdir -p "$run_dir"
trap end_jobs EXIT
start_runs wait_for_jobs '' present mode_list
ate_table 'ATE m, with masks' 3 "ORB-SLAM $published_orb_slam" "AirDOS $published_airdos" > "$run_dir/kitti_tracking.md"
cat "$run_dir/kitti_tracking.md"
((${#missing[@]} == 0)) || say "not in '$dataset': ${missing[*]}"
((${#without_people[@]} == 0)) || say "no files of people, so people change nothing: ${without_people[*]}"
finish_jobs
