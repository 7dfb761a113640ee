#include <experiments/bound_source.h>

#include <algorithm>
#include <optional>

#include <snug/bounds/table_triangle.h>
#include <snug/patch/evaluate.h>
#include <snug/scheme/refine.h>
#include <support/contract.h>

namespace snug {
namespace {

// Subdivision around the extraordinary corner shrinks the ring by its eigenvalue; the outer points follow by
// iteration, for their own eigenvalues are at most 1/8.
void relax(const Kind& kind, std::size_t centre, std::vector<LayoutPoint>& layout) {
  const Neighbourhood around = neighbourhood(kind.key());
  const Topology& topology = around.topology;
  // The quarter at the corner has the kind again, and here in the same order.
  const RefinedTopology refined = refine(topology, around.options, around.sharpness);
  std::vector<VertexId> control;
  kind.control_vertices(refined.topology, refined.topology.first_of(FaceId(centre)), control);
  SNUG_EXPECT(control.size() == layout.size());
  std::vector<bool> fixed(layout.size(), false);
  fixed[centre] = true;
  for (HalfEdge h = 0; h < topology.half_edge_count(); ++h) {
    if (topology.from(h) == VertexId(centre)) fixed[topology.to(h).index()] = true;
  }
  const double grow = 1 / kind.rules().shrink_factor(kind.corner(centre));
  const LayoutPoint origin = layout[centre];
  for (int step = 0; step < 200; ++step) {
    const std::vector<LayoutPoint> old = layout;
    for (std::size_t r = 0; r < layout.size(); ++r) {
      if (fixed[r]) continue;
      LayoutPoint sum{0, 0};
      const Stencils::Row row = refined.stencils.row(control[r].index());
      for (std::size_t i = 0; i < row.sources.size(); ++i) {
        for (std::size_t a = 0; a < 2; ++a) sum[a] += row.weights[i] * (old[row.sources[i]][a] - origin[a]);
      }
      layout[r] = {origin[0] + grow * sum[0], origin[1] + grow * sum[1]};
    }
    if (layout == old) break;
  }
}

}  // namespace

std::vector<LayoutPoint> characteristic_layout(const Kind& kind) {
  std::vector<LayoutPoint> layout = make_layout(kind);
  if (const std::optional<std::size_t> centre = lone_centre(kind)) relax(kind, *centre, layout);
  return layout;
}

const BoundTable& LayoutTables::get(const Kind& kind, BoundSource source) {
  SNUG_EXPECT(source != BoundSource::rows);
  if (source == BoundSource::ngon || !lone_centre(kind)) return library_.table(kind);
  return characteristic_.get(kind.id(), [&] {
    return make_bound_table(kind, make_bounding_rows(kind), characteristic_layout(kind));
  });
}

OffsetTriangle LayoutTables::offset(const Patch& patch, BoundSource source, BoundingPoints& scratch) {
  if (source != BoundSource::rows) return offset_triangle(table_triangle(get(*patch.kind, source), patch));
  bounding_points(library_, patch, scratch);
  return offset_triangle(library_, scratch, limit_corners(patch));
}

}  // namespace snug
