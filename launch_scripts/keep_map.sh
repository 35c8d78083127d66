#!/bin/bash
# Gives the folder of a map recorder another name if its map is closed, so that the next run does not replace it.
#
# Usage: launch_scripts/keep_map.sh FOLDER
#   FOLDER  --run-dir of the map recorder; it becomes FOLDER_<time of the map, UTC>, beside it
#   --help  this text
#
# A map that is not closed, of a recorder that was killed, stays where it is: the recorder goes on with it. The service of the map
# recorder calls this before each start.
set -euo pipefail
# shellcheck source=launch_scripts/common.sh
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/common.sh"

case ${1:-} in
  --help | -h)
    print_help
    exit 0
    ;;
  -*) die_usage "unknown option '$1' (see --help)" ;;
esac
(($# == 1)) || die_usage "which folder? One, not $# (see --help)"
folder=${1%/}
# The notes lie beside a map until it is closed.
[[ -e $folder/map.airdos && ! -e $folder/map.airdos.open ]] || exit 0
kept=${folder}_$(date -u -r "$folder/map.airdos" +%Y%m%dT%H%M%SZ)
[[ ! -e $kept ]] || die "$kept is there already"
mv -T "$folder" "$kept"
say "the map of the run before is kept in $kept"
