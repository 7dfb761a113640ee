#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <apps/snug/common.h>
#include <fmt/core.h>
#include <snug/bounds/bounds_cache.h>
#include <snug/mesh/topology.h>
#include <snug/scheme/rules.h>

#include "commands.h"

namespace snug::command {
namespace {

// Beyond, planes above and below a function of Midedge are farther apart than functions are high.
constexpr std::uint64_t max_midedge_valence = 20;

struct Options : CommonOptions {
  std::optional<std::uint64_t> valence;
};

// Where a vertex lies around an extraordinary one, or a face: both count counter-clockwise.
struct RingPlace {
  std::size_t ring, index;
};

// Two rings around an extraordinary vertex, of a dual scheme around a face, all else regular. Each ring begins
// where the patch does.
class TwoRings {
 public:
  TwoRings(const SchemeRules& rules, std::size_t n) : n_(n) {
    if (rules.primal) places_.push_back({0, 0});
    const std::size_t inner = rules.triangular() || !rules.primal ? n : 2 * n;
    add_ring(1, inner);
    add_ring(2, rules.triangular() ? 2 * n : rules.primal ? 4 * n : 3 * n);
    if (rules.triangular()) {
      add_triangles();
    } else if (rules.primal) {
      add_quads();
    } else {
      add_around_face();
    }
  }
  [[nodiscard]] Topology topology() const { return Topology(offsets_, vertices_, places_.size()); }
  [[nodiscard]] RingPlace place(VertexId v) const { return places_[v.index()]; }

 private:
  void add_ring(std::size_t ring, std::size_t size) {
    begins_[ring] = places_.size();
    sizes_[ring] = size;
    for (std::size_t i = 0; i < size; ++i) places_.push_back({ring, i});
  }
  [[nodiscard]] VertexId one(std::size_t i) const { return VertexId(begins_[1] + i % sizes_[1]); }
  [[nodiscard]] VertexId two(std::size_t i) const { return VertexId(begins_[2] + i % sizes_[2]); }
  void add_face(const std::vector<VertexId>& face) {
    vertices_.insert(vertices_.end(), face.begin(), face.end());
    offsets_.push_back(static_cast<std::uint32_t>(vertices_.size()));
  }

  void add_triangles() {
    for (std::size_t s = 0; s < n_; ++s) {
      add_face({VertexId(0), one(s), one(s + 1)});
      add_face({one(s), two(2 * s), two(2 * s + 1)});
      add_face({one(s), two(2 * s + 1), one(s + 1)});
      add_face({one(s + 1), two(2 * s + 1), two(2 * s + 2)});
    }
  }
  void add_quads() {
    for (std::size_t s = 0; s < n_; ++s) {
      const std::size_t i = 2 * s, j = 4 * s;
      add_face({VertexId(0), one(i), one(i + 1), one(i + 2)});
      add_face({one(i), two(j), two(j + 1), one(i + 1)});
      add_face({one(i + 1), two(j + 1), two(j + 2), two(j + 3)});
      add_face({one(i + 2), one(i + 1), two(j + 3), two(j + 4)});
    }
  }
  void add_around_face() {
    std::vector<VertexId> face;
    for (std::size_t k = 0; k < n_; ++k) face.push_back(one(k));
    add_face(face);
    for (std::size_t k = 0; k < n_; ++k) {
      const std::size_t j = 3 * k;
      add_face({one(k), two(j), two(j + 1), two(j + 2)});
      add_face({one(k), two(j + 2), two(j + 3), one(k + 1)});
    }
  }

  std::size_t n_;
  std::array<std::size_t, 3> begins_{}, sizes_{};
  std::vector<RingPlace> places_;
  std::vector<std::uint32_t> offsets_{0};
  std::vector<VertexId> vertices_;
};

// The table of the patch that begins in the middle of two rings, and where its control points lie there.
struct LaidOut {
  const Kind& kind;
  const BoundTable& table;
  std::vector<RingPlace> places;
};

LaidOut lay_out(BoundsCache& cache, const SchemeRules& rules, std::size_t valence) {
  const TwoRings rings(rules, valence);
  const Topology topology = rings.topology();
  const HalfEdge start = topology.first_of(FaceId(0));
  const Kind& kind = cache.kinds().find(kind_key_from(topology, start, {rules.scheme}));
  std::vector<VertexId> control;
  kind.control_vertices(topology, start, control);
  LaidOut found{kind, cache.table(kind), {}};
  for (const VertexId v : control) found.places.push_back(rings.place(v));
  return found;
}

template <class Rows>
void write_rows(JsonWriter& json, const char* name, const Rows& rows) {
  json.key(name).begin_array();
  for (const auto& row : rows) {
    json.begin_array();
    for (const double x : row) json.value(x);
    json.end_array();
  }
  json.end_array();
}

std::vector<std::vector<double>> dense(const Stencils& stencils, std::size_t count) {
  std::vector<std::vector<double>> rows(stencils.row_count(), std::vector<double>(count, 0.0));
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const Stencils::Row row = stencils.row(r);
    for (std::size_t i = 0; i < row.sources.size(); ++i) rows[r][row.sources[i]] += row.weights[i];
  }
  return rows;
}

void write_json(JsonWriter& json, const LaidOut& found) {
  const BoundTable& table = found.table;
  json.field("first_bounded", table.first_bounded());
  write_rows(json, "points", table.layout);
  write_rows(json, "triangle", table.triangle);
  write_rows(json, "below", table.lower);
  write_rows(json, "above", table.upper);
  json.key("numbering").begin_array();
  for (const RingPlace& at : found.places) {
    json.begin_object().field("ring", at.ring).field("index", at.index).end_object();
  }
  json.end_array().key("faces").begin_array();
  const Topology around = neighbourhood(found.kind.key()).topology;
  for (std::size_t f = 0; f < around.face_count(); ++f) {
    json.begin_array();
    for (const VertexId v : around.face(FaceId(f))) json.value(v.value());
    json.end_array();
  }
  json.end_array();
  write_rows(json, "corner_limits", dense(found.kind.corner_limits(), table.control_count()));
}

std::string text_of(const BoundTable::CornerValues& plane) {
  return fmt::format("{:9.6f} {:9.6f} {:9.6f}", plane[0], plane[1], plane[2]);
}

void write_text(Report& report, const LaidOut& found) {
  const BoundTable& table = found.table;
  const auto& [a, b, c] = table.triangle;
  report.text(fmt::format("# triangle ({}, {}) ({}, {}) ({}, {}); values at its corners", a[0], a[1], b[0],
                          b[1], c[0], c[1]));
  report.text("# point ring index          x         y       below                           above");
  for (std::size_t i = 0; i < table.control_count(); ++i) {
    const RingPlace& at = found.places[i];
    std::string line = fmt::format("{:7} {:4} {:5}  {:9.6f} {:9.6f}", i, at.ring, at.index,
                                   table.layout[i][0], table.layout[i][1]);
    if (i >= table.first_bounded()) {
      const std::size_t k = i - table.first_bounded();
      line += "   " + text_of(table.lower[k]) + "   " + text_of(table.upper[k]);
    }
    report.text(line);
  }
}

ExitStatus run(const Options& options) {
  const SchemeRules& rules = *rules_named(options.scheme);
  if (rules.scheme == Scheme::midedge && *options.valence > max_midedge_valence) {
    throw UsageError(
        fmt::format("table: planes of midedge are of no use beyond {} corners; bound has tighter sets",
                    max_midedge_valence));
  }
  BoundsCache cache;
  const LaidOut found = lay_out(cache, rules, *options.valence);
  Report report("table", options);
  if (report.json()) {
    report.write().field("scheme", rules.name).field("valence", *options.valence);
    write_json(report.write(), found);
  }
  write_text(report, found);
  return report.finish();
}

}  // namespace

Command table_command() {
  auto options = std::make_shared<Options>();
  options->scheme.clear();
  OptionList list;
  Option& scheme = list.add(Group::own, "--scheme NAME", &options->scheme, "Subdivision scheme").required();
  for (const SchemeRules* rules : all_rules()) {
    if (rules->local) continue;
    scheme.choices.emplace_back(rules->name);
    for (const char* other : rules->other_names) scheme.alias(other, rules->name);
  }
  list.add(Group::own, "--valence N", &options->valence,
           "Valence of the extraordinary vertex, 3 to 200; with a dual scheme, corners of the face, with "
           "midedge up to 20")
      .between(3, 200)
      .required();
  add_output_options(list, *options);
  return {
      "table",
      Topic::functions,
      "Print the table of a patch beside one extraordinary vertex: its layout, and planes below and above "
      "its basis functions",
      {"snug-research table --scheme loop --valence 7",
       "snug-research table --scheme catmark --valence 5 --json"},
      std::move(list),
      [options] { return run(*options); }};
}

}  // namespace snug::command
