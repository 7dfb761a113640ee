#include <snug/io/formats.h>

#include <array>
#include <bit>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include <support/binary.h>

#include <testing/files.h>

namespace snug::glb_test {
namespace {

using Ids = std::vector<std::uint32_t>;

std::uint32_t word_at(const std::string& bytes, std::size_t at) {
  return load<std::uint32_t>(bytes.data() + at, std::endian::little);
}

struct Container {
  nlohmann::json json;
  std::string binary;
};

/// Takes a file apart, and checks the rules of the container on the way.
Container open(const std::string& file) {
  EXPECT_EQ(file.substr(0, 4), "glTF");
  EXPECT_EQ(word_at(file, 4), 2u);
  EXPECT_EQ(word_at(file, 8), file.size());
  Container container;
  std::size_t at = 12;
  for (const char* type : {"JSON", "BIN"}) {
    const std::size_t size = word_at(file, at);
    EXPECT_EQ(size % 4, 0u);
    EXPECT_EQ(file.substr(at + 4, 4), std::string(type, 4));  // BIN ends with a NUL
    const std::string chunk = file.substr(at + 8, size);
    EXPECT_EQ(chunk.size(), size);
    if (type[0] == 'J') {
      container.json = nlohmann::json::parse(chunk);
    } else {
      container.binary = chunk;
    }
    at += 8 + size;
  }
  EXPECT_EQ(at, file.size());
  return container;
}

/// The bytes of an accessor, whose sizes must agree with one another.
std::string accessor_bytes(const Container& container, std::size_t number, std::size_t element_size) {
  const auto& accessor = container.json["accessors"][number];
  const auto& view = container.json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
  EXPECT_EQ(view["buffer"], 0);
  EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0u);
  EXPECT_EQ(view["byteLength"], accessor["count"].get<std::size_t>() * element_size);
  EXPECT_LE(view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>(),
            container.binary.size());
  return container.binary.substr(view["byteOffset"], view["byteLength"]);
}

Ids indices(const Container& container) {
  const std::string bytes = accessor_bytes(container, 1, 4);
  Ids result;
  for (std::size_t at = 0; at < bytes.size(); at += 4) result.push_back(word_at(bytes, at));
  return result;
}

ControlMesh house() {
  ControlMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.1}, {0.5, 2, -0.3}, {0, 1, 0}};
  const auto add = [&](const Ids& ids) { mesh.add_face(std::vector<VertexId>(ids.begin(), ids.end())); };
  add({0, 1, 2, 3, 4});
  add({0, 4, 1});
  return mesh;
}

TEST(glb, is_a_container_of_positions_and_fans) {
  std::vector<std::string> notes;
  const std::string file =
      format_glb(house(), "out.glb", [&](const std::string& line) { notes.push_back(line); });
  const Container container = open(file);
  const nlohmann::json& json = container.json;
  EXPECT_EQ(json["asset"]["version"], "2.0");
  EXPECT_EQ(json["scenes"][json["scene"].get<std::size_t>()]["nodes"], nlohmann::json::array({0}));
  EXPECT_EQ(json["nodes"][0]["mesh"], 0);
  const auto& primitive = json["meshes"][0]["primitives"][0];
  EXPECT_EQ(primitive["mode"], 4);
  EXPECT_EQ(primitive["attributes"]["POSITION"], 0);
  EXPECT_EQ(primitive["indices"], 1);
  EXPECT_EQ(json["buffers"][0]["byteLength"], container.binary.size());
  EXPECT_EQ(json["accessors"][0]["componentType"], 5126);
  EXPECT_EQ(json["accessors"][0]["type"], "VEC3");
  EXPECT_EQ(json["accessors"][1]["componentType"], 5125);
  EXPECT_EQ(json["accessors"][1]["type"], "SCALAR");
  EXPECT_EQ(json["bufferViews"][0]["target"], 34962);
  EXPECT_EQ(json["bufferViews"][1]["target"], 34963);
  EXPECT_EQ(indices(container), (Ids{0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1}));

  const std::string positions = accessor_bytes(container, 0, 12);
  const ControlMesh mesh = house();
  ASSERT_EQ(positions.size(), 12 * mesh.vertex_count());
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(load<float>(positions.data() + 12 * v + 4 * axis, std::endian::little),
                static_cast<float>(mesh.points[v][axis]));
    }
  }
  EXPECT_EQ(notes.size(), 2u);  // fans, and rounding
}

TEST(glb, bounds_are_exactly_those_of_the_stored_floats) {
  const Container container = open(format_glb(house(), "out.glb"));
  const auto& accessor = container.json["accessors"][0];
  EXPECT_EQ(accessor["min"].get<std::vector<double>>(), (std::vector<double>{0, 0, double{-0.3f}}));
  EXPECT_EQ(accessor["max"].get<std::vector<double>>(), (std::vector<double>{1, 2, double{0.1f}}));
}

TEST(glb, chunks_are_padded_whatever_the_length_of_the_numbers) {
  ControlMesh mesh;
  for (int digits = 0; digits < 9; ++digits) {
    const double x = std::pow(10.0, digits);
    mesh.points = {{0, 0, 0}, {x, 0, 0}, {0, 1, 0}};
    mesh.face_vertices.clear();
    mesh.face_offsets = {0};
    mesh.add_face(std::vector{VertexId(0), VertexId(1), VertexId(2)});
    EXPECT_EQ(open(format_glb(mesh, "out.glb")).json["accessors"][0]["max"][0], x);
  }
}

TEST(glb, triangles_of_floats_need_no_notes) {
  ControlMesh mesh;
  mesh.points = {{0, 0, 0}, {0.5, 0, 0}, {0, 1, 0}};
  mesh.add_face(std::vector{VertexId(0), VertexId(1), VertexId(2)});
  EXPECT_FALSE(format_glb(mesh, "out.glb", [](const std::string& line) { ADD_FAILURE() << line; }).empty());
}

TEST(glb, holds_normals_of_length_1) {
  ControlMesh mesh;
  mesh.points = {{0, 0, 0}, {0.5, 0, 0}, {0, 1, 0}};
  mesh.add_face(std::vector{VertexId(0), VertexId(1), VertexId(2)});
  const std::vector<Vector3> normals{{1, 0, 0}, {0, 0, 0}, {0, -1, 0}};
  const Container container = open(format_glb(mesh, "out.glb", {}, normals));
  const auto& attributes = container.json["meshes"][0]["primitives"][0]["attributes"];
  const std::string bytes = accessor_bytes(container, attributes["NORMAL"], 12);
  const std::vector<float> wanted{1, 0, 0, 0, 0, 1, 0, -1, 0};
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_EQ(std::bit_cast<float>(word_at(bytes, 4 * i)), wanted[i]);
  }
  EXPECT_EQ(accessor_bytes(container, attributes["POSITION"], 12).size(), 36u);
  EXPECT_EQ(accessor_bytes(container, container.json["meshes"][0]["primitives"][0]["indices"], 4).size(),
            12u);
}

TEST(glb, refuses_what_it_cannot_hold) {
  const auto refusal = [](const ControlMesh& mesh) -> std::string {
    try {
      static_cast<void>(format_glb(mesh, "out.glb"));
    } catch (const InputError& error) {
      EXPECT_EQ(error.problem(), InputProblem::refused);
      return error.what();
    }
    return "nothing was thrown";
  };
  ControlMesh mesh = house();
  mesh.points[3].x = 1e39;
  EXPECT_EQ(refusal(mesh), "out.glb: vertex 3 is too far out for single precision: write PLY, OBJ or OFF");
  mesh = house();
  mesh.add_face(std::vector{VertexId(0), VertexId(1)});
  EXPECT_EQ(refusal(mesh), "out.glb: face 2 has 2 corners");
  EXPECT_EQ(refusal(ControlMesh{}), "out.glb: the mesh has no faces, and glTF has no empty meshes");
}

}  // namespace
}  // namespace snug::glb_test
