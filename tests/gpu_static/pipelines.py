# SPDX-License-Identifier: MIT
"""Runs the program on Mesa's driver for AMD GPUs over a kernel that executes nothing, and reads what the
driver's compiler reports of each pipeline."""

import glob
import json
import os
import pathlib
import re
import subprocess
import tempfile
from dataclasses import dataclass

PINS = pathlib.Path(__file__).with_name("pins")
# One card of each generation, as the kernel's stand-in calls them.
FAMILIES = {"rdna2": "navi21", "rdna3": "navi31"}
SAMPLES = {"accumulate": "2", "truth": "1"}
# Pipelines that no method makes by itself: other rays, settings and effects, deforming meshes (the
# runner and his window in `gallery`), and alpha masks, glass and particles (drift.gltf).
VARIANTS = (
    ("vase", "--method", "hybrid", "--rays", "pipeline", "--response", "triangle"),
    ("vase", "--method", "hybrid", "--set", "composite=weights", "--response", "triangle"),
    ("vase", "--method", "hybrid", "--aov", "all", "--set", "rayShare=0.25", "--set",
     "composite=weights"),
    ("vase", "--method", "resolved", "--aov", "all", "--set", "secondRaster=true"),
    ("courtyard", "--time", "0.5", "--method", "resolved", "--shadows", "blurred", "--aa", "taa",
     "--bloom", "0.1"),
    ("courtyard", "--camera", "pan", "--time", "0.5", "--method", "resolved", "--aa", "taa"),
    ("gallery", "--time", "0.5", "--method", "hybrid", "--shadows", "sharp", "--max-blur", "3"),
    ("gallery", "--time", "0.5", "--method", "resolved"),
    ("gallery", "--time", "0.5", "--method", "resolved", "--set", "secondRaster=true"),
    ("gallery", "--time", "0.5", "--method", "adaptive"),
    ("gallery", "--time", "0.5", "--method", "resolved", "--fstop", "0.5", "--focus", "3"),
    ("vase", "--method", "resolved", "--fstop", "0.5", "--focus", "3"),
    ("gallery", "--time", "0.5", "--method", "adaptive", "--fstop", "0.5", "--focus", "3"),
    ("drift", "--time", "0.2", "--exposure", "0.1", "--method", "resolved"),
    ("drift", "--time", "0.2", "--exposure", "0.1", "--method", "gather"),
)
# What takes the time of a frame. Each of these is pinned, in all its variants.
HOT = (
    "G-buffer", "blended layer", "bloom down", "bloom up", "composite blended", "count",
    "count alone", "count revealed", "deform",
    "draw bright points", "edge", "filter lens", "find block samples", "find bright points",
    "find bright regions", "find jumps", "find parts",
    "find parts, last frame", "find parts, second raster", "fit planes", "gather", "gather and composite",
    "gather uniform", "guertin2014", "instant surfaces", "jimenez2014", "list candidates",
    "list candidates, last frame", "list candidates, second raster", "list crowds", "list missing",
    "mcguire2012",
    "pack surface", "particle composite", "particles", "ray mask", "ray reveal", "resolve",
    "resolve uniform", "rosado2007", "shape ways", "sort candidates", "split edges", "split samples",
    "stochastic rays", "taa", "tile max", "trace samples",
)
# Statistics of the driver, by the names that tables and pins use. Waves are those of 32 lanes that a
# SIMD can hold, also where the shader has 64.
STATISTICS = {
    "vgprs": "VGPRs", "scalarSpills": "Spilled SGPRs", "vectorSpills": "Spilled VGPRs",
    "scratch": "Scratch size", "waves": "Subgroups per SIMD", "instructions": "Instructions",
    "codeBytes": "Code size", "sharedBytes": "LDS size",
}
PINNED = ("scalarSpills", "waves", "instructions")
# Programs of ray-tracing pipelines: the driver's own traversal is part of them, with a stack in scratch
# memory. They are in the table alone.
STACKED = ("raygen",)


class Missing(Exception):
    """Something that the runs need is not here."""


@dataclass(frozen=True)
class Program:
    pipeline: str
    constants: str
    stage: str

    def __str__(self):
        return " ".join(part for part in (self.pipeline, self.constants, self.stage) if part)


@dataclass
class Run:
    arguments: tuple
    status: int
    messages: str


def find_file(package, *patterns):
    found = sorted(path for pattern in patterns for path in glob.glob(pattern))
    if not found:
        raise Missing(f"{patterns[0]} is missing (package {package})")
    return found[0]


class Machine:
    """A GPU of `family` that executes nothing. Each pipeline is compiled once for all runs."""

    def __init__(self, executable, assets, layer, family, folder, validates=True):
        self.executable = executable
        self.assets = assets
        self.validation = ("--validate",) if validates else ()
        self.folder = pathlib.Path(folder)
        self.statistics = self.folder / "statistics"
        self.statistics.mkdir()
        shim = find_file("mesa-drm-shim", "/usr/lib/*/libamdgpu_noop_drm_shim.so",
                         "/usr/lib/libamdgpu_noop_drm_shim.so")
        driver = find_file("mesa-vulkan-drivers", "/usr/share/vulkan/icd.d/radeon_icd*.json")
        validation = find_file("vulkan-validationlayers",
                               "/usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json")
        own = {name: value for name, value in os.environ.items()
               if not name.startswith(("RADV_", "MESA_", "VK_"))}
        self.environment = {
            **own, "LD_PRELOAD": shim, "AMDGPU_GPU_ID": FAMILIES[family], "VK_DRIVER_FILES": driver,
            "VK_ICD_FILENAMES": driver,
            # Validation is above our layer, which keeps submissions from the driver: old loaders
            # order layers by the folders, newer ones by the names.
            "VK_LAYER_PATH": f"{pathlib.Path(validation).parent}:{layer}",
            "VK_INSTANCE_LAYERS": (f"{'VK_LAYER_KHRONOS_validation:' if validates else ''}"
                                   "VK_LAYER_SHUTTER_faults"),
            "SHUTTER_FAULT_STATISTICS": str(self.statistics), "HOME": str(self.folder),
            "XDG_CACHE_HOME": str(self.folder), "MESA_SHADER_CACHE_DIR": str(self.folder),
        }
        devices = self.call("info", "--devices").stdout
        found = re.search(rf"RADV {FAMILIES[family]}.*Mesa (\d+\.\d+)", devices, re.IGNORECASE)
        if not found:
            raise Missing(f"the driver has no {FAMILIES[family]}: {devices.strip() or 'no device'}")
        self.mesa = found[1]

    def call(self, *arguments, **more):
        return subprocess.run([self.executable, *arguments], env={**self.environment, **more},
                              cwd=self.folder, capture_output=True, text=True, timeout=600)

    def render(self, scene, *options, **more):
        own = pathlib.Path(__file__).with_name(f"{scene}.gltf")
        path = own if own.exists() else f"{self.assets}/{scene}.glb"
        done = self.call("render", path, "--size", "64x36", "--out", "picture.exr",
                         *self.validation, *options, **more)
        # The stand-in itself prints the kernel features that it lacks.
        messages = [line for line in done.stderr.splitlines() if not line.startswith("DRM_IOCTL_")]
        return Run((scene, *options), done.returncode, "\n".join(messages))

    def render_all(self):
        """A picture by every method, and by what else makes pipelines."""
        methods = self.call("info", "--methods").stdout.split()
        runs = [("vase", "--method", method,
                 *(("--samples", SAMPLES[method]) if method in SAMPLES else ()))
                for method in methods]
        return [self.render(*run) for run in (*runs, *VARIANTS)]

    def read_statistics(self):
        """By program: its statistics, the worst of pipelines that are known by the same name."""
        programs = {}
        for path in sorted(self.statistics.iterdir()):
            for program, found in read_pipeline(path.read_text(encoding="utf-8")):
                known = programs.setdefault(program, found)
                for name, value in found.items():
                    known[name] = (min if name in ("waves", "lanes") else max)(known[name], value)
        return dict(sorted(programs.items(), key=lambda item: str(item[0])))


def read_pipeline(text):
    """The programs of a file that the layer wrote."""
    rows = [line.split("\t") for line in text.splitlines()]
    # A run that ended in between left a file without a name.
    names = {"name": "(unnamed)", "constants": ""}
    names |= {key: values[0] for key, *values in rows if key in names}
    programs = []
    for key, *values in rows:
        if key == "program":
            stage, lanes = values
            programs.append((Program(names["name"], names["constants"], stage),
                             {"lanes": int(lanes)}))
        elif key == "statistic":
            for name, theirs in STATISTICS.items():
                if theirs == values[0]:
                    programs[-1][1][name] = int(values[1])
    return programs


def list_pins(programs):
    """What pins hold of the statistics."""
    return {str(program): {name: found[name] for name in PINNED}
            for program, found in programs.items()
            if program.pipeline in HOT and program.stage not in STACKED}


def path_of_pins(mesa):
    return PINS / f"mesa_{mesa}.json"


def read_pins(mesa):
    """By family and program; empty: none for this version of Mesa."""
    path = path_of_pins(mesa)
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}


def find_faults(programs):
    """Sentences on what no program may do, with any compiler."""
    for program, found in programs.items():
        if program.stage in STACKED:
            continue
        if found["scratch"]:
            yield f"{program} has {found['scratch']} bytes of scratch memory"
        if found["vectorSpills"]:
            yield f"{program} spills {found['vectorSpills']} vector registers"


def compare(found, pinned):
    """Sentences on figures that are worse than their pin, or not pinned."""
    for program in sorted(found.keys() | pinned.keys()):
        if program not in pinned:
            yield f"{program} is not pinned"
        elif program not in found:
            yield f"{program} is pinned and was not made"
        else:
            yield from compare_program(program, found[program], pinned[program])


def compare_program(program, found, pinned):
    if found["scalarSpills"] > pinned["scalarSpills"]:
        yield (f"{program} spills {found['scalarSpills']} scalar registers, more than "
               f"{pinned['scalarSpills']}")
    if found["waves"] < pinned["waves"]:
        yield f"{program} leaves room for {found['waves']} waves, fewer than {pinned['waves']}"
    if abs(found["instructions"] - pinned["instructions"]) > 0.1 * pinned["instructions"]:
        yield (f"{program} has {found['instructions']} instructions, over 10 % off "
               f"{pinned['instructions']}")


def write_table(programs, path):
    columns = ("lanes", *STATISTICS)
    lines = ["| program | " + " | ".join(columns) + " |", "|---" * (len(columns) + 1) + "|"]
    lines += [f"| {program} | " + " | ".join(str(found[name]) for name in columns) + " |"
              for program, found in programs.items()]
    pathlib.Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8")


def make_folder():
    return tempfile.mkdtemp(prefix="shutter_gpu_static_")
