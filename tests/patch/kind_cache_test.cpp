#include <snug/patch/kind_cache.h>

#include <gtest/gtest.h>
#include <testing/twins.h>

#include <set>

namespace snug::kind_cache_test {
namespace {

std::set<KindId> kinds_of(KindCache& library, const oracle::TwinMesh& twin) {
  const Topology topology(testing::control_mesh(twin));
  std::set<KindId> kinds;
  for (std::size_t f = 0; f < topology.face_count(); ++f) {
    kinds.insert(library.find(kind_key(topology, FaceId(f), testing::rules(twin)).key).id());
  }
  return kinds;
}

TEST(kind_library, has_one_kind_for_all_faces_of_a_platonic_solid) {
  KindCache library;
  EXPECT_EQ(kinds_of(library, oracle::meshes::icosahedron()).size(), 1u);
  EXPECT_EQ(kinds_of(library, oracle::meshes::octahedron()).size(), 1u);
  EXPECT_EQ(library.size(), 2u);
}

TEST(kind_library, counts_control_points_by_valences) {
  KindCache library;
  const auto closed = [](std::uint16_t n) {
    return CornerFan{0, static_cast<std::uint16_t>(n - 1), true, false};
  };
  EXPECT_EQ(library.find({Scheme::loop, {closed(6), closed(6), closed(6)}}).control_count(), 12u);
  EXPECT_EQ(library.find({Scheme::loop, {closed(7), closed(6), closed(6)}}).control_count(), 13u);
  EXPECT_EQ(library.find({Scheme::loop, {closed(3), closed(6), closed(6)}}).control_count(), 9u);
  EXPECT_EQ(library.find({Scheme::loop, {closed(4), closed(5), closed(9)}}).control_count(), 12u);
  EXPECT_EQ(library.find({Scheme::loop, {closed(3), closed(3), closed(3)}}).control_count(),
            4u);  // tetrahedron
  const CornerFan lone{0, 0, false, true};
  EXPECT_EQ(library.find({Scheme::loop, {lone, lone, lone}}).control_count(), 3u);
}

TEST(kind_library, needs_few_kinds_after_one_refinement) {
  KindCache library;
  const Kind& irregular = library.find({Scheme::loop, {CornerFan{0, 4}, CornerFan{0, 6}, CornerFan{0, 8}}});
  for (std::size_t c = 0; c < 3; ++c) {
    const Kind& child = *irregular.children()[c].kind;
    std::size_t extraordinary = 0;
    for (std::size_t k = 0; k < 3; ++k) extraordinary += !child.regular_corner(k);
    EXPECT_EQ(extraordinary, 1u);
    // The corner's own child is of the child's own kind.
    const std::size_t own = (3 + c - irregular.children()[c].first) % 3;
    EXPECT_EQ(child.children()[own].kind, &child);
  }
  EXPECT_TRUE(irregular.children()[3].kind->polynomial());
}

TEST(kind_library, key_and_control_points_turn_together) {
  KindCache library;
  for (const oracle::TwinMesh& twin : testing::assorted_meshes(11)) {
    const ControlMesh mesh = testing::control_mesh(twin);
    const Topology topology(mesh);
    std::vector<VertexId> control;
    for (std::size_t f = 0; f < topology.face_count(); ++f) {
      const TurnedKey key = kind_key(topology, FaceId(f), testing::rules(twin));
      const Kind& kind = library.find(key.key);
      kind.control_vertices(topology, topology.first_of(FaceId(f)) + key.first, control);
      ASSERT_EQ(control.size(), kind.control_count());
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_EQ(control[k], topology.face(FaceId(f))[(k + key.first) % 3]);
      // Every face of the kind's neighbourhood is a face of the mesh.
      const Topology around = neighbourhood(key.key).topology;
      std::set<std::set<VertexId>> faces;
      for (std::size_t g = 0; g < topology.face_count(); ++g) {
        const auto face = topology.face(FaceId(g));
        faces.insert({face.begin(), face.end()});
      }
      for (std::size_t g = 0; g < around.face_count(); ++g) {
        std::set<VertexId> face;
        for (const VertexId v : around.face(FaceId(g))) face.insert(control[v.index()]);
        EXPECT_TRUE(faces.contains(face)) << "face " << f << ", neighbour " << g;
      }
    }
  }
}

}  // namespace
}  // namespace snug::kind_cache_test
