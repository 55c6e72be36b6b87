# SPDX-License-Identifier: MIT
# The kinds of target in this tree: a library a folder, and what its sources are made into
# (ShutterTools.cmake).

get_filename_component(SHUTTER_ROOT ${CMAKE_CURRENT_LIST_DIR} DIRECTORY)
set(SHUTTER_SHADER_DIR ${SHUTTER_ROOT}/shaders)
set(SHUTTER_SHADER_ROOT ${SHUTTER_SHADER_DIR})
include(${CMAKE_CURRENT_LIST_DIR}/ShutterTools.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/ShutterInstall.cmake)

# Settings every target of this project shares.
function(shutter_target_defaults target)
    target_compile_features(${target} PUBLIC cxx_std_20)
    shutter_include_roots(${target} PUBLIC)
    # Vulkan's functions are found while the program runs (engine/gpu/vulkan_functions.h), so that
    # nothing needs the library that Vulkan::Vulkan, which hosts use, would have it linked to.
    target_compile_definitions(${target} PRIVATE SHUTTER_LOADS_VULKAN)
    target_link_options(${target} PRIVATE LINKER:--as-needed)
    # No contraction into fused multiply-add: the CPU reference of a shader must round as written.
    target_compile_options(
        ${target} PRIVATE -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion
                          -Wno-missing-field-initializers # Vulkan structs are opened by sType alone
                          # False in GCC 12: https://gcc.gnu.org/PR105651
                          $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
                          # ccache asks for it where headers are precompiled.
                          $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>
                          -ffp-contract=off)
    if(SHUTTER_WERROR)
        target_compile_options(${target} PRIVATE -Werror)
    endif()
    if(SHUTTER_FUZZERS)
        target_compile_options(${target} PUBLIC -fsanitize=fuzzer-no-link)
    endif()
    if(SHUTTER_SANITIZE)
        target_compile_options(${target} PUBLIC -fsanitize=${SHUTTER_SANITIZE} -fno-sanitize=vptr)
        target_link_options(${target} PUBLIC -fsanitize=${SHUTTER_SANITIZE})
    endif()
endfunction()

# Libraries that are parts of the shared library (modules/motion_blur), too. What they use of fmt is
# within them, since a host may have another version of it.
set(SHUTTER_SHARED_PARTS core math gpu graph motion_blur motion_blur_c)
function(_shutter_make_shared_part target)
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    target_compile_definitions(${target} PRIVATE FMT_HEADER_ONLY)
endfunction()

# The headers that most files read and that this tree rarely changes: without them precompiled, a
# third of a build's time goes into reading them. Files include what they use all the same: the test
# `layering` and the preset `dev`, which precompiles nothing, find missing includes.
set(SHUTTER_PRECOMPILED_HEADERS
    <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream> <functional> <limits> <map>
    <memory> <numbers> <optional> <set> <span> <string> <string_view> <utility> <vector>
    <fmt/format.h> <vulkan/vulkan.h>
    <engine/math/math.h>) # GLM as the tree sets it up

# shutter_precompile(<target> <what it links to>... [HEADERS <more headers>...])
# Precompiles them once, for all targets that are compiled alike: target_precompile_headers(...
# REUSE_FROM <target>).
function(shutter_precompile target)
    cmake_parse_arguments(ARG "" "" "HEADERS" ${ARGN})
    set(source ${CMAKE_BINARY_DIR}/generated/${target}.cpp)
    file(CONFIGURE OUTPUT ${source} CONTENT "")
    add_library(${target} OBJECT ${source})
    shutter_target_defaults(${target})
    target_link_libraries(${target} PRIVATE fmt::fmt Vulkan::Vulkan ${ARG_UNPARSED_ARGUMENTS})
    target_precompile_headers(${target} PRIVATE ${SHUTTER_PRECOMPILED_HEADERS} ${ARG_HEADERS})
endfunction()

# The presets `release` and `fuzz` compile several sources of a library as one (a unity build), which
# instantiates the templates that they share once. Names in unnamed namespaces must therefore differ
# within a library; a source that cannot have it so is compiled alone (SKIP_UNITY_BUILD_INCLUSION).

# shutter_library(<name> SOURCES ... HEADERS ... LINKS ... PRIVATE_LINKS ...)
# One folder, one library `shutter_<name>`; LINKS are public and are the folder's allowed includes.
# Those of engine/ and modules/ are installed.
function(shutter_library name)
    cmake_parse_arguments(ARG "" "" "SOURCES;HEADERS;LINKS;PRIVATE_LINKS" ${ARGN})
    set(target shutter_${name})
    if(ARG_SOURCES)
        add_library(${target} STATIC ${ARG_SOURCES} ${ARG_HEADERS})
        shutter_target_defaults(${target})
        target_link_libraries(${target} PUBLIC ${ARG_LINKS} PRIVATE ${ARG_PRIVATE_LINKS})
        set(precompiled shutter_precompiled)
        if(name IN_LIST SHUTTER_SHARED_PARTS)
            _shutter_make_shared_part(${target})
            set(precompiled shutter_precompiled_shared)
        endif()
        # Builds of the embedding alone have none.
        if(TARGET ${precompiled})
            target_precompile_headers(${target} REUSE_FROM ${precompiled})
        endif()
    else()
        add_library(${target} INTERFACE)
        shutter_include_roots(${target} INTERFACE)
        target_link_libraries(${target} INTERFACE ${ARG_LINKS})
    endif()
    shutter_install_library(${name} ${ARG_LINKS} ${ARG_PRIVATE_LINKS})
endfunction()

# shutter_double_shaders(<target> <path below shaders/>...)
# Makes each pure GLSL file a header "double/<path>.h" that holds its functions in double precision,
# namespace shutter::shader64: what references in tests and benchmarks compute with.
function(shutter_double_shaders target)
    foreach(shader ${ARGN})
        set(source ${SHUTTER_ROOT}/shaders/${shader})
        set(output ${CMAKE_BINARY_DIR}/generated/double/${shader}.h)
        get_filename_component(output_dir ${output} DIRECTORY)
        file(MAKE_DIRECTORY ${output_dir})
        add_custom_command(
            OUTPUT ${output}
            COMMAND ${CMAKE_COMMAND} -DSOURCE=${source} -DOUTPUT=${output} -P
                    ${SHUTTER_ROOT}/cmake/DoubleShader.cmake
            DEPENDS ${source} ${SHUTTER_ROOT}/cmake/DoubleShader.cmake
            COMMENT "Double precision ${shader}"
            VERBATIM)
        list(APPEND outputs ${output})
    endforeach()
    _shutter_add_generated(${target} ${outputs})
endfunction()
