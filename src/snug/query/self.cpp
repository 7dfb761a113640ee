#include <snug/query/self.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <snug/base/error.h>
#include <snug/base/names.h>
#include <snug/base/parallel.h>
#include <snug/geometry/rounding.h>
#include <snug/patch/evaluate.h>
#include <snug/patch/star.h>
#include <snug/search/crossing.h>
#include <snug/search/quadratic_bvh.h>
#include <snug/surface/evaluate.h>
#include <snug/surface/level_complex.h>
#include <snug/surface/unscale.h>

namespace snug {
namespace {

constexpr auto verdict_names = std::to_array<Named<SelfVerdict>>({{"clear", SelfVerdict::clear},
                                                                  {"intersecting", SelfVerdict::intersecting},
                                                                  {"undecided", SelfVerdict::undecided}});

// Pieces that a thread keeps between two pairs or stars.
constexpr std::size_t most_kept = 20'000;
// Of one pair: pieces compared, crossings tried.
constexpr std::uint64_t most_tests = 4000;
constexpr int most_attempts = 40;
// Splits of a patch after which a pair is given up.
constexpr unsigned deepest = 20;

using NamePair = std::pair<PieceName, PieceName>;

// Patches and their pieces, by name.
class Pieces {
 public:
  explicit Pieces(const LimitSurface& surface) : surface_(&surface) {}

  [[nodiscard]] const Patch& patch(const PieceName& name) {
    if (const auto it = patches_.find(name); it != patches_.end()) return it->second;
    Patch made =
        name.splits == 0 ? surface_->patch(PatchId(name.patch)) : split(patch(name.parent()), name.digit());
    return patches_.emplace(name, std::move(made)).first->second;
  }
  [[nodiscard]] const Piece& piece(const PieceName& name) {
    if (const auto it = pieces_.find(name); it != pieces_.end()) return it->second;
    Piece made = make_piece(surface_->library(), PatchId(name.patch), patch(name), scratch_);
    return pieces_.emplace(name, std::move(made)).first->second;
  }
  void drop_many() {
    if (patches_.size() + pieces_.size() < most_kept) return;
    patches_.clear();
    pieces_.clear();
  }

 private:
  const LimitSurface* surface_;
  std::unordered_map<PieceName, Patch, PieceNameHash> patches_;
  std::unordered_map<PieceName, Piece, PieceNameHash> pieces_;
  HullPoints scratch_;
};

// What became of a pair of pieces: apart, or where it is not.
struct Found {
  enum class What : std::uint8_t { apart, crossing, unknown } what = What::apart;
  NamePair pieces;
  std::array<TriangleParameter, 2> at;
  double lower = 0;
  std::uint64_t tests = 0;
};

double size_of(const Piece& piece) {
  const Triangle& t = piece.offset.base;
  return std::max({length(t[1] - t[0]), length(t[2] - t[1]), length(t[0] - t[2])});
}

// Proves two pieces without a common corner to be apart, or some in them to cross.
Found compare(Pieces& pieces, BoundsCache& library, const NamePair& whole, std::uint64_t budget) {
  Found found;
  std::vector<NamePair> stack{whole};
  int attempts = 0;
  while (!stack.empty()) {
    const auto [a, b] = stack.back();
    stack.pop_back();
    const Piece& x = pieces.piece(a);
    const Piece& y = pieces.piece(b);
    ++found.tests;
    const NearestTriangles near = nearest(x.offset.base, y.offset.base);
    const double gap = rounded_down(rounded_down(near.certain_distance - x.offset.radius) - y.offset.radius);
    if (gap > 0) continue;
    const double size_x = size_of(x), size_y = size_of(y);
    if (near.certain_distance == 0 && attempts < most_attempts &&
        x.offset.radius + y.offset.radius <= std::min(size_x, size_y) / 16) {
      ++attempts;
      if (const auto at = certain_crossing(library, x, y)) {
        found.what = Found::What::crossing;
        found.pieces = {a, b};
        found.at = {clamped(at->on_a), clamped(at->on_b)};
        return found;
      }
    }
    const bool may_x = x.can_split() && a.splits < deepest, may_y = y.can_split() && b.splits < deepest;
    if (found.tests >= budget || (!may_x && !may_y)) {
      if (found.what == Found::What::apart) {
        found.what = Found::What::unknown;
        found.pieces = {a, b};
        found.at = {clamped(near.on_a), clamped(near.on_b)};
      }
      // A crossing may still be found elsewhere, but not where rounding is all there is.
      if (found.tests >= budget) return found;
      continue;
    }
    const bool first = may_x && (!may_y || size_x >= size_y);
    for (unsigned child = 4; child-- > 0;) {
      stack.push_back(first ? NamePair{a.child(child), b} : NamePair{a, b.child(child)});
    }
  }
  return found;
}

class SelfSearch {
 public:
  SelfSearch(const LimitSurface& surface, const SelfContactOptions& options, const WorkMonitor& monitor)
      : surface_(surface), options_(options), monitor_(monitor), complex_(surface), budget_(options.budget) {}

  [[nodiscard]] SelfContact run() {
    const std::vector<PieceName> pieces = complex_.pieces();
    if (pieces.empty()) {
      throw InputError(
          InputProblem::refused,
          "no face has a limit surface: all are holes or touch the boundary; use another boundary rule");
    }
    unsigned level = complex_.first_level();
    compare_far(far_pairs(pieces));
    std::vector<NamePair> live = near_pairs(pieces);
    for (unsigned depth = 0; !live.empty() && !crossing_; ++depth, ++level) {
      monitor_.checkpoint();
      drop_proved(live, level);
      if (live.empty()) break;
      if (depth >= options_.levels || live.size() > budget_ || level + 1 >= LevelComplex::max_level) {
        for (const NamePair& pair : live) leave(pair);
        break;
      }
      std::vector<NamePair> far;
      live = split_pairs(live, far);
      compare_far(far);
      answer_.levels = depth + 1;
    }
    return result();
  }

 private:
  [[nodiscard]] bool share_corner(const PieceName& a, const PieceName& b) const {
    const auto x = complex_.vertices(a), y = complex_.vertices(b);
    return std::any_of(x.begin(), x.end(),
                       [&](const LevelVertex& v) { return std::find(y.begin(), y.end(), v) != y.end(); });
  }

  // All pairs of the first level whose enclosures are near and that have no corner in common.
  std::vector<NamePair> far_pairs(const std::vector<PieceName>& pieces) {
    std::vector<QuadraticTriangle> sets(pieces.size());
    parallel_for_with(
        pieces.size(), options_.threads, [&] { return Pieces(surface_); },
        [&](Pieces& kept, std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) {
            kept.drop_many();
            const OffsetTriangle& offset = kept.piece(pieces[i]).offset;
            sets[i] = flat_quadratic(offset.base);
            sets[i].error = enlarged(sets[i].error + offset.radius);
          }
        });
    for (const QuadraticTriangle& set : sets) {
      if (!std::isfinite(set.error)) {
        throw InputError(InputProblem::unrepresentable,
                         "a bound of a patch does not fit a double; move the mesh nearer to the origin");
      }
    }
    const QuadraticBvh tree(sets, options_.threads);
    std::vector<std::vector<NamePair>> found(pieces.size());
    parallel_for(pieces.size(), options_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        monitor_.checkpoint();
        tree.for_each_near(sets[i], [&](std::uint32_t other) {
          if (other > i && !share_corner(pieces[i], pieces[other]))
            found[i].emplace_back(pieces[i], pieces[other]);
        });
        std::sort(found[i].begin(), found[i].end());
      }
    });
    std::vector<NamePair> all;
    for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
    return all;
  }

  // All pairs with a common corner, each piece with itself too.
  std::vector<NamePair> near_pairs(const std::vector<PieceName>& pieces) const {
    std::unordered_map<LevelVertex, std::vector<PieceName>, LevelVertexHash> around;
    for (const PieceName& piece : pieces) {
      for (const LevelVertex& v : complex_.vertices(piece)) around[v].push_back(piece);
    }
    std::vector<NamePair> pairs;
    for (const auto& [vertex, all] : around) {
      for (const PieceName& a : all) {
        for (const PieceName& b : all) {
          if (a <= b) pairs.emplace_back(a, b);
        }
      }
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
  }

  // Of two pieces of one level.
  [[nodiscard]] std::vector<LevelVertex> common_corners(const NamePair& pair) const {
    const auto x = complex_.vertices(pair.first), y = complex_.vertices(pair.second);
    std::vector<LevelVertex> common;
    for (const LevelVertex& v : x) {
      if (std::find(y.begin(), y.end(), v) != y.end()) common.push_back(v);
    }
    return common;
  }

  // Leaves pairs no common corner of which has a star that is proved to be injective.
  void drop_proved(std::vector<NamePair>& live, unsigned level) {
    std::vector<LevelVertex> vertices;
    for (const NamePair& pair : live) {
      for (const LevelVertex& v : common_corners(pair)) vertices.push_back(v);
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    if (vertices.size() > budget_) return;
    std::vector<std::uint8_t> proved(vertices.size(), 0);
    struct State {
      Pieces pieces;
      TipLimits tips;
    };
    parallel_for_with(
        vertices.size(), options_.threads,
        [&] {
          return State{Pieces(surface_), {}};
        },
        [&](State& state, std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) {
            monitor_.checkpoint();
            state.pieces.drop_many();
            proved[i] = star_holds(state.pieces, state.tips, vertices[i], level) ? 1 : 0;
          }
        });
    spend(vertices.size());
    answer_.stars += vertices.size();
    std::erase_if(live, [&](const NamePair& pair) {
      const auto common = common_corners(pair);
      return std::any_of(common.begin(), common.end(), [&](const LevelVertex& v) {
        return proved[static_cast<std::size_t>(std::lower_bound(vertices.begin(), vertices.end(), v) -
                                               vertices.begin())] != 0;
      });
    });
  }

  [[nodiscard]] bool star_holds(Pieces& pieces, TipLimits& tips, const LevelVertex& vertex,
                                unsigned level) const {
    const LevelStar star = complex_.star(vertex, level);
    if (!star.fan) return false;
    for (const auto& sector : star.sectors) static_cast<void>(pieces.patch(sector.piece));
    std::vector<StarSector> sectors;
    for (const auto& sector : star.sectors) sectors.push_back({&pieces.patch(sector.piece), sector.centre});
    return certainly_injective(sectors, star.closed, tips);
  }

  // The children's pairs: those with a common corner, and `far` the others.
  std::vector<NamePair> split_pairs(const std::vector<NamePair>& live, std::vector<NamePair>& far) const {
    std::vector<NamePair> next;
    for (const auto& [a, b] : live) {
      for (unsigned i = 0; i < 4; ++i) {
        for (unsigned j = a == b ? i : 0; j < 4; ++j) {
          NamePair pair{a.child(i), b.child(j)};
          if (pair.second < pair.first) std::swap(pair.first, pair.second);
          (share_corner(pair.first, pair.second) ? next : far).push_back(pair);
        }
      }
    }
    std::sort(next.begin(), next.end());
    std::sort(far.begin(), far.end());
    return next;
  }

  void compare_far(const std::vector<NamePair>& pairs) {
    if (pairs.empty()) return;
    const std::uint64_t each = std::min(most_tests, budget_ / pairs.size());
    std::vector<Found> found(pairs.size());
    parallel_for_with(
        pairs.size(), options_.threads, [&] { return Pieces(surface_); },
        [&](Pieces& kept, std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) {
            monitor_.checkpoint();
            kept.drop_many();
            found[i] = compare(kept, surface_.library(), pairs[i], std::max<std::uint64_t>(each, 1));
          }
        });
    for (const Found& one : found) {
      answer_.pair_tests += one.tests;
      spend(one.tests);
      if (one.what == Found::What::crossing) crossing_ = true;
      if (one.what != Found::What::apart) found_.push_back(one);
    }
  }

  void leave(const NamePair& pair) {
    Found found;
    found.what = Found::What::unknown;
    found.pieces = pair;
    const auto common = common_corners(pair);
    const auto corner_at = [&](const PieceName& piece) {
      const auto corners = complex_.vertices(piece);
      const auto k = std::find(corners.begin(), corners.end(), common.front()) - corners.begin();
      return TriangleParameter{k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0};
    };
    found.at = {corner_at(pair.first), corner_at(pair.second)};
    found_.push_back(found);
  }

  void spend(std::uint64_t work) { budget_ -= std::min(budget_, work); }

  SelfContact result() {
    answer_.verdict = crossing_        ? SelfVerdict::intersecting
                      : found_.empty() ? SelfVerdict::clear
                                       : SelfVerdict::undecided;
    for (const Found& found : found_) {
      const bool crossing = found.what == Found::What::crossing;
      if (crossing != crossing_ || answer_.pairs.size() == SelfContact::max_pairs) continue;
      SelfContactPair pair;
      pair.verdict = crossing ? SelfVerdict::intersecting : SelfVerdict::undecided;
      const std::array<PieceName, 2> names{found.pieces.first, found.pieces.second};
      double error = 0;
      for (std::size_t s = 0; s < 2; ++s) {
        pair.at[s] = place_of(surface_, PatchId(names[s].patch), to_face(names[s].path(), found.at[s]));
        const SurfacePoint point = evaluate(surface_, pair.at[s]);
        pair.points[s] = point.position;
        error += spatial_error(point.error);
      }
      if (!crossing) {
        const double apart = length(pair.points[1] - pair.points[0]);
        pair.distance.upper = enlarged(apart + error + gamma_bound(4) * max_abs(pair.points[0] - Point3{}));
      }
      answer_.pairs.push_back(pair);
    }
    return answer_;
  }

  const LimitSurface& surface_;
  const SelfContactOptions& options_;
  const WorkMonitor& monitor_;
  LevelComplex complex_;
  std::uint64_t budget_;
  std::vector<Found> found_;
  bool crossing_ = false;
  SelfContact answer_;
};

}  // namespace

const char* name_of(SelfVerdict verdict) { return name_in(verdict_names, verdict); }

SelfContact self_contact(const LimitSurface& surface, const SelfContactOptions& options,
                         const WorkMonitor& monitor) {
  require_value(options.levels <= 20, "self: more than 20 levels; give fewer");
  return SelfSearch(surface, options, monitor).run();
}

}  // namespace snug
