#pragma once

#include <cstdlib>

#include <gtest/gtest.h>
#include <testing/counts.h>
#include <testing/disguises.h>
#include <testing/scheme_surfaces.h>

namespace snug::testing {

/// Calls visit(surface, name, random) for surfaces of every sort of kind in every disguise, a surface in every second one by
/// turns, until a test fails; with other meshes once more for every 5000 placements that the environment's SNUG_PLACEMENTS asks
/// for.
template <class Visit>
void for_each_disguised_surface(std::uint64_t seed, const Visit& visit) {
  const std::uint64_t rounds = 1 + number_of("SNUG_PLACEMENTS", 0) / 5000;
  for (std::uint64_t round = 0; round < rounds; ++round) {
    std::mt19937_64 random(seed + round);
    std::size_t turn = 0;
    for_each_surface(seed + round, [&](const NamedSurface& named) {
      const auto library = std::make_shared<BoundsCache>();
      const std::vector<Disguise> list = disguises();
      ++turn;
      for (std::size_t i = 0; i < list.size(); ++i) {
        if ((i + turn) % 2 != 0 && !long_check()) continue;
        const Disguise& disguise = list[i];
        ControlMesh mesh = named.surface.mesh();
        for (Point3& p : mesh.points) {
          const oracle::Point q = disguise.change({p.x, p.y, p.z});
          p = {q[0], q[1], q[2]};
        }
        const LimitSurface surface(std::move(mesh), named.surface.options(), library);
        visit(surface, named.name + ", " + disguise.name, random);
        if (::testing::Test::HasFailure()) return;
      }
    });
  }
}

}  // namespace snug::testing
