#include <snug/bvh/frame.h>

#include <snug/geometry/rounding.h>

namespace snug {

namespace {

// Of a point with coordinates of at most `largest`. Rows of R have length at most 1 + defect, so their absolute
// sums are below 2.
double error_of(const PlacedFrame& frame, double largest) {
  const double size = 2 * frame.scale * largest + max_abs(frame.translation);
  return enlarged(8 * unit_roundoff * size) + 8 * underflow_error;
}

Rows3 transposed_product(const Rows3& a, const Rows3& b) {
  return {transposed_times(b, {a[0].x, a[1].x, a[2].x}), transposed_times(b, {a[0].y, a[1].y, a[2].y}),
          transposed_times(b, {a[0].z, a[1].z, a[2].z})};
}

Rows3 transposed(const Rows3& m) {
  return {Vector3{m[0].x, m[1].x, m[2].x}, Vector3{m[0].y, m[1].y, m[2].y}, Vector3{m[0].z, m[1].z, m[2].z}};
}

}  // namespace

double PlacedFrame::apply_error(const Point3& p) const { return error_of(*this, max_abs(p - Point3{})); }
double PlacedFrame::largest_apply_error() const { return error_of(*this, 4); }

BoundedPoint PlacedFrame::apply(const BoundedPoint& p) const {
  return {apply(p.position), enlarged(growth() * spatial_error(p.error)) + apply_error(p.position)};
}

RelativeFrame::RelativeFrame(const PlacedFrame& target, const PlacedFrame& source)
    : RelativeFrame(target, source, transposed_product(target.rows, source.rows)) {}

std::array<RelativeFrame, 2> RelativeFrame::both(const PlacedFrame& a, const PlacedFrame& b) {
  const Rows3 turn = transposed_product(a.rows, b.rows);
  return {RelativeFrame(a, b, turn), RelativeFrame(b, a, transposed(turn))};
}

RelativeFrame::RelativeFrame(const PlacedFrame& target, const PlacedFrame& source, const Rows3& turn) {
  scale = source.scale / target.scale;
  // Squares of what is beyond would leave the range of single precision.
  comparable = scale < 0x1p20 && target.scale > 0;
  if (!comparable) return;
  const double inverse = 1 / target.scale;
  for (std::size_t i = 0; i < 3; ++i) rows[i] = scale * turn[i];
  translation = transposed_times(target.rows, inverse * (source.translation - target.translation));
  const double defects = target.defect + source.defect;
  // Translations may have underflowed when they were brought to the search's units.
  slack = enlarged(16 * (defects + 16 * unit_roundoff) * (1 + scale + max_abs(translation)) +
                   8 * inverse * underflow_error) +
          0x1p-100;
  if (const double off = target.deviation + source.deviation; off > 0) {
    slack += enlarged((1 + 8 * defects) * inverse * off);
  }
  slack = static_cast<double>(static_cast<float>(slack * (1 + 0x1p-22)));
  comparable = slack < 0x1p20;
  to_world = target.scale * (1 - 8 * defects);
  from_world = (1 + 0x1p-20) / to_world;
}

}  // namespace snug
