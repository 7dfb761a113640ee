#include <snug/geometry/motion.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>

#include <snug/geometry/angles.h>
#include <support/direction.h>
#include <support/error.h>

namespace snug {
namespace {

using Numbers = std::array<double, 12>;
using Columns = std::array<Vector3, 3>;

// A smallest singular value below this part of the largest one counts as zero.
constexpr double singular = 1e-12;
// Columns of about the same length this nearly orthogonal are those of a scaled rotation.
constexpr double scaled_only = 1e-6;

[[noreturn]] void refuse(const std::string& message) {
  throw InputError(InputProblem::pose, "pose: " + message);
}

std::string short_text(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x);
  return text;
}

void require_finite(const Numbers& numbers) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!std::isfinite(numbers[i])) refuse("number " + std::to_string(i + 1) + " is not finite");
  }
}

Columns columns_of(const Numbers& m) {
  return {{{m[0], m[4], m[8]}, {m[1], m[5], m[9]}, {m[2], m[6], m[10]}}};
}

// R from its columns, t from `numbers`.
Numbers with_columns(const Numbers& numbers, const Columns& columns) {
  Numbers result = numbers;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) result[4 * i + j] = columns[j][i];
  }
  return result;
}

Numbers with_offset(Numbers numbers, const Vector3& t) {
  for (std::size_t i = 0; i < 3; ++i) numbers[4 * i + 3] = t[i];
  return numbers;
}

// Advice for a matrix that is off from a rotation by `defect`.
std::string mended(const Numbers& numbers, double defect) {
  const auto [a, b, c] = columns_of(numbers);
  const double scale = length(a);
  Numbers shrunk = numbers;
  for (double& x : shrunk) x /= scale;
  if (scale > 0 && std::isfinite(scale) && std::fabs(scale - 1) > scaled_only &&
      rigidity_defect(shrunk) <= scaled_only) {
    return "it scales lengths by " + short_text(scale) + "; scale the mesh instead";
  }
  const std::string off = std::isfinite(defect) ? short_text(defect) : "more than a double can hold";
  return "its 3x3 part R is not a rotation: an entry of R'R is off from the identity by " + off +
         ", more than 1e-9; take the nearest rotation (--nearest-rigid, or nearest_rigid() of the library)";
}

[[noreturn]] void refuse_mirror() {
  refuse("it mirrors: its determinant is negative; give a rotation, and mirror the mesh instead");
}

// One-sided Jacobi rotations: turns the columns of a, and those of v alike, until those of a are orthogonal.
void orthogonalise(Columns& a, Columns& v) {
  constexpr std::array<std::pair<std::size_t, std::size_t>, 3> pairs{{{0, 1}, {0, 2}, {1, 2}}};
  for (int sweep = 0; sweep < 40; ++sweep) {
    bool done = true;
    for (const auto& [p, q] : pairs) {
      const double pp = dot(a[p], a[p]), qq = dot(a[q], a[q]), pq = dot(a[p], a[q]);
      if (!(std::fabs(pq) > 4 * unit_roundoff * std::sqrt(pp) * std::sqrt(qq))) continue;
      done = false;
      const double zeta = (qq - pp) / (2 * pq);
      const double t = std::copysign(1.0, zeta) / (std::fabs(zeta) + std::hypot(1.0, zeta));
      const double c = 1 / std::sqrt(1 + t * t), s = c * t;
      for (Columns* columns : {&a, &v}) {
        const Vector3 x = (*columns)[p], y = (*columns)[q];
        (*columns)[p] = c * x - s * y;
        (*columns)[q] = s * x + c * y;
      }
    }
    if (done) return;
  }
}

// R + share R (I - R'R), from an error e to about e^2: with 1/2 the step of Newton and Schulz toward the
// nearest orthogonal matrix; with 1 Newton's from R' toward the inverse, transposed.
Columns newton_step(const Columns& r, double share) {
  Columns result = r;
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t k = 0; k < 3; ++k) result[j] = result[j] + (share * ((j == k) - dot(r[k], r[j]))) * r[k];
  }
  return result;
}

// The orthogonal polar factor of a matrix of entries up to about 1.
Columns nearest_rotation(Columns a) {
  Columns v{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  orthogonalise(a, v);
  // The longest first; swapping two columns of both and one's sign changes neither matrix nor determinants.
  for (const auto& [p, q] : {std::pair{0u, 1u}, {1u, 2u}, {0u, 1u}}) {
    if (length_sq(a[p]) >= length_sq(a[q])) continue;
    std::swap(a[p], a[q]);
    std::swap(v[p], v[q]);
    a[p] = -a[p];
    v[p] = -v[p];
  }
  const double largest = length(a[0]), smallest = length(a[2]);
  if (!(smallest > singular * largest)) {
    refuse("its 3x3 part is singular, or nearly so: no rotation is nearest; give a rotation");
  }
  const Vector3 u0 = (1 / largest) * a[0];
  const Vector3 rest = a[1] - dot(u0, a[1]) * u0;
  const Vector3 u1 = normalized(rest), u2 = cross(u0, u1);
  if (dot(a[2], u2) < 0) refuse_mirror();
  Columns result;
  for (std::size_t j = 0; j < 3; ++j) result[j] = v[0][j] * u0 + v[1][j] * u1 + v[2][j] * u2;
  return newton_step(result, 0.5);
}

Vector3 unit(const Vector3& axis) {
  if (!is_finite(axis)) refuse("the axis of rotation is not finite");
  if (max_abs(axis) == 0) refuse("the axis of rotation has no length; give its direction, as in 0 0 1");
  return normalized(axis);
}

// Rodrigues' formula for a unit axis and the angle's sine and cosine.
Numbers turned(const Vector3& n, double sine, double cosine) {
  const double rest = 1 - cosine;
  const auto entry = [&](double a, double b, double c) { return rest * a * b + sine * c; };
  return {cosine + rest * n.x * n.x, entry(n.x, n.y, -n.z),     entry(n.x, n.z, n.y),      0,
          entry(n.x, n.y, n.z),      cosine + rest * n.y * n.y, entry(n.y, n.z, -n.x),     0,
          entry(n.x, n.z, -n.y),     entry(n.y, n.z, n.x),      cosine + rest * n.z * n.z, 0};
}

}  // namespace

double rigidity_defect(const Numbers& matrix) {
  const auto [a, b, c] = columns_of(matrix);
  const double aa = std::fabs(dot(a, a) - 1), bb = std::fabs(dot(b, b) - 1), cc = std::fabs(dot(c, c) - 1);
  const double ab = std::fabs(dot(a, b)), bc = std::fabs(dot(b, c)), ca = std::fabs(dot(c, a));
  const double worst = std::max({aa, bb, cc, ab, bc, ca}) + 8 * unit_roundoff;
  // A NaN may have been lost in the maximum, but not in a sum.
  return std::isfinite(aa + bb + cc + ab + bc + ca) ? worst : INFINITY;
}

Numbers upper_rows(const std::array<double, 16>& matrix) {
  if (matrix[12] != 0 || matrix[13] != 0 || matrix[14] != 0 || matrix[15] != 1) {
    const bool transposed = matrix[3] == 0 && matrix[7] == 0 && matrix[11] == 0 && matrix[15] == 1;
    refuse(std::string("the last row of a 4x4 matrix is not 0 0 0 1; ") +
           (transposed ? "give it row by row, with the translation in the last column"
                       : "give an affine matrix, or the first three rows alone"));
  }
  Numbers result;
  std::copy_n(matrix.begin(), result.size(), result.begin());
  return result;
}

Motion Motion::from_3x4(const Numbers& matrix) {
  require_finite(matrix);
  const auto [a, b, c] = columns_of(matrix);
  if (dot(cross(a, b), c) < 0) refuse_mirror();
  const double defect = rigidity_defect(matrix);
  if (!(defect <= rigidity_tolerance)) refuse(mended(matrix, defect));
  return {matrix, defect};
}

Motion Motion::from_4x4(const std::array<double, 16>& matrix) { return from_3x4(upper_rows(matrix)); }

Motion Motion::translation(const Vector3& by) { return Motion().with_offset(by); }

Motion Motion::rotation(const Vector3& axis, double radians) {
  if (!std::isfinite(radians)) refuse("the angle of rotation is not finite");
  const auto [sine, cosine] = nearest_turn(radians);
  return from_3x4(turned(unit(axis), sine, cosine));
}

Motion Motion::rotation_degrees(const Vector3& axis, double degrees) {
  if (!std::isfinite(degrees)) refuse("the angle of rotation is not finite");
  int quarters = 0;
  const double rest = std::remquo(degrees, 90.0, &quarters) * (std::numbers::pi / 180);
  const auto [s, c] = nearest_turn(rest);
  const std::array<double, 4> sines{s, c, -s, -c};
  const auto quarter = static_cast<unsigned>(quarters) % 4;
  return from_3x4(turned(unit(axis), sines[quarter], sines[(quarter + 1) % 4]));
}

Motion Motion::from_quaternion(const std::array<double, 4>& wxyz, const Vector3& translation) {
  double largest = 0;
  for (const double q : wxyz) {
    if (!std::isfinite(q)) refuse("the quaternion is not finite");
    largest = std::max(largest, std::fabs(q));
  }
  if (largest == 0) refuse("the quaternion is zero; give w x y z, 1 0 0 0 for no rotation");
  const PowerOfTwo scale = PowerOfTwo::normalising(largest);
  const double w = scale.apply(wxyz[0]), x = scale.apply(wxyz[1]), y = scale.apply(wxyz[2]),
               z = scale.apply(wxyz[3]);
  const double s = 2 / (w * w + x * x + y * y + z * z);
  const Numbers rotation{1 - s * (y * y + z * z), s * (x * y - w * z),     s * (x * z + w * y),     0,
                         s * (x * y + w * z),     1 - s * (x * x + z * z), s * (y * z - w * x),     0,
                         s * (x * z - w * y),     s * (y * z + w * x),     1 - s * (x * x + y * y), 0};
  return from_3x4(snug::with_offset(rotation, translation));
}

Vector3 Motion::rotate(const Vector3& v) const { return {dot(row(0), v), dot(row(1), v), dot(row(2), v)}; }

Point3 Motion::apply(const Point3& p) const { return Point3{} + (rotate({p.x, p.y, p.z}) + offset()); }

Motion Motion::with_offset(const Vector3& offset) const {
  const Numbers numbers = snug::with_offset(numbers_, offset);
  require_finite(numbers);
  return {numbers, defect_};
}

Motion Motion::made_rigid(const Numbers& numbers) {
  if (!is_finite(Vector3{numbers[3], numbers[7], numbers[11]})) {
    refuse("the translation of a product or inverse does not fit a double; give smaller translations");
  }
  const double defect = rigidity_defect(numbers);
  return defect <= rigidity_tolerance ? Motion(numbers, defect) : nearest_rigid(numbers).motion;
}

Motion operator*(const Motion& a, const Motion& b) {
  const Columns columns = columns_of(b.numbers_);
  const Numbers rotation =
      with_columns({}, {a.rotate(columns[0]), a.rotate(columns[1]), a.rotate(columns[2])});
  return Motion::made_rigid(with_offset(rotation, a.rotate(b.offset()) + a.offset()));
}

Motion Motion::inverse() const {
  const Columns rows = newton_step(columns_of(numbers_), 1);
  const Vector3 t = offset();
  const Vector3 back{-dot(rows[0], t), -dot(rows[1], t), -dot(rows[2], t)};
  return made_rigid({rows[0].x, rows[0].y, rows[0].z, back.x,  //
                     rows[1].x, rows[1].y, rows[1].z, back.y,  //
                     rows[2].x, rows[2].y, rows[2].z, back.z});
}

NearestRigid nearest_rigid(const Numbers& matrix) {
  require_finite(matrix);
  const Columns given = columns_of(matrix);
  const double largest = std::max({max_abs(given[0]), max_abs(given[1]), max_abs(given[2])});
  const PowerOfTwo scale = PowerOfTwo::normalising(largest);
  const Columns rotation =
      nearest_rotation({scale.apply(given[0]), scale.apply(given[1]), scale.apply(given[2])});
  NearestRigid result;
  result.motion = Motion::from_3x4(with_columns(matrix, rotation));
  result.defect = rigidity_defect(matrix);
  for (std::size_t j = 0; j < 3; ++j)
    result.change = std::max(result.change, max_abs(rotation[j] - given[j]));
  return result;
}

}  // namespace snug
