#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include <apps/snug/progress_bar.h>
#include <experiments/convergence.h>
#include <experiments/curve_rates.h>
#include <experiments/enclosure_thickness.h>
#include <experiments/printed_pair_test.h>
#include <experiments/tightness.h>
#include <fmt/core.h>

#include "commands.h"

namespace snug::command {
namespace {

struct PairTestOptions : CommonOptions {
  std::uint64_t pairs = 20'000, seed = 1;
};

struct RatesOptions : CommonOptions {
  std::string of = name_of(Scheme::loop), at = name_of(NetCentre::interior);
  std::uint64_t nets = RateOptions{}.nets, seed = 1;
  unsigned levels = RateOptions{}.levels;
};

struct RadiiOptions : CommonOptions {
  std::uint64_t nets = TightnessOptions{}.nets, seed = 1;
  int samples = TightnessOptions{}.steps;
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
std::vector<PairRow> measure_pairs(const PairTestOptions& options, const WorkMonitor& monitor) {
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

ExitStatus pair_test(const PairTestOptions& options) {
  Report report("pair-test", options);
  std::vector<PairRow> rows;
  {
    ProgressBar bar("testing pairs", options.quiet);
    rows = measure_pairs(options, bar.monitor());
  }
  if (report.json()) {
    JsonWriter& json = report.write().field("seed", options.seed);
    json.key("rows").begin_array();
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
  return report.finish();
}

const char* layout_of(BoundSource source) {
  return source == BoundSource::characteristic ? "characteristic" : "ngon";
}

void write_source(JsonWriter& json, BoundSource source) {
  const bool rows = source == BoundSource::rows;
  json.field("bounds", rows ? "rows" : "table").key("layout");
  rows ? json.null() : json.value(layout_of(source));
}

std::string text_of(BoundSource source) {
  return source == BoundSource::rows ? "rows" : fmt::format("table, {}", layout_of(source));
}

RateOptions rate_options(const RatesOptions& options) {
  RateOptions wanted;
  wanted.nets = options.nets;
  wanted.levels = options.levels;
  wanted.seed = options.seed;
  wanted.threads = options.threads;
  if (const SchemeRules* rules = rules_named(options.of)) wanted.scheme = rules->scheme;
  if (rules_of(wanted.scheme).local) {
    throw UsageError(
        "rates: " + options.of +
        " has no extraordinary corners: each face has a surface of its own; give another scheme");
  }
  for (const NetCentre centre : all_net_centres) {
    if (options.at == name_of(centre)) wanted.centre = centre;
  }
  if (wanted.centre != NetCentre::interior && options.of == "curve") {
    throw UsageError("rates --at " + options.at + ": curves are measured inside and at their ends always");
  }
  if (wanted.centre != NetCentre::interior && !rules_of(wanted.scheme).primal) {
    throw UsageError(
        "rates --at " + options.at + ": " + options.of +
        " is dual: it has no patches at boundaries and no creases; give --scheme loop or catmark");
  }
  return wanted;
}

// rates --scheme curve.
ExitStatus curve_rates(const RatesOptions& options) {
  Report report("rates", options);
  const RateOptions wanted = rate_options(options);
  std::vector<CurveRateRow> rows;
  {
    ProgressBar bar("splitting polylines", options.quiet);
    rows = measure_curve_rates(wanted, bar.monitor());
  }
  if (report.json()) {
    JsonWriter& json = report.write().field("seed", options.seed);
    json.field("nets", wanted.nets).field("levels", wanted.levels).key("rows").begin_array();
    for (const CurveRateRow& row : rows) {
      json.begin_object().field("degree", static_cast<int>(row.degree)).field("place", name_of(row.place));
      json.field("measure", name_of(row.measure)).key("thickness").begin_array();
      for (const double t : row.thickness) json.value(t);
      json.end_array().key("factor");
      row.factor ? json.value(*row.factor) : json.null();
      json.field("expected", row.expected).end_object();
    }
    json.end_array();
  }
  report.text("thickness of a curve's piece, the factor a level: measured (theory)");
  report.text(fmt::format("{:>6}  {:<6}  {:<8}", "degree", "place", "measure"));
  for (const CurveRateRow& row : rows) {
    report.text(fmt::format("{:>6}  {:<6}  {:<8}  {} ({:.4f})", static_cast<int>(row.degree),
                            name_of(row.place), name_of(row.measure),
                            row.factor ? fmt::format("{:.4f}", *row.factor) : "straight", row.expected));
  }
  return report.finish();
}

// A line for each place and source.
void write_rates(Report& report, const RateOptions& wanted, const std::vector<RateRow>& rows) {
  const bool inside = wanted.centre == NetCentre::interior,
             semi_sharp = wanted.centre == NetCentre::semi_sharp;
  report.text(inside ? "thickness at an extraordinary corner, the factor a level: measured (theory)"
                     : "thickness at a corner, the factor a level: measured (theory); eigenvalues after 1");
  report.text(
      "C sum |d_i| of lemma 12 is so many times the interval thickness, at level 0 and at the last one");
  std::string line = fmt::format("{:>9}  {:<22}",
                                 semi_sharp ? "sharpness"
                                 : inside   ? "valence"
                                            : "faces",
                                 "bounds");
  for (const ThicknessMeasure m : all_thickness_measures) line += fmt::format("  {:<17}", name_of(m));
  report.text(line);
  LargestEigenvalues eigenvalues{};
  for (std::size_t i = 0; i < rows.size();) {
    const NetPlace& place = rows[i].place;
    if (i == 0 || rows[i - 1].place != place) eigenvalues = corner_eigenvalues(wanted.scheme, place);
    line = semi_sharp ? fmt::format("{:>9}", place.sharpness) : fmt::format("{:>9}", place.faces);
    line += fmt::format("  {:<22}", text_of(rows[i].source));
    const std::size_t begin = i;
    for (; i < rows.size() && rows[i].place == place && rows[i].source == rows[begin].source; ++i) {
      line += fmt::format("  {:.4f} ({:.4f})  ", rows[i].factor, rows[i].expected);
    }
    if (i - begin < all_thickness_measures.size()) line += fmt::format("  {:<17}", "no normal");
    for (std::size_t k = begin; k < i; ++k) {
      const LemmaTwelve& lemma = rows[k].lemma;
      if (lemma.bound.empty()) continue;
      line += fmt::format("  C {:.3f}, {:.1f} to {:.1f} times", lemma.gap,
                          lemma.bound.front() / rows[k].thickness.front(),
                          lemma.bound[rows[k].thickness.size() - 1] / rows[k].thickness.back());
    }
    if (!inside) {
      line += fmt::format("  {:.4f} {:.4f} {:.4f}", eigenvalues.subdominant, eigenvalues.second,
                          eigenvalues.next);
    }
    report.text(line);
  }
}

ExitStatus rates(const RatesOptions& options) {
  Report report("rates", options);
  const RateOptions wanted = rate_options(options);
  std::vector<RateRow> rows;
  {
    ProgressBar bar("splitting nets", options.quiet);
    rows = measure_rates(wanted, bar.monitor());
  }
  if (report.json()) {
    JsonWriter& json = report.write().field("seed", options.seed);
    json.field("nets", wanted.nets).field("levels", wanted.levels).key("rows").begin_array();
    LargestEigenvalues eigenvalues{};
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const RateRow& row = rows[i];
      if (i == 0 || rows[i - 1].place != row.place)
        eigenvalues = corner_eigenvalues(wanted.scheme, row.place);
      json.begin_object().field("scheme", name_of(wanted.scheme)).field("at", name_of(row.place.centre));
      json.field("valence", row.place.faces).key("sharpness");
      row.place.centre == NetCentre::semi_sharp ? json.value(row.place.sharpness) : json.null();
      write_source(json, row.source);
      json.field("measure", name_of(row.measure)).key("thickness").begin_array();
      for (const double t : row.thickness) json.value(t);
      json.end_array();
      if (!row.lemma.bound.empty()) {
        json.key("lemma_12").begin_object().field("gap", row.lemma.gap).key("bound").begin_array();
        for (const double bound : row.lemma.bound) json.value(bound);
        json.end_array().end_object();
      }
      json.field("factor", row.factor).field("expected", row.expected);
      json.field("subdominant", eigenvalues.subdominant).field("second", eigenvalues.second);
      json.field("next", eigenvalues.next).end_object();
    }
    json.end_array();
  }
  write_rates(report, wanted, rows);
  return report.finish();
}

ExitStatus tightness(const RadiiOptions& options) {
  Report report("tightness", options);
  TightnessOptions wanted;
  wanted.nets = options.nets;
  wanted.steps = options.samples;
  wanted.seed = options.seed;
  wanted.threads = options.threads;
  std::vector<TightnessRow> rows;
  {
    ProgressBar bar("measuring patches", options.quiet);
    rows = measure_tightness(wanted, bar.monitor());
  }
  if (report.json()) {
    JsonWriter& json = report.write().field("seed", options.seed);
    json.field("nets", wanted.nets).field("samples", wanted.steps).key("rows").begin_array();
    for (const TightnessRow& row : rows) {
      json.begin_object().field("shape", name_of(row.shape)).field("valence", row.valence);
      write_source(json, row.source);
      json.field("patches", row.patches).field("median", row.median).field("high", row.high);
      json.field("most", row.most).field("over_rows", row.over_rows).end_object();
    }
    json.end_array();
  }
  report.text("radius over the least possible for the same base triangle; over that of rows");
  report.text(fmt::format("{:<6} {:>7}  {:<22} {:>7} {:>8} {:>8} {:>8} {:>9}", "nets", "valence", "bounds",
                          "patches", "median", "95 %", "most", "over rows"));
  for (const TightnessRow& row : rows) {
    report.text(fmt::format("{:<6} {:>7}  {:<22} {:>7} {:>8.4f} {:>8.4f} {:>8.4f} {:>9.3f}",
                            name_of(row.shape), row.valence, text_of(row.source), row.patches, row.median,
                            row.high, row.most, row.over_rows));
  }
  return report.finish();
}

ExitStatus prism(const RadiiOptions& options) {
  Report report("prism", options);
  TightnessOptions wanted;
  wanted.nets = options.nets;
  wanted.steps = options.samples;
  wanted.seed = options.seed;
  wanted.threads = options.threads;
  std::vector<PrismRow> rows;
  {
    ProgressBar bar("measuring patches", options.quiet);
    rows = measure_prisms(wanted, bar.monitor());
  }
  if (report.json()) {
    JsonWriter& json = report.write().field("seed", options.seed);
    json.field("nets", wanted.nets).field("samples", wanted.steps).key("rows").begin_array();
    for (const PrismRow& row : rows) {
      json.begin_object().field("shape", name_of(row.shape)).field("valence", row.valence);
      json.field("patches", row.patches).field("left", row.left).field("outside", row.outside);
      json.field("prism", row.thickness.prism).field("offset", row.thickness.offset);
      json.field("interval", row.thickness.interval).field("box", row.thickness.box).end_object();
    }
    json.end_array();
  }
  report.text("patches that leave the prism, and by how much at most; thickness along its normal, medians");
  report.text(fmt::format("{:<6} {:>7} {:>7} {:>6} {:>8}  {:>8} {:>8} {:>8} {:>8}", "nets", "valence",
                          "patches", "leave", "by", "prism", "offset", "interval", "box"));
  for (const PrismRow& row : rows) {
    report.text(fmt::format("{:<6} {:>7} {:>7} {:>6} {:>8.4f}  {:>8.4f} {:>8.4f} {:>8.4f} {:>8.4f}",
                            name_of(row.shape), row.valence, row.patches, row.left, row.outside,
                            row.thickness.prism, row.thickness.offset, row.thickness.interval,
                            row.thickness.box));
  }
  report.finish();
  return ExitStatus::answered;
}

// The options of tightness and prism.
OptionList radii_options(RadiiOptions& options) {
  OptionList list;
  list.add(Group::own, "--nets N", &options.nets, "Nets for each valence and shape").between(1, 100'000);
  list.add(Group::own, "--samples N", &options.samples, "Limit points sampled along an edge, 1 to 1000")
      .between(1, 1000);
  list.add(Group::own, "--seed N", &options.seed, "Random seed");
  add_output_options(list, options);
  return list;
}

}  // namespace

Command prism_command() {
  auto options = std::make_shared<RadiiOptions>();
  return {"prism",
          Topic::comparisons,
          "Kobbelt's bounding prism, which does not contain all patches, beside sets that do",
          {"snug-research prism --nets 10"},
          radii_options(*options),
          [options] { return prism(*options); }};
}

Command pair_test_command() {
  auto options = std::make_shared<PairTestOptions>();
  OptionList list;
  list.add(Group::own, "--pairs N", &options->pairs, "Random pairs in all, over three families")
      .between(1, 1'000'000'000);
  list.add(Group::own, "--seed N", &options->seed, "Random seed");
  add_output_options(list, *options);
  return {"pair-test",
          Topic::tables,
          "How often the dissertation's pair test, as printed, misses a close pair",
          {"snug-research pair-test --pairs 200000"},
          std::move(list),
          [options] { return pair_test(*options); }};
}

Command rates_command() {
  auto options = std::make_shared<RatesOptions>();
  OptionList list;
  list.add(Group::own, "--scheme NAME", &options->of, "Subdivision scheme")
      .one_of({"loop", "catmark", "doo-sabin", "midedge", "curve"});
  list.add(Group::own, "--at PLACE", &options->at,
           "What is at the centre of each control net; all but interior with --scheme loop or catmark only")
      .one_of({"interior", "boundary", "corner", "crease", "dart", "semi-sharp"});
  list.add(Group::own, "--nets N", &options->nets, "Nets for each valence").between(1, 100'000);
  list.add(Group::own, "--levels N", &options->levels, "Splits of each patch, 4 to 40").between(4, 40);
  list.add(Group::own, "--seed N", &options->seed, "Random seed");
  add_output_options(list, *options);
  return {"rates",
          Topic::tables,
          "How fast enclosures shrink at extraordinary vertices, or on curves",
          {"snug-research rates --scheme catmark"},
          std::move(list),
          [options] { return options->of == "curve" ? curve_rates(*options) : rates(*options); }};
}

Command tightness_command() {
  auto options = std::make_shared<RadiiOptions>();
  return {"tightness",
          Topic::tables,
          "Radii divided by the least possible for the same base triangle",
          {"snug-research tightness --json"},
          radii_options(*options),
          [options] { return tightness(*options); }};
}

}  // namespace snug::command
