# SPDX-License-Identifier: MIT
"""The program run with the fault layer (tests/fault_layer/README.md), in a folder of its own."""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

EXECUTABLE = os.environ["SHUTTER_EXECUTABLE"]
ASSETS = os.environ["SHUTTER_ASSETS"]
LAYER = os.environ["SHUTTER_FAULT_LAYER"]
DEVICE = "llvmpipe"
# The method with the most images and pipelines, and rays. Those of `adaptive` are of the same kinds, and
# take lavapipe three times as long to compile.
METHOD = "hybrid"

# Sweeps draw a sample unless this is set: two of what they go through, or a few of many calls.
DRAWS_ALL = "SHUTTER_ALL" in os.environ

listed = subprocess.run([EXECUTABLE, "info", "--devices"], capture_output=True, text=True)
if DEVICE not in listed.stdout:
    print(f"skipped: {DEVICE} is missing (package mesa-vulkan-drivers)")
    sys.exit(77)


def choose(count, most):
    """Numbers of calls from 1 to `count`: all, or `most` of them, the first and the last among them."""
    if DRAWS_ALL or count <= most:
        return range(1, count + 1)
    return sorted({1 + round(i * (count - 1) / (most - 1)) for i in range(most)})


def sample(cases):
    """All, or the first two, which a sweep has in front because they differ most."""
    return cases if DRAWS_ALL else cases[:2]


def faults_as_environment(faults):
    """allocation=3 becomes the variables that fail the third allocation."""
    named = {f"SHUTTER_FAULT_{name.upper()}": str(value) for name, value in faults.items()}
    return {"VK_ADD_LAYER_PATH": LAYER, "VK_INSTANCE_LAYERS": "VK_LAYER_SHUTTER_faults", **named}


class FaultCase(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # Pipelines are made once for all runs of a class.
        cls.caches = tempfile.mkdtemp(prefix="shutter_faults_cache_")
        cls.addClassCleanup(shutil.rmtree, cls.caches)

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="shutter_faults_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def environment(self, more=()):
        # Without XDG_RUNTIME_DIR, Wayland's library writes to the standard error stream.
        return {"MESA_SHADER_CACHE_DIR": self.caches, **os.environ, "XDG_CACHE_HOME": self.caches,
                "XDG_RUNTIME_DIR": str(self.folder), "HOME": str(self.folder), **dict(more)}

    def run_shutter(self, arguments, environment=(), before=(), **options):
        return subprocess.run([*before, EXECUTABLE, *arguments], cwd=self.folder, text=True,
                              env=self.environment(environment), stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, timeout=300, **options)

    def run_faulty(self, arguments, faults, **options):
        return self.run_shutter(arguments, faults_as_environment(faults), **options)

    @staticmethod
    def render(*more, method=METHOD, size="16x9"):
        return ["render", f"{ASSETS}/vase.glb", "--device", DEVICE, "--size", size,
                "--method", method, *more]

    def count_calls(self, arguments):
        """How often a good run calls what can fail."""
        counts = self.folder / "counts.json"
        result = self.run_faulty(arguments, {"counts": counts})
        self.expect_done(result)
        counted = json.loads(counts.read_text(encoding="utf-8"))
        counts.unlink()
        return counted

    def list_files(self):
        return {str(path.relative_to(self.folder)) for path in self.folder.rglob("*")}

    def expect_done(self, result):
        self.assertEqual((result.returncode, result.stderr), (0, ""))

    def expect_sentence(self, result, *mentions, status=1):
        """It failed with one line that contains all of `mentions`."""
        self.assertEqual(result.returncode, status, result.stderr)
        self.assertTrue(result.stderr.startswith("shutter: "), result.stderr)
        self.assertTrue(result.stderr.endswith("\n"), result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        for mention in mentions:
            self.assertIn(mention, result.stderr)
