// self_contact(): clear, crossing, touching and collapsed shapes; what does not change the answer.

#include <snug/contacts.h>

#include <gtest/gtest.h>
#include <oracle/hull_twin.h>
#include <oracle/tagged_shapes.h>
#include <oracle/test_meshes.h>
#include <snug/run.h>
#include <testing/closed_meshes.h>
#include <testing/tagged.h>
#include <testing/twins.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <string>

namespace snug::self_test {
namespace {

namespace meshes = oracle::meshes;

SelfContact ask(const oracle::TaggedMesh& mesh, Scheme scheme, const SelfContactOptions& options = {},
                const Run& run = {}) {
  return self_contact(Surface(testing::control_mesh(mesh), {.scheme = scheme}), options, run);
}

// A tube around a figure of eight that passes itself at this height; radius 0.3, or less.
oracle::TaggedMesh eight(double height, bool triangles, double radius = 0.3) {
  constexpr std::uint32_t m = 32, n = 6;
  oracle::TaggedMesh mesh;
  for (std::uint32_t i = 0; i < m; ++i) {
    const double t = 2 * std::numbers::pi * i / m;
    const double dx = 3 * std::cos(t), dy = 4 * std::cos(2 * t), size = std::hypot(dx, dy);
    for (std::uint32_t j = 0; j < n; ++j) {
      const double s = 2 * std::numbers::pi * j / n;
      const double out = radius * std::cos(s), up = radius * std::sin(s);
      mesh.points.push_back({3 * std::sin(t) + out * dy / size, 2 * std::sin(2 * t) - out * dx / size,
                             0.5 * height * std::cos(t) + up});
      const std::uint32_t k = (i + 1) % m, l = (j + 1) % n;
      const std::uint32_t a = i * n + j, b = k * n + j, c = k * n + l, d = i * n + l;
      if (triangles) {
        mesh.polygons.push_back({a, b, c});
        mesh.polygons.push_back({a, c, d});
      } else {
        mesh.polygons.push_back({a, b, c, d});
      }
    }
  }
  return mesh;
}

oracle::TaggedMesh both(oracle::TaggedMesh a, const oracle::TaggedMesh& b, double dx) {
  const auto first = static_cast<std::uint32_t>(a.points.size());
  for (auto p : b.points) {
    p[0] += dx;
    a.points.push_back(p);
  }
  for (auto face : b.polygons) {
    for (auto& v : face) v += first;
    a.polygons.push_back(face);
  }
  return a;
}

std::vector<Scheme> schemes_of(const oracle::TaggedMesh& mesh) {
  std::vector<Scheme> schemes{Scheme::catmark, Scheme::doo_sabin, Scheme::midedge};
  if (std::all_of(mesh.polygons.begin(), mesh.polygons.end(), [](const auto& f) { return f.size() == 3; }))
    schemes.push_back(Scheme::loop);
  return schemes;
}

TEST(self_contact, round_shapes_of_every_valence_are_clear) {
  for (std::uint32_t n = 3; n <= 9; ++n) {
    oracle::TaggedMesh bipyramid;
    bipyramid.points = {{0, 0, 1}, {0, 0, -1}};
    for (std::uint32_t i = 0; i < n; ++i) {
      const double t = 2 * std::numbers::pi * i / n;
      bipyramid.points.push_back({std::cos(t), std::sin(t), 0});
      bipyramid.polygons.push_back({0, 2 + i, 2 + (i + 1) % n});
      bipyramid.polygons.push_back({1, 2 + (i + 1) % n, 2 + i});
    }
    const SelfContact round = ask(bipyramid, Scheme::loop);
    EXPECT_EQ(round.verdict, SelfVerdict::clear) << "bipyramid " << n;
    EXPECT_TRUE(round.pairs.empty());
    EXPECT_EQ(ask(meshes::prism(n), Scheme::catmark).verdict, SelfVerdict::clear) << "prism " << n;
  }
  EXPECT_EQ(ask(meshes::cube(), Scheme::catmark).verdict, SelfVerdict::clear);
}

TEST(self_contact, tubes_cross_where_they_meet) {
  for (const bool triangles : {false, true}) {
    for (const double height : {0.0, 0.1, 0.3, 0.9, 1.5}) {
      const oracle::TaggedMesh mesh = eight(height, triangles);
      for (const Scheme scheme : schemes_of(mesh)) {
        if (triangles && scheme != Scheme::loop) continue;
        const SelfContact found = ask(mesh, scheme);
        const std::string name = std::string(name_of(scheme)) + " at " + std::to_string(height);
        if (height < 0.5) {
          EXPECT_EQ(found.verdict, SelfVerdict::intersecting) << name;
          ASSERT_FALSE(found.pairs.empty());
          const SelfContactPair& pair = found.pairs.front();
          EXPECT_LT(std::hypot(pair.points[0].point.x, pair.points[0].point.y), 1) << name;
          EXPECT_LT(length(pair.points[1].point - pair.points[0].point), 0.2) << name;
          EXPECT_EQ(pair.distance.upper, 0) << name;
        } else if (scheme != Scheme::doo_sabin && scheme != Scheme::midedge) {
          EXPECT_EQ(found.verdict, SelfVerdict::clear) << name;
        } else {
          EXPECT_NE(found.verdict, SelfVerdict::intersecting) << name;
        }
      }
    }
  }
}

TEST(self_contact, of_faces_that_all_have_common_corners_is_found_among_their_children) {
  // One point of a double tetrahedron is pulled sideways through the other half.
  oracle::TaggedMesh mesh;
  mesh.points = {{0, 0, 1}, {0, 0, -1}};
  for (std::uint32_t i = 0; i < 3; ++i) {
    const double t = 2 * std::numbers::pi * i / 3;
    mesh.points.push_back({std::cos(t), std::sin(t), 0});
    mesh.polygons.push_back({0, 2 + i, 2 + (i + 1) % 3});
    mesh.polygons.push_back({1, 2 + (i + 1) % 3, 2 + i});
  }
  EXPECT_EQ(ask(mesh, Scheme::loop).verdict, SelfVerdict::clear);
  mesh.points[0] = {6, 0, -1.6};
  EXPECT_EQ(ask(mesh, Scheme::loop).verdict, SelfVerdict::intersecting);
}

TEST(self_contact, two_bodies_in_each_other_apart_or_in_one_place) {
  const oracle::TaggedMesh cube = meshes::cube();
  for (const Scheme scheme : schemes_of(cube)) {
    EXPECT_EQ(ask(both(cube, cube, 0.3), scheme).verdict, SelfVerdict::intersecting) << name_of(scheme);
    EXPECT_NE(ask(both(cube, cube, 1.3), scheme).verdict, SelfVerdict::intersecting) << name_of(scheme);
    EXPECT_NE(ask(both(cube, cube, 0), scheme, {}, {.max_splits = 20'000}).verdict, SelfVerdict::clear)
        << name_of(scheme);
  }
  EXPECT_EQ(ask(both(cube, cube, 1.3), Scheme::catmark).verdict, SelfVerdict::clear);
}

TEST(self_contact, what_touches_is_never_clear) {
  // Sharp cubes side by side touch in a face, shifted ones in an edge or a vertex.
  oracle::TaggedMesh cube = meshes::cube();
  for (const auto& face : meshes::cube().polygons) {
    for (std::size_t k = 0; k < 4; ++k) cube.creases.push_back({face[k], face[(k + 1) % 4], 10});
  }
  for (const auto& [dy, dz] :
       {std::pair{0.0, 0.0}, std::pair{0.5, 0.0}, std::pair{1.0, 0.0}, std::pair{1.0, 1.0}}) {
    oracle::TaggedMesh other = cube;
    for (auto& p : other.points) {
      p[1] += dy;
      p[2] += dz;
    }
    oracle::TaggedMesh pair = both(cube, other, 1);
    for (auto crease : cube.creases) {
      crease.a += 8;
      crease.b += 8;
      pair.creases.push_back(crease);
    }
    EXPECT_NE(ask(pair, Scheme::catmark, {}, {.max_splits = 20'000}).verdict, SelfVerdict::clear)
        << dy << " " << dz;
  }
}

TEST(self_contact, collapsed_meshes_are_undecided_and_pinched_ones_are_clear) {
  oracle::TaggedMesh point = meshes::cube(), flat = point;
  for (auto& p : point.points) p = {1, 1, 1};
  for (auto& p : flat.points) p[2] = 0;
  for (const Scheme scheme : schemes_of(point)) {
    EXPECT_EQ(ask(point, scheme, {}, {.max_splits = 2000}).verdict, SelfVerdict::undecided)
        << name_of(scheme);
    EXPECT_NE(ask(flat, scheme, {}, {.max_splits = 20'000}).verdict, SelfVerdict::clear) << name_of(scheme);
  }
  EXPECT_EQ(ask(meshes::two_cubes_at_a_vertex(), Scheme::catmark).verdict, SelfVerdict::clear);
  EXPECT_EQ(ask(meshes::cells({{0, 0, 0}, {1, 1, 0}}), Scheme::catmark).verdict, SelfVerdict::clear);
  EXPECT_EQ(ask(meshes::cells({{0, 0, 0}, {0, 0, 1}, {1, 1, 0}, {1, 1, 1}}), Scheme::catmark).verdict,
            SelfVerdict::clear);
  EXPECT_NE(ask(meshes::back_to_back(), Scheme::catmark, {}, {.max_splits = 20'000}).verdict,
            SelfVerdict::clear);
}

// Edges that three faces and more have, and two that run along them the same way.
TEST(self_contact, edges_that_are_not_manifold_are_decided) {
  for (const std::uint32_t pages : {3U, 4U}) {
    EXPECT_EQ(ask(meshes::book(pages), Scheme::catmark).verdict, SelfVerdict::clear) << pages;
    EXPECT_EQ(ask(meshes::triangulated(meshes::book(pages)), Scheme::loop).verdict, SelfVerdict::clear)
        << pages;
  }
  EXPECT_EQ(ask(meshes::moebius(9), Scheme::catmark).verdict, SelfVerdict::clear);
}

// Two faces with one vertex in common, in one plane, one turned against the other: they overlap, though each one's
// angle at the vertex would follow the other's in a fan.
TEST(self_contact, faces_that_only_have_a_vertex_in_common_are_no_fan) {
  for (const Scheme scheme : {Scheme::catmark, Scheme::loop}) {
    for (const double turn : {20.0, 60.0, 80.0, 100.0, 170.0}) {
      for (const bool swapped : {false, true}) {
        oracle::TaggedMesh mesh;
        mesh.points.push_back({0, 0, 0});
        for (const double first : {0.0, turn}) {
          for (const double degrees : {0.0, 45.0, 90.0}) {
            const double t = (first + degrees) * std::numbers::pi / 180,
                         size = degrees == 45 ? std::sqrt(2) : 1;
            mesh.points.push_back({size * std::cos(t), size * std::sin(t), 0});
          }
        }
        for (const std::uint32_t face : {swapped ? 1u : 0u, swapped ? 0u : 1u}) {
          const std::uint32_t a = 1 + 3 * face;
          if (scheme == Scheme::loop) {
            mesh.polygons.push_back({0, a, a + 2});
          } else {
            mesh.polygons.push_back({0, a, a + 1, a + 2});
          }
        }
        // As they are these are facets; quads that are bent are not.
        const SelfVerdict of_facets = turn < 90 ? SelfVerdict::intersecting : SelfVerdict::clear;
        EXPECT_EQ(ask(mesh, scheme, {}, {.max_splits = 20'000}).verdict, of_facets)
            << name_of(scheme) << " turned by " << turn;
        if (scheme == Scheme::loop) continue;
        for (const std::size_t middle : {2, 5}) mesh.points[middle][2] = 0.25;
        const SelfVerdict verdict = ask(mesh, scheme, {}, {.max_splits = 20'000}).verdict;
        if (turn < 90) {
          EXPECT_NE(verdict, SelfVerdict::clear) << name_of(scheme) << " turned by " << turn;
        } else {
          EXPECT_EQ(verdict, SelfVerdict::clear) << name_of(scheme) << " turned by " << turn;
        }
      }
    }
  }
}

TEST(self_contact, does_not_depend_on_threads_scale_or_place) {
  for (const double height : {0.1, 1.5}) {
    const oracle::TaggedMesh mesh = eight(height, true);
    const SelfContact one = ask(mesh, Scheme::loop, {}, {.threads = 1});
    const SelfContact four = ask(mesh, Scheme::loop, {}, {.threads = 4});
    EXPECT_EQ(one.verdict, four.verdict);
    EXPECT_EQ(one.stars, four.stars);
    EXPECT_EQ(one.pair_tests, four.pair_tests);
    ASSERT_EQ(one.pairs.size(), four.pairs.size());
    for (std::size_t i = 0; i < one.pairs.size(); ++i) EXPECT_EQ(one.pairs[i].points, four.pairs[i].points);
    for (const double scale : {0x1p-600, 0x1p600}) {
      oracle::TaggedMesh scaled = mesh;
      for (auto& p : scaled.points) {
        for (double& x : p) x *= scale;
      }
      EXPECT_EQ(ask(scaled, Scheme::loop).verdict, one.verdict);
    }
  }
}

TEST(self_contact, refuses_what_it_cannot_do) {
  EXPECT_THROW(static_cast<void>(ask(meshes::cube(), Scheme::catmark, {.levels = 21})), InputError);
  const Surface none(testing::control_mesh(meshes::quad_grid(1, 1)),
                     {.scheme = Scheme::catmark, .boundary = BoundaryRule::none});
  EXPECT_THROW(static_cast<void>(self_contact(none)), InputError);
  // Without a budget nothing is decided.
  const SelfContact nothing = ask(meshes::cube(), Scheme::catmark, {}, {.max_splits = 0});
  EXPECT_EQ(nothing.verdict, SelfVerdict::undecided);
  EXPECT_EQ(nothing.outcome, Outcome::budget_spent);
}

// All in one point: no level proves anything.
TEST(self_contact, outcomes_say_whether_a_larger_budget_helps) {
  oracle::TaggedMesh cube = meshes::cube();
  const SelfContact budget = ask(cube, Scheme::catmark, {.within = 0.2}, {.max_splits = 300});
  EXPECT_EQ(budget.verdict, SelfVerdict::undecided);
  EXPECT_EQ(budget.outcome, Outcome::budget_spent);
  EXPECT_EQ(ask(cube, Scheme::catmark, {.within = 0.2}).outcome, Outcome::complete);
  for (auto& p : cube.points) p = {1, 1, 1};
  for (const std::uint64_t splits : {1'000'000u, 10'000'000u}) {
    const SelfContact levels = ask(cube, Scheme::catmark, {.levels = 1}, {.max_splits = splits});
    EXPECT_EQ(levels.verdict, SelfVerdict::undecided);
    EXPECT_EQ(levels.outcome, Outcome::at_rounding);
  }
}

// Two pyramids with a common apex meet there alone, as one vertex does; turned into each other they do elsewhere, too.
TEST(self_contact, of_pyramids_with_a_common_apex_is_clear_unless_they_meet_elsewhere) {
  oracle::TaggedMesh pyramids;
  for (const bool bent : {false, true}) {
    for (const double height : {-1.0, 0.25}) {
      pyramids.points = {{0, 0, 0},      {1, 1, 1},       {-1, 1, 1},       {-1, -1, 1},    {1, -1, 1},
                         {1, 1, height}, {-1, 1, height}, {-1, -1, height}, {1, -1, height}};
      pyramids.polygons = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}, {4, 3, 2, 1},
                           {0, 6, 5}, {0, 7, 6}, {0, 8, 7}, {0, 5, 8}, {5, 6, 7, 8}};
      if (bent) {
        pyramids.points[1][2] = 1.25;
        pyramids.points[5][2] = 1.25 * height;
        // Only sharp tips.
        pyramids.corners = {{0, 10}};
      }
      const SelfVerdict verdict = ask(pyramids, Scheme::catmark, {}, {.max_splits = 100'000}).verdict;
      if (height < 0) {
        EXPECT_EQ(verdict, SelfVerdict::clear) << bent;
      } else {
        EXPECT_NE(verdict, SelfVerdict::clear) << bent;
      }
    }
  }
}

// A flat sheet whose middle vertex is the tip of another one. Alone it is sharp there, and folds unless it is in balance; no plane has the
// tip on its one side, and the sheet but for the vertex on the other.
TEST(self_contact, of_a_flat_sheet_and_a_tip_at_one_vertex_is_decided_in_balance) {
  for (const Scheme scheme : {Scheme::catmark, Scheme::loop}) {
    const std::uint32_t n = scheme == Scheme::loop ? 6 : 4;
    const auto sheets = [&](double height) {
      // Lattices: each ring has its vertex as the mean.
      const std::array<std::array<double, 2>, 6> hexagon{
          {{2, 0}, {1, 2}, {-1, 2}, {-2, 0}, {-1, -2}, {1, -2}}};
      const std::array<std::array<double, 2>, 8> square{
          {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};
      oracle::TaggedMesh mesh;
      mesh.points.push_back({0, 0, 0});
      for (const double up : {0.0, height}) {
        const auto first = static_cast<std::uint32_t>(mesh.points.size());
        for (std::uint32_t k = 0; k < (n == 6 ? 6 : 8); ++k) {
          const auto& [x, y] = n == 6 ? hexagon[k] : square[k];
          mesh.points.push_back({x, y, up * (std::fabs(x) + std::fabs(y))});
        }
        for (std::uint32_t k = 0; k < n; ++k) {
          if (n == 6) {
            mesh.polygons.push_back({0, first + k, first + (k + 1) % 6});
          } else {
            mesh.polygons.push_back({0, first + 2 * k, first + 2 * k + 1, first + (2 * k + 2) % 8});
          }
        }
      }
      return mesh;
    };
    for (const double height : {1.0, -0x1p-20}) {
      const oracle::TaggedMesh mesh = sheets(height);
      EXPECT_EQ(ask(mesh, scheme).verdict, SelfVerdict::clear) << name_of(scheme) << " " << height;
      for (const double amount : {0x1p-3, 0x1p-51}) {
        for (const std::size_t moved : {1, 2}) {
          oracle::TaggedMesh off = mesh;
          off.points[moved][0] += amount;
          EXPECT_NE(ask(off, scheme, {}, {.max_splits = 2'000}).verdict, SelfVerdict::clear)
              << name_of(scheme) << " " << height << ", " << moved << " moved by " << amount;
        }
      }
      if (n == 4) {
        // A plane through edges has the tip in front, and the corners, too, which are bent through it.
        oracle::TaggedMesh bent = sheets(std::fabs(height) / 4);
        for (const std::size_t corner : {2, 4, 6, 8}) bent.points[corner][2] = 2 * std::fabs(height);
        EXPECT_NE(ask(bent, scheme, {}, {.max_splits = 2'000}).verdict, SelfVerdict::clear) << height;
      }
      // Through the sheet, and along it.
      for (const double other : {-height, 0.0}) {
        oracle::TaggedMesh through = mesh;
        through.points[n == 6 ? 7 : 9][2] = 2 * other;
        through.points.back()[2] = 2 * other;
        if (other == 0) through.points[n == 6 ? 8 : 10][2] = 0;
        EXPECT_NE(ask(through, scheme, {}, {.max_splits = 2'000}).verdict, SelfVerdict::clear)
            << name_of(scheme) << " " << height << " through at " << other;
      }
    }
  }
}

// Facets are compared exactly: every verdict is that of rational arithmetic, none is open.
TEST(self_contact, of_facets_is_decided_always) {
  std::mt19937_64 random(21);
  std::map<std::string, int> counts;
  for (int trial = 0; trial < 400 && !HasFailure(); ++trial) {
    oracle::TwinMesh twin = trial % 3 == 0   ? oracle::meshes::bipyramid(3 + trial % 8)
                            : trial % 3 == 1 ? oracle::meshes::icosahedron()
                                             : oracle::meshes::quartered(oracle::meshes::octahedron());
    twin = oracle::meshes::disturbed(twin, trial % 4, 0.2 * (trial % 5), random);
    const double grain = trial % 2 == 0 ? 0.25 : 0;
    for (auto& p : twin.points) {
      for (double& x : p) x = grain > 0 ? grain * std::round(x / grain) : x;
    }
    const SelfContact found = self_contact(Surface(testing::control_mesh(twin), {.scheme = Scheme::flat}));
    const auto contacts = oracle::HullTwin(twin.points, twin.triangles).contacts();
    EXPECT_EQ(found.verdict, contacts.empty() ? SelfVerdict::clear : SelfVerdict::intersecting) << trial;
    EXPECT_EQ(found.outcome, Outcome::complete);
    ++counts[name_of(found.verdict)];
    for (const SelfContactPair& pair : found.pairs) {
      const std::pair<std::size_t, std::size_t> faces{pair.points[0].at->owner, pair.points[1].at->owner};
      EXPECT_TRUE(std::find(contacts.begin(), contacts.end(), faces) != contacts.end()) << trial;
      EXPECT_EQ(pair.distance.upper, 0);
      EXPECT_LT(distance(pair.points[0].point, pair.points[1].point), 1e-9) << trial;
      counts["touching"] += pair.touching;
      counts["crossing"] += !pair.touching;
    }
  }
  for (const char* what : {"clear", "intersecting", "touching", "crossing"})
    EXPECT_GT(counts[what], 50) << what;
}

// Quads and other polygons that are plane and convex are facets, too, of bilinear; others are not.
TEST(self_contact, of_plane_polygons_is_decided_exactly) {
  const auto boxes = [](double dx, double dy) {
    oracle::TaggedMesh mesh = both(meshes::cube(), meshes::cube(), dx);
    for (std::size_t v = mesh.points.size() / 2; v < mesh.points.size(); ++v) mesh.points[v][1] += dy;
    return mesh;
  };
  EXPECT_EQ(ask(boxes(2, 0), Scheme::bilinear).verdict, SelfVerdict::clear);
  const SelfContact crossing = ask(boxes(0.5, 0.25), Scheme::bilinear);
  EXPECT_EQ(crossing.verdict, SelfVerdict::intersecting);
  EXPECT_FALSE(crossing.pairs[0].touching);
  // Side by side: faces lie on one another; edge to edge they touch only.
  EXPECT_EQ(ask(boxes(1, 0), Scheme::bilinear).verdict, SelfVerdict::intersecting);
  EXPECT_FALSE(ask(boxes(1, 0.5), Scheme::bilinear).pairs[0].touching);
  const SelfContact touching = ask(boxes(1, 1), Scheme::bilinear);
  EXPECT_EQ(touching.verdict, SelfVerdict::intersecting);
  for (const SelfContactPair& pair : touching.pairs) EXPECT_TRUE(pair.touching);
  // Bodies with other faces are still decided, in the slower way.
  oracle::TaggedMesh bent = meshes::cube();
  bent.points[7][0] += 0.25;
  bent.points[7][1] += 0.5;
  EXPECT_EQ(ask(bent, Scheme::bilinear).verdict, SelfVerdict::clear);
  for (std::uint32_t n = 3; n < 9; ++n)
    EXPECT_EQ(ask(meshes::prism(n), Scheme::bilinear).verdict, SelfVerdict::clear) << n;
}

// The diagonal of a quad is no edge, though another face has one there.
TEST(self_contact, of_a_face_with_an_edge_in_a_polygon_is_found) {
  for (std::uint32_t turn = 0; turn < 4; ++turn) {
    oracle::TaggedMesh mesh;
    mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}, {2, 2, 1}};
    mesh.polygons = {{turn, (turn + 1) % 4, (turn + 2) % 4, (turn + 3) % 4}, {0, 2, 4}};
    const SelfContact found = ask(mesh, Scheme::bilinear);
    EXPECT_EQ(found.verdict, SelfVerdict::intersecting) << turn;
    EXPECT_TRUE(found.pairs[0].touching) << turn;
    // Of two quads it is the diagonal of both.
    mesh.polygons[1] = {0, 4, 2, 5};
    mesh.points[5] = {0.5, 0.5, -1};
    EXPECT_EQ(ask(mesh, Scheme::bilinear).verdict, SelfVerdict::intersecting) << turn;
    // An edge of both is none of that.
    mesh.polygons[1] = {0, 1, 4};
    EXPECT_EQ(ask(mesh, Scheme::bilinear).verdict, SelfVerdict::clear) << turn;
  }
}

// A facet without area has two parameters with one point.
TEST(self_contact, of_a_facet_without_area_is_one_with_itself) {
  oracle::TaggedMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {2, 1, 0}};
  mesh.polygons = {{0, 1, 2}, {0, 2, 3}};
  const SelfContact found = ask(mesh, Scheme::flat);
  EXPECT_EQ(found.verdict, SelfVerdict::intersecting);
  ASSERT_EQ(found.pairs.size(), 1u);
  EXPECT_TRUE(found.pairs[0].touching);
  EXPECT_EQ(found.pairs[0].points[0].at->owner, 0u);
  EXPECT_EQ(found.pairs[0].points[1].at->owner, 0u);
}

// An L of one face: at its concave corner the surface turns over.
TEST(self_contact, of_a_sheet_that_turns_over_in_its_plane_is_found) {
  oracle::TaggedMesh mesh;
  mesh.points = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.polygons = {{0, 1, 2, 3, 4, 5}};
  for (const bool tilted : {false, true}) {
    if (tilted) {
      for (auto& p : mesh.points) p = {p[0], p[1] - p[0], p[1]};
    }
    const SelfContact found = ask(mesh, Scheme::catmark);
    EXPECT_EQ(found.verdict, SelfVerdict::intersecting);
    ASSERT_EQ(found.pairs.size(), 1u);
    EXPECT_FALSE(found.pairs[0].touching);
  }
  // Not where the sheet leaves its plane, and curls over; nor where the corner is convex.
  mesh.points[0][2] += 0.25;
  EXPECT_EQ(ask(mesh, Scheme::catmark).verdict, SelfVerdict::clear);
  mesh.points = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {0.5, 1.75, 0}, {0, 1, 0}};
  EXPECT_EQ(ask(mesh, Scheme::catmark).verdict, SelfVerdict::clear);
}

// Two sheets whose borders have the same control points, each its own: with the points of one moved they no longer do.
TEST(self_contact, of_borders_whose_vertices_coincide_touches) {
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark}) {
    oracle::TaggedMesh mesh;
    const auto add = [&](double z, double side) {
      const auto first = static_cast<std::uint32_t>(mesh.points.size());
      for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < 4; ++x) mesh.points.push_back({1.0 * x, side * y, z * y});
      }
      for (std::uint32_t y = 0; y < 2; ++y) {
        for (std::uint32_t x = 0; x < 3; ++x) {
          const std::uint32_t a = first + 4 * y + x;
          const std::vector<std::uint32_t> quad =
              side > 0 ? std::vector{a, a + 1, a + 5, a + 4} : std::vector{a, a + 4, a + 5, a + 1};
          if (scheme == Scheme::catmark) {
            mesh.polygons.push_back(quad);
          } else {
            mesh.polygons.push_back({quad[0], quad[1], quad[2]});
            mesh.polygons.push_back({quad[0], quad[2], quad[3]});
          }
        }
      }
    };
    add(0.25, 1);
    add(0.5, -1);
    const SelfContact found = ask(mesh, scheme);
    EXPECT_EQ(found.verdict, SelfVerdict::intersecting);
    ASSERT_FALSE(found.pairs.empty());
    for (const SelfContactPair& pair : found.pairs) {
      EXPECT_TRUE(pair.touching);
      EXPECT_LT(length(pair.points[1].point - pair.points[0].point), 1e-12);
    }
    // Hardly sharp, a corner of one sheet is elsewhere, though by less than a rounding.
    oracle::TaggedMesh tagged = mesh;
    for (std::uint32_t v = 0; v < 4; ++v) tagged.corners.push_back({v, 0x1p-50});
    EXPECT_NE(ask(tagged, scheme).verdict, SelfVerdict::intersecting);
    // A neighbour elsewhere: the limit points are different ones, but for those of the corner that is left.
    oracle::TaggedMesh apart = mesh;
    for (std::size_t v = 12; v < 16; ++v) apart.points[v][2] += 0x1p-40;
    EXPECT_NE(ask(apart, scheme).verdict, SelfVerdict::intersecting);
  }
}

// Scaling rounds what lies below the least normal double: such coordinates are never said to be equal, or in a plane.
TEST(self_contact, takes_no_rounded_coordinate_for_another_one) {
  constexpr double tiny = 5e-324;
  ControlMesh apart;
  apart.points = {{0, 0, 0},         {8, 0, 1},  {0, 8, 2},  {8, 8, 7},
                  {-tiny, -tiny, 0}, {-8, 0, 1}, {0, -8, 2}, {-8, -8, 7}};
  for (const auto& f : {std::array{0, 1, 2}, std::array{1, 3, 2}, std::array{4, 5, 6}, std::array{5, 7, 6}}) {
    apart.add_face(
        std::array{VertexId(std::size_t(f[0])), VertexId(std::size_t(f[1])), VertexId(std::size_t(f[2]))});
  }
  EXPECT_NE(self_contact(Surface(apart, {.scheme = Scheme::loop})).verdict, SelfVerdict::intersecting);
  apart.points[4] = {0, 0, 0};
  EXPECT_EQ(self_contact(Surface(apart, {.scheme = Scheme::loop})).verdict, SelfVerdict::intersecting);

  // A strip that turns back over itself, and rises as it does.
  ControlMesh strip;
  for (const double y : {0.0, 8.0}) {
    strip.points.insert(
        strip.points.end(),
        {{0, y, 0}, {8, y, 0}, {16, y, 0}, {17, y, tiny}, {9, y, 2 * tiny}, {2, y, 3 * tiny}});
  }
  for (std::size_t k = 0; k < 5; ++k) {
    strip.add_face(std::array{VertexId(k), VertexId(k + 1), VertexId(k + 7), VertexId(k + 6)});
  }
  EXPECT_NE(self_contact(Surface(strip, {.scheme = Scheme::catmark})).verdict, SelfVerdict::intersecting);
  for (Point3& p : strip.points) p.z = 0;
  EXPECT_EQ(self_contact(Surface(strip, {.scheme = Scheme::catmark})).verdict, SelfVerdict::intersecting);
}

}  // namespace
}  // namespace snug::self_test
