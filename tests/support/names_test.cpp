#include <support/names.h>

#include <gtest/gtest.h>

namespace snug::names_test {
namespace {

enum class Colour { red, green, grey };
constexpr auto colour_names = std::to_array<Named<Colour>>(
    {{"red", Colour::red}, {"green", Colour::green}, {"grey", Colour::grey}, {"gray", Colour::grey}});

TEST(names, lead_to_enumerators_and_back) {
  for (const Named<Colour>& each : colour_names) EXPECT_EQ(value_in(colour_names, each.name), each.value);
  EXPECT_STREQ(name_in(colour_names, Colour::green), "green");
}

TEST(names, a_second_name_is_read_and_not_written) {
  EXPECT_EQ(value_in(colour_names, "gray"), Colour::grey);
  EXPECT_STREQ(name_in(colour_names, Colour::grey), "grey");
}

TEST(names, what_is_not_in_the_table_has_none) {
  EXPECT_FALSE(value_in(colour_names, "blue"));
  EXPECT_FALSE(value_in(colour_names, ""));
  EXPECT_STREQ(name_in(colour_names, static_cast<Colour>(7)), "");
}

TEST(names, are_listed_as_a_sentence_has_them) {
  EXPECT_EQ(listed(all_names(colour_names), "or"), "red, green, grey or gray");
  EXPECT_EQ(listed({"red", "green"}, "and"), "red and green");
  EXPECT_EQ(listed({"red"}, "and"), "red");
  EXPECT_EQ(listed({}, "and"), "");
}

}  // namespace
}  // namespace snug::names_test
