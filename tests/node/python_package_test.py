#!/usr/bin/env python3
"""The Python package: holds its codec against the C++ one, and throws hostile bytes at all that reads.

Usage: python_package_test.py MESSAGE_JUDGE SOURCE_DIR     (PYTHONPATH: where the package is)
"""
import os
import pathlib
import random
import struct
import subprocess
import sys
import tempfile
import tracemalloc
import unittest

import airdos
from airdos import bus, channels, log

JUDGE = sys.argv.pop(1)
SOURCE = pathlib.Path(sys.argv.pop(1))
TYPES = [value for value in vars(airdos).values() if isinstance(value, type) and issubclass(value, airdos.image_t.__base__)]
NESTED = {"channel_status_t", "frame_pose_t", "human_observation_t", "human_state_t"}  # travel inside others only
TOP = [kind for kind in TYPES if kind.__name__ not in NESTED]


class Judge:
    """The C++ codec."""

    def __init__(self):
        self._process = subprocess.Popen([JUDGE], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def ask(self, kind, data=b""):
        self._process.stdin.write(f"{kind.__name__} {data.hex()}\n")
        self._process.stdin.flush()
        answer = self._process.stdout.readline().strip()
        return answer if answer in ("no", "cannot") else bytes.fromhex(answer)

    def close(self):
        self._process.stdin.close()
        self._process.stdout.close()
        self._process.wait()


def mutated(data, generator):
    """Other bytes behind the fingerprint, hostile counts among them, and now and then a cut."""
    data = bytearray(data)
    for _ in range(generator.randint(1, 3)):
        place = generator.randrange(8, len(data))
        if generator.random() < 0.3:
            count = generator.choice([0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0, 1, 3])
            data[place : place + 4] = struct.pack(">I", count)
        else:
            data[place] = generator.randrange(256)
    if generator.random() < 0.15:
        del data[generator.randrange(8, len(data)) :]
    return bytes(data)


class CodecTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.judge = Judge()
        cls.samples = {kind: cls.judge.ask(kind) for kind in TOP}

    @classmethod
    def tearDownClass(cls):
        cls.judge.close()

    def test_all_types_are_there(self):
        files = sorted(path.stem for path in (SOURCE / "lcmtypes").glob("*.lcm"))
        self.assertEqual(sorted(kind.__name__ for kind in TYPES), files)
        self.assertEqual(len(TOP), 11)

    def test_reads_and_writes_the_bytes_of_cpp(self):
        for kind, sample in self.samples.items():
            self.assertEqual(kind.decode(sample).encode(), sample, kind)

    def test_a_message_of_which_nothing_was_set_is_one(self):
        for kind in TOP:
            data = kind().encode()
            self.assertEqual(self.judge.ask(kind, data), data, kind)
            self.assertEqual(kind.decode(data), kind())

    def test_takes_and_refuses_what_cpp_does(self):
        generator = random.Random(1)
        num_taken = 0
        for kind, sample in self.samples.items():
            for _ in range(400):
                data = mutated(sample, generator)
                answer = self.judge.ask(kind, data)
                if answer == "no":
                    self.assertRaises(ValueError, kind.decode, data)
                    continue
                message = kind.decode(data)
                num_taken += 1
                # Not the bytes: Python knows one NaN, one "true", and texts of UTF-8 only.
                if answer != "cannot":
                    self.assertEqual(repr(kind.decode(answer)), repr(message))
        self.assertGreater(num_taken, 1000)

    def test_refuses_the_counts_of_nothing_that_cpp_refuses(self):
        num_refused = 0
        for kind in TOP:  # without a single element a negative count has nothing to run into
            data = kind().encode()
            for place in range(8, len(data) - 3):
                hostile = data[:place] + b"\xff\xff\xff\xff" + data[place + 4 :]
                if self.judge.ask(kind, hostile) == "no":
                    num_refused += 1
                    self.assertRaises(ValueError, kind.decode, hostile)
                else:
                    kind.decode(hostile)
        self.assertGreater(num_refused, 20)
        text_of_nothing = airdos.frame_done_t().encode()[:-5] + bytes(4)
        self.assertEqual(self.judge.ask(airdos.frame_done_t, text_of_nothing), "no")
        self.assertRaises(ValueError, airdos.frame_done_t.decode, text_of_nothing)

    def test_refuses_truncated_and_trailing_bytes(self):
        for kind, sample in self.samples.items():
            for size in range(len(sample)):
                self.assertRaises(ValueError, kind.decode, sample[:size])
            self.assertRaises(ValueError, kind.decode, sample + b"\0")

    def test_hostile_counts_cost_nothing(self):
        rows_of_nothing = airdos.person_keypoints_t(num_people=0, num_joints=0).encode()[:-8] + struct.pack(">ii", 0x7FFFFFFF, 0)
        tracemalloc.start()
        self.assertRaises(ValueError, airdos.person_keypoints_t.decode, rows_of_nothing)
        for kind, sample in self.samples.items():
            for place in range(8, len(sample) - 3):
                for count in (0x7FFFFFFF, 0x80000000, 0x00FFFFFF):
                    hostile = sample[:place] + struct.pack(">I", count) + sample[place + 4 :]
                    try:
                        kind.decode(hostile)
                    except ValueError:
                        pass
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        self.assertLess(peak, 1 << 20)

    def test_too_large_messages_are_not_decoded(self):
        limit = airdos.pose_t.MAX_BYTES
        self.assertRaisesRegex(ValueError, "too many", airdos.pose_t.decode, bytes(limit + 1))
        self.assertEqual(airdos.image_t.MAX_BYTES, 40 << 20)
        self.assertEqual(airdos.person_mask_t.MAX_BYTES, 40 << 20)

    def test_encoding_refuses_what_does_not_fit_together(self):
        def refuses(text, message):
            self.assertRaisesRegex(ValueError, text, message.encode)

        refuses("image_t.data: 3 elements where the count says 0", airdos.image_t(data=b"abc"))
        refuses("image_t.data: 0 elements where the count says 5", airdos.image_t(num_bytes=5))
        refuses("image_t.width", airdos.image_t(width="640"))
        refuses("image_t.utime", airdos.image_t(utime=1 << 63))
        rows = [[1.0] * 17]
        keypoints = airdos.person_keypoints_t(num_people=1, num_joints=18, u_px=rows, v_px=rows, confidence=rows)
        refuses("person_keypoints_t.u_px: 17 elements where the count says 18", keypoints)
        person = airdos.human_observation_t(num_joints=1)
        refuses("^human_observation_t.joint_id", airdos.human_observations_t(num_humans=1, humans=[person]))
        refuses("human_observations_t.humans", airdos.human_observations_t(num_humans=1, humans=["somebody"]))

    def test_misspelt_fields_are_errors(self):
        self.assertRaises(TypeError, airdos.image_t, witdh=640)
        self.assertRaises(AttributeError, setattr, airdos.image_t(), "witdh", 640)

    def test_comments_of_the_types_are_help(self):
        self.assertIn("utime: int64_t: us, capture time", airdos.image_t.__doc__)
        self.assertIn("than that of an earlier frame", (pathlib.Path(airdos.__file__).parent / "static_features_t.py").read_text())

    def test_channels_are_those_of_cpp(self):
        text = (SOURCE / "processes/node/message/channels.h").read_text()
        names = [name for name in vars(channels) if name.isupper()]
        self.assertEqual(len(names), text.count("inline constexpr char"))
        for name in names:
            self.assertIn(f'"{getattr(channels, name)}"', text)


class GeneratorTest(unittest.TestCase):
    def refuses(self, text, lines, header="uint64_t hash = 0x1LL"):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "x_t.lcm"
            path.write_text("\n".join(lines))
            (pathlib.Path(folder) / "x_t.hpp").write_text(header)
            command = [sys.executable, SOURCE / "lcmtypes/generate_python.py", "--headers", folder, "--output", folder]
            command += ["--channels", SOURCE / "processes/node/message/channels.h", path]
            done = subprocess.run(command, capture_output=True, text=True)
            self.assertEqual(done.returncode, 1)
            self.assertIn(text, done.stderr)

    def test_says_what_it_does_not_know(self):
        unknown = "x_t.lcm:3: generate_python.py does not know this: int8_t a, b;"
        self.refuses(unknown, ["package airdos;", "struct x_t {", "int8_t a, b;", "}"])
        self.refuses("no type other_t", ["package airdos;", "struct x_t {", "  other_t other;", "}"])
        self.refuses("x_t.lcm:2:", ["package airdos;", "struct y_t {", "  int8_t a;", "}"])
        self.refuses("no struct", ["package airdos;"])
        self.refuses("x_t.hpp: 0 fingerprints, not one", ["struct x_t {", "  int8_t a;", "}"], header="")


class AssemblerTest(unittest.TestCase):
    def test_messages_of_all_sizes_arrive(self):
        assembler = bus.Assembler()
        for number, size in enumerate([0, 1, 65497, 65498, 65499, 130971, 130972, 130973, 400000]):
            payload = random.Random(size).randbytes(size)
            parts = bus.datagrams("C", payload, number)
            self.assertTrue(all(len(part) <= 65507 for part in parts))
            taken = [assembler.take(part, "sender") for part in reversed(parts)]
            self.assertEqual(taken, [None] * (len(parts) - 1) + [("C", payload)])
        self.assertEqual((assembler.num_malformed, assembler.num_incomplete), (0, 0))

    def test_fragments_of_two_senders_are_kept_apart(self):
        assembler = bus.Assembler()
        first, second = bus.datagrams("A", b"a" * 100000, 7), bus.datagrams("B", b"b" * 100000, 7)
        self.assertIsNone(assembler.take(first[0], 1))
        self.assertIsNone(assembler.take(second[0], 2))
        self.assertEqual(assembler.take(second[1], 2), ("B", b"b" * 100000))
        self.assertEqual(assembler.take(first[1], 1), ("A", b"a" * 100000))

    def test_a_lost_fragment_costs_its_message_only(self):
        assembler = bus.Assembler()
        self.assertIsNone(assembler.take(bus.datagrams("A", bytes(100000), 1)[0], 1))
        parts = bus.datagrams("A", bytes(100000), 2)
        self.assertIsNone(assembler.take(parts[0], 1))
        self.assertIsNone(assembler.take(parts[0], 1), "a fragment that comes twice")
        self.assertEqual(assembler.take(parts[1], 1), ("A", bytes(100000)))
        self.assertEqual(assembler.num_incomplete, 1)

    def test_what_contradicts_itself_is_counted(self):
        def fragment(number, size, offset, index, count, part):
            return struct.pack(">4sIIIHH", b"LC03", number, size, offset, index, count) + part

        bad = [
            [b""],
            [b"LC02"],
            [b"LC01\0\0\0\0C\0x"],
            [b"LC02\0\0\0\0" + b"C" * 64 + b"\0x"],  # a channel without an end
            [b"LC02\0\0\0\0\0x"],  # without a name
            [b"LC02\0\0\0\0\xff\0x"],
            [fragment(1, 5, 0, 0, 0, b"C\0")],
            [fragment(1, 5, 0, 3, 3, b"C\0")],
            [fragment(1, 0xFFFFFFFF, 0, 0, 2, b"C\0")],
            [fragment(1, 2, 0, 0, 2, b"C\0a"), fragment(1, 2, 2, 1, 2, b"b")],  # a gap
            [fragment(1, 4, 0, 0, 2, b"C\0a"), fragment(1, 4, 1, 1, 2, b"b")],  # less than announced
            [fragment(1, 2, 0, 0, 2, b"C\0a"), fragment(1, 2, 1, 1, 2, b"b" * 100)],  # more
            [fragment(1, 1, 1, 0, 1, b"C\0a")],
        ]
        for datagrams in bad:
            assembler = bus.Assembler()
            for datagram in datagrams:
                self.assertIsNone(assembler.take(datagram, 1), datagram)
            self.assertEqual(assembler.num_malformed, 1, datagrams)

    def test_any_bytes_at_all(self):
        generator = random.Random(3)
        seeds = bus.datagrams("A", bytes(1000), 1) + [part[:300] for part in bus.datagrams("A", bytes(200000), 2)]
        assembler = bus.Assembler()
        for _ in range(20000):
            datagram = bytearray(generator.choice(seeds))
            for _ in range(generator.randint(1, 4)):
                datagram[generator.randrange(min(len(datagram), 30))] = generator.randrange(256)
            assembler.take(bytes(datagram[: generator.randrange(len(datagram))]), generator.randrange(100))

    def flood(self, num, part, num_senders):
        """The most memory that so many fragments take, none of which completes a message."""
        assembler = bus.Assembler()
        tracemalloc.start()
        for index in range(num):
            head = struct.pack(">4sIIIHH", b"LC03", 1, 30 << 20, 0, index // num_senders, 60001)
            assembler.take(head + part, index % num_senders)
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        self.assertGreater(assembler.num_incomplete, 0)
        return peak

    def test_a_flood_of_fragments_is_bounded(self):
        self.addCleanup(setattr, bus, "MAX_WAITING_BYTES", bus.MAX_WAITING_BYTES)
        bus.MAX_WAITING_BYTES = 1 << 20
        self.assertLess(self.flood(2000, bytes(3000), num_senders=10), 2 << 20)
        self.assertLess(self.flood(20000, b"", num_senders=1), 2 << 20)
        bus.MAX_WAITING_BYTES = 1 << 40
        self.assertLess(self.flood(20000, b"", num_senders=20000), 1 << 20)


class BusTest(unittest.TestCase):
    def test_wrong_urls_and_channels(self):
        for url in ("tcpq://localhost", "udpm://10.0.0.1:7667", "udpm://239.255.76.67:99999", "udpm://239.255.76.67?tll=1", "udpm://x",
                    "udpm://239.255.76.67?ttl=far", "udpm://239.255.76.67?ttl=256", "nonsense"):
            self.assertRaisesRegex(ValueError, "expected something like udpm", bus.Bus, url)
        for name in ("", "x" * 64, "\0", "\u00e4"):
            self.assertRaises(ValueError, bus.datagrams, name, b"", 0)
        self.assertRaises(ValueError, bus.datagrams, "C", bytes(bus.MAX_MESSAGE_BYTES + 1), 0)


class LogTest(unittest.TestCase):
    def setUp(self):
        file, self.path = tempfile.mkstemp()
        os.close(file)
        self.addCleanup(os.remove, self.path)

    def test_reads_what_it_wrote(self):
        with log.LogWriter(self.path) as writer:
            writer.write(5, "A", b"payload")
            writer.write(6, "STATUS", airdos.process_status_t(process="me"))
            self.assertRaises(ValueError, writer.write, 7, "x" * 64, b"")
        reader = log.LogReader(self.path)
        events = list(reader)
        self.assertEqual(events[0], (5, "A", b"payload"))
        self.assertEqual(airdos.process_status_t.decode(events[1].data).process, "me")
        self.assertEqual((len(events), reader.num_damaged_bytes), (2, 0))

    def test_the_sample_log(self):
        sample = SOURCE / "logs/road_crossing06.lcm"
        events = list(log.LogReader(sample))
        self.assertEqual(sum(event.channel == channels.CAMERA_LEFT for event in events), 50)
        with log.LogWriter(self.path) as writer:
            for event in events:
                writer.write(*event)
        self.assertEqual(pathlib.Path(self.path).read_bytes(), sample.read_bytes())

    def test_passes_over_damage(self):
        with log.LogWriter(self.path) as writer:
            for number in range(5):
                writer.write(number, "A", bytes([number]) * 100)
        whole = pathlib.Path(self.path).read_bytes()
        size = len(whole) // 5
        for place, hostile in ((20, b"\x7f\xff\xff\xff"), (24, b"\x7f\xff\xff\xff"), (24, b"\xff\xff\xff\xff"), (0, b"lost")):
            pathlib.Path(self.path).write_bytes(whole[: size + place] + hostile + whole[size + place + 4 :])
            reader = log.LogReader(self.path)
            self.assertEqual([event.utime for event in reader], [0, 2, 3, 4], place)
            self.assertEqual(reader.num_damaged_bytes, size)
        for between in (b"x", b"\xed\xa1\xda", b"x" * 100):
            pathlib.Path(self.path).write_bytes(whole[:size] + between + whole[size:])
            self.assertEqual(len(list(log.LogReader(self.path))), 5)
        pathlib.Path(self.path).write_bytes(whole[:-1])
        self.assertEqual(len(list(log.LogReader(self.path))), 4)
        pathlib.Path(self.path).write_bytes(b"")
        self.assertEqual(list(log.LogReader(self.path)), [])


if __name__ == "__main__":
    unittest.main()
