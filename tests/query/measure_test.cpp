// measure(): closed forms, exact integrals of tori, what does not change the answer, and what is refused.

#include <snug/measure.h>

#include <gmpxx.h>
#include <gtest/gtest.h>
#include <oracle/measure_twin.h>
#include <oracle/tagged_shapes.h>
#include <testing/disguises.h>
#include <testing/tagged.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>

namespace snug::measure_test {
namespace {

namespace meshes = oracle::meshes;
using oracle::PeriodicBasis;

Surface surface_of(const oracle::TaggedMesh& mesh, Scheme scheme) {
  return Surface(testing::control_mesh(mesh), {.scheme = scheme});
}

double width(const Interval& x) { return x.upper - x.lower; }

bool holds(const Interval& x, const mpq_class& exact) {
  return mpq_class(x.lower) <= exact && exact <= mpq_class(x.upper);
}

// Control points of a torus, bent and shaken.
oracle::TaggedMesh torus(std::uint32_t m, std::uint32_t n, bool triangles, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  oracle::TaggedMesh mesh;
  for (std::uint32_t i = 0; i < m; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const double u = 2 * std::numbers::pi * i / m, v = 2 * std::numbers::pi * j / n;
      const double r = 3 + std::cos(v);
      mesh.points.push_back({r * std::cos(u), r * std::sin(u), std::sin(v) + 0.3 * std::cos(2 * u)});
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
  return meshes::shaken(mesh, 0.2, random);
}

void expect_exact(const Measures& found, const std::array<mpq_class, oracle::kMeasures - 1>& exact,
                  double size, const std::string& name) {
  ASSERT_TRUE(found.volume && found.centroid && found.inertia) << name;
  EXPECT_TRUE(holds(*found.volume, exact[0])) << name;
  EXPECT_LE(width(*found.volume), 1e-10 * std::pow(size, 3)) << name;
  for (std::size_t a = 0; a < 3; ++a) {
    EXPECT_TRUE(holds((*found.centroid)[a], exact[1 + a])) << name << ", centroid " << a;
    EXPECT_LE(width((*found.centroid)[a]), 1e-9 * size) << name;
  }
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_TRUE(holds((*found.inertia)[k], exact[4 + k])) << name << ", inertia " << k;
    EXPECT_LE(width((*found.inertia)[k]), 1e-9 * std::pow(size, 5)) << name;
  }
}

TEST(measure, holds_the_exact_moments_of_regular_tori) {
  struct Case {
    Scheme scheme;
    PeriodicBasis basis;
  };
  for (const auto& [scheme, basis] :
       {Case{Scheme::bilinear, PeriodicBasis::bilinear}, Case{Scheme::doo_sabin, PeriodicBasis::biquadratic},
        Case{Scheme::catmark, PeriodicBasis::bicubic}, Case{Scheme::loop, PeriodicBasis::box_spline}}) {
    const bool triangles = scheme == Scheme::loop;
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      const oracle::TaggedMesh mesh = torus(4, 3, triangles, seed);
      const Measures found = measure(surface_of(mesh, scheme));
      EXPECT_EQ(found.outcome, Outcome::complete);
      expect_exact(found, oracle::exact_measures(basis, 4, 3, mesh.points), 10, name_of(scheme));
    }
  }
}

TEST(measure, holds_the_moments_of_boxes) {
  const double a = 2, b = 3, c = 0.5;
  oracle::TaggedMesh box = meshes::cube();
  for (oracle::Point& p : box.points) p = {a * p[0] + 10, b * p[1] - 4, c * p[2] + 1};
  oracle::TaggedMesh sharp = box;
  for (const auto& polygon : sharp.polygons) {
    for (std::size_t k = 0; k < 4; ++k) sharp.creases.push_back({polygon[k], polygon[(k + 1) % 4], 10});
  }
  const double v = a * b * c;
  struct Case {
    std::string name;
    Surface surface;
  };
  for (const Case& each : {Case{"bilinear", surface_of(box, Scheme::bilinear)},
                           Case{"flat", surface_of(meshes::triangulated(box), Scheme::flat)},
                           Case{"sharp", surface_of(sharp, Scheme::catmark)},
                           Case{"sharp loop", surface_of(meshes::triangulated(sharp), Scheme::loop)}}) {
    SCOPED_TRACE(each.name);
    const Measures found = measure(each.surface, {.relative = 1e-6});
    EXPECT_EQ(found.outcome, Outcome::complete);
    EXPECT_TRUE(found.area.contains(2 * (a * b + b * c + c * a)));
    ASSERT_TRUE(found.inertia);
    EXPECT_TRUE(found.volume->contains(v));
    const std::array<double, 3> middle{a / 2 + 10, b / 2 - 4, c / 2 + 1};
    const std::array<double, 6> moments{
        v / 12 * (b * b + c * c), v / 12 * (a * a + c * c), v / 12 * (a * a + b * b), 0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k) EXPECT_TRUE((*found.centroid)[k].contains(middle[k]));
    for (std::size_t k = 0; k < 6; ++k) EXPECT_TRUE((*found.inertia)[k].contains(moments[k])) << k;
    EXPECT_LE(width(found.area), 1e-6 * found.area.upper);
  }
}

// Polygons in planes, split into bilinear quads at their first split or not.
TEST(measure, holds_those_of_polyhedra) {
  for (const auto& mesh : {meshes::cube(), meshes::prism(3), meshes::prism(5), meshes::pyramid(3),
                           meshes::pyramid(7), meshes::two_cubes_at_a_vertex()}) {
    const Measures found = measure(surface_of(mesh, Scheme::bilinear));
    const oracle::MeasureValues exact = oracle::polyhedron_measures(mesh);
    EXPECT_EQ(found.outcome, Outcome::complete);
    ASSERT_TRUE(found.inertia);
    const auto expect_near = [](const Interval& x, long double y) {
      EXPECT_LE(x.lower, y + 1e-12L);
      EXPECT_GE(x.upper, y - 1e-12L);
    };
    expect_near(found.area, exact[0]);
    expect_near(*found.volume, exact[1]);
    for (std::size_t a = 0; a < 3; ++a) expect_near((*found.centroid)[a], exact[2 + a]);
    for (std::size_t k = 0; k < 6; ++k) expect_near((*found.inertia)[k], exact[5 + k]);
    EXPECT_LE(width(*found.volume), 1e-9 * found.volume->upper);
  }
}

// Nothing is left to be narrowed but rounding.
TEST(measure, ends_where_nothing_can_be_asked_for) {
  for (const auto& mesh : {meshes::cube(), meshes::quad_grid(2, 2)}) {
    const Measures found = measure(surface_of(mesh, Scheme::bilinear), {.relative = 0});
    EXPECT_EQ(found.outcome, Outcome::at_rounding);
    EXPECT_LE(width(found.area), 1e-10 * found.area.upper);
    EXPECT_LE(found.splits, 1000);
  }
}

// Simpson's rule, whose error here is below 1e-13.
double saddle_area() {
  constexpr int n = 400;
  const auto weight = [](int i) { return i == 0 || i == n ? 1.0 : i % 2 == 1 ? 4.0 : 2.0; };
  long double sum = 0;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const long double x = static_cast<long double>(i) / n, y = static_cast<long double>(j) / n;
      sum += weight(i) * weight(j) * std::sqrt(1 + x * x + y * y);
    }
  }
  return static_cast<double>(sum / (9.0L * n * n));
}

TEST(measure, narrows_the_area_of_a_saddle) {
  oracle::TaggedMesh saddle;
  saddle.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}};
  saddle.polygons = {{0, 1, 2, 3}};
  const double area = saddle_area();
  std::uint64_t before = 0;
  for (const double relative : {1e-2, 1e-4, 1e-7, 1e-10, 1e-11}) {
    const Measures found = measure(surface_of(saddle, Scheme::bilinear), {.relative = relative});
    EXPECT_EQ(found.outcome, Outcome::complete) << relative;
    EXPECT_LE(width(found.area), relative * found.area.upper) << relative;
    EXPECT_LE(found.area.lower, area * (1 + 1e-13)) << relative;
    EXPECT_GE(found.area.upper, area * (1 - 1e-13)) << relative;
    EXPECT_LE(before, found.splits);
    EXPECT_LE(found.splits, 100) << relative;
    before = found.splits;
    EXPECT_FALSE(found.volume);
  }
}

// The normal vanishes at a corner: no polynomial is compared with there.
TEST(measure, narrows_the_area_of_a_collapsed_quad) {
  oracle::TaggedMesh quad;
  quad.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
  quad.polygons = {{0, 1, 2, 3}};
  const Measures found = measure(surface_of(quad, Scheme::bilinear), {.relative = 1e-4});
  EXPECT_EQ(found.outcome, Outcome::complete);
  EXPECT_TRUE(found.area.contains(0.5));
}

TEST(measure, is_between_inner_and_outer_spheres) {
  // A fine cube whose vertices lie on a sphere; limit points of a convex cage lie inside of it.
  const oracle::Rules rules;
  oracle::TaggedMesh mesh = oracle::refine(meshes::cube(), rules, 3);
  double least = INFINITY;
  for (oracle::Point& p : mesh.points) {
    for (double& x : p) x -= 0.5;
    const double r = std::hypot(p[0], p[1], p[2]);
    for (double& x : p) x /= r;
  }
  for (const auto& sample : oracle::sample_faces(mesh, rules, 2)) {
    least = std::min(least, std::hypot(sample.position[0], sample.position[1], sample.position[2]));
  }
  const double inner = least - 1e-3, pi = std::numbers::pi;
  const Measures found = measure(surface_of(mesh, Scheme::catmark));
  EXPECT_EQ(found.outcome, Outcome::complete);
  EXPECT_LE(found.area.lower, 4 * pi);
  EXPECT_GE(found.area.upper, 4 * pi * inner * inner);
  EXPECT_LE(found.volume->lower, 4 * pi / 3);
  EXPECT_GE(found.volume->upper, 4 * pi / 3 * inner * inner * inner);
  for (const Interval& x : *found.centroid) EXPECT_TRUE(x.contains(0));
}

void expect_same(const Interval& x, const Interval& y, double scale, const std::string& name) {
  EXPECT_LE(std::max(x.lower, scale * y.lower), std::min(x.upper, scale * y.upper)) << name;
}

TEST(measure, of_moved_and_scaled_surfaces_agree) {
  std::mt19937_64 random(5);
  const oracle::TaggedMesh plain = meshes::shaken(meshes::prism(5), 0.2, random);
  for (const Scheme scheme : {Scheme::catmark, Scheme::doo_sabin, Scheme::midedge, Scheme::bilinear}) {
    const Measures still = measure(surface_of(plain, scheme));
    for (const double scale : {1e-50, 1e-3, 1e50}) {
      oracle::TaggedMesh mesh = plain;
      for (oracle::Point& p : mesh.points) p = {scale * p[0], scale * p[1], scale * p[2]};
      const Measures found = measure(surface_of(mesh, scheme));
      const std::string name = std::string(name_of(scheme)) + " times " + std::to_string(scale);
      EXPECT_EQ(found.outcome, Outcome::complete) << name;
      expect_same(found.area, still.area, scale * scale, name);
      expect_same(*found.volume, *still.volume, std::pow(scale, 3), name);
      for (std::size_t k = 0; k < 6; ++k)
        expect_same((*found.inertia)[k], (*still.inertia)[k], std::pow(scale, 5), name);
    }
    for (const double away : {1e3, 1e7}) {
      oracle::TaggedMesh mesh = plain;
      for (oracle::Point& p : mesh.points) p = {p[0] + away, p[1] - away, p[2] + 3 * away};
      const Measures found = measure(surface_of(mesh, scheme));
      const std::string name = std::string(name_of(scheme)) + " at " + std::to_string(away);
      EXPECT_EQ(found.outcome, Outcome::complete) << name;
      // Sums of coordinates round.
      const double rounding = 16 * away * std::numeric_limits<double>::epsilon();
      EXPECT_NEAR(found.volume->lower, still.volume->lower, 2e-4 * std::fabs(still.volume->upper) + rounding);
      EXPECT_NEAR(found.area.upper, still.area.upper, 2e-4 * still.area.upper + rounding);
      EXPECT_NEAR((*found.centroid)[2].lower, (*still.centroid)[2].lower + 3 * away, 1e-3 + rounding);
    }
  }
}

TEST(measure, changes_sign_with_the_orientation) {
  oracle::TaggedMesh mesh = meshes::prism(5);
  const Measures out = measure(surface_of(mesh, Scheme::catmark));
  for (auto& polygon : mesh.polygons) std::reverse(polygon.begin(), polygon.end());
  const Measures in = measure(surface_of(mesh, Scheme::catmark));
  EXPECT_TRUE((out.volume->lower > 0) != (in.volume->lower > 0));
  expect_same(*out.volume, {-in.volume->upper, -in.volume->lower}, 1, "volume");
  for (std::size_t a = 0; a < 3; ++a) expect_same((*out.centroid)[a], (*in.centroid)[a], 1, "centroid");
}

// Two cubes that overlap count twice where they do; a cavity is subtracted.
TEST(measure, weighs_by_winding_numbers) {
  const oracle::TaggedMesh cube = meshes::cube();
  const auto both = [&](double shift, double size, bool inside_out) {
    oracle::TaggedMesh mesh = cube;
    for (const oracle::Point& p : cube.points) {
      mesh.points.push_back({shift + size * p[0], shift + size * p[1], shift + size * p[2]});
    }
    for (auto polygon : cube.polygons) {
      for (std::uint32_t& v : polygon) v += 8;
      if (inside_out) std::reverse(polygon.begin(), polygon.end());
      mesh.polygons.push_back(polygon);
    }
    return measure(surface_of(mesh, Scheme::bilinear));
  };
  EXPECT_TRUE(both(0.25, 1, false).volume->contains(2));
  EXPECT_TRUE(both(0.25, 0.5, true).volume->contains(0.875));
  EXPECT_TRUE(both(0.25, 0.5, true).area.contains(7.5));
}

TEST(measure, of_open_surfaces_is_the_area_alone) {
  for (const auto& mesh : {meshes::quad_grid(3, 3), meshes::moebius(5), meshes::book(3)}) {
    const Measures found = measure(surface_of(mesh, Scheme::bilinear));
    EXPECT_GT(found.area.lower, 0);
    EXPECT_FALSE(found.volume || found.centroid || found.inertia);
    EXPECT_EQ(found.outcome, Outcome::complete);
  }
  oracle::TaggedMesh hole = meshes::cube();
  hole.holes = {2};
  EXPECT_FALSE(measure(surface_of(hole, Scheme::bilinear)).volume);
  EXPECT_TRUE(measure(surface_of(hole, Scheme::bilinear)).area.contains(5));
}

TEST(measure, of_a_flat_solid_has_no_centroid) {
  const Measures found = measure(surface_of(meshes::back_to_back(), Scheme::bilinear));
  ASSERT_TRUE(found.volume);
  EXPECT_TRUE(found.volume->contains(0));
  EXPECT_FALSE(found.centroid || found.inertia);
  EXPECT_EQ(found.outcome, Outcome::complete);
}

TEST(measure, is_the_same_for_any_number_of_threads) {
  std::mt19937_64 random(3);
  const oracle::TaggedMesh mesh = meshes::shaken(meshes::pyramid(7), 0.2, random);
  for (const Scheme scheme : {Scheme::catmark, Scheme::midedge}) {
    const Measures one = measure(surface_of(mesh, scheme), {}, {.threads = 1});
    const Measures three = measure(surface_of(mesh, scheme), {}, {.threads = 3});
    EXPECT_EQ(one.area, three.area);
    EXPECT_EQ(one.volume, three.volume);
    EXPECT_EQ(one.inertia, three.inertia);
    EXPECT_EQ(one.splits, three.splits);
  }
}

TEST(measure, holds_within_any_budget) {
  std::mt19937_64 random(4);
  oracle::TaggedMesh mesh = meshes::shaken(meshes::pyramid(7), 0.2, random);
  testing::tag(mesh, random, false);
  for (const Scheme scheme : {Scheme::catmark, Scheme::doo_sabin, Scheme::midedge}) {
    const Measures fine = measure(surface_of(mesh, scheme));
    for (const std::uint64_t budget : {0, 20, 200, 2000}) {
      const Measures found = measure(surface_of(mesh, scheme), {}, {.max_splits = budget});
      EXPECT_LE(found.splits, budget);
      EXPECT_LE(found.area.lower, fine.area.lower);
      EXPECT_GE(found.area.upper, fine.area.upper);
      EXPECT_TRUE(std::isfinite(found.area.upper));
      expect_same(*found.volume, *fine.volume, 1, "volume");
      EXPECT_TRUE(budget > 20 || found.outcome == Outcome::budget_spent);
    }
  }
}

TEST(measure, refuses_what_has_no_answer) {
  const auto problem = [](const auto& ask) {
    try {
      ask();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("answered");
  };
  const Surface cube = surface_of(meshes::cube(), Scheme::catmark);
  for (const double relative : {-1.0, std::numeric_limits<double>::quiet_NaN(), double{INFINITY}}) {
    EXPECT_NE(problem([&] { (void)measure(cube, {.relative = relative}); }).find("precision"),
              std::string::npos);
  }
  oracle::TaggedMesh nothing = meshes::quad_grid(1, 1);
  nothing.holes = {0};
  EXPECT_NE(problem([&] { (void)measure(surface_of(nothing, Scheme::catmark)); }).find("no face has"),
            std::string::npos);
  oracle::TaggedMesh huge = meshes::cube();
  for (oracle::Point& p : huge.points) p = {1e150 * p[0], 1e150 * p[1], 1e150 * p[2]};
  EXPECT_NE(problem([&] { (void)measure(surface_of(huge, Scheme::catmark)); }).find("fits a double"),
            std::string::npos);
  std::atomic<bool> stop{true};
  const WorkMonitor monitor{.on_progress = {}, .stop = &stop};
  EXPECT_THROW((void)measure(cube, {}, {.monitor = &monitor}), Interrupted);
}

TEST(measure, holds_for_disguises) {
  std::mt19937_64 random(9);
  const oracle::TaggedMesh plain = meshes::shaken(meshes::prism(5), 0.2, random);
  for (const auto& [name, change] : testing::disguises()) {
    for (const Scheme scheme : {Scheme::catmark, Scheme::doo_sabin, Scheme::midedge, Scheme::bilinear}) {
      SCOPED_TRACE(name + ", " + name_of(scheme));
      oracle::TaggedMesh mesh = plain;
      for (oracle::Point& p : mesh.points) p = change(p);
      Measures found;
      try {
        found = measure(surface_of(mesh, scheme), {}, {.max_splits = 5'000});
      } catch (const InputError& error) {
        EXPECT_EQ(error.problem(), InputProblem::unrepresentable) << error.what();
        continue;
      }
      EXPECT_GE(found.area.lower, 0);
      EXPECT_LE(found.area.lower, found.area.upper);
      ASSERT_TRUE(found.volume);
      EXPECT_LE(found.volume->lower, found.volume->upper);
      // In one plane, or less.
      if (name.find("flat") == 0 || name == "line" || name == "a single point") {
        EXPECT_TRUE(found.volume->contains(0));
      }
      if (name == "flat" && scheme != Scheme::midedge) {
        EXPECT_EQ(found.outcome, Outcome::complete);
      }
      if (name == "line" || name == "a single point") {
        EXPECT_LE(found.area.lower, 1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace snug::measure_test
