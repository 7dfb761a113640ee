#include <snug/io/formats.h>

#include <cmath>
#include <string>
#include <vector>

#include <snug/surface.h>

#include <testing/files.h>

namespace snug::usda_test {
namespace {

using testing::corners;
using testing::expect_same_arrays;
using testing::unreadable;

using Ids = std::vector<std::uint32_t>;

const std::string header = "#usda 1.0\n";
const std::string quad_points = "point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0.1)]\n";
const std::string quad =
    "int[] faceVertexCounts = [4]\nint[] faceVertexIndices = [0, 1, 2, 3]\n" + quad_points;
const std::string triangle =
    "int[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 2]\n"
    "point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]\n";

std::string mesh_prim(const std::string& body, const std::string& name = "m") {
  return "def Mesh \"" + name + "\"\n{\n" + body + "}\n";
}

ControlMesh parse(const std::string& text) { return parse_usda(header + text, "in.usda"); }
ControlMesh parse_mesh_of(const std::string& body) { return parse(mesh_prim(body)); }

std::string refusal(const std::string& text) {
  return unreadable([&] { static_cast<void>(parse(text)); });
}

std::vector<std::string> notes_of(const std::string& text) {
  std::vector<std::string> lines;
  static_cast<void>(
      parse_usda(header + text, "in.usda", [&](const std::string& line) { lines.push_back(line); }));
  return lines;
}

TEST(usda, reads_a_mesh_with_its_rules) {
  const ControlMesh mesh = parse_mesh_of(quad + R"(
      uniform token subdivisionScheme = "bilinear"
      token interpolateBoundary = "edgeOnly"
      token triangleSubdivisionRule = "smooth"
      token faceVaryingLinearInterpolation = "all"
      int[] holeIndices = [0]
      int[] cornerIndices = [2, 0]
      float[] cornerSharpnesses = [10, 0.5]
  )");
  EXPECT_EQ(mesh.vertex_count(), 4u);
  EXPECT_EQ(mesh.points[3], (Point3{0, 1, 0.1}));
  EXPECT_EQ(corners(mesh, 0), (Ids{0, 1, 2, 3}));
  EXPECT_EQ(mesh.tags.scheme, Scheme::bilinear);
  EXPECT_EQ(mesh.tags.boundary, BoundaryRule::edge_only);
  EXPECT_EQ(mesh.tags.smooth_triangles, SmoothTriangles::smooth);
  ASSERT_EQ(mesh.tags.holes.size(), 1u);
  ASSERT_EQ(mesh.tags.corners.size(), 2u);
  EXPECT_EQ(mesh.tags.corners[0].vertex, VertexId(2));
  EXPECT_EQ(mesh.tags.corners[1].sharpness, 0.5);
}

TEST(usda, the_schemes_are_those_of_usd) {
  EXPECT_EQ(parse_mesh_of(triangle).tags.scheme, Scheme::catmark);  // by default, triangles too
  const auto scheme_of = [](const std::string& word, const std::string& body) {
    return parse_mesh_of(body + "uniform token subdivisionScheme = \"" + word + "\"\n").tags.scheme;
  };
  EXPECT_EQ(scheme_of("catmullClark", triangle), Scheme::catmark);
  EXPECT_EQ(scheme_of("loop", triangle), Scheme::loop);
  EXPECT_EQ(scheme_of("bilinear", triangle), Scheme::bilinear);
  EXPECT_EQ(scheme_of("none", triangle), Scheme::flat);
  EXPECT_EQ(scheme_of("none", quad), Scheme::bilinear);
  EXPECT_EQ(notes_of(mesh_prim(quad + "uniform token subdivisionScheme = \"none\"\n")).size(), 1u);
  // Polygons have no boundary rule, which would leave the faces at the boundary out.
  EXPECT_FALSE(parse_mesh_of(triangle + "uniform token subdivisionScheme = \"none\"\n"
                                        "token interpolateBoundary = \"none\"\n")
                   .tags.boundary);
}

TEST(usda, a_surface_has_the_scheme_of_its_file_unless_told_otherwise) {
  const ControlMesh mesh = parse_mesh_of(triangle);
  EXPECT_EQ(Surface(mesh).scheme(), Scheme::catmark);
  EXPECT_EQ(Surface(mesh, {.scheme = Scheme::loop}).scheme(), Scheme::loop);
  EXPECT_EQ(Surface(parse_mesh_of(triangle + "uniform token subdivisionScheme = \"none\"\n")).scheme(),
            Scheme::flat);
}

TEST(usda, creases_have_one_sharpness_or_one_for_each_edge) {
  const std::string creases = "int[] creaseIndices = [0, 1, 2, 3, 0]\nint[] creaseLengths = [3, 2]\n";
  const auto sharpness = [&](const std::string& values) {
    std::vector<double> found;
    for (const CreaseTag& crease :
         parse_mesh_of(quad + creases + "float[] creaseSharpnesses = " + values + "\n").tags.creases) {
      found.push_back(crease.sharpness);
    }
    return found;
  };
  EXPECT_EQ(sharpness("[2.5, 10]"), (std::vector<double>{2.5, 2.5, 10}));
  EXPECT_EQ(sharpness("[1, 2, inf]"), (std::vector<double>{1, 2, 10}));
  const ControlMesh mesh = parse_mesh_of(quad + creases + "float[] creaseSharpnesses = [1, 2]\n");
  EXPECT_EQ(mesh.tags.creases[1].a, VertexId(1));
  EXPECT_EQ(mesh.tags.creases[1].b, VertexId(2));
  EXPECT_EQ(mesh.tags.creases[2].a, VertexId(3));
  EXPECT_EQ(mesh.tags.creases[2].b, VertexId(0));
}

TEST(usda, what_is_no_mesh_is_passed_over) {
  const ControlMesh mesh = parse(R"(
(
    """A comment on the file, with ) and } in it"""
    defaultPrim = "World"
    customLayerData = { string a = "}" dictionary b = { int[] c = [1, 2] } }
    endTimeCode = 24 ; startTimeCode = 1
)
/* a comment
   of two lines */
def Xform "World" ( kind = "component" prepend apiSchemas = ["MaterialBindingAPI"] variants = { string v = "x" } )
{
    // another one
    def Material "red"
    {
        token outputs:surface.connect = </World/red/shader.outputs:surface>
        def Shader "shader" { asset inputs:file = @./a"b.png@ ( colorSpace = "raw" ) }
    }
    custom string note = "def Mesh \"not this\" {"
    def Mesh "m" ( prepend references = None ; instanceable = false )
    {
        rel material:binding = </World/red> ( bindMaterialAs = "weakerThanDescendants" )
        prepend rel other = [ </a>, </b> ]
        float3[] extent = [(0, 0, 0), (1, 1, 1)]
        normal3f[] normals = [(0, 0, 1)] ( interpolation = "constant" )
        texCoord2f[] primvars:st = [(0, 0)] ( interpolation = "faceVarying" )
        texCoord2f[] primvars:st.timeSamples = { 0: [(0, 0)], 1.5: [(1, 1)], }
        float unset
        reorder properties = ["points"]
)" + quad + R"(
        def GeomSubset "s" { int[] indices = [0] ; uniform token elementType = "face" }
    }
    def Camera "c" { float focalLength = 50 }
}
reorder rootPrims = ["World"]
)");
  EXPECT_EQ(mesh.vertex_count(), 4u);
  EXPECT_EQ(mesh.face_count(), 1u);
}

TEST(usda, numbers_are_the_nearest_doubles_whatever_the_type) {
  const ControlMesh mesh = parse_mesh_of(
      "int[] faceVertexCounts = [3,]\nint[] faceVertexIndices = [0, 1, 2]\n"
      "point3d[] points = [(0.1, -0, 1e-320), (+1, .5, 2.), (3, 4, 5,),]\n");
  EXPECT_EQ(mesh.points[0].x, 0.1);
  EXPECT_TRUE(std::signbit(mesh.points[0].y));
  EXPECT_EQ(mesh.points[0].z, 1e-320);
  EXPECT_EQ(mesh.points[1], (Point3{1, 0.5, 2}));
}

TEST(usda, several_meshes_become_one) {
  const std::string hole =
      "int[] holeIndices = [0]\nint[] cornerIndices = [1]\nfloat[] cornerSharpnesses = [3]\n";
  const ControlMesh mesh =
      parse("def Scope \"s\" {" + mesh_prim(quad, "a") + "}\n" + mesh_prim(quad + hole, "b"));
  EXPECT_EQ(mesh.vertex_count(), 8u);
  EXPECT_EQ(corners(mesh, 1), (Ids{4, 5, 6, 7}));
  EXPECT_EQ(mesh.tags.holes, (std::vector{FaceId(1)}));
  EXPECT_EQ(mesh.tags.corners[0].vertex, VertexId(5));
}

TEST(usda, meshes_with_other_rules_are_refused_by_name) {
  const auto pair = [](const std::string& a, const std::string& b) {
    return mesh_prim(quad + a, "a") + mesh_prim(quad + b, "b");
  };
  EXPECT_EQ(refusal(pair("", "uniform token subdivisionScheme = \"bilinear\"\n")),
            "in.usda:8: subdivisionScheme of '/b' is not that of '/a': write them to different files");
  EXPECT_EQ(refusal(pair("token interpolateBoundary = \"edgeOnly\"\n", "")),
            "in.usda:9: interpolateBoundary of '/b' is not that of '/a': write them to different files");
  EXPECT_EQ(refusal(pair("", "token triangleSubdivisionRule = \"smooth\"\n")),
            "in.usda:8: triangleSubdivisionRule of '/b' is not that of '/a': write them to different files");
  // Defaults may be written or not; none and bilinear are the same for polygons.
  EXPECT_EQ(parse(pair("",
                       "token interpolateBoundary = \"edgeAndCorner\"\nuniform token subdivisionScheme = "
                       "\"catmullClark\"\ntoken triangleSubdivisionRule = \"catmullClark\"\n"))
                .face_count(),
            2u);
  const std::string none = "uniform token subdivisionScheme = \"none\"\n";
  EXPECT_EQ(parse(pair(none, "uniform token subdivisionScheme = \"bilinear\"\n")).tags.scheme,
            Scheme::bilinear);
}

TEST(usda, prims_that_do_not_count_are_left_out_with_a_note) {
  const std::string kept = mesh_prim(quad, "kept");
  const auto with = [&](const std::string& prim) {
    EXPECT_EQ(parse(prim + kept).face_count(), 1u) << prim;
    const std::vector<std::string> notes = notes_of(prim + kept);
    EXPECT_EQ(notes.size(), 1u) << prim;
    return notes.empty() ? "" : notes[0];
  };
  EXPECT_EQ(with(mesh_prim(quad + "token visibility = \"invisible\"\n", "a")),
            "in.usda: meshes are left out that are invisible: '/a'");
  EXPECT_EQ(with("def Xform \"x\" { token visibility = \"invisible\"\n" + mesh_prim(quad, "a") + "}\n"),
            "in.usda: meshes are left out that are invisible: '/x/a'");
  EXPECT_EQ(with(mesh_prim(quad + "uniform token purpose = \"guide\"\n", "a")),
            "in.usda: meshes are left out that are of the purpose guide: '/a'");
  EXPECT_EQ(with("def \"x\" { uniform token purpose = \"proxy\"\n" + mesh_prim(quad, "a") + "}\n"),
            "in.usda: meshes are left out that are of the purpose proxy: '/x/a'");
  EXPECT_EQ(with("over \"x\" {" + mesh_prim(quad, "a") + "}\n"),
            "in.usda: meshes are left out that are only over, without a definition: '/x/a'");
  EXPECT_EQ(with("class \"x\" {" + mesh_prim(quad, "a") + mesh_prim(quad, "b") + "}\n"),
            "in.usda: meshes are left out that are a class: '/x/a', '/x/b'");
  EXPECT_EQ(with("def Mesh \"a\" ( active = false ) {" + quad + "}\n"),
            "in.usda: meshes are left out that are not active: '/a'");
  EXPECT_EQ(with("def Mesh \"a\" {\n int[] faceVertexCounts = []\n}\n"),
            "in.usda: meshes without faces are left out: '/a'");
  EXPECT_EQ(with("def Sphere \"a\" {}\n"), "in.usda: shapes that are not meshes are left out: '/a'");
  // Of purposes only, a prim overrides its ancestors.
  EXPECT_EQ(parse("def \"x\" { uniform token purpose = \"guide\"\n" +
                  mesh_prim(quad + "uniform token purpose = \"render\"\n") + "}\n")
                .face_count(),
            1u);
  EXPECT_EQ(refusal(mesh_prim(quad + "token visibility = \"invisible\"\n")),
            "in.usda: the file has no mesh that is defined, visible and for rendering");
}

TEST(usda, content_from_elsewhere_is_refused_where_it_counts) {
  const std::string flatten = " are not followed: flatten the file, usdcat --flatten -o flat.usda";
  const auto with = [](const std::string& metadata) {
    return "def Xform \"x\" (\n" + metadata + "\n)\n{\n" + mesh_prim(quad) + "}\n";
  };
  EXPECT_EQ(refusal(with("prepend references = @a.usda@</b> (offset = 1)")),
            "in.usda:3: 'references'" + flatten);
  EXPECT_EQ(refusal(with("payload = [@a.usda@, </b>]")), "in.usda:3: 'payload'" + flatten);
  EXPECT_EQ(refusal(with("inherits = </b>")), "in.usda:3: 'inherits'" + flatten);
  EXPECT_EQ(refusal(with("specializes = </b>")), "in.usda:3: 'specializes'" + flatten);
  EXPECT_EQ(refusal(with("prepend variantSets = \"v\"")), "in.usda:3: 'variantSets'" + flatten);
  EXPECT_EQ(
      refusal("def \"x\" {\nvariantSet \"v\" = { \"a\" { def Mesh \"m\" {} } }\n" + mesh_prim(quad) + "}"),
      "in.usda:3: 'variantSet'" + flatten);
  EXPECT_EQ(refusal("(\nsubLayers = [ @a.usda@ (offset = 1) ]\n)\n" + mesh_prim(quad)),
            "in.usda:3: sublayers are not read: flatten the file, usdcat --flatten -o flat.usda");
  EXPECT_EQ(parse(with("delete references = @a.usda@")).face_count(), 1u);
  EXPECT_EQ(parse("class \"c\" ( inherits = </d> ) {}\n" + mesh_prim(quad)).face_count(), 1u);
  EXPECT_EQ(refusal("def PointInstancer \"p\" { " + mesh_prim(quad) + "}"),
            "in.usda:2: instances are not read: turn those of '/p' into meshes");
}

TEST(usda, values_by_time_are_refused_where_they_count) {
  EXPECT_EQ(refusal(mesh_prim(quad + "point3f[] points.timeSamples = { 0: [(0, 0, 0)] }\n")),
            "in.usda:7: 'points' has values by time, which are not read: export one frame");
  const std::string moved = "double3 xformOp:translate.timeSamples = { 0: (0, 0, 0), 5: (1, 0, 0) }\n";
  EXPECT_EQ(refusal(mesh_prim(quad + moved + "uniform token[] xformOpOrder = [\"xformOp:translate\"]\n")),
            "in.usda:7: 'xformOp:translate' has values by time, which are not read: export one frame");
  EXPECT_EQ(parse_mesh_of(quad + moved).face_count(), 1u);  // it is not in the order
}

TEST(usda, left_handed_and_mirrored_meshes_are_reversed) {
  const std::string left = "uniform token orientation = \"leftHanded\"\n";
  const std::string mirror =
      "float3 xformOp:scale = (-1, 1, 1)\nuniform token[] xformOpOrder = [\"xformOp:scale\"]\n";
  EXPECT_EQ(corners(parse_mesh_of(quad + left), 0), (Ids{0, 3, 2, 1}));
  EXPECT_EQ(corners(parse_mesh_of(quad + mirror), 0), (Ids{0, 3, 2, 1}));
  EXPECT_EQ(corners(parse_mesh_of(quad + left + mirror), 0), (Ids{0, 1, 2, 3}));
  EXPECT_EQ(corners(parse_mesh_of(quad + "uniform token orientation = \"rightHanded\"\n"), 0),
            (Ids{0, 1, 2, 3}));
  EXPECT_EQ(notes_of(mesh_prim(quad + left))[0],
            "in.usda: faces of left-handed or mirrored meshes are reversed, in 1 of 1");
}

TEST(usda, transforms_move_points_from_the_inside_out) {
  // Scaled, then turned, then moved; and again by the prim above.
  const std::string own =
      "float3 xformOp:scale = (2, 1, 1)\nfloat xformOp:rotateZ = 90\ndouble3 xformOp:translate = (10, 0, 0)\n"
      "uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:rotateZ\", \"xformOp:scale\"]\n";
  const std::string above =
      "double3 xformOp:translate:up = (0, 0, 5)\n"
      "uniform token[] xformOpOrder = [\"xformOp:translate:up\"]\n";
  const ControlMesh mesh = parse("def Xform \"x\" {" + above + mesh_prim(quad + own) + "}");
  EXPECT_EQ(mesh.points[1], (Point3{10, 2, 5}));  // (1 0 0), (2 0 0), (0 2 0), (10 2 0)
  EXPECT_EQ(mesh.points[2], (Point3{9, 2, 5}));
  // The prim above acts last: moved to (11 0 0), then turned.
  const std::string turn =
      "float xformOp:rotateZ = 90\nuniform token[] xformOpOrder = [\"xformOp:rotateZ\"]\n";
  const std::string move =
      "double3 xformOp:translate = (10, 0, 0)\nuniform token[] xformOpOrder = [\"xformOp:translate\"]\n";
  EXPECT_EQ(parse("def Xform \"x\" {" + turn + mesh_prim(quad + move) + "}").points[1], (Point3{0, 11, 0}));
  // A scope has no place; nor has a prim without a type; the order counts, not the attribute.
  EXPECT_EQ(parse("def Scope \"x\" {" + above + mesh_prim(quad) + "}").points[1], (Point3{1, 0, 0}));
  EXPECT_EQ(parse_mesh_of(quad + "double3 xformOp:translate = (10, 0, 0)\n").points[1], (Point3{1, 0, 0}));
  // The stack is reset.
  const std::string reset =
      "double3 xformOp:translate = (10, 0, 0)\n"
      "uniform token[] xformOpOrder = [\"!resetXformStack!\", \"xformOp:translate\"]\n";
  EXPECT_EQ(parse("def Xform \"x\" {" + above + mesh_prim(quad + reset) + "}").points[1], (Point3{11, 0, 0}));
  // Attributes may stand behind the prims that they move.
  EXPECT_EQ(parse("def Xform \"x\" {" + mesh_prim(quad) + above + "}").points[1], (Point3{1, 0, 5}));
  // An operation and its inverse are nothing.
  const std::string pivot =
      "float3 xformOp:translate:pivot = (0.1, 0.2, 0.3)\n"
      "uniform token[] xformOpOrder = [\"xformOp:translate:pivot\", \"!invert!xformOp:translate:pivot\"]\n";
  const Point3 there = parse_mesh_of(quad + pivot).points[3];
  EXPECT_NEAR(there.z, 0.1, 1e-16);
}

TEST(usda, says_how_far_rounding_moves_points) {
  const std::string turn =
      "float xformOp:rotateX = 30\nuniform token[] xformOpOrder = [\"xformOp:rotateX\"]\n";
  const std::vector<std::string> notes = notes_of(mesh_prim(quad + turn));
  ASSERT_EQ(notes.size(), 1u);
  const std::string front =
      "in.usda: points are moved by the transforms of their prims; rounding moves a coordinate by at "
      "most ";
  ASSERT_EQ(notes[0].substr(0, front.size()), front);
  const double most = std::stod(notes[0].substr(front.size()));
  EXPECT_GT(most, 0);
  EXPECT_LT(most, 1e-14);
  const std::string exact =
      "float xformOp:rotateX = 90\nuniform token[] xformOpOrder = [\"xformOp:rotateX\"]\n";
  EXPECT_EQ(notes_of(mesh_prim(quad + exact))[0],
            "in.usda: points are moved by the transforms of their prims");
  EXPECT_TRUE(notes_of(mesh_prim(quad + "uniform token[] xformOpOrder = []\n")).empty());
}

TEST(usda, units_and_axes_are_only_told) {
  EXPECT_EQ(notes_of("( metersPerUnit = 0.01 upAxis = \"Z\" )\n" + mesh_prim(quad))[0],
            "in.usda: metersPerUnit 0.01 upAxis 'Z': coordinates are taken as they are");
}

TEST(usda, faults_name_their_line) {
  const auto in_mesh = [](const std::string& body) { return refusal(mesh_prim(body)); };
  const std::string counts = "int[] faceVertexCounts = [3]\n",
                    indices = "int[] faceVertexIndices = [0, 1, 2]\n";
  EXPECT_EQ(in_mesh(counts + indices), "in.usda:2: '/m' has faces but no points");
  EXPECT_EQ(in_mesh(counts + quad_points), "in.usda:4: face 0: faceVertexIndices has only 0 values");
  EXPECT_EQ(in_mesh(counts + "int[] faceVertexIndices = [0, 1, 2, 3]\n" + quad_points),
            "in.usda:5: faceVertexIndices has 4 values, and faceVertexCounts add up to 3");
  EXPECT_EQ(in_mesh(counts + "int[] faceVertexIndices = [0, 1, 4]\n" + quad_points),
            "in.usda:5: face 0: index 4 is outside 0 to 3");
  EXPECT_EQ(in_mesh(counts + "int[] faceVertexIndices = [0, 1, -1]\n" + quad_points),
            "in.usda:5: face 0: index -1 is outside 0 to 3");
  EXPECT_EQ(in_mesh("int[] faceVertexCounts = [3, 0]\n" + indices + quad_points),
            "in.usda:4: face 1: 0 is not a number of vertices");
  EXPECT_EQ(in_mesh("int[] faceVertexCounts = [3.5]\n"),
            "in.usda:4: faceVertexCounts: '3.5' is not a whole number");
  EXPECT_EQ(in_mesh("point3f[] points = [(0, 0, nan)]\n"),
            "in.usda:4: vertex 0: 'nan' is not a finite number");
  EXPECT_EQ(in_mesh("point3f[] points = [(0, 0, 1e999)]\n"),
            "in.usda:4: vertex 0: '1e999' is too large for a double");
  EXPECT_EQ(in_mesh("point3f[] points = [(0, 0, \"1\")]\n"), "in.usda:4: vertex 0: '1' is not a number");
  EXPECT_EQ(in_mesh("point3f[] points = [(0, 0)]\n"),
            "in.usda:4: ')' found where ',' is expected, between the coordinates of vertex 0");
  EXPECT_EQ(in_mesh("point3f[] points = [\n(0, 0, 0)\n(1, 0, 0)]\n"),
            "in.usda:6: '(' found where ',' is expected, between the values of points");
  EXPECT_EQ(in_mesh("point3f points = (0, 0, 0)\n"),
            "in.usda:4: 'points' is not declared as an array: its type must end in []");
  EXPECT_EQ(in_mesh(quad_points + quad_points),
            "in.usda:5: 'points' is given in line 4 already: take one of the two out");
  EXPECT_EQ(in_mesh(quad + "uniform token subdivisionScheme = \"Loop\"\n"),
            "in.usda:7: subdivisionScheme: 'Loop' is not one of catmullClark, loop, bilinear and none");
  EXPECT_EQ(in_mesh(quad + "uniform token orientation = \"up\"\n"),
            "in.usda:7: orientation: 'up' is not one of rightHanded and leftHanded");
  EXPECT_EQ(in_mesh(quad + "int[] holeIndices = [1]\n"), "in.usda:7: holeIndices: index 1 is outside 0 to 0");
  EXPECT_EQ(in_mesh(quad + "int[] cornerIndices = [1]\n"),
            "in.usda:7: 1 cornerIndices have 0 cornerSharpnesses: give one for each");
  EXPECT_EQ(in_mesh(quad + "int[] creaseIndices = [0, 1]\nint[] creaseLengths = [3]\n"),
            "in.usda:8: creaseLengths do not add up to the 2 creaseIndices");
  EXPECT_EQ(in_mesh(quad + "int[] creaseIndices = [0, 1, 2]\nint[] creaseLengths = [4, -1]\n"),
            "in.usda:8: creaseLengths: -1 is less than two vertices");
  EXPECT_EQ(in_mesh(quad + "int[] creaseIndices = [0, 1, 2]\nint[] creaseLengths = [3]\n"
                           "float[] creaseSharpnesses = [1, 2, 3]\n"),
            "in.usda:9: 3 creaseSharpnesses: give one for each of 1 creases, or of 2 edges");
  EXPECT_EQ(in_mesh(quad + "float[] cornerSharpnesses = [-1]\n"),
            "in.usda:7: cornerSharpnesses: a sharpness is negative");
}

TEST(usda, transforms_that_are_none_are_refused) {
  const auto with = [](const std::string& attribute, const std::string& order) {
    return refusal(mesh_prim(quad + attribute + "\nuniform token[] xformOpOrder = [\"" + order + "\"]\n"));
  };
  EXPECT_EQ(with("", "xformOp:translate"),
            "in.usda:8: xformOpOrder names 'xformOp:translate', which the prim does not have");
  EXPECT_EQ(with("float xformOp:spin = 3", "xformOp:spin"),
            "in.usda:7: 'xformOp:spin' is an operation that snug does not know");
  EXPECT_EQ(with("float xformOp:rotateX:\xff = (a)", "xformOp:rotateX"),
            "in.usda:7: 'xformOp:rotateX:\\xff': 'a' is not a number");
  EXPECT_EQ(with("float3 xformOp:scale = (0, 1, 1)", "!invert!xformOp:scale"),
            "in.usda:7: 'xformOp:scale' cannot be inverted: a factor is 0");
  EXPECT_EQ(with("double3 xformOp:scale = (1e308, 1e308, 1e308)\nfloat3 xformOp:scale:b = (1e308, 1, 1)",
                 "xformOp:scale\", \"xformOp:scale:b"),
            "in.usda:9: the transform is beyond the range of doubles");
  EXPECT_EQ(with("double3 xformOp:scale = (1.7e308, 1.7e308, 1)\nfloat xformOp:rotateZ = 45",
                 "xformOp:rotateZ\", \"xformOp:scale"),
            "in.usda:2: vertex 2 of '/m' is moved beyond the range of doubles");
}

TEST(usda, broken_texts_are_refused_where_they_break) {
  EXPECT_EQ(unreadable([] { static_cast<void>(parse_usda("def Mesh", "in.usda")); }),
            "in.usda: this is not a USD text: it does not begin with '#usda 1.0'");
  EXPECT_EQ(unreadable([] { static_cast<void>(parse_usda("PXR-USDC\1\2", "in.usd")); }),
            "in.usd: this is a binary USD file: convert it to text, usdcat -o mesh.usda");
  EXPECT_EQ(unreadable([] { static_cast<void>(parse_usda("PK\3\4", "in.usdz")); }),
            "in.usdz: this is a packed USD file: convert it to text, usdcat -o mesh.usda");
  EXPECT_EQ(refusal(""), "in.usda: the file has no mesh that is defined, visible and for rendering");
  EXPECT_EQ(
      refusal("def Mesh \"m\" {\n"),
      "in.usda:3: the file ends within the prim 'm' of line 2: it is truncated, or a bracket is missing");
  EXPECT_EQ(refusal("def Mesh m {}"), "in.usda:2: 'm' found where the name of a prim is expected, in quotes");
  EXPECT_EQ(refusal("}"), "in.usda:2: '}' found where a prim begins, as in def Mesh \"name\"");
  EXPECT_EQ(refusal("def \"m\" { float a = [1, (2] }"), "in.usda:2: ']' does not close '('");
  EXPECT_EQ(refusal("def \"m\" { string a = \"never ends\n }"),
            "in.usda:2: a string that begins here does not end");
  EXPECT_EQ(refusal("/* never ends"), "in.usda:2: a comment that begins here does not end");
  EXPECT_EQ(
      refusal("def \"m\" {\nfloat a = [1,\n2"),
      "in.usda:4: '[' is not closed: the file is truncated, or a bracket is missing, in line 3 or below");
}

TEST(usda, nesting_costs_no_stack) {
  const std::size_t deep = 1'000'000;
  EXPECT_EQ(parse("def \"m\" { float a = " + std::string(deep, '(') + std::string(deep, ')') + " }\n" +
                  mesh_prim(quad))
                .face_count(),
            1u);
  std::string prims;
  for (int i = 0; i < 2000; ++i) prims += "def \"m\" {\n";
  EXPECT_EQ(refusal(prims), "in.usda:1002: prims are nested deeper than 1000");
}

ControlMesh tagged_mesh() {
  ControlMesh mesh;
  mesh.points = {{0, -0.0, 1e-320}, {0.1, 1e300, 3}, {1.0 / 3, 1, 0}, {5, 5, 5}, {-1, -2, -3}};
  mesh.add_face(std::vector{VertexId(0), VertexId(1), VertexId(2), VertexId(3)});
  mesh.add_face(std::vector{VertexId(3), VertexId(2), VertexId(4)});
  mesh.tags.creases = {{VertexId(0), VertexId(1), 0.1}, {VertexId(2), VertexId(3), 1e5}};
  mesh.tags.corners = {{VertexId(4), 2.5}, {VertexId(4), 10}};
  mesh.tags.holes = {FaceId(1)};
  mesh.tags.smooth_triangles = SmoothTriangles::smooth;
  return mesh;
}

TEST(usda, a_round_trip_keeps_every_bit_and_tag) {
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark, Scheme::bilinear}) {
    for (const auto boundary :
         {std::optional<BoundaryRule>(), std::optional(BoundaryRule::none),
          std::optional(BoundaryRule::edge_only), std::optional(BoundaryRule::edge_and_corner)}) {
      ControlMesh mesh = tagged_mesh();
      mesh.tags.scheme = scheme;
      mesh.tags.boundary = boundary;
      const auto no_note = [](const std::string& line) { ADD_FAILURE() << line; };
      const std::string text = format_usda(mesh, "out.usda", no_note);
      const ControlMesh again = parse_usda(text, "out.usda", no_note);
      expect_same_arrays(mesh, again);
      EXPECT_EQ(again.tags.scheme, scheme);
      EXPECT_EQ(again.tags.boundary, boundary);
      EXPECT_EQ(again.tags.smooth_triangles, SmoothTriangles::smooth);
      ASSERT_EQ(again.tags.creases.size(), 2u);
      EXPECT_EQ(again.tags.creases[0].sharpness, 0.1);
      EXPECT_EQ(again.tags.creases[1].sharpness, 1e5);
      EXPECT_EQ(again.tags.creases[1].b, VertexId(3));
      ASSERT_EQ(again.tags.corners.size(), 2u);
      EXPECT_EQ(again.tags.corners[1].sharpness, 10);
      EXPECT_EQ(again.tags.holes, mesh.tags.holes);
      EXPECT_EQ(format_usda(again, "out.usda"), text);
    }
  }
}

TEST(usda, a_mesh_without_a_scheme_is_written_with_that_of_its_faces) {
  ControlMesh mesh = tagged_mesh();
  EXPECT_EQ(parse_usda(format_usda(mesh, "out"), "out").tags.scheme, Scheme::catmark);
  mesh = parse_mesh_of(triangle);
  mesh.tags.scheme.reset();
  EXPECT_EQ(parse_usda(format_usda(mesh, "out"), "out").tags.scheme, Scheme::loop);
  mesh.tags.scheme = Scheme::flat;
  EXPECT_EQ(parse_usda(format_usda(mesh, "out"), "out").tags.scheme, Scheme::flat);
  mesh.tags.boundary = BoundaryRule::none;  // polygons of USD have no such rule
  EXPECT_EQ(parse_usda(format_usda(mesh, "out"), "out").tags.scheme, Scheme::bilinear);
  EXPECT_EQ(parse_usda(format_usda(mesh, "out"), "out").tags.boundary, BoundaryRule::none);
  std::vector<std::string> notes;
  mesh.tags.scheme = Scheme::doo_sabin;
  mesh.tags.crease_method = CreaseMethod::chaikin;
  static_cast<void>(format_usda(mesh, "out.usda", [&](const std::string& line) { notes.push_back(line); }));
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_EQ(notes[0], "out.usda: USD has no scheme doo-sabin: the faces are written as they are");
}

TEST(usda, prims_are_parts_with_their_own_rules) {
  const std::string
      place =
          "double3 xformOp:translate = (5, 0, 0)\nuniform token[] xformOpOrder = [\"xformOp:translate\"]\n",
      mirror = "double3 xformOp:scale = (-1, 1, 1)\nuniform token[] xformOpOrder = [\"xformOp:scale\"]\n";
  const std::string text =
      "#usda 1.0\n(\n    metersPerUnit = 0.01\n)\n" + mesh_prim(quad + place, "a") + "def Xform \"x\"\n{\n" +
      mesh_prim(triangle + "uniform token subdivisionScheme = \"loop\"\n" + mirror, "a") + "}\n";
  const MeshAssembly parts = parse_assembly(text, "in.usda");
  ASSERT_EQ(parts.parts.size(), 2u);
  EXPECT_EQ(parts.parts[0].name, "a");
  EXPECT_EQ(parts.parts[1].name, "a#2");
  EXPECT_EQ(parts.parts[0].pose, Motion::translation({5, 0, 0}));
  EXPECT_EQ(parts.meshes[0].points[0], (Point3{0, 0, 0}));
  EXPECT_EQ(parts.meshes[0].tags.scheme, Scheme::catmark);
  EXPECT_EQ(parts.meshes[1].tags.scheme, Scheme::loop);
  EXPECT_EQ(parts.meshes[1].points[1], (Point3{-1, 0, 0}));
  EXPECT_EQ(corners(parts.meshes[1], 0), (Ids{0, 2, 1}));
  EXPECT_EQ(parts.meshes[1].metres_per_unit, 0.01);
  // Together their rules would have to agree.
  EXPECT_NE(unreadable([&] { static_cast<void>(parse_usda(text, "in.usda")); }).find("is not that of"),
            std::string::npos);
}

}  // namespace
}  // namespace snug::usda_test
