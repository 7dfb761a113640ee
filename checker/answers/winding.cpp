#include <algorithm>
#include <numeric>

#include "disc.h"
#include "tree.h"

// Winding numbers, and what they say of solids: docs/certificates.md.
namespace answers {
namespace {

// Is every face part of the surface, and do as many faces run one way along each edge as the other?
// Edges of more than two faces are infinitely sharp, so that all of these have their curve.
bool is_closed(const PieceSet& all) {
  const Net& net = all.net();
  if (!all.rules().dual() && all.size() != net.faces.size()) return false;
  for (Index e = 0; e < net.on_edge.size(); ++e) {
    const auto [a, b] = net.ends(e);
    if (a == b) continue;
    const auto forwards = std::ranges::count_if(
        net.on_edge[e], [&, from = a](Index h) { return net.vertex(h) == from; });
    if (2 * forwards != std::ssize(net.on_edge[e])) return false;
  }
  return true;
}

// For each vertex the number of its component.
std::vector<Index> components(const Net& net) {
  std::vector<Index> root(net.points.size());
  std::iota(root.begin(), root.end(), 0U);
  const auto find = [&](Index v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  for (Index f = 0; f < net.faces.size(); ++f) {
    for (const Index v : net.faces[f]) root[find(v)] = find(net.faces[f][0]);
  }
  for (Index v = 0; v < root.size(); ++v) root[v] = find(v);
  return root;
}

Index vertex_of(const PieceSet& all, Index owner) {
  return all.rules().dual() ? all.net().vertex(owner) : all.net().faces[owner][0];
}

// Is each component that has faces among these?
bool are_all(const PieceSet& all, const std::vector<Index>& owners) {
  const std::vector<Index> component = components(all.net());
  std::vector<bool> seen(component.size());
  for (const Index owner : owners) seen[component[vertex_of(all, owner)]] = true;
  return std::ranges::all_of(all.owners(),
                             [&](Index owner) { return seen[component[vertex_of(all, owner)]]; });
}

// How often a piece crosses a half-line, by sign: a number that stays when the piece moves, while
// its border keeps off the line and all of it off the line's first point. So the piece may become
// the triangles between its corners.
int crossings_of(Words& words, const PieceSet& piece, const Side& surface, const Side& line) {
  const auto require_apart = [&](const Hull& hull, bool only_start) {
    const Point w = read_direction(words);
    const Real start = dot(w, line.points[0]);
    const bool before = (start - extreme(hull, surface.pose, w, true)).certainly_positive();
    const bool behind = (extreme(hull, surface.pose, w, false) - start).certainly_positive();
    if (before && (only_start || !goes_back(line, w, false))) return;
    if (behind && (only_start || !goes_back(line, w, true))) return;
    words.refuse("this piece is not held off the line by this direction");
  };
  Disc disc(words, piece.only(0), surface.pose);
  require_apart(read_finer(words, disc.piece()), true);
  for (std::size_t k = 0; k < disc.corner_count(); ++k) {
    require_apart(disc.read_border(words, k), false);
  }
  const auto crossed =
      crossings(line.points[0], *line.direction, nullptr, disc.read_corners(words));
  if (!crossed) words.refuse("it is not seen whether the line crosses these triangles");
  return *crossed;
}

}  // namespace

std::string prove_winding(Words& words, Question& question, LeastSlack& least) {
  const std::size_t side = words.count(1);
  const Side &of_point = question.sides[side], &surface = question.sides[1 - side];
  if (!surface.pieces || !is_closed(*surface.pieces)) words.refuse("no closed surface");
  if (!of_point.pieces && (of_point.direction || of_point.points.size() != 1))
    words.refuse("neither a surface nor a point");
  const Place place = read_place(words, of_point);
  constexpr std::int64_t most = std::int64_t{1} << 31;
  const std::int64_t number = words.integer(-most, most);
  Side line;
  line.points.push_back(place.box);
  Point& direction = line.direction.emplace();
  for (Real& x : direction) x = Real(words.real());
  if (std::ranges::all_of(direction, [](const Real& x) { return x.is_exactly_zero(); }))
    words.refuse("a half-line without a direction");
  std::int64_t sum = 0;
  const Tree tree(words, {&surface, &line}, 0, least);
  tree.prove({0, 1, surface.pieces}, {1, 2}, [&](const Range& pieces, const Range&) {
    if (pieces.pieces->size() != 1) words.refuse("more than one piece");
    sum += crossings_of(words, *pieces.pieces, surface, line);
  });
  if (sum != number) words.refuse("the crossings of the line are not of this sum");
  if (!of_point.pieces) return "have the winding number " + std::to_string(number);
  if (number != 0) question.inside = true;
  if (number == 0) question.outside[side].push_back(place.owner);
  return {};
}

std::string prove_solids(const Words& words, const Question& question) {
  bool outside = question.apart;
  for (std::size_t side = 0; side < 2; ++side) {
    const PieceSet* const all = question.sides[side].pieces;
    if (!all || !is_closed(*all)) words.refuse("no closed surfaces");
    outside = outside && are_all(*all, question.outside[side]);
  }
  if (outside) return "bound solids that are as far apart";
  if (question.inside) return "bound solids that have a point in common";
  words.refuse("nothing is proved of all components");
}

}  // namespace answers
