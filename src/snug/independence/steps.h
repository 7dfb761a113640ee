#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <gmpxx.h>

#include <snug/independence/modular.h>
#include <snug/independence/piece_step.h>

namespace snug {

using ModularRow = std::vector<std::uint32_t>;
using ExactVector = std::vector<mpq_class>;

[[nodiscard]] bool is_rational(const WeightRow& row);

/// A step that is taken again and again, modulo a prime and exactly.
class Steps {
 public:
  /// `base`: the net of the step as combinations of `columns` control points; empty if it is those.
  ///
  /// Requires:  the field outlives it.
  Steps(PieceStep step, const ModularField& field, std::vector<WeightRow> base = {},
        std::uint32_t columns = 0);

  [[nodiscard]] const PieceStep& step() const { return step_; }
  [[nodiscard]] const ModularField& field() const { return field_; }
  /// How many control points everything is a combination of.
  [[nodiscard]] std::uint32_t columns() const { return columns_; }
  [[nodiscard]] bool rational() const { return rational_; }

  /// A functional of the regular pieces of the step that follows `before` steps.
  [[nodiscard]] ModularRow image(const Functional& functional, std::uint32_t before);
  /// The same exactly, of rational parts of weights alone: right for vectors that leave no irrational ones.
  [[nodiscard]] ExactVector exact(const Functional& functional, std::uint32_t before) const;
  /// Control values of the net of the step; nothing where they are not rational.
  [[nodiscard]] std::optional<ExactVector> at_base(const ExactVector& v) const;
  /// Conditions under which Loop's irrational rows are 0, so that what is left is rational: 0 at the vertex of each, and for
  /// the sum of its neighbours.
  [[nodiscard]] std::vector<ExactVector> corner_conditions() const;
  /// The number that a step multiplies these values of its net by, if there is one.
  [[nodiscard]] std::optional<mpq_class> factor(const ExactVector& at_base) const;

 private:
  using ImageRow = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

  [[nodiscard]] ImageRow image(const WeightRow& row) const;
  [[nodiscard]] ModularRow times(const ImageRow& row, const std::vector<ModularRow>& matrix) const;

  PieceStep step_;
  const ModularField& field_;
  std::vector<WeightRow> base_;
  std::uint32_t columns_;
  bool rational_;
  std::vector<ImageRow> images_;
  std::vector<std::vector<ModularRow>> powers_;  // of the rows that are kept
};

/// A function of a domain: a functional after so many steps of one of its parts.
struct DomainFunction {
  const Steps* part;
  std::uint32_t before;
  Functional functional;
};

/// Is the vector's function zero in all of these? Exact; false also where irrational parts are left.
///
/// Requires:  functions of one part follow each other, in the order of steps.
[[nodiscard]] bool vanishes(const ExactVector& v, const std::vector<DomainFunction>& functions);

}  // namespace snug
