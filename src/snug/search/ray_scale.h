#pragma once

#include <support/direction.h>
#include <support/point.h>
#include <support/scaling.h>

namespace snug {

/// Between parameters of a ray and lengths along it in scaled units; off by some roundings.
class RayScale {
 public:
  /// Requires:  direction finite and not 0.
  RayScale(const Vector3& direction, PowerOfTwo surface)
      : length_(snug::length(direction)), to_scaled_(surface) {
    plain_ = length_ >= 0x1p-400 && length_ <= 0x1p400;
    if (plain_) return;
    // Squares underflow or overflow.
    const PowerOfTwo turn = PowerOfTwo::normalising(max_abs(direction));
    length_ = snug::length(turn.apply(direction));
    to_scaled_ = surface * turn.inverse();
  }
  /// The ray's direction at length 1, up to some roundings; `direction` is that of the constructor.
  [[nodiscard]] Vector3 unit(const Vector3& direction) const {
    return plain_ ? (1 / length_) * direction : normalized(direction);
  }
  [[nodiscard]] double to_scaled(double t) const { return to_scaled_.apply(t) * length_; }
  [[nodiscard]] double to_parameter(double s) const { return to_scaled_.inverse().apply(s / length_); }

 private:
  double length_;
  PowerOfTwo to_scaled_;
  bool plain_;
};

}  // namespace snug
