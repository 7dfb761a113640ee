#include <snug/search/self_contact.h>

#include <algorithm>

#include <snug/geometry/nearest_to_origin.h>
#include <snug/geometry/rounding.h>
#include <snug/geometry/triangle_distance.h>
#include <snug/search/feet.h>
#include <snug/search/piece.h>
#include <support/direction.h>
#include <support/parallel.h>

namespace snug {
namespace {

using Names = std::array<std::uint32_t, 3>;

// Directions from a common vertex are compared with a plane through it; products of unit vectors err by less.
constexpr double min_height = 0x1p-40;
// Of a triangle with later ones: bounds the memory where everything meets everything.
constexpr int max_of_one = 16;

// Is there a plane through a vertex with two triangles on different sides of it?
bool parted_at(const Point3& vertex, const std::array<Point3, 2>& a, const std::array<Point3, 2>& b) {
  const std::array<Vector3, 4> rays{normalized(a[0] - vertex), normalized(a[1] - vertex),
                                    -normalized(b[0] - vertex), -normalized(b[1] - vertex)};
  const Vector3 w = normalized(nearest_to_origin(rays));
  return std::all_of(rays.begin(), rays.end(), [&](const Vector3& r) { return dot(w, r) > min_height; });
}

// Do two triangles on an edge have an angle between them?
bool parted_along(const Point3& from, const Point3& to, const Point3& a, const Point3& b) {
  const Vector3 edge = normalized(to - from);
  double rounding = min_height;
  std::array<Vector3, 2> across;
  for (std::size_t i = 0; i < 2; ++i) {
    const Vector3 d = (i == 0 ? a : b) - from;
    const Vector3 own = d - dot(d, edge) * edge;
    // A component across the edge that is mostly rounding is no direction.
    if (edge == Vector3{} || !(length(own) > min_height * length(d))) return false;
    across[i] = normalized(own);
    rounding += 64 * unit_roundoff * length(d) / length(own);
  }
  return dot(across[0], across[1]) < 0 || length(cross(across[0], across[1])) > rounding;
}

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

bool may_touch(std::span<const Point3> points, const Names& a, const Names& b) {
  std::array<std::size_t, 3> in_a{}, in_b{};
  std::size_t common = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (a[i] != b[j]) continue;
      if (common == 3) return true;
      in_a[common] = i;
      in_b[common] = j;
      ++common;
    }
  }
  if (common == 0) {
    const Triangle x{points[a[0]], points[a[1]], points[a[2]]}, y{points[b[0]], points[b[1]], points[b[2]]};
    return !(nearest(x, y).certain_distance > 0);
  }
  if (common == 1) {
    const std::size_t i = in_a[0], j = in_b[0];
    return !parted_at(points[a[i]], {points[a[(i + 1) % 3]], points[a[(i + 2) % 3]]},
                      {points[b[(j + 1) % 3]], points[b[(j + 2) % 3]]});
  }
  if (common == 2) {
    return !parted_along(points[a[in_a[0]]], points[a[in_a[1]]], points[a[3 - in_a[0] - in_a[1]]],
                         points[b[3 - in_b[0] - in_b[1]]]);
  }
  return true;
}

}  // namespace

std::vector<std::pair<std::uint32_t, std::uint32_t>> self_contacts(std::span<const Point3> points,
                                                                   std::span<const Names> triangles,
                                                                   std::size_t most, int threads,
                                                                   const WorkMonitor& monitor) {
  if (triangles.empty()) return {};
  std::vector<QuadraticTriangle> flat;
  flat.reserve(triangles.size());
  for (const Names& t : triangles) flat.push_back(flat_quadratic({points[t[0]], points[t[1]], points[t[2]]}));
  PieceSet set(std::move(flat));
  set.prepare(threads);
  constexpr std::size_t block = 1024;
  std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> found((triangles.size() + block - 1) /
                                                                          block);
  parallel_for(found.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      monitor.checkpoint();
      for (std::size_t i = b * block; i < std::min(triangles.size(), (b + 1) * block); ++i) {
        int of_this = 0;
        const Slabs slabs(set[i].corners);
        for_each_near(set, set[i], [&](std::uint32_t other) {
          if (other <= i || of_this == max_of_one || slabs.apart(set[other].corners)) return;
          if (may_touch(points, triangles[i], triangles[other])) {
            found[b].emplace_back(static_cast<std::uint32_t>(i), other);
            ++of_this;
          }
        });
      }
      std::sort(found[b].begin(), found[b].end());
    }
  });
  std::vector<std::pair<std::uint32_t, std::uint32_t>> all;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  if (all.size() > most) all.resize(most);
  return all;
}

}  // namespace snug
