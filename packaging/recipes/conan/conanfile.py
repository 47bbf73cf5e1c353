"""libmpm for Conan 2, from the checkout that this file lies in: `conan create packaging/recipes/conan`."""
import os
import re

from conan import ConanFile
from conan.errors import ConanInvalidConfiguration
from conan.tools.cmake import CMake, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load, rm, rmdir

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..")


class LibmpmConan(ConanFile):
    name = "libmpm"
    description = "The Material Point Method as a C library"
    license = "MIT"
    homepage = "https://example.org/libmpm"
    topics = ("mpm", "material point method", "mechanics", "simulation")
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False], "fPIC": [True, False], "baseline_only": [True, False]}
    default_options = {"shared": True, "fPIC": True, "baseline_only": False}
    implements = ["auto_shared_fpic"]
    languages = "C"

    def set_version(self):
        makefile = load(self, os.path.join(ROOT, "Makefile"))
        self.version = re.search(r"^VERSION := (\S+)", makefile, re.M).group(1)

    def export(self):
        copy(self, "Makefile", ROOT, self.export_folder)

    def export_sources(self):
        for pattern in ("CMakeLists.txt", "Makefile", "LICENSE", "src/*", "include/*", "umat/*", "cmake/*", "pkgconfig/*",
                        "bindings/*.json", "bindings/example.c"):
            copy(self, pattern, ROOT, self.export_sources_folder)

    def validate(self):
        if self.settings.compiler == "msvc":
            raise ConanInvalidConfiguration("libmpm is compiled by gcc or clang, for Windows by those of MinGW-w64")

    def layout(self):
        cmake_layout(self)

    def generate(self):
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables["MPM_INSTALL"] = True
        toolchain.cache_variables["MPM_BASELINE_ONLY"] = bool(self.options.baseline_only)
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))
        CMake(self).install()
        # CMake builds both kinds; the package has the one that was asked for, and Conan's own files for CMake.
        lib = os.path.join(self.package_folder, "lib")
        if self.options.shared:
            for name in ("libmpm.a", "libmpm-umat.a"):
                rm(self, name, lib)
        else:
            for pattern in ("*.so*", "*.dylib", "*.dll.a"):
                rm(self, pattern, lib)
            rm(self, "*.dll", os.path.join(self.package_folder, "bin"))
        rmdir(self, os.path.join(lib, "cmake"))
        rmdir(self, os.path.join(lib, "pkgconfig"))

    def package_info(self):
        self.cpp_info.set_property("cmake_file_name", "mpm")
        core = self.cpp_info.components["mpm"]
        core.set_property("cmake_target_name", "mpm::mpm")
        core.set_property("pkg_config_name", "mpm")
        core.libs = ["mpm"]
        if self.settings.os == "Windows":
            return  # where libmpm-umat is not built
        core.system_libs = ["m", "pthread"]
        umat = self.cpp_info.components["umat"]
        umat.set_property("cmake_target_name", "mpm::umat")
        umat.set_property("pkg_config_name", "mpm-umat")
        umat.libs = ["mpm-umat"]
        umat.requires = ["mpm"]
