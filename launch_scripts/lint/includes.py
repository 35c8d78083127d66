#!/usr/bin/python3
"""Checks that whoever uses a name of the standard library, Eigen, OpenCV, GoogleTest or nlohmann includes its header.

The precompiled headers of a normal build would hide that it is missing. An include by way of our own headers counts, one by way
of others' headers does not.

Usage: includes.py ROOT [PATH…]; exit code 0 if there is nothing to report, 1 if there is.
"""

import os
import re
import subprocess
import sys

# Header: what it brings. Several headers that bring one name: any of them will do.
STANDARD = {
    "algorithm": "all_of any_of none_of find find_if count count_if sort stable_sort nth_element clamp max_element min_element "
    "minmax_element fill fill_n transform remove_if equal replace replace_if lower_bound upper_bound copy copy_n copy_if unique "
    "is_sorted shuffle rotate reverse includes next_permutation search stable_partition partition iter_swap adjacent_find "
    "set_difference set_intersection for_each binary_search partial_sort generate mismatch min max",
    "array": "array",
    "atomic": "atomic",
    "bitset": "bitset",
    "cctype": "isdigit isalnum isalpha isspace tolower toupper",
    "chrono": "chrono",
    "cmath": "sqrt sin cos tan pow log log10 log1p exp lround llround hypot isfinite isinf isnan nan floor ceil round atan2 remainder",
    "condition_variable": "condition_variable",
    "csignal": "signal sig_atomic_t raise",
    "cstdint": "int8_t int16_t int32_t int64_t uint8_t uint16_t uint32_t uint64_t uintmax_t",
    "cstdio": "snprintf vsnprintf printf fprintf fputs fopen fclose fread fgets fflush ftell ferror setvbuf perror rename",
    "cstdlib": "getenv strtod strtoull exit atoi atoll atof abort malloc free",
    "cstring": "memcpy memcmp strlen strerror strcpy",
    "ctime": "clock clock_t time_t",
    "deque": "deque",
    "exception": "exception exception_ptr current_exception rethrow_exception",
    "filesystem": "filesystem",
    "fstream": "ifstream ofstream fstream",
    "functional": "function",
    "iomanip": "setw setprecision",
    "iostream": "cout cerr cin",
    "iterator": "istreambuf_iterator istream_iterator back_inserter",
    "limits": "numeric_limits",
    "map": "map multimap",
    "memory": "unique_ptr shared_ptr make_unique make_shared weak_ptr",
    "mutex": "mutex unique_lock lock_guard",
    "numeric": "iota inner_product accumulate",
    "optional": "optional nullopt make_optional",
    "random": "mt19937 mt19937_64 uniform_real_distribution uniform_int_distribution normal_distribution seed_seq",
    "regex": "regex smatch regex_match regex_search regex_error",
    "set": "set multiset",
    "sstream": "istringstream ostringstream stringstream",
    "string": "string to_string getline stoi stoul stoll stod stoull",
    "string_view": "string_view",
    "system_error": "error_code errc make_error_code system_error",
    "thread": "thread this_thread",
    "tuple": "tuple tie make_tuple",
    "unordered_map": "unordered_map",
    "utility": "exchange swap",
    "variant": "variant monostate get_if holds_alternative",
    "vector": "vector",
}
ALSO = {  # further headers that bring the name
    "error_code": ["filesystem"],
    "mutex": ["condition_variable"],
    "swap": ["vector", "string", "memory", "map"],
    "getline": ["string"],
    "signal": ["signal.h"],
    "time_t": ["time.h"],
    "rename": ["filesystem"],
    "cout": ["ostream"],
}
OTHERS = [
    (re.compile(r"\bEigen::"), re.compile(r"Eigen/"), "<Eigen/…>"),
    (re.compile(r"\bcv::"), re.compile(r"opencv2/"), "<opencv2/…>"),
    (re.compile(r"^(?:TEST|TEST_F|TEST_P)\(|\bEXPECT_|\bASSERT_|\btesting::", re.M), re.compile(r"g(test|mock)/"), "<gtest/gtest.h>"),
    (re.compile(r"\bnlohmann::"), re.compile(r"nlohmann/"), "<nlohmann/json.hpp>"),
]
BRINGS = {}
for header, names in STANDARD.items():
    for name in names.split():
        BRINGS.setdefault(name, [header]).extend(ALSO.get(name, []))

NAME = re.compile(r"\bstd::([a-z_0-9]+)\b")
OURS = re.compile(r'^\s*#\s*include "([^"]+)"', re.M)
ANY = re.compile(r'^\s*#\s*include [<"]([^>"]+)[>"]', re.M)
NOISE = re.compile(r'//[^\n]*|R"\((?:.|\n)*?\)"|"(?:[^"\\\n]|\\.)*"')


class Tree:
    def __init__(self, root):
        self.root, self.closures, self.texts = root, {}, {}
        listed = subprocess.run(["git", "-C", root, "ls-files", "-co", "--exclude-standard", "*.h", "*.cc"], capture_output=True, text=True)
        self.files = [path for path in listed.stdout.split() if os.path.exists(os.path.join(root, path))]
        if listed.returncode != 0:  # an unpacked archive
            for top in ("common", "processes", "tests", "examples"):
                for folder, _, names in os.walk(os.path.join(root, top)):
                    self.files += [os.path.relpath(os.path.join(folder, name), root) for name in names if name.endswith((".h", ".cc"))]
        for path in self.files:
            with open(os.path.join(root, path), encoding="utf-8") as file:
                self.texts[path] = file.read()

    def brought(self, path):
        """All includes of the file and of our headers that it includes."""
        if path not in self.closures:
            self.closures[path] = set()  # a circle ends here
            found = set(ANY.findall(self.texts[path]))
            for ours in OURS.findall(self.texts[path]):
                if ours in self.texts:
                    found |= self.brought(ours)
            self.closures[path] = found
        return self.closures[path]


def missing(tree, path):
    """Line and text of each complaint about the file."""
    brought, code = tree.brought(path), NOISE.sub(lambda match: "\n" * match[0].count("\n"), tree.texts[path])
    seen = set()
    for match in NAME.finditer(code):
        headers = BRINGS.get(match[1])
        if headers and headers[0] not in seen and not brought & set(headers):
            seen.add(headers[0])
            yield code.count("\n", 0, match.start()) + 1, f"std::{match[1]} needs #include <{headers[0]}>"
    for used, header, text in OTHERS:
        match = used.search(code)
        if match and not any(map(header.match, brought)):
            yield code.count("\n", 0, match.start()) + 1, f"{match[0]} needs #include {text}"


def main():
    root = os.path.abspath(sys.argv[1])
    tree = Tree(root)
    only = [os.path.relpath(path, root) for path in sys.argv[2:]]
    num = 0
    for path in tree.files:
        if only and not any(path == name or path.startswith(name + os.sep) or name == "." for name in only):
            continue
        complaints = list(missing(tree, path))
        for line, text in complaints:
            print(f"{path}:{line}: {text}")
        num += len(complaints)
    if not tree.files:
        sys.exit(f"includes.py: no sources in {root}")
    return int(num > 0)


if __name__ == "__main__":
    sys.exit(main())
