"""LCM logs: what lcm-logger and airdos-record write, and lcm-logplayer and airdos-replay read.

An event: 0xEDA1DA01, number of the event (8 bytes), utime (8), length of the channel (4), of the payload (4), channel, payload.
All numbers are big-endian.
"""
import collections
import mmap
import os
import struct

_HEAD = struct.Struct(">4sqqii")
_SYNC = b"\xed\xa1\xda\x01"
_MAX_CHANNEL = 63
_MAX_PAYLOAD = 40 << 20

Event = collections.namedtuple("Event", "utime channel data")


class LogReader:
    """The events of a log, in its order. What is damaged is passed over, up to the next event that is whole, and counted."""

    def __init__(self, path):
        self.num_damaged_bytes = 0
        with open(path, "rb") as file:
            is_empty = os.fstat(file.fileno()).st_size == 0  # which cannot be mapped
            self._data = b"" if is_empty else mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)

    def __iter__(self):
        place = self.num_damaged_bytes = 0
        while place < len(self._data):
            event, end = self._event_at(place)
            if event is None:
                end = self._data.find(_SYNC, place + 1)
                end = len(self._data) if end < 0 else end
                self.num_damaged_bytes += end - place
            else:
                yield event
            place = end

    def _event_at(self, place):
        if place + _HEAD.size > len(self._data):
            return None, 0
        sync, _, utime, channel_size, size = _HEAD.unpack_from(self._data, place)
        start = place + _HEAD.size
        if sync != _SYNC or not 0 < channel_size <= _MAX_CHANNEL or not 0 <= size <= _MAX_PAYLOAD:
            return None, 0
        end = start + channel_size + size
        channel = self._data[start : start + channel_size]
        if end > len(self._data) or not channel.isascii():
            return None, 0
        return Event(utime, channel.decode("ascii"), self._data[start + channel_size : end]), end


class LogWriter:
    """Writes a log. `utime` is the caller's: the capture time, say, so that the same run gives the same file."""

    def __init__(self, path):
        self._file = open(path, "wb")
        self._number = 0

    def write(self, utime, channel, message):
        """A message of ours, or bytes."""
        payload = message if isinstance(message, (bytes, bytearray)) else message.encode()
        name = channel.encode("ascii")
        if not 0 < len(name) <= _MAX_CHANNEL or len(payload) > _MAX_PAYLOAD:
            raise ValueError(f"{channel}: no name of a channel, or {len(payload)} bytes are too many")
        self._file.write(_HEAD.pack(_SYNC, self._number, utime, len(name), len(payload)) + name + payload)
        self._number += 1

    def close(self):
        self._file.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
