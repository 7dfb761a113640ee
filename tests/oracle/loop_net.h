#pragma once

#include <oracle/mpfi_interval.h>
#include <oracle/quad.h>
#include <oracle/twin_mesh.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

/// Loop refinement of nets that may be pieces of a larger mesh, over any arithmetic. Internal to the twins.
namespace oracle::detail {

constexpr std::uint32_t kSmallestValence = 3, kLargestValence = 1000;

/// Which rule moves a vertex. `unknown`: faces around it are missing from the net (or it has no rule); it is
/// carried along, but no position derived from its own star may be used.
enum class Kind : std::uint8_t { interior, crease, corner, unknown };

/// Weights of an interior vertex of valence n; `ring` is the weight of each single neighbour.
template <class Real>
struct Weights {
  Real vertex_self, vertex_ring;  // one step: 1 - a, a / n
  Real limit_self, limit_ring;    // limit: w, (1 - w) / n
};

/// Guarantee: Interval contains the exact weights, Quad and double are within 1.01 units of roundoff of them
///            (relative).
/// Source:    [Loop87] a = 5/8 - (3 + 2 cos(2 pi/n))^2 / 64, w = 1 / (1 + 8 a / 3).
template <class Real>
[[nodiscard]] Weights<Real> loop_weights(std::uint32_t valence);
template <>
Weights<Interval> loop_weights(std::uint32_t valence);
template <>
Weights<Quad> loop_weights(std::uint32_t valence);
template <>
Weights<double> loop_weights(std::uint32_t valence);

/// Weights by valence, each made once.
template <class Real>
class WeightTable {
 public:
  const Weights<Real>& operator[](std::uint32_t valence) {
    if (valence >= made_.size()) made_.resize(valence + 1);
    if (!made_[valence]) made_[valence] = loop_weights<Real>(valence);
    return *made_[valence];
  }

 private:
  std::vector<std::optional<Weights<Real>>> made_;
};

template <class Real>
struct Net {
  std::vector<std::array<Real, 3>> points;
  std::vector<Kind> kinds;
  std::vector<Triangle> triangles;
};

///         wing[0]
///          /   \                .
///         a --- b     `faces` of the two triangles are there
///          \   /
///         wing[1]
struct Edge {
  std::uint32_t a, b;
  std::array<std::uint32_t, 2> wing;
  std::uint32_t faces;
};

struct Edges {
  std::vector<Edge> edges;
  std::vector<Triangle> sides;  // sides[t][k]: the edge of triangle t from its corner k to its corner k + 1
};

/// Throws std::invalid_argument if an edge has more than two faces.
[[nodiscard]] Edges find_edges(const std::vector<Triangle>& triangles);

/// Rule of a vertex from the edges opposite to it in all its faces.
/// Throws std::invalid_argument if they are not one path or one cycle, or the valence is out of range.
[[nodiscard]] Kind classify(const std::vector<std::pair<std::uint32_t, std::uint32_t>>& opposite,
                            Boundary boundary);

/// Throws std::invalid_argument unless all faces have three different corners in range with finite
/// coordinates.
void check_faces(const TwinMesh& mesh);

/// Coordinates as they are, rules of all vertices that have faces.
template <class Real>
[[nodiscard]] Net<Real> whole_net(const TwinMesh& mesh);

/// The faces of `mesh` that touch `face`, in the layout of neighbourhood().
template <class Real>
[[nodiscard]] Net<Real> face_net(const TwinMesh& mesh, std::uint32_t face);

/// The children of (c0, c1, c2), at 4 t to 4 t + 3, are
///   (c0, e01, e20), (e01, c1, e12), (e20, e12, c2), (e12, e20, e01).
/// `corners` are three values to be halved along the edges, such as parameters.
template <class Value, class Halve>
[[nodiscard]] std::array<Value, 3> child_corners(const std::array<Value, 3>& corners, std::size_t child,
                                                 Halve halve) {
  const Value e01 = halve(corners[0], corners[1]), e12 = halve(corners[1], corners[2]),
              e20 = halve(corners[2], corners[0]);
  if (child == 0) return {corners[0], e01, e20};
  if (child == 1) return {e01, corners[1], e12};
  if (child == 2) return {e20, e12, corners[2]};
  return {e12, e20, e01};
}

/// Sums over the neighbours of each vertex, all and along the boundary.
template <class Real>
struct Rings {
  std::vector<std::array<Real, 3>> all, border;
  std::vector<std::uint32_t> valence;

  Rings(const Net<Real>& net, const Edges& topology)
      : all(net.points.size()), border(net.points.size()), valence(net.points.size(), 0) {
    for (const Edge& edge : topology.edges) {
      ++valence[edge.a];
      ++valence[edge.b];
      for (std::size_t x = 0; x < 3; ++x) {
        all[edge.a][x] += net.points[edge.b][x];
        all[edge.b][x] += net.points[edge.a][x];
        if (edge.faces == 1) {
          border[edge.a][x] += net.points[edge.b][x];
          border[edge.b][x] += net.points[edge.a][x];
        }
      }
    }
  }
};

/// One step of Loop subdivision. Old vertices keep their indices, edge points follow; triangles as
/// child_corners() says.
///
/// Guarantee: right at every vertex whose kind is not unknown, its neighbours included, provided the
///            positions around the parent are right; an edge with one face counts as boundary if the star of
///            one of its ends is complete.
template <class Real>
[[nodiscard]] Net<Real> refine(const Net<Real>& net, WeightTable<Real>& weights) {
  const Edges topology = find_edges(net.triangles);
  const Rings<Real> rings(net, topology);
  const std::uint32_t count = static_cast<std::uint32_t>(net.points.size());
  Net<Real> fine;
  fine.points = net.points;
  fine.points.resize(count + topology.edges.size());
  fine.kinds = net.kinds;
  fine.kinds.resize(fine.points.size(), Kind::unknown);
  for (std::uint32_t v = 0; v < count; ++v) {
    if (net.kinds[v] == Kind::interior) {
      const Weights<Real>& w = weights[rings.valence[v]];
      for (std::size_t x = 0; x < 3; ++x)
        fine.points[v][x] = w.vertex_self * net.points[v][x] + w.vertex_ring * rings.all[v][x];
    } else if (net.kinds[v] == Kind::crease) {
      for (std::size_t x = 0; x < 3; ++x)
        fine.points[v][x] = Real(0.75) * net.points[v][x] + Real(0.125) * rings.border[v][x];
    }
  }
  for (std::uint32_t e = 0; e < topology.edges.size(); ++e) {
    const Edge& edge = topology.edges[e];
    const auto &a = net.points[edge.a], &b = net.points[edge.b];
    auto& point = fine.points[count + e];
    if (edge.faces == 2) {
      const auto &c = net.points[edge.wing[0]], &d = net.points[edge.wing[1]];
      for (std::size_t x = 0; x < 3; ++x)
        point[x] = Real(0.375) * (a[x] + b[x]) + Real(0.125) * (c[x] + d[x]);
      fine.kinds[count + e] = Kind::interior;
    } else if (net.kinds[edge.a] != Kind::unknown || net.kinds[edge.b] != Kind::unknown) {
      for (std::size_t x = 0; x < 3; ++x) point[x] = Real(0.5) * (a[x] + b[x]);
      fine.kinds[count + e] = Kind::crease;
    }
  }
  fine.triangles.reserve(4 * net.triangles.size());
  for (std::size_t t = 0; t < net.triangles.size(); ++t) {
    const Triangle& c = net.triangles[t];
    const Triangle& side = topology.sides[t];
    const std::uint32_t e01 = count + side[0], e12 = count + side[1], e20 = count + side[2];
    fine.triangles.insert(fine.triangles.end(),
                          {Triangle{c[0], e01, e20}, {e01, c[1], e12}, {e20, e12, c[2]}, {e12, e20, e01}});
  }
  return fine;
}

/// Limit positions of all vertices whose kind is not unknown; the others keep their position.
/// Source:    interior w v + (1 - w) mean(ring), crease (4 v + ends) / 6, corner v.
template <class Real>
[[nodiscard]] std::vector<std::array<Real, 3>> limit_points(const Net<Real>& net,
                                                            WeightTable<Real>& weights) {
  const Rings<Real> rings(net, find_edges(net.triangles));
  auto limit = net.points;
  for (std::size_t v = 0; v < limit.size(); ++v) {
    if (net.kinds[v] == Kind::interior) {
      const Weights<Real>& w = weights[rings.valence[v]];
      for (std::size_t x = 0; x < 3; ++x)
        limit[v][x] = w.limit_self * net.points[v][x] + w.limit_ring * rings.all[v][x];
    } else if (net.kinds[v] == Kind::crease) {
      for (std::size_t x = 0; x < 3; ++x)
        limit[v][x] = (Real(4.0) * net.points[v][x] + rings.border[v][x]) / Real(6.0);
    }
  }
  return limit;
}

/// The faces that touch `triangle`: it comes first, its corners are the points 0, 1, 2, and only they keep
/// their kind.
///
/// Guarantee: refine() of the result is right at the four children of `triangle` and all that touches them.
template <class Real>
[[nodiscard]] Net<Real> neighbourhood(const Net<Real>& net, std::size_t triangle) {
  const Triangle corners = net.triangles[triangle];
  Net<Real> piece;
  std::vector<std::uint32_t> renumbered(net.points.size(), UINT32_MAX);
  const auto number = [&](std::uint32_t v) {
    if (renumbered[v] == UINT32_MAX) {
      renumbered[v] = static_cast<std::uint32_t>(piece.points.size());
      piece.points.push_back(net.points[v]);
    }
    return renumbered[v];
  };
  const auto take = [&](const Triangle& t) {
    const std::uint32_t a = number(t[0]), b = number(t[1]), c = number(t[2]);
    piece.triangles.push_back({a, b, c});
  };
  take(corners);
  const auto is_corner = [&](std::uint32_t v) {
    return v == corners[0] || v == corners[1] || v == corners[2];
  };
  for (std::size_t t = 0; t < net.triangles.size(); ++t) {
    const Triangle& other = net.triangles[t];
    if (t != triangle && (is_corner(other[0]) || is_corner(other[1]) || is_corner(other[2]))) take(other);
  }
  piece.kinds.assign(piece.points.size(), Kind::unknown);
  for (std::size_t k = 0; k < 3; ++k) piece.kinds[k] = net.kinds[corners[k]];
  return piece;
}

/// Does the face have a surface? False only for Boundary::none and a boundary vertex.
template <class Real>
[[nodiscard]] bool has_surface(const Net<Real>& net, std::size_t triangle) {
  for (const std::uint32_t v : net.triangles[triangle])
    if (net.kinds[v] == Kind::unknown) return false;
  return true;
}

}  // namespace oracle::detail
