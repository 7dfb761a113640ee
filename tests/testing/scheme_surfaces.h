#pragma once

#include <gtest/gtest.h>
#include <snug/surface/limit_surface.h>
#include <testing/counts.h>
#include <testing/tagged.h>

#include <functional>
#include <memory>
#include <random>
#include <string>

/// Small surfaces of every scheme for tests of what all of them have in common.
namespace snug::testing {

/// From 0 to 1.
[[nodiscard]] inline double unit(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

[[nodiscard]] inline TriangleParameter random_parameter(std::mt19937_64& random) {
  const double u = unit(random), v = unit(random);
  return u + v <= 1 ? TriangleParameter{u, v} : TriangleParameter{1 - u, 1 - v};
}

struct NamedSurface {
  std::string name;
  LimitSurface surface;
};

/// Surfaces of every scheme, tagged and plain, until a test fails; under sanitizers every third, other ones of another seed.
inline void for_each_surface(std::uint64_t seed, const std::function<void(const NamedSurface&)>& visit) {
  namespace meshes = oracle::meshes;
  const bool all = fewer(4) == 4;
  std::uint64_t number = seed;
  for (const auto scheme : {oracle::PrimalScheme::catmull_clark, oracle::PrimalScheme::loop}) {
    const auto library = std::make_shared<BoundsCache>();
    for (const TaggedCase& c : tagged_cases(scheme, seed)) {
      if (!all && ++number % 3 != 0) continue;
      const std::string name = c.name + ", " + text_of(c.rules);
      visit({name, LimitSurface(control_mesh(c.mesh, c.rules), options_of(c.rules), library)});
      if (::testing::Test::HasFailure()) return;
    }
  }
  std::mt19937_64 random(seed);
  for (const Scheme scheme : {Scheme::doo_sabin, Scheme::midedge}) {
    const auto library = std::make_shared<BoundsCache>();
    for (const auto& [name, plain] : std::vector<std::pair<std::string, oracle::TaggedMesh>>{
             {"cube", meshes::cube()},
             {"grid", meshes::quad_grid(5, 4)},
             {"prism 5", meshes::prism(5)},
             {"pyramid 7", meshes::pyramid(7)},
             {"mixed strip", meshes::mixed_strip()},
             {"triangles", meshes::triangulated(meshes::quad_grid(4, 4))}}) {
      const oracle::TaggedMesh mesh = meshes::shaken(plain, 0.3, random);
      if (!all && ++number % 3 != 0) continue;
      visit({name + ", " + name_of(scheme), LimitSurface(control_mesh(mesh), {scheme}, library)});
      if (::testing::Test::HasFailure()) return;
    }
  }
}

/// Every patch that is there, until a test fails.
inline void for_each_patch(const LimitSurface& surface, const std::function<void(PatchId)>& visit) {
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    if (surface.has_patch(PatchId(p))) visit(PatchId(p));
    if (::testing::Test::HasFailure()) return;
  }
}

}  // namespace snug::testing
