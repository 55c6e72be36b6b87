# SPDX-License-Identifier: MIT
# What `cmake --install` puts where: the libraries of engine/ and modules/ with their headers as a
# package that find_package(Shutter) finds (component Development), and the program with its scenes
# (component Runtime; the scenes: assets/generator).

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# What a build for other engines links of engine/ and modules/, without their headers. With the tools
# there is more, which is no part of the package.
set(SHUTTER_EMBEDDING_FOLDERS engine/core engine/math engine/gpu engine/graph modules/motion_blur)
set(SHUTTER_INSTALL_HEADERS ${CMAKE_INSTALL_INCLUDEDIR}/shutter)
set(SHUTTER_INSTALL_PACKAGE ${CMAKE_INSTALL_LIBDIR}/cmake/Shutter)
set(SHUTTER_INSTALL_DATA ${CMAKE_INSTALL_DATADIR}/shutter)

# Where "engine/...", "shaders/..." and "common/..." are found: in the tree, and once installed.
function(shutter_include_roots target scope)
    target_include_directories(
        ${target}
        ${scope}
        $<BUILD_INTERFACE:${SHUTTER_ROOT}>
        $<BUILD_INTERFACE:${SHUTTER_ROOT}/shaders>)
    if(NOT SHUTTER_EMBEDDING_ONLY)
        target_include_directories(
            ${target}
            ${scope}
            $<INSTALL_INTERFACE:${SHUTTER_INSTALL_HEADERS}>
            $<INSTALL_INTERFACE:${SHUTTER_INSTALL_HEADERS}/shaders>)
    endif()
endfunction()

# The package of a third-party library, by the library's name: <name>.pc for one that pkg-config
# knows; empty for one that is linked by its file or its plain name.
function(_shutter_find_package_name library result)
    set(${result} "" PARENT_SCOPE)
    if(library MATCHES "^PkgConfig::(.+)")
        set(${result} ${CMAKE_MATCH_1}.pc PARENT_SCOPE)
    elseif(library MATCHES "^([A-Za-z0-9_]+)::")
        set(${result} ${CMAKE_MATCH_1} PARENT_SCOPE)
    elseif(library STREQUAL "glfw")
        set(${result} glfw3 PARENT_SCOPE)
    endif()
endfunction()

# shutter_install_library(<name> <what it links to>...)
# Installs shutter_<name> as Shutter::<name>, if it lies below engine/ or modules/, and notes which
# packages it needs. Libraries of this tree that it links to are there before it.
function(shutter_install_library name)
    string(FIND ${CMAKE_CURRENT_SOURCE_DIR} ${SHUTTER_ROOT}/engine/ engine)
    string(FIND ${CMAKE_CURRENT_SOURCE_DIR} ${SHUTTER_ROOT}/modules/ modules)
    if(NOT engine EQUAL 0 AND NOT modules EQUAL 0)
        return()
    endif()
    file(RELATIVE_PATH folder ${SHUTTER_ROOT} ${CMAKE_CURRENT_SOURCE_DIR})
    if(SHUTTER_EMBEDDING_ONLY AND (NOT folder IN_LIST SHUTTER_EMBEDDING_FOLDERS OR name MATCHES plugin))
        return()
    endif()
    set(packages "")
    foreach(link IN LISTS ARGN)
        if(link MATCHES "^shutter_(.+)$")
            get_property(below GLOBAL PROPERTY SHUTTER_PACKAGES_${CMAKE_MATCH_1})
            list(APPEND packages ${below})
        else()
            _shutter_find_package_name(${link} package)
            list(APPEND packages ${package})
        endif()
    endforeach()
    list(REMOVE_DUPLICATES packages)
    set_property(GLOBAL PROPERTY SHUTTER_PACKAGES_${name} ${packages})
    set_property(GLOBAL APPEND PROPERTY SHUTTER_COMPONENTS ${name})
    set_target_properties(shutter_${name} PROPERTIES EXPORT_NAME ${name})
    install(TARGETS shutter_${name} EXPORT ShutterLibraries
            ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT Development)
endfunction()

# shutter_install_shared(<name> <header>...)
# Installs the shared library shutter_<name> as Shutter::<name>, with its headers, which need no other
# but Vulkan's.
function(shutter_install_shared name)
    set_target_properties(shutter_${name} PROPERTIES EXPORT_NAME ${name})
    target_include_directories(
        shutter_${name} INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    set_property(GLOBAL PROPERTY SHUTTER_PACKAGES_${name} Vulkan)
    set_property(GLOBAL APPEND PROPERTY SHUTTER_COMPONENTS ${name})
    install(TARGETS shutter_${name} EXPORT ShutterLibraries
            LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT Development
            ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT Development # Windows: of imports
            RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT Development) # Windows: the DLL
    install(FILES ${ARGN} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT Development)
endfunction()

# shutter_install_pkg_config(<package> <template in cmake/> <static library without shutter_>...)
# Static libraries are linked by their files: one has the name of the shared library.
function(shutter_install_pkg_config package template)
    set(archives "")
    foreach(name IN LISTS ARGN)
        string(APPEND archives " \${libdir}/libshutter_${name}.a")
    endforeach()
    set(runtime -lstdc++)
    if(CMAKE_CXX_IMPLICIT_LINK_LIBRARIES MATCHES "(^|;)c\\+\\+(;|$)")
        set(runtime -lc++)
    endif()
    foreach(library m ${CMAKE_DL_LIBS})
        string(APPEND runtime " -l${library}")
    endforeach()
    file(RELATIVE_PATH up /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
    configure_file(${SHUTTER_ROOT}/cmake/${template} ${CMAKE_BINARY_DIR}/package/${package}.pc @ONLY)
    install(FILES ${CMAKE_BINARY_DIR}/package/${package}.pc
            DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT Development)
endfunction()

# Once all libraries are declared.
function(shutter_install_package)
    # Headers for post effects and programs on the engine. Other engines get the two public ones of
    # the motion blur; the headers behind these are private.
    if(NOT SHUTTER_EMBEDDING_ONLY)
        foreach(folder engine modules)
            install(DIRECTORY ${SHUTTER_ROOT}/${folder} DESTINATION ${SHUTTER_INSTALL_HEADERS}
                    COMPONENT Development FILES_MATCHING PATTERN "*.h"
                    PATTERN embedding EXCLUDE PATTERN c_interface/structures.h EXCLUDE)
        endforeach()
        install(DIRECTORY ${SHUTTER_ROOT}/shaders DESTINATION ${SHUTTER_INSTALL_HEADERS}
                COMPONENT Development FILES_MATCHING PATTERN "*.h" PATTERN "*.glsl")
    endif()
    install(EXPORT ShutterLibraries NAMESPACE Shutter:: DESTINATION ${SHUTTER_INSTALL_PACKAGE}
            COMPONENT Development)

    get_property(SHUTTER_COMPONENTS GLOBAL PROPERTY SHUTTER_COMPONENTS)
    foreach(component IN LISTS SHUTTER_COMPONENTS)
        get_property(packages GLOBAL PROPERTY SHUTTER_PACKAGES_${component})
        string(APPEND SHUTTER_PACKAGES "set(_shutter_packages_${component} ${packages})\n")
    endforeach()
    set(folder ${CMAKE_BINARY_DIR}/package)
    configure_package_config_file(
        ${SHUTTER_ROOT}/cmake/ShutterConfig.cmake.in ${folder}/ShutterConfig.cmake
        INSTALL_DESTINATION ${SHUTTER_INSTALL_PACKAGE} PATH_VARS SHUTTER_INSTALL_HEADERS)
    # Before 1.0 a minor version may change the interface.
    write_basic_package_version_file(${folder}/ShutterConfigVersion.cmake
                                     COMPATIBILITY SameMinorVersion)
    install(FILES ${folder}/ShutterConfig.cmake ${folder}/ShutterConfigVersion.cmake
                  ${SHUTTER_ROOT}/cmake/ShutterTools.cmake ${SHUTTER_ROOT}/cmake/EmbedBytes.cmake
                  ${SHUTTER_ROOT}/cmake/EmbedWords.cmake
            DESTINATION ${SHUTTER_INSTALL_PACKAGE} COMPONENT Development)

    if(TARGET shutter)
        install(TARGETS shutter RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT Runtime)
        install(PROGRAMS ${CMAKE_BINARY_DIR}/shutter_film DESTINATION ${CMAKE_INSTALL_BINDIR}
                COMPONENT Runtime)
    endif()
    if(TARGET shutter_bench)
        # Where it was built.
        install(TARGETS shutter_bench RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT Runtime
                OPTIONAL)
    endif()
    foreach(component Development Runtime)
        install(FILES ${SHUTTER_ROOT}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR}
                COMPONENT ${component})
    endforeach()
endfunction()
