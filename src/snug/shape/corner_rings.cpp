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

// The order of the differences that do not last, beside the largest row.
unsigned order_of(const RingDecay& decay) { return decay.links > 0 ? 2 : 1; }

}  // namespace

RingValues::RingValues(const RingDecay& decay, const Stencils& step, std::vector<double> values, double error,
                       bool without_largest)
    : decay_(&decay),
      step_(&step),
      larger_(decay.larger && !without_largest),
      without_largest_(decay.larger && without_largest) {
  least_off_ = enlarged((decay.least.upper - decay.least.lower) / decay.least.lower);
  Level first{std::move(values), 0, 0};
  first.off = enlarged(error + gamma_bound(2) * largest_of(first.values));
  centre(first.values);
  first.off += take_off_largest(first);
  first.largest = largest_of(first.values);
  all_off_ = growing_off_ = first.off;
  levels_.reserve(64);
  levels_.push_back(std::move(first));
  std::vector<double> parts;
  while (parts.size() < max_rings) {
    descend_to(parts.size() + 1);
    const Lasting last = lasting(parts.size());
    parts.push_back(enlarged(last.extent + last.off));
    // Beyond, roundings are all that is seen, which grow where one eigenvalue is larger; or there is little, for a whole period.
    const std::size_t period = decay.period;
    const double before = parts.size() < period ? INFINITY : parts[parts.size() - period];
    if (before < small_rest * levels_[0].largest || before < 4 * last.off ||
        ((larger_ || decay.links > 0) && last.extent < last.off))
      break;
  }
  add_up(std::move(parts));
}

void RingValues::descend_to(std::size_t count) {
  while (levels_.size() < count + order_of(*decay_) + 1) descend();
}

// What the largest row sees is rounding, and would grow. Returns what the values are off more, beside that.
double RingValues::take_off_largest(Level& level) {
  if (!without_largest_) return 0;
  const RingDecay& decay = *decay_;
  const std::size_t size = level.values.size();
  double seen = 0, sum = 0;
  for (std::size_t i = 0; i < size; ++i) {
    seen += decay.largest_row[i] * level.values[i];
    sum += std::fabs(decay.largest_row[i]);
  }
  for (std::size_t i = 0; i < size; ++i) level.values[i] -= seen * decay.largest_column[i];
  const double moved = std::fabs(seen) * largest_of(decay.largest_column);
  const double large = largest_of(level.values) + 2 * moved;
  // As a share of the row's sum, which `seen` holds.
  largest_off_ = enlarged((decay.row_error / sum + gamma_bound(size + 6)) * 2 * large +
                          std::fabs(seen) * decay.column_off / sum);
  return enlarged(gamma_bound(3) * large + std::fabs(seen) * decay.column_off);
}

// One level on, over a number near the eigenvalue: levels are scaled anyhow. Of an error what the rows see grows as they do.
void RingValues::descend() {
  const RingDecay& decay = *decay_;
  const double least = middle(decay.least);
  const Level& before = levels_.back();
  Level next;
  apply(*step_, before.values, next.values);
  for (double& x : next.values) x /= least;
  centre(next.values);
  const double taken_off = take_off_largest(next);
  next.largest = largest_of(next.values);
  const double off = (step_->max_error() +
                      gamma_bound(next.values.size() + 6) * (step_->max_abs_sum() + step_->max_error())) *
                         (before.largest / least) +
                     taken_off;
  all_off_ = enlarged(all_off_ + off);
  growing_off_ = enlarged((larger_ ? decay.ratio.upper : 1) * growing_off_ + off);
  // Chains grow as the number of steps does.
  const double seen = decay.seen + decay.chain_seen * static_cast<double>(levels_.size());
  next.off =
      enlarged(decay.most * (1 + decay.seen) * all_off_ + seen * growing_off_ + decay.seen * largest_off_);
  levels_.push_back(std::move(next));
}

RingValues::Level RingValues::difference(std::size_t level, unsigned order) const {
  if (order == 1) return step_between(levels_[level], levels_[level + 1]);
  return step_between(difference(level, order - 1), difference(level + 1, order - 1));
}

RingValues::Level RingValues::step_between(const Level& from, const Level& to) const {
  Level step;
  step.values.resize(from.values.size());
  for (std::size_t i = 0; i < step.values.size(); ++i) step.values[i] = to.values[i] - from.values[i];
  centre(step.values);
  step.largest = largest_of(step.values);
  step.off = enlarged(from.off + to.off + (gamma_bound(3) + least_off_) * (from.largest + to.largest));
  return step;
}

// The extent of a difference, less what the one before leaves to it: this shrinks. `next_`: the one that was next.
RingValues::Lasting RingValues::lasting(std::size_t level) {
  const unsigned order = order_of(*decay_);
  if (!larger_) {
    const Level step = difference(level, order);
    return {extent(step.values), step.off};
  }
  const Level step = level > 0 ? std::move(next_) : difference(level, order);
  next_ = difference(level + 1, order);
  const double ratio = middle(decay_->ratio);
  double least = INFINITY, most = -INFINITY;
  for (std::size_t i = 0; i < step.values.size(); ++i) {
    const double rest = next_.values[i] - ratio * step.values[i];
    least = std::min(least, rest);
    most = std::max(most, rest);
  }
  const double of_ratio = (decay_->ratio.upper - decay_->ratio.lower + gamma_bound(2) * ratio) * step.largest;
  return {enlarged(0.5 * (most - least)),
          enlarged(next_.off + decay_->ratio.upper * step.off + of_ratio + gamma_bound(2) * next_.largest)};
}

// Parts beyond the last ones shrink by the factor of a period.
void RingValues::add_up(std::vector<double> parts) {
  const RingDecay& shrinks = *decay_;
  const auto period = static_cast<double>(shrinks.period);
  const double rest = 1 - shrinks.factor, grown = decay_->ratio.lower - 1;
  // The levels are scaled by a number that differs from the eigenvalue's power.
  for (double& part : parts) part *= 1 + 4 * static_cast<double>(parts.size()) * least_off_;
  const double end = shrinks.most * parts.back() * period, late = period / rest;
  // Of all further parts; of these sums; and of those.
  double once = enlarged(end / rest);
  if (parts.size() >= shrinks.period) {
    double last = 0;
    for (std::size_t k = parts.size() - shrinks.period; k < parts.size(); ++k) last += parts[k];
    once = std::min(once, enlarged(last * shrinks.factor / rest));
  }
  double twice = enlarged(once * late), thrice = enlarged(twice * late), of_largest = once;
  further_.resize(parts.size() + 1);
  for (std::size_t level = parts.size() + 1; level-- > 0;) {
    if (level < parts.size()) {
      once = enlarged(once + parts[level]);
      twice = enlarged(twice + once);
      if (larger_ && grown > 0) twice = std::min(twice, enlarged(once / grown));
      thrice = enlarged(thrice + twice);
      of_largest = enlarged((of_largest + parts[level]) / decay_->ratio.lower);
    }
    const bool chained = shrinks.links > 0;
    further_[level] = {larger_ && chained   ? thrice
                       : larger_ || chained ? twice
                                            : once,
                       larger_ ? twice : once, larger_ ? of_largest : 0};
  }
}

CornerRings::CornerRings(const RingDecay& decay, const Patch& values)
    : decay_(&decay), step_(decay.kind->children()[decay.corner].stencils()), first_(values.first) {
  std::array<std::vector<double>, 2> centred;
  for (std::size_t c = 0; c < 2; ++c) {
    for (const Vector3& p : values.points) centred[c].push_back(c == 0 ? p.x : p.y);
    centre(centred[c]);
  }
  const double error = enlarged(values.error + gamma_bound(2) * values.largest);
  const double largest = std::max(largest_of(centred[0]), largest_of(centred[1]));
  // All growth of the largest row along the second axis: the first one is across what that row sees, exactly.
  if (decay.larger) {
    Point2 along;
    double sum = 0;
    for (std::size_t i = 0; i < values.points.size(); ++i) {
      along = along + decay.largest_row[i] * Point2{centred[0][i], centred[1][i]};
      sum += std::fabs(decay.largest_row[i]);
    }
    const double size = std::sqrt(dot(along, along));
    const double off = enlarged(
        2 * (decay.row_error * largest + sum * (error + gamma_bound(values.points.size() + 2) * largest)));
    if (size > 4 * off) {
      axes_ = {{{along.y / size, -along.x / size}, {along.x / size, along.y / size}}};
      axis_off_ = enlarged(2 * off / size + gamma_bound(8));
      apart_ = true;
    }
  }
  for (std::size_t c = 0; c < 2; ++c) {
    std::vector<double> along;
    for (std::size_t i = 0; i < values.points.size(); ++i)
      along.push_back(dot(axes_[c], {centred[0][i], centred[1][i]}));
    values_.emplace_back(decay, step_, std::move(along),
                         enlarged(2 * error + (2 * axis_off_ + gamma_bound(4)) * 2 * largest),
                         apart_ && c == 0);
    count_ = std::max(count_, values_.back().count());
  }
  for (RingValues& own : values_) own.descend_to(count_);
}

std::array<Point2, 2> CornerRings::axes(std::size_t level) const {
  if (!apart_) return axes_;
  // By powers of two, so that both coordinates are about as large.
  std::array<Point2, 2> axes = axes_;
  for (std::size_t c = 0; c < 2; ++c) {
    const double largest = values_[c].level(level).largest;
    if (largest > 0x1p-500 && largest < 0x1p500) axes[c] = std::ldexp(1.0, -std::ilogb(largest)) * axes[c];
  }
  return axes;
}

Patch CornerRings::net_of(std::size_t level, unsigned order, double RingValues::Sums::*sum) const {
  Patch net;
  net.kind = decay_->kind;
  net.first = first_;
  const std::array<Point2, 2> axes = this->axes(level);
  for (std::size_t c = 0; c < 2; ++c) {
    const RingValues::Level own = order == 0 ? values_[c].level(level) : values_[c].difference(level, order);
    const double scale = axes_[c].x != 0 ? axes[c].x / axes_[c].x : axes[c].y / axes_[c].y;
    net.points.resize(own.values.size());
    // The first coordinate has nothing of the larger eigenvalue.
    if (sum == &RingValues::Sums::largest && c == 0 && apart_) continue;
    for (std::size_t i = 0; i < own.values.size(); ++i)
      (c == 0 ? net.points[i].x : net.points[i].y) = scale * own.values[i];
    net.largest = std::max(net.largest, scale * own.largest);
    net.error = std::max(net.error,
                         enlarged(scale * (own.off + (sum != nullptr ? values_[c].further(level).*sum : 0))));
  }
  return net;
}

Patch CornerRings::net(std::size_t level) const { return net_of(level, 0, nullptr); }

std::vector<Patch> CornerRings::all_further(std::size_t level) const {
  std::vector<Patch> nets{net_of(level, 0, &RingValues::Sums::net)};
  if (decay_->links > 0) nets.push_back(net_of(level, 1, &RingValues::Sums::chain));
  if (decay_->larger) nets.push_back(net_of(level, order_of(*decay_), &RingValues::Sums::largest));
  return nets;
}

}  // namespace snug
