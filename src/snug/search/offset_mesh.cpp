#include <snug/search/offset_mesh.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include <snug/search/feet.h>
#include <support/parallel.h>

namespace snug {
namespace {

using Index = std::uint32_t;
using Code = std::uint64_t;  // three whole numbers of 21 bits

constexpr Index no_index = UINT32_MAX;
constexpr unsigned code_bits = 21;
// Of a cube's edge: how far from its ends sheets cross it, so that two of them near a corner stay apart.
constexpr double least_share = 0.15;

Code code_of(Code x, Code y, Code z) { return x << 2 * code_bits | y << code_bits | z; }
std::array<Code, 3> parts_of(Code code) {
  constexpr Code mask = (Code{1} << code_bits) - 1;
  return {code >> 2 * code_bits, code >> code_bits & mask, code & mask};
}
// The corner of a cube by its number: bit a says whether it is the farther one along axis a.
Code corner(Code cube, unsigned i) {
  const auto [x, y, z] = parts_of(cube);
  return code_of(x + (i & 1u), y + (i >> 1 & 1u), z + (i >> 2));
}

// Numbers of codes, in the order in which they came.
class Numbers {
 public:
  // The number of a code, a new one if it has none.
  Index add(Code code) {
    if (2 * (codes_.size() + 1) > slots_.size()) grow();
    Index& slot = slots_[find(code)];
    if (slot == no_index) {
      slot = static_cast<Index>(codes_.size());
      codes_.push_back(code);
    }
    return slot;
  }
  // no_index if it has none.
  [[nodiscard]] Index of(Code code) const { return slots_.empty() ? no_index : slots_[find(code)]; }
  [[nodiscard]] const std::vector<Code>& codes() const { return codes_; }
  [[nodiscard]] std::size_t size() const { return codes_.size(); }

 private:
  [[nodiscard]] std::size_t find(Code code) const {
    std::size_t slot = (code * 0x9e3779b97f4a7c15u >> 36) & (slots_.size() - 1);
    while (slots_[slot] != no_index && codes_[slots_[slot]] != code) slot = (slot + 1) & (slots_.size() - 1);
    return slot;
  }
  void grow() {
    slots_.assign(std::max<std::size_t>(64, 2 * slots_.size()), no_index);
    for (std::size_t i = 0; i < codes_.size(); ++i) slots_[find(codes_[i])] = static_cast<Index>(i);
  }

  std::vector<Code> codes_;
  std::vector<Index> slots_;
};

// Edges of a cube, number 4 a + k along axis a, by their corners, the nearer one first.
constexpr std::array<std::array<std::uint8_t, 2>, 12> cube_edges{
    {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3}, {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
// Faces by their corners, around.
constexpr std::array<std::array<std::uint8_t, 4>, 6> cube_faces{
    {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}}};

constexpr std::uint8_t edge_between(std::uint8_t a, std::uint8_t b) {
  for (std::uint8_t e = 0; e < cube_edges.size(); ++e) {
    if ((cube_edges[e][0] == a && cube_edges[e][1] == b) || (cube_edges[e][0] == b && cube_edges[e][1] == a))
      return e;
  }
  return 12;
}
constexpr auto edges_of_faces = [] {
  std::array<std::array<std::uint8_t, 4>, 6> result{};
  for (std::size_t f = 0; f < 6; ++f) {
    for (std::size_t k = 0; k < 4; ++k)
      result[f][k] = edge_between(cube_faces[f][k], cube_faces[f][(k + 1) % 4]);
  }
  return result;
}();

// The sheets in a cube: which of them each edge belongs to that has one end inside.
struct Sheets {
  constexpr Sheets() = default;
  constexpr explicit Sheets(unsigned inside) {
    std::array<std::uint8_t, 12> parent{};
    for (std::uint8_t e = 0; e < 12; ++e) parent[e] = e;
    const auto root = [&](std::uint8_t e) {
      while (parent[e] != e) e = parent[e];
      return e;
    };
    const auto crossed = [&](std::uint8_t e) {
      return ((inside >> cube_edges[e][0] ^ inside >> cube_edges[e][1]) & 1u) != 0;
    };
    for (const auto& face : edges_of_faces) {
      std::uint8_t first = 12;
      for (const std::uint8_t e : face) {
        if (!crossed(e)) continue;
        if (first == 12) first = e;
        parent[root(first)] = root(e);
      }
    }
    std::array<std::uint8_t, 12> named{};
    named.fill(12);
    of_edge.fill(12);
    for (std::uint8_t e = 0; e < 12; ++e) {
      if (!crossed(e)) continue;
      std::uint8_t& name = named[root(e)];
      if (name == 12) name = count++;
      of_edge[e] = name;
    }
  }
  std::uint8_t count = 0;
  std::array<std::uint8_t, 12> of_edge{};  // 12 if it belongs to none
};
// By the corners inside, a bit each.
constexpr auto all_sheets = [] {
  std::array<Sheets, 256> result{};
  for (unsigned inside = 0; inside < 256; ++inside) result[inside] = Sheets(inside);
  return result;
}();

Box3 box_of(const PieceSet& set) {
  Box3 box;
  for (std::size_t i = 0; i < set.size(); ++i) {
    for (const Point3& p : points_of(set[i])) box.add(p);
  }
  return box;
}

class OffsetSampler {
 public:
  OffsetSampler(const PieceSet& set, const OffsetMeshOptions& options, const WorkMonitor& monitor)
      : set_(set), options_(options), monitor_(monitor) {
    const Box3 box = box_of(options.ball != nullptr ? options.ball->facets : set);
    const double beyond = (options.ball != nullptr ? options.ball->reach : options.offset) + 2 * options.cell;
    origin_ = box.lower - Vector3{beyond, beyond, beyond};
    const double side = longest_side(box) + 2 * beyond;
    while (options.cell * std::ldexp(1.0, static_cast<int>(levels_)) < side) ++levels_;
  }

  // False if there would be too many cubes.
  bool sample() {
    if (levels_ >= code_bits) return false;
    if (options_.ball == nullptr) return follow_outermost();
    if (!find_cubes()) return false;
    add_corners();
    add_values();
    return follow();
  }

  ClosedMesh mesh() {
    ClosedMesh made;
    // The sheets of each cube, and the vertex of the first one.
    std::vector<std::uint8_t> inside(cubes_.size());
    std::vector<Index> first(cubes_.size());
    for (std::size_t c = 0; c < cubes_.size(); ++c) {
      const Code cube = cubes_.codes()[c];
      std::array<float, 8> value;
      unsigned bits_inside = 0;
      for (unsigned i = 0; i < 8; ++i) {
        value[i] = values_[corners_of_[c][i]];
        bits_inside |= (value[i] <= 0 ? 1u : 0u) << i;
      }
      inside[c] = static_cast<std::uint8_t>(bits_inside);
      first[c] = static_cast<Index>(made.points.size());
      if (bits_inside == 0 || bits_inside == 255) continue;
      add_vertices(cube, all_sheets[bits_inside], value, made.points);
    }
    for (std::size_t c = 0; c < cubes_.size(); ++c) {
      if (inside[c] == 0 || inside[c] == 255) continue;
      for (unsigned axis = 0; axis < 3; ++axis) {
        const bool from_inside = (inside[c] & 1u) != 0;
        if (((inside[c] >> (1u << axis)) & 1u) == (from_inside ? 1u : 0u)) continue;
        add_square(c, axis, from_inside, inside, first, made);
      }
    }
    return made;
  }

 private:
  [[nodiscard]] Point3 place(Code code, double side, double shift) const {
    const auto [x, y, z] = parts_of(code);
    return origin_ + side * Vector3{static_cast<double>(x) + shift, static_cast<double>(y) + shift,
                                    static_cast<double>(z) + shift};
  }

  // Of points that lie side by side in order.
  std::vector<float> heights(std::size_t count, const std::function<Point3(std::size_t)>& point) const {
    std::vector<float> result(count);
    constexpr std::size_t block = 256;
    parallel_for((count + block - 1) / block, options_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) {
        monitor_.checkpoint();
        OffsetHeight at;
        for (std::size_t i = b * block; i < std::min(count, (b + 1) * block); ++i) {
          at = height_at(set_, options_.offset, options_.ball, point(i), at);
          result[i] = static_cast<float>(at.height);
        }
      }
    });
    return result;
  }

  // All cubes that the sheets in those there are pass, and those across their edges.
  bool follow() {
    // Corners that change make new cubes, whose faces may be crossed four times, and these may change corners.
    while (closed_ < cubes_.size()) {
      if (!close()) return false;
      part_sheets();
    }
    return true;
  }

  // The sheets around pieces that no sheet goes around yet, beginning with those farthest along the first axis: from a corner within
  // the offset to where the line through it along that axis comes out. What is enclosed is not looked at.
  bool follow_outermost() {
    std::vector<std::pair<double, std::uint32_t>> order;
    for (std::uint32_t i = 0; i < set_.size(); ++i) {
      const Triangle& t = set_[i].corners;
      order.emplace_back(-std::max({t[0].x, t[1].x, t[2].x}), i);
    }
    std::sort(order.begin(), order.end());
    // A corner that changes may open what was closed before.
    for (bool done = false; !done;) {
      done = true;
      add_crossings(0);
      for (const auto& [x, piece] : order) {
        const std::array<Code, 3> from = corner_beside(piece);
        if (is_enclosed(from)) continue;
        done = false;
        if (!follow_from(from)) return false;
      }
    }
    return true;
  }
  // The nearest corner to a piece's one that is farthest along the first axis: it is within the offset.
  [[nodiscard]] std::array<Code, 3> corner_beside(std::uint32_t piece) const {
    const Triangle& t = set_[piece].corners;
    const Point3& p =
        *std::max_element(t.begin(), t.end(), [](const Point3& a, const Point3& b) { return a.x < b.x; });
    std::array<Code, 3> at;
    for (std::size_t a = 0; a < 3; ++a)
      at[a] = static_cast<Code>(std::lround((p[a] - origin_[a]) / options_.cell));
    return at;
  }
  // False if there would be too many cubes, or no sheet goes around it.
  bool follow_from(std::array<Code, 3> at) {
    const std::array<Code, 3> from = at;
    double here = value_at(at);
    for (const Code end = Code{1} << levels_; at[0] < end; ++at[0]) {
      const double next = value_at({at[0] + 1, at[1], at[2]});
      if (here <= 0 && next > 0) {
        const std::size_t known = cubes_.size();
        cubes_.add(code_of(at[0], at[1], at[2]));
        add_corners();
        add_values();
        if (!follow()) return false;
        add_crossings(known);
        if (is_enclosed(from)) return true;
      }
      here = next;
    }
    return false;
  }
  double value_at(const std::array<Code, 3>& at) {
    const Index corner = corners_.add(code_of(at[0], at[1], at[2]));
    add_values();
    return static_cast<double>(values_[corner]);
  }
  // Is a corner within an odd number of sheets, counted along the first axis?
  [[nodiscard]] bool is_enclosed(const std::array<Code, 3>& at) const {
    const Index line = lines_.of(code_of(0, at[1], at[2]));
    if (line == no_index) return false;
    const std::vector<Code>& crossings = crossings_[line];
    return std::count_if(crossings.begin(), crossings.end(), [&](Code x) { return x >= at[0]; }) % 2 != 0;
  }
  // Where sheets in cubes from that one on pass edges along the first axis; from the first one on anew.
  void add_crossings(std::size_t first) {
    if (first == 0) crossings_.assign(crossings_.size(), {});
    for (std::size_t c = first; c < cubes_.size(); ++c) {
      const std::array<Index, 8>& corners = corners_of_[c];
      if ((values_[corners[0]] <= 0) == (values_[corners[1]] <= 0)) continue;
      const auto [x, y, z] = parts_of(cubes_.codes()[c]);
      const Index line = lines_.add(code_of(0, y, z));
      crossings_.resize(lines_.size());
      crossings_[line].push_back(x);
    }
  }

  // Cubes that the offset may pass, from one that holds all down to those wanted.
  bool find_cubes() {
    std::vector<Code> open{0};
    for (unsigned level = levels_; level > 0; --level) {
      const double side = options_.cell * std::ldexp(1.0, static_cast<int>(level));
      const std::vector<float> far =
          heights(open.size(), [&](std::size_t i) { return place(open[i], side, 0.5); });
      std::vector<Code> next;
      for (std::size_t i = 0; i < open.size(); ++i) {
        // Half a diagonal, and what errors of the set and of single precision come to.
        if (std::fabs(static_cast<double>(far[i])) > 0.87 * side) continue;
        const auto [x, y, z] = parts_of(open[i]);
        for (unsigned k = 0; k < 8; ++k) next.push_back(corner(code_of(2 * x, 2 * y, 2 * z), k));
      }
      open = std::move(next);
      if (open.size() > options_.most_cells) return false;
    }
    for (const Code code : open) cubes_.add(code);
    return true;
  }
  // Of cubes that are new.
  void add_corners() {
    while (corners_of_.size() < cubes_.size()) {
      const Code cube = cubes_.codes()[corners_of_.size()];
      std::array<Index, 8>& names = corners_of_.emplace_back();
      for (unsigned i = 0; i < 8; ++i) names[i] = corners_.add(corner(cube, i));
    }
  }
  void add_values() {
    const std::size_t known = values_.size();
    const std::vector<float> added = heights(corners_.size() - known, [&](std::size_t i) {
      return place(corners_.codes()[known + i], options_.cell, 0);
    });
    values_.insert(values_.end(), added.begin(), added.end());
  }

  // Adds the four cubes around each edge that is crossed: distances that were found may be larger than the least, so that one was
  // left out. False if they become too many.
  bool close() {
    while (closed_ < cubes_.size()) {
      monitor_.checkpoint();
      for (const std::size_t end = cubes_.size(); closed_ < end; ++closed_) {
        const std::array<Index, 8> corners = corners_of_[closed_];
        const std::array<Code, 3> first = parts_of(cubes_.codes()[closed_]);
        for (std::size_t e = 0; e < 12; ++e) {
          const auto [a, b] = cube_edges[e];
          if ((values_[corners[a]] <= 0) == (values_[corners[b]] <= 0)) continue;
          const std::size_t u = (e / 4 + 1) % 3, v = (e / 4 + 2) % 3;
          for (unsigned k = 0; k < 4; ++k) {
            std::array<Code, 3> at = first;
            at[u] = at[u] + (a >> u & 1u) - (k & 1u);
            at[v] = at[v] + (a >> v & 1u) - (k >> 1);
            cubes_.add(code_of(at[0], at[1], at[2]));
          }
        }
      }
      if (cubes_.size() > 2 * options_.most_cells + 1000) return false;
      add_corners();
      add_values();
    }
    return true;
  }

  // No face of a cube has both ends of one diagonal inside and both of the other outside: the nearer of these counts as
  // inside. Then a face has one sheet, and the mesh two triangles at an edge.
  void part_sheets() {
    std::vector<Index> open(cubes_.size() - parted_);
    std::iota(open.begin(), open.end(), static_cast<Index>(parted_));
    while (!open.empty()) {
      const std::array<Index, 8> corners = corners_of_[open.back()];
      open.pop_back();
      for (const auto& face : cube_faces) {
        std::array<Index, 4> at;
        std::array<bool, 4> in;
        for (std::size_t k = 0; k < 4; ++k) {
          at[k] = corners[face[k]];
          in[k] = values_[at[k]] <= 0;
        }
        if (in[0] != in[2] || in[1] != in[3] || in[0] == in[1]) continue;
        const std::size_t k = in[0] ? 1 : 0;
        const Index nearer = values_[at[k]] <= values_[at[k + 2]] ? at[k] : at[k + 2];
        values_[nearer] = static_cast<float>(-1e-3 * options_.cell);
        const auto [x, y, z] = parts_of(corners_.codes()[nearer]);
        for (unsigned i = 0; i < 8; ++i) {
          const Code around = code_of(x - (i & 1u), y - (i >> 1 & 1u), z - (i >> 2));
          open.push_back(cubes_.add(around));
        }
        add_corners();
        add_values();
      }
    }
    parted_ = cubes_.size();
  }

  // For each sheet the middle of where edges cross it.
  void add_vertices(Code cube, const Sheets& sheets, const std::array<float, 8>& value,
                    std::vector<Point3>& points) const {
    std::array<Vector3, 4> sum{};
    std::array<int, 4> count{};
    for (std::size_t e = 0; e < 12; ++e) {
      const std::size_t sheet = sheets.of_edge[e];
      if (sheet == 12) continue;
      const auto [a, b] = cube_edges[e];
      Vector3 at{static_cast<double>(a & 1), static_cast<double>(a >> 1 & 1), static_cast<double>(a >> 2)};
      const double crossing =
          static_cast<double>(value[a]) / (static_cast<double>(value[a]) - static_cast<double>(value[b]));
      at[e / 4] = std::clamp(crossing, least_share, 1 - least_share);
      sum[sheet] = sum[sheet] + at;
      ++count[sheet];
    }
    for (std::size_t s = 0; s < sheets.count; ++s) {
      points.push_back(place(cube, options_.cell, 0) + (options_.cell / count[s]) * sum[s]);
    }
  }

  // Two triangles across the edge along `axis` at the first corner of cube c, between the four cubes around it.
  void add_square(std::size_t c, unsigned axis, bool from_inside, const std::vector<std::uint8_t>& inside,
                  const std::vector<Index>& first, ClosedMesh& made) const {
    const unsigned u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::array<Index, 4> ring;
    constexpr std::array<std::array<unsigned, 2>, 4> around{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    for (std::size_t k = 0; k < 4; ++k) {
      std::array<Code, 3> at = parts_of(cubes_.codes()[c]);
      at[u] -= around[k][0];
      at[v] -= around[k][1];
      const Index cube = cubes_.of(code_of(at[0], at[1], at[2]));
      const std::uint8_t from = static_cast<std::uint8_t>(around[k][0] << u | around[k][1] << v);
      const std::uint8_t e = edge_between(from, static_cast<std::uint8_t>(from | 1u << axis));
      ring[k] = first[cube] + all_sheets[inside[cube]].of_edge[e];
    }
    if (!from_inside) std::swap(ring[1], ring[3]);
    const auto length = [&](std::size_t k) {
      return distance(made.points[ring[k]], made.points[ring[k + 2]]);
    };
    const std::size_t k = length(0) <= length(1) ? 0 : 1;
    made.triangles.push_back({ring[k], ring[k + 1], ring[k + 2]});
    made.triangles.push_back({ring[k], ring[k + 2], ring[(k + 3) % 4]});
  }

  const PieceSet& set_;
  const OffsetMeshOptions& options_;
  const WorkMonitor& monitor_;
  Point3 origin_;
  unsigned levels_ = 0;
  Numbers cubes_, corners_;
  std::vector<std::array<Index, 8>> corners_of_;  // of each cube
  std::size_t closed_ = 0;                        // of cubes: those around all their crossed edges are there
  std::size_t parted_ = 0;                        // and no face of theirs is crossed four times
  std::vector<float> values_;                     // of corners: distance less the offset
  Numbers lines_;                                 // along the first axis that sheets pass
  std::vector<std::vector<Code>> crossings_;      // of each line: the cubes where they do
};

// Whole shells of a mesh: which of them each vertex belongs to.
struct Shells {
  explicit Shells(const ClosedMesh& mesh) : of_vertex(mesh.points.size()) {
    std::iota(of_vertex.begin(), of_vertex.end(), Index{0});
    const auto root = [&](Index v) {
      while (of_vertex[v] != v) v = of_vertex[v] = of_vertex[of_vertex[v]];
      return v;
    };
    for (const auto& t : mesh.triangles) {
      for (std::size_t k = 1; k < 3; ++k) of_vertex[root(t[k])] = root(t[0]);
    }
    std::vector<Index> names(of_vertex.size(), no_index);
    for (Index v = 0; v < of_vertex.size(); ++v) {
      Index& name = names[root(v)];
      if (name == no_index) name = count++;
    }
    std::vector<Index> named(of_vertex.size());
    for (Index v = 0; v < of_vertex.size(); ++v) named[v] = names[root(v)];
    of_vertex = std::move(named);
  }
  std::vector<Index> of_vertex;
  Index count = 0;
};

// How much of the sphere around p a triangle hides [VanOosterom83].
double solid_angle(const ClosedMesh& mesh, const std::array<Index, 3>& t, const Point3& p) {
  const Vector3 a = mesh.points[t[0]] - p, b = mesh.points[t[1]] - p, c = mesh.points[t[2]] - p;
  const double la = length(a), lb = length(b), lc = length(c);
  return 2 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

// Does a closed mesh go around a point? Not told where it is within rounding.
template <class Triangles>
bool goes_around(const ClosedMesh& mesh, const Triangles& triangles, const Point3& p) {
  double angle = 0;
  for (const auto& t : triangles) angle += solid_angle(mesh, t, p);
  return angle > 6.28;
}

// Leaves out shells that face inward, those inside of others, and what is where a ball's centre gets to: too far from its mesh, too, but
// on the other side.
void keep_outermost(ClosedMesh& mesh, const RollingBall* ball, const WorkMonitor& monitor) {
  const Shells shells(mesh);
  std::vector<double> volume(shells.count);
  std::vector<Box3> box(shells.count);
  std::vector<std::vector<std::array<Index, 3>>> triangles(shells.count);
  std::vector<Point3> point(shells.count);
  for (Index i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    const Index s = shells.of_vertex[t[0]];
    const Point3 o = mesh.points[0];
    volume[s] += dot(mesh.points[t[0]] - o, cross(mesh.points[t[1]] - o, mesh.points[t[2]] - o));
    for (const Index v : t) box[s].add(mesh.points[v]);
    triangles[s].push_back(t);
    point[s] = mesh.points[t[0]];
  }
  const auto inside = [&](Index s, Index other) {
    for (std::size_t a = 0; a < 3; ++a) {
      if (point[s][a] < box[other].lower[a] || point[s][a] > box[other].upper[a]) return false;
    }
    return goes_around(mesh, triangles[other], point[s]);
  };
  std::vector<std::uint8_t> kept(shells.count);
  for (Index s = 0; s < shells.count; ++s) {
    monitor.checkpoint();
    kept[s] =
        volume[s] > 0 && (ball == nullptr || goes_around(ball->around, ball->around.triangles, point[s]));
    for (Index other = 0; other < shells.count && kept[s] != 0; ++other) {
      if (other != s && volume[other] > volume[s] && inside(s, other)) kept[s] = 0;
    }
  }
  std::erase_if(mesh.triangles, [&](const auto& t) { return kept[shells.of_vertex[t[0]]] == 0; });
  drop_unused_points(mesh);
}

}  // namespace

RollingBall::RollingBall(ClosedMesh mesh, double how_far, int threads)
    : around(std::move(mesh)), reach(how_far) {
  Blocks<QuadraticTriangle> all;
  for (const auto& [a, b, c] : around.triangles) {
    all.push_back(flat_quadratic({around.points[a], around.points[b], around.points[c]}));
  }
  facets = PieceSet(std::move(all));
  facets.prepare(threads);
}

OffsetHeight height_at(const PieceSet& set, double offset, const RollingBall* ball, const Point3& p,
                       const OffsetHeight& hint) {
  OffsetHeight at;
  at.height = INFINITY;
  if (ball != nullptr) {
    at.centre = nearest_foot(ball->facets, p, hint.centre);
    at.height = ball->reach - at.centre.distance;
    // Nowhere is a distance less.
    if (at.height <= -offset) return at;
  }
  at.foot = nearest_foot(set, p, hint.foot);
  at.height = std::min(at.height, at.foot.distance - offset);
  return at;
}

std::optional<ClosedMesh> offset_mesh(const PieceSet& set, const OffsetMeshOptions& options,
                                      const WorkMonitor& monitor) {
  OffsetSampler sampler(set, options, monitor);
  if (!sampler.sample()) return std::nullopt;
  ClosedMesh mesh = sampler.mesh();
  keep_outermost(mesh, options.ball, monitor);
  return mesh;
}

}  // namespace snug
