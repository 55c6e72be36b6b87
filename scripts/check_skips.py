#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compares the tests that a run of ctest skipped with those that are known to skip.

usage: check_skips.py RESULTS CASES EXPECTED
RESULTS is what `ctest --output-junit` wrote for a run of all tests. CASES is the folder in which
suites of GoogleTest reported their cases (cmake/ListSuites.cmake), which count as tests
"LABEL/SUITE.CASE" instead of their suite. EXPECTED is a list of lines "CONDITION : PATTERN : REASON".
PATTERN is a shell pattern for names of tests; a test that it matches may skip while CONDITION holds:
  absent PATH          there is no such file or folder; PATH is relative to the repository
  no-program NAME...   one of the programs is not on PATH
  no-module NAME       python3 cannot import the module
  other-device         the environment picks another device than lavapipe
  unpinned-driver      no pictures are pinned for the drivers and the processor of this machine
Exit status 1 if a test skipped without such a line, or if a pattern matches no test at all.
"""

import fnmatch
import json
import os
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


@dataclass
class Expectation:
    line: int
    condition: str
    pattern: str
    reason: str

    def matches(self, test):
        return fnmatch.fnmatchcase(test, self.pattern)


def is_absent(path):
    return not (ROOT / path).exists()


def lacks_program(*names):
    return any(shutil.which(name) is None for name in names)


def lacks_module(name):
    python = shutil.which("python3", path="/usr/bin") or sys.executable
    return subprocess.run([python, "-c", f"import {name}"], capture_output=True).returncode != 0


def is_other_device():
    return "lvp_icd" not in os.environ.get("VK_DRIVER_FILES", "lvp_icd")


def is_unpinned_driver():
    shutter = ROOT / "build/release/shutter"
    pins = json.loads((ROOT / "tests/determinism/pins.json").read_text(encoding="utf-8"))
    devices = subprocess.run([shutter, "info", "--devices"], capture_output=True, text=True)
    sys.path.insert(0, str(ROOT / "tests/determinism"))
    import traces
    processor = f" on {traces.describe_processor()}"
    return not any(pin.endswith(processor) and pin.removesuffix(processor) in devices.stdout
                   for pin in pins)


# By name: the function that evaluates the condition, and its number of arguments.
CONDITIONS = {
    "absent": (is_absent, range(1, 2)),
    "no-program": (lacks_program, range(1, 10)),
    "no-module": (lacks_module, range(1, 2)),
    "other-device": (is_other_device, range(0, 1)),
    "unpinned-driver": (is_unpinned_driver, range(0, 1)),
}


def holds(condition):
    name, *words = condition.split()
    return CONDITIONS[name][0](*words)


def read_expectations(path):
    expectations = []
    for number, line in enumerate(Path(path).read_text().splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        fields = [field.strip() for field in line.split(" : ", 2)]
        if len(fields) != 3 or not all(fields):
            sys.exit(f"check_skips: {path}:{number}: expected CONDITION : PATTERN : REASON")
        name, *words = fields[0].split()
        if name not in CONDITIONS or len(words) not in CONDITIONS[name][1]:
            sys.exit(f"check_skips: {path}:{number}: unknown condition '{fields[0]}'")
        expectations.append(Expectation(number, *fields))
    return expectations


def read_cases(path):
    try:
        return list(ElementTree.parse(path).getroot().iter("testcase"))
    except (OSError, ElementTree.ParseError) as error:
        sys.exit(f"check_skips: {path}: {error}")


def read_results(results, folder):
    """The names of all tests, and of those that were skipped or are disabled."""
    suites = {}
    for path in Path(folder).glob("*/*.xml"):
        for case in read_cases(path):
            suite = f"{path.parent.name}/{case.get('classname')}"
            suites.setdefault(suite, []).append(case)
    tests, skipped, names = [], [], set()
    for test in read_cases(results):
        name = test.get("name")
        if name in names:
            sys.exit(f"check_skips: {results}: two tests have the name {name}")
        names.add(name)
        for case in suites.get(name, ()):
            tests.append(f"{name}.{case.get('name')}")
            if case.get("result") in ("skipped", "suppressed"):
                skipped.append(tests[-1])
        if name not in suites:
            tests.append(name)
            if test.get("status") in ("notrun", "disabled"):
                skipped.append(name)
    return tests, skipped


def find_faults(tests, skipped, expectations):
    holding = [e for e in expectations if holds(e.condition)]
    for test in skipped:
        if any(e.matches(test) for e in holding):
            continue
        known = [f"line {e.line}: {e.condition}" for e in expectations if e.matches(test)]
        yield f"{test} was skipped, " + (
            f"though what it needs is there ({'; '.join(known)})" if known else "which no line expects"
        )
    for e in expectations:
        if not any(e.matches(test) for test in tests):
            yield f"line {e.line}: {e.pattern} matches no test"


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__.strip())
    tests, skipped = read_results(*sys.argv[1:3])
    expectations = read_expectations(sys.argv[3])
    if not tests:
        sys.exit(f"check_skips: {sys.argv[1]}: there are no tests")
    faults = list(find_faults(tests, skipped, expectations))
    if faults:
        sys.exit(f"check_skips: tests and {sys.argv[3]} disagree: " + "; ".join(faults))
    print(f"check_skips: {len(skipped)} of {len(tests)} tests were skipped, all as expected")


if __name__ == "__main__":
    main()
