#include "patches.h"

#include <memory>

#include <snug/surface/batch_bounds.h>

#include "meshes.h"
#ifdef SNUG_BENCH_OPENSUBDIV
#include "peer_opensubdiv.h"
#endif

namespace snug::bench {

std::vector<Times> bench_faces(const std::string& title, Subject& subject, const std::vector<PatchId>& faces,
                               const Options& options) {
  const auto count = static_cast<double>(faces.size());
  std::vector<Box3> boxes;
  std::vector<OffsetTriangle> triangles;
  Group group(title + ", " + std::to_string(faces.size()) + " patches", "patch", options);
  group.add("box of the control points", count, [&] { return subject.box(faces, boxes); });
  const auto& points = subject.surface().mesh().points;
  BatchBounds rows = subject.bounds(faces), tables = subject.bounds(faces, BoundMethod::table);
  group.add(one_by_one, count, [&] { return subject.enclose(faces, triangles); });
  group.add(from_rows, count, [&] { return update(rows, points, triangles); });
  group.add(from_tables, count, [&] { return update(tables, points, triangles); });
  return group.run();
}

std::vector<std::vector<Times>> bench_quads(const std::string& title, const ControlMesh& mesh,
                                            const Options& options) {
  const LimitSurface surface(mesh, catmark(), std::make_shared<BoundsCache>());
  std::vector<std::vector<PatchId>> patches(4);
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    patches[extraordinary_corners(surface.kind(PatchId(p)))].push_back(PatchId(p));
  }
  std::vector<std::vector<Times>> results;
  for (std::size_t corners = 0; corners <= 3; ++corners) {
    const std::vector<PatchId>& some = patches[corners];
    if (some.empty()) continue;
    const auto count = static_cast<double>(some.size());
    Group group(title + ", " + std::to_string(corners) + " extraordinary corners, " +
                    std::to_string(some.size()) + " patches",
                "patch", options);
    std::vector<OffsetTriangle> triangles;
    BatchBounds rows(surface, some, BoundMethod::rows, 1), tables(surface, some, BoundMethod::table, 1);
    group.add(from_rows, count, [&] { return update(rows, mesh.points, triangles); });
    group.add(from_tables, count, [&] { return update(tables, mesh.points, triangles); });
    results.push_back(group.run());
  }
  return results;
}

ColdBounds cold_bounds(const ControlMesh& mesh) {
  const auto library = std::make_shared<BoundsCache>();
  const LimitSurface surface(mesh, catmark(), library);
  BatchBounds bounds(surface, {}, 1);
  std::vector<OffsetTriangle> out;
  return {update(bounds, mesh.points, out), surface.kind_count(), library->bytes()};
}

std::vector<Times> bench_creases(const std::string& title, const ControlMesh& mesh, const Options& options) {
  const auto count = static_cast<double>(mesh.face_count());
  Group group(title + ", " + std::to_string(mesh.face_count()) + " faces", "face", options);
  const LimitSurface surface(mesh, catmark(), std::make_shared<BoundsCache>());
  BatchBounds bounds(surface, {}, 1);
  std::vector<OffsetTriangle> out;
#ifdef SNUG_BENCH_OPENSUBDIV
  const std::vector<PatchId> faces = all_faces(mesh.face_count());
  const OsdMesh osd(mesh);
  const OsdSurfaces kept(osd, faces, true);
  group.add(bfr_cold, count, [&] {
    const OsdMesh fresh(mesh);
    return OsdSurfaces(fresh, faces, true).box_all();
  });
  group.add("Bfr: boxes alone", count, [&] { return kept.box_all(); });
#endif
  group.add(snug_cold, count, [&] { return cold_bounds(mesh).radii; });
  group.add("snug: bounds alone", count, [&] { return update(bounds, mesh.points, out); });
  return group.run();
}

}  // namespace snug::bench
