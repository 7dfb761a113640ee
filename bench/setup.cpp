// bench_setup: from connectivity and positions in memory to a bound of every face, nothing known beforehand.

#include <cstdio>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "meshes.h"
#include "runner.h"
#include "subject.h"
#ifdef SNUG_BENCH_OPENSUBDIV
#include "peer_opensubdiv.h"
#endif

namespace {

using namespace snug;
using namespace snug::bench;

struct Work {
  std::string name;
  std::function<double()> run;
};

// Ten points a face: corners, thirds of the edges, the centre.
std::vector<TriangleParameter> ten_points() {
  std::vector<TriangleParameter> points;
  for (int j = 0; j <= 3; ++j) {
    for (int i = 0; i + j <= 3; ++i) points.push_back({i / 3.0, j / 3.0});
  }
  return points;
}

std::vector<Work> works(const ControlMesh& mesh) {
  std::vector<Work> all;
  all.push_back({"snug: offset triangles of all faces", [&mesh] {
                   Subject subject(mesh);
                   std::vector<OffsetTriangle> out;
                   return subject.enclose_all(out);
                 }});
  all.push_back(
      {"snug: surface alone", [&mesh] { return static_cast<double>(Subject(mesh).surface().kind_count()); }});
#ifdef SNUG_BENCH_OPENSUBDIV
  for (const bool cache : {true, false}) {
    all.push_back({cache ? "Bfr: surfaces, with cache" : "Bfr: surfaces, no cache", [&mesh, cache] {
                     const OsdMesh osd(mesh);
                     return OsdSurfaces(osd, all_faces(mesh.face_count()), cache).patch_points();
                   }});
  }
  all.push_back({"Bfr: surfaces and boxes (no proof)", [&mesh] {
                   const OsdMesh osd(mesh);
                   return OsdSurfaces(osd, all_faces(mesh.face_count()), true).box_all();
                 }});
  all.push_back({"Far: limit stencils, 10 points, level 2", [&mesh] {
                   return static_cast<double>(OsdStencils::limit(mesh, ten_points(), 2).weights());
                 }});
  all.push_back({"Far: topology alone", [&mesh] {
                   const OsdMesh osd(mesh);
                   return static_cast<double>(mesh.face_count());
                 }});
#endif
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = start(argc, argv, 0, "");
  const ControlMesh mesh = irregular_mesh(options.size(100'000, 2'000));
  const auto faces = static_cast<double>(mesh.face_count());
  const std::vector<Work> all = works(mesh);

  std::printf("peak memory beside the mesh, each in a process of its own\n");
  for (const Work& work : all) print_peak(work.name, faces, "face", peak_mib(work.run));

  print_statistics("irregular", Subject(mesh).surface());
  Group group("time from the mesh in memory", "face", options);
  for (const Work& work : all) group.add(work.name, faces, work.run);
  group.run();
  return 0;
}
