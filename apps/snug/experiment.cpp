#include <snug/query/printed_pair_test.h>

#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "common.h"
#include "progress_bar.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::string name;
  std::uint64_t pairs = 20'000;
  std::uint64_t seed = 1;
};

// How often each test called a pair separated that must not be.
struct PairRow {
  const char* family;
  std::uint64_t pairs = 0, called_separated = 0, rule_a_false = 0;
  [[nodiscard]] double share() const {
    return pairs == 0 ? 0.0 : static_cast<double>(called_separated) / static_cast<double>(pairs);
  }
};

// The families' rows, then their sum.
std::vector<PairRow> measure_pairs(const Options& options, const WorkMonitor& monitor) {
  std::mt19937_64 random(options.seed);
  std::vector<PairRow> rows;
  PairRow sum{"all"};
  const std::uint64_t stride = 100 + options.pairs / 1000;
  for (std::uint64_t f = 0; f < all_pair_families.size(); ++f) {
    PairRow row{name_of(all_pair_families[f])};
    // Families share the pairs evenly; the last ones get what is left over.
    row.pairs = (options.pairs + f) / all_pair_families.size();
    for (std::uint64_t i = 0; i < row.pairs; ++i) {
      if (i % stride == 0) {
        monitor.report(static_cast<double>(sum.pairs + i) / static_cast<double>(options.pairs));
      }
      const NearPair pair = near_pair(all_pair_families[f], random);
      row.called_separated += printed_test_says_separated(pair.a, pair.b, pair.epsilon);
      row.rule_a_false += certainly_separated(pair.a, pair.b, pair.epsilon);
    }
    sum.pairs += row.pairs;
    sum.called_separated += row.called_separated;
    sum.rule_a_false += row.rule_a_false;
    rows.push_back(row);
  }
  rows.push_back(sum);
  return rows;
}

ExitStatus pair_test(const Options& options) {
  if (!options.output.empty() && options.output != "-" && !options.output.ends_with(".json")) {
    throw UsageError("experiment: '" + options.output +
                     "' does not end in .json; the rows are written as JSON");
  }
  Report report("experiment", options);
  std::vector<PairRow> rows;
  {
    ProgressBar bar("testing pairs", options.quiet);
    rows = measure_pairs(options, bar.monitor());
  }
  if (report.json()) {
    JsonWriter& json = report.write();
    for (const char* none : {"mesh", "scheme"}) json.key(none).begin_array().end_array();
    json.field("name", options.name).field("seed", options.seed).key("rows").begin_array();
    for (const PairRow& row : rows) {
      json.begin_object().field("family", row.family).field("pairs", row.pairs);
      json.field("called_separated", row.called_separated).field("share", row.share());
      json.field("rule_a_false", row.rule_a_false).end_object();
    }
    json.end_array();
  }
  report.text(fmt::format("{:<16} {:>9} {:>17} {:>7} {:>17}", "family", "pairs", "called separated", "share",
                          "rule (a) false"));
  for (const PairRow& row : rows) {
    report.text(fmt::format("{:<16} {:>9} {:>17} {:>6.1f}% {:>17}", row.family, row.pairs,
                            row.called_separated, 100 * row.share(), row.rule_a_false));
  }
  report.text(
      fmt::format("no pair here may be called separated: the pair test as printed calls {:.1f}% of them so, "
                  "snug's rule (a) {}",
                  100 * rows.back().share(),
                  rows.back().rule_a_false == 0 ? "none" : fmt::format("{}", rows.back().rule_a_false)));
  report.finish();
  return ExitStatus::answered;
}

}  // namespace

Command add_experiment(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("experiment", "A table of the dissertation, measured here");
  command
      ->add_option("NAME", options->name, "pair-test: how often the pair test as printed misses a near pair")
      ->required()
      ->check(CLI::IsMember({"pair-test"}));
  command->add_option("--pairs", options->pairs, "Random pairs in all, over three families")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1'000'000'000}))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "Seed of the random pairs")->capture_default_str();
  add_common_options(*command, *options);
  return {command, [options] { return pair_test(*options); }};
}

}  // namespace snug::command
