#include <snug/inspect.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <utility>

#include <snug/bounds/fit_kernels.h>
#include <snug/bvh/box_tree.h>
#include <snug/mesh/control_mesh.h>
#include <snug/mesh/disjoint_sets.h>
#include <snug/mesh/half_edges.h>
#include <snug/mesh/loose_creases.h>
#include <snug/mesh/weld.h>
#include <snug/query/nesting.h>
#include <snug/scheme/rules.h>
#include <snug/search/surface_data.h>
#include <support/error.h>
#include <support/run.h>

namespace snug {
namespace {

using Edge = std::pair<VertexId, VertexId>;

constexpr double needle_ratio = 100;

bool has_vertices_of(const ControlMesh& mesh, std::span<const VertexId> face) {
  return std::all_of(face.begin(), face.end(), [&](VertexId v) { return v.index() < mesh.vertex_count(); });
}

// The mesh without faces that have no vertices or name such as it does not have, and without anything else but faces.
ControlMesh sound_faces(const ControlMesh& mesh) {
  ControlMesh sound;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(FaceId(f));
    if (!face.empty() && has_vertices_of(mesh, face)) sound.add_face(face);
  }
  return sound;
}

using Box = std::array<Point3, 2>;

// The boxes around the components: of the vertices of faces that are joined.
std::vector<Box> component_boxes(const ControlMesh& faces, const std::vector<Point3>& points) {
  DisjointSets joined(points.size());
  for (std::size_t f = 0; f < faces.face_count(); ++f) {
    const auto face = faces.face(FaceId(f));
    for (const VertexId v : face) joined.join(v.value(), face[0].value());
  }
  constexpr std::uint32_t none = UINT32_MAX;
  std::vector<std::uint32_t> place(points.size(), none);
  std::vector<Box> boxes;
  for (const VertexId v : faces.face_vertices) {
    const Point3& p = points[v.index()];
    std::uint32_t& own = place[joined.least(v.value())];
    if (own == none) {
      own = static_cast<std::uint32_t>(boxes.size());
      boxes.push_back({p, p});
    }
    auto& [lower, upper] = boxes[own];
    for (std::size_t a = 0; a < 3; ++a) {
      lower[a] = std::min(lower[a], p[a]);
      upper[a] = std::max(upper[a], p[a]);
    }
  }
  return boxes;
}

// Each with those that begin, along x, before it ends.
bool any_meet(std::vector<Box> boxes) {
  std::erase_if(boxes, [](const Box& box) { return !is_finite(box[0]) || !is_finite(box[1]); });
  std::sort(boxes.begin(), boxes.end(), [](const Box& a, const Box& b) { return a[0].x < b[0].x; });
  const auto meet = [](const Box& a, const Box& b) {
    return a[0].y <= b[1].y && b[0].y <= a[1].y && a[0].z <= b[1].z && b[0].z <= a[1].z;
  };
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t j = i + 1; j < boxes.size() && boxes[j][0].x <= boxes[i][1].x; ++j) {
      if (meet(boxes[i], boxes[j])) return true;
    }
  }
  return false;
}

// Ends of an edge.
Edge ends_of(const ControlMesh& mesh, const HalfEdgeGroups& groups, EdgeId e) {
  const HalfEdge h = groups.of_edge(e)[0];
  return {mesh.face_vertices[h], mesh.face_vertices[next_in_face(mesh.face_offsets, groups.face(h), h)]};
}

// Certainly true if no edge has one face and edges of two have them turned alike, but for one chance in
// 2^64: a sum over directed edges that opposite ones take out of it.
bool looks_closed(const ControlMesh& mesh) {
  std::uint64_t sum = 0;
  const auto mixed = [](VertexId a, VertexId b) {
    std::uint64_t x = (std::uint64_t{a.value()} << 32 | b.value()) * 0x9e3779b97f4a7c15u;
    x = (x ^ x >> 32) * 0xbf58476d1ce4e5b9u;
    return x ^ x >> 29;
  };
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(FaceId(f));
    for (std::size_t k = 0; k < face.size(); ++k) {
      const VertexId a = face[k], b = face[k + 1 == face.size() ? 0 : k + 1];
      sum += mixed(a, b) - mixed(b, a);
    }
  }
  return sum == 0;
}

std::vector<Edge> boundary_edges(const ControlMesh& mesh) {
  const HalfEdgeGroups groups(mesh.face_offsets, mesh.face_vertices, mesh.vertex_count());
  std::vector<Edge> edges;
  for (std::size_t e = 0; e < groups.edge_count(); ++e) {
    if (groups.of_edge(EdgeId(e)).size() == 1) edges.push_back(ends_of(mesh, groups, EdgeId(e)));
  }
  return edges;
}

// For each used vertex the first that stands where it does.
std::vector<VertexId> first_in_place(const ControlMesh& mesh, const std::vector<bool>& used) {
  std::vector<VertexId> vertices;
  std::vector<Point3> points;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;
    vertices.emplace_back(v);
    points.push_back(mesh.points[v]);
  }
  const std::vector<std::uint32_t> first = first_of_welded(points);
  std::vector<VertexId> places(used.size());
  for (std::size_t k = 0; k < first.size(); ++k) places[vertices[k].index()] = vertices[first[k]];
  return places;
}

std::size_t count_coincident(const std::vector<Edge>& boundary, const std::vector<VertexId>& places) {
  std::vector<Edge> edges;
  for (const auto& [a, b] : boundary) {
    edges.emplace_back(std::minmax({places[a.index()], places[b.index()]}));
  }
  std::sort(edges.begin(), edges.end());
  std::size_t count = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    count += (i > 0 && edges[i] == edges[i - 1]) || (i + 1 < edges.size() && edges[i] == edges[i + 1]);
  }
  return count;
}

// Places that stand within reach of an edge, and farther from its ends. `size` is the longest side of the box around all.
std::size_t count_on_edges(const std::vector<Point3>& places, const ControlMesh& mesh,
                           const std::vector<Edge>& boundary, double size, double reach) {
  if (boundary.empty()) return 0;
  std::vector<Box3> boxes{Box3{}};  // the tree finds items above one of them
  for (const Point3& p : places) boxes.emplace_back().add(p);
  boxes[0] = boxes[1];
  const BoxTree tree(boxes);
  const auto is_on = [&](const Point3& p, const Edge& edge) {
    const Point3 &a = mesh.points[edge.first.index()], &b = mesh.points[edge.second.index()];
    const Vector3 along = b - a, from = p - a;
    const double square = dot(along, along), t = dot(from, along) / square;
    if (!(square > 0) || !(t > 0 && t < 1)) return false;
    const double long_side = std::sqrt(square);
    return length(from - t * along) <= reach && std::min(t, 1 - t) * long_side > reach;
  };
  // The box of a long edge may hold most places, those of its parts few.
  const double part = size / std::cbrt(static_cast<double>(places.size()));
  std::vector<bool> counted(boxes.size(), false);
  for (const Edge& edge : boundary) {
    const Point3& start = mesh.points[edge.first.index()];
    const Vector3 along = mesh.points[edge.second.index()] - start;
    const double parts = std::clamp(std::ceil(max_abs(along) / part), 1.0, 64.0);
    for (double i = 0; i < parts; ++i) {
      Box3 box;
      box.add(start + i / parts * along);
      box.add(start + (i + 1) / parts * along);
      tree.find_near(box, 2 * reach, 0, [&](std::uint32_t item) {
        counted[item] = counted[item] || is_on(places[item - 1], edge);
      });
    }
  }
  return static_cast<std::size_t>(std::count(counted.begin(), counted.end(), true));
}

void find_near_vertices(const ControlMesh& mesh, const std::vector<Edge>& boundary,
                        const std::vector<VertexId>& places, Coincidences& found) {
  std::vector<Point3> points;  // one a place
  std::vector<bool> added(mesh.vertex_count(), false);
  for (const auto& [a, b] : boundary) {
    for (const VertexId v : {a, b}) {
      const std::size_t place = places[v.index()].index();
      if (!added[place]) points.push_back(mesh.points[v.index()]);
      added[place] = true;
    }
  }
  const std::vector<std::uint32_t> first = first_of_welded(points, found.reach);
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (first[p] == p) continue;
    const Vector3 between = points[p] - points[first[p]];
    const double apart = std::hypot(between.x, between.y, between.z);
    found.nearest = found.near == 0 ? apart : std::min(found.nearest, apart);
    found.farthest = std::max(found.farthest, apart);
    ++found.near;
  }
  found.on_edges = count_on_edges(points, mesh, boundary, 0x1p17 * found.reach, found.reach);
}

// Is the face long beside its area? Of no area counts as not.
bool is_needle(const ControlMesh& mesh, std::span<const VertexId> face) {
  Vector3 area{};
  double longest = 0;
  const Point3& first = mesh.points[face[0].index()];
  for (std::size_t k = 0; k < face.size(); ++k) {
    const Point3 &a = mesh.points[face[k].index()], &b = mesh.points[face[(k + 1) % face.size()].index()];
    area = area + cross(a - first, b - first);
    longest = std::max(longest, length(b - a));
  }
  const double twice = length(area);
  return twice > 0 && twice / longest < longest / needle_ratio;
}

}  // namespace

bool scheme_answers(Scheme scheme, DefectKind kind) { return rules_of(scheme).answers(kind); }

MeshCounts count_elements(const ControlMesh& mesh, Scheme scheme) {
  const SchemeTraits& traits = traits_of(scheme);
  const ControlMesh faces = sound_faces(mesh);
  const HalfEdgeGroups groups(faces.face_offsets, faces.face_vertices, mesh.vertex_count());
  MeshCounts result;
  result.edges = groups.edge_count();
  const std::vector<Box> boxes = component_boxes(faces, mesh.points);
  result.components = boxes.size();
  result.boxes_meet = any_meet(boxes);
  std::vector<std::uint32_t> valence(mesh.vertex_count(), 0);
  std::vector<bool> boundary(mesh.vertex_count(), false);
  DisjointSets borders(mesh.vertex_count());
  result.closed = groups.edge_count() > 0;
  for (std::size_t e = 0; e < groups.edge_count(); ++e) {
    const auto sides = groups.of_edge(EdgeId(e));
    const std::size_t members = sides.size();
    const auto [a, b] = ends_of(faces, groups, EdgeId(e));
    const auto forth = std::count_if(sides.begin(), sides.end(),
                                     [&, start = a](HalfEdge h) { return faces.face_vertices[h] == start; });
    ++valence[a.index()];
    ++valence[b.index()];
    result.many_sided_edges += members > 2;
    result.closed = result.closed && (a == b || 2 * static_cast<std::size_t>(forth) == members);
    if (members == 1) {
      ++result.boundary_edges;
      boundary[a.index()] = boundary[b.index()] = true;
      borders.join(a.value(), b.value());
    }
  }
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    if (valence[v] == 0) continue;
    const std::size_t n = valence[v];
    result.min_valence = result.used_vertices++ == 0 ? n : std::min(result.min_valence, n);
    result.max_valence = std::max(result.max_valence, n);
    const std::size_t regular = boundary[v] ? traits.regular_valence / 2 + 1 : traits.regular_valence;
    result.extraordinary += !traits.dual && n != regular;
  }
  for (std::size_t f = 0; traits.dual && f < mesh.face_count(); ++f)
    result.extraordinary += mesh.face(FaceId(f)).size() != traits.regular_valence;
  result.creases = mesh.tags.creases.size() - loose_creases(mesh).size();
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    result.borders += boundary[v] && borders.least(static_cast<std::uint32_t>(v)) == v;
  for (std::size_t f = 0; f < faces.face_count(); ++f)
    result.needles += is_needle(mesh, faces.face(FaceId(f)));
  return result;
}

Coincidences coincidences(const ControlMesh& mesh) {
  Coincidences found;
  std::vector<bool> used(mesh.vertex_count(), false);
  double largest = 0;
  for (const VertexId v : mesh.face_vertices) {
    if (v.index() >= mesh.vertex_count() || !is_finite(mesh.points[v.index()])) return found;
    used[v.index()] = true;
    largest = std::max(largest, max_abs(mesh.points[v.index()] - Point3{}));
  }
  const std::vector<VertexId> places = first_in_place(mesh, used);
  std::vector<bool> shared(mesh.vertex_count(), false);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    if (!used[v] || places[v] == VertexId(v)) continue;
    const std::size_t place = places[v].index();
    found.vertices += shared[place] ? 1 : 2;
    found.places += !shared[place];
    shared[place] = true;
  }
  found.reach = 0x1p-17 * longest_side(used_box(mesh));
  const bool reaches =
      found.reach >= std::ldexp(largest, -40) && found.reach > DBL_MIN && std::isfinite(found.reach);
  if (looks_closed(mesh)) return found;
  const std::vector<Edge> boundary = boundary_edges(mesh);
  if (found.vertices > 0) found.edges = count_coincident(boundary, places);
  if (reaches) find_near_vertices(mesh, boundary, places, found);
  return found;
}

std::optional<std::uint32_t> overlapping_shell(const Surface& surface, const Run& run) {
  const std::optional<PatchId> patch = wound_twice(surface.data()->bvh(monitor_of(run)), monitor_of(run));
  return patch ? std::optional(surface.data()->limit().place(*patch).owner) : std::nullopt;
}

std::optional<std::uint32_t> topology_of(const Surface& surface, const PatchPlace& patch) {
  const LimitSurface& limit = surface.data()->limit();
  const auto known = [&] {
    if (patch.owner >= limit.owner_count()) return false;
    const LimitSurface::PatchRange range = limit.patches_of(patch.owner);
    return patch.part < range.end - range.begin && limit.has_patch(PatchId(range.begin + patch.part));
  };
  require_value(known(), "topology_of: the surface has no such patch");
  const Kind& kind = limit.kind(PatchId(limit.patches_of(patch.owner).begin + patch.part));
  return kind.polynomial() ? std::nullopt : std::optional(kind.id().value());
}

const char* instruction_set() { return kernels::instruction_set(); }

}  // namespace snug
