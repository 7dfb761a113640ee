#include <snug/mesh/topology.h>

#include <algorithm>
#include <array>
#include <utility>

namespace snug {

namespace {

HalfEdge uniform_size_of(const std::vector<std::uint32_t>& face_offsets) {
  if (face_offsets.size() < 2) return 0;
  const HalfEdge size = face_offsets[1];
  for (std::size_t f = 2; f < face_offsets.size(); ++f) {
    if (face_offsets[f] - face_offsets[f - 1] != size) return 0;
  }
  return size;
}

}  // namespace

Topology::Topology(std::vector<std::uint32_t> face_offsets, std::vector<VertexId> face_vertices,
                   std::size_t vertex_count)
    : face_offsets_(std::move(face_offsets)),
      uniform_size_(uniform_size_of(face_offsets_)),
      face_vertices_(std::move(face_vertices)) {
  HalfEdgeGroups groups(face_offsets_, face_vertices_, vertex_count);
  twins_.assign(face_vertices_.size(), no_half_edge);
  edges_.resize(face_vertices_.size());
  edge_half_.resize(groups.edge_count());
  const auto face_of = [&](HalfEdge h) { return uniform_size_ == 3 ? FaceId(h / 3) : groups.face(h); };
  std::vector<HalfEdge> apart;  // edges of their own
  for (std::size_t e = 0; e < groups.edge_count(); ++e) {
    const auto members = groups.of_edge(EdgeId(e));
    edge_half_[e] = members[0];
    edges_[members[0]] = EdgeId(e);
    if (members.size() == 2 && face_vertices_[members[0]] != face_vertices_[members[1]] &&
        face_of(members[0]) != face_of(members[1])) {
      edges_[members[1]] = EdgeId(e);
      twins_[members[0]] = members[1];
      twins_[members[1]] = members[0];
      continue;
    }
    const bool loop = face_vertices_[members[0]] ==
                      face_vertices_[next_in_face(face_offsets_, groups.face(members[0]), members[0])];
    if (loop) odd_.emplace_back(e);
    for (std::size_t i = 1; i < members.size(); ++i) {  // in the order of faces
      const HalfEdge h = members[i];
      if (!loop && groups.face(h) != groups.face(members[i - 1])) {
        edges_[h] = EdgeId(e);
        more_halves_.emplace_back(EdgeId(e), h);
      } else {
        apart.push_back(h);
        odd_.emplace_back(e);
      }
    }
  }
  for (const HalfEdge h : apart) {
    edges_[h] = EdgeId(edge_half_.size());
    odd_.push_back(edges_[h]);
    edge_half_.push_back(h);
  }
  odd_.erase(std::unique(odd_.begin(), odd_.end()), odd_.end());
  faces_ = groups.take_faces();
  leaving_.assign(vertex_count, no_half_edge);
  find_fans();
}

// Walks of many vertices at once: each of their steps waits for memory.
std::vector<VertexId> Topology::vertices_of_more_fans() const {
  constexpr std::size_t at_once = 16;
  std::array<HalfEdge, at_once> at;
  std::array<std::uint32_t, at_once> left;
  std::vector<VertexId> found;
  for (std::size_t begin = 0; begin < vertex_count(); begin += at_once) {
    const std::size_t count = std::min(at_once, vertex_count() - begin);
    std::copy_n(leaving_.begin() + static_cast<std::ptrdiff_t>(begin), count, at.begin());
    std::copy_n(face_counts_.begin() + static_cast<std::ptrdiff_t>(begin), count, left.begin());
    // After as many steps as there are faces less one a fan of all of them has not come round.
    bool going = true;
    while (going) {
      going = false;
      for (std::size_t i = 0; i < count; ++i) {
        if (left[i] <= 1) continue;
        const HalfEdge h = ccw(at[i]);
        at[i] = h;
        --left[i];
        if (h == no_half_edge || h == leaving_[begin + i]) {
          found.emplace_back(begin + i);
          left[i] = 0;
        }
        going = going || left[i] > 1;
      }
    }
  }
  return found;
}

void Topology::find_fans() {
  face_counts_.assign(vertex_count(), 0);
  for (HalfEdge h = 0; h < half_edge_count(); ++h) {
    HalfEdge& best = leaving_[from(h).index()];
    if (best == no_half_edge || (twins_[h] == no_half_edge && twins_[best] != no_half_edge)) best = h;
    ++face_counts_[from(h).index()];
  }
  const std::vector<VertexId> pinched = vertices_of_more_fans();
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
  std::ranges::stable_sort(more_fans_, {}, &std::pair<VertexId, HalfEdge>::first);
}

namespace {

template <class Id>
std::vector<HalfEdge> of_key(const std::vector<std::pair<Id, HalfEdge>>& pairs, Id key) {
  std::vector<HalfEdge> found;
  auto it = std::ranges::lower_bound(pairs, key, {}, &std::pair<Id, HalfEdge>::first);
  for (; it != pairs.end() && it->first == key; ++it) found.push_back(it->second);
  return found;
}

}  // namespace

std::vector<HalfEdge> Topology::more_halves(EdgeId e) const { return of_key(more_halves_, e); }
std::vector<HalfEdge> Topology::more_fans(VertexId v) const { return of_key(more_fans_, v); }

bool Topology::is_manifold(EdgeId e) const {
  if (!ends_fans(e) || is_manifold()) return true;
  return more_halves(e).empty() && !std::binary_search(odd_.begin(), odd_.end(), e);
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

}  // namespace snug
