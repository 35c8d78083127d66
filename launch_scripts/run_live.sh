#!/bin/bash
# Runs the processes as intended: separately, with one LCM URL.
#
# Usage: launch_scripts/run_live.sh [--camera DEV [DEV] | --video FILE [FILE] | --images DIR [DIR] | --data FOLDER | --log FILE] [options]
#   --camera DEV [DEV]    also start the camera process: devices of the left and the right camera, or one that gives both images in one
#   --video FILE [FILE]   also start the player on a recording of a stereo camera: two videos, or one with both images; stop at its end
#   --images DIR [DIR]    the same with folders of the left and the right images, or one with both
#   --calibration FILE [FILE]
#                         needed with these three: of the unrectified pair (Kalibr, ROS, OpenCV, ...: airdos-calibration show FILE)
#   --side-by-side        in the one image of a device or video, the left one is on the left
#   --over-under          it is on top
#   --times FILE          with --images: their times
#   --rate HZ             images a second, where they have no times; with --camera: that it shall give
#   --no-detect           without airdos-person-detector, which is started with --camera, --video and --images
#   --set P:S.K=V         overrides a value in process P's configuration (repeatable): frontend, human_tracker, optimizer, map_recorder,
#                         person_detector, stereo_player or stereo_camera. In realtime pace the detector looks at every second image, reduced
#                         to 256 px, and follows people in between; person_detector:time.detect_every=1 makes it look at each,
#                         person_detector:network.short_side_px=288 as closely as a replay
#   --record              also record what the processes publish to <run-dir>/output.lcm, as --video and --images do anyway
#   --data FOLDER         also start the player on this data set, and stop when all of it has been processed; can be a log, too
#   --loop N              with --data: play it N times as one long session (default 1), reporting progress every 500 frames
#   --log FILE            also play this LCM log (only the channels of camera and detectors), and stop likewise
#   --speed X             with --log: 1 as recorded, 2 twice as fast, 0 as fast as possible (default 1)
#   --pace lockstep|realtime
#                         lockstep: nothing is lost; realtime: the newest image counts (default lockstep, with --camera realtime)
#   --detect              with --data or --log: also start airdos-person-detector; their keypoints and masks are not used
#   --lcm-url URL         (default udpm://239.255.76.67:7667?ttl=0)
#   --run-dir FOLDER      folder for logs and results (default logs/runs/<time>); logs/runs/latest points to it
#   --force               replace files in that folder that were not written by a run
#   --no-check            do not check the data set or log before playing it
#   --host-network        run in this machine's network instead of a separate namespace
#   --help                this text
#
# Also passed on, as airdos-stereo-player --help and airdos-stereo-camera --help tell: --swap, --rectified, --scale-calibration, --size,
# --baseline-unit, --lens, --kitti-cameras, --alpha, --capture-size, --pixel-format.
#
# Without a source it waits for images and runs until Ctrl-C, with --camera as well. The messages of each process go to
# <run-dir>/<process>.log (warnings and errors are also shown here; so is a lag that grows), its resolved configuration to
# <run-dir>/<process>.yaml. At the end it reports how many frames got their pose from images, from people, or by prediction only; with
# --camera, --video or --images it also makes the pictures that demo.sh makes, and lists the files.
# Exit code 0 if all processes ended well; 1 if one did not, or if no frame got a pose; 2 for a wrong option or input.
set -euo pipefail
# shellcheck source=launch_scripts/common.sh
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/common.sh"

PROCESSES=(frontend human-tracker optimizer map-recorder)
readonly READY_DEADLINE_S=30
readonly STOP_DEADLINE_S=20
# A frame that lacks an input is completed after 5 s (--deadline-s), so a shorter silence does not mean the end.
readonly IDLE_S=6
readonly DRAIN_DEADLINE_S=600

data='' loop=1 log='' speed=1 pace='' url=$AIRDOS_DEFAULT_URL run_dir='' host_network=no is_inside=no force=no check=yes detect='' record=no
camera=() video=() images=() calibration=() source_options=() settings=()
original_arguments=("$@")
while (($# > 0)); do
  case $1 in
    --camera | --video | --images | --calibration)
      need_value "$@"
      name=${1#--}
      [[ $2 != -* ]] || die_usage "$1 needs a value (see --help)"
      words=("$2")
      shift
      if (($# >= 2)) && [[ $2 != -* ]]; then
        words+=("$2")
        shift
      fi
      declare -n list=$name
      # shellcheck disable=SC2034  # another name for one of the four
      list=("${words[@]}")
      unset -n list
      ;;
    --times | --rate | --size | --baseline-unit | --lens | --kitti-cameras | --alpha | --capture-size | --pixel-format)
      need_value "$@"
      source_options+=("$1" "$2")
      shift
      ;;
    --side-by-side | --over-under | --swap | --rectified | --scale-calibration) source_options+=("$1") ;;
    --no-detect) detect=no ;;
    --record) record=yes ;;
    --set)
      need_value "$@"
      [[ $2 =~ ^(frontend|human_tracker|optimizer|map_recorder|person_detector|stereo_player|stereo_camera):.+=.*$ ]] ||
        die_usage "--set: '$2' is not PROCESS:section.key=value (see --help)"
      settings+=("$2")
      shift
      ;;
    --data | --loop | --log | --speed | --pace | --lcm-url | --run-dir)
      need_value "$@"
      name=${1#--}
      printf -v "${name//-/_}" '%s' "$2"
      shift
      ;;
    --host-network) host_network=yes ;;
    --force) force=yes ;;
    --no-check) check=no ;;
    --detect) detect=yes ;;
    --inside) is_inside=yes ;; # internal: the namespace exists
    --help | -h)
      print_help
      exit 0
      ;;
    *) die_usage "unknown option '$1' (see --help)" ;;
  esac
  shift
done
# shellcheck disable=SC2154  # --lcm-url fills lcm_url
url=${lcm_url:-$url}
# What the images come from: the process's name in the run, and what it is told.
sources=() source=player source_arguments=()
if [[ -n $data ]]; then sources+=(--data); fi
if [[ -n $log ]]; then sources+=(--log); fi
for name in camera video images; do
  declare -n given=$name
  if ((${#given[@]} > 0)); then
    sources+=("--$name")
    source_arguments=("--$name" "${given[@]}" --calibration "${calibration[@]}" "${source_options[@]}")
  fi
  unset -n given
done
((${#sources[@]} <= 1)) || die_usage "${sources[0]} and ${sources[1]} exclude each other"
if ((${#camera[@]} > 0)); then source=camera; fi
if ((${#source_arguments[@]} == 0)); then
  option=${source_options[0]:-}
  if ((${#calibration[@]} > 0)); then option=--calibration; fi
  [[ -z $option ]] || die_usage "$option is for --camera, --video and --images"
elif ((${#calibration[@]} == 0)); then
  die_usage "${sources[0]}: the calibration is missing: --calibration FILE (airdos-calibration show FILE tells what it says)"
fi
for name in "${calibration[@]}"; do [[ -f $name ]] || die_usage "--calibration: no file '$name'"; done
for name in "${video[@]}"; do [[ -f $name ]] || die_usage "--video: no file '$name'"; done
for name in "${images[@]}"; do [[ -d $name ]] || die_usage "--images: no folder '$name'"; done
for name in "${camera[@]}"; do [[ -e $name ]] || die_usage "--camera: no device '$name'"; done
((loop == 1 || ${#camera[@]} == 0)) || die_usage "--loop: a camera is not played"
# The camera cannot wait for anybody, and a user's own recording has no people yet.
if [[ -z $pace ]]; then
  pace=lockstep
  if [[ $source == camera ]]; then pace=realtime; fi
fi
if [[ -z $detect ]]; then
  detect=no
  if ((${#source_arguments[@]} > 0)); then detect=yes; fi
fi
# In realtime, people followed into every second image are worth more than fewer images. First, so that the user's own comes later.
if [[ $detect == yes && $pace == realtime ]]; then settings=(person_detector:{time.detect_every=2,network.short_side_px=256} "${settings[@]}"); fi
# A recording ends; a camera may go on for days.
if ((${#video[@]} > 0 || ${#images[@]} > 0)); then record=yes; fi
readonly source
[[ $loop =~ ^[1-9][0-9]*$ ]] || die_usage "--loop: not a whole number above 0: '$loop'"
[[ -z $data || -e $data ]] || die_usage "--data: no folder '$data'"
[[ -z $log || -f $log ]] || die_usage "--log: no file '$log'"
[[ $speed =~ ^[0-9]+(\.[0-9]+)?$ ]] || die_usage "--speed: not a number: '$speed'"
[[ $pace == lockstep || $pace == realtime ]] || die_usage "--pace: '$pace' is neither lockstep nor realtime"
channels=$AIRDOS_CAMERA_CHANNELS
if [[ $detect == yes ]]; then
  PROCESSES+=(person-detector)
  channels='^(CAMERA_LEFT|CAMERA_RIGHT|CALIBRATION|GROUND_TRUTH)$'
fi
if [[ $record == yes ]]; then PROCESSES+=(record); fi # the last one to be stopped
readonly PROCESSES channels
for process in "${PROCESSES[@]}"; do need_program "airdos-$process"; done
if [[ -n $data ]] || ((${#source_arguments[@]} > 0)); then need_program "airdos-stereo-$source"; fi
if [[ -n $log ]]; then
  command -v lcm-logplayer > /dev/null || die "lcm-logplayer is missing: 'apt-get install liblcm-bin'"
fi

# check_input FILE: reports what is wrong with it before anything is started.
check_input() {
  local code=0
  [[ $check == yes && -x $AIRDOS_BIN/airdos-check ]] || return 0
  "$AIRDOS_BIN/airdos-check" --quick "$1" > "$run_dir/check.log" 2>&1 || code=$?
  sed -n '/: warning: \|: error: /p' "$run_dir/check.log" >&2
  if ((code == 1)); then die_usage "'$1' cannot be used (see above; --no-check plays it anyway)"; fi
  if ((code != 0)); then die_usage "$(tail -n 1 "$run_dir/check.log")"; fi
}

# refuse_foreign_files: files with these names that were not written by a run are the user's.
refuse_foreign_files() {
  local name
  [[ $force == no && ! -e $run_dir/state ]] || return 0
  for name in state check player camera "${PROCESSES[@]}"; do
    [[ $name == state ]] || name=$name.log
    [[ ! -e $run_dir/$name ]] || die_usage "--run-dir: $run_dir/$name was not written by a run; --force replaces it"
  done
}

if [[ $is_inside == no ]]; then
  if [[ -z $run_dir ]]; then
    run_dir=$AIRDOS_RUNS/$(date +%Y%m%d_%H%M%S)_$$
    original_arguments+=(--run-dir "$run_dir")
  fi
  mkdir -p "$run_dir" || die_usage "--run-dir: '$run_dir' cannot be created"
  refuse_foreign_files
  # The processes keep it open as well, so it is released only when all of them have ended.
  exec {run_lock}> "$run_dir/.airdos_run_live"
  flock --nonblock "$run_lock" || die_usage "--run-dir: another run_live.sh is writing to $run_dir"
  if [[ -n $log ]]; then check_input "$log"; fi # the player checks its input itself
  mkdir -p "$AIRDOS_RUNS"
  ln -sfn "$(realpath "$run_dir")" "$AIRDOS_RUNS/latest"
  if [[ $host_network == yes ]]; then
    "$AIRDOS_SCRIPTS/network_setup.sh" --check || die "--host-network: the network is not ready for LCM (see above)"
  else
    run_in_new_network "$0" "${original_arguments[@]}" --inside
  fi
fi

declare -A pids=() exit_codes=()
stopping=no
trap 'stopping=yes' INT TERM HUP

# Ctrl-C also interrupts sleep, whose failure must not end the script before it has stopped the others.
pause() { sleep "$1" || true; }

# start NAME PROGRAM ARGUMENTS…: in its own session, so that Ctrl-C reaches only this script and the processes are stopped
# in order; they also end if this script is killed.
start() {
  local name=$1
  shift
  : > "$run_dir/$name.log" # here rather than in the child, or the READY of an earlier run might be found in it
  setsid setpriv --pdeathsig TERM -- "$@" > "$run_dir/$name.log" 2>&1 < /dev/null &
  pids[$name]=$!
  echo "$name=${pids[$name]}" >> "$run_dir/state"
}

is_running() { [[ -e /proc/${pids[$1]}/stat ]] && ! grep -q '^State:[[:space:]]*Z' "/proc/${pids[$1]}/status" 2> /dev/null; }

collect() {
  local code=0
  wait "${pids[$1]}" || code=$?
  exit_codes[$1]=$code
}

# stop NAME: sends SIGTERM, and SIGKILL only if it does not end.
stop() {
  local name=$1 deadline=$((SECONDS + STOP_DEADLINE_S))
  [[ -z ${exit_codes[$name]:-} ]] || return 0
  kill -TERM "${pids[$name]}" 2> /dev/null || true
  while is_running "$name"; do
    if ((SECONDS >= deadline)); then
      say "$name did not end within $STOP_DEADLINE_S s: killed"
      kill -KILL "${pids[$name]}" 2> /dev/null || true
      break
    fi
    pause 0.05
  done
  collect "$name"
}

# show_news: shows new warnings and errors of the processes.
declare -A lines_shown=()
show_news() {
  local name first last
  for name in "$source" "${PROCESSES[@]}"; do
    [[ -e $run_dir/$name.log ]] || continue
    first=$((${lines_shown[$name]:-0} + 1))
    last=$(wc -l < "$run_dir/$name.log")
    ((last >= first)) || continue
    lines_shown[$name]=$last
    sed -n "$first,$last{/: warning: \\|: error: /p}" "$run_dir/$name.log" >&2
  done
}

# show_results: the pictures and files of demo.sh. Pictures that cannot be made are no failure of the run.
show_results() {
  local file
  if [[ -s $run_dir/trajectory.tum && -s $run_dir/ground_truth.tum ]]; then
    "$AIRDOS_BIN/airdos-evaluate" trajectory --estimate "$run_dir/trajectory.tum" --ground-truth "$run_dir/ground_truth.tum" \
      --json "$run_dir/evaluation.json" --plot "$run_dir/trajectory.png" --force || say "no picture of the trajectory (see above)"
  fi
  if [[ -s $run_dir/map.airdos ]]; then
    "$AIRDOS_BIN/airdos-map" plot "$run_dir/map.airdos" --out "$run_dir/map.png" --force || say "no picture of the map (see above)"
  fi
  say "results:"
  for file in "$run_dir"/*; do printf '  %9s  %s\n' "$(du -h "$file" | cut -f1)" "$file"; done
}

# finish [CODE]: stops sources first and the recorder last, so that it records everything. Exits with at least CODE.
finish() {
  local name bad=${1:-0}
  for name in "$source" "${PROCESSES[@]}"; do
    if [[ -n ${pids[$name]:-} ]]; then stop "$name"; fi
  done
  show_news
  sed -n 's/^[^ ]* airdos-optimizer: info: \(poses: .*\)/\1/p' "$run_dir/optimizer.log" 2> /dev/null | tail -n 1
  for name in "${!exit_codes[@]}"; do
    say "$name: exit code ${exit_codes[$name]}"
    ((exit_codes[$name] == 0)) || bad=1
  done
  if ((${#source_arguments[@]} > 0 && bad == 0)); then show_results; fi
  say "results and logs: $run_dir"
  if ((${exit_codes[$source]:-0} == EXIT_BAD_INPUT)); then exit "$EXIT_BAD_INPUT"; fi
  exit "$bad"
}

# Reports what airdos-doctor finds wrong with the machine in this network; silent if nothing is.
consult_doctor() {
  [[ -x $AIRDOS_BIN/airdos-doctor ]] || return 0
  "$AIRDOS_BIN/airdos-doctor" --lcm-url "$url" --run-dir "$run_dir" --round-trip never 2>&1 |
    sed -n '/^OK\|^WARN spy/!s/^/airdos-doctor: /p' >&2 || true
}

wait_until_ready() {
  local name=$1 deadline=$((SECONDS + READY_DEADLINE_S))
  until grep -q ' READY ' "$run_dir/$name.log"; do
    if ! is_running "$name"; then
      tail -n 5 "$run_dir/$name.log" >&2
      say "$name ended before it was ready$([[ $name != person-detector ]] || echo " (--no-detect runs without it)")" >&2
      consult_doctor
      finish 1
    fi
    ((SECONDS < deadline)) || { say "$name is not READY after $READY_DEADLINE_S s" >&2 && consult_doctor && finish 1; }
    [[ $stopping == no ]] || finish
    pause 0.05
  done
}

# CPU time of all processes so far, in clock ticks.
ticks() {
  local name sum=0 stat
  for name in "${PROCESSES[@]}"; do
    stat=$(cat "/proc/${pids[$name]}/stat" 2> /dev/null) || continue
    read -ra stat <<< "${stat##*) }"
    sum=$((sum + stat[11] + stat[12]))
  done
  echo "$sum"
}

# Waits until no process has worked for IDLE_S: heartbeats cost less than two ticks in half a second, frames more.
wait_until_idle() {
  local now last quiet_since=$SECONDS deadline=$((SECONDS + DRAIN_DEADLINE_S))
  last=$(ticks)
  while ((SECONDS - quiet_since < IDLE_S)) && [[ $stopping == no ]]; do
    ((SECONDS < deadline)) || { say "the processes are still busy after $DRAIN_DEADLINE_S s" && return; }
    pause 0.5
    now=$(ticks)
    if ((now - last > 2)); then quiet_since=$SECONDS; fi
    last=$now
  done
}

# report_ended: names each process that has ended once; the others continue.
report_ended() {
  local name
  for name in "${PROCESSES[@]}"; do
    if [[ -z ${exit_codes[$name]:-} ]] && ! is_running "$name"; then
      collect "$name"
      say "$name ended with exit code ${exit_codes[$name]}; the others continue.$([[ $name == record ]] || echo " To restart it:")"
      [[ $name != record ]] || continue # it would begin another log
      # The recorder finds its unfinished map there and continues it.
      say "  nsenter -t $$ -n -- $AIRDOS_BIN/airdos-$name --lcm-url '$url' --pace $pace$(
        [[ $name != map-recorder ]] || echo " --set output.directory='$run_dir'"
      )"
    fi
  done
}

{
  echo "pid=$$"
  echo "url=$url"
  [[ -z $log ]] || echo "played=$log"
} > "$run_dir/state"

# configuration PROCESS: fills the array configured: its overrides, and that it writes all its options to the run's folder, like
# airdos-replay.
configuration() {
  local setting
  configured=(--resolved-config "$run_dir/$1.yaml")
  for setting in "${settings[@]}"; do
    [[ $setting != "$1:"* ]] || configured+=(--set "$setting")
  done
}

arguments=(--lcm-url "$url" --pace "$pace")
# People are found later than the 0.2 s after which a process goes on without them.
patience=()
if [[ $detect == yes && $pace == realtime ]]; then patience=(--deadline-s 0.6); fi
for name in frontend human-tracker optimizer map-recorder person-detector; do
  [[ " ${PROCESSES[*]} " == *" $name "* ]] || continue
  configuration "${name//-/_}"
  if [[ $name == map-recorder ]]; then configured+=(--set "output.directory=$run_dir"); fi
  start "$name" "$AIRDOS_BIN/airdos-$name" "${arguments[@]}" "${patience[@]}" "${configured[@]}"
done
if [[ $record == yes ]]; then
  outputs='STATIC_FEATURES|HUMAN_OBSERVATIONS|STATE_ESTIMATE|MAP_UPDATE|PERSON_KEYPOINTS_LEFT|PERSON_KEYPOINTS_RIGHT|PERSON_MASK'
  start record "$AIRDOS_BIN/airdos-record" --lcm-url "$url" --out "$run_dir/output.lcm" --channels "$outputs" --force
fi
for process in "${PROCESSES[@]}"; do wait_until_ready "$process"; done
say "READY: ${PROCESSES[*]} on $url"
if [[ $detect == yes && $pace == realtime ]]; then
  say "realtime: the detector looks at every second image, reduced to 256 px, unless --set person_detector:... says otherwise"
fi
if [[ $host_network == no ]]; then
  say "their network: nsenter -t $$ -n -- COMMAND; or spy.sh --namespace $$, replay_log.sh LOG --run-dir $run_dir"
fi

if [[ -n $data ]]; then player_input=(--data "$data"); else player_input=("${source_arguments[@]}"); fi
if [[ $source == player ]] && ((${#player_input[@]} > 0)); then
  player_options=()
  if ((loop > 1)); then player_options=(--loop "$loop" --one-session --say-every 500); fi
  if [[ $check == no ]]; then player_options+=(--no-check); fi
  if [[ $detect == yes ]]; then player_options+=(--without "keypoints,masks"); fi
  configuration stereo_player
  start player "$AIRDOS_BIN/airdos-stereo-player" "${player_input[@]}" "${arguments[@]}" \
    "${configured[@]}" "${player_options[@]}"
elif [[ $source == camera ]]; then
  camera_options=()
  if [[ $detect == no ]]; then camera_options=(--nobody); fi
  configuration stereo_camera
  start camera "$AIRDOS_BIN/airdos-stereo-camera" "${source_arguments[@]}" --lcm-url "$url" \
    "${configured[@]}" "${camera_options[@]}"
elif [[ -n $log ]]; then
  start player lcm-logplayer -s "$speed" -e "$channels" -l "$url" "$log"
fi
while [[ $stopping == no ]]; do
  show_news
  if [[ -n ${pids[$source]:-} ]] && ! is_running "$source"; then
    collect "$source"
    if ((exit_codes[$source] != 0)); then
      tail -n 3 "$run_dir/$source.log" >&2
      break
    fi
    say "everything has been sent; waiting for the processes"
    wait_until_idle
    break
  fi
  report_ended
  ((${#exit_codes[@]} < ${#PROCESSES[@]})) || break
  pause 0.2
done
finish
