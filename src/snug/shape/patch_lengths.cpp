#include <snug/shape/patch_lengths.h>

#include <algorithm>

#include <snug/geometry/rounding.h>
#include <snug/scheme/bezier.h>
#include <snug/shape/corner_asymptotics.h>

namespace snug {
namespace {

// Levels that a patch at an extraordinary corner is split before what is left is bounded by its control points,
// and patches that pass.
constexpr unsigned tip_levels = 6, passing_levels = 2;

// Derivatives along the edges of the parameters: any way from a corner, or between two points, is the image of
// a segment whose direction is a mean of those of two, or three, edges and their opposites.
PatchLengths of_polynomial(const Patch& patch) {
  const BezierRows& form = patch.kind->form();
  const std::size_t degree = form.degree, count = bezier_count(degree);
  const double error = form.rows.result_error(patch.largest, patch.error);
  std::array<double, 3> along{};  // from corner k of the kind to k + 1
  std::array<Vector3, bezier_count(max_degree)> points;
  for (std::size_t part = 0; part < form.parts; ++part) {
    for (std::size_t i = 0; i < count; ++i) {
      points[i] = form.rows.apply<Vector3>(part * count + i, patch.points);
    }
    for (std::size_t j = 0; j < degree; ++j) {
      for (std::size_t i = 0; i + j < degree; ++i) {
        const Vector3& at = points[bezier_index(degree, i, j)];
        const Vector3 u = points[bezier_index(degree, i + 1, j)] - at,
                      v = points[bezier_index(degree, i, j + 1)] - at;
        // Two parts are 0, 1, m and m, 1, 2; m is the middle of the edge 02.
        const std::array<Vector3, 3> steps = form.parts == 1 ? std::array{u, v - u, -v}
                                             : part == 0     ? std::array{u, 2 * v - u, -2 * v}
                                                             : std::array{u + v, v - u, -2 * v};
        for (std::size_t k = 0; k < 3; ++k) along[k] = std::max(along[k], length(steps[k]));
      }
    }
  }
  // A step has at most six points in it.
  const double off = spatial_error(6 * error) + 64 * unit_roundoff * (patch.largest + error);
  PatchLengths result;
  for (std::size_t k = 0; k < 3; ++k) {
    result.edge[(k + patch.first) % 3] = enlarged(static_cast<double>(degree) * (along[k] + off));
  }
  for (std::size_t k = 0; k < 3; ++k) {
    result.from_corner[k] = std::max(result.edge[k], result.edge[(k + 2) % 3]);
    result.diameter = std::max(result.diameter, result.edge[k]);
  }
  return result;
}

double diameter_of(const Patch& patch, unsigned levels) {
  if (patch.kind->polynomial()) return of_polynomial(patch).diameter;
  if (levels == 0) {
    Box3 box;
    for (const Vector3& p : patch.points) box.add(Point3{} + p);
    const double d = length(box.upper - box.lower) + spatial_error(2 * patch.error);
    return enlarged(asymptotics_of(*patch.kind).length_factor() * enlarged(d));
  }
  // Any two children have a common corner.
  double largest = 0, second = 0;
  for (unsigned child = 0; child < 4; ++child) {
    const double d = diameter_of(split(patch, child), levels - 1);
    second = std::max(second, std::min(largest, d));
    largest = std::max(largest, d);
  }
  return enlarged(largest + second);
}

// Does it split into polynomials and one patch of its own kind?
bool is_tip(const Kind& kind) {
  if (kind.transient()) return false;
  std::size_t others = 0;
  for (const KindChild& child : kind.children()) {
    if (child.kind->polynomial()) continue;
    if (child.kind != &kind) return false;
    ++others;
  }
  return others == 1;
}

}  // namespace

PatchLengths patch_lengths(const Patch& patch) {
  if (patch.kind->polynomial()) return of_polynomial(patch);
  const double d = diameter_of(patch, is_tip(*patch.kind) ? tip_levels : passing_levels);
  return {{d, d, d}, {d, d, d}, d};
}

}  // namespace snug
