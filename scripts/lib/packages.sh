# shellcheck shell=bash
# SPDX-License-Identifier: MIT
# Installs the packages that the build needs and that are missing. Sourced by scripts/setup.sh, with
# backports.sh and llvm_tools.sh.

# Debian 12, Debian 13 and Ubuntu 24.04 share these names. openimageio-tools and libopencv-core-dev
# are here because OpenImageIO's CMake files refer to /usr/bin/iconvert and /usr/include/opencv4 and
# stop the configuration when they are absent.
build_packages=(
    g++ cmake ninja-build pkg-config glslang-tools spirv-tools
    libvulkan-dev libglfw3-dev libglm-dev libfmt-dev libcli11-dev nlohmann-json3-dev
    libtinygltf-dev libstb-dev libopenimageio-dev openimageio-tools libopencv-core-dev
    libimgui-dev fonts-dejavu-core vulkan-validationlayers libjs-chart.js
    ffmpeg # for films
)
# Only the tests compare with scikit-image, look at the report page in a browser and at
# windows on a display without a screen, and have hosts with volk.
test_packages=(libgtest-dev python3-skimage python3-jsonschema python3-selenium xvfb xauth openbox
    libvulkan-volk-dev)
# Ubuntu has these as snaps alone, which cannot open files of the tests; they skip there.
debian_test_packages=(chromium chromium-driver)
# What scripts/check_*.sh judge the tree by; Debian 13 no longer has that version.
check_packages=(
    "clang-format-$llvm_version" "clang-tidy-$llvm_version"
    "clang-$llvm_version" "libclang-rt-$llvm_version-dev"
)
# lavapipe traces rays from this version of Mesa on.
mesa_package=mesa-vulkan-drivers
mesa_minimum=24.1
# What Mesa's drivers for GPUs run on where there is no GPU. It comes with Mesa, where it is packaged.
shim_package=mesa-drm-shim

apt_lists_are_fresh=no

# Prints a version as people write it: without the parts that packagers add.
short_version() {
    local version=${1#*:}
    printf '%s' "${version%%-*}"
}

# Prints those of its arguments that are not installed, one per line.
missing_packages() {
    local name state
    for name in "$@"; do
        state=$(dpkg-query -W -f '${db:Status-Status}' "$name" 2>/dev/null || true)
        [[ $state == installed ]] || printf '%s\n' "$name"
    done
}

# Whether version $1 exists and traces rays.
mesa_is_new_enough() {
    [[ -n $1 && $1 != "(none)" ]] && dpkg --compare-versions "$1" ge "$mesa_minimum"
}

installed_version() {
    dpkg-query -W -f '${Version}' "$1" 2>/dev/null || true
}

# The version that a plain `apt-get install` would take.
candidate_version() {
    apt-cache policy "$1" | sed -n 's/^ *Candidate: *//p'
}

can_be_root() {
    [[ $(id -u) == 0 ]] || command -v sudo >/dev/null
}

as_root() {
    if [[ $(id -u) == 0 ]]; then
        "$@"
    else
        sudo "$@"
    fi
}

# Goes on when it fails: an archive that cannot be reached need not be one that we take from, and
# apt-get install reports missing packages.
update_apt_lists() {
    say "refreshing the package lists"
    if ! as_root apt-get -q --error-on=any update; then
        say "apt-get update failed; once more"
        as_root apt-get -q --error-on=any update ||
            say "warning: apt-get update failed twice; going on with the lists there are"
    fi
    apt_lists_are_fresh=yes
}

# The same, once a run.
refresh_apt_lists() {
    [[ $apt_lists_are_fresh == yes ]] || update_apt_lists
}

# apt-get install without questions and without recommended packages.
install_packages() {
    as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o DPkg::Lock::Timeout=300 \
        install --no-install-recommends "$@" || die "apt-get could not install: $*"
}

# Takes Mesa from where it is new enough to trace rays; warns where it is nowhere.
install_mesa() {
    local version codename=$1
    refresh_apt_lists
    version=$(candidate_version "$mesa_package")
    if mesa_is_new_enough "$version"; then
        install_packages "$mesa_package"
        return
    fi
    if [[ $codename == bookworm ]]; then
        say "the stock Mesa is $(short_version "$version");" \
            "ray tracing without a GPU needs $mesa_minimum, which $codename-backports has"
        [[ -n $(backports_version "$codename" "$mesa_package") ]] ||
            add_backports "$codename" "$mesa_package"
        version=$(backports_version "$codename" "$mesa_package")
        if mesa_is_new_enough "$version"; then
            say "installing Mesa $(short_version "$version") from $codename-backports"
            install_packages -t "$codename-backports" "$mesa_package"
            return
        fi
    fi
    [[ -n $(installed_version "$mesa_package") ]] || install_packages "$mesa_package"
    say "warning: apt has no Mesa $mesa_minimum or newer here;" \
        "methods that trace rays will need a GPU"
}

# Installs the requirements of tests/gpu_static besides Mesa, where apt has it.
install_shim() {
    local version
    version=$(candidate_version "$shim_package")
    if [[ -z $version || $version == "(none)" ]]; then
        say "apt has no $shim_package here; what GPUs would run is not tested"
        return
    fi
    say "installing $shim_package"
    refresh_apt_lists
    install_packages "$shim_package"
}

# What to do on a distribution whose package names we do not know.
go_on_with_tools_found() {
    local tool absent=()
    say "this is ${1:-an unknown distribution}, not Debian 12, Debian 13 or Ubuntu 24.04;" \
        "nothing is installed here. Debian calls what the build needs:" \
        "${build_packages[*]} $mesa_package (for the tests also ${test_packages[*]})"
    for tool in c++ cmake ninja spirv-opt spirv-val; do
        command -v "$tool" >/dev/null || absent+=("$tool")
    done
    if ! command -v glslang >/dev/null && ! command -v glslangValidator >/dev/null; then
        absent+=(glslangValidator)
    fi
    if ((${#absent[@]})); then
        die "not found: ${absent[*]}; install these and the packages above, then run this again"
    fi
    say "the tools are there; going on"
}

# Installs missing packages of those above: with "with-tests" as $1, of those for the tests as well;
# with "with-checks" as $2, of those for the checks where the distribution has them. Without
# anything missing this reads the package database and nothing else.
ensure_packages() {
    local wanted=("${build_packages[@]}") missing old_mesa=no shim=no
    local ID='' VERSION_ID='' VERSION_CODENAME='' PRETTY_NAME=''
    [[ ${1:-} != with-tests ]] || wanted+=("${test_packages[@]}")
    if [[ -r /etc/os-release ]]; then
        # shellcheck source=/dev/null
        source /etc/os-release
    fi
    if [[ ${1:-} == with-tests && $ID == debian ]]; then
        wanted+=("${debian_test_packages[@]}")
    fi
    if [[ ${2:-} == with-checks && $ID-$VERSION_ID != debian-13 ]]; then
        wanted+=("${check_packages[@]}")
    fi
    case "$ID-$VERSION_ID" in
        debian-12 | debian-13 | ubuntu-24.04) ;;
        *)
            go_on_with_tools_found "$PRETTY_NAME"
            return
            ;;
    esac
    mapfile -t missing < <(missing_packages "${wanted[@]}")
    if ! mesa_is_new_enough "$(installed_version "$mesa_package")"; then
        old_mesa=yes
    fi
    if [[ ${1:-} == with-tests && -n $(missing_packages "$shim_package") ]]; then
        shim=yes
    fi
    if ((${#missing[@]} == 0)) && [[ $old_mesa == no && $shim == no ]]; then
        return
    fi
    if ! can_be_root; then
        if ((${#missing[@]})); then
            die "packages are missing, and there is no sudo to install them with; as root, run:" \
                "apt-get install --no-install-recommends ${missing[*]}"
        fi
        [[ $old_mesa == no ]] ||
            say "warning: there is no Mesa $mesa_minimum or newer, and no sudo to install it with;" \
                "methods that trace rays will need a GPU"
        return
    fi
    if ((${#missing[@]})); then
        say "installing ${missing[*]}"
        refresh_apt_lists
        install_packages "${missing[@]}"
    fi
    if [[ $old_mesa == yes ]]; then
        install_mesa "$VERSION_CODENAME"
    fi
    [[ $shim == no ]] || install_shim
}
