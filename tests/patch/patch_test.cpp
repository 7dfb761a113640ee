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
  for (unsigned i = 0; i < PiecePath::max_level; ++i) EXPECT_EQ(deep.digit(i), i % 4);
}

// Children, one by one, against the lattice; both ways between parameters.
TEST(piece_path, counts_in_the_lattice_as_splits_do) {
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 500; ++trial) {
    PiecePath path;
    std::array<TriangleParameter, 3> corners{{{0, 0}, {1, 0}, {0, 1}}};
    std::string digits;
    for (unsigned level = 0; level <= 20; ++level) {
      EXPECT_EQ(path.level(), level);
      EXPECT_EQ(path.text(), digits);
      EXPECT_EQ(path.turned(), corners[1].u < corners[0].u);
      const PiecePath::Corners lattice = path.corners();
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(static_cast<double>(lattice[k][0]), corners[k].u * path.scale());
        EXPECT_EQ(static_cast<double>(lattice[k][1]), corners[k].v * path.scale());
      }
      const TriangleParameter own{static_cast<double>(random() % 9) / 16,
                                  static_cast<double>(random() % 7) / 16},
          whole = to_face(path, own), back = path.local(whole);
      EXPECT_EQ(whole.u,
                corners[0].u + own.u * (corners[1].u - corners[0].u) + own.v * (corners[2].u - corners[0].u));
      EXPECT_EQ(whole.v,
                corners[0].v + own.u * (corners[1].v - corners[0].v) + own.v * (corners[2].v - corners[0].v));
      EXPECT_EQ(back.u, own.u);
      EXPECT_EQ(back.v, own.v);
      const auto child = static_cast<unsigned>(random() % 4);
      EXPECT_EQ(path.child(child).parent(), path);
      EXPECT_EQ(path.child(child).ancestor(level / 2), path.ancestor(level / 2));
      path = path.child(child);
      digits += static_cast<char>('0' + child);
      const auto middle = [&](std::size_t k) {
        const TriangleParameter a = corners[k], b = corners[(k + 1) % 3];
        return TriangleParameter{(a.u + b.u) / 2, (a.v + b.v) / 2};
      };
      const std::array<TriangleParameter, 3> m{middle(0), middle(1), middle(2)};
      if (child == 0) corners = {corners[0], m[0], m[2]};
      if (child == 1) corners = {m[0], corners[1], m[1]};
      if (child == 2) corners = {m[2], m[1], corners[2]};
      if (child == 3) corners = {m[1], m[2], m[0]};
    }
  }
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
