#include <snug/patch/patch.h>

#include <snug/base/contract.h>
#include <snug/base/rounding.h>

namespace snug {
namespace {

void measure(Patch& patch) {
  patch.largest = 0;
  for (const Vector3& p : patch.points) patch.largest = std::max(patch.largest, max_abs(p));
}

template <class PointAt>
Patch gather(const Kind& kind, std::uint8_t first, PointAt&& at) {
  Patch patch;
  patch.kind = &kind;
  patch.first = first;
  patch.origin = at(0);
  patch.points.reserve(kind.control_count());
  for (std::size_t i = 0; i < kind.control_count(); ++i) patch.points.push_back(at(i) - patch.origin);
  measure(patch);
  patch.error = enlarged(unit_roundoff * patch.largest + 4 * underflow_error);
  return patch;
}

}  // namespace

Patch make_patch(const Kind& kind, std::uint8_t first, std::span<const Point3> points) {
  SNUG_EXPECT(points.size() == kind.control_count() && first < 3);
  return gather(kind, first, [&](std::size_t i) { return points[i]; });
}

Patch make_patch(const Kind& kind, std::uint8_t first, std::span<const Point3> all,
                 std::span<const VertexId> which) {
  SNUG_EXPECT(which.size() == kind.control_count() && first < 3);
  return gather(kind, first, [&](std::size_t i) { return all[which[i].index()]; });
}

Patch split(const Patch& patch, unsigned child) {
  SNUG_EXPECT(child < 4 && patch.points.size() == patch.kind->control_count());
  const KindChild& step = patch.kind->children()[child < 3 ? patch.to_kind(child) : 3];
  Patch piece;
  piece.kind = step.kind;
  piece.first = static_cast<std::uint8_t>((step.first + patch.first) % 3);
  piece.path = patch.path.child(child);
  piece.origin = patch.origin;
  piece.points.reserve(step.stencils.row_count());
  for (std::size_t r = 0; r < step.stencils.row_count(); ++r) {
    piece.points.push_back(step.stencils.apply<Vector3>(r, patch.points));
  }
  measure(piece);
  piece.error = step.stencils.result_error(patch.largest, patch.error);
  return piece;
}

}  // namespace snug
