#!/bin/bash
# Builds the pages as a site, build/site (open build/site/index.html): no network, neither now nor when it is read.
#
# Usage: launch_scripts/docs.sh [--no-api]
#   --no-api  without the reference of the headers
#   --help    this text
#
# A link that leads nowhere, a formula or a picture that cannot be drawn, a page that docs/README.md does not list: exit 1. Where
# packages are missing and cannot be installed, one line says so, and the exit code is 77.
set -euo pipefail
# shellcheck source=launch_scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

readonly EXIT_SKIPPED=77
readonly SITE_SCRIPTS=$AIRDOS_ROOT/launch_scripts/docs

api=yes
while (($# > 0)); do
  case $1 in
    --no-api) api=no ;;
    --help | -h)
      print_help
      exit 0
      ;;
    *) die_usage "unknown option '$1' (see --help)" ;;
  esac
  shift
done

cd "$AIRDOS_ROOT"
if ! (install_only "${AIRDOS_DOCS_PACKAGES[@]}"); then
  say "SKIPPED: the site needs the packages ${AIRDOS_DOCS_PACKAGES[*]}"
  exit "$EXIT_SKIPPED"
fi

# The pages keep their places, so their links are the same here, in the site and on a forge. What they link to in the tree comes along.
readonly PAGES=$AIRDOS_ROOT/build/pages SETTINGS=$AIRDOS_ROOT/build/site-settings
rm -rf "$PAGES" "$SETTINGS" build/site
mkdir -p "$PAGES" "$SETTINGS" build/site
pages=(*.md docs/*.md examples/README.md lcmtypes/README.md logs/README.md tests/mutation/README.md)
cp -p --parents "${pages[@]}" LICENSE "$PAGES"
cp -rp --parents docs/images "$PAGES"
for page in "${pages[@]}"; do
  while IFS= read -r target; do
    file=$(realpath -m --relative-to=. "$(dirname "$page")/${target%%#*}")
    if [[ -f $file && ! -e $PAGES/$file ]]; then cp -p --parents "$file" "$PAGES"; fi
  done < <(grep -oP '\]\(\K[^)#:]+(?=[)#])' "$page" || true)
done
cp "$SITE_SCRIPTS/site.css" "$PAGES"
mkdir "$PAGES/katex"
cp -rL /usr/share/javascript/katex/katex.min.css /usr/share/javascript/katex/fonts "$PAGES/katex"
cp "$SITE_SCRIPTS"/{mkdocs.yml,hooks.py,render_math.js} "$SETTINGS"
if [[ $api == yes ]]; then echo "extra: { api: true }" >> "$SETTINGS/mkdocs.yml"; fi

# Debian keeps node's modules here, and another node than Debian's does not look there.
export NODE_PATH=/usr/share/nodejs${NODE_PATH:+:$NODE_PATH}
run_logged build/site.log mkdocs build --strict --config-file "$SETTINGS/mkdocs.yml"
if [[ $api == yes ]]; then run_logged build/site_api.log doxygen "$SITE_SCRIPTS/Doxyfile"; fi
"$SITE_SCRIPTS/check_links.py" build/site
say "build/site/index.html"
