#include <snug/scheme/scheme.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include <snug/base/error.h>
#include <snug/mesh/topology.h>
#include <snug/mesh/validate.h>

namespace snug {
namespace {

std::string number(std::size_t n) { return std::to_string(n); }

[[noreturn]] void refuse(const std::string& why) { throw InputError(InputProblem::refused, why); }

void require_manifold(const ControlMesh& mesh) {
  std::vector<Defect> refusing = defects(mesh);
  std::erase_if(refusing, [](const Defect& defect) { return is_legal(defect.kind); });
  if (refusing.empty()) return;
  refuse(summary(refusing) + "; an oriented manifold mesh is needed: mend these elements");
}

void require_triangles(const ControlMesh& mesh) {
  std::size_t others = 0, first = 0;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face(FaceId(f)).size() == 3) continue;
    if (others++ == 0) first = f;
  }
  if (others == 0) return;
  refuse("face " + number(first) + " has " + number(mesh.face(FaceId(first)).size()) + " vertices (" +
         number(others) +
         " faces are not triangles); Loop subdivision needs triangles: triangulate the mesh");
}

void require_valences(const Topology& topology) {
  std::string text;
  std::size_t bad = 0;
  for (std::size_t i = 0; i < topology.vertex_count(); ++i) {
    const VertexId v(i);
    const std::size_t faces = topology.face_valence(v);
    const bool boundary = topology.on_boundary(v);
    if (faces == 0 || (boundary ? faces <= max_boundary_faces
                                : faces >= min_interior_valence && faces <= max_interior_valence)) {
      continue;
    }
    if (++bad <= 10) {
      text += (bad > 1 ? "; " : "") + std::string(boundary ? "boundary" : "interior") + " vertex " +
              number(i) + " has " + number(faces) + " faces";
    }
  }
  if (bad == 0) return;
  if (bad > 10) text += "; and " + number(bad - 10) + " more";
  refuse(text + "; interior vertices need 3 to 1000 faces, boundary ones at most 1000: split faces there");
}

// Tags that leave the surface as it is: zero sharpness; edges that are no edges of the mesh; the boundary's
// own edges and corners, which the boundary rule makes infinitely sharp already.
void require_no_effective_tags(const ControlMesh& mesh, const Topology& topology,
                               const SchemeOptions& options) {
  const std::string until = "; creases, corners and holes are not supported yet: remove the tags";
  if (!mesh.tags.holes.empty()) {
    refuse("face " + number(mesh.tags.holes.front().index()) + " is tagged as a hole" + until);
  }
  std::set<std::pair<VertexId, VertexId>> inner;
  if (std::any_of(mesh.tags.creases.begin(), mesh.tags.creases.end(),
                  [](const CreaseTag& t) { return t.sharpness > 0; })) {
    for (std::size_t e = 0; e < topology.edge_count(); ++e) {
      const HalfEdge h = topology.half_of(EdgeId(e));
      if (!topology.on_boundary(EdgeId(e))) inner.insert(std::minmax(topology.from(h), topology.to(h)));
    }
  }
  for (const CreaseTag& tag : mesh.tags.creases) {
    if (tag.sharpness > 0 && inner.contains(std::minmax(tag.a, tag.b))) {
      refuse("edge (" + number(tag.a.index()) + ", " + number(tag.b.index()) +
             ") is tagged as a crease of sharpness " + std::to_string(tag.sharpness) + until);
    }
  }
  for (const CornerTag& tag : mesh.tags.corners) {
    const bool corner_already = options.boundary == BoundaryRule::edge_and_corner &&
                                topology.on_boundary(tag.vertex) && topology.face_valence(tag.vertex) == 1;
    if (tag.sharpness > 0 && !corner_already && !topology.isolated(tag.vertex)) {
      refuse("vertex " + number(tag.vertex.index()) + " is tagged as a corner" + until);
    }
  }
}

}  // namespace

const char* name_of(Scheme scheme) {
  switch (scheme) {
    case Scheme::loop:
      return "loop";
    case Scheme::catmark:
      return "catmark";
    case Scheme::doo_sabin:
      return "doo-sabin";
    case Scheme::midedge:
      return "midedge";
  }
  return "";
}

Scheme natural_scheme(const ControlMesh& mesh) {
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face(FaceId(f)).size() != 3) return Scheme::catmark;
  }
  return Scheme::loop;
}

void require_subdividable(const ControlMesh& mesh, const SchemeOptions& options) {
  if (mesh.face_count() == 0) refuse("the mesh has no faces");
  require_manifold(mesh);
  if (options.scheme != Scheme::loop) {
    refuse(std::string("the scheme ") + name_of(options.scheme) +
           " is not supported yet: Loop on triangle meshes is; triangulate the mesh or give --scheme loop");
  }
  require_triangles(mesh);
  const Topology topology(mesh);
  require_valences(topology);
  require_no_effective_tags(mesh, topology, options);
}

}  // namespace snug
