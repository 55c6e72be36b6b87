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
SHUTTER = os.environ["SHUTTER_EXECUTABLE"]
ON_SOFTWARE = ["--device", "llvmpipe"]

devices = subprocess.run([SHUTTER, "info", "--devices"], capture_output=True, text=True)
if "llvmpipe" not in devices.stdout:
    print("skipped: there is no lavapipe to draw on")
    sys.exit(77)


class Measured(unittest.TestCase):
    def measure(self, *options, statuses=(0,), size="32x18"):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(
                [SHUTTER, "bench", "--out", folder, "--size", size, "--repeats", "1",
                 "--truth-samples", "2", *options, *ON_SOFTWARE], check=False)
            self.assertIn(done.returncode, statuses)
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

    def test_a_stability_case(self):
        results = self.measure("--suite", "stability", "--case", "ZeroMotion",
                               "--case", "TooManyEntities")
        self.validate(results)
        self.assertEqual([c["name"] for c in results["stability"]],
                         ["ZeroMotion", "TooManyEntities"])
        self.assertTrue(all(c["held"] for c in results["stability"]))
        self.assertEqual(results["cases"], [])

    def test_a_played_sequence(self):
        results = self.measure("--suite", "sequence", "--case", "rally-play", "--frames", "3",
                               "--methods", "sharp,gather,accumulate,truth", size="64x36")
        self.validate(results)
        [film] = results["sequences"]
        self.assertEqual([(m["method"], m["samples"]) for m in film["measurements"]],
                         [("sharp", None), ("gather", 15), ("accumulate", 8), ("truth", 4)])
        self.assertEqual(len(film["measurements"][0]["curves"]["psnr"]), 3)
        self.assertEqual(results["cases"], [])

    def test_the_claims_about_cost(self):
        # So small and once only, times say nothing: claims may break, but each is measured. Toggles
        # has a test of its own.
        names = ["Still", "MovingShare", "Reveal", "Entities", "FullScreen", "MethodsAgainstGather",
                 "RevealTraversal", "Instants", "Lit"]
        cases = [word for name in names for word in ("--case", name)]
        results = self.measure("--suite", "demand", *cases, statuses=(0, 1), size="160x90")
        self.validate(results)
        self.assertEqual([c["name"] for c in results["demand"]], names)
        claims = {c["name"]: c for c in results["demand"]}
        for claim in results["demand"]:
            self.assertNotIn("failure", claim)
            self.assertTrue(claim["checks"])
        for check in claims["Still"]["checks"]:
            if "time" not in check["check"]:
                self.assertTrue(check["held"], check)
        for check in claims["Instants"]["checks"]:
            if "time" not in check["check"]:
                self.assertTrue(check["held"], check)
        for check in claims["Lit"]["checks"]:
            self.assertTrue(check["held"], check)
        shares = [[p["x"] for p in curve["points"]] for curve in claims["MovingShare"]["curves"]]
        self.assertEqual(len(shares), 6)
        self.assertEqual([shares[0][0], shares[0][-1]], [0, 100])
        self.assertEqual(shares[0], sorted(shares[0]))
        masked = [p["x"] for p in claims["Reveal"]["curves"][0]["points"]]
        self.assertEqual(masked, sorted(set(masked)))
        self.assertGreaterEqual(len(masked), 5)
        self.assertEqual([p["x"] for p in claims["Entities"]["curves"][0]["points"]],
                         [11, 100, 1000, 10000])


if __name__ == "__main__":
    unittest.main()
