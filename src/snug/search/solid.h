#pragma once

#include <memory>
#include <vector>

#include <snug/bvh/wide_bvh.h>
#include <snug/geometry/triangle.h>
#include <snug/surface/limit_surface.h>

namespace snug {

/// What a closed limit surface needs to be asked about inside and outside. Immutable; may be read by many threads.
///
/// The solid that a closed surface bounds is the surface with all points around which it winds.
///
/// Source:    derivations/contact.md, "Inside or outside of a closed surface".
class Solid {
 public:
  /// Requires:  the surface outlives it.
  /// Errors:    InputError (refused), naming an edge or a face, unless every edge of the surface's mesh has two faces that
  ///            run along it in opposite directions, and all have a limit surface.
  /// Cost:      linear in the edges; some microseconds for each edge between an owner that a first split makes quads of and
  ///            one that it does not.
  explicit Solid(const LimitSurface& surface);

  /// The triangle (a, b, m) over an edge from a to b whose middle m belongs to the first split of one side alone. Exact
  /// limit points are within `error`, a length, of its corners.
  struct Filler {
    Triangle corners;
    double error;
  };
  [[nodiscard]] const std::vector<Filler>& fillers() const { return fillers_; }
  /// Over the fillers; null if there are none.
  [[nodiscard]] const WideBvh* filler_tree() const { return tree_.get(); }
  /// A patch of each connected component.
  [[nodiscard]] const std::vector<PatchId>& components() const { return components_; }

 private:
  std::vector<Filler> fillers_;
  std::unique_ptr<WideBvh> tree_;
  std::vector<PatchId> components_;
};

}  // namespace snug
