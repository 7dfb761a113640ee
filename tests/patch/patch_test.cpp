#include <snug/patch/patch.h>

#include <gtest/gtest.h>
#include <snug/patch/evaluate.h>
#include <testing/twins.h>

namespace snug::patch_test {
namespace {

TEST(piece_path, remembers_its_digits_and_maps_parameters) {
  const PiecePath path = PiecePath().child(1).child(3).child(0);
  EXPECT_EQ(path.text(), "130");
  EXPECT_EQ(path.level(), 3u);
  const TriangleParameter p =
      to_face(path, {0, 0});  // corner 0 of the middle piece faces corner 0 of piece 1
  EXPECT_EQ(p.u, 0.75);
  EXPECT_EQ(p.v, 0.25);
  PiecePath deep;
  for (unsigned i = 0; i < PiecePath::max_level; ++i) deep = deep.child(i % 4);
  EXPECT_EQ(deep.digit(59), 3u);
}

// A piece's limit points are the whole patch's at the mapped parameters.
TEST(split, keeps_the_limit_surface) {
  KindCache library;
  std::mt19937_64 random(16);
  for (const oracle::TwinMesh& twin : testing::assorted_meshes(16)) {
    if (twin.boundary == oracle::Boundary::none) continue;
    const ControlMesh mesh = testing::control_mesh(twin);
    const Topology topology(mesh);
    const SchemeOptions options = testing::rules(twin);
    for (std::size_t f = 0; f < topology.face_count(); f += 3) {
      const TurnedKey key = kind_key(topology, FaceId(f), options);
      std::vector<VertexId> control;
      library.find(key.key).control_vertices(topology, topology.first_of(FaceId(f)) + key.first, control);
      const Patch whole = make_patch(library.find(key.key), key.first, mesh.points, control);
      Patch piece = whole;
      for (int level = 0; level < 6; ++level) {
        piece = split(piece, static_cast<unsigned>(random() % 4));
        for (const TriangleParameter at : {TriangleParameter{0, 0}, {1, 0}, {0, 1}, {0.25, 0.5}}) {
          const RelativePoint own = limit_point(piece, at),
                              root = limit_point(whole, to_face(piece.path, at));
          for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_NEAR(own.relative[k], root.relative[k], own.error + root.error)
                << f << " " << piece.path.text();
          }
        }
      }
    }
  }
}

// Control points that are off by as much as `error` allows: what is made of them is off by no more than it
// says.
TEST(patch_error, covers_points_that_are_off_through_splits_and_evaluation) {
  KindCache library;
  std::mt19937_64 random(32);
  for (const oracle::TwinMesh& twin : testing::assorted_meshes(32)) {
    if (twin.boundary == oracle::Boundary::none) continue;
    const ControlMesh mesh = testing::control_mesh(twin);
    const Topology topology(mesh);
    for (std::size_t f = 0; f < topology.face_count(); f += 5) {
      const TurnedKey key = kind_key(topology, FaceId(f), testing::rules(twin));
      std::vector<VertexId> control;
      library.find(key.key).control_vertices(topology, topology.first_of(FaceId(f)) + key.first, control);
      Patch exact = make_patch(library.find(key.key), key.first, mesh.points, control);
      Patch off = exact;
      const double error = 1e-3;
      off.error = error;
      const bool all_alike = random() % 2;  // the worst case for masks that are not negative
      for (Vector3& p : off.points) {
        p = p + (all_alike || random() % 2 ? error : -error) * Vector3{1, -1, 1};
        off.largest = std::max(off.largest, max_abs(p));
      }
      for (int level = 0; level < 8; ++level) {
        for (const TriangleParameter at : {TriangleParameter{0, 0}, {1, 0}, {0, 1}, {0.3, 0.4}}) {
          const RelativePoint a = limit_point(exact, at), b = limit_point(off, at);
          EXPECT_LE(max_abs(a.relative - b.relative), b.error + a.error);
        }
        const auto child = static_cast<unsigned>(random() % 4);
        exact = split(exact, child);
        off = split(off, child);
        for (std::size_t i = 0; i < exact.points.size(); ++i) {
          EXPECT_LE(max_abs(exact.points[i] - off.points[i]), off.error + exact.error);
        }
      }
    }
  }
}

}  // namespace
}  // namespace snug::patch_test
