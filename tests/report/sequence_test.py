# SPDX-License-Identifier: MIT
"""Films in the report page in headless Chromium: they show the frame that they should, in step."""

import example_results
from page_case import PageCase, By, Keys, WebDriverWait

# Number of the frame that each film shows, by its grey, and the colour of its own stripe.
READ = """
    return ["left", "right"].map((side) => {
        const video = document.getElementById(`player-${side}-film`);
        const canvas = document.createElement("canvas");
        canvas.width = video.videoWidth;
        canvas.height = video.videoHeight;
        const context = canvas.getContext("2d", {willReadFrequently: true});
        context.drawImage(video, 0, 0);
        const at = (x) => [...context.getImageData(x, 40, 1, 1).data].slice(0, 3);
        return {frame: (at(100)[1] - %d) / %d, stripe: at(16)};
    });""" % (example_results.gray_of(0), example_results.gray_of(1) - example_results.gray_of(0))
LAST = example_results.FRAMES - 1
RATE = 24


class Sequence(PageCase):
    def setUp(self):
        self.open("sequence")
        self.wait_for(0)

    def wait_for(self, frame):
        WebDriverWait(self.browser, 30).until(lambda browser: browser.execute_script(
            "return document.getElementById('player-stage').dataset.shown") == str(frame))

    def frames(self):
        return [round(side["frame"], 1) for side in self.js(READ)]

    def check_frame(self, frame):
        self.wait_for(frame)
        for shown in self.frames():
            self.assertAlmostEqual(shown, frame, delta=0.4)

    # Films

    def test_shows_the_first_frame_of_the_headline_s_method_and_the_truth(self):
        self.assertEqual(self.find("#player-left-name").text, "resolved, 15 instants")
        self.assertEqual(self.find("#player-right-name").text, "truth")
        self.check_frame(0)
        left, right = (side["stripe"] for side in self.js(READ))
        self.assertGreater(left[0], right[0] + 60)

    def test_steps_to_exactly_each_frame(self):
        forward = self.find("#player-forward")
        for frame in range(1, example_results.FRAMES):
            forward.click()
            self.check_frame(frame)
        forward.click()
        self.check_frame(LAST)
        back = self.find("#player-back")
        for frame in (LAST - 1, LAST - 2, LAST - 3):
            back.click()
            self.check_frame(frame)

    def test_follows_keys_and_the_slider_of_frames(self):
        stage = self.find("#player-stage")
        stage.send_keys(Keys.END)
        self.check_frame(LAST)
        stage.send_keys(Keys.ARROW_LEFT)
        self.check_frame(LAST - 1)
        stage.send_keys(Keys.HOME)
        self.check_frame(0)
        self.js("const range = document.getElementById('player-frame'); range.value = 13;"
                "range.dispatchEvent(new Event('input'))")
        self.check_frame(13)
        self.assertEqual(self.find("#player-place").text, "frame 13 of 24, 0.54 s")

    def test_plays_both_films_in_step(self):
        self.js("window.seen = []; const read = () => {%s};"
                "document.getElementById('player-stage').addEventListener("
                "'shown', () => window.seen.push(read()))" % READ)
        self.find("#player-play").click()
        self.assertEqual(self.find("#player-play").text, "Pause")
        WebDriverWait(self.browser, 60).until(
            lambda browser: browser.execute_script("return window.seen.length >= 12"))
        self.find("#player-play").click()
        seen = [[side["frame"] for side in pair] for pair in self.js("return window.seen")]
        for left, right in seen:
            self.assertAlmostEqual(left, right, delta=0.4)
        self.assertGreater(len({round(left) for left, _ in seen}), 6)

    def test_a_frame_is_shown_once_both_films_have_put_it_on_the_screen(self):
        # Frames that films present are recorded before the page's handler runs, since the page
        # registers later.
        self.js("""
            window.seen = [];
            const rate = %d;
            const presented = ["left", "right"].map((side, i) => {
                const video = document.getElementById(`player-${side}-film`);
                const note = (_now, {mediaTime}) => {
                    presented[i] = Math.round(mediaTime * rate);
                    video.requestVideoFrameCallback(note);
                };
                video.requestVideoFrameCallback(note);
                return null;
            });
            const stage = document.getElementById("player-stage");
            let left = performance.now();
            stage.addEventListener("shown", () => {
                window.seen.push({due: Number(stage.dataset.shown), presented: [...presented],
                    milliseconds: performance.now() - left});
                left = performance.now();
                document.getElementById("player-forward").click();
            });
            document.getElementById("player-forward").click();""" % RATE)
        self.wait_for(LAST)
        # The page waits no longer than a second for a film that presents nothing.
        seen = [one for one in self.js("return window.seen") if one["milliseconds"] < 900]
        self.assertGreater(len(seen), 3)
        for one in seen:
            self.assertEqual(one["presented"], [one["due"]] * 2)

    def test_another_film_shows_the_frame_of_the_one_before(self):
        self.find("#player-forward").click()
        self.check_frame(1)
        self.choose("#player-right-choice", "sharp")
        self.check_frame(1)
        self.assertEqual(self.find("#player-right-name").text, "sharp")
        self.choose("#sequence", "second")
        self.check_frame(1)
        left, _ = (side["stripe"] for side in self.js(READ))
        self.assertGreater(left[2], 90)

    def test_goes_on_where_a_film_is_changed_on_its_way_to_a_frame(self):
        # In one task, so that the film that is left never arrives.
        change = ("document.getElementById('player-forward').click();"
                  "const choice = document.getElementById('player-right-choice');"
                  "choice.value = arguments[0]; choice.dispatchEvent(new Event('change'))")
        for frame, choice in enumerate(("sharp", "truth", "gather, 15 samples"), 1):
            self.js(change, choice)
            self.check_frame(frame)
        self.find("#player-stage").send_keys(Keys.END)
        self.check_frame(LAST)

    def test_enlarges_both_alike_and_no_smaller_than_they_are(self):
        transforms = lambda: self.js("return ['left', 'right'].map((side) =>"
                                     "document.getElementById(`player-${side}-film`).style.transform)")
        self.find("#player-nearer").click()
        self.find("#player-nearer").click()
        left, right = transforms()
        self.assertEqual(left, right)
        self.assertTrue(left.startswith("scale(4)"), left)
        self.assertIn("translate(-37.5%, -37.5%)", left)
        for _ in range(4):
            self.find("#player-farther").click()
        self.assertTrue(transforms()[0].startswith("scale(1) translate(0%, 0%)"), transforms()[0])

    def test_lays_one_over_the_other_with_a_line_that_keys_move(self):
        self.find("#player-over").click()
        boxes = self.js("return ['left', 'right'].map((side) => {"
                        "const box = document.getElementById(`player-${side}`).getBoundingClientRect();"
                        "return [box.left, box.top, box.width, box.height]; })")
        for a, b in zip(*boxes):
            self.assertAlmostEqual(a, b, delta=1)
        handle = self.find("#player-handle")
        handle.send_keys(Keys.ARROW_LEFT)
        self.assertEqual(handle.get_attribute("aria-valuenow"), "49")
        self.assertIn("49%", self.js("return document.getElementById('player-right').style.clipPath"))

    # Figures

    def test_says_what_the_truth_is_and_which_frames_have_hdr_flip(self):
        note = self.find("#sequences-note").text
        self.assertIn("256 instants at most", note)
        self.assertIn("HDR-FLIP is the mean over 6 of the frames.", note)

    def test_tells_times_as_medians_over_frames(self):
        about = self.find("#about-body").text
        self.assertIn("Each picture is timed once", about)
        self.assertNotIn("repeats unless", about)

    def test_says_which_method_flickers_less(self):
        self.assertEqual(self.find("#headline").text,
                         "resolved flickers 2.0× less than gather, over 2 sequences.")

    def test_shows_every_measure_of_each_method(self):
        rows = [[cell.text for cell in row.find_elements(By.CSS_SELECTOR, "th, td")]
                for row in self.find_all("#sequences-table tbody tr")]
        self.assertEqual([row[0].split() for row in rows],
                         [["sharp"], ["gather", "15", "samples"], ["resolved", "15", "instants"]])
        self.assertEqual(rows[1][1:4], ["25.0", "30.00", "0.9300"])
        best = [cell.text for cell in self.find_all("#sequences-table td.better")]
        self.assertEqual(best, rows[2][2:], "resolved is ahead in every measure")

    def test_says_what_each_error_costs(self):
        rows = [[cell.text for cell in row.find_elements(By.CSS_SELECTOR, "th, td")]
                for row in self.find_all("#sequences-error tbody tr")]
        self.assertEqual(rows, [["resolved", "18.0 ms (15 instants)", "30.0 ms (15 instants)"],
                                ["gather", "28.0 ms (15 samples)", "reaches 30.00 dB"],
                                ["sharp", "reaches 24.00 dB", "reaches 24.00 dB"]])

    def test_draws_a_curve_of_each_method_over_the_frames(self):
        film = self.results["sequence"]["sequences"][0]
        sets = self.datasets("#sequences-chart")
        for m in film["measurements"]:
            self.assertEqual(sets[m["method"]],
                             [[x, y] for x, y in enumerate(m["curves"]["psnr"])])
        self.choose("#sequence-metric", "hdrFlip")
        sets = self.datasets("#sequences-chart")
        self.assertEqual([x for x, _ in sets["gather"]], [0, 4, 8, 12, 16, 20])
        self.choose("#sequence-metric", "flicker")
        sets = self.datasets("#sequences-chart")
        self.assertEqual(sets["gather"][0][0], 1, "the first frame has none before it")
        self.find('#sequences-legend [data-method="gather"]').click()
        self.assertEqual(set(self.datasets("#sequences-chart")), {"sharp", "resolved"})

