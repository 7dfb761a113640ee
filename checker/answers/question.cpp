#include "tree.h"

#include <algorithm>
#include <cstdio>

namespace answers {
namespace {

constexpr Index max_steps = 1000;

}  // namespace

std::string text_of(double x, bool above) {
  std::array<char, 40> text{};
  mpfr_t exact;
  mpfr_init2(exact, 53);
  mpfr_set_d(exact, x, MPFR_RNDN);
  mpfr_snprintf(text.data(), text.size(), above ? "%.17RUg" : "%.17RDg", exact);
  mpfr_clear(exact);
  return text.data();
}

namespace {

void prove_near(Words& words, const std::array<Side, 2>& sides, double upper) {
  const Point a = read_place(words, sides[0]).box, b = read_place(words, sides[1]).box;
  const Point between{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  Real sum = 0.0;
  for (const Real& x : between) sum += x.magnitude() * x.magnitude();
  if (!(Real(upper) * Real(upper)).certainly_at_least(sum))
    words.refuse("these points are not that near");
}

std::unique_ptr<PieceSet> read_owner(Words& words, const PieceSet& all) {
  return all.only(words.count(all.size() - 1));
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

Place read_place(Words& words, const Side& side) {
  if (!side.pieces) {
    words.expect("here");
    return {side.points[0]};
  }
  words.expect("on");
  std::unique_ptr<PieceSet> piece = read_owner(words, *side.pieces);
  const Index owner = piece->owners()[0];
  read_steps(words, piece);
  return {enclosing_box(*piece, side.pose), owner};
}

std::unique_ptr<PieceSet> read_piece(Words& words, const PieceSet& all) {
  std::unique_ptr<PieceSet> piece = read_owner(words, all);
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

namespace {

std::string prove_claim(Words& words, Question& question, LeastSlack& least) {
  if (words.take("apart")) {
    const double margin = words.real();
    if (margin < 0) words.refuse("a negative margin");
    const Tree tree(words, {&question.sides[0], &question.sides[1]}, margin, least);
    tree.prove({0, 1, question.sides[0].pieces}, {1, 2, question.sides[1].pieces}, {});
    question.apart = true;
    return margin == 0 ? "have no point in common"
                       : "are farther apart than " + text_of(margin, false);
  }
  if (words.take("near")) {
    const double upper = words.real();
    if (upper < 0) words.refuse("a negative distance");
    prove_near(words, question.sides, upper);
    return "are at most " + text_of(upper, true) + " apart";
  }
  if (words.take("winding")) return prove_winding(words, question, least);
  if (words.take("solids")) return prove_solids(words, question);
  words.expect("meet");
  prove_meeting(words, question.sides);
  return "have a point in common";
}

}  // namespace

std::string prove_claims(Words& words, Question& question, LeastSlack& least) {
  constexpr std::array claims{"apart", "near", "winding", "solids", "meet"};
  std::string all;
  do {
    const std::string claim = prove_claim(words, question, least);
    if (!claim.empty()) all += (all.empty() ? "" : ", and ") + claim;
  } while (std::ranges::find(claims, words.peek()) != claims.end());
  if (all.empty()) words.refuse("claims that nothing follows from");
  return all;
}

}  // namespace answers
