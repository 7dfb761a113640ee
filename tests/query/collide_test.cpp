#include <snug/distance.h>
#include <snug/evaluate.h>

#include <gtest/gtest.h>
#include <snug/search/piece_pairs.h>
#include <snug/search/surface_data.h>
#include <support/error.h>
#include <testing/placements.h>
#include <testing/surfaces.h>

#include <testing/tagged.h>
#include <cstdio>

#include <cfloat>

#include "testing/verdict_only.h"

namespace snug::collide_test {
namespace {

struct Pair {
  Surface a, b;
  Pair(const oracle::TwinMesh& x, const oracle::TwinMesh& y, int threads = 1)
      : a(testing::public_surface(x, {}, {.threads = threads})),
        b(testing::public_surface(y, {}, {.threads = threads})) {}
  Collision ask(const Motion& place, const CollideOptions& options, const Run& run = {}) {
    return collide(a, b.at(place), options, run);
  }
};

Motion moved(double x, double y, double z) { return Motion::translation({x, y, z}); }

bool same(const Collision& x, const Collision& y) {
  return x.verdict == y.verdict && x.distance.lower == y.distance.lower &&
         x.distance.upper == y.distance.upper && x.witness == y.witness && x.stats.splits == y.stats.splits;
}

TEST(collide, separates_what_is_apart_and_meets_what_overlaps) {
  Pair pair(oracle::meshes::icosahedron(), oracle::meshes::octahedron());
  const Collision apart = pair.ask(moved(5, 0, 0), testing::verdict_only(0.01, 0));
  EXPECT_EQ(apart.verdict, Verdict::separated);
  EXPECT_GT(apart.distance.lower, 0);
  EXPECT_LT(apart.distance.lower, 5);
  const Collision touching = pair.ask(moved(0.9, 0, 0), testing::verdict_only(0.01, 0));
  EXPECT_EQ(touching.verdict, Verdict::within);
  ASSERT_TRUE(touching.witness && std::isfinite(touching.distance.upper));
  EXPECT_LE(touching.distance.upper, 0.01);
  EXPECT_LE(distance((*touching.witness)[0].point, (*touching.witness)[1].point), 0.01);
}

// A shell inside a shell: no points in common, however deep.
TEST(collide, separates_nested_shells) {
  oracle::TwinMesh inner = oracle::meshes::icosahedron();
  for (oracle::Point& p : inner.points) p = {0.5 * p[0], 0.5 * p[1], 0.5 * p[2]};
  Pair pair(oracle::meshes::icosahedron(), inner);
  EXPECT_EQ(pair.ask({}, testing::verdict_only(0.001, 0)).verdict, Verdict::separated);
}

TEST(collide, honours_the_margin) {
  Pair pair(oracle::meshes::icosahedron(), oracle::meshes::icosahedron());
  const Collision near = pair.ask(moved(2, 0, 0), testing::verdict_only(1e-6, 0));
  ASSERT_EQ(near.verdict, Verdict::separated);
  EXPECT_EQ(pair.ask(moved(2, 0, 0), testing::verdict_only(1e-6, 1.5)).verdict, Verdict::within);
}

// Points near each other are found on patches as they are, not on splits of them.
TEST(collide, tells_that_patches_meet_with_few_splits) {
  Pair pair(oracle::meshes::icosahedron(), oracle::meshes::icosahedron());
  std::mt19937_64 random(31);
  std::uint64_t splits = 0;
  int met = 0, crossed = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Motion pose = testing::random_placement(random, testing::random_vector(random, 1));
    CollideOptions options = testing::verdict_only(1e-3, 0);
    const Collision found = pair.ask(pose, options);
    options.prove_contact = true;
    const Collision proved = pair.ask(pose, options);
    ASSERT_EQ(found.verdict == Verdict::separated, proved.verdict == Verdict::separated) << trial;
    if (found.verdict == Verdict::separated) continue;
    // Where pieces had to be split a crossing is proved on the way.
    if (found.verdict == Verdict::intersecting) {
      ++crossed;
      continue;
    }
    ASSERT_LE(found.distance.upper, 1e-3);
    ++met;
    splits += found.stats.splits;
    ASSERT_LE(distance((*found.witness)[0].point, (*found.witness)[1].point), 1e-3);
  }
  EXPECT_GT(met, 100);
  EXPECT_LE(crossed, 5);
  EXPECT_LT(splits, 3u * static_cast<unsigned>(met));
}

TEST(collide, finds_coincident_surfaces_at_once) {
  Pair pair(oracle::meshes::icosahedron(), oracle::meshes::icosahedron());
  EXPECT_EQ(pair.ask({}, testing::verdict_only(1e-9, 0)).verdict, Verdict::within);
}

TEST(collide, does_not_depend_on_threads_or_earlier_queries) {
  std::mt19937_64 random(28);
  const oracle::TwinMesh x =
      oracle::meshes::disturbed(oracle::meshes::quartered(oracle::meshes::icosahedron()), 10, 0.1, random);
  Pair one(x, oracle::meshes::bipyramid(7), 1), two(x, oracle::meshes::bipyramid(7), 2);
  for (int trial = 0; trial < 300; ++trial) {
    const Motion place = testing::random_placement(random, testing::random_vector(random, 1.5));
    const CollideOptions options{0.002, 0};
    const Collision answer = one.ask(place, options);
    EXPECT_TRUE(same(answer, two.ask(place, options)));
    if (trial % 30 == 0) {
      Pair fresh(x, oracle::meshes::bipyramid(7), 1);
      EXPECT_TRUE(same(answer, fresh.ask(place, options)));
    }
  }
}

TEST(collide, is_undecided_when_the_budget_ends) {
  Pair pair(oracle::meshes::icosahedron(), oracle::meshes::icosahedron());
  const Collision answer = pair.ask(moved(1.2, 0.3, 0.1), testing::verdict_only(1e-12, 0), {.max_splits = 3});
  EXPECT_EQ(answer.verdict, Verdict::undecided);
  EXPECT_EQ(answer.outcome, Outcome::budget_spent);
  EXPECT_EQ(answer.distance.lower, 0);
  EXPECT_LE(answer.stats.splits, 3u);
}

TEST(closest, ends_at_rounding_where_the_point_lies_on_the_surface) {
  const Surface surface = testing::public_surface(oracle::meshes::icosahedron());
  const Point3 on = evaluate(surface, {3, 0, 0, 0}).point;
  // No distance is small beside none: precision relative to it alone is never reached, and pieces around a
  // vertex could be split for long.
  Workspace workspace;
  const ClosestPoint found = closest_point(surface, on, {0, 1e-3}, {.workspace = &workspace});
  EXPECT_LE(found.distance.upper, 1e-13);
  EXPECT_LT(workspace.bytes(), 62 * (sizeof(SplitNode) + sizeof(Patch)));
}

TEST(collide, works_at_the_ends_of_the_doubles) {
  for (const double size : {1e-300, 1e-160, 1e160, 1e300}) {
    oracle::TwinMesh twin = oracle::meshes::icosahedron();
    for (oracle::Point& p : twin.points) p = {size * p[0], size * p[1], size * p[2]};
    Pair pair(twin, twin);
    EXPECT_EQ(pair.ask(moved(4 * size, 0, 0), testing::verdict_only(0.01 * size, 0)).verdict,
              Verdict::separated)
        << size;
    EXPECT_EQ(pair.ask(moved(size, 0, 0), testing::verdict_only(0.01 * size, 0)).verdict, Verdict::within)
        << size;
  }
}

// Octahedra tip to tip along x: the distance is that of the middles less both tips.
TEST(collide, surfaces_far_apart_are_separated_at_once_wherever_they_are) {
  const double tip = 24.0 / 55;  // of an octahedron, from its middle
  for (const double size_a : {1.0, 1e-150, 1e150, 1e-300}) {
    for (const double size_b : {1.0, 1e-150, 1e150, 1e300}) {
      for (const double far : {1e20, 1e80, 1e150, 1e200, 1e300, 1.5e308}) {
        if (!(far > 10 * std::max(size_a, size_b))) continue;
        const auto sized = [](double size) {
          oracle::TwinMesh twin = oracle::meshes::octahedron();
          for (oracle::Point& p : twin.points) p = {size * p[0], size * p[1], size * p[2]};
          return twin;
        };
        Pair pair(sized(size_a), sized(size_b));
        for (const double sign : {1.0, -1.0}) {
          char where[100];
          std::snprintf(where, sizeof where, "sizes %g and %g, %g apart", size_a, size_b, sign * far);
          const Collision answer = pair.ask(moved(sign * far, 0, 0), testing::verdict_only(0.01 * size_a, 0));
          EXPECT_EQ(answer.verdict, Verdict::separated) << where;
          EXPECT_EQ(answer.stats.splits, 0u) << where;
          // Not above the truth, and not far below it.
          EXPECT_LE(answer.distance.lower, far - tip * (size_a + size_b) * (1 - 1e-15)) << where;
          EXPECT_GE(answer.distance.lower, far * (1 - 2e-14) - 2 * (size_a + size_b)) << where;
          const bool very_far = far > 1e18 * std::max(size_a, size_b);
          const Distance apart =
              distance(pair.a, pair.b.at(moved(sign * far, 0, 0)), {0, very_far ? 1e-13 : 1e-6});
          EXPECT_LE(apart.stats.splits, 4000u) << where;
          EXPECT_LE(apart.distance.lower, far - tip * (size_a + size_b) * (1 - 1e-15)) << where;
          EXPECT_GE(apart.distance.upper, far - tip * (size_a + size_b) * (1 + 1e-15)) << where;
          // Where the sizes are nothing beside it, the distance is known to some roundings.
          if (very_far) {
            EXPECT_GE(answer.distance.lower, far * (1 - 2e-14)) << where;
            EXPECT_GE(apart.distance.lower, far * (1 - 2e-14)) << where;
            EXPECT_LE(apart.distance.upper, far * (1 + 2e-14)) << where;
          }
        }
      }
    }
  }
}

// The far corner of the range: an upper bound of the distance does not fit a double, the verdict does.
TEST(collide, separates_what_is_farther_apart_than_a_double_can_say) {
  Pair pair(oracle::meshes::octahedron(), oracle::meshes::octahedron());
  CollideOptions options = testing::verdict_only();
  options.measure = true;
  const Collision answer = pair.ask(moved(1.7e308, 1.7e308, 1.7e308), options);
  EXPECT_EQ(answer.verdict, Verdict::separated);
  EXPECT_GE(answer.distance.lower, 1.7e308);
  EXPECT_TRUE(std::isfinite(answer.distance.lower));
}

TEST(collide, measures_the_gap_if_asked) {
  Pair pair(oracle::meshes::icosahedron(), oracle::meshes::octahedron());
  CollideOptions options = testing::verdict_only();
  options.measure = true;
  for (const double x : {1.6, 1.7, 2.0, 3.0, 10.0}) {
    const Collision answer = pair.ask(moved(x, 0.3, 0.2), options);
    ASSERT_EQ(answer.verdict, Verdict::separated) << x;
    ASSERT_TRUE(std::isfinite(answer.distance.upper) && answer.witness);
    EXPECT_GE(answer.distance.lower, answer.distance.upper / 2) << x;
    EXPECT_TRUE((*answer.witness)[0].at && (*answer.witness)[1].at);
  }
}

// However coarse the precision: pairs that overlap by a tenth of it.
TEST(collide, surfaces_that_meet_are_no_distance_apart) {
  Pair pair(oracle::meshes::icosahedron(), oracle::meshes::octahedron());
  std::mt19937_64 random(38);
  int proved = 0;
  for (int i = 0; i < 100; ++i) {
    const Motion apart = testing::random_placement(random, {3, 0, 0});
    const DistanceOptions fine{.absolute = 1e-5, .relative = {}}, coarse{.absolute = 0.01, .relative = {}};
    const Distance gap = distance(pair.a, pair.b.at(apart), fine);
    const Vector3 deeper = (1 + 1e-3 / gap.distance.upper) * (gap.witness[0].point - gap.witness[1].point);
    const Motion place = Motion::translation(deeper) * apart;
    proved += distance(pair.a, pair.b.at(place), coarse).distance.upper == 0;
  }
  EXPECT_GE(proved, 95);
}

TEST(collide, compares_meshes_of_very_different_size) {
  oracle::TwinMesh grain = oracle::meshes::icosahedron();
  for (oracle::Point& p : grain.points) p = {1e-9 * p[0], 1e-9 * p[1], 1e-9 * p[2]};
  Pair pair(oracle::meshes::icosahedron(), grain);
  EXPECT_EQ(pair.ask(moved(0, 0, 0), testing::verdict_only(0.01, 0)).verdict,
            Verdict::separated);  // at the centre
  EXPECT_EQ(pair.ask(moved(3, 0, 0), testing::verdict_only(0.01, 0)).verdict, Verdict::separated);
}

// Both moved so far away that their own size underflows single precision in units of the translation.
TEST(collide, lower_bounds_hold_for_placements_of_any_length) {
  int separated = 0;
  for (int k = 0; k < 40; ++k) {
    const double apart = 0.05 + 0.0101 * k;
    oracle::TwinMesh below = oracle::meshes::grid(5, 5);
    for (oracle::Point& p : below.points) p = {0.1 * p[0], 0.1 * p[1], 0};
    oracle::TwinMesh above = below;
    for (oracle::Point& p : above.points) p[2] = apart;
    Pair pair(below, above);
    for (int exponent = 100; exponent < 150; ++exponent) {
      const Motion place = moved(std::ldexp(1.0, exponent), 0, 0);
      CollideOptions options = testing::verdict_only(0, 0.9 * apart);
      const Collision answer = collide(pair.a.at(place), pair.b.at(place), options, {.max_splits = 200});
      separated += answer.verdict == Verdict::separated;
      EXPECT_LE(answer.distance.lower, apart) << exponent;
    }
  }
  EXPECT_GT(separated, 1000);
}

// Any direction gives a bound, whatever its length: squares of short ones lose digits.
TEST(collide, planes_between_quadratics_hold_for_directions_of_any_length) {
  Pair pair(oracle::meshes::icosahedron(), oracle::meshes::octahedron());
  const SurfaceBvh &model_a = pair.a.data()->bvh(), &model_b = pair.b.data()->bvh();
  PieceCache scratch_a(model_a), scratch_b(model_b);
  const PlacedBvh a{model_a, scratch_a, {}}, b{model_b, scratch_b, moved(3, 0.2, 0.1)};
  PairFrames frames(a, b);
  SearchStats stats;
  PairWalk walk(frames, stats, WideNode::Gaps::lines);
  PiecePairs pieces(frames, stats);
  Frontier<NodePair> open;
  open.start(Order::last_first, walk.roots());
  NodePair pair_of_patches = open.take();
  while (!pair_of_patches.bounded()) {
    walk.open(pair_of_patches, INFINITY, open);
    pair_of_patches = open.take();
  }
  const Vector3 direction{3, 0.2, 0.1};
  const double gap = pieces.gap_along(pair_of_patches.nodes, direction);
  ASSERT_GT(gap, 0);
  for (int exponent = -1073; exponent < 1000; ++exponent) {
    const Vector3 scaled{std::ldexp(direction.x, exponent), std::ldexp(direction.y, exponent),
                         std::ldexp(direction.z, exponent)};
    if (scaled.z * 2 < DBL_MIN) continue;  // another direction
    EXPECT_LE(pieces.gap_along(pair_of_patches.nodes, scaled), gap * (1 + 1e-12)) << exponent;
  }
}

TEST(collide, proves_contact_at_tolerance_zero) {
  Pair closed(oracle::meshes::icosahedron(), oracle::meshes::octahedron());
  const Collision answer = closed.ask(moved(0.9, 0.1, 0.05), testing::verdict_only());
  EXPECT_EQ(answer.verdict, Verdict::intersecting);
  EXPECT_EQ(answer.distance.upper, 0);
  EXPECT_EQ(closed.ask(moved(3, 0, 0), testing::verdict_only()).verdict, Verdict::separated);
  // Open surfaces cross as well: one stands on edge in the other.
  Pair open(oracle::meshes::grid(4, 4), oracle::meshes::grid(4, 4));
  const Motion upright = Motion::from_3x4({1, 0, 0, 0.3, 0, 0, -1, 1.9, 0, 1, 0, -1.7});
  EXPECT_EQ(open.ask(upright, testing::verdict_only()).verdict, Verdict::intersecting);
}

TEST(collide, touching_surfaces_stay_undecided_at_tolerance_zero) {
  Pair pair(oracle::meshes::grid(3, 3), oracle::meshes::grid(3, 3));
  EXPECT_EQ(pair.ask({}, testing::verdict_only(0, 0), {.max_splits = 2000}).verdict, Verdict::undecided);
}

// In one plane but for rounding every pair of triangles looks as if it crossed.
TEST(collide, surfaces_in_one_plane_end_within_bounded_memory) {
  Pair pair(oracle::meshes::grid(16, 16), oracle::meshes::grid(16, 16));
  std::mt19937_64 random(32);
  const Motion tilted = testing::random_placement(random, {});
  // Once more, about the plane's own normal.
  const Motion turned = tilted * Motion::rotation({0, 0, 1}, 0.3);
  Workspace workspace;
  const Collision answer =
      collide(pair.a.at(tilted), pair.b.at(turned), testing::verdict_only(), {.workspace = &workspace});
  EXPECT_EQ(answer.verdict, Verdict::undecided);
  EXPECT_LT(workspace.bytes(), std::size_t{256} << 20);  // what max_touched allows
}

TEST(collide, takes_closed_surfaces_for_solids_if_asked) {
  oracle::TwinMesh inner = oracle::meshes::icosahedron();
  for (oracle::Point& p : inner.points) p = {0.5 * p[0], 0.5 * p[1], 0.5 * p[2]};
  Pair nested(oracle::meshes::icosahedron(), inner);
  CollideOptions options = testing::verdict_only();
  EXPECT_EQ(nested.ask({}, options).verdict, Verdict::separated);
  options.solid = true;
  const Collision held = nested.ask({}, options);
  EXPECT_EQ(held.verdict, Verdict::intersecting);
  EXPECT_EQ(held.contained, std::optional<std::size_t>(1));
  EXPECT_EQ(held.distance.lower, 0);
  EXPECT_EQ(held.distance.upper, 0);
  ASSERT_TRUE(held.witness);
  EXPECT_EQ(held.outcome, Outcome::complete);
  EXPECT_EQ((*held.witness)[0].point, (*held.witness)[1].point);
  EXPECT_EQ(nested.ask(moved(0, 3, 0), options).verdict, Verdict::separated);
  Pair half(oracle::meshes::icosahedron(), oracle::meshes::grid(2, 2));
  // However far away.
  EXPECT_THROW(static_cast<void>(half.ask(moved(0, 0, 1.2), options)), InputError);
  EXPECT_THROW(static_cast<void>(half.ask(moved(0, 0, 1e9), options)), InputError);
}

// Boxes that overlap, with faces in common planes: no crossing is proved, but faces of one lie in the other.
// From sizes 2^20 apart on, frames of one surface say nothing in the other's; points of the smaller one still do.
TEST(collide, finds_a_solid_inside_another_however_small) {
  for (int smaller = 0; smaller <= 900; smaller += smaller < 60 ? 4 : 60) {
    oracle::TwinMesh inner = oracle::meshes::icosahedron();
    for (oracle::Point& p : inner.points) {
      for (double& x : p) x = std::ldexp(x, -2 - smaller);
    }
    const bool swapped = smaller % 8 == 0;
    const oracle::TwinMesh outer = oracle::meshes::octahedron();
    Pair pair(swapped ? inner : outer, swapped ? outer : inner);
    CollideOptions options = testing::verdict_only(0, 0);
    options.solid = true;
    for (const Motion& place : {Motion(), moved(0.1, 0.2, 0.05)}) {
      EXPECT_EQ(pair.ask(place, options).verdict, Verdict::intersecting) << smaller;
    }
    EXPECT_EQ(pair.ask(moved(3, 0, 0), options).verdict, Verdict::separated) << smaller;
  }
}

TEST(collide, solids_that_share_planes_intersect) {
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark}) {
    oracle::TaggedMesh shape = oracle::meshes::cube();
    if (scheme == Scheme::loop) shape = oracle::meshes::triangulated(shape);
    for (const auto& polygon : shape.polygons) {
      for (std::size_t k = 0; k < polygon.size(); ++k) {
        shape.creases.push_back({polygon[k], polygon[(k + 1) % polygon.size()], oracle::kInfinitelySharp});
      }
    }
    const Surface box(testing::control_mesh(shape), {.scheme = scheme});
    CollideOptions options = testing::verdict_only();
    options.tolerance = 1e-3;
    options.prove_contact = true;
    options.solid = true;
    const auto ask = [&](const Vector3& d) { return collide(box, box.at(Motion::translation(d)), options); };
    for (const Vector3& d : {Vector3{0.875, 0, 0}, Vector3{0.5, 0.5, 0}, Vector3{0, 0.125, 0}}) {
      EXPECT_EQ(ask(d).verdict, Verdict::intersecting) << name_of(scheme) << ' ' << d.x << ' ' << d.y;
    }
    EXPECT_TRUE(ask({0.875, 0, 0}).contained);
    EXPECT_EQ(ask({1.25, 0, 0}).verdict, Verdict::separated);
    EXPECT_EQ(ask({1, 0, 0}).verdict, Verdict::within);        // side by side
    EXPECT_EQ(ask({0, 0, 0}).verdict, Verdict::intersecting);  // the same
    EXPECT_FALSE(ask({0, 0, 0}).contained);
  }
}

// No crossing, and no surface point that is certainly inside; turned about axes of symmetry, and inside out.
TEST(collide, equal_solids_in_one_place_intersect_and_only_touching_ones_never_do) {
  CollideOptions options = testing::verdict_only();
  options.tolerance = 1e-3;
  options.prove_contact = true;
  options.solid = true;
  oracle::TwinMesh body = oracle::meshes::octahedron(), out = body;
  for (auto& face : out.triangles) std::swap(face[1], face[2]);
  std::mt19937_64 random(41);
  for (const oracle::TwinMesh* second : {&body, &out}) {
    Pair pair(body, *second);
    for (int trial = 0; trial < 20; ++trial) {
      const Motion place = trial == 0 ? Motion() : testing::random_placement(random, {});
      for (const double turn : {0.0, 90.0, 180.0}) {
        const Motion turned = place * Motion::rotation_degrees({0, 0, 1}, turn);
        EXPECT_EQ(collide(pair.a.at(place), pair.b.at(turned), options).verdict, Verdict::intersecting)
            << trial << ' ' << turn;
      }
    }
  }
  // Octahedra with faces in one plane: points inside of each lie in the box around the other one.
  ControlMesh facets = testing::control_mesh(body);
  facets.tags.scheme = Scheme::flat;
  const Surface eight(facets);
  for (int trial = 0; trial < 50; ++trial) {
    const double x = static_cast<double>(random() % 9) / 8,
                 y = (1 - x) + x * static_cast<double>(random() % 9) / 8;
    const Motion beside = Motion::translation({x, y, 2 - x - y});
    EXPECT_NE(collide(eight, eight.at(beside), options).verdict, Verdict::intersecting) << trial;
  }
  // A box and its mirror image in one of its sides, and slid along it.
  ControlMesh box = testing::control_mesh(oracle::meshes::triangulated(oracle::meshes::cube()));
  box.tags.scheme = Scheme::flat;
  const Surface surface(box);
  const double side = surface.size();
  for (int trial = 0; trial < 200; ++trial) {
    std::array<double, 3> shift{};
    for (double& x : shift) x = side * static_cast<double>(static_cast<int>(random() % 9) - 4) / 4;
    const std::size_t axis = random() % 3;
    shift[axis] = random() % 2 == 0 ? side : -side;
    const Collision touching =
        collide(surface, surface.at(Motion::translation({shift[0], shift[1], shift[2]})), options);
    EXPECT_NE(touching.verdict, Verdict::intersecting) << trial;
    shift[axis] *= 0.75;
    const bool apart =
        std::fabs(shift[0]) >= side || std::fabs(shift[1]) >= side || std::fabs(shift[2]) >= side;
    const Collision deep =
        collide(surface, surface.at(Motion::translation({shift[0], shift[1], shift[2]})), options);
    if (!apart) {
      EXPECT_EQ(deep.verdict, Verdict::intersecting) << trial;
    }
  }
}

// Where the first split of a polygon meets a quad, the triangle over the middle of their edge belongs to the
// cycle whose winding number is taken: a ray that leaves through it counts it.
TEST(collide, edges_between_quads_and_polygons_are_closed) {
  for (const Scheme scheme : {Scheme::catmark, Scheme::doo_sabin, Scheme::midedge}) {
    oracle::TaggedMesh shape = oracle::meshes::prism(3);
    if (scheme != Scheme::catmark) shape.polygons = oracle::meshes::pyramid(4).polygons;
    if (scheme != Scheme::catmark) shape.points = oracle::meshes::pyramid(4).points;
    const Surface surface(testing::control_mesh(shape), {.scheme = scheme});
    const SurfaceBvh& model = surface.data()->bvh();
    ASSERT_FALSE(model.solid().fillers().empty()) << name_of(scheme);
    const PowerOfTwo back = model.surface().scale().inverse();
    for (const LimitTriangle& filler : model.solid().fillers()) {
      const auto& [a, b, m] = filler.corners;
      // Between the chord and the curve, and beyond the curve.
      const Point3 chord = a + 0.5 * (b - a);
      const Vector3 out = m - chord;
      EXPECT_EQ(contains(surface, back.apply(chord - 0.5 * out)), std::optional<bool>(true));
      EXPECT_EQ(contains(surface, back.apply(chord + 0.3 * out)), std::optional<bool>(true));
      EXPECT_EQ(contains(surface, back.apply(m + 2 * out)), std::optional<bool>(false));
    }
  }
}

TEST(collide, answers_the_same_with_tight_trees) {
  std::mt19937_64 random(31);
  std::vector<Motion> places;
  for (int i = 0; i < 60; ++i) {
    places.push_back(testing::random_placement(random, testing::random_vector(random, 2)));
  }
  for (const bool tight : {false, true}) {
    const Surface a = testing::public_surface(oracle::meshes::icosahedron(), {.tight = tight}),
                  b = testing::public_surface(oracle::meshes::bipyramid(7), {.tight = tight});
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Collision answer = collide(a, b.at(places[i]), testing::verdict_only());
      const Distance far = distance(a, b.at(places[i]), {1e-4, 0});
      ASSERT_NE(answer.verdict, Verdict::undecided) << i;
      EXPECT_EQ(far.outcome, Outcome::complete);
      EXPECT_EQ(answer.verdict == Verdict::separated, far.distance.lower > 0 || far.distance.upper > 1e-4)
          << i;
      EXPECT_LE(answer.distance.lower, far.distance.upper);
    }
  }
}

TEST(collide, refuses_a_model_without_surface) {
  const Surface nothing = testing::public_surface(oracle::meshes::grid(1, 1, oracle::Boundary::none));
  EXPECT_THROW(nothing.prepare(), InputError);
}

}  // namespace
}  // namespace snug::collide_test
