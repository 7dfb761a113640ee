#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <experiments/bound_source.h>
#include <experiments/corner_nets.h>
#include <snug/geometry/triangle.h>
#include <snug/patch/patch.h>
#include <snug/run.h>

/// How much larger radii are than they had to be. An experiment: nothing here is a bound of a surface.
namespace snug {

/// Limit points of one patch, to measure how far it is from triangles.
class LimitLattice {
 public:
  /// The points at all parameters (i, j) / steps.
  /// Requires:  the patch outlives this.
  /// Errors:    InputError (value) unless steps >= 1.
  /// Cost:      (steps + 1) (steps + 2) / 2 limit points.
  LimitLattice(const Patch& patch, int steps);

  /// A radius that no offset triangle of this base can do without: the largest distance of a limit point from
  /// `base` that was found, on the lattice and by a pattern search from its farthest point.
  ///
  /// Guarantee: the distance of a limit point from the triangle, up to rounding: a lower bound of the least
  ///            radius, and how near it comes is not proved.
  /// Cost:      some 20 ns a lattice point, and about a hundred limit points.
  [[nodiscard]] double min_radius(const Triangle& base) const;

 private:
  struct Sample {
    TriangleParameter at;
    Vector3 point;  // relative to the patch's origin
  };
  const Patch& patch_;
  int steps_;
  std::vector<Sample> samples_;
};

struct TightnessOptions {
  std::size_t nets = 60;  ///< a shape and valence; two patches each
  int steps = 64;         ///< of the lattice along each edge
  std::uint64_t seed = 1;
  int threads = 0;
};

/// One line of the experiment: radii over the least possible for the same base triangles.
struct TightnessRow {
  NetShape shape;
  std::size_t valence;
  BoundSource source;
  std::size_t patches;        ///< that were measured: of which rounding makes up less than a thousandth
  double median, high, most;  ///< quantiles 0.5, 0.95 and 1; 0 if no patch was measured
  double over_rows;  ///< median of the radius over that of bounding rows for the same patch; likewise
};

/// Rows of all shapes, valences and sources, in this order.
///
/// Guarantee: the same for any number of threads.
/// Errors:    InputError (value) unless nets >= 1 and steps >= 1.
/// Cost:      some 3 ms a net at the default steps.
[[nodiscard]] std::vector<TightnessRow> measure_tightness(const TightnessOptions& options,
                                                          const WorkMonitor& monitor = {});

}  // namespace snug
