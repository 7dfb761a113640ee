#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <snug/patch/evaluate.h>

namespace snug {

/// Limit points of one patch at many parameters: polynomial pieces once met are kept, so that a point costs a
/// walk down to its piece and one quartic.
///
/// Guarantee: as limit_point(); a result does not depend on earlier ones.
/// Cost:      about 30 ns a point in a regular patch, 10 ns a level more near an extraordinary corner
///            (bench/); a piece met for the first time about 300 ns. Memory: 0.5 KB a polynomial piece, at most
///            some 700 others.
class LimitEvaluator {
 public:
  LimitEvaluator() = default;
  explicit LimitEvaluator(const Patch& patch) { reset(patch); }

  /// Begins anew with another patch; keeps its memory.
  void reset(const Patch& patch);
  /// Stays where it is until reset().
  [[nodiscard]] const Patch& patch() const { return patch_; }

  /// Requires:  a patch; at as in limit_point().
  [[nodiscard]] LimitPoint operator()(TriangleParameter at);
  /// Requires:  out.size() == at.size().
  void operator()(std::span<const TriangleParameter> at, std::span<LimitPoint> out);

  [[nodiscard]] std::size_t bytes() const;

 private:
  // A quartic in the patch's order of corners: weights of w^k u^i v^j, four doubles a point, the last one 0.
  struct Quartic {
    std::array<std::array<double, 4>, 15> weights;
    double error;
  };
  // Child `place` of a piece: not met yet, a piece of inner_, or one of quartics_.
  struct Child {
    enum : std::uint8_t { unknown, inner, quartic } sort = unknown;
    std::uint32_t place = 0;
  };
  // A piece that is no polynomial, or the whole patch.
  struct Inner {
    Patch patch;
    double drift = 0;  // of parameters, upper bound
    std::array<Child, 4> children;
  };

  Child make(Patch&& piece, double drift);
  [[nodiscard]] static LimitPoint evaluate(const Quartic& quartic, TriangleParameter at);

  Patch patch_;
  std::vector<Inner> inner_;  // the patch itself first, polynomial or not
  std::vector<Quartic> quartics_;
};

}  // namespace snug
