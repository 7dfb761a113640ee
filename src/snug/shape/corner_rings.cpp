#include <snug/shape/corner_rings.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <snug/geometry/interval.h>
#include <snug/geometry/rounding.h>
#include <snug/shape/control_values.h>

namespace snug {
namespace {

// Levels that are followed. Share of the size below which what is left is not worth more of them.
constexpr std::size_t max_rings = 2000;
constexpr double small_rest = 0x1p-24;

// Constants last, and no extent sees them.
void centre(std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const double middle = 0.5 * *least + 0.5 * *most;
  for (double& x : values) x -= middle;
}

void rescale(Patch& net, double by) {
  for (Vector3& p : net.points) p = by * p;
  net.largest *= by;
  net.error = enlarged(by * net.error + gamma_bound(3) * net.largest);
}

// The order of the differences that do not last, beside the largest row.
unsigned order_of(const RingDecay& decay) { return decay.links > 0 ? 2 : 1; }

}  // namespace

RingValues::RingValues(const RingDecay& decay, const Stencils& step, std::vector<double> values, double error)
    : decay_(&decay), step_(&step) {
  least_off_ = enlarged((decay.least.upper - decay.least.lower) / decay.least.lower);
  std::size_t longest = 0;
  for (std::size_t r = 0; r < step.row_count(); ++r) longest = std::max(longest, step.row(r).sources.size());
  rounding_ = enlarged(step.max_error() + gamma_bound(longest + 6) * (step.max_abs_sum() + step.max_error()));
  Level first{std::move(values), 0, 0};
  first.off = enlarged(error + gamma_bound(2) * largest_of(first.values));
  centre(first.values);
  first.off += take_off_larger(first);
  first.largest = largest_of(first.values);
  all_off_ = first.off;
  if (decay.larger || !decay.spike_row.empty()) first.off = off_of(0);
  levels_.reserve(64);
  levels_.push_back(std::move(first));
  std::vector<double> parts;
  Level last;
  while (parts.size() < max_rings) {
    descend_to(parts.size() + 1);
    // Of the differences that do not last.
    difference(parts.size(), order_of(decay), last);
    const double left = extent(last.values);
    parts.push_back(enlarged(left + last.off));
    // Beyond, roundings are all that is seen, which grow in a chain; or there is little, for a whole period.
    const std::size_t period = decay.period;
    const double before = parts.size() < period ? INFINITY : parts[parts.size() - period];
    if (before < small_rest * levels_[0].largest || before < 4 * last.off ||
        (decay.links > 0 && left < last.off))
      break;
  }
  add_up(std::move(parts));
}

void RingValues::descend_to(std::size_t count) {
  while (levels_.size() < count + order_of(*decay_) + 1) descend();
}

// What larger rows see is rounding, and would grow. Returns what the values are off more, beside that.
double RingValues::take_off_larger(Level& level) {
  const RingDecay& decay = *decay_;
  const std::size_t size = level.values.size();
  const auto seen_by = [&](const std::vector<double>& row) {
    return std::inner_product(row.begin(), row.end(), level.values.begin(), 0.0);
  };
  double off = 0;
  const auto take_off = [&](const std::vector<double>& row, const std::vector<double>& column,
                            double column_off) {
    if (row.empty()) return;
    const double seen = seen_by(row);
    for (std::size_t i = 0; i < size; ++i) level.values[i] -= seen * column[i];
    const double large = largest_of(level.values) + 2 * std::fabs(seen) * largest_of(column);
    off = enlarged(off + gamma_bound(3) * large + std::fabs(seen) * column_off);
  };
  take_off(decay.spike_row, decay.spike_column, decay.spike_off);
  take_off(decay.largest_row, decay.largest_column, decay.column_off);
  // Of what is left, as a share of the row's sum, which `seen` holds.
  larger_off_ = 0;
  const double large = largest_of(level.values);
  for (const std::vector<double>* row : {&decay.spike_row, &decay.largest_row}) {
    if (row->empty()) continue;
    double sum = 0;
    for (const double weight : *row) sum += std::fabs(weight);
    larger_off_ = enlarged(larger_off_ + std::fabs(seen_by(*row)) / sum +
                           (decay.row_error / sum + gamma_bound(size + 6)) * 2 * large);
  }
  return off;
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
  const double taken_off = take_off_larger(next);
  next.largest = largest_of(next.values);
  const double off = rounding_ * (before.largest / least) + taken_off;
  all_off_ = enlarged(all_off_ + off);
  next.off = off_of(levels_.size());
  levels_.push_back(std::move(next));
}

// What values are off after so many steps, each of which was off by its share of all. What was taken off is not only the larger
// eigenvalue's part of the exact values, which is none, but also that of all this.
double RingValues::off_of(std::size_t level) const {
  const RingDecay& decay = *decay_;
  // Chains grow as the number of steps does.
  const double seen = decay.seen + decay.chain_seen * static_cast<double>(level);
  return enlarged((decay.most * (1 + decay.seen) + seen) * all_off_ + decay.seen * larger_off_);
}

RingValues::Level RingValues::difference(std::size_t level, unsigned order) const {
  Level step;
  difference(level, order, step);
  return step;
}

void RingValues::difference(std::size_t level, unsigned order, Level& step) const {
  if (order == 1) {
    step_between(levels_[level], levels_[level + 1], step);
  } else {
    step_between(difference(level, order - 1), difference(level + 1, order - 1), step);
  }
}

void RingValues::step_between(const Level& from, const Level& to, Level& step) const {
  step.values.resize(from.values.size());
  for (std::size_t i = 0; i < step.values.size(); ++i) step.values[i] = to.values[i] - from.values[i];
  centre(step.values);
  step.largest = largest_of(step.values);
  step.off = enlarged(from.off + to.off + (gamma_bound(3) + least_off_) * (from.largest + to.largest));
}

// Parts beyond the last ones shrink by the factor of a period.
void RingValues::add_up(std::vector<double> parts) {
  const RingDecay& shrinks = *decay_;
  const auto period = static_cast<double>(shrinks.period);
  const double rest = 1 - shrinks.factor;
  // The levels are scaled by a number that differs from the eigenvalue's power.
  for (double& part : parts) part *= 1 + 4 * static_cast<double>(parts.size()) * least_off_;
  const double end = shrinks.most * parts.back() * period, late = period / rest;
  // Of all further parts, and of these sums.
  double once = enlarged(end / rest);
  if (parts.size() >= shrinks.period) {
    double last = 0;
    for (std::size_t k = parts.size() - shrinks.period; k < parts.size(); ++k) last += parts[k];
    once = std::min(once, enlarged(last * shrinks.factor / rest));
  }
  double twice = enlarged(once * late);
  further_.resize(parts.size() + 1);
  for (std::size_t level = parts.size() + 1; level-- > 0;) {
    if (level < parts.size()) {
      once = enlarged(once + parts[level]);
      twice = enlarged(twice + once);
    }
    further_[level] = {shrinks.links > 0 ? twice : once, once};
  }
  parts_ = std::move(parts);
}

double RingValues::next(std::size_t level, std::size_t steps) const {
  double sum = 0;
  for (std::size_t k = 0; k < steps; ++k) sum = enlarged(sum + parts_[level + k]);
  return sum;
}

CornerRings::CornerRings(const RingDecay& decay, const Patch& values)
    : decay_(&decay),
      step_(decay.kind->children()[decay.corner].stencils()),
      first_(values.first),
      grows_(decay.larger) {
  std::array<std::vector<double>, 2> centred;
  for (std::size_t c = 0; c < 2; ++c) {
    for (const Vector3& p : values.points) centred[c].push_back(c == 0 ? p.x : p.y);
    centre(centred[c]);
  }
  const double error = enlarged(values.error + gamma_bound(2) * values.largest);
  const double largest = std::max(largest_of(centred[0]), largest_of(centred[1]));
  // What the larger eigenvalue's row sees along the second axis: the first one is across that, exactly.
  double of_row = 0;
  if (grows_) {
    Point2 along;
    double sum = 0;
    for (std::size_t i = 0; i < values.points.size(); ++i) {
      along = along + decay.largest_row[i] * Point2{centred[0][i], centred[1][i]};
      sum += std::fabs(decay.largest_row[i]);
    }
    const double size = std::sqrt(dot(along, along));
    of_row = enlarged(
        2 * (decay.row_error * largest + sum * (error + gamma_bound(values.points.size() + 4) * largest)));
    // Else no axis is across it; no net is of use, with such errors.
    const bool seen = size > 4 * of_row;
    if (seen) axes_ = {{{along.y / size, -along.x / size}, {along.x / size, along.y / size}}};
    axis_off_ = seen ? enlarged(2 * of_row / size + gamma_bound(8)) : 1;
    along_ = {std::max(0.0, rounded_down(size - of_row)), rounded_up(size + of_row)};
  }
  for (std::size_t c = 0; c < 2; ++c) {
    std::vector<double> along;
    for (std::size_t i = 0; i < values.points.size(); ++i) {
      along.push_back(dot(axes_[c], {centred[0][i], centred[1][i]}));
      if (grows_ && c == 1) along.back() -= middle(along_) * decay.largest_column[i];
    }
    double off = enlarged(2 * error + (2 * axis_off_ + gamma_bound(4)) * 2 * largest);
    if (grows_) {
      const double of_column = largest_of(decay.largest_column);
      off =
          enlarged(off + of_row * of_column + along_.upper * (decay.column_off + gamma_bound(4) * of_column));
    }
    values_.emplace_back(decay, step_, std::move(along), off);
    count_ = std::max(count_, values_.back().count());
  }
  for (RingValues& own : values_) own.descend_to(count_);
}

// Of the larger eigenvalue's vector along the second axis: at least, and at most.
Interval CornerRings::larger_part(std::size_t level) const {
  if (!grows_) return Interval{0};
  const auto steps = static_cast<double>(level);
  // Levels are divided by a number near the eigenvalue.
  const double off = (steps + 2) * gamma_bound(4),
               least_off = steps * (decay_->least.upper / decay_->least.lower - 1);
  return {along_.lower * std::pow(decay_->ratio.lower, steps) * (1 - off - least_off),
          along_.upper * std::pow(decay_->ratio.upper, steps) * (1 + off + 2 * least_off)};
}

// By powers of two, so that both coordinates are about as large.
double CornerRings::scale(std::size_t level, std::size_t coordinate) const {
  if (!grows_) return 1;
  double largest = values_[coordinate].level(level).largest;
  if (coordinate == 1)
    largest = std::max(largest, larger_part(level).upper * largest_of(decay_->largest_column));
  return largest > 0x1p-500 && largest < 0x1p500 ? std::ldexp(1.0, -std::ilogb(largest)) : 1;
}

std::array<Point2, 2> CornerRings::axes(std::size_t level) const {
  return {scale(level, 0) * axes_[0], scale(level, 1) * axes_[1]};
}

Patch CornerRings::net_of(std::size_t level, unsigned order, bool all_further,
                          std::array<double, 2> added) const {
  Patch net;
  net.kind = decay_->kind;
  net.first = first_;
  for (std::size_t c = 0; c < 2; ++c) {
    RingValues::Level own = order == 0 ? values_[c].level(level) : values_[c].difference(level, order);
    double off = own.off + added[c];
    if (grows_ && order == 0 && c == 1) {
      // Of all further nets at least this much; of one, no more than that.
      const Interval part = larger_part(level);
      const double of_column = largest_of(decay_->largest_column);
      for (std::size_t i = 0; i < own.values.size(); ++i)
        own.values[i] += part.lower * decay_->largest_column[i];
      own.largest = enlarged(own.largest + part.lower * of_column);
      off += part.lower * decay_->column_off + gamma_bound(3) * own.largest;
      if (!all_further) off += (part.upper - part.lower) * (of_column + decay_->column_off);
    }
    const double by = scale(level, c);
    net.points.resize(own.values.size());
    for (std::size_t i = 0; i < own.values.size(); ++i)
      (c == 0 ? net.points[i].x : net.points[i].y) = by * own.values[i];
    net.largest = std::max(net.largest, by * own.largest);
    net.error = std::max(net.error, enlarged(by * off));
  }
  return net;
}

std::size_t CornerRings::rings_at_once(std::size_t level) const {
  if (grows_ || decay_->links > 0) return 1;
  return std::max<std::size_t>(std::min(values_[0].count(), values_[1].count()), level + 1) - level;
}

Patch CornerRings::net(std::size_t level, std::size_t rings) const {
  return net_of(level, 0, false, {values_[0].next(level, rings - 1), values_[1].next(level, rings - 1)});
}

std::array<double, 2> CornerRings::further(std::size_t level, double RingValues::Sums::*sum) const {
  return {values_[0].further(level).*sum, values_[1].further(level).*sum};
}

std::vector<Patch> CornerRings::all_further(std::size_t level) const {
  std::vector<Patch> nets{net_of(level, 0, true, further(level, &RingValues::Sums::net))};
  if (decay_->links > 0) {
    nets.push_back(net_of(level, 1, true, further(level, &RingValues::Sums::chain)));
    // So that it is added no more often than the other one: i times q - 1, against q^i - 1.
    if (grows_) rescale(nets.back(), 1 / (decay_->ratio.lower - 1));
  }
  if (grows_) {
    nets.push_back(nets[0]);
    Patch& growth = nets.back();
    const double by = scale(level, 1) * larger_part(level).lower;
    for (std::size_t i = 0; i < growth.points.size(); ++i)
      growth.points[i] = {0, by * decay_->largest_column[i], 0};
    growth.largest = enlarged(by * largest_of(decay_->largest_column));
    growth.error = enlarged(by * decay_->column_off + gamma_bound(2) * growth.largest);
  }
  return nets;
}

}  // namespace snug
