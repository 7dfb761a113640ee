"""snug for Conan 2: the library."""

import os

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, get


class Snug(ConanFile):
    name = "snug"
    version = "0.1.0"
    license = "Apache-2.0"
    description = "Proved answers about the limit surfaces of subdivision meshes"
    settings = "os", "compiler", "build_type", "arch"
    options = {"shared": [True, False]}
    default_options = {"shared": False}
    package_type = "library"
    cmake_options = {"SNUG_BUILD_COMMAND": False, "SNUG_BUILD_TESTS": False}

    def requirements(self):
        self.requires("highway/1.0.7")
        self.requires("nlohmann_json/3.11.3")
        self.requires("zlib/1.3.1")

    def layout(self):
        cmake_layout(self, src_folder="src")

    def source(self):
        get(self, os.environ["SNUG_SOURCE"], strip_root=True)

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        for name, value in self.cmake_options.items():
            toolchain.cache_variables[name] = value
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))
        CMake(self).install()

    def package_info(self):
        self.cpp_info.set_property("cmake_target_name", "snug::snug")
        self.cpp_info.libs = ["snug"]
