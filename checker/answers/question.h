#pragma once

#include <optional>
#include <string>

#include "surface.h"

namespace answers {

/// x -> R x + t with the twelve numbers of a pose, whatever they are; without any, x -> x.
class Pose {
 public:
  Pose() : Pose({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}) {}
  explicit Pose(const std::array<double, 12>& numbers);
  [[nodiscard]] Point apply(const Point& p) const;
  /// w.(R x + t) is back(w).x + shift(w).
  [[nodiscard]] Point back(const Point& w) const;
  [[nodiscard]] Real shift(const Point& w) const;

 private:
  std::array<Real, 12> numbers_;
};

/// One of the two sets that a question is about: a placed surface, a point, or a ray.
struct Side {
  PieceSet* pieces = nullptr;
  Pose pose;
  std::vector<Point> points;       ///< the point; of a ray where it begins and, if it ends, where
  std::optional<Point> direction;  ///< of a ray that does not end
  std::string name;
};

/// The leaf of all proofs of a file whose gap is nearest to what it must exceed.
struct LeastSlack {
  double slack = 0;
  std::size_t line = 0;  ///< 0: there is no leaf
};

/// A question about two sets, and what is proved of it so far.
struct Question {
  std::array<Side, 2> sides;
  bool apart = false;
  /// Owners in whose pieces is a point that the other set winds 0 times around.
  std::array<std::vector<Index>, 2> outside;
  bool inside = false;  ///< one set winds around some point of the other
};

/// Proves the claims about two sets that a file makes next, one at least, and says them as the end
/// of a sentence. What is not proved is thrown as checker::Rejected.
[[nodiscard]] std::string prove_claims(Words& words, Question& question, LeastSlack& least);

/// As decimals that are not above it, or not below.
[[nodiscard]] std::string text_of(double x, bool above);
[[nodiscard]] Real dot(const Point& a, const Point& b);
/// Reads the name of one piece: its owner's position in the order, the number of steps, and which
/// child is taken in each.
[[nodiscard]] std::unique_ptr<PieceSet> read_piece(Words& words, const PieceSet& all);
/// The number of further steps, and these.
void read_steps(Words& words, std::unique_ptr<PieceSet>& piece);
/// Contains all points of a placed piece.
[[nodiscard]] Point enclosing_box(PieceSet& piece, const Pose& pose);
/// A point of a side: of a surface one in a piece that is named, or the point that the side is.
struct Place {
  Point box;        ///< encloses it
  Index owner = 0;  ///< of the piece, in the control mesh
};
[[nodiscard]] Place read_place(Words& words, const Side& side);
/// Three integers.
[[nodiscard]] Point read_direction(Words& words);
/// Contains w.x for the points with the least or with the largest one.
[[nodiscard]] Real extreme(std::span<const Point* const> points, const Pose& pose, const Point& w,
                           bool largest);
/// That a surface and the other one have a point in common.
void prove_meeting(Words& words, const std::array<Side, 2>& sides);
/// How often a closed surface winds around a point of the other side, as the end of a sentence; of
/// a limit point nothing is said but by prove_solids().
[[nodiscard]] std::string prove_winding(Words& words, Question& question, LeastSlack& least);
/// What follows for the solids that two closed surfaces bound, as the end of a sentence; refuses if
/// nothing does.
[[nodiscard]] std::string prove_solids(const Words& words, const Question& question);

/// Proves what a file says of pairs of placed surfaces, in sentences.
[[nodiscard]] std::vector<std::string> prove_scene(Words& words, const std::vector<Side>& parts,
                                                   LeastSlack& least);

}  // namespace answers
