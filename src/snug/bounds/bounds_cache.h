#pragma once

#include <cstddef>

#include <snug/bounds/bound_rows.h>
#include <snug/bounds/bound_table.h>
#include <snug/bounds/kind_slots.h>

namespace snug {

/// Rows and tables of all kinds met so far: on first use shipped ones (shipped.h) are taken and others made;
/// then immutable. Thread-safe; looking up costs two loads.
class BoundsCache {
 public:
  /// The library of kinds that this one keeps rows for.
  [[nodiscard]] KindCache& kinds() { return kinds_; }
  [[nodiscard]] const KindCache& kinds() const { return kinds_; }

  /// The rows of a kind. With several extraordinary corners they go down one level only: the tips there are of
  /// kinds that have rows of their own, and there are far fewer of these.
  /// Requires:  a kind of kinds().
  /// Errors:    InputError (refused) beyond 16 million kinds.
  [[nodiscard]] const BoundRows& rows(const Kind& kind);
  /// The table of a kind, made from rows that go down to tip_depth().
  [[nodiscard]] const BoundTable& table(const Kind& kind);

  /// Kinds that have rows, and the memory of all rows and tables.
  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  [[nodiscard]] std::size_t bytes() const { return rows_.bytes() + tables_.bytes(); }

 private:
  KindCache kinds_;
  KindSlots<BoundRows> rows_;
  KindSlots<BoundTable> tables_;
};

}  // namespace snug
