#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <vector>

#include <snug/bvh/frame.h>
#include <snug/bvh/obb.h>
#include <snug/search/piece.h>

namespace snug {

/// Sorts of convex sets that trees can be made of: boxes along the coordinate axes, boxes with axes of their
/// own, and k-DOPs.
enum class Volume : std::uint8_t { aabb, obb, dop14, dop18, dop26 };
inline constexpr std::array all_volumes{Volume::aabb, Volume::obb, Volume::dop14, Volume::dop18,
                                        Volume::dop26};
[[nodiscard]] const char* name_of(Volume volume);

/// Half of the directions of a k-DOP's facets; none for obb.
[[nodiscard]] std::span<const Vector3> directions_of(Volume volume);

/// A set of any sort. obb: the box. Others: the extents along directions_of().
struct BoundingVolume {
  Obb box;
  std::array<Extent, 13> extents{};
};

/// A volume around a set; `spread`: points like it, from which axes are chosen.
/// Guarantee: contains the set if extent() bounds it.
[[nodiscard]] BoundingVolume fit(Volume volume, std::span<const Point3> spread,
                                 const std::function<Extent(const Vector3&)>& extent);
/// A volume around volumes of the same sort.
/// Requires:  at least one.
[[nodiscard]] BoundingVolume merge(Volume volume, std::span<const BoundingVolume> parts);
[[nodiscard]] Ball ball_around(Volume volume, const BoundingVolume& set);

/// How volumes of one sort are seen from another frame.
struct VolumeView {
  RelativeFrame frame;
  /// Every direction of the frame as a sum of three of the set's own with weights of either sign: k-DOPs
  /// alone.
  struct Sum {
    std::array<std::uint8_t, 3> place;
    std::array<double, 3> weight;
  };
  std::vector<Sum> sums;

  VolumeView(Volume volume, const PlacedFrame& target, const PlacedFrame& source);
};

/// Lower bound of the distance from a set to another one seen through `view`, in units of the target; zero or
/// negative where no gap shows. Minus infinity where something is not finite.
/// Requires:  view.frame.comparable; coordinates of at most about 4.
[[nodiscard]] double gap(Volume volume, const BoundingVolume& set, const BoundingVolume& other,
                         const VolumeView& view);

/// A tree of volumes of one sort over a surface, eight children a node, and over its pieces where a walk came
/// near them. Compares sorts of volumes in one plain walk, a pair at a time in double.
class KdopTree {
 public:
  /// Requires:  the surface outlives the tree, and has a patch.
  KdopTree(const LimitSurface& surface, Volume volume);

  struct Answer {
    bool separated = false;            ///< proved
    bool within = false;               ///< two limit points are at most the tolerance apart
    std::uint64_t volume_tests = 0;    ///< of pairs of volumes
    std::uint64_t triangle_tests = 0;  ///< of pairs of base triangles
  };
  /// Do two placed surfaces touch, up to a tolerance? Neither is said where rounding hides it.
  /// Requires:  trees of the same sort; coordinates of at most about 4 in mesh units.
  [[nodiscard]] static Answer compare(KdopTree& a, const Motion& place_a, KdopTree& b, const Motion& place_b,
                                      double tolerance);

 private:
  friend class KdopWalk;
  struct Node {
    BoundingVolume set;
    double size;
    std::uint32_t first = 0, count = 0;  // of its children in nodes_, or patches of a leaf that is not opened
    bool opened = true;
    const Piece* piece = nullptr;  // none in the tree itself
  };
  [[nodiscard]] Node make_node(const BoundingVolume& set) const;
  void build(std::size_t node, std::size_t begin, std::size_t end);
  void open(std::size_t node);
  void add_piece(Piece piece);

  const LimitSurface& surface_;
  Volume volume_;
  std::deque<Piece> pieces_;
  HullPoints scratch_;
  std::vector<PatchId> patches_;
  std::vector<Node> nodes_;
};

}  // namespace snug
