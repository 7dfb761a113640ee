#include "subject.h"

#include <utility>

#include <snug/surface/refinement.h>

namespace snug::bench {

Subject::Subject(ControlMesh mesh, std::shared_ptr<BoundLibrary> library)
    : library_(std::move(library)),
      surface_(std::make_unique<Surface>(std::move(mesh), SchemeOptions{}, library_, 1)) {}

OffsetTriangle Subject::enclose(FaceId face) {
  return make_piece(*library_, face, surface_->patch(face), scratch_).offset;
}

double Subject::enclose(std::span<const FaceId> faces, std::vector<OffsetTriangle>& out) {
  out.resize(faces.size());
  double sum = 0;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    out[i] = enclose(faces[i]);
    sum += out[i].radius;
  }
  return sum;
}

double Subject::enclose_all(std::vector<OffsetTriangle>& out) {
  out.resize(surface_->face_count());
  double sum = 0;
  for (std::size_t f = 0; f < out.size(); ++f) {
    out[f] = enclose(FaceId(f));
    sum += out[f].radius;
  }
  return sum;
}

double Subject::box(std::span<const FaceId> faces, std::vector<Box3>& out) {
  out.resize(faces.size());
  double sum = 0;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    control_points(surface_->patch(faces[i]), scratch_);
    out[i] = outer_box(scratch_);
    sum += out[i].longest_side();
  }
  return sum;
}

double Subject::refit(std::span<const Point3> points, std::vector<OffsetTriangle>& out) {
  ControlMesh mesh = surface_->mesh();
  mesh.points.assign(points.begin(), points.end());
  surface_ = std::make_unique<Surface>(std::move(mesh), SchemeOptions{}, library_, 1);
  return enclose_all(out);
}

double Subject::evaluate(FaceId face, std::span<const TriangleParameter> at, std::span<Point3> out) {
  const Patch patch = surface_->patch(face);
  const PowerOfTwo back = surface_->scale().inverse();
  double errors = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const LimitPoint point = limit_point(patch, at[i]);
    out[i] = back.apply(patch.origin + point.relative);
    errors += back.apply(point.error);
  }
  return errors;
}

std::vector<FaceId> all_faces(std::size_t count) {
  std::vector<FaceId> faces;
  faces.reserve(count);
  for (std::size_t f = 0; f < count; ++f) faces.push_back(FaceId(f));
  return faces;
}

}  // namespace snug::bench
