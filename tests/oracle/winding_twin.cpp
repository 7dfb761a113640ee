#include <oracle/winding_twin.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace oracle {

namespace {

using Id = std::uint32_t;
using Polygons = std::vector<std::vector<Id>>;

// Turns faces round until all edges have two faces that run along them in opposite directions. The first
// `seeds` faces are right as they are.
void orient(Polygons& faces, std::size_t seeds) {
  std::map<std::pair<Id, Id>, std::vector<std::size_t>> faces_of;
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (std::size_t k = 0; k < faces[f].size(); ++k)
      faces_of[std::minmax(faces[f][k], faces[f][(k + 1) % faces[f].size()])].push_back(f);
  std::vector<char> done(faces.size(), 0);
  std::vector<std::size_t> stack;
  for (std::size_t f = 0; f < seeds; ++f) done[f] = 1, stack.push_back(f);
  const auto runs = [&](std::size_t f, Id a, Id b) {
    for (std::size_t k = 0; k < faces[f].size(); ++k)
      if (faces[f][k] == a && faces[f][(k + 1) % faces[f].size()] == b) return true;
    return false;
  };
  while (!stack.empty()) {
    const std::size_t f = stack.back();
    stack.pop_back();
    for (std::size_t k = 0; k < faces[f].size(); ++k) {
      const Id a = faces[f][k], b = faces[f][(k + 1) % faces[f].size()];
      for (const std::size_t g : faces_of[std::minmax(a, b)]) {
        if (g == f || done[g]) continue;
        if (runs(g, a, b)) std::reverse(faces[g].begin(), faces[g].end());
        done[g] = 1;
        stack.push_back(g);
      }
    }
  }
}

TaggedMesh refined(const TaggedMesh& mesh, const WindingScheme& scheme, int levels) {
  if (const Rules* const rules = std::get_if<Rules>(&scheme)) return refine(mesh, *rules, levels);
  TaggedMesh fine = mesh;
  for (int level = 0; level < levels; ++level) {
    const std::size_t seeds = fine.polygons.size();
    fine = refine_dual(fine, std::get<DualScheme>(scheme));
    orient(fine.polygons, seeds);
  }
  return fine;
}

double solid_angle(const Point& a, const Point& b, const Point& c) {
  const auto dot = [](const Point& p, const Point& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; };
  const double volume = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                        a[2] * (b[0] * c[1] - b[1] * c[0]);
  const double la = std::sqrt(dot(a, a)), lb = std::sqrt(dot(b, b)), lc = std::sqrt(dot(c, c));
  return 2 * std::atan2(volume, la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

}  // namespace

WindingTwin::WindingTwin(const TaggedMesh& mesh, const WindingScheme& scheme, int levels)
    : mesh_(refined(mesh, scheme, levels)) {
  std::vector<std::vector<Id>> faces_at(mesh_.points.size());
  for (Id f = 0; f < mesh_.polygons.size(); ++f)
    for (const Id v : mesh_.polygons[f]) faces_at[v].push_back(f);
  const double infinity = std::numeric_limits<double>::infinity();
  const auto grow = [&](Box& box, Id v) {
    for (const Id f : faces_at[v])
      for (const Id w : mesh_.polygons[f])
        for (std::size_t x = 0; x < 3; ++x) {
          const double slack = 1e-12 * (1 + std::fabs(mesh_.points[w][x]));
          box.lower[x] = std::min(box.lower[x], mesh_.points[w][x] - slack);
          box.upper[x] = std::max(box.upper[x], mesh_.points[w][x] + slack);
        }
  };
  const Box empty{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
  if (std::holds_alternative<Rules>(scheme)) {
    for (const auto& polygon : mesh_.polygons) {
      Box box = empty;
      for (const Id v : polygon) grow(box, v);
      boxes_.push_back(box);
    }
  } else {
    for (Id v = 0; v < mesh_.points.size(); ++v) {
      if (faces_at[v].empty()) continue;
      Box box = empty;
      grow(box, v);
      boxes_.push_back(box);
    }
  }
}

double WindingTwin::distance_to_boxes(const Point& q) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Box& box : boxes_) {
    double sum = 0;
    for (std::size_t x = 0; x < 3; ++x) {
      const double beyond = std::max({box.lower[x] - q[x], q[x] - box.upper[x], 0.0});
      sum += beyond * beyond;
    }
    least = std::min(least, sum);
  }
  return std::sqrt(least) * (1 - 1e-15);
}

std::optional<int> WindingTwin::operator()(const Point& q) const {
  for (const Box& box : boxes_) {
    bool inside = true;
    for (std::size_t x = 0; x < 3; ++x) inside = inside && box.lower[x] <= q[x] && q[x] <= box.upper[x];
    if (inside) return std::nullopt;
  }
  const auto from = [&](Id v) {
    const Point& p = mesh_.points[v];
    return Point{p[0] - q[0], p[1] - q[1], p[2] - q[2]};
  };
  double sum = 0;
  for (const auto& polygon : mesh_.polygons) {
    const Point first = from(polygon[0]);
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
      sum += solid_angle(first, from(polygon[k]), from(polygon[k + 1]));
  }
  const double turns = sum / (4 * std::numbers::pi);
  const double rounded = std::round(turns);
  if (std::fabs(turns - rounded) > 1e-6) throw std::logic_error("the refined mesh is not closed");
  return static_cast<int>(rounded);
}

}  // namespace oracle
