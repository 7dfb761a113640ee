#include <support/atomic_file.h>

#include <csignal>
#include <memory>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <support/read_file.h>

#include <testing/files.h>

// Pipes, devices, links, permissions and limits of POSIX, and signals: on Windows an open file that was removed keeps its name until it is closed.
namespace snug::atomic_file_posix_test {
namespace {

using testing::put;
using testing::TemporaryFolder;
using testing::unreadable;

unsigned permissions(const std::string& path) {
  struct stat status {};
  EXPECT_EQ(::stat(path.c_str(), &status), 0);
  return status.st_mode & 0777u;
}

TEST(atomic_file, a_handler_of_signals_finds_what_is_unfinished) {
  const TemporaryFolder folder;
  std::vector<std::unique_ptr<AtomicFile>> files;
  for (int i = 0; i < 60; ++i) {
    files.push_back(std::make_unique<AtomicFile>(folder.file(std::to_string(i))));
    files.back()->write("x");
    if (i % 3 == 0) files.back()->commit();
    if (i % 3 == 1) files.back().reset();
  }
  EXPECT_EQ(folder.entries(), 40u);
  remove_unfinished_files();
  EXPECT_EQ(folder.entries(), 20u);
  for (int i = 0; i < 60; i += 3) EXPECT_EQ(read_file(folder.file(std::to_string(i))), "x");
}

TEST(atomic_file, a_trial_leaves_everything_as_it_was) {
  const TemporaryFolder folder;
  put(folder.file("kept"), "old");
  require_writable(folder.file("kept"));
  require_writable(folder.file("new"));
  require_writable("-");
  require_writable("/dev/null");
  ASSERT_EQ(::mkfifo(folder.file("pipe").c_str(), 0600), 0);
  require_writable(folder.file("pipe"));  // does not wait for a reader
  EXPECT_EQ(folder.entries(), 2u);
  EXPECT_EQ(read_file(folder.file("kept")), "old");
  EXPECT_NE(unreadable([&] { require_writable(folder.file("no/file")); }).find("No such file"),
            std::string::npos);
  EXPECT_NE(unreadable([&] { require_writable(folder.path()); }).find("Is a directory"), std::string::npos);
}

TEST(atomic_file, replaces_the_bytes_and_keeps_the_permissions) {
  const TemporaryFolder folder;
  const std::string path = folder.file("out");
  put(path, "a longer text than the new one");
  ASSERT_EQ(::chmod(path.c_str(), 0640), 0);
  AtomicFile file(path);
  file.write("new");
  file.commit();
  EXPECT_EQ(read_file(path), "new");
  EXPECT_EQ(permissions(path), 0640u);
}

TEST(atomic_file, gives_a_new_file_the_usual_permissions) {
  const TemporaryFolder folder;
  put(folder.file("usual"), "");
  AtomicFile file(folder.file("out"));
  file.commit();
  EXPECT_EQ(permissions(folder.file("out")), permissions(folder.file("usual")));
}

TEST(atomic_file, keeps_a_symbolic_link) {
  const TemporaryFolder folder;
  put(folder.file("target"), "old");
  std::filesystem::create_symlink("target", folder.file("link"));
  AtomicFile file(folder.file("link"));
  file.write("new");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link")));
  EXPECT_EQ(read_file(folder.file("target")), "new");
}

TEST(atomic_file, writes_to_a_pipe_without_replacing_it) {
  const TemporaryFolder folder;
  const std::string path = folder.file("pipe");
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  const int reader = ::open(path.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  AtomicFile file(path);
  file.write("through");
  file.commit();
  std::string bytes(20, '\0');
  EXPECT_EQ(::read(reader, bytes.data(), bytes.size()), 7);
  EXPECT_EQ(bytes.substr(0, 7), "through");
  ::close(reader);
  EXPECT_TRUE(std::filesystem::is_fifo(path));
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(atomic_file, a_full_device_is_an_error) {
  EXPECT_EQ(unreadable([] {
              AtomicFile file("/dev/full");
              file.write("x");
              file.commit();
            }),
            "/dev/full: cannot be written: No space left on device");
}

TEST(atomic_file, a_failed_write_leaves_the_target_untouched) {
  const TemporaryFolder folder;
  put(folder.file("out"), "old");
  rlimit usual{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &usual), 0);
  const rlimit tight{100'000, usual.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &tight), 0);
  const std::string message = unreadable([&] {
    AtomicFile file(folder.file("out"));
    file.write(std::string(1'000'000, 'x'));
    file.commit();
  });
  ::setrlimit(RLIMIT_FSIZE, &usual);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(message, folder.file("out") + ": cannot be written: File too large");
  EXPECT_EQ(read_file(folder.file("out")), "old");
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(atomic_file, a_write_protected_file_is_not_replaced) {
  if (::geteuid() == 0) GTEST_SKIP() << "the superuser may write everything";
  const TemporaryFolder folder;
  put(folder.file("out"), "old");
  ASSERT_EQ(::chmod(folder.file("out").c_str(), 0444), 0);
  EXPECT_NE(unreadable([&] { AtomicFile file(folder.file("out")); }).find("Permission denied"),
            std::string::npos);
}

}  // namespace
}  // namespace snug::atomic_file_posix_test
