#include <snug/bounds/curve_points.h>

#include <algorithm>

namespace snug {
namespace {

void append(std::span<const Vector3> points, double error, HullPoints& out) {
  const std::size_t begin = out.size();
  out.resize(begin + points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    out.set(begin + i, points[i]);
    out.largest = std::max(out.largest, max_abs(points[i]));
  }
  out.error = std::max(out.error, error);
}

}  // namespace

void hull_points(const CurvePiece& piece, HullPoints& out) {
  out.resize(0);
  out.origin = piece.origin;
  out.error = out.largest = 0;
  out.tips = {};
  CurvePiece whole = piece;
  whole.path = {};  // a path may have no room for two more digits
  for (const unsigned half : {0u, 1u}) {
    const CurvePiece parent = split(whole, half);
    for (const unsigned child : {0u, 1u}) {
      const CurveBezier bezier = bezier_points(split(parent, child));
      append({bezier.points.data(), bezier.count}, bezier.error, out);
    }
  }
}

}  // namespace snug
