#include <algorithm>
#include <array>
#include <initializer_list>
#include <memory>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <snug/adapters/opensubdiv.h>
#include <snug/evaluate.h>
#include <snug/io/formats.h>
#include <snug/mesh.h>
#include <snug/search/surface_data.h>
#include <testing/places.h>

namespace snug::opensubdiv_test {
namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;
using opensubdiv::from_refiner;
using opensubdiv::MeshAndOptions;
using Refiner = std::unique_ptr<Far::TopologyRefiner>;

Sdc::Options rules_of(const MeshTags& tags) {
  Sdc::Options rules;
  const BoundaryRule boundary = tags.boundary.value_or(BoundaryRule::edge_and_corner);
  rules.SetVtxBoundaryInterpolation(boundary == BoundaryRule::none ? Sdc::Options::VTX_BOUNDARY_NONE
                                    : boundary == BoundaryRule::edge_only
                                        ? Sdc::Options::VTX_BOUNDARY_EDGE_ONLY
                                        : Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
  rules.SetCreasingMethod(tags.crease_method == CreaseMethod::chaikin ? Sdc::Options::CREASE_CHAIKIN
                                                                      : Sdc::Options::CREASE_UNIFORM);
  rules.SetTriangleSubdivision(tags.smooth_triangles == SmoothTriangles::smooth
                                   ? Sdc::Options::TRI_SUB_SMOOTH
                                   : Sdc::Options::TRI_SUB_CATMARK);
  return rules;
}

/// The refiner of a mesh and its tags, by way of OpenSubdiv's own descriptor.
Refiner refiner_of(const ControlMesh& mesh, Sdc::SchemeType scheme, bool left_handed = false) {
  std::vector<int> sizes, indices, ends, corners, holes;
  std::vector<float> sharpnesses, corner_sharpnesses;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    sizes.push_back(static_cast<int>(mesh.face(FaceId(f)).size()));
    for (const VertexId v : mesh.face(FaceId(f))) indices.push_back(static_cast<int>(v.value()));
  }
  for (const CreaseTag& tag : mesh.tags.creases) {
    ends.push_back(static_cast<int>(tag.a.value()));
    ends.push_back(static_cast<int>(tag.b.value()));
    sharpnesses.push_back(static_cast<float>(tag.sharpness));
  }
  for (const CornerTag& tag : mesh.tags.corners) {
    corners.push_back(static_cast<int>(tag.vertex.value()));
    corner_sharpnesses.push_back(static_cast<float>(tag.sharpness));
  }
  for (const FaceId f : mesh.tags.holes) holes.push_back(static_cast<int>(f.value()));

  Far::TopologyDescriptor description;
  description.numVertices = static_cast<int>(mesh.vertex_count());
  description.numFaces = static_cast<int>(mesh.face_count());
  description.numVertsPerFace = sizes.data();
  description.vertIndicesPerFace = indices.data();
  description.numCreases = static_cast<int>(sharpnesses.size());
  description.creaseVertexIndexPairs = ends.data();
  description.creaseWeights = sharpnesses.data();
  description.numCorners = static_cast<int>(corners.size());
  description.cornerVertexIndices = corners.data();
  description.cornerWeights = corner_sharpnesses.data();
  description.numHoles = static_cast<int>(holes.size());
  description.holeIndices = holes.data();
  description.isLeftHanded = left_handed;
  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  Refiner refiner(Factory::Create(description, Factory::Options(scheme, rules_of(mesh.tags))));
  EXPECT_NE(refiner, nullptr);
  return refiner;
}

using Creases = std::vector<std::tuple<VertexId, VertexId, double>>;
Creases sorted_creases(const MeshTags& tags) {
  Creases creases;
  for (const CreaseTag& t : tags.creases)
    creases.emplace_back(std::min(t.a, t.b), std::max(t.a, t.b), t.sharpness);
  std::sort(creases.begin(), creases.end());
  return creases;
}
using Corners = std::vector<std::pair<VertexId, double>>;
Corners sorted_corners(const MeshTags& tags) {
  Corners corners;
  for (const CornerTag& t : tags.corners) corners.emplace_back(t.vertex, t.sharpness);
  std::sort(corners.begin(), corners.end());
  return corners;
}
std::vector<FaceId> sorted_holes(const MeshTags& tags) {
  std::vector<FaceId> holes = tags.holes;
  std::sort(holes.begin(), holes.end());
  return holes;
}

void expect_same_faces(const ControlMesh& a, const ControlMesh& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.face_offsets, b.face_offsets);
  EXPECT_EQ(a.face_vertices, b.face_vertices);
}

void expect_same_tags(const MeshTags& a, const MeshTags& b) {
  EXPECT_EQ(sorted_creases(a), sorted_creases(b));
  EXPECT_EQ(sorted_corners(a), sorted_corners(b));
  EXPECT_EQ(sorted_holes(a), sorted_holes(b));
  EXPECT_EQ(a.crease_method, b.crease_method);
  EXPECT_EQ(a.smooth_triangles, b.smooth_triangles);
}

/// All that the surface of a refiner depends on.
void expect_same_base_level(const Far::TopologyRefiner& a, const Far::TopologyRefiner& b) {
  EXPECT_EQ(a.GetSchemeType(), b.GetSchemeType());
  const Sdc::Options rules_a = a.GetSchemeOptions(), rules_b = b.GetSchemeOptions();
  EXPECT_EQ(rules_a.GetCreasingMethod(), rules_b.GetCreasingMethod());
  EXPECT_EQ(rules_a.GetTriangleSubdivision(), rules_b.GetTriangleSubdivision());
  const Far::TopologyLevel &p = a.GetLevel(0), &q = b.GetLevel(0);
  ASSERT_EQ(p.GetNumVertices(), q.GetNumVertices());
  ASSERT_EQ(p.GetNumEdges(), q.GetNumEdges());
  ASSERT_EQ(p.GetNumFaces(), q.GetNumFaces());
  for (int v = 0; v < p.GetNumVertices(); ++v)
    EXPECT_EQ(p.GetVertexSharpness(v), q.GetVertexSharpness(v)) << v;
  for (int e = 0; e < p.GetNumEdges(); ++e) EXPECT_EQ(p.GetEdgeSharpness(e), q.GetEdgeSharpness(e)) << e;
  for (int f = 0; f < p.GetNumFaces(); ++f) EXPECT_EQ(p.IsFaceHole(f), q.IsFaceHole(f)) << f;
}

/// A position, in the form that Far asks for.
struct Primvar {
  Point3 value;
  void Clear() { value = {}; }
  void AddWithWeight(const Primvar& other, double weight) {
    value = value + weight * (other.value - Point3{});
  }
};

/// Limit positions after two steps of uniform refinement.
std::vector<Point3> limit_points(Far::TopologyRefiner& refiner, const std::vector<Point3>& points) {
  Far::TopologyRefiner::UniformOptions uniform(2);
  uniform.fullTopologyInLastLevel = true;
  refiner.RefineUniform(uniform);
  const Far::PrimvarRefinerReal<double> interpolate(refiner);
  std::vector<Primvar> values(points.size());
  for (std::size_t v = 0; v < points.size(); ++v) values[v].value = points[v];
  for (int level = 1; level <= 2; ++level) {
    std::vector<Primvar> fine(static_cast<std::size_t>(refiner.GetLevel(level).GetNumVertices()));
    interpolate.Interpolate(level, values, fine);
    values = std::move(fine);
  }
  std::vector<Primvar> limit(values.size());
  interpolate.Limit(values, limit);
  std::vector<Point3> result;
  for (const Primvar& p : limit) result.push_back(p.value);
  return result;
}

/// Mesh -> refiner -> mesh: the same. The way back leads to the same refiner, too.
void expect_round_trip(const ControlMesh& mesh, Scheme scheme = Scheme::catmark) {
  const Sdc::SchemeType type = scheme == Scheme::loop ? Sdc::SCHEME_LOOP : Sdc::SCHEME_CATMARK;
  const Refiner refiner = refiner_of(mesh, type);
  const MeshAndOptions answer = from_refiner(*refiner, mesh.points);
  expect_same_faces(answer.mesh, mesh);
  expect_same_tags(answer.mesh.tags, mesh.tags);
  EXPECT_EQ(answer.options.scheme, scheme);
  EXPECT_EQ(answer.options.boundary, mesh.tags.boundary.value_or(BoundaryRule::edge_and_corner));
  EXPECT_EQ(answer.mesh.tags.boundary, answer.options.boundary);
  expect_same_base_level(*refiner, *refiner_of(answer.mesh, type));
}

void add_face(ControlMesh& mesh, std::initializer_list<std::size_t> corners) {
  std::vector<VertexId> face;
  for (const std::size_t v : corners) face.emplace_back(v);
  mesh.add_face(face);
}

/// Vertex x + 2 y + 4 z at (x, y, z).
ControlMesh cube() {
  ControlMesh mesh;
  for (int v = 0; v < 8; ++v) mesh.points.push_back({double(v & 1), double((v >> 1) & 1), double(v >> 2)});
  for (const auto& f :
       {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    add_face(mesh, {std::size_t(f[0]), std::size_t(f[1]), std::size_t(f[2]), std::size_t(f[3])});
  }
  return mesh;
}

/// columns x rows quads; vertex x + (columns + 1) y at (x, y, 0).
ControlMesh grid(std::size_t columns, std::size_t rows) {
  ControlMesh mesh;
  for (std::size_t y = 0; y <= rows; ++y)
    for (std::size_t x = 0; x <= columns; ++x) mesh.points.push_back({double(x), double(y), 0});
  for (std::size_t y = 0; y < rows; ++y) {
    for (std::size_t x = 0; x < columns; ++x) {
      const std::size_t v = x + (columns + 1) * y;
      add_face(mesh, {v, v + 1, v + columns + 2, v + columns + 1});
    }
  }
  return mesh;
}

ControlMesh icosahedron() {
  return parse_obj(
      "v 0 1 1.618\nv 0 -1 1.618\nv 0 1 -1.618\nv 0 -1 -1.618\nv 1 1.618 0\nv -1 1.618 0\nv 1 -1.618 0\n"
      "v -1 -1.618 0\nv 1.618 0 1\nv -1.618 0 1\nv 1.618 0 -1\nv -1.618 0 -1\n"
      "f 1 2 9\nf 1 10 2\nf 1 9 5\nf 1 5 6\nf 1 6 10\nf 2 10 8\nf 2 8 7\nf 2 7 9\nf 9 7 11\nf 9 11 5\n"
      "f 5 11 3\nf 5 3 6\nf 6 3 12\nf 6 12 10\nf 10 12 8\nf 8 12 4\nf 8 4 7\nf 7 4 11\nf 11 4 3\nf 3 4 12\n",
      "icosahedron");
}

TEST(opensubdiv_adapter, keeps_creases_of_every_sharpness_and_corners) {
  ControlMesh mesh = cube();
  mesh.tags.creases = {{VertexId(0), VertexId(1), 0.5},  {VertexId(1), VertexId(3), 2},
                       {VertexId(3), VertexId(2), 3.25}, {VertexId(2), VertexId(0), 9.75},
                       {VertexId(4), VertexId(5), 10},   {VertexId(5), VertexId(7), 12}};
  mesh.tags.corners = {{VertexId(7), 1.5}, {VertexId(4), 10}};
  expect_round_trip(mesh);
  mesh.tags.crease_method = CreaseMethod::chaikin;
  expect_round_trip(mesh);
}

TEST(opensubdiv_adapter, orders_tags) {
  ControlMesh mesh = cube();
  mesh.tags.creases = {
      {VertexId(7), VertexId(5), 1}, {VertexId(3), VertexId(1), 2}, {VertexId(1), VertexId(0), 3}};
  mesh.tags.corners = {{VertexId(6), 1}, {VertexId(2), 2}};
  mesh.tags.holes = {FaceId(4), FaceId(1)};
  const MeshTags tags = from_refiner(*refiner_of(mesh, Sdc::SCHEME_CATMARK), mesh.points).mesh.tags;
  ASSERT_EQ(tags.creases.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LT(tags.creases[i].a, tags.creases[i].b);
  EXPECT_EQ(tags.creases[0].b, VertexId(1));
  EXPECT_EQ(tags.creases[1].b, VertexId(3));
  ASSERT_EQ(tags.corners.size(), 2U);
  EXPECT_EQ(tags.corners[0].vertex, VertexId(2));
  EXPECT_EQ(tags.holes, (std::vector{FaceId(1), FaceId(4)}));
}

TEST(opensubdiv_adapter, leaves_out_what_no_sharpness_makes_sharp) {
  ControlMesh mesh = cube();
  mesh.tags.creases = {{VertexId(0), VertexId(1), 0}, {VertexId(1), VertexId(3), -1}};
  mesh.tags.corners = {{VertexId(7), 0}};
  const MeshTags tags = from_refiner(*refiner_of(mesh, Sdc::SCHEME_CATMARK), mesh.points).mesh.tags;
  EXPECT_TRUE(tags.creases.empty());
  EXPECT_TRUE(tags.corners.empty());
}

TEST(opensubdiv_adapter, reads_what_an_obj_text_says) {
  const ControlMesh mesh = parse_obj(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
      "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n"
      "t crease 5/4/0 0 1 3 2 0 1.5 2.5 3 10\nt corner 2/2/0 7 4 10 2\nt hole 1/0/0 1\n"
      "t interpolateboundary 1/0/0 2\nt creasemethod 0/0/1 chaikin\nt smoothtriangles 0/0/1 smooth\n",
      "cube");
  EXPECT_EQ(mesh.tags.creases.size(), 4U);
  EXPECT_EQ(mesh.tags.boundary, BoundaryRule::edge_only);
  expect_round_trip(mesh);
}

TEST(opensubdiv_adapter, makes_no_tags_of_boundaries) {
  for (const BoundaryRule rule :
       {BoundaryRule::edge_and_corner, BoundaryRule::edge_only, BoundaryRule::none}) {
    for (ControlMesh mesh : {grid(4, 3), grid(1, 1), grid(2, 1)}) {
      mesh.tags.boundary = rule;
      expect_round_trip(mesh);
    }
  }
}

TEST(opensubdiv_adapter, keeps_corners_that_the_rule_does_not_make) {
  ControlMesh mesh = grid(3, 3);
  mesh.tags.boundary = BoundaryRule::edge_only;
  mesh.tags.corners = {{VertexId(0), 10}, {VertexId(3), 1.5}, {VertexId(1), 2}, {VertexId(5), 3}};
  expect_round_trip(mesh);
  mesh.tags.boundary = BoundaryRule::edge_and_corner;
  const Refiner refiner = refiner_of(mesh, Sdc::SCHEME_CATMARK);
  const MeshAndOptions answer = from_refiner(*refiner, mesh.points);
  EXPECT_EQ(sorted_corners(answer.mesh.tags), (Corners{{VertexId(1), 2}, {VertexId(5), 3}}));
  expect_same_base_level(*refiner, *refiner_of(answer.mesh, Sdc::SCHEME_CATMARK));
}

TEST(opensubdiv_adapter, keeps_holes) {
  for (const BoundaryRule rule :
       {BoundaryRule::edge_and_corner, BoundaryRule::edge_only, BoundaryRule::none}) {
    ControlMesh mesh = grid(5, 4);
    mesh.tags.boundary = rule;
    mesh.tags.holes = {FaceId(6), FaceId(12)};  // inside
    expect_round_trip(mesh);
  }
  ControlMesh mesh = grid(5, 4);
  mesh.tags.holes = {FaceId(0), FaceId(7), FaceId(19)};
  expect_round_trip(mesh);
  mesh = cube();
  mesh.tags.boundary = BoundaryRule::none;
  mesh.tags.holes = {FaceId(2)};
  expect_round_trip(mesh);
}

// OpenSubdiv: no boundary interpolation, except where boundary edges were explicitly sharpened.
TEST(opensubdiv_adapter, keeps_faces_at_boundaries_that_were_sharp_before) {
  ControlMesh mesh = grid(4, 4);
  mesh.tags.boundary = BoundaryRule::none;
  for (std::size_t x = 0; x < 4; ++x) mesh.tags.creases.push_back({VertexId(x), VertexId(x + 1), 10});
  const Refiner refiner = refiner_of(mesh, Sdc::SCHEME_CATMARK);
  ASSERT_FALSE(refiner->GetLevel(0).IsFaceHole(1));
  ASSERT_TRUE(refiner->GetLevel(0).IsFaceHole(0));
  const MeshAndOptions answer = from_refiner(*refiner, mesh.points);
  EXPECT_EQ(answer.options.boundary, BoundaryRule::edge_only);
  EXPECT_EQ(answer.mesh.tags.boundary, BoundaryRule::edge_only);
  EXPECT_TRUE(answer.mesh.tags.creases.empty());
  EXPECT_EQ(answer.mesh.tags.holes.size(), 10U);  // all at the other three sides
  expect_same_base_level(*refiner, *refiner_of(answer.mesh, Sdc::SCHEME_CATMARK));
}

TEST(opensubdiv_adapter, leads_to_the_same_refiner_and_limit_from_random_tags) {
  std::mt19937_64 random(41);
  const auto pick = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  std::size_t replaced = 0;
  for (int round = 0; round < 400; ++round) {
    const std::size_t columns = 1 + pick(5), rows = 1 + pick(5);
    ControlMesh mesh = grid(columns, rows);
    for (Point3& p : mesh.points) p.z = static_cast<double>(pick(100)) / 100;
    mesh.tags.boundary =
        std::array{BoundaryRule::none, BoundaryRule::edge_only, BoundaryRule::edge_and_corner}[pick(3)];
    if (pick(2) == 0) mesh.tags.crease_method = CreaseMethod::chaikin;
    if (pick(2) == 0) mesh.tags.smooth_triangles = SmoothTriangles::smooth;
    const double sharpnesses[] = {0.1, 1, 2.5, 9.999, 10, 10, 20};
    const std::size_t first = pick(2) * 4;  // in every other round all are infinite, and on most edges
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
      const auto face = mesh.face(FaceId(f));
      for (std::size_t k = 0; k < 4; ++k) {
        if (pick(4) < (first == 0 ? 3U : 1U)) continue;
        mesh.tags.creases.push_back({face[k], face[(k + 1) % 4], sharpnesses[first + pick(7 - first)]});
      }
      if (pick(5) == 0) mesh.tags.corners.push_back({face[pick(4)], sharpnesses[pick(7)]});
      if (pick(8) == 0) mesh.tags.holes.push_back(FaceId(f));
    }
    const Refiner refiner = refiner_of(mesh, Sdc::SCHEME_CATMARK);
    const MeshAndOptions answer = from_refiner(*refiner, mesh.points);
    expect_same_faces(answer.mesh, mesh);
    const Refiner again = refiner_of(answer.mesh, Sdc::SCHEME_CATMARK);
    expect_same_base_level(*refiner, *again);
    EXPECT_EQ(limit_points(*refiner, mesh.points), limit_points(*again, mesh.points));
    replaced += answer.options.boundary != *mesh.tags.boundary ? 1 : 0;
    if (HasFailure()) FAIL() << "round " << round;
  }
  EXPECT_GT(replaced, 10U);  // boundaries without a rule, sharp in part
}

TEST(opensubdiv_adapter, keeps_polygons_of_any_size) {
  // A cube whose top is a pyramid, one side of which has lost an edge: triangles, quads and a pentagon.
  ControlMesh mesh;
  for (const Point3& p : cube().points) mesh.points.push_back(p);
  mesh.points.push_back({0.5, 0.5, 2});
  add_face(mesh, {0, 2, 3, 1});
  add_face(mesh, {0, 1, 5, 8, 4});
  add_face(mesh, {2, 6, 7, 3});
  add_face(mesh, {0, 4, 6, 2});
  add_face(mesh, {1, 3, 7, 5});
  add_face(mesh, {5, 7, 8});
  add_face(mesh, {7, 6, 8});
  add_face(mesh, {6, 4, 8});
  mesh.tags.creases = {{VertexId(4), VertexId(8), 1}, {VertexId(6), VertexId(7), 2}};
  mesh.tags.smooth_triangles = SmoothTriangles::smooth;
  expect_round_trip(mesh);
}

TEST(opensubdiv_adapter, keeps_the_points_of_unused_vertices) {
  ControlMesh mesh = cube();
  mesh.points.push_back({7, 8, 9});
  expect_round_trip(mesh);
}

TEST(opensubdiv_adapter, turns_left_handed_faces_around) {
  const ControlMesh mesh = cube();
  ControlMesh turned = mesh;
  for (std::size_t f = 0; f < turned.face_count(); ++f) {
    const auto first = turned.face_vertices.begin() + turned.face_offsets[f];
    std::reverse(first + 1, first + 4);
  }
  const Refiner refiner = refiner_of(turned, Sdc::SCHEME_CATMARK, true);
  expect_same_faces(from_refiner(*refiner, mesh.points).mesh, mesh);
}

TEST(opensubdiv_adapter, hands_on_non_manifold_meshes) {
  ControlMesh mesh;  // three quads at the edge (0, 1)
  mesh.points = {{0, 0, 0},  {0, 0, 1},  {1, 0, 0},   {1, 0, 1},
                 {-1, 1, 0}, {-1, 1, 1}, {-1, -1, 0}, {-1, -1, 1}};
  add_face(mesh, {0, 2, 3, 1});
  add_face(mesh, {0, 1, 5, 4});
  add_face(mesh, {0, 1, 7, 6});
  for (const BoundaryRule rule :
       {BoundaryRule::edge_and_corner, BoundaryRule::edge_only, BoundaryRule::none}) {
    mesh.tags.boundary = rule;
    expect_round_trip(mesh);
  }
  MeshAndOptions answer = from_refiner(*refiner_of(mesh, Sdc::SCHEME_CATMARK), mesh.points);
  const Surface handle(std::move(answer.mesh), answer.options);
  const LimitSurface& surface = handle.data()->limit();
  EXPECT_EQ(surface.patch_count(), 6u);
}

TEST(opensubdiv_adapter, keeps_corners_on_the_edge_of_a_wall_inside) {
  // Two cubes side by side with a wall between them: its vertices are smooth along its edges unless they are
  // tagged.
  ControlMesh mesh;
  for (std::size_t v = 0; v < 12; ++v) {
    mesh.points.push_back({double(v / 4), double(v % 4 / 2), double(v % 2)});
  }
  add_face(mesh, {0, 1, 3, 2});
  add_face(mesh, {8, 10, 11, 9});
  add_face(mesh, {4, 6, 7, 5});
  for (const std::size_t x : {0, 4}) {
    add_face(mesh, {x, x + 4, x + 5, x + 1});
    add_face(mesh, {x + 2, x + 3, x + 7, x + 6});
    add_face(mesh, {x, x + 2, x + 6, x + 4});
    add_face(mesh, {x + 1, x + 5, x + 7, x + 3});
  }
  expect_round_trip(mesh);
  mesh.tags.corners = {{VertexId(4), 10}, {VertexId(7), 2.5}};
  expect_round_trip(mesh);
}

TEST(opensubdiv_adapter, hands_loop_meshes_to_surface) {
  const ControlMesh bust = read_mesh(testing::models_dir() + "/bust.obj");
  for (const ControlMesh& mesh : {icosahedron(), bust}) {
    expect_round_trip(mesh, Scheme::loop);
    MeshAndOptions answer = from_refiner(*refiner_of(mesh, Sdc::SCHEME_LOOP), mesh.points);
    const Surface handle(std::move(answer.mesh), answer.options), other(mesh);
    const LimitSurface &surface = handle.data()->limit(), &direct = other.data()->limit();
    ASSERT_EQ(surface.face_count(), direct.face_count());
    EXPECT_EQ(surface.kind_count(), direct.kind_count());
    for (std::size_t f = 0; f < surface.face_count(); ++f) {
      EXPECT_EQ(&surface.kind(PatchId(f)), &direct.kind(PatchId(f)));
      EXPECT_EQ(surface.patch(PatchId(f)).origin, direct.patch(PatchId(f)).origin);
    }
  }
}

TEST(opensubdiv_adapter, keeps_tags_of_loop_meshes) {
  ControlMesh mesh = icosahedron();
  mesh.tags.creases = {{VertexId(0), VertexId(1), 2}, {VertexId(0), VertexId(4), 10}};
  mesh.tags.corners = {{VertexId(3), 1}};
  mesh.tags.holes = {FaceId(5)};
  mesh.tags.crease_method = CreaseMethod::chaikin;
  expect_round_trip(mesh, Scheme::loop);
}

TEST(opensubdiv_adapter, reads_the_base_level_of_a_refined_refiner) {
  ControlMesh mesh = grid(4, 3);
  mesh.tags.creases = {{VertexId(6), VertexId(7), 2.5}};
  mesh.tags.corners = {{VertexId(8), 1}};
  mesh.tags.holes = {FaceId(5)};
  const Refiner uniform = refiner_of(mesh, Sdc::SCHEME_CATMARK),
                adaptive = refiner_of(mesh, Sdc::SCHEME_CATMARK);
  uniform->RefineUniform(Far::TopologyRefiner::UniformOptions(3));
  adaptive->RefineAdaptive(Far::TopologyRefiner::AdaptiveOptions(4));
  ASSERT_GT(uniform->GetNumLevels(), 1);
  ASSERT_GT(adaptive->GetNumLevels(), 1);
  for (const Refiner* refiner : {&uniform, &adaptive}) {
    const MeshAndOptions answer = from_refiner(**refiner, mesh.points);
    expect_same_faces(answer.mesh, mesh);
    expect_same_tags(answer.mesh.tags, mesh.tags);
  }
}

TEST(opensubdiv_adapter, reads_points_in_every_form) {
  const ControlMesh mesh = cube();
  const Refiner refiner = refiner_of(mesh, Sdc::SCHEME_CATMARK);
  std::vector<float> tight, wide{-1, -1};  // wide: two numbers before, four from point to point, none after
  std::vector<double> doubles;
  for (const Point3& p : mesh.points) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      tight.push_back(static_cast<float>(p[axis]));
      doubles.push_back(p[axis]);
      wide.push_back(static_cast<float>(p[axis]));
    }
    wide.push_back(-1);
  }
  wide.pop_back();
  EXPECT_EQ(from_refiner(*refiner, tight).mesh.points, mesh.points);
  EXPECT_EQ(from_refiner(*refiner, doubles).mesh.points, mesh.points);
  EXPECT_EQ(from_refiner(*refiner, std::span<const float>(wide).subspan(2), 4).mesh.points, mesh.points);
  // Points of refined levels behind those of the base level.
  std::vector<Point3> more = mesh.points;
  more.push_back({9, 9, 9});
  EXPECT_EQ(from_refiner(*refiner, more).mesh.points, mesh.points);
  // A float is the double of the same value.
  tight[0] = 0.1F;
  EXPECT_EQ(from_refiner(*refiner, tight).mesh.points[0].x, static_cast<double>(0.1F));
}

TEST(opensubdiv_adapter, needs_a_point_for_each_vertex) {
  const ControlMesh mesh = cube();
  const Refiner refiner = refiner_of(mesh, Sdc::SCHEME_CATMARK);
  const std::vector<double> values(24);
  const std::span<const double> all(values);
  EXPECT_NO_THROW(static_cast<void>(from_refiner(*refiner, all)));
  EXPECT_THROW(static_cast<void>(from_refiner(*refiner, all.first(23))), InputError);
  EXPECT_THROW(static_cast<void>(from_refiner(*refiner, all.first(2))), InputError);
  EXPECT_THROW(static_cast<void>(from_refiner(*refiner, all, 4)), InputError);
  EXPECT_THROW(static_cast<void>(from_refiner(*refiner, all, 2)), InputError);
  EXPECT_THROW(static_cast<void>(from_refiner(*refiner, all, SIZE_MAX)), InputError);
  EXPECT_THROW(static_cast<void>(from_refiner(*refiner, std::span(mesh.points).first(7))), InputError);
}

TEST(opensubdiv_adapter, hands_over_bilinear_surfaces) {
  const ControlMesh mesh = cube();
  auto [taken, options] = from_refiner(*refiner_of(mesh, Sdc::SCHEME_BILINEAR), mesh.points);
  const Surface surface(std::move(taken), options);
  EXPECT_EQ(surface.scheme(), Scheme::bilinear);
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const std::span<const VertexId> face = mesh.face(FaceId(f));
    const SurfacePoint middle = evaluate(surface, {static_cast<std::uint32_t>(f), 0, 0.5, 0.5});
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double mean = 0;
      for (const VertexId v : face) mean += mesh.points[v.index()][axis] / 4;
      EXPECT_NEAR(middle.point[axis], mean, middle.error + 1e-15);
    }
  }
}

}  // namespace
}  // namespace snug::opensubdiv_test
