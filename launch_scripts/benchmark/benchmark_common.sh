# shellcheck shell=bash
# Shared by the benchmark scripts: a run on one sequence, and several runs in parallel. Source it after common.sh.

# Number of processor cores, the default for --jobs.
num_cores() { nproc 2> /dev/null || echo 1; }

# parse_options NAMES ARGUMENT…: sets the variable of each option that is named (run-dir fills run_dir) and collects what is no
# option in the array operands, without a / at its end, and --set, where it is named, in replay_options.
parse_options() {
  local names=" $1 " name
  shift
  operands=() replay_options=()
  while (($# > 0)); do
    name=${1#--}
    if [[ $1 == --help || $1 == -h ]]; then
      print_help
      exit 0
    elif [[ $1 == -* ]]; then
      [[ $1 == --* && $names == *" $name "* ]] || die_usage "unknown option '$1' (see --help)"
      need_value "$@"
      if [[ $name == set ]]; then replay_options+=(--set "$2"); else printf -v "${name//-/_}" '%s' "$2"; fi
      shift
    else
      operands+=("${1%/}")
    fi
    shift
  done
}

# need_number OPTION VALUE: requires a whole number above zero.
need_number() { [[ $2 =~ ^[1-9][0-9]*$ ]] || die_usage "$1: not a whole number above 0: '$2'"; }

# need_modes LIST [OPTION]: requires modes of people.
need_modes() {
  local mode option=${2:---modes}
  [[ $1 =~ [^[:space:]] ]] || die_usage "$option: the list is empty"
  for mode in $1; do
    [[ $mode =~ ^(off|mask_only|on)$ ]] || die_usage "$option: '$mode' is none of off, mask_only, on"
  done
}

# need_benchmark_programs: requires what every benchmark runs.
need_benchmark_programs() {
  need_program airdos-replay
  need_program airdos-evaluate
  command -v jq > /dev/null || die "jq is missing: apt-get install jq"
}

# need_sequences FOLDER…: requires folders with distinct names, because results are filed by name.
need_sequences() {
  local folder
  local -A seen=()
  (($# > 0)) || die_usage "no sequence given (see --help)"
  for folder in "$@"; do
    [[ -d $folder ]] || die_usage "no folder '$folder'"
    [[ -z ${seen[${folder##*/}]:-} ]] || die_usage "two sequences are named '${folder##*/}'"
    seen[${folder##*/}]=1
  done
}

# replay_sequence NAME FOLDER RUN REPLAY_OPTION…: runs all processes on a sequence, leaves trajectories, the map and
# timing.json in the folder RUN. NAME is used in error messages.
replay_sequence() {
  local name=$1 folder=$2 run=$3
  shift 3
  mkdir -p "$run"
  rm -f "$run/evaluation.json" # of an earlier run
  "$AIRDOS_BIN/airdos-replay" "$folder" --run-dir "$run" --timing "$run/timing.json" --no-progress --threads 1 "$@" \
    > "$run/replay.log" 2>&1 || die "$name: airdos-replay failed (log: $run/replay.log)"
}

# evaluate_run NAME RUN EVALUATE_OPTION…: leaves evaluation.json, .txt and trajectory.png beside the trajectory.
evaluate_run() {
  local name=$1 run=$2
  shift 2
  "$AIRDOS_BIN/airdos-evaluate" trajectory --estimate "$run/trajectory.tum" --ground-truth "$run/ground_truth.tum" \
    --json "$run/evaluation.json" --plot "$run/trajectory.png" "$@" \
    > "$run/evaluation.txt" 2>&1 || die "$name: airdos-evaluate failed (log: $run/evaluation.txt)"
}

# number_of PATH FILE: a number from one of our JSON files.
number_of() { jq -r ".$1" "$2"; }

# axes_of EVALUATION_JSON: the detected axes of the ground truth, for --gt-axes.
axes_of() { jq -r '.ground_truth_axes | ascii_downcase' "$1"; }

running_jobs=0 failed_jobs=0

# start_job LIMIT COMMAND…: runs a command in the background, at most LIMIT at a time.
start_job() {
  local limit=$1
  shift
  if ((running_jobs >= limit)); then
    wait -n || failed_jobs=$((failed_jobs + 1))
    running_jobs=$((running_jobs - 1))
  fi
  set -m # a process group of its own, which end_jobs can end as a whole
  "$@" &
  set +m
  running_jobs=$((running_jobs + 1))
}

# wait_for_jobs: waits until all have ended; failed_jobs counts those that failed.
wait_for_jobs() {
  while ((running_jobs > 0)); do
    wait -n || failed_jobs=$((failed_jobs + 1))
    running_jobs=$((running_jobs - 1))
  done
}

# finish_jobs: the same, but ends the script if one failed (and has reported why).
finish_jobs() {
  wait_for_jobs
  ((failed_jobs == 0)) || die "$failed_jobs of the runs failed"
}

# For a trap on EXIT: no run continues after the script has ended.
end_jobs() {
  local pid
  for pid in $(jobs -p); do kill -TERM -- "-$pid" 2> /dev/null || true; done
}
