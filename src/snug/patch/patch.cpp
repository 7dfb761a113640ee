#include <snug/patch/patch.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <support/contract.h>

namespace snug {
namespace {

// The largest coordinate of points that are met one by one.
class Largest {
 public:
  void add(const Vector3& p) {
    x_ = std::max(x_, std::fabs(p.x));
    y_ = std::max(y_, std::fabs(p.y));
    z_ = std::max(z_, std::fabs(p.z));
  }
  [[nodiscard]] double get() const { return std::max({x_, y_, z_}); }

 private:
  double x_ = 0, y_ = 0, z_ = 0;  // three chains of maxima, not one
};

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
  Largest largest;
  for (std::size_t i = 0; i < which.size(); ++i) {
    out.points[i] = all[which[i].index()] - out.origin;
    largest.add(out.points[i]);
  }
  out.largest = largest.get();
  out.error = enlarged(unit_roundoff * out.largest + 4 * underflow_error);
}

Patch split(const Patch& patch, unsigned child) {
  Patch piece;
  split(patch, child, piece);
  return piece;
}

namespace {

// All of a child but its points.
const KindChild& begin_child(const Patch& patch, unsigned child, Patch& piece) {
  const bool polygon = patch.kind->key().polygon;
  const std::vector<KindChild>& children = patch.kind->children();
  SNUG_EXPECT(child < children.size() && patch.points.size() == patch.kind->control_count() &&
              &piece != &patch);
  const KindChild& step = children[polygon || child == 3 ? child : patch.to_kind(child)];
  piece.kind = step.kind;
  piece.first = static_cast<std::uint8_t>((step.first + patch.first) % 3);
  piece.path = polygon ? patch.path : patch.path.child(child);
  piece.origin = patch.origin;
  piece.error = step.step->result_error(patch.largest, patch.error);
  piece.points.resize(step.control.size());
  return step;
}

// `point(r)`: new point r.
template <class PointOf>
void take_points(const KindChild& child, Patch& piece, const PointOf& point) {
  Largest largest;
  for (std::size_t i = 0; i < child.control.size(); ++i) {
    piece.points[i] = point(child.control[i]);
    largest.add(piece.points[i]);
  }
  piece.largest = largest.get();
}

}  // namespace

void split(const Patch& patch, unsigned child, Patch& piece) {
  const KindChild& step = begin_child(patch, child, piece);
  take_points(step, piece, [&](std::uint32_t r) { return step.step->apply<Vector3>(r, patch.points); });
}

void split_into_four(const Patch& patch, std::span<Patch, 4> pieces) {
  SNUG_EXPECT(!patch.kind->key().polygon);
  thread_local std::vector<Vector3> points;
  const Stencils& step = *patch.kind->children()[0].step;
  points.resize(step.row_count());
  for (std::size_t r = 0; r < points.size(); ++r) points[r] = step.apply<Vector3>(r, patch.points);
  for (unsigned child = 0; child < 4; ++child) {
    take_points(begin_child(patch, child, pieces[child]), pieces[child],
                [&](std::uint32_t r) { return points[r]; });
  }
}

}  // namespace snug
