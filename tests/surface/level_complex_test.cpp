// Names of the corners of pieces: one for each point, on closed surfaces as many as Euler has it.

#include <snug/surface/level_complex.h>

#include <gtest/gtest.h>
#include <oracle/tagged_shapes.h>
#include <snug/surface/evaluate.h>
#include <testing/closed_meshes.h>
#include <testing/tagged.h>

#include <map>
#include <random>
#include <set>

namespace snug::level_complex_test {
namespace {

namespace meshes = oracle::meshes;

std::vector<PieceName> next_level(const std::vector<PieceName>& pieces) {
  std::vector<PieceName> next;
  for (const PieceName& piece : pieces) {
    for (unsigned child = 0; child < 4; ++child) next.push_back(piece.child(child));
  }
  return next;
}

void expect_complex(const LimitSurface& surface, const std::string& name) {
  const LevelComplex complex(surface);
  std::vector<PieceName> pieces = complex.pieces();
  unsigned level = complex.first_level();
  for (int step = 0; step < 3; ++step, ++level, pieces = next_level(pieces)) {
    std::map<LevelVertex, Point3> points;
    std::map<LevelVertex, std::size_t> counts;
    for (const PieceName& piece : pieces) {
      ASSERT_EQ(complex.level_of(piece), level) << name;
      Patch patch = surface.patch(piece.patch);
      const PiecePath& path = piece.path;
      for (unsigned k = 0; k < path.level(); ++k) patch = split(patch, path.digit(k));
      const auto limits = limit_corners(patch);
      const auto vertices = complex.vertices(piece);
      for (std::size_t k = 0; k < 3; ++k) {
        const Point3 p = patch.origin + limits[k];
        const auto [it, added] = points.try_emplace(vertices[k], p);
        EXPECT_LE(length(p - it->second), 1e-12) << name << " level " << level;
        ++counts[vertices[k]];
      }
      if (::testing::Test::HasFailure()) return;
    }
    const auto euler = static_cast<long>(points.size()) - static_cast<long>(pieces.size()) / 2;
    const Topology& topology = surface.topology();
    EXPECT_EQ(euler, static_cast<long>(topology.vertex_count()) - static_cast<long>(topology.edge_count()) +
                         static_cast<long>(topology.face_count()))
        << name << " level " << level;
    for (const auto& [vertex, count] : counts) {
      const LevelStar star = complex.star(vertex, level);
      EXPECT_TRUE(star.fan && star.closed) << name << " level " << level;
      EXPECT_EQ(star.sectors.size(), count) << name << " level " << level;
    }
  }
}

TEST(level_complex, of_closed_surfaces_counts_as_euler_does) {
  std::mt19937_64 random(1);
  for (const auto& closed :
       {testing::prism(3), testing::prism(5), testing::antiprism(5), testing::bipyramid(7),
        testing::torus(4, 5), testing::truncated(testing::tetrahedron())}) {
    oracle::TaggedMesh mesh;
    for (std::uint32_t v = 0; v < closed.vertices; ++v) {
      const auto x = [&] { return static_cast<double>(random() % 1000) * 1e-3; };
      mesh.points.push_back({x(), x(), x()});
    }
    mesh.polygons = closed.faces;
    const bool triangles = std::all_of(closed.faces.begin(), closed.faces.end(),
                                       [](const auto& face) { return face.size() == 3; });
    for (const Scheme scheme : {Scheme::loop, Scheme::catmark, Scheme::doo_sabin, Scheme::midedge}) {
      if (scheme == Scheme::loop && !triangles) continue;
      expect_complex(LimitSurface(testing::control_mesh(mesh), {scheme}, std::make_shared<BoundsCache>()),
                     closed.name + " " + name_of(scheme));
      if (HasFailure()) return;
    }
  }
}

TEST(level_complex, a_vertex_of_two_fans_has_no_star) {
  const LimitSurface surface(testing::control_mesh(meshes::two_cubes_at_a_vertex()), {Scheme::catmark},
                             std::make_shared<BoundsCache>());
  const LevelComplex complex(surface);
  std::set<LevelVertex> vertices;
  for (const PieceName& piece : complex.pieces()) {
    for (const LevelVertex& v : complex.vertices(piece)) vertices.insert(v);
  }
  std::size_t fans = 0;
  for (const LevelVertex& v : vertices) fans += complex.star(v, complex.first_level()).fan ? 1 : 0;
  EXPECT_EQ(fans + 1, vertices.size());
}

}  // namespace
}  // namespace snug::level_complex_test
