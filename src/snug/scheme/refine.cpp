#include <snug/scheme/refine.h>

#include <cmath>
#include <numbers>

#include <snug/base/contract.h>
#include <snug/scheme/loop_masks.h>

namespace snug {
namespace {

// Neighbours of v, counter-clockwise; at a boundary vertex from one boundary neighbour to the other.
void collect_ring(const Topology& topology, VertexId v, std::vector<VertexId>& ring) {
  ring.clear();
  const HalfEdge start = topology.leaving(v);
  HalfEdge h = start;
  while (true) {
    ring.push_back(topology.to(h));
    const HalfEdge after = topology.ccw(h);
    if (after == no_half_edge) {
      ring.push_back(topology.from(topology.prev(h)));
      return;
    }
    if (after == start) return;
    h = after;
  }
}

void add_vertex_row(const Topology& topology, VertexId v, const SchemeOptions& options,
                    std::vector<VertexId>& ring, Stencils& out) {
  if (topology.isolated(v) || is_sharp_corner(topology, v, options)) {
    out.add(v.value(), 1.0);
  } else {
    collect_ring(topology, v, ring);
    if (topology.on_boundary(v)) {
      out.add(v.value(), loop::curve_centre);
      out.add(ring.front().value(), loop::curve_side);
      out.add(ring.back().value(), loop::curve_side);
    } else {
      const loop::RingMask mask = loop::vertex_mask(ring.size());
      out.add(v.value(), mask.centre);
      for (const VertexId w : ring) out.add(w.value(), mask.each);
    }
  }
  out.end_row();
}

void add_edge_row(const Topology& topology, EdgeId e, Stencils& out) {
  const HalfEdge h = topology.half_of(e);
  const bool boundary = topology.on_boundary(e);
  const double end = boundary ? loop::curve_edge_end : loop::edge_end;
  out.add(topology.from(h).value(), end);
  out.add(topology.to(h).value(), end);
  if (!boundary) {
    out.add(topology.from(topology.prev(h)).value(), loop::edge_wing);
    out.add(topology.from(topology.prev(topology.twin(h))).value(), loop::edge_wing);
  }
  out.end_row();
}

}  // namespace

bool is_sharp_corner(const Topology& topology, VertexId v, const SchemeOptions& options) {
  return options.boundary == BoundaryRule::edge_and_corner && topology.on_boundary(v) &&
         topology.ccw(topology.leaving(v)) == no_half_edge;
}

RefinedTopology refine(const Topology& topology, const SchemeOptions& options) {
  SNUG_EXPECT(options.scheme == Scheme::loop);
  const std::size_t vertices = topology.vertex_count(), edges = topology.edge_count();
  RefinedTopology result;
  result.stencils.reserve(vertices + edges, 7 * vertices + 4 * edges);
  std::vector<VertexId> ring;
  for (std::size_t v = 0; v < vertices; ++v)
    add_vertex_row(topology, VertexId(v), options, ring, result.stencils);
  for (std::size_t e = 0; e < edges; ++e) add_edge_row(topology, EdgeId(e), result.stencils);

  std::vector<std::uint32_t> offsets(4 * topology.face_count() + 1);
  for (std::size_t f = 0; f < offsets.size(); ++f) offsets[f] = static_cast<std::uint32_t>(3 * f);
  std::vector<VertexId> corners;
  corners.reserve(12 * topology.face_count());
  for (std::size_t f = 0; f < topology.face_count(); ++f) {
    const HalfEdge h = topology.first_of(FaceId(f));
    const auto c = topology.face(FaceId(f));
    const auto middle = [&](HalfEdge g) { return VertexId(vertices + topology.edge_of(g).index()); };
    const VertexId m01 = middle(h), m12 = middle(h + 1), m20 = middle(h + 2);
    corners.insert(corners.end(), {c[0], m01, m20, m01, c[1], m12, m20, m12, c[2], m12, m20, m01});
  }
  result.topology = Topology(std::move(offsets), std::move(corners), vertices + edges);
  return result;
}

void add_limit_row(const Topology& topology, VertexId v, const SchemeOptions& options, Stencils& out) {
  const bool boundary = topology.on_boundary(v);
  if (topology.isolated(v) || is_sharp_corner(topology, v, options) ||
      (boundary && options.boundary == BoundaryRule::none)) {
    out.add(v.value(), 1.0);
  } else {
    std::vector<VertexId> ring;
    collect_ring(topology, v, ring);
    const loop::RingMask mask = boundary ? loop::curve_limit_mask() : loop::limit_mask(ring.size());
    out.add(v.value(), mask.centre);
    if (boundary) {
      out.add(ring.front().value(), mask.each);
      out.add(ring.back().value(), mask.each);
    } else {
      for (const VertexId w : ring) out.add(w.value(), mask.each);
    }
  }
  out.end_row();
}

Stencils limit_stencils(const Topology& topology, const SchemeOptions& options) {
  Stencils out;
  out.reserve(topology.vertex_count(), 7 * topology.vertex_count());
  for (std::size_t v = 0; v < topology.vertex_count(); ++v)
    add_limit_row(topology, VertexId(v), options, out);
  return out;
}

TangentRows tangent_rows(const Topology& topology, VertexId v, const SchemeOptions& options) {
  TangentRows result;
  Stencils& out = result.rows;
  std::vector<VertexId> ring;
  collect_ring(topology, v, ring);
  const std::size_t n = ring.size();
  if (!topology.on_boundary(v)) {
    // Left eigenvectors of 3/8 + cos(2 pi/n)/4: the first Fourier mode of the ring.
    for (std::size_t i = 0; i < n; ++i)
      out.add(ring[i].value(), cos_of_turn(static_cast<unsigned>(i), static_cast<unsigned>(n)));
    out.end_row();
    for (std::size_t i = 0; i < n; ++i) {  // sin x = cos(x - pi/2), in quarters of a step
      const auto quarters = static_cast<unsigned>(4 * i + 3 * n);
      out.add(ring[i].value(), cos_of_turn(quarters, static_cast<unsigned>(4 * n)));
    }
    out.end_row();
    return result;
  }
  if (is_sharp_corner(topology, v, options)) {
    for (const VertexId w : ring) {
      out.add(v.value(), -1.0);
      out.add(w.value(), 1.0);
      out.end_row();
    }
    return result;
  }
  // Along the boundary, with the surface on the left: from the last neighbour to the first, as the boundary
  // runs through v into the face that leaves by ring.front().
  out.add(ring.front().value(), 1.0);
  out.add(ring.back().value(), -1.0);
  out.end_row();
  const std::size_t faces = n - 1;
  if (faces == 1) {
    out.add(v.value(), -2.0);
    out.add(ring.front().value(), 1.0);
    out.add(ring.back().value(), 1.0);
  } else {
    // Left eigenvector of 3/8 + cos(t)/4, t = pi/faces: sin(i t) on the inner neighbours, which fixes the
    // rest.
    const double t = std::numbers::pi / static_cast<double>(faces);
    const double eigenvalue = 0.375 + 0.25 * std::cos(t);
    double inner_sum = 0;
    for (std::size_t i = 1; i < faces; ++i) {
      const double w = std::sin(static_cast<double>(i) * t);
      inner_sum += w;
      out.add(ring[i].value(), w);
    }
    // Column of an end:    x/8 + s/8 + e/2 = lambda e           (s = sin t, weight of the first inner
    // neighbour) Column of v:         3x/4 + 3/8 inner_sum + e = lambda x  (two ends of weight e)
    const double s = std::sin(t);
    // From the sum of all weights being 0 (an eigenvector for lambda != 1 kills constants): x + inner_sum + 2
    // e = 0.
    const double e = (s - inner_sum) / (8 * eigenvalue - 2);
    const double x = -inner_sum - 2 * e;
    out.add(v.value(), x);
    out.add(ring.front().value(), e);
    out.add(ring.back().value(), e);
  }
  out.end_row();
  return result;
}

ControlMesh refine(const ControlMesh& mesh, const SchemeOptions& options) {
  const RefinedTopology refined = refine(Topology(mesh), options);
  ControlMesh result;
  result.points.reserve(refined.stencils.row_count());
  for (std::size_t r = 0; r < refined.stencils.row_count(); ++r) {
    result.points.push_back(refined.stencils.apply<Point3>(r, mesh.points));
  }
  for (std::size_t f = 0; f < refined.topology.face_count(); ++f)
    result.add_face(refined.topology.face(FaceId(f)));
  result.tags.boundary = mesh.tags.boundary;
  return result;
}

}  // namespace snug
