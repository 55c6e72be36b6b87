# SPDX-License-Identifier: MIT
"""A build without tests compiles none, and one of the program alone no benchmark."""

import json
import os
import pathlib
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).parents[2]


class Product(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.build = pathlib.Path(folder.name)
        subprocess.run([os.environ["SHUTTER_CMAKE"], "-S", ROOT, "-B", cls.build, "-G", "Ninja",
                        "-DSHUTTER_TESTS=OFF"], check=True, stdout=subprocess.DEVNULL)

    def list_commands(self, *targets):
        return subprocess.run([os.environ["SHUTTER_NINJA"], "-C", self.build, "-t", "commands",
                               *targets], check=True, capture_output=True, text=True).stdout

    def test_without_tests_no_test_is_compiled(self):
        commands = json.loads((self.build / "compile_commands.json").read_text())
        files = {pathlib.Path(row["file"]) for row in commands}
        ours = {str(file.relative_to(ROOT)) for file in files if file.is_relative_to(ROOT)}
        self.assertIn("game/cli/main.cpp", ours)
        self.assertIn("game/bench/main.cpp", ours)
        self.assertEqual([file for file in ours if file.startswith("tests/")], [])
        self.assertNotIn("tests/", self.list_commands().replace(str(self.build), ""))

    def test_the_program_alone_builds_no_benchmark(self):
        commands = self.list_commands("shutter")
        self.assertIn("game/cli/main.cpp", commands)
        self.assertNotIn("game/bench", commands)


if __name__ == "__main__":
    unittest.main()
