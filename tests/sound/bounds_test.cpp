// The promise itself: no limit point outside its enclosures, on more than a million adversarial points,
// against the twin's quadruple precision.

#include <snug/bound.h>

#include <gtest/gtest.h>
#include <oracle/loop_twin.h>
#include <snug/bounds/table_triangle.h>
#include <snug/search/piece.h>
#include <snug/surface/unscale.h>
#include <testing/containment.h>
#include <testing/disguises.h>
#include <testing/patches.h>
#include <testing/surfaces.h>

#include <functional>
#include <iostream>
#include <map>
#include <string>

namespace snug::bounds_test {
namespace {

// The piece of `level` digits that contains a parameter.
std::string piece_at(double u, double v, unsigned level) {
  std::string digits;
  for (unsigned i = 0; i < level; ++i) {
    if (u >= 0.5) {
      digits += '1', u = 2 * u - 1, v = 2 * v;
    } else if (v >= 0.5) {
      digits += '2', u = 2 * u, v = 2 * v - 1;
    } else if (u + v <= 0.5) {
      digits += '0', u = 2 * u, v = 2 * v;
    } else {
      digits += '3', u = 1 - 2 * u, v = 1 - 2 * v;
    }
  }
  return digits;
}

// Source of the enclosures.
struct Source {
  const char* name;
  BoundMethod method;
};
constexpr Source sources[] = {{"rows", BoundMethod::rows}, {"table", BoundMethod::table}};

struct Enclosures {
  OffsetTriangle offset;
  IntervalTriangle interval;
};

// Of one patch, in mesh units.
Enclosures enclosures_of(const LimitSurface& surface, const Patch& patch, const Source& source) {
  const PowerOfTwo back = surface.scale().inverse();
  if (source.method == BoundMethod::table) {
    const TableTriangle triangle = table_triangle(surface.library().table(*patch.kind), patch);
    return {unscaled(offset_triangle(triangle), back), unscaled(triangle.interval, back)};
  }
  BoundingPoints points;
  bounding_points(surface.library(), patch, points);
  const auto corners = limit_corners(patch);
  const OffsetTriangle offset = offset_triangle(surface.library(), points, corners);
  return {unscaled(offset, back), unscaled(interval_simplex(points, corners), back)};
}

class Checker {
 public:
  void check(const OffsetTriangle& offset, const IntervalTriangle& interval, const oracle::LimitSample& s,
             const std::string& where) {
    ++checked_;
    const testing::Extended p{s.position[0], s.position[1], s.position[2]};
    // The sample is known to s.error a coordinate; extended precision adds 1e-18 of what it works on.
    const long double size = std::fabs(p[0]) + std::fabs(p[1]) + std::fabs(p[2]);
    const long double slack = 1.8L * s.error + 1e-17L * offset.radius + 1e-18L * size;
    if (!testing::within_radius(p, offset.base, offset.radius + slack)) {
      ADD_FAILURE() << "outside the offset triangle: " << where << ", face " << s.face << " at " << s.u
                    << ", " << s.v;
    }
    if (!testing::in_interval_triangle(p, interval, slack)) {
      ADD_FAILURE() << "outside the interval triangle: " << where << ", face " << s.face << " at " << s.u
                    << ", " << s.v;
    }
  }
  [[nodiscard]] std::size_t checked() const { return checked_; }

 private:
  std::size_t checked_ = 0;
};

TEST(bounds, contain_a_million_adversarial_limit_points) {
  Checker checker;
  std::size_t points = 0;
  const std::vector<oracle::TwinMesh> meshes = testing::assorted_meshes(26);
  for (const testing::Disguise& disguise : testing::disguises()) {
    for (const oracle::TwinMesh& plain : meshes) {
      oracle::TwinMesh twin = plain;
      for (oracle::Point& p : twin.points) p = disguise.change(p);
      std::vector<oracle::LimitSample> samples = oracle::sample_uniform(twin, 4);
      for (std::uint32_t corner = 0; corner < 3; ++corner) {
        const auto deep = oracle::sample_near_corner(twin, 0, corner, 50);
        samples.insert(samples.end(), deep.begin(), deep.end());
      }
      points += samples.size();
      for (const Source& source : sources) {
        const Surface surface = testing::public_surface(twin, {.bounds = source.method});
        for (const unsigned level : {0u, 2u}) {
          std::map<std::pair<std::size_t, std::string>, PatchEnclosure> pieces;
          bound(surface, {.level = level},
                [&](const PatchEnclosure& e) {
                  pieces[{e.patch.owner, e.piece}] = e;
                },
                {.threads = 1});
          for (const oracle::LimitSample& s : samples) {
            const auto it = pieces.find({s.face, piece_at(s.u, s.v, level)});
            ASSERT_NE(it, pieces.end());
            checker.check(it->second.offset, it->second.interval, s,
                          disguise.name + ", " + source.name + ", level " + std::to_string(level));
          }
        }
      }
      if (HasFailure()) FAIL() << disguise.name;
    }
  }
  std::cout << points << " limit points, " << checker.checked() << " checks of two enclosures each\n";
  EXPECT_GE(points, 1'000'000u);
}

// Squares of what is left of a shape underflow beside a large one in the same mesh.
TEST(bounds, hold_for_a_grain_beside_a_boulder) {
  Checker checker;
  for (const double size : {1e-100, 1e-150, 1e-158, 1e-160, 1e-162, 1e-200}) {
    oracle::TwinMesh twin = oracle::meshes::octahedron();
    const auto count = static_cast<std::uint32_t>(twin.points.size());
    const oracle::TwinMesh grain = twin;
    for (const oracle::Point& p : grain.points)
      twin.points.push_back({size * p[0], size * p[1], size * p[2]});
    for (const oracle::Triangle& t : grain.triangles)
      twin.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
    const LimitSurface surface = testing::surface_of(twin);
    const auto samples = oracle::sample_uniform(twin, 3);
    for (const Source& source : sources) {
      for (const oracle::LimitSample& s : samples) {
        const Enclosures e = enclosures_of(surface, surface.patch(PatchId(s.face)), source);
        checker.check(e.offset, e.interval, s,
                      std::string(source.name) + ", grain of " + std::to_string(std::log10(size)));
      }
    }
  }
  EXPECT_GT(checker.checked(), 1000u);
}

// A kind's error terms: after 30 splits toward a corner, where valence 3 has shrunk to 1e-18 and rounding is
// all there is.
TEST(bounds, hold_after_thirty_splits_at_valences_3_to_500) {
  Checker checker;
  for (const std::uint32_t n :
       {3u, 4u, 5u, 6u, 7u, 8u, 9u, 10u, 12u, 16u, 20u, 33u, 50u, 100u, 200u, 333u, 500u}) {
    std::mt19937_64 random(n);
    oracle::TwinMesh twin = oracle::meshes::disturbed(oracle::meshes::bipyramid(n), 0, 0.1, random);
    for (oracle::Point& p : twin.points) p = {p[0] + 0.7, p[1] / 3, p[2] - 0.2};
    const LimitSurface surface = testing::surface_of(twin);
    for (std::uint32_t face = 0; face < 2; ++face) {
      for (std::uint32_t corner = 0; corner < 3; ++corner) {
        const auto samples = oracle::sample_near_corner(twin, face, corner, 42);
        Patch patch = surface.patch(PatchId(face));
        std::string path;
        for (unsigned level = 0; level <= 30; ++level) {
          for (const Source& source : sources) {
            const Enclosures e = enclosures_of(surface, patch, source);
            for (const oracle::LimitSample& s : samples) {
              if (piece_at(s.u, s.v, level) != path) continue;
              checker.check(e.offset, e.interval, s,
                            std::string(source.name) + ", valence " + std::to_string(n) + ", level " +
                                std::to_string(level));
            }
          }
          if (HasFailure()) FAIL() << "valence " << n;
          patch = split(patch, corner);
          path += static_cast<char>('0' + corner);
        }
      }
    }
  }
  std::cout << checker.checked() << " checks of two enclosures each\n";
  EXPECT_GE(checker.checked(), 30'000u);
}

TEST(bounds, hold_after_thirty_splits_along_random_paths) {
  Checker checker;
  std::mt19937_64 random(27);
  for (const oracle::TwinMesh& twin : testing::assorted_meshes(27)) {
    if (twin.boundary == oracle::Boundary::none) continue;
    const LimitSurface surface = testing::surface_of(twin);
    for (int trial = 0; trial < 6; ++trial) {
      const auto face = static_cast<std::uint32_t>(random() % surface.face_count());
      const double u = static_cast<double>(random() >> 24) * 0x1p-41,
                   v = static_cast<double>(random() >> 24) * 0x1p-41;
      const auto samples = oracle::sample_near_point(twin, face, u, v, 36);
      Patch patch = surface.patch(PatchId(face));
      const std::string whole = piece_at(u, v, 30);
      for (unsigned level = 0; level <= 30; ++level) {
        for (const Source& source : sources) {
          const Enclosures e = enclosures_of(surface, patch, source);
          for (const oracle::LimitSample& s : samples) {
            if (piece_at(s.u, s.v, level) == whole.substr(0, level))
              checker.check(e.offset, e.interval, s, source.name + (" " + whole.substr(0, level)));
          }
        }
        if (level < 30) patch = split(patch, static_cast<unsigned>(whole[level] - '0'));
      }
      if (HasFailure()) FAIL();
    }
  }
  EXPECT_GE(checker.checked(), 30'000u);
}

}  // namespace
}  // namespace snug::bounds_test
