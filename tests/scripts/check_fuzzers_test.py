# SPDX-License-Identifier: MIT
"""scripts/check_fuzzers.sh knows every reader, and says so where it cannot feed them."""

import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).parents[2]
SCRIPT = ROOT / "scripts/check_fuzzers.sh"
FUZZERS = ROOT / "tests/fuzz"
NOT_CHECKED = 77


def check(*arguments, path=None):
    environment = {**os.environ, "PATH": path or os.environ["PATH"]}
    return subprocess.run(["bash", SCRIPT, *arguments], env=environment, capture_output=True,
                          text=True, check=False)


class CheckFuzzers(unittest.TestCase):
    readers = sorted(file.name.removesuffix("_fuzz.cpp") for file in FUZZERS.glob("*_fuzz.cpp"))

    def test_every_reader_has_a_row_a_target_and_seeds(self):
        self.assertGreater(len(self.readers), 5)
        script = SCRIPT.read_text()
        rows = re.findall(r"'([a-z_]+) (\d+) (\d+)'", script)
        self.assertEqual(sorted(row[0] for row in rows), self.readers)
        self.assertEqual(sum(int(row[2]) for row in rows), 1000, "thousands of the long run")
        targets = re.findall(r"shutter_fuzzer\(\s*([a-z_]+)", (FUZZERS / "CMakeLists.txt").read_text())
        self.assertEqual(sorted(targets), self.readers)
        for reader in self.readers:
            seeds = list((FUZZERS / "seeds" / reader).iterdir())
            self.assertTrue(seeds, reader)
            for seed in seeds:
                self.assertLess(seed.stat().st_size, 4096, seed)

    def test_wrong_usage_is_told(self):
        for arguments in (["--nosuch"], ["nosuch"], ["--runs"]):
            told = check(*arguments)
            self.assertEqual(told.returncode, 2, told)
            self.assertIn(arguments[0], told.stderr)

    def test_without_the_compiler_nothing_is_checked(self):
        with tempfile.TemporaryDirectory() as folder:
            for tool in ("bash", "dirname"):
                os.symlink(shutil.which(tool), pathlib.Path(folder) / tool)
            told = check("--short", path=folder)
        self.assertEqual(told.returncode, NOT_CHECKED, told)
        self.assertIn("skipped: there is no clang++", told.stderr)


if __name__ == "__main__":
    unittest.main()
