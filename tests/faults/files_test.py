# SPDX-License-Identifier: MIT
"""Full and read-only disks, and death in the middle of a write: files are whole or not there."""

import shutil
import signal
import subprocess
import unittest

from fault_case import ASSETS, DRAWS_ALL, EXECUTABLE, FaultCase, sample

OLDER = b"what was here before"
# Runs a command in a folder that is a disk of its own, and lists what it left there.
ON_SMALL_DISK = ("mount -t tmpfs -o size=$0 none . && cd . && "
                 '{ "$@"; status=$?; find . -type f; exit $status; }')


def ignore_large_files():
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)


class Files(FaultCase):
    # Whatever runs with a limit to the size of files has run without one before: Mesa has then kept
    # its shaders, and its own files are not the ones that are too large.

    def setUp(self):
        super().setUp()
        self.outputs = ["--out", "a.png", "--stats", "s.json", "--aov", "motion"]
        self.names = {"a.png", "a.motion.exr", "s.json"}

    def write_older(self):
        for name in self.names:
            (self.folder / name).write_bytes(OLDER)

    def draw_good(self, frame):
        """The bytes of its files; of statistics, which contain times, none."""
        last = self.count_calls(frame)["submissions"]
        good = {name: (self.folder / name).read_bytes() for name in self.names - {"s.json"}}
        return last, good

    def expect_whole(self, good):
        for name in self.names:
            held = (self.folder / name).read_bytes()
            if name in good:
                self.assertIn(held, (OLDER, good[name]), name)
            else:
                self.assertTrue(held == OLDER or held.endswith(b"}\n"), name)

    def sizes(self, good):
        """Limits at which each file in turn is the first that is too large, and one in its middle."""
        lengths = {len(content) for content in good.values()}
        return sorted({0} | {length - 1 for length in lengths} | (lengths | {1} if DRAWS_ALL else set()))

    def test_a_full_disk_and_death_in_the_middle_of_a_write_leave_whole_files(self):
        frame = self.render(*self.outputs, method="sharp")
        last, good = self.draw_good(frame)
        for size in self.sizes(good):
            faults = {"files": f"{last}={size}"}
            with self.subTest(bytes=size, disk="full"):
                self.write_older()
                result = self.run_faulty(frame, faults, restore_signals=False,
                                         preexec_fn=ignore_large_files)
                self.expect_sentence(result, "cannot write", "File too large")
                self.assertEqual(self.list_files(), self.names)
                self.expect_whole(good)
            with self.subTest(bytes=size, disk="whole"):
                self.write_older()
                result = self.run_faulty(frame, faults)
                self.assertEqual(result.returncode, -signal.SIGXFSZ, result.stderr)
                self.expect_whole(good)
                for extra in self.list_files() - self.names:
                    self.assertTrue(extra.startswith(".shutter-"), extra)
                    (self.folder / extra).unlink()

    def test_a_sequence_killed_in_its_journal_goes_on_to_the_same_frames(self):
        sequence = self.render("--frames", "0:1", "--out", "f_%d.png", method="sharp")
        last = self.count_calls(sequence)["submissions"]
        frames = [self.folder / f"f_{i}.png" for i in range(2)]
        whole = [frame.read_bytes() for frame in frames]
        journal = self.folder / ".f_%d.png.journal"
        length = journal.stat().st_size
        for size in (length - 1, length - 60):
            for frame in frames:
                frame.unlink(missing_ok=True)
            journal.unlink(missing_ok=True)
            with self.subTest(bytes=size):
                killed = self.run_faulty(sequence, {"files": f"{last}={size}"})
                self.assertEqual(killed.returncode, -signal.SIGXFSZ, killed.stderr)
                self.assertEqual(self.run_shutter(sequence).returncode, 0)
                self.assertEqual([frame.read_bytes() for frame in frames], whole)

    def test_a_disk_that_is_really_full(self):
        on_disk = ["unshare", "--map-root-user", "--mount", "sh", "-c", ON_SMALL_DISK]
        if not shutil.which("unshare") or subprocess.run([*on_disk, "16k", "true"], cwd=self.folder,
                                                         capture_output=True).returncode != 0:
            self.skipTest("this user may not mount a small disk")
        large = self.render("--out", "a.exr", size="64x36", method="sharp")
        result = self.run_shutter(large, before=[*on_disk, "8k"])
        self.expect_sentence(result, "cannot write 'a.exr'", "No space left on device")
        self.assertEqual(result.stdout, "")
        # Kept pipelines are a convenience: without room for them all else is well.
        result = self.run_shutter(self.render("--out", "a.png", method="sharp"),
                                  {"XDG_CACHE_HOME": "."}, before=[*on_disk, "4k"])
        self.expect_done(result)
        self.assertEqual(result.stdout, "./a.png\n")

    def test_a_file_that_cannot_be_written_is_named_and_a_cache_is_done_without(self):
        (self.folder / "cache").write_bytes(b"a file")
        self.expect_done(self.run_shutter(self.render("--out", "a.png", method="sharp"),
                                          {"XDG_CACHE_HOME": str(self.folder / "cache")}))
        # /proc takes no files, not even from root.
        for outputs, *mentions in ((["--out", "/proc/a.png"], "cannot write '/proc/a.png'"),
                                   (["--out", "a.png", "--stats", "/proc/s.json"], "/proc/s.json"),
                                   (["--out", "a.png", "--stats", "/dev/full"], "/dev/full",
                                    "No space left on device")):
            with self.subTest(outputs=outputs):
                result = self.run_shutter(self.render(*outputs, method="sharp"))
                self.expect_sentence(result, *mentions)

    def test_what_is_printed_and_lost_is_told(self):
        self.expect_done(self.run_shutter(self.render("--out", "a.png", method="sharp")))
        for command in sample((self.render("--out", "b.png", "--explain", method="sharp"), ["--help"],
                               ["info", "--methods"], ["info", "--devices"],
                               ["info", f"{ASSETS}/vase.glb"], ["compare", "a.png", "a.png"],
                               self.render("--out", "b.png", "--dump-graph", method="hybrid"))):
            with self.subTest(command=command), open("/dev/full", "wb") as full:
                result = subprocess.run([EXECUTABLE, *command], cwd=self.folder, stdout=full,
                                        env=self.environment(), stderr=subprocess.PIPE, text=True)
                self.expect_sentence(result, "standard output", "No space left on device")


if __name__ == "__main__":
    unittest.main()
