#pragma once

#include <checker/answers/file.h>
#include <checker/rejected.h>
#include <gtest/gtest.h>
#include <snug/collide.h>
#include <snug/distance.h>
#include <snug/ray.h>
#include <testing/disguised_surfaces.h>
#include <testing/surfaces.h>

#include <sstream>

/// Answers with their proofs, and what the checker says of these.
namespace snug::testing {

/// What is proved, or why not.
struct Checked {
  std::vector<std::string> proved;
  std::string refused;
  answers::LeastSlack least;
};
[[nodiscard]] inline Checked check(const std::string& text, std::size_t most_points = 1'000'000) {
  Checked result;
  try {
    result.proved = answers::check(text, result.least, most_points);
  } catch (const checker::Rejected& rejected) {
    result.refused = rejected.what();
  }
  return result;
}

using Lines = std::vector<std::string>;
[[nodiscard]] inline Lines lines_of(const std::string& text) {
  Lines lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}
[[nodiscard]] inline std::string text_of(const Lines& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + '\n';
  return text;
}

/// Every third of the surfaces of every scheme, flat and bilinear ones too, with tags of every sort; all of them, and of more seeds, if
/// SNUG_CERTIFICATES asks for more than the usual 1.
inline void for_each_certified_surface(std::uint64_t seed,
                                       const std::function<void(const std::string&, const Surface&)>& visit) {
  const std::uint64_t rounds = number_of("SNUG_CERTIFICATES", 1);
  const std::uint64_t stride = rounds > 1 ? 1 : fewer(4) == 4 ? 3 : 9;
  std::uint64_t number = seed;
  namespace meshes = oracle::meshes;
  for (std::uint64_t round = 0; round < rounds; ++round) {
    for_each_surface(seed + round, [&](const NamedSurface& named) {
      if (++number % stride != 0) return;
      bool any = false;
      for_each_patch(named.surface, [&](PatchId) { any = true; });
      if (any) visit(named.name, public_surface(named.surface.mesh(), named.surface.options()));
    });
    std::mt19937_64 random(seed + round);
    for (const auto& mesh : {meshes::cube(), meshes::prism(5), meshes::mixed_strip()}) {
      if (::testing::Test::HasFailure()) return;
      const oracle::TaggedMesh shaken = meshes::shaken(mesh, 0.3, random);
      visit("bilinear", Surface(control_mesh(shaken), {.scheme = Scheme::bilinear}));
      visit("flat", Surface(control_mesh(meshes::triangulated(shaken)), {.scheme = Scheme::flat}));
    }
  }
}

/// The second surface moved so that the middles of both boxes are `apart` sizes from each other.
[[nodiscard]] inline Motion placed_beside(const Surface& a, const Surface& b, double apart,
                                          std::mt19937_64& random) {
  const auto middle = [](const Surface& surface) {
    Box3 box;
    for (const Point3& p : surface.mesh().points) box.add(p);
    return box.lower + 0.5 * (box.upper - box.lower);
  };
  const auto side = [&] { return 2 * unit(random) - 1; };
  const Vector3 direction{side(), side(), side()};
  const Motion turn = Motion::rotation({side(), side(), 1}, 3 * unit(random));
  const double size = std::max(a.size(), b.size());
  const Vector3 to = (middle(a) - Point3{}) + (apart * size / length(direction)) * direction -
                     turn.rotate(middle(b) - Point3{});
  return turn.with_offset(to);
}

}  // namespace snug::testing
