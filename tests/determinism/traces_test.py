# SPDX-License-Identifier: MIT
"""A change in one pass is named, on any driver."""

import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import traces

EXECUTABLE = os.environ["SHUTTER_EXECUTABLE"]
ASSETS = os.environ["SHUTTER_ASSETS"]


def rows(*hashes):
    return [{"frame": 0, "pass": f"pass {i}", "image": "color", "hash": value}
            for i, value in enumerate(hashes)]


class Traces(unittest.TestCase):
    def draw(self, method, *more):
        return traces.draw(EXECUTABLE, ASSETS, method, *more)["images"]

    def test_the_first_row_that_differs_is_named(self):
        self.assertIsNone(traces.find_difference(rows("a", "b"), rows("a", "b")))
        self.assertIn("differs is 'pass 1'", traces.find_difference(rows("a", "b", "c"),
                                                                   rows("a", "x", "y")))
        self.assertIn("only one of them has the pass 'pass 1'",
                      traces.find_difference(rows("a"), rows("a", "b")))
        renamed = rows("a", "b")
        renamed[0]["pass"] = "another"
        self.assertIn("differ from 'pass 0' on", traces.find_difference(renamed, rows("a", "b")))

    def test_one_hash_tells_every_image_that_is_written_whole(self):
        self.assertEqual(traces.hash_all(rows("a", "b")), traces.hash_all(rows("a", "b")))
        self.assertNotEqual(traces.hash_all(rows("a", "b")), traces.hash_all(rows("a", "x")))
        partly = rows("a", "b")
        partly[1]["image"] = "reveal color"
        self.assertEqual(traces.hash_all(partly), traces.hash_all(rows("a")))

    def test_two_runs_write_the_same(self):
        for method in ("gather", "resolved"):
            found = self.draw(method)
            self.assertGreater(len(found), 8)
            self.assertIsNone(traces.find_difference(self.draw(method), found))

    def test_two_runs_with_every_effect_write_the_same(self):
        found = self.draw("hybrid", *traces.EFFECTS)
        names = " ".join(row["pass"] for row in found)
        for part in ("taa", "bloom", "shadow"):
            self.assertIn(part, names)
        self.assertIsNone(traces.find_difference(self.draw("hybrid", *traces.EFFECTS), found))

    def test_samples_of_a_moving_camera_are_traced_once_they_are_split(self):
        with tempfile.TemporaryDirectory(prefix="shutter_trace_") as folder:
            trace = pathlib.Path(folder) / "trace.json"
            subprocess.run(
                [EXECUTABLE, "render", f"{ASSETS}/courtyard.glb", "--camera", "pan", "--time", "0.5",
                 "--method", "resolved", "--aa", "taa", *traces.SHOT, "--hash-passes", trace,
                 "--out", f"{folder}/picture.exr"], check=True, timeout=300)
            found = json.loads(trace.read_text(encoding="utf-8"))["images"]
        self.assertIn("split edges", {row["pass"] for row in found})

    def test_tracing_does_not_change_the_picture(self):
        for method in ("hybrid", "resolved", "accumulate"):
            with tempfile.TemporaryDirectory(prefix="shutter_trace_") as folder:
                files = [pathlib.Path(folder) / name for name in ("plain.exr", "traced.exr")]
                traces.render(EXECUTABLE, ASSETS, traces.SHOTS["vase"], method, files[0])
                traces.render(EXECUTABLE, ASSETS, traces.SHOTS["vase"], method, files[1],
                              "--hash-passes", f"{folder}/trace.json")
                self.assertEqual(*(file.read_bytes() for file in files))

    def test_a_setting_of_one_pass_is_traced_to_it(self):
        before = {method: self.draw(method) for method in ("gather", "hybrid")}
        for method, setting, name in CHANGES:
            with self.subTest(setting=setting):
                difference = traces.find_difference(
                    before[method], self.draw(method, "--set", setting))
                self.assertIsNotNone(difference)
                self.assertIn(f"'{name}'", difference)


# What each setting acts on first.
CHANGES = (
    ("gather", "foregroundMagnification=30", "gather"),
    ("hybrid", "neighbourhoodTiles=1", "neighbour max"),
    ("hybrid", "jitter=0", "count"),
)


if __name__ == "__main__":
    unittest.main()
