# SPDX-License-Identifier: MIT
"""What the validation layer advises (best practices, with the checks for NVIDIA, AMD, Arm and IMG) over
pictures by every method and over the demos: nothing that explained.txt does not explain."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

EXECUTABLE = os.environ["SHUTTER_EXECUTABLE"]
ASSETS = os.environ["SHUTTER_ASSETS"]
LIST = pathlib.Path(__file__).with_name("explained.txt")
# https://vulkan.lunarg.com/doc/view/latest/linux/khronos_validation_layer.html, VK_LAYER_ENABLES
ENABLES = ":".join(f"VALIDATION_CHECK_ENABLE_VENDOR_SPECIFIC_{vendor}"
                   for vendor in ("NVIDIA", "AMD", "ARM", "IMG"))
# Newer layers name the vendor, too.
NAME = re.compile(r"\[ (?:UNASSIGNED-)?(BestPractices-)(?:AMD-|Arm-|IMG-|NVIDIA-)?([A-Za-z0-9_-]+) \]")
SAMPLES = {"accumulate": "2", "truth": "1", "denoised": "1"}


def read_list():
    """Names of messages with their reasons and links."""
    explained = {}
    for number, line in enumerate(LIST.read_text(encoding="utf-8").splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        fields = line.split(" : ")
        if len(fields) != 3 or not fields[2].startswith("https://"):
            sys.exit(f"{LIST}:{number}: expected NAME : REASON : LINK")
        explained[fields[0]] = fields[1:]
    return explained

listed = subprocess.run([EXECUTABLE, "info", "--devices"], capture_output=True, text=True)
if "llvmpipe" not in listed.stdout:
    print("skipped: llvmpipe is missing (package mesa-vulkan-drivers)")
    sys.exit(77)


class Advice(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.caches = tempfile.mkdtemp(prefix="shutter_advice_caches_")  # for all runs
        cls.addClassCleanup(shutil.rmtree, cls.caches)

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="shutter_advice_"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.environment = {"MESA_SHADER_CACHE_DIR": self.caches, **os.environ, "HOME": str(self.folder),
                            "XDG_CACHE_HOME": self.caches, "VK_LAYER_ENABLES": ENABLES}
        self.environment.pop("XDG_CONFIG_HOME", None)

    def hear(self, *arguments):
        """Names of the advice given, with one message each."""
        done = subprocess.run(
            [EXECUTABLE, *arguments, "--device", "llvmpipe", "--validate", "--advice"],
            cwd=self.folder, env=self.environment, capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, 0, done.stderr)
        heard = {}
        for message in done.stderr.split("Vulkan advice: ")[1:]:
            found = NAME.search(message)
            self.assertIsNotNone(found, message)
            heard.setdefault(found[1] + found[2], message.strip())
        return heard

    def expect_explained(self, heard):
        explained = read_list()
        for name, message in heard.items():
            with self.subTest(advice=name):
                self.assertIn(name, explained, message)

    def test_pictures_by_every_method(self):
        methods = subprocess.run([EXECUTABLE, "info", "--methods"], capture_output=True, text=True,
                                 check=True).stdout.split()
        heard = {}
        for method in methods:
            samples = ("--samples", SAMPLES[method]) if method in SAMPLES else ()
            heard |= self.hear("render", f"{ASSETS}/vase.glb", "--out", "a.png", "--size", "64x36",
                               "--method", method, *samples)
        for method in ("hybrid", "resolved"):
            heard |= self.hear("render", f"{ASSETS}/courtyard.glb", "--out", "a.png", "--size",
                               "64x36", "--method", method)
        self.expect_explained(heard)
        # All sets of checks are on.
        for mark in ("BestPractices-vk", "NVIDIA", "AMD"):
            self.assertTrue(any(mark in message for message in heard.values()), mark)

    def test_pictures_with_every_effect(self):
        self.expect_explained(self.hear(
            "render", f"{ASSETS}/vase.glb", "--out", "a.png", "--size", "64x36", "--aa", "taa",
            "--bloom", "0.3", "--shadows", "blurred", "--shadow-map-size", "64", "--sky", "3"))

    def test_the_demos(self):
        for demo in ("rally", "gallery", "spin"):
            self.expect_explained(self.hear(
                "play", demo, "--assets", ASSETS, "--no-window", "--frames", "12", "--size", "64x36"))


if __name__ == "__main__":
    unittest.main()
