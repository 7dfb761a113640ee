#include <snug/patch/neighbourhood.h>

#include <algorithm>
#include <bit>
#include <utility>

#include <snug/base/compact_numbering.h>
#include <snug/base/contract.h>
#include <snug/scheme/limits.h>

namespace snug {
namespace {

// A corner as its patch sees it.
struct CornerView {
  CornerFan fan;  // when all that decays has decayed
  bool plain;     // the fan says everything
};

CornerView view_of(const Topology& topology, const Sharpness& sharpness, HalfEdge corner,
                   const SchemeOptions& options) {
  const bool loop = options.scheme == Scheme::loop;
  CornerView view{{0, 0, false, false, false}, true};
  CornerFan& fan = view.fan;
  // Most vertices are of this sort: no need to walk around them.
  if (loop && sharpness.none() && topology.is_manifold() && !topology.on_boundary(topology.from(corner))) {
    const std::size_t faces = topology.face_valence(topology.from(corner));
    fan.after = static_cast<std::uint16_t>(faces - 1);
    fan.closed = true;
    view.plain = faces >= 3;
    return view;
  }
  const auto is_standard = [&](HalfEdge h) { return loop || topology.face(topology.face_of(h)).size() == 4; };
  bool cutting = false;
  const VertexId v = topology.from(corner);
  if (!sharpness.none() || !topology.is_manifold()) {
    thread_local Star star;
    gather_star(topology, sharpness, v, options.boundary, star);
    view.plain = is_stationary(star);
    const auto infinite = std::count_if(star.spokes.begin(), star.spokes.end(), [](const Spoke& spoke) {
      return spoke.sharpness >= infinite_sharpness;
    });
    fan.sharp = star.sharpness >= infinite_sharpness || infinite > 2;
    cutting = fan.sharp || infinite == 2;
    fan.odd = !cutting && infinite == 1;
  }
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
  // From an edge of many faces, or a cut, back to it. At a crease it goes on elsewhere; at a corner the first and the last
  // vertex of the fan are one, which vertices of three faces beside it, or a fan of one's own, cannot tell.
  fan.odd = fan.odd || (cutting && topology.edge_of(h) == last);
  if (!cutting && !fan.odd) {  // the short way: nothing is sharp but what connectivity makes so
    fan.sharp = vertex_sharpness(topology, sharpness, v, options.boundary) >= infinite_sharpness;
  }
  view.plain = view.plain && standard && !fan.odd;
  return view;
}

CornerFan dual_fan(const Topology& topology, HalfEdge corner) {
  const std::size_t size = topology.face(topology.face_of(corner)).size();
  return {0, static_cast<std::uint16_t>(size - 1), true, false, false};
}

KindKey dual_key(const Topology& topology, HalfEdge start, Scheme scheme) {
  KindKey key;
  key.scheme = scheme;
  std::vector<std::uint32_t> sizes;
  topology.walk_fan(start, [&](HalfEdge h) {
    if (sizes.size() < 4) key.corners[sizes.size()] = dual_fan(topology, h);
    sizes.push_back(static_cast<std::uint32_t>(topology.face(topology.face_of(h)).size()));
  });
  if (sizes.size() == 4) return key;
  key.polygon = true;
  key.corners = {};
  key.details = std::move(sizes);
  return key;
}

// The other ends of the edges at the corners of a face, each once.
std::vector<VertexId> spoke_ends(const Topology& topology, HalfEdge start) {
  std::vector<VertexId> ends;
  const auto add = [&](VertexId v) {
    if (std::find(ends.begin(), ends.end(), v) == ends.end()) ends.push_back(v);
  };
  HalfEdge corner = start;
  do {
    topology.for_each_fan(topology.from(corner), [&](HalfEdge first) {
      topology.walk_fan(first, [&](HalfEdge h) {
        add(topology.to(h));
        add(topology.from(topology.prev(h)));
      });
    });
    corner = topology.next(corner);
  } while (corner != start);
  return ends;
}

// The faces around the corners of a face, its own first, each as the half-edge that leaves the corner where it was met; then, if
// wide, those around the far ends of the edges at the corners.
std::vector<HalfEdge> faces_around(const Topology& topology, HalfEdge start, bool wide) {
  thread_local CompactNumbering met;
  met.begin(topology.face_count());
  std::vector<HalfEdge> found;
  const auto add = [&](HalfEdge h) {
    if (met.number(topology.face_of(h).index()) == found.size()) found.push_back(h);
  };
  add(start);
  HalfEdge corner = start;
  do {
    topology.walk_fan(corner, add);
    if (topology.twin(corner) != no_half_edge) {
      for (HalfEdge h = topology.cw(corner); h != no_half_edge && h != corner; h = topology.cw(h)) add(h);
    }
    topology.for_each_fan(topology.from(corner), [&](HalfEdge first) { topology.walk_fan(first, add); });
    corner = topology.next(corner);
  } while (corner != start);
  if (!wide) return found;
  for (const VertexId end : spoke_ends(topology, start)) {
    topology.for_each_fan(end, [&](HalfEdge first) { topology.walk_fan(first, add); });
  }
  return found;
}

bool is_corner(const Topology& topology, HalfEdge start, VertexId v) {
  const auto corners = topology.face(topology.face_of(start));
  return std::find(corners.begin(), corners.end(), v) != corners.end();
}

// Does the sharpness of edges at the corners depend on that of edges which do not touch them?
bool is_wide(const Topology& topology, HalfEdge start, const SchemeOptions& options,
             const Sharpness& sharpness) {
  std::vector<VertexId> ends;
  for (const VertexId v : topology.face(topology.face_of(start))) {
    add_far_ends(topology, sharpness, v, options, ends);
  }
  return std::any_of(ends.begin(), ends.end(), [&](VertexId v) { return !is_corner(topology, start, v); });
}

// Details of a primal kind: rules; faces; sharpness of vertices and edges.
class DetailWriter {
 public:
  std::vector<std::uint32_t> words;
  void add(std::size_t word) { words.push_back(static_cast<std::uint32_t>(word)); }
  void add(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    words.push_back(static_cast<std::uint32_t>(bits));
    words.push_back(static_cast<std::uint32_t>(bits >> 32));
  }
};

std::vector<std::uint32_t> primal_details(const Topology& topology, HalfEdge start,
                                          const SchemeOptions& options, const Sharpness& sharpness) {
  const bool wide = is_wide(topology, start, options, sharpness);
  const PartOfMesh part = part_of(topology, sharpness, options.boundary, faces_around(topology, start, wide));
  // The corners are the first vertices; fewer than the face has if it names one twice.
  std::size_t corners = 0;
  for (const VertexId v : part.topology.face(FaceId(0))) corners = std::max(corners, v.index() + 1);
  DetailWriter out;
  out.add(static_cast<std::size_t>(options.creases) | static_cast<std::size_t>(options.triangles) << 1 |
          static_cast<std::size_t>(wide) << 2);
  out.add(part.names.size());
  out.add(part.topology.face_count());
  for (std::size_t f = 0; f < part.topology.face_count(); ++f) {
    const auto face = part.topology.face(FaceId(f));
    out.add(face.size());
    for (const VertexId v : face) out.add(v.index());
  }
  // Nothing beyond the edges and vertices of the face's corners counts; if it is wide, of the edges' far ends.
  std::vector<std::pair<std::size_t, double>> sharp;
  if (!part.sharpness.vertices.empty()) {
    for (std::size_t v = 0; v < corners; ++v) {
      if (part.sharpness.vertices[v] > 0) sharp.emplace_back(v, part.sharpness.vertices[v]);
    }
  }
  out.add(sharp.size());
  for (const auto& [v, s] : sharp) {
    out.add(v);
    out.add(s);
  }
  sharp.clear();
  std::vector<bool> near(part.names.size(), false);
  std::fill_n(near.begin(), corners, true);
  if (wide) {
    for (const VertexId v : spoke_ends(part.topology, part.topology.first_of(FaceId(0))))
      near[v.index()] = true;
  }
  for (std::size_t e = 0; e < part.sharpness.edges.size(); ++e) {
    const HalfEdge h = part.topology.half_of(EdgeId(e));
    const bool counts = near[part.topology.from(h).index()] || near[part.topology.to(h).index()];
    if (counts && part.sharpness.edges[e] > 0 && !part.topology.ends_fans(EdgeId(e))) {
      sharp.emplace_back(e, part.sharpness.edges[e]);
    }
  }
  out.add(sharp.size());
  for (const auto& [e, s] : sharp) {
    out.add(e);
    out.add(s);
  }
  return std::move(out.words);
}

Neighbourhood from_details(const KindKey& key) {
  std::size_t at = 0;
  const auto next = [&] { return key.details[at++]; };
  const auto next_double = [&] {
    const std::uint64_t low = next(), high = next();
    return std::bit_cast<double>(low | high << 32);
  };
  Neighbourhood result;
  const std::uint32_t rules = next();
  result.options = {key.scheme, BoundaryRule::edge_only, static_cast<CreaseMethod>(rules & 1u),
                    static_cast<SmoothTriangles>(rules >> 1 & 1u)};
  const std::size_t vertices = next(), faces = next();
  std::vector<std::uint32_t> offsets{0};
  std::vector<VertexId> corners;
  for (std::size_t f = 0; f < faces; ++f) {
    for (std::size_t left = next(); left > 0; --left) corners.emplace_back(next());
    offsets.push_back(static_cast<std::uint32_t>(corners.size()));
  }
  result.topology = Topology(std::move(offsets), std::move(corners), vertices);
  result.sharpness.vertices_complete = true;
  if (std::size_t left = next(); left > 0) {
    result.sharpness.vertices.assign(vertices, 0.0);
    for (; left > 0; --left) {
      const std::size_t v = next();
      result.sharpness.vertices[v] = next_double();
    }
  }
  if (std::size_t left = next(); left > 0) {
    result.sharpness.edges.assign(result.topology.edge_count(), 0.0);
    for (; left > 0; --left) {
      const std::size_t e = next();
      result.sharpness.edges[e] = next_double();
    }
  }
  return result;
}

// Faces in the making.
struct FaceList {
  std::vector<std::uint32_t> offsets{0};
  std::vector<VertexId> corners;
  void add(std::initializer_list<std::size_t> face) {
    for (const std::size_t v : face) corners.emplace_back(v);
    offsets.push_back(static_cast<std::uint32_t>(corners.size()));
  }
  Topology finish(std::size_t vertices) && {
    return Topology(std::move(offsets), std::move(corners), vertices);
  }
};

// Which of the vertices across the edges 01, 12, 20 are there, and which are the same by structure: entry i
// is the place among the distinct ones, or absent.
struct AcrossEdges {
  static constexpr std::uint8_t absent = 255;
  std::array<std::uint8_t, 3> place{absent, absent, absent};
  std::uint8_t count = 0;

  explicit AcrossEdges(const std::array<CornerFan, 4>& corners) {
    const auto merges = [&](std::size_t i) { return corners[i].closed && corners[i].faces() == 3; };
    for (std::size_t i = 0; i < 3; ++i) {
      if (!corners[i].closed && corners[i].before == 0) continue;
      if (i > 0 && merges(i)) {
        place[i] = place[i - 1];
      } else if (i == 2 && merges(0)) {
        place[i] = place[0];
      } else {
        place[i] = count++;
      }
    }
  }
};

Topology loop_neighbourhood(const std::array<CornerFan, 4>& fans) {
  for (std::size_t i = 0; i < 3; ++i) {  // both ends of an edge agree whether it is a boundary
    const CornerFan &here = fans[i], &there = fans[(i + 1) % 3];
    SNUG_EXPECT((!here.closed && here.before == 0) == (!there.closed && there.after == 0));
  }
  const AcrossEdges across(fans);
  FaceList faces;
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) { faces.add({a, b, c}); };
  const auto outer = [&](std::size_t edge) { return std::size_t{3} + across.place[edge]; };
  add(0, 1, 2);
  for (std::size_t i = 0; i < 3; ++i) {
    if (across.place[i] != AcrossEdges::absent) add((i + 1) % 3, i, outer(i));
  }
  std::size_t count = std::size_t{3} + across.count;
  for (std::size_t i = 0; i < 3; ++i) {
    const CornerFan& fan = fans[i];
    if (fan.closed) {
      if (fan.faces() == 3) continue;
      std::size_t last = outer((i + 2) % 3);
      for (std::size_t k = 0; k + 4 < fan.faces(); ++k) {
        add(i, last, count);
        last = count++;
      }
      add(i, last, outer(i));
      continue;
    }
    if (fan.after > 0) {
      std::size_t last = outer((i + 2) % 3);
      for (std::size_t k = 1; k < fan.after; ++k) {
        add(i, last, count);
        last = count++;
      }
    }
    if (fan.before > 0) {
      std::size_t last = outer(i);
      for (std::size_t k = 1; k < fan.before; ++k) {
        add(i, count, last);
        last = count++;
      }
    }
  }
  return std::move(faces).finish(count);
}

// The two vertices across an edge of a quad: at its first corner and at its second one; absent at a boundary.
struct AcrossQuad {
  std::array<std::size_t, 4> near{}, far{};
  std::array<bool, 4> there{};
  std::size_t end = 4;

  explicit AcrossQuad(const std::array<CornerFan, 4>& fans) {
    const auto merges = [&](std::size_t i) { return fans[i].closed && fans[i].faces() == 3; };
    for (std::size_t i = 0; i < 4; ++i) {
      there[i] = fans[i].closed || fans[i].before > 0;
      if (!there[i]) continue;
      near[i] = i > 0 && merges(i) ? far[i - 1] : end++;
      far[i] = i == 3 && merges(0) ? near[0] : end++;
    }
  }
};

Topology catmark_neighbourhood(const std::array<CornerFan, 4>& fans) {
  for (std::size_t i = 0; i < 4; ++i) {  // both ends of an edge agree whether it is a boundary
    const CornerFan &here = fans[i], &there = fans[(i + 1) % 4];
    SNUG_EXPECT((!here.closed && here.before == 0) == (!there.closed && there.after == 0));
  }
  const AcrossQuad across(fans);
  FaceList faces;
  faces.add({0, 1, 2, 3});
  for (std::size_t i = 0; i < 4; ++i) {
    if (across.there[i]) faces.add({(i + 1) % 4, i, across.near[i], across.far[i]});
  }
  std::size_t count = across.end;
  for (std::size_t i = 0; i < 4; ++i) {
    const CornerFan& fan = fans[i];
    const std::size_t faces_before = fan.closed ? 2 : 1;  // of the patch and across its edges
    if (fan.after > 0) {
      std::size_t last = across.far[(i + 3) % 4];
      for (std::size_t k = faces_before; k < fan.after; ++k) {
        const std::size_t diagonal = count++;
        const std::size_t spoke = fan.closed && k + 1 == fan.after ? across.near[i] : count++;
        faces.add({i, last, diagonal, spoke});
        last = spoke;
      }
    }
    if (fan.before > 0) {
      std::size_t last = across.near[i];
      for (std::size_t k = 1; k < fan.before; ++k) {
        const std::size_t diagonal = count++, spoke = count++;
        faces.add({i, spoke, diagonal, last});
        last = spoke;
      }
    }
  }
  return std::move(faces).finish(count);
}

Topology dual_neighbourhood(std::span<const std::size_t> sizes) {
  FaceList faces;
  const std::size_t n = sizes.size();
  std::size_t count = n + 1;
  for (std::size_t k = 0; k < n; ++k) {
    faces.corners.emplace_back(0u);
    faces.corners.emplace_back(1 + k);
    for (std::size_t i = 3; i < sizes[k]; ++i) faces.corners.emplace_back(count++);
    faces.corners.emplace_back(1 + (k + 1) % n);
    faces.offsets.push_back(static_cast<std::uint32_t>(faces.corners.size()));
  }
  return std::move(faces).finish(count);
}

// The half-edges that leave the corners of a face, from `start` on.
template <std::size_t n>
std::array<HalfEdge, n> corners_from(const Topology& topology, HalfEdge start) {
  std::array<HalfEdge, n> corner;
  for (HalfEdge& h : corner) {
    h = start;
    start = topology.next(start);
  }
  return corner;
}

bool merges(const CornerFan& fan) { return fan.closed && fan.faces() == 3; }

void loop_control(const Topology& topology, HalfEdge start, const std::array<CornerFan, 4>& fans,
                  std::vector<VertexId>& out) {
  const auto corner = corners_from<3>(topology, start);
  for (const HalfEdge h : corner) out.push_back(topology.from(h));
  for (std::size_t i = 0; i < 3; ++i) {
    const bool there = fans[i].closed || fans[i].before > 0;
    // At an interior vertex of valence 3 both outer edges face the same vertex.
    if (!there || (i > 0 && merges(fans[i])) || (i == 2 && merges(fans[0]))) continue;
    out.push_back(topology.from(topology.prev(topology.twin(corner[i]))));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const CornerFan& fan = fans[i];
    const std::size_t last = fan.closed ? (fan.after < 2 ? 0 : fan.after - 2u) : fan.after;
    HalfEdge h = corner[i];
    for (std::size_t step = 1; step <= last; ++step) {
      h = topology.ccw(h);
      if (step > 1) out.push_back(topology.from(topology.prev(h)));
    }
    h = corner[i];
    for (std::size_t step = 1; step <= fan.before; ++step) {
      h = topology.cw(h);
      if (step > 1) out.push_back(topology.to(h));
    }
  }
}

void catmark_control(const Topology& topology, HalfEdge start, const std::array<CornerFan, 4>& fans,
                     std::vector<VertexId>& out) {
  const auto corner = corners_from<4>(topology, start);
  for (const HalfEdge h : corner) out.push_back(topology.from(h));
  for (std::size_t i = 0; i < 4; ++i) {
    if (!fans[i].closed && fans[i].before == 0) continue;
    const HalfEdge across = topology.twin(corner[i]);
    if (i == 0 || !merges(fans[i])) out.push_back(topology.to(topology.next(across)));
    if (i < 3 || !merges(fans[0])) out.push_back(topology.from(topology.prev(across)));
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const CornerFan& fan = fans[i];
    const std::size_t last = fan.closed ? fan.after - 1u : fan.after;
    HalfEdge h = corner[i];
    for (std::size_t step = 1; step <= last; ++step) {
      h = topology.ccw(h);
      if (step == 1) continue;
      out.push_back(topology.to(topology.next(h)));
      if (!fan.closed || step < last) out.push_back(topology.from(topology.prev(h)));
    }
    h = corner[i];
    for (std::size_t step = 1; step <= fan.before; ++step) {
      h = topology.cw(h);
      if (step == 1) continue;
      out.push_back(topology.to(topology.next(h)));
      out.push_back(topology.to(h));
    }
  }
}

void dual_control(const Topology& topology, HalfEdge start, std::vector<VertexId>& out) {
  out.push_back(topology.from(start));
  topology.walk_fan(start, [&](HalfEdge h) { out.push_back(topology.to(h)); });
  topology.walk_fan(start, [&](HalfEdge h) {
    for (HalfEdge g = topology.next(h); topology.to(g) != topology.from(topology.prev(h));
         g = topology.next(g))
      out.push_back(topology.to(g));
  });
}

}  // namespace

std::size_t KindKeyHash::operator()(const KindKey& key) const noexcept {
  std::uint64_t hash = static_cast<std::uint64_t>(key.scheme) << 1 | std::uint64_t{key.polygon};
  const auto mix = [&](std::uint64_t code) {
    hash = (hash ^ code) * 0x9e3779b97f4a7c15u;
    hash ^= hash >> 31;
  };
  for (const CornerFan& fan : key.corners) {
    mix(std::uint64_t{fan.before} << 19 | std::uint64_t{fan.after} << 3 | std::uint64_t{fan.closed} << 2 |
        std::uint64_t{fan.sharp} << 1 | std::uint64_t{fan.odd});
  }
  for (const std::uint32_t word : key.details) mix(word);
  return hash;
}

KindKey kind_key_from(const Topology& topology, HalfEdge start, const SchemeOptions& options,
                      const Sharpness& sharpness) {
  if (!is_primal(options.scheme)) return dual_key(topology, start, options.scheme);
  KindKey key;
  key.scheme = options.scheme;
  const std::size_t size = topology.face(topology.face_of(start)).size();
  key.polygon = size != (options.scheme == Scheme::loop ? 3u : 4u);
  bool plain = !key.polygon;
  if (!key.polygon) {
    HalfEdge h = start;
    for (std::size_t i = 0; i < size; ++i, h = topology.next(h)) {
      const CornerView view = view_of(topology, sharpness, h, options);
      key.corners[i] = view.fan;
      plain = plain && view.plain;
    }
  }
  if (!plain) key.details = primal_details(topology, start, options, sharpness);
  return key;
}

TurnedKey kind_key(const Topology& topology, FaceId face, const SchemeOptions& options,
                   const Sharpness& sharpness) {
  SNUG_EXPECT(options.scheme == Scheme::loop);
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

void control_vertices(const Topology& topology, HalfEdge start, const KindKey& key,
                      std::vector<VertexId>& out) {
  out.clear();
  if (!is_primal(key.scheme)) {
    dual_control(topology, start, out);
  } else if (!key.plain()) {
    const bool wide = (key.details[0] >> 2 & 1u) != 0;
    vertices_of(topology, faces_around(topology, start, wide), out);
  } else if (key.scheme == Scheme::loop) {
    loop_control(topology, start, key.corners, out);
  } else {
    catmark_control(topology, start, key.corners, out);
  }
}

void control_vertices(const Topology& topology, FaceId face, std::uint8_t first, const KindKey& key,
                      std::vector<VertexId>& out) {
  control_vertices(topology, topology.first_of(face) + first, key, out);
}

Neighbourhood neighbourhood(const KindKey& key) {
  if (!is_primal(key.scheme)) {
    std::vector<std::size_t> sizes(key.details.begin(), key.details.end());
    if (!key.polygon) {
      for (const CornerFan& fan : key.corners) sizes.push_back(fan.faces());
    }
    return {dual_neighbourhood(sizes), {}, {key.scheme, BoundaryRule::edge_only}};
  }
  if (!key.plain()) return from_details(key);
  const bool loop = key.scheme == Scheme::loop;
  Neighbourhood result{loop ? loop_neighbourhood(key.corners) : catmark_neighbourhood(key.corners),
                       {},
                       {key.scheme, BoundaryRule::edge_only}};
  for (std::size_t i = 0; i < (loop ? 3u : 4u); ++i) {
    if (!key.corners[i].sharp) continue;
    if (result.sharpness.vertices.empty())
      result.sharpness.vertices.assign(result.topology.vertex_count(), 0.0);
    result.sharpness.vertices[i] = infinite_sharpness;
  }
  return result;
}

}  // namespace snug
