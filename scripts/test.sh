#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Sets up and runs the tests on Mesa's software device; arguments go to ctest, e.g. -L unit. Without
# any, tests that skip must be those of tests/expected_skips.txt.
# VK_DRIVER_FILES picks another device, CTEST_PARALLEL_LEVEL the number of tests at a time.
set -euo pipefail

script_name='test'
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/lib/messages.sh
source "$root/scripts/lib/messages.sh"
# shellcheck source=scripts/lib/lavapipe.sh
source "$root/scripts/lib/lavapipe.sh"

"$root/scripts/setup.sh" --with-tests
force_lavapipe
compile_shaders_quickly
cd "$root"
run_ctest() {
    ctest --preset release -j "${CTEST_PARALLEL_LEVEL:-2}" "$@"
}

# A selection of tests does not check those that skip.
if (($#)); then
    run_ctest "$@"
    exit
fi
results=build/release/test_results.xml
cases=build/release/test_results
status=0
rm -rf "$results" "$cases"
run_ctest --output-junit "$root/$results" || status=$?
scripts/check_skips.py "$results" "$cases" tests/expected_skips.txt || status=1
exit "$status"
