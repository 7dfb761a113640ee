#include <snug/independence/eigenvalues.h>

#include <initializer_list>
#include <optional>
#include <utility>

#include <flint/fmpq_mat.h>
#include <flint/fmpq_poly.h>
#include <snug/independence/flint_memory.h>
#include <snug/independence/null_space.h>
#include <snug/independence/piece_step.h>
#include <support/contract.h>

namespace snug {
namespace {

class Rational {
 public:
  explicit Rational(const mpq_class& value) {
    fmpq_init(number_);
    fmpq_set_mpq(number_, value.get_mpq_t());
  }
  ~Rational() { fmpq_clear(number_); }
  Rational(const Rational&) = delete;
  Rational& operator=(const Rational&) = delete;
  [[nodiscard]] const fmpq* get() const { return number_; }

 private:
  fmpq_t number_;
};

class Polynomial {
 public:
  Polynomial() { fmpq_poly_init(p_); }
  Polynomial(std::initializer_list<mpq_class> coefficients) : Polynomial() {
    slong degree = 0;
    for (const mpq_class& c : coefficients) fmpq_poly_set_coeff_fmpq(p_, degree++, Rational(c).get());
  }
  Polynomial(const Polynomial& other) : Polynomial() { fmpq_poly_set(p_, other.p_); }
  Polynomial& operator=(const Polynomial& other) {
    fmpq_poly_set(p_, other.p_);
    return *this;
  }
  ~Polynomial() { fmpq_poly_clear(p_); }

  friend Polynomial operator*(const Polynomial& a, const Polynomial& b) {
    Polynomial result;
    fmpq_poly_mul(result.p_, a.p_, b.p_);
    return result;
  }
  friend Polynomial operator-(const Polynomial& a, const Polynomial& b) {
    Polynomial result;
    fmpq_poly_sub(result.p_, a.p_, b.p_);
    return result;
  }
  friend bool operator==(const Polynomial& a, const Polynomial& b) {
    return fmpq_poly_equal(a.p_, b.p_) != 0;
  }
  /// Without the remainder, if there is none.
  [[nodiscard]] std::optional<Polynomial> divided_by(const Polynomial& divisor) const {
    Polynomial quotient, remainder;
    fmpq_poly_divrem(quotient.p_, remainder.p_, p_, divisor.p_);
    if (!fmpq_poly_is_zero(remainder.p_)) return std::nullopt;
    return quotient;
  }
  void make_monic() { fmpq_poly_make_monic(p_, p_); }
  [[nodiscard]] fmpq_poly_struct* get() { return p_; }

 private:
  fmpq_poly_t p_;
};

Polynomial root(const mpq_class& value) { return {-value, 1}; }

// The product over k = 1, ..., n - 1 of a - b 2cos(2 pi k / n), by Dickson's polynomials: over all k it is
// b^n (D_n(a / b) - 2), where D_n(2 cos x) = 2 cos(n x).
Polynomial product_over_frequencies(const Polynomial& a, const Polynomial& b, std::uint32_t n) {
  const Polynomial two{2};
  Polynomial before = two, now = a, power = b;
  for (std::uint32_t i = 1; i < n; ++i) {
    Polynomial next = a * now - b * b * before;
    before = std::exchange(now, next);
    power = power * b;
  }
  const auto rest = (now - two * power).divided_by(a - two * b);
  SNUG_EXPECT(rest);
  return *rest;
}

using Matrix = std::vector<std::vector<mpq_class>>;

Polynomial characteristic_polynomial(const Matrix& matrix) {
  const auto size = static_cast<slong>(matrix.size());
  fmpq_mat_t entries;
  fmpq_mat_init(entries, size, size);
  for (slong r = 0; r < size; ++r) {
    for (slong c = 0; c < size; ++c) {
      fmpq_set_mpq(fmpq_mat_entry(entries, r, c),
                   matrix[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)].get_mpq_t());
    }
  }
  Polynomial result;
  fmpq_mat_charpoly(result.get(), entries);
  fmpq_mat_clear(entries);
  return result;
}

// A', rational parts of weights alone.
Matrix kept_rows(const PieceStep& step) {
  Matrix rows(step.kept, std::vector<mpq_class>(step.dimension));
  for (std::uint32_t r = 0; r < step.kept; ++r) {
    for (const auto& [point, w] : step.rows[r]) rows[r][point] = w.rational;
  }
  return rows;
}
// The neighbours' share s of the corner's mask: Loop's is 5/8 - (3 + 2cos(2 pi/n))^2/64.
void set_share(Matrix& rows, std::uint32_t n, const mpq_class& s) {
  rows[0][0] = 1 - s;
  for (std::uint32_t j = 1; j <= n; ++j) rows[0][j] = s / n;
}

std::uint32_t multiplicity(Polynomial p, const mpq_class& value) {
  std::uint32_t times = 0;
  for (auto rest = p.divided_by(root(value)); rest; rest = rest->divided_by(root(value))) ++times;
  return times;
}

std::vector<RationalEigenvalue> repeated_ones(const Polynomial& p, const Matrix& rows,
                                              const Matrix& conditions) {
  std::vector<RationalEigenvalue> found;
  for (const int of_64 : {64, 32, 24, 16, 8, 4, 2, 1}) {
    mpq_class value(of_64, 64);
    value.canonicalize();
    const std::uint32_t times = multiplicity(p, value);
    if (times < 2) continue;
    Matrix shifted = rows;
    for (std::size_t i = 0; i < shifted.size(); ++i) shifted[i][i] -= value;
    shifted.insert(shifted.end(), conditions.begin(), conditions.end());
    found.push_back({value, times, null_space(shifted, rows.size())});
  }
  return found;
}

CornerEigenvalues loop_eigenvalues(const PieceStep& step, std::uint32_t n) {
  Polynomial around = product_over_frequencies({-3, 8}, {1}, n);
  around.make_monic();
  for (const mpq_class& value :
       {mpq_class(1, 8), mpq_class(1, 8), mpq_class(1, 8), mpq_class(1, 16), mpq_class(1, 16)}) {
    around = around * root(value);
  }
  CornerEigenvalues found;
  Matrix rows = kept_rows(step);
  // Both sides are linear in s, since one row is: two values of it are all.
  found.as_stated = true;
  for (const mpq_class& s : {mpq_class(0), mpq_class(1)}) {
    set_share(rows, n, s);
    found.as_stated &= characteristic_polynomial(rows) == around * root(1) * root(mpq_class(5, 8) - s);
  }
  // Of an irrational share only eigenvectors with 0 at the corner and no mean around it are not its own.
  const Weight& own = step.rows[0][0].second;
  Polynomial all = around * root(1);
  Matrix conditions;
  if (own.is_rational()) {
    set_share(rows, n, 1 - own.rational);
    all = all * root(own.rational - mpq_class(3, 8));
  } else {
    conditions.assign(2, std::vector<mpq_class>(rows.size()));
    conditions[0][0] = 1;
    for (std::uint32_t j = 1; j <= n; ++j) conditions[1][j] = 1;
  }
  found.repeated = repeated_ones(all, rows, conditions);
  return found;
}

CornerEigenvalues catmark_eigenvalues(const PieceStep& step, std::uint32_t n) {
  // 16 x^2 - 2 (5 + C_k) x + 1 for each frequency, C_k = cos(2 pi k / n); k = 0 makes a block of its own.
  Polynomial stated = product_over_frequencies({1, -10, 16}, {0, 1}, n);
  const mpq_class m = n;
  stated = stated * characteristic_polynomial({{1 - 7 / (4 * m), 3 / (2 * m), 1 / (4 * m)},
                                               {mpq_class(3, 8), mpq_class(1, 2), mpq_class(1, 8)},
                                               {mpq_class(1, 4), mpq_class(1, 2), mpq_class(1, 4)}});
  for (const int denominator : {8, 8, 16, 16, 32, 32, 64}) stated = stated * root(mpq_class(1, denominator));
  stated.make_monic();
  const Matrix rows = kept_rows(step);
  return {characteristic_polynomial(rows) == stated, repeated_ones(stated, rows, {})};
}

}  // namespace

CornerEigenvalues corner_eigenvalues(const ExactScheme& scheme, std::uint32_t n) {
  SNUG_EXPECT((scheme.scheme == Scheme::loop || scheme.scheme == Scheme::catmark) && !scheme.older_vertices &&
              n >= 3);
  const FlintMemory memory;
  const PieceStep step = piece_step(scheme, n);
  return scheme.scheme == Scheme::loop ? loop_eigenvalues(step, n) : catmark_eigenvalues(step, n);
}

}  // namespace snug
