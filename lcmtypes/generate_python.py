#!/usr/bin/env python3
"""Writes the Python modules of our message types: one a type, and the names of the channels.

Usage: generate_python.py --headers FOLDER --channels FILE --output FOLDER TYPE.lcm...
  --headers   where lcm-gen put the C++ headers: the types' fingerprints are taken from there
  --channels  processes/node/message/channels.h
  --output    the package's folder

Why not `lcm-gen --python`: what it makes (1.3.1) cannot encode a message whose bytes were not set, sends too few bytes where a
list is shorter than its count, takes negative counts, truncated and trailing bytes for valid, and builds as many empty rows as
a packet announces. Nearly each line would have to be mended. Here the types are tables, one codec (_codec.py) reads and writes
them, and the comments of the .lcm files become docstrings.

Only what our types use is known: everything else is an error.
"""
import argparse
import pathlib
import re
import sys

NUMBERS = {"int8_t", "int16_t", "int32_t", "int64_t", "float", "double", "boolean", "byte"}
KINDS = NUMBERS | {"string"}
MAX_BYTES_WITH_PIXELS = 40 << 20  # as kMaxMessageBytes in processes/node/message/codec.h
MAX_BYTES = 1 << 20

STRUCT = re.compile(r"\s*struct\s+(\w+)\s*\{\s*$")
FIELD = re.compile(r"\s*(\w+)\s+(\w+)((?:\[\w+\])*)\s*;\s*(?://\s*(.*))?$")
CONSTANT = re.compile(r"\s*const\s+int\d+_t\s+(\w+)\s*=\s*(-?\d+)\s*;\s*(?://\s*(.*))?$")
COMMENT = re.compile(r"\s*//\s?(.*)$")


class Type:
    """One struct of an .lcm file."""

    def __init__(self, path):
        self.name = path.stem
        self.comment = []
        self.fields = []  # name, kind, dimensions, comment
        self.constants = []  # name, value, comment
        self.is_inside = False
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if not self._take(line):
                sys.exit(f"{path}:{number}: generate_python.py does not know this: {line.strip()}")
        if not self.fields:
            sys.exit(f"{path}: no struct")

    def _take(self, line):
        if not self.is_inside:
            return self._take_outside(line)
        if match := CONSTANT.match(line):
            self.constants.append((match[1], int(match[2]), [match[3] or ""]))
        elif match := FIELD.match(line):
            dimensions = [int(d) if d.isdigit() else d for d in re.findall(r"\w+", match[3])]
            self.fields.append((match[2], match[1], dimensions, [match[4] or ""]))
        elif match := COMMENT.match(line):
            # Far to the right it goes on with the line before, else it is about what follows.
            if line.startswith("      "):
                (self.constants or self.fields)[-1][-1].append(match[1].strip())
        else:
            return line.strip() in ("", "}")
        return True

    def _take_outside(self, line):
        if match := STRUCT.match(line):
            self.is_inside = True
            return match[1] == self.name
        if match := COMMENT.match(line):
            self.comment.append(match[1])
            return True
        return line.strip() in ("", "package airdos;")

    def nested(self):
        return sorted({kind for _, kind, _, _ in self.fields if kind not in KINDS})

    def max_bytes(self):
        return MAX_BYTES_WITH_PIXELS if any(f[1] == "byte" for f in self.fields) else MAX_BYTES


def fingerprint_base(header):
    """What lcm-gen computed for the type itself; those of nested types are added when it is used."""
    found = re.findall(r"uint64_t hash = (0x[0-9a-f]+)LL", header.read_text())
    if len(found) != 1:
        sys.exit(f"{header}: {len(found)} fingerprints, not one")
    return found[0]


def docstring(lcm_type):
    lines = list(lcm_type.comment) + [""]
    for name, kind, dimensions, comment in lcm_type.fields:
        extents = "".join(f"[{d}]" for d in dimensions)
        lines.append(f"{name}: {kind}{extents}" + (": " if comment[0] else "") + comment[0])
        lines += ["    " + more for more in comment[1:]]
    text = "\n".join(f"    {line}".rstrip() for line in lines).strip()
    return text.replace("\\", "\\\\").replace('"""', "'''")


def module(lcm_type, base):
    text = [f"# Made from {lcm_type.name}.lcm by generate_python.py; not to be edited.", "from ._codec import Message"]
    text += [f"from .{name} import {name}" for name in lcm_type.nested()]
    text += ["", "", f"class {lcm_type.name}(Message):", f'    """{docstring(lcm_type)}', '    """', "", "    FIELDS = ("]
    for name, kind, dimensions, _ in lcm_type.fields:
        kind_text = f'"{kind}"' if kind in KINDS else kind
        extents = ", ".join(str(d) if isinstance(d, int) else f'"{d}"' for d in dimensions)
        text.append(f'        ("{name}", {kind_text}, ({extents}{"," * (len(dimensions) == 1)})),')
    text += ["    )", "    __slots__ = tuple(name for name, _, _ in FIELDS)", f"    FINGERPRINT_BASE = {base}"]
    text += [f"    MAX_BYTES = {lcm_type.max_bytes()}", ""]
    for name, value, comment in lcm_type.constants:
        text.append(f"    {name} = {value}" + (f"  # {' '.join(comment)}" if comment[0] else ""))
    return "\n".join(text).rstrip() + "\n"


def channels_module(header):
    names = re.findall(r'inline constexpr char k\w+\[\] = "(\w+)";', header.read_text())
    if not names:
        sys.exit(f"{header}: no channels")
    lines = ['"""The channels, one type and one publisher each: lcmtypes/README.md, in share/airdos where AirDOS is installed."""']
    lines += [f'{name} = "{name}"' for name in names]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--headers", type=pathlib.Path, required=True)
    parser.add_argument("--channels", type=pathlib.Path, required=True)
    parser.add_argument("--output", type=pathlib.Path, required=True)
    parser.add_argument("files", type=pathlib.Path, nargs="+")
    arguments = parser.parse_args()
    types = [Type(path) for path in sorted(arguments.files)]
    known = {lcm_type.name for lcm_type in types}
    for lcm_type in types:
        for name in lcm_type.nested():
            if name not in known:
                sys.exit(f"{lcm_type.name}.lcm: no type {name}")
        base = fingerprint_base(arguments.headers / f"{lcm_type.name}.hpp")
        (arguments.output / f"{lcm_type.name}.py").write_text(module(lcm_type, base))
    (arguments.output / "channels.py").write_text(channels_module(arguments.channels))
    lines = ['"""AirDOS for clients in Python: message types, LCM over UDP multicast (bus), LCM logs (log). Standard library only."""']
    lines += ["from . import channels", "from .bus import Bus", "from .log import LogReader, LogWriter"]
    lines += [f"from .{name} import {name}" for name in sorted(known)]
    (arguments.output / "__init__.py").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
