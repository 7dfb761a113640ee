#include <snug/bvh/wide_node.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <support/contract.h>

namespace snug {
namespace {

constexpr double single_roundoff = 0x1p-24;
// More than what some hundred operations in single precision lose where they underflow, be it by flushing.
// Gaps are lowered by it, as by a slack.
constexpr double single_underflow = 0x1p-118;
// Scales below leave the range of single precision, or what is placed with them does.
constexpr double min_scale = 0x1p-96;

}  // namespace

View::View(const RelativeFrame& relative) : frame(relative) {
  if (!frame.comparable) return;
  // All of a source that is smaller lies within 8 of these scales of its origin's image, as does what another
  // turn of that scale makes of it.
  const bool point = frame.scale < min_scale;
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = 0; i < 3; ++i) {
      turn.columns[j][i] = static_cast<float>(point ? (i == j ? min_scale : 0) : frame.rows[i][j]);
    }
  }
  turn.scale = static_cast<float>(point ? min_scale : frame.scale);
  turn.inverse_scale = 1 / turn.scale;
  slack = float_up(frame.slack + (point ? 16 * min_scale : 0));
  to_world = static_cast<float>(frame.to_world);
}

void View::look_along(const Vector3& direction) {
  const double size = length(direction);
  if (!frame.comparable || !(size > 0) || !std::isfinite(1 / size)) return;
  const Vector3 n = ((1 - 0x1p-20) / size) * direction;
  // Without the scale, which the half sizes have already.
  const Vector3 other = (1 / frame.scale) * transposed_times(frame.rows, n);
  for (std::size_t j = 0; j < 3; ++j) {
    turn.direction[j] = static_cast<float>(n[j]);
    turn.other_direction[j] = static_cast<float>(other[j]);
  }
}

TreeView::TreeView(const RelativeFrame& frame) {
  const Vector3& t = frame.translation;
  const auto set = [](float(&to)[4], double x, double y, double z) {
    to[0] = static_cast<float>(x), to[1] = static_cast<float>(y), to[2] = static_cast<float>(z), to[3] = 0;
  };
  const auto& [x, y, z] = frame.rows;
  set(columns[0], x.x, y.x, z.x);
  set(columns[1], x.y, y.y, z.y);
  set(columns[2], x.z, y.z, z.z);
  set(translation, t.x, t.y, t.z);
  scale = static_cast<float>(frame.scale);
  inverse_scale = 1 / scale;
  slack = static_cast<float>(frame.slack);
  reach = static_cast<float>((1 + 0x1p-22) * (std::fabs(t.x) + std::fabs(t.y) + std::fabs(t.z))) + 0x1p-125F;
}

float TreeView::doubt(float size) const {
  return slack + kernels::walk_roundings * (size + 2 * scale * size + reach);
}

WideNode::WideNode(std::span<const Obb> boxes, std::span<const std::uint32_t> of_boxes) {
  SNUG_EXPECT(!boxes.empty() && boxes.size() <= width &&
              (of_boxes.empty() || of_boxes.size() == boxes.size()));
  std::copy(of_boxes.begin(), of_boxes.end(), names.begin());
  box_count = static_cast<std::uint32_t>(boxes.size());
  const Point3 origin = boxes[0].centre;
  for (std::size_t k = 0; k < 3; ++k) reference[k] = origin[k];
  for (std::size_t l = 0; l < boxes.size(); ++l) {
    const Obb& box = boxes[l];
    sizes[l] = float_up(2 * ball_around(box).radius);
    const Vector3 centre = box.centre - origin;
    double moved = 4 * unit_roundoff * max_abs(centre);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto single = static_cast<float>(centre[k]);
      moved += std::fabs(centre[k] - static_cast<double>(single));
      rows[width * k + l] = single;
      for (std::size_t i = 0; i < 3; ++i) {
        rows[width * (6 + 3 * k + i) + l] = static_cast<float>(box.axes[k][i]);
      }
    }
    // Rounded axes are off by less than two roundings, and no more orthogonal than that.
    const double sum = box.half.x + box.half.y + box.half.z;
    for (std::size_t k = 0; k < 3; ++k) {
      rows[width * (3 + k) + l] = float_up(enlarged(box.half[k] + moved + 8 * single_roundoff * sum));
    }
    float of_box = 0;
    for (std::size_t r = 0; r < 6; ++r) of_box += std::fabs(rows[width * r + l]);
    // A NaN stays.
    if (!std::isnan(reach) && !(of_box <= reach)) reach = of_box;
  }
  // Places that are not taken repeat the first box, so that they are decided when it is.
  std::fill(sizes + boxes.size(), sizes + width, sizes[0]);
  for (std::size_t r = 0; r < kernels::obb_rows; ++r) {
    float* const row = rows + width * r;
    std::fill(row + boxes.size(), row + width, row[0]);
  }
}

Obb WideNode::box(std::size_t place) const {
  const auto number = [&](std::size_t row) { return static_cast<double>(rows[width * row + place]); };
  Obb box;
  box.centre = origin() + Vector3{number(0), number(1), number(2)};
  box.half = {number(3), number(4), number(5)};
  for (std::size_t k = 0; k < 3; ++k) box.axes[k] = {number(6 + 3 * k), number(7 + 3 * k), number(8 + 3 * k)};
  return box;
}

WideNode::Near WideNode::distances(const WideNode& other, std::size_t place, const View& view,
                                   float prune_distance, Gaps which, Distances& out) const {
  const Vector3 offset = view.frame.apply(other.origin()) - origin();
  const kernels::SeenBox seen{
      other.rows + place,
      other.reach,
      {static_cast<float>(offset.x), static_cast<float>(offset.y), static_cast<float>(offset.z)}};
  const Near near =
      kernels::obb_distances(rows, reach, seen, view.turn, view.slack, prune_distance, which, out.data());
  return {near.places & ((1u << box_count) - 1), near.others};
}

WideNode::Near WideNode::distances(const PlacedBox& other, double slack, float prune_distance,
                                   Distances& out) const {
  const Vector3 offset = other.centre - origin();
  kernels::OtherBox box = other.box;
  for (std::size_t k = 0; k < 3; ++k) box.centre[k] = static_cast<float>(offset[k]);
  const Near near = kernels::obb_distances(rows, reach, box, float_up(slack + single_underflow),
                                           prune_distance, out.data());
  return {near.places & ((1u << box_count) - 1), near.others};
}

WideNode::Near WideNode::distances(const Point3& point, double slack, float prune_distance,
                                   Distances& out) const {
  const Vector3 offset = point - origin();
  const float centre[3] = {static_cast<float>(offset.x), static_cast<float>(offset.y),
                           static_cast<float>(offset.z)};
  const Near near =
      kernels::obb_distances(rows, centre, float_up(slack + single_underflow), prune_distance, out.data());
  return {near.places & ((1u << box_count) - 1), near.others};
}

void WideNode::extents(const Vector3& direction, Distances& out) const {
  const float along[3] = {static_cast<float>(direction.x), static_cast<float>(direction.y),
                          static_cast<float>(direction.z)};
  kernels::obb_extents(rows, reach, along, out.data());
}

}  // namespace snug
