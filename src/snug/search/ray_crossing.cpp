#include <snug/search/ray_crossing.h>

#include <algorithm>
#include <cmath>
#include <span>

#include <snug/geometry/rounding.h>
#include <support/direction.h>

namespace snug {
namespace {

// Newton steps that are tried: each is a proof of its own, and the error of the one is squared by the next.
constexpr unsigned max_newton_steps = 4;
// Share of a step that bending may take or add.
constexpr double max_bent = 0.8;
// Extent along the line, as a multiple of errors across it, from which on a piece is cut to the tube around it.
constexpr double max_slant = 256;
// Lines in pieces: how well these are known, as a share of the line in them, how long that is, how far it may leave their triangle, and
// steps to a point.
constexpr double max_line_error = 0x1p-20, min_line = 0x1p-16, line_slack = 0x1p-16;
constexpr unsigned max_line_steps = 6;
// Factor that covers a few roundings of a bound.
constexpr double ray_slack = 1 + 0x1p-40;

double cross2(const Offset2& a, const Offset2& b) { return a.x * b.y - a.y * b.x; }

// A matrix of two rows.
struct Matrix2 {
  double a, b, c, d;
  [[nodiscard]] Offset2 operator()(const Vector3& v) const { return {a * v.x + b * v.y, c * v.x + d * v.y}; }
  [[nodiscard]] double norm() const {
    return std::max(std::fabs(a) + std::fabs(b), std::fabs(c) + std::fabs(d));
  }
};

// Bounds of u, of v or of the rest 1 - u - v, from the matrix and the images of the second differences.
struct Gains {
  double of_off;  // of an error across the ray
  double bent;    // times the square of a step
};
Gains gains(double x, double y, double uu, double uv, double vv) {
  return {std::fabs(x) + std::fabs(y), std::fabs(uu) + std::fabs(uv) + std::fabs(vv)};
}

double max_abs2(const Vector3& v) { return std::max(std::fabs(v.x), std::fabs(v.y)); }
double max_abs(const Offset2& v) { return std::max(std::fabs(v.x), std::fabs(v.y)); }

TriangleParameter clamped(double u, double v) {
  if (!(u >= 0)) u = 0;
  if (!(v >= 0)) v = 0;
  if (const double sum = u + v; sum > 1) {
    // The nearest point of the far edge.
    const double excess = (sum - 1) / 2;
    u = std::clamp(u - excess, 0.0, 1.0);
    v = 1 - u;
  }
  return {u, v};
}

// Is the hull of points farther than `reach` from the line through `place`, on the side that w shows?
bool beyond(std::span<const Vector3> points, const Offset2& place, const Offset2& w, double reach) {
  const double size = std::sqrt(w.x * w.x + w.y * w.y);
  if (!(size > 0x1p-400)) return false;  // squares underflow
  const double least = reach * size * ray_slack;
  double largest = 0;
  for (const Vector3& p : points) {
    const double x = p.x - place.x, y = p.y - place.y;
    largest = std::max(largest, std::fabs(w.x * x) + std::fabs(w.y * y));
    if (!(w.x * x + w.y * y > least + 8 * unit_roundoff * largest)) return false;
  }
  return true;
}

// The extent along the line of a polygon of three or four corners, cut to a square of this half width around a place; empty where there
// is none.
Extent cut_to_square(std::span<const Vector3> corners, const Offset2& place, double half) {
  // Rounding may make it cross a side more than twice: each cut leaves at most half as many corners again.
  std::array<Vector3, 20> polygon, rest;
  std::copy(corners.begin(), corners.end(), polygon.begin());
  std::size_t count = corners.size();
  for (unsigned side = 0; side < 4; ++side) {
    const auto inside = [&](const Vector3& v) {
      const double from = side < 2 ? v.x - place.x : v.y - place.y;
      return half + (side % 2 == 0 ? from : -from);
    };
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Vector3 &p = polygon[i], &q = polygon[(i + 1) % count];
      const double of_p = inside(p), of_q = inside(q);
      if (of_p >= 0) rest[kept++] = p;
      if ((of_p >= 0) != (of_q >= 0)) rest[kept++] = p + of_p / (of_p - of_q) * (q - p);
    }
    polygon = rest;
    count = kept;
  }
  Extent extent;
  for (std::size_t i = 0; i < count; ++i) extent.add(polygon[i].z);
  return extent;
}

}  // namespace

RayFrame::RayFrame(const Point3& from, const Vector3& direction) : origin(from), along(direction) {
  const Vector3 size{std::fabs(along.x), std::fabs(along.y), std::fabs(along.z)};
  const std::size_t axis = size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2;
  Vector3 other;
  other[axis] = 1;
  across[0] = normalized(snug::cross(other, along));
  across[1] = snug::cross(along, across[0]);
}

SeenPiece::SeenPiece(const RayFrame& ray, const PieceBounds& record, const Point3& origin) {
  const auto seen = [&](const Vector3& v) {
    return Vector3{dot(ray.across[0], v), dot(ray.across[1], v), dot(ray.along, v)};
  };
  std::array<Vector3, 6> local;
  double largest = 0;
  for (std::size_t k = 0; k < 6; ++k) {
    local[k] = seen(record.bezier_point(k));
    largest = std::max(largest, max_abs(local[k]));
  }
  along_u_ = 2 * (local[3] - local[0]);
  along_v_ = 2 * (local[5] - local[0]);
  uu_ = local[0] + local[1] - 2 * local[3];
  vv_ = local[0] + local[2] - 2 * local[5];
  uv_ = 2 * (local[0] - local[3] - local[5] + local[4]);
  const Vector3 offset = origin - ray.origin, from = seen(offset);
  for (std::size_t k = 0; k < 6; ++k) net_[k] = from + local[k];
  // Axes are off by some roundings in length and angle, as is the ray's direction: that moves by as many
  // roundings of the distance. Values below are sums of a dozen products.
  error_ = enlarged(record.error() + 64 * unit_roundoff * (max_abs(offset) + largest) + 64 * underflow_error);
  if (!(error_ < INFINITY)) error_ = INFINITY;
}

LinePieceCrossing SeenPiece::crossing(const Offset2& place, double reach, double enough) const {
  LinePieceCrossing result;
  const double off = (error_ + reach) * ray_slack;
  if (!(off < INFINITY)) {
    result.along = unbounded;
    return result;
  }
  TriangleParameter at{1.0 / 3, 1.0 / 3};
  double farthest = 2.0 / 3 * ray_slack;  // a zero is no farther from `at`
  const double curve = max_abs2(uu_) + max_abs2(uv_) + max_abs2(vv_);
  for (unsigned step = 0; step < max_newton_steps; ++step) {
    const auto [u, v] = at;
    const Vector3 value = net_[0] + u * (along_u_ + u * uu_ + v * uv_) + v * (along_v_ + v * vv_);
    const Vector3 du = along_u_ + (2 * u) * uu_ + v * uv_, dv = along_v_ + u * uv_ + (2 * v) * vv_;
    const double determinant = du.x * dv.y - du.y * dv.x;
    const Matrix2 inverse{dv.y / determinant, -dv.x / determinant, -du.y / determinant, du.x / determinant};
    const double norm = inverse.norm();
    const auto bend = [&](const Vector3& second) { return inverse(second); };
    const Offset2 b_uu = bend(uu_), b_uv = bend(uv_), b_vv = bend(vv_);
    // The inverse times the derivative is off from 1 by this.
    const double doubt = 32 * unit_roundoff * norm * (max_abs2(along_u_) + max_abs2(along_v_) + 2 * curve);
    const double bent = ray_slack * (std::max(std::fabs(b_uu.x) + std::fabs(b_uv.x) + std::fabs(b_vv.x),
                                              std::fabs(b_uu.y) + std::fabs(b_uv.y) + std::fabs(b_vv.y)) +
                                     doubt);
    const double share = ray_slack * (bent * farthest + doubt);
    if (!(share < max_bent)) break;  // of what is not a number, too
    const Offset2 newton = inverse({value.x - place.x, value.y - place.y, 0});
    const double blur = norm * off + 32 * unit_roundoff * max_abs(newton);
    // Zeros are at most so far from `at`, then this far from the next place.
    const double far = std::min(farthest, ray_slack * (max_abs(newton) + blur) / (1 - share));
    const double radius = ray_slack * (blur + (doubt + bent * far) * far);
    const double next_u = u - newton.x, next_v = v - newton.y, rest = 1 - next_u - next_v;
    // Each barycentric coordinate by itself: those across a needle are far better known than those along it.
    const double rounding = 0x1p-50 * (1 + max_abs(newton));
    const auto off_by = [&](const Gains& of, double times) {
      const double roundings = times * (32 * unit_roundoff * max_abs(newton) + doubt * far + rounding);
      return ray_slack * (of.of_off * off + roundings + ray_slack * (of.bent + times * doubt) * far * far);
    };
    const double off_u = off_by(gains(inverse.a, inverse.b, b_uu.x, b_uv.x, b_vv.x), 1),
                 off_v = off_by(gains(inverse.c, inverse.d, b_uu.y, b_uv.y, b_vv.y), 1),
                 off_rest = off_by(gains(inverse.a + inverse.c, inverse.b + inverse.d, b_uu.x + b_uu.y,
                                         b_uv.x + b_uv.y, b_vv.x + b_vv.y),
                                   2);
    if (next_u < -off_u || next_v < -off_v || rest < -off_rest) {
      result.state = LinePieceCrossing::State::none;
      return result;
    }
    const double middle = value.z - newton.x * du.z - newton.y * dv.z;
    const double bend_along = (std::fabs(uu_.z) + std::fabs(uv_.z) + std::fabs(vv_.z)) * far * far;
    const double rest_along = (std::fabs(du.z) + std::fabs(dv.z)) * radius + error_ +
                              16 * unit_roundoff * (std::fabs(value.z) + std::fabs(middle));
    const double spread = ray_slack * (bend_along + rest_along);
    const Extent along{middle - spread, middle + spread};
    if (step == 0) {
      result.along = along;
    } else {  // both hold
      result.along.lower = std::max(result.along.lower, along.lower);
      result.along.upper = std::min(result.along.upper, along.upper);
    }
    const bool inside =
        next_u > off_u && next_v > off_v && rest > off_rest && ray_slack * (max_abs(newton) + radius) <= far;
    result.at = clamped(next_u, next_v);
    if (inside) {
      result.state = LinePieceCrossing::State::one;
      result.side = determinant > 0 ? 1 : -1;
    } else if (result.state != LinePieceCrossing::State::one) {
      result.state = LinePieceCrossing::State::unsure;
    }
    // Nothing is left to be gained where errors are most of the radius, and of the extent.
    if (radius < 2 * blur &&
        (bend_along <= rest_along || result.along.upper - result.along.lower <= enough)) {
      result.limited_by_errors = true;
      break;
    }
    at = result.at;
    farthest = std::min(
        1.0, ray_slack * (std::max(std::fabs(next_u - at.u), std::fabs(next_v - at.v)) + radius + rounding));
  }
  // Seen as narrow as errors: the line may be along it.
  const bool along = result.state == LinePieceCrossing::State::unsure &&
                     result.along.upper - result.along.lower > max_slant * off;
  if (result.state != LinePieceCrossing::State::bent && !along) return result;
  const Extent near = chord(place, reach);
  if (along) {
    result.along = {std::max(result.along.lower, near.lower), std::min(result.along.upper, near.upper)};
    if (result.along.upper < result.along.lower) result.state = LinePieceCrossing::State::none;
    return result;
  }
  // By lines between the piece and the ray: across its edges, and from its corners.
  Offset2 middle;
  double nearest = INFINITY;
  for (std::size_t k = 0; k < 6; ++k) {
    middle.x += net_[k].x / 6 - place.x / 6;
    middle.y += net_[k].y / 6 - place.y / 6;
  }
  result.along = near;
  bool none = near.upper < near.lower || beyond(net_, place, middle, off);
  for (std::size_t k = 0; k < 3 && !none; ++k) {
    const Vector3 &p = net_[k], &q = net_[(k + 1) % 3];
    const Offset2 corner{p.x - place.x, p.y - place.y}, normal{p.y - q.y, q.x - p.x};
    const double distance = std::hypot(corner.x, corner.y);
    if (distance < nearest) {
      nearest = distance;
      result.at = {k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0};
    }
    none = beyond(net_, place, corner, off) || beyond(net_, place, normal, off) ||
           beyond(net_, place, {-normal.x, -normal.y}, off);
  }
  if (none) result.state = LinePieceCrossing::State::none;
  return result;
}

Extent SeenPiece::chord(const Offset2& place, double reach) const {
  double bend = 0, bend_along = 0, largest = std::fabs(place.x) + std::fabs(place.y);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3 &p = net_[k], &q = net_[(k + 1) % 3];
    const Vector3 off = net_[3 + k] - 0.5 * (p + q);
    bend = std::max(bend, max_abs2(off));
    bend_along = std::max(bend_along, std::fabs(off.z));
    largest = std::max(largest, max_abs(p));
  }
  const double rounding = 64 * unit_roundoff * largest;
  const double half = ray_slack * (error_ + reach + bend + rounding),
               along = ray_slack * (error_ + bend_along + rounding);
  const Extent extent = cut_to_square(std::span(net_).first(3), place, half);
  return {extent.lower - along, extent.upper + along};
}

double SeenPiece::bend() const {
  double bend = 0;
  for (std::size_t k = 0; k < 3; ++k)
    bend = std::max(bend, max_abs(net_[3 + k] - 0.5 * (net_[k] + net_[(k + 1) % 3])));
  return bend;
}

bool SeenPiece::seems_to_hold_line(const Extent& along) const {
  const double length = along.upper - along.lower;
  // A line that only touches a piece is as near to it along less.
  if (!(error_ <= max_line_error * length) || !(length >= min_line)) return false;
  double largest = 0;
  for (const Vector3& p : net_) largest = std::max(largest, max_abs(p));
  const double noise = 2 * error_ + 64 * unit_roundoff * largest;
  TriangleParameter at{1.0 / 3, 1.0 / 3};
  for (const double share : {0.3, 0.5, 0.7}) {
    const Vector3 wanted{0, 0, along.lower + share * length};
    Vector3 rest;
    // Gauss's and Newton's steps.
    for (unsigned step = 0; step < max_line_steps; ++step) {
      const auto [u, v] = at;
      rest = wanted - (net_[0] + u * (along_u_ + u * uu_ + v * uv_) + v * (along_v_ + v * vv_));
      const Vector3 du = along_u_ + (2 * u) * uu_ + v * uv_, dv = along_v_ + u * uv_ + (2 * v) * vv_;
      const Vector3 normal = snug::cross(du, dv);
      const double square = length_sq(normal);
      const double by_u = dot(snug::cross(rest, dv), normal) / square,
                   by_v = dot(snug::cross(du, rest), normal) / square;
      at = {u + by_u, v + by_v};
      if (!(std::fabs(at.u) + std::fabs(at.v) < 4)) return false;
    }
    const auto [u, v] = at;
    if (!(max_abs(rest) <= noise) || u < -line_slack || v < -line_slack || u + v > 1 + line_slack)
      return false;
  }
  return true;
}

std::optional<Extent> chord_in_plane(const RayFrame& ray, const std::array<Point3, 4>& quad, double error,
                                     double reach) {
  std::array<Vector3, 4> seen;
  double largest = 0;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    const Vector3 from = quad[k] - ray.origin;
    seen[k] = {dot(ray.across[0], from), dot(ray.across[1], from), dot(ray.along, from)};
    largest = std::max(largest, max_abs(from));
  }
  const double off = ray_slack * (2 * error + 64 * unit_roundoff * largest + 64 * underflow_error);
  // How thick the quad is seen: across some side, or not at all.
  const double thin = 64 * off;
  double least = INFINITY;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    for (std::size_t k = i + 1; k < seen.size(); ++k) {
      const Vector3& p = seen[i];
      const Vector3 side = seen[k] - p;
      const double size = std::hypot(side.x, side.y);
      double width = 0;
      for (std::size_t j = 0; j < seen.size(); ++j) {
        const Vector3 from = seen[j] - p;
        width = std::max(width, size > 0 ? std::fabs(cross2({side.x, side.y}, {from.x, from.y})) / size
                                         : std::hypot(from.x, from.y));
      }
      least = std::min(least, width);
    }
  }
  if (!(least <= thin)) return std::nullopt;
  const Extent extent = cut_to_square(seen, {}, ray_slack * (reach + off));
  return Extent{extent.lower - off, extent.upper + off};
}

bool SeenPiece::passes_side(std::size_t k, const Offset2& place, double reach) const {
  const std::size_t next = (k + 1) % 3;
  const std::array<Vector3, 3> side{net_[k], net_[3 + k], net_[next]};
  const double off = (error_ + reach) * ray_slack;
  const Offset2 normal{side[0].y - side[2].y, side[2].x - side[0].x};
  if (beyond(side, place, normal, off) || beyond(side, place, {-normal.x, -normal.y}, off)) return true;
  for (const Vector3& p : side) {
    if (beyond(side, place, {p.x - place.x, p.y - place.y}, off)) return true;
  }
  return false;
}

double SeenPiece::width() const {
  double least = INFINITY;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3 &p = net_[k], &q = net_[(k + 1) % 3];
    const Offset2 side{q.x - p.x, q.y - p.y};
    const double size = std::sqrt(side.x * side.x + side.y * side.y);
    double lower = 0, upper = 0;
    for (const Vector3& r : net_) {
      const Offset2 from{r.x - p.x, r.y - p.y};
      const double height = size > 0 ? cross2(side, from) / size : std::hypot(from.x, from.y);
      lower = std::min(lower, height);
      upper = std::max(upper, height);
    }
    least = std::min(least, upper - lower);
  }
  return least;
}

}  // namespace snug
