#!/bin/bash
# What an outside user does: the commands of docs/clients.md build the examples against an installed tree, and these run with our
# processes: camera driver and detector -> processes -> receivers, in C++, Python and Java.
# Usage: clients_test.sh SOURCE_DIR BUILD_DIR JAR|NO_JAR
set -euo pipefail

readonly source_dir=$1 build=$2 has_jar=$3
readonly deadline_s=150
readonly num_pictures=24
if [[ -z ${CLIENTS_TEST_WORK:-} ]]; then # not yet in a network of its own
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
else
  work=$CLIENTS_TEST_WORK
fi
readonly work prefix=$work/prefix log=$source_dir/logs/road_crossing06.lcm
export PREFIX=$prefix PYTHONDONTWRITEBYTECODE=1

fail() {
  echo "FAILED: $*"
  exit 1
}

# The commands of the page, in its order; those of Java only where there is a JDK.
documented_commands_build_everything() {
  awk '/^## /{inside = $0 == "## Building a client"} /^```/{code = inside && /sh$/; next} code' \
    "$prefix/share/doc/airdos/docs/clients.md" > "$work/commands.sh"
  (($(wc -l < "$work/commands.sh") >= 7)) || fail "few commands in docs/clients.md: $(cat "$work/commands.sh")"
  if [[ $has_jar != JAR ]]; then sed -i '/^javac/d' "$work/commands.sh"; fi
  ln -s "$prefix/share/doc/airdos/examples" "$work/examples"
  (cd "$work" && bash -euo pipefail commands.sh) > "$work/build.log" 2>&1 || fail "docs/clients.md: $(tail -n 30 "$work/build.log")"
}

# Which headers they may include says includes_test; that they were enough, the commands above.
nothing_of_ours_leaks() {
  ! grep -rn 'AIRDOS_CHECK\|"common/\|"processes/' "$prefix/include" || fail "an installed header needs our source tree"
}

# Each sentence of the contract names the test that holds it.
the_contract_names_tests_that_exist() {
  local name
  (($(grep -cE '`[A-Z][A-Za-z]+[.][A-Z]' "$source_dir/docs/clients.md") > 40)) || fail "docs/clients.md names few tests"
  ! grep -n "untested" "$source_dir/docs/clients.md" || fail "docs/clients.md has a sentence without a test"
  cat "$source_dir"/tests/*/*.cc "$source_dir"/tests/unit/*/*.cc | tr -d ' \n' > "$work/tests"
  # shellcheck disable=SC2016  # the page's backquotes
  for name in $(grep -oE '`[A-Z][A-Za-z0-9]+[.][A-Z][A-Za-z0-9]+`' "$source_dir/docs/clients.md" | tr -d '`' | sort -u); do
    grep -qE "TEST(_F|_P)?\(${name/./,}\)" "$work/tests" || fail "docs/clients.md names $name, which is no test"
  done
}

components_are_apart() {
  local component file
  for component in runtime dev doc; do
    cmake --install "$build" --prefix "$work/only_$component" --component "$component" > "$work/install.log"
    (cd "$work/only_$component" && find . -type f -o -type l) | sort > "$work/$component.files"
  done
  (cd "$prefix" && find . -type f -o -type l) | sort | diff - <(sort "$work"/{runtime,dev,doc}.files) > "$work/diff" ||
    fail "files that belong to no component, or to two: $(cat "$work/diff")"
  for file in ./bin/ ./share/airdos/config/ ./share/airdos/scripts/; do
    grep -q "^$file" "$work/runtime.files" || fail "$file is not runtime"
  done
  for file in ./include/airdos/codec.h ./lib/python3/dist-packages/airdos/bus.py ./share/airdos/lcmtypes/image_t.lcm \
    ./share/cmake/airdos/ ./share/pkgconfig/; do
    grep -q "^$file" "$work/dev.files" || fail "$file is not dev"
  done
  ! grep -vE '^\./share/doc/airdos/' "$work/doc.files" || fail "these are not documentation"
}

# The sample log's pictures as a folder, as a camera may have left them.
write_pictures() {
  python3 - "$log" "$work/pictures" "$num_pictures" << 'PYTHON'
import pathlib
import sys

from airdos import LogReader, channels, image_t, stereo_calibration_t

folder, num = pathlib.Path(sys.argv[2]), int(sys.argv[3])
for event in LogReader(sys.argv[1]):
    if event.channel in (channels.CAMERA_LEFT, channels.CAMERA_RIGHT):
        image = image_t.decode(event.data)
        if image.seq < num:
            path = folder / ("image_0" if event.channel == channels.CAMERA_LEFT else "image_1") / f"{image.seq:06}.jpg"
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(image.data)
    elif event.channel == channels.CALIBRATION:
        camera = stereo_calibration_t.decode(event.data)
with open(folder / "calib.txt", "w") as file:
    for name, shift in (("P0:", 0), ("P1:", -camera.fx_px * camera.baseline_m)):
        print(name, camera.fx_px, 0, camera.cx_px, shift, 0, camera.fy_px, camera.cy_px, 0, 0, 0, 1, 0, file=file)
PYTHON
  mkdir -p "$work/few/image_0" "$work/few/image_1"
  cp "$work"/pictures/calib.txt "$work/few"
  cp "$work"/pictures/image_0/00000[0-3].jpg "$work/few/image_0"
  cp "$work"/pictures/image_1/00000[0-3].jpg "$work/few/image_1"
}

# expect_one_line TEXT COMMAND…: says it in one line, and ends with 2.
expect_one_line() {
  local text=$1 code=0
  shift
  "$@" > "$work/out" 2>&1 || code=$?
  ((code == 2)) || fail "$*: exit code $code: $(cat "$work/out")"
  if (($(wc -l < "$work/out") != 1)) || ! grep -qF "$text" "$work/out"; then
    fail "$*: not one line with '$text': $(cat "$work/out")"
  fi
}

examples_say_what_is_wrong() {
  local driver code
  mkdir -p "$work/no_calibration"/image_{0,1}
  for driver in "$work/build-examples/camera_driver" "$work/examples/camera_driver.py"; do
    for folder in "$work/nowhere" "$work/no_calibration"; do
      code=0
      "$driver" "$folder" > "$work/out" 2>&1 || code=$?
      if ((code != 2)) || ! grep -q "calib.txt" "$work/out"; then fail "$driver $folder: exit code $code: $(cat "$work/out")"; fi
    done
    code=0
    "$driver" --rate 0 "$work/few" > "$work/out" 2>&1 || code=$?
    ((code == 2)) || fail "$driver --rate 0: exit code $code: $(cat "$work/out")"
  done
  local example
  for example in who_is_near camera_driver person_detector; do
    local -a command=("$work/examples/$example.py")
    if [[ $example == camera_driver ]]; then command+=("$work/few"); fi
    expect_one_line "LCM URL 'nonsense'" env LCM_DEFAULT_URL=nonsense "${command[@]}"
    expect_one_line "no multicast route" "${new_network[@]}" "${command[@]}" # which has none yet
  done
  expect_one_line "could not convert" "$work/examples/who_is_near.py" five
}

declare -A pids=()
# start NAME COMMAND…: in the background; ended with this script.
start() {
  local name=$1
  shift
  "$@" > "$work/$name.out" 2> "$work/$name.err" < /dev/null &
  pids[$name]=$!
}

stop_all() {
  local name
  for name in "${!pids[@]}"; do kill -TERM "${pids[$name]}" 2> /dev/null || true; done
  wait
}

# await NAME PATTERN: until a line of its output has it.
await() {
  local deadline=$((SECONDS + deadline_s))
  until grep -qE "$2" "$work/$1.out"; do
    kill -0 "${pids[$1]}" 2> /dev/null || fail "$1 has ended: $(tail -n 5 "$work/$1.out" "$work/$1.err")"
    ((SECONDS < deadline)) || fail "no '$2' from $1: $(tail -n 5 "$work"/*.out "$work"/*.err)"
    sleep 0.05
  done
}

# drive NAME DRIVER ARGUMENT…: until both receivers know all poses; sets session.
session=''
drive() {
  local name=$1
  shift
  "$@" > "$work/$name.out" 2> "$work/$name.err" || fail "$*: exit code $?: $(cat "$work/$name.err")"
  [[ ! -s $work/$name.err ]] || fail "$*: $(cat "$work/$name.err")"
  session=$(sed -n 's/^published .* as session //p' "$work/$name.out")
  local last
  last=$(($(sed -n 's/^published \([0-9]*\) pairs.*/\1/p' "$work/$name.out") - 1))
  await near_cc "session $session image $last:"
  await near_py "session $session image $last:"
}

# poses_of RECEIVER SESSION: its lines without the session, which differs from run to run.
poses_of() { sed -n "s/^session $2 //p" "$work/$1.out"; }

expect_same() { diff "$1" "$2" > "$work/diff" || fail "$1 and $2 differ: $(head -n 10 "$work/diff")"; }

in_a_network() {
  local process session_cc session_py
  trap stop_all EXIT
  python3 "$source_dir/tests/system/python_bus_test.py" "$build/bin" || fail "the Python bus and LCM do not understand each other"

  for process in frontend human-tracker optimizer; do start "$process" "$prefix/bin/airdos-$process" --pace lockstep; done
  start near_cc "$work/build-examples/who_is_near" 5
  start near_py "$work/examples/who_is_near.py" 5
  start detector "$work/examples/person_detector.py" --recorded "$log"
  if [[ $has_jar == JAR ]]; then
    start java java -Djava.net.preferIPv4Stack=true -Xmx128m \
      -cp "$work/java-classes:$prefix/share/java/airdos.jar:/usr/share/java/lcm.jar" PosePrinter
    await java listening
  fi
  for process in frontend human-tracker optimizer; do await "$process" READY; done
  for process in near_cc near_py detector; do await "$process" listening; done

  drive driver_cc "$work/build-examples/camera_driver" "$work/pictures" --rate 10 --detector
  session_cc=$session
  drive driver_py "$work/examples/camera_driver.py" "$work/pictures" --rate 10 --detector
  session_py=$session
  poses_of near_cc "$session_cc" > "$work/poses"
  (($(grep -c "camera at" "$work/poses") == num_pictures)) || fail "not a pose for each picture: $(cat "$work/poses")"
  grep -qE "camera at -?[0-9.]+ -?[0-9.]+ -?[0-9.]+, [1-9][0-9]* people, person [0-9]+ at [0-9.]+ m" "$work/poses" ||
    fail "nobody is near: $(cat "$work/poses")"
  # What is said must not depend on who drives, nor on who listens.
  poses_of near_py "$session_cc" > "$work/poses_heard_in_python"
  poses_of near_cc "$session_py" > "$work/poses_driven_in_python"
  expect_same "$work/poses" "$work/poses_heard_in_python"
  expect_same "$work/poses" "$work/poses_driven_in_python"
  if [[ $has_jar == JAR ]]; then
    # Java's LCM cannot ask for a larger buffer: on a busy machine it misses some.
    sed 's/, .*//' "$work/poses" | sort > "$work/positions"
    grep '^image' "$work/java.out" | sort -u > "$work/positions_heard_in_java"
    comm -13 "$work/positions" "$work/positions_heard_in_java" > "$work/diff"
    [[ ! -s $work/diff ]] || fail "Java heard what C++ did not: $(head -n 10 "$work/diff")"
    (($(wc -l < "$work/positions_heard_in_java") >= num_pictures / 2)) || fail "Java heard little: $(cat "$work/java.out")"
  fi

  # Without a detector the drivers say that there is nobody, so that nobody is waited for.
  kill -TERM "${pids[detector]}"
  for driver in "$work/build-examples/camera_driver" "$work/examples/camera_driver.py"; do
    drive alone "$driver" "$work/few" --rate 10
    (($(poses_of near_py "$session" | grep -c "camera at .*, 0 people$") == 4)) || fail "$driver: $(poses_of near_py "$session")"
  done
  for process in frontend human-tracker optimizer; do
    local code=0
    kill -TERM "${pids[$process]}"
    wait "${pids[$process]}" || code=$?
    ((code == 0)) || fail "$process: exit code $code: $(cat "$work/$process.err")"
    ! grep -q "deadline\|nothing on" "$work/$process.err" || fail "$process has waited in vain: $(cat "$work/$process.err")"
  done
}
# Raw pixels of this size would not get through receivers' default buffers.
the_detectors_mask_is_a_small_png() {
  python3 - "$work/examples" << 'PYTHON' || fail "person_detector.py: what becomes of a mask"
import struct
import sys
import zlib

sys.path.insert(0, sys.argv[1])
import person_detector
from airdos import channels, image_t

WIDTH, HEIGHT = 640, 360
mask = bytes((x // 9 + y // 7) % 3 for y in range(HEIGHT) for x in range(WIDTH))
person_detector.detect = lambda image: ([[(1.0, 2.0, 0.5)] * 18], mask)
image = image_t(utime=1, seq=2, session=3, width=WIDTH, height=HEIGHT)
message = dict(person_detector.messages(channels.CAMERA_LEFT, image))[channels.PERSON_MASK]
assert message.encoding == message.ENCODING_PNG, message.encoding
assert len(message.encode()) < 128000, len(message.encode())
png, at, chunks = bytes(message.data), 8, {}
assert png[:8] == b"\x89PNG\r\n\x1a\n"
while at < len(png):
    (size,) = struct.unpack_from(">I", png, at)
    body = png[at + 4 : at + 8 + size]
    assert struct.unpack_from(">I", png, at + 8 + size) == (zlib.crc32(body),)
    chunks[body[:4]] = body[4:]
    at += size + 12
assert chunks[b"IHDR"] == struct.pack(">IIBBBBB", WIDTH, HEIGHT, 8, 0, 0, 0, 0)  # 8 bit grey
rows = zlib.decompress(chunks[b"IDAT"])
assert b"".join(rows[y * (WIDTH + 1) + 1 : (y + 1) * (WIDTH + 1)] for y in range(HEIGHT)) == mask
PYTHON
}

if [[ -n ${CLIENTS_TEST_WORK:-} ]]; then
  export PYTHONPATH=$prefix/lib/python3/dist-packages
  in_a_network
  exit
fi
cmake --install "$build" --prefix "$prefix" > "$work/install.log" 2>&1 || fail "$(tail -n 5 "$work/install.log")"
nothing_of_ours_leaks
the_contract_names_tests_that_exist
components_are_apart
documented_commands_build_everything
export PYTHONPATH=$prefix/lib/python3/dist-packages
the_detectors_mask_is_a_small_png
write_pictures
new_network=(unshare -n)
"${new_network[@]}" true 2> /dev/null || new_network=(unshare -r -n)
if ! "${new_network[@]}" true 2> /dev/null; then
  echo "SKIPPED: the examples are built, but there is no right to make a network namespace to run them in"
  exit 77
fi
# shellcheck source=launch_scripts/common.sh
(source "$source_dir/launch_scripts/common.sh" && CLIENTS_TEST_WORK=$work run_in_new_network "$0" "$@")
examples_say_what_is_wrong
echo "all checks passed"
