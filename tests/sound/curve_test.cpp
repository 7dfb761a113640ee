#include <snug/curves.h>
#include <snug/surface/unscale.h>
#include <testing/curves.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <string>

namespace snug::curve_test {
namespace {

using oracle::CurveSample;
using oracle::TwinPolyline;

struct Disguise {
  std::string name;
  std::function<oracle::Point(oracle::Point)> change;
};

std::vector<Disguise> disguises() {
  std::vector<Disguise> list;
  for (const double s : {1.0, 1e-300, 1e-308, 1e-155, 1e-77, 1e77, 1e155, 1e300}) {
    list.push_back({"scaled by " + std::to_string(std::log10(s)), [s](oracle::Point p) {
                      return oracle::Point{s * p[0], s * p[1], s * p[2]};
                    }});
  }
  for (const double d : {1e3, 1e8, 3e14}) {
    list.push_back({"moved by " + std::to_string(d), [d](oracle::Point p) {
                      return oracle::Point{p[0] + d, p[1] - d / 3, p[2] + 0.1 * d};
                    }});
  }
  list.push_back({"tiny and far", [](oracle::Point p) {
                    return oracle::Point{1e-200 * (p[0] + 1e6), 1e-200 * p[1], 1e-200 * (p[2] - 2e6)};
                  }});
  list.push_back({"flat", [](oracle::Point p) { return oracle::Point{p[0], p[1], 0.0}; }});
  list.push_back({"needle", [](oracle::Point p) { return oracle::Point{p[0], 1e-7 * p[1], 1e-9 * p[2]}; }});
  list.push_back({"line", [](oracle::Point p) { return oracle::Point{p[0], 0.3 * p[0], -p[0]}; }});
  list.push_back({"snapped to a coarse grid", [](oracle::Point p) {
                    return oracle::Point{std::round(2 * p[0]), std::round(2 * p[1]), std::round(2 * p[2])};
                  }});
  list.push_back({"a single point", [](oracle::Point) { return oracle::Point{0.1, 0.2, 0.3}; }});
  list.push_back({"spiked", [](oracle::Point p) {
                    return oracle::Point{p[0], p[1], p[0] * p[1] > 0.2 ? 1e6 * p[2] : p[2]};
                  }});
  list.push_back({"grains among boulders", [](oracle::Point p) {
                    const double s = p[0] > 0 ? 1e-160 : 1;
                    return oracle::Point{s * p[0], s * p[1], s * p[2]};
                  }});
  return list;
}

// Both ends, next to them, dyadic and random.
std::vector<double> parameters(std::mt19937_64& random, int count) {
  std::vector<double> list{
      0, 1, 0.5, 0.25, 0.75, 0x1p-60, 1e-300, 1 - 0x1p-53, std::nextafter(0.5, 0), std::nextafter(0.5, 1)};
  for (int i = 0; i < count; ++i) list.push_back(static_cast<double>(random() >> 11) * 0x1p-53);
  return list;
}

TEST(curves, lie_in_their_enclosures_at_a_hundred_thousand_adversarial_points) {
  std::mt19937_64 random(31);
  std::size_t points = 0, checks = 0;
  const std::vector<TwinPolyline> polylines = testing::assorted_polylines(7);
  for (const Disguise& disguise : disguises()) {
    for (const TwinPolyline& plain : polylines) {
      TwinPolyline twin = plain;
      for (oracle::Point& p : twin.points) p = disguise.change(p);
      for (const int degree : {2, 3}) {
        const CurveSet curves = testing::curve_set(twin, degree);
        ASSERT_EQ(curves.edge_count(), twin.edge_count());
        std::vector<std::vector<CurveSample>> samples(twin.edge_count());
        for (std::uint32_t e = 0; e < twin.edge_count(); ++e) {
          for (const double t : parameters(random, 30)) samples[e].push_back(curve_at(twin, degree, e, t));
          points += samples[e].size();
        }
        const auto check = [&](const BoundOptions& how) {
          const BoundSummary summary = bound(curves, how, [&](const CurveEnclosure& piece) {
            const testing::Range range = testing::range_of(piece.piece);
            for (const CurveSample& s : samples[piece.edge.index()]) {
              if (!range.holds(s.t)) continue;
              ++checks;
              const bool inside = testing::contains(piece.offset, piece.interval, s);
              if (!inside) {
                ADD_FAILURE() << disguise.name << ", degree " << degree
                              << (twin.closed ? ", closed, " : ", open, ") << twin.points.size()
                              << " vertices, edge " << s.edge << " at " << s.t << ", piece '" << piece.piece
                              << "'";
              }
            }
          });
          EXPECT_EQ(summary.outcome, Outcome::complete);
        };
        for (const unsigned level : {0u, 1u, 2u, 5u}) {
          BoundOptions how;
          how.level = level;
          check(how);
        }
        if (HasFailure()) FAIL();
      }
    }
  }
  std::cout << points << " limit points, " << checks << " checks\n";
  EXPECT_GE(points, 100'000u);
}

// After many splits a piece is nothing but rounding.
TEST(curves, lie_in_their_enclosures_after_fifty_splits) {
  std::mt19937_64 random(32);
  std::size_t checks = 0;
  for (const Disguise& disguise : disguises()) {
    for (const TwinPolyline& plain : testing::assorted_polylines(8)) {
      TwinPolyline twin = plain;
      for (oracle::Point& p : twin.points) p = disguise.change(p);
      for (const int degree : {2, 3}) {
        const CurveSet curves = testing::curve_set(twin, degree);
        const PowerOfTwo back = curves.edges().scale().inverse();
        const auto edge = static_cast<std::uint32_t>(random() % twin.edge_count());
        for (const std::uint64_t turns :
             {std::uint64_t{0}, ~std::uint64_t{0}, static_cast<std::uint64_t>(random())}) {
          CurvePiece piece = curves.edges().piece(EdgeId(edge));
          BoundingPoints points;
          for (unsigned level = 0; level <= 50; ++level) {
            const testing::Range range = testing::range_of(piece.path.text());
            bounding_points(piece, points);
            const auto limits = limit_ends(piece);
            const std::array<Vector3, 2> ends{limits[0].relative, limits[1].relative};
            const OffsetSegment offset = unscaled(offset_segment(points, ends), back);
            const IntervalSegment interval = unscaled(interval_simplex<2>(points, ends), back);
            for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
              ++checks;
              ASSERT_TRUE(testing::contains(offset, interval,
                                            curve_at(twin, degree, edge, range.first + share * range.size)))
                  << disguise.name << ", degree " << degree << ", level " << level;
            }
            if (level < 50) piece = split(piece, (turns >> level) & 1);
          }
        }
      }
    }
  }
  EXPECT_GT(checks, 100'000u);
}

TEST(curves, positions_are_within_their_error) {
  std::mt19937_64 random(33);
  std::size_t points = 0;
  for (const Disguise& disguise : disguises()) {
    for (const TwinPolyline& plain : testing::assorted_polylines(9)) {
      TwinPolyline twin = plain;
      for (oracle::Point& p : twin.points) p = disguise.change(p);
      for (const int degree : {2, 3}) {
        const CurveSet curves = testing::curve_set(twin, degree);
        for (std::uint32_t e = 0; e < twin.edge_count(); ++e) {
          for (const double t : parameters(random, 20)) {
            const CurvePoint point = evaluate(curves, EdgeId(e), t);
            const CurveSample s = curve_at(twin, degree, e, t);
            ++points;
            for (std::size_t a = 0; a < 3; ++a) {
              ASSERT_LE(std::fabs(static_cast<long double>(point.point[a]) - s.position[a]),
                        static_cast<long double>(point.error) + s.error)
                  << disguise.name << ", degree " << degree << ", edge " << e << " at " << t;
            }
          }
        }
      }
    }
  }
  EXPECT_GT(points, 50'000u);
}

}  // namespace
}  // namespace snug::curve_test
