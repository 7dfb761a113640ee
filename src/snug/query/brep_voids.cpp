#include <snug/query/brep_voids.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include <snug/spline/face_spline.h>

namespace snug {
namespace {

// More shells are not compared: the time grows with the number of pairs.
constexpr std::size_t most_shells = 2000;

struct Sampled {
  Box3 box;
  std::vector<Triangle> triangles;
  double volume = 0;
};

Sampled sampled(std::span<const Brep::Face> faces) {
  Sampled result;
  for (const Brep::Face& face : faces) {
    const std::vector<double> u = breaks_of(face.surface.u_knots), v = breaks_of(face.surface.v_knots);
    std::vector<Point3> points;
    for (const double y : v) {
      for (const double x : u) points.push_back(frame_at(face.surface, x, y).point);
    }
    for (std::size_t j = 0; j + 1 < v.size(); ++j) {
      for (std::size_t i = 0; i + 1 < u.size(); ++i) {
        const std::size_t a = i + u.size() * j, b = a + 1, c = b + u.size(), d = a + u.size();
        if (face.triangle() && j > i) continue;
        result.triangles.push_back({points[a], points[b], points[c]});
        if (face.triangle() && j == i) continue;
        result.triangles.push_back({points[a], points[c], points[d]});
      }
    }
    for (const Point3& p : points) result.box.add(p);
  }
  const Point3 origin = result.box.lower;
  for (const auto& [a, b, c] : result.triangles)
    result.volume += dot(a - origin, cross(b - origin, c - origin)) / 6;
  return result;
}

bool within(const Box3& outer, const Box3& inner) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (inner.lower[k] < outer.lower[k] || inner.upper[k] > outer.upper[k]) return false;
  }
  return true;
}

// Does a shell wind around a point? By solid angles.
bool around(const Sampled& shell, const Point3& point) {
  double sum = 0;
  for (const auto& [p, q, r] : shell.triangles) {
    const Vector3 a = p - point, b = q - point, c = r - point;
    const double la = length(a), lb = length(b), lc = length(c);
    sum += std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return std::fabs(sum) > 3.14159265358979;  // half of the full angle, which is twice as much
}

// About the diagonal; a face over one triangle about the other one, so that its half stays where it is.
void turn_over(Brep::Face& face) {
  SplineSurface& s = face.surface;
  const std::size_t columns = s.columns(), rows = s.rows();
  std::vector<Point3> points;
  points.reserve(s.points.size());
  for (std::size_t i = 0; i < columns; ++i) {
    for (std::size_t j = 0; j < rows; ++j) points.push_back(s.points[i + columns * j]);
  }
  s.points = std::move(points);
  std::swap(s.u_knots, s.v_knots);
  std::reverse(face.loop.begin(), face.loop.end());
  for (Brep::Side& side : face.loop) side.reversed = !side.reversed;
  if (!face.triangle()) return;
  std::reverse(s.points.begin(), s.points.end());
  for (std::vector<double>* knots : {&s.u_knots, &s.v_knots}) {
    std::reverse(knots->begin(), knots->end());
    for (double& knot : *knots) knot = 1 - knot;
  }
  std::rotate(face.loop.begin(), face.loop.begin() + 1, face.loop.end());
}

}  // namespace

void find_voids(Brep& brep, const WorkMonitor& monitor) {
  std::vector<std::uint32_t> closed;
  std::vector<Sampled> samples;
  for (std::uint32_t s = 0; s < brep.shells.size(); ++s) {
    const Brep::Shell& shell = brep.shells[s];
    if (!shell.closed) continue;
    monitor.checkpoint();
    closed.push_back(s);
    samples.push_back(sampled({brep.faces.data() + shell.begin, brep.faces.data() + shell.end}));
  }
  // The shells around each, the outermost first.
  std::vector<std::vector<std::size_t>> around_it(closed.size());
  for (std::size_t i = 0; i < closed.size() && closed.size() <= most_shells; ++i) {
    monitor.checkpoint();
    for (std::size_t k = 0; k < closed.size(); ++k) {
      if (k != i && within(samples[k].box, samples[i].box) &&
          around(samples[k], samples[i].triangles.front()[0]))
        around_it[i].push_back(k);
    }
  }
  std::vector<std::size_t> order(closed.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return around_it[a].size() < around_it[b].size(); });
  for (const std::size_t i : order) {
    std::optional<std::size_t> outer;  // the nearest one
    for (const std::size_t k : around_it[i]) {
      if (!outer || around_it[k].size() > around_it[*outer].size()) outer = k;
    }
    Brep::Shell& shell = brep.shells[closed[i]];
    const bool inward = samples[i].volume < 0;
    // A void is oriented against the solid around it in the mesh, whichever way that is.
    if (outer && !brep.shells[closed[*outer]].void_of && inward != (samples[*outer].volume < 0))
      shell.void_of = closed[*outer];
    if (inward == shell.void_of.has_value()) continue;
    for (std::uint32_t f = shell.begin; f < shell.end; ++f) turn_over(brep.faces[f]);
  }
}

}  // namespace snug
