#pragma once

#include <snug/independence/mesh_kernel.h>

#include "json_writer.h"

namespace snug::command {

/// The field `kernel`: a list of vectors, each by its `vertices` and their `signs`.
void write_kernel(JsonWriter& json, const MeshKernel& kernel);

}  // namespace snug::command
