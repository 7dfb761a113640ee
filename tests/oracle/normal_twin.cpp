#include <oracle/normal_twin.h>
#include <oracle/polygon_twin.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>

namespace oracle {
namespace {

using Place = std::array<double, 2>;
using Long = std::array<long double, 3>;

// A refined mesh whose faces know where in the control mesh they lie.
struct Tracked {
  struct Piece {
    std::uint32_t face, part;
    std::vector<Place> corners;
  };
  TaggedMesh mesh;
  std::vector<Piece> pieces;
};

Tracked tracked(const TaggedMesh& mesh) {
  Tracked all{mesh, {}};
  for (std::uint32_t f = 0; f < mesh.polygons.size(); ++f) {
    Tracked::Piece piece{f, 0, {}};
    const std::size_t n = mesh.polygons[f].size();
    if (n == 3) piece.corners = {{0, 0}, {1, 0}, {0, 1}};
    if (n == 4) piece.corners = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    piece.corners.resize(n);
    all.pieces.push_back(piece);
  }
  return all;
}

Place between(Place a, Place b) { return {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2}; }

Tracked refined(const Tracked& from, const Rules& rules, bool first) {
  Tracked to{refine(from.mesh, rules), {}};
  const bool loop = rules.scheme == PrimalScheme::loop;
  for (std::size_t f = 0; f < from.pieces.size(); ++f) {
    const Tracked::Piece& piece = from.pieces[f];
    const auto& c = piece.corners;
    const std::size_t n = c.size();
    if (loop) {
      const Place a = between(c[0], c[1]), b = between(c[1], c[2]), d = between(c[2], c[0]);
      to.pieces.push_back({piece.face, piece.part, {c[0], a, d}});
      to.pieces.push_back({piece.face, piece.part, {a, c[1], b}});
      to.pieces.push_back({piece.face, piece.part, {d, b, c[2]}});
      to.pieces.push_back({piece.face, piece.part, {b, d, a}});
      continue;
    }
    if (n != 4) {
      if (!first) throw std::invalid_argument("a polygon after the first step");
      for (std::uint32_t k = 0; k < n; ++k)
        to.pieces.push_back({piece.face, k, {{0, 0}, {1, 0}, {1, 1}, {0, 1}}});
      continue;
    }
    for (std::size_t k = 0; k < 4; ++k) {
      std::vector<Place> corners(4);
      corners[k] = c[k];
      corners[(k + 1) % 4] = between(c[k], c[(k + 1) % 4]);
      corners[(k + 2) % 4] = between(c[0], c[2]);
      corners[(k + 3) % 4] = between(c[k], c[(k + 3) % 4]);
      to.pieces.push_back({piece.face, piece.part, corners});
    }
  }
  if (to.pieces.size() != to.mesh.polygons.size()) throw std::invalid_argument("faces in another order");
  return to;
}

Long minus(const Point& a, const Point& b) {
  return {static_cast<long double>(a[0]) - b[0], static_cast<long double>(a[1]) - b[1],
          static_cast<long double>(a[2]) - b[2]};
}
Long cross(const Long& a, const Long& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
long double length(const Long& a) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

struct Modes {
  std::array<Long, 2> sums{};
  void add(const Long& p, long double cosine, long double sine) {
    for (std::size_t k = 0; k < 3; ++k) {
      sums[0][k] += cosine * p[k];
      sums[1][k] += sine * p[k];
    }
  }
  // A unit normal, and its error for points of this size.
  [[nodiscard]] std::optional<std::pair<Point, double>> normal(long double size) const {
    const Long n = cross(sums[0], sums[1]);
    const long double l = length(n);
    const long double error = 1e-13L * size * std::max(length(sums[0]), length(sums[1])) / l;
    if (!(error < 1e-7L)) return std::nullopt;
    return std::pair{
        Point{static_cast<double>(n[0] / l), static_cast<double>(n[1] / l), static_cast<double>(n[2] / l)},
        static_cast<double>(error)};
  }
};

// A corner of a face: what comes before and after it around the vertex.
struct Corner {
  std::size_t face, at;
};

void add_samples(const Tracked& all, const Rules& rules, std::vector<NormalSample>& out) {
  const TaggedMesh& mesh = all.mesh;
  const bool loop = rules.scheme == PrimalScheme::loop;
  std::vector<std::map<std::uint32_t, Corner>> around(mesh.points.size());  // by the edge that enters a face
  for (std::size_t f = 0; f < mesh.polygons.size(); ++f) {
    const auto& face = mesh.polygons[f];
    for (std::size_t k = 0; k < face.size(); ++k) {
      if (!around[face[k]].emplace(face[(k + 1) % face.size()], Corner{f, k}).second)
        throw std::invalid_argument("no oriented manifold");
    }
  }
  std::vector<bool> sharp(mesh.points.size(), false);
  for (const auto& crease : mesh.creases) {
    if (crease.sharpness > 0) sharp[crease.a] = sharp[crease.b] = true;
  }
  for (const auto& corner : mesh.corners) {
    if (corner.sharpness > 0) sharp[corner.vertex] = true;
  }
  long double size = 0;
  for (const Point& p : mesh.points) {
    for (const double x : p) size = std::max(size, std::fabs(static_cast<long double>(x)));
  }
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    if (sharp[v] || around[v].size() < 3) continue;
    std::vector<std::uint32_t> spokes, diagonals;
    std::uint32_t next = around[v].begin()->first;
    bool closed = true, quads = true;
    do {
      const auto it = around[v].find(next);
      if (it == around[v].end()) {
        closed = false;
        break;
      }
      const auto& face = mesh.polygons[it->second.face];
      const std::size_t n = face.size();
      quads = quads && n == 4;
      spokes.push_back(next);
      diagonals.push_back(face[(it->second.at + 2) % n]);
      next = face[(it->second.at + n - 1) % n];
    } while (next != spokes.front());
    if (!closed || spokes.size() != around[v].size() || (!loop && !quads)) continue;
    const std::size_t n = spokes.size();
    const long double turn = 2 * std::numbers::pi_v<long double> / static_cast<long double>(n);
    const long double c = std::cos(turn);
    const long double edge = 1 + c + std::cos(turn / 2) * std::sqrt(2 * (9 + c));
    Modes modes;
    for (std::size_t i = 0; i < n; ++i) {
      const long double angle = turn * static_cast<long double>(i);
      const Long p = minus(mesh.points[spokes[i]], mesh.points[v]);
      const long double weight = loop ? 1 : edge;
      modes.add(p, weight * std::cos(angle), weight * std::sin(angle));
      if (loop) continue;
      const Long q = minus(mesh.points[diagonals[i]], mesh.points[v]);
      modes.add(q, std::cos(angle) + std::cos(angle + turn), std::sin(angle) + std::sin(angle + turn));
    }
    const auto normal = modes.normal(size);
    if (!normal) continue;
    for (const auto& [first, corner] : around[v]) {
      const Tracked::Piece& piece = all.pieces[corner.face];
      const Place at = piece.corners[corner.at];
      out.push_back({piece.face, piece.part, at[0], at[1], normal->first, normal->second});
    }
  }
}

// The faces within three rings of a vertex, which moves to the origin.
Tracked cropped(const Tracked& all, std::uint32_t& vertex) {
  std::vector<std::uint8_t> near(all.mesh.points.size(), 0);
  near[vertex] = 1;
  std::vector<bool> kept(all.pieces.size(), false);
  for (int ring = 0; ring < 3; ++ring) {
    for (std::size_t f = 0; f < all.pieces.size(); ++f) {
      const auto& face = all.mesh.polygons[f];
      if (std::any_of(face.begin(), face.end(), [&](std::uint32_t v) { return near[v] == 1; }))
        kept[f] = true;
    }
    for (std::size_t f = 0; f < all.pieces.size(); ++f) {
      if (!kept[f]) continue;
      for (const std::uint32_t v : all.mesh.polygons[f]) near[v] = 1;
    }
  }
  std::vector<std::uint32_t> name(all.mesh.points.size(), UINT32_MAX);
  Tracked to;
  const Point origin = all.mesh.points[vertex];
  for (std::uint32_t v = 0; v < name.size(); ++v) {
    if (near[v] == 0) continue;
    name[v] = static_cast<std::uint32_t>(to.mesh.points.size());
    const Point& p = all.mesh.points[v];
    to.mesh.points.push_back({p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]});
  }
  for (std::size_t f = 0; f < all.pieces.size(); ++f) {
    if (!kept[f]) continue;
    auto face = all.mesh.polygons[f];
    for (std::uint32_t& v : face) v = name[v];
    to.mesh.polygons.push_back(face);
    to.pieces.push_back(all.pieces[f]);
  }
  for (auto crease : all.mesh.creases) {
    crease.a = name[crease.a];
    crease.b = name[crease.b];
    if (crease.a != UINT32_MAX && crease.b != UINT32_MAX) to.mesh.creases.push_back(crease);
  }
  for (auto corner : all.mesh.corners) {
    corner.vertex = name[corner.vertex];
    if (corner.vertex != UINT32_MAX) to.mesh.corners.push_back(corner);
  }
  vertex = name[vertex];
  return to;
}

}  // namespace

std::vector<NormalSample> sample_normals(const TaggedMesh& mesh, const Rules& rules, int levels) {
  Tracked all = tracked(mesh);
  for (int level = 0; level < levels; ++level) all = refined(all, rules, level == 0);
  std::vector<NormalSample> samples;
  add_samples(all, rules, samples);
  return samples;
}

std::vector<NormalSample> sample_normals_near(const TaggedMesh& mesh, const Rules& rules,
                                              std::uint32_t vertex, int rings) {
  Tracked all = tracked(mesh);
  std::vector<NormalSample> samples;
  // A refined vertex stands at the same corner of a child of the first face that has it.
  const auto corner_of = [](const Tracked& tracked, std::uint32_t v) {
    for (std::size_t f = 0; f < tracked.pieces.size(); ++f) {
      const auto& face = tracked.mesh.polygons[f];
      const auto it = std::find(face.begin(), face.end(), v);
      if (it != face.end()) return std::pair{f, static_cast<std::size_t>(it - face.begin())};
    }
    throw std::invalid_argument("no face has the vertex");
  };
  for (int ring = 0; ring < rings; ++ring) {
    const auto [f, k] = corner_of(all, vertex);
    std::size_t child = k;
    for (std::size_t g = 0; g < f; ++g) child += std::max<std::size_t>(4, all.pieces[g].corners.size());
    if (all.pieces[f].corners.size() == 3 && rules.scheme != PrimalScheme::loop) return samples;
    for (std::size_t g = 0; g < f; ++g) {
      if (all.pieces[g].corners.size() == 3 && rules.scheme != PrimalScheme::loop) return samples;
    }
    const bool quad = all.pieces[f].corners.size() == 4 || rules.scheme == PrimalScheme::loop;
    all = refined(all, rules, ring == 0);
    vertex = all.mesh.polygons[child][quad ? k : 0];
    all = cropped(all, vertex);
    // Of these only what is near: the rim of what was left lacks its neighbours.
    Tracked inner = all;
    std::vector<NormalSample> found;
    add_samples(inner, rules, found);
    samples.insert(samples.end(), found.begin(), found.end());
  }
  return samples;
}

std::vector<DualNormal> sample_dual_normals(const TaggedMesh& mesh, DualScheme scheme, int levels) {
  const TaggedMesh fine = refine_dual(mesh, scheme, levels);
  const std::vector<DualSample> places = sample_dual(mesh, scheme, levels);
  long double size = 0;
  for (const Point& p : fine.points) {
    for (const double x : p) size = std::max(size, std::fabs(static_cast<long double>(x)));
  }
  std::vector<DualNormal> normals;
  for (const auto& face : fine.polygons) {
    const std::size_t n = face.size();
    Point centre{};
    for (const std::uint32_t v : face) {
      for (std::size_t k = 0; k < 3; ++k) centre[k] += fine.points[v][k] / static_cast<double>(n);
    }
    const auto at =
        std::min_element(places.begin(), places.end(), [&](const DualSample& a, const DualSample& b) {
          return length(minus(a.position, centre)) < length(minus(b.position, centre));
        });
    if (at == places.end() || !(length(minus(at->position, centre)) < 1e-13L * (1 + size))) continue;
    Modes modes;
    for (std::size_t i = 0; i < n; ++i) {
      const long double angle =
          2 * std::numbers::pi_v<long double> * static_cast<long double>(i) / static_cast<long double>(n);
      modes.add(minus(fine.points[face[i]], centre), std::cos(angle), std::sin(angle));
    }
    if (const auto normal = modes.normal(size))
      normals.push_back({at->owners, normal->first, normal->second});
  }
  return normals;
}

}  // namespace oracle
