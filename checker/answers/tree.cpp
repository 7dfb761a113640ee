#include "tree.h"

#include <cctype>

namespace answers {

bool goes_back(const Side& side, const Point& w, bool largest) {
  if (!side.direction) return false;
  const Real along = dot(w, *side.direction);
  return !(largest ? Real(0.0) - along : along).certainly_at_least(Real(0.0));
}

std::pair<Range, Range> Tree::halves_of(const Range& range) const {
  if (range.pieces) {
    if (range.pieces->size() < 2) words_.refuse("one piece is not halved");
    return {{range.begin, range.end, &range.pieces->half(0)},
            {range.begin, range.end, &range.pieces->half(1)}};
  }
  if (range.size() < 2) words_.refuse("a point, a ray or a whole part is not divided");
  const std::size_t middle = range.begin + range.size() / 2;
  return {{range.begin, middle}, {middle, range.end}};
}

// Children come in turn behind their parent: `A` and `B` halve a range, `a` and `b` make it finer,
// `x` leaves a pair out, and three integers are the direction of a leaf.
void Tree::prove(const Range& a, const Range& b, const LeftOut& leave_out) const {
  std::vector<Pair> open{{a, b}};
  while (!open.empty()) {
    Pair pair = open.back();
    open.pop_back();
    bool is_left_out = false;
    while (!is_left_out && !words_.peek().empty() &&
           std::isalpha(static_cast<unsigned char>(words_.peek()[0])) != 0) {
      is_left_out = leave_out && words_.take("x");
      if (is_left_out) break;
      for (const char step : words_.next()) divide(step, pair, open);
    }
    if (is_left_out) {
      leave_out(pair[0], pair[1]);
    } else {
      prove_leaf(pair);
    }
  }
}

void Tree::divide(char step, Pair& pair, std::vector<Pair>& open) const {
  const std::size_t s = step == 'A' || step == 'a' ? 0 : step == 'B' || step == 'b' ? 1 : 2;
  if (s == 2) words_.refuse("a step that is none");
  Range& range = pair[s];
  if (step == 'a' || step == 'b') {
    if (!range.pieces) words_.refuse("only pieces of one surface are made finer");
    range.pieces = &range.pieces->finer();
    return;
  }
  const auto [first, second] = halves_of(range);
  range = second;
  open.push_back(pair);
  range = first;
}

void Tree::prove_leaf(const Pair& pair) const {
  const Point w = read_direction(words_);
  for (std::size_t s = 0; s < 2; ++s) {
    for (std::size_t i = pair[s].begin; i < pair[s].end; ++i) {
      if (goes_back(*sides_[i], w, s == 0)) words_.refuse("a ray crosses the plane of this leaf");
    }
  }
  const Real gap = extreme_of(pair[1], w, false) - extreme_of(pair[0], w, true);
  const Real length = dot(w, w).root(), slack = gap - Real(margin_) * length;
  if (!slack.certainly_positive())
    words_.refuse("these pieces are not separated by this direction");
  const double share = (slack / length).approximately();
  if (least_.line == 0 || share < least_.slack) least_ = {share, words_.line()};
}

Real Tree::extreme_of(const Range& range, const Point& w, bool largest) const {
  std::optional<Real> value;
  const auto add = [&](const Real& x) {
    value = !value ? x : largest ? max(*value, x) : min(*value, x);
  };
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const Side& side = *sides_[i];
    for (const Point& p : side.points) add(dot(w, p));
    PieceSet* const pieces = range.pieces ? range.pieces : side.pieces;
    if (pieces) add(extreme(pieces->hull(), side.pose, w, largest));
  }
  return *value;
}

}  // namespace answers
