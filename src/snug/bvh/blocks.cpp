#include <snug/bvh/blocks.h>

#include <algorithm>
#include <cmath>

#include <snug/base/contract.h>
#include <snug/geometry/rounding.h>

namespace snug {
namespace {

constexpr double single_roundoff = 0x1p-24;
// More than what some hundred operations in single precision lose where they underflow, be it by flushing. Gaps are
// lowered by it, as by a slack.
constexpr double single_underflow = 0x1p-118;

float float_up(double x) {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) >= x ? f : std::nextafterf(f, INFINITY);
}
float float_down(double x) { return -float_up(-x); }

// Upper bounds of 1, sqrt(2) and sqrt(3) in single precision.
float length_of(std::uint8_t direction) {
  return direction < 3 ? 1.0F : direction < 7 ? 1.7320509F : 1.4142137F;
}

// A vector as a sum of directions of a sort with weights: of those that are nearest to it.
class Decomposition {
 public:
  explicit Decomposition(Volume volume) : volume_(volume) {
    places_.fill(255);
    const auto directions = directions_of(volume);
    for (std::size_t i = 0; i < directions.size(); ++i) places_[directions[i]] = static_cast<std::uint8_t>(i);
  }

  [[nodiscard]] View::Sum operator()(const Vector3& v) const {
    // Axes by size: p >= q >= r >= 0.
    std::array<std::size_t, 3> a{0, 1, 2};
    std::sort(a.begin(), a.end(),
              [&](std::size_t i, std::size_t j) { return std::fabs(v[i]) > std::fabs(v[j]); });
    const double p = std::fabs(v[a[0]]), q = std::fabs(v[a[1]]), r = std::fabs(v[a[2]]);
    View::Sum sum{};
    switch (volume_) {
      case Volume::dop14:
        set(sum, 0, v, {true, true, true}, r);
        set(sum, 1, v, only(a[0]), p - r);
        set(sum, 2, v, only(a[1]), q - r);
        return sum;
      case Volume::dop18:
        if (p >= q + r) {
          set(sum, 0, v, both(a[0], a[1]), q);
          set(sum, 1, v, both(a[0], a[2]), r);
          set(sum, 2, v, only(a[0]), p - q - r);
        } else {
          set(sum, 0, v, both(a[0], a[1]), (p + q - r) / 2);
          set(sum, 1, v, both(a[0], a[2]), (p + r - q) / 2);
          set(sum, 2, v, both(a[1], a[2]), (q + r - p) / 2);
        }
        return sum;
      case Volume::dop26:
        set(sum, 0, v, {true, true, true}, r);
        set(sum, 1, v, both(a[0], a[1]), q - r);
        set(sum, 2, v, only(a[0]), p - q);
        return sum;
      default:
        for (std::size_t k = 0; k < 3; ++k) set(sum, k, v, only(k), std::fabs(v[k]));
        return sum;
    }
  }

 private:
  using Which = std::array<bool, 3>;
  static Which only(std::size_t i) { return {i == 0, i == 1, i == 2}; }
  static Which both(std::size_t i, std::size_t j) {
    return {i == 0 || j == 0, i == 1 || j == 1, i == 2 || j == 2};
  }

  // The direction with the signs of v in some coordinates and zero in the others, or its opposite with a negative weight.
  void set(View::Sum& sum, std::size_t k, const Vector3& v, const Which& which, double weight) const {
    Vector3 wanted;
    for (std::size_t i = 0; i < 3; ++i) wanted[i] = which[i] ? (v[i] < 0 ? -1.0 : 1.0) : 0.0;
    for (std::size_t d = 0; d < max_directions; ++d) {
      if (places_[d] == 255) continue;
      const bool same = all_directions[d] == wanted;
      if (!same && !(-all_directions[d] == wanted)) continue;
      sum.place[k] = places_[d];
      sum.weight[k] = same ? weight : -weight;
      return;
    }
  }

  Volume volume_;
  std::array<std::uint8_t, max_directions> places_;
};

}  // namespace

View::View(Volume volume, const PlacedFrame& target, const PlacedFrame& source) : frame(target, source) {
  if (!frame.comparable) return;
  if (volume == Volume::obb) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) seen.rows[i][j] = static_cast<float>(frame.rows[i][j]);
    }
    seen.scale = static_cast<float>(frame.scale);
    for (std::size_t j = 0; j < 3; ++j) seen.direction[j] = seen.other_direction[j] = 0;
    return;
  }
  const Decomposition decomposition(volume);
  for (const std::uint8_t direction : directions_of(volume)) {
    const Vector3& d = all_directions[direction];
    sums.push_back(decomposition(d.x * frame.rows[0] + d.y * frame.rows[1] + d.z * frame.rows[2]));
  }
}

void View::look_along(const Vector3& direction) {
  if (!frame.comparable) return;
  const double size = length(direction);
  if (!(size > 0) || !std::isfinite(1 / size)) return;
  const Vector3 n = ((1 - 0x1p-20) / size) * direction;
  for (std::size_t j = 0; j < 3; ++j) {
    seen.direction[j] = static_cast<float>(n[j]);
    const Vector3 column{frame.rows[0][j], frame.rows[1][j], frame.rows[2][j]};
    seen.other_direction[j] = static_cast<float>(dot(n, column));
  }
}

Blocks::Blocks(Volume volume)
    : volume_(volume),
      directions_(directions_of(volume)),
      stride_(lanes * (volume == Volume::obb ? kernels::obb_rows : 2 * directions_of(volume).size())) {}

std::size_t Blocks::bytes() const {
  return heads_.capacity() * sizeof(Head) + data_.capacity() * sizeof(float);
}

void Blocks::clear() {
  heads_.clear();
  data_.clear();
}

std::uint32_t Blocks::add(std::span<const BoundingVolume> sets, std::span<const std::uint32_t> names) {
  SNUG_EXPECT(!sets.empty() && sets.size() <= lanes && names.size() == sets.size());
  const auto block = static_cast<std::uint32_t>(heads_.size());
  Head head{};
  head.count = static_cast<std::uint32_t>(sets.size());
  head.origin = ball_around(volume_, sets[0]).centre;
  data_.resize(data_.size() + stride_, 0.0F);
  float* const rows = data_.data() + block * stride_;
  for (std::size_t l = 0; l < sets.size(); ++l) {
    head.names[l] = names[l];
    head.sizes[l] = float_up(2 * ball_around(volume_, sets[l]).radius);
    if (volume_ == Volume::obb) {
      const Obb& box = sets[l].box;
      const Vector3 centre = box.centre - head.origin;
      double moved = 4 * unit_roundoff * max_abs(centre);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto single = static_cast<float>(centre[k]);
        moved += std::fabs(centre[k] - static_cast<double>(single));
        rows[lanes * k + l] = single;
        for (std::size_t i = 0; i < 3; ++i) {
          rows[lanes * (6 + 3 * k + i) + l] = static_cast<float>(box.axes[k][i]);
        }
      }
      // Rounded axes are off by less than two roundings, and no more orthogonal than that.
      const double sum = box.half.x + box.half.y + box.half.z;
      for (std::size_t k = 0; k < 3; ++k) {
        rows[lanes * (3 + k) + l] = float_up(enlarged(box.half[k] + moved + 8 * single_roundoff * sum));
      }
      float reach = 0;
      for (std::size_t r = 0; r < 6; ++r) reach += std::fabs(rows[lanes * r + l]);
      // A NaN stays.
      if (!std::isnan(head.reach) && !(reach <= head.reach)) head.reach = reach;
      continue;
    }
    for (std::size_t i = 0; i < directions_.size(); ++i) {
      const double from = dot(all_directions[directions_[i]], head.origin - Point3{});
      const double error = 8 * unit_roundoff * max_abs(head.origin - Point3{});
      rows[lanes * 2 * i + l] = float_down(sets[l].lower[i] - from - error);
      rows[lanes * (2 * i + 1) + l] = float_up(sets[l].upper[i] - from + error);
    }
  }
  // Lanes that are not there repeat the first one, so that they settle when it does.
  std::fill(head.sizes.begin() + static_cast<std::ptrdiff_t>(sets.size()), head.sizes.end(), head.sizes[0]);
  for (std::size_t r = 0; r < stride_ / lanes; ++r) {
    std::fill(rows + lanes * r + sets.size(), rows + lanes * (r + 1), rows[lanes * r]);
  }
  heads_.push_back(head);
  return block;
}

void Blocks::placed(Lane at, const View& view, PlacedVolume& out) const {
  const float* const row = data(at.block) + at.lane;
  const Point3& origin = heads_[at.block].origin;
  if (volume_ == Volume::obb) {
    const auto number = [&](std::size_t r) { return static_cast<double>(row[lanes * r]); };
    out.centre = view.frame.apply(origin + Vector3{number(0), number(1), number(2)});
    const double inverse = 1 / view.frame.scale;
    for (std::size_t k = 0; k < 3; ++k) {
      out.box.half[k] = static_cast<float>(view.frame.scale * number(3 + k));
      const Vector3 axis = view.frame.turn({number(6 + 3 * k), number(7 + 3 * k), number(8 + 3 * k)});
      for (std::size_t i = 0; i < 3; ++i) out.box.axes[k][i] = static_cast<float>(inverse * axis[i]);
    }
    return;
  }
  out.centre = view.frame.apply(origin);
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    const View::Sum& sum = view.sums[i];
    double lower = 0, upper = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double low = static_cast<double>(row[lanes * 2 * sum.place[k]]),
                   high = static_cast<double>(row[lanes * (2 * sum.place[k] + 1u)]);
      lower += sum.weight[k] * (sum.weight[k] >= 0 ? low : high);
      upper += sum.weight[k] * (sum.weight[k] >= 0 ? high : low);
    }
    out.lower[i] = lower;
    out.upper[i] = upper;
  }
}

Blocks::Near Blocks::distances(std::uint32_t block, const PlacedVolume& other, double slack, float enough,
                               Distances& out) const {
  // Of the lanes that are there.
  const auto result = [&](kernels::Near near) {
    return Near{near.lanes & ((1u << heads_[block].count) - 1), near.others};
  };
  const Vector3 offset = other.centre - heads_[block].origin;
  if (volume_ == Volume::obb) {
    kernels::OtherBox box = other.box;
    for (std::size_t k = 0; k < 3; ++k) box.centre[k] = static_cast<float>(offset[k]);
    return result(kernels::obb_distances(data(block), heads_[block].reach, box,
                                         float_up(slack + single_underflow), enough, out.data()));
  }
  kernels::OtherIntervals intervals;
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    const double from = dot(all_directions[directions_[i]], offset);
    intervals.lower[i] = float_down(other.lower[i] + from);
    intervals.upper[i] = float_up(other.upper[i] + from);
    intervals.length[i] = length_of(directions_[i]);
  }
  return result(kernels::dop_distances(data(block), directions_.size(), intervals,
                                       float_up(slack + single_underflow), enough, out.data()));
}

float Blocks::distances(std::uint32_t block, const Blocks& others, std::uint32_t other, const View& view,
                        float enough, Pairs& out) const {
  if (volume_ == Volume::obb) {
    kernels::SeenBlock seen = view.seen;
    const Vector3 offset = view.frame.apply(others.heads_[other].origin) - heads_[block].origin;
    for (std::size_t k = 0; k < 3; ++k) seen.offset[k] = static_cast<float>(offset[k]);
    const Near near = kernels::obb_pairs(boxes(block), others.boxes(other), seen, float_up(view.frame.slack),
                                         enough, out.pairs.data());
    out.count = near.lanes;
    return near.others;
  }
  out.count = 0;
  float least = INFINITY;
  for (std::uint32_t j = 0; j < others.count(other); ++j) {
    PlacedVolume seen;
    others.placed({other, j}, view, seen);
    Distances found;
    const Near near = distances(block, seen, view.frame.slack, enough, found);
    least = std::min(least, near.others);
    for (std::uint32_t i = 0; i < count(block); ++i) {
      if ((near.lanes >> i & 1u) == 0) continue;
      out.pairs[out.count++] = {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(j), found[i]};
    }
  }
  return least;
}

void Blocks::distances(std::uint32_t block, const Point3& point, double slack, Distances& out) const {
  const Vector3 offset = point - heads_[block].origin;
  if (volume_ == Volume::obb) {
    const float centre[3] = {static_cast<float>(offset.x), static_cast<float>(offset.y),
                             static_cast<float>(offset.z)};
    kernels::obb_distances(data(block), centre, float_up(slack + single_underflow), out.data());
    return;
  }
  PlacedVolume other;
  other.centre = point;
  other.lower.fill(0);
  other.upper.fill(0);
  static_cast<void>(distances(block, other, slack, INFINITY, out));
}

}  // namespace snug
