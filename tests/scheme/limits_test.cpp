#include <snug/scheme/refine.h>
#include <snug/scheme/rules.h>

#include <gtest/gtest.h>
#include <testing/tagged.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace snug::limits_test {
namespace {

std::vector<double> dense(const Stencils::Row& row, std::size_t count) {
  std::vector<double> all(count, 0.0);
  for (std::size_t i = 0; i < row.sources.size(); ++i) all[row.sources[i]] += row.weights[i];
  return all;
}

// The limit stays what it is under a step: row = next row * step, up to the errors that the rows own up to.
// Those of a dart come from an iteration and are never 0.
TEST(limit_stencils, of_darts_stay_under_a_step_within_their_errors) {
  for (const std::uint32_t n : {3u, 4u, 7u, 30u}) {
    for (const Scheme scheme : {Scheme::catmark, Scheme::loop}) {
      oracle::TaggedMesh twin = oracle::meshes::pole(n, false);
      twin.creases = {{0, 1, 10}};
      if (scheme == Scheme::loop) twin = oracle::meshes::triangulated(twin);
      const ControlMesh mesh = testing::control_mesh(twin);
      const Topology topology(mesh);
      const Sharpness sharpness = sharpness_of(mesh, topology);
      const SchemeOptions options{scheme};
      const RefinedTopology step = refine(topology, options, sharpness);
      const std::size_t count = topology.vertex_count();
      Stencils limit, next;
      rules_of(scheme).add_limit_row({topology, options, sharpness}, VertexId(0), limit);
      rules_of(scheme).add_limit_row({step.topology, options, step.sharpness}, VertexId(0), next);
      const double error = limit.row(0).error, next_error = next.row(0).error;
      EXPECT_GT(error, 0x1p-53) << n;
      EXPECT_LT(error, 1e-10) << n;
      std::vector<double> rest = dense(limit.row(0), count);
      const Stencils::Row outer = next.row(0);
      for (std::size_t i = 0; i < outer.sources.size(); ++i) {
        const std::vector<double> inner = dense(step.stencils.row(outer.sources[i]), count);
        for (std::size_t c = 0; c < count; ++c) rest[c] -= outer.weights[i] * inner[c];
      }
      double sum = 0;
      for (const double r : rest) sum += std::fabs(r);
      EXPECT_LE(sum, error + next_error) << name_of(scheme) << ", valence " << n;
      EXPECT_LE(sum, 1e-14) << name_of(scheme) << ", valence " << n;
    }
  }
}

// Of more valences than are kept.
TEST(limit_stencils, of_darts_are_the_same_however_many_came_between) {
  const auto weights = [](std::uint32_t n, Scheme scheme) {
    oracle::TaggedMesh twin = oracle::meshes::pole(n, false);
    twin.creases = {{0, 1, 10}};
    if (scheme == Scheme::loop) twin = oracle::meshes::triangulated(twin);
    const ControlMesh mesh = testing::control_mesh(twin);
    const Topology topology(mesh);
    Stencils limit;
    rules_of(scheme).add_limit_row({topology, {scheme}, sharpness_of(mesh, topology)}, VertexId(0), limit);
    std::vector<double> all = dense(limit.row(0), topology.vertex_count());
    all.push_back(limit.row(0).error);
    return all;
  };
  std::vector<std::vector<double>> first;
  for (std::uint32_t i = 0; i < 60; ++i) {
    const std::uint32_t n = 3 + i % 30;
    const auto both = {weights(n, Scheme::loop), weights(n, Scheme::catmark)};
    if (i < 30) {
      first.insert(first.end(), both);
    } else {
      EXPECT_TRUE(std::equal(both.begin(), both.end(), first.begin() + 2 * (i - 30))) << n;
    }
  }
}

}  // namespace
}  // namespace snug::limits_test
