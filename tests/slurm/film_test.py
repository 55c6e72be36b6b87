#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Films drawn by a real Slurm, on a cluster of two nodes that is set up on this machine: a node that
dies in the middle changes no bit, and failures are reported. Exit status 77 where a program or a device to
draw on is missing."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import cluster as slurm

SHUTTER = os.environ["SHUTTER_EXECUTABLE"]
# Another film than the default, which is as long as a test may take.
SCENE = os.environ.get("SHUTTER_FILM_SCENE", os.environ["SHUTTER_ASSETS"] + "/vase.glb")
METHOD = os.environ.get("SHUTTER_FILM_METHOD", "accumulate")
FRAMES = int(os.environ.get("SHUTTER_FILM_FRAMES", "16"))
PARTS = 4


def read_folder(folder):
    return {path.name: path.read_bytes() for path in sorted(folder.glob("frame_*.png"))}


class Films(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="shutter_slurm_"))
        cls.cluster = slurm.Cluster(cls.folder / "cluster")
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        cls.addClassCleanup(cls.cluster.stop)
        cls.cluster.start()

    def start(self, words):
        environment = dict(self.cluster.environment, XDG_CACHE_HOME=str(self.folder))
        return subprocess.Popen(words, cwd=self.folder, env=environment, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def finish(self, process, status=0):
        out, err = process.communicate(timeout=300)
        self.assertEqual(process.returncode, status, out + err)
        return out, err

    def queue(self, form, *more):
        return self.cluster.run("squeue", "-h", "-r", "-o", form, *more).stdout.splitlines()

    def wait_for_part(self, what, process, find):
        """What find() answers of a part, as soon as it is not None. The process must not end before."""
        found = []

        def is_caught():
            self.assertIsNone(process.poll(), f"all was finished before there was {what}")
            part = find()
            if part is not None:
                found.append(part)
            return part is not None
        slurm.wait_for(what, is_caught)
        return found[0]

    def start_jobs(self, jobs, check=True):
        for job in jobs:
            self.cluster.run("scontrol", "update", f"jobid={job}", "StartTime=now", check=check)

    def start_requeued(self):
        """Slurm makes a job that was requeued wait for two minutes; this one need not."""
        self.start_jobs([job for job in self.queue("%i", "-t", "PD") if "_" in job], check=False)

    def words(self, command, out, *more):
        return [SHUTTER, command, SCENE, "--device", "llvmpipe", "--size", "96x54", "--method",
                METHOD, "--samples", "48", "--frames", f"0:{FRAMES - 1}", "--out", out, *more]

    def film(self, out, *more, method=None):
        words = self.words("film", out, "--parts", str(PARTS), "--slurm", *more)
        if method:
            words[words.index(METHOD)] = method
        return words

    def find_running_part(self, node, work):
        """A part that the node draws and of which a frame is complete."""
        for row in self.queue("%K %N", "-t", "R"):
            part, _, where = row.partition(" ")
            journal = work / f".frame_%06d.png.journal.part_{part}"
            if where == node and part.isdigit() and slurm.read_bytes(journal).count(b"\n") > 1:
                return int(part)
        return None

    def test_a_node_that_dies_changes_no_bit(self):
        self.finish(self.start(self.words("render", "one.mp4", "--keep-frames")))
        process = self.start(self.film("parts.mp4", "--keep-frames", "--wait"))
        work = self.folder / "parts.mp4.frames"
        self.wait_for_part("a part on node2", process,
                           lambda: self.find_running_part("node2", work))
        self.cluster.kill_node("node2")
        # Resumes: complete frames are not drawn again.
        kept = {path: path.stat().st_mtime_ns for path in work.glob("frame_*.png")}
        try:
            slurm.wait_for("the part that lost its node",
                           lambda: any(row.startswith("PD BeginTime")
                                       for row in self.queue("%t %r")))
            self.start_requeued()
            out, err = self.finish(process)
        finally:
            self.cluster.start_node("node2")
        self.assertRegex(out, rf"^job \d+: parts 1-{PARTS}\njob \d+: finishes the film\n$")
        self.assertEqual(err, "")
        self.assertEqual((self.folder / "parts.mp4").read_bytes(),
                         (self.folder / "one.mp4").read_bytes())
        self.assertEqual(read_folder(work), read_folder(self.folder / "one.mp4.frames"))
        self.assertEqual(len(read_folder(work)), FRAMES)
        self.assertFalse((self.folder / "parts.mp4.parts").exists())
        again = [path for path, time in kept.items() if path.stat().st_mtime_ns != time]
        # The frame that was being recorded when the node died may be drawn twice.
        self.assertLessEqual(len(again), 1, again)

    def test_a_part_that_fails_ends_the_film_and_says_why(self):
        film = self.film("refused.mp4", method="sharp")
        out, _ = self.finish(self.start([*film, "--sbatch", "begin=now+1hour"]))
        jobs = re.findall(r"job (\d+)", out)
        self.assertEqual(len(jobs), 2, out)
        # The same film is not submitted twice.
        out, _ = self.finish(self.start(film))
        self.assertEqual(out, f"the jobs {jobs[0]} {jobs[1]} draw this film already\n")
        self.assertEqual({row.split("_")[0] for row in self.queue("%i")}, set(jobs))
        # As if another driver had drawn a part before.
        frames = self.folder / "refused.mp4.frames"
        frames.mkdir()
        other = frames / ".frame_%06d.png.journal.part_9"
        other.write_text('{"fingerprint": "another card", "journal": "shutter frames 1"}\n')
        self.start_jobs(jobs)
        _, err = self.finish(self.start([*film, "--wait"]), status=1)
        self.assertEqual(err.count("\n"), 1, err)
        self.assertRegex(err, "the film is not finished: part [1-4] reports: .* were drawn otherwise")
        self.assertFalse((self.folder / "refused.mp4").exists())
        # The remaining frames can be drawn by any process once that is fixed.
        other.unlink()
        self.finish(self.start([*film, "--wait"]))
        self.assertTrue((self.folder / "refused.mp4").exists())
        self.assertFalse(frames.exists())

    def test_what_sbatch_refuses_is_told_and_nothing_is_submitted(self):
        film = self.film("none.mp4", "--sbatch", "partition=nowhere")
        _, err = self.finish(self.start(film), status=1)
        self.assertIn("sbatch", err)
        self.assertIn("Invalid partition name specified", err)
        self.assertEqual(err.count("\n"), 1, err)
        self.assertEqual(self.queue("%j", "--name=none.mp4"), [])


if __name__ == "__main__":
    lacking = slurm.find_missing() + ([] if shutil.which("ffmpeg") else ["ffmpeg"])
    if lacking:
        print(f"not installed: {', '.join(lacking)} (Debian: slurm-wlm, munge, ffmpeg)")
        sys.exit(77)
    listed = subprocess.run([SHUTTER, "info", "--devices"], capture_output=True, text=True)
    if "llvmpipe" not in listed.stdout:
        print("skipped: llvmpipe is missing (package mesa-vulkan-drivers)")
        sys.exit(77)
    unittest.main(verbosity=2)
