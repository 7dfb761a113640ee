#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <snug/bvh/wide_bvh.h>
#include <snug/search/piece.h>

namespace snug {

/// A patch of each connected component: of patches with limit points of corners in common.
[[nodiscard]] std::vector<PatchId> component_patches(const LimitSurface& surface);

/// Does a surface bound a solid? So it does if along every edge of its mesh as many faces run one way as the
/// other, and all faces have a limit surface. The mesh need not be manifold.
/// Source:    derivations/contact.md, "Inside or outside of a closed surface".
[[nodiscard]] bool is_closed(const LimitSurface& surface);

/// Why it does not: names the first edge that does not cancel, and a vertex that lies on it, or a hole. Nothing
/// if it is closed.
[[nodiscard]] std::optional<std::string> open_reason(const LimitSurface& surface);

/// Data for inside tests of a closed limit surface. The solid that it bounds is the surface with all points around
/// which it winds. Immutable; may be read by many threads.
/// Source:    derivations/contact.md, "Inside or outside of a closed surface".
class Solid {
 public:
  /// Errors:    InputError (refused) where open_reason() has one.
  explicit Solid(const LimitSurface& surface);

  /// Triangles (a, b, m) over edges from a to b whose middle m belongs to the first split of one side alone.
  [[nodiscard]] const std::vector<LimitTriangle>& fillers() const { return fillers_; }
  /// Over the fillers; null if there are none.
  [[nodiscard]] const WideBvh* filler_tree() const { return tree_.get(); }
  /// Those of component_patches().
  [[nodiscard]] const std::vector<PatchId>& components() const { return components_; }

 private:
  std::vector<LimitTriangle> fillers_;
  std::unique_ptr<WideBvh> tree_;
  std::vector<PatchId> components_;
};

}  // namespace snug
