#include <experiments/kdop_tree.h>

#include <gtest/gtest.h>
#include <snug/query/pairs.h>
#include <testing/patches.h>
#include <testing/placed_points.h>
#include <testing/placements.h>

namespace snug {
namespace {

using testing::Extended;

BoundingVolume around(Volume volume, const std::vector<Point3>& points) {
  return fit(volume, points, [&](const Vector3& direction) {
    Extent all;
    for (const Point3& p : points) {
      const double height = dot(direction, p - Point3{});
      all.add({height - 1e-15, height + 1e-15});
    }
    return all;
  });
}

class EachVolume : public ::testing::TestWithParam<Volume> {};

TEST_P(EachVolume, holds_its_set_and_the_volume_around_volumes_what_they_hold) {
  const Volume volume = GetParam();
  std::mt19937_64 random(25);
  for (int trial = 0; trial < 500; ++trial) {
    std::vector<BoundingVolume> parts;
    std::vector<Point3> points;
    for (int i = 0; i < 5; ++i) {
      const auto cloud = testing::any_points(random, {0.1 * i, 1 - 0.3 * i, 0.5}, 0.2);
      points.insert(points.end(), cloud.begin(), cloud.end());
      parts.push_back(around(volume, cloud));
    }
    const BoundingVolume all = merge(volume, parts);
    const Ball ball = ball_around(volume, all);
    for (const Point3& p : points) {
      EXPECT_LE(distance(p, ball.centre), ball.radius);
      for (std::size_t k = 0; volume == Volume::obb && k < 3; ++k) {
        EXPECT_LE(std::fabs(dot(all.box.axes[k], p - all.box.centre)), all.box.half[k]);
      }
      const auto directions = directions_of(volume);
      for (std::size_t i = 0; i < directions.size(); ++i) {
        const double height = dot(directions[i], p - Point3{});
        EXPECT_LE(all.extents[i].lower, height);
        EXPECT_GE(all.extents[i].upper, height);
      }
    }
  }
}

TEST_P(EachVolume, gap_never_exceeds_the_distance_of_the_contents) {
  const Volume volume = GetParam();
  std::mt19937_64 random(23);
  int gaps = 0;
  constexpr int trials = 4000;
  for (int trial = 0; trial < trials; ++trial) {
    const double size = std::pow(10.0, -static_cast<double>(random() % 7));
    const auto cloud_a = testing::any_points(random, {0.3, -0.7, 1.1}, size),
               cloud_b = testing::any_points(random, {-0.2, 0.4, 0.5}, size);
    const PlacedFrame frame_a = testing::any_frame(random);
    PlacedFrame frame_b = testing::any_frame(random);
    // B next to A, so that gaps are as small as the sets.
    const Extended at_a = testing::image(frame_a, cloud_a[0]), at_b = testing::image(frame_b, cloud_b[0]);
    std::uniform_real_distribution<double> unit(-3 * size, 3 * size);
    for (std::size_t k = 0; k < 3; ++k) {
      frame_b.translation[k] += static_cast<double>(at_a[k] - at_b[k]) + unit(random);
    }
    const VolumeView view(volume, frame_a, frame_b);
    const double found = gap(volume, around(volume, cloud_a), around(volume, cloud_b), view);
    if (!(found > 0)) continue;
    ++gaps;
    std::vector<Extended> images_a, images_b;
    for (const Point3& p : cloud_a) images_a.push_back(testing::image(frame_a, p));
    for (const Point3& p : cloud_b) images_b.push_back(testing::image(frame_b, p));
    ASSERT_LE(found * view.frame.to_world, testing::distance_from_above(images_a, images_b, random)) << trial;
  }
  EXPECT_GT(gaps, trials / 4);
}

TEST_P(EachVolume, what_is_not_finite_is_apart_from_nothing) {
  const Volume volume = GetParam();
  const std::vector<Point3> middle{{0, 0, 0}};
  const BoundingVolume far = around(volume, {{9, 9, 9}});
  PlacedFrame here;
  here.rows = {Vector3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const VolumeView view(volume, here, here);
  for (const double bad : std::array<double, 2>{INFINITY, NAN}) {
    const BoundingVolume set = fit(volume, middle, [&](const Vector3&) { return Extent{-1, bad}; });
    EXPECT_FALSE(gap(volume, set, far, view) > 0) << bad;
    EXPECT_FALSE(gap(volume, far, set, view) > 0) << bad;
    EXPECT_EQ(ball_around(volume, merge(volume, std::array{far, set})).radius, INFINITY);
  }
}

TEST_P(EachVolume, tree_says_of_two_surfaces_what_collide_says) {
  constexpr double tolerance = 1e-3;
  const LimitSurface a = testing::surface_of(oracle::meshes::icosahedron()),
                     b = testing::surface_of(oracle::meshes::bipyramid(7));
  KdopTree tree_a(a, GetParam()), tree_b(b, GetParam());
  const SurfaceBvh model_a(a), model_b(b);
  SurfaceWorkspace workspace_a(model_a), workspace_b(model_b);
  std::mt19937_64 random(31);
  int separated = 0;
  for (int i = 0; i < 60; ++i) {
    const Motion place = testing::random_placement(random, testing::random_vector(random, 2));
    const KdopTree::Answer answer = KdopTree::compare(tree_a, {}, tree_b, place, tolerance);
    const Collision truth =
        collide({model_a, workspace_a, {}}, {model_b, workspace_b, place}, {.tolerance = tolerance});
    EXPECT_EQ(answer.separated, truth.verdict == Verdict::separated) << i;
    EXPECT_EQ(answer.within, !answer.separated) << i;
    separated += answer.separated;
  }
  EXPECT_GT(separated, 5);
  EXPECT_LT(separated, 55);
}

INSTANTIATE_TEST_SUITE_P(kdop, EachVolume, ::testing::ValuesIn(all_volumes),
                         [](const auto& volume) { return std::string(name_of(volume.param)); });

}  // namespace
}  // namespace snug
