#include <snug/search/closed_mesh.h>

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>
#include <unordered_map>
#include <utility>

#include <snug/search/piece.h>
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

  void run(const WorkMonitor& monitor) {
    for (const Names& t : mesh_.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (t[k] < t[(k + 1) % 3]) offer(t[k], t[(k + 1) % 3]);
      }
    }
    for (std::size_t n = 0; !queue_.empty(); ++n) {
      if (n % 1024 == 0) monitor.checkpoint();
      const Offer best = queue_.top();
      queue_.pop();
      if (best.age != age_[best.a] + age_[best.b] || around_[best.a].empty() || around_[best.b].empty())
        continue;
      Quadric sum = quadrics_[best.a];
      sum += quadrics_[best.b];
      if (const Vector3 to = place(best.a, best.b, sum); can_collapse(best, to)) collapse(best, to);
    }
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

  [[nodiscard]] Vector3 at(Index v) const { return mesh_.points[v] - Point3{}; }
  [[nodiscard]] Vector3 area_of(const Names& t) const {
    return cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]));
  }

  void offer(Index a, Index b) {
    if (!kept_.empty() && (kept_[a] != 0 || kept_[b] != 0)) return;
    Quadric sum = quadrics_[a];
    sum += quadrics_[b];
    const Vector3 to = place(a, b, sum);
    if (!is_finite(to)) return;
    const double cost = sum.at(to);
    if (cost <= most_) queue_.push({cost, a, b, age_[a] + age_[b]});
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

  [[nodiscard]] bool can_collapse(const Offer& offer, const Vector3& to) {
    // Only the two vertices across the edge are neighbours of both, and they keep three.
    ++mark_;
    visit_neighbours(offer.a, [&](Index v) { marks_[v] = mark_; });
    int common = 0;
    bool keeps_three = true;
    visit_neighbours(offer.b, [&](Index v) {
      if (marks_[v] != mark_) return;
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

  void collapse(const Offer& offer, const Vector3& to) {
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
    visit_neighbours(a, [&](Index v) { this->offer(std::min(a, v), std::max(a, v)); });
  }

  ClosedMesh& mesh_;
  const std::function<bool(const Triangle&)>& accept_;
  std::span<const std::uint8_t> kept_;
  double most_;
  std::vector<std::vector<Index>> around_;  // triangles of each vertex
  std::vector<Quadric> quadrics_;
  std::vector<Index> age_;    // grows when the vertex moves: older offers are void
  std::vector<Index> marks_;  // of vertices, for one question at a time
  Index mark_ = 0;
  std::priority_queue<Offer> queue_;
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
              std::span<const std::uint8_t> kept, const WorkMonitor& monitor) {
  Simplifier(mesh, error, accept, kept).run(monitor);
}

std::vector<Index> halve_longest_sides(ClosedMesh& mesh, std::vector<std::uint8_t>& marks) {
  const auto side = [](Index from, Index to) { return std::uint64_t{from} << 32 | to; };
  std::unordered_map<std::uint64_t, Index> of_side;
  of_side.reserve(3 * mesh.triangles.size());
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k)
      of_side[side(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3])] = t;
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
