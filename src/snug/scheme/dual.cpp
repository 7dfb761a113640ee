#include <array>
#include <utility>

#include <snug/scheme/rules.h>
#include <support/contract.h>

// Doo-Sabin and Midedge: each corner of a face makes a vertex, quads are regular, a patch is a vertex's.
namespace snug {
namespace {

// A mask weights the corners of a face of n vertices for the one that moves: its own first, then around.
using CornerMask = std::vector<Interval> (*)(std::size_t n);

// a_0 = 1/4 + 5/(4n), a_i = (3 + 2 cos(2 pi i/n)) / (4n).  [DooSabin78]
std::vector<Interval> doo_sabin_mask(std::size_t n) {
  if (n == 4) return {0.5625, 0.1875, 0.0625, 0.1875};
  std::vector<Interval> mask;
  const Interval quarter_n = 4 * static_cast<double>(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Interval cosine = cos_of_turn(static_cast<unsigned>(i), static_cast<unsigned>(n));
    mask.push_back((Interval(3) + Interval(2) * cosine) / quarter_n);
  }
  mask[0] = Interval(0.25) + Interval(5) / quarter_n;
  return mask;
}

// v/2 + prev/4 + next/4: two steps of edge midpoints.  [PetersReif97]
std::vector<Interval> midedge_mask(std::size_t n) {
  std::vector<Interval> mask(n, 0.0);
  mask[0] = 0.5;
  mask[1] = mask[n - 1] = 0.25;
  return mask;
}

class DualRules : public SchemeRules {
 public:
  DualRules(const SchemeFacts& facts, CornerMask mask) : SchemeRules(facts), mask_(mask) {}

  // There are no faces to make at what is no manifold.
  [[nodiscard]] bool answers(DefectKind kind) const override { return is_legal(kind); }

  [[nodiscard]] RefinedTopology refine(const RuledMesh& mesh, const WorkMonitor& monitor) const override {
    const Topology& topology = mesh.topology;
    RefinedTopology result;
    std::vector<std::uint32_t> offsets{0};
    std::vector<VertexId> new_vertices;
    const auto end_face = [&] { offsets.push_back(static_cast<std::uint32_t>(new_vertices.size())); };
    for (std::size_t f = 0; f < topology.face_count(); ++f) {
      monitor.checkpoint();
      const HalfEdge first = topology.first_of(FaceId(f));
      const std::vector<Interval> mask = mask_(topology.face(FaceId(f)).size());
      for (HalfEdge h = first; h < first + mask.size(); ++h) {
        add_new_vertex(topology, h, mask, result.stencils);
        new_vertices.emplace_back(h);
      }
      end_face();
    }
    for (std::size_t e = 0; e < topology.edge_count(); ++e) {
      monitor.checkpoint();
      const HalfEdge h = topology.half_of(EdgeId(e)), g = topology.twin(h);
      if (g == no_half_edge) continue;
      for (const HalfEdge corner : {topology.next(h), h, topology.next(g), g})
        new_vertices.emplace_back(corner);
      end_face();
    }
    for (std::size_t v = 0; v < topology.vertex_count(); ++v) {
      if (topology.isolated(VertexId(v)) || topology.on_boundary(VertexId(v))) continue;
      topology.walk_fan(topology.leaving(VertexId(v)), [&](HalfEdge h) { new_vertices.emplace_back(h); });
      end_face();
    }
    result.topology = Topology(std::move(offsets), std::move(new_vertices), topology.half_edge_count());
    return result;
  }

  // The middle of a vertex's patch: the mean of the corners of its own new face.
  void add_limit_row(const RuledMesh& mesh, VertexId v, Stencils& out) const override {
    const Topology& topology = mesh.topology;
    if (topology.on_boundary(v)) {
      out.add_unit_row(v.value());
      return;
    }
    Stencils new_face;
    topology.walk_fan(topology.leaving(v), [&](HalfEdge h) {
      add_new_vertex(topology, h, mask_(topology.face(topology.face_of(h)).size()), new_face);
    });
    RowBuilder row;
    const Interval each = Interval(1) / Interval(static_cast<double>(new_face.row_count()));
    for (std::size_t k = 0; k < new_face.row_count(); ++k) row.add(each, new_face.row(k));
    row.end_row(out);
  }

  [[nodiscard]] Topology ring(std::span<const CornerFan> fans) const override { return ring_of_vertex(fans); }
  // New vertex k lies in face k, near the patch's own vertex. Its faces counter-clockwise: k, the one of the
  // edge between k and k + 1, the patch's own, the one of the edge before.
  [[nodiscard]] std::vector<HalfEdge> child_starts(const Topology& ring,
                                                   const Topology& refined) const override {
    const auto at = [&](std::size_t k, std::size_t step) { return around(ring, refined, k, step); };
    if (ring.face_count() == 4) return {at(0, 0), at(1, 3), at(2, 2), at(1, 1)};
    std::vector<HalfEdge> starts;
    for (std::size_t k = 0; k < ring.face_count(); ++k) {
      starts.push_back(at(k, 0));
      starts.push_back(at(k, 2));
    }
    return starts;
  }
  [[nodiscard]] HalfEdge quarter_start(const Topology& ring, const Topology& refined,
                                       std::size_t corner) const override {
    return around(ring, refined, corner, (4 - corner) % 4);
  }
  // The mean of the face there.
  [[nodiscard]] bool add_corner_limit(const RuledMesh& mesh, HalfEdge corner, Stencils& out) const override {
    RowBuilder row;
    add_mean(mesh.topology.face(mesh.topology.face_of(corner)), Interval(1), row);
    row.end_row(out);
    return true;
  }
  // First Fourier modes of that face.
  void add_corner_tangents(const RuledMesh& mesh, HalfEdge corner, Stencils& out) const override {
    const auto face = mesh.topology.face(mesh.topology.face_of(corner));
    const auto add = [&](unsigned i, const auto& wave) { out.add(face[i].value(), wave(i)); };
    add_first_modes(face.size(), add, out);
  }

  [[nodiscard]] bool regular(const CornerFan& fan) const override { return regular_among_quads(fan); }
  // As biquadratic B-splines count nine places; the corners are faces, face 0 at the lower left. Vertices as
  // rings of vertices number them: the middle one, the ends of its edges (left, below, right, above), the far
  // ones of the faces.
  [[nodiscard]] Lattice lattice(const Topology&, std::span<const CornerFan>) const override {
    constexpr std::array<std::size_t, 9> by_rows{5, 2, 6, 1, 0, 3, 8, 4, 7};
    Lattice lattice;
    for (std::size_t i = 0; i < 9; ++i) {
      lattice.push_back(unit_combination(basis == RegularBasis::biquadratic ? by_rows[i] : i, 9));
    }
    return lattice;
  }

 private:
  // The half-edge of the new vertex in face k that leaves it, so many faces counter-clockwise after that in k.
  static HalfEdge around(const Topology& ring, const Topology& refined, std::size_t k, std::size_t step) {
    HalfEdge h = refined.first_of(FaceId(k));
    SNUG_EXPECT(refined.from(h).index() == ring.first_of(FaceId(k)));
    for (; step > 0; --step) h = refined.ccw(h);
    return h;
  }
  // The vertex that half-edge h makes.
  static void add_new_vertex(const Topology& topology, HalfEdge h, const std::vector<Interval>& mask,
                             Stencils& out) {
    for (const Interval& weight : mask) {
      if (weight != Interval(0)) out.add(topology.from(h).value(), weight);
      h = topology.next(h);
    }
    out.end_row();
  }

  CornerMask mask_;
};

// Most faces at a vertex and vertices of a face. A step of Doo-Sabin takes the square of that in products, and with
// Midedge polygons hardly shrink.
constexpr std::size_t max_size = 360;

class DooSabinRules : public DualRules {
 public:
  DooSabinRules()
      : DualRules({.scheme = Scheme::doo_sabin,
                   .name = "doo-sabin",
                   .primal = false,
                   .max_valence = max_size,
                   .max_face_size = max_size,
                   .full_step = true,
                   .creases = false,
                   .basis = RegularBasis::biquadratic},
                  doo_sabin_mask) {}
  [[nodiscard]] BezierRows bezier(const Topology& ring, std::span<const CornerFan> fans) const override {
    return tensor_bezier(2, lattice(ring, fans));
  }
  // The first Fourier mode has 1/4 + 2 / (4n) n/2 for every n.
  [[nodiscard]] double shrink_factor(const CornerFan&) const override { return 0.5; }
};

// 8 times the Bezier points of two quadratics, j outermost. derivations/midedge_bezier.md
constexpr int midedge_rows[12][9]{
    {2, 2, 2, 0, 0, 2, 0, 0, 0}, {4, 0, 4, 0, 0, 0, 0, 0, 0}, {2, 0, 2, 2, 0, 0, 2, 0, 0},
    {4, 2, 2, 0, 0, 0, 0, 0, 0}, {4, 0, 2, 2, 0, 0, 0, 0, 0}, {4, 1, 1, 1, 1, 0, 0, 0, 0},
    {4, 1, 1, 1, 1, 0, 0, 0, 0}, {4, 0, 2, 2, 0, 0, 0, 0, 0}, {2, 0, 2, 2, 0, 0, 2, 0, 0},
    {4, 0, 0, 2, 2, 0, 0, 0, 0}, {4, 0, 0, 4, 0, 0, 0, 0, 0}, {2, 0, 0, 2, 2, 0, 0, 2, 0}};

constexpr std::array midedge_names{"mid-edge"};

class MidedgeRules : public DualRules {
 public:
  MidedgeRules()
      : DualRules({.scheme = Scheme::midedge,
                   .name = "midedge",
                   .other_names = midedge_names,
                   .primal = false,
                   .max_valence = max_size,
                   .max_face_size = max_size,
                   .creases = false,
                   .basis = RegularBasis::zwart_powell},
                  midedge_mask) {}
  [[nodiscard]] BezierRows bezier(const Topology&, std::span<const CornerFan>) const override {
    BezierRows out{2, 2, {}};
    for (const auto& row : midedge_rows) add_fractions(Combination(row, row + 9), 8, out.rows, 0);
    return out;
  }
  // Modes 1 and n - 1; for n = 3 there are no others, and 1/4 is what remains.
  [[nodiscard]] double shrink_factor(const CornerFan& fan) const override {
    return 0.5 + 0.5 * middle(cos_of_turn(1, static_cast<unsigned>(fan.faces())));
  }
};

}  // namespace

const SchemeRules& doo_sabin_rules() { return only<DooSabinRules>(); }
const SchemeRules& midedge_rules() { return only<MidedgeRules>(); }

}  // namespace snug
