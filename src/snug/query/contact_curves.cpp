#include <snug/query/contact_curves.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include <snug/geometry/rounding.h>
#include <snug/mesh/disjoint_sets.h>
#include <snug/query/touching_boxes.h>
#include <snug/surface/patch_sides.h>
#include <support/parallel.h>

namespace snug {
namespace {

// Below, parameters of root patches are exact, and far from the last digit of doubles.
constexpr unsigned max_level = 40;
// Pieces smaller than the precision are split down to this share of it, as long as there are at most so many pairs.
constexpr double smallest_open = 0x1p-5;
constexpr std::size_t max_late = 1024;
// Pieces that bend less than this share of their size count as flat.
constexpr double min_bend = 0x1p-12;
// Pieces that lie in the other surface are looked for where there are so many pairs, at first, or once there are so many times more than
// a split before, which curves make two. Later on it goes on.
constexpr std::size_t min_area_pairs = 256, first_area_pairs = 2048, area_growth = 3;
// Of those with some samples on the other surface, so many times the precision are small enough.
constexpr double largest_outline = 16;
// Error of a parameter of a root patch that is computed from that of a piece.
constexpr double path_error = 0x1p-48;

// ---- Pieces against each other ----

struct PlacedPatch {
  std::shared_ptr<const Patch> patch;
  PlacedPiece placed;
};

// Result for two pieces; `late`: they are as small as was asked, but smaller ones may be separable.
struct PairOutcome {
  enum class State : std::uint8_t { apart, arcs, unresolved, split, late } state = State::apart;
  std::vector<CutArc> arcs;
  std::vector<Box3> end_boxes;
  Box3 box;
  bool reached = true;
};

class Cutter {
 public:
  Cutter(const std::array<const LimitSurface*, 2>& surfaces, const std::array<PlacedFrame, 2>& frames,
         double precision)
      : surfaces_(surfaces), frames_(frames), precision_(precision) {}

  [[nodiscard]] PlacedPatch place(std::size_t side, std::shared_ptr<const Patch> patch) const {
    PlacedPiece placed(surfaces_[side]->library(), *patch, frames_[side]);
    return {std::move(patch), std::move(placed)};
  }

  [[nodiscard]] PairOutcome compare(const PlacedPatch& a, const PlacedPatch& b) const {
    PieceCut found = cut(a.placed, b.placed);
    PairOutcome outcome;
    if (found.state == PieceCut::State::apart) return outcome;
    outcome.box = common_box(a.placed.box(), b.placed.box());
    const bool last = !which(a, b)[0] && !which(a, b)[1];
    if (found.state == PieceCut::State::arcs) {
      outcome.reached = std::all_of(found.arcs.begin(), found.arcs.end(),
                                    [&](const CutArc& arc) { return arc.deviation <= precision_; });
      outcome.state = outcome.reached || last ? PairOutcome::State::arcs : PairOutcome::State::split;
      outcome.arcs = std::move(found.arcs);
      outcome.end_boxes = std::move(found.end_boxes);
      return outcome;
    }
    const double size = std::max(longest_side(a.placed.box()), longest_side(b.placed.box()));
    outcome.reached = size <= precision_;
    outcome.state = last || size <= smallest_open * precision_ ? PairOutcome::State::unresolved
                    : outcome.reached                          ? PairOutcome::State::late
                                                               : PairOutcome::State::split;
    return outcome;
  }

  // Which are to be split: what bends more, or both; neither, if neither can be. Flat pieces stay whole as long as
  // the other one can become as small as the precision.
  [[nodiscard]] std::array<bool, 2> which(const PlacedPatch& a, const PlacedPatch& b) const {
    const std::array<const PlacedPatch*, 2> both{&a, &b};
    std::array<bool, 2> can{}, fine{}, result{};
    std::array<double, 2> size{}, bend{};
    const double limit =
        longest_side(a.placed.box()) <= precision_ && longest_side(b.placed.box()) <= precision_
            ? smallest_open * precision_
            : precision_;
    for (std::size_t s = 0; s < 2; ++s) {
      can[s] = both[s]->patch->path.level() < max_level;
      size[s] = longest_side(both[s]->placed.box());
      fine[s] = size[s] <= limit;
      bend[s] = std::clamp(both[s]->placed.slope(), min_bend, 1.0) * size[s];
    }
    for (std::size_t s = 0; s < 2; ++s) {
      const std::size_t other = 1 - s;
      const bool only = !can[other] || (fine[other] && !fine[s]);
      const bool wanted = !(fine[s] && !fine[other]) && !(bend[s] < bend[other] / 4);
      result[s] = can[s] && (only || wanted);
    }
    return result;
  }

  // The parts that a piece is to be compared by.
  [[nodiscard]] std::vector<PlacedPatch> parts(std::size_t side, const PlacedPatch& whole,
                                               bool split_it) const {
    std::vector<PlacedPatch> result;
    if (!split_it) {
      result.push_back(whole);
      return result;
    }
    for (unsigned child = 0; child < 4; ++child) {
      result.push_back(place(side, std::make_shared<const Patch>(split(*whole.patch, child))));
    }
    return result;
  }

 private:
  std::array<const LimitSurface*, 2> surfaces_;
  std::array<PlacedFrame, 2> frames_;
  double precision_;
};

// ---- Pieces that lie in the other surface ----

// Corners, middles of edges, the centre: no four are on one line.
constexpr std::array<TriangleParameter, 7> samples{
    {{1.0 / 3, 1.0 / 3}, {0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}}};
constexpr std::size_t some_samples = 4;
constexpr unsigned max_foot_steps = 32;

// Finds pieces of which all samples are on the other surface, up to less than smaller pieces could show. That proves nothing: the box
// around such a piece is left open.
class AreaPieces {
 public:
  AreaPieces(const Cutter& cutter, double precision, int threads, const WorkMonitor& monitor)
      : cutter_(cutter), precision_(precision), threads_(threads), monitor_(monitor) {}

  // Takes pairs with such a piece out of `pairs`. Of both sides at once: what lies on pieces that were taken out is not seen.
  void take_from(std::vector<CrossingPieces>& pairs, CutSurfaces& result) {
    const std::size_t before = std::exchange(pairs_before_, pairs.size());
    const bool many = before == 0 ? pairs.size() >= first_area_pairs : pairs.size() >= area_growth * before;
    if (pairs.size() < min_area_pairs || !(many || found_)) return;
    place(pairs);
    std::array<std::vector<char>, 2> lies;
    for (std::size_t s = 0; s < 2; ++s) {
      lies[s].resize(pairs_of_[s].size());
      parallel_for(lies[s].size(), threads_, [&](std::size_t begin, std::size_t end) {
        for (std::size_t g = begin; g < end; ++g) {
          monitor_.checkpoint();
          lies[s][g] = lies_in_other(s, g);
        }
      });
    }
    for (std::size_t s = 0; s < 2; ++s) {
      for (std::size_t g = 0; g < lies[s].size(); ++g) {
        const std::vector<std::uint32_t>& own = pairs_of_[s][g];
        // Where pieces of A hold all of it that counts, it needs no box.
        const bool needed =
            lies[s][g] != 0 && (s == 0 || std::any_of(own.begin(), own.end(), [&](std::uint32_t i) {
                                  return lies[0][number_[0][i]] == 0;
                                }));
        if (!needed) continue;
        const Box3& box = placed_[s][g].placed.box();
        result.unresolved.push_back({box, pairs[own.front()].roots, pairs[own.front()].contact});
        result.reached = result.reached && longest_side(box) <= precision_;
        found_ = true;
      }
    }
    std::vector<CrossingPieces> rest;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (lies[0][number_[0][i]] != 0 || lies[1][number_[1][i]] != 0) {
        result.covered.push_back(pairs[i].contact);
      } else {
        rest.push_back(std::move(pairs[i]));
      }
    }
    pairs = std::move(rest);
    pairs_before_ = pairs.size();
  }

 private:
  // Places each piece once, and groups pairs by it.
  void place(const std::vector<CrossingPieces>& pairs) {
    for (std::size_t s = 0; s < 2; ++s) {
      const auto name = [&](std::uint32_t i) {
        return std::tie(pairs[i].roots[s], pairs[i].pieces[s]->path);
      };
      std::vector<std::uint32_t> order(pairs.size());
      std::iota(order.begin(), order.end(), 0u);
      std::stable_sort(order.begin(), order.end(),
                       [&](std::uint32_t i, std::uint32_t k) { return name(i) < name(k); });
      pairs_of_[s].clear();
      number_[s].assign(pairs.size(), 0);
      for (std::size_t k = 0; k < order.size(); ++k) {
        if (k == 0 || name(order[k]) != name(order[k - 1])) pairs_of_[s].emplace_back();
        pairs_of_[s].back().push_back(order[k]);
        number_[s][order[k]] = static_cast<std::uint32_t>(pairs_of_[s].size() - 1);
      }
      std::vector<std::optional<PlacedPatch>> found(pairs_of_[s].size());
      parallel_for(found.size(), threads_, [&](std::size_t begin, std::size_t end) {
        for (std::size_t g = begin; g < end; ++g) {
          monitor_.checkpoint();
          found[g] = cutter_.place(s, pairs[pairs_of_[s][g].front()].pieces[s]);
        }
      });
      placed_[s].clear();
      for (std::optional<PlacedPatch>& one : found) placed_[s].push_back(std::move(*one));
    }
  }

  [[nodiscard]] bool lies_in_other(std::size_t s, std::size_t g) const {
    const PlacedPiece& piece = placed_[s][g].placed;
    if (!piece.bounded_slope()) return false;
    const double size = longest_side(piece.box());
    // Pieces as small as the precision bend by an eighth of its square, and curves need angles above 1e-5.
    const double noise = std::min(precision_ * precision_ / 16, 0x1p-18 * size) + 0x1p-38;
    std::size_t missed = 0;
    for (const TriangleParameter& at : samples) {
      const Point3 point = piece.origin().position + piece.at(at);
      const auto& pairs = pairs_of_[s][g];
      const bool on = std::any_of(pairs.begin(), pairs.end(), [&](std::uint32_t i) {
        return is_on(placed_[1 - s][number_[1 - s][i]].placed, point, noise);
      });
      missed += on ? 0 : 1;
      if (samples.size() - missed < some_samples) return false;
    }
    return missed == 0 || size <= largest_outline * precision_;
  }

  // Is a point on a piece, up to `noise`?
  [[nodiscard]] static bool is_on(const PlacedPiece& piece, const Point3& point, double noise) {
    if (!piece.bounded_slope()) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(point[k] >= piece.box().lower[k] - noise && point[k] <= piece.box().upper[k] + noise))
        return false;
    }
    Vector3 u, v;
    for (const Vector3& d : piece.derivatives().u) u = u + d;
    for (const Vector3& d : piece.derivatives().v) v = v + d;
    const auto count = static_cast<double>(piece.derivatives().u.size());
    u = (1 / count) * u;
    v = (1 / count) * v;
    Vector3 dual_u = cross(v, piece.normal()), dual_v = cross(piece.normal(), u);
    dual_u = (1 / dot(dual_u, u)) * dual_u;
    dual_v = (1 / dot(dual_v, v)) * dual_v;
    const Vector3 wanted = point - piece.origin().position;
    TriangleParameter at{1.0 / 3, 1.0 / 3};
    Vector3 rest;
    for (unsigned step = 0; step < max_foot_steps; ++step) {
      rest = wanted - piece.at(at);
      const double by_u = dot(dual_u, rest), by_v = dot(dual_v, rest);
      at = {at.u + by_u, at.v + by_v};
      if (!(std::fabs(at.u) + std::fabs(at.v) < 2)) return false;
      if (std::fabs(by_u) + std::fabs(by_v) < 0x1p-46) break;
    }
    constexpr double slack = 0x1p-20;
    return at.u >= -slack && at.v >= -slack && at.u + at.v <= 1 + slack && length(rest) <= noise;
  }

  const Cutter& cutter_;
  double precision_;
  int threads_;
  const WorkMonitor& monitor_;
  std::size_t pairs_before_ = 0;
  bool found_ = false;
  // By side: pairs of each piece, the piece of each pair, and pieces as placed.
  std::array<std::vector<std::vector<std::uint32_t>>, 2> pairs_of_;
  std::array<std::vector<std::uint32_t>, 2> number_;
  std::array<std::vector<PlacedPatch>, 2> placed_;
};

// ---- Ends as points of lines that pieces have in common ----

// A line along which pieces meet: a side of a root patch, or one inside of it. Parts of one line have equal names.
struct Line {
  std::uint32_t kind =
      0;  // 0 to 2: inside of a patch, by which parameter is constant; 3, 4: inside an owner, an edge
  std::uint32_t number = 0;
  double constant = 0;
  double from = 0, to = 0;  // where the part begins and ends

  [[nodiscard]] auto name() const { return std::tie(kind, number, constant); }
};

Line line_of(const LimitSurface& surface, PatchId root, const PiecePath& path, std::size_t edge) {
  const std::array<TriangleParameter, 3> corners{to_face(path, {0, 0}), to_face(path, {1, 0}),
                                                 to_face(path, {0, 1})};
  const TriangleParameter p = corners[edge], q = corners[(edge + 1) % 3];
  const auto on_side = [&](std::size_t side, double from, double to) {
    const PatchSide found = sides_of(surface, root)[side];
    if (found.reversed) {
      from = 1 - from;
      to = 1 - to;
    }
    if (found.part == PatchSide::Part::first_half || found.part == PatchSide::Part::second_half) {
      const double begin = found.part == PatchSide::Part::first_half ? 0 : 1;
      from = (begin + from) / 2;
      to = (begin + to) / 2;
    }
    const bool inside = found.part == PatchSide::Part::inside;
    return Line{inside ? 3u : 4u, found.number, 0, from, to};
  };
  if (p.v == 0 && q.v == 0) return on_side(0, p.u, q.u);
  if (p.u + p.v == 1 && q.u + q.v == 1) return on_side(1, p.v, q.v);
  if (p.u == 0 && q.u == 0) return on_side(2, 1 - p.v, 1 - q.v);
  if (p.u == q.u) return {0, root.value(), p.u, p.v, q.v};
  if (p.v == q.v) return {1, root.value(), p.v, p.u, q.u};
  return {2, root.value(), p.u + p.v, p.u, q.u};
}

// Does the surface certainly end at a line? Only edges of its mesh can be such.
bool is_border(const LimitSurface& surface, const Line& line) {
  if (line.kind != 4) return false;
  const Topology& topology = surface.topology();
  const HalfEdge half = topology.half_of(EdgeId(line.number)), twin = topology.twin(half);
  if (surface.rules().primal && twin == no_half_edge) return true;
  const auto without_surface = [&](std::size_t owner) {
    const LimitSurface::PatchRange range = surface.patches_of(owner);
    return range.begin == range.end || !surface.has_patch(PatchId(range.begin));
  };
  if (!surface.rules().primal)
    return without_surface(topology.from(half).index()) || without_surface(topology.to(half).index());
  return without_surface(topology.face_of(half).index()) || without_surface(topology.face_of(twin).index());
}

// A parameter that a piece's kind counts, as the piece does.
TriangleParameter turned(const Patch& patch, TriangleParameter p) {
  const std::array<double, 3> weights{1 - p.u - p.v, p.u, p.v};
  return {weights[patch.to_kind(1)], weights[patch.to_kind(2)]};
}

// An end: a point of a line of one surface and of a root patch of the other.
struct PlacedEnd {
  std::size_t side = 0;  // that the line is of
  Line line;
  double along = 0, doubt_along = 0;
  PatchId other;
  TriangleParameter at;
  double doubt = 0;
  PiecePath piece;  // of the other surface
  std::uint32_t number = 0;

  [[nodiscard]] auto name() const { return std::tuple(side, line.name(), other); }

  // Is the point of `end` certainly on this line's part, and in this piece?
  [[nodiscard]] bool holds(const PlacedEnd& end) const {
    const double low = std::min(line.from, line.to), high = std::max(line.from, line.to);
    if (!(end.along - end.doubt_along > low && end.along + end.doubt_along < high)) return false;
    const auto [u, v] = piece.local(end.at);
    const double off = 2 * end.doubt * piece.scale() + 0x1p-40;
    return u > off && v > off && u + v < 1 - 2 * off;
  }
};

PlacedEnd placed_end(const std::array<const LimitSurface*, 2>& surfaces, const CrossingPieces& pieces,
                     const CutEnd& end) {
  PlacedEnd result;
  result.side = end.side;
  const Patch &from = *pieces.pieces[end.side], &piece = *pieces.pieces[1 - end.side];
  result.line = line_of(*surfaces[end.side], pieces.roots[end.side], from.path, (end.edge + from.first) % 3);
  const double length = result.line.to - result.line.from;
  result.along = result.line.from + end.along * length;
  result.doubt_along = end.doubt * std::fabs(length) + path_error;
  result.other = pieces.roots[1 - end.side];
  result.at = to_face(piece.path, turned(piece, end.at));
  result.piece = piece.path;
  result.doubt = 2 * end.doubt / piece.path.scale() + path_error;
  return result;
}

ArcEnd arc_end(const CrossingPieces& pieces, const CutEnd& end) {
  ArcEnd result{end.point, {}};
  const Patch &from = *pieces.pieces[end.side], &piece = *pieces.pieces[1 - end.side];
  TriangleParameter at;
  if (end.edge == 0) at = {end.along, 0};
  if (end.edge == 1) at = {1 - end.along, end.along};
  if (end.edge == 2) at = {0, 1 - end.along};
  const auto clamped_to_root = [](TriangleParameter p) {
    p.u = std::clamp(p.u, 0.0, 1.0);
    return TriangleParameter{p.u, std::clamp(p.v, 0.0, 1 - p.u)};
  };
  result.at[end.side] = clamped_to_root(to_face(from.path, turned(from, at)));
  result.at[1 - end.side] = clamped_to_root(to_face(piece.path, turned(piece, end.at)));
  return result;
}

// Two ends are one point if the one is on the line's part and in the piece in which the other is the only point.
void join_ends(std::vector<PlacedEnd>& ends, std::vector<ChainArc>& arcs) {
  const auto less = [](const PlacedEnd& x, const PlacedEnd& y) {
    return std::tuple(x.name(), x.along, x.number) < std::tuple(y.name(), y.along, y.number);
  };
  std::sort(ends.begin(), ends.end(), less);
  constexpr std::uint32_t several = ChainArc::none - 1;
  std::vector<std::uint32_t> partner(2 * arcs.size(), ChainArc::none);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (std::size_t k = i + 1; k < ends.size() && ends[i].name() == ends[k].name(); ++k) {
      // Ends are in the order of the line.
      if (ends[k].along - ends[k].doubt_along > ends[i].along + ends[i].doubt_along + 0x1p-20) break;
      if (!ends[i].holds(ends[k]) && !ends[k].holds(ends[i])) continue;
      const std::uint32_t x = ends[i].number, y = ends[k].number;
      partner[x] = partner[x] == ChainArc::none ? y : several;
      partner[y] = partner[y] == ChainArc::none ? x : several;
    }
  }
  for (std::uint32_t i = 0; i < partner.size(); ++i) {
    const std::uint32_t p = partner[i];
    if (p < several && partner[p] == i && p / 2 != i / 2) arcs[i / 2].next[i % 2] = p;
  }
}

}  // namespace

CutSurfaces cut_surfaces(const std::array<const LimitSurface*, 2>& surfaces,
                         const std::array<PlacedFrame, 2>& frames, std::span<const CrossingPieces> pieces,
                         double precision, std::uint64_t budget, int threads, const WorkMonitor& monitor) {
  const Cutter cutter(surfaces, frames, precision);
  CutSurfaces result;
  std::vector<PlacedEnd> ends;
  struct Item {
    CrossingPieces pieces;
    PairOutcome outcome;
  };
  // Takes what is known, and leaves what is to be split.
  std::vector<Item> late;
  const auto take = [&](Item&& item, std::vector<CrossingPieces>& rest) {
    PairOutcome& outcome = item.outcome;
    if (outcome.state == PairOutcome::State::late) late.push_back(std::move(item));
    if (outcome.state == PairOutcome::State::split) rest.push_back(std::move(item.pieces));
    if (outcome.state == PairOutcome::State::arcs || outcome.state == PairOutcome::State::unresolved) {
      result.reached = result.reached && outcome.reached;
    }
    if (outcome.state == PairOutcome::State::unresolved) {
      result.unresolved.push_back({outcome.box, item.pieces.roots, item.pieces.contact});
    }
    if (outcome.state != PairOutcome::State::arcs) return;
    for (const Box3& box : outcome.end_boxes) {
      result.unresolved.push_back({box, item.pieces.roots, item.pieces.contact});
    }
    for (CutArc& arc : outcome.arcs) {
      const auto number = static_cast<std::uint32_t>(2 * result.arcs.size());
      ChainArc chained;
      for (std::uint32_t e = 0; e < 2; ++e) {
        if (!arc.ends[e].sure) continue;
        ends.push_back(placed_end(surfaces, item.pieces, arc.ends[e]));
        ends.back().number = number + e;
        chained.at_border[e] = is_border(*surfaces[arc.ends[e].side], ends.back().line);
      }
      chained.ends = {arc_end(item.pieces, arc.ends[0]), arc_end(item.pieces, arc.ends[1])};
      chained.arc = std::move(arc);
      chained.roots = item.pieces.roots;
      chained.contact = item.pieces.contact;
      result.arcs.push_back(std::move(chained));
    }
  };
  const auto take_late = [&](std::vector<CrossingPieces>& rest) {
    const bool few = late.size() <= max_late;
    for (Item& item : late) {
      if (few) {
        rest.push_back(std::move(item.pieces));
      } else {
        result.unresolved.push_back({item.outcome.box, item.pieces.roots, item.pieces.contact});
      }
    }
    late.clear();
  };
  const auto open_rest = [&](const std::vector<CrossingPieces>& rest) {
    for (const CrossingPieces& p : rest) {
      const PlacedPatch a = cutter.place(0, p.pieces[0]), b = cutter.place(1, p.pieces[1]);
      const Box3 box = common_box(a.placed.box(), b.placed.box());
      if (!box.empty()) result.unresolved.push_back({box, p.roots, p.contact});
    }
    result.budget_spent = result.budget_spent || !rest.empty();
  };
  std::vector<CrossingPieces> frontier;
  std::vector<Item> first(pieces.size());
  parallel_for(pieces.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      monitor.checkpoint();
      first[i] = {pieces[i],
                  cutter.compare(cutter.place(0, pieces[i].pieces[0]), cutter.place(1, pieces[i].pieces[1]))};
    }
  });
  result.compared += pieces.size();
  for (Item& item : first) take(std::move(item), frontier);
  take_late(frontier);
  AreaPieces areas(cutter, precision, threads, monitor);
  while (!frontier.empty()) {
    areas.take_from(frontier, result);
    // A pair makes up to 16 smaller ones.
    const std::uint64_t room = (budget - std::min(budget, result.compared)) / 16;
    if (frontier.size() > room) {
      const auto last = frontier.begin() + static_cast<std::ptrdiff_t>(room);
      open_rest({last, frontier.end()});
      frontier.erase(last, frontier.end());
    }
    std::vector<std::vector<Item>> found(frontier.size());
    std::vector<std::uint64_t> compared(frontier.size());
    parallel_for(frontier.size(), threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        monitor.checkpoint();
        const CrossingPieces& whole = frontier[i];
        const PlacedPatch a = cutter.place(0, whole.pieces[0]), b = cutter.place(1, whole.pieces[1]);
        const std::array<bool, 2> which = cutter.which(a, b);
        const std::vector<PlacedPatch> parts_a = cutter.parts(0, a, which[0]),
                                       parts_b = cutter.parts(1, b, which[1]);
        for (const PlacedPatch& p : parts_a) {
          for (const PlacedPatch& q : parts_b) {
            ++compared[i];
            PairOutcome outcome = cutter.compare(p, q);
            if (outcome.state == PairOutcome::State::apart) continue;
            found[i].push_back({{{p.patch, q.patch}, whole.roots, whole.contact}, std::move(outcome)});
          }
        }
      }
    });
    std::vector<CrossingPieces> next;
    for (std::size_t i = 0; i < found.size(); ++i) {
      result.compared += compared[i];
      for (Item& item : found[i]) take(std::move(item), next);
    }
    take_late(next);
    frontier.swap(next);
  }
  join_ends(ends, result.arcs);
  return result;
}

namespace {

class Chainer {
 public:
  explicit Chainer(const CutSurfaces& cut)
      : cut_(cut), link_(2 * cut.arcs.size()), visited_(cut.arcs.size()) {
    for (std::uint32_t i = 0; i < link_.size(); ++i) link_[i] = cut.arcs[i / 2].next[i % 2];
    link_through_open();
  }

  [[nodiscard]] Chains run() {
    Chains result;
    // Chains with ends first: what is left is closed.
    for (std::uint32_t i = 0; i < link_.size(); ++i) {
      if (link_[i] == ChainArc::none && !visited_[i / 2]) result.chains.push_back(follow(i));
    }
    for (std::uint32_t a = 0; a < cut_.arcs.size(); ++a) {
      if (!visited_[a]) result.chains.push_back(follow(2 * a));
    }
    return result;
  }

 private:
  // Joins two ends that lie in the same set of open boxes, if no third one does.
  void link_through_open() {
    if (cut_.unresolved.empty()) return;
    std::vector<Box3> boxes;
    for (const UnresolvedPieces& open : cut_.unresolved) boxes.push_back(open.box);
    const std::size_t open_count = boxes.size();
    std::vector<std::uint32_t> loose;
    for (std::uint32_t i = 0; i < link_.size(); ++i) {
      if (link_[i] != ChainArc::none) continue;
      const CutEnd& end = cut_.arcs[i / 2].arc.ends[i % 2];
      Box3 box;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lower[axis] = rounded_down(end.point[axis] - end.error);
        box.upper[axis] = rounded_up(end.point[axis] + end.error);
      }
      loose.push_back(i);
      boxes.push_back(box);
    }
    DisjointSets sets(boxes.size());
    for_each_touching(boxes, [&](std::uint32_t x, std::uint32_t y) {
      if (std::min(x, y) < open_count) sets.join(x, y);
    });
    std::vector<std::vector<std::uint32_t>> in_set(boxes.size());
    std::vector<Box3> around(boxes.size());
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
      around[sets.least(i)].add(boxes[i]);
      if (i >= open_count) in_set[sets.least(i)].push_back(loose[i - open_count]);
    }
    for (std::uint32_t s = 0; s < open_count; ++s) {
      if (in_set[s].size() != 2) continue;
      const auto [x, y] = std::pair(in_set[s][0], in_set[s][1]);
      link_[x] = y;
      link_[y] = x;
      gap_.push_back({std::min(x, y), around[s]});
    }
    std::sort(gap_.begin(), gap_.end(), [](const Gap& x, const Gap& y) { return x.end < y.end; });
  }

  [[nodiscard]] Box3 gap_between(std::uint32_t x, std::uint32_t y) const {
    const std::uint32_t end = std::min(x, y);
    const auto at = std::lower_bound(gap_.begin(), gap_.end(), end,
                                     [](const Gap& gap, std::uint32_t e) { return gap.end < e; });
    return at != gap_.end() && at->end == end ? at->box : Box3{};
  }

  [[nodiscard]] bool at_border(std::uint32_t end) const { return cut_.arcs[end / 2].at_border[end % 2]; }

  Chains::Chain follow(std::uint32_t start) {
    Chains::Chain chain{.ends = {}, .gaps = {}, .closed = false, .at_border = {}};
    std::uint32_t in = start, out = in;
    while (true) {
      visited_[in / 2] = true;
      chain.ends.push_back(in);
      out = in ^ 1u;
      const std::uint32_t next = link_[out];
      if (next == ChainArc::none) break;
      chain.gaps.push_back(gap_between(out, next));
      if (next == start) {
        chain.closed = true;
        break;
      }
      in = next;
    }
    if (!chain.closed) chain.at_border = {at_border(start), at_border(out)};
    return chain;
  }

  struct Gap {
    std::uint32_t end;
    Box3 box;
  };
  const CutSurfaces& cut_;
  std::vector<std::uint32_t> link_;
  std::vector<bool> visited_;
  std::vector<Gap> gap_;
};

}  // namespace

Chains chains_of(const CutSurfaces& cut) { return Chainer(cut).run(); }

}  // namespace snug
