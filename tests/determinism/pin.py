#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Pins what the methods write on this machine's driver; README.md explains when.

usage: pin.py EXECUTABLE GENERATOR
Each shot is drawn several times, with main memory that holds something else before it is written
to: what depends on that cannot be pinned.
"""

import json
import sys
import tempfile

import traces

# Values of MALLOC_PERTURB_ (mallopt(3)): bytes that fresh memory is filled with.
FILLINGS = ("0", "85", "170")


def find_difference(runs):
    """A sentence about the first picture that differs between two runs; None where none does."""
    for run in runs[1:]:
        for picture, trace in runs[0]["traces"].items():
            whole = [[row for row in images if row["image"] not in traces.PARTLY_WRITTEN]
                     for images in (trace, run["traces"][picture])]
            if difference := traces.find_difference(*whole):
                return f"{picture}: two runs differ: {difference}"
        if runs[0]["pictures"] != run["pictures"]:
            return "two runs of a film differ"
    return None


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__.strip())
    executable, generator = sys.argv[1:]
    with tempfile.TemporaryDirectory(prefix="shutter_pin_") as assets:
        traces.generate(generator, assets)
        runs = [traces.draw_all(executable, assets, environment={"MALLOC_PERTURB_": filling})
                for filling in FILLINGS]
    if difference := find_difference(runs):
        sys.exit(difference)
    pins = {**traces.read_pins(), runs[0]["driver"]: runs[0]["pictures"]}
    traces.PINS.write_text(json.dumps(pins, indent=1) + "\n", encoding="utf-8")
    if traces.DEVICE == "llvmpipe":
        traces.EXPLANATIONS.write_text(traces.write_explanations(runs[0]["explained"]),
                                       encoding="utf-8")


if __name__ == "__main__":
    main()
