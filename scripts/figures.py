#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes docs/figures.md from what `shutter bench` measured.

usage: figures.py [--out FILE.md] [--timed DIR]... DIR...
Each DIR holds the results.json of a complete run of any suite but scaling. Runs of the same suite, size, pixel
filter and truth share a section and may hold different methods or shots of it. Times are written for the
runs of --timed alone: use it where nothing else kept the machine busy. The same results give the same file.
"""

import argparse
import json
import sys
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SUITES = ("paper", "dial", "hard", "sequence", "edges", "lens", "own")
# Against the mean over the pixel, with each anti-aliasing, by default.
SUITES_WITH_EDGES = ("edges", "lens")
# Of methods whose error falls with each sample, these counts; of all others the default.
SHOWN_COUNTS = {"accumulate": (8, 16, 64), "truth": (1, 16, 64, 256), "denoised": (1, 4)}
# Intermediate steps of the suite dial.
LEFT_OUT = ("hybrid_share_25", "hybrid_share_50", "adaptive_rays_2", "adaptive_rays_50")
# Metrics by their order in a section. Those of pictures and of films share names where they share definitions.
SHOWN_METRICS = ("psnr", "linearPsnr", "flicker", "standingFlicker")
# With many shots each column takes a table, so these are left out there for what says as much.
REPLACED_WITH_MANY_SHOTS = {"psnr": "linearPsnr", "frame": "effect"}
TIMES = {"frame": "frame, ms", "effect": "effect, ms"}
DECIMALS = {"dB": 2, "": 4}
MAX_COLUMNS = 120


class Refusal(Exception):
    """One sentence for the user."""


class Section:
    """The cells of all runs with the same conditions."""

    def __init__(self):
        self.runs = {}  # ordered, without duplicates, as are
        self.truths = {}
        self.shots = {}
        self.rows = {}  # (method, sample count, anti-aliasing) to {(shot, column): text}
        self.columns = {}  # id to heading

    def add(self, source, shot, measurement, smoothing, cells):
        row = self.rows.setdefault((measurement["method"], measurement["samples"], smoothing), {})
        for column, text in cells.items():
            if (shot, column) in row:
                method = measurement["method"]
                raise Refusal(f"{source}: {method} on {shot} with --aa {smoothing} is in another run too")
            row[shot, column] = text
        self.shots[shot] = True


def read_results(folder):
    file = folder / "results.json"
    try:
        results = json.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise Refusal(f"{file} cannot be read: {error.strerror}") from error
    except ValueError as error:
        raise Refusal(f"{file} is not JSON: {error}") from error
    if not isinstance(results, dict) or results.get("schema") != "shutter-bench" or results.get("version") != 2:
        raise Refusal(f"{file} holds no results of shutter bench, version 2")
    if results.get("suite") not in SUITES:
        raise Refusal(f"{file} is of the suite {results.get('suite')}; this script knows {', '.join(SUITES)}")
    if results.get("complete") is not True:
        raise Refusal(f"{file} is incomplete; the same command of shutter bench goes on with it")
    if "options" not in results:
        raise Refusal(f"{file} lacks `options`, the command's: its shutter bench was too old to write them")
    return results


def format_metric(value, unit):
    # A null is a picture that equals the truth.
    return "equal" if value is None else f"{value:.{DECIMALS.get(unit, 4)}f}"


def is_shown(measurement):
    if measurement["method"] in LEFT_OUT:
        return False
    counts = SHOWN_COUNTS.get(measurement["method"])
    # Films have no sweep, so nothing there is marked as a default.
    return measurement.get("isDefault", True) if counts is None else measurement["samples"] in counts


def list_entries(results):
    """Triples of a shot or film, its name without the anti-aliasing, and that."""
    for entry in results["cases"] + results.get("sequences", []):
        smoothing = entry.get("antiAliasing", "none")
        name = entry["name"]
        yield entry, name.removesuffix(f"-{smoothing}") if smoothing != "none" else name, smoothing


def describe_pixel(suite, pixel):
    """The option of a pixel filter that is not the suite's own."""
    return [f"--pixel {pixel}"] if (pixel == "box") != (suite in SUITES_WITH_EDGES) else []


def describe_device(results):
    return f"{results['device']['name']}, {results['device']['driver']}"


def describe_run(results, is_timed, has_device):
    revision, machine = results["revision"], results["machine"]
    changed = "-dirty" if revision["dirty"] else ""
    conditions = [f"on {results['created'][:10]}, revision {revision['git']}{changed}"]
    if has_device:
        conditions.append(describe_device(results))
    if is_timed:
        conditions.append(f"times on {machine['cores']} cores of {machine['cpu']}")
    return "\n  ".join([f"- `{' '.join(['shutter bench', *results['options']])}`",
                        *textwrap.wrap("; ".join(conditions), MAX_COLUMNS - 2, break_on_hyphens=False)])


def describe_truth(entry):
    truth = entry["truth"]
    if "maxStepPx" not in truth:
        return f"`{truth['method']}`, {truth['samples']} samples"
    if truth["maxStepPx"] is None:
        return f"`{truth['method']}`, {truth['mostInstants']} samples in each frame"
    return f"`{truth['method']}`, up to {truth['mostInstants']} samples, {truth['maxStepPx']} px apart"


def add_run(sections, folder, results, is_timed, has_device):
    settings = results["settings"]
    size = f"{settings['width']}x{settings['height']}"
    key = (results["suite"], settings["pixel"], size, settings.get("truthSamples"))
    section = sections.setdefault(key, Section())
    section.runs[describe_run(results, is_timed, has_device)] = True
    # Films have metrics of their own, although the results list those of pictures too.
    metrics = {metric["id"]: metric for metric in results.get("temporalMetrics") or results["metrics"]}
    shown = [metrics[name] for name in SHOWN_METRICS if name in metrics]
    for metric in shown:
        unit = f", {metric['unit']}" if metric["unit"] else ""
        section.columns.setdefault(metric["id"], metric["name"] + unit)
    if is_timed:
        section.columns.update(TIMES)
    for entry, shot, smoothing in list_entries(results):
        section.truths[describe_truth(entry)] = True
        for measurement in filter(is_shown, entry["measurements"]):
            values = measurement["metrics"]
            cells = {metric["id"]: format_metric(values[metric["id"]], metric["unit"])
                     for metric in shown if metric["id"] in values}
            if is_timed:
                cells |= {name: f"{measurement['milliseconds'][name]['median']:.1f}" for name in TIMES}
            section.add(folder, shot, measurement, smoothing, cells)


def list_rows(section):
    """Those that hold half of the shots or more: by methods as they were measured, then by sample counts;
    anti-aliasing as it was measured."""
    methods = list(dict.fromkeys(method for method, _, _ in section.rows))
    smoothings = list(dict.fromkeys(smoothing for _, _, smoothing in section.rows))
    rows = [key for key, row in section.rows.items()
            if 2 * len({shot for shot, _ in row}) >= len(section.shots)]
    return sorted(rows, key=lambda row: (methods.index(row[0]), row[1] or 0, smoothings.index(row[2])))


def table_lines(section, corner, headings, keys):
    """A table whose columns are headings, filled by the cells that keys name."""
    has_smoothing = len({smoothing for _, _, smoothing in section.rows}) > 1
    head = [corner] + (["`--aa`"] if has_smoothing else []) + headings
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    for method, samples, smoothing in list_rows(section):
        row = section.rows[method, samples, smoothing]
        label = f"`{method}`" + (f", {samples}" if method in SHOWN_COUNTS else "")
        cells = [label] + ([f"`{smoothing}`"] if has_smoothing else []) + [row.get(key, "") for key in keys]
        lines.append("| " + " | ".join(cells) + " |")
    return lines


def section_lines(key, section):
    suite, pixel, size, _ = key
    lines = ["## Suite " + ", ".join(f"`{word}`" for word in [suite, *describe_pixel(suite, pixel)]), ""]
    lines += [f"{size} pixels; truth: {' or '.join(section.truths)}.", "", *section.runs, ""]
    shots = list(section.shots)
    if len(shots) == 1:
        columns = list(section.columns)
        lines += table_lines(section, f"method on `{shots[0]}`", [section.columns[name] for name in columns],
                             [(shots[0], name) for name in columns])
        return lines + [""]
    for name, heading in section.columns.items():
        if REPLACED_WITH_MANY_SHOTS.get(name) in section.columns:
            continue
        lines += [f"{heading}:", ""]
        lines += table_lines(section, "method", [f"`{shot}`" for shot in shots], [(shot, name) for shot in shots])
        lines.append("")
    return lines


def make_page(folders, timed):
    sections = {}
    runs = [(folder, read_results(folder)) for folder in folders]
    devices = {describe_device(results) for _, results in runs}
    for folder, results in runs:
        try:
            add_run(sections, folder, results, folder in timed, len(devices) > 1)
        except (KeyError, TypeError, AttributeError) as error:
            file = folder / "results.json"
            raise Refusal(f"{file} does not follow game/bench/results.schema.json: {error}") from error
    lines = [
        "# Figures",
        "",
        "Written by `scripts/figures.py` from the results of the runs that each section names; change nothing here.",
        "[Measuring](measuring.md#numbers) has the commands, [bench](../game/bench/README.md) what they measure. A",
        "method followed by N has N samples per pixel, the others their default. Methods that a suite has in fewer",
        "than half of its shots are left out, as are intermediate steps of the suite `dial`.",
        "",
    ]
    if len(devices) == 1:
        lines += [f"Device: {devices.pop()}.", ""]
    for key, section in sections.items():
        lines += section_lines(key, section)
    return "\n".join(lines).rstrip("\n") + "\n"


def main():
    parser = argparse.ArgumentParser(usage="figures.py [--out FILE.md] [--timed DIR]... DIR...")
    parser.add_argument("--out", type=Path, default=ROOT / "docs/figures.md", help="default: docs/figures.md")
    parser.add_argument("--timed", type=Path, action="append", default=[], help="a run whose times are written")
    parser.add_argument("folders", type=Path, nargs="*", metavar="DIR", help="folder of a run's results.json")
    arguments = parser.parse_args()
    folders = arguments.timed + arguments.folders
    if not folders:
        parser.error("give the folder of a run")
    try:
        page = make_page(folders, arguments.timed)
        arguments.out.write_text(page, encoding="utf-8")
    except Refusal as refusal:
        sys.exit(f"figures: {refusal}")
    except OSError as error:
        sys.exit(f"figures: {arguments.out} cannot be written: {error.strerror}")


if __name__ == "__main__":
    main()
