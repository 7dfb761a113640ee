#include <picture/render.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>
#include <thread>

#include <support/error.h>

namespace snug::render_test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr Colour black{0, 0, 0}, white{1, 1, 1}, red{1, 0, 0}, green{0, 1, 0}, blue{0, 0, 1};

// The eye at the origin looks along -z, and the picture is the square |s|, |t| <= 1.
Camera plain_camera() {
  return {.eye = {}, .right = {1, 0, 0}, .up = {0, 1, 0}, .forward = {0, 0, -1}, .tangent = 1};
}

RenderOptions on_black(int size, int samples = 3) {
  RenderOptions options;
  options.width = options.height = size;
  options.samples = samples;
  options.background = {black, black};
  return options;
}

Material unlit(Colour colour, double opacity = 1) {
  return {.colour = colour, .opacity = opacity, .lit = false};
}

void add_triangle(PictureScene& scene, Point3 a, Point3 b, Point3 c, std::uint32_t material = 0) {
  scene.triangles.push_back({{a, b, c}, {}, material});
}

// The square |x|, |y| <= half at depth z before the eye, facing it.
void add_square(PictureScene& scene, double half, double z, std::uint32_t material) {
  add_triangle(scene, {-half, -half, -z}, {half, -half, -z}, {half, half, -z}, material);
  add_triangle(scene, {-half, -half, -z}, {half, half, -z}, {-half, half, -z}, material);
}

// Longitudes and latitudes, smooth normals, the poles on the y axis.
void add_sphere(PictureScene& scene, Point3 centre, double radius, int n, std::uint32_t material) {
  const auto direction = [n](int i, int j) {
    const double u = pi * (i % (2 * n)) / n, v = pi * j / n;
    return Vector3{std::sin(v) * std::cos(u), std::cos(v), std::sin(v) * std::sin(u)};
  };
  for (int i = 0; i < 2 * n; ++i)
    for (int j = 0; j < n; ++j) {
      const Vector3 a = direction(i, j), b = direction(i + 1, j), c = direction(i + 1, j + 1),
                    d = direction(i, j + 1);
      for (const auto& [p, q, r] : {std::array{a, b, c}, std::array{a, c, d}})
        scene.triangles.push_back(
            {{centre + radius * p, centre + radius * q, centre + radius * r}, {p, q, r}, material});
    }
}

std::array<int, 3> pixel(const Image& image, int column, int row) {
  const auto at = (static_cast<std::size_t>(row) * image.width + column) * 3;
  return {image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
}

// The amount of light, in pixels, of a picture of white things on black.
double lit_area(const Image& image) {
  double sum = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) sum += light_from_srgb(image.rgb[i] / 255.0);
  return sum;
}

std::array<int, 3> shown(const Radiance& light) {
  const auto byte = [](double share) { return static_cast<int>(std::lround(255 * srgb_from_light(share))); };
  return {byte(light.red), byte(light.green), byte(light.blue)};
}

// A bit of everything, in an order that the seed decides.
PictureScene mixed_scene(unsigned seed) {
  PictureScene scene;
  scene.materials = {palette::surface(), palette::enclosure(), palette::enclosure(palette::amber),
                     palette::flat()};
  add_sphere(scene, {0.1, 0, -3}, 1, 12, 0);
  add_sphere(scene, {0, 0.2, -3}, 1.3, 5, 1);
  add_sphere(scene, {-0.4, -0.3, -2.7}, 0.9, 6, 2);
  add_square(scene, 0.8, 3.1, 3);
  for (int i = 0; i < 12; ++i) {
    const double t = i * pi / 6;
    scene.lines.push_back(
        {{1.4 * std::cos(t), 1.4 * std::sin(t), -3}, {std::sin(t), 0, -2.5}, 1.0 + i % 4, palette::ink});
  }
  std::mt19937 random(seed);
  std::shuffle(scene.triangles.begin(), scene.triangles.end(), random);
  std::shuffle(scene.lines.begin(), scene.lines.end(), random);
  return scene;
}

TEST(render, fills_exactly_the_projection_of_a_triangle) {
  // One sample a pixel: its middle decides.
  const int size = 64;
  const Point3 a{-1.31, -1.17, -2}, b{1.73, -0.39, -2.5}, c{-0.21, 2.43, -3};
  PictureScene scene{{unlit(white)}, {}, {}};
  add_triangle(scene, a, b, c);
  const Image image = render(scene, plain_camera(), on_black(size, 1));
  const auto left_of = [](Point3 p, Point3 q, double s, double t) {
    const double px = p.x / -p.z, py = p.y / -p.z, qx = q.x / -q.z, qy = q.y / -q.z;
    return (qx - px) * (t - py) - (qy - py) * (s - px) > 0;
  };
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) {
      const double s = 2 * (column + 0.5) / size - 1, t = 1 - 2 * (row + 0.5) / size;
      const bool inside = left_of(a, b, s, t) && left_of(b, c, s, t) && left_of(c, a, s, t);
      EXPECT_EQ(pixel(image, column, row)[0], inside ? 255 : 0) << column << ", " << row;
    }
}

TEST(render, covers_the_analytic_area_of_a_sphere) {
  PictureScene scene{{unlit(white)}, {}, {}};
  add_sphere(scene, {0, 0, -3}, 1.5, 100, 0);
  const int size = 200;
  // The cone of tangents meets the plane z = 1 in a circle of radius r / sqrt(d^2 - r^2).
  const double radius = 1.5 / std::sqrt(9 - 2.25) * size / 2;
  const double area = lit_area(render(scene, plain_camera(), on_black(size)));
  EXPECT_NEAR(area / (pi * radius * radius), 1, 0.005);
}

TEST(render, shows_no_pinholes_in_a_dense_closed_mesh) {
  PictureScene scene{{unlit(white)}, {}, {}};
  add_sphere(scene, {0, 0, -3}, 1.5, 150, 0);
  const int size = 200;
  for (const int samples : {1, 3}) {
    const Image image = render(scene, plain_camera(), on_black(size, samples));
    const double radius = 1.5 / std::sqrt(9 - 2.25) * size / 2 - 2;
    for (int row = 0; row < size; ++row) {
      for (int column = 0; column < size; ++column) {
        if (std::hypot(column + 0.5 - size / 2.0, row + 0.5 - size / 2.0) >= radius) continue;
        ASSERT_EQ(pixel(image, column, row)[0], 255) << column << ", " << row;
      }
    }
  }
}

TEST(render, rays_through_edges_and_vertices_meet_exactly_one_triangle) {
  // All edges of an 8 x 8 grid pass through pixel middles, and its vertices lie on them; half opaque, so that
  // a ray that meets two triangles or none shows.
  PictureScene scene{{unlit(white, 0.5)}, {}, {}};
  const int cells = 8, size = 33;
  const auto at = [](int i, int j) { return Point3{i / 4.0 - 1, j / 4.0 - 1, -33.0 / 32}; };
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j) {
      if ((i + j) % 2 == 0) {
        add_triangle(scene, at(i, j), at(i + 1, j), at(i + 1, j + 1));
        add_triangle(scene, at(i, j + 1), at(i, j), at(i + 1, j + 1));  // both ways round
      } else {
        add_triangle(scene, at(i, j), at(i, j + 1), at(i + 1, j));
        add_triangle(scene, at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
      }
    }
  const Image image = render(scene, plain_camera(), on_black(size, 1));
  const std::array<int, 3> once = shown({0.5, 0.5, 0.5});
  for (int row = 1; row < size - 1; ++row)
    for (int column = 1; column < size - 1; ++column)
      EXPECT_EQ(pixel(image, column, row), once) << column << ", " << row;
}

TEST(render, nearer_surface_wins) {
  for (const bool near_first : {false, true}) {
    PictureScene scene{{unlit(red), unlit(green)}, {}, {}};
    if (near_first) add_square(scene, 0.5, 2, 1);
    add_square(scene, 5, 3, 0);
    if (!near_first) add_square(scene, 0.5, 2, 1);
    const Image image = render(scene, plain_camera(), on_black(40));
    EXPECT_EQ(pixel(image, 20, 20), (std::array{0, 255, 0}));
    EXPECT_EQ(pixel(image, 2, 2), (std::array{255, 0, 0}));
  }
}

TEST(render, what_is_behind_the_eye_is_not_shown) {
  PictureScene scene{{unlit(white)}, {}, {}};
  add_square(scene, 5, -2, 0);
  scene.lines.push_back({{-1, 0, 2}, {1, 0.1, 3}, 4, white});
  EXPECT_EQ(lit_area(render(scene, plain_camera(), on_black(20))), 0);
}

TEST(render, a_triangle_that_passes_the_eye_is_cut_there) {
  // A floor one below the eye, from behind it to the horizon: the lower half of the picture.
  PictureScene scene{{unlit(white)}, {}, {}};
  add_triangle(scene, {-1e4, -1, 10}, {1e4, -1, 10}, {0, -1, -1e6});
  const Image image = render(scene, plain_camera(), on_black(40));
  EXPECT_EQ(pixel(image, 20, 5)[0], 0);
  EXPECT_EQ(pixel(image, 20, 35)[0], 255);
  EXPECT_EQ(pixel(image, 2, 35)[0], 255);
}

TEST(render, transparent_layers_blend_front_to_back) {
  PictureScene scene{{unlit(red, 0.5), unlit(green, 0.25), unlit(blue)}, {}, {}};
  add_square(scene, 9, 4, 2);
  add_square(scene, 9, 2, 0);
  add_square(scene, 9, 3, 1);
  add_square(scene, 9, 5, 0);
  const Image image = render(scene, plain_camera(), on_black(10));
  EXPECT_EQ(pixel(image, 5, 5), shown({0.5, 0.5 * 0.25, 0.5 * 0.75}));
}

TEST(render, a_one_sided_surface_is_seen_from_its_outside_only) {
  PictureScene scene{{unlit(white)}, {}, {}};
  scene.materials[0].two_sided = false;
  add_square(scene, 9, 2, 0);
  EXPECT_EQ(pixel(render(scene, plain_camera(), on_black(10)), 5, 5)[0], 255);
  for (ShadedTriangle& t : scene.triangles) std::swap(t.corner[0], t.corner[1]);
  EXPECT_EQ(pixel(render(scene, plain_camera(), on_black(10)), 5, 5)[0], 0);
}

TEST(render, shades_both_sides_and_both_normals_alike) {
  PictureScene scene{{palette::surface()}, {}, {}};
  add_sphere(scene, {0, 0, -3}, 1.5, 20, 0);
  const Image image = render(scene, plain_camera(), on_black(40));
  PictureScene turned = scene;
  for (ShadedTriangle& t : turned.triangles) {
    std::swap(t.corner[0], t.corner[1]);
    std::swap(t.normal[0], t.normal[1]);
    for (Vector3& n : t.normal) n = -3 * n;
  }
  const Image again = render(turned, plain_camera(), on_black(40));
  int largest = 0;
  for (std::size_t i = 0; i < image.rgb.size(); ++i)
    largest = std::max(largest, std::abs(image.rgb[i] - again.rgb[i]));
  EXPECT_LE(largest, 1);
}

TEST(render, normals_smooth_the_facets) {
  // A coarse sphere: the shades of neighbouring pixels differ less with its normals than without.
  PictureScene scene{{palette::surface()}, {}, {}};
  add_sphere(scene, {0, 0, -3}, 1.5, 8, 0);
  const auto steps = [](const Image& image) {
    int largest = 0;
    for (int column = 30; column < 70; ++column)
      largest = std::max(largest, std::abs(pixel(image, column, 50)[1] - pixel(image, column - 1, 50)[1]));
    return largest;
  };
  const int smooth = steps(render(scene, plain_camera(), on_black(100)));
  for (ShadedTriangle& t : scene.triangles)
    for (Vector3& n : t.normal) n = {};
  EXPECT_LT(3 * smooth, steps(render(scene, plain_camera(), on_black(100))));
}

TEST(render, a_line_is_as_wide_as_asked_near_and_far) {
  for (const double depth : {1.0, 10.0})
    for (const double width : {1.0, 2.5, 6.0}) {
      PictureScene scene;
      scene.lines.push_back(
          {{-0.5 * depth, -0.3 * depth, -depth}, {0.5 * depth, 0.4 * depth, -depth}, width, white});
      const double across = std::hypot(1, 0.7) * 50;  // pixels, of a picture of 100
      const double area = across * width + pi * width * width / 4;
      EXPECT_NEAR(lit_area(render(scene, plain_camera(), on_black(100, 8))) / area, 1, 0.01)
          << depth << ", " << width;
    }
}

TEST(render, a_line_is_hidden_behind_a_surface_and_shown_before_and_in_it) {
  const auto colour_at_centre = [](double line_depth, double opacity) {
    PictureScene scene{{unlit(red, opacity)}, {}, {}};
    add_square(scene, 9, 2, 0);
    scene.lines.push_back({{-1, 0, -line_depth}, {1, 0, -line_depth}, 2, green});
    return pixel(render(scene, plain_camera(), on_black(41)), 20, 20);
  };
  EXPECT_EQ(colour_at_centre(1.5, 1), (std::array{0, 255, 0}));
  EXPECT_EQ(colour_at_centre(2, 1), (std::array{0, 255, 0}));
  EXPECT_EQ(colour_at_centre(4, 1), (std::array{255, 0, 0}));
  EXPECT_EQ(colour_at_centre(4, 0.5), shown({0.5, 0.5, 0}));
}

TEST(render, the_depth_of_a_slanted_line_is_that_of_its_points) {
  // From before the surface to behind it: it disappears where it pierces it, here at the middle of the
  // picture.
  PictureScene scene{{unlit(red)}, {}, {}};
  add_square(scene, 9, 4, 0);
  scene.lines.push_back({{-1, 0, -1}, {1, 0, -7}, 1, green});
  const Image image = render(scene, plain_camera(), on_black(401, 1));
  int last = 0;
  for (int column = 0; column < 401; ++column)
    if (pixel(image, column, 200)[1] > 0) last = column;
  EXPECT_NEAR(last, 200, 2);
}

TEST(render, a_line_through_the_eye_plane_is_cut_there) {
  PictureScene scene;
  scene.lines.push_back({{0, -1, 5}, {0, -1, -1e3}, 3, white});
  const Image image = render(scene, plain_camera(), on_black(41));
  EXPECT_EQ(pixel(image, 20, 38)[0], 255);
  EXPECT_EQ(pixel(image, 20, 5)[0], 0);
}

TEST(render, the_order_of_the_scene_changes_no_byte) {
  const Image image = render(mixed_scene(1), plain_camera(), on_black(60));
  for (const unsigned seed : {2U, 3U, 4U})
    EXPECT_EQ(render(mixed_scene(seed), plain_camera(), on_black(60)), image) << seed;
}

TEST(render, coincident_transparent_layers_blend_the_same_in_either_order) {
  Image images[2];
  for (std::uint32_t first = 0; first < 2; ++first) {
    PictureScene scene{{unlit(red, 0.5), unlit(green, 0.5)}, {}, {}};
    add_square(scene, 9, 2, first);
    add_square(scene, 9, 2, 1 - first);
    images[first] = render(scene, plain_camera(), on_black(10));
  }
  EXPECT_EQ(images[0], images[1]);
}

TEST(render, thread_count_changes_no_byte) {
  const PictureScene scene = mixed_scene(1);
  RenderOptions options = on_black(61);
  const Image image = render(scene, plain_camera(), options);
  for (const std::size_t count : {1, 2, 5, 61}) {
    options.parallel_for = [count](std::size_t n, const std::function<void(std::size_t, std::size_t)>& body) {
      std::vector<std::thread> threads;
      for (std::size_t i = 0; i < count; ++i)
        threads.emplace_back([=, &body] { body(i * n / count, (i + 1) * n / count); });
      for (std::thread& thread : threads) thread.join();
    };
    EXPECT_EQ(render(scene, plain_camera(), options), image) << count;
  }
}

TEST(render, progress_grows_to_one) {
  RenderOptions options = on_black(20);
  std::vector<double> fractions;
  options.progress = [&](double fraction) { fractions.push_back(fraction); };
  (void)render(mixed_scene(1), plain_camera(), options);
  ASSERT_EQ(fractions.size(), 20U);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 1);
}

TEST(render, an_interruption_ends_it_on_the_calling_thread) {
  RenderOptions options = on_black(40);
  int calls = 0;
  options.progress = [&](double) {
    if (++calls == 3) throw Interrupted();
  };
  EXPECT_THROW((void)render(mixed_scene(1), plain_camera(), options), Interrupted);
  EXPECT_EQ(calls, 3);
  // Threads that know nothing of exceptions.
  calls = 0;
  options.parallel_for = [](std::size_t n, const std::function<void(std::size_t, std::size_t)>& body) {
    std::thread other([&] { body(0, n / 2); });
    body(n / 2, n);
    other.join();
  };
  EXPECT_THROW((void)render(mixed_scene(1), plain_camera(), options), Interrupted);
  EXPECT_EQ(calls, 3);
}

TEST(render, an_empty_scene_is_the_background) {
  RenderOptions options;
  options.width = 3;
  options.height = 101;
  options.background = {{0.2, 0.4, 0.6}, {0.8, 0.4, 0.2}};
  const Image image = render({}, plain_camera(), options);
  EXPECT_NEAR(pixel(image, 1, 50)[0], 128, 1);
  EXPECT_EQ(pixel(image, 1, 50)[1], 102);
  EXPECT_LT(pixel(image, 1, 0)[0], 54);
  EXPECT_GT(pixel(image, 1, 100)[0], 201);
}

TEST(render, triangles_without_area_are_not_drawn) {
  PictureScene scene{{palette::surface()}, {}, {}};
  add_triangle(scene, {-1, -1, -2}, {-1, -1, -2}, {1, 1, -2});
  add_triangle(scene, {-1, -1, -2}, {0, 0, -2}, {1, 1, -2});
  add_triangle(scene, {0, 0, -2}, {0, 0, -2}, {0, 0, -2});
  EXPECT_EQ(lit_area(render(scene, plain_camera(), on_black(21))), 0);
}

TEST(render, refuses_numbers_it_cannot_draw) {
  const auto broken = [](const auto& breaking) {
    PictureScene scene = mixed_scene(1);
    Camera camera = plain_camera();
    RenderOptions options = on_black(2);
    breaking(scene, camera, options);
    EXPECT_THROW((void)render(scene, camera, options), InputError);
  };
  broken([](PictureScene& s, Camera&, RenderOptions&) { s.triangles[5].corner[1].y = NAN; });
  broken([](PictureScene& s, Camera&, RenderOptions&) { s.triangles[5].normal[2].z = INFINITY; });
  broken([](PictureScene& s, Camera&, RenderOptions&) { s.triangles[5].material = 4; });
  broken([](PictureScene& s, Camera&, RenderOptions&) { s.lines[0].a.x = -INFINITY; });
  broken([](PictureScene& s, Camera&, RenderOptions&) { s.lines[0].width_in_pixels = 0; });
  broken([](PictureScene& s, Camera&, RenderOptions&) { s.lines[0].colour.red = NAN; });
  broken([](PictureScene& s, Camera&, RenderOptions&) { s.materials[0].opacity = 1.5; });
  broken([](PictureScene& s, Camera&, RenderOptions&) { s.materials[0].gloss = NAN; });
  broken([](PictureScene&, Camera& c, RenderOptions&) { c.eye.x = NAN; });
  broken([](PictureScene&, Camera& c, RenderOptions&) { c.up = {0, 2, 0}; });
  broken([](PictureScene&, Camera& c, RenderOptions&) { c.forward = {0, 0, 1}; });
  broken([](PictureScene&, Camera& c, RenderOptions&) { c.tangent = 0; });
  broken([](PictureScene&, Camera&, RenderOptions& o) { o.width = 0; });
  broken([](PictureScene&, Camera&, RenderOptions& o) { o.samples = 17; });
  broken([](PictureScene&, Camera&, RenderOptions& o) { o.background.foot.blue = 2; });
  broken([](PictureScene&, Camera&, RenderOptions& o) {
    o.parallel_for = [](std::size_t, const std::function<void(std::size_t, std::size_t)>& body) {
      body(0, 1);
    };
  });
}

}  // namespace
}  // namespace snug::render_test
