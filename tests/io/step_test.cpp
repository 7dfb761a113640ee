// STEP as text: numbers, strings, and a structure in which every reference is to an entity that stands before it.

#include <snug/brep.h>
#include <snug/io/step_text.h>
#include <support/number.h>

#include <gtest/gtest.h>

#include <random>
#include <regex>
#include <set>
#include <string>

namespace snug::step_test {
namespace {

TEST(step, reals_have_a_point_and_are_read_back) {
  std::mt19937_64 random(1);
  const std::regex real("[+-]?[0-9]+\\.[0-9]*(E[+-]?[0-9]+)?");
  std::vector<double> values{0, -0.0, 1, 1e300, 5e-324, -1e-7, 0.1, 123456789};
  for (int k = 0; k < 200; ++k)
    values.push_back(std::ldexp(static_cast<double>(random()), static_cast<int>(random() % 200) - 150));
  for (const double x : values) {
    std::string text;
    append_step_real(text, x);
    EXPECT_TRUE(std::regex_match(text, real)) << text;
    EXPECT_EQ(parse_real(text).value, x) << text;
  }
}

TEST(step, strings_are_ascii) {
  EXPECT_EQ(step_string("part"), "'part'");
  EXPECT_EQ(step_string("it's \\"), "'it''s \\\\'");
  EXPECT_EQ(step_string("m\xC3\xBC"), "'m\\X2\\00FC\\X0\\'");
  EXPECT_EQ(step_string("\xF0\x9F\x98\x80"), "'\\X4\\0001F600\\X0\\'");
  EXPECT_EQ(step_string("\xff\n"), "'\\X2\\00FF\\X0\\\\X2\\000A\\X0\\'");
  // Beyond the last code point.
  EXPECT_EQ(step_string("\xF7\x81\x81\x81"),
            "'\\X2\\00F7\\X0\\\\X2\\0081\\X0\\\\X2\\0081\\X0\\\\X2\\0081\\X0\\'");
}

Brep square() {
  Brep brep;
  brep.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  for (std::uint32_t k = 0; k < 4; ++k)
    brep.edges.push_back(
        {{k, (k + 1) % 4}, {1, {0, 0, 1, 1}, {brep.vertices[k], brep.vertices[(k + 1) % 4]}}});
  const SplineSurface surface{1,
                              {0, 0, 1, 1},
                              {0, 0, 1, 1},
                              {brep.vertices[0], brep.vertices[1], brep.vertices[3], brep.vertices[2]}};
  brep.faces.push_back({surface, {{0, false}, {1, false}, {2, false}, {3, false}}, 0, 0});
  brep.shells.push_back({0, 1, false, {}});
  return brep;
}

void expect_well_formed(const std::string& text) {
  EXPECT_TRUE(text.starts_with("ISO-10303-21;\nHEADER;\n"));
  EXPECT_TRUE(text.ends_with("ENDSEC;\nEND-ISO-10303-21;\n"));
  std::set<std::string> known;
  const std::regex entity("(#[0-9]+)=(.*);"), reference("#[0-9]+");
  std::size_t begin = text.find("DATA;\n") + 6, count = 0;
  for (std::size_t end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const std::string line = text.substr(begin, end - begin);
    std::smatch match;
    if (!std::regex_match(line, match, entity)) {
      EXPECT_EQ(line, "ENDSEC;");
      break;
    }
    const std::string body = match[2];
    for (auto r = std::sregex_iterator(body.begin(), body.end(), reference); r != std::sregex_iterator(); ++r)
      EXPECT_TRUE(known.contains(r->str())) << line;
    EXPECT_EQ(std::count(body.begin(), body.end(), '('), std::count(body.begin(), body.end(), ')')) << line;
    EXPECT_TRUE(known.insert(match[1]).second);
    ++count;
  }
  EXPECT_GT(count, 40u);
}

TEST(step, entities_stand_before_what_names_them) {
  for (const LengthUnit unit :
       {LengthUnit::millimetre, LengthUnit::centimetre, LengthUnit::metre, LengthUnit::inch}) {
    for (const bool old : {false, true}) {
      const std::string text = format_step(square(), {"a part", unit, old});
      expect_well_formed(text);
      EXPECT_EQ(text.find("AUTOMOTIVE_DESIGN") != std::string::npos, old);
      EXPECT_EQ(text.find("'INCH'") != std::string::npos, unit == LengthUnit::inch);
      EXPECT_NE(text.find("SHELL_BASED_SURFACE_MODEL"), std::string::npos);
    }
  }
}

TEST(step, refuses_numbers_that_are_not_finite) {
  Brep brep = square();
  brep.vertices[0].x = INFINITY;
  EXPECT_THROW(static_cast<void>(format_step(brep)), InputError);
}

}  // namespace
}  // namespace snug::step_test
