// Bounds of how fast bodies move whose control points move, against limit points of the twins.

#include <snug/query/moving_body.h>

#include <gtest/gtest.h>
#include <snug/search/surface_data.h>
#include <testing/cad_parts.h>
#include <testing/deformations.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace snug::moving_body_test {
namespace {

using testing::Body;
using testing::deformed;
using testing::random_placement;
using testing::random_vector;
using testing::Shape;
using testing::shapes;
using testing::translated;
using testing::unit;
using testing::way_count;

TEST(moving_body, knows_the_speed_of_all_that_meets) {
  std::mt19937_64 random(24);
  const std::vector<Shape> all = shapes(33);
  for (std::size_t trial = 0; trial < testing::trials(120); ++trial) {
    const Shape &shape_a = all[random() % all.size()], &shape_b = all[random() % all.size()];
    const Body a(
        shape_a, shape_a.mesh.points,
        deformed(shape_a.mesh.points, trial % 3 == 1 ? 8 : static_cast<int>(trial % way_count), random));
    // Mostly so small that it meets few patches of A.
    std::vector<Point3> begin_b = shape_b.mesh.points;
    for (Point3& p : begin_b) p = Point3{} + (trial % 4 == 0 ? 1.0 : 0.01) * (p - Point3{});
    const Body b(
        shape_b, begin_b,
        translated(deformed(begin_b, trial % 4 == 0 ? static_cast<int>(random() % way_count) : 0, random),
                   random_vector(random, trial % 4 == 0 ? 1 : 0)));
    std::size_t i = random() % a.first.size();
    const std::size_t j = random() % b.first.size();
    for (std::size_t k = 0; k < a.first.size() && trial % 2 == 0; ++k) {
      if (distance(a.first[k], a.last[k]) > distance(a.first[i], a.last[i])) i = k;
    }
    const double s = unit(random), before = s * unit(random), after = s + (1 - s) * unit(random);
    const Trajectory of_a{random_placement(random, random_vector(random, 1))};
    const Motion turn = random_placement(random, {});
    const Trajectory of_b = turn.with_offset(of_a.start().apply(a.at(i, s)) - turn.apply(b.at(j, s)));
    const SurfaceBvh &model_a = a.surface.data()->bvh(), &model_b = b.surface.data()->bvh();
    PieceCache scratch_a(model_a), scratch_b(model_b);
    const MovingBvh moving_a{model_a, scratch_a, of_a, a.end}, moving_b{model_b, scratch_b, of_b, b.end};
    MovingBody body_a(moving_a), body_b(moving_b);
    body_a.enter_piece(0);
    body_b.enter_piece(0);
    const Vector3 against =
        of_b.start().rotate(b.last[j] - b.first[j]) - of_a.start().rotate(a.last[i] - a.first[i]);
    const std::string what = a.name + " and " + b.name;
    EXPECT_GE(body_a.speed() * (1 + 1e-12) + 1e-12, length(a.last[i] - a.first[i])) << what;
    for (const Interval& times : {Interval{before, after}, Interval{s, s}, Interval{0, 1}}) {
      const auto speed = LinearPatches::meeting_speed(*body_a.linear_patches(), *body_b.linear_patches(),
                                                      times.lower, times.upper);
      ASSERT_TRUE(speed) << what;
      EXPECT_GE(*speed * (1 + 1e-12) + 1e-12, length(against)) << what;
      EXPECT_LE(*speed, 1.0001 * (body_a.speed() + body_b.speed()) * std::sqrt(3.0) + 1e-9) << what;
    }
  }
}

TEST(moving_body, knows_the_speed_of_all_points_that_turn_too) {
  std::mt19937_64 random(26);
  const std::vector<Shape> all = shapes(34);
  for (std::size_t trial = 0; trial < testing::trials(80); ++trial) {
    const Shape& shape = all[random() % all.size()];
    const std::vector<Point3>& begin = shape.mesh.points;
    const int way = static_cast<int>(trial % way_count);
    // Large at the beginning or at the end.
    std::vector<Point3> end = deformed(begin, way, random);
    for (Point3& p : end) p = Point3{} + (trial % 3 == 0 ? 5.0 : 1.0) * (p - Point3{});
    const Body body(shape, begin, end);
    const Motion from = random_placement(random, random_vector(random, 1));
    const Trajectory motion =
        trial % 2 ? testing::any_motion(3, random)
                  : Trajectory::screw(from, random_placement(random, random_vector(random, 1)));
    const SurfaceBvh& model = body.surface.data()->bvh();
    PieceCache scratch(model);
    const MovingBvh moving{model, scratch, motion, body.end};
    MovingBody bounded(moving);
    bounded.enter_piece(0);
    const double speed = bounded.speed();
    EXPECT_FALSE(bounded.linear_patches());
    double fastest = 0;
    for (const double s : {0.0, 0.3, 0.7, 1 - 0x1p-20}) {
      const Motion now = motion.at(s), next = motion.at(s + 0x1p-20);
      for (std::size_t i = 0; i < body.first.size(); ++i) {
        const double way_there = distance(now.apply(body.at(i, s)), next.apply(body.at(i, s + 0x1p-20)));
        fastest = std::max(fastest, way_there * 0x1p20);
      }
    }
    EXPECT_LE(fastest, speed * (1 + 1e-6) + 1e-8) << shape.name << " by way " << way;
    EXPECT_LE(speed, 8 * fastest) << shape.name << " by way " << way;
  }
}

TEST(moving_body, looks_at_control_points_within_their_rounding) {
  std::mt19937_64 random(25);
  for (int trial = 0; trial < 300; ++trial) {
    const double scale = std::exp2(static_cast<int>(random() % 40) - 20);
    ControlMesh mesh = testing::box({0, 0, 0}, {1, 1, 1}, true);
    std::vector<Point3> end = mesh.points;
    for (Point3& p : mesh.points) p = Point3{} + scale * random_vector(random, 1);
    for (Point3& p : end)
      p = Point3{} + std::exp2(static_cast<int>(random() % 20) - 10) * scale * random_vector(random, 1);
    const Surface surface(mesh, {.scheme = Scheme::flat});
    const SurfaceBvh& model = surface.data()->bvh();
    PieceCache scratch(model);
    Deformation deformation(model, scratch, end);
    for (const double s : {0.0, 1.0, unit(random), std::nextafter(1.0, 0.0), 0x1p-60}) {
      const Deformation::Shape shape = deformation.at(s);
      for (std::size_t v = 0; v < end.size(); ++v) {
        for (std::size_t k = 0; k < 3; ++k) {
          const long double begin = mesh.points[v][k], way = static_cast<long double>(end[v][k]) - begin;
          const long double off = shape.model.surface().mesh().points[v][k] - (begin + s * way);
          ASSERT_LE(std::fabs(off), shape.error * 0.6L) << s;
        }
      }
    }
  }
}

}  // namespace
}  // namespace snug::moving_body_test
