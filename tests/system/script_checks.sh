# shellcheck shell=bash disable=SC2034
# Shared by the tests of the launch scripts: a folder of their own, checks, stand-ins for programs. To be sourced, with the
# source folder as $1.
#
# Nothing here depends on how fast the machine is: a stand-in waits until it is told to end, /proc is read without a process an
# entry, and what must come is waited for.

readonly source_dir=$1
readonly scripts=$source_dir/launch_scripts
work=$(mktemp -d)
readonly work
mkdir "$work/bin"

# is_stand_in FOLDER TEXT: whether that process (a folder of /proc) runs a program of this test whose name begins so.
is_stand_in() {
  local -a words=()
  { mapfile -d '' -t words < "$1/cmdline"; } 2> /dev/null || return 1
  # An interpreter and its script, or the program itself.
  [[ ${words[0]:-} == "$work/"*"/$2"* || ${words[1]:-} == "$work/"*"/$2"* ]]
}

# pids_of TEXT: of the stand-ins that run and whose names begin so. (pgrep is no part of a small Debian.)
pids_of() {
  local folder
  for folder in /proc/[0-9]*; do
    if is_stand_in "$folder" "$1"; then echo "${folder#/proc/}"; fi
  done
}

# Whatever a failed check leaves running is ended.
cleanup() {
  local pid
  for pid in $(jobs -p); do kill -TERM "$pid" 2> /dev/null || true; done
  for pid in $(pids_of ''); do kill -KILL "$pid" 2> /dev/null || true; done
  wait
  rm -rf "$work"
}
trap cleanup EXIT

fail() {
  echo "FAILED: $*"
  exit 1
}

# run CODE COMMAND…: ends with this code; what it says is in out and err.
run() {
  local code=$1 got=0
  shift
  "$@" > "$work/out" 2> "$work/err" < /dev/null || got=$?
  ((got == code)) || fail "$*: exit code $got, not $code: $(cat "$work/out" "$work/err")"
}

# expect CODE TEXT COMMAND…: the exit code, and one line on stderr that has the text; on stdout if it is 0.
expect() {
  local code=$1 text=$2
  shift 2
  run "$code" "$@"
  if ((code != 0)); then
    (($(wc -l < "$work/err") == 1)) || fail "$*: not one line: $(cat "$work/err")"
    grep -qF -e "$text" "$work/err" || fail "$*: '$(cat "$work/err")' does not say '$text'"
  else
    grep -qF -e "$text" "$work/out" || fail "$*: '$(cat "$work/out")' does not say '$text'"
  fi
}

# says out|err TEXT, says_not out|err TEXT: what the last command said or not.
says() { grep -qF -e "$2" "$work/$1" || fail "no '$2' in: $(cat "$work/out" "$work/err")"; }
says_not() { ! grep -qF -e "$2" "$work/$1" || fail "'$2' in: $(cat "$work/out" "$work/err")"; }

# ends_with out|err TEXT: its last line.
ends_with() {
  local last
  last=$(tail -n 1 "$work/$1")
  [[ $last == "$2" ]] || fail "the last line on $1 is '$last', not '$2': $(cat "$work/out" "$work/err")"
}

# await WHAT COMMAND…: until the command is true.
await() {
  local what=$1 deadline=$((SECONDS + 60))
  shift
  until "$@"; do
    ((SECONDS < deadline)) || fail "$what did not come: $(tail -n 20 "$work"/*.out "$work"/*.err 2> /dev/null)"
    sleep 0.05
  done
}

# make_script NAME: a program in bin, from stdin.
make_script() {
  {
    echo '#!/bin/bash'
    cat
  } > "$work/bin/$1"
  chmod +x "$work/bin/$1"
}

# link_tools NAME…: a folder with these programs only, for a PATH on which nothing else is found, whatever the machine has.
link_tools() {
  local tool
  mkdir "$work/tools"
  for tool in "$@"; do
    ln -s "$(command -v "$tool")" "$work/tools/$tool"
  done
}

# make_program PATH: as make_script, writes down its name and arguments first; `fails NAME` there asks FAILS.
make_program() {
  {
    cat << PROGRAM
#!/bin/bash
echo "\${0##*/} \$*" >> "$work/calls"
fails() { [[ " \${FAILS:-} " == *" \$1 "* ]]; }
PROGRAM
    cat
  } > "$1"
  chmod +x "$1"
}

# started PATTERN: how many calls there were since the last fresh.
started() { grep -cE -e "$1" "$work/calls" || true; }
fresh() { : > "$work/calls"; }

# ran COUNT PATTERN
ran() { (($(started "$2") == $1)) || fail "not $1 calls of '$2': $(cat "$work/calls")"; }

# make_process NAME: says READY after its arguments and waits; ends with 0 on SIGTERM, with the code that tell sends it.
# It opens the FIFO for writing too, so as not to see the end of a file.
make_process() {
  mkfifo "$work/$1.fifo"
  make_script "$1" << FAKE
trap 'echo "end of \$0"; exit 0' TERM
exec 3<> "$work/$1.fifo"
echo "\$0 READY \$*"
read -r -u 3 code
exit "\$code"
FAKE
}

# tell NAME CODE: one that runs ends.
tell() { echo "$2" > "$work/$1.fifo"; }

# skip_unless_networks: the rest needs network namespaces.
skip_unless_networks() {
  if ! unshare -n true 2> /dev/null && ! unshare -r -n true 2> /dev/null; then
    echo "SKIPPED: no right to make a network namespace"
    exit 77
  fi
}

# start_live ARGUMENT…: run_live.sh with the stand-ins, in the background; its folder is run.
live_pid=
live=$scripts/run_live.sh
start_live() {
  rm -rf "$work/run" "$work/live.out" "$work/live.err"
  env AIRDOS_BIN="$work/bin" PATH="$work/bin:$PATH" "$live" --run-dir "$work/run" "$@" \
    > "$work/live.out" 2> "$work/live.err" < /dev/null &
  live_pid=$!
}

end_live() {
  local expected=$1 got=0
  wait "$live_pid" || got=$?
  ((got == expected)) || fail "run_live.sh: exit code $got, not $expected: $(cat "$work/live.out" "$work/live.err")"
  [[ -z $(pids_of airdos-) ]] || fail "processes are left behind: $(pids_of airdos-)"
}
