#pragma once

#include <array>
#include <functional>

#include <snug/query/bound.h>
#include <snug/surface/curve_set.h>

namespace snug {

/// What encloses one piece of a limit curve, in mesh units.
struct CurveEnclosure {
  EdgeId edge;
  PiecePath path;
  Segment corners;  ///< limit points at both ends, in double precision
  OffsetSegment offset;
  IntervalSegment interval;
};

/// Enclosures of all limit curves, passed to `sink` edge by edge, pieces of an edge from its first end to its
/// last.
///
/// Guarantee: every limit point of edge e lies in the union of its pieces' offset segments, and of their
///            interval segments, rounding included; also where `reached` is false. `threads` changes nothing.
/// Errors:    InputError (value) for tables and as require_sound(), (unrepresentable) if a result does not fit a double;
///            whatever `sink` or the monitor throws.
/// Cost:      about a microsecond a piece, on one thread. Memory does not grow with the output.
BoundSummary bound(const CurveSet& curves, const BoundOptions& options,
                   const std::function<void(const CurveEnclosure&)>& sink, const WorkMonitor& monitor = {});

}  // namespace snug
