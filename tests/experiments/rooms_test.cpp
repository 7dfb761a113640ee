#include <experiments/rooms.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace snug::rooms_test {
namespace {

TEST(rooms, a_unit_model_fills_a_box_of_size_one_around_the_origin) {
  ControlMesh mesh;
  mesh.points = {{3, 1, 5}, {7, 1, 5}, {3, 3, 6}, {100, 100, 100}};  // no face uses the last one
  mesh.add_face(std::vector{VertexId(0), VertexId(1), VertexId(2)});
  const Box3 box = used_box(unit_model(mesh));
  EXPECT_EQ(longest_side(box), 1);
  EXPECT_EQ(box, (Box3{{-0.5, -0.25, -0.125}, {0.5, 0.25, 0.125}}));
}

TEST(rooms, motions_are_rigid_and_middles_keep_half_a_unit_from_the_walls) {
  std::mt19937_64 random(4);
  double most = 0;
  for (int i = 0; i < 2000; ++i) {
    const PosePair pair = place_in_room(3, random);
    EXPECT_LT(pair.a.defect(), 1e-14);
    EXPECT_LT(pair.b.defect(), 1e-14);
    for (const Vector3& t : {pair.a.offset(), pair.b.offset()}) most = std::max(most, max_abs(t));
  }
  EXPECT_LE(most, 1);
  EXPECT_GT(most, 0.99);
}

// Of a rotation by a uniform random quaternion each entry has mean 0 and mean square 1/3.
TEST(rooms, rotations_are_uniform) {
  std::mt19937_64 random(5);
  constexpr int count = 20000;
  std::array<double, 12> sum{}, sum_sq{};
  for (int i = 0; i < count; ++i) {
    const std::array<double, 12> numbers = place_in_room(2, random).b.numbers();
    for (std::size_t k = 0; k < 12; ++k) {
      sum[k] += numbers[k] / count;
      sum_sq[k] += numbers[k] * numbers[k] / count;
    }
  }
  for (std::size_t k = 0; k < 12; ++k) {
    if (k % 4 == 3) continue;
    EXPECT_NEAR(sum[k], 0, 0.02);
    EXPECT_NEAR(sum_sq[k], 1.0 / 3, 0.02);
  }
}

}  // namespace
}  // namespace snug::rooms_test
