#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <support/error.h>

namespace snug {

/// A share of the larger of two sizes: the default precision.
[[nodiscard]] inline double share_of_size(double share, double size_a, double size_b = 0) {
  return std::min(share * std::max(size_a, size_b), std::numeric_limits<double>::max());
}

/// A precision, or options that hold one, with both parts given, as Precision says.
/// Errors:    InputError (value) unless both are finite and >= 0.
template <class Options>
[[nodiscard]] Options with_precision(Options options, double size_a, double size_b = 0) {
  const bool given = options.absolute || options.relative;
  options.absolute = options.absolute.value_or(given ? 0 : share_of_size(1e-4, size_a, size_b));
  options.relative = options.relative.value_or(0);
  require_length(*options.absolute, "the absolute precision");
  require_length(*options.relative, "the relative precision");
  return options;
}

/// Are bounds, in mesh units, within the precision of the options?
template <class Options>
[[nodiscard]] bool near_enough(const Interval& bounds, const Options& options) {
  return bounds.upper - bounds.lower <= std::max(*options.absolute, *options.relative * bounds.upper);
}

/// A number of single precision not above a lower bound x >= 0; below zero where single precision underflows.
[[nodiscard]] inline float single_down(double x) { return static_cast<float>(x * (1 - 0x1p-23)) - 0x1p-125F; }

/// Bounds of a distance while it is searched for, in units in which surfaces are about 2 large.
class DistanceBounds {
 public:
  /// `absolute`, `noise`: bounds come no nearer to each other; below `noise` rounding dominates.
  DistanceBounds(double absolute, double relative, double noise)
      : absolute_(std::max(absolute, noise)), relative_(relative) {}

  /// From now on with this precision.
  void accept(double absolute, double relative, double noise) {
    absolute_ = std::max(absolute, noise);
    relative_ = relative;
  }

  [[nodiscard]] double upper() const { return upper_; }
  [[nodiscard]] double lower() const { return std::min(std::max(pruned_, floor_), upper_) - slack_; }
  [[nodiscard]] double precision() const { return std::max(absolute_, relative_ * upper_); }
  /// Distance beyond which pairs are pruned.
  [[nodiscard]] double prune_distance() const { return upper_ == INFINITY ? INFINITY : upper_ - precision(); }
  /// Parts were pruned by sets that hold them only up to this.
  void loosen(double slack) { slack_ = std::max(slack_, slack); }
  /// The distance is at least this, whatever is left to be searched.
  void raise_lower(double floor) { floor_ = std::max(floor_, floor); }
  /// Can the rest of the search be skipped?
  [[nodiscard]] bool done() const { return upper_ <= 0 || floor_ >= prune_distance(); }
  /// The distance is at most this.
  void reduce_upper(double upper) { upper_ = std::min(upper_, upper); }
  /// A part of the search was pruned, and is no nearer than this.
  void prune(double lower) { pruned_ = std::min(pruned_, lower); }

 private:
  double absolute_, relative_;
  double upper_ = INFINITY, pruned_ = INFINITY, floor_ = 0, slack_ = 0;
};

}  // namespace snug
