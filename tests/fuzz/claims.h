#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include <snug/mesh/control_mesh.h>
#include <support/error.h>

namespace snug::fuzz {

/// Ends the process, so that the fuzzer keeps the input, unless the claim holds.
inline void claim(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "claim does not hold: %s\n", what);
  std::abort();
}

/// Guarantees of every reader.
inline void claim_well_formed(const ControlMesh& mesh) {
  claim(!mesh.points.empty() && mesh.face_count() + mesh.polyline_count() > 0,
        "there are vertices, and faces or polylines");
  for (const Point3& point : mesh.points) claim(is_finite(point), "coordinates are finite");
  claim(mesh.face_offsets.front() == 0 && mesh.face_offsets.back() == mesh.face_vertices.size(),
        "offsets span the corners");
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    claim(mesh.face_offsets[f] < mesh.face_offsets[f + 1], "faces have corners");
  }
  for (const VertexId vertex : mesh.face_vertices) {
    claim(vertex.index() < mesh.vertex_count(), "corners name vertices");
  }
  claim(mesh.polyline_offsets.front() == 0 && mesh.polyline_offsets.back() == mesh.polyline_vertices.size(),
        "offsets span the polylines");
  for (std::size_t p = 0; p < mesh.polyline_count(); ++p) {
    claim(mesh.polyline_offsets[p] < mesh.polyline_offsets[p + 1], "polylines have vertices");
  }
  for (const VertexId vertex : mesh.polyline_vertices) {
    claim(vertex.index() < mesh.vertex_count(), "polylines name vertices");
  }
}

/// Bit by bit: 0 is not -0. Tags aside.
inline void claim_same(const ControlMesh& a, const ControlMesh& b) {
  claim(a.points.size() == b.points.size(), "a round trip keeps the number of vertices");
  for (std::size_t v = 0; v < a.points.size(); ++v) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      claim(
          std::bit_cast<std::uint64_t>(a.points[v][axis]) == std::bit_cast<std::uint64_t>(b.points[v][axis]),
          "a round trip keeps coordinates");
    }
  }
  claim(a.face_offsets == b.face_offsets && a.face_vertices == b.face_vertices, "a round trip keeps faces");
  claim(a.polyline_offsets == b.polyline_offsets && a.polyline_vertices == b.polyline_vertices,
        "a round trip keeps polylines");
}

/// The message of bad input is one printable line.
inline void claim_one_line(const InputError& error) {
  for (const char c : std::string_view(error.what()))
    claim(c >= ' ' && c <= '~', "messages are one printable line");
}

/// Reads the input and, if it is accepted, hands the mesh to `check`. Anything but InputError ends the
/// process.
template <class Parse, class Check>
void read_or_refuse(const std::uint8_t* data, std::size_t size, const Parse& parse, const Check& check) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    const ControlMesh mesh = parse(bytes);
    claim_well_formed(mesh);
    check(mesh);
  } catch (const InputError& error) {
    claim_one_line(error);
  }
}

}  // namespace snug::fuzz
