#include <snug/query/collide.h>

#include <algorithm>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "common.h"
#include "length.h"
#include "progress_bar.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::string mesh_a, mesh_b;
  std::string scheme_a, scheme_b;
  std::string place_a, place_b;
  std::string tolerance, margin = "0";
  bool solid = false;
  bool exit_code = false;
};

void write_answer(JsonWriter& json, const Collision& answer, double tolerance, double margin) {
  json.field("verdict", name_of(answer.verdict)).field("tolerance", tolerance).field("margin", margin);
  json.key("distance").begin_array().value(answer.lower);
  answer.upper ? json.value(*answer.upper) : json.null();
  json.end_array().key("witness");
  if (answer.witness) {
    json.begin_array().value((*answer.witness)[0]).value((*answer.witness)[1]).end_array();
    json.field("witness_error", answer.witness_error);
  } else {
    json.null().key("witness_error").null();
  }
  json.key("stats").begin_object();
  json.field("box_tests", answer.stats.box_tests).field("triangle_tests", answer.stats.triangle_tests);
  json.field("evaluations", answer.stats.evaluations).field("splits", answer.stats.splits).end_object();
}

// The verdict as a sentence for people.
std::string sentence(const Collision& answer, double tolerance, double margin) {
  switch (answer.verdict) {
    case Verdict::separated:
      return fmt::format("separated: proved, the limit surfaces are at least {} apart",
                         text_at_most(answer.lower));
    case Verdict::within:
      return fmt::format("within: two points of the limit surfaces are at most {} apart (asked: {:.6g})",
                         text_at_most(*answer.upper, true), margin + tolerance);
    case Verdict::intersecting:
      return answer.lower > 0 ? "intersecting: proved, one solid holds a part of the other"
                              : "intersecting: proved, the limit surfaces have a point in common";
    case Verdict::undecided:
      break;
  }
  return fmt::format("undecided: the distance lies in [{}, {}]; give a larger --tolerance or --budget",
                     text_at_most(answer.lower), answer.upper ? text_at_most(*answer.upper, true) : "?");
}

ExitStatus status(Verdict verdict, bool exit_code) {
  switch (verdict) {
    case Verdict::separated:
      return ExitStatus::answered;
    case Verdict::within:
      return exit_code ? ExitStatus::within : ExitStatus::answered;
    case Verdict::intersecting:
      return exit_code ? ExitStatus::intersecting : ExitStatus::answered;
    case Verdict::undecided:
      break;
  }
  return exit_code ? ExitStatus::undecided : ExitStatus::not_reached;
}

ExitStatus run(const Options& options) {
  const BoundMethod method = bound_method(options);
  if (method == BoundMethod::control_box)
    throw UsageError("collide: --bounds control-box is not available; give rows or table");
  std::optional<TableLayout> table;
  if (method == BoundMethod::table) table = table_layout(options);
  const Length tolerance_length = parse_length(options.tolerance, "--tolerance", true);
  const Length margin_length = parse_length(options.margin, "--margin", true);
  Placement place_a, place_b;
  if (!options.place_a.empty()) place_a = parse_placement(options.place_a, "--place-a");
  if (!options.place_b.empty()) place_b = parse_placement(options.place_b, "--place-b");
  const auto library = std::make_shared<BoundLibrary>();
  const auto scheme = [&](const std::string& own) { return own.empty() ? options.scheme : own; };
  const Surface a = load_surface(options.mesh_a, options, scheme(options.scheme_a), library);
  const Surface b = load_surface(options.mesh_b, options, scheme(options.scheme_b), library);
  const double size = std::max(a.size(), b.size());
  const double tolerance = tolerance_length.in_mesh_units(size), margin = margin_length.in_mesh_units(size);

  ProgressBar bar("colliding", options.quiet);
  const WorkMonitor monitor = bar.monitor();
  QueryModelOptions model_options;
  model_options.table = table;
  model_options.threads = options.threads;
  CollideOptions wanted;
  wanted.tolerance = tolerance;
  wanted.margin = margin;
  wanted.budget = options.budget;
  wanted.prove_contact = true;
  wanted.solid = options.solid;
  std::optional<QueryModel> model_a, model_b;
  naming(options.mesh_a, [&] { model_a.emplace(a, model_options, monitor); });
  naming(options.mesh_b, [&] { model_b.emplace(b, model_options, monitor); });
  QueryScratch scratch_a(*model_a), scratch_b(*model_b);
  const Collision answer =
      collide({*model_a, scratch_a, place_a}, {*model_b, scratch_b, place_b}, wanted, monitor);

  Report report("collide", options);
  report.heads({options.mesh_a, options.mesh_b}, {name_of(a.options().scheme), name_of(b.options().scheme)});
  if (report.json()) write_answer(report.write(), answer, tolerance, margin);
  report.text(sentence(answer, tolerance, margin));
  report.finish();
  return status(answer.verdict, options.exit_code);
}

}  // namespace

Command add_collide(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("collide", "Do two limit surfaces touch? A verdict that is a proof");
  command->add_option("A", options->mesh_a, "First control mesh (OBJ, OFF, PLY or STL)")->required();
  command->add_option("B", options->mesh_b, "Second control mesh")->required();
  command
      ->add_option("--tolerance", options->tolerance,
                   "Surfaces this near may be called within: mesh units, or percent of the longer mesh (1%)")
      ->required();
  command->add_option("--margin", options->margin, "Distance that must be kept")->capture_default_str();
  command->add_option("--place-a", options->place_a,
                      "Placement of A: twelve numbers, a row-major 3x4 motion");
  command->add_option("--place-b", options->place_b, "Placement of B");
  const auto schemes = CLI::IsMember({"auto", "loop", "catmark", "catmull-clark", "doo-sabin", "midedge"});
  command->add_option("--scheme-a", options->scheme_a, "Scheme of A, before --scheme")->check(schemes);
  command->add_option("--scheme-b", options->scheme_b, "Scheme of B, before --scheme")->check(schemes);
  command->add_flag("--solid", options->solid,
                    "Closed surfaces bound solids: one inside of the other intersects it");
  command->add_flag("--exit-code", options->exit_code,
                    "Status 0 separated, 10 within, 11 intersecting, 12 undecided");
  add_common_options(*command, *options);
  return {command, [options] { return run(*options); }};
}

}  // namespace snug::command
