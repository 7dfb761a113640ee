#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <snug/surface/limit_surface.h>

namespace snug {

/// The patches of a surface whose control points all go along lines, each at a constant speed, for one unit of
/// time: a tree of boxes around where they are at both ends, and around their velocities.
/// Cost:      a microsecond and 200 bytes an owner of patches.
/// Source:    derivations/time_of_contact.md, "Control points that move".
class LinearPatches {
 public:
  /// `start`, `end`: around the place of each vertex at time 0 and at time 1.
  /// Requires:  one patch or more; finite boxes, of vertices that faces use.
  LinearPatches(const LimitSurface& surface, std::span<const Box3> start, std::span<const Box3> end);

  /// Upper bound of the speed against each other of any two limit points, one of each, that are within `margin` of each
  /// other at some time in [from, to]; nothing if no two are.
  [[nodiscard]] static std::optional<double> meeting_speed(const LinearPatches& a, const LinearPatches& b,
                                                           double from, double to, double margin = 0);

 private:
  struct Node {
    Box3 start, end;
    Box3 velocity;            // as points
    std::uint32_t child = 0;  // the first of two; none for the patches of one owner
  };
  [[nodiscard]] static bool may_meet(const Node& a, const Node& b, double from, double to, double margin);
  [[nodiscard]] static double speed(const Node& a, const Node& b);
  void split(std::uint32_t node, std::span<Node> leaves);

  std::vector<Node> nodes_;
};

}  // namespace snug
