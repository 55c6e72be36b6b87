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
    @classmethod
    def setUpClass(cls):
        cls.schema = jsonschema.Draft202012Validator(json.loads(SCHEMA.read_text(encoding="utf-8")))

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def measure(self, *options, size="32x18", truth_samples=2, repeats=1):
        """Complete results that follow their schema; lines of progress alone were printed."""
        done = subprocess.run(
            [SHUTTER, "bench", "--out", self.folder, "--size", size, "--repeats", str(repeats),
             "--truth-samples", str(truth_samples), *options, *ON_SOFTWARE], check=False,
            stderr=subprocess.PIPE, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.progress = done.stderr.splitlines()
        for line in self.progress:
            self.assertRegex(line, "^shutter: measuring .* % done$")
        results = json.loads((self.folder / "results.json").read_text(encoding="utf-8"))
        self.schema.validate(results)
        self.assertTrue(results["complete"])
        self.assertIn("</html>", (self.folder / "index.html").read_text(encoding="utf-8"))
        return results

    def test_the_paper_suite(self):
        methods = ["sharp", "gather", "hybrid", "hybrid_paper", "resolved", "truth"]
        results = self.measure("--suite", "paper", "--methods", ",".join(methods), "--validate", repeats=2)
        # One line per method, whatever its sample counts.
        self.assertEqual([line.split("; ")[0] for line in self.progress],
                         ["shutter: measuring vase: the truth",
                          *(f"shutter: measuring vase: {method}, method {i} of {len(methods)}"
                            for i, method in enumerate(methods, 1)),
                          "shutter: measuring vase: times"])
        case = results["cases"][0]
        counts = {m["method"]: [] for m in case["measurements"]}
        for m in case["measurements"]:
            counts[m["method"]].append(m["samples"])
            self.assertGreater(m["milliseconds"]["frame"]["median"], 0)
            # The page holds the pictures of defaults alone.
            self.assertEqual("image" in m, m["isDefault"])
            for field in ("image", "errorMap"):
                self.assertTrue(field not in m or (self.folder / m[field]).is_file())
            if m["method"] in ("sharp", "gather", "hybrid"):
                self.assertEqual(m["repeats"], 2)
                self.assertGreater(m["metrics"]["psnr"], 15)
        self.assertEqual(counts["sharp"], [None])
        for method in ("gather", "hybrid"):
            self.assertEqual(counts[method], [4, 8, 15, 16, 32, 64])
        self.assertEqual(counts["truth"], [1 << i for i in range(9)])
        self.assertEqual(results["equalTime"][0]["reference"]["method"], "resolved")
        self.assertEqual(results["headline"], {"method": "resolved", "baseline": "gather"})
        # The publication's numbers give another picture than the defaults.
        psnr = {m["method"]: m["metrics"]["psnr"] for m in case["measurements"] if m["isDefault"]}
        self.assertNotEqual(psnr["hybrid_paper"], psnr["hybrid"])

    def test_a_limit_skips_other_sample_counts_than_defaults(self):
        results = self.measure("--suite", "paper", "--methods", "gather,resolved", "--limit", "1e-6")
        [case] = results["cases"]
        self.assertEqual({m["method"] for m in case["measurements"] if m["isDefault"]},
                         {"gather", "resolved"})
        skipped = {(s["method"], s["samples"]) for s in case["skipped"]}
        self.assertIn(("gather", 64), skipped)
        self.assertIn("above the limit", case["skipped"][0]["reason"])

    def test_a_hard_case(self):
        results = self.measure("--suite", "hard", "--case", "spin", "--methods", "sharp,denoised")
        self.assertEqual([c["name"] for c in results["cases"]], ["spin"])
        self.assertEqual(results["equalTime"], [])

    def test_edges_against_the_mean_over_the_pixel(self):
        results = self.measure("--suite", "edges", "--case", "courtyard",
                               "--methods", "sharp,resolved,accumulate", size="64x36", truth_samples=32)
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
        [film] = results["sequences"]
        self.assertEqual((film["name"], film["antiAliasing"]), ("spin-play-taa", "taa"))
        self.assertIsNone(film["truth"]["maxStepPx"])
        self.assertEqual([m["method"] for m in film["measurements"]], ["sharp"])
        self.assertGreater(film["measurements"][0]["metrics"]["flicker"], 0)

    def test_flights_and_demos_are_judged_over_time(self):
        results = self.measure(
            "--suite", "sequence", "--case", "courtyard-flight", "--case", "spin-play", "--frames", "4",
            "--methods", "sharp,resolved,accumulate,truth", "--validate", size="64x36", truth_samples=4)
        self.assertEqual(self.progress[0],
                         "shutter: measuring courtyard-flight: frame 1 of 4; 0 % done")
        self.assertEqual(results["options"][2], "--case courtyard-flight")
        self.assertEqual(results["settings"]["truthSamples"], 4)
        self.assertEqual(results["cases"], [])
        self.assertEqual(len(results["sequences"]), 2)
        for film in results["sequences"]:
            self.assertEqual(film["frames"], 4)
            self.assertEqual([(m["method"], m["samples"]) for m in film["measurements"]],
                             [("sharp", None), ("resolved", 15), ("accumulate", 8), ("truth", 4)])
            for m in film["measurements"]:
                self.assertGreater(m["milliseconds"]["frame"]["median"], 0)
                self.assertGreater(m["metrics"]["psnr"], 15)
                for metric in ("flicker", "hdrFlip"):
                    self.assertGreater(m["metrics"][metric], 0)
                self.assertIsNotNone(m["metrics"]["standingFlicker"])
                self.assertEqual(len(m["curves"]["psnr"]), 4)
                self.assertIsNone(m["curves"]["flicker"][0], "there is no frame before the first")
                self.assertGreater(m["curves"]["flicker"][3], 0)
                self.assertTrue("film" not in m or (self.folder / m["film"]).is_file())
            self.assertEqual([len(error["rows"]) for error in film["equalError"]], [4, 4])
        # Frames go with their film.
        self.assertFalse((self.folder / "frames/courtyard-flight").exists())


if __name__ == "__main__":
    unittest.main()
