#include "simplify.h"

#include <algorithm>
#include <array>
#include <queue>
#include <tuple>

namespace models {

namespace {

/// Sum of squared distances to planes.
struct Quadric {
  std::array<double, 10> q{};

  void add_plane(const Vec3& n, double offset, double weight) {
    const std::array<double, 4> h = {n.x, n.y, n.z, offset};
    std::size_t at = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i; j < 4; ++j) q[at++] += weight * h[i] * h[j];
    }
  }
  void add(const Quadric& other) {
    for (std::size_t i = 0; i < 10; ++i) q[i] += other.q[i];
  }
  double operator()(const Vec3& p) const {
    return p.x * (q[0] * p.x + 2 * (q[1] * p.y + q[2] * p.z + q[3])) +
           p.y * (q[4] * p.y + 2 * (q[5] * p.z + q[6])) + p.z * (q[7] * p.z + 2 * q[8]) + q[9];
  }
};

struct Candidate {
  double cost;
  Index gone, kept;
  std::uint32_t age;  ///< sum of both vertices' edit counts when the cost was found

  bool operator>(const Candidate& other) const {
    return std::tie(cost, gone, kept, age) > std::tie(other.cost, other.gone, other.kept, other.age);
  }
};

class Simplifier {
 public:
  Simplifier(const HalfMesh& half, const SculptOptions& options)
      : half_(half),
        options_(options),
        around_(half.mesh.points.size()),
        edits_(half.mesh.points.size(), 0),
        errors_(half.mesh.points.size()),
        alive_(half.mesh.faces.size(), true),
        count_(half.mesh.faces.size()) {
    for (std::size_t f = 0; f < half_.mesh.faces.size(); ++f) {
      const Triangle& face = half_.mesh.faces[f];
      const Vec3 a = half_.mesh.points[face[0]];
      const Vec3 n = normal(face, face[0], a);
      Quadric plane;
      plane.add_plane(unit(n), -dot(unit(n), a), length(n));
      for (const Index v : face) {
        around_[v].push_back(static_cast<Index>(f));
        errors_[v].add(plane);
      }
    }
    for (std::size_t v = 0; v < around_.size(); ++v) offer_around(static_cast<Index>(v), true);
  }

  HalfMesh run() {
    while (count_ > options_.faces / 2 && !queue_.empty()) {
      const Candidate best = queue_.top();
      queue_.pop();
      if (around_[best.gone].empty() || around_[best.kept].empty()) continue;
      if (edits_[best.gone] + edits_[best.kept] != best.age) continue;
      collapse(best.gone, best.kept);
    }
    return packed();
  }

 private:
  std::vector<Index> ring(Index v) const {
    std::vector<Index> result;
    for (const Index f : around_[v]) {
      for (const Index w : half_.mesh.faces[f]) {
        if (w != v) result.push_back(w);
      }
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

  Vec3 normal(const Triangle& face, Index moved, const Vec3& to) const {
    const auto at = [&](std::size_t k) { return face[k] == moved ? to : half_.mesh.points[face[k]]; };
    return cross(at(1) - at(0), at(2) - at(0));
  }

  /// Cheapest of the places the merged vertex may take.
  std::pair<double, Vec3> merged(Index gone, Index kept) const {
    const Vec3 a = half_.mesh.points[gone], b = half_.mesh.points[kept];
    Quadric sum = errors_[gone];
    sum.add(errors_[kept]);
    const double edge_sq = length_sq(a - b);
    const double extra = options_.importance(0.5 * (a + b)) * (1e-6 + edge_sq * edge_sq);
    std::pair<double, Vec3> best = {sum(b), b};
    if (half_.planes[gone] == half_.planes[kept]) {
      for (const Vec3& p : {0.5 * (a + b), a}) {
        if (sum(p) < best.first) best = {sum(p), p};
      }
    }
    best.first = std::max(best.first, 0.0) * options_.importance(best.second) + 0.05 * extra;
    return best;
  }

  void offer_around(Index v, bool once) {
    for (const Index w : ring(v)) {
      if (once && w < v) continue;
      const std::uint8_t a = half_.planes[v], b = half_.planes[w];
      if ((a & b) == a) queue_.push({merged(v, w).first, v, w, edits_[v] + edits_[w]});
      if ((a & b) == b && a != b) queue_.push({merged(w, v).first, w, v, edits_[v] + edits_[w]});
    }
  }

  /// Valence after the mirror join of a vertex with `n` neighbours in this half.
  std::size_t whole_valence(std::uint8_t planes, std::size_t n) const {
    return (planes & HalfMesh::kMirror) != 0 && planes == HalfMesh::kMirror ? 2 * n - 2 : n;
  }

  bool legal(Index gone, Index kept, const Vec3& to) const {
    const std::vector<Index> a = ring(gone), b = ring(kept);
    std::vector<Index> shared;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(shared));
    std::size_t faces_between = 0;
    for (const Index f : around_[gone]) {
      const Triangle& face = half_.mesh.faces[f];
      if (std::find(face.begin(), face.end(), kept) != face.end()) ++faces_between;
    }
    const bool on_boundary = half_.planes[gone] != 0;
    if (shared.size() != faces_between || faces_between != (on_boundary ? 1u : 2u)) return false;
    for (const Index w : shared) {
      const std::size_t n = ring(w).size() - 1;
      if (whole_valence(half_.planes[w], n) < (half_.planes[w] != 0 ? 3u : 4u) || n < 3) return false;
    }
    std::size_t on_planes = 0;
    for (const Index w : a) {
      if (w == kept || half_.planes[w] == 0) continue;
      ++on_planes;
      const bool known = std::binary_search(b.begin(), b.end(), w);
      if (!on_boundary && half_.planes[kept] != 0 && !known) return false;
    }
    if (on_boundary && on_planes > 1) return false;
    const std::size_t n = a.size() + b.size() - 2 - shared.size();
    if (n < 4 || whole_valence(half_.planes[kept], n) > options_.max_valence) return false;
    for (const Index v : {gone, kept}) {
      for (const Index f : around_[v]) {
        const Triangle& face = half_.mesh.faces[f];
        const Index other = v == gone ? kept : gone;
        if (std::find(face.begin(), face.end(), other) != face.end()) continue;
        const Vec3 before = normal(face, v, half_.mesh.points[v]), after = normal(face, v, to);
        double longest = 0;
        for (const Index w : face) {
          if (w != v) longest = std::max(longest, length_sq(half_.mesh.points[w] - to));
        }
        if (dot(unit(before), unit(after)) < 0.35 || length(after) < 0.22 * longest) return false;
      }
    }
    return true;
  }

  void collapse(Index gone, Index kept) {
    const Vec3 to = merged(gone, kept).second;
    if (!legal(gone, kept, to)) return;
    half_.mesh.points[kept] = to;
    errors_[kept].add(errors_[gone]);
    for (const Index f : around_[gone]) {
      Triangle& face = half_.mesh.faces[f];
      if (std::find(face.begin(), face.end(), kept) != face.end()) {
        alive_[f] = false;
        --count_;
        for (const Index v : face) {
          if (v != gone) std::erase(around_[v], f);
        }
      } else {
        std::replace(face.begin(), face.end(), gone, kept);
        around_[kept].push_back(f);
      }
    }
    around_[gone].clear();
    ++edits_[kept];
    const std::vector<Index> touched = ring(kept);
    for (const Index w : touched) ++edits_[w];
    offer_around(kept, false);
    for (const Index w : touched) offer_around(w, false);
  }

  HalfMesh packed() const {
    HalfMesh result;
    std::vector<Index> place(around_.size());
    for (std::size_t v = 0; v < around_.size(); ++v) {
      if (around_[v].empty()) continue;
      place[v] = static_cast<Index>(result.mesh.points.size());
      result.mesh.points.push_back(half_.mesh.points[v]);
      result.planes.push_back(half_.planes[v]);
    }
    for (std::size_t f = 0; f < alive_.size(); ++f) {
      const Triangle& face = half_.mesh.faces[f];
      if (alive_[f]) result.mesh.faces.push_back({place[face[0]], place[face[1]], place[face[2]]});
    }
    return result;
  }

  HalfMesh half_;
  const SculptOptions& options_;
  std::vector<std::vector<Index>> around_;
  std::vector<std::uint32_t> edits_;
  std::vector<Quadric> errors_;
  std::vector<bool> alive_;
  std::size_t count_;
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue_;
};

}  // namespace

HalfMesh simplify(const HalfMesh& half, const SculptOptions& options) {
  return Simplifier(half, options).run();
}

}  // namespace models
