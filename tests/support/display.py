# SPDX-License-Identifier: MIT
"""A display without a screen for windows of tests. xvfb-run starts one for each program and now and
then fails while it cleans up; this one serves all programs of a test's class."""

import os
import shutil
import subprocess
import sys


def skip_without_display():
    if not shutil.which("Xvfb"):
        print("skipped: Xvfb is missing (package xvfb)")
        sys.exit(77)


class Display:
    """\\param screen width, height and depth, as in "640x480x24" """

    def __init__(self, screen):
        ready, announce = os.pipe()
        # -noreset: the server stays when the last window has gone.
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(announce), "-screen", "0", screen, "-nolisten", "tcp", "-noreset"],
            pass_fds=[announce], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(announce)
        with os.fdopen(ready, encoding="ascii") as pipe:
            number = pipe.readline().strip()  # empty where the server could not start
        if not number:
            raise RuntimeError(f"Xvfb could not start: status {self.server.wait()}")
        self.name = f":{number}"

    def close(self):
        self.server.terminate()
        self.server.wait()
