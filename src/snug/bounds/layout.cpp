#include <snug/bounds/layout.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include <snug/geometry/interval.h>
#include <support/contract.h>

namespace snug {
namespace {

LayoutPoint operator+(LayoutPoint a, LayoutPoint b) { return {a[0] + b[0], a[1] + b[1]}; }
LayoutPoint operator-(LayoutPoint a, LayoutPoint b) { return {a[0] - b[0], a[1] - b[1]}; }
LayoutPoint operator*(double s, LayoutPoint a) { return {s * a[0], s * a[1]}; }

constexpr std::array<LayoutPoint, 3> unit_triangle{{{0, 0}, {1, 0}, {0, 1}}};

// The ring of a corner, counter-clockwise from corner + 1: so corner + 2 comes second. At a boundary those
// clockwise of corner + 1 are apart, nearest first.
struct Ring {
  std::vector<std::size_t> after, before;
};

Ring ring_of(const Topology& topology, std::size_t corner) {
  const HalfEdge own = topology.first_of(FaceId(0)) + static_cast<HalfEdge>(corner);
  Ring ring;
  HalfEdge h = own;
  do {
    ring.after.push_back(topology.to(h).index());
    const HalfEdge next = topology.ccw(h);
    if (next == no_half_edge) {
      ring.after.push_back(topology.from(topology.prev(h)).index());
      for (h = topology.cw(own); h != no_half_edge; h = topology.cw(h))
        ring.before.push_back(topology.to(h).index());
      return ring;
    }
    h = next;
  } while (h != own);
  return ring;
}

// Twice the cosine of the angle between spokes: equal angles, half a turn in all at a boundary.
double twice_cosine(const CornerFan& fan) {
  const auto faces = static_cast<unsigned>(fan.faces());
  return 2 * middle(cos_of_turn(1, fan.closed ? faces : 2 * faces));
}

// Calls place(vertex, where) for the ring of a corner as the affine image of a regular fan:
// u_{j+1} = 2 cos u_j - u_{j-1}.
template <class Place>
void lay_ring(const Topology& topology, const CornerFan& fan, std::size_t corner, Place&& place) {
  const LayoutPoint centre = unit_triangle[corner];
  const LayoutPoint first = unit_triangle[(corner + 1) % 3] - centre;
  const LayoutPoint second = unit_triangle[(corner + 2) % 3] - centre;
  const double c = twice_cosine(fan);
  const Ring ring = ring_of(topology, corner);
  LayoutPoint last = first, here = second;
  for (std::size_t j = 2; j < ring.after.size(); ++j) {
    const LayoutPoint next = c * here - last;
    last = here, here = next;
    place(ring.after[j], centre + here);
  }
  last = second, here = first;
  for (const std::size_t v : ring.before) {
    const LayoutPoint next = c * here - last;
    last = here, here = next;
    place(v, centre + here);
  }
}

std::vector<LayoutPoint> ngon_layout(const Kind& kind, const Topology& topology, std::size_t centre) {
  std::vector<LayoutPoint> layout(kind.control_count());
  std::copy(unit_triangle.begin(), unit_triangle.end(), layout.begin());
  const CornerFan& fan = kind.corner(centre);
  lay_ring(topology, fan, centre, [&](std::size_t v, LayoutPoint where) { layout[v] = where; });
  const std::size_t one = (centre + 1) % 3, two = (centre + 2) % 3;
  const LayoutPoint origin = unit_triangle[centre];
  const LayoutPoint u1 = unit_triangle[one] - origin, u2 = unit_triangle[two] - origin;
  const double k = outer_spoke(fan.faces());
  const double c = 1 + twice_cosine(fan);
  const Ring around_one = ring_of(topology, one);  // u2, u0, un, a, b, c
  const Ring around_two = ring_of(topology, two);  // u0, u1, c, d, e, u3
  layout[around_one.after[3]] = origin + (k / 2) * (c * u1 - u2);
  layout[around_one.after[4]] = origin + k * u1;
  layout[around_one.after[5]] = origin + (k / 2) * (u1 + u2);
  layout[around_two.after[3]] = origin + k * u2;
  layout[around_two.after[4]] = origin + (k / 2) * (c * u2 - u1);
  return layout;
}

// Moves the points that are not corners as little as makes the limits of the corners the corners.
void pull_limits_to_corners(const Kind& kind, std::vector<LayoutPoint>& layout) {
  const std::size_t count = kind.control_count();
  std::array<std::vector<double>, 3> rows;
  std::array<LayoutPoint, 3> miss;
  for (std::size_t k = 0; k < 3; ++k) {
    rows[k].assign(count, 0.0);
    const Stencils::Row row = kind.corner_limits().row(k);
    miss[k] = unit_triangle[k];
    for (std::size_t i = 0; i < row.sources.size(); ++i) {
      rows[k][row.sources[i]] += row.weights[i];
      miss[k] = miss[k] - row.weights[i] * layout[row.sources[i]];
    }
    for (std::size_t i = 0; i < 3; ++i) rows[k][i] = 0;  // these stay
  }
  // Least squares: rows' multipliers from the 3 x 3 Gram matrix, by Gauss and Jordan. A sharp corner moves
  // nothing.
  std::array<std::array<double, 5>, 3> system{};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t l = 0; l < 3; ++l) {
      for (std::size_t i = 0; i < count; ++i) system[k][l] += rows[k][i] * rows[l][i];
    }
    if (system[k][k] == 0) system[k][k] = 1;
    system[k][3] = miss[k][0];
    system[k][4] = miss[k][1];
  }
  for (std::size_t pivot = 0; pivot < 3; ++pivot) {
    if (!(system[pivot][pivot] > 1e-9)) return;  // dependent: leave the layout as it is
    for (std::size_t k = 0; k < 3; ++k) {
      if (k == pivot) continue;
      const double factor = system[k][pivot] / system[pivot][pivot];
      for (std::size_t l = 0; l < 5; ++l) system[k][l] -= factor * system[pivot][l];
    }
  }
  for (std::size_t i = 3; i < count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double by = rows[k][i] / system[k][k];
      layout[i] = layout[i] + by * LayoutPoint{system[k][3], system[k][4]};
    }
  }
}

std::vector<LayoutPoint> blended_layout(const Kind& kind, const Topology& topology) {
  std::vector<LayoutPoint> layout(kind.control_count(), LayoutPoint{0, 0});
  std::vector<double> places(kind.control_count(), 0.0);
  for (std::size_t corner = 0; corner < 3; ++corner) {
    lay_ring(topology, kind.corner(corner), corner, [&](std::size_t v, LayoutPoint where) {
      layout[v] = layout[v] + where;
      ++places[v];
    });
  }
  for (std::size_t i = 3; i < layout.size(); ++i) layout[i] = (1 / places[i]) * layout[i];
  std::copy(unit_triangle.begin(), unit_triangle.end(), layout.begin());
  pull_limits_to_corners(kind, layout);
  return layout;
}

}  // namespace

std::vector<LayoutPoint> lattice_layout(const Kind& kind) {
  const Topology topology = neighbourhood(kind.key()).topology;
  const std::size_t sides = topology.face(FaceId(0)).size();
  if (sides != 3 && sides != 4) return {};
  std::vector<LayoutPoint> layout(topology.vertex_count(), LayoutPoint{NAN, NAN});
  const std::array<LayoutPoint, 4> own = sides == 3
                                             ? std::array<LayoutPoint, 4>{{{0, 0}, {1, 0}, {0, 1}}}
                                             : std::array<LayoutPoint, 4>{{{0, 0}, {1, 0}, {0, 1}, {-1, 1}}};
  std::vector<bool> placed(topology.face_count());
  std::vector<FaceId> open{FaceId(0)};
  for (std::size_t k = 0; k < sides; ++k) layout[topology.face(FaceId(0))[k].index()] = own[k];
  placed[0] = true;
  bool fits = true;
  const auto place = [&](VertexId v, const LayoutPoint& at) {
    LayoutPoint& here = layout[v.index()];
    if (std::isnan(here[0])) here = at;
    fits = fits && here == at;
  };
  while (!open.empty() && fits) {
    const FaceId face = open.back();
    open.pop_back();
    HalfEdge h = topology.first_of(face);
    for (std::size_t k = 0; k < sides; ++k, h = topology.next(h)) {
      const HalfEdge across = topology.twin(h);
      if (across == no_half_edge || placed[topology.face_of(across).index()]) continue;
      const FaceId beyond = topology.face_of(across);
      if (topology.face(beyond).size() != sides) return {};
      // Beyond an edge from p to q: a triangle turned by half a turn, or a square moved on.
      const auto at = [&](HalfEdge of) { return layout[topology.from(of).index()]; };
      const LayoutPoint p = at(h), q = at(topology.next(h)), r = at(topology.prev(h));
      const HalfEdge next = topology.next(topology.next(across));
      if (sides == 3) {
        place(topology.from(next), {p[0] + q[0] - r[0], p[1] + q[1] - r[1]});
      } else {
        const LayoutPoint s = at(topology.next(topology.next(h)));
        place(topology.from(next), {2 * p[0] - r[0], 2 * p[1] - r[1]});
        place(topology.from(topology.next(next)), {2 * q[0] - s[0], 2 * q[1] - s[1]});
      }
      placed[beyond.index()] = true;
      open.push_back(beyond);
    }
  }
  const auto set = [](const LayoutPoint& at) { return !std::isnan(at[0]); };
  fits = fits && layout.size() == kind.control_count() && std::all_of(layout.begin(), layout.end(), set);
  return fits ? layout : std::vector<LayoutPoint>{};
}

double outer_spoke(std::size_t n) {
  SNUG_EXPECT(n >= 3);
  const double c = middle(cos_of_turn(1, static_cast<unsigned>(n)));  // of the angle between spokes
  return n >= 6 ? (6 - 2 * c) / (2 + c) : (36 - 6 * c) / (16 + c);
}

bool laid_by_rings(const KindKey& key) { return rules_of(key.scheme).laid_by_rings && key.plain(); }

std::optional<std::size_t> lone_centre(const Kind& kind) {
  if (!laid_by_rings(kind.key())) return {};
  std::size_t centre = 0, extraordinary = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!kind.corner(i).closed) return {};
    if (kind.regular_corner(i)) continue;
    centre = i;
    ++extraordinary;
  }
  return extraordinary <= 1 ? std::optional(centre) : std::nullopt;
}

std::vector<LayoutPoint> make_layout(const Kind& kind) {
  if (!laid_by_rings(kind.key())) return fair_layout(kind);
  const Topology topology = neighbourhood(kind.key()).topology;
  const std::optional<std::size_t> centre = lone_centre(kind);
  return centre ? ngon_layout(kind, topology, *centre) : blended_layout(kind, topology);
}

}  // namespace snug
