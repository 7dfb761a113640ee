#include <snug/scheme/row_builder.h>

#include <algorithm>

#include <snug/geometry/rounding.h>

namespace snug {

Interval times(const Interval& factor, const Interval& weight) {
  return factor == Interval(1) ? weight : factor * weight;
}

void add_mean(std::span<const VertexId> face, const Interval& share, RowBuilder& row) {
  const std::size_t n = face.size();
  const Interval each =
      share == Interval(1) && n == 4 ? Interval(0.25) : share / Interval(static_cast<double>(n));
  for (const VertexId v : face) row.add(v.value(), each);
}

void add_face_means(const Topology& topology, const WorkMonitor& monitor, Stencils& out) {
  RowBuilder row;
  for (std::size_t f = 0; f < topology.face_count(); ++f) {
    monitor.checkpoint();
    add_mean(topology.face(FaceId(f)), Interval(1), row);
    row.end_row(out);
  }
}

void add_product(const Stencils::Row& outer, const Stencils& inner, std::span<const VertexId> names,
                 Stencils& out) {
  RowBuilder builder;
  double largest = 0;
  for (std::size_t i = 0; i < outer.sources.size(); ++i) {
    const Stencils::Row row = inner.row(outer.sources[i]);
    builder.add(Interval(outer.weights[i]), row);
    largest = std::max(largest, row.abs_sum + row.error);
  }
  Stencils one;
  builder.end_row(one);
  const Stencils::Row product = one.row(0);
  for (std::size_t i = 0; i < product.sources.size(); ++i) {
    const std::uint32_t source = product.sources[i];
    out.add(names.empty() ? source : names[source].value(), product.weights[i],
            i == 0 ? enlarged(product.error + outer.error * largest) : 0.0);
  }
  out.end_row();
}

}  // namespace snug
