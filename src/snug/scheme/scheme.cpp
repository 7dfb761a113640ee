#include <snug/scheme/scheme.h>

#include <algorithm>
#include <string>

#include <snug/mesh/topology.h>
#include <snug/scheme/rules.h>
#include <support/error.h>

namespace snug {
namespace {

[[noreturn]] void refuse(const std::string& why) { throw InputError(InputProblem::refused, why); }

enum class Purpose : std::uint8_t { refinement, surface };

// Three vertices or more, in range: then there is a topology.
bool has_topology(const ControlMesh& mesh) {
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face(FaceId(f)).size() < 3) return false;
  }
  return std::all_of(mesh.face_vertices.begin(), mesh.face_vertices.end(),
                     [&](VertexId v) { return v.index() < mesh.vertex_count(); });
}

bool all_triangles(const ControlMesh& mesh) { return scheme_of_faces(mesh) == Scheme::loop; }

void require_sound(std::vector<Defect> refusing, const ControlMesh& mesh, const SchemeRules& rules,
                   Purpose purpose) {
  std::erase_if(refusing, [&](const Defect& defect) {
    return rules.answers(defect.kind) ||
           (purpose == Purpose::refinement && rules.primal && defect.kind == DefectKind::repeated_vertex);
  });
  if (refusing.empty()) return;
  const bool sound = std::all_of(refusing.begin(), refusing.end(),
                                 [](const Defect& defect) { return is_non_manifold(defect.kind); });
  const SchemeRules& flat = rules_of(Scheme::flat);
  const bool facets = purpose == Purpose::surface && all_triangles(mesh) &&
                      std::all_of(refusing.begin(), refusing.end(),
                                  [&](const Defect& defect) { return flat.answers(defect.kind); });
  refuse(summary(refusing) +
         (sound && !rules.primal ? "; an oriented manifold mesh is needed: mend these elements"
                                 : "; mend these elements") +
         (facets ? ", or use the scheme flat, which takes the triangles as they are" : ""));
}

void require_fitting_faces(const ControlMesh& mesh, const SchemeRules& rules) {
  std::size_t others = 0, first = 0, large = mesh.face_count();
  for (std::size_t f = mesh.face_count(); f-- > 0;) {
    const std::size_t size = mesh.face(FaceId(f)).size();
    if (size != 3) ++others, first = f;
    if (size > rules.max_face_size) large = f;
  }
  const auto text = [&](std::size_t f) {
    return "face " + std::to_string(f) + " has " + std::to_string(mesh.face(FaceId(f)).size()) + " vertices";
  };
  if (rules.wants_triangles && others > 0) {
    refuse(text(first) + " (" + std::to_string(others) + " faces are not triangles); " +
           rules.wants_triangles);
  }
  if (large < mesh.face_count()) {
    refuse(text(large) + "; at most " + std::to_string(rules.max_face_size) + " are taken: split it");
  }
}

void require_valences(const Topology& topology, const SchemeRules& rules) {
  const std::size_t least = rules.min_valence, most = rules.max_valence;
  std::string text;
  std::size_t bad = 0;
  for (std::size_t i = 0; i < topology.vertex_count(); ++i) {
    const VertexId v(i);
    const std::size_t faces = topology.face_valence(v);
    if (faces >= least && faces <= most) continue;
    const bool inside = !topology.isolated(v) && topology.is_manifold(v) && !topology.on_boundary(v);
    if (faces <= most && (!inside || faces >= least)) continue;
    if (++bad <= 10) {
      text += (bad > 1 ? "; " : "") + std::string(inside ? "interior" : "boundary") + " vertex " +
              std::to_string(i) + " has " + std::to_string(faces) + " faces";
    }
  }
  if (bad == 0) return;
  if (bad > 10) text += "; and " + std::to_string(bad - 10) + " more";
  refuse(text + "; interior vertices need " + std::to_string(least) + " to " + std::to_string(most) +
         " faces, boundary ones at most " + std::to_string(most) + ": split faces there");
}

Topology require_fit_for(Purpose purpose, const ControlMesh& mesh, const SchemeOptions& options) {
  if (mesh.face_count() == 0) refuse("the mesh has no faces");
  const SchemeRules& rules = rules_of(options.scheme);
  Topology topology;
  if (has_topology(mesh)) topology = Topology(mesh);
  const bool manifold = topology.face_count() > 0 && topology.is_manifold();
  require_sound(manifold ? defects_of_elements(mesh, topology) : defects(mesh), mesh, rules, purpose);
  require_fitting_faces(mesh, rules);
  require_valences(topology, rules);
  return topology;
}

}  // namespace

const char* name_of(Scheme scheme) { return rules_of(scheme).name; }

Scheme natural_scheme(const ControlMesh& mesh) {
  return mesh.tags.scheme ? *mesh.tags.scheme : scheme_of_faces(mesh);
}

Scheme scheme_of_faces(const ControlMesh& mesh) {
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face(FaceId(f)).size() != 3) return Scheme::catmark;
  }
  return Scheme::loop;
}

bool has_rules(const MeshTags& tags) {
  return !tags.creases.empty() || !tags.corners.empty() || !tags.holes.empty() || tags.boundary ||
         tags.crease_method != CreaseMethod::uniform || tags.smooth_triangles != SmoothTriangles::catmark;
}

bool smooths_untagged(const ControlMesh& mesh) {
  return !mesh.tags.scheme && !has_rules(mesh.tags) && scheme_of_faces(mesh) == Scheme::loop;
}

SchemeOptions with_tags(SchemeOptions options, const MeshTags& tags) {
  options.creases = tags.crease_method;
  options.triangles = tags.smooth_triangles;
  return options;
}

SchemeOptions rules_for(const ControlMesh& mesh, std::optional<Scheme> scheme,
                        std::optional<BoundaryRule> boundary) {
  if (!boundary) boundary = mesh.tags.boundary.value_or(BoundaryRule::edge_and_corner);
  return {scheme ? *scheme : natural_scheme(mesh), *boundary};
}

Topology require_subdividable(const ControlMesh& mesh, const SchemeOptions& options) {
  return require_fit_for(Purpose::refinement, mesh, options);
}

Topology require_surface(const ControlMesh& mesh, const SchemeOptions& options) {
  return require_fit_for(Purpose::surface, mesh, options);
}

}  // namespace snug
