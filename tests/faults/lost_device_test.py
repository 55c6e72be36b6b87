# SPDX-License-Identifier: MIT
"""The device is lost at each submission in turn: where it is submitted, or while it runs."""

import unittest

from fault_case import ASSETS, FaultCase

KINDS = ("submission", "execution")


class LostDevice(FaultCase):
    def lose(self, arguments, numbers, kinds=KINDS):
        for kind in kinds:
            for number in numbers:
                with self.subTest(lost_at=f"{kind} {number}"):
                    result = self.run_faulty(arguments, {kind: number})
                    self.expect_sentence(result, "the device was lost")

    def test_each_submission_of_a_picture(self):
        frame = self.render("--out", "a.png", "--validate")
        count = self.count_calls(frame)["submissions"]
        # What the scene is uploaded with, the frame before and the frame.
        self.assertGreater(count, 5)
        (self.folder / "a.png").unlink()
        self.lose(frame, range(1, count + 1))
        self.assertEqual(self.list_files(), set())

    def test_a_sequence_keeps_the_frames_from_before_and_goes_on_from_them(self):
        sequence = self.render("--frames", "0:2", "--out", "f_%d.png", method="sharp")
        count = self.count_calls([*sequence, "--restart"])["submissions"]
        whole = [(self.folder / f"f_{i}.png").read_bytes() for i in range(3)]
        for path in self.folder.iterdir():
            path.unlink()
        # The last submission is the last frame's.
        self.lose(sequence, [count], kinds=["execution"])
        self.assertEqual(self.list_files(), {".f_%d.png.journal", "f_0.png", "f_1.png"})
        result = self.run_shutter(sequence)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("2 of 3 frames are complete", result.stdout)
        self.assertEqual([(self.folder / f"f_{i}.png").read_bytes() for i in range(3)], whole)

    def test_frames_on_their_way_in_play(self):
        session = ["play", "rally", "--assets", ASSETS, "--no-window", "--frames", "4",
                   "--size", "32x18"]
        count = self.count_calls(session)["submissions"]
        self.lose(session, range(count - 2, count + 1))


if __name__ == "__main__":
    unittest.main()
