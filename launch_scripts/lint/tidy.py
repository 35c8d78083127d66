#!/usr/bin/python3
"""Runs clang-tidy over the units of a build folder, a batch of them at a time, and remembers which were clean.

Nearly all of clang-tidy's time goes into the headers of Eigen, OpenCV, Ceres and GoogleTest, which it reads again for each
unit. So units are included into one, their local names, where two have the same, renamed by macros; where that cannot be, they go to
different batches, and a batch that does not compile is halved until it does. A batch whose text, with all headers of ours that it includes, was clean
once is not looked at again.

Exit code 0 if there is nothing to report, 1 if there is, 2 for wrong arguments.
"""

import argparse
import concurrent.futures
import hashlib
import itertools
import json
import os
import re
import shlex
import subprocess
import sys

MAX_BATCH = 40
# Where units are joined, the local names of one hide those of another; g++ warns of real shadows in each build. What clang's
# -Wconversion says beyond that of g++, an int as an index, is no mistake here. A main() that goes by another name would have to return
# something; of other functions g++ knows. Twenty errors would end a unit, and look like a batch that does not compile.
FLAGS = ["-Wno-shadow", "-Wno-sign-conversion", "-Wno-return-type", "-ferror-limit=0"]
INCLUDE = re.compile(r'^#include "([^"]+)"', re.M)
TYPE = re.compile(r"^(?:struct|class|enum class|enum|using)\s+(\w+)\b(?!;)", re.M)
TEST = re.compile(r"^(?:TEST|TEST_F|TEST_P|TYPED_TEST|BENCHMARK\w*)\((\w+)(?:, (\w+))?\)", re.M)
ANONYMOUS = re.compile(r"^namespace \{$(.*?)^\}  // namespace$", re.M | re.S)
VARIABLE = re.compile(r"^(?:static |inline |constexpr |const |thread_local )+[^(={;]*?(\w+)(?:\[[^\]]*\])*\s*[={;]", re.M)
FUNCTION = re.compile(r"^(?:\[\[[^\]\n]*\]\] )?\w[^=;(\n]*?\b(\w+)\(", re.M)
QUALIFIED = re.compile(r"::(\w+)")
MAIN = re.compile(r"^int (main)\(", re.M)
WORD = re.compile(r"\w+")
# What the macros of GoogleTest name, testing::Message, and a unit may name, too.
IN_MACROS = {"Message"}
FINDING = re.compile(r"^(?P<file>/[^:\n]+):(?P<line>\d+):(?P<column>\d+): (?:warning|error): .*\[(?P<check>[^\]]+)\]$")


def fail(text):
    print(f"tidy.py: {text}", file=sys.stderr)
    sys.exit(2)


class Tree:
    """The text of our files, what they include and which names they define."""

    def __init__(self, root, build):
        self.folders = (root, os.path.join(build, "generated"))
        self.texts = {}
        self.closures = {}
        self.cache = {}

    def text(self, path):
        if path not in self.texts:
            with open(path, encoding="utf-8") as file:
                self.texts[path] = file.read()
        return self.texts[path]

    def find(self, include):
        return next((path for path in (os.path.join(folder, include) for folder in self.folders) if os.path.exists(path)), None)

    def closure(self, path):
        """The file and all headers of ours that it includes, directly or not."""
        if path not in self.closures:
            seen, todo = set(), [path]
            while todo:
                here = todo.pop()
                if here not in seen:
                    seen.add(here)
                    todo += filter(None, map(self.find, INCLUDE.findall(self.text(here))))
            self.closures[path] = frozenset(seen)
        return self.closures[path]

    def tests(self, path):
        return {"_".join(filter(None, groups)) for groups in TEST.findall(self.text(path))}

    def local_names(self, path):
        """What would be defined twice if two units with the same name were one."""
        text = self.text(path)
        names = self.tests(path) | set(MAIN.findall(text))
        for inside in ANONYMOUS.findall(text) + re.findall(r"^static .*?[;{]$", text, re.M):
            for pattern in (TYPE, VARIABLE, FUNCTION):
                names.update(pattern.findall(inside))
        return names

    def in_headers(self, pattern, closure):
        return {name for path in closure if path.endswith(".h") for name in self.found(pattern, path)}

    def found(self, pattern, path):
        key = (pattern, path)
        if key not in self.cache:
            self.cache[key] = frozenset(pattern.findall(self.text(path)))
        return self.cache[key]


class Unit:
    def __init__(self, tree, path, command):
        words = shlex.split(command)
        self.path = path
        self.flags = words[1 : words.index("-o")]
        self.closure = tree.closure(path)
        self.names = tree.local_names(path)
        self.declared = tree.in_headers(TYPE, self.closure) | tree.in_headers(FUNCTION, self.closure)
        # A macro would change these in its headers, too, or where another's are meant (std::move), or does not reach them. They must
        # be nobody else's. Of "main" headers speak in comments only.
        unchangeable = tree.in_headers(WORD, self.closure) | tree.tests(path) | tree.found(QUALIFIED, path) | IN_MACROS
        self.fixed_names = self.names & unchangeable - {"main"}
        top = os.path.relpath(path, tree.folders[0]).split(os.sep)[0]
        self.group = (top, next((word for word in self.flags if word.endswith(".pch")), ""))

    def fits(self, batch):
        return not any(
            self.fixed_names & (other.names | other.declared) or other.fixed_names & (self.names | self.declared) for other in batch
        )


def read_units(tree, build):
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
        commands = json.load(file)
    root = tree.folders[0]
    units = {}
    for entry in commands:
        path = os.path.normpath(entry["file"])
        if path.startswith(root + os.sep) and not path.startswith(build + os.sep) and path not in units:
            units[path] = Unit(tree, path, entry["command"])
    return units


def make_batches(units):
    groups = {}
    for unit in units:
        batches = groups.setdefault(unit.group, [])
        batch = next((batch for batch in batches if len(batch) < MAX_BATCH and unit.fits(batch)), None)
        if batch is None:
            batches.append([unit])
        else:
            batch.append(unit)
    return [batch for batches in groups.values() for batch in batches]


def merged_flags(batch):
    """The flags of the first, and what other units of the batch define or include besides."""
    flags = list(batch[0].flags)
    for unit in batch[1:]:
        for i, word in enumerate(unit.flags):
            if word.startswith("-D") and word not in flags:
                flags.append(word)
            elif word == "-isystem" and unit.flags[i + 1] not in flags:
                flags += unit.flags[i : i + 2]
    return flags


def joined(batch):
    """The text of a unit that is all of these."""
    lines = []
    for number, unit in enumerate(batch):
        others = set().union(*(other.names | other.declared for other in batch if other is not unit))
        same = sorted((unit.names - unit.fixed_names) & others)
        lines += [f"#define {name} {name}_{number}" for name in same]
        # The check of includes of .cc files looks at the main file only, which this is.
        lines += [f'#include "{unit.path}"  // NOLINT']
        lines += [f"#undef {name}" for name in same]
    return "\n".join(lines) + "\n"


class Runner:
    def __init__(self, tree, options):
        self.tree = tree
        self.options = options
        self.folder = os.path.join(options.build, "tidy")
        self.num_halved = 0
        os.makedirs(self.folder, exist_ok=True)
        version = subprocess.run([options.program, "--version"], capture_output=True, text=True, check=True).stdout
        with open(os.path.join(options.root, ".clang-tidy"), encoding="utf-8") as file:
            self.setting = version + file.read() + " ".join(options.checks)

    def key(self, batch):
        digest = hashlib.sha256(self.setting.encode())
        for path in sorted(set().union(*(unit.closure for unit in batch))):
            digest.update(f"\0{path}\0{self.tree.text(path)}".encode())
        for unit in batch:
            digest.update(f"\0{unit.path}\0{unit.flags}".encode())
        return digest.hexdigest()

    def run(self, batch):
        """The output about a batch: nothing if it is clean."""
        key = self.key(batch)
        verdict = os.path.join(self.folder, key)
        known = ""
        if os.path.exists(verdict):
            with open(verdict, encoding="utf-8") as file:
                known = file.read()
        if known == "clean":
            return ""
        if known == "halve":
            return self.halve(batch)
        output, code = self.tidy(batch, key)
        if len(batch) > 1 and "clang-diagnostic-error" in output:
            known, result = "halve", self.halve(batch)
        elif code == 0:
            known, result = "clean", ""
        else:
            return output
        with open(verdict, "w", encoding="utf-8") as file:
            file.write(known)
        return result

    def halve(self, batch):
        self.num_halved += 1
        middle = len(batch) // 2
        return self.run(batch[:middle]) + self.run(batch[middle:])

    def tidy(self, batch, key):
        source = batch[0].path
        if len(batch) > 1:
            source = os.path.join(self.folder, f"batch_{key[:16]}.cc")
            with open(source, "w", encoding="utf-8") as file:
                file.write(joined(batch))
        command = [self.options.program, "--quiet", f"--config-file={self.options.root}/.clang-tidy", *self.options.checks]
        command += ["--fix"] if self.options.fix else []
        command += [source, "--", *merged_flags(batch), *FLAGS]
        done = subprocess.run(command, capture_output=True, text=True, cwd=self.options.build, check=False)
        if done.returncode not in (0, 1):
            return f"{source}:1:1: error: clang-tidy ended with {done.returncode}: {done.stderr} [crash]\n", 1
        return done.stdout, done.returncode


def check_lone_headers(tree, units, runner):
    """A header that no unit includes first was not yet compiled by itself: the precompiled headers aside, which includes.py is for."""
    first = {tree.find(include) for unit in units for include in INCLUDE.findall(tree.text(unit.path))[:1]}
    users = {}
    for unit in units:
        for path in unit.closure:
            if path.endswith(".h") and path not in first and not path.startswith(runner.options.build + os.sep):
                users.setdefault(path, unit)
    compiler = runner.options.program.replace("clang-tidy", "clang++")

    def run(header):
        unit = users[header]
        key = "header_" + runner.key([unit]) + hashlib.sha256(header.encode()).hexdigest()[:16]
        if os.path.exists(os.path.join(runner.folder, key)):
            return ""
        source = os.path.join(runner.folder, f"{key[:24]}_{os.path.basename(header)}.cc")
        with open(source, "w", encoding="utf-8") as file:
            file.write(f'#include "{header}"\n')
        command = [compiler, *unit.flags, *FLAGS, "-fsyntax-only", source]
        done = subprocess.run(command, capture_output=True, text=True, cwd=runner.options.build, check=False)
        os.remove(source)
        if done.returncode == 0:
            with open(os.path.join(runner.folder, key), "w", encoding="utf-8"):
                pass
            return ""
        return re.sub(r"^(/.*: error: .*)$", r"\1 [by itself]", done.stderr, flags=re.M)

    return sorted(users), run


def print_findings(outputs):
    """Each finding once, with the lines that explain it; returns their number."""
    seen = set()
    for output in outputs:
        shown = False
        for line in output.splitlines():
            match = FINDING.match(line)
            if match:
                shown = match.groups() not in seen
                seen.add(match.groups())
            if shown:
                print(line, flush=True)
    return len(seen)


def chosen(units, paths):
    """The units that are named, or lie in a named folder, or include a named header; of these only the first."""
    picked = {}
    for path in map(os.path.abspath, paths):
        if path.endswith(".h"):
            own = [path[:-2] + ".cc"] + [unit.path for unit in units.values() if path in unit.closure]
            found = [units[name] for name in own if name in units][:1]
        else:
            found = [unit for unit in units.values() if unit.path == path or unit.path.startswith(path + os.sep)]
        picked.update((unit.path, unit) for unit in found)
    return list(picked.values())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--root", required=True, help="source folder")
    parser.add_argument("--build", required=True, help="build folder with compile_commands.json and precompiled headers")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--program", default="clang-tidy")
    parser.add_argument("--each", action="store_true", help="each unit by itself")
    parser.add_argument("--fix", action="store_true", help="mend what can be mended, one unit after the other")
    parser.add_argument("--checks", default=[], type=lambda text: [f"--checks={text}"], help="added to those of .clang-tidy")
    parser.add_argument("--print-batches", action="store_true", help="only say which units go together")
    parser.add_argument("paths", nargs="*")
    options = parser.parse_args()
    options.root, options.build = os.path.abspath(options.root), os.path.abspath(options.build)
    try:
        tree = Tree(options.root, options.build)
        units = read_units(tree, options.build)
        runner = Runner(tree, options)
    except OSError as error:
        fail(error)
    todo = chosen(units, options.paths) if options.paths else list(units.values())
    batches = [[unit] for unit in todo] if options.each or options.fix else make_batches(todo)
    if options.print_batches:
        for batch in batches:
            print(" ".join(os.path.relpath(unit.path, options.root) for unit in batch))
        return 0
    if options.fix:
        options.jobs = 1
    batches.sort(key=len, reverse=True)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        headers, run = check_lone_headers(tree, todo, runner)
        num = print_findings(itertools.chain(pool.map(runner.run, batches), pool.map(run, headers)))
    halved = f" ({runner.num_halved} halved, which takes twice as long)" if runner.num_halved else ""
    print(f"clang-tidy: {len(todo)} units in {len(batches)} batches{halved}, {len(headers)} headers by themselves, {num} findings")
    return int(num > 0)


if __name__ == "__main__":
    sys.exit(main())
