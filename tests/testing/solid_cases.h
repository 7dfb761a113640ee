#pragma once

#include <oracle/winding_twin.h>
#include <snug/mesh/control_mesh.h>
#include <snug/scheme/scheme.h>
#include <testing/counts.h>
#include <testing/solids.h>
#include <testing/tagged.h>

#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>

/// Random solids of every scheme, plain and tagged, for tests of inside and outside.
namespace snug::testing {

struct SolidCase {
  std::string name;
  oracle::TaggedMesh mesh;
  oracle::WindingScheme scheme;
  SchemeOptions options;
};

/// Number by number: five of Catmull-Clark, one of Loop, one of Doo-Sabin, one of Midedge.
[[nodiscard]] inline SolidCase solid_case(std::uint64_t number) {
  std::mt19937_64 random(number * 7919 + 17);
  SolidCase c{"solid " + std::to_string(number), random_solid(random), {}, {}};
  const std::uint64_t which = number % 8;
  if (which >= 6) {
    c.scheme = which == 6 ? oracle::DualScheme::doo_sabin : oracle::DualScheme::midedge;
    c.options.scheme = which == 6 ? Scheme::doo_sabin : Scheme::midedge;
    c.name += std::string(", ") + name_of(c.options.scheme);
    return c;
  }
  oracle::Rules rules;
  rules.clamp_dart_edges = true;
  rules.scheme = which == 5 ? oracle::PrimalScheme::loop : oracle::PrimalScheme::catmull_clark;
  if (which == 5) c.mesh = oracle::meshes::triangulated(c.mesh);
  rules.chaikin = random() % 3 == 0;
  rules.smooth_triangles = which != 5 && random() % 3 == 0;
  if (random() % 3 == 0) tag(c.mesh, random, false);
  c.scheme = rules;
  c.options = options_of(rules);
  c.name += ", " + text_of(rules);
  return c;
}

[[nodiscard]] inline ControlMesh control_mesh(const SolidCase& c) {
  const oracle::Rules* const rules = std::get_if<oracle::Rules>(&c.scheme);
  return control_mesh(c.mesh, rules ? *rules : oracle::Rules{});
}

/// So many steps that a twin's mesh has so many faces or more, and two at least.
[[nodiscard]] inline int twin_levels(const oracle::TaggedMesh& mesh, std::size_t faces) {
  int level = 2;
  for (std::size_t count = 16 * mesh.polygons.size(); count < faces; count *= 4) ++level;
  return level;
}

[[nodiscard]] inline double between(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
}

}  // namespace snug::testing
