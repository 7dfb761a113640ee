// Winding numbers of surfaces that are closed but not manifold, against refined meshes and, of facets, exact
// rational arithmetic.
//
//   SNUG_PLACEMENTS=100000 build/release/bin/tests/sound_test --gtest_filter='cycles.*'

#include <gtest/gtest.h>
#include <oracle/polyhedron_twin.h>
#include <snug/mesh/topology.h>
#include <snug/search/solid.h>
#include <snug/search/winding.h>
#include <snug/surface/evaluate.h>
#include <support/error.h>
#include <testing/solid_cases.h>

#include <algorithm>
#include <iostream>
#include <map>

namespace snug::cycles_test {
namespace {

using testing::between;
using Id = std::uint32_t;
using Polygon = std::vector<Id>;

Polygon turned(Polygon face) {
  std::reverse(face.begin(), face.end());
  return face;
}

Id copy_of(oracle::TaggedMesh& mesh, const oracle::Point& p, double share) {
  mesh.points.push_back({share * p[0], share * p[1], share * p[2]});
  return static_cast<Id>(mesh.points.size() - 1);
}

// A second shell with its first `shared` vertices of a face of the first one.
void add_shell(oracle::TaggedMesh& mesh, std::mt19937_64& random, std::size_t shared) {
  const oracle::TaggedMesh more = testing::random_solid(random);
  const Polygon here = mesh.polygons[random() % mesh.polygons.size()],
                there = more.polygons[random() % more.polygons.size()];
  std::vector<Id> names(more.points.size(), UINT32_MAX);
  // Face to face, or edge to edge, whichever way round.
  const bool back = random() % 2 == 0;
  for (std::size_t k = 0; k < std::min({shared, here.size(), there.size()}); ++k)
    names[there[k]] = here[back ? here.size() - 1 - k : k];
  const double share = between(random, 0.3, 1.2);
  for (std::size_t v = 0; v < names.size(); ++v)
    if (names[v] == UINT32_MAX) names[v] = copy_of(mesh, more.points[v], share);
  const bool inside_out = random() % 2 == 0;
  for (Polygon face : more.polygons) {
    for (Id& v : face) v = names[v];
    mesh.polygons.push_back(inside_out ? turned(face) : face);
  }
}

constexpr std::size_t changes = 8;

void change(oracle::TaggedMesh& mesh, std::mt19937_64& random, std::size_t which) {
  const Polygon face = mesh.polygons[random() % mesh.polygons.size()];
  switch (which) {
    case 0:  // a membrane between vertices of the mesh
      for (int tries = 0; tries < 20; ++tries) {
        const Id n = static_cast<Id>(mesh.points.size());
        const Polygon t{static_cast<Id>(random() % n), static_cast<Id>(random() % n),
                        static_cast<Id>(random() % n)};
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
        mesh.polygons.push_back(t);
        mesh.polygons.push_back(turned(t));
        return;
      }
      return;
    case 1:  // a face again, both ways
      mesh.polygons.push_back(face);
      mesh.polygons.push_back(turned(face));
      return;
    case 2: {  // a free sheet
      Polygon own;
      for (const Id v : face) own.push_back(copy_of(mesh, mesh.points[v], 0.6));
      mesh.polygons.push_back(own);
      mesh.polygons.push_back(turned(own));
      return;
    }
    case 3: {  // a cone on a face, which is there once more: wound around twice, or not at all
      const Id tip =
          copy_of(mesh, {between(random, -1, 1), between(random, -1, 1), between(random, -1, 1)}, 1);
      const bool out = random() % 2 == 0;
      mesh.polygons.push_back(out ? face : turned(face));
      for (std::size_t k = 0; k < face.size(); ++k) {
        const Polygon side{face[(k + 1) % face.size()], face[k], tip};
        mesh.polygons.push_back(out ? side : turned(side));
      }
      return;
    }
    case 4: {  // a pillow: one side a fan, the other a face
      const Id tip = copy_of(mesh, mesh.points[face[0]], 0.4);
      for (std::size_t k = 0; k < face.size(); ++k)
        mesh.polygons.push_back({face[k], face[(k + 1) % face.size()], tip});
      mesh.polygons.push_back(turned(face));
      return;
    }
    default:  // shells that share a vertex, an edge, a face or more
      add_shell(mesh, random, which == 5 ? 1 : which == 6 ? 2 : 4);
  }
}

// All pairs of changes, number by number; then again with other numbers.
testing::SolidCase cycle_case(std::uint64_t number) {
  testing::SolidCase c = testing::solid_case(number * 8 + number % 6);
  c.name = "cycle " + std::to_string(number) + ", " + c.name;
  std::mt19937_64 random(number * 131 + 5);
  change(c.mesh, random, number % changes);
  change(c.mesh, random, number / changes % changes);
  const oracle::Rules* const rules = std::get_if<oracle::Rules>(&c.scheme);
  if (rules && rules->scheme == oracle::PrimalScheme::loop) c.mesh = oracle::meshes::triangulated(c.mesh);
  return c;
}

// Triangles (a, b, m) over edges of three faces and more that the first split of a face cuts at m.
std::vector<Triangle> cut_triangles(const LimitSurface& surface) {
  const Topology& topology = surface.topology();
  std::vector<Triangle> found;
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    const PatchPlace at = surface.place(PatchId(p));
    if (!surface.rules().primal || !surface.after_first_split(PatchId(p)) || at.part % 2 != 0) continue;
    const Id corner = at.part / 2, size = static_cast<Id>(topology.face(FaceId(at.owner)).size());
    if (topology.more_halves(topology.edge_of(topology.first_of(FaceId(at.owner)) + corner)).empty())
      continue;
    const auto owner = static_cast<std::uint32_t>(at.owner);
    found.push_back({evaluate(surface, {owner, corner, 0, 0}).point,
                     evaluate(surface, {owner, (corner + 1) % size, 0, 0}).point,
                     evaluate(surface, {owner, corner, 1, 0}).point});
  }
  return found;
}

// A point from where a ray that winding_number() tries first leads through a triangle.
Point3 behind(const Triangle& t, const Ball& ball, std::mt19937_64& random) {
  constexpr std::array<Vector3, 8> rays{{{0.8236391, 0.2941752, 0.4848613},
                                         {-0.3912744, 0.8123906, 0.4324018},
                                         {0.1748203, -0.5321907, 0.8283922},
                                         {-0.6723481, -0.5610927, -0.4829115},
                                         {0.5519373, 0.7218405, -0.4176331},
                                         {-0.9321904, 0.1293847, 0.3381923},
                                         {0.2639471, -0.8931207, -0.3642918},
                                         {-0.1173952, 0.2387164, -0.9639721}}};
  const double b = between(random, 0, 1), c = between(random, 0, 1 - b);
  const Point3 target = t[0] + (b * (t[1] - t[0]) + c * (t[2] - t[0]));
  Point3 q = target;
  for (int tries = 0; tries < 50; ++tries) {
    const std::size_t ray = random() % rays.size();
    q = target - ball.radius * between(random, 0.02, 0.7) * rays[ray];
    const auto along = [&](const Vector3& d) { return dot(d, q - ball.centre); };
    if (std::all_of(rays.begin(), rays.end(), [&](const Vector3& d) { return along(d) <= along(rays[ray]); }))
      break;
  }
  return q;
}

TEST(cycles, of_smooth_schemes_wind_as_refined_meshes_do) {
  const std::uint64_t count = testing::number_of("SNUG_PLACEMENTS", 3000) / 40,
                      first = testing::number_of("SNUG_FIRST", 0);
  std::size_t asked = 0, untold = 0, refused = 0, not_manifold = 0, cuts = 0;
  std::map<int, std::size_t> numbers;
  for (std::uint64_t i = first; i < first + count && !HasFailure(); ++i) {
    const testing::SolidCase c = cycle_case(i);
    try {
      const LimitSurface surface(testing::control_mesh(c), c.options, std::make_shared<BoundsCache>());
      ASSERT_TRUE(is_closed(surface)) << c.name << *open_reason(surface);
      const SurfaceBvh model(surface, {.threads = 1});
      PieceCache scratch(model);
      const std::vector<Triangle> cut = cut_triangles(surface);
      not_manifold += !surface.topology().is_manifold();
      cuts += !cut.empty();
      const oracle::WindingTwin twin(c.mesh, c.scheme, testing::twin_levels(c.mesh, 1500));
      std::mt19937_64 random(i);
      for (int k = 0; k < 40; ++k) {
        const auto& near = twin.mesh().points[random() % twin.mesh().points.size()];
        const double away = model.ball().radius * std::exp2(-between(random, 0, 6));
        Point3 q{near[0], near[1], near[2]};
        for (std::size_t x = 0; x < 3; ++x) q[x] += away * between(random, -1, 1);
        if (k % 4 != 0 && !cut.empty()) q = behind(cut[random() % cut.size()], model.ball(), random);
        const std::optional<int> truth = twin({q.x, q.y, q.z});
        if (!truth) continue;
        ++asked;
        ++numbers[*truth];
        const std::optional<int> found = winding_number(scratch, surface.scale().apply(q), 0);
        untold += !found;
        if (found) {
          EXPECT_EQ(*found, *truth) << c.name << " point " << q.x << ' ' << q.y << ' ' << q.z;
        }
      }
    } catch (const InputError& error) {
      ++refused;
    }
  }
  std::cout << "  " << asked << " points, " << not_manifold << " meshes not manifold, " << cuts
            << " with first splits at such edges, " << refused << " refused, " << untold
            << " not told; winding numbers";
  for (const auto& [number, n] : numbers) std::cout << "  " << number << ": " << n;
  std::cout << "\n";
  EXPECT_LE(untold * 500, asked);
}

TEST(cycles, of_facets_wind_as_exact_polyhedra_do) {
  const std::uint64_t count = testing::number_of("SNUG_PLACEMENTS", 3000) / 40,
                      first = testing::number_of("SNUG_FIRST", 0);
  std::size_t asked = 0, untold = 0, refused = 0;
  std::map<int, std::size_t> numbers;
  for (std::uint64_t i = first; i < first + count && !HasFailure(); ++i) {
    std::mt19937_64 random(i + 9);
    oracle::TaggedMesh mesh = testing::random_solid(random);
    change(mesh, random, i % changes);
    change(mesh, random, i / changes % changes);
    mesh = oracle::meshes::triangulated(mesh);
    for (oracle::Point& p : mesh.points)
      for (double& x : p) x = std::round(8 * x);
    std::vector<oracle::Triangle> triangles;
    for (const auto& t : mesh.polygons) triangles.push_back({t[0], t[1], t[2]});
    const oracle::PolyhedronTwin twin(mesh.points, triangles);
    try {
      const Scheme scheme = i / 64 % 2 == 0 ? Scheme::flat : Scheme::bilinear;
      const LimitSurface surface(testing::control_mesh(mesh, {}), {scheme}, std::make_shared<BoundsCache>());
      ASSERT_TRUE(is_closed(surface)) << i;
      const SurfaceBvh model(surface, {.threads = 1});
      PieceCache scratch(model);
      for (int k = 0; k < 40; ++k) {
        Point3 q;
        for (std::size_t x = 0; x < 3; ++x) {
          q[x] = std::round(between(random, -16, 16)) / 2;
          if (k % 3 != 0) q[x] += std::ldexp(between(random, -1, 1), -static_cast<int>(random() % 12));
        }
        const std::optional<int> truth = twin.winding({q.x, q.y, q.z});
        if (!truth) continue;
        ++asked;
        ++numbers[*truth];
        const std::optional<int> found = winding_number(scratch, surface.scale().apply(q), 0);
        untold += !found;
        if (found) {
          EXPECT_EQ(*found, *truth) << i << " point " << q.x << ' ' << q.y << ' ' << q.z;
        }
      }
    } catch (const InputError& error) {
      ++refused;
    }
  }
  std::cout << "  " << asked << " points, " << refused << " refused, " << untold
            << " not told; winding numbers";
  for (const auto& [number, n] : numbers) std::cout << "  " << number << ": " << n;
  std::cout << "\n";
}

}  // namespace
}  // namespace snug::cycles_test
