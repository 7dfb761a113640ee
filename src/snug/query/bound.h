#pragma once

#include <functional>

#include <snug/bound.h>
#include <snug/bounds/enclosure.h>
#include <snug/patch/piece_path.h>
#include <snug/surface/curve_set.h>
#include <snug/surface/limit_surface.h>

namespace snug {

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

/// bound() of bound.h, patches by their names in LimitSurface.
BoundSummary bound(const LimitSurface& surface, const BoundOptions& options,
                   const std::function<void(const PieceEnclosure&)>& sink, const WorkMonitor& monitor = {});
/// The same of all limit curves, edge by edge, pieces of one from its first end to its last.
/// Errors:    as above; InputError (value) for tables, which curves do not have.
/// Cost:      about a microsecond a piece.
BoundSummary bound(const CurveSet& curves, const BoundOptions& options,
                   const std::function<void(const CurveEnclosure&)>& sink, const WorkMonitor& monitor = {});

}  // namespace snug
