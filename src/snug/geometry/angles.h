#pragma once

namespace snug {

struct NearestTurn {
  double sine, cosine;
};

/// Sine and cosine of an angle, and the angle of (x, y): the nearest doubles but for one argument in 10^13, so the same digits on every
/// machine. C libraries promise nothing of their last bit.
///
/// Requires:  finite numbers; of angle_of() none beyond 1e150.
/// Cost:      half a microsecond. Angles beyond 1e9 are those of the C library.
[[nodiscard]] NearestTurn nearest_turn(double radians);
[[nodiscard]] double angle_of(double y, double x);

}  // namespace snug
