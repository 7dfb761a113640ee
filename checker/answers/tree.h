#pragma once

#include <functional>

#include "question.h"

namespace answers {

/// Sides that follow each other in an order, as a whole, or what is left of one.
struct Range {
  std::size_t begin, end;
  PieceSet* pieces = nullptr;  ///< what is left; none of what is not divided
  [[nodiscard]] std::size_t size() const { return end - begin; }
};

/// Does a half-line not stay behind the plane across w that its points lie behind, or before?
[[nodiscard]] bool goes_back(const Side& side, const Point& w, bool largest);

/// Trees over pairs of ranges, by which files prove that sides are more than `margin` apart.
class Tree {
 public:
  Tree(Words& words, std::vector<const Side*> sides, double margin, LeastSlack& least)
      : words_(words), sides_(std::move(sides)), margin_(margin), least_(least) {}

  [[nodiscard]] const Side& side(std::size_t i) const { return *sides_[i]; }
  /// Both halves: of the sides, or of what is left of one.
  [[nodiscard]] std::pair<Range, Range> halves_of(const Range& range) const;

  using LeftOut = std::function<void(const Range&, const Range&)>;
  /// Refuses unless all sides of one range are that far from all of the other. Pairs that the file
  /// leaves out are passed on.
  void prove(const Range& a, const Range& b, const LeftOut& leave_out) const;

 private:
  using Pair = std::array<Range, 2>;
  void divide(char step, Pair& pair, std::vector<Pair>& open) const;
  void prove_leaf(const Pair& pair) const;
  [[nodiscard]] Real extreme_of(const Range& range, const Point& w, bool largest) const;

  Words& words_;
  std::vector<const Side*> sides_;
  double margin_;
  LeastSlack& least_;
};

}  // namespace answers
