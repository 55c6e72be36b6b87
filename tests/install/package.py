# SPDX-License-Identifier: MIT
"""What the tests of the installed package share."""

import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ["SHUTTER_BUILD"])
CMAKE = os.environ["SHUTTER_CMAKE"]
CC = os.environ["SHUTTER_CC"]
CXX = os.environ["SHUTTER_CXX"]


def fail(what):
    sys.exit(f"FAILED: {what}")


def run(command, folder, env=None):
    """What it printed, both streams; ends the test where it fails."""
    done = subprocess.run([str(word) for word in command], cwd=folder, env=env, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    if done.returncode != 0:
        fail(f"{' '.join(map(str, command))}: exit status {done.returncode}\n{done.stdout}")
    return done.stdout


def list_symbols(library, *options):
    return [line.split()[-1] for line in
            run(["nm", "-D", *options, library], library.parent).splitlines() if line]


def run_validated(command, folder):
    """Runs with core and synchronization validation, which must be there and print nothing."""
    env = dict(os.environ, VK_INSTANCE_LAYERS="VK_LAYER_KHRONOS_validation",
               VK_LAYER_ENABLES="VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT",
               VK_KHRONOS_VALIDATION_VALIDATE_SYNC="true", VK_LOADER_DEBUG="layer")
    printed = run(command, folder, env)
    if not re.search(r'Insert\w* (instance|device) layer "VK_LAYER_KHRONOS_validation"', printed):
        fail(f"{command[0]} ran without validation:\n{printed}")
    for word in ("VUID-", "SYNC-HAZARD", "UNASSIGNED-", "Validation Error"):
        if word in printed:
            fail(f"validation spoke up:\n{printed}")
    return printed


def list_words(prefix, package, folder):
    """What pkg-config prints of an installed package."""
    packages = next(prefix.rglob(f"{package}.pc")).parent
    env = dict(os.environ, PKG_CONFIG_PATH=str(packages))
    return run(["pkg-config", "--cflags", "--libs", package], folder, env).split()
