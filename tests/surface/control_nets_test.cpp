#include <snug/surface/control_nets.h>

#include <testing/counts.h>
#include <testing/instruction_sets.h>
#include <testing/journeys.h>
#include <testing/scheme_surfaces.h>

#include <cstring>

namespace snug::control_nets_test {
namespace {

using testing::NamedSurface;

struct Nets {
  explicit Nets(const LimitSurface& surface) {
    std::vector<PatchId> patches;
    testing::for_each_patch(surface, [&](PatchId p) { patches.push_back(p); });
    ControlHull hull;
    for (std::size_t begin = 0; begin < patches.size(); begin += 8) {
      members.emplace_back(
          patches.begin() + static_cast<std::ptrdiff_t>(begin),
          patches.begin() + static_cast<std::ptrdiff_t>(std::min(begin + 8, patches.size())));
      hull.assign(surface, members.back());
      nets.add(hull);
    }
  }
  ControlNets nets;
  std::vector<std::vector<PatchId>> members;
};

// Extents of boxes are found again as a hull's, up to a few roundings.
TEST(control_nets, boxes_are_those_of_hulls_wherever_the_points_are) {
  std::mt19937_64 random(62);
  std::size_t boxes = 0;
  testing::for_each_surface(62, [&](const NamedSurface& named) {
    LimitSurface surface = named.surface;
    const Nets nets(surface);
    for (std::size_t j = 0; j < testing::journey_count; ++j) {
      const auto journey = static_cast<testing::Journey>(j);
      surface.move(testing::start_of(journey, named.surface.mesh().points, random));
      const Axes axes = orthonormal_axes({testing::unit(random), -1, testing::unit(random)},
                                         {1, testing::unit(random), testing::unit(random)});
      ControlHull hull;
      for (std::size_t i = 0; i < nets.members.size(); ++i, ++boxes) {
        hull.assign(surface, nets.members[i]);
        const Obb box = nets.nets.fit(i, surface, axes).box;
        for (std::size_t k = 0; k < 3; ++k) {
          const Extent extent = hull.extent(axes[k]);
          const double middle = dot(axes[k], box.centre - Point3{});
          ASSERT_NEAR(middle + box.half[k], extent.upper, 1e-12) << named.name << testing::name_of(journey);
          ASSERT_NEAR(middle - box.half[k], extent.lower, 1e-12) << named.name << testing::name_of(journey);
          // No less than what holds the patches: extents have 32 roundings of the largest coordinate to give.
          ASSERT_GE(middle + box.half[k], extent.upper - 40 * 0x1p-53 * 2) << named.name;
          ASSERT_LE(middle - box.half[k], extent.lower + 40 * 0x1p-53 * 2) << named.name;
        }
      }
    }
  });
  EXPECT_GT(boxes, testing::fewer(5'000));
}

TEST(control_nets, boxes_are_the_same_on_every_instruction_set) {
  std::vector<NamedSurface> surfaces;
  testing::for_each_surface(63, [&](const NamedSurface& named) {
    if (surfaces.size() < 12) surfaces.push_back(named);
  });
  const Axes axes = orthonormal_axes({3, 1, -2}, {0.5, 1, 1});
  std::vector<double> first;
  testing::EachInstructionSet().run([&](const char* name) {
    std::vector<double> numbers;
    for (const NamedSurface& named : surfaces) {
      const Nets nets(named.surface);
      for (std::size_t i = 0; i < nets.members.size(); ++i) {
        const ControlNets::Fit fit = nets.nets.fit(i, named.surface, axes);
        for (std::size_t k = 0; k < 3; ++k) {
          numbers.push_back(fit.box.half[k]);
          numbers.push_back(fit.box.centre[k]);
        }
        numbers.push_back(fit.patch_sizes);
      }
    }
    if (first.empty()) first = numbers;
    ASSERT_EQ(numbers.size(), first.size());
    EXPECT_EQ(std::memcmp(numbers.data(), first.data(), numbers.size() * sizeof(double)), 0) << name;
  });
  EXPECT_GT(first.size(), testing::fewer(100));
}

}  // namespace
}  // namespace snug::control_nets_test
