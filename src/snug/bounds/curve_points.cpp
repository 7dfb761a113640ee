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

void clear(const CurvePiece& piece, HullPoints& out) {
  out.resize(0);
  out.origin = piece.origin;
  out.error = out.largest = 0;
  out.tips = {};
}

}  // namespace

void hull_points(const CurvePiece& piece, HullPoints& out) {
  clear(piece, out);
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

void control_points(const CurvePiece& piece, HullPoints& out) {
  clear(piece, out);
  const std::array<LimitPoint, 2> ends = limit_ends(piece);
  const std::span<const Vector3> controls = piece.controls();
  const std::size_t first = piece.ghost[0] ? 1 : 0, last = piece.ghost[1] ? 1 : 0;
  append(controls.subspan(first, controls.size() - first - last), piece.error, out);
  for (std::size_t end = 0; end < 2; ++end) {
    if (piece.ghost[end]) append({&ends[end].relative, 1}, ends[end].error, out);
  }
}

}  // namespace snug
