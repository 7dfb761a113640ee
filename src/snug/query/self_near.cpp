#include <snug/query/self_near.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <optional>
#include <queue>
#include <span>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include <snug/geometry/rounding.h>
#include <snug/geometry/triangle_distance.h>
#include <snug/patch/evaluate.h>
#include <snug/query/self_pieces.h>
#include <snug/search/feet.h>
#include <snug/search/gap.h>
#include <snug/shape/patch_lengths.h>
#include <snug/shape/star_distortion.h>
#include <support/parallel.h>

namespace snug {
namespace {

// Pieces around one, at most, that ways along the surface are looked for in.
constexpr std::size_t max_around = 20'000;
// That a thread keeps between two searches.
constexpr std::size_t max_nodes = 50'000;
// Looked at in the time of a pair.
constexpr std::uint64_t pieces_a_pair = 16;

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
Gap gap_between(const OffsetTriangle& a, const OffsetTriangle& b) {
  const NearestTriangles near = nearest(a.base, b.base);
  return {std::max(0.0, gap_of(near, a.radius, b.radius)), {clamped(near.on_a), clamped(near.on_b)}};
}

// An upper bound of the distance of two points of pieces.
double distance_of_points(const Patch& a, const Patch& b, const std::array<TriangleParameter, 2>& at) {
  const BoundedPoint x = limit_point(a, at[0]).from(a.origin), y = limit_point(b, at[1]).from(b.origin);
  return distance_at_most(y.position - x.position, spatial_error(x.error) + spatial_error(y.error));
}

// The pieces of one level as a thread knows them, each with its neighbours.
class LevelPieces {
 public:
  struct Vertex;
  struct Node {
    PieceName name;
    OffsetTriangle offset;
    std::array<Vertex*, 3> corners{};
    std::optional<PatchLengths> lengths;
    std::uint64_t seen = 0, partner = 0;  // in which search
    bool within = false;                  // in that search
    double gap = 0;                       // to its centre
    std::uint64_t known_gap = 0;          // in which search
    std::size_t which = 0;                // partner
  };
  struct Vertex {
    LevelVertex name;
    bool known = false;
    std::vector<Node*> around;
    std::uint64_t seen = 0;
    double way = 0;
  };

  LevelPieces(const SurfaceBvh& model, const LevelComplex& complex, unsigned level)
      : complex_(&complex), level_(level), pieces_(pieces_of_self(model)) {}

  [[nodiscard]] PieceCache& cache() { return pieces_; }
  [[nodiscard]] Node& node(const PieceName& name) {
    const auto [it, made] = nodes_.try_emplace(name);
    Node& node = it->second;
    if (!made) return node;
    node.name = name;
    node.offset = pieces_.offset(name);
    const auto corners = complex_->vertices(name);
    for (std::size_t k = 0; k < 3; ++k) {
      node.corners[k] = &vertices_.try_emplace(corners[k]).first->second;
      node.corners[k]->name = corners[k];
    }
    return node;
  }
  [[nodiscard]] const std::vector<Node*>& around(Vertex& vertex) {
    if (!vertex.known) {
      for (const auto& sector : complex_->star(vertex.name, level_).sectors) {
        vertex.around.push_back(&node(sector.piece));
      }
      vertex.known = true;
    }
    return vertex.around;
  }
  [[nodiscard]] const PatchLengths& lengths(Node& node) {
    if (!node.lengths) node.lengths = patch_lengths(pieces_.patch(node.name));
    return *node.lengths;
  }
  // Where many have come together. What was returned is gone.
  void drop_many() {
    pieces_.begin(max_bytes_of_self);
    if (nodes_.size() < max_nodes) return;
    nodes_.clear();
    vertices_.clear();
  }
  [[nodiscard]] std::uint64_t next_search() { return ++searches_; }
  [[nodiscard]] std::uint64_t this_search() const { return searches_; }
  [[nodiscard]] const LevelComplex& complex() const { return *complex_; }

 private:
  const LevelComplex* complex_;
  unsigned level_;
  PieceCache pieces_;
  std::unordered_map<PieceName, Node, PieceNameHash> nodes_;
  std::unordered_map<LevelVertex, Vertex, LevelVertexHash> vertices_;
  std::uint64_t searches_ = 0;
};

// Pieces that ways along the surface reach from one piece, and how long these ways are.
class Surroundings {
 public:
  Surroundings(LevelPieces& pieces, const PieceName& centre)
      : pieces_(pieces), centre_(pieces.node(centre)) {}

  [[nodiscard]] std::uint64_t looked_at() const { return looked_at_; }

  // Which of the pieces have ways of at most this length from any point of the centre to any of theirs?
  // Searches shortest ways along edges until all are decided, or `most` pieces are visited.
  std::vector<bool> near_by_ways(std::span<const PieceName> partners, double longest, std::uint64_t most) {
    const std::uint64_t search = pieces_.next_search();
    std::vector<bool> found(partners.size(), false);
    std::size_t open_partners = 0;
    const PatchLengths& own = pieces_.lengths(centre_);
    for (std::size_t i = 0; i < partners.size(); ++i) {
      LevelPieces::Node& node = pieces_.node(partners[i]);
      if (&node == &centre_) {
        found[i] = own.diameter <= longest;
      } else {
        node.partner = search;
        node.which = i;
        ++open_partners;
      }
    }
    using Entry = std::tuple<double, LevelVertex, LevelPieces::Vertex*>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    const auto reach = [&](LevelPieces::Vertex& v, double d) {
      if (!(d <= longest) || (v.seen == search && v.way <= d)) return;
      v.seen = search;
      v.way = d;
      open.emplace(d, v.name, &v);
    };
    for (std::size_t k = 0; k < 3; ++k) reach(*centre_.corners[k], own.from_corner[k]);
    while (!open.empty() && open_partners > 0 && looked_at_ < most) {
      const auto [d, name, v] = open.top();
      open.pop();
      if (v->way < d) continue;
      for (LevelPieces::Node* node : pieces_.around(*v)) {
        ++looked_at_;
        const PatchLengths& lengths = pieces_.lengths(*node);
        for (std::size_t i = 0; i < 3; ++i) {
          if (node->corners[i] != v) continue;
          if (node->partner == search && !found[node->which] &&
              enlarged(d + lengths.from_corner[i]) <= longest) {
            found[node->which] = true;
            --open_partners;
          }
          for (std::size_t k = 0; k < 3; ++k) {
            if (k != i) reach(*node->corners[k], enlarged(d + lengths.between(i, k)));
          }
        }
      }
    }
    return found;
  }

  // May the pieces have ways of at most `longest` to points of the centre at most `chord` from theirs? True,
  // too, where `most` is not enough to decide. Such ways stay within half the sum of both from the centre; and
  // the sum of distances from both ends is at most their length, which is tested for each piece where the
  // centre is small.
  std::vector<bool> may_reach(std::span<const PieceName> partners, double longest, double chord,
                              std::uint64_t most) {
    const double distance = enlarged(0.5 * (longest + chord));
    centre_.gap = 0;
    const bool complete = spread(most, [&](LevelPieces::Node& node) {
      node.gap = gap_between(centre_.offset, node.offset).least;
      node.known_gap = pieces_.this_search();
      return node.gap <= distance;
    });
    std::vector<bool> may(partners.size(), true);
    if (!complete) return may;
    const std::uint64_t search = pieces_.this_search();
    for (std::size_t i = 0; i < partners.size(); ++i) {
      const LevelPieces::Node& node = pieces_.node(partners[i]);
      may[i] = node.seen == search && node.within;
    }
    if (4 * pieces_.lengths(centre_).diameter > chord) return may;
    for (std::size_t i = 0; i < partners.size(); ++i) {
      const LevelPieces::Node& partner = pieces_.node(partners[i]);
      if (!may[i] || &partner == &centre_ || share_corner(pieces_.complex(), centre_.name, partner.name))
        continue;
      may[i] = !spread(most, [&](LevelPieces::Node& node) {
        // Of pieces that were not reached above the distance is not known, but more than that.
        if (node.known_gap != search) return false;
        return node.gap <= distance &&
               node.gap + gap_between(partner.offset, node.offset).least <= enlarged(longest);
      }) || (partner.seen == pieces_.this_search() && partner.within);
    }
    return may;
  }

 private:
  // From the centre on, to all pieces that are let in. False if `most` ended it.
  template <class LetIn>
  bool spread(std::uint64_t most, const LetIn& let_in) {
    const std::uint64_t search = pieces_.next_search();
    std::vector<LevelPieces::Node*> open{&centre_};
    centre_.seen = search;
    centre_.within = true;
    while (!open.empty()) {
      if (looked_at_ > most) return false;
      LevelPieces::Node& at = *open.back();
      open.pop_back();
      for (LevelPieces::Vertex* v : at.corners) {
        for (LevelPieces::Node* next : pieces_.around(*v)) {
          if (next->seen == search) continue;
          next->seen = search;
          ++looked_at_;
          next->within = let_in(*next);
          if (next->within) open.push_back(next);
        }
      }
    }
    return true;
  }

  LevelPieces& pieces_;
  LevelPieces::Node& centre_;
  std::uint64_t looked_at_ = 0;
};

class NearSearch {
 public:
  NearSearch(const SurfaceBvh& model, const LevelComplex& complex, const NearnessOptions& options,
             const WorkMonitor& monitor)
      : model_(model), complex_(complex), options_(options), monitor_(monitor), budget_(options.budget) {}

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
        answer_.budget_spent = answer_.budget_spent || 16 * live.size() > budget_;
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
    const PieceSet sets = enclosures_of(model_, pieces, options_.threads, monitor_);
    std::vector<std::vector<NearPair>> found(pieces.size());
    std::atomic<std::uint64_t> count{0};
    parallel_for(pieces.size(), options_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        monitor_.checkpoint();
        if (count.load(std::memory_order_relaxed) > budget_) return;
        QuadraticTriangle grown = sets[i];
        grown.error = enlarged(grown.error + options_.tolerance);
        for_each_near(sets, grown, [&](std::uint32_t other) {
          if (other >= i) found[i].push_back({pieces[i], pieces[other]});
        });
        std::sort(found[i].begin(), found[i].end());
        count.fetch_add(found[i].size(), std::memory_order_relaxed);
      }
    });
    std::vector<NearPair> all;
    // Too many: pairs of each piece with itself stand for those not compared.
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
    for_each_with_pieces(
        model_, live.size(), options_.threads, monitor_, [&](PieceCache& pieces, std::size_t i) {
          const Gap gap = gap_between(pieces.offset(live[i].first), pieces.offset(live[i].second));
          keep[i] = gap.least <= options_.tolerance ? 1 : 0;
        });
    spend(live.size());
    answer_.pair_tests += live.size();
    keep_if(live, [&](std::size_t i) { return keep[i] != 0; });
  }

  // Those in a star along which ways are not much longer than distances.
  void drop_stretched(std::vector<NearPair>& live, unsigned level) {
    std::vector<LevelVertex> corners;
    for (const NearPair& pair : live) {
      if (pair.far) continue;
      for (const LevelVertex& v : common_corners(complex_, pair.first, pair.second)) corners.push_back(v);
    }
    MarkedVertices short_ways(std::move(corners));
    if (short_ways.count() > budget_) {
      answer_.budget_spent = true;
      return;
    }
    for_each_with_pieces(model_, short_ways.count(), options_.threads, monitor_,
                         [&](PieceCache& pieces, std::size_t i) {
                           const double stretch = stretch_of(pieces, short_ways[i], level);
                           short_ways.mark(i, enlarged(stretch * options_.tolerance) <= options_.radius);
                         });
    spend(short_ways.count());
    answer_.stars += short_ways.count();
    std::erase_if(live, [&](const NearPair& pair) {
      return !pair.far && short_ways.any(common_corners(complex_, pair.first, pair.second));
    });
  }

  double stretch_of(PieceCache& pieces, const LevelVertex& vertex, unsigned level) const {
    const LevelStar star = complex_.star(vertex, level);
    return star.fan ? star_distortion(sectors_of(pieces, star), star.closed) : INFINITY;
  }

  // Drops those joined by short ways along the surface; finds the others that are near each other.
  void drop_by_ways(std::vector<NearPair>& live, unsigned level) {
    std::vector<std::size_t> groups;  // pairs with the same first piece
    for (std::size_t i = 0; i < live.size(); ++i) {
      if (i == 0 || live[i].first != live[i - 1].first) groups.push_back(i);
    }
    if (groups.empty()) return;
    const std::size_t count = groups.size();
    groups.push_back(live.size());
    const std::size_t most =
        std::min<std::uint64_t>(max_around, std::max<std::uint64_t>(200, pieces_a_pair * budget_ / count));
    std::vector<std::uint64_t> work(count, 0);
    std::vector<std::uint8_t> keep(live.size(), 1);
    std::vector<std::optional<ProximityPair>> near(live.size());
    parallel_for_with(
        count, options_.threads, [&] { return LevelPieces(model_, complex_, level); },
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
    for (const std::uint64_t one : work) spend(one / pieces_a_pair);
    for (const auto& one : near) {
      if (one) answer_.near.push_back(*one);
    }
    keep_if(live, [&](std::size_t i) { return keep[i] != 0; });
  }

  // The pairs of one piece. Returns how many pieces around it were visited.
  std::uint64_t look_around(LevelPieces& pieces, std::span<NearPair> group, std::size_t most,
                            std::uint8_t* keep) const {
    std::vector<std::size_t> which;
    std::vector<PieceName> partners;
    for (std::size_t i = 0; i < group.size(); ++i) {
      if (group[i].far) continue;
      which.push_back(i);
      partners.push_back(group[i].second);
    }
    if (partners.empty()) return 0;
    Surroundings around(pieces, group.front().first);
    const std::vector<bool> found = around.near_by_ways(partners, options_.radius, most);
    bool others = false;  // that are no neighbours
    for (std::size_t i = 0; i < partners.size(); ++i) {
      keep[which[i]] = found[i] ? 0 : 1;
      others = others || (!found[i] && !share_corner(complex_, group.front().first, partners[i]));
    }
    if (!others) return around.looked_at();
    const std::vector<bool> may = around.may_reach(partners, options_.radius, options_.tolerance, 4 * most);
    for (std::size_t i = 0; i < partners.size(); ++i) group[which[i]].far = !may[i];
    return around.looked_at();
  }

  std::optional<ProximityPair> proved_near(LevelPieces& pieces, const NearPair& pair) const {
    const ProximityPair near = measured(pieces.cache(), pair);
    if (near.distance.upper <= options_.tolerance) return near;
    return {};
  }

  static ProximityPair measured(PieceCache& pieces, const NearPair& pair) {
    const Gap gap = gap_between(pieces.offset(pair.first), pieces.offset(pair.second));
    const double upper = distance_of_points(pieces.patch(pair.first), pieces.patch(pair.second), gap.at);
    return {{pair.first, pair.second}, gap.at, {std::min(gap.least, upper), upper}};
  }

  void leave(const std::vector<NearPair>& live) {
    constexpr std::size_t enough = 100;
    PieceCache pieces = pieces_of_self(model_);
    for (const NearPair& pair : live) {
      if (answer_.unresolved.size() == enough) break;
      pieces.begin(max_bytes_of_self);
      answer_.unresolved.push_back(measured(pieces, pair));
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

  const SurfaceBvh& model_;
  const LevelComplex& complex_;
  const NearnessOptions& options_;
  const WorkMonitor& monitor_;
  std::uint64_t budget_;
  Nearness answer_;
};

}  // namespace

Nearness find_nearness(const SurfaceBvh& model, const LevelComplex& complex, const NearnessOptions& options,
                       const WorkMonitor& monitor) {
  return NearSearch(model, complex, options, monitor).run();
}

}  // namespace snug
