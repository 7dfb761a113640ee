#include <snug/shape/area_piece.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <snug/geometry/rounding.h>
#include <support/point.h>

namespace snug {
namespace {

// Halvings of a piece; beyond them nothing but rounding is left.
constexpr unsigned max_halvings = 80;

template <Domain domain>
using Polynomial = AreaPiece::Polynomial<domain>;

// Values at a lattice of nodes from Bezier coefficients, row by row, and the way back.
template <Domain domain>
class Interpolation {
 public:
  static constexpr std::size_t count = Polynomial<domain>::count;
  using Matrix = std::vector<double>;
  Interpolation() : values_(count * count), coefficients_(count * count) {
    constexpr std::size_t d = AreaPiece::degree<domain>;
    const auto& scale = binomials<Polynomial<domain>>;
    Polynomial<domain>::for_each([&](std::size_t a, std::size_t b) {
      const double u = static_cast<double>(a) / d, v = static_cast<double>(b) / d;
      Polynomial<domain>::for_each([&](std::size_t i, std::size_t j) {
        const double powers =
            domain == Domain::triangle
                ? power(u, i) * power(v, j) * power(static_cast<double>(d - a - b) / d, d - i - j)
                : power(u, i) * power(1 - u, d - i) * power(v, j) * power(1 - v, d - j);
        const std::size_t k = Polynomial<domain>::place(i, j);
        values_[Polynomial<domain>::place(a, b) * count + k] = scale[k] * powers;
      });
    });
    invert();
  }
  [[nodiscard]] double value(std::size_t node, const double* coefficients) const {
    return row_times(values_, node, coefficients);
  }
  [[nodiscard]] double coefficient(std::size_t k, const double* values) const {
    return row_times(coefficients_, k, values);
  }

 private:
  static double power(double x, std::size_t n) { return n == 0 ? 1 : x * power(x, n - 1); }
  static double row_times(const Matrix& m, std::size_t row, const double* x) {
    double sum = 0;
    for (std::size_t k = 0; k < count; ++k) sum += m[row * count + k] * x[k];
    return sum;
  }
  // Gauss and Jordan, with pivots. Any inverse will do: it only says which polynomial is compared with.
  void invert() {
    Matrix a = values_;
    for (std::size_t k = 0; k < count; ++k) coefficients_[k * count + k] = 1;
    for (std::size_t k = 0; k < count; ++k) {
      std::size_t pivot = k;
      for (std::size_t r = k + 1; r < count; ++r) {
        if (std::fabs(a[r * count + k]) > std::fabs(a[pivot * count + k])) pivot = r;
      }
      for (std::size_t c = 0; c < count; ++c) {
        std::swap(a[k * count + c], a[pivot * count + c]);
        std::swap(coefficients_[k * count + c], coefficients_[pivot * count + c]);
      }
      const double by = 1 / a[k * count + k];
      for (std::size_t c = 0; c < count; ++c) {
        a[k * count + c] *= by;
        coefficients_[k * count + c] *= by;
      }
      for (std::size_t r = 0; r < count; ++r) {
        const double factor = a[r * count + k];
        if (r == k || factor == 0) continue;
        for (std::size_t c = 0; c < count; ++c) {
          a[r * count + c] -= factor * a[k * count + c];
          coefficients_[r * count + c] -= factor * coefficients_[k * count + c];
        }
      }
    }
  }

  Matrix values_, coefficients_;
};

template <Domain domain>
const Interpolation<domain>& interpolation() {
  static const Interpolation<domain> only;
  return only;
}

std::size_t count_on(Domain domain) {
  return domain == Domain::triangle ? Polynomial<Domain::triangle>::count : Polynomial<Domain::square>::count;
}

}  // namespace

AreaPiece::AreaPiece(Domain domain, const Coefficients& normal, double error)
    : domain_(domain), share_(area_of(domain)), error_(error), normal_(normal) {
  bound();
}

// The length of the mean normal is at most the mean length, and that at most the mean of coefficients' lengths.
void AreaPiece::bound() {
  const std::size_t count = count_on(domain_);
  const double by = 1 / static_cast<double>(count);
  Vector3 sum;
  double lengths = 0;
  largest_ = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const Vector3 n{normal_[0][k], normal_[1][k], normal_[2][k]};
    sum = sum + n;
    lengths += length(n);
    largest_ = std::max(largest_, max_abs(n));
  }
  const double slack = spatial_error(error_ + gamma_bound(64) * largest_) + 0x1p-500;
  area_.lower = share_ * std::max(0.0, length(by * sum) - slack);
  area_.upper = share_ * enlarged(by * lengths + slack);
}

bool AreaPiece::can_improve() const {
  const double noise = share_ * 32 * spatial_error(error_ + gamma_bound(64) * largest_);
  return level_ < max_halvings && gap() > noise;
}

void AreaPiece::tighten() {
  tight_ = true;
  if (domain_ == Domain::triangle) {
    tighten_on<Domain::triangle>();
  } else {
    tighten_on<Domain::square>();
  }
}

// | |N| - p | = |N.N - p p| / (|N| + p), and both in the denominator have lower bounds.
template <Domain domain>
void AreaPiece::tighten_on() {
  using Normal = Polynomial<domain>;
  const Interpolation<domain>& nodes = interpolation<domain>();
  const auto& scale = binomials<Normal>;
  std::array<double, Normal::count> lengths;
  for (std::size_t node = 0; node < Normal::count; ++node) {
    Vector3 n;
    for (std::size_t a = 0; a < 3; ++a) n[a] = nodes.value(node, normal_[a].data());
    lengths[node] = length(n);
  }
  Normal p;
  double least = INFINITY, largest = 0;
  for (std::size_t k = 0; k < Normal::count; ++k) {
    const double coefficient = nodes.coefficient(k, lengths.data());
    least = std::min(least, coefficient);
    largest = std::max(largest, coefficient);
    p.scaled[k] = coefficient * scale[k];
  }
  if (!(least > 0) || !std::isfinite(largest)) return;

  ProductOf<Normal, Normal> difference;
  add_product(p, p, -1, difference);
  Vector3 middle;
  for (std::size_t a = 0; a < 3; ++a) {
    Normal n;
    for (std::size_t k = 0; k < Normal::count; ++k) {
      n.scaled[k] = normal_[a][k] * scale[k];
      middle[a] += normal_[a][k];
    }
    add_product(n, n, 1, difference);
  }
  using Square = ProductOf<Normal, Normal>;
  double off = 0;
  for (std::size_t k = 0; k < Square::count; ++k)
    off += std::fabs(difference.scaled[k]) / binomials<Square>[k];
  off /= static_cast<double>(Square::count);
  const double off_error = enlarged(3 * error_ * (2 * largest_ + error_) +
                                    gamma_bound(160) * (3 * largest_ * largest_ + largest * largest)) +
                           0x1p-900;

  // The normal is at least this long.
  const double size = length(middle);
  double along = 0;
  if (size > 0x1p-300) {
    along = INFINITY;
    for (std::size_t k = 0; k < Normal::count; ++k) {
      along = std::min(along, dot(middle, {normal_[0][k], normal_[1][k], normal_[2][k]}) / size);
    }
    along = std::max(0.0, along - spatial_error(error_ + gamma_bound(32) * largest_));
  }
  const double both = (least * (1 - gamma_bound(8)) + along) * (1 - gamma_bound(8));
  const double reach = enlarged((off + off_error) / both + gamma_bound(128) * largest);
  const double mean = mean_of(p);
  area_.lower = std::max(area_.lower, share_ * (mean - reach));
  area_.upper = std::min(area_.upper, share_ * (mean + reach));
}

std::pair<AreaPiece, AreaPiece> AreaPiece::split() const {
  return domain_ == Domain::triangle ? split_on<Domain::triangle>() : split_on<Domain::square>();
}

namespace {

// The coefficient (i, j) after `turns` of the domain's corners: of a square, from u to v.
template <Domain domain>
std::size_t turned_place(std::size_t i, std::size_t j, unsigned turns) {
  constexpr std::size_t d = AreaPiece::degree<domain>;
  if (turns == 0) return Polynomial<domain>::place(i, j);
  if (domain == Domain::square) return Polynomial<domain>::place(j, i);
  return turns == 1 ? Polynomial<domain>::place(d - i - j, i) : Polynomial<domain>::place(j, d - i - j);
}

// How much the coefficients change along u after some turns.
template <Domain domain>
double change_along(const AreaPiece::Coefficients& normal, unsigned turns) {
  double sum = 0;
  Polynomial<domain>::for_each([&](std::size_t i, std::size_t j) {
    if (i + 1 >= Polynomial<domain>::width(j)) return;
    const std::size_t here = turned_place<domain>(i, j, turns), next = turned_place<domain>(i + 1, j, turns);
    for (std::size_t a = 0; a < 3; ++a) sum += std::fabs(normal[a][next] - normal[a][here]);
  });
  return sum;
}

}  // namespace

// De Casteljau along u, for each power of v.
template <Domain domain>
std::pair<AreaPiece, AreaPiece> AreaPiece::split_on() const {
  using Normal = Polynomial<domain>;
  constexpr std::size_t d = degree<domain>;
  unsigned turns = 0;
  double most = -1;
  for (unsigned t = 0; t < (domain == Domain::triangle ? 3 : 2); ++t) {
    const double change = change_along<domain>(normal_, t);
    if (change > most) turns = t;
    most = std::max(most, change);
  }
  std::pair<AreaPiece, AreaPiece> halves{AreaPiece(), AreaPiece()};
  for (AreaPiece* half : {&halves.first, &halves.second}) {
    half->domain_ = domain_;
    half->level_ = level_ + 1;
    half->share_ = share_ / 2;
    half->error_ = enlarged(error_ + gamma_bound(2 * d) * largest_);
  }
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t j = 0; j <= d; ++j) {
      const std::size_t width = Normal::width(j);
      std::array<double, d + 1> row;
      for (std::size_t i = 0; i < width; ++i) row[i] = normal_[a][turned_place<domain>(i, j, turns)];
      for (std::size_t step = 0; step < width; ++step) {
        halves.first.normal_[a][Normal::place(step, j)] = row[0];
        halves.second.normal_[a][Normal::place(width - 1 - step, j)] = row[width - 1 - step];
        for (std::size_t i = 0; i + step + 1 < width; ++i) row[i] = 0.5 * (row[i] + row[i + 1]);
      }
    }
  }
  for (AreaPiece* half : {&halves.first, &halves.second}) half->bound();
  return halves;
}

}  // namespace snug
