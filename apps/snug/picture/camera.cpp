#include <picture/camera.h>

#include <limits>

#include <support/direction.h>
#include <support/error.h>

namespace snug {
namespace {

constexpr double half_angle_tangent = 0.24932800284318068;  // of 14 degrees
constexpr double margin = 0.05;

Vector3 unit(Vector3 v) {
  const Vector3 direction = normalized(v);
  require_value(direction != Vector3{}, "camera: view and up must be finite, not zero and not parallel");
  return direction;
}

// The lines of sight along both borders of the picture, moved until they touch the points from outside, cross
// at the eye. Coordinates: `across` the picture, and `depth` along the view.
class Wedge {
 public:
  explicit Wedge(double tangent) : tangent_(tangent) {}
  void add(double across, double depth) {
    high_ = std::max(high_, across - tangent_ * depth);
    low_ = std::min(low_, across + tangent_ * depth);
  }
  [[nodiscard]] double distance() const { return (high_ - low_) / (2 * tangent_); }
  [[nodiscard]] double middle() const { return (high_ + low_) / 2; }

 private:
  double tangent_;
  double high_ = -std::numeric_limits<double>::infinity(), low_ = std::numeric_limits<double>::infinity();
};

}  // namespace

Camera frame(std::span<const Point3> points, Vector3 view_direction, Vector3 up, double aspect) {
  require_value(!points.empty(), "camera: there is nothing to show");
  require_value(std::isfinite(aspect) && aspect > 0, "camera: width / height must be finite and positive");
  Camera camera;
  camera.tangent = half_angle_tangent;
  camera.forward = unit(view_direction);
  camera.right = unit(cross(camera.forward, unit(up)));
  camera.up = cross(camera.right, camera.forward);

  const double inner = (1 - 2 * margin) * camera.tangent;
  Wedge sideways(inner * aspect), upright(inner);
  Box3 box;
  double nearest = std::numeric_limits<double>::infinity();
  for (const Point3& p : points) {
    require_value(is_finite(p), "camera: a point to show is not finite");
    box.add(p);
    const Vector3 v = p - points.front();
    const double depth = dot(v, camera.forward);
    sideways.add(dot(v, camera.right), depth);
    upright.add(dot(v, camera.up), depth);
    nearest = std::min(nearest, depth);
  }
  const double size = longest_side(box);
  const double clear_of_the_eye = size > 0 ? 0.25 * size - nearest : 1;
  const double back = std::max(clear_of_the_eye, std::max(sideways.distance(), upright.distance()));
  camera.eye = points.front() + sideways.middle() * camera.right + upright.middle() * camera.up -
               back * camera.forward;
  return camera;
}

Camera frame(const Box3& box, Vector3 view_direction, Vector3 up, double aspect) {
  require_value(!box.empty(), "camera: the box to show is empty");
  Point3 corners[8];
  for (int i = 0; i < 8; ++i)
    corners[i] = {i & 1 ? box.upper.x : box.lower.x, i & 2 ? box.upper.y : box.lower.y,
                  i & 4 ? box.upper.z : box.lower.z};
  return frame(corners, view_direction, up, aspect);
}

}  // namespace snug
