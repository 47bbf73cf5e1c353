# libmpm for Homebrew: brew install --HEAD packaging/recipes/homebrew/libmpm.rb
class Libmpm < Formula
  desc "Material Point Method as a C library"
  homepage "https://example.org/libmpm"
  license "MIT"
  head "https://example.org/libmpm.git", branch: "main"

  depends_on "cmake" => :build
  depends_on "pkgconf" => :test

  def install
    system "cmake", "-S", ".", "-B", "build", "-DMPM_INSTALL=ON", *std_cmake_args
    system "cmake", "--build", "build"
    system "cmake", "--install", "build"
    pkgshare.install "bindings/example.c"
  end

  test do
    flags = shell_output("pkgconf --cflags --libs mpm").split
    system ENV.cc, "-std=c11", pkgshare/"example.c", *flags, "-o", "example"
    assert_match "87de2815a6d3f4bc", shell_output("./example")
  end
end
