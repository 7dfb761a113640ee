#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace snug::bench {

/// Options of every program of bench/.
struct Options {
  int rounds = 7;                  ///< --rounds N, at least 1
  bool quick = false;              ///< --quick: small inputs and two rounds, to see that it runs
  std::vector<std::string> files;  ///< all other arguments

  /// The size to use: one for measurements, one for --quick.
  template <class T>
  [[nodiscard]] T size(T full, T small) const {
    return quick ? small : full;
  }
};

/// As a number of files: any.
inline constexpr std::size_t any_files = SIZE_MAX;

/// Reads the arguments and prints the first lines: the program, and how fast the machine is.
/// Errors:    prints usage and ends the process with status 2, also unless `files` file names are given.
[[nodiscard]] Options start(int argc, char** argv, std::size_t files, const char* usage);

/// Processor times of one contestant, in seconds, and the median time on the clock.
struct Times {
  std::string name;
  double items = 0;
  double median = 0, least = 0, most = 0;
  double checksum = 0;
  double wall = 0;
};

/// Time an item of one over another's.
[[nodiscard]] double ratio(const Times& slow, const Times& fast);
/// Errors:    std::logic_error if nobody has the name.
[[nodiscard]] const Times& of_name(const std::vector<Times>& times, std::string_view name);

/// Contestants for the same work, timed in turns so that a slow moment hits all of them.
///
/// A line each, columns separated by two or more blanks:
///
///   name  us an item  items a second  times the baseline  [least-most us, busy share, cal]  checksum
///
/// Times are processor time, all threads together, so that others on the same machine disturb little; busy is
/// that over wall time (below 1 somebody else had the processor; above 1 there are threads); cal is how long
/// calibrate() took around these runs, relative to its best in this process. `times` is the ratio of times an
/// item to the first contestant's: above 1 is slower.
class Group {
 public:
  /// `item`: what one item is called, as in "us/patch".
  Group(std::string title, std::string item, const Options& options);

  /// Adds a contestant; `work` returns a checksum that shows the work was done. `prepare` runs before each
  /// round, not timed.
  void add(std::string name, double items, std::function<double()> work, std::function<void()> prepare = {});

  /// Fewer rounds for works of many seconds; never more than the options ask for.
  void limit_rounds(int rounds);
  /// Work that must be cold each time is not run once before.
  void set_cold() { warm_ = false; }

  /// Runs all and prints a line each.
  /// Errors:    std::logic_error if a contestant's checksum changes between rounds.
  std::vector<Times> run();

 private:
  struct Contestant {
    std::string name;
    double items;
    std::function<double()> work;
    std::function<void()> prepare;
  };
  std::string title_, item_;
  int rounds_;
  bool warm_ = true;
  std::vector<Contestant> contestants_;
};

/// Memory that `work` needed at its peak beyond what the process had before, in MiB.
///
/// Guarantee: `work` runs in a child process of its own, so that nothing it leaves behind counts twice.
/// Requires:  no other thread runs, and `work` starts none that were started before.
/// Errors:    std::runtime_error if the child fails, or where the system does not tell (only Linux does).
[[nodiscard]] double peak_mib(const std::function<double()>& work);

/// Prints a line "name  MiB  bytes an item".
void print_peak(const std::string& name, double items, const char* item, double mib);

}  // namespace snug::bench
