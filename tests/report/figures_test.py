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

    def run_script(self, *arguments, out=None):
        return subprocess.run([sys.executable, SCRIPT, "--out", out or self.page, *arguments],
                              capture_output=True, text=True, check=False)

    def make(self, *arguments):
        result = self.run_script(*arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return self.page.read_text(encoding="utf-8")

    def expect_page(self, *parts, of):
        """\\param of folders of runs and options, or the results of one run"""
        page = self.make(*([self.write("run", of)] if isinstance(of, dict) else of))
        for part in parts:
            self.assertIn(part, page)
        return page

    def expect_refusal(self, sentence, *arguments):
        self.page.write_text("as before", encoding="utf-8")
        result = self.run_script(*arguments)
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, rf"\Afigures: [^\n]*{sentence}[^\n]*\n\Z")
        self.assertEqual(self.page.read_text(encoding="utf-8"), "as before")

    def test_a_shot_has_a_row_per_method_below_the_description_of_its_run(self):
        page = self.expect_page(
            "\n## Suite `paper`\n",
            "\n| method on `vase` | PSNR, dB |\n|---|---|\n",
            "\n| `hybrid` | 31.56 |\n",
            # Methods have their default, and truths the counts that are read.
            "\n| `accumulate`, 16 |", "\n| `accumulate`, 64 |",
            "\n- `shutter bench --suite paper --size 160x90`\n  on 2026-01-01, revision abc1234\n",
            "\nDevice: synthetic device, none.\n",
            "\n160x90 pixels; truth: `accumulate`, 256 samples.\n",
            of=example_results.make("paper"))
        self.assertNotIn("| `accumulate`, 4 |", page)
        self.assertEqual(page.count("\n| `gather`"), 1)

    def test_a_run_is_described_as_it_was(self):
        results = example_results.make("paper")
        results["options"] = ["--suite paper", "--methods gather,hybrid", "--case vase", "--unlit"]
        results["device"]["driver"] = "a driver whose name " + "goes on and on " * 9
        results["revision"]["dirty"] = True
        results["cases"][0]["measurements"][0]["metrics"]["psnr"] = None
        page = self.expect_page(
            "\n- `shutter bench --suite paper --methods gather,hybrid --case vase --unlit`\n",
            "revision abc1234-dirty; synthetic device, a driver whose name ",
            "\n| `sharp` | equal |\n",  # a picture that equals the truth
            of=[self.write("own", results), self.write("other", example_results.make("sequence"))])
        self.assertIn("; synthetic device, none\n", page)  # each run has its device, since they differ
        self.assertLess(max(map(len, page.splitlines())), 121)

    def test_what_a_lens_sees_has_sections_by_shot_with_each_anti_aliasing(self):
        results = smooth(example_results.make("paper"), ["near", "joint"])
        results.update(suite="lens", options=["--suite lens", "--aa none,taa"])
        page = self.expect_page("\n## Suite `lens`\n", of=results)
        linear = page[page.index("\nLinear PSNR, dB:\n"):]
        self.assertIn("\n| `gather` | `none` | 31.16 | 32.16 |\n| `gather` | `taa` | 41.16 | 42.16 |\n", linear)

    def test_times_are_those_of_timed_runs_alone(self):
        paper = self.write("paper", example_results.make("paper"))
        films = self.write("films", example_results.make("sequence"))
        untimed = self.make(paper, films)
        self.assertNotIn(", ms", untimed)
        # The same results give the same file.
        self.assertEqual(untimed, self.make(paper, films))
        page = self.expect_page(
            "\n| method on `vase` | PSNR, dB | frame, ms | effect, ms |\n",
            "\n| `hybrid` | 31.56 | 213.0 | 118.0 |\n",
            "revision abc1234; times on 2 cores of synthetic CPU\n",
            of=["--timed", paper, films])
        self.assertNotIn(", ms", page[page.index("## Suite `sequence`"):])

    def test_several_shots_have_a_table_per_metric_with_a_row_per_anti_aliasing(self):
        page = self.expect_page(
            "\n## Suite `edges`\n", of=smooth(example_results.make("paper"), ["vase", "pan"]))
        linear = page[page.index("\nLinear PSNR, dB:\n"):]
        self.assertIn("\n| method | `--aa` | `vase` | `pan` |\n|---|---|---|---|\n", linear)
        self.assertIn("\n| `gather` | `none` | 31.16 | 32.16 |\n| `gather` | `taa` | 41.16 | 42.16 |\n", linear)
        self.assertNotIn("\nPSNR, dB:\n", page)  # the linear one says as much

    def test_with_several_shots_rows_of_fewer_than_half_are_left_out(self):
        results = smooth(example_results.make("paper"), ["vase", "pan", "orbit"])
        for case in results["cases"]:
            case["measurements"] = [
                m for m in case["measurements"]
                if case["name"].startswith({"gather": "vase", "hybrid": ("vase", "pan")}.get(m["method"], ""))]
        page = self.expect_page("\n| `hybrid` | `taa` | 42.56 | 43.56 |  |\n", of=results)
        self.assertNotIn("| `gather` |", page)

    def test_intermediate_steps_of_the_dial_are_left_out(self):
        results = example_results.make("paper")
        for measurement in results["cases"][0]["measurements"]:
            if measurement["method"] == "mcguire2012":
                measurement["method"] = "adaptive_rays_2"
        self.assertNotIn("adaptive_rays_2", self.expect_page("\n| `gather` |", of=results))

    def test_films_have_a_table_per_measure(self):
        results = example_results.make("sequence")
        results["metrics"].append(
            {"id": "linearPsnr", "name": "Linear PSNR", "unit": "dB", "better": "higher"})
        page = self.expect_page(
            "\nFlicker, camera at rest:\n\n| method | `first` | `second` |\n",
            "\n| `resolved` | 42.00 | 43.00 |\n", of=results)
        self.assertNotIn("Linear PSNR", page)

    def test_a_pixel_filter_that_is_not_the_suites_own_has_its_own_section(self):
        centre, box = (example_results.make("paper") for _ in range(2))
        box["settings"]["pixel"] = "box"
        self.expect_page("\n## Suite `paper`\n", "\n## Suite `paper`, `--pixel box`\n",
                         of=[self.write("centre", centre), self.write("box", box)])

    def test_runs_under_the_same_conditions_share_a_section(self):
        whole = smooth(example_results.make("paper"), ["vase", "pan"])
        parts = [copy.deepcopy(whole), copy.deepcopy(whole)]  # with one description
        for part, wanted in zip(parts, (False, True)):
            for case in part["cases"]:
                case["measurements"] = [m for m in case["measurements"]
                                        if (m["method"] == "gather") == wanted]
        page = self.expect_page(
            "\n| `gather` | `taa` | 41.16 | 42.16 |\n", "\n| `hybrid` | `none` | 32.56 | 33.56 |\n",
            of=[self.write(f"part{i}", part) for i, part in enumerate(parts)])
        self.assertEqual(page.count("\n## "), 1)
        self.assertEqual(page.count("\n- `shutter bench"), 1)

    def test_times_of_a_run_that_is_not_timed_stay_empty_next_to_a_timed_one(self):
        runs = []
        for wanted in ("gather", "hybrid"):
            results = example_results.make("paper")
            case = results["cases"][0]
            case["measurements"] = [m for m in case["measurements"] if m["method"] == wanted]
            runs.append(self.write(wanted, results))
        self.expect_page("\n| `gather` | 30.16 | 146.0 | 51.0 |\n",
                         "\n| `hybrid` | 31.56 |  |  |\n", of=["--timed", *runs])

    def test_a_measurement_in_two_runs_is_refused(self):
        results = example_results.make("paper")
        self.expect_refusal("second: sharp on vase with --aa none is in another run too",
                            self.write("first", results), self.write("second", results))

    def test_results_that_cannot_be_read_are_refused(self):
        no_options, no_metrics = (example_results.make("paper") for _ in range(2))
        del no_options["options"]
        del no_metrics["cases"][0]["measurements"][0]["metrics"]
        for number, (results, sentence) in enumerate((
                (no_options, "results.json lacks `options`"),
                (no_metrics, "does not follow game/bench/results.schema.json: 'metrics'"),
                (example_results.make("hard"), "results.json is incomplete"),
                (example_results.make("scaling"), "is of the suite scaling"),
                ([], "results.json holds no results of shutter bench"),
                ({"schema": "shutter-bench", "version": 1}, "results.json holds no results"))):
            with self.subTest(sentence=sentence):
                self.expect_refusal(sentence, self.write(f"run{number}", results))
        self.expect_refusal("nowhere/results.json cannot be read", self.folder / "nowhere")
        broken = self.folder / "run0"
        (broken / "results.json").write_text("{", encoding="utf-8")
        self.expect_refusal("run0/results.json is not JSON", broken)

    def test_wrong_usage_and_a_page_that_cannot_be_written_are_refused(self):
        result = self.run_script()
        self.assertEqual(result.returncode, 2)
        self.assertIn("give the folder of a run", result.stderr)
        result = self.run_script(self.write("run", example_results.make("paper")), out=self.folder)
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, r"\Afigures: .* cannot be written: [^\n]*\n\Z")


if __name__ == "__main__":
    unittest.main()
