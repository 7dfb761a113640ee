#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <experiments/printed_hierarchy.h>
#include <snug/bvh/frame.h>
#include <snug/bvh/obb.h>

namespace snug {

/// Sorts of convex sets that trees can be made of: boxes along the coordinate axes, boxes with axes of their
/// own, and k-DOPs.
enum class Volume : std::uint8_t { aabb, dop14, dop18, dop26, obb };
inline constexpr std::array all_volumes{Volume::aabb, Volume::dop14, Volume::dop18, Volume::dop26,
                                        Volume::obb};
[[nodiscard]] const char* name_of(Volume volume);

/// Half of the directions of a k-DOP's facets; none for obb.
[[nodiscard]] std::span<const Vector3> directions_of(Volume volume);

/// How k-DOPs of one sort are seen from another frame.
struct VolumeView {
  RelativeFrame frame;
  /// Every direction of the frame as a sum of three of the set's own with weights of either sign.
  struct Sum {
    std::array<std::uint8_t, 3> place;
    std::array<double, 3> weight;
  };
  std::vector<Sum> sums;

  VolumeView(Volume volume, const PlacedFrame& target, const PlacedFrame& source);
};

/// Lower bound of the distance from a k-DOP to another one seen through `view`, in units of the target; zero
/// or negative where no gap shows. Minus infinity where something is not finite.
/// Requires:  extents along directions_of(volume), no NaN; view.frame.comparable; coordinates of at most about 4.
[[nodiscard]] double gap(Volume volume, std::span<const Extent> set, std::span<const Extent> other,
                         const VolumeView& view);
/// The same of oriented boxes.
[[nodiscard]] double gap(const Obb& box, const Obb& other, const RelativeFrame& frame);

/// How k-DOPs of the second model follow its rotation: those that a walk meets are bounded by k-DOPs
/// along the axes of the first, or all are fitted again to the turned leaves. Oriented boxes turn with it.
enum class Turning : std::uint8_t { bounded, refitted };
[[nodiscard]] const char* name_of(Turning turning);

/// Volumes of one sort around the nodes of a hierarchy.
///
/// Source:    [Klosowski98] for what turns; [Wu05, sec. 1.3, 5.1.2, 5.1.3].
class VolumeTree {
 public:
  /// Requires:  the hierarchy outlives the tree.
  VolumeTree(const PrintedHierarchy& hierarchy, Volume volume);

  /// Of the volumes alone: what links nodes is the same for all sorts.
  [[nodiscard]] std::size_t bytes() const;

  /// The volumes of all nodes fitted to the leaves as they are seen in another frame: node by node, extents
  /// along directions_of().
  /// Guarantee: contains the image, under the very doubles of the frame, of each node's offset triangles.
  /// Requires:  k-DOPs; frame.scale is 1.
  void refit(const RelativeFrame& frame, std::vector<Extent>& extents) const;

  struct Answer {
    bool separated = false;            ///< proved; else a pair of leaves is not apart
    std::uint64_t volume_tests = 0;    ///< of pairs of volumes
    std::uint64_t triangle_tests = 0;  ///< of pairs of offset triangles
  };
  /// Is each leaf of one apart from each leaf of the other?
  /// Guarantee: the same answer for all sorts and turnings, but for pairs that are apart by a rounding.
  /// Requires:  trees of the same sort; coordinates of at most about 4.
  [[nodiscard]] static Answer compare(const VolumeTree& a, const Motion& place_a, const VolumeTree& b,
                                      const Motion& place_b, Turning turning);

 private:
  [[nodiscard]] std::span<const Extent> extents(std::size_t node) const;

  const PrintedHierarchy& hierarchy_;
  Volume volume_;
  std::vector<Extent> extents_;
  std::vector<Obb> boxes_;
};

/// Is an offset triangle certainly apart from another one? Snug's own rule.
[[nodiscard]] bool leaves_apart(const OffsetTriangle& a, const PlacedFrame& frame_a, const OffsetTriangle& b,
                                const PlacedFrame& frame_b);
/// A motion of a model in mesh units as a frame.
[[nodiscard]] PlacedFrame frame_of(const Motion& motion);

}  // namespace snug
