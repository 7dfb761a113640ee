#include <snug/bounds/bound_table.h>

#include <gtest/gtest.h>
#include <oracle/loop_twin.h>
#include <snug/bounds/bounds_cache.h>
#include <testing/kinds.h>
#include <testing/twins.h>

#include <algorithm>
#include <cmath>

namespace snug::bound_table_test {
namespace {

using testing::inside;

// The kind's neighbourhood for the twin: points are (s, t) of the layout and one basis function. As a mesh it
// has a rim, but the patch of face 0 does not see it.
oracle::TwinMesh twin_of(const KindKey& key, const std::vector<LayoutPoint>& layout, std::size_t function) {
  const Topology around = neighbourhood(key).topology;
  oracle::TwinMesh twin;
  twin.boundary = testing::boundary_of(key);
  for (std::size_t i = 0; i < layout.size(); ++i)
    twin.points.push_back({layout[i][0], layout[i][1], i == function ? 1.0 : 0.0});
  for (std::size_t f = 0; f < around.face_count(); ++f) {
    const auto face = around.face(FaceId(f));
    twin.triangles.push_back({face[0].value(), face[1].value(), face[2].value()});
  }
  return twin;
}

std::vector<oracle::LimitSample> samples_of(const oracle::TwinMesh& twin, int depth) {
  std::vector<oracle::LimitSample> samples;
  for (std::uint32_t corner = 0; corner < 3; ++corner) {
    const auto near = oracle::sample_near_corner(twin, 0, corner, depth);
    samples.insert(samples.end(), near.begin(), near.end());
  }
  for (const double u : {0.0, 0.125, 0.25, 0.375, 0.5, 0.625}) {
    for (const double v : {0.0, 0.25, 0.375}) {
      const auto near = oracle::sample_near_point(twin, 0, u, v, 4);
      samples.insert(samples.end(), near.begin(), near.end());
    }
  }
  return samples;
}

// The guarantees of the header, tested in extended precision against the twin.
TEST(bound_table, holds_the_domain_and_every_basis_function) {
  KindCache library;
  for (const KindKey& key : testing::assorted_kinds()) {
    const Kind& kind = library.find(key);
    const BoundingRows rows = make_bounding_rows(kind);
    const BoundTable table = make_bound_table(kind, rows);
    ASSERT_EQ(table.control_count(), kind.control_count());
    ASSERT_EQ(table.lower.size() + 3, kind.control_count());
    const auto& t = table.triangle;
    ASSERT_EQ(t[0][1], t[1][1]);
    ASSERT_EQ(t[0][0], t[2][0]);
    const long double width = static_cast<long double>(t[1][0]) - t[0][0];
    const long double height = static_cast<long double>(t[2][1]) - t[0][1];
    const std::size_t stride = 1 + kind.control_count() / 16;
    for (std::size_t i = 3; i < kind.control_count(); i += stride) {
      for (const oracle::LimitSample& s : samples_of(twin_of(key, table.layout, i), 20)) {
        const long double one = (s.position[0] - static_cast<long double>(t[0][0])) / width;
        const long double two = (s.position[1] - static_cast<long double>(t[0][1])) / height;
        EXPECT_GE(one, 0);
        EXPECT_GE(two, 0);
        EXPECT_LE(one + two, 1);
        const auto plane = [&](const BoundTable::CornerValues& w) {
          return w[0] + one * (static_cast<long double>(w[1]) - w[0]) +
                 two * (static_cast<long double>(w[2]) - w[0]);
        };
        const long double slack = 40 * s.error;  // of the sample, times the planes' slopes
        EXPECT_LE(plane(table.lower[i - 3]), s.position[2] + slack) << i;
        EXPECT_GE(plane(table.upper[i - 3]), s.position[2] - slack) << i;
      }
    }
    if (HasFailure()) FAIL() << kind.control_count() << " control points";
  }
}

// No plane can be lower at the centroid than the function's own upper hull there.
TEST(bound_table, has_planes_that_touch) {
  KindCache library;
  for (const KindKey& key : testing::assorted_kinds()) {
    const Kind& kind = library.find(key);
    const BoundingRows rows = make_bounding_rows(kind);
    const BoundTable table = make_bound_table(kind, rows);
    const auto& t = table.triangle;
    for (std::size_t i = 3; i < kind.control_count(); ++i) {
      for (const auto* planes : {&table.lower, &table.upper}) {
        const auto& w = (*planes)[i - 3];
        int touching = 0;
        for (std::size_t r = 0; r < rows.count(); ++r) {
          double x = 0, y = 0;
          for (std::size_t c = 0; c < rows.control_count(); ++c) {
            x += rows.weight(r, c) * table.layout[c][0];
            y += rows.weight(r, c) * table.layout[c][1];
          }
          const double at = w[0] + (x - t[0][0]) / (t[1][0] - t[0][0]) * (w[1] - w[0]) +
                            (y - t[0][1]) / (t[2][1] - t[0][1]) * (w[2] - w[0]);
          touching += std::fabs(at - rows.weight(r, i)) < 1e-9;
        }
        // A lower plane that met the upper one at a corner of the triangle was put lower there.
        bool crossed = false;
        for (std::size_t k = 0; k < 3; ++k) {
          EXPECT_LE(table.lower[i - 3][k], table.upper[i - 3][k]);
          crossed = crossed || table.lower[i - 3][k] == table.upper[i - 3][k];
        }
        if (planes == &table.upper || !crossed) {
          EXPECT_GE(touching, 3) << i;
        }
      }
    }
  }
}

TEST(ngon_layout, touches_the_far_edge_and_keeps_to_its_triangle) {
  KindCache library;
  for (std::size_t n = 3; n <= 50; n = n < 12 ? n + 1 : n + 19) {
    KindKey key{Scheme::loop, {inside(6), inside(6), inside(n)}};
    std::size_t centre = 2;
    if (n < 6) {
      key.corners = {inside(n), inside(6), inside(6)};
      centre = 0;
    }
    const Kind& kind = library.find(key);
    const BoundTable table = make_bound_table(kind, make_bounding_rows(kind));
    const auto from_centre = [&](double s, double t) {  // how far across, 1 on the far edge
      return 1 - (centre == 0 ? 1 - s - t : t);
    };
    double farthest = 0, least = 1;
    for (const oracle::LimitSample& s : samples_of(twin_of(key, table.layout, 3), 20)) {
      farthest = std::max(farthest, from_centre(s.position[0], s.position[1]));
      least = std::min({least, s.position[0], s.position[1], 1 - s.position[0] - s.position[1]});
    }
    EXPECT_NEAR(farthest, 1, 1e-14) << n;
    EXPECT_GE(least, -1e-14) << n;
    // The table's triangle is hardly wider: the net of the tip sticks out by 1 % of the width, and nothing
    // beyond the far edge.
    const auto& t = table.triangle;
    EXPECT_LT(from_centre(t[(centre + 1) % 3][0], t[(centre + 1) % 3][1]), 1.03) << n;
    EXPECT_GT(t[0][0], -0.015) << n;
    EXPECT_GT(t[0][1], -0.015) << n;
  }
  EXPECT_EQ(outer_spoke(6), 2);
}

TEST(layout, of_regular_kinds_is_the_regular_lattice) {
  KindCache library;
  const Kind& kind = library.find({Scheme::loop, {inside(6), inside(6), inside(6)}});
  for (const LayoutPoint& p : make_layout(kind)) {
    EXPECT_EQ(p[0], std::round(p[0]));
    EXPECT_EQ(p[1], std::round(p[1]));
  }
}

// Of Catmull-Clark with a corner or boundary too; dual schemes have corners between control points.
TEST(fair_layout, of_regular_kinds_is_the_regular_lattice) {
  KindCache library;
  const CornerFan in = inside(4), lone{0, 0, false, true}, before{1, 0, false}, after{0, 1, false};
  for (const std::array<CornerFan, 4>& fans :
       {std::array{in, in, in, in}, std::array{after, before, in, in}, std::array{in, in, after, before},
        std::array{lone, before, in, after}, std::array{in, after, lone, before}}) {
    const auto layout = make_layout(library.find({Scheme::catmark, fans}));
    EXPECT_EQ(layout[0], (LayoutPoint{0, 0}));
    EXPECT_EQ(layout[1], (LayoutPoint{1, 0}));
    EXPECT_EQ(layout[2], (LayoutPoint{0, 1}));
    EXPECT_EQ(layout[3], (LayoutPoint{-1, 1}));
    for (const LayoutPoint& p : layout) {
      EXPECT_EQ(p[0], std::round(p[0]));
      EXPECT_EQ(p[1], std::round(p[1]));
    }
  }
  for (const Scheme scheme : {Scheme::doo_sabin, Scheme::midedge}) {
    const auto layout = make_layout(library.find({scheme, {in, in, in, in}}));
    ASSERT_EQ(layout.size(), 9u);
    EXPECT_EQ(layout[0], (LayoutPoint{0, 0.5}));  // the middle of the edge 02
    for (const LayoutPoint& p : layout) {
      EXPECT_EQ(2 * p[0], std::round(2 * p[0]));
      EXPECT_EQ(2 * p[1], std::round(2 * p[1]));
    }
  }
}

TEST(fair_layout, has_its_limit_corners_at_the_corners_and_stays_near) {
  KindCache library;
  for (const Scheme scheme : {Scheme::catmark, Scheme::doo_sabin, Scheme::midedge}) {
    for (const std::size_t n : {3u, 5u, 7u, 12u, 40u}) {
      for (const std::size_t m : {3u, 4u, 9u}) {
        const Kind& kind = library.find({scheme, {inside(n), inside(m), inside(4), inside(5)}});
        const auto layout = make_layout(kind);
        for (const LayoutPoint& p : layout)
          EXPECT_LT(std::fabs(p[0]) + std::fabs(p[1]), 30) << name_of(scheme) << n << m;
        for (std::size_t k = 0; k < 3; ++k) {
          const auto row = kind.corner_limits().row(k);
          LayoutPoint limit{0, 0};
          for (std::size_t i = 0; i < row.sources.size(); ++i) {
            limit[0] += row.weights[i] * layout[row.sources[i]][0];
            limit[1] += row.weights[i] * layout[row.sources[i]][1];
          }
          EXPECT_NEAR(limit[0], k == 1, 1e-12);
          EXPECT_NEAR(limit[1], k == 2, 1e-12);
        }
      }
    }
  }
}

TEST(layout, of_other_kinds_has_its_limit_corners_at_the_corners) {
  KindCache library;
  for (const KindKey& key : testing::assorted_kinds()) {
    const bool one = std::all_of(key.corners.begin(), key.corners.end(), [](auto& f) { return f.closed; }) &&
                     std::count_if(key.corners.begin(), key.corners.end(),
                                   [](auto& f) { return !rules_of(Scheme::loop).regular(f); }) <= 1;
    if (one) continue;
    const Kind& kind = library.find(key);
    const auto layout = make_layout(kind);
    for (std::size_t k = 0; k < 3; ++k) {
      if (key.corners[k].faces() == 1) continue;  // its ring is the other corners: nothing to move
      const auto row = kind.corner_limits().row(k);
      LayoutPoint limit{0, 0};
      for (std::size_t i = 0; i < row.sources.size(); ++i) {
        limit[0] += row.weights[i] * layout[row.sources[i]][0];
        limit[1] += row.weights[i] * layout[row.sources[i]][1];
      }
      EXPECT_NEAR(limit[0], k == 1, 1e-12);
      EXPECT_NEAR(limit[1], k == 2, 1e-12);
    }
  }
}

}  // namespace
}  // namespace snug::bound_table_test
