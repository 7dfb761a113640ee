#include <snug/hull.h>
#include <snug/search/surface_data.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <unordered_set>
#include <utility>

#include <snug/distance.h>
#include <snug/geometry/rounding.h>
#include <snug/measure.h>
#include <snug/search/feet.h>
#include <snug/search/offset_mesh.h>
#include <snug/search/piece.h>
#include <snug/search/placed_box.h>
#include <snug/search/precision.h>
#include <snug/search/self_contact.h>
#include <snug/search/solid.h>
#include <support/direction.h>
#include <support/error.h>
#include <support/parallel.h>
#include <support/run.h>
#include <support/scaling.h>

namespace snug {
namespace {

using Index = std::uint32_t;

// Of the band, from below: where vertices are put. Nearer to the surfaces than the middle, since facets across the mouths of gaps
// are farther from them than their corners.
constexpr double level_share = 0.4;
// Sides of cubes: of the level, below 2 / sqrt(3), so that each point of a surface has a corner of its cube within the level; and of the
// band's width, if that is less. Then shares of these, where the first do not do.
constexpr double cell_of_level = 1.1, cell_of_width = 0.8;
constexpr std::array cell_shares{1.0, 0.64, 0.4};
// Of the band's width: errors of pieces; how far collapses move planes once facets are looked at one by one; how far off the level
// vertices may be, and how far below it.
constexpr double piece_error_share = 0x1p-6, last_move_share = 0.5, vertex_share = 0.3, near_share = 0.1;
// The least cosine between a facet's normal and the way from the surface to its centre; between it and the mean one at a vertex where
// the mesh is not bent.
constexpr double least_facing = 0.3, least_flat = 0.8;
// How far collapses move planes before, first and second.
constexpr double first_move_share = 0.04, second_move_share = 0.11;
// Of all facets: more are not halved.
constexpr double max_wrong_share = 0.125;
constexpr int first_rounds = 8, max_rounds = 24, max_reductions = 5, max_steps = 8;
constexpr std::size_t facets_beside = 20'000, max_boxes = 20'000, max_known = 100'000;
constexpr std::uint64_t least_pieces = 1u << 17;
constexpr std::size_t max_contacts = 100'000, max_problems = 100;
// Of a facet, to show that it is near. Rounding of a middle is within distance_rounding, as often as that.
struct Effort {
  int halvings;
  bool if_open;  // the answer where these do not decide
  bool bridges;  // is it enough that a ball does not get there?
};
constexpr Effort look{3, true, true}, proof{16, false, true}, proof_of_error{16, false, false};
// With a gap: sides of cubes of the radius; and, of the band's width, how far the ball reaches beyond the level, so that distances from
// the surfaces decide where they can, and how closely distances of bridges are bounded.
constexpr double cell_of_radius = 0.125, beyond_share = 0.1, overlap_share = 0.2, bridge_share = 0.5;
// A pose sums four terms, each at most twice the largest coordinate or offset, in each of three coordinates.
constexpr double pose_roundings = 64 * unit_roundoff;

// All parts as one set, in units in which coordinates are below 1.
struct PlacedPieces {
  PieceSet set;
  PowerOfTwo scale;  // from mesh units
  std::vector<Point3>
      members;  // for each connected component of a part, a point within the error of its pieces
};

// A box around all parts, in mesh units.
Box3 box_around(std::span<const PlacedSurface> parts) {
  Box3 all;
  for (const PlacedSurface& part : parts) all.add(placed_box(part.surface().data()->bvh(), part.pose()));
  require_representable(all.lower);
  require_representable(all.upper);
  return all;
}

// Nothing if these would be more than `most`.
std::optional<PlacedPieces> placed_pieces(std::span<const PlacedSurface> parts, PowerOfTwo scale,
                                          double error, std::uint64_t most, const Run& run) {
  Blocks<QuadraticTriangle> all;
  PlacedPieces result{.set = {}, .scale = scale, .members = {}};
  for (const PlacedSurface& part : parts) {
    const LimitSurface& surface = part.surface().data()->bvh().surface();
    const PieceSet own(surface, error, run.threads, stop_only(run), most, scale * surface.scale().inverse());
    if (own.size() == 0 || all.size() + own.size() > most) return std::nullopt;
    const std::vector<PatchId> components = component_patches(surface);
    auto component = components.begin();
    const Motion& pose = part.pose();
    const Vector3 offset = scale.apply(pose.offset());
    const auto placed = [&](const Point3& p) {
      const Vector3 v = p - Point3{};
      return Point3{dot(pose.row(0), v), dot(pose.row(1), v), dot(pose.row(2), v)} + offset;
    };
    for (std::size_t i = 0; i < own.size(); ++i) {
      QuadraticTriangle piece = own[i];
      double largest = max_abs(offset);
      for (const Point3& p : piece.corners) largest = std::max(largest, max_abs(p - Point3{}));
      for (const Point3& p : piece.middles) largest = std::max(largest, max_abs(p - Point3{}));
      for (Point3& p : piece.corners) p = placed(p);
      for (Point3& p : piece.middles) p = placed(p);
      // Whatever the direction: the normal that goes with the error is the unturned piece's.
      piece.normal = {};
      piece.normal_error = 0;
      piece.error = enlarged((1 + 4 * pose.defect()) * piece.error + pose_roundings * largest);
      if (!std::isfinite(piece.error)) {
        throw InputError(InputProblem::unrepresentable,
                         "envelope: a patch of the surface does not fit doubles; scale the mesh");
      }
      if (component != components.end() && own.name(i).patch == *component) {
        result.members.push_back(piece.corners[0]);
        ++component;
      }
      all.push_back(piece);
    }
  }
  result.set = PieceSet(std::move(all));
  result.set.prepare(run.threads);
  return result;
}

Point3 centre_of(const Triangle& t) { return t[0] + (1.0 / 3) * ((t[1] - t[0]) + (t[2] - t[0])); }

std::uint64_t hash_of(std::span<const Point3> points) {
  std::uint64_t hash = points.size();
  for (const Point3& p : points) {
    for (std::size_t a = 0; a < 3; ++a) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(p[a])) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 29;
    }
  }
  return hash;
}
struct TriangleHash {
  std::size_t operator()(const Triangle& t) const { return hash_of(t); }
};

// Answers about points and triangles that collapses ask for again, by their coordinates; later ones take the places of
// former ones. No proof rests on it.
class LookTable {
 public:
  template <class Find>
  bool ask(std::span<const Point3> of, const Find& find) {
    const std::uint64_t hash = hash_of(of);
    std::atomic<std::uint64_t>& slot = slots_[hash >> 43];
    const std::uint64_t known = slot.load(std::memory_order_relaxed);
    if (known >> 1 == hash >> 1) return (known & 1u) != 0;
    const bool answer = find();
    slot.store((hash & ~std::uint64_t{1}) | (answer ? 1u : 0u), std::memory_order_relaxed);
    return answer;
  }

 private:
  std::vector<std::atomic<std::uint64_t>> slots_ = std::vector<std::atomic<std::uint64_t>>(1u << 21);
};

bool contains(const Box3& box, const Point3& p) {
  for (std::size_t a = 0; a < 3; ++a) {
    if (!(box.lower[a] <= p[a] && p[a] <= box.upper[a])) return false;
  }
  return true;
}

class EnvelopeMaker {
 public:
  EnvelopeMaker(const PlacedPieces& pieces, Interval band, const EnvelopeOptions& options, const Run& run)
      : pieces_(pieces), options_(options), run_(run), monitor_(stop_only(run)), band_(band) {}

  Envelope run() {
    const double width = band_.upper - band_.lower;
    const double side = std::min(cell_of_level * level(), cell_of_width * width);
    OffsetMeshOptions options{.offset = 0,
                              .cell = 0,
                              .most_cells = run_.max_splits.value_or(default_splits::envelope),
                              .ball = nullptr,
                              .threads = run_.threads};
    if (options_.gap) {
      radius_ = pieces_.scale.apply(*options_.gap) / 2;
      options.offset = radius_;
      options.cell = std::max(cell_of_radius * radius_, 0.8 * side);
      std::optional<ClosedMesh> around = offset_mesh(pieces_.set, options, monitor_);
      if (!around) return without(HullFault::too_few_triangles, pieces_.members[0]);
      parallel_for(around->points.size(), run_.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
          Point3& p = around->points[v];
          const QuadraticFoot foot = nearest_foot(pieces_.set, p);
          if (foot.distance > 0) p = foot.point + (radius_ / foot.distance) * (p - foot.point);
        }
      });
      ball_.emplace(std::move(*around), radius_ - level() + beyond_share * width, run_.threads);
      options.ball = &*ball_;
    }
    options.offset = level();
    for (const double share : cell_shares) {
      options.cell = share * side;
      std::optional<ClosedMesh> made = offset_mesh(pieces_.set, options, monitor_);
      if (!made) return without(HullFault::too_few_triangles, pieces_.members[0]);
      monitor_of(run_).report(0.4);
      mesh_ = std::move(*made);
      if (!halve_bent() || !reduce_far()) continue;
      monitor_of(run_).report(0.6);
      // Looked at here and there, judged at the end.
      ClosedMesh fine = mesh_;
      const auto accept = [&](const Triangle& t) { return looks_.ask(t, [&] { return looks_right(t); }); };
      if (!reduce(last_move_share, accept)) {
        mesh_ = std::move(fine);
      }
      monitor_of(run_).report(0.9);
      return finished();
    }
    const auto wrong = std::find(wrong_.begin(), wrong_.end(), to_halve);
    const std::size_t t = wrong == wrong_.end() ? 0 : static_cast<std::size_t>(wrong - wrong_.begin());
    return without(HullFault::meets_itself, mesh_.points[mesh_.triangles[t][0]]);
  }

 private:
  enum State : std::uint8_t { proved, to_halve };

  [[nodiscard]] const RollingBall* ball() const { return ball_ ? &*ball_ : nullptr; }
  [[nodiscard]] double level() const { return band_.lower + level_share * (band_.upper - band_.lower); }
  [[nodiscard]] Triangle corners(Index t) const {
    const auto& [a, b, c] = mesh_.triangles[t];
    return {mesh_.points[a], mesh_.points[b], mesh_.points[c]};
  }
  [[nodiscard]] Point3 in_mesh_units(const Point3& p) const { return pieces_.scale.inverse().apply(p); }

  // Vertices nearer than `least` go to the level, of those that are marked, if any are. Those that are far stay: they are where gaps
  // are bridged.
  void push_off(double least, std::span<const std::uint8_t> marked = {}) {
    parallel_for(mesh_.points.size(), run_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        if (!marked.empty() && marked[v] == 0) continue;
        Point3& p = mesh_.points[v];
        const QuadraticFoot foot = least > 0 ? nearest_foot(pieces_.set, p) : QuadraticFoot{};
        if (foot.distance < least && foot.distance > 0) {
          p = foot.point + (level() / foot.distance) * (p - foot.point);
        }
        p = as_written(p);
      }
    });
  }
  // With the coordinates that are handed out.
  [[nodiscard]] Point3 as_written(const Point3& p) const {
    Point3 out = in_mesh_units(p);
    for (std::size_t a = 0; a < 3 && options_.single_precision; ++a) {
      out[a] = static_cast<double>(static_cast<float>(out[a]));
      if (!std::isfinite(out[a])) {
        throw InputError(InputProblem::unrepresentable,
                         "envelope: a coordinate does not fit a float; scale the mesh down, or write a "
                         "format that holds doubles");
      }
    }
    return pieces_.scale.apply(require_representable(out));
  }

  // Moves vertices along the normals there, inward or outward, until they are well within the band: through a gap, where the way to
  // the nearest surface leads aside.
  void steer(std::span<const Index> vertices) {
    std::vector<Vector3> normals(mesh_.points.size());
    for (Index t = 0; t < mesh_.triangles.size(); ++t) {
      const Vector3 normal = unit_normal(corners(t));
      for (const Index v : mesh_.triangles[t]) normals[v] = normals[v] + normal;
    }
    const double most = vertex_share * (band_.upper - band_.lower);
    parallel_for(vertices.size(), run_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        Point3& p = mesh_.points[vertices[i]];
        p = as_written(p);
        const Vector3 outward = normalized(normals[vertices[i]]);
        Point3 at = p;
        OffsetHeight there;
        for (int step = 0; step < max_steps && distance(at, p) <= level(); ++step) {
          there = height_at(pieces_.set, level(), ball(), at, there);
          const double off = there.height;
          if (std::fabs(off) <= most) {
            p = as_written(at);
            break;
          }
          at = at + (off > 0 ? most / 2 - off : -most / 2 - off) * outward;
        }
      }
    });
  }
  [[nodiscard]] double least_distance() const { return level() - near_share * (band_.upper - band_.lower); }
  // Can facets be in the band where the mesh is bent, halved or not? Where gaps are too narrow for the cubes they cannot, whatever
  // collapses.
  bool halve_bent() {
    std::vector<Vector3> normals(mesh_.points.size());
    for (Index t = 0; t < mesh_.triangles.size(); ++t) {
      const Vector3 normal = unit_normal(corners(t));
      for (const Index v : mesh_.triangles[t]) normals[v] = normals[v] + normal;
    }
    std::vector<std::uint8_t> bent(mesh_.points.size(), 0), beside = bent;
    for (Index t = 0; t < mesh_.triangles.size(); ++t) {
      const Vector3 normal = unit_normal(corners(t));
      for (const Index v : mesh_.triangles[t]) {
        if (!(dot(normal, normals[v]) > least_flat * length(normals[v]))) bent[v] = 1;
      }
    }
    wrong_.assign(mesh_.triangles.size(), proved);
    for (Index t = 0; t < wrong_.size(); ++t) {
      const auto& [a, b, c] = mesh_.triangles[t];
      if (bent[a] == 0 && bent[b] == 0 && bent[c] == 0) continue;
      wrong_[t] = to_halve;
      beside[a] = beside[b] = beside[c] = 1;
    }
    push_off(least_distance(), beside);
    return halve_wrong(first_rounds);
  }
  // By small moves, and by larger ones from there, so that what is tried again begins at few triangles. Where these do not do the small
  // ones stay.
  bool reduce_far() {
    const ClosedMesh whole = mesh_;
    const double width = band_.upper - band_.lower;
    simplify(mesh_, first_move_share * width, {}, {}, run_.threads, monitor_);
    const ClosedMesh near = mesh_;
    if (!ball_ && reduce(second_move_share, {}, nullptr, max_reductions - 1)) return true;
    mesh_ = whole;
    return reduce(first_move_share, {}, &near);
  }
  // Fewer triangles, all of them proved. Where that fails all that is near stays as it is, in the last round of max_reductions
  // everything. False if it fails even so. `first`: the mesh, if it is known, before anything has failed.
  bool reduce(double share, const std::function<bool(const Triangle&)>& accept,
              const ClosedMesh* first = nullptr, int rounds = max_reductions) {
    const double least = accept ? 0 : least_distance();
    ClosedMesh whole = mesh_;
    std::vector<std::uint8_t> kept;
    for (int round = 0; round < rounds; ++round) {
      mesh_ = round == 0 && first != nullptr ? *first : whole;
      const bool last = round + 1 == max_reductions;
      if (last) kept.assign(whole.points.size(), 1);
      if (round > 0 || first == nullptr)
        simplify(mesh_, share * (band_.upper - band_.lower), accept, kept, run_.threads, monitor_);
      push_off(least);
      wrong_.assign(mesh_.triangles.size(), to_halve);
      if (repair(last ? max_rounds : first_rounds)) return true;
      if (last) return false;
      keep_near_wrong(std::ldexp(level(), round), whole, kept);
      if (accept || round > 0) continue;
      // Where collapses are not to blame no number of them helps.
      mesh_ = whole;
      push_off(least, kept);
      wrong_.assign(mesh_.triangles.size(), proved);
      for (Index t = 0; t < wrong_.size(); ++t) {
        for (const Index v : mesh_.triangles[t]) {
          if (kept[v] != 0) wrong_[t] = to_halve;
        }
      }
      if (!halve_wrong(first_rounds)) return false;
      whole = mesh_;
      kept.resize(whole.points.size(), 1);
    }
    return false;
  }
  // Marks the vertices of a mesh that are as near to facets which are not proved.
  void keep_near_wrong(double beyond, const ClosedMesh& whole, std::vector<std::uint8_t>& kept) const {
    std::vector<Box3> boxes;
    for (Index t = 0; t < wrong_.size(); ++t) {
      if (wrong_[t] == proved) continue;
      Box3& box = boxes.emplace_back();
      for (const Point3& p : corners(t)) box.add(p);
      box.lower = box.lower - Vector3{beyond, beyond, beyond};
      box.upper = box.upper + Vector3{beyond, beyond, beyond};
    }
    kept.resize(whole.points.size());
    if (boxes.size() > max_boxes) kept.assign(kept.size(), 1);
    parallel_for(kept.size(), run_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        if (v % 256 == 0) monitor_.checkpoint();
        for (std::size_t i = 0; i < boxes.size() && kept[v] == 0; ++i)
          kept[v] = contains(boxes[i], whole.points[v]);
      }
    });
  }

  // Judges what is not proved, and was not before.
  void judge() {
    std::vector<std::uint8_t> is_new(wrong_.size(), 0);
    parallel_for(wrong_.size(), run_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        if (wrong_[t] == proved) continue;
        monitor_.checkpoint();
        const Triangle facet = corners(static_cast<Index>(t));
        if (in_band_.contains(facet)) {
          wrong_[t] = proved;
          continue;
        }
        const QuadraticFoot foot = nearest_foot(pieces_.set, centre_of(facet));
        is_new[t] = is_in_band(facet, foot, proof) ? 1 : 0;
        wrong_[t] = is_new[t] != 0 ? proved : to_halve;
      }
    });
    for (Index t = 0; t < wrong_.size(); ++t) {
      if (is_new[t] != 0 && in_band_.size() < max_known) in_band_.insert(corners(t));
    }
  }
  // Halves facets until all are in the band: false if these become more and more, or rounds do not do.
  bool halve_wrong(int rounds) {
    const std::size_t most = 2 * mesh_.triangles.size() + facets_beside;
    std::size_t at_first = 0;
    for (int round = 0;; ++round) {
      judge();
      const auto count = static_cast<std::size_t>(std::count(wrong_.begin(), wrong_.end(), to_halve));
      if (count == 0) return true;
      if (round < 3) at_first = std::max(at_first, count);
      if (round == rounds || mesh_.triangles.size() > most || count > 4 * at_first) return false;
      const auto facets = static_cast<double>(mesh_.triangles.size());
      if (rounds == first_rounds && round == 0 && static_cast<double>(count) > max_wrong_share * facets)
        return false;
      steer(halve_longest_sides(mesh_, wrong_));
    }
  }
  // The same, until none touches another, too.
  bool repair(int rounds) {
    for (int round = 0; halve_wrong(rounds); ++round) {
      const auto pairs = self_contacts(mesh_.points, mesh_.triangles, max_contacts, run_.threads, monitor_);
      if (pairs.empty()) return true;
      for (const TrianglePair& pair : pairs) wrong_[pair.a] = wrong_[pair.b] = to_halve;
      if (rounds == first_rounds || round == rounds) return false;
      steer(halve_longest_sides(mesh_, wrong_));
    }
    return false;
  }

  // With `proof`: all points of the facet are at least band.lower and at most band.upper from the surfaces.
  [[nodiscard]] bool is_in_band(const Triangle& corners, const QuadraticFoot& foot, Effort effort) const {
    QuadraticTriangle facet = flat_quadratic(corners);
    facet.error = band_.lower;
    if (may_meet(pieces_.set, facet, (band_.upper - band_.lower) / 32)) return false;
    return is_near(corners, foot, effort);
  }
  // All points of a triangle are no farther from a point of the surfaces than its corners. Halves it where that is too far. `foot`:
  // of its centre.
  [[nodiscard]] bool is_near(const Triangle& t, const QuadraticFoot& foot, Effort effort) const {
    if (effort.bridges && foot.distance > bridged_from() && is_bridge(t)) return true;
    if (foot.distance > band_.upper) return false;
    if (farthest(t, foot) <= band_.upper || farthest_from(pieces_.set, foot, t, band_.upper) <= band_.upper)
      return true;
    if (effort.halvings == 0) return effort.if_open;
    const std::size_t k = longest_side(t);
    const Point3 middle = t[k] + 0.5 * (t[(k + 1) % 3] - t[k]);
    for (const std::size_t moved : {k, (k + 1) % 3}) {
      Triangle half = t;
      half[moved] = middle;
      if (!is_near(half, nearest_foot(pieces_.set, centre_of(half), foot),
                   {effort.halvings - 1, effort.if_open, effort.bridges}))
        return false;
    }
    return true;
  }
  // At least how far the points of a triangle are from a point of the surfaces near that foot.
  [[nodiscard]] double farthest(const Triangle& t, const QuadraticFoot& foot) const {
    double far = 0;
    for (const Point3& p : t) far = std::max(far, distance(p, foot.point));
    return enlarged(far + pieces_.set.error(foot.piece)) + distance_rounding;
  }
  // The same of points in parts of it: about the least such bound.
  [[nodiscard]] double bridge_distance(const Triangle& t, const QuadraticFoot& foot, int halvings) const {
    const double far = farthest(t, foot);
    if (halvings == 0 || far <= foot.distance + bridge_share * (band_.upper - band_.lower)) return far;
    const std::size_t k = longest_side(t);
    const Point3 middle = t[k] + 0.5 * (t[(k + 1) % 3] - t[k]);
    double most = 0;
    for (const std::size_t moved : {k, (k + 1) % 3}) {
      Triangle half = t;
      half[moved] = middle;
      const QuadraticFoot near = nearest_foot(pieces_.set, centre_of(half), foot);
      most = std::max(most, bridge_distance(half, near, halvings - 1));
    }
    return most;
  }
  // Beyond this facets may be bridges: less than the error, so that those between are one or the other.
  [[nodiscard]] double bridged_from() const {
    return ball_ ? band_.upper - overlap_share * (band_.upper - band_.lower) : INFINITY;
  }
  // Where a ball with the gap's diameter does not get to, so that no error is asked for. No proof rests on it.
  [[nodiscard]] bool is_filled(const Point3& p) const {
    return ball_ && nearest_foot(ball_->facets, p).distance >= radius_ - bridged_from();
  }
  [[nodiscard]] bool is_bridge(const Triangle& t) const {
    return is_filled(centre_of(t)) && std::all_of(t.begin(), t.end(), [&](const Point3& p) {
             return is_filled(p) || nearest_foot(pieces_.set, p).distance <= band_.upper;
           });
  }
  // A look at what a collapse would make. Meshes whose facets all face away hardly touch themselves.
  [[nodiscard]] bool looks_right(const Triangle& t) {
    const Point3 centre = centre_of(t);
    const Vector3 normal = unit_normal(t);
    const QuadraticFoot foot = nearest_foot(pieces_.set, centre);
    if (!(foot.distance > band_.lower)) return false;
    if (!(foot.distance < band_.upper && dot(normal, centre - foot.point) > least_facing * foot.distance)) {
      // Towards the ball, then.
      if (!is_filled(centre)) return false;
      const QuadraticFoot to = nearest_foot(ball_->facets, centre);
      if (!(dot(normal, to.point - centre) > least_facing * to.distance)) return false;
    }
    return std::all_of(t.begin(), t.end(),
                       [&](const Point3& p) {
                         return looks_.ask(std::span(&p, 1), [&] {
                           return nearest_foot(pieces_.set, p, foot).distance < band_.upper || is_filled(p);
                         });
                       }) &&
           is_in_band(t, foot, look);
  }

  Envelope written() {
    Envelope result;
    result.error = *options_.error;
    result.clearance = *options_.clearance;
    for (const Point3& p : mesh_.points) result.positions.push_back(require_representable(in_mesh_units(p)));
    result.triangles = std::move(mesh_.triangles);
    return result;
  }
  Envelope without(HullFault fault, const Point3& place) {
    mesh_ = {};
    Envelope result = written();
    result.outcome = outcome_of(false, fault == HullFault::too_few_triangles);
    result.problems.push_back({fault, false, in_mesh_units(place)});
    return result;
  }
  // Are all components inside? None meets the mesh, so a point of each tells.
  Envelope finished() {
    if (mesh_.triangles.empty() || !is_manifold(mesh_))
      return without(HullFault::meets_itself, pieces_.members[0]);
    Envelope result = written();
    for (Index t = 0; ball_ && t < result.triangles.size(); ++t) {
      const auto& [a, b, c] = result.triangles[t];
      const Triangle facet{mesh_.points[a], mesh_.points[b], mesh_.points[c]};
      const QuadraticFoot foot = nearest_foot(pieces_.set, centre_of(facet));
      if (is_near(facet, foot, proof_of_error)) continue;
      result.bridges.push_back(t);
      const double most = bridge_distance(facet, foot, proof_of_error.halvings);
      result.bridge_distance =
          std::max(result.bridge_distance, enlarged(pieces_.scale.inverse().apply(most)));
    }
    ControlMesh mesh;
    mesh.points = result.positions;
    for (const auto& [a, b, c] : result.triangles)
      mesh.add_face(std::array{VertexId(a), VertexId(b), VertexId(c)});
    const Run quiet{.threads = run_.threads, .monitor = &monitor_};
    const Surface facets(std::move(mesh), {.scheme = Scheme::flat}, quiet);
    std::vector<Point3> members;
    members.reserve(pieces_.members.size());
    for (const Point3& p : pieces_.members) members.push_back(in_mesh_units(p));
    const std::vector<std::optional<bool>> inside = snug::contains(facets, members, quiet);
    for (std::size_t i = 0; i < inside.size() && result.problems.size() < max_problems; ++i) {
      if (inside[i] != true) result.problems.push_back({HullFault::not_around, false, members[i]});
    }
    if (const Measures measures = measure(facets, {}, quiet); measures.volume)
      result.volume = *measures.volume;
    result.outcome = outcome_of(result.problems.empty(), false);
    monitor_of(run_).report(1);
    return result;
  }

  const PlacedPieces& pieces_;
  const EnvelopeOptions& options_;
  const Run& run_;
  WorkMonitor monitor_;
  Interval band_;  // of distances, in the units of the pieces
  std::optional<RollingBall> ball_;
  double radius_ = 0;  // of that
  ClosedMesh mesh_;
  LookTable looks_;
  std::unordered_set<Triangle, TriangleHash> in_band_;  // proved to be
  std::vector<std::uint8_t> wrong_;                     // a State for each triangle
};

}  // namespace

Envelope envelope(std::span<const PlacedSurface> parts, const EnvelopeOptions& wanted, const Run& run) {
  require_value(!parts.empty(), "envelope: give at least one surface");
  const Box3 box = box_around(parts);
  const double size = longest_side(box);
  EnvelopeOptions options = wanted;
  if (!options.error) options.error = 1e-2 * size;
  require_value(*options.error > 0 && std::isfinite(*options.error),
                "envelope: the error must be finite and greater than 0");
  if (!options.clearance) options.clearance = *options.error / 4;
  require_length(*options.clearance, "envelope: the clearance");
  require_value(*options.clearance < *options.error, "envelope: the clearance must be less than the error");
  if (*options.error > size / 2) {
    throw InputError(
        InputProblem::value,
        "envelope: the error is more than half of the surfaces' size; give at most " + shortest(size / 2));
  }
  if (options.gap) {
    require_length(*options.gap, "envelope: the gap");
    if (*options.gap < 2 * *options.error || *options.gap > size / 4) {
      throw InputError(InputProblem::value,
                       "envelope: the gap must be at least twice the error, " + shortest(2 * *options.error) +
                           ", and at most a quarter of the surfaces' size, " + shortest(size / 4));
    }
  }
  double largest = 0;
  for (const Point3& p : {box.lower, box.upper}) largest = std::max(largest, max_abs(p - Point3{}));
  // Below 1, with room for the envelope.
  const PowerOfTwo scale = PowerOfTwo::normalising(largest) * PowerOfTwo(-1);
  const double width = *options.error - *options.clearance;
  const double least = scale.inverse().apply(options.single_precision ? 0x1p-18 : 0x1p-28);
  if (width < least) {
    throw InputError(InputProblem::value,
                     std::string("envelope: ") + (options.single_precision ? "floats" : "doubles") +
                         " allow no difference of error and clearance below " + shortest(least) +
                         " for coordinates of this size; ask for that or more" +
                         (options.single_precision ? ", or write a format that holds doubles" : ""));
  }
  const double error = piece_error_share * scale.apply(width);
  const std::uint64_t cubes = run.max_splits.value_or(default_splits::envelope);
  const std::optional<PlacedPieces> pieces =
      placed_pieces(parts, scale, error, std::max(least_pieces, cubes / 4), run);
  if (!pieces) {
    Envelope none;
    none.error = *options.error;
    none.clearance = *options.clearance;
    none.outcome = Outcome::budget_spent;
    none.problems.push_back({HullFault::too_few_triangles, false, box.lower});
    return none;
  }
  // The errors of pieces are below the least distance: then their points are on the side of the surfaces' own.
  const Interval band{std::max(enlarged(scale.apply(*options.clearance)) + 4 * distance_rounding, 4 * error),
                      scale.apply(*options.error) * (1 - 4 * unit_roundoff)};
  return EnvelopeMaker(*pieces, band, options, run).run();
}

Envelope envelope(const PlacedSurface& part, const EnvelopeOptions& options, const Run& run) {
  return envelope(std::span(&part, 1), options, run);
}

}  // namespace snug
