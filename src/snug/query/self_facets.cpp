#include <snug/query/self_facets.h>

#include <algorithm>
#include <span>
#include <vector>

#include <snug/geometry/triangle_distance.h>
#include <snug/search/facet.h>
#include <snug/search/self_contact.h>
#include <snug/surface/evaluate.h>
#include <support/run.h>

namespace snug {
namespace {

using FacetNames = std::array<std::uint32_t, 3>;

// The faces, cut into triangles of the mesh's vertices.
struct FacetMesh {
  std::vector<FacetNames> triangles;
  std::vector<std::uint32_t> faces;  // that each belongs to
};

// Triangles of different faces that both name a cut through the inside of one: all of it is a contact, though names say that it is an
// edge of both. A pair for each cut.
std::vector<TrianglePair> along_cuts(const FacetMesh& mesh) {
  struct Side {
    std::array<std::uint32_t, 2> ends;
    std::uint32_t triangle;
    bool cut;
  };
  std::vector<Side> sides;
  const std::size_t count = mesh.triangles.size();
  for (std::uint32_t t = 0; t < count; ++t) {
    const bool first = t == 0 || mesh.faces[t - 1] != mesh.faces[t],
               last = t + 1 == count || mesh.faces[t + 1] != mesh.faces[t];
    const FacetNames& names = mesh.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(names[k], names[(k + 1) % 3]);
      sides.push_back({{low, high}, t, (k == 0 && !first) || (k == 2 && !last)});
    }
  }
  if (std::none_of(sides.begin(), sides.end(), [](const Side& side) { return side.cut; })) return {};
  std::sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) {
    return x.ends != y.ends ? x.ends < y.ends : x.cut != y.cut ? x.cut : x.triangle < y.triangle;
  });
  std::vector<TrianglePair> found;
  for (std::size_t i = 0, end; i < sides.size(); i = end) {
    end = i + 1;
    while (end < sides.size() && sides[end].ends == sides[i].ends) ++end;
    for (std::size_t j = i + 1; sides[i].cut && j < end; ++j) {
      const auto [low, high] = std::minmax(sides[i].triangle, sides[j].triangle);
      if (mesh.faces[low] == mesh.faces[high]) continue;
      found.push_back({low, high, TriangleContact::touching});
      break;
    }
  }
  return found;
}

class FacetContacts {
 public:
  FacetContacts(const LimitSurface& surface, const FacetMesh& mesh) : surface_(surface), mesh_(mesh) {}

  [[nodiscard]] SelfContactPair pair_of(const TrianglePair& found) const {
    const bool touching =
        found.contact == TriangleContact::touching || found.contact == TriangleContact::collapsed;
    SelfContactPair pair{SelfVerdict::intersecting, touching, {}, {0, 0}};
    const Point3 at = common_point(found);
    for (std::size_t s = 0; s < 2; ++s) {
      pair.points[s] = evaluate(surface_, place_near(mesh_.faces[s == 0 ? found.a : found.b], at));
    }
    return pair;
  }

 private:
  [[nodiscard]] Triangle triangle(std::uint32_t t) const {
    Triangle corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = surface_.scaled_points()[mesh_.triangles[t][k]];
    return corners;
  }

  // A point of both, in double precision, beside the vertices that both name: the best one of other corners, of points where edges
  // between these pass through the other plane, and of points where these are nearest to the other triangle.
  [[nodiscard]] Point3 common_point(const TrianglePair& found) const {
    const std::array<Triangle, 2> t{triangle(found.a), triangle(found.b)};
    const std::array<FacetNames, 2> names{mesh_.triangles[found.a], mesh_.triangles[found.b]};
    double least = INFINITY;
    Point3 result = t[0][0];
    const auto consider = [&](const Point3& p) {
      const double apart = distance_between(p, t[0], 1).upper + distance_between(p, t[1], 1).upper;
      if (!(apart < least)) return;
      least = apart;
      result = p;
    };
    for (std::size_t s = 0; s < 2; ++s) {
      const Triangle& other = t[1 - s];
      const Vector3 normal = cross(other[1] - other[0], other[2] - other[0]);
      std::vector<Point3> own, common;
      for (std::size_t k = 0; k < 3; ++k) {
        const bool both =
            std::find(names[1 - s].begin(), names[1 - s].end(), names[s][k]) != names[1 - s].end();
        (both ? common : own).push_back(t[s][k]);
      }
      if (own.size() == 1) {  // near the common edge
        const Point3 middle = common[0] + 0.5 * (common[1] - common[0]);
        for (double share = 0.5; share > 0x1p-20; share *= 0.5) consider(middle + share * (own[0] - middle));
      }
      for (std::size_t k = 0; k < own.size(); ++k) {
        const Point3 &p = own[k], &q = own[(k + 1) % own.size()];
        consider(p);
        const double of_p = dot(normal, p - other[0]), of_q = dot(normal, q - other[0]);
        if (of_p * of_q < 0) consider(p + of_p / (of_p - of_q) * (q - p));
        const NearestTriangles near = nearest({p, q, q}, other);
        consider(other[0] + near.on_b.b * (other[1] - other[0]) + near.on_b.c * (other[2] - other[0]));
      }
    }
    return result;
  }

  [[nodiscard]] Place place_near(std::uint32_t face, const Point3& point) const {
    Place place{face, 0, 0, 0};
    double least = INFINITY;
    const auto [begin, end] = surface_.patches_of(face);
    for (std::size_t p = begin; p < end; ++p) {
      const std::optional<Facet> facet = facet_of(surface_, PatchId(p));
      if (!facet) continue;
      const PointTriangleDistance found = distance_between(point, facet->triangle, 1);
      if (!(found.upper < least)) continue;
      least = found.upper;
      const TriangleParameter at = facet->place_of(found.foot);
      place = {face, facet->corner, at.u, at.v};
    }
    return place;
  }

  const LimitSurface& surface_;
  const FacetMesh& mesh_;
};

}  // namespace

ComparedFacets compare_facets(const LimitSurface& surface, int threads, const WorkMonitor& monitor) {
  const Topology& topology = surface.topology();
  ComparedFacets result{std::vector<bool>(topology.face_count()), surface.rules().primal, {}};
  result.answer.verdict = SelfVerdict::clear;
  if (!surface.rules().primal) return result;
  FacetMesh mesh;
  for (std::uint32_t f = 0; f < topology.face_count(); ++f) {
    monitor.checkpoint();
    const auto [begin, end] = surface.patches_of(f);
    if (begin == end || !surface.has_patch(PatchId(begin))) continue;
    const std::span<const VertexId> face = topology.face(FaceId(f));
    result.faces[f] = is_exact_facet(surface, FaceId(f), PatchId(begin));
    result.all = result.all && result.faces[f];
    for (std::size_t k = 2; result.faces[f] && k < face.size(); ++k) {
      mesh.triangles.push_back({face[0].value(), face[k - 1].value(), face[k].value()});
      mesh.faces.push_back(f);
    }
  }
  std::vector<TrianglePair> found =
      self_contacts(surface.scaled_points(), mesh.triangles, SIZE_MAX, threads, monitor);
  const std::vector<TrianglePair> cuts = along_cuts(mesh);
  found.insert(found.end(), cuts.begin(), cuts.end());
  if (!found.empty()) result.answer.verdict = SelfVerdict::intersecting;
  // Crossings first.
  std::stable_sort(found.begin(), found.end(),
                   [](const TrianglePair& x, const TrianglePair& y) { return x.contact < y.contact; });
  const FacetContacts contacts(surface, mesh);
  for (const TrianglePair& pair : found) {
    if (result.answer.pairs.size() == SelfContact::max_pairs) break;
    result.answer.pairs.push_back(contacts.pair_of(pair));
  }
  return result;
}

}  // namespace snug
