#include <snug/patch/neighbourhood.h>

#include <algorithm>
#include <bit>
#include <utility>

#include <snug/scheme/refine.h>
#include <snug/scheme/rules.h>
#include <support/compact_numbering.h>
#include <support/contract.h>

namespace snug {
namespace {

class Hash {
 public:
  void mix(std::uint64_t word) {
    hash_ = (hash_ ^ word) * 0x9e3779b97f4a7c15u;
    hash_ ^= hash_ >> 31;
  }
  void mix(const std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (values[i] == 0) continue;
      mix(i);
      mix(std::bit_cast<std::uint64_t>(values[i]));
    }
  }
  [[nodiscard]] std::size_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0;
};

// A corner as its patch sees it.
struct CornerView {
  CornerFan fan;                   // when all that decays has decayed
  bool plain;                      // the fan says everything
  bool own_fan_is_enough = false;  // no other fan at the vertex matters
};

CornerView view_of(const Topology& topology, const Sharpness& sharpness, HalfEdge corner,
                   const SchemeOptions& options) {
  const SchemeRules& rules = rules_of(options.scheme);
  if (rules.local) return {{}, true};
  CornerView view{{0, 0, false, false, false}, true};
  CornerFan& fan = view.fan;
  // Most vertices are of this sort: no need to walk around them.
  if (rules.triangular() && sharpness.none() && topology.is_manifold() &&
      !topology.on_boundary(topology.from(corner))) {
    const std::size_t faces = topology.face_valence(topology.from(corner));
    fan.after = static_cast<std::uint16_t>(faces - 1);
    fan.closed = true;
    view.plain = faces >= 3;
    return view;
  }
  const auto is_standard = [&](HalfEdge h) {
    return topology.face(topology.face_of(h)).size() == rules.corners;
  };
  bool cutting = false;
  const VertexId v = topology.from(corner);
  if (!sharpness.none() || !topology.is_manifold()) {
    thread_local Star star;
    gather_star({topology, options, sharpness}, v, star);
    view.plain = is_stationary(star);
    const auto infinite = std::count_if(star.spokes.begin(), star.spokes.end(), [](const Spoke& spoke) {
      return spoke.sharpness >= infinite_sharpness;
    });
    fan.sharp = star.sharpness >= infinite_sharpness || infinite > 2;
    cutting = fan.sharp || infinite == 2;
    fan.odd = !cutting && infinite == 1;
  }
  const bool stationary = view.plain;
  const auto ends = [&](HalfEdge h) {  // may the fan not go on across this half-edge?
    const EdgeId e = topology.edge_of(h);
    return topology.ends_fans(e) ||
           (cutting && !sharpness.edges.empty() && sharpness.edges[e.index()] >= infinite_sharpness);
  };
  HalfEdge h = corner;
  bool standard = is_standard(h);
  while (!ends(topology.prev(h))) {
    h = topology.ccw(h);
    if (h == corner) {
      fan.closed = true;
      break;
    }
    ++fan.after;
    standard = standard && is_standard(h);
  }
  if (fan.closed) {
    fan.odd = fan.odd || (cutting && !fan.sharp);
    view.plain = view.plain && standard && !fan.odd && fan.faces() >= 3;
    return view;
  }
  const EdgeId last = topology.edge_of(topology.prev(h));
  for (h = corner; !ends(h);) {
    h = topology.cw(h);
    ++fan.before;
    standard = standard && is_standard(h);
  }
  // From an edge of many faces, or a cut, back to it. At a crease it goes on elsewhere; at a corner the first
  // and the last vertex of the fan are one, which vertices of three faces beside it, or a fan of one's own,
  // cannot tell.
  fan.odd = fan.odd || (cutting && topology.edge_of(h) == last);
  if (!cutting && !fan.odd) {  // the short way: nothing is sharp but what connectivity makes so
    fan.sharp = vertex_sharpness(topology, sharpness, v, options.boundary) >= infinite_sharpness;
  }
  view.plain = view.plain && standard && !fan.odd;
  // Where the vertex stays, or lies on a crease that the fan ends at on both sides. Sharpness that is averaged sees all edges.
  view.own_fan_is_enough =
      options.creases == CreaseMethod::uniform && (fan.sharp || (stationary && !fan.odd));
  return view;
}

KindKey dual_key(const Topology& topology, HalfEdge start, const SchemeRules& rules) {
  KindKey key{rules.scheme};
  std::vector<CornerFan> fans;
  topology.walk_fan(start, [&](HalfEdge h) {
    const std::size_t size = topology.face(topology.face_of(h)).size();
    fans.push_back({0, static_cast<std::uint16_t>(size - 1), true, false, false});
  });
  if (fans.size() == key.corners.size()) {
    std::copy(fans.begin(), fans.end(), key.corners.begin());
  } else {
    key.polygon = true;
    key.around = std::make_shared<Neighbourhood>(
        Neighbourhood{rules.ring(fans), {}, {rules.scheme, BoundaryRule::edge_only}});
  }
  return key;
}

// The other ends of the edges at the corners of a face, each once.
std::vector<VertexId> spoke_ends(const Topology& topology, HalfEdge start) {
  std::vector<VertexId> ends;
  HalfEdge corner = start;
  do {
    walk_edges(topology, topology.from(corner), [&](EdgeId, VertexId v) {
      if (std::find(ends.begin(), ends.end(), v) == ends.end()) ends.push_back(v);
    });
    corner = topology.next(corner);
  } while (corner != start);
  return ends;
}

// The faces around the corners of a face, its own first, each as the half-edge that leaves the corner where
// it was met: whole fans, where the own one is enough those alone that others of these faces belong to. Then, if wide, those around the
// far ends of the edges at the corners.
std::vector<HalfEdge> faces_around(const Topology& topology, HalfEdge start, Scheme scheme,
                                   const OwnFans& own_fans, bool wide) {
  if (rules_of(scheme).local) return {start};
  thread_local CompactNumbering met;
  met.begin(topology.face_count());
  std::vector<HalfEdge> found;
  const auto add = [&](HalfEdge h) {
    if (met.number(topology.face_of(h).index()) == found.size()) found.push_back(h);
  };
  add(start);
  std::vector<VertexId> seen_by_own_fan;
  HalfEdge corner = start;
  std::size_t k = 0;
  do {
    topology.walk_fan(corner, add);
    for (HalfEdge h = topology.cw(corner); h != no_half_edge && h != corner; h = topology.cw(h)) add(h);
    if (k < own_fans.size() && own_fans[k] && !topology.is_manifold()) {
      seen_by_own_fan.push_back(topology.from(corner));
    } else {
      walk_fans(topology, topology.from(corner), add);
    }
    corner = topology.next(corner);
    ++k;
  } while (corner != start);
  for (std::size_t i = 0; !seen_by_own_fan.empty() && i < found.size(); ++i) {
    HalfEdge h = found[i];
    do {
      if (std::find(seen_by_own_fan.begin(), seen_by_own_fan.end(), topology.from(h)) !=
          seen_by_own_fan.end()) {
        for (const HalfEdge beside : {topology.ccw(h), topology.cw(h)}) {
          if (beside != no_half_edge) add(beside);
        }
      }
      h = topology.next(h);
    } while (h != found[i]);
  }
  if (!wide) return found;
  for (const VertexId end : spoke_ends(topology, start)) walk_fans(topology, end, add);
  return found;
}

// Does the sharpness of edges at the corners depend on that of edges which do not touch them?
bool is_wide(const RuledMesh& mesh, HalfEdge start) {
  const auto corners = mesh.topology.face(mesh.topology.face_of(start));
  std::vector<VertexId> ends;
  for (const VertexId v : corners) add_far_ends(mesh, v, ends);
  return std::any_of(ends.begin(), ends.end(), [&](VertexId v) {
    return std::find(corners.begin(), corners.end(), v) == corners.end();
  });
}

// Keeps what is sharp at some places; nothing left is no entries.
template <class Keeps>
void keep_only(std::vector<double>& sharpness, const Keeps& keeps) {
  bool any = false;
  for (std::size_t i = 0; i < sharpness.size(); ++i) {
    if (!keeps(i)) sharpness[i] = 0;
    any = any || sharpness[i] > 0;
  }
  if (!any) sharpness.clear();
}

// The neighbourhood of a patch whose corners' fans do not determine it, with the sharpness at its corners or, if
// that depends on edges which do not touch them, at the far ends of their edges too.
std::shared_ptr<const Neighbourhood> surroundings(const Topology& topology, HalfEdge start,
                                                  const KindKey& key, const OwnFans& own_fans,
                                                  const SchemeOptions& options, const Sharpness& sharpness) {
  const bool local = rules_of(options.scheme).local;
  const bool wide = !local && is_wide({topology, options, sharpness}, start);
  PartOfMesh part = part_of(topology, sharpness, options.boundary,
                            faces_around(topology, start, options.scheme, own_fans, wide));
  Sharpness& kept = part.sharpness;
  // The corners are the first vertices; fewer than the face has if it names one twice.
  std::size_t corners = 0;
  for (const VertexId v : part.topology.face(FaceId(0))) {
    if (!local) corners = std::max(corners, v.index() + 1);
  }
  keep_only(kept.vertices, [&](std::size_t v) { return v < corners; });
  // Edges that make a vertex sharp may be in other fans.
  for (std::size_t k = 0; k < own_fans.size(); ++k) {
    if (!own_fans[k] || !key.corners[k].sharp) continue;
    kept.vertices.resize(part.names.size(), 0.0);
    kept.vertices[part.topology.face(FaceId(0))[k].index()] = infinite_sharpness;
  }
  std::vector<bool> near(part.names.size(), false);
  std::fill_n(near.begin(), corners, true);
  if (wide) {
    for (const VertexId v : spoke_ends(part.topology, 0)) near[v.index()] = true;
  }
  keep_only(kept.edges, [&](std::size_t e) {
    const HalfEdge h = part.topology.half_of(EdgeId(e));
    return (near[part.topology.from(h).index()] || near[part.topology.to(h).index()]) &&
           !part.topology.ends_fans(EdgeId(e));
  });
  return std::make_shared<Neighbourhood>(
      Neighbourhood{std::move(part.topology),
                    std::move(kept),
                    {options.scheme, BoundaryRule::edge_only, options.creases, options.triangles},
                    wide,
                    own_fans});
}

}  // namespace

bool operator==(const Neighbourhood& a, const Neighbourhood& b) {
  if (a.hash != b.hash || a.wide != b.wide || a.own_fans != b.own_fans || a.options != b.options ||
      a.sharpness != b.sharpness || a.topology.face_count() != b.topology.face_count()) {
    return false;
  }
  for (std::size_t f = 0; f < a.topology.face_count(); ++f) {
    const auto x = a.topology.face(FaceId(f)), y = b.topology.face(FaceId(f));
    if (!std::equal(x.begin(), x.end(), y.begin(), y.end())) return false;
  }
  return true;
}

Neighbourhood::Neighbourhood(Topology faces, Sharpness sharp, const SchemeOptions& rules, bool is_wide,
                             const OwnFans& own)
    : topology(std::move(faces)), sharpness(std::move(sharp)), options(rules), wide(is_wide), own_fans(own) {
  Hash all;
  for (std::size_t f = 0; f < topology.face_count(); ++f) {
    const auto face = topology.face(FaceId(f));
    all.mix(face.size());
    for (const VertexId v : face) all.mix(v.value());
  }
  all.mix(sharpness.vertices);
  all.mix(sharpness.edges);
  hash = all.value();
}

bool operator==(const KindKey& a, const KindKey& b) {
  return a.scheme == b.scheme && a.corners == b.corners && a.polygon == b.polygon &&
         (a.around == b.around || (a.around && b.around && *a.around == *b.around));
}

std::size_t KindKeyHash::operator()(const KindKey& key) const noexcept {
  Hash all;
  all.mix(static_cast<std::uint64_t>(key.scheme) << 1 | std::uint64_t{key.polygon});
  for (const CornerFan& fan : key.corners) {
    all.mix(std::uint64_t{fan.before} << 19 | std::uint64_t{fan.after} << 3 | std::uint64_t{fan.closed} << 2 |
            std::uint64_t{fan.sharp} << 1 | std::uint64_t{fan.odd});
  }
  if (key.around) all.mix(key.around->hash);
  return all.value();
}

KindKey kind_key_from(const Topology& topology, HalfEdge start, const SchemeOptions& options,
                      const Sharpness& sharpness) {
  const SchemeRules& rules = rules_of(options.scheme);
  if (!rules.primal) return dual_key(topology, start, rules);
  KindKey key{options.scheme};
  const std::size_t size = topology.face(topology.face_of(start)).size();
  key.polygon = size != rules.corners;
  bool plain = !key.polygon;
  OwnFans own_fans{};
  if (!key.polygon) {
    HalfEdge h = start;
    for (std::size_t i = 0; i < size; ++i, h = topology.next(h)) {
      const CornerView view = view_of(topology, sharpness, h, options);
      key.corners[i] = view.fan;
      plain = plain && view.plain;
      own_fans[i] = view.own_fan_is_enough;
    }
  }
  if (!plain) key.around = surroundings(topology, start, key, own_fans, options, sharpness);
  return key;
}

TurnedKey kind_key(const Topology& topology, FaceId face, const SchemeOptions& options,
                   const Sharpness& sharpness) {
  SNUG_EXPECT(rules_of(options.scheme).triangular());
  const HalfEdge base = topology.first_of(face);
  const auto turned = [&](std::uint8_t first) {
    return kind_key_from(topology, base + first, options, sharpness);
  };
  TurnedKey best{turned(0), 0};
  if (!best.key.plain()) return best;
  const std::array<CornerFan, 4> fans = best.key.corners;
  for (std::uint8_t first = 1; first < 3; ++first) {
    const std::array<CornerFan, 4> other{fans[first], fans[(first + 1) % 3], fans[(first + 2) % 3], fans[3]};
    if (other < best.key.corners) best.key.corners = other, best.first = first;
  }
  return best;
}

Neighbourhood neighbourhood(const KindKey& key) {
  if (key.around) return *key.around;
  const SchemeRules& rules = rules_of(key.scheme);
  Topology ring = rules.ring(key.corners);
  Sharpness sharpness;
  for (std::size_t i = 0; i < rules.corners; ++i) {
    if (!key.corners[i].sharp) continue;
    if (sharpness.vertices.empty()) sharpness.vertices.assign(ring.vertex_count(), 0.0);
    sharpness.vertices[i] = infinite_sharpness;
  }
  return {std::move(ring), std::move(sharpness), {key.scheme, BoundaryRule::edge_only}};
}

ControlOrder::ControlOrder(const KindKey& key, const Topology& around) : scheme_(key.scheme) {
  if (key.around) {
    wide_ = key.around->wide;
    own_fans_ = key.around->own_fans;
  }
  const SchemeRules& rules = rules_of(scheme_);
  if (key.around && rules.primal) return;
  // Where the walk enters each face.
  std::vector<HalfEdge> entries(around.face_count(), no_half_edge);
  const auto step_to = [&](HalfEdge h) {
    const std::size_t f = around.face_of(h).index();
    Step step{static_cast<std::uint16_t>(f), 0};
    for (HalfEdge g = entries[f]; g != h; g = around.next(g)) ++step.edges;
    return step;
  };
  entries[0] = 0;
  std::vector<bool> met(around.vertex_count(), false);
  vertices_.resize(around.vertex_count());
  for (std::size_t f = 0; f < around.face_count(); ++f) {
    const HalfEdge first = around.first_of(FaceId(f));
    HalfEdge h = first;
    while (f > 0 && (around.twin(h) == no_half_edge || around.face_of(around.twin(h)).index() >= f)) {
      h = around.next(h);
      SNUG_EXPECT(h != first);
    }
    if (f > 0) faces_.push_back(step_to(around.twin(h)));
    entries[f] = h;
    do {
      const std::size_t v = around.from(h).index();
      if (!met[v]) vertices_[v] = step_to(h);
      met[v] = true;
      h = around.next(h);
    } while (h != entries[f]);
  }
}

void ControlOrder::operator()(const Topology& topology, HalfEdge start, std::vector<VertexId>& out) const {
  if (vertices_.empty()) {
    vertices_of(topology, faces_around(topology, start, scheme_, own_fans_, wide_), out);
    return;
  }
  // A face that was entered: its half-edges, and which of them was met.
  struct Entry {
    HalfEdge first, size, met;
  };
  thread_local std::vector<Entry> kept;
  kept.resize(faces_.size() + 1);
  Entry* const entries = kept.data();
  const HalfEdge uniform = topology.uniform_size();
  const auto enter = [&](HalfEdge h) -> Entry {
    if (uniform != 0) return {h - h % uniform, uniform, h % uniform};  // no look at memory
    const FaceId f = topology.face_of(h);
    const HalfEdge first = topology.first_of(f);
    return {first, static_cast<HalfEdge>(topology.face(f).size()), h - first};
  };
  const auto at = [&](Step step) {
    const Entry& entry = entries[step.face];
    const HalfEdge i = entry.met + step.edges;
    return entry.first + (i < entry.size ? i : i - entry.size);
  };
  entries[0] = enter(start);
  for (std::size_t f = 0; f < faces_.size(); ++f) entries[f + 1] = enter(topology.twin(at(faces_[f])));
  out.resize(vertices_.size());
  for (std::size_t i = 0; i < vertices_.size(); ++i) out[i] = topology.from(at(vertices_[i]));
}

}  // namespace snug
