#include <snug/hull.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include <snug/query/hull_check.h>
#include <snug/query/one_hull.h>
#include <snug/search/precision.h>
#include <snug/search/surface_data.h>
#include <support/error.h>
#include <support/names.h>
#include <support/number.h>
#include <support/run.h>
#include <support/system_files.h>

namespace snug {
namespace {

constexpr auto fault_names = std::to_array<Named<HullFault>>({
    {"no-position", HullFault::no_position},
    {"meets-surface", HullFault::meets_surface},
    {"meets-itself", HullFault::meets_itself},
    {"meets-other", HullFault::meets_other},
    {"not-around", HullFault::not_around},
    {"too-few-triangles", HullFault::too_few_triangles},
    {"through-itself", HullFault::through_itself},
});

constexpr std::size_t max_problems = 100;
// After which it is asked whether the surface meets itself, if one hull is wanted; of both the first to fail asks at once.
constexpr int rounds_alone = 4;

// One problem of a sort and side for each owner, and not too many.
void keep_some(std::vector<HullProblem>& problems) {
  std::set<std::tuple<HullFault, bool, std::optional<std::uint32_t>>> known;
  std::erase_if(problems,
                [&](const HullProblem& p) { return !known.emplace(p.fault, p.inner, p.owner).second; });
  if (problems.size() > max_problems) problems.resize(max_problems);
}

}  // namespace

const char* name_of(HullFault fault) { return name_in(fault_names, fault); }

Hulls hull(const Surface& handle, const HullOptions& wanted, const Run& run) {
  const LimitSurface& surface = handle.data()->bvh().surface();
  HullOptions options = wanted;
  if (!options.error) options.error = share_of_size(1e-2, surface.size());
  require_value(*options.error > 0 && std::isfinite(*options.error),
                "hull: the error must be finite and greater than 0");
  // Tolerances of triangles go down to a share of it.
  const double least = surface.scale().inverse().apply(options.single_precision ? 0x1p-20 : 0x1p-30);
  if (*options.error < least) {
    throw InputError(InputProblem::value,
                     std::string("hull: ") + (options.single_precision ? "floats" : "doubles") +
                         " allow no error below " + shortest(least) +
                         " for coordinates of this size; ask for that or more" +
                         (options.single_precision ? ", or write a format that holds doubles" : ""));
  }
  if (*options.error > surface.size() / 2) {
    throw InputError(InputProblem::value,
                     "hull: the error is more than half of the surface's size; give at most " +
                         shortest(surface.size() / 2));
  }
  require_value(options.inner || options.outer, "hull: ask for the inner hull, the outer one, or both");
  Hulls result;
  // Two balls that go through each other a little have an inner hull, and no outer one; turned inside out the other way round.
  const int asked_from = options.inner && options.outer ? 0 : rounds_alone;
  OwnContacts contacts(handle, run);
  for (const bool inner : {true, false}) {
    if (!(inner ? options.inner : options.outer)) continue;
    OneHull side = make_hull(surface, options, inner, contacts, asked_from, run);
    result.closed = side.closed;
    (inner ? result.inner : result.outer) = std::move(side.hull);
    result.problems.insert(result.problems.end(), side.problems.begin(), side.problems.end());
    monitor_of(run).report(inner ? 0.3 : 0.6);
    // Nothing is proved of the other one then, and one that fails takes most of the time.
    if (!side.problems.empty()) break;
  }
  system_files::return_free_memory();
  if (result.problems.empty()) result.problems = problems_of(handle, result, options, run);
  const bool too_few =
      std::any_of(result.problems.begin(), result.problems.end(),
                  [](const HullProblem& problem) { return problem.fault == HullFault::too_few_triangles; });
  result.outcome = outcome_of(result.problems.empty(), too_few);
  keep_some(result.problems);
  monitor_of(run).report(1);
  return result;
}

}  // namespace snug
