#include "subject.h"

#include <utility>

#include <experiments/control_box.h>
#include <snug/search/piece.h>

namespace snug::bench {

Subject::Subject(ControlMesh mesh, const SchemeOptions& options, std::shared_ptr<BoundsCache> library)
    : library_(std::move(library)),
      surface_(std::make_unique<LimitSurface>(std::move(mesh), options, library_)) {}

double Subject::enclose(std::span<const PatchId> faces, std::vector<OffsetTriangle>& out) {
  out.resize(faces.size());
  double sum = 0;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    out[i] = make_piece(*library_, faces[i], surface_->patch(faces[i]), scratch_).offset;
    sum += out[i].radius;
  }
  return sum;
}

std::size_t Subject::hull_point_count() {
  std::size_t sum = 0;
  for (const PatchId f : all_faces(surface_->face_count())) {
    bounding_points(*library_, surface_->patch(f), scratch_);
    sum += scratch_.size();
  }
  return sum;
}

BatchBounds Subject::bounds(std::span<const PatchId> faces, BoundMethod method) const {
  return BatchBounds(*surface_, {faces.begin(), faces.end()}, method, 1);
}

double Subject::enclose_all(std::vector<OffsetTriangle>& out) {
  BatchBounds bounds(*surface_, BoundMethod::rows, 1);
  return update(bounds, surface_->mesh().points, out);
}

double Subject::box(std::span<const PatchId> faces, std::vector<Box3>& out) {
  out.resize(faces.size());
  double sum = 0;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    out[i] = control_box(surface_->patch(faces[i]), scratch_);
    sum += longest_side(out[i]);
  }
  return sum;
}

double update(BatchBounds& bounds, std::span<const Point3> points, std::vector<OffsetTriangle>& out) {
  out.resize(bounds.patches().size());
  bounds.update(points, out, 1);
  double sum = 0;
  for (const OffsetTriangle& triangle : out) sum += triangle.radius;
  return sum;
}

std::vector<PatchId> all_faces(std::size_t count) {
  std::vector<PatchId> faces;
  faces.reserve(count);
  for (std::size_t f = 0; f < count; ++f) faces.push_back(PatchId(f));
  return faces;
}

}  // namespace snug::bench
