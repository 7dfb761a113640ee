// Patches that are fitted without a split, in single precision: limit points in extended precision, most of them near corners, are as
// near the base and the quadratic, and as far along the axes, as is said; whatever size and place the patches have.

#include <snug/bounds/piece_kernel.h>

#include <gtest/gtest.h>
#include <snug/bounds/piece_fit.h>
#include <snug/patch/evaluate.h>
#include <testing/containment.h>
#include <testing/counts.h>
#include <testing/disguises.h>
#include <testing/scheme_surfaces.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace snug::piece_kernel_test {
namespace {

using testing::Extended;

struct Counts {
  std::size_t patches = 0, fitted = 0, samples = 0, near_apart = 0, near_along = 0, near_base = 0,
              near_end = 0;
};

// A parameter so many levels down at a corner, or, every other time, anywhere.
TriangleParameter any_parameter(std::mt19937_64& random) {
  const TriangleParameter within = testing::random_parameter(random);
  if (random() % 2 == 0) return within;
  const double share = std::ldexp(1.0, -static_cast<int>(random() % 9));
  std::array<double, 3> weights{share * (1 - within.u - within.v), share * within.u, share * within.v};
  weights[random() % 3] += 1 - share;
  return {weights[1], weights[2]};
}

Extended on_quadratic(const QuadraticTriangle& q, TriangleParameter at) {
  const long double u = at.u, v = at.v, w = 1 - u - v;
  const std::array<long double, 3> of_corners{w * w, u * u, v * v},
      of_middles{2 * w * u, 2 * u * v, 2 * v * w};
  Extended sum{};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t a = 0; a < 3; ++a)
      sum[a] += of_corners[k] * q.corners[k][a] + of_middles[k] * q.middles[k][a];
  }
  return sum;
}

void expect_near(const Patch& patch, const PieceFit& fit, std::mt19937_64& random, const std::string& name,
                 Counts& counts) {
  for (int sample = 0; sample < 24; ++sample) {
    const TriangleParameter at = sample < 3
                                     ? std::array<TriangleParameter, 3>{{{0, 0}, {1, 0}, {0, 1}}}[sample]
                                     : any_parameter(random);
    const RelativePoint point = limit_point(patch, at);
    const long double known = 1.75L * point.error + 0x1p-60L;
    Extended x, off;
    const Extended q = on_quadratic(fit.quadratic, at);
    for (std::size_t a = 0; a < 3; ++a) {
      x[a] = static_cast<long double>(patch.origin[a]) + point.relative[a];
      off[a] = x[a] - q[a];
    }
    const Vector3& n = fit.quadratic.normal;
    const long double apart = std::sqrt(testing::inner(off, off)),
                      along = std::fabs(n.x * off[0] + n.y * off[1] + n.z * off[2]);
    ++counts.samples;
    ASSERT_LE(apart, fit.quadratic.error + known) << name << " at " << at.u << ", " << at.v;
    ASSERT_LE(along, fit.quadratic.normal_error + known) << name << " at " << at.u << ", " << at.v;
    ASSERT_TRUE(testing::within_radius(x, fit.offset.base, fit.offset.radius + known)) << name;
    counts.near_apart += apart > 0.6L * fit.quadratic.error;
    counts.near_along += along > 0.6L * fit.quadratic.normal_error;
    counts.near_base += !testing::within_radius(x, fit.offset.base, 0.8L * fit.offset.radius);
    for (std::size_t a = 0; a < 3; ++a) {
      const long double height = fit.axes[a].x * x[0] + fit.axes[a].y * x[1] + fit.axes[a].z * x[2];
      ASSERT_GE(height, fit.lower[a] - known) << name;
      ASSERT_LE(height, fit.upper[a] + known) << name;
      const double size = fit.upper[a] - fit.lower[a];
      counts.near_end += height < fit.lower[a] + 0.01 * size || height > fit.upper[a] - 0.01 * size;
    }
  }
}

// Those that the kernel answers.
void expect_all_near(const LimitSurface& surface, std::mt19937_64& random, const std::string& name,
                     Counts& counts) {
  BoundsCache& library = surface.library();
  std::vector<Patch> patches;
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    if (surface.has_patch(PatchId(p))) patches.push_back(surface.patch(PatchId(p)));
  }
  std::stable_sort(patches.begin(), patches.end(),
                   [](const Patch& a, const Patch& b) { return a.kind->id() < b.kind->id(); });
  std::vector<PieceFit> sorted(patches.size());
  fit_sorted_pieces(library, patches, sorted);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const Patch& patch = patches[i];
    if (patch.kind->polynomial() || !patch.kind->cacheable()) continue;
    const kernels::RowsWithTips<float>* const rows = library.piece_rows(*patch.kind);
    if (rows == nullptr) continue;
    ++counts.patches;
    PartShape shape;
    PatchFrame frame;
    PartBounds bounds;
    const kernels::PieceToFit piece{&patch, &shape, &frame, &bounds};
    kernels::fit_pieces_by_rows(*rows, kernels::most_row_levels, {&piece, 1});
    if (bounds.error < 0) continue;
    ++counts.fitted;
    expect_near(patch, sorted[i], random, name, counts);
    if (::testing::Test::HasFatalFailure()) return;
  }
}

TEST(piece_kernel, patches_are_as_near_as_it_says) {
  std::mt19937_64 random(71);
  Counts counts;
  testing::for_each_surface(71, [&](const testing::NamedSurface& named) {
    expect_all_near(named.surface, random, named.name, counts);
  });
  for (const auto scheme : {oracle::PrimalScheme::catmull_clark, oracle::PrimalScheme::loop}) {
    const auto library = std::make_shared<BoundsCache>();
    const std::vector<testing::TaggedCase> cases = testing::tagged_cases(scheme, 72);
    std::size_t next = 0;
    for (const testing::Disguise& disguise : testing::disguises()) {
      for (int of_disguise = 0; of_disguise < 2; ++of_disguise) {
        testing::TaggedCase c = cases[7 * next++ % cases.size()];
        for (oracle::Point& p : c.mesh.points) p = disguise.change(p);
        expect_all_near(
            LimitSurface(testing::control_mesh(c.mesh, c.rules), testing::options_of(c.rules), library),
            random, c.name + ", " + disguise.name, counts);
      }
    }
  }
  std::printf(
      "  %zu of %zu patches, %zu samples; near the bound: %zu apart, %zu along, %zu of the base, %zu of an "
      "end\n",
      counts.fitted, counts.patches, counts.samples, counts.near_apart, counts.near_along, counts.near_base,
      counts.near_end);
  EXPECT_GT(counts.fitted, counts.patches / 2);
  EXPECT_GT(counts.samples, testing::fewer(10'000));
  EXPECT_GT(counts.near_apart, counts.samples / 50);
  EXPECT_GT(counts.near_along, counts.samples / 50);
  EXPECT_GT(counts.near_base, counts.samples / 50);
  EXPECT_GT(counts.near_end, counts.samples / 20);
}

}  // namespace
}  // namespace snug::piece_kernel_test
