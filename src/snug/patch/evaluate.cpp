#include <snug/patch/evaluate.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <snug/patch/descent.h>
#include <snug/patch/net_kernels.h>

namespace snug {
namespace {

// PieceParameter coordinates on a piece, in its kind's order of corners. `off` bounds their errors' sum.
struct PieceParameter {
  std::array<double, 3> at;
  double off;
};

// Drift bounds the errors of u and v; 1 - u - v is off by one roundoff more.
PieceParameter to_kind(const Patch& patch, TriangleParameter p, double drift) {
  const std::array<double, 3> at{1 - p.u - p.v, p.u, p.v};
  PieceParameter result{{}, 4 * drift + unit_roundoff};
  for (std::size_t corner = 0; corner < 3; ++corner) result.at[patch.to_kind(corner)] = at[corner];
  return result;
}

// The lattice of a polynomial piece, and a parameter on it.
struct OnLattice {
  std::array<kernels::NetPoint, max_basis_count> points;
  kernels::LatticePlace at;
  double largest, error;
};

void put_on_lattice(const Patch& piece, const PieceParameter& p, OnLattice& out) {
  static constexpr std::array<std::uint32_t, max_basis_count> in_order{0, 1, 2,  3,  4,  5,  6,  7,
                                                                       8, 9, 10, 11, 12, 13, 14, 15};
  const KindLattice& lattice = piece.kind->lattice();
  out.largest = piece.largest;
  out.error = piece.error;
  if (lattice.ghosts.row_count() > 0) {
    out.error = std::max(out.error, lattice.ghosts.result_error(piece.largest, piece.error));
  }
  for (std::size_t i = 0; i < lattice.places.size(); ++i) {
    const std::size_t place = lattice.places[i], count = piece.points.size();
    Vector3 point;
    if (place < count) {
      point = piece.points[place];
    } else {
      point = lattice.ghosts.apply<Vector3>(place - count, piece.points);
      out.largest = std::max(out.largest, max_abs(point));
    }
    out.points[i] = {point.x, point.y, point.z, 0};
  }
  const auto [w, u, v] = p.at;
  // Halves of quads run from (0,0) by (1,0) to (1,1).
  const bool half = !piece.kind->rules().triangular();
  out.at = {w, half ? u + v : u, v, in_order.data()};
}

RelativePoint polynomial_point(const Patch& piece, const PieceParameter& p) {
  OnLattice here;
  put_on_lattice(piece, p, here);
  kernels::NetPoint sum;
  kernels::sum_values(piece.kind->rules().basis, here.points.data(), here.at, sum);
  return {{sum[0], sum[1], sum[2]}, BasisBounds::value_error(here.largest, here.error, p.off)};
}

// The point, and derivatives along the kind's u and v with the error of each coordinate.
struct Derivatives {
  RelativePoint point;
  std::array<Vector3, 2> along;
  double error;
};
Derivatives polynomial_derivatives(const Patch& piece, const PieceParameter& p) {
  OnLattice here;
  put_on_lattice(piece, p, here);
  kernels::BasisSums sums;
  kernels::sum_derivatives(piece.kind->rules().basis, here.points.data(), here.at, sums);
  const auto spatial = [](const kernels::NetPoint& sum) { return Vector3{sum[0], sum[1], sum[2]}; };
  const Vector3 along_u = spatial(sums.along_u), along_v = spatial(sums.along_v);
  const bool half = !piece.kind->rules().triangular();
  return {{spatial(sums.value), BasisBounds::value_error(here.largest, here.error, p.off)},
          {along_u, half ? along_u + along_v : along_v},
          BasisBounds::derivative_error(here.largest, here.error, p.off)};
}

struct Located {
  const Patch* piece;  // polynomial, unless stopped; stays until the thread's next search
  TriangleParameter at;
  double turned = 1;     // derivative of the piece's u along the face's u: plus or minus 2^level
  double drift = 0;      // upper bound of the distance of parameters that roundings have made, in the piece
  bool stopped = false;  // at the depth limit: the parameter is a corner for all practical ends
};

// Splits until the parameter lies in a polynomial piece.
Located locate(const Patch& patch, TriangleParameter at) {
  thread_local std::array<Patch, 2> pieces;  // for their memory
  Located here{&patch, at};
  for (std::size_t next = 0; !here.piece->kind->polynomial(); next = 1 - next) {
    if (here.piece->path.level() >= PiecePath::max_level) {
      here.stopped = true;
      return here;
    }
    const Descent step = descend(here.at);
    split(*here.piece, step.child, pieces[next]);
    here.piece = &pieces[next];
    here.at = step.at;
    here.turned *= step.child == 3 ? -2 : 2;
    here.drift = 2 * here.drift + (step.child == 3 ? unit_roundoff : 0);
  }
  return here;
}

// Tangents at a corner of the patch: limits along the corner's ring, counter-clockwise as the face sees them.
LimitFrame corner_frame(const Patch& patch, std::size_t corner) {
  LimitFrame frame;
  frame.point = corner_point(patch, corner);
  frame.differentiable = false;
  const std::size_t k = patch.to_kind(corner);
  for (std::size_t t = 0; t < 2; ++t) {
    frame.tangents[t] = patch.kind->corner_tangents().apply<Vector3>(2 * k + t, patch.points);
  }
  add_normal(frame);
  return frame;
}

}  // namespace

void add_normal(LimitFrame& frame) {
  const double a = max_abs(frame.tangents[0]), b = max_abs(frame.tangents[1]);
  frame.normal.reset();
  frame.normal_error.reset();
  if (!(a > 0) || !(b > 0)) return;
  const double by_a = 1 / a, by_b = 1 / b;
  const Vector3 product = cross(by_a * frame.tangents[0], by_b * frame.tangents[1]);
  const double size = length(product);
  // Below this the direction is rounding noise.
  if (!(size > 1e-13)) return;
  const double by_size = 1 / size;
  frame.normal = by_size * product;
  if (!frame.tangent_error || !(a > 0x1p-900) || !(b > 0x1p-900)) return;
  const double a_error = spatial_error(*frame.tangent_error * by_a + 4 * unit_roundoff),
               b_error = spatial_error(*frame.tangent_error * by_b + 4 * unit_roundoff);
  const double error = 2 * (a_error + b_error) + a_error * b_error + 32 * unit_roundoff;
  if (size > 4 * error) frame.normal_error = enlarged(2 * error * by_size + 16 * unit_roundoff);
}

RelativePoint corner_point(const Patch& patch, std::size_t corner) {
  const Stencils& limits = patch.kind->corner_limits();
  return {limits.apply<Vector3>(patch.to_kind(corner), patch.points),
          limits.result_error(patch.largest, patch.error)};
}

std::array<Vector3, 3> limit_corners(const Patch& patch) {
  const Stencils& limits = patch.kind->corner_limits();
  std::array<Vector3, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) corners[k] = limits.apply<Vector3>(patch.to_kind(k), patch.points);
  return corners;
}

RelativePoint limit_point(const Patch& patch, TriangleParameter parameter) {
  const TriangleParameter at = checked(parameter);
  if (const std::size_t corner = corner_at(at); corner < 3) return corner_point(patch, corner);
  const Located here = locate(patch, at);
  if (here.stopped) return stopped_point(*here.piece);
  return polynomial_point(*here.piece, to_kind(*here.piece, here.at, here.drift));
}

LimitFrame limit_frame(const Patch& patch, TriangleParameter parameter) {
  const TriangleParameter at = checked(parameter);
  if (const std::size_t corner = corner_at(at);
      corner < 3 && !patch.kind->regular_corner(patch.to_kind(corner))) {
    return corner_frame(patch, corner);
  }
  const Located here = locate(patch, at);
  const Patch& piece = *here.piece;
  if (here.stopped) {
    std::size_t corner = 0;
    while (corner < 2 && piece.kind->regular_corner(piece.to_kind(corner))) ++corner;
    LimitFrame frame = corner_frame(piece, corner);
    frame.point = stopped_point(piece);
    return frame;
  }
  const PieceParameter p = to_kind(piece, here.at, here.drift);
  const Derivatives derivatives = polynomial_derivatives(piece, p);
  LimitFrame frame;
  frame.point = derivatives.point;
  // Derivatives along the kind's edges 01 and 02; those along the patch's are differences of these.
  const std::array<Vector3, 3> towards{Vector3{}, derivatives.along[0], derivatives.along[1]};
  const auto corner_at_plane = [&](std::size_t corner) { return towards[piece.to_kind(corner)]; };
  frame.tangents = {here.turned * (corner_at_plane(1) - corner_at_plane(0)),
                    here.turned * (corner_at_plane(2) - corner_at_plane(0))};
  frame.differentiable = true;
  frame.tangent_error = enlarged(std::fabs(here.turned) * 3 * derivatives.error);
  add_normal(frame);
  return frame;
}

}  // namespace snug
