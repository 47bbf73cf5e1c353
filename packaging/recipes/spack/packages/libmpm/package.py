"""libmpm for Spack: `spack dev-build --source-path . libmpm@develop` at the top of the sources."""
from spack.package import *


class Libmpm(CMakePackage):
    """The Material Point Method as a C library."""

    homepage = "https://example.org/libmpm"
    git = "https://example.org/libmpm.git"
    license("MIT")

    version("develop", branch="main")

    variant("baseline", default=False, description="Leave the kernels of wider instruction sets out")

    depends_on("c", type="build")
    depends_on("cmake@3.13:", type="build")
    depends_on("pkgconfig", type="test")

    def cmake_args(self):
        return [self.define("MPM_INSTALL", True), self.define_from_variant("MPM_BASELINE_ONLY", "baseline")]

    @run_after("install")
    @on_package_attributes(run_tests=True)
    def check_example(self):
        """Builds and runs the two disks of bindings/example.c."""
        source = join_path(self.stage.source_path, "bindings", "example.c")
        flags = ["-std=c11", "-I" + self.prefix.include, "-L" + self.prefix.lib, "-Wl,-rpath," + self.prefix.lib]
        Executable(self.compiler.cc)(source, *flags, "-lmpm", "-lm", "-o", "example")
        Executable("./example")()
