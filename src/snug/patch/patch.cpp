#include <snug/patch/patch.h>

#include <algorithm>
#include <cmath>

#include <snug/base/contract.h>
#include <snug/geometry/rounding.h>

namespace snug {
namespace {

void measure(Patch& patch) {
  double x = 0, y = 0, z = 0;  // three chains of maxima, not one
  for (const Vector3& p : patch.points) {
    x = std::max(x, std::fabs(p.x));
    y = std::max(y, std::fabs(p.y));
    z = std::max(z, std::fabs(p.z));
  }
  patch.largest = std::max({x, y, z});
}

}  // namespace

Patch make_patch(const Kind& kind, std::uint8_t first, std::span<const Point3> all,
                 std::span<const VertexId> which) {
  Patch patch;
  make_patch(kind, first, all, which, patch);
  return patch;
}

void make_patch(const Kind& kind, std::uint8_t first, std::span<const Point3> all,
                std::span<const VertexId> which, Patch& out) {
  SNUG_EXPECT(which.size() == kind.control_count() && first < 3);
  out.kind = &kind;
  out.first = first;
  out.path = {};
  out.origin = all[which[0].index()];
  out.points.resize(which.size());
  for (std::size_t i = 0; i < which.size(); ++i) out.points[i] = all[which[i].index()] - out.origin;
  measure(out);
  out.error = enlarged(unit_roundoff * out.largest + 4 * underflow_error);
}

Patch split(const Patch& patch, unsigned child) {
  Patch piece;
  split(patch, child, piece);
  return piece;
}

void split(const Patch& patch, unsigned child, Patch& piece) {
  const bool polygon = patch.kind->key().polygon;
  const std::vector<KindChild>& children = patch.kind->children();
  SNUG_EXPECT(child < children.size() && patch.points.size() == patch.kind->control_count() &&
              &piece != &patch);
  const KindChild& step = children[polygon || child == 3 ? child : patch.to_kind(child)];
  piece.kind = step.kind;
  piece.first = static_cast<std::uint8_t>((step.first + patch.first) % 3);
  piece.path = polygon ? patch.path : patch.path.child(child);
  piece.origin = patch.origin;
  piece.points.resize(step.stencils.row_count());
  for (std::size_t r = 0; r < piece.points.size(); ++r) {
    piece.points[r] = step.stencils.apply<Vector3>(r, patch.points);
  }
  measure(piece);
  piece.error = step.stencils.result_error(patch.largest, patch.error);
}

}  // namespace snug
