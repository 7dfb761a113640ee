#pragma once

#include <array>
#include <vector>

#include <snug/geometry/interval.h>
#include <snug/geometry/motion.h>
#include <snug/search/surface_bvh.h>
#include <snug/time_of_contact.h>

namespace snug {

/// Upper bound of the length of every vector in three intervals.
[[nodiscard]] double length_up(const std::array<Interval, 3>& vector);

/// The most that frames of a chain may stretch lengths by, up to some roundings.
[[nodiscard]] double stretch_of(const Trajectory::Piece& chain);

/// A pose in double precision, and upper bounds of what its numbers differ by from the one that is meant.
struct BoundedPose {
  Motion pose;
  std::array<double, 12> error{};

  /// Upper bound of the distance between the places of a point by this pose and by the one meant.
  /// Requires:  no coordinate of the point is larger than `reach`.
  [[nodiscard]] double deviation(double reach) const;
};

/// A piece of a trajectory, or a pose that stays, with proved bounds.
///
/// Source:    derivations/time_of_contact.md.
class PieceMotion {
 public:
  explicit PieceMotion(const Motion& stays);
  /// Errors:    InputError (unrepresentable) where a pose does not fit doubles; at() and speed() likewise.
  explicit PieceMotion(const Trajectory::Piece& piece);

  /// Requires:  s in [0, 1].
  [[nodiscard]] BoundedPose at(double s) const;
  /// Upper bound of the velocity of any point of the surface, in mesh units for one unit of time.
  [[nodiscard]] double speed(const SurfaceBvh& model) const;
  /// Does it only translate?
  [[nodiscard]] bool straight() const { return piece_.radians == 0 && piece_.chain.empty(); }
  /// And without what a given end may turn it by?
  [[nodiscard]] bool keeps_rotation() const { return straight() && !piece_.ends; }
  /// Upper bound of what its poses may stretch lengths by.
  [[nodiscard]] double growth() const;
  /// Of two that only translate: upper bound of their relative velocity.
  [[nodiscard]] static double relative_speed(const PieceMotion& a, const SurfaceBvh& model_a,
                                             const PieceMotion& b, const SurfaceBvh& model_b);

  [[nodiscard]] const Trajectory::Piece& piece() const { return piece_; }
  /// The unit vector of the axis, up to a few roundings.
  [[nodiscard]] Vector3 axis() const { return {middle(axis_[0]), middle(axis_[1]), middle(axis_[2])}; }
  /// Upper bounds of what `to - S(1)`, with `from - C(0)` for a chain, makes of a vector of length 1, and of how far it takes
  /// a point of a surface.
  [[nodiscard]] double closing_growth() const;
  [[nodiscard]] double closing_speed(const SurfaceBvh& model) const;

 private:
  using Intervals = std::array<Interval, 12>;
  using IntervalVector = std::array<Interval, 3>;
  [[nodiscard]] Intervals screwed(double s) const;
  [[nodiscard]] Intervals chained(double s) const;
  [[nodiscard]] double lever(const SurfaceBvh& model) const;
  [[nodiscard]] double chain_speed(const SurfaceBvh& model) const;
  [[nodiscard]] IntervalVector lever_at(const IntervalVector& point) const;

  Trajectory::Piece piece_;
  bool stays_ = false;
  IntervalVector axis_;               // of length 1
  std::vector<IntervalVector> axes_;  // of a chain's joints, likewise
  Intervals closing_{}, opening_{};   // to - S(1); from - C(0)
};

}  // namespace snug
