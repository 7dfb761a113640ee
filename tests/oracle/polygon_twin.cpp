#include <oracle/polygon_net.h>
#include <oracle/polygon_twin.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <tuple>

namespace oracle {

namespace {

using detail::PolygonNet;
using detail::QuadPoint;

void require(bool condition) {
  if (!condition) throw std::invalid_argument("oracle: an argument is out of range");
}

using Parameter = std::array<std::uint32_t, 2>;  // in units of 2^-16
constexpr std::uint32_t kOne = 1U << 16U;

Parameter halfway(const Parameter& a, const Parameter& b) { return {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2}; }

/// Where a face of the refined net lies; no corners for a control face that is neither triangle nor quad.
struct Place {
  std::uint32_t face, part;
  std::vector<Parameter> corners;
};

std::vector<Place> control_places(const TaggedMesh& mesh, const Rules& rules) {
  std::vector<Place> places;
  for (std::uint32_t f = 0; f < mesh.polygons.size(); ++f) {
    Place place{f, 0, {}};
    if (rules.scheme == PrimalScheme::loop)
      place.corners = {{0, 0}, {kOne, 0}, {0, kOne}};
    else if (mesh.polygons[f].size() == 4)
      place.corners = {{0, 0}, {kOne, 0}, {kOne, kOne}, {0, kOne}};
    places.push_back(std::move(place));
  }
  return places;
}

/// In the order of refine()'s faces.
std::vector<Place> child_places(const std::vector<Place>& places, const TaggedMesh& mesh) {
  std::vector<Place> fine;
  for (const Place& place : places) {
    const auto& c = place.corners;
    if (c.empty()) {
      for (std::uint32_t k = 0; k < mesh.polygons[place.face].size(); ++k)
        fine.push_back({place.face, k, {{0, 0}, {kOne, 0}, {kOne, kOne}, {0, kOne}}});
    } else if (c.size() == 3) {
      for (std::size_t k = 0; k < 4; ++k) {
        const auto child = detail::child_corners(std::array{c[0], c[1], c[2]}, k, halfway);
        fine.push_back({place.face, 0, {child.begin(), child.end()}});
      }
    } else {
      const Parameter centre = halfway(c[0], c[2]);
      for (std::size_t k = 0; k < 4; ++k) {
        Place child{place.face, place.part, c};
        child.corners[(k + 1) % 4] = halfway(c[k], c[(k + 1) % 4]);
        child.corners[(k + 2) % 4] = centre;
        child.corners[(k + 3) % 4] = halfway(c[k], c[(k + 3) % 4]);
        fine.push_back(std::move(child));
      }
    }
  }
  return fine;
}

Quad largest_coordinate(const PolygonNet& net) {
  Quad most = 0;
  for (const QuadPoint& p : net.points)
    for (const Quad& x : p) most = std::max(most, x < 0 ? -x : x);
  return most;
}

std::size_t largest_star(const PolygonNet& net) {
  const detail::Neighbours near(net);
  std::size_t most = 4;
  for (const auto& edges : near.vertex_edges) most = std::max(most, edges.size());
  for (const auto& faces : near.vertex_faces) most = std::max(most, faces.size());
  for (const auto& face : net.faces) most = std::max(most, face.vertices.size());
  return most;
}

/// `off` bounds how far `exact` may be from the truth already.
void round(const QuadPoint& exact, const Quad& off, FaceSample& sample) {
  Quad worst = 0;
  for (std::size_t x = 0; x < 3; ++x) {
    sample.position[x] = static_cast<double>(exact[x]);
    const Quad rest = exact[x] - static_cast<Quad>(sample.position[x]);
    worst = std::max(worst, rest < 0 ? -rest : rest);
  }
  sample.error = std::nextafter(static_cast<double>(worst + off), std::numeric_limits<double>::infinity());
}

}  // namespace

std::vector<FaceSample> sample_faces(const TaggedMesh& mesh, const Rules& rules, int levels) {
  require(levels >= 0 && levels <= 10);
  auto [net, has_surface] = detail::control_net(mesh, rules);
  std::vector<Place> places = control_places(mesh, rules);
  const Quad star = static_cast<Quad>(largest_star(net));
  Quad largest = largest_coordinate(net);
  for (int level = 0; level < levels; ++level) {
    net = detail::refine(net, rules);
    places = child_places(places, mesh);
    largest = std::max(largest, largest_coordinate(net));
  }
  std::vector<char> wanted(net.points.size(), 0);
  for (std::size_t f = 0; f < places.size(); ++f)
    if (has_surface[places[f].face])
      for (const std::uint32_t v : net.faces[f].vertices) wanted[v] = 1;
  const detail::Limits limits = detail::limit_points(net, rules, wanted);

  // A vertex without a formula may take some thousand steps more.
  const Quad step = 2 * (star + 12) * largest * static_cast<Quad>(0x1p-112);
  std::vector<FaceSample> samples;
  std::set<std::tuple<std::uint32_t, std::uint32_t, Parameter>> seen;
  for (std::size_t f = 0; f < places.size(); ++f) {
    const Place& place = places[f];
    if (!has_surface[place.face]) continue;
    const auto& corners = net.faces[f].vertices;
    for (std::uint32_t k = 0; k < corners.size(); ++k) {
      const bool whole = place.corners.empty();
      const Parameter at = whole ? Parameter{0, 0} : place.corners[k];
      const std::uint32_t part = whole ? k : place.part;
      if (!seen.insert({place.face, part, at}).second) continue;
      FaceSample sample{place.face, part, at[0] / double{kOne}, at[1] / double{kOne}, {}, 0};
      const Quad steps = limits.error[corners[k]] > 0 ? Quad(100000) : Quad(levels + 12);
      round(limits.points[corners[k]], steps * step + limits.error[corners[k]], sample);
      samples.push_back(sample);
    }
  }
  return samples;
}

TaggedMesh refine(const TaggedMesh& mesh, const Rules& rules, int levels) {
  require(levels >= 0 && levels <= 10);
  auto [net, has_surface] = detail::control_net(mesh, rules);
  std::vector<Place> places = control_places(mesh, rules);
  for (int level = 0; level < levels; ++level) {
    net = detail::refine(net, rules);
    places = child_places(places, mesh);
  }
  TaggedMesh fine;
  for (const QuadPoint& p : net.points)
    fine.points.push_back({static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
  for (const auto& face : net.faces) fine.polygons.push_back(face.vertices);
  for (const auto& edge : net.edges)
    if (edge.sharpness > 0) fine.creases.push_back({edge.a, edge.b, static_cast<double>(edge.sharpness)});
  for (std::uint32_t v = 0; v < net.points.size(); ++v)
    if (net.sharpness[v] > 0) fine.corners.push_back({v, static_cast<double>(net.sharpness[v])});
  for (std::uint32_t f = 0; f < places.size(); ++f)
    if (!has_surface[places[f].face]) fine.holes.push_back(f);
  return fine;
}

}  // namespace oracle
