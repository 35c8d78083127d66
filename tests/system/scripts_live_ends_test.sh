#!/bin/bash
# How run_live.sh and replay_log.sh end: exit codes, what they say, what and whom they leave behind. Programs that only say READY
# stand in for ours; run_live.sh is a copy that waits for a second where the real one waits for many.
# Usage: scripts_live_ends_test.sh SOURCE_DIR
set -euo pipefail
# shellcheck source=tests/system/script_checks.sh
source "$(dirname "${BASH_SOURCE[0]}")/script_checks.sh"

readonly log=$source_dir/CMakeLists.txt # any file: the stand-ins do not read it
readonly url='udpm://239.255.76.67:7667?ttl=0'
readonly channels='^(CAMERA_LEFT|CAMERA_RIGHT|CALIBRATION|PERSON_KEYPOINTS_LEFT|PERSON_KEYPOINTS_RIGHT|PERSON_MASK|GROUND_TRUTH)$'
readonly processes=(frontend human-tracker optimizer map-recorder)
readonly root=$work/root
live=$root/launch_scripts/run_live.sh

make_stand_ins() {
  local process
  for process in "${processes[@]}"; do make_process "airdos-$process"; done
  mkfifo "$work/player.fifo"
  make_program "$work/bin/lcm-logplayer" << FAKE
fails player && echo "no such file" && exit 3
readlink /proc/self/ns/net > "$work/network_of_player"
[[ -z \${HOLD:-} ]] || read -r < "$work/player.fifo"
FAKE
  make_program "$work/bin/airdos-stereo-player" << 'FAKE'
fails input && echo "airdos-stereo-player: no calibration" && exit 2
fails player && echo "airdos-stereo-player: lost" && exit 4
exit 0
FAKE
  make_program "$work/bin/airdos-stereo-camera" << FAKE
fails camera && echo "airdos-stereo-camera: no such device" && exit 2
echo "2026-03-01T12:34:56.789Z airdos-stereo-camera: warning: 2.3 s behind, growing: airdos-optimizer has done image 7 of 30"
for file in map.airdos trajectory.tum ground_truth.tum; do fails nothing || echo one > "$work/run/\$file"; done
exit 0
FAKE
  make_program "$work/bin/airdos-map" <<< 'fails map && exit 1; exit 0'
  make_program "$work/bin/airdos-evaluate" < /dev/null
  make_program "$work/bin/airdos-check" << 'FAKE'
fails unreadable && echo "airdos-check: no such thing" && exit 2
fails check || exit 0
echo "log: error: no calibration"
echo "1 error"
exit 1
FAKE
}

# change NAME VALUE: another value of a constant in the copy of run_live.sh, until restore.
change() {
  grep -q "^readonly $1=" "$live" || fail "run_live.sh has no constant $1"
  sed -i "s/^readonly $1=.*/readonly $1=$2/" "$live"
}
restore() { cp "$work/run_live.sh" "$live"; }

make_root() {
  mkdir -p "$root"/{launch_scripts,logs,build}
  cp "$scripts"/*.sh "$root/launch_scripts/"
  ln -s "$work/bin" "$root/build/bin"
  echo 'project(airdos VERSION 1.2.3' > "$root/CMakeLists.txt"
  echo log > "$root/logs/road_crossing06.lcm"
  change IDLE_S 1
  cp "$live" "$work/run_live.sh"
}

# --- replay_log.sh, into a run in this test's own network

# make_run PID: what run_live.sh leaves of a run that goes on.
make_run() {
  fresh
  mkdir -p "$work/run"
  printf '%s\n' "pid=$1" "url=$url" > "$work/run/state"
}

# shellcheck disable=SC2120
replay_log() { "$scripts/replay_log.sh" "$log" --run-dir "$work/run" "$@"; }

# played COUNT: how many plays the run knows of.
played() { (($(grep -c "^played=$log\$" "$work/run/state" || true) == $1)) || fail "not $1 plays: $(cat "$work/run/state")"; }

replay_is_the_player_itself() {
  make_run $$
  run 0 replay_log
  ends_with out "replay_log.sh: $log to $url at speed 1"
  ran 1 "^airdos-check --quick $log\$"
  grep -qxF "lcm-logplayer -s 1 -e $channels -l $url $log" "$work/calls" || fail "calls: $(cat "$work/calls")"
  played 1
  make_run $$
  FAILS=player run 3 replay_log
}

replay_again_is_another_session() {
  make_run $$
  run 0 replay_log
  run 0 replay_log --speed 2.5
  ran 1 "^lcm-logplayer"
  ran 1 "^airdos-stereo-player --log $log --session [0-9]{16} --no-check --lcm-url udpm://.* --pace realtime --speed 2.5\$"
  run 0 replay_log --speed 0.0
  ran 1 '--pace lockstep$'
  (($(sed -n 's/.*--session \([0-9]*\).*/\1/p' "$work/calls" | sort -u | wc -l) == 2)) || fail "sessions: $(cat "$work/calls")"
  played 3
  FAILS=player run 4 replay_log
}

replay_of_a_bad_log_is_refused() {
  make_run $$
  FAILS=check expect 2 "'$log' cannot be used: 'airdos-check $log' says why" replay_log
  ran 0 lcm-logplayer
  played 0
  FAILS=check run 0 replay_log --no-check
  ran 1 lcm-logplayer
  rm "$work/run/state"
  expect 2 "no run of run_live.sh in '$work/run'" replay_log
}

replay_into_a_run_that_has_ended_is_refused() {
  local gone
  true &
  gone=$!
  wait "$gone"
  make_run "$gone"
  expect 1 "process $gone is not running" replay_log
  make_run nonsense
  expect 2 "not a process id: 'nonsense'" replay_log
  ran 0 lcm-logplayer
  played 0
}

replay_that_is_interrupted_leaves_nobody() {
  local pid got=0
  make_run $$
  rm -f "$work/network_of_player"
  HOLD=1 "$scripts/replay_log.sh" "$log" --run-dir "$work/run" > "$work/replay.out" 2>&1 < /dev/null &
  pid=$!
  await "the player" test -s "$work/network_of_player"
  [[ $(pids_of lcm-logplayer) == "$pid" ]] || fail "the player $(pids_of lcm-logplayer) is not the script $pid"
  kill -TERM "$pid"
  wait "$pid" || got=$?
  ((got == 143)) || fail "replay_log.sh: exit code $got"
  [[ -z $(pids_of lcm-logplayer) ]] || fail "the player goes on"
}

replay_without_lcm_says_so() {
  make_run $$
  expect 1 "lcm-logplayer is missing: 'apt-get install liblcm-bin'" env PATH="$work/tools" bash "$scripts/replay_log.sh" "$log" \
    --run-dir "$work/run"
}

# --- run_live.sh, in a network of its own

ready() {
  start_live
  await "READY" grep -qs "READY: frontend" "$work/live.out"
}

# live_says out|err TEXT
live_says() { grep -qF -e "$2" "$work/live.$1" || fail "no '$2' in: $(cat "$work/live.out" "$work/live.err")"; }

# all_ended CODE: of each process, but those named.
all_ended() {
  local code=$1 process
  shift
  for process in "${processes[@]}"; do
    if [[ " $* " != *" $process "* ]]; then live_says out "run_live.sh: $process: exit code $code"; fi
  done
  [[ $(tail -n 1 "$work/live.out") == "run_live.sh: results and logs: $work/run" ]] || fail "last: $(tail -n 1 "$work/live.out")"
}

replay_goes_on_when_a_process_dies() {
  local pid got=0
  ready
  fresh
  rm "$work/network_of_player"
  HOLD=1 replay_log > "$work/replay.out" 2>&1 < /dev/null &
  pid=$!
  await "the player" test -s "$work/network_of_player"
  [[ $(cat "$work/network_of_player") == "$(readlink "/proc/$live_pid/ns/net")" ]] || fail "played into another network"
  kill -KILL "$(sed -n 's/^optimizer=//p' "$work/run/state")"
  await "the report" grep -q "optimizer ended with exit code 137; the others continue" "$work/live.out"
  echo > "$work/player.fifo"
  wait "$pid" || got=$?
  ((got == 0)) || fail "replay_log.sh: exit code $got: $(cat "$work/replay.out")"
  kill -TERM "$live_pid"
  end_live 1
  all_ended 0 optimizer
  run 1 replay_log
  says err "process $live_pid is not running"
}

live_ends_when_all_have_ended() {
  local process
  ready
  for process in "${processes[@]}"; do tell "airdos-$process" 0; done
  end_live 0
  all_ended 0
  ready
  tell airdos-frontend 5
  await "how to start it again" grep -qF "nsenter -t $live_pid -n -- $work/bin/airdos-frontend --lcm-url '$url' --pace lockstep" \
    "$work/live.out"
  live_says out "frontend ended with exit code 5; the others continue. To restart it:"
  for process in human-tracker optimizer map-recorder; do tell "airdos-$process" 0; done
  end_live 1
  live_says out "run_live.sh: frontend: exit code 5"
  all_ended 0 frontend
}

live_ends_as_its_player_does() {
  start_live --data "$log"
  end_live 0
  live_says out 'everything has been sent; waiting for the processes'
  all_ended 0
  FAILS=player start_live --data "$log"
  end_live 1
  live_says err 'airdos-stereo-player: lost'
  live_says out 'run_live.sh: player: exit code 4'
  all_ended 0
  FAILS=input start_live --data "$log"
  end_live 2
  live_says err 'airdos-stereo-player: no calibration'
  all_ended 0
}

# started_with PROCESS TEXT: its stand-in notes its arguments in its log.
started_with() { grep -qF -e "$2" "$work/run/$1.log" || fail "$1 was not started with '$2': $(cat "$work/run/$1.log")"; }

live_takes_a_camera_and_makes_what_the_demo_makes() {
  local process
  make_process airdos-person-detector
  make_process airdos-record
  fresh
  start_live --camera "$log" --side-by-side --rate 30 --calibration "$log" "$log" --capture-size 640x240
  end_live 0
  for process in "${processes[@]}" person-detector; do
    started_with "$process" "--pace realtime"
    live_says out "run_live.sh: $process: exit code 0"
    started_with "$process" "--deadline-s 0.6 --resolved-config $work/run/${process//-/_}.yaml"
  done
  started_with person-detector "--set person_detector:time.detect_every=2 --set person_detector:network.short_side_px=256"
  live_says out 'run_live.sh: realtime: the detector looks at every second image, reduced to 256 px, unless'
  ran 1 "^airdos-stereo-camera --camera $log --calibration $log $log --side-by-side --rate 30 --capture-size 640x240 --lcm-url udpm://.* \
--resolved-config $work/run/stereo_camera.yaml\$"
  live_says err 'airdos-stereo-camera: warning: 2.3 s behind, growing'
  live_says out 'run_live.sh: camera: exit code 0'
  ran 1 "^airdos-evaluate trajectory --estimate $work/run/trajectory.tum --ground-truth $work/run/ground_truth.tum .* --plot $work/run/trajectory.png"
  ran 1 "^airdos-map plot $work/run/map.airdos --out $work/run/map.png --force\$"
  live_says out "$work/run/map.airdos"
  all_ended 0
  ! [[ -e $work/run/record.log ]] || fail "a camera was recorded unasked"
  FAILS=map start_live --camera "$log" --over-under --calibration "$log" --no-detect --pace lockstep
  end_live 0
  live_says out 'run_live.sh: no picture of the map (see above)'
  ran 1 "^airdos-stereo-camera .* --over-under .*--nobody\$"
  ! [[ -e $work/run/person-detector.log ]] || fail "the detector was started"
  started_with optimizer "--pace lockstep"
  if grep -q -e "--deadline-s\|--set" "$work/run/optimizer.log"; then fail "optimizer.log: $(cat "$work/run/optimizer.log")"; fi
  FAILS=camera start_live --camera "$log" --side-by-side --calibration "$log" --no-detect
  end_live 2
  live_says err 'airdos-stereo-camera: no such device'
  all_ended 0
  start_live --camera "$log" --side-by-side --calibration "$log" --no-detect --record
  end_live 0
  started_with record "--out $work/run/output.lcm --channels STATIC_FEATURES|"
}

live_plays_a_recording() {
  fresh
  start_live --video "$log" "$log" --calibration "$log" --swap
  end_live 0
  ran 1 "^airdos-stereo-player --video $log $log --calibration $log --swap --lcm-url udpm://.* --pace lockstep .*--without keypoints,masks\$"
  started_with person-detector "--pace lockstep"
  live_says out "run_live.sh: record: exit code 0"
  started_with record "--out $work/run/output.lcm"
  ran 0 "^airdos-(map|evaluate)"
  start_live --images "$work" --times "$log" --calibration "$log" --no-detect --pace realtime
  end_live 0
  ran 1 "^airdos-stereo-player --images $work --calibration $log --times $log --lcm-url udpm://.* --pace realtime --resolved-config $work/run/stereo_player.yaml\$"
}

live_sets_a_value_of_one_process() {
  fresh
  start_live --images "$work" --times "$log" --calibration "$log" --pace realtime --set person_detector:time.detect_every=1 \
    --set optimizer:window.num_frames=7 --set stereo_player:image.max_image_bytes=50000
  end_live 0
  started_with person-detector "--set person_detector:network.short_side_px=256 --set person_detector:time.detect_every=1"
  started_with optimizer "--set optimizer:window.num_frames=7"
  ran 1 "^airdos-stereo-player .* --set stereo_player:image.max_image_bytes=50000 "
  if grep -q -e --set "$work/run/frontend.log"; then fail "frontend.log: $(cat "$work/run/frontend.log")"; fi
  local -a live_here=(env AIRDOS_BIN="$work/bin" "$live" --run-dir "$work/other")
  expect 2 "--set: 'window.num_frames=7' is not PROCESS:section.key=value" "${live_here[@]}" --set window.num_frames=7
  expect 2 "--set: 'recorder:a.b=7' is not PROCESS:section.key=value" "${live_here[@]}" --set recorder:a.b=7
}

live_says_that_it_can_do_without_a_detector() {
  rm "$work/bin/airdos-person-detector"
  make_script airdos-person-detector <<< 'echo "no networks"'
  start_live --video "$log" "$log" --calibration "$log"
  end_live 1
  live_says err 'no networks'
  live_says err 'run_live.sh: person-detector ended before it was ready (--no-detect runs without it)'
}

live_refuses_what_is_no_source() {
  local -a live_here=(env AIRDOS_BIN="$work/bin" "$live" --run-dir "$work/other")
  expect 2 "--camera: the calibration is missing: --calibration FILE" "${live_here[@]}" --camera "$log"
  expect 2 "--calibration is for --camera, --video and --images" "${live_here[@]}" --calibration "$log"
  expect 2 "--rate is for --camera, --video and --images" "${live_here[@]}" --rate 5
  expect 2 "--data and --video exclude each other" "${live_here[@]}" --data "$log" --video "$log" --calibration "$log"
  expect 2 "--camera needs a value" "${live_here[@]}" --camera --calibration "$log"
  expect 2 "--camera: no device '/nope'" "${live_here[@]}" --camera /nope --calibration "$log"
  expect 2 "--video: no file '/nope'" "${live_here[@]}" --video /nope --calibration "$log"
  expect 2 "--images: no folder '$log'" "${live_here[@]}" --images "$log" --calibration "$log"
  expect 2 "--calibration: no file '/nope'" "${live_here[@]}" --camera "$log" --calibration /nope
}

# make_optimizer COMMANDS: one that runs these, then waits.
make_optimizer() {
  make_script airdos-optimizer << FAKE
$1
exec 3<> "$work/airdos-optimizer.fifo"
while :; do read -r -u 3; done
FAKE
}

# The optimizer works for about half a second of processor time, and fails if it is ended before it has done so.
# shellcheck disable=SC2016
live_waits_for_what_was_sent() {
  change IDLE_S 3
  make_optimizer 'done=7; trap "exit \$done" TERM; echo "airdos-optimizer: READY now"
    read -r -u 3 3<> "'"$work"'/airdos-optimizer.fifo"
    for ((i = 0; i < 200000; ++i)); do :; done; done=0'
  start_live --data "$log"
  await "the player" grep -qs "everything has been sent" "$work/live.out"
  tell airdos-optimizer go
  end_live 0
  restore
}

live_says_what_its_processes_say() {
  make_optimizer 'echo "airdos-optimizer: READY now"; echo "2026-03-01T12:34:56.789Z airdos-optimizer: warning: it is dark"
    trap "echo 2026-03-01T12:34:56.789Z airdos-optimizer: info: poses: 7 from images; exit 1" TERM'
  ready
  await "the warning" grep -q "airdos-optimizer: warning: it is dark" "$work/live.err"
  kill -TERM "$live_pid"
  end_live 1
  (($(grep -c dark "$work/live.err") == 1)) || fail "the warning is not shown once: $(cat "$work/live.err")"
  grep -qx "poses: 7 from images" "$work/live.out" || fail "no tally: $(cat "$work/live.out")"
  live_says out 'run_live.sh: optimizer: exit code 1'
  all_ended 0 optimizer
}

# Nothing is said here of the others: on a busy machine they may take as long.
live_kills_who_does_not_end() {
  change STOP_DEADLINE_S 1
  make_optimizer 'trap "" TERM; echo "airdos-optimizer: READY now"'
  ready
  kill -TERM "$live_pid"
  end_live 1
  live_says out 'run_live.sh: optimizer did not end within 1 s: killed'
  live_says out 'run_live.sh: optimizer: exit code 137'
  restore
}

live_fails_if_one_ends_before_it_is_ready() {
  make_script airdos-optimizer <<< 'echo "nothing to do"'
  start_live
  end_live 1
  live_says err 'nothing to do'
  live_says err 'run_live.sh: optimizer ended before it was ready'
}

# The front end is the first that is waited for.
live_fails_if_one_is_not_ready() {
  change READY_DEADLINE_S 1
  mv "$work/bin/airdos-frontend" "$work/frontend"
  make_script airdos-frontend <<< "trap 'exit 0' TERM; exec 3<> '$work/airdos-frontend.fifo'; read -r -u 3"
  start_live
  end_live 1
  live_says err 'run_live.sh: frontend is not READY after 1 s'
  restore
  mv "$work/frontend" "$work/bin/airdos-frontend"
}

# That it is interrupted before all are ready is no failure.
live_that_is_interrupted_early_is_well() {
  local process
  make_optimizer 'trap "exit 0" TERM; echo "no READY"'
  start_live
  for process in "${processes[@]}"; do await "$process" grep -qs READY "$work/run/$process.log"; done
  kill -TERM "$live_pid"
  end_live 0
  all_ended 0
}

# It cannot end anybody then, so they end by themselves.
live_that_is_killed_leaves_nobody() {
  nobody_is_left() { [[ -z $(pids_of airdos-) ]]; }
  ready
  kill -KILL "$live_pid"
  await "their end" nobody_is_left
  end_live 137
}

live_refuses_before_it_starts_anybody() {
  FAILS=check start_live --log "$log"
  end_live 2
  live_says err 'log: error: no calibration'
  live_says err "'$log' cannot be used (see above; --no-check plays it anyway)"
  FAILS=unreadable start_live --log "$log"
  end_live 2
  live_says err 'airdos-check: no such thing'
  ! [[ -e $work/run/state ]] || fail "a run was begun"
  mkdir -p "$work/other"
  echo mine > "$work/other/frontend.log"
  expect 2 "$work/other/frontend.log was not written by a run; --force replaces it" env AIRDOS_BIN="$work/bin" "$live" --run-dir "$work/other"
  ready
  expect 2 "another run_live.sh is writing to $work/run" env AIRDOS_BIN="$work/bin" "$live" --run-dir "$work/run"
  kill -TERM "$live_pid"
  end_live 0
}

make_root
make_stand_ins
link_tools bash basename date dirname grep readlink sed
export AIRDOS_BIN=$work/bin
PATH=$work/bin:$PATH
replay_is_the_player_itself
replay_again_is_another_session
replay_of_a_bad_log_is_refused
replay_into_a_run_that_has_ended_is_refused
replay_that_is_interrupted_leaves_nobody
replay_without_lcm_says_so
live_refuses_what_is_no_source
skip_unless_networks
replay_goes_on_when_a_process_dies
live_ends_when_all_have_ended
live_ends_as_its_player_does
live_takes_a_camera_and_makes_what_the_demo_makes
live_plays_a_recording
live_sets_a_value_of_one_process
live_says_that_it_can_do_without_a_detector
live_refuses_before_it_starts_anybody
live_that_is_killed_leaves_nobody
live_waits_for_what_was_sent
live_says_what_its_processes_say
live_kills_who_does_not_end
live_that_is_interrupted_early_is_well
live_fails_if_one_ends_before_it_is_ready
live_fails_if_one_is_not_ready
echo "all checks passed"
