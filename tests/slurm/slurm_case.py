# SPDX-License-Identifier: MIT
"""Tests of work that a real Slurm does, on a cluster of two nodes that is set up for each class. Exit
status 77 where a program or a device to draw on is missing."""

import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import cluster as slurm

SHUTTER = os.environ["SHUTTER_EXECUTABLE"]


class SlurmCase(unittest.TestCase):
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


def main(*programs):
    """Runs the tests. `programs`: what they need besides Slurm's."""
    lacking = slurm.find_missing() + [name for name in programs if not shutil.which(name)]
    if lacking:
        packages = ", ".join(("slurm-wlm", "munge", *programs))
        print(f"not installed: {', '.join(lacking)} (Debian: {packages})")
        sys.exit(77)
    listed = subprocess.run([SHUTTER, "info", "--devices"], capture_output=True, text=True)
    if "llvmpipe" not in listed.stdout:
        print("skipped: llvmpipe is missing (package mesa-vulkan-drivers)")
        sys.exit(77)
    unittest.main(verbosity=2)
