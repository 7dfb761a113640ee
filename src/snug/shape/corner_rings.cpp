#include <snug/shape/corner_rings.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <snug/geometry/interval.h>
#include <snug/geometry/rounding.h>
#include <snug/shape/control_values.h>

namespace snug {
namespace {

// Rings that are bounded. Share of the size below which a rest is not worth more rings.
constexpr std::size_t max_rings = 120;
constexpr double small_rest = 0x1p-13;

}  // namespace

CornerRings::CornerRings(const CharacteristicMap& map, const Patch& values) : map_(&map), values_(&values) {
  for (std::size_t c = 0; c < 2; ++c) decompose(c);
  for (count_ = 1; count_ < max_rings && !(small(parts_[0]) && small(parts_[1])); ++count_) {
    for (Value& part : parts_) descend(part);
  }
  // Further ones cannot be larger than those of a period; nor than what one leaves, times the growth.
  for (Value& part : parts_) {
    const double fading = map.growth_ * part.rests.back().fading;
    const auto at = [&](std::size_t level) { return part.rests[level].extent + part.rests[level].along; };
    part.largest_after.resize(count_);
    double largest = INFINITY;
    for (std::size_t level = count_; level-- > 0;) {
      largest = enlarged(std::min(map.growth_ * at(level), std::max(at(level), largest)));
      if (level + map.period_ <= count_) {
        double widest = 0;
        for (std::size_t k = level; k < level + map.period_; ++k) widest = std::max(widest, at(k));
        largest = std::min(largest, enlarged(widest));
      }
      part.largest_after[level] = enlarged(largest + fading);
    }
  }
}

void CornerRings::decompose(std::size_t c) {
  const CharacteristicMap& map = *map_;
  Value& part = parts_[c];
  std::vector<double> y(map.size_);
  for (std::size_t i = 0; i < y.size(); ++i) y[i] = c == 0 ? values_->points[i].x : values_->points[i].y;
  part.own = map.conformal_ ? 0 : c;
  const CharacteristicMap::Shares shares = map.shares(y, *values_);
  part.m = shares.m;
  part.off = shares.off;
  for (std::size_t t = 0; t < 2; ++t) {
    part.ratios[t] =
        map.conformal_ || t == part.own ? Interval{1} : map.eigenvalues_[t] / map.eigenvalues_[part.own];
  }
  if (!map.conformal_ && map.dominant_ != part.own) {
    part.m[map.dominant_] = part.off[map.dominant_] = 0;
  }
  Rest rest;
  rest.values = std::move(y);
  double largest = values_->largest;
  for (std::size_t i = 0; i < rest.values.size(); ++i) {
    const double a = part.m[0] * map.directions_[0][i], b = part.m[1] * map.directions_[1][i];
    largest = std::max(largest, std::fabs(a) + std::fabs(b));
    rest.values[i] -= a + b;
  }
  rest.fading = enlarged((1 + map.projection()) * (values_->error + gamma_bound(8) * 3 * largest) +
                         map.off_plane(part.m));
  remove_directions(rest);
  part.rests.push_back(std::move(rest));
}

// One level on.
void CornerRings::descend(Value& part) const {
  const CharacteristicMap& map = *map_;
  const Stencils& step = map.kind_->children()[map.corner_].stencils;
  const Interval& eigenvalue = map.eigenvalues_[part.own];
  const Rest& before = part.rests.back();
  Rest rest;
  apply(step, before.values, rest.values);
  const double divisor = middle(eigenvalue);
  for (double& x : rest.values) x /= divisor;
  const double largest = largest_of(before.values) / divisor;
  const double error = (step.max_error() + gamma_bound(map.size_ + 2) * step.max_abs_sum()) * largest +
                       (gamma_bound(2) + (eigenvalue.upper - eigenvalue.lower) / eigenvalue.lower) *
                           (step.max_abs_sum() + step.max_error()) * largest;
  rest.fading = enlarged(before.fading + (1 + map.projection()) * error);
  remove_directions(rest);
  part.rests.push_back(std::move(rest));
}

// Takes off the part along V: the exact rest has none.
void CornerRings::remove_directions(Rest& rest) const {
  const CharacteristicMap& map = *map_;
  // Constants last, and no extent sees them.
  const auto centre = [&] {
    const auto [least, most] = std::minmax_element(rest.values.begin(), rest.values.end());
    const double middle = 0.5 * *least + 0.5 * *most;
    for (double& x : rest.values) x -= middle;
  };
  double largest = largest_of(rest.values);
  centre();
  const std::array<double, 2> share = map.tangent(rest.values);
  for (std::size_t i = 0; i < rest.values.size(); ++i) {
    const double a = share[0] * map.directions_[0][i], b = share[1] * map.directions_[1][i];
    largest = std::max(largest, std::fabs(a) + std::fabs(b));
    rest.values[i] -= a + b;
  }
  centre();
  rest.fading =
      enlarged(rest.fading + (1 + map.projection()) * gamma_bound(8) * 4 * largest + map.off_plane(share));
  rest.extent = extent(rest.values);
  const std::array<double, 2> left = map.tangent(rest.values);
  const double size = largest_of(rest.values);
  for (std::size_t t = 0; t < 2; ++t) {
    const double most =
        std::fabs(left[t]) + (map.row_errors_[t] + gamma_bound(map.size_ + 2) * map.row_sums_[t]) * size;
    rest.along += (map.extents_[t] + map.direction_errors_[t]) * most;
  }
  rest.along = enlarged(rest.along);
}

// Would what is left hardly be seen beside the value's own direction?
bool CornerRings::small(const Value& part) const {
  const double size = std::fabs(part.m[part.own]) * map_->extents_[part.own];
  return map_->growth_ * part.rests.back().extent <= small_rest * size;
}

CornerRings::Filled CornerRings::fill(std::size_t c, std::size_t level, bool all_further, Patch& net) const {
  const CharacteristicMap& map = *map_;
  const Value& part = parts_[c];
  std::array<double, 2> kept{};
  double error = 0;
  for (std::size_t t = 0; t < 2; ++t) {
    Interval power{1};
    for (std::size_t i = 0; i < level && part.ratios[t] != Interval{1}; ++i) power = power * part.ratios[t];
    const double m = std::fabs(part.m[t]), exact_extent = map.extents_[t] + map.direction_errors_[t];
    if (all_further && part.ratios[t] != Interval{1}) {
      // It shrinks faster: from its share to none.
      error += (m + part.off[t]) * power.upper * exact_extent;
      continue;
    }
    kept[t] = part.m[t] * middle(power);
    error += ((m + part.off[t]) * map.direction_errors_[t] + part.off[t] * map.extents_[t]) * power.upper +
             m * (power.upper - power.lower) * map.extents_[t];
  }
  const Rest& rest = part.rests[level];
  error += all_further ? part.largest_after[level] : map.growth_ * rest.fading + rest.along;
  double largest = 0, sum = 0;
  for (std::size_t i = 0; i < map.size_; ++i) {
    const double a = kept[0] * map.directions_[0][i], b = kept[1] * map.directions_[1][i];
    const double own = all_further ? 0 : rest.values[i];
    (c == 0 ? net.points[i].x : net.points[i].y) = a + b + own;
    sum = std::max(sum, std::fabs(a) + std::fabs(b) + std::fabs(own));
    largest = std::max(largest, std::fabs(a + b + own));
  }
  return {largest, enlarged(error + gamma_bound(6) * sum)};
}

Patch CornerRings::made(std::size_t level, bool all_further) const {
  Patch net;
  net.kind = map_->kind_;
  net.first = values_->first;
  net.points.resize(map_->size_);
  std::array<Filled, 2> filled;
  for (std::size_t c = 0; c < 2; ++c) filled[c] = fill(c, level, all_further, net);
  // By powers of two to a size of about 1. With turned axes a condition mixes both values: then one for both.
  if (map_->conformal_) {
    filled[0].largest = filled[1].largest = std::max(filled[0].largest, filled[1].largest);
  }
  std::array<double, 2> scales{};
  for (std::size_t c = 0; c < 2; ++c) {
    if (!(filled[c].largest > 0x1p-900)) {
      net.error = INFINITY;
      return net;
    }
    scales[c] = std::exp2(-std::ilogb(filled[c].largest));
    net.largest = std::max(net.largest, scales[c] * filled[c].largest);
    net.error = std::max(net.error, enlarged(scales[c] * filled[c].error));
  }
  for (Vector3& p : net.points) p = {scales[0] * p.x, scales[1] * p.y, 0};
  return net;
}

Patch CornerRings::net(std::size_t level) const { return level == 0 ? *values_ : made(level, false); }
Patch CornerRings::all_further(std::size_t level) const { return made(level, true); }

}  // namespace snug
