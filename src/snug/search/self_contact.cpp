#include <snug/search/self_contact.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <snug/geometry/exact_sign.h>
#include <snug/search/feet.h>
#include <snug/search/piece.h>
#include <support/direction.h>
#include <support/parallel.h>

namespace snug {
namespace {

using Names = std::array<std::uint32_t, 3>;
using Corners3 = std::array<const Point3*, 3>;

// Of a triangle with later ones: bounds the memory where everything meets everything.
constexpr std::uint8_t max_of_one = 16;

// A triangle's extents along axes of its own: these tell most triangles near a narrow one from it.
class Slabs {
 public:
  explicit Slabs(const Triangle& triangle) {
    const Vector3 normal = unit_normal(triangle);
    const Vector3 along = longest_edge(triangle);
    axes_ = {normalized(cross(normal, along)), normal, normalized(along)};
    for (std::size_t a = 0; a < 3; ++a) extents_[a] = extent_of(triangle, axes_[a]);
  }
  // Along one of the axes, certainly?
  [[nodiscard]] bool apart(const Triangle& other) const {
    for (std::size_t a = 0; a < 3; ++a) {
      const Extent extent = extent_of(other, axes_[a]);
      if (extent.lower - extents_[a].upper > distance_rounding ||
          extents_[a].lower - extent.upper > distance_rounding)
        return true;
    }
    return false;
  }

 private:
  static Extent extent_of(const Triangle& triangle, const Vector3& axis) {
    Extent extent;
    for (const Point3& p : triangle) extent.add(dot(axis, p - Point3{}));
    return extent;
  }
  std::array<Vector3, 3> axes_;
  std::array<Extent, 3> extents_;
};

// Two coordinates in which a triangle keeps its area; none if it has none.
std::optional<Projection> plane_of(const Corners3& t) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Projection plane{i, (i + 1) % 3};
    if (orientation(*t[0], *t[1], *t[2], plane) != 0) return plane;
  }
  return std::nullopt;
}

// How corners of one triangle lie to another one.
using Sides = std::array<int, 3>;

// Two triangles with area that name at most one vertex both, compared by signs of determinants alone.
class ExactPair {
 public:
  ExactPair(const Corners3& a, const Corners3& b) : t_{a, b} {
    for (std::size_t s = 0; s < 2; ++s) {
      const Corners3 &own = t_[s], &other = t_[1 - s];
      for (std::size_t k = 0; k < 3; ++k)
        sides_[s][k] = orientation(*other[0], *other[1], *other[2], *own[k]);
    }
  }

  // Of triangles without a common vertex: some point. `common`: the corner of each that is one vertex; a point beside it, which
  // leads, away from it, to the far side of one of them.
  [[nodiscard]] TriangleContact contact(std::optional<std::array<std::size_t, 2>> common) {
    for (const Sides& side : sides_) {
      if (one_sign(side, 1) || one_sign(side, -1)) return TriangleContact::none;
    }
    const bool plane = sides_[0] == Sides{};
    if (plane) plane_ = *plane_of(t_[0]);
    bool met = false;
    for (std::size_t s = 0; s < 2 && !met; ++s) {
      for (std::size_t k = 0; k < 3 && !met; ++k) {
        if (!common || k == ((*common)[s] + 1) % 3)
          met = plane ? edge_meets_in_plane(s, k) : edge_meets(s, k);
      }
    }
    if (!met) return TriangleContact::none;
    if (plane)
      return insides_are_apart(0) || insides_are_apart(1) ? TriangleContact::touching
                                                          : TriangleContact::overlapping;
    if (!straddles(sides_[0]) || !straddles(sides_[1])) return TriangleContact::touching;
    return common || chords_overlap() ? TriangleContact::crossing : TriangleContact::touching;
  }

 private:
  static bool one_sign(const Sides& sides, int sign) {
    // A common vertex is in the other plane.
    return std::all_of(sides.begin(), sides.end(), [&](int s) { return s == sign; });
  }
  static bool straddles(const Sides& sides) {
    return std::min({sides[0], sides[1], sides[2]}) < 0 && std::max({sides[0], sides[1], sides[2]}) > 0;
  }
  static bool of_both_signs(int x, int y, int z) {
    return std::min({x, y, z}) < 0 && std::max({x, y, z}) > 0;
  }

  // Does edge k of triangle s meet the other one? They are in different planes.
  [[nodiscard]] bool edge_meets(std::size_t s, std::size_t k) const {
    const Point3 &p = *t_[s][k], &q = *t_[s][(k + 1) % 3];
    const Corners3& t = t_[1 - s];
    const int above_p = sides_[s][k], above_q = sides_[s][(k + 1) % 3];
    if (above_p * above_q > 0) return false;
    if (above_p == 0 && above_q == 0) return segment_meets_in_plane(p, q, t, *plane_of(t));
    return !of_both_signs(orientation(p, q, *t[0], *t[1]), orientation(p, q, *t[1], *t[2]),
                          orientation(p, q, *t[2], *t[0]));
  }
  [[nodiscard]] bool edge_meets_in_plane(std::size_t s, std::size_t k) const {
    return segment_meets_in_plane(*t_[s][k], *t_[s][(k + 1) % 3], t_[1 - s], plane_);
  }
  // Not where all of the one is outside of an edge of the triangle, or all of the triangle on one side of its line.
  static bool segment_meets_in_plane(const Point3& p, const Point3& q, const Corners3& t, Projection plane) {
    const int turn = orientation(*t[0], *t[1], *t[2], plane);
    for (std::size_t k = 0; k < 3; ++k) {
      const Point3 &from = *t[k], &to = *t[(k + 1) % 3];
      if (turn * orientation(from, to, p, plane) < 0 && turn * orientation(from, to, q, plane) < 0)
        return false;
    }
    std::array<int, 3> of_line;
    for (std::size_t k = 0; k < 3; ++k) of_line[k] = orientation(p, q, *t[k], plane);
    return !one_sign(of_line, 1) && !one_sign(of_line, -1);
  }
  // Of triangles in a plane: is there an edge of one that the other has nothing inside of?
  [[nodiscard]] bool insides_are_apart(std::size_t s) const {
    const Corners3 &own = t_[s], &other = t_[1 - s];
    const int turn = orientation(*own[0], *own[1], *own[2], plane_);
    for (std::size_t k = 0; k < 3; ++k) {
      const bool outside = std::all_of(other.begin(), other.end(), [&](const Point3* p) {
        return turn * orientation(*own[k], *own[(k + 1) % 3], *p, plane_) <= 0;
      });
      if (outside) return true;
    }
    return false;
  }
  // Both straddle the other's plane, so have chords on the line that both planes share: do these have more than an end in common?
  // Source: [Guigue03].
  [[nodiscard]] bool chords_overlap() const {
    const Corners3 a = alone_first(0), b = alone_first(1);
    return orientation(*a[0], *a[1], *b[0], *b[1]) < 0 && orientation(*a[0], *a[2], *b[2], *b[0]) < 0;
  }
  // The corners in order, first the one that is alone on its side, with the other triangle turned so that this is its upper one.
  [[nodiscard]] Corners3 alone_first(std::size_t s) const {
    const auto alone = [](const Sides& sides) {
      for (std::size_t k = 0; k < 3; ++k) {
        const int own = sides[k], next = sides[(k + 1) % 3], last = sides[(k + 2) % 3];
        if (own != 0 && own * next <= 0 && own * last <= 0) return k;
      }
      return std::size_t{0};
    };
    const std::size_t k = alone(sides_[s]), of_other = alone(sides_[1 - s]);
    Corners3 turned{t_[s][k], t_[s][(k + 1) % 3], t_[s][(k + 2) % 3]};
    if (sides_[1 - s][of_other] < 0) std::swap(turned[1], turned[2]);
    return turned;
  }

  std::array<Corners3, 2> t_;
  std::array<Sides, 2> sides_;
  Projection plane_;  // that both are in
};

// Is there a plane through a common vertex with the rest of both triangles on different sides, certainly? Most of a fan's triangles
// are told apart so.
bool parted_at(const Corners3& a, const Corners3& b, const std::array<std::size_t, 2>& common) {
  const Point3& v = *a[common[0]];
  std::array<Vector3, 2> of_a, of_b;
  Vector3 across;
  for (std::size_t k = 0; k < 2; ++k) {
    of_a[k] = *a[(common[0] + 1 + k) % 3] - v;
    of_b[k] = *b[(common[1] + 1 + k) % 3] - v;
    across = across + (normalized(of_a[k]) - normalized(of_b[k]));
  }
  const auto certainly_positive = [](const Vector3& w, const Vector3& d) {
    return dot(w, d) >
           0x1p-50 * (std::fabs(w.x * d.x) + std::fabs(w.y * d.y) + std::fabs(w.z * d.z)) + 1e-300;
  };
  return certainly_positive(across, of_a[0]) && certainly_positive(across, of_a[1]) &&
         certainly_positive(-across, of_b[0]) && certainly_positive(-across, of_b[1]);
}

TriangleContact contact_between(std::span<const Point3> points, const Names& a, const Names& b) {
  const Corners3 s{&points[a[0]], &points[a[1]], &points[a[2]]},
      t{&points[b[0]], &points[b[1]], &points[b[2]]};
  std::array<std::size_t, 3> in_a{}, in_b{};
  std::size_t common = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (a[i] != b[j]) continue;
      in_a[common] = i;
      in_b[common] = j;
      ++common;
    }
  }
  if (common == 3) return TriangleContact::overlapping;
  if (common == 2) {
    // In one plane, and on one side of the edge?
    const Point3 &v = *s[in_a[0]], &w = *s[in_a[1]], &x = *s[3 - in_a[0] - in_a[1]],
                 &y = *t[3 - in_b[0] - in_b[1]];
    if (orientation(v, w, x, y) != 0) return TriangleContact::none;
    const Projection plane = *plane_of(s);
    return orientation(v, w, x, plane) == orientation(v, w, y, plane) ? TriangleContact::overlapping
                                                                      : TriangleContact::none;
  }
  if (common == 1) {
    const std::array<std::size_t, 2> vertex{in_a[0], in_b[0]};
    return parted_at(s, t, vertex) ? TriangleContact::none : ExactPair(s, t).contact(vertex);
  }
  return ExactPair(s, t).contact(std::nullopt);
}

// What can be said of a triangle alone: it has no area, or not the coordinates for exact signs.
TriangleContact contact_of_one(std::span<const Point3> points, const Names& t) {
  const Corners3 corners{&points[t[0]], &points[t[1]], &points[t[2]]};
  if (!std::all_of(corners.begin(), corners.end(), [](const Point3* p) { return may_be_signed(*p); }))
    return TriangleContact::unknown;
  return plane_of(corners) ? TriangleContact::none : TriangleContact::collapsed;
}

// Is a box around it much less than a ball?
bool is_narrow(const Triangle& t) {
  const double longest = length_sq(longest_edge(t));
  return length_sq(cross(t[1] - t[0], t[2] - t[0])) < 0x1p-6 * longest * longest;
}

Box3 box_of(const Triangle& t) {
  Box3 box;
  for (const Point3& p : t) box.add(p);
  return box;
}

// Calls visit(piece) for those that may meet a triangle; it may return true to end this where that is narrow.
template <class Visit>
void visit_near(const PieceSet& set, const Triangle& triangle, const Visit& visit) {
  const QuadraticTriangle facet = flat_quadratic(triangle);
  if (is_narrow(triangle)) {
    set.visit_near(slim_box(facet), visit);
  } else {
    for_each_near(set, facet, [&](std::uint32_t piece) { static_cast<void>(visit(piece)); });
  }
}

// ---- Fans ----

// Around a vertex of so many triangles most pairs are near each other.
constexpr std::size_t min_fan = 256;

// Triangles around a vertex, each on an edge with the one before.
struct Fan {
  std::vector<std::uint32_t> triangles;
  std::vector<std::uint32_t>
      rim;  // their other vertices in order, the first one again at the end of a closed fan
};

// The largest fan of some triangles that name v; none where three are at an edge.
std::optional<Fan> fan_around(std::uint32_t v, std::span<const std::uint32_t> around,
                              std::span<const Names> triangles) {
  std::unordered_map<std::uint32_t, std::uint32_t> from;  // by the vertex of the rim where it begins
  std::unordered_set<std::uint32_t> ends;
  const auto next = [&](std::uint32_t t, std::size_t by) {
    const Names& names = triangles[t];
    return names[(static_cast<std::size_t>(std::find(names.begin(), names.end(), v) - names.begin()) + by) %
                 3];
  };
  for (const std::uint32_t t : around) {
    if (!from.emplace(next(t, 1), t).second || !ends.insert(next(t, 2)).second) return std::nullopt;
  }
  Fan largest;
  const auto walk = [&](std::uint32_t begin) {
    Fan fan{{}, {begin}};
    for (auto at = from.find(begin); at != from.end(); at = from.find(fan.rim.back())) {
      fan.triangles.push_back(at->second);
      fan.rim.push_back(next(at->second, 2));
      from.erase(at);
    }
    if (fan.triangles.size() > largest.triangles.size()) largest = std::move(fan);
  };
  for (const std::uint32_t t : around) {
    if (!ends.contains(next(t, 1))) walk(next(t, 1));
  }
  // What is left is closed.
  for (const std::uint32_t t : around) walk(next(t, 1));
  return largest;
}

// Does a fan whose triangles all turn the same way, seen along an axis, go around at most once? Then any two of its triangles have in
// common what they name alone.
bool turns_once(std::span<const Point3> points, std::uint32_t v, const Fan& fan, Projection plane) {
  const auto side = [&](std::uint32_t a, std::uint32_t b) {
    return orientation(points[v], points[a], points[b], plane);
  };
  const std::size_t count = fan.triangles.size();
  const int turn = side(fan.rim[0], fan.rim[1]);
  bool beyond = false;  // half a turn from the first edge
  for (std::size_t k = 1; k < count; ++k) {
    const bool last = k + 1 == count && fan.rim[count] == fan.rim[0];
    const int of_end = last ? 0 : turn * side(fan.rim[0], fan.rim[k + 1]);
    if (beyond && !last && of_end >= 0) return false;
    beyond = beyond || of_end <= 0;
  }
  return true;
}

// Which large fan of those in which no two triangles meet a triangle belongs to, from 1 on; 0 for none.
std::vector<std::uint32_t> large_fans(std::span<const Point3> points, std::span<const Names> triangles,
                                      std::span<const TriangleContact> alone, std::uint32_t& count) {
  std::vector<std::uint32_t> valence(points.size(), 0), fan_of(triangles.size(), 0);
  for (const Names& t : triangles) {
    for (const std::uint32_t v : t) ++valence[v];
  }
  std::map<std::uint32_t, std::vector<std::uint32_t>> large;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (const std::uint32_t v : triangles[t]) {
      if (valence[v] >= min_fan) large[v].push_back(t);
    }
  }
  count = 0;
  for (const auto& [v, around] : large) {
    for (const Projection& plane : {Projection{0, 1}, Projection{1, 2}, Projection{2, 0}}) {
      for (const int turn : {1, -1}) {
        std::vector<std::uint32_t> some;
        std::copy_if(around.begin(), around.end(), std::back_inserter(some), [&](std::uint32_t t) {
          const auto& [a, b, c] = triangles[t];
          return alone[t] == TriangleContact::none && fan_of[t] == 0 &&
                 orientation(points[a], points[b], points[c], plane) == turn;
        });
        if (some.size() < min_fan) continue;
        const std::optional<Fan> fan = fan_around(v, some, triangles);
        if (!fan || fan->triangles.size() < min_fan || !turns_once(points, v, *fan, plane)) continue;
        ++count;
        for (const std::uint32_t t : fan->triangles) fan_of[t] = count;
      }
    }
  }
  return fan_of;
}

// ---- Sets ----

// Triangles that others are compared with; those of a fan, from 1 on, not with each other.
struct TriangleSet {
  std::vector<std::uint32_t> members;
  std::uint32_t fan = 0;
};

// A set for each fan, and for all others some that lie together: what comparisons need of all of them would take much more memory
// than the triangles do.
std::vector<TriangleSet> sets_of(std::span<const Point3> points, std::span<const Names> triangles,
                                 std::span<const std::uint32_t> fan_of, std::uint32_t fans, int threads) {
  constexpr std::size_t least_size = 8192, max_sets = 128;
  std::vector<TriangleSet> sets(fans);
  for (std::uint32_t f = 0; f < fans; ++f) sets[f].fan = f + 1;
  std::vector<std::uint32_t> others;
  std::vector<Point3> places;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (fan_of[t] > 0) {
      sets[fan_of[t] - 1].members.push_back(t);
    } else {
      others.push_back(t);
      places.push_back(points[triangles[t][0]]);
    }
  }
  const std::vector<std::uint32_t> order = in_order_of_place(places, threads);
  // Each triangle is held against the box of each set.
  const std::size_t most = std::max(least_size, (order.size() + max_sets - 1) / max_sets);
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i % most == 0) sets.emplace_back();
    sets.back().members.push_back(others[order[i]]);
  }
  return sets;
}

}  // namespace

std::vector<TrianglePair> self_contacts(std::span<const Point3> points, std::span<const Names> triangles,
                                        std::size_t most, int threads, const WorkMonitor& monitor,
                                        std::span<const std::uint8_t> wanted) {
  if (triangles.empty()) return {};
  const auto is_wanted = [&](std::size_t i) { return wanted.empty() || wanted[i] != 0; };
  std::vector<TriangleContact> alone;
  for (const Names& t : triangles) alone.push_back(contact_of_one(points, t));
  std::uint32_t fans = 0;
  const std::vector<std::uint32_t> fan_of = large_fans(points, triangles, alone, fans);
  constexpr std::size_t block = 1024;
  std::vector<std::vector<TrianglePair>> found((triangles.size() + block - 1) / block);
  std::vector<std::uint8_t> found_of(triangles.size());  // pairs
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto own = static_cast<std::uint32_t>(i);
    if (is_wanted(i) && alone[i] != TriangleContact::none) found[i / block].push_back({own, own, alone[i]});
  }
  const auto corners_of = [&](std::size_t t) {
    return Triangle{points[triangles[t][0]], points[triangles[t][1]], points[triangles[t][2]]};
  };
  for (const TriangleSet& part : sets_of(points, triangles, fan_of, fans, threads)) {
    std::vector<Names> names;
    names.reserve(part.members.size());
    for (const std::uint32_t t : part.members) names.push_back(triangles[t]);
    PieceSet set(points, names);
    set.prepare(threads);
    const Box3 around = set.box();
    parallel_for(found.size(), threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin * block; i < std::min(triangles.size(), end * block); ++i) {
        if (i % block == 0) monitor.checkpoint();
        if (!is_wanted(i) || alone[i] == TriangleContact::collapsed ||
            (part.fan > 0 && part.fan == fan_of[i]))
          continue;
        const Triangle corners = corners_of(i);
        if (!overlap(box_of(corners), around)) continue;
        const auto own = static_cast<std::uint32_t>(i);
        const Slabs slabs(corners);
        const auto compare = [&](std::uint32_t piece) {
          if (found_of[i] == max_of_one) return true;
          const std::uint32_t other = part.members[piece];
          if (other == own || alone[other] == TriangleContact::collapsed) return false;
          // Of two that are wanted the first one finds the pair.
          if (other < own && is_wanted(other)) return false;
          const bool known = alone[i] == TriangleContact::none && alone[other] == TriangleContact::none;
          const TriangleContact contact = slabs.apart(corners_of(other)) ? TriangleContact::none
                                          : known ? contact_between(points, triangles[i], triangles[other])
                                                  : TriangleContact::unknown;
          if (contact == TriangleContact::none) return false;
          found[i / block].push_back({std::min(own, other), std::max(own, other), contact});
          ++found_of[i];
          return false;
        };
        visit_near(set, corners, compare);
      }
    });
  }
  for (auto& of_block : found) std::sort(of_block.begin(), of_block.end());
  std::vector<TrianglePair> all;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  if (!wanted.empty()) std::sort(all.begin(), all.end());
  if (all.size() > most) all.resize(most);
  return all;
}

}  // namespace snug
