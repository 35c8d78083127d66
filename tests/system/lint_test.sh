#!/bin/bash
# What lint.sh sees: in a small tree of its own, which is clean, one mistake of each kind is planted at a time.
# Usage: lint_test.sh SOURCE_DIR
set -euo pipefail
# shellcheck source=tests/system/script_checks.sh
source "$(dirname "${BASH_SOURCE[0]}")/script_checks.sh"

for program in clang-format clang-tidy clang++ cppcheck shellcheck yamllint python3; do
  command -v "$program" > /dev/null || {
    echo "SKIPPED: no $program (launch_scripts/setup.sh --development)"
    exit 77
  }
done

readonly root=$work/root
readonly lint=$root/launch_scripts/lint.sh tidy=$root/launch_scripts/lint/tidy.py

make_root() {
  mkdir -p "$root"/{launch_scripts,common/{util,geometry},processes,tests/system,.ci,build}
  cp -r "$scripts"/{lint.sh,setup.sh,common.sh,lint} "$root/launch_scripts/"
  cp "$source_dir"/{.clang-format,.clang-tidy,.yamllint.yml} "$root"
  cp "$source_dir/tests/system/includes_test.sh" "$root/tests/system/"
  echo 'project(airdos VERSION 1.2.3' > "$root/CMakeLists.txt"
  printf '#!/bin/bash\n' > "$root/.ci/run"
  printf 'a: 1\n' > "$root/good.yaml"
  printf 'FROM debian:12 AS build\nRUN true \\\n  && true\nFROM build\nCOPY good.yaml /\nUSER me\nCMD ["true"]\n' > "$root/Dockerfile"
  printf '#pragma once\n\n#include <vector>\n\nint Sum(const std::vector<int>& values);\n' > "$root/common/util/sum.h"
  cat > "$root/common/util/sum.cc" << 'CODE'
#include "common/util/sum.h"

namespace {
constexpr int kStart = 0;
}  // namespace

int Sum(const std::vector<int>& values) {
  int sum = kStart;
  for (const int value : values) sum += value;
  return sum;
}
CODE
}

# planted STEP TEXT FILE: with stdin as this file, that step alone fails and says the text; then the file is as it was.
planted() {
  local file=$root/$3
  [[ ! -e $file ]] || cp -p "$file" "$work/kept"
  cat > "$file"
  run 1 "$lint" --fast
  says out "$2"
  ends_with err "lint.sh: FAILED: $1"
  if [[ -e $work/kept ]]; then mv "$work/kept" "$file"; else rm "$file"; fi
}

each_step_sees_its_mistake() {
  run 0 "$lint" --fast
  ends_with out 'lint.sh: nothing to report'
  planted clang-format 'code should be clang-formatted' common/util/a.h <<< $'#pragma once\nint  A();'
  planted 'what is included' 'std::string needs #include <string>' common/util/b.h <<< $'#pragma once\nvoid B(const std::string& text);'
  planted 'which way includes point' 'stands below' common/util/c.h <<< $'#pragma once\n#include "common/geometry/d.h"'
  planted shellcheck SC2086 launch_scripts/e.sh <<< $'#!/bin/bash\nrm $1'
  planted 'YAML and JSON' 'duplication of key' good.yaml <<< $'a: 1\na: 2'
  planted 'YAML and JSON' 'bad.json: not JSON' bad.json <<< '{"a": 1,}'
  planted Dockerfile "unknown instruction 'RNU'" Dockerfile <<< $'FROM debian:12\nRNU true'
  planted cppcheck '[arrayIndexOutOfBounds]' common/util/f.cc <<< $'int F() {\n  int values[2] = {1, 2};\n  return values[2];\n}'
}

# bad_dockerfile TEXT: with stdin as the file
bad_dockerfile() {
  cat > "$work/Dockerfile"
  run 1 "$root/launch_scripts/lint/dockerfile.py" "$work/Dockerfile"
  says out "$1"
}

a_dockerfile_is_looked_at() {
  bad_dockerfile "there is no 'nothing'" <<< $'FROM debian:12\nCOPY nothing /'
  bad_dockerfile "there is no stage 'built'" <<< $'FROM debian:12 AS build\nFROM debian:12\nCOPY --from=built /a /'
  bad_dockerfile "has no fixed version" <<< 'FROM debian'
  bad_dockerfile "it runs as root" <<< $'FROM debian:12\nCMD ["true"]'
  bad_dockerfile "not a JSON list" <<< $'FROM debian:12\nUSER me\nCMD true'
  bad_dockerfile "ends within an instruction" <<< $'FROM debian:12\nRUN true \\'
}

only_what_is_named_is_looked_at() {
  printf '#pragma once\nint  A();\n' > "$root/common/util/a.h"
  run 0 "$lint" --fast "$root/launch_scripts"
  run 1 "$lint" --fast "$root/common/util/a.h"
  run 0 "$lint" --fast --fix "$root/common/util"
  grep -qx 'int A();' "$root/common/util/a.h" || fail "it is not mended"
  rm "$root/common/util/a.h"
}

# --- clang-tidy in batches

# tidied CODE: tidy.py over the units there are; calls has a line for each run of clang-tidy.
tidied() {
  local unit separator='['
  for unit in "$root"/common/*/*.cc; do
    printf '%s{"directory": "%s", "file": "%s", "command": "clang++ -I%s -std=c++17 -o x.o -c %s"}\n' "$separator" "$root/build" \
      "$unit" "$root" "$unit"
    separator=,
  done > "$root/build/compile_commands.json"
  echo ']' >> "$root/build/compile_commands.json"
  fresh
  run "$1" "$tidy" --root "$root" --build "$root/build" --program "$work/bin/clang-tidy" --jobs 1
}

unit() { cat > "$root/common/util/$1.cc"; }

make_tidy() {
  make_program "$work/bin/clang-tidy" <<< "exec $(command -v clang-tidy) \"\$@\""
  ln -s "$(command -v clang++)" "$work/bin/clang++"
}

units_are_joined_and_remembered() {
  unit one <<< $'#include "common/util/sum.h"\n\nint One() { return Sum({1}); }'
  tidied 0
  ran 1 'clang-tidy --quiet'
  says out 'clang-tidy: 2 units in 1 batches, 0 headers by themselves, 0 findings'
  tidied 0
  ran 0 'clang-tidy --quiet'
  echo 'int One(const std::vector<int>& values);' >> "$root/common/util/sum.h" # a header of both
  tidied 0
  ran 1 'clang-tidy --quiet'
}

a_mistake_in_a_batch_is_found_each_time() {
  unit two <<< $'#include <string>\n#include <utility>\n\nstd::string Two(std::string text) {\n  std::string other = std::move(text);\n  return other + text;\n}'
  tidied 1
  says out "common/util/two.cc:6:18: error: 'text' used after it was moved [bugprone-use-after-move"
  says out '1 findings'
  tidied 1
  says out 'bugprone-use-after-move'
  rm "$root/common/util/two.cc"
}

the_same_local_name_is_no_mistake() {
  unit three <<< $'namespace {\nconstexpr int kStart = 3;\n}  // namespace\n\nint Three() { return kStart; }'
  tidied 0
  says out '3 units in 1 batches'
  ran 1 'clang-tidy --quiet'
  # Nor is that of a type in a header of another unit; but one in a header of its own is not to be renamed.
  printf '#pragma once\n\nstruct Thing {};\n' > "$root/common/util/thing.h"
  unit three <<< $'#include "common/util/thing.h"\n\nThing Three() { return {}; }'
  unit three_too <<< $'namespace {\nstruct Thing {\n  int a = 0;\n};\n}  // namespace\n\nint ThreeToo() { return Thing().a; }'
  tidied 0
  says out '4 units in 1 batches'
  ran 1 'clang-tidy --quiet'
  unit three_too <<< $'#include "common/util/sum.h"\n\nnamespace {\nint values() { return 0; }\n}  // namespace\n\nint ThreeToo() { return values(); }'
  unit three <<< $'#include "common/util/thing.h"\n\nnamespace {\nint values() { return 0; }\n}  // namespace\n\nint Three() { return values(); }'
  tidied 0
  says out '4 units in 2 batches'
  ran 2 'clang-tidy --quiet'
  rm "$root"/common/util/{thing.h,three_too.cc}
  # Programs are joined, too; so is a function with an attribute with a type of its name, but not one that macros of GoogleTest name.
  unit main_one <<< $'int main() { return 1; }'
  unit main_two <<< $'int main() {}'
  printf '#pragma once\n\n// main() calls it.\n[[nodiscard]] int Ten();\n' > "$root/common/util/ten.h"
  unit ten <<< $'#include "common/util/ten.h"\n\nint Ten() { return 10; }'
  unit three <<< $'namespace {\nstruct Ten {\n  int a = 3;\n};\n}  // namespace\n\nint Three() { return Ten().a; }'
  tidied 0
  says out '6 units in 1 batches, 0 headers'
  ran 1 'clang-tidy --quiet'
  rm "$root"/common/util/{main_one,main_two,ten}.cc "$root/common/util/ten.h"
  unit three <<< $'namespace {\nint Message() { return 3; }\n}  // namespace\n\nint Three() { return Message(); }'
  unit six <<< $'namespace {\nint Message() { return 6; }\nint max() { return 6; }\n}  // namespace\n\nint Six() { return Message() + max(); }'
  unit seven <<< $'#include <algorithm>\n\nnamespace {\nint max() { return 7; }\n}  // namespace\n\nint Seven() { return max() + std::max(7, 6); }'
  tidied 0
  says out '5 units in 2 batches, 0 headers'
  ran 2 'clang-tidy --quiet'
  rm "$root"/common/util/{six,seven}.cc
  # What the names do not tell, the compiler does: such a batch is halved, and that is remembered.
  unit four <<< $'#define SAME int kStart = 4;\nnamespace {\nconst SAME\n}  // namespace\n\nint Four() { return kStart; }'
  rm "$root/common/util/three.cc"
  tidied 0
  says out '0 findings'
  says out ' batches (1 halved, which takes twice as long), '
  (($(started 'clang-tidy --quiet') > 1)) || fail "not halved: $(cat "$work/calls")"
  tidied 0
  ran 0 'clang-tidy --quiet'
  rm "$root/common/util/four.cc"
}

a_header_must_compile_by_itself() {
  printf '#pragma once\n\ninline int Lone() { return Sum({1}); }\n' > "$root/common/util/lone.h"
  unit five <<< $'#include "common/util/sum.h"\n\n#include "common/util/lone.h"\n\nint Five() { return Lone(); }'
  tidied 1
  says out "lone.h:3:28: error: use of undeclared identifier 'Sum' [by itself]"
  rm "$root"/common/util/{five.cc,lone.h}
}

make_root
each_step_sees_its_mistake
a_dockerfile_is_looked_at
only_what_is_named_is_looked_at
make_tidy
units_are_joined_and_remembered
a_mistake_in_a_batch_is_found_each_time
the_same_local_name_is_no_mistake
a_header_must_compile_by_itself
expect 0 "Usage: launch_scripts/lint.sh" "$lint" --help
expect 2 "--no-such-option" "$lint" --no-such-option
expect 2 "--jobs: not a whole number above 0: '0'" "$lint" --jobs 0
expect 2 "no file or folder '/nonexistent'" "$lint" /nonexistent
expect 2 "not in $root: '/'" "$lint" /
echo "all checks passed"
