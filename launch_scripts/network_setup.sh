#!/bin/bash
# Sets up this machine for LCM's multicast, or only checks it.
#
# Usage: launch_scripts/network_setup.sh [--interface IF] [--check]
#   --interface IF  multicast through network interface IF, to distribute processes over hosts (use ?ttl=1 in --lcm-url);
#                   default: the loopback interface, for processes on this machine only
#   --check         changes nothing; without --interface it checks the one that LCM's messages are sent
#                   through, like airdos-doctor, which comes to the same conclusion
#   --help          this text
#
# Three things are needed: the interface is up and has its multicast flag, 224.0.0.0/4 is routed through it, and sockets may have
# a receive buffer of 4 MiB (net.core.rmem_max), as lossless images require. Exit code 0: everything is fine (a buffer that only
# suffices for messages of 128 kB causes a warning); 1: something is missing and was not, or could not be, fixed; 2: wrong
# arguments. The settings do not survive a reboot. airdos-doctor tests more: other runs on the port, a round trip, disk, lcm-spy.
set -u

readonly WANTED_RMEM_BYTES=4194304
readonly LEAST_RMEM_BYTES=131072
readonly LCM_ADDRESS=239.255.76.67
interface=
check_only=false

while [ $# -gt 0 ]; do
  case $1 in
    --check) check_only=true ;;
    --interface)
      [ $# -ge 2 ] || { echo "network_setup.sh: --interface needs a name" >&2; exit 2; }
      interface=$2
      shift ;;
    -h|--help|--version)
      # shellcheck source=launch_scripts/common.sh
      . "$(dirname "$(readlink -f "$0")")/common.sh" "$1" # prints the version and exits
      print_help
      exit 0 ;;
    *) echo "network_setup.sh: unknown argument '$1'" >&2; exit 2 ;;
  esac
  shift
done

command -v ip >/dev/null || { echo "network_setup.sh: the program 'ip' is missing (package iproute2)" >&2; exit 1; }
# The interface to which the kernel routes LCM's messages; empty if there is none.
interface_in_use() { ip -4 -o route get "$LCM_ADDRESS" 2>/dev/null | sed -n 's/.* dev \([^ ]*\).*/\1/p'; }
if [ -z "$interface" ] && $check_only; then interface=$(interface_in_use); fi
interface=${interface:-lo}
ip link show dev "$interface" >/dev/null 2>&1 ||
  { echo "network_setup.sh: there is no network interface '$interface'" >&2; exit 2; }

as_root() {
  if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo "$@"; fi
}

# shellcheck disable=SC2317 # require() calls it
has_flag() { ip link show dev "$interface" | head -n 1 | grep -q "[<,]$1[,>]"; }
# shellcheck disable=SC2317 # require() calls it
is_up() { has_flag UP; }
# shellcheck disable=SC2317 # require() calls it
is_multicast() { has_flag MULTICAST; }
# shellcheck disable=SC2317 # require() calls it
has_route() {
  if $check_only; then [ "$(interface_in_use)" = "$interface" ]; return; fi
  ip -4 route show exact 224.0.0.0/4 | grep -q "dev $interface\b"
}
has_other_route() { ip -4 route show exact 224.0.0.0/4 | grep -qv "dev $interface\b"; }
rmem_bytes() { cat /proc/sys/net/core/rmem_max 2>/dev/null || echo 0; }
has_buffer() { [ "$(rmem_bytes)" -ge "$WANTED_RMEM_BYTES" ]; }

missing=0
# require TEST WHAT COMMAND...: if the test fails, runs the command and tests again
require() {
  local test=$1 what=$2
  shift 2
  if "$test"; then echo "ok       $what"; return; fi
  if ! $check_only && as_root "$@" && "$test"; then echo "set      $what"; return; fi
  echo "MISSING  $what    (mend with: sudo $*)"
  missing=1
}

require is_up "interface $interface is up" ip link set dev "$interface" up
require is_multicast "interface $interface has its multicast flag" ip link set dev "$interface" multicast on
if has_other_route; then
  # Two routes for the same addresses: do not leave it to chance which one is used.
  echo "note     another route for 224.0.0.0/4: $(ip -4 route show exact 224.0.0.0/4 | grep -v "dev $interface\b" | head -n 1)"
fi
require has_route "multicast route 224.0.0.0/4 through $interface" ip route replace 224.0.0.0/4 dev "$interface"

if has_buffer; then
  echo "ok       sockets may have a receive buffer of $WANTED_RMEM_BYTES bytes"
elif ! $check_only && as_root sysctl -q -w net.core.rmem_max=$WANTED_RMEM_BYTES 2>/dev/null && has_buffer; then
  echo "set      sockets may have a receive buffer of $WANTED_RMEM_BYTES bytes"
elif [ "$(rmem_bytes)" -lt "$LEAST_RMEM_BYTES" ]; then
  echo "MISSING  receive buffers are limited to $(rmem_bytes) bytes: messages of up to 128 kB do not fit and are lost" \
       "   (mend with: sudo sysctl -w net.core.rmem_max=$WANTED_RMEM_BYTES)"
  missing=1
else
  echo "warning  receive buffers are limited to $(rmem_bytes) bytes: images above 120 kB may be lost" \
       "(mend with: sudo sysctl -w net.core.rmem_max=$WANTED_RMEM_BYTES)"
fi
exit $missing
