#include <gtest/gtest.h>
#include <oracle/tagged_shapes.h>
#include <peers/opensubdiv_comparison.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

namespace oracle::polygon_twin_opensubdiv_test {
namespace {

using namespace meshes;

constexpr Boundary kBoundaries[] = {Boundary::none, Boundary::edge_only, Boundary::edge_and_corner};

Compared expect_same(const TaggedMesh& mesh, const Rules& rules, int levels, double tolerance = 1e-12) {
  const Compared c = compare_with_opensubdiv(mesh, rules, levels);
  EXPECT_TRUE(c.accepted);
  EXPECT_TRUE(c.same_faces);
  EXPECT_GT(c.refined.count, 0U);
  EXPECT_LE(c.refined.worst, tolerance);
  EXPECT_LE(c.limit.worst, tolerance);
  return c;
}

/// Both schemes where the mesh can be cut into triangles without harm.
void expect_same_in_both(const TaggedMesh& mesh, const Rules& rules, int levels, double tolerance = 1e-12) {
  Rules catmull_clark = rules, loop = rules;
  catmull_clark.scheme = PrimalScheme::catmull_clark;
  loop.scheme = PrimalScheme::loop;
  expect_same(mesh, catmull_clark, levels, tolerance);
  expect_same(triangulated(mesh), loop, levels, tolerance);
}

Rules with(Boundary boundary) {
  Rules rules;
  rules.boundary = boundary;
  return rules;
}

TEST(polygon_twin_and_opensubdiv, agree_on_creases_of_any_sharpness) {
  std::mt19937_64 random(21);
  for (const double s : {0.25, 0.75, 1.0, 1.5, 2.75, 4.0, 9.5, 10.0, 20.0}) {
    TaggedMesh mesh = shaken(cube(), 0.25, random);
    for (const auto& [a, b] : {std::pair{0U, 1U}, {1U, 3U}, {3U, 2U}, {2U, 0U}})
      mesh.creases.push_back({a, b, s});
    expect_same_in_both(mesh, {}, 4);
    mesh.creases.resize(3);  // ends in darts
    mesh.creases[1].sharpness = s / 2;
    expect_same_in_both(mesh, {}, 4);
    mesh.creases.push_back({0, 4, s});  // three meet
    mesh.corners.push_back({7, s});
    expect_same_in_both(mesh, {}, 4);
  }
}

TEST(polygon_twin_and_opensubdiv, agree_where_creases_cross) {
  std::mt19937_64 random(22);
  TaggedMesh mesh = shaken(quad_grid(4, 4), 0.3, random);
  for (std::uint32_t i = 0; i < 4; ++i) {
    mesh.creases.push_back({10 + i, 11 + i, 1.25 + i});
    mesh.creases.push_back({2 + 5 * i, 7 + 5 * i, 0.5});
  }
  for (const Boundary boundary : kBoundaries)
    for (const bool chaikin : {false, true}) {
      Rules rules = with(boundary);
      rules.chaikin = chaikin;
      expect_same_in_both(mesh, rules, 4, chaikin ? 1e-6 : 1e-12);
    }
}

TEST(polygon_twin_and_opensubdiv, agree_on_chaikin_sharpness) {
  std::mt19937_64 random(23);
  Rules rules;
  rules.chaikin = true;
  std::uniform_int_distribution<int> eighths(0, 40);
  for (int trial = 0; trial < 20; ++trial) {
    TaggedMesh mesh = shaken(cube(), 0.25, random);
    const auto faces = mesh.polygons;
    for (const auto& p : faces)
      for (std::size_t k = 0; k < 4; ++k)
        if (eighths(random) < 20) mesh.creases.push_back({p[k], p[(k + 1) % 4], eighths(random) / 8.0});
    expect_same_in_both(mesh, rules, 4, 1e-6);
  }
}

/// Chaikin makes the edge smooth at one end at once, since 3/4 of 1.25 and 1/4 of 0.125 are less than one.
TEST(polygon_twin_and_opensubdiv, weight_a_dart_edge_with_more_than_one) {
  TaggedMesh mesh = cube();
  mesh.creases = {{0, 1, 1.25}, {1, 3, 0.125}};
  Rules rules;
  rules.chaikin = true;
  expect_same_in_both(mesh, rules, 3);
  rules.clamp_dart_edges = true;
  EXPECT_GT(compare_with_opensubdiv(mesh, rules, 3).refined.worst, 1e-2);
}

/// Its mask for a vertex with one sharp edge is the smooth one, and the vertex itself where two faces meet.
TEST(polygon_twin_and_opensubdiv, differ_where_its_mask_is_not_the_limit) {
  TaggedMesh dart = cube();
  dart.creases = {{0, 1, 10}};
  double before = 1;
  for (int level = 1; level <= 4; ++level) {
    const Compared c = expect_same(dart, {}, level);
    EXPECT_EQ(c.dart.count, 6U);  // two vertices in three faces
    EXPECT_GT(c.dart.worst, 1e-4);
    EXPECT_LT(c.dart.worst, before);
    before = c.dart.worst;
  }
  EXPECT_GT(expect_same(back_to_back(), {}, 2).valence_two.worst, 1e-3);
  TaggedMesh sharp = cube();
  sharp.corners = {{0, 5.5}};
  EXPECT_GT(expect_same(sharp, {}, 2).alive.worst, 1e-3);
}

TEST(polygon_twin_and_opensubdiv, agree_on_boundaries_and_holes) {
  std::mt19937_64 random(24);
  for (const Boundary boundary : kBoundaries) {
    TaggedMesh mesh = shaken(quad_grid(4, 3), 0.3, random);
    expect_same_in_both(mesh, with(boundary), 3);
    mesh.holes = {5};
    mesh.corners = {{0, 10}, {4, 1.5}, {7, 0.5}};
    mesh.creases = {{0, 1, 10}, {0, 5, 10}, {1, 2, 3}};  // two tagged boundary edges keep a corner face
    expect_same_in_both(mesh, with(boundary), 3);
    expect_same_in_both(shaken(quad_grid(1, 1), 0.2, random), with(boundary), 3);
  }
}

TEST(polygon_twin_and_opensubdiv, agree_on_polygons) {
  std::mt19937_64 random(25);
  for (const bool smooth : {false, true})
    for (const Boundary boundary : kBoundaries) {
      Rules rules = with(boundary);
      rules.smooth_triangles = smooth;
      for (const TaggedMesh& mesh :
           {prism(3), prism(5), pyramid(5), pyramid(7), mixed_strip(), triangulated(cube())})
        expect_same(shaken(mesh, 0.2, random), rules, 3);
      TaggedMesh creased = shaken(pyramid(5), 0.2, random);
      creased.creases = {{0, 1, 0.5}, {1, 2, 1.75}, {0, 3, 0.25}};
      expect_same(creased, rules, 4);
    }
}

TEST(polygon_twin_and_opensubdiv, agree_on_non_manifold_meshes) {
  std::mt19937_64 random(26);
  TaggedMesh doubled = cube();
  doubled.polygons.push_back(doubled.polygons[0]);  // the same face twice
  TaggedMesh turned = cube();
  turned.polygons[2] = {4, 5, 1, 0};  // runs along its edges as its neighbours do
  TaggedMesh loose = cube();
  loose.points.push_back({3, 3, 3});  // no face
  TaggedMesh fin = cube();
  fin.points.insert(fin.points.end(), {{2, 2, 0}, {2, 2, 1}});
  fin.polygons.push_back({3, 8, 9, 7});
  for (const TaggedMesh& mesh :
       {book(3), book(4), two_cubes_at_a_vertex(), moebius(5), doubled, turned, loose, fin})
    for (const Boundary boundary : kBoundaries) {
      TaggedMesh moved = shaken(mesh, 0.1, random);
      expect_same_in_both(moved, with(boundary), 3);
      moved.creases = {{0, 1, 2.5}, {1, 2, 0.75}};
      expect_same_in_both(moved, with(boundary), 3);
    }
}

TEST(polygon_twin_and_opensubdiv, agree_on_two_faces_with_two_common_edges) {
  std::mt19937_64 random(27);
  for (const TaggedMesh& mesh : {back_to_back(), valence_two_inside()})
    for (const Boundary boundary : kBoundaries) {
      const TaggedMesh moved = shaken(mesh, 0.1, random);
      expect_same(moved, with(boundary), 3);
      Rules loop = with(boundary);
      loop.scheme = PrimalScheme::loop;
      expect_same(triangulated(moved), loop, 3);
    }
}

TEST(polygon_twin_and_opensubdiv, agree_on_faces_with_repeated_corners) {
  std::mt19937_64 random(28);
  TaggedMesh mesh = shaken(cube(), 0.2, random);
  std::vector<TaggedMesh> broken;
  mesh.points.insert(mesh.points.end(), {{2, 2, 2}, {3, 2, 2}, {3, 3, 3}, {2, 2, 4}});
  for (const std::vector<std::uint32_t>& face : std::vector<std::vector<std::uint32_t>>{
           {0, 0, 1}, {0, 1, 0, 2}, {8, 8, 9, 10}, {8, 9, 8, 10}, {7, 8, 9, 7, 10, 11}, {8, 8, 8}, {8, 9}}) {
    broken.push_back(mesh);
    broken.back().polygons.push_back(face);
  }
  for (const TaggedMesh& m : broken)
    for (const Boundary boundary : kBoundaries) expect_same(m, with(boundary), 3);
  Rules loop;
  loop.scheme = PrimalScheme::loop;
  for (const std::vector<std::uint32_t>& face :
       std::vector<std::vector<std::uint32_t>>{{0, 0, 1}, {8, 8, 8}}) {
    TaggedMesh m = triangulated(mesh);
    m.polygons.push_back(face);
    expect_same(m, loop, 3);
  }
}

/// Random faces over few vertices, so that hardly anything is manifold, with random tags.
TEST(polygon_twin_and_opensubdiv, agree_on_soup) {
  std::mt19937_64 random(29);
  const auto up_to = [&](std::uint32_t n) {
    return std::uniform_int_distribution<std::uint32_t>(0, n)(random);
  };
  for (int trial = 0; trial < 400; ++trial) {
    Rules rules;
    rules.scheme = trial % 2 == 0 ? PrimalScheme::catmull_clark : PrimalScheme::loop;
    rules.boundary = kBoundaries[up_to(2)];
    rules.chaikin = up_to(3) == 0;
    rules.smooth_triangles = up_to(1) == 0;
    const std::uint32_t last = 3 + up_to(6);
    TaggedMesh mesh;
    mesh.points.resize(last + 1);
    mesh = shaken(mesh, 1, random);
    const std::uint32_t faces = 1 + up_to(9);
    const bool repeat = up_to(2) == 0;
    for (std::uint32_t f = 0; f < faces; ++f) {
      std::vector<std::uint32_t> face;
      const std::size_t corners = trial % 2 == 0 ? 3 + up_to(1) : 3;
      while (face.size() < corners) {
        const std::uint32_t v = up_to(last);
        if (repeat || std::find(face.begin(), face.end(), v) == face.end()) face.push_back(v);
      }
      for (std::size_t k = 0; k < corners; ++k)
        if (up_to(4) == 0) mesh.creases.push_back({face[k], face[(k + 1) % corners], up_to(88) / 8.0});
      if (up_to(4) == 0) mesh.corners.push_back({face[0], up_to(88) / 8.0});
      if (up_to(7) == 0) mesh.holes.push_back(f);
      mesh.polygons.push_back(std::move(face));
    }
    expect_same(mesh, rules, 3, rules.chaikin ? 1e-6 : 1e-12);
    if (HasFailure()) FAIL() << "trial " << trial;
  }
}

}  // namespace
}  // namespace oracle::polygon_twin_opensubdiv_test
