# SPDX-License-Identifier: MIT
# An overlay port: it builds the tree that it lies in.
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)

# The shared library for C and the static libraries for C++ are different interfaces, so there are
# always both.
set(VCPKG_POLICY_DLLS_IN_STATIC_LIBRARY enabled)

# The first was called glslangValidator until version 13.
find_program(
    GLSLANG NAMES glslang glslangValidator
    PATHS "${CURRENT_HOST_INSTALLED_DIR}/tools/glslang" NO_DEFAULT_PATH REQUIRED)
set(SPIRV_TOOLS "${CURRENT_HOST_INSTALLED_DIR}/tools/spirv-tools")
vcpkg_cmake_configure(
    SOURCE_PATH "${SOURCE_PATH}"
    OPTIONS
        -DSHUTTER_EMBEDDING_ONLY=ON
        "-DSHUTTER_GLSLANG=${GLSLANG}"
        "-DSHUTTER_SPIRV_OPT=${SPIRV_TOOLS}/spirv-opt${VCPKG_HOST_EXECUTABLE_SUFFIX}"
        "-DSHUTTER_SPIRV_VAL=${SPIRV_TOOLS}/spirv-val${VCPKG_HOST_EXECUTABLE_SUFFIX}")
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(PACKAGE_NAME Shutter CONFIG_PATH lib/cmake/Shutter)
vcpkg_fixup_pkgconfig()

file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
