#pragma once

#include <functional>
#include <string>
#include <vector>

#include <testing/files.h>

#ifdef SNUG_SANITIZED
// Sanitizers take terabytes of addresses, and their own place before the C library.
#define SNUG_SKIP_UNDER_SANITIZERS() GTEST_SKIP() << "not under a sanitizer"
#else
#define SNUG_SKIP_UNDER_SANITIZERS() static_cast<void>(0)
#endif

namespace snug::testing {

struct Outcome {
  int status = -1;  ///< exit status; 1000 + signal if a signal ended it
  std::string out, err;
};

/// Runs the command with these arguments, standard input empty or `input`, and waits for it.
[[nodiscard]] Outcome run_snug(const std::vector<std::string>& arguments, const std::string& input = "");

/// The same of snug-research.
[[nodiscard]] Outcome run_research(const std::vector<std::string>& arguments, const std::string& input = "");

/// Differences from a usual start of the command.
struct Surroundings {
  /// Called in the new process once its standard files are in place, before the command begins.
  std::function<void()> before;
  /// Called with the number of the process while it runs.
  std::function<void(int)> meanwhile;
};
[[nodiscard]] Outcome run_snug_in(const Surroundings& surroundings,
                                  const std::vector<std::string>& arguments);

/// Starts the command, sends it SIGINT after `milliseconds`, and waits.
[[nodiscard]] Outcome interrupt_snug(const std::vector<std::string>& arguments, int milliseconds);

/// Path of an example model.
[[nodiscard]] std::string model(const std::string& name);

}  // namespace snug::testing
