// The promise of tessellate against the twins: exact limit points of refined meshes are within error_bound of the
// triangle over their parameters, and points of triangles within it of the surface.
//
//   SNUG_PLACEMENTS=100000 build/release/bin/tests/sound_test --gtest_filter='tessellate.*'

#include <snug/tessellate.h>

#include <gtest/gtest.h>
#include <oracle/dual_twin.h>
#include <oracle/limit_twin.h>
#include <oracle/polygon_twin.h>
#include <testing/counts.h>
#include <testing/disguised_surfaces.h>
#include <testing/surfaces.h>
#include <testing/tessellations.h>

#include <iostream>
#include <map>

namespace snug::tessellate_test {
namespace {

using oracle::PrimalScheme;

TessellateOptions to_tolerance(double tolerance) {
  TessellateOptions options;
  options.error = tolerance;
  options.corners = true;
  options.normals = false;
  return options;
}

// Weights of corners 1 and 2 at a parameter of a triangle's owner; nothing if it lies outside.
std::optional<std::array<double, 2>> weights_at(const std::array<Place, 3>& corner, double u, double v) {
  const double bu = corner[1].u - corner[0].u, bv = corner[1].v - corner[0].v, cu = corner[2].u - corner[0].u,
               cv = corner[2].v - corner[0].v, pu = u - corner[0].u, pv = v - corner[0].v;
  const double whole = bu * cv - cu * bv, b = (pu * cv - cu * pv) / whole, c = (bu * pv - pu * bv) / whole;
  if (b < 0 || c < 0 || b + c > 1) return {};
  return std::array{b, c};
}

struct Counted {
  std::size_t surfaces = 0, triangles = 0, samples = 0;
  double tightest = 0;
};

void print(const char* name, const Counted& counted) {
  std::cout << name << ": " << counted.surfaces << " surfaces, " << counted.triangles << " triangles, "
            << counted.samples << " checks; largest distance " << counted.tightest << " of the bound\n";
}

void check_primal(const testing::TaggedCase& c, Counted& counted) {
  const std::string name = c.name + ", " + testing::text_of(c.rules);
  const Surface surface =
      testing::public_surface(testing::control_mesh(c.mesh), testing::options_of(c.rules));
  const std::vector<oracle::FaceSample> samples = oracle::sample_faces(c.mesh, c.rules, 4);
  ++counted.surfaces;
  for (const double tolerance : {10.0, 0.05, 0.004}) {
    const Tessellation t = tessellate(surface, to_tolerance(tolerance * surface.size()));
    testing::expect_watertight(surface, t, name);
    if (::testing::Test::HasFailure()) return;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::size_t>> of_quad;
    for (std::size_t i = 0; i < t.triangles.size(); ++i) {
      of_quad[{t.corners[i][0].owner, t.corners[i][0].corner}].push_back(i);
    }
    counted.triangles += t.triangles.size();
    for (const oracle::FaceSample& s : samples) {
      bool covered = false;
      for (const std::size_t i : of_quad[{s.face, s.part}]) {
        const auto weights = weights_at(t.corners[i], s.u, s.v);
        if (!weights) continue;
        covered = true;
        ++counted.samples;
        const double found = testing::distance_at(t, i, (*weights)[0], (*weights)[1],
                                                  {s.position[0], s.position[1], s.position[2]});
        if (t.error_bound > 0) counted.tightest = std::max(counted.tightest, found / t.error_bound);
        EXPECT_LE(found, t.error_bound + 1.8 * s.error + 0x1p-48 * surface.size())
            << name << ", face " << s.face << '.' << s.part << " at " << s.u << ' ' << s.v;
      }
      EXPECT_TRUE(covered) << name << ", face " << s.face << '.' << s.part << " at " << s.u << ' ' << s.v;
    }
    if (::testing::Test::HasFailure()) return;
  }
}

TEST(tessellate, contains_the_limit_points_of_the_twins) {
  for (const PrimalScheme scheme : {PrimalScheme::catmull_clark, PrimalScheme::loop}) {
    Counted counted;
    std::size_t number = 0;
    for (const testing::TaggedCase& c : testing::tagged_cases(scheme, 91)) {
      // Of each shape and boundary rule the plain case or the tagged one, by turns.
      const std::size_t turn = number++;
      if ((turn + turn / 2) % 2 != 0 && !testing::long_check()) continue;
      check_primal(c, counted);
      if (HasFailure()) return;
    }
    print(scheme == PrimalScheme::loop ? "loop" : "catmark", counted);
    EXPECT_GT(counted.samples, 50'000u);
  }
}

// Limit points of duals have no parameters: they are near some triangle of their owners.
TEST(tessellate, contains_the_limit_points_of_dual_twins) {
  namespace meshes = oracle::meshes;
  std::mt19937_64 random(92);
  for (const auto& [scheme, twin] : {std::pair{Scheme::doo_sabin, oracle::DualScheme::doo_sabin},
                                     std::pair{Scheme::midedge, oracle::DualScheme::midedge}}) {
    Counted counted;
    for (const oracle::TaggedMesh& plain : {meshes::cube(), meshes::quad_grid(4, 4), meshes::prism(5),
                                            meshes::pyramid(7), meshes::mixed_strip(), meshes::prism(3)}) {
      const oracle::TaggedMesh mesh = meshes::shaken(plain, 0.3, random);
      const Surface surface(testing::control_mesh(mesh), {.scheme = scheme});
      ++counted.surfaces;
      for (const double tolerance : {0.05, 0.004}) {
        const Tessellation t = tessellate(surface, to_tolerance(tolerance * surface.size()));
        testing::expect_watertight(surface, t, name_of(scheme));
        if (HasFailure()) return;
        counted.triangles += t.triangles.size();
        for (const oracle::DualSample& s : oracle::sample_dual(mesh, twin, 4)) {
          double nearest = INFINITY;
          bool owned = false;
          for (std::size_t i = 0; i < t.triangles.size(); ++i) {
            if (std::find(s.owners.begin(), s.owners.end(), t.owners[i]) == s.owners.end()) continue;
            owned = true;
            const auto corner = [&](std::size_t k) { return t.positions[t.triangles[i][k]] - Point3{}; };
            const Vector3 p{s.position[0], s.position[1], s.position[2]};
            nearest = std::min(nearest, length(TriangleFoot(corner(0), corner(1), corner(2)).rest(p)));
          }
          if (!owned) continue;
          ++counted.samples;
          counted.tightest = std::max(counted.tightest, nearest / t.error_bound);
          EXPECT_LE(nearest, t.error_bound + 1.8 * s.error + 0x1p-46 * surface.size()) << name_of(scheme);
        }
        if (HasFailure()) return;
      }
    }
    print(name_of(scheme), counted);
    EXPECT_GT(counted.samples, 5'000u);
  }
}

// The other way, with search trees of the twin.
TEST(tessellate, has_no_point_far_from_the_surface_of_the_twins) {
  Counted counted;
  std::mt19937_64 random(93);
  for (const PrimalScheme scheme : {PrimalScheme::catmull_clark, PrimalScheme::loop}) {
    std::size_t number = 0;
    for (const testing::TaggedCase& c : testing::tagged_cases(scheme, 94)) {
      if (number++ % 8 != 0) continue;
      const Surface surface =
          testing::public_surface(testing::control_mesh(c.mesh), testing::options_of(c.rules));
      const Tessellation t = tessellate(surface, to_tolerance(0.02 * surface.size()));
      if (t.triangles.empty()) continue;
      ++counted.surfaces;
      counted.triangles += t.triangles.size();
      oracle::LimitTwin twin(c.mesh, std::make_shared<oracle::LimitRules>(c.rules));
      const oracle::Placement identity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
      for (std::size_t n = 0; n < std::min<std::size_t>(60, t.triangles.size()); ++n) {
        const std::size_t i = random() % t.triangles.size();
        const Point3 p = t.positions[t.triangles[i][0]], q = t.positions[t.triangles[i][1]],
                     r = t.positions[t.triangles[i][2]];
        oracle::Point middle;
        for (std::size_t a = 0; a < 3; ++a) middle[a] = (p[a] + q[a] + r[a]) / 3;
        ++counted.samples;
        EXPECT_TRUE(twin.on_surface(identity, middle, t.error_bound + 0x1p-40 * surface.size(), t.owners[i]))
            << c.name << ", " << testing::text_of(c.rules) << ", triangle " << i;
      }
      if (HasFailure()) return;
    }
  }
  print("triangles", counted);
  EXPECT_GT(counted.samples, 1'000u);
}

TEST(tessellate, holds_in_every_disguise) {
  std::size_t surfaces = 0, refused = 0;
  std::optional<Surface> last;  // keeps the bounds that disguises share
  testing::for_each_disguised_surface(
      95, [&](const LimitSurface& limit, const std::string& name, std::mt19937_64&) {
        if (!(limit.size() > 0)) return;
        const Surface surface = testing::public_surface(limit.mesh(), limit.options());
        last = surface;
        TessellateOptions options = to_tolerance(0.05 * surface.size());
        try {
          const Tessellation t = tessellate(surface, options, {.max_splits = 20'000});
          testing::expect_watertight(surface, t, name);
          if (::testing::Test::HasFatalFailure()) return;
          if (t.outcome == Outcome::complete) {
            EXPECT_LE(t.error_bound, *options.error) << name;
          }
          // Distances are computed near 1, and evaluation too.
          if (limit.scale().moderate()) testing::expect_near(surface, t, name, 2);
          ++surfaces;
        } catch (const InputError& error) {
          EXPECT_EQ(error.problem(), InputProblem::value) << name << ": " << error.what();
          ++refused;
        }
      });
  std::cout << surfaces << " surfaces, " << refused << " tolerances refused\n";
  EXPECT_GT(surfaces, testing::share(1'000));
}

}  // namespace
}  // namespace snug::tessellate_test
