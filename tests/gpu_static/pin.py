#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Pins what the compiler makes of the hot shaders, for all families and the Mesa of this machine.

usage: pin.py BUILD
BUILD is a build folder with tests (build/release). Pins of other versions of Mesa stay.
"""

import json
import shutil
import sys

import pipelines


def pin(build, family):
    """The version of Mesa, and the pins."""
    folder = pipelines.make_folder()
    try:
        machine = pipelines.Machine(f"{build}/shutter", f"{build}/assets",
                                    f"{build}/tests/fault_layer", family, folder)
        for run in machine.render_all():
            if run.status != 0 or run.messages:
                sys.exit(f"{' '.join(run.arguments)}: {run.messages}")
        programs = machine.read_statistics()
    except pipelines.Missing as missing:
        sys.exit(f"pin.py: {missing}")
    finally:
        shutil.rmtree(folder)
    pipelines.write_table(programs, f"{build}/gpu_static_{family}.md")
    return machine.mesa, pipelines.list_pins(programs)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__.strip())
    build = str(pipelines.pathlib.Path(sys.argv[1]).resolve())
    layer = pipelines.pathlib.Path(build, "tests/fault_layer/libshutter_fault_layer.so")
    if not layer.exists():
        sys.exit(f"pin.py: {layer} is missing: without it renders wait forever; build everything first")
    pins = {}
    for family in pipelines.FAMILIES:
        mesa, pins[family] = pin(build, family)
    path = pipelines.path_of_pins(mesa)
    path.parent.mkdir(exist_ok=True)
    # A line for each program, so that a difference shows its name.
    tables = [f"{json.dumps(family)}: {{\n" + ",\n".join(
        f" {json.dumps(program)}: {json.dumps(pin)}" for program, pin in programs.items()) + "\n}"
        for family, programs in pins.items()]
    path.write_text("{\n" + ",\n".join(tables) + "\n}\n", encoding="utf-8")
    print(f"pinned in {path}")


if __name__ == "__main__":
    main()
