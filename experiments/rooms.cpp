#include <experiments/rooms.h>

#include <array>
#include <cmath>

#include <support/error.h>

namespace snug {
namespace {

// In [-1, 1). The standard's distributions differ from library to library.
double symmetric(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; }

// A unit quaternion, uniform on the sphere: a point of the ball, scaled.
std::array<double, 4> any_quaternion(std::mt19937_64& random) {
  for (;;) {
    std::array<double, 4> q;
    double norm_sq = 0;
    for (double& x : q) {
      x = symmetric(random);
      norm_sq += x * x;
    }
    if (norm_sq > 1 || norm_sq < 0.01) continue;
    for (double& x : q) x /= std::sqrt(norm_sq);
    return q;
  }
}

Motion any_pose(double reach, std::mt19937_64& random) {
  const auto [w, x, y, z] = any_quaternion(random);
  const std::array<double, 12> rotation{
      1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),     0,
      2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),     0,
      2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y), 0};
  Vector3 translation;
  for (std::size_t k = 0; k < 3; ++k) translation[k] = reach * symmetric(random);
  return Motion::from_3x4(rotation).with_offset(translation);
}

}  // namespace

ControlMesh unit_model(ControlMesh mesh) {
  const Box3 box = used_box(mesh);
  const double size = longest_side(box);
  require_value(size > 0 && std::isfinite(size),
                "unit model: the longest side of the box is 0 or does not fit a double; give another mesh");
  for (Point3& p : mesh.points) {
    for (std::size_t k = 0; k < 3; ++k) p[k] = (p[k] - 0.5 * (box.lower[k] + box.upper[k])) / size;
  }
  return mesh;
}

PosePair place_in_room(double side, std::mt19937_64& random) {
  require_value(side > 1 && std::isfinite(side), "room: the side must be finite and larger than 1");
  const double reach = (side - 1) / 2;
  const Motion a = any_pose(reach, random);
  return {a, any_pose(reach, random)};
}

}  // namespace snug
