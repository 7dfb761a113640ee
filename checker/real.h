#pragma once

#include <mpfi.h>
#include <mpfr.h>

namespace checker {

/// Frees, when destroyed, the memory that the arithmetic keeps for a thread between operations.
struct KeptByThread {
  KeptByThread() = default;
  ~KeptByThread() { mpfr_free_cache(); }
  KeptByThread(const KeptByThread&) = delete;
  KeptByThread& operator=(const KeptByThread&) = delete;
};

/// A real number known to lie between two ends of 160 bits; every operation contains the exact result.
class Real {
 public:
  static constexpr mpfr_prec_t bits = 160;

  Real() : Real(0.0) {}
  /// Exactly `value`.
  Real(double value) {  // NOLINT: exact numbers are reals
    mpfi_init2(ends_, bits);
    mpfi_set_d(ends_, value);
  }
  Real(const Real& other) {
    mpfi_init2(ends_, bits);
    mpfi_set(ends_, other.ends_);
  }
  Real(Real&& other) noexcept {
    mpfi_init2(ends_, bits);
    mpfi_swap(ends_, other.ends_);
  }
  Real& operator=(const Real& other) {
    mpfi_set(ends_, other.ends_);
    return *this;
  }
  Real& operator=(Real&& other) noexcept {
    mpfi_swap(ends_, other.ends_);
    return *this;
  }
  ~Real() { mpfi_clear(ends_); }

  /// cos(2 pi times / n).
  [[nodiscard]] static Real cos_of_turn(unsigned n, unsigned times = 1) {
    Real x;
    mpfi_const_pi(x.ends_);
    mpfi_mul_ui(x.ends_, x.ends_, 2 * times);
    mpfi_div_ui(x.ends_, x.ends_, n);
    mpfi_cos(x.ends_, x.ends_);
    return x;
  }

  Real& operator+=(const Real& other) {
    mpfi_add(ends_, ends_, other.ends_);
    return *this;
  }
  /// *this += a * b, without memory for the product each time.
  void add_product(const Real& a, const Real& b) {
    static thread_local Real product;
    mpfi_mul(product.ends_, a.ends_, b.ends_);
    mpfi_add(ends_, ends_, product.ends_);
  }
  friend Real operator+(Real a, const Real& b) { return a += b; }
  friend Real operator-(Real a, const Real& b) {
    mpfi_sub(a.ends_, a.ends_, b.ends_);
    return a;
  }
  friend Real operator*(Real a, const Real& b) {
    mpfi_mul(a.ends_, a.ends_, b.ends_);
    return a;
  }
  friend Real operator/(Real a, const Real& b) {
    mpfi_div(a.ends_, a.ends_, b.ends_);
    return a;
  }
  [[nodiscard]] Real root() const {
    Real x;
    mpfi_sqrt(x.ends_, ends_);
    return x;
  }
  /// Contains the lesser one; the larger one; both.
  friend Real min(Real a, const Real& b) {
    mpfr_min(&a.ends_->left, &a.ends_->left, &b.ends_->left, MPFR_RNDD);
    mpfr_min(&a.ends_->right, &a.ends_->right, &b.ends_->right, MPFR_RNDU);
    return a;
  }
  friend Real max(Real a, const Real& b) {
    mpfr_max(&a.ends_->left, &a.ends_->left, &b.ends_->left, MPFR_RNDD);
    mpfr_max(&a.ends_->right, &a.ends_->right, &b.ends_->right, MPFR_RNDU);
    return a;
  }
  friend Real hull(Real a, const Real& b) {
    mpfi_union(a.ends_, a.ends_, b.ends_);
    return a;
  }
  [[nodiscard]] Real magnitude() const {
    Real x;
    mpfi_abs(x.ends_, ends_);
    return x;
  }

  [[nodiscard]] bool is_exactly_zero() const { return mpfi_is_zero(ends_) > 0; }
  [[nodiscard]] bool certainly_at_least(const Real& other) const {
    return mpfr_lessequal_p(&other.ends_->right, &ends_->left) != 0;
  }
  [[nodiscard]] bool certainly_positive() const { return mpfr_cmp_si(&ends_->left, 0) > 0; }
  [[nodiscard]] bool may_be(double value) const {
    return mpfr_cmp_d(&ends_->left, value) <= 0 && mpfr_cmp_d(&ends_->right, value) >= 0;
  }
  /// Some double close by.
  [[nodiscard]] double approximately() const { return mpfi_get_d(ends_); }

 private:
  mpfi_t ends_;
};

}  // namespace checker
