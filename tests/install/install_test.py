#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Installs into a folder of its own, builds the examples against what is there, as projects of
their own, and runs them under validation; their pictures must show what they promise."""

import os
import re
import shutil
import subprocess
import sys

try:
    import skimage.io
except ImportError:
    print("skipped: the package python3-skimage is missing")
    sys.exit(77)

from package import (BUILD, CC, CMAKE, CXX, ROOT, fail, list_symbols, list_words, run,
                     run_validated)

EXAMPLES = ROOT / "game/examples"
MOST_LINES = {"bare_renderer": 165, "c_host": 150, "deforming_host": 310, "forward_host": 430,
              "new_effect": 99}
SOURCES = {".c", ".cpp", ".h", ".comp", ".frag", ".vert", ".txt"}


def check_lengths():
    for name, most in MOST_LINES.items():
        files = [file for file in (EXAMPLES / name).iterdir() if file.suffix in SOURCES]
        # The hosts' limits are on their code; new_effect's on all that it consists of.
        counted = [file for file in files if name == "new_effect" or file.suffix != ".txt"]
        lines = [line for file in counted for line in file.read_text().splitlines()]
        if len(lines) > most:
            fail(f"game/examples/{name} has {len(lines)} lines, {most} are allowed")
        if longest := [line for line in lines if len(line) > 100]:
            fail(f"game/examples/{name} has a line of {len(longest[0])} columns: {longest[0]}")


def check_installed(prefix):
    for file in ("bin/shutter", "bin/shutter_film", "share/shutter/assets/vase.glb", "share/doc/Shutter/LICENSE",
                 "include/shutter_motion_blur.h", "include/shutter_motion_blur.hpp",
                 "include/shutter/shaders/motion_blur/motion_blur_shared.h"):
        if not (prefix / file).is_file():
            fail(f"{file} is not installed")
    for name in ("embedded_*.h", "host_i*.h", "structures.h"):
        if internal := list(prefix.rglob(name)):
            fail(f"{internal[0]} is behind the motion blur's public headers and is installed")
    if layers := [file.name for file in prefix.rglob("*fault_layer*")]:
        fail(f"{layers[0]} belongs to the tests and is installed")
    # Nothing may lead back to where it was built.
    for file in prefix.rglob("*.cmake"):
        for folder in (str(ROOT), str(BUILD)):
            if folder + "/" in file.read_text().replace(str(prefix), ""):
                fail(f"{file.relative_to(prefix)} names {folder}")


def check_components(prefix, folder):
    """All link; one that does not exist is named where it is required, and else does no harm."""
    folder.mkdir()
    (folder / "main.cpp").write_text("int main() {}\n")
    (folder / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.25)\nproject(probe LANGUAGES CXX)\n"
        "find_package(Shutter 0.1 REQUIRED COMPONENTS core OPTIONAL_COMPONENTS teapot)\n"
        "if(Shutter_teapot_FOUND OR NOT Shutter_core_FOUND)\n message(FATAL_ERROR wrong)\nendif()\n"
        "find_package(Shutter REQUIRED)\nadd_executable(probe main.cpp)\n"
        "target_link_libraries(probe PRIVATE Shutter::app Shutter::truth Shutter::accumulate)\n"
        "find_package(Shutter QUIET COMPONENTS teapot)\n"
        "if(Shutter_FOUND OR NOT Shutter_NOT_FOUND_MESSAGE MATCHES \"no component teapot\")\n"
        " message(FATAL_ERROR \"teapot: ${Shutter_NOT_FOUND_MESSAGE}\")\nendif()\n")
    run([CMAKE, "-S", folder, "-B", folder / "build", f"-DCMAKE_PREFIX_PATH={prefix}"], folder)
    run([CMAKE, "--build", folder / "build"], folder)


def build_example(name, prefix, folder):
    folder.mkdir()
    run([CMAKE, "-S", EXAMPLES / name, "-B", folder, f"-DCMAKE_PREFIX_PATH={prefix}",
         f"-DCMAKE_CXX_COMPILER={CXX}",
         f"-DCMAKE_CXX_COMPILER_LAUNCHER={os.environ['SHUTTER_LAUNCHER']}",
         f"-DCMAKE_BUILD_TYPE={os.environ['SHUTTER_CONFIG']}"], folder)
    run([CMAKE, "--build", folder, "--parallel", "2"], folder)


def check_shared_library(prefix):
    """A host may bring its own Vulkan loader, volk's variables, and any version of fmt."""
    library = next(prefix.rglob("libshutter_motion_blur.so"))
    defined = list_symbols(library, "--defined-only")
    if foreign := [name for name in defined if not name.startswith("shutterBlur")]:
        fail(f"{library.name} exports {foreign[0]}, and {len(foreign)} names in all that are not "
             "of its interface")
    if len(defined) < 10:
        fail(f"{library.name} exports only {defined}")
    if foreign := [name for name in list_symbols(library, "--undefined-only")
                   if name.startswith("vk") or "N3fmt" in name]:
        fail(f"{library.name} needs {foreign[0]} from its host")


def build_by_pkg_config(prefix, folder):
    """The C host by the compiler alone."""
    folder.mkdir()
    words = list_words(prefix, "shutter_motion_blur", folder)
    libraries = next(prefix.rglob("libshutter_motion_blur.so")).parent
    run([CC, "-std=c11", "-pedantic-errors", "-Wall", "-Wextra", "-Werror",
         EXAMPLES / "c_host/main.c", "-o", "c_host", *words, f"-Wl,-rpath,{libraries}", "-lvulkan"],
        folder)


def read_ppm(file):
    kind, width, height, largest, pixels = file.read_bytes().split(maxsplit=4)
    if (kind, largest) != (b"P6", b"255"):
        fail(f"{file.name} is no PPM of 8 bits")
    width, height = int(width), int(height)
    # split() takes away white space that belongs to the pixels.
    pixels = file.read_bytes()[-3 * width * height:]
    return width, height, lambda x, y: pixels[3 * (y * width + x):3 * (y * width + x) + 3]


def check_blur(folder, left):
    """The square, 60 x 60 at (left, 60), moved by 24 px: its vertical edges are smears as long, all
    else is as it was."""
    width, height, before = read_ppm(folder / "before.ppm")
    _, _, after = read_ppm(folder / "after.ppm")
    changed = {(x, y) for y in range(height) for x in range(width) if before(x, y) != after(x, y)}
    # Nothing farther than 24 px from it (and the half pixel that a tap may reach) sees it.
    far = [(x, y) for x, y in changed
           if not (left - 26 <= x < left + 86 and 60 - 2 <= y < 120 + 2)]
    if far:
        fail(f"{len(far)} pixels that the square does not pass were changed, e.g. {far[0]}")
    # Along a row through the square's middle red falls from the square's 255 by steps.
    row = [after(x, 90)[0] for x in range(width)]
    levels = {value for value in row if 140 < value < 250}
    if len(levels) < 5:
        fail(f"the square's edges are not blurred: reds between are {sorted(levels)}")
    if not any((x, 90) in changed for x in range(left, left + 60)):
        fail("nothing inside of the square's place was blurred")


def check_spark(folder, left):
    """Before the square: 6 px high at (left, 70), 24 px long and 6 more that fade in and out."""
    _, _, after = read_ppm(folder / "after.ppm")
    light = [after(x, 73)[2] - after(x, 65)[2] for x in range(left, left + 32)]
    if not (light[12] > 40 and 0 < light[0] < light[3] < light[12] > light[28] > 0 == light[31]):
        fail(f"the spark is not drawn over the exposure: {light}")


def check_vignette(prefix, folder, picture):
    """Sharp and blurred pictures of the same view by the program show what the example did."""
    def draw(method):
        file = folder / f"{method}.png"
        run([prefix / "bin/shutter", "render", prefix / "share/shutter/assets/vase.glb",
             "--ambient", "0,0,0", "--method", method, "--out", file], folder)
        return read(file)

    def read(file):
        return skimage.io.imread(file)[:, :, :3].astype(int)

    own, sharp, blurred = read(picture), draw("sharp"), draw("gather")
    if not own.shape == sharp.shape == blurred.shape:
        fail("the pictures are of different sizes")
    height, width, _ = own.shape

    def distance(first, second):
        """Mean absolute difference where the vignette takes next to no light."""
        middle = slice(height * 4 // 10, height * 6 // 10), slice(width * 4 // 10, width * 6 // 10)
        return abs(first[middle] - second[middle]).mean()

    moved, left = distance(sharp, blurred), distance(own, blurred)
    print(f"sharp and blurred differ by {moved:.2f} in the middle, the example by {left:.2f}")
    if not left < 0.5 * moved:
        fail("the example's picture is not the blurred one")
    for y, x in ((0, 0), (0, -1), (-1, 0), (-1, -1)):
        before, after = blurred[y, x].max(), own[y, x].max()
        if before < 30 or after > before / 4:
            fail(f"the corner {x}, {y} goes from {before} to {after}; it should be dark")


def check_flag(folder):
    """The flag's free end is blurred; the wall and the end at the pole are not."""
    _, _, before = read_ppm(folder / "before.ppm")
    _, _, after = read_ppm(folder / "after.ppm")

    def measure_changed(columns, lines):
        places = [(x, y) for y in lines for x in columns]
        return sum(max(abs(a - b) for a, b in zip(before(*place), after(*place))) > 8
                   for place in places) / len(places)

    free = measure_changed(range(445, 470), range(75, 245))
    held = measure_changed(range(100, 200), range(110, 245))
    if free < 0.2 or held > 0.01:
        fail(f"{free:.0%} of the flag's free end is blurred, and {held:.0%} of what hardly moves")


def check_forward(printed):
    """`resolved` is at least 3 dB nearer to the mean of the host's own frames than any filter, and
    the checker is silent."""
    found = {name: float(value) for name, value in re.findall(r"^(\w+) ([\d.]+) dB$", printed, re.M)}
    print("forward_host:", found)
    resolved, sharp = found.pop("resolved"), found.pop("sharp")
    if len(found) < 6:
        fail(f"forward_host compares {sorted(found)} alone")
    if resolved < max(found.values()) + 3.0 or min(found.values()) < sharp + 2.0:
        fail(f"resolved has {resolved} dB, sharp {sharp}, and filters {found}")
    if "motion blur" in printed:
        fail(f"forward_host was reported to:\n{printed}")


def has_device(prefix, folder):
    done = subprocess.run([prefix / "bin/shutter", "info", "--devices"], cwd=folder, text=True,
                          capture_output=True, check=False)
    return done.returncode == 0


def main():
    check_lengths()
    folder = BUILD / "install_test"
    shutil.rmtree(folder, ignore_errors=True) # what an earlier run installed must not help
    prefix = folder / "prefix"
    folder.mkdir(parents=True)
    run([CMAKE, "--install", BUILD, "--prefix", prefix], folder)
    check_installed(prefix)
    check_components(prefix, folder / "probe")
    check_shared_library(prefix)
    for name in MOST_LINES:
        build_example(name, prefix, folder / name)
    build_by_pkg_config(prefix, folder / "by_pkg_config")
    if not has_device(prefix, folder) and not os.environ.get("SHUTTER_REQUIRE_DEVICE"):
        print("no Vulkan device: the examples were built but not run")
        sys.exit(77)
    run_validated([folder / "bare_renderer/bare_renderer"], folder)
    check_blur(folder, left=136)
    check_spark(folder, left=136)
    for host in ("c_host", "by_pkg_config"):
        run_validated([folder / host / "c_host"], folder)
        check_blur(folder, left=120)
    run_validated([folder / "deforming_host/deforming_host"], folder)
    check_flag(folder)
    check_forward(run_validated([folder / "forward_host/forward_host"], folder))
    scene = prefix / "share/shutter/assets/vase.glb"
    run_validated([folder / "new_effect/new_effect", scene, "vignette.png"], folder)
    check_vignette(prefix, folder, folder / "vignette.png")
    shutil.rmtree(folder)


if __name__ == "__main__":
    main()
