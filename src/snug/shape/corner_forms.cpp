#include <snug/shape/corner_forms.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <snug/geometry/rounding.h>
#include <snug/shape/dense_rows.h>

namespace snug {
namespace {

// Kinds of more control points are left to their factors.
constexpr std::size_t most_points = 80;

// Integrals of products of derivatives of functions: of u with u, of u with v, of v with v.
struct Forms {
  std::array<std::vector<double>, 3> entries;
  double error = 0;  // of the entries of each, in sum

  explicit Forms(std::size_t functions) {
    for (auto& form : entries) form.assign(functions * functions, 0.0);
  }
  // The largest sum of the sizes of the entries of one.
  [[nodiscard]] double size() const {
    double largest = 0;
    for (const auto& form : entries) {
      double sum = 0;
      for (const double x : form) sum += std::fabs(x);
      largest = std::max(largest, sum);
    }
    return enlarged(largest * (1 + gamma_bound(entries[0].size())));
  }
};

// Of rows by columns numbers, sums of a row's sizes at most `sum`, of their errors at most `error`.
struct Rows {
  std::span<const double> matrix;
  std::size_t count, columns;
  double sum, error;
};

// Adds forms of what rows make of points, as forms of these points.
void add(const Forms& forms, const Rows& rows, Forms& to) {
  const std::size_t m = rows.count, n = rows.columns;
  const double before = to.size();
  std::vector<double> half(m * n);
  for (std::size_t form = 0; form < 3; ++form) {
    std::fill(half.begin(), half.end(), 0.0);
    for (std::size_t i = 0; i < m; ++i) {
      for (std::size_t k = 0; k < m; ++k) {
        const double x = forms.entries[form][i * m + k];
        for (std::size_t c = 0; c < n; ++c) half[i * n + c] += x * rows.matrix[k * n + c];
      }
    }
    for (std::size_t k = 0; k < m; ++k) {
      for (std::size_t i = 0; i < n; ++i) {
        const double x = rows.matrix[k * n + i];
        for (std::size_t c = 0; c < n; ++c) to.entries[form][i * n + c] += x * half[k * n + c];
      }
    }
  }
  const double size = forms.size(), sum = rows.sum + rows.error;
  to.error = enlarged(to.error + sum * sum * forms.error + rows.error * (2 * sum + rows.error) * size +
                      gamma_bound(4 * m + 8) * (before + sum * sum * size));
}

// Points of Gauss's rule that integrates polynomials of degree 7 over [0, 1], and their weights.
constexpr std::array<double, 4> gauss_points{0.06943184420297371, 0.33000947820757187, 0.66999052179242813,
                                             0.93056815579702629};
constexpr std::array<double, 4> gauss_weights{0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                              0.17392742256872693};

// Adds products of the basis functions' derivatives at a parameter.
void add_products(RegularBasis basis, double u, double v, double weight, Forms& to) {
  const std::size_t count = basis_count(basis);
  constexpr std::size_t lanes = 4;
  std::array<std::uint32_t, max_basis_count> lattice;
  for (std::size_t i = 0; i < count; ++i) lattice[i] = static_cast<std::uint32_t>(i);
  const kernels::LatticePlace at{1 - u - v, u, v, lattice.data()};
  std::array<double, max_basis_count> by_u{}, by_v{};
  for (std::size_t first = 0; first < count; first += lanes) {
    std::array<kernels::NetPoint, max_basis_count> units{};
    for (std::size_t k = 0; k < lanes && first + k < count; ++k) units[first + k][k] = 1;
    kernels::BasisSums sums;
    kernels::sum_derivatives(basis, units.data(), at, sums);
    for (std::size_t k = 0; k < lanes && first + k < count; ++k) {
      by_u[first + k] = sums.along_u[k];
      by_v[first + k] = sums.along_v[k];
    }
  }
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t l = 0; l < count; ++l) {
      to.entries[0][k * count + l] += weight * by_u[k] * by_u[l];
      to.entries[1][k * count + l] += weight * by_u[k] * by_v[l];
      to.entries[2][k * count + l] += weight * by_v[k] * by_v[l];
    }
  }
}

// Of the basis functions of a regular piece. Products have degree 6 in u and in v on squares, 6 on triangles.
Forms regular_forms(RegularBasis basis, bool triangular) {
  Forms forms(basis_count(basis));
  constexpr std::array<std::array<double, 2>, 4> corners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      const double s = gauss_points[i], t = gauss_points[j], weight = gauss_weights[i] * gauss_weights[j];
      if (is_tensor(basis)) {
        add_products(basis, s, t, weight, forms);
      } else if (triangular) {
        add_products(basis, s, t * (1 - s), weight * (1 - s), forms);
      } else {  // a polynomial on each triangle of an edge and the middle, at s = 1
        for (std::size_t k = 0; k < 4; ++k) {
          const auto &p = corners[k], &q = corners[(k + 1) % 4];
          const auto at = [&](std::size_t a) { return 0.5 * s + (1 - s) * ((1 - t) * p[a] + t * q[a]); };
          add_products(basis, at(0), at(1), weight * (1 - s) * 0.5, forms);
        }
      }
    }
  }
  // Products of derivatives of at most derivative_sum, whose parameters are off by few roundings, on an area of at most 1.
  constexpr double sum = BasisBounds::derivative_sum;
  const double off = BasisBounds::derivative_error(1, 0, 16 * unit_roundoff);
  forms.error = enlarged(off * (2 * sum + off) + gamma_bound(256) * sum * sum);
  return forms;
}

// Of a triangle whose corners are named from another one on: `first` is its corner 0 as the result names them.
Forms turned(const Forms& forms, std::size_t first) {
  if (first == 0) return forms;
  Forms result = forms;
  const std::size_t n =
      static_cast<std::size_t>(std::sqrt(static_cast<double>(forms.entries[0].size())) + 0.5);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const std::size_t at = i * n + j;
      const double uu = forms.entries[0][at], uv = forms.entries[1][at], vu = forms.entries[1][j * n + i],
                   vv = forms.entries[2][at];
      // Derivatives along u and v are, of those here, -x_v and x_u - x_v; or x_v - x_u and -x_u.
      if (first == 1) {
        result.entries[0][at] = vv;
        result.entries[1][at] = vv - vu;
        result.entries[2][at] = uu - uv - vu + vv;
      } else {
        result.entries[0][at] = uu - uv - vu + vv;
        result.entries[1][at] = uu - vu;
        result.entries[2][at] = uu;
      }
    }
  }
  result.error = enlarged(4 * forms.error + gamma_bound(8) * 4 * forms.size());
  return result;
}

// Adds those of a regular piece of a step.
void add_piece(const KindStep& step, const KindStep::Piece& piece, std::size_t columns, Forms& to) {
  const SchemeRules& rules = piece.kind->rules();
  std::vector<double> matrix(piece.lattice.size() * columns, 0.0);
  const std::size_t ghosts = step.stencils.row_count();
  double sum = 0, error = 0;
  for (std::size_t r = 0; r < piece.lattice.size(); ++r) {
    const std::size_t place = piece.lattice[r];
    const Stencils::Row row = place < ghosts ? step.stencils.row(place) : step.ghosts.row(place - ghosts);
    for (std::size_t i = 0; i < row.sources.size(); ++i)
      matrix[r * columns + row.sources[i]] += row.weights[i];
    sum = std::max(sum, row.abs_sum);
    error = std::max(error, row.error + gamma_bound(8) * row.abs_sum);
  }
  const Forms forms = turned(regular_forms(rules.basis, rules.triangular()), piece.first);
  add(forms, {matrix, piece.lattice.size(), columns, sum, error}, to);
}

}  // namespace

PieceArea CornerForms::area_of(std::span<const kernels::NetPoint> points, const Point3& middle,
                               double extent_sq, double error) const {
  std::array<kernels::NetPoint, most_points> from;
  for (std::size_t i = 0; i < points.size(); ++i) {
    from[i] = {points[i][0] - middle.x, points[i][1] - middle.y, points[i][2] - middle.z, 0};
  }
  double uu = 0, uv = 0, vv = 0;
  Vector3 flux;
  const std::array<double, 4>* weights = pairs_.data();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3 p{from[i][0], from[i][1], from[i][2]};
    for (std::size_t j = 0; j <= i; ++j, ++weights) {
      const Vector3 q{from[j][0], from[j][1], from[j][2]};
      const double product = dot(p, q);
      uu += (*weights)[0] * product;
      uv += (*weights)[1] * product;
      vv += (*weights)[2] * product;
      flux = flux + (*weights)[3] * cross(q, p);
    }
  }
  constexpr std::size_t roundings = most_points * most_points;
  const double extent = std::sqrt(extent_sq);
  const double off =
      enlarged((rest_ + gamma_bound(roundings) * size_) * extent_sq + 3 * size_ * error * (extent + error));
  const double all = std::max(0.0, uu + off) * std::max(0.0, vv + off),
               mixed = std::max(0.0, std::fabs(uv) - off);
  const double upper = enlarged(std::sqrt(std::max(0.0, all - mixed * mixed) + 8 * unit_roundoff * all));
  const double flux_error = 2 * off;
  return {std::max(0.0, length(flux) * (1 - 0x1p-42) - flux_error), upper, flux, flux_error};
}

std::optional<CornerForms> make_corner_forms(const Kind& kind, double area_factor) {
  const std::size_t n = kind.control_count();
  if (kind.polynomial() || kind.transient() || n > most_points || !(area_factor < INFINITY)) return {};
  const KindStep& step = kind.step();
  const KindStep::Piece* again = nullptr;
  for (const KindStep::Piece& piece : step.pieces) {
    if (piece.kind->polynomial()) continue;
    if (piece.kind != &kind || piece.first != 0 || again != nullptr) return {};
    again = &piece;
  }
  if (again == nullptr) return {};
  Forms forms(n);
  for (const KindStep::Piece& piece : step.pieces) {
    if (&piece != again) add_piece(step, piece, n, forms);
  }
  // Of two, four, ... steps, until what is left after them is nothing beside the rest.
  DenseRows rows(n);
  rows.step(step.stencils, again->control);
  CornerForms result;
  for (unsigned doublings = 0;; ++doublings) {
    const double growth = rows.growth(), size = forms.size();
    const double left = enlarged(area_factor * growth * growth);
    if (left <= 0x1p-40 * size || doublings == 8) {
      result.rest_ = enlarged(left + forms.error);
      result.size_ = size;
      break;
    }
    const Forms before = forms;
    add(before, {rows.matrix(), n, n, rows.sum(), rows.error()}, forms);
    rows.square();
  }
  if (!(result.rest_ <= 0x1p-20 * result.size_)) return {};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const auto both = [&](std::size_t form) {
        return forms.entries[form][i * n + j] + (j < i ? forms.entries[form][j * n + i] : 0);
      };
      result.pairs_.push_back(
          {both(0), both(1), both(2), forms.entries[1][j * n + i] - forms.entries[1][i * n + j]});
    }
  }
  return result;
}

}  // namespace snug
