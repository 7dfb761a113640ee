#include <snug/bvh/obb.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <snug/geometry/rounding.h>
#include <support/contract.h>

namespace snug {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

// Eigenvectors of a symmetric matrix by cyclic Jacobi rotations, as columns.
Matrix eigenvectors(Matrix m) {
  Matrix v{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (int sweep = 0; sweep < 8; ++sweep) {
    const double off = std::fabs(m[0][1]) + std::fabs(m[0][2]) + std::fabs(m[1][2]);
    const double diagonal = std::fabs(m[0][0]) + std::fabs(m[1][1]) + std::fabs(m[2][2]);
    if (!(off > 1e-4 * diagonal)) break;  // any axes are right, nearly principal ones are as good
    for (std::size_t p = 0; p < 2; ++p) {
      for (std::size_t q = p + 1; q < 3; ++q) {
        if (m[p][q] == 0) continue;
        const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
        const double t = (theta >= 0 ? 1.0 : -1.0) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (std::size_t k = 0; k < 3; ++k) {
          const double kp = m[k][p], kq = m[k][q];
          m[k][p] = c * kp - s * kq;
          m[k][q] = s * kp + c * kq;
        }
        for (std::size_t k = 0; k < 3; ++k) {
          const double pk = m[p][k], qk = m[q][k];
          m[p][k] = c * pk - s * qk;
          m[q][k] = s * pk + c * qk;
          const double vp = v[k][p], vq = v[k][q];
          v[k][p] = c * vp - s * vq;
          v[k][q] = s * vp + c * vq;
        }
      }
    }
  }
  return v;
}

// Two eigenvectors made orthonormal again, the third their cross product; the coordinate axes if that fails.
std::array<Vector3, 3> axes_of(const Matrix& covariance) {
  const Matrix v = eigenvectors(covariance);
  Vector3 a{v[0][0], v[1][0], v[2][0]}, b{v[0][1], v[1][1], v[2][1]};
  const double size_a = length(a);
  if (!(size_a > 0.5)) return Obb{}.axes;
  a = (1 / size_a) * a;
  b = b - dot(a, b) * a;
  const double size_b = length(b);
  if (!(size_b > 0.5) || !std::isfinite(size_b)) return Obb{}.axes;
  b = (1 / size_b) * b;
  return {a, b, cross(a, b)};
}

// A sum of outer products.
class Outer {
 public:
  void add(const Vector3& d) {
    diagonal_ = diagonal_ + Vector3{d.x * d.x, d.y * d.y, d.z * d.z};
    beside_ = beside_ + Vector3{d.x * d.y, d.y * d.z, d.z * d.x};
  }
  [[nodiscard]] Matrix matrix() const {
    const auto& [xx, yy, zz] = diagonal_;
    const auto& [xy, yz, zx] = beside_;
    return {{{xx, xy, zx}, {xy, yy, yz}, {zx, yz, zz}}};
  }
  void add(const Outer& other, double weight) {
    diagonal_ = diagonal_ + weight * other.diagonal_;
    beside_ = beside_ + weight * other.beside_;
  }

 private:
  Vector3 diagonal_, beside_;
};

// Bounds of dot(direction, x) over boxes.
Extent extent_of(std::span<const Obb> boxes, const Vector3& direction) {
  Extent all;
  for (const Obb& box : boxes) {
    // Infinite sides times cosines of zero are no numbers, which minima pass over.
    if (!std::isfinite(box.half.x + box.half.y + box.half.z)) return unbounded;
    double reach = 0;
    for (std::size_t k = 0; k < 3; ++k) reach += box.half[k] * std::fabs(dot(direction, box.axes[k]));
    const double middle = dot(direction, box.centre - Point3{});
    // The box as a set of inequalities lies in that of the combinations of its axes, made larger by what the
    // axes lack of orthonormality; at most 64 roundings.
    const double error =
        128 * unit_roundoff * (max_abs(box.centre - Point3{}) + box.half.x + box.half.y + box.half.z);
    all.add({middle - reach - error, middle + reach + error});
  }
  return all;
}

}  // namespace

namespace {

// A box along three axes: its centre, then its half edges. The fourth place is of no use: vectors are of four.
struct AlongAxes {
  std::array<std::array<float, 4>, 4> of;
};

// Turns that axes are tried with: steps of a right angle. All at once, since vectors do so.
constexpr std::size_t turn_count = 8;
struct Turns {
  std::array<float, turn_count> cosine, sine;
};
// Extents of boxes along two axes after each turn; not exact.
struct Sides {
  std::array<float, turn_count> first, second;
};
Sides sides_after(std::span<const AlongAxes> boxes, std::size_t i, std::size_t j, const Turns& turns) {
  std::array<float, turn_count> lower[2], upper[2];
  for (std::size_t a = 0; a < 2; ++a) {
    lower[a].fill(INFINITY);
    upper[a].fill(-INFINITY);
  }
  for (const AlongAxes& box : boxes) {
    for (std::size_t t = 0; t < turn_count; ++t) {
      const float c = turns.cosine[t], s = turns.sine[t];
      float reach[2] = {0, 0};
      for (std::size_t k = 1; k < 4; ++k) {
        reach[0] += std::fabs(c * box.of[k][i] + s * box.of[k][j]);
        reach[1] += std::fabs(c * box.of[k][j] - s * box.of[k][i]);
      }
      const float centre[2] = {c * box.of[0][i] + s * box.of[0][j], c * box.of[0][j] - s * box.of[0][i]};
      for (std::size_t a = 0; a < 2; ++a) {
        lower[a][t] = std::min(lower[a][t], centre[a] - reach[a]);
        upper[a][t] = std::max(upper[a][t], centre[a] + reach[a]);
      }
    }
  }
  Sides sides;
  for (std::size_t t = 0; t < turn_count; ++t) {
    sides.first[t] = upper[0][t] - lower[0][t];
    sides.second[t] = upper[1][t] - lower[1][t];
  }
  return sides;
}

// Boxes for choices, which one in `stride` of them will do for.
template <class BoxOf>
struct SomeBoxes {
  const BoxOf& box;  // of a number below `count`
  std::size_t count, stride = 1;
  // Of these in turn.
  [[nodiscard]] SomeBoxes at_most(std::size_t most) const {
    const std::size_t here = (count + stride - 1) / stride;
    return {box, count, stride * ((here + most - 1) / most)};
  }
};

constexpr std::size_t max_boxes = 256, max_turned = 64;

template <class BoxOf>
std::span<const AlongAxes> seen_along(const Axes& axes, const SomeBoxes<BoxOf>& boxes,
                                      std::array<AlongAxes, max_turned>& seen) {
  std::array<std::array<float, 4>, 3> columns{};
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t k = 0; k < 3; ++k) columns[k][a] = static_cast<float>(axes[a][k]);
  }
  const auto along = [&columns](const Vector3& v, std::array<float, 4>& out) {
    const auto x = static_cast<float>(v.x), y = static_cast<float>(v.y), z = static_cast<float>(v.z);
    for (std::size_t a = 0; a < 4; ++a) out[a] = x * columns[0][a] + y * columns[1][a] + z * columns[2][a];
  };
  const Point3 origin = boxes.box(0).centre;
  std::size_t count = 0;
  for (std::size_t b = 0; b < boxes.count; b += boxes.stride) {
    const Obb& box = boxes.box(b);
    AlongAxes& here = seen[count++];
    along(box.centre - origin, here.of[0]);
    for (std::size_t k = 0; k < 3; ++k) along(box.half[k] * box.axes[k], here.of[1 + k]);
  }
  return {seen.data(), count};
}

// Axes turned about the one of the least extent, then about that of the largest, so that a box around boxes
// has less surface. Any axes will do, so single precision is enough.
template <class BoxOf>
Axes turned_to_fit(Axes axes, const SomeBoxes<BoxOf>& boxes) {
  static const Turns turns = [] {
    Turns made;
    for (std::size_t t = 0; t < turn_count; ++t) {
      const double angle = static_cast<double>(t) * std::numbers::pi / (2 * turn_count);
      made.cosine[t] = static_cast<float>(std::cos(angle));
      made.sine[t] = static_cast<float>(std::sin(angle));
    }
    return made;
  }();
  std::array<AlongAxes, max_turned> memory;
  const std::span<const AlongAxes> seen = seen_along(axes, boxes, memory);
  std::array<float, 4> sides, lower, upper;
  lower.fill(INFINITY);
  upper.fill(-INFINITY);
  for (const auto& [of] : seen) {
    for (std::size_t a = 0; a < 4; ++a) {
      const float reach = std::fabs(of[1][a]) + std::fabs(of[2][a]) + std::fabs(of[3][a]);
      lower[a] = std::min(lower[a], of[0][a] - reach);
      upper[a] = std::max(upper[a], of[0][a] + reach);
    }
  }
  for (std::size_t a = 0; a < 4; ++a) sides[a] = upper[a] - lower[a];
  for (const bool least : {true, false}) {
    const auto about = static_cast<std::size_t>((least ? std::min_element(sides.begin(), sides.begin() + 3)
                                                       : std::max_element(sides.begin(), sides.begin() + 3)) -
                                                sides.begin());
    const std::size_t i = (about + 1) % 3, j = (about + 2) % 3;
    const Sides turned = sides_after(seen, i, j, turns);
    float best = INFINITY;
    std::size_t turn = 0;
    for (std::size_t t = 0; t < turn_count; ++t) {
      const float x = turned.first[t], y = turned.second[t], area = x * y + (x + y) * sides[about];
      if (!(area < best)) continue;
      best = area;
      turn = t;
      sides[i] = x;
      sides[j] = y;
    }
    if (turn == 0) continue;
    const double angle = static_cast<double>(turn) * std::numbers::pi / (2 * turn_count);
    const Vector3 first = axes[i], second = axes[j];
    axes[i] = std::cos(angle) * first + std::sin(angle) * second;
    axes[j] = std::cos(angle) * second - std::sin(angle) * first;
    if (!least) continue;
    const float c = turns.cosine[turn], s = turns.sine[turn];
    for (AlongAxes& box : std::span(memory).first(seen.size())) {
      for (auto& v : box.of) {
        const float x = v[i], y = v[j];
        v[i] = c * x + s * y;
        v[j] = c * y - s * x;
      }
    }
  }
  return axes;
}

template <class BoxOf>
Axes principal_axes(const SomeBoxes<BoxOf>& boxes) {
  Vector3 sum;
  double count = 0;
  for (std::size_t b = 0; b < boxes.count; b += boxes.stride, ++count)
    sum = sum + (boxes.box(b).centre - Point3{});
  const Point3 mean = Point3{} + (1.0 / count) * sum;
  Outer centres, edges;
  for (std::size_t b = 0; b < boxes.count; b += boxes.stride) {
    const Obb& box = boxes.box(b);
    centres.add(box.centre - mean);
    for (std::size_t k = 0; k < 3; ++k) edges.add(box.half[k] * box.axes[k]);
  }
  centres.add(edges, 1.0 / 3);
  return axes_of(centres.matrix());
}

// Axes for a box around boxes.
template <class BoxOf>
Axes axes_for(const SomeBoxes<BoxOf>& boxes) {
  SNUG_EXPECT(boxes.count > 0);
  const SomeBoxes<BoxOf> some = boxes.at_most(max_boxes);
  return turned_to_fit(principal_axes(some), some.at_most(max_turned));
}

}  // namespace

std::array<Vector3, 3> principal_axes(std::span<const Point3> points) {
  Vector3 sum;
  for (const Point3& p : points) sum = sum + (p - Point3{});
  const Point3 mean = Point3{} + (1.0 / static_cast<double>(std::max<std::size_t>(points.size(), 1))) * sum;
  Outer outer;
  for (const Point3& p : points) outer.add(p - mean);
  return axes_of(outer.matrix());
}

// Where x is a corner of what the extents hold, dot(axis, x - centre) is off from dot(axis, x) - dot(axis,
// centre) by no more than the roundings counted here.
Obb box_of(const std::array<Vector3, 3>& axes, const std::array<Extent, 3>& extents) {
  Obb box;
  for (const Extent& extent : extents) {
    if (!std::isfinite(extent.lower) || !std::isfinite(extent.upper)) {
      box.half = {INFINITY, INFINITY, INFINITY};
      return box;
    }
  }
  box.axes = axes;
  Vector3 from_origin;
  for (std::size_t k = 0; k < 3; ++k) {
    from_origin = from_origin + ((extents[k].lower + extents[k].upper) / 2) * axes[k];
  }
  box.centre = Point3{} + from_origin;
  for (std::size_t k = 0; k < 3; ++k) {
    const double middle = dot(axes[k], from_origin);
    const double error = 8 * unit_roundoff * max_abs(from_origin) + 8 * underflow_error;
    const double half = std::max(extents[k].upper - middle, middle - extents[k].lower);
    box.half[k] = enlarged(std::max(half, 0.0) + error);
  }
  return box;
}

Axes orthonormal_axes(const Vector3& a, const Vector3& b) {
  const double size_a = length(a);
  if (!(size_a > 0x1p-400) || !(size_a < 0x1p400)) return Obb{}.axes;
  const Vector3 first = (1 / size_a) * a;
  // Where little is left of the second, rounding has turned it.
  Vector3 second = b - dot(first, b) * first;
  double size_b = length(second);
  if (!(size_b > 0.25 * length(b)) || !(size_b > 0x1p-400) || !(size_b < 0x1p400)) {
    const Vector3 across{std::fabs(first.x), std::fabs(first.y), std::fabs(first.z)};
    Vector3 other;
    other[across.x <= across.y && across.x <= across.z ? 0 : across.y <= across.z ? 1 : 2] = 1;
    second = other - dot(first, other) * first;
    size_b = length(second);
  }
  second = (1 / size_b) * second;
  second = second - dot(first, second) * first;
  return {first, second, cross(first, second)};
}

Axes axes_around(std::span<const Obb> boxes) {
  SNUG_EXPECT(!boxes.empty());
  const auto box = [&](std::size_t i) -> const Obb& { return boxes[i]; };
  return principal_axes(SomeBoxes<decltype(box)>{box, boxes.size()});
}

Obb merge(std::span<const Obb> boxes) {
  const auto box = [&](std::size_t i) -> const Obb& { return boxes[i]; };
  return merge(boxes, axes_for(SomeBoxes<decltype(box)>{box, boxes.size()}));
}

// |w . d| <= |part| normal_error + |w - part n| error for any part: that which makes the sum least, as far as doubles know it.
double error_along(const Vector3& w, const Vector3& n, double error, double normal_error) {
  if (!(error < INFINITY)) return INFINITY;
  const double cosine = dot(w, n), across_sq = error * error - normal_error * normal_error;
  double part = 0;
  if (across_sq > 0) {
    const double sine = std::sqrt(std::max(0.0, length_sq(w) - cosine * cosine));
    part = std::max(0.0, std::fabs(cosine) - sine * normal_error / std::sqrt(across_sq));
  }
  const Vector3 rest = w - std::copysign(part, cosine) * n;
  const double most = std::min(part * normal_error + length(rest) * error, length(w) * error);
  return most * (1 + 0x1p-45) + 0x1p-47 * error;
}

FittedSet::FittedSet(const Obb& around, const std::array<Point3, 6>& points, double off, const Vector3& n,
                     double off_normal) {
  if (!std::isfinite(around.half.x + around.half.y + around.half.z)) return;
  box = around;
  // The box as a set of inequalities lies in that of the combinations of its axes, made larger by what these lack of
  // orthonormality; at most 64 roundings.
  box_error = 128 * unit_roundoff * (max_abs(box.centre - Point3{}) + box.half.x + box.half.y + box.half.z);
  if (!(off < INFINITY)) return;
  double largest = 0;
  net[0] = points[0] - Point3{};
  for (std::size_t k = 1; k < 6; ++k) {
    net[k] = points[k] - points[0];
    largest = std::max(largest, max_abs(net[k]));
  }
  normal = n;
  error = off;
  normal_error = off_normal;
  const double across_sq = error * error - normal_error * normal_error;
  // Any is right.
  tilt = across_sq > 0 ? std::min(normal_error / std::sqrt(across_sq), 0x1p500) : 0x1p500;
  slack = 64 * unit_roundoff * (largest + max_abs(net[0]));
}

Axes axes_around(std::span<const FittedSet> sets, std::span<const std::uint32_t> which) {
  const auto box = [&](std::size_t i) -> const Obb& { return sets[which[i]].box; };
  return axes_for(SomeBoxes<decltype(box)>{box, which.size()});
}

Obb merge(std::span<const Obb> boxes, const Axes& axes) {
  return fit_box(axes, [&](const Vector3& axis) { return extent_of(boxes, axis); });
}

Ball ball_around(const Obb& box) {
  const double reach = std::sqrt(length_sq(box.half));
  return {box.centre, std::isfinite(reach) ? enlarged(reach) : INFINITY};
}

namespace {

// The corner of boxes that is farthest from a point, and an upper bound of how far it is.
struct Farthest {
  Vector3 corner;
  double distance;
};
Farthest farthest_corner(std::span<const Obb> boxes, const Point3& from) {
  double farthest_sq = 0;
  Vector3 to_farthest;
  for (const Obb& box : boxes) {
    const Vector3 to = box.centre - from;
    Vector3 corner = to;
    double sq = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double along = dot(box.axes[k], to), reach = std::fabs(along) + box.half[k];
      sq += reach * reach;
      corner = corner + (along < 0 ? -box.half[k] : box.half[k]) * box.axes[k];
    }
    if (std::isnan(sq)) return {corner, INFINITY};
    if (sq > farthest_sq) {
      farthest_sq = sq;
      to_farthest = corner;
    }
  }
  // The axes' defect of orthonormality, and roundings of numbers of about 4.
  return {to_farthest, enlarged(std::sqrt(farthest_sq) * (1 + 64 * unit_roundoff)) +
                           64 * unit_roundoff * max_abs(from - Point3{})};
}

}  // namespace

Ball ball_around(std::span<const Obb> boxes) {
  constexpr int steps = 32;
  Ball best{boxes[0].centre, INFINITY};
  Point3 centre = merge(boxes).centre;
  for (int step = 1; step <= steps; ++step) {
    const Farthest farthest = farthest_corner(boxes, centre);
    if (farthest.distance < best.radius) best = {centre, farthest.distance};
    centre = centre + (1.0 / (step + 1)) * farthest.corner;
  }
  return best;
}

Ball ball_around(std::span<const Obb> boxes, const Point3& centre) {
  return {centre, farthest_corner(boxes, centre).distance};
}

}  // namespace snug
