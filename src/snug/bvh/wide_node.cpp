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

View::View(const PlacedFrame& target, const PlacedFrame& source) : frame(target, source) {
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

TreeView::TreeView(const View& view) {
  const Vector3& t = view.frame.translation;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) columns[j][i] = view.turn.columns[j][i];
    columns[i][3] = 0;
    translation[i] = static_cast<float>(t[i]);
  }
  translation[3] = 0;
  scale = view.turn.scale;
  inverse_scale = view.turn.inverse_scale;
  slack = view.slack;
  reach = float_up(std::fabs(t.x) + std::fabs(t.y) + std::fabs(t.z));
}

float TreeView::doubt(float size) const {
  return slack + kernels::walk_roundings * (size + 2 * scale * size + reach);
}

WideNode::WideNode(std::span<const Obb> boxes) {
  SNUG_EXPECT(!boxes.empty() && boxes.size() <= width);
  count_ = static_cast<std::uint32_t>(boxes.size());
  origin_ = boxes[0].centre;
  for (std::size_t l = 0; l < boxes.size(); ++l) {
    const Obb& box = boxes[l];
    sizes_[l] = float_up(2 * ball_around(box).radius);
    const Vector3 centre = box.centre - origin_;
    double moved = 4 * unit_roundoff * max_abs(centre);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto single = static_cast<float>(centre[k]);
      moved += std::fabs(centre[k] - static_cast<double>(single));
      rows_[width * k + l] = single;
      for (std::size_t i = 0; i < 3; ++i) {
        rows_[width * (6 + 3 * k + i) + l] = static_cast<float>(box.axes[k][i]);
      }
    }
    // Rounded axes are off by less than two roundings, and no more orthogonal than that.
    const double sum = box.half.x + box.half.y + box.half.z;
    for (std::size_t k = 0; k < 3; ++k) {
      rows_[width * (3 + k) + l] = float_up(enlarged(box.half[k] + moved + 8 * single_roundoff * sum));
    }
    float reach = 0;
    for (std::size_t r = 0; r < 6; ++r) reach += std::fabs(rows_[width * r + l]);
    // A NaN stays.
    if (!std::isnan(reach_) && !(reach <= reach_)) reach_ = reach;
  }
  // Places that are not taken repeat the first box, so that they are decided when it is.
  std::fill(sizes_.begin() + static_cast<std::ptrdiff_t>(boxes.size()), sizes_.end(), sizes_[0]);
  for (std::size_t r = 0; r < kernels::obb_rows; ++r) {
    float* const row = rows_.data() + width * r;
    std::fill(row + boxes.size(), row + width, row[0]);
  }
}

Obb WideNode::box(std::size_t place) const {
  const auto number = [&](std::size_t row) { return static_cast<double>(rows_[width * row + place]); };
  Obb box;
  box.centre = origin_ + Vector3{number(0), number(1), number(2)};
  box.half = {number(3), number(4), number(5)};
  for (std::size_t k = 0; k < 3; ++k) box.axes[k] = {number(6 + 3 * k), number(7 + 3 * k), number(8 + 3 * k)};
  return box;
}

WideNode::Near WideNode::distances(const WideNode& other, std::size_t place, const View& view,
                                   float prune_distance, Gaps which, Distances& out) const {
  const Vector3 offset = view.frame.apply(other.origin_) - origin_;
  const kernels::SeenBox seen{
      other.rows_.data() + place,
      other.reach_,
      {static_cast<float>(offset.x), static_cast<float>(offset.y), static_cast<float>(offset.z)}};
  const Near near = kernels::obb_distances(rows_.data(), reach_, seen, view.turn, view.slack, prune_distance,
                                           which, out.data());
  return {near.places & ((1u << count_) - 1), near.others};
}

WideNode::Near WideNode::distances(const PlacedBox& other, double slack, float prune_distance,
                                   Distances& out) const {
  const Vector3 offset = other.centre - origin_;
  kernels::OtherBox box = other.box;
  for (std::size_t k = 0; k < 3; ++k) box.centre[k] = static_cast<float>(offset[k]);
  const Near near = kernels::obb_distances(rows_.data(), reach_, box, float_up(slack + single_underflow),
                                           prune_distance, out.data());
  return {near.places & ((1u << count_) - 1), near.others};
}

WideNode::Near WideNode::distances(const Point3& point, double slack, float prune_distance,
                                   Distances& out) const {
  const Vector3 offset = point - origin_;
  const float centre[3] = {static_cast<float>(offset.x), static_cast<float>(offset.y),
                           static_cast<float>(offset.z)};
  const Near near = kernels::obb_distances(rows_.data(), centre, float_up(slack + single_underflow),
                                           prune_distance, out.data());
  return {near.places & ((1u << count_) - 1), near.others};
}

void WideNode::extents(const Vector3& direction, Distances& out) const {
  const float along[3] = {static_cast<float>(direction.x), static_cast<float>(direction.y),
                          static_cast<float>(direction.z)};
  kernels::obb_extents(rows_.data(), reach_, along, out.data());
}

}  // namespace snug
