#include <experiments/control_box.h>

#include <algorithm>
#include <array>

namespace snug {

void control_points(const Patch& patch, HullPoints& out) {
  out.origin = patch.origin;
  out.resize(patch.points.size());
  for (std::size_t i = 0; i < patch.points.size(); ++i) out.set(i, patch.points[i]);
  out.largest = patch.largest;
  out.error = patch.error;
  out.tips = {};
}

void control_points(const CurvePiece& piece, HullPoints& out) {
  out.resize(0);
  out.origin = piece.origin;
  out.error = out.largest = 0;
  out.tips = {};
  const auto add = [&](const Vector3& point, double error) {
    out.resize(out.size() + 1);
    out.set(out.size() - 1, point);
    out.largest = std::max(out.largest, max_abs(point));
    out.error = std::max(out.error, error);
  };
  const std::array<LimitPoint, 2> ends = limit_ends(piece);
  const std::span<const Vector3> controls = piece.controls();
  for (std::size_t i = 0; i < controls.size(); ++i) {
    const bool first = piece.ghost[0] && i == 0, last = piece.ghost[1] && i + 1 == controls.size();
    if (!first && !last) add(controls[i], piece.error);
  }
  for (std::size_t end = 0; end < 2; ++end) {
    if (piece.ghost[end]) add(ends[end].relative, ends[end].error);
  }
}

}  // namespace snug
