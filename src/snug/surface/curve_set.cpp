#include <snug/surface/curve_set.h>

#include <algorithm>
#include <utility>

#include <support/error.h>

namespace snug {

CurveSet::Edges::Edges(ControlMesh mesh, CurveDegree degree) : mesh_(std::move(mesh)), degree_(degree) {
  require_curves(mesh_);
  Box3 box;
  for (const VertexId v : mesh_.polyline_vertices) box.add(mesh_.points[v.index()]);
  size_ = longest_side(box);
  scale_ = PowerOfTwo::normalising(std::max(max_abs(box.lower - Point3{}), max_abs(box.upper - Point3{})));
  for (std::size_t p = 0; p < mesh_.polyline_count(); ++p) {
    const auto line = mesh_.polyline(PolylineId(p));
    const std::size_t last = line.size() - 1;
    const bool closed = line.front() == line.back();
    for (std::size_t i = 0; i < last; ++i) {
      const VertexId before = i > 0 ? line[i - 1] : closed ? line[last - 1] : VertexId();
      const VertexId after = i + 1 < last ? line[i + 2] : closed ? line[1] : VertexId();
      edges_.push_back({before, line[i], line[i + 1], after});
    }
  }
}

CurvePiece CurveSet::Edges::piece(EdgeId edge) const {
  require_value(edge.index() < edges_.size(),
                "curves: there is no such edge; they count from 0 to edge_count() - 1");
  const Window& window = edges_[edge.index()];
  const auto point = [&](VertexId v) { return scale_.apply(mesh_.points[v.index()]); };
  const auto neighbour = [&](VertexId v) { return v.valid() ? std::optional(point(v)) : std::nullopt; };
  return make_curve_piece(degree_, neighbour(window.before), point(window.from), point(window.to),
                          neighbour(window.after));
}

CurveSet::CurveSet(ControlMesh mesh, CurveDegree degree)
    : edges_(std::make_shared<const Edges>(std::move(mesh), degree)) {}
CurveSet::CurveSet(const CurveSet&) noexcept = default;
CurveSet& CurveSet::operator=(const CurveSet&) noexcept = default;
CurveSet::~CurveSet() = default;
const ControlMesh& CurveSet::mesh() const { return edges_->mesh(); }
CurveDegree CurveSet::degree() const { return edges_->degree(); }
double CurveSet::size() const { return edges_->size(); }
std::size_t CurveSet::edge_count() const { return edges_->count(); }

}  // namespace snug
