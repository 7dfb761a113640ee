// Quads as polynomials, and these as B-splines: distances against limit points at the same parameters, which evaluation finds
// by its own way down, and against B-splines by the recursion of their basis functions.

#include <snug/spline/face_spline.h>
#include <snug/spline/quad_pieces.h>
#include <snug/surface/evaluate.h>

#include <gtest/gtest.h>
#include <oracle/spline_twin.h>
#include <testing/counts.h>
#include <testing/tagged.h>

#include <cmath>
#include <random>

namespace snug::face_spline_test {
namespace {

using testing::number_of;

double length_of(const std::array<long double, 3>& a, const Point3& b) {
  return static_cast<double>(
      std::sqrt((a[0] - b.x) * (a[0] - b.x) + (a[1] - b.y) * (a[1] - b.y) + (a[2] - b.z) * (a[2] - b.z)));
}

struct Case {
  std::string name;
  ControlMesh mesh;
  SchemeOptions options;
};

// All shapes, rules and tags of Catmull-Clark; and shapes of the other schemes of quads.
std::vector<Case> cases(std::uint64_t seed) {
  std::vector<Case> list;
  for (const testing::TaggedCase& c : testing::tagged_cases(oracle::PrimalScheme::catmull_clark, seed))
    list.push_back({c.name, testing::control_mesh(c.mesh, c.rules), testing::options_of(c.rules)});
  std::mt19937_64 random(seed);
  for (const Scheme scheme : {Scheme::doo_sabin, Scheme::bilinear}) {
    for (const auto& mesh : {oracle::meshes::cube(), oracle::meshes::prism(5), oracle::meshes::pyramid(7),
                             oracle::meshes::quad_grid(4, 4)}) {
      SchemeOptions options;
      options.scheme = scheme;
      list.push_back(
          {name_of(scheme), testing::control_mesh(oracle::meshes::shaken(mesh, 0.2, random)), options});
    }
  }
  return list;
}

TEST(face_spline, is_as_near_to_the_limit_as_it_says) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t quads = 0, tips = 0, bent = 0, merged = 0, near = 0;
  for (const Case& c : cases(41)) {
    SCOPED_TRACE(c.name);
    const LimitSurface surface(c.mesh, c.options, std::make_shared<BoundsCache>());
    for (std::size_t p = 0; p < surface.patch_count(); p += 2) {
      if (!surface.has_patch(PatchId(p)) || random() % testing::share(3) != 0) continue;
      const Patch patch = surface.patch(PatchId(p));
      QuadDepths depths;
      for (std::uint8_t& d : depths.corners) d = static_cast<std::uint8_t>(1 + random() % 4);
      const auto deepest = *std::max_element(depths.corners.begin(), depths.corners.end());
      depths.corners.fill(deepest);
      depths.sides.fill(random() % 3 == 0 ? 1 : deepest);
      if (depths.sides[0] < deepest) depths.corners.fill(1);
      std::array<QuadFlat, 4> flats{};
      if (!patch.kind->transient() && tensor_degree(surface.rules().basis) == 3 && random() % 2 == 0) {
        for (QuadFlat& flat : flats) flat = {0.3 * unit(random), 2, static_cast<unsigned>(random() % 3)};
      }
      QuadPieces quad(patch, depths, 0.05, flats);
      std::vector<FacePart> parts;
      double area = 0;
      for (QuadPiece& piece : quad.take()) {
        const ParameterBox box = piece.box();
        area += (box.u1 - box.u0) * (box.v1 - box.v0);
        tips += piece.tip ? 1 : 0;
        merged += piece.columns * piece.rows > 1 ? 1 : 0;
        bent += piece.bent ? 1 : 0;
        parts.push_back({box, piece.piece, patch.origin, piece.tip || piece.bent, piece.distance});
      }
      ASSERT_EQ(area, 1);
      ++quads;
      const std::size_t natural = tensor_degree(surface.rules().basis);
      const SplineSurface spline = spline_of(parts, natural);
      ASSERT_EQ(spline.points.size(), spline.columns() * spline.rows());
      const double bound = distance_bound(parts, spline);
      LimitEvaluator evaluator(patch);
      double farthest = 0;
      for (int k = 0; k < 60; ++k) {
        // Every other one near a corner or a side.
        double u = unit(random), v = unit(random);
        if (k % 2 == 1) u = std::pow(u, 6);
        if (k % 4 == 3) v = std::pow(v, 6);
        if (random() % 2 == 0) u = 1 - u;
        if (random() % 2 == 0) v = 1 - v;
        const Place at{0, 0, u, v};
        BoundedPoint limit;
        evaluator.points({&at, 1}, {&limit, 1});
        const double apart = length_of(
            oracle::spline_point(spline.degree, spline.u_knots, spline.v_knots, spline.points, u, v),
            limit.position);
        ASSERT_LE(apart, bound + 2 * limit.error) << u << ' ' << v;
        farthest = std::max(farthest, apart);
      }
      if (bound < 1e-13 || farthest > 0.1 * bound) ++near;
    }
  }
  EXPECT_GT(quads, testing::share(250));
  EXPECT_GT(tips, testing::share(500));
  EXPECT_GT(merged, testing::share(20));
  EXPECT_GT(bent, testing::share(500));
  EXPECT_GT(near, quads / 4);  // bounds that say something
}

TEST(face_spline, of_a_regular_quad_is_its_lattice) {
  std::mt19937_64 random(6);
  for (const Scheme scheme : {Scheme::catmark, Scheme::doo_sabin}) {
    SchemeOptions options;
    options.scheme = scheme;
    const ControlMesh mesh =
        testing::control_mesh(oracle::meshes::shaken(oracle::meshes::quad_grid(5, 5), 0.3, random));
    const LimitSurface surface(mesh, options, std::make_shared<BoundsCache>());
    for (std::size_t p = 0; p < surface.patch_count(); p += 2) {
      if (!surface.has_patch(PatchId(p)) || !surface.kind(PatchId(p)).polynomial()) continue;
      const Patch patch = surface.patch(PatchId(p));
      QuadPieces quad(patch, {}, 1);
      const std::vector<QuadPiece> pieces = quad.take();
      ASSERT_EQ(pieces.size(), 1u);
      const std::vector<FacePart> parts{{pieces[0].box(), pieces[0].piece, patch.origin, false, 0}};
      const SplineSurface spline = spline_of(parts, pieces[0].piece.degree);
      EXPECT_EQ(spline.points.size(), pieces[0].piece.count());
      EXPECT_LE(distance_bound(parts, spline), 1e-13);
    }
  }
}

// A part of a curve is the curve there, whichever knots it has; and what is moved is seen.
TEST(face_spline, curves_are_cut_turned_and_compared) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (std::uint64_t number = 0; number < number_of("SNUG_CURVES", 200); ++number) {
    SplineCurve curve;
    curve.degree = static_cast<unsigned>(1 + random() % 3);
    curve.knots.assign(curve.degree + 1, 0.0);
    double at = 0;
    for (std::size_t k = random() % 6; k > 0; --k) {
      at += std::ldexp(1.0, -static_cast<int>(random() % 5));
      curve.knots.insert(curve.knots.end(), 1 + random() % curve.degree, at);
    }
    curve.knots.insert(curve.knots.end(), curve.degree + 1, at + 1);
    for (std::size_t k = 0; k + curve.degree + 1 < curve.knots.size(); ++k)
      curve.points.push_back({unit(random), unit(random), unit(random)});
    const std::vector<double> breaks = breaks_of(curve.knots);
    const std::size_t from = random() % (breaks.size() - 1),
                      to = from + 1 + random() % (breaks.size() - from - 1);
    const SplineCurve part = part_of(curve, breaks[from], breaks[to]), back = reversed(part);
    const auto point = [](const SplineCurve& c, double t) {
      const std::vector<double> none{0, 1};
      std::array<long double, 3> sum{};
      const auto basis = oracle::spline_basis(c.knots, c.degree, t);
      for (std::size_t i = 0; i < basis.size(); ++i) {
        sum[0] += basis[i] * c.points[i].x;
        sum[1] += basis[i] * c.points[i].y;
        sum[2] += basis[i] * c.points[i].z;
      }
      return Point3{static_cast<double>(sum[0]), static_cast<double>(sum[1]), static_cast<double>(sum[2])};
    };
    const double length = breaks[to] - breaks[from];
    for (int k = 0; k <= 8; ++k) {
      const double t = length * k / 8;
      EXPECT_LE(distance(point(part, t), point(curve, breaks[from] + t)), 1e-11);
      EXPECT_LE(distance(point(back, length - t), point(part, t)), 1e-13);
    }
    SplineCurve moved = part;
    const Vector3 by{unit(random), 0, 0};
    moved.points[random() % moved.points.size()] = moved.points[0] + by;
    double farthest = 0;
    for (int k = 0; k <= 64; ++k)
      farthest = std::max(farthest, distance(point(part, length * k / 64), point(moved, length * k / 64)));
    EXPECT_GE(distance_bound(part, moved), farthest);
    EXPECT_LE(distance_bound(part, reversed(back)), 1e-12);
  }
}

}  // namespace
}  // namespace snug::face_spline_test
