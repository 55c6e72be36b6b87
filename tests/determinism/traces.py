# SPDX-License-Identifier: MIT
"""Pictures of one shot by every method, with a hash of each image that each pass wrote."""

import hashlib
import json
import os
import pathlib
import subprocess
import tempfile

PINS = pathlib.Path(__file__).with_name("pins.json")
# Small, and yet every pass of every method runs in it.
SHOT = ("--size", "96x54", "--device", "llvmpipe", "--exposure", "0.05")
SAMPLES = {"accumulate": "4", "truth": "2", "denoised": "1"}


def describe_processor():
    """Name and a digest of all that a compiler asks of it: software drivers compile for it."""
    wanted = ("vendor_id", "cpu family", "model", "model name", "flags", "Features")
    found = {}
    cpuinfo = pathlib.Path("/proc/cpuinfo")
    for line in cpuinfo.read_text(encoding="utf-8").splitlines() if cpuinfo.exists() else ():
        key, _, value = line.partition(":")
        if key.strip() in wanted:
            found.setdefault(key.strip(), value.strip())
    digest = hashlib.sha256(json.dumps(found, sort_keys=True).encode()).hexdigest()
    return f"{found.get('model name', 'unknown')} {digest[:8]}"


def list_methods(executable):
    done = subprocess.run([executable, "info", "--methods"], capture_output=True, text=True,
                          check=True)
    return done.stdout.split()


def render(executable, assets, method, picture, *more, environment=()):
    samples = ("--samples", SAMPLES[method]) if method in SAMPLES else ()
    subprocess.run(
        [executable, "render", f"{assets}/vase.glb", "--method", method, *SHOT, *samples, *more,
         "--out", picture],
        check=True, env={**os.environ, **dict(environment)}, timeout=300)


def draw(executable, assets, method, *more, environment=()):
    """{"driver": driver and processor, "images": [{"frame", "pass", "image", "hash"}, ...]} of one picture."""
    with tempfile.TemporaryDirectory(prefix="shutter_trace_") as folder:
        trace = pathlib.Path(folder) / "trace.json"
        render(executable, assets, method, f"{folder}/picture.exr", "--hash-passes", trace, *more,
               environment=environment)
        found = json.loads(trace.read_text(encoding="utf-8"))
    return {**found, "driver": f"{found['driver']} on {describe_processor()}"}


def place(row):
    return row["frame"], row["pass"], row["image"]


def find_difference(expected, found):
    """A sentence that names the first pass whose images differ; None where none does."""
    for before, now in zip(expected, found):
        if place(before) != place(now):
            return (f"the passes differ from '{now['pass']}' on, where '{before['pass']}' ran: "
                    f"image '{now['image']}' of frame {now['frame']}")
        if before["hash"] != now["hash"]:
            return (f"the first pass that differs is '{now['pass']}': image '{now['image']}' of "
                    f"frame {now['frame']}")
    if len(expected) != len(found):
        longer = max(expected, found, key=len)
        row = longer[min(len(expected), len(found))]
        return f"only one of them has the pass '{row['pass']}'"
    return None


# Written at masked pixels only. The rest is what other images left in the block of memory that they
# share, which is the same in every run and another with any change of any image's size or order.
PARTLY_WRITTEN = ("reveal color", "reveal motion depth", "reveal entity id")


def hash_all(images):
    """One hash of what all passes wrote."""
    lines = [f"{frame} {name} {image} {row['hash']}" for row in images
             for frame, name, image in [place(row)] if image not in PARTLY_WRITTEN]
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()[:32]


def read_pins():
    return json.loads(PINS.read_text(encoding="utf-8")) if PINS.exists() else {}
