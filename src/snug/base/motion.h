#pragma once

#include <array>

#include <snug/base/point.h>

namespace snug {

/// A placement: x -> R x + t, with exactly these doubles, row-major 3x4 (R | t).
struct Placement {
  std::array<double, 12> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

  [[nodiscard]] Vector3 row(std::size_t i) const { return {m[4 * i], m[4 * i + 1], m[4 * i + 2]}; }
  [[nodiscard]] Vector3 translation() const { return {m[3], m[7], m[11]}; }
  [[nodiscard]] Vector3 rotate(Vector3 v) const { return {dot(row(0), v), dot(row(1), v), dot(row(2), v)}; }
  /// R x + t in doubles; see apply_error.
  [[nodiscard]] Point3 apply(Point3 p) const {
    const Vector3 r = rotate({p.x, p.y, p.z}), t = translation();
    return {r.x + t.x, r.y + t.y, r.z + t.z};
  }
  friend bool operator==(const Placement&, const Placement&) = default;
};

/// How far a placement may be from rigid before it is refused.
inline constexpr double rigidity_tolerance = 1e-9;

/// Upper bound of the largest entry of |R'R - I|; infinite for entries that are not finite.
[[nodiscard]] double rigidity_defect(const Placement& placement);

/// Throws InputError (refused) unless the placement is a motion: finite, rigid within rigidity_tolerance, no
/// reflection.
void require_rigid(const Placement& placement);

}  // namespace snug
