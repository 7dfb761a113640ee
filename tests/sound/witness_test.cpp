// Where witnesses lie, and their normals: against the twins' dense samples, the general evaluation, and
// tangents of nets that are refined in 113-bit arithmetic.

#include <gtest/gtest.h>
#include <oracle/polygon_net.h>
#include <oracle/polygon_twin.h>
#include <snug/distance.h>
#include <snug/evaluate.h>
#include <testing/placements.h>
#include <testing/scheme_surfaces.h>
#include <testing/surfaces.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "testing/verdict_only.h"

namespace snug::witness_test {
namespace {

using testing::for_each_surface;
using testing::NamedSurface;
using testing::unit;

// The general evaluation at the very doubles of a place.
void expect_on(const Surface& surface, const Motion& pose, const LimitPoint& witness,
               const std::string& where) {
  const std::optional<Place>& at = witness.at;
  ASSERT_TRUE(at) << where;
  ASSERT_TRUE(surface.has(*at)) << where << " u " << at->u << " v " << at->v;
  const SurfacePoint point = evaluate(surface, *at);
  const Point3 placed = pose.apply(point.point);
  // Parameters are rounded to 2^-51; around many faces points move by more than parameters do.
  const double rounding = 1e-11 * (surface.size() + max_abs(pose.offset()));
  for (std::size_t k = 0; k < 3; ++k) {
    ASSERT_NEAR(placed[k], witness.point[k], witness.error + 2 * point.error + rounding)
        << where << " face " << at->owner << " corner " << at->corner << " u " << at->u << " v " << at->v;
  }
}

TEST(witnesses, lie_where_they_say_with_every_scheme) {
  std::mt19937_64 random(71);
  std::size_t asked = 0;
  for_each_surface(71, [&](const NamedSurface& s) {
    std::size_t patches = 0;
    for (std::size_t p = 0; p < s.surface.patch_count(); ++p) patches += s.surface.has_patch(PatchId(p));
    if (patches == 0) return;
    const Surface surface = testing::public_surface(s.surface.mesh(), s.surface.options());
    for (int trial = 0; trial < 3; ++trial) {
      const double far = s.surface.size() * (trial == 0 ? 0.3 : 2);
      const Motion a = testing::random_placement(random, testing::random_vector(random, far)),
                   b = testing::random_placement(random, testing::random_vector(random, far));
      const PlacedSurface placed_a = surface.at(a), placed_b = surface.at(b);
      CollideOptions options = testing::verdict_only();
      options.tolerance = 0.01 * s.surface.size();
      options.measure = trial != 1;
      const Collision met = collide(placed_a, placed_b, options, {.max_splits = 3000});
      if (met.witness) {
        expect_on(surface, a, (*met.witness)[0], s.name);
        expect_on(surface, b, (*met.witness)[1], s.name);
      }
      if (met.verdict == Verdict::separated && options.measure) {
        ASSERT_TRUE(std::isfinite(met.distance.upper) && met.witness) << s.name;
        EXPECT_GE(met.distance.lower, met.distance.upper / 2) << s.name;
        EXPECT_LE(distance((*met.witness)[0].point, (*met.witness)[1].point),
                  met.distance.upper * (1 + 1e-12))
            << s.name;
      }
      DistanceOptions precise;
      precise.absolute = 1e-3 * s.surface.size();
      const snug::Run run{.max_splits = 1000};
      const Distance apart = distance(placed_a, placed_b, precise, run);
      expect_on(surface, a, apart.witness[0], s.name);
      expect_on(surface, b, apart.witness[1], s.name);
      const ClosestPoint near =
          closest_point(surface, Point3{} + testing::random_vector(random, 2 * s.surface.size()),
                        {.absolute = precise.absolute, .relative = {}}, run);
      expect_on(surface, {}, near, s.name);
      asked += 3;
    }
  });
  EXPECT_GT(asked, testing::share(1000));
}

// The twin's lattice around a place: an owner, corner or order of u and v that is wrong is far off.
TEST(witnesses, lie_between_the_samples_of_the_twin) {
  constexpr int level = 4;
  std::mt19937_64 random(72);
  std::size_t checked = 0;
  for (const auto scheme : {oracle::PrimalScheme::catmull_clark, oracle::PrimalScheme::loop}) {
    for (const testing::TaggedCase& c : testing::tagged_cases(scheme, 72, 0)) {
      const Surface surface =
          testing::public_surface(testing::control_mesh(c.mesh), testing::options_of(c.rules));
      std::map<std::array<std::uint32_t, 2>, std::vector<oracle::FaceSample>> samples;
      for (const oracle::FaceSample& s : oracle::sample_faces(c.mesh, c.rules, level)) {
        samples[{s.face, s.part}].push_back(s);
      }
      if (samples.empty()) continue;
      for (int trial = 0; trial < 40; ++trial) {
        const Point3 to = Point3{} + testing::random_vector(random, 2 * surface.size());
        const ClosestPoint near = closest_point(surface, to, {1e-3 * surface.size(), 0});
        const auto& around = samples.at({near.at->owner, near.at->corner});
        // The samples around the place, those of split polygons twice as far apart: their box, made half as
        // large again, holds the point.
        const double h = 1.5 / (1 << (level - 1));
        Box3 box;
        for (const oracle::FaceSample& s : around) {
          if (std::fabs(s.u - near.at->u) > h || std::fabs(s.v - near.at->v) > h) continue;
          box.add(Point3{s.position[0], s.position[1], s.position[2]});
        }
        ASSERT_FALSE(box.empty()) << c.name;
        const double slack = 0.25 * longest_side(box);
        for (std::size_t k = 0; k < 3; ++k) {
          ASSERT_GE(near.point[k], box.lower[k] - slack) << c.name << ", " << testing::text_of(c.rules);
          ASSERT_LE(near.point[k], box.upper[k] + slack) << c.name << ", " << testing::text_of(c.rules);
        }
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 2000u);
}

// --- normals ---

using oracle::detail::PolygonNet;
using oracle::detail::QuadPoint;
using Exact = std::array<long double, 3>;

QuadPoint combination(const std::vector<std::pair<int, QuadPoint>>& terms) {
  QuadPoint sum{};
  for (const auto& [weight, p] : terms) {
    for (std::size_t k = 0; k < 3; ++k) sum[k] += weight * p[k];
  }
  return sum;
}

// Two tangents at a vertex whose ring is that of a regular lattice; nothing elsewhere. All weights are whole.
std::optional<std::array<QuadPoint, 2>> tangents_at(const PolygonNet& net,
                                                    const oracle::detail::Neighbours& near, std::uint32_t v,
                                                    bool loop) {
  std::map<std::uint32_t, std::array<std::uint32_t, 2>>
      next;  // of a spoke: what lies between, the next spoke
  for (const std::uint32_t e : near.vertex_edges[v]) {
    if (net.edges[e].sharpness > 0) return {};
  }
  if (net.sharpness[v] > 0) return {};
  for (const std::uint32_t f : near.vertex_faces[v]) {
    const auto& corners = net.faces[f].vertices;
    const std::size_t n = corners.size();
    const auto k = static_cast<std::size_t>(std::find(corners.begin(), corners.end(), v) - corners.begin());
    if (n != (loop ? 3u : 4u)) return {};
    next[corners[(k + 1) % n]] = {corners[(k + 2) % n], corners[(k + n - 1) % n]};
  }
  const std::size_t valence = loop ? 6 : 4;
  if (next.size() != valence || near.vertex_edges[v].size() != valence) return {};
  std::vector<QuadPoint> spokes, between;
  std::uint32_t at = next.begin()->first;
  for (std::size_t k = 0; k < valence; ++k) {
    if (!next.contains(at)) return {};
    spokes.push_back(net.points[at]);
    between.push_back(net.points[next[at][0]]);
    at = next[at][1];
  }
  if (loop) {
    return std::array{combination({{2, spokes[0]},
                                   {1, spokes[1]},
                                   {-1, spokes[2]},
                                   {-2, spokes[3]},
                                   {-1, spokes[4]},
                                   {1, spokes[5]}}),
                      combination({{1, spokes[1]}, {1, spokes[2]}, {-1, spokes[4]}, {-1, spokes[5]}})};
  }
  return std::array{combination({{4, spokes[0]},
                                 {-4, spokes[2]},
                                 {1, between[0]},
                                 {1, between[3]},
                                 {-1, between[1]},
                                 {-1, between[2]}}),
                    combination({{4, spokes[1]},
                                 {-4, spokes[3]},
                                 {1, between[0]},
                                 {1, between[1]},
                                 {-1, between[2]},
                                 {-1, between[3]}})};
}

Exact unit_cross(const Exact& s, const Exact& t) {
  Exact n{s[1] * t[2] - s[2] * t[1], s[2] * t[0] - s[0] * t[2], s[0] * t[1] - s[1] * t[0]};
  const long double size = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  for (long double& x : n) x /= size;
  return n;
}

// The tangents turned with the surface, exactly by these doubles.
Exact turned(const Motion& pose, const QuadPoint& t) {
  Exact result;
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] = 0;
    for (std::size_t j = 0; j < 3; ++j)
      result[i] += static_cast<long double>(pose.row(i)[j]) * static_cast<long double>(t[j]);
  }
  return result;
}

long double off(const Vector3& x, const Exact& y) {
  const auto to = [&](long double sign) {
    long double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += (x[k] - sign * y[k]) * (x[k] - sign * y[k]);
    return std::sqrt(sum);
  };
  return std::min(to(1), to(-1));  // which side is out is tested elsewhere
}

TEST(normals, are_within_their_error_of_tangents_refined_in_113_bits) {
  constexpr int level = 2;
  std::mt19937_64 random(73);
  std::size_t checked = 0, bounded = 0;
  long double most = 0;
  for (const auto scheme : {oracle::PrimalScheme::catmull_clark, oracle::PrimalScheme::loop}) {
    const bool loop = scheme == oracle::PrimalScheme::loop;
    for (const testing::TaggedCase& c : testing::tagged_cases(scheme, 73)) {
      const Surface surface =
          testing::public_surface(testing::control_mesh(c.mesh), testing::options_of(c.rules));
      PolygonNet net = oracle::detail::control_net(c.mesh, c.rules).net;
      for (int i = 0; i < level; ++i) net = oracle::detail::refine(net, c.rules);
      const oracle::detail::Neighbours near(net);
      const oracle::detail::Limits limits =
          oracle::detail::limit_points(net, c.rules, std::vector<char>(net.points.size(), 1));
      std::map<oracle::Point, std::uint32_t> vertices;  // one for several at one place
      for (std::uint32_t v = 0; v < net.points.size(); ++v) {
        oracle::Point p;
        for (std::size_t k = 0; k < 3; ++k) p[k] = static_cast<double>(limits.points[v][k]);
        const bool alone = vertices.emplace(p, v).second;
        if (!alone) vertices[p] = UINT32_MAX;
      }
      for (const oracle::FaceSample& s : oracle::sample_faces(c.mesh, c.rules, level)) {
        const auto found = vertices.find(s.position);
        if (found == vertices.end() || found->second == UINT32_MAX) continue;
        const auto tangents = tangents_at(net, near, found->second, loop);
        if (!tangents) continue;
        ++checked;
        // Poses as far from rigid as they may be, too.
        Motion pose = testing::random_placement(random, {});
        if (checked % 3 == 0) {
          std::array<double, 12> numbers = pose.numbers();
          for (double& x : numbers) x *= 1 + 2e-10 * (unit(random) - 0.5);
          pose = Motion::from_3x4(numbers);
        }
        const auto normal = normal_at(surface.at(pose), {s.face, s.part, s.u, s.v});
        if (!normal || !normal->error) continue;
        ++bounded;
        const long double distance =
            off(normal->direction, unit_cross(turned(pose, (*tangents)[0]), turned(pose, (*tangents)[1])));
        most = std::max(most, distance / static_cast<long double>(*normal->error));
        ASSERT_LE(distance, static_cast<long double>(*normal->error) + 1e-17L)
            << c.name << ", " << testing::text_of(c.rules) << ", face " << s.face << " part " << s.part
            << " at " << s.u << ", " << s.v;
      }
    }
  }
  std::printf("%zu normals with a bound of %zu; the nearest to its bound used %.2g of it\n", bounded, checked,
              static_cast<double>(most));
  EXPECT_GT(checked, 5000u);
  EXPECT_GT(10 * bounded, 9 * checked);
}

TEST(normals, have_no_bound_where_there_is_none) {
  const oracle::TaggedMesh mesh = oracle::meshes::pyramid(7);
  const Surface surface(testing::control_mesh(mesh), {.scheme = Scheme::catmark});
  const auto tip = normal_at(surface, {0, 0, 0, 0});
  if (tip) {
    EXPECT_FALSE(tip->error.has_value());
  }
}

}  // namespace
}  // namespace snug::witness_test
