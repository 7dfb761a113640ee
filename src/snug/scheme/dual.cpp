#include <algorithm>
#include <array>
#include <utility>

#include <snug/base/contract.h>
#include <snug/scheme/rings.h>
#include <snug/scheme/row_builder.h>
#include <snug/scheme/rules.h>

// Doo-Sabin and Midedge: each corner of a face makes a vertex, quads are regular, a patch lies around a vertex.
namespace snug {
namespace {

// A mask weights the corners of a face of n vertices for the one that moves: its own first, then around.
using Mask = std::vector<Interval> (*)(std::size_t n);

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
  DualRules(const SchemeFacts& facts, Mask mask) : SchemeRules(facts), mask_(mask) {}

  // There are no faces to make at what is no manifold.
  [[nodiscard]] bool answers(DefectKind kind) const override { return is_legal(kind); }

  [[nodiscard]] RefinedTopology refine(const Topology& topology, const SchemeOptions&, const Sharpness&,
                                       const WorkMonitor& monitor) const override {
    RefinedTopology result;
    std::vector<std::uint32_t> offsets{0};
    std::vector<VertexId> new_vertices;
    const auto end_face = [&] { offsets.push_back(static_cast<std::uint32_t>(new_vertices.size())); };
    for (std::size_t f = 0; f < topology.face_count(); ++f) {
      monitor.checkpoint();
      const auto face = topology.face(FaceId(f));
      const std::size_t n = face.size();
      const std::vector<Interval> mask = mask_(n);
      for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t i = 0; i < n; ++i) {
          if (mask[i] != Interval(0)) result.stencils.add(face[(k + i) % n].value(), mask[i]);
        }
        result.stencils.end_row();
        new_vertices.emplace_back(topology.first_of(FaceId(f)) + k);
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
  void add_limit_row(const Topology& topology, VertexId v, const SchemeOptions& options, const Sharpness&,
                     Stencils& out) const override {
    if (topology.on_boundary(v)) {
      out.add(v.value(), 1.0);
      out.end_row();
      return;
    }
    std::vector<HalfEdge> firsts;
    topology.walk_fan(topology.leaving(v), [&](HalfEdge h) { firsts.push_back(h); });
    const PartOfMesh part = part_of(topology, {}, options.boundary, firsts);
    const RefinedTopology refined = refine(part.topology, options, {}, {});
    RowBuilder row;
    const Interval each = Interval(1) / Interval(static_cast<double>(firsts.size()));
    for (std::size_t f = 0; f < firsts.size(); ++f) {
      row.add(each, refined.stencils.row(part.topology.first_of(FaceId(f))));
    }
    Stencils one;
    row.end_row(one);
    std::vector<std::uint32_t> names;
    for (const VertexId own : part.names) names.push_back(own.value());
    out.append(one.row(0), names);
  }

  [[nodiscard]] Topology ring(std::span<const CornerFan> fans) const override {
    std::vector<std::size_t> sizes;
    for (const CornerFan& fan : fans) sizes.push_back(fan.faces());
    return ring_of_vertex(sizes);
  }
  // New vertex k lies in face k, near the patch's own vertex. Its faces counter-clockwise: k, the one of the edge between k
  // and k + 1, the patch's own, the one of the edge before.
  [[nodiscard]] std::vector<HalfEdge> child_starts(const Topology& ring,
                                                   const Topology& refined) const override {
    const auto around = [&](std::size_t k, std::size_t step) {
      HalfEdge h = refined.first_of(FaceId(k));
      SNUG_EXPECT(refined.from(h).index() == ring.first_of(FaceId(k)));
      for (; step > 0; --step) h = refined.ccw(h);
      return h;
    };
    if (ring.face_count() == 4) return {around(0, 0), around(1, 3), around(2, 2), around(1, 1)};
    std::vector<HalfEdge> starts;
    for (std::size_t k = 0; k < ring.face_count(); ++k) {
      starts.push_back(around(k, 0));
      starts.push_back(around(k, 2));
    }
    return starts;
  }
  // The mean of the face there.
  [[nodiscard]] bool add_corner_limit(const Topology& ring, std::size_t corner, const SchemeOptions&,
                                      const Sharpness&, Stencils& out) const override {
    RowBuilder row;
    add_mean(ring.face(FaceId(corner)), Interval(1), row);
    row.end_row(out);
    return true;
  }
  // First Fourier modes of that face, counter-clockwise.
  void add_corner_tangents(const Topology& ring, std::size_t corner, const SchemeOptions&, const Sharpness&,
                           Stencils& out) const override {
    const auto face = ring.face(FaceId(corner));
    const auto n = static_cast<unsigned>(face.size());
    for (const unsigned turn : {0u, 3 * n}) {  // sin x = cos(x - pi/2), in quarters of a step
      for (unsigned i = 0; i < n; ++i) out.add(face[i].value(), cos_of_turn((4 * i + turn) % (4 * n), 4 * n));
      out.end_row();
    }
  }

  [[nodiscard]] bool regular(const CornerFan& fan) const override { return regular_among_quads(fan); }

 private:
  Mask mask_;
};

// Nine places; the corners are faces, face 0 at the lower left. Vertices as dual neighbourhoods number them: the middle
// one, the ends of its edges (left, below, right, above), the far ones of the faces.
constexpr std::array<std::size_t, 9> biquadratic_places{5, 2, 6, 1, 0, 3, 8, 4, 7};

Lattice biquadratic_lattice() {
  Lattice lattice;
  for (const std::size_t v : biquadratic_places) lattice.push_back(unit_combination(v, 9));
  return lattice;
}

class DooSabinRules : public DualRules {
 public:
  DooSabinRules()
      : DualRules({.scheme = Scheme::doo_sabin, .name = "doo-sabin", .primal = false, .creases = false},
                  doo_sabin_mask) {}
  [[nodiscard]] BezierRows bezier(const Topology&, std::span<const CornerFan>) const override {
    return tensor_bezier(2, biquadratic_lattice());
  }
  // The first Fourier mode has 1/4 + 2 / (4n) n/2 for every n.
  [[nodiscard]] double shrink_factor(const CornerFan&) const override { return 0.5; }
};

// Two quadratics, from the values at their corners and the middles of their edges; all weights are multiples of 1/32.
// derivations/midedge_bezier.md.
Stencils midedge_rows() {
  using Row = std::array<double, 9>;
  const auto spoke = [](std::size_t k) { return 1 + k % 4; };
  const auto far = [](std::size_t k) { return 5 + k % 4; };
  const auto face = [&](std::size_t k) {
    Row r{};
    r[0] = r[spoke(k)] = r[spoke(k + 1)] = r[far(k)] = 0.25;
    return r;
  };
  const auto between_faces = [&](std::size_t k) {  // the middle between faces k and k + 1
    Row r{};
    r[0] = r[spoke(k + 1)] = 6.0 / 16;
    r[spoke(k)] = r[spoke(k + 2)] = r[far(k)] = r[far(k + 1)] = 1.0 / 16;
    return r;
  };
  const auto towards_middle = [&](std::size_t k) {  // halfway from face k to the middle of the patch
    Row r{};
    r[0] = 14.0 / 32;
    r[spoke(k)] = r[spoke(k + 1)] = 7.0 / 32;
    r[far(k)] = 2.0 / 32;
    r[spoke(k + 2)] = r[spoke(k + 3)] = 1.0 / 32;
    return r;
  };
  const Row middle{0.5, 0.125, 0.125, 0.125, 0.125, 0, 0, 0, 0};
  const auto inner = [](const Row& half, const Row& a, const Row& b) {  // 2 f(1/2) - (f(0) + f(1)) / 2
    Row r{};
    for (std::size_t c = 0; c < 9; ++c) r[c] = 2 * half[c] - (a[c] + b[c]) / 2;
    return r;
  };
  Stencils out;
  const auto add = [&](const Row& row) {
    for (std::size_t c = 0; c < 9; ++c) {
      if (row[c] != 0) out.add(static_cast<std::uint32_t>(c), row[c]);
    }
    out.end_row();
  };
  const auto spine = [&](std::size_t k) { return inner(towards_middle(k), face(k), middle); };
  const auto side = [&](std::size_t k) { return inner(between_faces(k), face(k), face(k + 1)); };
  for (const Row& row : {face(0), side(0), face(1), spine(0), spine(1), middle}) add(row);
  for (const Row& row : {middle, spine(1), face(1), spine(2), side(1), face(2)}) add(row);
  return out;
}

constexpr std::array midedge_names{"mid-edge"};

class MidedgeRules : public DualRules {
 public:
  MidedgeRules()
      : DualRules({.scheme = Scheme::midedge,
                   .name = "midedge",
                   .other_names = midedge_names,
                   .primal = false,
                   .creases = false},
                  midedge_mask) {}
  [[nodiscard]] BezierRows bezier(const Topology&, std::span<const CornerFan>) const override {
    return {2, 2, midedge_rows()};
  }
  // Modes 1 and n - 1; for n = 3 there are no others, and 1/4 is what remains.
  [[nodiscard]] double shrink_factor(const CornerFan& fan) const override {
    return 0.5 + 0.5 * middle(cos_of_turn(1, static_cast<unsigned>(fan.faces())));
  }
};

}  // namespace

const SchemeRules& doo_sabin_rules() {
  static const DooSabinRules rules;
  return rules;
}

const SchemeRules& midedge_rules() {
  static const MidedgeRules rules;
  return rules;
}

}  // namespace snug
