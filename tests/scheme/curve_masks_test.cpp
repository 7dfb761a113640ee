#include <snug/scheme/curve_masks.h>

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace snug::curve_masks_test {
namespace {

constexpr std::array windows{CurveWindow::cubic_edge, CurveWindow::quadratic_edge,
                             CurveWindow::quadratic_vertex};
const std::vector<Point3> corners{{0, 0, 0}, {8, 0, 16}, {24, 8, 0}, {-8, 64, 8}};

std::vector<Point3> applied(const Stencils& rows, const std::vector<Point3>& points) {
  std::vector<Point3> result;
  for (std::size_t r = 0; r < rows.row_count(); ++r) result.push_back(rows.apply<Point3>(r, points));
  return result;
}

TEST(curve_masks, weights_sum_to_1) {
  const std::vector<Point3> ones(4, {1, 1, 1});
  for (const CurveWindow window : windows) {
    for (const unsigned child : {0u, 1u}) {
      const Stencils& rows = child_rows(window, child);
      ASSERT_EQ(rows.row_count(), control_count(child_window(window)));
      EXPECT_EQ(rows.max_error(), 0);
      for (const Point3& p : applied(rows, ones)) EXPECT_EQ(p.x, 1);
    }
    if (window == CurveWindow::quadratic_edge) continue;
    for (const Point3& p : applied(bezier_rows(window), ones)) EXPECT_NEAR(p.x, 1, 1e-15);
  }
}

// The rows of pieces and the refinement of whole polylines are one scheme.
TEST(curve_masks, of_pieces_are_those_of_polylines) {
  const ControlPolygon polygon{corners, false};
  const ControlPolygon cubic = refine(polygon, CurveDegree::cubic);
  const auto all = applied(child_rows(CurveWindow::cubic_edge, 0), corners);
  EXPECT_EQ(all, std::vector<Point3>(cubic.points.begin() + 1, cubic.points.begin() + 5));
  EXPECT_EQ(applied(child_rows(CurveWindow::cubic_edge, 1), corners),
            std::vector<Point3>(cubic.points.begin() + 2, cubic.points.begin() + 6));
  const ControlPolygon cut = refine(polygon, CurveDegree::quadratic);
  EXPECT_EQ(applied(child_rows(CurveWindow::quadratic_edge, 0), corners),
            std::vector<Point3>(cut.points.begin() + 2, cut.points.begin() + 5));
  EXPECT_EQ(applied(child_rows(CurveWindow::quadratic_edge, 1), corners),
            std::vector<Point3>(cut.points.begin() + 3, cut.points.begin() + 6));
  EXPECT_EQ(applied(child_rows(CurveWindow::quadratic_vertex, 1), corners),
            std::vector<Point3>(cut.points.begin() + 2, cut.points.begin() + 5));
}

TEST(curve_masks, closed_polylines_go_round) {
  const ControlPolygon polygon{corners, true};
  for (const CurveDegree degree : {CurveDegree::quadratic, CurveDegree::cubic}) {
    const ControlPolygon once = refine(polygon, degree);
    EXPECT_TRUE(once.closed);
    EXPECT_EQ(once.points.size(), 8u);
    ControlPolygon turned = polygon;
    turned.points.push_back(turned.points.front());
    turned.points.erase(turned.points.begin());
    std::vector<Point3> expected(once.points.begin() + 2, once.points.end());
    expected.insert(expected.end(), once.points.begin(), once.points.begin() + 2);
    EXPECT_EQ(refine(turned, degree).points, expected);
  }
  EXPECT_EQ(refine(ControlPolygon{{{1, 2, 3}}, true}, CurveDegree::cubic).points,
            std::vector<Point3>(2, {1, 2, 3}));
}

TEST(curve_masks, ends_of_open_polylines_stay) {
  for (const CurveDegree degree : {CurveDegree::quadratic, CurveDegree::cubic}) {
    ControlPolygon polygon{corners, false};
    for (int step = 0; step < 4; ++step) polygon = refine(polygon, degree);
    polygon = limit_positions(polygon, degree);
    EXPECT_EQ(polygon.points.front(), corners.front());
    EXPECT_EQ(polygon.points.back(), corners.back());
  }
}

}  // namespace
}  // namespace snug::curve_masks_test
