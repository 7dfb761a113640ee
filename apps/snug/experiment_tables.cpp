#include "experiment_tables.h"

#include <filesystem>
#include <map>
#include <memory>
#include <optional>

#include <experiments/room_tables.h>
#include <experiments/rooms.h>
#include <fmt/core.h>
#include <snug/base/error.h>

#include "neighbour.h"
#include "progress_bar.h"
#include "words.h"

namespace snug::command {
namespace {

// Peers' columns, in the order of our rows: from the program that bench/ builds where the peers are installed.
using PeerRows = std::optional<std::vector<std::map<std::string, double>>>;
constexpr const char* peer_program = "bench_tables";
constexpr unsigned creation_rounds = 5;

struct Model {
  std::string file, name;
  ControlMesh mesh;
};

std::vector<std::string> default_models() {
  std::vector<std::string> files;
  for (const char* name : {"bust", "head", "pawn", "star", "demon", "figure"}) {
    const std::optional<std::string> file = file_around(fmt::format("examples/models/{}.obj", name));
    if (!file) throw UsageError("no folder examples/models here: name the files of the models");
    files.push_back(*file);
  }
  return files;
}

// Loop, edge-and-corner, without tags: what the peers can be given, too.
SchemeOptions rules() { return {Scheme::loop, BoundaryRule::edge_and_corner}; }

std::vector<Model> load_models(const TableExperiment& experiment, const CommonOptions& options) {
  if (options.scheme != "auto" && options.scheme != "loop") {
    throw UsageError("experiment " + experiment.name + " is about Loop surfaces: leave --scheme away");
  }
  std::vector<Model> models;
  for (const std::string& file : experiment.models.empty() ? default_models() : experiment.models) {
    Model model{file, std::filesystem::path(file).stem().string(), load_mesh(file, options)};
    model.mesh.tags = {};
    // Refuses what is no surface, before a size is looked for.
    naming(file,
           [&] { static_cast<void>(LimitSurface(model.mesh, rules(), std::make_shared<BoundsCache>(), 1)); });
    model.mesh = unit_model(std::move(model.mesh));
    models.push_back(std::move(model));
  }
  if (experiment.name == "table-5-3" && models.size() % 2 != 0) {
    throw UsageError("experiment table-5-3: models meet two by two; give an even number of them");
  }
  return models;
}

// Reads lines "NAME NUMBER NAME NUMBER ...".
PeerRows read_peer_rows(const std::string& text) {
  PeerRows rows(std::in_place);
  for_each_line(text, [&](std::string_view line, std::size_t) {
    std::map<std::string, double>& row = rows->emplace_back();
    for (std::string_view name = next_word(line); !name.empty(); name = next_word(line)) {
      parse(next_word(line), row[std::string(name)]);
    }
  });
  return rows;
}

[[noreturn]] void refuse_peers() {
  throw UsageError(
      fmt::format("{} beside this executable is of another version; build it again", peer_program));
}

PeerRows ask_peers(const TableExperiment& experiment, const std::vector<Model>& models,
                   std::size_t expected_rows) {
  std::vector<std::string> arguments{experiment.name, std::to_string(experiment.placements),
                                     std::to_string(experiment.seed)};
  for (const Model& model : models) arguments.push_back(model.file);
  const std::optional<std::string> text = output_of_neighbour(peer_program, arguments);
  if (!text) return {};
  PeerRows rows = read_peer_rows(*text);
  if (rows->size() != expected_rows) refuse_peers();
  return rows;
}

// The number in a peer's row; nothing without peers.
std::optional<double> peer_number(const PeerRows& peers, std::size_t row, const char* key) {
  if (!peers) return {};
  const auto number = peers->at(row).find(key);
  if (number == peers->at(row).end()) refuse_peers();
  return number->second;
}

void write_number(JsonWriter& json, const char* key, const std::optional<double>& number) {
  json.key(key);
  number ? json.value(*number) : json.null();
}
void write_count(JsonWriter& json, const char* key, const std::optional<double>& count) {
  json.key(key);
  count ? json.value(static_cast<std::uint64_t>(*count)) : json.null();
}

std::string text_of(const std::optional<double>& number, const char* format) {
  return number ? fmt::format(fmt::runtime(format), *number) : "-";
}

void begin_table(Report& report, const TableExperiment& experiment, const PeerRows& peers) {
  if (!report.json()) return;
  JsonWriter& json = report.write();
  for (const char* none : {"mesh", "scheme"}) json.key(none).begin_array().end_array();
  json.field("name", experiment.name).field("seed", experiment.seed).field("peers", peers.has_value());
  json.key("rows").begin_array();
}

void end_table(Report& report, const PeerRows& peers) {
  if (report.json()) report.write().end_array();
  if (!peers) {
    report.text(fmt::format(
        "uniform Loop: not measured; bin/{} does that, which is built where OpenSubdiv and FCL are installed",
        peer_program));
  }
  report.finish();
}

// A monitor that shows one step of several.
WorkMonitor part_of(const WorkMonitor& whole, std::size_t step, std::size_t steps) {
  WorkMonitor part = whole;
  if (whole.on_progress) {
    part.on_progress = [&whole, step, steps](double done) {
      whole.on_progress((static_cast<double>(step) + done) / static_cast<double>(steps));
    };
  }
  return part;
}

ExitStatus leaves_table(const TableExperiment& experiment, const CommonOptions& options) {
  Report report("experiment", options);
  const std::vector<Model> models = load_models(experiment, options);
  const std::size_t count = models.size() * table_tolerances.size();
  std::vector<LeafCounts> rows;
  {
    ProgressBar bar("splitting patches", options.quiet);
    const WorkMonitor monitor = bar.monitor();
    const auto library = std::make_shared<BoundsCache>();
    for (const Model& model : models) {
      const LimitSurface surface(model.mesh, rules(), library, options.threads);
      for (const double tolerance : table_tolerances) {
        rows.push_back(count_leaves(surface, tolerance, monitor));
        monitor.report(static_cast<double>(rows.size()) / static_cast<double>(count));
      }
    }
  }
  const PeerRows peers = ask_peers(experiment, models, count);
  begin_table(report, experiment, peers);
  report.text("triangles until each offset triangle's radius is at most half the tolerance");
  report.text(fmt::format("{:<10} {:>6} {:>7} {:>8} {:>8} {:>8} {:>8}", "model", "faces", "within", "rows",
                          "tables", "printed", "uniform"));
  for (std::size_t i = 0; i < count; ++i) {
    const Model& model = models[i / table_tolerances.size()];
    const double tolerance = table_tolerances[i % table_tolerances.size()];
    const std::optional<double> uniform = peer_number(peers, i, "triangles");
    if (report.json()) {
      JsonWriter& json = report.write();
      json.begin_object().field("model", model.name).field("faces", model.mesh.face_count());
      json.field("tolerance", tolerance).field("rows", rows[i].rows).field("tables", rows[i].tables);
      json.field("printed", rows[i].printed);
      write_count(json, "uniform", uniform);
      json.end_object();
    }
    report.text(fmt::format("{:<10} {:>6} {:>5} % {:>8} {:>8} {:>8} {:>8}", model.name,
                            model.mesh.face_count(), 100 * tolerance, rows[i].rows, rows[i].tables,
                            rows[i].printed, text_of(uniform, "{:.0f}")));
  }
  end_table(report, peers);
  return ExitStatus::answered;
}

ExitStatus creation_table(const TableExperiment& experiment, const CommonOptions& options) {
  Report report("experiment", options);
  const std::vector<Model> models = load_models(experiment, options);
  const std::size_t count = models.size() * table_tolerances.size();
  std::vector<CreationTimes> rows;
  {
    ProgressBar bar("making hierarchies", options.quiet);
    const WorkMonitor monitor = bar.monitor();
    for (const Model& model : models) {
      for (const double tolerance : table_tolerances) {
        rows.push_back(measure_creation(model.mesh, rules(), tolerance, creation_rounds, monitor));
        monitor.report(static_cast<double>(rows.size()) / static_cast<double>(count));
      }
    }
  }
  const PeerRows peers = ask_peers(experiment, models, count);
  begin_table(report, experiment, peers);
  report.text("milliseconds from a control mesh in memory until queries can be asked, one thread");
  report.text(fmt::format("{:<10} {:>7} {:>8} {:>8} {:>8} {:>8} {:>12} {:>15}", "model", "within", "ready",
                          "tight", "rows", "printed", "uniform, OBB", "uniform, OBBRSS"));
  for (std::size_t i = 0; i < count; ++i) {
    const std::string& name = models[i / table_tolerances.size()].name;
    const double tolerance = table_tolerances[i % table_tolerances.size()];
    const double ready = 1e3 * rows[i].model, tight = 1e3 * rows[i].tight, hull_rows = 1e3 * rows[i].rows,
                 printed = 1e3 * rows[i].printed;
    const std::optional<double> obb = peer_number(peers, i, "obb_ms"),
                                obbrss = peer_number(peers, i, "obbrss_ms");
    if (report.json()) {
      JsonWriter& json = report.write();
      json.begin_object().field("model", name).field("tolerance", tolerance).field("ready_ms", ready);
      json.field("tight_ms", tight).field("rows_ms", hull_rows).field("printed_ms", printed);
      write_number(json, "uniform_obb_ms", obb);
      write_number(json, "uniform_obbrss_ms", obbrss);
      json.end_object();
    }
    report.text(fmt::format("{:<10} {:>5} % {:>8.2f} {:>8.2f} {:>8.2f} {:>8.2f} {:>12} {:>15}", name,
                            100 * tolerance, ready, tight, hull_rows, printed, text_of(obb, "{:.2f}"),
                            text_of(obbrss, "{:.2f}")));
  }
  end_table(report, peers);
  return ExitStatus::answered;
}

ExitStatus room_table(const TableExperiment& experiment, const CommonOptions& options) {
  Report report("experiment", options);
  const std::vector<Model> models = load_models(experiment, options);
  // Rooms, then pairs, then tolerances.
  struct Cell {
    double side, tolerance;
    std::size_t pair;
  };
  std::vector<Cell> cells;
  for (const double side : room_sides) {
    for (std::size_t pair = 0; pair < models.size() / 2; ++pair) {
      for (const double tolerance : table_tolerances) cells.push_back({side, tolerance, pair});
    }
  }
  std::vector<RoomRow> rows;
  {
    ProgressBar bar("colliding", options.quiet);
    const WorkMonitor monitor = bar.monitor();
    const auto library = std::make_shared<BoundsCache>();
    std::vector<LimitSurface> surfaces;
    for (const Model& model : models) surfaces.emplace_back(model.mesh, rules(), library, options.threads);
    for (const Cell& cell : cells) {
      rows.push_back(measure_room(surfaces[2 * cell.pair], surfaces[2 * cell.pair + 1],
                                  {cell.side, cell.tolerance, experiment.placements, experiment.seed},
                                  part_of(monitor, rows.size(), cells.size())));
    }
  }
  const PeerRows peers = ask_peers(experiment, models, cells.size());
  begin_table(report, experiment, peers);
  report.text(
      "microseconds a query, one thread; hits: placements in which the limit surfaces meet; misses: "
      "placements");
  report.text(
      "certainly within the tolerance that the printed test calls separated, with either epsilon, of all "
      "that are");
  report.text(fmt::format("{:>4} {:<16} {:>7} {:>7} {:>7} {:>8} {:>8} {:>17} {:>13} {:>13}", "room", "models",
                          "within", "hits", "rows", "tables", "printed", "it misses", "uniform, OBB",
                          "uni., OBBRSS"));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto& [side, tolerance, pair] = cells[i];
    const std::string &a = models[2 * pair].name, &b = models[2 * pair + 1].name;
    const RoomRow& row = rows[i];
    const std::optional<double> obb = peer_number(peers, i, "obb_us"),
                                obbrss = peer_number(peers, i, "obbrss_us"),
                                uniform_hits = peer_number(peers, i, "hits");
    if (report.json()) {
      JsonWriter& json = report.write();
      json.begin_object().key("pair").begin_array().value(a).value(b).end_array();
      json.field("room", side).field("tolerance", tolerance).field("placements", experiment.placements);
      json.field("hits", row.hits).field("within", row.within);
      json.field("rows_us", 1e6 * row.rows).field("tables_us", 1e6 * row.tables);
      json.field("printed_us", 1e6 * row.printed).field("printed_missed", row.printed_missed);
      json.field("printed_missed_moeller", row.printed_missed_moeller);
      json.field("printed_missed_hits", row.printed_missed_hits);
      json.field("printed_alarms", row.printed_alarms);
      write_number(json, "uniform_obb_us", obb);
      write_number(json, "uniform_obbrss_us", obbrss);
      write_count(json, "uniform_hits", uniform_hits);
      json.end_object();
    }
    const double share = 100.0 * static_cast<double>(row.hits) / static_cast<double>(experiment.placements);
    report.text(
        fmt::format("{:>4} {:<16} {:>5} % {:>5.1f} % {:>7.2f} {:>8.2f} {:>8.2f} {:>17} {:>13} {:>13}", side,
                    a + "/" + b, 100 * tolerance, share, 1e6 * row.rows, 1e6 * row.tables, 1e6 * row.printed,
                    fmt::format("{}, {} of {}", row.printed_missed, row.printed_missed_moeller, row.within),
                    text_of(obb, "{:.2f}"), text_of(obbrss, "{:.2f}")));
  }
  end_table(report, peers);
  return ExitStatus::answered;
}

}  // namespace

ExitStatus run_table(const TableExperiment& experiment, const CommonOptions& options) {
  if (experiment.name == "table-5-1") return leaves_table(experiment, options);
  return experiment.name == "table-5-2" ? creation_table(experiment, options)
                                        : room_table(experiment, options);
}

}  // namespace snug::command
