#include <snug/scene.h>

#include <cfloat>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>
#include <oracle/contact_twin.h>
#include <oracle/test_meshes.h>
#include <snug/search/surface_data.h>
#include <testing/counts.h>
#include <testing/placements.h>
#include <testing/scheme_surfaces.h>

namespace snug::scene_test {
namespace {

Surface surface_of(const oracle::TwinMesh& twin, double size = 1) {
  ControlMesh mesh;
  for (const oracle::Point& p : twin.points) mesh.points.push_back({size * p[0], size * p[1], size * p[2]});
  for (const auto& face : twin.triangles) {
    mesh.add_face(std::array{VertexId(face[0]), VertexId(face[1]), VertexId(face[2])});
  }
  return Surface(std::move(mesh), {}, {.threads = 1});
}

// The cube [0, 1]^3, its faces as they are.
Surface cube() {
  ControlMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.points.push_back({double(i & 1), double(i >> 1 & 1), double(i >> 2)});
  for (const auto& face : {std::array{0u, 2u, 3u, 1u},
                           {4u, 5u, 7u, 6u},
                           {0u, 1u, 5u, 4u},
                           {2u, 6u, 7u, 3u},
                           {0u, 4u, 6u, 2u},
                           {1u, 3u, 7u, 5u}}) {
    mesh.add_face(std::array{VertexId(face[0]), VertexId(face[1]), VertexId(face[2])});
    mesh.add_face(std::array{VertexId(face[0]), VertexId(face[2]), VertexId(face[3])});
  }
  return Surface(std::move(mesh), {.scheme = Scheme::flat}, {.threads = 1});
}

Scene random_scene(std::mt19937_64& random, std::size_t parts, double spread) {
  static const std::vector<Surface> shapes{surface_of(oracle::meshes::icosahedron()),
                                           surface_of(oracle::meshes::octahedron(), 0.3), cube(),
                                           surface_of(oracle::meshes::octahedron(), 1e-4)};
  Scene scene;
  for (std::size_t i = 0; i < parts; ++i) {
    scene.parts.emplace_back(shapes[random() % shapes.size()],
                             testing::random_placement(random, testing::random_vector(random, spread)));
  }
  return scene;
}

std::vector<PartPair> pairs_of(const Scene& scene) {
  if (scene.pairs) return *scene.pairs;
  std::vector<PartPair> pairs;
  for (std::uint32_t a = 0; a < scene.parts.size(); ++a) {
    for (std::uint32_t b = a + 1; b < scene.parts.size(); ++b) pairs.push_back({a, b});
  }
  return pairs;
}

double margin_of(const Scene& scene, const PartPair& pair, double margin) {
  for (const PairMargin& own : scene.margins) {
    if (own.parts == pair || own.parts == PartPair{pair.b, pair.a}) return own.margin;
  }
  return margin;
}

bool same(const Collision& x, const Collision& y) {
  const SearchStats &s = x.stats, &t = y.stats;
  return x.verdict == y.verdict && x.distance == y.distance && x.witness == y.witness &&
         x.contained == y.contained && x.outcome == y.outcome && s.box_tests == t.box_tests &&
         s.triangle_tests == t.triangle_tests && s.evaluations == t.evaluations && s.splits == t.splits;
}

// Every pair by itself, with no broad phase.
void expect_all_pairs(const Scene& scene, const CollideOptions& options, const Run& run) {
  std::vector<PairCollision> found;
  const SceneCounts counts = collide(
      scene, options, [&](const PairCollision& pair) { found.push_back(pair); }, run);
  std::size_t next = 0;
  SceneCounts expected;
  for (const PartPair& pair : pairs_of(scene)) {
    CollideOptions own = options;
    own.margin = margin_of(scene, pair, options.margin);
    const Collision answer = collide(scene.parts[pair.a], scene.parts[pair.b], own, run);
    ++expected.pairs;
    if (next < found.size() && found[next].parts == pair) {
      ASSERT_TRUE(same(found[next].answer, answer)) << pair.a << ' ' << pair.b;
      ++next;
      ++(answer.verdict == Verdict::separated      ? expected.separated
         : answer.verdict == Verdict::within       ? expected.within
         : answer.verdict == Verdict::intersecting ? expected.intersecting
                                                   : expected.undecided);
    } else {
      ASSERT_EQ(answer.verdict, Verdict::separated) << pair.a << ' ' << pair.b;
      ++expected.separated_by_boxes;
    }
  }
  ASSERT_EQ(next, found.size());
  EXPECT_EQ(counts.pairs, expected.pairs);
  EXPECT_EQ(counts.separated_by_boxes, expected.separated_by_boxes);
  EXPECT_EQ(counts.separated, expected.separated);
  EXPECT_EQ(counts.within, expected.within);
  EXPECT_EQ(counts.intersecting, expected.intersecting);
  EXPECT_EQ(counts.undecided, expected.undecided);
}

TEST(scene, answers_as_every_pair_by_itself) {
  std::mt19937_64 random(81);
  for (const double spread : {0.5, 3.0, 30.0, 1e12}) {
    for (const bool listed : {false, true}) {
      for (const double margin : {0.0, 0.4}) {
        Scene scene = random_scene(random, 24, spread);
        if (listed) {
          scene.pairs.emplace();
          for (int i = 0; i < 100; ++i) {
            const auto a = static_cast<std::uint32_t>(random() % 24);
            scene.pairs->push_back({a, static_cast<std::uint32_t>((a + 1 + random() % 23) % 24)});
          }
        }
        std::set<std::pair<std::uint32_t, std::uint32_t>> named;
        for (int i = 0; i < 8; ++i) {
          const auto a = static_cast<std::uint32_t>(random() % 23);
          if (!named.emplace(a, 23).second) continue;
          const PartPair pair = i % 2 == 0 ? PartPair{a, 23} : PartPair{23, a};
          scene.margins.push_back({pair, i % 3 == 0 ? 0 : spread});
        }
        for (const bool solid : {false, true}) {
          expect_all_pairs(scene, {.tolerance = 0.01, .margin = margin, .solid = solid},
                           {.threads = 1 + int(random() % 3), .max_splits = 500});
          if (HasFatalFailure()) return;
        }
      }
    }
  }
}

// Surfaces of every scheme, tagged and plain, some of them as large and as small as doubles go.
std::vector<Surface> surfaces_of_every_sort(std::uint64_t seed) {
  std::vector<Surface> surfaces;
  testing::for_each_surface(seed, [&](const testing::NamedSurface& named) {
    constexpr double sizes[] = {1, 1, 1, 1e-3, 1e3, 0x1p-1040, 1e-300, 1e-160, 1e160, 1e300};
    ControlMesh mesh = named.surface.mesh();
    const double size = sizes[surfaces.size() % std::size(sizes)];
    for (Point3& p : mesh.points) p = {size * p.x, size * p.y, size * p.z};
    try {
      const Surface surface(
          std::move(mesh),
          {.scheme = named.surface.options().scheme, .boundary = named.surface.options().boundary},
          {.threads = 1});
      static_cast<void>(surface.data()->bvh());
      surfaces.push_back(surface);
    } catch (const InputError&) {
      // No face has a limit surface.
    }
  });
  return surfaces;
}

// A turn that is rigid to 1e-9 and no better, at times with entries of every size.
Motion slack_placement(std::mt19937_64& random, const Vector3& to) {
  if (random() % 4 == 0) {
    constexpr double specks[] = {0, -0.0, 5e-324, -1e-300, 1e-40, 1e-12, -3e-10};
    const auto speck = [&] { return specks[random() % std::size(specks)]; };
    return Motion::from_3x4(
        {1, speck(), speck(), to.x, speck(), -1, speck(), to.y, speck(), speck(), -1, to.z});
  }
  std::array<double, 12> numbers = testing::random_placement(random, to).numbers();
  for (std::size_t k = 0; k < 12; ++k) {
    if (k % 4 != 3) numbers[k] += testing::random_vector(random, 2e-10).x;
  }
  return Motion::from_3x4(numbers);
}

// All pairs of surfaces meet in the course of the trials: schemes, tags, sizes, copies in one place, margins.
TEST(scene, answers_as_every_pair_by_itself_whatever_the_parts_are) {
  const std::vector<Surface> surfaces = surfaces_of_every_sort(85);
  ASSERT_GT(surfaces.size(), testing::fewer(100));
  std::mt19937_64 random(86);
  for (int trial = 0; trial < static_cast<int>(testing::fewer(40)); ++trial) {
    constexpr double spreads[] = {0, 1e-3, 1, 3, 20, 1e9, 1e160, 1e300};
    const double spread = spreads[random() % std::size(spreads)];
    Scene scene;
    for (int i = 0; i < 24; ++i) {
      const Surface& surface = surfaces[random() % surfaces.size()];
      scene.parts.push_back(
          i > 0 && random() % 4 == 0
              ? scene.parts[random() % scene.parts.size()]
              : surface.at(slack_placement(random, testing::random_vector(random, spread))));
    }
    constexpr double margins[] = {0, 0, 0.1, 1e-300, 1e300};
    for (std::uint32_t a = 0; a + 1 < 24; a += 2) {
      if (random() % 3 == 0) scene.margins.push_back({{a + 1, a}, margins[random() % std::size(margins)]});
    }
    const CollideOptions options{.tolerance = trial % 3 == 0 ? 0.1 : 1e-3,
                                 .margin = margins[random() % std::size(margins)],
                                 .prove_contact = trial % 2 == 0,
                                 .measure = trial % 5 != 0};
    expect_all_pairs(scene, options, {.threads = 1 + int(random() % 2), .max_splits = 60});
    if (HasFatalFailure()) FAIL() << trial << ' ' << spread;
  }
}

TEST(scene, distances_are_those_of_every_pair_by_itself) {
  std::mt19937_64 random(82);
  const Scene scene = random_scene(random, 30, 3);
  const DistanceOptions options{.absolute = 1e-3};
  for (const double limit : {0.0, 0.7, 1e3}) {
    std::size_t next = 0;
    std::vector<PairDistance> found;
    const SceneCounts counts = distance(
        scene, limit, options, [&](const PairDistance& pair) { found.push_back(pair); }, {.threads = 2});
    for (const PartPair& pair : pairs_of(scene)) {
      const Distance answer = distance(scene.parts[pair.a], scene.parts[pair.b], options);
      if (next < found.size() && found[next].parts == pair) {
        EXPECT_EQ(found[next].answer.distance, answer.distance);
        EXPECT_EQ(found[next++].answer.witness, answer.witness);
      } else {
        EXPECT_GT(answer.distance.upper, limit);
      }
    }
    EXPECT_EQ(next, found.size());
    EXPECT_EQ(counts.within + counts.intersecting, found.size());
    EXPECT_EQ(counts.pairs, counts.separated_by_boxes + counts.separated + found.size());
    if (limit == 1e3) {
      EXPECT_EQ(found.size(), counts.pairs);
    }
  }
}

// Distances that equal a margin are not above it. All numbers here are exact.
TEST(scene, one_pair_is_answered_with_its_margin_and_named) {
  const Scene scene{
      {cube(), cube().at(Motion::translation({1.5, 0, 0})), cube().at(Motion::translation({9e307, 0, 0}))}};
  EXPECT_EQ(collide(scene, {{0, 1}, 0, 0}).verdict, Verdict::separated);
  EXPECT_EQ(collide(scene, {{0, 1}, 0.6, 0}).verdict, Verdict::within);
  EXPECT_FALSE(distance(scene, {{0, 1}, 0.4, 0}).has_value());
  for (const PartPair& parts : {PartPair{0, 3}, PartPair{7, 0}, PartPair{1, 1}}) {
    EXPECT_THROW(static_cast<void>(collide(scene, {parts, 0, 0})), InputError);
    EXPECT_THROW(static_cast<void>(distance(scene, {parts, 0, 0})), InputError);
  }
  EXPECT_TRUE(distance(scene, {{0, 1}, 0.5, 0}, {.absolute = 1e-6}).value().distance.contains(0.5));
  try {
    static_cast<void>(collide(scene, {{0, 1}, -1, 0}));
    ADD_FAILURE() << "a negative margin was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("parts 0 and 1"), std::string::npos) << error.what();
  }
}

TEST(broad_phase, deals_out_parts_whose_distance_is_the_margin) {
  const Surface shape = cube();
  const double places[] = {0, 1, 2.25, -3, 1024};
  for (const double x : places) {
    for (const double y : places) {
      for (const double z : places) {
        const double gaps[] = {std::max(std::fabs(x) - 1, 0.0), std::max(std::fabs(y) - 1, 0.0),
                               std::max(std::fabs(z) - 1, 0.0)};
        // The distance of both cubes, where it is a double.
        double margin = 0;
        int axes = 0;
        for (const double gap : gaps) {
          margin += gap;
          axes += gap > 0 ? 1 : 0;
        }
        if (axes > 1) continue;
        Scene scene{{shape, shape.at(Motion::translation({x, y, z}))}};
        EXPECT_EQ(SceneBroadPhase(scene, margin).next(1).size(), 1u) << x << ' ' << y << ' ' << z;
        scene.margins = {{{1, 0}, margin}};
        EXPECT_EQ(SceneBroadPhase(scene, 0).next(1).size(), 1u) << x << ' ' << y << ' ' << z;
        if (margin == 0) continue;
        scene.margins = {{{1, 0}, 0}};
        EXPECT_EQ(SceneBroadPhase(scene, margin).next(1).size(), 0u) << x << ' ' << y << ' ' << z;
        EXPECT_EQ(SceneBroadPhase(scene, margin, true).next(1).size(), 1u);
      }
    }
  }
}

// All pairs of the cases that the boxes distinguish, against distances found by others.
TEST(broad_phase, separates_nothing_that_the_twins_know_to_be_near) {
  std::mt19937_64 random(83);
  const std::vector<oracle::TwinMesh> meshes{oracle::meshes::icosahedron(), oracle::meshes::octahedron()};
  std::vector<Surface> surfaces;
  std::vector<std::unique_ptr<oracle::ContactSurface>> twins;
  for (const double size : {1e-6, 1.0, 1e6}) {
    for (oracle::TwinMesh mesh : meshes) {
      surfaces.push_back(surface_of(mesh, size));
      for (oracle::Point& p : mesh.points) {
        for (double& x : p) x *= size;
      }
      twins.push_back(std::make_unique<oracle::ContactSurface>(mesh));
    }
  }
  std::size_t near = 0, apart = 0;
  for (int trial = 0; trial < static_cast<int>(testing::fewer(1500)); ++trial) {
    // Every pair of sizes and of turns, and every place.
    const std::size_t cases[] = {static_cast<std::size_t>(trial % 3),
                                 static_cast<std::size_t>(trial / 3 % 3)};
    const int turns[] = {trial / 9 % 3, trial / 27 % 3}, place = trial / 81 % 3;
    std::size_t names[2];
    Motion poses[2];
    double reach = 0;
    for (std::size_t side = 0; side < 2; ++side) {
      names[side] = 2 * cases[side] + random() % 2;
      reach += surfaces[names[side]].size();
      if (turns[side] == 1) poses[side] = Motion::rotation_degrees({0, 1, 0}, 90);
      if (turns[side] == 2) poses[side] = testing::random_placement(random, {});
    }
    const Vector3 origin = place == 2 ? testing::random_vector(random, 1e12) : Vector3{};
    poses[0] = poses[0].with_offset(origin);
    const Vector3 away = testing::random_vector(random, place == 0 ? 0 : reach);
    poses[1] = poses[1].with_offset({origin.x + away.x, origin.y + away.y, origin.z + away.z});
    Scene scene{{surfaces[names[0]].at(poses[0]), surfaces[names[1]].at(poses[1])}};
    const double margin = trial % 2 == 0 ? 0 : 0.2 * reach;
    const std::vector<ScenePair> dealt = SceneBroadPhase(scene, margin, true).next(1);
    ASSERT_EQ(dealt.size(), 1u);
    oracle::Placement places[2];
    for (std::size_t side = 0; side < 2; ++side) {
      const auto& numbers = poses[side].numbers();
      std::copy(numbers.begin(), numbers.end(), places[side].begin());
    }
    // The twins measure where numbers are small: both surfaces moved by the same exact vector.
    for (std::size_t axis = 0; axis < 3; ++axis) {
      places[1][4 * axis + 3] -= places[0][4 * axis + 3];
      places[0][4 * axis + 3] = 0;
    }
    const oracle::ContactBounds truth = oracle::contact_bounds(
        *twins[names[0]], places[0], *twins[names[1]], places[1], {.precision = {1e-3 * reach, 0.05}});
    ASSERT_LE(dealt[0].gap, truth.upper) << trial;
    const bool dealt_out = !SceneBroadPhase(scene, margin).next(1).empty();
    ASSERT_EQ(dealt_out, !dealt[0].separated_by_boxes());
    if (truth.upper <= margin) {
      ASSERT_TRUE(dealt_out) << trial;
      ++near;
    }
    apart += dealt_out ? 0u : 1u;
  }
  EXPECT_GT(near, testing::fewer(100));
  EXPECT_GT(apart, testing::fewer(100));
}

TEST(broad_phase, deals_out_all_of_a_thousand_equal_parts) {
  Scene scene;
  scene.parts.assign(1000, cube());
  SceneBroadPhase pairs(scene);
  std::uint32_t a = 0, b = 1;
  std::uint64_t count = 0;
  while (true) {
    const std::vector<ScenePair> batch = pairs.next(1000);
    if (batch.empty()) break;
    EXPECT_LT(batch.size(), 200'000u);
    for (const ScenePair& pair : batch) {
      ASSERT_EQ(pair.parts, (PartPair{a, b}));
      ++count;
      if (++b == 1000) b = ++a + 1;
    }
  }
  EXPECT_EQ(count, pairs.pair_count());
  EXPECT_EQ(pairs.share(), 1);
}

// Half a million pairs in one place, of which no two kinds differ but in margins, sides and signs of zero.
TEST(scene, a_thousand_equal_parts_are_answered_soon) {
  const Surface shape = surface_of(oracle::meshes::icosahedron());
  Scene scene;
  scene.parts.assign(1000, shape);
  scene.parts[500] = shape.at(Motion::translation({0.1, 0, 0}));
  scene.parts[600] = shape.at(Motion::translation({-0.0, 0, 0}));
  scene.margins = {{{3, 4}, 0.5}};
  const CollideOptions options{.tolerance = 1e-3};
  std::map<std::array<int, 3>, Collision> kinds;
  const auto kind_of = [](const PartPair& parts) {
    const auto place = [](std::uint32_t part) { return part == 500 ? 1 : part == 600 ? 2 : 0; };
    return std::array{place(parts.a), place(parts.b), parts == PartPair{3, 4} ? 1 : 0};
  };
  std::uint64_t seen = 0;
  const SceneCounts counts =
      collide(scene, options,
              [&](const PairCollision& pair) {
                const auto [known, fresh] = kinds.try_emplace(kind_of(pair.parts));
                if (fresh) {
                  CollideOptions own = options;
                  if (known->first[2] != 0) own.margin = 0.5;
                  known->second = collide(scene.parts[pair.parts.a], scene.parts[pair.parts.b], own);
                }
                if (same(pair.answer, known->second)) ++seen;
              },
              {.threads = 2});
  EXPECT_EQ(kinds.size(), 7u);
  EXPECT_EQ(seen, 499'500u);
  EXPECT_EQ(counts.pairs, seen);
  EXPECT_EQ(counts.separated_by_boxes + counts.separated + counts.undecided, 0u);
  std::uint64_t near = 0;
  const SceneCounts distances =
      distance(scene, 0.5, {.absolute = 1e-3}, [&](const PairDistance&) { ++near; }, {.threads = 2});
  EXPECT_EQ(near, 499'500u);
  EXPECT_EQ(distances.within + distances.intersecting, near);
}

TEST(broad_phase, does_not_depend_on_threads) {
  std::mt19937_64 random(84);
  const Scene scene = random_scene(random, 3000, 20);
  const auto all = [&](int threads) {
    SceneBroadPhase pairs(scene, 0.1, false, {.threads = threads});
    std::vector<PartPair> result;
    for (std::vector<ScenePair> batch; !(batch = pairs.next(777)).empty();) {
      for (const ScenePair& pair : batch) result.push_back(pair.parts);
    }
    return result;
  };
  const std::vector<PartPair> expected = all(1);
  EXPECT_GT(expected.size(), 1000u);
  EXPECT_EQ(all(2), expected);
  EXPECT_EQ(all(3), expected);
}

TEST(scene, of_no_part_one_part_and_no_pairs_is_answered) {
  Scene scene;
  const auto none = [](const PairCollision&) { FAIL(); };
  EXPECT_EQ(collide(scene, {}, none).pairs, 0u);
  scene.parts.emplace_back(cube());
  EXPECT_EQ(collide(scene, {}, none).pairs, 0u);
  scene.parts.emplace_back(cube());
  scene.pairs.emplace();
  EXPECT_EQ(collide(scene, {}, none).pairs, 0u);
}

std::string refusal(const Scene& scene, double margin = 0) {
  try {
    static_cast<void>(SceneBroadPhase(scene, margin));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(scene, names_the_pair_margin_or_part_that_is_wrong) {
  Scene scene{{cube(), cube(), cube()}};
  EXPECT_NE(refusal(scene, -1).find("margin"), std::string::npos);
  EXPECT_NE(refusal(scene, NAN).find("margin"), std::string::npos);
  scene.pairs = {{0, 1}, {2, 3}};
  EXPECT_NE(refusal(scene).find("pairs[1]: there is no part 3; the scene has 3"), std::string::npos);
  scene.pairs = {{1, 1}};
  EXPECT_NE(refusal(scene).find("pairs[0]: part 1 with itself"), std::string::npos);
  scene.pairs.reset();
  scene.margins = {{{0, 1}, 1}, {{1, 0}, 2}};
  EXPECT_NE(refusal(scene).find("parts 0 and 1 have two"), std::string::npos);
  scene.margins = {{{0, 1}, INFINITY}};
  EXPECT_NE(refusal(scene).find("margins[0]"), std::string::npos);
  scene.margins.clear();
  ControlMesh open = cube().mesh();
  open.face_offsets.pop_back();
  open.face_vertices.resize(open.face_offsets.back());
  scene.parts.emplace_back(Surface(open, {.scheme = Scheme::flat}));
  try {
    collide(scene, {.solid = true}, [](const PairCollision&) {}, {.threads = 1});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("parts 0 and 3"), std::string::npos) << error.what();
  }
}

TEST(scene, ends_where_the_sink_throws_or_a_stop_is_requested) {
  Scene scene;
  scene.parts.assign(40, cube());
  int taken = 0;
  EXPECT_THROW(collide(scene, {},
                       [&](const PairCollision&) {
                         if (++taken == 5) throw std::runtime_error("full");
                       },
                       {.threads = 2}),
               std::runtime_error);
  EXPECT_EQ(taken, 5);
  const std::atomic<bool> stop{true};
  const WorkMonitor monitor{.on_progress = {}, .stop = &stop};
  EXPECT_THROW(collide(scene, {}, [](const PairCollision&) { FAIL(); }, {.threads = 2, .monitor = &monitor}),
               Interrupted);
}

}  // namespace
}  // namespace snug::scene_test
