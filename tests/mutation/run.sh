#!/bin/bash
# Builds small mistakes into the code, one at a time, and says which of them no test notices: how much the tests are worth.
#
# Usage: tests/mutation/run.sh [--area NAME]… [--list] [--jobs N] [--timeout S] [--build FOLDER]
#   --area NAME     only the mistakes of that area (again for more)
#   --list          only look whether each list still fits the code: builds and runs nothing
#   --jobs N        mistakes at a time, each in a copy of the tree with a build folder of its own (default 1)
#   --timeout S     seconds that a test program may take (default 300); one that takes longer has noticed the mistake
#   --build FOLDER  where everything happens (default build-mutation): copies of the tree, result.tsv, a log a mistake
#   --help          this text
#
# The lists are mutants_*.txt beside this script, reasons for survivors are in survivors.txt; README.md says how to write
# them. Prints a table (Markdown). Exit 1 if a mistake survived for which there is no reason, does not compile, or no
# longer fits the code, and if the tests fail without any mistake; 2 for a wrong option.
set -euo pipefail
# shellcheck source=launch_scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/../../launch_scripts/common.sh"

lists=$AIRDOS_ROOT/tests/mutation
only_list=no jobs=1 timeout_s=300 build=$AIRDOS_ROOT/build-mutation
areas=()
while (($# > 0)); do
  case $1 in
    --list) only_list=yes ;;
    --area | --jobs | --timeout | --build | --lists)
      need_value "$@"
      case $1 in
        --area) areas+=("$2") ;;
        --jobs) jobs=$2 ;;
        --timeout) timeout_s=$2 ;;
        --build) build=$2 ;;
        --lists) lists=$2 ;; # for the test of this script
      esac
      shift
      ;;
    --help | -h)
      print_help
      exit 0
      ;;
    *) die_usage "unknown option '$1' (see --help)" ;;
  esac
  shift
done
for number in "$jobs" "$timeout_s"; do
  [[ $number =~ ^[1-9][0-9]*$ ]] || die_usage "--jobs, --timeout: not a whole number above 0: '$number'"
done

# One element a mutant in each.
mutant_area=() mutant_file=() mutant_from=() mutant_to=() mutant_tests=()
num_bad=0

# bad TEXT…: says what is wrong with a list and counts it.
bad() {
  say "$*" >&2
  num_bad=$((num_bad + 1))
}

# split LINE: its fields, which ' | ' divides, into the array fields.
split() {
  local rest=$1
  fields=()
  while [[ $rest == *' | '* ]]; do
    fields+=("${rest%%' | '*}")
    rest=${rest#*' | '}
  done
  fields+=("$rest")
}

wants_area() {
  local area
  ((${#areas[@]} > 0)) || return 0
  for area in "${areas[@]}"; do [[ $area != "$1" ]] || return 0; done
  return 1
}

# read_list FILE: appends the mutants of the areas that are wanted.
read_list() {
  local list=$1 line area='' number=0
  while IFS= read -r line || [[ -n $line ]]; do
    number=$((number + 1))
    if [[ $line == '# area '* ]]; then area=${line#'# area '}; fi
    [[ -n $line && $line != '#'* ]] || continue
    split "$line"
    if ((${#fields[@]} != 4)) || [[ -z $area || -z ${fields[3]} ]]; then
      bad "${list##*/}:$number: not of the form FILE | ORIGINAL | REPLACEMENT | TESTS under a line '# area NAME'"
      continue
    fi
    wants_area "$area" || continue
    mutant_area+=("$area") mutant_file+=("${fields[0]}") mutant_from+=("${fields[1]}") mutant_to+=("${fields[2]}")
    mutant_tests+=("${fields[3]}")
  done < "$list"
}

# count_matches TEXT FILE: how often the text stands in the file.
count_matches() {
  TEXT=$1 awk '
    { rest = $0
      while ((at = index(rest, ENVIRON["TEXT"])) > 0) { ++num; rest = substr(rest, at + length(ENVIRON["TEXT"])) } }
    END { print num + 0 }' "$2"
}

# check_mutant I: each must fit exactly one place of the code.
check_mutant() {
  local file=$AIRDOS_ROOT/${mutant_file[$1]} num
  if [[ ! -f $file ]]; then
    bad "${mutant_file[$1]}: there is no such file"
    return
  fi
  num=$(count_matches "${mutant_from[$1]}" "$file")
  ((num == 1)) || bad "${mutant_file[$1]}: '${mutant_from[$1]}' stands there $num times, not once"
  [[ ${mutant_from[$1]} != "${mutant_to[$1]}" ]] || bad "${mutant_file[$1]}: '${mutant_from[$1]}' is not changed"
}

# reason_of I: why that mutant may survive; empty if nobody said.
reason_of() {
  local line
  [[ -f $lists/survivors.txt ]] || return 0
  while IFS= read -r line; do
    [[ -n $line && $line != '#'* ]] || continue
    split "$line"
    if [[ ${fields[0]} == "${mutant_file[$1]}" && ${fields[1]} == "${mutant_from[$1]}" &&
      ${fields[2]:-} == "${mutant_to[$1]}" ]]; then
      echo "${fields[3]:-}"
      return
    fi
  done < "$lists/survivors.txt"
}

# check_survivors: a reason must belong to a mutant, or it is stale as well.
check_survivors() {
  local line i found
  [[ -f $lists/survivors.txt && ${#areas[@]} == 0 ]] || return 0
  while IFS= read -r line; do
    [[ -n $line && $line != '#'* ]] || continue
    split "$line"
    found=no
    for i in "${!mutant_file[@]}"; do
      [[ ${fields[0]} != "${mutant_file[$i]}" || ${fields[1]:-} != "${mutant_from[$i]}" ||
        ${fields[2]:-} != "${mutant_to[$i]}" ]] || found=yes
    done
    [[ $found == yes && -n ${fields[3]:-} ]] || bad "survivors.txt: no mutant, or no reason: $line"
  done < "$lists/survivors.txt"
}

shopt -s nullglob
for list in "$lists"/mutants_*.txt; do read_list "$list"; done
num_mutants=${#mutant_file[@]}
((num_mutants > 0 || num_bad > 0)) || die_usage "no mutants in $lists for: ${areas[*]:-all areas}"
for ((i = 0; i < num_mutants; ++i)); do check_mutant "$i"; done
check_survivors
if [[ $only_list == yes ]]; then
  printf '%s\n' "${mutant_area[@]}" | sort | uniq -c | awk '{ num = $1; sub(/^ *[0-9]+ /, ""); printf "%4d  %s\n", num, $0 }'
  ((num_bad == 0)) || die "$num_bad lines of the lists do not fit the code any more"
  exit 0
fi
((num_bad == 0)) || die "$num_bad lines of the lists do not fit the code any more: nothing was run"

# copy_tree FOLDER: the tree as git knows it, with what is not committed; only what differs is touched.
copy_tree() {
  local folder=$1 file
  mkdir -p "$folder"
  git -C "$AIRDOS_ROOT" ls-files -z -co --exclude-standard | while IFS= read -r -d '' file; do
    [[ -f $AIRDOS_ROOT/$file ]] || continue
    cmp -s "$AIRDOS_ROOT/$file" "$folder/$file" && continue
    mkdir -p "$folder/$(dirname "$file")"
    cp "$AIRDOS_ROOT/$file" "$folder/$file"
  done
  (cd "$folder" && find . -path ./build -prune -o -type f -print) | while IFS= read -r file; do
    [[ -f $AIRDOS_ROOT/$file ]] || rm -f "$folder/$file"
  done
}

# build_tests WORKER TESTS: those programs. The build folder lies in the sources as everybody's does: the compiler's cache knows
# all but the mistake.
build_tests() {
  local -a targets
  read -ra targets <<< "$2"
  CCACHE_BASEDIR=$1 cmake --build "$1/source/build" -- -j"$(nproc)" "${targets[@]}"
}

# run_test WORKER TEST: with a time limit, until the first failure. AIRDOS_DATA_DIR is as in this environment.
run_test() {
  (cd "$1/source/build" && GTEST_FAIL_FAST=1 GTEST_BRIEF=1 timeout --kill-after=10 "$timeout_s" "bin/$2")
}

# prepare WORKER: copy, configuration, and all tests without a mistake: built by each worker, run by the first.
prepare() {
  local worker=$1 all test cache=()
  copy_tree "$worker/source"
  ! command -v ccache > /dev/null || cache=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  cmake -S "$worker/source" -B "$worker/source/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DAIRDOS_BUILD_JAVA=OFF \
    "${cache[@]}" > "$worker/configure.log" 2>&1 ||
    die "cannot be configured (log: $worker/configure.log)"
  all=$(printf '%s\n' "${mutant_tests[@]}" | tr ' ' '\n' | sort -u | tr '\n' ' ')
  build_tests "$worker" "$all" > "$worker/build.log" 2>&1 || die "does not build (log: $worker/build.log)"
  [[ $worker == "$build/1" ]] || return 0
  for test in $all; do
    run_test "$worker" "$test" > "$worker/$test.log" 2>&1 ||
      die "$test fails without any mistake (log: $worker/$test.log)"
  done
}

# judge WORKER I: builds and runs the tests on the tree as it is now; prints the verdict and what noticed it.
judge() {
  local worker=$1 log=$build/log_$2.txt test code
  : > "$log"
  for test in ${mutant_tests[$2]}; do
    if ! build_tests "$worker" "$test" >> "$log" 2>&1; then
      printf 'invalid\t%s\n' "it does not compile: $log"
      return
    fi
    code=0
    run_test "$worker" "$test" >> "$log" 2>&1 || code=$?
    if ((code == 124 || code == 137)); then
      printf 'killed\t%s\n' "$test: timeout"
      return
    elif ((code != 0)); then
      printf 'killed\t%s\n' "$test: $(sed -n 's/^\[  FAILED  \] \([^ (,]*\).*/\1/p' "$log" | head -1)"
      return
    fi
  done
  printf 'survived\t-\n'
}

# run_mutant WORKER I: leaves a line in result_I.tsv. The file is written anew both times, so that ninja sees the change.
run_mutant() {
  local worker=$1 file=$1/source/${mutant_file[$2]} verdict
  cp "$file" "$worker/original"
  FROM=${mutant_from[$2]} TO=${mutant_to[$2]} awk '
    { at = index($0, ENVIRON["FROM"])
      if (at > 0) $0 = substr($0, 1, at - 1) ENVIRON["TO"] substr($0, at + length(ENVIRON["FROM"]))
      print }' "$worker/original" > "$file"
  verdict=$(judge "$worker" "$2")
  cp "$worker/original" "$file"
  printf '%s\t%s\t%s -> %s\t%s\n' "${mutant_area[$2]}" "${mutant_file[$2]}" "${mutant_from[$2]}" "${mutant_to[$2]}" \
    "$verdict" > "$build/result_$2.tsv"
  say "$(($2 + 1))/$num_mutants ${mutant_file[$2]}: '${mutant_from[$2]}' -> '${mutant_to[$2]}': ${verdict/$'\t'/, }" >&2
}

# run_worker NUMBER: every N-th mutant. Neighbours in the lists are in one file: so each worker builds each file.
run_worker() {
  local worker=$build/$1 i
  mkdir -p "$worker"
  prepare "$worker"
  for ((i = $1 - 1; i < num_mutants; i += jobs)); do run_mutant "$worker" "$i"; done
}

mkdir -p "$build"
build=$(cd "$build" && pwd)
rm -f "$build"/result_*.tsv "$build"/log_*.txt
workers=()
end_workers() {
  local pid
  for pid in "${workers[@]}"; do kill -TERM -- "-$pid" 2> /dev/null || true; done
}
trap end_workers EXIT
set -m # a process group each, to be ended as a whole
for ((number = 1; number <= jobs; ++number)); do
  run_worker "$number" &
  workers+=($!)
done
set +m
has_failed=no
for pid in "${workers[@]}"; do wait "$pid" || has_failed=yes; done
workers=()
[[ $has_failed == no ]] || die "a worker failed (see above)"

for ((i = 0; i < num_mutants; ++i)); do
  printf '%s\t%s\n' "$(cat "$build/result_$i.tsv")" "$(reason_of "$i")"
done > "$build/result.tsv"
awk -F '\t' '
  { ++num[$1]; if (!($1 in order)) { order[$1] = ++last; name[last] = $1 } }
  $4 == "killed" { ++killed[$1] }
  $4 == "survived" { ++survived[$1]; list[++n] = $1 "\t" $2 "\t" $3 "\t" ($6 == "" ? "**none**" : $6) }
  $4 == "invalid" { print "invalid: " $2 ": " $3 ": " $5 > "/dev/stderr"; ++invalid }
  $4 == "survived" && $6 == "" { ++open }
  END {
    print "| area | mutants | killed | survived |\n|---|---|---|---|"
    for (i = 1; i <= last; ++i) printf "| %s | %d | %d | %d |\n", name[i], num[name[i]], killed[name[i]], survived[name[i]]
    if (n > 0) print "\n| survivor | in | reason |\n|---|---|---|"
    for (i = 1; i <= n; ++i) { split(list[i], f, "\t"); gsub(/\|/, "\\|", f[3]); printf "| `%s` | %s | %s |\n", f[3], f[2], f[4] }
    exit open + invalid > 0
  }' "$build/result.tsv"
