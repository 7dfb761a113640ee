#include <snug/independence/mesh_kernel.h>

#include <algorithm>
#include <string>
#include <utility>

#include <snug/mesh/topology.h>
#include <snug/scheme/creases.h>
#include <snug/scheme/rules.h>

namespace snug {
namespace {

[[noreturn]] void refuse_kernel(const std::string& why) {
  throw NotDecided(InputProblem::refused, "the kernel of the mesh is not decided: " + why);
}

// Faces without a surface; with a dual scheme those without a vertex inside, which support no patch.
std::vector<bool> faces_without_surface(const ControlMesh& mesh, const RuledMesh& ruled) {
  const Topology& topology = ruled.topology;
  std::vector<bool> without_surface(mesh.face_count(), false);
  if (!rules_of(ruled.options.scheme).primal) {
    for (std::size_t f = 0; f < without_surface.size(); ++f) {
      const auto face = topology.face(FaceId(f));
      without_surface[f] =
          std::all_of(face.begin(), face.end(), [&](VertexId v) { return topology.on_boundary(v); });
    }
    return without_surface;
  }
  for (const FaceId f : mesh.tags.holes) without_surface[f.index()] = true;
  if (ruled.options.boundary == BoundaryRule::none) {
    for (std::size_t f = 0; f < without_surface.size(); ++f) {
      without_surface[f] = without_surface[f] || loses_surface(topology, ruled.sharpness, FaceId(f));
    }
  }
  return without_surface;
}

// With Doo-Sabin, all modes of a face show at its corners inside and beside these: there are enough of them.
void require_small_faces(const Topology& topology, const std::vector<bool>& without_surface) {
  for (std::size_t f = 0; f < without_surface.size(); ++f) {
    if (without_surface[f]) continue;
    const auto face = topology.face(FaceId(f));
    const std::size_t n = face.size();
    std::size_t shown = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const auto inside = [&](std::size_t k) { return !topology.on_boundary(face[k % n]); };
      shown += inside(i) || inside(i + 1) || inside(i + n - 1) ? 1 : 0;
    }
    if (n <= shown + 3) continue;
    refuse_kernel("face " + std::to_string(f) + " has " + std::to_string(n) + " corners, " +
                  std::to_string(n - shown) +
                  " of them beside no vertex inside; split it, or close the mesh");
  }
}

void require_manifold_with_surfaces(const Topology& topology, const std::vector<bool>& without_surface) {
  if (!topology.is_manifold()) refuse_kernel("it is not manifold; 'snug info' names where, mend it");
  const auto first = std::find(without_surface.begin(), without_surface.end(), true);
  if (first != without_surface.end()) {
    refuse_kernel("face " + std::to_string(first - without_surface.begin()) +
                  " has no surface; remove the tag of the hole, or take another boundary rule");
  }
}

// Result of a step, at a vertex, for values that alternate along all edges.
enum class Alternating : std::uint8_t { vanishes, stays, unknown };

Alternating fate_at(const RuledMesh& ruled, VertexId v, Star& star) {
  if (ruled.options.scheme == Scheme::midedge) return Alternating::vanishes;
  gather_star(ruled, v, star);
  const std::size_t valence = star.spokes.size();
  if (vertex_rule(star) == VertexRule::smooth) {
    return valence == 3 ? Alternating::vanishes : Alternating::stays;
  }
  return valence == 2 && !is_stationary(star) ? Alternating::unknown : Alternating::stays;
}

// A component in two colours.
struct Colouring {
  std::vector<VertexId> vertices;
  bool two_colours = true, vanishes = true;
  VertexId unknown;
};

// Colours the component of `first`, along edges of faces with a surface, by 1 and -1 in `signs`, where 0 is
// not yet met.
Colouring colour(const RuledMesh& ruled, const std::vector<bool>& without_surface, VertexId first,
                 std::vector<std::int8_t>& signs) {
  const Topology& topology = ruled.topology;
  Colouring result;
  Star star;
  signs[first.index()] = 1;
  result.vertices.push_back(first);
  for (std::size_t next = 0; next < result.vertices.size(); ++next) {
    const VertexId v = result.vertices[next];
    const std::int8_t sign = signs[v.index()];
    // Faces are cycles: edges that leave vertices lead everywhere.
    walk_fans(topology, v, [&](HalfEdge h) {
      if (without_surface[topology.face_of(h).index()]) return;
      const VertexId end = topology.to(h);
      std::int8_t& other = signs[end.index()];
      if (other == 0) {
        other = static_cast<std::int8_t>(-sign);
        result.vertices.push_back(end);
      } else if (other == sign) {
        result.two_colours = false;
      }
    });
    if (!result.vanishes || !result.two_colours) continue;
    const Alternating fate = fate_at(ruled, v, star);
    if (fate == Alternating::stays) result.vanishes = false;
    if (fate == Alternating::unknown) result.unknown = v;
  }
  return result;
}

// Vertices of faces with a surface.
std::vector<bool> used_vertices(const Topology& topology, const std::vector<bool>& without_surface) {
  std::vector<bool> used(topology.vertex_count(), false);
  for (std::size_t f = 0; f < without_surface.size(); ++f) {
    if (without_surface[f]) continue;
    for (const VertexId v : topology.face(FaceId(f))) used[v.index()] = true;
  }
  return used;
}

// Adds a vector for each component whose alternating values vanish.
void add_alternating(const RuledMesh& ruled, const std::vector<bool>& without_surface,
                     const std::vector<bool>& used, const WorkMonitor& monitor,
                     std::vector<KernelVector>& out) {
  std::vector<std::int8_t> signs(used.size(), 0);
  for (std::size_t v = 0; v < used.size(); ++v) {
    monitor.checkpoint();
    if (signs[v] != 0 || !used[v]) continue;
    Colouring found = colour(ruled, without_surface, VertexId(v), signs);
    if (!found.two_colours || !found.vanishes) continue;
    if (found.unknown.valid()) {
      refuse_kernel("vertex " + std::to_string(found.unknown.index()) +
                    " has two edges, and sharpness that decays; give infinite sharpness or none");
    }
    std::sort(found.vertices.begin(), found.vertices.end());
    KernelVector vector{std::move(found.vertices), {}};
    for (const VertexId u : vector.vertices) vector.signs.push_back(signs[u.index()]);
    out.push_back(std::move(vector));
  }
}

}  // namespace

MeshKernel mesh_kernel(const ControlMesh& mesh, const SchemeOptions& options, const WorkMonitor& monitor) {
  const SchemeOptions how = with_tags(options, mesh.tags);
  const SchemeRules& rules = rules_of(how.scheme);
  const Topology topology = require_surface(mesh, how);
  const Sharpness sharpness = rules.primal ? sharpness_of(mesh, topology) : Sharpness{};
  const RuledMesh ruled{topology, how, sharpness};
  const std::vector<bool> without_surface = faces_without_surface(mesh, ruled),
                          used = used_vertices(topology, without_surface);

  MeshKernel kernel;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) kernel.vectors.push_back({{VertexId(v)}, {1}});
  }
  if (rules.local) return kernel;
  if (rules.primal) require_manifold_with_surfaces(topology, without_surface);
  if (how.scheme == Scheme::doo_sabin) require_small_faces(topology, without_surface);
  if (how.scheme == Scheme::catmark || how.scheme == Scheme::midedge) {
    add_alternating(ruled, without_surface, used, monitor, kernel.vectors);
  }
  std::sort(kernel.vectors.begin(), kernel.vectors.end(), [](const KernelVector& a, const KernelVector& b) {
    return a.vertices.front() < b.vertices.front();
  });
  return kernel;
}

}  // namespace snug
