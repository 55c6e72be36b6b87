#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Measures the processor time of the build, of each suite of the tests and of the checks."""

import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / "build/release"
RESULT = BUILD / "test_times.json"
DESCRIPTION = """
Prints a table of processor seconds (user and system, of a process and its children) and of wall
seconds by label and by test, the largest first, and writes it to build/release/test_times.json.
Processes that outlive their test, as parts of a browser may, are not counted. Tests run one at a
time by default; several at a time change processor times by some 10 %. The suites must be built.
"""
CHECKS = {
    "check format": ["scripts/check_format.sh"],
    "check sanitizers": ["scripts/check_sanitizers.sh", "--short"],
    "check fuzzers": ["scripts/check_fuzzers.sh", "--short"],
}


def measure(command, **options):
    """{"cpu", "wall", "status"} of a command."""
    begin = time.monotonic()
    process = subprocess.Popen(command, cwd=ROOT, **options)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    return {"cpu": round(usage.ru_utime + usage.ru_stime, 2),
            "wall": round(time.monotonic() - begin, 2), "status": process.returncode}


def list_tests(options):
    """The names and labels of the tests that ctest would run, in its order."""
    listed = subprocess.run(["ctest", "--test-dir", BUILD, "--show-only=json-v1", *options],
                            cwd=ROOT, check=True, capture_output=True, text=True).stdout
    found = []
    for test in json.loads(listed)["tests"]:
        properties = {row["name"]: row["value"] for row in test.get("properties", ())}
        found.append((float(properties.get("COST", 0)), test["name"],
                      (properties.get("LABELS") or ["none"])[0]))
    return [(name, label) for _, name, label in sorted(found, key=lambda row: -row[0])]


def run_tests(options, parallel):
    """Yields a row for each test as it ends. ctest starts each by itself, with its environment."""
    def run(test):
        name, label = test
        with tempfile.TemporaryFile() as output:
            row = measure(["ctest", "--test-dir", BUILD, "-R", f"^{re.escape(name)}$"],
                          stdout=output, stderr=subprocess.STDOUT)
        return {"test": name, "label": label, **row}
    with concurrent.futures.ThreadPoolExecutor(parallel) as pool:
        for done in concurrent.futures.as_completed(
                [pool.submit(run, test) for test in list_tests(options)]):
            yield done.result()


def run_build():
    """Yields a row for the program and one for the tests, compiled anew without a cache."""
    with tempfile.TemporaryDirectory(prefix="times_", dir=ROOT / "build") as folder:
        subprocess.run(["cmake", "--preset", "release", "-B", folder, "-DSHUTTER_TESTS=ON"],
                       cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
        environment = {**os.environ, "CCACHE_DISABLE": "1"}
        for name, targets in (("build program", ["shutter", "shutter_assets"]),
                              ("build tests", ["all"])):
            yield {"test": name, "label": "build",
                   **measure(["cmake", "--build", folder, "--target", *targets], env=environment,
                             stdout=subprocess.DEVNULL)}


def run_checks():
    for name, command in CHECKS.items():
        yield {"test": name, "label": "checks", **measure(command, stdout=subprocess.DEVNULL)}


def print_table(rows, before):
    """Sums of labels, then each test that took a second; with the former times where there are any."""
    former = {row["test"]: row["cpu"] for row in before}
    labels, former_labels = {}, {}
    for kept, source in ((labels, rows), (former_labels, before)):
        for row in source:
            kept[row["label"]] = kept.get(row["label"], 0.0) + row["cpu"]
    table = [("all", sum(former_labels.values()), sum(labels.values()))]
    table += [(name, former_labels.get(name, 0.0), cpu) for name, cpu in
              sorted({**dict.fromkeys(former_labels, 0.0), **labels}.items(), key=lambda row: -row[1])]
    table.append(None)
    table += [(row["test"], former.get(row["test"], 0.0), row["cpu"])
              for row in sorted(rows, key=lambda row: -row["cpu"]) if row["cpu"] >= 1.0]
    print(f"{'before':>9} {'cpu s':>9}" if before else f"{'cpu s':>9}")
    for row in table:
        if row is None:
            print()
            continue
        name, old, cpu = row
        print(f"{old:9.1f} {cpu:9.1f}  {name}" if before else f"{cpu:9.1f}  {name}")


def main():
    parser = argparse.ArgumentParser(description=DESCRIPTION,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-j", type=int, default=1, metavar="N", help="tests at a time")
    parser.add_argument("--build", action="store_true",
                        help="also build the program and the tests in a new folder, without ccache")
    parser.add_argument("--checks", action="store_true",
                        help="also run the checks of .ci/run: format, sanitizers, fuzzers")
    parser.add_argument("--before", type=pathlib.Path, metavar="FILE",
                        help="an earlier result, whose times become a column")
    parser.add_argument("--no-tests", action="store_true", help="run no suites: with --build, --checks")
    options, ctest = parser.parse_known_args()
    if options.j < 1:
        parser.error("-j takes a number of at least 1")
    before = []
    if options.before:
        try:
            before = json.loads(options.before.read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            sys.exit(f"test_times: {options.before}: {error}")
    if not (BUILD / "CTestTestfile.cmake").exists():
        sys.exit("test_times: build/release has no tests; scripts/setup.sh --with-tests builds them")
    rows = []
    sources = [run_build()] if options.build else []
    sources += [] if options.no_tests else [run_tests(ctest, options.j)]
    sources += [run_checks()] if options.checks else []
    for source in sources:
        for row in source:
            rows.append(row)
            if row["status"]:
                print(f"{row['test']} failed", file=sys.stderr)
            RESULT.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
    print_table(rows, before)
    sys.exit(any(row["status"] not in (0, 77) for row in rows))


if __name__ == "__main__":
    main()
