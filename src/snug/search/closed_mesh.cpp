#include <snug/search/closed_mesh.h>

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>
#include <unordered_map>
#include <utility>

#include <snug/search/piece.h>
#include <support/parallel.h>
#include <support/point.h>

namespace snug {
namespace {

using Index = std::uint32_t;
using Names = std::array<Index, 3>;

constexpr Index no_vertex = UINT32_MAX;
// Of the sum of a quadric's weights: how much a vertex is drawn to the middle where planes leave it free.
constexpr double pull = 1e-3;
// The least cosine between a triangle and what it becomes.
constexpr double least_cosine = 0.5;
// Meshes with as many triangles are collapsed in as many blocks of vertices first, side by side; then as a whole.
constexpr std::size_t least_in_blocks = 8'000;
constexpr Index block_count = 32;

// The weighted sum of the squares of the distances from planes.
class Quadric {
 public:
  Quadric() = default;
  Quadric(const Vector3& normal, double at, double weight)
      : xx_{weight * normal.x * normal.x, weight * normal.y * normal.y, weight * normal.z * normal.z},
        xy_{weight * normal.y * normal.z, weight * normal.z * normal.x, weight * normal.x * normal.y},
        x_((-weight * at) * normal),
        one_(weight * at * at),
        weight_(weight) {}
  Quadric& operator+=(const Quadric& q) {
    xx_ = xx_ + q.xx_;
    xy_ = xy_ + q.xy_;
    x_ = x_ + q.x_;
    one_ += q.one_;
    weight_ += q.weight_;
    return *this;
  }
  // The mean square of the distances of p.
  [[nodiscard]] double at(const Vector3& p) const {
    return std::max(0.0, dot(p, times(rows(0), p) + 2 * x_) + one_) / weight_;
  }
  // Where it is least, drawn to `middle`.
  [[nodiscard]] Vector3 least(const Vector3& middle) const {
    const Rows3 m = rows(pull * weight_);
    const Vector3 right = pull * weight_ * middle - x_;
    const Vector3 a = cross(m[1], m[2]), b = cross(m[2], m[0]), c = cross(m[0], m[1]);
    return (1 / dot(m[0], a)) * (right.x * a + right.y * b + right.z * c);
  }

 private:
  [[nodiscard]] Rows3 rows(double more) const {
    return {Vector3{xx_.x + more, xy_.z, xy_.y}, Vector3{xy_.z, xx_.y + more, xy_.x},
            Vector3{xy_.y, xy_.x, xx_.z + more}};
  }

  Vector3 xx_, xy_, x_;
  double one_ = 0, weight_ = 0;
};

class Simplifier {
 public:
  Simplifier(ClosedMesh& mesh, double error, const std::function<bool(const Triangle&)>& accept,
             std::span<const std::uint8_t> kept)
      : mesh_(mesh),
        accept_(accept),
        kept_(kept),
        most_(error * error),
        around_(mesh.points.size()),
        quadrics_(mesh.points.size()),
        age_(mesh.points.size()),
        marks_(mesh.points.size()) {
    std::vector<Index> valence(mesh.points.size());
    for (const Names& names : mesh.triangles) {
      for (const Index v : names) ++valence[v];
    }
    for (Index v = 0; v < valence.size(); ++v) around_[v].reserve(valence[v] + 2);
    for (Index t = 0; t < mesh.triangles.size(); ++t) {
      const Names& names = mesh.triangles[t];
      const Vector3 area = area_of(names);
      const double size = length(area);
      for (const Index v : names) around_[v].push_back(t);
      if (!(size > 0)) continue;
      const Vector3 normal = (1 / size) * area;
      const Quadric plane(normal, dot(normal, at(names[0])), size);
      for (const Index v : names) quadrics_[v] += plane;
    }
  }

  void run(int threads, const WorkMonitor& monitor) {
    if (mesh_.triangles.size() > least_in_blocks) {
      std::vector<Pass> passes(block_count);
      for (Index i = 0; i < block_count; ++i) passes[i].block = i;
      visit_edges([&](Index a, Index b) {
        if (block_of(a) == block_of(b)) passes[block_of(a)].edges.emplace_back(a, b);
      });
      parallel_for(block_count, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) collapse_all(passes[i], monitor);
      });
    }
    Pass whole;
    visit_edges([&](Index a, Index b) { whole.edges.emplace_back(a, b); });
    std::fill(marks_.begin(), marks_.end(), 0);
    collapse_all(whole, monitor);
    std::erase_if(mesh_.triangles, [](const Names& t) { return t[0] == no_vertex; });
    drop_unused_points(mesh_);
  }

 private:
  struct Offer {
    double cost;
    Index a, b, age;
    // The cheapest first; then by names, so that the order is the same everywhere.
    friend bool operator<(const Offer& x, const Offer& y) {
      return std::tie(x.cost, x.a, x.b) > std::tie(y.cost, y.a, y.b);
    }
  };

  // Edges of one block, and what is looked at for one question at a time.
  struct Pass {
    Index block = block_count;                     // all of the mesh
    std::vector<std::pair<Index, Index>> edges{};  // at first
    std::priority_queue<Offer> queue{};
    Index mark = 0;
  };

  template <class Visit>
  void visit_edges(const Visit& visit) const {
    for (const Names& t : mesh_.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (t[k] < t[(k + 1) % 3]) visit(t[k], t[(k + 1) % 3]);
      }
    }
  }

  // By the names of vertices, which lie side by side in order.
  [[nodiscard]] Index block_of(Index v) const {
    return static_cast<Index>(std::uint64_t{v} * block_count / mesh_.points.size());
  }
  // Passes of different blocks have no vertex in common that they read or write.
  [[nodiscard]] bool is_in(const Pass& pass, Index v) const {
    return pass.block == block_count || block_of(v) == pass.block;
  }
  [[nodiscard]] bool is_within(const Pass& pass, Index v) const {
    if (pass.block == block_count) return true;
    bool within = true;
    visit_neighbours(v, [&](Index w) { within = within && is_in(pass, w); });
    return within;
  }

  void collapse_all(Pass& pass, const WorkMonitor& monitor) {
    for (const auto& [a, b] : pass.edges) offer(pass, a, b);
    pass.edges = {};
    for (std::size_t n = 0; !pass.queue.empty(); ++n) {
      if (n % 1024 == 0) monitor.checkpoint();
      const Offer best = pass.queue.top();
      pass.queue.pop();
      if (best.age != age_[best.a] + age_[best.b] || around_[best.a].empty() || around_[best.b].empty())
        continue;
      if (!is_within(pass, best.a) || !is_within(pass, best.b)) continue;
      Quadric sum = quadrics_[best.a];
      sum += quadrics_[best.b];
      if (const Vector3 to = place(best.a, best.b, sum); can_collapse(pass, best, to))
        collapse(pass, best, to);
    }
  }

  [[nodiscard]] Vector3 at(Index v) const { return mesh_.points[v] - Point3{}; }
  [[nodiscard]] Vector3 area_of(const Names& t) const {
    return cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]));
  }

  void offer(Pass& pass, Index a, Index b) {
    if (!is_in(pass, a) || !is_in(pass, b)) return;
    if (!kept_.empty() && (kept_[a] != 0 || kept_[b] != 0)) return;
    Quadric sum = quadrics_[a];
    sum += quadrics_[b];
    const Vector3 to = place(a, b, sum);
    if (!is_finite(to)) return;
    const double cost = sum.at(to);
    // Of those that cost nothing the shortest first, not all at one vertex.
    if (cost <= most_) pass.queue.push({cost + most_ * length_sq(at(b) - at(a)), a, b, age_[a] + age_[b]});
  }
  // Where the vertex goes that an edge becomes; NaN where there is no such place.
  [[nodiscard]] Vector3 place(Index a, Index b, const Quadric& sum) const {
    return sum.least(0.5 * (at(a) + at(b)));
  }

  // Calls visit(w) for each vertex on an edge from v, once.
  template <class Visit>
  void visit_neighbours(Index v, const Visit& visit) const {
    for (const Index t : around_[v]) {
      const Names& names = mesh_.triangles[t];
      // Triangles around v are one fan: each neighbour comes after v in one of them.
      visit(names[0] == v ? names[1] : names[1] == v ? names[2] : names[0]);
    }
  }

  [[nodiscard]] bool can_collapse(Pass& pass, const Offer& offer, const Vector3& to) {
    // Only the two vertices across the edge are neighbours of both, and they keep three.
    ++pass.mark;
    visit_neighbours(offer.a, [&](Index v) { marks_[v] = pass.mark; });
    int common = 0;
    bool keeps_three = true;
    visit_neighbours(offer.b, [&](Index v) {
      if (marks_[v] != pass.mark) return;
      ++common;
      keeps_three = keeps_three && around_[v].size() > 3;
    });
    if (common != 2 || !keeps_three) return false;
    std::vector<Triangle> made;
    for (const auto& [moved, other] : {std::pair(offer.a, offer.b), std::pair(offer.b, offer.a)}) {
      for (const Index t : around_[moved]) {
        const Names& names = mesh_.triangles[t];
        if (std::find(names.begin(), names.end(), other) != names.end()) continue;
        std::array<Vector3, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) corners[k] = names[k] == moved ? to : at(names[k]);
        const Vector3 before = area_of(names),
                      after = cross(corners[1] - corners[0], corners[2] - corners[0]);
        if (!(dot(before, after) > least_cosine * length(before) * length(after))) return false;
        if (accept_) made.push_back({Point3{} + corners[0], Point3{} + corners[1], Point3{} + corners[2]});
      }
    }
    return made.empty() || std::all_of(made.begin(), made.end(), std::cref(accept_));
  }

  void collapse(Pass& pass, const Offer& offer, const Vector3& to) {
    const Index a = offer.a, b = offer.b;
    mesh_.points[a] = Point3{} + to;
    quadrics_[a] += quadrics_[b];
    for (const Index t : around_[b]) {
      Names& names = mesh_.triangles[t];
      if (std::find(names.begin(), names.end(), a) == names.end()) {
        std::replace(names.begin(), names.end(), b, a);
        around_[a].push_back(t);
        continue;
      }
      for (const Index v : names) {
        if (v != b) std::erase(around_[v], t);
      }
      names = {no_vertex, no_vertex, no_vertex};
    }
    around_[b].clear();
    age_[a] = age_[a] + age_[b] + 1;
    visit_neighbours(a, [&](Index v) { this->offer(pass, std::min(a, v), std::max(a, v)); });
  }

  ClosedMesh& mesh_;
  const std::function<bool(const Triangle&)>& accept_;
  std::span<const std::uint8_t> kept_;
  double most_;
  std::vector<std::vector<Index>> around_;  // triangles of each vertex
  std::vector<Quadric> quadrics_;
  std::vector<Index> age_;    // grows when the vertex moves: older offers are void
  std::vector<Index> marks_;  // of vertices, for one question of a pass at a time
};

}  // namespace

void drop_unused_points(ClosedMesh& mesh) {
  std::vector<Index> name(mesh.points.size(), no_vertex);
  std::vector<Point3> used;
  for (Names& t : mesh.triangles) {
    for (Index& v : t) {
      if (name[v] == no_vertex) {
        name[v] = static_cast<Index>(used.size());
        used.push_back(mesh.points[v]);
      }
      v = name[v];
    }
  }
  mesh.points = std::move(used);
}

bool is_manifold(const ClosedMesh& mesh) {
  std::unordered_map<std::uint64_t, Index> next;  // of an edge: the vertex after it in its triangle
  next.reserve(3 * mesh.triangles.size());
  const auto side = [](Index from, Index to) { return std::uint64_t{from} << 32 | to; };
  std::vector<Index> valence(mesh.points.size()), neighbour(mesh.points.size(), no_vertex);
  for (const Names& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!next.emplace(side(t[k], t[(k + 1) % 3]), t[(k + 2) % 3]).second) return false;
      ++valence[t[k]];
      neighbour[t[k]] = t[(k + 1) % 3];
    }
  }
  for (Index v = 0; v < valence.size(); ++v) {
    if (valence[v] == 0) continue;
    Index count = 0, at = neighbour[v];
    do {
      const auto found = next.find(side(v, at));
      if (found == next.end() || !next.contains(side(at, v))) return false;
      at = found->second;
    } while (++count < valence[v] && at != neighbour[v]);
    if (count != valence[v] || at != neighbour[v]) return false;
  }
  return true;
}

void simplify(ClosedMesh& mesh, double error, const std::function<bool(const Triangle&)>& accept,
              std::span<const std::uint8_t> kept, int threads, const WorkMonitor& monitor) {
  Simplifier(mesh, error, accept, kept).run(threads, monitor);
}

std::vector<Index> halve_longest_sides(ClosedMesh& mesh, std::vector<std::uint8_t>& marks) {
  const auto side = [](Index from, Index to) { return std::uint64_t{from} << 32 | to; };
  // Sides between vertices of marked triangles: the others are not asked for.
  std::vector<std::uint8_t> is_asked(mesh.points.size());
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    for (const Index v : mesh.triangles[t]) {
      if (marks[t] == 1) is_asked[v] = 1;
    }
  }
  std::unordered_map<std::uint64_t, Index> of_side;
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      if (is_asked[a] != 0 && is_asked[b] != 0) of_side[side(a, b)] = t;
    }
  }
  // The longest of all first: no triangle waits for ever while others beside it are cut.
  std::vector<std::tuple<double, Index, std::size_t>> order;
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    if (marks[t] != 1) continue;
    const Names& names = mesh.triangles[t];
    const std::size_t k = longest_side({mesh.points[names[0]], mesh.points[names[1]], mesh.points[names[2]]});
    order.emplace_back(-distance(mesh.points[names[k]], mesh.points[names[(k + 1) % 3]]), t, k);
  }
  std::sort(order.begin(), order.end());
  std::vector<std::uint8_t> is_cut(mesh.triangles.size());
  std::vector<Index> added;
  for (const auto& [length, t, k] : order) {
    if (is_cut[t] != 0) continue;
    const Names names = mesh.triangles[t];
    const Index a = names[k], b = names[(k + 1) % 3], other = of_side.at(side(b, a));
    if (is_cut[other] != 0) continue;
    const auto middle = static_cast<Index>(mesh.points.size());
    mesh.points.push_back(mesh.points[a] + 0.5 * (mesh.points[b] - mesh.points[a]));
    added.push_back(middle);
    for (const Index cut : {t, other}) {
      // One half keeps the corner a, the other one b.
      Names half = mesh.triangles[cut];
      std::replace(half.begin(), half.end(), a, middle);
      std::replace(mesh.triangles[cut].begin(), mesh.triangles[cut].end(), b, middle);
      mesh.triangles.push_back(half);
      marks[cut] = marks[t];
      marks.push_back(marks[cut]);
      is_cut[cut] = 1;
    }
  }
  return added;
}

}  // namespace snug
