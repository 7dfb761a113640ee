#include <algorithm>
#include <array>
#include <vector>

#include "bezier.h"
#include "half_quad.h"
#include "prove.h"
#include "quadratic.h"
#include "rejected.h"

namespace checker {
namespace {

using Point = std::array<double, 2>;
using Planar = std::array<Real, 2>;

// The set normal . x <= bound.
struct HalfPlane {
  Planar normal;
  Real bound;
};

Real dot(const Planar& a, const Planar& b) { return a[0] * b[0] + a[1] * b[1]; }

bool turns_left(const Point& a, const Point& b, const Point& c) {
  const Planar p{Real(b[0]) - a[0], Real(b[1]) - a[1]}, q{Real(c[0]) - a[0], Real(c[1]) - a[1]};
  return (p[0] * q[1] - p[1] * q[0]).certainly_positive();
}

// Corners of a convex polygon, counter-clockwise, in the hull of the points: all that are certainly corners.
std::vector<Point> convex_polygon(std::vector<Point> points) {
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 2) return points;
  std::vector<Point> polygon;
  const auto add_chain = [&](auto begin, auto end) {
    const std::size_t fixed = polygon.size();
    for (; begin != end; ++begin) {
      while (polygon.size() > fixed + 1 && !turns_left(polygon[polygon.size() - 2], polygon.back(), *begin))
        polygon.pop_back();
      polygon.push_back(*begin);
    }
    polygon.pop_back();
  };
  add_chain(points.begin(), points.end());
  add_chain(points.rbegin(), points.rend());
  return polygon;
}

// The sum of a convex polygon and the square |x|, |y| <= error: a polygon whose edges are parallel to those of
// both.
std::vector<HalfPlane> widened(const std::vector<Point>& polygon, double error) {
  std::vector<Planar> normals{{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    normals.push_back({Real(b[1]) - a[1], Real(a[0]) - b[0]});
  }
  std::vector<HalfPlane> sides;
  for (const Planar& normal : normals) {
    const Real more = Real(error) * (normal[0].magnitude() + normal[1].magnitude());
    std::vector<Real> reach;
    for (const Point& p : polygon) reach.push_back(dot(normal, {Real(p[0]), Real(p[1])}));
    const auto farthest = std::max_element(reach.begin(), reach.end(), [](const Real& a, const Real& b) {
      return a.approximately() < b.approximately();
    });
    sides.push_back({normal, *farthest + more});
  }
  return sides;
}

class FrameProver {
 public:
  explicit FrameProver(const StoredFrame& frame)
      : frame_(frame), sides_(widened(convex_polygon(frame.offsets), frame.offset_error)) {}

  // A Piece of Loop, or a HalfQuad. Nets are split until they hold, Bezier points are taken as they are.
  template <class AnyPiece>
  void prove(const AnyPiece& piece) const {
    if (piece.polynomial()) {
      for (const BezierTriangle& triangle : bezier_triangles(piece)) require(triangle);
    } else if (!holds(piece)) {
      if (piece.depth >= depth_limit) throw Rejected("a net that is beyond the frame at any level");
      for (const AnyPiece& child : split(piece)) prove(child);
    }
  }

 private:
  void require(const BezierTriangle& triangle) const {
    const std::vector<Exponents>& all = exponents(triangle.degree);
    for (std::size_t p = 0; p < all.size(); ++p) {
      if (!no_larger(triangle.points[p])) throw Rejected("a basis function that may be larger");
      if (!is_offset(place_of(triangle.points[p]), raised_parameter(triangle.places, all[p])))
        throw Rejected("limit points that may be farther from their parameters");
    }
  }

  // A point of the piece and its parameter may be anywhere in the hulls of both.
  template <class AnyPiece>
  [[nodiscard]] bool holds(const AnyPiece& piece) const {
    return std::all_of(piece.rows.begin(), piece.rows.end(), [&](const auto& row) {
      if (!no_larger(*row)) return false;
      const Planar at = place_of(*row);
      return std::all_of(piece.places.begin(), piece.places.end(),
                         [&](const Place& corner) { return is_offset(at, parameter_of(corner)); });
    });
  }

  [[nodiscard]] bool no_larger(const Row& row) const {
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (!Real(frame_.largest[c]).certainly_at_least(row[c].magnitude())) return false;
    }
    return true;
  }
  [[nodiscard]] Planar place_of(const Row& row) const {
    Planar at;
    for (std::size_t c = 0; c < row.size(); ++c) {
      for (std::size_t x = 0; x < 2; ++x) at[x].add_product(row[c], frame_.layout[c][x]);
    }
    return at;
  }
  [[nodiscard]] bool is_offset(const Planar& at, const Parameter& t) const {
    const Planar off{at[0] - t[0], at[1] - t[1]};
    return std::all_of(sides_.begin(), sides_.end(), [&](const HalfPlane& side) {
      return side.bound.certainly_at_least(dot(side.normal, off));
    });
  }

  static constexpr unsigned depth_limit = 26;
  const StoredFrame& frame_;
  std::vector<HalfPlane> sides_;
};

}  // namespace

void prove_frame(const StoredFrame& frame, Scheme scheme, const Key& key) {
  if (frame.offsets.empty()) throw Rejected("a polygon without corners");
  if (!Real(frame.offset_error).certainly_at_least(0)) throw Rejected("a negative error");
  const FrameProver prover(frame);
  const auto prove = [&](const auto& root) {
    if (root.rows.size() != frame.layout.size() || root.rows.size() != frame.largest.size())
      throw Rejected("another number of control points than the key gives");
    prover.prove(root);
  };
  Shapes shapes;
  if (scheme == Scheme::loop) {
    prove(root_piece(key));
  } else {
    prove(root_half(shapes, scheme, key));
  }
}

}  // namespace checker
