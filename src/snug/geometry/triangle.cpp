#include <snug/geometry/triangle.h>

#include <algorithm>
#include <cmath>

namespace snug {
namespace {

double inverse_or_zero(double x) { return x > 0 && std::isfinite(1 / x) ? 1 / x : 0; }

double clamped(double t) { return t > 0 ? std::min(t, 1.0) : 0.0; }

}  // namespace

TriangleFoot::TriangleFoot(const Vector3& a, const Vector3& b, const Vector3& c)
    : a_(a),
      edge_b_(b - a),
      edge_c_(c - a),
      edge_bc_(c - b),
      inverse_b_(inverse_or_zero(length_sq(edge_b_))),
      inverse_c_(inverse_or_zero(length_sq(edge_c_))),
      inverse_bc_(inverse_or_zero(length_sq(edge_bc_))) {
  const Vector3 normal = cross(edge_b_, edge_c_);
  const double inverse = inverse_or_zero(length_sq(normal));
  dual_b_ = inverse * cross(edge_c_, normal);
  dual_c_ = inverse * cross(normal, edge_b_);
  flat_ = inverse == 0 || !is_finite(dual_b_) || !is_finite(dual_c_);
}

Barycentric TriangleFoot::operator()(const Vector3& p) const {
  const Vector3 d = p - a_;
  if (!flat_) {
    const Barycentric foot{dot(dual_b_, d), dot(dual_c_, d)};
    if (foot.b >= 0 && foot.c >= 0 && foot.b + foot.c <= 1) return foot;
  }
  const double on_b = clamped(dot(d, edge_b_) * inverse_b_);
  const double on_c = clamped(dot(d, edge_c_) * inverse_c_);
  const double on_bc = clamped(dot(d - edge_b_, edge_bc_) * inverse_bc_);
  const double dist_b = length_sq(d - on_b * edge_b_);
  const double dist_c = length_sq(d - on_c * edge_c_);
  const double dist_bc = length_sq(d - edge_b_ - on_bc * edge_bc_);
  if (dist_b <= dist_c && dist_b <= dist_bc) return {on_b, 0};
  if (dist_c <= dist_bc) return {0, on_c};
  return {1 - on_bc, on_bc};
}

Vector3 TriangleFoot::rest(const Vector3& p) const {
  const Barycentric foot = (*this)(p);
  return p - a_ - foot.b * edge_b_ - foot.c * edge_c_;
}

SegmentFoot::SegmentFoot(const Vector3& a, const Vector3& b)
    : a_(a), edge_(b - a), inverse_(inverse_or_zero(length_sq(edge_))) {}

Vector3 SegmentFoot::rest(const Vector3& p) const {
  const Vector3 d = p - a_;
  return d - clamped(dot(d, edge_) * inverse_) * edge_;
}

}  // namespace snug
