#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

/// Marks what a shared libsnug exports.
#define SNUG_API __attribute__((visibility("default")))

namespace snug {

/// Kinds of problems with an input.
enum class InputProblem {
  unreadable,       ///< a file that cannot be opened, read, written or parsed
  refused,          ///< a mesh that is defective or not supported
  pose,             ///< a transform that is not rigid, mirrors, or is not finite
  value,            ///< a point, tolerance, parameter or option that is not finite or out of its range
  unrepresentable,  ///< a result that does not fit a double
};

/// Bad input. The message is one line that names the file, line, face or vertex, and the next step.
class SNUG_API InputError : public std::runtime_error {
 public:
  InputError(InputProblem problem, const std::string& message)
      : std::runtime_error(message), problem_(problem) {}
  [[nodiscard]] InputProblem problem() const noexcept { return problem_; }

 private:
  InputProblem problem_;
};

/// Thrown at the next checkpoint after a stop was requested, see WorkMonitor.
class SNUG_API Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

/// How long-running work reports progress and is stopped. Both members are optional.
struct WorkMonitor {
  /// Called with the fraction done, in [0, 1], at most a few thousand times, by several threads at once.
  std::function<void(double)> on_progress;
  /// Set from elsewhere, such as a signal handler, to stop the work.
  const std::atomic<bool>* stop = nullptr;

  /// Throws Interrupted if a stop was requested.
  /// Cost:      one load.
  void checkpoint() const {
    if (stop && stop->load(std::memory_order_relaxed)) throw Interrupted();
  }
  void report(double done) const {
    checkpoint();
    if (on_progress) on_progress(done);
  }
};

class Workspace;

/// A proof of an answer as text, which the program snug-check verifies without trusting snug: docs/certificates.md.
struct Certificate {
  std::string text;     ///< empty where nothing of the answer has a proof
  std::string missing;  ///< the rest of "does not prove ..."; empty if it proves all
};

/// How a function is to work: the last argument of all that take long. Only `max_splits` may change an answer.
struct Run {
  int threads = 0;                       ///< 0: all cores
  const WorkMonitor* monitor = nullptr;  ///< progress and interruption of what may throw Interrupted
  Workspace* workspace = nullptr;        ///< for one call at a time; default: that of the calling thread
  /// Budget: most splits of pieces for an answer. Searches that refine something else, such as triangles or pairs of
  /// pieces, count that. Functions name their unit, default and memory under "Budget".
  std::optional<std::uint64_t> max_splits{};
  /// Receives a proof of the answers: a tenth of a second each, some seconds for surfaces that run along each other.
  Certificate* certificate = nullptr;
};

/// Defaults of Run::max_splits, in the unit that each function names under "Budget".
namespace default_splits {
inline constexpr std::uint64_t brep = 10'000'000, ray = 20'000, penetration = 20'000, contacts = 200'000,
                               bound = 1'000'000, closest_point = 1'000'000, collide = 1'000'000,
                               distance = 1'000'000, hull = 1'000'000, envelope = 4'000'000,
                               self_contact = 1'000'000, time_of_contact = 1'000'000, tessellate = 5'000'000,
                               measure = 10'000'000, deviation = 50'000'000;
}  // namespace default_splits

/// How a search ended. Answers hold for every outcome, but hulls; only `complete` ones are as narrow or as fine as
/// requested.
enum class Outcome : std::uint8_t {
  complete,
  budget_spent,  ///< at Run::max_splits; rays also at the memory of a query
  at_rounding,  ///< where a larger budget would not help: at the precision of doubles, at the pieces that a query may
                ///< keep, or where nothing can be proved
};
[[nodiscard]] SNUG_API const char* name_of(Outcome outcome);

/// The points that an answer comes with.
enum class WitnessKind : std::uint8_t {
  none,  ///< none, the quickest; of two surfaces the lower end of a distance is what the search happens to show
  approximate,  ///< near the surfaces: LimitPoint::error says how near
  exact,        ///< on the surfaces, up to rounding
};

/// How narrow an interval must become: upper - lower <= max(absolute, relative * upper). If only one is given the
/// other is 0; if neither is given `absolute` is 0.01 % of the (larger) surface's size.
struct Precision {
  std::optional<double> absolute{};          ///< >= 0, mesh units
  std::optional<double> relative{};          ///< >= 0
  WitnessKind witness = WitnessKind::exact;  ///< `none` is as `approximate`
};

}  // namespace snug
