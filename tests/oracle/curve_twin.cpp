#include <oracle/curve_twin.h>
#include <oracle/quad.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace oracle {

namespace {

using QuadPoint = std::array<Quad, 3>;

void require(bool condition) {
  if (!condition) throw std::invalid_argument("oracle: an argument is out of range");
}

QuadPoint exact(const Point& p) { return {p[0], p[1], p[2]}; }

QuadPoint sum(Quad a, const QuadPoint& p, Quad b, const QuadPoint& q, Quad c = 0, const QuadPoint& r = {}) {
  QuadPoint result{};
  for (std::size_t x = 0; x < 3; ++x) result[x] = a * p[x] + b * q[x] + c * r[x];
  return result;
}

double largest_coordinate(const TwinPolyline& polyline) {
  double largest = 0;
  for (const Point& p : polyline.points)
    for (const double x : p) largest = std::max(largest, std::abs(x));
  return largest;
}

/// Weights and points of up to 4 times the largest coordinate, some twenty roundings a step: 400 u with u =
/// 2^-113 holds.
CurveSample sample(std::uint32_t edge, double t, const QuadPoint& p, double largest, int steps) {
  CurveSample result{edge, t, {}, 0};
  Quad worst = 0;
  for (std::size_t x = 0; x < 3; ++x) {
    result.position[x] = static_cast<double>(p[x]);
    const Quad off = p[x] - static_cast<Quad>(result.position[x]);
    worst = std::max(worst, off < 0 ? -off : off);
  }
  worst += static_cast<Quad>(400 * (steps + 1)) * static_cast<Quad>(0x1p-113) * static_cast<Quad>(largest);
  result.error = static_cast<double>(worst);
  if (static_cast<Quad>(result.error) < worst) {
    result.error = std::nextafter(result.error, std::numeric_limits<double>::infinity());
  }
  return result;
}

}  // namespace

CurveSample curve_at(const TwinPolyline& polyline, int degree, std::uint32_t edge, double t) {
  const auto n = static_cast<std::int64_t>(polyline.points.size());
  require((degree == 2 || degree == 3) && n >= (polyline.closed ? 1 : 2) && edge < polyline.edge_count() &&
          t >= 0 && t <= 1);
  const auto point = [&](std::int64_t i) {
    if (polyline.closed) return exact(polyline.points[static_cast<std::size_t>((i + n) % n)]);
    if (i < 0) return sum(2, exact(polyline.points[0]), -1, exact(polyline.points[1]));
    const auto last = static_cast<std::size_t>(n - 1);
    if (i >= n) return sum(2, exact(polyline.points[last]), -1, exact(polyline.points[last - 1]));
    return exact(polyline.points[static_cast<std::size_t>(i)]);
  };
  const double largest = largest_coordinate(polyline);
  if (degree == 3) {
    const auto i = static_cast<std::int64_t>(edge);
    const Quad x = t, xx = x * x, xxx = xx * x;
    const QuadPoint first =
        sum((1 - 3 * x + 3 * xx - xxx) / 6, point(i - 1), (4 - 6 * xx + 3 * xxx) / 6, point(i));
    const QuadPoint second = sum((1 + 3 * x + 3 * xx - 3 * xxx) / 6, point(i + 1), xxx / 6, point(i + 2));
    return sample(edge, t, sum(1, first, 1, second), largest, 0);
  }
  // The segment of vertex i runs from -1/2 to 1/2.
  const auto i = static_cast<std::int64_t>(edge) + (t > 0.5 ? 1 : 0);
  const Quad x = static_cast<Quad>(t) + static_cast<Quad>(t > 0.5 ? -0.5 : 0.5), xx = x * x;
  return sample(
      edge, t,
      sum((1 - 2 * x + xx) / 2, point(i - 1), (1 + 2 * x - 2 * xx) / 2, point(i), xx / 2, point(i + 1)),
      largest, 0);
}

std::vector<CurveSample> subdivided_curve(const TwinPolyline& polyline, int degree, int levels) {
  require((degree == 2 || degree == 3) && levels >= 0 && levels <= 12 &&
          polyline.points.size() >= (polyline.closed ? 1u : 2u));
  // Coordinates and the parameter, which goes through the same steps: all of its numbers are dyadic.
  struct Vertex {
    QuadPoint at;
    double parameter;
  };
  std::vector<Vertex> vertices;
  for (const Point& p : polyline.points) vertices.push_back({exact(p), static_cast<double>(vertices.size())});
  const auto between = [](const Vertex& a, double weight, const Vertex& b) {
    return Vertex{sum(1 - weight, a.at, weight, b.at), (1 - weight) * a.parameter + weight * b.parameter};
  };
  const double turn = polyline.edge_count();
  for (int level = 0; level < levels; ++level) {
    std::vector<Vertex> next;
    const std::size_t n = vertices.size();
    if (polyline.closed) {
      for (const Vertex& v : vertices) next.insert(next.end(), {v, v});
      for (int round = 0; round < degree; ++round) {
        const Vertex first{next.front().at, next.front().parameter + turn};
        for (std::size_t i = 0; i < next.size(); ++i) {
          next[i] = between(next[i], 0.5, i + 1 < next.size() ? next[i + 1] : first);
        }
      }
    } else {
      next.push_back(vertices.front());
      for (std::size_t i = 0; i + 1 < n; ++i) {
        const Vertex &a = vertices[i], &b = vertices[i + 1];
        if (degree == 2) {
          next.insert(next.end(), {between(a, 0.25, b), between(a, 0.75, b)});
          continue;
        }
        if (i > 0) next.push_back(between(a, 0.25, between(vertices[i - 1], 0.5, b)));
        next.push_back(between(a, 0.5, b));
      }
      next.push_back(vertices.back());
    }
    vertices = std::move(next);
  }
  std::vector<CurveSample> samples;
  const double largest = largest_coordinate(polyline), step = std::ldexp(1.0, -levels);
  const std::size_t n = vertices.size();
  const Quad sixth = 1 / static_cast<Quad>(6), eighth = 0.125;
  for (std::size_t i = 0; i < n; ++i) {
    const Vertex &before = vertices[(i + n - 1) % n], &here = vertices[i], &after = vertices[(i + 1) % n];
    const bool end = !polyline.closed && (i == 0 || i + 1 == n);
    const bool even = polyline.closed ||
                      (here.parameter - before.parameter == step && after.parameter - here.parameter == step);
    if (!end && !even) continue;
    const double parameter = polyline.closed ? std::fmod(here.parameter, turn) : here.parameter;
    const double edge = std::min(std::floor(parameter), turn - 1);
    const QuadPoint limit = end           ? here.at
                            : degree == 3 ? sum(sixth, before.at, 4 * sixth, here.at, sixth, after.at)
                                          : sum(eighth, before.at, 6 * eighth, here.at, eighth, after.at);
    samples.push_back(sample(static_cast<std::uint32_t>(edge), parameter - edge, limit, largest, levels));
  }
  return samples;
}

}  // namespace oracle
