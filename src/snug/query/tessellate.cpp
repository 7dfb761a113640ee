#include <snug/query/tessellate.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include <snug/geometry/rounding.h>
#include <snug/query/mesh_refinement.h>
#include <snug/search/surface_data.h>
#include <snug/surface/unscale.h>
#include <support/error.h>
#include <support/run.h>

namespace snug {
namespace {

void require_positive(const std::optional<double>& value, const char* message) {
  require_value(!value || (*value > 0 && std::isfinite(*value)), message);
}

RefinementLimits limits_of(const LimitSurface& surface, const TessellateOptions& options) {
  require_value(options.error || options.max_edge || options.max_angle || options.max_triangles ||
                    options.view || options.max_thickness,
                "tessellate: give error, max_edge, max_angle, max_triangles, view or max_thickness");
  require_positive(options.error, "tessellate: the error must be finite and positive");
  require_positive(options.max_edge, "tessellate: the longest edge must be finite and positive");
  require_positive(options.max_thickness, "tessellate: the thickness must be finite and positive");
  require_value(!options.max_angle || (*options.max_angle > 0 && *options.max_angle <= 180),
                "tessellate: the largest angle must be above 0 and at most 180 degrees");
  require_value(!options.max_triangles || *options.max_triangles > 0,
                "tessellate: the number of triangles must be positive");
  const PowerOfTwo scale = surface.scale(), back = scale.inverse();
  const double least = options.single_precision ? min_single_tolerance : min_tolerance;
  const auto scaled = [&](const std::optional<double>& length, const char* what) {
    if (!length) return double{INFINITY};
    const double result = scale.apply(*length);
    if (!(result >= least)) {
      char text[200];
      std::snprintf(
          text, sizeof text,
          "tessellate: %s of %g is too small for coordinates as large as these%s; take %.4g or more", what,
          *length, options.single_precision ? " in single precision" : "",
          rounded_up(unscaled_up(least, back) * (1 + 1e-3)));
      refuse_value(text);
    }
    return result;
  };
  RefinementLimits limits;
  limits.tolerance = scaled(options.error, "an error");
  limits.max_edge = scaled(options.max_edge, "a longest edge");
  limits.max_thickness = scaled(options.max_thickness, "a thickness");
  if (options.view) {
    require_value(is_finite(options.view->eye),
                  "tessellate: a coordinate of the eye is not finite; give three numbers");
    require_value(options.view->angle > 0 && options.view->angle < 90,
                  "tessellate: the angle under which errors are seen must be above 0 and below 90 degrees");
    limits.eye = scale.apply(options.view->eye);
    limits.slope = std::sin(options.view->angle * 3.14159265358979323846 / 180);
  }
  if (options.max_angle) limits.min_cosine = std::cos(*options.max_angle * 3.14159265358979323846 / 180);
  limits.shortest_turn =
      std::isfinite(limits.tolerance) ? limits.tolerance : 1e-6 * scale.apply(surface.size());
  return limits;
}

// The smallest error that is found for at most so many triangles, by tolerances in between.
class CountSearch {
 public:
  CountSearch(const LimitSurface& surface, const TessellateOptions& options, const RefinementLimits& limits,
              const Run& run)
      : surface_(surface),
        options_(options),
        limits_(limits),
        run_(run),
        monitor_(monitor_of(run)),
        max_splits_(run.max_splits.value_or(default_splits::tessellate)),
        max_triangles_(std::min(*options.max_triangles, max_splits_)) {}

  Tessellation run() {
    const double wanted = limits_.tolerance;
    if (std::isfinite(wanted) && attempt(wanted)) return finished(true);
    if (!attempt(INFINITY)) refuse_number();
    // So many triangles are too many at `low`; at `high` they are enough.
    double low = std::isfinite(wanted) ? wanted : 0, high = error_;
    constexpr int max_bisections = 16;
    for (int i = 0; i < max_bisections && high > least() && high > 1.02 * low; ++i) {
      monitor_.report(i / static_cast<double>(max_bisections));
      const double guess = high * static_cast<double>(count_) / static_cast<double>(max_triangles_);
      double next = low > 0 ? std::sqrt(low * high) : guess / (i == 0 ? 1.0 : 2.0);
      next = std::max({next, least(), 1.01 * low});
      if (attempt(next)) {
        high = std::min(next, error_);
      } else {
        low = next;
      }
    }
    const bool spent = max_splits_ < *options_.max_triangles && high > least();
    return finished(!std::isfinite(wanted) && !spent);
  }

 private:
  [[nodiscard]] double least() const {
    return options_.single_precision ? min_single_tolerance : min_tolerance;
  }
  // Keeps the best.
  bool attempt(double tolerance) {
    limits_.tolerance = tolerance;
    const WorkMonitor quiet = stop_only(run_);
    MeshRefinement refinement(surface_, options_, limits_, {.threads = run_.threads, .monitor = &quiet});
    if (!refinement.run(max_triangles_) || refinement.triangle_count() > max_triangles_) return false;
    const double error = surface_.scale().apply(refinement.error_bound());
    if (!best_ || error < error_) {
      error_ = error;
      count_ = refinement.triangle_count();
      best_ = refinement.take_result();
    }
    return true;
  }
  Tessellation finished(bool reached) {
    best_->outcome = outcome_of(reached, true);
    return std::move(*best_);
  }
  // Names the number that is enough, if the budget allows to find it.
  [[noreturn]] void refuse_number() {
    limits_.tolerance = INFINITY;
    MeshRefinement refinement(surface_, options_, limits_, run_);
    const bool known = refinement.run(max_splits_);
    const std::uint64_t needed = refinement.triangle_count();
    std::string text = "tessellate: ";
    text += known && needed <= *options_.max_triangles
                ? "a budget of " + std::to_string(max_splits_) + " triangles is too small"
                : std::to_string(*options_.max_triangles) + " triangles are too few";
    text += " for this mesh and what else is asked for; ";
    if (known) {
      text += "take " + std::to_string(needed) + " or more";
      if (max_splits_ < needed && needed > *options_.max_triangles) text += ", with a budget as large";
    } else {
      text += "so is the budget of " + std::to_string(max_splits_) +
              "; give more of both, or longer edges, larger angles and thicknesses";
    }
    refuse_value(text.c_str());
  }

  const LimitSurface& surface_;
  const TessellateOptions& options_;
  RefinementLimits limits_;
  Run run_;
  const WorkMonitor& monitor_;
  std::uint64_t max_splits_;
  std::uint64_t max_triangles_;  // triangles of an attempt
  std::optional<Tessellation> best_;
  double error_ = INFINITY;  // of the best, in scaled units
  std::size_t count_ = 0;
};

}  // namespace

Tessellation tessellate(const Surface& handle, const TessellateOptions& options, const Run& run) {
  const LimitSurface& surface = handle.data()->limit();
  const RefinementLimits limits = limits_of(surface, options);
  if (options.max_triangles) return CountSearch(surface, options, limits, run).run();
  MeshRefinement refinement(surface, options, limits, run);
  const bool reached = refinement.run(run.max_splits.value_or(default_splits::tessellate));
  if (!reached) refinement.find_errors();
  Tessellation result = refinement.take_result();
  result.outcome = outcome_of(reached, true);
  return result;
}

LocalTessellation tessellate(const LimitSurface& surface, const LocalTolerances& tolerances,
                             const TessellateOptions& options, const Run& run) {
  RefinementLimits limits;
  limits.local = &tolerances;
  limits.tolerance = std::max(surface.scale().apply(tolerances.least()), min_tolerance);
  MeshRefinement refinement(surface, options, limits, run);
  const bool reached = refinement.run(run.max_splits.value_or(default_splits::tessellate));
  if (!reached) refinement.find_errors();
  LocalTessellation result;
  result.mesh = refinement.take_result(&result);
  result.mesh.outcome = outcome_of(reached, true);
  return result;
}

}  // namespace snug
