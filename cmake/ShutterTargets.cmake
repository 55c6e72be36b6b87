# SPDX-License-Identifier: MIT
# The kinds of target in this tree: a library a folder, shaders compiled to SPIR-V, and files that
# a program carries in itself.

get_filename_component(SHUTTER_ROOT ${CMAKE_CURRENT_LIST_DIR} DIRECTORY)

find_program(SHUTTER_GLSLANG NAMES glslang glslangValidator REQUIRED)

# Settings every target of this project shares.
function(shutter_target_defaults target)
    target_compile_features(${target} PUBLIC cxx_std_20)
    target_include_directories(${target} PUBLIC ${SHUTTER_ROOT} ${SHUTTER_ROOT}/shaders)
    # No contraction into fused multiply-add: the CPU reference of a shader must round as written.
    target_compile_options(
        ${target} PRIVATE -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion
                          -Wno-missing-field-initializers # Vulkan structs are opened by sType alone
                          -ffp-contract=off)
    if(SHUTTER_WERROR)
        target_compile_options(${target} PRIVATE -Werror)
    endif()
    if(SHUTTER_SANITIZE)
        target_compile_options(${target} PUBLIC -fsanitize=address,undefined -fno-sanitize=vptr)
        target_link_options(${target} PUBLIC -fsanitize=address,undefined)
    endif()
endfunction()

# shutter_library(<name> SOURCES ... HEADERS ... LINKS ...)
# One folder, one library `shutter_<name>`; LINKS are public and are the folder's allowed includes.
function(shutter_library name)
    cmake_parse_arguments(ARG "" "" "SOURCES;HEADERS;LINKS;PRIVATE_LINKS" ${ARGN})
    set(target shutter_${name})
    if(ARG_SOURCES)
        add_library(${target} STATIC ${ARG_SOURCES} ${ARG_HEADERS})
        shutter_target_defaults(${target})
        target_link_libraries(${target} PUBLIC ${ARG_LINKS} PRIVATE ${ARG_PRIVATE_LINKS})
    else()
        add_library(${target} INTERFACE)
        target_include_directories(${target} INTERFACE ${SHUTTER_ROOT})
        target_link_libraries(${target} INTERFACE ${ARG_LINKS})
    endif()
endfunction()

# shutter_shaders(<target> <path below shaders/>...)
# Compiles each GLSL file to SPIR-V at build time and makes it a header "spirv/<path>.h" that
# defines `const uint32_t <path with _ for / and .>[]`. Rebuilt when any included file changes.
function(shutter_shaders target)
    foreach(shader ${ARGN})
        string(MAKE_C_IDENTIFIER ${shader} symbol)
        set(source ${SHUTTER_ROOT}/shaders/${shader})
        set(output ${CMAKE_BINARY_DIR}/generated/spirv/${shader}.h)
        get_filename_component(output_dir ${output} DIRECTORY)
        file(MAKE_DIRECTORY ${output_dir})
        add_custom_command(
            OUTPUT ${output}
            COMMAND
                ${SHUTTER_GLSLANG} -V --target-env vulkan1.3 --quiet -I${SHUTTER_ROOT}/shaders
                --depfile ${output}.d --vn ${symbol} -o ${output} ${source}
            DEPENDS ${source}
            DEPFILE ${output}.d
            COMMENT "GLSL ${shader}"
            VERBATIM)
        list(APPEND outputs ${output})
    endforeach()
    target_sources(${target} PRIVATE ${outputs})
    target_include_directories(${target} PRIVATE ${CMAKE_BINARY_DIR}/generated)
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
    target_sources(${target} PRIVATE ${outputs})
    target_include_directories(${target} PRIVATE ${CMAKE_BINARY_DIR}/generated)
endfunction()

# shutter_embed(<target> <header> <symbol> <file>)
# Makes a file a header, named from the repository root as if it lay there, that defines
# `constexpr char <symbol>[]`: the file's bytes and a zero. Rebuilt when the file changes.
function(shutter_embed target header symbol source)
    get_filename_component(source ${source} ABSOLUTE)
    set(output ${CMAKE_BINARY_DIR}/generated/${header})
    get_filename_component(output_dir ${output} DIRECTORY)
    file(MAKE_DIRECTORY ${output_dir})
    add_custom_command(
        OUTPUT ${output}
        COMMAND ${CMAKE_COMMAND} -DSOURCE=${source} -DOUTPUT=${output} -DSYMBOL=${symbol} -P
                ${SHUTTER_ROOT}/cmake/EmbedBytes.cmake
        DEPENDS ${source} ${SHUTTER_ROOT}/cmake/EmbedBytes.cmake
        COMMENT "Embedding ${header}"
        VERBATIM)
    target_sources(${target} PRIVATE ${output})
    target_include_directories(${target} PRIVATE ${CMAKE_BINARY_DIR}/generated)
endfunction()
