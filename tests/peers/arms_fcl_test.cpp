// Random arms along random paths of their joints: what FCL finds at many times, on the same triangles, is never proved away.
// SNUG_ARM_SEGMENTS: how many (default 30).

#include <gtest/gtest.h>
#include <peer_fcl.h>
#include <snug/distance.h>
#include <snug/tessellate.h>
#include <snug/time_of_contact.h>
#include <testing/placements.h>
#include <testing/scheme_surfaces.h>

#include <cstdlib>
#include <iostream>
#include <memory>

namespace snug::arms_fcl_test {
namespace {

using testing::random_placement;
using testing::random_vector;
using testing::unit;

// A rounded link 0.3 long, its limit surface as triangles within 0.1 mm.
ControlMesh link_triangles(std::mt19937_64& random) {
  ControlMesh cage;
  const double length = 0.2 + 0.2 * unit(random), thick = 0.04 + 0.06 * unit(random);
  for (std::size_t v = 0; v < 8; ++v) {
    cage.points.push_back({(v & 1u) != 0 ? length : -0.02,
                           ((v & 2u) != 0 ? thick : -thick) * (0.8 + 0.4 * unit(random)),
                           ((v & 4u) != 0 ? thick : -thick) * (0.8 + 0.4 * unit(random))});
  }
  for (const auto& f :
       {std::array{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}) {
    cage.add_face(std::array{VertexId(f[0]), VertexId(f[1]), VertexId(f[2]), VertexId(f[3])});
  }
  const Surface surface(cage);
  const Tessellation found = tessellate(surface, {.error = 1e-4});
  ControlMesh mesh;
  mesh.points = found.positions;
  for (const auto& t : found.triangles)
    mesh.add_face(std::array{VertexId(t[0]), VertexId(t[1]), VertexId(t[2])});
  mesh.tags.scheme = Scheme::flat;
  return mesh;
}

struct Link {
  ControlMesh mesh;
  Surface surface;
  bench::FclModel theirs;
  explicit Link(ControlMesh own)
      : mesh(std::move(own)), surface(mesh), theirs(triangles_of(mesh), bench::FclBoxes::obbrss) {}
  static bench::TriangleMesh triangles_of(const ControlMesh& mesh) {
    bench::TriangleMesh result{mesh.points, {}};
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
      const auto face = mesh.face(FaceId(f));
      result.triangles.push_back({face[0].value(), face[1].value(), face[2].value()});
    }
    return result;
  }
};

TEST(arms, miss_no_contact_that_fcl_finds) {
  const char* const wanted = std::getenv("SNUG_ARM_SEGMENTS");
  const int segments = wanted ? std::atoi(wanted) : 30;
  std::mt19937_64 random(59);
  std::vector<std::unique_ptr<Link>> links;
  for (int i = 0; i < 6; ++i) links.push_back(std::make_unique<Link>(link_triangles(random)));
  std::size_t contacts = 0, undecided = 0, early = 0;
  for (int trial = 0; trial < segments; ++trial) {
    // Two links in the frame that carries both; one of them may stay.
    std::array<Trajectory, 2> motions{Motion(), Motion()};
    for (std::size_t side = 0; side < 2; ++side) {
      const std::size_t joints = side == 0 ? random() % 3 : 1 + random() % 5;
      std::vector<ChainJoint> chain(joints);
      std::vector<std::vector<double>> path(2);
      for (ChainJoint& joint : chain) {
        joint.frame = random_placement(random, random_vector(random, 0.15));
        joint.axis = random_vector(random, 1);
        joint.slides = random() % 5 == 0;
        const double size = joint.slides ? 0.1 : 1.5;
        for (auto& list : path) list.push_back(size * (2 * unit(random) - 1));
      }
      const Motion tip = random_placement(random, random_vector(random, 0.1));
      motions[side] = joints == 0 ? Trajectory(tip) : Trajectory::joints(chain, tip, path);
    }
    const Link &a = *links[random() % links.size()], &b = *links[random() % links.size()];
    const TimeOfContact found =
        time_of_contact(a.surface, motions[0], b.surface, motions[1], {.tolerance = 1e-5});
    undecided += found.verdict == Verdict::undecided;
    const auto pose = [&](std::size_t side, double time) {
      return motions[side].at(motions[side].duration() > 0 ? time : 0);
    };
    double first = INFINITY;
    constexpr int looks = 1000;
    for (int i = 0; i <= looks && first == INFINITY; ++i) {
      const double time = static_cast<double>(i) / looks;
      if (bench::fcl_collide(a.theirs, pose(0, time), b.theirs, pose(1, time))) first = time;
    }
    contacts += first < INFINITY;
    if (first < INFINITY) {
      // At a time before `lower` there is no contact: FCL's rounding alone could say so, for surfaces that graze.
      const bool grazes =
          found.time.lower > first &&
          distance(a.surface.at(pose(0, first)), b.surface.at(pose(1, first))).distance.upper < 1e-9;
      EXPECT_TRUE(found.time.lower <= first || grazes)
          << trial << ": missed at " << first << ", " << found.time.lower;
      EXPECT_NE(found.verdict, Verdict::separated) << trial;
    }
    early +=
        found.verdict == Verdict::intersecting && found.time.upper + 2.0 / looks < first && first < INFINITY;
  }
  std::cout << "  " << segments << " segments, " << contacts << " contacts, " << undecided << " undecided, "
            << early << " contacts between FCL's times\n";
  EXPECT_GT(contacts, static_cast<std::size_t>(segments) / 10);
  EXPECT_LT(undecided, static_cast<std::size_t>(segments) / 10 + 1);
}

}  // namespace
}  // namespace snug::arms_fcl_test
