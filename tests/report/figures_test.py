# SPDX-License-Identifier: MIT
"""scripts/figures.py writes the tables of docs/figures.md from results of shutter bench."""

import copy
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import example_results

SCRIPT = pathlib.Path(__file__).parents[2] / "scripts/figures.py"


def smooth(results, shots):
    """Results of a suite with several shots, each with the anti-aliasing none and taa; PSNR in the
    linear picture, too. Figures differ between all of them."""
    results = copy.deepcopy(results)
    results["suite"] = "edges"
    results["options"] = ["--suite edges", "--aa none,taa"]
    results["settings"].update(pixel="box", width=640, height=360)
    results["metrics"].append(
        {"id": "linearPsnr", "name": "Linear PSNR", "unit": "dB", "better": "higher"})
    model = results["cases"][0]
    results["cases"] = []
    for number, shot in enumerate(shots):
        for gain, smoothing in ((0, "none"), (10, "taa")):
            case = copy.deepcopy(model)
            case["name"] = shot if smoothing == "none" else f"{shot}-{smoothing}"
            case["antiAliasing"] = smoothing
            for measurement in case["measurements"]:
                metrics = measurement["metrics"]
                metrics["psnr"] += gain + number
                metrics["linearPsnr"] = metrics["psnr"] + 1
            results["cases"].append(case)
    return results


class Figures(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        self.page = self.folder / "figures.md"

    def write(self, name, results):
        folder = self.folder / name
        folder.mkdir()
        (folder / "results.json").write_text(json.dumps(results), encoding="utf-8")
        return folder

    def run_script(self, *arguments):
        return subprocess.run([sys.executable, SCRIPT, "--out", self.page, *arguments],
                              capture_output=True, text=True, check=False)

    def make(self, *arguments):
        result = self.run_script(*arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return self.page.read_text(encoding="utf-8")

    def expect_refusal(self, sentence, *arguments):
        self.page.write_text("as before", encoding="utf-8")
        result = self.run_script(*arguments)
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, rf"\Afigures: [^\n]*{sentence}[^\n]*\n\Z")
        self.assertEqual(self.page.read_text(encoding="utf-8"), "as before")

    def test_a_shot_has_a_row_per_method_and_a_column_per_metric(self):
        page = self.make(self.write("run", example_results.make("paper")))
        self.assertIn("\n## Suite `paper`\n", page)
        self.assertIn("\n| method on `vase` | PSNR, dB | SSIM | FLIP |\n|---|---|---|---|\n", page)
        self.assertIn("\n| `hybrid` | 31.56 | 0.9841 | 0.0238 |\n", page)

    def test_methods_have_their_default_and_truths_the_counts_that_are_read(self):
        page = self.make(self.write("run", example_results.make("paper")))
        for count in (16, 64):
            self.assertIn(f"\n| `accumulate`, {count} |", page)
        self.assertNotIn("| `accumulate`, 4 |", page)
        self.assertEqual(page.count("\n| `gather`"), 1)

    def test_a_run_is_named_by_command_revision_device_driver_and_day(self):
        page = self.make(self.write("run", example_results.make("paper")))
        self.assertIn("\n- `shutter bench --suite paper --size 160x90`\n  on 2026-01-01, revision abc1234; "
                      "synthetic device, none; times left out\n", page)
        self.assertIn("\n160x90 pixels; truth: `accumulate`, 256 samples.\n", page)

    def test_the_command_has_its_options_as_they_were_given(self):
        results = example_results.make("paper")
        results["options"] = ["--suite paper", "--methods gather,hybrid", "--case vase", "--unlit"]
        self.assertIn("\n- `shutter bench --suite paper --methods gather,hybrid --case vase --unlit`\n",
                      self.make(self.write("run", results)))

    def test_results_without_the_options_of_their_run_are_refused(self):
        results = example_results.make("paper")
        del results["options"]
        self.expect_refusal("results.json lacks `options`", self.write("run", results))

    def test_what_a_lens_sees_has_sections_by_shot_with_each_anti_aliasing(self):
        results = smooth(example_results.make("paper"), ["near", "joint"])
        results.update(suite="lens", options=["--suite lens", "--aa none,taa"])
        page = self.make(self.write("run", results))
        self.assertIn("\n## Suite `lens`\n", page)
        linear, flip = page[page.index("\nLinear PSNR, dB:\n"):].split("\nFLIP:\n")
        self.assertIn("\n| `gather` | `none` | 31.16 | 32.16 |\n| `gather` | `taa` | 41.16 | 42.16 |\n", linear)
        self.assertIn("\n| `gather` | `taa` | 0.0279 | 0.0279 |\n", flip)

    def test_lines_of_a_run_have_at_most_120_columns(self):
        results = example_results.make("paper")
        results["device"]["driver"] = "a driver whose name " + "goes on and on " * 9
        page = self.make(self.write("run", results))
        self.assertLess(max(map(len, page.splitlines())), 121)

    def test_a_revision_with_changes_is_named_so(self):
        results = example_results.make("paper")
        results["revision"]["dirty"] = True
        self.assertIn("revision abc1234 with uncommitted changes; ",
                      self.make(self.write("run", results)))

    def test_times_are_those_of_timed_runs_alone(self):
        paper = self.write("paper", example_results.make("paper"))
        films = self.write("films", example_results.make("sequence"))
        self.assertNotIn(", ms", self.make(paper, films))
        page = self.make("--timed", paper, films)
        self.assertIn("\n| method on `vase` | PSNR, dB | SSIM | FLIP | frame, ms | effect, ms |\n", page)
        self.assertIn("\n| `hybrid` | 31.56 | 0.9841 | 0.0238 | 213.0 | 118.0 |\n", page)
        self.assertIn("times on 2 cores of synthetic CPU\n", page)
        self.assertNotIn(", ms", page[page.index("## Suite `sequence`"):])

    def test_several_shots_have_a_table_per_metric_with_a_row_per_anti_aliasing(self):
        results = smooth(example_results.make("paper"), ["vase", "pan"])
        page = self.make(self.write("run", results))
        self.assertIn("\n## Suite `edges`\n", page)
        psnr, linear = page[page.index("\nPSNR, dB:\n"):].split("\nLinear PSNR, dB:\n")
        self.assertIn("\n| method | `--aa` | `vase` | `pan` |\n|---|---|---|---|\n", psnr)
        self.assertIn("\n| `gather` | `none` | 30.16 | 31.16 |\n| `gather` | `taa` | 40.16 | 41.16 |\n", psnr)
        self.assertIn("\n| `gather` | `taa` | 41.16 | 42.16 |\n", linear)
        self.assertNotIn("SSIM", page)

    def test_films_have_a_table_per_measure(self):
        results = example_results.make("sequence")
        results["metrics"].append(
            {"id": "linearPsnr", "name": "Linear PSNR", "unit": "dB", "better": "higher"})
        page = self.make(self.write("run", results))
        self.assertNotIn("Linear PSNR", page)
        self.assertIn("\nFlicker, camera at rest:\n\n| method | `first` | `second` |\n", page)
        self.assertIn("\n| `resolved` | 42.00 | 43.00 |\n", page)

    def test_a_pixel_filter_that_is_not_the_suites_own_has_its_own_section(self):
        centre, box = (example_results.make("paper") for _ in range(2))
        box["settings"]["pixel"] = "box"
        page = self.make(self.write("centre", centre), self.write("box", box))
        self.assertIn("\n## Suite `paper`\n", page)
        self.assertIn("\n## Suite `paper`, `--pixel box`\n", page)

    def test_a_picture_that_equals_the_truth_is_named_so(self):
        results = example_results.make("paper")
        results["cases"][0]["measurements"][0]["metrics"]["psnr"] = None
        self.assertIn("\n| `sharp` | equal | ", self.make(self.write("run", results)))

    def test_runs_under_the_same_conditions_share_a_section(self):
        whole = smooth(example_results.make("paper"), ["vase", "pan"])
        parts = [copy.deepcopy(whole), copy.deepcopy(whole)]  # with one description
        for part, wanted in zip(parts, (False, True)):
            for case in part["cases"]:
                case["measurements"] = [m for m in case["measurements"]
                                        if (m["method"] == "gather") == wanted]
        page = self.make(*(self.write(f"part{i}", part) for i, part in enumerate(parts)))
        self.assertEqual(page.count("\n## "), 1)
        self.assertEqual(page.count("\n- `shutter bench"), 1)
        self.assertIn("\n| `gather` | `taa` | 40.16 | 41.16 |\n", page)
        self.assertIn("\n| `hybrid` | `none` | 31.56 | 32.56 |\n", page)

    def test_times_of_a_run_that_is_not_timed_stay_empty_next_to_a_timed_one(self):
        runs = []
        for wanted in ("gather", "hybrid"):
            results = example_results.make("paper")
            case = results["cases"][0]
            case["measurements"] = [m for m in case["measurements"] if m["method"] == wanted]
            runs.append(self.write(wanted, results))
        page = self.make("--timed", runs[0], runs[1])
        self.assertIn("\n| `gather` | 30.16 | 0.9810 | 0.0279 | 146.0 | 51.0 |\n", page)
        self.assertIn("\n| `hybrid` | 31.56 | 0.9841 | 0.0238 |  |  |\n", page)

    def test_the_same_results_give_the_same_file(self):
        runs = [self.write(suite, example_results.make(suite)) for suite in ("paper", "sequence")]
        self.assertEqual(self.make(*runs), self.make(*runs))

    def test_a_measurement_in_two_runs_is_refused(self):
        results = example_results.make("paper")
        self.expect_refusal("second: sharp on vase with --aa none is in another run too",
                            self.write("first", results), self.write("second", results))

    def test_a_run_that_was_stopped_is_refused(self):
        self.expect_refusal("results.json is incomplete", self.write("run", example_results.make("hard")))

    def test_a_suite_without_pictures_is_refused(self):
        self.expect_refusal("is of the suite scaling", self.write("run", example_results.make("scaling")))

    def test_a_folder_without_results_is_refused(self):
        self.expect_refusal("nowhere/results.json cannot be read", self.folder / "nowhere")

    def test_other_files_are_refused(self):
        folder = self.folder / "run"
        folder.mkdir()
        for text, sentence in (("{", "is not JSON"), ("[]", "holds no results of shutter bench"),
                               ('{"schema": "shutter-bench", "version": 1}', "holds no results")):
            (folder / "results.json").write_text(text, encoding="utf-8")
            with self.subTest(text=text):
                self.expect_refusal(f"run/results.json {sentence}", folder)

    def test_results_that_lack_a_field_are_refused_with_its_name(self):
        results = example_results.make("paper")
        del results["cases"][0]["measurements"][0]["metrics"]
        self.expect_refusal("does not follow game/bench/results.schema.json: 'metrics'",
                            self.write("run", results))

    def test_no_run_is_an_error_of_usage(self):
        result = self.run_script()
        self.assertEqual(result.returncode, 2)
        self.assertIn("give the folder of a run", result.stderr)

    def test_a_page_that_cannot_be_written_is_refused(self):
        result = subprocess.run(
            [sys.executable, SCRIPT, "--out", self.folder,
             self.write("run", example_results.make("paper"))],
            capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, r"\Afigures: .* cannot be written: [^\n]*\n\Z")


if __name__ == "__main__":
    unittest.main()
