#pragma once

#include <oracle/contact_twin.h>
#include <oracle/twin_mesh.h>

#include <cstdint>
#include <optional>
#include <vector>

/// Trees of sub-patches of a limit surface, and the search for distances that they share. Internal to the
/// twins.
namespace oracle::detail {

constexpr std::uint32_t kNoPatch = UINT32_MAX;

struct TreePatch {
  std::uint32_t kind = kNoPatch;
  std::uint32_t net = 0;                        // the first of its control points
  std::uint32_t hull = 0, hull_count = 0;       // points whose convex hull contains the limit patch
  std::uint32_t corners = 0, corner_count = 0;  // limit points on it
  double corner_error = 0;                      // how far these are off beyond rounding, as vectors
  std::uint32_t first_child = kNoPatch, child_count = 4;
  std::uint32_t face = 0, level = 0;
  Point centre{};
  double radius = 0;  // of a ball around the hull
};

/// Patches are split when a search asks for it, and kept.
class PatchTree {
 public:
  virtual ~PatchTree() = default;
  std::vector<Point> points;
  std::vector<TreePatch> patches;
  std::size_t root_count = 0, root_points = 0;
  double largest = 0;  // coordinate of the net
  std::uint32_t deepest = 0;

  /// First of the children, which are made if need be.
  std::uint32_t split(std::uint32_t index) {
    if (patches[index].first_child == kNoPatch) {
      const auto first = static_cast<std::uint32_t>(patches.size());
      make_children(index);
      patches[index].first_child = first;
    }
    return patches[index].first_child;
  }
  /// Forgets all but the roots if there are more patches, or points, than that.
  void trim(std::size_t max_patches, std::size_t max_points);
  /// How far points of a net of this level are off, as vectors.
  [[nodiscard]] virtual double error(std::uint32_t level) const = 0;

 protected:
  /// Appends the children of a patch and sets its child_count.
  virtual void make_children(std::uint32_t index) = 0;
  /// Sets the ball of a patch from its hull, and appends it.
  void append(TreePatch patch);
};

/// The segment from p to q; a point if they are the same.
class SegmentTree final : public PatchTree {
 public:
  SegmentTree(const Point& p, const Point& q);
  [[nodiscard]] double error(std::uint32_t) const override { return 0; }

 private:
  void make_children(std::uint32_t) override {}
};

/// See contact_twin.h. `face_a` confines A to the patches of a face.
[[nodiscard]] ContactBounds tree_bounds(PatchTree& a, const Placement& place_a, PatchTree& b,
                                        const Placement& place_b, const ContactGoal& goal,
                                        std::optional<std::uint32_t> face_a = {});
/// Bounds of the distance of a point, which is exact and as near as a translation is.
[[nodiscard]] ContactBounds tree_distance_to(PatchTree& tree, const Placement& placement, const Point& point,
                                             const ContactGoal& goal, std::optional<std::uint32_t> face = {});

}  // namespace oracle::detail
