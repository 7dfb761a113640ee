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

template <class PointAt>
void gather(const Kind& kind, std::uint8_t first, const PointAt& at, Patch& out) {
  out.kind = &kind;
  out.first = first;
  out.path = {};
  out.origin = at(0);
  out.points.resize(kind.control_count());
  for (std::size_t i = 0; i < kind.control_count(); ++i) out.points[i] = at(i) - out.origin;
  measure(out);
  out.error = enlarged(unit_roundoff * out.largest + 4 * underflow_error);
}

// The control points of a child from those of the whole.
void apply(const Patch& patch, const KindChild& step, Patch& piece) {
  piece.kind = step.kind;
  piece.origin = patch.origin;
  piece.points.resize(step.stencils.row_count());
  for (std::size_t r = 0; r < piece.points.size(); ++r) {
    piece.points[r] = step.stencils.apply<Vector3>(r, patch.points);
  }
  measure(piece);
  piece.error = step.stencils.result_error(patch.largest, patch.error);
}

}  // namespace

Patch make_patch(const Kind& kind, std::uint8_t first, std::span<const Point3> points) {
  SNUG_EXPECT(points.size() == kind.control_count() && first < 3);
  Patch patch;
  gather(
      kind, first, [&](std::size_t i) { return points[i]; }, patch);
  return patch;
}

Patch make_patch(const Kind& kind, std::uint8_t first, std::span<const Point3> all,
                 std::span<const VertexId> which) {
  Patch patch;
  make_patch(kind, first, all, which, patch);
  return patch;
}

void make_patch(const Kind& kind, std::uint8_t first, std::span<const Point3> all,
                std::span<const VertexId> which, Patch& out) {
  SNUG_EXPECT(which.size() == kind.control_count() && first < 3);
  gather(
      kind, first, [&](std::size_t i) { return all[which[i].index()]; }, out);
}

Patch split(const Patch& patch, unsigned child) {
  Patch piece;
  split(patch, child, piece);
  return piece;
}

void split(const Patch& patch, unsigned child, Patch& piece) {
  SNUG_EXPECT(child < 4 && patch.points.size() == patch.kind->control_count() && &piece != &patch);
  const KindChild& step = patch.kind->children()[child < 3 ? patch.to_kind(child) : 3];
  apply(patch, step, piece);
  piece.first = static_cast<std::uint8_t>((step.first + patch.first) % 3);
  piece.path = patch.path.child(child);
}

Patch patch_of_polygon(const Patch& polygon, std::size_t part) {
  Patch piece;
  patch_of_polygon(polygon, part, piece);
  return piece;
}

void patch_of_polygon(const Patch& polygon, std::size_t part, Patch& piece) {
  const auto& children = polygon.kind->children();
  SNUG_EXPECT(polygon.kind->key().polygon && polygon.points.size() == polygon.kind->control_count());
  SNUG_EXPECT(part < children.size() && &piece != &polygon);
  apply(polygon, children[part], piece);
  piece.first = children[part].first;
  piece.path = polygon.path;
}

}  // namespace snug
