# SPDX-License-Identifier: MIT
"""Sessions of `shutter play` on a display of their own, with a window manager, unattended."""

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
FRAME_SECONDS = 1 / 30
# Sweeps draw the first two of their cases, which differ most, and all with this variable set.
DRAWS_ALL = "SHUTTER_ALL" in os.environ
# Tests of the blur switch off the other effects; frames of a static scene are then equal.
NO_EFFECTS = {"antiAliasing": "none", "shadows": "none", "bloomShare": 0}

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "support"))

from display import Display, skip_without_display

skip_without_display()
if not shutil.which("openbox"):
    print("skipped: openbox is missing (package openbox)")
    sys.exit(77)


class Script:
    """An input script that is written event by event; times are of frames."""

    def __init__(self):
        self.frame = 0
        self.events = []

    def add(self, **event):
        # Half a frame before its frame: no rounding puts it into the next.
        time = max(self.frame - 0.5, 0) * FRAME_SECONDS
        self.events.append({"time": time, **event})
        return self

    def wait(self, frames=1):
        self.frame += frames
        return self

    def tap(self, key):
        return self.add(key=key).wait()

    def write(self, path):
        script = {"version": 1, "frameSeconds": FRAME_SECONDS, "events": self.events}
        path.write_text(json.dumps(script), encoding="utf-8")


class PlayCase(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.caches = tempfile.mkdtemp(prefix="shutter_play_caches_")  # for all sessions of a class
        cls.addClassCleanup(shutil.rmtree, cls.caches)
        cls.display = Display("1024x768x24")
        cls.addClassCleanup(cls.display.close)
        # It minimises and restores windows; a bare display would not.
        manager = subprocess.Popen(
            ["openbox"], env={**os.environ, "DISPLAY": cls.display.name},
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        cls.addClassCleanup(manager.wait)
        cls.addClassCleanup(manager.terminate)

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="shutter_play_"))
        self.addCleanup(shutil.rmtree, self.folder)

    @staticmethod
    def sample(cases):
        return cases if DRAWS_ALL else cases[:2]

    def run_shutter(self, arguments, display=True):
        command = [EXECUTABLE, "play", *arguments, *(() if display else ("--no-window",))]
        environment = {"MESA_SHADER_CACHE_DIR": self.caches, **os.environ, "HOME": str(self.folder),
                       "XDG_CACHE_HOME": self.caches, "DISPLAY": self.display.name}
        environment.pop("XDG_CONFIG_HOME", None)
        return subprocess.run(
            command,
            cwd=self.folder,
            env=environment,
            capture_output=True,
            text=True,
            timeout=500,
        )

    def play(self, stage, script, *options, size="192x108", display=True, **settings):
        """Runs a session that must end well; returns its statistics."""
        script.write(self.folder / "script.json")
        (self.folder / "settings.json").write_text(
            json.dumps({"version": 1, "instants": 2, "rays": 1, **NO_EFFECTS, **settings}),
            encoding="utf-8",
        )
        result = self.run_shutter(
            [stage, "--size", size, "--script", "script.json", "--settings", "settings.json",
             "--assets", ASSETS, "--validate", "--stats", "stats.json", *options],
            display,
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("validation", result.stderr.lower())
        return json.loads((self.folder / "stats.json").read_text(encoding="utf-8"))
