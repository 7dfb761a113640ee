#pragma once

#include <array>
#include <cstdint>

#include <snug/surface/limit_surface.h>

namespace snug {

/// A side of a root patch, from one of its corners to the next. Equal parts of equal numbers are one limit
/// curve, and a whole edge is made of its halves.
struct PatchSide {
  enum class Part : std::uint8_t {
    whole,        ///< of an edge of the mesh, or the line between the faces beside it in a dual scheme
    first_half,   ///< likewise, to its middle
    second_half,  ///< from there
    inside,       ///< a line inside an owner
  };
  Part part;
  std::uint32_t number;  ///< EdgeId, or of a line inside below patch_count()
  bool reversed;         ///< the side runs against the curve's own direction, see ends_of()
};

/// The sides of a patch: from corner 0 to 1, 1 to 2, 2 to 0.
/// Requires:  surface.has_patch(p).
[[nodiscard]] std::array<PatchSide, 3> sides_of(const LimitSurface& surface, PatchId p);

/// Corner names (LimitSurface::corner_names) where the curve of a whole edge begins, of its middle where it has
/// one, and where it ends.
/// Requires:  an edge that a patch has on its sides.
[[nodiscard]] std::array<std::uint32_t, 3> ends_of(const LimitSurface& surface, EdgeId edge);

}  // namespace snug
