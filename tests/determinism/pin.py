#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Pins what every pass writes on this machine's driver; README.md says when.

usage: pin.py EXECUTABLE ASSETS
Each method is drawn several times, with main memory that holds something else before it is written
to: an image of which a pass writes a part only is not pinned.
"""

import json
import sys

import traces

# Values of MALLOC_PERTURB_ (mallopt(3)): bytes that fresh memory is filled with.
FILLINGS = ("0", "85", "170", "0")
# Written at masked pixels only. The rest is what other images left in the block of memory that they
# share, which is the same in every run and another with any change of any image's size or order.
PARTLY_WRITTEN = ("reveal color", "reveal motion depth", "reveal entity id")


def pin(executable, assets, method):
    """The driver and the rows of the method."""
    runs = [traces.draw(executable, assets, method, environment={"MALLOC_PERTURB_": filling})
            for filling in FILLINGS]
    rows = []
    for same in zip(*(run["images"] for run in runs)):
        if len({traces.place(row) for row in same}) > 1:
            sys.exit(f"{method}: the passes of two runs differ at '{same[0]['pass']}'")
        hashes = {row["hash"] for row in same}
        is_pinned = len(hashes) == 1 and same[0]["image"] not in PARTLY_WRITTEN
        rows.append({**same[0], "hash": hashes.pop() if is_pinned else None})
    if not rows or rows[-1]["hash"] is None:
        sys.exit(f"{method}: the picture is not the same in every run")
    return runs[0]["driver"], rows


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__.strip())
    pins = traces.read_pins()
    methods = {}
    for method in traces.list_methods(sys.argv[1]):
        driver, methods[method] = pin(*sys.argv[1:], method)
        loose = sum(row["hash"] is None for row in methods[method])
        print(f"{method}: {len(methods[method])} images, {loose} of them not pinned")
    pins[driver] = methods
    # A row of a table in each line, so that a change can be read.
    text = "{\n"
    for i, (name, methods) in enumerate(sorted(pins.items())):
        text += f"{',' if i else ''}{json.dumps(name)}: {{\n"
        for j, (method, rows) in enumerate(methods.items()):
            lines = ",\n  ".join(json.dumps(row) for row in rows)
            text += f"{',' if j else ''} {json.dumps(method)}: [\n  {lines}\n ]\n"
        text += "}\n"
    traces.PINS.write_text(text + "}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
