# SPDX-License-Identifier: MIT
"""Every command of README and docs runs, on small pictures."""

import os
import pathlib
import shlex
import subprocess
import tempfile
import unittest

import commands_test

ROOT = commands_test.ROOT
BUILD = pathlib.Path(os.environ["SHUTTER_BUILD"])
# Other tests run these: builds and installations are install/*, a host's dump is gpu/EmbeddedDump.
ELSEWHERE = ("scripts/demo.sh", "scripts/test.sh", "cmake ", "shutter replay DUMP")
# What stands for the reader's own files and choices.
WORDS = {"[rally|gallery|spin|SCENE.glb]": "rally"}
# Options in place of the command's own: pictures of all sizes and sequences of all lengths are drawn alike.
SMALL = {
    "render": {"--size": "48x32"},
    "film": {"--size": "48x32"},
    "play": {"--size": "48x32", "--frames": "2", "--no-window": None},
    "bench": {"--size": "48x32", "--repeats": "1", "--truth-samples": "2", "--methods": "sharp"},
}


def shorten(words):
    """The command's words with small pictures and, of a film or sequence, two frames."""
    options = dict(SMALL.get(words[1], {}))
    if words[1] in ("render", "film") and ("--frames" in words or "--flythrough" in words):
        options["--frames"] = "0:1"
    kept = []
    skips = False
    for word in words:
        skips = skips or word in options
        if not skips:
            kept.append(word)
        skips = word in options and options[word] is not None
    return kept + [part for option, value in options.items() for part in (option, value) if part]


def find_commands():
    """Pairs of place and words of each command that runs here, by page."""
    for page in commands_test.list_pages():
        path = page.relative_to(ROOT)
        if path.name == "README.md" and path.parent == pathlib.Path(".") or path.parts[0] == "docs":
            yield path, [(f"{path}:{number}", [WORDS.get(word, word) for word in shlex.split(command)])
                         for number, command in commands_test.list_commands(page)
                         if not command.startswith(ELSEWHERE)]


class Run(unittest.TestCase):
    def run_in(self, folder, words):
        return subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False,
                              executable=BUILD / "shutter")

    def prepare(self, folder):
        """What the pages' names stand for."""
        (folder / "build").mkdir()
        (folder / "build/release").symlink_to(BUILD)
        (folder / "assets").symlink_to(ROOT / "assets")
        (folder / "SCENE.glb").symlink_to(BUILD / "assets/vase.glb")
        (folder / "FLIGHT.json").symlink_to(ROOT / "assets/flythroughs/vase.json")
        drawn = ("shutter", "render", "SCENE.glb", "--size", "48x32", "--method")
        for words in ((*drawn, "sharp", "--out", "A.exr"), (*drawn, "gather", "--out", "B.exr"),
                      (*drawn, "sharp", "--out", "A.png"),
                      (*drawn, "sharp", "--aov", "motion,depth", "--out", "COLOUR.exr")):
            self.assertEqual(self.run_in(folder, words).returncode, 0)
        for name in ("motion", "depth"):
            (folder / f"COLOUR.{name}.exr").rename(folder / f"{name.upper()}.exr")

    def test_the_commands_of_each_page_run_in_their_order(self):
        count = 0
        for page, commands in find_commands():
            with tempfile.TemporaryDirectory() as name:
                folder = pathlib.Path(name)
                if commands:
                    self.prepare(folder)
                for place, words in commands:
                    with self.subTest(place):
                        self.assertEqual(words[0], "shutter", words)
                        done = self.run_in(folder, shorten(words))
                        self.assertEqual(done.returncode, 0, (words, done.stderr))
                        count += 1
        self.assertGreater(count, 15, "hardly any command was found")


if __name__ == "__main__":
    unittest.main()
