#include <snug/io/formats.h>

#include <array>
#include <clocale>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include <snug/io/other_file.h>
#include <support/binary.h>
#include <support/number.h>

#include <testing/files.h>

namespace snug::parse_gltf_test {
namespace {

using nlohmann::json;
using testing::corners;
using testing::expect_same_arrays;
using testing::unreadable;

using Ids = std::vector<std::uint32_t>;

std::string container(const std::string& text, const std::string& binary) {
  std::string padded = text;
  padded.resize((text.size() + 3) / 4 * 4, ' ');
  std::string bytes = "glTF";
  append_binary(bytes, std::uint32_t{2});
  append_binary(bytes, static_cast<std::uint32_t>(12 + 8 + padded.size() + 8 + binary.size()));
  append_binary(bytes, static_cast<std::uint32_t>(padded.size()));
  bytes += "JSON" + padded;
  append_binary(bytes, static_cast<std::uint32_t>(binary.size()));
  bytes.append("BIN\0", 4);
  return bytes + binary;
}

/// A file that grows by values: views, accessors, and one primitive that a test may change.
class File {
 public:
  json text{{"asset", {{"version", "2.0"}}},
            {"scene", 0},
            {"scenes", {{{"nodes", {0}}}}},
            {"nodes", {{{"mesh", 0}}}},
            {"meshes", {{{"primitives", json::array({json{{"attributes", json::object()}}})}}}},
            {"accessors", json::array()},
            {"bufferViews", json::array()}};
  std::string binary;

  template <class Number>
  std::size_t view(const std::vector<Number>& values, std::size_t stride = 0) {
    json own{{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", values.size() * sizeof(Number)}};
    if (stride) own["byteStride"] = stride;
    for (const Number value : values) append_binary(binary, value);
    text["bufferViews"].push_back(own);
    return text["bufferViews"].size() - 1;
  }
  std::size_t accessor(std::size_t view, unsigned component, std::size_t count, const char* type) {
    text["accessors"].push_back(
        {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
    return text["accessors"].size() - 1;
  }
  void positions(const std::vector<float>& values) {
    primitive()["attributes"]["POSITION"] = accessor(view(values), 5126, values.size() / 3, "VEC3");
  }
  template <class Number>
  void indices(const std::vector<Number>& values, unsigned component) {
    primitive()["indices"] = accessor(view(values), component, values.size(), "SCALAR");
  }
  json& primitive() { return text["meshes"][0]["primitives"][0]; }
  json& node(std::size_t n = 0) { return text["nodes"][n]; }

  [[nodiscard]] std::string bytes() const {
    json whole = text;
    if (!whole.contains("buffers")) whole["buffers"] = {{{"byteLength", binary.size()}}};
    return container(whole.dump(), binary);
  }
  [[nodiscard]] ControlMesh read(const Notes& notes = {}) const {
    return parse_gltf(bytes(), "in.glb", {}, notes);
  }
  [[nodiscard]] std::string refusal() const {
    return unreadable([&] { static_cast<void>(read()); });
  }
  [[nodiscard]] std::vector<std::string> notes() const {
    std::vector<std::string> lines;
    static_cast<void>(read([&](const std::string& line) { lines.push_back(line); }));
    return lines;
  }
};

/// A triangle of a node whose text has these members, too.
std::string bytes_with(const std::string& members) {
  File file;
  file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  file.text["buffers"] = {{{"byteLength", file.binary.size()}}};
  std::string whole = file.text.dump();
  const std::string plain = "\"mesh\":0";
  whole.replace(whole.find(plain), plain.size(), plain + members);
  return container(whole, file.binary);
}
ControlMesh read_with(const std::string& members) { return parse_gltf(bytes_with(members), "in.glb"); }
std::string refusal_with(const std::string& members) {
  return unreadable([&] { static_cast<void>(read_with(members)); });
}

/// Five corners of a strip in the plane.
File strip() {
  File file;
  file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0.1f});
  return file;
}

std::vector<Ids> faces(const ControlMesh& mesh) {
  std::vector<Ids> all;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) all.push_back(corners(mesh, f));
  return all;
}

TEST(parse_gltf, reads_back_what_is_written) {
  ControlMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0.5}, {0.25, 3, -2}};
  for (const auto& f : {Ids{0, 1, 2}, Ids{0, 3, 1}, Ids{1, 3, 2}}) {
    mesh.add_face(std::vector<VertexId>(f.begin(), f.end()));
  }
  expect_same_arrays(mesh, parse_gltf(format_glb(mesh, "a.glb"), "a.glb"));
  const std::vector<Vector3> normals(4, {0, 0, 1});
  expect_same_arrays(mesh, parse_gltf(format_glb(mesh, "a.glb", {}, normals), "a.glb"));
}

TEST(parse_gltf, lists_strips_and_fans_turn_as_the_specification_says) {
  File file = strip();
  file.indices<std::uint16_t>({0, 1, 2, 2, 1, 3}, 5123);
  EXPECT_EQ(faces(file.read()), (std::vector{Ids{0, 1, 2}, Ids{2, 1, 3}}));
  file = strip();
  file.primitive()["mode"] = 5;
  EXPECT_EQ(faces(file.read()), (std::vector{Ids{0, 1, 2}, Ids{1, 3, 2}, Ids{2, 3, 4}}));
  file.primitive()["mode"] = 6;  // vertices are numbered as they are met
  EXPECT_EQ(file.read().points[0], (Point3{1, 0, 0}));
  EXPECT_EQ(faces(file.read()), (std::vector{Ids{0, 1, 2}, Ids{1, 3, 2}, Ids{3, 4, 2}}));
}

TEST(parse_gltf, indices_may_be_of_8_16_and_32_bits_or_none) {
  const auto with = [](const auto& add) {
    File file = strip();
    add(file);
    return faces(file.read());
  };
  const std::vector<Ids> wanted{Ids{0, 1, 2}};
  EXPECT_EQ(with([](File& f) { f.indices<std::uint8_t>({1, 3, 2}, 5121); }), wanted);
  EXPECT_EQ(with([](File& f) { f.indices<std::uint16_t>({1, 3, 2}, 5123); }), wanted);
  EXPECT_EQ(with([](File& f) { f.indices<std::uint32_t>({1, 3, 2}, 5125); }), wanted);
  File file;
  file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
  EXPECT_EQ(faces(file.read()), (std::vector{Ids{0, 1, 2}, Ids{1, 3, 2}}));  // welded
}

TEST(parse_gltf, reads_interleaved_and_sparse_accessors) {
  File file;
  const std::size_t view = file.view<float>({9, 0, 0, 0, 9, 1, 0, 0, 9, 0, 1, 0}, 16);
  file.primitive()["attributes"]["POSITION"] = file.accessor(view, 5126, 3, "VEC3");
  file.text["accessors"][0]["byteOffset"] = 4;
  EXPECT_EQ(file.read().points, (std::vector<Point3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  file.text["bufferViews"][0]["byteStride"] = 32;  // two fit
  EXPECT_EQ(file.refusal(), "in.glb: glTF: an accessor of 3 elements ends beyond its buffer view");
  file.text["bufferViews"][0]["byteStride"] = 16;
  const std::size_t places = file.view<std::uint8_t>({2, 0, 0, 0}), values = file.view<float>({5, 6, 7});
  file.text["accessors"][0]["sparse"] = {{"count", 1},
                                         {"indices", {{"bufferView", places}, {"componentType", 5121}}},
                                         {"values", {{"bufferView", values}}}};
  EXPECT_EQ(file.read().points[2], (Point3{5, 6, 7}));
  // Without a view all other elements are zero.
  File zeros;
  const std::size_t two = zeros.view<std::uint16_t>({1, 2}), news = zeros.view<float>({5, 6, 7, 8, 9, 10});
  zeros.text["accessors"].push_back({{"componentType", 5126},
                                     {"count", 3},
                                     {"type", "VEC3"},
                                     {"sparse",
                                      {{"count", 2},
                                       {"indices", {{"bufferView", two}, {"componentType", 5123}}},
                                       {"values", {{"bufferView", news}}}}}});
  zeros.primitive()["attributes"]["POSITION"] = 0;
  EXPECT_EQ(zeros.read().points, (std::vector<Point3>{{0, 0, 0}, {5, 6, 7}, {8, 9, 10}}));
}

TEST(parse_gltf, quantized_positions_are_integers_or_parts_of_the_largest) {
  File file;
  const std::size_t view = file.view<std::int8_t>({0, 0, 0, 0, 127, 0, 0, 0, -128, 64, 0, 0}, 4);
  file.primitive()["attributes"]["POSITION"] = file.accessor(view, 5120, 3, "VEC3");
  file.text["extensionsRequired"] = {"KHR_mesh_quantization"};
  EXPECT_EQ(file.read().points, (std::vector<Point3>{{0, 0, 0}, {127, 0, 0}, {-128, 64, 0}}));
  file.text["accessors"][0]["normalized"] = true;
  EXPECT_EQ(file.read().points, (std::vector<Point3>{{0, 0, 0}, {1, 0, 0}, {-1, 64.0 / 127, 0}}));
}

TEST(parse_gltf, nodes_move_their_meshes) {
  File file = strip();
  file.indices<std::uint8_t>({0, 1, 2}, 5121);
  file.text["nodes"] = json::array(
      {{{"children", {1}}, {"translation", {0, 0, 5}}},
       {{"mesh", 0}, {"translation", {10, 0, 0}}, {"rotation", {0, 0, 1, 0}}, {"scale", {2, 1, 1}}}});
  // Scaled, turned by half a turn about z, moved; then moved by the node above.
  const ControlMesh mesh = file.read();
  EXPECT_NEAR(mesh.points[1].x, 8, 1e-14);
  EXPECT_NEAR(mesh.points[2].y, -1, 1e-14);
  EXPECT_EQ(mesh.points[0].z, 5);
  EXPECT_EQ(corners(mesh, 0), (Ids{0, 1, 2}));
  EXPECT_EQ(file.notes().size(), 1u);
  // Columns of a matrix: a mirror, and a move.
  file.node(1) = {{"mesh", 0}, {"matrix", {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 0, 0, 1}}};
  EXPECT_EQ(file.read().points[1], (Point3{6, 0, 5}));
  EXPECT_EQ(corners(file.read(), 0), (Ids{0, 2, 1}));
}

TEST(parse_gltf, equal_corners_are_welded_within_a_node) {
  File file;
  // Two triangles beside each other, of two primitives.
  file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const std::size_t other = file.accessor(file.view<float>({1, 0, 0, 1, 1, 0, -0.0f, 1, 0}), 5126, 3, "VEC3");
  file.text["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", other}}}});
  EXPECT_EQ(faces(file.read()), (std::vector{Ids{0, 1, 2}, Ids{1, 3, 2}}));
  // As two nodes they stay apart.
  file.text["meshes"] =
      json::array({{{"primitives", json::array({{{"attributes", {{"POSITION", 0}}}}})}},
                   {{"primitives", json::array({{{"attributes", {{"POSITION", other}}}}})}}});
  file.text["nodes"] = json::array({{{"mesh", 0}}, {{"mesh", 1}}});
  file.text["scenes"][0]["nodes"] = {1, 0};
  EXPECT_EQ(faces(file.read()), (std::vector{Ids{0, 1, 2}, Ids{3, 4, 5}}));
  EXPECT_EQ(file.read().points[1], (Point3{1, 1, 0}));  // in the order of the scene
}

TEST(parse_gltf, scenes_say_which_nodes_count) {
  File file = strip();
  file.indices<std::uint8_t>({0, 1, 2}, 5121);
  file.text["nodes"] = json::array({{{"mesh", 0}}, {{"mesh", 0}, {"children", {2}}}, {{"mesh", 0}}});
  file.text["scenes"] = json::array({{{"nodes", {0}}}, {{"nodes", {1}}}});
  EXPECT_EQ(file.read().face_count(), 1u);
  file.text["scene"] = 1;
  EXPECT_EQ(file.read().face_count(), 2u);
  file.text.erase("scene");
  EXPECT_EQ(file.read().face_count(), 1u);
  file.text.erase("scenes");
  EXPECT_EQ(file.read().face_count(), 3u);
}

TEST(parse_gltf, what_makes_no_triangles_is_left_out_with_a_note) {
  File file = strip();
  file.indices<std::uint8_t>({0, 1, 2, 2, 2, 3}, 5121);
  EXPECT_EQ(file.read().face_count(), 1u);
  EXPECT_EQ(file.notes(),
            (std::vector<std::string>{"in.glb: 1 triangles with two corners in one place are left "
                                      "out: faces are numbered without them"}));
  file = strip();
  file.indices<std::uint8_t>({0, 1, 2}, 5121);
  json line = file.primitive();
  line["mode"] = 1;
  file.text["meshes"][0]["primitives"].push_back(line);
  EXPECT_EQ(file.notes(),
            (std::vector<std::string>{"in.glb: 1 primitives are left out: they contain no triangles"}));
  file.node()["skin"] = 0;
  EXPECT_EQ(file.notes().back(), "in.glb: skins and morph targets are not applied");
  file.text["nodes"][0].erase("mesh");
  EXPECT_EQ(file.refusal(), "in.glb: the file has no triangles in its scene");
}

TEST(parse_gltf, faults_name_what_is_wrong) {
  const auto changed = [](const auto& change) {
    File file = strip();
    file.indices<std::uint8_t>({0, 1, 2, 0}, 5121);
    file.text["accessors"][1]["count"] = 3;
    change(file);
    return file.refusal();
  };
  EXPECT_EQ(changed([](File& f) { f.text["asset"]["version"] = "1.0"; }),
            "in.glb: glTF: only version 2.0 is read");
  EXPECT_EQ(changed([](File& f) { f.text["extensionsRequired"] = {"KHR_draco_mesh_compression"}; }),
            "in.glb: glTF: the extension 'KHR_draco_mesh_compression' is needed: write the file without it");
  EXPECT_EQ(changed([](File& f) {
              f.text["buffers"] = {{{"byteLength", 100}, {"uri", "a.bin"}}};
            }),
            "in.glb: glTF: buffer 0 is in the file 'a.bin', which is not at hand: give the path of the file, "
            "or write one "
            ".glb file with all in it");
  EXPECT_EQ(changed([](File& f) { f.text["accessors"][0]["count"] = 6; }),
            "in.glb: glTF: an accessor of 6 elements ends beyond its buffer view");
  EXPECT_EQ(changed([](File& f) { f.text["accessors"][0]["byteOffset"] = 1; }),
            "in.glb: glTF: an accessor of 5 elements ends beyond its buffer view");
  EXPECT_EQ(changed([](File& f) { f.text["accessors"][0]["count"] = 1e15; }),
            "in.glb: glTF: accessor 0 counts more than the file can hold");
  EXPECT_EQ(changed([](File& f) { f.text["accessors"][0]["count"] = 2.5; }),
            "in.glb: glTF: 'count' is not a whole number >= 0");
  EXPECT_EQ(changed([](File& f) { f.text["accessors"][0]["type"] = "VEC2"; }),
            "in.glb: glTF: accessor 0 is not of the type VEC3");
  EXPECT_EQ(changed([](File& f) { f.text["accessors"][1]["componentType"] = 5126; }),
            "in.glb: glTF: an accessor of 3 elements ends beyond its buffer view");
  EXPECT_EQ(changed([](File& f) { f.text["accessors"][1]["componentType"] = 5120; }),
            "in.glb: glTF: accessor 1: indices are not whole numbers from 0");
  EXPECT_EQ(changed([](File& f) { f.text["accessors"][1]["count"] = 4; }),
            "in.glb: glTF: 4 corners are not a multiple of 3");
  EXPECT_EQ(changed([](File& f) { f.text["bufferViews"][1]["byteOffset"] = 61; }),
            "in.glb: glTF: buffer view 1 ends beyond its buffer: the file is truncated");
  EXPECT_EQ(changed([](File& f) { f.binary[61] = 7; }),
            "in.glb: glTF: node 0: index 7 names none of 5 vertices");
  EXPECT_EQ(changed([](File& f) { f.binary[3] = 0x7f, f.binary[2] = '\x80'; }),
            "in.glb: glTF: vertex 0 of accessor 0: a coordinate is not a finite number");
  EXPECT_EQ(changed([](File& f) { f.node()["children"] = {0}; }),
            "in.glb: glTF: node 0 is met twice: nodes must form trees");
  EXPECT_EQ(changed([](File& f) { f.node()["mesh"] = 3; }),
            "in.glb: glTF: 'meshes' has no number 3: it counts 1");
  EXPECT_EQ(changed([](File& f) {
              f.node()["scale"] = {1, 2};
            }),
            "in.glb: glTF: 'scale' of node 0 has 2 numbers, not three");
  EXPECT_EQ(
      changed([](File& f) {
        f.node()["rotation"] = {0, 0, 0, 0};
      }),
      "in.glb: glTF: 'rotation' of node 0 is a quaternion of another length than 1: write w, x, y, z of a "
      "rotation");
}

/// Decimals that are read wrong where they pass through a float, a long double or 17 digits.
std::vector<std::string> hard_decimals() {
  std::vector<std::string> words{"0",
                                 "-0",
                                 "0.1",
                                 "-1.5e3",
                                 "5e-324",
                                 "2.4703282292062328e-324",
                                 "2.4703282292062327e-324",
                                 "2.2250738585072011e-308",
                                 "1e-400",
                                 "1e308",
                                 "9007199254740993",
                                 "-9007199254740993",
                                 "9223372036854775809",
                                 "18446744073709551615",
                                 "18446744073709551617",
                                 "100000000000000000000000000000000000001"};
  // Half way between 1 and the double above it, and a hair over; likewise below the least subnormal.
  const std::string half = "1.00000000000000011102230246251565404236316680908203125";
  words.push_back(half);
  words.push_back(half + std::string(400, '0') + '1');
  words.push_back("0." + std::string(400, '0') + "123456789e100");
  words.push_back("1" + std::string(400, '0') + "e-400");
  return words;
}

void expect_nearest_doubles() {
  for (const std::string& word : hard_decimals()) {
    const ControlMesh mesh = read_with(",\"translation\":[" + word + ",0,0]");
    EXPECT_EQ(mesh.points[0].x, parse_real(word).value) << word;
  }
}

TEST(parse_gltf, numbers_are_the_nearest_doubles) { expect_nearest_doubles(); }

TEST(parse_gltf, numbers_do_not_depend_on_the_locale) {
  const std::string before = std::setlocale(LC_NUMERIC, nullptr);
  const char* found = nullptr;
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "ru_RU.UTF-8", "pl_PL.UTF-8"}) {
    if (!found) found = std::setlocale(LC_NUMERIC, name);
  }
  if (!found) GTEST_SKIP() << "no locale with a decimal comma is installed";
  EXPECT_STREQ(std::localeconv()->decimal_point, ",");
  expect_nearest_doubles();
  std::setlocale(LC_NUMERIC, before.c_str());
}

TEST(parse_gltf, text_that_is_not_json_is_refused) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {",\"a\":[1,]", "unexpected ']'"},
      {",\"a\" 1", "expected ':'"},
      {",1:2", "expected string literal"},
      {",\"a\":nul", "invalid literal"},
      {",\"a\":01", "unexpected number literal"},
      {",\"a\":1.", "expected digit after '.'"},
      {",\"a\":+1", "invalid literal"},
      {",\"a\":NaN", "invalid literal"},
      {",\"a\":1e999", "number overflow"},
      {",\"a\":-" + std::string(100'000, '9'), "number overflow"},
      {",\"a\":\"\\q\"", "forbidden character after backslash"},
      {",\"a\":\"\\ud800\"", "must be followed by U+DC00"},
      {",\"a\":\"\xff\"", "ill-formed UTF-8"},
      {",\"a\":\"\n\"", "control character"},
      {"}]}1", "end of input"},
      {std::string(",\"a\":\0 1", 8), "zero"}};
  for (const auto& [members, part] : cases) {
    const std::string message = refusal_with(members);
    EXPECT_TRUE(message.starts_with("in.glb: glTF: ")) << members;
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_LT(message.size(), 250u) << message;
  }
}

TEST(parse_gltf, zeros_do_not_end_the_text) {
  const std::string text = R"({"asset": {"version": "2.0"}})";
  for (const std::string& whole : {text + '\0', text + std::string("\0]", 2), '\0' + text}) {
    const std::string message =
        unreadable([&] { static_cast<void>(parse_gltf(container(whole, ""), "in.glb")); });
    EXPECT_EQ(message,
              "in.glb: glTF: byte " + std::to_string(whole.find('\0')) + " of the JSON text is zero");
  }
}

TEST(parse_gltf, escapes_are_decoded_and_the_last_of_equal_names_counts) {
  EXPECT_EQ(read_with(R"(,"translation":[1,0,0],"tr\u0061nslation":[2,0,0])").points[0].x, 2);
  EXPECT_EQ(read_with(R"(,"translation":"none","translation":[3,0,0])").points[0].x, 3);
}

TEST(parse_gltf, text_may_be_nested_deep_and_long) {
  const std::size_t depth = 200'000;
  EXPECT_EQ(read_with(",\"extras\":" + std::string(depth, '[') + std::string(depth, ']')).face_count(), 1u);
  EXPECT_NE(refusal_with(",\"extras\":" + std::string(depth, '[')).find("unexpected"), std::string::npos);
  std::string many = ",\"extras\":{";
  for (std::size_t i = 0; i < depth; ++i) many += '"' + std::to_string(i) + "\":[{}],";
  EXPECT_EQ(read_with(many + "\"\":0}").face_count(), 1u);
}

TEST(parse_gltf, values_of_another_kind_are_refused) {
  for (const char* value : {"1", "\"1\"", "null", "{\"a\":1}", "[1,2]", "[1,2,\"3\"]", "[1,2,null]"}) {
    const std::string message = refusal_with(std::string(",\"scale\":") + value);
    EXPECT_TRUE(message.starts_with("in.glb: glTF: 'scale' of node 0 ")) << value << ": " << message;
  }
  for (const char* value : {"-1", "1.5", "\"0\"", "1e300", "null", "[0]", "true"}) {
    const std::string message = refusal_with(std::string(",\"mesh\":") + value);
    EXPECT_EQ(message, "in.glb: glTF: 'mesh' is not a whole number >= 0") << value;
  }
  EXPECT_EQ(refusal_with(",\"children\":7"), "in.glb: glTF: 'children' is not a list");
  for (const char* whole : {"[]", "7", "null", "\"a\"", R"({"asset": 2})", R"({"asset": {"version": 2}})"}) {
    EXPECT_EQ(unreadable([&] { static_cast<void>(parse_gltf(container(whole, ""), "in.glb")); }),
              "in.glb: glTF: only version 2.0 is read");
  }
}

TEST(parse_gltf, instances_are_bounded) {
  File file = strip();
  file.indices<std::uint8_t>(
      [] {
        std::vector<std::uint8_t> corners;
        for (int t = 0; t < 1000; ++t) corners.insert(corners.end(), {0, 1, 2});
        return corners;
      }(),
      5121);
  file.text["nodes"] = json::array();
  file.text["scenes"][0]["nodes"] = json::array();
  for (int n = 0; n < 4000; ++n) {
    file.text["nodes"].push_back({{"mesh", 0}});
    file.text["scenes"][0]["nodes"].push_back(n);
  }
  EXPECT_EQ(
      file.refusal(),
      "in.glb: glTF: instances or shared values make more than 100 times the file: write fewer of them");
}

TEST(parse_gltf, containers_must_be_whole) {
  File file = strip();
  file.indices<std::uint8_t>({0, 1, 2}, 5121);
  const std::string bytes = file.bytes();
  for (std::size_t size = 0; size < bytes.size(); size += 7) {
    EXPECT_FALSE(unreadable([&] { static_cast<void>(parse_gltf(bytes.substr(0, size), "in.glb")); }).empty());
  }
  const auto refusal = [](const std::string& text) {
    return unreadable([&] { static_cast<void>(parse_gltf(text, "in.glb")); });
  };
  EXPECT_EQ(refusal("OFF\n"), "in.glb: this is not a glTF file: it begins neither with 'glTF' nor with '{'");
  EXPECT_EQ(refusal(bytes + "x"), "in.glb: glTF: the file declares " + std::to_string(bytes.size()) +
                                      " bytes, but has " + std::to_string(bytes.size() + 1));
  EXPECT_EQ(refusal("glTF" + std::string("\1\0\0\0", 4) + bytes.substr(8)),
            "in.glb: glTF: version 1 is not read: write version 2");
}

// --- text, and buffers in other places

std::string text_of(const File& file, const json& buffer) {
  json whole = file.text;
  whole["buffers"] = json::array({buffer});
  return whole.dump(2);
}
std::string data_uri(const std::string& bytes) {
  std::string uri = "data:application/octet-stream;base64,";
  append_base64(uri, bytes);
  return uri;
}
File plain() {
  File file = strip();
  file.indices<std::uint8_t>({0, 1, 2, 2, 1, 3, 4}, 5121);  // 67 bytes
  file.text["accessors"][1]["count"] = 6;
  return file;
}

TEST(parse_gltf, text_holds_its_buffer_or_names_a_file) {
  const File file = plain();
  const ControlMesh wanted = file.read();
  const std::size_t size = file.binary.size();
  const std::string inside = text_of(file, {{"byteLength", size}, {"uri", data_uri(file.binary)}});
  expect_same_arrays(wanted, parse_gltf(inside, "in.gltf"));
  expect_same_arrays(wanted, parse_gltf("\xEF\xBB\xBF" + inside, "in.gltf"));
  EXPECT_EQ(parse_gltf(inside, "in.gltf").metres_per_unit, 1.0);
  std::vector<std::string> asked;
  const OtherFiles files = [&](const std::string& path) {
    asked.push_back(path);
    return file.binary;
  };
  const std::string outside = text_of(file, {{"byteLength", size}, {"uri", "a%20b/./c.bin"}});
  expect_same_arrays(wanted, parse_gltf(outside, "in.gltf", files));
  EXPECT_EQ(asked, (std::vector<std::string>{"a b/./c.bin"}));  // once
}

TEST(parse_gltf, buffers_that_are_not_there_are_refused) {
  const File file = plain();
  const std::size_t size = file.binary.size();
  const auto refusal = [&](const json& buffer, const OtherFiles& files = {}) {
    return unreadable([&] { static_cast<void>(parse_gltf(text_of(file, buffer), "in.gltf", files)); });
  };
  const std::string front = "in.gltf: glTF: buffer 0";
  EXPECT_EQ(refusal({{"byteLength", size}}), front + " has no 'uri', and no bytes in the file");
  const OtherFiles none = [](const std::string& path) -> std::string {
    throw InputError(InputProblem::unreadable, path + ": no such file");
  };
  EXPECT_EQ(refusal({{"byteLength", size}, {"uri", "a.bin"}}, none), front + ": a.bin: no such file");
  const OtherFiles shorter = [&](const std::string&) { return file.binary.substr(1); };
  EXPECT_EQ(refusal({{"byteLength", size}, {"uri", "a.bin"}}, shorter),
            "in.gltf: glTF: buffer view 1 ends beyond its buffer: the file is truncated");
  for (const char* uri : {"../a.bin", "../a/b.bin", "../a/b/c.bin", "/etc/passwd", "a/../../a.bin", "..",
                          "%2e%2e/a.bin", "..\\a.bin", "C:/a.bin", ".", "b/.."}) {
    EXPECT_NE(refusal({{"byteLength", size}, {"uri", uri}}, none).find("leads out of the file's folder"),
              std::string::npos)
        << uri;
  }
  EXPECT_NE(refusal({{"byteLength", size}, {"uri", "https://a.b/c.bin"}}, none).find("is an address"),
            std::string::npos);
  EXPECT_NE(refusal({{"byteLength", size}, {"uri", "a%00.bin"}}, none).find("is not the name of a file"),
            std::string::npos);
  EXPECT_EQ(refusal({{"byteLength", size}, {"uri", "data:,abc"}}), front + ": a data URI that is not base64");
  EXPECT_EQ(refusal({{"byteLength", size}, {"uri", "data:;base64,AAAAA"}}),
            front + ": the data URI is truncated");
  EXPECT_EQ(refusal({{"byteLength", size}, {"uri", "data:;base64,AA*A"}}),
            front + ": '*' in a data URI is not base64");
}

TEST(parse_gltf, base64_is_read_back) {
  std::string bytes;
  for (int size = 0; size < 9; ++size) {
    EXPECT_EQ(data_of_uri(data_uri(bytes), "in", "buffer"), bytes);
    bytes += static_cast<char>(250 - 37 * size);
  }
}

TEST(parse_gltf, what_is_written_as_text_is_read_back) {
  const ControlMesh mesh = plain().read();
  expect_same_arrays(mesh, parse_gltf(format_gltf(mesh, "a.gltf"), "a.gltf"));
  EXPECT_EQ(parse_gltf(format_gltf(mesh, "a.gltf"), "a.gltf").points,
            parse_gltf(format_glb(mesh, "a.glb"), "a.glb").points);
}

TEST(parse_gltf, counts_may_go_beyond_a_short_text_with_a_long_buffer) {
  File file;
  std::vector<float> values(3 * 400'000, 0.5f);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 1009);
  values.resize(values.size() / 9 * 9);
  file.positions(values);
  const OtherFiles files = [&](const std::string&) { return file.binary; };
  const std::string text = text_of(file, {{"byteLength", file.binary.size()}, {"uri", "a.bin"}});
  EXPECT_GT(parse_gltf(text, "in.gltf", files).face_count(), 130'000u);
}

// --- scenes

TEST(parse_gltf, rigid_nodes_are_parts_that_share_their_mesh) {
  File file = plain();
  file.text["nodes"] = json::array({{{"mesh", 0}, {"name", "a"}},
                                    {{"mesh", 0}, {"name", "a"}, {"translation", {5, 0, 0}}},
                                    {{"mesh", 0}, {"rotation", {0, 0, 1, 0}}},
                                    {{"mesh", 0}, {"name", "large"}, {"scale", {2, 2, 2}}},
                                    {{"mesh", 0}, {"name", "mirrored"}, {"scale", {-1, 1, 1}}}});
  file.text["scenes"][0]["nodes"] = {0, 1, 2, 3, 4};
  const ControlMesh whole = file.read();
  const MeshAssembly parts = parse_assembly(file.bytes(), "in.glb");
  ASSERT_EQ(parts.parts.size(), 5u);
  EXPECT_EQ(parts.meshes.size(), 3u);
  std::vector<std::string> names;
  std::size_t first = 0;
  for (const MeshAssembly::Part& part : parts.parts) {
    names.push_back(part.name);
    const ControlMesh& own = parts.meshes[part.mesh];
    for (std::size_t v = 0; v < own.points.size(); ++v) {
      const Point3 placed = part.pose.apply(own.points[v]);
      for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(placed[axis], whole.points[first + v][axis], 1e-14);
    }
    for (std::size_t k = 0; k < own.face_vertices.size(); ++k) {
      EXPECT_EQ(
          own.face_vertices[k].index() + first,
          whole.face_vertices[&part - parts.parts.data() == 0 ? k : k + 6 * (&part - parts.parts.data())]
              .index());
    }
    first += own.points.size();
  }
  EXPECT_EQ(names, (std::vector<std::string>{"a", "a#2", "2", "large", "mirrored"}));
  EXPECT_EQ(parts.parts[1].pose, Motion::translation({5, 0, 0}));
}

TEST(parse_gltf, other_formats_are_one_part) {
  const MeshAssembly one = parse_assembly("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "dir/part.obj");
  ASSERT_EQ(one.parts.size(), 1u);
  EXPECT_EQ(one.parts[0].name, "part");
  EXPECT_EQ(one.meshes[0].face_count(), 1u);
}

}  // namespace
}  // namespace snug::parse_gltf_test
