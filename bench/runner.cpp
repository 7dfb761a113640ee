#include "runner.h"

#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <utility>

#include <experiments/quantile.h>

#include "calibration.h"

namespace snug::bench {
namespace {

struct Duration {
  double wall, processor;
};

Duration duration_of(const std::function<double()>& work, double& checksum) {
  const double processor = processor_seconds();
  const auto start = std::chrono::steady_clock::now();
  checksum = work();
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return {wall, processor_seconds() - processor};
}

// A line of /proc/self/status in KiB, such as "VmHWM:".
double status_kib(const char* key) {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with(key)) return std::atof(line.c_str() + std::strlen(key));
  }
  throw std::runtime_error(std::string("no ") + key + " in /proc/self/status");
}

double rate(double per_second, const char*& prefix) {
  prefix = per_second >= 1e6 ? "M" : per_second >= 1e3 ? "k" : "";
  return per_second >= 1e6 ? per_second / 1e6 : per_second >= 1e3 ? per_second / 1e3 : per_second;
}

}  // namespace

Options start(int argc, char** argv, std::size_t files, const char* usage) {
  Options options;
  bool good = true;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--quick") {
      options.quick = true;
      options.rounds = 2;
    } else if (argument == "--rounds" && i + 1 < argc) {
      options.rounds = std::atoi(argv[++i]);
    } else if (argument.starts_with("-")) {
      good = false;
    } else {
      options.files.push_back(argument);
    }
  }
  if (!good || options.rounds < 1 || (files != any_files && options.files.size() != files)) {
    std::fprintf(stderr, "usage: %s [--quick] [--rounds N]%s\n", argv[0], usage);
    std::exit(2);
  }
  const char* slash = std::strrchr(argv[0], '/');
  std::printf("# %s\n", slash ? slash + 1 : argv[0]);
  const Calibration& best = best_calibration();
  std::printf("# machine at its best: scalar chain %.2f GFLOP/s, vectors %.1f GFLOP/s, memory %.1f GB/s\n",
              best.scalar_gflops, best.vector_gflops, best.memory_gb_per_s);
  std::fflush(stdout);
  return options;
}

double ratio(const Times& slow, const Times& fast) {
  return (slow.median / slow.items) / (fast.median / fast.items);
}

const Times& of_name(const std::vector<Times>& times, std::string_view name) {
  const auto found = std::find_if(times.begin(), times.end(), [&](const Times& t) { return t.name == name; });
  if (found == times.end()) throw std::logic_error("nobody is called " + std::string(name));
  return *found;
}

Group::Group(std::string title, std::string item, const Options& options)
    : title_(std::move(title)), item_(std::move(item)), rounds_(options.rounds) {}

void Group::add(std::string name, double items, std::function<double()> work, std::function<void()> prepare) {
  contestants_.push_back({std::move(name), items, std::move(work), std::move(prepare)});
}

void Group::limit_rounds(int rounds) { rounds_ = std::min(rounds_, rounds); }

std::vector<Times> Group::run() {
  const std::size_t count = contestants_.size();
  std::vector<std::vector<double>> wall(count), processor(count);
  std::vector<double> checksums(count), calibrations;
  for (int round = warm_ ? -1 : 0; round < rounds_; ++round) {
    calibrations.push_back(calibrate().seconds);
    for (std::size_t c = 0; c < count; ++c) {
      if (contestants_[c].prepare) contestants_[c].prepare();
      double checksum = 0;
      const Duration duration = duration_of(contestants_[c].work, checksum);
      const bool first = wall[c].empty() && (round < 0 || !warm_);
      if (!first && checksum != checksums[c] && !(std::isnan(checksum) && std::isnan(checksums[c]))) {
        throw std::logic_error(contestants_[c].name + ": the checksum changes from run to run");
      }
      checksums[c] = checksum;
      if (round < 0) continue;
      wall[c].push_back(duration.wall);
      processor[c].push_back(duration.processor);
    }
  }
  calibrations.push_back(calibrate().seconds);
  const double cal = quantile(calibrations, 0.5) / best_calibration().seconds;

  std::printf("%s (%d rounds)\n", title_.c_str(), rounds_);
  std::vector<Times> results;
  for (std::size_t c = 0; c < count; ++c) {
    Times times{contestants_[c].name,      contestants_[c].items,     quantile(processor[c], 0.5),
                quantile(processor[c], 0), quantile(processor[c], 1), checksums[c],
                quantile(wall[c], 0.5)};
    results.push_back(times);
    const double per_item = 1e6 / times.items;
    const double ratio = (times.median / times.items) / (results.front().median / results.front().items);
    const char* prefix = "";
    const double per_second = rate(times.items / times.median, prefix);
    std::printf("  %-40s  %10.4f us/%s  %7.2f %s/s  x %-8.3g  [%.4f-%.4f, busy %.2f, cal %.2f]  sum %.17g\n",
                times.name.c_str(), times.median * per_item, item_.c_str(), per_second, prefix, ratio,
                times.least * per_item, times.most * per_item, times.median / times.wall, cal,
                times.checksum);
  }
  std::fflush(stdout);
  return results;
}

double peak_mib(const std::function<double()>& work) {
  malloc_trim(0);  // else the child could use memory that the parent has freed but not given back
  std::fflush(stdout);
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("peak_mib: no pipe");
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("peak_mib: no child process");
  if (child == 0) {
    int status = 1;
    try {
      const double before = status_kib("VmRSS:");
      static_cast<void>(work());
      const double kib = status_kib("VmHWM:") - before;
      status = write(ends[1], &kib, sizeof kib) == sizeof kib ? 0 : 1;
    } catch (const std::exception& error) {
      std::fprintf(stderr, "peak_mib: %s\n", error.what());
    }
    _exit(status);
  }
  close(ends[1]);
  double kib = 0;
  const bool complete = read(ends[0], &kib, sizeof kib) == sizeof kib;
  close(ends[0]);
  int status = 0;
  if (waitpid(child, &status, 0) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0 || !complete) {
    throw std::runtime_error("peak_mib: the child failed");
  }
  return kib / 1024;
}

void print_peak(const std::string& name, double items, const char* item, double mib) {
  std::printf("  %-40s  %10.1f MiB at its peak  %8.1f bytes/%s\n", name.c_str(), mib, mib * 0x1p20 / items,
              item);
  std::fflush(stdout);
}

}  // namespace snug::bench
