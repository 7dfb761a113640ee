#include <picture/polyhedron.h>
#include <picture/render.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <thread>
#include <utility>
#include <vector>

namespace snug::extremes_test {
namespace {

constexpr Colour white = Colour::hex(0xffffff), red = Colour::hex(0xff0000), blue = Colour::hex(0x0000ff);

using Pixel = std::array<std::uint8_t, 3>;
constexpr Pixel white_pixel{255, 255, 255}, red_pixel{255, 0, 0}, blue_pixel{0, 0, 255};

Pixel pixel(const Image& image, int x, int y) {
  const std::size_t at = std::size_t{3} * (static_cast<std::size_t>(y) * image.width + x);
  return {image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
}

int count(const Image& image, const Pixel& wanted) {
  int n = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) n += pixel(image, x, y) == wanted;
  return n;
}

ShadedTriangle flat_triangle(Point3 a, Point3 b, Point3 c, std::uint32_t material = 0) {
  return {{a, b, c}, {}, material};
}

// Two triangles that fill the square |x|, |y| <= half at height z, seen from z > 0 as counter-clockwise.
void add_square(PictureScene& scene, double half, double z, std::uint32_t material) {
  const Point3 a{-half, -half, z}, b{half, -half, z}, c{half, half, z}, d{-half, half, z};
  scene.triangles.push_back(flat_triangle(a, b, c, material));
  scene.triangles.push_back(flat_triangle(a, c, d, material));
}

Point3 on_sphere(int i, int j, int steps) {
  const double a = 2 * std::numbers::pi * (i % steps) / steps, b = std::numbers::pi * j / steps;
  if (j == 0) return {0, 1, 0};
  if (j == steps) return {0, -1, 0};
  return {std::sin(b) * std::cos(a), std::cos(b), std::sin(b) * std::sin(a)};
}

// A closed unit sphere; seen from outside its triangles run counter-clockwise.
PictureScene sphere(int steps, const Material& material) {
  PictureScene scene;
  scene.materials = {material};
  const auto add = [&](Point3 a, Point3 b, Point3 c) {
    const Point3 centre;
    scene.triangles.push_back({{a, c, b}, {a - centre, c - centre, b - centre}, 0});
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

RenderOptions on_white(int size, int samples = 1) {
  RenderOptions options;
  options.width = options.height = size;
  options.samples = samples;
  options.background = {white, white};
  return options;
}

// At (0, 0, 4), looking at the origin: the picture shows |x|, |y| <= 1 at z = 0.
Camera ahead() {
  Camera camera;
  camera.eye = {0, 0, 4};
  return camera;
}

Camera around_unit_sphere(const Vector3& direction) {
  return frame(Box3{{-1, -1, -1}, {1, 1, 1}}, direction, {0, 1, 0.1}, 1);
}

const std::vector<Vector3>& view_directions() {
  static const std::vector<Vector3> directions{{0, 0, -1},    {1, 0, 0}, {0, -1, 0},
                                               {1, 0.2, 0.3}, {1, 1, 1}, {-0.3, -1, 2}};
  return directions;
}

auto two_threads() {
  return [](std::size_t size, const std::function<void(std::size_t, std::size_t)>& body) {
    std::thread other([&] { body(size / 2, size); });
    body(0, size / 2);
    other.join();
  };
}

// The depth at which a ray meets a triangle, one ray at a time and with more digits [Moeller97]; `clear` is
// how far, in barycentric coordinates, the ray stays from the triangle's border.
struct SlowHit {
  long double depth = std::numeric_limits<long double>::infinity(), clear = 1;
};

SlowHit meet(const Camera& camera, double s, double t, const ShadedTriangle& triangle) {
  using Triple = std::array<long double, 3>;
  const auto triple = [](Vector3 v) { return Triple{v.x, v.y, v.z}; };
  const auto times = [](const Triple& a, const Triple& b) {
    return Triple{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const auto along = [](const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
  const Triple ray = triple(camera.forward + s * camera.right + t * camera.up);
  const Triple e1 = triple(triangle.corner[1] - triangle.corner[0]),
               e2 = triple(triangle.corner[2] - triangle.corner[0]),
               from = triple(camera.eye - triangle.corner[0]);
  const Triple p = times(ray, e2), q = times(from, e1);
  const long double det = along(e1, p);
  SlowHit hit;
  if (det == 0) return hit;
  const long double u = along(from, p) / det, v = along(ray, q) / det;
  const long double least = std::min({u, v, 1 - u - v});
  hit.clear = std::fabs(least);
  if (const long double depth = along(e2, q) / det; least >= 0 && depth > 0) hit.depth = depth;
  return hit;
}

// Compares each pixel whose centre is clear of all borders with the nearest of slow hits; how many were hit.
int expect_nearest_everywhere(const PictureScene& scene, const Camera& camera, int width, int height) {
  RenderOptions options = on_white(1);
  options.width = width;
  options.height = height;
  const Image image = render(scene, camera, options);
  int hits = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double s = (2 * (x + 0.5) - width) / height * camera.tangent,
                   t = (height - 2 * (y + 0.5)) / height * camera.tangent;
      SlowHit nearest;
      long double clear = 1;
      Pixel expected = white_pixel;
      for (const ShadedTriangle& triangle : scene.triangles) {
        const SlowHit hit = meet(camera, s, t, triangle);
        clear = std::min(clear, hit.clear);
        if (hit.depth >= nearest.depth) continue;
        nearest = hit;
        const Colour& c = scene.materials[triangle.material].colour;
        const auto byte = [](double share) { return static_cast<std::uint8_t>(std::lround(255 * share)); };
        expected = {byte(c.red), byte(c.green), byte(c.blue)};
      }
      if (clear < 1e-10L) continue;
      hits += expected != white_pixel;
      EXPECT_EQ(pixel(image, x, y), expected) << "column " << x << ", row " << y;
    }
  }
  return hits;
}

TEST(render, fills_the_part_of_a_triangle_that_is_in_front_of_the_eye) {
  PictureScene scene;
  scene.materials = {palette::flat(red)};
  scene.triangles = {flat_triangle({-9, -0.5, -30}, {9, -0.4, -30}, {0.1, -0.3, 30})};
  EXPECT_GT(expect_nearest_everywhere(scene, ahead(), 100, 100), 1000);
}

TEST(render, shows_the_nearest_of_many_triangles_at_each_pixel) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> coordinate(-1, 1), size(-0.4, 0.4);
  PictureScene scene;
  for (std::uint32_t i = 0; i < 200; ++i) {
    const Point3 centre{coordinate(random), coordinate(random), coordinate(random)};
    const auto near = [&] { return centre + Vector3{size(random), size(random), size(random)}; };
    scene.materials.push_back(palette::flat(Colour::hex(0x10203 * (i + 1))));
    scene.triangles.push_back(flat_triangle(near(), near(), near(), i));
  }
  for (const Vector3& direction : view_directions()) {
    SCOPED_TRACE(testing::Message() << direction.x << ' ' << direction.y << ' ' << direction.z);
    EXPECT_GT(expect_nearest_everywhere(scene, around_unit_sphere(direction), 60, 50), 500);
  }
}

TEST(render, shows_a_closed_dense_sphere_without_pinholes) {
  const PictureScene scene = sphere(120, palette::flat(blue));
  for (const Vector3& direction : view_directions()) {
    const Image image = render(scene, around_unit_sphere(direction), on_white(301));
    EXPECT_GT(count(image, blue_pixel), 20'000);
    for (int y = 0; y < image.height; ++y) {
      int first = -1, last = -1, covered = 0;
      for (int x = 0; x < image.width; ++x) {
        if (pixel(image, x, y) == white_pixel) continue;
        if (first < 0) first = x;
        last = x;
        ++covered;
      }
      EXPECT_EQ(covered, first < 0 ? 0 : last - first + 1) << "pinhole in row " << y;
    }
  }
}

TEST(render, shows_a_closed_transparent_sphere_without_seams) {
  Material glass = palette::flat(blue);
  glass.opacity = 0.5;
  glass.two_sided = false;
  const PictureScene scene = sphere(60, glass);
  for (const Vector3& direction : view_directions()) {
    const Image image = render(scene, around_unit_sphere(direction), on_white(201));
    const Pixel once = pixel(image, 100, 100);
    EXPECT_NE(once, white_pixel);
    EXPECT_EQ(count(image, once) + count(image, white_pixel), 201 * 201);
  }
}

TEST(render, draws_a_line_without_length_as_a_dot) {
  PictureScene scene;
  scene.lines = {{{0, 0, 0}, {0, 0, 0}, 20, red}};
  EXPECT_NEAR(count(render(scene, ahead(), on_white(100)), red_pixel), std::numbers::pi * 100, 10);
}

TEST(render, draws_no_line_in_the_eye) {
  PictureScene scene;
  scene.lines = {{{0, 0, 4}, {0, 0, 4}, 4, red}};
  EXPECT_EQ(count(render(scene, ahead(), on_white(20)), white_pixel), 20 * 20);
}

TEST(render, draws_a_triangle_seen_edge_on_at_most_as_a_hairline) {
  PictureScene scene;
  scene.materials = {palette::surface()};
  scene.triangles = {flat_triangle({0, -0.5, -0.5}, {0, 0.5, -0.5}, {0, 0, 0.5})};
  EXPECT_EQ(count(render(scene, ahead(), on_white(20)), white_pixel), 20 * 20);
}

TEST(render, shades_by_the_directions_of_normals_not_their_lengths) {
  const PictureScene scene = sphere(16, palette::surface());
  const Camera camera = around_unit_sphere({1, -1, -1});
  const Image image = render(scene, camera, on_white(60));
  for (const double scale : {-1.0, 0x1p-600, 0x1p-1030, 0x1p+1000}) {
    PictureScene scaled = scene;
    for (ShadedTriangle& t : scaled.triangles)
      for (Vector3& n : t.normal) n = scale * n;
    const Image other = render(scaled, camera, on_white(60));
    int worst = 0;
    for (std::size_t i = 0; i < image.rgb.size(); ++i)
      worst = std::max(worst, std::abs(image.rgb[i] - other.rgb[i]));
    EXPECT_LE(worst, 1) << scale;
  }
}

TEST(render, makes_pictures_of_any_shape) {
  PictureScene scene;
  scene.materials = {palette::flat(red)};
  add_square(scene, 500, 0, 0);
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 300}, {300, 1}, {7, 3}}) {
    RenderOptions options = on_white(1, 2);
    options.width = width;
    options.height = height;
    options.parallel_for = two_threads();
    const Image image = render(scene, ahead(), options);
    EXPECT_EQ(image.width, width);
    EXPECT_EQ(image.height, height);
    EXPECT_EQ(image.rgb.size(), std::size_t{3} * width * height);
    EXPECT_EQ(count(image, red_pixel), width * height);
  }
}

TEST(render, refuses_a_camera_whose_axes_are_not_perpendicular) {
  Camera skewed = ahead();
  skewed.up = {0.6, 0.8, 0};
  skewed.forward = {0, 0, -0.8};
  EXPECT_THROW((void)render({}, skewed, on_white(2)), InputError);
}

TEST(camera, frame_takes_directions_of_any_length) {
  const Box3 box{{0, 0, 0}, {1, 2, 3}};
  const Camera one = frame(box, {1, 1, -4}, {0, 1, 0}, 1);
  for (const double scale : {0x1p-1060, 0x1p-600, 0x1p+600, 0x1p+1020}) {
    const Camera other = frame(box, scale * Vector3{1, 1, -4}, scale * Vector3{0, 1, 0}, 1);
    EXPECT_LT(distance(other.eye, one.eye), 1e-12) << scale;
    EXPECT_LT(length(other.up - one.up), 1e-14) << scale;
  }
}

TEST(polyhedron, may_be_tiny_in_a_plane_far_from_the_origin) {
  constexpr double tiny = 1e-300;
  const auto at = [](double x, double z) { return Box3{{x, 1, z}, {x, 1, z}}; };
  const Polyhedron solid = hull_of_boxes({{at(0, 0), at(tiny, 0), at(0, tiny)}});
  EXPECT_EQ(solid.facets.size(), 2u);
  ASSERT_EQ(solid.points.size(), 3u);
  for (const Point3& p : solid.points) EXPECT_EQ(p.y, 1);
}

}  // namespace
}  // namespace snug::extremes_test
