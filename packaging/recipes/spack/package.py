"""snug for Spack: the library and the command."""

import os

from spack.package import *


class Snug(CMakePackage):
    """Proved answers about the limit surfaces of subdivision meshes."""

    url = os.environ.get("SNUG_SOURCE", "file:///snug-0.1.0.tar.gz")
    license("Apache-2.0")
    version("0.1.0")

    depends_on("cxx", type="build")
    depends_on("cmake@3.24:", type="build")
    depends_on("nlohmann-json", type="build")
    depends_on("highway@1:")
    depends_on("zlib-api")
    depends_on("fmt")
    depends_on("libpng")
    depends_on("meshoptimizer")

    def cmake_args(self):
        return ["-DSNUG_BUILD_RESEARCH=OFF", "-DSNUG_BUILD_CHECK=OFF", "-DSNUG_BUILD_TESTS=OFF"]
