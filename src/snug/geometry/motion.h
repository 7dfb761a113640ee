#pragma once

#include <array>

#include <snug/geometry/point.h>
#include <snug/geometry/rounding.h>

namespace snug {

/// How far R'R may be from the identity, in its largest entry, before a matrix is refused as a motion.
inline constexpr double rigidity_tolerance = 1e-9;

/// Upper bound of the largest entry of |R'R - I| for the 3x3 part R of a row-major 3x4 matrix; infinite where doubles do not
/// reach.
[[nodiscard]] double rigidity_defect(const std::array<double, 12>& matrix);

/// The first three rows of a row-major 4x4 matrix.
/// Errors:    InputError (pose) unless the last row is exactly 0 0 0 1.
[[nodiscard]] std::array<double, 12> upper_rows(const std::array<double, 16>& matrix);

/// A rigid motion x -> R x + t with exactly the twelve doubles of numbers(), row-major 3x4 (R | t).
///
/// Guarantee: all numbers are finite, no entry of R'R is farther from the identity than rigidity_tolerance, det R > 0.
///            Those made from a translation, an axis and an angle or a quaternion have a defect() of at most 32 unit_roundoff.
/// Errors:    whatever makes one throws InputError (pose) for numbers that are not finite or not such a motion. The message
///            says how far off they are; see nearest_rigid().
class Motion {
 public:
  /// Moves nothing.
  Motion() = default;
  /// Row-major (R | t), taken as it stands.
  [[nodiscard]] static Motion from_3x4(const std::array<double, 12>& matrix);
  /// Row-major, for columns (x, 1); the last row is 0 0 0 1.
  [[nodiscard]] static Motion from_4x4(const std::array<double, 16>& matrix);
  [[nodiscard]] static Motion from_translation(const Vector3& translation);
  /// Turns about the origin by an angle in radians, counterclockwise where the axis points at the viewer.
  /// Requires:  an axis of any positive length.
  [[nodiscard]] static Motion from_axis_angle(const Vector3& axis, double radians);
  /// The same in degrees: about x, y or z, multiples of 90 give a matrix of 0, 1 and -1.
  [[nodiscard]] static Motion from_axis_degrees(const Vector3& axis, double degrees);
  /// Turns by q / |q|, q = (w, x, y, z) of any positive length, then moves.
  [[nodiscard]] static Motion from_quaternion(const std::array<double, 4>& wxyz,
                                              const Vector3& translation = {});

  [[nodiscard]] const std::array<double, 12>& numbers() const { return numbers_; }
  /// Of R.
  [[nodiscard]] Vector3 row(std::size_t i) const {
    return {numbers_[4 * i], numbers_[4 * i + 1], numbers_[4 * i + 2]};
  }
  [[nodiscard]] Vector3 translation() const { return {numbers_[3], numbers_[7], numbers_[11]}; }
  /// The same rotation with another translation.
  [[nodiscard]] Motion with_translation(const Vector3& translation) const;
  /// Upper bound of the largest entry of |R'R - I|; at most rigidity_tolerance.
  [[nodiscard]] double defect() const { return defect_; }

  [[nodiscard]] Vector3 rotate(const Vector3& v) const {
    return {dot(row(0), v), dot(row(1), v), dot(row(2), v)};
  }
  /// R x + t in doubles; see PlacedFrame::apply_error.
  [[nodiscard]] Point3 apply(const Point3& p) const {
    return Point3{} + (rotate({p.x, p.y, p.z}) + translation());
  }

  /// x -> a(b(x)), its twelve numbers rounded. A product that drifted beyond the tolerance is brought to the nearest
  /// rotation, so that chains of any length stay motions.
  /// Errors:    InputError (pose) if the translation does not fit a double.
  friend Motion operator*(const Motion& a, const Motion& b);
  /// Undoes this one: the matrix of inverse() * motion is the identity within some roundings, and within 2 defect() where the
  /// exact inverse is no motion.
  [[nodiscard]] Motion inverse() const;

  friend bool operator==(const Motion&, const Motion&) = default;

 private:
  Motion(const std::array<double, 12>& numbers, double defect) : numbers_(numbers), defect_(defect) {}
  static Motion settled(const std::array<double, 12>& numbers);

  std::array<double, 12> numbers_{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  double defect_ = 8 * unit_roundoff;
};

/// Where two meshes stand.
struct PosePair {
  Motion a, b;
};

/// A motion near a matrix that is none, and how far that was from being one.
struct NearestRigid {
  Motion motion;
  double defect = 0;  ///< rigidity_defect() of the matrix
  double change = 0;  ///< the largest change of an entry of R
};

/// The motion with the same translation whose R is nearest to that of the matrix in the Frobenius norm: its orthogonal polar
/// factor, within a few roundings over the sum of its two smallest singular values.
///
/// Errors:    InputError (pose) for numbers that are not finite, a matrix that mirrors, or one that is singular: whose
///            smallest singular value is below 1e-12 of the largest one.
/// Source:    [Higham86]; differs: singular vectors by one-sided Jacobi rotations [Hestenes58], which also tell a mirrored
///            matrix from a singular one, then one step of Newton and Schulz.
[[nodiscard]] NearestRigid nearest_rigid(const std::array<double, 12>& matrix);

}  // namespace snug
