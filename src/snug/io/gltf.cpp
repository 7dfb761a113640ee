#include <snug/io/formats.h>
#include <snug/io/other_file.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include <support/binary.h>
#include <support/contract.h>
#include <support/error.h>
#include <support/number.h>

namespace snug {
namespace {

using Position = std::array<float, 3>;

constexpr std::size_t position_size = 12, index_size = 4;

[[noreturn]] void refuse(const std::string& name, const std::string& message) {
  throw InputError(InputProblem::refused, name + ": " + message);
}

/// Triangles of all the fans.
std::size_t count_triangles(const ControlMesh& mesh, const std::string& name, const Notes& notes) {
  bool polygons = false;
  for (std::size_t face = 0; face < mesh.face_count(); ++face) {
    const std::size_t corners = mesh.face(FaceId(face)).size();
    if (corners < 3)
      refuse(name, "face " + std::to_string(face) + " has " + std::to_string(corners) + " corners");
    polygons = polygons || corners > 3;
  }
  if (mesh.face_count() == 0) refuse(name, "the mesh has no faces, and glTF has no empty meshes");
  if (polygons && notes)
    notes(name + ": glTF holds triangles only: faces with more corners are split into fans");
  return mesh.face_vertices.size() - 2 * mesh.face_count();
}

void append_bounds(std::string& json, const std::vector<Position>& positions) {
  Position lower = positions[0], upper = positions[0];
  for (const Position& position : positions) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lower[axis] = std::min(lower[axis], position[axis]);
      upper[axis] = std::max(upper[axis], position[axis]);
    }
  }
  const auto append = [&](const char* key, const Position& corner) {
    json += key;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      json += axis == 0 ? '[' : ',';
      append_real(json, double{corner[axis]});
    }
    json += ']';
  };
  append(",\"min\":", lower);
  append(",\"max\":", upper);
}

// A view of the buffer, and what it holds.
void append_view(std::string& json, std::size_t begin, std::size_t size, const char* target) {
  json += begin == 0 ? "" : ",";
  json += "{\"buffer\":0,\"byteOffset\":";
  append_integer(json, begin);
  json += ",\"byteLength\":";
  append_integer(json, size);
  json += target;
}

/// `append_uri`: appends the URI of the buffer; empty for the chunk of a binary file.
std::string describe(const std::vector<Position>& positions, bool normals, std::size_t triangles,
                     const std::function<void(std::string&)>& append_uri) {
  constexpr const char *vertices = ",\"target\":34962}", *indices = ",\"target\":34963}";
  const std::size_t vector_bytes = positions.size() * position_size;
  const std::size_t index_bytes = 3 * triangles * index_size;
  const std::size_t vectors = (normals ? 2 : 1) * vector_bytes;
  std::string json = R"({"asset":{"version":"2.0","generator":"snug"},"scene":0,"scenes":[{"nodes":[0]}],)"
                     R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0)";
  json += normals ? R"(,"NORMAL":2},"indices":1,"mode":4}]}],)" : R"(},"indices":1,"mode":4}]}],)";
  json += R"("buffers":[{"byteLength":)";
  append_integer(json, vectors + index_bytes);
  if (append_uri) {
    json += R"(,"uri":")";
    append_uri(json);
    json += '"';
  }
  json += R"(}],"bufferViews":[)";
  append_view(json, 0, vector_bytes, vertices);
  append_view(json, vectors, index_bytes, indices);
  if (normals) append_view(json, vector_bytes, vector_bytes, vertices);
  json += R"(],"accessors":[{"bufferView":0,"componentType":5126,"count":)";  // float
  append_integer(json, positions.size());
  json += R"(,"type":"VEC3")";
  append_bounds(json, positions);
  json += R"(},{"bufferView":1,"componentType":5125,"count":)";  // unsigned int
  append_integer(json, 3 * triangles);
  json += R"(,"type":"SCALAR"})";
  if (normals) {
    json += R"(,{"bufferView":2,"componentType":5126,"count":)";
    append_integer(json, positions.size());
    json += R"(,"type":"VEC3"})";
  }
  json += "]}";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  return json;
}

std::size_t buffer_size(std::size_t vertices, std::size_t normals, std::size_t triangles) {
  return (vertices + normals) * position_size + 3 * triangles * index_size;
}

/// Calls put(number) for positions, normals and indices: whole words, nothing is left to pad.
template <class Put>
void put_buffer(const ControlMesh& mesh, const std::vector<Position>& positions,
                std::span<const Vector3> normals, const Put& put) {
  for (const Position& position : positions) {
    for (const float x : position) put(x);
  }
  for (const Vector3& normal : normals) {
    const Vector3 written = normal == Vector3{} ? Vector3{0, 0, 1} : normal;
    for (std::size_t axis = 0; axis < 3; ++axis) put(static_cast<float>(written[axis]));
  }
  for (std::size_t face = 0; face < mesh.face_count(); ++face) {
    const auto corners = mesh.face(FaceId(face));
    for (std::size_t corner = 2; corner < corners.size(); ++corner) {
      put(corners[0].value());
      put(corners[corner - 1].value());
      put(corners[corner].value());
    }
  }
}

}  // namespace

std::string format_glb(const ControlMesh& mesh, const std::string& name, const Notes& notes,
                       std::span<const Vector3> normals) {
  SNUG_EXPECT(normals.empty() || normals.size() == mesh.vertex_count());
  const std::size_t triangles = count_triangles(mesh, name, notes);
  const std::vector<Position> positions = in_single_precision(mesh.points, name, notes);
  const std::string json = describe(positions, !normals.empty(), triangles, {});
  const std::size_t buffer = buffer_size(positions.size(), normals.size(), triangles);
  const std::size_t size = glb_header_size + glb_chunk_head_size + json.size() + glb_chunk_head_size + buffer;
  if (size > std::numeric_limits<std::uint32_t>::max()) {
    refuse(name, "the mesh takes more than the 4 GiB of a binary glTF file: write PLY");
  }
  std::string bytes = "glTF";
  bytes.reserve(size);
  append_binary(bytes, std::uint32_t{2});
  append_binary(bytes, static_cast<std::uint32_t>(size));
  append_binary(bytes, static_cast<std::uint32_t>(json.size()));
  bytes += "JSON";
  bytes += json;
  append_binary(bytes, static_cast<std::uint32_t>(buffer));
  bytes.append("BIN\0", 4);
  put_buffer(mesh, positions, normals, [&](auto number) { append_binary(bytes, number); });
  return bytes;
}

std::string format_gltf(const ControlMesh& mesh, const std::string& name, const Notes& notes,
                        std::span<const Vector3> normals) {
  SNUG_EXPECT(normals.empty() || normals.size() == mesh.vertex_count());
  const std::size_t triangles = count_triangles(mesh, name, notes);
  const std::vector<Position> positions = in_single_precision(mesh.points, name, notes);
  return describe(positions, !normals.empty(), triangles, [&](std::string& json) {
    json.reserve(json.size() + buffer_size(positions.size(), normals.size(), triangles) / 3 * 4 + 1024);
    json += "data:application/octet-stream;base64,";
    constexpr std::size_t part_size = 3 * 4096;  // words and groups of base64 end with it
    std::string part;
    put_buffer(mesh, positions, normals, [&](auto number) {
      append_binary(part, number);
      if (part.size() < part_size) return;
      append_base64(json, part);
      part.clear();
    });
    append_base64(json, part);
  });
}

}  // namespace snug
