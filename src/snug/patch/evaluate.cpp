#include <snug/patch/evaluate.h>

#include <array>
#include <cmath>

#include <snug/base/contract.h>
#include <snug/base/rounding.h>
#include <snug/patch/descent.h>

namespace snug {
namespace {

struct Polynomial {
  std::array<Vector3, 15> points;
  double error;
  double largest;
};

Polynomial bezier_points(const Patch& patch) {
  Polynomial result;
  const Stencils& rows = patch.kind->bezier();
  result.largest = 0;
  for (std::size_t r = 0; r < 15; ++r) {
    result.points[r] = rows.apply<Vector3>(r, patch.points);
    result.largest = std::max(result.largest, max_abs(result.points[r]));
  }
  result.error = rows.result_error(patch.largest, patch.error);
  return result;
}

// De Casteljau on a triangle of degree 4 down to degree 1, whose three points give position and derivatives.
std::array<Vector3, 3> reduce_to_plane(std::array<Vector3, 15> b, double u, double v) {
  const double w = 1 - u - v;
  std::size_t degree = 4;
  while (degree > 1) {
    std::size_t to = 0, row = 0;
    for (std::size_t j = 0; j < degree; ++j) {
      const std::size_t length = degree + 1 - j;
      for (std::size_t i = 0; i + 1 < length; ++i) {
        b[to++] = w * b[row + i] + u * b[row + i + 1] + v * b[row + length + i];
      }
      row += length;
    }
    --degree;
  }
  return {b[0], b[1], b[2]};
}

// The parameter in the kind's corner order. Turning needs w = 1 - u - v, which may round; `drift` bounds
// that.
struct KindParameter {
  TriangleParameter at;
  double drift;
};

KindParameter to_kind(const Patch& patch, TriangleParameter p) {
  if (patch.first == 0) return {p, 0};
  const double w = std::fmax(0.0, 1 - p.u - p.v);
  // Kind corner c is patch corner c + first: (w, u, v) turned.
  if (patch.first == 1) return {{p.v, w}, 4 * unit_roundoff};
  return {{w, p.u}, 4 * unit_roundoff};
}

struct Located {
  Patch piece;  // polynomial, unless stopped
  TriangleParameter at;
  double turned = 1;     // derivative of the piece's u along the face's u: plus or minus 2^level
  double drift = 0;      // upper bound of the distance of parameters that roundings have made, in the piece
  bool stopped = false;  // at the depth limit: the parameter is a corner for all practical ends
};

// Splits until the parameter lies in a polynomial piece.
Located locate(const Patch& patch, TriangleParameter at) {
  Located here{patch, at};
  while (!here.piece.kind->polynomial()) {
    if (here.piece.path.level() >= PiecePath::max_level) {
      here.stopped = true;
      return here;
    }
    const Descent step = descend(here.at);
    here.piece = split(here.piece, step.child);
    here.at = step.at;
    here.turned *= step.child == 3 ? -2 : 2;
    here.drift = 2 * here.drift + (step.child == 3 ? unit_roundoff : 0);
  }
  return here;
}

LimitPoint point_of(const Polynomial& polynomial, const std::array<Vector3, 3>& plane, double u, double v,
                    double drift) {
  const double w = 1 - u - v;
  const Vector3 p = w * plane[0] + u * plane[1] + v * plane[2];
  // Twelve roundings through four levels, each weight off by two more; a parameter off by d moves the point
  // by at most 4 * 2 largest * 2 d, the derivative of a quartic being four times a difference of Bezier
  // points.
  const double error = (gamma_bound(32) + 16 * (drift + 2 * unit_roundoff)) * polynomial.largest +
                       polynomial.error + 64 * underflow_error;
  return {p, enlarged(error)};
}

LimitPoint stopped_point(const Located& here) {
  LimitPoint corner = corner_point(here.piece, 0);
  corner.error += net_size(here.piece);
  return corner;
}

std::optional<Vector3> unit_normal(const std::array<Vector3, 2>& tangents) {
  const double a = max_abs(tangents[0]), b = max_abs(tangents[1]);
  if (!(a > 0) || !(b > 0)) return std::nullopt;
  const Vector3 normal = cross((1 / a) * tangents[0], (1 / b) * tangents[1]);
  const double size = length(normal);
  // Below this the direction is rounding noise.
  if (!(size > 1e-13)) return std::nullopt;
  return (1 / size) * normal;
}

// Tangents at a corner of the patch: limits along the corner's ring, ordered counter-clockwise as the face
// sees them.
LimitFrame corner_frame(const Patch& patch, std::size_t corner) {
  LimitFrame frame;
  frame.point = corner_point(patch, corner);
  frame.differentiable = false;
  const std::size_t k = patch.to_kind(corner);
  for (std::size_t t = 0; t < 2; ++t) {
    frame.tangents[t] = patch.kind->corner_tangents().apply<Vector3>(2 * k + t, patch.points);
  }
  frame.normal = unit_normal(frame.tangents);
  return frame;
}

}  // namespace

LimitPoint corner_point(const Patch& patch, std::size_t corner) {
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

LimitPoint limit_point(const Patch& patch, TriangleParameter parameter) {
  const TriangleParameter at = checked(parameter);
  if (const std::size_t corner = corner_at(at); corner < 3) return corner_point(patch, corner);
  const Located here = locate(patch, at);
  if (here.stopped) return stopped_point(here);
  if (const std::size_t corner = corner_at(here.at); corner < 3) {
    LimitPoint point = corner_point(here.piece, corner);
    point.error += enlarged(16 * here.drift * here.piece.largest);
    return point;
  }
  const Polynomial polynomial = bezier_points(here.piece);
  const KindParameter p = to_kind(here.piece, here.at);
  return point_of(polynomial, reduce_to_plane(polynomial.points, p.at.u, p.at.v), p.at.u, p.at.v,
                  here.drift + p.drift);
}

LimitFrame limit_frame(const Patch& patch, TriangleParameter parameter) {
  const TriangleParameter at = checked(parameter);
  if (const std::size_t corner = corner_at(at);
      corner < 3 && !patch.kind->corner(patch.to_kind(corner)).regular()) {
    return corner_frame(patch, corner);
  }
  Located here = locate(patch, at);
  if (here.stopped) {
    std::size_t corner = 0;
    while (corner < 2 && here.piece.kind->corner(here.piece.to_kind(corner)).regular()) ++corner;
    LimitFrame frame = corner_frame(here.piece, corner);
    frame.point = stopped_point(here);
    return frame;
  }
  const Polynomial polynomial = bezier_points(here.piece);
  const KindParameter p = to_kind(here.piece, here.at);
  const std::array<Vector3, 3> plane = reduce_to_plane(polynomial.points, p.at.u, p.at.v);
  LimitFrame frame;
  frame.point = point_of(polynomial, plane, p.at.u, p.at.v, here.drift + p.drift);
  // The plane's corners follow the kind's; corner k of the piece is to_kind(k).
  const std::array<Vector3, 3> corner{plane[here.piece.to_kind(0)], plane[here.piece.to_kind(1)],
                                      plane[here.piece.to_kind(2)]};
  frame.tangents = {4 * here.turned * (corner[1] - corner[0]), 4 * here.turned * (corner[2] - corner[0])};
  frame.differentiable = true;
  frame.normal = unit_normal(frame.tangents);
  return frame;
}

}  // namespace snug
