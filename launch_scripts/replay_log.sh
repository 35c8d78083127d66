#!/bin/bash
# Plays an LCM log into the processes that run_live.sh has started.
#
# Usage: launch_scripts/replay_log.sh FILE [--speed X] [--run FOLDER]
#   FILE          LCM log; only what came from the camera is played
#   --speed X     1 as recorded, 2 twice as fast, 0 as fast as possible (default 1)
#   --run FOLDER  of which run (default logs/runs/latest)
#   --help        this text
set -euo pipefail
# shellcheck source=launch_scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

log='' speed=1 run=$AIRDOS_RUNS/latest
while (($# > 0)); do
  case $1 in
    --speed | --run)
      need_value "$@"
      printf -v "${1#--}" '%s' "$2"
      shift
      ;;
    --help | -h)
      print_help
      exit 0
      ;;
    -*) die_usage "unknown option '$1' (see --help)" ;;
    *)
      [[ -z $log ]] || die_usage "one log only, not also '$1'"
      log=$1
      ;;
  esac
  shift
done
[[ -n $log ]] || die_usage "which log? (see --help)"
[[ -f $log ]] || die_usage "no file '$log'"
[[ $speed =~ ^[0-9]+(\.[0-9]+)?$ ]] || die_usage "--speed: not a number: '$speed'"
[[ -r $run/state ]] || die_usage "--run: no run of run_live.sh in '$run'"
command -v lcm-logplayer > /dev/null || die "lcm-logplayer is missing: 'apt-get install liblcm-bin'"

enter_network "$(state_of pid "$run")"
url=$(state_of url "$run")
say "$log to $url at speed $speed"
exec "${ENTER_NETWORK[@]}" lcm-logplayer -s "$speed" -e "$AIRDOS_CAMERA_CHANNELS" -l "$url" "$log"
