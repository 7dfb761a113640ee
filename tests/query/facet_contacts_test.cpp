// Contacts of bodies with plane faces, against rational arithmetic for each pair of faces.

#include <snug/contacts.h>

#include <gtest/gtest.h>
#include <oracle/plane_facet_twin.h>
#include <snug/geometry/point_triangle.h>
#include <testing/counts.h>
#include <testing/tagged.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace snug::facet_contacts_test {
namespace {

using oracle::plane_facets::Polygon;
using oracle::plane_facets::Vector;
using oracle::plane_facets::operator-;
using Random = std::mt19937_64;

// A prism over a convex polygon: caps of any number of corners, sides of four; or all of it in triangles.
oracle::TaggedMesh prism(Random& random, double step, bool triangles) {
  static const std::vector<std::vector<std::array<int, 2>>> bases{
      {{0, 0}, {4, 0}, {0, 4}},
      {{0, 0}, {4, 0}, {4, 4}, {0, 4}},
      {{0, 0}, {3, 0}, {4, 2}, {1, 4}},
      {{1, 0}, {3, 0}, {4, 2}, {2, 4}, {0, 2}},
      {{1, 0}, {3, 0}, {4, 2}, {3, 4}, {1, 4}, {0, 2}},
      {{0, 0}, {9, 0}, {9, 1}}};  // a sliver
  const auto& base = bases[random() % bases.size()];
  const double height = step * static_cast<double>(1 + random() % 3);
  oracle::TaggedMesh mesh;
  const auto n = static_cast<std::uint32_t>(base.size());
  for (const double z : {0.0, height}) {
    for (const auto& p : base) mesh.points.push_back({step * p[0], step * p[1], z});
  }
  std::vector<std::vector<std::uint32_t>> faces(2);
  for (std::uint32_t k = 0; k < n; ++k) {
    faces[0].push_back(n - 1 - k);
    faces[1].push_back(n + k);
    const std::uint32_t next = (k + 1) % n;
    faces.push_back({k, next, n + next, n + k});
  }
  for (const std::vector<std::uint32_t>& face : faces) {
    for (std::size_t k = triangles ? 2 : face.size() - 1; k < face.size(); ++k) {
      mesh.polygons.push_back(triangles ? std::vector{face[0], face[k - 1], face[k]} : face);
    }
  }
  return mesh;
}

struct Body {
  Surface surface;
  std::vector<std::vector<std::uint32_t>> faces;
};
Body body(Random& random, double step, bool triangles) {
  const oracle::TaggedMesh mesh = prism(random, step, triangles);
  return {Surface(testing::control_mesh(mesh), {.scheme = triangles ? Scheme::flat : Scheme::bilinear}),
          mesh.polygons};
}

Polygon placed(const Body& body, std::size_t f, const Motion& pose) {
  Polygon polygon;
  for (const std::uint32_t v : body.faces[f]) {
    const Point3& p = body.surface.mesh().points[v];
    Vector x;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3 row = pose.row(i);
      x[i] = mpq_class(row.x) * mpq_class(p.x) + mpq_class(row.y) * mpq_class(p.y) +
             mpq_class(row.z) * mpq_class(p.z) + mpq_class(pose.offset()[i]);
    }
    polygon.push_back(x);
  }
  return polygon;
}

Point3 rounded(const Vector& x) { return {x[0].get_d(), x[1].get_d(), x[2].get_d()}; }

// The hull of a point, a segment or a convex polygon in order.
double distance_to(const std::vector<Point3>& points, const Point3& p) {
  const std::size_t n = points.size();
  double least = INFINITY;
  for (std::size_t k = 0; k == 0 || k + 2 < n; ++k) {
    const Triangle t{points[0], points[std::min(k + 1, n - 1)], points[std::min(k + 2, n - 1)]};
    least = std::min(least, distance_between(p, t, 1).lower);
  }
  return least;
}
bool holds(const Box3& box, const Point3& p) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(p[k] >= box.lower[k] - 1e-13 && p[k] <= box.upper[k] + 1e-13)) return false;
  }
  return true;
}
std::array<Point3, 2> side_of(const IntersectionCurve& curve, std::size_t k) {
  return {curve.points[k], curve.points[(k + 1) % curve.points.size()]};
}
bool in_area(const Contacts& found, const Point3& p) {
  return std::any_of(found.areas.begin(), found.areas.end(),
                     [&](const ContactArea& a) { return distance_to(a.points, p) <= 1e-13; });
}
// In an area, or on a side of a curve and in its box?
bool listed(const Contacts& found, const Point3& p) {
  const auto on_curve = [&](const IntersectionCurve& curve) {
    for (std::size_t k = 0; k < curve.boxes.size(); ++k) {
      const auto [from, to] = side_of(curve, k);
      if (holds(curve.boxes[k].box, p) && distance_to({from, to}, p) <= 1e-13) return true;
    }
    return false;
  };
  return in_area(found, p) || std::any_of(found.curves.begin(), found.curves.end(), on_curve);
}
// A point up to an error a coordinate?
bool is_at(const Point3& p, const Vector& x, double error) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (abs(mpq_class(mpq_class(p[k]) - x[k])) > mpq_class(error)) return false;
  }
  return true;
}

Motion some_pose(Random& random, double step, unsigned sort) {
  const auto lattice = [&](int most) { return step * (static_cast<int>(random() % (2 * most + 1)) - most); };
  const std::array<Vector3, 3> axes{Vector3{1, 0, 0}, Vector3{0, 1, 0}, Vector3{0, 0, 1}};
  Motion pose = sort == 1
                    ? Motion::rotation_degrees(axes[random() % 3], 90.0 * static_cast<double>(random() % 4))
                : sort == 2 ? Motion::rotation({0.3, 1, 0.7}, 0.9)
                : sort == 4 ? Motion::rotation({lattice(4) + 0.01, lattice(4), lattice(4)}, lattice(9))
                            : Motion{};
  Vector3 offset{lattice(4), lattice(4), lattice(3)};
  if (sort == 2) offset = {0.1, 0.7, -0.3};
  if (sort == 3) offset.z = offset.z == 0 ? 0x1p-60 : std::nextafter(offset.z, 2);
  return pose.with_offset(offset);
}

// triangle, quad, polygon and sliver, of flat and of bilinear; on one lattice, so that faces lie in each other, share edges and corners,
// are equal, contain each other or lie on each other's planes; turned by right angles; both turned alike by any; apart by the last bit;
// turned by any, so that they pass through each other.
TEST(facet_contacts, are_those_of_rational_arithmetic) {
  std::map<std::string, std::size_t> counts;
  Random random(11);
  const std::uint64_t trials = testing::number_of("SNUG_PLACEMENTS", 120);
  for (std::uint64_t trial = 0; trial < trials && !HasFailure(); ++trial) {
    const double step = trial % 2 == 0 ? 0.25 : 0.1;
    const Body a = body(random, step, trial % 3 == 0), b = body(random, step, trial / 3 % 2 == 0);
    const auto sort = static_cast<unsigned>(random() % 5);
    const Motion of_b = some_pose(random, step, sort), of_a = sort == 2 ? of_b : Motion{};
    const double within = random() % 2 == 0 ? 0 : 1e-3;
    const std::string what = "trial " + std::to_string(trial) + " sort " + std::to_string(sort);
    const Contacts found = contacts(a.surface.at(of_a), b.surface.at(of_b), {.within = within, .error = 0.2});
    EXPECT_TRUE(found.exhaustive) << what;
    std::map<std::array<std::uint32_t, 2>, Polygon> truth;
    std::vector<Polygon> segments;  // in which faces pass through each other
    for (std::uint32_t f = 0; f < a.faces.size(); ++f) {
      for (std::uint32_t g = 0; g < b.faces.size(); ++g) {
        const Polygon p = placed(a, f, of_a), q = placed(b, g, of_b);
        Polygon common = oracle::plane_facets::common_corners(p, q);
        if (common.empty()) continue;
        const auto passes = [](const Polygon& plane, const Polygon& other) {
          bool above = false, below = false;
          for (const Vector& x : other) {
            const int side =
                sgn(oracle::plane_facets::dot(oracle::plane_facets::normal_of(plane), x - plane[0]));
            above = above || side > 0;
            below = below || side < 0;
          }
          return above && below;
        };
        if (common.size() == 2 && passes(p, q) && passes(q, p)) segments.push_back(common);
        truth[{f, g}] = std::move(common);
      }
    }
    ++counts["trials"];
    counts["in contact"] += !truth.empty();
    counts["in contact without crossing"] += !truth.empty() && segments.empty();
    EXPECT_TRUE(found.open.empty()) << what;
    EXPECT_EQ(found.outcome, Outcome::complete) << what;
    EXPECT_EQ(found.areas.empty(), truth.size() == segments.size()) << what;
    EXPECT_EQ(found.compared, 0u) << what;
    // Each side of a curve is one of the segments, and each segment a side: bodies are closed, so that curves end at areas alone.
    std::size_t sides = 0;
    for (const IntersectionCurve& curve : found.curves) {
      ++counts[curve.closed ? "closed curves" : "open curves"];
      counts["curves of more than 8 sides"] += curve.boxes.size() > 8;
      EXPECT_TRUE(curve.proved) << what;
      EXPECT_LE(curve.error, 4e-14) << what;
      EXPECT_FALSE(curve.at_border[0] || curve.at_border[1]) << what;
      EXPECT_TRUE(curve.closed ||
                  (in_area(found, curve.points.front()) && in_area(found, curve.points.back())))
          << what;
      ASSERT_EQ(curve.boxes.size() + (curve.closed ? 0 : 1), curve.points.size()) << what;
      ASSERT_LT(curve.region, found.regions.size()) << what;
      EXPECT_EQ(found.regions[curve.region].verdict, Verdict::intersecting) << what;
      for (std::size_t k = 0; k < curve.boxes.size(); ++k) {
        const std::array<Point3, 2> side = side_of(curve, k);
        const Point3 &from = side[0], &to = side[1];
        EXPECT_TRUE(holds(found.regions[curve.region].box, from)) << what;
        EXPECT_TRUE(std::any_of(segments.begin(), segments.end(), [&](const Polygon& s) {
          return (is_at(from, s[0], curve.error) && is_at(to, s[1], curve.error)) ||
                 (is_at(from, s[1], curve.error) && is_at(to, s[0], curve.error));
        })) << what;
        ++sides;
      }
    }
    EXPECT_EQ(sides, segments.size()) << what;
    std::map<std::array<std::uint32_t, 2>, bool> owners;
    for (const ContactRegion& region : found.regions) {
      for (const PatchContact& c : region.contacts) owners[{c.patches[0].owner, c.patches[1].owner}] = true;
    }
    for (const ContactArea& area : found.areas) {
      const auto at = truth.find(area.faces);
      ASSERT_TRUE(at != truth.end()) << what;
      ASSERT_EQ(area.points.size(), at->second.size()) << what;
      ++counts["areas of " + std::to_string(std::min<std::size_t>(area.points.size(), 3)) + " corners"];
      counts["exact areas"] += area.error == 0;
      EXPECT_LE(area.error, 1e-14) << what;
      for (const Point3& p : area.points) {
        EXPECT_TRUE(std::any_of(at->second.begin(), at->second.end(), [&](const Vector& x) {
          return is_at(p, x, area.error);
        })) << what;
      }
      ASSERT_LT(area.region, found.regions.size()) << what;
      EXPECT_EQ(found.regions[area.region].verdict, Verdict::intersecting) << what;
      for (const Point3& p : area.points) {
        EXPECT_LE(distance_to(area.points, p), 1e-15);
        EXPECT_TRUE(holds(found.regions[area.region].box, p)) << what;
      }
    }
    for (const auto& [faces, common] : truth) {
      EXPECT_TRUE(owners.contains(faces)) << what << " faces " << faces[0] << " " << faces[1];
      for (const Vector& x : common) {
        for (const Vector& y : common) {
          Vector middle;
          for (std::size_t k = 0; k < 3; ++k) middle[k] = (x[k] + 2 * y[k]) / 3;
          ++counts["points"];
          EXPECT_TRUE(listed(found, rounded(middle))) << what << " faces " << faces[0] << " " << faces[1];
        }
      }
    }
    if (truth.empty()) {
      for (const ContactRegion& region : found.regions)
        EXPECT_NE(region.verdict, Verdict::intersecting) << what;
    }
  }
  for (const auto& [name, number] : counts) std::printf("  %-32s %8zu\n", name.c_str(), number);
  if (trials < 120) return;
  for (const char* name :
       {"in contact", "in contact without crossing", "areas of 1 corners", "areas of 2 corners",
        "areas of 3 corners", "exact areas", "closed curves", "open curves", "curves of more than 8 sides"})
    EXPECT_GT(counts[name], 2u) << name;
}

// Scaling takes such an offset away.
TEST(facet_contacts, are_not_told_exactly_of_offsets_that_scaling_loses) {
  Random random(1);
  const Body a = body(random, 4, false);
  const Motion pose = Motion::translation({0, 0, -std::numeric_limits<double>::denorm_min()});
  const Contacts found = contacts(a.surface, a.surface.at(pose), {.within = 0.0, .error = 4});
  EXPECT_TRUE(found.areas.empty());
  EXPECT_TRUE(found.exhaustive);
}

}  // namespace
}  // namespace snug::facet_contacts_test
