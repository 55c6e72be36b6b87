# SPDX-License-Identifier: MIT
"""Demos in a window: every method, many sizes, minimised and back, and no validation message."""

import subprocess
import sys
import unittest

from play_case import DRAWS_ALL, EXECUTABLE, PlayCase, Script

try:
    import skimage.io
except ImportError:
    print("skipped: the package python3-skimage is missing")
    sys.exit(77)

HIDDEN_FRAMES = 100
SIZES = 200 if DRAWS_ALL else 24


def list_methods():
    listed = subprocess.run([EXECUTABLE, "info", "--methods"], capture_output=True, text=True)
    return listed.stdout.split()


def toggle_everything(script):
    """All methods on both sides, the split, its divider, all views, pause, step and slow motion."""
    for _ in list_methods():
        script.tap("m").wait()
    script.tap("x")
    script.add(pointer=[0.5, 0.5]).wait().add(button="left", action="press").wait()
    script.add(pointer=[0.3, 0.5]).wait().add(button="left", action="release").wait()
    for _ in list_methods():
        script.tap("n")
    script.tap("x")
    for _ in range(13):
        script.tap("v")
    for key in ("p", "period", "p", "comma", "slash", "b", "b", "1", "3", "f1", "f1", "f2", "t", "q", "t", "p", "c", "e"):
        script.tap(key)


def resize(script, times):
    for i in range(times):
        script.add(resize=[140 + i * 37 % 130, 90 + i * 53 % 70]).wait()
    script.add(resize=[192, 108]).wait(3)


def hide_and_show(script):
    # Turns without a picture are short: many pass until the window manager has hidden it.
    script.add(window="minimise").wait(HIDDEN_FRAMES).add(window="restore").wait(40)
    script.add(window="full_screen").wait(3).add(window="windowed").wait(3)


class Window(PlayCase):
    def check_demo(self, demo):
        script = Script()
        script.add(key="w", action="press").wait(5)
        toggle_everything(script)
        if demo == "rally":
            resize(script, SIZES // 5)
        script.tap("1")  # without blur: sizes alone, in less time
        resize(script, SIZES)
        hide_and_show(script)
        script.add(screenshot="end.png").wait(2).add(window="quit")
        statistics = self.play(demo, script)
        self.assertEqual(statistics["validationMessages"], 0)
        # Out of sight nothing is drawn; all else is, but for turns between two sizes.
        self.assertGreater(statistics["frames"], 0.7 * (script.frame - HIDDEN_FRAMES))
        self.assertLess(statistics["frames"], script.frame - HIDDEN_FRAMES // 2)
        self.assertIn(statistics["method"], list_methods())
        self.check_picture(self.folder / "end.png")

    def check_picture(self, file):
        """Not one colour between the head-up display's lines and the foot."""
        picture = skimage.io.imread(file)
        band = picture[int(0.8 * len(picture)):int(0.85 * len(picture))]
        self.assertGreater(band.astype(float).std(), 3.0)

    def test_sticks_of_a_script_do_the_same_in_a_window(self):
        script = Script().add(rightStick=[0, 1]).wait(90).add(window="quit")
        shown = self.play("rally", script)
        unseen = self.play("rally", script, display=False)
        self.assertEqual(shown["score"], unseen["score"])
        self.assertNotEqual(shown["score"], 0)  # it drove: a gate or a post

    def test_demos_show_every_method_and_view_and_bear_changes_of_their_window(self):
        for demo in self.sample(("rally", "gallery", "spin")):
            with self.subTest(demo=demo):
                self.check_demo(demo)


if __name__ == "__main__":
    unittest.main()
