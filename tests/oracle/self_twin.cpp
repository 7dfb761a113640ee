#include <oracle/self_twin.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

namespace oracle {
namespace {

using Real = long double;
using Vec = std::array<Real, 3>;

Vec minus(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec cross(const Vec& a, const Vec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Real dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Real length(const Vec& a) { return std::sqrt(dot(a, a)); }

bool passes(const Vec& from, const Vec& to, const std::array<Vec, 3>& t, Real margin) {
  const Vec normal = cross(minus(t[1], t[0]), minus(t[2], t[0]));
  const Real size = length(normal);
  if (size < 1e-14L) return false;
  const Real a = dot(normal, minus(from, t[0])) / size, b = dot(normal, minus(to, t[0])) / size;
  if (!((a > margin && b < -margin) || (a < -margin && b > margin))) return false;
  Vec at;
  for (std::size_t k = 0; k < 3; ++k) at[k] = from[k] + a / (a - b) * (to[k] - from[k]);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec edge = minus(t[(k + 1) % 3], t[k]);
    if (dot(cross(normal, edge), minus(at, t[k])) / (size * length(edge)) <= margin) return false;
  }
  return true;
}

// With a margin of `least`, and of a share of the longest edge of the smaller one of two triangles.
std::optional<std::pair<std::size_t, std::size_t>> crossing_pair(
    std::span<const std::array<double, 3>> points, std::span<const std::array<std::uint32_t, 3>> triangles,
    double least, double share) {
  // Boxes and numbers of triangles, in the order of their first coordinates.
  struct Item {
    std::array<double, 3> low, high;
    std::size_t index;
  };
  std::vector<Item> items;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    Item item{{}, {}, i};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::tie(item.low[axis], item.high[axis]) = std::minmax(
          {points[triangles[i][0]][axis], points[triangles[i][1]][axis], points[triangles[i][2]][axis]});
    }
    items.push_back(item);
  }
  std::sort(items.begin(), items.end(), [](const Item& a, const Item& b) { return a.low[0] < b.low[0]; });
  const auto corners = [&](const Item& item) {
    std::array<Vec, 3> all;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& p = points[triangles[item.index][k]];
      all[k] = {p[0], p[1], p[2]};
    }
    return all;
  };
  const auto longest = [](const std::array<Vec, 3>& t) {
    return std::max({length(minus(t[0], t[1])), length(minus(t[1], t[2])), length(minus(t[2], t[0]))});
  };
  for (std::size_t i = 0; i < items.size(); ++i) {
    const Item& a = items[i];
    const auto& x = triangles[a.index];
    for (std::size_t j = i + 1; j < items.size() && items[j].low[0] <= a.high[0]; ++j) {
      const Item& b = items[j];
      if (a.low[1] > b.high[1] || b.low[1] > a.high[1] || a.low[2] > b.high[2] || b.low[2] > a.high[2])
        continue;
      const auto& y = triangles[b.index];
      if (std::any_of(x.begin(), x.end(),
                      [&](auto v) { return std::find(y.begin(), y.end(), v) != y.end(); }))
        continue;
      const std::array<Vec, 3> s = corners(a), t = corners(b);
      const Real margin = least + share * std::min(longest(s), longest(t));
      for (std::size_t k = 0; k < 3; ++k) {
        if (passes(s[k], s[(k + 1) % 3], t, margin) || passes(t[k], t[(k + 1) % 3], s, margin)) {
          return std::pair(a.index, b.index);
        }
      }
    }
  }
  return std::nullopt;
}

// ---- Near a place ----

struct Box {
  Point low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
  void add(const Point& p) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  [[nodiscard]] double diagonal() const {
    return std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
  }
  [[nodiscard]] bool is_within(double reach, const Point& p) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (p[k] < low[k] - reach || p[k] > high[k] + reach) return false;
    }
    return true;
  }
};

std::vector<Box> boxes_of(const TaggedMesh& mesh) {
  std::vector<Box> boxes;
  for (const auto& face : mesh.polygons) {
    Box& box = boxes.emplace_back();
    for (const std::uint32_t v : face) box.add(mesh.points[v]);
  }
  return boxes;
}

TaggedMesh one_step(const TaggedMesh& mesh, const WindingScheme& scheme) {
  if (const Rules* const rules = std::get_if<Rules>(&scheme)) return refine(mesh, *rules, 1);
  return refine_dual(mesh, std::get<DualScheme>(scheme), 1);
}

// A mesh, and which of its vertices refine otherwise than those of the whole.
struct Region {
  TaggedMesh mesh;
  std::vector<bool> marked;
};

// Weights are not negative but for semi-sharp ones under Chaikin's rule: a child of a marked point moves when this does.
Region refined(const Region& region, const WindingScheme& scheme) {
  TaggedMesh marks = region.mesh;
  for (std::size_t v = 0; v < marks.points.size(); ++v)
    marks.points[v] = {region.marked[v] ? 1.0 : 0.0, 0, 0};
  Region fine{one_step(region.mesh, scheme), {}};
  for (const Point& p : one_step(marks, scheme).points) fine.marked.push_back(p[0] != 0);
  return fine;
}

// The faces within `reach` of the place, and three rings of others.
Region cropped(const Region& region, const std::vector<Box>& boxes, const Point& place, double reach) {
  const TaggedMesh& mesh = region.mesh;
  std::vector<bool> is_kept(boxes.size());
  std::transform(boxes.begin(), boxes.end(), is_kept.begin(),
                 [&](const Box& box) { return box.is_within(reach, place); });
  std::vector<bool> touched(mesh.points.size());
  for (int ring = 0; ring < 3; ++ring) {
    for (std::size_t f = 0; f < boxes.size(); ++f) {
      for (const std::uint32_t v : mesh.polygons[f]) touched[v] = touched[v] || is_kept[f];
    }
    for (std::size_t f = 0; f < boxes.size(); ++f) {
      const auto& face = mesh.polygons[f];
      is_kept[f] = std::any_of(face.begin(), face.end(), [&](std::uint32_t v) { return touched[v]; });
    }
  }
  constexpr std::uint32_t none = UINT32_MAX;
  std::vector<std::uint32_t> names(mesh.points.size(), none);
  Region part;
  for (std::size_t f = 0; f < boxes.size(); ++f) {
    if (!is_kept[f]) continue;
    std::vector<std::uint32_t>& face = part.mesh.polygons.emplace_back(mesh.polygons[f]);
    for (std::uint32_t& v : face) {
      if (names[v] == none) {
        names[v] = static_cast<std::uint32_t>(part.mesh.points.size());
        part.mesh.points.push_back(mesh.points[v]);
        part.marked.push_back(region.marked[v]);
      }
      v = names[v];
    }
  }
  for (std::size_t f = 0; f < boxes.size(); ++f) {
    for (const std::uint32_t v : mesh.polygons[f]) {
      if (!is_kept[f] && names[v] != none) part.marked[names[v]] = true;
    }
  }
  for (const TaggedMesh::Crease& c : mesh.creases) {
    if (names[c.a] != none && names[c.b] != none)
      part.mesh.creases.push_back({names[c.a], names[c.b], c.sharpness});
  }
  for (const TaggedMesh::Corner& c : mesh.corners) {
    if (names[c.vertex] != none) part.mesh.corners.push_back({names[c.vertex], c.sharpness});
  }
  return part;
}

bool crosses_itself(const Region& region, double share) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const auto& face : region.mesh.polygons) {
    if (std::any_of(face.begin(), face.end(), [&](std::uint32_t v) { return region.marked[v]; })) continue;
    for (std::size_t k = 2; k < face.size(); ++k) triangles.push_back({face[0], face[k - 1], face[k]});
  }
  return crossing_pair(region.mesh.points, triangles, 0, share).has_value();
}

}  // namespace

bool crosses_near(TaggedMesh mesh, const WindingScheme& scheme, const Point& place, double within) {
  // Faces at high valences shrink by less than a half.
  constexpr double faces_around = 2;
  constexpr int whole = 2, small = 7, last = 18;
  constexpr std::ptrdiff_t most_faces = 4000;
  const std::vector<bool> none(mesh.points.size());
  Region region{std::move(mesh), none};
  double reach = INFINITY, around = INFINITY;
  for (int level = 1; level <= last && around > within / 8; ++level) {
    region = refined(region, scheme);
    if (level < whole) continue;
    const std::vector<Box> boxes = boxes_of(region.mesh);
    around = 0;
    for (const Box& box : boxes) {
      if (level == whole || box.is_within(box.diagonal(), place)) around = std::max(around, box.diagonal());
    }
    reach = std::max({std::min(reach / 2, 4 * faces_around * around), faces_around * around, within});
    // Where faces around the place are much larger than those at it.
    const auto is_near = [&](const Box& box) { return box.is_within(reach, place); };
    while (reach > within && std::count_if(boxes.begin(), boxes.end(), is_near) > most_faces)
      reach = std::max(reach / 2, within);
    region = cropped(region, boxes, place, reach);
    if (level >= small && crosses_itself(region, std::ldexp(0x1p-10, small - level))) return true;
  }
  return false;
}

std::optional<std::pair<std::size_t, std::size_t>> crossing_triangles(
    std::span<const std::array<double, 3>> points, std::span<const std::array<std::uint32_t, 3>> triangles,
    double margin) {
  return crossing_pair(points, triangles, margin, 0);
}

}  // namespace oracle
