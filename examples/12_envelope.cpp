// A watertight mesh around a limit surface, at least a clearance and at most an error away, and its volume: 12_envelope MESH OUT

#include <cstdio>
#include <exception>

#include <snug/snug.h>

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: 12_envelope MESH OUT\n");
    return 2;
  }
  try {
    const snug::Surface surface = snug::load(argv[1]);
    const double error = 0.02 * surface.size();
    const snug::Envelope around = snug::envelope(surface, {.error = error});
    if (around.outcome != snug::Outcome::complete) return 5;
    std::printf("%zu triangles, from %g to %g away from the surface; it holds a volume of %.12g to %.12g\n",
                around.triangles.size(), around.clearance, around.error, around.volume.lower,
                around.volume.upper);
    snug::ControlMesh mesh;
    mesh.points = around.positions;
    for (const auto& [a, b, c] : around.triangles) {
      mesh.face_vertices.insert(mesh.face_vertices.end(),
                                {snug::VertexId(a), snug::VertexId(b), snug::VertexId(c)});
      mesh.face_offsets.push_back(static_cast<std::uint32_t>(mesh.face_vertices.size()));
    }
    mesh.tags.scheme = snug::Scheme::flat;
    snug::write_mesh(mesh, argv[2]);
    // Nobody needs to take our word for it.
    const snug::Surface facets(std::move(mesh));
    std::printf("the envelope and the surface: %s\n",
                snug::name_of(snug::collide(surface, facets, {.tolerance = 0}).verdict));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
