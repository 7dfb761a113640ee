#include <snug/mesh/loose_creases.h>

#include <gtest/gtest.h>

#include <array>
#include <random>

namespace snug::loose_creases_test {
namespace {

using Places = std::vector<std::size_t>;

TEST(loose_creases, are_those_that_no_face_has_as_an_edge) {
  std::mt19937_64 random(5);
  const auto vertex = [&] { return VertexId(random() % 7); };
  std::size_t loose = 0, good = 0;
  for (int trial = 0; trial < 500; ++trial) {
    ControlMesh mesh;
    mesh.points.resize(7);
    std::array<std::array<bool, 7>, 7> edge{};
    for (std::size_t f = random() % 4; f > 0; --f) {
      std::vector<VertexId> face(3 + random() % 3);
      for (VertexId& v : face) v = vertex();
      mesh.add_face(face);
      for (std::size_t i = 0; i < face.size(); ++i) {
        const std::size_t a = face[i].index(), b = face[(i + 1) % face.size()].index();
        edge[a][b] = edge[b][a] = true;
      }
    }
    Places expected;
    for (std::size_t i = 0; i < 5; ++i) {
      mesh.tags.creases.push_back({vertex(), vertex(), 1});
      if (!edge[mesh.tags.creases[i].a.index()][mesh.tags.creases[i].b.index()]) expected.push_back(i);
    }
    ASSERT_EQ(loose_creases(mesh), expected);
    loose += expected.size(), good += 5 - expected.size();
  }
  EXPECT_GT(loose, 100u);
  EXPECT_GT(good, 100u);
}

}  // namespace
}  // namespace snug::loose_creases_test
