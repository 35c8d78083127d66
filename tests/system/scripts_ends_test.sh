#!/bin/bash
# How demo.sh, test.sh and fuzz.sh end: exit codes, what they say last, what they leave. They run in a folder that looks like the
# source tree, with stand-ins for cmake, apt-get, clang and our programs, which fail where FAILS names them; ctest is the real one.
# Usage: scripts_ends_test.sh SOURCE_DIR
set -euo pipefail
# shellcheck source=tests/system/script_checks.sh
source "$(dirname "${BASH_SOURCE[0]}")/script_checks.sh"

readonly root=$work/root
readonly demo=$root/launch_scripts/demo.sh test=$root/launch_scripts/test.sh fuzz=$root/launch_scripts/fuzz.sh

make_builders() {
  make_program "$work/bin/dpkg-query" << 'FAKE'
fails "$3" && exit 1
printf installed
FAKE
  make_program "$work/bin/apt-get" << 'FAKE'
fails apt-get || exit 0
echo "E: no such server"
exit 100
FAKE
  ln -s "$work/tools/env" "$work/bin/sudo"
  make_program "$work/bin/cmake" << 'FAKE'
if [[ $1 == --build ]]; then
  echo "[1/2] a.cc"
  if fails "build:${2##*/}"; then
    echo "FAILED: a.o"
    echo "a.cc:1: error: nonsense"
    exit 1
  fi
  echo "[2/2] b.cc"
else
  fails configure && echo "CMake Error: no OpenCV" && exit 1
  mkdir -p "$4"
  touch "$4/CMakeCache.txt"
fi
FAKE
  make_program "$work/clang++" << FAKE
fails libfuzzer && echo libclang_rt.fuzzer.a && exit 0
echo "$work/clang++"
FAKE
}

make_demo_programs() {
  make_program "$root/build/bin/airdos-replay" << 'FAKE'
fails replay && echo "airdos-replay: the log is empty" >&2 && exit 3
cd "${!#}" 2> /dev/null || cd "$5" || exit 9
touch map.airdos trajectory.tum output.lcm
fails truth || echo "0 0 0 0 0 0 0 1" > ground_truth.tum
FAKE
  make_program "$root/build/bin/airdos-evaluate" << 'FAKE'
fails evaluate && echo "airdos-evaluate: two poses are too few" >&2 && exit 4
echo "ATE 0.0123 m"
touch "$7" "$9"
FAKE
  make_program "$root/build/bin/airdos-map" << 'FAKE'
fails map && echo "airdos-map: it is no map" >&2 && exit 5
touch "$4"
FAKE
  make_program "$work/bin/npm" <<< 'echo "npm ERR! no network"; exit 1'
  mkdir -p "$root/build/networks"
  for file in movenet-multipose.json movenet-multipose.bin selfie.json selfie.bin; do
    echo there > "$root/build/networks/$file"
  done
}

# The one program under its many names. Its crash is libFuzzer's, whose exit code is 77, as that of a skipped test.
make_fuzzers() {
  make_program "$root/build-fuzz/bin/airdos_fuzz" << 'FAKE'
name=${0##*/airdos_fuzz_}
case $name in
  list) printf '%s\n' 'first 100' 'second 200' 'third 300' ;;
  seeds) mkdir -p "$1"/{first,second,third} ;;
  *)
    for argument in "$@"; do [[ $argument != -artifact_prefix=* ]] || prefix=${argument#*=}; done
    if fails "$name"; then
      echo "==7==ERROR: AddressSanitizer: heap-buffer-overflow in $name"
      echo "artifact_prefix='$prefix'; Test unit written to ${prefix}crash-0abc"
      touch "${prefix}crash-0abc"
      exit 77
    fi
    if fails hang; then
      mkfifo "$0.fifo" && exec 3<> "$0.fifo" && read -r -u 3
    fi
    fails slow && mkdir "${0%/*}/running" && sleep 0.2 && rmdir "${0%/*}/running"
    echo "#8 DONE   cov: 12 ft: 34 corp: 5/6b"
    echo "stat::number_of_executed_units: 56"
    echo "end of $name" >> "${0%/*}/../ended"
    ;;
esac
FAKE
}

make_root() {
  mkdir -p "$root"/{launch_scripts,logs,build/bin,build-fuzz/bin,build-sanitize}
  cp "$scripts"/*.sh "$root/launch_scripts/"
  # Two packages will do: each is asked for by a process of its own.
  sed -i '/^AIRDOS_PACKAGES=($/,/^)$/c AIRDOS_PACKAGES=(xauth jq)' "$root/launch_scripts/setup.sh"
  echo 'project(airdos VERSION 1.2.3' > "$root/CMakeLists.txt"
  echo log > "$root/logs/road_crossing06.lcm"
  make_program "$root/launch_scripts/lint.sh" << 'FAKE'
fails lint && echo "a.cc:1: error: nonsense" && exit 1
echo "lint.sh: nothing to report"
FAKE
  make_builders
  make_demo_programs
  make_fuzzers
}

# --- demo.sh

demo_prints_the_error_and_where_the_map_is() {
  local file results=$root/logs/runs/demo
  fresh
  run 0 "$demo"
  for step in 1 2 3 4; do says out "demo.sh: step $step of 4: "; done
  says out 'ATE 0.0123 m'
  for file in map.airdos map.png trajectory.tum trajectory.png evaluation.json output.lcm; do
    grep -qE "^ +[0-9.]+K?  $results/$file\$" "$work/out" || fail "$file is not listed: $(cat "$work/out")"
  done
  ends_with out "$(grep -F trajectory.tum "$work/out")"
  ! [[ -s $work/err ]] || fail "stderr: $(cat "$work/err")"
  grep -v dpkg-query "$work/calls" > "$work/steps"
  diff "$work/steps" - << CALLS || fail "other calls"
cmake -S $root -B $root/build -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_EXPORT_COMPILE_COMMANDS=ON
cmake --build $root/build -j $(nproc) --target airdos_programs
airdos-replay $root/logs/road_crossing06.lcm --out $results/output.lcm --run-dir $results --force
airdos-evaluate trajectory --estimate $results/trajectory.tum --ground-truth $results/ground_truth.tum --json $results/evaluation.json --plot $results/trajectory.png --force
airdos-map plot $results/map.airdos --out $results/map.png --force
CALLS
}

demo_can_do_without_the_networks() {
  ran_npm() { grep -c '^npm ' "$work/calls" || true; }
  (($(ran_npm) == 0)) || fail "networks that are there are fetched again: $(cat "$work/calls")"
  rm "$root/build/networks/selfie.bin"
  run 0 "$demo"
  (($(ran_npm) == 1)) || fail "the networks are not fetched: $(cat "$work/calls")"
  says err 'npm cannot fetch'
  says out 'demo.sh: airdos-person-detector has no networks yet: launch_scripts/fetch_networks.sh'
  echo there > "$root/build/networks/selfie.bin"
}

demo_replaces_nothing_in_a_folder_that_was_named() {
  fresh
  run 0 "$demo" --log "$0" --run-dir "$work/mine"
  ran 0 '--force'
  ran 1 "^airdos-replay $0 --out $work/mine/output.lcm --run-dir $work/mine\$"
  says out "$work/mine/map.png"
}

demo_without_ground_truth_is_well() {
  fresh
  FAILS=truth run 0 "$demo" --run-dir "$work/no_truth"
  says out 'the log has no ground truth'
  ran 0 airdos-evaluate
  says out "$work/no_truth/map.png"
}

# demo_fails CODE WHAT MESSAGE CALLED NOT_CALLED: ends where this fails, with its exit code, without results.
demo_fails() {
  fresh
  FAILS=$2 run "$1" "$demo"
  says err "$3"
  says_not out 'results:'
  ran 1 "$4"
  ran 0 "$5"
}

demo_ends_with_the_step_that_fails() {
  demo_fails 3 replay 'airdos-replay: the log is empty' airdos-replay 'airdos-(evaluate|map)'
  demo_fails 4 evaluate 'airdos-evaluate: two poses are too few' airdos-evaluate airdos-map
  demo_fails 5 map 'airdos-map: it is no map' airdos-map none
  demo_fails 1 configure 'CMake Error: no OpenCV' 'cmake -S' 'cmake --build|^airdos-'
  ends_with err "demo.sh: failed: cmake -S $root -B $root/build -DCMAKE_BUILD_TYPE=Release \
-DCMAKE_EXPORT_COMPILE_COMMANDS=ON (log: $root/build/configure.log)"
  demo_fails 1 build:build 'a.cc:1: error: nonsense' 'cmake --build' airdos-
  ends_with err "demo.sh: the build failed (log: $root/build/compile.log)"
  demo_fails 1 'jq apt-get' 'E: no such server' 'apt-get' '^cmake|^airdos-'
  says err 'demo.sh: failed: '
  says err "(log: $root/build/packages.log)"
}

demo_installs_what_is_missing() {
  fresh
  FAILS='jq xauth' run 0 "$demo"
  says out 'demo.sh: installing xauth jq '
  ran 1 '^apt-get .* update$'
  ran 1 '^apt-get .* install --no-install-recommends xauth jq$'
}

# --- how far it is

# With a clock of its own: 4 s for each line.
progress_of() {
  bash -c 'source "$1"; clock=0; read_clock() { now=$clock; clock=$((clock + 4)); }; "$2" "$3"' \
    progress "$root/launch_scripts/setup.sh" "$1" "$work/progress.log"
}

a_build_says_how_long_it_takes_yet() {
  {
    echo 'ninja: Entering directory'
    for ((i = 1; i <= 100; ++i)); do echo "[$i/100] Building $i.cc"; done
  } > "$work/lines"
  progress_of show_progress < "$work/lines" > "$work/out"
  diff "$work/out" - << 'LINES' || fail "other lines"
  compiled 1 of 100
  compiled 10 of 100, about 6 min left
  compiled 20 of 100, about 5 min left
  compiled 30 of 100, about 5 min left
  compiled 40 of 100, about 4 min left
  compiled 50 of 100, about 3 min left
  compiled 60 of 100, about 3 min left
  compiled 70 of 100, about 2 min left
  compiled 80 of 100, about 1 min left
  compiled 90 of 100, less than a minute left
  compiled 100 of 100
LINES
  diff "$work/lines" "$work/progress.log" || fail "the log is not what ninja said"
  printf '%s\n' '[1/1] Nothing' > "$work/lines"
  progress_of show_progress < "$work/lines" > "$work/out"
  ends_with out '  compiled 1 of 1'
  progress_of show_progress < /dev/null > "$work/out"
  ! [[ -s $work/out ]] || fail "of nothing it says: $(cat "$work/out")"
}

packages_say_how_long_they_take_yet() {
  {
    echo 'Reading package lists...'
    for ((i = 0; i <= 100; i += 25)); do echo "dlstatus:$i:$i.0000:Retrieving file $i of 100"; done
    for ((i = 0; i <= 100; i += 10)); do echo "pmstatus:libfoo:$i.5:Installing libfoo"; done
    echo 'Setting up libfoo'
  } > "$work/lines"
  progress_of show_apt_progress < "$work/lines" > "$work/out"
  diff "$work/out" - << 'LINES' || fail "other lines"
  downloaded 0 % of the packages
  downloaded 25 % of the packages
  downloaded 50 % of the packages, less than a minute left
  downloaded 75 % of the packages, less than a minute left
  downloaded 100 % of the packages
  installed 0 % of the packages
  installed 10 % of the packages
  installed 20 % of the packages, less than a minute left
  installed 30 % of the packages, less than a minute left
  installed 40 % of the packages, less than a minute left
  installed 50 % of the packages, less than a minute left
  installed 60 % of the packages, less than a minute left
  installed 70 % of the packages, less than a minute left
  installed 80 % of the packages, less than a minute left
  installed 90 % of the packages, less than a minute left
  installed 100 % of the packages
LINES
  printf '%s\n' 'Reading package lists...' 'Setting up libfoo' | diff - "$work/progress.log" || fail "the log holds apt's figures"
}

# --- fuzz.sh

fuzz_says_how_far_each_target_came() {
  fresh
  run 0 "$fuzz" --seconds 2 --jobs 2
  local name
  for name in first second third; do says out "  $(printf '%-16s' $name)        56 runs, coverage 12"; done
  ends_with out 'fuzz.sh: 3 targets for 2 s each, 0 failed'
  ran 1 "^cmake -S $root -B $root/build-fuzz .* -DCMAKE_CXX_COMPILER=clang\+\+ -DAIRDOS_BUILD_FUZZERS=ON"
  ran 1 "^airdos_fuzz_seeds $root/build-fuzz/seeds $root/logs/road_crossing06.lcm\$"
  ran 1 "^airdos_fuzz_second -max_total_time=2 -max_len=200 .* $root/build-fuzz/corpus/second $root/build-fuzz/seeds/second\$"
}

fuzz_names_the_input_that_fails_and_runs_the_others() {
  local jobs artifact=$root/build-fuzz/failures/first-crash-0abc
  for jobs in 1 2 9; do
    rm -f "$root/build-fuzz/ended" "$artifact"
    FAILS=first run 1 "$fuzz" --jobs "$jobs"
    says out '==7==ERROR: AddressSanitizer: heap-buffer-overflow in first'
    ends_with err "fuzz.sh: first FAILED on $artifact (log: $root/build-fuzz/first.log)"
    ends_with out 'fuzz.sh: 3 targets for 10 s each, 1 failed'
    [[ -e $artifact ]] || fail "the input is gone"
    (($(wc -l < "$root/build-fuzz/ended") == 2)) || fail "the others ran not: $(cat "$root/build-fuzz/ended")"
  done
  FAILS='second third' run 1 "$fuzz" --jobs 2
  ends_with out 'fuzz.sh: 3 targets for 10 s each, 2 failed'
}

# Each finds the folder that another has made.
fuzz_runs_so_many_at_a_time() {
  FAILS=slow run 0 "$fuzz" --jobs 1
  ! grep -q 'File exists' "$root"/build-fuzz/*.log || fail "two at a time"
}

fuzz_runs_only_what_was_named() {
  fresh
  FAILS='first third' run 0 "$fuzz" second
  ends_with out 'fuzz.sh: 1 targets for 10 s each, 0 failed'
  ran 0 '^airdos_fuzz_(first|third)'
  fresh
  run 2 "$fuzz" second nonsense
  ends_with err "fuzz.sh: no such target: 'nonsense' (see --list)"
  ran 0 '^airdos_fuzz_second'
  run 0 "$fuzz" --list
  ends_with out 'third 300'
  fresh
  run 0 "$fuzz" --build-only
  ran 1 'cmake --build'
  ran 0 airdos_fuzz_
}

fuzz_that_is_ended_leaves_nobody() {
  local pid got=0 target=$root/build-fuzz/bin/airdos_fuzz_first
  nobody_is_left() { [[ -z $(pids_of airdos_fuzz_) ]]; }
  FAILS=hang "$fuzz" --jobs 2 > "$work/hung.out" 2>&1 < /dev/null &
  pid=$!
  await "the first target" test -p "$target.fifo"
  kill -TERM "$pid"
  wait "$pid" || got=$?
  ((got == 143)) || fail "exit code $got: $(cat "$work/hung.out")"
  await "the end of its targets" nobody_is_left
  rm -f "$root"/build-fuzz/bin/*.fifo
}

fuzz_without_a_build_ends_at_once() {
  fresh
  FAILS=build:build-fuzz run 1 "$fuzz"
  ends_with err "fuzz.sh: the build failed (log: $root/build-fuzz/compile.log)"
  FAILS=libfuzzer run 77 "$fuzz"
  ends_with out 'fuzz.sh: no clang with libFuzzer here (apt-get install clang libclang-rt-14-dev): the fuzz targets are not run'
  rm "$work/bin/clang++"
  run 77 "$fuzz"
  says out 'no clang with libFuzzer here'
  ran 0 airdos_fuzz_
  ln -s "$work/clang++" "$work/bin/clang++"
}

# --- test.sh

# tests_of FOLDER: its tests, as cmake writes them down, from lines "name label shell-command".
tests_of() {
  local name label command
  mkdir -p "$root/$1"
  while read -r name label command; do
    echo "add_test($name $work/tools/sh -c \"$command\")"
    echo "set_tests_properties($name PROPERTIES LABELS $label SKIP_RETURN_CODE 77)"
  done > "$root/$1/CTestTestfile.cmake"
}

# As all is well. The system test must not be run under sanitizers.
all_is_well() {
  fresh
  tests_of build-fuzz << 'TESTS'
unit_good unit true
numeric_good numeric true
node_good node true
system_bad system false
TESTS
  cp "$root/build-fuzz/CTestTestfile.cmake" "$root/build-sanitize/"
  tests_of build << 'TESTS'
unit_good unit true
system_good system true
TESTS
}

readonly well_sanitized='100% tests passed, 0 tests failed out of 3'
readonly well='100% tests passed, 0 tests failed out of 2'
readonly failed_before='test.sh: FAILED: tests or fuzz targets under the sanitizers (see above)'

test_runs_all_and_says_so() {
  all_is_well
  run 0 "$test"
  says out "$well_sanitized"
  says out 'fuzz.sh: 3 targets for 10 s each, 0 failed'
  ends_with out "$well"
  says_not out FAILED
  says_not out skipped
  (($(grep -c 'tests passed' "$work/out") == 2)) || fail "not one closing line each: $(cat "$work/out")"
  grep -E '^cmake|_first ' "$work/calls" | sed 's/ -j.*--target//; s/ -D.*//; s/ -max_len.*//' > "$work/steps"
  diff "$work/steps" - << CALLS || fail "other calls"
cmake -S $root -B $root/build-fuzz
cmake --build $root/build-fuzz airdos_fuzz airdos_tests_unit airdos_tests_numeric airdos_tests_node
cmake -S $root -B $root/build-fuzz
cmake --build $root/build-fuzz airdos_fuzz airdos_tests_unit airdos_tests_numeric airdos_tests_node
airdos_fuzz_first -max_total_time=10
cmake -S $root -B $root/build
cmake --build $root/build all
CALLS
  ran 2 'build-fuzz .*-DAIRDOS_BUILD_FUZZERS=ON .*-DAIRDOS_BUILD_TESTS=ON'
  ran 1 'dpkg-query .* clang$'
}

test_runs_the_normal_build_although_the_sanitized_fails() {
  all_is_well
  tests_of build-fuzz <<< 'node_bad node echo heap-use-after-free; exit 1'
  run 1 "$test"
  says out 'heap-use-after-free'
  says out '0% tests passed, 1 tests failed out of 1'
  says out 'fuzz.sh: 3 targets for 10 s each, 0 failed'
  says out "$well"
  ends_with out "$failed_before"
}

test_runs_the_tests_although_lint_fails() {
  all_is_well
  FAILS=lint run 1 "$test"
  says out 'a.cc:1: error: nonsense'
  says out "$well_sanitized"
  says out "$well"
  says_not out "$failed_before"
  ends_with out 'test.sh: FAILED: lint.sh (see above)'
}

test_fails_where_a_fuzz_target_does() {
  all_is_well
  FAILS=second run 1 "$test"
  says out "$well_sanitized"
  says err 'second FAILED on '
  says out 'fuzz.sh: 3 targets for 10 s each, 1 failed'
  says_not out SKIPPED
  says out "$well"
  ends_with out "$failed_before"
}

test_fails_where_the_normal_build_does() {
  all_is_well
  tests_of build << 'TESTS'
good unit true
bad unit false
TESTS
  run 1 "$test"
  says out 'The following tests FAILED:'
  says out '2 - bad (Failed)'
  ends_with out '50% tests passed, 1 tests failed out of 2'
  run 1 "$test" --no-sanitizers
  ends_with out '50% tests passed, 1 tests failed out of 2'
}

test_says_that_there_is_no_clang() {
  all_is_well
  rm "$work/bin/clang++"
  run 0 "$test"
  ran 1 'build-sanitize .*-DAIRDOS_SANITIZE=ON'
  says out "$well_sanitized"
  says out 'test.sh: SKIPPED: the fuzz targets (no clang)'
  ends_with out "$well"
  ln -s "$work/clang++" "$work/bin/clang++"
}

test_gives_the_reasons_for_skips() {
  all_is_well
  tests_of build << 'TESTS'
by_script system echo SKIPPED: no jq; exit 77
by_googletest unit echo a_test.cc:7: Skipped; echo AIRDOS_DATA_DIR is not set; echo done
good unit echo nothing
TESTS
  run 0 "$test"
  says out '  skipped: by_script: no jq'
  says out '  skipped: by_googletest: AIRDOS_DATA_DIR is not set'
  (($(grep -c 'skipped: ' "$work/out") == 2)) || fail "other skips: $(cat "$work/out")"
  ends_with out '100% tests passed, 0 tests failed out of 3'
}

test_ends_with_what_failures_said() {
  all_is_well
  tests_of build << 'TESTS'
wrong unit i=0; while [ $i -lt 20 ]; do echo line $i; i=$((i + 1)); done; exit 1
good unit echo nothing
TESTS
  run 1 "$test"
  says out '  failed: wrong'
  says out '    line 8'
  says out '    line 19'
  ! sed -n '/^  failed: /,$p' "$work/out" | grep -q 'line 7$' || fail "more than the last lines: $(cat "$work/out")"
  (($(grep -c 'failed: ' "$work/out") == 1)) || fail "other failures: $(cat "$work/out")"
  ends_with out '50% tests passed, 1 tests failed out of 2'
}

# no_result FOLDER ARGUMENT…: there is no test at all, so that ctest says nothing of how many passed.
no_result() {
  local folder=$1
  shift
  all_is_well
  : > "$root/$folder/CTestTestfile.cmake"
  run 1 "$test" "$@"
  ends_with err "test.sh: ctest came to no result (log: $root/$folder/ctest.log)"
}

test_without_a_result_is_no_success() {
  no_result build
  no_result build --no-sanitizers
  no_result build-fuzz
  no_result build-sanitize --no-fuzz
  says_not out "$well"
}

test_ends_where_a_build_fails() {
  local folder script
  for folder in build build-fuzz build-sanitize; do
    script="test"
    if [[ $folder == build-fuzz ]]; then script=fuzz; fi
    all_is_well
    FAILS="build:$folder $([[ $folder == build-sanitize ]] && echo libfuzzer)" run 1 "$test"
    says err 'a.cc:1: error: nonsense'
    ends_with err "$script.sh: the build failed (log: $root/$folder/compile.log)"
    says_not out "$well"
  done
}

test_leaves_out_what_it_is_told_to() {
  all_is_well
  run 0 "$test" --no-fuzz
  says out "$well_sanitized"
  ran 0 'airdos_fuzz|build-fuzz|dpkg-query .* clang$'
  all_is_well
  run 0 "$test" --no-lint
  ran 0 'lint.sh|dpkg-query .* shellcheck$'
  says out "$well"
  all_is_well
  run 0 "$test" --no-sanitizers
  ran 1 'lint.sh'
  ran 0 'airdos_fuzz|build-fuzz|build-sanitize'
  ends_with out "$well"
}

link_tools awk basename bash cat chmod cp ctest cut diff dirname du env grep ln mkdir mkfifo mktemp nproc readlink rm rmdir sed sh sleep tail tee touch uname wc
make_root
ln -s "$work/clang++" "$work/bin/clang++"
export PATH=$work/bin:$work/tools
demo_prints_the_error_and_where_the_map_is
demo_can_do_without_the_networks
demo_replaces_nothing_in_a_folder_that_was_named
demo_without_ground_truth_is_well
demo_ends_with_the_step_that_fails
demo_installs_what_is_missing
a_build_says_how_long_it_takes_yet
packages_say_how_long_they_take_yet
fuzz_says_how_far_each_target_came
fuzz_names_the_input_that_fails_and_runs_the_others
fuzz_runs_so_many_at_a_time
fuzz_runs_only_what_was_named
fuzz_that_is_ended_leaves_nobody
fuzz_without_a_build_ends_at_once
test_runs_all_and_says_so
test_runs_the_normal_build_although_the_sanitized_fails
test_runs_the_tests_although_lint_fails
test_fails_where_a_fuzz_target_does
test_fails_where_the_normal_build_does
test_says_that_there_is_no_clang
test_gives_the_reasons_for_skips
test_ends_with_what_failures_said
test_without_a_result_is_no_success
test_ends_where_a_build_fails
test_leaves_out_what_it_is_told_to
echo "all checks passed"
