# SPDX-License-Identifier: MIT
"""The report page in headless Chromium: what it draws and states is what the results hold."""

import json
import statistics
import subprocess
import unittest

import example_results
from page_case import CHART, MAKE_PAGE, PageCase, By
from pictures_test import Pictures  # which run in this program's browser
from sequence_test import Sequence


def find_front(points, higher):
    """(time, value) pairs that no other beats: quadratic, and so another way than the page's."""
    def beats(a, b):
        better = a[1] > b[1] if higher else a[1] < b[1]
        as_good = better or a[1] == b[1]
        return (a[0] <= b[0] and better) or (a[0] < b[0] and as_good)
    return sorted(p for p in points if not any(beats(q, p) for q in points))


class Page(PageCase):
    def expected_points(self, case, metric, time="frame"):
        points = {}
        for m in sorted(case["measurements"], key=lambda m: m["samples"] or 0):
            points.setdefault(m["method"], []).append(
                [m["milliseconds"][time]["median"], m["metrics"][metric]])
        return points

    def show_all_methods(self):
        for button in self.find_all('#tradeoff-legend [aria-pressed="false"]'):
            button.click()

    # The whole page

    def test_asks_nothing_of_the_network(self):
        for suite in self.results:
            self.open(suite)
            requested = self.js("return performance.getEntriesByType('resource').map((e) => e.name)")
            self.assertEqual([name for name in requested if not name.startswith("data:")], [])
            self.assertTrue(self.js("return [...document.images].every((i) => i.naturalWidth)"))

    def test_keeps_the_licence_of_what_it_includes(self):
        text = (self.folder / "paper/index.html").read_text(encoding="utf-8")
        self.assertIn("Released under the MIT License", text)

    def test_shows_sections_that_have_data_and_no_others(self):
        expected = {
            "paper": {"ladder", "tradeoff", "pictures", "slider", "tables", "equal-time", "about"},
            "hard": {"ladder", "tradeoff", "matrix", "pictures", "slider", "equal-time", "about"},
            "scaling": {"scaling", "about"},
            "sequence": {"sequences", "player", "about"},
        }
        for suite, sections in expected.items():
            self.open(suite)
            shown = {s.get_attribute("id") for s in self.find_all("section") if s.is_displayed()}
            self.assertEqual(shown, sections)
            links = {a.get_attribute("href").split("#")[1] for a in self.find_all("#contents a")}
            self.assertEqual(links, sections)

    def test_fits_1000_pixels_in_either_theme(self):
        for suite in self.results:
            for theme in ("light", "dark"):
                self.open(suite, width=1000, theme=theme)
                widths = self.js("const e = document.documentElement;"
                                 "return [e.scrollWidth, e.clientWidth]")
                self.assertLessEqual(widths[0], widths[1], f"{suite}, {theme}")

    def test_takes_the_theme_that_the_reader_asks_for(self):
        colors = {}
        for theme in ("light", "dark"):
            self.open("paper", theme=theme)
            colors[theme] = self.js(
                "return [getComputedStyle(document.body).backgroundColor,"
                " Chart.getChart('tradeoff-chart').options.scales.x.grid.color]")
        self.assertNotEqual(colors["light"][0], colors["dark"][0])
        self.assertNotEqual(colors["light"][1], colors["dark"][1])

    def test_prints_without_cutting_tables(self):
        for suite in self.results:
            # A4 between margins of 1 cm, in CSS pixels.
            self.open(suite, width=718, media="print")
            wide = self.js("return [...document.querySelectorAll('table')].filter((t) =>"
                           "t.getBoundingClientRect().right > innerWidth).map((t) => t.innerText)")
            self.assertEqual(wide, [])

    def test_prints_on_white_and_returns(self):
        self.open("paper", theme="dark")
        grid = "return Chart.getChart('tradeoff-chart').options.scales.x.grid.color"
        dark = self.js(grid)
        self.js("dispatchEvent(new Event('beforeprint'))")
        self.assertNotEqual(self.js(grid), dark)
        self.js("dispatchEvent(new Event('afterprint'))")
        self.assertEqual(self.js(grid), dark)

    # Results that hold little, or too little

    def make_page(self, name, change):
        results = example_results.make("paper")
        for case in results["cases"]:
            case["crops"] = []
            del case["truth"]["image"]
            for m in case["measurements"]:
                m.pop("image", None)
                m.pop("errorMap", None)
        for row in results["equalTime"][0]["rows"]:
            row.pop("image", None)
        change(results)
        (self.folder / name).mkdir()
        (self.folder / name / "results.json").write_text(json.dumps(results), encoding="utf-8")
        subprocess.run([*MAKE_PAGE, self.folder / name], check=True)
        self.open(name, ready=name != "broken")

    def shown(self):
        return {s.get_attribute("id") for s in self.find_all("section") if s.is_displayed()}

    def test_a_run_without_cases_says_so(self):
        self.make_page("empty", lambda r: r.update(cases=[], equalTime=[], paper={
            "source": "nowhere", "case": "vase", "method": "hybrid"}))
        self.assertEqual(self.find("#headline").text, "No figures were taken.")
        self.assertEqual(self.shown(), {"about"})

    def test_a_case_without_pictures_has_no_empty_sections(self):
        self.make_page("plain", lambda r: None)
        self.assertEqual(self.shown(), {"ladder", "tradeoff", "tables", "equal-time", "about"})

    def test_one_measurement_is_drawn(self):
        def keep_one(results):
            case = results["cases"][0]
            case["measurements"] = [m for m in case["measurements"] if m["method"] == "sharp"]
            results.update(equalTime=[])
        self.make_page("single", keep_one)
        self.assertEqual(self.datasets()["sharp"], [[100, 22]])
        self.assertEqual(self.find("#headline").text, "1 measurement over 1 case.")

    def test_pictures_equal_to_the_truth_are_listed_and_not_drawn(self):
        def equalize(results):
            for m in results["cases"][0]["measurements"]:
                m["metrics"].update(psnr=None, ssim=1, flip=0)
        self.make_page("equal", equalize)
        drawn = self.datasets()
        self.assertEqual([p for points in drawn.values() for p in points], [])
        self.assertIn("hybrid, 15 samples (equal to the truth", self.find(
            "#tradeoff-omitted").text)
        self.assertIn("∞", self.find("#ladder-table").text)
        self.choose("#metric", "flip")
        self.assertEqual(len(self.datasets()["hybrid"]), 5)

    def test_says_what_is_wrong_with_results_it_cannot_draw(self):
        self.make_page("broken", lambda r: r.pop("device"))
        self.assertIn("could not be drawn in full", self.find("#failure").text)
        self.assertEqual(len(self.browser.get_log("browser")), 1)

    def test_a_dial_has_a_line_per_case_by_its_methods_and_one_of_the_truth(self):
        self.make_page("dial", lambda results: results.update(suite="dial"))
        self.assertIn("dial", self.shown())
        results = example_results.make("paper")
        case = results["cases"][0]
        points = self.expected_points(case, "psnr")
        drawn = self.datasets("#dial-chart")
        names = [m["name"] for m in results["methods"]]
        self.assertEqual(drawn[case["title"]],
                         [p for name in names if name != "truth" for p in points.get(name, [])])
        self.assertEqual(drawn[f"{case['title']}, truth"], points["truth"])
        self.choose("#time", "effect")
        points = self.expected_points(case, "psnr", "effect")
        self.assertEqual(self.datasets("#dial-chart")[f"{case['title']}, truth"], points["truth"])

    # Sentences

    def test_headline_has_the_figures_of_the_results(self):
        self.open("paper")
        case = self.results["paper"]["cases"][0]
        pair = {m["method"]: m for m in case["measurements"] if m["isDefault"]}
        hybrid, gather = pair["hybrid"], pair["gather"]
        gain = hybrid["metrics"]["psnr"] - gather["metrics"]["psnr"]
        ratio = (hybrid["milliseconds"]["frame"]["median"] /
                 gather["milliseconds"]["frame"]["median"])
        self.assertEqual(self.find("#headline").text,
                         f"hybrid gains {gain:.1f} dB over gather for {ratio:.1f}× its time.")

    def test_lede_names_the_next_step_and_the_rays_that_the_time_buys(self):
        self.open("paper")
        case = self.results["paper"]["cases"][0]
        hybrid = next(m for m in case["measurements"]
                      if m["method"] == "hybrid" and m["isDefault"])
        time = lambda m: m["milliseconds"]["frame"]["median"]
        rivals = [m for m in case["measurements"] if m["method"] not in ("hybrid", "accumulate")
                  and m["metrics"]["psnr"] > hybrid["metrics"]["psnr"]]
        best = min(rivals, key=time)
        truth = next(r for r in self.results["paper"]["equalTime"][0]["rows"]
                     if r["method"] == "truth")
        text = self.find("#lede").text
        ratio = time(best) / time(hybrid)
        self.assertIn(f"{best['method']}, {best['samples']} rays, reaches "
                      f"{best['metrics']['psnr']:.1f} dB for {ratio:.1f}×", text)
        self.assertIn("In the time of hybrid, truth traces 1 ray per pixel and reaches "
                      f"{truth['metrics']['psnr']:.1f} dB", text)

    def test_lede_says_where_one_ray_takes_longer_than_there_is_time(self):
        def slow(results):
            entry = results["equalTime"][0]
            row = next(r for r in entry["rows"] if r["method"] == "truth")
            row["milliseconds"] = 3.2 * entry["reference"]["milliseconds"]

        self.make_page("slow-truth", slow)
        self.assertIn("Even 1 ray per pixel of truth takes 3.2× the time of hybrid, and reaches ",
                      self.find("#lede").text)

    def test_headline_over_many_cases_is_a_median(self):
        self.open("hard")
        gains = []
        for case in self.results["hard"]["cases"]:
            pair = {m["method"]: m["metrics"]["psnr"] for m in case["measurements"]
                    if m["isDefault"]}
            gains.append(pair["hybrid"] - pair["gather"])
        wins = sum(g > 0 for g in gains)
        text = self.find("#headline").text
        self.assertIn(f"Over 12 cases, hybrid gains a median of {statistics.median(gains):.1f} dB",
                      text)
        self.assertIn(f"(better in {wins})", text)

    def test_headline_of_scaling_tells_the_growth(self):
        self.open("scaling")
        self.assertIn("From 640x360 to 3840x2160, the time of hybrid grows 30×, as pixels to the "
                      "power of 0.95", self.find("#headline").text)

    def test_says_when_a_run_was_stopped(self):
        self.open("hard")
        self.assertTrue(self.find("#incomplete").is_displayed())
        self.open("paper")
        self.assertFalse(self.find("#incomplete").is_displayed())

    def test_text_of_the_results_stays_text(self):
        self.open("paper")
        self.assertIn("no rays </script>", self.find("#about-body").text)

    # Error against time

    def test_what_made_the_truth_is_hidden_at_first(self):
        self.open("paper")
        self.assertNotIn("accumulate", self.datasets())
        self.assertIn("accumulate made the truth", self.find("#tradeoff-note").text)
        row = next(row for row in self.find_all("#ladder-table tbody tr")
                   if row.text.startswith("accumulate"))
        self.assertIn("it made the truth", row.text)
        self.assertNotIn("accumulate", self.find("#lede").text)

    def test_tradeoff_has_every_point_for_every_metric_and_time(self):
        self.open("paper")
        self.show_all_methods()
        case = self.results["paper"]["cases"][0]
        for metric in ("psnr", "ssim", "flip"):
            for time in ("frame", "effect"):
                self.choose("#metric", metric)
                self.choose("#time", time)
                drawn = self.datasets()
                front = drawn.pop("Pareto front")
                expected = self.expected_points(case, metric, time)
                if time == "effect":
                    self.assertEqual(drawn["sharp"], [], "0 ms has no place on a logarithm")
                    self.assertIn("sharp", self.find("#tradeoff-omitted").text)
                    expected["sharp"] = []
                self.assertEqual(drawn, expected)
                every = [tuple(p) for points in expected.values() for p in points]
                self.assertEqual([tuple(p) for p in front], find_front(every, metric != "flip"))

    def test_lists_the_members_of_the_front(self):
        self.open("paper")
        front = self.datasets()["Pareto front"]
        rows = self.find_all("#tradeoff-front tbody tr")
        self.assertEqual(len(rows), len(front))
        for row, (_, value) in zip(rows, front):
            self.assertIn(f"{value:.2f}", row.text)

    def test_legend_hides_and_shows_methods(self):
        self.open("paper")
        self.show_all_methods()
        case = self.results["paper"]["cases"][0]
        button = '#tradeoff-legend [data-method="accumulate"]'
        self.find(button).click()
        self.assertEqual(self.find(button).get_attribute("aria-pressed"), "false")
        drawn = self.datasets()
        self.assertNotIn("accumulate", drawn)
        expected = self.expected_points(case, "psnr")
        del expected["accumulate"]
        every = [tuple(p) for points in expected.values() for p in points]
        self.assertEqual([tuple(p) for p in drawn["Pareto front"]], find_front(every, True))
        self.find(button).click()
        self.assertIn("accumulate", self.datasets())

    def test_methods_differ_by_color_and_marker(self):
        self.open("paper")
        self.show_all_methods()
        marks = self.js(CHART + ".map((s) => [s.borderColor, s.pointStyle, s.pointRotation,"
                        "s.pointBackgroundColor === s.pointBorderColor].join())", "#tradeoff-chart")
        self.assertEqual(len(set(marks)), len(marks))
        colors = self.js(CHART + ".map((s) => s.borderColor)", "#tradeoff-chart")
        self.assertEqual(len(set(colors)), len(colors))

    def test_points_carry_quartiles(self):
        self.open("paper")
        drawn = self.js(CHART + ".find((s) => s.label === 'hybrid').data.map((p) => p.quartiles)",
                        "#tradeoff-chart")
        expected = [[m["milliseconds"]["frame"][q] for q in ("q1", "q3")]
                    for m in self.results["paper"]["cases"][0]["measurements"]
                    if m["method"] == "hybrid"]
        self.assertEqual(drawn, expected)

    def test_another_case_draws_its_points(self):
        self.open("hard")
        cases = self.results["hard"]["cases"]
        self.show_all_methods()
        self.choose("#case", "case7")
        drawn = self.datasets()
        del drawn["Pareto front"]
        self.assertEqual(drawn, self.expected_points(cases[7], "psnr"))
        self.assertIn(cases[7]["title"], self.find("#tradeoff-note").text)

    # Matrix, ladder, tables, equal time

    def test_ladder_has_a_row_for_each_method_by_rising_time(self):
        self.open("paper")
        rows = self.find_all("#ladder-table tbody tr")
        defaults = [m for m in self.results["paper"]["cases"][0]["measurements"] if m["isDefault"]]
        defaults.sort(key=lambda m: m["milliseconds"]["frame"]["median"])
        names = [row.find_element(By.CSS_SELECTOR, "th").text.split()[0] for row in rows]
        self.assertEqual(names, [m["method"] for m in defaults])

    def test_a_method_without_its_default_keeps_a_row_with_a_dash_and_the_reason(self):
        def skip_denoised(results):
            for case in results["cases"]:
                case["measurements"] = [m for m in case["measurements"]
                                        if (m["method"], m["isDefault"]) != ("denoised", True)]
                case["skipped"].append({"method": "denoised", "samples": 1,
                                        "reason": "the device traces no ray queries"})

        self.make_page("skipped", skip_denoised)
        rows = self.find_all("#ladder-table tbody tr")
        self.assertTrue(rows[-1].text.startswith("denoised"), rows[-1].text)
        self.assertIn("not measured: the device traces no ray queries", rows[-1].text)
        self.assertIn("–", rows[-1].text)
        self.assertEqual(sum("not measured" in row.text for row in rows), 1)

    def test_matrix_has_every_case_and_method_and_frames_the_best(self):
        self.open("hard")
        for metric, pick, decimals in (("psnr", max, 2), ("flip", min, 4)):
            self.choose("#metric", metric)
            rows = self.find_all("#matrix-table tbody tr")
            cases = self.results["hard"]["cases"]
            self.assertEqual(len(rows), len(cases))
            for row, case in zip(rows, cases):
                defaults = {m["method"]: m["metrics"][metric] for m in case["measurements"]
                            if m["isDefault"]}
                values = list(defaults.values())
                # It made the truth.
                del defaults["accumulate"]
                cells = [float(c.text) for c in row.find_elements(By.CSS_SELECTOR, "td")]
                self.assertEqual(len(cells), len(values))
                best = float(row.find_element(By.CSS_SELECTOR, ".best").text)
                for shown, value in zip([*cells, best], [*values, pick(defaults.values())]):
                    self.assertAlmostEqual(shown, value, delta=0.51 * 10 ** -decimals)

    def test_matrix_chooses_a_case(self):
        self.open("hard")
        self.find("#matrix-table tbody tr:nth-child(4) button").click()
        self.assertEqual(self.find("#case").get_attribute("value"), "case3")

    def test_tables_have_printed_figures_and_ours(self):
        self.open("paper")
        defaults = {m["method"]: m for m in self.results["paper"]["cases"][0]["measurements"]
                    if m["isDefault"]}
        text = self.find("#tables-body").text
        for printed in ("24.20", "12.32", "25.69", "0.91", "0.68", "0.92", "9.92", "205"):
            self.assertIn(printed, text)
        hybrid = self.find("#tables-body tbody tr:nth-child(3)").text
        self.assertIn(f"{defaults['hybrid']['metrics']['psnr']:.2f}", hybrid)
        gain = defaults["hybrid"]["metrics"]["psnr"] - defaults["gather"]["metrics"]["psnr"]
        self.assertIn(f"PSNR printed +1.49 dB, ours +{gain:.2f} dB", text)
        rows = {row.find_element(By.CSS_SELECTOR, "th").text:
                row.find_elements(By.CSS_SELECTOR, "td.ours")[0].text
                for row in self.find_all("#tables-body .printed tbody tr")}
        passes = {p["name"]: p["median"] for p in defaults["hybrid"]["passes"]}
        self.assertEqual(rows["Ray Mask"], f"{passes['edge'] + passes['ray mask']:.1f}")
        self.assertEqual(rows["Others"], f"{passes['read ray mask counters']:.2f}")
        self.assertEqual(rows["Total Duration"],
                         f"{defaults['hybrid']['milliseconds']['frame']['median']:.0f}")

    def test_equal_time_has_every_rival_best_first(self):
        self.open("paper")
        entry = self.results["paper"]["equalTime"][0]
        for metric, reverse in (("psnr", True), ("flip", False)):
            self.choose("#metric", metric)
            names = [row.find_element(By.CSS_SELECTOR, "th").text.split()[0]
                     for row in self.find_all("#equal-time-table tbody tr")]
            expected = sorted(entry["rows"], key=lambda r: r["metrics"][metric], reverse=reverse)
            self.assertEqual(names, [row["method"] for row in expected])

    # Scaling

    def test_scaling_has_every_point_and_the_fits_of_either_time(self):
        self.open("scaling")
        for time in ("frame", "effect"):
            self.choose("#time", time)
            for axis in self.results["scaling"]["scaling"]:
                drawn = self.datasets(f"#scaling-{axis['axis']}")
                for series in axis["series"]:
                    points = [[p["value"], p["milliseconds"][time]["median"]]
                              for p in series["points"]]
                    self.assertEqual(drawn.pop(series["method"]), points)
                    if "fit" not in series:
                        continue
                    fit = series["fit"][time]
                    line = drawn.pop(f"{series['method']}, fit")
                    self.assertEqual([line[0][0], line[1][0]], [fit["from"], fit["to"]])
                    self.assertAlmostEqual(line[1][1] / points[-1][1], 1, delta=0.01)
                self.assertEqual(drawn, {})

    def test_an_axis_that_holds_0_is_linear(self):
        self.open("scaling")
        kinds = {axis: self.js("return Chart.getChart(arguments[0]).options.scales.x.type",
                               f"scaling-{axis}") for axis in ("resolution", "moving")}
        self.assertEqual(kinds, {"resolution": "logarithmic", "moving": "linear"})


if __name__ == "__main__":
    unittest.main()
