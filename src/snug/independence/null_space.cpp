#include <snug/independence/null_space.h>

#include <flint/fmpz_mat.h>

namespace snug {
namespace {

class IntegerMatrix {
 public:
  IntegerMatrix(std::size_t rows, std::size_t columns) {
    fmpz_mat_init(matrix_, static_cast<slong>(rows), static_cast<slong>(columns));
  }
  ~IntegerMatrix() { fmpz_mat_clear(matrix_); }
  IntegerMatrix(const IntegerMatrix&) = delete;
  IntegerMatrix& operator=(const IntegerMatrix&) = delete;

  [[nodiscard]] fmpz_mat_struct* get() { return matrix_; }
  [[nodiscard]] fmpz* entry(std::size_t r, std::size_t c) {
    return fmpz_mat_entry(matrix_, static_cast<slong>(r), static_cast<slong>(c));
  }

 private:
  fmpz_mat_t matrix_;
};

}  // namespace

std::vector<std::vector<mpq_class>> null_space(const std::vector<std::vector<mpq_class>>& rows,
                                               std::size_t columns) {
  IntegerMatrix matrix(rows.size(), columns), reduced(rows.size(), columns);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    mpz_class common = 1;
    for (const mpq_class& x : rows[r]) common = lcm(common, x.get_den());
    for (std::size_t c = 0; c < columns; ++c) {
      const mpz_class integer = rows[r][c].get_num() * (common / rows[r][c].get_den());
      fmpz_set_mpz(matrix.entry(r, c), integer.get_mpz_t());
    }
  }
  fmpz_t denominator;
  fmpz_init(denominator);
  const auto rank = static_cast<std::size_t>(fmpz_mat_rref(reduced.get(), denominator, matrix.get()));
  const auto number = [&](const fmpz* x) {
    mpz_class result;
    fmpz_get_mpz(result.get_mpz_t(), x);
    return result;
  };
  const mpz_class scale = number(denominator);
  fmpz_clear(denominator);
  std::vector<std::size_t> pivots;
  for (std::size_t r = 0, c = 0; r < rank; ++r, ++c) {
    while (fmpz_is_zero(reduced.entry(r, c))) ++c;
    pivots.push_back(c);
  }
  std::vector<std::vector<mpq_class>> basis;
  for (std::size_t free = 0, next = 0; free < columns; ++free) {
    if (next < rank && pivots[next] == free) {
      ++next;
      continue;
    }
    std::vector<mpq_class> vector(columns);
    vector[free] = 1;
    for (std::size_t r = 0; r < next; ++r) {
      mpq_class x(-number(reduced.entry(r, free)), scale);
      x.canonicalize();
      vector[pivots[r]] = x;
    }
    basis.push_back(std::move(vector));
  }
  return basis;
}

}  // namespace snug
