# SPDX-License-Identifier: MIT
"""The report page's pictures in headless Chromium: panels, crops, error maps and the slider."""

from page_case import ActionChains, Keys, PageCase, Select, WebDriverWait


class Pictures(PageCase):
    # Pictures

    def panels(self):
        return [f.get_attribute("data-picture") for f in self.find_all("#pictures-panels figure")]

    def sources(self, selector):
        return [image.get_attribute("src") for image in self.find_all(selector)]

    def test_panels_are_the_papers_figure(self):
        self.open("paper")
        self.assertEqual(self.panels(), ["sharp", "gather, 15 samples", "hybrid, 15 samples",
                                         "truth-reference"])
        whole = self.sources("#pictures-panels .viewport:not(.crop) img")
        self.assertEqual(len(set(whole)), 4)

    def test_a_panel_takes_another_picture(self):
        self.open("paper")
        Select(self.find("#pictures-panels figure:nth-child(2) select")).select_by_value(
            "denoised, 1 ray")
        self.assertEqual(self.panels()[1], "denoised, 1 ray")

    def test_panels_show_error_maps(self):
        self.open("paper")
        pictures = self.sources("#pictures-panels .viewport:not(.crop) img")
        self.find("#pictures-show input[value=errorMap]").click()
        maps = self.sources("#pictures-panels .viewport:not(.crop) img")
        self.assertEqual(len(maps), 3)
        self.assertFalse(set(maps) & set(pictures))
        self.assertIn("the truth has no error", self.find("#pictures-panels").text)

    def test_a_crop_enlarges_without_smoothing(self):
        self.open("paper")
        crop = self.find("#pictures-panels figure:nth-child(1) .crop-button")
        self.js("arguments[0].scrollIntoView({block: 'center'})", crop)
        crop.click()
        images = self.find_all("#zoom[open] img")
        self.assertEqual(len(images), 4)
        self.assertEqual(images[0].value_of_css_property("image-rendering"), "pixelated")
        WebDriverWait(self.browser, 10).until(lambda _: images[0].size["width"] > 200)
        # Crops are pictures of their own.
        ratio, left = self.js(
            "const image = arguments[0], box = image.parentElement.getBoundingClientRect();"
            "const own = image.getBoundingClientRect();"
            "return [own.width / box.width, (box.left - own.left) / own.width]", images[0])
        self.assertAlmostEqual(ratio, 1, places=2)
        self.assertAlmostEqual(left, 0, places=2)
        self.find("#zoom button").click()
        self.assertFalse(self.find_all("#zoom[open]"))

    # Slider

    def slider(self):
        handle = self.find("#slider-handle")
        clip = self.js("return document.getElementById('slider-over').style.clipPath")
        right = float(clip.split()[1].rstrip("%"))
        self.assertEqual(round(100 - right), int(handle.get_attribute("aria-valuenow")))
        return 100 - right

    def test_slider_moves_by_drag(self):
        self.open("paper")
        frame = self.find("#slider-frame")
        self.js("arguments[0].scrollIntoView({block: 'center'})", frame)
        self.assertEqual(self.slider(), 50)
        width = frame.size["width"]
        ActionChains(self.browser).move_to_element(self.find("#slider-handle")).click_and_hold() \
            .move_by_offset(int(width * 0.25), 0).release().perform()
        self.assertAlmostEqual(self.slider(), 75, delta=1)
        ActionChains(self.browser).move_by_offset(-int(width * 0.5), 0).perform()
        self.assertAlmostEqual(self.slider(), 75, delta=1, msg="moves without the button")

    def test_slider_moves_by_key_and_stops_at_its_ends(self):
        self.open("paper")
        handle = self.find("#slider-handle")
        self.assertEqual(handle.get_attribute("role"), "slider")
        for key, expected in ((Keys.ARROW_RIGHT, 51), (Keys.ARROW_LEFT, 50), (Keys.PAGE_UP, 60),
                              (Keys.END, 100), (Keys.ARROW_RIGHT, 100), (Keys.HOME, 0),
                              (Keys.ARROW_LEFT, 0)):
            handle.send_keys(key)
            self.assertEqual(self.slider(), expected)

    def test_slider_takes_any_two_pictures_and_a_region(self):
        self.open("paper")
        before = self.sources("#slider-frame img")
        self.choose("#slider-left", "sharp")
        self.choose("#slider-right", "sharp: error")
        after = self.sources("#slider-frame img")
        self.assertEqual(len(set(before + after)), 4)
        self.choose("#slider-region", "1")
        self.assertEqual(len(self.find_all("#slider-frame .viewport.crop")), 2)

