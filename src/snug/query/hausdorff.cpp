#include <snug/query/hausdorff.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include <snug/geometry/rounding.h>
#include <snug/query/plane_cover.h>
#include <support/parallel.h>

namespace snug {
namespace {

// Are all points of a part on the queried side?
enum class Side : std::uint8_t { unknown, asked, other };

struct Part {
  std::uint32_t piece;
  std::uint8_t depth = 0;
  std::uint8_t tried = 0;  // corners that were no lower bound when asked, a bit each
  Side side = Side::unknown;
  std::array<TriangleParameter, 3> at;
  std::array<QuadraticFoot, 3> feet;  // of the corners, on the other set
  double upper = INFINITY;            // all its points are at most this far from the other set
  double reach = INFINITY;            // all points of the whole piece are
};

// How a part compares with the pieces of the other set below its corners.
struct Comparison {
  double upper = INFINITY;      // all its points are at most this far from the other set
  double geometric = INFINITY;  // without the errors of the quadratics
  double errors = 0;
  double at_corners = 0, bent = 0;  // largest distance of a corner, of a middle
  std::size_t edge = 0;             // where to cut, from corner `edge` to the next
  double share = 0.5;
};

// Gaps that rounding leaves at each cut sum to less than distance_rounding.
constexpr unsigned max_depth = 120;

// Of the precision: heights between pieces that lie on one plane.
constexpr double cover_share = 0.125;

// Parts that are compared before what is left goes back to be handed out again.
constexpr std::size_t chunk_work = 4096;
constexpr std::size_t chunk_pieces = 32;
constexpr std::size_t chunks_at_once = 64;
// Blocks of feet after which the farthest corner of them is compared with a threshold.
constexpr std::size_t blocks_at_once = 4;

// Raises the lower end to what a point proves that lies at a parameter of a piece, with a foot near it; makes the foot nearer where
// that is found.
void raise_lower_end(const BoundedPoint& point, std::pair<std::uint32_t, TriangleParameter> at,
                     const PieceSet& other, const HausdorffOptions& options, QuadraticFoot& foot,
                     Farthest& found) {
  const double lower =
      certain_distance(other, point.position, options.precision / 16, foot) - spatial_error(point.error);
  if (!(lower > found.lower)) return;
  found.lower = lower;
  found.from = point;
  found.to = foot;
  found.at = at;
}

class Chunk {
 public:
  Chunk(const PieceSet& set, const PieceSet& other, const HausdorffOptions& options, bool last,
        const Farthest& known)
      : set_(set), other_(other), options_(options), last_(last), found_(known) {
    found_.compared = 0;
  }

  // Resolves parts until the work of a chunk is done; `stack` keeps the others.
  void run(std::vector<Part>& stack, const SideTest& side_test, std::vector<Unresolved>& unresolved,
           const WorkMonitor& monitor) {
    while (!stack.empty() && found_.compared < chunk_work) {
      if (found_.compared % 64 == 0) monitor.checkpoint();
      Part part = stack.back();
      stack.pop_back();
      ++found_.compared;
      if (resolve(part, side_test)) continue;
      if (limited_) {
        // The rest of the piece is compared again with it.
        const std::uint32_t piece = part.piece;
        std::erase_if(stack, [&](const Part& p) { return p.piece == piece; });
        unresolved.push_back({piece, part.reach});
        continue;
      }
      cut(part, stack);
    }
  }
  // Resolves all parts as they are.
  void give_up(std::vector<Part>& stack) {
    for (Part& part : stack) {
      if (part.side == Side::other) continue;
      if (part.upper == INFINITY) see(part);
      found_.upper = std::max(found_.upper, part.upper);
    }
    stack.clear();
  }
  [[nodiscard]] const Farthest& found() const { return found_; }

 private:
  void see(Part& part) {
    quadratic_ = restricted(set_[part.piece], part.at);
    compare(part);
    if (part.depth == 0) part.reach = part.upper;
  }

  // Distance that parts need not be below.
  [[nodiscard]] double goal() const {
    const double wanted = found_.lower + options_.precision;
    if (!options_.threshold) return wanted;
    return found_.lower > *options_.threshold ? INFINITY : std::max(wanted, *options_.threshold);
  }

  bool resolve(Part& part, const SideTest& side_test) {
    limited_ = false;
    if (part.side == Side::other) return true;
    see(part);
    // A first point to report, whatever the options.
    if (found_.lower == 0 && !side_test && raise_lower(part, side_test)) compare(part);
    if (accept(part)) return true;
    if (side_test && part.side == Side::unknown) {
      find_side(part, side_test);
      if (part.side == Side::other) return true;
    }
    if (raise_lower(part, side_test)) {
      compare(part);
      if (accept(part)) return true;
    }
    // Is there nothing to be had from smaller parts?
    const bool errors_rule = now_.errors > options_.precision / 4;
    const bool small = gain(part) <= options_.precision * (errors_rule ? 0.25 : 0x1p-4);
    const bool on_side = !side_test || part.side == Side::asked;
    // Other errors than its own keep the lower end down where a small part is above the goal.
    limited_ = small && (errors_rule || on_side) && !last_;
    if (limited_) return false;
    if (part.depth < max_depth && !(small && on_side)) return false;
    found_.upper = std::max(found_.upper, part.upper);
    return true;
  }

  // Largest distance that smaller parts may gain.
  [[nodiscard]] double gain(const Part& part) const {
    return now_.geometric - std::max({part.feet[0].distance, part.feet[1].distance, part.feet[2].distance});
  }

  bool accept(const Part& part) {
    if (!(part.upper <= goal())) return false;
    found_.upper = std::max(found_.upper, part.upper);
    return true;
  }

  void find_side(Part& part, const SideTest& side_test) const {
    if (may_meet(other_, quadratic_)) return;
    // No point of it is on the surface: all are on one side.
    const std::optional<bool> asked = side_test(quadratic_.corners[0], distance_rounding);
    if (asked) part.side = *asked ? Side::asked : Side::other;
  }

  // Asks the farthest corner for a lower bound. Has a nearer foot of it come up?
  bool raise_lower(Part& part, const SideTest& side_test) {
    const std::size_t k = static_cast<std::size_t>(
        std::max_element(part.feet.begin(), part.feet.end(),
                         [](const auto& x, const auto& y) { return x.distance < y.distance; }) -
        part.feet.begin());
    const double error = other_.error(part.feet[k].piece);
    if ((part.tried >> k & 1u) != 0) return false;
    if (!(part.feet[k].distance - error > found_.lower + options_.precision / 16)) return false;
    part.tried = static_cast<std::uint8_t>(part.tried | 1u << k);
    const BoundedPoint point = set_.point(part.piece, part.at[k]);
    if (side_test && part.side != Side::asked) {
      if (side_test(point.position, spatial_error(point.error)) != true) return false;
    }
    QuadraticFoot foot = foot_on(other_, part.feet[k].piece, point.position);
    const double before = foot.distance;
    raise_lower_end(point, {part.piece, part.at[k]}, other_, options_, foot, found_);
    if (foot.distance < before) {
      foot.distance = distance(foot.point, quadratic_.corners[k]);
      part.feet[k] = foot;
      part.tried = static_cast<std::uint8_t>(part.tried & ~(1u << k));
    }
    return true;
  }

  // With the piece below each corner in turn; stops at one that is near enough.
  void compare(Part& part) {
    now_ = {};
    std::array<std::array<double, 3>, 3> to_piece{};  // distances of corners to the piece below corner i
    std::size_t different = 0;
    bool torn = false;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t piece = part.feet[i].piece;
      const bool known = (i > 0 && piece == part.feet[0].piece) || (i == 2 && piece == part.feet[1].piece);
      if (known) to_piece[i] = to_piece[piece == part.feet[0].piece ? 0 : 1];
      if (known && !torn) continue;
      different += !known;
      std::array<QuadraticFoot, 3> feet = part.feet;
      for (std::size_t k = 0; k < 3; ++k) {
        if (feet[k].piece != piece) feet[k] = foot_on(other_, piece, quadratic_.corners[k]);
        if (!known) to_piece[i][k] = feet[k].distance;
      }
      const double geometric = compare_with(part, feet);
      if (now_.upper <= goal()) break;
      // From one foot nothing is farther than the part is large beyond its own distance. If the piece's part below is, it comes back
      // to where it was, and feet are on different sheets of it.
      torn = farthest_from(part.feet[i].point) < geometric;
      if (torn) {
        compare_with(part, {part.feet[i], part.feet[i], part.feet[i]});
        for (std::size_t k = 0; k < 3; ++k) {
          if (k != i) feet[k] = foot_beside(other_, part.feet[i], quadratic_.corners[k]);
        }
        compare_with(part, feet);
      }
      if (now_.upper <= goal()) break;
    }
    part.upper = std::min(part.upper, now_.upper);
    if (different > 1 && now_.at_corners >= now_.bent * (1 - 0x1p-20)) choose_border(part, to_piece);
  }

  // With the part of a piece whose corners are `feet`. How far are both apart?
  double compare_with(const Part& part, std::array<QuadraticFoot, 3> feet) {
    for (std::size_t k = 0; k < 3; ++k) feet[k].distance = distance(feet[k].point, quadratic_.corners[k]);
    const QuadraticTriangle there = below(other_, feet);
    const double at_corners = std::max({feet[0].distance, feet[1].distance, feet[2].distance});
    std::array<double, 3> at_middles;
    for (std::size_t k = 0; k < 3; ++k) at_middles[k] = distance(quadratic_.middles[k], there.middles[k]);
    const auto most = std::max_element(at_middles.begin(), at_middles.end());
    const double geometric = std::max(at_corners, *most),
                 errors = set_.error(part.piece) + other_.error(feet[0].piece),
                 upper = enlarged(geometric + errors) + distance_rounding;
    if (upper < now_.upper) {
      now_ = {.upper = upper,
              .geometric = geometric,
              .errors = errors,
              .at_corners = at_corners,
              .bent = *most,
              .edge = static_cast<std::size_t>(most - at_middles.begin())};
    }
    return geometric;
  }

  // Of the part's points from a point.
  [[nodiscard]] double farthest_from(const Point3& point) const {
    double most = 0;
    for (const Point3& p : points_of(quadratic_)) most = std::max(most, distance(p, point));
    return most;
  }

  // Where an edge leaves the piece below one end for that below the other: exact where both lie in a plane.
  void choose_border(const Part& part, const std::array<std::array<double, 3>, 3>& to_piece) {
    double most = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      if (part.feet[k].piece == part.feet[next].piece) continue;
      const auto over = [&](std::size_t piece_of, std::size_t c) {
        const double own = part.feet[c].distance, far = to_piece[piece_of][c];
        return std::sqrt(std::max(0.0, (far - own) * (far + own)));
      };
      const double there = over(next, k), here = over(k, next);
      if (there + here > most) {
        most = there + here;
        now_.edge = k;
        now_.share = std::clamp(there / (there + here), 0x1p-6, 1 - 0x1p-6);
      }
    }
  }

  void cut(const Part& part, std::vector<Part>& stack) {
    std::size_t k = now_.edge;
    double share = now_.share;
    // Where distances themselves are too long no edge is to blame; cuts near corners leave needles.
    if (gain(part) <= options_.precision / 16 || part.depth % 8 == 7) {
      double longest = -1;
      for (std::size_t i = 0; i < 3; ++i) {
        if (const double length = distance(quadratic_corner(part, i), quadratic_corner(part, (i + 1) % 3));
            length > longest) {
          longest = length;
          k = i;
        }
      }
      share = 0.5;
    }
    const std::size_t next = (k + 1) % 3;
    const TriangleParameter a = part.at[k], b = part.at[next];
    TriangleParameter at{a.u + share * (b.u - a.u), a.v + share * (b.v - a.v)};
    if (at.u + at.v > 1) at.v = 1 - at.u;
    const Point3 point = point_of(set_[part.piece], at);
    const QuadraticFoot foot = nearest_foot(other_, point, part.feet[share < 0.5 ? k : next]);
    for (const std::size_t moved : {k, next}) {
      Part child = part;
      child.at[moved] = at;
      child.feet[moved] = foot;
      child.tried = static_cast<std::uint8_t>(child.tried & ~(1u << moved));
      ++child.depth;
      stack.push_back(child);
    }
  }
  [[nodiscard]] Point3 quadratic_corner(const Part& part, std::size_t k) const {
    return point_of(set_[part.piece], part.at[k]);
  }

  const PieceSet& set_;
  const PieceSet& other_;
  const HausdorffOptions& options_;
  bool last_;
  Farthest found_;
  QuadraticTriangle quadratic_{};  // of the part at hand
  Comparison now_;
  bool limited_ = false;
};

// The feet of the corners of pieces; corners at the same point are asked once.
class CornerFeet {
 public:
  CornerFeet(const PieceSet& set, std::span<const std::uint32_t> pieces, const PieceSet& other)
      : set_(set), pieces_(pieces), other_(other) {
    std::size_t size = 16;
    while (size < 6 * pieces.size()) size *= 2;
    std::vector<std::uint32_t> table(size, UINT32_MAX);
    names_.resize(3 * pieces.size());
    for (std::size_t c = 0; c < names_.size(); ++c) {
      const Point3 p = point(c);
      std::size_t slot = hash(p) & (size - 1);
      while (table[slot] != UINT32_MAX && !(point(corners_[table[slot]]) == p))
        slot = (slot + 1) & (size - 1);
      if (table[slot] == UINT32_MAX) {
        table[slot] = static_cast<std::uint32_t>(corners_.size());
        corners_.push_back(static_cast<std::uint32_t>(c));
      }
      names_[c] = table[slot];
    }
    feet_.reserve(corners_.size());
  }

  [[nodiscard]] bool all_found() const { return feet_.size() == corners_.size(); }
  // Finds at most so many blocks of feet, of a fixed length so that hints depend on the input alone. Which corner of which of the
  // pieces is farthest among these?
  std::pair<std::size_t, std::size_t> find(std::size_t blocks, int threads, const WorkMonitor& monitor) {
    constexpr std::size_t block = 256;
    const std::size_t first = feet_.size(), here = std::min(corners_.size() - first, blocks * block);
    feet_.resize(first + here);
    std::vector<double> distances(here);
    parallel_for((here + block - 1) / block, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) {
        monitor.checkpoint();
        QuadraticFoot hint;
        for (std::size_t i = b * block; i < std::min(here, (b + 1) * block); ++i) {
          hint = nearest_foot(other_, point(corners_[first + i]), hint);
          feet_[first + i] = {{hint.at.u, hint.at.v}, hint.piece};
          distances[i] = hint.distance;
        }
      }
    });
    const auto farthest =
        static_cast<std::size_t>(std::max_element(distances.begin(), distances.end()) - distances.begin());
    const std::uint32_t corner = corners_[first + farthest];
    return {corner / 3, corner % 3};
  }

  [[nodiscard]] QuadraticFoot operator()(std::size_t i, std::size_t corner) const {
    const auto& [at, piece] = feet_[names_[3 * i + corner]];
    return foot_at(other_, piece, {at[0], at[1]}, point(3 * i + corner));
  }
  // Of the corners of a piece, the largest one.
  [[nodiscard]] double distance(std::size_t i) const {
    return std::max({(*this)(i, 0).distance, (*this)(i, 1).distance, (*this)(i, 2).distance});
  }

 private:
  static std::size_t hash(const Point3& p) {
    std::uint64_t h = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      h = (h ^ std::bit_cast<std::uint64_t>(p[a] + 0.0)) * 0x9e3779b97f4a7c15u;
      h ^= h >> 29;
    }
    return h;
  }

  // Corner c % 3 of piece c / 3.
  [[nodiscard]] Point3 point(std::size_t c) const {
    const std::uint32_t piece = pieces_[c / 3];
    const QuadraticTriangle* const q = set_.kept(piece);
    return q != nullptr ? q->corners[c % 3] : set_.facet(piece)[c % 3];
  }

  // A foot is made again where it is wanted: of a hull's facets there are hundreds of thousands.
  struct Foot {
    std::array<double, 2> at;
    std::uint32_t piece;
  };

  const PieceSet& set_;
  std::span<const std::uint32_t> pieces_;
  const PieceSet& other_;
  std::vector<std::uint32_t> names_;    // of the points, three a piece
  std::vector<std::uint32_t> corners_;  // of each point one
  std::vector<Foot> feet_;
};

// How far pieces that lie on flat ones of the other set are from it, at most; of others nothing. Those whose corners are near it are asked.
std::vector<std::optional<double>> covered_pieces(const PieceSet& set, std::span<const std::uint32_t> pieces,
                                                  const PieceSet& other, const CornerFeet& corners,
                                                  double most, int threads, const WorkMonitor& monitor) {
  std::vector<std::optional<double>> covered(pieces.size());
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (corners.distance(i) <= most) near.push_back(i);
  }
  if (near.empty()) return covered;
  const PlaneCover cover(other, most);
  parallel_for(near.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      if (k % 64 == 0) monitor.checkpoint();
      covered[near[k]] = cover.distance_of(set[pieces[near[k]]]);
    }
  });
  return covered;
}

// Is a distance greater than the threshold, in mesh units too?
bool is_beyond(double lower, const HausdorffOptions& options) {
  return options.threshold && lower > (1 + 16 * unit_roundoff) * *options.threshold;
}

// All of some pieces, however far: no point of them is farther from the other set than from one point of that.
double farthest_from_a_point(const PieceSet& set, std::span<const std::uint32_t> pieces,
                             const PieceSet& other) {
  double most = 0;
  for (const std::uint32_t piece : pieces) {
    const QuadraticTriangle& p = set[piece];
    for (std::size_t k = 0; k < 3; ++k) {
      for (const Point3& of_net : {p.corners[k], p.middles[k]}) {
        most = std::max(most, distance(of_net, other[0].corners[0]) + p.error);
      }
    }
  }
  return enlarged(most + other.error(0)) + distance_rounding;
}

void merge(Farthest& all, const Farthest& part) {
  all.compared += part.compared;
  all.upper = std::max(all.upper, part.upper);
  if (part.lower > all.lower) {
    all.lower = part.lower;
    all.from = part.from;
    all.to = part.to;
    all.at = part.at;
  }
}

}  // namespace

std::vector<Unresolved> resolve(const PieceSet& set, std::span<const std::uint32_t> pieces,
                                const PieceSet& other, const HausdorffOptions& options, bool last,
                                Farthest& farthest, const WorkMonitor& monitor) {
  CornerFeet corners(set, pieces, other);
  const auto end_beyond_threshold = [&] {
    farthest.upper = std::max(farthest.upper, farthest_from_a_point(set, pieces, other));
    return std::vector<Unresolved>{};
  };
  while (!corners.all_found()) {
    if (is_beyond(farthest.lower, options)) return end_beyond_threshold();
    const auto [i, k] = corners.find(blocks_at_once, options.threads, monitor);
    if (options.make_side_test || !is_beyond(corners(i, k).distance, options)) continue;
    const TriangleParameter at{k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0};
    const BoundedPoint point = set.point(pieces[i], at);
    QuadraticFoot foot = foot_on(other, corners(i, k).piece, point.position);
    raise_lower_end(point, {pieces[i], at}, other, options, foot, farthest);
  }
  const auto first_part = [&](std::size_t i) {
    Part part{.piece = pieces[i], .at = {TriangleParameter{0, 0}, {1, 0}, {0, 1}}, .feet = {}};
    for (std::size_t k = 0; k < 3; ++k) part.feet[k] = corners(i, k);
    return part;
  };
  // Farthest first: they bound at once how far the others must be examined.
  std::vector<double> far(pieces.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    far[i] = corners.distance(i);
  }
  const std::vector<std::optional<double>> covered =
      covered_pieces(set, pieces, other, corners, cover_share * options.precision, options.threads, monitor);
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < pieces.size(); ++i) {
    if (covered[i]) {
      farthest.upper = std::max(farthest.upper, *covered[i]);
    } else {
      order.push_back(i);
    }
  }
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t x, std::uint32_t y) { return far[x] != far[y] ? far[x] > far[y] : x < y; });

  std::vector<Unresolved> unresolved;
  std::vector<std::vector<Part>> left;  // of chunks that had more to do
  std::size_t next = 0;
  // With the first ones the lower end is not known yet.
  std::size_t chunks = 4;
  while (next < order.size() || !left.empty()) {
    if (is_beyond(farthest.lower, options)) return end_beyond_threshold();
    monitor.report(static_cast<double>(next) / static_cast<double>(order.size()));
    std::vector<std::vector<Part>> stacks = std::exchange(left, {});
    while (stacks.size() < chunks && next < order.size()) {
      std::vector<Part>& stack = stacks.emplace_back();
      const std::size_t end = std::min(order.size(), next + chunk_pieces);
      for (std::size_t i = end; i-- > next;) stack.push_back(first_part(order[i]));
      next = end;
    }
    chunks = std::min(chunks_at_once, 2 * chunks);
    const bool ends = farthest.compared >= options.budget;
    std::vector<Farthest> found(stacks.size());
    std::vector<std::vector<Unresolved>> limited(stacks.size());
    parallel_for_with(
        stacks.size(), options.threads,
        [&] { return options.make_side_test ? options.make_side_test() : SideTest{}; },
        [&](const SideTest& side_test, std::size_t begin, std::size_t end) {
          for (std::size_t c = begin; c < end; ++c) {
            Chunk chunk(set, other, options, last, farthest);
            if (ends) {
              chunk.give_up(stacks[c]);
            } else {
              chunk.run(stacks[c], side_test, limited[c], monitor);
            }
            found[c] = chunk.found();
          }
        });
    for (std::size_t c = 0; c < stacks.size(); ++c) {
      merge(farthest, found[c]);
      unresolved.insert(unresolved.end(), limited[c].begin(), limited[c].end());
      if (!stacks[c].empty()) left.push_back(std::move(stacks[c]));
    }
    farthest.ended = farthest.ended || ends;
  }
  return unresolved;
}

}  // namespace snug
