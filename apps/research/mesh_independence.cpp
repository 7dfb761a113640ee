#include "mesh_independence.h"

#include <algorithm>
#include <cstdlib>
#include <optional>

#include <apps/snug/curve.h>
#include <apps/snug/progress_bar.h>
#include <fmt/core.h>
#include <snug/independence/mesh_kernel.h>
#include <snug/independence/mesh_rank.h>
#include <snug/run.h>

#include "kernel_json.h"

namespace snug::command {
namespace {

constexpr std::size_t named_vertices = 6;

struct Answer {
  MeshKernel kernel;
  std::optional<MeshRank> rank;  // where the theorem does not reach
};

Answer answer(const ControlMesh& mesh, const SchemeOptions& rules, const WorkMonitor& monitor) {
  Answer result;
  try {
    result.kernel = mesh_kernel(mesh, rules, monitor);
  } catch (const NotDecided& reason) {
    if (mesh.vertex_count() > max_ranked_vertices) {
      throw InputError(
          InputProblem::refused,
          fmt::format("{}. Ranks are computed of meshes of {} control points and less; this one has {}",
                      reason.what(), max_ranked_vertices, mesh.vertex_count()));
    }
    result.rank = mesh_rank(mesh, rules, monitor);
  }
  return result;
}

// 1 or -1, else 0.
int sign_of(const std::vector<mpq_class>& value) {
  return value.size() == 1 && abs(value[0]) == 1 ? sgn(value[0]) : 0;
}

bool has_signs(const ExactKernelVector& vector) {
  return std::all_of(vector.entries.begin(), vector.entries.end(),
                     [](const auto& entry) { return sign_of(entry.second) != 0; });
}

void write_weight(JsonWriter& json, const std::vector<mpq_class>& value) {
  if (value.size() == 1) {
    json.value(value[0].get_str());
    return;
  }
  json.begin_array();
  for (const mpq_class& coefficient : value) json.value(coefficient.get_str());
  json.end_array();
}

void write_vectors(JsonWriter& json, const MeshRank& rank) {
  json.key("kernel").begin_array();
  for (const ExactKernelVector& vector : rank.vectors) {
    json.begin_object().key("vertices").begin_array();
    for (const auto& [v, value] : vector.entries) json.value(v.index());
    json.end_array();
    const bool signs = has_signs(vector);
    json.key(signs ? "signs" : "weights").begin_array();
    for (const auto& [v, value] : vector.entries) {
      if (signs) {
        json.value(sign_of(value));
      } else {
        write_weight(json, value);
      }
    }
    json.end_array();
    if (vector.order > 1) json.field("order", vector.order);
    json.end_object();
  }
  json.end_array();
}

void write_rank(JsonWriter& json, const MeshRank& rank) {
  json.field("dimension", rank.dimension).field("method", "rank");
  if (rank.decided()) {
    json.field("rank", rank.least);
  } else {
    json.key("rank").null();
  }
  json.key("rank_interval").begin_array();
  json.value(rank.least);
  json.value(rank.most);
  json.end_array();
  if (rank.least == rank.dimension || rank.most < rank.dimension) {
    json.field("independent", rank.least == rank.dimension);
  } else {
    json.key("independent").null();
  }
  write_vectors(json, rank);
  json.key("certificate").begin_object().field("prime", rank.prime).field("root", rank.root);
  json.field("root_order", rank.root_order).end_object();
}

std::string line_of(const KernelVector& vector) {
  std::string names;
  for (std::size_t i = 0; i < std::min(named_vertices, vector.vertices.size()); ++i) {
    names += fmt::format(" {}{}", vector.signs[i] > 0 ? '+' : '-', vector.vertices[i].index());
  }
  return fmt::format("  vanishes: {} vertices with signs in turn:{}{}", vector.vertices.size(), names,
                     vector.vertices.size() > named_vertices ? " ..." : "");
}

// "1 - 3/2 t"
std::string text_of(const std::vector<mpq_class>& value) {
  std::string text;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (value[i] == 0) continue;
    const char* const sign = value[i] < 0 ? (text.empty() ? "-" : " - ") : text.empty() ? "" : " + ";
    const mpq_class size = abs(value[i]);
    const std::string power = i == 0 ? "" : i == 1 ? "t" : fmt::format("t^{}", i);
    const std::string factor = size == 1 && i > 0 ? "" : size.get_str() + (i > 0 ? " " : "");
    text += sign + factor + power;
  }
  return text;
}

std::string line_of(const ExactKernelVector& vector) {
  std::string names;
  for (std::size_t i = 0; i < std::min(named_vertices, vector.entries.size()); ++i) {
    const auto& [v, value] = vector.entries[i];
    names += fmt::format("{} {}: {}", i == 0 ? "" : ",", v.index(), text_of(value));
  }
  return fmt::format("  vanishes: {} vertices with weights{}{}{}", vector.entries.size(), names,
                     vector.entries.size() > named_vertices ? " ..." : "",
                     vector.order > 1 ? fmt::format("; t = 2cos(2 pi/{})", vector.order) : "");
}

std::string verdict_of(const MeshRank& rank) {
  const char* const word = rank.least == rank.dimension ? "independent"
                           : rank.most < rank.dimension ? "dependent"
                                                        : "undecided";
  if (rank.decided()) return fmt::format("rank {}: {}", rank.least, word);
  return fmt::format("rank undecided, from {} to {}: {}", rank.least, rank.most, word);
}

}  // namespace

ExitStatus independence_of_mesh(const std::string& path, const CommonOptions& options) {
  const ControlMesh mesh = load_mesh(path, options);
  refuse_curves(mesh, options.scheme, path);
  const SurfaceOptions how = surface_options(options, options.scheme, mesh);
  const SchemeOptions rules = rules_for(mesh, how.scheme, how.boundary);
  Report report("independence", options);
  Answer found;
  {
    ProgressBar bar("kernel", options.quiet);
    const WorkMonitor monitor = bar.monitor();
    naming(path, [&] { found = answer(mesh, rules, monitor); });
  }
  report.heads({path}, {name_of(rules.scheme)});
  const std::size_t dimension = mesh.vertex_count(), rank = dimension - found.kernel.dimension();
  const bool independent = found.kernel.dimension() == 0;
  if (report.json()) {
    JsonWriter& json = report.write();
    if (found.rank) {
      write_rank(json, *found.rank);
    } else {
      json.field("dimension", dimension).field("method", "theorem").field("rank", rank);
      json.field("independent", independent);
      write_kernel(json, found.kernel);
    }
  }
  report.text(fmt::format("{}: {} nodal functions, {}", path, dimension,
                          found.rank
                              ? verdict_of(*found.rank)
                              : fmt::format("rank {}: {}", rank, independent ? "independent" : "dependent")));
  for (const KernelVector& vector : found.kernel.vectors) report.text(line_of(vector));
  if (!found.rank) return report.finish();
  for (const ExactKernelVector& vector : found.rank->vectors) report.text(line_of(vector));
  return report.finish(found.rank->decided());
}

}  // namespace snug::command
