#!/usr/bin/env python3
"""Checks the house rules a compiler cannot see, over the tree given (default: the one this file is in).

Includes go left only, quoted includes name a file by its full path from the root, third-party headers stay in
the few files that wrap them, headers are guarded, files stay short. Prints `file:line: what is wrong` for each
violation and exits 1 if there is any.
"""
import fnmatch
import re
import sys
from pathlib import Path

longest_file = 400  # lines; 300 is the aim

# What each room may include, besides itself.
rooms = {
    "engine": set(),
    "systems": {"engine"},
    "scenes": {"engine", "systems"},
    "bench": {"engine", "systems", "scenes"},
    "tests": {"engine", "systems", "scenes"},
}

# Library, its headers, the files of engine, systems and scenes that may include them, and at most how many do.
# Benchmarks and tests may look behind the wrappers.
libraries = [
    ("Embree", r"embree\d/", ["systems/build_*", "systems/intersect*", "systems/shadow*", "systems/accelerator.h", "systems/alpha_masks.cpp"], None),
    ("OpenVDB", r"(openvdb|nanovdb)/", ["scenes/volumes/*"], None),
    ("Blosc", r"blosc\.h", ["scenes/volumes/*"], 1),
    ("OpenImageIO", r"OpenImageIO/", ["engine/files/*", "*/textures*", "*/images*", "*/image_*"], None),
    ("OpenColorIO", r"OpenColorIO/", ["systems/ocio_*"], 1),
    ("OpenEXR", r"(OpenEXR/|Imf|Imath)", ["engine/files/*"], None),
    ("oneTBB", r"(oneapi/)?tbb/", ["engine/schedule/*"], None),
    ("jsoncpp", r"json/", ["scenes/*"], None),
    ("CLI11", r"CLI/", ["scenes/program/*"], None),
    ("zlib", r"zlib\.h", ["scenes/*"], 1),
    ("OpenSubdiv", r"opensubdiv/", ["scenes/*"], 1),
    ("tinyobjloader", r"tiny_obj_loader\.h", ["scenes/*"], 1),
    ("GoogleTest", r"g(test|mock)/", [], None),
    ("Google Benchmark", r"benchmark/", [], None),
]

include_line = re.compile(r'\s*#\s*include\s*(?:<([^>]+)>|"([^"]+)")')


def check_quoted(root, room, header):
    """What is wrong with `#include "header"` in a file of this room, or None."""
    top = header.split("/")[0]
    if top == "hwy":  # Highway's own documentation quotes its headers
        return None
    if top in rooms and top != room and top not in rooms[room]:
        return f"{room} must not include {top}: includes go left only (engine <- systems <- scenes <- bench, tests)"
    if not (root / header).is_file():
        return f'"{header}" is not a file by its full path from the root'
    return None


def check_library(room, name, header, users):
    """What is wrong with including a third-party header in the file `name`, or None. Counts users per library."""
    if room in ("bench", "tests"):
        return None
    for library, headers, wrappers, limit in libraries:
        if not re.match(headers, header):
            continue
        if not any(fnmatch.fnmatchcase(name, wrapper) for wrapper in wrappers):
            where = ", ".join(wrappers) if wrappers else "bench and tests"
            return f"{library} stays in {where}"
        users.setdefault(library, set()).add(name)
        if limit is not None and len(users[library]) > limit:
            return f"{library} belongs in {limit} file, and is already in {min(users[library] - {name})}"
    return None


def check_file(root, path, users):
    name = path.relative_to(root).as_posix()
    room = name.split("/")[0]
    lines = path.read_text(encoding="utf-8").splitlines()
    if len(lines) > longest_file:
        yield name, longest_file + 1, f"the file has {len(lines)} lines, {longest_file} are the most"
    if path.suffix == ".h" and not path.name.endswith("-inl.h") and "#pragma once" not in lines:
        yield name, 1, "the header lacks #pragma once"
    for number, line in enumerate(lines, 1):
        found = include_line.match(line)
        if not found:
            continue
        problem = check_quoted(root, room, found[2]) if found[2] else check_library(room, name, found[1], users)
        if problem:
            yield name, number, problem


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    files = [path for room in rooms for path in sorted((root / room).rglob("*"))
             if path.suffix in (".h", ".cpp") and not path.is_relative_to(root / "tests/package")]
    users = {}
    problems = [problem for path in files for problem in check_file(root, path, users)]
    for name, number, text in problems:
        print(f"{name}:{number}: {text}")
    if not files:
        print(f"{root} has no C++ file in {', '.join(rooms)}")
    if problems or not files:
        return 1
    print(f"layers: {len(files)} files keep the rules")
    return 0


if __name__ == "__main__":
    sys.exit(main())
