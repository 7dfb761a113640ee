#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <apps/snug/common.h>
#include <apps/snug/places.h>
#include <apps/snug/progress_bar.h>
#include <apps/snug/words.h>
#include <fmt/core.h>
#include <snug/distance.h>
#include <snug/independence/mesh_kernel.h>
#include <snug/mesh.h>
#include <snug/search/surface_data.h>
#include <snug/surface/evaluate.h>
#include <snug/surface/unscale.h>
#include <support/atomic_file.h>
#include <support/read_file.h>

#include "commands.h"
#include "kernel_json.h"
#include "least_squares.h"
#include "limit_weights.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::string mesh, points;
  unsigned rounds = 5;
  double smooth = 0;
  bool least_change = false;
};

// Points, and the places on the surface that are to come near them: given, or the closest ones.
struct Samples {
  std::vector<Point3> points;
  std::vector<Place> at;
  bool given = false;
  bool reached = true;  // are closest ones as near as they get, or did the budget end some?
};

// Lines "x y z", or all "x y z face u v".
Samples read_samples(const std::string& path, const Surface& surface) {
  const std::string text = read_file(path, stopped_by_interrupts());
  const std::string with_place = "x y z " + place_words(surface.traits());
  Samples samples;
  for_each_line(text, [&](std::string_view line, std::size_t number) {
    const std::string where = path + ":" + std::to_string(number) + ": ";
    Point3 p;
    if (!parse(next_word(line), p.x) || !parse(next_word(line), p.y) || !parse(next_word(line), p.z) ||
        !is_finite(p)) {
      throw InputError(InputProblem::unreadable,
                       where + "a line is 'x y z' or '" + with_place + "', x, y and z finite numbers");
    }
    std::string_view rest = line;
    const bool given = !next_word(rest).empty();
    if (samples.points.empty()) samples.given = given;
    if (given != samples.given) {
      throw InputError(InputProblem::unreadable, where + "give all points a place on the surface, or none");
    }
    samples.points.push_back(p);
    if (given) samples.at.push_back(read_place(line, surface, where, with_place));
  });
  if (samples.points.empty())
    throw InputError(InputProblem::unreadable, path + ": there are no points; give lines 'x y z'");
  return samples;
}

struct Residual {
  double rms = 0, max = 0;
};

Residual residual_of(const LimitSurface& surface, const Samples& samples, int threads) {
  Residual result;
  std::vector<double> distances;
  const std::vector<SurfacePoint> reached = evaluate(surface, samples.at, threads);
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const Vector3 gap = samples.points[i] - reached[i].point;
    distances.push_back(std::hypot(gap.x, gap.y, gap.z));
    result.max = std::max(result.max, distances.back());
  }
  if (result.max == 0) return result;
  double sum = 0;
  for (const double d : distances) sum += (d / result.max) * (d / result.max);  // nothing overflows
  result.rms = result.max * std::sqrt(sum / static_cast<double>(distances.size()));
  return result;
}

// The place of each point that is closest to it.
void assign(const LimitSurface& surface, Samples& samples, const Options& options,
            const WorkMonitor& monitor) {
  samples.reached = true;
  Precision wanted;
  wanted.absolute = 1e-6 * surface.size();
  const Run run = run_of(options, monitor);
  const Surface model(surface.mesh(),
                      {.scheme = surface.options().scheme, .boundary = surface.options().boundary}, run);
  samples.at.clear();
  for (const ClosestPoint& found : closest_point(model, samples.points, wanted, run)) {
    samples.at.push_back(*found.at);
    samples.reached &= found.outcome == Outcome::complete;
  }
}

// Of displacements: each one's difference from the mean of its neighbours; alone where there are none.
Stencils umbrellas(const LimitSurface& surface) {
  const Sharpness none;
  const RuledMesh mesh{surface.topology(), surface.options(), none};
  Stencils rows;
  Star star;
  for (std::size_t v = 0; v < surface.topology().vertex_count(); ++v) {
    rows.add(static_cast<std::uint32_t>(v), 1.0);
    if (!surface.topology().isolated(VertexId(v))) {
      gather_star(mesh, VertexId(v), star);
      const double share = -1 / static_cast<double>(star.spokes.size());
      for (const Spoke& spoke : star.spokes) rows.add(spoke.end.value(), share);
    }
    rows.end_row();
  }
  return rows;
}

// "0, 1, 2 and 5 more"
template <class Ids, class NumberOf>
std::string first_ones(const Ids& ids, const NumberOf& number_of) {
  constexpr std::size_t most = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, ids.size()); ++i) {
    text += (i ? ", " : "") + std::to_string(number_of(ids[i]));
  }
  return ids.size() > most ? text + fmt::format(" and {} more", ids.size() - most) : text;
}

[[noreturn]] void refuse_singular(const std::string& why) {
  throw InputError(InputProblem::refused,
                   "the points do not determine the control points: " + why +
                       "; give --smooth WEIGHT, or --least-change to keep the others in place");
}

// Says where a system is singular, by what the mesh is and by what the points miss.
void require_regular(const LeastSquares& system, std::size_t unknowns, std::size_t rank,
                     const std::optional<MeshKernel>& kernel, const LimitSurface& surface,
                     const Options& options) {
  if (options.least_change || (options.smooth > 0 && rank == unknowns)) return;
  if (options.smooth == 0) {
    for (const KernelVector& vector : kernel ? kernel->vectors : std::vector<KernelVector>{}) {
      if (vector.vertices.size() == 1) continue;  // has no sample
      refuse_singular(
          fmt::format("with {} the surface stays where it is if control points {} move by 1 and "
                      "-1 in turn, neighbours against each other",
                      name_of(surface.options().scheme),
                      first_ones(vector.vertices, [](VertexId v) { return v.index(); })));
    }
    const std::vector<std::size_t> unseen = system.unseen();
    if (!unseen.empty()) {
      refuse_singular(fmt::format("{} of {} have no point on the surface near them: {}", unseen.size(),
                                  unknowns, first_ones(unseen, [](std::size_t v) { return v; })));
    }
  }
  if (rank < unknowns) {
    refuse_singular(fmt::format("numerical rank {} of {}", rank, unknowns));
  }
}

// A mesh whose limit surface is near the points, and what is known of it.
struct Fit {
  LimitSurface surface;
  Samples samples;
  Residual residual;
  unsigned rounds = 0;
  std::size_t rank = 0;
};

// The control points for these places.
Fit fitted(const Fit& before, const std::optional<MeshKernel>& kernel, const Options& options,
           const WorkMonitor& monitor) {
  const LimitSurface& surface = before.surface;
  const std::size_t unknowns = surface.mesh().vertex_count();
  const Samples& samples = before.samples;
  const LeastSquares system(unknowns, limit_weights(surface, samples.at, monitor),
                            options.smooth > 0 ? umbrellas(surface) : Stencils(), options.smooth);
  const std::size_t rank = system.rank();
  require_regular(system, unknowns, rank, kernel, surface, options);
  std::vector<Vector3> gaps;
  const std::vector<SurfacePoint> reached = evaluate(surface, samples.at, options.threads);
  for (std::size_t i = 0; i < reached.size(); ++i) gaps.push_back(samples.points[i] - reached[i].point);
  const std::vector<Vector3> moves = system.solve(gaps);
  ControlMesh mesh = surface.mesh();
  for (std::size_t v = 0; v < unknowns; ++v) {
    mesh.points[v] = require_representable(mesh.points[v] + moves[v]);
  }
  return {LimitSurface(std::move(mesh), surface.options(), surface.shared_library(), monitor),
          samples,
          {},
          before.rounds + 1,
          rank};
}

Fit fit(LimitSurface surface, Samples samples, const std::optional<MeshKernel>& kernel,
        const Options& options, const WorkMonitor& monitor) {
  const auto place = [&](Fit& of) {
    if (!samples.given) assign(of.surface, of.samples, options, monitor);
    of.residual = residual_of(of.surface, of.samples, options.threads);
  };
  Fit best{std::move(surface), samples, {}};
  place(best);
  const unsigned rounds = samples.given ? 1 : options.rounds;
  for (unsigned round = 0; round < rounds; ++round) {
    monitor.report(static_cast<double>(round) / rounds);
    Fit next = fitted(best, kernel, options, monitor);
    place(next);
    best.rank = next.rank;
    const bool better = next.residual.rms < best.residual.rms;
    if (better) best = std::move(next);
    if (!better) break;
  }
  return best;
}

void write_json(JsonWriter& json, const Fit& found, const std::optional<MeshKernel>& kernel) {
  json.field("points", found.samples.points.size()).key("residual").begin_object();
  json.field("rms", found.residual.rms).field("max", found.residual.max).end_object();
  json.field("reached", found.samples.reached).field("rounds", found.rounds).field("rank", found.rank);
  json.field("dimension", found.surface.mesh().vertex_count());
  if (kernel) {
    write_kernel(json, *kernel);
  } else {
    json.key("kernel").null();
  }
}

// Empty where it is not decided.
std::optional<MeshKernel> kernel_of(const LimitSurface& surface, const WorkMonitor& monitor) {
  try {
    return mesh_kernel(surface.mesh(), surface.options(), monitor);
  } catch (const InputError&) {
    return {};
  }
}

ExitStatus run(const Options& options) {
  if (options.output.empty()) throw UsageError("fit: -o FILE is missing; name the mesh to write");
  if (options.mesh == "-" && options.points == "-") {
    throw UsageError(
        "fit: MESH and --points are both -, and there is one standard input; give a file for one");
  }
  if (options.json && options.output == "-")
    throw UsageError("fit: --json and -o - both want standard output");
  const Surface given = read_surface(options.mesh, options, options.scheme);
  LimitSurface surface = given.data()->limit();
  Samples samples = read_samples(options.points, given);
  CommonOptions to_standard_output = options;
  to_standard_output.output.clear();
  Report report("fit", to_standard_output);
  std::optional<MeshKernel> kernel;
  std::optional<Fit> found;
  {
    ProgressBar bar("fitting", options.quiet);
    const WorkMonitor monitor = bar.monitor();
    naming(options.mesh, [&] {
      kernel = kernel_of(surface, monitor);
      found.emplace(fit(std::move(surface), std::move(samples), kernel, options, monitor));
    });
  }
  AtomicFile file(options.output);
  const ControlMesh& mesh = found->surface.mesh();
  write_mesh(mesh, file, options.output, options);
  report.heads({options.mesh}, {name_of(found->surface.options().scheme)});
  if (report.json()) write_json(report.write(), *found, kernel);
  if (options.output != "-") {
    report.text(
        fmt::format("{}: {} control points, {} points, residual {:.6g} rms, {:.6g} at most, {} round{}",
                    options.output, mesh.vertex_count(), found->samples.points.size(), found->residual.rms,
                    found->residual.max, found->rounds, found->rounds == 1 ? "" : "s"));
  }
  if (!found->samples.reached)
    report.text("the budget ended some closest points; give a larger --max-splits");
  return report.finish(found->samples.reached, {&file});
}

}  // namespace

Command fit_command() {
  auto options = std::make_shared<Options>();
  OptionList list;
  list.add(Group::own, "MESH", &options->mesh,
           "Control mesh to begin with (OBJ, OFF, PLY, STL, USD, glTF or 3MF)");
  list.add(Group::own, "--points FILE", &options->points,
           "File with lines 'x y z', or all 'x y z face u v' as in eval; - for standard input")
      .required();
  list.add(Group::own, "--rounds N", &options->rounds,
           "Without places: find the closest ones and solve again, at most N times, as long as the error "
           "falls")
      .between(1, 1000);
  list.add(Group::own, "--smooth WEIGHT", &options->smooth,
           "Weight of the smoothness term: displacement minus the neighbours' mean, squared")
      .between(0, 1e6);
  list.add(Group::own, "--least-change", &options->least_change,
           "Among equally good fits, choose the smallest displacement");
  list.add(Group::effort, "--max-splits N", &options->max_splits,
           "Split at most N pieces for each closest point")
      .formerly("--budget")
      .between(1, std::uint64_t{1} << 40);
  add_common_options(list, *options);
  return {"fit",
          Topic::functions,
          "Fit a limit surface to given points by moving control points, by least squares",
          {"snug-research fit pawn.obj --points scan.txt -o fitted.obj",
           "snug-research fit cube.obj --points scan.txt --smooth 0.01 -o fitted.obj --json"},
          std::move(list),
          [options] { return run(*options); }};
}

}  // namespace snug::command
