#include "query.h"

namespace snug::bench {

Queries::Queries(const Surface& a, const Surface& b, std::optional<TableLayout> table)
    : a_(a, 1, {}, table), b_(b, 1, {}, table), scratch_(a_, b_) {}

Collision Queries::collide(const PlacedPair& at, double tolerance, double margin) {
  return snug::collide(a_, at.a, b_, at.b, {tolerance, margin}, scratch_);
}

std::optional<bool> Queries::meet(const PlacedPair& at) {
  const Collision answer = collide(at, 1e-7);
  if (answer.verdict == Verdict::separated) return false;
  return answer.verdict == Verdict::within ? std::optional<bool>(true) : std::nullopt;
}

Queries::Interval Queries::distance(const PlacedPair& at, double precision) {
  double low = 0, high = 16;
  while (high - low > precision) {
    const double middle = 0.5 * (low + high);
    const Collision answer = collide(at, 0.25 * (high - low), middle);
    if (answer.verdict == Verdict::separated) low = middle;
    if (answer.upper && *answer.upper < high) high = *answer.upper;
    if (answer.verdict == Verdict::undecided) break;
  }
  return {low, high};
}

}  // namespace snug::bench
