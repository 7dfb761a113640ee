#pragma once

#include <memory>
#include <optional>
#include <string>

#include <snug/query/query_model.h>

#include "common.h"

namespace snug::command {

/// Options of the commands that ask about one surface, or two placed ones.
struct ModelOptions : CommonOptions {
  std::string volume = name_of(QueryModelOptions{}.volume);
};
void add_model_options(OptionList& list, ModelOptions& options);
/// Errors:    UsageError where `command` has no use for --bounds.
[[nodiscard]] QueryModelOptions model_options(const ModelOptions& options, const std::string& command);

struct PairOptions : ModelOptions {
  std::string mesh_a, mesh_b;
  std::string scheme_a, scheme_b;
  std::string place_a, place_b;
};
void add_pair_options(OptionList& list, PairOptions& options);

/// Two meshes, read and made ready.
class PairArguments {
 public:
  /// Errors:    UsageError; InputError that names the mesh or the placement.
  PairArguments(const PairOptions& options, const std::string& command);

  /// Makes the models.
  void prepare(const WorkMonitor& monitor);
  /// Requires:  prepare().
  [[nodiscard]] PlacedModel a() { return {*model_a_, *scratch_a_, place_a_}; }
  [[nodiscard]] PlacedModel b() { return {*model_b_, *scratch_b_, place_b_}; }
  /// Of the longer one.
  [[nodiscard]] double size() const { return std::max(surface_a_->size(), surface_b_->size()); }
  /// The fields of both in the head of a report.
  void write_heads(Report& report) const;

 private:
  const PairOptions& options_;
  QueryModelOptions model_options_;
  Motion place_a_, place_b_;
  std::optional<Surface> surface_a_, surface_b_;
  std::optional<QueryModel> model_a_, model_b_;
  std::optional<QueryScratch> scratch_a_, scratch_b_;
};

}  // namespace snug::command
