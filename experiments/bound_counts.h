#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include <experiments/bound_source.h>
#include <snug/run.h>
#include <snug/surface/curve_set.h>
#include <snug/surface/limit_surface.h>

/// How many pieces a surface is split into until a tolerance is met, by what bounds them. One thread.
namespace snug {

/// Ways to bound a surface. The library has the first two; the others lost.
enum class BoundWay : std::uint8_t {
  rows,            ///< bounding rows
  ngon,            ///< the dissertation's tables
  characteristic,  ///< tables over the control net of the characteristic map
  control_box,     ///< boxes of control points
  split,  ///< bounding rows after transient kinds are split until what passes has passed, whatever the tolerance
};
inline constexpr std::array all_bound_ways{BoundWay::rows, BoundWay::ngon, BoundWay::characteristic,
                                           BoundWay::control_box, BoundWay::split};
[[nodiscard]] const char* name_of(BoundWay way);

struct CountOptions {
  /// Split until each radius is at most half of this, in mesh units; of a box half its longest side counts.
  std::optional<double> tolerance = {};
  unsigned level = 0;  ///< without a tolerance: split every patch this often
  std::uint64_t budget = 1'000'000;
};

struct PieceCount {
  std::uint64_t count = 0, splits = 0;
  double largest = 0;   ///< radius, in mesh units
  bool reached = true;  ///< else budget, levels or rounding stood in the way
};

/// Pieces of the whole surface; `sink` is called with each and its radius.
/// Errors:    InputError (value) for a tolerance that is not positive, and a level beyond
///            PiecePath::max_level; Interrupted.
[[nodiscard]] PieceCount count_pieces(const LimitSurface& surface, LayoutTables& tables, BoundWay way,
                                      const CountOptions& options,
                                      const std::function<void(PatchId, const Patch&, double)>& sink = {},
                                      const WorkMonitor& monitor = {});

/// The same of curves, which know bounding rows and control boxes.
/// Errors:    InputError (value) for the other ways, too.
[[nodiscard]] PieceCount count_pieces(const CurveSet& curves, BoundWay way, const CountOptions& options,
                                      const WorkMonitor& monitor = {});

}  // namespace snug
