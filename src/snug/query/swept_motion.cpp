#include <snug/query/swept_motion.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <support/direction.h>

namespace snug {
namespace {

// More than the roundings of any of these sums, relative to their terms.
constexpr double turn_noise = 0x1p-44;

}  // namespace

SweptMotion::SweptMotion(const PieceMotion& motion) {
  const Trajectory::Piece& piece = motion.piece();
  from_ = piece.from;
  if (!piece.chain.empty()) {
    tip_ = piece.tip;
    stretch_ = enlarged(stretch_of(piece));
    double outward = 0;
    for (const Trajectory::Piece::JointPath& path : piece.chain) {
      const double rate = enlarged(std::fabs(path.to - path.from));
      const Vector3 axis = normalized(path.joint.axis);
      if (!joints_.empty()) {
        Joint& before = joints_.back();
        const Vector3 offset = path.joint.frame.offset();
        before.offset = enlarged(length(offset));
        before.across_offset = enlarged(length(cross(last_axis_, offset)) + turn_noise * before.offset);
        before.slack = path.joint.slides ? std::max(std::fabs(path.from), std::fabs(path.to)) : 0;
      }
      joints_.push_back({path.joint.slides ? 0 : rate, path.joint.slides ? rate : 0, outward, 0, 0, 0});
      if (!path.joint.slides) outward = enlarged(outward + rate);
      last_axis_ = axis;
    }
    return;
  }
  about_ = piece.about - Point3{};
  rate_ = std::fabs(piece.radians);
  if (piece.radians == 0) {
    velocity_ = piece.velocity + piece.turning;
    return;
  }
  // Of the axis as it is given, so that the rotation is counterclockwise.
  axis_ = std::copysign(1.0, piece.radians) * motion.axis();
  velocity_ = piece.velocity;
  turning_ = piece.turning;
  rise_ = enlarged(std::fabs(dot(axis_, turning_)) + turn_noise * length(turning_));
}

double SweptMotion::across(const Vector3& v) const { return length(cross(axis_, v)) + turn_noise; }

SweptMotion::Moved SweptMotion::moved(const OwnBall& ball) const {
  const Vector3 own = ball.centre - Point3{}, t = tip_.offset();
  const Vector3 place = tip_.rotate(own) + t;
  const double noise = turn_noise * (3 * length(own) + length(t)),
               around = enlarged(ball.radius * (1 + 2 * tip_.defect()) + noise);
  // Of the ball in the frame that the joint moves: how far from its origin, and from its axis.
  double from_origin = enlarged(length(place) + around),
         from_axis = enlarged(length(cross(last_axis_, place)) + around);
  Moved result;
  for (std::size_t k = joints_.size(); k-- > 0;) {
    const Joint& joint = joints_[k];
    if (k + 1 < joints_.size()) {
      const double turned = enlarged((from_origin + joint.slack) * stretch_);
      from_origin = enlarged(joint.offset + turned);
      from_axis = std::min(from_origin, enlarged(joint.across_offset + turned));
    }
    result.speed = enlarged(result.speed + joint.turns * from_axis + joint.slides);
    result.acceleration =
        enlarged(result.acceleration + joint.turns * from_axis * (joint.turns + 2 * joint.outward) +
                 2 * joint.slides * joint.outward);
  }
  return {enlarged(result.speed * stretch_), enlarged(result.acceleration * stretch_)};
}

double SweptMotion::lever(const OwnBall& ball) const {
  if (is_chain()) return moved(ball).speed;
  if (rate_ == 0) return 0;
  const Vector3 own = ball.centre - Point3{}, turned = from_.rotate(own), t = from_.offset();
  const Vector3 at = rate_ * cross(axis_, turned + (t - about_)) + turning_;
  const double terms = rate_ * (3 * length(own) + length(t) + length(about_)) + length(turning_);
  return enlarged(length(at) + rate_ * ball.radius * (1 + 2 * from_.defect()) + turn_noise * terms);
}

double SweptMotion::lever_at(const Point3& place, double radius, double s) const {
  const Vector3 arm = (place - Point3{}) - about_ - s * velocity_;
  const Vector3 at = rate_ * cross(axis_, arm) + turning_;
  const double terms =
      rate_ * (length(place - Point3{}) + length(about_) + s * length(velocity_)) + length(turning_);
  return enlarged(length(at) + rate_ * radius + turn_noise * terms);
}

double SweptHeights::bending(const Vector3& w, double doubt) const {
  double sum = 0;
  for (std::size_t s = 0; s < 2; ++s) {
    const SweptMotion& motion = *motions[s];
    if (motion.is_chain()) sum += (1 + 0x1p-20) * accelerations[s];
    if (motion.turns()) sum += motion.rate() * ((motion.across(w) + doubt) * levers[s] + 2 * motion.rise());
  }
  return enlarged(sum);
}

double SweptHeights::bending(const Vector3& w, double doubt, std::size_t side) const {
  const SweptMotion &own = *motions[side], &other = *motions[1 - side];
  const double across = own.across(w) + doubt, turned = own.rate() * across * half_step;
  double sum = 0;
  if (other.turns()) {
    const double seen = std::min(1 + 0x1p-20, other.across(w) + doubt + turned);
    sum += other.rate() * (seen * levers[1 - side] + 2 * other.rise());
  }
  // Of the other's points against what moves with `velocity`.
  const Vector3 against = other.velocity() - own.velocity();
  const double speed = length(against) * (1 + turn_noise) +
                       turn_noise * (length(own.velocity()) + length(other.velocity())) + levers[1 - side] +
                       2 * other.rise();
  const double around = balls[1 - side].radius * (1 + 0x1p-20) + half_step * speed;
  sum += own.rate() * (across * (2 * speed + own.lever_at(centres[1 - side], around, time)) + 2 * own.rise());
  return enlarged(sum);
}

}  // namespace snug
