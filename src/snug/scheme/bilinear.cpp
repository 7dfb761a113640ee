#include <array>
#include <cstdint>

#include <snug/scheme/row_builder.h>
#include <snug/scheme/rules.h>

// Schemes whose limit surface is made of the faces themselves: `bilinear`, OpenSubdiv's third, has the bilinear patch of
// each quad and splits other faces into quads at the mean of their vertices and the middles of their edges; `flat` has
// triangles as they are. Nothing but a face's own vertices matters to it; tags of sharpness change nothing.
namespace snug {
namespace {

class LocalRules : public SchemeRules {
 public:
  // Corners that are one vertex are places of their own all the same.
  [[nodiscard]] bool answers(DefectKind kind) const override {
    return is_legal(kind) || is_non_manifold(kind);
  }

  [[nodiscard]] RefinedTopology refine(const Topology& topology, const SchemeOptions&, const Sharpness&,
                                       const WorkMonitor& monitor) const override {
    RefinedTopology result;
    RowBuilder row;
    for (std::size_t v = 0; v < topology.vertex_count(); ++v) {
      monitor.checkpoint();
      add_vertex(VertexId(v), result.stencils);
    }
    for (std::size_t e = 0; e < topology.edge_count(); ++e) {
      monitor.checkpoint();
      const HalfEdge h = topology.half_of(EdgeId(e));
      for (const VertexId end : {topology.from(h), topology.to(h)}) row.add(end.value(), 0.5);
      row.end_row(result.stencils);
    }
    for (std::size_t f = 0; f < topology.face_count() && !triangular(); ++f) {
      monitor.checkpoint();
      add_mean(topology.face(FaceId(f)), Interval(1), row);
      row.end_row(result.stencils);
    }
    result.topology = split_faces(topology, corners);
    return result;
  }
  void add_limit_row(const Topology&, VertexId v, const SchemeOptions&, const Sharpness&,
                     Stencils& out) const override {
    add_vertex(v, out);
  }

  [[nodiscard]] Topology ring(std::span<const CornerFan>) const override {
    const std::array<VertexId, 4> face{VertexId(0u), VertexId(1u), VertexId(2u), VertexId(3u)};
    return {{0, static_cast<std::uint32_t>(corners)}, {face.begin(), face.begin() + corners}, corners};
  }
  [[nodiscard]] bool add_corner_limit(const Topology& ring, std::size_t corner, const SchemeOptions&,
                                      const Sharpness&, Stencils& out) const override {
    add_vertex(ring.face(FaceId(0))[corner], out);
    return true;
  }
  void add_corner_tangents(const Topology& ring, std::size_t corner, const SchemeOptions&, const Sharpness&,
                           Stencils& out) const override {
    const auto face = ring.face(FaceId(0));
    for (const std::size_t step : {std::size_t{1}, face.size() - 1}) {
      out.add(face[corner].value(), -1.0);
      out.add(face[(corner + step) % face.size()].value(), 1.0);
      out.end_row();
    }
  }

  [[nodiscard]] bool regular(const CornerFan&) const override { return true; }
  [[nodiscard]] double shrink_factor(const CornerFan&) const override { return 0.5; }

 protected:
  using SchemeRules::SchemeRules;

 private:
  static void add_vertex(VertexId v, Stencils& out) {
    out.add(v.value(), 1.0);
    out.end_row();
  }
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
                    .creases = false,
                    .local = true}) {}
  [[nodiscard]] BezierRows bezier(const Topology&, std::span<const CornerFan>) const override {
    Lattice lattice;
    for (const std::size_t corner : {0, 1, 3, 2}) lattice.push_back(unit_combination(corner, 4));
    return tensor_bezier(1, lattice);
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
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      form.rows.add(corner, 1.0);
      form.rows.end_row();
    }
    return form;
  }
};

}  // namespace

const SchemeRules& bilinear_rules() {
  static const BilinearRules rules;
  return rules;
}

const SchemeRules& flat_rules() {
  static const FlatRules rules;
  return rules;
}

}  // namespace snug
