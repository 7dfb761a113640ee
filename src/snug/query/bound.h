#pragma once

#include <functional>
#include <optional>

#include <snug/bound.h>
#include <snug/bounds/enclosure.h>
#include <snug/patch/piece_path.h>
#include <snug/surface/curve_set.h>
#include <snug/surface/limit_surface.h>

namespace snug {

/// Enclosures of one piece, in mesh units.
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
  std::optional<NormalCone> normals{};
};
/// Of a limit curve.
struct CurveEnclosure : Enclosure<2> {
  EdgeId edge;
};

/// bound() of bound.h, patches by their names in LimitSurface.
BoundSummary bound(const LimitSurface& surface, const BoundOptions& options,
                   const std::function<void(const PieceEnclosure&)>& sink, const Run& run = {},
                   BoundMethod method = BoundMethod::rows);
/// The same of all limit curves, edge by edge, pieces of one from its first end to its last.
BoundSummary bound(const CurveSet& curves, const BoundOptions& options,
                   const std::function<void(const CurveEnclosure&)>& sink, const Run& run = {});

/// limit_to_faces() of evaluate.h.
[[nodiscard]] std::optional<double> limit_to_faces(const LimitSurface& surface, int threads = 0);

}  // namespace snug
