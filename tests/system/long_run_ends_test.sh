#!/bin/bash
# How long_run.sh ends: what it makes of the figures of a run, whether it notices that a run failed, and that it leaves nobody running.
# A stand-in for run_live.sh leaves figures of our own; a minute takes a second.
# Usage: long_run_ends_test.sh SOURCE_DIR
set -euo pipefail
# shellcheck source=tests/system/script_checks.sh
source "$(dirname "${BASH_SOURCE[0]}")/script_checks.sh"

readonly root=$work/root
readonly results=$work/run

# The stand-in's figures are those in figures; its numbers of processes are its own.
make_run_live() {
  mkfifo "$work/run_live.fifo"
  make_program "$root/launch_scripts/run_live.sh" << FAKE
finish() {
  cp "$work/figures/"* "$results/"
  fails end && exit 1
  exit 0
}
trap finish TERM
fails state || for name in pid frontend human-tracker optimizer map-recorder; do echo "\$name=\$\$"; done > "$results/state"
exec 3<> "$work/run_live.fifo"
echo "\$\$" > "$work/started"
fails early && echo "run_live.sh: why it ends" && exit 0
read -r -u 3
FAKE
}

# Until there is something to be measured; where the run is to end early, until it has.
make_sleep() {
  local sleep
  sleep=$(command -v sleep)
  make_program "$work/bin/sleep" << FAKE
until [[ -s "$work/started" ]]; do "$sleep" 0.05; done
if fails early; then
  while read -r stat 2> /dev/null < "/proc/\$(cat "$work/started")/stat" && [[ \${stat##*) } != Z* ]]; do "$sleep" 0.05; done
fi
exec "$sleep" 0.1
FAKE
}

make_root() {
  mkdir -p "$root"/{launch_scripts,logs,build/bin} "$work/figures"
  cp "$scripts"/{common,long_run}.sh "$root/launch_scripts/"
  (($(grep -c 'minutes \* 60' "$scripts/long_run.sh") == 2)) || fail "long_run.sh counts minutes otherwise"
  sed -i 's/minutes \* 60/minutes/' "$root/launch_scripts/long_run.sh"
  echo 'project(airdos VERSION 1.2.3' > "$root/CMakeLists.txt"
  echo log > "$root/logs/road_crossing06.lcm"
  make_program "$root/build/bin/airdos-stereo-player" < /dev/null
  make_run_live
  make_sleep
}

# figures PROCESS DONE INCOMPLETE SKIPPED MISSING LATE: what it says at its end, of two cameras; the image numbers are of the left one.
figures() {
  cat > "$work/figures/$1.log" << LOG
2026-03-01T12:34:56.789Z airdos-$1: info: stopped; frames done $2, incomplete $3, skipped $4
2026-03-01T12:34:56.789Z airdos-$1: info: latency p50 12.5 ms, p99 40.5 ms
2026-03-01T12:34:56.789Z airdos-$1: info: CAMERA_LEFT: received $2, missing $5, duplicate $6, rejected 0
2026-03-01T12:34:56.789Z airdos-$1: info: CAMERA_RIGHT: received $2, missing 0, duplicate 0, rejected 0
LOG
}

# memory MB…: of the optimizer, in eight rows; the others have 10 MB.
memory() {
  local mb
  for mb in "$@"; do printf '5\t10240\t10240\t%s\t10240\n' "$((mb * 1024))"; done > "$work/figures/memory.tsv"
}

good_figures() {
  local process
  rm -rf "$results" "$work/started" "$work/figures"
  mkdir "$work/figures"
  fresh
  for process in frontend human-tracker optimizer map-recorder; do figures "$process" 100 0 0 0 0; done
}

# long_run CODE TEXT ARGUMENT…: ends so; the last line on stderr has the text.
long_run() {
  local code=$1 text=$2
  shift 2
  run "$code" "$root/launch_scripts/long_run.sh" --run-dir "$results" --minutes 1 "$@"
  if ((code != 0)); then
    [[ $(tail -n 1 "$work/err") == "long_run.sh: $text"* ]] || fail "no '$text' at the end of: $(cat "$work/err")"
  fi
  [[ -z $(pids_of run_live) ]] || fail "run_live.sh goes on"
}

good_run_gives_a_table() {
  good_figures
  long_run 0 ''
  says out '| process | frames done | incomplete | skipped | messages missing | latency ms p50 | p99 |'
  (($(grep -c '^| [a-z-]* | 100 | 0 | 0 | 0 | 12.5 | 40.5 | ' "$work/out") == 4)) || fail "rows: $(cat "$work/out")"
  diff "$work/out" "$results/long_run.md" || fail "long_run.md is another table"
  ran 1 "^run_live.sh --data $root/logs/road_crossing06.lcm --loop 1 --pace realtime --run-dir $results\$"
  # Each row of its own measurement: a time and four times the memory of one process.
  ! grep -qvE "^[0-9]+("$'\t'"[1-9][0-9]*)\1\1\1$" "$results/memory.tsv" || fail "memory: $(cat "$results/memory.tsv")"
}

lost_frames_fail_above_the_limit() {
  local kind
  # Of 200 frames: 100 * 4 <= 2 * (197 + 3).
  for kind in '197 1 3 0 0' '197 0 3 1 1'; do
    good_figures
    # shellcheck disable=SC2086
    figures human-tracker $kind
    long_run 0 '' --max-lost 2
  done
  says out '| human-tracker | 197 | 0 | 3 | 1 | 12.5 | 40.5 | '
  good_figures
  figures human-tracker 197 1 3 1 1
  long_run 1 'frames or messages were lost: is the machine fast enough, and idle? (logs: ' --max-lost 2
  good_figures
  figures frontend 100 1 0 0 0
  long_run 1 'frames or messages were lost'
}

lost_images_fail_whatever_the_limit() {
  good_figures
  figures map-recorder 100 0 0 3 2
  long_run 1 'camera images were lost in transit: see airdos-doctor' --max-lost 100
  figures map-recorder 100 0 0 3 3
  long_run 0 '' --max-lost 100
}

idle_process_fails() {
  good_figures
  figures optimizer 0 0 0 0 0
  long_run 1 'a process did nothing'
}

# The largest of the second half over the largest of the second quarter, whatever was before.
growth_fails_above_the_limit() {
  good_figures
  memory 900 900 100 90 100 130 120 110
  long_run 0 ''
  says out '| optimizer | 100 | 0 | 0 | 0 | 12.5 | 40.5 | 900.0 | 110.0 | 30.0 |'
  memory 900 900 100 120 90 90 90 90
  long_run 0 ''
  says out ' | -25.0 |'
  memory 900 900 90 100 131 100 100 100
  long_run 1 'a process grew by more than 30 %'
  says out ' | 31.0 |'
  memory 1 1 100 100 100 100 100 110
  long_run 0 '' --minutes 3
  memory 1 1 100 100 100 100 100 111
  long_run 1 'a process grew by more than 10 %' --minutes 3
}

bad_run_fails() {
  local name
  good_figures
  FAILS=early long_run 1 "the run ended early: see $results/run_live.log"
  says err "run_live.sh: why it ends"
  good_figures
  FAILS=end long_run 1 "a process ended badly: see $results/run_live.log"
  # That there are figures of an earlier run changes nothing.
  good_figures
  mkdir "$results"
  for name in memory.tsv long_run.md; do echo earlier > "$results/$name"; done
  FAILS=state long_run 1 "nothing was measured: see $results/run_live.log"
  [[ ! -e $results/long_run.md ]] || fail "a table of nothing"
}

lockstep_is_handed_on_with_rounds_enough_for_a_fast_machine() {
  good_figures
  fresh
  long_run 0 '' --pace lockstep
  ran 1 "^run_live.sh --data $root/logs/road_crossing06.lcm --loop 100 --pace lockstep --run-dir $results\$"
  long_run 2 "--pace: neither realtime nor lockstep: 'fast'" --pace fast
}

interrupted_run_leaves_nobody() {
  local pid got=0
  nobody_is_left() { [[ -z $(pids_of run_live) ]]; }
  good_figures
  "$root/launch_scripts/long_run.sh" --run-dir "$results" --minutes 1000 > "$work/long.out" 2>&1 < /dev/null &
  pid=$!
  await "the run" test -s "$work/started"
  kill -TERM "$pid"
  wait "$pid" || got=$?
  ((got == 143)) || fail "exit code $got: $(cat "$work/long.out")"
  await "the end of run_live.sh" nobody_is_left
  [[ -e $results/optimizer.log ]] || fail "run_live.sh was not asked to end"
}

make_root
PATH=$work/bin:$PATH
good_run_gives_a_table
lost_frames_fail_above_the_limit
lost_images_fail_whatever_the_limit
idle_process_fails
growth_fails_above_the_limit
bad_run_fails
lockstep_is_handed_on_with_rounds_enough_for_a_fast_machine
interrupted_run_leaves_nobody
echo "all checks passed"
