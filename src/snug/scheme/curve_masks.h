#pragma once

#include <cstdint>
#include <vector>

#include <snug/curves.h>
#include <snug/scheme/stencils.h>

namespace snug {

/// The control points that a piece of a curve depends on. Parameters run as on the polyline: a vertex at 0,
/// the next at 1.
///
///     cubic_edge          a   b===c   d     between the limits of b and c
///     quadratic_edge      a   b===c   d     the same; two parabolas that meet in the middle of bc
///     quadratic_vertex    a --=b=-- c       one parabola, from the middle of ab to the middle of bc
///
/// Both children of a cubic_edge are of that kind; those of the others are quadratic_vertex, since corner
/// cutting puts its new vertices at 1/4 and 3/4 of an edge.
enum class CurveWindow : std::uint8_t { cubic_edge, quadratic_edge, quadratic_vertex };

[[nodiscard]] constexpr std::size_t control_count(CurveWindow window) {
  return window == CurveWindow::quadratic_vertex ? 3 : 4;
}
[[nodiscard]] constexpr CurveWindow child_window(CurveWindow window) {
  return window == CurveWindow::cubic_edge ? CurveWindow::cubic_edge : CurveWindow::quadratic_vertex;
}

/// The control points of the first (child 0) or the second half of a piece, a row each. The weights are
/// exact.
[[nodiscard]] const Stencils& child_rows(CurveWindow window, unsigned child);

/// The Bezier points of a piece that is one polynomial: all but quadratic_edge.
/// Guarantee: of the weights only the sixths and thirds of degree 3 are rounded.
[[nodiscard]] const Stencils& bezier_rows(CurveWindow window);

/// A polyline with its vertices in a row; a closed one does not repeat its first.
struct ControlPolygon {
  std::vector<Point3> points;
  bool closed = false;
};
[[nodiscard]] ControlPolygon control_polygon(const ControlMesh& mesh, PolylineId p);

/// One step of subdivision, in double precision. Ends of open polylines stay where they are.
///
///     cubic      edge i becomes 2i and 2i + 1; n vertices become 2n - 1 (open) or 2n (closed)
///     quadratic  two vertices an edge, and the ends of open ones: 2n
///
/// Source:    derivations/curves.md.
[[nodiscard]] ControlPolygon refine(const ControlPolygon& polygon, CurveDegree degree);

/// The limit position of every vertex, in double precision.
[[nodiscard]] ControlPolygon limit_positions(const ControlPolygon& polygon, CurveDegree degree);

/// Throws InputError (refused), naming elements, unless every polyline has a limit curve: at least one
/// polyline, two vertices each (twice the same is legal), all of them there and finite, no corners.
void require_curves(const ControlMesh& mesh);

}  // namespace snug
