class Snug < Formula
  desc "Proved answers about the limit surfaces of subdivision meshes"
  url ENV.fetch("SNUG_SOURCE")
  version "0.1.0"
  license "Apache-2.0"

  depends_on "cmake" => :build
  depends_on "nlohmann-json" => :build
  depends_on "fmt"
  depends_on "highway"
  depends_on "libpng"
  depends_on "meshoptimizer"

  def install
    system "cmake", "-S", ".", "-B", "build", "-DSNUG_BUILD_RESEARCH=OFF", "-DSNUG_BUILD_CHECK=OFF", "-DSNUG_BUILD_TESTS=OFF", *std_cmake_args
    system "cmake", "--build", "build"
    system "cmake", "--install", "build"
  end

  test do
    (testpath/"cube.obj").write <<~OBJ
      v -1 -1 -1
      v 1 -1 -1
      v -1 1 -1
      v 1 1 1
      f 1 3 2
      f 1 2 4
      f 2 3 4
      f 3 1 4
    OBJ
    assert_match "closed", shell_output("#{bin}/snug info cube.obj")
  end
end
