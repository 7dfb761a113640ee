#include <support/binary.h>

#include <cmath>
#include <limits>

#include <support/error.h>

namespace snug {

std::vector<std::array<float, 3>> in_single_precision(std::span<const Point3> points, const std::string& name,
                                                      const Notes& notes) {
  std::vector<std::array<float, 3>> result;
  result.reserve(points.size());
  bool rounded = false;
  for (const Point3& point : points) {
    require_value(is_finite(point), "a coordinate to write is not finite");
    std::array<float, 3>& own = result.emplace_back();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // Beyond the largest float the conversion is not defined, although half a step farther would round to
      // it.
      if (std::fabs(point[axis]) > double{std::numeric_limits<float>::max()}) {
        throw InputError(InputProblem::refused,
                         name + ": vertex " + std::to_string(result.size() - 1) +
                             " is too far out for single precision: write PLY, OBJ or OFF");
      }
      own[axis] = static_cast<float>(point[axis]);
      rounded = rounded || double{own[axis]} != point[axis];
    }
  }
  if (rounded && notes) notes(name + ": coordinates are rounded to single precision");
  return result;
}

}  // namespace snug
