#include <snug/bvh/volume.h>

#include <algorithm>
#include <cmath>

#include <snug/base/contract.h>
#include <snug/geometry/rounding.h>

namespace snug {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

// Eigenvectors of a symmetric matrix by cyclic Jacobi rotations, as columns.
Matrix eigenvectors(Matrix m) {
  Matrix v{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (int sweep = 0; sweep < 8; ++sweep) {
    const double off = std::fabs(m[0][1]) + std::fabs(m[0][2]) + std::fabs(m[1][2]);
    const double diagonal = std::fabs(m[0][0]) + std::fabs(m[1][1]) + std::fabs(m[2][2]);
    if (!(off > 1e-4 * diagonal)) break;  // any axes are right, nearly principal ones are as good
    for (std::size_t p = 0; p < 2; ++p) {
      for (std::size_t q = p + 1; q < 3; ++q) {
        if (m[p][q] == 0) continue;
        const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
        const double t = (theta >= 0 ? 1.0 : -1.0) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (std::size_t k = 0; k < 3; ++k) {
          const double kp = m[k][p], kq = m[k][q];
          m[k][p] = c * kp - s * kq;
          m[k][q] = s * kp + c * kq;
        }
        for (std::size_t k = 0; k < 3; ++k) {
          const double pk = m[p][k], qk = m[q][k];
          m[p][k] = c * pk - s * qk;
          m[q][k] = s * pk + c * qk;
          const double vp = v[k][p], vq = v[k][q];
          v[k][p] = c * vp - s * vq;
          v[k][q] = s * vp + c * vq;
        }
      }
    }
  }
  return v;
}

// Two eigenvectors made orthonormal again, the third their cross product; the coordinate axes if that fails.
std::array<Vector3, 3> axes_of(const Matrix& covariance) {
  const Matrix v = eigenvectors(covariance);
  Vector3 a{v[0][0], v[1][0], v[2][0]}, b{v[0][1], v[1][1], v[2][1]};
  const double size_a = length(a);
  if (!(size_a > 0.5)) return Obb{}.axes;
  a = (1 / size_a) * a;
  b = b - dot(a, b) * a;
  const double size_b = length(b);
  if (!(size_b > 0.5) || !std::isfinite(size_b)) return Obb{}.axes;
  b = (1 / size_b) * b;
  return {a, b, cross(a, b)};
}

void add_outer(Matrix& m, const Vector3& d, double weight) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) m[i][j] += weight * d[i] * d[j];
  }
}

// The box with these axes and extents. Where x is a corner of what the extents hold, dot(axis, x - centre) is off from
// dot(axis, x) - dot(axis, centre) by no more than the roundings counted here.
Obb box_of(const std::array<Vector3, 3>& axes, const std::array<Enclosed::Extent, 3>& extents) {
  Obb box;
  for (const Enclosed::Extent& extent : extents) {
    if (!std::isfinite(extent.lower) || !std::isfinite(extent.upper)) {
      box.half = {INFINITY, INFINITY, INFINITY};
      return box;
    }
  }
  box.axes = axes;
  Vector3 from_origin;
  for (std::size_t k = 0; k < 3; ++k) {
    from_origin = from_origin + ((extents[k].lower + extents[k].upper) / 2) * axes[k];
  }
  box.centre = Point3{} + from_origin;
  for (std::size_t k = 0; k < 3; ++k) {
    const double middle = dot(axes[k], from_origin);
    const double error = 8 * unit_roundoff * max_abs(from_origin) + 8 * underflow_error;
    const double half = std::max(extents[k].upper - middle, middle - extents[k].lower);
    box.half[k] = enlarged(std::max(half, 0.0) + error);
  }
  return box;
}

// Bounds of dot(direction, x) over boxes.
Enclosed::Extent extent_of(std::span<const BoundingVolume> boxes, const Vector3& direction) {
  Enclosed::Extent all{INFINITY, -INFINITY};
  for (const BoundingVolume& part : boxes) {
    const Obb& box = part.box;
    // Infinite sides times cosines of zero are no numbers, which minima pass over.
    if (!std::isfinite(box.half.x + box.half.y + box.half.z)) return {-INFINITY, INFINITY};
    double reach = 0;
    for (std::size_t k = 0; k < 3; ++k) reach += box.half[k] * std::fabs(dot(direction, box.axes[k]));
    const double middle = dot(direction, box.centre - Point3{});
    // The box as a set of inequalities lies in that of the combinations of its axes, made larger by what the axes lack of
    // orthonormality; at most 64 roundings.
    const double error =
        128 * unit_roundoff * (max_abs(box.centre - Point3{}) + box.half.x + box.half.y + box.half.z);
    all.lower = std::min(all.lower, middle - reach - error);
    all.upper = std::max(all.upper, middle + reach + error);
  }
  return all;
}

}  // namespace

const char* name_of(Volume volume) {
  switch (volume) {
    case Volume::aabb:
      return "aabb";
    case Volume::obb:
      return "obb";
    case Volume::dop14:
      return "14-dop";
    case Volume::dop18:
      return "18-dop";
    case Volume::dop26:
      return "26-dop";
  }
  return "";
}

std::span<const std::uint8_t> directions_of(Volume volume) {
  static constexpr std::array<std::uint8_t, 13> diagonals_then_faces{0, 1, 2, 3,  4,  5, 6,
                                                                     7, 8, 9, 10, 11, 12};
  static constexpr std::array<std::uint8_t, 9> faces{0, 1, 2, 7, 8, 9, 10, 11, 12};
  const std::span<const std::uint8_t> all(diagonals_then_faces);
  switch (volume) {
    case Volume::aabb:
      return all.first(3);
    case Volume::dop14:
      return all.first(7);
    case Volume::dop18:
      return faces;
    case Volume::dop26:
      return all;
    case Volume::obb:
      break;
  }
  return {};
}

void Enclosed::extents(std::span<const Vector3> directions, std::span<Extent> out) const {
  for (std::size_t i = 0; i < directions.size(); ++i) out[i] = extent(directions[i]);
}

std::array<Vector3, 3> principal_axes(std::span<const Point3> points) {
  Vector3 sum;
  for (const Point3& p : points) sum = sum + (p - Point3{});
  const Point3 mean = Point3{} + (1.0 / static_cast<double>(std::max<std::size_t>(points.size(), 1))) * sum;
  Matrix covariance{};
  for (const Point3& p : points) add_outer(covariance, p - mean, 1);
  return axes_of(covariance);
}

Obb fit(const std::array<Vector3, 3>& axes, const Enclosed& set) {
  std::array<Enclosed::Extent, 3> extents;
  set.extents(axes, extents);
  return box_of(axes, extents);
}

BoundingVolume fit(Volume volume, const Enclosed& set) {
  BoundingVolume result;
  if (volume == Volume::obb) {
    result.box = fit(principal_axes(set.points()), set);
    return result;
  }
  const auto directions = directions_of(volume);
  std::array<Vector3, max_directions> wanted;
  std::array<Enclosed::Extent, max_directions> found;
  for (std::size_t i = 0; i < directions.size(); ++i) wanted[i] = all_directions[directions[i]];
  set.extents(std::span(wanted).first(directions.size()), found);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const bool finite = std::isfinite(found[i].lower) && std::isfinite(found[i].upper);
    result.lower[i] = finite ? found[i].lower : -INFINITY;
    result.upper[i] = finite ? found[i].upper : INFINITY;
  }
  return result;
}

BoundingVolume merge(Volume volume, std::span<const BoundingVolume> parts) {
  SNUG_EXPECT(!parts.empty());
  BoundingVolume result = parts[0];
  if (volume == Volume::obb) {
    Vector3 sum;
    for (const BoundingVolume& part : parts) sum = sum + (part.box.centre - Point3{});
    const Point3 mean = Point3{} + (1.0 / static_cast<double>(parts.size())) * sum;
    Matrix covariance{};
    for (const BoundingVolume& part : parts) {
      add_outer(covariance, part.box.centre - mean, 1);
      for (std::size_t k = 0; k < 3; ++k) {
        add_outer(covariance, part.box.axes[k], part.box.half[k] * part.box.half[k] / 3);
      }
    }
    const std::array<Vector3, 3> axes = axes_of(covariance);
    result.box =
        box_of(axes, {extent_of(parts, axes[0]), extent_of(parts, axes[1]), extent_of(parts, axes[2])});
    return result;
  }
  for (const BoundingVolume& part : parts.subspan(1)) {
    for (std::size_t i = 0; i < directions_of(volume).size(); ++i) {
      result.lower[i] = std::min(result.lower[i], part.lower[i]);
      result.upper[i] = std::max(result.upper[i], part.upper[i]);
    }
  }
  return result;
}

Ball ball_around(Volume volume, const BoundingVolume& set) {
  if (volume == Volume::obb) {
    const Obb& box = set.box;
    const double reach = std::sqrt(length_sq(box.half));
    return {box.centre, std::isfinite(reach) ? enlarged(reach) : INFINITY};
  }
  Point3 centre;
  Vector3 half;
  for (std::size_t k = 0; k < 3; ++k) {
    centre[k] = (set.lower[k] + set.upper[k]) / 2;
    half[k] = std::max(set.upper[k] - centre[k], centre[k] - set.lower[k]);
  }
  const double reach = std::sqrt(length_sq(half));
  if (!std::isfinite(reach) || !is_finite(centre)) return {Point3{}, INFINITY};
  return {centre, enlarged(reach)};
}

Obb box_around(Volume volume, const BoundingVolume& set) {
  if (volume == Volume::obb) return set.box;
  Obb box;
  for (std::size_t k = 0; k < 3; ++k) {
    const double middle = (set.lower[k] + set.upper[k]) / 2;
    box.centre[k] = std::isfinite(middle) ? middle : 0;
    box.half[k] = enlarged(std::max(set.upper[k] - box.centre[k], box.centre[k] - set.lower[k]));
  }
  return box;
}

}  // namespace snug
