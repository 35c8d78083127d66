#!/bin/bash
# Searches for inputs that crash, throw, hang or allocate more than 64 MB at once: builds the fuzz targets (tests/fuzz) with clang's
# libFuzzer and the address and undefined-behaviour sanitizers, and runs each of them for a few seconds.
#
# Usage: launch_scripts/fuzz.sh [--seconds N] [--jobs N] [--build-only] [--with-tests] [TARGET…]
#   --seconds N   time per target (default 10; an hour in total for the 39 targets: 92)
#   --jobs N      number of targets run at the same time (default: one per processor)
#   --build-only  do not run the targets
#   --with-tests  also build the tests that run under sanitizers, from the same objects (test.sh runs them)
#   --list        print the names of the targets (after a build)
#   --help        this text
#
# Seeds are generated, and whatever libFuzzer finds worth keeping is kept in build-fuzz/corpus/TARGET for the next run. Inputs that
# fail are kept in build-fuzz/failures; to reproduce one, run build-fuzz/bin/airdos_fuzz_TARGET FILE. Exit code 1 if there are any,
# 77 if clang is not installed.
set -euo pipefail
# shellcheck source=launch_scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

readonly FOLDER=${AIRDOS_FUZZ_BUILD:-$AIRDOS_ROOT/build-fuzz}
readonly EXIT_SKIPPED=77

seconds=10 jobs=$(nproc) build_only=no with_tests=no list=no
targets=()
while (($# > 0)); do
  case $1 in
    --seconds | --jobs)
      need_value "$@"
      [[ $2 =~ ^[1-9][0-9]*$ ]] || die_usage "$1: not a whole number above 0: '$2'"
      printf -v "${1#--}" '%s' "$2"
      shift
      ;;
    --build-only) build_only=yes ;;
    --with-tests) with_tests=yes ;;
    --list) list=yes ;;
    --help | -h)
      print_help
      exit 0
      ;;
    -*) die_usage "unknown option '$1' (see --help)" ;;
    *) targets+=("$1") ;;
  esac
  shift
done

# The newest clang++ that includes libFuzzer.
find_clang() {
  local compiler runtime
  for compiler in clang++ clang++-19 clang++-16 clang++-15 clang++-14; do
    command -v "$compiler" > /dev/null || continue
    runtime=$("$compiler" --print-file-name="libclang_rt.fuzzer-$(uname -m).a")  # its bare name if there is none
    if [[ -e $runtime ]]; then
      echo "$compiler"
      return
    fi
  done
}

build_fuzzers() {
  local compiler built=airdos_fuzz tests=OFF
  compiler=$(find_clang)
  if [[ -z $compiler ]]; then
    say "no clang with libFuzzer here (apt-get install clang libclang-rt-14-dev): the fuzz targets are not run"
    exit "$EXIT_SKIPPED"
  fi
  if [[ $with_tests == yes ]]; then
    tests=ON
    built+=" airdos_tests_${AIRDOS_SANITIZED_TIERS// / airdos_tests_}"
  fi
  configure_and_build "$FOLDER" "$built" -DCMAKE_CXX_COMPILER="$compiler" -DAIRDOS_BUILD_FUZZERS=ON \
    -DAIRDOS_BUILD_TESTS=$tests -DAIRDOS_BUILD_JAVA=OFF -DCMAKE_BUILD_TYPE=Fuzz "-DCMAKE_CXX_FLAGS_FUZZ=-O1 -g1"
}

# link_to NAME: links the program under a target's name, by which it selects the target.
link_to() { ln -sf airdos_fuzz "$FOLDER/bin/airdos_fuzz_$1"; }

# run_target NAME MAX_BYTES: returns false on failure.
run_target() {
  local name=$1 max_bytes=$2 corpus=$FOLDER/corpus/$1 log=$FOLDER/$1.log input
  mkdir -p "$corpus" "$FOLDER/failures"
  link_to "$name"
  # 64 MB per allocation; a whole process needs more with sanitizers than without.
  if "$FOLDER/bin/airdos_fuzz_$name" -max_total_time="$seconds" -max_len="$max_bytes" -timeout=10 -malloc_limit_mb=64 \
    -rss_limit_mb=1024 -print_final_stats=1 -artifact_prefix="$FOLDER/failures/$name-" "$corpus" "$FOLDER/seeds/$name" \
    > "$log" 2>&1 < /dev/null; then
    printf '  %-16s %9s runs, coverage %s\n' "$name" "$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")" \
      "$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -n 1)"
  else
    grep -m 1 -E 'ERROR|runtime error|fuzz check|terminate' "$log" || tail -n 3 "$log"
    input=$(sed -n 's/.*Test unit written to //p' "$log" | tail -n 1)
    say "$name FAILED${input:+ on $input} (log: $log)" >&2
    return 1
  fi
}

[[ $list == yes && -e $FOLDER/bin/airdos_fuzz ]] || build_fuzzers
for name in list seeds; do link_to "$name"; done
if [[ $list == yes ]]; then
  "$FOLDER/bin/airdos_fuzz_list"
  exit 0
fi
if [[ $build_only == yes ]]; then exit 0; fi

mapfile -t all < <("$FOLDER/bin/airdos_fuzz_list")
for name in "${targets[@]}"; do
  [[ " ${all[*]%% *} " == *" $name "* ]] || die_usage "no such target: '$name' (see --list)"
done
"$FOLDER/bin/airdos_fuzz_seeds" "$FOLDER/seeds" "$AIRDOS_ROOT/logs/road_crossing06.lcm"
failed=0 num_ended=0
pids=()
# Ending this script ends its targets.
end_targets() {
  local pid
  for pid in "${pids[@]:num_ended}"; do kill -TERM -- "-$pid" 2> /dev/null || true; done
}
trap end_targets EXIT

# Waits for the target that has run longest; all of them take equally long.
await_target() {
  wait "${pids[num_ended]}" || failed=$((failed + 1))
  num_ended=$((num_ended + 1))
}

for target in "${all[@]}"; do
  read -r name max_bytes <<< "$target"
  if ((${#targets[@]} > 0)) && [[ " ${targets[*]} " != *" $name "* ]]; then continue; fi
  if ((${#pids[@]} - num_ended >= jobs)); then await_target; fi
  set -m # gives each target its own process group, to be ended as a whole
  run_target "$name" "$max_bytes" &
  set +m
  pids+=($!)
done
while ((num_ended < ${#pids[@]})); do await_target; done
((${#pids[@]} > 0)) || die "airdos_fuzz_list names no targets"
say "${#pids[@]} targets for $seconds s each, $failed failed"
((failed == 0))
