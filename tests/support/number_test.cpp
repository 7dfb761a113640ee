#include <support/number.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

namespace snug::number_test {
namespace {

constexpr std::string_view none,
    not_a_number = "is not a number", not_finite = "is not a finite number",
    too_large = "is too large for a double",
    decimal_comma = "is not a number: write a decimal point instead of the comma",
    hexadecimal = "is a hexadecimal number: write it in decimal";

using Limits = std::numeric_limits<double>;

void expect_round_trip(double value) {
  std::string text;
  append_real(text, value);
  const ParsedReal parsed = parse_real(text);
  ASSERT_EQ(parsed.fault, none) << text;
  ASSERT_EQ(std::bit_cast<std::uint64_t>(parsed.value), std::bit_cast<std::uint64_t>(value)) << text;
}

std::string_view fault(std::string_view word) { return parse_real(word).fault; }

TEST(number, random_bit_patterns_round_trip) {
  std::mt19937_64 random(20240501);
  for (int i = 0; i < 300'000; ++i) {
    const double value = std::bit_cast<double>(random());
    if (std::isfinite(value)) expect_round_trip(value);
  }
}

TEST(number, subnormals_and_ends_round_trip) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 50'000; ++i) expect_round_trip(std::bit_cast<double>(random() >> (12 + random() % 52)));
  for (const double value :
       {0.0, Limits::denorm_min(), Limits::min(), Limits::max(), Limits::epsilon(), 1.0, 0.1,
        9007199254740993.0, std::nextafter(Limits::min(), 0.0), std::nextafter(1.0, 2.0)}) {
    expect_round_trip(value);
    expect_round_trip(-value);
  }
}

TEST(number, random_decimals_are_read_as_the_nearest_double) {
  std::mt19937_64 random(11);
  for (int i = 0; i < 100'000; ++i) {
    std::string word = random() % 2 ? "-" : "";
    const std::size_t digits = 1 + random() % 30, point = random() % (digits + 1);
    for (std::size_t k = 0; k < digits; ++k) {
      if (k == point) word += '.';
      word += static_cast<char>('0' + random() % 10);
    }
    word += 'e' + std::to_string(static_cast<int>(random() % 700) - 370);
    const double expected = std::strtod(word.c_str(), nullptr);
    const ParsedReal parsed = parse_real(word);
    if (std::isinf(expected)) {
      ASSERT_EQ(parsed.fault, too_large) << word;
    } else {
      ASSERT_EQ(parsed.fault, none) << word;
      ASSERT_EQ(std::bit_cast<std::uint64_t>(parsed.value), std::bit_cast<std::uint64_t>(expected)) << word;
    }
  }
}

TEST(number, halfway_cases_go_to_even) {
  EXPECT_EQ(parse_real("9007199254740993").value, 9007199254740992.0);
  EXPECT_EQ(parse_real("9007199254740995").value, 9007199254740996.0);
  EXPECT_EQ(parse_real("9007199254740993.00000000000000000000000000000001").value, 9007199254740994.0);
  EXPECT_EQ(parse_real("2.4703282292062327e-324").value, 0.0);
  EXPECT_EQ(parse_real("2.4703282292062329e-324").value, Limits::denorm_min());
}

TEST(number, too_small_becomes_a_zero_of_the_same_sign) {
  for (const std::string word : {"1e-400", "0.0000001e-320", "123456789e-400", "1e-99999999999999999999"}) {
    EXPECT_EQ(fault(word), none) << word;
    EXPECT_EQ(std::bit_cast<std::uint64_t>(parse_real(word).value), 0u) << word;
    EXPECT_TRUE(std::signbit(parse_real("-" + word).value)) << word;
  }
}

TEST(number, zeros_with_any_exponent_are_zero) {
  for (const char* word : {"0e400", "0.000e99999999999999999999", "0e-400", "-0"}) {
    EXPECT_EQ(fault(word), none) << word;
    EXPECT_EQ(parse_real(word).value, 0.0) << word;
  }
}

TEST(number, too_large_is_a_fault) {
  for (const char* word : {"1e400", "-1e400", "+1e400", "1.8e308", "0.00001e400", "1e99999999999999999999"}) {
    EXPECT_EQ(fault(word), too_large) << word;
  }
  EXPECT_EQ(fault(std::string(400, '9')), too_large);
  EXPECT_EQ(fault("1.7976931348623157e308"), none);
}

TEST(number, usual_spellings_are_read) {
  EXPECT_EQ(parse_real("+1.5").value, 1.5);
  EXPECT_EQ(parse_real(".5").value, 0.5);
  EXPECT_EQ(parse_real("5.").value, 5.0);
  EXPECT_EQ(parse_real("1E+3").value, 1000.0);
  EXPECT_EQ(parse_real("-00012").value, -12.0);
}

TEST(number, what_is_not_finite_is_named_so) {
  for (const char* word :
       {"nan", "NaN", "-nan", "+nan(0x1)", "inf", "-inf", "INF", "Infinity", "-1.#IND", "1.#QNAN"}) {
    EXPECT_EQ(fault(word), not_finite) << word;
  }
}

TEST(number, other_faults_are_told_apart) {
  EXPECT_EQ(fault("0x1p3"), hexadecimal);
  EXPECT_EQ(fault("-0X1"), hexadecimal);
  EXPECT_EQ(fault("1,5"), decimal_comma);
  EXPECT_EQ(fault("-1,5e3"), decimal_comma);
  for (const char* word :
       {"", "+", "-", ".", "e5", "1e", "1e+", "+-1", "--1", "1.2.3", "1 ", " 1", "1d5", "one", ","}) {
    EXPECT_EQ(fault(word), not_a_number) << word;
  }
}

TEST(number, integers_are_whole_words_and_saturate) {
  EXPECT_EQ(parse_integer("42"), 42);
  EXPECT_EQ(parse_integer("+42"), 42);
  EXPECT_EQ(parse_integer("-7"), -7);
  EXPECT_EQ(parse_integer("99999999999999999999"), std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(parse_integer("-99999999999999999999"), std::numeric_limits<std::int64_t>::min());
  for (const char* word : {"", "+", "-", "+-1", "1.0", "0x10", "1e3", "1 ", "one"}) {
    EXPECT_EQ(parse_integer(word), std::nullopt) << word;
  }
}

TEST(text_at_most, rounds_to_the_side_asked_for_in_six_digits_or_few_more) {
  EXPECT_EQ(text_at_most(0.25), "0.25");
  EXPECT_EQ(text_at_most(0.25, true), "0.25");
  EXPECT_EQ(text_at_most(INFINITY, true), "inf");
  std::mt19937_64 random(17);
  for (int i = 0; i < 100'000; ++i) {
    const double x = std::bit_cast<double>(random());
    if (!std::isfinite(x)) continue;
    for (const bool at_least : {false, true}) {
      const std::string text = text_at_most(x, at_least);
      const double read = parse_real(text).value;
      EXPECT_TRUE(at_least ? read >= x : read <= x) << text;
      EXPECT_LE(std::abs(read / 4 - x / 4), 5e-6 * (std::abs(x) / 4)) << text;
      const double within = 1e-12 * std::abs(x);
      const double near = parse_real(text_at_most(x, at_least, within)).value;
      EXPECT_TRUE((at_least ? near >= x : near <= x) && std::abs(near - x) <= within) << text;
    }
  }
}

}  // namespace
}  // namespace snug::number_test
