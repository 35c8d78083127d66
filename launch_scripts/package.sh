#!/bin/bash
# Builds the Debian packages airdos, airdos-dev and airdos-doc into build/packages.
#
# Usage: launch_scripts/package.sh [--no-build] [--out FOLDER]
#   --no-build    take the programs as they are in build/
#   --out FOLDER  where the packages go (default build/packages), instead of those that lie there
#   --help        this text
#
# The maintainer in them is $DEBFULLNAME <$DEBEMAIL>, as Debian's own tools have it. To install them:
# apt-get install ./build/packages/*.deb
set -euo pipefail
# shellcheck source=launch_scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

build=yes
build_dir=$(dirname "$AIRDOS_BIN")
out=$build_dir/packages
while (($# > 0)); do
  case $1 in
    --no-build) build=no ;;
    --out)
      need_value "$@"
      out=$2
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

install_packages "${AIRDOS_PACKAGING_PACKAGES[@]}"
if [[ $build == yes ]]; then build_programs; fi
need_program airdos-check
# One commit, one package.
if [[ -z ${SOURCE_DATE_EPOCH:-} ]]; then
  SOURCE_DATE_EPOCH=$(git -C "$AIRDOS_ROOT" log -1 --format=%ct 2> /dev/null) || SOURCE_DATE_EPOCH=$(date +%s)
fi
export SOURCE_DATE_EPOCH
mkdir -p "$out" || die_usage "--out: '$out' cannot be made"
out=$(realpath "$out")
rm -rf "$out"/airdos*.deb "$out/_CPack_Packages"
say "making the packages (log: $out/packaging.log)"
maintainer=()
if [[ -n ${DEBEMAIL:-} ]]; then
  maintainer=(-D "CPACK_DEBIAN_PACKAGE_MAINTAINER=${DEBFULLNAME:-The AirDOS on LCM authors} <$DEBEMAIL>")
fi
run_logged "$out/packaging.log" cpack --config "$build_dir/CPackConfig.cmake" -B "$out" "${maintainer[@]}"
rm -rf "$out/_CPack_Packages"
say "packages:"
for file in "$out"/airdos*.deb; do printf '  %9s  %s\n' "$(du -h "$file" | cut -f1)" "$file"; done
