#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common.h"

namespace snug::command {

/// experiment table-5-1, table-5-2, table-5-3.
struct TableExperiment {
  std::string name;
  std::vector<std::string> models;  ///< files; empty: six of examples/models
  std::size_t placements = 150'000;
  std::uint64_t seed = 1;
};

/// Errors:    UsageError for models that are not there, or that are no pairs where pairs are asked for, or for a scheme that is
///            not Loop.
ExitStatus run_table(const TableExperiment& experiment, const CommonOptions& options);

}  // namespace snug::command
