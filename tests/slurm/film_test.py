#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Films drawn by a real Slurm, on a cluster of two nodes that is set up on this machine: a node that
dies in the middle changes no bit, and what fails is told. Exit status 77 where Slurm is missing."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import cluster as slurm

SHUTTER = os.environ["SHUTTER_EXECUTABLE"]
SCENE = os.environ["SHUTTER_ASSETS"] + "/vase.glb"
FRAMES = 16
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

    def words(self, command, out, *more):
        return [SHUTTER, command, SCENE, "--device", "llvmpipe", "--size", "96x54", "--method",
                "accumulate", "--samples", "48", "--frames", f"0:{FRAMES - 1}", "--out", out, *more]

    def film(self, out, *more, method=None):
        words = self.words("film", out, "--parts", str(PARTS), "--slurm", *more)
        if method:
            words[words.index("accumulate")] = method
        return words

    def start(self, words):
        environment = dict(self.cluster.environment, XDG_CACHE_HOME=str(self.folder))
        return subprocess.Popen(words, cwd=self.folder, env=environment, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def finish(self, process, status=0):
        out, err = process.communicate(timeout=300)
        self.assertEqual(process.returncode, status, out + err)
        return out, err

    def queue(self, form, *more):
        listed = self.cluster.run("squeue", "-h", "-r", "-o", form, *more).stdout
        return listed.splitlines()

    def find_running_part(self, node, work):
        """A part that the node draws and of which a frame is complete."""
        for row in self.queue("%K %N", "-t", "R"):
            part, _, where = row.partition(" ")
            journal = work / f".frame_%06d.png.journal.part_{part}"
            if where == node and part.isdigit() and slurm.read_bytes(journal).count(b"\n") > 1:
                return int(part)
        return None

    def start_requeued(self):
        """Slurm lets a job that lost its node wait for two minutes; this one need not."""
        for job in self.queue("%i", "-t", "PD"):
            if "_" in job:
                self.cluster.run("scontrol", "update", f"jobid={job}", "StartTime=now", check=False)

    def test_a_node_that_dies_changes_no_bit(self):
        self.finish(self.start(self.words("render", "one.mp4", "--keep-frames")))
        process = self.start(self.film("parts.mp4", "--keep-frames", "--wait"))
        work = self.folder / "parts.mp4.frames"
        drawn = []

        def is_caught():
            self.assertIsNone(process.poll(), "the film was finished before a node could die")
            part = self.find_running_part("node2", work)
            if part is not None:
                drawn.append(part)
            return part is not None
        slurm.wait_for("a part on node2", is_caught)
        self.cluster.kill_node("node2")
        # Where it stopped: what is complete is not drawn again.
        kept = {path: path.stat().st_mtime_ns for path in work.glob("frame_*.png")}
        try:
            slurm.wait_for("the part that lost its node",
                           lambda: any(row.startswith("PD BeginTime")
                                       for row in self.queue("%t %r")))
            self.start_requeued()
            out, err = self.finish(process)
        finally:
            self.cluster.start_node("node2")
        self.assertRegex(out, rf"^job \d+: parts 0-{PARTS - 1}\njob \d+: finishes the film\n$")
        self.assertEqual(err, "")
        self.assertEqual((self.folder / "parts.mp4").read_bytes(),
                         (self.folder / "one.mp4").read_bytes())
        self.assertEqual(read_folder(work), read_folder(self.folder / "one.mp4.frames"))
        self.assertEqual(len(read_folder(work)), FRAMES)
        self.assertFalse((work / "plan.json").exists())
        again = [path for path, time in kept.items() if path.stat().st_mtime_ns != time]
        # The frame that was being recorded when the node died may be drawn twice.
        self.assertLessEqual(len(again), 1, again)

    def test_another_driver_is_refused_and_the_film_says_so(self):
        film = self.film("refused.mp4", method="sharp")
        out, _ = self.finish(self.start([*film, "--sbatch", "begin=now+1hour"]))
        jobs = re.findall(r"job (\d+)", out)
        self.assertEqual(len(jobs), 2, out)
        # The same film is not submitted twice.
        out, _ = self.finish(self.start(film))
        self.assertEqual(out, f"the jobs {jobs[0]} {jobs[1]} draw this film already\n")
        self.assertEqual({row.split("_")[0] for row in self.queue("%i")}, set(jobs))
        work = self.folder / "refused.mp4.frames"
        (work / "device.json").write_text('{"device": "another card", "driver": "7"}')
        for job in jobs:
            self.cluster.run("scontrol", "update", f"jobid={job}", "StartTime=now")
        _, err = self.finish(self.start([*film, "--wait"]), status=1)
        self.assertEqual(err.count("\n"), 1, err)
        self.assertIn("the film is not finished: part 0 says: the film is drawn by 'another card' "
                      "with driver '7', and this is 'llvmpipe", err)
        self.assertFalse((self.folder / "refused.mp4").exists())
        # What is left can be drawn once that is set right, by whatever draws it.
        (work / "device.json").unlink()
        self.finish(self.start([*film, "--wait"]))
        self.assertTrue((self.folder / "refused.mp4").exists())
        self.assertFalse(work.exists())

    def test_what_sbatch_refuses_is_told_and_nothing_is_submitted(self):
        film = self.film("none.mp4", "--estimate", "off", "--sbatch", "partition=nowhere")
        _, err = self.finish(self.start(film), status=1)
        self.assertIn("sbatch", err)
        self.assertIn("Invalid partition name specified", err)
        self.assertEqual(err.count("\n"), 1, err)
        self.assertEqual(self.queue("%j", "--name=none.mp4"), [])


def has_device():
    listed = subprocess.run([SHUTTER, "info", "--devices"], capture_output=True, text=True)
    return "llvmpipe" in listed.stdout


if __name__ == "__main__":
    lacking = slurm.find_missing()
    lacking += [] if shutil.which("ffmpeg") else ["ffmpeg"]
    if lacking:
        print(f"not installed: {', '.join(lacking)} (Debian: slurm-wlm, munge, ffmpeg)")
        sys.exit(77)
    if not has_device():
        print("skipped: llvmpipe is missing (package mesa-vulkan-drivers)")
        sys.exit(77)
    unittest.main(verbosity=2)
