#!/bin/bash
# The site of the pages: that of this tree is built without a complaint, and what would be broken in it stops the build.
# Usage: docs_test.sh SOURCE_DIR
set -euo pipefail
# shellcheck source=tests/system/script_checks.sh
source "$(dirname "${BASH_SOURCE[0]}")/script_checks.sh"

for package in mkdocs mkdocs-material python3-pymdownx katex libjs-katex graphviz; do
  [[ $(dpkg-query -W -f='${db:Status-Status}' "$package" 2> /dev/null) == installed ]] || {
    echo "SKIPPED: no package $package (launch_scripts/setup.sh --development)"
    exit 77
  }
done

readonly root=$work/root
readonly docs=$root/launch_scripts/docs.sh site=$root/build/site

make_root() {
  mkdir -p "$root"/{examples,lcmtypes,logs,tests/mutation,common}
  cp -r "$source_dir"/{docs,*.md,LICENSE} "$root"
  (cd "$source_dir" && cp --parents {examples,lcmtypes,logs,tests/mutation}/README.md "$root")
  mkdir "$root/launch_scripts"
  cp -r "$scripts"/{docs,docs.sh,setup.sh,common.sh} "$root/launch_scripts/"
  # Those of the reference are not asked for here.
  sed -i 's/^\(AIRDOS_DOCS_PACKAGES\)=.*/\1=(mkdocs)/' "$root/launch_scripts/setup.sh"
  cp "$source_dir/CMakeLists.txt" "$root"
}

the_pages_become_a_site() {
  run 0 "$docs" --no-api
  says out ' 0 broken links'
  grep -q '<svg' "$site/docs/architecture.html" || fail "no picture of the processes"
  grep -q 'class="katex"' "$site/docs/derivations.html" || fail "no formulas"
  ! grep -qE 'katex-error|\\frac\{[^<]*</(p|code)>' "$site/docs/derivations.html" || fail "a formula is not set"
  ls "$site"/katex/fonts/*.woff2 > /dev/null || fail "no fonts for the formulas"
}

make_small_root() {
  rm -rf "$root"/*.md "$root"/docs/*
  mkdir "$root/docs/images"
  printf '# Start\n' | tee "$root/README.md" "$root/CONTRIBUTING.md" "$root/CHANGELOG.md" "$root/THIRD_PARTY_LICENSES.md" \
    "$root/examples/README.md" "$root/lcmtypes/README.md" "$root/logs/README.md" "$root/tests/mutation/README.md" > /dev/null
  printf '# Pages\n\n1. [One](one.md): the first\n' > "$root/docs/README.md"
  printf 'int a;\n' > "$root/common/a.h"
}

# page CODE TEXT: with stdin as the page one.md; the end of the log says the text where it fails.
page() {
  cat > "$root/docs/one.md"
  run "$1" "$docs" --no-api
  if (($1 > 0)); then says err "$2"; fi
}

what_is_broken_stops_the_build() {
  page 0 '' <<< $'# One\n\n## A part\n\n[here](#a-part) [there](README.md) [code](../common/a.h) $x$\n\n```math\ny\n```\n\n```mermaid\nflowchart TD\n  a["A<br/>B"]\n  a -- "to" --> b\n```'
  [[ -e $site/common/a.h ]] || fail "the file that a page links to is not there"
  page 1 "nowhere.md" <<< $'# One\n\n[there](nowhere.md)'
  page 1 "docs/one.html: #no-part leads to no such heading" <<< $'# One\n\n[there](#no-part)'
  page 1 "http://example.invalid/a.png is loaded from elsewhere" <<< $'# One\n\n![a](http://example.invalid/a.png)'
  page 1 "formula '\\frac'" <<< $'# One\n\nand $\\frac$'
  page 1 "this line of a flow chart is not understood: a ==> b" <<< $'# One\n\n```mermaid\nflowchart TD\n  a ==> b\n```'
  echo '# Two' > "$root/docs/two.md"
  page 1 "docs/README.md does not list two.md" <<< '# One'
}

make_root
the_pages_become_a_site
make_small_root
what_is_broken_stops_the_build
expect 0 "Usage: launch_scripts/docs.sh" "$docs" --help
expect 2 "--no-such-option" "$docs" --no-such-option
echo "all checks passed"
