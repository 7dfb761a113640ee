#include <snug/independence/piece_step.h>

#include <algorithm>
#include <set>

#include <support/contract.h>

namespace snug {
namespace {

bool shares_vertex(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
  return std::any_of(a.begin(), a.end(),
                     [&](std::uint32_t v) { return std::find(b.begin(), b.end(), v) != b.end(); });
}

// Are all faces around the corners of a face there? Those at a boundary have two boundary edges.
bool surrounded(const NetPart& net, const std::vector<std::uint32_t>& corners,
                const std::vector<std::vector<std::uint32_t>>& around) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& face : around) {
    for (std::size_t i = 0; i < face.size(); ++i) edges.emplace(face[i], face[(i + 1) % face.size()]);
  }
  return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
    const auto [a, b] = edge;
    return !shares_vertex({a, b}, corners) || edges.contains({b, a}) ||
           net.boundary.contains(std::minmax(a, b));
  });
}

// Each control point of a regular piece: of its face (primal) and the faces around; with Loop's valence 3 one comes twice. At
// a boundary those that are there: what else the polynomial has are combinations of them.
std::vector<Functional> primal_functionals(const NetPart& net, std::uint32_t face) {
  std::vector<std::vector<std::uint32_t>> around;
  std::set<std::uint32_t> points;
  for (const auto& other : net.faces) {
    if (!shares_vertex(other, net.faces[face])) continue;
    around.push_back(other);
    points.insert(other.begin(), other.end());
  }
  SNUG_EXPECT(surrounded(net, net.faces[face], around));
  SNUG_EXPECT(!net.boundary.empty() || points.size() >= (net.faces[face].size() == 3 ? 11U : 16U));
  std::vector<Functional> all;
  for (const std::uint32_t p : points) all.push_back({{p, 1}});
  return all;
}

std::vector<Functional> dual_functionals(const NetPart& net, std::uint32_t vertex, bool midedge) {
  std::set<std::uint32_t> beside, diagonal;
  for (const auto& face : net.faces) {
    const auto at = std::find(face.begin(), face.end(), vertex);
    if (at == face.end()) continue;
    SNUG_EXPECT(face.size() == 4);
    const auto i = static_cast<std::size_t>(at - face.begin());
    beside.insert({face[(i + 1) % 4], face[(i + 3) % 4]});
    diagonal.insert(face[(i + 2) % 4]);
  }
  SNUG_EXPECT(beside.size() == 4 && diagonal.size() == 4);
  std::vector<Functional> all;
  if (!midedge) all.push_back({{vertex, 1}});
  for (const std::uint32_t p : beside)
    all.push_back(midedge ? Functional{{vertex, 1}, {p, 1}} : Functional{{p, 1}});
  for (const std::uint32_t p : diagonal)
    all.push_back(midedge ? Functional{{vertex, 1}, {p, -1}} : Functional{{p, 1}});
  return all;
}

std::vector<Functional> functionals(const ExactScheme& scheme, const NetPart& net, std::uint32_t child) {
  return scheme.dual() ? dual_functionals(net, child, scheme.scheme == Scheme::midedge)
                       : primal_functionals(net, child);
}

// `edge`: where the net's edge (0, 1) is in the finer one; `children`: the regular pieces.
PieceStep kept_step(const ExactScheme& scheme, const NetPart& net, const RefinedNet& fine,
                    std::array<std::uint32_t, 2> edge,
                    const std::array<std::pair<std::uint32_t, std::uint32_t>, 3>& children) {
  const std::vector<std::uint32_t> kept = embedded(net, {0, 1}, fine.net, edge);
  // Kept rows first, in the order of the net.
  PieceStep step;
  step.dimension = step.kept = net.points;
  std::vector<std::uint32_t> number(fine.rows.size(), UINT32_MAX);
  for (const std::uint32_t p : kept) {
    number[p] = static_cast<std::uint32_t>(step.rows.size());
    step.rows.push_back(fine.rows[p]);
  }
  for (std::uint32_t p = 0; p < fine.rows.size(); ++p) {
    if (number[p] != UINT32_MAX) continue;
    number[p] = static_cast<std::uint32_t>(step.rows.size());
    step.rows.push_back(fine.rows[p]);
  }
  for (const auto& child : children) {
    step.pieces.push_back(functionals(scheme, fine.net, fine.child.at(child)));
    for (Functional& functional : step.pieces.back()) {
      for (auto& [row, sign] : functional) row = number[row];
    }
  }
  return step;
}

}  // namespace

PieceStep piece_step(const ExactScheme& scheme, std::uint32_t n, std::uint32_t order) {
  using Children = std::array<std::pair<std::uint32_t, std::uint32_t>, 3>;
  const NetPart net = piece_net(scheme, n);
  const RefinedNet fine = refine(net, scheme, order == 0 ? n : order);
  if (scheme.dual())
    return kept_step(scheme, net, fine, {fine.child.at({0, 0}), fine.child.at({0, 1})},
                     {{{1, 1}, {2, 0}, {3, 0}}});
  const Children children = scheme.scheme == Scheme::loop ? Children{{{n - 1, 2}, {n - 1, 3}, {n - 1, 1}}}
                                                          : Children{{{1, 1}, {1, 2}, {1, 3}}};
  return kept_step(scheme, net, fine, {*fine.of_vertex[0], fine.of_edge.at({0, 1})}, children);
}

PieceStep boundary_step(const ExactScheme& scheme, std::uint32_t faces, const BoundaryFace& at) {
  const NetPart net = boundary_net(scheme, faces, at);
  const RefinedNet fine = refine(net, scheme, 1);
  const std::uint32_t face = at.face - 1;
  const std::uint32_t middle = scheme.scheme == Scheme::loop ? 3 : 2,
                      last = scheme.scheme == Scheme::loop ? 2 : 3;
  return kept_step(scheme, net, fine, {*fine.of_vertex[0], fine.of_edge.at({0, 1})},
                   {{{face, 1}, {face, middle}, {face, last}}});
}

TwoCornerStep two_corner_step(const ExactScheme& scheme, const PieceCorners& corners, std::uint32_t order) {
  const bool loop = scheme.scheme == Scheme::loop;
  SNUG_EXPECT(corners.second && !(loop && (corners.opposite || corners.valence + *corners.second < 7)));
  const NetPart net = two_corner_net(scheme, corners);
  const RefinedNet fine = refine(net, scheme, order);
  // Dual: at the vertex in each of its faces, where it is the first corner; primal: at the corners of the face.
  const auto child = [&](std::uint32_t i) {
    return fine.child.at(scheme.dual() ? std::pair{i, 0U} : std::pair{0U, i});
  };
  const std::uint32_t second = corners.opposite ? 2 : 1;
  TwoCornerStep result;
  result.step.dimension = net.points;
  result.step.rows = fine.rows;
  for (std::uint32_t i = 0; i < 4; ++i) {
    if (i != 0 && i != second) result.step.pieces.push_back(functionals(scheme, fine.net, child(i)));
  }
  for (const std::uint32_t i : {0U, second}) {
    TwoCornerStep::Part& part = result.parts[i == 0 ? 0 : 1];
    part.valence = i == 0 ? corners.valence : *corners.second;
    // An edge of each net from the corner along the piece, or around the face.
    const std::uint32_t next = (i + 1) % (loop ? 3 : 4);
    const NetPart own = piece_net(scheme, part.valence);
    const std::array<std::uint32_t, 2> edge{0, scheme.dual() ? 1 : loop ? part.valence : 3};
    const std::array<std::uint32_t, 2> fine_edge =
        scheme.dual()
            ? std::array{fine.child.at({i, 0}), fine.child.at({i, 1})}
            : std::array{*fine.of_vertex[i], fine.of_edge.at({std::min(i, next), std::max(i, next)})};
    for (const std::uint32_t p : embedded(own, edge, fine.net, fine_edge)) part.net.push_back(fine.rows[p]);
  }
  return result;
}

PieceStep annulus_step(const ExactScheme& scheme, std::uint32_t n) {
  const NetPart net = annulus_net(scheme, n);
  RefinedNet fine = refine(net, scheme, n);
  PieceStep step;
  step.dimension = net.points;
  for (const auto& [at, child] : fine.child) {
    const auto [face, corner] = at;
    const std::vector<std::uint32_t>& corners = net.faces[face];
    bool regular;  // a part of a piece at the corner, but not its part there
    if (scheme.dual()) {
      regular = face != 0 && corners[corner] < n;
    } else {
      regular = corners[0] == 0 && corner != 0;
    }
    if (regular) step.pieces.push_back(functionals(scheme, fine.net, child));
  }
  SNUG_EXPECT(step.pieces.size() == 3 * n);
  step.rows = std::move(fine.rows);
  return step;
}

PieceStep mesh_step(const RefinedNet& refined, std::uint32_t points) {
  return {points, refined.rows, {}, refined.net.points};
}

}  // namespace snug
