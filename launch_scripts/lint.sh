#!/bin/bash
# Looks for mistakes without running anything: layout (clang-format), includes, scripts (shellcheck), YAML and JSON files, the
# Dockerfile, cppcheck, clang-tidy. test.sh runs it.
#
# Usage: launch_scripts/lint.sh [--fix] [--all] [--fast] [--jobs N] [PATH…]
#   --fix     mend what clang-format, and clang-tidy in the units named, can mend
#   --all     clang-tidy with all checks of .clang-tidy, the static analyzer too, instead of QUICK_CHECKS, each unit by itself: an hour
#             or two of one processor; CI does it weekly
#   --fast    all but clang-tidy: seconds, for a commit hook
#   --jobs N  units at a time (default: one per processor)
#   PATH…     only these files and folders
#   --help    this text
#
# Exit 1 if there is anything to report. What was clean is not looked at again by clang-tidy until it, or a header of ours that it
# includes, changes (build-lint/tidy).
set -euo pipefail
# shellcheck source=launch_scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

readonly LINT_SCRIPTS=$AIRDOS_ROOT/launch_scripts/lint
readonly LINT_BUILD=${AIRDOS_LINT_BUILD:-$AIRDOS_ROOT/build-lint}
# Of the checks in .clang-tidy, those that find most for their time: a quarter of the time of all, the static analyzer aside. What g++,
# clang or cppcheck see of the others' kind, they see in each run.
readonly QUICK_CHECKS='-*,clang-diagnostic-*,bugprone-argument-comment,bugprone-branch-clone,bugprone-copy-constructor-init,bugprone-dangling-handle,bugprone-fold-init-type,bugprone-forwarding-reference-overload,bugprone-inaccurate-erase,bugprone-integer-division,bugprone-move-forwarding-reference,bugprone-parent-virtual-call,bugprone-string-constructor,bugprone-string-integer-assignment,bugprone-suspicious-missing-comma,bugprone-swapped-arguments,bugprone-terminating-continue,bugprone-throw-keyword-missing,bugprone-undefined-memory-manipulation,bugprone-unhandled-self-assignment,bugprone-use-after-move,google-build-using-namespace,google-explicit-constructor,performance-for-range-copy,performance-implicit-conversion-in-loop,performance-move-const-arg,performance-move-constructor-init,performance-noexcept-move-constructor,performance-unnecessary-copy-initialization,readability-identifier-naming'
# What clang itself sees for nothing, in place of checks on null pointers and overriding.
readonly LINT_WARNINGS='-Wno-unknown-warning-option -Wzero-as-null-pointer-constant -Wsuggest-override'

fix=no all=no fast=no jobs=$(nproc)
paths=()
while (($# > 0)); do
  case $1 in
    --fix) fix=yes ;;
    --all) all=yes ;;
    --fast) fast=yes ;;
    --jobs)
      need_value "$@"
      [[ $2 =~ ^[1-9][0-9]*$ ]] || die_usage "--jobs: not a whole number above 0: '$2'"
      jobs=$2
      shift
      ;;
    --help | -h)
      print_help
      exit 0
      ;;
    -*) die_usage "unknown option '$1' (see --help)" ;;
    *)
      [[ -e $1 ]] || die_usage "no file or folder '$1'"
      paths+=("$(realpath "$1")")
      ;;
  esac
  shift
done
for path in "${paths[@]}"; do
  [[ $path == "$AIRDOS_ROOT" || $path == "$AIRDOS_ROOT"/* ]] || die_usage "not in $AIRDOS_ROOT: '$path'"
done
cd "$AIRDOS_ROOT"
mapfile -t paths < <(((${#paths[@]} == 0)) || realpath --relative-to=. "${paths[@]}")

# files_of PATTERN…: the files of the project, or of the paths named, whose names fit; in an unpacked archive too.
files_of() {
  local pattern
  local -a names=()
  for pattern; do names+=(-o -name "$pattern"); done
  find "${paths[@]:-.}" -type d \( -name .git -o -name 'build*' -o -path ./logs/runs \) -prune -o -type f \
    \( "${names[@]:1}" \) -print | sed 's,^\./,,' | LC_ALL=C sort
}

# program NAME…: the first of these that is installed.
program() {
  local name
  for name; do
    if command -v "$name"; then return; fi
  done
  die "none of these programs is installed: $*; launch_scripts/lint.sh needs ${AIRDOS_LINT_PACKAGES[*]}"
}

failed=()
# step NAME COMMAND…: says how long it took, or what is wrong.
step() {
  local name=$1 started=$SECONDS output=$work/output
  shift
  if "$@" > "$output" 2>&1 < /dev/null; then
    say "$name: well ($((SECONDS - started)) s)"
    grep -E '^clang-tidy: ' "$output" | sed 's/^/  /' || true
  else
    cat "$output"
    failed+=("$name")
    say "$name: FAILED"
  fi
}

check_layout() {
  local -a sources
  mapfile -t sources < <(files_of '*.h' '*.cc')
  ((${#sources[@]} > 0)) || return 0
  if [[ $fix == yes ]]; then
    "$format" -i "${sources[@]}"
  else
    "$format" --dry-run -Werror "${sources[@]}"
  fi
}

check_scripts() {
  local -a scripts
  mapfile -t scripts < <(
    files_of '*.sh'
    [[ ! -f .ci/run || ${#paths[@]} -gt 0 ]] || echo .ci/run
  )
  ((${#scripts[@]} == 0)) || shellcheck --external-sources --severity=style "${scripts[@]}"
}

check_data() {
  local -a yaml json
  local bad=0 # set -e does not hold in a step
  mapfile -t yaml < <(files_of '*.yaml' '*.yml' '.clang-*')
  mapfile -t json < <(files_of '*.json')
  ((${#yaml[@]} == 0)) || yamllint --strict --config-file .yamllint.yml "${yaml[@]}" || bad=1
  local file
  for file in "${json[@]}"; do
    "$python" -m json.tool "$file" /dev/null || {
      echo "$file: not JSON"
      bad=1
    }
  done
  return "$bad"
}

check_dockerfiles() {
  local -a files
  mapfile -t files < <(files_of 'Dockerfile*')
  ((${#files[@]} == 0)) || "$LINT_SCRIPTS/dockerfile.py" "${files[@]}"
}

run_cppcheck() {
  local -a sources
  # Headers are read where they are included.
  mapfile -t sources < <(if ((${#paths[@]} > 0)); then files_of '*.cc' '*.h'; else files_of '*.cc'; fi)
  ((${#sources[@]} > 0)) || return 0
  mkdir -p "$LINT_BUILD/cppcheck"
  cppcheck --enable=warning,performance,portability --inline-suppr --language=c++ --std=c++17 --quiet -j "$jobs" --library=googletest \
    '-DTYPED_TEST_SUITE(a,b)=using a##_types=b' '-DTYPED_TEST(a,b)=template<class TypeParam>void a##b()' \
    --suppressions-list="$LINT_SCRIPTS/cppcheck_suppressions.txt" --cppcheck-build-dir="$LINT_BUILD/cppcheck" \
    --error-exitcode=1 --template='{file}:{line}: {severity}: {message} [{id}]' -I . "${sources[@]}"
}

# The precompiled headers and the headers of the message types: all that clang-tidy needs of a build.
prepare_tidy() {
  local -a generator=()
  [[ -e $LINT_BUILD/CMakeCache.txt ]] || generator=(-G Ninja)
  run_logged "$LINT_BUILD/configure.log" cmake -S . -B "$LINT_BUILD" "${generator[@]}" -DCMAKE_BUILD_TYPE=Lint \
    -DCMAKE_CXX_COMPILER="$clang" "-DCMAKE_CXX_FLAGS_LINT=$LINT_WARNINGS" -DAIRDOS_BUILD_TESTS=ON -DAIRDOS_BUILD_JAVA=OFF \
    -DCMAKE_EXPORT_COMPILE_COMMANDS=ON
  run_logged "$LINT_BUILD/compile.log" cmake --build "$LINT_BUILD" -j "$jobs" \
    --target airdos_pch airdos_test_pch airdos_lcmtypes_headers
}

run_tidy() {
  local -a options=(--root . --build "$LINT_BUILD" --jobs "$jobs" --program "$tidy")
  if [[ $all == yes ]]; then options+=(--each); else options+=("--checks=$QUICK_CHECKS"); fi
  if [[ $fix == yes && ${#paths[@]} -gt 0 ]]; then options+=(--fix); fi
  "$LINT_SCRIPTS/tidy.py" "${options[@]}" "${paths[@]}"
}

format=$(program clang-format-14 clang-format)
python=$(program python3)
for name in shellcheck yamllint cppcheck; do program "$name" > /dev/null; done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

step clang-format check_layout
step "what is included" "$LINT_SCRIPTS/includes.py" . "${paths[@]}"
step "which way includes point" tests/system/includes_test.sh .
step shellcheck check_scripts
step "YAML and JSON" check_data
step Dockerfile check_dockerfiles
step cppcheck run_cppcheck
if [[ $fast == no ]]; then
  clang=$(program clang++-14 clang++)
  tidy=$(program clang-tidy-14 clang-tidy)
  say "clang-tidy (minutes the first time; log of its build: ${LINT_BUILD#"$AIRDOS_ROOT"/}/compile.log)"
  prepare_tidy
  step clang-tidy run_tidy
fi
if ((${#failed[@]} > 0)); then
  printf -v text '%s, ' "${failed[@]}"
  die "FAILED: ${text%, }"
fi
say "nothing to report"
