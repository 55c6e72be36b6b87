# SPDX-License-Identifier: MIT
"""Pictures of small shots by the methods, with a hash of each image that each pass wrote."""

import hashlib
import json
import os
import pathlib
import platform
import subprocess
import tempfile

PINS = pathlib.Path(__file__).with_name("pins.json")
EXPLANATIONS = pathlib.Path(__file__).with_name("explanations.txt")
# lavapipe's; that of another driver, which VK_DRIVER_FILES then names.
DEVICE = os.environ.get("SHUTTER_PIN_DEVICE", "llvmpipe")
# lavapipe compiles for the instructions of its processor: those of the first AVX alone.
ENVIRONMENT = {"GALLIUM_OVERRIDE_CPU_CAPS": "avx"}
# Small, and yet every pass of every method runs in it.
SHOT = ("--size", "96x54", "--device", DEVICE, "--exposure", "0.05")
SAMPLES = {"accumulate": "4", "truth": "2", "denoised": "1"}
NEED_RAYS = ("hybrid", "adaptive", "denoised", "truth")
NEED_OWN_SAMPLES = ("accumulate", "denoised", "truth") # they refuse --aa
HARD_CASE = ("--time", "0.2")

# What may be drawn besides the blur.
EFFECTS = ("--aa", "taa", "--bloom", "0.3", "--shadows", "blurred", "--shadow-map-size", "64",
           "--sky", "3")


class Shot:
    """What is drawn: a scene, options, and options for some methods alone."""

    def __init__(self, scene, *options, methods=(), settings=()):
        self.scene = scene
        self.options = options
        self.methods = methods
        self.settings = dict(settings)

    def list_options(self, method):
        options = list(self.options)
        if method in NEED_OWN_SAMPLES and "--aa" in options:
            del options[options.index("--aa"):options.index("--aa") + 2]
        samples = ("--samples", SAMPLES[method]) if method in SAMPLES else ()
        return [*SHOT, *options, *samples, *self.settings.get(method, ())]


PRINCIPAL = ("sharp", "gather", "hybrid", "resolved", "adaptive", "truth")
TWO_RASTERS = ("--set", "secondRaster=true")
# Each has something that the others lack. The first is drawn by every method.
SHOTS = {
    "vase": Shot("vase"),
    "lit courtyard": Shot("courtyard", "--camera", "pan", "--time", "0.5", *EFFECTS,
                          methods=PRINCIPAL),
    "sparks": Shot("sparks_beside_mover", *HARD_CASE, methods=PRINCIPAL),
    "glass": Shot("glass_carriage", *HARD_CASE, methods=PRINCIPAL),
    "focus pull": Shot("gallery", "--camera", "side", "--time", "1.5", methods=PRINCIPAL),
    "runner": Shot("running_figure_pan", *HARD_CASE, methods=PRINCIPAL),
    "second raster": Shot("long_motion", *HARD_CASE, methods=PRINCIPAL,
                          settings={"resolved": TWO_RASTERS, "adaptive": TWO_RASTERS}),
}
# Two frames of a film, each of which the one before left something for.
FILM = Shot("running_figure_pan", "--aa", "taa", "--frames", "11:12", "--fps", "60",
            methods=("resolved", "adaptive"))


def read_processor():
    """What the kernel reports of the first one."""
    found = {}
    cpuinfo = pathlib.Path("/proc/cpuinfo")
    for line in cpuinfo.read_text(encoding="utf-8").splitlines() if cpuinfo.exists() else ():
        key, _, value = line.partition(":")
        found.setdefault(key.strip(), value.strip())
    return found


def describe_processor():
    """Name and a digest of all that a compiler depends on: SwiftShader compiles for it."""
    wanted = ("vendor_id", "cpu family", "model", "model name", "flags", "Features")
    found = {key: value for key, value in read_processor().items() if key in wanted}
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


def generate(generator, folder):
    """All scenes of our own, and the sparks with something beside them that is blurred."""
    subprocess.run([generator, "--all", folder], check=True, timeout=300)
    content = (pathlib.Path(folder) / "sparks.glb").read_bytes()
    length = int.from_bytes(content[12:16], "little")
    scene = json.loads(content[20:20 + length])
    mover = next(node for node in scene["nodes"] if "mesh" in node)
    mover["extensions"] = {"KHR_physics_rigid_bodies": {
        "motion": {"isKinematic": True, "linearVelocity": [2.0, 1.0, 0.0]}}}
    scene["extensionsUsed"] = ["KHR_physics_rigid_bodies", *scene.get("extensionsUsed", ())]
    text = json.dumps(scene).encode()
    text += b" " * (-len(text) % 4)
    parts = [content[:4], content[4:8], (len(content) - length + len(text)).to_bytes(4, "little"),
             len(text).to_bytes(4, "little"), content[16:20], text, content[20 + length:]]
    (pathlib.Path(folder) / "sparks_beside_mover.glb").write_bytes(b"".join(parts))


def render(executable, assets, shot, method, picture, *more, environment=()):
    """What the program prints."""
    done = subprocess.run(
        [executable, "render", f"{assets}/{shot.scene}.glb", "--method", method,
         *shot.list_options(method), *more, "--out", picture],
        env={**os.environ, **ENVIRONMENT, **dict(environment)}, timeout=600, capture_output=True,
        text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def draw(executable, assets, method, *more, shot="vase", environment=()):
    """One picture: {"driver": driver and what it compiles for, "explained": [line, ...],
    "images": [{"frame", "pass", "image", "hash"}, ...]}."""
    with tempfile.TemporaryDirectory(prefix="shutter_trace_") as folder:
        trace = pathlib.Path(folder) / "trace.json"
        printed = render(executable, assets, SHOTS[shot], method, f"{folder}/picture.exr",
                         "--hash-passes", trace, "--explain", *more, environment=environment)
        found = json.loads(trace.read_text(encoding="utf-8"))
    driver = found["driver"].strip()
    target = (f" on {describe_processor()}" if driver.startswith("SwiftShader")
              else f" {found['device'].rpartition(', ')[2].strip(')')} {platform.machine()} "
                   f"{read_processor().get('vendor_id', 'unknown')}")
    return {**found, "driver": f"{driver}{describe_library(driver)}{target}",
            "explained": [" ".join(line.split()) for line in printed.splitlines()
                          if line.split()[0] in ("effect", "work")]}


def hash_film(executable, assets, method, environment=()):
    """One hash of the files of a film."""
    with tempfile.TemporaryDirectory(prefix="shutter_trace_") as folder:
        render(executable, assets, FILM, method, f"{folder}/%04d.exr", environment=environment)
        files = sorted(pathlib.Path(folder).glob("*.exr"))
        assert len(files) == 2, files
        return hashlib.sha256(b"".join(file.read_bytes() for file in files)).hexdigest()[:32]


def list_pictures(executable):
    """(shot, method) of all that is pinned."""
    able = list_methods(executable)
    return [(name, method) for name, shot in SHOTS.items()
            for method in able if not shot.methods or method in shot.methods]


def draw_all(executable, assets, environment=()):
    """{"driver", "pictures": {"shot, method": hash}, "explained": {(shot, method): lines}, "traces"}"""
    found = {"pictures": {}, "explained": {}, "traces": {}}
    for shot, method in list_pictures(executable):
        drawn = draw(executable, assets, method, shot=shot, environment=environment)
        found["driver"] = drawn["driver"]
        found["pictures"][f"{shot}, {method}"] = hash_all(drawn["images"])
        found["explained"][shot, method] = drawn["explained"]
        found["traces"][f"{shot}, {method}"] = drawn["images"]
    for method in FILM.methods:
        if method in list_methods(executable):
            found["pictures"][f"film, {method}"] = hash_film(executable, assets, method, environment)
    return found


def write_explanations(explained):
    """What ran in each shot and what did not, and why: whole for its first method, then what differs."""
    lines = []
    for shot in SHOTS:
        first = None
        for (name, method), found in explained.items():
            if name != shot:
                continue
            lines.append(f"{shot}, {method}")
            lines += [f"  {line}" for line in found if first is None or line not in first]
            first = first or found
    return "\n".join(lines) + "\n"


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
PARTLY_WRITTEN = (
    "reveal color", "reveal motion depth", "reveal entity id", "seen", "missing taps",
)


def hash_all(images):
    """One hash of what all passes wrote."""
    lines = [f"{frame} {name} {image} {row['hash']}" for row in images
             for frame, name, image in [place(row)] if image not in PARTLY_WRITTEN]
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()[:32]


def read_pins():
    return json.loads(PINS.read_text(encoding="utf-8")) if PINS.exists() else {}
