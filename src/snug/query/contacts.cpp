#include <snug/contacts.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include <snug/geometry/rounding.h>
#include <snug/mesh/disjoint_sets.h>
#include <snug/query/contact_curves.h>
#include <snug/query/facet_contacts.h>
#include <snug/query/pair_queries.h>
#include <snug/query/touching_boxes.h>
#include <snug/search/crossing.h>
#include <snug/search/pair_frames.h>
#include <snug/search/precision.h>
#include <snug/surface/unscale.h>
#include <support/error.h>
#include <support/run.h>

namespace snug {
namespace {

// Pieces of regions are at most this share of the larger surface; those of which nothing is proved are split so many
// times smaller.
constexpr double largest_share = 0x1p-5, smallest_share = 0x1p-3;
// Of an answer, or one for each pair of patches in a region.
constexpr std::size_t max_open = 4000;
// Faces that touch are split until points of both are that near, in the query's units, or they are small.
constexpr double touching_distance = 0x1p-36;

// Two pieces that may be within the tolerance of each other. Lengths are in the query's units.
struct ContactPair {
  std::array<PatchId, 2> roots;
  std::array<Box3, 2> boxes;
  Interval distance;
  bool within = false, crossing = false;
  std::array<TriangleParameter, 2> at;                 // of the root patches: where they are about nearest
  std::array<std::shared_ptr<const Patch>, 2> pieces;  // of those that may have a point in common
  const FacetMeeting* facets = nullptr;                // of faces that are compared exactly
  bool kept = true;                                    // is it a contact?
  std::uint32_t arc = ChainArc::none;                  // the first one in it
  std::uint32_t region = 0;
};

Box3 widened(Box3 box, double by) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.lower[axis] = rounded_down(box.lower[axis] - by);
    box.upper[axis] = rounded_up(box.upper[axis] + by);
  }
  return box;
}

Box3 box_of(const Triangle& base, double radius) {
  Box3 box;
  for (const Point3& p : base) box.add(p);
  return widened(box, radius);
}

// May a segment meet a box?
bool may_pass(const Box3& box, const std::vector<BoundedPoint>& ends) {
  const Vector3 along = ends[1].position - ends[0].position;
  const double largest = std::max(max_abs(ends[0].position - Point3{}), max_abs(ends[1].position - Point3{}));
  const double slack = 0x1p-40 + std::max(ends[0].error, ends[1].error) + 0x1p-50 * largest;
  double from = 0, to = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double low = box.lower[axis] - slack - ends[0].position[axis],
                 high = box.upper[axis] + slack - ends[0].position[axis];
    if (std::fabs(along[axis]) <= slack) {
      if (low > slack || high < -slack) return false;
      continue;
    }
    from = std::max(from, std::min(low / along[axis], high / along[axis]));
    to = std::min(to, std::max(low / along[axis], high / along[axis]));
  }
  return from <= to;
}

// Lists pairs of pieces that may be within the tolerance of each other.
class ContactWalk {
 public:
  // Adds statistics and how it ended to `answer`.
  ContactWalk(PairFrames& frames, FacetContacts& facets, const ContactsOptions& options, const Run& run,
              Contacts& answer)
      : frames_(frames),
        facets_(facets),
        options_(options),
        monitor_(monitor_of(run)),
        max_splits_(run.max_splits.value_or(default_splits::contacts)),
        tolerance_(frames.length_up(*options.within)),
        within_(frames.length_down(*options.within)),
        answer_(answer) {}

  // Breadth first: where the budget ends, what is left is about equally large.
  std::vector<ContactPair> run() {
    answer_.exhaustive = true;
    const NodePair roots = walk_.roots();
    fine_ =
        std::max(largest_share * static_cast<double>(std::max(walk_.size(roots, 0), walk_.size(roots, 1))),
                 tolerance_);
    open_.start(Order::first_first, roots);
    search(open_, *this);
    return std::move(near_);
  }

  Verb look_at(const NodePair& pair) {
    if (pair.bounded()) {
      monitor_.checkpoint();
      if (!is_split(pair)) return Verb::drop;
    }
    const PairWalk::May may = walk_.may(pair, max_splits_);
    if (pair.bounded() && may != PairWalk::May::open) {
      const PiecePair pieces = pieces_.nearest(pair);
      // Pieces that cannot be split are as fine as they get.
      const bool end = may == PairWalk::May::end;
      if (end || (within_ > 0 && !(pieces.near_distance <= within_))) {
        answer_.outcome =
            worse(answer_.outcome, outcome_of(false, end && answer_.stats.splits >= max_splits_));
      }
      list(pair, pieces);
      return Verb::drop;
    }
    if (open_.size() + near_.size() <= max_splits_) return Verb::open;
    answer_.exhaustive = false;
    answer_.outcome = Outcome::budget_spent;
    return Verb::stop;
  }
  void open(const NodePair& pair) { static_cast<void>(walk_.open(pair, tolerance_, open_)); }

 private:
  // Is a pair to be split? Else it is done with: apart, or listed.
  bool is_split(const NodePair& pair) {
    PiecePair pieces = pieces_.nearest(pair);
    if (pieces.gap > tolerance_ || pieces_.gap_along(pair.nodes, pieces.between) > tolerance_) return false;
    // Flat pieces need not be split, however large.
    double size = 0;
    for (std::size_t s = 0; s < 2; ++s) {
      if (PieceCache::can_open(pair.nodes[s]))
        size = std::max(size, static_cast<double>(walk_.size(pair, s)));
    }
    if (size > fine_) {
      const FacetMeeting* const facets = facets_of(pair);
      if (facets == nullptr || facets->state != FacetMeeting::State::touching) return true;
      pieces_.approach(pieces);
      if (!(pieces.near_distance <= touching_distance)) return true;
      list(pair, pieces);
      return false;
    }
    if (!(pieces.near_distance <= within_)) pieces_.approach(pieces);
    const bool done = pieces.near_distance <= within_ || within_ <= 0 || size <= smallest_share * fine_;
    if (done) list(pair, pieces);
    return !done;
  }

  void list(const NodePair& pair, const PiecePair& pieces) {
    ContactPair item;
    const double gap = std::max(pieces.gap, pieces_.gap_along(pair.nodes, pieces.between));
    if (gap > tolerance_) return;
    item.within = pieces.near_distance <= within_;
    item.distance = {std::min(gap, pieces.near_distance), pieces.near_distance};
    for (std::size_t s = 0; s < 2; ++s) {
      PieceCache& cache = frames_.cache(s);
      item.roots[s] = cache.name(pair.nodes[s]).patch;
      item.boxes[s] = box_of(pieces.base[s], pieces.radii[s]);
      const Patch& patch = cache.patch(pair.nodes[s]);
      item.at[s] = to_face(patch.path, pieces.at[s]);
      if (gap <= 0 && options_.curves) item.pieces[s] = std::make_shared<const Patch>(patch);
    }
    item.facets = facets_of(pair);
    if (item.facets != nullptr) item.pieces = {};
    const bool may_cross =
        item.facets == nullptr ? !options_.curves : item.facets->state == FacetMeeting::State::crossing;
    if (gap <= 0 && may_cross && pieces.near.certain_distance == 0)
      item.crossing = proves_crossing(frames_, pieces);
    near_.push_back(std::move(item));
  }

  [[nodiscard]] const FacetMeeting* facets_of(const NodePair& pair) {
    std::array<std::uint32_t, 2> owners;
    for (std::size_t s = 0; s < 2; ++s) {
      PieceCache& cache = frames_.cache(s);
      owners[s] = cache.model().surface().place(cache.name(pair.nodes[s]).patch).owner;
    }
    return facets_.between(owners[0], owners[1]);
  }

  PairFrames& frames_;
  FacetContacts& facets_;
  const ContactsOptions& options_;
  const WorkMonitor& monitor_;
  std::uint64_t max_splits_;
  double tolerance_, within_;
  Contacts& answer_;
  PairWalk walk_{frames_, answer_.stats, WideNode::Gaps::axes};
  PiecePairs pieces_{frames_, answer_.stats};
  Frontier<NodePair>& open_ = frames_.cache(0).open_pairs();
  double fine_ = 0;  // larger pieces are split
  std::vector<ContactPair> near_;
};

// Replaces boxes by boxes around some of them, halved along the longest side until they are `most`.
void add_merged(std::span<UnresolvedPieces> open, std::size_t most, std::vector<UnresolvedPieces>& merged) {
  if (open.size() <= most) {
    merged.insert(merged.end(), open.begin(), open.end());
    return;
  }
  Box3 all;
  for (const UnresolvedPieces& one : open) all.add(one.box);
  if (most <= 1) {
    merged.push_back({all, open[0].roots, open[0].contact});
    return;
  }
  const Vector3 sides = all.upper - all.lower;
  const std::size_t axis = sides.x >= sides.y ? (sides.x >= sides.z ? 0 : 2) : (sides.y >= sides.z ? 1 : 2);
  std::stable_sort(open.begin(), open.end(), [&](const UnresolvedPieces& a, const UnresolvedPieces& b) {
    return a.box.lower[axis] + a.box.upper[axis] < b.box.lower[axis] + b.box.upper[axis];
  });
  const std::size_t half = open.size() / 2;
  add_merged(open.first(half), most / 2, merged);
  add_merged(open.subspan(half), most - most / 2, merged);
}

// All contacts: regions of pairs, and the curves in them.
class ContactsSearch {
 public:
  ContactsSearch(const PlacedBvh& a, const PlacedBvh& b, const ContactsOptions& options, const Run& run)
      : frames_(a, b),
        facets_(frames_, a, b),
        options_(options),
        run_(run),
        tolerance_(frames_.length_up(*options.within)) {}

  Contacts run() {
    near_ = ContactWalk(frames_, facets_, options_, run_, answer_).run();
    if (options_.curves) find_curves();
    take_facets();
    find_regions();
    add_facets();
    add_curves();
    answer_.compared = cut_.compared;
    return std::move(answer_);
  }

 private:
  [[nodiscard]] const LimitSurface& surface(std::size_t side) const {
    return frames_.cache(side).model().surface();
  }

  // ---- Curves ----

  void find_curves() {
    std::vector<CrossingPieces> crossing;
    for (std::uint32_t i = 0; i < near_.size(); ++i) {
      ContactPair& item = near_[i];
      if (item.pieces[0]) crossing.push_back({std::move(item.pieces), item.roots, i});
    }
    cut_ = cut_surfaces({&surface(0), &surface(1)}, {frames_.frame(0), frames_.frame(1)}, crossing,
                        frames_.length_down(*options_.error),
                        run_.max_splits.value_or(default_splits::contacts), run_.threads, monitor_of(run_));
    answer_.outcome =
        worse(answer_.outcome, outcome_of(cut_.reached && !cut_.budget_spent, cut_.budget_spent));
    // With no tolerance, what has no common point is no contact.
    for (const CrossingPieces& pair : crossing) near_[pair.contact].kept = tolerance_ > 0;
    for (std::uint32_t i = 0; i < cut_.arcs.size(); ++i) {
      ContactPair& item = near_[cut_.arcs[i].contact];
      item.crossing = item.kept = true;
      item.arc = std::min(item.arc, i);
    }
    for (const UnresolvedPieces& open : cut_.unresolved) near_[open.contact].kept = true;
    for (const std::uint32_t contact : cut_.covered) near_[contact].kept = true;
  }

  // Pairs of facets are decided: they were compared exactly.
  void take_facets() {
    for (std::uint32_t i = 0; i < near_.size(); ++i) {
      ContactPair& item = near_[i];
      if (item.facets == nullptr) continue;
      switch (item.facets->state) {
        case FacetMeeting::State::apart:
          item.kept = tolerance_ > 0;
          break;
        case FacetMeeting::State::touching:
          // Of quads it may be other halves that touch.
          item.crossing = surface(0).rules().triangular() && surface(1).rules().triangular();
          break;
        case FacetMeeting::State::crossing:
          item.kept = tolerance_ > 0 || (may_pass(item.boxes[0], item.facets->corners) &&
                                         may_pass(item.boxes[1], item.facets->corners));
          break;
      }
    }
  }

  // ---- Regions ----

  [[nodiscard]] bool neighbours(std::size_t side, PatchId p, PatchId q) const {
    if (p == q) return true;
    const auto a = surface(side).corner_names(p), b = surface(side).corner_names(q);
    return std::any_of(a.begin(), a.end(),
                       [&](std::uint32_t name) { return std::find(b.begin(), b.end(), name) != b.end(); });
  }

  void find_regions() {
    std::vector<Box3> boxes;
    for (const ContactPair& item : near_) boxes.push_back(item.boxes[0]);
    DisjointSets sets(near_.size());
    for_each_touching(boxes, [&](std::uint32_t i, std::uint32_t k) {
      const ContactPair &x = near_[i], &y = near_[k];
      if (!x.kept || !y.kept || sets.least(i) == sets.least(k)) return;
      if (!touch(x.boxes[1], y.boxes[1])) return;
      if (neighbours(0, x.roots[0], y.roots[0]) && neighbours(1, x.roots[1], y.roots[1])) sets.join(i, k);
    });
    std::map<std::uint32_t, std::vector<std::uint32_t>> members;
    for (std::uint32_t i = 0; i < near_.size(); ++i) {
      if (near_[i].kept) members[sets.least(i)].push_back(i);
    }
    for (const auto& [least, items] : members) {
      for (const std::uint32_t i : items)
        near_[i].region = static_cast<std::uint32_t>(answer_.regions.size());
      answer_.regions.push_back(region_of(items));
    }
  }

  [[nodiscard]] ContactRegion region_of(const std::vector<std::uint32_t>& items) {
    ContactRegion region;
    std::map<std::array<std::uint32_t, 2>, PatchContact> contacts;
    Box3 box;
    std::uint32_t nearest = items.front(), arc = ChainArc::none;
    double lower = INFINITY, upper = INFINITY;
    for (const std::uint32_t i : items) {
      const ContactPair& item = near_[i];
      const Interval distance = distance_of(item);
      const std::array<std::uint32_t, 2> roots{item.roots[0].value(), item.roots[1].value()};
      const auto [at, added] = contacts.try_emplace(roots);
      PatchContact& contact = at->second;
      if (added) {
        for (std::size_t s = 0; s < 2; ++s) contact.patches[s] = surface(s).place(item.roots[s]);
        contact.distance = distance;
      }
      contact.distance = {std::min(contact.distance.lower, distance.lower),
                          std::min(contact.distance.upper, distance.upper)};
      contact.verdict = better(contact.verdict, verdict_of(item));
      region.verdict = better(region.verdict, verdict_of(item));
      lower = std::min(lower, distance.lower);
      upper = std::min(upper, distance.upper);
      // Points farther than the tolerance from the other piece are in no contact.
      for (std::size_t s = 0; s < 2; ++s) {
        box.add(common_box(item.boxes[s], widened(item.boxes[1 - s], tolerance_)));
      }
      if (item.distance.upper < near_[nearest].distance.upper) nearest = i;
      arc = std::min(arc, item.arc);
    }
    for (auto& [roots, contact] : contacts) {
      for (std::size_t s = 0; s < 2; ++s) region.owners[s].push_back(contact.patches[s].owner);
      region.contacts.push_back(contact);
    }
    for (std::vector<std::uint32_t>& owners : region.owners) {
      std::sort(owners.begin(), owners.end());
      owners.erase(std::unique(owners.begin(), owners.end()), owners.end());
    }
    if (box.empty()) box = near_[nearest].boxes[0];  // no pair of pieces has points so near
    region.box = unscaled(box, frames_.to_mesh_units());
    region.distance = {lower, upper};
    if (arc != ChainArc::none) {
      set_witness(cut_.arcs[arc].roots, cut_.arcs[arc].ends[0].at, region);
    } else {
      set_witness(near_[nearest].roots, near_[nearest].at, region);
    }
    return region;
  }

  [[nodiscard]] Interval distance_of(const ContactPair& item) const {
    const PowerOfTwo back = frames_.to_mesh_units();
    if (item.crossing) return {0, 0};
    double upper = item.distance.upper;
    if (!(upper < INFINITY)) {  // nobody looked for near points
      Box3 both = item.boxes[0];
      both.add(item.boxes[1]);
      upper = enlarged(length(both.upper - both.lower));
    }
    return {unscaled_down(item.distance.lower, back), require_representable(unscaled_up(upper, back))};
  }
  [[nodiscard]] static Verdict verdict_of(const ContactPair& item) {
    return item.crossing ? Verdict::intersecting : item.within ? Verdict::within : Verdict::undecided;
  }
  [[nodiscard]] static Verdict better(Verdict a, Verdict b) {
    for (const Verdict v : {Verdict::intersecting, Verdict::within}) {
      if (a == v || b == v) return v;
    }
    return Verdict::undecided;
  }

  void set_witness(const std::array<PatchId, 2>& roots, const std::array<TriangleParameter, 2>& at,
                   ContactRegion& region) const {
    const PowerOfTwo back = frames_.to_mesh_units();
    for (std::size_t s = 0; s < 2; ++s) {
      const Patch patch = surface(s).patch(roots[s]);
      const BoundedPoint point = frames_.frame(s).apply(limit_point(patch, at[s]).from(patch.origin));
      region.witness[s] = {require_representable(back.apply(point.position)),
                           unscaled_up(point.error, back) + underflow_error,
                           place_of(surface(s), roots[s], at[s])};
    }
  }

  // Common parts of plane faces.
  void add_facets() {
    for (std::uint32_t i = 0; i < near_.size(); ++i) {
      if (near_[i].facets != nullptr && near_[i].kept)
        items_[{surface(0).place(near_[i].roots[0]).owner, surface(1).place(near_[i].roots[1]).owner}]
            .push_back(i);
    }
    for (const FacetContacts::Touching& touching : facets_.touching()) add_area(touching);
    add_crossings();
  }

  // Segments in which faces pass through each other, as arcs.
  void add_crossings() {
    const std::vector<FacetContacts::Crossing> crossings = facets_.crossings();
    std::vector<std::uint32_t> numbers(crossings.size(), ChainArc::none);
    const std::size_t first = cut_.arcs.size();
    for (std::size_t i = 0; i < crossings.size(); ++i) {
      const std::optional<std::uint32_t> item = item_at(crossings[i].segment);
      if (!item) continue;
      prove(near_[*item].region);
      if (!options_.curves) continue;
      numbers[i] = static_cast<std::uint32_t>(cut_.arcs.size());
      ChainArc& arc = cut_.arcs.emplace_back();
      arc.roots = near_[*item].roots;
      arc.contact = *item;
      arc.next = crossings[i].next;
      arc.at_border = crossings[i].at_border;
      for (std::size_t e = 0; e < 2; ++e) {
        const BoundedPoint& corner = crossings[i].segment.meeting->corners[e];
        CutEnd& end = arc.arc.ends[e];
        end.sure = true;
        end.point = arc.ends[e].point = corner.position;
        end.error = spatial_error(corner.error);
        arc.arc.box.add(widened({corner.position, corner.position}, corner.error));
      }
    }
    for (std::size_t a = first; a < cut_.arcs.size(); ++a) {
      for (std::uint32_t& next : cut_.arcs[a].next) {
        if (next == FacetContacts::Crossing::none) continue;
        const std::uint32_t number = numbers[next / 2];
        next = number == ChainArc::none ? ChainArc::none : 2 * number + next % 2;
      }
    }
  }

  // A pair of pieces at the first point of what two faces have in common: all of these are in one region. Where the budget ended
  // there may be none.
  [[nodiscard]] std::optional<std::uint32_t> item_at(const FacetContacts::Touching& touching) {
    const BoundedPoint& first = touching.meeting->corners.front();
    const Box3 at = widened({first.position, first.position}, first.error);
    const auto& own = items_[touching.faces];
    const auto item = std::find_if(own.begin(), own.end(), [&](std::uint32_t i) {
      return touch(near_[i].boxes[0], at) && touch(near_[i].boxes[1], at);
    });
    if (item == own.end()) return std::nullopt;
    return *item;
  }
  void prove(std::uint32_t region) {
    answer_.regions[region].verdict = Verdict::intersecting;
    answer_.regions[region].distance = {0, 0};
  }

  void add_area(const FacetContacts::Touching& touching) {
    const std::optional<std::uint32_t> item = item_at(touching);
    if (!item) return;
    const PowerOfTwo back = frames_.to_mesh_units();
    ContactArea area{{}, 0, touching.faces, near_[*item].region};
    for (const BoundedPoint& corner : touching.meeting->corners) {
      const Point3& p = area.points.emplace_back(require_representable(back.apply(corner.position)));
      const Point3 again = back.inverse().apply(p);
      const double lost = again == corner.position ? 0 : underflow_error;
      area.error = std::max(area.error, corner.error > 0 ? unscaled_up(corner.error, back) + lost : lost);
    }
    prove(area.region);
    answer_.areas.push_back(std::move(area));
  }
  void add_curves() {
    const PowerOfTwo back = frames_.to_mesh_units();
    for (const Chains::Chain& chain : chains_of(cut_).chains) {
      IntersectionCurve curve;
      curve.closed = chain.closed;
      curve.proved = true;
      curve.at_border = chain.at_border;
      curve.region = near_[cut_.arcs[chain.ends.front() / 2].contact].region;
      double error = 0;
      const auto point = [&](std::uint32_t end) {
        const CutEnd& e = cut_.arcs[end / 2].arc.ends[end % 2];
        error = std::max(error, e.error);
        return require_representable(back.apply(e.point));
      };
      const auto box = [&](const Box3& b, bool one_arc) {
        curve.boxes.push_back({unscaled(b, back), one_arc});
        curve.proved = curve.proved && one_arc;
      };
      for (std::size_t i = 0; i < chain.ends.size(); ++i) {
        const std::uint32_t in = chain.ends[i], out = in ^ 1u;
        const CutArc& arc = cut_.arcs[in / 2].arc;
        curve.points.push_back(point(in));
        error = std::max(error, arc.deviation);
        box(arc.box, true);
        const bool last = i + 1 == chain.ends.size();
        const Box3* const gap = i < chain.gaps.size() && !chain.gaps[i].empty() ? &chain.gaps[i] : nullptr;
        if (gap != nullptr) {
          curve.points.push_back(point(out));
          box(*gap, false);
          if (longest_side(*gap) > frames_.length_down(*options_.error))
            answer_.outcome = worse(answer_.outcome, Outcome::at_rounding);
          const Vector3 sides = gap->upper - gap->lower;
          error = std::max(error, enlarged(length(sides)));
        } else if (last && !chain.closed) {
          curve.points.push_back(point(out));
        }
      }
      // Two ends that are one point are reported as one of them.
      curve.error = unscaled_up(enlarged(3 * error), back) + underflow_error;
      answer_.curves.push_back(std::move(curve));
    }
    for (const UnresolvedPieces& open : few_open()) {
      answer_.open.push_back({unscaled(open.box, back),
                              {surface(0).place(open.roots[0]), surface(1).place(open.roots[1])},
                              near_[open.contact].region});
    }
  }

  // Boxes of the same patches and region together, where there are too many.
  [[nodiscard]] std::vector<UnresolvedPieces> few_open() const {
    std::vector<UnresolvedPieces> open = cut_.unresolved, merged;
    if (open.size() <= max_open) return open;
    const auto place = [&](const UnresolvedPieces& one) {
      return std::tuple(near_[one.contact].region, one.roots);
    };
    std::stable_sort(open.begin(), open.end(), [&](const UnresolvedPieces& a, const UnresolvedPieces& b) {
      return place(a) < place(b);
    });
    const std::span<UnresolvedPieces> all(open);
    for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
      while (end < all.size() && place(all[end]) == place(all[begin])) ++end;
      const std::size_t count = end - begin;
      add_merged(all.subspan(begin, count), std::max<std::size_t>(1, max_open * count / all.size()), merged);
    }
    return merged;
  }

  PairFrames frames_;
  FacetContacts facets_;
  const ContactsOptions& options_;
  const Run& run_;
  double tolerance_;
  std::vector<ContactPair> near_;
  std::map<std::array<std::uint32_t, 2>, std::vector<std::uint32_t>> items_;  // by two plane faces
  CutSurfaces cut_;
  Contacts answer_;
};

}  // namespace

Contacts contacts(const PlacedSurface& surface_a, const PlacedSurface& surface_b,
                  const ContactsOptions& options, const Run& run) {
  const auto [a, b] = PlacedPair(surface_a, surface_b, workspace_of(run));
  ContactsOptions wanted = options;
  const double share = share_of_size(1e-3, a.model.surface().size(), b.model.surface().size());
  if (!wanted.within) wanted.within = share;
  if (!wanted.error) wanted.error = share;
  require_length(*wanted.within, "contacts: 'within'");
  require_length(*wanted.error, "contacts: the error");
  require_value(*wanted.error > 0 || !options.error, "contacts: the error must be positive");
  if (root_gap(a, b, *wanted.within) > *wanted.within) {
    Contacts none;
    none.exhaustive = true;
    return none;
  }
  return ContactsSearch(a, b, wanted, run).run();
}

}  // namespace snug
