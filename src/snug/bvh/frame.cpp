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

}  // namespace

double PlacedFrame::apply_error(const Point3& p) const { return error_of(*this, max_abs(p - Point3{})); }
double PlacedFrame::largest_apply_error() const { return error_of(*this, 4); }

BoundedPoint PlacedFrame::apply(const BoundedPoint& p) const {
  return {apply(p.position), enlarged(growth() * spatial_error(p.error)) + apply_error(p.position)};
}

RelativeFrame::RelativeFrame(const PlacedFrame& target, const PlacedFrame& source) {
  scale = source.scale / target.scale;
  // Squares of what is beyond would leave the range of single precision.
  comparable = scale < 0x1p20 && target.scale > 0;
  if (!comparable) return;
  const double inverse = 1 / target.scale;
  for (std::size_t j = 0; j < 3; ++j) {
    const Vector3 column{source.rows[0][j], source.rows[1][j], source.rows[2][j]};
    const Vector3 seen = scale * transposed_times(target.rows, column);
    for (std::size_t i = 0; i < 3; ++i) rows[i][j] = seen[i];
  }
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
