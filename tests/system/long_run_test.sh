#!/bin/bash
# launch_scripts/long_run.sh for three minutes: nobody grows, nobody dies, no image is lost on its way. How many frames are skipped
# depends on the machine, so one in twenty may be here; the nightly 30 minutes allow none.
# Usage: long_run_test.sh SOURCE_DIR BINARY_DIR
set -euo pipefail

readonly EXIT_SKIPPED=77

if ! unshare -n true 2> /dev/null && ! unshare -r -n true 2> /dev/null; then
  echo "SKIPPED: cannot make a network namespace (no root, no user namespaces)"
  exit "$EXIT_SKIPPED"
fi
AIRDOS_BIN=$2/bin exec "$1/launch_scripts/long_run.sh" --minutes 3 --max-lost 5 --run-dir "$2/long_run"
