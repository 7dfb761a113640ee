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
  [[nodiscard]] double lower() const { return std::min(std::max(pruned_, floor_), upper_); }
  [[nodiscard]] double precision() const { return std::max(absolute_, relative_ * upper_); }
  /// Distance beyond which pairs are pruned.
  [[nodiscard]] double prune_distance() const { return upper_ == INFINITY ? INFINITY : upper_ - precision(); }
  /// The distance is at least this, whatever is left to be searched.
  void raise_lower(double floor) { floor_ = std::max(floor_, floor); }
  /// Is what is left to be searched of no interest?
  [[nodiscard]] bool done() const { return upper_ <= 0 || floor_ >= prune_distance(); }
  /// The distance is at most this.
  void reduce_upper(double upper) { upper_ = std::min(upper_, upper); }
  /// A part of the search was pruned, and is no nearer than this.
  void prune(double lower) { pruned_ = std::min(pruned_, lower); }

 private:
  double absolute_, relative_;
  double upper_ = INFINITY, pruned_ = INFINITY, floor_ = 0;
};

/// Are bounds, in mesh units, as near as was asked for?
[[nodiscard]] inline bool near_enough(double lower, double upper, const DistanceOptions& options) {
  return upper - lower <= std::max(options.absolute, options.relative * upper);
}

}  // namespace snug
