#include <snug/shape/corner_rings.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <snug/geometry/interval.h>
#include <snug/geometry/rounding.h>
#include <snug/shape/control_values.h>

namespace snug {
namespace {

// Levels that are followed. Share of the size below which what is left is not worth more of them.
constexpr std::size_t max_rings = 400;
constexpr double small_rest = 0x1p-24;

// Constants last, and no extent sees them.
void centre(std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const double middle = 0.5 * *least + 0.5 * *most;
  for (double& x : values) x -= middle;
}

}  // namespace

CornerRings::CornerRings(const RingDecay& decay, const Patch& values)
    : decay_(&decay), step_(decay.kind->children()[decay.corner].stencils()), values_(&values) {
  least_off_ = enlarged((decay.least.upper - decay.least.lower) / decay.least.lower);
  Level first;
  for (std::size_t c = 0; c < 2; ++c) {
    for (const Vector3& p : values.points) first.values[c].push_back(c == 0 ? p.x : p.y);
    centre(first.values[c]);
    first.largest = std::max(first.largest, largest_of(first.values[c]));
  }
  first.off = enlarged(values.error + gamma_bound(2) * values.largest);
  all_off_ = growing_off_ = first.off;
  levels_.push_back(std::move(first));
  descend();
  descend();
  std::vector<double> parts;
  for (; parts.size() < max_rings; descend()) {
    const Lasting last = lasting(parts.size());
    parts.push_back(enlarged(last.extent + last.off));
    // Beyond, roundings are all that is seen, which grow where one eigenvalue is larger; or there is little, for a whole period.
    const std::size_t period = decay.period;
    const double before = parts.size() < period ? INFINITY : parts[parts.size() - period];
    if (before < small_rest * levels_[0].largest || before < 4 * last.off ||
        (decay.growth != RingDecay::Growth::none && last.extent < last.off))
      break;
  }
  add_up(std::move(parts));
}

// One level on, over a number near the eigenvalue: levels are scaled anyhow. Of an error what the rows see grows as they do.
void CornerRings::descend() {
  const RingDecay& decay = *decay_;
  const double least = middle(decay.least);
  const std::size_t size = values_->points.size();
  const Level& before = levels_.back();
  Level next;
  const double largest = before.largest / least;
  for (std::size_t c = 0; c < 2; ++c) {
    apply(step_, before.values[c], next.values[c]);
    for (double& x : next.values[c]) x /= least;
    centre(next.values[c]);
    next.largest = std::max(next.largest, largest_of(next.values[c]));
  }
  const double off =
      (step_.max_error() + gamma_bound(size + 6) * (step_.max_abs_sum() + step_.max_error())) * largest;
  all_off_ = enlarged(all_off_ + off);
  growing_off_ = enlarged(decay.ratio.upper * growing_off_ + off);
  // Chains grow as the number of steps does.
  const bool chained = decay.growth != RingDecay::Growth::none && decay.ratio == Interval{1};
  const double steps = chained ? 1 + 8 * static_cast<double>(levels_.size()) : 1;
  next.off = enlarged(decay.most * (1 + decay.seen) * all_off_ + decay.seen * steps * growing_off_);
  levels_.push_back(std::move(next));
}

// From a level to the next one.
CornerRings::Level CornerRings::step_of(std::size_t level) const {
  const Level &from = levels_[level], &to = levels_[level + 1];
  Level step;
  for (std::size_t c = 0; c < 2; ++c) {
    for (std::size_t i = 0; i < values_->points.size(); ++i)
      step.values[c].push_back(to.values[c][i] - from.values[c][i]);
    centre(step.values[c]);
    step.largest = std::max(step.largest, largest_of(step.values[c]));
  }
  step.off = enlarged(from.off + to.off + (gamma_bound(3) + least_off_) * (from.largest + to.largest));
  return step;
}

// The extent of a step, less what the step before leaves to it: this shrinks.
CornerRings::Lasting CornerRings::lasting(std::size_t level) const {
  const Level step = step_of(level);
  double widest = 0;
  if (decay_->growth == RingDecay::Growth::none) {
    for (const auto& values : step.values) widest = std::max(widest, extent(values));
    return {widest, step.off};
  }
  const Level next = step_of(level + 1);
  const double ratio = middle(decay_->ratio);
  for (std::size_t c = 0; c < 2; ++c) {
    std::vector<double> rest(values_->points.size());
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = next.values[c][i] - ratio * step.values[c][i];
    widest = std::max(widest, extent(rest));
  }
  const double of_ratio = (decay_->ratio.upper - decay_->ratio.lower + gamma_bound(2) * ratio) * step.largest;
  return {widest,
          enlarged(next.off + decay_->ratio.upper * step.off + of_ratio + gamma_bound(2) * next.largest)};
}

// Parts beyond the last ones shrink by the factor of a period.
void CornerRings::add_up(std::vector<double> parts) {
  const RingDecay& shrinks = *decay_;
  const auto period = static_cast<double>(shrinks.period);
  const double rest = 1 - shrinks.factor, grown = decay_->ratio.lower - 1;
  // The levels are scaled by a number that differs from the eigenvalue's power.
  for (double& part : parts) part *= 1 + 4 * static_cast<double>(parts.size()) * least_off_;
  const double end = shrinks.most * parts.back() * period;
  Sums sums{enlarged(end / rest), enlarged(end * period / (rest * rest)), 0};
  if (parts.size() >= shrinks.period) {
    double last = 0;
    for (std::size_t k = parts.size() - shrinks.period; k < parts.size(); ++k) last += parts[k];
    sums.once = std::min(sums.once, enlarged(last * shrinks.factor / rest));
    sums.twice = std::min(sums.twice, enlarged(last * period * shrinks.factor / (rest * rest)));
  }
  sums.of_growth = sums.once;
  further_.resize(parts.size());
  for (std::size_t level = parts.size(); level-- > 0;) {
    sums.once = enlarged(sums.once + parts[level]);
    sums.twice = enlarged(sums.twice + sums.once);
    if (grown > 0) sums.twice = std::min(sums.twice, enlarged(sums.once / grown));
    sums.of_growth = enlarged((sums.of_growth + parts[level]) / decay_->ratio.lower);
    further_[level] = sums;
  }
}

Patch CornerRings::patch_of(const Level& level) const {
  Patch net;
  net.kind = decay_->kind;
  net.first = values_->first;
  for (std::size_t i = 0; i < values_->points.size(); ++i)
    net.points.push_back({level.values[0][i], level.values[1][i], 0});
  net.largest = level.largest;
  net.error = level.off;
  return net;
}

Patch CornerRings::net(std::size_t level) const { return level == 0 ? *values_ : patch_of(levels_[level]); }

CornerRings::Further CornerRings::all_further(std::size_t level) const {
  Further further{patch_of(levels_[level]), std::nullopt};
  const Sums& sums = further_[level];
  further.net.error =
      enlarged(further.net.error + (decay_->growth == RingDecay::Growth::none ? sums.once : sums.twice));
  if (decay_->growth != RingDecay::Growth::none) {
    further.growth = patch_of(step_of(level));
    further.growth->error = enlarged(further.growth->error + sums.of_growth);
  }
  return further;
}

}  // namespace snug
