#include "question.h"

#include <cctype>
#include <cstdio>

namespace answers {
namespace {

constexpr Index max_steps = 1000;

// As decimals that are not above it, or not below.
std::string text_of(double x, bool above) {
  std::array<char, 40> text{};
  mpfr_t exact;
  mpfr_init2(exact, 53);
  mpfr_set_d(exact, x, MPFR_RNDN);
  mpfr_snprintf(text.data(), text.size(), above ? "%.17RUg" : "%.17RDg", exact);
  mpfr_clear(exact);
  return text.data();
}

// Of the two sets, what is left to separate.
using Pair = std::array<PieceSet*, 2>;

// The least or largest w.x of what is left of a side.
Real extreme_of(const Side& side, PieceSet* pieces, const Point& w, bool largest) {
  if (pieces) return extreme(pieces->hull(), side.pose, w, largest);
  Real value = dot(w, side.points[0]);
  for (const Point& p : side.points) {
    value = largest ? max(value, dot(w, p)) : min(value, dot(w, p));
  }
  return value;
}

// Does a half-line leave the side of the plane that its points are on?
bool goes_back(const Side& side, const Point& w, bool largest) {
  if (!side.direction) return false;
  const Real along = dot(w, *side.direction);
  return !(largest ? Real(0.0) - along : along).certainly_at_least(Real(0.0));
}

// A tree over pairs of sets, children in turn behind their parent: `A` and `B` halve a set, `a` and
// `b` make it finer, and three integers are the direction of a leaf.
void prove_apart(Words& words, std::array<Side, 2>& sides, double margin, LeastSlack& least) {
  std::vector<Pair> open{{sides[0].pieces, sides[1].pieces}};
  while (!open.empty()) {
    Pair pair = open.back();
    open.pop_back();
    while (!words.peek().empty() &&
           std::isalpha(static_cast<unsigned char>(words.peek()[0])) != 0) {
      for (const char step : words.next()) {
        const std::size_t s = step == 'A' || step == 'a' ? 0 : step == 'B' || step == 'b' ? 1 : 2;
        if (s == 2) words.refuse("a step that is none");
        if (!pair[s]) words.refuse("a point or a ray is not divided");
        if (step == 'a' || step == 'b') {
          pair[s] = &pair[s]->finer();
          continue;
        }
        if (pair[s]->size() < 2) words.refuse("one piece is not halved");
        open.push_back(pair);
        open.back()[s] = &pair[s]->half(1);
        pair[s] = &pair[s]->half(0);
      }
    }
    const Point w = read_direction(words);
    if (goes_back(sides[0], w, true) || goes_back(sides[1], w, false)) {
      words.refuse("a ray crosses the plane of this leaf");
    }
    const Real gap =
        extreme_of(sides[1], pair[1], w, false) - extreme_of(sides[0], pair[0], w, true);
    const Real length = dot(w, w).root(), slack = gap - Real(margin) * length;
    if (!slack.certainly_positive())
      words.refuse("these pieces are not separated by this direction");
    const double share = (slack / length).approximately();
    if (least.line == 0 || share < least.slack) least = {share, words.line()};
  }
}

void prove_near(Words& words, const std::array<Side, 2>& sides, double upper) {
  const Point a = read_place(words, sides[0]), b = read_place(words, sides[1]);
  const Point between{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  Real sum = 0.0;
  for (const Real& x : between) sum += x.magnitude() * x.magnitude();
  if (!(Real(upper) * Real(upper)).certainly_at_least(sum))
    words.refuse("these points are not that near");
}

}  // namespace

Pose::Pose(const std::array<double, 12>& numbers) {
  for (std::size_t i = 0; i < 12; ++i) numbers_[i] = Real(numbers[i]);
}

Point Pose::apply(const Point& p) const {
  Point x{numbers_[3], numbers_[7], numbers_[11]};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) x[i].add_product(numbers_[4 * i + k], p[k]);
  }
  return x;
}

Point Pose::back(const Point& w) const {
  Point x;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) x[k].add_product(numbers_[4 * i + k], w[i]);
  }
  return x;
}

Real Pose::shift(const Point& w) const { return dot(w, {numbers_[3], numbers_[7], numbers_[11]}); }

Real dot(const Point& a, const Point& b) {
  Real sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) sum.add_product(a[i], b[i]);
  return sum;
}

Point read_direction(Words& words) {
  constexpr std::int64_t most = std::int64_t{1} << 31;
  Point w;
  for (Real& x : w) x = Real(static_cast<double>(words.integer(-most, most)));
  return w;
}

Real extreme(std::span<const Point* const> points, const Pose& pose, const Point& w, bool largest) {
  const Point own = pose.back(w);
  Real value = dot(own, *points[0]);
  for (const Point* p : points.subspan(1)) {
    const Real here = dot(own, *p);
    value = largest ? max(value, here) : min(value, here);
  }
  return value + pose.shift(w);
}

Point read_place(Words& words, const Side& side) {
  if (!side.pieces) {
    words.expect("here");
    return side.points[0];
  }
  words.expect("on");
  return enclosing_box(*read_piece(words, *side.pieces), side.pose);
}

std::unique_ptr<PieceSet> read_piece(Words& words, const PieceSet& all) {
  std::unique_ptr<PieceSet> piece = all.only(words.count(all.size() - 1));
  read_steps(words, piece);
  return piece;
}

void read_steps(Words& words, std::unique_ptr<PieceSet>& piece) {
  for (Index left = words.count(max_steps); left > 0; --left) {
    PieceSet& children = piece->finer();
    piece = children.only(words.count(children.size() - 1));
  }
}

Point enclosing_box(PieceSet& piece, const Pose& pose) {
  Point box = pose.apply(*piece.hull()[0]);
  for (const Point* p : piece.hull().subspan(1)) {
    const Point placed = pose.apply(*p);
    for (std::size_t axis = 0; axis < 3; ++axis) box[axis] = hull(box[axis], placed[axis]);
  }
  return box;
}

std::string prove_claim(Words& words, std::array<Side, 2>& sides, LeastSlack& least) {
  if (words.take("apart")) {
    const double margin = words.real();
    if (margin < 0) words.refuse("a negative margin");
    prove_apart(words, sides, margin, least);
    return margin == 0 ? "have no point in common"
                       : "are farther apart than " + text_of(margin, false);
  }
  if (words.take("near")) {
    const double upper = words.real();
    if (upper < 0) words.refuse("a negative distance");
    prove_near(words, sides, upper);
    return "are at most " + text_of(upper, true) + " apart";
  }
  words.expect("meet");
  prove_meeting(words, sides);
  return "have a point in common";
}

}  // namespace answers
