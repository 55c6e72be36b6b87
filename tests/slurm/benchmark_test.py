#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A benchmark measured by a real Slurm, on a cluster of two nodes that is set up on this machine: a
part that is killed is started again and goes on. Exit status 77 where Slurm is missing."""

import json
import re

import cluster as slurm
from slurm_case import SHUTTER, SlurmCase, main

CASES = ["spin", "camera_pan", "static_post"]


class Benchmarks(SlurmCase):
    def words(self, out, *more):
        cases = [word for name in CASES for word in ("--case", name)]
        return [SHUTTER, "bench", "--suite", "hard", *cases, "--methods", "sharp,gather,accumulate",
                "--size", "96x54", "--repeats", "2", "--truth-samples", "64", "--out", out,
                "--device", "llvmpipe", *more]

    def find_measured_part(self):
        """The job of a part that runs and of which something is in a journal."""
        for row in self.queue("%i %K", "-t", "R"):
            job, _, part = row.partition(" ")
            if part.isdigit() and (self.folder / f"many/journal/{CASES[int(part)]}.json").exists():
                return job, int(part)
        return None

    def test_a_part_that_is_requeued_goes_on(self):
        process = self.start(self.words("many", "--slurm", "--wait"))
        job, part = self.wait_for_part("a part that measures", process, self.find_measured_part)
        self.cluster.run("scontrol", "requeue", job)
        slurm.wait_for("the part that was requeued",
                       lambda: any(row.startswith("PD") and row.endswith(f"_{part}")
                                   for row in self.queue("%t %F_%K")))
        journal = self.folder / f"many/journal/{CASES[part]}.json"
        kept = json.loads(journal.read_text())["records"]
        self.start_requeued()
        out, err = self.finish(process)
        self.assertRegex(out, r"^job \d+: parts 0-2\njob \d+: finishes the benchmark\n$")
        self.assertEqual(err, "")
        results = json.loads((self.folder / "many/results.json").read_text())
        self.assertTrue(results["complete"])
        self.assertEqual(sorted(c["name"] for c in results["cases"]), sorted(CASES))
        self.assertEqual(results["parallel"]["processes"], 3)
        self.assertTrue(results["parallel"]["slurm"])
        after = json.loads(journal.read_text())["records"]
        for key, record in kept.items():
            self.assertEqual(after[key]["samples"][:len(record["samples"])], record["samples"], key)
        self.assertFalse((self.folder / "many/parts").exists())

    def test_another_driver_is_refused_and_the_benchmark_says_so(self):
        words = self.words("refused", "--slurm")
        out, _ = self.finish(self.start([*words, "--sbatch", "begin=now+1hour"]))
        jobs = re.findall(r"job (\d+)", out)
        self.assertEqual(len(jobs), 2, out)
        parts = self.folder / "refused/parts"
        (parts / "device.json").write_text('{"device": "another card", "driver": "7"}')
        self.start_jobs(jobs)
        _, err = self.finish(self.start([*words, "--wait"]), status=1)
        self.assertEqual(err.count("\n"), 1, err)
        self.assertIn("the benchmark is not finished: part 0 says: the benchmark is drawn by "
                      "'another card' with driver '7', and this is 'llvmpipe", err)
        self.assertFalse((self.folder / "refused/results.json").exists())


if __name__ == "__main__":
    main()
