#include "field_colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <snug/bounds/enclosure.h>
#include <snug/patch/evaluate.h>
#include <snug/query/closest.h>
#include <snug/surface/evaluate.h>
#include <support/parallel.h>

namespace snug::command {
namespace {

// Lightness carries the same information as blue and yellow.
Colour ramp(double share) {
  constexpr std::array<Colour, 5> stops{Colour::hex(0x3a2a78), Colour::hex(0x3b6c97), Colour::hex(0x3fa58c),
                                        Colour::hex(0x9fd05a), Colour::hex(0xf8e75b)};
  const double at = std::clamp(share, 0.0, 1.0) * (stops.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), stops.size() - 2);
  const double rest = at - static_cast<double>(i);
  const auto blend = [&](double a, double b) { return a + rest * (b - a); };
  return {blend(stops[i].red, stops[i + 1].red), blend(stops[i].green, stops[i + 1].green),
          blend(stops[i].blue, stops[i + 1].blue)};
}

Colour colour_of_kind(const Kind& kind) {
  if (kind.polynomial()) return Colour::hex(0xc9ced6);
  // Those of Okabe and Ito, distinct without colour vision.
  constexpr std::array<std::uint32_t, 7> codes{0xe69f00, 0x56b4e9, 0x009e73, 0xf0e442,
                                               0x0072b2, 0xd55e00, 0xcc79a7};
  return Colour::hex(codes[kind.id().index() % codes.size()]);
}

PatchId patch_of(const LimitSurface& surface, const QuickHit& hit) {
  return PatchId(surface.patches_of(hit.patch.owner).begin + hit.patch.part);
}

// The parameters of a hit on its patch; place_of() of a quad's halves, turned round.
TriangleParameter on_patch(const LimitSurface& surface, const QuickHit& hit) {
  const auto [owner, corner, u, v] = hit.at;
  if (surface.rules().triangular()) return {u, v};
  return hit.patch.part % 2 == 0 ? TriangleParameter{u - v, v} : TriangleParameter{v - u, 1 - v};
}

// A number at the places of a lattice on each patch, linear between them.
class Field {
 public:
  Field(const LimitSurface& surface, std::uint32_t steps, int threads, const WorkMonitor& monitor,
        const std::function<double(PatchId, const PatchEvaluator&, TriangleParameter)>& value)
      : surface_(surface), steps_(steps), values_(surface.patch_count() * places()) {
    parallel_for(surface.patch_count(), threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        const PatchId patch(p);
        if (!surface.has_patch(patch)) continue;
        monitor.checkpoint();
        const PatchEvaluator evaluate_at(surface, patch);
        for (std::uint32_t j = 0; j <= steps_; ++j) {
          for (std::uint32_t i = 0; i + j <= steps_; ++i) {
            const double v = static_cast<double>(j) / steps_,
                         u = std::fmin(static_cast<double>(i) / steps_, 1 - v);
            values_[p * places() + place(i, j)] = value(patch, evaluate_at, {u, v});
          }
        }
      }
    });
  }

  [[nodiscard]] double at(const QuickHit& hit) const {
    const double* const values = values_.data() + patch_of(surface_, hit).index() * places();
    const TriangleParameter at = on_patch(surface_, hit);
    const double x = at.u * steps_, y = at.v * steps_;
    auto i = static_cast<std::uint32_t>(std::clamp(x, 0.0, steps_ - 1.0)),
         j = static_cast<std::uint32_t>(std::clamp(y, 0.0, steps_ - 1.0));
    while (i + j >= steps_) --(i > j ? i : j);
    const double u = x - i, v = y - j;
    const double a = values[place(i + 1, j)], b = values[place(i, j + 1)];
    if (u + v <= 1) return (1 - u - v) * values[place(i, j)] + u * a + v * b;
    if (i + j + 2 > steps_) return (u * a + v * b) / (u + v);
    return (u + v - 1) * values[place(i + 1, j + 1)] + (1 - v) * a + (1 - u) * b;
  }
  // The number that a share of all is below of.
  [[nodiscard]] double quantile(double share, bool absolute) const {
    std::vector<double> sorted = values_;
    if (absolute) {
      for (double& x : sorted) x = std::fabs(x);
    }
    const auto which =
        sorted.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(sorted.size() - 1));
    std::nth_element(sorted.begin(), which, sorted.end());
    return *which;
  }

 private:
  [[nodiscard]] std::size_t places() const { return std::size_t{steps_ + 1} * (steps_ + 2) / 2; }
  [[nodiscard]] std::size_t place(std::uint32_t i, std::uint32_t j) const {
    return std::size_t{j} * (steps_ + 1) - std::size_t{j} * (j - std::size_t{1}) / 2 + i;
  }

  const LimitSurface& surface_;
  std::uint32_t steps_;
  std::vector<double> values_;
};

// From the changes of the normal over small steps towards the middle of the patch.
double mean_curvature(const PatchEvaluator& evaluate_at, TriangleParameter at) {
  constexpr double step = 1e-3;
  const double inwards_u = at.u > 1.0 / 3 ? -step : step, inwards_v = at.v > 1.0 / 3 ? -step : step;
  const TriangleParameter first{at.u + 0.01 * (1.0 / 3 - at.u), at.v + 0.01 * (1.0 / 3 - at.v)};
  const SurfacePoint here = evaluate_at(first), along_u = evaluate_at({first.u + inwards_u, first.v}),
                     along_v = evaluate_at({first.u, first.v + inwards_v});
  if (!here.normal || !along_u.normal || !along_v.normal) return 0;
  const Vector3 xu = along_u.point - here.point, xv = along_v.point - here.point,
                nu = *along_u.normal - *here.normal, nv = *along_v.normal - *here.normal;
  const double e = dot(xu, xu), f = dot(xu, xv), g = dot(xv, xv), area = e * g - f * f;
  const double change = dot(nu, xu) * g - (dot(nu, xv) + dot(nv, xu)) * f + dot(nv, xv) * e;
  return area > 0 && std::isfinite(change / area) ? change / (2 * area) : 0;
}

std::shared_ptr<Field> distances(const PlacedSurface& surface, const PlacedSurface& other, int threads,
                                 const WorkMonitor& monitor) {
  constexpr std::uint32_t steps = 8;
  const SurfaceBvh model(limit_of(other.surface()));
  const Motion to_other = other.pose().inverse() * surface.pose();
  // All points first, so that they are asked for together.
  std::vector<Point3> points;
  const auto collect = [&](PatchId, const PatchEvaluator& evaluate_at, TriangleParameter at) {
    points.push_back(to_other.apply(evaluate_at(at).point));
    return 0.0;
  };
  static_cast<void>(Field(limit_of(surface.surface()), steps, 1, monitor, collect));
  Precision how;
  how.absolute = 1e-3 * other.surface().size();
  const std::vector<ClosestPoint> found =
      closest_point(model, points, how, {.threads = threads, .monitor = &monitor});
  std::size_t next = 0;
  return std::make_shared<Field>(
      limit_of(surface.surface()), steps, 1, monitor,
      [&](PatchId, const PatchEvaluator&, TriangleParameter) { return found[next++].distance.upper; });
}

// Of each patch the longest side of its interval triangle's boxes, in units of the largest; less than a thousandth of
// that is as good as nothing.
std::vector<double> thicknesses(const LimitSurface& surface, int threads, const WorkMonitor& monitor) {
  std::vector<double> sides(surface.patch_count());
  parallel_for(sides.size(), threads, [&](std::size_t begin, std::size_t end) {
    BoundingPoints points;
    for (std::size_t p = begin; p < end; ++p) {
      if (!surface.has_patch(PatchId(p))) continue;
      monitor.checkpoint();
      const Patch patch = surface.patch(PatchId(p));
      bounding_points(surface.library(), patch, points);
      const IntervalTriangle triangle = interval_simplex<3>(points, limit_corners(patch));
      for (const Box3& box : triangle.corner) sides[p] = std::max(sides[p], longest_side(box));
    }
  });
  const double largest = sides.empty() ? 0 : *std::max_element(sides.begin(), sides.end());
  for (double& side : sides) {
    side = largest > 0 && std::isfinite(largest) ? 1 + std::log10(std::max(side / largest, 1e-3)) / 3 : 0;
  }
  return sides;
}

}  // namespace

std::function<Colour(const QuickHit&)> colours_by(std::string_view name, const PlacedSurface& surface,
                                                  const PlacedSurface& other, int threads,
                                                  const WorkMonitor& monitor) {
  const LimitSurface* const limit = &limit_of(surface.surface());
  if (name == "level") {
    return [](const QuickHit& hit) { return ramp(hit.level / 6.0); };
  }
  if (name == "thickness") {
    const auto shares = std::make_shared<std::vector<double>>(thicknesses(*limit, threads, monitor));
    return [limit, shares](const QuickHit& hit) { return ramp((*shares)[patch_of(*limit, hit).index()]); };
  }
  if (name == "kind") {
    return [limit](const QuickHit& hit) { return colour_of_kind(limit->kind(patch_of(*limit, hit))); };
  }
  if (name == "curvature") {
    const auto field = std::make_shared<Field>(
        *limit, 4, threads, monitor, [](PatchId, const PatchEvaluator& evaluate_at, TriangleParameter at) {
          return mean_curvature(evaluate_at, at);
        });
    const double most = field->quantile(0.95, true);
    return [field, most](const QuickHit& hit) {
      return ramp(most > 0 ? 0.5 + field->at(hit) / (2 * most) : 0.5);
    };
  }
  const auto field = distances(surface, other, threads, monitor);
  const double least = field->quantile(0, false), most = field->quantile(1, false);
  return [field, least, most](const QuickHit& hit) {
    return ramp(most > least ? (field->at(hit) - least) / (most - least) : 0);
  };
}

}  // namespace snug::command
