#include <picture/lettering.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <picture/render.h>

namespace snug::lettering_test {
namespace {

using Places = std::vector<std::array<double, 4>>;

Places places_of(char c) {
  Places places;
  for (const LetterStroke& s : lettering(std::string(1, c))) {
    places.push_back({s.from[0], s.from[1], s.to[0], s.to[1]});
  }
  return places;
}

TEST(lettering, tells_signs_apart_and_stays_in_its_line) {
  std::set<Places> seen;
  for (const char c : std::string("ABCDEFGHIJKLMNOPQRSTUVWXYZ123456789.,:-+=%/()<>'_ ")) {
    EXPECT_TRUE(seen.insert(places_of(c)).second) << c;
    for (const auto& place : places_of(c)) {
      for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_GE(place[k], 0) << c;
        EXPECT_LE(place[k], k % 2 == 0 ? 4.01 / 6 : 1) << c;
      }
    }
  }
  EXPECT_EQ(places_of('q'), places_of('Q'));
  EXPECT_EQ(places_of('#'), places_of('?'));  // a box
  EXPECT_EQ(places_of('#').size(), 4u);
}

TEST(lettering, sets_one_letter_after_the_other) {
  const std::vector<LetterStroke> two = lettering("LL");
  ASSERT_EQ(two.size(), 4u);
  EXPECT_NEAR(two[2].from[0] - two[0].from[0], 1, 1e-12);
  EXPECT_NEAR(lettering_width("LL"), 1 + 4.0 / 6, 1e-12);
  EXPECT_EQ(lettering_width(""), 0);
}

TEST(lettering, is_in_front_of_everything) {
  PictureScene scene{{{.colour = {0, 0, 0}, .lit = false}}, {}, {}};
  scene.triangles.push_back({{{-9, -9, -1}, {9, -9, -1}, {0, 18, -1}}, {}, 0});
  scene.labels.push_back({"I", 30, {1, 0, 0}});
  RenderOptions options;
  options.width = options.height = 100;
  const Camera camera{.eye = {}, .right = {1, 0, 0}, .up = {0, 1, 0}, .forward = {0, 0, -1}, .tangent = 1};
  const Image image = render(scene, camera, options);
  // The stem, 30 pixels from the left and up, in the middle of the letter.
  const std::size_t stem = 3 * (55 * 100 + 40);
  EXPECT_GT(image.rgb[stem], 200);
  EXPECT_LT(image.rgb[stem + 1], 60);
  EXPECT_EQ(image.rgb[3 * (20 * 100 + 80)], 0);  // the triangle
}

TEST(colour_bar, shows_its_colours_along_the_lower_border_and_its_words_above) {
  PictureScene scene;
  scene.bar = {[](double share) { return Colour{share, 0, 1 - share}; }, "NAME", "0", "1", 10, {0, 0, 0}};
  RenderOptions options;
  options.width = options.height = 200;
  const Camera camera{.eye = {}, .right = {1, 0, 0}, .up = {0, 1, 0}, .forward = {0, 0, -1}, .tangent = 1};
  const Image image = render(scene, camera, options);
  const auto pixel = [&](int column, int row) { return image.rgb.data() + 3 * (row * 200 + column); };
  // The bar runs from 10 to 190, and is 6 pixels high.
  for (const int column : {12, 60, 100, 140, 188}) {
    const std::uint8_t* here = pixel(column, 190);
    EXPECT_NEAR(here[0], 255 * (column + 0.5 - 10) / 180, 3) << column;
    EXPECT_EQ(here[1], 0);
    EXPECT_NEAR(here[2], 255 * (1 - (column + 0.5 - 10) / 180), 3) << column;
  }
  EXPECT_GT(pixel(4, 190)[1], 200);
  // Ink at both ends and in the middle of the line of words.
  for (const auto& [from, to] : {std::pair(8, 20), {80, 120}, {180, 192}}) {
    int darkest = 255;
    for (int row = 170; row < 184; ++row)
      for (int column = from; column < to; ++column) darkest = std::min<int>(darkest, *pixel(column, row));
    EXPECT_LT(darkest, 100) << from;
  }
}

}  // namespace
}  // namespace snug::lettering_test
