# SPDX-License-Identifier: MIT
"""What holds of sessions without a display: the same film twice, scores, settings, bad input."""

import json
import sys
import unittest

try:
    import numpy as np
    import skimage.io
except ImportError:
    print("skipped: the package python3-skimage is missing")
    sys.exit(77)

from play_case import ASSETS, DRAWS_ALL, PlayCase, Script


def drive():
    script = Script()
    script.add(key="w", action="press").wait(10).add(key="d", action="press").wait(10)
    return script.add(key="d", action="release").wait(5).add(window="quit")


class Session(PlayCase):
    def film(self, name):
        self.play("rally", drive(), "--film", f"{name}%02d.png", "--method", "gather", display=False)
        return [path.read_bytes() for path in sorted(self.folder.glob(f"{name}*.png"))]

    def test_the_same_script_gives_the_same_film(self):
        first = self.film("first")
        self.assertGreaterEqual(len(first), 24)
        self.assertEqual(first, self.film("second"))
        # The picture moves.
        self.assertGreater(len(set(first)), 20)

    def test_a_film_shows_the_head_up_display_only_if_that_is_typed(self):
        def corner(*options):
            script = Script().wait(2).add(window="quit")
            self.play("rally", script, "--film", "a%02d.png", "--method", "sharp", *options, display=False)
            return skimage.io.imread(sorted(self.folder.glob("a*.png"))[0])[4:20, 4:20].mean()

        # Its background is dark.
        self.assertGreater(corner(), corner("--film-hud") + 20)

    def test_split_shows_both_methods(self):
        script = Script().add(key="w", action="press").wait(150).tap("p")
        script.add(screenshot="sharp.png").wait().tap("m").wait()  # the next method blurs
        script.add(screenshot="blurred.png").wait().tap("x").wait()
        script.add(screenshot="split.png").wait(2).add(window="quit")
        self.play("rally", script, "--method", "sharp", size="480x270", display=False)
        # Between the head-up display's lines and the foot; the divider's line apart.
        blurred, split, sharp = (
            skimage.io.imread(self.folder / f"{name}.png")[120:200]
            for name in ("blurred", "split", "sharp")
        )
        self.assertTrue((split[:, :238] == sharp[:, :238]).all())
        self.assertTrue((split[:, 242:] == blurred[:, 242:]).all())
        for half in (slice(0, 238), slice(242, 480)):
            self.assertGreater(abs(blurred[:, half].astype(float) - sharp[:, half]).mean(), 0.5)

    def test_photo_mode_adds_rays_until_the_picture_is_the_truth(self):
        def shoot(name, *taps, frames, method, rays=1):
            script = Script().add(key="w", action="press").wait(8)
            script.add(key="w", action="release").wait()  # it would fly the photo's camera
            for key in taps:
                script.tap(key)
            script.wait(frames).tap("f2").wait(2).add(window="quit")
            self.play("rally", script, "--method", method, display=False, rays=rays)
            (self.folder / "rally_truth_001.png").rename(self.folder / f"{name}.png")
            return skimage.io.imread(self.folder / f"{name}.png").astype(int)

        # Four frames of photo mode, the key's and the saved one included, are one of four rays.
        photo = shoot("photo", "t", frames=2, method="resolved")
        truth = shoot("truth", "p", frames=2, method="truth", rays=4)
        self.assertTrue((photo == truth).all())
        self.assertFalse((photo == shoot("three", "p", frames=0, method="truth", rays=3)).all())

    def test_no_budget_takes_the_blur_away(self):
        def drive_and_shoot(name, method, milliseconds):
            script = Script().add(key="w", action="press").wait(90)
            script.add(screenshot=f"{name}.png").wait(2).add(window="quit")
            stats = self.play("rally", script, "--method", method, size="320x180", display=False,
                              budget={"milliseconds": milliseconds})
            picture = skimage.io.imread(self.folder / f"{name}.png")
            # Next to the lines of the head-up display, which show the budget.
            return picture[75:122, :40].astype(float), stats["reducedFrames"]

        sharp, _ = drive_and_shoot("sharp", "sharp", "unlimited")
        full, reduced = drive_and_shoot("full", "resolved", "unlimited")
        self.assertEqual(reduced, 0)
        blurred = abs(full - sharp).mean()
        self.assertGreater(blurred, 0.5)
        for milliseconds in (0.1, 16) if DRAWS_ALL else (0.1,):
            with self.subTest(milliseconds=milliseconds):
                picture, reduced = drive_and_shoot("budget", "resolved", milliseconds)
                # At least half of what the whole blur changes.
                self.assertGreater(abs(picture - sharp).mean(), 0.5 * blurred)
                if milliseconds < 1:
                    self.assertGreater(reduced, 60)
                    self.assertLess(abs(picture - full).mean(), 0.75 * blurred)

    def test_f2_saves_the_picture_with_its_settings_and_without_what_lies_over_it(self):
        script = Script().add(key="w", action="press").wait(8).tap("f1").tap("f2").tap("f2").wait()
        self.play("rally", script.add(window="quit"), "--method", "gather", display=False)
        photos = sorted(self.folder.glob("*.png"))
        self.assertEqual([photo.name for photo in photos],
                         ["rally_gather_001.png", "rally_gather_002.png"])
        bytes_ = photos[0].read_bytes()
        at = bytes_.index(b"tEXtSettings\0") + len(b"tEXtSettings\0")
        settings, _ = json.JSONDecoder().raw_decode(bytes_[at:].decode("latin1"))
        self.assertEqual(settings["method"], "gather")
        self.assertTrue(settings["showPanel"])
        again = Script().add(key="w", action="press").wait(8).add(screenshot="over.png")
        self.play("rally", again.wait(2).add(window="quit"), display=False, **settings)
        photo = skimage.io.imread(photos[0])
        shown = skimage.io.imread(self.folder / "over.png")
        self.assertEqual(photo.shape, shown.shape)
        # The head-up display's background darkens only the corner of the shown picture.
        self.assertGreater(photo[4:20, 4:20].mean(), shown[4:20, 4:20].mean() + 20)

    def test_the_camera_of_a_photo_flies_while_the_game_rests(self):
        def shoot(name, *held):
            script = Script().add(key="w", action="press").wait(8)
            script.add(key="w", action="release").wait().tap("t")
            for key in held:
                script.add(key=key, action="press").wait(15).add(key=key, action="release").wait()
            script.tap("f2").tap("t").wait(2).add(screenshot=f"{name}.png").wait(2)
            stats = self.play("rally", script.add(window="quit"), display=False)
            photo = skimage.io.imread(self.folder / "rally_truth_001.png").astype(int)
            (self.folder / "rally_truth_001.png").unlink()
            return photo, skimage.io.imread(self.folder / f"{name}.png"), stats["score"]

        still, after_still, score = shoot("still")
        flown, after_flown, score_flown = shoot("flown", "q", "d")
        self.assertGreater(abs(still - flown).mean(), 3.0)
        # The game has seen none of it.
        self.assertEqual(score, score_flown)
        self.assertTrue((after_still[60:] == after_flown[60:]).all())

    def test_depth_of_field_is_the_players_and_at_scale_0_costs_nothing(self):
        def shoot(*taps, lens):
            script = Script().wait(2).tap("p")
            for key in taps:
                script.tap(key)
            script.wait(2).add(window="quit")
            stats = self.play("gallery", script, "--method", "resolved", display=False,
                              size="96x54", lens=lens)
            photos = sorted(self.folder.glob("gallery_*.png"))
            pictures = [skimage.io.imread(photo).astype(int) for photo in photos]
            for photo in photos:
                photo.unlink()
            return pictures, stats["passes"]

        (pinhole,), passes = shoot("f2", lens={})
        (off,), passes_off = shoot("f2", lens={"fStop": 0.5, "focusDistance": 1, "blurScale": 0})
        self.assertTrue((off == pinhole).all())
        self.assertEqual(passes_off, passes)
        # In the middle there is the wall, which F makes sharp.
        (near, middle), passes_near = shoot("f2", "f", "f2", lens={"fStop": 0.5, "focusDistance": 1})
        self.assertGreater(abs(near - pinhole).mean(), 1.0)
        self.assertGreater(set(passes_near), set(passes))
        self.assertLess(abs(middle - pinhole).mean(), 0.5 * abs(near - pinhole).mean())

    def test_shift_f_says_how_it_focuses_and_photo_mode_ends_what_was_said_before_it(self):
        script = Script().wait(2).tap("p").add(screenshot="before.png").wait()
        script.add(key="shift", action="press").wait().tap("f").add(key="shift", action="release")
        script.add(screenshot="said.png").wait().tap("t").tap("t").add(screenshot="after.png").wait(2)
        self.play("gallery", script.add(window="quit"), "--method", "gather", display=False, size="320x240")
        # Without the upper lines, which hold times.
        before, said, after = (skimage.io.imread(self.folder / f"{name}.png")[120:].astype(int)
                               for name in ("before", "said", "after"))
        self.assertGreater(abs(said - before).mean(), 0.5)
        self.assertTrue((after == before).all())

    def test_an_option_of_the_lens_that_changes_nothing_says_why(self):
        (self.folder / "settings.json").write_text('{"version": 1}', encoding="utf-8")

        def warn(method, *options):
            result = self.run_shutter(
                ["gallery", "--size", "64x36", "--frames", "1", "--assets", ASSETS, "--settings",
                 "settings.json", "--method", method, *options], display=False)
            self.assertEqual(result.returncode, 0, result.stderr)
            return result.stderr

        self.assertIn("--focus changes nothing: the camera is a pinhole", warn("resolved", "--focus", "3"))
        self.assertIn("--fstop changes nothing: gather draws pinholes", warn("gather", "--fstop", "2"))
        self.assertIn("--focus-entity changes nothing: the camera is a pinhole",
                      warn("resolved", "--focus-entity", "runner"))
        self.assertNotIn("changes nothing", warn("resolved", "--fstop", "2", "--focus-entity", "runner"))
        unknown = self.run_shutter(["gallery", "--frames", "1", "--assets", ASSETS, "--settings", "settings.json",
                                    "--focus-entity", "nobody"], display=False)
        self.assertEqual(unknown.returncode, 1)
        self.assertIn("gallery: --focus-entity 'nobody' is the name of no node", unknown.stderr)

    def test_settings_are_kept(self):
        script = Script().wait(2).tap("x").tap("f5").wait().add(window="quit")
        self.play("spin", script, display=False)
        kept = json.loads((self.folder / "settings.json").read_text(encoding="utf-8"))
        self.assertTrue(kept["split"])
        self.assertEqual(kept["instants"], 2)

    def test_bloom_costs_its_passes_and_none_without_a_share_or_a_highlight(self):
        def shoot(share, **settings):
            script = Script().add(key="f1").wait(2).add(screenshot="a.png").wait(2)
            stats = self.play("rally", script.add(window="quit"), "--method", "gather",
                              display=False, bloomShare=share, **settings)
            passes = {name: count for name, count in stats["passes"].items() if "bloom" in name}
            return passes, skimage.io.imread(self.folder / "a.png").astype(int)

        passes, sharp = shoot(0)
        self.assertEqual(passes, {})
        # 108 lines halve four times until an image is less than four pixels high. All light is
        # scattered: what highlights there are lies behind the panel.
        passes, bloomed = shoot(0.2, bloomThreshold=0)
        self.assertEqual(passes, {"bloom down": 4, "bloom up": 4})
        self.assertGreater(abs(bloomed - sharp).mean(), 0.5)
        # Nothing is as bright as that, which the second picture after knows.
        passes, _ = shoot(0.2, bloomThreshold=60000)
        self.assertEqual(passes, {})

    def test_motion_that_stops_and_starts_allocates_nothing_after_the_first_second(self):
        # Pausing and going on change what a frame consists of; drivers may take tens of
        # milliseconds over an allocation.
        script = Script().wait(6)
        for _ in range(2):
            script.tap("p").wait(6).tap("p").wait(6)
        script.wait(12)
        for _ in range(3):
            script.tap("p").wait(4).tap("p").wait(4)
        script.add(window="quit")
        for demo, method in self.sample((("rally", "resolved"), ("spin", "hybrid"), ("rally", "hybrid"),
                                         ("spin", "resolved"), ("gallery", "hybrid"),
                                         ("gallery", "resolved"))):
            with self.subTest(demo=demo, method=method):
                stats = self.play(demo, script, "--method", method, display=False)
                self.assertEqual(stats["allocationsAfterFirstSecond"], 0)

    def test_bad_input_is_told_in_one_sentence(self):
        (self.folder / "wrong.json").write_text('{"version": 1,\n "instants": 0}', encoding="utf-8")
        for arguments, status, expected in (
            (["spin", "--frames", "1", "--assets", ASSETS, "--settings", "wrong.json"], 1,
             "wrong.json:2: instants"),
            (["nowhere.glb", "--frames", "1"], 1,
             "'nowhere.glb' is neither a demo (rally, gallery, spin) nor a file"),
            (["rally"], 2, "--no-window"),
            (["rally", "--script", "none.json"], 1, "none.json"),
            (["rally", "--assets", "nowhere", "--frames", "1"], 1, "nowhere"),
        ):
            with self.subTest(arguments=arguments):
                result = self.run_shutter(arguments, display=False)
                self.assertEqual(result.returncode, status, result.stderr)
                self.assertIn(expected, result.stderr)
                self.assertEqual(result.stderr.count("\n"), 1, result.stderr)


class Effects(PlayCase):
    def test_each_effect_is_switched_by_its_option_and_its_key(self):
        def shoot(keys, *options, rays="query"):
            script = Script().add(key="w", action="press").wait(3)
            for key in keys:
                script.tap(key)
            script.wait(2 - len(keys)).add(screenshot="a.png").wait(2).add(window="quit")
            stats = self.play("rally", script, "--method", "resolved", "--rays", rays, *options,
                              display=False)
            self.assertEqual(stats["validationMessages"], 0)
            return set(stats["passes"]), skimage.io.imread(self.folder / "a.png").astype(int)

        # A sky has no separate pass. Next to and below the head-up display, which shows times.
        place = np.s_[74:, 70:]
        bare, by_option = shoot("", "--sky", "0")
        shadow_passes = {"shadow maps", "keep shadow maps"}  # the last if the camera rests
        every = set(bare)
        for keys, passes in (("6", {"clear edges", "split samples", "split edges", "taa"}),
                             ("7", shadow_passes),
                             ("77", shadow_passes),
                             ("9", {"bloom down", "bloom up"})):
            with self.subTest(keys=keys):
                alone, _ = shoot(keys, "--sky", "0")
                self.assertNotEqual(alone & passes, set())
                self.assertLessEqual(alone - bare, passes)
                every |= alone
        with_sky, without = (shoot(keys)[1][place] for keys in ("", "8"))
        self.assertGreater(abs(with_sky - without).mean(), 2)
        self.assertLess(abs(without - by_option[place]).mean(), 0.2 * abs(with_sky - without).mean())
        options = ("--sky", "0", "--aa", "taa", "--shadows", "blurred", "--bloom", "0.04")
        self.assertEqual(shoot("", *options)[0], every)
        for rays in ("pipeline", "none"):
            with self.subTest(rays=rays):
                passes, _ = shoot("", *options, rays=rays)
                self.assertLessEqual(
                    {"split samples", "shadow maps", "bloom down", "bloom up"}, passes
                )


if __name__ == "__main__":
    unittest.main()
