#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs what is missing, configures and builds; leaves build/release/shutter.
set -euo pipefail

script_name=setup
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/lib/messages.sh
source "$root/scripts/lib/messages.sh"
# shellcheck source=scripts/lib/backports.sh
source "$root/scripts/lib/backports.sh"
# shellcheck source=scripts/lib/packages.sh
source "$root/scripts/lib/packages.sh"

usage() {
    cat <<'TEXT'
usage: scripts/setup.sh [--with-tests] [--no-packages] [--no-build]
  --with-tests    also install and build what only the tests use
  --no-packages   install nothing
  --no-build      neither configure nor build
TEXT
}

# The preset is read again only when it changed: Ninja itself notices changed CMakeLists.txt.
configure() {
    local generated=build/release/build.ninja
    if [[ ! -e $generated || CMakePresets.json -nt $generated ]]; then
        cmake --preset release
    fi
}

main() {
    local packages=yes build=yes tests=
    while (($#)); do
        case $1 in
            --with-tests) tests=with-tests ;;
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
    [[ $packages == no ]] || ensure_packages "$tests"
    if [[ $build == yes ]]; then
        configure
        if [[ -n $tests ]]; then
            cmake --build --preset release
        else
            cmake --build --preset release --target shutter shutter_assets
        fi
    fi
}

main "$@"
