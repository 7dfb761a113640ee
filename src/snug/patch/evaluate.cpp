#include <snug/patch/evaluate.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <snug/base/contract.h>
#include <snug/geometry/rounding.h>
#include <snug/patch/descent.h>

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

// The part of form() that holds a parameter, and where it does: a triangle split at the middle m of its edge
// 02 has w c0 + u c1 + v c2 = (w - v) c0 + u c1 + 2 v m = 2 w m + u c1 + (v - w) c2.
struct InPart {
  std::size_t part;
  PieceParameter p;
};

InPart to_part(const PolynomialForm& form, const PieceParameter& p) {
  if (form.parts == 1) return {0, p};
  const auto [w, u, v] = p.at;
  const double off = 3 * p.off + unit_roundoff;
  if (v <= w) return {0, {{w - v, u, 2 * v}, off}};
  return {1, {{2 * w, u, v - w}, off}};
}

// Limit point in a polynomial piece: first the weights of the control points, then their sum.
LimitPoint polynomial_point(const Patch& piece, const PieceParameter& parameter) {
  const PolynomialForm& form = piece.kind->form();
  const auto [part, p] = to_part(form, parameter);
  const std::size_t count = bezier_count(form.degree), controls = piece.points.size();
  std::array<double, bezier_count(max_degree)> powers;
  const auto [w, u, v] = p.at;
  with_degree(form.degree,
              [&, w = w, u = u, v = v](auto degree) { monomials<degree>(w, u, v, powers.data()); });
  const double* row = form.weights.data() + part * (form.weights.size() / form.parts);
  Vector3 point;
  for (std::size_t c = 0; c < controls; c += 4) {
    std::array<double, 4> weights{};
    for (std::size_t r = 0; r < count; ++r, row += 4) {
      for (std::size_t a = 0; a < 4; ++a) weights[a] += powers[r] * row[a];
    }
    for (std::size_t a = 0; a < std::min<std::size_t>(4, controls - c); ++a) {
      point = point + weights[a] * piece.points[c + a];
    }
  }
  // derivations/rounding.md
  const std::size_t roundings = form.degree + count + controls + 4;
  const double off = gamma_bound(roundings) + static_cast<double>(form.degree) * p.off;
  const double sum = form.rows.max_abs_sum(), row_error = form.rows.max_error();
  const double error = (off * sum + row_error) * piece.largest + (sum + row_error) * piece.error;
  return {point, enlarged(error) + 0x1p20 * underflow_error};
}

// Derivatives along the kind's u and v in a polynomial piece: de Casteljau on a triangle down to degree 1.
struct Derivatives {
  std::array<Vector3, 2> along;
  double error;  // upper bound, a coordinate
};
Derivatives polynomial_derivatives(const Patch& piece, const PieceParameter& parameter) {
  const PolynomialForm& form = piece.kind->form();
  const auto [part, p] = to_part(form, parameter);
  const auto [w, u, v] = p.at;
  std::array<Vector3, bezier_count(max_degree)> b;
  const std::size_t count = bezier_count(form.degree);
  double largest = 0;
  for (std::size_t r = 0; r < count; ++r) {
    b[r] = form.rows.apply<Vector3>(part * count + r, piece.points);
    largest = std::max(largest, max_abs(b[r]));
  }
  // derivations/rounding.md, "Normals".
  const double row_error = form.rows.result_error(piece.largest, piece.error),
               d_max = static_cast<double>(form.degree);
  const double error =
      4 * d_max * (2 * row_error + 2 * d_max * (8 * unit_roundoff + p.off) * (largest + row_error)) +
      0x1p20 * underflow_error;
  for (std::size_t degree = form.degree; degree > 1; --degree) {
    std::size_t to = 0, row = 0;
    for (std::size_t j = 0; j < degree; ++j) {
      const std::size_t length = degree + 1 - j;
      for (std::size_t i = 0; i + 1 < length; ++i) {
        b[to++] = w * b[row + i] + u * b[row + i + 1] + v * b[row + length + i];
      }
      row += length;
    }
  }
  const auto degree = static_cast<double>(form.degree);
  const Vector3 along_u = degree * (b[1] - b[0]), along_v = degree * (b[2] - b[0]);
  if (form.parts == 1) return {{along_u, along_v}, enlarged(error)};
  if (part == 0) return {{along_u, 2.0 * along_v}, enlarged(2 * error)};  // (u, 2 v)
  // (u, v - w), w = 1 - u - v:  (u, u + 2 v - 1)
  return {{along_u + along_v, 2.0 * along_v}, enlarged(3 * error)};
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
  frame.point = polynomial_point(piece, p);
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
