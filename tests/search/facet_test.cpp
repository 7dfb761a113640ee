#include <snug/search/facet.h>

#include <gtest/gtest.h>
#include <oracle/tagged_shapes.h>
#include <snug/bounds/bounds_cache.h>
#include <snug/evaluate.h>
#include <snug/search/surface_data.h>
#include <snug/surface/evaluate.h>
#include <testing/tagged.h>

#include <cmath>
#include <random>

namespace snug::facet_test {
namespace {

namespace meshes = oracle::meshes;

// Which edges and corners stay sharp: for ever, or for some steps.
enum class Sharp { all, semi };

oracle::TaggedMesh sharpened(oracle::TaggedMesh mesh, Sharp sharp) {
  const double sharpness = sharp == Sharp::semi ? 3 : 10;
  for (const auto& face : mesh.polygons) {
    for (std::size_t k = 0; k < face.size(); ++k) {
      const std::uint32_t a = face[k], b = face[(k + 1) % face.size()];
      if (a < b) mesh.creases.push_back({a, b, sharpness});
    }
  }
  return mesh;
}

struct Counted {
  int patches = 0, between = 0, facets = 0;
};

// Limit points of patches between their corners are those of the triangle or the quad, and of facets near their triangles.
Counted check(const Surface& surface) {
  const LimitSurface& limit = surface.data()->limit();
  Counted counted;
  for (std::uint32_t p = 0; p < limit.patch_count(); ++p) {
    ++counted.patches;
    if (!is_between_corners(limit, PatchId(p))) continue;
    ++counted.between;
    const std::optional<Facet> facet = facet_of(limit, PatchId(p));
    if (!facet) continue;
    ++counted.facets;
    const std::uint32_t owner = limit.place(PatchId(p)).owner;
    for (int i = 0; i <= 4; ++i) {
      for (int j = 0; i + j <= 4; ++j) {
        const Barycentric at{0.25 * i, 0.25 * j};
        const TriangleParameter place = facet->place_of(at);
        const BoundedPoint found = facet->point(place);
        const SurfacePoint there = evaluate(limit, Place{owner, facet->corner, place.u, place.v});
        const Point3 scaled = limit.scale().apply(there.point);
        EXPECT_LE(max_abs(found.position - scaled), found.error + limit.scale().apply(there.error) + 0x1p-52);
        EXPECT_LE(found.error, 0x1p-46);
        // It is the point of the triangle that was asked for.
        const Triangle& t = facet->triangle;
        const Point3 wanted = t[0] + at.b * (t[1] - t[0]) + at.c * (t[2] - t[0]);
        EXPECT_LE(distance(found.position, wanted), 1e-13);
        EXPECT_LE(facet->off, 0x1p-40);
      }
    }
  }
  return counted;
}

TEST(facet, is_found_in_every_scheme_that_has_one) {
  const auto all_are = [](const Counted& c) { return c.facets == c.patches && c.patches > 0; };
  const oracle::TaggedMesh cube = meshes::cube(), triangles = meshes::triangulated(cube);
  const auto counted = [](const oracle::TaggedMesh& mesh, Scheme scheme) {
    return check(Surface(testing::control_mesh(mesh), {.scheme = scheme}));
  };
  EXPECT_TRUE(all_are(counted(triangles, Scheme::flat)));
  EXPECT_TRUE(all_are(counted(cube, Scheme::bilinear)));
  EXPECT_TRUE(all_are(counted(triangles, Scheme::bilinear)));
  for (std::uint32_t n = 3; n < 9; ++n)
    EXPECT_TRUE(all_are(counted(meshes::prism(n), Scheme::bilinear))) << n;
  EXPECT_TRUE(all_are(counted(sharpened(triangles, Sharp::all), Scheme::loop)));
  EXPECT_TRUE(all_are(counted(sharpened(cube, Sharp::all), Scheme::catmark)));
  for (const Scheme scheme : {Scheme::catmark, Scheme::doo_sabin, Scheme::midedge})
    EXPECT_EQ(counted(cube, scheme).between, 0);
  EXPECT_EQ(counted(triangles, Scheme::loop).between, 0);
  EXPECT_EQ(counted(sharpened(triangles, Sharp::semi), Scheme::loop).between, 0);
  EXPECT_EQ(counted(sharpened(cube, Sharp::semi), Scheme::catmark).between, 0);
  // A lone face with borders all around, whose corners are sharp or not.
  for (const bool quad : {false, true}) {
    ControlMesh mesh;
    mesh.points = {{0, 0, 0}, {1, 0, 0}, {1.3, 1.2, 0}, {0, 1, 0}};
    quad ? mesh.add_face(std::array{VertexId(0), VertexId(1), VertexId(2), VertexId(3)})
         : mesh.add_face(std::array{VertexId(0), VertexId(1), VertexId(2)});
    for (const Scheme scheme : {quad ? Scheme::catmark : Scheme::loop, Scheme::bilinear}) {
      EXPECT_TRUE(all_are(check(Surface(mesh, {.scheme = scheme}))));
    }
    const Surface round(
        mesh, {.scheme = quad ? Scheme::catmark : Scheme::loop, .boundary = BoundaryRule::edge_only});
    EXPECT_EQ(check(round).between, 0);
  }
}

TEST(facet, is_no_quad_that_is_bent_or_turns_back) {
  std::mt19937_64 random(5);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
  int facets = 0;
  for (int trial = 0; trial < 300; ++trial) {
    ControlMesh mesh;
    for (int k = 0; k < 4; ++k)
      mesh.points.push_back({unit(), unit(), trial % 3 == 0 ? 1e-9 * unit() : 0.25});
    mesh.add_face(std::array{VertexId(0), VertexId(1), VertexId(2), VertexId(3)});
    bool convex = true;
    double turns = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const Vector3 e = mesh.points[(k + 1) % 4] - mesh.points[k],
                    f = mesh.points[(k + 2) % 4] - mesh.points[(k + 1) % 4];
      const double turn = e.x * f.y - e.y * f.x;
      convex = convex && (k == 0 || turn * turns > 0);
      turns = turn;
    }
    const Counted counted = check(Surface(mesh, {.scheme = Scheme::bilinear}));
    EXPECT_EQ(counted.facets, convex && trial % 3 != 0 ? 2 : 0) << trial;
    facets += counted.facets;
  }
  EXPECT_GT(facets, 50);
}

}  // namespace
}  // namespace snug::facet_test
