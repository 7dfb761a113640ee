#include <snug/bounds/linear_programme.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <snug/bounds/fit_kernels.h>
#include <support/contract.h>
#include <support/point.h>

namespace snug {
namespace {

constexpr double steepest = 4096;
// Violations below this are left to the caller, who moves the plane up.
constexpr double negligible = 1e-14;

struct Slopes {
  double x, y;
};

struct LinePoint {
  double x, y, z;  // relative to the centre
};

// Every order with equal probability, from a fixed seed.
void shuffle(std::vector<LinePoint>& points) {
  std::uint64_t state = 0x9e3779b97f4a7c15u;
  for (std::size_t i = points.size(); i > 1; --i) {
    state ^= state << 13, state ^= state >> 7, state ^= state << 17;
    std::swap(points[i - 1], points[state % i]);
  }
}

// The largest t * gain within the box and the half-planes of the first `count` points, on the line
// start + t * along; all as seen from the plane that holds `tight`.
class Line {
 public:
  Line(Slopes start, Slopes along) : start_(start), along_(along) {
    hold(-1, 0, -steepest);
    hold(1, 0, -steepest);
    hold(0, -1, -steepest);
    hold(0, 1, -steepest);
  }

  // p x + q y >= least
  void hold(double p, double q, double least) {
    const double rate = p * along_.x + q * along_.y;
    const double rest = least - (p * start_.x + q * start_.y);
    if (std::fabs(rate) <= 1e-13 * (std::fabs(p) + std::fabs(q))) return;  // parallel: decides nothing here
    const double t = rest / rate;
    if (rate > 0) {
      lower_ = std::max(lower_, t);
    } else {
      upper_ = std::min(upper_, t);
    }
  }

  [[nodiscard]] Slopes best(double gain) const {
    // Rounding may cross the ends where the line touches what is allowed in a point.
    const double t = lower_ > upper_ ? lower_ + (upper_ - lower_) / 2 : gain > 0 ? upper_ : lower_;
    return {start_.x + t * along_.x, start_.y + t * along_.y};
  }

 private:
  Slopes start_, along_;
  double lower_ = -INFINITY, upper_ = INFINITY;
};

// Least at the centre of the planes through `tight` above the first `count` points: maximises
// x tight.x + y tight.y.
Slopes best_through(const LinePoint& tight, const std::vector<LinePoint>& points, std::size_t count) {
  Slopes slopes{std::copysign(steepest, tight.x), std::copysign(steepest, tight.y)};
  for (std::size_t i = 0; i < count; ++i) {
    const double p = tight.x - points[i].x, q = tight.y - points[i].y;  // p x + q y <= most
    const double most = tight.z - points[i].z;
    if (p * slopes.x + q * slopes.y <= most + negligible) continue;
    const double size_sq = p * p + q * q;
    if (size_sq <= 1e-28) continue;  // the same place
    Line line({p * most / size_sq, q * most / size_sq}, {-q, p});
    for (std::size_t k = 0; k < i; ++k) {
      line.hold(points[k].x - tight.x, points[k].y - tight.y, points[k].z - tight.z);
    }
    slopes = line.best(p * tight.y - q * tight.x);
  }
  return slopes;
}

// At the centre and its slopes: of the plane above `points`, which are in random order.
struct CentredPlane {
  double at_centre;
  Slopes slopes;
};
CentredPlane lowest_above(const std::vector<LinePoint>& points) {
  CentredPlane plane{-INFINITY, {0, 0}};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const LinePoint& p = points[i];
    if (p.z <= plane.at_centre + plane.slopes.x * p.x + plane.slopes.y * p.y + negligible) continue;
    plane.slopes = best_through(p, points, i);
    plane.at_centre = p.z - plane.slopes.x * p.x - plane.slopes.y * p.y;
  }
  return plane;
}

// The point farthest above a plane, by some height; nothing if none is above it but for roundings.
std::optional<std::size_t> farthest_above(const kernels::Coordinates& points, const Vector3& from,
                                          const Slopes& slopes) {
  constexpr std::size_t block = 64;
  const Vector3 up{-slopes.x, -slopes.y, 1};
  double most = negligible;
  std::optional<std::size_t> highest;
  for (std::size_t begin = 0; begin < points.count; begin += block) {
    const kernels::Coordinates here = points.first(std::min(points.count, begin + block)).from(begin);
    const double upper = kernels::heights(here, from, up).upper;
    if (upper > most) most = upper, highest = begin;
  }
  if (!highest) return {};
  std::size_t farthest = *highest;
  double best = -INFINITY;
  for (std::size_t i = *highest; i < std::min(points.count, *highest + block); ++i) {
    const double above = dot(up, Vector3{points.x[i], points.y[i], points.z[i]} - from);
    if (above > best) best = above, farthest = i;
  }
  return farthest;
}

}  // namespace

PlanesAbove::PlanesAbove(std::span<const double> x, std::span<const double> y, double centre_x,
                         double centre_y)
    : x_(x), y_(y), centre_x_(centre_x), centre_y_(centre_y) {
  SNUG_EXPECT(!x.empty() && x.size() == y.size());
  for (const std::span<const double>& axis : {x, y}) {
    const auto [least, most] = std::minmax_element(axis.begin(), axis.end());
    extremes_.push_back(static_cast<std::size_t>(least - axis.begin()));
    extremes_.push_back(static_cast<std::size_t>(most - axis.begin()));
  }
}

Plane PlanesAbove::lowest(std::span<const double> z) const {
  SNUG_EXPECT(z.size() == x_.size());
  // Few points touch the plane: it is made for some, and the one farthest above it joins them.
  std::vector<std::size_t> some;
  std::vector<LinePoint> points;
  const auto join = [&](std::size_t i) {
    if (std::find(some.begin(), some.end(), i) != some.end()) return false;
    some.push_back(i);
    points.push_back({x_[i] - centre_x_, y_[i] - centre_y_, z[i]});
    return true;
  };
  for (const std::size_t i : extremes_) join(i);
  while (true) {
    std::vector<LinePoint> shuffled = points;
    shuffle(shuffled);
    const CentredPlane plane = lowest_above(shuffled);
    const std::optional<std::size_t> next = farthest_above(
        {x_.data(), y_.data(), z.data(), z.size()}, {centre_x_, centre_y_, plane.at_centre}, plane.slopes);
    if (!next || !join(*next)) return {plane.at_centre, plane.slopes.x, plane.slopes.y, centre_x_, centre_y_};
  }
}

}  // namespace snug
