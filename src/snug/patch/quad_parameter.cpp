#include <snug/patch/quad_parameter.h>

#include <snug/base/error.h>
#include <snug/geometry/rounding.h>

namespace snug {
namespace {

// A piece that is half of a quad, and a parameter on that quad.
struct Half {
  Patch piece;
  unsigned part;
  QuadParameter at;
  double scale = 1;  // derivative of `at` along the whole quad's parameter
};

bool at_corner(QuadParameter p) { return (p.u == 0 || p.u == 1) && (p.v == 0 || p.v == 1); }

// Down to a polynomial piece, or to where the parameter is a corner: doubling, and 2 u - 1 from 1/2 on, are exact. The
// quarters at the corners 0 and 2 of a triangle are halves of the same sort; the quarter at its corner 1 has one of each,
// its children 1 and 3.
Half descend(const Patch& patch, QuadParameter at) {
  Half here{patch, part_of(at), at};
  while (!here.piece.kind->polynomial() && !at_corner(here.at) &&
         here.piece.path.level() < PiecePath::max_level) {
    const bool right = here.at.u >= 0.5, upper = here.at.v >= 0.5;
    here.at = {right ? 2 * here.at.u - 1 : 2 * here.at.u, upper ? 2 * here.at.v - 1 : 2 * here.at.v};
    here.scale *= 2;
    unsigned child = 1;
    if (right == upper) {
      child = right == (here.part == 0) ? 2 : 0;
    } else if (part_of(here.at) != here.part && here.at.u != here.at.v) {
      child = 3;
      here.part = 1 - here.part;
    }
    here.piece = split(here.piece, child);
  }
  return here;
}

// Part 0 has the corners (0,0), (1,0), (1,1), part 1 has (1,1), (0,1), (0,0). One difference is rounded.
TriangleParameter on_triangle(const Half& here) {
  const auto [u, v] = here.at;
  return here.part == 0 ? TriangleParameter{u - v, v} : TriangleParameter{v - u, 1 - v};
}

// What the roundings of on_triangle() move a point by: parameters by one roundoff of 1, points by at most 2 degree
// largest as much in a polynomial piece; elsewhere the parameter is a corner.
double slack(const Half& here) { return enlarged(64 * unit_roundoff * here.piece.largest); }

}  // namespace

LimitPoint limit_point(const Patch& patch, QuadParameter at) { return limit_frame(patch, at).point; }

LimitFrame limit_frame(const Patch& patch, QuadParameter at) {
  require_value(at.u >= 0 && at.u <= 1 && at.v >= 0 && at.v <= 1,
                "a parameter is outside its quad: u and v must be from 0 to 1");
  const Half here = descend(patch, at);
  LimitFrame frame = limit_frame(here.piece, on_triangle(here));
  frame.point.error += slack(here);
  if (frame.differentiable) {
    const std::array<Vector3, 2> t = frame.tangents;
    const double sign = here.part == 0 ? 1 : -1;
    frame.tangents = {sign * here.scale * t[0], sign * here.scale * (t[1] - t[0])};
    // The rounding of on_triangle(), too: second derivatives are at most 1024 largest.
    if (frame.tangent_error) {
      frame.tangent_error =
          enlarged(here.scale * (2 * *frame.tangent_error + 8192 * unit_roundoff * here.piece.largest));
    }
  }
  return frame;
}

}  // namespace snug
