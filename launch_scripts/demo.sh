#!/bin/bash
# Everything in one command: installs missing packages, builds, replays a log and evaluates the trajectory.
#
# Usage: launch_scripts/demo.sh [--log FILE] [--run-dir FOLDER]
#   --log FILE        LCM log to replay (default: the sample in logs/)
#   --run-dir FOLDER  folder for the results (default: logs/runs/demo)
#   --help            this text
#
# A second run takes only seconds. The map, trajectories, people and pictures are in the results folder.
set -euo pipefail
# shellcheck source=launch_scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

# The default folder belongs to the demo.
replace=(--force)
log=$AIRDOS_ROOT/logs/road_crossing06.lcm
run_dir=$AIRDOS_ROOT/logs/runs/demo
while (($# > 0)); do
  case $1 in
    --log)
      need_value "$@"
      log=$2
      shift
      ;;
    --run-dir)
      need_value "$@"
      run_dir=$2
      replace=()
      shift
      ;;
    --help | -h)
      print_help
      exit 0
      ;;
    *) die_usage "unknown option '$1' (see --help)" ;;
  esac
  shift
done
[[ -f $log && -r $log ]] || die_usage "--log: no readable file '$log'"

say "step 1 of 4: packages"
install_packages
say "step 2 of 4: build"
build_programs
fetch_networks

say "step 3 of 4: replay of $log"
mkdir -p "$run_dir"
"$AIRDOS_BIN/airdos-replay" "$log" --out "$run_dir/output.lcm" --run-dir "$run_dir" "${replace[@]}"

say "step 4 of 4: evaluation and pictures"
if [[ -s $run_dir/ground_truth.tum ]]; then
  "$AIRDOS_BIN/airdos-evaluate" trajectory --estimate "$run_dir/trajectory.tum" \
    --ground-truth "$run_dir/ground_truth.tum" --json "$run_dir/evaluation.json" --plot "$run_dir/trajectory.png" \
    "${replace[@]}"
else
  say "the log has no ground truth to compare the trajectory with"
fi

"$AIRDOS_BIN/airdos-map" plot "$run_dir/map.airdos" --out "$run_dir/map.png" "${replace[@]}"

say "results:"
for file in "$run_dir"/*; do printf '  %9s  %s\n' "$(du -h "$file" | cut -f1)" "$file"; done
