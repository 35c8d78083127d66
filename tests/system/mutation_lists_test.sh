#!/bin/bash
# Usage: mutation_lists_test.sh SOURCE: each mutant of tests/mutation/mutants_*.txt still fits the code, and the script that
# runs them says so where one does not. Builds nothing.
set -uo pipefail

source=$1
run=$source/tests/mutation/run.sh
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
num_failed=0

fail() {
  echo "FAILED: $*"
  num_failed=$((num_failed + 1))
}

# expect CODE PATTERN ARGUMENT…: the script ends so and says that.
expect() {
  local code=$1 pattern=$2 output actual=0
  shift 2
  output=$("$run" "$@" 2>&1) || actual=$?
  ((actual == code)) || fail "run.sh $*: exit $actual instead of $code: $output"
  grep -q -- "$pattern" <<< "$output" || fail "run.sh $*: no '$pattern' in: $output"
}

# list LINE…: a folder of lists with these lines.
list() { printf '%s\n' '# area x' "$@" > "$folder/mutants_x.txt"; }

expect 0 'geometry' --list
expect 2 'unknown option' --nothing
expect 2 'whole number' --jobs 0
expect 2 'no mutants' --list --area nowhere
expect 0 '^# \{0,1\}\|Usage' --help

readonly line='common/geometry/se3.cc | return {q, -(q * translation)};'
list "$line | return {q, q * translation}; | geometry_test"
expect 0 '1  x' --list --lists "$folder"
list "$line | return {q, q * translation};"
expect 1 'not of the form' --list --lists "$folder"
list "$line | return {q, -(q * translation)}; | geometry_test"
expect 1 'is not changed' --list --lists "$folder"
list 'common/geometry/se3.cc | no such text |  | geometry_test'
expect 1 'stands there 0 times' --list --lists "$folder"
list 'common/geometry/se3.cc | return | throw | geometry_test'
expect 1 'stands there [0-9]* times, not once' --list --lists "$folder"
list 'common/nowhere.cc | a | b | geometry_test'
expect 1 'no such file' --list --lists "$folder"
list "$line | return {q, q * translation}; | geometry_test"
echo 'common/geometry/se3.cc | something else | b | it is equivalent' > "$folder/survivors.txt"
expect 1 'no mutant, or no reason' --list --lists "$folder"

# Each of the programs that are named is a test of ours.
while read -r test; do
  grep -rqs "airdos_test($test " "$source"/tests/*/CMakeLists.txt "$source"/tests/*/*.cmake || grep -rqs "foreach(name.* ${test}[ )]" \
    "$source"/tests/*/CMakeLists.txt || fail "there is no test '$test'"
done < <(grep -hv '^#' "$source"/tests/mutation/mutants_*.txt | sed '/^$/d; s/.* | //' | tr ' ' '\n' | sort -u)

((num_failed == 0))
