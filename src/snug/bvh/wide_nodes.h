#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <snug/bvh/frame.h>
#include <snug/bvh/node_kernels.h>
#include <snug/bvh/obb.h>

namespace snug {

/// One of the boxes in a wide node.
struct Child {
  std::uint32_t parent = 0;
  std::uint32_t place = 0;
};

/// How boxes are seen from another frame.
struct View {
  RelativeFrame frame;
  kernels::SeenNode seen{};  // but for its offset

  View() = default;
  View(const PlacedFrame& target, const PlacedFrame& source);
  /// Gaps of pairs of nodes are looked for along this direction first, from the target to the source.
  void look_along(const Vector3& direction);
};

/// A box as seen from another frame, ready to be compared with nodes there.
struct PlacedBox {
  Point3 centre;
  kernels::OtherBox box;  // but for its centre
};

/// Nodes of up to eight boxes, in single precision relative to an origin of their own, so that all eight are
/// compared with another box at once and small ones lose nothing far from the coordinates' origin.
/// Guarantee: rounding to single precision never makes boxes smaller. The same bits on every instruction set.
class WideNodes {
 public:
  static constexpr std::size_t width = kernels::node_width;
  using Distances = std::array<float, width>;
  using Near = kernels::Near;
  using Pairs = kernels::NearPairs;

  [[nodiscard]] std::size_t size() const { return heads_.size(); }
  [[nodiscard]] std::size_t bytes() const;
  void clear();

  /// Adds a node of 1 to 8 boxes and returns its number. `names`: what the owner calls them.
  /// Requires:  coordinates at most about 4, sizes that are not finite allowed.
  std::uint32_t add(std::span<const Obb> boxes, std::span<const std::uint32_t> names);

  [[nodiscard]] std::size_t count(std::uint32_t node) const { return heads_[node].count; }
  [[nodiscard]] std::uint32_t name(Child at) const { return heads_[at.parent].names[at.place]; }
  /// Upper bound of the distance of two points of the box, for choosing which one to open.
  [[nodiscard]] float size_of(Child at) const { return heads_[at.parent].sizes[at.place]; }

  /// The box as seen from another frame.
  /// Requires:  view.frame.comparable.
  [[nodiscard]] PlacedBox placed(Child at, const View& view) const;

  /// Lower bounds of the distances from the boxes of a node to a box placed in the node's frame, in its
  /// units; zero or negative where no gap shows, the more negative the deeper they overlap. Wider gaps than
  /// `prune_distance` are not looked for where one is found. Returns the boxes with at most that, one bit
  /// each, and the least gap of the others.
  /// Guarantee: at most the exact distance less `slack` where positive; -infinity if one is not finite.
  /// Source:    derivations/boxes.md; [Gottschalk96] for the axes.
  Near distances(std::uint32_t node, const PlacedBox& other, double slack, float prune_distance,
                 Distances& out) const;
  /// The same of all boxes of two nodes, the other one seen through `view`, which is comparable. `out`: the
  /// pairs with at most `prune_distance`. Returns the least gap of the others; infinite if there are none.
  float distances(std::uint32_t node, const WideNodes& others, std::uint32_t other, const View& view,
                  float prune_distance, Pairs& out) const;
  /// The same to a point.
  void distances(std::uint32_t node, const Point3& point, double slack, Distances& out) const;

 private:
  static constexpr std::size_t stride = kernels::obb_rows * width;  // numbers a node

  struct Head {
    Point3 origin;
    std::array<std::uint32_t, width> names;
    std::array<float, width> sizes;
    std::uint32_t count;
    float reach;  // of the largest, see kernels
  };
  [[nodiscard]] kernels::BoxNode boxes(std::uint32_t node) const {
    const Head& head = heads_[node];
    return {data(node), head.sizes.data(), head.count, head.reach};
  }
  [[nodiscard]] const float* data(std::uint32_t node) const { return data_.data() + node * stride; }

  std::vector<Head> heads_;
  std::vector<float> data_;
};

}  // namespace snug
