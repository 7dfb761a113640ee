#include <experiments/volume_tree.h>

#include <experiments/room_tables.h>
#include <experiments/rooms.h>
#include <gtest/gtest.h>
#include <snug/query/pair_queries.h>
#include <testing/patches.h>
#include <testing/placed_points.h>
#include <testing/placements.h>

namespace snug::volume_tree_test {
namespace {

using testing::Extended;

class EachKdop : public ::testing::TestWithParam<Volume> {
 protected:
  [[nodiscard]] std::vector<Extent> around(const std::vector<Point3>& points) const {
    std::vector<Extent> extents;
    for (const Vector3& direction : directions_of(GetParam())) {
      Extent all;
      for (const Point3& p : points) {
        const double height = dot(direction, p - Point3{});
        all.add({height - 1e-15, height + 1e-15});
      }
      extents.push_back(all);
    }
    return extents;
  }
};

TEST_P(EachKdop, gap_never_exceeds_the_distance_of_the_contents) {
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
    const double found = gap(volume, around(cloud_a), around(cloud_b), view);
    if (!(found > 0)) continue;
    ++gaps;
    std::vector<Extended> images_a, images_b;
    for (const Point3& p : cloud_a) images_a.push_back(testing::image(frame_a, p));
    for (const Point3& p : cloud_b) images_b.push_back(testing::image(frame_b, p));
    ASSERT_LE(found * view.frame.to_world, testing::distance_from_above(images_a, images_b, random)) << trial;
  }
  EXPECT_GT(gaps, trials / 4);
}

TEST_P(EachKdop, what_is_not_finite_is_apart_from_nothing) {
  const Volume volume = GetParam();
  const std::vector<Extent> far = around({{9, 9, 9}});
  PlacedFrame here;
  here.rows = {Vector3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const VolumeView view(volume, here, here);
  for (const Extent& bad : {unbounded, Extent{-1, INFINITY}}) {
    const std::vector<Extent> set(far.size(), bad);
    EXPECT_FALSE(gap(volume, set, far, view) > 0) << bad.lower;
    EXPECT_FALSE(gap(volume, far, set, view) > 0) << bad.lower;
  }
}

// The images of a leaf's corners and of balls around them, and not much more.
TEST_P(EachKdop, refitted_around_turned_leaves_holds_them) {
  const LimitSurface surface = testing::surface_of(oracle::meshes::bipyramid(7));
  const PrintedHierarchy hierarchy(surface, {0.05, {}});
  const VolumeTree tree(hierarchy, GetParam());
  const std::span<const Vector3> directions = directions_of(GetParam());
  std::mt19937_64 random(41);
  std::vector<Extent> extents;
  for (int trial = 0; trial < 20; ++trial) {
    const RelativeFrame frame(frame_of(testing::random_placement(random, testing::random_vector(random, 2))),
                              frame_of(testing::random_placement(random, testing::random_vector(random, 2))));
    tree.refit(frame, extents);
    ASSERT_EQ(extents.size(), hierarchy.nodes().size() * directions.size());
    const PlacedFrame turned{frame.rows, 1, frame.translation};
    for (std::size_t n = 0; n < hierarchy.nodes().size(); ++n) {
      const PrintedHierarchy::Node& node = hierarchy.nodes()[n];
      for (std::size_t i = 0; i < directions.size(); ++i) {
        const Vector3 d = directions[i];
        const Extent own = extents[n * directions.size() + i];
        if (node.first_child != 0) {
          for (const std::size_t child : {node.first_child, node.first_child + 1}) {
            EXPECT_LE(own.lower, extents[child * directions.size() + i].lower);
            EXPECT_GE(own.upper, extents[child * directions.size() + i].upper);
          }
          continue;
        }
        const OffsetTriangle& leaf = hierarchy.leaves()[node.leaf];
        long double lower = INFINITY, upper = -INFINITY;
        for (const Point3& corner : leaf.base) {
          const Extended at = testing::image(turned, corner);
          const long double height = d.x * at[0] + d.y * at[1] + d.z * at[2];
          lower = std::min(lower, height);
          upper = std::max(upper, height);
        }
        const long double reach = static_cast<long double>(leaf.radius) * length(d);
        ASSERT_LE(own.lower, lower - reach * (1 - 1e-12L));
        ASSERT_GE(own.upper, upper + reach * (1 - 1e-12L));
        ASSERT_GE(own.lower, lower - reach - 1e-11L);
        ASSERT_LE(own.upper, upper + reach + 1e-11L);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(volume, EachKdop,
                         ::testing::Values(Volume::aabb, Volume::dop14, Volume::dop18, Volume::dop26),
                         [](const auto& volume) { return std::string(name_of(volume.param)); });

// All pairs of leaves, without a tree.
bool separated_without_trees(const PrintedHierarchy& a, const Motion& place_a, const PrintedHierarchy& b,
                             const Motion& place_b) {
  for (const OffsetTriangle& leaf_a : a.leaves()) {
    for (const OffsetTriangle& leaf_b : b.leaves()) {
      if (!leaves_apart(leaf_a, frame_of(place_a), leaf_b, frame_of(place_b))) return false;
    }
  }
  return true;
}

// Placements from far apart to deep inside, many of them within a leaf's radius of first contact.
TEST(volume_tree, says_what_all_pairs_of_leaves_say_and_what_collide_says) {
  constexpr double tolerance = 0.05;
  const LimitSurface a = testing::surface_of(oracle::meshes::icosahedron()),
                     b = testing::surface_of(oracle::meshes::bipyramid(7));
  const PrintedHierarchy hierarchy_a(a, {tolerance, {}}), hierarchy_b(b, {tolerance, {}});
  const SurfaceBvh model_a(a), model_b(b);
  PieceCache workspace_a(model_a), workspace_b(model_b);
  std::mt19937_64 random(31);
  int separated = 0, near = 0;
  constexpr int trials = 120;
  for (int trial = 0; trial < trials; ++trial) {
    const Motion place_a = testing::random_placement(random, {});
    Motion place_b = testing::random_placement(random, testing::random_vector(random, 2));
    const auto collided = [&](const CollideOptions& options) {
      return collide({model_a, workspace_a, place_a}, {model_b, workspace_b, place_b}, options).verdict;
    };
    if (trial % 2 == 0) {  // to where they are about the tolerance apart
      const Vector3 way = testing::random_vector(random, 1);
      double near_end = 0, far_end = 4 / length(way);
      const Motion turn = place_b;
      const auto move = [&](double s) {
        const Vector3 to = s * way;
        place_b = Motion::from_3x4({turn.row(0).x, turn.row(0).y, turn.row(0).z, to.x,  //
                                    turn.row(1).x, turn.row(1).y, turn.row(1).z, to.y,  //
                                    turn.row(2).x, turn.row(2).y, turn.row(2).z, to.z});
      };
      for (int step = 0; step < 12; ++step) {
        const double middle = (near_end + far_end) / 2;
        move(middle);
        (collided({.tolerance = tolerance}) == Verdict::separated ? far_end : near_end) = middle;
      }
      ++near;
    }
    const bool truth = separated_without_trees(hierarchy_a, place_a, hierarchy_b, place_b);
    separated += truth;
    for (const Volume volume : all_volumes) {
      const VolumeTree tree_a(hierarchy_a, volume), tree_b(hierarchy_b, volume);
      for (const Turning turning : {Turning::bounded, Turning::refitted}) {
        EXPECT_EQ(VolumeTree::compare(tree_a, place_a, tree_b, place_b, turning).separated, truth)
            << name_of(volume) << " " << name_of(turning) << " " << trial;
      }
    }
    EXPECT_TRUE(!truth || collided({.tolerance = 1e-7}) == Verdict::separated) << trial;
    const bool far = collided({.tolerance = 1e-7, .margin = 2 * tolerance}) == Verdict::separated;
    EXPECT_TRUE(truth || !far) << trial;
  }
  EXPECT_GT(separated, 20);
  EXPECT_LT(separated, trials - 20);
  EXPECT_EQ(near, trials / 2);
}

TEST(volume_tree, tighter_volumes_need_fewer_tests) {
  const auto unit = [](const oracle::TwinMesh& mesh) {
    return LimitSurface(unit_model(testing::control_mesh(mesh)), testing::rules(mesh),
                        std::make_shared<BoundsCache>());
  };
  const LimitSurface a = unit(oracle::meshes::icosahedron()), b = unit(oracle::meshes::bipyramid(7));
  const std::vector<VolumeRow> rows = measure_volumes(a, b, {2.4, 0.02, 400, 3});
  ASSERT_EQ(rows.size(), 9u);
  EXPECT_EQ(rows.back().volume, Volume::obb);
  for (const VolumeRow& row : rows) {
    EXPECT_EQ(row.verdicts_sum, rows[0].verdicts_sum);
    EXPECT_EQ(row.possible, rows[0].possible);
    EXPECT_GT(row.seconds, 0);
  }
  EXPECT_GT(rows[0].possible, 10u);
  EXPECT_LT(rows[0].possible, 390u);
  for (std::size_t i = 0; i + 1 < rows.size(); i += 2) {
    EXPECT_EQ(rows[i].volume, rows[i + 1].volume);
    EXPECT_EQ(rows[i].bytes, rows[i + 1].bytes);
    EXPECT_GT(rows[i].volume_tests, rows[i + 1].volume_tests) << i;  // bounded; refitted
    EXPECT_GE(rows[i].triangle_tests, rows[i + 1].triangle_tests) << i;
  }
  for (std::size_t i = 2; i + 1 < rows.size(); ++i) {
    EXPECT_LT(rows[i].volume_tests, rows[i % 2].volume_tests) << i;
    EXPECT_GT(rows[i].bytes, rows[0].bytes);
  }
}

}  // namespace
}  // namespace snug::volume_tree_test
