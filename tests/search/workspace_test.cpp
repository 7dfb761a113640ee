#include <array>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <snug/search/surface_data.h>
#include <snug/search/workspace.h>
#include <snug/snug.h>
#include <testing/places.h>

namespace snug::workspace_test {
namespace {

Surface star() { return load(testing::models_dir() + "/star.obj"); }

TEST(workspace, holds_nothing_of_surfaces_that_are_gone) {
  Workspace workspace;
  std::size_t one = 0;
  for (int i = 0; i < 50; ++i) {
    const Surface surface = star();  // another one each time, perhaps in the same memory
    static_cast<void>(closest_point(surface, {1, 2, 3}, {.absolute = 1e-6}, {.workspace = &workspace}));
    one = std::max(one, i == 0 ? workspace.bytes() : 0);
    EXPECT_LE(workspace.bytes(), 2 * one);
  }
  workspace.clear();
  EXPECT_EQ(workspace.bytes(), 0u);
}

TEST(workspace, keeps_a_surface_asked_about_against_itself_twice) {
  Workspace workspace;
  const Surface surface = star();
  const Motion beside = Motion::translation({0.1 * surface.size(), 0, 0});
  const Collision with_both = collide(surface, surface.at(beside), {}, {.workspace = &workspace});
  const Surface other = star();
  EXPECT_EQ(with_both.distance, collide(surface, other.at(beside), {}, {.workspace = &workspace}).distance);
  const Workspace::Pieces::Pair pair = workspace.pieces().of(surface, surface);
  EXPECT_NE(&pair.a, &pair.b);
  EXPECT_EQ(&pair.a, &workspace.pieces().of(surface));
}

TEST(workspace, outlives_handles_and_moves) {
  Workspace workspace;
  PlacedSurface placed = star().at(Motion::translation({1, 0, 0}));  // the only handle
  const Collision before = collide(placed, star(), {}, {.workspace = &workspace});
  Workspace moved = std::move(workspace);
  EXPECT_EQ(collide(placed, star(), {}, {.workspace = &moved}).distance, before.distance);
}

// Each crease makes patch topologies of its own; only so many are shared with the next surface.
TEST(workspace, surfaces_leave_a_cache_that_knows_very_many_topologies) {
  constexpr std::uint32_t size = 60;
  ControlMesh mesh;
  for (std::uint32_t i = 0; i <= size; ++i) {
    for (std::uint32_t k = 0; k <= size; ++k) {
      mesh.points.push_back({static_cast<double>(i), static_cast<double>(k), 0});
    }
  }
  const auto at = [](std::uint32_t i, std::uint32_t k) { return VertexId(i * (size + 1) + k); };
  for (std::uint32_t i = 0; i < size; ++i) {
    for (std::uint32_t k = 0; k < size; ++k) {
      mesh.add_face(std::array{at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)});
      mesh.tags.creases.push_back({at(i, k), at(i, k + 1), 0.5 + 1e-4 * (size * i + k)});
    }
  }
  const auto cache = [](const Surface& surface) { return &surface.data()->limit().library(); };
  const Surface first = star(), second = star(), large(mesh);
  large.data()->limit().find_kinds(1);
  const Surface third = star(), fourth = star();
  EXPECT_EQ(cache(first), cache(second));
  EXPECT_EQ(cache(first), cache(large));
  EXPECT_NE(cache(large), cache(third));
  EXPECT_EQ(cache(third), cache(fourth));
}

TEST(workspace, of_each_thread_gives_the_same_answers) {
  const Surface a = star(), b = star();
  const Motion beside = Motion::translation({0.6 * a.size(), 0, 0});
  const Interval expected = distance(a, b.at(beside)).distance;
  std::vector<Interval> found(4);
  std::vector<std::thread> threads;
  for (Interval& one : found) threads.emplace_back([&] { one = distance(a, b.at(beside)).distance; });
  for (std::thread& thread : threads) thread.join();
  for (const Interval& one : found) EXPECT_EQ(one, expected);
}

}  // namespace
}  // namespace snug::workspace_test
