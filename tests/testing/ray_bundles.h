#pragma once

#include <gtest/gtest.h>
#include <snug/snug.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

/// Rays that lie close together, which a search takes down the tree as one.
namespace snug::testing {

struct BundleCounts {
  std::size_t hits = 0, misses = 0, unsure = 0;
};

/// A place on a surface: at a corner or a side of a patch, or inside one; nothing where its face has no surface.
[[nodiscard]] inline std::optional<SurfacePoint> any_place(const Surface& surface, int sort,
                                                           std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  const auto face = static_cast<std::uint32_t>(random() % surface.mesh().face_count());
  const double u = sort % 3 == 0 ? 0 : unit(random) / 2, v = sort % 3 == 1 ? 0 : unit(random) / 2;
  try {
    return evaluate(surface, Place{face, 0, u, v});
  } catch (const InputError&) {
    return {};
  }
}

/// Rays of a bundle, at a place and beside it: from one eye or side by side, as far apart as a pixel or as the surface is large,
/// whole ones or segments, some along the surface, past a silhouette. Every eighth one goes through the place.
[[nodiscard]] inline std::vector<Ray> bundle_at(const SurfacePoint& at, double size, int sort,
                                                std::mt19937_64& random) {
  std::uniform_real_distribution<double> signed_unit(-1, 1);
  const auto unit = [&] { return signed_unit(random); };
  Vector3 from{unit(), unit(), unit()};
  if (sort % 4 == 3) from = {at.tangents[0].x + 1e-3 * size * unit(), at.tangents[0].y, at.tangents[0].z};
  const double away = 2 * size / std::max(1e-300, std::hypot(from.x, from.y, from.z));
  const Point3 eye{at.point.x + away * from.x, at.point.y + away * from.y, at.point.z + away * from.z};
  const double apart = size * std::ldexp(1.0, -4 * (sort % 10));
  std::vector<Ray> rays;
  for (int i = 0; i < 19; ++i) {
    const Vector3 aside{apart * unit(), apart * unit(), apart * unit()};
    const double off = i % 8 == 0 ? 0 : 1;
    const Point3 target{at.point.x + off * aside.x, at.point.y + off * aside.y, at.point.z + off * aside.z};
    const Point3 origin = sort % 2 == 0 ? eye : Point3{eye.x + aside.x, eye.y + aside.y, eye.z + aside.z};
    rays.push_back({origin, {target.x - origin.x, target.y - origin.y, target.z - origin.z}});
    if (sort % 5 == 0) rays.back().to = 1.0 + 0.25 * unit();
  }
  return rays;
}

/// Rays have together the answers of each alone, and none that goes through a point of the surface misses it for certain.
inline void expect_together_as_alone(const Surface& surface, const std::string& name, int bundles,
                                     std::mt19937_64& random, BundleCounts& counts) {
  const double size = surface.size();
  for (int bundle = 0; bundle < bundles; ++bundle) {
    const auto sort = static_cast<int>(random() % 120);
    const std::optional<SurfacePoint> at = any_place(surface, sort, random);
    if (!at) continue;
    const std::vector<Ray> rays = bundle_at(*at, size, sort, random);
    for (const RayQuery query : {RayQuery::nearest, RayQuery::all, RayQuery::any}) {
      RayOptions options{.query = query};
      if (random() % 2 == 0) options.absolute = 1e-3 * size;
      Run run{.threads = 2};
      if (random() % 2 == 0) run.max_splits = std::array{60u, 200u, 600u}[random() % 3];
      const std::vector<RayHits> together = ray(surface, rays, options, run);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const std::string which = name + ", sort " + std::to_string(sort) + ", ray " + std::to_string(i);
        const RayHits alone = ray(surface, rays[i], options, run);
        const RayHits& one = together[i];
        (alone.certain_hit() ? counts.hits : alone.certain_miss() ? counts.misses : counts.unsure)++;
        ASSERT_EQ(alone.certain_hit(), one.certain_hit()) << which;
        ASSERT_EQ(alone.certain_miss(), one.certain_miss()) << which;
        if (i % 8 == 0 && sort % 5 != 0) {
          ASSERT_FALSE(one.certain_miss()) << which;
        }
        if (query == RayQuery::any) continue;
        ASSERT_EQ(alone.outcome, one.outcome) << which;
        ASSERT_EQ(alone.hits.size(), one.hits.size()) << which;
        for (std::size_t k = 0; k < alone.hits.size(); ++k) {
          ASSERT_EQ(alone.hits[k].t, one.hits[k].t) << which;
          ASSERT_EQ(alone.hits[k].side, one.hits[k].side) << which;
          ASSERT_EQ(alone.hits[k].certified, one.hits[k].certified) << which;
        }
      }
    }
  }
}

}  // namespace snug::testing
