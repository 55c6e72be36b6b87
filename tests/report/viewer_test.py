# SPDX-License-Identifier: MIT
"""The report's viewer in headless Chromium: what it paints is what the pictures' files hold."""

import os
import re
import shutil
import struct
import subprocess
import unittest
import zlib

import example_results
from page_case import MAKE_PAGE, ActionChains, By, Keys, PageCase, WebDriverWait

WIDTH, HEIGHT = example_results.WIDTH, example_results.HEIGHT
CROP = {"x": 40, "y": 20, "width": 32, "height": 24}

# The byte values that a view shows of the middle of some pixels of the picture.
READ = """
const [view, pixels] = arguments;
const canvas = document.querySelectorAll('#viewer-stage canvas')[view];
const {scale, x, y} = document.getElementById('viewer-stage').dataset;
const ratio = canvas.width / canvas.clientWidth;
// From a copy: reading a canvas that is drawn to makes the browser warn.
const copy = document.createElement('canvas');
copy.width = canvas.width;
copy.height = canvas.height;
const context = copy.getContext('2d', {willReadFrequently: true});
context.drawImage(canvas, 0, 0);
return pixels.map(([px, py]) => [...context.getImageData(
    Math.floor((px + 0.5 - x) * scale * ratio + canvas.width / 2),
    Math.floor((py + 0.5 - y) * scale * ratio + canvas.height / 2), 1, 1).data].slice(0, 3));
"""


def srgb_byte(light):
    c = min(max(light, 0), 1)
    return round(255 * (12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055))


def half(value):
    return struct.unpack("e", struct.pack("e", value))[0]


class Viewer(PageCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        # Too small a page for whole pictures of floats: crops have them, the rest is JPEG.
        folder = cls.folder / "small"
        example_results.write("paper", folder)
        most = (folder / "results.json").stat().st_size + 750_000
        subprocess.run([MAKE_PAGE, folder, str(most)], check=True)
        shutil.rmtree(folder / "images")
        cls.small_page_limit = most
        case = cls.results["paper"]["cases"][0]
        by_method = {m["method"]: m for m in case["measurements"] if m["isDefault"]}
        cls.rows, cls.errors = {}, {}
        for name in ("gather", "hybrid"):
            error = 10 ** ((22 - by_method[name]["metrics"]["psnr"]) / 20)
            cls.rows[name] = example_results.picture_rows(24 * (1 - error / 2), error / 4)
            cls.errors[name] = example_results.error_values(error)
        cls.rows["truth"] = example_results.picture_rows(24, 0)

    def start(self, suite="paper"):
        self.open(suite)
        self.stage = self.find("#viewer-stage")
        self.js("arguments[0].scrollIntoView({block: 'center'})", self.stage)
        self.wait()

    def wait(self):
        WebDriverWait(self.browser, 20).until(
            lambda _: self.stage.get_attribute("data-state") == "painted")

    def press(self, *keys):
        for key in keys:
            self.stage.send_keys(key)
        self.wait()

    def shown(self):
        return [tag.text for tag in self.find_all("#viewer-stage .tag")]

    def place(self):
        return [float(self.stage.get_attribute(f"data-{name}")) for name in ("scale", "x", "y")]

    def light(self, name, x, y):
        return [half(example_results.decode_srgb(max(0, c))) for c in self.rows[name][y][x]]

    def expect_near(self, found, expected, delta=1):
        for a, b in zip(found, expected):
            for i, (one, other) in enumerate(zip(a, b)):
                self.assertLessEqual(abs(one - other), delta, f"{a} for {b}, channel {i}")

    PIXELS = [(3, 4), (45, 30), (60, 44), (80, 45), (100, 40), (118, 60), (158, 88)]

    def test_begins_with_the_headlines_two_methods(self):
        self.start()
        self.assertEqual(self.shown(), ["gather, 15 samples", "hybrid, 15 samples"])
        self.assertIn("Every pixel is linear light", self.find("#viewer-note").text)

    def test_paints_the_light_that_the_files_hold(self):
        self.start()
        for view, name in enumerate(("gather", "hybrid")):
            expected = [[srgb_byte(c) for c in self.light(name, *p)] for p in self.PIXELS]
            self.expect_near(self.js(READ, view, self.PIXELS), expected)

    def test_exposure_scales_light_and_brings_back_what_was_dark(self):
        self.start()
        self.press("e", "e", "e", "e")
        self.assertEqual(self.find("#viewer-stops").text, "+2.0 stops")
        expected = [[srgb_byte(4 * c) for c in self.light("gather", *p)] for p in self.PIXELS]
        self.expect_near(self.js(READ, 0, self.PIXELS), expected)
        self.press("E", "E", "E", "E", "E", "E")
        expected = [[srgb_byte(c / 2) for c in self.light("gather", *p)] for p in self.PIXELS]
        self.expect_near(self.js(READ, 0, self.PIXELS), expected)

    def test_the_difference_is_one_of_light(self):
        self.start()
        self.press("d", "e", "e")
        expected = [[srgb_byte(2 * abs(a - b)) for a, b in zip(self.light("gather", *p),
                                                              self.light("truth", *p))]
                    for p in self.PIXELS]
        self.assertTrue(any(max(color) > 20 for color in expected))
        self.expect_near(self.js(READ, 0, self.PIXELS), expected)
        # From another picture than the truth: nothing differs from itself.
        self.choose("#viewer-against", "gather, 15 samples")
        self.wait()
        self.assertEqual(self.js(READ, 0, self.PIXELS), [[0, 0, 0]] * len(self.PIXELS))

    def test_flip_is_in_the_error_maps_colours(self):
        self.start()
        self.press("f")
        magma = self.js("return [...atob(JSON.parse(document.getElementById('picture-files')"
                        ".textContent).magma)].map((letter) => letter.charCodeAt(0))")
        expected = []
        for x, y in self.PIXELS:
            step = round(255 * min(1, half(self.errors["gather"][y][x])))
            expected.append(magma[3 * step:3 * step + 3])
        self.assertGreater(len({tuple(color) for color in expected}), 3)
        self.expect_near(self.js(READ, 0, self.PIXELS), expected, delta=3)
        self.assertFalse(self.find("#viewer-exposure").is_enabled())

    def test_number_keys_put_pictures_into_the_active_view(self):
        self.start()
        labels = [re.split(r"\s", button.text, maxsplit=1)[1]
                  for button in self.find_all("#viewer-pictures button")]
        self.press("2")
        self.assertEqual(self.shown(), [labels[1], "hybrid, 15 samples"])
        self.press("v", "1")
        self.assertEqual(self.shown()[1], labels[0])
        self.press("0")
        self.assertEqual(self.shown()[1], labels[9])
        # What Shift makes of a digit is the keyboard's affair.
        ActionChains(self.browser).key_down(Keys.SHIFT).send_keys("1").key_up(Keys.SHIFT).perform()
        self.wait()
        self.assertEqual(self.shown()[1], labels[10])
        self.find_all("#viewer-pictures button")[2].click()
        self.wait()
        self.assertEqual(self.shown()[1], labels[2])
        pressed = self.find_all('#viewer-pictures [aria-pressed="true"]')
        self.assertEqual([re.split(r"\s", button.text, maxsplit=1)[1] for button in pressed],
                         [labels[2]])

    def test_a_key_without_a_picture_does_nothing(self):
        self.start()
        before = self.shown()
        ActionChains(self.browser).click(self.find_all(".view canvas")[0]).key_down(Keys.SHIFT) \
            .send_keys("9").key_up(Keys.SHIFT).perform()
        self.assertEqual(self.shown(), before)

    def test_views_zoom_and_pan_as_one(self):
        self.start()
        whole = self.place()
        self.press("+", "+", "+", "+")
        scale, x, y = self.place()
        self.assertAlmostEqual(scale, whole[0] * 1.25 ** 4, places=3)
        self.press(Keys.ARROW_RIGHT)
        self.assertAlmostEqual(self.place()[1], x + 40 / scale, places=3)
        pixels = [(70, 40), (85, 45), (90, 50)]
        for view, name in enumerate(("gather", "hybrid")):
            expected = [[srgb_byte(c) for c in self.light(name, *p)] for p in pixels]
            self.expect_near(self.js(READ, view, pixels), expected)
        self.press("r")
        self.assertEqual(self.place(), whole)

    def test_drags_the_picture_along(self):
        self.start()
        self.press("+", "+", "+", "+")
        scale, x, y = self.place()
        ActionChains(self.browser).move_to_element(self.find_all(".view canvas")[1]) \
            .click_and_hold().move_by_offset(-30, 12).release().perform()
        self.assertAlmostEqual(self.place()[1], x + 30 / scale, delta=0.5 / scale)
        self.assertAlmostEqual(self.place()[2], y - 12 / scale, delta=0.5 / scale)
        self.assertIn("active", self.find_all(".view")[1].get_attribute("class"))

    def test_the_wheel_zooms_where_it_points_and_only_in_a_viewer_that_was_clicked(self):
        self.start()
        canvas = self.find_all(".view canvas")[0]
        before = self.place()
        roll = ("const box = arguments[0].getBoundingClientRect();"
                "arguments[0].dispatchEvent(new WheelEvent('wheel', {deltaY: -300, bubbles: true,"
                " cancelable: true, clientX: box.left + box.width / 4,"
                " clientY: box.top + box.height / 2}));")
        self.js(roll, canvas)
        self.assertEqual(self.place(), before)
        canvas.click()
        self.js(roll, canvas)
        scale, x, _ = self.place()
        self.assertAlmostEqual(scale, 2 * before[0], places=3)
        # A quarter of the picture from the left stays a quarter of the view from the left.
        self.assertAlmostEqual(x - canvas.size["width"] / 4 / scale, WIDTH / 4, delta=0.5)

    def test_tells_the_values_under_the_pointer_of_every_view(self):
        self.start()
        canvas = self.find_all(".view canvas")[0]
        ActionChains(self.browser).move_to_element(canvas).perform()
        text = self.find("#viewer-pixel").text
        x, y = (int(v) for v in re.match(r"(\d+), (\d+)", text).groups())
        self.assertLessEqual(abs(x - WIDTH // 2), 1)
        for name in ("gather", "hybrid"):
            values = re.search(name + r", 15 samples: (\S+) (\S+) (\S+), FLIP (\S+)", text).groups()
            for found, expected in zip(values, self.light(name, x, y)):
                self.assertAlmostEqual(float(found), expected, delta=1e-3 * expected + 1e-6)
            self.assertAlmostEqual(float(values[3]), self.errors[name][y][x], places=2)
        self.assertNotIn("8 bits", text)

    def test_shows_one_two_or_four_views(self):
        self.start()
        for count in ("4", "1", "2"):
            self.choose("#viewer-count", count)
            self.wait()
            self.assertEqual(len(self.shown()), int(count))
        self.choose("#viewer-count", "4")
        self.wait()
        self.assertEqual(len(set(self.shown())), 4)

    # A page in which only crops are floats

    def test_a_small_page_stays_below_its_limit(self):
        page = self.folder / "small/index.html"
        self.assertLess(page.stat().st_size, self.small_page_limit)
        self.assertIn("data:image/jpeg", page.read_text(encoding="utf-8"))

    def test_crops_are_exact_and_the_rest_nearly(self):
        self.start("small")
        self.assertIn("Inside the frames", self.find("#viewer-note").text)
        self.press("e", "e")
        inside = [(CROP["x"] + 3, CROP["y"] + 5), (CROP["x"] + 28, CROP["y"] + 20)]
        expected = [[srgb_byte(2 * c) for c in self.light("gather", *p)] for p in inside]
        self.expect_near(self.js(READ, 0, inside), expected)
        outside = [(20, 60), (140, 80)]
        expected = [[srgb_byte(2 * c) for c in self.light("gather", *p)] for p in outside]
        self.expect_near(self.js(READ, 0, outside), expected, delta=40)
        self.press("d")
        expected = [[srgb_byte(2 * abs(a - b)) for a, b in zip(self.light("gather", *p),
                                                              self.light("truth", *p))]
                    for p in inside]
        self.expect_near(self.js(READ, 0, inside), expected)

    def test_a_part_fills_the_view(self):
        self.start("small")
        self.choose("#viewer-region", "0")
        scale, x, y = self.place()
        canvas = self.find_all(".view canvas")[0]
        self.assertAlmostEqual(scale, min(canvas.size["width"] / CROP["width"],
                                          canvas.size["height"] / CROP["height"]), places=2)
        self.assertEqual((x, y), (CROP["x"] + CROP["width"] / 2, CROP["y"] + CROP["height"] / 2))

    def test_crops_of_the_figure_are_painted_from_floats(self):
        self.start("small")
        read = ("const canvas = document.querySelector(arguments[0]);"
                "const copy = document.createElement('canvas').getContext('2d',"
                " {willReadFrequently: true});"
                "copy.drawImage(canvas, 0, 0);"
                "return canvas.dataset.drawn && arguments[1].map(([x, y]) =>"
                " [...copy.getImageData(x, y, 1, 1).data].slice(0, 3))")
        pixels = [(3, 5), (28, 20)]
        panel = '#pictures-panels [data-picture="gather, 15 samples"] .crop canvas'
        found = WebDriverWait(self.browser, 20).until(lambda _: self.js(read, panel, pixels))
        expected = [[srgb_byte(c) for c in self.light("gather", CROP["x"] + x, CROP["y"] + y)]
                    for x, y in pixels]
        self.expect_near(found, expected)

    # A page that was measured

    def test_paints_what_the_program_compared(self):
        """The tone mapper and the case's exposure are those of the PNG files."""
        shutter = os.environ["SHUTTER_EXECUTABLE"]
        devices = subprocess.run([shutter, "info", "--devices"], capture_output=True, text=True)
        if "llvmpipe" not in devices.stdout:
            self.skipTest("there is no lavapipe to draw on")
        folder = self.folder / "measured"
        subprocess.run(
            [shutter, "bench", os.environ["SHUTTER_ASSETS"] + "/vase.glb", "--time", "0.5", "--ev",
             "2", "--out", folder, "--size", "96x54", "--methods", "sharp,gather", "--repeats", "1",
             "--truth-samples", "8", "--device", "llvmpipe"], check=True)
        self.start("measured")
        self.assertIn("Every pixel is linear light", self.find("#viewer-note").text)
        pixels = [(x, y) for y in range(2, 54, 5) for x in range(1, 96, 5)]
        painted = self.js(READ, 0, pixels)
        stored = self.browser.execute_async_script("""
            const [file, pixels, done] = arguments;
            const files = JSON.parse(document.getElementById('picture-files').textContent);
            const image = new Image();
            image.src = files.whole[file];
            image.decode().then(() => {
                const context = document.createElement('canvas').getContext(
                    '2d', {willReadFrequently: true});
                context.drawImage(image, 0, 0);
                done(pixels.map(([x, y]) => [...context.getImageData(x, y, 1, 1).data].slice(0, 3)));
            });""", "images/own.gather.15.png", pixels)
        self.assertTrue(any(max(color) > 225 for color in stored), "nothing is compressed")
        self.expect_near(painted, stored)

    # What cannot be shown

    def test_says_which_picture_it_cannot_read(self):
        page = (self.folder / "paper/index.html").read_text(encoding="utf-8")
        # An EXR whose first block is cut short: the browser cannot inflate it.
        broken = re.sub(r'"exr":"([^"]{1200})[^"]*"', r'"exr":"\1"', page)
        self.assertNotEqual(broken, page)
        (self.folder / "broken").mkdir()
        (self.folder / "broken/index.html").write_text(broken, encoding="utf-8")
        self.open("broken")
        WebDriverWait(self.browser, 20).until(lambda _: self.find("#failure").is_displayed())
        self.assertIn("a picture: ", self.find("#failure").text)


if __name__ == "__main__":
    unittest.main()
