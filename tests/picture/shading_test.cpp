#include <picture/shading.h>

#include <gtest/gtest.h>

#include <random>

#include <picture/palette.h>

namespace snug::shading_test {
namespace {

Vector3 random_unit(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const Vector3 v{normal(random), normal(random), normal(random)};
  return (1 / length(v)) * v;
}

double largest_step(const Radiance& a, const Radiance& b) {
  return std::max({std::fabs(a.red - b.red), std::fabs(a.green - b.green), std::fabs(a.blue - b.blue)});
}

TEST(shading, light_stays_within_what_a_picture_shows) {
  std::mt19937 random(3);
  for (const double gloss : {0.0, 0.3, 1.0}) {
    const Finish white = finish_of({.colour = {1, 1, 1}, .gloss = gloss});
    for (int trial = 0; trial < 10000; ++trial) {
      const Vector3 to_eye{0, 0, -1};
      Vector3 normal = random_unit(random);
      normal.z = -std::fabs(normal.z);
      const Radiance light = shade(white, normal, to_eye);
      for (const double share : {light.red, light.green, light.blue}) {
        EXPECT_GE(share, 0);
        EXPECT_LE(share, 1);
      }
    }
  }
}

TEST(shading, varies_continuously_with_the_normal) {
  std::mt19937 random(4);
  const Finish finish = finish_of(palette::surface());
  for (int trial = 0; trial < 10000; ++trial) {
    Vector3 normal = random_unit(random);
    normal.z = -std::fabs(normal.z);
    const Vector3 moved = normal + 1e-6 * random_unit(random);
    const Vector3 near = (1 / length(moved)) * moved, to_eye{0, 0, -1};
    EXPECT_LT(largest_step(shade(finish, normal, to_eye), shade(finish, near, to_eye)), 1e-4);
  }
}

TEST(shading, what_faces_the_key_light_is_brighter_than_what_faces_away) {
  const Finish finish = finish_of(palette::surface());
  const double r = std::sqrt(0.5);
  EXPECT_GT(shade(finish, {0, r, -r}, {0, 0, -1}).green, 1.5 * shade(finish, {0, -r, -r}, {0, 0, -1}).green);
}

TEST(shading, an_unlit_material_keeps_its_colour) {
  const Colour colour{0.2, 0.5, 0.7};
  EXPECT_EQ(shade(finish_of(palette::flat(colour)), {0, 1, 0}, {0, 0, -1}), light_of(colour));
}

TEST(shading, srgb_curve_and_its_inverse_agree) {
  for (int i = 0; i <= 255; ++i) EXPECT_NEAR(srgb_from_light(light_from_srgb(i / 255.0)), i / 255.0, 1e-12);
}

}  // namespace
}  // namespace snug::shading_test
