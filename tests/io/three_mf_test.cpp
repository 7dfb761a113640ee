#include <snug/io/formats.h>

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <snug/io/zip.h>
#include <snug/scene.h>
#include <support/error.h>

#include <testing/files.h>

namespace snug::three_mf_test {
namespace {

using testing::corners;
using testing::expect_same_arrays;
using testing::unreadable;

constexpr const char* core = "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"";
constexpr const char* production =
    " xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\"";
constexpr const char* tetrahedron =
    "<mesh><vertices><vertex x='0' y='0' z='0'/><vertex x='1' y='0' z='0'/><vertex x='0' y='1' z='0'/>"
    "<vertex x='0' y='0' z='1'/></vertices><triangles><triangle v1='0' v2='2' v3='1'/><triangle v1='0' "
    "v2='1' v3='3'/>"
    "<triangle v1='0' v2='3' v3='2'/><triangle v1='1' v2='2' v3='3'/></triangles></mesh>";

using Files = std::vector<std::pair<std::string, std::string>>;
std::string package(const Files& files) {
  ZipWriter archive;
  archive.add(
      "_rels/.rels",
      "<Relationships><Relationship Target=\"/thumb.png\" Id=\"a\" Type=\"x/thumbnail\"/><Relationship "
      "Target=\"/3D/m.model\" Id=\"b\" "
      "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/>"
      "</Relationships>");
  for (const auto& [path, text] : files) archive.add(path, text);
  return archive.finish("x");
}
std::string model(const std::string& resources, const std::string& build,
                  const std::string& heads = "unit=\"inch\"") {
  return std::string("<?xml version=\"1.0\"?><model ") + heads + ' ' + core + production +
         "><metadata name=\"a\">b</metadata><resources>" + resources + "</resources><build>" + build +
         "</build></model>";
}
std::string object(int id, const std::string& content, const std::string& more = "") {
  return "<object id='" + std::to_string(id) + "' " + more + '>' + content + "</object>";
}
std::string one(const std::string& resources, const std::string& build) {
  return package({{"3D/m.model", model(resources, build)}});
}
const std::string item = "<item objectid='1'/>";

std::string refusal(const std::string& bytes) {
  return unreadable([&] { static_cast<void>(parse_3mf(bytes, "in.3mf")); });
}
std::vector<std::string> notes_of(const std::string& bytes) {
  std::vector<std::string> lines;
  static_cast<void>(parse_3mf(bytes, "in.3mf", [&](const std::string& line) { lines.push_back(line); }));
  return lines;
}

TEST(three_mf, reads_a_mesh_with_its_unit) {
  const ControlMesh mesh = parse_3mf(one(object(1, tetrahedron), item), "in.3mf");
  EXPECT_EQ(mesh.points, (std::vector<Point3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  EXPECT_EQ(corners(mesh, 3), (std::vector<std::uint32_t>{1, 2, 3}));
  EXPECT_EQ(mesh.tags.scheme, Scheme::flat);
  EXPECT_EQ(mesh.metres_per_unit, 0.0254);
  EXPECT_EQ(
      parse_3mf(package({{"3D/m.model", model(object(1, tetrahedron), item, "")}}), "in.3mf").metres_per_unit,
      1e-3);
}

TEST(three_mf, what_is_written_is_read_back_bit_by_bit) {
  std::mt19937_64 random(3);
  ControlMesh mesh;
  for (int v = 0; v < 200; ++v) {
    Point3 p;
    for (std::size_t axis = 0; axis < 3; ++axis)
      p[axis] = std::ldexp(static_cast<double>(random() >> 11), static_cast<int>(random() % 40) - 80);
    mesh.points.push_back(p);
  }
  for (int f = 0; f < 300; ++f) {
    const auto a = random() % 198;
    mesh.add_face(std::vector{VertexId(a), VertexId(a + 1), VertexId(a + 2)});
  }
  for (const double unit : {1e-6, 1e-3, 1e-2, 0.0254, 0.3048, 1.0}) {
    mesh.metres_per_unit = unit;
    const ControlMesh again = parse_3mf(format_3mf(mesh, "dir/a.3mf"), "a.3mf");
    expect_same_arrays(mesh, again);
    EXPECT_EQ(again.metres_per_unit, unit);
  }
  mesh.metres_per_unit = 0.1;
  EXPECT_THROW(static_cast<void>(format_3mf(mesh, "a.3mf")), InputError);
  std::vector<std::string> lines;
  mesh.metres_per_unit.reset();
  mesh.add_face(std::vector{VertexId(0), VertexId(1), VertexId(2), VertexId(3)});
  mesh.add_face(std::vector{VertexId(0), VertexId(1), VertexId(1)});
  const std::string bytes =
      format_3mf(mesh, "a.3mf", [&](const std::string& line) { lines.push_back(line); });
  EXPECT_EQ(lines.size(), 3u);
  EXPECT_EQ(parse_3mf(bytes, "a.3mf").face_count(), 302u);
}

TEST(three_mf, components_and_items_are_placed) {
  // Rows are images: x to y, y to -x, and 5 along z; then the item moves by 10 along x.
  const std::string bytes =
      one(object(1, tetrahedron, "name='tip &amp; co'") +
              object(2,
                     "<components><component objectid='1' transform='0 1 0 -1 0 0 0 0 1 0 0 5'/>"
                     "<component objectid='1'/></components>"),
          "<item objectid='2' transform='1 0 0 0 1 0 0 0 1 10 0 0'/><item objectid='1' transform='1 0 0 0 1 "
          "0 0 0 -1 0 0 0'/>");
  const ControlMesh mesh = parse_3mf(bytes, "in.3mf");
  ASSERT_EQ(mesh.points.size(), 12u);
  EXPECT_EQ(mesh.points[1], (Point3{10, 1, 5}));
  EXPECT_EQ(mesh.points[2], (Point3{9, 0, 5}));
  EXPECT_EQ(mesh.points[5], (Point3{11, 0, 0}));
  EXPECT_EQ(mesh.points[11], (Point3{0, 0, -1}));
  EXPECT_EQ(corners(mesh, 0), (std::vector<std::uint32_t>{0, 2, 1}));
  EXPECT_EQ(corners(mesh, 8), (std::vector<std::uint32_t>{8, 9, 10}));  // mirrored: reversed
  const MeshAssembly parts = parse_assembly(bytes, "in.3mf");
  ASSERT_EQ(parts.parts.size(), 3u);
  EXPECT_EQ(parts.meshes.size(), 2u);
  EXPECT_EQ(parts.parts[0].name, "tip & co");
  EXPECT_EQ(parts.parts[1].name, "tip & co#2");
  EXPECT_EQ(parts.parts[0].pose.apply({1, 0, 0}), (Point3{10, 1, 5}));
  EXPECT_EQ(parts.parts[0].mesh, parts.parts[1].mesh);
  EXPECT_EQ(parts.meshes[0].metres_per_unit, 0.0254);
}

// A mesh of one part is its object; of several parts it is a component of an object for each.
TEST(three_mf, an_assembly_is_read_back_as_it_was_written) {
  const ControlMesh mesh = parse_3mf(one(object(1, tetrahedron), item), "in.3mf");
  MeshAssembly assembly{{mesh, mesh, mesh}, {}};
  assembly.meshes[1].points[3] = {0.1, 1e-300, 1 / 3.0};
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto pose = [&] {
    return Motion::translation({1e3 * unit(random), unit(random), 1e-9 * unit(random)}) *
           Motion::rotation({unit(random), unit(random), 1}, 9 * unit(random));
  };
  const std::vector<std::string> names{"pin 1", "Schl\xc3\xbcssel <a> & \"b\"", "pin 2", "\xe2\x86\x92",
                                       "as it is"};
  const std::vector<std::uint32_t> of{0, 1, 0, 0, 2};
  for (std::size_t p = 0; p < names.size(); ++p)
    assembly.parts.push_back({names[p], of[p], p == 4 ? Motion() : pose()});
  const MeshAssembly read = parse_assembly(format_assembly(assembly, "Out.3MF"), "out.3mf");
  ASSERT_EQ(read.parts.size(), names.size());
  EXPECT_EQ(read.meshes.size(), 3u);
  for (std::size_t p = 0; p < names.size(); ++p) {
    EXPECT_EQ(read.parts[p].name, names[p]);
    EXPECT_EQ(read.parts[p].pose.numbers(), assembly.parts[p].pose.numbers()) << p;
    const ControlMesh &was = assembly.meshes[of[p]], &is = read.meshes[read.parts[p].mesh];
    EXPECT_EQ(is.points, was.points);
    EXPECT_EQ(is.face_vertices, was.face_vertices);
    EXPECT_EQ(is.metres_per_unit, 0.0254);
  }
  assembly.meshes[2].metres_per_unit = 1;
  const auto fault = [&](const char* path) {
    return unreadable([&] { static_cast<void>(format_assembly(assembly, path)); });
  };
  EXPECT_EQ(fault("out.stl"), "out.stl: parts in their places are written to .3mf files only");
  EXPECT_THROW(static_cast<void>(format_assembly(assembly, "out.3mf")), InputError);  // two units
  assembly.parts[4].mesh = 3;
  EXPECT_THROW(static_cast<void>(format_assembly(assembly, "out.3mf")), InputError);
}

TEST(three_mf, objects_may_be_in_other_files_of_the_package) {
  const std::string root = model(object(2,
                                        "<components><component objectid='1' p:path='/3D/Objects/o.model' "
                                        "transform='1 0 0 0 1 0 0 0 1 0 0 7'/></components>"),
                                 "<item objectid='2'/>", "unit='millimeter' requiredextensions='p'");
  const ControlMesh mesh =
      parse_3mf(package({{"3D/m.model", root},
                         {"3D/Objects/o.model", model(object(1, tetrahedron), "", "unit='millimeter'")}}),
                "in.3mf");
  EXPECT_EQ(mesh.points[0], (Point3{0, 0, 7}));
  EXPECT_EQ(refusal(package({{"3D/m.model", root}})),
            "in.3mf: 3MF: the package has no file '3D/Objects/o.model'");
  EXPECT_EQ(
      refusal(package({{"3D/m.model", root}, {"3D/Objects/o.model", model(object(1, tetrahedron), "")}})),
      "in.3mf: 3D/Objects/o.model: 3MF: its unit is not that of the other models of the package");
}

TEST(three_mf, supports_and_extensions_are_left_out_with_a_note) {
  const std::string support = object(2, tetrahedron, "type='support'");
  EXPECT_EQ(notes_of(one(object(1, tetrahedron) + support, item + "<item objectid='2'/>")),
            (std::vector<std::string>{"in.3mf: 1 objects of the types support and other are left out"}));
  const std::string lattice =
      "<mesh><vertices><vertex x='0' y='0' z='0'/><vertex x='1' y='0' z='0'/><vertex x='0' y='1' "
      "z='0'/></vertices><triangles><triangle v1='0' v2='1' v3='2'/></triangles><beamlattice "
      "xmlns='http://b'/></mesh>";
  EXPECT_EQ(
      notes_of(one(object(1, lattice), item)),
      (std::vector<std::string>{"in.3mf: 'beamlattice' is not read: the surface is the one without it"}));
}

TEST(three_mf, faults_are_one_line) {
  const std::string mesh = object(1, tetrahedron);
  EXPECT_EQ(refusal("PK"), "in.3mf: this is not a 3MF file: it does not begin like a ZIP archive");
  EXPECT_EQ(refusal("OFF\n"), "in.3mf: this is not a 3MF file: it does not begin like a ZIP archive");
  ZipWriter other;
  other.add("a.txt", "b");
  EXPECT_EQ(refusal(other.finish("x")),
            "in.3mf: this is a ZIP archive, but no 3MF package: it has no _rels/.rels");
  EXPECT_EQ(refusal(package({})), "in.3mf: 3MF: the package has no file '3D/m.model'");
  EXPECT_EQ(refusal(one(mesh, "")), "in.3mf: 3MF: nothing is built: the file has no items with triangles");
  EXPECT_EQ(refusal(one(mesh, "<item objectid='7'/>")),
            "in.3mf: 3D/m.model:1: 3MF: object 7 is in no file of the package");
  EXPECT_EQ(refusal(one(mesh + mesh, item)), "in.3mf: 3D/m.model:1: 3MF: the id 1 is that of two objects");
  EXPECT_EQ(refusal(one(mesh, "<item objectid='1' transform='1 0 0'/>")),
            "in.3mf: 3D/m.model:1: transform has 3 numbers, not 12");
  EXPECT_EQ(refusal(one(mesh, "<item objectid='1' transform='1 0 0 0 1 0 0 0 1 1e999 0 0'/>")),
            "in.3mf: 3D/m.model:1: transform: '1e999' is too large for a double");
  EXPECT_EQ(
      refusal(
          one(mesh,
              "<item objectid='1' transform='1e300 0 0 0 1e300 0 0 0 1e300 1e308 1e308 1e308'/>"
              "<item objectid='1' transform='1e308 1e308 0 1e308 1e308 0 0 0 1e300 1.7e308 1e308 1e308'/>")),
      "in.3mf: 3MF: object 1 moves a vertex beyond the range of doubles");
  EXPECT_EQ(refusal(package({{"3D/m.model", model(mesh, item, "unit='parsec'")}})),
            "in.3mf: 3D/m.model:1: 3MF: unit: 'parsec' is not one of micron, millimeter, centimeter, inch, "
            "foot and meter");
  EXPECT_EQ(refusal(package(
                {{"3D/m.model", model(mesh, item, "requiredextensions='b' xmlns:b='http://lattice'")}})),
            "in.3mf: 3D/m.model:1: 3MF: the extension 'http://lattice' is needed: write the file without it");
  EXPECT_EQ(refusal(package({{"3D/m.model", "<model/>"}})),
            "in.3mf: 3D/m.model:1: 3MF: 'model' is not of the namespace of 3MF's core specification");
  EXPECT_EQ(
      refusal(one(
          object(1,
                 "<mesh><vertices><vertex x='0' y='0' z='0'/></vertices><triangles><triangle v1='0' v2='1' "
                 "v3='0'/></triangles></mesh>"),
          item)),
      "in.3mf: 3D/m.model:1: 3MF: v2: index 1 names none of 1 vertices");
  EXPECT_EQ(refusal(one(object(1, "<mesh><vertices><vertex x='nan' y='0' z='0'/></vertices></mesh>"), item)),
            "in.3mf: 3D/m.model:1: x: 'nan' is not a finite number");
  EXPECT_EQ(refusal(one(object(1, "<mesh><vertices><vertex x='1' y='0'/></vertices></mesh>"), item)),
            "in.3mf: 3D/m.model:1: 'vertex' has no 'z'");
}

TEST(three_mf, bombs_are_one_line) {
  // Components of components: ten of each, thirty deep.
  std::string objects = object(1, tetrahedron);
  for (int id = 2; id < 32; ++id) {
    std::string components;
    for (int k = 0; k < 10; ++k) components += "<component objectid='" + std::to_string(id - 1) + "'/>";
    objects += object(id, "<components>" + components + "</components>");
  }
  EXPECT_EQ(refusal(one(objects, "<item objectid='31'/>")),
            "in.3mf: 3D/m.model:1: 3MF: more than 262144 parts, with all components");
  EXPECT_EQ(
      refusal(one(object(1, "<components><component objectid='1'/></components>"), item)),
      "in.3mf: 3D/m.model:1: 3MF: object 1: components of components, more than 256 deep or without an end");
  EXPECT_EQ(
      refusal(package({{"3D/m.model", "<!DOCTYPE a [<!ENTITY b 'c'>]><model/>"}})),
      "in.3mf: 3D/m.model:1: XML: a document type, as in <!DOCTYPE>: entities are not read; take it out");
  // Instances that share a mesh are no bomb.
  std::string items;
  for (int i = 0; i < 1000; ++i)
    items += "<item objectid='1' transform='1 0 0 0 1 0 0 0 1 " + std::to_string(i * i) + " 0 0'/>";
  const MeshAssembly many = parse_assembly(one(object(1, tetrahedron), items), "in.3mf");
  EXPECT_EQ(many.parts.size(), 1000u);
  EXPECT_EQ(many.meshes.size(), 1u);
}

}  // namespace
}  // namespace snug::three_mf_test
