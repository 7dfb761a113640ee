#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "bounds_file.h"
#include "piece.h"

namespace checker {

/// What the proof of a kind's rows found.
struct RowsProof {
  std::vector<Row>
      hull;  ///< exact rows, each close to a stored one: the patch lies in the hull of their images
  std::size_t pieces = 0;   ///< that the patch was split into
  std::size_t covered = 0;  ///< Bezier points on edges that are in the hull of others, not stored
  unsigned depth = 0;       ///< of the smallest piece
};

/// Proves that the stored rows of a kind are hull rows as BoundRows (snug/basis/bound_rows.h) promises.
/// Errors:    Rejected if that could not be proved.
/// Source:    derivations/checker.md.
[[nodiscard]] RowsProof prove_rows(const StoredKind& kind);

/// Proves the table, as BoundTable (snug/basis/bound_table.h) promises, from the rows' proof of its kind.
/// Errors:    Rejected if that could not be proved.
void prove_table(const StoredTable& table, Scheme scheme, const RowsProof& rows);

/// What the proof of a whole file found.
struct FileProof {
  std::size_t kinds = 0, tables = 0, stored_rows = 0, pieces = 0, covered = 0;
  unsigned depth = 0;
};

/// Proves every kind and table of a file, on all cores.
/// Errors:    Rejected, naming the first kind in the file that could not be proved.
[[nodiscard]] FileProof prove_file(std::span<const std::byte> bytes);

}  // namespace checker
