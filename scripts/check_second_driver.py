#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs what needs no rays on SwiftShader, Chromium's software device, which shares no code with Mesa's.

usage: check_second_driver.py [--pictures]
With validation: a picture by every method, compared with lavapipe's and, without --pictures, tests of single
passes, laws that whole pictures obey, and the same bits in every run. SHUTTER_SWIFTSHADER is another driver
description than that of the package chromium. Needs a build with tests in build/release. Exit status: 0 all
pass, 1 not, 77 there is no SwiftShader.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BUILD = ROOT / "build/release"
SWIFTSHADER = os.environ.get("SHUTTER_SWIFTSHADER", "/usr/lib/chromium/vk_swiftshader_icd.json")
LAVAPIPE = ("lvp_icd.json", f"lvp_icd.{os.uname().machine}.json")
METHODS = ("sharp", "rosado2007", "own_velocity", "mcguire2012", "guertin2014", "jimenez2014", "gather",
           "resolved", "accumulate")
SAMPLES = {"accumulate": "8"}
# The sharp pictures differ, as their rasters do: SwiftShader's sRGB texels are brighter by up to 0.004,
# and 22 of 57,600 pixels at silhouettes show another entity. That leaves 43.9 dB.
SHARP_DB = 43.0
# A blur passes these differences on and adds its own. Errors at D dB on top of those of the sharp
# picture's S dB give S - 10 log10(1 + 10^((S - D) / 10)): half a decibel less means that the blur
# alone differs by 53 dB, the difference of rounding over a picture.
LOSS_DB = 0.5
# Suites by program; what needs rays is skipped by the tests themselves. The rest of test_gpu_embedded is
# too slow.
PROGRAMS = {"test_gpu": "*", "test_gpu_ui": "*", "test_image": "*",
            "test_gpu_embedded": "CInterface*:Cpp*:EmbeddedConventions.*:EmbeddedOverlay.*"}
# Half floats of SwiftShader are NaN, by an `or` with 0x7FFF, where they overflow or are infinite: so are
# the depth of the sky that hides particles at instants, and light beyond 65,504.
BROKEN = ("ParticleLaw.ACameraPanBlursParticlesLikeTheWorld",
          "ParticleLaw.LightThatThePictureCannotHoldStaysFinite")
# Not run: up to minutes each, mostly because the driver compiles `resolved` again for each picture.
SLOW = ("BlendedLayerLaw.*", "CInterface.EachPreset*", "CInterface.PreparationAhead*", "InstantNoises.*",
        "MethodSettingsLaw.*", "ParticleLaw.*Instant*", "ParticleLaw.OverGlass*", "PhaseLaw.*",
        "PictureDrawerTest.AFrameInWhichSomethingJumps*", "Resolved*")


def find_lavapipe():
    for name in LAVAPIPE:
        path = Path("/usr/share/vulkan/icd.d") / name
        if path.exists():
            return str(path)
    sys.exit("check_second_driver: lavapipe is not installed (package mesa-vulkan-drivers)")


def environment(driver, folder):
    return {**os.environ, "VK_DRIVER_FILES": driver, "VK_ICD_FILENAMES": driver,
            "XDG_CACHE_HOME": str(folder)}


def render(method, driver, folder):
    """The picture, and what went wrong."""
    picture = folder / f"{method}_{Path(driver).stem}.exr"
    samples = ("--samples", SAMPLES[method]) if method in SAMPLES else ()
    done = subprocess.run(
        [BUILD / "shutter", "render", BUILD / "assets/vase.glb", "--method", method, "--size",
         "320x180", "--validate", *samples, "--out", picture],
        env=environment(driver, folder), capture_output=True, text=True, timeout=600)
    return picture, done.stderr.strip() if done.returncode or done.stderr.strip() else None


def measure(method, folder):
    """PSNR of SwiftShader's picture against lavapipe's, or a sentence."""
    pictures = []
    for driver in (SWIFTSHADER, find_lavapipe()):
        picture, problem = render(method, driver, folder)
        if problem is not None:
            return f"{method} on {Path(driver).stem}: {problem}"
        pictures.append(picture)
    done = subprocess.run([BUILD / "shutter", "compare", *pictures, "--json"], capture_output=True,
                          text=True, check=True)
    return float(json.loads(done.stdout)["psnr_db"])


def compare_pictures(folder):
    """Sentences on what differs by more than is explained above."""
    sharp = None
    for method in METHODS:
        began = time.monotonic()
        found = measure(method, folder)
        seconds = time.monotonic() - began
        if isinstance(found, str):
            print_row(f"picture by {method}", 1, 0, 0, seconds)
            yield found
            continue
        if method == "sharp":
            sharp = found
        bound = SHARP_DB if sharp is None or method == "sharp" else sharp - LOSS_DB
        print_row(f"picture by {method}, {found:.2f} dB", 1, int(found >= bound), 0, seconds)
        if found < bound:
            yield f"{method} is {found:.2f} dB from lavapipe's picture, less than {bound:.2f}"


def print_row(suite, tests, passed, skipped, seconds):
    print(f"{suite:<55} {tests:>5} {passed:>6} {skipped:>7} {seconds:>7.1f}", flush=True)


def print_header():
    print(f"{'suite':<55} {'tests':>5} {'passed':>6} {'skipped':>7} {'seconds':>7}")


def count_results(suite):
    """Tests of a suite of a report of googletest by how they ended."""
    return Counter("failed" if "failures" in test else test["result"].lower()
                   for test in suite["testsuite"] if test["status"] == "RUN")


def run_tests(program, suites, folder):
    """A row for each suite, and sentences on tests that fail."""
    report = folder / f"{program}.json"
    done = subprocess.run(
        [BUILD / program, f"--gtest_filter={suites}-{':'.join(BROKEN + SLOW)}", "--gtest_brief=1",
         f"--gtest_output=json:{report}"], cwd=BUILD,
        env={**environment(SWIFTSHADER, folder), "SHUTTER_REQUIRE_DEVICE": "1"},
        stdout=subprocess.PIPE, text=True)
    if not report.exists():
        print(done.stdout, end="")
        yield f"{program} ends with status {done.returncode}"
        return
    total = Counter()
    for suite in json.loads(report.read_text(encoding="utf-8"))["testsuites"]:
        counts = count_results(suite)
        if not counts:
            continue
        total += counts
        print_row(f"{program} {suite['name']}", sum(counts.values()), counts["completed"], counts["skipped"],
                  float(suite["time"].rstrip("s")))
    if done.returncode:
        print(done.stdout, end="")
        yield f"{program}: {total['failed']} tests fail"
    elif not total["completed"]:
        yield f"{program} passed no test"


def check_bits(folder):
    """Sentences on pictures whose bits are not those of another run, or those that were pinned."""
    variables = {**environment(SWIFTSHADER, folder), "SHUTTER_EXECUTABLE": str(BUILD / "shutter"),
                 "SHUTTER_ASSETS": str(BUILD / "assets"),
                 "SHUTTER_GENERATOR": str(BUILD / "shutter_generate_assets"),
                 "SHUTTER_PIN_DEVICE": "SwiftShader", "PYTHONDONTWRITEBYTECODE": "1"}
    for name, test in (("two runs", ("traces_test.py", "Traces.test_two_runs_write_the_same")),
                       ("pins", ("pinned_test.py",))):
        began = time.monotonic()
        done = subprocess.run(
            [sys.executable, ROOT / "tests/determinism" / test[0], *test[1:]], env=variables,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        skipped = done.returncode == 77
        print_row(f"determinism: {name}", 1, int(done.returncode == 0), int(skipped),
                  time.monotonic() - began)
        if skipped:
            print(done.stdout, end="")
        elif done.returncode:
            yield f"determinism: {name}: {done.stdout}"


def main():
    options = sys.argv[1:]
    if options in (["-h"], ["--help"]):
        print(__doc__.strip())
        return
    if options not in ([], ["--pictures"]):
        print(__doc__.strip(), file=sys.stderr)
        sys.exit(2)
    if not Path(SWIFTSHADER).exists():
        print(f"check_second_driver: skipped: {SWIFTSHADER} is missing (package chromium)")
        sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="shutter_second_driver_") as name:
        folder = Path(name)
        began = time.monotonic()
        print_header()
        faults = list(compare_pictures(folder))
        if not options:
            for program, suites in PROGRAMS.items():
                faults += run_tests(program, suites, folder)
            faults += check_bits(folder)
    if faults:
        sys.exit("check_second_driver: " + "; ".join(faults))
    print(f"check_second_driver: SwiftShader draws what lavapipe draws, as far as is explained; "
          f"{time.monotonic() - began:.0f} s")


if __name__ == "__main__":
    main()
