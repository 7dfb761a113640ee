// Triangle meshes as they are, against FCL on the same triangles.

#include <gtest/gtest.h>
#include <peer_fcl.h>
#include <snug/mesh.h>
#include <snug/query/pair_queries.h>
#include <testing/placements.h>

#include <iostream>

#include <testing/places.h>
#include "testing/verdict_only.h"

namespace snug::plain_meshes_fcl_test {
namespace {

struct Body {
  LimitSurface surface;
  SurfaceBvh model;
  PieceCache scratch;
  explicit Body(const ControlMesh& mesh)
      : surface(mesh, {Scheme::flat}, std::make_shared<BoundsCache>()), model(surface), scratch(model) {}
  [[nodiscard]] PlacedBvh at(const Motion& pose) { return {model, scratch, pose}; }
};

bench::TriangleMesh triangles_of(const ControlMesh& mesh) {
  bench::TriangleMesh result{mesh.points, {}};
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(FaceId(f));
    result.triangles.push_back({face[0].value(), face[1].value(), face[2].value()});
  }
  return result;
}

TEST(flat, has_fcl_s_verdicts_and_distances) {
  const std::string folder = testing::models_dir();
  const ControlMesh meshes[] = {read_mesh(folder + "/star.obj"), read_mesh(folder + "/pawn.obj")};
  Body a(meshes[0]), b(meshes[1]);
  const bench::FclModel theirs[] = {{triangles_of(meshes[0]), bench::FclBoxes::obbrss},
                                    {triangles_of(meshes[1]), bench::FclBoxes::obbrss}};
  const double size = std::max(a.surface.size(), b.surface.size());
  std::mt19937_64 random(5);
  std::size_t meet = 0, apart = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const Motion at_a = testing::random_placement(random, {}),
                 at_b = testing::random_placement(random, testing::random_vector(random, 0.7 * size));
    CollideOptions strict = testing::verdict_only();
    const Verdict verdict = collide(a.at(at_a), b.at(at_b), strict).verdict;
    DistanceOptions precision;
    precision.absolute = 1e-9 * size;
    const Distance found = distance(a.at(at_a), b.at(at_b), precision);
    ASSERT_EQ(found.outcome, Outcome::complete);
    const bool they_meet = bench::fcl_collide(theirs[0], at_a, theirs[1], at_b);
    if (found.distance.upper > 1e-7 * size ||
        found.distance.upper == 0) {  // else FCL's own rounding may decide
      EXPECT_EQ(verdict, they_meet ? Verdict::intersecting : Verdict::separated) << trial;
    }
    if (they_meet) {
      ++meet;
      continue;
    }
    ++apart;
    const double distance = bench::fcl_distance(theirs[0], at_a, theirs[1], at_b);
    EXPECT_NEAR(distance, found.distance.upper, 1e-7 * size) << trial;
  }
  std::cout << "  " << meet << " meet, " << apart << " apart\n";
  EXPECT_GT(meet, 100u);
  EXPECT_GT(apart, 100u);
}

}  // namespace
}  // namespace snug::plain_meshes_fcl_test
