#include "sculpt.h"

#include <algorithm>
#include <map>
#include <utility>

#include "simplify.h"

namespace models {

namespace {

/// Step from `p` to the zero set of `solid`, within the planes that hold it.
Vec3 step_to(const Solid& solid, Vec3 p, std::uint8_t planes) {
  const Vec3 start = p;
  for (int i = 0; i < 3; ++i) {
    constexpr double h = 1e-3;
    const double f = solid(p);
    Vec3 slope;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Vec3 ahead = p, behind = p;
      ahead[axis] += h;
      behind[axis] -= h;
      slope[axis] = (solid(ahead) - solid(behind)) / (2 * h);
    }
    if ((planes & HalfMesh::kMirror) != 0) slope.x = 0;
    if ((planes & HalfMesh::kRim) != 0) slope.y = 0;
    Vec3 move = (-f / std::max(length_sq(slope), 0.15)) * slope;
    if (length(move) > 0.1) move = 0.1 * unit(move);
    p = p + move;
  }
  return p - start;
}

/// Marching tetrahedra on the half box; six tetrahedra a cube, all sharing its main diagonal.
class Sampler {
 public:
  Sampler(const Solid& solid, const SculptOptions& options) : options_(options) {
    const Vec3 size = options.high - options.low;
    for (std::size_t axis = 0; axis < 3; ++axis)
      n_[axis] = static_cast<Index>(std::llround(size[axis] / options.cell));
    values_.resize(std::size_t{n_[0] + 1} * (n_[1] + 1) * (n_[2] + 1));
    for (Index g = 0; g < values_.size(); ++g) {
      values_[g] = solid(place(g));
      if (values_[g] == 0) values_[g] = 1e-9;
    }
  }

  HalfMesh run() {
    static constexpr std::array<std::array<std::size_t, 3>, 6> orders = {
        {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
    for (Index k = 0; k < n_[2]; ++k) {
      for (Index j = 0; j < n_[1]; ++j) {
        for (Index i = 0; i < n_[0]; ++i) {
          for (const auto& order : orders) {
            std::array<Index, 3> at = {i, j, k};
            std::array<Index, 4> corners{grid(at)};
            for (std::size_t step = 0; step < 3; ++step) {
              ++at[order[step]];
              corners[step + 1] = grid(at);
            }
            cut(corners);
          }
        }
      }
    }
    return std::move(half_);
  }

 private:
  Index grid(const std::array<Index, 3>& at) const {
    return at[0] + (n_[0] + 1) * (at[1] + (n_[1] + 1) * at[2]);
  }

  std::array<Index, 3> coordinates(Index g) const {
    return {g % (n_[0] + 1), g / (n_[0] + 1) % (n_[1] + 1), g / ((n_[0] + 1) * (n_[1] + 1))};
  }

  Vec3 place(Index g) const {
    const auto at = coordinates(g);
    Vec3 p = options_.low;
    for (std::size_t axis = 0; axis < 3; ++axis) p[axis] += options_.cell * at[axis];
    return p;
  }

  Index crossing(Index a, Index b) {
    if (a > b) std::swap(a, b);
    const auto [it, fresh] = vertices_.try_emplace({a, b}, static_cast<Index>(half_.mesh.points.size()));
    if (fresh) {
      const double t = std::clamp(values_[a] / (values_[a] - values_[b]), 0.12, 0.88);
      half_.mesh.points.push_back(place(a) + t * (place(b) - place(a)));
      const auto ca = coordinates(a), cb = coordinates(b);
      std::uint8_t planes = 0;
      if (ca[0] == 0 && cb[0] == 0) planes |= HalfMesh::kMirror;
      if (options_.open_floor && ca[1] == 0 && cb[1] == 0) planes |= HalfMesh::kRim;
      half_.planes.push_back(planes);
    }
    return it->second;
  }

  void emit(Index a, Index b, Index c, const Vec3& outward) {
    const auto& p = half_.mesh.points;
    if (dot(cross(p[b] - p[a], p[c] - p[a]), outward) < 0) std::swap(b, c);
    half_.mesh.faces.push_back({a, b, c});
  }

  void cut(const std::array<Index, 4>& corners) {
    std::vector<Index> in, out;
    for (const Index g : corners) (values_[g] < 0 ? in : out).push_back(g);
    if (in.empty() || out.empty()) return;
    Vec3 outward;
    for (const Index g : out) outward = outward + (1.0 / static_cast<double>(out.size())) * place(g);
    for (const Index g : in) outward = outward - (1.0 / static_cast<double>(in.size())) * place(g);
    if (in.size() == 2) {
      const Index a = crossing(in[0], out[0]), b = crossing(in[0], out[1]);
      const Index c = crossing(in[1], out[1]), d = crossing(in[1], out[0]);
      emit(a, b, c, outward);
      emit(a, c, d, outward);
    } else {
      const Index lone = in.size() == 1 ? in[0] : out[0];
      const std::vector<Index>& rest = in.size() == 1 ? out : in;
      const Index a = crossing(lone, rest[0]), b = crossing(lone, rest[1]), c = crossing(lone, rest[2]);
      emit(a, b, c, outward);
    }
  }

  const SculptOptions& options_;
  std::array<Index, 3> n_{};
  std::vector<double> values_;
  HalfMesh half_;
  std::map<std::pair<Index, Index>, Index> vertices_;
};

/// Slides vertices part of the way to the mean of their neighbours, then back to the surface.
void relax(HalfMesh& half, const Solid& solid, int rounds, double share) {
  const auto rings = neighbours(half.mesh);
  for (int round = 0; round < rounds; ++round) {
    const std::vector<Vec3> old = half.mesh.points;
    for (std::size_t v = 0; v < old.size(); ++v) {
      const std::uint8_t planes = half.planes[v];
      Vec3 sum;
      std::size_t count = 0;
      for (const Index w : rings[v]) {
        if ((half.planes[w] & planes) != planes) continue;
        sum = sum + old[w];
        ++count;
      }
      if (count < 2) continue;
      Vec3 p = old[v] + share * ((1.0 / static_cast<double>(count)) * sum - old[v]);
      half.mesh.points[v] = p + step_to(solid, p, planes);
    }
  }
}

}  // namespace

void fit_limit(TriangleMesh& mesh, const Solid& solid, double floor_y, int rounds) {
  const auto rings = neighbours(mesh);
  std::vector<std::size_t> corners(mesh.points.size(), 0);
  for (const Triangle& f : mesh.faces) {
    for (const Index v : f) ++corners[v];
  }
  for (int round = 0; round < rounds; ++round) {
    const std::vector<Vec3> old = mesh.points;
    std::vector<Vec3> move(old.size());
    for (std::size_t v = 0; v < old.size(); ++v) {
      const bool rim = corners[v] != rings[v].size();
      const auto n = static_cast<double>(rings[v].size());
      Vec3 sum;
      double share = 1.0 / 6;
      if (rim) {
        for (const Index w : rings[v]) {
          if (corners[w] != rings[w].size() && old[w].y == floor_y) sum = sum + old[w];
        }
        sum = sum + 4.0 * old[v];
      } else {
        for (const Index w : rings[v]) sum = sum + old[w];
        const double c = 0.375 + 0.25 * cos_sin(1 / n)[0];
        const double beta = (0.625 - c * c) / n;
        share = 1 / (0.375 / beta + n);
        sum = sum + (1 / share - n) * old[v];
      }
      const std::uint8_t planes = (old[v].x == 0 ? HalfMesh::kMirror : 0) | (rim ? HalfMesh::kRim : 0);
      move[v] = step_to(solid, share * sum, planes);
    }
    for (std::size_t v = 0; v < old.size(); ++v) {
      Vec3 mean;
      for (const Index w : rings[v]) mean = mean + (1.0 / static_cast<double>(rings[v].size())) * move[w];
      if (corners[v] != rings[v].size()) mean.y = 0;
      if (old[v].x == 0) mean.x = 0;
      mesh.points[v] = old[v] + 0.8 * move[v] + 0.2 * mean;
    }
  }
}

TriangleMesh sculpt(const Solid& solid, const SculptOptions& options) {
  HalfMesh half = Sampler(solid, options).run();
  relax(half, solid, 4, 0.5);
  half = simplify(half, options);
  relax(half, solid, 6, 0.25);
  TriangleMesh mesh = mirrored(half.mesh);
  fit_limit(mesh, solid, options.low.y, 4);
  return mesh;
}

}  // namespace models
