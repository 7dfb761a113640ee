#pragma once

#include <snug/bounds/bounding_points.h>
#include <snug/search/piece.h>

#include <random>
#include <utility>

namespace snug::testing {

/// A piece with what is fitted around it.
struct KnownPiece {
  Piece piece;
  Heights heights;
  Obb box;
};

/// Pieces of one surface, made anew each time.
class Pieces {
 public:
  explicit Pieces(const LimitSurface& surface, BoundMethod method = BoundMethod::rows)
      : surface_(surface), method_(method) {}

  [[nodiscard]] KnownPiece root(PatchId p) {
    return known(make_piece(surface_.library(), p, surface_.patch(p), scratch_, method_));
  }
  [[nodiscard]] KnownPiece child(const KnownPiece& of, unsigned child) {
    return known(child_of(surface_.library(), of.piece, child, scratch_, method_));
  }
  /// A piece some levels below a patch, or as many as it can be split.
  [[nodiscard]] KnownPiece below(PatchId p, std::size_t levels, std::mt19937_64& random) {
    KnownPiece piece = root(p);
    for (; levels > 0 && piece.piece.can_split(); --levels) {
      piece = child(piece, static_cast<unsigned>(random() % 4));
    }
    return piece;
  }
  /// Points whose hull holds it, until the next call.
  [[nodiscard]] const BoundingPoints& hull(const KnownPiece& of) {
    bounding_points(surface_.library(), of.piece.patch, scratch_);
    return scratch_;
  }

 private:
  // Tables need no points.
  [[nodiscard]] KnownPiece known(Piece piece) const {
    const Heights heights =
        method_ == BoundMethod::table ? heights_of(piece.offset) : heights_of(piece, scratch_);
    const Obb box = box_around(piece.offset, scratch_, method_);
    return {std::move(piece), heights, box};
  }

  const LimitSurface& surface_;
  BoundMethod method_;
  BoundingPoints scratch_;
};

}  // namespace snug::testing
