#pragma once

#include <cstddef>
#include <optional>

#include <snug/bounds/bound_table.h>
#include <snug/bounds/bounding_rows.h>
#include <snug/bounds/crease_rows.h>
#include <snug/bounds/kind_slots.h>
#include <snug/bounds/quadratic.h>
#include <snug/bounds/rows_kernel.h>
#include <snug/bounds/tip_table.h>

namespace snug {

/// Levels of rows around extraordinary corners before the tips.
inline constexpr unsigned levels_before_tips = 2;

/// Rows and tables of kinds, made on first use; then immutable. Thread-safe; looking up costs two loads.
///
/// Memory: kinds and their tables take a few times what the connectivity of the surfaces takes that they are
///         for; half a megabyte a patch where every semi-sharp edge has a sharpness of its own. Rows grow with the
///         square of a valence; those that would go beyond a limit are made when they are needed, and a thread
///         keeps its last eight. No result depends on it.
class BoundsCache {
 public:
  explicit BoundsCache(std::size_t max_bytes_of_rows = std::size_t{256} << 20)
      : rows_(max_bytes_of_rows),
        level_rows_(max_bytes_of_rows),
        level_steps_(max_bytes_of_rows),
        direct_rows_(max_bytes_of_rows),
        tip_tables_(max_bytes_of_rows),
        quadratics_(max_bytes_of_rows),
        piece_rows_(max_bytes_of_rows) {}

  [[nodiscard]] KindCache& kinds() { return kinds_; }
  [[nodiscard]] const KindCache& kinds() const { return kinds_; }

  /// The rows of a kind of kinds(), levels_before_tips levels of them: tips are bounded by the tables of
  /// their own kinds, of which there are far fewer. KindSlots keeps them.
  [[nodiscard]] const BoundingRows& rows(const Kind& kind);
  /// One level of them.
  [[nodiscard]] const BoundingRows& level_rows(const Kind& kind);
  /// The same in two factors.
  [[nodiscard]] const LevelStep& level_step(const Kind& kind);
  /// Rows of a patch that is one polynomial or a few, without a split: of polynomial kinds of degree 2
  /// and more, and those of make_crease_rows(). Null for others.
  [[nodiscard]] const BoundingRows* direct_rows(const Kind& kind);
  /// The table of a kind, made from rows that go down to tip_depth(). It stays as long as this.
  [[nodiscard]] const BoundTable& table(const Kind& kind);
  /// The same for the boxes of tips of this kind.
  [[nodiscard]] const TipTable& tip_table(const Kind& kind);
  /// Rows for the quadratic triangles of a kind.
  [[nodiscard]] const QuadraticRows& quadratic_rows(const Kind& kind);
  /// Rows that fit pieces of a kind without a split. Null for others than has_layouts().
  [[nodiscard]] const kernels::RowsWithTips<float>* piece_rows(const Kind& kind);

  /// Kinds whose rows are kept, and the memory of all rows and tables that are.
  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  [[nodiscard]] std::size_t bytes() const {
    return rows_.bytes() + direct_rows_.bytes() + level_rows_.bytes() + level_steps_.bytes() +
           tables_.bytes() + tip_tables_.bytes() + quadratics_.bytes() + piece_rows_.bytes();
  }

 private:
  struct PieceRows {
    std::optional<kernels::RowsWithTips<float>> rows;
    [[nodiscard]] std::size_t bytes() const { return rows ? rows->bytes() : 0; }
  };

  KindCache kinds_;
  KindSlots<BoundingRows> rows_, level_rows_;
  KindSlots<LevelStep> level_steps_;
  KindSlots<CreaseRows> direct_rows_;
  KindSlots<BoundTable> tables_;
  KindSlots<TipTable> tip_tables_;
  KindSlots<QuadraticRows> quadratics_;
  KindSlots<PieceRows> piece_rows_;
};

}  // namespace snug
