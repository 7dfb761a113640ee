#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/bvh/set_kernel.cpp"
#include <snug/geometry/vector_code-inl.h>

#include <algorithm>
#include <cmath>

#include <snug/bvh/set_kernel.h>
#include <snug/geometry/rounding.h>

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {
namespace {

constexpr std::size_t most_lanes = 8, row_count = sizeof(FittedSet) / sizeof(double);
using Tag = hn::CappedTag<double, most_lanes>;
using V = hn::Vec<Tag>;
using Point = Vec3<V>;

HWY_INLINE V everywhere(double x) { return hn::Set(Tag(), x); }

// Numbers of some sets, each in a row; lanes beyond them repeat the last.
class Block {
 public:
  HWY_INLINE void gather(std::span<const FittedSet> sets, std::span<const std::uint32_t> which) {
    for (std::size_t l = 0; l < hn::Lanes(Tag()); ++l) {
      const auto* const from = reinterpret_cast<const double*>(&sets[which[std::min(l, which.size() - 1)]]);
      for (std::size_t r = 0; r < row_count; ++r) rows_[r][l] = from[r];
    }
  }
  HWY_INLINE V number(std::size_t row) const { return hn::Load(Tag(), rows_[row]); }
  HWY_INLINE Point point(std::size_t row) const { return {number(row), number(row + 1), number(row + 2)}; }

 private:
  HWY_ALIGN double rows_[row_count][most_lanes];
};

// Rows of FittedSet.
constexpr std::size_t centre = 0, axes_row = 3, halves = 12, box_error = 15, corner = 16, net = 19,
                      normal_row = 34, error_row = 37, normal_error = 38, tilt = 39, slack = 40;
static_assert(row_count == 41);

struct ExtentV {
  V lower, upper;
};

// As error_along().
HWY_INLINE V error_of(const Block& block, const Point& w) {
  const Point n = block.point(normal_row);
  const V error = block.number(error_row), zero = hn::Zero(Tag());
  const V cosine = dot(w, n), length_sq = dot(w, w);
  const V sine = hn::Sqrt(hn::Max(zero, hn::Sub(length_sq, hn::Mul(cosine, cosine))));
  const V part = hn::Max(zero, hn::Sub(hn::Abs(cosine), hn::Mul(sine, block.number(tilt))));
  const Point rest = sub(w, scaled(hn::CopySign(part, cosine), n));
  const V most =
      hn::Min(hn::Add(hn::Mul(part, block.number(normal_error)), hn::Mul(hn::Sqrt(dot(rest, rest)), error)),
              hn::Mul(hn::Sqrt(length_sq), error));
  return hn::Add(hn::Mul(most, everywhere(1 + 0x1p-45)), hn::Mul(everywhere(0x1p-47), error));
}

HWY_INLINE ExtentV extent(const Block& block, const Vector3& axis) {
  const Point w{everywhere(axis.x), everywhere(axis.y), everywhere(axis.z)};
  V reach = block.number(box_error);
  for (std::size_t k = 0; k < 3; ++k) {
    reach = hn::Add(reach, hn::Mul(block.number(halves + k), hn::Abs(dot(w, block.point(axes_row + 3 * k)))));
  }
  const V middle = dot(w, block.point(centre));
  // Bezier points of the quarters, those that are no means of others.
  V h[6] = {hn::Zero(Tag())};
  for (std::size_t k = 1; k < 6; ++k) h[k] = dot(w, block.point(net + 3 * (k - 1)));
  V least = hn::Min(hn::Min(h[0], h[1]), h[2]), most = hn::Max(hn::Max(h[0], h[1]), h[2]);
  const V inner = hn::Add(hn::Add(h[3], h[4]), h[5]), half = everywhere(0.5), quarter = everywhere(0.25);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const V inside = hn::Mul(quarter, hn::Add(h[k], inner));
    least = hn::Min(least, hn::Min(inside, hn::Mul(half, hn::Add(hn::Min(h[k], h[next]), h[3 + k]))));
    most = hn::Max(most, hn::Max(inside, hn::Mul(half, hn::Add(hn::Max(h[k], h[next]), h[3 + k]))));
  }
  const V height = dot(w, block.point(corner));
  const V off = hn::Add(hn::Mul(hn::Add(error_of(block, w), block.number(slack)), everywhere(1 + 0x1p-42)),
                        everywhere(17 * underflow_error));
  return {hn::Max(hn::Sub(middle, reach), hn::Sub(hn::Add(height, least), off)),
          hn::Min(hn::Add(middle, reach), hn::Add(hn::Add(height, most), off))};
}

SNUG_FLAT void ExtentsAlong(const Axes& axes, std::span<const FittedSet> sets,
                            std::span<const std::uint32_t> which, SetSides* sides, Extent* all) {
  const std::size_t lanes = hn::Lanes(Tag());
  Block block;
  HWY_ALIGN double lane[2][most_lanes];
  for (std::size_t begin = 0; begin < which.size(); begin += lanes) {
    const std::size_t here = std::min(lanes, which.size() - begin);
    block.gather(sets, which.subspan(begin, here));
    for (std::size_t k = 0; k < 3; ++k) {
      const ExtentV of_set = extent(block, axes[k]);
      hn::Store(of_set.lower, Tag(), lane[0]);
      hn::Store(of_set.upper, Tag(), lane[1]);
      for (std::size_t l = 0; l < here; ++l) {
        all[k].add({lane[0][l], lane[1][l]});
        sides[begin + l].reach[k] = static_cast<float>(std::min(-lane[0][l], 1e6));
        sides[begin + l].reach[4 + k] = static_cast<float>(std::min(lane[1][l], 1e6));
      }
    }
  }
}

constexpr std::size_t most_singles = 16;
using SingleTag = hn::CappedTag<float, most_singles>;

SNUG_FLAT void ExtentsOfTriangles(const Axes& axes, std::span<const SetTriangle> sets, SetSides* sides,
                                  Extent* all) {
  const SingleTag d;
  using S = hn::Vec<SingleTag>;
  constexpr std::size_t number_count = sizeof(SetTriangle) / sizeof(float);
  static_assert(number_count == 10);
  const std::size_t lanes = hn::Lanes(d);
  HWY_ALIGN float rows[number_count][most_singles], lane[2][most_singles];
  S least[3], most[3];
  for (std::size_t k = 0; k < 3; ++k) {
    least[k] = hn::Set(d, INFINITY);
    most[k] = hn::Set(d, -INFINITY);
  }
  for (std::size_t begin = 0; begin < sets.size(); begin += lanes) {
    const std::size_t here = std::min(lanes, sets.size() - begin);
    for (std::size_t l = 0; l < lanes; ++l) {
      const auto* const from = reinterpret_cast<const float*>(&sets[begin + std::min(l, here - 1)]);
      for (std::size_t r = 0; r < number_count; ++r) rows[r][l] = from[r];
    }
    const S reach = hn::Load(d, rows[number_count - 1]);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3<S> w{hn::Set(d, static_cast<float>(axes[k].x)), hn::Set(d, static_cast<float>(axes[k].y)),
                      hn::Set(d, static_cast<float>(axes[k].z))};
      S height[3];
      for (std::size_t c = 0; c < 3; ++c) {
        height[c] =
            dot(w, {hn::Load(d, rows[3 * c]), hn::Load(d, rows[3 * c + 1]), hn::Load(d, rows[3 * c + 2])});
      }
      const S lower = hn::Sub(hn::Min(height[0], hn::Min(height[1], height[2])), reach),
              upper = hn::Add(hn::Max(height[0], hn::Max(height[1], height[2])), reach);
      least[k] = hn::Min(least[k], lower);
      most[k] = hn::Max(most[k], upper);
      hn::Store(hn::Min(hn::Neg(lower), hn::Set(d, 1e6F)), d, lane[0]);
      hn::Store(hn::Min(upper, hn::Set(d, 1e6F)), d, lane[1]);
      for (std::size_t l = 0; l < here; ++l) {
        sides[begin + l].reach[k] = lane[0][l];
        sides[begin + l].reach[4 + k] = lane[1][l];
      }
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    hn::Store(least[k], d, lane[0]);
    hn::Store(most[k], d, lane[1]);
    for (std::size_t l = 0; l < lanes; ++l)
      all[k].add({static_cast<double>(lane[0][l]), static_cast<double>(lane[1][l])});
  }
}

}  // namespace
}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace snug::kernels {

HWY_EXPORT(ExtentsAlong);
HWY_EXPORT(ExtentsOfTriangles);

SetTriangle triangle_of(const FittedSet& set) {
  SetTriangle result{};
  std::array<Point3, 3> corners;
  double reach = INFINITY;
  if (set.slack < INFINITY) {
    const std::array<Vector3, 3> from_first{Vector3{}, set.net[1], set.net[2]};
    std::array<Vector3, 3> bend;
    Vector3 mean;
    for (std::size_t k = 0; k < 3; ++k) {
      bend[k] = set.net[3 + k] - 0.5 * (from_first[k] + from_first[(k + 1) % 3]);
      mean = mean + (1.0 / 3) * bend[k];
    }
    double unlike = 0;
    for (const Vector3& b : bend) unlike = std::max(unlike, length(b - mean));
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = Point3{} + (set.net[0] + (from_first[k] + (1.0 / 3) * mean));
    reach = 2.0 / 3 * unlike + 1.0 / 3 * length(mean) + set.error;
  } else {
    corners.fill(set.box.centre);
    reach = std::sqrt(length_sq(set.box.half)) + set.box_error;
  }
  constexpr double roundoff = roundoff_of<float>;
  double largest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t a = 0; a < 3; ++a) result.corner[k][a] = static_cast<float>(corners[k][a]);
    largest = std::max(largest, max_abs(corners[k] - Point3{}));
  }
  reach = enlarged((1 + 16 * roundoff) * reach + 64 * roundoff * largest + 0x1p-100);
  if (!(reach < 0x1p60)) {
    result.corner = {};
    reach = INFINITY;
  }
  result.reach = float_up(reach);
  return result;
}

std::array<Extent, 3> extents_along(const Axes& axes, std::span<const SetTriangle> sets, SetSides* sides) {
  std::array<Extent, 3> all;
  HWY_DYNAMIC_DISPATCH(ExtentsOfTriangles)(axes, sets, sides, all.data());
  return all;
}

std::array<Extent, 3> extents_along(const Axes& axes, std::span<const FittedSet> sets,
                                    std::span<const std::uint32_t> which, SetSides* sides) {
  std::array<Extent, 3> all;
  HWY_DYNAMIC_DISPATCH(ExtentsAlong)(axes, sets, which, sides, all.data());
  return all;
}

}  // namespace snug::kernels
#endif
