#include <snug/query/piece_quadratic.h>

#include <algorithm>

#include <snug/geometry/rounding.h>
#include <snug/query/flatness_kernel.h>

namespace snug {
namespace {

Vector3 doubled(const std::array<float, 3>& x) {
  return {static_cast<double>(x[0]), static_cast<double>(x[1]), static_cast<double>(x[2])};
}

}  // namespace

PieceQuadratic::PieceQuadratic(const QuadraticTriangle& near, const PiecePath& path)
    : first_(to_face(path, {0, 0})),
      origin_(near.corners[0]),
      scale_(static_cast<float>(path.turned() ? -path.scale() : path.scale())) {
  const auto from = [&](const Point3& p) { return p - origin_; };
  const Vector3 corner_u = from(near.corners[1]), corner_v = from(near.corners[2]),
                middle_u = from(near.middles[0]), middle_uv = from(near.middles[1]),
                middle_v = from(near.middles[2]);
  u_ = 2.0 * middle_u;
  v_ = 2.0 * middle_v;
  // u^2 + u v + v^2 is at most 1.
  double rounding = 0;
  const auto single = [&](const Vector3& x) {
    Single result;
    for (std::size_t a = 0; a < 3; ++a) {
      result[a] = static_cast<float>(x[a]);
      rounding = std::max(rounding, std::fabs(static_cast<double>(result[a]) - x[a]));
    }
    return result;
  };
  uu_ = single(corner_u - 2.0 * middle_u);
  vv_ = single(corner_v - 2.0 * middle_v);
  uv_ = single(2.0 * (middle_uv - middle_u - middle_v));
  error_ = float_up(enlarged(near.error + spatial_error(rounding)));
}

TriangleParameter PieceQuadratic::local(TriangleParameter p) const {
  const auto scale = static_cast<double>(scale_);
  return {scale * (p.u - first_.u), scale * (p.v - first_.v)};
}

Vector3 PieceQuadratic::from_origin(TriangleParameter p) const {
  const Vector3 uu = doubled(uu_), uv = doubled(uv_), vv = doubled(vv_);
  return p.u * (u_ + p.u * uu + p.v * uv) + p.v * (v_ + p.v * vv);
}

Vector3 PieceQuadratic::bow(TriangleParameter a, TriangleParameter b) const {
  const auto scale = static_cast<double>(scale_);
  const double du = (b.u - a.u) * scale, dv = (b.v - a.v) * scale;
  return 0.25 * (du * du * doubled(uu_) + du * dv * doubled(uv_) + dv * dv * doubled(vv_));
}

Flatness PieceQuadratic::flatness(const FlatTriangle& triangle) const {
  const PieceQuadratic* const piece = this;
  Flatness result{};
  flatness({&piece, 1}, {&triangle, 1}, {&result, 1});
  return result;
}

void PieceQuadratic::flatness(std::span<const PieceQuadratic* const> pieces,
                              std::span<const FlatTriangle> triangles, std::span<Flatness> out) {
  kernels::FlatnessLanes lanes;
  for (std::size_t l = 0; l < kernels::FlatnessLanes::count; ++l) {
    // Lanes beyond the last triangle repeat it.
    const std::size_t i = std::min(l, triangles.size() - 1);
    const PieceQuadratic& q = *pieces[i];
    const FlatTriangle& t = triangles[i];
    lanes.error[l] = q.error();
    for (std::size_t k = 0; k < 3; ++k) {
      const TriangleParameter at = q.local(t.at[k]);
      lanes.at[k][0][l] = at.u;
      lanes.at[k][1][l] = at.v;
      for (std::size_t a = 0; a < 3; ++a) lanes.corner[k][a][l] = t.corner[k][a];
    }
    for (std::size_t a = 0; a < 3; ++a) {
      lanes.origin[a][l] = q.origin_[a];
      lanes.u[a][l] = q.u_[a];
      lanes.v[a][l] = q.v_[a];
      lanes.uu[a][l] = static_cast<double>(q.uu_[a]);
      lanes.uv[a][l] = static_cast<double>(q.uv_[a]);
      lanes.vv[a][l] = static_cast<double>(q.vv_[a]);
    }
  }
  kernels::flatness(lanes);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const double error = lanes.error[i];
    out[i] = {error < INFINITY ? error : INFINITY, lanes.corner_gap[i]};
  }
}

}  // namespace snug
