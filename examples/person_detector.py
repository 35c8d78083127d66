#!/usr/bin/env python3
"""A detector of people, to put your own network into: hears the pictures, publishes where people are. Its rules: docs/how_to_add.md.

The LCM URL is LCM_DEFAULT_URL, or LCM's default.
"""
import argparse
import struct
import sys
import zlib

from airdos import Bus, LogReader, channels, image_t, person_keypoints_t, person_mask_t

KEYPOINTS_OF = {
    channels.CAMERA_LEFT: channels.PERSON_KEYPOINTS_LEFT,
    channels.CAMERA_RIGHT: channels.PERSON_KEYPOINTS_RIGHT,
}


def detect(image):
    """Your network: for each person 18 keypoints (u px, v px, confidence 0..1) in COCO-18 order, and a mask or b"".

    `image.data` is what `image.encoding` says: a JPEG or PNG file, or raw rows of grey or BGR pixels (image_t.ENCODING_*). The mask is
    width * height bytes, 0 where there is nobody. Left pictures only need one.
    """
    return [], b""


def as_png(width, height, gray):
    """The mask as a PNG file. As raw bytes it might be larger than the 128 kB that get through receivers' default buffers."""
    rows = b"".join(b"\0" + gray[y * width : (y + 1) * width] for y in range(height))
    chunks = {b"IHDR": struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0), b"IDAT": zlib.compress(rows), b"IEND": b""}
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data)) for name, data in chunks.items()
    )


def messages(channel, image):
    """One message a channel, also where nobody is seen, with the header of the picture."""
    header = {"utime": image.utime, "seq": image.seq, "session": image.session}
    people, mask = detect(image)
    rows = [[[keypoint[i] for keypoint in person] for person in people] for i in range(3)]
    keypoints = {"num_people": len(people), "num_joints": 18, "u_px": rows[0], "v_px": rows[1], "confidence": rows[2]}
    yield KEYPOINTS_OF[channel], person_keypoints_t(**header, layout=person_keypoints_t.LAYOUT_COCO18, **keypoints)
    if channel == channels.CAMERA_LEFT:
        encoding = person_mask_t.ENCODING_PNG if mask else person_mask_t.ENCODING_NONE
        data = as_png(image.width, image.height, mask) if mask else b""
        size = {"width": image.width, "height": image.height, "num_bytes": len(data)}
        yield channels.PERSON_MASK, person_mask_t(**header, encoding=encoding, **size, data=data)


def read_recorded(path):
    """What another detector said of each picture, as it was recorded: by channel and number of the picture."""
    types = {name: person_keypoints_t for name in KEYPOINTS_OF.values()}
    types[channels.PERSON_MASK] = person_mask_t
    recorded = {}
    for event in LogReader(path):
        if event.channel in types:
            message = types[event.channel].decode(event.data)
            recorded[event.channel, message.seq] = message
    return recorded


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--recorded", metavar="LOG", help="publish what this log has for the pictures of the same numbers")
    arguments = parser.parse_args()
    recorded = read_recorded(arguments.recorded) if arguments.recorded else {}
    with Bus(channels=KEYPOINTS_OF) as bus:
        print("listening", flush=True)
        while True:
            channel, data = bus.receive()
            try:
                image = image_t.decode(data)
            except ValueError as error:  # whoever may send may send anything
                print(error, file=sys.stderr)
                continue
            for name, message in messages(channel, image):
                message = recorded.get((name, image.seq), message)
                message.utime, message.seq, message.session = image.utime, image.seq, image.session
                bus.publish(name, message)


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        pass
    except (OSError, ValueError) as error:
        print(f"person_detector.py: {error}", file=sys.stderr)
        sys.exit(2)
