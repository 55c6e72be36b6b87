#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Pins what every method writes on this machine's driver; README.md explains when.

usage: pin.py EXECUTABLE ASSETS
Each method is drawn several times, with main memory that holds something else before it is written
to: what depends on that cannot be pinned.
"""

import json
import sys

import traces

# Values of MALLOC_PERTURB_ (mallopt(3)): bytes that fresh memory is filled with.
FILLINGS = ("0", "85", "170", "0")


def pin(executable, assets, method):
    """The driver and the hash of the method's images."""
    runs = [traces.draw(executable, assets, method, environment={"MALLOC_PERTURB_": filling})
            for filling in FILLINGS]
    for run in runs[1:]:
        if difference := traces.find_difference(
                *([row for row in images if row["image"] not in traces.PARTLY_WRITTEN]
                  for images in (runs[0]["images"], run["images"]))):
            sys.exit(f"{method}: two runs differ: {difference}")
    return runs[0]["driver"], traces.hash_all(runs[0]["images"])


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__.strip())
    pins = traces.read_pins()
    methods = {}
    for method in traces.list_methods(sys.argv[1]):
        driver, methods[method] = pin(*sys.argv[1:], method)
    pins[driver] = methods
    traces.PINS.write_text(json.dumps(pins, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
