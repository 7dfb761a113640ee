#include <snug/picture/render.h>

#include <gtest/gtest.h>
#include <snug/base/contract.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <thread>

namespace snug {
namespace {

Point3 on_sphere(int i, int j, int steps) {
  const double a = 2 * std::numbers::pi * (i % steps) / steps, b = std::numbers::pi * j / steps;
  if (j == 0) return {0, 1, 0};
  if (j == steps) return {0, -1, 0};
  return {std::sin(b) * std::cos(a), std::cos(b), std::sin(b) * std::sin(a)};
}

// A unit sphere of one material without light: its pixels are exactly its colour.
Scene sphere(int steps, Colour colour) {
  Scene scene;
  scene.materials = {palette::flat(colour)};
  const auto add = [&](Point3 a, Point3 b, Point3 c) {
    ShadedTriangle t{{a, b, c}, {a - Point3{}, b - Point3{}, c - Point3{}}, 0};
    scene.triangles.push_back(t);
  };
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      const Point3 a = on_sphere(i, j, steps), b = on_sphere(i + 1, j, steps),
                   c = on_sphere(i + 1, j + 1, steps), d = on_sphere(i, j + 1, steps);
      if (j > 0) add(a, b, c);
      if (j + 1 < steps) add(a, c, d);
    }
  }
  return scene;
}

RenderOptions small(int size, int samples = 1) {
  RenderOptions options;
  options.width = options.height = size;
  options.samples = samples;
  options.background = {Colour::hex(0xffffff), Colour::hex(0xffffff)};
  return options;
}

Camera camera_on(const Vector3& direction) {
  Box3 box;
  box.add(Point3{-1, -1, -1});
  box.add(Point3{1, 1, 1});
  return frame(box, direction, {0, 1, 0.1}, 1);
}

bool is_white(const Image& image, int x, int y) {
  const std::size_t at = static_cast<std::size_t>(3 * (y * image.width + x));
  return image.rgb[at] == 255 && image.rgb[at + 1] == 255 && image.rgb[at + 2] == 255;
}

TEST(render, shows_a_closed_sphere_as_a_disc_without_pinholes) {
  for (const Vector3 direction : {Vector3{0, 0, -1}, {1, 0.2, 0.3}, {-0.3, -1, 0.2}, {1, 1, 1}}) {
    const Image image = render(sphere(60, Colour::hex(0x204060)), camera_on(direction), small(301));
    int covered = 0;
    for (int y = 0; y < image.height; ++y) {
      int first = -1, last = -1, count = 0;
      for (int x = 0; x < image.width; ++x) {
        if (is_white(image, x, y)) continue;
        if (first < 0) first = x;
        last = x;
        ++count;
      }
      covered += count;
      EXPECT_EQ(count, first < 0 ? 0 : last - first + 1) << "pinhole in row " << y;
    }
    // A unit sphere at distance d is seen under the angle asin(1/d).
    const Camera camera = camera_on(direction);
    const double d = length(camera.eye - Point3{});
    const double radius = std::tan(std::asin(1 / d)) / camera.tangent * 301 / 2;
    EXPECT_NEAR(covered / (std::numbers::pi * radius * radius), 1, 0.01);
  }
}

TEST(render, does_not_depend_on_threads_or_the_order_of_triangles) {
  Scene scene = sphere(20, Colour::hex(0x808080));
  scene.materials = {palette::surface(), palette::enclosure()};
  for (const ShadedTriangle& t : std::vector<ShadedTriangle>(scene.triangles)) {
    ShadedTriangle larger = t;
    for (Point3& p : larger.corner) p = {1.2 * p.x, 1.2 * p.y, 1.2 * p.z};
    larger.material = 1;
    scene.triangles.push_back(larger);
  }
  scene.lines.push_back({{-1, -1, 1}, {1, 1, 1}, 2, palette::ink});
  const Camera camera = camera_on({0.3, -0.4, -1});
  const Image alone = render(scene, camera, small(120, 2));
  RenderOptions two = small(120, 2);
  two.parallel_for = [](std::size_t count, const std::function<void(std::size_t, std::size_t)>& body) {
    std::thread other([&] { body(count / 2, count); });
    body(0, count / 2);
    other.join();
  };
  EXPECT_EQ(render(scene, camera, two).rgb, alone.rgb);
  std::reverse(scene.triangles.begin(), scene.triangles.end());
  EXPECT_EQ(render(scene, camera, two).rgb, alone.rgb);
}

TEST(render, hands_on_what_progress_throws) {
  RenderOptions options = small(50);
  options.progress = [](double) { throw std::runtime_error("enough"); };
  EXPECT_THROW(static_cast<void>(render(sphere(8, palette::ink), camera_on({0, 0, -1}), options)),
               std::runtime_error);
}

TEST(render, expects_finite_numbers) {
  const ContractHandler before = set_contract_handler(
      [](const ContractViolation& violation) { throw std::logic_error(violation.condition); });
  Scene scene = sphere(8, palette::ink);
  scene.triangles[3].corner[1].y = NAN;
  EXPECT_THROW(static_cast<void>(render(scene, camera_on({0, 0, -1}), small(10))), std::logic_error);
  set_contract_handler(before);
}

}  // namespace
}  // namespace snug
