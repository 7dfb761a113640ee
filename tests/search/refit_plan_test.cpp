#include <snug/search/refit_plan.h>

#include <oracle/test_meshes.h>
#include <snug/patch/evaluate.h>
#include <snug/search/surface_bvh.h>
#include <testing/counts.h>
#include <testing/journeys.h>
#include <testing/patches.h>
#include <testing/scheme_surfaces.h>

#include <map>
#include <set>

namespace snug::refit_plan_test {
namespace {

using testing::Journey;
using testing::NamedSurface;

// Limit points of each patch, in scaled units.
std::map<std::uint32_t, std::vector<Point3>> samples_of(const LimitSurface& surface,
                                                        std::mt19937_64& random) {
  std::map<std::uint32_t, std::vector<Point3>> samples;
  testing::for_each_patch(surface, [&](PatchId p) {
    const Patch patch = surface.patch(p);
    for (int i = 0; i < 4; ++i) {
      const TriangleParameter at =
          i < 3 ? std::array<TriangleParameter, 3>{{{0, 0}, {1, 0}, {0, 1}}}[static_cast<std::size_t>(i)]
                : testing::random_parameter(random);
      samples[p.value()].push_back(patch.origin + limit_point(patch, at).relative);
    }
  });
  return samples;
}

// The patches below a name; their samples are in every box on the way.
std::vector<std::uint32_t> walk(const SurfaceBvh& model,
                                const std::map<std::uint32_t, std::vector<Point3>>& samples,
                                std::uint32_t name) {
  std::vector<std::uint32_t> below;
  if ((name & WideBvh::leaf_bit) != 0) {
    const std::uint32_t leaf = name & ~WideBvh::leaf_bit;
    for (std::size_t i = 0; i < model.tree().leaf(leaf).size(); ++i) {
      const std::uint32_t patch = model.patch(leaf, i).value();
      below.push_back(patch);
      WideNode::Distances found;
      for (const Point3& p : samples.at(patch)) {
        model.leaf(leaf).distances(p, 1e-14, found);
        EXPECT_LE(found[i], 0) << "box of patch " << patch;
      }
    }
    return below;
  }
  const WideNode& node = model.tree().node(name);
  for (std::uint32_t l = 0; l < node.count(); ++l) {
    for (const std::uint32_t patch : walk(model, samples, node.names[l])) {
      below.push_back(patch);
      WideNode::Distances found;
      for (const Point3& p : samples.at(patch)) {
        node.distances(p, 1e-14, found);
        EXPECT_LE(found[l], 0) << "node " << name << " around patch " << patch;
      }
    }
  }
  return below;
}

void expect_all_inside(const SurfaceBvh& model, std::mt19937_64& random) {
  const LimitSurface& surface = model.surface();
  const auto samples = samples_of(surface, random);
  const std::vector<std::uint32_t> found = walk(model, samples, model.tree().root().names[0]);
  EXPECT_EQ(std::set<std::uint32_t>(found.begin(), found.end()).size(), samples.size());
  const WideBvh& tree = model.tree();
  WideNode::Distances root;
  for (const auto& [patch, points] : samples) {
    for (const Point3& p : points) {
      EXPECT_LE(distance(p, tree.ball().centre), tree.ball().radius + 1e-14);
      tree.root().distances(p, 1e-14, root);
      EXPECT_LE(root[0], 0);
      const Vector3 direction{testing::unit(random) - 0.5, testing::unit(random) - 0.5,
                              testing::unit(random) - 0.5};
      EXPECT_LE(dot(direction, p - tree.dop().centre()), tree.dop().reach(direction) + 1e-14);
    }
  }
}

TEST(refit_plan, boxes_hold_limit_points_wherever_the_control_points_went) {
  std::mt19937_64 random(71);
  std::size_t refits = 0;
  testing::for_each_surface(71, [&](const NamedSurface& named) {
    if (samples_of(named.surface, random).empty()) return;
    for (std::size_t j = 0; j < testing::journey_count; ++j, ++refits) {
      const auto journey = static_cast<Journey>(j);
      const std::vector<Point3> here = named.surface.mesh().points,
                                start = testing::start_of(journey, here, random);
      // There or back; by the first plan alone, or by others, too.
      const bool there = refits / 2 % 2 == 0;
      SCOPED_TRACE(named.name + ", " + testing::name_of(journey));
      LimitSurface surface(named.surface, there ? here : start);
      SharedPlan plan;
      SurfaceBvh model(surface, {.threads = 1, .max_looser = refits % 2 == 0 ? INFINITY : 1.5}, plan);
      static_cast<void>(model.leaf(0));
      surface.move(there ? start : here);
      model.refit(plan);
      expect_all_inside(model, random);
      if (::testing::Test::HasFailure()) return;
    }
  });
  EXPECT_GT(refits, testing::fewer(1'000));
}

LimitSurface large_surface() {
  std::mt19937_64 random(34);
  return testing::surface_of(oracle::meshes::disturbed(
      oracle::meshes::quartered(
          oracle::meshes::quartered(oracle::meshes::quartered(oracle::meshes::icosahedron()))),
      20, 0.02, random));
}

TEST(refit_plan, axes_go_along_so_that_boxes_stay_as_narrow) {
  std::mt19937_64 random(72);
  LimitSurface surface = large_surface();
  const std::vector<Point3> rest = surface.mesh().points;
  SharedPlan shared;
  SurfaceBvh model(surface, {.threads = 1}, shared);
  const auto plan = shared.get();
  ASSERT_GT(plan->order().node_count(), 20u);
  for (const Journey journey :
       {Journey::tiny, Journey::turned, Journey::from_small, Journey::from_large, Journey::from_huge}) {
    surface.move(testing::start_of(journey, rest, random));
    WideBvh tree = WideBvh::in_order_of(plan->order());
    EXPECT_NEAR(plan->refit(surface, tree) / plan->looseness(), 1, 1e-6) << testing::name_of(journey);
    model.refit(shared);
    EXPECT_EQ(shared.get(), plan);
  }
  for (const Journey journey : {Journey::bent, Journey::mirrored}) {
    surface.move(testing::start_of(journey, rest, random));
    WideBvh tree = WideBvh::in_order_of(plan->order());
    EXPECT_LT(plan->refit(surface, tree) / plan->looseness(), 1.3) << testing::name_of(journey);
  }
}

TEST(refit_plan, another_one_is_made_where_boxes_are_much_larger_than_they_were) {
  std::mt19937_64 random(73);
  LimitSurface surface = large_surface();
  const std::vector<Point3> rest = surface.mesh().points;
  // Closed up to a sheet that is opened: leaves hold patches of both sides, which part.
  std::vector<Point3> closed = rest;
  for (Point3& p : closed) p.z *= 1e-3;
  surface.move(closed);
  SharedPlan shared;
  SurfaceBvh model(surface, {.threads = 1}, shared);
  const auto plan = shared.get();
  surface.move(rest);
  WideBvh tree = WideBvh::in_order_of(plan->order());
  const double loose = plan->refit(surface, tree) / plan->looseness();
  EXPECT_GT(loose, 1.5);
  model.refit(shared);
  const auto better = shared.get();
  ASSERT_NE(better, plan);
  // As good as one that knew of no other position.
  EXPECT_EQ(better->looseness(), RefitPlan(surface, std::vector<PatchId>(better->patches()), 1).looseness());
  expect_all_inside(model, random);
  model.refit(shared);
  EXPECT_EQ(shared.get(), better) << "once is enough";
}

TEST(refit_plan, boxes_depend_on_the_points_and_the_plan_alone) {
  std::mt19937_64 random(74);
  LimitSurface surface = large_surface();
  const std::vector<Point3> rest = surface.mesh().points,
                            other = testing::start_of(Journey::bent, rest, random);
  SharedPlan shared;
  SurfaceBvh model(surface, {.threads = 1, .max_looser = INFINITY}, shared);
  const auto boxes = [&] {
    const auto all = model.tree().node_boxes();
    std::vector<Point3> numbers;
    for (const Obb& box : all) {
      numbers.push_back(box.centre);
      numbers.push_back(Point3{} + box.half);
    }
    return numbers;
  };
  const std::vector<Point3> first = boxes();
  surface.move(other);
  model.refit(shared);
  EXPECT_NE(boxes(), first);
  surface.move(rest);
  model.refit(shared);
  EXPECT_EQ(boxes(), first);
}

}  // namespace
}  // namespace snug::refit_plan_test
