# SPDX-License-Identifier: MIT
"""scripts/check_skips.py judges what ctest itself wrote for a small project."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

CHECK = pathlib.Path(__file__).parents[2] / "scripts/check_skips.py"
PROJECT = r"""
cmake_minimum_required(VERSION 3.25)
project(Skips LANGUAGES NONE)
enable_testing()
add_test(NAME a/Runs COMMAND sh -c "exit 0")
add_test(NAME a/Skips COMMAND sh -c "exit 77")
set_tests_properties(a/Skips PROPERTIES SKIP_RETURN_CODE 77)
add_test(NAME "a/GoogleTests<skip>" COMMAND sh -c "echo '[  SKIPPED ] Some.Test'")
set_tests_properties("a/GoogleTests<skip>" PROPERTIES SKIP_REGULAR_EXPRESSION "\\[  SKIPPED \\]")
add_test(NAME a/Disabled COMMAND sh -c "exit 0")
set_tests_properties(a/Disabled PROPERTIES DISABLED TRUE)
"""
ALL_EXPECTED = """
# A comment.
absent no/such/file : a/S* : it reads the file
no-program sh no_such_program : a/GoogleTests<skip> : it runs the program
no-module no_such_module : a/Disabled : it imports the module
"""


class CheckSkips(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.results = cls.folder / "results.xml"
        (cls.folder / "CMakeLists.txt").write_text(PROJECT)
        build = cls.folder / "build"
        cmake, ctest = os.environ["SHUTTER_CMAKE"], os.environ["SHUTTER_CTEST"]
        # The generator that scripts/setup.sh installs; the default one may be missing.
        for command in ([cmake, "-G", "Ninja", "-S", cls.folder, "-B", build],
                        [ctest, "--test-dir", build, "--output-junit", cls.results]):
            subprocess.run(command, check=True, capture_output=True)

    def check(self, expected, results=None, **environment):
        listed = self.folder / "expected.txt"
        listed.write_text(expected)
        return subprocess.run(
            [sys.executable, CHECK, results or self.results, listed],
            env={**os.environ, **environment}, capture_output=True, text=True, check=False)

    def expect_fault(self, expected, *mentions, **more):
        done = self.check(expected, **more)
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertEqual(done.stdout, "")
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        for mention in mentions:
            self.assertIn(mention, done.stderr)

    def test_skips_that_are_all_expected_pass(self):
        done = self.check(ALL_EXPECTED)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("3 of 4 tests", done.stdout)

    def test_each_skip_without_a_line_is_named(self):
        for line in ALL_EXPECTED.strip().splitlines()[1:]:
            name = {"S": "a/Skips", "G": "a/GoogleTests<skip>", "D": "a/Disabled"}[
                line.split(" : ")[1][2]]
            self.expect_fault(ALL_EXPECTED.replace(line, ""), f"{name} was skipped")

    def test_a_skip_whose_condition_does_not_hold_is_named_with_its_line(self):
        self.expect_fault(ALL_EXPECTED.replace("no/such/file", "README.md"),
                          "a/Skips was skipped", "line 3", "absent README.md")
        self.expect_fault(ALL_EXPECTED.replace("no_such_program", "true"), "a/GoogleTests<skip>")
        self.expect_fault(ALL_EXPECTED.replace("no_such_module", "json"), "a/Disabled")

    def test_a_pattern_that_matches_no_test_is_named(self):
        self.expect_fault(ALL_EXPECTED + "absent README.md : b/* : it is gone\n",
                          "line 6", "b/* matches no test")

    def test_a_test_that_runs_where_it_may_skip_passes(self):
        done = self.check(ALL_EXPECTED + "absent no/such/file : a/Runs : it needs little of it\n")
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_the_device_is_another_one_where_the_environment_names_its_driver(self):
        listed = ALL_EXPECTED.replace("absent no/such/file", "other-device")
        done = self.check(listed, VK_DRIVER_FILES="/icd.d/nvidia_icd.json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.expect_fault(listed, "a/Skips", VK_DRIVER_FILES="/icd.d/lvp_icd.x86_64.json")

    def test_lines_that_are_not_understood_are_refused(self):
        for line in ("absent README.md : a/Skips", "never : a/Skips : so", "absent : a/S* : so",
                     "other-device now : a/S* : so", "absent x :  : so"):
            self.expect_fault(ALL_EXPECTED + line + "\n", "expected.txt:6")

    def test_results_that_are_missing_broken_or_empty_are_refused(self):
        broken, empty = self.folder / "broken.xml", self.folder / "empty.xml"
        broken.write_text("<testsuite>")
        empty.write_text("<testsuite/>")
        for results in (self.folder / "none.xml", broken, empty):
            self.expect_fault(ALL_EXPECTED, results.name, results=results)


if __name__ == "__main__":
    unittest.main()
