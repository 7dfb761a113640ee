#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <snug/geometry/rounding.h>
#include <snug/query/moving_body.h>
#include <snug/query/swept_pairs.h>
#include <snug/search/precision.h>

namespace snug {

/// Two surfaces at one time as doubles, with how far these are from the exact places where the surfaces may meet.
struct PlacesInTime {
  PlacedBvh a, b;
  [[nodiscard]] double doubt() const { return a.deviation + b.deviation; }
};

/// Two surfaces during one piece of their motions after the other.
class MovingPair {
 public:
  MovingPair(const MovingBvh& a, const MovingBvh& b) : bodies_{MovingBody(a), MovingBody(b)} {}

  void enter_piece(std::size_t piece) {
    begin_ = static_cast<double>(piece);
    for (MovingBody& body : bodies_) body.enter_piece(piece);
  }
  /// Time at which the piece begins.
  [[nodiscard]] double begin() const { return begin_; }
  [[nodiscard]] double duration() const { return std::max(bodies_[0].duration(), bodies_[1].duration()); }
  [[nodiscard]] bool deforms() const { return bodies_[0].deforms() || bodies_[1].deforms(); }
  [[nodiscard]] double size() const {
    return share_of_size(1, bodies_[0].model().surface().size(), bodies_[1].model().surface().size());
  }
  [[nodiscard]] MovingBody& operator[](std::size_t side) { return bodies_[side]; }

  /// Upper bound of the speed of any two points against each other during the piece.
  [[nodiscard]] double speed() {
    MovingBody &a = bodies_[0], &b = bodies_[1];
    const double most = enlarged(a.speed() + b.speed());
    if (deforms() || !a.piece().straight() || !b.piece().straight()) return most;
    return std::min(most, PieceMotion::relative_speed(a.piece(), a.model(), b.piece(), b.model()));
  }

  /// At a time of the piece; until the next call.
  [[nodiscard]] PlacesInTime at(double time) {
    const double s = time - begin_;  // exact: both are at most a factor of 2 apart, or begin_ is 0
    const MovingBody::Place a = bodies_[0].at(s), b = bodies_[1].at(s);
    const Ball &ball_a = a.shape.model.ball(), &ball_b = b.shape.model.ball();
    // A common point is at most so far from the origin of either surface, and so are all its own.
    const double between = distance(a.pose.pose.apply(ball_a.centre), b.pose.pose.apply(ball_b.centre));
    const double beyond = 2 * (between + ball_a.radius + ball_b.radius + a.shape.error + b.shape.error);
    const double reach_a = enlarged(max_abs(ball_a.centre - Point3{}) + ball_a.radius + beyond),
                 reach_b = enlarged(max_abs(ball_b.centre - Point3{}) + ball_b.radius + beyond);
    return {{a.shape.model, a.shape.scratch, a.pose.pose, a.deviation(reach_a)},
            {b.shape.model, b.shape.scratch, b.pose.pose, b.deviation(reach_b)}};
  }
  [[nodiscard]] SweptBody swept(std::size_t side) const {
    return {bodies_[side].model(), bodies_[side].scratch(), bodies_[side].piece()};
  }

 private:
  std::array<MovingBody, 2> bodies_;
  double begin_ = 0;
};

/// Errors:    InputError (value) unless both motions last equally long, or one stays.
void require_same_duration(const MovingBvh& a, const MovingBvh& b);

}  // namespace snug
