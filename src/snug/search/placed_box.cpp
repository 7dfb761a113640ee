#include <snug/search/placed_box.h>

#include <cmath>

#include <snug/geometry/rounding.h>

namespace snug {
namespace {

constexpr Box3 everywhere{{-INFINITY, -INFINITY, -INFINITY}, {INFINITY, INFINITY, INFINITY}};

// A row without entries that are too small for Dop26::reach().
Vector3 without_tiny_entries(const Vector3& row) {
  Vector3 result = row;
  for (std::size_t k = 0; k < 3; ++k) {
    if (std::fabs(row[k]) < 0x1p-100) result[k] = 0;
  }
  return result;
}

}  // namespace

// Along each axis the image of x is row . (x - centre) + row . centre + t, whatever the rows are: no rigidity is needed.
Box3 placed_box(const SurfaceBvh& model, const Motion& pose) {
  const PowerOfTwo scale = model.surface().scale();
  if (!scale.moderate()) return everywhere;
  const Dop26& dop = model.tree().dop();
  const Vector3 centre = dop.centre() - Point3{};
  const double back = scale.inverse_factor(), size = back * (max_abs(centre) + dop.radius());
  Box3 box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Vector3 row = without_tiny_entries(pose.row(axis));
    const double t = pose.offset()[axis], middle = dot(row, centre);
    // Sums of three with |row|_1 < 1.8, and what tiny entries and reach() leave out: less than 50 u of the size.
    const double doubt = 128 * unit_roundoff * (std::fabs(t) + size) + 64 * underflow_error;
    const double lower = t + back * (middle - dop.reach(-row)) - doubt;
    const double upper = t + back * (middle + dop.reach(row)) + doubt;
    if (!std::isfinite(lower) || !std::isfinite(upper)) return everywhere;
    box.lower[axis] = rounded_down(lower);
    box.upper[axis] = rounded_up(upper);
  }
  return box;
}

}  // namespace snug
