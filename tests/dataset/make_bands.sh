#!/bin/bash
# Makes tests/dataset/bands.txt: how far the figures of the dataset tests go when little is changed. Runs the tests as
# configured and ten times with one setting changed, five of the camera's (those of benchmark_perturbed.sh) and five of the
# people's, and leaves some room around the least and the greatest that came out.
#
# Usage: AIRDOS_DATA_DIR=FOLDER tests/dataset/make_bands.sh [FIGURES]
#   FIGURES   lines `figure: CASE NAME VALUE` of earlier runs instead (the tests print them)
#   --help    this text
#
# Look at what changes (git diff) before it is committed: a band that moves says that the result did.
set -euo pipefail
# shellcheck source=launch_scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/../../launch_scripts/common.sh"

readonly settings=('' frontend:features.fast_threshold=7 frontend:features.fast_threshold=10 frontend:masks.dilation_px=6
  frontend:masks.dilation_px=10 frontend:tracking.max_observations=250 human_tracker:keypoints.min_confidence=0.12
  human_tracker:keypoints.sigma_per_height=0.010 human_tracker:flow.window_px=15 human_tracker:tracking.depth_sigma=0.12
  optimizer:people.rigidity_sigma_m=0.017)

case ${1:-} in
  --help | -h)
    print_help
    exit 0
    ;;
esac
figures=${1:-}
if [[ -z $figures ]]; then
  need_program chain_accuracy_test
  need_program human_tracking_test
  figures=$AIRDOS_RUNS/figures.txt
  mkdir -p "$AIRDOS_RUNS"
  : > "$figures"
  for setting in "${settings[@]}"; do
    say "${setting:-as configured}" >&2
    for program in chain_accuracy_test human_tracking_test; do
      # Figures leave the bands that are to be made anew: that is no failure here.
      AIRDOS_TEST_SET=$setting "$AIRDOS_BIN/$program" > "$figures.log" || true
      grep '^figure: ' "$figures.log" >> "$figures" || die "$program gave no figures (log: $figures.log)"
    done
  done
fi

# Room: half of the range on either side, at least a share of the value: 25 % for errors of the camera, 15 % for those of
# people, 5 % for counts, and a few units where values are near 0. Errors may come out as low as half the least.
awk '
  $1 != "figure:" { next }
  { key = $2 " " $3; value = $4
    if (!(key in least) || value < least[key]) least[key] = value
    if (!(key in most) || value > most[key]) most[key] = value }
  END {
    for (key in least) {
      split(key, part, " "); name = part[2]
      is_camera = name ~ /^(ate_m|drift_percent|frames_lost)$/
      is_error = is_camera || name ~ /error|measured|optimized|switches|wrong|false|swapped|eliminated/
      share = is_camera ? 0.25 : is_error ? 0.15 : 0.05
      unit = name ~ /^(frames_lost|switches|tracks)$/ ? 2 : name ~ /idf1/ ? 0.02 : name ~ /signed/ ? 0.5 : \
             name ~ /bias/ ? 0.005 : name ~ /percent|reprojections/ ? 0.3 : name ~ /velocity|speed/ ? 0.03 : 0.0005
      room = (most[key] - least[key]) / 2
      if (room < share * most[key]) room = share * most[key]
      if (room < unit) room = unit
      high = most[key] + room
      low = is_error ? least[key] / 2 : least[key] - room
      if (name ~ /percent$/ && name !~ /signed|drift/ && high > 100) high = 100
      if (name == "idf1" && high > 1) high = 1
      if (most[key] == 0 && name !~ /percent|lost|switches|bias/) { low = 0; high = 0 }
      printf "%s %s %.4g %.4g\n", part[1], name, low, high
    }
  }' "$figures" | sort > "$AIRDOS_ROOT/tests/dataset/bands.new"
{
  echo '# case, figure, least, most: made by tests/dataset/make_bands.sh.'
  cat "$AIRDOS_ROOT/tests/dataset/bands.new"
} > "$AIRDOS_ROOT/tests/dataset/bands.txt"
rm "$AIRDOS_ROOT/tests/dataset/bands.new"
