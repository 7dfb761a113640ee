#include <support/text_cursor.h>

#include <string>
#include <vector>

#include <testing/files.h>

namespace snug::text_cursor_test {
namespace {

using testing::unreadable;
using Lines = std::vector<std::vector<std::string>>;

Lines lines_of(std::string_view text) {
  TextCursor cursor(text, "text");
  Lines lines;
  while (cursor.next_line()) {
    lines.emplace_back();
    for (std::string_view word = cursor.word(); !word.empty(); word = cursor.word())
      lines.back().emplace_back(word);
  }
  return lines;
}

TEST(text_cursor, lines_end_in_three_ways) {
  const Lines expected{{"a", "b"}, {}, {"c"}};
  for (const char* text : {"a b\n\nc\n", "a b\r\n\r\nc\r\n", "a b\r\rc\r", "a b\n\nc", "\ta  b \n\v\n\fc"}) {
    EXPECT_EQ(lines_of(text), expected);
  }
  EXPECT_EQ(lines_of(""), Lines{});
}

TEST(text_cursor, backslash_continues_a_line) {
  const Lines expected{{"a", "b", "c"}, {"d"}};
  EXPECT_EQ(lines_of("a \\\nb \\\r\nc\nd"), expected);
  EXPECT_EQ(lines_of("a\\\rb\\\nc\nd"), expected);
  EXPECT_EQ(lines_of("a b \\"), (Lines{{"a", "b", "\\"}}));
}

TEST(text_cursor, comments_last_to_the_end_of_the_line) {
  EXPECT_EQ(lines_of("# x \\\na # y\n1.#INF"), (Lines{{}, {"a"}, {"1.#INF"}}));
}

TEST(text_cursor, knows_the_line_of_the_last_word) {
  TextCursor cursor("a \\\n\\\nb\r\n\r\n\rc", "text");
  ASSERT_TRUE(cursor.next_line());
  cursor.word();
  EXPECT_EQ(cursor.line(), 1u);
  cursor.word();
  EXPECT_EQ(cursor.line(), 3u);
  EXPECT_EQ(cursor.word_across_lines(), "c");
  EXPECT_EQ(cursor.line(), 6u);
  EXPECT_EQ(unreadable([&] { cursor.fail("bad"); }), "text:6: bad");
}

TEST(text_cursor, looking_ahead_does_not_move) {
  TextCursor cursor("a # b\n\n c\n", "text");
  ASSERT_TRUE(cursor.next_line());
  EXPECT_EQ(cursor.count_lines_with_words(), 2u);
  EXPECT_TRUE(cursor.more_in_line());
  EXPECT_EQ(cursor.word(), "a");
  EXPECT_FALSE(cursor.more_in_line());
  EXPECT_EQ(cursor.word_across_lines(), "c");
}

TEST(text_cursor, quoted_words_are_short_and_printable) {
  EXPECT_EQ(in_quotes("abc"), "'abc'");
  EXPECT_EQ(in_quotes("a\x01\xff"), "'a\\x01\\xff'");
  EXPECT_EQ(in_quotes(std::string(100, 'x')), "'" + std::string(40, 'x') + "...'");
}

}  // namespace
}  // namespace snug::text_cursor_test
