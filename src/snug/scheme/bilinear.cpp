#include <array>
#include <cstdint>

#include <snug/scheme/rules.h>

// Schemes whose limit surface is made of the faces themselves: `bilinear`, OpenSubdiv's third, has the
// bilinear patch of each quad and splits other faces into quads at the mean of their vertices and the middles
// of their edges; `flat` has triangles as they are. Nothing but a face's own vertices matters to it; tags of
// sharpness change nothing.
namespace snug {
namespace {

class LocalRules : public SchemeRules {
 public:
  // Corners that are one vertex are places of their own all the same.
  [[nodiscard]] bool answers(DefectKind kind) const override {
    return is_legal(kind) || is_non_manifold(kind);
  }

  [[nodiscard]] RefinedTopology refine(const RuledMesh& mesh, const WorkMonitor& monitor) const override {
    const Topology& topology = mesh.topology;
    RefinedTopology result;
    RowBuilder row;
    for (std::size_t v = 0; v < topology.vertex_count(); ++v) {
      monitor.checkpoint();
      add_limit_row(mesh, VertexId(v), result.stencils);
    }
    for (std::size_t e = 0; e < topology.edge_count(); ++e) {
      monitor.checkpoint();
      const HalfEdge h = topology.half_of(EdgeId(e));
      for (const VertexId end : {topology.from(h), topology.to(h)}) row.add(end.value(), 0.5);
      row.end_row(result.stencils);
    }
    if (!triangular()) add_face_means(topology, monitor, result.stencils);
    result.topology = split_faces(topology, corners);
    return result;
  }
  void add_limit_row(const RuledMesh&, VertexId v, Stencils& out) const override {
    out.add_unit_row(v.value());
  }

  [[nodiscard]] Topology ring(std::span<const CornerFan>) const override {
    const std::array<VertexId, 4> face{VertexId(0u), VertexId(1u), VertexId(2u), VertexId(3u)};
    return {{0, static_cast<std::uint32_t>(corners)}, {face.begin(), face.begin() + corners}, corners};
  }
  [[nodiscard]] bool add_corner_limit(const RuledMesh& mesh, HalfEdge corner, Stencils& out) const override {
    out.add_unit_row(mesh.topology.from(corner).value());
    return true;
  }
  void add_corner_tangents(const RuledMesh& mesh, HalfEdge corner, Stencils& out) const override {
    const Topology& topology = mesh.topology;
    for (const VertexId end : {topology.to(corner), topology.from(topology.prev(corner))}) {
      out.add(topology.from(corner).value(), -1.0);
      out.add(end.value(), 1.0);
      out.end_row();
    }
  }

  [[nodiscard]] bool regular(const CornerFan&) const override { return true; }
  [[nodiscard]] double shrink_factor(const CornerFan&) const override { return 0.5; }

 protected:
  using SchemeRules::SchemeRules;
};

constexpr std::array bilinear_names{"scheme-bilinear"};
constexpr std::array flat_names{"none"};  // USD's word for meshes that are not subdivided

class BilinearRules : public LocalRules {
 public:
  BilinearRules()
      : LocalRules({.scheme = Scheme::bilinear,
                    .name = "bilinear",
                    .other_names = bilinear_names,
                    .min_valence = 1,
                    .max_valence = SIZE_MAX,
                    .max_face_size = 1000,
                    .creases = false,
                    .local = true,
                    .basis = RegularBasis::bilinear}) {}
  [[nodiscard]] BezierRows bezier(const Topology& ring, std::span<const CornerFan> fans) const override {
    return tensor_bezier(1, lattice(ring, fans));
  }
  [[nodiscard]] Lattice lattice(const Topology&, std::span<const CornerFan>) const override {
    Lattice lattice;
    for (const std::size_t corner : {0, 1, 3, 2}) lattice.push_back(unit_combination(corner, 4));
    return lattice;
  }
};

class FlatRules : public LocalRules {
 public:
  FlatRules()
      : LocalRules({.scheme = Scheme::flat,
                    .name = "flat",
                    .other_names = flat_names,
                    .corners = 3,
                    .regular_valence = 6,
                    .min_valence = 1,
                    .max_valence = SIZE_MAX,
                    .wants_triangles =
                        "the scheme flat needs triangles: triangulate the mesh, or use the scheme "
                        "bilinear",
                    .creases = false,
                    .local = true}) {}
  [[nodiscard]] BezierRows bezier(const Topology&, std::span<const CornerFan>) const override {
    BezierRows form{1, 1, {}};
    for (const std::uint32_t corner : {0u, 1u, 2u}) form.rows.add_unit_row(corner);
    return form;
  }
  [[nodiscard]] Lattice lattice(const Topology&, std::span<const CornerFan>) const override {
    return {unit_combination(0, 3), unit_combination(1, 3), unit_combination(2, 3)};
  }
};

}  // namespace

const SchemeRules& bilinear_rules() { return only<BilinearRules>(); }
const SchemeRules& flat_rules() { return only<FlatRules>(); }

}  // namespace snug
