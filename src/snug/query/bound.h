#pragma once

#include <functional>
#include <optional>

#include <snug/bound.h>
#include <snug/bounds/enclosure.h>
#include <snug/patch/piece_path.h>
#include <snug/surface/limit_surface.h>

namespace snug {

/// Enclosures of one piece of a surface or of a curve, in mesh units.
template <std::size_t N>
struct Enclosure {
  PiecePath path;
  std::array<Point3, N> corners;  ///< limit corners, in double precision
  OffsetSimplex<N> offset;
  IntervalSimplex<N> interval;
};
struct PieceEnclosure : Enclosure<3> {
  PatchId patch;
  std::optional<NormalCone> normals{};
};

/// bound() of bound.h, patches by their names in LimitSurface.
BoundSummary bound(const LimitSurface& surface, const BoundOptions& options,
                   const std::function<void(const PieceEnclosure&)>& sink, const Run& run = {},
                   BoundMethod method = BoundMethod::rows);

/// limit_to_faces() of evaluate.h.
[[nodiscard]] std::optional<double> limit_to_faces(const LimitSurface& surface, int threads = 0);

}  // namespace snug
