// Refined meshes and limit positions against OpenSubdiv's uniform refinement and Limit, face by face and
// corner by corner.

#include <gtest/gtest.h>
#include <oracle/obj_reader.h>
#include <peers/opensubdiv_comparison.h>
#include <snug/evaluate.h>
#include <testing/tagged.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace snug::subdivide_opensubdiv_test {
namespace {

using oracle::OpenSubdivMesh;

// Largest differences, relative to the largest coordinate.
struct Differences {
  double refined = 0, limit = 0;                // where OpenSubdiv's mask is the limit
  double dart = 0, valence_two = 0, alive = 0;  // where it is not
  bool same_faces = true;
};

double largest_coordinate(const oracle::TaggedMesh& mesh) {
  double largest = 0;
  for (const oracle::Point& p : mesh.points) {
    for (const double x : p) largest = std::max(largest, std::fabs(x));
  }
  return largest;
}

double distance(const Point3& a, const oracle::Point& b) {
  return std::max({std::fabs(a.x - b[0]), std::fabs(a.y - b[1]), std::fabs(a.z - b[2])});
}

Differences compare(const oracle::TaggedMesh& mesh, const oracle::Rules& rules, unsigned level,
                    bool bilinear = false) {
  Differences result;
  const OpenSubdivMesh theirs =
      oracle::refine_with_opensubdiv(mesh, rules, static_cast<int>(level), bilinear);
  if (!theirs.accepted) {
    result.same_faces = false;
    return result;
  }
  const ControlMesh control = testing::control_mesh(mesh, rules);
  const SchemeOptions made = testing::options_of(rules);
  const SurfaceOptions options{.scheme = bilinear ? Scheme::bilinear : made.scheme,
                               .boundary = made.boundary};
  const ControlMesh refined = subdivided(control, level, false, options);
  const ControlMesh limit = subdivided(control, level, true, options);
  const double size = largest_coordinate(mesh);
  result.same_faces = refined.face_count() == theirs.faces.size();
  std::size_t kept = 0;  // faces of `limit`: holes are left out
  for (std::size_t f = 0; f < theirs.faces.size() && result.same_faces; ++f) {
    const auto mine = refined.face(FaceId(f));
    result.same_faces = mine.size() == theirs.faces[f].size();
    for (std::size_t k = 0; k < mine.size() && result.same_faces; ++k) {
      const double d = distance(refined.points[mine[k].index()], theirs.faces[f][k].refined) / size;
      result.refined = std::max(result.refined, d);
    }
    if (theirs.holes[f]) continue;
    result.same_faces = result.same_faces && kept < limit.face_count();
    if (!result.same_faces) break;
    const auto face = limit.face(FaceId(kept++));
    for (std::size_t k = 0; k < face.size(); ++k) {
      const auto& corner = theirs.faces[f][k];
      const double d = distance(limit.points[face[k].index()], corner.limit) / size;
      double& worst = corner.sort == OpenSubdivMesh::Limit::dart          ? result.dart
                      : corner.sort == OpenSubdivMesh::Limit::valence_two ? result.valence_two
                      : corner.sort == OpenSubdivMesh::Limit::alive       ? result.alive
                                                                          : result.limit;
      worst = std::max(worst, d);
    }
  }
  result.same_faces = result.same_faces && kept == limit.face_count();
  return result;
}

// The largest finite sharpness, rounded up; at least 1 and as fine as `most` faces allow.
unsigned level_for(const oracle::TaggedMesh& mesh, std::size_t most) {
  double sharpest = 1;
  for (const auto& c : mesh.creases) {
    if (c.sharpness < infinite_sharpness) sharpest = std::max(sharpest, c.sharpness);
  }
  for (const auto& c : mesh.corners) {
    if (c.sharpness < infinite_sharpness) sharpest = std::max(sharpest, c.sharpness);
  }
  auto level = static_cast<unsigned>(std::ceil(sharpest));
  std::size_t faces = 0;
  for (const auto& polygon : mesh.polygons) faces += polygon.size();
  while (level > 1 && (faces << (2 * (level - 1))) > most) --level;
  return level;
}

// Do doubles and floats hold the same sharpnesses?
bool sharpness_fits_float(const oracle::TaggedMesh& mesh) {
  const auto fits = [](const auto& c) {
    return static_cast<double>(static_cast<float>(c.sharpness)) == c.sharpness;
  };
  return std::all_of(mesh.creases.begin(), mesh.creases.end(), fits) &&
         std::all_of(mesh.corners.begin(), mesh.corners.end(), fits);
}

constexpr oracle::Boundary all_boundaries[] = {oracle::Boundary::edge_and_corner, oracle::Boundary::edge_only,
                                               oracle::Boundary::none};

TEST(subdivide, agrees_with_opensubdiv_s_bilinear_scheme) {
  for (const auto& [name, shape] : testing::plain_shapes()) {
    for (const oracle::Boundary boundary : {oracle::Boundary::edge_and_corner, oracle::Boundary::edge_only}) {
      oracle::TaggedMesh mesh = shape;
      const auto& first = mesh.polygons[0];
      mesh.creases = {{first[0], first[1], 2.5}, {first[1], first[2], 10}};  // of no effect
      oracle::Rules rules;
      rules.boundary = boundary;
      const Differences found = compare(mesh, rules, 2, true);
      EXPECT_TRUE(found.same_faces) << name;
      EXPECT_LE(std::max({found.refined, found.limit, found.dart, found.valence_two, found.alive}), 1e-12)
          << name;
    }
  }
}

TEST(subdivide, agrees_with_opensubdiv_on_tagged_shapes) {
  for (const oracle::PrimalScheme scheme :
       {oracle::PrimalScheme::catmull_clark, oracle::PrimalScheme::loop}) {
    for (const testing::TaggedCase& c : testing::tagged_cases(scheme, 31)) {
      const Differences d = compare(c.mesh, c.rules, level_for(c.mesh, 20'000));
      const bool exact = sharpness_fits_float(c.mesh) && !c.rules.chaikin;
      EXPECT_TRUE(d.same_faces) << c.name << ", " << testing::text_of(c.rules);
      if (c.rules.chaikin)
        continue;  // an edge of sharpness 1 and more that ends at one side only is another thing there
      EXPECT_LE(d.refined, exact ? 1e-12 : 1e-6) << c.name << ", " << testing::text_of(c.rules);
      EXPECT_LE(d.limit, exact ? 1e-12 : 1e-6) << c.name << ", " << testing::text_of(c.rules);
    }
  }
}

TEST(subdivide, agrees_with_opensubdiv_on_faces_that_name_vertices_twice) {
  std::mt19937_64 random(32);
  for (const oracle::PrimalScheme scheme :
       {oracle::PrimalScheme::catmull_clark, oracle::PrimalScheme::loop}) {
    oracle::TaggedMesh mesh = oracle::meshes::shaken(oracle::meshes::vertices_twice(), 0.3, random);
    if (scheme == oracle::PrimalScheme::loop) mesh = oracle::meshes::triangulated(mesh);
    for (const oracle::Boundary boundary : all_boundaries) {
      oracle::Rules rules;
      rules.scheme = scheme;
      rules.boundary = boundary;
      for (const unsigned level : {1u, 2u, 3u}) {
        const Differences d = compare(mesh, rules, level);
        EXPECT_TRUE(d.same_faces) << testing::text_of(rules);
        EXPECT_LE(d.refined, 1e-12) << testing::text_of(rules);
        EXPECT_LE(d.limit, 1e-12) << testing::text_of(rules);
      }
    }
  }
}

/// OpenSubdiv's own regression shapes, where the environment says they are: SNUG_EXTRA_MODELS/osd.
TEST(subdivide, agrees_with_opensubdiv_on_its_regression_shapes) {
  const char* folder = std::getenv("SNUG_EXTRA_MODELS");
  if (folder == nullptr) GTEST_SKIP() << "SNUG_EXTRA_MODELS is not set";
  const std::filesystem::path shapes = std::filesystem::path(folder) / "osd";
  if (!std::filesystem::is_directory(shapes)) GTEST_SKIP() << shapes << " is not there";
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(shapes)) {
    if (entry.path().extension() == ".obj") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  ASSERT_FALSE(paths.empty());
  std::printf(
      "%-28s %-10s %5s %9s %9s | where OpenSubdiv's mask is not the limit: dart, two faces, still sharp\n",
      "shape", "boundary", "level", "refined", "limit");
  for (const auto& path : paths) {
    const oracle::TaggedFile file = oracle::read_tagged_obj(path);
    const std::string name = path.stem().string();
    for (const oracle::Boundary boundary : all_boundaries) {
      oracle::Rules rules;
      rules.boundary = boundary;
      rules.chaikin = file.chaikin;
      rules.smooth_triangles = file.smooth_triangles;
      if (name.starts_with("loop")) rules.scheme = oracle::PrimalScheme::loop;
      const unsigned level =
          level_for(file.mesh, 4'000) + 1;  // one more: tags of the last one are kept right
      const char* const names[] = {"corner", "edge", "none"};
      try {
        const Differences d = compare(file.mesh, rules, level);
        std::printf("%-28s %-10s %5u %9.1e %9.1e | %.1e %.1e %.1e%s\n", name.c_str(),
                    names[static_cast<int>(boundary)], level, d.refined, d.limit, d.dart, d.valence_two,
                    d.alive, d.same_faces ? "" : "  OTHER FACES");
        const double tolerance = rules.chaikin || !sharpness_fits_float(file.mesh) ? 1e-6 : 1e-12;
        EXPECT_TRUE(d.same_faces) << name;
        EXPECT_LE(d.refined, tolerance) << name;
        EXPECT_LE(d.limit, tolerance) << name;
      } catch (const std::exception& refusal) {
        std::printf("%-28s %-10s refused: %s\n", name.c_str(), names[static_cast<int>(boundary)],
                    refusal.what());
        // Two edges between the same vertices after one step: Loop's valence 2.
        EXPECT_NE(std::string(refusal.what()).find("has the same vertices as face"), std::string::npos)
            << name;
      }
    }
  }
}

}  // namespace
}  // namespace snug::subdivide_opensubdiv_test
