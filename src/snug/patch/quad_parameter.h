#pragma once

#include <snug/patch/evaluate.h>

namespace snug {

/// A parameter on a quad with corners (0,0), (1,0), (1,1), (0,1), of which a patch is half: part 0 where v <= u, part 1
/// where v >= u.
struct QuadParameter {
  double u = 0, v = 0;
};

/// Which half a parameter lies in.
[[nodiscard]] constexpr unsigned part_of(QuadParameter p) { return p.v <= p.u ? 0 : 1; }

/// Limit point of the half of a quad that holds the parameter.
///
/// Guarantee: as limit_point(): at exactly these doubles, in corners too; a triangle's own parameters are coarser
///            near its far corners.
/// Requires:  patch: half part_of(at), whole.
/// Errors:    InputError (value) unless 0 <= u, v <= 1.
[[nodiscard]] LimitPoint limit_point(const Patch& patch, QuadParameter at);
/// The same with the derivatives along the quad's u and v, where they exist.
[[nodiscard]] LimitFrame limit_frame(const Patch& patch, QuadParameter at);

}  // namespace snug
