#include <snug/surface/control_hull.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/rounding.h>

namespace snug {

void ControlHull::assign(const LimitSurface& surface, std::span<const PatchId> patches) {
  const Topology& topology = surface.topology();
  numbers_.begin(topology.vertex_count());
  points_.clear();
  vertices_.clear();
  corners_.clear();
  ring_.clear();
  ring_ends_.clear();
  patch_.clear();
  patch_ends_.clear();
  weights_.clear();
  largest_ = 0;
  const bool primal = surface.rules().primal;
  const auto add = [&](VertexId v) {
    const std::uint32_t number = numbers_.number(v.index());
    if (number == points_.size()) {
      points_.push_back(surface.scaled_point(v));
      vertices_.push_back(v);
    }
    return number;
  };
  for (const PatchId p : patches) {
    const std::uint32_t owner = surface.place(p).owner;
    const auto add_corner = [&](VertexId v) {
      patch_.push_back(add(v));
      if (patch_.back() == corners_.size()) corners_.push_back(v);
    };
    if (primal) {
      for (const VertexId v : topology.face(FaceId(owner))) add_corner(v);
    } else {
      add_corner(VertexId(owner));
    }
    patch_ends_.push_back(static_cast<std::uint32_t>(patch_.size()));
    weights_.push_back(surface.polygon_of(p) ? 1.0 : surface.kind(p).outer_weight());
  }
  inner_count_ = points_.size();
  for (const VertexId corner : corners_) {
    const auto add_ring = [&](HalfEdge start) {
      HalfEdge h = start;
      do {
        // The vertices of this face that the next one does not have: all but the last, where the fan goes on.
        const HalfEdge last = topology.prev(h);
        for (HalfEdge g = topology.next(h); g != last; g = topology.next(g)) {
          ring_.push_back(add(topology.from(g)));
        }
        h = topology.twin(last);
        if (h == no_half_edge) ring_.push_back(add(topology.from(last)));
      } while (h != no_half_edge && h != start);
    };
    if (!surface.rules().local) topology.for_each_fan(corner, add_ring);
    ring_ends_.push_back(static_cast<std::uint32_t>(ring_.size()));
  }
  for (const Point3& p : points_) largest_ = std::max(largest_, max_abs(p - Point3{}));
}

Extent ControlHull::extent(const Vector3& direction) const {
  heights_.resize(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) heights_[i] = dot(direction, points_[i] - Point3{});
  rings_.resize(corners_.size());
  std::size_t at = 0;
  for (std::size_t c = 0; c < corners_.size(); ++c) {
    Extent& ring = rings_[c] = {heights_[c], heights_[c]};
    for (; at < ring_ends_[c]; ++at) ring.add(heights_[ring_[at]]);
  }
  Extent all;
  at = 0;
  for (std::size_t p = 0; p < weights_.size(); ++p) {
    Extent inner, outer;
    for (; at < patch_ends_[p]; ++at) {
      const std::uint32_t c = patch_[at];
      inner.add(heights_[c]);
      outer.add(rings_[c]);
    }
    const double w = weights_[p];
    all.add({inner.lower + w * (outer.lower - inner.lower), inner.upper + w * (outer.upper - inner.upper)});
  }
  const double error = enlarged(32 * unit_roundoff * largest_) + 8 * underflow_error;
  return {all.lower - error, all.upper + error};
}

Obb ControlHull::box() const {
  const std::span<const Point3> corners = std::span(points_).first(inner_count_);
  return fit_box(principal_axes(corners), [this](const Vector3& axis) { return extent(axis); });
}

namespace {

// Of each vertex: how far the vertices of its faces are from it, but for roundings; squared.
std::vector<double> ring_sizes_sq(const LimitSurface& surface) {
  constexpr std::size_t max_compared = 16;
  const Topology& topology = surface.topology();
  std::vector<double> sizes(topology.vertex_count(), 0.0);
  const auto raise = [&](VertexId v, double size_sq) {
    sizes[v.index()] = std::max(sizes[v.index()], size_sq);
  };
  for (std::size_t f = 0; f < topology.face_count(); ++f) {
    const std::span<const VertexId> face = topology.face(FaceId(f));
    if (face.size() > max_compared) {
      double radius_sq = 0;
      for (const VertexId v : face) {
        radius_sq = std::max(radius_sq, length_sq(surface.scaled_point(v) - surface.scaled_point(face[0])));
      }
      for (const VertexId v : face) raise(v, 4 * radius_sq);
      continue;
    }
    for (std::size_t i = 1; i < face.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const double size_sq = length_sq(surface.scaled_point(face[i]) - surface.scaled_point(face[j]));
        raise(face[i], size_sq);
        raise(face[j], size_sq);
      }
    }
  }
  return sizes;
}

}  // namespace

std::vector<Ball> control_balls(const LimitSurface& surface, std::span<const PatchId> patches) {
  const std::vector<double> rings_sq = surface.rules().local
                                           ? std::vector<double>(surface.topology().vertex_count(), 0.0)
                                           : ring_sizes_sq(surface);
  std::vector<Ball> balls;
  balls.reserve(patches.size());
  for (const PatchId p : patches) {
    const Point3 middle = surface.middle(p);
    double radius_sq = 0, ring_sq = 0;
    const auto take = [&](VertexId v) {
      radius_sq = std::max(radius_sq, length_sq(surface.scaled_point(v) - middle));
      ring_sq = std::max(ring_sq, rings_sq[v.index()]);
    };
    const std::uint32_t owner = surface.place(p).owner;
    if (surface.rules().primal) {
      for (const VertexId v : surface.topology().face(FaceId(owner))) take(v);
    } else {
      take(VertexId(owner));
    }
    // Squares of what is below 2^-500 are lost.
    balls.push_back({middle, enlarged(std::sqrt(radius_sq) + std::sqrt(ring_sq)) + 0x1p-480});
  }
  return balls;
}

}  // namespace snug
