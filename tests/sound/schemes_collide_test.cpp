// Verdicts for Catmull-Clark, creases, boundaries, polygons and the dual schemes against dense limit samples
// of the twins, where a surface meets itself or lies inside a larger copy: no pair of samples is nearer than what is
// called separated. By trees that are made part by part where queries come.

#include <snug/query/pair_queries.h>

#include <gtest/gtest.h>
#include <oracle/dual_twin.h>
#include <oracle/polygon_twin.h>
#include <testing/placements.h>
#include <testing/tagged.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>

#include "testing/verdict_only.h"

namespace snug::schemes_collide_test {
namespace {

struct Body {
  std::string name;
  LimitSurface surface;
  SurfaceBvh model;
  std::vector<Point3> samples;
  double error = 0;    // of each coordinate of a sample
  double spacing = 0;  // about how far a limit point is from the nearest sample

  Body(std::string title, ControlMesh mesh, const SchemeOptions& options,
       const std::shared_ptr<BoundsCache>& library)
      : name(std::move(title)),
        surface(std::move(mesh), options, library),
        model(surface, {.threads = 1, .min_lazy = 0, .part_level = 1}) {}

  void add(const oracle::Point& p, double e) {
    samples.push_back({p[0], p[1], p[2]});
    error = std::max(error, e);
  }
};

std::unique_ptr<Body> primal_body(const testing::TaggedCase& c, int levels,
                                  const std::shared_ptr<BoundsCache>& library) {
  auto body = std::make_unique<Body>(c.name, testing::control_mesh(c.mesh, c.rules),
                                     testing::options_of(c.rules), library);
  std::map<std::tuple<std::uint32_t, std::uint32_t, double, double>, Point3> at;
  for (const oracle::FaceSample& s : oracle::sample_faces(c.mesh, c.rules, levels)) {
    body->add(s.position, s.error);
    at[{s.face, s.part, s.u, s.v}] = body->samples.back();
  }
  // A polygon's quads are one level down.
  for (const auto& [key, p] : at) {
    const auto& [face, part, u, v] = key;
    for (const double step : {std::ldexp(1.0, -levels), std::ldexp(1.0, 1 - levels)}) {
      const auto right = at.find({face, part, u + step, v}), up = at.find({face, part, u, v + step});
      bool found = false;
      for (const auto& next : {right, up}) {
        if (next == at.end()) continue;
        found = true;
        body->spacing = std::max(body->spacing, distance(p, next->second));
      }
      if (found) break;
    }
  }
  return body;
}

std::unique_ptr<Body> dual_body(const std::string& name, const oracle::TaggedMesh& mesh, Scheme scheme,
                                int levels, const std::shared_ptr<BoundsCache>& library) {
  auto body = std::make_unique<Body>(name + ", " + name_of(scheme), testing::control_mesh(mesh),
                                     SchemeOptions{scheme}, library);
  const auto twin = scheme == Scheme::doo_sabin ? oracle::DualScheme::doo_sabin : oracle::DualScheme::midedge;
  for (const oracle::DualSample& s : oracle::sample_dual(mesh, twin, levels)) {
    const bool there = std::any_of(s.owners.begin(), s.owners.end(), [&](std::uint32_t owner) {
      const auto [begin, end] = body->surface.patches_of(owner);
      return begin < end && body->surface.has_patch(PatchId(begin));
    });
    if (there) body->add(s.position, s.error);
  }
  // The fourth neighbour of a sample is about as far as the cells around it reach.
  for (const Point3& p : body->samples) {
    std::vector<double> all;
    for (const Point3& q : body->samples) all.push_back(distance(p, q));
    std::nth_element(all.begin(), all.begin() + 4, all.end());
    body->spacing = std::max(body->spacing, all[4]);
  }
  return body;
}

Point3 placed(const Motion& place, const Point3& p) {
  Point3 result;
  const auto& m = place.numbers();
  for (std::size_t k = 0; k < 3; ++k) {
    result[k] = m[4 * k] * p[0] + m[4 * k + 1] * p[1] + m[4 * k + 2] * p[2] + m[4 * k + 3];
  }
  return result;
}

std::vector<Point3> placed(const Motion& place, const std::vector<Point3>& points) {
  std::vector<Point3> result;
  for (const Point3& p : points) result.push_back(placed(place, p));
  return result;
}

double nearest_sample(const Point3& p, const std::vector<Point3>& points) {
  double best = INFINITY;
  for (const Point3& q : points) best = std::min(best, length_sq(q - p));
  return std::sqrt(best);
}

double nearest_pair(const std::vector<Point3>& a, const std::vector<Point3>& b) {
  double best = INFINITY;
  for (const Point3& p : a) best = std::min(best, nearest_sample(p, b));
  return best;
}

// Checks one placement against samples; `counts` counts verdicts.
void check(const Body& a, const Body& b, const Motion& place_a, const Motion& place_b,
           std::map<std::string, int>& counts) {
  const std::string where = a.name + " and " + b.name;
  const double size = std::max(a.surface.size(), b.surface.size());
  const std::vector<Point3> on_a = placed(place_a, a.samples), on_b = placed(place_b, b.samples);
  const double rounding = 1e-14 * size;
  const double slack = 2 * (a.error + b.error) + rounding;
  const double upper = nearest_pair(on_a, on_b) + slack;
  const double lower = upper - 2 * slack - a.spacing - b.spacing;
  PieceCache scratch_a(a.model), scratch_b(b.model);
  const double tolerance = 1e-3 * size;
  const Collision answer = collide({a.model, scratch_a, place_a}, {b.model, scratch_b, place_b},
                                   testing::verdict_only(tolerance, 0));
  ++counts[name_of(answer.verdict)];
  ASSERT_NE(answer.verdict, Verdict::undecided) << where;
  EXPECT_LE(answer.distance.lower, upper) << where;
  if (answer.verdict == Verdict::separated) {
    EXPECT_GT(answer.distance.lower, 0) << where;
  } else {
    EXPECT_GE(tolerance, lower) << where;
    EXPECT_GE(answer.distance.upper, lower) << where;
    EXPECT_LE(nearest_sample((*answer.witness)[0].point, on_a), a.spacing + slack) << where;
    EXPECT_LE(nearest_sample((*answer.witness)[1].point, on_b), b.spacing + slack) << where;
  }
  // Two samples are not farther apart than this margin: no enclosure may leave either out.
  const Collision beyond = collide({a.model, scratch_a, place_a}, {b.model, scratch_b, place_b},
                                   testing::verdict_only(tolerance, upper));
  EXPECT_EQ(beyond.verdict, Verdict::within) << where;
}

// The same mesh twice, the second one moved by a hair, and smaller inside itself.
void check_with_itself(const Body& a, const Body& smaller, std::map<std::string, int>& counts) {
  const double size = a.surface.size();
  for (const double hair : {0.0, 1e-15, 1e-9, 1e-4}) {
    const Motion place = Motion::translation({hair * size, 0, 0});
    PieceCache scratch(a.model), other(a.model);
    const Collision answer =
        collide({a.model, scratch, {}}, {a.model, other, place}, testing::verdict_only(1e-3 * size, 0));
    ++counts[name_of(answer.verdict)];
    EXPECT_EQ(answer.verdict, Verdict::within) << a.name << ", " << hair;
    EXPECT_EQ(answer.distance.lower, 0) << a.name << ", " << hair;
    check(a, a, {}, place, counts);
  }
  check(a, smaller, {}, {}, counts);
}

void print(const std::map<std::string, int>& counts) {
  for (const auto& [verdict, count] : counts) std::cout << ' ' << verdict << ' ' << count;
  std::cout << '\n';
}

testing::TaggedCase smaller(testing::TaggedCase c) {
  c.name += ", smaller";
  for (oracle::Point& p : c.mesh.points) {
    for (double& x : p) x = 0.5 + 0.25 * (x - 0.5);
  }
  return c;
}

TEST(collide, agrees_with_samples_of_tagged_meshes) {
  std::mt19937_64 random(81);
  std::map<std::string, int> counts;
  for (const auto scheme : {oracle::PrimalScheme::catmull_clark, oracle::PrimalScheme::loop}) {
    const auto library = std::make_shared<BoundsCache>();
    for (const testing::TaggedCase& c : testing::tagged_cases(scheme, 82)) {
      if (random() % 3 > 0 || c.mesh.points.size() > 20) continue;
      if (oracle::sample_faces(c.mesh, c.rules, 0).empty()) continue;
      auto body = primal_body(c, 3, library);
      check_with_itself(*body, *primal_body(smaller(c), 3, library), counts);
      if (HasFailure()) FAIL() << c.name << ", " << testing::text_of(c.rules);
    }
  }
  print(counts);
  EXPECT_GT(counts["separated"], 10);
  EXPECT_GT(counts["within"], 30);
}

TEST(collide, agrees_with_samples_of_dual_schemes) {
  namespace meshes = oracle::meshes;
  std::mt19937_64 random(83);
  std::map<std::string, int> counts;
  for (const Scheme scheme : {Scheme::doo_sabin, Scheme::midedge}) {
    const auto library = std::make_shared<BoundsCache>();
    for (const auto& [name, plain] : std::vector<std::pair<std::string, oracle::TaggedMesh>>{
             {"cube", meshes::cube()},
             {"grid", meshes::quad_grid(4, 4)},
             {"prism 5", meshes::prism(5)},
             {"pyramid 7", meshes::pyramid(7)},
             {"mixed strip", meshes::mixed_strip()},
             {"triangles", meshes::triangulated(meshes::prism(6))}}) {
      testing::TaggedCase c{name, meshes::shaken(plain, 0.3, random), {}};
      auto body = dual_body(c.name, c.mesh, scheme, 3, library);
      c = smaller(c);
      check_with_itself(*body, *dual_body(c.name, c.mesh, scheme, 3, library), counts);
      if (HasFailure()) FAIL() << name << ", " << name_of(scheme);
    }
  }
  print(counts);
  EXPECT_GT(counts["separated"], 4);
  EXPECT_GT(counts["within"], 10);
}

// Shell inside shell: far from each other, whatever lies in between.
TEST(collide, separates_nested_shells_of_every_scheme) {
  for (const Scheme scheme : {Scheme::catmark, Scheme::loop, Scheme::doo_sabin, Scheme::midedge}) {
    oracle::TaggedMesh outer = oracle::meshes::cube();
    if (scheme == Scheme::loop) outer = oracle::meshes::triangulated(outer);
    if (rules_of(scheme).primal) outer.creases = {{0, 1, 10}, {1, 3, 2.5}, {0, 4, 0.3}};
    oracle::TaggedMesh inner = outer;
    for (oracle::Point& p : inner.points) {
      for (double& x : p) x = 0.5 + 0.3 * (x - 0.5);
    }
    const auto library = std::make_shared<BoundsCache>();
    const LimitSurface a(testing::control_mesh(outer), {scheme}, library),
        b(testing::control_mesh(inner), {scheme}, library);
    const SurfaceBvh model_a(a, {.threads = 1}), model_b(b, {.threads = 1});
    PieceCache scratch_a(model_a), scratch_b(model_b);
    const Collision answer =
        collide({model_a, scratch_a, {}}, {model_b, scratch_b, {}}, testing::verdict_only(1e-4, 0));
    EXPECT_EQ(answer.verdict, Verdict::separated) << name_of(scheme);
    EXPECT_GT(answer.distance.lower, 0) << name_of(scheme);
  }
}

}  // namespace
}  // namespace snug::schemes_collide_test
