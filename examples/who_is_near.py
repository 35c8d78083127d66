#!/usr/bin/env python3
"""Prints who is near the camera: a line for each image, from what the optimizer publishes.

Usage: who_is_near.py [METRES]     (default 5; the LCM URL is LCM_DEFAULT_URL, or LCM's default)
"""
import math
import sys

from airdos import Bus, channels, map_update_t, state_estimate_t

MAX_FRAMES = 100  # of which something is still missing: it may be lost


class Frame:
    """What is known of one image. Pose and people come on two channels, in any order, and many people come in several parts."""

    def __init__(self):
        self.pose = None
        self.people = []
        self.num_parts_heard = 0
        self.num_parts = 1


def distance_m(person, camera):
    """From the camera to the middle of the person's joints, both in the world W."""
    middle = [sum(axis) / person.num_joints for axis in (person.x_W_m, person.y_W_m, person.z_W_m)]
    return math.sqrt(sum((m - c) ** 2 for m, c in zip(middle, camera)))


def line(session, seq, frame, near_m):
    start = f"session {session} image {seq}: "
    if frame.pose.status == state_estimate_t.STATUS_INVALID:
        return start + "no pose"
    camera = frame.pose.position_W_C
    near = sorted((distance_m(person, camera), person.track_id) for person in frame.people)
    people = "".join(f", person {number} at {distance:.2f} m" for distance, number in near if distance <= near_m)
    return start + "camera at {:.3f} {:.3f} {:.3f}".format(*camera) + f", {len(frame.people)} people" + people


def main():
    near_m = float(sys.argv[1]) if len(sys.argv) > 1 else 5.0
    frames = {}
    with Bus(channels=[channels.STATE_ESTIMATE, channels.MAP_UPDATE]) as bus:
        print("listening", flush=True)
        while True:
            channel, data = bus.receive()
            try:
                message = (state_estimate_t if channel == channels.STATE_ESTIMATE else map_update_t).decode(data)
            except ValueError as error:  # whoever may send may send anything
                print(error, file=sys.stderr)
                continue
            key = (message.session, message.seq)  # a new session is a new world, and its images are counted anew
            frame = frames.setdefault(key, Frame())
            if channel == channels.STATE_ESTIMATE:
                frame.pose = message
            else:
                frame.num_parts = message.num_parts
                frame.num_parts_heard += 1
                # People of the frame that leaves the window are told once more, refined; only the newest matter here.
                frame.people += [p for p in message.humans if p.seq == message.seq and p.num_joints > 0]
            if frame.pose is not None and frame.num_parts_heard >= frame.num_parts:
                print(line(*key, frames.pop(key), near_m), flush=True)
            elif len(frames) > MAX_FRAMES:
                del frames[min(frames)]


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        pass
    except (OSError, ValueError) as error:
        print(f"who_is_near.py: {error}", file=sys.stderr)
        sys.exit(2)
