#include <snug/ray.h>

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/core.h>
#include <support/read_file.h>
#include "number_rows.h"

#include "answer_writer.h"
#include "certificate_file.h"
#include "common.h"
#include "length.h"
#include "placed_pair.h"
#include "progress_bar.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::string mesh, rays;
  std::string precision = "0.0001%";
  bool any = false, all = false;
};

// Rows "ox oy oz dx dy dz", and for a segment "from to".
std::vector<Ray> read_rays(const std::string& path) {
  std::vector<Ray> rays;
  for_each_row(
      read_file(path, stopped_by_interrupts()), path, {6, 8},
      "a line is 'ox oy oz dx dy dz', or with 'from to' after it: finite numbers, a direction that is "
      "not 0 0 0, and from <= to",
      [&](std::span<const double> row) {
        Ray ray;
        for (std::size_t k = 0; k < 3; ++k) {
          ray.origin[k] = row[k];
          ray.direction[k] = row[3 + k];
        }
        if (row.size() == 8) {
          ray.from = row[6];
          ray.to = row[7];
        }
        rays.push_back(ray);
        return is_finite(ray.origin) && is_finite(ray.direction) && !(ray.direction == Vector3{}) &&
               std::isfinite(ray.from) && ray.from <= ray.to;
      });
  return rays;
}

std::string line_of(std::size_t ray, const Surface& surface, const RayHit& hit) {
  const std::string corner = surface.traits().triangular ? "" : fmt::format(" {}", hit.at->corner);
  return fmt::format("{}  {} {}  {}  {} {} {}  {} {} {}{}", ray, hit.t.lower, hit.t.upper,
                     hit.certified ? "certified" : "uncertified", hit.point.x, hit.point.y, hit.point.z,
                     hit.at->owner, hit.at->u, hit.at->v, corner);
}

void write_answer(Report& report, const Surface& surface, std::size_t ray, const RayHits& answer) {
  if (report.json()) {
    const PlacedSurface placed(surface);
    write_value(report.write(), answer, {&placed, 1});
    return;
  }
  for (const RayHit& hit : answer.hits) report.text(line_of(ray, surface, hit));
  if (answer.certain_miss()) report.text(fmt::format("{}  no hit", ray));
  if (answer.outcome == Outcome::at_rounding) {
    report.text(fmt::format("{}  not within --absolute: rounding or a glancing ray leaves more", ray));
  }
  if (answer.outcome == Outcome::budget_spent) {
    report.text(fmt::format("{}  the budget ended: there may be more; give a larger --max-splits", ray));
  }
}

// Nothing about the ray is left open.
bool decided(const RayHits& answer) {
  if (answer.outcome != Outcome::complete) return false;
  for (const RayHit& hit : answer.hits) {
    if (!hit.certified) return false;
  }
  return true;
}

ExitStatus run(const Options& options) {
  const Length precision = parse_length(options.precision, "--absolute", true);
  const std::vector<Ray> rays = read_rays(options.rays);
  const Surface surface = read_surface(options.mesh, options, options.scheme);
  RayOptions wanted;
  wanted.query = options.all ? RayQuery::all : options.any ? RayQuery::any : RayQuery::nearest;
  wanted.absolute = precision.in_mesh_units(surface.size(), units_of(surface));
  std::vector<RayHits> answers;
  CertificateFile certificate(options);
  {
    ProgressBar bar("rays", options.quiet);
    const WorkMonitor monitor = bar.monitor();
    const Run run = certificate.with(run_of(options, monitor));
    naming(options.mesh, [&] { answers = ray(surface, rays, wanted, run); });
  }
  Report report("ray", options);
  report.heads({options.mesh}, {name_of(surface.scheme())});
  if (report.json()) report.write().field("absolute", *wanted.absolute).key("results").begin_array();
  report.text(fmt::format("# ray  t: lower upper  proof  x y z  {} u v{}", surface.traits().owner(),
                          surface.traits().triangular ? "" : " corner"));
  bool all_decided = true;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    write_answer(report, surface, i, answers[i]);
    all_decided = all_decided && decided(answers[i]);
  }
  if (report.json()) report.write().end_array();
  std::vector<AtomicFile*> files;
  certificate.add_to(report, files);
  return report.finish(all_decided, files);
}

}  // namespace

Command ray_command() {
  auto options = std::make_shared<Options>();
  options->max_splits = default_splits::ray;
  OptionList list;
  list.add(Group::own, "MESH", &options->mesh, mesh_help);
  list.add(Group::own, "--rays FILE", &options->rays,
           "File with one ray per line, 'ox oy oz dx dy dz', followed by 'from to' for a segment; text, CSV "
           "or a NumPy array (.npy); - for standard input")
      .required();
  list.add(Group::own, "--all", &options->all, "All hits, not only the nearest one");
  list.add(Group::own, "--any", &options->any,
           "Any hit, not necessarily the nearest, to test whether the ray is blocked")
      .excludes("--all");
  list.add(Group::own, "--absolute LENGTH", &options->precision,
           "Target width of the interval of a hit; mesh units, or percent of the mesh")
      .formerly("--precision");
  add_certificate_option(list, *options);
  add_common_options(list, *options);
  add_bound_options(list, *options);
  return {"ray",
          Topic::one_surface,
          "Find where rays hit a limit surface",
          {"snug ray bust.obj --rays rays.txt --all", "echo \"0 0 9 0 0 -1\" | snug ray bust.obj --rays -"},
          std::move(list),
          [options] { return run(*options); }};
}

}  // namespace snug::command
