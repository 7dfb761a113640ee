#pragma once

#include <mpfi.h>
#include <mpfr.h>

namespace oracle::detail {

/// Interval with 160-bit ends that contains the exact result of every operation. A thin owner of an mpfi_t.
class Interval {
 public:
  static constexpr mpfr_prec_t kBits = 160;

  Interval() : Interval(0.0) {}
  /// The single number `value`.
  explicit Interval(double value) {
    mpfi_init2(ends_, kBits);
    mpfi_set_d(ends_, value);
  }
  Interval(const Interval& other) {
    mpfi_init2(ends_, kBits);
    mpfi_set(ends_, other.ends_);
  }
  Interval(Interval&& other) noexcept {
    mpfi_init2(ends_, kBits);
    mpfi_swap(ends_, other.ends_);
  }
  Interval& operator=(const Interval& other) {
    mpfi_set(ends_, other.ends_);
    return *this;
  }
  Interval& operator=(Interval&& other) noexcept {
    mpfi_swap(ends_, other.ends_);
    return *this;
  }
  ~Interval() { mpfi_clear(ends_); }

  [[nodiscard]] mpfi_ptr get() { return ends_; }
  [[nodiscard]] mpfi_srcptr get() const { return ends_; }

  Interval& operator+=(const Interval& other) {
    mpfi_add(ends_, ends_, other.ends_);
    return *this;
  }
  friend Interval operator+(Interval a, const Interval& b) { return a += b; }
  friend Interval operator-(Interval a, const Interval& b) {
    mpfi_sub(a.ends_, a.ends_, b.ends_);
    return a;
  }
  friend Interval operator*(Interval a, const Interval& b) {
    mpfi_mul(a.ends_, a.ends_, b.ends_);
    return a;
  }
  friend Interval operator/(Interval a, const Interval& b) {
    mpfi_div(a.ends_, a.ends_, b.ends_);
    return a;
  }

 private:
  mpfi_t ends_;
};

}  // namespace oracle::detail
