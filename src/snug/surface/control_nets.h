#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <snug/surface/control_hull.h>

namespace snug {

/// Many sets of patches, each known by its control points as a ControlHull, whose lists are kept so that boxes
/// are soon made anew when the points have moved.
/// Cost:      some 80 bytes a patch; a box some 20 nanoseconds a patch.
class ControlNets {
 public:
  /// Appends a set.
  void add(const ControlHull& hull);

  [[nodiscard]] std::size_t count() const { return begins_.size() - 1; }
  /// The corners of the faces of a set's patches.
  [[nodiscard]] std::span<const VertexId> corners(std::size_t net) const;

  struct Fit {
    Obb box;
    double patch_sizes = 0;  ///< sum of the squared diagonals of boxes around each patch's corners; not exact
  };
  /// A box around a set, along given axes.
  /// Guarantee: contains the patches, rounding included, as ControlHull does.
  /// Requires:  the same connectivity; axes orthonormal up to a few roundings; points in scaled units.
  [[nodiscard]] Fit fit(std::size_t net, const LimitSurface& surface, const Axes& axes) const;
  [[nodiscard]] std::size_t bytes() const;

 private:
  // Where the lists of a set begin.
  struct Begin {
    std::size_t vertices = 0, corners = 0, rings = 0, places = 0, patches = 0;
  };
  std::vector<Begin> begins_{Begin{}};
  // As a ControlHull has them, one set behind the other; numbers and ends count from the set's own begin.
  std::vector<VertexId> vertices_;
  std::vector<std::uint32_t> rings_, ring_ends_, patch_, patch_ends_;
  std::vector<double> weights_;
};

}  // namespace snug
