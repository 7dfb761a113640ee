#include <oracle/loop_net.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace oracle::detail {

namespace {

[[noreturn]] void refuse(const char* what) { throw std::invalid_argument(std::string("oracle: ") + what); }

struct ExactWeights {
  mpfi_t part[4];  // as in Weights, with 256 bits
  explicit ExactWeights(std::uint32_t n) {
    for (auto& p : part) mpfi_init2(p, 256);
    auto &self = part[0], &ring = part[1], &limit_self = part[2], &limit_ring = part[3];
    mpfi_const_pi(ring);  // ring = 2 pi / n
    mpfi_mul_ui(ring, ring, 2);
    mpfi_div_ui(ring, ring, n);
    mpfi_cos(ring, ring);  // (3 + 2 cos)^2 / 64
    mpfi_mul_ui(ring, ring, 2);
    mpfi_add_ui(ring, ring, 3);
    mpfi_sqr(ring, ring);
    mpfi_div_ui(ring, ring, 64);
    mpfi_set_d(self, 0.625);  // a
    mpfi_sub(ring, self, ring);
    mpfi_ui_sub(self, 1, ring);  // 1 - a
    mpfi_mul_ui(limit_self, ring, 8);
    mpfi_div_ui(limit_self, limit_self, 3);
    mpfi_add_ui(limit_self, limit_self, 1);
    mpfi_ui_div(limit_self, 1, limit_self);  // w
    mpfi_ui_sub(limit_ring, 1, limit_self);
    mpfi_div_ui(limit_ring, limit_ring, n);  // (1 - w) / n
    mpfi_div_ui(ring, ring, n);              // a / n
  }
  ~ExactWeights() {
    for (auto& p : part) mpfi_clear(p);
  }
  ExactWeights(const ExactWeights&) = delete;
  ExactWeights& operator=(const ExactWeights&) = delete;
};

/// Three doubles hold 159 bits; their sum is rounded to Quad once.
Quad nearest_quad(mpfi_srcptr interval) {
  mpfr_t rest;
  mpfr_init2(rest, 256);
  mpfi_mid(rest, interval);
  double part[3];
  for (double& p : part) {
    p = mpfr_get_d(rest, MPFR_RNDN);
    mpfr_sub_d(rest, rest, p, MPFR_RNDN);
  }
  mpfr_clear(rest);
  return static_cast<Quad>(part[0]) + (static_cast<Quad>(part[1]) + static_cast<Quad>(part[2]));
}

Interval outer_interval(mpfi_srcptr exact) {
  Interval result;
  mpfi_set(result.get(), exact);
  return result;
}

}  // namespace

template <>
Weights<Interval> loop_weights(std::uint32_t valence) {
  const ExactWeights exact(valence);
  return {outer_interval(exact.part[0]), outer_interval(exact.part[1]), outer_interval(exact.part[2]),
          outer_interval(exact.part[3])};
}

template <>
Weights<Quad> loop_weights(std::uint32_t valence) {
  const ExactWeights exact(valence);
  return {nearest_quad(exact.part[0]), nearest_quad(exact.part[1]), nearest_quad(exact.part[2]),
          nearest_quad(exact.part[3])};
}

template <>
Weights<double> loop_weights(std::uint32_t valence) {
  const Weights<Quad> w = loop_weights<Quad>(valence);
  return {static_cast<double>(w.vertex_self), static_cast<double>(w.vertex_ring),
          static_cast<double>(w.limit_self), static_cast<double>(w.limit_ring)};
}

Edges find_edges(const std::vector<Triangle>& triangles) {
  struct Half {
    std::uint32_t a, b;  // a < b
    std::uint32_t triangle, side;
    bool operator<(const Half& o) const {
      return a != o.a                 ? a < o.a
             : b != o.b               ? b < o.b
             : triangle != o.triangle ? triangle < o.triangle
                                      : side < o.side;
    }
  };
  std::vector<Half> halves;
  halves.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(triangles[t][k], triangles[t][(k + 1) % 3]);
      halves.push_back({a, b, t, k});
    }
  std::sort(halves.begin(), halves.end());
  Edges result;
  result.sides.resize(triangles.size());
  for (const Half& half : halves) {
    const std::uint32_t wing = triangles[half.triangle][(half.side + 2) % 3];
    if (result.edges.empty() || result.edges.back().a != half.a || result.edges.back().b != half.b) {
      result.edges.push_back({half.a, half.b, {wing, wing}, 1});
    } else {
      Edge& edge = result.edges.back();
      if (edge.faces == 2) refuse("an edge has more than two faces");
      edge.wing[1] = wing;
      edge.faces = 2;
    }
    result.sides[half.triangle][half.side] = static_cast<std::uint32_t>(result.edges.size() - 1);
  }
  return result;
}

Kind classify(const std::vector<std::pair<std::uint32_t, std::uint32_t>>& opposite, Boundary boundary) {
  // Each neighbour with the opposite edges that end there.
  std::vector<std::pair<std::uint32_t, std::size_t>> ends;
  for (std::size_t i = 0; i < opposite.size(); ++i) {
    ends.emplace_back(opposite[i].first, i);
    ends.emplace_back(opposite[i].second, i);
  }
  std::sort(ends.begin(), ends.end());
  std::size_t loose = 0, start = 0;
  for (std::size_t i = 0; i < ends.size();) {
    std::size_t j = i;
    while (j < ends.size() && ends[j].first == ends[i].first) ++j;
    if (j - i > 2) refuse("an edge has more than two faces");
    if (j - i == 1) {
      ++loose;
      start = i;
    }
    i = j;
  }
  // Walk from a loose end if there is one: a single fan is walked completely.
  std::size_t walked = 0, at = ends[start].second;
  std::uint32_t from = ends[start].first;
  while (walked < opposite.size()) {
    ++walked;
    const std::uint32_t to = opposite[at].first == from ? opposite[at].second : opposite[at].first;
    const auto range =
        std::equal_range(ends.begin(), ends.end(), std::pair<std::uint32_t, std::size_t>(to, 0),
                         [](const auto& x, const auto& y) { return x.first < y.first; });
    auto next = range.first;
    if (next != range.second && next->second == at) ++next;
    if (next == range.second || next->second == ends[start].second) break;
    at = next->second;
    from = to;
  }
  if (walked != opposite.size() || (loose != 0 && loose != 2))
    refuse("the faces at a vertex are not a single fan");
  if (loose == 0) {
    if (opposite.size() < kSmallestValence || opposite.size() > kLargestValence)
      refuse("interior valence outside 3 to 1000");
    return Kind::interior;
  }
  if (boundary == Boundary::none) return Kind::unknown;
  return boundary == Boundary::edge_and_corner && opposite.size() == 1 ? Kind::corner : Kind::crease;
}

void check_faces(const TwinMesh& mesh) {
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      if (v >= mesh.points.size()) refuse("a face names a point that is not there");
      for (const double x : mesh.points[v])
        if (!std::isfinite(x)) refuse("a coordinate is not finite");
    }
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) refuse("a face repeats a corner");
  }
}

namespace {

template <class Real>
std::array<Real, 3> widened(const Point& p) {
  return {Real(p[0]), Real(p[1]), Real(p[2])};
}

}  // namespace

template <class Real>
Net<Real> whole_net(const TwinMesh& mesh) {
  check_faces(mesh);
  Net<Real> net;
  for (const Point& p : mesh.points) net.points.push_back(widened<Real>(p));
  std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> opposite(mesh.points.size());
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) opposite[t[k]].emplace_back(t[(k + 1) % 3], t[(k + 2) % 3]);
  net.kinds.assign(mesh.points.size(), Kind::unknown);
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    if (!opposite[v].empty()) net.kinds[v] = classify(opposite[v], mesh.boundary);
  net.triangles = mesh.triangles;
  return net;
}

template <class Real>
Net<Real> face_net(const TwinMesh& mesh, std::uint32_t face) {
  if (face >= mesh.triangles.size()) refuse("no such face");
  const Triangle corners = mesh.triangles[face];
  TwinMesh near;
  near.boundary = mesh.boundary;
  near.triangles.push_back(corners);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& other = mesh.triangles[t];
    bool touches = false;
    for (const std::uint32_t v : other) touches |= v == corners[0] || v == corners[1] || v == corners[2];
    if (touches && t != face) near.triangles.push_back(other);
  }
  std::vector<std::uint32_t> used;
  for (const Triangle& t : near.triangles)
    for (const std::uint32_t v : t) {
      if (v >= mesh.points.size()) refuse("a face names a point that is not there");
      used.push_back(v);
    }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  for (const std::uint32_t v : used) near.points.push_back(mesh.points[v]);
  for (Triangle& t : near.triangles)
    for (std::uint32_t& v : t)
      v = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), v) - used.begin());
  check_faces(near);
  Net<Real> net;
  for (const Point& p : near.points) net.points.push_back(widened<Real>(p));
  net.triangles = near.triangles;
  net.kinds.assign(near.points.size(), Kind::unknown);
  for (const std::uint32_t v : near.triangles[0]) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> opposite;
    for (const Triangle& t : near.triangles)
      for (std::size_t k = 0; k < 3; ++k)
        if (t[k] == v) opposite.emplace_back(t[(k + 1) % 3], t[(k + 2) % 3]);
    net.kinds[v] = classify(opposite, mesh.boundary);
  }
  return neighbourhood(net, 0);
}

template Net<Interval> whole_net(const TwinMesh& mesh);
template Net<Quad> whole_net(const TwinMesh& mesh);
template Net<double> whole_net(const TwinMesh& mesh);
template Net<Interval> face_net(const TwinMesh& mesh, std::uint32_t face);
template Net<Quad> face_net(const TwinMesh& mesh, std::uint32_t face);

}  // namespace oracle::detail
