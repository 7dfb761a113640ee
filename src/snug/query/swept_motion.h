#pragma once

#include <array>
#include <vector>

#include <snug/bvh/wide_node.h>
#include <snug/query/trajectory.h>

namespace snug {

/// A ball in the frame of a surface, in mesh units.
struct OwnBall {
  Point3 centre;
  double radius;
};

/// Upper bounds of how one surface moves during a piece of its motion, of all points of a ball at once: in mesh
/// units and double precision, for the exact motion without what a given end adds.
/// Source:    derivations/time_of_contact.md, "Over an interval of time".
class SweptMotion {
 public:
  SweptMotion() = default;
  explicit SweptMotion(const PieceMotion& motion);

  /// About one axis: not a chain.
  [[nodiscard]] bool turns() const { return rate_ != 0; }
  [[nodiscard]] bool is_chain() const { return !joints_.empty(); }
  [[nodiscard]] double rate() const { return rate_; }
  /// Of the point `about`.
  [[nodiscard]] const Vector3& velocity() const { return velocity_; }
  /// Length of what of a vector is across the axis, for one that is about 1 long.
  [[nodiscard]] double across(const Vector3& v) const;
  /// Of a chain: of what each joint moves.
  struct Moved {
    double speed = 0, acceleration = 0;
  };
  [[nodiscard]] Moved moved(const OwnBall& ball) const;
  /// Velocity of a point of the ball against velocity().
  [[nodiscard]] double lever(const OwnBall& ball) const;
  /// That part of all velocities that is along the axis and not in velocity(), and the same of accelerations.
  [[nodiscard]] double rise() const { return rise_; }
  /// Velocity against velocity() of what moves with the surface and is within `radius` of a point of the world
  /// at s.
  [[nodiscard]] double lever_at(const Point3& place, double radius, double s) const;

 private:
  Motion from_;
  Vector3 axis_{0, 0, 1};
  double rate_ = 0;
  Vector3 about_, velocity_, turning_;  // about_ as a vector
  double rise_ = 0;
  struct Joint {
    double turns, slides;  // in one unit of time
    double outward;        // of the joints before: what they turn by
    double offset,
        across_offset;  // of the next joint's frame, or 0: from the origin of this one, and from its axis
    double slack;       // what a slide of the next one adds
  };
  std::vector<Joint> joints_;
  Motion tip_;
  Vector3 last_axis_;
  double stretch_ = 1;
};

/// Upper bound of |h''(s)| for h(s) = w(s).(y(s) - x(s)) with points x of one surface and y of the other, where
/// w turns with one of them or stays; in a step of time around its middle.
struct SweptHeights {
  std::array<const SweptMotion*, 2> motions;
  std::array<OwnBall, 2> balls;
  std::array<Point3, 2> centres;                  ///< of the balls, placed in the middle of the step
  std::array<double, 2> levers, accelerations{};  ///< these of chains
  double time, half_step;                         ///< the middle of the step, and half of its length

  /// w stays: this is its value, about 1 long, up to `doubt`.
  [[nodiscard]] double bending(const Vector3& w, double doubt) const;
  /// w turns with the surface of that side, and this is its value in the middle.
  [[nodiscard]] double bending(const Vector3& w, double doubt, std::size_t side) const;
};

}  // namespace snug
