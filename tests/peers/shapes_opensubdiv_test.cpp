#include <gtest/gtest.h>
#include <oracle/obj_reader.h>
#include <peers/opensubdiv_comparison.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace oracle::shapes_opensubdiv_test {
namespace {

/// OpenSubdiv's own regression shapes, where the environment says they are: SNUG_EXTRA_MODELS/osd. A name
/// that begins with "loop" asks for Loop.
TEST(polygon_twin_and_opensubdiv, agree_on_the_regression_shapes) {
  const char* folder = std::getenv("SNUG_EXTRA_MODELS");
  if (folder == nullptr) GTEST_SKIP() << "SNUG_EXTRA_MODELS is not set";
  const std::filesystem::path shapes = std::filesystem::path(folder) / "osd";
  if (!std::filesystem::is_directory(shapes)) GTEST_SKIP() << shapes << " is not there";
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(shapes))
    if (entry.path().extension() == ".obj") paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  ASSERT_FALSE(paths.empty());
  std::printf("%-28s %-10s %5s %9s %9s | where OpenSubdiv's mask is not the limit: %s\n", "shape", "boundary",
              "level", "refined", "limit", "dart, two faces, still sharp");
  for (const auto& path : paths) {
    const TaggedFile file = read_tagged_obj(path);
    for (const Boundary boundary : {Boundary::none, Boundary::edge_only, Boundary::edge_and_corner}) {
      Rules rules;
      rules.boundary = boundary;
      rules.chaikin = file.chaikin;
      rules.smooth_triangles = file.smooth_triangles;
      const std::string name = path.stem().string();
      if (name.starts_with("loop")) rules.scheme = PrimalScheme::loop;
      const int levels = file.mesh.polygons.size() > 150 ? 1 : file.mesh.polygons.size() > 40 ? 2 : 3;
      const Compared c = compare_with_opensubdiv(file.mesh, rules, levels);
      const char* const names[] = {"corner", "edge", "none"};
      std::printf("%-28s %-10s %5d %9.1e %9.1e | %zu: %.1e, %zu: %.1e, %zu: %.1e\n", name.c_str(),
                  names[static_cast<int>(boundary)], levels, c.refined.worst, c.limit.worst, c.dart.count,
                  c.dart.worst, c.valence_two.count, c.valence_two.worst, c.alive.count, c.alive.worst);
      EXPECT_TRUE(c.accepted && c.same_faces) << name;
      // Chaikin's means are rounded to float there.
      const double tolerance = rules.chaikin ? 1e-6 : 1e-12;
      EXPECT_LE(c.refined.worst, tolerance) << name;
      EXPECT_LE(c.limit.worst, tolerance) << name;
    }
  }
}

}  // namespace
}  // namespace oracle::shapes_opensubdiv_test
