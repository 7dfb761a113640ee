// First times of contact where control points move: never later than limit points of the twins that meet, of every
// scheme, tag and way to deform; nor than the distances of Loop surfaces that their twin finds at many times.
//
//   SNUG_DEFORMATIONS=2000 build/release/bin/tests/sound_test --gtest_filter='deforming_contact.*'

#include <snug/time_of_contact.h>

#include <gtest/gtest.h>
#include <oracle/contact_twin.h>
#include <testing/deformations.h>
#include <testing/surfaces.h>

#include <iostream>
#include <string>
#include <vector>

namespace snug::deforming_contact_test {
namespace {

using testing::random_placement;
using testing::random_vector;

TEST(deforming_contact, is_not_later_than_points_that_meet_of_every_scheme_and_deformation) {
  testing::Tally tally = testing::points_that_meet(41, testing::trials(90), 400'000);
  tally.print();
  EXPECT_GT(tally.sharp, static_cast<int>(tally.looks.size() / 2));
  EXPECT_LE(tally.median(), 20);
}

TEST(deforming_contact, no_points_of_loop_surfaces_meet_before) {
  std::mt19937_64 random(12);
  std::vector<oracle::TwinMesh> meshes = testing::assorted_meshes(6);
  std::erase_if(meshes, [](const oracle::TwinMesh& mesh) {
    const Surface surface = testing::public_surface(mesh);
    for (std::uint32_t f = 0; f < surface.owner_count(); ++f) {
      if (surface.has({f, 0, 0, 0})) return false;
    }
    return true;
  });
  testing::Tally tally;
  int checked = 0;
  for (std::size_t trial = 0; trial < testing::trials(40); ++trial) {
    std::array<oracle::TwinMesh, 2> twin{meshes[random() % meshes.size()], meshes[random() % meshes.size()]};
    std::array<std::vector<Point3>, 2> begin, end;
    const Vector3 side = random_vector(random, 2.5);
    std::array<Motion, 2> pose{random_placement(random, {}), random_placement(random, side)};
    for (std::size_t k = 0; k < 2; ++k) {
      begin[k] = testing::control_mesh(twin[k]).points;
      end[k] = testing::deformed(begin[k], static_cast<int>(random() % testing::way_count), random);
    }
    const Motion to_b = pose[1].with_offset({}).inverse();
    end[1] = testing::translated(end[1], to_b.rotate(-1.5 * side));
    const auto at = [&](std::size_t k, double s) {
      oracle::TwinMesh mesh = twin[k];
      for (std::size_t v = 0; v < begin[k].size(); ++v) {
        for (std::size_t i = 0; i < 3; ++i) mesh.points[v][i] = (1 - s) * begin[k][v][i] + s * end[k][v][i];
      }
      return oracle::ContactSurface(mesh);
    };
    const Surface a = testing::public_surface(twin[0]), b = testing::public_surface(twin[1]);
    const double size = std::max(a.size(), b.size()),
                 tolerance = random() % 4 == 0 ? 1e-5 * size : 1e-3 * size;
    const TimeOfContact found =
        time_of_contact({a, end[0], pose[0]}, {b, end[1], pose[1]}, {.tolerance = tolerance});
    tally.add(found);
    const std::string what = "trial " + std::to_string(trial);
    const auto bounds_at = [&](double s) {
      oracle::ContactSurface one = at(0, s), other = at(1, s);
      const oracle::ContactGoal goal{{1e-10 * size, 0}, 1e-9 * size, 20'000};
      return oracle::contact_bounds(one, pose[0].numbers(), other, pose[1].numbers(), goal);
    };
    std::vector<double> times;
    for (int i = 0; i <= 40; ++i) times.push_back(i / 40.0);
    for (int i = 0; i < 10; ++i) times.push_back(std::min(1.0, found.time.lower) * (1 - std::exp2(-2 * i)));
    for (const double s : times) {
      // Surfaces that the twin finds that near have met, but for those that move in the last moment.
      if (bounds_at(s).upper > 1e-9 * size) continue;
      ++checked;
      ASSERT_LE(found.time.lower, s + 1e-6) << what;
      ASSERT_NE(found.verdict, Verdict::separated) << what << " at " << s;
    }
    if (found.time.upper <= 1) {
      // Near each other by the end of the interval.
      EXPECT_LE(bounds_at(found.time.upper).lower, tolerance) << what;
    }
  }
  tally.print();
  std::cout << "  " << checked << " samples in contact\n";
  EXPECT_GT(checked, 50);
}

}  // namespace
}  // namespace snug::deforming_contact_test
