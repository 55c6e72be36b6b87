# SPDX-License-Identifier: MIT
"""scripts/check_format.sh names files that are not formatted, and judges in one version only."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

CHECK = pathlib.Path(__file__).parents[2] / "scripts/check_format.sh"
NOT_CHECKED = 77


class CheckFormat(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        self.file = self.folder / "file.cpp"
        self.file.write_text("int  main( ) {return 0;}\n")

    def check(self, *arguments, path=None):
        environment = {**os.environ, "PATH": path or os.environ["PATH"]}
        return subprocess.run(["bash", CHECK, *arguments], env=environment,
                              capture_output=True, text=True, check=False)

    def make_path(self, version=None):
        """A PATH with what the script uses and, if at all, a clang-format of this version."""
        programs = self.folder / "bin"
        programs.mkdir()
        for name in ("bash", "cat", "dirname", "sed", "sort"):
            (programs / name).symlink_to(shutil.which(name))
        if version:
            fake = programs / "clang-format"
            fake.write_text(f"#!{shutil.which('bash')}\n[[ $1 == --version ]] || exit 1\n"
                            f"echo 'Ubuntu clang-format version {version}.1.0 (7)'\n")
            fake.chmod(0o755)
        return str(programs)

    def test_a_file_that_is_not_formatted_is_named_until_it_is_fixed(self):
        done = self.check(self.file)
        if done.returncode == NOT_CHECKED:
            self.skipTest(done.stderr)
        self.assertEqual(done.returncode, 1)
        self.assertIn(f"{self.file}\n", done.stderr)
        self.assertIn("1 of 1 files", done.stderr)
        self.assertEqual(self.check("--fix", self.file).returncode, 0)
        self.assertEqual(self.check(self.file).returncode, 0)

    def test_a_file_that_is_missing_is_an_error(self):
        done = self.check(self.folder / "missing.cpp")
        if done.returncode == NOT_CHECKED:
            self.skipTest(done.stderr)
        self.assertEqual(done.returncode, 1)
        self.assertIn("No such file", done.stderr)

    def test_another_version_is_told_and_judges_nothing(self):
        done = self.check(self.file, path=self.make_path(version=99))
        self.assertEqual((done.returncode, done.stdout), (NOT_CHECKED, ""))
        self.assertIn("version 99", done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1)

    def test_no_version_at_all_is_told(self):
        done = self.check(self.file, path=self.make_path())
        self.assertEqual((done.returncode, done.stdout), (NOT_CHECKED, ""))
        self.assertIn("is not installed", done.stderr)

    def test_unknown_options_are_refused(self):
        done = self.check("--fit", self.file)
        self.assertEqual(done.returncode, 2)
        self.assertIn("--fit", done.stderr)


if __name__ == "__main__":
    unittest.main()
