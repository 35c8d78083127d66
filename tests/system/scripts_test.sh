#!/bin/bash
# What the launch scripts do with wrong options, and how run_live.sh starts, watches and ends processes (programs that only
# say READY stand in for ours).
# Usage: scripts_test.sh SOURCE_DIR
set -euo pipefail

# shellcheck source=tests/system/script_checks.sh
source "$(dirname "${BASH_SOURCE[0]}")/script_checks.sh"

each_script_says_its_version() {
  local script name
  for script in "$scripts"/*.sh "$scripts"/benchmark/*.sh; do
    name=$(basename "$script")
    [[ $name != *common.sh ]] || continue
    "$script" --version > "$work/out" 2>&1 < /dev/null || fail "$name --version: exit code $?"
    grep -qxE "$name [0-9]+\.[0-9]+\.[0-9]+ \(([0-9a-f]{7,}|unknown)\)" "$work/out" ||
      fail "$name --version says '$(cat "$work/out")'"
  done
}

wrong_options_exit_2_in_one_line() {
  local script
  for script in setup demo test lint docs fuzz spy run_live replay_log long_run package keep_map network_setup; do
    expect 0 "Usage: launch_scripts/$script.sh" "$scripts/$script.sh" --help
    expect 2 "--no-such-option" "$scripts/$script.sh" --no-such-option
  done
  expect 2 "no readable file '/nonexistent.lcm'" "$scripts/demo.sh" --log /nonexistent.lcm
  expect 2 "--log needs a value" "$scripts/demo.sh" --log
  expect 2 "--data: no folder '/nonexistent'" "$scripts/run_live.sh" --data /nonexistent
  expect 2 "--pace: 'fast'" "$scripts/run_live.sh" --pace fast
  expect 2 "--speed: not a number: 'x'" "$scripts/run_live.sh" --speed x
  expect 2 "exclude each other" "$scripts/run_live.sh" --data / --log "$0"
  expect 2 "--minutes: not a whole number above 0: '0'" "$scripts/long_run.sh" --minutes 0
  expect 2 "--max-lost: not a whole number from 0 to 100: '101'" "$scripts/long_run.sh" --max-lost 101
  expect 2 "no folder or log '/nonexistent'" "$scripts/long_run.sh" /nonexistent
  expect 2 "no file '/nonexistent.lcm'" "$scripts/replay_log.sh" /nonexistent.lcm
  expect 2 "no run of run_live.sh in '/nonexistent'" "$scripts/replay_log.sh" "$0" --run /nonexistent
  expect 2 "no run of run_live.sh in '/nonexistent'" "$scripts/spy.sh" --namespace /nonexistent
  expect 2 "--seconds: not a whole number above 0: '0'" "$scripts/fuzz.sh" --seconds 0
  expect 2 "--jobs: not a whole number above 0: '0'" "$scripts/fuzz.sh" --jobs 0
  expect 2 "which folder? One, not 2" "$scripts/keep_map.sh" /a /b
  expect 2 "--out needs a value" "$scripts/package.sh" --out
  expect 1 "airdos-frontend is missing: build it" env AIRDOS_BIN="$work/none" "$scripts/run_live.sh"
}

processes_start_and_end_together() {
  start_live
  await "READY" grep -qs "READY: frontend" "$work/live.out"
  [[ $(readlink "/proc/$live_pid/ns/net") != "$(readlink /proc/self/ns/net)" ]] || fail "no network of its own"
  grep -q "^pid=$live_pid\$" "$work/run/state" || fail "state: $(cat "$work/run/state")"
  kill -TERM "$live_pid"
  end_live 0
  local process
  for process in frontend human-tracker optimizer map-recorder; do
    grep -q "$process: exit code 0" "$work/live.out" || fail "no exit code of $process: $(cat "$work/live.out")"
    grep -q "end of .*$process" "$work/run/$process.log" || fail "$process was not asked to end"
    grep -q -e "--resolved-config $work/run/${process//-/_}.yaml" "$work/run/$process.log" ||
      fail "$process does not leave its configuration: $(cat "$work/run/$process.log")"
  done
}

# A sleep that says its number and waits, once there is a file hold_sleep.
make_sleep() {
  mkfifo "$work/sleep.fifo"
  make_script sleep << FAKE
[[ -e "$work/hold_sleep" ]] || exec "$(command -v sleep)" "\$@"
exec 3<> "$work/sleep.fifo"
echo "\$\$" > "$work/sleeping"
read -r -u 3
FAKE
}

# Ctrl-C reaches the script, which sees it when its sleep has ended, and that sleep, which fails.
stops_in_order_although_the_signal_ends_its_sleep() {
  make_sleep
  start_live
  await "READY" grep -qs "READY: frontend" "$work/live.out"
  : > "$work/hold_sleep"
  await "a sleep of the script" test -s "$work/sleeping"
  rm "$work/hold_sleep"
  kill -TERM "$live_pid"
  kill -TERM "$(cat "$work/sleeping")"
  end_live 0
  grep -q "map-recorder: exit code 0" "$work/live.out" || fail "not stopped in order: $(cat "$work/live.out")"
  rm "$work/bin/sleep"
}

others_go_on_when_one_is_killed() {
  start_live
  await "READY" grep -qs "READY: frontend" "$work/live.out"
  kill -KILL "$(sed -n 's/^optimizer=//p' "$work/run/state")"
  await "the report" grep -q "optimizer ended with exit code 137; the others continue" "$work/live.out"
  [[ -n $(pids_of airdos-frontend) ]] || fail "the frontend does not go on"
  kill -TERM "$live_pid"
  end_live 1
  grep -q "frontend: exit code 0" "$work/live.out" || fail "the frontend did not end well"
}

log_is_played_into_them_and_then_all_end() {
  printf '#!/bin/bash\necho "played $*"\n' > "$work/bin/lcm-logplayer"
  chmod +x "$work/bin/lcm-logplayer"
  start_live --log "$0" --speed 2
  end_live 0
  grep -q "played -s 2 -e .*CAMERA_LEFT.* $0" "$work/run/player.log" || fail "player: $(cat "$work/run/player.log")"
}

failing_start_is_said() {
  printf '#!/bin/bash\necho "no such key: typo" >&2\nexit 2\n' > "$work/bin/airdos-optimizer"
  start_live
  end_live 1
  grep -q "no such key: typo" "$work/live.err" || fail "the reason is not shown: $(cat "$work/live.err")"
  grep -q "optimizer ended before it was ready" "$work/live.err" || fail "not said: $(cat "$work/live.err")"
}

each_script_says_its_version
wrong_options_exit_2_in_one_line
skip_unless_networks
for program in frontend human-tracker optimizer map-recorder; do make_process "airdos-$program"; done
processes_start_and_end_together
stops_in_order_although_the_signal_ends_its_sleep
others_go_on_when_one_is_killed
log_is_played_into_them_and_then_all_end
failing_start_is_said
echo "all checks passed"
