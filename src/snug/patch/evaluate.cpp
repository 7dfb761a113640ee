#include <snug/patch/evaluate.h>

#include <array>
#include <cmath>
#include <utility>

#include <snug/base/contract.h>
#include <snug/base/rounding.h>
#include <snug/patch/descent.h>

namespace snug {
namespace {

constexpr std::size_t most_points = bezier_count(max_degree);
using BezierPoints = std::array<Vector3, most_points>;

// One polynomial of a piece.
struct Polynomial {
  std::size_t degree;
  BezierPoints points;
  double error;
  double largest;
};

Polynomial bezier_points(const Patch& patch, std::size_t part) {
  const PolynomialForm& form = patch.kind->form();
  Polynomial result;
  result.degree = form.degree;
  result.largest = 0;
  const std::size_t count = bezier_count(form.degree);
  for (std::size_t r = 0; r < count; ++r) {
    result.points[r] = form.rows.apply<Vector3>(part * count + r, patch.points);
    result.largest = std::max(result.largest, max_abs(result.points[r]));
  }
  result.error = form.rows.result_error(patch.largest, patch.error);
  return result;
}

// De Casteljau on a triangle down to degree 1, whose three points give position and derivatives.
std::array<Vector3, 3> reduce_to_plane(const Polynomial& polynomial, double u, double v) {
  BezierPoints b = polynomial.points;
  const double w = 1 - u - v;
  std::size_t degree = polynomial.degree;
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

// The same in the half of a triangle that form() splits at the middle of its edge 02:
// w c0 + u c1 + v c2 = (w - v) c0 + u c1 + 2 v m = 2 w m + u c1 + (v - w) c2.
KindParameter to_part(const KindParameter& p, std::size_t& part) {
  const double w = std::fmax(0.0, 1 - p.at.u - p.at.v);
  part = p.at.v <= w ? 0 : 1;
  const double drift = 4 * p.drift + 8 * unit_roundoff;
  if (part == 0) return {{p.at.u, 2 * p.at.v}, drift};
  return {{p.at.u, p.at.v - w}, drift};
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
  Patch child;
  while (!here.piece.kind->polynomial()) {
    if (here.piece.path.level() >= PiecePath::max_level) {
      here.stopped = true;
      return here;
    }
    const Descent step = descend(here.at);
    split(here.piece, step.child, child);
    std::swap(here.piece, child);
    here.at = step.at;
    here.turned *= step.child == 3 ? -2 : 2;
    here.drift = 2 * here.drift + (step.child == 3 ? unit_roundoff : 0);
  }
  return here;
}

// Position and derivatives along the kind's u and v in a polynomial piece.
struct Evaluated {
  LimitPoint point;
  std::array<Vector3, 2> derivatives;
};

Evaluated evaluate_polynomial(const Patch& piece, KindParameter p) {
  const PolynomialForm& form = piece.kind->form();
  std::size_t part = 0;
  if (form.parts == 2) p = to_part(p, part);
  const Polynomial polynomial = bezier_points(piece, part);
  const double u = p.at.u, v = p.at.v, w = 1 - u - v;
  const auto degree = static_cast<double>(form.degree);
  const std::array<Vector3, 3> plane = reduce_to_plane(polynomial, u, v);
  Evaluated result;
  // Three roundings a level, each weight off by two more; a parameter off by d moves the point by at most
  // degree * 2 largest * 2 d, the derivative being the degree times a difference of Bezier points.
  const double error =
      (gamma_bound(8 * form.degree) + 4 * degree * (p.drift + 2 * unit_roundoff)) * polynomial.largest +
      polynomial.error + 64 * underflow_error;
  result.point = {w * plane[0] + u * plane[1] + v * plane[2], enlarged(error)};
  const Vector3 along_u = degree * (plane[1] - plane[0]), along_v = degree * (plane[2] - plane[0]);
  if (form.parts == 1) {
    result.derivatives = {along_u, along_v};
  } else if (part == 0) {  // (u, 2 v)
    result.derivatives = {along_u, 2.0 * along_v};
  } else {  // (u, 1 - u - 2 w), w = 1 - u - v:  (u, u + 2 v - 1)
    result.derivatives = {along_u + along_v, 2.0 * along_v};
  }
  return result;
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
  if (patch.kind->polynomial()) return evaluate_polynomial(patch, to_kind(patch, at)).point;
  const Located here = locate(patch, at);
  if (here.stopped) return stopped_point(here);
  if (const std::size_t corner = corner_at(here.at); corner < 3) {
    LimitPoint point = corner_point(here.piece, corner);
    point.error += enlarged(16 * here.drift * here.piece.largest);
    return point;
  }
  KindParameter p = to_kind(here.piece, here.at);
  p.drift += here.drift;
  return evaluate_polynomial(here.piece, p).point;
}

LimitFrame limit_frame(const Patch& patch, TriangleParameter parameter) {
  const TriangleParameter at = checked(parameter);
  if (const std::size_t corner = corner_at(at);
      corner < 3 && !patch.kind->regular_corner(patch.to_kind(corner))) {
    return corner_frame(patch, corner);
  }
  Located here = locate(patch, at);
  if (here.stopped) {
    std::size_t corner = 0;
    while (corner < 2 && here.piece.kind->regular_corner(here.piece.to_kind(corner))) ++corner;
    LimitFrame frame = corner_frame(here.piece, corner);
    frame.point = stopped_point(here);
    return frame;
  }
  KindParameter p = to_kind(here.piece, here.at);
  p.drift += here.drift;
  const Evaluated evaluated = evaluate_polynomial(here.piece, p);
  LimitFrame frame;
  frame.point = evaluated.point;
  // Derivatives along the kind's edges 01 and 02; those along the patch's are differences of these.
  const std::array<Vector3, 3> towards{Vector3{}, evaluated.derivatives[0], evaluated.derivatives[1]};
  const auto corner_at_plane = [&](std::size_t corner) { return towards[here.piece.to_kind(corner)]; };
  frame.tangents = {here.turned * (corner_at_plane(1) - corner_at_plane(0)),
                    here.turned * (corner_at_plane(2) - corner_at_plane(0))};
  frame.differentiable = true;
  frame.normal = unit_normal(frame.tangents);
  return frame;
}

}  // namespace snug
