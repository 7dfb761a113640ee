#include <snug/shape/characteristic_map.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <snug/geometry/interval.h>
#include <snug/geometry/rounding.h>
#include <snug/shape/control_values.h>
#include <snug/shape/matrix_power.h>

namespace snug {
namespace {

// Larger matrices are not worth their products.
constexpr std::size_t largest_size = 200;
constexpr unsigned max_squarings = 14;
constexpr int max_iterations = 4000;

// A bound that is not proved by much is of no use.
constexpr double enough_contraction = 0.95;

bool suitable(const Kind& kind, std::size_t corner) {
  const CornerFan& fan = kind.corner(corner);
  return !fan.odd && kind.control_count() <= largest_size;
}

}  // namespace

std::array<double, 2> CharacteristicMap::tangent(const std::vector<double>& values) const {
  std::array<double, 2> sums{};
  for (std::size_t t = 0; t < 2; ++t) {
    for (std::size_t c = 0; c < size_; ++c) sums[t] += rows_[t][c] * values[c];
  }
  return sums;
}

// How much larger extents may be after the part along V is taken off.
double CharacteristicMap::projection() const {
  double sum = 0;
  for (std::size_t t = 0; t < 2; ++t) {
    sum += (extents_[t] + direction_errors_[t]) * (row_sums_[t] + row_errors_[t]);
  }
  return enlarged(sum);
}

// From (W A)_c = l W_c, where W_c is large.
bool CharacteristicMap::find_eigenvalues(const Kind& kind, const Stencils& step) {
  const MatrixPower a(step, size_);
  for (std::size_t t = 0; t < 2; ++t) {
    const Stencils::Row row = kind.corner_tangents().row(2 * corner_ + t);
    rows_[t].assign(size_, 0.0);
    for (std::size_t i = 0; i < row.sources.size(); ++i) rows_[t][row.sources[i]] += row.weights[i];
    row_sums_[t] = row.abs_sum;
    row_errors_[t] = row_error(row);
    const double largest = largest_of(rows_[t]);
    if (!(largest > 0)) return false;
    Interval value{0, 1};
    for (std::size_t c = 0; c < size_; ++c) {
      double product = 0;
      for (std::size_t r = 0; r < size_; ++r) product += rows_[t][r] * a.matrix[r * size_ + c];
      const double error = enlarged((row_sums_[t] + row_errors_[t]) * a.error + row_errors_[t] * a.sum +
                                    gamma_bound(size_ + 2) * row_sums_[t] * a.sum);
      const double w = rows_[t][c];
      if (std::fabs(w) >= 0.5 * largest) {
        const Interval found = Interval{rounded_down(product - error), rounded_up(product + error)} /
                               Interval{rounded_down(w - row_errors_[t]), rounded_up(w + row_errors_[t])};
        value = {std::max(value.lower, found.lower), std::min(value.upper, found.upper)};
      }
    }
    if (!(value.lower <= value.upper) || !(value.lower > 0.05) || !(value.upper < 0.99)) return false;
    // Are these rows what they are taken for? The claim W A = L W itself is derived, not measured.
    for (std::size_t c = 0; c < size_; ++c) {
      double product = 0;
      for (std::size_t r = 0; r < size_; ++r) product += rows_[t][r] * a.matrix[r * size_ + c];
      if (std::fabs(product - middle(value) * rows_[t][c]) > 1e-10 * largest) return false;
    }
    eigenvalues_[t] = value;
  }
  const CornerFan& fan = kind.corner(corner_);
  // The two first modes of a closed fan; both edges of a sharp corner are halved.
  if (fan.closed || fan.sharp) {
    const Interval both{std::max(eigenvalues_[0].lower, eigenvalues_[1].lower),
                        std::min(eigenvalues_[0].upper, eigenvalues_[1].upper)};
    if (!(both.lower <= both.upper)) return false;
    eigenvalues_ = {both, both};
    conformal_ = true;
    return true;
  }
  if (eigenvalues_[0].lower > eigenvalues_[1].upper) {
    dominant_ = 0;
  } else if (eigenvalues_[1].lower > eigenvalues_[0].upper) {
    dominant_ = 1;
  } else {
    return false;
  }
  return true;
}

// By iteration: no proof rests on how near they come. Constants, which no extent sees, would grow.
bool CharacteristicMap::find_directions(const Stencils& step) {
  for (std::size_t t = 0; t < 2; ++t) directions_[t] = rows_[t];
  std::array<std::vector<double>, 2> next;
  double before = INFINITY;
  for (int i = 0; i < max_iterations; ++i) {
    for (std::size_t t = 0; t < 2; ++t) {
      apply(step, directions_[t], next[t]);
      const auto [least, most] = std::minmax_element(next[t].begin(), next[t].end());
      const double middle = 0.5 * (*least + *most);
      for (double& x : next[t]) x -= middle;
    }
    const auto a = tangent(next[0]), b = tangent(next[1]);
    const double determinant = a[0] * b[1] - a[1] * b[0];
    if (!(std::fabs(determinant) > 1e-100)) return false;
    double change = 0, size = 0;
    for (std::size_t c = 0; c < size_; ++c) {
      const double x = (b[1] * next[0][c] - a[1] * next[1][c]) / determinant;
      const double y = (a[0] * next[1][c] - b[0] * next[0][c]) / determinant;
      change = std::max({change, std::fabs(x - directions_[0][c]), std::fabs(y - directions_[1][c])});
      size = std::max({size, std::fabs(x), std::fabs(y)});
      directions_[0][c] = x;
      directions_[1][c] = y;
    }
    if (!std::isfinite(change)) return false;
    if (i > 40 && (change <= 4e-16 * size || (change <= 1e-13 * size && change >= before))) return true;
    before = change;
  }
  return true;
}

bool CharacteristicMap::bound_remainders(const Stencils& step) {
  // How far the directions, made exact by V (W V)^-1, are from these.
  double mixing = 0;
  for (std::size_t t = 0; t < 2; ++t) {
    extents_[t] = extent(directions_[t]);
    const auto image = tangent(directions_[t]);
    const double largest = largest_of(directions_[t]);
    for (std::size_t k = 0; k < 2; ++k) {
      const double off = std::fabs(image[k] - (k == t ? 1.0 : 0.0));
      mixing =
          std::max(mixing, off + row_errors_[k] * largest + gamma_bound(size_ + 4) * row_sums_[k] * largest);
    }
  }
  if (!(mixing < 0x1p-20)) return false;
  // |(1 + E)^-1 - 1| <= |E| / (1 - |E|) for row sums, of two entries.
  mixing = enlarged(2 * mixing / (1 - 2 * mixing));
  const double exact = enlarged(mixing * (extents_[0] + extents_[1]));

  const double least = std::min(eigenvalues_[0].lower, eigenvalues_[1].lower);
  MatrixPower power(step, size_);
  power.remove(kind_->corner_limits().row(corner_));
  double scale = least;  // least^(2^i), a lower bound
  std::array<double, 2> shrink{eigenvalues_[0].lower, eigenvalues_[1].lower};
  std::array<double, 2> sums{1, 1};
  std::array<double, 2> powers{middle(eigenvalues_[0]), middle(eigenvalues_[1])};
  const double step_sum = step.max_abs_sum();
  for (unsigned i = 0;; ++i) {
    std::vector<double> rest = power.matrix;
    double projected = 0, projected_error = 0;
    for (std::size_t t = 0; t < 2; ++t) {
      const double largest = std::fabs(powers[t]) * largest_of(directions_[t]);
      projected += largest * row_sums_[t];
      projected_error += largest * row_errors_[t];
    }
    for (std::size_t r = 0; r < size_; ++r) {
      for (std::size_t t = 0; t < 2; ++t) {
        const double x = powers[t] * directions_[t][r];
        for (std::size_t c = 0; c < size_; ++c) rest[r * size_ + c] -= x * rows_[t][c];
      }
    }
    // x powers * directions is rounded itself, but any X does: what counts is its product with W.
    const double contraction =
        enlarged(growth_of_rows(rest, size_) + power.error + projected_error * (1 + 0x1p-40) +
                 gamma_bound(8) * (power.sum + projected));
    const double factor = enlarged(contraction / scale);
    if (factor < enough_contraction) {
      contraction_.period = std::size_t{1} << i;
      contraction_.factor = factor;
      for (std::size_t t = 0; t < 2; ++t) {
        const double own = enlarged(contraction / shrink[t]);
        sums[t] = enlarged(sums[t] / (1 - own));
      }
      break;
    }
    if (i == max_squarings) return false;
    contraction_.growth = enlarged(contraction_.growth * std::max(1.0, factor));
    for (std::size_t t = 0; t < 2; ++t) {
      sums[t] = enlarged(sums[t] * (1 + contraction / shrink[t]));
      shrink[t] = shrink[t] * shrink[t] * (1 - gamma_bound(2));
      powers[t] *= powers[t];
    }
    scale = scale * scale * (1 - gamma_bound(2));
    power.square();
    if (!(scale > 1e-250) || !std::isfinite(contraction_.growth)) return false;
  }
  // r = A V / l - V, of V made exact; V itself is V + sum (A / l)^i r.
  std::vector<double> image;
  for (std::size_t t = 0; t < 2; ++t) {
    apply(step, directions_[t], image);
    const double largest = largest_of(directions_[t]), l = eigenvalues_[t].lower;
    const double image_error = enlarged((step.max_error() + gamma_bound(size_ + 2) * step_sum) * largest);
    const double middle_l = middle(eigenvalues_[t]);
    std::vector<double> residual(size_);
    for (std::size_t c = 0; c < size_; ++c) residual[c] = image[c] / middle_l - directions_[t][c];
    const double spread = (eigenvalues_[t].upper - eigenvalues_[t].lower) / (l * l);
    const double error = image_error / l + spread * (step_sum * largest + image_error) +
                         gamma_bound(4) * (step_sum * largest / l + largest) + exact * (1 + step_sum / l);
    direction_errors_[t] = enlarged(sums[t] * (extent(residual) + error) + exact);
    if (!(direction_errors_[t] < 0x1p-14 * extents_[t])) return false;
  }
  return true;
}

std::optional<CharacteristicMap> make_characteristic_map(const Kind& kind) {
  if (kind.polynomial() || kind.transient() || kind.key().polygon || !kind.key().plain()) return std::nullopt;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    if (kind.regular_corner(corner) || !suitable(kind, corner)) continue;
    const KindChild& child = kind.children()[corner];
    if (child.kind != &kind || child.first != 0) continue;
    CharacteristicMap map;
    map.kind_ = &kind;
    map.corner_ = corner;
    map.size_ = kind.control_count();
    const Stencils step = child.stencils();
    if (map.find_eigenvalues(kind, step) && map.find_directions(step) && map.bound_remainders(step)) {
      return map;
    }
    return std::nullopt;
  }
  return std::nullopt;
}

RingDecay CharacteristicMap::decay() const {
  RingDecay decay;
  decay.kind = kind_;
  decay.corner = corner_;
  decay.least = eigenvalues_[conformal_ ? 0 : 1 - dominant_];
  if (!conformal_) {
    decay.ratio = eigenvalues_[dominant_] / decay.least;
    decay.larger = true;
    decay.largest_row = rows_[dominant_];
    decay.largest_column = directions_[dominant_];
    decay.row_error = row_errors_[dominant_];
    decay.column_off = direction_errors_[dominant_];
  }
  decay.period = contraction_.period;
  decay.factor = contraction_.factor;
  decay.most = contraction_.growth;
  decay.seen = projection();
  return decay;
}

// Upper bound of the extents of A^j r over the least eigenvalue's powers: some powers are taken, the others
// shrink what these leave. `rest` is r up to extents of `error`.
double CharacteristicMap::largest_rest(std::vector<double> rest, double error) const {
  constexpr int powers = 16;
  const Stencils step = kind_->children()[corner_].stencils();
  const double least = std::min(eigenvalues_[0].lower, eigenvalues_[1].lower);
  const double rounding = step.max_error() + gamma_bound(size_ + 2) * step.max_abs_sum();
  double best = INFINITY, before = 0, scale = 1;
  std::vector<double> next;
  for (int i = 0; i <= powers; ++i) {
    const double now = enlarged((extent(rest) + error) / scale);
    best = std::min(best, std::max(before, enlarged(contraction_.growth * now)));
    before = std::max(before, now);
    apply(step, rest, next);
    error = enlarged(step.max_abs_sum() * error + rounding * largest_of(rest));
    rest.swap(next);
    scale = scale * least * (1 - gamma_bound(2));
  }
  return best;
}

CharacteristicMap::Shares CharacteristicMap::shares(const std::vector<double>& y, const Patch& values) const {
  Shares shares{tangent(y), {}};
  for (std::size_t t = 0; t < 2; ++t) {
    shares.off[t] = enlarged((row_errors_[t] + gamma_bound(size_ + 2) * row_sums_[t]) * values.largest +
                             (row_sums_[t] + row_errors_[t]) * values.error);
  }
  return shares;
}

// Upper bound, in extents, of what one value's net of these shares is off, and of all that shrinks faster.
double CharacteristicMap::left_out(const std::vector<double>& y, const Shares& shares,
                                   const Patch& values) const {
  double error = 0, largest = values.largest;
  std::vector<double> rest(size_);
  for (std::size_t i = 0; i < size_; ++i) {
    const double first = shares.m[0] * directions_[0][i], second = shares.m[1] * directions_[1][i];
    rest[i] = y[i] - (first + second);
    largest = std::max(largest, std::fabs(first) + std::fabs(second));
  }
  for (std::size_t t = 0; t < 2; ++t) {
    error += direction_errors_[t] * (std::fabs(shares.m[t]) + shares.off[t]) + shares.off[t] * extents_[t];
  }
  const double off_rest = enlarged(values.error + gamma_bound(8) * 2 * largest + error);
  return enlarged(error + largest_rest(std::move(rest), off_rest) + gamma_bound(4) * 2 * largest);
}

CharacteristicMap::LimitNets CharacteristicMap::limit_nets(const Patch& patch) const {
  LimitNets nets;
  for (Patch* net : {&nets.net, &nets.dominant}) {
    net->kind = kind_;
    net->first = patch.first;
    net->points.resize(size_);
  }
  std::vector<double> y(size_);
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < size_; ++i) y[i] = patch.points[i][c];
    const Shares own = shares(y, patch);
    for (std::size_t i = 0; i < size_; ++i) {
      const std::array<double, 2> parts{own.m[0] * directions_[0][i], own.m[1] * directions_[1][i]};
      nets.net.points[i][c] = parts[0] + parts[1];
      nets.dominant.points[i][c] = conformal_ ? parts[0] + parts[1] : parts[dominant_];
    }
    nets.net.error = std::max(nets.net.error, left_out(y, own, patch));
  }
  for (Patch* net : {&nets.net, &nets.dominant}) {
    for (const Vector3& p : net->points) net->largest = std::max(net->largest, max_abs(p));
  }
  nets.dominant.error = nets.net.error;
  return nets;
}

}  // namespace snug
