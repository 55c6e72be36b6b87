# SPDX-License-Identifier: MIT
"""An ffmpeg that would go on for ever never outlives the program, however that ends."""

import os
import select
import shutil
import signal
import subprocess
import time
import unittest

from fault_case import EXECUTABLE, FaultCase

OLDER = b"the film before"
ENCODER = """#!/bin/sh
case "$1" in
-version) echo ffmpeg version 1;;
-hide_banner) echo ' V libx264 x';;
*) echo $$ > started; exec sleep 1000;;
esac
"""


def wait_until(condition, seconds):
    """Whether it came true."""
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.05)
    return condition()


def wait_for(descriptor, seconds):
    return bool(select.select([descriptor], [], [], seconds)[0])


class ChildProcess(FaultCase):
    def start_encoding(self):
        """A run that is encoding, and the process of its ffmpeg."""
        encoder = self.folder / "ffmpeg"
        encoder.write_text(ENCODER, encoding="utf-8")
        encoder.chmod(0o700)
        frames = self.folder / "film.mp4.frames"
        frames.mkdir()
        started = frames / "started"
        os.mkfifo(started)
        reader = os.open(started, os.O_RDONLY | os.O_NONBLOCK)
        self.addCleanup(os.close, reader)
        film = self.render("--frames", "0:1", "--out", "film.mp4", "--ffmpeg", str(encoder),
                           method="sharp", size="16x10")
        process = subprocess.Popen([EXECUTABLE, *film], cwd=self.folder, env=self.environment(),
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        ended = os.pidfd_open(process.pid)
        self.addCleanup(os.close, ended)
        select.select([reader, ended], [], [], 200)
        self.assertTrue(wait_for(reader, 0), "nothing was encoded")
        child = os.pidfd_open(int(os.read(reader, 100)))
        self.addCleanup(os.close, child)
        return process, child

    def test_ffmpeg_ends_where_the_program_is_killed_asked_to_end_or_interrupted(self):
        for number in (signal.SIGKILL, signal.SIGTERM, signal.SIGINT):
            with self.subTest(signal=number):
                (self.folder / "film.mp4").write_bytes(OLDER)
                process, child = self.start_encoding()
                process.send_signal(number)
                self.assertEqual(process.wait(), -number)
                ended = wait_for(child, 60)
                if not ended:
                    signal.pidfd_send_signal(child, signal.SIGKILL)
                self.assertTrue(ended, "ffmpeg goes on")
                self.assertEqual((self.folder / "film.mp4").read_bytes(), OLDER)
                shutil.rmtree(self.folder / "film.mp4.frames")

    def test_a_sequence_that_is_killed_leaves_its_pipelines(self):
        caches = self.folder / "caches"
        sequence = self.render("--frames", "0:999", "--out", "frame_%04d.png", method="gather")
        process = subprocess.Popen(
            [EXECUTABLE, *sequence], cwd=self.folder, stdout=subprocess.DEVNULL,
            env=self.environment({"XDG_CACHE_HOME": str(caches)}), stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        second = self.folder / "frame_0001.png"
        self.assertTrue(wait_until(second.exists, 200), "it draws nothing")
        process.kill()
        process.wait()
        self.assertFalse((self.folder / "frame_0999.png").exists(), "it came to its end")
        self.assertEqual(len(list(caches.glob("shutter/pipelines-*.bin"))), 1)


if __name__ == "__main__":
    unittest.main()
