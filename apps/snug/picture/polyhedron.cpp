#include <picture/polyhedron.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <support/error.h>

namespace snug {
namespace {

// Lattice coordinates are at most 2^41 apart: determinants of three differences stay below 2^126.
constexpr int lattice_bits = 41;
__extension__ using Wide = __int128;

using Index = std::uint32_t;
using HullEdge = std::pair<Index, Index>;

struct Difference {
  std::int64_t x, y, z;
};

struct WideVector {
  std::array<Wide, 3> at;
};

WideVector cross(const Difference& a, const Difference& b) {
  return {{Wide{a.y} * b.z - Wide{a.z} * b.y, Wide{a.z} * b.x - Wide{a.x} * b.z,
           Wide{a.x} * b.y - Wide{a.y} * b.x}};
}

bool is_zero(const WideVector& v) { return v.at[0] == 0 && v.at[1] == 0 && v.at[2] == 0; }
Wide magnitude(Wide a) { return a < 0 ? -a : a; }

struct LatticePoint {
  std::array<std::int64_t, 3> at;
  Point3 place;  // the same in the boxes' coordinates
};

Difference operator-(const LatticePoint& a, const LatticePoint& b) {
  return {a.at[0] - b.at[0], a.at[1] - b.at[1], a.at[2] - b.at[2]};
}

std::vector<LatticePoint> lattice_corners(const IntervalTriangle& triangle) {
  Box3 all;
  for (const Box3& box : triangle.corner) {
    require_value(is_finite(box.lower) && is_finite(box.upper), "hull of boxes: a corner is not finite");
    require_value(box.lower.x <= box.upper.x && box.lower.y <= box.upper.y && box.lower.z <= box.upper.z,
                  "hull of boxes: a box is empty");
    all.add(box);
  }
  const double size = longest_side(all);
  require_value(std::isfinite(size), "hull of boxes: its longest side does not fit a double");
  int exponent = 0;
  std::frexp(size, &exponent);
  const int step = exponent - lattice_bits;  // size <= 2^lattice_bits steps of 2^step
  const auto in_steps = [step](double x) { return std::nearbyint(std::ldexp(x, -step)); };
  std::vector<LatticePoint> corners;
  for (const Box3& box : triangle.corner) {
    for (unsigned i = 0; i < 8; ++i) {
      LatticePoint corner{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double x = (i >> axis) & 1 ? box.upper[axis] : box.lower[axis];
        if (all.lower[axis] < all.upper[axis]) {  // otherwise x may overflow in steps
          // Differences of integers below 2^42: exact, however large the integers themselves.
          corner.at[axis] = static_cast<std::int64_t>(in_steps(x) - in_steps(all.lower[axis]));
          corner.place[axis] = std::ldexp(in_steps(x), step);
        } else {
          corner.place[axis] = x;
        }
      }
      corners.push_back(corner);
    }
  }
  const auto before = [](const LatticePoint& a, const LatticePoint& b) { return a.at < b.at; };
  const auto same = [](const LatticePoint& a, const LatticePoint& b) { return a.at == b.at; };
  std::sort(corners.begin(), corners.end(), before);
  corners.erase(std::unique(corners.begin(), corners.end(), same), corners.end());
  return corners;
}

class GiftWrapping {
 public:
  explicit GiftWrapping(std::vector<LatticePoint> points) : points_(std::move(points)) {}
  [[nodiscard]] Polyhedron hull();

 private:
  using Facet = std::vector<Index>;

  [[nodiscard]] WideVector normal(Index a, Index b, Index c) const {
    return cross(points_[b] - points_[a], points_[c] - points_[a]);
  }
  // Height of p above the plane through a with this normal, times the normal's length.
  [[nodiscard]] Wide height(const WideVector& n, Index a, Index p) const {
    const Difference d = points_[p] - points_[a];
    return n.at[0] * d.x + n.at[1] * d.y + n.at[2] * d.z;
  }
  [[nodiscard]] Facet in_plane(const WideVector& n, Index a) const;
  [[nodiscard]] bool first_facet(WideVector& n) const;
  [[nodiscard]] Facet facet_beyond(const HullEdge& edge) const;
  [[nodiscard]] Polyhedron compact(std::vector<Facet> facets) const;

  std::vector<LatticePoint> points_;
};

// The points in the plane of a facet with outward normal n through a: the corners of their convex hull,
// counter-clockwise from outside. Monotone chains in the coordinate plane that the facet is most parallel to.
GiftWrapping::Facet GiftWrapping::in_plane(const WideVector& n, Index a) const {
  std::size_t dropped = 0;
  for (std::size_t axis = 1; axis < 3; ++axis) {
    if (magnitude(n.at[axis]) > magnitude(n.at[dropped])) dropped = axis;
  }
  const std::size_t first = (dropped + 1) % 3, second = (dropped + 2) % 3;
  const auto coordinates = [&](Index p) { return std::pair(points_[p].at[first], points_[p].at[second]); };
  const auto turns_left = [&](Index p, Index q, Index r) {
    const auto [px, py] = coordinates(p);
    const auto [qx, qy] = coordinates(q);
    const auto [rx, ry] = coordinates(r);
    return Wide{qx - px} * (ry - py) > Wide{qy - py} * (rx - px);
  };
  std::vector<Index> members;
  for (Index p = 0; p < points_.size(); ++p) {
    if (height(n, a, p) == 0) members.push_back(p);
  }
  std::sort(members.begin(), members.end(),
            [&](Index p, Index q) { return coordinates(p) < coordinates(q); });
  Facet chain;
  const auto extend = [&](std::size_t fixed, Index p) {
    while (chain.size() >= fixed + 2 && !turns_left(chain[chain.size() - 2], chain.back(), p))
      chain.pop_back();
    chain.push_back(p);
  };
  for (const Index p : members) extend(0, p);
  const std::size_t lower = chain.size() - 1;
  for (std::size_t i = members.size() - 1; i-- > 0;) extend(lower, members[i]);
  chain.pop_back();
  if (n.at[dropped] < 0) std::reverse(chain.begin(), chain.end());
  return chain;
}

// Outward normal of a facet through point 0, which is a corner of the hull since it is the first in
// lexicographic order. False if all the points lie on a line.
bool GiftWrapping::first_facet(WideVector& n) const {
  for (Index b = 1; b < points_.size(); ++b) {
    for (Index c = 1; c < points_.size(); ++c) {
      n = normal(0, b, c);
      if (is_zero(n)) continue;
      bool outside = false;
      for (Index p = 1; p < points_.size() && !outside; ++p) outside = height(n, 0, p) > 0;
      if (!outside) return true;
    }
  }
  return false;
}

// The facet to the left of an edge of the hull: the plane through the edge is turned outwards until it leaves
// no point out.
GiftWrapping::Facet GiftWrapping::facet_beyond(const HullEdge& edge) const {
  WideVector n{};
  for (Index p = 0; p < points_.size(); ++p) {
    if (!is_zero(n) && height(n, edge.first, p) <= 0) continue;
    const WideVector turned = normal(edge.first, edge.second, p);
    if (!is_zero(turned)) n = turned;
  }
  return in_plane(n, edge.first);
}

Polyhedron GiftWrapping::compact(std::vector<Facet> facets) const {
  Polyhedron result;
  std::vector<Index> number(points_.size(), UINT32_MAX);
  for (Facet& facet : facets) {
    for (Index& corner : facet) {
      Index& known = number[corner];
      if (known == UINT32_MAX) {
        known = static_cast<Index>(result.points.size());
        result.points.push_back(points_[corner].place);
      }
      corner = known;
    }
  }
  result.facets = std::move(facets);
  return result;
}

Polyhedron GiftWrapping::hull() {
  WideVector n{};
  if (!first_facet(n)) {
    Polyhedron ends;
    ends.points.push_back(points_.front().place);
    if (points_.size() > 1) ends.points.push_back(points_.back().place);
    return ends;
  }
  std::vector<Facet> facets{in_plane(n, 0)};
  const auto flat = [&] {
    for (Index p = 0; p < points_.size(); ++p) {
      if (height(n, 0, p) != 0) return false;
    }
    return true;
  };
  if (flat()) {
    facets.emplace_back(facets[0].rbegin(), facets[0].rend());
    return compact(std::move(facets));
  }
  // Half-edges of facets found, and those whose facet is still missing.
  const std::size_t count = points_.size();
  std::vector<bool> bordered(count * count, false);
  std::vector<HullEdge> open;
  const auto enter = [&](const Facet& facet) {
    for (std::size_t i = 0; i < facet.size(); ++i) {
      const Index from = facet[i], to = facet[(i + 1) % facet.size()];
      bordered[from * count + to] = true;
      open.emplace_back(to, from);
    }
  };
  enter(facets[0]);
  while (!open.empty()) {
    const HullEdge edge = open.back();
    open.pop_back();
    if (bordered[edge.first * count + edge.second]) continue;
    facets.push_back(facet_beyond(edge));
    enter(facets.back());
  }
  return compact(std::move(facets));
}

}  // namespace

Polyhedron hull_of_boxes(const IntervalTriangle& triangle) {
  return GiftWrapping(lattice_corners(triangle)).hull();
}

}  // namespace snug
