#include <experiments/control_box.h>
#include <experiments/quantile.h>
#include <snug/curves.h>
#include <support/error.h>
#include <testing/counts.h>
#include <testing/curves.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <limits>
#include <string>

namespace snug::bound_curve_test {
namespace {

using oracle::TwinPolyline;

std::string refusal(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& error) {
    EXPECT_NE(error.problem(), InputProblem::unreadable);
    return error.what();
  }
  return "nothing was thrown";
}

std::string refusal_of(const ControlMesh& mesh) {
  return refusal([&] { CurveSet(mesh, CurveDegree::cubic); });
}

ControlMesh line_of(std::vector<Point3> points, std::vector<std::size_t> indices) {
  ControlMesh mesh;
  mesh.points = std::move(points);
  std::vector<VertexId> line;
  for (const std::size_t i : indices) line.emplace_back(i);
  mesh.add_polyline(line);
  return mesh;
}

TEST(bound_curve, of_every_edge_meets_the_tolerance) {
  for (const TwinPolyline& twin : testing::assorted_polylines(3)) {
    for (const int degree : {2, 3}) {
      const CurveSet curves = testing::curve_set(twin, degree);
      for (const double tolerance : {0.1, 1e-3, 1e-6}) {
        BoundOptions how;
        how.error = tolerance;
        std::vector<double> covered(curves.edge_count(), 0);
        const BoundSummary summary = bound(curves, how, [&](const CurveEnclosure& piece) {
          EXPECT_LE(piece.offset.radius, tolerance / 2);
          const testing::Range range = testing::range_of(piece.piece);
          EXPECT_EQ(range.first, covered[piece.edge.index()]);
          covered[piece.edge.index()] += range.size;
        });
        EXPECT_EQ(summary.outcome, Outcome::complete);
        EXPECT_LE(summary.max_radius, tolerance / 2);
        for (const double share : covered) EXPECT_EQ(share, 1);
      }
    }
  }
}

TEST(bound_curve, that_runs_out_of_budget_still_covers) {
  const CurveSet curves = testing::curve_set(testing::assorted_polylines(3)[5], 3);
  BoundOptions how;
  how.error = 1e-9;
  double covered = 0;
  const BoundSummary summary =
      bound(curves, how, [&](const CurveEnclosure& piece) { covered += testing::range_of(piece.piece).size; },
            {.max_splits = 10});
  EXPECT_EQ(summary.outcome, Outcome::budget_spent);
  EXPECT_EQ(summary.splits, 10u);
  EXPECT_EQ(covered, static_cast<double>(curves.edge_count()));
}

TEST(bound_curve, stops_where_rounding_stands_in_the_way) {
  TwinPolyline twin = testing::assorted_polylines(3)[5];
  for (auto& p : twin.points)
    p[0] += 1000;  // sooner there: an edge is bounded as a whole before it is visited
  const CurveSet curves = testing::curve_set(twin, 3);
  BoundOptions how;
  how.error = 1e-300;
  std::uint64_t deepest = 0, visited = 0;
  const auto stopped = [&] {
    bound(curves, how,
          [&](const CurveEnclosure& piece) {
            deepest = std::max<std::uint64_t>(deepest, piece.level);
            if (++visited > 4'000) throw Interrupted();
          },
          {.max_splits = 1'000'000'000});
  };
  EXPECT_THROW(stopped(), Interrupted);
  EXPECT_LT(deepest, 40u);
}

TEST(bound_curve, has_enclosures_at_the_last_level) {
  for (const int degree : {2, 3}) {
    CurvePiece piece = testing::curve_set(testing::assorted_polylines(3)[5], degree).edges().piece(EdgeId(0));
    while (piece.path.level() < PiecePath::max_level) piece = split(piece, 1);
    BoundingPoints points;
    bounding_points(piece, points);
    const auto limits = limit_ends(piece);
    EXPECT_LT(offset_segment(points, {limits[0].relative, limits[1].relative}).radius, 1e-12);
    EXPECT_LT(longest_side(control_box(piece, points)), 1e-12);
  }
}

// Radius over the least radius of any translate of the same segment, from dense limit points.
TEST(bound_curve, is_close_to_the_least_radius) {
  std::vector<double> ratios[2];
  for (std::uint64_t seed = 20; seed < 20 + testing::fewer(8); ++seed) {
    for (const TwinPolyline& twin : testing::assorted_polylines(seed)) {
      for (const int degree : {2, 3}) {
        const CurveSet curves = testing::curve_set(twin, degree);
        for (const unsigned level : {0u, 2u}) {
          BoundOptions how;
          how.level = level;
          bound(curves, how, [&](const CurveEnclosure& piece) {
            if (piece.offset.radius < 1e-9) return;
            std::vector<Point3> samples;
            const testing::Range range = testing::range_of(piece.piece);
            for (int i = 0; i <= 64; ++i) {
              samples.push_back(evaluate(curves, piece.edge, range.first + i / 64.0 * range.size).point);
            }
            Segment segment = piece.corners;
            double least = std::numeric_limits<double>::infinity();
            for (int round = 1; round <= 300; ++round) {
              Vector3 farthest;
              for (const Point3& p : samples) {
                const Vector3 edge = segment[1] - segment[0], d = p - segment[0];
                const double t = std::clamp(dot(d, edge) / std::max(length_sq(edge), 1e-300), 0.0, 1.0);
                if (length_sq(d - t * edge) > length_sq(farthest)) farthest = d - t * edge;
              }
              least = std::min(least, length(farthest));
              for (Point3& end : segment) end = end + (1.0 / (round + 1)) * farthest;
            }
            ratios[degree - 2].push_back(piece.offset.radius / least);
          });
        }
      }
    }
  }
  for (const int degree : {2, 3}) {
    const auto& r = ratios[degree - 2];
    const double median = quantile(r, 0.5), high = quantile(r, 0.95), most = quantile(r, 1);
    std::cout << "degree " << degree << ": " << r.size() << " pieces, radius over the least: median "
              << median << ", 95 % " << high << ", most " << most << '\n';
    EXPECT_LT(median, 1.02);
    EXPECT_LT(high, 1.15);
    EXPECT_LT(most, 3);  // curves that turn back: Bezier points stick out beyond the ends
  }
}

TEST(bound_curve, of_a_straight_evenly_spaced_polyline_is_thin) {
  for (const int degree : {2, 3}) {
    const CurveSet curves = testing::curve_set({{{0, 0, 0}, {1, 1, 2}, {2, 2, 4}, {3, 3, 6}}, false}, degree);
    bound(curves, {}, [](const CurveEnclosure& piece) { EXPECT_LT(piece.offset.radius, 1e-13); });
  }
}

TEST(curve_set, refuses_what_has_no_curve_and_names_it) {
  const std::vector<Point3> two{{0, 0, 0}, {1, 0, 0}};
  EXPECT_EQ(refusal_of(ControlMesh{}), "the mesh has no polylines, which curves are made of");
  EXPECT_EQ(refusal_of(line_of(two, {0})),
            "polyline 0 has 1 vertices, a polyline needs 2; mend these elements");
  EXPECT_EQ(refusal_of(line_of(two, {0, 7})), "polyline 0 uses vertex 7 of 2; mend these elements");
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(refusal_of(line_of({{0, 0, 0}, {1, bad, 0}}, {0, 1})),
              "vertex 1 has a coordinate that is not finite; mend these elements");
  }
  EXPECT_EQ(CurveSet(line_of({{0, 0, 0}, {1, 0, 0}, {std::nan(""), 0, 0}}, {0, 1}), CurveDegree::cubic)
                .edge_count(),
            1u);
  ControlMesh cornered = line_of(two, {0, 1});
  cornered.tags.corners.push_back({VertexId(1), 2});
  EXPECT_NE(refusal_of(cornered).find("vertex 1 is tagged as a corner"), std::string::npos);
}

TEST(curve_set, takes_two_vertices_repeated_ones_and_closed_ones_of_any_length) {
  const std::vector<Point3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  for (const CurveDegree degree : {CurveDegree::quadratic, CurveDegree::cubic}) {
    for (const auto& [indices, edges] :
         std::vector<std::pair<std::vector<std::size_t>, std::size_t>>{{{0, 1}, 1},
                                                                       {{0, 0}, 1},
                                                                       {{0, 1, 0}, 2},
                                                                       {{0, 1, 2, 0}, 3},
                                                                       {{0, 1, 1, 2}, 3},
                                                                       {{1, 1, 1}, 2}}) {
      const CurveSet curves(line_of(points, indices), degree);
      EXPECT_EQ(curves.edge_count(), edges);
      const BoundSummary summary = bound(curves, {}, [](const CurveEnclosure&) {});
      EXPECT_EQ(summary.count, edges);
      EXPECT_LT(summary.max_radius, 1);
    }
    const CurveSet segment(line_of(points, {0, 1}), degree);
    EXPECT_NEAR(evaluate(segment, EdgeId(0), 0).point.x, 0, 1e-15);
    EXPECT_NEAR(evaluate(segment, EdgeId(0), 1).point.x, 1, 1e-15);
    EXPECT_NEAR(evaluate(segment, EdgeId(0), 0.25).point.x, 0.25, 1e-15);
  }
}

TEST(curve_set, refuses_results_that_do_not_fit_a_double) {
  const double big = std::numeric_limits<double>::max();
  const CurveSet curves(line_of({{-big, 0, 0}, {big, 0, 0}}, {0, 1}), CurveDegree::cubic);
  EXPECT_NE(refusal([&] { bound(curves, {}, [](const CurveEnclosure&) {}); }).find("no longer fits a double"),
            std::string::npos);
}

TEST(evaluate_curve, has_tangents_that_are_derivatives) {
  for (const int degree : {2, 3}) {
    const CurveSet curves = testing::curve_set(testing::assorted_polylines(4)[4], degree);
    for (std::size_t e = 0; e < curves.edge_count(); ++e) {
      for (const double t : {0.1, 0.3, 0.6, 0.9}) {
        const double h = 1e-5;
        const Vector3 slope = (1 / (2 * h)) * (evaluate(curves, EdgeId(e), t + h).point -
                                               evaluate(curves, EdgeId(e), t - h).point);
        EXPECT_LT(length(slope - evaluate(curves, EdgeId(e), t).tangent), 1e-8);
      }
    }
  }
}

// The limit of a refined polyline is the limit of the polyline, and its limit positions lie on it.
TEST(subdivide_curve, keeps_the_curve) {
  for (const TwinPolyline& twin : testing::assorted_polylines(6)) {
    for (const int degree : {2, 3}) {
      const CurveDegree d = degree == 2 ? CurveDegree::quadratic : CurveDegree::cubic;
      const ControlMesh mesh = testing::control_mesh(std::vector{twin});
      const CurveSet curves(mesh, d);
      BoundOptions how;
      how.error = 1e-5;
      std::vector<OffsetSegment> pieces;
      bound(curves, how, [&](const CurveEnclosure& piece) { pieces.push_back(piece.offset); });
      const auto on_curve = [&](const Point3& p) {
        return std::any_of(pieces.begin(), pieces.end(), [&](const OffsetSegment& piece) {
          const Triangle flat{piece.base[0], piece.base[1], piece.base[1]};
          return testing::distance_to_triangle({p.x, p.y, p.z}, flat) <= piece.radius + 1e-12;
        });
      };
      for (const unsigned level : {0u, 1u, 3u}) {
        for (const Point3& p : subdivided(CurveSet(mesh, d), level, true).points) {
          EXPECT_TRUE(on_curve(p)) << "degree " << degree << ", level " << level;
        }
      }
      const CurveSet refined(subdivided(CurveSet(mesh, d), 2), d);
      for (std::size_t e = 0; e < refined.edge_count(); e += 3) {
        EXPECT_TRUE(on_curve(evaluate(refined, EdgeId(e), 0.3).point)) << "degree " << degree;
      }
    }
  }
}

TEST(subdivide_curve, counts_as_it_says) {
  const std::vector<Point3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {3, 1, 0}};
  const auto count = [&](std::vector<std::size_t> line, CurveDegree degree) {
    return subdivided(CurveSet(line_of(points, std::move(line)), degree), 1).vertex_count();
  };
  EXPECT_EQ(count({0, 1, 2, 3}, CurveDegree::cubic), 7u);
  EXPECT_EQ(count({0, 1, 2, 3}, CurveDegree::quadratic), 8u);
  EXPECT_EQ(count({0, 1, 2, 0}, CurveDegree::cubic), 6u);
  EXPECT_EQ(count({0, 1, 2, 0}, CurveDegree::quadratic), 6u);
  EXPECT_NE(refusal([&] {
              static_cast<void>(subdivided(CurveSet(line_of(points, {0, 1})), 31));
            }).find("take a lower level"),
            std::string::npos);
}

}  // namespace
}  // namespace snug::bound_curve_test
