#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <snug/mesh.h>

/// Small closed meshes without positions: families of them, and what turns one into another.
namespace snug::testing {

using Faces = std::vector<std::vector<std::uint32_t>>;

struct ClosedMesh {
  std::string name;
  std::uint32_t vertices;
  Faces faces;
};

/// Is it an oriented closed manifold of simple faces, no two edges between the same vertices, all valences
/// and sizes 3 or more?
inline bool is_closed_manifold(const ClosedMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>
      after;  // edge before, of an edge around its first vertex
  std::map<std::uint32_t, std::uint32_t> valence;
  for (const auto& face : mesh.faces) {
    const std::size_t n = face.size();
    if (n < 3 || std::set<std::uint32_t>(face.begin(), face.end()).size() != n) return false;
    for (std::size_t i = 0; i < n; ++i) {
      if (!after.insert({{face[i], face[(i + 1) % n]}, face[(i + n - 1) % n]}).second) return false;
      ++valence[face[i]];
    }
  }
  for (const auto& [edge, before] : after) {
    if (!after.contains({edge.second, edge.first})) return false;
    std::uint32_t count = 0, end = edge.second;
    do {
      end = after.at({edge.first, end});
      ++count;
    } while (end != edge.second);
    if (count != valence[edge.first] || count < 3) return false;
  }
  return true;
}

inline ClosedMesh tetrahedron() { return {"tetrahedron", 4, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}}; }

inline ClosedMesh prism(std::uint32_t n) {
  ClosedMesh mesh{"prism " + std::to_string(n), 2 * n, {{}, {}}};
  for (std::uint32_t i = 0; i < n; ++i) {
    mesh.faces[0].push_back(n - 1 - i);
    mesh.faces[1].push_back(n + i);
    const std::uint32_t k = (i + 1) % n;
    mesh.faces.push_back({i, k, n + k, n + i});
  }
  return mesh;
}

inline ClosedMesh antiprism(std::uint32_t n) {
  ClosedMesh mesh{"antiprism " + std::to_string(n), 2 * n, {{}, {}}};
  for (std::uint32_t i = 0; i < n; ++i) {
    mesh.faces[0].push_back(n - 1 - i);
    mesh.faces[1].push_back(n + i);
    const std::uint32_t k = (i + 1) % n;
    mesh.faces.push_back({i, k, n + i});
    mesh.faces.push_back({k, n + k, n + i});
  }
  return mesh;
}

inline ClosedMesh torus(std::uint32_t a, std::uint32_t b, bool triangles = false) {
  ClosedMesh mesh{
      (triangles ? "cut torus " : "torus ") + std::to_string(a) + " " + std::to_string(b), a * b, {}};
  const auto at = [=](std::uint32_t i, std::uint32_t j) { return i % a + a * (j % b); };
  for (std::uint32_t j = 0; j < b; ++j) {
    for (std::uint32_t i = 0; i < a; ++i) {
      const std::array c{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
      if (triangles) {
        mesh.faces.push_back({c[0], c[1], c[2]});
        mesh.faces.push_back({c[0], c[2], c[3]});
      } else {
        mesh.faces.push_back({c[0], c[1], c[2], c[3]});
      }
    }
  }
  return mesh;
}

/// Faces and vertices change roles.
inline ClosedMesh dual(const ClosedMesh& mesh) {
  ClosedMesh result{"dual of " + mesh.name, static_cast<std::uint32_t>(mesh.faces.size()), {}};
  std::map<std::uint32_t, std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>>> around;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    const auto& face = mesh.faces[f];
    for (std::size_t i = 0, n = face.size(); i < n; ++i) {
      around[face[i]][face[(i + 1) % n]] = {f, face[(i + n - 1) % n]};
    }
  }
  for (const auto& [v, ring] : around) {
    std::vector<std::uint32_t> face;
    const std::uint32_t first = ring.begin()->first;
    std::uint32_t end = first;
    do {
      face.push_back(ring.at(end).first);
      end = ring.at(end).second;
    } while (end != first);
    result.faces.push_back(std::move(face));
  }
  return result;
}

/// Cuts a vertex off, or all of them.
inline ClosedMesh truncated(const ClosedMesh& mesh, std::uint32_t which = UINT32_MAX) {
  ClosedMesh result{"truncated " + mesh.name, 0, {}};
  const auto cut = [=](std::uint32_t v) { return which == UINT32_MAX || v == which; };
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> names;
  const auto name = [&](std::uint32_t v, std::uint32_t towards) {
    return names.insert({{v, cut(v) ? towards : v}, static_cast<std::uint32_t>(names.size())}).first->second;
  };
  std::map<std::uint32_t, std::map<std::uint32_t, std::uint32_t>> before;
  for (const auto& face : mesh.faces) {
    std::vector<std::uint32_t> longer;
    for (std::size_t i = 0, n = face.size(); i < n; ++i) {
      const std::uint32_t v = face[i], last = face[(i + n - 1) % n], next = face[(i + 1) % n];
      if (cut(v)) {
        longer.push_back(name(v, last));
        before[v][next] = last;
      }
      longer.push_back(name(v, next));
    }
    result.faces.push_back(std::move(longer));
  }
  for (const auto& [v, ring] : before) {
    std::vector<std::uint32_t> face;
    const std::uint32_t first = ring.begin()->first;
    std::uint32_t end = first;
    do {
      face.push_back(name(v, end));
      end = ring.at(end);
    } while (end != first);
    result.faces.push_back(std::move(face));
  }
  result.vertices = static_cast<std::uint32_t>(names.size());
  return result;
}

/// A vertex in the middle of a face, or of every one, joined to its corners.
inline ClosedMesh stellated(const ClosedMesh& mesh, std::size_t which = SIZE_MAX) {
  ClosedMesh result{"stellated " + mesh.name, mesh.vertices, {}};
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto& face = mesh.faces[f];
    if (which != SIZE_MAX && which != f) {
      result.faces.push_back(face);
      continue;
    }
    for (std::size_t i = 0; i < face.size(); ++i) {
      result.faces.push_back({face[i], face[(i + 1) % face.size()], result.vertices});
    }
    ++result.vertices;
  }
  return result;
}

inline ClosedMesh bipyramid(std::uint32_t n) { return dual(prism(n)); }
inline ClosedMesh trapezohedron(std::uint32_t n) { return dual(antiprism(n)); }

/// Two components.
inline ClosedMesh beside(const ClosedMesh& a, const ClosedMesh& b) {
  ClosedMesh both{a.name + " beside " + b.name, a.vertices + b.vertices, a.faces};
  for (auto face : b.faces) {
    for (std::uint32_t& v : face) v += a.vertices;
    both.faces.push_back(std::move(face));
  }
  return both;
}

/// Connected sum along the last faces, which have equally many corners.
inline ClosedMesh joined(const ClosedMesh& a, const ClosedMesh& b) {
  ClosedMesh sum{a.name + " joined to " + b.name, a.vertices, a.faces};
  sum.faces.pop_back();
  const auto &hole = a.faces.back(), &other = b.faces.back();
  std::vector<std::uint32_t> names(b.vertices, UINT32_MAX);
  for (std::size_t i = 0; i < hole.size(); ++i) names[other[other.size() - 1 - i]] = hole[i];
  for (std::uint32_t& name : names) {
    if (name == UINT32_MAX) name = sum.vertices++;
  }
  for (std::size_t f = 0; f + 1 < b.faces.size(); ++f) {
    std::vector<std::uint32_t> face;
    for (const std::uint32_t v : b.faces[f]) face.push_back(names[v]);
    sum.faces.push_back(std::move(face));
  }
  return sum;
}

/// A random edge gone or put across a face, or turned; a vertex cut off; a face raised: the same mesh where
/// that is no manifold.
inline ClosedMesh changed(const ClosedMesh& mesh, std::mt19937_64& random) {
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  ClosedMesh result = mesh;
  const std::size_t f = below(mesh.faces.size()), n = mesh.faces[f].size();
  const auto& face = mesh.faces[f];
  switch (below(5)) {
    case 0:
      result = truncated(mesh, face[below(n)]);
      break;
    case 1:
      result = stellated(mesh, f);
      break;
    case 2: {  // a diagonal
      const std::size_t i = below(n), steps = 2 + below(n);
      if (n < 4 || steps > n - 2) return mesh;
      std::vector<std::uint32_t> one, other;
      for (std::size_t k = 0; k <= steps; ++k) one.push_back(face[(i + k) % n]);
      for (std::size_t k = steps; k <= n; ++k) other.push_back(face[(i + k) % n]);
      result.faces[f] = one;
      result.faces.push_back(other);
      break;
    }
    default: {  // two faces as one, and perhaps cut anew
      const std::size_t i = below(n);
      const std::uint32_t a = face[i], b = face[(i + 1) % n];
      for (std::size_t g = 0; g < mesh.faces.size(); ++g) {
        const auto& with = mesh.faces[g];
        const auto at = std::find(with.begin(), with.end(), b);
        if (g == f || at == with.end()) continue;
        const std::size_t m = with.size(), k = static_cast<std::size_t>(at - with.begin());
        if (with[(k + 1) % m] != a) continue;
        std::vector<std::uint32_t> merged;
        for (std::size_t s = 1; s < n; ++s) merged.push_back(face[(i + s) % n]);
        for (std::size_t s = 1; s < m; ++s) merged.push_back(with[(k + s) % m]);
        result.faces[f] = merged;
        result.faces.erase(result.faces.begin() + static_cast<std::ptrdiff_t>(g));
        break;
      }
      break;
    }
  }
  result.name = mesh.name;
  if (!result.name.ends_with(" changed")) result.name += " changed";
  return is_closed_manifold(result) ? result : mesh;
}

/// With random positions.
inline ControlMesh control_mesh_of(const ClosedMesh& mesh, std::mt19937_64& random) {
  ControlMesh result;
  std::uniform_real_distribution<double> anywhere(-1, 1);
  for (std::uint32_t v = 0; v < mesh.vertices; ++v) {
    result.points.push_back({anywhere(random), anywhere(random), anywhere(random)});
  }
  for (const auto& face : mesh.faces) {
    std::vector<VertexId> corners;
    for (const std::uint32_t v : face) corners.emplace_back(v);
    result.add_face(corners);
  }
  return result;
}

}  // namespace snug::testing
