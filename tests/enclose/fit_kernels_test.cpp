#include <snug/enclose/fit_kernels.h>

#include <gtest/gtest.h>
#include <snug/enclose/table_kernel.h>
#include <snug/enclose/table_triangle.h>
#include <testing/containment.h>
#include <testing/patches.h>

#include <hwy/targets.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <string>

namespace snug {
namespace {

using kernels::Coordinates;
using testing::Quad;

struct Cloud {
  std::vector<double> x, y, z;
  explicit Cloud(const std::vector<Vector3>& points) {
    for (const Vector3& p : points) {
      x.push_back(p.x);
      y.push_back(p.y);
      z.push_back(p.z);
    }
  }
  [[nodiscard]] Coordinates all() const { return {x.data(), y.data(), z.data(), x.size()}; }
};

class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}
  [[nodiscard]] double unit() { return static_cast<double>(bits_() >> 11) * 0x1p-52 - 1; }
  [[nodiscard]] std::size_t below(std::size_t n) { return bits_() % n; }
  [[nodiscard]] Vector3 vector(double size = 1) { return {size * unit(), size * unit(), size * unit()}; }

 private:
  std::mt19937_64 bits_;
};

// Triangles of every shape, some in a coordinate plane, some thin.
std::array<Vector3, 3> random_triangle(Random& random) {
  const double size = std::ldexp(1.0, -static_cast<int>(random.below(24)));
  std::array<Vector3, 3> t{random.vector(), {}, {}};
  const Vector3 e = random.vector(size), f = random.vector(size);
  t[1] = t[0] + e;
  t[2] = t[0] + (random.unit() * e) + std::ldexp(1.0, -static_cast<int>(random.below(12))) * f;
  if (random.below(4) == 0) t[0].z = t[1].z = t[2].z = 0;
  return t;
}

// Near the triangle's corners and edges as well as far from it.
Vector3 random_point(Random& random, const std::array<Vector3, 3>& t) {
  const double u = 1.5 * random.unit(), v = 1.5 * random.unit();
  const Vector3 e = t[1] - t[0], f = t[2] - t[0];
  const double away = std::ldexp(1.0, -static_cast<int>(random.below(60)));
  switch (random.below(4)) {
    case 0:
      return t[random.below(3)] + away * random.vector(max_abs(e));
    case 1:
      return t[0] + u * e + away * random.vector(max_abs(e));
    case 2:
      return t[0] + u * e + v * f + away * cross(e, f);
    default:
      return t[0] + random.vector(4 * (max_abs(e) + max_abs(f)));
  }
}

double exact_distance(const Vector3& p, const std::array<Vector3, 3>& t) {
  const Point3 zero;
  const Triangle triangle{zero + t[0], zero + t[1], zero + t[2]};
  return static_cast<double>(std::sqrt(static_cast<long double>(
      testing::distance_sq_to_triangle(testing::extended<Quad>(zero + p), triangle))));
}

TEST(farthest, is_an_upper_bound_within_its_own_rounding) {
  Random random(1);
  std::size_t answered = 0;
  double most_used = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const auto t = random_triangle(random);
    std::vector<Vector3> points(1 + random.below(13));
    double exact = 0;
    for (Vector3& p : points) {
      p = random_point(random, t);
      exact = std::max(exact, exact_distance(p, t));
    }
    const Cloud cloud(points);
    const auto reach = kernels::farthest(cloud.all(), t[0], t[1], t[2]);
    if (!reach) continue;
    ++answered;
    ASSERT_GE(reach->distance, exact * (1 - 1e-15)) << trial;
    ASSERT_GT(reach->rounding, 0);
    // What it says beyond its own rounding is no more than the truth.
    ASSERT_LE(reach->distance - 2 * reach->rounding, exact * (1 + 1e-11)) << trial;
    most_used = std::max(most_used, std::fabs(reach->distance - reach->rounding - exact) / reach->rounding);

    const std::size_t split = random.below(points.size() + 1);
    const auto parts = kernels::farthest(cloud.all(), split, t[0], t[1], t[2]);
    ASSERT_TRUE(parts);
    EXPECT_EQ(std::max((*parts)[0].distance, (*parts)[1].distance), reach->distance);
  }
  EXPECT_GT(answered, 7000u);
  EXPECT_LT(most_used, 1);
}

// Rounding turns the normal of this needle round.
TEST(farthest, does_not_answer_for_needles_and_triangles_without_area) {
  const Cloud cloud({{0, 0, 0.25}});
  EXPECT_FALSE(kernels::farthest(cloud.all(), {}, {-0x1.ba89316747ec1p-1, 0x1.7c4e6627d2f1p-3, 0},
                                 {0x1.46b9c4b39a8bcp+0, -0x1.18c8035243c3fp-2, 0}));
  EXPECT_FALSE(kernels::farthest(cloud.all(), {}, {}, {}));
  EXPECT_FALSE(kernels::farthest(cloud.all(), {}, {1, 1, 1}, {2, 2, 2}));
  EXPECT_FALSE(kernels::farthest(cloud.all(), {1, 0, 0}, {1, 0, 0}, {0, 1, 0}));
  EXPECT_FALSE(kernels::farthest(cloud.all(), {}, {NAN, 1, 1}, {2, 2, 2}));
  Random random(2);
  for (int trial = 0; trial < 20000; ++trial) {
    Vector3 b = random.vector();
    b.z = 0;
    const Vector3 c = random.unit() * b;
    const auto reach = kernels::farthest(cloud.all(), {}, b, c);
    if (reach) {
      EXPECT_GE(reach->distance, 0.25) << trial;
    }
  }
}

TEST(farthest, is_not_finite_where_a_point_is_not) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (std::size_t place = 0; place < 9; ++place) {
      std::vector<Vector3> points(9, Vector3{0.2, 0.2, 0.1});
      points[place].y = bad;
      const auto reach = kernels::farthest(Cloud(points).all(), {}, {1, 0, 0}, {0, 1, 0});
      EXPECT_TRUE(!reach || !std::isfinite(reach->distance)) << place;
    }
  }
}

TEST(apply_rows_and_heights, are_plain_loops) {
  Random random(3);
  for (std::size_t rows = 1; rows < 40; ++rows) {
    const std::size_t columns = 1 + random.below(30);
    std::vector<double> weights(rows * columns), x(rows), y(rows), z(rows);
    for (double& w : weights) w = random.unit();
    std::vector<Vector3> points(columns);
    for (Vector3& p : points) p = random.vector();
    kernels::apply_rows(weights.data(), rows, points, x.data(), y.data(), z.data());
    const Vector3 from = random.vector(), normal = random.vector();
    double lower = INFINITY, upper = -INFINITY;
    for (std::size_t r = 0; r < rows; ++r) {
      Vector3 sum;
      for (std::size_t c = 0; c < columns; ++c) sum = sum + weights[c * rows + r] * points[c];
      EXPECT_EQ(x[r], sum.x);
      EXPECT_EQ(y[r], sum.y);
      EXPECT_EQ(z[r], sum.z);
      const double height = dot(normal, sum - from);
      lower = std::min(lower, height);
      upper = std::max(upper, height);
    }
    const kernels::Range range = kernels::heights({x.data(), y.data(), z.data(), rows}, from, normal);
    EXPECT_EQ(range.lower, lower);
    EXPECT_EQ(range.upper, upper);
  }
}

// Patches of one kind with control points of their own.
struct Batch {
  std::vector<Point3> points;
  std::vector<VertexId> control;
  std::vector<Patch> patches;
};

Batch batch(const Kind& kind, std::size_t count, Random& random, double size, const Vector3& at) {
  Batch result;
  // Places of a regular kind; further ones anywhere around.
  constexpr double places[12][2] = {{0, 0},  {1, 0},  {0, 1},  {1, -1}, {1, 1}, {-1, 1},
                                    {-1, 0}, {0, -1}, {2, -1}, {2, 0},  {0, 2}, {-1, 2}};
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<Point3> own;
    for (std::size_t k = 0; k < kind.control_count(); ++k) {
      const Vector3 place = k < 12 ? Vector3{places[k][0], places[k][1], 0} : random.vector(2);
      own.push_back(Point3{} + at + size * (place + random.vector(0.2)));
      result.control.push_back(VertexId(result.points.size()));
      result.points.push_back(own.back());
    }
    result.patches.push_back(make_patch(kind, 0, own));
  }
  return result;
}

TEST(fit_regular, is_the_offset_triangle_of_the_hull_rows_and_holds_the_patch) {
  BoundLibrary library;
  const Kind& kind = library.kinds().find({});
  Random random(4);
  for (std::size_t count = 1; count < 10; ++count) {
    for (const double size : {1.0, 1e-8, 1e-100}) {
      const Batch b = batch(kind, count, random, size, count % 2 ? Vector3{1.5, -1, 0.3} : Vector3{});
      std::vector<kernels::BatchFit> out(count);
      kernels::fit_regular(b.points, b.control, out);
      for (std::size_t i = 0; i < count; ++i) {
        HullPoints hull;
        hull_points(library.rows(kind), b.patches[i], hull);
        const OffsetTriangle expected = offset_triangle(hull, limit_corners(b.patches[i]));
        if (out[i].radius < 0) {
          EXPECT_LT(size, 1e-50);
          continue;
        }
        const double noise = 1e-14 * (size + (count % 2 ? 1.5 : 0));
        for (std::size_t k = 0; k < 3; ++k) EXPECT_LT(max_abs(out[i].base[k] - expected.base[k]), noise);
        EXPECT_NEAR(out[i].radius, expected.radius, 1e-11 * expected.radius + noise);
        for (int u = 0; u <= 6; ++u) {
          for (int v = 0; u + v <= 6; ++v) {
            const LimitPoint p = limit_point(b.patches[i], {u / 6.0, v / 6.0});
            testing::Extended at;
            for (std::size_t a = 0; a < 3; ++a)
              at[a] = static_cast<long double>(b.patches[i].origin[a]) + p.relative[a];
            EXPECT_TRUE(testing::within_radius(at, {out[i].base[0], out[i].base[1], out[i].base[2]},
                                               out[i].radius + 2 * p.error));
          }
        }
      }
    }
  }
}

TEST(fit_regular, marks_what_it_does_not_answer_and_nothing_beside_it) {
  BoundLibrary library;
  Random random(5);
  Batch b = batch(library.kinds().find({}), 9, random, 1, {});
  for (std::size_t k = 0; k < 12; ++k) {
    b.points[12 + k] = {};                              // a point
    b.points[36 + k] = {static_cast<double>(k), 0, 0};  // a line
    b.points[60 + k].y *= 1e-9;                         // a needle
    b.points[60 + k].z *= 1e-9;
  }
  b.points[84 + 3].z = NAN;
  std::vector<kernels::BatchFit> out(9);
  kernels::fit_regular(b.points, b.control, out);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(out[i].radius < 0, i % 2 == 1) << i;
}

TEST(fit_table, is_the_tables_offset_triangle) {
  BoundLibrary library;
  Random random(6);
  for (const std::size_t valence : {6u, 5u, 9u, 40u}) {
    const CornerFan fan{0, static_cast<std::uint16_t>(valence - 1), true, false};
    const Kind& kind = library.kinds().find({Scheme::loop, {CornerFan{}, CornerFan{}, fan}});
    const BoundTable& table = library.table(kind);
    for (std::size_t count = 1; count < 10; ++count) {
      Batch b = batch(kind, count, random, 0.5, {});
      const std::size_t broken = random.below(count + 1);
      if (broken < count) {
        b.points[broken * kind.control_count() + 5].x = count % 2 ? NAN : INFINITY;
      }
      std::vector<kernels::BatchFit> out(count);
      kernels::fit_table(table, b.points, b.control, out);
      for (std::size_t i = 0; i < count; ++i) {
        if (i == broken) {
          EXPECT_EQ(out[i].radius, INFINITY);
          continue;
        }
        const OffsetTriangle expected = offset_triangle(table_triangle(table, b.patches[i]));
        for (std::size_t k = 0; k < 3; ++k) EXPECT_LT(max_abs(out[i].base[k] - expected.base[k]), 1e-12);
        EXPECT_NEAR(out[i].radius, expected.radius, 1e-12);
        EXPECT_GT(out[i].rounding, 0);
        EXPECT_LT(out[i].rounding, 1e-11);
      }
    }
  }
}

TEST(kernels, have_the_same_bits_on_every_instruction_set) {
  BoundLibrary library;
  const Kind& kind = library.kinds().find({});
  const BoundRows& rows = library.rows(kind);
  Random random(7);
  const Batch b = batch(kind, 7, random, 1, {0.1, 0.2, 0.3});
  const auto t = random_triangle(random);
  const auto everything = [&] {
    std::vector<double> all;
    HullPoints hull;
    for (const Patch& patch : b.patches) {
      hull_points(rows, patch, hull);
      const Coordinates points = hull.coordinates();
      all.insert(all.end(), points.x, points.x + points.count);
      const kernels::Range range = kernels::heights(points, t[0], t[1]);
      const auto reach = kernels::farthest(points, {}, {1, 0, 0}, {0.3, 1, 0.1});
      all.insert(all.end(), {range.lower, range.upper, reach->distance, reach->rounding});
    }
    std::vector<kernels::BatchFit> out(7);
    for (const bool tables : {false, true}) {
      tables ? kernels::fit_table(library.table(kind), b.points, b.control, out)
             : kernels::fit_regular(b.points, b.control, out);
      for (const kernels::BatchFit& fit : out) {
        for (const Point3& p : fit.base) all.insert(all.end(), {p.x, p.y, p.z});
        all.insert(all.end(), {fit.radius, fit.rounding});
      }
    }
    return all;
  };
  const std::vector<double> expected = everything();
  std::set<std::string> names;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    const std::vector<double> found = everything();
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(std::bit_cast<std::uint64_t>(found[i]), std::bit_cast<std::uint64_t>(expected[i]))
          << kernels::instruction_set() << " " << i;
    }
    names.insert(kernels::instruction_set());
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  EXPECT_GE(names.size(), 2u);
}

}  // namespace
}  // namespace snug
