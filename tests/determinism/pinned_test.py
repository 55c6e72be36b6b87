# SPDX-License-Identifier: MIT
"""Every method draws the bits that were pinned for this driver (README.md)."""

import os
import sys
import unittest

import traces

EXECUTABLE = os.environ["SHUTTER_EXECUTABLE"]
ASSETS = os.environ["SHUTTER_ASSETS"]


class Pinned(unittest.TestCase):
    def test_every_method_draws_the_pinned_bits(self):
        driver = traces.draw(EXECUTABLE, ASSETS, "sharp")["driver"]
        pinned = traces.read_pins().get(driver)
        if pinned is None:
            print(f"skipped: no pictures are pinned for the driver '{driver}'")
            os._exit(77)
        self.assertEqual(set(pinned), set(traces.list_methods(EXECUTABLE)))
        for method, expected in pinned.items():
            with self.subTest(method=method):
                found = traces.draw(EXECUTABLE, ASSETS, method)["images"]
                self.assertEqual(traces.hash_all(found), expected,
                                 "README.md explains how to find the pass that differs")


if __name__ == "__main__":
    unittest.main()
