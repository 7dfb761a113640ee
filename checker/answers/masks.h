#pragma once

#include "net.h"

namespace answers {

/// A sum of weighted points.
struct Sum {
  Point value{Real(0.0), Real(0.0), Real(0.0)};
  void add(const Point& p) {
    for (std::size_t axis = 0; axis < 3; ++axis) value[axis] += p[axis];
  }
  void add(const Real& weight, const Point& p) {
    for (std::size_t axis = 0; axis < 3; ++axis) value[axis].add_product(weight, p[axis]);
  }
  void scale(const Real& by) {
    for (Real& x : value) x = std::move(x) * by;
  }
};

/// A vertex with its edges, each by the vertex at its other end.
struct Spoke {
  Index edge, end;
  double sharpness;
};

// Masks of smooth vertices and edges. All weights are at least 0, and sum to 1.

/// Loop's scheme [Loop87]: (1 - a) v + a mean(ring), a = 5/8 - (3 + 2 cos(2 pi/n))^2 / 64; 3/8 of
/// the ends and 1/8 of the vertices across.
[[nodiscard]] Point loop_vertex(const Net& net, Index v, std::span<const Spoke> spokes);
[[nodiscard]] Point loop_edge(const Net& net, Index edge);

/// Catmull-Clark [CatmullClark78]: (n - 2)/n v + mean(ends)/n + mean(face means)/n; (1 - 2 f)/2 of
/// the ends and f of the means of both faces, f = 1/4, with smooth triangles half of 0.47 for each
/// triangle.
[[nodiscard]] Point catmark_vertex(const Net& net, Index v, std::span<const Spoke> spokes,
                                   const std::vector<const Point*>& means);
[[nodiscard]] Point catmark_edge(const Net& net, Index edge,
                                 const std::array<const Point*, 2>& means, bool smooth_triangles);
[[nodiscard]] Point mean_of_face(const Net& net, Index face);

/// The new vertex in a face near one of its corners: Doo-Sabin [DooSabin78], a_0 = 1/4 + 5/(4n),
/// a_i = (3 + 2 cos(2 pi i/n)) / (4n); Midedge [PetersReif97], 1/2 and 1/4 for both neighbours.
[[nodiscard]] Point dual_vertex(const Net& net, Index corner, Scheme scheme);

}  // namespace answers
