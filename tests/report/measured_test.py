# SPDX-License-Identifier: MIT
"""What the program itself measures, against the schema that its page is made for."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

try:
    import jsonschema
except ImportError:
    print("skipped: the package python3-jsonschema is missing")
    sys.exit(77)

SCHEMA = pathlib.Path(__file__).parents[2] / "game/bench/results.schema.json"
ROOMS = pathlib.Path(__file__).parents[3] / "shared/scenes"
SHUTTER = os.environ["SHUTTER_EXECUTABLE"]
ON_SOFTWARE = ["--device", "llvmpipe"]

devices = subprocess.run([SHUTTER, "info", "--devices"], capture_output=True, text=True)
if "llvmpipe" not in devices.stdout:
    print("skipped: there is no lavapipe to draw on")
    sys.exit(77)


class Measured(unittest.TestCase):
    def measure(self, *options, size="32x18", truth_samples=2):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(
                [SHUTTER, "bench", "--out", folder, "--size", size, "--repeats", "1",
                 "--truth-samples", str(truth_samples), *options, *ON_SOFTWARE], check=False)
            self.assertEqual(done.returncode, 0)
            return json.loads((pathlib.Path(folder) / "results.json").read_text(encoding="utf-8"))

    def validate(self, results):
        schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
        jsonschema.Draft202012Validator(schema).validate(results)
        self.assertTrue(results["complete"])

    def test_the_paper_suite(self):
        results = self.measure("--suite", "paper", "--methods", "sharp,gather,hybrid,hybrid_paper,resolved,truth")
        self.validate(results)
        case = results["cases"][0]
        counts = {m["method"]: [] for m in case["measurements"]}
        for m in case["measurements"]:
            counts[m["method"]].append(m["samples"])
        self.assertEqual(counts["sharp"], [None])
        self.assertEqual(counts["hybrid"], [4, 8, 15, 16, 32, 64])
        self.assertEqual(counts["truth"], [1 << i for i in range(9)])
        self.assertEqual(results["equalTime"][0]["reference"]["method"], "resolved")
        self.assertEqual(results["headline"], {"method": "resolved", "baseline": "gather"})
        # The publication's numbers give another picture than the defaults.
        psnr = {m["method"]: m["metrics"]["psnr"] for m in case["measurements"] if m["isDefault"]}
        self.assertNotEqual(psnr["hybrid_paper"], psnr["hybrid"])

    def test_a_hard_case(self):
        results = self.measure("--suite", "hard", "--case", "spin", "--methods", "sharp,denoised")
        self.validate(results)
        self.assertEqual([c["name"] for c in results["cases"]], ["spin"])
        self.assertEqual(results["equalTime"], [])

    def test_edges_against_the_mean_over_the_pixel(self):
        results = self.measure("--suite", "edges", "--case", "courtyard",
                               "--methods", "sharp,resolved,accumulate", size="64x36", truth_samples=32)
        self.validate(results)
        self.assertEqual(results["settings"]["pixel"], "box")
        none, taa, box = results["cases"]
        self.assertEqual([(c["name"], c["antiAliasing"]) for c in results["cases"]],
                         [("courtyard", "none"), ("courtyard-taa", "taa"), ("courtyard-box", "box")])
        self.assertEqual(len({c["truth"]["hash"] for c in results["cases"]}), 1)
        self.assertIn("accumulate", {m["method"] for m in none["measurements"]})
        for case in (taa, box):
            self.assertEqual([m["method"] for m in case["measurements"]], ["sharp", "resolved"])
        # Smooth edges come closer to it.
        for metric in ("psnr", "linearPsnr"):
            reached = [next(m["metrics"][metric] for m in case["measurements"]
                            if m["method"] == "resolved" and m["isDefault"])
                       for case in (none, taa, box)]
            self.assertEqual(reached, sorted(reached), metric)

    def test_what_a_lens_sees(self):
        if not (ROOMS / "pink-room").exists():
            self.skipTest("the rooms are outside of the repository")
        methods = ["sharp", "near_far_lens", "hybrid_lens", "lens_then_blur", "blur_then_lens"]
        results = self.measure("--suite", "lens", "--case", "joint", "--rooms", str(ROOMS), "--aa", "box",
                               "--methods", ",".join(["gather", *methods]), size="64x36", truth_samples=32)
        self.validate(results)
        self.assertEqual(results["settings"]["pixel"], "box")
        for case in results["cases"]:
            reached = {m["method"]: m["metrics"]["linearPsnr"] for m in case["measurements"] if m["isDefault"]}
            self.assertEqual(list(reached), methods)
            # Most of the blur is the ball's motion.
            for both in ("lens_then_blur", "blur_then_lens"):
                self.assertGreater(reached[both], reached["near_far_lens"] + 3)
            self.assertGreater(reached["near_far_lens"], reached["sharp"])
            self.assertGreater(reached["hybrid_lens"], reached["sharp"])
            self.assertEqual({s["method"] for s in case["skipped"]}, {"gather"})
            self.assertIn("pinhole", case["skipped"][0]["reason"])

    def test_a_film_against_the_mean_over_the_pixel(self):
        results = self.measure("--suite", "sequence", "--case", "spin-play", "--frames", "2",
                               "--pixel", "box", "--aa", "taa", "--methods", "sharp,accumulate", size="64x36")
        self.validate(results)
        [film] = results["sequences"]
        self.assertEqual((film["name"], film["antiAliasing"]), ("spin-play-taa", "taa"))
        self.assertIsNone(film["truth"]["maxStepPx"])
        self.assertEqual([m["method"] for m in film["measurements"]], ["sharp"])
        self.assertGreater(film["measurements"][0]["metrics"]["flicker"], 0)

    def test_a_played_sequence(self):
        results = self.measure("--suite", "sequence", "--case", "rally-play", "--frames", "3",
                               "--methods", "sharp,gather,accumulate,truth", size="64x36")
        self.validate(results)
        [film] = results["sequences"]
        self.assertEqual([(m["method"], m["samples"]) for m in film["measurements"]],
                         [("sharp", None), ("gather", 15), ("accumulate", 8), ("truth", 4)])
        self.assertEqual(len(film["measurements"][0]["curves"]["psnr"]), 3)
        self.assertEqual(results["cases"], [])


if __name__ == "__main__":
    unittest.main()
