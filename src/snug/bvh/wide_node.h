#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <snug/bvh/frame.h>
#include <snug/bvh/node_kernels.h>
#include <snug/bvh/obb.h>
#include <snug/bvh/walk_kernel.h>

namespace snug {

/// How boxes are seen from another frame.
struct View {
  RelativeFrame frame;
  kernels::Turn turn{};           ///< frame.rows in single precision
  float slack = 0, to_world = 1;  ///< those of the frame

  View() = default;
  explicit View(const RelativeFrame& frame);
  /// Gaps are looked for along this direction of the target, from the target to the source.
  void look_along(const Vector3& direction);
};

/// How a whole tree is seen, so that a walk places its nodes in single precision.
/// Source:    derivations/boxes.md, "A walk in single precision".
struct TreeView : kernels::TreeView {
  TreeView() = default;
  /// Requires:  frame.comparable, and that of the opposite direction: scales that differ by less than 2^20.
  explicit TreeView(const RelativeFrame& frame);
  /// About what gaps are lowered by, in units of the target, for trees of this size.
  [[nodiscard]] float doubt(float size) const;
};

/// A box in the frame of the nodes that it is compared with.
struct PlacedBox {
  Point3 centre;
  kernels::OtherBox box;  // but for its centre
};

/// Up to eight boxes, in single precision relative to an origin of their own, so that all eight are compared
/// with another box at once and small ones lose nothing far from the coordinates' origin.
/// Guarantee: rounding to single precision never makes boxes smaller. The same bits on every instruction set.
class WideNode : public kernels::NodeBoxes {
 public:
  static constexpr std::size_t width = kernels::node_width;
  using Distances = std::array<float, width>;
  using Near = kernels::Near;
  using Gaps = kernels::Gaps;

  /// No boxes.
  WideNode() = default;
  /// Requires:  1 to 8 boxes, coordinates at most about 4, sizes that are not finite allowed; as many names, or none where
  ///            no tree needs them.
  explicit WideNode(std::span<const Obb> boxes, std::span<const std::uint32_t> of_boxes = {});

  [[nodiscard]] std::size_t count() const { return box_count; }
  [[nodiscard]] Point3 origin() const { return {reference[0], reference[1], reference[2]}; }
  /// Upper bound of the distance of two points of a box, for choosing which one to open.
  [[nodiscard]] float size_of(std::size_t place) const { return sizes[place]; }
  /// A box as it is kept, read in double: what it bounds is among all centre + sum of s_k half_k axis_k with |s_k| <= 1,
  /// up to one rounding of the origin. Its axes are orthonormal up to a few roundings of single precision.
  [[nodiscard]] Obb box(std::size_t place) const;

  /// Lower bounds of the distances from the boxes to one of another node, which is seen through `view`, in
  /// units of the target; zero or negative where no gap shows, the more negative the deeper they overlap.
  /// Wider gaps than `prune_distance` are not looked for where one is found. Returns the boxes with at most
  /// that, one bit each, and the least gap of the others.
  /// Guarantee: at most the exact distance of what is placed, as RelativeFrame says; -infinity if one is not
  ///            finite.
  /// Requires:  view.frame.comparable.
  /// Source:    derivations/boxes.md; [Gottschalk96] for the axes.
  Near distances(const WideNode& other, std::size_t place, const View& view, float prune_distance, Gaps which,
                 Distances& out) const;
  /// The same to a box in this node's frame, less `slack`.
  Near distances(const PlacedBox& other, double slack, float prune_distance, Distances& out) const;
  /// The same to a point.
  Near distances(const Point3& point, double slack, float prune_distance, Distances& out) const;
  void distances(const Point3& point, double slack, Distances& out) const {
    static_cast<void>(distances(point, slack, INFINITY, out));
  }
  /// Upper bounds of dot(direction, x - origin()) over the boxes.
  /// Requires:  |direction| about 1.
  void extents(const Vector3& direction, Distances& out) const;
};

// Walks step through nodes by their boxes.
static_assert(sizeof(WideNode) == sizeof(kernels::NodeBoxes));

}  // namespace snug
