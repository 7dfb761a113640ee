// Rays at graphs of quadratic polynomials with integer coefficients: with every scheme the limit surface of such a
// control mesh is the polynomial plus a constant, and the hits of a ray are roots of a quadratic, told exactly. Each
// crossing is certified and as narrow as asked; beside the surface there is none.
//
//   SNUG_PLACEMENTS=1000000 build/release/bin/tests/sound_test --gtest_filter='rays.*'
//
// asks so many rays; SNUG_FIRST=N begins with mesh N.

#include <snug/ray.h>

#include <gmpxx.h>
#include <gtest/gtest.h>
#include <testing/solid_cases.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>

namespace snug::graph_ray_test {
namespace {

using testing::between;
using testing::number_of;

struct Counts {
  std::size_t rays = 0, hits = 0, misses = 0, pairs = 0, corners = 0;
};

// z = a x^2 + b xy + c y^2 + d x + e y over a grid of integer points, plus a constant: half of the second derivatives times
// the covariances of the box spline of the scheme.
class GraphTrials {
 public:
  GraphTrials(std::uint64_t number, Scheme scheme, Counts& counts)
      : random_(number * 7919 + 11),
        scheme_(scheme),
        name_(std::string(name_of(scheme)) + ", mesh " + std::to_string(number)),
        counts_(counts) {
    const bool bilinear = scheme == Scheme::bilinear;
    n_ = bilinear ? 1 + static_cast<int>(random_() % 3) : 4;
    inner_ = bilinear ? n_ : n_ - 2;
    for (int& k : q_) k = static_cast<int>(random_() % 7) - 3;
    if (bilinear) q_[0] = q_[2] = 0;
    if (q_[1] == 0 && random_() % 4 != 0) q_[1] = 1;
    const bool loop = scheme == Scheme::loop;
    added_ = bilinear ? mpq_class(0)
             : loop   ? mpq_class(2 * (q_[0] + q_[2]) + q_[1], 6)
                      : mpq_class(q_[0] + q_[2], scheme == Scheme::catmark ? 3 : 4);
    added_.canonicalize();
    // Lengths and angles of every kind, exactly.
    for (int i = 0; i < 3; ++i) map_[i][i] = 1;
    for (int i = 0; i < 3; ++i) {
      const std::size_t to = random_() % 3, from = (to + 1 + random_() % 2) % 3;
      const int by = static_cast<int>(random_() % 3) - 1;
      for (std::size_t k = 0; k < 3; ++k) map_[to][k] += by * map_[from][k];
    }
  }

  void run(std::uint64_t rays) {
    const Surface surface(mesh(), {.scheme = scheme_}, {.threads = 1});
    for (std::uint64_t i = 0; i < rays && !::testing::Test::HasFailure(); ++i) ask(surface);
  }

 private:
  ControlMesh mesh() {
    ControlMesh mesh;
    const int side = 2 * n_ + 1;
    for (int x = -n_; x <= n_; ++x) {
      for (int y = -n_; y <= n_; ++y) {
        const Vector3 p = mapped(
            {static_cast<double>(x), static_cast<double>(y),
             static_cast<double>(q_[0] * x * x + q_[1] * x * y + q_[2] * y * y + q_[3] * x + q_[4] * y)});
        mesh.points.push_back({p.x, p.y, p.z});
      }
    }
    const auto add = [&](std::vector<int> face) {
      std::rotate(face.begin(), face.begin() + static_cast<std::ptrdiff_t>(random_() % face.size()),
                  face.end());
      std::vector<VertexId> ids;
      for (const int v : face) ids.emplace_back(static_cast<std::size_t>(v));
      mesh.add_face(ids);
    };
    for (int i = 0; i + 1 < side; ++i) {
      for (int j = 0; j + 1 < side; ++j) {
        const int v = i * side + j;
        if (scheme_ == Scheme::loop) {
          add({v, v + side, v + side + 1});
          add({v, v + side + 1, v + 1});
        } else {
          add({v, v + side, v + side + 1, v + 1});
        }
      }
    }
    return mesh;
  }

  [[nodiscard]] Vector3 mapped(const Vector3& p) const {
    Vector3 result;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) result[i] += map_[i][k] * p[k];
    }
    return result;
  }

  // Of the inverse of the map, whose determinant is 1.
  [[nodiscard]] double inverse_norm() const {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t a = (i + 1) % 3, b = (i + 2) % 3, c = (k + 1) % 3, d = (k + 2) % 3;
        const double minor = map_[a][c] * map_[b][d] - map_[a][d] * map_[b][c];
        sum += minor * minor;
      }
    }
    return std::sqrt(sum);
  }

  // A place in the grid: a corner, on an edge or a diagonal, dyadic or anywhere.
  [[nodiscard]] double coordinate() {
    const double x = between(random_, -1, 1) * inner_;
    const double grain = std::ldexp(1, static_cast<int>(random_() % 7));
    return random_() % 4 == 0 ? std::ldexp(std::round(std::ldexp(x, 20)), -20)
                              : std::round(x * grain) / grain;
  }

  struct Quadratic {  // F(t) = (a t + b) t + c
    mpq_class a, b, c;
    [[nodiscard]] mpq_class operator()(double t) const { return (a * t + b) * t + c; }
  };
  // z - polynomial along the ray.
  [[nodiscard]] Quadratic along(const Vector3& o, const Vector3& d) const {
    const mpq_class ox(o.x), oy(o.y), oz(o.z), dx(d.x), dy(d.y), dz(d.z);
    return {-(q_[0] * dx * dx + q_[1] * dx * dy + q_[2] * dy * dy),
            dz - (2 * q_[0] * ox * dx + q_[1] * (ox * dy + oy * dx) + 2 * q_[2] * oy * dy + q_[3] * dx +
                  q_[4] * dy),
            oz - (q_[0] * ox * ox + q_[1] * ox * oy + q_[2] * oy * oy + q_[3] * ox + q_[4] * oy + added_)};
  }

  void ask(const Surface& surface) {
    const double size = surface.size();
    double x = coordinate(), y = coordinate();
    if (random_() % 4 == 0) y = random_() % 2 == 0 ? x : -x;
    const double z = q_[0] * x * x + q_[1] * x * y + q_[2] * y * y + q_[3] * x + q_[4] * y + added_.get_d();
    Vector3 d{0, 0, -1};
    if (random_() % 4 != 0) {
      for (std::size_t k = 0; k < 3; ++k) d[k] = std::round(64 * between(random_, -1, 1)) / 64;
    }
    if (d == Vector3{}) return;
    const double away = 1 + static_cast<double>(random_() % 16);
    const auto grid = [](double v) { return std::ldexp(std::round(std::ldexp(v, 30)), -30); };
    const Vector3 o{x - away * d.x, y - away * d.y, grid(z) - away * d.z};
    const Quadratic f = along(o, d);
    // The part over the inner grid; a ray at the end of a bilinear surface goes on beside it.
    double from = 0, to = 40;
    const double margin = 0x1p-6;
    for (std::size_t k = 0; k < 2; ++k) {
      if (d[k] == 0) {
        if (std::fabs(o[k]) > inner_ - margin) return;
        continue;
      }
      const double a = (-inner_ - o[k]) / d[k], b = (inner_ - o[k]) / d[k];
      from = std::max(from, std::min(a, b));
      to = std::min(to, std::max(a, b));
    }
    from += margin;
    to -= margin;
    if (!(from < to)) return;
    // The roots in between, isolated by signs.
    const int first = sgn(f(from)), last = sgn(f(to));
    if (first == 0 || last == 0) return;
    int count = first == last ? 0 : 1;
    double slope = 0;
    if (count == 0 && sgn(f.a) != 0) {
      const double top = mpq_class(-f.b / (2 * f.a)).get_d();
      if (top > from && top < to && sgn(f(top)) != first) count = 2;
    }
    const double discriminant = mpq_class(f.b * f.b - 4 * f.a * f.c).get_d();
    slope = std::sqrt(std::max(0.0, discriminant));  // |F'| at the roots
    const double steepest = 1 + (2 * std::abs(q_[0]) + std::abs(q_[1])) * inner_ + std::abs(q_[3]) +
                            (2 * std::abs(q_[2]) + std::abs(q_[1])) * inner_ + std::abs(q_[4]);
    // A lower bound of the sine of the angle: the normal is steepest times as long, and mapped by the inverse.
    const bool well = count == 0 || slope > 0x1p-6 * steepest * inverse_norm() * length(mapped(d));
    // Near its ends a segment's hits are not told.
    const bool ends = std::min(std::fabs(f(from).get_d()), std::fabs(f(to).get_d())) < 0.05;
    // Misses of which the surface stays clear.
    double gap = INFINITY;
    for (int i = 0; i <= 256; ++i) gap = std::min(gap, std::fabs(f(from + (to - from) * i / 256).get_d()));
    if (ends || !well || (count == 0 && gap < 0.05)) return;
    RayOptions options{.query = random_() % 4 == 0 ? RayQuery::nearest : RayQuery::all};
    if (random_() % 4 == 0) options.absolute = size * std::array{1e-3, 1e-5, 1e-8}[random_() % 3];
    check(snug::ray(surface, {Point3{} + mapped(o), mapped(d), from, to}, options), f, count, options.query,
          options.absolute.value_or(1e-6 * size) / length(mapped(d)), [&] {
            std::ostringstream text;
            text.precision(17);
            text << name_ << ": from " << o.x << ' ' << o.y << ' ' << o.z << " along " << d.x << ' ' << d.y
                 << ' ' << d.z << ", " << from << " to " << to << ", roots " << count;
            return text.str();
          });
    counts_.corners += std::round(x) == x && std::round(y) == y;
  }

  template <typename Text>
  void check(const RayHits& answer, const Quadratic& f, int count, RayQuery query, double precision,
             const Text& text) {
    ++counts_.rays;
    counts_.hits += static_cast<std::size_t>(count);
    counts_.misses += count == 0;
    counts_.pairs += count == 2;
    const std::size_t wanted = query == RayQuery::all ? static_cast<std::size_t>(count) : std::min(count, 1);
    EXPECT_EQ(answer.outcome, Outcome::complete) << text();
    EXPECT_EQ(answer.hits.size(), wanted) << text();
    double before = -INFINITY;
    for (const RayHit& hit : answer.hits) {
      EXPECT_TRUE(hit.certified) << text() << (hit.certified ? ": certified " : ": uncertified ")
                                 << hit.t.lower << ' ' << hit.t.upper;
      EXPECT_LE(hit.t.upper - hit.t.lower, precision * (1 + 1e-6) + 1e-12) << text();
      EXPECT_LE(sgn(f(hit.t.lower)) * sgn(f(hit.t.upper)), 0) << text() << ": no root in the interval";
      EXPECT_GE(hit.t.lower, before) << text();
      before = hit.t.lower;
    }
  }

  std::mt19937_64 random_;
  Scheme scheme_;
  std::string name_;
  Counts& counts_;
  int n_ = 0, inner_ = 0;
  std::array<int, 5> q_{};
  mpq_class added_;
  std::array<std::array<int, 3>, 3> map_{};
};

TEST(rays, locate_every_crossing_of_quadratic_graphs) {
  constexpr std::uint64_t rays_a_mesh = 100;
  const std::uint64_t first = number_of("SNUG_FIRST", 0),
                      meshes = (number_of("SNUG_PLACEMENTS", 5000) + rays_a_mesh - 1) / rays_a_mesh;
  constexpr std::array schemes{Scheme::bilinear, Scheme::midedge, Scheme::doo_sabin, Scheme::catmark,
                               Scheme::loop};
  Counts counts;
  for (std::uint64_t i = first; i < first + meshes && !HasFailure(); ++i) {
    GraphTrials(i, schemes[i % schemes.size()], counts).run(rays_a_mesh);
  }
  std::cout << "  " << counts.rays << " rays, " << counts.hits << " hits, " << counts.misses << " misses, "
            << counts.pairs << " with two hits, " << counts.corners << " at corners\n";
  EXPECT_GT(counts.hits * 2, counts.rays);
  EXPECT_GT(counts.misses * 100, counts.rays);
}

}  // namespace
}  // namespace snug::graph_ray_test
