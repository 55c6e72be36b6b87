# SPDX-License-Identifier: MIT
"""scripts/gpu_report.sh writes one file with every figure, and names what it could not measure."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).parents[2]
EXECUTABLE = os.environ["SHUTTER_EXECUTABLE"]
ASSETS = os.environ["SHUTTER_ASSETS"]
NUMBER = r"\d+\.\d+"

if not shutil.which("oiiotool"):
    print("skipped: oiiotool is missing (package openimageio-tools)")
    sys.exit(77)
listed = subprocess.run([EXECUTABLE, "info", "--devices"], capture_output=True, text=True)
if "llvmpipe" not in listed.stdout:
    print("skipped: llvmpipe is missing (package mesa-vulkan-drivers)")
    sys.exit(77)


class GpuReport(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        self.report = self.folder / "report.md"

    def run_script(self, *arguments, program=EXECUTABLE):
        return subprocess.run(
            ["bash", ROOT / "scripts/gpu_report.sh", "--out", self.report, "--program", program,
             "--scenes", ASSETS, *arguments],
            cwd=self.folder, capture_output=True, text=True, check=False)

    def read(self):
        return self.report.read_text(encoding="utf-8")

    def expect_row(self, part, name, cell=NUMBER):
        self.assertRegex(part, rf"(?m)^\| \**{re.escape(name)}\** \|[^|]*(\| \**{cell}\** ){{3}}\|$")

    def test_the_report_holds_every_figure(self):
        result = self.run_script("--short", "--device", "llvmpipe")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        report = self.read()
        self.assertIn("llvmpipe", report)
        self.assertNotIn("Not at", report)
        parts = dict(zip(*[iter(re.split(r"(?m)^## (.*)$", report)[1:])] * 2))
        for shot in ("vase", "courtyard", "pan"):
            for method in ("gather", "hybrid", "resolved"):
                self.assertRegex(parts["Sums"], rf"(?m)^\| {shot} \| {method}( \| {NUMBER}){{3}} \|$")
        passes = {"gather": "gather", "hybrid": "ray reveal", "resolved": "resolve"}
        for method, own in passes.items():
            with self.subTest(method=method):
                part = parts[method]
                self.expect_row(part, own)
                self.expect_row(part, "effect")
                self.expect_row(part, "transient images, MiB")
                self.expect_row(part, "longest / mean blur, px", rf"{NUMBER} / {NUMBER}")
        self.expect_row(parts["hybrid"], "masked pixels, %")
        self.assertIn("No message", parts["Validation"])
        same = parts["Pictures against those of llvmpipe"]
        self.assertEqual(same.count("PSNR inf dB"), 3, same)

    def test_what_fails_is_said_and_the_rest_is_written(self):
        program = self.folder / "shutter"
        program.write_text("#!/bin/sh\necho 'no such device'\nexit 1\n", encoding="utf-8")
        program.chmod(0o755)
        self.assertEqual(self.run_script("--short", program=program).returncode, 0)
        self.assertRegex(self.read(), "Not at 160x90: .*no such device")
        self.assertIn("Left out: llvmpipe is not installed", self.read())

    def test_a_wrong_command_line_writes_nothing(self):
        for arguments in (["--size", "1"], ["--out"], ["--program", "nowhere"]):
            with self.subTest(arguments=arguments):
                self.assertNotEqual(self.run_script(*arguments).returncode, 0)
                self.assertFalse(self.report.exists())


if __name__ == "__main__":
    unittest.main()
