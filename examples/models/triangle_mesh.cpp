#include "triangle_mesh.h"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace models {

namespace {

Vec3 area_normal(const TriangleMesh& mesh, const Triangle& face) {
  const Vec3& a = mesh.points[face[0]];
  return cross(mesh.points[face[1]] - a, mesh.points[face[2]] - a);
}

/// Face that holds the directed edge (a, b), rotated so that it reads (a, b, c); the face count if there is none.
std::size_t rotate_to(TriangleMesh& mesh, Index a, Index b) {
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    Triangle& face = mesh.faces[f];
    for (std::size_t k = 0; k < 3; ++k) {
      if (face[k] == a && face[(k + 1) % 3] == b) {
        std::rotate(face.begin(), face.begin() + static_cast<std::ptrdiff_t>(k), face.end());
        return f;
      }
    }
  }
  return mesh.faces.size();
}

std::string decimal(double value) {
  long long scaled = std::llround(value * 10000);
  std::string text = scaled < 0 ? "-" : "";
  scaled = scaled < 0 ? -scaled : scaled;
  text += std::to_string(scaled / 10000);
  std::string fraction = std::to_string(10000 + scaled % 10000).substr(1);
  while (!fraction.empty() && fraction.back() == '0') fraction.pop_back();
  return fraction.empty() ? text : text + "." + fraction;
}

void check(bool good, const std::string& name, const char* what) {
  if (!good) throw std::runtime_error(name + ": " + what);
}

}  // namespace

std::vector<std::vector<Index>> neighbours(const TriangleMesh& mesh) {
  std::vector<std::vector<Index>> rings(mesh.points.size());
  for (const Triangle& face : mesh.faces) {
    for (std::size_t k = 0; k < 3; ++k) {
      rings[face[k]].push_back(face[(k + 1) % 3]);
      rings[face[k]].push_back(face[(k + 2) % 3]);
    }
  }
  for (std::vector<Index>& ring : rings) {
    std::sort(ring.begin(), ring.end());
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  }
  return rings;
}

std::vector<Triangle> triangulate(std::span<const Vec3> points, std::span<const Quad> quads) {
  std::vector<Triangle> faces;
  bool alternate = false;
  for (const Quad& q : quads) {
    const double first = length(points[q[0]] - points[q[2]]);
    const double second = length(points[q[1]] - points[q[3]]);
    bool use_first = first < second;
    if (first < 1.1 * second && second < 1.1 * first) {
      use_first = alternate;
      alternate = !alternate;
    }
    if (use_first) {
      faces.push_back({q[0], q[1], q[2]});
      faces.push_back({q[0], q[2], q[3]});
    } else {
      faces.push_back({q[0], q[1], q[3]});
      faces.push_back({q[1], q[2], q[3]});
    }
  }
  return faces;
}

TriangleMesh mirrored(const TriangleMesh& half) {
  TriangleMesh whole = half;
  std::vector<Index> image(half.points.size());
  for (std::size_t v = 0; v < half.points.size(); ++v) {
    const Vec3& p = half.points[v];
    if (p.x == 0) {
      image[v] = static_cast<Index>(v);
    } else {
      image[v] = static_cast<Index>(whole.points.size());
      whole.points.push_back({-p.x, p.y, p.z});
    }
  }
  for (const Triangle& f : half.faces) whole.faces.push_back({image[f[0]], image[f[2]], image[f[1]]});
  return whole;
}

bool flip_edge(TriangleMesh& mesh, Index a, Index b) {
  const std::size_t left = rotate_to(mesh, a, b);
  const std::size_t right = rotate_to(mesh, b, a);
  if (left == mesh.faces.size() || right == mesh.faces.size()) return false;
  const Index c = mesh.faces[left][2];
  const Index d = mesh.faces[right][2];
  const auto rings = neighbours(mesh);
  if (c == d || std::binary_search(rings[c].begin(), rings[c].end(), d)) return false;
  if (rings[a].size() <= 4 || rings[b].size() <= 4 || rings[c].size() >= 10 || rings[d].size() >= 10)
    return false;
  const Vec3 before = unit(area_normal(mesh, mesh.faces[left]) + area_normal(mesh, mesh.faces[right]));
  const Triangle first = {c, d, b};
  const Triangle second = {d, c, a};
  for (const Triangle& face : {first, second}) {
    const Vec3 normal = area_normal(mesh, face);
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      longest = std::max(longest, length_sq(mesh.points[face[k]] - mesh.points[face[(k + 1) % 3]]));
    }
    if (dot(unit(normal), before) < 0.5 || length(normal) < 0.2 * longest) return false;
  }
  mesh.faces[left] = first;
  mesh.faces[right] = second;
  return true;
}

std::size_t scatter_flips(TriangleMesh& mesh, std::uint32_t seed, std::uint32_t stride) {
  std::vector<std::pair<Index, Index>> edges;
  const auto rings = neighbours(mesh);
  for (std::size_t v = 0; v < rings.size(); ++v) {
    for (const Index w : rings[v]) {
      if (v < w) edges.emplace_back(static_cast<Index>(v), w);
    }
  }
  std::size_t flipped = 0;
  std::uint32_t state = seed;
  for (const auto& [a, b] : edges) {
    state = state * 1664525u + 1013904223u;
    if ((state >> 8) % stride == 0 && flip_edge(mesh, a, b)) ++flipped;
  }
  return flipped;
}

Index split_face(TriangleMesh& mesh, std::size_t face, double raise) {
  const Triangle f = mesh.faces[face];
  const Vec3 &a = mesh.points[f[0]], &b = mesh.points[f[1]], &c = mesh.points[f[2]];
  const double mean_edge = (length(b - a) + length(c - b) + length(a - c)) / 3;
  const Vec3 tip = (1.0 / 3) * (a + b + c) + (raise * mean_edge) * unit(area_normal(mesh, f));
  const auto v = static_cast<Index>(mesh.points.size());
  mesh.points.push_back(tip);
  mesh.faces[face] = {f[0], f[1], v};
  mesh.faces.push_back({f[1], f[2], v});
  mesh.faces.push_back({f[2], f[0], v});
  return v;
}

void orient_outward(TriangleMesh& mesh) {
  double volume = 0;
  for (const Triangle& f : mesh.faces)
    volume += dot(mesh.points[f[0]], cross(mesh.points[f[1]], mesh.points[f[2]]));
  if (volume >= 0) return;
  for (Triangle& f : mesh.faces) std::swap(f[1], f[2]);
}

void finish(TriangleMesh& mesh, const std::string& name) {
  std::set<std::tuple<double, double, double>> places;
  for (Vec3& p : mesh.points) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      p[axis] = static_cast<double>(std::llround(p[axis] * 10000)) / 10000;
    check(places.emplace(p.x, p.y, p.z).second, name, "two vertices share a place");
  }
  std::map<std::pair<Index, Index>, Index> next_around;  // (v, from) -> to, once for each face corner
  std::vector<std::size_t> corners(mesh.points.size());
  for (const Triangle& f : mesh.faces) {
    check(length(area_normal(mesh, f)) > 1e-6, name, "a face has no area");
    for (std::size_t k = 0; k < 3; ++k) {
      ++corners[f[k]];
      check(next_around.emplace(std::pair(f[k], f[(k + 1) % 3]), f[(k + 2) % 3]).second, name,
            "an edge is used twice");
    }
  }
  const auto rings = neighbours(mesh);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    check(rings[v].size() >= 3, name, "a vertex has fewer than three neighbours");
    check(rings[v].size() - corners[v] <= 1, name, "a vertex joins two boundaries");
    Index start = rings[v].front();  // at a boundary: the neighbour that no face leads to
    for (const Index w : rings[v]) {
      if (!next_around.contains({w, static_cast<Index>(v)})) start = w;
    }
    Index at = start;
    std::size_t steps = 0;
    for (auto it = next_around.find({static_cast<Index>(v), at});
         it != next_around.end() && steps < corners[v]; it = next_around.find({static_cast<Index>(v), at})) {
      at = it->second;
      ++steps;
      if (at == start) break;
    }
    check(steps == corners[v], name, "the faces around a vertex are not one fan");
  }
}

std::string obj_text(const TriangleMesh& mesh, const std::string& title) {
  std::string text =
      "# " + title +
      "\n# Control mesh for Loop subdivision, written by generate_models.\nt scheme 0/0/1 loop\n";
  for (const Vec3& p : mesh.points)
    text += "v " + decimal(p.x) + " " + decimal(p.y) + " " + decimal(p.z) + "\n";
  for (const Triangle& f : mesh.faces) {
    text += "f " + std::to_string(f[0] + 1) + " " + std::to_string(f[1] + 1) + " " +
            std::to_string(f[2] + 1) + "\n";
  }
  return text;
}

}  // namespace models
