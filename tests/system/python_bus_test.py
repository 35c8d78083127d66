#!/usr/bin/env python3
"""The Python bus and LCM's own library, both ways, with messages of one and of several datagrams. In a network of its own.

Usage: python_bus_test.py FOLDER_OF_PROGRAMS     (PYTHONPATH: where the package is)
"""
import pathlib
import random
import subprocess
import sys
import tempfile
import time

from airdos import Bus, LogReader, LogWriter

SIZES = [0, 1, 1000, 65490, 65491, 65492, 65493, 65494, 130960, 130973, 131000, 400000]  # around the limits of datagrams
CHANNEL = "SOMETHING"
DEADLINE_S = 60


def payload(size):
    return random.Random(size).randbytes(size)


def expect(is_right, text):
    if not is_right:
        sys.exit(f"FAILED: {text}")


def hear(bus):
    """What comes until all sizes have."""
    heard = []
    deadline = time.monotonic() + DEADLINE_S
    while len(heard) < len(SIZES) and time.monotonic() < deadline:
        message = bus.receive(timeout_s=1)
        if message is not None:
            expect(message[0] == CHANNEL, f"heard {message[0]}, which was not asked for")
            heard.append(message[1])
    return heard


def hears_what_lcm_says(folder):
    path = folder / "to_play.lcm"
    with LogWriter(path) as log:
        for number, size in enumerate(SIZES):
            log.write(20000 * number, "ANOTHER", b"not for us")
            log.write(20000 * number, CHANNEL, payload(size))
    with Bus(channels=[CHANNEL]) as bus:
        subprocess.run(["lcm-logplayer", path], check=True, stdout=subprocess.DEVNULL, timeout=DEADLINE_S)
        expect(hear(bus) == [payload(size) for size in SIZES], "other bytes arrive than LCM's library sent")
        expect((bus.num_malformed, bus.num_incomplete) == (0, 0), "some of LCM's datagrams were refused")


def is_heard_by_lcm(folder, programs):
    path = folder / "recorded.lcm"
    command = [programs / "airdos-record", "--out", path]
    recorder = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    while "READY" not in (line := recorder.stdout.readline()):
        expect(line, "airdos-record does not start")
    with Bus(channels=[CHANNEL]) as bus:
        for size in SIZES:
            bus.publish(CHANNEL, payload(size))
            expect(bus.receive(timeout_s=DEADLINE_S) == (CHANNEL, payload(size)), f"{size} bytes do not come back")
    recorder.terminate()
    recorder.communicate(timeout=DEADLINE_S)
    recorded = [event.data for event in LogReader(path) if event.channel == CHANNEL]
    sizes = [len(data) for data in recorded]
    expect(recorded == [payload(size) for size in SIZES], f"LCM's library hears other bytes than were sent: of sizes {sizes}")


def says_where_there_is_nothing():
    with Bus(channels=["NOBODY"]) as bus:
        expect(bus.receive(timeout_s=0.01) is None and bus.receive(timeout_s=0) is None, "something came from nobody")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        hears_what_lcm_says(pathlib.Path(name))
        is_heard_by_lcm(pathlib.Path(name), pathlib.Path(sys.argv[1]))
        says_where_there_is_nothing()
