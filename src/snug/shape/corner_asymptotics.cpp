#include <snug/shape/corner_asymptotics.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include <snug/geometry/rounding.h>
#include <snug/shape/dense_rows.h>

namespace snug {
namespace {

// Steps after which a kind comes again, at most: one, but where faces around it are named in turns.
constexpr std::size_t max_period = 24;
// Largest matrices whose powers are taken for a smaller factor, or to find one at all.
constexpr std::size_t common_size = 80, largest_power = 600;

// The least factor, by one period, two, four, ... at once, `other` being that of all that one period splits
// off. Factors grow by a power of extents' growth.
template <class Power>
double repeated(DenseRows period, double other, const Power& power) {
  constexpr unsigned enough = 8, most = 4096;
  double best = INFINITY;
  double sum = 1;  // of the factors' growths by 0, 1, ... times - 1 periods
  for (unsigned times = 1;; times *= 2) {
    const double growth = enlarged(power(period.growth()));
    if (growth < 1) best = std::min(best, enlarged(other * sum / (1 - growth)));
    const std::size_t limit = best == INFINITY ? largest_power : common_size;
    if (period.columns() > limit || times >= most || (best < INFINITY && times >= enough)) return best;
    sum *= 1 + growth;
    period.square();
  }
}

using Path = std::vector<std::size_t>;

// Children by which a kind comes again, if it does.
bool comes_again(const Kind& kind, const Kind& from, std::unordered_set<const Kind*>& seen, Path& path) {
  if (path.size() >= max_period) return false;
  for (std::size_t k = 0; k < 4; ++k) {
    const Kind& child = *from.step().pieces[k].kind;
    if (child.polynomial()) continue;
    path.push_back(k);
    if (&child == &kind) return true;
    if (seen.insert(&child).second && comes_again(kind, child, seen, path)) return true;
    path.pop_back();
  }
  return false;
}

}  // namespace

// Factors of a kind and of those that it splits into. Growths count squared for areas.
class CornerAsymptotics::FactorSearch {
 public:
  explicit FactorSearch(Measure measure) : measure_(measure) {}

  double find(const Kind& kind) {
    if (const auto it = known_.find(&kind); it != known_.end()) return it->second;
    if (const double* made = asymptotics_of(kind).factors_[measure_].made()) return *made;
    if (kind.polynomial()) {
      // Derivatives along u and v are averages of differences of lattice points.
      const double domain = kind.rules().triangular() ? 0.5 : 1;
      const double stretch = std::max(1.0, kind.lattice().ghosts.max_abs_sum());
      // Of two points u and v differ by at most 1.
      return known_[&kind] = enlarged(measure_ == areas ? domain * stretch * stretch : 2 * stretch);
    }
    if (!open_.insert(&kind).second) return INFINITY;
    const double factor = find_new(kind);
    open_.erase(&kind);
    if (factor < INFINITY) known_[&kind] = factor;
    return factor;
  }
  // Those of other kinds that were found along with it; finite ones do not depend on what was asked first.
  [[nodiscard]] const std::unordered_map<const Kind*, double>& known() const { return known_; }

 private:
  [[nodiscard]] double power(double growth) const { return measure_ == areas ? growth * growth : growth; }
  double find_new(const Kind& kind) {
    Path path;
    std::unordered_set<const Kind*> seen;
    const bool again = !kind.transient() && comes_again(kind, kind, seen, path);
    if (!again) path = {4};  // no child is left out
    DenseRows rows(kind.control_count());
    double factor = 0;
    const Kind* at = &kind;
    for (const std::size_t next : path) {
      const KindStep& step = at->step();
      const double growth = at == &kind ? 1 : rows.growth();
      for (std::size_t k = 0; k < 4; ++k) {
        if (k == next) continue;
        const KindStep::Piece& piece = step.pieces[k];
        const double grows = growth * growth_of(step.stencils, piece.control, at->control_count());
        factor += power(grows) * find(*piece.kind);
      }
      if (!again) return enlarged(factor);
      rows.step(step.stencils, step.pieces[next].control);
      at = step.pieces[next].kind;
    }
    return repeated(std::move(rows), enlarged(factor), [&](double growth) { return power(growth); });
  }

  Measure measure_;
  std::unordered_map<const Kind*, double> known_;
  std::unordered_set<const Kind*> open_;  // whose factors are being found
};

const CharacteristicMap* CornerAsymptotics::characteristic_map() const {
  const auto& map = map_.get([&] { return make_characteristic_map(kind_); });
  return map ? &*map : nullptr;
}

const RingDecay* CornerAsymptotics::ring_decay() const {
  const auto& decay = decay_.get([&] { return make_ring_decay(kind_, characteristic_map()); });
  return decay ? &*decay : nullptr;
}

const RingDecay* CornerAsymptotics::spike_decay() const {
  const auto& decay = spike_.get([&] { return make_spike_decay(kind_); });
  return decay ? &*decay : nullptr;
}

const CornerForms* CornerAsymptotics::forms() const {
  const auto& forms = forms_.get([&] { return make_corner_forms(kind_, area_factor()); });
  return forms ? &*forms : nullptr;
}

double CornerAsymptotics::factor(Measure measure) const {
  if (const double* made = factors_[measure].made()) return *made;
  // Outside of the lock, as kinds may need each other's.
  FactorSearch search(measure);
  const double found = search.find(kind_);
  for (const auto& [kind, factor] : search.known()) {
    static_cast<void>(asymptotics_of(*kind).factors_[measure].get([factor = factor] { return factor; }));
  }
  return factors_[measure].get([&] { return found; });
}

const CornerAsymptotics& asymptotics_of(const Kind& kind) {
  return *kind.asymptotics_.get([&] { return std::make_shared<const CornerAsymptotics>(kind); });
}

}  // namespace snug
