#include "meshes.h"

#include <snug/evaluate.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <random>
#include <utility>

namespace snug::bench {
namespace {

constexpr std::uint32_t min_valence = 3, max_valence = 12;

// In [-1, 1), the same on every machine.
double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; }

struct GridSize {
  std::size_t columns, rows;
};

// Edges of about equal length on average: the torus is three times as long around its axis as around its
// tube.
GridSize grid_size(std::size_t faces) {
  const double rows = std::max(3.0, std::round(std::sqrt(static_cast<double>(faces) / 6)));
  return {static_cast<std::size_t>(std::max(3.0, std::round(static_cast<double>(faces) / (2 * rows)))),
          static_cast<std::size_t>(rows)};
}

// A closed triangle mesh as half-edges, three in a row a face, whose edges can be flipped.
class Flipper {
 public:
  explicit Flipper(const ControlMesh& mesh) : valence_(mesh.vertex_count(), 0) {
    const Topology topology(mesh);
    from_ = mesh.face_vertices;
    twin_.reserve(from_.size());
    for (HalfEdge h = 0; h < from_.size(); ++h) {
      twin_.push_back(topology.twin(h));
      ++valence_[from_[h].index()];
    }
  }

  //       c                  c
  //     /   \              / | \        h: a -> b becomes d -> c; the faces stay where they are in the list
  //    a --- b     ->     a  |  b
  //     \   /              \ | /
  //       d                  d
  //
  // False, and nothing changes, where a valence would leave its range or the new edge is there already.
  bool flip(HalfEdge h) {
    const HalfEdge t = twin_[h];
    const HalfEdge bc = next(h), ca = next(bc), ad = next(t), db = next(ad);
    const VertexId a = from_[h], b = from_[t], c = from_[ca], d = from_[db];
    if (valence_[a.index()] == min_valence || valence_[b.index()] == min_valence ||
        valence_[c.index()] == max_valence || valence_[d.index()] == max_valence || c == d || joined(ca, d)) {
      return false;
    }
    const std::array<HalfEdge, 4> outer{twin_[bc], twin_[ca], twin_[ad], twin_[db]};
    from_[h] = d, from_[bc] = c, from_[ca] = a;
    from_[t] = c, from_[ad] = d, from_[db] = b;
    join(bc, outer[1]), join(ca, outer[2]), join(ad, outer[3]), join(db, outer[0]);
    --valence_[a.index()], --valence_[b.index()];
    ++valence_[c.index()], ++valence_[d.index()];
    return true;
  }

  [[nodiscard]] std::vector<VertexId> take() { return std::move(from_); }

 private:
  static HalfEdge next(HalfEdge h) { return h % 3 == 2 ? h - 2 : h + 1; }
  void join(HalfEdge g, HalfEdge h) {
    twin_[g] = h;
    twin_[h] = g;
  }
  // Does an edge lead from the start of `leaving` to v?
  [[nodiscard]] bool joined(HalfEdge leaving, VertexId v) const {
    HalfEdge h = leaving;
    do {
      if (from_[next(h)] == v) return true;
      h = next(twin_[h]);
    } while (h != leaving);
    return false;
  }

  std::vector<VertexId> from_;
  std::vector<HalfEdge> twin_;
  std::vector<std::uint32_t> valence_;
};

}  // namespace

ControlMesh torus_grid(std::size_t columns, std::size_t rows) {
  ControlMesh mesh;
  for (std::size_t i = 0; i < columns; ++i) {
    for (std::size_t j = 0; j < rows; ++j) {
      const double a = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(columns);
      const double b = 2 * std::numbers::pi * static_cast<double>(j) / static_cast<double>(rows);
      const double r = 3 + std::cos(b);
      mesh.points.push_back({r * std::cos(a), r * std::sin(a), std::sin(b)});
    }
  }
  const auto at = [&](std::size_t i, std::size_t j) { return VertexId(i % columns * rows + j % rows); };
  for (std::size_t i = 0; i < columns; ++i) {
    for (std::size_t j = 0; j < rows; ++j) {
      mesh.add_face(std::array{at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.add_face(std::array{at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

ControlMesh regular_mesh(std::size_t faces) {
  const GridSize size = grid_size(faces);
  return torus_grid(size.columns, size.rows);
}

ControlMesh irregular_mesh(std::size_t faces, const Irregularity& options) {
  const GridSize size = grid_size(faces);
  ControlMesh mesh = torus_grid(size.columns, size.rows);
  std::mt19937_64 random(options.seed);
  Flipper flipper(mesh);
  const std::size_t half_edges = mesh.face_vertices.size();
  const auto wanted = static_cast<std::size_t>(options.flips * static_cast<double>(half_edges) / 2);
  // Some tries flip nothing; the limit keeps an impossible wish from running on for ever.
  for (std::size_t done = 0, tries = 0; done < wanted && tries < 10 * wanted; ++tries) {
    done += flipper.flip(static_cast<HalfEdge>(random() % half_edges));
  }
  mesh.face_vertices = flipper.take();
  const double move = options.jitter * 2 * std::numbers::pi / static_cast<double>(size.rows);
  for (Point3& p : mesh.points) {
    for (std::size_t x = 0; x < 3; ++x) p[x] += move * unit(random);
  }
  return mesh;
}

namespace {

// A torus of columns * rows vertices; vertex (c, r) at c + columns * r, quad (c, r) from there to (c + 1, r +
// 1).
struct QuadTorus {
  std::size_t columns, rows;
  [[nodiscard]] VertexId vertex(std::size_t c, std::size_t r) const {
    return VertexId(c % columns + columns * (r % rows));
  }
  [[nodiscard]] std::array<VertexId, 4> quad(std::size_t c, std::size_t r) const {
    return {vertex(c, r), vertex(c + 1, r), vertex(c + 1, r + 1), vertex(c, r + 1)};
  }
  [[nodiscard]] std::vector<Point3> points(double jitter, std::uint64_t seed) const {
    std::mt19937_64 random(seed);
    const auto noise = [&] { return jitter * (static_cast<double>(random() >> 11) * 0x1p-52 - 1); };
    std::vector<Point3> result;
    for (std::size_t r = 0; r < rows; ++r) {
      for (std::size_t c = 0; c < columns; ++c) {
        const double s = 2 * std::numbers::pi * static_cast<double>(c) / static_cast<double>(columns);
        const double t = 2 * std::numbers::pi * static_cast<double>(r) / static_cast<double>(rows);
        const double ring = 3 + std::cos(t);
        result.push_back({ring * std::cos(s) + noise(), ring * std::sin(s) + noise(), std::sin(t) + noise()});
      }
    }
    return result;
  }
};

QuadTorus torus_of(std::size_t faces) {
  const auto rows =
      std::max<std::size_t>(4, static_cast<std::size_t>(std::sqrt(static_cast<double>(faces) / 2)));
  return {std::max<std::size_t>(4, faces / rows), rows};
}

}  // namespace

ControlMesh quad_torus(std::size_t faces) {
  const QuadTorus torus = torus_of(faces);
  ControlMesh mesh;
  mesh.points = torus.points(0, 0);
  for (std::size_t r = 0; r < torus.rows; ++r) {
    for (std::size_t c = 0; c < torus.columns; ++c) mesh.add_face(torus.quad(c, r));
  }
  return mesh;
}

// Two quads side by side are a hexagon; its middle edge is turned to the next two corners.
ControlMesh irregular_quads(std::size_t faces, const Irregularity& options) {
  QuadTorus torus = torus_of(faces);
  torus.columns += torus.columns % 2;
  std::mt19937_64 random(options.seed);
  ControlMesh mesh;
  mesh.points =
      torus.points(options.jitter * 2 * std::numbers::pi / static_cast<double>(torus.rows), options.seed);
  std::vector<std::size_t> valence(mesh.points.size(), 4);
  for (std::size_t r = 0; r < torus.rows; ++r) {
    for (std::size_t c = r % 2; c < torus.columns + r % 2; c += 2) {
      const auto p = torus.quad(c, r), q = torus.quad(c + 1, r);
      // Of two quads one edge in four is inside such a hexagon.
      const bool turn =
          unit(random) < 8 * options.flips - 1 && valence[p[1].index()] > 3 && valence[p[2].index()] > 3;
      if (!turn) {
        mesh.add_face(p);
        mesh.add_face(q);
        continue;
      }
      mesh.add_face(std::array{p[0], p[1], q[1], p[3]});
      mesh.add_face(std::array{q[1], q[2], p[2], p[3]});
      for (const VertexId v : {p[1], p[2]}) --valence[v.index()];
      for (const VertexId v : {q[1], p[3]}) ++valence[v.index()];
    }
  }
  return mesh;
}

ControlMesh character_mesh(std::size_t faces, std::size_t creases) {
  const QuadTorus torus = torus_of(faces);
  std::mt19937_64 random(7);
  ControlMesh mesh;
  mesh.points = torus.points(0.01, 8);
  for (std::size_t r = 0; r < torus.rows; ++r) {
    for (std::size_t c = 0; c < torus.columns; ++c) {
      const auto q = torus.quad(c, r);
      const std::size_t lot = random() % 8;
      if (lot == 0) {
        mesh.add_face(std::array{q[0], q[1], q[2]});
        mesh.add_face(std::array{q[0], q[2], q[3]});
      } else if (lot == 1 && c + 1 < torus.columns) {
        const auto next = torus.quad(++c, r);
        mesh.add_face(std::array{q[0], q[1], next[1], next[2], q[2], q[3]});
      } else {
        mesh.add_face(q);
      }
    }
  }
  for (std::size_t count = 0; count < creases;) {
    const std::size_t kind = random() % 8, length = 5 + random() % 40;
    const double sharpness = kind == 0 ? infinite_sharpness : 0.5 * static_cast<double>(kind);
    std::size_t c = random() % torus.columns, r = random() % torus.rows;
    for (std::size_t step = 0; step < length; ++step, ++count) {
      const VertexId from = torus.vertex(c, r);
      (random() % 4 == 0 ? r : c) += 1;
      mesh.tags.creases.push_back({from, torus.vertex(c, r), sharpness});
    }
  }
  return mesh;
}

ControlMesh panelled_mesh(std::size_t faces) {
  constexpr unsigned levels = 2;
  ControlMesh mesh = irregular_mesh(faces / 12);
  std::mt19937_64 random(9);
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto corners = mesh.face(FaceId(f));
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexId a = corners[k], b = corners[(k + 1) % 3];
      if (a < b && random() % 10 == 0) mesh.tags.creases.push_back({a, b, 6.0 + levels});
    }
  }
  return subdivided(std::move(mesh), levels, false, {.scheme = Scheme::catmark});
}

ControlMesh many_sharpnesses(std::size_t count) {
  ControlMesh mesh = quad_torus(count);
  const QuadTorus torus = torus_of(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t c = i % torus.columns, r = i / torus.columns;
    const double sharpness = 4 * static_cast<double>(i + 1) / static_cast<double>(count + 1);
    mesh.tags.creases.push_back({torus.vertex(c, r), torus.vertex(c + 1, r), sharpness});
  }
  return mesh;
}

std::size_t extraordinary_corners(const Kind& kind) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < kind.rules().corners; ++i) count += !kind.regular_corner(i);
  return count;
}

std::vector<PatchId> faces_with(const LimitSurface& surface, std::size_t corners) {
  std::vector<PatchId> patches;
  for (std::size_t f = 0; f < surface.face_count(); ++f) {
    const PatchId p(surface.patches_of(f).begin);
    if (surface.has_patch(p) && extraordinary_corners(surface.kind(p)) == corners) patches.push_back(p);
  }
  return patches;
}

void print_statistics(const char* name, const LimitSurface& surface) {
  std::map<std::size_t, std::size_t> valences;
  for (std::size_t v = 0; v < surface.topology().vertex_count(); ++v) {
    ++valences[surface.topology().face_valence(VertexId(v))];
  }
  std::printf("mesh %s: %zu faces, %zu vertices, %zu kinds\n", name, surface.face_count(),
              surface.topology().vertex_count(), surface.kind_count());
  std::printf("  vertices by valence:");
  for (const auto& [valence, count] : valences) {
    std::printf("  %zu: %.1f %%", valence,
                100 * static_cast<double>(count) / static_cast<double>(surface.topology().vertex_count()));
  }
  std::printf("\n  faces by extraordinary corners:");
  for (std::size_t corners = 0; corners <= 3; ++corners) {
    std::printf("  %zu: %.1f %%", corners,
                100 * static_cast<double>(faces_with(surface, corners).size()) /
                    static_cast<double>(surface.face_count()));
  }
  std::printf("\n");
}

}  // namespace snug::bench
