#pragma once

#include <string>

#include <apps/snug/common.h>

namespace snug::command {

/// `independence --mesh FILE`: the kernel by the theorem, and where that does not reach by elimination.
ExitStatus independence_of_mesh(const std::string& path, const CommonOptions& options);

}  // namespace snug::command
