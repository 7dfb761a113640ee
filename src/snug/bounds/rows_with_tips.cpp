#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include <snug/bounds/bounds_cache.h>
#include <snug/bounds/rows_kernel.h>
#include <snug/geometry/rounding.h>

namespace snug::kernels {
namespace {

// The nets that a step leaves beside polynomials: at most one a corner, and a middle child that is made of polynomials after another.
struct Nets {
  std::vector<const LevelStep::Net*> tips;
  const LevelStep::Net* middle = nullptr;
};
std::optional<Nets> nets_of(BoundsCache& library, const std::vector<LevelStep::Net>& nets) {
  Nets result;
  for (const LevelStep::Net& net : nets) {
    if (net.corner < 3) {
      result.tips.push_back(&net);
    } else {
      if (!library.level_step(*net.kind).nets.empty()) return std::nullopt;
      result.middle = &net;
    }
  }
  return result;
}

// each(level, kind, net it comes from) from a net at a corner on, as long as the only tip is at that corner.
template <class Each>
bool follow(BoundsCache& library, const LevelStep::Net& first, const Each& each) {
  LevelStep::Net net = first;
  for (unsigned level = 1; level < most_row_levels; ++level) {
    const std::vector<LevelStep::Net> own = library.level_step(*net.kind).nets;
    const std::optional<Nets> nets = nets_of(library, own);
    if (!nets || nets->tips.size() != 1 || nets->tips.front()->corner != net.own) return false;
    each(level, net);
    net = *nets->tips.front();
  }
  return true;
}

}  // namespace

bool has_rows_with_tips(BoundsCache& library, const Kind& kind) {
  if (!kind.cacheable() || kind.polynomial() || !has_self_similar_tips(kind)) return false;
  const std::vector<LevelStep::Net> own = library.level_step(kind).nets;
  const std::optional<Nets> nets = nets_of(library, own);
  return nets && std::all_of(nets->tips.begin(), nets->tips.end(), [&](const LevelStep::Net* net) {
           return follow(library, *net, [](unsigned, const LevelStep::Net&) {});
         });
}

bool has_layouts(BoundsCache& library, const Kind& kind) {
  if (quadratic_fit(library, kind).empty()) return false;
  for (const LevelStep::Net& net : std::vector<LevelStep::Net>(library.level_step(kind).nets)) {
    if (net.corner == 3) continue;
    const Kind* last = net.kind;
    follow(library, net, [&](unsigned, const LevelStep::Net& from) { last = from.kind; });
    if (!has_quadratic_rows(*last) || library.quadratic_rows(*last).layout().empty()) return false;
  }
  return true;
}

template <class T>
SparseRows<T>::SparseRows(const Stencils& rows, std::size_t count, std::span<const std::uint32_t> names)
    : places(count) {
  struct OfLength {
    std::uint32_t rows = 0, next = 0;
    std::size_t entry = 0;
  };
  std::vector<OfLength> by_length;
  for (std::size_t r = 0; r < count; ++r) {
    const std::size_t length = rows.row(r).sources.size();
    if (length >= by_length.size()) by_length.resize(length + 1);
    ++by_length[length].rows;
  }
  std::uint32_t place = 0;
  std::size_t entries = 0;
  for (std::size_t length = 0; length < by_length.size(); ++length) {
    OfLength& of = by_length[length];
    if (of.rows == 0) continue;
    runs.push_back({of.rows, static_cast<std::uint32_t>(length)});
    of.next = place;
    of.entry = entries;
    place += of.rows;
    entries += of.rows * length;
  }
  sources.resize(entries);
  weights.resize(entries);
  for (std::size_t r = 0; r < count; ++r) {
    const Stencils::Row row = rows.row(r);
    OfLength& of = by_length[row.sources.size()];
    places[of.next++] = static_cast<std::uint32_t>(r);
    for (std::size_t i = 0; i < row.sources.size(); ++i, ++of.entry) {
      sources[of.entry] = names.empty() ? row.sources[i] : names[row.sources[i]];
      weights[of.entry] = static_cast<T>(row.weights[i]);
    }
  }
}

// Errors of a coordinate of points, all of which are of at most `size`, for control points of at most 1.
template <class T>
struct RowsWithTips<T>::Growth {
  double of_points = 1, of_largest = sizeof(T) == sizeof(double) ? 0 : roundoff_of<T>, size = 1;
  void pass_on(const Stencils& by) {
    const double sum = std::max(1.0, by.max_abs_sum());
    std::size_t entries = 0;
    for (std::size_t r = 0; r < by.row_count(); ++r) entries = std::max(entries, by.row(r).sources.size());
    of_points = enlarged(of_points * (sum + by.max_error()));
    of_largest = by.result_error(size, of_largest);
    // Roundings of weights and of sums in single precision.
    if (sizeof(T) < sizeof(double))
      of_largest = enlarged(of_largest + gamma_bound<T>(entries + 2) * sum * size);
    size = enlarged(size * sum);
  }
};

namespace {

template <class T>
RestrictionOf<T> restriction_to(const LevelStep::Net& net) {
  // Corner k of the piece's kind is corner k + first of the piece.
  const std::size_t first = (6 + net.corner - net.own) % 3;
  RestrictionOf<T> result;
  for (std::size_t k = 0; k < 6; ++k) {
    const QuadraticWeights& weights =
        quarter_rows().to_child[net.corner][k < 3 ? (k + first) % 3 : 3 + (k + first) % 3];
    std::transform(weights.begin(), weights.end(), result[k].begin(),
                   [](double weight) { return static_cast<T>(weight); });
  }
  return result;
}

template <class T>
TipLayout<T> layout_of(BoundsCache& library, const Kind& kind) {
  const QuadraticRows& rows = library.quadratic_rows(kind);
  TipLayout<T> layout;
  for (std::size_t i = 0; i < rows.layout().size(); ++i) {
    const auto [u, v] = rows.layout()[i];
    const double largest = rows.largest()[i] * (1 + 2 * roundoff_of<T>);
    layout.places.push_back({static_cast<T>(u), static_cast<T>(v), static_cast<T>(largest)});
    layout.reach += enlarged(largest * (1 + std::fabs(u) + std::fabs(v)));
  }
  double spread = 1;
  for (const auto& [u, v] : rows.offsets()) {
    layout.offsets.push_back({static_cast<T>(u), static_cast<T>(v)});
    spread = std::max(spread, 1 + std::fabs(u) + std::fabs(v));
  }
  layout.offset_error = rows.offset_error() + 12 * roundoff_of<T> * spread;
  for (std::size_t k = 0; k < 3; ++k) {
    const Stencils::Row row = kind.corner_limits().row(k);
    layout.to_corner[k].assign(kind.control_count(), 0);
    for (std::size_t i = 0; i < row.sources.size(); ++i) {
      layout.to_corner[k][row.sources[i]] = static_cast<T>(row.weights[i]);
    }
  }
  return layout;
}

}  // namespace

// Steps, each once.
template <class T>
struct RowsWithTips<T>::Maker {
  RowsWithTips& rows;
  BoundsCache& library;
  std::map<std::tuple<const Kind*, std::vector<std::uint32_t>, bool>, const Step*> known;

  // Of a kind, from points whose numbers are `names`. `inner`: without points that the step before has.
  const Step* step(const Kind& kind, const std::vector<std::uint32_t>& names, bool inner) {
    const Step*& own = known[{&kind, names, inner}];
    if (own) return own;
    const LevelStep& of = library.level_step(kind);
    const std::size_t count = of.points.row_count();
    rows.most_points_ = std::max(rows.most_points_, count);
    Step made{SparseRows<T>(of.points, count, names),
              SparseRows<T>(of.bezier, inner ? of.inner : of.bezier.row_count()),
              {}};
    for (const QuadraticWeights& weights : of.quadratic) {
      std::array<T, 6>& own_weights = made.quadratic.emplace_back();
      for (std::size_t k = 0; k < 6; ++k) own_weights[k] = static_cast<T>(weights[k]);
    }
    own = rows.steps_.emplace_back(std::make_unique<const Step>(std::move(made))).get();
    return own;
  }
  void widen(const Growth& growth) {
    rows.error_of_points_ = std::max(rows.error_of_points_, growth.of_points);
    rows.error_of_largest_ = std::max(rows.error_of_largest_, growth.of_largest);
    rows.growth_ = std::max(rows.growth_, growth.size);
  }
  void pass_on(const LevelStep& step, Growth& growth) {
    growth.pass_on(step.points);
    widen(growth);
    Growth bezier = growth;
    bezier.pass_on(step.bezier);
    widen(bezier);
  }
  Level level(const Kind& kind, const std::vector<std::uint32_t>& names, bool inner, Growth& growth) {
    Level result;
    result.step = step(kind, names, inner);
    pass_on(library.level_step(kind), growth);
    for (const LevelStep::Net& net : std::vector<LevelStep::Net>(library.level_step(kind).nets)) {
      if (net.corner < 3) {
        result.tip_control = net.control;
        result.to_tip = restriction_to<T>(net);
        continue;
      }
      result.middle = step(*net.kind, net.control, false);
      result.to_middle = restriction_to<T>(net);
      Growth there = growth;
      pass_on(library.level_step(*net.kind), there);
    }
    return result;
  }
};

// Derivations/rounding.md, "Batches".
template <class T>
RowsWithTips<T>::RowsWithTips(BoundsCache& library, const Kind& kind, TipsBy by) : kind_(&kind) {
  Maker maker{*this, library, {}};
  Growth of_first;
  first_ = maker.level(kind, {}, false, of_first);
  for (const LevelStep::Net& net : std::vector<LevelStep::Net>(library.level_step(kind).nets)) {
    if (net.corner == 3) continue;
    Tip& tip = tips_.emplace_back();
    tip.control = net.control;
    tip.from_patch = restriction_to<T>(net);
    const Kind* last = net.kind;
    Growth growth = of_first;
    follow(library, net, [&](unsigned level, const LevelStep::Net& from) {
      // The piece beyond is the middle one of the step before.
      tip.levels[level] = maker.level(*from.kind, from.control, true, growth);
      last = from.kind;
    });
    if (by == TipsBy::tables) {
      tip.table = flatten(library.tip_table(*last), *last, tip.columns);
    } else {
      tip.layout = layout_of<T>(library, *last);
    }
  }
  if (by == TipsBy::layouts) {
    for (const double weight : quadratic_fit(library, kind)) fit_.push_back(static_cast<T>(weight));
  }
}

template <class T>
std::size_t RowsWithTips<T>::bytes() const {
  const auto of = [](const SparseRows<T>& rows) {
    return rows.runs.size() * sizeof(typename SparseRows<T>::Run) +
           (rows.places.size() + rows.sources.size()) * sizeof(std::uint32_t) +
           rows.weights.size() * sizeof(T);
  };
  std::size_t sum = fit_.size() * sizeof(T) + tips_.size() * sizeof(Tip);
  for (const auto& step : steps_)
    sum += of(step->points) + of(step->bezier) + step->quadratic.size() * sizeof(step->quadratic[0]);
  for (const Tip& tip : tips_) {
    sum += tip.columns.size() * sizeof(tip.columns[0]);
    for (const Level& level : tip.levels) sum += level.tip_control.size() * sizeof(std::uint32_t);
    sum += (tip.layout.places.size() + 2 * tip.layout.offsets.size()) * 3 * sizeof(T);
  }
  return sum;
}

template <class T>
std::size_t RowsWithTips<T>::bezier_count(unsigned levels) const {
  const auto count_of = [](const Level& level) {
    return level.step->bezier.places.size() + (level.middle ? level.middle->bezier.places.size() : 0);
  };
  std::size_t count = count_of(first_);
  for (const Tip& tip : tips_) {
    for (unsigned level = 1; level < levels; ++level) count += count_of(tip.levels[level]);
  }
  return count;
}

template class RowsWithTips<float>;
template class RowsWithTips<double>;

}  // namespace snug::kernels
