#include <snug/measure.h>
#include <snug/search/surface_data.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>
#include <vector>

#include <snug/geometry/interval.h>
#include <snug/patch/evaluate.h>
#include <snug/patch/quarters.h>
#include <snug/search/solid.h>
#include <snug/shape/corner_asymptotics.h>
#include <snug/shape/moment_kernel.h>
#include <snug/shape/regular_integrals.h>
#include <snug/surface/unscale.h>
#include <support/error.h>
#include <support/ordering.h>
#include <support/parallel.h>
#include <support/run.h>

namespace snug {
namespace {

constexpr double default_relative = 1e-4;
// Of a patch: pieces take a kilobyte each.
constexpr std::uint64_t max_patch_splits = 100'000;
constexpr int max_quadratic_rounds = 12;
// Regular pieces that are integrated at once: most have one part.
constexpr std::size_t max_regular = kernels::moment_lanes;

// A sum of many numbers, as in twice the precision.
class BoundedSum {
 public:
  void add(double x, double error) {
    const double sum = sum_ + x, part = sum - sum_;
    rest_ += (sum_ - (sum - part)) + (x - part);  // what the first sum lost, exactly
    sum_ = sum;
    size_ += std::fabs(x);
    error_ += error;
    ++count_;
  }
  [[nodiscard]] Interval interval() const {
    const double g = gamma_bound(count_ + 1), value = sum_ + rest_;
    const double error = error_ * (1 + g) + 2 * g * g * size_ + unit_roundoff * std::fabs(value);
    return {rounded_down(value - enlarged(error)), rounded_up(value + enlarged(error))};
  }

 private:
  double sum_ = 0, rest_ = 0, size_ = 0, error_ = 0;
  std::size_t count_ = 0;
};

// Of one patch, or of a quad: two patches.
struct PatchMeasures {
  FluxMoments moments;        // what is left at corners counts as error
  double lower = 0, gap = 0;  // of the area, what is left at corners included
  double tips = 0;            // what is not known of pieces at corners
  std::uint64_t splits = 0;
  bool stuck = false;  // in rounding, or at the end of the budget
};

// The unknown part of pieces at corners is the gap of their area, and their area times size times a weight: that much moments err.
struct Goal {
  double gap, tips, weight;
};

// A piece that is not regular, and waits to be split.
struct Net : ControlNet {
  PieceArea area{};
  Point3 middle{};
  double extent = 0;   // of the box around the points, by its diagonal
  double unknown = 0;  // gap of the area, and what moments do not know, see Goal
};

class PatchMeasurer {
 public:
  PatchMeasurer(const LimitSurface& surface, const Point3& origin, std::uint64_t patch_splits,
                const WorkMonitor& monitor)
      : surface_(surface), origin_(origin), patch_splits_(patch_splits), monitor_(monitor) {}

  [[nodiscard]] PatchMeasures run(PatchId p, const Goal& goal) {
    result_ = {};
    weight_ = goal.weight;
    pieces_.clear();
    tips_.clear();
    regular_.clear();
    surface_.patch(p, patch_);
    middle_ = patch_.origin - origin_;
    open({control_net(patch_)});
    split_tips(goal.tips);
    integrate_regular();
    narrow_area(goal.gap);
    return result_;
  }

 private:
  void open(Net net) {
    if (net.kind->polynomial()) {
      add_regular(with_ghosts(net));
    } else if (net.kind->transient() && result_.splits < patch_splits_) {
      refine(net);
    } else {
      bound_area(net);
      tips_.push_back(std::move(net));
    }
  }

  void refine(const Net& net) {
    monitor_.checkpoint();
    ++result_.splits;
    const NetQuarters quarters(net);
    for (std::size_t k = 0; k < NetQuarters::count(); ++k) {
      if (quarters.regular(k)) {
        add_regular(quarters.lattice(k));
      } else {
        open({quarters.net(k)});
      }
    }
  }

  void add_regular(const LatticeNet& net) {
    RegularPiece piece{surface_.rules().basis,          {}, net.largest, net.error, middle_,
                       unit_roundoff * max_abs(middle_)};
    for (std::size_t i = 0; i < net.lattice.size(); ++i) piece.points[i] = net.points[net.lattice[i]];
    regular_.push_back(piece);
    if (regular_.size() == max_regular) integrate_regular();
  }
  void integrate_regular() {
    std::array<FluxMoments, max_regular> sums;
    integrate(regular_, sums, pieces_);
    for (std::size_t i = 0; i < regular_.size(); ++i) {
      for (std::size_t m = 0; m < 10; ++m) {
        double& sum = result_.moments.value[m];
        sum += sums[i].value[m];
        result_.moments.error[m] += sums[i].error[m] + unit_roundoff * std::fabs(sum);
      }
    }
    regular_.clear();
  }

  // A net's piece, as far as it is known.
  void bound_area(Net& net) const {
    Box3 box;
    for (const auto& p : net.points) box.add(Point3{p[0], p[1], p[2]});
    const Vector3 sides = box.upper - box.lower;
    net.middle = box.lower + 0.5 * sides;
    const double error = net.error + 4 * unit_roundoff * net.largest, more = 2 * error;
    const double extent_sq = enlarged(length_sq({sides.x + more, sides.y + more, sides.z + more}));
    net.extent = enlarged(std::sqrt(extent_sq));
    const CornerAsymptotics& asymptotics = asymptotics_of(*net.kind);
    const double factor = asymptotics.area_factor();
    if (!(factor < INFINITY)) {
      throw InputError(
          InputProblem::refused,
          "measure: Midedge converges too slowly beside a face of so many corners; split that face "
          "or use another scheme");
    }
    const double most = enlarged(factor * extent_sq);
    net.area = {0, most, {}, most};
    if (const CornerForms* forms = asymptotics.forms())
      net.area = forms->area_of(net.points, net.middle, extent_sq, error);
    net.unknown = net.area.upper - net.area.lower + weight_ * net.extent * net.area.upper;
  }
  static bool less_known(const Net& a, const Net& b) { return a.unknown < b.unknown; }

  void split_tips(double goal) {
    const auto sum_of_tips = [&] {
      double sum = 0;
      for (const Net& tip : tips_) sum += tip.unknown;
      return enlarged(sum * (1 + gamma_bound(tips_.size())));
    };
    ordering::make_heap(tips_.data(), tips_.size(), less_known);
    double left = sum_of_tips();
    while (left > goal && !tips_.empty()) {
      const Net& largest = tips_.front();
      if (result_.splits >= patch_splits_ || largest.extent <= 64 * largest.error) {
        result_.stuck = true;
        break;
      }
      ordering::pop_heap(tips_.data(), tips_.size(), less_known);
      const Net tip = std::move(tips_.back());
      tips_.pop_back();
      const std::size_t before = tips_.size();
      left -= tip.unknown;
      refine(tip);
      for (std::size_t i = before; i < tips_.size(); ++i) left += tips_[i].unknown;
      for (std::size_t i = before; i < tips_.size(); ++i)
        ordering::push_heap(tips_.data(), i + 1, less_known);
      if (left <= goal) left = sum_of_tips();
    }
    left = sum_of_tips();
    result_.tips = left;
    for (const Net& tip : tips_) add_tip(tip);
  }

  // Moments as if the piece were where the middle m of its box is: x . N is m . F and what x is off from m.
  void add_tip(const Net& tip) {
    const Vector3 middle = middle_ + (tip.middle - Point3{});
    const double reach = max_abs(middle_) * (1 + 2 * unit_roundoff) + tip.largest + tip.error;
    const double off = 0.5 * tip.extent + 8 * unit_roundoff * reach;
    const double from_middle = off * tip.area.upper;
    const double flux = dot(middle, tip.area.flux);
    const double flux_error =
        from_middle + spatial_error(reach) * (tip.area.flux_error + gamma_bound(8) * length(tip.area.flux));
    // Along with the integrand its factors change, each by `off`.
    const double by_factor = spatial_error(from_middle);
    const auto add = [&](std::size_t m, double factor, double size, double change) {
      double& sum = result_.moments.value[m];
      sum += factor * flux;
      result_.moments.error[m] += enlarged(size * (flux_error + gamma_bound(8) * std::fabs(flux)) + change) +
                                  unit_roundoff * std::fabs(sum);
    };
    add(0, 1, 1, 0);
    for (std::size_t a = 0; a < 3; ++a) {
      const double x = middle[a], y = middle[(a + 1) % 3];
      add(1 + a, x, reach, reach * by_factor);
      add(4 + a, x * x, reach * reach, 2 * reach * reach * by_factor);
      add(7 + a, x * y, reach * reach, 2 * reach * reach * by_factor);
    }
  }

  void narrow_area(double goal) {
    heap_.clear();
    double gap = 0;
    for (std::uint32_t i = 0; i < pieces_.size(); ++i) gap += push(i);
    std::uint64_t halvings = 0;
    while (gap > goal && !heap_.empty()) {
      if (result_.splits + halvings / 4 >= patch_splits_) {
        result_.stuck = true;
        break;
      }
      const std::uint32_t i = heap_.front().second;
      ordering::pop_heap(heap_.data(), heap_.size(), std::less<>());
      heap_.pop_back();
      gap -= pieces_[i].gap();
      if (!pieces_[i].tight()) {
        pieces_[i].tighten();
      } else {
        monitor_.checkpoint();
        ++halvings;
        auto halves = pieces_[i].split();
        pieces_[i] = std::move(halves.first);
        pieces_.push_back(std::move(halves.second));
        gap += push(static_cast<std::uint32_t>(pieces_.size() - 1));
      }
      gap += push(i);
    }
    if (gap > goal) result_.stuck = true;
    result_.splits += halvings / 4;
    double lower = 0, upper = 0;
    for (const AreaPiece& piece : pieces_) {
      lower += piece.area().lower;
      upper += piece.area().upper;
    }
    for (const Net& tip : tips_) {
      lower += tip.area.lower;
      upper += tip.area.upper;
    }
    const double g = gamma_bound(pieces_.size() + tips_.size() + 2);
    result_.lower = lower * (1 - g);
    result_.gap = enlarged(upper * (1 + g) - result_.lower);
  }
  // Puts a piece in line if it can be improved; its gap.
  double push(std::uint32_t i) {
    if (pieces_[i].can_improve()) {
      heap_.emplace_back(pieces_[i].gap(), i);
      ordering::push_heap(heap_.data(), heap_.size(), std::less<>());
    }
    return pieces_[i].gap();
  }

  const LimitSurface& surface_;
  Point3 origin_;
  std::uint64_t patch_splits_;
  const WorkMonitor& monitor_;
  PatchMeasures result_;
  double weight_ = 0;
  Patch patch_;
  Vector3 middle_;
  std::vector<Net> tips_;
  std::vector<RegularPiece> regular_;  // that wait to be integrated
  std::vector<AreaPiece> pieces_;
  std::vector<std::pair<double, std::uint32_t>> heap_;
};

// Integrals in scaled units, about an origin amid the surface.
struct Totals {
  Interval area;
  std::array<Interval, 10> moments;
};

// Goals in scaled units, and how far totals are from them.
struct Answer {
  Interval area, volume;
  bool has_centroid = false;
  std::array<Interval, 3> centroid;
  std::array<Interval, 6> inertia;
  // Widths over what was asked for: at most 1 where reached.
  double area_excess = 0, solid_excess = 0;
};

double width(const Interval& x) { return x.upper - x.lower; }
double magnitude(const Interval& x) { return std::max(std::fabs(x.lower), std::fabs(x.upper)); }

double excess(double is, double wanted) {
  return is <= wanted ? is / std::max(wanted, 0x1p-900) : wanted > 0 ? is / wanted : 0x1p900;
}

void add_inertia(const Totals& totals, Answer& answer) {
  const auto first = [&](std::size_t a) { return totals.moments[1 + a] / Interval(4); };
  const auto about_centroid = [&](std::size_t m, std::size_t a, std::size_t b) {
    return totals.moments[m] / Interval(5) - first(a) * first(b) / answer.volume;
  };
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
    answer.inertia[a] = about_centroid(4 + b, b, b) + about_centroid(4 + c, c, c);
    answer.inertia[3 + a] = -about_centroid(7 + a, a, b);
  }
}

Answer answer_of(const Totals& totals, const Point3& origin, double size, double relative, bool closed) {
  Answer answer;
  answer.area = totals.area;
  answer.area_excess =
      excess(width(answer.area), relative * std::max(answer.area.upper, relative * size * size));
  if (!closed) return answer;
  answer.volume = totals.moments[0] / Interval(3);
  answer.solid_excess = excess(width(answer.volume),
                               relative * std::max(magnitude(answer.volume), relative * size * size * size));
  if (answer.volume.contains(0)) return answer;
  answer.has_centroid = true;
  for (std::size_t a = 0; a < 3; ++a) {
    answer.centroid[a] = Interval(origin[a]) + totals.moments[1 + a] / Interval(4) / answer.volume;
    answer.solid_excess = std::max(answer.solid_excess, excess(width(answer.centroid[a]), relative * size));
  }
  add_inertia(totals, answer);
  double largest = relative * std::pow(size, 5), widest = 0;
  for (const Interval& x : answer.inertia) {
    largest = std::max(largest, magnitude(x));
    widest = std::max(widest, width(x));
  }
  answer.solid_excess = std::max(answer.solid_excess, excess(widest, relative * largest));
  return answer;
}

Interval unscaled_interval(const Interval& x, PowerOfTwo back) {
  return {require_representable(unscaled_down(x.lower, back)),
          require_representable(unscaled_up(x.upper, back))};
}

Measures in_mesh_units(const Answer& answer, PowerOfTwo back, bool closed) {
  const PowerOfTwo square = back * back, cube = square * back, fifth = cube * square;
  Measures result;
  result.area = unscaled_interval(answer.area, square);
  result.area.lower = std::max(0.0, result.area.lower);
  if (!closed) return result;
  result.volume = unscaled_interval(answer.volume, cube);
  if (!answer.has_centroid) return result;
  result.centroid.emplace();
  result.inertia.emplace();
  for (std::size_t a = 0; a < 3; ++a) (*result.centroid)[a] = unscaled_interval(answer.centroid[a], back);
  for (std::size_t a = 0; a < 6; ++a) (*result.inertia)[a] = unscaled_interval(answer.inertia[a], fifth);
  return result;
}

// All patches, each until its share of a goal is reached; then again with nearer goals for those that need
// it.
class SurfaceMeasurer {
 public:
  SurfaceMeasurer(const LimitSurface& surface, const MeasureOptions& options, const Run& run)
      : surface_(surface), options_(options), run_(run), monitor_(monitor_of(run)) {
    Box3 box;
    for (std::size_t v = 0; v < surface.mesh().vertex_count(); ++v) {
      if (!surface.topology().isolated(VertexId(v))) box.add(surface.scaled_point(VertexId(v)));
    }
    for (std::size_t p = 0; p < surface.patch_count(); ++p) {
      const bool second = !surface.rules().triangular() && surface.place(PatchId(p)).part % 2 == 1;
      if (!second && surface.has_patch(PatchId(p))) patches_.emplace_back(p);
    }
    if (patches_.empty()) {
      throw InputError(
          InputProblem::refused,
          "no face has a limit surface: all are holes or touch the boundary; use another boundary rule");
    }
    size_ = longest_side(box);
    origin_ = box.lower + 0.5 * (box.upper - box.lower);
    closed_ = is_closed(surface);
    patch_splits_ = std::min<std::uint64_t>(
        run.max_splits.value_or(default_splits::measure) / patches_.size(), max_patch_splits);
    find_shares();
  }

  [[nodiscard]] Measures run() {
    const double relative = options_.relative.value_or(default_relative);
    double gap = 0.4 * relative * estimate_, tips = 0.4 * relative * estimate_;
    // Moments of inertia, about a tenth of the volume times the squared size, err by most.
    if (closed_) weight_ = estimate_ / std::max(std::fabs(volume_), relative * size_ * size_ * size_);
    Answer answer;
    for (int round = 0; round < max_quadratic_rounds; ++round) {
      // Patches may be narrower than was asked for, and the answer is not.
      bool some = round_of(gap, tips, round);
      while (!some && gap + tips > 0 && !all_stuck()) {
        gap *= 0.5;
        tips *= 0.5;
        some = round_of(gap, tips, round);
      }
      if (round > 0 && !some) break;
      answer = answer_of(totals(), origin_, size_, relative, closed_);
      if (answer.area_excess <= 1 && answer.solid_excess <= 1) break;
      if (answer.area_excess > 1) {
        const double nearer = 0.4 * relative * answer.area.lower;
        gap = round == 0 ? std::min(gap, nearer) : 0.5 * gap;
        tips = std::min(tips, 0.5 * nearer);
      }
      if (answer.solid_excess > 1) tips *= std::max(0.4 / answer.solid_excess, 0x1p-20);
    }
    Measures result = in_mesh_units(answer, surface_.scale().inverse(), closed_);
    bool spent = false;
    for (const PatchMeasures& patch : results_) {
      result.splits += patch.splits;
      spent = spent || (patch.splits >= patch_splits_ && patch_splits_ < max_patch_splits);
    }
    result.outcome = outcome_of(answer.area_excess <= 1 && answer.solid_excess <= 1, spent);
    return result;
  }

 private:
  // By flat triangles: shares of the goals, half alike, half by areas; and how large the answers are.
  void find_shares() {
    shares_.resize(patches_.size());
    std::vector<double> volumes(patches_.size());
    parallel_for(patches_.size(), run_.threads, [&](std::size_t begin, std::size_t end) {
      Patch patch;
      for (std::size_t i = begin; i < end; ++i) {
        surface_.patch(patches_[i], patch);
        const std::array<Vector3, 3> corners = limit_corners(patch);
        const Vector3 across = cross(corners[1] - corners[0], corners[2] - corners[0]);
        const double part = surface_.rules().triangular() ? 0.5 : 1;
        shares_[i] = part * length(across);
        volumes[i] = part / 3 * dot(across, patch.origin + corners[0] - origin_);
      }
    });
    for (const double share : shares_) estimate_ += share;
    for (const double volume : volumes) volume_ += volume;
    const double by = estimate_ > 0 ? 0.5 / estimate_ : 0;
    for (double& share : shares_) share = share * by + 0.5 / static_cast<double>(patches_.size());
  }

  // Measures patches that have not reached their goals; were there some?
  bool round_of(double gap, double tips, int round) {
    std::vector<std::uint32_t> open;
    results_.resize(patches_.size());
    for (std::uint32_t i = 0; i < patches_.size(); ++i) {
      const PatchMeasures& before = results_[i];
      const bool done = before.gap <= shares_[i] * (gap + tips) && before.tips <= shares_[i] * tips;
      if (round == 0 || (!done && !before.stuck)) open.push_back(i);
    }
    std::atomic<std::size_t> count{0};
    parallel_for_with(
        open.size(), run_.threads, [&] { return PatchMeasurer(surface_, origin_, patch_splits_, monitor_); },
        [&](PatchMeasurer& measurer, std::size_t begin, std::size_t end) {
          for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t i = open[k];
            results_[i] = measurer.run(patches_[i], {shares_[i] * gap, shares_[i] * tips, weight_});
          }
          count += end - begin;
          if (round == 0) monitor_.report(static_cast<double>(count) / static_cast<double>(open.size()));
        });
    return !open.empty();
  }

  [[nodiscard]] bool all_stuck() const {
    return std::all_of(results_.begin(), results_.end(),
                       [](const PatchMeasures& patch) { return patch.stuck; });
  }

  [[nodiscard]] Totals totals() const {
    BoundedSum lower, gap;
    std::array<BoundedSum, 10> moments;
    for (const PatchMeasures& patch : results_) {
      lower.add(patch.lower, 0);
      gap.add(patch.gap, 0);
      for (std::size_t m = 0; m < 10; ++m) moments[m].add(patch.moments.value[m], patch.moments.error[m]);
    }
    Totals result;
    result.area = {lower.interval().lower, rounded_up(lower.interval().upper + gap.interval().upper)};
    for (std::size_t m = 0; m < 10; ++m) result.moments[m] = moments[m].interval();
    return result;
  }

  const LimitSurface& surface_;
  MeasureOptions options_;
  Run run_;
  const WorkMonitor& monitor_;
  std::vector<PatchId> patches_;  // a quad's first patch stands for both
  std::vector<double> shares_;
  std::vector<PatchMeasures> results_;
  double size_ = 0, estimate_ = 0, volume_ = 0, weight_ = 0;
  Point3 origin_;
  bool closed_ = false;
  std::uint64_t patch_splits_ = 0;
};

}  // namespace

Measures measure(const Surface& surface, const MeasureOptions& options, const Run& run) {
  if (options.relative) require_length(*options.relative, "the relative precision");
  return SurfaceMeasurer(surface.data()->limit(), options, run).run();
}

}  // namespace snug
