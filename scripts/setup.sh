#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs missing packages, configures and builds; leaves build/release/shutter.
set -euo pipefail

script_name=setup
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/lib/messages.sh
source "$root/scripts/lib/messages.sh"
# shellcheck source=scripts/lib/backports.sh
source "$root/scripts/lib/backports.sh"
# shellcheck source=scripts/lib/llvm_tools.sh
source "$root/scripts/lib/llvm_tools.sh"
# shellcheck source=scripts/lib/packages.sh
source "$root/scripts/lib/packages.sh"

usage() {
    cat <<'TEXT'
usage: scripts/setup.sh [--with-tests] [--with-checks] [--no-packages] [--no-build]
  --with-tests    also install and build what only the tests use
  --with-checks   also install what scripts/check_*.sh use
  --no-packages   install nothing
  --no-build      neither configure nor build
SHUTTER_WERROR=ON in the environment makes compiler warnings errors, OFF no longer does.
TEXT
}

# Whether the build folder is configured, by today's presets, for the tests if $1 is not empty, and as
# SHUTTER_WERROR asks. Ninja itself notices changed CMakeLists.txt.
is_configured() {
    local folder=build/release
    [[ -e $folder/build.ninja && ! CMakePresets.json -nt $folder/build.ninja ]] || return 1
    [[ -z $1 ]] || grep -qx SHUTTER_TESTS:BOOL=ON "$folder/CMakeCache.txt" || return 1
    [[ -z ${SHUTTER_WERROR:-} ]] ||
        grep -qx "SHUTTER_WERROR:BOOL=$SHUTTER_WERROR" "$folder/CMakeCache.txt"
}

configure() {
    is_configured "$1" || cmake --preset release -DSHUTTER_TESTS="$([[ -n $1 ]] && echo ON || echo OFF)" \
        ${SHUTTER_WERROR:+"-DSHUTTER_WERROR=$SHUTTER_WERROR"}
}

main() {
    local packages=yes build=yes tests='' checks=''
    while (($#)); do
        case $1 in
            --with-tests) tests=with-tests ;;
            --with-checks) checks=with-checks ;;
            --no-packages) packages=no ;;
            --no-build) build=no ;;
            -h | --help)
                usage
                exit 0
                ;;
            *)
                usage >&2
                die_of_usage "unknown option $1"
                ;;
        esac
        shift
    done
    cd "$root"
    [[ $packages == no ]] || ensure_packages "$tests" "$checks"
    if [[ $build == yes ]]; then
        configure "$tests"
        if [[ -n $tests ]]; then
            cmake --build --preset release
        else
            cmake --build --preset release --target shutter shutter_assets
        fi
    fi
}

main "$@"
