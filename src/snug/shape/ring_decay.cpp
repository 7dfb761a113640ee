#include <snug/shape/ring_decay.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <snug/geometry/rounding.h>
#include <snug/shape/characteristic_map.h>
#include <snug/shape/control_values.h>
#include <snug/shape/lasting_rows.h>
#include <snug/shape/matrix_power.h>

namespace snug {
namespace {

constexpr std::size_t largest_size = 120;
constexpr unsigned max_squarings = 12;
constexpr double enough_contraction = 0.5;
constexpr int improving_squarings = 10;

using Row = std::vector<double>;

// Columns V with W V = 1, about: W^T (W W^T)^-1, orthogonalised row by row. Empty where rows are nearly dependent.
std::vector<Row> dual_columns(const std::vector<Row>& rows) {
  const auto dot = [](const Row& a, const Row& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
  };
  std::vector<Row> columns;
  for (std::size_t t = 0; t < rows.size(); ++t) {
    // The part of row t across all others.
    Row across = rows[t];
    std::vector<Row> others;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (k == t) continue;
      Row other = rows[k];
      for (int pass = 0; pass < 2; ++pass) {
        for (const Row& known : others) {
          const double by = dot(other, known) / dot(known, known);
          for (std::size_t i = 0; i < other.size(); ++i) other[i] -= by * known[i];
        }
      }
      others.push_back(other);
    }
    for (int pass = 0; pass < 2; ++pass) {
      for (const Row& known : others) {
        const double by = dot(across, known) / dot(known, known);
        for (std::size_t i = 0; i < across.size(); ++i) across[i] -= by * known[i];
      }
    }
    const double size = dot(across, rows[t]);
    if (!(size > 1e-6 * dot(rows[t], rows[t]))) return {};
    for (double& x : across) x /= size;
    columns.push_back(across);
  }
  return columns;
}

double abs_sum(const Row& row) {
  double sum = 0;
  for (const double x : row) sum += std::fabs(x);
  return enlarged(sum * (1 + gamma_bound(row.size())));
}

double product(const Row& row, const Row& column) {
  return std::inner_product(row.begin(), row.end(), column.begin(), 0.0);
}

class DecaySearch {
 public:
  DecaySearch(const Stencils& step, const Stencils::Row& limit, const LastingRows& lasting)
      : step_(step), limit_(limit), lasting_(lasting), size_(step.row_count()) {}

  [[nodiscard]] bool find(RingDecay& decay) {
    columns_ = dual_columns(lasting_.rows);
    return !columns_.empty() && contracts(decay) && improve() && bound_seen(decay);
  }

 private:
  // For x with W x = 0: A^m x = (A^m - X W) x for any X, which is about A^m V here.
  bool contracts(RingDecay& decay) const {
    MatrixPower power(step_, size_);
    power.remove(limit_);
    double scale = decay.least.lower;
    for (unsigned i = 0; i <= max_squarings; ++i) {
      std::vector<double> rest = power.matrix;
      double projected = 0, projected_error = 0;
      for (std::size_t t = 0; t < columns_.size(); ++t) {
        const double own_sum = abs_sum(lasting_.rows[t]);
        double largest = 0;
        for (std::size_t r = 0; r < size_; ++r) {
          double x = 0;
          for (std::size_t c = 0; c < size_; ++c) x += power.matrix[r * size_ + c] * columns_[t][c];
          largest = std::max(largest, std::fabs(x));
          for (std::size_t c = 0; c < size_; ++c) rest[r * size_ + c] -= x * lasting_.rows[t][c];
        }
        projected += largest * own_sum;
        projected_error += largest * lasting_.error;
      }
      const double contraction = enlarged(growth_of_rows(rest, size_) + power.error + projected_error +
                                          gamma_bound(4 + columns_.size()) * (power.sum + projected));
      const double factor = enlarged(contraction / scale);
      if (factor < enough_contraction) {
        decay.period = std::size_t{1} << i;
        decay.factor = factor;
        return true;
      }
      decay.most = enlarged(decay.most * std::max(1.0, factor));
      scale = scale * scale * (1 - gamma_bound(2));
      power.square();
      if (!(scale > 1e-250) || !(decay.most < 1e9)) return false;
    }
    return false;
  }

  // Towards what lasts: a power of A times V, made dual again. No proof rests on how near it comes.
  bool improve() {
    MatrixPower power(step_, size_);
    power.remove(limit_);
    // Not so far that one column is all that is left of each.
    double apart = lasting_.spike    ? lasting_.spike->ratio.upper
                   : lasting_.larger ? lasting_.larger->ratio.upper
                                     : 1;
    for (int i = 0; i < improving_squarings && apart < 1e4 && power.sum > 1e-140; ++i, apart *= apart)
      power.square();
    const std::size_t m = columns_.size();
    std::vector<Row> images(m, Row(size_, 0.0)), seen(m, Row(m, 0.0));
    for (std::size_t t = 0; t < m; ++t) {
      for (std::size_t r = 0; r < size_; ++r) {
        for (std::size_t c = 0; c < size_; ++c) images[t][r] += power.matrix[r * size_ + c] * columns_[t][c];
      }
      // By powers of the eigenvalue all are tiny.
      const double size = largest_of(images[t]);
      if (!(size > 0)) return false;
      for (double& x : images[t]) x /= size;
      for (std::size_t k = 0; k < m; ++k) {
        for (std::size_t i = 0; i < size_; ++i) seen[k][t] += lasting_.rows[k][i] * images[t][i];
      }
    }
    const std::vector<Row> inverse = about_inverse(seen);
    if (inverse.empty()) return true;
    for (std::size_t t = 0; t < m; ++t) {
      for (std::size_t i = 0; i < size_; ++i) {
        columns_[t][i] = 0;
        for (std::size_t k = 0; k < m; ++k) columns_[t][i] += images[k][i] * inverse[k][t];
      }
    }
    return true;
  }

  // V' = V (W V)^-1 is about V. Any x is V' W x, and a rest that W does not see. With r = B V' - V' L / l, which W does not see, either,
  // B^k V' = V' (L / l)^k + sum of B^i r (L / l)^(k - 1 - i). Of a chain powers grow as k does: what is multiplied by k elsewhere.
  bool bound_seen(RingDecay& decay) const {
    const std::size_t m = columns_.size();
    const std::size_t of_least = m - (lasting_.larger ? 1 : 0) - (lasting_.spike ? 1 : 0);
    const double least = middle(decay.least), rest = 1 - decay.factor;
    const auto period = static_cast<double>(decay.period);
    Row image;
    double seen = 0;
    std::vector<Row> images;
    for (const Row& column : columns_) {
      apply(step_, column, image);
      images.push_back(image);
    }
    double mixing = 0;
    for (std::size_t t = 0; t < m; ++t) {
      for (std::size_t k = 0; k < m; ++k) {
        const double off = product(lasting_.rows[t], columns_[k]) - (k == t ? 1 : 0);
        mixing = std::max(
            mixing, std::fabs(off) + (lasting_.error + gamma_bound(size_ + 2) * abs_sum(lasting_.rows[t])) *
                                         largest_of(columns_[k]));
      }
    }
    if (!(static_cast<double>(m) * mixing < 0x1p-24)) return false;
    double widest = 0;
    for (const Row& column : columns_) widest = std::max(widest, extent(column));
    // The part of each image that W does not see, generously: with all roundings it is far below 1.
    std::vector<double> unseen;
    for (std::size_t t = 0; t < m; ++t) {
      Row left = images[t];
      for (std::size_t k = 0; k < m; ++k) {
        const double share = product(lasting_.rows[k], images[t]);
        for (std::size_t i = 0; i < size_; ++i) left[i] -= share * columns_[k][i];
      }
      unseen.push_back(extent(left) / least + 0x1p-20 * widest);
    }
    for (std::size_t t = 0; t < m; ++t) {
      const double grown =
          enlarged(2 * extent(columns_[t]) + decay.most * unseen[t] * period / rest * period / rest);
      const double row_sum = abs_sum(lasting_.rows[t]) + lasting_.error;
      seen += grown * row_sum;
      if (lasting_.links > 0 && t < of_least) {
        // At each step a chain moves this column by others, and with them comes what W does not see of these.
        Row moved = images[t];
        for (std::size_t i = 0; i < size_; ++i) moved[i] = moved[i] / least - columns_[t][i];
        double with_it = unseen[t];
        for (std::size_t k = 0; k < m; ++k)
          with_it += 2 * std::fabs(product(lasting_.rows[k], moved)) * unseen[k];
        decay.chain_seen = enlarged(
            decay.chain_seen + 2 * (extent(moved) + with_it * (1 + decay.most * period / rest)) * row_sum);
      }
    }
    // Of a larger eigenvalue's column what W does not see is the sum of B^i r / q^(i + 1).
    decay.row_error = lasting_.error;
    if (lasting_.larger) {
      decay.largest_row = lasting_.rows[of_least];
      decay.largest_column = lasting_.larger->column;
      decay.column_off = lasting_.larger->error;
    }
    if (lasting_.spike) {
      decay.spike_row = lasting_.rows.back();
      decay.spike_column = lasting_.spike->column;
      decay.spike_off = lasting_.spike->error;
    }
    decay.seen = enlarged(2 * seen);
    return std::isfinite(decay.seen);
  }

  const Stencils& step_;
  const Stencils::Row limit_;
  const LastingRows& lasting_;
  std::size_t size_;
  std::vector<Row> columns_;
};

// Of kinds that have the fan: no edge of it is sharp, or one.
bool is_spike(const CornerFan& fan) { return fan.sharp && fan.closed != fan.odd; }

// At a vertex inside that is sharp by itself, with smooth edges: the rows of first modes have no weight at it, and no other point's rule
// sees that it is sharp, so they are those of a smooth vertex. The last row is that of the largest eigenvalue.
struct RowsOfSpike {
  LastingRows rows;
  LastingColumn largest;
};
std::optional<RowsOfSpike> rows_of_spike(const Kind& kind, std::size_t corner, const Stencils& step) {
  constexpr double rounding = 64 * unit_roundoff, no_eigenvector = 1e-12;
  KindKey smooth = kind.key();
  smooth.corners[corner].sharp = false;
  const Neighbourhood around = neighbourhood(smooth);
  Stencils modes;
  kind.rules().add_corner_tangents(around.ruled(), kind.rules().corner_of(around.topology, corner), modes);
  const double eigenvalue = kind.rules().shrink_factor(smooth.corners[corner]);
  LastingRows result;
  for (std::size_t t = 0; t < 2; ++t) {
    const Stencils::Row row = modes.row(t);
    Row& weights = result.rows.emplace_back(kind.control_count(), 0.0);
    for (std::size_t i = 0; i < row.sources.size(); ++i) weights[row.sources[i]] += row.weights[i];
    result.error = std::max(result.error, CharacteristicMap::row_error(row));
    // Are they what they are taken for?
    Row image(weights.size(), 0.0);
    for (std::size_t r = 0; r < weights.size(); ++r) {
      const Stencils::Row from = step.row(r);
      for (std::size_t i = 0; i < from.sources.size(); ++i)
        image[from.sources[i]] += weights[r] * from.weights[i];
    }
    for (std::size_t c = 0; c < image.size(); ++c) {
      if (!(std::fabs(image[c] - eigenvalue * weights[c]) <= no_eigenvector * row.abs_sum))
        return std::nullopt;
    }
    if (!(row.abs_sum > 0)) return std::nullopt;
  }
  result.least = {eigenvalue * (1 - rounding), eigenvalue * (1 + rounding)};
  std::optional<LastingColumn> largest = add_largest_row(step, kind.control_count(), result);
  if (!largest) return std::nullopt;
  return RowsOfSpike{std::move(result), std::move(*largest)};
}

constexpr double apart = 1e-6;

// 1 is that of constants, which say nothing of directions.
bool decays(const Interval& eigenvalue) { return eigenvalue.upper < 1 - apart; }

// Where one edge of a fan is sharp the other ones' points take part in modes that are 0 on it: those of a smooth fan of twice as many
// faces. Other eigenvalues are 1/2, the edge's own, and at most 1/4. The largest one is alone and far from all others.
bool is_largest(const Kind& kind, std::size_t corner, const Interval& eigenvalue) {
  CornerFan smooth = kind.corner(corner);
  smooth.closed = true;
  smooth.sharp = smooth.odd = false;
  return eigenvalue.lower > std::max(0.5, kind.rules().shrink_factor(smooth)) + apart && decays(eigenvalue);
}

std::optional<LastingRows> rows_across_spike(const Kind& kind, std::size_t corner, const Stencils& step) {
  if (kind.corner(corner).odd) {
    // Of all faces at the vertex, not of some of another fan: then all sectors have one direction of the largest.
    const Neighbourhood around = neighbourhood(kind.key());
    const VertexId vertex = around.topology.from(kind.rules().corner_of(around.topology, corner));
    if (around.topology.face_valence(vertex) != kind.corner(corner).faces()) return std::nullopt;
    std::optional<LastingRows> rows = find_lasting_rows(step, kind.control_count(), true);
    if (!rows || !is_largest(kind, corner, rows->spike->ratio * rows->least)) return std::nullopt;
    return rows;
  }
  std::optional<RowsOfSpike> found = rows_of_spike(kind, corner, step);
  if (!found || !decays(found->largest.ratio * found->rows.least)) return std::nullopt;
  found->rows.spike = std::move(found->largest);
  return std::move(found->rows);
}

std::optional<LastingRows> rows_of(const Kind& kind, std::size_t corner, const Stencils& step) {
  if (!is_spike(kind.corner(corner)) || kind.corner(corner).odd)
    return find_lasting_rows(step, kind.control_count());
  std::optional<RowsOfSpike> found = rows_of_spike(kind, corner, step);
  if (!found) return std::nullopt;
  found->rows.larger = std::move(found->largest);
  return std::move(found->rows);
}

// find(kind, corner, step) of the corner that a kind comes again at.
template <class Find>
std::optional<RingDecay> decay_at_corner(const Kind& kind, const Find& find) {
  if (kind.polynomial() || kind.transient() || kind.key().polygon || kind.control_count() > largest_size)
    return std::nullopt;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    const KindChild& child = kind.children()[corner];
    if (kind.regular_corner(corner) || child.kind != &kind || child.first != 0) continue;
    const Stencils step = child.stencils();
    const std::optional<LastingRows> lasting = find(kind, corner, step);
    if (!lasting) return std::nullopt;
    RingDecay decay;
    decay.kind = &kind;
    decay.corner = corner;
    decay.least = lasting->least;
    decay.larger = lasting->larger.has_value();
    if (lasting->larger) decay.ratio = lasting->larger->ratio;
    decay.links = lasting->links;
    if (!DecaySearch(step, kind.corner_limits().row(corner), *lasting).find(decay)) return std::nullopt;
    return decay;
  }
  return std::nullopt;
}

}  // namespace

std::optional<RingDecay> make_ring_decay(const Kind& kind, const CharacteristicMap* map) {
  if (map != nullptr) return map->decay();
  return decay_at_corner(kind, rows_of);
}

std::optional<RingDecay> make_spike_decay(const Kind& kind) {
  return decay_at_corner(kind, [](const Kind& own, std::size_t corner, const Stencils& step) {
    return is_spike(own.corner(corner)) ? rows_across_spike(own, corner, step) : std::nullopt;
  });
}

}  // namespace snug
