#include <support/atomic_file.h>

#include <string>

#include <support/read_file.h>

#include <testing/files.h>

namespace snug::atomic_file_test {
namespace {

using testing::put;
using testing::TemporaryFolder;
using testing::unreadable;

TEST(atomic_file, appears_whole_at_the_commit) {
  const TemporaryFolder folder;
  const std::string path = folder.file("out.bin");
  const std::string part("a\0\xff\r\n", 5);
  std::string expected;
  AtomicFile file(path);
  for (int i = 0; i < 50'000; ++i) {
    file.write(part);
    expected += part;
  }
  file.write(std::string(300'000, 'z'));
  expected.append(300'000, 'z');
  EXPECT_FALSE(std::filesystem::exists(path));
  file.commit();
  EXPECT_EQ(read_file(path), expected);
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(atomic_file, leaves_nothing_behind_when_it_is_dropped) {
  const TemporaryFolder folder;
  put(folder.file("kept"), "old");
  try {
    AtomicFile file(folder.file("kept")), other(folder.file("new"));
    file.write(std::string(200'000, 'x'));
    other.write("x");
    throw Interrupted();
  } catch (const Interrupted&) {
  }
  EXPECT_EQ(read_file(folder.file("kept")), "old");
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(atomic_file, is_not_in_place_before_the_commit_though_complete) {
  const TemporaryFolder folder;
  AtomicFile file(folder.file("out"));
  file.write("all");
  file.complete();
  EXPECT_FALSE(std::filesystem::exists(folder.file("out")));
  file.commit();
  EXPECT_EQ(read_file(folder.file("out")), "all");
  EXPECT_THROW(file.write("more"), InputError);
  EXPECT_THROW(file.commit(), InputError);
}

TEST(atomic_file, bad_targets_are_errors_at_once) {
  const TemporaryFolder folder;
  EXPECT_EQ(unreadable([] { AtomicFile file(""); }), "the name of the file to write is empty");
  EXPECT_EQ(unreadable([&] { AtomicFile file(folder.path()); }),
            folder.path() + ": cannot be written: Is a directory");
  EXPECT_EQ(unreadable([&] { AtomicFile file(folder.file("no/such/out")); }),
            folder.file("no/such/out") + ": cannot be written: No such file or directory");
  EXPECT_EQ(folder.entries(), 0u);
}

}  // namespace
}  // namespace snug::atomic_file_test
