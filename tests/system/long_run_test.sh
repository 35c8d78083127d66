#!/bin/bash
# launch_scripts/long_run.sh for two minutes in lockstep: nobody grows, nobody dies, nothing is lost on its way. In realtime pace, which it
# is made for, how many frames are skipped depends on the machine and what else it does: that is measured, not tested.
# Usage: long_run_test.sh SOURCE_DIR BINARY_DIR
set -euo pipefail

readonly EXIT_SKIPPED=77

if ! unshare -n true 2> /dev/null && ! unshare -r -n true 2> /dev/null; then
  echo "SKIPPED: cannot create a network namespace (no root, no user namespaces)"
  exit "$EXIT_SKIPPED"
fi
AIRDOS_BIN=$2/bin exec "$1/launch_scripts/long_run.sh" --minutes 2 --pace lockstep --run-dir "$2/long_run"
