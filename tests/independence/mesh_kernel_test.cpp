#include <snug/independence/mesh_kernel.h>

#include <gtest/gtest.h>
#include <oracle/kernel_twin.h>
#include <testing/closed_meshes.h>
#include <testing/counts.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include <snug/evaluate.h>
#include <snug/patch/limit_evaluator.h>
#include <snug/run.h>
#include <snug/scheme/rules.h>
#include <snug/surface/limit_surface.h>

// Kernels of meshes against eliminations of limits in exact arithmetic. SNUG_KERNELS: how many random meshes.
namespace snug::mesh_kernel_test {
namespace {

using oracle::KernelMesh;
using oracle::KernelScheme;
using testing::ClosedMesh;

constexpr std::array schemes{
    std::pair{Scheme::loop, KernelScheme::loop}, std::pair{Scheme::catmark, KernelScheme::catmark},
    std::pair{Scheme::doo_sabin, KernelScheme::doo_sabin}, std::pair{Scheme::midedge, KernelScheme::midedge}};

std::vector<std::int8_t> values_of(const KernelVector& vector, std::size_t vertices) {
  std::vector<std::int8_t> values(vertices, 0);
  for (std::size_t i = 0; i < vector.vertices.size(); ++i) {
    values[vector.vertices[i].index()] = vector.signs[i];
  }
  return values;
}

ControlMesh mesh_of(const KernelMesh& twin) {
  std::mt19937_64 random(1);
  ControlMesh mesh = testing::control_mesh_of({"", twin.vertices, twin.faces}, random);
  const auto sharpness = [](int quarters) {
    return quarters == KernelMesh::infinite ? infinite_sharpness : quarters / 4.0;
  };
  for (const auto& [edge, s] : twin.creases) {
    mesh.tags.creases.push_back({VertexId(edge.first), VertexId(edge.second), sharpness(s)});
  }
  for (const auto& [v, s] : twin.corners) mesh.tags.corners.push_back({VertexId(v), sharpness(s)});
  if (twin.smooth_triangles) mesh.tags.smooth_triangles = SmoothTriangles::smooth;
  return mesh;
}

int levels_until_rest(const KernelMesh& mesh) {
  int most = 0;
  for (const auto& [edge, s] : mesh.creases) most = std::max(most, s == KernelMesh::infinite ? 0 : s);
  for (const auto& [v, s] : mesh.corners) most = std::max(most, s == KernelMesh::infinite ? 0 : s);
  return (most + 3) / 4;
}

// The library's own masks and limits.
void expect_no_limit(ControlMesh mesh, const KernelVector& vector, const SchemeOptions& options) {
  for (Point3& p : mesh.points) p = {};
  for (std::size_t i = 0; i < vector.vertices.size(); ++i) {
    mesh.points[vector.vertices[i].index()].x = vector.signs[i];
  }
  const ControlMesh limit =
      subdivided(std::move(mesh), 1, true, {.scheme = options.scheme, .boundary = options.boundary});
  for (const VertexId v : limit.face_vertices) EXPECT_NEAR(limit.points[v.index()].x, 0, 1e-14);
}

// The kernel lies between what vanishes after one step and what has limits 0.
std::size_t expect_exact(const KernelMesh& twin, Scheme scheme, KernelScheme own, const std::string& name) {
  SCOPED_TRACE(name + ", " + name_of(scheme));
  SchemeOptions options{.scheme = scheme};
  options.boundary = twin.boundary_corners ? BoundaryRule::edge_and_corner : BoundaryRule::edge_only;
  const MeshKernel kernel = mesh_kernel(mesh_of(twin), options);
  EXPECT_EQ(kernel.dimension(), nullity_of_limits(twin, own, 2 + levels_until_rest(twin)));
  std::vector<int> times(twin.vertices, 0);
  for (const KernelVector& vector : kernel.vectors) {
    EXPECT_TRUE(vanishes(twin, own, values_of(vector, twin.vertices)));
    expect_no_limit(mesh_of(twin), vector, options);
    EXPECT_TRUE(std::is_sorted(vector.vertices.begin(), vector.vertices.end()));
    EXPECT_EQ(vector.signs.at(0), 1);
    EXPECT_EQ(vector.signs.size(), vector.vertices.size());
    for (const VertexId v : vector.vertices) ++times[v.index()];
  }
  EXPECT_LE(*std::max_element(times.begin(), times.end()), 1);
  return kernel.dimension();
}

// All schemes; Loop with a vertex in each face that is no triangle.
std::array<std::size_t, 4> expect_exact(const ClosedMesh& mesh) {
  std::array<std::size_t, 4> dimensions{};
  EXPECT_TRUE(is_closed_manifold(mesh)) << mesh.name;
  const bool triangles =
      std::all_of(mesh.faces.begin(), mesh.faces.end(), [](const auto& face) { return face.size() == 3; });
  for (std::size_t s = 0; s < schemes.size(); ++s) {
    const ClosedMesh used = s == 0 && !triangles ? stellated(mesh) : mesh;
    dimensions[s] = expect_exact({used.vertices, used.faces}, schemes[s].first, schemes[s].second, used.name);
  }
  return dimensions;
}

using Dimensions = std::array<std::size_t, 4>;  // Loop, Catmull-Clark, Doo-Sabin, Midedge

std::vector<ClosedMesh> families() {
  using namespace testing;
  std::vector<ClosedMesh> all{tetrahedron(), truncated(tetrahedron())};
  for (std::uint32_t n = 3; n <= 8; ++n) {
    for (const ClosedMesh& mesh : {prism(n), antiprism(n), bipyramid(n), trapezohedron(n)})
      all.push_back(mesh);
  }
  for (std::uint32_t n = 3; n <= 4; ++n) all.push_back(truncated(bipyramid(n)));
  for (std::uint32_t a = 3; a <= 6; ++a) {
    for (std::uint32_t b = 3; b <= a; ++b) {
      all.push_back(torus(a, b));
      all.push_back(torus(a, b, true));
      if (a * b <= 16) all.push_back(dual(torus(a, b, true)));  // hexagons
    }
  }
  all.push_back(truncated(torus(3, 3)));
  return all;
}

TEST(mesh_kernel, of_named_meshes) {
  using namespace testing;
  EXPECT_EQ(expect_exact(prism(4)), (Dimensions{0, 1, 0, 1}));  // a cube
  EXPECT_EQ(expect_exact(prism(6)), (Dimensions{0, 1, 0, 1}));
  EXPECT_EQ(expect_exact(prism(5)), (Dimensions{0, 0, 0, 0}));
  EXPECT_EQ(expect_exact(tetrahedron()), (Dimensions{0, 0, 0, 0}));
  EXPECT_EQ(expect_exact(torus(4, 4)), (Dimensions{0, 0, 0, 1}));
  EXPECT_EQ(expect_exact(torus(5, 4)), (Dimensions{0, 0, 0, 0}));
  EXPECT_EQ(expect_exact(dual(torus(4, 4, true))), (Dimensions{0, 1, 0, 1}));  // hexagons all around
  EXPECT_EQ(expect_exact(dual(torus(3, 3, true))), (Dimensions{0, 1, 0, 1}));
  EXPECT_EQ(expect_exact(truncated(bipyramid(4))), (Dimensions{0, 1, 0, 1}));  // squares and hexagons
  EXPECT_EQ(expect_exact(dual(truncated(bipyramid(4)))), (Dimensions{0, 0, 0, 0}));
  EXPECT_EQ(expect_exact(trapezohedron(4)), (Dimensions{0, 0, 0, 1}));
  EXPECT_EQ(expect_exact(beside(prism(4), prism(6))), (Dimensions{0, 2, 0, 2}));
  EXPECT_EQ(expect_exact(beside(prism(4), prism(5))), (Dimensions{0, 1, 0, 1}));
  EXPECT_EQ(expect_exact(beside(torus(4, 4), prism(8))), (Dimensions{0, 1, 0, 2}));
}

TEST(mesh_kernel, of_small_closed_meshes) {
  std::size_t catmark = 0, midedge = 0;
  for (const ClosedMesh& mesh : families()) {
    const Dimensions found = expect_exact(mesh);
    catmark += found[1];
    midedge += found[3];
  }
  EXPECT_GE(catmark, 8);
  EXPECT_GE(midedge, 15);
}

TEST(mesh_kernel, of_sums_and_pairs) {
  using namespace testing;
  const std::vector<ClosedMesh> parts{prism(4),    prism(6),    prism(5),
                                      torus(4, 4), torus(4, 3), trapezohedron(3)};
  for (const ClosedMesh& a : parts) {
    for (const ClosedMesh& b : parts) {
      expect_exact(beside(a, b));
      const ClosedMesh sum = joined(a, b);
      if (is_closed_manifold(sum)) expect_exact(sum);
    }
  }
}

TEST(mesh_kernel, of_random_closed_meshes) {
  const std::size_t trials = testing::number_of("SNUG_KERNELS", 60);
  std::mt19937_64 random(20240601);
  const std::vector<ClosedMesh> all = families();
  Dimensions sum{};
  for (std::size_t trial = 0; trial < trials; ++trial) {
    ClosedMesh mesh = all[random() % all.size()];
    for (std::size_t k = random() % 6; k > 0; --k) {
      if (ClosedMesh next = changed(mesh, random); next.vertices <= 40) mesh = std::move(next);
    }
    if (mesh.vertices > 40) continue;
    const Dimensions found = expect_exact(mesh);
    for (std::size_t s = 0; s < 4; ++s) sum[s] += found[s];
  }
  if (trials < 60) return;
  EXPECT_GT(sum[1], 0);
  EXPECT_GT(sum[3], sum[1]);
}

// Faces taken away where the rest stays manifold; creases and corners of each sort.
TEST(mesh_kernel, of_random_open_and_creased_meshes) {
  const std::size_t trials = testing::number_of("SNUG_KERNELS", 80);
  std::mt19937_64 random(20240602);
  const std::vector<ClosedMesh> all = families();
  std::size_t kernels = 0, open = 0, refused = 0;
  for (std::size_t trial = 0; trial < trials; ++trial) {
    for (const std::size_t s : {std::size_t{0}, std::size_t{1}}) {
      ClosedMesh mesh = all[random() % all.size()];
      if (s == 1 && random() % 3 == 0)
        mesh = testing::prism(4 + 2 * static_cast<std::uint32_t>(random() % 3));
      if (s == 0) mesh = stellated(mesh);
      if (mesh.vertices > (s == 0 ? 24 : 20)) continue;
      KernelMesh twin{mesh.vertices, mesh.faces};
      twin.boundary_corners = random() % 2 == 0;
      twin.smooth_triangles = s == 1 && random() % 2 == 0;
      for (std::size_t k = random() % 3; k > 0 && twin.faces.size() > 2; --k) {
        KernelMesh fewer = twin;
        fewer.faces.erase(fewer.faces.begin() + static_cast<std::ptrdiff_t>(random() % fewer.faces.size()));
        if (Topology(mesh_of(fewer)).is_manifold()) twin = std::move(fewer);
      }
      for (std::size_t k = random() % 6; k > 0; --k) {
        const auto& face = twin.faces[random() % twin.faces.size()];
        const std::size_t i = random() % face.size();
        constexpr std::array sharpnesses{KernelMesh::infinite, 4, 2, 1, 3, 7};
        const int sharp = sharpnesses[random() % sharpnesses.size()];
        if (random() % 4 == 0) {
          twin.corners[face[i]] = sharp;
        } else {
          twin.creases[std::minmax(face[i], face[(i + 1) % face.size()])] = sharp;
        }
      }
      try {
        kernels += expect_exact(twin, schemes[s].first, schemes[s].second, mesh.name + " with tags");
        ++open;
      } catch (const InputError& error) {
        ++refused;
        EXPECT_NE(std::string(error.what()).find("not decided"), std::string::npos) << error.what();
      }
    }
  }
  EXPECT_EQ(refused, 0);
  if (trials < 80) return;
  EXPECT_GT(kernels, 0);
  EXPECT_GT(open, trials / 2);
}

// Dual schemes on what is left of a mesh when faces are taken away.
TEST(mesh_kernel, of_random_open_meshes_of_dual_schemes) {
  const std::size_t trials = testing::number_of("SNUG_KERNELS", 120);
  std::mt19937_64 random(20240603);
  const std::vector<ClosedMesh> all = families();
  std::array<std::size_t, 4> sum{}, refused{};
  for (std::size_t trial = 0; trial < trials; ++trial) {
    ClosedMesh mesh = all[random() % all.size()];
    for (std::size_t k = random() % 4; k > 0; --k) mesh = changed(mesh, random);
    if (mesh.vertices > 30) continue;
    KernelMesh twin{mesh.vertices, mesh.faces};
    for (std::size_t k = 1 + random() % 4; k > 0 && twin.faces.size() > 2; --k) {
      KernelMesh fewer = twin;
      fewer.faces.erase(fewer.faces.begin() + static_cast<std::ptrdiff_t>(random() % fewer.faces.size()));
      if (Topology(mesh_of(fewer)).is_manifold()) twin = std::move(fewer);
    }
    for (const std::size_t s : {std::size_t{2}, std::size_t{3}}) {
      try {
        sum[s] += expect_exact(twin, schemes[s].first, schemes[s].second, mesh.name + " opened");
      } catch (const InputError& error) {
        ++refused[s];
        EXPECT_NE(std::string(error.what()).find("corners"), std::string::npos) << error.what();
      }
    }
  }
  EXPECT_EQ(refused[3], 0);
  if (trials < 120) return;
  EXPECT_LT(refused[2], trials / 10);
  EXPECT_GT(sum[2], 0);
  EXPECT_GT(sum[3], sum[2]);
}

// One vertex inside, of a face of n corners and two quads: three corners of the face show. Modes 2 to n - 2 of it are n - 3.
TEST(mesh_kernel, of_a_large_face_at_the_boundary) {
  for (const std::uint32_t n : {4, 5, 6, 7, 8}) {
    KernelMesh twin{n + 3, {{}, {0, n - 1, n, n + 1}, {0, n + 1, n + 2, 1}}};
    for (std::uint32_t i = 0; i < n; ++i) twin.faces[0].push_back(i);
    EXPECT_EQ(expect_exact(twin, Scheme::midedge, KernelScheme::midedge, "fan"), n % 2 == 0 ? 1 : 0);
    if (n <= 6) {
      EXPECT_EQ(expect_exact(twin, Scheme::doo_sabin, KernelScheme::doo_sabin, "fan"), 0);
    } else {
      EXPECT_EQ(nullity_of_limits(twin, KernelScheme::doo_sabin, 3), n - 6);
      EXPECT_THROW(static_cast<void>(mesh_kernel(mesh_of(twin), {.scheme = Scheme::doo_sabin})), InputError);
    }
  }
}

// A cube keeps its kernel with darts, and loses it to a crease through a vertex, a corner or a hole's edge.
TEST(mesh_kernel, of_a_cube_with_tags) {
  const ClosedMesh cube = testing::prism(4);
  const KernelMesh plain{cube.vertices, cube.faces};
  const auto expect = [&](const KernelMesh& twin, std::size_t dimension) {
    EXPECT_EQ(expect_exact(twin, Scheme::catmark, KernelScheme::catmark, "cube"), dimension);
  };
  for (const int sharp : {KernelMesh::infinite, 2, 4, 9}) {
    KernelMesh twin = plain;
    twin.creases[{0, 1}] = sharp;
    expect(twin, 1);
    twin.creases[{2, 3}] = sharp;
    expect(twin, 1);
    twin.creases[{1, 2}] = sharp;
    expect(twin, 0);
    twin = plain;
    twin.corners[3] = sharp;
    expect(twin, 0);
  }
}

// Two vertices on an edge of a cube.
TEST(mesh_kernel, of_catmark_vertices_with_two_edges) {
  ClosedMesh cube = testing::prism(4);
  KernelMesh twin{10, cube.faces};
  for (auto& face : twin.faces) {
    const auto at = std::find(face.begin(), face.end(), 0);
    if (at == face.end()) continue;
    const std::size_t i = static_cast<std::size_t>(at - face.begin()), n = face.size();
    const auto put = [&](std::size_t before, std::uint32_t v) {
      face.insert(face.begin() + static_cast<std::ptrdiff_t>(before), v);
    };
    if (face[(i + 1) % n] == 1) {
      put(i + 1, 9);
      put(i + 1, 8);
    } else if (face[(i + n - 1) % n] == 1) {
      put(i, 8);
      put(i, 9);
    }
  }
  const auto expect_none = [&] {
    EXPECT_EQ(expect_exact(twin, Scheme::catmark, KernelScheme::catmark, "two on an edge"), 0);
  };
  expect_none();
  twin.creases = {{{0, 8}, KernelMesh::infinite}};
  expect_none();
  twin.creases[{8, 9}] = KernelMesh::infinite;
  expect_none();
  twin.creases[{1, 9}] = KernelMesh::infinite;
  expect_none();
  // Half a crease and half smooth are 0 for two edges: refused, whatever the sharpness.
  for (auto& [edge, sharpness] : twin.creases) sharpness = 2;
  EXPECT_EQ(nullity_of_limits(twin, KernelScheme::catmark, 3), 1);
  EXPECT_THROW(static_cast<void>(mesh_kernel(mesh_of(twin), {.scheme = Scheme::catmark})), InputError);
  twin.corners[2] = 1;  // does not hang on them
  expect_none();
}

// Vertices of valence 3 with sharpness at all edges: where a smooth vertex alone could vanish.
TEST(mesh_kernel, of_a_tetrahedron_with_fractions) {
  const ClosedMesh mesh = testing::tetrahedron();
  std::mt19937_64 random(8);
  for (int trial = 0; trial < 60; ++trial) {
    KernelMesh twin{mesh.vertices, mesh.faces};
    const auto quarters = [&] { return static_cast<int>(random() % 6); };
    for (std::uint32_t a = 0; a < 4; ++a) {
      if (random() % 3 == 0) twin.corners[a] = 1 + quarters() % 3;
      for (std::uint32_t b = a + 1; b < 4; ++b) {
        if (const int s = quarters(); s > 0) twin.creases[{a, b}] = s == 5 ? KernelMesh::infinite : s;
      }
    }
    EXPECT_EQ(expect_exact(twin, Scheme::loop, KernelScheme::loop, "tetrahedron"), 0);
  }
}

TEST(mesh_kernel, names_isolated_vertices) {
  const ClosedMesh cube = testing::prism(4);
  for (const auto& [scheme, own] : schemes) {
    ClosedMesh mesh = scheme == Scheme::loop ? stellated(cube) : cube;
    mesh.vertices += 2;
    const std::size_t without = scheme == Scheme::catmark || scheme == Scheme::midedge ? 1 : 0;
    EXPECT_EQ(expect_exact({mesh.vertices, mesh.faces}, scheme, own, "isolated"), without + 2);
  }
}

TEST(mesh_kernel, of_plain_meshes_is_what_no_surface_uses) {
  std::mt19937_64 random(3);
  ControlMesh mesh = testing::control_mesh_of(testing::prism(4), random);
  EXPECT_EQ(mesh_kernel(mesh, {.scheme = Scheme::bilinear}).dimension(), 0);
  for (const std::size_t face : {1, 2, 3}) mesh.tags.holes.emplace_back(face);
  const MeshKernel kernel = mesh_kernel(mesh, {.scheme = Scheme::bilinear});
  ASSERT_EQ(kernel.dimension(), 1);
  EXPECT_EQ(kernel.vectors[0].vertices, std::vector<VertexId>{VertexId(5)});
}

// Unproved cases are refused, with the next step.
TEST(mesh_kernel, refuses_what_is_not_decided) {
  std::mt19937_64 random(4);
  const auto message = [](const ControlMesh& mesh, SchemeOptions options) -> std::string {
    try {
      static_cast<void>(mesh_kernel(mesh, options));
    } catch (const InputError& error) {
      EXPECT_EQ(error.problem(), InputProblem::refused);
      return error.what();
    }
    return "decided";
  };
  const auto has = [](const std::string& text, const char* part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  const ControlMesh cube = testing::control_mesh_of(testing::prism(4), random);
  ClosedMesh open = testing::prism(4);
  open.faces.pop_back();
  const ControlMesh box = testing::control_mesh_of(open, random);
  // A face of eight corners, one of them inside.
  const ControlMesh large =
      testing::control_mesh_of({"", 11, {{0, 1, 2, 3, 4, 5, 6, 7}, {0, 7, 8, 9}, {0, 9, 10, 1}}}, random);
  has(message(large, {.scheme = Scheme::doo_sabin}),
      "face 0 has 8 corners, 5 of them beside no vertex inside");
  EXPECT_EQ(message(large, {.scheme = Scheme::midedge}), "decided");
  has(message(box, {.scheme = Scheme::catmark, .boundary = BoundaryRule::none}), "face 0 has no surface");
  ControlMesh hole = cube;
  hole.tags.holes.emplace_back(4);
  has(message(hole, {.scheme = Scheme::catmark}), "face 4 has no surface");
  // Dual schemes know no holes.
  for (const std::size_t face : {1, 2, 3}) hole.tags.holes.emplace_back(face);
  EXPECT_EQ(mesh_kernel(hole, {.scheme = Scheme::midedge}).dimension(), 1);

  ClosedMesh three = testing::prism(4);
  three.faces.push_back({0, 1, 8});
  three.vertices = 9;
  has(message(testing::control_mesh_of(three, random), {.scheme = Scheme::catmark}), "not manifold");
}

// How many directions of control values the points of a regular patch tell apart.
std::size_t rank_of_regular_patch(const ClosedMesh& torus, Scheme scheme, std::size_t control_count) {
  std::mt19937_64 random(6);
  const LimitSurface surface(testing::control_mesh_of(torus, random), {.scheme = scheme},
                             std::make_shared<BoundsCache>());
  const PatchId p(0);
  std::vector<Place> at;
  for (int j = 0; j <= 8; ++j) {
    for (int i = 0; i + (surface.rules().triangular() ? j : 0) <= 8; ++i)
      at.push_back({0, 0, i / 8.0, j / 8.0});
  }
  Patch nets;
  nets.kind = &surface.kind(p);
  nets.first = surface.first(p);
  EXPECT_TRUE(nets.kind->polynomial());
  EXPECT_EQ(nets.kind->control_count(), control_count);
  std::vector<std::vector<double>> columns(control_count);
  std::vector<BoundedPoint> values(at.size());
  nets.largest = 1;
  for (std::size_t c = 0; c < control_count; ++c) {
    nets.points.assign(control_count, {});
    nets.points[c].x = 1;
    LimitEvaluator(nets).points(at, values);
    for (const BoundedPoint& value : values) columns[c].push_back(value.position.x);
  }
  std::size_t rank = 0;  // by Gram and Schmidt, twice; far from rounding
  for (std::size_t c = 0; c < control_count; ++c) {
    const auto dot = [](const auto& a, const auto& b) {
      return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
    };
    const double before = std::sqrt(dot(columns[c], columns[c]));
    for (int twice = 0; twice < 2; ++twice) {
      for (std::size_t k = 0; k < rank; ++k) {
        const double share = dot(columns[k], columns[c]);
        for (std::size_t i = 0; i < at.size(); ++i) columns[c][i] -= share * columns[k][i];
      }
    }
    const double length = std::sqrt(dot(columns[c], columns[c]));
    EXPECT_TRUE(length < 1e-12 * before || length > 1e-4 * before) << length / before;
    if (length < 1e-12 * before) continue;
    for (double& x : columns[c]) x /= length;
    std::swap(columns[rank++], columns[c]);
  }
  return rank;
}

// Midedge's relation is the alternating net.
TEST(mesh_kernel, of_a_regular_patch_is_none_but_with_midedge) {
  EXPECT_EQ(rank_of_regular_patch(testing::torus(8, 8, true), Scheme::loop, 12), 12);
  EXPECT_EQ(rank_of_regular_patch(testing::torus(8, 8), Scheme::catmark, 16), 16);
  EXPECT_EQ(rank_of_regular_patch(testing::torus(8, 8), Scheme::doo_sabin, 9), 9);
  EXPECT_EQ(rank_of_regular_patch(testing::torus(8, 8), Scheme::midedge, 9), 8);
}

TEST(mesh_kernel, of_a_million_vertices_takes_seconds) {
  std::mt19937_64 random(5);
  const ControlMesh mesh = testing::control_mesh_of(testing::torus(1000, 1000), random);
  for (const Scheme scheme : {Scheme::catmark, Scheme::doo_sabin, Scheme::midedge}) {
    const auto start = std::chrono::steady_clock::now();
    const MeshKernel kernel = mesh_kernel(mesh, {.scheme = scheme});
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    EXPECT_EQ(kernel.dimension(), scheme == Scheme::midedge ? 1 : 0);
    RecordProperty(name_of(scheme), std::to_string(taken.count()));
    EXPECT_LT(taken.count(), 20);
  }
}

}  // namespace
}  // namespace snug::mesh_kernel_test
