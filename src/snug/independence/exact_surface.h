#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <snug/independence/weight.h>
#include <snug/run.h>
#include <snug/scheme/creases.h>

namespace snug {

/// All patches of equal connectivity and sharpness: what their function depends on, exactly.
struct ExactKind {
  std::uint32_t control_count = 0;
  /// Of a regular patch: it is 0 if and only if these integer combinations of its control values are.
  std::vector<std::vector<std::pair<std::uint32_t, int>>> functionals;
  struct Child {
    std::uint32_t kind;
    std::vector<WeightRow> rows;  ///< its control values from those of the patch
  };
  /// Of others: it is made of these, but for single points.
  std::vector<Child> children;
};

/// Most kinds of a surface; they take up to 100 kilobytes each.
inline constexpr std::size_t max_exact_kinds = 20000;

/// Stands for a control value that is 0.
inline constexpr std::uint32_t no_column = UINT32_MAX;

/// A limit surface as the patches of its owners, and the patches that these split into, each kind once.
struct ExactSurface {
  struct Patch {
    std::uint32_t kind;
    std::vector<std::uint32_t> control;  ///< vertices of the mesh; the same may come twice
  };
  std::uint32_t order;  ///< of weights
  std::vector<ExactKind> kinds;
  std::vector<Patch> patches;
};

/// Takes the mesh apart as LimitSurface does: by patch/neighbourhood.h. Kinds are finitely many, as sharpness decays.
///
/// Requires:  Loop, Catmull-Clark, Doo-Sabin or Midedge; a surface for each owner not in `without_surface`: faces, of dual schemes
///            vertices; a multiple of order_of_masks().
/// Errors:    InputError (refused): more than max_exact_kinds. Interrupted.
/// Cost:      up to a millisecond a kind.
[[nodiscard]] ExactSurface exact_surface(const RuledMesh& mesh, const std::vector<bool>& without_surface,
                                         std::uint32_t order, const WorkMonitor& monitor);

}  // namespace snug
