#!/usr/bin/python3
"""Checks what can be checked of a Dockerfile without an engine: instructions, stages, the sources of COPY, who runs it.

Usage: dockerfile.py FILE…; sources are looked for in the root of the tree, the context of our builds. Exit code 1 if there is
anything to report.
"""

import glob
import json
import os
import re
import sys

KNOWN = set("ADD ARG CMD COPY ENTRYPOINT ENV EXPOSE FROM HEALTHCHECK LABEL ONBUILD SHELL STOPSIGNAL USER VOLUME WORKDIR RUN".split())
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def instructions(lines):
    """Line number, name and rest of each instruction, its continued lines joined."""
    start, whole = 0, ""
    for number, line in enumerate(lines, 1):
        text = line.strip()
        if text.startswith("#") or (not text and not whole):
            continue
        start = start or number
        whole += text[:-1] + " " if text.endswith("\\") else text
        if not text.endswith("\\"):
            name, _, rest = whole.partition(" ")
            yield start, name, rest.strip()
            start, whole = 0, ""
    if whole:
        yield start, "", "the file ends within an instruction"


def check_copy(rest, stages):
    words = [word for word in rest.split() if not word.startswith("--")]
    source = re.search(r"--from=(\S+)", rest)
    if len(words) < 2:
        yield "COPY needs a source and a target"
    if source and source[1] not in stages and not source[1].isdigit() and "/" not in source[1] and ":" not in source[1]:
        yield f"there is no stage '{source[1]}'"
    if not source:
        for word in words[:-1]:
            if not glob.glob(os.path.join(ROOT, word)):
                yield f"there is no '{word}'"


def check(path):
    with open(path, encoding="utf-8") as file:
        lines = file.read().splitlines()
    stages, user, seen_from, starts = [], "root", False, False
    for number, name, rest in instructions(lines):
        why = []
        if name not in KNOWN:
            why = [f"unknown instruction '{name}'" if name else rest]
        elif not seen_from and name not in ("FROM", "ARG"):
            why = ["the first instruction must be FROM"]
        elif not rest:
            why = [f"{name} of what?"]
        elif name == "FROM":
            words = rest.split()
            seen_from, user, starts = True, "root", False
            if len(words) == 3 and words[1].upper() == "AS":
                stages.append(words[2])
            elif len(words) != 1:
                why = [f"not FROM IMAGE [AS NAME]: '{rest}'"]
            if words[0] not in stages and not re.search(r":(?!latest$)[\w.-]+$|@sha256:", words[0]):
                why.append(f"the image '{words[0]}' has no fixed version")
        elif name in ("COPY", "ADD"):
            why = list(check_copy(rest, stages))
        elif name in ("CMD", "ENTRYPOINT", "SHELL"):
            starts = True
            try:
                words = json.loads(rest)
                if not isinstance(words, list) or not all(isinstance(word, str) for word in words):
                    raise ValueError
            except ValueError:
                why = [f"{name} is not a JSON list of words: a shell would stand between it and its signals"]
        elif name == "USER":
            user = rest.split(":")[0]
        yield from ((number, text) for text in why)
    if not seen_from:
        yield 1, "there is no FROM"
    elif starts and user in ("root", "0"):
        yield len(lines), "it runs as root"


def main():
    num = 0
    for path in sys.argv[1:]:
        for number, text in check(path):
            print(f"{path}:{number}: {text}")
            num += 1
    return int(num > 0)


if __name__ == "__main__":
    sys.exit(main())
