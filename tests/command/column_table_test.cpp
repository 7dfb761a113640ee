#include <apps/snug/column_table.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

#include <testing/files.h>

namespace snug::column_table_test {
namespace {

using Type = ColumnTable::Type;

ColumnTable filled(const std::string& path) {
  ColumnTable table({{"x", Type::real}, {"face", Type::integer}, {"reached", Type::flag}}, path);
  for (const double value : {0.1, 7.0, 1.0, std::numeric_limits<double>::quiet_NaN(), 4294967295.0, 0.0}) {
    table.add(value);
  }
  return table;
}

TEST(column_table, csv_has_names_and_shortest_decimals) {
  EXPECT_EQ(filled("a.CSV").file(), "x,face,reached\n0.1,7,1\nnan,4294967295,0\n");
  EXPECT_EQ(filled("a.csv").rows(), 2u);
}

TEST(column_table, ply_names_its_properties) {
  const std::string file = filled("a.ply").file();
  const std::string head =
      "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty double x\nproperty uint face\n"
      "property uchar reached\nend_header\n";
  EXPECT_EQ(file.substr(0, head.size()), head);
  EXPECT_EQ(file.size(), head.size() + 2 * 13);
}

TEST(column_table, numbers_begin_at_multiples_of_64_whatever_the_names) {
  for (std::size_t length = 1; length <= 128; ++length) {
    const std::string head = ColumnTable({{std::string(length, 'a'), Type::real}}, "a.npy").file();
    EXPECT_EQ(head.size() % 64, 0u) << length;
    const std::string end = "'fortran_order': False, 'shape': (0,), }";
    const std::size_t at = head.find(end);
    ASSERT_NE(at, std::string::npos) << length;
    EXPECT_EQ(head.find_first_not_of(' ', at + end.size()), head.size() - 1);
    EXPECT_EQ(head.back(), '\n');
  }
}

TEST(column_table, numpy_loads_the_same_numbers) {
  const testing::TemporaryFolder folder;
  for (const char* path : {"a.npy", "empty.npy"}) {
    ColumnTable table = path[0] == 'a' ? filled(path) : ColumnTable({{"x", Type::real}}, path);
    testing::put(folder.file(path), table.file());
  }
  const std::string script =
      "import numpy as n; a = n.load('" + folder.file("a.npy") +
      "', mmap_mode='r'); "
      "assert a.dtype.names == ('x', 'face', 'reached') and a.shape == (2,); "
      "assert a['x'][0] == 0.1 and n.isnan(a['x'][1]) and list(a['face']) == [7, 4294967295]; "
      "assert list(a['reached']) == [1, 0] and a.offset % 64 == 0; "
      "assert n.load('" +
      (folder.file("empty.npy")) + "').shape == (0,)";
  if (std::system("/usr/bin/python3 -c 'import numpy' 2> /dev/null") != 0) GTEST_SKIP() << "no numpy";
  EXPECT_EQ(std::system(("/usr/bin/python3 -c \"" + script + "\"").c_str()), 0);
}

TEST(column_table, knows_its_endings) {
  for (const char* path : {"a.npy", "b.PLY", "c.csv"}) EXPECT_TRUE(ColumnTable::is_table(path)) << path;
  for (const char* path : {"a.json", "npy", "-", "a.npz"}) EXPECT_FALSE(ColumnTable::is_table(path)) << path;
}

}  // namespace
}  // namespace snug::column_table_test
