#pragma once

#include <cstdint>
#include <vector>

#include <gmpxx.h>

#include <flint/fmpq_poly.h>

#include <snug/independence/weight.h>

namespace snug {

/// An element of a RealField: a polynomial in its generator.
class FieldNumber {
 public:
  FieldNumber() { fmpq_poly_init(value_); }
  /// By coefficients, that of the power 0 first.
  explicit FieldNumber(const std::vector<mpq_class>& coefficients);
  FieldNumber(const FieldNumber& other) : FieldNumber() { fmpq_poly_set(value_, other.value_); }
  FieldNumber(FieldNumber&& other) noexcept : FieldNumber() { fmpq_poly_swap(value_, other.value_); }
  FieldNumber& operator=(FieldNumber other) noexcept {
    fmpq_poly_swap(value_, other.value_);
    return *this;
  }
  ~FieldNumber() { fmpq_poly_clear(value_); }

  [[nodiscard]] bool is_zero() const { return fmpq_poly_is_zero(value_) != 0; }
  [[nodiscard]] const fmpq_poly_struct* get() const { return value_; }
  [[nodiscard]] fmpq_poly_struct* get() { return value_; }

 private:
  fmpq_poly_t value_;
};

/// The rational numbers with 2 cos(2 pi/order), exactly.
class RealField {
 public:
  explicit RealField(std::uint32_t order);
  RealField(const RealField&) = delete;
  RealField& operator=(const RealField&) = delete;

  [[nodiscard]] std::uint32_t order() const { return order_; }
  /// Of polynomials, less than this.
  [[nodiscard]] std::size_t degree() const;

  /// Requires:  the order of the weight's cosines is `stride` times that of the field, and their indices are multiples of it.
  [[nodiscard]] FieldNumber number(const Weight& w, std::uint32_t stride) const;
  /// sum += a b
  void add_product(const FieldNumber& a, const FieldNumber& b, FieldNumber& sum) const;
  [[nodiscard]] FieldNumber product(const FieldNumber& a, const FieldNumber& b) const;
  /// Requires:  not 0.
  [[nodiscard]] FieldNumber inverse(const FieldNumber& a) const;

 private:
  std::uint32_t order_;
  FieldNumber modulus_;
  std::vector<FieldNumber> cosines_;  // 2 cos(2 pi i/order), by i
};

}  // namespace snug
