#include "neighbour.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <filesystem>

#include <snug/base/error.h>

#include "progress_bar.h"

extern char** environ;

namespace snug::command {
namespace {

namespace fs = std::filesystem;

fs::path own_folder() {
  std::error_code ignored;
  return fs::read_symlink("/proc/self/exe", ignored).parent_path();
}

// Until an interrupt, at most.
std::string read_all(int file) {
  std::string text;
  char block[4096];
  for (ssize_t got = 0; !stop_requested.load() && (got = read(file, block, sizeof block)) != 0;) {
    if (got > 0) text.append(block, static_cast<std::size_t>(got));
    if (got < 0 && errno != EINTR) break;
  }
  return text;
}

// The signals that this process does not die of, in the child as usual.
class UsualSignals {
 public:
  UsualSignals() {
    posix_spawnattr_init(&attributes_);
    sigset_t signals;
    sigemptyset(&signals);
    for (const int signal : {SIGPIPE, SIGXFSZ}) sigaddset(&signals, signal);
    posix_spawnattr_setsigdefault(&attributes_, &signals);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGDEF);
  }
  ~UsualSignals() { posix_spawnattr_destroy(&attributes_); }
  UsualSignals(const UsualSignals&) = delete;
  UsualSignals& operator=(const UsualSignals&) = delete;
  [[nodiscard]] const posix_spawnattr_t* get() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_;
};

}  // namespace

std::optional<std::string> output_of_neighbour(const std::string& program,
                                               const std::vector<std::string>& arguments) {
  const fs::path folder = own_folder();
  std::error_code ignored;
  if (folder.empty() || !fs::exists(folder / program, ignored)) return {};
  std::vector<std::string> words{(folder / program).string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);

  int ends[2];
  if (pipe(ends) != 0) throw InputError(InputProblem::unreadable, program + ": no pipe");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_addclose(&actions, ends[0]);
  posix_spawn_file_actions_addclose(&actions, ends[1]);
  pid_t child = 0;
  const UsualSignals signals;
  const int failed = posix_spawn(&child, words[0].c_str(), &actions, signals.get(), pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  std::string text;
  if (failed == 0) text = read_all(ends[0]);
  close(ends[0]);
  if (failed == 0 && stop_requested.load()) kill(child, SIGTERM);
  int status = 0;
  const bool ended = failed == 0 && waitpid(child, &status, 0) == child;
  if (stop_requested.load()) throw Interrupted();
  if (!ended || !WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw InputError(InputProblem::unreadable, words[0] + " failed; take it away to do without its columns");
  }
  return text;
}

std::optional<std::string> file_around(const std::string& name) {
  std::error_code ignored;
  if (fs::is_regular_file(name, ignored)) return name;
  for (fs::path folder = own_folder(); folder.has_relative_path(); folder = folder.parent_path()) {
    if (fs::is_regular_file(folder / name, ignored)) return (folder / name).string();
  }
  return {};
}

}  // namespace snug::command
