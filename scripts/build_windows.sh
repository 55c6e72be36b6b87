#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Cross-builds the embeddable motion blur for 64-bit Windows with MinGW-w64, and with it the host in
# C; runs that under Wine where Wine has Vulkan.
set -euo pipefail

script_name=build_windows
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/lib/messages.sh
source "$root/scripts/lib/messages.sh"

readonly tools=x86_64-w64-mingw32
readonly compiler=$tools-g++-posix

usage() {
    cat <<'TEXT'
usage: scripts/build_windows.sh [--run] [FOLDER]
  --run    run the host in C under Wine as well, and check that it blurs
FOLDER is where to build, build/windows unless given. The package is in FOLDER/package.
Exit status: 0 built (and ran), 1 not, 77 MinGW-w64 is missing, or Wine where it should run.
TEXT
}

# Headers that do not depend on the system, away from those that do, and packages of them.
make_packages() {
    local folder=$1 name
    mkdir -p "$folder/include" "$folder/lib/cmake/"{fmt,glm,nlohmann_json}
    for name in vulkan vk_video fmt glm nlohmann; do
        [[ -d /usr/include/$name ]] || die "/usr/include/$name is missing"
        ln -sfn "/usr/include/$name" "$folder/include/$name"
    done
    for name in fmt glm; do
        cat >"$folder/lib/cmake/$name/$name-config.cmake" <<TEXT
if(NOT TARGET $name::$name)
    add_library($name::$name INTERFACE IMPORTED)
    set_target_properties($name::$name PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "$folder/include")
endif()
TEXT
    done
    cat >"$folder/lib/cmake/nlohmann_json/nlohmann_json-config.cmake" <<TEXT
if(NOT TARGET nlohmann_json::nlohmann_json)
    add_library(nlohmann_json::nlohmann_json INTERFACE IMPORTED)
    set_target_properties(nlohmann_json::nlohmann_json PROPERTIES
        INTERFACE_INCLUDE_DIRECTORIES "$folder/include")
endif()
TEXT
    printf '%s\n' 'set_property(TARGET fmt::fmt PROPERTY INTERFACE_COMPILE_DEFINITIONS FMT_HEADER_ONLY)' \
        >>"$folder/lib/cmake/fmt/fmt-config.cmake"
    # What hosts link to: the functions that the header declares are those of the loader's DLL. The
    # libraries themselves look them up while they run.
    {
        printf 'LIBRARY vulkan-1.dll\nEXPORTS\n'
        sed -n '/^#ifndef VK_NO_PROTOTYPES/,/^#endif/s/.*VKAPI_CALL \(vk[A-Za-z0-9]*\)(.*/\1/p' \
            /usr/include/vulkan/vulkan_core.h | grep -v '[A-Z][A-Z]$' | sort -u
    } >"$folder/lib/vulkan-1.def"
    "$tools-dlltool" -d "$folder/lib/vulkan-1.def" -l "$folder/lib/libvulkan-1.dll.a"
}

configure() {
    local source=$1 build=$2 packages=$3
    shift 3
    cmake -G Ninja -S "$source" -B "$build" --toolchain "$root/cmake/MinGW.cmake" \
        -DCMAKE_BUILD_TYPE=Release "-DCMAKE_PREFIX_PATH=$packages;$folder/package" \
        "-DVulkan_INCLUDE_DIR=$packages/include" \
        "-DVulkan_LIBRARY=$packages/lib/libvulkan-1.dll.a" "$@"
}

# Nothing in the DLL may need files that are not part of Windows.
check_dll() {
    local dll=$1 said needed
    said=$("$tools-objdump" -p "$dll")
    needed=$(sed -n 's/.*DLL Name: //p' <<<"$said")
    if grep -qiE 'libgcc|libstdc|winpthread|fmt|vulkan' <<<"$needed"; then
        die "$dll needs ${needed//$'\n'/, }"
    fi
    grep -q 'shutterBlurRecord' <<<"$said" || die "$dll exports no shutterBlurRecord"
}

run_host() {
    local folder=$1 display=()
    command -v wine >/dev/null || {
        say "Wine is missing (Debian and Ubuntu: wine64); the host was built but not run"
        exit 77
    }
    # Wine's Vulkan comes with its driver of the display.
    [[ -n ${DISPLAY:-} ]] || display=(xvfb-run --auto-servernum)
    (
        cd "$folder"
        rm -f before.ppm after.ppm
        WINEPREFIX=$folder/wine WINEDEBUG=-all "${display[@]}" wine ./c_host.exe
        [[ -s after.ppm ]] || die "the host wrote no picture"
        ! cmp -s before.ppm after.ppm || die "the host's picture is not blurred"
    )
    say "the host in C ran under $(wine --version): $folder/after.ppm"
}

main() {
    local run=no folder=$root/build/windows
    while (($#)); do
        case $1 in
            --run) run=yes ;;
            -h | --help)
                usage
                exit 0
                ;;
            -*)
                usage >&2
                die_of_usage "unknown option $1"
                ;;
            *) folder=$(realpath -m "$1") ;;
        esac
        shift
    done
    command -v "$compiler" >/dev/null || {
        say "$compiler is missing (Debian and Ubuntu: g++-mingw-w64-x86-64-posix)"
        exit 77
    }
    make_packages "$folder/packages"
    configure "$root" "$folder/library" "$folder/packages" -DSHUTTER_EMBEDDING_ONLY=ON
    cmake --build "$folder/library" --parallel 2
    cmake --install "$folder/library" --prefix "$folder/package"
    check_dll "$folder/package/bin/libshutter_motion_blur.dll"
    configure "$root/game/examples/c_host" "$folder/host" "$folder/packages"
    cmake --build "$folder/host"
    cp "$folder/package/bin/libshutter_motion_blur.dll" "$folder/host/"
    say "built: $folder/package"
    [[ $run == no ]] || run_host "$folder/host"
}

main "$@"
