# shellcheck shell=bash
# SPDX-License-Identifier: MIT
# Picks Mesa's software device, so that a test sees the same driver on every machine.

# Prints the path of lavapipe's driver description; returns 1 if there is none. The name carries the
# architecture in some versions of the package and not in others.
find_lavapipe() {
    local folder name
    for folder in /usr/share/vulkan/icd.d /usr/local/share/vulkan/icd.d /etc/vulkan/icd.d; do
        for name in "lvp_icd.$(uname -m).json" lvp_icd.json; do
            if [[ -r $folder/$name ]]; then
                printf '%s\n' "$folder/$name"
                return 0
            fi
        done
    done
    return 1
}

# Exports the two names under which old and new Vulkan loaders search a driver. A choice that the
# caller made stays, so that the tests can be pointed at another device. Names Mesa's folder of
# compiled shaders, too: a test that has a home or a folder of caches of its own would compile each
# shader again, which takes lavapipe six times as long as the rest of a small picture.
force_lavapipe() {
    local chosen=${VK_DRIVER_FILES:-${VK_ICD_FILENAMES:-}}
    if [[ -n $chosen ]]; then
        say "Vulkan driver as the environment asks: $chosen"
    else
        chosen=$(find_lavapipe) ||
            die "lavapipe is not installed: no lvp_icd*.json below /usr/share/vulkan/icd.d" \
                "(package mesa-vulkan-drivers)"
        say "Vulkan driver: $chosen"
    fi
    export VK_DRIVER_FILES=$chosen VK_ICD_FILENAMES=$chosen
    export MESA_SHADER_CACHE_DIR=${MESA_SHADER_CACHE_DIR:-${XDG_CACHE_HOME:-${HOME:-/tmp}/.cache}}
}

# Makes lavapipe compile shaders without LLVM's optimisations, which pays for many small pictures. They
# keep their bits (tests/determinism). Without compiled shaders at hand, a picture by `adaptive` takes 26 s
# of processor instead of 83; drawing takes about half as long again.
compile_shaders_quickly() {
    export GALLIVM_PERF=${GALLIVM_PERF:-nopt}
}
