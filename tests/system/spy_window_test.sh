#!/bin/bash
# Starts the real lcm-spy in a network namespace of its own, on a virtual display, and lets SpyWindowTest click in it.
# Usage: spy_window_test.sh CLASSPATH FOLDER_FOR_SCREENSHOTS [DATA_SET]. Exit code 77: skipped, with the reason.
set -euo pipefail

readonly classpath=$1
shift

skip() {
  echo "SKIPPED: $*"
  exit 77
}
command -v xvfb-run > /dev/null || skip "xvfb-run is missing (package xvfb)"
[[ -e /usr/share/java/jchart2d.jar ]] || skip "jchart2d.jar is missing (package libjchart2d-java)"
find /usr/lib/jvm -name libawt_xawt.so 2> /dev/null | grep -q . || skip "Java without windows (package default-jre)"
unshare -n true 2> /dev/null || skip "no right to make a network namespace"

mkdir -p "$1"
exec unshare -n bash -c '
  ip link set lo up
  ip link set lo multicast on
  ip route add 224.0.0.0/4 dev lo
  exec "$@"' _ \
  env LCM_DEFAULT_URL='udpm://239.255.76.67:7667?ttl=0' \
  xvfb-run --auto-servernum --server-args='-screen 0 1240x1000x24' \
  java -Djava.net.preferIPv4Stack=true -Xmx512m -ea -cp "$classpath" airdos.spy.SpyWindowTest "$@"
