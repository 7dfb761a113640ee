#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <snug/run.h>
#include <snug/search/feet.h>

namespace snug {

/// Is a point on the queried side? Nothing where that is not known. One test a thread.
using SideTest = std::function<std::optional<bool>(const Point3& point, double error)>;

struct HausdorffOptions {
  double precision;                 ///< wanted: upper - lower <= precision
  std::optional<double> threshold;  ///< ... or that one of them decides whether the distance is greater
  std::function<SideTest()> make_side_test{};  ///< count only points on this side of the other set
  std::uint64_t budget;                        ///< most parts to be compared
  int threads = 0;
};

/// The greatest distance of points of one set from another one, while it is searched for.
struct Farthest {
  double lower = 0, upper = 0;  ///< of pieces that are resolved
  BoundedPoint from;            ///< where `lower` is reached
  QuadraticFoot to;
  std::optional<std::pair<std::uint32_t, TriangleParameter>> at;  ///< piece and parameter of `from`; none yet
  std::uint64_t compared = 0;
  bool ended = false;  ///< the budget is used up: pieces were resolved as they are
};

/// A piece that could not be resolved since its quadratic, or those near it, are not exact enough.
struct Unresolved {
  std::uint32_t piece;
  double reach;  ///< all points of its set are at most this far from the other set
};

/// Resolves pieces of a set: each is cut into parts until a part is proved to be no farther from the other set
/// than `farthest.upper`, which is raised where it must be.
///
/// A part is compared with one piece of the other set at a time: the difference of two quadratics over the
/// same parameters is a quadratic, no longer than its longest Bezier point. Points of the set bound the
/// distance from below.
///
/// Guarantee: after it, every point of pieces that are resolved, and on the queried side, is at most
///            `farthest.upper` from the other set; the point `from` is at least `farthest.lower` from it. The
///            same for any number of threads.
/// Requires:  sets that are prepared; with `last` pieces are resolved whatever their errors are.
/// Source:    derivations/deviation.md.
[[nodiscard]] std::vector<Unresolved> resolve(const PieceSet& set, std::span<const std::uint32_t> pieces,
                                              const PieceSet& other, const HausdorffOptions& options,
                                              bool last, Farthest& farthest, const WorkMonitor& monitor = {});

}  // namespace snug
