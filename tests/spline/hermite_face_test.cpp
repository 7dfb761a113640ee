// Faces over triangles: distances against limit points at the same parameters, which evaluation finds by its own way down, and
// against B-splines by the recursion of their basis functions. Pairs are drawn across smooth and sharp edges alike.

#include <snug/spline/hermite_face.h>
#include <snug/surface/limit_surface.h>

#include <gtest/gtest.h>
#include <oracle/spline_twin.h>
#include <oracle/tagged_shapes.h>
#include <testing/counts.h>
#include <testing/tagged.h>

#include <cmath>
#include <random>

namespace snug::hermite_face_test {
namespace {

double length_of(const std::array<long double, 3>& a, const Point3& b) {
  return static_cast<double>(
      std::sqrt((a[0] - b.x) * (a[0] - b.x) + (a[1] - b.y) * (a[1] - b.y) + (a[2] - b.z) * (a[2] - b.z)));
}

// A triangle, or two with a common edge, the diagonal.
struct Drawn {
  PatchId lower;
  unsigned turn;
  std::optional<PatchId> upper;
  unsigned upper_turn;
};
Drawn drawn(const LimitSurface& surface, PatchId p, std::mt19937_64& random) {
  const auto turn = static_cast<unsigned>(random() % 3);
  Drawn result{p, turn, {}, 0};
  const HalfEdge diagonal = surface.topology().first_of(FaceId(p.index())) + (turn + 2) % 3;
  const HalfEdge twin = surface.topology().twin(diagonal);
  if (twin == no_half_edge || random() % 4 == 0) return result;
  const PatchId other(surface.topology().face_of(twin).index());
  if (other == p || !surface.has_patch(other)) return result;
  result.upper = other;
  result.upper_turn = twin % 3;
  return result;
}

// Of a point of a square: its patch, and there the parameters.
std::pair<PatchId, Place> place_of(const Drawn& d, double u, double v) {
  const bool lower = v <= u;
  const std::array<double, 3> w = lower ? std::array{1 - u, u - v, v} : std::array{1 - v, u, v - u};
  std::array<double, 3> own{};
  for (unsigned k = 0; k < 3; ++k) own[(k + (lower ? d.turn : d.upper_turn)) % 3] = w[k];
  return {lower ? d.lower : *d.upper, {0, 0, own[1], own[2]}};
}

// The same cubic with a knot in the middle of a span; knots are double, so span k has the points 2 k + 1 and 2 k + 2 of its own.
SplineCurve with_knot(const SplineCurve& curve, std::mt19937_64& random) {
  const std::vector<double> breaks = breaks_of(curve.knots);
  const std::size_t spans = breaks.size() - 1, k = random() % spans;
  const auto mean = [](const Point3& a, const Point3& b, double t) { return a + t * (b - a); };
  const auto joint = [&](std::size_t j) {
    if (j == 0) return curve.points.front();
    if (j == spans) return curve.points.back();
    return mean(curve.points[2 * j], curve.points[2 * j + 1],
                (breaks[j] - breaks[j - 1]) / (breaks[j + 1] - breaks[j - 1]));
  };
  const Point3 b0 = joint(k), b1 = curve.points[2 * k + 1], b2 = curve.points[2 * k + 2], b3 = joint(k + 1);
  const Point3 a = mean(b0, b1, 0.5), m = mean(b1, b2, 0.5), d = mean(b2, b3, 0.5);
  SplineCurve result = curve;
  const auto at = static_cast<std::ptrdiff_t>(2 * k + 1);
  result.points.erase(result.points.begin() + at, result.points.begin() + at + 2);
  result.points.insert(result.points.begin() + at, {a, mean(a, m, 0.5), mean(m, d, 0.5), d});
  const double middle = 0.5 * (breaks[k] + breaks[k + 1]);
  result.knots.insert(std::upper_bound(result.knots.begin(), result.knots.end(), middle), 2, middle);
  return result;
}

TEST(hermite_face, is_as_near_to_the_limit_as_it_says) {
  std::mt19937_64 random(9);
  std::size_t pairs = 0, singles = 0, reached = 0, near = 0, all = 0;
  for (const testing::TaggedCase& c : testing::tagged_cases(oracle::PrimalScheme::loop, 43)) {
    SCOPED_TRACE(c.name + ", " + testing::text_of(c.rules));
    const LimitSurface surface(testing::control_mesh(c.mesh, c.rules), testing::options_of(c.rules),
                               std::make_shared<BoundsCache>());
    for (std::size_t p = 0; p < surface.patch_count(); ++p) {
      if (!surface.has_patch(PatchId(p)) || random() % testing::share(4) != 0) continue;
      const Drawn d = drawn(surface, PatchId(p), random);
      const Patch lower = surface.patch(d.lower);
      std::vector<FaceSquare> squares;
      squares.push_back({{lower, d.turn, SquareHalf::lower}, {}});
      std::vector<HermiteCurve> border;
      const auto add_side = [&](const Patch& patch, unsigned corner) {
        TriangleTree tree(patch, corner, SquareHalf::lower);
        border.push_back(curve_near(tree, 0.02));
      };
      add_side(lower, d.turn);
      add_side(lower, d.turn + 1);
      if (d.upper) {
        const Patch upper = surface.patch(*d.upper);
        squares[0].upper.emplace(upper, d.upper_turn, SquareHalf::upper);
        add_side(upper, d.upper_turn + 1);
        add_side(upper, d.upper_turn + 2);
      } else {
        add_side(lower, d.turn + 2);
      }
      HermiteFace face(1, 1, std::move(squares), border);
      reached += face.refine(random() % 4 == 0 ? 0.002 : 0.05, 150) ? 1 : 0;
      const std::vector<FacePart> parts = face.parts();
      const SplineSurface spline = spline_of(parts, 3);
      const double bound = distance_bound(parts, spline);
      ++(d.upper ? pairs : singles);
      double farthest = 0;
      for (int k = 0; k < 40; ++k) {
        // Multiples of 2^-20; every other one near a corner, a side or the diagonal.
        const auto unit = [&] { return std::ldexp(static_cast<double>(random() % ((1u << 20) + 1)), -20); };
        const auto snapped = [](double t) { return std::ldexp(std::round(std::ldexp(t, 20)), -20); };
        double u = unit(), v = unit();
        if (k % 2 == 1) u = snapped(std::pow(u, 6));
        if (k % 4 == 3) v = snapped(std::pow(v, 6));
        if (k % 8 == 6) v = snapped(u * (1 - 0.001 * unit()));
        if (random() % 2 == 0) u = 1 - u;
        if (random() % 2 == 0) v = 1 - v;
        if (!d.upper && v > u) std::swap(u, v);
        const auto [patch, at] = place_of(d, u, v);
        LimitEvaluator evaluator(surface.patch(patch));
        BoundedPoint limit;
        evaluator.points({&at, 1}, {&limit, 1});
        const double apart = length_of(
            oracle::spline_point(spline.degree, spline.u_knots, spline.v_knots, spline.points, u, v),
            limit.position);
        ASSERT_LE(apart, bound + 2 * limit.error) << u << ' ' << v;
        farthest = std::max(farthest, apart);
      }
      ++all;
      if (bound < 1e-13 || farthest > 0.1 * bound) ++near;
      if (d.upper) continue;
      // The diagonal is the third side, from (1, 1) to (0, 0).
      const HermiteCurve third = border[2].reversed();
      const SplineCurve diagonal = diagonal_of(spline);
      EXPECT_LE(distance_from_diagonal(spline, diagonal), 1e-12);
      for (int k = 0; k <= 16; ++k) {
        const double t = k / 16.0;
        const auto there =
            oracle::spline_point(spline.degree, spline.u_knots, spline.v_knots, spline.points, t, t);
        EXPECT_LE(length_of(there, third.origin + third.at(t).point), 1e-12);
      }
      // Of a curve with a point moved; also one with a further knot, and moved where the curve before the knot is not.
      for (SplineCurve moved : {diagonal, with_knot(diagonal, random)}) {
        const bool further = moved.points.size() > diagonal.points.size();
        std::size_t changed = random() % moved.points.size();
        if (further) {
          EXPECT_LE(distance_from_diagonal(spline, moved), 1e-12);
          changed = 0;
          while (moved.knots[changed + 4] == diagonal.knots[changed + 4]) ++changed;
          changed += 4;  // of the curve behind the new knot
        }
        moved.points[changed].y += 0.01;
        double away = 0;
        for (int k = 0; k <= 64; ++k) {
          const double t = k / 64.0;
          std::array<long double, 3> point{};
          const auto basis = oracle::spline_basis(moved.knots, moved.degree, t);
          for (std::size_t i = 0; i < basis.size(); ++i) {
            point[0] += basis[i] * moved.points[i].x;
            point[1] += basis[i] * moved.points[i].y;
            point[2] += basis[i] * moved.points[i].z;
          }
          const auto there =
              oracle::spline_point(spline.degree, spline.u_knots, spline.v_knots, spline.points, t, t);
          away =
              std::max(away, length_of(there, {static_cast<double>(point[0]), static_cast<double>(point[1]),
                                               static_cast<double>(point[2])}));
        }
        EXPECT_GE(distance_from_diagonal(spline, moved), away);
      }
    }
  }
  EXPECT_GT(pairs, testing::share(150));
  EXPECT_GT(singles, testing::share(50));
  EXPECT_GT(reached, all / 2);
  EXPECT_GT(near, all / 4);  // bounds that say something
}

// A quartic on half of a square against a bicubic: the bound is at least the distance at any parameter, and no more than a few times it.
TEST(hermite_face, distances_of_quartics_and_bicubics_are_bounded) {
  std::mt19937_64 random(10);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (std::uint64_t number = 0; number < testing::number_of("SNUG_HERMITE", 300); ++number) {
    const SquareHalf half = number % 2 == 0 ? SquareHalf::lower : SquareHalf::upper;
    QuarticTriangle quartic;
    TensorPiece bicubic = bezier_piece(3);
    for (Vector3& p : quartic.points) p = {unit(random), unit(random), unit(random)};
    for (std::size_t k = 0; k < 16; ++k) bicubic.points[k] = {unit(random), unit(random), unit(random)};
    quartic.largest = 1;
    take_largest(bicubic);
    const auto point = [&](double u, double v) {
      const bool lower = half == SquareHalf::lower;
      const double w[] = {lower ? 1 - u : 1 - v, lower ? u - v : u, lower ? v : v - u};
      Vector3 p;
      for (std::size_t j = 0; j <= 4; ++j) {
        for (std::size_t i = 0; i + j <= 4; ++i) {
          const double ways[] = {1, 1, 2, 6, 24};
          const double share =
              24 / (ways[i] * ways[j] * ways[4 - i - j]) * std::pow(w[0], static_cast<double>(4 - i - j)) *
              std::pow(w[1], static_cast<double>(i)) * std::pow(w[2], static_cast<double>(j));
          p = p + share * quartic.points[bezier_index(4, i, j)];
        }
      }
      return p;
    };
    const double bound = distance_bound(quartic, bicubic, half);
    double farthest = 0;
    for (int k = 0; k <= 12; ++k) {
      for (int l = 0; l + k <= 12; ++l) {
        const double u = half == SquareHalf::lower ? (k + l) / 12.0 : k / 12.0,
                     v = half == SquareHalf::lower ? l / 12.0 : (k + l) / 12.0;
        farthest = std::max(farthest, length(point(u, v) - value(bicubic, u, v)));
      }
    }
    EXPECT_GE(bound * (1 + 1e-12), farthest);
    EXPECT_LE(bound, 4 * farthest);
    // On a rectangle, in the triangle or on its sides.
    const auto sixteenth = [&](std::uint64_t low, std::uint64_t high) {
      return static_cast<double>(low + random() % (high - low + 1)) / 16;
    };
    ParameterBox box;
    box.u0 = sixteenth(1, 15);
    box.u1 = sixteenth(static_cast<std::uint64_t>(16 * box.u0) + 1, 16);
    box.v1 = sixteenth(1, static_cast<std::uint64_t>(16 * box.u0));
    box.v0 = sixteenth(0, static_cast<std::uint64_t>(16 * box.v1) - 1);
    if (half == SquareHalf::upper) box = {box.v0, box.v1, box.u0, box.u1};
    const double here = distance_bound(quartic, bicubic, half, box);
    double away = 0;
    for (int k = 0; k <= 8; ++k) {
      for (int l = 0; l <= 8; ++l) {
        const double u = box.u0 + (box.u1 - box.u0) * k / 8, v = box.v0 + (box.v1 - box.v0) * l / 8;
        away = std::max(away, length(point(u, v) - value(bicubic, k / 8.0, l / 8.0)));
      }
    }
    EXPECT_GE(here * (1 + 1e-12), away);
    EXPECT_LE(here, 4 * away);
  }
}

// Of a polynomial that is both, a + b u + c v + d u v, nothing but rounding is left.
TEST(hermite_face, equal_polynomials_have_no_distance) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (std::uint64_t number = 0; number < testing::number_of("SNUG_HERMITE_EQUAL", 40); ++number) {
    const SquareHalf half = number % 2 == 0 ? SquareHalf::lower : SquareHalf::upper;
    std::array<Vector3, 4> c;
    for (Vector3& x : c) x = {unit(random), unit(random), unit(random)};
    // Its polar form at four points; at three pairs of parameters of a bicubic it is itself at their means.
    const auto form = [&](const std::array<double, 4>& u, const std::array<double, 4>& v) {
      double product = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        for (std::size_t l = 0; l < 4; ++l) product += k == l ? 0 : u[k] * v[l] / 12;
      }
      return c[0] + ((u[0] + u[1] + u[2] + u[3]) / 4) * c[1] + ((v[0] + v[1] + v[2] + v[3]) / 4) * c[2] +
             product * c[3];
    };
    QuarticTriangle quartic;
    quartic.largest = 4;
    const std::array<double, 3> cu{0, 1, half == SquareHalf::lower ? 1.0 : 0.0},
        cv{0, half == SquareHalf::lower ? 0.0 : 1.0, 1};
    for (std::size_t j = 0; j <= 4; ++j) {
      for (std::size_t i = 0; i + j <= 4; ++i) {
        std::array<double, 4> u{}, v{};
        for (std::size_t k = 0; k < 4; ++k) {
          const std::size_t corner = k < i ? 1 : k < i + j ? 2 : 0;
          u[k] = cu[corner];
          v[k] = cv[corner];
        }
        quartic.points[bezier_index(4, i, j)] = form(u, v);
      }
    }
    TensorPiece bicubic = bezier_piece(3);
    for (std::size_t j = 0; j < 4; ++j) {
      for (std::size_t i = 0; i < 4; ++i) {
        const double u = static_cast<double>(i) / 3, v = static_cast<double>(j) / 3;
        bicubic.at(i, j) = c[0] + u * c[1] + v * c[2] + (u * v) * c[3];
      }
    }
    take_largest(bicubic);
    EXPECT_LE(distance_bound(quartic, bicubic, half), 1e-12);
    const ParameterBox box = half == SquareHalf::lower ? ParameterBox{0.5, 0.875, 0.125, 0.5}
                                                       : ParameterBox{0.125, 0.5, 0.5, 0.875};
    EXPECT_LE(distance_bound(quartic, bezier_on(bicubic, box), half, box), 1e-12);
    bicubic.at(1, 2).x += 0.01;
    EXPECT_GE(distance_bound(quartic, bezier_on(bicubic, box), half, box), 1e-4);
  }
}

// Over boxes of every shape, on either half, across the diagonal or not: no farther than the bound, wherever the bicubic is far.
TEST(hermite_face, distances_over_boxes_are_bounded) {
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::size_t boxes = 0, across = 0, beside = 0;
  double ratio = 0;
  for (const testing::TaggedCase& c : testing::tagged_cases(oracle::PrimalScheme::loop, 44)) {
    SCOPED_TRACE(c.name + ", " + testing::text_of(c.rules));
    const LimitSurface surface(testing::control_mesh(c.mesh, c.rules), testing::options_of(c.rules),
                               std::make_shared<BoundsCache>());
    for (std::size_t p = 0; p < surface.patch_count(); ++p) {
      if (!surface.has_patch(PatchId(p)) || random() % testing::share(2) != 0) continue;
      const Patch patch = surface.patch(PatchId(p));
      const auto turn = static_cast<unsigned>(random() % 3);
      const bool lower = random() % 2 == 0;
      const auto interval = [&](std::uint64_t levels) {
        const int level = static_cast<int>(random() % levels);
        const std::uint64_t all = std::uint64_t{1} << level, k = random() % all;
        // A dyadic one, or as many of these as may be.
        const std::uint64_t end = random() % 2 == 0 ? k + 1 : k + 1 + random() % (all - k);
        return std::pair(std::ldexp(static_cast<double>(k), -level),
                         std::ldexp(static_cast<double>(end), -level));
      };
      const auto [u0, u1] = interval(6);
      const auto [v0, v1] = interval(6);
      if (lower ? v0 >= u1 : u0 >= v1) continue;
      TriangleTree tree(patch, turn, lower ? SquareHalf::lower : SquareHalf::upper);
      LimitEvaluator evaluator(patch);
      const auto limit = [&](double u, double v) {
        const std::array<double, 3> w = lower ? std::array{1 - u, u - v, v} : std::array{1 - v, u, v - u};
        std::array<double, 3> own{};
        for (unsigned k = 0; k < 3; ++k) own[(k + turn) % 3] = w[k];
        const Place at{0, 0, own[1], own[2]};
        BoundedPoint point;
        evaluator.points({&at, 1}, {&point, 1});
        return point.position - patch.origin;
      };
      // About there, with one point far away, often the one at the corner that is farthest from the diagonal.
      TensorPiece bicubic = bezier_piece(3);
      const Vector3 near = limit(lower ? u1 : u0, lower ? v0 : v1);
      std::fill_n(bicubic.points.begin(), 16, near);
      Vector3& far = bicubic.points[random() % 2 == 0 ? random() % 16 : lower ? 3 : 12];
      far = far + Vector3{unit(random), unit(random), unit(random)};
      take_largest(bicubic);
      const double bound = tree.distance({u0, u1, v0, v1}, bicubic, 0);
      double farthest = 0;
      for (int k = 0; k <= 16; ++k) {
        for (int l = 0; l <= 16; ++l) {
          const double x = k / 16.0, y = l / 16.0, u = u0 + x * (u1 - u0), v = v0 + y * (v1 - v0);
          if (lower ? v <= u : u <= v)
            farthest = std::max(farthest, length(limit(u, v) - value(bicubic, x, y)));
        }
      }
      EXPECT_GE(bound * (1 + 1e-9) + 1e-12, farthest) << u0 << ' ' << u1 << ' ' << v0 << ' ' << v1;
      ++boxes;
      across += v1 > u0 && u1 > v0 ? 1 : 0;
      beside += lower ? v0 < u0 && u0 < v1 && v1 < u1 : u0 < v0 && v0 < u1 && u1 < v1;
      ratio += bound / farthest;
    }
  }
  EXPECT_GT(boxes, testing::share(200));
  EXPECT_GT(across, boxes / 4);
  EXPECT_GT(beside, boxes / 50);  // a triangle and two rectangles
  EXPECT_LT(ratio, 2 * static_cast<double>(boxes));
}

// About a corner of high valence: a plane in the inner ball, the limit surface beyond the outer one, smooth between them, and the same
// from both sides of an edge.
TEST(hermite_face, flattened_surfaces_are_smooth_and_the_same_from_both_sides) {
  constexpr std::uint32_t n = 13;
  constexpr double radius = 0.2, size = 0x1p-14;
  oracle::TaggedMesh mesh = oracle::meshes::triangulated(oracle::meshes::pyramid(n));
  for (std::size_t k = 0; k < mesh.points.size(); ++k)
    mesh.points[k][2] += 0.2 * std::cos(2.0 * static_cast<double>(k));
  const LimitSurface surface(testing::control_mesh(mesh), {.scheme = Scheme::loop},
                             std::make_shared<BoundsCache>());
  std::size_t flat = 0, between = 0, beyond = 0;
  const Topology& topology = surface.topology();
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    const auto names = surface.corner_names(PatchId(p));
    for (unsigned k = 0; k < 3; ++k) {
      if (topology.face_valence(VertexId(names[k])) != n) continue;
      TriangleTree plain(surface.patch(PatchId(p)), k, SquareHalf::lower), tree = plain;
      tree.flatten(0, radius);
      const Vector3 center = plain.limit(0, 0), normal = *plain.normal(0);
      const HalfEdge twin = topology.twin(topology.first_of(FaceId(static_cast<std::uint32_t>(p))) + k);
      const PatchId other(topology.face_of(twin).index());
      TriangleTree across(surface.patch(other), twin % 3 + 1, SquareHalf::upper);
      across.flatten(0, radius);
      for (int i = 1; i <= 64; ++i) {
        const double u = std::pow(i / 65.0, 2), v = u * ((7 * i) % 64) / 64.0;
        const double away = length(plain.limit(u, v) - center),
                     height = dot(normal, tree.limit(u, v) - center);
        if (away < 0.149 * radius) {
          ++flat;
          EXPECT_LE(std::fabs(height), 1e-15);
        }
        if (away > radius) {
          ++beyond;
          EXPECT_EQ(length(tree.limit(u, v) - plain.limit(u, v)), 0);
        }
        if (away > 0.15 * radius && away < radius) ++between;
        const CornerJet jet = *tree.jet(u, 0);
        const double h = size * u;
        const CornerJet left = *tree.jet(u - h, 0), right = *tree.jet(u + h, 0);
        EXPECT_LE(length((1 / (2 * h)) * (right.point - left.point) - jet.along_u),
                  1e-4 * length(jet.along_u));
        EXPECT_LE(length((1 / (2 * h)) * (right.along_v - left.along_v) - jet.twist),
                  1e-4 * (length(jet.twist) + length(jet.along_v) / u));
        const CornerJet inside = *tree.jet(u, 0.5 * u), above = *tree.jet(u, 0.5 * u + h),
                        below = *tree.jet(u, 0.5 * u - h);
        EXPECT_LE(length((1 / (2 * h)) * (above.point - below.point) - inside.along_v),
                  1e-4 * length(inside.along_v));
        EXPECT_LE(length((1 / (2 * h)) * (above.along_u - below.along_u) - inside.twist),
                  1e-4 * (length(inside.twist) + length(inside.along_u) / u));
        // The other triangle has the edge on its diagonal's opposite side: from its corner 0 along u = 0.
        const CornerJet there = *across.jet(0, u);
        const Vector3 shift = across.origin() - tree.origin();
        EXPECT_LE(length(there.point + shift - jet.point), 1e-14);
        EXPECT_LE(length(there.along_v - jet.along_u), 1e-11 * length(jet.along_u));
        // Both derivatives across: the same plane.
        EXPECT_LE(std::fabs(dot(cross(jet.along_u, jet.along_v), there.along_u)),
                  1e-9 * length(jet.along_u) * length(jet.along_v) * length(there.along_u));
      }
    }
  }
  EXPECT_GE(flat, n);
  EXPECT_GE(between, 5 * n);
  EXPECT_GE(beyond, 5 * n);
}

}  // namespace
}  // namespace snug::hermite_face_test
