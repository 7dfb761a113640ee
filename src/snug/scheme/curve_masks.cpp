#include <snug/scheme/curve_masks.h>

#include <array>
#include <span>
#include <string>

#include <snug/geometry/rounding.h>
#include <snug/mesh/validate.h>
#include <support/contract.h>
#include <support/error.h>

namespace snug {
namespace {

// Weights of up to three neighbours in a row, as whole numbers over a denominator.
struct Mask {
  std::array<int, 3> weights;
  int denominator;
};
constexpr Mask vertex_itself{{1, 0, 0}, 1};
constexpr Mask edge_middle{{1, 1, 0}, 2};
constexpr Mask cubic_vertex{{1, 6, 1}, 8};
constexpr Mask first_cut{{3, 1, 0}, 4};
constexpr Mask second_cut{{1, 3, 0}, 4};
constexpr Mask first_third{{2, 1, 0}, 3};
constexpr Mask second_third{{1, 2, 0}, 3};
constexpr Mask cubic_limit{{1, 4, 1}, 6};
constexpr Mask quadratic_limit{{1, 6, 1}, 8};

// A mask and the first control point that it weighs.
struct Placed {
  std::uint32_t first;
  Mask mask;
};

Stencils rows_of(std::span<const Placed> list) {
  Stencils rows;
  for (const auto& [first, mask] : list) {
    for (std::uint32_t i = 0; i < 3; ++i) {
      if (mask.weights[i] == 0) continue;
      const double weight = static_cast<double>(mask.weights[i]) / mask.denominator;
      const bool exact = (mask.denominator & (mask.denominator - 1)) == 0;
      rows.add(first + i, weight, exact ? 0 : unit_roundoff * weight);
    }
    rows.end_row();
  }
  return rows;
}

// Points in a row after a step: the window of the second child begins one later than that of the first.
Stencils make_child_rows(CurveWindow window, unsigned child) {
  constexpr std::array<Placed, 5> cubic{
      {{0, edge_middle}, {0, cubic_vertex}, {1, edge_middle}, {1, cubic_vertex}, {2, edge_middle}}};
  constexpr std::array<Placed, 5> cuts{
      {{0, first_cut}, {0, second_cut}, {1, first_cut}, {1, second_cut}, {2, first_cut}}};
  if (window == CurveWindow::cubic_edge) return rows_of(std::span(cubic).subspan(child, 4));
  return rows_of(std::span(cuts).subspan(child + (window == CurveWindow::quadratic_edge ? 1 : 0), 3));
}

Point3 applied(const Mask& mask, const Point3& a, const Point3& b, const Point3& c) {
  const double d = mask.denominator;
  const double u = mask.weights[0] / d, v = mask.weights[1] / d, w = mask.weights[2] / d;
  return {u * a.x + v * b.x + w * c.x, u * a.y + v * b.y + w * c.y, u * a.z + v * b.z + w * c.z};
}
Point3 applied(const Mask& mask, const Point3& a, const Point3& b) { return applied(mask, a, b, b); }

// A vertex by a mask of itself and its neighbours; the ends of an open polyline stay.
Point3 moved_vertex(const ControlPolygon& polygon, std::size_t i, const Mask& mask) {
  const auto& p = polygon.points;
  const std::size_t n = p.size();
  if (!polygon.closed && (i == 0 || i + 1 == n)) return p[i];
  return applied(mask, p[(i + n - 1) % n], p[i], p[(i + 1) % n]);
}

}  // namespace

const Stencils& child_rows(CurveWindow window, unsigned child) {
  SNUG_EXPECT(child < 2);
  using Halves = std::array<Stencils, 2>;
  const auto halves = [](CurveWindow w) { return Halves{make_child_rows(w, 0), make_child_rows(w, 1)}; };
  static const std::array<Halves, 3> rows{halves(CurveWindow::cubic_edge),
                                          halves(CurveWindow::quadratic_edge),
                                          halves(CurveWindow::quadratic_vertex)};
  return rows[static_cast<std::size_t>(window)][child];
}

const Stencils& bezier_rows(CurveWindow window) {
  SNUG_EXPECT(window != CurveWindow::quadratic_edge);
  static const Stencils cubic = rows_of(
      std::array<Placed, 4>{{{0, cubic_limit}, {1, first_third}, {1, second_third}, {1, cubic_limit}}});
  static const Stencils quadratic =
      rows_of(std::array<Placed, 3>{{{0, edge_middle}, {1, vertex_itself}, {1, edge_middle}}});
  return window == CurveWindow::cubic_edge ? cubic : quadratic;
}

ControlPolygon control_polygon(const ControlMesh& mesh, PolylineId p) {
  std::span<const VertexId> vertices = mesh.polyline(p);
  SNUG_EXPECT(vertices.size() >= 2);
  ControlPolygon polygon;
  polygon.closed = vertices.front() == vertices.back();
  if (polygon.closed) vertices = vertices.first(vertices.size() - 1);
  for (const VertexId v : vertices) polygon.points.push_back(mesh.points[v.index()]);
  return polygon;
}

ControlPolygon refine(const ControlPolygon& polygon, CurveDegree degree) {
  const auto& p = polygon.points;
  const std::size_t n = p.size(), edges = polygon.closed ? n : n - 1;
  ControlPolygon result{{}, polygon.closed};
  result.points.reserve(2 * n);
  if (degree == CurveDegree::quadratic && !polygon.closed) result.points.push_back(p.front());
  for (std::size_t i = 0; i < edges; ++i) {
    const Point3 &a = p[i], &b = p[(i + 1) % n];
    if (degree == CurveDegree::cubic) {
      result.points.push_back(moved_vertex(polygon, i, cubic_vertex));
      result.points.push_back(applied(edge_middle, a, b));
    } else {
      result.points.push_back(applied(first_cut, a, b));
      result.points.push_back(applied(second_cut, a, b));
    }
  }
  if (!polygon.closed) result.points.push_back(p.back());
  return result;
}

ControlPolygon limit_positions(const ControlPolygon& polygon, CurveDegree degree) {
  ControlPolygon result{{}, polygon.closed};
  result.points.reserve(polygon.points.size());
  const Mask& mask = degree == CurveDegree::cubic ? cubic_limit : quadratic_limit;
  for (std::size_t i = 0; i < polygon.points.size(); ++i) {
    result.points.push_back(moved_vertex(polygon, i, mask));
  }
  return result;
}

void require_curves(const ControlMesh& mesh) {
  const auto refuse = [](const std::string& why) { throw InputError(InputProblem::refused, why); };
  if (mesh.polyline_count() == 0) refuse("the mesh has no polylines, which curves are made of");
  std::vector<Defect> found;
  std::vector<bool> used(mesh.vertex_count(), false);
  for (std::size_t p = 0; p < mesh.polyline_count(); ++p) {
    const auto vertices = mesh.polyline(PolylineId(p));
    const std::string line = "polyline " + std::to_string(p);
    if (vertices.size() < 2) {
      found.push_back({DefectKind::too_few_vertices,
                       line + " has " + std::to_string(vertices.size()) + " vertices, a polyline needs 2"});
    }
    for (const VertexId v : vertices) {
      if (v.index() < used.size()) {
        used[v.index()] = true;
      } else {
        found.push_back({DefectKind::index_out_of_range, line + " uses vertex " + std::to_string(v.index()) +
                                                             " of " + std::to_string(used.size())});
      }
    }
  }
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    if (used[v] && !is_finite(mesh.points[v])) {
      found.push_back({DefectKind::coordinate_not_finite,
                       "vertex " + std::to_string(v) + " has a coordinate that is not finite"});
    }
  }
  if (!found.empty()) refuse(summary(found) + "; mend these elements");
  for (const CornerTag& tag : mesh.tags.corners) {
    if (tag.sharpness > 0 && tag.vertex.index() < used.size() && used[tag.vertex.index()]) {
      refuse("vertex " + std::to_string(tag.vertex.index()) +
             " is tagged as a corner, which curves do not have: end a polyline there and begin another");
    }
  }
}

}  // namespace snug
