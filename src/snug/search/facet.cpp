#include <snug/search/facet.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <snug/geometry/double_double.h>
#include <snug/geometry/exact_sign.h>
#include <snug/geometry/rounding.h>
#include <support/direction.h>

namespace snug {
namespace {

// A quad is flatter than that, of its size, and its corners turn by more, as sines.
constexpr double max_quad_height = 0x1p-44, min_quad_turn = 0x1p-16;
// Of the search for a parameter in a quad.
constexpr int max_place_steps = 8;

using QuadPoints = std::array<Point3, 4>;

// The corners of a quad: of the face itself, or of the one that the first split makes at its corner k.
struct QuadCorners {
  QuadPoints at{};
  double error = 0;
};
QuadCorners quad_of(const LimitSurface& surface, std::span<const VertexId> face, std::size_t k) {
  QuadCorners quad;
  if (face.size() == 4) {
    for (std::size_t i = 0; i < 4; ++i) quad.at[i] = surface.scaled_point(face[i]);
    return quad;
  }
  const std::size_t n = face.size();
  const auto corner = [&](std::size_t i) -> const Point3& { return surface.scaled_point(face[i % n]); };
  // Relative to corner k: what is added errs by the face's size alone.
  const Point3 own = corner(k);
  Vector3 sum;
  double largest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3 from = corner(i) - own;
    sum = sum + from;
    largest = std::max(largest, max_abs(from));
  }
  quad.at = {own, own + 0.5 * (corner(k + 1) - own), own + (1.0 / static_cast<double>(n)) * sum,
             own + 0.5 * (corner(k + n - 1) - own)};
  double coordinate = max_abs(own - Point3{});
  for (const Point3& p : quad.at) coordinate = std::max(coordinate, max_abs(p - Point3{}));
  quad.error = enlarged(gamma_bound(n + 4) * largest + unit_roundoff * coordinate);
  return quad;
}

// How far the corners are from one plane, if each turns the same way in it.
std::optional<double> flatness(const QuadPoints& quad) {
  const Vector3 normal = normalized(cross(quad[2] - quad[0], quad[3] - quad[1]));
  if (normal == Vector3{}) return std::nullopt;
  double size = 0, height = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vector3 edge = quad[(k + 1) % 4] - quad[k], next = quad[(k + 2) % 4] - quad[(k + 1) % 4];
    const double turn = dot(normal, cross(edge, next));
    if (!(turn > min_quad_turn * length(edge) * length(next))) return std::nullopt;
    const Vector3 from = quad[k] - quad[0];
    height = std::max(height, std::fabs(dot(normal, from)));
    size = std::max(size, length(from));
  }
  if (!(height <= max_quad_height * size) || !(size > 0x1p-300)) return std::nullopt;
  return enlarged(height + 8 * unit_roundoff * size);
}

// Does each edge have all other corners on its left, exactly, in one plane?
bool convex_in_plane(std::span<const Point3> all, std::span<const VertexId> face) {
  const auto at = [&](std::size_t k) -> const Point3& { return all[face[k % face.size()].index()]; };
  Projection plane;
  int turn = 0;
  for (std::size_t i = 0; i < 3 && turn == 0; ++i) {
    plane = {i, (i + 1) % 3};
    turn = orientation(at(0), at(1), at(2), plane);
  }
  if (turn == 0) return false;
  for (std::size_t k = 0; k < face.size(); ++k) {
    if (orientation(at(0), at(1), at(2), at(k)) != 0) return false;
    for (std::size_t other = k + 2; other < k + face.size(); ++other) {
      if (orientation(at(k), at(k + 1), at(other), plane) != turn) return false;
    }
  }
  return true;
}

using Twofold = Vector3Of<DoubleDouble>;
Twofold operator+(const Twofold& a, const Twofold& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }

}  // namespace

// Without other control points all edges are sharp, or borders; and corners that stay where they are are sharp.
bool is_between_corners(const LimitSurface& surface, PatchId patch) {
  const SchemeRules& rules = surface.rules();
  if (rules.local) return true;
  if (!rules.primal) return false;
  const Kind& kind = surface.kind(patch);
  if (kind.control_count() != rules.corners || kind.transient() || surface.polygon_of(patch) != nullptr)
    return false;
  const auto stay = [](const Stencils& limits) {
    for (std::size_t row = 0; row < limits.row_count(); ++row) {
      if (limits.row(row).sources.size() != 1) return false;
    }
    return true;
  };
  return stay(kind.corner_limits()) && (rules.triangular() || stay(kind.far_corner().limit));
}

std::optional<Facet> facet_of(const LimitSurface& surface, PatchId patch) {
  if (!is_between_corners(surface, patch)) return std::nullopt;
  const PatchPlace place = surface.place(patch);
  const std::span<const VertexId> face = surface.topology().face(FaceId(place.owner));
  Facet facet;
  if (surface.rules().triangular()) {
    for (std::size_t k = 0; k < 3; ++k) facet.triangle[k] = surface.scaled_point(face[k]);
  } else {
    const QuadCorners quad = quad_of(surface, face, place.part / 2);
    const std::optional<double> height = flatness(quad.at);
    if (!height) return std::nullopt;
    facet.corner = place.part / 2;
    facet.second = place.part % 2 == 1;
    const std::size_t first = facet.second ? 2 : 0;
    for (std::size_t k = 0; k < 3; ++k) facet.triangle[k] = quad.at[(first + k) % 4];
    facet.far = quad.at[(first + 3) % 4];
    facet.error = quad.error;
    facet.off = enlarged(2 * *height + 2 * spatial_error(quad.error));
    facet.largest = max_abs(*facet.far - Point3{});
  }
  for (const Point3& p : facet.triangle) facet.largest = std::max(facet.largest, max_abs(p - Point3{}));
  return facet;
}

bool is_exact_facet(const LimitSurface& surface, FaceId f, PatchId patch) {
  if (!is_between_corners(surface, patch)) return false;
  const std::span<const VertexId> face = surface.topology().face(f);
  const PowerOfTwo scale = surface.scale();
  for (const VertexId v : face) {
    const Point3& p = surface.mesh().points[v.index()];
    if (!may_be_signed(surface.scaled_point(v)) || !scale.exact(p.x) || !scale.exact(p.y) ||
        !scale.exact(p.z))
      return false;
  }
  return face.size() == 3 ||
         (face.size() <= max_facet_corners && convex_in_plane(surface.scaled_points(), face));
}

TriangleParameter Facet::place_of(Barycentric at) const {
  if (!far) return {at.b, at.c};
  // The point is c0 + b e + c d of a half whose sides are e and d; of the quad, with f its other side at corner 0,
  // it is c0 + u e + v f + u v (d - e - f).
  const Vector3 e = triangle[1] - triangle[0], d = triangle[2] - triangle[0], f = *far - triangle[0];
  const Vector3 twist = d - e - f, wanted = at.b * e + at.c * d;
  double u = at.b + at.c, v = at.c;
  for (int step = 0; step < max_place_steps; ++step) {
    const Vector3 rest = wanted - u * e - v * f - (u * v) * twist;
    const Vector3 du = e + v * twist, dv = f + u * twist, normal = cross(du, dv);
    const double square = length_sq(normal);
    const double by_u = dot(cross(rest, dv), normal) / square, by_v = dot(cross(du, rest), normal) / square;
    if (!std::isfinite(by_u) || !std::isfinite(by_v)) break;
    u = std::clamp(u + by_u, 0.0, 1.0);
    v = std::clamp(v + by_v, 0.0, 1.0);
    if (std::fabs(by_u) + std::fabs(by_v) < 0x1p-50) break;
  }
  // Sides of the quad are kept.
  if (at.c == 0) v = 0;
  if (at.b + at.c == 1) u = 1;
  return second ? TriangleParameter{1 - u, 1 - v} : TriangleParameter{u, v};
}

BoundedPoint Facet::point(TriangleParameter at) const {
  const DoubleDouble one{1, 0};
  DoubleDouble u{at.u, 0}, v{at.v, 0};
  if (second) u = one - u, v = one - v;
  const Point3& from = triangle[0];
  Twofold sum;
  if (far) {
    const auto e = difference<DoubleDouble>(from, triangle[1]),
               d = difference<DoubleDouble>(from, triangle[2]), f = difference<DoubleDouble>(from, *far);
    sum = u * (e - v * e) + v * (f - u * f) + (u * v) * d;
  } else {
    sum = u * difference<DoubleDouble>(from, triangle[1]) + v * difference<DoubleDouble>(from, triangle[2]);
  }
  const auto rounded = [](double x, const DoubleDouble& d) { return (DoubleDouble{x, 0} + d).high; };
  const Point3 point{rounded(from.x, sum.x), rounded(from.y, sum.y), rounded(from.z, sum.z)};
  const double rounding = unit_roundoff * max_abs(point - Point3{}) + 0x1p-90 * largest + 0x1p-400;
  return {point, error > 0 ? enlarged(error + rounding) : rounding * (1 + 8 * unit_roundoff)};
}

}  // namespace snug
