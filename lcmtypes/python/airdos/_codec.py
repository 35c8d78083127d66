"""Encodes and decodes the message types: LCM's format, written by what each type says in its FIELDS."""
import struct

_FORMATS = {"int8_t": "b", "int16_t": "h", "int32_t": "i", "int64_t": "q", "float": "f", "double": "d", "boolean": "?"}
_SIZES = {kind: struct.calcsize(">" + code) for kind, code in _FORMATS.items()}
_SIZES["byte"] = 1
_SIZES["string"] = 5  # at least: its length, and the zero at its end


class Message:
    """A message of a generated type. Fields that are not given are zero or empty.

    encode() and decode() raise ValueError, and nothing else, where lists, counts or bytes do not fit together. As with LCM in
    other languages a list has its count beside it: `image_t(num_bytes=len(data), data=data)`.
    """

    __slots__ = ()
    FIELDS = ()  # name, kind (a name of LCM's, or a class), extents (numbers, or names of counts)
    FINGERPRINT_BASE = 0
    MAX_BYTES = 0  # larger messages are not decoded

    def __init__(self, **values):
        for name, kind, extents in self.FIELDS:
            setattr(self, name, _initial(kind, extents))
        for name, value in values.items():
            if name not in self.__slots__:
                raise TypeError(f"{type(self).__name__} has no field {name}")
            setattr(self, name, value)

    def __eq__(self, other):
        return type(self) is type(other) and all(getattr(self, n) == getattr(other, n) for n in self.__slots__)

    def __repr__(self):
        return f"{type(self).__name__}({', '.join(f'{n}={getattr(self, n)!r}' for n in self.__slots__)})"

    def encode(self):
        """The bytes of this message."""
        parts = [self.fingerprint().to_bytes(8, "big")]
        self._write(parts)
        return b"".join(parts)

    @classmethod
    def decode(cls, data):
        """The message that these bytes are: exactly one, of this type."""
        if len(data) > cls.MAX_BYTES:
            raise ValueError(f"{cls.__name__}: {len(data)} bytes are too many")
        reader = _Reader(data)
        if int.from_bytes(reader.take(8), "big") != cls.fingerprint():
            raise ValueError(f"not a message of type {cls.__name__}, or of another version of it")
        message = cls._read(reader)
        if reader.left() != 0:
            raise ValueError(f"{cls.__name__}: {reader.left()} bytes too many")
        return message

    @classmethod
    def fingerprint(cls):
        """What LCM tells types apart by: 64 bits over the members' names, types and extents, at the head of each message."""
        value = cls.FINGERPRINT_BASE + sum(kind.fingerprint() for _, kind, _ in cls.FIELDS if isinstance(kind, type))
        value &= 0xFFFFFFFFFFFFFFFF
        return ((value << 1) & 0xFFFFFFFFFFFFFFFF) | value >> 63

    @classmethod
    def smallest(cls):
        """Bytes that a message takes at least, inside of another one."""
        size = 0
        for _, kind, extents in cls.FIELDS:
            count = 1
            for extent in extents:
                count *= extent if isinstance(extent, int) else 0
            size += count * _smallest(kind)
        return size

    def _extent(self, extent):
        return extent if isinstance(extent, int) else getattr(self, extent)

    def _write(self, parts):
        for name, kind, extents in self.FIELDS:
            try:
                _write_value(parts, kind, [self._extent(extent) for extent in extents], getattr(self, name))
            except _NestedError:
                raise
            except (struct.error, TypeError, ValueError, AttributeError, OverflowError) as error:
                raise _NestedError(f"{type(self).__name__}.{name}: {error}") from None

    @classmethod
    def _read(cls, reader):
        message = cls()
        for name, kind, extents in cls.FIELDS:
            setattr(message, name, _read_value(reader, kind, [message._extent(extent) for extent in extents]))
        return message


class _NestedError(ValueError):
    """Names its field already."""


class _Reader:
    """Bytes from the front to the back, never beyond it."""

    def __init__(self, data):
        self._data = bytes(data)
        self._place = 0

    def left(self):
        return len(self._data) - self._place

    def take(self, size):
        if size < 0 or size > self.left():
            raise ValueError(f"{size} bytes announced, {self.left()} left")
        self._place += size
        return self._data[self._place - size : self._place]

    def check_count(self, count, size):
        """Nothing is made room for that the bytes which are left cannot hold."""
        if count < 0 or count * size > self.left():
            raise ValueError(f"{count} elements announced, {self.left()} bytes left")


def _smallest(kind):
    return kind.smallest() if isinstance(kind, type) else _SIZES[kind]


def _initial(kind, extents):
    if extents:
        if kind == "byte":
            return b""
        return [_initial(kind, extents[1:]) for _ in range(extents[0])] if isinstance(extents[0], int) else []
    if isinstance(kind, type):
        return kind()
    return {"string": "", "float": 0.0, "double": 0.0, "boolean": False}.get(kind, 0)


def _write_value(parts, kind, extents, value):
    if extents:
        if len(value) != extents[0]:
            raise ValueError(f"{len(value)} elements where the count says {extents[0]}")
        if kind == "byte":
            parts.append(bytes(value))
        elif kind in _FORMATS and len(extents) == 1:
            parts.append(struct.pack(f">{extents[0]}{_FORMATS[kind]}", *value))
        else:
            for element in value:
                _write_value(parts, kind, extents[1:], element)
    elif isinstance(kind, type):
        if not isinstance(value, kind):
            raise TypeError(f"a {kind.__name__} is needed")
        value._write(parts)
    elif kind == "string":
        text = value.encode("utf-8")
        parts += [struct.pack(">i", len(text) + 1), text, b"\0"]
    else:
        parts.append(struct.pack(">" + _FORMATS[kind], value))


def _read_value(reader, kind, extents):
    if len(extents) == 2:
        rows, columns = extents
        reader.check_count(columns, 0)
        reader.check_count(rows, max(columns, 1) * _smallest(kind))
        return [_read_value(reader, kind, [columns]) for _ in range(rows)]
    if extents:
        count = extents[0]
        reader.check_count(count, _smallest(kind))
        if kind == "byte":
            return reader.take(count)
        if kind in _FORMATS:
            return list(struct.unpack(f">{count}{_FORMATS[kind]}", reader.take(count * _SIZES[kind])))
        return [_read_value(reader, kind, []) for _ in range(count)]
    if isinstance(kind, type):
        return kind._read(reader)
    if kind == "string":
        size = struct.unpack(">i", reader.take(4))[0]
        if size < 1:
            raise ValueError(f"a text of {size} bytes")
        return reader.take(size)[:-1].decode("utf-8", "replace")
    return struct.unpack(">" + _FORMATS[kind], reader.take(_SIZES[kind]))[0]
