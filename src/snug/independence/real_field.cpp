#include <snug/independence/real_field.h>

#include <flint/fmpz_poly.h>

#include <support/contract.h>

namespace snug {

FieldNumber::FieldNumber(const std::vector<mpq_class>& coefficients) : FieldNumber() {
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    fmpq_poly_set_coeff_mpq(value_, static_cast<slong>(i), coefficients[i].get_mpq_t());
  }
}

RealField::RealField(std::uint32_t order) : order_(order) {
  fmpz_poly_t minimal;
  fmpz_poly_init(minimal);
  fmpz_poly_cos_minpoly(minimal, order);
  fmpq_poly_set_fmpz_poly(modulus_.get(), minimal);
  fmpz_poly_clear(minimal);
  // 2 cos((i + 1) x) = 2 cos(x) 2 cos(i x) - 2 cos((i - 1) x)
  const FieldNumber generator({0, 1});
  cosines_.push_back(FieldNumber({2}));
  cosines_.push_back(product(generator, FieldNumber({1})));
  for (std::uint32_t i = 2; i <= order / 2; ++i) {
    FieldNumber next = product(cosines_[1], cosines_[i - 1]);
    fmpq_poly_sub(next.get(), next.get(), cosines_[i - 2].get());
    cosines_.push_back(std::move(next));
  }
}

std::size_t RealField::degree() const { return static_cast<std::size_t>(fmpq_poly_degree(modulus_.get())); }

FieldNumber RealField::number(const Weight& w, std::uint32_t stride) const {
  FieldNumber result({w.rational});
  for (const auto& [index, factor] : w.cosines) {
    SNUG_EXPECT(index % stride == 0);
    add_product(FieldNumber({factor}), cosines_[index / stride], result);
  }
  return result;
}

void RealField::add_product(const FieldNumber& a, const FieldNumber& b, FieldNumber& sum) const {
  const FieldNumber c = product(a, b);
  fmpq_poly_add(sum.get(), sum.get(), c.get());
}

FieldNumber RealField::product(const FieldNumber& a, const FieldNumber& b) const {
  FieldNumber result;
  fmpq_poly_mul(result.get(), a.get(), b.get());
  if (fmpq_poly_length(result.get()) >= fmpq_poly_length(modulus_.get())) {
    fmpq_poly_rem(result.get(), result.get(), modulus_.get());
  }
  return result;
}

FieldNumber RealField::inverse(const FieldNumber& a) const {
  SNUG_EXPECT(!a.is_zero());
  FieldNumber one, result, rest;
  fmpq_poly_xgcd(one.get(), result.get(), rest.get(), a.get(), modulus_.get());
  return result;
}

}  // namespace snug
