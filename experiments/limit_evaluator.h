#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <snug/patch/evaluate.h>

namespace snug {

/// Limit points of one patch at many parameters: polynomial pieces once met are kept, so that a point costs a
/// walk down to its piece and one polynomial.
///
/// Guarantee: as limit_point(); a result does not depend on earlier ones.
/// Cost:      about 30 ns a point in a regular patch, 10 ns a level more near an extraordinary corner
///            (bench/); a piece met for the first time about 300 ns. Memory: 0.5 to 0.9 KB a polynomial
///            piece, at most some 700 others.
class LimitEvaluator {
 public:
  LimitEvaluator() = default;
  explicit LimitEvaluator(const Patch& patch) { reset(patch); }

  /// Begins anew with another patch; keeps its memory.
  void reset(const Patch& patch);
  /// Stays where it is until reset().
  [[nodiscard]] const Patch& patch() const { return patch_; }

  /// Errors:    InputError (value) without a patch, and as limit_point().
  [[nodiscard]] LimitPoint operator()(TriangleParameter at);
  /// Errors:    likewise; (value) unless out.size() == at.size().
  void operator()(std::span<const TriangleParameter> at, std::span<LimitPoint> out);

  [[nodiscard]] std::size_t bytes() const;

 private:
  // A polynomial in the patch's order of corners: its weights of w^k u^i v^j are those from `first` on.
  struct Polynomial {
    std::uint32_t first;
    std::uint16_t degree;
    std::uint16_t parts;  // 2: another one follows, and the patch's corner that faces their common edge is 1
    double error;
  };
  // Child `place` of a piece: not met yet, a piece of inner_, or one of polynomials_.
  struct Child {
    enum : std::uint8_t { unknown, inner, polynomial } sort = unknown;
    std::uint32_t place = 0;
  };
  // A piece that is no polynomial, or the whole patch.
  struct Inner {
    Patch patch;
    double drift = 0;  // of parameters, upper bound
    std::array<Child, 4> children;
  };

  Child make(Patch&& piece, double drift);
  [[nodiscard]] LimitPoint evaluate(const Polynomial& polynomial, TriangleParameter at) const;

  Patch patch_;
  std::vector<Inner> inner_;  // the patch itself first, polynomial or not
  std::vector<Polynomial> polynomials_;
  std::vector<std::array<double, 4>> weights_;  // four doubles a point, the last one 0
};

}  // namespace snug
