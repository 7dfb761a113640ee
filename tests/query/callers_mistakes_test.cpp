// A caller's mistake is an InputError with a code, never the end of the process.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <experiments/convergence.h>
#include <experiments/corner_nets.h>
#include <experiments/rooms.h>
#include <experiments/tightness.h>
#include <snug/curves.h>
#include <snug/distance.h>
#include <snug/patch/evaluate.h>
#include <snug/search/pair_frames.h>
#include <snug/surface/batch_bounds.h>
#include <snug/surface/evaluate.h>

namespace snug::callers_mistakes_test {
namespace {

template <class Call>
void expect_refused(const char* what, const Call& call) {
  try {
    call();
    ADD_FAILURE() << what << ": not refused";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problem(), InputProblem::value) << what << ": " << error.what();
    const std::string message = error.what();
    EXPECT_GT(message.size(), 10u) << what;
    EXPECT_EQ(message.find('\n'), std::string::npos) << what;
  }
}

ControlMesh square() {
  ControlMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.25}, {0, 1, 0}};
  mesh.add_face(std::array{VertexId(0), VertexId(1), VertexId(2), VertexId(3)});
  return mesh;
}

ControlMesh triangle() {
  ControlMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.25}};
  mesh.add_face(std::array{VertexId(0), VertexId(1), VertexId(2)});
  return mesh;
}

LimitSurface surface_of(ControlMesh mesh, Scheme scheme) {
  SchemeOptions options;
  options.scheme = scheme;
  return {std::move(mesh), options, std::make_shared<BoundsCache>()};
}

const std::vector<double> no_numbers{NAN, INFINITY, -INFINITY};

TEST(callers_mistakes, a_surface_needs_a_library) {
  expect_refused("null", [] { LimitSurface(square(), {.scheme = Scheme::catmark}, nullptr); });
  const LimitSurface surface = surface_of(square(), Scheme::catmark);
  expect_refused("patch", [&] { static_cast<void>(surface.patch(PatchId(2))); });
  expect_refused("no patch", [&] { static_cast<void>(surface.patch(PatchId())); });
}

TEST(callers_mistakes, bound_needs_a_positive_tolerance_and_a_level_that_there_is) {
  const Surface surface(square());
  const auto run = [&](const BoundOptions& options) {
    bound(surface, options, [](const PatchEnclosure&) {});
  };
  for (const double tolerance : std::vector<double>{NAN, INFINITY, -INFINITY, 0, -1e-300}) {
    expect_refused("error", [&] { run({.error = tolerance}); });
  }
  expect_refused("level", [&] { run({.error = {}, .level = 61}); });
  expect_refused("level", [&] { run({.error = {}, .level = UINT32_MAX}); });
}

TEST(callers_mistakes, points_of_a_surface_have_parameters_on_it) {
  const LimitSurface quad = surface_of(square(), Scheme::catmark),
                     loop = surface_of(triangle(), Scheme::loop);
  const PatchEvaluator of_loop(loop, PatchId(0));
  LimitEvaluator kept(loop.patch(PatchId(0)));
  std::vector<BoundedPoint> points(1);
  const std::vector<double> outside{NAN, INFINITY, -INFINITY, -1e-300, 1 + 0x1p-52};
  for (const double x : outside) {
    expect_refused("quad u", [&] { static_cast<void>(evaluate(quad, {0, 0, x, 0})); });
    expect_refused("quad v", [&] { static_cast<void>(evaluate(quad, {0, 0, 0, x})); });
    expect_refused("loop u", [&] { static_cast<void>(evaluate(loop, {0, 0, x, 0})); });
    expect_refused("positions on a quad", [&] {
      SurfaceEvaluator(quad).positions(std::array{Place{0, 0, 0, x}}, points);
    });
    expect_refused("evaluator of a triangle", [&] { static_cast<void>(of_loop(TriangleParameter{0, x})); });
    expect_refused("kept pieces", [&] { kept.points(std::array{Place{0, 0, x, 0}}, points); });
    expect_refused("patch", [&] {
      static_cast<void>(limit_point(loop.patch(PatchId(0)), TriangleParameter{x, 0}));
    });
    expect_refused("frame", [&] { static_cast<void>(kept.frame({0, 0, 0, x})); });
  }
  expect_refused("sum", [&] { static_cast<void>(evaluate(loop, {0, 0, 0.5, 0.5 + 0x1p-52})); });
  expect_refused("owner", [&] { static_cast<void>(evaluate(quad, {1, 0, 0, 0})); });
  expect_refused("corner", [&] { static_cast<void>(evaluate(quad, {0, 1, 0, 0})); });
  expect_refused("no such patch", [&] { PatchEvaluator(quad, PatchId(7)); });
  std::array<float, 3> one{};
  std::array<float, 6> two{};
  const std::array<Place, 2> places{};
  expect_refused("room for positions", [&] { evaluate(quad, places, {one}, 1); });
  expect_refused("room for normals", [&] { evaluate(quad, places, {two, one}, 1); });
}

TEST(callers_mistakes, curves_have_edges_and_parameters) {
  ControlMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  mesh.add_polyline(std::array{VertexId(0), VertexId(1), VertexId(2)});
  const CurveSet curves(std::move(mesh), CurveDegree::cubic);
  const auto run = [&](const BoundOptions& options) { bound(curves, options, [](const CurveEnclosure&) {}); };
  expect_refused("error", [&] { run({.error = -1}); });
  expect_refused("level", [&] { run({.error = {}, .level = 61}); });
  expect_refused("edge", [&] { static_cast<void>(evaluate(curves, EdgeId(2), 0)); });
  for (const double t : std::vector<double>{NAN, -1e-300, 1 + 0x1p-52}) {
    expect_refused("t", [&] { static_cast<void>(evaluate(curves, EdgeId(0), t)); });
  }
}

TEST(callers_mistakes, patch_bounds_take_a_point_a_vertex_and_patches_that_there_are) {
  const LimitSurface surface = surface_of(square(), Scheme::catmark);
  BatchBounds bounds(surface, {}, 1);
  std::vector<Point3> points = surface.mesh().points;
  std::vector<OffsetTriangle> out(bounds.patches().size());
  EXPECT_NO_THROW(bounds.update(points, out));
  expect_refused("room", [&] { bounds.update(points, std::span(out).first(1)); });
  points.pop_back();
  expect_refused("points", [&] { bounds.update(points, out); });
  expect_refused("patch", [&] { BatchBounds(surface, std::vector{PatchId(2)}, {}, 1); });
  expect_refused("no patch", [&] { BatchBounds(surface, std::vector{PatchId()}, {}, 1); });
}

TEST(callers_mistakes, queries_take_finite_numbers) {
  const Surface surface(square());
  for (const double x : no_numbers) {
    expect_refused("point", [&] { static_cast<void>(closest_point(surface, {x, 0, 0})); });
    expect_refused("points", [&] {
      static_cast<void>(closest_point(surface, std::vector<Point3>{{0, 0, x}}, {}, {.threads = 2}));
    });
    expect_refused("precision",
                   [&] { static_cast<void>(closest_point(surface, Point3{}, {.absolute = x})); });
    expect_refused("tolerance", [&] { static_cast<void>(collide(surface, surface, {.tolerance = x})); });
    expect_refused("relative", [&] { static_cast<void>(distance(surface, surface, {.relative = x})); });
  }
}

TEST(callers_mistakes, pairs_of_trees_take_a_workspace_for_each) {
  const LimitSurface surface = surface_of(square(), Scheme::catmark);
  const SurfaceBvh a(surface, {.threads = 1}), b(surface, {.threads = 1});
  PieceCache at_a(a), at_b(b);
  expect_refused("one for two", [&] { PairFrames({a, at_a, {}}, {a, at_a, {}}); });
  expect_refused("another's", [&] { PairFrames({a, at_b, {}}, {b, at_a, {}}); });
}

TEST(callers_mistakes, experiments_need_something_to_measure) {
  expect_refused("nets", [] { static_cast<void>(measure_tightness({.nets = 0})); });
  expect_refused("steps", [] { static_cast<void>(measure_tightness({.nets = 1, .steps = 0})); });
  RateOptions rates;
  rates.levels = 61;
  expect_refused("levels", [&] { static_cast<void>(measure_rates(rates)); });
  expect_refused("corners", [] { static_cast<void>(polygon_mesh(2)); });
  expect_refused("rings", [] { static_cast<void>(fan_mesh(3, 0)); });
  expect_refused("size", [] { static_cast<void>(unit_model({})); });
  std::mt19937_64 random(1);
  expect_refused("room", [&] { static_cast<void>(place_in_room(1, random)); });
}

TEST(callers_mistakes, messages_tell_small_numbers_from_zero) {
  try {
    require_length(-1e-300, "the tolerance");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "the tolerance is -1e-300: give a finite number that is not negative");
  }
}

}  // namespace
}  // namespace snug::callers_mistakes_test
