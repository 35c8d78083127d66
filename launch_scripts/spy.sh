#!/bin/bash
# Shows the processes' messages: Debian's lcm-spy with AirDOS' types and plugins.
#
# Usage: launch_scripts/spy.sh [--namespace latest|FOLDER|PID] [--lcm-url URL]
#   --namespace WHERE  enter the network of a run of run_live.sh: the latest one, the one in a folder, or that of a process id
#   --lcm-url URL      LCM URL of the processes (default: the run's, otherwise LCM_DEFAULT_URL, otherwise LCM's default)
#   --help             this text
#
# Double-click CAMERA_LEFT for the image with people, tracks and features, STATUS for the table of processes, or any other
# channel for its fields.
set -euo pipefail
# shellcheck source=launch_scripts/common.sh
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/common.sh"

url=${LCM_DEFAULT_URL:-$AIRDOS_DEFAULT_URL}
url_given=no
namespace=
while (($# > 0)); do
  case $1 in
    --namespace)
      need_value "$@"
      namespace=$2
      shift
      ;;
    --lcm-url)
      need_value "$@"
      url=$2 url_given=yes
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

ENTER_NETWORK=()
if [[ -n $namespace ]]; then
  pid=$namespace
  if [[ ! $namespace =~ ^[0-9]+$ ]]; then
    run_dir=$namespace
    [[ $namespace == latest ]] && run_dir=$AIRDOS_RUNS/latest
    [[ -r $run_dir/state ]] || die_usage "--namespace: no run of run_live.sh in '$run_dir'"
    pid=$(state_of pid "$run_dir")
    [[ $url_given == yes ]] || url=$(state_of url "$run_dir")
  fi
  enter_network "$pid"
fi

# first_file NAME PACKAGE FILE…: prints the first file that exists.
first_file() {
  local name=$1 package=$2 file
  shift 2
  for file in "$@"; do
    if [[ -e $file ]]; then
      printf '%s' "$file"
      return
    fi
  done
  die "$name is missing: install it with 'apt-get install $package'"
}
airdos_jar=
for file in "$AIRDOS_ROOT/build/share/java/airdos.jar" "$AIRDOS_ROOT/../java/airdos.jar"; do
  if [[ -e $file ]]; then airdos_jar=$file && break; fi
done
[[ -n $airdos_jar ]] || die "airdos.jar is missing: install the package airdos-dev, or build it with launch_scripts/setup.sh"
lcm_jar=$(first_file lcm.jar liblcm-java /usr/share/java/lcm.jar)
chart_jar=$(first_file jchart2d.jar libjchart2d-java /usr/share/java/jchart2d.jar)
command -v java > /dev/null || die "java is missing: install it with 'apt-get install default-jre'"
java_home=$(dirname "$(dirname "$(readlink -f "$(command -v java)")")")
[[ -e $java_home/lib/libawt_xawt.so ]] || die "this Java cannot open windows: install one with 'apt-get install default-jre'"
[[ -n ${DISPLAY:-} ]] || die "no display (DISPLAY is not set)"
# Java first looks for the X server on a local socket, so it finds it from inside a network namespace, too.
export LCM_DEFAULT_URL=$url
say "$url${namespace:+ in the network of process $pid}"
exec "${ENTER_NETWORK[@]}" java -Djava.net.preferIPv4Stack=true -Xmx512m \
  -cp "$airdos_jar:$lcm_jar:$chart_jar" lcm.spy.Spy
