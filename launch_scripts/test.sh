#!/bin/bash
# Installs what is missing, looks for mistakes that need no running (lint.sh), builds, and runs all tests: the unit, numeric and node
# tests under the address and undefined-behaviour sanitizers, the fuzz targets (fuzz.sh) for 10 s each, then everything in the
# normal build.
#
# Usage: launch_scripts/test.sh [--no-lint] [--no-sanitizers] [--no-fuzz]
#   --no-lint        without lint.sh
#   --no-sanitizers  only the normal build, and no fuzz targets
#   --no-fuzz        no fuzz targets
#   --help           this text
#
# Exit 0 if nothing failed. Tests that were skipped are listed with their reasons.
set -euo pipefail
# shellcheck source=launch_scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

readonly EXIT_SKIPPED=77

lint=yes sanitizers=yes fuzz=yes
while (($# > 0)); do
  case $1 in
    --no-lint) lint=no ;;
    --no-sanitizers) sanitizers=no fuzz=no ;;
    --no-fuzz) fuzz=no ;;
    --help | -h)
      print_help
      exit 0
      ;;
    *) die_usage "unknown option '$1' (see --help)" ;;
  esac
  shift
done

# print_skipped FOLDER: name and reason of each skipped test, from ctest's own log of the last run.
print_skipped() {
  awk '
    /^[0-9]+\/[0-9]+ Test: /  { name = $3; reason = ""; skipped = next_is_reason = 0 }
    next_is_reason            { reason = $0; next_is_reason = 0 }
    /: Skipped$/              { skipped = next_is_reason = 1 }  # as GoogleTest says it
    /^SKIPPED: /              { skipped = 1; reason = substr($0, 10) }  # as our scripts say it
    /^<end of output>$/       { if (skipped) print "  skipped: " name ": " reason; skipped = 0 }
    ' "$1/Testing/Temporary/LastTest.log"
}

# print_failed FOLDER: the last lines of each failed test, from the same log: what ctest says of it stands thousands of lines above.
print_failed() {
  awk -v max_lines=12 '
    /^[0-9]+\/[0-9]+ Test: / { name = $3; num_lines = inside = 0 }
    /^<end of output>$/      { inside = 0 }
    inside                   { lines[num_lines++] = $0 }
    /^Output:$/              { getline; inside = 1 }
    /^Test Failed\.$/ && name {
      print "  failed: " name
      for (i = num_lines > max_lines ? num_lines - max_lines : 0; i < num_lines; i++) print "    " substr(lines[i], 1, 300)
      name = ""
    }
    ' "$1/Testing/Temporary/LastTest.log"
}

# run_tests FOLDER [CTEST OPTIONS…]: as ctest does it, but with the reasons for skips and failures, and the closing line last.
run_tests() {
  local folder=$1 failed=no
  shift
  ctest --test-dir "$folder" --output-on-failure --no-label-summary -j "$(nproc)" "$@" 2>&1 < /dev/null |
    tee "$folder/ctest.log" | sed '/% tests passed,/,$d' || failed=yes
  sed '1,/% tests passed,/d; /^Errors while running CTest/d; /^$/d' "$folder/ctest.log"
  print_failed "$folder"
  print_skipped "$folder"
  grep '% tests passed,' "$folder/ctest.log" || die "ctest came to no result (log: $folder/ctest.log)"
  [[ $failed == no ]]
}

# build_sanitized: sets sanitized to the folder with the tests to be run. One build with clang for them and the fuzz targets;
# where those are not wanted, or there is no clang, one with g++, and fuzz becomes "no".
build_sanitized() {
  local code=$EXIT_SKIPPED
  if [[ $fuzz == yes ]]; then
    code=0
    "$AIRDOS_ROOT/launch_scripts/fuzz.sh" --build-only --with-tests || code=$?
  fi
  sanitized=$AIRDOS_ROOT/build-fuzz
  ((code == 0)) && return
  ((code == EXIT_SKIPPED)) || exit "$code"
  if [[ $fuzz == yes ]]; then skipped_fuzzers=yes; fi
  fuzz=no
  sanitized=$AIRDOS_ROOT/build-sanitize
  # -O1 -g1: the sanitizers stay bearable on code that leans on Eigen's inlining, and say line numbers.
  configure_and_build "$sanitized" "airdos_tests_${AIRDOS_SANITIZED_TIERS// / airdos_tests_}" \
    -DAIRDOS_SANITIZE=ON -DAIRDOS_BUILD_JAVA=OFF -DCMAKE_BUILD_TYPE=Sanitize "-DCMAKE_CXX_FLAGS_SANITIZE=-O1 -g1"
}

further=()
if [[ $fuzz == yes ]]; then further+=("${AIRDOS_TEST_PACKAGES[@]}"); fi
if [[ $lint == yes ]]; then further+=("${AIRDOS_LINT_PACKAGES[@]}"); fi
install_packages "${further[@]}"
failures=0 sanitized='' skipped_fuzzers=no lint_failures=0 sanitized_failures=0

if [[ $lint == yes ]]; then "$AIRDOS_ROOT/launch_scripts/lint.sh" || lint_failures=1; fi

if ((lint_failures > 0)); then say "lint.sh FAILED (see above); now the tests"; fi
if [[ $sanitizers == yes ]]; then
  build_sanitized
  say "tests under sanitizers"
  # On glibc 2.36 the leak checker of GCC 12 may follow a block of thread-local storage that it misread, and crash.
  export LSAN_OPTIONS=intercept_tls_get_addr=0
  run_tests "$sanitized" -L "^(${AIRDOS_SANITIZED_TIERS// /|})\$" || sanitized_failures=1
fi

if [[ $fuzz == yes ]]; then "$AIRDOS_ROOT/launch_scripts/fuzz.sh" --with-tests --seconds 10 || sanitized_failures=1; fi
if [[ $skipped_fuzzers == yes ]]; then say "SKIPPED: the fuzz targets (no clang)"; fi

configure_and_build "$AIRDOS_ROOT/build" all -DCMAKE_BUILD_TYPE=Release
if ((sanitized_failures > 0)); then say "tests or fuzz targets FAILED under the sanitizers (see above); now the others"; fi
# The system tests wait more than they compute.
run_tests "$AIRDOS_ROOT/build" -j "$(($(nproc) + 2))" || failures=1
# Else the last line might be that all tests passed.
if ((lint_failures > 0)); then say "FAILED: lint.sh (see above)"; fi
if ((sanitized_failures > 0)); then say "FAILED: tests or fuzz targets under the sanitizers (see above)"; fi
exit "$((failures || lint_failures || sanitized_failures))"
