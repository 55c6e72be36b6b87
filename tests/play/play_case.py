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

for needed, package in (("xvfb-run", "xvfb"), ("openbox", "openbox")):
    if not shutil.which(needed):
        print(f"skipped: {needed} is missing (package {package})")
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
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="shutter_play_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def run_shutter(self, arguments, display=True):
        command = [EXECUTABLE, "play", *arguments, *(() if display else ("--no-window",))]
        if display:
            # A window manager minimises and restores; a bare display would not.
            inner = 'openbox >/dev/null 2>&1 & "$@"; status=$?; kill $! 2>/dev/null; exit $status'
            command = ["xvfb-run", "-a", "-s", "-screen 0 1024x768x24", "bash", "-c", inner, "-",
                       *command]
        environment = {**os.environ, "HOME": str(self.folder)}
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
            json.dumps({"version": 1, "instants": 2, "rays": 1, **settings}), encoding="utf-8"
        )
        result = self.run_shutter(
            [stage, "--size", size, "--script", "script.json", "--settings", "settings.json",
             "--assets", ASSETS, "--validate", "--stats", "stats.json", *options],
            display,
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("validation", result.stderr.lower())
        return json.loads((self.folder / "stats.json").read_text(encoding="utf-8"))
