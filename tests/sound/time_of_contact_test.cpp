// First times of contact of Loop surfaces along every kind of motion, against distances that the twin finds at many
// times: no two points meet before the time that is told.
//
//   SNUG_MOTIONS=2000 build/release/bin/tests/sound_test --gtest_filter='time_of_contact.*'

#include <snug/time_of_contact.h>

#include <gtest/gtest.h>
#include <oracle/contact_twin.h>
#include <testing/counts.h>
#include <testing/placements.h>
#include <testing/surfaces.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

namespace snug::time_of_contact_test {
namespace {

using testing::random_placement;
using testing::random_vector;

std::size_t trials(std::size_t usual) { return testing::number_of("SNUG_MOTIONS", usual); }

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

struct Part {
  explicit Part(const oracle::TwinMesh& mesh) : surface(testing::public_surface(mesh)), twin(mesh) {}
  Surface surface;
  oracle::ContactSurface twin;
};

// Through the middle, past it, or near it.
Trajectory any_motion(std::mt19937_64& random) {
  const Vector3 side = random_vector(random, 2.5), past = random_vector(random, 1.5);
  const Motion from = random_placement(random, side + past), to = random_placement(random, past - side);
  switch (random() % 4) {
    case 0:
      return Trajectory::screw(from, to);
    case 1:
      return Trajectory::through(std::vector<Motion>{from, random_placement(random, side), to});
    case 2:
      return Trajectory::steady(from, {-2 * side, {0, 0, 1}, 0, {}});
    default:
      return Trajectory::steady(from, {random() % 3 ? -2 * side : Vector3{}, random_vector(random, 1),
                                       12 * unit(random) - 6, Point3{} + random_vector(random, 2)});
  }
}

TEST(time_of_contact, no_points_of_loop_surfaces_meet_before) {
  std::mt19937_64 random(11);
  const std::vector<oracle::TwinMesh> meshes = testing::assorted_meshes(5);
  std::array<int, 4> verdicts{};
  int wide = 0, checked = 0;
  std::vector<int> looks;
  for (std::size_t trial = 0; trial < trials(60); ++trial) {
    Part a(meshes[random() % meshes.size()]), b(meshes[random() % meshes.size()]);
    Trajectory of_b = any_motion(random);
    const Trajectory of_a = of_b.duration() == 1 && random() % 3 == 0
                                ? Trajectory::steady(random_placement(random, {}),
                                                     {random_vector(random, 1), {1, 0, 1}, unit(random), {}})
                                : Trajectory(random_placement(random, random_vector(random, 0.3)));
    const double size = std::max(a.surface.size(), b.surface.size());
    const double tolerance = random() % 4 == 0 ? 1e-6 * size : 1e-3 * size;
    const TimeOfContact found = time_of_contact(a.surface, of_a, b.surface, of_b, {.tolerance = tolerance});
    ++verdicts[static_cast<std::size_t>(found.verdict)];
    wide += found.outcome != Outcome::complete;
    looks.push_back(found.steps);
    const std::string what = "trial " + std::to_string(trial);
    const auto bounds_at = [&](double t) {
      const oracle::ContactGoal goal{{1e-10 * size, 0}, 1e-9 * size, 20'000};
      return oracle::contact_bounds(a.twin, of_a.at(t).numbers(), b.twin, of_b.at(t).numbers(), goal);
    };
    const double end = std::max(of_a.duration(), of_b.duration());
    std::vector<double> times;
    for (int i = 0; i <= 60; ++i) times.push_back(end * i / 60);
    for (int i = 0; i < 12; ++i) times.push_back(found.time.lower * (1 - std::exp2(-2 * i)));
    for (const double t : times) {
      // Surfaces that the twin finds that near have met, but for those that move in the last moment.
      if (bounds_at(t).upper > 1e-9 * size) continue;
      ++checked;
      ASSERT_LE(found.time.lower, t + 1e-6 * end) << what;
      ASSERT_NE(found.verdict, Verdict::separated) << what << " at " << t;
    }
    if (found.verdict == Verdict::within || found.verdict == Verdict::intersecting) {
      // Near each other by the end of the interval, and not proved apart all through it.
      EXPECT_LE(bounds_at(found.time.upper).lower, tolerance) << what;
    }
  }
  std::sort(looks.begin(), looks.end());
  std::cout << "  " << verdicts[0] << " separated, " << verdicts[1] << " within, " << verdicts[2]
            << " intersecting, " << verdicts[3] << " undecided; " << wide
            << " not told to the tolerance; looks " << looks[looks.size() / 2] << " in the median, "
            << looks.back() << " at most; " << checked << " samples in contact\n";
  EXPECT_GT(verdicts[2], static_cast<int>(testing::share(10)));
  EXPECT_GT(checked, static_cast<int>(testing::share(100)));
}

}  // namespace
}  // namespace snug::time_of_contact_test
