#include <snug/bvh/wide_nodes.h>

#include <algorithm>
#include <cmath>

#include <snug/base/contract.h>
#include <snug/geometry/rounding.h>

namespace snug {
namespace {

constexpr double single_roundoff = 0x1p-24;
// More than what some hundred operations in single precision lose where they underflow, be it by flushing.
// Gaps are lowered by it, as by a slack.
constexpr double single_underflow = 0x1p-118;

float float_up(double x) {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) >= x ? f : std::nextafterf(f, INFINITY);
}

}  // namespace

View::View(const PlacedFrame& target, const PlacedFrame& source) : frame(target, source) {
  if (!frame.comparable) return;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) seen.rows[i][j] = static_cast<float>(frame.rows[i][j]);
  }
  seen.scale = static_cast<float>(frame.scale);
}

void View::look_along(const Vector3& direction) {
  if (!frame.comparable) return;
  const double size = length(direction);
  if (!(size > 0) || !std::isfinite(1 / size)) return;
  const Vector3 n = ((1 - 0x1p-20) / size) * direction;
  const Vector3 other = transposed_times(frame.rows, n);
  for (std::size_t j = 0; j < 3; ++j) {
    seen.direction[j] = static_cast<float>(n[j]);
    seen.other_direction[j] = static_cast<float>(other[j]);
  }
}

std::size_t WideNodes::bytes() const {
  return heads_.capacity() * sizeof(Head) + data_.capacity() * sizeof(float);
}

void WideNodes::clear() {
  heads_.clear();
  data_.clear();
}

std::uint32_t WideNodes::add(std::span<const Obb> boxes, std::span<const std::uint32_t> names) {
  SNUG_EXPECT(!boxes.empty() && boxes.size() <= width && names.size() == boxes.size());
  const auto node = static_cast<std::uint32_t>(heads_.size());
  Head head{};
  head.count = static_cast<std::uint32_t>(boxes.size());
  head.origin = boxes[0].centre;
  data_.resize(data_.size() + stride, 0.0F);
  float* const rows = data_.data() + node * stride;
  for (std::size_t l = 0; l < boxes.size(); ++l) {
    const Obb& box = boxes[l];
    head.names[l] = names[l];
    head.sizes[l] = float_up(2 * ball_around(box).radius);
    const Vector3 centre = box.centre - head.origin;
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
    float reach = 0;
    for (std::size_t r = 0; r < 6; ++r) reach += std::fabs(rows[width * r + l]);
    // A NaN stays.
    if (!std::isnan(head.reach) && !(reach <= head.reach)) head.reach = reach;
  }
  // Places that are not taken repeat the first box, so that they are decided when it is.
  std::fill(head.sizes.begin() + static_cast<std::ptrdiff_t>(boxes.size()), head.sizes.end(), head.sizes[0]);
  for (std::size_t r = 0; r < kernels::obb_rows; ++r) {
    std::fill(rows + width * r + boxes.size(), rows + width * (r + 1), rows[width * r]);
  }
  heads_.push_back(head);
  return node;
}

PlacedBox WideNodes::placed(Child at, const View& view) const {
  const float* const row = data(at.parent) + at.place;
  const auto number = [&](std::size_t r) { return static_cast<double>(row[width * r]); };
  PlacedBox out;
  out.centre = view.frame.apply(heads_[at.parent].origin + Vector3{number(0), number(1), number(2)});
  const double inverse = 1 / view.frame.scale;
  for (std::size_t k = 0; k < 3; ++k) {
    out.box.half[k] = static_cast<float>(view.frame.scale * number(3 + k));
    const Vector3 axis = times(view.frame.rows, {number(6 + 3 * k), number(7 + 3 * k), number(8 + 3 * k)});
    for (std::size_t i = 0; i < 3; ++i) out.box.axes[k][i] = static_cast<float>(inverse * axis[i]);
  }
  return out;
}

WideNodes::Near WideNodes::distances(std::uint32_t node, const PlacedBox& other, double slack,
                                     float prune_distance, Distances& out) const {
  const Vector3 offset = other.centre - heads_[node].origin;
  kernels::OtherBox box = other.box;
  for (std::size_t k = 0; k < 3; ++k) box.centre[k] = static_cast<float>(offset[k]);
  const Near near = kernels::obb_distances(data(node), heads_[node].reach, box,
                                           float_up(slack + single_underflow), prune_distance, out.data());
  return {near.places & ((1u << heads_[node].count) - 1), near.others};
}

float WideNodes::distances(std::uint32_t node, const WideNodes& others, std::uint32_t other, const View& view,
                           float prune_distance, Pairs& out) const {
  kernels::SeenNode seen = view.seen;
  const Vector3 offset = view.frame.apply(others.heads_[other].origin) - heads_[node].origin;
  for (std::size_t k = 0; k < 3; ++k) seen.offset[k] = static_cast<float>(offset[k]);
  kernels::obb_pairs(boxes(node), others.boxes(other), seen, float_up(view.frame.slack), prune_distance, out);
  return out.others;
}

void WideNodes::distances(std::uint32_t node, const Point3& point, double slack, Distances& out) const {
  const Vector3 offset = point - heads_[node].origin;
  const float centre[3] = {static_cast<float>(offset.x), static_cast<float>(offset.y),
                           static_cast<float>(offset.z)};
  kernels::obb_distances(data(node), centre, float_up(slack + single_underflow), out.data());
}

}  // namespace snug
