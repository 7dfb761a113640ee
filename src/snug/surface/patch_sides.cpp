#include <snug/surface/patch_sides.h>

namespace snug {
namespace {

using Part = PatchSide::Part;

// As LimitSurface counts the corners of an owner.
HalfEdge corner_of(const LimitSurface& surface, std::size_t owner, std::size_t k) {
  const Topology& topology = surface.topology();
  if (surface.rules().primal) return topology.first_of(FaceId(owner)) + static_cast<HalfEdge>(k);
  HalfEdge h = topology.leaving(VertexId(owner));
  for (; k > 0; --k) h = topology.ccw(h);
  return h;
}

// The half-edge on the line from a corner to the next one: of a dual scheme the one in the corner's own face.
HalfEdge after(const LimitSurface& surface, HalfEdge corner) {
  return surface.rules().primal ? corner : surface.topology().prev(corner);
}
HalfEdge before(const LimitSurface& surface, HalfEdge corner) {
  return surface.rules().primal ? surface.topology().prev(corner) : corner;
}

// Does the line from a corner to the next one run as the edge does? `h` is after() it.
bool forward_after(const LimitSurface& surface, HalfEdge h) {
  const Topology& topology = surface.topology();
  const HalfEdge half = topology.half_of(topology.edge_of(h));
  return surface.rules().primal ? topology.from(h) == topology.from(half) : h == half;
}
// The same for the line from the corner before; `h` is before() the corner.
bool forward_before(const LimitSurface& surface, HalfEdge h) {
  return surface.rules().primal ? forward_after(surface, h) : !forward_after(surface, h);
}

PatchSide whole_side(const LimitSurface& surface, std::size_t owner, std::size_t k) {
  const HalfEdge h = after(surface, corner_of(surface, owner, k));
  return {Part::whole, surface.topology().edge_of(h).value(), !forward_after(surface, h)};
}

}  // namespace

std::array<PatchSide, 3> sides_of(const LimitSurface& surface, PatchId p) {
  const auto [owner, part] = surface.place(p);
  if (surface.rules().triangular()) {
    return {whole_side(surface, owner, 0), whole_side(surface, owner, 1), whole_side(surface, owner, 2)};
  }
  const std::size_t k = part / 2;
  const bool second = part % 2 == 1;
  // Two lines a corner: those that its even and its odd part are numbered by.
  const PatchSide diagonal{Part::inside, p.value() - (second ? 1 : 0) + 1, !second};
  if (!surface.after_first_split(p)) {
    return {whole_side(surface, owner, second ? 2 : 0), whole_side(surface, owner, second ? 3 : 1), diagonal};
  }
  const Topology& topology = surface.topology();
  const HalfEdge corner = corner_of(surface, owner, k);
  const LimitSurface::PatchRange range = surface.patches_of(owner);
  if (!second) {  // corner, middle of the edge after it, centre
    const HalfEdge h = after(surface, corner);
    const bool forward = forward_after(surface, h);
    return {{{forward ? Part::first_half : Part::second_half, topology.edge_of(h).value(), !forward},
             {Part::inside, p.value(), false},
             diagonal}};
  }
  // Centre, middle of the edge before it, corner. The line from that middle is numbered by the corner before.
  const std::size_t corners = (range.end - range.begin) / 2, previous = (k + corners - 1) % corners;
  const HalfEdge h = before(surface, corner);
  const bool forward = forward_before(surface, h);
  return {{{Part::inside, static_cast<std::uint32_t>(range.begin + 2 * previous), true},
           {forward ? Part::second_half : Part::first_half, topology.edge_of(h).value(), !forward},
           diagonal}};
}

std::array<std::uint32_t, 3> ends_of(const LimitSurface& surface, EdgeId edge) {
  const Topology& topology = surface.topology();
  const HalfEdge h = topology.half_of(edge);
  const auto vertices = static_cast<std::uint32_t>(topology.vertex_count()),
             edges = static_cast<std::uint32_t>(topology.edge_count());
  const std::uint32_t middle = vertices + edge.value();
  if (surface.rules().primal) return {topology.from(h).value(), middle, topology.to(h).value()};
  const auto name = [&](HalfEdge g) { return vertices + edges + topology.face_of(g).value(); };
  return {name(h), middle, name(topology.twin(h))};
}

}  // namespace snug
