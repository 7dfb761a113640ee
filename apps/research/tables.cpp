#include <filesystem>
#include <memory>
#include <optional>

#include <apps/snug/progress_bar.h>
#include <experiments/room_tables.h>
#include <experiments/rooms.h>
#include <fmt/core.h>

#include "commands.h"
#include "uniform_meshes.h"

namespace snug::command {
namespace {

constexpr unsigned creation_rounds = 5;

struct Options : CommonOptions {
  std::vector<std::string> models;  // files; empty: six of examples/models
  std::uint64_t placements = 150'000, seed = 1;
};

struct Models {
  std::vector<std::string> names;
  std::vector<ControlMesh> meshes;
};

// A file such as "examples/models/star.obj" below the current folder, or below one of those above this
// executable.
std::optional<std::string> file_around(const std::string& name) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (fs::is_regular_file(name, ignored)) return name;
  fs::path folder = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  for (; folder.has_relative_path(); folder = folder.parent_path()) {
    if (fs::is_regular_file(folder / name, ignored)) return (folder / name).string();
  }
  return {};
}

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

Models load_models(const Options& options) {
  Models models;
  for (const std::string& file : options.models.empty() ? default_models() : options.models) {
    ControlMesh mesh = load_mesh(file, options);
    mesh.tags = {};
    // Refuses what is no surface, before a size is looked for.
    naming(file, [&] { static_cast<void>(LimitSurface(mesh, rules(), std::make_shared<BoundsCache>())); });
    models.names.push_back(std::filesystem::path(file).stem().string());
    models.meshes.push_back(unit_model(std::move(mesh)));
  }
  return models;
}

void require_pairs(const char* command, const Models& models) {
  if (models.meshes.size() % 2 == 0) return;
  throw UsageError(fmt::format("{}: models meet two by two; give an even number of them", command));
}

void write_number(JsonWriter& json, const char* key, const std::optional<double>& number) {
  json.key(key);
  number ? json.value(*number) : json.null();
}
std::string text_of(const std::optional<double>& number, const char* format) {
  return number ? fmt::format(fmt::runtime(format), *number) : "-";
}

void begin_table(Report& report, bool peers) {
  if (report.json()) report.write().field("peers", peers).key("rows").begin_array();
}

void end_table(Report& report, bool peers) {
  if (report.json()) report.write().end_array();
  if (!peers) report.text("uniform Loop: not measured; build where OpenSubdiv and FCL are installed");
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

ExitStatus leaves_table(const Options& options) {
  Report report("table-5-1", options);
  const Models models = load_models(options);
  const std::size_t count = models.meshes.size() * table_tolerances.size();
  std::vector<LeafCounts> rows;
  {
    ProgressBar bar("splitting patches", options.quiet);
    const WorkMonitor monitor = bar.monitor();
    const auto library = std::make_shared<BoundsCache>();
    for (const ControlMesh& mesh : models.meshes) {
      const LimitSurface surface(mesh, rules(), library);
      for (const double tolerance : table_tolerances) {
        rows.push_back(count_leaves(surface, tolerance, monitor));
        monitor.report(static_cast<double>(rows.size()) / static_cast<double>(count));
      }
    }
  }
  const auto uniform = uniform_triangles(models.meshes, stopped_by_interrupts());
  begin_table(report, uniform.has_value());
  report.text("triangles until each offset triangle's radius is at most half the tolerance");
  report.text("of AABBs around control points: half the longest side");
  report.text(fmt::format("{:<10} {:>6} {:>7} {:>8} {:>8} {:>8} {:>9} {:>8}", "model", "faces", "within",
                          "rows", "tables", "printed", "AABB", "uniform"));
  for (std::size_t i = 0; i < count; ++i) {
    const std::string& name = models.names[i / table_tolerances.size()];
    const std::size_t faces = models.meshes[i / table_tolerances.size()].face_count();
    const double tolerance = table_tolerances[i % table_tolerances.size()];
    if (report.json()) {
      JsonWriter& json = report.write();
      json.begin_object().field("model", name).field("faces", faces);
      json.field("tolerance", tolerance).field("rows", rows[i].rows).field("tables", rows[i].tables);
      json.field("printed", rows[i].printed).field("aabb", rows[i].boxes).key("uniform");
      uniform ? json.value(uniform->at(i)) : json.null();
      json.end_object();
    }
    report.text(fmt::format("{:<10} {:>6} {:>5} % {:>8} {:>8} {:>8} {:>9} {:>8}", name, faces,
                            100 * tolerance, rows[i].rows, rows[i].tables, rows[i].printed, rows[i].boxes,
                            uniform ? fmt::format("{}", uniform->at(i)) : "-"));
  }
  end_table(report, uniform.has_value());
  return ExitStatus::answered;
}

ExitStatus creation_table(const Options& options) {
  Report report("table-5-2", options);
  const Models models = load_models(options);
  const std::size_t count = models.meshes.size() * table_tolerances.size();
  std::vector<CreationTimes> rows;
  {
    ProgressBar bar("making hierarchies", options.quiet);
    const WorkMonitor monitor = bar.monitor();
    for (const ControlMesh& mesh : models.meshes) {
      for (const double tolerance : table_tolerances) {
        rows.push_back(measure_creation(mesh, rules(), tolerance, creation_rounds, monitor));
        monitor.report(static_cast<double>(rows.size()) / static_cast<double>(count));
      }
    }
  }
  const auto uniform = uniform_creation(models.meshes, stopped_by_interrupts());
  begin_table(report, uniform.has_value());
  report.text("milliseconds from a control mesh in memory until queries can be asked, one thread");
  report.text(fmt::format("{:<10} {:>7} {:>8} {:>8} {:>8} {:>8} {:>12} {:>15}", "model", "within", "ready",
                          "tight", "rows", "printed", "uniform, OBB", "uniform, OBBRSS"));
  for (std::size_t i = 0; i < count; ++i) {
    const std::string& name = models.names[i / table_tolerances.size()];
    const double tolerance = table_tolerances[i % table_tolerances.size()];
    const double ready = 1e3 * rows[i].model, tight = 1e3 * rows[i].tight, bounding_rows = 1e3 * rows[i].rows,
                 printed = 1e3 * rows[i].printed;
    const std::optional<double> obb = uniform ? std::optional(uniform->at(i).obb) : std::nullopt,
                                obbrss = uniform ? std::optional(uniform->at(i).obbrss) : std::nullopt;
    if (report.json()) {
      JsonWriter& json = report.write();
      json.begin_object().field("model", name).field("tolerance", tolerance).field("ready_ms", ready);
      json.field("tight_ms", tight).field("rows_ms", bounding_rows).field("printed_ms", printed);
      write_number(json, "uniform_obb_ms", obb);
      write_number(json, "uniform_obbrss_ms", obbrss);
      json.end_object();
    }
    report.text(fmt::format("{:<10} {:>5} % {:>8.2f} {:>8.2f} {:>8.2f} {:>8.2f} {:>12} {:>15}", name,
                            100 * tolerance, ready, tight, bounding_rows, printed, text_of(obb, "{:.2f}"),
                            text_of(obbrss, "{:.2f}")));
  }
  end_table(report, uniform.has_value());
  return ExitStatus::answered;
}

ExitStatus room_table(const Options& options) {
  Report report("table-5-3", options);
  const Models models = load_models(options);
  require_pairs("table-5-3", models);
  // Rooms, then pairs, then tolerances.
  struct Cell {
    double side, tolerance;
    std::size_t pair;
  };
  std::vector<Cell> cells;
  for (const double side : room_sides) {
    for (std::size_t pair = 0; pair < models.meshes.size() / 2; ++pair) {
      for (const double tolerance : table_tolerances) cells.push_back({side, tolerance, pair});
    }
  }
  std::vector<RoomRow> rows;
  {
    ProgressBar bar("colliding", options.quiet);
    const WorkMonitor monitor = bar.monitor();
    const auto library = std::make_shared<BoundsCache>();
    std::vector<LimitSurface> surfaces;
    for (const ControlMesh& mesh : models.meshes) surfaces.emplace_back(mesh, rules(), library);
    for (const Cell& cell : cells) {
      rows.push_back(measure_room(surfaces[2 * cell.pair], surfaces[2 * cell.pair + 1],
                                  {cell.side, cell.tolerance, options.placements, options.seed},
                                  part_of(monitor, rows.size(), cells.size())));
    }
  }
  const auto uniform =
      uniform_rooms(models.meshes, options.placements, options.seed, stopped_by_interrupts());
  if (report.json()) report.write().field("seed", options.seed);
  begin_table(report, uniform.has_value());
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
    const std::string &a = models.names[2 * pair], &b = models.names[2 * pair + 1];
    const RoomRow& row = rows[i];
    const std::optional<double> obb = uniform ? std::optional(uniform->at(i).obb) : std::nullopt,
                                obbrss = uniform ? std::optional(uniform->at(i).obbrss) : std::nullopt;
    if (report.json()) {
      JsonWriter& json = report.write();
      json.begin_object().key("pair").begin_array().value(a).value(b).end_array();
      json.field("room", side).field("tolerance", tolerance).field("placements", options.placements);
      json.field("hits", row.hits).field("within", row.within);
      json.field("rows_us", 1e6 * row.rows).field("tables_us", 1e6 * row.tables);
      json.field("printed_us", 1e6 * row.printed).field("printed_missed", row.printed_missed);
      json.field("printed_missed_moeller", row.printed_missed_moeller);
      json.field("printed_missed_hits", row.printed_missed_hits);
      json.field("printed_alarms", row.printed_alarms);
      write_number(json, "uniform_obb_us", obb);
      write_number(json, "uniform_obbrss_us", obbrss);
      json.key("uniform_hits");
      uniform ? json.value(uniform->at(i).hits) : json.null();
      json.end_object();
    }
    const double share = 100.0 * static_cast<double>(row.hits) / static_cast<double>(options.placements);
    report.text(
        fmt::format("{:>4} {:<16} {:>5} % {:>5.1f} % {:>7.2f} {:>8.2f} {:>8.2f} {:>17} {:>13} {:>13}", side,
                    a + "/" + b, 100 * tolerance, share, 1e6 * row.rows, 1e6 * row.tables, 1e6 * row.printed,
                    fmt::format("{}, {} of {}", row.printed_missed, row.printed_missed_moeller, row.within),
                    text_of(obb, "{:.2f}"), text_of(obbrss, "{:.2f}")));
  }
  end_table(report, uniform.has_value());
  return ExitStatus::answered;
}

ExitStatus volumes_table(const Options& options) {
  Report report("volumes", options);
  const Models models = load_models(options);
  require_pairs("volumes", models);
  constexpr double tolerance = 0.01;
  struct Cell {
    double side;
    std::size_t pair;
    std::vector<VolumeRow> rows;
  };
  std::vector<Cell> cells;
  {
    ProgressBar bar("colliding", options.quiet);
    const WorkMonitor monitor = bar.monitor();
    const auto library = std::make_shared<BoundsCache>();
    std::vector<LimitSurface> surfaces;
    for (const ControlMesh& mesh : models.meshes) surfaces.emplace_back(mesh, rules(), library);
    const std::size_t pairs = surfaces.size() / 2;
    for (const double side : {room_sides[0], room_sides[1]}) {
      for (std::size_t pair = 0; pair < pairs; ++pair) {
        cells.push_back({side, pair,
                         measure_volumes(surfaces[2 * pair], surfaces[2 * pair + 1],
                                         {side, tolerance, options.placements, options.seed},
                                         part_of(monitor, cells.size(), 2 * pairs))});
      }
    }
  }
  if (report.json()) {
    report.write().field("seed", options.seed).field("placements", options.placements);
    report.write().field("tolerance", tolerance).key("rows").begin_array();
  }
  report.text("a query: pairs of volumes and of leaves tested, microseconds; KB: the volumes of both trees");
  report.text(fmt::format("{:>4} {:<16} {:<6} {:<9} {:>7} {:>9} {:>9} {:>9} {:>8}  {}", "room", "models",
                          "volume", "turning", "KB", "volumes", "leaves", "us", "possible", "verdicts"));
  for (const auto& [side, pair, rows] : cells) {
    const std::string &a = models.names[2 * pair], &b = models.names[2 * pair + 1];
    for (const VolumeRow& row : rows) {
      const char* turning = row.volume == Volume::obb ? "turned" : name_of(row.turning);
      const std::string verdicts = fmt::format("{:016x}", row.verdicts_sum);
      if (report.json()) {
        JsonWriter& json = report.write();
        json.begin_object().key("pair").begin_array().value(a).value(b).end_array();
        json.field("room", side).field("volume", name_of(row.volume)).field("turning", turning);
        json.field("bytes", row.bytes).field("volume_tests", row.volume_tests);
        json.field("triangle_tests", row.triangle_tests).field("query_us", 1e6 * row.seconds);
        json.field("possible", row.possible).field("verdicts", verdicts).end_object();
      }
      report.text(fmt::format("{:>4} {:<16} {:<6} {:<9} {:>7} {:>9.1f} {:>9.2f} {:>9.2f} {:>8}  {}", side,
                              a + "/" + b, name_of(row.volume), turning, (row.bytes + 512) / 1024,
                              row.volume_tests, row.triangle_tests, 1e6 * row.seconds, row.possible,
                              verdicts));
    }
  }
  if (report.json()) report.write().end_array();
  report.finish();
  return ExitStatus::answered;
}

// The options of all.
OptionList table_options(Options& options) {
  OptionList list;
  list.add(Group::own, "MODEL", &options.models,
           "Triangle meshes, taken in pairs by table-5-3 and volumes; default: six of examples/models")
      .must = false;
  add_output_options(list, options);
  return list;
}

OptionList room_options(Options& options) {
  OptionList list = table_options(options);
  list.add(Group::own, "--placements N", &options.placements, "Random poses of each pair in each room")
      .between(1, 100'000'000);
  list.add(Group::own, "--seed N", &options.seed, "Random seed");
  return list;
}

}  // namespace

Command leaves_command() {
  auto options = std::make_shared<Options>();
  return {"table-5-1",
          Topic::tables,
          "Number of triangles for tolerances of 2, 1 and 0.5 %, by bounding method",
          {"snug-research table-5-1 star.obj"},
          table_options(*options),
          [options] { return leaves_table(*options); }};
}

Command creation_command() {
  auto options = std::make_shared<Options>();
  return {"table-5-2",
          Topic::tables,
          "Time to build a hierarchy",
          {"snug-research table-5-2 star.obj"},
          table_options(*options),
          [options] { return creation_table(*options); }};
}

Command rooms_command() {
  auto options = std::make_shared<Options>();
  OptionList list = room_options(*options);
  return {"table-5-3",
          Topic::tables,
          "Query times for two models at random poses in a room",
          {"snug-research table-5-3 --placements 2000"},
          std::move(list),
          [options] { return room_table(*options); }};
}

Command volumes_command() {
  auto options = std::make_shared<Options>();
  options->placements = 5000;
  OptionList list = room_options(*options);
  return {"volumes",
          Topic::tables,
          "Trees of boxes, k-DOPs or oriented boxes alone, while one model turns",
          {"snug-research volumes --placements 500"},
          std::move(list),
          [options] { return volumes_table(*options); }};
}

}  // namespace snug::command
