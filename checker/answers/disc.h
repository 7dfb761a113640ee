#pragma once

#include <optional>

#include "question.h"

namespace answers {

using Hull = std::vector<const Point*>;
[[nodiscard]] inline Hull copy_of(std::span<const Point* const> hull) {
  return {hull.begin(), hull.end()};
}

/// A number, and the points that determine a piece after so many steps.
[[nodiscard]] Hull read_finer(Words& words, PieceSet& piece);

[[nodiscard]] Point between(const Point& a, const Point& b);

/// A placed piece with three or four border curves.
class Disc {
 public:
  /// Refuses other pieces.
  Disc(Words& words, std::unique_ptr<PieceSet> piece, const Pose& pose);

  [[nodiscard]] PieceSet& piece() const { return *piece_; }
  [[nodiscard]] const Pose& pose() const { return pose_; }
  [[nodiscard]] std::size_t corner_count() const { return corners_; }
  /// `border`, a number, and the points that determine curve k after so many steps.
  [[nodiscard]] Hull read_border(Words& words, std::size_t k);
  /// `corners`, a number of steps, which corner is first; boxes around the placed limit corners.
  [[nodiscard]] std::vector<Point> read_corners(Words& words) const;

 private:
  struct BorderPiece {
    std::unique_ptr<PieceSet> piece;
    std::size_t side;
  };
  static std::vector<BorderPiece> finer(const std::vector<BorderPiece>& curve);

  std::unique_ptr<PieceSet> piece_;
  std::vector<BorderPiece> curve_;  // the last one, which keeps its points
  const Pose& pose_;
  std::size_t corners_;
};

/// How often a line from a point, up to an end or without one, crosses the triangles from the first
/// corner: from behind, where the corners go round clockwise, less from the front. Nothing if that
/// is not certain.
[[nodiscard]] std::optional<int> crossings(const Point& from, const Point& along, const Point* end,
                                           std::span<const Point> corners);

}  // namespace answers
