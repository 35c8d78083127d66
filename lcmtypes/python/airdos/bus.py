"""LCM over UDP multicast, for whoever has no LCM library (Debian has none for Python).

A message is one datagram where it fits, and else several. All numbers are big-endian.

    short:     "LC02", number of the message (4 bytes), channel, zero byte, payload
    fragment:  "LC03", number of the message (4), size of the payload (4), offset of this part of it (4),
               number of the fragment (2), how many there are (2); in the first one channel and zero byte; part of the payload

Whoever may send to the address is heard, so all that comes is bounded: see the constants.
"""
import collections
import ipaddress
import os
import select
import socket
import struct
import time
import urllib.parse

DEFAULT_URL = "udpm://239.255.76.67:7667?ttl=0"

MAX_CHANNEL = 63  # letters, as LCM has it
MAX_MESSAGE_BYTES = 40 << 20  # larger ones are neither sent nor taken
MAX_SENDERS = 64  # whose messages are put together at a time; each sends one after the other
MAX_WAITING_BYTES = 64 << 20  # of all fragments that wait for others
_COST_OF_A_FRAGMENT = 200  # bytes beside its payload

_MAX_SHORT = 65499  # channel, zero byte and payload
_MAX_FRAGMENT = 65487
_SHORT = struct.Struct(">4sI")
_LONG = struct.Struct(">4sIIIHH")


class Bus:
    """One place on the bus: publishes, and hears what is published on some channels, or on all.

    `url` is as LCM's: the default, or what LCM_DEFAULT_URL says. Raises ValueError for one that is wrong, OSError where the
    network cannot do multicast (network_setup.sh, of the launch scripts, says what to do).
    """

    def __init__(self, url=None, channels=None):
        url = url or os.environ.get("LCM_DEFAULT_URL") or DEFAULT_URL
        group, port, options = _parse(url)
        self._address = (group, port)
        self._channels = None if channels is None else {_checked_channel(name) for name in channels}
        self._number = 0
        self._assembler = Assembler()
        self._sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, options["ttl"])
        try:
            self._sender.connect(self._address)
        except OSError as error:
            raise OSError(error.errno, f"{url}: {error.strerror}: no multicast route? network_setup.sh checks and sets it") from None
        self._receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._receiver.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        # The kernel gives as much as net.core.rmem_max allows; its default of 212,992 bytes loses bursts.
        self._receiver.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, options["recv_buf_size"])
        self._receiver.bind(self._address)  # not "": other groups of the port are not ours
        member = socket.inet_aton(group) + socket.inet_aton("0.0.0.0")
        self._receiver.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, member)
        self._receiver.setblocking(False)

    def publish(self, channel, message):
        """Sends a message of ours, or bytes."""
        payload = message if isinstance(message, (bytes, bytearray)) else message.encode()
        for datagram in datagrams(channel, payload, self._number):
            self._sender.send(datagram)
        self._number = (self._number + 1) & 0xFFFFFFFF

    def receive(self, timeout_s=None):
        """The next (channel, bytes) of our channels, or None where nothing has come after timeout_s (None: waits for ever)."""
        deadline = None if timeout_s is None else time.monotonic() + timeout_s
        while True:
            try:
                datagram, sender = self._receiver.recvfrom(65536)
            except BlockingIOError:
                left = None if deadline is None else deadline - time.monotonic()
                if left is not None and left <= 0:
                    return None
                select.select([self._receiver], [], [], left)
                continue
            message = self._assembler.take(datagram, sender)
            if message is not None and (self._channels is None or message[0] in self._channels):
                return message
            if deadline is not None and time.monotonic() > deadline:
                return None

    @property
    def num_malformed(self):
        """Datagrams that were none of LCM's, or contradicted themselves."""
        return self._assembler.num_malformed

    @property
    def num_incomplete(self):
        """Messages of several datagrams of which not all came."""
        return self._assembler.num_incomplete

    def fileno(self):
        """For select() and the like: readable when receive(0) may have something."""
        return self._receiver.fileno()

    def close(self):
        self._sender.close()
        self._receiver.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


class Assembler:
    """Makes messages of datagrams, whatever these hold."""

    def __init__(self):
        self.num_malformed = 0
        self.num_incomplete = 0
        self._waiting = collections.OrderedDict()  # by sender, the oldest first
        self._num_bytes = 0

    def take(self, datagram, sender):
        """The (channel, payload) that this datagram completes, or None."""
        message = None
        try:
            if datagram[:4] == b"LC02" and len(datagram) >= _SHORT.size:
                message = _split(datagram[_SHORT.size :])
            elif datagram[:4] == b"LC03" and len(datagram) >= _LONG.size:
                message = self._take_fragment(datagram, sender)
            else:
                raise ValueError("not LCM's")
        except ValueError:
            self.num_malformed += 1
        return message

    def _take_fragment(self, datagram, sender):
        _, number, size, offset, index, count = _LONG.unpack_from(datagram)
        part = datagram[_LONG.size :]
        if size > MAX_MESSAGE_BYTES or index >= count:
            raise ValueError("impossible fragment")
        waiting = self._waiting.get(sender)
        if waiting is None or waiting.key != (number, size, count):
            self._drop(sender)
            waiting = self._waiting[sender] = _Waiting((number, size, count))
        if index in waiting.parts:
            return None
        waiting.parts[index] = (offset, part)
        waiting.num_bytes += len(part) + _COST_OF_A_FRAGMENT
        self._num_bytes += len(part) + _COST_OF_A_FRAGMENT
        if len(waiting.parts) == count:
            self._forget(sender)
            return _join(waiting)
        while len(self._waiting) > MAX_SENDERS or self._num_bytes > MAX_WAITING_BYTES:
            self._drop(next(iter(self._waiting)))
        return None

    def _drop(self, sender):
        if sender in self._waiting:
            self.num_incomplete += 1
            self._forget(sender)

    def _forget(self, sender):
        self._num_bytes -= self._waiting.pop(sender).num_bytes


class _Waiting:
    def __init__(self, key):
        self.key = key
        self.parts = {}
        self.num_bytes = 0  # with what it costs to keep them


def datagrams(channel, payload, number):
    """A message as LCM sends it."""
    if len(payload) > MAX_MESSAGE_BYTES:
        raise ValueError(f"{channel}: {len(payload)} bytes are too many for a message")
    head = _checked_channel(channel).encode("ascii") + b"\0"
    if len(head) + len(payload) <= _MAX_SHORT:
        return [_SHORT.pack(b"LC02", number) + head + payload]
    whole = head + payload
    parts = [whole[start : start + _MAX_FRAGMENT] for start in range(0, len(whole), _MAX_FRAGMENT)]
    return [
        _LONG.pack(b"LC03", number, len(payload), max(0, index * _MAX_FRAGMENT - len(head)), index, len(parts)) + part
        for index, part in enumerate(parts)
    ]


def _join(waiting):
    _, size, count = waiting.key
    channel, first = _split(waiting.parts[0][1])
    if waiting.parts[0][0] != 0:
        raise ValueError("no first fragment")
    payload = bytearray(first)
    for index in range(1, count):
        offset, part = waiting.parts[index]
        if offset != len(payload):
            raise ValueError("fragments that do not fit together")
        payload += part
    if len(payload) != size:
        raise ValueError("another size than announced")
    return channel, bytes(payload)


def _split(data):
    end = data.find(b"\0", 0, MAX_CHANNEL + 1)
    if end < 1:
        raise ValueError("no channel")
    return data[:end].decode("ascii"), data[end + 1 :]  # what is not ASCII is a ValueError


def _checked_channel(name):
    if not name or len(name) > MAX_CHANNEL or not name.isascii() or "\0" in name:
        raise ValueError(f"no name of a channel: {name!r}")
    return name


def _parse(url):
    parts = urllib.parse.urlsplit(url)
    options = {"ttl": 0, "recv_buf_size": 4 << 20}
    try:
        if parts.scheme != "udpm":
            raise ValueError("only udpm:// is known here")
        group = ipaddress.IPv4Address(parts.hostname or "239.255.76.67")
        if not group.is_multicast:
            raise ValueError(f"{group} is no multicast address")
        for name, value in urllib.parse.parse_qsl(parts.query, strict_parsing=bool(parts.query)):
            if name not in options:
                raise ValueError(f"unknown option {name}")
            options[name] = int(value)
        if not 0 <= options["ttl"] <= 255 or not 0 < options["recv_buf_size"] < 1 << 30:
            raise ValueError("ttl or recv_buf_size is out of range")
        return str(group), parts.port or 7667, options
    except ValueError as error:
        raise ValueError(f"LCM URL '{url}': {error}; expected something like {DEFAULT_URL}") from None
