#include <snug/mesh/topology.h>

#include <algorithm>
#include <utility>

namespace snug {

Topology::Topology(const ControlMesh& mesh)
    : face_offsets_(mesh.face_offsets), face_vertices_(mesh.face_vertices) {
  connect(mesh.vertex_count());
}

Topology::Topology(std::vector<std::uint32_t> face_offsets, std::vector<VertexId> face_vertices,
                   std::size_t vertex_count)
    : face_offsets_(std::move(face_offsets)), face_vertices_(std::move(face_vertices)) {
  connect(vertex_count);
}

void Topology::connect(std::size_t vertex_count) {
  HalfEdgeGroups groups(face_offsets_, face_vertices_, vertex_count);
  twins_.assign(face_vertices_.size(), no_half_edge);
  edges_.resize(face_vertices_.size());
  edge_half_.resize(groups.edge_count());
  for (std::size_t e = 0; e < groups.edge_count(); ++e) {
    const auto members = groups.of_edge(EdgeId(e));
    edge_half_[e] = members[0];
    for (const HalfEdge h : members) edges_[h] = EdgeId(e);
    if (members.size() == 2 && face_vertices_[members[0]] != face_vertices_[members[1]] &&
        groups.face(members[0]) != groups.face(members[1])) {
      twins_[members[0]] = members[1];
      twins_[members[1]] = members[0];
    } else {
      for (const HalfEdge h : members.subspan(1)) more_halves_.emplace_back(EdgeId(e), h);
    }
  }
  faces_ = groups.take_faces();
  leaving_.assign(vertex_count, no_half_edge);
  find_fans();
}

void Topology::find_fans() {
  std::vector<std::uint32_t> corners(vertex_count(), 0);
  for (HalfEdge h = 0; h < half_edge_count(); ++h) {
    HalfEdge& best = leaving_[from(h).index()];
    if (best == no_half_edge || twins_[h] == no_half_edge) best = h;
    ++corners[from(h).index()];
  }
  std::vector<VertexId> pinched;
  for (std::size_t i = 0; i < vertex_count(); ++i) {
    if (corners[i] == 0) continue;
    std::uint32_t met = 0;
    walk_fan(leaving_[i], [&](HalfEdge) { ++met; });
    if (met != corners[i]) pinched.emplace_back(i);
  }
  if (pinched.empty()) return;
  std::vector<bool> is_pinched(vertex_count(), false), met(half_edge_count(), false);
  for (const VertexId v : pinched) {
    is_pinched[v.index()] = true;
    walk_fan(leaving(v), [&](HalfEdge h) { met[h] = true; });
  }
  // Open fans from their clockwise-most half-edge, then closed ones from any.
  for (const bool open : {true, false}) {
    for (HalfEdge h = 0; h < half_edge_count(); ++h) {
      if (!is_pinched[from(h).index()] || met[h] || open != (twins_[h] == no_half_edge)) continue;
      more_fans_.emplace_back(from(h), h);
      walk_fan(h, [&](HalfEdge g) { met[g] = true; });
    }
  }
  std::stable_sort(more_fans_.begin(), more_fans_.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
}

namespace {

template <class Id>
std::vector<HalfEdge> of_key(const std::vector<std::pair<Id, HalfEdge>>& pairs, Id key) {
  std::vector<HalfEdge> found;
  auto it = std::lower_bound(pairs.begin(), pairs.end(), std::pair(key, HalfEdge{0}),
                             [](const auto& a, const auto& b) { return a.first < b.first; });
  for (; it != pairs.end() && it->first == key; ++it) found.push_back(it->second);
  return found;
}

}  // namespace

std::vector<HalfEdge> Topology::more_halves(EdgeId e) const { return of_key(more_halves_, e); }
std::vector<HalfEdge> Topology::more_fans(VertexId v) const { return of_key(more_fans_, v); }

bool Topology::has_lone_face(EdgeId e) const {
  std::vector<HalfEdge> halves = more_halves(e);
  if (halves.empty() || from(half_of(e)) == to(half_of(e))) return true;
  halves.push_back(half_of(e));
  std::sort(halves.begin(), halves.end(), [&](HalfEdge g, HalfEdge h) { return face_of(g) < face_of(h); });
  return std::adjacent_find(halves.begin(), halves.end(), [&](HalfEdge g, HalfEdge h) {
           return face_of(g) == face_of(h);
         }) != halves.end();
}

bool Topology::on_boundary(VertexId v) const {
  if (isolated(v)) return false;
  if (is_manifold()) return twins_[leaving(v)] == no_half_edge;
  bool boundary = false;
  for_each_fan(v, [&](HalfEdge start) {
    walk_fan(start, [&](HalfEdge h) {
      boundary = boundary || on_boundary(edge_of(h)) || on_boundary(edge_of(prev(h)));
    });
  });
  return boundary;
}

bool Topology::is_manifold(VertexId v) const {
  if (is_manifold() || isolated(v)) return true;
  bool manifold = more_fans(v).empty();
  for_each_fan(v, [&](HalfEdge start) {
    walk_fan(start, [&](HalfEdge h) {
      manifold = manifold && is_manifold(edge_of(h)) && is_manifold(edge_of(prev(h)));
    });
  });
  return manifold;
}

std::size_t Topology::face_valence(VertexId v) const {
  std::size_t count = 0;
  for_each_fan(v, [&](HalfEdge start) { walk_fan(start, [&](HalfEdge) { ++count; }); });
  return count;
}

}  // namespace snug
