#include <snug/mesh.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include <snug/base/error.h>
#include <snug/geometry/direction.h>
#include <snug/mesh/split_polygon.h>
#include <snug/mesh/topology.h>

namespace snug {
namespace {

/// In degrees; 180 for vectors without a length.
double angle_between(const Vector3& a, const Vector3& b) {
  const double cosine = dot(a, b), sine = length(cross(a, b));
  if (sine == 0 && cosine == 0) return 180;
  return std::atan2(sine, cosine) * (180 / std::numbers::pi);
}

/// Sets of numbers that were joined.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t i, std::uint32_t k) {
    const auto [first, second] = std::minmax({root(i), root(k)});
    parent_[second] = first;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

bool can_be_sharpened(const ControlMesh& mesh) {
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face(FaceId(f)).size() < 3) return false;
  }
  return std::all_of(mesh.face_vertices.begin(), mesh.face_vertices.end(), [&](VertexId v) {
    return v.index() < mesh.vertex_count() && is_finite(mesh.points[v.index()]);
  });
}

double largest_coordinate(const ControlMesh& mesh) {
  double largest = 0;
  for (const VertexId v : mesh.face_vertices) {
    largest = std::max(largest, max_abs(mesh.points[v.index()] - Point3{}));
  }
  return largest;
}

/// How exact the coordinates of a mesh are taken to be, scaled: see sharpen.h.
double exactness(const ControlMesh& mesh, PowerOfTwo scale, double largest) {
  const bool floats = std::all_of(mesh.face_vertices.begin(), mesh.face_vertices.end(), [&](VertexId v) {
    const Point3& p = mesh.points[v.index()];
    return std::fabs(max_abs(p - Point3{})) <= 0x1p127 && p.x == static_cast<float>(p.x) &&
           p.y == static_cast<float>(p.y) && p.z == static_cast<float>(p.z);
  });
  const Box3 box = used_box(mesh);
  const double size = longest_side(Box3{scale.apply(box.lower), scale.apply(box.upper)});
  return std::max(0x1p-17 * size, (floats ? 0x1p-22 : 0x1p-48) * scale.apply(largest));
}

using EdgeEnds = std::pair<VertexId, VertexId>;

/// Edges and vertices tagged infinitely sharp, in rising order.
struct SharpTags {
  std::vector<EdgeEnds> edges;
  std::vector<VertexId> vertices;

  explicit SharpTags(const MeshTags& tags) {
    // The last tag of an element counts: later ones first, and only the first of each stays.
    std::vector<std::pair<EdgeEnds, double>> all_edges;
    for (const CreaseTag& tag : tags.creases)
      all_edges.emplace_back(std::minmax({tag.a, tag.b}), tag.sharpness);
    std::vector<std::pair<VertexId, double>> all_vertices;
    for (const CornerTag& tag : tags.corners) all_vertices.emplace_back(tag.vertex, tag.sharpness);
    keep_infinite(all_edges, edges);
    keep_infinite(all_vertices, vertices);
  }

 private:
  template <class Key>
  static void keep_infinite(std::vector<std::pair<Key, double>>& tags, std::vector<Key>& kept) {
    std::reverse(tags.begin(), tags.end());
    std::stable_sort(tags.begin(), tags.end(),
                     [](const auto& s, const auto& t) { return s.first < t.first; });
    for (std::size_t i = 0; i < tags.size(); ++i) {
      const bool counts = i == 0 || tags[i].first != tags[i - 1].first;
      if (counts && tags[i].second >= infinite_sharpness) kept.push_back(tags[i].first);
    }
  }
};

/// What is sharp in a mesh: edges by angle, then planar regions, then vertices. Works in scaled coordinates.
class Sharpener {
 public:
  Sharpener(const ControlMesh& mesh, double angle)
      : mesh_(mesh), angle_(angle), topology_(mesh), tagged_(mesh.tags) {
    const double largest = largest_coordinate(mesh);
    const PowerOfTwo scale = PowerOfTwo::normalising(largest);
    exactness_ = exactness(mesh, scale, largest);
    points_.reserve(mesh.vertex_count());
    for (const Point3& p : mesh.points) points_.push_back(scale.apply(p));
    measure_faces();
    sharp_.resize(topology_.edge_count());
    for (std::size_t e = 0; e < sharp_.size(); ++e) sharp_[e] = sharp_by_angle(EdgeId(e));
    sharpen_across_narrow_faces();
    find_regions();
  }

  [[nodiscard]] std::size_t flat_regions() const { return flat_regions_; }
  [[nodiscard]] std::size_t fixed_regions() const { return fixed_regions_; }
  /// Is the face to be its own limit surface?
  [[nodiscard]] bool is_faceted(FaceId f) const { return faceted_[f.index()]; }
  [[nodiscard]] const Vector3& area(FaceId f) const { return areas_[f.index()]; }

  /// Appends the tags that are missing.
  void tag(MeshTags& tags, Sharpened& result) const {
    for (std::size_t e = 0; e < sharp_.size(); ++e) {
      const EdgeId edge(e);
      if (!sharp_[e] || topology_.ends_fans(edge) || is_tagged(edge)) continue;
      const auto [a, b] = ends(edge);
      tags.creases.push_back({a, b, infinite_sharpness});
      ++result.creases;
    }
    for (const VertexId v : corners()) {
      if (std::binary_search(tagged_.vertices.begin(), tagged_.vertices.end(), v)) continue;
      tags.corners.push_back({v, infinite_sharpness});
      ++result.corners;
    }
  }

 private:
  [[nodiscard]] EdgeEnds ends(EdgeId e) const {
    const HalfEdge h = topology_.half_of(e);
    return std::minmax({topology_.from(h), topology_.to(h)});
  }
  [[nodiscard]] bool is_tagged(EdgeId e) const {
    return !tagged_.edges.empty() && std::binary_search(tagged_.edges.begin(), tagged_.edges.end(), ends(e));
  }
  [[nodiscard]] const Point3& point(VertexId v) const { return points_[v.index()]; }

  void measure_faces() {
    const std::size_t count = mesh_.face_count();
    areas_.resize(count);
    normals_.resize(count);
    for (std::size_t f = 0; f < count; ++f) {
      const auto face = mesh_.face(FaceId(f));
      const Point3& origin = point(face[0]);
      Vector3 area;  // twice that
      double perimeter = 0;
      for (std::size_t k = 0; k < face.size(); ++k) {
        const Point3 &a = point(face[k]), &b = point(face[(k + 1) % face.size()]);
        area = area + cross(a - origin, b - origin);
        perimeter += distance(a, b);
      }
      areas_[f] = area;
      if (length(area) > exactness_ * (perimeter / 2)) normals_[f] = normalized(area);
    }
  }
  /// Has the face too little width for a normal of its own?
  [[nodiscard]] bool is_narrow(FaceId f) const { return normals_[f.index()] == Vector3{}; }

  [[nodiscard]] bool sharp_by_angle(EdgeId e) const {
    if (topology_.ends_fans(e) || is_tagged(e)) return true;
    const auto [f, g] = faces_of(e);
    if (is_narrow(f) || is_narrow(g)) return false;
    return angle_between(normals_[f.index()], normals_[g.index()]) > angle_;
  }
  /// Requires:  two faces.
  [[nodiscard]] std::pair<FaceId, FaceId> faces_of(EdgeId e) const {
    const HalfEdge h = topology_.half_of(e);
    return {topology_.face_of(h), topology_.face_of(topology_.twin(h))};
  }

  /// An edge between a set of narrow faces and another face.
  struct Shore {
    std::uint32_t set;
    EdgeId edge;
    FaceId face;
  };

  // Narrow faces that hang together are looked through: the faces around them are compared with each other.
  void sharpen_across_narrow_faces() {
    Sets sets(mesh_.face_count());
    std::vector<Shore> shores;
    for (std::size_t e = 0; e < sharp_.size(); ++e) {
      if (sharp_[e]) continue;
      const auto [f, g] = faces_of(EdgeId(e));
      if (is_narrow(f) && is_narrow(g)) sets.join(f.value(), g.value());
    }
    for (std::size_t e = 0; e < sharp_.size(); ++e) {
      if (sharp_[e]) continue;
      const auto [f, g] = faces_of(EdgeId(e));
      if (is_narrow(f) == is_narrow(g)) continue;
      shores.push_back({sets.root((is_narrow(f) ? f : g).value()), EdgeId(e), is_narrow(f) ? g : f});
    }
    std::stable_sort(shores.begin(), shores.end(),
                     [](const Shore& a, const Shore& b) { return a.set < b.set; });
    for (std::size_t begin = 0, end = 0; begin < shores.size(); begin = end) {
      while (end < shores.size() && shores[end].set == shores[begin].set) ++end;
      sharpen_shores({shores.data() + begin, shores.data() + end});
    }
  }

  void sharpen_shores(std::span<const Shore> shores) {
    const auto apart = [&](const Shore& a, const Shore& b, double angle) {
      return angle_between(normals_[a.face.index()], normals_[b.face.index()]) > angle;
    };
    // No two can be farther apart than the angle if none is farther than half of it from the first.
    const auto far_from_first = [&](const Shore& s) { return apart(shores[0], s, angle_ / 2); };
    if (std::none_of(shores.begin(), shores.end(), far_from_first)) return;
    constexpr std::size_t most_compared = 256;
    for (const Shore& s : shores) {
      sharp_[s.edge.index()] =
          shores.size() > most_compared ||
          std::any_of(shores.begin(), shores.end(), [&](const Shore& t) { return apart(s, t, angle_); });
    }
  }

  void find_regions() {
    Sets sets(mesh_.face_count());
    for (std::size_t e = 0; e < sharp_.size(); ++e) {
      if (sharp_[e]) continue;
      const auto [f, g] = faces_of(EdgeId(e));
      sets.join(f.value(), g.value());
    }
    std::vector<std::pair<std::uint32_t, FaceId>> by_region;
    for (std::size_t f = 0; f < mesh_.face_count(); ++f) {
      by_region.emplace_back(sets.root(static_cast<std::uint32_t>(f)), FaceId(f));
    }
    std::sort(by_region.begin(), by_region.end());
    faceted_.assign(mesh_.face_count(), false);
    pinned_.assign(mesh_.vertex_count(), false);
    std::vector<std::vector<FaceId>> curved;
    for (std::size_t begin = 0, end = 0; begin < by_region.size(); begin = end) {
      std::vector<FaceId> faces;
      while (end < by_region.size() && by_region[end].first == by_region[begin].first) {
        faces.push_back(by_region[end++].second);
      }
      if (is_planar(faces)) {
        ++flat_regions_;
        for (const FaceId f : faces) pin(f);
      } else {
        curved.push_back(std::move(faces));
      }
    }
    find_fixed_regions(curved);
  }

  // Regions without a vertex that subdivision could move: between corners, smooth edges would only make them uneven.
  void find_fixed_regions(const std::vector<std::vector<FaceId>>& regions) {
    const std::vector<SharpEnds> at = sharp_ends();
    std::vector<bool> fixed(at.size());
    for (std::size_t v = 0; v < at.size(); ++v)
      fixed[v] = pinned_[v] || at[v].count > 2 || turns(VertexId(v), at[v]);
    for (const std::vector<FaceId>& faces : regions) {
      const bool all = std::all_of(faces.begin(), faces.end(), [&](FaceId f) {
        const auto face = mesh_.face(f);
        return std::all_of(face.begin(), face.end(), [&](VertexId v) { return fixed[v.index()]; });
      });
      if (!all) continue;
      ++fixed_regions_;
      for (const FaceId f : faces) pin(f);
    }
  }

  // The normal is that of all faces together, which inner vertices have no part in.
  [[nodiscard]] bool is_planar(const std::vector<FaceId>& faces) const {
    Vector3 sum;
    double area = 0;
    bool narrow = true;
    for (const FaceId f : faces) {
      sum = sum + areas_[f.index()];
      area += length(areas_[f.index()]);
      narrow = narrow && is_narrow(f);
    }
    if (narrow) return true;
    if (!(length(sum) > area / 2)) return false;
    const Vector3 normal = normalized(sum);
    const Point3& origin = point(mesh_.face(faces[0])[0]);
    double low = 0, high = 0;
    for (const FaceId f : faces) {
      for (const VertexId v : mesh_.face(f)) {
        const double height = dot(normal, point(v) - origin);
        low = std::min(low, height);
        high = std::max(high, height);
      }
    }
    return high - low <= 2 * exactness_;
  }

  void pin(FaceId f) {
    faceted_[f.index()] = true;
    HalfEdge h = topology_.first_of(f);
    for (const VertexId v : mesh_.face(f)) {
      pinned_[v.index()] = true;
      sharp_[topology_.edge_of(h++).index()] = true;
    }
  }

  /// Sharp edges at a vertex: how many, and where the first two lead.
  struct SharpEnds {
    std::uint32_t count = 0;
    std::array<VertexId, 2> far;
  };
  [[nodiscard]] std::vector<SharpEnds> sharp_ends() const {
    std::vector<SharpEnds> at(mesh_.vertex_count());
    for (std::size_t e = 0; e < sharp_.size(); ++e) {
      if (!sharp_[e]) continue;
      const auto [a, b] = ends(EdgeId(e));
      for (const auto& [v, far] : {std::pair(a, b), std::pair(b, a)}) {
        SharpEnds& s = at[v.index()];
        if (s.count < 2) s.far[s.count] = far;
        ++s.count;
      }
    }
    return at;
  }
  /// Has the vertex two sharp edges, which turn by more than the angle?
  [[nodiscard]] bool turns(VertexId v, const SharpEnds& s) const {
    return s.count == 2 && angle_between(point(v) - point(s.far[0]), point(s.far[1]) - point(v)) > angle_;
  }

  /// Vertices that need a tag to be corners.
  [[nodiscard]] std::vector<VertexId> corners() const {
    const std::vector<SharpEnds> at = sharp_ends();
    std::vector<VertexId> found;
    for (std::size_t v = 0; v < at.size(); ++v) {
      if (at[v].count > 2) continue;
      if (pinned_[v] || turns(VertexId(v), at[v])) found.emplace_back(v);
    }
    return found;
  }

  const ControlMesh& mesh_;
  double angle_;
  Topology topology_;
  SharpTags tagged_;
  double exactness_ = 0;
  std::vector<Point3> points_;
  std::vector<Vector3> areas_, normals_;  // of faces; no normal where they are narrow
  std::vector<bool> sharp_;               // of edges
  std::vector<bool> faceted_;             // of faces: in regions that are kept as they are
  std::vector<bool> pinned_;              // of vertices
  std::size_t flat_regions_ = 0, fixed_regions_ = 0;
};

/// Splits the faces of planar regions that are not convex.
void split_faces(ControlMesh& mesh, const Sharpener& sharp, Sharpened& result) {
  std::vector<bool> hole(mesh.face_count(), false);
  for (const FaceId f : mesh.tags.holes) {
    if (f.index() < hole.size()) hole[f.index()] = true;
  }
  ControlMesh split;  // faces alone
  std::vector<std::array<VertexId, 3>> behind;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(FaceId(f));
    std::vector<std::array<std::uint32_t, 3>> triangles;
    if (face.size() > 3 && !hole[f] && sharp.is_faceted(FaceId(f))) {
      std::vector<Point3> corners;
      for (const VertexId v : face) corners.push_back(mesh.points[v.index()]);
      const std::vector<PlanePoint> polygon = dropped_along(sharp.area(FaceId(f)), corners);
      if (!is_convex(polygon)) {
        triangles = triangles_of(polygon);
        (triangles.empty() ? result.crossed_faces : result.split_faces) += 1;
      }
    }
    if (triangles.empty()) {
      split.add_face(face);
      continue;
    }
    for (std::size_t k = 0; k < triangles.size(); ++k) {
      const std::array<VertexId, 3> part{face[triangles[k][0]], face[triangles[k][1]], face[triangles[k][2]]};
      if (k == 0) {
        split.add_face(part);
      } else {
        behind.push_back(part);
        result.parts_of.emplace_back(f);
      }
    }
  }
  for (const auto& part : behind) split.add_face(part);
  mesh.face_offsets = std::move(split.face_offsets);
  mesh.face_vertices = std::move(split.face_vertices);
}

}  // namespace

Sharpened sharpen(ControlMesh& mesh, double angle) {
  if (!(angle >= 0 && angle < 180)) {
    throw InputError(InputProblem::value,
                     "the angle of sharp edges must be at least 0 and below 180 degrees");
  }
  Sharpened result;
  if (!can_be_sharpened(mesh)) return result;
  std::optional<Sharpener> sharp(std::in_place, mesh, angle);
  split_faces(mesh, *sharp, result);
  if (result.split_faces > 0) sharp.emplace(mesh, angle);
  result.flat_regions = sharp->flat_regions();
  result.fixed_regions = sharp->fixed_regions();
  sharp->tag(mesh.tags, result);
  return result;
}

}  // namespace snug
