# SPDX-License-Identifier: MIT
"""Prints the tables of scripts/gpu_report.sh:
gpu_report_tables.py FOLDER SHOT... -- METHOD... -- SIZE...

The folder holds SHOT_METHOD_SIZE.json of `render --stats`, or SHOT_METHOD_SIZE.error with what the
program said instead, and blur_SIZE.stats of oiiotool.
"""

import json
import pathlib
import re
import sys

MEBIBYTE = 1024 * 1024
# The shot whose passes have rows.
DETAILED = "courtyard"


def read_statistics(folder, shot, method, size):
    file = folder / f"{shot}_{method}_{size}.json"
    return json.loads(file.read_text(encoding="utf-8")) if file.exists() else None


def read_failure(folder, method, size):
    file = folder / f"{DETAILED}_{method}_{size}.error"
    lines = file.read_text(encoding="utf-8").splitlines() if file.exists() else []
    return lines[-1] if lines else "it was not measured"


def describe_blur(folder, size):
    """Longest and mean length of the motion, pixels."""
    file = folder / f"blur_{size}.stats"
    if not file.exists():
        return "not known"
    found = dict(re.findall(r"Stats (Max|Avg): (\S+)", file.read_text(encoding="utf-8")))
    if len(found) < 2:
        return "not known"
    return f"{float(found['Max']):.1f} / {float(found['Avg']):.2f}"


def describe_mask(statistics):
    masked = statistics["pictures"][0]["counters"].get("pixels masked")
    if masked is None:
        return "-"
    return f"{100 * masked / (statistics['width'] * statistics['height']):.2f}"


def list_passes(measured):
    """Names and owners in the order of the first size that has them."""
    names = {}
    for statistics in measured.values():
        for each in statistics["pictures"][0]["passes"]:
            names.setdefault(each["name"], each["owner"])
    return names


def time_of(statistics, name):
    times = [each["gpu_ms"] for each in statistics["pictures"][0]["passes"] if each["name"] == name]
    return f"{sum(times):.3f}" if times else "-"


def time_of_owner(statistics, owner):
    return sum(each["gpu_ms"] for each in statistics["pictures"][0]["passes"]
               if each["owner"] == owner)


def print_row(*cells):
    print("| " + " | ".join(str(cell) for cell in cells) + " |")


def print_sums(folder, shots, methods, sizes):
    print("## Sums\n\nms of the blur's own passes, as in modules/motion_blur/gpu.md.\n")
    print_row("shot", "method", *sizes)
    print_row("---", "---", *("---:" for _ in sizes))
    for shot in shots:
        for method in methods:
            measured = [read_statistics(folder, shot, method, size) for size in sizes]
            print_row(shot, method, *(f"{time_of_owner(each, 'blur'):.3f}" if each else "-"
                                      for each in measured))
    print()


def print_method(folder, method, sizes):
    measured = {size: read_statistics(folder, DETAILED, method, size) for size in sizes}
    missing = [size for size, statistics in measured.items() if not statistics]
    measured = {size: statistics for size, statistics in measured.items() if statistics}
    print(f"## {method}\n")
    for size in missing:
        print(f"Not at {size}: {read_failure(folder, method, size)}\n")
    if not measured:
        return
    any_of = next(iter(measured.values()))
    print(f"{any_of['device']}, {any_of['driver']}; {any_of['samples']} samples, exposure "
          f"{any_of['exposure_s']:.4f} s, medians of {any_of['repeat']}.\n")
    print_row("ms of GPU time", "owner", *measured)
    print_row("---", "---", *("---:" for _ in measured))
    for name, owner in list_passes(measured).items():
        print_row(name, owner, *(time_of(one, name) for one in measured.values()))
    print_row("**effect**", "",
              *(f"**{time_of_owner(one, 'blur'):.3f}**" for one in measured.values()))
    print_row("transient images, MiB", "",
              *(f"{one['pictures'][0]['transient_bytes'] / MEBIBYTE:.1f}"
                for one in measured.values()))
    print_row("masked pixels, %", "", *(describe_mask(one) for one in measured.values()))
    print_row("longest / mean blur, px", "", *(describe_blur(folder, size) for size in measured))
    print()


def main():
    folder, *arguments = sys.argv[1:]
    folder = pathlib.Path(folder)
    lists = [[]]
    for argument in arguments:
        if argument == "--":
            lists.append([])
        else:
            lists[-1].append(argument)
    shots, methods, sizes = lists
    print_sums(folder, shots, methods, sizes)
    for method in methods:
        print_method(folder, method, sizes)


if __name__ == "__main__":
    main()
