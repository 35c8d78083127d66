#!/usr/bin/env python3
"""A camera driver: publishes a folder of rectified pictures as a live stereo camera would. Take it as a start for a real one.

The rules that it keeps are in docs/clients.md, "A camera driver in ten lines". The LCM URL is LCM_DEFAULT_URL, or LCM's default.
"""
import argparse
import pathlib
import sys
import time

from airdos import Bus, channels, image_t, person_keypoints_t, person_mask_t, stereo_calibration_t

MAX_BYTES = 128000  # above it, receivers on a stock kernel lose messages
STARTS_OF_FRAME = set(range(0xC0, 0xD0)) - {0xC4, 0xC8, 0xCC}


def size_of(path, data):
    """Width and height in px, from the header of a PNG or JPEG file."""

    def number(place):
        return int.from_bytes(data[place : place + 2], "big")

    if data[:4] == b"\x89PNG":
        return number(18), number(22)
    place = 2  # JPEG: segments 0xFF, kind, length; the size is in a start of frame
    while place + 9 < len(data) and data[place] == 0xFF:
        if data[place + 1] in STARTS_OF_FRAME:
            return number(place + 7), number(place + 5)
        place += 2 + number(place + 2)
    raise ValueError(f"{path}: neither PNG nor JPEG")


def read_calibration(path):
    rows = {}
    for row in path.read_text().splitlines():
        name, *numbers = row.split() or [""]
        if name in ("P0:", "P1:"):
            rows[name] = [float(number) for number in numbers]
    if sorted(rows) != ["P0:", "P1:"] or any(len(row) != 12 for row in rows.values()):
        raise ValueError(f"{path}: no lines P0: and P1: of 12 numbers")
    left, right = rows["P0:"], rows["P1:"]
    return {"fx_px": left[0], "cx_px": left[2], "fy_px": left[5], "cy_px": left[6], "baseline_m": -right[3] / right[0]}


def read_image(path, header):
    data = path.read_bytes()
    width, height = size_of(path, data)
    if len(data) > MAX_BYTES:
        print(f"{path}: {len(data)} bytes; messages above 128 kB may be lost: JPEG is smaller", file=sys.stderr)
    encoding = image_t.ENCODING_PNG if data[:4] == b"\x89PNG" else image_t.ENCODING_JPEG
    return image_t(**header, width=width, height=height, encoding=encoding, num_bytes=len(data), data=data)


def publish_nobody(bus, header, left):
    """So that nobody waits for a detector: an empty message for each picture."""
    nobody = person_keypoints_t(**header, layout=person_keypoints_t.LAYOUT_COCO18)
    bus.publish(channels.PERSON_KEYPOINTS_LEFT, nobody)
    bus.publish(channels.PERSON_KEYPOINTS_RIGHT, nobody)
    mask = person_mask_t(**header, encoding=person_mask_t.ENCODING_NONE, width=left.width, height=left.height)
    bus.publish(channels.PERSON_MASK, mask)


def drive(bus, folder, rate_hz, has_detector):
    calibration = read_calibration(folder / "calib.txt")
    rights = {path.name: path for path in (folder / "image_1").iterdir()}
    pairs = [(path, rights[path.name]) for path in sorted((folder / "image_0").iterdir()) if path.name in rights]
    if not pairs:
        raise ValueError(f"{folder}: no pictures of the same name in image_0 and image_1")
    # Another number than any before: after a restart the pictures are counted from 0 again, which is a new session.
    session = time.time_ns() // 1000
    start, next_calibration = time.monotonic(), 0
    for seq, (left_path, right_path) in enumerate(pairs):
        time.sleep(max(0.0, start + seq / rate_hz - time.monotonic()))
        # utime is when it was taken, here since the start; seq counts, one more with each pair.
        header = {"utime": int(1e6 * seq / rate_hz), "seq": seq, "session": session}
        left = read_image(left_path, header)
        if header["utime"] >= next_calibration:  # before the first picture, and then once a second, for whoever comes later
            next_calibration = header["utime"] + 1000000
            size = {"width": left.width, "height": left.height}
            bus.publish(channels.CALIBRATION, stereo_calibration_t(**header, **size, **calibration))
        bus.publish(channels.CAMERA_LEFT, left)
        bus.publish(channels.CAMERA_RIGHT, read_image(right_path, header))
        if not has_detector:
            publish_nobody(bus, header, left)
    print(f"published {len(pairs)} pairs as session {session}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "folder",
        type=pathlib.Path,
        help="image_0/ and image_1/, left and right pictures (8-bit PNG or JPEG) of the same names, in order of their names; calib.txt,"
        " as KITTI has it: lines P0: and P1: of 12 numbers, P0 with fx, cx, fy, cy, P1 with -fx * baseline in m",
    )
    parser.add_argument("--rate", type=float, default=10, help="pictures a second (default 10)")
    parser.add_argument("--detector", action="store_true", help="a detector of people is running and publishes what it sees")
    arguments = parser.parse_args()
    if not arguments.rate > 0:
        parser.error("--rate must be above 0")
    try:
        with Bus(channels=[]) as bus:
            drive(bus, arguments.folder, arguments.rate, arguments.detector)
    except (OSError, ValueError) as error:
        print(f"camera_driver.py: {error}", file=sys.stderr)
        sys.exit(2)


if __name__ == "__main__":
    main()
