#include <experiments/tightness.h>

#include <algorithm>
#include <array>
#include <memory>

#include <experiments/quantile.h>
#include <snug/patch/evaluate.h>
#include <snug/surface/limit_surface.h>
#include <support/error.h>
#include <support/parallel.h>

namespace snug {

LimitLattice::LimitLattice(const Patch& patch, int steps) : patch_(patch), steps_(steps) {
  require_value(steps >= 1, "limit lattice: there are no steps; give at least 1");
  for (int j = 0; j <= steps; ++j) {
    for (int i = 0; i + j <= steps; ++i) {
      TriangleParameter at{static_cast<double>(i) / steps, static_cast<double>(j) / steps};
      at.v = std::min(at.v, 1 - at.u);
      samples_.push_back({at, limit_point(patch, at).relative});
    }
  }
}

double LimitLattice::min_radius(const Triangle& base) const {
  const Vector3 corner = base[0] - patch_.origin;
  const TriangleFoot foot(corner, base[1] - patch_.origin, base[2] - patch_.origin);
  const auto deviation = [&](const Vector3& q) { return length(foot.rest(q)); };
  TriangleParameter best;
  double largest = -1;
  for (const Sample& sample : samples_) {
    const double d = deviation(sample.point);
    if (d > largest) largest = d, best = sample.at;
  }
  for (double step = 0.5 / steps_; step > 1e-5; step /= 2) {
    const TriangleParameter centre = best;
    for (const auto& [du, dv] : {std::array{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, -1}, {-1, 1}}) {
      TriangleParameter at;
      at.u = std::clamp(centre.u + du * step, 0.0, 1.0);
      at.v = std::clamp(centre.v + dv * step, 0.0, 1 - at.u);
      const double d = deviation(limit_point(patch_, at).relative);
      if (d > largest) largest = d, best = at;
    }
  }
  return largest;
}

std::vector<TightnessRow> measure_tightness(const TightnessOptions& options, const WorkMonitor& monitor) {
  require_value(options.nets >= 1, "tightness: there are no nets; give at least 1");
  // Of a patch and a source; 0 where rounding makes up too much of the radius.
  struct Measured {
    double ratio = 0, over_rows = 0;
  };
  const auto library = std::make_shared<BoundsCache>();
  LayoutTables tables(*library);
  std::vector<TightnessRow> rows;
  const std::size_t jobs = all_net_shapes.size() * experiment_valences.size();
  for (std::size_t job = 0; job < jobs; ++job) {
    monitor.report(static_cast<double>(job) / static_cast<double>(jobs));
    const NetShape shape = all_net_shapes[job / experiment_valences.size()];
    const std::size_t n = experiment_valences[job % experiment_valences.size()];
    std::vector<std::array<Measured, all_bound_sources.size()>> all(2 * options.nets);
    const auto measure = [&](BoundingPoints& scratch, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        monitor.checkpoint();
        const LimitSurface surface(corner_net(shape, n, options.seed + i / 2), {}, library);
        const PatchId face(i % 2 == 0 ? 0 : n / 2);
        const Patch patch = surface.patch(face);
        const LimitLattice lattice(patch, options.steps);
        double of_rows = 0;
        for (std::size_t s = 0; s < all_bound_sources.size(); ++s) {
          const OffsetTriangle offset = tables.offset(patch, all_bound_sources[s], scratch);
          if (all_bound_sources[s] == BoundSource::rows) of_rows = offset.radius;
          if (offset.radius <= 1000 * offset.rounding) continue;
          all[i][s] = {offset.radius / lattice.min_radius(offset.base), offset.radius / of_rows};
        }
      }
    };
    parallel_for_with(
        all.size(), options.threads, [] { return BoundingPoints{}; }, measure);
    for (std::size_t s = 0; s < all_bound_sources.size(); ++s) {
      std::vector<double> ratios, over_rows;
      for (const auto& patch : all) {
        if (patch[s].ratio == 0) continue;
        ratios.push_back(patch[s].ratio);
        over_rows.push_back(patch[s].over_rows);
      }
      TightnessRow row{shape, n, all_bound_sources[s], ratios.size(), 0, 0, 0, 0};
      if (!ratios.empty()) {
        row.median = quantile(ratios, 0.5);
        row.high = quantile(ratios, 0.95);
        row.most = quantile(ratios, 1);
        row.over_rows = quantile(over_rows, 0.5);
      }
      rows.push_back(row);
    }
  }
  return rows;
}

}  // namespace snug
