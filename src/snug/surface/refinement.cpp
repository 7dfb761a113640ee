#include <snug/surface/refinement.h>

#include <utility>

#include <snug/base/contract.h>
#include <snug/enclose/table_triangle.h>
#include <snug/patch/evaluate.h>

namespace snug {

Piece make_piece(BoundLibrary& library, PatchId root, Patch patch, HullPoints& scratch,
                 std::optional<TableLayout> table) {
  Piece piece;
  piece.root = root;
  piece.corners = limit_corners(patch);
  if (table) {
    piece.offset = offset_triangle(table_triangle(library.table(*patch.kind, *table), patch));
  } else {
    hull_points(library, patch, scratch);
    piece.offset = offset_triangle(library, scratch, piece.corners);
  }
  piece.patch = std::move(patch);
  return piece;
}

Refinement::Refinement(const Surface& surface, std::optional<TableLayout> table)
    : surface_(surface), table_(table), roots_(surface.patch_count()) {}

PieceId Refinement::root(PatchId patch) {
  PieceId& id = roots_[patch.index()];
  if (!id.valid()) {
    pieces_.push_back(make_piece(surface_.library(), patch, surface_.patch(patch), scratch_, table_));
    id = PieceId(pieces_.size() - 1);
  }
  return id;
}

bool Refinement::can_split(PieceId id) const {
  const Piece& piece = pieces_[id.index()];
  return piece.patch.path.level() < PiecePath::max_level && piece.offset.radius > 2 * piece.offset.rounding;
}

PieceId Refinement::split(PieceId id) {
  if (pieces_[id.index()].first_child.valid()) return pieces_[id.index()].first_child;
  SNUG_EXPECT(can_split(id));
  const PieceId first(pieces_.size());
  for (unsigned child = 0; child < 4; ++child) {
    const Piece& parent = pieces_[id.index()];
    pieces_.push_back(
        make_piece(surface_.library(), parent.root, snug::split(parent.patch, child), scratch_, table_));
  }
  pieces_[id.index()].first_child = first;
  return first;
}

}  // namespace snug
