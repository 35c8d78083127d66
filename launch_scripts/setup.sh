#!/bin/bash
# Installs what is missing (Debian 12 packages, with apt-get) and builds AirDOS into build/.
#
# Usage: launch_scripts/setup.sh [--packages-only]
#   --packages-only  install packages, do not build
#   --help           this text
#
# Nothing is installed that is there already. As a user, sudo is asked for. demo.sh and test.sh source this file.
set -euo pipefail
# shellcheck source=launch_scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

# libopencv-dev as a whole: the CMake configuration of OpenCV lies in it and checks that every module is there.
AIRDOS_PACKAGES=(
  cmake g++ ninja-build
  liblcm-dev liblcm-bin liblcm-java libjchart2d-java
  libopencv-dev libpng-dev libeigen3-dev libceres-dev libyaml-cpp-dev libzstd-dev libssl-dev libcli11-dev nlohmann-json3-dev
  zlib1g-dev libgtest-dev libgmock-dev libbenchmark-dev
  default-jdk-headless default-jre
  iproute2 xvfb xauth jq
)

# What package.sh takes besides.
AIRDOS_PACKAGING_PACKAGES=(dpkg-dev file help2man)
# What test.sh takes besides: the fuzz targets (fuzz.sh) are built with clang's libFuzzer.
# shellcheck disable=SC2034
AIRDOS_TEST_PACKAGES=(clang libclang-rt-14-dev "${AIRDOS_PACKAGING_PACKAGES[@]}" lintian systemd)

# The tiers of tests that run under sanitizers.
readonly AIRDOS_SANITIZED_TIERS='unit numeric node'

is_installed() { [[ $(dpkg-query -W -f='${db:Status-Status}' "$1" 2> /dev/null) == installed ]]; }

# install_packages [FURTHER PACKAGES…]
# shellcheck disable=SC2120
install_packages() {
  local -a packages=("${AIRDOS_PACKAGES[@]}" "$@")
  command -v dpkg-query > /dev/null || die "this set-up knows Debian and apt-get only; install by hand: ${packages[*]}"
  local package
  local -a missing=() as_root=()
  for package in "${packages[@]}"; do
    is_installed "$package" || missing+=("$package")
  done
  if ((${#missing[@]} == 0)); then
    say "all ${#packages[@]} packages are installed"
    return
  fi
  if ((EUID != 0)); then
    command -v sudo > /dev/null || die "no root and no sudo; ask an administrator for: apt-get install ${missing[*]}"
    as_root=(sudo)
  fi
  local log=$AIRDOS_ROOT/build/packages.log
  mkdir -p "$AIRDOS_ROOT/build"
  say "installing ${missing[*]} (takes some minutes; log: $log)"
  local -a apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -y -o Acquire::Retries=3)
  run_logged "$log" "${apt[@]}" update
  run_logged "$log.install" "${apt[@]}" install --no-install-recommends "${missing[@]}"
}

# run_logged LOG COMMAND…: quiet unless it fails; then the end of the log and exit 1.
run_logged() {
  local log=$1
  shift
  mkdir -p "$(dirname "$log")"
  if ! "$@" > "$log" 2>&1 < /dev/null; then
    tail -n 40 "$log" >&2
    die "failed: $* (log: $log)"
  fi
}

# Keeps ninja's lines in a log and shows how far it is: on a terminal in one line, else every tenth.
show_progress() {
  local log=$1 line shown=-1 tenth
  : > "$log"
  while IFS= read -r line; do
    printf '%s\n' "$line" >> "$log"
    [[ $line =~ ^\[([0-9]+)/([0-9]+)\] ]] || continue
    if [[ -t 1 ]]; then
      printf '\r  compiled %s of %s ' "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}"
    else
      tenth=$((10 * BASH_REMATCH[1] / BASH_REMATCH[2]))
      ((tenth > shown)) && printf '  compiled %s of %s\n' "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}"
      shown=$tenth
    fi
  done
  if [[ -t 1 ]]; then printf '\n'; fi
}

# configure_and_build FOLDER "TARGETS" [CMAKE OPTIONS…]
configure_and_build() {
  local folder=$1 targets=$2
  shift 2
  local -a options=("$@" -DCMAKE_EXPORT_COMPILE_COMMANDS=ON) generator=()
  [[ -e $folder/CMakeCache.txt ]] || generator=(-G Ninja)
  if command -v ccache > /dev/null; then options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
  say "building $targets in ${folder#"$AIRDOS_ROOT"/} (logs: configure.log, compile.log there)"
  run_logged "$folder/configure.log" cmake -S "$AIRDOS_ROOT" -B "$folder" "${generator[@]}" "${options[@]}"
  local -a words
  read -ra words <<< "$targets"
  if ! cmake --build "$folder" -j "$(nproc)" --target "${words[@]}" 2>&1 < /dev/null |
    show_progress "$folder/compile.log"; then
    grep -A 30 -m 1 -E 'FAILED:|[Ee]rror' "$folder/compile.log" >&2 || tail -n 40 "$folder/compile.log" >&2
    die "the build failed (log: $folder/compile.log)"
  fi
}

build_programs() { configure_and_build "$AIRDOS_ROOT/build" airdos_programs -DCMAKE_BUILD_TYPE=Release; }

setup_main() {
  local packages_only=no
  while (($# > 0)); do
    case $1 in
      --packages-only) packages_only=yes ;;
      --help | -h)
        print_help
        exit 0
        ;;
      *) die_usage "unknown option '$1' (see --help)" ;;
    esac
    shift
  done
  install_packages
  if [[ $packages_only == no ]]; then build_programs; fi
}

if [[ ${BASH_SOURCE[0]} == "$0" ]]; then setup_main "$@"; fi
