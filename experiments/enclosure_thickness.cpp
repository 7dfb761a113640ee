#include <experiments/enclosure_thickness.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <experiments/control_box.h>
#include <experiments/prism.h>
#include <experiments/quantile.h>
#include <snug/bounds/enclosure.h>
#include <snug/patch/evaluate.h>
#include <snug/surface/limit_surface.h>
#include <support/error.h>
#include <support/parallel.h>

namespace snug {
namespace {

// Least and largest height of what is added, along a normal.
class HeightRange {
 public:
  explicit HeightRange(const Vector3& normal) : normal_(normal) {}
  void add(const Point3& p, double radius) {
    const double height = dot(normal_, p - Point3{});
    lower_ = std::min(lower_, height - radius);
    upper_ = std::max(upper_, height + radius);
  }
  void add(const Box3& box) {
    const Vector3 half = 0.5 * (box.upper - box.lower);
    add(box.lower + half,
        std::fabs(normal_.x) * half.x + std::fabs(normal_.y) * half.y + std::fabs(normal_.z) * half.z);
  }
  [[nodiscard]] double size() const { return upper_ - lower_; }

 private:
  Vector3 normal_;
  double lower_ = INFINITY, upper_ = -INFINITY;
};

struct Measured {
  double outside = 0;
  EnclosureThickness thickness{};
};

// In the patch's own units.
Measured measure(BoundsCache& library, const Patch& patch, int steps, BoundingPoints& scratch) {
  const std::array<Vector3, 3> corners = limit_corners(patch);
  bounding_points(library, patch, scratch);
  const OffsetTriangle offset = offset_triangle(library, scratch, corners);  // refines tips
  const Prism prism = kobbelt_prism(scratch, corners);
  const Vector3 across = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const Vector3 normal = (1 / length(across)) * across;
  HeightRange of_prism(normal), of_offset(normal), of_interval(normal), of_box(normal);
  for (const Triangle& side : {prism.lower, prism.upper}) {
    for (const Point3& p : side) of_prism.add(p, 0);
  }
  for (const Point3& p : offset.base) of_offset.add(p, offset.radius);
  for (const Box3& box : interval_simplex<3>(scratch, corners).corner) of_interval.add(box);
  of_box.add(control_box(patch, scratch));
  Measured result{0, {of_prism.size(), of_offset.size(), of_interval.size(), of_box.size()}};
  for (int j = 0; j <= steps; ++j) {
    for (int i = 0; i + j <= steps; ++i) {
      TriangleParameter at{static_cast<double>(i) / steps, static_cast<double>(j) / steps};
      at.v = std::min(at.v, 1 - at.u);
      const RelativePoint point = limit_point(patch, at);
      const double outside = distance_outside(prism, patch.origin + point.relative);
      if (outside > 4 * point.error + 1e-12) result.outside = std::max(result.outside, outside);
    }
  }
  return result;
}

double median(const std::vector<Measured>& all, double EnclosureThickness::*which) {
  std::vector<double> values;
  for (const Measured& patch : all) values.push_back(patch.thickness.*which);
  return quantile(std::move(values), 0.5);
}

}  // namespace

std::vector<PrismRow> measure_prisms(const TightnessOptions& options, const WorkMonitor& monitor) {
  require_value(options.nets >= 1 && options.steps >= 1, "prisms: give at least one net and one step");
  const auto library = std::make_shared<BoundsCache>();
  std::vector<PrismRow> rows;
  const std::size_t jobs = all_net_shapes.size() * experiment_valences.size();
  for (std::size_t job = 0; job < jobs; ++job) {
    monitor.report(static_cast<double>(job) / static_cast<double>(jobs));
    const NetShape shape = all_net_shapes[job / experiment_valences.size()];
    const std::size_t n = experiment_valences[job % experiment_valences.size()];
    std::vector<Measured> all(2 * options.nets);
    const auto work = [&](BoundingPoints& scratch, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        monitor.checkpoint();
        const LimitSurface surface(corner_net(shape, n, options.seed + i / 2), {}, library);
        const PatchId face(i % 2 == 0 ? 0 : n / 2);
        all[i] = measure(*library, surface.patch(face), options.steps, scratch);
        const double unit = surface.scale().inverse().apply(1.0);
        all[i].outside *= unit;
        for (double EnclosureThickness::*which : {&EnclosureThickness::prism, &EnclosureThickness::offset,
                                                  &EnclosureThickness::interval, &EnclosureThickness::box})
          all[i].thickness.*which *= unit;
      }
    };
    parallel_for_with(
        all.size(), options.threads, [] { return BoundingPoints{}; }, work);
    PrismRow row{shape, n, all.size(), 0, 0, {}};
    for (const Measured& patch : all) {
      row.left += patch.outside > 0;
      row.outside = std::max(row.outside, patch.outside);
    }
    row.thickness = {median(all, &EnclosureThickness::prism), median(all, &EnclosureThickness::offset),
                     median(all, &EnclosureThickness::interval), median(all, &EnclosureThickness::box)};
    rows.push_back(row);
  }
  return rows;
}

}  // namespace snug
