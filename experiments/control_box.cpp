#include <experiments/control_box.h>

#include <algorithm>
#include <array>

#include <snug/geometry/rounding.h>

namespace snug {

void control_points(const Patch& patch, BoundingPoints& out) {
  out.restart(patch.origin);
  out.add(patch.points, patch.error, patch.largest);
}

void control_points(const CurvePiece& piece, BoundingPoints& out) {
  out.restart(piece.origin);
  const auto add = [&](const Vector3& point, double error) { out.add({&point, 1}, error, max_abs(point)); };
  const std::array<RelativePoint, 2> ends = limit_ends(piece);
  const std::span<const Vector3> controls = piece.controls();
  for (std::size_t i = 0; i < controls.size(); ++i) {
    const bool first = piece.ghost[0] && i == 0, last = piece.ghost[1] && i + 1 == controls.size();
    if (!first && !last) add(controls[i], piece.error);
  }
  for (std::size_t end = 0; end < 2; ++end) {
    if (piece.ghost[end]) add(ends[end].relative, ends[end].error);
  }
}

Box3 outer_box(const BoundingPoints& points) {
  Box3 box;
  const kernels::Coordinates all = points.coordinates();
  const std::array<const double*, 3> axes{all.x, all.y, all.z};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto [low, high] = std::minmax_element(axes[a], axes[a] + all.count);
    const double o = points.origin[a];
    box.lower[a] = rounded_down(o + rounded_down(*low - points.error));
    box.upper[a] = rounded_up(o + rounded_up(*high + points.error));
  }
  return box;
}

}  // namespace snug
