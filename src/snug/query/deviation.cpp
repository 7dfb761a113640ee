#include <snug/distance.h>
#include <snug/search/surface_data.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <snug/geometry/rounding.h>
#include <snug/patch/evaluate.h>
#include <snug/query/hausdorff.h>
#include <snug/query/pair_queries.h>
#include <snug/search/piece_cache.h>
#include <snug/search/winding.h>
#include <snug/surface/evaluate.h>
#include <snug/surface/unscale.h>
#include <support/error.h>
#include <support/names.h>
#include <support/run.h>
#include <support/scaling.h>

namespace snug {
namespace {

// In common units: below, roundings would be most of an interval.
constexpr double min_precision = 0x1p-37;
// Errors of quadratics: at first a share of the size, then smaller by a factor where that is not enough, at
// last a share of the precision.
constexpr double first_error_share = 0x1p-12, next_share = 0x1p-3, last_share = 0x1p-3;
// Most quadratics of a set that is refined: of the budget one for so many parts, and beside them a few.
constexpr std::uint64_t parts_a_piece = 8, min_pieces = 1u << 17;

// A set in units in which the largest coordinate of both is in [1, 2), and whether it could not be made as fine as was wanted.
struct ComparedSet {
  PieceSet pieces;
  bool is_full = false;
};

// Of a surface, in units of which a mesh unit is `scale` many.
ComparedSet compared(const LimitSurface& surface, PowerOfTwo scale, double error, const Run& run) {
  ComparedSet set{
      {surface, error, run.threads, stop_only(run), UINT64_MAX, scale * surface.scale().inverse()}};
  for (std::size_t i = 0; i < set.pieces.size(); ++i) {
    if (!std::isfinite(set.pieces.error(i))) {
      throw InputError(InputProblem::unrepresentable,
                       "deviation: a patch of the surface does not fit doubles; scale the mesh");
    }
  }
  set.pieces.prepare(run.threads);
  return set;
}

ComparedSet compared(std::span<const Point3> points, std::span<const std::array<std::uint32_t, 3>> triangles,
                     PowerOfTwo scale, const Run& run) {
  ComparedSet set{PieceSet(points, triangles, scale)};
  set.pieces.prepare(run.threads);
  return set;
}

// Makes what `which` names finer; the piece that each one is a part of, none where nothing was done.
std::vector<std::uint32_t> refine(ComparedSet& set, std::span<const std::uint8_t> which, double error,
                                  const Run& run) {
  const std::uint64_t most = std::max<std::uint64_t>(
      min_pieces + run.max_splits.value_or(default_splits::deviation) / parts_a_piece, set.pieces.size());
  std::vector<std::uint32_t> origins = set.pieces.refine(which, error, run.threads, stop_only(run), most);
  set.is_full = origins.empty() && set.pieces.is_surface();
  set.pieces.prepare(run.threads);
  return origins;
}

// Distance of a set, or of its part on one side, from the other set.
class HausdorffBound {
 public:
  HausdorffBound(const PieceSet& from, const PieceSet& to, HausdorffOptions options)
      : from_(from), to_(to), options_(std::move(options)), active_(from.size()) {
    for (std::size_t i = 0; i < active_.size(); ++i) active_[i] = static_cast<std::uint32_t>(i);
  }

  void resolve(bool last, const WorkMonitor& monitor) {
    unresolved_ = snug::resolve(from_, active_, to_, options_, last, farthest_, monitor);
    if (!farthest_.at) return;
    keep(farthest_.from, *farthest_.at, farthest_.to);
    farthest_.at.reset();
  }
  [[nodiscard]] bool resolved() const { return unresolved_.empty(); }
  [[nodiscard]] bool open() const { return !active_.empty(); }
  [[nodiscard]] bool ended() const { return farthest_.ended; }

  // Marks the pieces whose errors are in the way.
  void mark(const PieceSet& of, std::span<std::uint8_t> marks) const {
    for (const Unresolved& u : unresolved_) {
      if (&of == &from_) {
        marks[u.piece] = 1;
      } else {
        mark_near(to_, from_[u.piece], u.reach, marks);
      }
    }
  }
  // After refinement of its own set: `origins` as from refine(), empty where that did nothing.
  void go_on(std::span<const std::uint32_t> origins) {
    active_.clear();
    if (origins.empty()) {
      for (const Unresolved& u : unresolved_) active_.push_back(u.piece);
      std::sort(active_.begin(), active_.end());
      return;
    }
    std::vector<std::uint32_t> left;
    left.reserve(unresolved_.size());
    for (const Unresolved& u : unresolved_) left.push_back(u.piece);
    std::sort(left.begin(), left.end());
    for (std::size_t i = 0; i < origins.size(); ++i) {
      if (std::binary_search(left.begin(), left.end(), origins[i])) {
        active_.push_back(static_cast<std::uint32_t>(i));
      }
    }
  }
  [[nodiscard]] const PieceSet& from() const { return from_; }

  [[nodiscard]] OneSidedDistance answer(PowerOfTwo back) {
    if (!found_) {
      // Nothing is farther away than 0: any point will do.
      const BoundedPoint first = from_.point(0, {});
      keep(first, {0, {}}, nearest_foot(to_, from_[0].corners[0]));
    }
    OneSidedDistance result;
    result.distance = {unscaled_down(std::max(0.0, farthest_.lower), back),
                       require_representable(unscaled_up(farthest_.upper, back))};
    const BoundedPoint from = unscaled(from_point_, back);
    result.from = {require_representable(from.position), from.error, at_};
    result.to = require_representable(back.apply(to_point_));
    return result;
  }

 private:
  void keep(const BoundedPoint& from, const std::pair<std::uint32_t, TriangleParameter>& at,
            const QuadraticFoot& to) {
    found_ = true;
    from_point_ = from;
    at_ = from_.place(at.first, at.second);
    to_point_ = to_.point(to.piece, to.at).position;
  }

  const PieceSet& from_;
  const PieceSet& to_;
  HausdorffOptions options_;
  std::vector<std::uint32_t> active_;
  std::vector<Unresolved> unresolved_;
  Farthest farthest_;
  bool found_ = false;
  BoundedPoint from_point_;
  Point3 to_point_;
  std::optional<Place> at_;
};

// Is a point, in common units, inside of a closed surface?
SideTest side_test(const SurfaceBvh& model, PowerOfTwo from_common, bool inside) {
  auto workspace = std::make_shared<PieceCache>(model);
  return [workspace, from_common, inside](const Point3& point, double error) -> std::optional<bool> {
    workspace->begin();
    const Point3 own = from_common.apply(point);
    // More than 10^12 sizes away.
    if (!(max_abs(own - Point3{}) <= 0x1p40)) return !inside;
    const double own_error = from_common.apply(error) + 2 * underflow_error;
    const std::optional<int> number = winding_number(*workspace, own, own_error);
    return number ? std::optional((*number != 0) == inside) : std::nullopt;
  };
}

// Options in common units.
struct ScaledOptions {
  ScaledOptions(const DeviationOptions& options, const LimitSurface& surface, PowerOfTwo of_candidate)
      : scale(std::min(surface.scale().exponent(), of_candidate.exponent())),
        size(scale.apply(std::min(surface.size(), std::numeric_limits<double>::max()))) {
    if (options.absolute) {
      require_value(*options.absolute > 0 && std::isfinite(*options.absolute),
                    "deviation: the precision must be finite and greater than 0");
      precision = scale.apply(*options.absolute);
      if (precision < min_precision) {
        throw InputError(InputProblem::value, "deviation: doubles allow no precision below " +
                                                  shortest(scale.inverse().apply(min_precision)) +
                                                  " for coordinates of this size; ask for that or more");
      }
    } else {
      precision = std::max(1e-4 * size, min_precision);
    }
    if (options.threshold) {
      require_length(*options.threshold, "deviation: the threshold");
      threshold = scale.apply(*options.threshold) * (1 - 4 * unit_roundoff);
    }
  }
  [[nodiscard]] HausdorffOptions options(const Run& run) const {
    // Less by the roundings of the way back.
    return {.precision = precision * (1 - 0x1p-10),
            .threshold = threshold,
            .budget = run.max_splits.value_or(default_splits::deviation),
            .threads = run.threads};
  }

  [[nodiscard]] double last_error() const { return last_share * precision; }
  [[nodiscard]] double first_error() const { return std::max(first_error_share * size, last_error()); }

  PowerOfTwo scale;  // from mesh units
  double size;
  double precision = 0;
  std::optional<double> threshold{};
};

// Is the interval as narrow as it was asked for, or does it answer the question?
bool is_reached(const Interval& distance, const DeviationOptions& options, double precision) {
  if (options.threshold && (distance.upper <= *options.threshold || distance.lower > *options.threshold)) {
    return true;
  }
  return distance.upper - distance.lower <= precision;
}

DeviationVerdict verdict_of(const Deviation& found, double threshold) {
  const Interval &there = found.from_surface.distance, &back = found.from_candidate.distance;
  if (there.lower > threshold || back.lower > threshold) return DeviationVerdict::exceeds;
  return there.upper <= threshold && back.upper <= threshold ? DeviationVerdict::within
                                                             : DeviationVerdict::undecided;
}

OneSidedDistance larger_of(const OneSidedDistance& a, const OneSidedDistance& b) {
  OneSidedDistance result = a.distance.lower >= b.distance.lower ? a : b;
  result.distance.upper = std::max(a.distance.upper, b.distance.upper);
  return result;
}

Deviation compare(const SurfaceBvh& model, ComparedSet surface, ComparedSet candidate,
                  const ScaledOptions& asked, const DeviationOptions& options, const Run& run) {
  std::vector<HausdorffBound> directions;
  directions.emplace_back(surface.pieces, candidate.pieces, asked.options(run));
  if (options.solid) {
    const PowerOfTwo from_common = model.surface().scale() * asked.scale.inverse();
    for (const bool inside : {true, false}) {
      HausdorffOptions one_side = asked.options(run);
      one_side.make_side_test = [&model, from_common, inside] {
        return side_test(model, from_common, inside);
      };
      directions.emplace_back(candidate.pieces, surface.pieces, std::move(one_side));
    }
  } else {
    directions.emplace_back(candidate.pieces, surface.pieces, asked.options(run));
  }

  const WorkMonitor quiet = stop_only(run);
  double error = asked.first_error();
  double done = 0;
  const auto all_resolved = [&] {
    return std::all_of(directions.begin(), directions.end(),
                       [](const HausdorffBound& q) { return q.resolved(); });
  };
  for (;;) {
    const bool last = error <= asked.last_error() || surface.is_full || candidate.is_full;
    for (HausdorffBound& direction : directions) {
      if (!direction.open()) continue;
      direction.resolve(last, quiet);
      done += (1 - done) / static_cast<double>(2 * directions.size());
      monitor_of(run).report(done);
    }
    if (last || all_resolved()) break;
    error = std::max(next_share * error, asked.last_error());
    std::array<ComparedSet*, 2> sets{&surface, &candidate};
    std::array<std::vector<std::uint8_t>, 2> marks;
    for (std::size_t i = 0; i < 2; ++i) {
      marks[i].assign(sets[i]->pieces.size(), 0);
      for (const HausdorffBound& direction : directions) direction.mark(sets[i]->pieces, marks[i]);
    }
    std::array<std::vector<std::uint32_t>, 2> origins;
    for (std::size_t i = 0; i < 2; ++i) origins[i] = refine(*sets[i], marks[i], error, run);
    for (HausdorffBound& direction : directions)
      direction.go_on(origins[&direction.from() == &surface.pieces ? 0 : 1]);
  }

  const PowerOfTwo back = asked.scale.inverse();
  Deviation result;
  result.from_surface = directions[0].answer(back);
  result.from_candidate = directions[1].answer(back);
  if (options.solid) {
    result.inside = result.from_candidate;
    result.outside = directions[2].answer(back);
    result.from_candidate = larger_of(*result.inside, *result.outside);
  }
  if (options.threshold) result.verdict = verdict_of(result, *options.threshold);
  const double precision = unscaled_up(asked.precision, back);
  bool reached = is_reached(result.from_surface.distance, options, precision) &&
                 is_reached(result.from_candidate.distance, options, precision);
  for (const auto& side : {result.inside, result.outside}) {
    if (side) reached = reached && is_reached(side->distance, options, precision);
  }
  const bool spent =
      surface.is_full || candidate.is_full ||
      std::any_of(directions.begin(), directions.end(), [](const HausdorffBound& q) { return q.ended(); });
  result.outcome = outcome_of(reached, spent);
  monitor_of(run).report(1);
  return result;
}

// Of points, three a triangle in the messages.
double largest_coordinate(std::span<const Point3> points) {
  double largest = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_finite(points[i])) {
      throw InputError(InputProblem::value, "deviation: a corner of triangle " + std::to_string(i / 3) +
                                                " of the candidate is not finite; give three numbers");
    }
    largest = std::max(largest, max_abs(points[i] - Point3{}));
  }
  return largest;
}

void require_closed_if_solid(const SurfaceBvh& model, const DeviationOptions& options) {
  if (options.solid) static_cast<void>(model.solid());
}

constexpr auto verdict_names =
    std::to_array<Named<DeviationVerdict>>({{"within", DeviationVerdict::within},
                                            {"exceeds", DeviationVerdict::exceeds},
                                            {"undecided", DeviationVerdict::undecided}});

}  // namespace

const char* name_of(DeviationVerdict verdict) { return name_in(verdict_names, verdict); }

Deviation deviation(const Surface& surface, std::span<const Triangle> candidate,
                    const DeviationOptions& options, const Run& run) {
  require_value(!candidate.empty(), "deviation: the candidate has no triangles");
  require_value(candidate.size() < WideBvh::leaf_bit,
                "deviation: the candidate has more than 2^31 triangles; compare parts of it");
  static_assert(sizeof(Triangle) == 3 * sizeof(Point3));
  return deviation(surface, {candidate.front().data(), 3 * candidate.size()}, {}, options, run);
}

Deviation deviation(const Surface& surface, std::span<const Point3> points,
                    std::span<const std::array<std::uint32_t, 3>> triangles, const DeviationOptions& options,
                    const Run& run) {
  const SurfaceBvh& model = surface.data()->bvh();
  const double largest = largest_coordinate(points);
  // Zero fits any scale.
  const PowerOfTwo own = largest > 0 ? PowerOfTwo::normalising(largest) : model.surface().scale();
  const ScaledOptions asked(options, model.surface(), own);
  require_closed_if_solid(model, options);
  return compare(model, compared(model.surface(), asked.scale, asked.first_error(), run),
                 compared(points, triangles, asked.scale, run), asked, options, run);
}

Deviation deviation(const Surface& surface, const Surface& candidate, const DeviationOptions& options,
                    const Run& run) {
  const SurfaceBvh& model = surface.data()->bvh();
  const LimitSurface& other = candidate.data()->bvh().surface();
  const ScaledOptions asked(options, model.surface(), other.scale());
  require_closed_if_solid(model, options);
  return compare(model, compared(model.surface(), asked.scale, asked.first_error(), run),
                 compared(other, asked.scale, asked.first_error(), run), asked, options, run);
}

}  // namespace snug
