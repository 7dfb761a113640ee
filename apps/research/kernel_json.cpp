#include "kernel_json.h"

namespace snug::command {

void write_kernel(JsonWriter& json, const MeshKernel& kernel) {
  json.key("kernel").begin_array();
  for (const KernelVector& vector : kernel.vectors) {
    json.begin_object().key("vertices").begin_array();
    for (const VertexId v : vector.vertices) json.value(v.index());
    json.end_array().key("signs").begin_array();
    for (const std::int8_t sign : vector.signs) json.value(int{sign});
    json.end_array().end_object();
  }
  json.end_array();
}

}  // namespace snug::command
