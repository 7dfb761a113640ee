#include <snug/search/solid.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

#include <snug/geometry/rounding.h>
#include <snug/mesh/disjoint_sets.h>
#include <snug/patch/evaluate.h>
#include <support/error.h>

namespace snug {
namespace {

// Calls visit(first, second, edge, ways) for each edge of an owner that its first split cuts in two: the
// patches on the first and on the second half of it, whose corners there are 0 and 1, and 1 and 2. `ways` is 1
// if the owner runs from the end of the lesser name to the other one, else -1.
template <class Visit>
void for_each_cut_edge(const LimitSurface& surface, const Visit& visit) {
  for (std::size_t owner = 0; owner < surface.owner_count(); ++owner) {
    const auto [begin, end] = surface.patches_of(owner);
    if (begin == end || !surface.after_first_split(PatchId(begin))) continue;
    for (std::size_t first = begin; first < end; first += 2) {
      const PatchId second(first + 2 < end ? first + 3 : begin + 1);
      const auto names = surface.corner_names(PatchId(first));
      visit(PatchId(first), second, names[1], names[0] < surface.corner_names(second)[2] ? 1 : -1);
    }
  }
}

LimitTriangle make_filler(const LimitSurface& surface, PatchId first, PatchId second) {
  LimitTriangle filler{};
  const auto set = [&](std::size_t place, const Patch& patch, std::size_t corner) {
    const BoundedPoint limit = corner_point(patch, corner).from(patch.origin);
    filler.corners[place] = limit.position;
    filler.error = std::max(filler.error, spatial_error(limit.error));
  };
  const Patch patch = surface.patch(first);
  set(0, patch, 0);
  set(2, patch, 1);
  set(1, surface.patch(second), 2);
  return filler;
}

// The first edge along which faces run more often one way than the other, from the end of the lesser number
// to that of the greater one and back. Twins cancel: all others are tested.
struct OpenEdge {
  HalfEdge first;
  VertexId low, high;
  std::size_t forth = 0, back = 0;
};

std::optional<OpenEdge> first_open_edge(const Topology& topology) {
  std::vector<std::pair<std::uint64_t, HalfEdge>> sides;
  for (HalfEdge h = 0; h < topology.half_edge_count(); ++h) {
    if (topology.twin(h) != no_half_edge) continue;
    const auto [low, high] = std::minmax({topology.from(h), topology.to(h)});
    sides.emplace_back(std::uint64_t{low.value()} << 32 | high.value(), h);
  }
  std::sort(sides.begin(), sides.end());
  std::optional<OpenEdge> found;
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    const HalfEdge h = sides[begin].second;
    const auto [low, high] = std::minmax({topology.from(h), topology.to(h)});
    OpenEdge edge{h, low, high};
    for (; end < sides.size() && sides[end].first == sides[begin].first; ++end) {
      ++(topology.from(sides[end].second) == low ? edge.forth : edge.back);
    }
    if (low == high || edge.forth == edge.back) continue;  // from a vertex to itself: a point
    if (!found || h < found->first) found = edge;
  }
  return found;
}

std::optional<std::size_t> first_hole(const LimitSurface& surface) {
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    if (!surface.has_patch(PatchId(p))) return surface.place(PatchId(p)).owner;
  }
  return {};
}

// A vertex of a face between the ends of an edge, up to some roundings.
std::optional<VertexId> vertex_on(const LimitSurface& surface, VertexId a, VertexId b) {
  const Point3 start = surface.scaled_point(a);
  const Vector3 along = surface.scaled_point(b) - start;
  const double square = length_sq(along);
  for (std::size_t v = 0; v < surface.topology().vertex_count(); ++v) {
    if (VertexId(v) == a || VertexId(v) == b || surface.topology().isolated(VertexId(v))) continue;
    const Vector3 from = surface.scaled_point(VertexId(v)) - start;
    const double t = dot(from, along);
    if (!(t > 0 && t < square)) continue;
    if (length_sq(cross(from, along)) <= 0x1p-80 * square * square) return VertexId(v);
  }
  return {};
}

}  // namespace

std::vector<PatchId> component_patches(const LimitSurface& surface) {
  DisjointSets components(surface.corner_name_count());
  const auto for_each_patch = [&](const auto& visit) {
    for (std::size_t p = 0; p < surface.patch_count(); ++p) {
      if (surface.has_patch(PatchId(p))) visit(PatchId(p), surface.corner_names(PatchId(p)));
    }
  };
  for_each_patch([&](PatchId, const auto& names) {
    for (std::size_t k = 1; k < 3; ++k) components.join(names[0], names[k]);
  });
  std::vector<bool> seen(surface.corner_name_count());
  std::vector<PatchId> patches;
  for_each_patch([&](PatchId p, const auto& names) {
    const std::uint32_t component = components.least(names[0]);
    if (!seen[component]) patches.push_back(p);
    seen[component] = true;
  });
  return patches;
}

bool is_closed(const LimitSurface& surface) {
  return !first_open_edge(surface.topology()) && !first_hole(surface);
}

std::optional<std::string> open_reason(const LimitSurface& surface) {
  const Topology& topology = surface.topology();
  if (const auto edge = first_open_edge(topology)) {
    const auto number = [](auto id) { return std::to_string(id.value()); };
    const auto faces = [](std::size_t n) {
      return std::to_string(n) + (n == 1 ? " face runs" : " faces run");
    };
    const std::string low = number(edge->low), high = number(edge->high),
                      face = number(topology.face_of(edge->first));
    const std::optional<VertexId> between = vertex_on(surface, edge->low, edge->high);
    return "edge (" + low + ", " + high + ") of face " + face + " does not cancel: " + faces(edge->forth) +
           " from " + low + " to " + high + " and " + std::to_string(edge->back) + " back" +
           (between ? "; vertex " + number(*between) + " lies on it" : "");
  }
  if (const auto hole = first_hole(surface)) return "face " + std::to_string(*hole) + " is a hole";
  return {};
}

Solid::Solid(const LimitSurface& surface) {
  if (const auto reason = open_reason(surface)) refuse_open(*reason);
  components_ = component_patches(surface);
  // Where as many sides of an edge are cut that run one way as the other, their fillers cancel.
  std::vector<int> ways(surface.corner_name_count());
  for_each_cut_edge(surface, [&](PatchId, PatchId, std::uint32_t edge, int way) { ways[edge] += way; });
  for_each_cut_edge(surface, [&](PatchId first, PatchId second, std::uint32_t edge, int way) {
    if (ways[edge] * way <= 0) return;
    fillers_.push_back(make_filler(surface, first, second));
    ways[edge] -= way;
  });
  if (fillers_.empty()) return;
  std::vector<Point3> centres;
  centres.reserve(fillers_.size());
  for (const LimitTriangle& filler : fillers_) centres.push_back(filler.corners[2]);
  tree_ = std::make_unique<WideBvh>(
      centres, 1, [&](std::size_t, std::span<const std::uint32_t> items, std::vector<Obb>& boxes) {
        std::vector<OffsetTriangle> triangles;
        std::vector<Point3> spread;
        for (const std::uint32_t i : items) {
          triangles.push_back({fillers_[i].corners, fillers_[i].error});
          spread.insert(spread.end(), fillers_[i].corners.begin(), fillers_[i].corners.end());
        }
        boxes.push_back(box_around(principal_axes(spread), triangles));
      });
}

}  // namespace snug
