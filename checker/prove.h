#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "bounds_file.h"
#include "piece.h"

namespace checker {

/// Result of the proof of a kind's rows.
struct RowsProof {
  std::vector<Row>
      hull;  ///< exact rows, each close to a stored one: the patch lies in the hull of their images
  std::size_t pieces = 0;   ///< that the patch was split into
  std::size_t covered = 0;  ///< Bezier points on edges that are in the hull of others, not stored
  unsigned depth = 0;       ///< of the smallest piece
};

/// Proves that the stored rows of a kind are bounding rows as BoundingRows (snug/basis/bounding_rows.h) promises.
/// Errors:    Rejected if that could not be proved.
/// Source:    derivations/checker.md.
[[nodiscard]] RowsProof prove_rows(const StoredKind& kind);

/// Proves the table, as BoundTable (snug/basis/bound_table.h) promises, from the rows' proof of its kind.
/// Errors:    Rejected if that could not be proved.
void prove_table(const StoredTable& table, Scheme scheme, const RowsProof& rows);

/// Proves the rows by which a patch of a kind is compared with a quadratic. At each parameter the point of the
/// patch and that of any quadratic are together in the hull of pairs: exact Bezier points of both, each of the
/// patch within entry_error of a stored row, the quadratic's weights there within 16 roundoffs. Or the
/// parameter is in a piece that a stored net, within entry_error, and the restricted quadratic belong to.
/// Errors:    Rejected if that could not be proved.
void prove_comparison(const StoredComparison& comparison, Scheme scheme, const Key& key);

/// Proves that no basis function of a kind is larger than the frame says, and that the layout's limit points
/// less their parameters are, up to the error, in the hull of its offsets.
/// Errors:    Rejected if that could not be proved.
void prove_frame(const StoredFrame& frame, Scheme scheme, const Key& key);

/// Result of the proof of a whole file.
struct FileProof {
  std::size_t kinds = 0, tables = 0, comparisons = 0, frames = 0, stored_rows = 0, pieces = 0, covered = 0;
  unsigned depth = 0;
};

/// Proves all of every kind of a file, on all cores; and that the kinds of nets are in the file.
/// Errors:    Rejected, naming the first kind in the file that could not be proved.
[[nodiscard]] FileProof prove_file(std::span<const std::byte> bytes);

}  // namespace checker
