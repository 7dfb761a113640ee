// Surfaces that rays meet by themselves, beside the same surfaces as triangles.

#include <picture/render.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <vector>

#include <snug/mesh.h>
#include <support/error.h>

namespace snug::surface_test {
namespace {

using Quad = std::array<std::uint32_t, 4>;

struct Shape {
  std::vector<Point3> points;
  std::vector<Quad> faces;
};

Shape box(Point3 low, Point3 high) {
  Shape shape;
  for (int i = 0; i < 8; ++i) {
    shape.points.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
  }
  shape.faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  return shape;
}

// All edges sharp: the limit surface is the mesh.
Surface surface_of(const Shape& shape) {
  ControlMesh mesh;
  mesh.points = shape.points;
  for (const Quad& face : shape.faces) {
    const std::array<VertexId, 4> corners{VertexId(face[0]), VertexId(face[1]), VertexId(face[2]),
                                          VertexId(face[3])};
    mesh.add_face(corners);
  }
  static_cast<void>(sharpen(mesh, 10));
  return Surface(std::move(mesh), {.scheme = Scheme::catmark});
}

constexpr Rows3 identity{Vector3{1, 0, 0}, Vector3{0, 1, 0}, Vector3{0, 0, 1}};

SceneSurface as_it_is(const RayCaster& caster) { return {&caster, identity, {}, identity, 0, {}}; }

void add_triangles(PictureScene& scene, const Shape& shape) {
  for (const Quad& f : shape.faces) {
    for (const auto& [a, b, c] : {std::array{f[0], f[1], f[2]}, std::array{f[0], f[2], f[3]}}) {
      scene.triangles.push_back({{shape.points[a], shape.points[b], shape.points[c]}, {}, 0});
    }
  }
}

Camera camera_on(const Shape& shape) { return frame(shape.points, {-0.5, -0.4, -0.8}, {0, 1, 0}, 1); }

RenderOptions plain(int size) {
  RenderOptions options;
  options.width = options.height = size;
  options.shadows = false;
  options.surface_tolerance = 1e-5;
  return options;
}

// How many bytes differ by more than a little, as at edges where the tolerance counts.
std::size_t differing(const Image& a, const Image& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) count += std::abs(int{a.rgb[i]} - int{b.rgb[i]}) > 3;
  return count;
}

int brightness(const Image& image, int x, int y) {
  const std::size_t at =
      3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
  return image.rgb[at] + image.rgb[at + 1] + image.rgb[at + 2];
}

TEST(surfaces_in_pictures, look_like_their_triangles) {
  const Shape shape = box({-0.4, -0.3, -0.5}, {0.4, 0.3, 0.5});
  const Surface surface = surface_of(shape);
  const RayCaster caster(surface, 1e-5, {.threads = 1});
  for (const double opacity : {1.0, 0.4}) {
    PictureScene by_rays{{{.colour = {0.2, 0.5, 0.8}, .opacity = opacity, .gloss = 0.3}}, {}, {}},
        by_triangles = by_rays;
    by_rays.surfaces.push_back(as_it_is(caster));
    add_triangles(by_triangles, shape);
    const Image a = render(by_rays, camera_on(shape), plain(200)),
                b = render(by_triangles, camera_on(shape), plain(200));
    EXPECT_LT(differing(a, b), a.rgb.size() / 200) << opacity;
    EXPECT_GT(differing(a, render(PictureScene{by_rays.materials, {}, {}}, camera_on(shape), plain(200))),
              a.rgb.size() / 5);
  }
}

TEST(surfaces_in_pictures, are_placed_by_their_similarity) {
  const Shape shape = box({-0.4, -0.3, -0.5}, {0.4, 0.3, 0.5});
  // The same box three times as large, a quarter turn about z and moved.
  Shape given;
  given.faces = shape.faces;
  for (const Point3& p : shape.points) given.points.push_back({3 * p.y + 7, -3 * p.x + 1, 3 * p.z - 2});
  const Surface surface = surface_of(given);
  const RayCaster caster(surface, 3e-5, {.threads = 1});
  PictureScene by_rays{{{.colour = {0.2, 0.5, 0.8}}}, {}, {}}, by_triangles = by_rays;
  by_rays.surfaces.push_back({&caster,
                              {Vector3{0, 3, 0}, Vector3{-3, 0, 0}, Vector3{0, 0, 3}},
                              {7, 1, -2},
                              {Vector3{0, -1, 0}, Vector3{1, 0, 0}, Vector3{0, 0, 1}},
                              0,
                              {}});
  add_triangles(by_triangles, shape);
  const Image a = render(by_rays, camera_on(shape), plain(200)),
              b = render(by_triangles, camera_on(shape), plain(200));
  EXPECT_LT(differing(a, b), a.rgb.size() / 200);
}

TEST(surfaces_in_pictures, hide_and_are_hidden_by_triangles) {
  const Shape near = box({-0.2, -0.2, 0.2}, {0.2, 0.2, 0.4}), far = box({-0.4, -0.4, -0.4}, {0.4, 0.4, -0.2});
  const Camera camera = frame(far.points, {0, 0, -1}, {0, 1, 0}, 1);
  for (const bool near_by_rays : {true, false}) {
    const Surface surface = surface_of(near_by_rays ? near : far);
    const RayCaster caster(surface, 1e-5, {.threads = 1});
    PictureScene scene{{{.colour = {1, 0, 0}, .lit = false}, {.colour = {0, 1, 0}, .lit = false}}, {}, {}};
    scene.surfaces.push_back(as_it_is(caster));
    add_triangles(scene, near_by_rays ? far : near);
    for (ShadedTriangle& t : scene.triangles) t.material = 1;
    const Image image = render(scene, camera, plain(101));
    const std::size_t middle = 3 * (50 * 101 + 50), side = 3 * (50 * 101 + 15);
    EXPECT_EQ(image.rgb[middle] > 200, near_by_rays);
    EXPECT_EQ(image.rgb[side] > 200, !near_by_rays);
  }
}

TEST(surfaces_in_pictures, are_cut_and_coloured) {
  const Shape shape = box({-0.4, -0.4, -0.4}, {0.4, 0.4, 0.4});
  const Surface surface = surface_of(shape);
  const RayCaster caster(surface, 1e-5, {.threads = 1});
  PictureScene scene{{{.colour = {0.2, 0.5, 0.8}, .lit = false}}, {}, {}};
  scene.surfaces.push_back(as_it_is(caster));
  // Green where the surface looks at the camera's side, red inside of the far wall.
  scene.surfaces[0].colour = [](const QuickHit& hit) {
    return hit.normal.z > 0.5 ? Colour{0, 1, 0} : hit.normal.z < -0.5 ? Colour{1, 0, 0} : Colour{0, 0, 1};
  };
  const Camera camera = frame(shape.points, {0, 0, -1}, {0, 1, 0}, 1);
  const std::size_t middle = 3 * (50 * 101 + 50);
  EXPECT_EQ(render(scene, camera, plain(101)).rgb[middle + 1], 255);
  scene.cut = CutPlane{{0, 0, 1}, 0.1};  // what is nearer than z = 0.1
  EXPECT_EQ(render(scene, camera, plain(101)).rgb[middle], 255);
  scene.cut = CutPlane{{1, 0, 0}, 0};  // the right half
  const Image half = render(scene, camera, plain(101));
  EXPECT_EQ(half.rgb[3 * (50 * 101 + 30) + 1], 255);
  EXPECT_GT(brightness(half, 70, 50), 600);  // paper
}

TEST(surfaces_in_pictures, cast_shadows) {
  const Shape floor = box({-0.5, -0.1, -0.5}, {0.5, 0, 0.5}),
              lid = box({-0.15, 0.25, -0.15}, {0.15, 0.3, 0.15});
  const Surface floor_surface = surface_of(floor), lid_surface = surface_of(lid);
  const RayCaster floor_caster(floor_surface, 1e-5, {.threads = 1}),
      lid_caster(lid_surface, 1e-5, {.threads = 1});
  PictureScene scene{{{.colour = {0.8, 0.8, 0.8}}}, {}, {}};
  scene.surfaces = {as_it_is(floor_caster), as_it_is(lid_caster)};
  const Camera camera = frame(floor.points, {0, -1, -0.6}, {0, 1, 0}, 1);
  RenderOptions options = plain(120);
  const Image without = render(scene, camera, options);
  options.shadows = true;
  const Image with = render(scene, camera, options);
  int darker = 0;
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 120; ++x) darker += brightness(with, x, y) < brightness(without, x, y) - 150;
  }
  EXPECT_GT(darker, 200);
  EXPECT_LT(darker, 6000);
  // The same for any threads.
  options.parallel_for = [](std::size_t count, const std::function<void(std::size_t, std::size_t)>& body) {
    for (std::size_t i = count; i-- > 0;) body(i, i + 1);
  };
  EXPECT_EQ(with, render(scene, camera, options));
}

}  // namespace
}  // namespace snug::surface_test
