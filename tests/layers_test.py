#!/usr/bin/env python3
"""Shows that layers.py finds each kind of violation, at its line, and nothing in a tree that keeps the rules."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

script = Path(__file__).with_name("layers.py")

good = {
    "engine/a.h": "#pragma once\n#include <vector>\n",
    "engine/simd/b-inl.h": "#if defined(TOGGLE) == 1\n#endif\n",
    "systems/build_bvh.cpp": '#include <embree3/rtcore.h>\n#include "engine/a.h"\n',
    "scenes/obj.cpp": '#include <tiny_obj_loader.h>\n#include "systems/s.h"\n',
    "systems/s.h": "#pragma once\n",
    "tests/systems/s_test.cpp": '#include <gtest/gtest.h>\n#include "scenes/r.h"\n',
    "scenes/r.h": "#pragma once\n",
}


def run_on(files):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            path = Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        done = subprocess.run([sys.executable, script, folder], capture_output=True, text=True)
        return done.returncode, done.stdout


class Layers(unittest.TestCase):
    def expect_violation(self, name, text, place):
        code, output = run_on({**good, name: text})
        self.assertEqual(code, 1, output)
        self.assertTrue(output.startswith(place), output)
        self.assertEqual(len(output.splitlines()), 1, output)

    def test_a_tree_that_keeps_the_rules_passes(self):
        self.assertEqual(run_on(good), (0, "layers: 7 files keep the rules\n"))

    def test_a_tree_without_sources_fails(self):
        self.assertEqual(run_on({"readme.txt": ""})[0], 1)

    def test_includes_to_the_right_are_found(self):
        self.expect_violation("engine/x.cpp", '#include "engine/a.h"\n#include "systems/s.h"\n', "engine/x.cpp:2: ")
        self.expect_violation("systems/x.cpp", ' # include "scenes/r.h"\n', "systems/x.cpp:1: ")
        self.expect_violation("bench/x_bench.cpp", '#include "tests/systems/s_test.cpp"\n', "bench/x_bench.cpp:1: ")

    def test_includes_that_are_not_full_paths_are_found(self):
        self.expect_violation("engine/x.cpp", '#include "a.h"\n', "engine/x.cpp:1: ")

    def test_third_party_headers_out_of_place_are_found(self):
        for number, header in enumerate(("embree3/rtcore.h", "openvdb/openvdb.h", "OpenImageIO/imageio.h", "json/json.h",
                                         "CLI/CLI.hpp", "tiny_obj_loader.h", "tbb/task_arena.h", "ImfHeader.h",
                                         "gtest/gtest.h", "benchmark/benchmark.h")):
            with self.subTest(header):
                self.expect_violation("engine/x.cpp", "\n" * number + f"#include <{header}>\n",
                                      f"engine/x.cpp:{number + 1}: ")

    def test_a_second_wrapper_of_a_library_that_has_one_is_found(self):
        self.expect_violation("scenes/other.cpp", "#include <tiny_obj_loader.h>\n", "scenes/other.cpp:1: ")

    def test_long_files_are_found(self):
        self.expect_violation("engine/x.cpp", "//\n" * 401, "engine/x.cpp:401: ")
        self.assertEqual(run_on({**good, "engine/x.cpp": "//\n" * 400})[0], 0)

    def test_unguarded_headers_are_found(self):
        self.expect_violation("engine/x.h", "int f();\n", "engine/x.h:1: ")


if __name__ == "__main__":
    unittest.main()
