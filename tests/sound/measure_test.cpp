// Measures of random solids of every scheme and with every tag, against refined meshes, and against those of the same
// surface by a mesh that was refined once.
//
//   SNUG_SOLIDS=1000 build/release/bin/tests/sound_test --gtest_filter='measure.*'
//
// asks about so many; SNUG_FIRST=N begins with solid N.

#include <snug/measure.h>

#include <gtest/gtest.h>
#include <oracle/measure_twin.h>
#include <testing/solid_cases.h>

#include <algorithm>
#include <cmath>
#include <iostream>

namespace snug::measure_test {
namespace {

using testing::number_of;

std::array<Interval, oracle::kMeasures> all_of(const Measures& found) {
  std::array<Interval, oracle::kMeasures> all;
  all[0] = found.area;
  all[1] = *found.volume;
  for (std::size_t a = 0; a < 3; ++a) all[2 + a] = (*found.centroid)[a];
  for (std::size_t k = 0; k < 6; ++k) all[5 + k] = (*found.inertia)[k];
  return all;
}

TEST(measure, holds_those_of_refined_meshes) {
  const std::uint64_t first = number_of("SNUG_FIRST", 0), count = number_of("SNUG_SOLIDS", 20);
  std::vector<long double> errors;
  for (std::uint64_t number = first; number < first + count; ++number) {
    const testing::SolidCase c = testing::solid_case(number);
    SCOPED_TRACE(c.name);
    const Surface surface(testing::control_mesh(c),
                          {.scheme = c.options.scheme, .boundary = c.options.boundary});
    const Measures rough = measure(surface, {.relative = 1e-2}), found = measure(surface, {.relative = 1e-5});
    EXPECT_EQ(found.outcome, Outcome::complete);
    ASSERT_TRUE(found.volume);
    if (!found.inertia) continue;  // shells that cancel
    const oracle::MeasureEstimate twin =
        oracle::limit_measures(c.mesh, c.scheme, testing::twin_levels(c.mesh, 20'000));
    const auto all = all_of(found);
    for (std::size_t m = 0; m < all.size(); ++m) {
      EXPECT_LE(all[m].lower, twin.value[m] + twin.error[m]) << m;
      EXPECT_GE(all[m].upper, twin.value[m] - twin.error[m]) << m;
    }
    // Once refined by the twin it is the same surface, but for the rounding of its points.
    testing::SolidCase refined = c;
    refined.mesh = oracle::WindingTwin(c.mesh, c.scheme, 1).mesh();
    const Measures again = measure(Surface(testing::control_mesh(refined), {.scheme = c.options.scheme}),
                                   {.relative = 1e-7}),
                   closer = measure(surface, {.relative = 1e-7});
    ASSERT_TRUE(again.inertia && closer.inertia);
    const auto first_time = all_of(closer), second = all_of(again);
    for (std::size_t m = 0; m < all.size(); ++m) {
      EXPECT_LE(first_time[m].lower, second[m].upper + 1e-11) << m;
      EXPECT_GE(first_time[m].upper, second[m].lower - 1e-11) << m;
    }
    errors.push_back(twin.error[0] / twin.value[0]);
    errors.push_back(twin.error[1] / std::fabs(twin.value[1]));
    // A wider interval holds a narrower one, up to the rounding of either.
    EXPECT_LE(rough.area.lower, found.area.upper);
    EXPECT_GE(rough.area.upper, found.area.lower);
    EXPECT_LE(rough.volume->lower, found.volume->upper);
    EXPECT_GE(rough.volume->upper, found.volume->lower);
    if (::testing::Test::HasFailure()) return;
  }
  std::sort(errors.begin(), errors.end());
  ASSERT_FALSE(errors.empty());
  std::cout << "twins were good to " << errors[errors.size() / 2] << " in the median, "
            << errors[errors.size() * 19 / 20] << " in 95 of 100\n";
}

TEST(measure, holds_the_area_with_every_tag_and_rule) {
  std::vector<long double> errors;
  std::size_t none = 0;
  for (const auto scheme : {oracle::PrimalScheme::catmull_clark, oracle::PrimalScheme::loop}) {
    for (const testing::TaggedCase& c : testing::tagged_cases(scheme, 21)) {
      SCOPED_TRACE(c.name + ", " + testing::text_of(c.rules));
      const oracle::AreaEstimate twin =
          oracle::limit_area(c.mesh, c.rules, testing::twin_levels(c.mesh, 4000));
      const SchemeOptions options = testing::options_of(c.rules);
      const Surface surface(testing::control_mesh(c.mesh, c.rules),
                            {.scheme = options.scheme, .boundary = options.boundary});
      if (twin.value == 0) {
        EXPECT_THROW((void)measure(surface), InputError);
        ++none;
        continue;
      }
      const Measures found = measure(surface);
      EXPECT_EQ(found.outcome, Outcome::complete);
      EXPECT_LE(found.area.lower, twin.value + twin.error);
      EXPECT_GE(found.area.upper, twin.value - twin.error);
      errors.push_back(twin.error / twin.value);
      if (::testing::Test::HasFailure()) return;
    }
  }
  std::sort(errors.begin(), errors.end());
  std::cout << errors.size() << " surfaces and " << none << " without any; twins were good to "
            << errors[errors.size() / 2] << " in the median\n";
}

}  // namespace
}  // namespace snug::measure_test
