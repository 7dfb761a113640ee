#include <snug/bounds/bounds_cache.h>

#include <gtest/gtest.h>
#include <oracle/loop_twin.h>
#include <snug/patch/patch.h>
#include <testing/kinds.h>
#include <testing/twins.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace snug::bounding_rows_test {
namespace {

using testing::assorted_kinds;
using testing::inside;

TEST(bounding_rows, sum_to_one_within_their_stated_error) {
  KindCache library;
  for (const KindKey& key : assorted_kinds()) {
    const BoundingRows rows = make_bounding_rows(library.find(key));
    ASSERT_GT(rows.count(), 0u);
    EXPECT_LT(rows.entry_error(), 1e-12);
    for (std::size_t r = 0; r < rows.count(); ++r) {
      long double sum = 0, magnitude = 0;
      for (std::size_t c = 0; c < rows.control_count(); ++c) {
        sum += rows.weight(r, c);
        magnitude += std::fabs(rows.weight(r, c));
      }
      EXPECT_LE(std::fabs(sum - 1), rows.entry_error()) << r;
      EXPECT_LE(magnitude, rows.abs_sum()) << r;
    }
  }
}

TEST(bounding_rows, end_with_the_control_nets_of_the_tips) {
  BoundsCache library;
  std::mt19937_64 random(3);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  std::size_t tips = 0;
  for (const KindKey& key : assorted_kinds()) {
    const Kind& kind = library.kinds().find(key);
    for (const unsigned most : {1u, 24u}) {
      const BoundingRows rows = make_bounding_rows(kind, most);
      std::vector<Point3> points(kind.control_count());
      for (Point3& p : points) p = {unit(), unit(), unit()};
      const Patch patch = testing::patch_of(kind, points);
      std::size_t row = rows.bezier_count(), tip = 0;
      EXPECT_EQ(rows.self_similar(), has_self_similar_tips(kind) && !kind.polynomial());
      for (unsigned corner = 0; corner < 3; ++corner) {
        if (kind.regular_corner(corner)) continue;
        Patch piece = patch;
        ParameterTriangle place = whole_patch;
        for (unsigned level = 0; level < std::min(most, tip_depth(kind.corner(corner), Scheme::loop));
             ++level)
          piece = split(piece, corner), place = child_of(place, corner);
        ASSERT_LT(tip, rows.nets().size());
        ASSERT_EQ(rows.nets()[tip].kind, piece.kind);
        ASSERT_EQ(rows.nets()[tip].begin, row);
        EXPECT_EQ(rows.nets()[tip].place, turned(place, piece.first));
        for (std::size_t i = 0; i < piece.points.size(); ++i, ++row) {
          double x = 0;
          for (std::size_t c = 0; c < points.size(); ++c) x += rows.weight(row, c) * patch.points[c].x;
          EXPECT_NEAR(x, piece.points[i].x, rows.result_error(patch.largest, patch.error) + piece.error);
        }
        ++tip;
        ++tips;
      }
      EXPECT_EQ(row, rows.count());
      EXPECT_EQ(tip, rows.nets().size());
    }
  }
  EXPECT_GT(tips, 20u);
}

TEST(bounding_rows, of_a_regular_patch_are_its_bezier_points_after_one_split) {
  KindCache library;
  const BoundingRows rows =
      make_bounding_rows(library.find({Scheme::loop, {inside(6), inside(6), inside(6)}}));
  EXPECT_EQ(rows.count(), 45u);
  EXPECT_EQ(rows.control_count(), 12u);
}

// The twin evaluates every basis function of a kind: a random functional of the control points is bounded by
// its values on the rows. As a mesh the neighbourhood has a rim, but the patch of face 0 does not see it.
TEST(bounding_rows, bound_random_functionals_of_the_patch) {
  KindCache library;
  std::mt19937_64 random(17);
  std::normal_distribution<double> normal;
  for (const KindKey& key : assorted_kinds()) {
    const Kind& kind = library.find(key);
    const BoundingRows rows = make_bounding_rows(kind);
    const Topology around = neighbourhood(key).topology;
    for (int trial = 0; trial < 12; ++trial) {
      oracle::TwinMesh twin;
      twin.boundary = testing::boundary_of(key);
      for (std::size_t i = 0; i < kind.control_count(); ++i) {
        // Three functionals at once; sometimes a single basis function.
        const bool single = trial < 3;
        const double hit = i == random() % kind.control_count() ? 1 : 0;
        twin.points.push_back(single ? oracle::Point{hit, 0, hit}
                                     : oracle::Point{normal(random), normal(random), normal(random)});
      }
      for (std::size_t f = 0; f < around.face_count(); ++f) {
        const auto face = around.face(FaceId(f));
        twin.triangles.push_back({face[0].value(), face[1].value(), face[2].value()});
      }
      std::array<double, 3> lower{INFINITY, INFINITY, INFINITY}, upper{-INFINITY, -INFINITY, -INFINITY};
      for (std::size_t r = 0; r < rows.count(); ++r) {
        for (std::size_t k = 0; k < 3; ++k) {
          double value = 0;
          for (std::size_t c = 0; c < rows.control_count(); ++c)
            value += rows.weight(r, c) * twin.points[c][k];
          lower[k] = std::min(lower[k], value);
          upper[k] = std::max(upper[k], value);
        }
      }
      std::vector<oracle::LimitSample> samples;
      for (std::uint32_t corner = 0; corner < 3; ++corner) {
        const auto near = oracle::sample_near_corner(twin, 0, corner, 20);
        samples.insert(samples.end(), near.begin(), near.end());
      }
      for (const double u : {0.25, 0.375, 0.5, 0.125}) {
        const auto near = oracle::sample_near_point(twin, 0, u, 0.25, 6);
        samples.insert(samples.end(), near.begin(), near.end());
      }
      double largest = 0;
      for (const oracle::Point& p : twin.points)
        largest = std::max({largest, std::fabs(p[0]), std::fabs(p[1]), std::fabs(p[2])});
      const double slack = rows.result_error(largest, 0);
      EXPECT_LT(slack, 1e-12);
      for (const oracle::LimitSample& s : samples) {
        for (std::size_t k = 0; k < 3; ++k) {
          EXPECT_GE(s.position[k], lower[k] - slack - s.error);
          EXPECT_LE(s.position[k], upper[k] + slack + s.error);
        }
      }
    }
  }
}

TEST(tip_depth, grows_with_the_valence_and_stays_bounded) {
  EXPECT_LE(tip_depth(inside(3), Scheme::loop), tip_depth(inside(8), Scheme::loop));
  EXPECT_LE(tip_depth(inside(8), Scheme::loop), tip_depth(inside(50), Scheme::loop));
  EXPECT_LE(tip_depth(inside(1000), Scheme::loop), 24u);
}

}  // namespace
}  // namespace snug::bounding_rows_test
