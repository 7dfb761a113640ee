#include <snug/bounds/bound_table.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <snug/bounds/fit_kernels.h>
#include <snug/bounds/linear_programme.h>
#include <snug/geometry/rounding.h>
#include <support/contract.h>

namespace snug {
namespace {

// Widens the triangle, beside the error of the bounding points.
constexpr double margin = 1e-12;

// Images of the rows under the layout.
struct DomainPoints {
  std::vector<double> x, y;
  double error = 0;  // a coordinate
};

DomainPoints domain_points(const BoundingRows& rows, const std::vector<LayoutPoint>& layout) {
  DomainPoints points{std::vector<double>(rows.count(), 0.0), std::vector<double>(rows.count(), 0.0)};
  double largest = 0;
  for (std::size_t c = 0; c < layout.size(); ++c) {
    const double* const weight = rows.column(c);
    for (std::size_t r = 0; r < rows.count(); ++r) {
      points.x[r] += weight[r] * layout[c][0];
      points.y[r] += weight[r] * layout[c][1];
    }
    largest = std::max({largest, std::fabs(layout[c][0]), std::fabs(layout[c][1])});
  }
  points.error = rows.result_error(largest, 0);
  return points;
}

// The least triangle with these edge directions around the points, widened by their error and the margin.
std::array<LayoutPoint, 3> triangle_around(const DomainPoints& points) {
  double x = INFINITY, y = INFINITY, sum = -INFINITY;
  for (std::size_t r = 0; r < points.x.size(); ++r) {
    x = std::min(x, points.x[r]);
    y = std::min(y, points.y[r]);
    sum = std::max(sum, points.x[r] + points.y[r]);
  }
  const double by = points.error + margin;
  const double x0 = rounded_down(x - by), y0 = rounded_down(y - by);
  // Any x1, y2 with x1 + y0 and x0 + y2 at least the largest sum hold all points on the inner side.
  const double most = rounded_up(sum + 2 * by + 4 * unit_roundoff * (std::fabs(sum) + 1));
  return {{{x0, y0}, {rounded_up(most - y0), y0}, {x0, rounded_up(most - x0)}}};
}

// Points of one function over the triangle, and the planes above them.
class PlaneFitter {
 public:
  PlaneFitter(const DomainPoints& points, const std::array<LayoutPoint, 3>& triangle, double value_error)
      : triangle_(triangle),
        planes_(points.x, points.y, (triangle[0][0] + triangle[1][0] + triangle[2][0]) / 3,
                (triangle[0][1] + triangle[1][1] + triangle[2][1]) / 3),
        value_error_(value_error) {
    const double width = triangle[1][0] - triangle[0][0], height = triangle[2][1] - triangle[0][1];
    SNUG_EXPECT(width > 0 && height > 0);
    weight_error_ = enlarged(points.error / std::min(width, height) + 8 * unit_roundoff);
    for (std::size_t r = 0; r < points.x.size(); ++r) {
      one_.push_back((points.x[r] - triangle[0][0]) / width);
      two_.push_back((points.y[r] - triangle[0][1]) / height);
    }
  }

  // A plane that is above the exact function, by its values at the corners of the triangle.
  [[nodiscard]] BoundTable::CornerValues above(std::span<const double> values) const {
    const Plane plane = planes_.lowest(values);
    BoundTable::CornerValues w;
    for (std::size_t k = 0; k < 3; ++k) w[k] = plane(triangle_[k][0], triangle_[k][1]);
    const double to_one = w[1] - w[0], to_two = w[2] - w[0];
    const double missing = kernels::heights({one_.data(), two_.data(), values.data(), values.size()},
                                            {0, 0, w[0]}, {-to_one, -to_two, 1})
                               .upper;
    const double size = std::fabs(w[0]) + std::fabs(w[1]) + std::fabs(w[2]);
    const double error = enlarged(value_error_ + weight_error_ * (std::fabs(to_one) + std::fabs(to_two)) +
                                  16 * unit_roundoff * (size + 1));
    const double lift = rounded_up(missing + error);
    for (double& value : w) value = rounded_up(value + lift);
    SNUG_EXPECT(std::isfinite(w[0]) && std::isfinite(w[1]) && std::isfinite(w[2]));
    return w;
  }

 private:
  const std::array<LayoutPoint, 3>& triangle_;
  PlanesAbove planes_;
  double value_error_, weight_error_ = 0;
  std::vector<double> one_, two_;  // barycentric weights of corners 1 and 2 of the triangle
};

}  // namespace

BoundTable make_bound_table(const Kind& kind, const BoundingRows& rows) {
  return make_bound_table(kind, rows, make_layout(kind));
}

BoundTable make_bound_table(const Kind& kind, const BoundingRows& rows, std::vector<LayoutPoint> layout) {
  SNUG_EXPECT(rows.control_count() == kind.control_count() && layout.size() == kind.control_count());
  BoundTable table;
  table.layout = std::move(layout);
  const DomainPoints points = domain_points(rows, table.layout);
  table.triangle = triangle_around(points);
  const PlaneFitter fitter(points, table.triangle, rows.entry_error());
  std::vector<double> negative(rows.count());
  for (std::size_t i = laid_by_rings(kind.key()) ? 3 : 0; i < rows.control_count(); ++i) {
    const std::span<const double> values(rows.column(i), rows.count());
    table.upper.push_back(fitter.above(values));
    std::transform(values.begin(), values.end(), negative.begin(), [](double v) { return -v; });
    BoundTable::CornerValues below = fitter.above(negative);
    // The planes may cross outside the domain, at a corner of the triangle: the lower one is put lower there.
    for (std::size_t k = 0; k < 3; ++k) below[k] = std::min(-below[k], table.upper.back()[k]);
    table.lower.push_back(below);
  }
  return table;
}

}  // namespace snug
