# SPDX-License-Identifier: MIT
"""scripts/check_fuzzers.sh knows every reader, and each has a target and seeds."""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).parents[2]
FUZZERS = ROOT / "tests/fuzz"


class CheckFuzzers(unittest.TestCase):
    def test_every_reader_has_a_row_a_target_and_seeds(self):
        readers = sorted(file.name.removesuffix("_fuzz.cpp") for file in FUZZERS.glob("*_fuzz.cpp"))
        self.assertGreater(len(readers), 5)
        rows = re.findall(r"'([a-z_]+) (\d+) (\d+)'", (ROOT / "scripts/check_fuzzers.sh").read_text())
        self.assertEqual(sorted(row[0] for row in rows), readers)
        self.assertEqual(sum(int(row[2]) for row in rows), 1000, "thousands of the long run")
        targets = re.findall(r"shutter_fuzzer\(\s*([a-z_]+)", (FUZZERS / "CMakeLists.txt").read_text())
        self.assertEqual(sorted(targets), readers)
        for reader in readers:
            self.assertTrue(list((FUZZERS / "seeds" / reader).iterdir()), reader)


if __name__ == "__main__":
    unittest.main()
