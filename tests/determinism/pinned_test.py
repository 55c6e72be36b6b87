# SPDX-License-Identifier: MIT
"""The methods draw the bits that were pinned for this driver, for the reasons pinned (README.md)."""

import os
import tempfile
import unittest

import traces

EXECUTABLE = os.environ["SHUTTER_EXECUTABLE"]
GENERATOR = os.environ["SHUTTER_GENERATOR"]


class Pinned(unittest.TestCase):
    maxDiff = None

    def test_every_shot_has_the_pinned_bits_and_reasons(self):
        with tempfile.TemporaryDirectory(prefix="shutter_pin_") as assets:
            traces.generate(GENERATOR, assets)
            driver = traces.draw(EXECUTABLE, assets, "sharp")["driver"]
            pinned = traces.read_pins().get(driver)
            if pinned is None: # minutes of drawing would tell nothing
                print(f"skipped: no pictures are pinned for the driver '{driver}'")
                os._exit(77)
            found = traces.draw_all(EXECUTABLE, assets)
        if traces.DEVICE == "llvmpipe":
            with self.subTest("explanations"):
                self.assertEqual(traces.write_explanations(found["explained"]),
                                 traces.EXPLANATIONS.read_text(encoding="utf-8"))
        self.assertEqual(found["pictures"], pinned,
                         "README.md explains how to find the pass that differs")


if __name__ == "__main__":
    unittest.main()
