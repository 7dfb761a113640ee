// What two plane facets have in common, against rational arithmetic that clips halfplanes and solves for each corner.

#include <snug/geometry/plane_facets.h>

#include <gtest/gtest.h>
#include <oracle/plane_facet_twin.h>
#include <testing/counts.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace snug::plane_facets_test {
namespace {

using State = FacetMeeting::State;
using Random = std::mt19937_64;

using Exact = oracle::plane_facets::Vector;
using oracle::plane_facets::common_corners;
using oracle::plane_facets::cross;
using oracle::plane_facets::dot;
using oracle::plane_facets::normal_of;
using oracle::plane_facets::operator-;

struct Facet {
  std::vector<Exact> exact;
  std::vector<ExactPoint> points;
};

double unit(Random& random) { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; }

// Products of numbers much below that underflow.
double next_up(double x) { return x == 0 ? 0x1p-60 : std::nextafter(x, 2 * x); }

// A rigid motion, or nearly: rows and an offset, all doubles.
struct Pose {
  std::array<std::array<double, 4>, 3> rows{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
};

Facet facet_of(const std::vector<Point3>& points, const Pose& pose) {
  Facet facet;
  for (const Point3& p : points) {
    Exact x;
    std::array<ExactNumber, 3> sum;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& row = pose.rows[i];
      x[i] = mpq_class(row[0]) * mpq_class(p.x) + mpq_class(row[1]) * mpq_class(p.y) +
             mpq_class(row[2]) * mpq_class(p.z) + mpq_class(row[3]);
      sum[i] = ExactNumber(row[3]);
      for (std::size_t k = 0; k < 3; ++k) sum[i] = sum[i] + ExactNumber(row[k]) * ExactNumber(p[k]);
    }
    facet.exact.push_back(x);
    facet.points.emplace_back(std::move(sum));
  }
  return facet;
}

// Strictly convex, of 3 to 7 corners on a lattice of the plane z = height: the hull of some points, or a sliver.
std::vector<Point3> polygon(Random& random, double height, int sort) {
  const double step = sort % 3 == 0 ? 0.1 : sort % 3 == 1 ? 0.125 : 0x1p-30;
  std::vector<Point3> points;
  while (points.size() < 3) {
    std::vector<std::array<int, 2>> all;
    const std::size_t count = 3 + random() % 6;
    for (std::size_t i = 0; i < count; ++i) {
      std::array<int, 2> p{static_cast<int>(random() % 9) - 4, static_cast<int>(random() % 9) - 4};
      if (sort % 5 == 4) p[1] = p[1] > 0;  // slivers, once they are scaled
      all.push_back(p);
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    if (all.size() < 3) continue;
    const auto turn = [](const std::array<int, 2>& a, const std::array<int, 2>& b,
                         const std::array<int, 2>& c) {
      return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    };
    std::vector<std::array<int, 2>> hull;
    for (int half = 0; half < 2; ++half) {
      const std::size_t start = hull.size();
      for (const auto& p : all) {
        while (hull.size() >= start + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
        hull.push_back(p);
      }
      hull.pop_back();
      std::reverse(all.begin(), all.end());
    }
    if (hull.size() < 3) continue;
    const double thin = sort % 5 == 4 ? 0x1p-40 : 1;
    for (const auto& p : hull) points.push_back({step * p[0], thin * step * p[1], height});
    if (random() % 2 == 0) std::reverse(points.begin(), points.end());
    std::rotate(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(random() % points.size()),
                points.end());
  }
  return points;
}

// The exact point that a computed one stands for is a corner of the twin's.
bool near_one(const BoundedPoint& p, const std::vector<Exact>& corners) {
  return std::any_of(corners.begin(), corners.end(), [&](const Exact& x) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (abs(mpq_class(mpq_class(p.position[k]) - x[k])) > mpq_class(p.error)) return false;
    }
    return true;
  });
}

// The corners of the least element of a facet that a point of it is on.
std::vector<std::size_t> least_element(const Facet& facet, const Exact& x) {
  const std::size_t n = facet.exact.size();
  std::vector<std::size_t> all;
  for (std::size_t k = 0; k < n; ++k) {
    if (facet.exact[k] == x) return {k};
    all.push_back(k);
  }
  for (std::size_t k = 0; k < n; ++k) {
    const Exact &e = facet.exact[k], &f = facet.exact[(k + 1) % n];
    if (cross(x - e, x - f) == Exact{}) return {std::min(k, (k + 1) % n), std::max(k, (k + 1) % n)};
  }
  return all;
}

// Planes along axes and aslant; upright to each other or at any angle; parallel an ulp apart; polygons on one lattice, so that edges and
// corners are often shared, contain each other and are equal; scales far from each other; poses that take several doubles.
TEST(plane_facets, have_in_common_what_rational_arithmetic_says) {
  std::map<std::string, std::size_t> counts;
  Random random(7);
  for (std::uint64_t trial = 0; trial < testing::fewer(3000) && !HasFailure(); ++trial) {
    const int sort = static_cast<int>(random() % 15);
    const double height = 0.125 * static_cast<double>(random() % 3);
    std::vector<Point3> p = polygon(random, height, sort), q = polygon(random, height, sort);
    const unsigned relation = random() % 8;
    if (relation == 0) q = p;
    if (relation == 1) {  // upright, through a line of the lattice
      for (Point3& x : q) x = {x.x, 0, height + x.y};
    }
    if (relation == 2) {
      for (Point3& x : q) x.z = next_up(x.z);
    }
    if (relation == 3) {  // at an angle
      for (Point3& x : q) x.z = height + x.x + 0.5 * x.y;
      // x + y / 2 rounded may leave the plane: three corners are in one.
      q.resize(3);
    }
    if (relation == 4) {  // nearly in the plane
      q.resize(3);
      for (Point3& x : q) x.z = random() % 2 == 0 ? x.z : next_up(x.z);
    }
    Pose pose, other;
    const unsigned motion = random() % 4;
    if (motion == 1) {  // offsets that do not round away
      for (std::size_t i = 0; i < 2; ++i) pose.rows[i][3] = other.rows[i][3] = unit(random);
      if (random() % 2 == 0) other.rows[0][3] += 0.1;
    }
    if (motion >= 2) {  // any map, and the same, or nearly, for both
      for (auto& row : pose.rows) {
        for (double& x : row) x = unit(random);
      }
      other = pose;
      if (motion == 3) other.rows[random() % 3][random() % 4] *= 1 + 0x1p-52;
    }
    const Facet a = facet_of(p, pose), b = facet_of(q, other);
    const auto x = PlaneFacet::made(a.points), y = PlaneFacet::made(b.points);
    ASSERT_EQ(x.has_value(), normal_of(a.exact) != Exact{});
    ASSERT_EQ(y.has_value(), normal_of(b.exact) != Exact{});
    if (!x || !y) continue;
    const std::vector<Exact> truth = common_corners(a.exact, b.exact);
    const FacetMeeting found = meet(*x, *y);
    const std::string what = "trial " + std::to_string(trial) + " relation " + std::to_string(relation) +
                             " motion " + std::to_string(motion) + " sort " + std::to_string(sort);
    if (found.state == State::apart) {
      EXPECT_TRUE(truth.empty()) << what;
      ++counts["apart"];
    } else if (found.state == State::touching) {
      ++counts["touching in " + std::to_string(std::min<std::size_t>(truth.size(), 4)) + " corners"];
      counts["exact"] += std::all_of(found.corners.begin(), found.corners.end(),
                                     [](const BoundedPoint& c) { return c.error == 0; });
      ASSERT_EQ(found.corners.size(), truth.size()) << what;
      for (const BoundedPoint& c : found.corners) {
        EXPECT_LE(c.error, 0x1p-50) << what;
        EXPECT_TRUE(near_one(c, truth)) << what;
      }
      // As the first facet runs. Corners of slivers may be one up to rounding.
      const Exact n = normal_of(a.exact);
      std::vector<Exact> ordered;
      for (const BoundedPoint& c : found.corners) {
        std::vector<Exact> near;
        std::copy_if(truth.begin(), truth.end(), std::back_inserter(near),
                     [&](const Exact& e) { return near_one(c, {e}); });
        if (near.size() == 1) ordered.push_back(near[0]);
      }
      const std::size_t count = ordered.size();
      for (std::size_t k = 0; count > 2 && count == truth.size() && k < count; ++k) {
        const Exact &c = ordered[k], &d = ordered[(k + 1) % count], &e = ordered[(k + 2) % count];
        EXPECT_GT(dot(n, cross(d - c, e - c)), 0) << what;
        ++counts["turns"];
      }
      for (std::size_t s = 0; s < 2; ++s) {
        const Facet& facet = s == 0 ? a : b;
        std::vector<std::size_t> on = found.elements[s];
        const std::size_t n_corners = facet.exact.size();
        ASSERT_FALSE(on.empty());
        if (truth.size() == 1 && std::count(facet.exact.begin(), facet.exact.end(), truth[0]) == 1) {
          EXPECT_EQ(on.size(), 1u) << what;
        }
        if (on.size() == n_corners && truth.size() > 2) continue;
        // All of it on the element; and no smaller one would do.
        for (const Exact& t : truth) {
          if (on.size() == 1) {
            EXPECT_EQ(t, facet.exact[on[0]]) << what;
          }
          if (on.size() == 2) {
            const Exact &e = facet.exact[on[0]], &f = facet.exact[on[1]];
            EXPECT_EQ(cross(t - e, t - f), Exact{}) << what;
            EXPECT_LE(dot(t - e, t - f), 0) << what;
            const std::size_t apart = on[1] - on[0];
            EXPECT_TRUE(apart == 1 || apart + 1 == n_corners) << what;
          }
        }
        if (on.size() == n_corners) {
          for (std::size_t k = 0; k < n_corners; ++k) {
            const Exact &e = facet.exact[k], &f = facet.exact[(k + 1) % n_corners];
            EXPECT_FALSE(std::all_of(truth.begin(), truth.end(), [&](const Exact& t) {
              return cross(t - e, t - f) == Exact{};
            })) << what;
          }
        }
      }
    } else {
      ++counts["crossing"];
      ASSERT_EQ(truth.size(), 2u) << what;
      ASSERT_EQ(found.corners.size(), 2u) << what;
      for (std::size_t e = 0; e < 2; ++e) {
        EXPECT_LE(found.corners[e].error, 0x1p-50) << what;
        std::vector<Exact> near;
        std::copy_if(truth.begin(), truth.end(), std::back_inserter(near),
                     [&](const Exact& t) { return near_one(found.corners[e], {t}); });
        ASSERT_FALSE(near.empty()) << what;
        if (near.size() > 1) continue;  // a short one
        for (std::size_t s = 0; s < 2; ++s)
          EXPECT_EQ(found.ends[e][s], least_element(s == 0 ? a : b, near[0])) << what;
        ++counts["ends in " + std::to_string(std::min<std::size_t>(found.ends[e][0].size(), 3)) + " and " +
                 std::to_string(std::min<std::size_t>(found.ends[e][1].size(), 3)) + " corners"];
      }
    }
  }
  for (const auto& [name, number] : counts) std::printf("  %-32s %8zu\n", name.c_str(), number);
  if (testing::fewer(3000) < 3000) return;
  for (const char* name : {"apart", "touching in 1 corners", "touching in 2 corners", "touching in 3 corners",
                           "touching in 4 corners", "exact", "turns", "crossing"})
    EXPECT_GT(counts[name], 50u) << name;
  for (const char* name :
       {"1 and 1", "1 and 2", "1 and 3", "2 and 1", "2 and 2", "2 and 3", "3 and 1", "3 and 2"})
    EXPECT_GT(counts["ends in " + std::string(name) + " corners"], 2u) << name;
}

TEST(plane_facets, of_unit_squares_are_exact) {
  const auto square = [](double x, double y, double z) {
    std::vector<ExactPoint> points;
    for (const Point3& p : {Point3{0, 0, 0}, Point3{1, 0, 0}, Point3{1, 1, 0}, Point3{0, 1, 0}})
      points.push_back(facet_of({p}, {{{{1, 0, 0, x}, {0, 1, 0, y}, {0, 0, 1, z}}}}).points[0]);
    return *PlaneFacet::made(points);
  };
  const FacetMeeting found = meet(square(0, 0, 1), square(0.3, 0.2, 1));
  ASSERT_EQ(found.corners.size(), 4u);
  for (const BoundedPoint& corner : found.corners) {
    EXPECT_EQ(corner.error, 0);
    EXPECT_TRUE((corner.position.x == 0.3 || corner.position.x == 1) &&
                (corner.position.y == 0.2 || corner.position.y == 1) && corner.position.z == 1);
  }
  EXPECT_EQ(meet(square(0, 0, 1), square(0.3, 0.2, std::nextafter(1.0, 2))).state, State::apart);
  EXPECT_EQ(meet(square(0, 0, 1), square(1, 0, 1)).corners.size(), 2u);
  EXPECT_EQ(meet(square(0, 0, 1), square(1, 1, 1)).corners.size(), 1u);
  EXPECT_EQ(meet(square(0, 0, 1), square(1, std::nextafter(1.0, 2), 1)).state, State::apart);
}

}  // namespace
}  // namespace snug::plane_facets_test
