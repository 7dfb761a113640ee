#include <snug/query/self.h>
#include <snug/search/surface_data.h>

#include <algorithm>
#include <limits>
#include <set>
#include <unordered_map>
#include <utility>

#include <snug/geometry/rounding.h>
#include <snug/patch/evaluate.h>
#include <snug/query/self_exact.h>
#include <snug/query/self_facets.h>
#include <snug/query/self_near.h>
#include <snug/query/self_pieces.h>
#include <snug/search/crossing.h>
#include <snug/search/feet.h>
#include <snug/search/frontier.h>
#include <snug/search/gap.h>
#include <snug/shape/star.h>
#include <snug/surface/evaluate.h>
#include <snug/surface/level_complex.h>
#include <snug/surface/unscale.h>
#include <support/error.h>
#include <support/names.h>
#include <support/parallel.h>
#include <support/run.h>

namespace snug {
namespace {

constexpr auto self_verdict_names =
    std::to_array<Named<SelfVerdict>>({{"clear", SelfVerdict::clear},
                                       {"intersecting", SelfVerdict::intersecting},
                                       {"near", SelfVerdict::near},
                                       {"undecided", SelfVerdict::undecided}});

// Levels that pieces are compared at for nearness, beside those for stars.
constexpr unsigned further_levels = 6;
// Distances along the surface that count, against the tolerance.
constexpr double min_radius = 2, default_radius = 4;
// Of one pair: pieces compared, crossings tried.
constexpr std::uint64_t max_tests = 4000;
constexpr int max_pair_attempts = 40;
// Splits of a patch after which a pair is given up.
constexpr unsigned deepest = 20;

using NamePair = std::pair<PieceName, PieceName>;

// Result for a pair of pieces: apart, or where they are not.
struct Found {
  enum class What : std::uint8_t { apart, crossing, touching, unknown } what = What::apart;
  NamePair pieces;
  std::array<TriangleParameter, 2> at;
  double lower = 0;
  std::uint64_t tests = 0;
};

double size_of(const OffsetTriangle& offset) {
  const Triangle& t = offset.base;
  return std::max({length(t[1] - t[0]), length(t[2] - t[1]), length(t[0] - t[2])});
}

// Proves two pieces without a common corner to be apart, or some in them to cross.
class PairComparison {
 public:
  PairComparison(PieceCache& pieces, std::uint64_t budget) : pieces_(pieces), budget_(budget) {}

  Found run(const NamePair& whole) {
    open_.start(Order::last_first, whole);
    search(open_, *this);
    return found_;
  }

  Verb look_at(const NamePair& pair) {
    const auto& [a, b] = pair;
    const OffsetTriangle &x = pieces_.offset(a), &y = pieces_.offset(b);
    ++found_.tests;
    const NearestTriangles near = nearest(x.base, y.base);
    if (gap_of(near, x.radius, y.radius) > 0) return Verb::drop;
    const double size_x = size_of(x), size_y = size_of(y);
    if (near.certain_distance == 0 && attempts_ < max_pair_attempts &&
        x.radius + y.radius <= std::min(size_x, size_y) / 16) {
      ++attempts_;
      if (const auto at = proved_crossing(pieces_.model().surface().library(), {a.patch, pieces_.patch(a), x},
                                          {b.patch, pieces_.patch(b), y})) {
        set(Found::What::crossing, pair, {clamped(at->on_a), clamped(at->on_b)});
        return Verb::stop;
      }
    }
    const bool may_x = can_split(pieces_.patch(a), x) && a.path.level() < deepest,
               may_y = can_split(pieces_.patch(b), y) && b.path.level() < deepest;
    first_ = may_x && (!may_y || size_x >= size_y);
    if (found_.tests < budget_ && (may_x || may_y)) return Verb::open;
    if (found_.what == Found::What::apart)
      set(Found::What::unknown, pair, {clamped(near.on_a), clamped(near.on_b)});
    // A crossing may still be found elsewhere, but not where rounding is all there is.
    return found_.tests >= budget_ ? Verb::stop : Verb::drop;
  }
  void open(const NamePair& pair) {
    const auto& [a, b] = pair;
    for (unsigned child = 4; child-- > 0;) {
      open_.add(first_ ? NamePair{a.child(child), b} : NamePair{a, b.child(child)});
    }
  }

 private:
  void set(Found::What what, const NamePair& pair, const std::array<TriangleParameter, 2>& at) {
    found_.what = what;
    found_.pieces = pair;
    found_.at = at;
  }

  PieceCache& pieces_;
  std::uint64_t budget_;
  Frontier<NamePair> open_;
  Found found_;
  int attempts_ = 0;
  bool first_ = false;  // Is it the first piece that is to be opened?
};

// Of pairs of pieces at a vertex those that have nothing in common but what both name: a part of a fan is injective, or a plane is between
// both.
class VertexPairs {
 public:
  // `live`: sorted; other pairs are of no interest.
  VertexPairs(PieceCache& pieces, const LevelComplex& complex, const std::vector<NamePair>& live)
      : pieces_(pieces), complex_(complex), live_(live) {}

  [[nodiscard]] std::set<NamePair> proved(const LevelStar& star) {
    if (star.fan) {
      try_parts(star);
    } else {
      const std::vector<LevelStar> fans = complex_.fans(star);
      for (const LevelStar& fan : fans) {
        if (!fan.fan) continue;
        try_whole(fan);
        for (const LevelStar* other = fans.data(); other != &fan; ++other) try_both(*other, fan);
      }
    }
    for (const auto& a : star.sectors) {
      for (const auto& b : star.sectors) {
        if (a.piece < b.piece && is_open({a.piece, b.piece}) && holds(a, b))
          found_.insert({a.piece, b.piece});
      }
    }
    return std::move(found_);
  }

 private:
  [[nodiscard]] bool is_injective(const LevelStar& fan) const {
    return certainly_injective(sectors_of(pieces_, fan), fan.closed,
                               is_balanced(pieces_.model().surface(), fan));
  }
  [[nodiscard]] bool is_open(const NamePair& pair) const {
    return std::binary_search(live_.begin(), live_.end(), pair) && !found_.contains(pair);
  }
  // Of each two sectors, and of each with itself.
  template <class Visit>
  static void each_pair(const LevelStar& fan, const Visit& visit) {
    for (std::size_t i = 0; i < fan.sectors.size(); ++i) {
      for (std::size_t k = 0; k <= i; ++k) visit(std::minmax(fan.sectors[i].piece, fan.sectors[k].piece));
    }
  }
  void add_all(const LevelStar& fan) {
    each_pair(fan, [&](const NamePair& pair) { found_.insert(pair); });
  }
  void try_whole(const LevelStar& fan) {
    if (is_injective(fan)) {
      add_all(fan);
    } else {
      try_parts(fan);
    }
  }
  // Two fans with an edge in common, which more may have: one of them in a mirror if they run along it the same way.
  void try_both(const LevelStar& a, LevelStar b) {
    for (const bool mirrored : {false, true}) {
      for (LevelStar::Sector& sector : b.sectors) sector.mirrored = mirrored;
      LevelStar both{a.sectors};
      both.sectors.insert(both.sectors.end(), b.sectors.begin(), b.sectors.end());
      complex_.put_in_order(both);
      if (both.fan) return try_whole(both);
    }
  }
  // From each sector on as far as it holds.
  void try_parts(const LevelStar& fan) {
    const std::size_t count = fan.sectors.size();
    for (std::size_t first = 0; first < count; ++first) {
      LevelStar part{{}, false, true};
      const std::size_t most = fan.closed ? count - 1 : count - first;
      while (part.sectors.size() < most) {
        part.sectors.push_back(fan.sectors[(first + part.sectors.size()) % count]);
        bool any = false;
        each_pair(part, [&](const NamePair& pair) { any = any || is_open(pair); });
        if (!any) continue;
        if (!is_injective(part)) break;
        add_all(part);
      }
    }
  }
  [[nodiscard]] bool holds(const LevelStar::Sector& a, const LevelStar::Sector& b) const {
    LevelStar both{{a, b}};
    if (common_corners(complex_, a.piece, b.piece).size() == 1) {
      const std::vector<StarSector> sectors = sectors_of(pieces_, both);
      return certainly_meet_only_at_vertex(sectors[0], sectors[1]) ||
             (stays_in_place(sectors[0]) && are_parted_by_facet(pieces_.model().surface(), a, b));
    }
    complex_.put_in_order(both);
    return both.fan && is_injective(both);
  }

  PieceCache& pieces_;
  const LevelComplex& complex_;
  const std::vector<NamePair>& live_;
  std::set<NamePair> found_;
};

class SelfSearch {
 public:
  SelfSearch(const SurfaceBvh& model, const SelfContactOptions& options, const Run& run)
      : model_(model),
        surface_(model.surface()),
        options_(options),
        run_(run),
        monitor_(monitor_of(run)),
        complex_(surface_),
        budget_(run.max_splits.value_or(default_splits::self_contact)) {
    if (options.within) {
      answer_.radius = options.radius.value_or(
          std::min(default_radius * *options.within, std::numeric_limits<double>::max()));
    }
  }

  // Faces of `facets` do not meet each other. Without `stars` pieces with a common corner are not looked at.
  [[nodiscard]] SelfContact run(const ComparedFacets& facets, bool stars) {
    const std::vector<PieceName> pieces = complex_.pieces();
    if (pieces.empty()) {
      throw InputError(
          InputProblem::refused,
          "no face has a limit surface: all are holes or touch the boundary; use another boundary rule");
    }
    if (!facets.all) {
      add(flat_folds(model_), Found::What::crossing);
      if (contacts_.empty()) look_for_contact(pieces, facets.faces, stars);
      // No pieces show these, however small.
      if ((!stars || !unknown_.empty()) && contacts_.empty())
        add(coincident_vertices(surface_), Found::What::touching);
    }
    if (options_.within && contacts_.empty()) look_for_near();
    return result();
  }

 private:
  void look_for_contact(const std::vector<PieceName>& pieces, const std::vector<bool>& facets, bool stars) {
    unsigned level = complex_.first_level();
    const auto are_facets = [&](const NamePair& pair) {
      const auto is_facet = [&](const PieceName& piece) {
        const std::uint32_t owner = surface_.place(piece.patch).owner;
        return surface_.rules().primal && facets[owner];
      };
      return is_facet(pair.first) && is_facet(pair.second);
    };
    std::vector<NamePair> far = far_pairs(pieces);
    std::erase_if(far, are_facets);
    if (!stars) {
      for (std::uint64_t most = 16; !far.empty() && contacts_.empty() && budget_ >= far.size(); most *= 16) {
        unknown_.clear();
        far = compare_far(far, std::min(most, max_tests));
        if (most >= max_tests) break;
      }
      return;
    }
    std::vector<NamePair> later;
    compare_far(far, max_tests, &later);
    std::vector<NamePair> live = near_pairs(pieces);
    std::erase_if(live, are_facets);
    for (unsigned depth = 0; !live.empty() && contacts_.empty(); ++depth, ++level) {
      monitor_.checkpoint();
      drop_proved(live, level);
      if (live.empty()) break;
      if (depth >= options_.levels || live.size() > budget_ || level + 1 >= LevelComplex::max_level) {
        budget_spent_ = budget_spent_ || live.size() > budget_;
        for (const NamePair& pair : live) leave(pair);
        break;
      }
      far.clear();
      live = split_pairs(live, far);
      compare_far(far, max_tests, &later);
      answer_.levels = depth + 1;
    }
    compare_far(later);
  }

  // Contacts of pieces that are known from their control points.
  void add(const std::vector<PieceContact>& contacts, Found::What what) {
    for (const auto& [pieces, at] : contacts) keep({what, {pieces[0], pieces[1]}, at});
  }

  void look_for_near() {
    // In scaled units all distances are below 16; a radius is 1e100 at most: only other components are so far.
    const PowerOfTwo scale = surface_.scale();
    NearnessOptions wanted{.tolerance = std::min(enlarged(scale.apply(*options_.within)), 64.0),
                           .radius = std::min(scale.apply(answer_.radius), 1e100),
                           .budget = run_.max_splits.value_or(default_splits::self_contact),
                           .levels = options_.levels + further_levels,
                           .threads = run_.threads};
    if (scale.exact(*options_.within)) wanted.tolerance = std::min(scale.apply(*options_.within), 64.0);
    nearness_ = find_nearness(model_, complex_, wanted, monitor_);
    answer_.stars += nearness_.stars;
    answer_.pair_tests += nearness_.pair_tests;
    answer_.levels = std::max(answer_.levels, nearness_.levels);
    budget_spent_ = budget_spent_ || nearness_.budget_spent;
  }

  // All pairs of the first level whose enclosures are near and that have no corner in common.
  std::vector<NamePair> far_pairs(const std::vector<PieceName>& pieces) {
    const PieceSet sets = enclosures_of(model_, pieces, run_.threads, monitor_);
    std::vector<std::vector<NamePair>> found(pieces.size());
    parallel_for(pieces.size(), run_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        monitor_.checkpoint();
        for_each_near(sets, sets[i], [&](std::uint32_t other) {
          if (other > i && !share_corner(complex_, pieces[i], pieces[other]))
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

  // Leaves pairs no common corner of which has a star that is proved to be injective.
  void drop_proved(std::vector<NamePair>& live, unsigned level) {
    std::vector<LevelVertex> corners;
    for (const NamePair& pair : live) {
      for (const LevelVertex& v : common_corners(complex_, pair.first, pair.second)) corners.push_back(v);
    }
    MarkedVertices proved(std::move(corners)), single = proved;
    if (proved.count() > budget_) {
      budget_spent_ = true;
      return;
    }
    for_each_with_pieces(
        model_, proved.count(), run_.threads, monitor_, [&](PieceCache& pieces, std::size_t i) {
          const LevelStar star = complex_.star(proved[i], level);
          const std::vector<StarSector> sectors = sectors_of(pieces, star);
          const bool holds =
              star.fan && certainly_injective(sectors, star.closed, is_balanced(surface_, star));
          proved.mark(i, holds);
          single.mark(i, !holds && (!star.fan || stays_in_place(sectors.front())));
        });
    spend(proved.count());
    answer_.stars += proved.count();
    std::erase_if(live, [&](const NamePair& pair) {
      return proved.any(common_corners(complex_, pair.first, pair.second));
    });
    if (!live.empty()) drop_proved_pairs(live, single, level);
  }

  // At vertices whose stars are not proved as a whole, since there is no tangent plane or no fan: pairs of pieces one by one.
  void drop_proved_pairs(std::vector<NamePair>& live, const MarkedVertices& single, unsigned level) {
    std::vector<LevelVertex> at;
    for (std::size_t i = 0; i < single.count(); ++i) {
      if (single.any({single[i]})) at.push_back(single[i]);
    }
    std::vector<std::set<NamePair>> proved(at.size());
    for_each_with_pieces(model_, at.size(), run_.threads, monitor_, [&](PieceCache& pieces, std::size_t i) {
      proved[i] = VertexPairs(pieces, complex_, live).proved(complex_.star(at[i], level));
    });
    std::set<NamePair> all;
    for (std::set<NamePair>& part : proved) all.merge(part);
    std::erase_if(live, [&](const NamePair& pair) { return all.contains(pair); });
  }

  // The children's pairs: those with a common corner, and `far` the others.
  std::vector<NamePair> split_pairs(const std::vector<NamePair>& live, std::vector<NamePair>& far) const {
    std::vector<NamePair> next;
    for (const auto& [a, b] : live) {
      for (unsigned i = 0; i < 4; ++i) {
        for (unsigned j = a == b ? i : 0; j < 4; ++j) {
          NamePair pair{a.child(i), b.child(j)};
          if (pair.second < pair.first) std::swap(pair.first, pair.second);
          (share_corner(complex_, pair.first, pair.second) ? next : far).push_back(pair);
        }
      }
    }
    std::sort(next.begin(), next.end());
    std::sort(far.begin(), far.end());
    return next;
  }

  // Returns the pairs that are neither apart nor cross, as far as `most` tests of each can tell. Most need few: what these leave of the
  // budget is for the others. With `later`, only half of it now: those that need more are put there.
  std::vector<NamePair> compare_far(const std::vector<NamePair>& pairs, std::uint64_t most = max_tests,
                                    std::vector<NamePair>* later = nullptr) {
    const std::uint64_t kept_back = later != nullptr ? budget_ / 2 : 0;
    std::vector<NamePair> open = pairs, unknown;
    for (std::uint64_t before = 0; !open.empty() && contacts_.empty();) {
      const std::uint64_t all = before == 0 ? budget_ : budget_ - std::min(budget_, kept_back);
      const std::uint64_t each = std::max<std::uint64_t>(std::min(most, all / open.size()), 1);
      // Another round would be of little use.
      if (before > 0 && each < 2 * before) {
        for (const NamePair& pair : open) later != nullptr ? later->push_back(pair) : leave_far(pair);
        budget_spent_ = budget_spent_ || later == nullptr;
        break;
      }
      std::vector<Found> found(open.size());
      for_each_with_pieces(model_, open.size(), run_.threads, monitor_, [&](PieceCache& kept, std::size_t i) {
        found[i] = PairComparison(kept, each).run(open[i]);
      });
      std::vector<NamePair> left;
      for (std::size_t i = 0; i < open.size(); ++i) {
        const Found& one = found[i];
        answer_.pair_tests += one.tests;
        spend(one.tests);
        if (one.what == Found::What::unknown && one.tests >= each && each < most) {
          left.push_back(open[i]);
          continue;
        }
        keep(one);
        if (one.what == Found::What::unknown) unknown.push_back(open[i]);
      }
      open = std::move(left);
      before = each;
    }
    return unknown;
  }

  // Two pieces that no tests are left for: by their corners 0.
  void leave_far(const NamePair& pair) {
    Found found;
    found.what = Found::What::unknown;
    found.pieces = pair;
    keep(found);
  }
  void leave(const NamePair& pair) {
    Found found;
    found.what = Found::What::unknown;
    found.pieces = pair;
    const auto common = common_corners(complex_, pair.first, pair.second);
    const auto corner_at = [&](const PieceName& piece) {
      const auto corners = complex_.vertices(piece);
      const auto k = std::find(corners.begin(), corners.end(), common.front()) - corners.begin();
      return TriangleParameter{k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0};
    };
    found.at = {corner_at(pair.first), corner_at(pair.second)};
    keep(found);
  }
  // Of each sort as many as an answer holds.
  void keep(const Found& found) {
    if (found.what == Found::What::apart) return;
    auto& of_its_sort = found.what == Found::What::unknown ? unknown_ : contacts_;
    if (of_its_sort.size() < SelfContact::max_pairs) of_its_sort.push_back(found);
  }

  void spend(std::uint64_t work) { budget_ -= std::min(budget_, work); }

  SelfContact result() {
    answer_.verdict = !contacts_.empty()                                 ? SelfVerdict::intersecting
                      : !nearness_.near.empty()                          ? SelfVerdict::near
                      : unknown_.empty() && nearness_.unresolved.empty() ? SelfVerdict::clear
                                                                         : SelfVerdict::undecided;
    answer_.outcome = outcome_of(answer_.verdict != SelfVerdict::undecided, budget_spent_);
    if (answer_.verdict != SelfVerdict::near) {
      for (const Found& found : contacts_.empty() ? unknown_ : contacts_) add_place(found);
    }
    if (answer_.verdict == SelfVerdict::near) {
      for (const ProximityPair& pieces : nearness_.near) add_place(pieces, SelfVerdict::near);
    } else if (contacts_.empty()) {
      for (const ProximityPair& pieces : nearness_.unresolved) add_place(pieces, SelfVerdict::undecided);
    }
    return answer_;
  }

  // The limit points at two places of pieces; returns an upper bound of what both are off, as lengths.
  double set_points(SelfContactPair& pair, const std::array<PieceName, 2>& names,
                    const std::array<TriangleParameter, 2>& at) const {
    double error = 0;
    for (std::size_t s = 0; s < 2; ++s) {
      const Place place = place_of(surface_, names[s], at[s]);
      pair.points[s] = evaluate(surface_, place);
      error += spatial_error(pair.points[s].error);
    }
    return error;
  }

  void add_place(const Found& found) {
    if (answer_.pairs.size() == SelfContact::max_pairs) return;
    SelfContactPair pair;
    pair.verdict = !contacts_.empty() ? SelfVerdict::intersecting : SelfVerdict::undecided;
    pair.touching = found.what == Found::What::touching;
    const double error = set_points(pair, {found.pieces.first, found.pieces.second}, found.at);
    if (contacts_.empty()) {
      pair.distance.upper = distance_at_most(pair.points[1].point - pair.points[0].point, enlarged(error));
    }
    answer_.pairs.push_back(pair);
  }

  void add_place(const ProximityPair& pieces, SelfVerdict verdict) {
    if (answer_.pairs.size() == SelfContact::max_pairs) return;
    SelfContactPair pair;
    pair.verdict = verdict;
    static_cast<void>(set_points(pair, pieces.pieces, pieces.at));
    const PowerOfTwo back = surface_.scale().inverse();
    pair.distance = {unscaled_down(pieces.distance.lower, back), unscaled_up(pieces.distance.upper, back)};
    answer_.pairs.push_back(pair);
  }

  const SurfaceBvh& model_;
  const LimitSurface& surface_;
  const SelfContactOptions& options_;
  Run run_;
  const WorkMonitor& monitor_;
  LevelComplex complex_;
  std::uint64_t budget_;
  std::vector<Found> contacts_, unknown_;  // the first: where it certainly meets itself
  bool budget_spent_ = false;
  Nearness nearness_;
  SelfContact answer_;
};

}  // namespace

const char* name_of(SelfVerdict verdict) { return name_in(self_verdict_names, verdict); }

SelfContact self_contact(const Surface& surface, const SelfContactOptions& options, const Run& run) {
  require_value(options.levels <= 20, "self contact: more than 20 levels; give fewer");
  if (options.within) {
    require_length(*options.within, "self contact: 'within'");
    require_value(*options.within > 0, "self contact: 'within' is 0; give a positive length, or none");
  }
  if (options.radius) {
    require_value(options.within.has_value(),
                  "self contact: a radius without 'within'; give both, or no radius");
    require_length(*options.radius, "self contact: the radius");
    require_value(
        *options.radius / min_radius >= *options.within,
        "self contact: the radius is less than twice 'within', where even flat places are near each other "
        "beyond it; give a longer one");
  }
  const ComparedFacets facets = compare_facets(surface.data()->limit(), run.threads, monitor_of(run));
  const bool clear = facets.answer.verdict == SelfVerdict::clear;
  const bool any = std::find(facets.faces.begin(), facets.faces.end(), true) != facets.faces.end();
  if (!clear || (any && facets.all && !options.within)) return facets.answer;
  return SelfSearch(surface.data()->bvh(stop_only(run)), options, run).run(facets, true);
}

SelfContact contact_far_apart(const Surface& surface, const Run& run) {
  const ComparedFacets facets = compare_facets(surface.data()->limit(), run.threads, monitor_of(run));
  if (facets.answer.verdict == SelfVerdict::intersecting) return facets.answer;
  return SelfSearch(surface.data()->bvh(stop_only(run)), {}, run).run(facets, false);
}

}  // namespace snug
