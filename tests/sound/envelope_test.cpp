// The promises of envelope() against the twins: closed, not through itself, around every limit point, and nowhere nearer to the
// surface than the clearance or farther than the error.
//
//   SNUG_PLACEMENTS=200 build/release/bin/tests/sound_test --gtest_filter='envelopes.*'

#include <snug/hull.h>

#include <gtest/gtest.h>
#include <oracle/limit_twin.h>
#include <oracle/tagged_shapes.h>
#include <testing/counts.h>
#include <testing/hulls.h>
#include <testing/solid_cases.h>
#include <testing/surfaces.h>

#include <array>
#include <cmath>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <set>
#include <string>

namespace snug::envelope_test {
namespace {

using oracle::Point;
using oracle::TaggedMesh;
using testing::both;

constexpr oracle::Placement in_place{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

struct Outcomes {
  std::size_t complete = 0, triangles = 0, points = 0, inside = 0, near_least = 0, near_most = 0, bridges = 0;
  std::map<std::string, std::size_t> others;

  void print(const char* name) const {
    std::cout << "  " << name << ": " << complete << " complete, " << triangles << " triangles, " << points
              << " points of them (" << near_least << " within a tenth of the clearance, " << near_most
              << " of the error), " << inside << " points of surfaces inside, " << bridges << " bridges";
    for (const auto& [why, count] : others) std::cout << "; " << why << ' ' << count;
    std::cout << '\n';
  }
};

// Bounds of the distance of a point from the surface.
using Distance = std::function<Interval(const Point&)>;

void expect_envelope(const Envelope& found, const Distance& distance, const std::vector<Point>& of_surface,
                     std::mt19937_64& random, const std::string& name, Outcomes& outcomes) {
  ++outcomes.complete;
  outcomes.triangles += found.triangles.size();
  const oracle::HullTwin twin = testing::hull_twin({found.positions, found.triangles, {}, 0});
  EXPECT_EQ(twin.open_edges(), 0u) << name;
  EXPECT_TRUE(twin.contacts().empty()) << name;
  // The limit surface is inside, wherever it is; on its own border too.
  testing::for_some(of_surface, 60, [&](const Point& p) {
    EXPECT_EQ(twin.winding(p), 1) << name;
    ++outcomes.inside;
  });
  std::uniform_real_distribution<double> unit(0, 1);
  std::set<std::array<std::uint32_t, 3>> bridges;
  for (const std::uint32_t t : found.bridges) bridges.insert(found.triangles.at(t));
  EXPECT_EQ(bridges.size(), found.bridges.size()) << name;
  EXPECT_EQ(bridges.empty(), found.bridge_distance == 0) << name;
  outcomes.bridges += bridges.size();
  testing::for_some(found.triangles, 50, [&](const std::array<std::uint32_t, 3>& t) {
    // A corner, the middle of a side, and anywhere.
    const double a = unit(random), b = unit(random) * (1 - a);
    for (const auto& [u, v] : {std::pair{0.0, 0.0}, {0.5, 0.5}, {1.0 / 3, 1.0 / 3}, {a, b}}) {
      Point p;
      for (std::size_t k = 0; k < 3; ++k) {
        p[k] = (1 - u - v) * found.positions[t[0]][k] + u * found.positions[t[1]][k] +
               v * found.positions[t[2]][k];
      }
      const Interval far = distance(p);
      EXPECT_GE(far.upper * (1 + 1e-9), found.clearance) << name;
      EXPECT_LE(far.lower * (1 - 1e-9), bridges.contains(t) ? found.bridge_distance : found.error) << name;
      outcomes.near_least += far.upper < 1.1 * found.clearance;
      outcomes.near_most += far.lower > 0.9 * found.error;
      ++outcomes.points;
    }
  });
  EXPECT_LE(found.volume.lower, found.volume.upper);
  EXPECT_GT(found.volume.upper, 0) << name;
}

EnvelopeOptions any_options(double size, std::mt19937_64& random) {
  EnvelopeOptions how;
  how.error = std::array{0.1, 0.05, 0.03}[random() % 3] * size;
  if (const std::size_t which = random() % 4; which > 0) {
    how.clearance = std::array{0.0, 0.1, 0.6}[which - 1] * *how.error;
  }
  how.single_precision = random() % 4 == 0;
  if (random() % 3 == 0) how.gap = std::min(std::array{2.0, 3.0, 6.0}[random() % 3] * *how.error, size / 4);
  return how;
}

void check(const TaggedMesh& mesh, const oracle::WindingScheme& scheme, const SchemeOptions& options,
           const std::string& name, std::mt19937_64& random, Outcomes& outcomes) {
  Envelope found;
  try {
    const Surface surface = testing::public_surface(testing::control_mesh(mesh), options);
    found = envelope(surface, any_options(surface.size(), random), {.max_splits = 400'000});
  } catch (const InputError& error) {
    EXPECT_EQ(error.problem(), InputProblem::refused) << name << ": " << error.what();
    ++outcomes.others["refused"];
    return;
  }
  EXPECT_EQ(found.outcome == Outcome::complete, found.problems.empty()) << name;
  if (found.outcome != Outcome::complete) {
    EXPECT_TRUE(found.triangles.empty() || found.problems[0].fault == HullFault::not_around) << name;
    ++outcomes.others[std::string(name_of(found.outcome)) + ' ' + name_of(found.problems[0].fault)];
    return;
  }
  const auto* const dual = std::get_if<oracle::DualScheme>(&scheme);
  auto rules = dual ? std::make_shared<oracle::LimitRules>(*dual)
                    : std::make_shared<oracle::LimitRules>(std::get<oracle::Rules>(scheme));
  oracle::LimitTwin twin(mesh, std::move(rules));
  const Distance distance = [&](const Point& p) {
    const oracle::ContactBounds bounds =
        twin.distance_to(in_place, p, {.precision = {1e-3 * found.error, 1e-3}, .effort = 2000});
    return Interval{bounds.lower, bounds.upper};
  };
  expect_envelope(found, distance, testing::limit_samples(mesh, scheme, 3).points, random, name, outcomes);
}

TEST(envelopes, of_solids_of_every_scheme_are_around_them) {
  Outcomes outcomes;
  std::mt19937_64 random(4711);
  const std::uint64_t solids = testing::number_of("SNUG_PLACEMENTS", 12);
  for (std::uint64_t number = 0; number < solids && !HasFailure(); ++number) {
    const testing::SolidCase c = testing::solid_case(number);
    TaggedMesh mesh = c.mesh;
    // Beside or through itself, or inside out.
    if (number % 3 == 1) mesh = both(mesh, testing::moved(mesh, 0.8, {0.3, 0.2, 0.1}));
    if (number % 3 == 2) {
      for (auto& polygon : mesh.polygons) std::reverse(polygon.begin(), polygon.end());
    }
    check(mesh, c.scheme, c.options, c.name, random, outcomes);
  }
  outcomes.print("solids");
  EXPECT_EQ(outcomes.complete, solids);
  // Few points are; a third of the solids has none.
  EXPECT_TRUE(solids < 12 || outcomes.near_least + outcomes.near_most > 3);
}

// Every tag, boundary rule and sort of non-manifold place, mostly open.
TEST(envelopes, of_surfaces_with_every_tag_are_around_them) {
  std::mt19937_64 random(4712);
  for (const auto scheme : {oracle::PrimalScheme::catmull_clark, oracle::PrimalScheme::loop}) {
    Outcomes outcomes;
    std::size_t number = 0, tried = 0;
    for (const testing::TaggedCase& c : testing::tagged_cases(scheme, 78)) {
      if (HasFailure()) return;
      const std::size_t i = number++, shape = i / 6;
      if (testing::long_check() ? (i + shape) % 2 != 0 : i % 6 != shape % 6) continue;
      ++tried;
      check(c.mesh, c.rules, testing::options_of(c.rules), c.name + ", " + testing::text_of(c.rules), random,
            outcomes);
    }
    outcomes.print(scheme == oracle::PrimalScheme::loop ? "loop" : "catmark");
    EXPECT_GE(20 * outcomes.complete, 19 * (tried - outcomes.others["refused"]));
    EXPECT_GT(outcomes.complete, 8u);
  }
}

// Triangles in no order: through each other, on each other, needles, beside each other.
TEST(envelopes, of_soups_of_facets_are_around_them) {
  Outcomes outcomes;
  std::mt19937_64 random(4713);
  const std::uint64_t soups = testing::number_of("SNUG_PLACEMENTS", 12);
  for (std::uint64_t number = 0; number < soups && !HasFailure(); ++number) {
    ControlMesh mesh;
    std::vector<Point> points;
    std::vector<oracle::Triangle> triangles;
    std::uniform_real_distribution<double> unit(-1, 1);
    // On a coarse lattice facets meet in every way.
    const bool coarse = number % 2 == 0;
    const std::size_t count = 1 + random() % 12;
    for (std::uint32_t i = 0; i < 3 * count; ++i) {
      Point p;
      for (double& x : p) x = coarse ? std::round(2 * unit(random)) / 2 : unit(random);
      // A needle now and then.
      if (i % 3 == 2 && random() % 5 == 0)
        p = {points[i - 1][0] + 1e-3 * unit(random), points[i - 1][1], points[i - 1][2]};
      points.push_back(p);
      mesh.points.push_back({p[0], p[1], p[2]});
    }
    for (std::uint32_t t = 0; t < count; ++t) {
      triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
      mesh.add_face(std::array{VertexId(3 * t), VertexId(3 * t + 1), VertexId(3 * t + 2)});
    }
    const Surface surface = testing::public_surface(mesh, {Scheme::flat});
    const Envelope found = envelope(surface, any_options(surface.size(), random), {.max_splits = 400'000});
    if (found.outcome != Outcome::complete) {
      ++outcomes.others[name_of(found.problems[0].fault)];
      continue;
    }
    const oracle::HullTwin twin(points, triangles);
    std::vector<Point> of_surface = points;
    for (const auto& [a, b, c] : triangles) {
      Point middle;
      for (std::size_t k = 0; k < 3; ++k) middle[k] = (points[a][k] + points[b][k] + points[c][k]) / 3;
      of_surface.push_back(middle);
    }
    expect_envelope(
        found, [&](const Point& p) { return Interval(twin.distance(p)); }, of_surface, random,
        std::to_string(number), outcomes);
  }
  outcomes.print("soups");
  EXPECT_GE(12 * outcomes.complete, 11 * soups);
}

struct Facets {
  std::vector<Point> points;
  std::vector<oracle::Triangle> triangles;

  std::uint32_t add(double x, double y, double z) {
    points.push_back({x, y, z});
    return static_cast<std::uint32_t>(points.size() - 1);
  }
  // Rings of so many points around the z axis, by radius and height, and what is between them.
  void add_rings(const std::vector<std::pair<double, double>>& rings) {
    constexpr std::uint32_t sides = 24;
    for (std::size_t i = 0; i < rings.size(); ++i) {
      for (std::uint32_t k = 0; k < sides; ++k) {
        const double angle = 2 * std::numbers::pi * k / sides;
        const auto [radius, z] = rings[i];
        const std::uint32_t v = add(radius * std::cos(angle), radius * std::sin(angle), z);
        if (i == 0) continue;
        const std::uint32_t next = k + 1 == sides ? v + 1 - sides : v + 1;
        triangles.push_back({v - sides, v, next});
        triangles.push_back({v - sides, next, next - sides});
      }
    }
  }
  // A sphere with a hole at each pole.
  void add_sphere(double radius, double upper_hole, double lower_hole) {
    std::vector<std::pair<double, double>> rings;
    const double first = std::asin(upper_hole / radius),
                 last = std::numbers::pi - std::asin(lower_hole / radius);
    for (int i = 0; i <= 10; ++i) {
      const double angle = first + (last - first) * i / 10;
      rings.emplace_back(radius * std::sin(angle), radius * std::cos(angle));
    }
    add_rings(rings);
  }
};

// A ball as wide as the gap goes through wider holes, and through no others, whatever is behind them.
TEST(envelopes, with_a_gap_go_through_holes_that_are_wider) {
  constexpr double gap = 0.4;
  struct Case {
    const char* name;
    std::function<void(Facets&)> make;
    std::vector<std::pair<double, int>> winding;  // by heights on the axis
    std::optional<bool> bridged;
  };
  const auto sphere = [](double hole, double other = 1e-3) {
    return [=](Facets& f) { f.add_sphere(0.82, hole * gap / 2, other * gap / 2); };
  };
  const auto tube = [](double radius) {
    return [=](Facets& f) {
      f.add_rings({{radius * gap / 2, 0}, {radius * gap / 2, 1}, {radius * gap / 2, 2}});
    };
  };
  const std::vector<Case> cases{
      {"almost as wide", sphere(0.95), {{0, 1}, {0.6, 1}}, true},
      {"a little wider", sphere(1.15), {{0, 0}, {0.6, 0}}, {}},
      {"wider, and a place between as far from all", sphere(1.6), {{0, 0}, {0.6, 0}}, false},
      // From both sides the ball comes deeper into the narrow one than the sheet is thick.
      {"one narrow, one wide", sphere(0.6, 1.4), {{0, 0}, {0.81, 0}, {-0.8, 0}}, {}},
      {"a tube almost as wide", tube(0.93), {{0.5, 1}, {1, 1}, {1.5, 1}}, true},
      {"a wide tube", tube(1.3), {{-0.1, 0}, {1, 0}, {2.1, 0}}, false},
      {"nested, the outer one open",
       [&](Facets& f) {
         f.add_sphere(0.82, 0.35, 1e-3);
         f.add_sphere(0.3, 0.1, 1e-3);
       },
       {{0, 1}, {0.6, 0}},
       true},
      {"nested, the inner one open",
       [&](Facets& f) {
         f.add_sphere(0.82, 0.1, 1e-3);
         f.add_sphere(0.4, 0.3, 1e-3);
       },
       {{0, 1}, {0.55, 1}},
       true},
  };
  std::mt19937_64 random(4716);
  Outcomes outcomes;
  for (const Case& c : cases) {
    Facets made;
    c.make(made);
    ControlMesh mesh;
    for (const Point& p : made.points) mesh.points.push_back({p[0], p[1], p[2]});
    for (const auto& [x, y, z] : made.triangles)
      mesh.add_face(std::array{VertexId(x), VertexId(y), VertexId(z)});
    const Surface surface = testing::public_surface(mesh, {Scheme::flat});
    const Envelope found = envelope(surface, {.error = 0.06, .gap = gap}, {.threads = 2});
    ASSERT_EQ(found.outcome, Outcome::complete) << c.name;
    EXPECT_EQ(!found.bridges.empty(), c.bridged.value_or(!found.bridges.empty()))
        << c.name << ' ' << found.bridges.size();
    EXPECT_LE(found.bridge_distance, gap) << c.name;
    const oracle::HullTwin surface_twin(made.points, made.triangles);
    expect_envelope(
        found, [&](const Point& p) { return Interval(surface_twin.distance(p)); }, made.points, random,
        c.name, outcomes);
    const oracle::HullTwin twin = testing::hull_twin({found.positions, found.triangles, {}, 0});
    for (const auto& [z, winding] : c.winding) {
      EXPECT_EQ(twin.winding({0.001, 0.002, z}), winding) << c.name << " at " << z;
    }
  }
  outcomes.print("holes");
}

// Parts at their poses: the envelope is around all of them, and answers do not depend on threads.
TEST(envelopes, of_parts_are_around_all_of_them) {
  std::mt19937_64 random(4714);
  const TaggedMesh cube = testing::solid_case(0).mesh;
  const Surface part = testing::public_surface(testing::control_mesh(cube), {Scheme::catmark});
  const std::array parts{PlacedSurface(part), part.at(Motion::rotation_degrees({1, 2, 3}, 40)),
                         part.at(Motion::translation({5, 0, 0})),
                         part.at(Motion::translation({5.5, 0.25, 0}))};
  const Envelope one = envelope(parts, {.error = 0.1}, {.threads = 1}),
                 two = envelope(parts, {.error = 0.1}, {.threads = 2});
  ASSERT_EQ(one.outcome, Outcome::complete);
  EXPECT_EQ(one.positions, two.positions);
  EXPECT_EQ(one.triangles, two.triangles);
  oracle::LimitTwin twin(
      cube, std::make_shared<oracle::LimitRules>(oracle::Rules{oracle::PrimalScheme::catmull_clark}));
  const Distance distance = [&](const Point& p) {
    Interval least{INFINITY, INFINITY};
    for (const PlacedSurface& placed : parts) {
      const oracle::ContactBounds bounds =
          twin.distance_to(placed.pose().numbers(), p, {.precision = {1e-4, 1e-3}, .effort = 2000});
      least = {std::min(least.lower, bounds.lower), std::min(least.upper, bounds.upper)};
    }
    return least;
  };
  std::vector<Point> of_surfaces;
  for (const Point& p :
       testing::limit_samples(cube, oracle::Rules{oracle::PrimalScheme::catmull_clark}, 3).points) {
    for (const PlacedSurface& placed : parts) {
      const Point3 there = placed.pose().apply({p[0], p[1], p[2]});
      of_surfaces.push_back({there.x, there.y, there.z});
    }
  }
  Outcomes outcomes;
  expect_envelope(one, distance, of_surfaces, random, "parts", outcomes);
  outcomes.print("parts");
}

// Pieces err least along their normals, which turn with them; a pose may cancel large coordinates.
TEST(envelopes, of_sheets_that_are_turned_and_come_from_far_away_are_around_them) {
  std::mt19937_64 random(4715);
  Outcomes outcomes;
  for (const double far : {0.0, 1e7}) {
    TaggedMesh sheet = testing::moved(oracle::meshes::shaken(oracle::meshes::quad_grid(3, 3), 0.3, random), 1,
                                      {far, -far, far});
    const Surface part = testing::public_surface(testing::control_mesh(sheet), {Scheme::catmark});
    const Motion turn = Motion::rotation_degrees({0, 1, 0}, 90);
    const Point3 there = turn.apply({far, -far, far});
    const PlacedSurface placed = part.at(turn.with_offset({-there.x, -there.y, -there.z}));
    EnvelopeOptions how{.error = 0.2};
    how.clearance = 0.15;
    const Envelope found = envelope(placed, how);
    ASSERT_EQ(found.outcome, Outcome::complete) << far;
    oracle::LimitTwin twin(
        sheet, std::make_shared<oracle::LimitRules>(oracle::Rules{oracle::PrimalScheme::catmull_clark}));
    const Distance distance = [&](const Point& p) {
      const oracle::ContactBounds bounds =
          twin.distance_to(placed.pose().numbers(), p, {.precision = {1e-5, 1e-5}, .effort = 2000});
      return Interval{bounds.lower, bounds.upper};
    };
    expect_envelope(found, distance, {}, random, "sheet", outcomes);
  }
  outcomes.print("sheets");
}

TEST(envelopes, refuse_what_is_no_question) {
  const Surface part =
      testing::public_surface(testing::control_mesh(testing::solid_case(0).mesh), {Scheme::catmark});
  const auto problem = [&](const EnvelopeOptions& options) {
    try {
      static_cast<void>(envelope(part, options));
    } catch (const InputError& error) {
      return error.problem();
    }
    return InputProblem::unreadable;
  };
  EXPECT_EQ(problem({.error = 0.0}), InputProblem::value);
  EXPECT_EQ(problem({.error = NAN}), InputProblem::value);
  EXPECT_EQ(problem({.error = 1e9}), InputProblem::value);
  EXPECT_EQ(problem({.error = 1e-12}), InputProblem::value);
  EXPECT_EQ(problem({.error = 0.1, .clearance = 0.1}), InputProblem::value);
  EXPECT_EQ(problem({.error = 0.1, .clearance = -1.0}), InputProblem::value);
  EXPECT_EQ(problem({.error = 0.1, .gap = 0.19}), InputProblem::value);
  EXPECT_EQ(problem({.error = 0.1, .gap = NAN}), InputProblem::value);
  EXPECT_EQ(problem({.error = 0.01, .gap = 5.0}), InputProblem::value);
  EXPECT_THROW(static_cast<void>(envelope(std::span<const PlacedSurface>{})), InputError);
  // A small budget says so, and hands out nothing.
  const Envelope none = envelope(part, {.error = 1e-3}, {.max_splits = 1000});
  EXPECT_EQ(none.outcome, Outcome::budget_spent);
  EXPECT_TRUE(none.triangles.empty());
  ASSERT_FALSE(none.problems.empty());
  EXPECT_EQ(none.problems[0].fault, HullFault::too_few_triangles);
}

}  // namespace
}  // namespace snug::envelope_test
