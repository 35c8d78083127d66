#!/bin/bash
# Plays an LCM log to the processes that run_live.sh has started.
#
# Usage: launch_scripts/replay_log.sh FILE [--speed X] [--run-dir FOLDER] [--no-check]
#   FILE              LCM log; only the channels of camera and detectors are played
#   --speed X         1 as recorded, 2 twice as fast, 0 as fast as possible (default 1)
#   --run-dir FOLDER  the run to play it to (default logs/runs/latest)
#   --no-check        do not check the log before playing it
#   --help            this text
#
# Each time, the log is played as a new session. The first time in a run, lcm-logplayer plays it with the session number in the log.
# Since the processes ignore frames that they have already processed, airdos-stereo-player plays it with new numbers after that.
set -euo pipefail
# shellcheck source=launch_scripts/common.sh
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/common.sh"

log='' speed=1 run_dir=$AIRDOS_RUNS/latest check=yes
while (($# > 0)); do
  case $1 in
    --speed)
      need_value "$@"
      speed=$2
      shift
      ;;
    --run-dir | --run)
      need_value "$@"
      run_dir=$2
      shift
      ;;
    --no-check) check=no ;;
    --help | -h)
      print_help
      exit 0
      ;;
    -*) die_usage "unknown option '$1' (see --help)" ;;
    *)
      [[ -z $log ]] || die_usage "only one log can be played, not '$1' as well"
      log=$1
      ;;
  esac
  shift
done
[[ -n $log ]] || die_usage "which log? (see --help)"
[[ -f $log ]] || die_usage "no file '$log'"
[[ $speed =~ ^[0-9]+(\.[0-9]+)?$ ]] || die_usage "--speed: not a number: '$speed'"
[[ -r $run_dir/state ]] || die_usage "--run-dir: no run of run_live.sh in '$run_dir'"
command -v lcm-logplayer > /dev/null || die "lcm-logplayer is missing: 'apt-get install liblcm-bin'"
if [[ $check == yes && -x $AIRDOS_BIN/airdos-check ]]; then
  "$AIRDOS_BIN/airdos-check" --quick "$log" > /dev/null ||
    die_usage "'$log' cannot be used: 'airdos-check $log' says why; --no-check plays it anyway"
fi

enter_network "$(state_of pid "$run_dir")"
url=$(state_of url "$run_dir")
played=$(state_of played "$run_dir")
echo "played=$log" >> "$run_dir/state"
if [[ -z $played ]]; then
  say "$log to $url at speed $speed"
  exec "${ENTER_NETWORK[@]}" lcm-logplayer -s "$speed" -e "$AIRDOS_CAMERA_CHANNELS" -l "$url" "$log"
fi
need_program airdos-stereo-player
session=$(date +%s%6N)
say "$log to $url at speed $speed, as session $session: these processes have already processed a log"
pace=(--pace realtime --speed "$speed")
if [[ $speed =~ ^0+(\.0+)?$ ]]; then pace=(--pace lockstep); fi
exec "${ENTER_NETWORK[@]}" "$AIRDOS_BIN/airdos-stereo-player" --log "$log" --session "$session" --no-check --lcm-url "$url" "${pace[@]}"
