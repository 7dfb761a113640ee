#include "placed_pair.h"

#include <fmt/core.h>

#include "length.h"

namespace snug::command {

void add_pair_options(OptionList& list, PairOptions& options, bool many) {
  list.add(Group::own, "A", &options.mesh_a, "First control mesh (OBJ, OFF, PLY, STL, USD, glTF or 3MF)");
  list.add(Group::own, "B", &options.mesh_b, "Second control mesh");
  if (many) {
    list.at("A").unless("--scene");
    list.at("B").unless("--scene");
    list.add(
        Group::own, "--scene FILE", &options.scene,
        "Query the parts that a JSON file names and places, instead of A and B; under mpirun, on all ranks");
    list.add(Group::own, "--resume JOURNAL", &options.journal,
             "Save finished answers for a scene to this file, and continue from those already in it")
        .needs("--scene");
    list.add(Group::own, "--rank-timeout SECONDS", &options.rank_timeout,
             "Under mpirun, give up once a rank has been silent for this long; 0 waits forever")
        .needs("--scene")
        .between(0, 1e6);
  }
  add_pose_options(list, "-a", "A", options.pose_a);
  add_pose_options(list, "-b", "B", options.pose_b);
  add_nearest_rigid_option(list, options.nearest_rigid);
  if (many) {
    list.add(Group::placement, "--poses FILE", &options.poses,
             "Answer many poses, one per line: a pose of B, or JSON with a, b or both; - for standard input")
        .excludes("--scene");
  }
  add_common_options(list, options);
  add_bound_options(list, options);
  add_scheme_option(list, "--scheme-a", options.scheme_a, "Scheme of A; overrides --scheme");
  add_scheme_option(list, "--scheme-b", options.scheme_b, "Scheme of B; overrides --scheme");
  list.add(Group::mesh, "--scale-a FACTOR", &options.scale_a,
           "Multiply coordinates of A by this; overrides --scale")
      .between(1e-100, 1e100);
  list.add(Group::mesh, "--scale-b FACTOR", &options.scale_b,
           "Multiply coordinates of B by this; overrides --scale")
      .between(1e-100, 1e100);
  if (!many) return;
  for (const char* name : {"--place", "--rotate", "--move", "--scheme", "--scale"}) {
    for (const char* side : {"-a", "-b"}) list.at(name + std::string(side)).excludes("--scene");
  }
}

ExitStatus status_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::separated:
      return ExitStatus::answered;
    case Verdict::within:
      return ExitStatus::within;
    case Verdict::intersecting:
      return ExitStatus::intersecting;
    case Verdict::undecided:
      break;
  }
  return ExitStatus::undecided;
}

void write_poses(JsonWriter& json, const PosePair& poses) {
  for (const auto& [key, motion] : {std::pair{"place_a", &poses.a}, {"place_b", &poses.b}}) {
    json.key(key).begin_array();
    for (const double number : motion->numbers()) json.value(number);
    json.end_array();
  }
}

PairArguments::PairArguments(const PairOptions& options) : options_(options) {
  const bool unplaced = options.pose_a.place.empty() && options.pose_b.place.empty() && options.poses.empty();
  if (options.nearest_rigid && unplaced && !options.moves) {
    throw UsageError("--nearest-rigid needs --place-a, --place-b or --poses");
  }
  if (options.scheme != "auto" && !options.scheme_a.empty() && !options.scheme_b.empty()) {
    throw UsageError("--scheme has no effect beside --scheme-a and --scheme-b");
  }
  const Mending mending{options.nearest_rigid, notes_for(options)};
  const Motion pose_a = pose_of(options.pose_a, "-a", mending),
               pose_b = pose_of(options.pose_b, "-b", mending);
  const auto load = [&](const std::string& mesh, const std::string& own, double scale, const char* option) {
    CommonOptions reading = options;
    if (scale > 0) reading.scale = scale;
    try {
      return read_surface(mesh, reading, own.empty() ? options.scheme : own);
    } catch (const InputError& error) {
      if (error.problem() != InputProblem::refused || options.scheme == "auto" || !own.empty()) throw;
      throw InputError(error.problem(),
                       fmt::format("{}; {} names the scheme of this mesh alone", error.what(), option));
    }
  };
  a_.emplace(load(options.mesh_a, options.scheme_a, options.scale_a, "--scheme-a"), pose_a);
  b_.emplace(load(options.mesh_b, options.scheme_b, options.scale_b, "--scheme-b"), pose_b);
  const std::array surfaces{a_->surface(), b_->surface()};
  const std::array names{options.mesh_a, options.mesh_b};
  units_ = common_units(surfaces, names);
}

void PairArguments::prepare(const WorkMonitor& monitor) const {
  naming(options_.mesh_a, [&] { a().surface().prepare({.monitor = &monitor}); });
  naming(options_.mesh_b, [&] { b().surface().prepare({.monitor = &monitor}); });
}

void PairArguments::require_closed() const {
  naming(options_.mesh_a, [&] { command::require_closed(a().surface()); });
  naming(options_.mesh_b, [&] { command::require_closed(b().surface()); });
}

void PairArguments::write_heads(Report& report) const {
  report.heads({options_.mesh_a, options_.mesh_b},
               {name_of(a().surface().scheme()), name_of(b().surface().scheme())});
}

}  // namespace snug::command
