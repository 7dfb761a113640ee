#include <snug/mesh/weld.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cfloat>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include <snug/base/error.h>
#include <snug/mesh/half_edges.h>

namespace snug {
namespace {

using Key = std::array<std::int64_t, 3>;

/// The first point of each place, found by its coordinates.
class Places {
 public:
  explicit Places(std::span<const Point3> points)
      : points_(points), slots_(std::bit_ceil(2 * points.size() + 1), no_point) {}

  /// The first of the points asked for so far that stands where p stands.
  std::uint32_t first_like(std::uint32_t p) {
    for (std::size_t slot = hash(points_[p]);; ++slot) {
      std::uint32_t& held = slots_[slot & (slots_.size() - 1)];
      if (held == no_point) held = p;
      if (points_[held] == points_[p]) return held;
    }
  }

 private:
  static constexpr std::uint32_t no_point = UINT32_MAX;

  static std::size_t hash(const Point3& point) {
    std::uint64_t mixed = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      mixed ^= std::bit_cast<std::uint64_t>(point[axis] + 0.0);  // -0 and 0 are one place
      mixed *= 0x9e3779b97f4a7c15u;
      mixed ^= mixed >> 32;
    }
    return mixed;
  }

  std::span<const Point3> points_;
  std::vector<std::uint32_t> slots_;
};

std::vector<std::uint32_t> first_of_equal(std::span<const Point3> points) {
  Places places(points);
  std::vector<std::uint32_t> first(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) first[i] = places.first_like(i);
  return first;
}

/// Points in cells whose diagonal is shorter than the distance, so that those of one cell weld unseen.
class Grid {
 public:
  Grid(std::span<const Point3> points, std::vector<std::uint32_t> first, double distance)
      : points_(points), parent_(std::move(first)), distance_(distance) {
    std::vector<CellPoint> sorted;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      if (parent_[i] == i) sorted.push_back({key_of(points[i]), i});
    }
    std::sort(sorted.begin(), sorted.end(), [](const CellPoint& a, const CellPoint& b) {
      return a.cell != b.cell ? a.cell < b.cell : a.number < b.number;
    });
    for (const CellPoint& point : sorted) {
      if (cells_.empty() || cells_.back().key != point.cell)
        cells_.push_back({point.cell, members_.size(), 0});
      members_.push_back(point.number);
      cells_.back().end = members_.size();
      unite(members_[cells_.back().begin], point.number);
    }
  }

  std::vector<std::uint32_t> weld() {
    // Half of the offsets (i, j): each pair of cells is met once. Cells that weld are at most two apart, since
    // the distance is 1.96 cells.
    for (std::int64_t i = 0; i <= 2; ++i) {
      for (std::int64_t j = i == 0 ? 0 : -2; j <= 2; ++j) weld_across(i, j);
    }
    for (std::uint32_t p = 0; p < parent_.size(); ++p) parent_[p] = root(p);
    return std::move(parent_);
  }

 private:
  struct CellPoint {
    Key cell;
    std::uint32_t number;
  };
  struct Cell {
    Key key;
    std::size_t begin, end;
  };

  [[nodiscard]] Key key_of(const Point3& point) const {
    Key key{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      key[axis] = static_cast<std::int64_t>(std::floor(point[axis] / (0.51 * distance_)));
    }
    return key;
  }

  /// Cells are sorted, so the cells at a fixed offset from one another are found by walking along once.
  void weld_across(std::int64_t i, std::int64_t j) {
    const bool own_row = i == 0 && j == 0;
    std::size_t first = 0;
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      const Key& key = cells_[c].key;
      const Key low{key[0] + i, key[1] + j, key[2] + (own_row ? 1 : -2)};
      const Key high{key[0] + i, key[1] + j, key[2] + 2};
      while (first < cells_.size() && cells_[first].key < low) ++first;
      for (std::size_t other = first; other < cells_.size() && cells_[other].key <= high; ++other) {
        weld_cells(cells_[c], cells_[other]);
      }
    }
  }

  void weld_cells(const Cell& a, const Cell& b) {
    if (root(members_[a.begin]) == root(members_[b.begin])) return;
    for (std::size_t p = a.begin; p < a.end; ++p) {
      for (std::size_t q = b.begin; q < b.end; ++q) {
        const Vector3 between = points_[members_[p]] - points_[members_[q]];
        if (std::hypot(between.x, between.y, between.z) <= distance_) {
          unite(members_[p], members_[q]);
          return;
        }
      }
    }
  }

  std::uint32_t root(std::uint32_t p) {
    while (parent_[p] != p) {
      parent_[p] = parent_[parent_[p]];
      p = parent_[p];
    }
    return p;
  }

  void unite(std::uint32_t p, std::uint32_t q) {
    const auto [first, second] = std::minmax({root(p), root(q)});
    parent_[second] = first;
  }

  std::span<const Point3> points_;
  std::vector<std::uint32_t> parent_;
  double distance_;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> members_;
};

/// Each element's key with the last value that was given to it becomes another key; of those that become the same the
/// largest value stays, where the first of them stood.
template <class Key, class Tag, class KeyOf, class Become>
void merge_tags(std::vector<Tag>& tags, const KeyOf& key_of, const Become& become) {
  std::map<Key, double> last;
  for (const Tag& tag : tags) last[key_of(tag)] = tag.sharpness;
  std::map<Key, double> merged;
  for (const auto& [key, sharpness] : last) {
    const auto [it, added] = merged.emplace(become(key), sharpness);
    if (!added) it->second = std::max(it->second, sharpness);
  }
  std::vector<Tag> kept;
  for (Tag tag : tags) {
    const auto found = merged.find(become(key_of(tag)));
    if (found == merged.end()) continue;
    tag.sharpness = found->second;
    kept.push_back(tag);
    merged.erase(found);
  }
  tags = std::move(kept);
}

/// Gives a mesh the vertices that stay after welding.
class Welder {
 public:
  Welder(ControlMesh& mesh, std::span<const std::uint32_t> first) : mesh_(mesh), becomes_(first.size()) {
    std::size_t kept = 0;
    for (std::size_t v = 0; v < first.size(); ++v) {
      if (first[v] == v) {
        becomes_[v] = VertexId(kept++);
        continue;
      }
      becomes_[v] = becomes_[first[v]];
      ++result_.vertices;
      const Vector3 between = mesh.points[v] - mesh.points[first[v]];
      result_.farthest = std::max(result_.farthest, std::hypot(between.x, between.y, between.z));
    }
  }

  Welded weld() {
    move_points();
    move_faces();
    for (VertexId& v : mesh_.polyline_vertices) v = moved(v);
    move_tags();
    return result_;
  }

 private:
  // Ids that name nothing stay as they are.
  [[nodiscard]] VertexId moved(VertexId v) const {
    return v.index() < becomes_.size() ? becomes_[v.index()] : v;
  }

  void move_points() {
    std::size_t kept = 0;
    for (std::size_t v = 0; v < becomes_.size(); ++v) {
      if (becomes_[v].index() == kept) mesh_.points[kept++] = mesh_.points[v];
    }
    mesh_.points.resize(kept);
  }

  // The corners of a face after welding, those that follow each other and are equal as one; none if the face is to go.
  // Faces that lose no corner stay as they are.
  std::vector<VertexId> moved_face(std::span<const VertexId> face) {
    std::vector<VertexId> corners;
    for (const VertexId v : face) {
      if (corners.empty() || corners.back() != moved(v)) corners.push_back(moved(v));
    }
    while (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
    std::vector<VertexId> different = corners;
    std::sort(different.begin(), different.end());
    different.erase(std::unique(different.begin(), different.end()), different.end());
    if (face.size() >= 3 && different.size() < 3) corners.clear();
    return corners;
  }

  void move_faces() {
    std::vector<std::uint32_t> offsets{0};
    std::vector<VertexId> vertices;
    vertices.reserve(mesh_.face_vertices.size());
    new_face_.assign(mesh_.face_count(), FaceId());
    for (std::size_t f = 0; f < mesh_.face_count(); ++f) {
      const auto face = mesh_.face(FaceId(f));
      const std::vector<VertexId> corners = moved_face(face);
      if (corners.empty() && !face.empty()) {
        ++result_.dropped;
        continue;
      }
      result_.shortened += corners.size() != face.size();
      new_face_[f] = FaceId(offsets.size() - 1);
      vertices.insert(vertices.end(), corners.begin(), corners.end());
      offsets.push_back(static_cast<std::uint32_t>(vertices.size()));
    }
    mesh_.face_offsets = std::move(offsets);
    mesh_.face_vertices = std::move(vertices);
  }

  void move_tags() {
    using Edge = std::pair<VertexId, VertexId>;
    MeshTags& tags = mesh_.tags;
    for (CreaseTag& tag : tags.creases) std::tie(tag.a, tag.b) = std::minmax({tag.a, tag.b});
    merge_tags<Edge>(
        tags.creases, [](const CreaseTag& tag) { return Edge(tag.a, tag.b); },
        [&](const Edge& edge) {
          return Edge(std::minmax({moved(edge.first), moved(edge.second)}));
        });
    for (CreaseTag& tag : tags.creases) {
      std::tie(tag.a, tag.b) = std::minmax({moved(tag.a), moved(tag.b)});
    }
    std::erase_if(tags.creases, [](const CreaseTag& tag) { return tag.a == tag.b; });
    merge_tags<VertexId>(
        tags.corners, [](const CornerTag& tag) { return tag.vertex; }, [&](VertexId v) { return moved(v); });
    for (CornerTag& tag : tags.corners) tag.vertex = moved(tag.vertex);
    std::vector<FaceId> holes;
    for (const FaceId f : tags.holes) {
      if (f.index() >= new_face_.size()) {
        holes.push_back(f);
      } else if (new_face_[f.index()].valid()) {
        holes.push_back(new_face_[f.index()]);
      }
    }
    tags.holes = std::move(holes);
  }

  ControlMesh& mesh_;
  std::vector<VertexId> becomes_;
  std::vector<FaceId> new_face_;
  Welded result_;
};

/// Certainly true if no edge has one face and edges of two have them turned alike, but for one chance in 2^64: a sum over
/// directed edges that opposite ones take out of it.
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

/// Ends of the edges that have one face.
std::vector<std::pair<VertexId, VertexId>> boundary_edges(const ControlMesh& mesh) {
  const HalfEdgeGroups groups(mesh.face_offsets, mesh.face_vertices, mesh.vertex_count());
  std::vector<std::pair<VertexId, VertexId>> edges;
  for (std::size_t e = 0; e < groups.edge_count(); ++e) {
    const auto members = groups.of_edge(EdgeId(e));
    if (members.size() != 1) continue;
    const HalfEdge next = next_in_face(mesh.face_offsets, groups.face(members[0]), members[0]);
    edges.emplace_back(mesh.face_vertices[members[0]], mesh.face_vertices[next]);
  }
  return edges;
}

void find_coincident_edges(const ControlMesh& mesh,
                           const std::vector<std::pair<VertexId, VertexId>>& boundary, Coincidences& found) {
  Places places(mesh.points);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& [a, b] : boundary) {
    edges.push_back(std::minmax({places.first_like(a.value()), places.first_like(b.value())}));
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const bool like_last = i > 0 && edges[i] == edges[i - 1];
    const bool like_next = i + 1 < edges.size() && edges[i] == edges[i + 1];
    found.edges += like_last || like_next;
  }
}

void find_near_vertices(const ControlMesh& mesh, const std::vector<std::pair<VertexId, VertexId>>& boundary,
                        Coincidences& found) {
  Places places(mesh.points);
  std::vector<Point3> points;  // one a place
  const auto add = [&](VertexId v) {
    if (places.first_like(v.value()) == v.value()) points.push_back(mesh.points[v.index()]);
  };
  std::vector<bool> added(mesh.vertex_count(), false);
  for (const auto& [a, b] : boundary) {
    for (const VertexId v : {a, b}) {
      if (!added[v.index()]) add(v);
      added[v.index()] = true;
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
}

}  // namespace

std::vector<std::uint32_t> first_of_welded(std::span<const Point3> points, double distance) {
  require_length(distance, "the welding distance");
  if (points.size() >= UINT32_MAX) {
    throw InputError(InputProblem::refused, "at most 2^32 - 1 points can be welded: split the mesh");
  }
  double largest = 0;
  for (const Point3& point : points) {
    if (!is_finite(point))
      throw InputError(InputProblem::refused, "a coordinate is not finite: it cannot be welded");
    largest = std::max(largest, max_abs(point - Point3{}));
  }
  std::vector<std::uint32_t> first = first_of_equal(points);
  if (distance == 0) return first;
  // So that cells have whole numbers that are exact, and neighbours of them.
  if (!(distance >= std::ldexp(largest, -40)) || 0.51 * distance < std::ldexp(1.0, -1000)) {
    throw InputError(InputProblem::refused,
                     "the welding distance is too small for these coordinates: give a larger one");
  }
  return Grid(points, std::move(first), distance).weld();
}

Welded weld(ControlMesh& mesh, double distance) {
  const std::vector<std::uint32_t> first = first_of_welded(mesh.points, distance);
  return Welder(mesh, first).weld();
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
  Places places(mesh.points);
  std::vector<bool> shared(mesh.vertex_count(), false);
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    if (!used[v]) continue;
    const std::uint32_t first = places.first_like(v);
    if (first == v) continue;
    found.vertices += shared[first] ? 1 : 2;
    found.places += !shared[first];
    shared[first] = true;
  }
  found.reach = 0x1p-17 * longest_side(used_box(mesh));
  const bool reaches =
      found.reach >= std::ldexp(largest, -40) && found.reach > DBL_MIN && std::isfinite(found.reach);
  if (looks_closed(mesh)) return found;
  const auto boundary = boundary_edges(mesh);
  if (found.vertices > 0) find_coincident_edges(mesh, boundary, found);
  if (reaches) find_near_vertices(mesh, boundary, found);
  return found;
}

}  // namespace snug
