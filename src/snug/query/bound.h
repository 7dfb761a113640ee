#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include <snug/bounds/bound_method.h>
#include <snug/bounds/enclosure.h>
#include <snug/patch/piece_path.h>
#include <snug/surface/curve_set.h>
#include <snug/surface/limit_surface.h>

namespace snug {

struct BoundOptions {
  BoundMethod method = BoundMethod::rows;
  /// Split until each radius is at most half of this, in mesh units.
  std::optional<double> tolerance;
  /// Without a tolerance: split every patch this often; the first split of a polygon that is no patch counts.
  unsigned level = 0;
  std::uint64_t budget = 10'000'000;  ///< most splits in all; spent patch by patch
  int threads = 0;
};

/// Throws InputError (value) unless the tolerance, if there is one, is finite and positive, and the level at most
/// PiecePath::max_level.
void require_sound(const BoundOptions& options);

/// What encloses one piece, in mesh units.
template <std::size_t N>
struct Enclosure {
  PiecePath path;
  std::array<Point3, N> corners;  ///< limit corners, in double precision
  OffsetSimplex<N> offset;
  IntervalSimplex<N> interval;
};
/// Of a limit surface.
struct PieceEnclosure : Enclosure<3> {
  PatchId patch;
};
/// Of a limit curve.
struct CurveEnclosure : Enclosure<2> {
  EdgeId edge;
};

struct BoundSummary {
  std::uint64_t count = 0;
  double max_radius = 0;
  std::uint64_t splits = 0;
  /// Every piece meets the tolerance; else budget, levels or rounding stood in the way.
  bool reached = true;
};

/// Enclosures of the whole limit surface, passed to `sink` patch by patch, pieces of one in the order of
/// their paths.
///
/// Guarantee: every limit point of a patch lies in the union of its pieces' offset triangles, and of their
///            interval triangles, rounding included; also where `reached` is false. Same output for any number of threads.
/// Errors:    InputError (value) as require_sound(), (unrepresentable) if a result does not fit a double; whatever `sink` or
///            the monitor throws.
/// Cost:      rows: a piece 3 to 5 microseconds on regular patches. Memory holds the pieces of one face,
///            or some 65,000; it does not grow with the output.
BoundSummary bound(const LimitSurface& surface, const BoundOptions& options,
                   const std::function<void(const PieceEnclosure&)>& sink, const WorkMonitor& monitor = {});
/// The same of all limit curves, edge by edge, pieces of one from its first end to its last.
/// Errors:    as above; InputError (value) for tables, which curves do not have.
/// Cost:      about a microsecond a piece.
BoundSummary bound(const CurveSet& curves, const BoundOptions& options,
                   const std::function<void(const CurveEnclosure&)>& sink, const WorkMonitor& monitor = {});

}  // namespace snug
