#include <snug/mesh.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include <snug/mesh/disjoint_sets.h>
#include <snug/mesh/split_polygon.h>
#include <snug/mesh/topology.h>
#include <support/direction.h>
#include <support/error.h>

namespace snug {
namespace {

/// In degrees; 180 for vectors without a length.
double angle_between(const Vector3& a, const Vector3& b) {
  const double cosine = dot(a, b), sine = length(cross(a, b));
  if (sine == 0 && cosine == 0) return 180;
  return std::atan2(sine, cosine) * (180 / std::numbers::pi);
}

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

/// How exact the coordinates of a mesh are taken to be, scaled: see sharpen().
double exactness(const ControlMesh& mesh, PowerOfTwo scale, double largest) {
  const bool floats = std::all_of(mesh.face_vertices.begin(), mesh.face_vertices.end(), [&](VertexId v) {
    const Point3& p = mesh.points[v.index()];
    return max_abs(p - Point3{}) <= 0x1p127 && p.x == static_cast<float>(p.x) &&
           p.y == static_cast<float>(p.y) && p.z == static_cast<float>(p.z);
  });
  const Box3 box = used_box(mesh);
  const double size = longest_side(Box3{scale.apply(box.lower), scale.apply(box.upper)});
  return std::max(0x1p-17 * size, (floats ? 0x1p-22 : 0x1p-48) * scale.apply(largest));
}

using EdgeEnds = std::pair<VertexId, VertexId>;

/// Elements with the sharpness that tags give them, in rising order; the last one of an element counts.
template <class Key>
using Tagged = std::vector<std::pair<Key, double>>;

template <class Key>
bool is_infinite(const Tagged<Key>& tags, const Key& key) {
  const auto after = std::ranges::upper_bound(tags, key, {}, &std::pair<Key, double>::first);
  return after != tags.begin() && std::prev(after)->first == key &&
         std::prev(after)->second >= infinite_sharpness;
}

/// Finds the sharp parts of a mesh: edges by angle, then planar regions, then vertices. Works in scaled coordinates.
class Sharpener {
 public:
  Sharpener(const ControlMesh& mesh, double angle) : mesh_(mesh), angle_(angle), topology_(mesh) {
    for (const CreaseTag& tag : mesh.tags.creases) {
      tagged_edges_.emplace_back(std::minmax({tag.a, tag.b}), tag.sharpness);
    }
    for (const CornerTag& tag : mesh.tags.corners) tagged_vertices_.emplace_back(tag.vertex, tag.sharpness);
    std::ranges::stable_sort(tagged_edges_, {}, &std::pair<EdgeEnds, double>::first);
    std::ranges::stable_sort(tagged_vertices_, {}, &std::pair<VertexId, double>::first);
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

  /// Is the face to be its own limit surface?
  [[nodiscard]] bool is_faceted(FaceId f) const { return faceted_[f.index()]; }
  [[nodiscard]] const Vector3& area(FaceId f) const { return areas_[f.index()]; }

  /// Appends the tags that are missing, and counts them and the regions.
  void tag(MeshTags& tags, SharpenReport& result) const {
    result.flat_regions = flat_regions_;
    result.fixed_regions = fixed_regions_;
    for (std::size_t e = 0; e < sharp_.size(); ++e) {
      const EdgeId edge(e);
      if (!sharp_[e] || topology_.ends_fans(edge) || is_tagged(edge)) continue;
      const auto [a, b] = ends(edge);
      tags.creases.push_back({a, b, infinite_sharpness});
      ++result.creases;
    }
    for (const VertexId v : corners()) {
      if (is_infinite(tagged_vertices_, v)) continue;
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
    return !tagged_edges_.empty() && is_infinite(tagged_edges_, ends(e));
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
    EdgeId edge;
    FaceId face;
  };

  // Narrow faces that hang together are looked through: the faces around them are compared with each other.
  void sharpen_across_narrow_faces() {
    DisjointSets sets(mesh_.face_count());
    for (std::size_t e = 0; e < sharp_.size(); ++e) {
      if (sharp_[e]) continue;
      const auto [f, g] = faces_of(EdgeId(e));
      if (is_narrow(f) && is_narrow(g)) sets.join(f.value(), g.value());
    }
    std::map<std::uint32_t, std::vector<Shore>> shores;
    for (std::size_t e = 0; e < sharp_.size(); ++e) {
      if (sharp_[e]) continue;
      const auto [f, g] = faces_of(EdgeId(e));
      if (is_narrow(f) == is_narrow(g)) continue;
      const auto [narrow, wide] = is_narrow(f) ? std::pair(f, g) : std::pair(g, f);
      shores[sets.least(narrow.value())].push_back({EdgeId(e), wide});
    }
    for (const auto& [set, around] : shores) sharpen_shores(around);
  }

  void sharpen_shores(std::span<const Shore> shores) {
    const auto apart = [&](const Shore& a, const Shore& b, double angle) {
      return angle_between(normals_[a.face.index()], normals_[b.face.index()]) > angle;
    };
    // No two can be farther apart than the angle if none is farther than half of it from the first.
    const auto far_from_first = [&](const Shore& s) { return apart(shores[0], s, angle_ / 2); };
    if (std::none_of(shores.begin(), shores.end(), far_from_first)) return;
    constexpr std::size_t max_compared = 256;
    for (const Shore& s : shores) {
      sharp_[s.edge.index()] =
          shores.size() > max_compared ||
          std::any_of(shores.begin(), shores.end(), [&](const Shore& t) { return apart(s, t, angle_); });
    }
  }

  void find_regions() {
    DisjointSets sets(mesh_.face_count());
    for (std::size_t e = 0; e < sharp_.size(); ++e) {
      if (sharp_[e]) continue;
      const auto [f, g] = faces_of(EdgeId(e));
      sets.join(f.value(), g.value());
    }
    std::vector<std::vector<FaceId>> regions(mesh_.face_count()), curved;  // empty but at their first faces
    for (std::size_t f = 0; f < mesh_.face_count(); ++f) {
      regions[sets.least(static_cast<std::uint32_t>(f))].emplace_back(f);
    }
    faceted_.assign(mesh_.face_count(), false);
    pinned_.assign(mesh_.vertex_count(), false);
    for (std::vector<FaceId>& faces : regions) {
      if (faces.empty()) continue;
      if (!is_planar(faces)) {
        curved.push_back(std::move(faces));
        continue;
      }
      ++flat_regions_;
      for (const FaceId f : faces) pin(f);
    }
    find_fixed_regions(curved);
  }

  // Regions without a vertex that subdivision could move: between corners, smooth edges make them uneven.
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
  Tagged<EdgeEnds> tagged_edges_;
  Tagged<VertexId> tagged_vertices_;
  double exactness_ = 0;
  std::vector<Point3> points_;
  std::vector<Vector3> areas_, normals_;  // of faces; no normal where they are narrow
  std::vector<bool> sharp_;               // of edges
  std::vector<bool> faceted_;             // of faces: in regions that are kept as they are
  std::vector<bool> pinned_;              // of vertices
  std::size_t flat_regions_ = 0, fixed_regions_ = 0;
};

/// Splits the faces of planar regions that are not convex.
void split_faces(ControlMesh& mesh, const Sharpener& sharp, SharpenReport& result) {
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

SharpenReport sharpen(ControlMesh& mesh, double angle) {
  if (!(angle >= 0 && angle < 180)) {
    throw InputError(InputProblem::value,
                     "the angle of sharp edges must be at least 0 and below 180 degrees");
  }
  SharpenReport result;
  if (!can_be_sharpened(mesh)) return result;
  std::optional<Sharpener> sharp(std::in_place, mesh, angle);
  split_faces(mesh, *sharp, result);
  if (result.split_faces > 0) sharp.emplace(mesh, angle);
  sharp->tag(mesh.tags, result);
  std::optional<Scheme>& scheme = mesh.tags.scheme;
  if (!scheme || scheme == Scheme::flat) {
    const bool triangles = mesh.face_count() > 0 && mesh.face_vertices.size() == 3 * mesh.face_count();
    scheme = triangles ? std::optional(Scheme::loop) : std::nullopt;
  }
  return result;
}

}  // namespace snug
