# SPDX-License-Identifier: MIT
"""Conan 2 recipe of the embeddable motion blur: `conan create packaging/conan` from a checkout."""

import os

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.env import VirtualBuildEnv
from conan.tools.files import copy

ROOTS = ("CMakeLists.txt", "LICENSE", "cmake", "engine", "modules", "shaders")


class ShutterMotionBlur(ConanFile):
    name = "shutter-motion-blur"
    version = "0.1.0"
    description = "Motion blur for renderers on Vulkan: the embeddable part of Shutter"
    license = "MIT"
    topics = ("vulkan", "graphics", "motion-blur")
    package_type = "library"  # the shared library and the static ones: always both
    settings = "os", "arch", "compiler", "build_type"

    def export_sources(self):
        root = os.path.join(self.recipe_folder, "..", "..")
        for name in ROOTS:
            pattern = name if os.path.isfile(os.path.join(root, name)) else f"{name}/*"
            copy(self, pattern, src=root, dst=self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def requirements(self):
        self.requires("fmt/[>=9 <12]", transitive_headers=True, transitive_libs=True)
        self.requires("glm/[>=0.9.9]", transitive_headers=True)
        self.requires("nlohmann_json/[>=3.11]")
        self.requires("vulkan-headers/[>=1.3.239]", transitive_headers=True)
        self.requires("vulkan-loader/[>=1.3.239]")

    def build_requirements(self):
        self.tool_requires("cmake/[>=3.25]")
        self.tool_requires("glslang/[>=11]")
        self.tool_requires("spirv-tools/[>=1.3.239]")

    def validate(self):
        check_min_cppstd(self, 20)

    def generate(self):
        VirtualBuildEnv(self).generate()  # where the shader compiler is found
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables["SHUTTER_EMBEDDING_ONLY"] = True
        toolchain.generate()
        CMakeDeps(self).generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        copy(self, "LICENSE", src=self.source_folder,
             dst=os.path.join(self.package_folder, "licenses"))
        CMake(self).install()

    def package_info(self):
        # The package's own ShutterConfig.cmake says more than Conan can: its components, and which
        # packages each of them needs.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = [os.path.join("lib", "cmake", "Shutter")]
        self.cpp_info.includedirs = ["include"]
        self.cpp_info.libs = ["shutter_motion_blur"]
        self.cpp_info.defines = ["SHUTTER_BLUR_SHARED"]
        self.cpp_info.set_property("pkg_config_name", "none")
