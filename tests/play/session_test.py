# SPDX-License-Identifier: MIT
"""What holds of sessions without a display: the same film twice, scores, settings, bad input."""

import json
import pathlib
import unittest

import play_case
from play_case import ASSETS, PlayCase, Script

SCRIPTS = pathlib.Path(play_case.__file__).parents[2] / "game/demos"


def drive():
    script = Script()
    script.add(key="w", action="press").wait(10).add(key="d", action="press").wait(10)
    return script.add(key="d", action="release").wait(5).add(window="quit")


class Session(PlayCase):
    def film(self, name, *options):
        self.play("rally", drive(), "--film", f"{name}%02d.png", *options, display=False)
        return [path.read_bytes() for path in sorted(self.folder.glob(f"{name}*.png"))]

    def test_the_same_script_gives_the_same_film(self):
        first = self.film("first")
        self.assertGreaterEqual(len(first), 24)
        self.assertEqual(first, self.film("second"))
        # The picture moves.
        self.assertGreater(len(set(first)), 20)

    def test_split_shows_both_methods(self):
        script = Script()
        script.add(key="w", action="press").wait(20).add(screenshot="right.png").wait()
        script.add(key="p").tap("x").wait(2).add(screenshot="split.png").wait(2)
        self.play("rally", script.add(window="quit"), display=False)
        self.assertNotEqual((self.folder / "right.png").read_bytes(),
                            (self.folder / "split.png").read_bytes())

    def test_settings_are_kept_and_wrong_ones_refused(self):
        script = Script().wait(2).tap("x").tap("f5").wait().add(window="quit")
        self.play("spin", script, display=False)
        kept = json.loads((self.folder / "settings.json").read_text(encoding="utf-8"))
        self.assertTrue(kept["split"])
        self.assertEqual(kept["instants"], 2)
        (self.folder / "wrong.json").write_text('{"version": 1,\n "instants": 0}', encoding="utf-8")
        result = self.run_shutter(["spin", "--no-window", "--frames", "1", "--assets", ASSETS,
                                   "--settings", "wrong.json"], display=False)
        self.assertEqual(result.returncode, 1)
        self.assertIn("wrong.json:2", result.stderr)
        self.assertIn("instants", result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1)

    def test_bad_input_is_told_in_one_sentence(self):
        for arguments, status, told in (
            (["nowhere.glb", "--no-window", "--frames", "1"], 1, "nowhere.glb"),
            (["rally", "--no-window"], 2, "--no-window"),
            (["rally", "--script", "none.json", "--no-window"], 1, "none.json"),
            (["rally", "--assets", "nowhere", "--no-window", "--frames", "1"], 1, "nowhere"),
        ):
            with self.subTest(arguments=arguments):
                result = self.run_shutter(arguments, display=False)
                self.assertEqual(result.returncode, status, result.stderr)
                self.assertIn(told, result.stderr)
                self.assertEqual(result.stderr.count("\n"), 1, result.stderr)


if __name__ == "__main__":
    unittest.main()
