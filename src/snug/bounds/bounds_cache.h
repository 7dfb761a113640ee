#pragma once

#include <cstddef>

#include <snug/bounds/bound_rows.h>
#include <snug/bounds/bound_table.h>
#include <snug/bounds/kind_slots.h>
#include <snug/bounds/quadratic.h>

namespace snug {

/// Rows and tables of kinds, made on first use; then immutable. Thread-safe; looking up costs two loads.
///
/// Memory: kinds and their tables take a few times what the connectivity of the surfaces takes that they are
///         for. Rows grow with the square of a valence; those that would go beyond a limit are made when they
///         are needed, and a thread keeps its last eight. No result depends on it.
class BoundsCache {
 public:
  explicit BoundsCache(std::size_t most_bytes_of_rows = std::size_t{256} << 20)
      : rows_(most_bytes_of_rows), quadratics_(most_bytes_of_rows) {}

  [[nodiscard]] KindCache& kinds() { return kinds_; }
  [[nodiscard]] const KindCache& kinds() const { return kinds_; }

  /// The rows of a kind of kinds(). With several extraordinary corners they go down one level only: the tips
  /// there are of kinds that have rows of their own, and there are far fewer of these. KindSlots keeps them.
  [[nodiscard]] const BoundRows& rows(const Kind& kind);
  /// The table of a kind, made from rows that go down to tip_depth().
  [[nodiscard]] const BoundTable& table(const Kind& kind);
  /// What the quadratic triangles of a kind share.
  [[nodiscard]] const QuadraticRows& quadratic_rows(const Kind& kind);

  /// Kinds whose rows are kept, and the memory of all rows and tables that are.
  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  [[nodiscard]] std::size_t bytes() const { return rows_.bytes() + tables_.bytes() + quadratics_.bytes(); }

 private:
  KindCache kinds_;
  KindSlots<BoundRows> rows_;
  KindSlots<BoundTable> tables_;
  KindSlots<QuadraticRows> quadratics_;
};

}  // namespace snug
