#include "run_snug.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <testing/places.h>
#include <unistd.h>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace snug::testing {
namespace {

// Or another build of it, such as one for another machine with what runs it; see scripts/check_cross.
const char* command() {
  const char* const other = std::getenv("SNUG_TESTED_COMMAND");
  return other != nullptr ? other : SNUG_COMMAND;
}

std::string slurp(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

void redirect(const std::string& path, int flags, int to) {
  const int file = open(path.c_str(), flags, 0600);
  if (file < 0 || dup2(file, to) < 0) _exit(126);
  close(file);
}

Outcome run(const char* program, const std::vector<std::string>& arguments, const std::string& input,
            const Surroundings& surroundings) {
  const TemporaryFolder folder;
  const std::string in = folder.file("in"), out = folder.file("out"), err = folder.file("err");
  std::ofstream(in, std::ios::binary) << input;
  std::vector<char*> argv{const_cast<char*>(program)};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork");
  if (child == 0) {
    redirect(in, O_RDONLY, STDIN_FILENO);
    redirect(out, O_WRONLY | O_CREAT | O_TRUNC, STDOUT_FILENO);
    redirect(err, O_WRONLY | O_CREAT | O_TRUNC, STDERR_FILENO);
    if (surroundings.before) surroundings.before();
    execv(program, argv.data());
    _exit(127);
  }
  if (surroundings.meanwhile) surroundings.meanwhile(child);
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw std::runtime_error("waitpid");
  }
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status), slurp(out), slurp(err)};
}

}  // namespace

Outcome run_snug(const std::vector<std::string>& arguments, const std::string& input) {
  return run(command(), arguments, input, {});
}

#ifdef SNUG_RESEARCH
Outcome run_research(const std::vector<std::string>& arguments, const std::string& input) {
  return run(SNUG_RESEARCH, arguments, input, {});
}
#endif

Outcome run_snug_in(const Surroundings& surroundings, const std::vector<std::string>& arguments) {
  return run(command(), arguments, "", surroundings);
}

Outcome interrupt_snug(const std::vector<std::string>& arguments, int milliseconds) {
  return run(command(), arguments, "", {{}, [milliseconds](int child) {
                                          usleep(static_cast<useconds_t>(milliseconds) * 1000);
                                          kill(child, SIGINT);
                                        }});
}

std::string model(const std::string& name) { return testing::models_dir() + "/" + name; }

}  // namespace snug::testing
