#include <oracle/polygon_net.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace oracle::detail {

namespace {

using Id = std::uint32_t;
constexpr Id kNone = UINT32_MAX;

void require(bool condition, const char* what) {
  if (!condition) throw std::invalid_argument(std::string("oracle: ") + what);
}

void check(const TaggedMesh& mesh, const Rules& rules) {
  const std::size_t count = mesh.points.size();
  for (const Point& p : mesh.points)
    for (const double x : p) require(std::isfinite(x), "a coordinate is not finite");
  for (const auto& polygon : mesh.polygons) {
    require(polygon.size() >= 2, "a face has less than two corners");
    require(polygon.size() == 3 || rules.scheme != PrimalScheme::loop, "Loop needs triangles");
    for (const Id v : polygon) require(v < count, "a corner is out of range");
  }
  for (const auto& c : mesh.creases)
    require(c.a < count && c.b < count && !std::isnan(c.sharpness), "a crease is wrong");
  for (const auto& c : mesh.corners) require(c.vertex < count && !std::isnan(c.sharpness), "a tag is wrong");
  for (const Id f : mesh.holes) require(f < mesh.polygons.size(), "a hole is out of range");
}

double tagged(double sharpness) { return std::clamp(sharpness, 0.0, kInfinitelySharp); }

/// Connects the faces; says which edges are non-manifold.
class Builder {
 public:
  PolygonNet net;
  std::vector<char> odd;  // non-manifold edges

  explicit Builder(const TaggedMesh& mesh) : at_vertex_(mesh.points.size()) {
    for (const Point& p : mesh.points) net.points.push_back({Quad(p[0]), Quad(p[1]), Quad(p[2])});
    net.sharpness.assign(mesh.points.size(), Quad(0));
    for (const auto& polygon : mesh.polygons) {
      PolygonNet::Face face{polygon, {}};
      for (std::size_t k = 0; k < polygon.size(); ++k)
        face.edges.push_back(side(polygon[k], polygon[(k + 1) % polygon.size()]));
      net.faces.push_back(std::move(face));
    }
  }

  [[nodiscard]] Id find(Id a, Id b) const {
    for (const Id e : at_vertex_[a])
      if ((net.edges[e].a == a && net.edges[e].b == b) || (net.edges[e].a == b && net.edges[e].b == a))
        return e;
    return kNone;
  }

 private:
  Id side(Id a, Id b) {
    const Id face = static_cast<Id>(net.faces.size());
    Id e = a == b ? kNone : find(a, b);
    bool twice = a == b;
    if (e != kNone) {
      if (last_face_[e] == face) {
        odd[e] = 1;
        twice = true;
        e = kNone;
      } else if (uses_[e] > 1 || net.edges[e].a == a) {
        odd[e] = 1;
      }
    }
    if (e == kNone) {
      e = static_cast<Id>(net.edges.size());
      net.edges.push_back({a, b, Quad(0)});
      odd.push_back(twice ? 1 : 0);
      uses_.push_back(0);
      last_face_.push_back(kNone);
      at_vertex_[a].push_back(e);
      if (a != b) at_vertex_[b].push_back(e);
    }
    ++uses_[e];
    last_face_[e] = face;
    return e;
  }

  std::vector<std::vector<Id>> at_vertex_;
  std::vector<std::size_t> uses_;
  std::vector<Id> last_face_;
};

/// Are the corners at `v` one closed or open fan, joined by edges that are all manifold?
bool one_fan(const PolygonNet& net, const Neighbours& near, Id v) {
  struct Corner {
    Id in, out;  // edges
  };
  std::vector<Corner> corners;
  std::vector<Id> faces = near.vertex_faces[v];
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  for (const Id f : faces) {
    const auto& face = net.faces[f];
    const std::size_t n = face.vertices.size();
    for (std::size_t k = 0; k < n; ++k)
      if (face.vertices[k] == v) corners.push_back({face.edges[(k + n - 1) % n], face.edges[k]});
  }
  if (corners.empty()) return false;
  std::vector<char> reached(corners.size(), 0);
  std::vector<std::size_t> todo{0};
  reached[0] = 1;
  std::size_t count = 0;
  while (!todo.empty()) {
    const Corner c = corners[todo.back()];
    todo.pop_back();
    ++count;
    for (std::size_t i = 0; i < corners.size(); ++i)
      if (!reached[i] && (corners[i].in == c.out || corners[i].out == c.in)) {
        reached[i] = 1;
        todo.push_back(i);
      }
  }
  return count == corners.size();
}

}  // namespace

Neighbours::Neighbours(std::size_t vertex_count, const std::vector<NetEdge>& edges,
                       const std::vector<NetFace>& faces)
    : vertex_edges(vertex_count), vertex_faces(vertex_count), edge_faces(edges.size()) {
  for (Id e = 0; e < edges.size(); ++e) {
    vertex_edges[edges[e].a].push_back(e);
    vertex_edges[edges[e].b].push_back(e);
  }
  for (Id f = 0; f < faces.size(); ++f) {
    for (const Id v : faces[f].vertices) vertex_faces[v].push_back(f);
    for (const Id e : faces[f].edges) edge_faces[e].push_back(f);
  }
}

ControlNet control_net(const TaggedMesh& mesh, const Rules& rules) {
  check(mesh, rules);
  Builder built(mesh);
  PolygonNet& net = built.net;
  for (const auto& c : mesh.creases) {
    const Id e = built.find(c.a, c.b);
    if (e != kNone) net.edges[e].sharpness = tagged(c.sharpness);
  }
  for (const auto& c : mesh.corners) net.sharpness[c.vertex] = tagged(c.sharpness);

  const Neighbours near(net);
  std::vector<char> has_surface(net.faces.size(), 1);
  for (const Id f : mesh.holes) has_surface[f] = 0;
  if (rules.boundary == Boundary::none)
    for (Id e = 0; e < net.edges.size(); ++e)
      if (near.edge_faces[e].size() == 1 && net.edges[e].sharpness < kInfinitelySharp)
        for (const Id v : {net.edges[e].a, net.edges[e].b})
          for (const Id f : near.vertex_faces[v]) has_surface[f] = 0;

  for (Id e = 0; e < net.edges.size(); ++e)
    if (near.edge_faces[e].size() < 2 || built.odd[e]) net.edges[e].sharpness = kInfinitelySharp;
  for (Id v = 0; v < net.points.size(); ++v) {
    const auto& edges = near.vertex_edges[v];
    const std::size_t faces = near.vertex_faces[v].size();
    if (faces == 1 && edges.size() == 2 && rules.boundary == Boundary::edge_and_corner) {
      net.sharpness[v] = kInfinitelySharp;
      continue;
    }
    std::size_t odd = 0, border = 0;
    for (const Id e : edges) {
      odd += built.odd[e] ? 1 : 0;
      border += near.edge_faces[e].size() == 1 ? 1 : 0;
    }
    if (odd == 0 && one_fan(net, near, v)) continue;
    if (odd != 2 || border != 0 || faces <= edges.size()) net.sharpness[v] = kInfinitelySharp;
  }
  return {std::move(net), std::move(has_surface)};
}

}  // namespace oracle::detail
