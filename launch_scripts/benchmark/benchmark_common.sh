# shellcheck shell=bash
# Shared by the benchmark scripts: one run on one sequence, all runs of a benchmark, and tables of their figures. Source it
# after common.sh.
# shellcheck disable=SC2154 # run_dir, jobs and sequences are the script's

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

# need_dataset: sets dataset to the one folder that was given.
need_dataset() {
  ((${#operands[@]} < 2)) || die_usage "more than one folder: '${operands[1]}' (see --help)"
  ((${#operands[@]} == 1)) || die_usage "no folder given (see --help)"
  dataset=${operands[0]}
  [[ -d $dataset ]] || die_usage "no folder '$dataset'"
}

# need_number OPTION VALUE: requires a whole number above zero.
need_number() { [[ $2 =~ ^[1-9][0-9]*$ ]] || die_usage "$1: not a whole number above 0: '$2'"; }

# need_modes LIST [OPTION]: requires modes of people; sets the array mode_list to its words.
need_modes() {
  local mode option=${2:---modes}
  [[ $1 =~ [^[:space:]] ]] || die_usage "$option: the list is empty"
  # shellcheck disable=SC2206 # words
  mode_list=($1)
  for mode in "${mode_list[@]}"; do
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
  [[ -s $run/ground_truth.tum ]] || die "$name: no ground truth (gt_pose.txt; of KITTI tracking oxts and calib)"
  "$AIRDOS_BIN/airdos-evaluate" trajectory --estimate "$run/trajectory.tum" --ground-truth "$run/ground_truth.tum" \
    --json "$run/evaluation.json" --plot "$run/trajectory.png" "$@" \
    > "$run/evaluation.txt" 2>&1 || die "$name: airdos-evaluate failed (log: $run/evaluation.txt)"
}

# number_of PATH FILE: a number from one of our JSON files.
number_of() { jq -r ".$1" "$2"; }

# axes_of EVALUATION_JSON: the detected axes of the ground truth, for --gt-axes.
axes_of() { jq -r '.ground_truth_axes | ascii_downcase' "$1"; }

# run_with_axes_of REFERENCE NAME FOLDER RUN REPLAY_OPTION…: replays and evaluates. A failing estimate may be too bad to tell the
# axes of the ground truth: they come from the run in the folder REFERENCE, if RUN is another one.
run_with_axes_of() {
  local reference=$1/evaluation.json name=$2 folder=$3 run=$4 axes=auto
  shift 4
  replay_sequence "$name" "$folder" "$run" "$@"
  if [[ $run/evaluation.json != "$reference" ]]; then
    [[ -e $reference ]] || die "$name: no figures, because $reference is missing"
    axes=$(axes_of "$reference")
  fi
  evaluate_run "$name" "$run" --gt-axes "$axes"
}

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

# for_each LIST… -- COMMAND…: the command with every combination of an element of each array LIST behind it, those of the last
# list changing fastest.
for_each() {
  local element
  if [[ $1 == -- ]]; then
    "${@:2}"
    return
  fi
  local -n elements=$1
  for element in "${elements[@]}"; do for_each "${@:2}" "$element"; done
}

# start_runs WAIT REFERENCE LIST…: run_one with every combination of an element of each array LIST, $jobs at a time, until
# WAIT (wait_for_jobs or finish_jobs) is through. REFERENCE: what follows an element of the first list (words) in the run that
# others take their axes from; it is made first, and whatever the lists say. Empty: none is.
start_runs() {
  local wait=$1 reference=$2
  shift 2
  if [[ -n $reference ]]; then
    for_each "$1" -- start_reference
    "$wait"
  fi
  for_each "$@" -- start_other
  "$wait"
}
# shellcheck disable=SC2086 # words
start_reference() { start_job "$jobs" run_one "$1" $reference; }
start_other() { [[ ${*:2} == "$reference" ]] || start_job "$jobs" run_one "$@"; }

# run_of FOLDER WORD…: the folder of the run with these words on that sequence.
run_of() {
  local IFS=/
  set -- "${1##*/}" "${@:2}"
  echo "$run_dir/$*"
}

# collect_rows LIST…: runs.jsonl of the rows that the runs (see start_runs) left.
collect_rows() { for_each "$@" -- print_row > "$run_dir/runs.jsonl"; }
print_row() { cat "$(run_of "$@")/row.json"; }

# table_row CELL…: of Markdown.
table_row() { printf '|' && printf ' %s |' "$@" && echo; }

# ate_cell DECIMALS NAME MODE: ATE, with the share of the frames that have a pose where that is not all. is_there NAME is the
# script's.
ate_cell() {
  local file=$run_dir/$2/$3/evaluation.json completeness
  if ! is_there "$2"; then
    echo missing
  elif [[ ! -e $file ]]; then
    echo failed
  else
    completeness=$(jq -r '100 * .completeness | floor' "$file")
    printf "%.$1f" "$(number_of ate_se3_m.rmse "$file")"
    ((completeness == 100)) || printf ' (%d %%)' "$completeness"
    echo
  fi
}

# ate_table TITLE DECIMALS ["METHOD FIGURE…"]…: a column for each of sequences, a row for each METHOD with its published figures
# (of the first sequences), and a row for each of mode_list with ours.
ate_table() {
  local title=$1 decimals=$2 published mode name cells
  shift 2
  table_row "$title" "${sequences[@]}"
  printf '|---|' && printf '%.0s---|' "${sequences[@]}" && echo
  for published in "$@"; do
    read -r -a cells <<< "$published"
    cells[0]+=', published'
    while ((${#cells[@]} <= ${#sequences[@]})); do cells+=(''); done
    table_row "${cells[@]}"
  done
  for mode in "${mode_list[@]}"; do
    cells=()
    for name in "${sequences[@]}"; do cells+=("$(ate_cell "$decimals" "$name" "$mode")"); done
    table_row "ours, people $mode" "${cells[@]}"
  done
}

# For a trap on EXIT: no run continues after the script has ended.
end_jobs() {
  local pid
  for pid in $(jobs -p); do kill -TERM -- "-$pid" 2> /dev/null || true; done
}
