#include <snug/mesh/topology.h>

#include <gtest/gtest.h>
#include <testing/twins.h>

namespace snug::topology_test {
namespace {

TEST(topology, half_edges_agree_with_each_other) {
  for (const oracle::TwinMesh& twin : testing::assorted_meshes(3)) {
    const ControlMesh mesh = testing::control_mesh(twin);
    const Topology topology(mesh);
    std::size_t boundary = 0;
    for (HalfEdge h = 0; h < topology.half_edge_count(); ++h) {
      EXPECT_EQ(topology.prev(topology.next(h)), h);
      EXPECT_EQ(topology.face_of(topology.next(h)), topology.face_of(h));
      const HalfEdge twin_edge = topology.twin(h);
      if (twin_edge == no_half_edge) {
        ++boundary;
        EXPECT_TRUE(topology.on_boundary(topology.edge_of(h)));
        continue;
      }
      EXPECT_EQ(topology.twin(twin_edge), h);
      EXPECT_EQ(topology.from(twin_edge), topology.to(h));
      EXPECT_EQ(topology.edge_of(twin_edge), topology.edge_of(h));
      EXPECT_EQ(topology.cw(topology.ccw(h) == no_half_edge ? h : topology.ccw(h)),
                topology.ccw(h) == no_half_edge ? topology.cw(h) : h);
    }
    EXPECT_EQ(2 * topology.edge_count(), topology.half_edge_count() + boundary);
  }
}

TEST(topology, walks_the_whole_fan_of_every_vertex) {
  for (const oracle::TwinMesh& twin : testing::assorted_meshes(4)) {
    const ControlMesh mesh = testing::control_mesh(twin);
    const Topology topology(mesh);
    std::vector<std::size_t> faces(mesh.vertex_count(), 0);
    for (const VertexId v : mesh.face_vertices) ++faces[v.index()];
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
      EXPECT_EQ(topology.face_valence(VertexId(v)), faces[v]);
  }
}

TEST(topology, edges_that_a_face_makes_twice_are_apart) {
  // Two triangles at an edge, and one that runs along it there and back.
  const std::vector<VertexId> corners{VertexId(0u), VertexId(1u), VertexId(2u), VertexId(1u), VertexId(0u),
                                      VertexId(3u), VertexId(0u), VertexId(1u), VertexId(1u)};
  const Topology topology({0, 3, 6, 9}, corners, 4);
  ASSERT_EQ(topology.edge_count(), 7u);
  const EdgeId shared = topology.edge_of(0), loop = topology.edge_of(7), back = topology.edge_of(8);
  EXPECT_EQ(topology.edge_of(3), shared);
  EXPECT_EQ(topology.edge_of(6), shared);
  EXPECT_EQ(topology.more_halves(shared), (std::vector<HalfEdge>{3, 6}));
  EXPECT_NE(back, shared);
  EXPECT_TRUE(topology.more_halves(back).empty());
  for (const EdgeId odd : {shared, loop, back}) {
    EXPECT_TRUE(topology.ends_fans(odd));
    EXPECT_FALSE(topology.is_manifold(odd));
  }
  EXPECT_FALSE(topology.on_boundary(shared));
  EXPECT_TRUE(topology.on_boundary(loop));
  EXPECT_TRUE(topology.on_boundary(back));
  for (const HalfEdge h : {1u, 2u, 4u, 5u}) EXPECT_TRUE(topology.is_manifold(topology.edge_of(h)));
}

}  // namespace
}  // namespace snug::topology_test
