#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <snug/base/error.h>

namespace snug {

/// When the bounds of a distance are near enough: upper - lower <= max(absolute, relative * upper).
struct DistanceOptions {
  double absolute = 0;               ///< >= 0, mesh units
  double relative = 0;               ///< >= 0
  std::uint64_t budget = 1'000'000;  ///< most pieces opened
  bool solid = false;  ///< distance(): closed surfaces bound solids, which are 0 apart where they meet
};

/// Throws InputError (value) unless both precisions are finite and >= 0.
inline void require_precision(const DistanceOptions& options) {
  require_length(options.absolute, "the absolute precision");
  require_length(options.relative, "the relative precision");
}

/// A number of single precision that is not above a lower bound; below zero where single precision underflows.
/// Requires:  x >= 0.
[[nodiscard]] inline float single_down(double x) { return static_cast<float>(x * (1 - 0x1p-23)) - 0x1p-125F; }

/// Bounds of a distance while they are searched for, in a search's units, in which surfaces are about 2 large.
class DistanceBounds {
 public:
  /// `absolute`, `noise`: bounds are not brought nearer to each other than this; `noise` where rounding hides what is left.
  DistanceBounds(double absolute, double relative, double noise)
      : absolute_(std::max(absolute, noise)), relative_(relative) {}

  [[nodiscard]] double upper() const { return upper_; }
  [[nodiscard]] double lower() const { return std::min(std::max(settled_, floor_), upper_); }
  [[nodiscard]] double precision() const { return std::max(absolute_, relative_ * upper_); }
  /// What is as far as this need not be looked at.
  [[nodiscard]] double enough() const { return upper_ == INFINITY ? INFINITY : upper_ - precision(); }
  /// The distance is at least this, whatever is left to be searched.
  void raise(double floor) { floor_ = std::max(floor_, floor); }
  /// Is what is left to be searched of no interest?
  [[nodiscard]] bool done() const { return upper_ <= 0 || floor_ >= enough(); }
  /// The distance is at most this.
  void found(double upper) { upper_ = std::min(upper_, upper); }
  /// A part of the search is done with: it is no nearer than this.
  void settle(double lower) { settled_ = std::min(settled_, lower); }

 private:
  double absolute_, relative_;
  double upper_ = INFINITY, settled_ = INFINITY, floor_ = 0;
};

/// Are bounds, in mesh units, as near as was asked for?
[[nodiscard]] inline bool near_enough(double lower, double upper, const DistanceOptions& options) {
  return upper - lower <= std::max(options.absolute, options.relative * upper);
}

}  // namespace snug
