#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>

#include <snug/io/formats.h>
#include <snug/mesh.h>
#include <support/binary.h>
#include <support/number.h>

/// Files as other programs write them: the forms of PLY and STL that snug reads and does not write.
namespace snug::testing {

enum class PlyForm : std::uint8_t { ascii, little_endian, big_endian };

inline std::string big_endian_ply(const ControlMesh& mesh) {
  std::string file = format_ply(mesh);
  file.resize(file.find("end_header\n") + 11);
  file.replace(file.find("little"), 6, "big");
  const bool short_counts = file.find("list uchar") != std::string::npos;
  for (const Point3& point : mesh.points) {
    for (std::size_t axis = 0; axis < 3; ++axis) append_binary(file, point[axis], std::endian::big);
  }
  for (std::size_t face = 0; face < mesh.face_count(); ++face) {
    const auto corners = mesh.face(FaceId(face));
    if (short_counts) {
      file += static_cast<char>(corners.size());
    } else {
      append_binary(file, static_cast<std::uint32_t>(corners.size()), std::endian::big);
    }
    for (const VertexId v : corners) append_binary(file, v.value(), std::endian::big);
  }
  return file;
}

inline std::string ascii_ply(const ControlMesh& mesh) {
  std::string file = format_ply(mesh);
  file.resize(file.find("end_header\n") + 11);
  file.replace(file.find("binary_little_endian"), 20, "ascii");
  for (const Point3& point : mesh.points) {
    append_point(file, point);
    file += '\n';
  }
  for (std::size_t face = 0; face < mesh.face_count(); ++face) {
    const auto corners = mesh.face(FaceId(face));
    append_integer(file, corners.size());
    for (const VertexId v : corners) file += ' ' + std::to_string(v.value());
    file += '\n';
  }
  return file;
}

inline std::string ply_of(const ControlMesh& mesh, PlyForm form) {
  if (form == PlyForm::ascii) return ascii_ply(mesh);
  return form == PlyForm::big_endian ? big_endian_ply(mesh) : format_ply(mesh);
}

/// Of triangles; without normals.
inline std::string ascii_stl(const ControlMesh& mesh) {
  std::string text = "solid snug\n";
  for (std::size_t face = 0; face < mesh.face_count(); ++face) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const VertexId v : mesh.face(FaceId(face))) {
      text += "vertex ";
      append_point(text, mesh.points[v.index()]);
      text += '\n';
    }
    text += "endloop\nendfacet\n";
  }
  return text += "endsolid snug\n";
}

}  // namespace snug::testing
