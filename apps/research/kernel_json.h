#pragma once

#include <apps/snug/json_writer.h>
#include <snug/independence/mesh_kernel.h>

namespace snug::command {

/// The field `kernel`: a list of vectors, each by its `vertices` and their `signs`.
void write_kernel(JsonWriter& json, const MeshKernel& kernel);

}  // namespace snug::command
