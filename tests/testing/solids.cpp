#include <oracle/tagged_shapes.h>
#include <testing/solids.h>

#include <algorithm>
#include <array>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace snug::testing {
namespace {

using oracle::Point;
using oracle::TaggedMesh;
using Id = std::uint32_t;
using Polygon = std::vector<Id>;

double between(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

TaggedMesh torus(Id m, Id n) {
  TaggedMesh mesh;
  for (Id i = 0; i < m; ++i) {
    for (Id j = 0; j < n; ++j) {
      const double u = 2 * std::numbers::pi * i / m, v = 2 * std::numbers::pi * j / n,
                   r = 2 + 0.8 * std::cos(v);
      mesh.points.push_back({r * std::cos(u), r * std::sin(u), 0.8 * std::sin(v)});
      const Id k = (i + 1) % m, l = (j + 1) % n;
      mesh.polygons.push_back({i * n + j, k * n + j, k * n + l, i * n + l});
    }
  }
  return mesh;
}

TaggedMesh base_shape(std::mt19937_64& random) {
  switch (random() % 5) {
    case 0:
      return oracle::meshes::cube();
    case 1:
      return oracle::meshes::prism(3 + static_cast<Id>(random() % 6));
    case 2:
      return oracle::meshes::pyramid(3 + static_cast<Id>(random() % 6));
    case 3:
      return torus(3 + static_cast<Id>(random() % 3), 3 + static_cast<Id>(random() % 3));
    default:
      return oracle::meshes::triangulated(oracle::meshes::prism(3 + static_cast<Id>(random() % 4)));
  }
}

Point middle(const TaggedMesh& mesh, const Polygon& face) {
  Point sum{};
  for (const Id v : face)
    for (std::size_t x = 0; x < 3; ++x) sum[x] += mesh.points[v][x] / static_cast<double>(face.size());
  return sum;
}

// A vertex in the middle, and triangles around it.
void poke(TaggedMesh& mesh, std::size_t f) {
  const Polygon face = mesh.polygons[f];
  const Id centre = static_cast<Id>(mesh.points.size());
  mesh.points.push_back(middle(mesh, face));
  mesh.polygons.erase(mesh.polygons.begin() + static_cast<std::ptrdiff_t>(f));
  for (std::size_t k = 0; k < face.size(); ++k)
    mesh.polygons.push_back({face[k], face[(k + 1) % face.size()], centre});
}

// A smaller face inside, and quads around it.
void inset(TaggedMesh& mesh, std::size_t f, std::mt19937_64& random) {
  const Polygon face = mesh.polygons[f];
  const Point centre = middle(mesh, face);
  const double share = between(random, 0.3, 0.7), out = between(random, -0.2, 0.3);
  Polygon inner;
  for (const Id v : face) {
    Point p;
    for (std::size_t x = 0; x < 3; ++x)
      p[x] = (1 - share) * mesh.points[v][x] + share * centre[x] + out * centre[x];
    inner.push_back(static_cast<Id>(mesh.points.size()));
    mesh.points.push_back(p);
  }
  for (std::size_t k = 0; k < face.size(); ++k) {
    const std::size_t next = (k + 1) % face.size();
    mesh.polygons.push_back({face[k], face[next], inner[next], inner[k]});
  }
  mesh.polygons[f] = inner;
}

std::map<std::pair<Id, Id>, std::vector<std::size_t>> edges_of(const TaggedMesh& mesh) {
  std::map<std::pair<Id, Id>, std::vector<std::size_t>> edges;
  for (std::size_t f = 0; f < mesh.polygons.size(); ++f) {
    const Polygon& face = mesh.polygons[f];
    for (std::size_t k = 0; k < face.size(); ++k)
      edges[std::minmax(face[k], face[(k + 1) % face.size()])].push_back(f);
  }
  return edges;
}

// Two faces of one, unless its ends are joined by an edge already.
void cut(TaggedMesh& mesh, std::size_t f, std::mt19937_64& random) {
  const Polygon face = mesh.polygons[f];
  const std::size_t n = face.size();
  if (n < 4) return;
  const std::size_t i = random() % n, j = (i + 2 + random() % (n - 3)) % n;
  if (edges_of(mesh).count(std::minmax(face[i], face[j])) != 0) return;
  Polygon one, other;
  for (std::size_t k = i;; k = (k + 1) % n) {
    one.push_back(face[k]);
    if (k == j) break;
  }
  for (std::size_t k = j;; k = (k + 1) % n) {
    other.push_back(face[k]);
    if (k == i) break;
  }
  mesh.polygons[f] = one;
  mesh.polygons.push_back(other);
}

// One face of two that share an edge and no other vertex, if its ends keep three faces.
void join(TaggedMesh& mesh, std::mt19937_64& random) {
  const auto edges = edges_of(mesh);
  auto it = edges.begin();
  std::advance(it, static_cast<std::ptrdiff_t>(random() % edges.size()));
  if (it->second.size() != 2 || it->second[0] == it->second[1]) return;
  std::size_t f = it->second[0], g = it->second[1];
  std::map<Id, int> faces;
  for (const Polygon& face : mesh.polygons)
    for (const Id v : face) ++faces[v];
  if (faces[it->first.first] < 4 || faces[it->first.second] < 4) return;
  const std::set<Id> own(mesh.polygons[f].begin(), mesh.polygons[f].end());
  const auto shared = std::count_if(mesh.polygons[g].begin(), mesh.polygons[g].end(),
                                    [&](Id v) { return own.count(v) != 0; });
  if (shared != 2) return;
  // f turned so that the edge is its last one, from its back to its front.
  Polygon first = mesh.polygons[f], second = mesh.polygons[g];
  const auto turn = [&](Polygon& face) {
    while (std::minmax(face.back(), face.front()) !=
           std::pair<const Id&, const Id&>(it->first.first, it->first.second))
      std::rotate(face.begin(), face.begin() + 1, face.end());
  };
  turn(first);
  turn(second);
  first.insert(first.end(), second.begin() + 1, second.end() - 1);
  mesh.polygons[f] = first;
  mesh.polygons.erase(mesh.polygons.begin() + static_cast<std::ptrdiff_t>(g));
}

TaggedMesh shell(std::mt19937_64& random) {
  TaggedMesh mesh = base_shape(random);
  for (std::uint64_t steps = random() % 6; steps > 0; --steps) {
    const std::size_t f = random() % mesh.polygons.size();
    switch (random() % 5) {
      case 0:
        poke(mesh, f);
        break;
      case 1:
        inset(mesh, f, random);
        break;
      case 2:
        cut(mesh, f, random);
        break;
      default:
        join(mesh, random);
    }
  }
  return oracle::meshes::shaken(mesh, between(random, 0, 0.25), random);
}

}  // namespace

TaggedMesh random_solid(std::mt19937_64& random) {
  TaggedMesh mesh = shell(random);
  if (random() % 3 != 0) return mesh;
  const TaggedMesh more = shell(random);
  const double share = between(random, 0.15, 0.9);
  const Point away{between(random, -0.5, 0.5), between(random, -0.5, 0.5), between(random, -0.5, 0.5)};
  const Id first = static_cast<Id>(mesh.points.size());
  for (const Point& p : more.points)
    mesh.points.push_back({share * p[0] + away[0], share * p[1] + away[1], share * p[2] + away[2]});
  const bool inside_out = random() % 2 == 0;
  for (Polygon face : more.polygons) {
    for (Id& v : face) v += first;
    if (inside_out) std::reverse(face.begin(), face.end());
    mesh.polygons.push_back(std::move(face));
  }
  return mesh;
}

}  // namespace snug::testing
