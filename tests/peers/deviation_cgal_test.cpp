// Deviations of random closed meshes, taken as they are, against CGAL's bounded_error_Hausdorff_distance.

#include <snug/distance.h>

#include <gtest/gtest.h>
#include <oracle/hausdorff_twin.h>
#include <peer_cgal.h>
#include <support/error.h>
#include <testing/candidates.h>
#include <testing/solids.h>
#include <testing/tagged.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <random>
#include <stdexcept>

namespace snug::deviation_cgal_test {
namespace {

bench::TriangleMesh triangle_mesh(const oracle::TaggedMesh& mesh) {
  bench::TriangleMesh result;
  for (const oracle::Point& p : mesh.points) result.points.push_back({p[0], p[1], p[2]});
  for (const auto& t : mesh.polygons) result.triangles.push_back({t[0], t[1], t[2]});
  return result;
}

TEST(deviation_and_cgal, agree_on_closed_meshes) {
  constexpr double precision = 1e-3;
  std::size_t asked = 0;
  double widest = 0;
  for (std::uint64_t i = 0; i < 150 && !HasFailure(); ++i) {
    std::mt19937_64 random(i + 3);
    std::array<oracle::TaggedMesh, 2> shapes;
    for (oracle::TaggedMesh& shape : shapes)
      shape = oracle::meshes::triangulated(testing::random_solid(random));
    // Sometimes nearly the same, as a tessellation would be.
    if (i % 3 == 0) shapes[1] = oracle::meshes::shaken(shapes[0], 0.05, random);
    try {
      const std::array meshes{triangle_mesh(shapes[0]), triangle_mesh(shapes[1])};
      const bench::CgalMesh one(meshes[0]), other(meshes[1]);
      const Surface surface(testing::control_mesh(shapes[0]), {.scheme = Scheme::flat});
      const Deviation found = deviation(surface, testing::candidate_of(testing::triangles_of(shapes[1])),
                                        {.absolute = precision});
      EXPECT_EQ(found.outcome, Outcome::complete) << i;
      const std::array theirs{cgal_hausdorff(one, other, precision), cgal_hausdorff(other, one, precision)};
      const std::array ours{found.from_surface.distance, found.from_candidate.distance};
      for (std::size_t way = 0; way < 2; ++way) {
        EXPECT_LE(ours[way].lower, theirs[way] + precision) << i;
        EXPECT_GE(ours[way].upper, theirs[way] - precision) << i;
        widest = std::max(widest, std::fabs(theirs[way] - ours[way].upper));
      }
      ++asked;
    } catch (const InputError&) {
      continue;  // the same triangle twice
    } catch (const std::runtime_error&) {
      continue;  // not a manifold
    }
  }
  std::cout << "  " << asked << " pairs of meshes, at most " << widest << " apart where " << precision
            << " was asked for\n";
  EXPECT_GT(asked, 75u);
}

}  // namespace
}  // namespace snug::deviation_cgal_test
