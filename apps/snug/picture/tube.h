#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <picture/scene.h>

namespace snug {

/// A round tube of triangles along a chain of points, closed if its last point is its first. Its ends are
/// round, and so is it where the chain turns sharply. A chain that stays at one place is a ball.
///
/// Guarantee: every corner is as far as the radius from a point of the chain, up to rounding.
/// Requires:  at least one point, all finite; radius > 0.
class Tube {
 public:
  /// Points closer to the last one than a fiftieth of the radius are left out.
  Tube(std::span<const Point3> chain, double radius);

  /// Of add_to().
  [[nodiscard]] std::size_t triangle_count(unsigned sides) const;
  /// Adds its triangles to the scene.
  /// Requires:  sides >= 5.
  void add_to(PictureScene& scene, unsigned sides, std::uint32_t material) const;
  /// Adds points whose hull contains the tube, whatever its number of sides.
  void add_outline(std::vector<Point3>& points) const;

 private:
  [[nodiscard]] std::size_t chord_count() const { return directions_.size(); }
  // Does a ball stand at this point, rather than a ring that two chords share?
  [[nodiscard]] bool has_ball(std::size_t point, unsigned sides) const;

  double radius_;
  bool closed_ = false;
  std::vector<Point3> points_;
  std::vector<Vector3> directions_;  // of the chord that begins at each point
};

}  // namespace snug
