// Patches that are fitted together: what comes out does not hang on the others or on the instruction set, and is as narrow as what
// quadratic_triangle() and offset_triangle() find for one patch. That it holds the patches is piece_record's to say.

#include <snug/bounds/piece_fit.h>

#include <gtest/gtest.h>
#include <snug/bounds/bounding_points.h>
#include <snug/bounds/enclosure.h>
#include <snug/bounds/part_kernels.h>
#include <snug/patch/evaluate.h>
#include <testing/containment.h>
#include <testing/counts.h>
#include <testing/disguises.h>
#include <testing/instruction_sets.h>
#include <testing/scheme_surfaces.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numeric>
#include <vector>

namespace snug::piece_fit_test {
namespace {

std::vector<Patch> patches_of(const LimitSurface& surface) {
  std::vector<Patch> patches;
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    if (surface.has_patch(PatchId(p))) patches.push_back(surface.patch(PatchId(p)));
  }
  return patches;
}

using Fits = std::vector<PieceFit> (*)(BoundsCache& library, std::span<const Patch> patches);
std::vector<PieceFit> fits_of(BoundsCache& library, std::span<const Patch> patches) {
  std::vector<PieceFit> fits(patches.size());
  fit_pieces(library, patches, fits);
  return fits;
}
// By kind; the answers in the order of the patches.
std::vector<PieceFit> sorted_fits_of(BoundsCache& library, std::span<const Patch> patches) {
  std::vector<std::size_t> order(patches.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return patches[a].kind->id() < patches[b].kind->id();
  });
  std::vector<Patch> sorted;
  for (const std::size_t i : order) sorted.push_back(patches[i]);
  std::vector<PieceFit> fits(patches.size()), result(patches.size());
  fit_sorted_pieces(library, sorted, fits);
  for (std::size_t i = 0; i < order.size(); ++i) result[order[i]] = fits[i];
  return result;
}
class BothWays : public ::testing::TestWithParam<Fits> {};
INSTANTIATE_TEST_SUITE_P(piece_fit, BothWays, ::testing::Values(fits_of, sorted_fits_of),
                         [](const auto& of) { return of.param == &fits_of ? "as_they_are" : "sorted"; });

// All numbers of an answer; of none the sign of its radius.
std::vector<double> numbers(const PieceFit& fit) {
  if (fit.offset.radius < 0) return {-1};
  std::vector<double> all{fit.offset.radius, fit.offset.rounding, fit.quadratic.error,
                          fit.quadratic.normal_error};
  const auto add = [&](const auto& v) { all.insert(all.end(), {v.x, v.y, v.z}); };
  for (const Point3& p : fit.offset.base) add(p);
  for (const Point3& p : fit.quadratic.corners) add(p);
  for (const Point3& p : fit.quadratic.middles) add(p);
  add(fit.quadratic.normal);
  for (const Vector3& axis : fit.axes) add(axis);
  all.insert(all.end(), fit.lower.begin(), fit.lower.end());
  all.insert(all.end(), fit.upper.begin(), fit.upper.end());
  return all;
}

bool same(const PieceFit& a, const PieceFit& b) {
  const std::vector<double> x = numbers(a), y = numbers(b);
  return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(double)) == 0;
}

TEST_P(BothWays, of_a_patch_does_not_depend_on_the_others) {
  std::mt19937_64 random(51);
  testing::for_each_surface(51, [&](const testing::NamedSurface& named) {
    std::vector<Patch> patches = patches_of(named.surface);
    const std::vector<PieceFit> together = GetParam()(named.surface.library(), patches);
    for (std::size_t i = 0; i < patches.size(); ++i) {
      ASSERT_TRUE(same(GetParam()(named.surface.library(), {&patches[i], 1})[0], together[i])) << named.name;
    }
    std::vector<std::size_t> order(patches.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::shuffle(order.begin(), order.end(), random);
    std::vector<Patch> shuffled;
    for (const std::size_t i : order) shuffled.push_back(patches[i]);
    const std::vector<PieceFit> others = GetParam()(named.surface.library(), shuffled);
    for (std::size_t i = 0; i < order.size(); ++i)
      ASSERT_TRUE(same(others[i], together[order[i]])) << named.name;
  });
}

TEST_P(BothWays, is_the_same_on_every_instruction_set) {
  const testing::EachInstructionSet sets;
  testing::for_each_surface(52, [&](const testing::NamedSurface& named) {
    const std::vector<Patch> patches = patches_of(named.surface);
    std::vector<PieceFit> first;
    sets.run([&](const char* name) {
      const std::vector<PieceFit> fits = GetParam()(named.surface.library(), patches);
      if (first.empty()) first = fits;
      for (std::size_t i = 0; i < fits.size(); ++i) {
        ASSERT_TRUE(same(fits[i], first[i])) << named.name << ", " << name;
      }
    });
  });
}

// The same patches one by one, as if nothing were known of others.
struct Alone {
  OffsetTriangle offset;
  QuadraticTriangle quadratic;
};
Alone alone(BoundsCache& library, const Patch& patch) {
  Alone result;
  BoundingPoints points;
  bounding_points(library, patch, points);
  result.quadratic = quadratic_triangle(library, patch, points);
  result.offset = offset_triangle(library, points, limit_corners(patch));
  return result;
}

TEST_P(BothWays, is_as_narrow_as_the_fit_of_one_patch) {
  double errors = 0, errors_alone = 0, radii = 0, radii_alone = 0;
  std::size_t answers = 0, patches_asked = 0;
  testing::for_each_surface(53, [&](const testing::NamedSurface& named) {
    const std::vector<Patch> patches = patches_of(named.surface);
    const std::vector<PieceFit> fits = GetParam()(named.surface.library(), patches);
    patches_asked += patches.size();
    for (std::size_t i = 0; i < patches.size(); ++i) {
      const PieceFit& fit = fits[i];
      if (fit.offset.radius < 0) continue;
      ++answers;
      const Alone other = alone(named.surface.library(), patches[i]);
      errors += fit.quadratic.error;
      errors_alone += other.quadratic.error;
      radii += fit.offset.radius;
      radii_alone += other.offset.radius;
      // A patch that is flat but for its parameters has the tips' errors alone, which are some levels down.
      const double of_tips = 2e-5 * patches[i].largest;
      EXPECT_LE(fit.quadratic.error, 2 * other.quadratic.error + of_tips) << named.name;
      EXPECT_LE(fit.offset.radius, 2 * other.offset.radius + of_tips) << named.name;
      EXPECT_LE(fit.quadratic.normal_error, fit.quadratic.error * (1 + 1e-6)) << named.name;
    }
  });
  std::printf("  %zu answers for %zu patches; errors %.3f, radii %.3f of those of one patch\n", answers,
              patches_asked, errors / errors_alone, radii / radii_alone);
  EXPECT_LE(errors, 1.15 * errors_alone);
  EXPECT_LE(radii, 1.06 * radii_alone);
  EXPECT_GT(answers, patches_asked / 3);
}

// dot(axis, x) in extended precision, for limit points x.
TEST_P(BothWays, reaches_as_far_along_its_axes_as_it_says) {
  std::mt19937_64 random(54);
  std::size_t samples = 0, near = 0;
  const auto expect_inside = [&](const std::string& name, const LimitSurface& surface) {
    const std::vector<Patch> patches = patches_of(surface);
    const std::vector<PieceFit> fits = GetParam()(surface.library(), patches);
    for (std::size_t i = 0; i < patches.size(); ++i) {
      if (fits[i].offset.radius < 0) continue;
      for (int sample = 0; sample < 6; ++sample) {
        const TriangleParameter at = sample < 3
                                         ? std::array<TriangleParameter, 3>{{{0, 0}, {1, 0}, {0, 1}}}[sample]
                                         : testing::random_parameter(random);
        const RelativePoint point = limit_point(patches[i], at);
        for (std::size_t a = 0; a < 3; ++a) {
          long double height = 0;
          for (std::size_t k = 0; k < 3; ++k) {
            height +=
                fits[i].axes[a][k] * (static_cast<long double>(patches[i].origin[k]) + point.relative[k]);
          }
          const long double known = 1.75L * point.error;
          ASSERT_GE(height, fits[i].lower[a] - known) << name;
          ASSERT_LE(height, fits[i].upper[a] + known) << name;
          const double size = fits[i].upper[a] - fits[i].lower[a];
          ++samples;
          near += height < fits[i].lower[a] + 0.01 * size || height > fits[i].upper[a] - 0.01 * size;
        }
      }
    }
  };
  testing::for_each_surface(
      54, [&](const testing::NamedSurface& named) { expect_inside(named.name, named.surface); });
  for (const auto scheme : {oracle::PrimalScheme::catmull_clark, oracle::PrimalScheme::loop}) {
    const auto library = std::make_shared<BoundsCache>();
    const std::vector<testing::TaggedCase> cases = testing::tagged_cases(scheme, 55);
    std::size_t next = 0;
    for (const testing::Disguise& disguise : testing::disguises()) {
      testing::TaggedCase c = cases[7 * next++ % cases.size()];
      for (oracle::Point& p : c.mesh.points) p = disguise.change(p);
      expect_inside(c.name + ", " + disguise.name, LimitSurface(testing::control_mesh(c.mesh, c.rules),
                                                                testing::options_of(c.rules), library));
    }
  }
  EXPECT_GT(samples, testing::fewer(20'000));
  EXPECT_GT(near, samples / 20);
}

// The direction is one of length 1, or zero: where the quadratic's corners lie on a line, or too close for squares.
TEST(piece_fit, has_no_direction_across_corners_on_a_line) {
  const auto direction_of = [](const std::array<Vector3, 6>& quadratic) {
    const PartShape shape{{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, quadratic};
    PatchFrame frame;
    kernels::make_frames({&shape, 1}, 1, {&frame, 1});
    EXPECT_TRUE(frame.good);
    return frame.direction;
  };
  const std::array<Vector3, 6> round{
      {{0, 0, 0}, {1, 0, 0.1}, {0, 1, 0}, {0.5, 0, 0}, {0.5, 0.5, 0}, {0, 0.5, 0}}};
  const auto with_third = [&](const Vector3& third) {
    std::array<Vector3, 6> changed = round;
    changed[1] = {1, 0, 0};
    changed[2] = third;
    return changed;
  };
  EXPECT_NEAR(length(direction_of(round)), 1, 1e-15);
  EXPECT_EQ(direction_of(with_third({0.25, 0, 0})), Vector3{});
  for (int exponent = -40; exponent > -1074; exponent -= 7) {
    const double size = length(direction_of(with_third({0.25, std::ldexp(1.1, exponent), 0})));
    EXPECT_TRUE(size == 0 || std::fabs(size - 1) < 1e-15) << exponent << ", " << size;
  }
}

TEST_P(BothWays, has_no_answer_for_what_has_no_triangle) {
  const auto library = std::make_shared<BoundsCache>();
  ControlMesh mesh;
  const oracle::TaggedMesh cube = oracle::meshes::triangulated(oracle::meshes::cube());
  const testing::TaggedCase c{"cube", cube, {.scheme = oracle::PrimalScheme::loop}};
  LimitSurface surface(testing::control_mesh(c.mesh, c.rules), testing::options_of(c.rules), library);
  std::vector<Patch> patches = patches_of(surface);
  for (Vector3& p : patches[0].points) p = {p.x, 0, 0};
  for (Vector3& p : patches[1].points) p = {};
  patches[2].points[1].y = INFINITY;
  patches[3].points[2].z = std::nan("");
  const std::vector<PieceFit> fits = GetParam()(*library, patches);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT(fits[i].offset.radius, 0) << i;
  for (std::size_t i = 4; i < fits.size(); ++i) EXPECT_GT(fits[i].offset.radius, 0) << i;
}

}  // namespace
}  // namespace snug::piece_fit_test
