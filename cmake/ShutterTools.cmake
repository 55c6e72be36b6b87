# SPDX-License-Identifier: MIT
# Functions that make headers of shaders and of files: for this tree, and for projects that found
# the installed package. Who includes this has set SHUTTER_SHADER_DIR, the folder of the shaders that
# others may include, and, in this tree, SHUTTER_SHADER_ROOT.

set(SHUTTER_TOOLS_DIR ${CMAKE_CURRENT_LIST_DIR})

find_program(SHUTTER_GLSLANG NAMES glslang glslangValidator)
find_program(SHUTTER_SPIRV_OPT spirv-opt)
find_program(SHUTTER_SPIRV_VAL spirv-val)

# What spirv-opt -O of SPIRV-Tools 2023.1 does, without simplify-instructions: that one reorders
# arithmetic of floats, and pictures would depend on the optimiser's version. Behind them, what takes
# unused variables out of the interface: later versions leave those of resources in.
set(SHUTTER_SPIRV_PASSES
    --wrap-opkill --eliminate-dead-branches --merge-return --inline-entry-points-exhaustive
    --eliminate-dead-functions --eliminate-dead-code-aggressive --private-to-local
    --eliminate-local-single-block --eliminate-local-single-store --eliminate-dead-code-aggressive
    --scalar-replacement=100 --convert-local-access-chains --eliminate-local-single-block
    --eliminate-local-single-store --eliminate-dead-code-aggressive --ssa-rewrite
    --eliminate-dead-code-aggressive --ccp --eliminate-dead-code-aggressive --loop-unroll
    --eliminate-dead-branches --redundancy-elimination --combine-access-chains
    --scalar-replacement=100 --convert-local-access-chains --eliminate-local-single-block
    --eliminate-local-single-store --eliminate-dead-code-aggressive --ssa-rewrite
    --eliminate-dead-code-aggressive --vector-dce --eliminate-dead-inserts --eliminate-dead-branches
    --if-conversion --copy-propagate-arrays --reduce-load-size --eliminate-dead-code-aggressive
    --merge-blocks --redundancy-elimination --eliminate-dead-branches --merge-blocks
    --remove-unused-interface-variables --eliminate-dead-variables)

# Has `target` made from the files that follow, which lie below the folder of made headers.
function(_shutter_add_generated target)
    target_sources(${target} PRIVATE ${ARGN})
    target_include_directories(${target} PRIVATE ${CMAKE_BINARY_DIR}/generated)
endfunction()

# shutter_shaders(<target> [ROOT <folder>] <path below the root>...)
# Compiles each GLSL file to SPIR-V at build time, optimises and validates it, and makes it a header
# "spirv/<path>.h" that defines `const uint32_t <path with _ for / and .>[]`. Optimising takes out
# what an entry point does not use: what a module declares counts as used by it in Vulkan's rules.
# Rebuilt when any included file changes. The root is the current source folder (in this tree:
# shaders/); shaders may include files below it and Shutter's ("common/numeric.glsl").
function(shutter_shaders target)
    cmake_parse_arguments(ARG "" "ROOT" "" ${ARGN})
    if(NOT SHUTTER_GLSLANG)
        message(FATAL_ERROR "shutter_shaders: neither glslang nor glslangValidator was found "
                            "(Debian and Ubuntu: glslang-tools)")
    endif()
    if(NOT SHUTTER_SPIRV_OPT OR NOT SHUTTER_SPIRV_VAL)
        message(FATAL_ERROR "shutter_shaders: spirv-opt or spirv-val was not found "
                            "(Debian and Ubuntu: spirv-tools)")
    endif()
    if(NOT ARG_ROOT)
        set(ARG_ROOT ${CMAKE_CURRENT_SOURCE_DIR})
        if(SHUTTER_SHADER_ROOT)
            set(ARG_ROOT ${SHUTTER_SHADER_ROOT})
        endif()
    endif()
    foreach(shader IN LISTS ARG_UNPARSED_ARGUMENTS)
        string(MAKE_C_IDENTIFIER ${shader} symbol)
        set(source ${ARG_ROOT}/${shader})
        set(output ${CMAKE_BINARY_DIR}/generated/spirv/${shader}.h)
        get_filename_component(output_dir ${output} DIRECTORY)
        file(MAKE_DIRECTORY ${output_dir})
        set(module ${CMAKE_BINARY_DIR}/generated/spirv/${shader}.spv)
        add_custom_command(
            # In front, as the file of its dependencies names it.
            OUTPUT ${module}.raw ${module} ${output}
            COMMAND
                ${SHUTTER_GLSLANG} -V --target-env vulkan1.3 --quiet -I${ARG_ROOT}
                -I${SHUTTER_SHADER_DIR} --depfile ${module}.d -o ${module}.raw ${source}
            COMMAND ${SHUTTER_SPIRV_OPT} --target-env=vulkan1.3 --scalar-block-layout
                    ${SHUTTER_SPIRV_PASSES} ${module}.raw -o ${module}
            COMMAND ${SHUTTER_SPIRV_VAL} --target-env vulkan1.3 --scalar-block-layout ${module}
            COMMAND ${CMAKE_COMMAND} -DSOURCE=${module} -DOUTPUT=${output} -DSYMBOL=${symbol} -P
                    ${SHUTTER_TOOLS_DIR}/EmbedWords.cmake
            DEPENDS ${source} ${SHUTTER_TOOLS_DIR}/EmbedWords.cmake
            DEPFILE ${module}.d
            COMMENT "GLSL ${shader}"
            VERBATIM)
        list(APPEND outputs ${output})
    endforeach()
    _shutter_add_generated(${target} ${outputs})
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
                ${SHUTTER_TOOLS_DIR}/EmbedBytes.cmake
        DEPENDS ${source} ${SHUTTER_TOOLS_DIR}/EmbedBytes.cmake
        COMMENT "Embedding ${header}"
        VERBATIM)
    _shutter_add_generated(${target} ${output})
endfunction()
