#!/bin/bash
# The Debian packages: what is in them, and that they work where nothing else of AirDOS is: a root of its own, over this machine's,
# in which the source and build folders are empty.
# Usage: packages_test.sh SOURCE_DIR BUILD_DIR
set -euo pipefail

readonly source_dir=$1 build=$2 log=/usr/share/airdos/logs/road_crossing06.lcm
readonly EXIT_SKIPPED=77
skip() {
  echo "SKIPPED: $*"
  exit "$EXIT_SKIPPED"
}
fail() {
  echo "FAILED: $*"
  exit 1
}

for tool in dpkg-shlibdeps:dpkg-dev file:file help2man:help2man; do
  command -v "${tool%:*}" > /dev/null || skip "no ${tool%:*} (package ${tool#*:}), without which no package is made"
done

# In a mount namespace of its own from here on, whose mounts go with it.
if [[ ${3:-} != inside ]]; then
  ((EUID == 0)) || skip "no root: packages are installed as dpkg does it"
  unshare -m true 2> /dev/null || skip "no right to make a mount namespace"
  exec unshare -m --propagation private "$0" "$source_dir" "$build" inside
fi
work=$(mktemp -d)
readonly work root=$work/top/root
trap 'umount -R "$work/top" 2> /dev/null || true; rm -rf "$work"' EXIT
mkdir -p "$work/top"
mount -t tmpfs tmpfs "$work/top"
mkdir "$work/top"/{upper,work,root,packages}
mount -t overlay overlay -o "lowerdir=/,upperdir=$work/top/upper,workdir=$work/top/work" "$root" 2> /dev/null ||
  skip "no overlay file system"
in_root() { chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 "$@"; }
in_root dpkg --version > /dev/null 2>&1 || skip "this machine's root has its programs on other file systems"

packages_are_made() {
  AIRDOS_BIN=$build/bin DEBFULLNAME='A Maintainer' DEBEMAIL=maintainer@airdos.org \
    "$source_dir/launch_scripts/package.sh" --no-build --out "$work/top/packages" > "$work/out" 2>&1 ||
    fail "package.sh: $(cat "$work/out")"
  local version package
  version=$(sed -n 's/^project(airdos VERSION \([0-9.]*\).*/\1/p' "$source_dir/CMakeLists.txt")-1
  for package in airdos airdos-dev airdos-doc; do
    local -a found=("$work/top/packages/${package}_${version}"_*.deb)
    [[ -s ${found[0]} ]] || fail "no $package of version $version: $(ls "$work/top/packages")"
    [[ $(dpkg-deb -f "${found[0]}" Maintainer) == 'A Maintainer <maintainer@airdos.org>' ]] || fail "$package: maintainer"
    [[ $(dpkg-deb -f "${found[0]}" Section) == @(science|libdevel|doc) ]] || fail "$package: section"
  done
  [[ $(dpkg-deb -f "$work/top/packages"/airdos-dev_*.deb Depends) == *"airdos (= $version)"*liblcm-dev* ]] || fail "dev depends"
  [[ $(dpkg-deb -f "$work/top/packages"/airdos_*.deb Depends) == *libceres* || $(dpkg-deb -f "$work/top/packages"/airdos_*.deb Depends) == *liblcm1* ]] ||
    fail "the libraries are no dependencies"
}

packages_are_installed() {
  local folder
  for folder in "$source_dir" "$build"; do
    mount -t tmpfs tmpfs "$root$folder" 2> /dev/null || true # the build may lie within the source
    ! [[ -e $root$folder/bin || -e $root$folder/CMakeLists.txt ]] || fail "$folder is not hidden"
  done
  mount --rbind /proc "$root/proc"
  mount --rbind /dev "$root/dev"
  mkdir -p "$root/packages"
  mount --bind "$work/top/packages" "$root/packages"
  in_root sh -c 'dpkg -i /packages/airdos*.deb' > "$work/out" 2>&1 || fail "dpkg -i: $(cat "$work/out")"
}

# The same digests as in the build tree.
a_replay_is_the_same() {
  local here there
  "$build/bin/airdos-replay" "$source_dir/logs/road_crossing06.lcm" --no-progress --digest > "$work/here" 2> "$work/err" ||
    fail "airdos-replay in the build tree: $(cat "$work/err")"
  in_root airdos-replay "$log" --no-progress --digest > "$work/there" 2> "$work/err" || fail "airdos-replay: $(cat "$work/err")"
  here=$(cat "$work/here") there=$(cat "$work/there")
  [[ $here == *STATE_ESTIMATE* ]] || fail "no digest: $here"
  [[ $here == "$there" ]] || fail "digests differ: $here"$'\n'"$there"
  in_root airdos-frontend --help > "$work/help"
  grep -qF 'FILE=/usr/share/airdos/config/frontend.yaml' "$work/help" || fail "another configuration: $(cat "$work/help")"
}

clients_find_what_they_need() {
  in_root python3 -c 'import airdos; airdos.pose_t' || fail "no Python package"
  # shellcheck disable=SC2016
  in_root sh -c 'echo "#include <airdos/codec.h>" > /tmp/client.cc
    c++ -std=c++17 -fsyntax-only $(pkg-config --cflags airdos) /tmp/client.cc; rm /tmp/client.cc' || fail "no headers"
}

# Its options stand in its man page, and completion knows them.
options_of() { grep -oE '^  (-[a-z],)?--[a-z-]+' "$1" | grep -oE -e '--[a-z-]+'; }

each_command_has_a_page() {
  local command page option section
  for command in "$root"/usr/bin/airdos-*; do
    command=$(basename "$command")
    in_root "$command" --help > "$work/help" || fail "$command --help"
    ! grep -q launch_scripts "$work/help" || fail "$command looks into the source tree: $(cat "$work/help")"
    page=$root/usr/share/man/man1/$command.1.gz
    [[ -s $page ]] || fail "$command has no man page"
    gzip -dc "$page" | sed 's/\\-/-/g; s/\\f[BIR]//g' > "$work/page"
    for section in NAME SYNOPSIS DESCRIPTION OPTIONS; do
      grep -qx "\.SH \"*$section\"*" "$work/page" || fail "$command: no $section in its man page"
    done
    grep -q "^$command - [a-z]" "$work/page" || fail "$command: its man page does not say what it is"
    for option in $(options_of "$work/help"); do
      grep -qE -e "(^|,)$option( |$)" "$work/page" || fail "$command: $option is not in its man page"
    done
    ! grep -nE "$work|$source_dir|_CPack" "$work/page" || fail "$command: its man page names a folder of the build"
  done
}

# completes WORD… gives EXPECTED…: what bash offers for the last word, in the root.
completes() {
  local -a words=() expected
  while [[ $1 != gives ]]; do words+=("$1") && shift; done
  shift
  expected=("$@")
  # shellcheck disable=SC2016
  in_root bash -c 'cd /usr/share/airdos
    . "/usr/share/bash-completion/completions/$1"
    complete -p "$1" > /dev/null || exit 3
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
    _airdos "$1" "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD - 1]}"
    printf "%s\n" "${COMPREPLY[@]}"' _ "${words[@]}" > "$work/completed" || fail "completion of ${words[*]} ends so"
  [[ $(sort "$work/completed") == "$(printf '%s\n' "${expected[@]}" | sort)" ]] ||
    fail "'${words[*]}' is completed by: $(tr '\n' ' ' < "$work/completed")"
}

each_command_is_completed() {
  local command
  for command in "$root"/usr/bin/airdos-*; do
    command=$(basename "$command")
    in_root "$command" --help > "$work/help"
    mapfile -t options < <(options_of "$work/help")
    completes "$command" -- gives "${options[@]}"
  done
  completes airdos-frontend --log-level '' gives error warning info debug
  completes airdos-frontend --pace = r gives realtime
  completes airdos-run-live --pace '' gives lockstep realtime
  completes airdos-replay --people m gives mask_only
  completes airdos-evaluate '' gives trajectory people detections curve speed ablation
  completes airdos-evaluate trajectory --pl gives --plot
  completes airdos-calibration '' gives show convert check
  completes airdos-calibration convert --to k gives kalibr
  completes airdos-calibration check --bas gives --baseline-unit
  completes airdos-calibration show logs/ro gives logs/road_crossing06.lcm
  completes airdos-evaluate trajectory --inverted e gives estimate
  completes airdos-frontend --config con gives config
  completes airdos-map-recorder --run-dir '' gives config lcmtypes logs scripts
  completes airdos-replay --out logs/ro gives logs/road_crossing06.lcm
  completes airdos-replay logs/ro gives logs/road_crossing06.lcm
  completes airdos-frontend --deadline-s '' gives ''
}

units_are_right() {
  command -v systemd-analyze > /dev/null || return 0
  local process
  local -a units=(airdos.target airdos-network.service)
  for process in frontend human-tracker optimizer map-recorder stereo-player stereo-camera record; do units+=("airdos@$process.service"); done
  in_root systemd-analyze verify --man=no "${units[@]}" > "$work/out" 2>&1 || fail "systemd-analyze verify: $(cat "$work/out")"
  ! grep airdos "$work/out" || fail "systemd-analyze verify (see above)"
}

# What the service of the map recorder does before it starts: a closed map makes room, an open one stays.
maps_are_kept() {
  in_root sh -ec 'cd /tmp; mkdir maps; touch -d 2026-03-01T12:34:56Z maps/map.airdos maps/map.airdos.open
    /usr/share/airdos/scripts/keep_map.sh maps; test -e maps/map.airdos
    rm maps/map.airdos.open; /usr/share/airdos/scripts/keep_map.sh maps/; test ! -e maps
    test -e maps_20260301T123456Z/map.airdos; airdos-keep-map maps; rm -r maps_*' > "$work/out" 2>&1 || fail "keep_map.sh: $(cat "$work/out")"
}

nothing_is_left() {
  local path rest=''
  in_root dpkg -r airdos-doc airdos-dev airdos > "$work/out" 2>&1 || fail "dpkg -r: $(cat "$work/out")"
  umount "$root/packages"
  rmdir "$root/packages"
  # The upper layer holds what is not as it was; dpkg and man keep books, systemd-analyze makes a folder in /run. A file that was removed and never lay below is gone.
  while IFS= read -r path; do
    case $path in
      /var/lib/dpkg* | /var/log/* | /var/cache/* | /run/* | /tmp | /packages) ;;
      *) [[ -d $work/top/upper$path && -d $path ]] || rest+=" $path" ;;
    esac
  done < <(find "$work/top/upper" -mindepth 1 -printf '/%P\n')
  [[ -z $rest ]] || fail "dpkg -r leaves$rest"
  # shellcheck disable=SC2016 # dpkg's variable
  ! in_root dpkg-query -W -f '${db:Status-Status}\n' 'airdos*' 2> /dev/null | grep -x installed || fail "dpkg knows them still"
}

lintian_has_no_error() {
  command -v lintian > /dev/null || { echo "no lintian: not asked" && return; }
  lintian --allow-root --fail-on error "$work/top/packages"/airdos*.deb > "$work/out" 2>&1 || fail "lintian: $(cat "$work/out")"
}

for check in packages_are_made packages_are_installed a_replay_is_the_same clients_find_what_they_need each_command_has_a_page \
  each_command_is_completed units_are_right maps_are_kept nothing_is_left lintian_has_no_error; do
  SECONDS=0
  "$check"
  echo "ok  $check ($SECONDS s)"
done
echo "all checks passed"
