#include <snug/independence/mesh_kernel.h>

#include <algorithm>
#include <string>
#include <utility>

#include <snug/error.h>
#include <snug/mesh/topology.h>
#include <snug/scheme/creases.h>
#include <snug/scheme/rules.h>

namespace snug {
namespace {

[[noreturn]] void refuse(const std::string& why) {
  throw InputError(InputProblem::refused, "the kernel of the mesh is not decided: " + why);
}

std::string name_of_edge(const Topology& topology, EdgeId e) {
  const HalfEdge h = topology.half_of(e);
  const auto [a, b] = std::minmax({topology.from(h).index(), topology.to(h).index()});
  return "edge (" + std::to_string(a) + ", " + std::to_string(b) + ")";
}

// Has a face no surface?
std::vector<bool> bare_faces(const ControlMesh& mesh, const RuledMesh& ruled) {
  std::vector<bool> bare(mesh.face_count(), false);
  for (const FaceId f : mesh.tags.holes) bare[f.index()] = true;
  if (ruled.options.boundary == BoundaryRule::none) {
    for (std::size_t f = 0; f < bare.size(); ++f) {
      bare[f] = bare[f] || loses_surface(ruled.topology, ruled.sharpness, FaceId(f));
    }
  }
  return bare;
}

void require_closed(const Topology& topology) {
  for (std::size_t e = 0; e < topology.edge_count(); ++e) {
    if (!topology.ends_fans(EdgeId(e))) continue;
    refuse(name_of_edge(topology, EdgeId(e)) +
           " is on the boundary, and the scheme is dual; close the mesh, or take loop or catmark");
  }
}

void require_manifold_with_surfaces(const Topology& topology, const std::vector<bool>& bare) {
  if (!topology.is_manifold()) refuse("it is not manifold; 'snug info' names where, mend it");
  const auto first = std::find(bare.begin(), bare.end(), true);
  if (first != bare.end()) {
    refuse("face " + std::to_string(first - bare.begin()) +
           " has no surface; remove the tag of the hole, or take another boundary rule");
  }
}

// What a step makes of values that alternate along all edges, at a vertex.
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

// Colours the component of `first` by 1 and -1 in `signs`, where 0 is not yet met.
Colouring colour(const RuledMesh& ruled, VertexId first, std::vector<std::int8_t>& signs) {
  Colouring result;
  Star star;
  signs[first.index()] = 1;
  result.vertices.push_back(first);
  for (std::size_t next = 0; next < result.vertices.size(); ++next) {
    const VertexId v = result.vertices[next];
    const std::int8_t sign = signs[v.index()];
    walk_edges(ruled.topology, v, [&](EdgeId, VertexId end) {
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

// Adds a vector for each component whose alternating values vanish.
void add_alternating(const RuledMesh& ruled, const WorkMonitor& monitor, std::vector<KernelVector>& out) {
  const std::size_t count = ruled.topology.vertex_count();
  std::vector<std::int8_t> signs(count, 0);
  for (std::size_t v = 0; v < count; ++v) {
    monitor.checkpoint();
    if (signs[v] != 0 || ruled.topology.isolated(VertexId(v))) continue;
    Colouring found = colour(ruled, VertexId(v), signs);
    if (!found.two_colours || !found.vanishes) continue;
    if (found.unknown.valid()) {
      refuse("vertex " + std::to_string(found.unknown.index()) +
             " has two edges, and sharpness that decays; give infinite sharpness or none");
    }
    std::sort(found.vertices.begin(), found.vertices.end());
    KernelVector vector{std::move(found.vertices), {}};
    for (const VertexId u : vector.vertices) vector.signs.push_back(signs[u.index()]);
    out.push_back(std::move(vector));
  }
}

// Adds a vector for each vertex that no face with a surface uses.
void add_unused(const ControlMesh& mesh, const std::vector<bool>& bare, std::vector<KernelVector>& out) {
  std::vector<bool> used(mesh.vertex_count(), false);
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    if (!bare.empty() && bare[f]) continue;
    for (const VertexId v : mesh.face(FaceId(f))) used[v.index()] = true;
  }
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) out.push_back({{VertexId(v)}, {1}});
  }
}

}  // namespace

MeshKernel mesh_kernel(const ControlMesh& mesh, const SchemeOptions& options, const WorkMonitor& monitor) {
  const SchemeOptions how = with_tags(options, mesh.tags);
  const SchemeRules& rules = rules_of(how.scheme);
  const Topology topology = require_surface(mesh, how);
  const Sharpness sharpness = rules.primal ? sharpness_of(mesh, topology) : Sharpness{};
  const RuledMesh ruled{topology, how, sharpness};
  const std::vector<bool> bare = rules.primal ? bare_faces(mesh, ruled) : std::vector<bool>{};

  MeshKernel kernel;
  add_unused(mesh, bare, kernel.vectors);
  if (rules.local) return kernel;
  if (rules.primal) {
    require_manifold_with_surfaces(topology, bare);
  } else {
    require_closed(topology);
  }
  if (how.scheme == Scheme::catmark || how.scheme == Scheme::midedge) {
    add_alternating(ruled, monitor, kernel.vectors);
  }
  std::sort(kernel.vectors.begin(), kernel.vectors.end(), [](const KernelVector& a, const KernelVector& b) {
    return a.vertices.front() < b.vertices.front();
  });
  return kernel;
}

}  // namespace snug
