#include <snug/independence/modular.h>

#include <support/contract.h>

namespace snug {
namespace {

bool is_prime(std::uint32_t p) {
  if (p % 2 == 0) return p == 2;
  for (std::uint32_t d = 3; std::uint64_t{d} * d <= p; d += 2) {
    if (p % d == 0) return false;
  }
  return p > 1;
}

std::uint32_t power(std::uint64_t base, std::uint64_t exponent, std::uint64_t modulus) {
  std::uint64_t result = 1;
  for (; exponent > 0; exponent /= 2) {
    if (exponent % 2 == 1) result = result * base % modulus;
    base = base * base % modulus;
  }
  return static_cast<std::uint32_t>(result);
}

// Is z^order = 1, and no smaller power?
bool has_order(std::uint32_t z, std::uint32_t order, std::uint32_t prime) {
  if (power(z, order, prime) != 1) return false;
  for (std::uint32_t q = 2, left = order; left > 1; ++q) {
    if (left % q != 0) continue;
    if (power(z, order / q, prime) == 1) return false;
    while (left % q == 0) left /= q;
  }
  return true;
}

}  // namespace

std::uint32_t ModularField::inverse(std::uint32_t a) const { return power(a, prime - 2, prime); }

std::uint32_t ModularField::image(const Weight& w) const {
  const auto of = [&](const mpq_class& q) {
    const auto numerator = static_cast<std::uint32_t>(mpz_fdiv_ui(q.get_num_mpz_t(), prime));
    const auto denominator = static_cast<std::uint32_t>(mpz_fdiv_ui(q.get_den_mpz_t(), prime));
    SNUG_EXPECT(denominator != 0);
    return product(numerator, inverse(denominator));
  };
  std::uint32_t result = of(w.rational);
  for (const auto& [index, factor] : w.cosines)
    result = sum(result, product(of(factor), twice_cosines[index]));
  return result;
}

ModularField modular_field(std::uint32_t order, std::uint32_t above) {
  ModularField field;
  field.order = order;
  std::uint32_t p = above / order * order + 1;
  while (p <= above || p == 2 || !is_prime(p)) p += order;  // 2 divides denominators
  field.prime = p;
  for (std::uint32_t g = 2;; ++g) {
    field.root = power(g, (p - 1) / order, p);
    if (has_order(field.root, order, p)) break;
  }
  for (std::uint32_t i = 0; i <= order / 2; ++i) {
    field.twice_cosines.push_back(field.sum(power(field.root, i, p), power(field.root, order - i, p)));
  }
  return field;
}

bool ModularRank::add(std::vector<std::uint32_t> row) {
  SNUG_EXPECT(row.size() == columns_);
  for (std::size_t c = 0; c < columns_; ++c) {
    if (row[c] == 0) continue;
    std::vector<std::uint32_t>& pivot = by_pivot_[c];
    if (pivot.empty()) {
      const std::uint32_t scale = field_.inverse(row[c]);
      for (std::uint32_t& x : row) x = field_.product(x, scale);
      pivot = std::move(row);
      ++rank_;
      return true;
    }
    const std::uint64_t factor = field_.prime - row[c];
    for (std::size_t k = c; k < columns_; ++k) {
      row[k] = static_cast<std::uint32_t>((row[k] + factor * pivot[k]) % field_.prime);
    }
  }
  return false;
}

}  // namespace snug
