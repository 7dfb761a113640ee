#include <snug/bounds/fit_kernels.h>

#include <gtest/gtest.h>
#include <oracle/loop_twin.h>
#include <snug/geometry/rounding.h>
#include <testing/containment.h>
#include <testing/instruction_sets.h>
#include <testing/patches.h>

#include <bit>
#include <random>
#include <string>

namespace snug::fit_kernels_test {
namespace {

using testing::Quad;
using Random = std::mt19937_64;

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

Vector3 any_vector(Random& random, double size) {
  return {uniform(random, -size, size), uniform(random, -size, size), uniform(random, -size, size)};
}

// One array a coordinate, as the kernels read them.
struct Cloud {
  std::vector<double> x, y, z;
  void add(const Vector3& p) {
    x.push_back(p.x);
    y.push_back(p.y);
    z.push_back(p.z);
  }
  [[nodiscard]] kernels::Coordinates coordinates() const { return {x.data(), y.data(), z.data(), x.size()}; }
  [[nodiscard]] Vector3 at(std::size_t i) const { return {x[i], y[i], z[i]}; }
};

using Corners = std::array<Vector3, 3>;

Triangle placed(const Corners& c) { return {Point3{} + c[0], Point3{} + c[1], Point3{} + c[2]}; }

std::optional<kernels::Reach> farthest(const Cloud& cloud, const Corners& c) {
  const auto parts = kernels::farthest(cloud.coordinates(), {}, c[0], c[1], c[2]);
  return parts ? std::optional((*parts)[3]) : std::nullopt;
}

// ---- the twin: exact enough, and written without a plane's frame ----

template <class Real>
Real root(Real square) {  // of a square from doubles; Newton's step takes it from 64 bits to 113
  const Real guess = std::sqrt(static_cast<long double>(square));
  return guess > 0 ? (guess + square / guess) / 2 : guess;
}

template <class Real>
Real true_distance(const Vector3& p, const Corners& c) {
  return root(testing::distance_sq_to_triangle(testing::extended<Real>(Point3{} + p), placed(c)));
}

template <class Real>
Real true_farthest(const Cloud& cloud, const Corners& c) {
  Real most = 0;
  for (std::size_t i = 0; i < cloud.x.size(); ++i) {
    const Real d = true_distance<Real>(cloud.at(i), c);
    if (d > most) most = d;
  }
  return most;
}

double longest_edge(const Corners& c) {
  return std::max({length(c[1] - c[0]), length(c[2] - c[1]), length(c[0] - c[2])});
}

// 2 / sin of the sharpest angle.
double sharpness(const Corners& c) {
  std::array<testing::Extended, 3> edge;
  for (std::size_t k = 0; k < 3; ++k) {
    edge[k] =
        testing::minus(testing::extended(Point3{} + c[(k + 1) % 3]), testing::extended(Point3{} + c[k]));
  }
  const long double aa = testing::inner(edge[0], edge[0]), bb = testing::inner(edge[1], edge[1]),
                    cc = testing::inner(edge[2], edge[2]), ab = testing::inner(edge[0], edge[1]);
  const long double most = std::max({aa * bb, bb * cc, cc * aa});
  return static_cast<double>(2 * std::sqrt(most / (aa * bb - ab * ab)));
}

// ---- inputs ----

// Columns of a rotation, as far as doubles have one.
std::array<Vector3, 3> any_frame(Random& random) {
  Vector3 a = any_vector(random, 1);
  a = (1 / length(a)) * a;
  Vector3 b = cross(a, any_vector(random, 1));
  b = (1 / length(b)) * b;
  return {a, b, cross(a, b)};
}

// Needles up to and beyond what is answered, obtuse, acute and equilateral ones; in any place, or in the
// plane z = 0.
Corners any_corners(Random& random, double size) {
  double x = uniform(random, -0.5, 1.5), y = std::pow(2.0, uniform(random, -6, 1));
  if (random() % 4 == 0) x = 0.5, y = 0.8660254037844386;
  if (random() % 4 == 0) x = uniform(random, -3, 4);
  std::array<Vector3, 3> frame = any_frame(random);
  Vector3 at = any_vector(random, random() % 2 ? 1 : size);
  if (random() % 4 == 0) frame = {Vector3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, at.z = 0;
  Corners c{at, at + size * frame[0], at + (size * x) * frame[0] + (size * y) * frame[1]};
  std::rotate(c.begin(), c.begin() + static_cast<std::ptrdiff_t>(random() % 3), c.end());
  if (random() % 2) std::swap(c[0], c[1]);
  return c;
}

// On corners, edges and the inside, in and beside the plane, and all around: where signs and cases change.
Vector3 any_point(Random& random, const Corners& c) {
  const double size = longest_edge(c);
  std::array<double, 3> weight{uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1)};
  switch (random() % 6) {
    case 0:
      weight[random() % 3] = 0;
      break;
    case 1:
      weight = {0, 0, 0};
      weight[random() % 3] = 1;
      break;
    case 2:  // beyond an edge or a corner
      weight[random() % 3] *= -1;
      break;
    default:
      break;
  }
  const double sum = weight[0] + weight[1] + weight[2];
  if (std::fabs(sum) < 0.01) return c[0];
  Vector3 p = (weight[0] / sum) * c[0] + (weight[1] / sum) * c[1] + (weight[2] / sum) * c[2];
  switch (random() % 4) {
    case 0:
      break;
    case 1:
      p = p + any_vector(random, size);
      break;
    case 2:
      p = p + any_vector(random, size * std::pow(10.0, uniform(random, -17, 1)));
      break;
    default: {
      const Vector3 normal = cross(c[1] - c[0], c[2] - c[0]);
      p = p + (uniform(random, -1, 1) * size / length(normal)) * normal;
      break;
    }
  }
  return p;
}

// Share of the rounding term that reaches the true distance; sound up to 1.
double used(const kernels::Reach& reach, Quad truth) {
  return static_cast<double>((truth - (Quad(reach.distance) - Quad(reach.rounding))) / Quad(reach.rounding));
}

// ---- farthest ----

TEST(farthest, is_never_below_the_true_distance_and_above_by_three_roundings_at_most) {
  Random random(41);
  int answered = 0;
  for (int trial = 0; trial < 60000; ++trial) {
    const Corners corners = any_corners(random, std::pow(10.0, uniform(random, -6, 0.6)));
    Cloud cloud;
    const std::size_t count = 1 + random() % 16;
    for (std::size_t i = 0; i < count; ++i) cloud.add(any_point(random, corners));
    const auto reach = farthest(cloud, corners);
    if (!reach) continue;
    ++answered;
    const auto truth = true_farthest<long double>(cloud, corners);
    if (truth > reach->distance) {
      ASSERT_LE(true_farthest<Quad>(cloud, corners), Quad(reach->distance)) << trial;
    }
    if (reach->distance > truth + 3 * reach->rounding) {
      ASSERT_LE(Quad(reach->distance) - 3 * Quad(reach->rounding), true_farthest<Quad>(cloud, corners))
          << trial;
    }
    const double size = reach->distance + 2 * longest_edge(corners);
    ASSERT_GT(reach->rounding, 0) << trial;
    ASSERT_LE(reach->rounding, (16 + 56 * sharpness(corners)) * unit_roundoff * size) << trial;
  }
  EXPECT_GT(answered, 50000);
}

// Changes corners and the point by ever smaller steps, and keeps what needs more of the rounding term.
TEST(farthest, withstands_a_search_for_the_worst_rounding) {
  Random random(42);
  double worst = -INFINITY;
  for (int start = 0; start < 60; ++start) {
    Corners best_corners = any_corners(random, 1);
    Vector3 best_point = any_point(random, best_corners);
    double best = -INFINITY;
    for (int step = 0; step < 1000; ++step) {
      Corners corners = best_corners;
      Vector3 point = best_point;
      const double change = std::pow(2.0, uniform(random, -54, step < 500 ? -10 : -45));
      Vector3& moved = random() % 2 ? point : corners[random() % 3];
      moved = moved + any_vector(random, change);
      Cloud cloud;
      cloud.add(point);
      const auto reach = farthest(cloud, corners);
      if (!reach) continue;
      const double found = used(*reach, true_distance<Quad>(point, corners));
      ASSERT_LE(found, 1) << start << ' ' << step;
      if (found < best) continue;
      best = found;
      best_corners = corners;
      best_point = point;
    }
    worst = std::max(worst, best);
  }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_GT(worst, 0.005);  // the search gets somewhere
  EXPECT_LT(worst, 0.25);   // the derivation's constants are not used up
}

// Below 1e-70 the square of the area loses digits, and below 1e-81 all of them.
TEST(farthest, is_answered_well_or_not_at_all_at_any_size) {
  Random random(52);
  int answered = 0;
  for (int trial = 0; trial < 30000; ++trial) {
    Corners corners = any_corners(random, 1);
    corners = {Vector3{0, 0, 0}, corners[1] - corners[0], corners[2] - corners[0]};
    Vector3 point = any_point(random, corners);
    const double size = std::pow(10.0, trial % 2 ? uniform(random, -83, -76) : uniform(random, -100, 0.3));
    for (Vector3* v : {&corners[1], &corners[2], &point}) *v = size * *v;
    Cloud cloud;
    cloud.add(point);
    const auto reach = farthest(cloud, corners);
    if (!reach) continue;
    ++answered;
    const Quad truth = true_distance<Quad>(point, corners);
    ASSERT_LE(truth, Quad(reach->distance)) << size;
    ASSERT_LE(Quad(reach->distance), (truth + 3 * Quad(reach->rounding)) * (1 + Quad(0x1p-39))) << size;
  }
  EXPECT_GT(answered, 10000);
}

TEST(farthest, answers_triangles_by_their_sharpest_angle) {
  Random random(43);
  for (int trial = 0; trial < 20000; ++trial) {
    const Corners corners = any_corners(random, std::pow(10.0, uniform(random, -6, 0.6)));
    Cloud cloud;
    cloud.add(any_point(random, corners));
    const double sharp = sharpness(corners);
    if (std::fabs(sharp - 64) < 0.1) continue;
    ASSERT_EQ(farthest(cloud, corners).has_value(), sharp < 64) << sharp;
  }
}

// The sign of such an area is noise. Where all of it lies in one coordinate plane no other defect shows.
TEST(farthest, does_not_answer_needles_whose_area_is_rounding) {
  Random random(44);
  Cloud cloud;
  cloud.add({0.3, 0.2, 0.1});
  for (int trial = 0; trial < 20000; ++trial) {
    std::array<double, 3> b{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
    if (trial % 4 < 3) b[static_cast<std::size_t>(trial % 4)] = 0;
    const Vector3 along{b[0], b[1], b[2]};
    EXPECT_FALSE(farthest(cloud, {Vector3{0, 0, 0}, along, uniform(random, -1, 2) * along})) << trial;
  }
}

TEST(farthest, does_not_answer_triangles_without_a_plane) {
  const Vector3 a{0.1, 0.2, 0.3}, b{1, 0.2, -0.4}, c{0.3, 0.8, 0.5};
  Cloud cloud;
  cloud.add({0.3, 0.2, 0.1});
  ASSERT_TRUE(farthest(cloud, {a, b, c}));
  EXPECT_FALSE(farthest(cloud, {a, a, a}));
  EXPECT_FALSE(farthest(cloud, {a, a, c}));
  EXPECT_FALSE(farthest(cloud, {a, b, a}));
  EXPECT_FALSE(farthest(cloud, {a, b, b}));
  EXPECT_FALSE(farthest(cloud, {a, b, a + 0.5 * (b - a)}));
  for (const double bad : {static_cast<double>(NAN), static_cast<double>(INFINITY), -1e200, 1e-200, 5e-324}) {
    EXPECT_FALSE(farthest(cloud, {bad * a, bad * b, bad * c})) << bad;
  }
  for (const double bad : {static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    for (std::size_t k = 0; k < 9; ++k) {
      Corners corners{a, b, c};
      double* const axes[3] = {&corners[k / 3].x, &corners[k / 3].y, &corners[k / 3].z};
      *axes[k % 3] = bad;
      EXPECT_FALSE(farthest(cloud, corners)) << k;
    }
  }
}

TEST(farthest, is_infinite_where_a_point_is_not_finite) {
  const Corners corners{Vector3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  for (const double bad :
       {static_cast<double>(NAN), static_cast<double>(INFINITY), -static_cast<double>(INFINITY)}) {
    for (std::size_t count = 1; count < 20; ++count) {
      for (std::size_t k = 0; k < 3 * count; ++k) {
        Cloud cloud;
        for (std::size_t i = 0; i < count; ++i) cloud.add({0.25, 0.25, 0.5});
        (k % 3 == 0 ? cloud.x : k % 3 == 1 ? cloud.y : cloud.z)[k / 3] = bad;
        const auto reach = farthest(cloud, corners);
        ASSERT_TRUE(reach);
        EXPECT_EQ(reach->distance, INFINITY) << bad << ' ' << count << ' ' << k;
      }
    }
  }
}

TEST(farthest, of_parts_is_that_of_each) {
  Random random(45);
  for (std::size_t count = 0; count < 24; ++count) {
    const Corners c{Vector3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    Cloud cloud;
    for (std::size_t i = 0; i < count; ++i) cloud.add(any_point(random, c));
    for (int trial = 0; trial < 24; ++trial) {
      std::array<std::size_t, 3> splits;
      for (std::size_t& split : splits) split = random() % (count + 1);
      std::sort(splits.begin(), splits.end());
      const auto parts = kernels::farthest(cloud.coordinates(), splits, c[0], c[1], c[2]);
      ASSERT_TRUE(parts);
      for (std::size_t i = 0; i < 4; ++i) {
        const kernels::Coordinates points =
            cloud.coordinates().first(i < 3 ? splits[i] : count).from(i > 0 ? splits[i - 1] : 0);
        const auto alone = kernels::farthest(points, {}, c[0], c[1], c[2]);
        EXPECT_EQ((*parts)[i].distance, points.count ? (*alone)[3].distance : 0);
        EXPECT_EQ((*parts)[i].rounding, points.count ? (*alone)[3].rounding : 0);
      }
    }
  }
}

// ---- rows and heights ----

TEST(apply_rows, is_the_plain_loop_bit_by_bit) {
  Random random(46);
  for (std::size_t rows = 1; rows < 35; ++rows) {
    const std::size_t columns = 1 + random() % 20;
    std::vector<double> weights(rows * columns);
    for (double& w : weights) w = uniform(random, -1, 1);
    std::vector<Vector3> points(columns);
    for (Vector3& p : points) p = any_vector(random, 2);
    constexpr double untouched = 7;
    std::vector<double> x(rows + 1, untouched), y = x, z = x;
    kernels::apply_rows(weights.data(), rows, points, x.data(), y.data(), z.data());
    for (std::size_t r = 0; r < rows; ++r) {
      Vector3 sum{0, 0, 0};
      for (std::size_t c = 0; c < columns; ++c) sum = sum + weights[c * rows + r] * points[c];
      ASSERT_EQ(Vector3({x[r], y[r], z[r]}), sum) << rows << ' ' << r;
    }
    ASSERT_EQ(Vector3({x[rows], y[rows], z[rows]}), Vector3({untouched, untouched, untouched})) << rows;
  }
}

TEST(combine_rows, is_the_plain_loop_bit_by_bit) {
  Random random(48);
  for (std::size_t width = 1; width < 35; ++width) {
    const std::size_t rows = 1 + random() % 20, count = random() % 12;
    std::vector<double> entries(rows * width), weights(count);
    for (double& entry : entries) entry = uniform(random, -1, 1);
    for (double& weight : weights) weight = uniform(random, -1, 1);
    std::vector<std::uint32_t> places(rows), sources(count);
    for (std::uint32_t& place : places) place = static_cast<std::uint32_t>(random() % rows);
    for (std::uint32_t& source : sources) source = static_cast<std::uint32_t>(random() % rows);
    constexpr double untouched = 7;
    std::vector<double> out(width + 1, untouched);
    kernels::combine_rows({entries.data(), width, places, sources, weights}, out.data());
    for (std::size_t c = 0; c < width; ++c) {
      double sum = 0;
      for (std::size_t i = 0; i < count; ++i) sum += weights[i] * entries[places[sources[i]] * width + c];
      ASSERT_EQ(out[c], sum) << width << ' ' << c;
    }
    ASSERT_EQ(out[width], untouched) << width;
  }
}

TEST(heights, are_those_of_the_plain_loop) {
  Random random(47);
  for (std::size_t count = 1; count < 35; ++count) {
    for (int trial = 0; trial < 20; ++trial) {
      Cloud cloud;
      for (std::size_t i = 0; i < count; ++i) cloud.add(any_vector(random, 2));
      if (trial % 2 && count > 1) cloud.y[random() % count] = NAN;  // passed over
      const Vector3 from = any_vector(random, 2), normal = any_vector(random, 1);
      double lower = INFINITY, upper = -INFINITY;
      for (std::size_t i = 0; i < count; ++i) {
        const double height = dot(normal, cloud.at(i) - from);
        if (height < lower) lower = height;
        if (height > upper) upper = height;
      }
      const kernels::Range range = kernels::heights(cloud.coordinates(), from, normal);
      ASSERT_EQ(range.lower, lower) << count;
      ASSERT_EQ(range.upper, upper) << count;
    }
  }
}

// ---- regular patches ----

// A regular patch and its one-ring, numbered as derivations/loop_bezier.md draws them; face 0 is the patch.
oracle::TwinMesh regular_net() {
  oracle::TwinMesh mesh;
  mesh.boundary = oracle::Boundary::none;
  constexpr double h = 0.8660254037844386;
  mesh.points = {{1, 0, 0}, {0, 0, 0},    {0.5, h, 0},   {0.5, -h, 0}, {-0.5, h, 0},  {1.5, h, 0},
                 {2, 0, 0}, {1.5, -h, 0}, {-0.5, -h, 0}, {-1, 0, 0},   {0, 2 * h, 0}, {1, 2 * h, 0}};
  mesh.triangles = {{0, 2, 1}, {10, 4, 2}, {10, 2, 11}, {11, 2, 5}, {4, 1, 2}, {2, 0, 5}, {5, 0, 6},
                    {4, 9, 1}, {9, 8, 1},  {1, 8, 3},   {1, 3, 0},  {0, 3, 7}, {0, 7, 6}};
  return mesh;
}

// Bent, sheared, noisy, flat and tiny ones, some with edges that bulge in the plane; near the origin and far
// from it.
oracle::TwinMesh any_regular_net(Random& random) {
  oracle::TwinMesh mesh = regular_net();
  const double size = random() % 2 ? 0.3 : std::pow(10.0, uniform(random, -8, -0.6));
  const double noise = random() % 4 == 0 ? 0 : std::pow(10.0, uniform(random, -4, -0.7));
  const double bend = random() % 2 ? uniform(random, -0.5, 0.5) : 0;
  const double shear = uniform(random, -1, 1);
  std::array<double, 6> bulge{};
  if (random() % 2) {
    for (double& b : bulge) b = uniform(random, -1.5, 1.5);
  }
  std::array<Vector3, 3> frame = any_frame(random);
  Vector3 at = any_vector(random, random() % 2 ? 1 : size);
  if (random() % 8 == 0) frame = {Vector3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, at.z = 0;
  for (oracle::Point& p : mesh.points) {
    const double xx = p[0] * p[0], xy = p[0] * p[1], yy = p[1] * p[1];
    const double x = p[0] + shear * p[1] + bulge[0] * xx + bulge[1] * xy + bulge[2] * yy;
    const double y = p[1] + bulge[3] * xx + bulge[4] * xy + bulge[5] * yy;
    const double z = bend * (x * x + 0.5 * y * y - 0.3 * x * y);
    const Vector3 v = at + size * (x * frame[0] + y * frame[1] + z * frame[2] + any_vector(random, noise));
    p = {v.x, v.y, v.z};
  }
  return mesh;
}

// Its limit corners span an area of mere rounding, in the plane z = 0.
oracle::TwinMesh net_on_a_line(Random& random) {
  oracle::TwinMesh mesh = regular_net();
  const double x = uniform(random, -1, 1), y = uniform(random, -1, 1);
  for (oracle::Point& p : mesh.points) {
    const double along = p[0] + uniform(random, -0.3, 0.3);
    p = {along * x, along * y, 0};
  }
  return mesh;
}

// Many nets behind each other, as the batch reads them.
class Nets {
 public:
  Nets() : surface_(testing::surface_of(regular_net())) { surface_.control_vertices(PatchId(0), order_); }

  void add(const oracle::TwinMesh& mesh) {
    for (const VertexId v : order_) control_.push_back(VertexId(points_.size() + v.index()));
    for (const oracle::Point& p : mesh.points) points_.push_back({p[0], p[1], p[2]});
  }

  [[nodiscard]] std::size_t size() const { return control_.size() / order_.size(); }

  [[nodiscard]] std::vector<OffsetTriangle> fits(std::size_t begin, std::size_t end) const {
    std::vector<OffsetTriangle> out(end - begin);
    const std::size_t n = order_.size();
    kernels::fit_regular(points_, std::span(control_).subspan(begin * n, (end - begin) * n), out);
    return out;
  }

  // The general way: rows of the kind, points, fit.
  [[nodiscard]] OffsetTriangle offset(std::size_t i) const {
    const Kind& kind = surface_.kind(PatchId(0));
    const std::size_t n = order_.size();
    const Patch patch = make_patch(kind, 0, points_, std::span(control_).subspan(i * n, n));
    BoundingPoints hull;
    bounding_points(surface_.library().rows(kind), patch, hull);
    return offset_triangle(surface_.library(), hull, limit_corners(patch));
  }

 private:
  LimitSurface surface_;
  std::vector<VertexId> order_, control_;
  std::vector<Point3> points_;
};

TEST(regular_fit, contains_the_limit_patch) {
  Random random(48);
  Nets nets;
  std::vector<oracle::TwinMesh> meshes;
  for (int i = 0; i < 203; ++i) {
    meshes.push_back(any_regular_net(random));
    nets.add(meshes.back());
  }
  const auto fits = nets.fits(0, nets.size());
  std::size_t answered = 0;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    if (fits[i].radius < 0) continue;
    ++answered;
    const auto samples = oracle::sample_uniform(meshes[i], 3);
    ASSERT_EQ(samples.size(), 45u);
    const Triangle base{fits[i].base[0], fits[i].base[1], fits[i].base[2]};
    for (const oracle::LimitSample& s : samples) {
      const testing::Extended p{s.position[0], s.position[1], s.position[2]};
      ASSERT_TRUE(testing::within_radius(p, base, fits[i].radius + 2 * s.error)) << i;
    }
  }
  EXPECT_GT(answered, 190u);
}

TEST(regular_fit, agrees_with_the_general_way) {
  Random random(49);
  Nets nets;
  for (int i = 0; i < 3001; ++i) nets.add(any_regular_net(random));
  const auto fits = nets.fits(0, nets.size());
  int answered = 0;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    if (fits[i].radius < 0) continue;
    ++answered;
    const OffsetTriangle general = nets.offset(i);
    const double slack = fits[i].rounding + general.rounding;
    ASSERT_NEAR(fits[i].radius, general.radius, 1e-12 * general.radius + slack) << i;
    ASSERT_LT(fits[i].rounding, 4 * general.rounding) << i;
    for (std::size_t k = 0; k < 3; ++k) ASSERT_LT(max_abs(fits[i].base[k] - general.base[k]), slack) << i;
  }
  EXPECT_GT(answered, 2900);
}

TEST(regular_fit, does_not_depend_on_the_patches_beside_it) {
  Random random(50);
  Nets nets;
  for (int i = 0; i < 19; ++i) nets.add(any_regular_net(random));
  const auto together = nets.fits(0, nets.size());
  for (std::size_t begin = 0; begin < nets.size(); ++begin) {
    for (std::size_t end = begin; end <= nets.size(); ++end) {
      const auto part = nets.fits(begin, end);
      for (std::size_t i = 0; i < part.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(part[i].base[k], together[begin + i].base[k]);
        ASSERT_EQ(part[i].radius, together[begin + i].radius);
        ASSERT_EQ(part[i].rounding, together[begin + i].rounding);
      }
    }
  }
}

TEST(regular_fit, marks_what_it_does_not_answer_and_nothing_else) {
  Nets nets;
  const auto add = [&](auto&& change) {
    oracle::TwinMesh mesh = regular_net();
    for (oracle::Point& p : mesh.points) change(p);
    nets.add(mesh);
    nets.add(regular_net());
  };
  add([](oracle::Point& p) { p = {0.5, 0.25, 0.125}; });
  add([](oracle::Point& p) { p = {0, 0, 0}; });
  add([](oracle::Point& p) { p = {0.3 * p[0], 0.7 * p[0], 0.1 * p[0]}; });
  Random random(53);
  for (int i = 0; i < 2000; ++i) nets.add(net_on_a_line(random)), nets.add(regular_net());
  add([](oracle::Point& p) { p[1] *= 0.01; });
  for (const double bad : {static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    for (std::size_t k = 0; k < 36; ++k) {
      std::size_t at = 0;
      add([&](oracle::Point& p) {
        if (at++ == k / 3) p[k % 3] = bad;
      });
    }
  }
  add([](oracle::Point& p) {
    for (double& x : p) x *= 1e-200;
  });
  add([](oracle::Point& p) {
    for (double& x : p) x *= 1e200;
  });
  const auto fits = nets.fits(0, nets.size());
  for (std::size_t i = 0; i < fits.size(); ++i) {
    if (i % 2 == 0) {
      EXPECT_EQ(fits[i].radius, -1) << i;
    } else {
      EXPECT_EQ(fits[i].radius, fits[1].radius) << i;
      EXPECT_GE(fits[i].radius, 0) << i;
    }
  }
}

TEST(offset_triangle, contains_patches_on_a_line_in_a_coordinate_plane) {
  Random random(54);
  Nets nets;
  for (std::size_t i = 0; i < 1000; ++i) {
    const oracle::TwinMesh mesh = net_on_a_line(random);
    nets.add(mesh);
    const OffsetTriangle offset = nets.offset(i);
    for (const oracle::LimitSample& s : oracle::sample_uniform(mesh, 2)) {
      const testing::Extended p{s.position[0], s.position[1], s.position[2]};
      ASSERT_TRUE(testing::within_radius(p, offset.base, offset.radius + 2 * s.error)) << i;
    }
  }
}

// ---- instruction sets ----

using Bits = std::vector<std::uint64_t>;

void add(Bits& bits, double x) { bits.push_back(std::isnan(x) ? ~0ull : std::bit_cast<std::uint64_t>(x)); }

// Results of all kernels for inputs with all cases and tails, and with heights that are zeros of both signs.
Bits everything() {
  Random random(51);
  Bits bits;
  for (std::size_t trial = 0; trial < 4000; ++trial) {
    const Corners corners = any_corners(random, std::pow(10.0, uniform(random, -6, 0.6)));
    const std::size_t count = 1 + trial % 37;
    Cloud cloud;
    for (std::size_t i = 0; i < count; ++i) cloud.add(any_point(random, corners));
    if (trial % 8 == 0) {
      for (double& z : cloud.z) z = random() % 2 ? 0.0 : -0.0;
    }
    if (trial % 16 == 1 && count > 1) cloud.x[random() % count] = NAN;
    const auto reach = farthest(cloud, corners);
    add(bits, reach ? reach->distance : -1);
    add(bits, reach ? reach->rounding : -1);
    for (const Vector3& normal : {Vector3{0, 0, 1}, Vector3{-0.0, -0.0, -1}, any_vector(random, 1)}) {
      const kernels::Range range = kernels::heights(cloud.coordinates(), {0, 0, 0}, normal);
      add(bits, range.lower);
      add(bits, range.upper);
    }
    std::vector<double> weights(12 * count), x(count), y(count), z(count);
    for (double& w : weights) w = uniform(random, -1, 1);
    std::vector<Vector3> points(12);
    for (Vector3& p : points) p = any_vector(random, 1);
    kernels::apply_rows(weights.data(), count, points, x.data(), y.data(), z.data());
    for (const auto* axis : {&x, &y, &z}) {
      for (const double value : *axis) add(bits, value);
    }
  }
  Nets nets;
  for (int i = 0; i < 1003; ++i) nets.add(any_regular_net(random));
  oracle::TwinMesh flat = regular_net();
  for (oracle::Point& p : flat.points) p[2] = -0.0;
  nets.add(flat);
  for (const OffsetTriangle& fit : nets.fits(0, nets.size())) {
    for (const Point3& p : fit.base) {
      for (const double value : {p.x, p.y, p.z}) add(bits, value);
    }
    add(bits, fit.radius);
    add(bits, fit.rounding);
  }
  return bits;
}

TEST(fit_kernels, say_the_same_on_every_instruction_set) {
  const Bits here = everything();
  std::string names;
  testing::EachInstructionSet().run([&](const char* name) {
    names += std::string(name) + ' ';
    const Bits there = everything();
    ASSERT_EQ(there.size(), here.size()) << name;
    std::size_t differences = 0;
    for (std::size_t i = 0; i < here.size(); ++i) differences += here[i] != there[i];
    EXPECT_EQ(differences, 0u) << name;
  });
  RecordProperty("instruction_sets", names);
}

}  // namespace
}  // namespace snug::fit_kernels_test
