#include <snug/query/self_near.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <optional>
#include <queue>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include <snug/base/parallel.h>
#include <snug/geometry/rounding.h>
#include <snug/geometry/triangle_distance.h>
#include <snug/patch/evaluate.h>
#include <snug/patch/patch_lengths.h>
#include <snug/patch/star_stretch.h>
#include <snug/query/self_pieces.h>
#include <snug/search/quadratic_bvh.h>

namespace snug {
namespace {

// Pieces around one, at most, that ways along the surface are looked for in.
constexpr std::size_t most_around = 20'000;

struct NearPair {
  PieceName first, second;
  bool far = false;  // every way from one to the other whose ends are near each other is long
  friend auto operator<=>(const NearPair&, const NearPair&) = default;
};

// A lower bound of the distance of two pieces, and where their triangles are nearest.
struct Gap {
  double least = 0;
  std::array<TriangleParameter, 2> at;
};
Gap gap_of(const OffsetTriangle& a, const OffsetTriangle& b) {
  const NearestTriangles near = nearest(a.base, b.base);
  const double least = rounded_down(rounded_down(near.certain_distance - a.radius) - b.radius);
  return {std::max(0.0, least), {clamped(near.on_a), clamped(near.on_b)}};
}

// An upper bound of the distance of two points of pieces.
double distance_at_most(const Patch& a, const Patch& b, const std::array<TriangleParameter, 2>& at) {
  const BoundedPoint x = limit_point(a, at[0]).from(a.origin), y = limit_point(b, at[1]).from(b.origin);
  return enlarged(length(y.position - x.position) + spatial_error(x.error) + spatial_error(y.error));
}

// The pieces of one level as a thread knows them.
class LevelPieces {
 public:
  LevelPieces(const LimitSurface& surface, const LevelComplex& complex, unsigned level)
      : complex_(&complex), level_(level), pieces_(surface) {}

  [[nodiscard]] const Piece& piece(const PieceName& name) { return pieces_.piece(name); }
  [[nodiscard]] const Patch& patch(const PieceName& name) { return pieces_.patch(name); }
  [[nodiscard]] const PatchLengths& lengths(const PieceName& name) {
    const auto [it, made] = lengths_.try_emplace(name);
    if (made) it->second = patch_lengths(pieces_.patch(name), tips_);
    return it->second;
  }
  [[nodiscard]] const std::vector<PieceName>& around(const LevelVertex& vertex) {
    const auto [it, made] = around_.try_emplace(vertex);
    if (made) {
      for (const auto& sector : complex_->star(vertex, level_).sectors) it->second.push_back(sector.piece);
    }
    return it->second;
  }
  void drop_many() {
    if (!pieces_.drop_many()) return;
    lengths_.clear();
    around_.clear();
  }
  [[nodiscard]] const LevelComplex& complex() const { return *complex_; }

 private:
  const LevelComplex* complex_;
  unsigned level_;
  SelfPieces pieces_;
  TipLengths tips_;
  std::unordered_map<PieceName, PatchLengths, PieceNameHash> lengths_;
  std::unordered_map<LevelVertex, std::vector<PieceName>, LevelVertexHash> around_;
};

// What ways from one piece lead to, while they stay within some distance of it.
class Surroundings {
 public:
  // Finds the pieces that such ways can come to; not all of them if there are more than `most`.
  Surroundings(LevelPieces& pieces, const PieceName& centre, double reach, std::size_t most)
      : pieces_(pieces), centre_(centre) {
    const OffsetTriangle middle = pieces.piece(centre).offset;
    std::vector<PieceName> open{centre};
    around_.emplace(centre, true);
    while (!open.empty() && complete_) {
      const PieceName at = open.back();
      open.pop_back();
      for (const LevelVertex& v : pieces.complex().vertices(at)) {
        for (const PieceName& next : pieces.around(v)) {
          const auto [it, added] = around_.try_emplace(next, false);
          if (!added) continue;
          it->second = gap_of(middle, pieces.piece(next).offset).least <= reach;
          if (it->second) open.push_back(next);
          complete_ = complete_ && around_.size() <= most;
        }
      }
    }
  }

  [[nodiscard]] std::size_t size() const { return around_.size(); }
  // False: no such way leads there.
  [[nodiscard]] bool may_reach(const PieceName& piece) const {
    if (!complete_) return true;
    const auto it = around_.find(piece);
    return it != around_.end() && it->second;
  }

  // Distances along edges to the corners of all pieces, up to `most`.
  void find_ways(double most) {
    using Entry = std::pair<double, LevelVertex>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    const auto reach = [&](const LevelVertex& v, double d) {
      if (!(d <= most)) return;
      const auto [it, added] = ways_.try_emplace(v, d);
      if (!added && it->second <= d) return;
      it->second = d;
      open.emplace(d, v);
    };
    const PatchLengths& own = pieces_.lengths(centre_);
    const auto corners = pieces_.complex().vertices(centre_);
    for (std::size_t k = 0; k < 3; ++k) reach(corners[k], own.from_corner[k]);
    while (!open.empty()) {
      const auto [d, v] = open.top();
      open.pop();
      if (ways_.at(v) < d) continue;
      for (const PieceName& piece : pieces_.around(v)) {
        const auto at = around_.find(piece);
        if (at == around_.end() || !at->second) continue;
        const auto ends = pieces_.complex().vertices(piece);
        const PatchLengths& lengths = pieces_.lengths(piece);
        for (std::size_t i = 0; i < 3; ++i) {
          if (!(ends[i] == v)) continue;
          for (std::size_t k = 0; k < 3; ++k) {
            if (k != i) reach(ends[k], enlarged(d + lengths.between(i, k)));
          }
        }
      }
    }
  }

  // An upper bound of the distance along the surface of any two points, the second one of this piece.
  [[nodiscard]] double way_to(const PieceName& piece) {
    const PatchLengths& lengths = pieces_.lengths(piece);
    double least = piece == centre_ ? lengths.diameter : INFINITY;
    const auto corners = pieces_.complex().vertices(piece);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto it = ways_.find(corners[k]);
      if (it != ways_.end()) least = std::min(least, enlarged(it->second + lengths.from_corner[k]));
    }
    return least;
  }

 private:
  LevelPieces& pieces_;
  PieceName centre_;
  bool complete_ = true;
  std::unordered_map<PieceName, bool, PieceNameHash> around_;  // looked at: within reach?
  std::unordered_map<LevelVertex, double, LevelVertexHash> ways_;
};

class NearSearch {
 public:
  NearSearch(const LimitSurface& surface, const LevelComplex& complex, const NearnessOptions& options,
             const WorkMonitor& monitor)
      : surface_(surface),
        complex_(complex),
        options_(options),
        monitor_(monitor),
        budget_(options.budget),
        // Where the distance of two points is at most T, ways of length R between them stay this near to both.
        reach_(enlarged(0.5 * (options.radius + options.tolerance))) {}

  [[nodiscard]] Nearness run() {
    std::vector<NearPair> live = first_pairs();
    const unsigned first = complex_.first_level();
    for (unsigned depth = 0; !live.empty(); ++depth) {
      monitor_.report(static_cast<double>(depth) / (options_.levels + 1));
      const unsigned level = first + depth;
      if (live.size() <= budget_) {
        drop_apart(live);
        drop_stretched(live, level);
        drop_by_ways(live, level);
      }
      if (!answer_.near.empty()) break;
      if (depth >= options_.levels || 16 * live.size() > budget_ || level + 1 >= LevelComplex::max_level) {
        leave(live);
        break;
      }
      live = children_of(live);
      if (!live.empty()) answer_.levels = depth + 1;
    }
    return std::move(answer_);
  }

 private:
  // All pairs of pieces that may be near each other, each piece with itself too.
  std::vector<NearPair> first_pairs() {
    const std::vector<PieceName> pieces = complex_.pieces();
    const std::vector<QuadraticTriangle> sets = enclosures_of(surface_, pieces, options_.threads, monitor_);
    const QuadraticBvh tree(sets, options_.threads);
    std::vector<std::vector<NearPair>> found(pieces.size());
    std::atomic<std::uint64_t> count{0};
    parallel_for(pieces.size(), options_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        monitor_.checkpoint();
        if (count.load(std::memory_order_relaxed) > budget_) return;
        QuadraticTriangle grown = sets[i];
        grown.error = enlarged(grown.error + options_.tolerance);
        tree.for_each_near(grown, [&](std::uint32_t other) {
          if (other >= i) found[i].push_back({pieces[i], pieces[other]});
        });
        std::sort(found[i].begin(), found[i].end());
        count.fetch_add(found[i].size(), std::memory_order_relaxed);
      }
    });
    std::vector<NearPair> all;
    // Too many: each piece with itself stands for what is not looked at.
    if (count > budget_) {
      for (const PieceName& piece : pieces) all.push_back({piece, piece});
      budget_ = 0;
      return all;
    }
    for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
    return all;
  }

  void spend(std::uint64_t work) { budget_ -= std::min(budget_, work); }

  template <class Keep>
  void keep_if(std::vector<NearPair>& live, const Keep& keep) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < live.size(); ++i) {
      if (keep(i)) live[kept++] = live[i];
    }
    live.resize(kept);
  }

  // Those more than the tolerance apart.
  void drop_apart(std::vector<NearPair>& live) {
    std::vector<std::uint8_t> keep(live.size(), 0);
    parallel_for_with(
        live.size(), options_.threads, [&] { return SelfPieces(surface_); },
        [&](SelfPieces& pieces, std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) {
            monitor_.checkpoint();
            pieces.drop_many();
            const Piece& a = pieces.piece(live[i].first);
            const Gap gap = gap_of(a.offset, pieces.piece(live[i].second).offset);
            keep[i] = gap.least <= options_.tolerance ? 1 : 0;
          }
        });
    spend(live.size());
    answer_.pair_tests += live.size();
    keep_if(live, [&](std::size_t i) { return keep[i] != 0; });
  }

  // Those in a star along which ways are not much longer than distances.
  void drop_stretched(std::vector<NearPair>& live, unsigned level) {
    std::vector<LevelVertex> vertices;
    for (const NearPair& pair : live) {
      if (pair.far) continue;
      for (const LevelVertex& v : common_corners(complex_, pair.first, pair.second)) vertices.push_back(v);
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    if (vertices.size() > budget_) return;
    std::vector<std::uint8_t> short_ways(vertices.size(), 0);
    struct State {
      SelfPieces pieces;
      TipLimits tips;
    };
    parallel_for_with(
        vertices.size(), options_.threads,
        [&] {
          return State{SelfPieces(surface_), {}};
        },
        [&](State& state, std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) {
            monitor_.checkpoint();
            state.pieces.drop_many();
            const double stretch = stretch_of(state.pieces, state.tips, vertices[i], level);
            short_ways[i] = enlarged(stretch * options_.tolerance) <= options_.radius ? 1 : 0;
          }
        });
    spend(vertices.size());
    answer_.stars += vertices.size();
    keep_if(live, [&](std::size_t i) {
      if (live[i].far) return true;
      const auto common = common_corners(complex_, live[i].first, live[i].second);
      return std::none_of(common.begin(), common.end(), [&](const LevelVertex& v) {
        return short_ways[static_cast<std::size_t>(std::lower_bound(vertices.begin(), vertices.end(), v) -
                                                   vertices.begin())] != 0;
      });
    });
  }

  double stretch_of(SelfPieces& pieces, TipLimits& tips, const LevelVertex& vertex, unsigned level) const {
    const LevelStar star = complex_.star(vertex, level);
    if (!star.fan) return INFINITY;
    for (const auto& sector : star.sectors) static_cast<void>(pieces.patch(sector.piece));
    std::vector<StarSector> sectors;
    for (const auto& sector : star.sectors) sectors.push_back({&pieces.patch(sector.piece), sector.centre});
    return star_stretch(sectors, star.closed, tips);
  }

  // Those that short ways along the surface lead between; tells which others are far, and near each other.
  void drop_by_ways(std::vector<NearPair>& live, unsigned level) {
    std::vector<std::size_t> groups;  // pairs with the same first piece
    for (std::size_t i = 0; i < live.size(); ++i) {
      if (i == 0 || live[i].first != live[i - 1].first) groups.push_back(i);
    }
    if (groups.empty()) return;
    const std::size_t count = groups.size();
    groups.push_back(live.size());
    const std::size_t most =
        std::min<std::uint64_t>(most_around, std::max<std::uint64_t>(100, budget_ / count));
    std::vector<std::uint64_t> work(count, 0);
    std::vector<std::uint8_t> keep(live.size(), 1);
    std::vector<std::optional<NearPieces>> near(live.size());
    parallel_for_with(
        count, options_.threads, [&] { return LevelPieces(surface_, complex_, level); },
        [&](LevelPieces& pieces, std::size_t begin, std::size_t end) {
          for (std::size_t g = begin; g < end; ++g) {
            monitor_.checkpoint();
            pieces.drop_many();
            const std::span group(live.data() + groups[g], groups[g + 1] - groups[g]);
            work[g] = look_around(pieces, group, most, keep.data() + groups[g]);
            for (std::size_t i = groups[g]; i < groups[g + 1]; ++i) {
              if (keep[i] != 0 && live[i].far) near[i] = proved_near(pieces, live[i]);
            }
          }
        });
    for (const std::uint64_t one : work) spend(one);
    for (const auto& one : near) {
      if (one) answer_.near.push_back(*one);
    }
    keep_if(live, [&](std::size_t i) { return keep[i] != 0; });
  }

  // The pairs of one piece. Returns how many pieces around it were looked at.
  std::uint64_t look_around(LevelPieces& pieces, std::span<NearPair> group, std::size_t most,
                            std::uint8_t* keep) const {
    if (std::all_of(group.begin(), group.end(), [](const NearPair& pair) { return pair.far; })) return 0;
    Surroundings around(pieces, group.front().first, reach_, most);
    around.find_ways(options_.radius);
    for (std::size_t i = 0; i < group.size(); ++i) {
      NearPair& pair = group[i];
      if (pair.far) continue;
      if (!around.may_reach(pair.second)) {
        pair.far = true;
      } else if (around.way_to(pair.second) <= options_.radius) {
        keep[i] = 0;
      }
    }
    return around.size();
  }

  std::optional<NearPieces> proved_near(LevelPieces& pieces, const NearPair& pair) const {
    const NearPieces near = measured(pieces, pair);
    if (near.distance.upper <= options_.tolerance) return near;
    return {};
  }

  template <class AnyPieces>
  static NearPieces measured(AnyPieces& pieces, const NearPair& pair) {
    const Piece &a = pieces.piece(pair.first), &b = pieces.piece(pair.second);
    const Gap gap = gap_of(a.offset, b.offset);
    const double upper = distance_at_most(a.patch, b.patch, gap.at);
    return {{pair.first, pair.second}, gap.at, {std::min(gap.least, upper), upper}};
  }

  void leave(const std::vector<NearPair>& live) {
    constexpr std::size_t enough = 100;
    SelfPieces pieces(surface_);
    for (const NearPair& pair : live) {
      if (answer_.open.size() == enough) break;
      pieces.drop_many();
      answer_.open.push_back(measured(pieces, pair));
    }
  }

  static std::vector<NearPair> children_of(const std::vector<NearPair>& live) {
    std::vector<NearPair> next;
    for (const NearPair& pair : live) {
      for (unsigned i = 0; i < 4; ++i) {
        for (unsigned j = pair.first == pair.second ? i : 0; j < 4; ++j) {
          NearPair child{pair.first.child(i), pair.second.child(j), pair.far};
          if (child.second < child.first) std::swap(child.first, child.second);
          next.push_back(child);
        }
      }
    }
    std::sort(next.begin(), next.end());
    return next;
  }

  const LimitSurface& surface_;
  const LevelComplex& complex_;
  const NearnessOptions& options_;
  const WorkMonitor& monitor_;
  std::uint64_t budget_;
  double reach_;
  Nearness answer_;
};

}  // namespace

Nearness find_nearness(const LimitSurface& surface, const LevelComplex& complex,
                       const NearnessOptions& options, const WorkMonitor& monitor) {
  return NearSearch(surface, complex, options, monitor).run();
}

}  // namespace snug
