# SPDX-License-Identifier: MIT
"""Windows that change and go away between any two pictures, and devices lost before one."""

import json
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "support"))

from display import Display, skip_without_display

skip_without_display()

from fault_case import ASSETS, FaultCase, sample

FRAMES = 8
NOTICES = 2  # "loading" and "compiling shaders", before the first picture
SESSION = ["play", "rally", "--assets", ASSETS, "--frames", str(FRAMES), "--size", "64x36",
           "--method", "sharp"]


class Window(FaultCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.display = Display("640x480x24")
        cls.addClassCleanup(cls.display.close)

    def play(self, faults, *more):
        return self.run_faulty([*SESSION, *more], faults,
                               before=["env", f"DISPLAY={self.display.name}"])

    def expect_presented(self, counted, lost):
        """All pictures, and the notices but for `lost`: no swapchain is recreated between notices."""
        self.assertEqual(counted["presentations"], FRAMES + NOTICES - lost)

    def test_play_goes_on_after_every_answer_of_the_window(self):
        counts = self.folder / "counts.json"
        for call in ("acquire", "present"):
            for answers in sample((
                "1=SURFACE_LOST,2=SURFACE_LOST,4=SURFACE_LOST",
                "1=OUT_OF_DATE,2=SUBOPTIMAL,3=OUT_OF_DATE,4=SURFACE_LOST,5=SUBOPTIMAL,6=SURFACE_LOST",
                "1=SUBOPTIMAL,2=SUBOPTIMAL,3=SUBOPTIMAL,4=SUBOPTIMAL",
                "1=OUT_OF_DATE,2=OUT_OF_DATE,4=OUT_OF_DATE",
            )):
                with self.subTest(call=call, answers=answers):
                    result = self.play({call: answers, "counts": counts}, "--validate")
                    self.expect_done(result)
                    counted = json.loads(counts.read_text(encoding="utf-8"))
                    # The first answer fails, or none does. A presentation that fails counts.
                    fails = not answers.startswith("1=SUBOPTIMAL")
                    self.expect_presented(counted, fails * (2 if call == "acquire" else 1))

    def test_a_frame_is_recorded_before_it_waits_for_an_image_and_a_lost_device_is_told_once(self):
        counts = self.folder / "counts.json"
        self.expect_done(self.play({"counts": counts}))
        counted = json.loads(counts.read_text(encoding="utf-8"))
        self.assertEqual(counted["acquisitions"], FRAMES + NOTICES)
        self.assertEqual(counted["lateAcquisitions"], FRAMES)
        last = counted["submissions"]
        # In the middle of the pictures: how many submissions come before the first may differ by a
        # few between runs.
        middle = last - FRAMES // 2
        for kind in ("submission", "execution"):
            with self.subTest(kind=kind):
                self.expect_sentence(self.play({kind: middle}), "the device was lost")

    def test_a_swapchain_that_cannot_be_made_is_told(self):
        # The first one, and one that is recreated for a changed window.
        for number in (1, 2):
            with self.subTest(swapchain=number):
                result = self.play({"creation": f"CreateSwapchainKHR={number}",
                                    "acquire": "2=OUT_OF_DATE"}, "--validate")
                self.assertEqual(result.returncode, 1, result.stderr)
                self.assertIn("shutter: making a swapchain failed: out of main memory\n",
                              result.stderr)
                self.assertNotIn("validation", result.stderr.lower())

    def test_a_surface_that_goes_while_its_swapchain_is_made_is_replaced(self):
        counts = self.folder / "counts.json"
        for answers in sample(("1=SURFACE_LOST,2=SURFACE_LOST", "2=SURFACE_LOST", "1=SURFACE_LOST")):
            with self.subTest(answers=answers):
                self.expect_done(self.play({"swapchain": answers, "acquire": "2=OUT_OF_DATE",
                                            "counts": counts}, "--validate"))
                counted = json.loads(counts.read_text(encoding="utf-8"))
                self.expect_presented(counted, NOTICES if answers.startswith("1=") else 1)

    def test_a_device_that_shows_no_pictures_is_told(self):
        result = self.play({"hide": "VK_KHR_swapchain"})
        self.assertEqual(result.returncode, 1)
        self.assertIn("shutter: no device can run the engine", result.stderr)
        self.assertIn("lacks VK_KHR_swapchain\n", result.stderr)


if __name__ == "__main__":
    unittest.main()
