# SPDX-License-Identifier: MIT
"""Pictures of one shot by every method, with a hash of each image that each pass wrote."""

import hashlib
import json
import os
import pathlib
import subprocess
import tempfile

PINS = pathlib.Path(__file__).with_name("pins.json")
# lavapipe's; that of another driver, which VK_DRIVER_FILES then names.
DEVICE = os.environ.get("SHUTTER_PIN_DEVICE", "llvmpipe")
# Small, and yet every pass of every method runs in it.
SHOT = ("--size", "96x54", "--device", DEVICE, "--exposure", "0.05")
SAMPLES = {"accumulate": "4", "truth": "2", "denoised": "1"}
NEED_RAYS = ("hybrid", "adaptive", "denoised", "truth")


def describe_processor():
    """Name and a digest of all that a compiler depends on: software drivers compile for it."""
    wanted = ("vendor_id", "cpu family", "model", "model name", "flags", "Features")
    found = {}
    cpuinfo = pathlib.Path("/proc/cpuinfo")
    for line in cpuinfo.read_text(encoding="utf-8").splitlines() if cpuinfo.exists() else ():
        key, _, value = line.partition(":")
        if key.strip() in wanted:
            found.setdefault(key.strip(), value.strip())
    digest = hashlib.sha256(json.dumps(found, sort_keys=True).encode()).hexdigest()
    return f"{found.get('model name', 'unknown')} {digest[:8]}"


def describe_library(driver):
    """A digest of the driver's library, where its name has no version."""
    path = pathlib.Path(os.environ.get("VK_DRIVER_FILES", ""))
    if not driver.startswith("SwiftShader") or not path.is_file():
        return ""
    library = path.parent / json.loads(path.read_text(encoding="utf-8"))["ICD"]["library_path"]
    return f" {library.name} {hashlib.sha256(library.read_bytes()).hexdigest()[:8]}"


def info(executable, what):
    return subprocess.run([executable, "info", what], capture_output=True, text=True,
                          check=True).stdout


def list_methods(executable):
    """Those that the device can run."""
    traces_none = any(DEVICE in line and line.endswith("rays: none")
                      for line in info(executable, "--devices").splitlines())
    return [method for method in info(executable, "--methods").split()
            if not (traces_none and method in NEED_RAYS)]


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
    driver = found["driver"].strip()
    return {**found,
            "driver": f"{driver}{describe_library(driver)} on {describe_processor()}"}


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
