#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Hosts of every kind, built outside the tree against an installed package: in C11 and in C++17, by
pkg-config and by CMake, with the shared and the static libraries. Each blurs a scene by every method
that traces no rays of Shutter's own, under validation. The scene is so simple that the right picture
is known."""

import math
import os
import re
import shutil
import struct
import subprocess
import sys

from package import BUILD, CC, CMAKE, CXX, ROOT, fail, list_words, run, run_validated

HOSTS = ROOT / "tests/install/hosts"
GLSLANG = os.environ["SHUTTER_GLSLANG"]
CLANG = os.environ["SHUTTER_CLANG"] or CC
VOLK = os.environ["SHUTTER_VOLK"]
STRICT = ["-Wall", "-Wextra", "-Werror"]
C11 = ["-std=c11", "-pedantic-errors", *STRICT]
CPP17 = ["-std=c++17", "-pedantic-errors", "-Wshadow", "-Wconversion", *STRICT]
WITH_VOLK = ["-DHOST_USES_VOLK", "-DVK_NO_PROTOTYPES"] if VOLK else []

# As in hosts/scene.h.
WIDTH, HEIGHT = 96, 64
LEFT, TOP, SIDE, MOVED = 40, 20, 24, 16
# PSNR against the right picture, dB, that each method reaches at least; unblurred, it is 21.0. No
# method can know the stripe of the wall that the square hides in the one picture: `resolved` takes
# the wall's nearest visible colour, which here is that of the other stripes.
LEAST_PSNR = {"own_velocity": 24.7, "mcguire2012": 25.4, "guertin2014": 24.8, "jimenez2014": 32.2,
              "gather": 24.9, "hybrid": 29.5, "resolved": 32.2}


def make_rays(folder):
    """The shader of the hosts' rays, as words of C."""
    run([GLSLANG, "-V", "--target-env", "vulkan1.3", "--quiet", "--vn", "kRaysSpirv",
         "-o", folder / "rays_spirv.h", HOSTS / "rays.comp"], folder)
    return folder


def build_by_pkg_config(prefix, folder, rays):
    """Commands of three hosts."""
    include = [f"-I{rays}"]
    volk = []
    if VOLK:
        run([CC, "-c", VOLK, "-o", "volk.o"], folder)
        volk = ["volk.o", "-ldl"]
    loader = volk or ["-lvulkan"]
    words = list_words(prefix, "shutter_motion_blur", folder)
    libraries = next(prefix.rglob("libshutter_motion_blur.so")).parent
    run([CC, *C11, *WITH_VOLK, *include, HOSTS / "host.c", "-o", "c_shared", *words, *loader,
         f"-Wl,-rpath,{libraries}"], folder)
    words = list_words(prefix, "shutter_motion_blur_static", folder)
    run([CLANG, *C11, *include, HOSTS / "host.c", "-o", "c_static", *words, "-lvulkan"], folder)
    words = list_words(prefix, "shutter_motion_blur", folder)
    run([CXX, *CPP17, *WITH_VOLK, *include, HOSTS / "host.cpp", "-o", "cpp_shared", *words, *loader,
         f"-Wl,-rpath,{libraries}"], folder)
    return {name: [folder / name.split()[-1]]
            for name in ("pkg-config c_shared", "pkg-config c_static", "pkg-config cpp_shared")}


def build_by_cmake(prefix, folder, rays):
    folder.mkdir()
    run([CMAKE, "-S", HOSTS, "-B", folder, f"-DCMAKE_PREFIX_PATH={prefix}",
         f"-DCMAKE_C_COMPILER={CC}", f"-DCMAKE_CXX_COMPILER={CXX}",
         f"-DCMAKE_CXX_COMPILER_LAUNCHER={os.environ['SHUTTER_LAUNCHER']}",
         f"-DHOST_RAYS={rays}", f"-DHOST_VOLK={VOLK}"], folder)
    run([CMAKE, "--build", folder, "--parallel", "2"], folder)
    return {"CMake c_static": [folder / "c_static"],
            "CMake cpp_plugin": [folder / "loads_plugin", folder / "libcpp_plugin.so"]}


def get_wall(x):
    return (0.125 if x // 8 % 2 else 0.5, 0.25, 0.375)


def draw_truth():
    """The light of the exposure: the square covers a pixel for a share of its way."""
    pixels = []
    for y in range(HEIGHT):
        for x in range(WIDTH):
            share = 0.0
            if TOP <= y < TOP + SIDE: # its left edge is between these while it covers the pixel
                first, last = max(x + 0.5 - SIDE, LEFT - MOVED), min(x + 0.5, LEFT)
                share = max(last - first, 0.0) / MOVED
            pixels += [share * front + (1.0 - share) * wall
                       for front, wall in zip((1.0, 0.25, 0.125), get_wall(x))]
    return pixels


def measure(file, truth):
    floats = struct.unpack(f"{4 * WIDTH * HEIGHT}f", file.read_bytes())
    colors = [value for i, value in enumerate(floats) if i % 4 != 3]
    error = sum((a - b) ** 2 for a, b in zip(colors, truth)) / len(truth)
    return 10.0 * math.log10(1.0 / error) if error > 0 else math.inf


def check_host(name, command, folder, truth):
    """Returns the pictures of the methods, as bytes."""
    folder.mkdir()
    printed = run_validated([*command, *LEAST_PSNR], folder)
    if "rays 1\n" not in printed:
        fail(f"{name} was not called once for what its rays see:\n{printed}")
    offered = re.findall("^method (.*)$", printed, re.M)
    if offered and not set(LEAST_PSNR) <= set(offered):
        fail(f"{name} was offered only {offered}")
    for method, least in LEAST_PSNR.items():
        reached = measure(folder / f"{method}.raw", truth)
        print(f"{name}: {method} {reached:.2f} dB")
        if not reached >= least:
            fail(f"{name}: {method} reaches {reached:.2f} dB, {least} are due")
    return {method: (folder / f"{method}.raw").read_bytes() for method in LEAST_PSNR}


def has_device(host, folder):
    """A host that is to blur by no method does nothing but find its device."""
    done = subprocess.run([str(word) for word in host], cwd=folder, text=True, capture_output=True,
                          check=False)
    if done.returncode == 0:
        return True
    if done.stderr.strip() not in ("host: no device", "host: no Vulkan"):
        fail(f"{host[0]}: exit status {done.returncode}\n{done.stdout}{done.stderr}")
    return bool(os.environ.get("SHUTTER_REQUIRE_DEVICE"))


def main():
    folder = BUILD / "hosts_test"
    shutil.rmtree(folder, ignore_errors=True) # what an earlier run installed must not help
    prefix = folder / "prefix"
    folder.mkdir(parents=True)
    run([CMAKE, "--install", BUILD, "--prefix", prefix, "--component", "Development"], folder)
    rays = make_rays(folder)
    hosts = build_by_pkg_config(prefix, folder, rays)
    hosts |= build_by_cmake(prefix, folder / "by_cmake", rays)
    if not has_device(hosts["pkg-config c_shared"], folder):
        print("no Vulkan device: the hosts were built but not run")
        sys.exit(77)
    truth = draw_truth()
    pictures = {}
    for name, command in hosts.items():
        pictures[name] = check_host(name, command, folder / name.replace(" ", "_"), truth)
    first = next(iter(pictures))
    for name, picture in pictures.items():
        for method in LEAST_PSNR:
            if picture[method] != pictures[first][method]:
                fail(f"{method}: {name} and {first} have different pictures")
    shutil.rmtree(folder)


if __name__ == "__main__":
    main()
