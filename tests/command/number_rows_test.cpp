#include <apps/snug/number_rows.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <support/binary.h>

#include <testing/files.h>

namespace snug::number_rows_test {
namespace {

using testing::unreadable;

using Rows = std::vector<std::vector<double>>;

Rows read(const std::string& bytes, std::initializer_list<std::size_t> widths = {3}) {
  Rows rows;
  for_each_row(bytes, "p", widths, "expected", [&](std::span<const double> row) {
    rows.emplace_back(row.begin(), row.end());
    return std::isfinite(row[0]);
  });
  return rows;
}

std::string refusal(const std::string& bytes, std::initializer_list<std::size_t> widths = {3}) {
  return unreadable([&] { static_cast<void>(read(bytes, widths)); });
}

/// An array as NumPy writes it.
std::string array(const std::string& type, bool fortran, const std::string& shape, const std::string& values,
                  char version = 1) {
  std::string head = "{'descr': '" + type + "', 'fortran_order': " + (fortran ? "True" : "False") +
                     ", 'shape': " + shape + ", }\n";
  std::string bytes = "\x93NUMPY";
  bytes += {version, '\0'};
  if (version == 1) {
    append_binary(bytes, static_cast<std::uint16_t>(head.size()));
  } else {
    append_binary(bytes, static_cast<std::uint32_t>(head.size()));
  }
  return bytes + head + values;
}

template <class Number>
std::string values(const std::vector<Number>& numbers, std::endian order = std::endian::little) {
  std::string bytes;
  for (const Number number : numbers) append_binary(bytes, number, order);
  return bytes;
}

const Rows two{{1, 2, 3}, {4, 5, 6.5}};

TEST(number_rows, text_may_be_separated_in_several_ways) {
  for (const char* text :
       {"1 2 3\n4 5 6.5\n", "1,2,3\n4, 5 ,6.5", "1;2;3\r\n4; 5; 6.5\r\n", "1\t2\t3\n4\t5\t6.5",
        "# a comment\n\n 1 2 3 \n  # another\n4 5 6.5", "x,y,z\n1,2,3\n4,5,6.5",
        "\xEF\xBB\xBF\"x\";\"y\";\"z\"\n1;2;3\n4;5;6.5", "\n# c\nx y z\n+1 2e0 3\n4 5 6.5"}) {
    EXPECT_EQ(read(text), two) << text;
  }
  EXPECT_TRUE(read("").empty());
  EXPECT_EQ(read("1 2 3\n1 2 3 4 5\n", {3, 5}).size(), 2u);
  EXPECT_EQ(read("0.1 1e-400 -1e-400\n")[0][0], 0.1);
}

TEST(number_rows, bad_lines_are_named) {
  EXPECT_EQ(refusal("1 2 3\n1 2\n"), "p:2: expected");
  EXPECT_EQ(refusal("1 2 3\nx y z\n"), "p:2: expected");  // heads stand first
  EXPECT_EQ(refusal("x y z\na b c\n"), "p:2: expected");
  EXPECT_EQ(refusal("x y\n1 2 3\n"), "p:1: expected");
  EXPECT_EQ(refusal("1 y z\n"), "p:1: expected");
  for (const char* text : {"1,,2,3", ",1,2,3", "1,2,3,", "1,2;,3", "1 2 3x", "1 2 3 4", "1,5;2,5;3,5",
                           "0x1 2 3", "nan 2 3", "1e999 2 3", "+-1 2 3", "1 2 \x01"}) {
    EXPECT_EQ(refusal(text), "p:1: expected") << text;
  }
}

TEST(number_rows, arrays_may_be_single_or_double_in_either_order) {
  const std::vector<double> c{1, 2, 3, 4, 5, 6.5}, f{1, 4, 2, 5, 3, 6.5};
  const std::vector<float> single(c.begin(), c.end());
  EXPECT_EQ(read(array("<f8", false, "(2, 3)", values(c))), two);
  EXPECT_EQ(read(array("<f8", true, "(2, 3)", values(f))), two);
  EXPECT_EQ(read(array(">f8", false, "(2, 3)", values(c, std::endian::big))), two);
  EXPECT_EQ(read(array("<f4", false, "(2, 3)", values(single))), two);
  EXPECT_EQ(read(array("<f8", false, "(2, 3)", values(c), 2)), two);
  EXPECT_TRUE(read(array("<f8", false, "(0, 3)", "")).empty());
  EXPECT_EQ(read(array("<f8", false, "(1, 6)", values(c)), {6, 8}), (Rows{c}));
}

TEST(number_rows, other_arrays_are_refused) {
  const std::string shape =
      "p: the NumPy array is not one of float32 or float64 with the shape (n, 3): save it as "
      "a.astype(float)";
  const std::string six = values(std::vector<double>(6));
  for (const char* type : {"<i8", "|u1", "<f2", "<c16", "f8", ""}) {
    EXPECT_EQ(refusal(array(type, false, "(2, 3)", six)), shape) << type;
  }
  for (const char* form : {"(6,)", "(3, 2)", "(2, 3, 1)", "(-2, 3)", "(2, 3", "()", "2, 3"}) {
    EXPECT_EQ(refusal(array("<f8", false, form, six)), shape) << form;
  }
  const std::string good = array("<f8", false, "(2, 3)", six);
  for (std::size_t size = 6; size < good.size(); ++size) {
    EXPECT_EQ(refusal(good.substr(0, size)).substr(0, 17), "p: the NumPy arra") << size;
  }
  EXPECT_EQ(refusal(good + "x"),
            "p: the NumPy array declares 2 rows of 3 numbers, but has 49 bytes: it is truncated");
  EXPECT_EQ(refusal(array("<f8", false, "(9223372036854775807, 3)", six)).substr(0, 25),
            "p: the NumPy array declar");
  const std::vector<double> bad{1, 2, 3, NAN, 5, 6};
  EXPECT_EQ(refusal(array("<f8", false, "(2, 3)", values(bad))), "p: row 1: expected");
}

}  // namespace
}  // namespace snug::number_rows_test
