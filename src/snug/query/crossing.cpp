#include <snug/query/crossing.h>

#include <algorithm>
#include <cmath>

#include <snug/base/rounding.h>
#include <snug/patch/descent.h>
#include <snug/patch/evaluate.h>

namespace snug {
namespace {

// Levels that a piece near the border's extraordinary corners is split before its whole net stands for its edge.
constexpr unsigned edge_levels = 8;
// Levels from the piece that was asked about to one that is small enough to pass between the strips.
constexpr unsigned probe_levels = 5;

// Bezier points of the polynomial `part` whose hull holds its edge from corner k to k + 1.
template <class Visit>
void visit_bezier_edge(const Patch& patch, std::size_t part, std::size_t edge, const Visit& visit) {
  const PolynomialForm& form = patch.kind->form();
  const std::size_t degree = form.degree, first = part * bezier_count(degree);
  const double error = form.rows.result_error(patch.largest, patch.error);
  for (std::size_t t = 0; t <= degree; ++t) {
    const std::size_t at = edge == 0   ? bezier_index(degree, t, 0)
                           : edge == 1 ? bezier_index(degree, degree - t, t)
                                       : bezier_index(degree, 0, t);
    visit(form.rows.apply<Vector3>(first + at, patch.points), error);
  }
}

// Points, relative to the patch's origin, whose hull holds the curve from its corner k to k + 1, each with its error.
template <class Visit>
void visit_edge(const Patch& patch, std::size_t edge, unsigned level, const Visit& visit) {
  if (!patch.kind->polynomial()) {
    if (level == edge_levels) {
      for (const Vector3& p : patch.points) visit(p, patch.error);
      return;
    }
    visit_edge(split(patch, static_cast<unsigned>(edge)), edge, level + 1, visit);
    visit_edge(split(patch, static_cast<unsigned>((edge + 1) % 3)), edge, level + 1, visit);
    return;
  }
  const std::size_t own = patch.to_kind(edge);  // corner of the kind that the edge begins at
  if (patch.kind->form().parts == 1) {
    visit_bezier_edge(patch, 0, own, visit);
  } else if (own == 0) {  // parts are 0, 1, m and m, 1, 2
    visit_bezier_edge(patch, 0, 0, visit);
  } else if (own == 1) {
    visit_bezier_edge(patch, 1, 1, visit);
  } else {
    visit_bezier_edge(patch, 0, 2, visit);
    visit_bezier_edge(patch, 1, 2, visit);
  }
}

}  // namespace

Crossed::Crossed(const Piece& piece, const Heights& heights) {
  const OffsetTriangle& offset = piece.offset;
  normal_ = unit_normal(offset.base);
  if (normal_ == Vector3{} || !std::isfinite(heights.lower) || !std::isfinite(heights.upper)) return;
  from_ = offset.base[0];
  lower_ = heights.lower;
  upper_ = heights.upper;
  const Patch& patch = piece.patch;
  double corner_error = 0;
  std::array<Point3, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) {
    corners[k] = patch.origin + piece.corners[k];
    const LimitPoint corner = corner_point(patch, k);
    corner_error = std::max(corner_error, corner.error + unit_roundoff * max_abs(corners[k] - Point3{}));
  }
  for (std::size_t k = 0; k < 3; ++k) {
    Strip& strip = strips_[k];
    const Vector3 edge = corners[(k + 1) % 3] - corners[k];
    const double size = max_abs(edge);
    if (!(size > 0) || !std::isfinite(1 / size)) return;
    strip.inward = cross(normal_, (1 / size) * edge);
    const double length_in = length(strip.inward);
    if (!(length_in > 0)) return;
    strip.inward = (1 / length_in) * strip.inward;
    strip.from = corners[k];
    // Both ends of the edge belong to its curve: the exact corners are within their error of these.
    double widest = std::max(0.0, dot(strip.inward, edge)) + 2 * spatial_error(corner_error);
    const Vector3 from = strip.from - patch.origin;
    double largest = max_abs(from);
    visit_edge(patch, k, 0, [&](const Vector3& p, double error) {
      widest = std::max(widest, dot(strip.inward, p - from) + 2 * spatial_error(error));
      largest = std::max(largest, max_abs(p));
    });
    strip.width = enlarged(widest + gamma_bound(16) * largest);
    // Nothing is free unless the opposite corner lies beyond the strip.
    if (!(dot(strip.inward, corners[(k + 2) % 3] - strip.from) > strip.width)) return;
  }
  possible_ = true;
}

bool Crossed::crossed_by(const Triangle& around, double radius, const Triangle& points, double error) const {
  double largest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    largest = std::max({largest, max_abs(around[i] - from_), max_abs(points[i] - from_)});
  }
  const double rounding = gamma_bound(16) * (largest + 4);
  for (const Strip& strip : strips_) {
    for (const Point3& p : around) {
      if (!(dot(strip.inward, p - strip.from) - enlarged(radius) - rounding > strip.width)) return false;
    }
  }
  bool below = false, above = false;
  for (const Point3& p : points) {
    const double height = dot(normal_, p - from_);
    below = below || height + enlarged(error) + rounding < lower_;
    above = above || height - enlarged(error) - rounding > upper_;
  }
  return below && above;
}

bool crosses_near(Refinement& pieces, PieceId id, TriangleParameter at, const Crossed& crossed,
                  const RelativeFrame& seen) {
  if (!seen.comparable) return false;
  at = on_triangle(at);
  for (unsigned level = 0;; ++level) {
    const Piece& piece = pieces[id];
    Triangle around, corners;
    double error = 0, extent = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      around[k] = seen.apply(piece.offset.base[k]);
      const Point3 corner = piece.patch.origin + piece.corners[k];
      corners[k] = seen.apply(corner);
      error =
          std::max(error, corner_point(piece.patch, k).error + unit_roundoff * max_abs(corner - Point3{}));
      extent = std::max(extent, length(corners[k] - corners[0]));
    }
    // seen.slack covers the mapping; lengths grow by its scale.
    const double growth = seen.scale * (1 + 0x1p-20);
    if (crossed.crossed_by(around, growth * piece.offset.radius + seen.slack, corners,
                           growth * spatial_error(error) + seen.slack)) {
      return true;
    }
    if (2 * extent < crossed.thickness() || level == probe_levels ||
        piece.patch.path.level() == PiecePath::max_level) {
      return false;
    }
    const Descent next = descend(at);
    at = next.at;
    id = PieceId(pieces.split(id).index() + next.child);
  }
}

}  // namespace snug
