# shellcheck shell=bash disable=SC2034
# Shared by the launch scripts: the project's folder, messages, network namespaces. Source it.

AIRDOS_ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
AIRDOS_SCRIPTS=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# In the source tree or installed (share/airdos/scripts, with links in bin/).
if [[ -e $AIRDOS_ROOT/CMakeLists.txt ]]; then
  AIRDOS_BIN=${AIRDOS_BIN:-$AIRDOS_ROOT/build/bin}
  AIRDOS_RUNS=$AIRDOS_ROOT/logs/runs
else
  AIRDOS_BIN=${AIRDOS_BIN:-$AIRDOS_ROOT/../../bin}
  AIRDOS_RUNS=${XDG_STATE_HOME:-${HOME:-}/.local/state}/airdos/runs
fi
AIRDOS_DEFAULT_URL='udpm://239.255.76.67:7667?ttl=0'
# The channels of the camera and the detectors; a log may contain more.
AIRDOS_CAMERA_CHANNELS='^(CAMERA_LEFT|CAMERA_RIGHT|CALIBRATION|PERSON_KEYPOINTS_LEFT|PERSON_KEYPOINTS_RIGHT|PERSON_MASK|GROUND_TRUTH)$'
readonly AIRDOS_ROOT AIRDOS_SCRIPTS AIRDOS_BIN AIRDOS_RUNS AIRDOS_DEFAULT_URL AIRDOS_CAMERA_CHANNELS

readonly EXIT_BAD_INPUT=2

say() { printf '%s: %s\n' "$(basename "$0")" "$*"; }

# One line on stderr and exit code 1: something failed.
die() {
  say "$*" >&2
  exit 1
}

# One line on stderr and exit code 2: a wrong option, file or value.
die_usage() {
  say "$*" >&2
  exit "$EXIT_BAD_INPUT"
}

# Prints the comment at the top of the script as its help, in the form of the programs' help. An installed script uses its
# installed name and folders.
print_help() {
  local is_installed=yes
  if [[ -e $AIRDOS_ROOT/CMakeLists.txt ]]; then is_installed=no; fi
  sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0" | sed 's/^Usage: .*/&\n\nOptions:/' |
    if [[ $is_installed == yes ]]; then
      sed "s|launch_scripts/[a-z_]*\.sh|$(basename "$0")|g; s|logs/runs|${AIRDOS_RUNS/#"${HOME:-}"/\~}|g
        s|run_live\.sh|airdos-run-live|g; s|replay_log\.sh|airdos-replay-log|g; s|network_setup\.sh|airdos-network-setup|g"
    else
      cat
    fi
  echo "With --version as its only argument it prints its name, version and commit."
}

# Like the programs: "run_live.sh 0.1.0 (abc1234)".
print_version() {
  local version commit=unknown
  if [[ -e $AIRDOS_ROOT/CMakeLists.txt ]]; then
    version=$(sed -n 's/^project(airdos VERSION \([0-9.]*\).*/\1/p' "$AIRDOS_ROOT/CMakeLists.txt")
    if git -C "$AIRDOS_ROOT" ls-files --error-unmatch CMakeLists.txt > /dev/null 2>&1; then
      commit=$(git -C "$AIRDOS_ROOT" rev-parse --short=7 HEAD 2> /dev/null) || commit=unknown
    fi
    echo "$(basename "$0") $version ($commit)"
  else # installed: the version of the programs next to it
    version=$("$AIRDOS_BIN/airdos-check" --version) || die "$AIRDOS_BIN/airdos-check is missing"
    echo "$(basename "$0") ${version#* }"
  fi
}

# need_value "$@": requires a value after the option $1.
need_value() { (($# >= 2)) || die_usage "$1 needs a value (see --help)"; }

need_program() {
  [[ -x $AIRDOS_BIN/$1 ]] || die "$AIRDOS_BIN/$1 is missing: build it with launch_scripts/setup.sh"
}

# Runs a command in its own network namespace, where multicast stays on the loopback interface. Without root, it uses a
# user namespace as well.
run_in_new_network() {
  local -a unshare=(unshare -n)
  "${unshare[@]}" true 2> /dev/null || unshare=(unshare -r -n)
  "${unshare[@]}" true 2> /dev/null ||
    die "cannot create a network namespace (no root, no user namespaces); --host-network runs without one"
  # shellcheck disable=SC2016
  exec "${unshare[@]}" bash -c '
    ip link set lo up
    ip link set lo multicast on
    ip route add 224.0.0.0/4 dev lo
    exec "$@"' _ "$@"
}

# enter_network PID: sets the array ENTER_NETWORK to the command that enters the namespace of that process.
enter_network() {
  local pid=$1
  [[ $pid =~ ^[0-9]+$ ]] || die_usage "not a process id: '$pid'"
  [[ -e /proc/$pid/ns/net ]] || die "process $pid is not running"
  if [[ $(readlink "/proc/$pid/ns/net") == "$(readlink /proc/self/ns/net)" ]]; then
    ENTER_NETWORK=()
  elif ((EUID == 0)); then
    ENTER_NETWORK=(nsenter -t "$pid" -n --)
  else
    ENTER_NETWORK=(nsenter -t "$pid" -U --preserve-credentials -n --)
  fi
}

# state_of KEY FOLDER: a value that run_live.sh recorded about its run.
state_of() { sed -n "s/^$1=//p" "$2/state"; }

# A sourced file sees the arguments of its script, so this works for all of them.
if [[ ${1:-} == --version ]]; then
  print_version
  exit 0
fi
