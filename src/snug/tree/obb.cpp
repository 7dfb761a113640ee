#include <snug/tree/obb.h>

#include <algorithm>
#include <cmath>

#include <snug/base/contract.h>
#include <snug/base/rounding.h>

namespace snug {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

// Eigenvectors of a symmetric matrix by cyclic Jacobi rotations, as columns.
Matrix eigenvectors(Matrix m) {
  Matrix v{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (int sweep = 0; sweep < 12; ++sweep) {
    const double off = std::fabs(m[0][1]) + std::fabs(m[0][2]) + std::fabs(m[1][2]);
    const double diagonal = std::fabs(m[0][0]) + std::fabs(m[1][1]) + std::fabs(m[2][2]);
    if (!(off > 1e-14 * diagonal)) break;
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
std::array<Vector3, 3> principal_axes(std::span<const OffsetTriangle* const> members, Point3 mean) {
  Matrix covariance{};
  for (const OffsetTriangle* member : members) {
    for (const Point3& p : member->base) {
      const Vector3 d = p - mean;
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) covariance[i][j] += d[i] * d[j];
      }
    }
  }
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

// Larger than what non-orthonormal axes (64 roundings) and this many operations can do.
constexpr double pair_slack = 32;

}  // namespace

Obb outer_obb(std::span<const OffsetTriangle* const> members) {
  SNUG_EXPECT(!members.empty());
  Vector3 sum;
  for (const OffsetTriangle* member : members) {
    for (const Point3& p : member->base) sum = sum + (p - Point3{});
  }
  const Point3 mean = Point3{} + (1.0 / (3.0 * static_cast<double>(members.size()))) * sum;
  Obb box;
  box.axes = principal_axes(members, mean);
  std::array<double, 3> lower{INFINITY, INFINITY, INFINITY}, upper{-INFINITY, -INFINITY, -INFINITY};
  for (const OffsetTriangle* member : members) {
    for (const Point3& p : member->base) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double height = dot(box.axes[k], p - mean);
        lower[k] = std::min(lower[k], height - member->radius);
        upper[k] = std::max(upper[k], height + member->radius);
      }
    }
  }
  box.centre = mean;
  for (std::size_t k = 0; k < 3; ++k) box.centre = box.centre + ((lower[k] + upper[k]) / 2) * box.axes[k];
  // Again about the centre as it came out: this pass is the one that counts.
  for (const OffsetTriangle* member : members) {
    SNUG_EXPECT(std::isfinite(member->radius));
    for (const Point3& p : member->base) {
      const Vector3 d = p - box.centre;
      for (std::size_t k = 0; k < 3; ++k) {
        const double height =
            std::fabs(dot(box.axes[k], d)) + 16 * unit_roundoff * max_abs(d) + 8 * underflow_error;
        box.half[k] = std::max(box.half[k], enlarged(height + member->radius));
      }
    }
  }
  return box;
}

double PlacedFrame::apply_error(const Point3& p) const {
  // Rows of R have length at most 1 + defect, so their absolute sums are below 2.
  const double size = 2 * scale * max_abs(p - Point3{}) + max_abs(translation);
  return enlarged(8 * unit_roundoff * size) + 8 * underflow_error;
}

double PlacedFrame::growth() const { return scale * (1 + 2 * defect); }

PlacedObb placed(const Obb& box, const PlacedFrame& frame) {
  return {frame.apply(box.centre),
          {frame.turn(box.axes[0]), frame.turn(box.axes[1]), frame.turn(box.axes[2])},
          frame.scale * box.half,
          frame.apply_error(box.centre)};
}

double certain_gap(const PlacedObb& a, const PlacedObb& b, double defect) {
  const Vector3 d = b.centre - a.centre;
  double t[3], c[3][3], m[3][3];
  for (std::size_t i = 0; i < 3; ++i) {
    t[i] = dot(a.axes[i], d);
    for (std::size_t j = 0; j < 3; ++j) {
      c[i][j] = dot(a.axes[i], b.axes[j]);
      m[i][j] = std::fabs(c[i][j]);
    }
  }
  const double reach = max_abs(d) + a.half.x + a.half.y + a.half.z + b.half.x + b.half.y + b.half.z;
  const double slack = enlarged(pair_slack * (defect + 64 * unit_roundoff) * reach +
                                spatial_error(a.centre_error + b.centre_error));
  double best = -INFINITY;
  for (std::size_t i = 0; i < 3; ++i) {
    best = std::max(
        best, std::fabs(t[i]) - (a.half[i] + b.half.x * m[i][0] + b.half.y * m[i][1] + b.half.z * m[i][2]));
  }
  for (std::size_t j = 0; j < 3; ++j) {
    const double along = std::fabs(t[0] * c[0][j] + t[1] * c[1][j] + t[2] * c[2][j]);
    best = std::max(best, along - (b.half[j] + a.half.x * m[0][j] + a.half.y * m[1][j] + a.half.z * m[2][j]));
  }
  best -= slack;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const double length_sq = 1 - c[i][j] * c[i][j];  // of the cross product
      if (!(length_sq > 1e-3)) continue;               // nearly parallel: the face axes see the same
      const double along = std::fabs(t[i2] * c[i1][j] - t[i1] * c[i2][j]);
      const double gap =
          along -
          (a.half[i1] * m[i2][j] + a.half[i2] * m[i1][j] + b.half[j1] * m[i][j2] + b.half[j2] * m[i][j1]) -
          slack;
      // A gap along a longer vector is divided by its length; an overlap only orders visits.
      best = std::max(best, gap > 0 ? gap / std::sqrt(length_sq + 8 * (defect + 64 * unit_roundoff)) : gap);
    }
  }
  return best;
}

}  // namespace snug
