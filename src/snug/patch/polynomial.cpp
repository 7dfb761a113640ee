#include <snug/patch/polynomial.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include <snug/geometry/rounding.h>
#include <snug/patch/monomials.h>

namespace snug {
namespace {

constexpr std::size_t full_count = 12;  // control points of a full Loop lattice

// 24 times the Bezier points (i, j), j outermost, of a patch whose twelve control points lie as drawn in
// neighbourhood.h. Derived in derivations/loop_bezier.md.
constexpr std::array<std::array<int, full_count>, bezier_count(4)> full_rows{{
    {12, 2, 2, 2, 0, 2, 2, 2, 0, 0, 0, 0},
    {12, 4, 3, 3, 0, 1, 0, 1, 0, 0, 0, 0},
    {8, 8, 4, 4, 0, 0, 0, 0, 0, 0, 0, 0},
    {4, 12, 3, 3, 1, 0, 0, 0, 1, 0, 0, 0},
    {2, 12, 2, 2, 2, 0, 0, 0, 2, 2, 0, 0},
    {12, 3, 4, 1, 0, 3, 1, 0, 0, 0, 0, 0},
    {10, 6, 6, 1, 0, 1, 0, 0, 0, 0, 0, 0},
    {6, 10, 6, 1, 1, 0, 0, 0, 0, 0, 0, 0},
    {3, 12, 4, 1, 3, 0, 0, 0, 0, 1, 0, 0},
    {8, 4, 8, 0, 0, 4, 0, 0, 0, 0, 0, 0},
    {6, 6, 10, 0, 1, 1, 0, 0, 0, 0, 0, 0},
    {4, 8, 8, 0, 4, 0, 0, 0, 0, 0, 0, 0},
    {4, 3, 12, 0, 1, 3, 0, 0, 0, 0, 0, 1},
    {3, 4, 12, 0, 3, 1, 0, 0, 0, 0, 1, 0},
    {2, 2, 12, 0, 2, 2, 0, 0, 0, 0, 2, 2},
}};

// A control point of the full lattice as an integer combination of those that the kind has.
using Combination = std::vector<int>;

Combination unit(std::size_t i, std::size_t count) {
  Combination c(count, 0);
  c[i] = 1;
  return c;
}

// The ghost beyond a boundary edge pq of a triangle with third vertex r: p + q - r.
Combination ghost(std::size_t p, std::size_t q, std::size_t r, std::size_t count) {
  Combination c(count, 0);
  c[p] += 1;
  c[q] += 1;
  c[r] -= 1;
  return c;
}

// The twelve places of the full lattice, ghosts filled in. A regular boundary corner has three faces; its
// ring of six is the four vertices of its fan and two ghosts.
std::array<Combination, full_count> complete(const KindKey& key) {
  const Topology topology = neighbourhood(key).topology;
  const std::size_t count = topology.vertex_count();
  std::array<Combination, full_count> places;
  for (std::size_t i = 0; i < 3; ++i) places[i] = unit(i, count);
  for (std::size_t i = 0; i < 3; ++i) {
    const HalfEdge corner = topology.first_of(FaceId(0)) + static_cast<HalfEdge>(i);
    // Ring counter-clockwise from the clockwise boundary neighbour, or from v_{i+1} in a closed fan.
    HalfEdge start = corner;
    std::size_t before = 0;
    while (!key.corners[i].closed && topology.cw(start) != no_half_edge) {
      start = topology.cw(start);
      ++before;
    }
    std::vector<std::size_t> fan;
    for (HalfEdge h = start;;) {
      fan.push_back(topology.to(h).index());
      const HalfEdge after = topology.ccw(h);
      if (after == start) break;
      if (after == no_half_edge) {
        fan.push_back(topology.from(topology.prev(h)).index());
        break;
      }
      h = after;
    }
    std::array<Combination, 6> ring;
    for (std::size_t k = 0; k < 6; ++k) {
      if (k < fan.size()) ring[k] = unit(fan[k], count);
    }
    if (!key.corners[i].closed) {
      ring[4] = ghost(i, fan[3], fan[2], count);
      ring[5] = ghost(i, fan[0], fan[1], count);
    }
    const auto seen = [&](std::size_t k) { return ring[(k + before) % 6]; };  // counted from v_{i+1}
    places[3 + (i + 2) % 3] = seen(2);
    places[6 + 2 * i] = seen(3);
    places[7 + 2 * i] = seen(4);
    places[3 + i] = seen(5);
  }
  return places;
}

Stencils loop_rows(const KindKey& key) {
  const std::array<Combination, full_count> places = complete(key);
  Stencils out;
  for (const auto& row : full_rows) {
    for (std::size_t c = 0; c < places[0].size(); ++c) {
      int sum = 0;
      for (std::size_t k = 0; k < full_count; ++k) sum += row[k] * places[k][c];
      if (sum == 0) continue;
      const double weight = sum / 24.0;
      out.add(static_cast<std::uint32_t>(c), weight, std::fabs(weight) * unit_roundoff);
    }
    out.end_row();
  }
  return out;
}

// Control points of a B-spline patch of degree d in both directions, place (x, y) at x + (d + 1) y; its corner 0 is at
// (0, 0), its corner 1 at (1, 0) of the parameters.
using Lattice = std::vector<Combination>;

// The corners of a quad, counter-clockwise, lie at (1, 1) to (1, 2) of sixteen places. What is missing beyond a
// boundary mirrors what is inside: 2 p - q.
Lattice bicubic_lattice(const KindKey& key) {
  const Neighbourhood around = neighbourhood(key);
  const Topology& topology = around.topology;
  const std::size_t count = topology.vertex_count();
  Lattice lattice(16);
  const auto at = [&](int x, int y) -> Combination& { return lattice[static_cast<std::size_t>(x + 4 * y)]; };
  constexpr std::array<std::array<int, 2>, 4> corner{{{1, 1}, {2, 1}, {2, 2}, {1, 2}}};
  constexpr std::array<std::array<int, 2>, 4> ahead{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto [x, y] = corner[i];
    const auto [dx, dy] = ahead[i];            // to the next corner
    const auto [ex, ey] = ahead[(i + 1) % 4];  // to the one before
    const auto set = [&](int px, int py, VertexId v) { at(px, py) = unit(v.index(), count); };
    at(x, y) = unit(i, count);
    const auto h = static_cast<HalfEdge>(i);
    const HalfEdge across = topology.twin(h);
    if (across != no_half_edge) {
      set(x - ex, y - ey, topology.to(topology.next(across)));
      const auto [nx, ny] = corner[(i + 1) % 4];
      set(nx - ex, ny - ey, topology.from(topology.prev(across)));
    }
    if (key.corners[i].closed) {
      const HalfEdge beyond = topology.ccw(topology.ccw(h));
      set(x - dx - ex, y - dy - ey, topology.to(topology.next(beyond)));
    }
  }
  const auto mirror = [&](Combination& ghost, const Combination& p, const Combination& q) {
    if (!ghost.empty() || p.empty() || q.empty()) return;
    ghost.resize(count);
    for (std::size_t c = 0; c < count; ++c) ghost[c] = 2 * p[c] - q[c];
  };
  for (int y = 0; y < 4; ++y) {
    mirror(at(0, y), at(1, y), at(2, y));
    mirror(at(3, y), at(2, y), at(1, y));
  }
  for (int x = 0; x < 4; ++x) {
    mirror(at(x, 0), at(x, 1), at(x, 2));
    mirror(at(x, 3), at(x, 2), at(x, 1));
  }
  return lattice;
}

// Nine places; the corners are faces, face 0 at the lower left. Vertices as dual neighbourhoods number them: the middle
// one, the ends of its edges (left, below, right, above), the far ones of the faces.
constexpr std::array<std::size_t, 9> biquadratic_places{5, 2, 6, 1, 0, 3, 8, 4, 7};

Lattice biquadratic_lattice() {
  Lattice lattice;
  for (const std::size_t v : biquadratic_places) lattice.push_back(unit(v, 9));
  return lattice;
}

std::int64_t factorial(std::size_t n) { return n < 2 ? 1 : static_cast<std::int64_t>(n) * factorial(n - 1); }
std::int64_t binomial(std::size_t n, std::size_t k) {
  return factorial(n) / (factorial(k) * factorial(n - k));
}

// Bezier points on the triangle (0,0), (1,0), (1,1) of a tensor product of B-splines of degree d: with x = u + v and
// y = v the product B_i(x) B_j(y) is C(d,i) (u+v)^i w^(d-i) C(d,j) v^j (w+u)^(d-j), of degree 2 d.
// derivations/tensor_bezier.md.
Stencils tensor_rows(std::size_t d, const Lattice& lattice) {
  // Bezier points of a segment from its control points, times `scale`.
  static constexpr int cubic[4][4] = {{1, 4, 1, 0}, {0, 4, 2, 0}, {0, 2, 4, 0}, {0, 1, 4, 1}};
  static constexpr int quadratic[3][3] = {{1, 1, 0}, {0, 2, 0}, {0, 1, 1}};
  const auto segment = [&](std::size_t i, std::size_t k) { return d == 3 ? cubic[i][k] : quadratic[i][k]; };
  const double scale = d == 3 ? 36 : 4;
  const std::size_t controls = lattice[0].size();
  // Coefficients of the monomials w^(2d-i-j) u^i v^j, a control point each.
  std::vector<std::vector<std::int64_t>> sums(bezier_count(2 * d), std::vector<std::int64_t>(controls, 0));
  for (std::size_t i = 0; i <= d; ++i) {
    for (std::size_t j = 0; j <= d; ++j) {
      std::vector<std::int64_t> point(controls, 0);
      for (std::size_t x = 0; x <= d; ++x) {
        for (std::size_t y = 0; y <= d; ++y) {
          const std::int64_t factor = segment(i, x) * segment(j, y);
          for (std::size_t c = 0; c < controls; ++c) point[c] += factor * lattice[x + (d + 1) * y][c];
        }
      }
      for (std::size_t p = 0; p <= i; ++p) {
        for (std::size_t q = 0; q <= d - j; ++q) {
          const std::int64_t factor = binomial(d, i) * binomial(d, j) * binomial(i, p) * binomial(d - j, q);
          auto& sum = sums[bezier_index(2 * d, p + q, i - p + j)];
          for (std::size_t c = 0; c < controls; ++c) sum[c] += factor * point[c];
        }
      }
    }
  }
  Stencils out;
  for (std::size_t j = 0; j <= 2 * d; ++j) {
    for (std::size_t i = 0; i + j <= 2 * d; ++i) {
      const std::size_t place = bezier_index(2 * d, i, j);
      const double divisor = scale * multinomial(2 * d, place);
      const auto& sum = sums[place];
      for (std::size_t c = 0; c < controls; ++c) {
        if (sum[c] == 0) continue;
        const double weight = static_cast<double>(sum[c]) / divisor;
        out.add(static_cast<std::uint32_t>(c), weight, std::fabs(weight) * unit_roundoff);
      }
      out.end_row();
    }
  }
  return out;
}

// Two quadratics, from the values at their corners and the middles of their edges; all weights are multiples of 1/32.
// derivations/midedge_bezier.md.
Stencils midedge_rows() {
  using Row = std::array<double, 9>;
  const auto spoke = [](std::size_t k) { return 1 + k % 4; };
  const auto far = [](std::size_t k) { return 5 + k % 4; };
  const auto face = [&](std::size_t k) {
    Row r{};
    r[0] = r[spoke(k)] = r[spoke(k + 1)] = r[far(k)] = 0.25;
    return r;
  };
  const auto between_faces = [&](std::size_t k) {  // the middle between faces k and k + 1
    Row r{};
    r[0] = r[spoke(k + 1)] = 6.0 / 16;
    r[spoke(k)] = r[spoke(k + 2)] = r[far(k)] = r[far(k + 1)] = 1.0 / 16;
    return r;
  };
  const auto towards_middle = [&](std::size_t k) {  // halfway from face k to the middle of the patch
    Row r{};
    r[0] = 14.0 / 32;
    r[spoke(k)] = r[spoke(k + 1)] = 7.0 / 32;
    r[far(k)] = 2.0 / 32;
    r[spoke(k + 2)] = r[spoke(k + 3)] = 1.0 / 32;
    return r;
  };
  const Row middle{0.5, 0.125, 0.125, 0.125, 0.125, 0, 0, 0, 0};
  const auto inner = [](const Row& half, const Row& a, const Row& b) {  // 2 f(1/2) - (f(0) + f(1)) / 2
    Row r{};
    for (std::size_t c = 0; c < 9; ++c) r[c] = 2 * half[c] - (a[c] + b[c]) / 2;
    return r;
  };
  Stencils out;
  const auto add = [&](const Row& row) {
    for (std::size_t c = 0; c < 9; ++c) {
      if (row[c] != 0) out.add(static_cast<std::uint32_t>(c), row[c]);
    }
    out.end_row();
  };
  const auto spine = [&](std::size_t k) { return inner(towards_middle(k), face(k), middle); };
  const auto side = [&](std::size_t k) { return inner(between_faces(k), face(k), face(k + 1)); };
  for (const Row& row : {face(0), side(0), face(1), spine(0), spine(1), middle}) add(row);
  for (const Row& row : {middle, spine(1), face(1), spine(2), side(1), face(2)}) add(row);
  return out;
}

bool all_regular(const KindKey& key) {
  return std::all_of(key.corners.begin(), key.corners.begin() + (key.scheme == Scheme::loop ? 3 : 4),
                     [&](const CornerFan& fan) { return fan.regular(key.scheme); });
}

PolynomialForm form_of(const KindKey& key, std::size_t degree, std::size_t parts, Stencils rows) {
  const std::size_t count = bezier_count(degree);
  const std::size_t blocks = (neighbourhood(key).topology.vertex_count() + 3) / 4;
  std::vector<double> weights(parts * blocks * count * 4);
  for (std::size_t r = 0; r < parts * count; ++r) {
    const std::size_t part = r / count, place = r % count;
    const Stencils::Row row = rows.row(r);
    for (std::size_t i = 0; i < row.sources.size(); ++i) {
      const std::size_t block = part * blocks + row.sources[i] / 4;
      weights[(block * count + place) * 4 + row.sources[i] % 4] = multinomial(degree, place) * row.weights[i];
    }
  }
  return {degree, parts, std::move(rows), std::move(weights)};
}

}  // namespace

std::optional<PolynomialForm> polynomial_form(const KindKey& key) {
  if (!key.plain() || key.polygon || !all_regular(key)) return {};
  switch (key.scheme) {
    case Scheme::loop:
      return form_of(key, 4, 1, loop_rows(key));
    case Scheme::catmark:
      return form_of(key, 6, 1, tensor_rows(3, bicubic_lattice(key)));
    case Scheme::doo_sabin:
      return form_of(key, 4, 1, tensor_rows(2, biquadratic_lattice()));
    case Scheme::midedge:
      break;
  }
  return form_of(key, 2, 2, midedge_rows());
}

}  // namespace snug
