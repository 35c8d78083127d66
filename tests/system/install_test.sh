#!/bin/bash
# What `cmake --install` puts into a prefix is complete and works from there.
# Usage: install_test.sh BUILD_DIR JAR|NO_JAR
set -euo pipefail

readonly build=$1 has_jar=$2
work=$(mktemp -d)
readonly work prefix=$work/prefix
live_pid=
cleanup() {
  if [[ -n $live_pid ]]; then
    kill -TERM "$live_pid" 2> /dev/null || true
    wait "$live_pid" || true
  fi
  rm -rf "$work"
}
trap cleanup EXIT

fail() {
  echo "FAILED: $*"
  exit 1
}

everything_is_where_users_look() {
  local file
  for file in share/doc/airdos/{LICENSE,THIRD_PARTY_LICENSES.md,README.md} share/airdos/lcmtypes/image_t.lcm \
    share/airdos/scripts/{run_live,replay_log,spy,network_setup,keep_map}.sh share/airdos/logs/road_crossing06.lcm \
    {bin,share/bash-completion/completions}/airdos-{run-live,replay-log,spy,network-setup,keep-map,check}; do
    [[ -s $prefix/$file ]] || fail "$file is not installed"
  done
  if [[ $has_jar == JAR ]]; then [[ -s $prefix/share/java/airdos.jar ]] || fail "airdos.jar is not installed"; fi
  for file in "$prefix"/share/airdos/lcmtypes/*.lcm; do
    echo "#include <airdos/$(basename "$file" .lcm).hpp>"
  done > "$work/all_types.cc"
  "${CXX:-c++}" -std=c++17 -fsyntax-only -I "$prefix/include" "$work/all_types.cc" || fail "the headers do not compile"
}

programs_start() {
  local program
  for program in "$prefix"/bin/*; do
    "$program" --help > "$work/help" || fail "$program --help"
    ! grep -q "launch_scripts" "$work/help" || fail "$program looks into the source tree: $(cat "$work/help")"
  done
}

processes_run_from_there() {
  "$prefix/share/airdos/scripts/run_live.sh" --run-dir "$work/run" > "$work/live.out" 2>&1 < /dev/null &
  live_pid=$!
  local deadline=$((SECONDS + 60)) code=0
  until grep -q "READY: frontend" "$work/live.out"; do
    if ((SECONDS >= deadline)) || ! kill -0 "$live_pid" 2> /dev/null; then fail "not READY: $(cat "$work/live.out")"; fi
    sleep 0.05
  done
  kill -TERM "$live_pid"
  wait "$live_pid" || code=$?
  live_pid=
  ((code == 0)) || fail "run_live.sh: exit code $code: $(cat "$work/live.out")"
  local process
  for process in frontend human_tracker optimizer map_recorder; do
    grep -q " config $prefix/share/airdos/config/$process.yaml" "$work/run/${process//_/-}.log" ||
      fail "$process has another configuration: $(cat "$work/run/${process//_/-}.log")"
    [[ -s $work/run/$process.yaml ]] || fail "$process leaves no configuration"
  done
}

# Without a network: each says in one line what is wrong in the file that it reads.
configurations_are_read_from_there() {
  local file process code
  local -a arguments
  for file in "$prefix"/share/airdos/config/*.yaml; do
    printf 'bogus:\n  key: 1\n' >> "$file"
    process=$(basename "$file" .yaml)
    # It looks for its networks, which need not be there, before it looks for keys that it does not know.
    if [[ $process == person_detector ]]; then sed -i 's/head: movenet /head: nothing /' "$file"; fi
    arguments=(--lcm-url memq://) code=0
    if [[ $process == stereo_player ]]; then arguments+=(--data "$work"); fi
    if [[ $process == stereo_camera ]]; then arguments+=(--camera /dev/null --side-by-side --calibration "$work/none.yaml"); fi
    if [[ $process == map_recorder ]]; then arguments+=(--run-dir "$work/map"); fi
    "$prefix/bin/airdos-${process//_/-}" "${arguments[@]}" > "$work/out" 2>&1 || code=$?
    ((code == 2)) || fail "$process: exit code $code, not 2: $(cat "$work/out")"
    grep -qF "$file" "$work/out" || fail "$process does not read $file: $(cat "$work/out")"
  done
}

cmake --install "$build" --prefix "$prefix" > "$work/install.log" 2>&1 || fail "$(tail -n 5 "$work/install.log")"
everything_is_where_users_look
programs_start
if unshare -n true 2> /dev/null || unshare -r -n true 2> /dev/null; then
  processes_run_from_there
else
  echo "no right to make a network namespace: the processes are not run together"
fi
configurations_are_read_from_there
echo "all checks passed"
