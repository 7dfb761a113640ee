// Deviations: of polyhedra, whose limit surface is made of their triangles, against intervals in extended
// precision; of curved surfaces of every scheme against points of them and of candidates.
//
//   SNUG_PLACEMENTS=20000 build/release/bin/tests/sound_test --gtest_filter='deviation.*'
//
// asks about so many pairs; SNUG_FIRST=N begins with pair N.

#include <snug/distance.h>

#include <gtest/gtest.h>
#include <oracle/hausdorff_twin.h>
#include <oracle/limit_twin.h>
#include <oracle/polygon_twin.h>
#include <oracle/winding_twin.h>
#include <snug/evaluate.h>
#include <snug/tessellate.h>
#include <support/error.h>
#include <testing/candidates.h>
#include <testing/solid_cases.h>
#include <testing/tagged.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace snug::deviation_test {
namespace {

using oracle::HausdorffBounds;
using oracle::Side;
using testing::CandidateKind;
using testing::number_of;
using testing::TriangleSet;

constexpr std::array precisions{1e-2, 1e-3, 1e-4, 1e-5};

// Enough for nearly all, and an end of the others.
constexpr std::uint64_t budget = 50'000;
const Run one_thread{.threads = 1, .max_splits = budget}, three_threads{.threads = 3, .max_splits = budget};
constexpr std::uint64_t usual_trials = 250, usual_curved = 480;

/// Scales to the ends of the doubles, and far away.
struct Disguise {
  const char* name;
  double scale, offset;  // the latter in units, before scaling
};
constexpr std::array disguises{Disguise{"plain", 1, 0},     Disguise{"1e-300", 1e-300, 0},
                               Disguise{"1e296", 1e296, 0}, Disguise{"2^-900", 0x1p-900, 0},
                               Disguise{"far", 1, 3e4},     Disguise{"tiny and far", 1e-200, 3e4}};

oracle::Point disguised(const Disguise& d, const oracle::Point& p) {
  return {d.scale * (p[0] + d.offset), d.scale * (p[1] - d.offset / 3), d.scale * p[2]};
}

// Do two intervals that contain the same number have one in common? `slack` is what the sets themselves are
// off.
bool agree(const Interval& found, const HausdorffBounds& truth, long double slack) {
  return found.lower <= truth.upper + slack && truth.lower <= found.upper + slack &&
         found.lower <= found.upper && found.lower >= 0;
}

std::string text_of(const Interval& found, const HausdorffBounds& truth) {
  std::ostringstream text;
  text.precision(17);
  text << ": [" << found.lower << ", " << found.upper << "] and the twin's [" << truth.lower << ", "
       << truth.upper << "]";
  return text.str();
}

// The farthest point lies in its set up to its error, and is as far away as the lower end tells.
void expect_farthest_point(const OneSidedDistance& found, const TriangleSet& of, const TriangleSet& from,
                           long double slack, const std::string& name) {
  const oracle::Point p{found.from.point.x, found.from.point.y, found.from.point.z};
  const long double off = std::sqrt(3.0L) * found.from.error + slack;
  EXPECT_LE(oracle::distance_to_triangles(p, of).lower, off) << name;
  EXPECT_GE(oracle::distance_to_triangles(p, from).upper, found.distance.lower - off) << name;
}

bool same(const OneSidedDistance& a, const OneSidedDistance& b) {
  return a.distance == b.distance && a.from == b.from && a.to == b.to;
}

bool same(const Deviation& a, const Deviation& b) {
  const auto both = [](const std::optional<OneSidedDistance>& x, const std::optional<OneSidedDistance>& y) {
    return x.has_value() == y.has_value() && (!x || same(*x, *y));
  };
  return same(a.from_surface, b.from_surface) && same(a.from_candidate, b.from_candidate) &&
         both(a.inside, b.inside) && both(a.outside, b.outside) && a.outcome == b.outcome;
}

// -- Polyhedra ------------------------------------------------------------------------------------------

/// Polyhedra that some scheme has as its limit surface, with whole-numbered corners before the disguise.
enum class Kind { flat_solid, loop_solid, catmark_solid, bilinear_solid, sheet, soup, boxes, thin, single };
constexpr std::array kind_names{"flat solid", "loop solid", "catmark solid", "bilinear solid", "sheet",
                                "soup",       "boxes",      "thin",          "single triangle"};

struct Polyhedron {
  oracle::TaggedMesh mesh;
  Scheme scheme = Scheme::flat;
  bool closed = false;
  bool planar_quads = false;
};

void round_points(oracle::TaggedMesh& mesh, double scale) {
  for (oracle::Point& p : mesh.points)
    for (double& x : p) x = std::round(scale * x);
}

// Every edge and vertex infinitely sharp.
void sharpen_all(oracle::TaggedMesh& mesh) {
  for (const auto& polygon : mesh.polygons) {
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      mesh.creases.push_back({polygon[k], polygon[(k + 1) % polygon.size()], oracle::kInfinitelySharp});
      mesh.corners.push_back({polygon[k], oracle::kInfinitelySharp});
    }
  }
}

oracle::TaggedMesh box(const std::array<int, 3>& low, const std::array<int, 3>& sides) {
  oracle::TaggedMesh mesh = oracle::meshes::cube();
  for (oracle::Point& p : mesh.points)
    for (std::size_t x = 0; x < 3; ++x) p[x] = low[x] + p[x] * sides[x];
  return mesh;
}

Polyhedron make_polyhedron(Kind kind, std::mt19937_64& random) {
  Polyhedron made;
  const auto whole = [&](int low, int high) {
    return low + static_cast<int>(random() % static_cast<std::uint64_t>(high - low + 1));
  };
  const auto add = [&](const oracle::Point& a, const oracle::Point& b, const oracle::Point& c) {
    const auto first = static_cast<std::uint32_t>(made.mesh.points.size());
    made.mesh.points.insert(made.mesh.points.end(), {a, b, c});
    made.mesh.polygons.push_back({first, first + 1, first + 2});
  };
  const auto point = [&](int most) {
    return oracle::Point{double(whole(-most, most)), double(whole(-most, most)), double(whole(-most, most))};
  };
  switch (kind) {
    case Kind::flat_solid:
    case Kind::loop_solid:
    case Kind::catmark_solid:
    case Kind::bilinear_solid:
      made.mesh = oracle::meshes::triangulated(testing::random_solid(random));
      round_points(made.mesh, 8);
      made.closed = true;
      made.scheme = kind == Kind::flat_solid      ? Scheme::flat
                    : kind == Kind::loop_solid    ? Scheme::loop
                    : kind == Kind::catmark_solid ? Scheme::catmark
                                                  : Scheme::bilinear;
      break;
    case Kind::sheet:
      made.mesh = oracle::meshes::triangulated(oracle::meshes::quad_grid(3, 2));
      for (oracle::Point& p : made.mesh.points) p = {8 * p[0], 8 * p[1], double(whole(-4, 4))};
      made.scheme = random() % 2 == 0 ? Scheme::loop : Scheme::flat;
      break;
    case Kind::soup:
      for (int k = whole(2, 10); k > 0; --k) add(point(20), point(20), point(20));
      break;
    case Kind::boxes: {
      const auto some = [&] {
        return box({whole(-12, 4), whole(-12, 4), whole(-12, 4)}, {whole(1, 16), whole(1, 16), whole(1, 16)});
      };
      made.mesh = some();
      const oracle::TaggedMesh other = some();
      for (auto face : other.polygons) {
        for (std::uint32_t& v : face) v += 8;
        made.mesh.polygons.push_back(face);
      }
      made.mesh.points.insert(made.mesh.points.end(), other.points.begin(), other.points.end());
      made.scheme = random() % 2 == 0 ? Scheme::catmark : Scheme::bilinear;
      made.closed = made.planar_quads = true;
      break;
    }
    case Kind::thin:
      for (int k = whole(1, 5); k > 0; --k) {
        const oracle::Point a = point(20), b = point(20);
        add(a, b, {b[0] + 0x1p-20, b[1], b[2] - 0x1p-18});
      }
      // Without area, and a point.
      add({1, 2, 3}, {3, 6, 9}, {2, 4, 6});
      add({5, 5, 5}, {5, 5, 5}, {5, 5, 5});
      break;
    case Kind::single:
      add(point(16), point(16), point(16));
      break;
  }
  if (made.scheme == Scheme::loop || made.scheme == Scheme::catmark) sharpen_all(made.mesh);
  return made;
}

struct Trial {
  Polyhedron polyhedron;
  TriangleSet surface, candidate;  // disguised
  double size = 0;                 // of the surface
  bool coincident = false;         // candidate and surface may have triangles in one plane
  std::string name;
};

Trial make_trial(Kind kind, CandidateKind candidate, const Disguise& disguise, std::mt19937_64& random) {
  Trial trial;
  trial.polyhedron = make_polyhedron(kind, random);
  oracle::TaggedMesh& mesh = trial.polyhedron.mesh;
  trial.candidate = testing::make_candidate(candidate, testing::triangles_of(mesh), 32, random);
  if (random() % 8 == 0) {
    for (auto& t : testing::make_candidate(CandidateKind::soup, trial.candidate, 32, random))
      trial.candidate.push_back(t);
  }
  for (oracle::Point& p : mesh.points) p = disguised(disguise, p);
  testing::change_points(trial.candidate, [&](const oracle::Point& p) { return disguised(disguise, p); });
  trial.surface = testing::triangles_of(mesh);
  trial.size = testing::size_of(trial.surface);
  trial.coincident = candidate != CandidateKind::soup && candidate != CandidateKind::points &&
                     candidate != CandidateKind::one && candidate != CandidateKind::needles &&
                     candidate != CandidateKind::far && candidate != CandidateKind::other_size;
  return trial;
}

double largest(const TriangleSet& set) {
  double most = 0;
  for (const oracle::Corners& t : set)
    for (const oracle::Point& p : t)
      for (const double x : p) most = std::max(most, std::fabs(x));
  return most;
}

struct Counts {
  std::size_t asked = 0, solids = 0, spent = 0, decided = 0, undecided = 0;
  std::array<std::size_t, 2> unreached{};  // beside candidates without and with triangles in the surface
};

// With a tolerance about as large as the distance every answer is right.
void expect_decided(const Surface& surface, const Trial& trial, const HausdorffBounds& there,
                    const HausdorffBounds& back, double factor, Counts& counts) {
  DeviationOptions options;
  options.threshold = static_cast<double>(factor * std::max(there.upper, back.upper));
  options.absolute = std::max(1e-4 * trial.size, 0x1p-36 * largest(trial.candidate));
  const Deviation found = deviation(surface, testing::candidate_of(trial.candidate), options, one_thread);
  EXPECT_TRUE(agree(found.from_surface.distance, there, 0))
      << trial.name << text_of(found.from_surface.distance, there);
  EXPECT_TRUE(agree(found.from_candidate.distance, back, 0))
      << trial.name << text_of(found.from_candidate.distance, back);
  bool decided = true;
  for (const Interval& d : {found.from_surface.distance, found.from_candidate.distance}) {
    const bool own = d.lower > *options.threshold || d.upper <= *options.threshold;
    const bool narrow = d.upper - d.lower <= *options.absolute;
    EXPECT_TRUE(own || narrow || found.outcome != Outcome::complete) << trial.name;
    decided = decided && (own || narrow);
  }
  ++(decided ? counts.decided : counts.undecided);
}

void check(const Surface& surface, const Trial& trial, double precision, std::mt19937_64& random,
           Counts& counts) {
  const std::vector<Triangle> candidate = testing::candidate_of(trial.candidate);
  DeviationOptions options;
  options.absolute = precision;
  options.solid = trial.polyhedron.closed && random() % 2 == 0;
  const Deviation found = deviation(surface, candidate, options, one_thread);
  // Planar quads are no longer planar once they are rounded.
  const long double extent =
      trial.size + largest(trial.surface) + static_cast<long double>(largest(trial.candidate));
  const long double slack = trial.polyhedron.planar_quads ? extent * 0x1p-48L : 0;
  const oracle::HausdorffGoal goal{precision / 4.0L, Side::any, 3000};
  const HausdorffBounds there = oracle::one_sided_hausdorff(trial.surface, trial.candidate, goal),
                        back = oracle::one_sided_hausdorff(trial.candidate, trial.surface, goal);
  EXPECT_TRUE(agree(found.from_surface.distance, there, slack))
      << trial.name << text_of(found.from_surface.distance, there);
  EXPECT_TRUE(agree(found.from_candidate.distance, back, slack))
      << trial.name << text_of(found.from_candidate.distance, back);
  expect_farthest_point(found.from_surface, trial.surface, trial.candidate, slack + extent * 0x1p-50L,
                        trial.name);
  expect_farthest_point(found.from_candidate, trial.candidate, trial.surface, slack + extent * 0x1p-50L,
                        trial.name);
  EXPECT_TRUE(found.from_surface.from.at.has_value()) << trial.name;
  EXPECT_FALSE(found.from_candidate.from.at.has_value()) << trial.name;
  std::vector<Interval> intervals{found.from_surface.distance, found.from_candidate.distance};
  EXPECT_EQ(found.inside.has_value(), options.solid);
  EXPECT_EQ(found.outside.has_value(), options.solid);
  if (options.solid) {
    ++counts.solids;
    const HausdorffBounds inside =
        oracle::one_sided_hausdorff(trial.candidate, trial.surface, {goal.precision, Side::inside, 3000});
    const HausdorffBounds outside =
        oracle::one_sided_hausdorff(trial.candidate, trial.surface, {goal.precision, Side::outside, 3000});
    EXPECT_TRUE(agree(found.inside->distance, inside, slack))
        << trial.name << ", inside" << text_of(found.inside->distance, inside);
    EXPECT_TRUE(agree(found.outside->distance, outside, slack))
        << trial.name << ", outside" << text_of(found.outside->distance, outside);
    intervals.insert(intervals.end(), {found.inside->distance, found.outside->distance});
  }
  bool narrow = true;
  for (const Interval& d : intervals) narrow = narrow && d.upper - d.lower <= precision;
  EXPECT_EQ(found.outcome == Outcome::complete, narrow) << trial.name;
  ++counts.asked;
  counts.unreached[trial.coincident] += found.outcome != Outcome::complete;
  counts.spent += there.spent || back.spent;
  if (counts.asked % 8 == 0) {
    EXPECT_TRUE(same(found, deviation(surface, candidate, options, three_threads))) << trial.name;
  }
  if (counts.asked % 4 == 1 && slack == 0) {
    constexpr std::array factors{0.5, 0.99, 1.01, 2.0};
    expect_decided(surface, trial, there, back, factors[random() % 4], counts);
  }
}

TEST(deviation, of_polyhedra_contains_that_of_the_twin) {
  const std::uint64_t trials = number_of("SNUG_PLACEMENTS", usual_trials), first = number_of("SNUG_FIRST", 0);
  Counts counts;
  testing::PairsDrawn pairs(
      {kind_names.size(), testing::candidate_names.size(), precisions.size(), disguises.size()});
  for (std::uint64_t i = first; i < first + trials && !HasFailure(); ++i) {
    std::mt19937_64 random(i * 6271 + 11);
    const std::size_t kind = i % kind_names.size(),
                      other = i / kind_names.size() % testing::candidate_names.size(),
                      round = i / (kind_names.size() * testing::candidate_names.size());
    // All pairs by turns, then any.
    const bool turns = i < usual_trials;
    const std::size_t precision = (turns ? kind + other : random()) % precisions.size(),
                      disguise = (turns ? kind + other + round : random()) % disguises.size();
    Trial trial =
        make_trial(static_cast<Kind>(kind), static_cast<CandidateKind>(other), disguises[disguise], random);
    trial.name = "pair " + std::to_string(i) + ", " + kind_names[kind] + ", " +
                 testing::candidate_names[other] + ", " + disguises[disguise].name;
    std::optional<Surface> surface;
    try {
      surface.emplace(testing::control_mesh(trial.polyhedron.mesh),
                      SurfaceOptions{.scheme = trial.polyhedron.scheme});
    } catch (const InputError&) {
      continue;  // the same triangle twice
    }
    try {
      // No finer than doubles of such coordinates allow.
      const double wanted = std::max(precisions[precision] * trial.size, 0x1p-36 * largest(trial.candidate));
      check(*surface, trial, wanted, random, counts);
    } catch (const InputError& error) {
      // Four triangles at an edge, or a side that winds both ways.
      EXPECT_TRUE(trial.polyhedron.closed && error.problem() == InputProblem::refused)
          << trial.name << error.what();
      continue;
    }
    pairs.add({kind, other, precision, disguise});
  }
  std::cout << "  " << counts.asked << " pairs, " << counts.solids << " of them with solids; "
            << counts.unreached[1] << " not as narrow as asked beside triangles in one plane, "
            << counts.unreached[0] << " beside others, the twin not in " << counts.spent << "; "
            << counts.decided << " questions decided, " << counts.undecided << " not; " << pairs.missing()
            << " pairs of choices not drawn\n";
  EXPECT_GT(10 * counts.asked, 9 * trials);
  EXPECT_LE(50 * counts.unreached[0], counts.asked + 50);
  EXPECT_LE(10 * (counts.unreached[1] + counts.undecided), counts.asked);
  EXPECT_TRUE(trials < usual_trials || pairs.missing() == 0);
}

// -- Curved surfaces ------------------------------------------------------------------------------------

/// How a surface ends, and what is sharp in it.
enum class Border { closed, edge_and_corner, edge_only, none };
enum class Creases { none, sharp, semi_sharp, both };
constexpr std::size_t border_count = 4, crease_count = 4;

/// A surface of any scheme with the twin that knows its limit.
struct Curved {
  std::string name;
  oracle::TaggedMesh mesh;
  oracle::WindingScheme scheme;
  SurfaceOptions options;
};

template <class Kind>
std::size_t index_of(Kind kind) {
  return static_cast<std::size_t>(kind);
}

Border border_of(const Curved& c) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> faces;
  for (const auto& polygon : c.mesh.polygons) {
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const std::uint32_t a = polygon[k], b = polygon[(k + 1) % polygon.size()];
      ++faces[std::minmax(a, b)];
    }
  }
  if (std::none_of(faces.begin(), faces.end(), [](const auto& edge) { return edge.second == 1; }))
    return Border::closed;
  switch (c.options.boundary.value_or(BoundaryRule::edge_and_corner)) {
    case BoundaryRule::edge_only:
      return Border::edge_only;
    case BoundaryRule::none:
      return Border::none;
    default:
      return Border::edge_and_corner;
  }
}

Creases creases_of(const Curved& c) {
  bool sharp = false, semi_sharp = false;
  const auto add = [&](double sharpness) {
    (sharpness >= oracle::kInfinitelySharp ? sharp : semi_sharp) = true;
  };
  for (const auto& crease : c.mesh.creases) add(crease.sharpness);
  for (const auto& corner : c.mesh.corners) add(corner.sharpness);
  if (sharp) return semi_sharp ? Creases::both : Creases::sharp;
  return semi_sharp ? Creases::semi_sharp : Creases::none;
}

ControlMesh control_mesh(const Curved& c) {
  const oracle::Rules* const rules = std::get_if<oracle::Rules>(&c.scheme);
  return testing::control_mesh(c.mesh, rules ? *rules : oracle::Rules{});
}

std::vector<Curved> curved_surfaces(std::uint64_t seed) {
  namespace meshes = oracle::meshes;
  std::vector<Curved> list;
  for (const auto scheme : {oracle::PrimalScheme::catmull_clark, oracle::PrimalScheme::loop}) {
    for (const testing::TaggedCase& c : testing::tagged_cases(scheme, seed)) {
      const SchemeOptions rules = testing::options_of(c.rules);
      list.push_back({c.name + ", " + testing::text_of(c.rules),
                      c.mesh,
                      c.rules,
                      {.scheme = rules.scheme, .boundary = rules.boundary}});
    }
  }
  std::mt19937_64 random(seed);
  // A hexagon around a corner inwards, and a grid that is pulled across itself: plane surfaces that come back to where they were. A cube.
  oracle::TaggedMesh hexagon, pulled = meshes::quad_grid(3, 3);
  hexagon.points = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {1, 1, 0}, {0, 1, 0}};
  hexagon.polygons = {{0, 1, 2, 3, 4, 5}};
  std::swap(pulled.points[5], pulled.points[6]);
  for (const oracle::TaggedMesh& plain : {hexagon, pulled, meshes::cube()}) {
    for (const auto& [first, second] : {std::pair{0.0, 0.0}, {10.0, 10.0}, {1.5, 1.5}, {10.0, 1.5}}) {
      for (const auto boundary :
           {oracle::Boundary::edge_and_corner, oracle::Boundary::edge_only, oracle::Boundary::none}) {
        for (const auto scheme : {oracle::PrimalScheme::catmull_clark, oracle::PrimalScheme::loop}) {
          oracle::TaggedMesh mesh =
              scheme == oracle::PrimalScheme::loop ? meshes::triangulated(plain) : plain;
          if (first > 0) mesh.creases = {{4, 5, first}, {0, 1, second}};
          oracle::Rules rules;
          rules.scheme = scheme;
          rules.boundary = boundary;
          const SchemeOptions own = testing::options_of(rules);
          list.push_back({"comes back, " + testing::text_of(rules) + ", creases " + std::to_string(first) +
                              ", " + std::to_string(second),
                          mesh,
                          rules,
                          {.scheme = own.scheme, .boundary = own.boundary}});
        }
      }
    }
  }
  for (const auto dual : {oracle::DualScheme::doo_sabin, oracle::DualScheme::midedge}) {
    const Scheme scheme = dual == oracle::DualScheme::doo_sabin ? Scheme::doo_sabin : Scheme::midedge;
    for (const auto& [name, plain] : std::vector<std::pair<std::string, oracle::TaggedMesh>>{
             {"cube", meshes::cube()},
             {"grid", meshes::quad_grid(5, 4)},
             {"prism 5", meshes::prism(5)},
             {"pyramid 7", meshes::pyramid(7)},
             {"triangles", meshes::triangulated(meshes::quad_grid(4, 4))}}) {
      list.push_back(
          {name + ", " + name_of(scheme), meshes::shaken(plain, 0.3, random), dual, {.scheme = scheme}});
    }
  }
  return list;
}

/// Of which sort a surface is, for the pairs: Catmull-Clark, Loop, Doo-Sabin, Midedge.
std::size_t sort_of(const Curved& c) {
  switch (*c.options.scheme) {
    case Scheme::loop:
      return 1;
    case Scheme::doo_sabin:
      return 2;
    case Scheme::midedge:
      return 3;
    default:
      return 0;
  }
}

struct LimitSample {
  oracle::Point position;
  double error;
};

std::vector<LimitSample> samples_of(const Curved& c, int levels = 2) {
  std::vector<LimitSample> list;
  if (const oracle::Rules* const rules = std::get_if<oracle::Rules>(&c.scheme)) {
    for (const auto& s : oracle::sample_faces(c.mesh, *rules, levels)) list.push_back({s.position, s.error});
  } else {
    for (const auto& s : oracle::sample_dual(c.mesh, std::get<oracle::DualScheme>(c.scheme), levels + 1))
      list.push_back({s.position, s.error});
  }
  return list;
}

std::shared_ptr<oracle::LimitRules> limit_rules(const Curved& c) {
  if (const oracle::Rules* const rules = std::get_if<oracle::Rules>(&c.scheme))
    return std::make_shared<oracle::LimitRules>(*rules);
  return std::make_shared<oracle::LimitRules>(std::get<oracle::DualScheme>(c.scheme));
}

/// Bounds of distances from a limit surface.
class LimitDistance {
 public:
  explicit LimitDistance(const Curved& c) : twin_(c.mesh, limit_rules(c)) {}
  oracle::ContactBounds operator()(const oracle::Point& p, double precision) {
    return twin_.distance_to(oracle::kUnmoved, p, {.precision = {precision, 1e-4}});
  }

 private:
  oracle::LimitTwin twin_;
};

/// Triangles beside a curved surface: those of its tessellation, and what may happen to them.
enum class Beside {
  tessellation,
  moved,
  spoiled,
  holes,
  trimmed,
  shrunk,
  overlays,
  slivers,
  fine,
  cage,
  flipped,
  soup,
  points,
  far,
  surface
};
constexpr std::array beside_names{"tessellation",   "moved",        "a corner moved", "a triangle dropped",
                                  "trimmed",        "shrunk",       "overlays",       "slivers",
                                  "fine triangles", "control mesh", "flipped",        "soup",
                                  "points",         "far",          "another surface"};

std::optional<TriangleSet> make_beside(Beside kind, const Curved& c, const Surface& surface,
                                       std::mt19937_64& random) {
  const auto level = 1 + static_cast<unsigned>(random() % 2);
  TriangleSet set = testing::triangles_of(
      kind == Beside::cage ? surface.mesh()
                           : subdivided(surface.mesh(), level, true,
                                        {.scheme = surface.scheme(), .boundary = surface.boundary()}));
  if (set.empty()) return std::nullopt;
  const auto make = [&](CandidateKind other) { return testing::make_candidate(other, set, 1, random); };
  switch (kind) {
    case Beside::moved:
      return make(CandidateKind::moved);
    case Beside::spoiled:
      return make(CandidateKind::spoiled);
    case Beside::holes:
      set.erase(set.begin() + static_cast<std::ptrdiff_t>(random() % set.size()));
      if (set.empty()) return std::nullopt;
      return set;
    case Beside::trimmed:
      set.resize((set.size() + 1) / 2);
      return set;
    case Beside::shrunk: {
      const oracle::Point to = set[0][0];
      testing::change_points(set, [&](const oracle::Point& p) {
        return oracle::Point{to[0] + 0.98 * (p[0] - to[0]), to[1] + 0.98 * (p[1] - to[1]),
                             to[2] + 0.98 * (p[2] - to[2])};
      });
      return set;
    }
    case Beside::overlays:
      return make(CandidateKind::overlays);
    case Beside::slivers:
      return make(CandidateKind::slivers);
    case Beside::fine: {
      const Tessellation fine = tessellate(surface, {.error = 1e-2 * surface.size()});
      set.clear();
      for (const auto& t : fine.triangles) {
        oracle::Corners& corners = set.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
          const Point3& p = fine.positions[t[k]];
          corners[k] = {p.x, p.y, p.z};
        }
      }
      return set;
    }
    case Beside::flipped:
      return make(CandidateKind::flipped);
    case Beside::soup:
      return make(CandidateKind::soup);
    case Beside::points:
      return make(CandidateKind::points);
    case Beside::far:
      return make(CandidateKind::far);
    default:
      static_cast<void>(c);
      return set;
  }
}

// As it is asked about: `size` up or down by a power of two, which changes no digit.
constexpr std::array powers{0, -900, 900};

ControlMesh scaled(ControlMesh mesh, int power) {
  for (Point3& p : mesh.points)
    for (std::size_t x = 0; x < 3; ++x) p[x] = std::ldexp(p[x], power);
  return mesh;
}

OneSidedDistance unscaled(OneSidedDistance found, int power) {
  const auto down = [&](Point3& p) {
    for (std::size_t x = 0; x < 3; ++x) p[x] = std::ldexp(p[x], -power);
  };
  found.distance = {std::ldexp(found.distance.lower, -power), std::ldexp(found.distance.upper, -power)};
  found.from.error = std::ldexp(found.from.error, -power);
  down(found.from.point);
  down(found.to);
  return found;
}

struct CurvedCounts {
  std::size_t asked = 0, unreached = 0, samples = 0, inside = 0, outside = 0;
  double share = 0;  // sum of how much of the upper end samples find
};

// Nothing is farther than the upper end; where the precision was reached, the lower end is as near.
void expect_reaches(const OneSidedDistance& found, long double sampled, double precision, bool reached,
                    const std::string& name) {
  EXPECT_GE(found.distance.upper, sampled) << name;
  if (reached) {
    EXPECT_GE(found.distance.lower, sampled - precision * (1 + 1e-12L)) << name;
  }
  EXPECT_GE(found.distance.lower, 0) << name;
  EXPECT_LE(found.distance.lower, found.distance.upper) << name;
}

std::vector<oracle::Point> points_of(const TriangleSet& set, std::size_t count, std::mt19937_64& random) {
  std::vector<oracle::Point> points;
  for (std::size_t k = 0; k < count; ++k) {
    const oracle::Corners& t = set[k < set.size() ? k : random() % set.size()];
    double u = testing::between(random, 0, 1), v = testing::between(random, 0, 1);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    if (k % 2 == 0) u = 0, v = 0;
    oracle::Point p;
    for (std::size_t x = 0; x < 3; ++x) p[x] = t[0][x] + u * (t[1][x] - t[0][x]) + v * (t[2][x] - t[0][x]);
    points.push_back(p);
  }
  return points;
}

// A point that lies on no triangle but for its rounding: all its distances are off by that.
constexpr double rounding = 1e-14;

void check_triangles(const Curved& c, const Surface& surface, int power, const TriangleSet& set,
                     double precision, const std::string& name, std::mt19937_64& random,
                     CurvedCounts& counts) {
  TriangleSet asked = set;
  testing::change_points(asked, [&](const oracle::Point& p) {
    return oracle::Point{std::ldexp(p[0], power), std::ldexp(p[1], power), std::ldexp(p[2], power)};
  });
  DeviationOptions options;
  options.absolute = std::ldexp(precision, power);
  const Deviation found = deviation(surface, testing::candidate_of(asked), options, one_thread);
  const OneSidedDistance there = unscaled(found.from_surface, power),
                         back = unscaled(found.from_candidate, power);
  ++counts.asked;
  counts.unreached += found.outcome != Outcome::complete;
  if (found.outcome == Outcome::complete) {
    EXPECT_LE(there.distance.upper - there.distance.lower, precision) << name;
    EXPECT_LE(back.distance.upper - back.distance.lower, precision) << name;
  }
  long double sampled = 0;
  for (const LimitSample& s : samples_of(c)) {
    sampled =
        std::max(sampled, oracle::distance_to_triangles(s.position, set).lower - std::sqrt(3.0L) * s.error);
    ++counts.samples;
  }
  expect_reaches(there, sampled, precision, (found.outcome == Outcome::complete), name + ", of the surface");
  counts.share += there.distance.upper > 0 ? static_cast<double>(sampled) / there.distance.upper : 1;
  LimitDistance distance(c);
  sampled = 0;
  for (const oracle::Point& p : points_of(set, 40, random)) {
    sampled = std::max<long double>(sampled, distance(p, precision / 8).lower - rounding);
  }
  expect_reaches(back, sampled, precision, (found.outcome == Outcome::complete), name + ", of the candidate");
  // Farthest points: on their set, and as far away as the lower end tells.
  const oracle::Point on_surface{there.from.point.x, there.from.point.y, there.from.point.z},
      on_candidate{back.from.point.x, back.from.point.y, back.from.point.z};
  EXPECT_LE(distance(on_surface, 1e-11).lower, std::sqrt(3.0) * there.from.error + 1e-11) << name;
  EXPECT_GE(oracle::distance_to_triangles(on_surface, set).upper,
            there.distance.lower - std::sqrt(3.0L) * there.from.error - rounding)
      << name;
  EXPECT_LE(oracle::distance_to_triangles(on_candidate, set).lower,
            std::sqrt(3.0L) * back.from.error + rounding)
      << name;
  EXPECT_GE(distance(on_candidate, precision / 64).upper,
            back.distance.lower - std::sqrt(3.0) * back.from.error - rounding)
      << name;
  EXPECT_TRUE(there.from.at.has_value() && !back.from.at.has_value()) << name;
  if (counts.asked % 16 == 0) {
    EXPECT_TRUE(same(found, deviation(surface, testing::candidate_of(asked), options, three_threads)))
        << name;
  }
}

void check_surfaces(const Curved& a, const Surface& surface, const Curved& b, double precision,
                    const std::string& name, CurvedCounts& counts) {
  std::optional<Surface> other;
  try {
    other.emplace(control_mesh(b), b.options);
  } catch (const InputError&) {
    return;
  }
  if (samples_of(b).empty()) return;
  DeviationOptions options;
  options.absolute = precision;
  const Deviation found = deviation(surface, *other, options, one_thread);
  ++counts.asked;
  counts.unreached += found.outcome != Outcome::complete;
  LimitDistance to_a(a), to_b(b);
  const auto sampled = [&](const Curved& of, LimitDistance& from) {
    long double most = 0;
    std::vector<LimitSample> samples = samples_of(of);
    for (std::size_t k = 0; k < samples.size(); k += 1 + samples.size() / 60) {
      most = std::max<long double>(
          most, from(samples[k].position, precision / 8).lower - 2 * samples[k].error - rounding);
      ++counts.samples;
    }
    return most;
  };
  expect_reaches(found.from_surface, sampled(a, to_b), precision, (found.outcome == Outcome::complete),
                 name + ", of the surface");
  expect_reaches(found.from_candidate, sampled(b, to_a), precision, (found.outcome == Outcome::complete),
                 name + ", of the other");
  const auto expect_point = [&](const OneSidedDistance& side, LimitDistance& on, LimitDistance& from) {
    const oracle::Point p{side.from.point.x, side.from.point.y, side.from.point.z};
    EXPECT_LE(on(p, 1e-11).lower, std::sqrt(3.0) * side.from.error + 1e-11) << name;
    EXPECT_GE(from(p, precision / 64).upper,
              side.distance.lower - std::sqrt(3.0) * side.from.error - rounding)
        << name;
    EXPECT_TRUE(side.from.at.has_value()) << name;
  };
  expect_point(found.from_surface, to_a, to_b);
  expect_point(found.from_candidate, to_b, to_a);
}

// One that ends and is creased like this, if there is one; else one of either.
const Curved* drawn_of(const std::vector<Curved>& list, std::size_t border, std::size_t creases,
                       std::mt19937_64& random) {
  std::array<std::vector<const Curved*>, 3> fit;
  for (const Curved& c : list) {
    const bool ends = index_of(border_of(c)) == border, creased = index_of(creases_of(c)) == creases;
    if (ends && creased) fit[0].push_back(&c);
    if (ends || creased) fit[1].push_back(&c);
    fit[2].push_back(&c);
  }
  for (const auto& some : fit) {
    if (!some.empty()) return some[random() % some.size()];
  }
  return nullptr;
}

TEST(deviation, of_curved_surfaces_is_not_below_what_points_say) {
  const std::uint64_t trials = number_of("SNUG_PLACEMENTS", usual_curved) / 4,
                      first = number_of("SNUG_FIRST", 0);
  CurvedCounts counts;
  testing::PairsDrawn pairs(
      {4, beside_names.size(), precisions.size(), powers.size(), border_count, crease_count}),
      possible({4, border_count, crease_count});
  // Of all sorts equally many; other ones for each thousand.
  std::array<std::vector<Curved>, 4> sorts;
  for (std::uint64_t i = first; i < first + trials && !HasFailure(); ++i) {
    if (i == first || i % 1000 == 0) {
      for (std::vector<Curved>& list : sorts) list.clear();
      for (Curved& c : curved_surfaces(i / 1000 + 1)) {
        if (samples_of(c, 0).empty()) continue;
        possible.add({sort_of(c), index_of(border_of(c)), index_of(creases_of(c))});
        sorts[sort_of(c)].push_back(std::move(c));
      }
    }
    std::mt19937_64 random(i * 7907 + 3);
    const std::size_t sort = i % 4, kind = i / 4 % beside_names.size();
    // The finest precision takes its time.
    const bool turns = i < usual_curved / 4;  // all pairs, then any
    const std::size_t precision = (turns ? sort + kind + kind / 4 : random()) % precisions.size(),
                      power =
                          (turns ? sort + kind + i / (4 * beside_names.size()) : random()) % powers.size();
    const std::size_t turn = sort % 2 + 2 * (i / (4 * beside_names.size()));
    const Curved& c =
        *drawn_of(sorts[sort], (kind + turn) % border_count, (kind / 4 + turn) % crease_count, random);
    const std::string name = "trial " + std::to_string(i) + ", " + c.name + ", " + beside_names[kind] +
                             ", 2^" + std::to_string(powers[power]);
    const Surface plain(control_mesh(c), c.options);
    const double asked = precisions[precision] * plain.size();
    if (static_cast<Beside>(kind) == Beside::surface) {
      const std::vector<Curved>& others = sorts[random() % 4];
      check_surfaces(c, plain, others[random() % others.size()], asked, name, counts);
    } else {
      const std::optional<TriangleSet> set = make_beside(static_cast<Beside>(kind), c, plain, random);
      if (!set) continue;
      const Surface surface(scaled(control_mesh(c), powers[power]), c.options);
      check_triangles(c, surface, powers[power], *set, asked, name, random, counts);
    }
    pairs.add({sort, kind, precision, power, index_of(border_of(c)), index_of(creases_of(c))});
  }
  std::cout << "  " << counts.asked << " pairs, " << counts.samples << " points of surfaces, which find "
            << counts.share / static_cast<double>(counts.asked) << " of the upper ends; " << counts.unreached
            << " not as narrow as asked; " << pairs.missing() << " pairs of choices not drawn\n";
  EXPECT_GT(10 * counts.asked, 8 * trials);
  EXPECT_LE(50 * counts.unreached, counts.asked + 150);
  EXPECT_TRUE(trials < usual_curved / 4 || pairs.missing() == possible.missing());
}

// Points of candidates near solids of every scheme: the twin tells on which side they are.
TEST(deviation, of_curved_solids_is_not_below_what_points_of_either_side_say) {
  const std::uint64_t solids = number_of("SNUG_PLACEMENTS", usual_curved) / 20,
                      first = number_of("SNUG_FIRST", 0);
  CurvedCounts counts;
  for (std::uint64_t i = first; i < first + solids && !HasFailure(); ++i) {
    const testing::SolidCase c = testing::solid_case(i);
    std::mt19937_64 random(i + 9);
    std::optional<Surface> surface;
    try {
      surface.emplace(testing::control_mesh(c),
                      SurfaceOptions{.scheme = c.options.scheme, .boundary = c.options.boundary});
      TriangleSet set = testing::triangles_of(subdivided(
          surface->mesh(), 1, true, {.scheme = surface->scheme(), .boundary = surface->boundary()}));
      constexpr std::array kinds{CandidateKind::soup, CandidateKind::moved, CandidateKind::scaled};
      set = testing::make_candidate(kinds[i % 3], set, surface->size(), random);
      DeviationOptions options;
      options.absolute = precisions[i % 3] * surface->size();
      options.solid = true;
      const Deviation found =
          deviation(*surface, testing::candidate_of(set), options, {.max_splits = budget});
      ++counts.asked;
      counts.unreached += found.outcome != Outcome::complete;
      ASSERT_TRUE(found.inside && found.outside) << c.name;
      EXPECT_LE(std::max(found.inside->distance.lower, found.outside->distance.lower),
                found.from_candidate.distance.upper)
          << c.name;
      EXPECT_GE(std::max(found.inside->distance.upper, found.outside->distance.upper),
                found.from_candidate.distance.lower)
          << c.name;
      const oracle::WindingTwin twin(c.mesh, c.scheme, testing::twin_levels(c.mesh, 400));
      std::array<long double, 2> sampled{};
      for (const oracle::Point& p : points_of(set, 150, random)) {
        const std::optional<int> number = twin(p);
        if (!number) continue;
        ++(*number != 0 ? counts.inside : counts.outside);
        long double& most = sampled[*number != 0 ? 0 : 1];
        most = std::max<long double>(most, twin.distance_to_boxes(p) - 1e-12);
      }
      expect_reaches(*found.inside, sampled[0], *options.absolute, (found.outcome == Outcome::complete),
                     c.name + ", inside");
      expect_reaches(*found.outside, sampled[1], *options.absolute, (found.outcome == Outcome::complete),
                     c.name + ", outside");
      // Farthest points are on the side that they stand for.
      for (const auto& [side, within] : {std::pair{&*found.inside, true}, {&*found.outside, false}}) {
        if (side->distance.lower == 0) continue;
        const std::optional<int> number = twin({side->from.point.x, side->from.point.y, side->from.point.z});
        EXPECT_TRUE(!number || (*number != 0) == within) << c.name;
      }
    } catch (const InputError&) {
      continue;  // the same triangle twice
    }
  }
  std::cout << "  " << counts.asked << " solids, " << counts.inside << " points inside, " << counts.outside
            << " outside; " << counts.unreached << " not as narrow as asked\n";
  EXPECT_GT(10 * counts.asked, 8 * solids);
  EXPECT_GT(counts.inside, 4 * solids);
  EXPECT_GT(counts.outside, 10 * solids);
  // Where corners touch the surface, nothing else may be on a side.
  EXPECT_LE(10 * counts.unreached, counts.asked);
}

}  // namespace
}  // namespace snug::deviation_test
