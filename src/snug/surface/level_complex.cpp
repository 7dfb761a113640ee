#include <snug/surface/level_complex.h>

#include <algorithm>

#include <snug/mesh/disjoint_sets.h>
#include <support/contract.h>

namespace snug {
namespace {

constexpr std::uint64_t kind_shift = 60;
enum : std::uint64_t { at_corner, on_edge, in_patch };

std::uint64_t mixed(std::uint64_t x) {
  x ^= x >> 31;
  x *= 0x9e3779b97f4a7c15u;
  x ^= x >> 29;
  return x;
}

}  // namespace

std::size_t LevelVertexHash::operator()(const LevelVertex& v) const noexcept {
  return mixed(mixed(v.where) + v.place);
}

LevelComplex::LevelComplex(const LimitSurface& surface) : surface_(&surface) {
  const std::size_t count = surface.patch_count();
  names_.resize(count);
  sides_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const PatchId p(i);
    if (!surface.has_patch(p)) continue;
    if (surface.after_first_split(p)) first_level_ = 1;
    names_[i] = surface.corner_names(p);
    sides_[i] = sides_of(p);
    for (std::uint8_t k = 0; k < 3; ++k) {
      at_corner_[names_[i][k]].push_back({p, k});
      at_edge_[sides_[i][k].edge].push_back({p, k});
    }
  }
}

// Edges of the mesh (of dual schemes: between the faces on both sides) have their numbers, others follow.
std::array<LevelComplex::Side, 3> LevelComplex::sides_of(PatchId p) const {
  const Topology& topology = surface_->topology();
  const bool primal = surface_->rules().primal;
  const auto [owner, part] = surface_->place(p);
  const std::size_t first = surface_->patches_of(owner).begin;
  HalfEdge corner = primal ? topology.first_of(FaceId(owner)) : topology.leaving(VertexId(owner));
  const auto next = [&](HalfEdge h) { return primal ? topology.next(h) : topology.ccw(h); };
  // The edges that leave corner k towards the next one and the one before.
  const auto edge_after = [&](HalfEdge h) {
    return std::uint64_t{topology.edge_of(primal ? h : topology.prev(h)).value()};
  };
  const auto edge_before = [&](HalfEdge h) {
    return std::uint64_t{topology.edge_of(primal ? topology.prev(h) : h).value()};
  };
  const auto end_name = [&](HalfEdge h) {
    return primal ? std::uint64_t{topology.from(h).value()} : std::uint64_t{topology.face_of(h).value()};
  };
  const std::uint64_t edges = topology.edge_count();
  const auto whole = [](std::uint64_t edge, std::uint64_t from, std::uint64_t to) {
    return from < to ? Side{edge, 0, 2} : Side{edge, 2, 0};
  };
  const auto own = [&](std::size_t patch, bool spoke) { return edges + 2 * patch + (spoke ? 1 : 0); };
  if (surface_->rules().triangular()) {
    std::array<Side, 3> sides{};
    for (Side& side : sides) {
      side = whole(edge_after(corner), end_name(corner), end_name(next(corner)));
      corner = next(corner);
    }
    return sides;
  }
  if (!surface_->after_first_split(p)) {
    for (unsigned k = 0; k < 2 * part; ++k) corner = next(corner);
    const HalfEdge middle = next(corner), far = next(middle);
    // The diagonal runs from corner 0 to corner 2 of the quad.
    return {whole(edge_after(corner), end_name(corner), end_name(middle)),
            whole(edge_after(middle), end_name(middle), end_name(far)),
            part == 0 ? Side{own(first, false), 2, 0} : Side{own(first, false), 0, 2}};
  }
  const std::size_t k = part / 2, corners = (surface_->patches_of(owner).end - first) / 2;
  HalfEdge before = corner;
  for (std::size_t m = 0; m < k; ++m) corner = next(corner);
  for (std::size_t m = 0; m < (k + corners - 1) % corners; ++m) before = next(before);
  if (part % 2 == 0) {  // corner k, middle of the edge after it, centre
    const bool forward = end_name(corner) < end_name(next(corner));
    return {Side{edge_after(corner), static_cast<std::uint8_t>(forward ? 0 : 2), 1},
            Side{own(first + 2 * k, true), 0, 2}, Side{own(first + 2 * k, false), 0, 2}};
  }
  // Centre, middle of the edge before corner k, corner k.
  const bool forward = end_name(corner) < end_name(before);
  const std::size_t spoke = first + 2 * ((k + corners - 1) % corners);
  return {Side{own(spoke, true), 2, 0},
          Side{edge_before(corner), 1, static_cast<std::uint8_t>(forward ? 0 : 2)},
          Side{own(first + 2 * k, false), 2, 0}};
}

std::vector<PieceName> LevelComplex::pieces() const {
  std::vector<PieceName> pieces;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const PieceName whole{PatchId(i), {}};
    if (!surface_->has_patch(whole.patch)) continue;
    if (level_of(whole) == first_level_) {
      pieces.push_back(whole);
    } else {
      for (unsigned child = 0; child < 4; ++child) pieces.push_back(whole.child(child));
    }
  }
  return pieces;
}

LevelVertex LevelComplex::vertex(PatchId p, unsigned splits, std::uint64_t i, std::uint64_t j) const {
  const std::uint64_t n = std::uint64_t{1} << splits, first = n - i - j;
  const std::uint64_t vertices = surface_->topology().vertex_count(),
                      edges = surface_->topology().edge_count();
  const unsigned level = splits + offset(p);
  const auto corner = [&](std::size_t k) -> LevelVertex {
    const std::uint64_t name = names_[p.index()][k];
    // The middle of an edge, where a first split ends, is one of its points.
    if (!surface_->rules().triangular() && name >= vertices && name < vertices + edges) {
      return {(on_edge << kind_shift) | (name - vertices), std::uint64_t{1} << (level - 1)};
    }
    return {(at_corner << kind_shift) | name, 0};
  };
  if (first == n) return corner(0);
  if (i == n) return corner(1);
  if (j == n) return corner(2);
  const auto on = [&](std::size_t k, std::uint64_t t) -> LevelVertex {
    const Side& side = sides_[p.index()][k];
    // The whole edge has 2^level of them, which is n, or 2 n after a first split.
    const std::uint64_t halves = side.begin * (n - t) + side.end * t;
    return {(on_edge << kind_shift) | side.edge, offset(p) == 0 ? halves / 2 : halves};
  };
  if (j == 0) return on(0, i);
  if (first == 0) return on(1, j);
  if (i == 0) return on(2, n - j);
  return {(in_patch << kind_shift) | p.value(), i << 32 | j};
}

std::array<LevelVertex, 3> LevelComplex::vertices(const PieceName& piece) const {
  const auto at = piece.path.corners();
  std::array<LevelVertex, 3> result;
  for (std::size_t k = 0; k < 3; ++k) result[k] = vertex(piece.patch, piece.path.level(), at[k][0], at[k][1]);
  return result;
}

void LevelComplex::add_pieces(PatchId p, unsigned splits, std::uint64_t i, std::uint64_t j,
                              std::vector<LevelStar::Sector>& out) const {
  const std::uint64_t n = std::uint64_t{1} << splits;
  const auto add = [&](bool turned, std::uint64_t di, std::uint64_t dj, std::uint8_t centre) {
    if (i < di || j < dj) return;
    const PiecePath path(splits, turned, i - di, j - dj);
    if (path.i() + path.j() + (turned ? 2 : 1) <= n) out.push_back({{p, path}, centre});
  };
  add(false, 0, 0, 0);
  add(false, 1, 0, 1);
  add(false, 0, 1, 2);
  add(true, 1, 1, 0);
  add(true, 0, 1, 1);
  add(true, 1, 0, 2);
}

LevelStar LevelComplex::star(const LevelVertex& vertex, unsigned level) const {
  LevelStar star;
  const std::uint64_t kind = vertex.where >> kind_shift,
                      id = vertex.where & ((std::uint64_t{1} << kind_shift) - 1);
  if (kind == in_patch) {
    const PatchId p(id);
    add_pieces(p, level - offset(p), vertex.place >> 32, vertex.place & UINT32_MAX, star.sectors);
  } else if (kind == at_corner) {
    for (const auto& [p, k] : at_corner_.at(id)) {
      const unsigned splits = level - offset(p);
      const std::uint64_t n = std::uint64_t{1} << splits;
      add_pieces(p, splits, k == 1 ? n : 0, k == 2 ? n : 0, star.sectors);
    }
  } else {
    for (const auto& [p, k] : at_edge_.at(id)) {
      const Side& side = sides_[p.index()][k];
      const unsigned splits = level - offset(p);
      const std::uint64_t n = std::uint64_t{1} << splits, half = std::uint64_t{1} << (level - 1);
      const std::uint64_t begin = side.begin * half, end = side.end * half;
      if (vertex.place < std::min(begin, end) || vertex.place > std::max(begin, end)) continue;
      const std::uint64_t length = std::max(begin, end) - std::min(begin, end);
      const std::uint64_t from = begin < end ? vertex.place - begin : begin - vertex.place;
      const std::uint64_t t = from * n / length, rest = n - t;
      if (k == 0) add_pieces(p, splits, t, 0, star.sectors);
      if (k == 1) add_pieces(p, splits, rest, t, star.sectors);
      if (k == 2) add_pieces(p, splits, 0, rest, star.sectors);
    }
  }
  put_in_order(star);
  return star;
}

LevelComplex::Ends LevelComplex::ends_of(const LevelStar::Sector& sector) const {
  const PieceName& piece = sector.piece;
  const auto at = piece.path.corners();
  const auto middle = [&](std::size_t k) {
    const auto &from = at[sector.centre], &to = at[(sector.centre + k) % 3];
    return vertex(piece.patch, piece.path.level() + 1u, from[0] + to[0], from[1] + to[1]);
  };
  if (sector.mirrored) return {middle(2), middle(1)};
  return {middle(1), middle(2)};
}

std::vector<LevelStar> LevelComplex::fans(const LevelStar& star) const {
  const std::size_t count = star.sectors.size();
  struct AtEdge {
    std::vector<std::uint32_t> begin, end;
  };
  std::unordered_map<LevelVertex, AtEdge, LevelVertexHash> at;
  for (std::uint32_t s = 0; s < count; ++s) {
    const auto [begin, end] = ends_of(star.sectors[s]);
    at[begin].begin.push_back(s);
    at[end].end.push_back(s);
  }
  DisjointSets sets(count);
  for (const auto& [edge, sectors] : at) {
    if (sectors.begin.size() == 1 && sectors.end.size() == 1) sets.join(sectors.begin[0], sectors.end[0]);
  }
  std::vector<LevelStar> fans;
  std::unordered_map<std::uint32_t, std::size_t> places;
  for (std::uint32_t s = 0; s < count; ++s) {
    const auto [place, is_new] = places.try_emplace(sets.least(s), fans.size());
    if (is_new) fans.emplace_back();
    fans[place->second].sectors.push_back(star.sectors[s]);
  }
  for (LevelStar& fan : fans) put_in_order(fan);
  return fans;
}

// Each piece's third corner is the next one's second, on the same edge.
void LevelComplex::put_in_order(LevelStar& star) const {
  const std::size_t n = star.sectors.size();
  std::vector<Ends> ends;
  for (const LevelStar::Sector& sector : star.sectors) ends.push_back(ends_of(sector));
  // Each end is met by at most one begin and the other way round: else it is no fan.
  std::unordered_map<LevelVertex, std::size_t, LevelVertexHash> begins, by_end;
  for (std::size_t s = 0; s < n; ++s) {
    if (!begins.try_emplace(ends[s].begin, s).second || !by_end.try_emplace(ends[s].end, s).second) return;
  }
  std::size_t first = 0, open = 0;
  for (std::size_t s = 0; s < n; ++s) {
    if (by_end.contains(ends[s].begin)) continue;
    first = s;
    ++open;
  }
  if (n == 0 || open > 1) return;
  std::vector<LevelStar::Sector> ordered;
  for (std::size_t s = first; ordered.size() < n;) {
    ordered.push_back(star.sectors[s]);
    const auto next = begins.find(ends[s].end);
    if (next == begins.end() || next->second == first) break;
    s = next->second;
  }
  if (ordered.size() != n) return;
  star.sectors = std::move(ordered);
  star.closed = open == 0;
  star.fan = true;
}

}  // namespace snug
