# shellcheck shell=bash
# SPDX-License-Identifier: MIT
# How the scripts speak; script_name is set by the script that sources this.

say() {
    printf '%s: %s\n' "${script_name:-shutter}" "$*"
}

# Prints the reason on stderr and ends the script with status 1.
die() {
    printf '%s: %s\n' "${script_name:-shutter}" "$*" >&2
    exit 1
}

# The same for a command line that was not understood: status 2.
die_of_usage() {
    printf '%s: %s\n' "${script_name:-shutter}" "$*" >&2
    exit 2
}
