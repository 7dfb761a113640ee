#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <snug/bvh/block_kernels.h>
#include <snug/bvh/frame.h>
#include <snug/bvh/volume.h>

namespace snug {

/// One of the sets in a block.
struct Lane {
  std::uint32_t block = 0;
  std::uint32_t lane = 0;
};

/// How sets of one sort are seen from another frame.
struct View {
  RelativeFrame frame;
  /// Every direction of the frame as a sum of at most three of the set's own with weights of either sign: polytopes alone.
  struct Sum {
    std::array<std::uint8_t, 3> place;
    std::array<double, 3> weight;
  };
  std::vector<Sum> sums;
  kernels::SeenBlock seen{};  // obb, but for its offset

  View() = default;
  View(Volume volume, const PlacedFrame& target, const PlacedFrame& source);
  /// Gaps of pairs of blocks are looked for along this direction first, from the target's sets to the source's.
  void look_along(const Vector3& direction);
};

/// A set as seen from another frame, ready to be compared with blocks there.
struct PlacedVolume {
  Point3 centre;
  kernels::OtherBox box;                            // obb, but for its centre
  std::array<double, max_directions> lower, upper;  // others, relative to the centre
};

/// Blocks of up to eight sets of one sort, in single precision relative to an origin of their own, so that all eight are
/// compared with another set at once and small ones lose nothing far from the coordinates' origin.
///
/// Guarantee: rounding to single precision makes sets larger, never smaller. Distances are the same, bit by bit, on every
///            instruction set.
class Blocks {
 public:
  static constexpr std::size_t lanes = 8;
  using Distances = std::array<float, lanes>;
  using Near = kernels::Near;

  explicit Blocks(Volume volume);
  [[nodiscard]] Volume volume() const { return volume_; }
  [[nodiscard]] std::size_t size() const { return heads_.size(); }
  [[nodiscard]] std::size_t bytes() const;
  void clear();

  /// Adds a block of 1 to 8 sets and returns its number. `names`: what the owner calls them.
  /// Requires:  sets of this sort, coordinates at most about 4, radii or sizes that are not finite allowed.
  std::uint32_t add(std::span<const BoundingVolume> sets, std::span<const std::uint32_t> names);

  [[nodiscard]] std::size_t count(std::uint32_t block) const { return heads_[block].count; }
  [[nodiscard]] std::uint32_t name(Lane at) const { return heads_[at.block].names[at.lane]; }
  void rename(Lane at, std::uint32_t name) { heads_[at.block].names[at.lane] = name; }
  /// Upper bound of the distance of two points of the set, for choosing which one to open.
  [[nodiscard]] float size_of(Lane at) const { return heads_[at.block].sizes[at.lane]; }

  /// The set as seen from another frame.
  /// Requires:  view.frame.comparable.
  void placed(Lane at, const View& view, PlacedVolume& out) const;

  /// Lower bounds of the distances from the sets of a block to a set placed in the block's frame; zero or negative where no
  /// gap shows, the more negative the deeper they overlap. In units of the frame.
  ///
  /// `enough`: wider gaps than this are not looked for where one is found.
  /// Returns:   the lanes with at most `enough`, one bit each, and the least gap of the others; infinite if there are none.
  /// Guarantee: at most the exact distance where positive; `slack` is taken off. Where anything is not finite: minus
  ///            infinity.
  /// Source:    derivations/boxes.md; [Gottschalk96] for the axes.
  Near distances(std::uint32_t block, const PlacedVolume& other, double slack, float enough,
                 Distances& out) const;
  /// The same of all sets of two blocks, the other one seen through `view`. `out`: the pairs with at most `enough`.
  /// Returns:   the least gap of the others; infinite if there are none.
  /// Requires:  view.frame.comparable.
  struct Pairs {
    std::array<kernels::LanePair, lanes * lanes> pairs;
    std::size_t count = 0;
  };
  float distances(std::uint32_t block, const Blocks& others, std::uint32_t other, const View& view,
                  float enough, Pairs& out) const;
  /// The same to a point.
  void distances(std::uint32_t block, const Point3& point, double slack, Distances& out) const;

 private:
  struct Head {
    Point3 origin;
    std::array<std::uint32_t, lanes> names;
    std::array<float, lanes> sizes;
    std::uint32_t count;
    float reach;  // obb: of the largest, see kernels
  };
  [[nodiscard]] kernels::BoxBlock boxes(std::uint32_t block) const {
    const Head& head = heads_[block];
    return {data(block), head.sizes.data(), head.count, head.reach};
  }
  [[nodiscard]] const float* data(std::uint32_t block) const { return data_.data() + block * stride_; }

  Volume volume_;
  std::span<const std::uint8_t> directions_;
  std::size_t stride_;  // numbers a block
  std::vector<Head> heads_;
  std::vector<float> data_;
};

}  // namespace snug
