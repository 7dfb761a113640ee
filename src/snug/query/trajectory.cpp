#include <snug/query/trajectory.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <snug/geometry/angles.h>
#include <snug/geometry/rounding.h>
#include <support/direction.h>
#include <support/error.h>

namespace snug {
namespace {

using Numbers = std::array<double, 12>;
using IntervalVector = std::array<Interval, 3>;

// Half the cosine of poses that are so nearly half a turn apart that neither rotation is the shorter one.
constexpr double half_turn = 1e-8;
// Rotations by less are translations: quotients by them would leave the range.
constexpr double min_angle = 0x1p-500;

IntervalVector intervals(const Vector3& v) { return {v.x, v.y, v.z}; }
IntervalVector operator+(const IntervalVector& a, const IntervalVector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
IntervalVector operator-(const IntervalVector& a, const IntervalVector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
IntervalVector operator*(Interval s, const IntervalVector& a) { return {s * a[0], s * a[1], s * a[2]}; }
Interval dot(const IntervalVector& a, const IntervalVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
IntervalVector cross(const IntervalVector& a, const IntervalVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double largest(Interval a) { return std::max(std::fabs(a.lower), std::fabs(a.upper)); }
IntervalVector rotated(const Motion& m, const IntervalVector& v) {
  return {dot(intervals(m.row(0)), v), dot(intervals(m.row(1)), v), dot(intervals(m.row(2)), v)};
}
IntervalVector unit_of(const Vector3& axis) {
  const IntervalVector given = intervals(axis);
  const Interval size = square_root(dot(given, given));
  return {given[0] / size, given[1] / size, given[2] / size};
}
// By an angle about a unit vector; `rest` is 1 - cosine, with its own digits.
struct Turn {
  Interval sine{0}, cosine{1}, rest{0};
  explicit Turn(Interval angle) {
    if (angle == Interval(0)) return;
    const SineCosine of_angle = sine_cosine(angle);
    const Interval half = sine_cosine(angle / Interval(2)).sine;
    sine = of_angle.sine;
    cosine = of_angle.cosine;
    rest = Interval(2) * (half * half);
  }
  [[nodiscard]] IntervalVector operator()(const IntervalVector& n, const IntervalVector& v) const {
    if (sine == Interval(0) && cosine == Interval(1)) return v;
    return cosine * v + sine * cross(n, v) + (rest * dot(n, v)) * n;
  }
};
// Where a joint is at a time.
Interval position(const Trajectory::Piece::JointPath& path, double s) {
  if (s == 0 || path.from == path.to) return path.from;
  if (s == 1) return path.to;
  return Interval(path.from) + Interval(s) * (Interval(path.to) - Interval(path.from));
}
double rate_of(const Trajectory::Piece::JointPath& path) {
  return largest(Interval(path.to) - Interval(path.from));
}
double farthest_position(const Trajectory::Piece::JointPath& path) {
  return std::max(std::fabs(path.from), std::fabs(path.to));
}

// Upper bound of a convex function over a surface: at a corner of its box, or by its ball and what it changes by with the
// distance of points.
template <class Function>
double farthest(const SurfaceBvh& model, const Function& of, double change) {
  const Ball& ball = model.ball();
  const Obb& box = model.box();
  const double by_ball = enlarged(of(intervals(ball.centre - Point3{})) + change * ball.radius);
  // Axes are orthonormal up to some roundings, which moves a corner by less than this.
  const double more = 0x1p-40 * (box.half.x + box.half.y + box.half.z);
  double by_box = 0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    IntervalVector point = intervals(box.centre - Point3{});
    for (std::size_t k = 0; k < 3; ++k) {
      const double half = enlarged(box.half[k] + more);
      point = point + Interval((corner >> k & 1u) != 0 ? half : -half) * intervals(box.axes[k]);
    }
    by_box = std::max(by_box, of(point));
  }
  return std::min(by_ball, std::isfinite(by_box) ? by_box : INFINITY);
}

// The pose of a chain in double precision.
Motion pose_of_chain(std::span<const ChainJoint> chain, const Motion& tip,
                     std::span<const double> positions) {
  Motion pose;
  for (std::size_t k = 0; k < chain.size(); ++k) {
    const ChainJoint& joint = chain[k];
    pose = pose * joint.frame;
    if (positions[k] == 0) continue;
    const Vector3 axis = PowerOfTwo::normalising(max_abs(joint.axis)).apply(joint.axis);
    pose = pose * (joint.slides ? Motion::translation(positions[k] * normalized(axis))
                                : Motion::rotation(axis, positions[k]));
  }
  return pose * tip;
}

void require_chain(std::span<const ChainJoint> chain, std::span<const std::vector<double>> positions) {
  require_value(!positions.empty(), "trajectory: no positions of the joints; give one list or more");
  for (const ChainJoint& joint : chain) {
    require_value(is_finite(joint.axis) && joint.axis != Vector3{},
                  "trajectory: the axis of a joint has no length or is not finite; give its direction");
  }
  for (const std::vector<double>& list : positions) {
    require_value(
        list.size() == chain.size(),
        "trajectory: positions are not as many as the chain has joints; give one of each in every list");
    for (std::size_t k = 0; k < list.size(); ++k) {
      require_value(std::fabs(list[k]) < (chain[k].slides ? 0x1p1000 : 0x1p30),
                    "trajectory: the position of a joint is not finite or more than 1e8 turns; give less");
    }
  }
}

[[noreturn]] void refuse_motion() {
  throw InputError(
      InputProblem::unrepresentable,
      "trajectory: poses or velocities do not fit doubles; bring meshes and motion to a moderate "
      "scale");
}

// The unit quaternion w, x, y, z of a rotation, w not negative, to some roundings.
std::array<double, 4> quaternion_of(const Rows3& r) {
  const double xx = r[0].x, yy = r[1].y, zz = r[2].z;
  std::array<double, 4> q{1 + xx + yy + zz, 1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz};
  const double wx = r[2].y - r[1].z, wy = r[0].z - r[2].x, wz = r[1].x - r[0].y;
  const double xy = r[0].y + r[1].x, xz = r[0].z + r[2].x, yz = r[1].z + r[2].y;
  const auto k = std::max_element(q.begin(), q.end()) - q.begin();
  if (k == 0) q = {q[0], wx, wy, wz};
  if (k == 1) q = {wx, q[1], xy, xz};
  if (k == 2) q = {wy, xy, q[2], yz};
  if (k == 3) q = {wz, xz, yz, q[3]};
  double norm = 0;
  for (const double x : q) norm += x * x;
  const double factor = std::copysign(1 / std::sqrt(norm), q[0]);
  for (double& x : q) x *= factor;
  return q;
}

// The rotation that takes that of one pose to that of another.
Rows3 rotation_between(const Motion& from, const Motion& to) {
  Rows3 rows;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) rows[i][j] = dot(to.row(i), from.row(j));
  }
  return rows;
}

Trajectory::Piece screw_piece(const Motion& from, const Motion& to, const std::string& what) {
  Trajectory::Piece piece{.from = from, .to = to, .ends = true};
  const auto [w, x, y, z] = quaternion_of(rotation_between(from, to));
  if (w < half_turn) {
    throw InputError(InputProblem::pose, what +
                                             "is half a turn away: neither way round is the shorter one; "
                                             "give a pose between, or an axis and an angle");
  }
  const Vector3 vector{x, y, z};
  piece.radians = 2 * angle_of(length(vector), w);
  if (piece.radians < min_angle) piece.radians = 0;
  if (piece.radians > 0) piece.axis = normalized(vector);
  piece.about = Point3{} + from.offset();
  const Vector3 way = to.offset() - from.offset(), n = piece.axis;
  if (!is_finite(way) || !(max_abs(way) < 0x1p1000)) refuse_motion();
  piece.velocity = dot(n, way) * n;
  const Vector3 across = way - piece.velocity;
  if (piece.radians == 0) {
    piece.turning = across;
  } else {
    // Solves (sin turning + (1 - cos) n x turning) / radians = across.
    const double a = nearest_turn(piece.radians).sine / piece.radians,
                 half = nearest_turn(piece.radians / 2).sine, b = 2 * half * half / piece.radians;
    piece.turning = (1 / (a * a + b * b)) * (a * across - b * cross(n, across));
  }
  return piece;
}

}  // namespace

double stretch_of(const Trajectory::Piece& chain) {
  double stretch = 1 + 2 * chain.tip.defect();
  for (const Trajectory::Piece::JointPath& path : chain.chain) stretch *= 1 + 2 * path.joint.frame.defect();
  return stretch;
}

double length_up(const IntervalVector& a) {
  Vector3 most{largest(a[0]), largest(a[1]), largest(a[2])};
  const double size = max_abs(most);
  if (!std::isfinite(size)) return INFINITY;
  if (size == 0) return 0;
  const PowerOfTwo scale = PowerOfTwo::normalising(size);
  return enlarged(scale.inverse().apply(enlarged(length(scale.apply(most)))));
}

Trajectory::Trajectory(const Motion& pose) : start_(pose) {}

Trajectory Trajectory::screw(const Motion& from, const Motion& to) {
  Trajectory result(from);
  result.pieces_ = {screw_piece(from, to, "trajectory: the second pose ")};
  return result;
}

Trajectory Trajectory::through(std::span<const Motion> poses) {
  require_value(!poses.empty(), "trajectory: no pose; give one or more");
  Trajectory result(poses[0]);
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    result.pieces_.push_back(
        screw_piece(poses[i], poses[i + 1], "trajectory: pose " + std::to_string(i + 2) + " "));
  }
  return result;
}

Trajectory Trajectory::steady(const Motion& from, const SteadyMotion& motion) {
  require_value(is_finite(motion.velocity) && max_abs(motion.velocity) < 0x1p1000,
                "trajectory: the velocity does not fit; give three numbers below 1e300");
  require_value(is_finite(motion.about), "trajectory: the point to rotate about is not finite");
  require_value(std::isfinite(motion.radians) && std::fabs(motion.radians) < 0x1p30,
                "trajectory: the rotation is not finite or more than 1e8 turns; give less");
  require_value(is_finite(motion.axis) && (motion.axis != Vector3{} || motion.radians == 0),
                "trajectory: the axis of rotation has no length or is not finite; give its direction");
  Piece piece{.from = from};
  piece.about = motion.about;
  piece.velocity = motion.velocity;
  if (std::fabs(motion.radians) >= min_angle) {
    piece.radians = motion.radians;
    piece.axis = PowerOfTwo::normalising(max_abs(motion.axis)).apply(motion.axis);
  }
  Trajectory result(from);
  result.pieces_ = {piece};
  return result;
}

Trajectory Trajectory::joints(std::span<const ChainJoint> chain, const Motion& tip,
                              std::span<const std::vector<double>> positions) {
  require_chain(chain, positions);
  std::vector<Motion> poses;
  for (const std::vector<double>& list : positions) poses.push_back(pose_of_chain(chain, tip, list));
  Trajectory result(poses[0]);
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    Piece piece{.from = poses[i], .to = poses[i + 1], .ends = true};
    piece.tip = tip;
    for (std::size_t k = 0; k < chain.size(); ++k) {
      ChainJoint joint = chain[k];
      joint.axis = PowerOfTwo::normalising(max_abs(joint.axis)).apply(joint.axis);
      piece.chain.push_back({joint, positions[i][k], positions[i + 1][k]});
    }
    result.pieces_.push_back(std::move(piece));
  }
  return result;
}

Motion Trajectory::at(double time) const {
  if (pieces_.empty()) return start_;
  require_value(time >= 0 && time <= duration(),
                "trajectory: a time outside of the motion; give one from 0 to its duration");
  const std::size_t piece = std::min(static_cast<std::size_t>(time), pieces_.size() - 1);
  return PieceMotion(pieces_[piece]).at(time - static_cast<double>(piece)).pose;
}

double BoundedPose::deviation(double reach) const {
  double most = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double turned = error[4 * i] + error[4 * i + 1] + error[4 * i + 2];
    most = std::max(most, (turned > 0 ? turned * reach : 0) + error[4 * i + 3]);
  }
  return most == 0 ? 0 : enlarged(spatial_error(most));
}

PieceMotion::PieceMotion(const Motion& stays) : stays_(true), axis_{0, 0, 1} {
  piece_.from = stays;
  piece_.about = Point3{} + stays.offset();
}

PieceMotion::PieceMotion(const Trajectory::Piece& piece) : piece_(piece) {
  axis_ = unit_of(piece.axis);
  for (const Trajectory::Piece::JointPath& path : piece.chain) axes_.push_back(unit_of(path.joint.axis));
  if (!piece.ends) return;
  const bool is_chain = !piece.chain.empty();
  closing_ = is_chain ? chained(1) : screwed(1);
  for (std::size_t k = 0; k < 12; ++k) closing_[k] = Interval(piece.to.numbers()[k]) - closing_[k];
  if (!is_chain) return;
  opening_ = chained(0);
  for (std::size_t k = 0; k < 12; ++k) opening_[k] = Interval(piece.from.numbers()[k]) - opening_[k];
}

PieceMotion::Intervals PieceMotion::chained(double s) const {
  std::array<IntervalVector, 4> columns;  // images of the axes, and of the origin
  for (std::size_t j = 0; j < 3; ++j)
    columns[j] = {piece_.tip.row(0)[j], piece_.tip.row(1)[j], piece_.tip.row(2)[j]};
  columns[3] = intervals(piece_.tip.offset());
  for (std::size_t k = piece_.chain.size(); k-- > 0;) {
    const Trajectory::Piece::JointPath& path = piece_.chain[k];
    const Interval at = position(path, s);
    const Turn turn(path.joint.slides ? Interval(0) : at);
    if (path.joint.slides) columns[3] = columns[3] + at * axes_[k];
    for (IntervalVector& column : columns) column = rotated(path.joint.frame, turn(axes_[k], column));
    columns[3] = columns[3] + intervals(path.joint.frame.offset());
  }
  Intervals result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 4; ++j) result[4 * i + j] = columns[j][i];
  }
  return result;
}

PieceMotion::Intervals PieceMotion::screwed(double s) const {
  const Motion& from = piece_.from;
  const Turn turn(piece_.radians == 0 ? Interval(0) : Interval(s) * Interval(piece_.radians));
  const Interval &sine = turn.sine, &rest = turn.rest;
  const IntervalVector& n = axis_;
  const auto turned = [&](const IntervalVector& v) { return turn(n, v); };
  Intervals result;
  for (std::size_t j = 0; j < 3; ++j) {
    const IntervalVector column = turned({from.row(0)[j], from.row(1)[j], from.row(2)[j]});
    for (std::size_t i = 0; i < 3; ++i) result[4 * i + j] = column[i];
  }
  const IntervalVector about = intervals(piece_.about - Point3{}), turning = intervals(piece_.turning);
  IntervalVector place = about;
  if (const Vector3 t = from.offset(); Point3{} + t != piece_.about) {
    place = turned(intervals(t) - about) + about;
  }
  place = place + Interval(s) * intervals(piece_.velocity);
  if (piece_.turning != Vector3{}) {
    const Interval radians(piece_.radians);
    place = piece_.radians == 0 ? place + Interval(s) * turning
                                : place + (sine / radians) * turning + (rest / radians) * cross(n, turning);
  }
  for (std::size_t i = 0; i < 3; ++i) result[4 * i + 3] = place[i];
  return result;
}

BoundedPose PieceMotion::at(double s) const {
  if (stays_ || s == 0) return {piece_.from};
  if (piece_.ends && s == 1) return {piece_.to};
  const bool is_chain = !piece_.chain.empty();
  Intervals exact = is_chain ? chained(s) : screwed(s);
  Numbers numbers;
  BoundedPose result;
  for (std::size_t k = 0; k < 12; ++k) {
    if (piece_.ends) exact[k] = exact[k] + Interval(s) * closing_[k];
    if (is_chain) exact[k] = exact[k] + (Interval(1) - Interval(s)) * opening_[k];
    numbers[k] = middle(exact[k]);
    if (!std::isfinite(numbers[k])) refuse_motion();
  }
  // Between poses at the border of rigidity it may be crossed.
  result.pose = rigidity_defect(numbers) <= rigidity_tolerance ? Motion::from_3x4(numbers)
                                                               : nearest_rigid(numbers).motion;
  for (std::size_t k = 0; k < 12; ++k) {
    const double taken = result.pose.numbers()[k];
    result.error[k] = std::max(0.0, rounded_up(std::max(exact[k].upper - taken, taken - exact[k].lower)));
  }
  return result;
}

// radians n x (R x + t - about) + turning, by which x moves across the axis at first.
PieceMotion::IntervalVector PieceMotion::lever_at(const IntervalVector& point) const {
  const Vector3 t = piece_.from.offset();
  IntervalVector arm = rotated(piece_.from, point);
  if (Point3{} + t != piece_.about) arm = arm + (intervals(t) - intervals(piece_.about - Point3{}));
  return Interval(piece_.radians) * cross(axis_, arm) + intervals(piece_.turning);
}

// The largest of these over the surface: at a corner of its box, or by its ball.
double PieceMotion::lever(const SurfaceBvh& model) const {
  if (piece_.radians == 0) return length_up(intervals(piece_.turning));
  // Growth of R beyond 1: 2 defects.
  return farthest(
      model, [this](const IntervalVector& point) { return length_up(lever_at(point)); },
      std::fabs(piece_.radians) * (1 + 2 * piece_.from.defect()));
}

// Joint by joint, from the last one: its rate times how far points are from its axis.
double PieceMotion::chain_speed(const SurfaceBvh& model) const {
  const auto& chain = piece_.chain;
  const double growth = enlarged(1 + 2 * piece_.tip.defect());
  const auto placed = [this](const IntervalVector& point) {
    return rotated(piece_.tip, point) + intervals(piece_.tip.offset());
  };
  // Of the points in the frame that joint k moves: how far from its origin, and from the axis.
  double from_origin = farthest(
      model, [&](const IntervalVector& point) { return length_up(placed(point)); }, growth);
  double from_axis = farthest(
      model, [&](const IntervalVector& point) { return length_up(cross(axes_.back(), placed(point))); },
      growth);
  double sum = 0;
  for (std::size_t k = chain.size(); k-- > 0;) {
    const Trajectory::Piece::JointPath& path = chain[k];
    sum = enlarged(sum + (path.joint.slides ? rate_of(path) : rate_of(path) * from_axis));
    if (k == 0) break;
    if (path.joint.slides) from_origin = enlarged(from_origin + farthest_position(path));
    const double turned = enlarged((1 + 2 * path.joint.frame.defect()) * from_origin);
    const IntervalVector offset = intervals(path.joint.frame.offset());
    from_origin = enlarged(length_up(offset) + turned);
    from_axis = std::min(from_origin, enlarged(length_up(cross(axes_[k - 1], offset)) + turned));
  }
  return enlarged(enlarged(stretch_of(piece_)) * sum);
}

double PieceMotion::closing_growth() const {
  double matrix = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) matrix += largest(closing_[4 * i + j]) + largest(opening_[4 * i + j]);
  }
  return enlarged(matrix);
}

double PieceMotion::growth() const {
  const double own = piece_.chain.empty() ? 1 + 2 * piece_.from.defect() : enlarged(stretch_of(piece_));
  return enlarged(own + closing_growth());
}

double PieceMotion::closing_speed(const SurfaceBvh& model) const {
  if (!piece_.ends) return 0;
  const Ball& ball = model.ball();
  return enlarged(closing_growth() * (length_up(intervals(ball.centre - Point3{})) + ball.radius) +
                  length_up({closing_[3], closing_[7], closing_[11]}) +
                  length_up({opening_[3], opening_[7], opening_[11]}));
}

double PieceMotion::speed(const SurfaceBvh& model) const {
  if (stays_) return 0;
  if (!piece_.chain.empty()) {
    const double result = enlarged(chain_speed(model) + closing_speed(model));
    if (!std::isfinite(result)) refuse_motion();
    return result;
  }
  const IntervalVector velocity = intervals(piece_.velocity);
  const Interval along = dot(axis_, velocity);
  const double rise = enlarged(largest(along) + largest(dot(axis_, intervals(piece_.turning)))),
               across = enlarged(length_up(velocity - along * axis_) + lever(model));
  const double result = enlarged(length_up({rise, across, 0}) + closing_speed(model));
  if (!std::isfinite(result)) refuse_motion();
  return result;
}

double PieceMotion::relative_speed(const PieceMotion& a, const SurfaceBvh& model_a, const PieceMotion& b,
                                   const SurfaceBvh& model_b) {
  const auto velocity = [](const PieceMotion& m) {
    return intervals(m.piece_.velocity) + intervals(m.piece_.turning);
  };
  const double result =
      enlarged(length_up(velocity(b) - velocity(a)) + a.closing_speed(model_a) + b.closing_speed(model_b));
  if (!std::isfinite(result)) refuse_motion();
  return result;
}

}  // namespace snug
