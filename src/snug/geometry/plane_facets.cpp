#include <snug/geometry/plane_facets.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <span>

#include <snug/geometry/rounding.h>
#include <support/contract.h>

namespace snug {
namespace {

using Corners = std::uint64_t;  // a bit for each corner of a facet
constexpr Corners bit(std::size_t k) { return Corners{1} << k; }
constexpr Corners all_bits(std::size_t count) { return count >= 64 ? ~Corners{0} : bit(count) - 1; }

std::array<Projection, 3> projections(const Vector3& normal) {
  std::array<std::size_t, 3> axes{0, 1, 2};
  std::sort(axes.begin(), axes.end(),
            [&](std::size_t i, std::size_t k) { return std::fabs(normal[i]) > std::fabs(normal[k]); });
  std::array<Projection, 3> result;
  for (std::size_t k = 0; k < 3; ++k) result[k] = {(axes[k] + 1) % 3, (axes[k] + 2) % 3};
  return result;
}

// The point from p to q at of_p / (of_p - of_q), of values on either side of 0.
BoundedPoint point_between(const ExactPoint& p, const ExactPoint& q, const ExactNumber& of_p,
                           const ExactNumber& of_q) {
  const DoubleDouble share = of_p.about() / (of_p - of_q).about();
  BoundedPoint result;
  for (std::size_t k = 0; k < 3; ++k) {
    const DoubleDouble from = p.exact[k].about(), along = (q.exact[k] - p.exact[k]).about();
    result.position[k] = (from + share * along).high;
    const double largest = std::fabs(from.high) + std::fabs(along.high);
    result.error =
        std::max(result.error, enlarged(unit_roundoff * std::fabs(result.position[k]) + 0x1p-80 * largest));
  }
  return result;
}

// Of a point over a facet's plane, times the same for all points.
ExactNumber height(const PlaneFacet& plane, const ExactPoint& p) {
  return determinant(plane.corner(0), plane.corner(1), plane.corner(2), p);
}

bool on_line(const ExactPoint& p, const ExactPoint& q, const ExactPoint& x) {
  return orientation(p, q, x, Projection{0, 1}) == 0 && orientation(p, q, x, Projection{1, 2}) == 0 &&
         orientation(p, q, x, Projection{2, 0}) == 0;
}

// A point that was computed is often the exact one: where `is_it` says so.
template <class IsIt>
void make_exact(BoundedPoint& point, const IsIt& is_it) {
  if (point.error > 0 && may_be_signed(point.position) && is_it(ExactPoint(point.position))) point.error = 0;
}

BoundedPoint rounded(const ExactPoint& p) { return {p.about, p.error}; }

// ---- Two polygons in one plane, or an edge or a corner of the one in the plane of the other ----

// A corner of what both have in common, and the least element of each that it is on.
struct CommonCorner {
  BoundedPoint point;
  std::array<Corners, 2> on{};
};

class Overlap {
 public:
  // Of `a` and the hull of the corners of b that are given: all, two, or one.
  Overlap(const PlaneFacet& a, const PlaneFacet& b, std::span<const std::size_t> of_b)
      : a_(a), b_(b), names_(of_b.begin(), of_b.end()), n_(a.size()), m_(names_.size()) {
    if (m_ > 2 && turn_of_b() < 0) std::reverse(names_.begin(), names_.end());
    edges_ = m_ > 2 ? m_ : m_ - 1;
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t j = 0; j < m_; ++j) side_of_b_.push_back(side(a.corner(i), a.corner(i + 1), q(j)));
    }
    for (std::size_t j = 0; j < edges_; ++j) {
      for (std::size_t i = 0; i < n_; ++i) side_of_a_.push_back(side(q(j), q(j + 1), a.corner(i)));
    }
  }

  [[nodiscard]] FacetMeeting run() {
    find_corners();
    FacetMeeting result;
    if (found_.empty()) return result;
    if (found_.size() > 2) put_in_order();
    result.state = FacetMeeting::State::touching;
    std::array<Corners, 2> on{};
    for (const CommonCorner& corner : found_) {
      result.corners.push_back(corner.point);
      for (std::size_t s = 0; s < 2; ++s) on[s] |= corner.on[s];
    }
    if (!is_edge(on[0], n_)) on[0] = all_bits(n_);
    if (m_ > 2 && !is_edge(on[1], m_)) on[1] = all_bits(m_);
    for (std::size_t k = 0; k < n_; ++k) {
      if ((on[0] & bit(k)) != 0) result.elements[0].push_back(k);
    }
    for (std::size_t k = 0; k < m_; ++k) {
      if ((on[1] & bit(k)) != 0) result.elements[1].push_back(names_[k]);
    }
    std::sort(result.elements[1].begin(), result.elements[1].end());
    return result;
  }

 private:
  [[nodiscard]] const ExactPoint& q(std::size_t j) const { return b_.corner(names_[j % m_]); }
  [[nodiscard]] int side(const ExactPoint& p, const ExactPoint& r, const ExactPoint& x) const {
    return orientation(p, r, x, a_.to());
  }
  [[nodiscard]] int turn_of_b() const { return side(q(0), q(1), q(2)); }
  // Of corner j of b beside edge i of a, and the other way round.
  [[nodiscard]] int b_side(std::size_t i, std::size_t j) const { return side_of_b_[i * m_ + j % m_]; }
  [[nodiscard]] int a_side(std::size_t j, std::size_t i) const { return side_of_a_[j * n_ + i % n_]; }

  [[nodiscard]] static Corners edge(std::size_t k, std::size_t count) {
    return bit(k) | bit((k + 1) % count);
  }
  // One corner, or two next to each other?
  [[nodiscard]] static bool is_edge(Corners on, std::size_t count) {
    if (std::popcount(on) != 2) return std::popcount(on) < 2;
    for (std::size_t k = 0; k < count; ++k) {
      if (on == edge(k, count)) return true;
    }
    return false;
  }
  // The least element of a polygon that a point of it is on, by the edges whose lines it is on.
  template <class OnLine>
  [[nodiscard]] static Corners element(std::size_t count, const OnLine& on_line) {
    Corners on = all_bits(count);
    for (std::size_t k = 0; k < count; ++k) {
      if (on_line(k)) on &= edge(k, count);
    }
    return on;
  }

  // Is a corner of a, on the line of an edge of b, between its ends?
  [[nodiscard]] bool between(const ExactPoint& p) const {
    ExactNumber product;
    for (const std::size_t k : {a_.to().first, a_.to().second})
      product = product + (q(0).exact[k] - p.exact[k]) * (q(1).exact[k] - p.exact[k]);
    return product.sign() < 0;
  }

  // Extreme points are corners of one in the other, and points where edges cross.
  void find_corners() {
    for (std::size_t j = 0; j < m_; ++j) {
      bool inside = true;
      for (std::size_t i = 0; i < n_ && inside; ++i) inside = b_side(i, j) >= 0;
      if (!inside) continue;
      found_.push_back(
          {rounded(q(j)), {element(n_, [&](std::size_t i) { return b_side(i, j) == 0; }), bit(j)}});
    }
    for (std::size_t i = 0; i < n_ && m_ > 1; ++i) {
      if (m_ == 2) {
        if (a_side(0, i) == 0 && between(a_.corner(i)))
          found_.push_back({rounded(a_.corner(i)), {bit(i), all_bits(2)}});
        continue;
      }
      bool inside = true;
      for (std::size_t j = 0; j < m_ && inside; ++j) inside = a_side(j, i) >= 0;
      const Corners on = element(m_, [&](std::size_t j) { return a_side(j, i) == 0; });
      // A corner of both is there.
      if (inside && std::popcount(on) > 1) found_.push_back({rounded(a_.corner(i)), {bit(i), on}});
    }
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t j = 0; j < edges_; ++j) {
        if (b_side(i, j) * b_side(i, j + 1) < 0 && a_side(j, i) * a_side(j, i + 1) < 0)
          found_.push_back({crossing_of(i, j), {edge(i, n_), edge(j, m_)}});
      }
    }
  }

  [[nodiscard]] BoundedPoint crossing_of(std::size_t i, std::size_t j) const {
    const ExactPoint &p = a_.corner(i), &r = a_.corner(i + 1);
    BoundedPoint found =
        point_between(q(j), q(j + 1), determinant(p, r, q(j), a_.to()), determinant(p, r, q(j + 1), a_.to()));
    make_exact(found, [&](const ExactPoint& at) { return on_line(p, r, at) && on_line(q(j), q(j + 1), at); });
    return found;
  }

  // Each side of the polygon is on an edge of a or of b.
  void put_in_order() {
    std::vector<std::size_t> next(found_.size(), found_.size());
    for (std::size_t s = 0; s < 2; ++s) {
      const std::size_t count = s == 0 ? n_ : m_;
      for (std::size_t k = 0; k < count; ++k) {
        std::vector<std::size_t> on;
        for (std::size_t x = 0; x < found_.size(); ++x) {
          if ((found_[x].on[s] & ~edge(k, count)) == 0) on.push_back(x);
        }
        if (on.size() != 2) continue;
        if (!comes_first(s, k, found_[on[0]], found_[on[1]])) std::swap(on[0], on[1]);
        next[on[0]] = on[1];
      }
    }
    std::vector<CommonCorner> ordered;
    for (std::size_t x = 0; ordered.size() < found_.size(); x = next[x]) {
      SNUG_EXPECT(x < found_.size());
      ordered.push_back(found_[x]);
    }
    found_ = std::move(ordered);
  }

  // Of two corners on edge k of one of them.
  [[nodiscard]] bool comes_first(std::size_t s, std::size_t k, const CommonCorner& x,
                                 const CommonCorner& y) const {
    const int of_x = place_on(s, k, x), of_y = place_on(s, k, y);
    if (of_x != of_y) return of_x < of_y;
    // Both inside of the edge, and corners of the other one: next to each other, and run the same way.
    const std::size_t count = s == 0 ? m_ : n_;
    const auto corner = [&](const CommonCorner& c) {
      return static_cast<std::size_t>(std::countr_zero(c.on[1 - s]));
    };
    return (corner(x) + 1) % count == corner(y);
  }
  // -2: its first end; -1: where the other's inside begins along it; 0: a corner of the other one; 1: where that ends; 2: its last end.
  [[nodiscard]] int place_on(std::size_t s, std::size_t k, const CommonCorner& c) const {
    if (c.on[s] == bit(k)) return -2;
    if (std::popcount(c.on[s]) == 1) return 2;
    if (std::popcount(c.on[1 - s]) == 1) return 0;
    const std::size_t count = s == 0 ? m_ : n_;
    std::size_t other = 0;
    while (c.on[1 - s] != edge(other, count)) ++other;
    return s == 0 ? a_side(other, k) : b_side(other, k);
  }

  const PlaneFacet &a_, &b_;
  std::vector<std::size_t> names_;  // corners of b, counter-clockwise as those of a are
  std::size_t n_, m_, edges_ = 0;
  std::vector<int> side_of_b_, side_of_a_;
  std::vector<CommonCorner> found_;
};

// ---- Facets that are not in one plane ----

// Signs of the corners of one beside the plane of another.
struct Sides {
  std::vector<int> of;
  std::vector<std::size_t> zeros;
  bool above = false, below = false;

  Sides(const PlaneFacet& plane, const PlaneFacet& facet) {
    for (std::size_t k = 0; k < facet.size(); ++k) {
      of.push_back(orientation(plane.corner(0), plane.corner(1), plane.corner(2), facet.corner(k)));
      above = above || of.back() > 0;
      below = below || of.back() < 0;
      if (of.back() == 0) zeros.push_back(k);
    }
  }
  [[nodiscard]] bool both() const { return above && below; }
};

// Where the border of a facet passes another one's plane: the edge from a corner below it to one that is not, or to that corner.
struct Passage {
  std::size_t low, high;
};
// As the corners run: where they leave what is below, and where they come back.
std::array<Passage, 2> passages(const Sides& sides) {
  const std::size_t count = sides.of.size();
  std::array<Passage, 2> found{};
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t next = (k + 1) % count;
    if (sides.of[k] < 0 && sides.of[next] >= 0) found[0] = {k, next};
    if (sides.of[k] >= 0 && sides.of[next] < 0) found[1] = {next, k};
  }
  return found;
}

// Where an edge of a facet passes the plane of another one.
BoundedPoint passing_point(const PlaneFacet& facet, Passage at, const Sides& sides, const PlaneFacet& plane) {
  const ExactPoint &low = facet.corner(at.low), &high = facet.corner(at.high);
  if (sides.of[at.high] == 0) return rounded(high);
  BoundedPoint found = point_between(low, high, height(plane, low), height(plane, high));
  make_exact(found, [&](const ExactPoint& x) {
    return orientation(plane.corner(0), plane.corner(1), plane.corner(2), x) == 0 && on_line(low, high, x);
  });
  return found;
}

std::vector<std::size_t> element_of(Passage at, const Sides& sides) {
  if (sides.of[at.high] == 0) return {at.high};
  return {std::min(at.low, at.high), std::max(at.low, at.high)};
}

std::vector<std::size_t> whole(const PlaneFacet& facet) {
  std::vector<std::size_t> all(facet.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

// Two facets that pass each other's planes: each has a segment of the line that these have in common. Along the line, in the direction of
// normal of a x normal of b, that of a goes from where its border rises to where it falls, that of b the other way round; and an edge of
// a passes the line before an edge of b, both from below, if its ends and that edge's are positively oriented.
FacetMeeting meet_in_line(const PlaneFacet& a, const PlaneFacet& b, const Sides& of_a, const Sides& of_b) {
  const auto [a_begin, a_end] = passages(of_a);
  const auto [b_end, b_begin] = passages(of_b);
  const auto a_before_b = [&](Passage p, Passage q) {
    return orientation(a.corner(p.low), a.corner(p.high), b.corner(q.low), b.corner(q.high));
  };
  const int first = a_before_b(a_begin, b_end), last = a_before_b(a_end, b_begin);
  FacetMeeting result;
  if (first < 0 || last > 0) return result;
  if (first == 0 || last == 0) {
    const Passage p = first == 0 ? a_begin : a_end, q = first == 0 ? b_end : b_begin;
    result.state = FacetMeeting::State::touching;
    result.elements = {element_of(p, of_a), element_of(q, of_b)};
    result.corners = {of_b.of[q.high] == 0 ? passing_point(b, q, of_b, a) : passing_point(a, p, of_a, b)};
    return result;
  }
  result.state = FacetMeeting::State::crossing;
  result.elements = {whole(a), whole(b)};
  // What is first on the line does not end the segment where it begins, and what is last not where it ends.
  const auto add_end = [&](std::size_t end, Passage p, Passage q, int b_ends, bool corner_of_b) {
    result.ends[end] = {b_ends > 0 ? whole(a) : element_of(p, of_a),
                        b_ends < 0 ? whole(b) : element_of(q, of_b)};
    result.corners.push_back(b_ends > 0 || (b_ends == 0 && corner_of_b) ? passing_point(b, q, of_b, a)
                                                                        : passing_point(a, p, of_a, b));
  };
  add_end(0, a_begin, b_begin, a_before_b(a_begin, b_begin), of_b.of[b_begin.high] == 0);
  add_end(1, a_end, b_end, -a_before_b(a_end, b_end), of_b.of[b_end.high] == 0);
  return result;
}

FacetMeeting turned(FacetMeeting meeting) {
  std::swap(meeting.elements[0], meeting.elements[1]);
  return meeting;
}

}  // namespace

std::optional<PlaneFacet> PlaneFacet::made(std::vector<ExactPoint> corners) {
  SNUG_EXPECT(corners.size() >= 3 && corners.size() <= max_corners);
  PlaneFacet facet;
  facet.corners_ = std::move(corners);
  const Point3 &p = facet.corners_[0].about, &q = facet.corners_[1].about, &r = facet.corners_[2].about;
  for (const Projection& to : projections(cross(q - p, r - p))) {
    const int turn = orientation(facet.corners_[0], facet.corners_[1], facet.corners_[2], to);
    if (turn == 0) continue;
    facet.to_ = turn > 0 ? to : Projection{to.second, to.first};
    return facet;
  }
  return std::nullopt;
}

FacetMeeting meet(const PlaneFacet& a, const PlaneFacet& b) {
  const Sides of_b(a, b);
  if (of_b.zeros.empty() && !of_b.both()) return {};
  if (of_b.zeros.size() == b.size() || !of_b.both()) return Overlap(a, b, of_b.zeros).run();
  const Sides of_a(b, a);
  if (of_a.zeros.empty() && !of_a.both()) return {};
  if (!of_a.both()) return turned(Overlap(b, a, of_a.zeros).run());
  return meet_in_line(a, b, of_a, of_b);
}

}  // namespace snug
