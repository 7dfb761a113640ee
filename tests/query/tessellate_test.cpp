#include <snug/distance.h>
#include <snug/evaluate.h>
#include <snug/tessellate.h>

#include <gtest/gtest.h>
#include <oracle/test_meshes.h>
#include <snug/bounds/bounding_points.h>
#include <snug/bounds/enclosure.h>
#include <snug/bounds/quadratic.h>
#include <snug/patch/evaluate.h>
#include <snug/search/surface_data.h>
#include <testing/counts.h>
#include <testing/places.h>
#include <testing/scheme_surfaces.h>
#include <testing/surfaces.h>
#include <testing/tessellations.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <utility>

namespace snug::tessellate_test {
namespace {

Surface model(const char* file) { return load(testing::models_dir() + "/" + file); }

TessellateOptions to_tolerance(double tolerance) {
  TessellateOptions options;
  options.error = tolerance;
  options.corners = true;
  return options;
}

std::string refusal(const Surface& surface, const TessellateOptions& options) {
  try {
    static_cast<void>(tessellate(surface, options));
  } catch (const InputError& error) {
    EXPECT_EQ(error.problem(), InputProblem::value);
    return error.what();
  }
  return "not refused";
}

TEST(tessellate, is_watertight_and_near_for_every_scheme_and_tag) {
  std::size_t surfaces = 0, triangles = 0;
  testing::for_each_surface(301, [&](const testing::NamedSurface& named) {
    const Surface surface = testing::public_surface(named.surface.mesh(), named.surface.options());
    const double size = surface.size();
    for (const double tolerance : {10 * size, 0.02 * size}) {
      const Tessellation t = tessellate(surface, to_tolerance(tolerance));
      testing::expect_watertight(surface, t, named.name);
      if (HasFatalFailure()) return;
      testing::expect_near(surface, t, named.name, 2);
      EXPECT_EQ(t.outcome, Outcome::complete);
      EXPECT_LE(t.error_bound, tolerance) << named.name;
      triangles += t.triangles.size();
    }
    ++surfaces;
  });
  std::cout << surfaces << " surfaces, " << triangles << " triangles\n";
  EXPECT_GT(surfaces, testing::fewer(150));
}

// Of all pieces after so many splits, with their limit corners as corners of triangles.
double error_of_uniform(const LimitSurface& surface, const Patch& piece, unsigned levels) {
  if (levels > 0) {
    double largest = 0;
    for (unsigned child = 0; child < 4; ++child) {
      largest = std::max(largest, error_of_uniform(surface, split(piece, child), levels - 1));
    }
    return largest;
  }
  BoundingPoints hull;
  if (piece.kind->cacheable()) bounding_points(surface.library(), piece, hull);
  const std::array<Vector3, 3> c = limit_corners(piece);
  return distance_to_triangle(surface.library(), piece, hull,
                              {piece.origin + c[0], piece.origin + c[1], piece.origin + c[2]});
}

TEST(tessellate, takes_a_quarter_of_the_triangles_of_uniform_refinement) {
  std::vector<double> ratios;
  for (const char* const file : {"pawn.obj", "ring.obj", "pin.obj", "bracket.obj", "head.obj"}) {
    const Surface whole = model(file);
    const LimitSurface& surface = whole.data()->limit();
    // The first level with an error below 0.1 % of the size, on the patches that are worst one level before.
    unsigned level = 0;
    double error = INFINITY;
    for (; level < 6; ++level) {
      error = 0;
      const double wanted = surface.scale().apply(1e-3 * surface.size());
      for (std::size_t p = 0; p < surface.patch_count() && error <= wanted; ++p) {
        error = std::max(error, error_of_uniform(surface, surface.patch(PatchId(p)), level));
      }
      if (error <= wanted) break;
    }
    const Tessellation t = tessellate(whole, to_tolerance(surface.scale().inverse().apply(error)));
    const double uniform =
        std::ldexp(static_cast<double>(surface.patch_count()), 2 * static_cast<int>(level));
    ratios.push_back(static_cast<double>(t.triangles.size()) / uniform);
    std::cout << file << ": level " << level << ", " << uniform << " triangles; adaptive "
              << t.triangles.size() << '\n';
  }
  std::sort(ratios.begin(), ratios.end());
  EXPECT_LE(ratios[ratios.size() / 2], 0.25);
}

TEST(tessellate, bounds_are_tight) {
  for (const char* const file : {"pawn.obj", "ring.obj", "bracket.obj"}) {
    const Surface surface = model(file);
    const Tessellation t = tessellate(surface, to_tolerance(1e-3 * surface.size()));
    const double found = testing::expect_near(surface, t, file, 8);
    std::cout << file << ": bound " << t.error_bound / found << " times the largest distance\n";
    EXPECT_LE(t.error_bound, 2 * found) << file;
  }
}

TEST(tessellate, holds_a_longest_edge) {
  const Surface surface = model("pawn.obj");
  TessellateOptions options = to_tolerance(1e-2 * surface.size());
  options.max_edge = 0.03 * surface.size();
  const Tessellation t = tessellate(surface, options);
  testing::expect_watertight(surface, t, "pawn");
  for (const auto& [a, b, c] : t.triangles) {
    EXPECT_LE(distance(t.positions[a], t.positions[b]), *options.max_edge);
    EXPECT_LE(distance(t.positions[b], t.positions[c]), *options.max_edge);
  }
}

TEST(tessellate, holds_a_largest_angle_of_normals) {
  const Surface surface = model("pawn.obj");
  TessellateOptions options = to_tolerance(1e-2 * surface.size());
  options.max_angle = 10;
  const Tessellation t = tessellate(surface, options);
  testing::expect_watertight(surface, t, "pawn");
  const double least = std::cos(10.01 * 3.14159265358979 / 180);
  for (std::size_t i = 0; i < t.triangles.size(); ++i) {
    const auto& [p, q, r] = t.triangles[i];
    const auto side = [&](std::uint32_t x, std::uint32_t y) {
      return distance(t.positions[x], t.positions[y]);
    };
    if (std::max({side(p, q), side(q, r), side(r, p)}) <= *options.error) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      const auto a = evaluate(surface, t.corners[i][k]).normal,
                 b = evaluate(surface, t.corners[i][next]).normal;
      ASSERT_TRUE(a && b);
      EXPECT_GE(dot(*a, *b), least);
    }
  }
}

TEST(tessellate, finds_a_small_error_for_so_many_triangles) {
  const Surface surface = model("pawn.obj");
  TessellateOptions options;
  options.max_triangles = 5000;
  options.corners = true;
  const Tessellation t = tessellate(surface, options);
  testing::expect_watertight(surface, t, "pawn");
  testing::expect_near(surface, t, "pawn");
  EXPECT_EQ(t.outcome, Outcome::complete);
  EXPECT_LE(t.triangles.size(), 5000u);
  EXPECT_GE(t.triangles.size(), 4000u);
  options.error = t.error_bound / 10;
  EXPECT_EQ(tessellate(surface, options).outcome, Outcome::budget_spent);
  options.error = t.error_bound * 10;
  const Tessellation loose = tessellate(surface, options);
  EXPECT_EQ(loose.outcome, Outcome::complete);
  EXPECT_LT(loose.triangles.size(), t.triangles.size());
}

TEST(tessellate, says_what_is_proved_when_the_budget_ends) {
  const Surface surface = model("pawn.obj");
  TessellateOptions options = to_tolerance(1e-5 * surface.size());
  const Tessellation t = tessellate(surface, options, {.max_splits = 2000});
  EXPECT_EQ(t.outcome, Outcome::budget_spent);
  EXPECT_LE(t.triangles.size(), 2000u);
  testing::expect_watertight(surface, t, "pawn");
  testing::expect_near(surface, t, "pawn");
}

TEST(tessellate, proves_the_floats_that_it_returns) {
  const Surface surface = model("pawn.obj");
  TessellateOptions options = to_tolerance(1e-6 * surface.size());
  options.single_precision = true;
  const Tessellation t = tessellate(surface, options, {.max_splits = 100'000});
  for (const Point3& p : t.positions) {
    for (std::size_t a = 0; a < 3; ++a) EXPECT_EQ(static_cast<double>(static_cast<float>(p[a])), p[a]);
  }
  testing::expect_near(surface, t, "pawn", 1);
  EXPECT_GT(t.position_error, 1e-9 * surface.size());
}

TEST(tessellate, refuses_what_it_cannot_hold) {
  const Surface surface = model("pawn.obj");
  TessellateOptions options;
  EXPECT_NE(refusal(surface, options).find("give error"), std::string::npos);
  options.error = -1;
  EXPECT_NE(refusal(surface, options).find("finite and positive"), std::string::npos);
  options.error = NAN;
  EXPECT_NE(refusal(surface, options).find("finite and positive"), std::string::npos);
  options.error = 1e-30;
  const std::string message = refusal(surface, options);
  const std::size_t at = message.find("take ");
  ASSERT_NE(at, std::string::npos) << message;
  // The named value is taken.
  options.error = std::stod(message.substr(at + 5));
  EXPECT_EQ(tessellate(surface, options, {.max_splits = 1000}).outcome, Outcome::budget_spent);
  options = {};
  options.max_triangles = 10;
  const std::string few = refusal(surface, options);
  ASSERT_NE(few.find("take "), std::string::npos) << few;
  options.max_triangles = std::stoull(few.substr(few.find("take ") + 5));
  EXPECT_LE(tessellate(surface, options).triangles.size(), *options.max_triangles);
  options.max_angle = 0;
  EXPECT_NE(refusal(surface, options).find("angle"), std::string::npos);
}

TEST(tessellate, stops_when_asked) {
  const std::atomic<bool> stop = true;
  const WorkMonitor monitor{{}, &stop};
  EXPECT_THROW(static_cast<void>(tessellate(model("pawn.obj"), to_tolerance(1e-3), {.monitor = &monitor})),
               Interrupted);
}

// A random point of a triangle, and where the surface has its own one.
std::pair<Place, Point3> sample(const Tessellation& t, std::size_t i, std::mt19937_64& random) {
  const TriangleParameter at = testing::random_parameter(random);
  const auto mean = [&](double a, double b, double c) { return (1 - at.u - at.v) * a + at.u * b + at.v * c; };
  const auto& c = t.corners[i];
  const Point3 &p = t.positions[t.triangles[i][0]], &q = t.positions[t.triangles[i][1]],
               &r = t.positions[t.triangles[i][2]];
  return {{c[0].owner, c[0].corner, mean(c[0].u, c[1].u, c[2].u), mean(c[0].v, c[1].v, c[2].v)},
          p + at.u * (q - p) + at.v * (r - p)};
}

// The surface at each parameter is as near to its triangle as the distance from the eye allows; from farther away
// fewer triangles do. Within reach of the eye, too.
TEST(tessellate, shows_no_error_from_where_it_is_seen) {
  std::mt19937_64 random(11);
  for (const char* const file : {"pawn.obj", "bracket.obj"}) {
    const Surface surface = model(file);
    std::size_t before = SIZE_MAX;
    for (const double away : {0.6, 2.0, 20.0}) {
      TessellateOptions options;
      options.corners = true;
      options.view = {{0.1 * surface.size(), 0.2 * surface.size(), away * surface.size()}, 0.05};
      const Tessellation t = tessellate(surface, options);
      testing::expect_watertight(surface, t, file);
      EXPECT_LT(t.triangles.size(), before);
      before = t.triangles.size();
      const double slope = std::sin(0.05 * 3.14159265358979323846 / 180);
      double largest = 0;
      for (std::size_t i = 0; i < t.triangles.size(); ++i) {
        const auto [there, flat] = sample(t, i, random);
        const double error = distance(evaluate(surface, there).point, flat),
                     allowed = slope * distance(flat, options.view->eye);
        EXPECT_LE(error, allowed + 1e-12);
        largest = std::max(largest, error / allowed);
      }
      if (away < 20) {
        EXPECT_GT(largest, 0.2) << "there are no more triangles than needed";
      }
    }
  }
}

// How many pieces a patch has that are split in four until they are thin.
std::size_t thin_pieces(BoundsCache& library, const Patch& patch, double thin) {
  BoundingPoints hull;
  bounding_points(library, patch, hull);
  double longest = 0;
  for (const Box3& box : interval_simplex<3>(hull, limit_corners(patch)).corner) {
    longest = std::max(longest, longest_side(box));
  }
  if (longest <= thin) return 1;
  std::size_t pieces = 0;
  for (unsigned child = 0; child < 4; ++child) pieces += thin_pieces(library, split(patch, child), thin);
  return pieces;
}

// Whole pieces only, split in four until they are thin, as in figure 5-3; flat ones of axes' directions are thin at once.
TEST(tessellate, holds_the_thickness_of_pieces) {
  for (const char* const file : {"pawn.obj", "bracket.obj"}) {
    const Surface surface = model(file);
    std::size_t before = 0;
    for (const double share : {0.02, 0.004, 0.001}) {
      TessellateOptions options;
      options.max_thickness = share * surface.size();
      options.corners = true;
      const Tessellation t = tessellate(surface, options);
      testing::expect_watertight(surface, t, file);
      testing::expect_near(surface, t, file, 2);
      EXPECT_GT(t.triangles.size(), before);
      // A piece and the triangle of its corners are in one hull of boxes; middles of its edges are, too.
      std::vector<Triangle> triangles;
      for (const auto& [x, y, z] : t.triangles)
        triangles.push_back({t.positions[x], t.positions[y], t.positions[z]});
      const double within = 3.5 * *options.max_thickness;
      const Deviation found = deviation(surface, triangles, {.absolute = within / 64, .threshold = within});
      EXPECT_LE(found.from_surface.distance.upper, within);
      EXPECT_LE(found.from_candidate.distance.upper, within);
      before = t.triangles.size();
      const LimitSurface& limit = surface.data()->limit();
      const double scaled = limit.scale().apply(*options.max_thickness);
      std::size_t pieces = 0;
      for (std::size_t p = 0; p < limit.patch_count(); ++p) {
        pieces += thin_pieces(limit.library(), limit.patch(PatchId(p)), scaled);
      }
      EXPECT_GE(t.triangles.size(), pieces) << "each piece is one triangle at least";
      EXPECT_LE(t.triangles.size(), pieces + pieces / 4) << "neighbours are cut as needed";
    }
  }
}

TEST(tessellate, refuses_eyes_and_thicknesses_that_are_none) {
  const Surface surface = model("pawn.obj");
  TessellateOptions options;
  options.view = {{0, 0, NAN}, 0.1};
  EXPECT_NE(refusal(surface, options).find("eye"), std::string::npos);
  options.view = {{0, 0, 9}, 0};
  EXPECT_NE(refusal(surface, options).find("angle"), std::string::npos);
  options.view = {{0, 0, 9}, 90};
  EXPECT_NE(refusal(surface, options).find("angle"), std::string::npos);
  options.view.reset();
  options.max_thickness = -1;
  EXPECT_NE(refusal(surface, options).find("thickness"), std::string::npos);
  // With the eye on the surface the budget ends it.
  options.max_thickness.reset();
  options.view = {tessellate(surface, to_tolerance(surface.size())).positions[0], 0.05};
  EXPECT_EQ(tessellate(surface, options, {.max_splits = 20'000}).outcome, Outcome::budget_spent);
}

}  // namespace
}  // namespace snug::tessellate_test
