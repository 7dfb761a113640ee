#include <snug/patch/neighbourhood.h>

#include <algorithm>
#include <utility>

#include <snug/base/contract.h>
#include <snug/scheme/refine.h>

namespace snug {
namespace {

CornerFan fan_of(const Topology& topology, HalfEdge corner, const SchemeOptions& options) {
  std::uint16_t after = 0, before = 0;
  HalfEdge h = topology.ccw(corner);
  for (; h != no_half_edge && h != corner; h = topology.ccw(h)) ++after;
  if (h == corner) return {0, after, true, false};
  for (h = topology.cw(corner); h != no_half_edge; h = topology.cw(h)) ++before;
  return {before, after, false, is_sharp_corner(topology, topology.from(corner), options)};
}

// Which of the vertices across the edges 01, 12, 20 are there, and which are the same by structure: entry i
// is the place among the distinct ones, or absent.
struct AcrossEdges {
  static constexpr std::uint8_t absent = 255;
  std::array<std::uint8_t, 3> place{absent, absent, absent};
  std::uint8_t count = 0;

  explicit AcrossEdges(const std::array<CornerFan, 3>& corners) {
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

}  // namespace

std::size_t KindKeyHash::operator()(const KindKey& key) const noexcept {
  std::uint64_t hash = static_cast<std::uint64_t>(key.scheme);
  for (const CornerFan& fan : key.corners) {
    const std::uint64_t code = std::uint64_t{fan.before} << 18 | std::uint64_t{fan.after} << 2 |
                               std::uint64_t{fan.closed} << 1 | std::uint64_t{fan.sharp};
    hash = (hash ^ code) * 0x9e3779b97f4a7c15u;
    hash ^= hash >> 31;
  }
  return hash;
}

TurnedKey kind_key(const Topology& topology, FaceId face, const SchemeOptions& options) {
  const HalfEdge base = topology.first_of(face);
  std::array<CornerFan, 3> fans;
  for (std::size_t i = 0; i < 3; ++i) fans[i] = fan_of(topology, base + static_cast<HalfEdge>(i), options);
  TurnedKey best{{options.scheme, fans}, 0};
  for (std::uint8_t first = 1; first < 3; ++first) {
    const std::array<CornerFan, 3> turned{fans[first], fans[(first + 1) % 3], fans[(first + 2) % 3]};
    if (turned < best.key.corners) best = {{options.scheme, turned}, first};
  }
  return best;
}

void control_vertices(const Topology& topology, FaceId face, std::uint8_t first, std::vector<VertexId>& out) {
  out.clear();
  const HalfEdge base = topology.first_of(face);
  std::array<HalfEdge, 3> corner;
  std::array<bool, 3> three;  // an interior vertex of valence 3: its two outer edges face the same vertex
  for (std::size_t i = 0; i < 3; ++i) {
    corner[i] = base + static_cast<HalfEdge>((first + i) % 3);
    out.push_back(topology.from(corner[i]));
    HalfEdge h = corner[i];
    for (int step = 0; step < 3 && h != no_half_edge; ++step) h = topology.ccw(h);
    three[i] = h == corner[i];
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const HalfEdge across = topology.twin(corner[i]);
    if (across == no_half_edge || (i > 0 && three[i]) || (i == 2 && three[0])) continue;
    out.push_back(topology.from(topology.prev(across)));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t already = out.size();
    HalfEdge h = topology.ccw(corner[i]);  // its face lies across edge i + 2
    if (h != no_half_edge) {
      for (h = topology.ccw(h); h != no_half_edge && h != corner[i]; h = topology.ccw(h)) {
        out.push_back(topology.from(topology.prev(h)));
      }
    }
    if (h != no_half_edge) {  // round a closed fan: the last two are across edge i, and corner i + 1
      out.resize(out.size() - std::min<std::size_t>(2, out.size() - already));
      continue;
    }
    h = topology.cw(corner[i]);  // leaves for the vertex across edge i
    if (h == no_half_edge) continue;
    for (h = topology.cw(h); h != no_half_edge; h = topology.cw(h)) out.push_back(topology.to(h));
  }
}

Topology neighbourhood(const KindKey& key) {
  const std::array<CornerFan, 3>& fans = key.corners;
  for (std::size_t i = 0; i < 3; ++i) {  // both ends of an edge agree whether it is a boundary
    const CornerFan &here = fans[i], &there = fans[(i + 1) % 3];
    SNUG_EXPECT((!here.closed && here.before == 0) == (!there.closed && there.after == 0));
  }
  const AcrossEdges across(fans);
  std::vector<VertexId> corners;  // of faces
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    corners.insert(corners.end(), {VertexId(a), VertexId(b), VertexId(c)});
  };
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
  std::vector<std::uint32_t> offsets(corners.size() / 3 + 1);
  for (std::size_t f = 0; f < offsets.size(); ++f) offsets[f] = static_cast<std::uint32_t>(3 * f);
  return Topology(std::move(offsets), std::move(corners), count);
}

SchemeOptions neighbourhood_options(const KindKey& key) {
  const bool sharp =
      std::any_of(key.corners.begin(), key.corners.end(), [](const CornerFan& f) { return f.sharp; });
  return {key.scheme, sharp ? BoundaryRule::edge_and_corner : BoundaryRule::edge_only};
}

}  // namespace snug
