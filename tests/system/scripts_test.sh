#!/bin/bash
# What the launch scripts do with wrong options, and how run_live.sh starts, watches and ends processes (programs that only
# say READY stand in for ours).
# Usage: scripts_test.sh SOURCE_DIR
set -euo pipefail

readonly scripts=$1/launch_scripts
work=$(mktemp -d)
live_pid=
cleanup() {
  if [[ -n $live_pid ]]; then kill -TERM "$live_pid" 2> /dev/null || true; fi
  rm -rf "$work"
}
trap cleanup EXIT

fail() {
  echo "FAILED: $*"
  exit 1
}

# expect CODE TEXT COMMAND…: the exit code, and one line on stderr that has the text.
expect() {
  local code=$1 text=$2 got=0
  shift 2
  "$@" > "$work/out" 2> "$work/err" < /dev/null || got=$?
  ((got == code)) || fail "$*: exit code $got, not $code: $(cat "$work/out" "$work/err")"
  if ((code != 0)); then
    (($(wc -l < "$work/err") == 1)) || fail "$*: not one line: $(cat "$work/err")"
    grep -qF -e "$text" "$work/err" || fail "$*: '$(cat "$work/err")' does not say '$text'"
  else
    grep -qF -e "$text" "$work/out" || fail "$*: '$(cat "$work/out")' does not say '$text'"
  fi
}

await() {
  local what=$1 deadline=$((SECONDS + 60))
  shift
  until "$@"; do
    ((SECONDS < deadline)) || fail "$what did not come: $(tail -n 20 "$work"/live.out "$work"/live.err 2> /dev/null)"
    sleep 0.05
  done
}

each_script_says_its_version() {
  local script name
  for script in "$scripts"/*.sh; do
    name=$(basename "$script")
    [[ $name != *common.sh ]] || continue
    "$script" --version > "$work/out" 2>&1 < /dev/null || fail "$name --version: exit code $?"
    grep -qxE "$name [0-9]+\.[0-9]+\.[0-9]+ \(([0-9a-f]{7,}|unknown)\)" "$work/out" ||
      fail "$name --version says '$(cat "$work/out")'"
  done
}

wrong_options_exit_2_in_one_line() {
  local script
  for script in setup demo test fuzz spy run_live replay_log long_run; do
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
  expect 2 "--max-lost: not a whole number of 0 to 100: '101'" "$scripts/long_run.sh" --max-lost 101
  expect 2 "no folder or log '/nonexistent'" "$scripts/long_run.sh" /nonexistent
  expect 2 "no file '/nonexistent.lcm'" "$scripts/replay_log.sh" /nonexistent.lcm
  expect 2 "no run of run_live.sh in '/nonexistent'" "$scripts/replay_log.sh" "$0" --run /nonexistent
  expect 2 "no run of run_live.sh in '/nonexistent'" "$scripts/spy.sh" --namespace /nonexistent
  expect 2 "--seconds: not a whole number above 0: '0'" "$scripts/fuzz.sh" --seconds 0
  expect 2 "--jobs: not a whole number above 0: '0'" "$scripts/fuzz.sh" --jobs 0
  expect 1 "airdos-frontend is missing: build first" env AIRDOS_BIN="$work/none" "$scripts/run_live.sh"
}

# make_program NAME: says READY after its arguments, ends with 0 on SIGTERM.
make_program() {
  cat > "$work/bin/$1" << 'FAKE'
#!/bin/bash
trap 'echo "end of $0"; exit 0' TERM
echo "$0 READY $*"
while :; do sleep 0.05; done
FAKE
  chmod +x "$work/bin/$1"
}

start_live() {
  rm -rf "$work/run" "$work/live.out" "$work/live.err"
  env AIRDOS_BIN="$work/bin" PATH="$work/bin:$PATH" "$scripts/run_live.sh" --run-dir "$work/run" "$@" \
    > "$work/live.out" 2> "$work/live.err" < /dev/null &
  live_pid=$!
}

end_live() {
  local expected=$1 got=0
  wait "$live_pid" || got=$?
  live_pid=
  ((got == expected)) || fail "run_live.sh: exit code $got, not $expected: $(cat "$work/live.out" "$work/live.err")"
}

# pids_of NAME: of the stand-ins that run from this test's folder. (pgrep is no part of a small Debian.)
pids_of() {
  local folder
  for folder in /proc/[0-9]*; do
    if tr '\0' ' ' 2> /dev/null < "$folder/cmdline" | grep -qF "$work/bin/$1"; then echo "${folder#/proc/}"; fi
  done
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

# kill_sleep_of PID: ends a sleep that this process waits for, as Ctrl-C does.
kill_sleep_of() {
  local status
  for status in /proc/[0-9]*/status; do
    if grep -qs "^Name:.sleep" "$status" && grep -qs "^PPid:.$1\$" "$status"; then
      status=${status#/proc/}
      kill -TERM "${status%/status}" 2> /dev/null && return 0
    fi
  done
  return 1
}

stops_in_order_although_the_signal_ends_its_sleep() {
  start_live
  await "READY" grep -qs "READY: frontend" "$work/live.out"
  await "a sleep of the script" kill_sleep_of "$live_pid"
  kill -TERM "$live_pid"
  end_live 0
  grep -q "map-recorder: exit code 0" "$work/live.out" || fail "not stopped in order: $(cat "$work/live.out")"
}

others_go_on_when_one_is_killed() {
  start_live
  await "READY" grep -qs "READY: frontend" "$work/live.out"
  kill -KILL "$(sed -n 's/^optimizer=//p' "$work/run/state")"
  await "the report" grep -q "optimizer ended with exit code 137; the others go on" "$work/live.out"
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
  [[ -z $(pids_of airdos-) ]] || fail "processes are left behind"
}

each_script_says_its_version
wrong_options_exit_2_in_one_line
if ! unshare -n true 2> /dev/null && ! unshare -r -n true 2> /dev/null; then
  echo "SKIPPED: no right to make a network namespace"
  exit 77
fi
mkdir "$work/bin"
for program in frontend human-tracker optimizer map-recorder; do make_program "airdos-$program"; done
processes_start_and_end_together
stops_in_order_although_the_signal_ends_its_sleep
others_go_on_when_one_is_killed
log_is_played_into_them_and_then_all_end
failing_start_is_said
echo "all checks passed"
