#include "scene_builder.h"

#include <algorithm>
#include <cmath>

#include <picture/palette.h>
#include <snug/base/parallel.h>
#include <snug/surface/evaluate.h>

namespace snug::command {
namespace {

// A point as the camera sees it, in pixels from the middle of the picture.
struct Pixel {
  double x, y;
};

Pixel seen(const Camera& camera, int height, Point3 p) {
  const Vector3 v = p - camera.eye;
  const double pixels = 0.5 * height / (camera.tangent * dot(v, camera.forward));
  return {dot(v, camera.right) * pixels, dot(v, camera.up) * pixels};
}

double distance(const Pixel& a, const Pixel& b) { return std::hypot(a.x - b.x, a.y - b.y); }

}  // namespace

PictureUnits::PictureUnits(std::span<const PlacedMesh> parts) {
  double largest = 0;
  for (const PlacedMesh& part : parts) {
    if (part.used.empty()) continue;
    largest = std::max(largest, max_abs(part.pose.offset()));
    for (const VertexId v : part.used) {
      largest = std::max(largest, max_abs(part.mesh->points[v.index()] - Point3{}));
    }
  }
  // Two halvings: sums of a rotated point and a translation stay small.
  scale_ = PowerOfTwo::normalising(largest) * PowerOfTwo(-2);
  Box3 box;
  for (const PlacedMesh& part : parts) {
    for (const VertexId v : part.used) box.add(placed(part.pose, scale_.apply(part.mesh->points[v.index()])));
  }
  if (box.empty()) return;
  centre_ = box.lower + 0.5 * (box.upper - box.lower);
  if (const double zoom = 1 / longest_side(box); std::isfinite(zoom)) zoom_ = zoom;
}

Tessellation::Tessellation(const PlacedSurface& part, const PictureUnits& units, std::uint32_t steps,
                           int threads, const WorkMonitor& monitor)
    : steps_(steps), points_a_patch_(std::size_t{steps + 1} * (steps + 2) / 2) {
  const LimitSurface& surface = *part.surface;
  std::vector<std::uint32_t> offsets{0};
  std::vector<VertexId> corners;
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    if (!surface.has_patch(PatchId(p))) continue;
    patches_.emplace_back(p);
    for (const std::uint32_t name : surface.corner_names(PatchId(p))) corners.emplace_back(name);
    offsets.push_back(static_cast<std::uint32_t>(corners.size()));
  }
  topology_ = Topology(std::move(offsets), std::move(corners), surface.corner_name_count());
  vertex_owner_.assign(topology_.vertex_count(), no_half_edge);
  for (HalfEdge h = 0; h < topology_.half_edge_count(); ++h) {
    HalfEdge& owner = vertex_owner_[topology_.from(h).index()];
    if (owner == no_half_edge) owner = h;
  }
  positions_.resize(patches_.size() * points_a_patch_);
  normals_.resize(patches_.size() * points_a_patch_);
  parallel_for(patches_.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t rank = begin; rank < end; ++rank) {
      monitor.checkpoint();
      const PatchEvaluator evaluate_at(surface, patches_[rank]);
      std::size_t at = rank * points_a_patch_;
      for (std::uint32_t j = 0; j <= steps_; ++j) {
        for (std::uint32_t i = 0; i + j <= steps_; ++i, ++at) {
          // The far edge is met exactly: u + v rounds to at most 1.
          const double v = static_cast<double>(j) / steps_,
                       u = std::fmin(static_cast<double>(i) / steps_, 1 - v);
          const SurfacePoint point = evaluate_at(TriangleParameter{u, v});
          positions_[at] = units(part.pose, point.position);
          if (point.normal) normals_[at] = units(part.pose, *point.normal);
        }
      }
    }
  });
}

std::vector<double> Tessellation::longest_edges(const Camera& camera, int height) const {
  std::vector<double> longest(patches_.size(), 0);
  for (std::size_t rank = 0; rank < patches_.size(); ++rank) {
    for (std::size_t side = 0; side < 3; ++side) {
      double sum = 0;
      Pixel last{};
      for (std::uint32_t along = 0; along <= steps_; ++along) {
        const Pixel next =
            seen(camera, height, positions_[rank * points_a_patch_ + number(on_side(side, along))]);
        if (along > 0) sum += distance(last, next);
        last = next;
      }
      longest[rank] = std::max(longest[rank], sum);
    }
  }
  return longest;
}

//                  2
//                 / \        side s runs from corner s to corner s + 1,
//            2   /   \   1   i grows from corner 0 to corner 1,
//               /     \      j from corner 0 to corner 2
//              0-------1
//                  0
Tessellation::LatticePoint Tessellation::on_side(std::size_t side, std::uint32_t steps_along) const {
  switch (side) {
    case 0:
      return {steps_along, 0};
    case 1:
      return {steps_ - steps_along, steps_along};
    default:
      return {0, steps_ - steps_along};
  }
}

Point3 Tessellation::shared_position(std::size_t rank, LatticePoint p) const {
  const auto lent_by = [&](HalfEdge h, std::uint32_t steps_along) {
    const FaceId f = topology_.face_of(h);
    return positions_[f.index() * points_a_patch_ + number(on_side(h - topology_.first_of(f), steps_along))];
  };
  const HalfEdge first = topology_.first_of(FaceId(rank));
  for (std::uint32_t side = 0; side < 3; ++side) {
    const std::uint32_t k = steps_ - p.i - p.j;
    const std::uint32_t across = side == 0 ? p.j : side == 1 ? k : p.i;
    if (across > 0) continue;
    const std::uint32_t along = side == 0 ? p.i : side == 1 ? p.j : k;
    const HalfEdge h = first + side;
    if (along == 0) return lent_by(vertex_owner_[topology_.from(h).index()], 0);
    if (along == steps_) return lent_by(vertex_owner_[topology_.to(h).index()], 0);
    const HalfEdge twin = topology_.twin(h);
    const bool twin_lends = twin != no_half_edge && twin < h;
    return twin_lends ? lent_by(twin, steps_ - along) : lent_by(h, along);
  }
  return positions_[rank * points_a_patch_ + number(p)];
}

void Tessellation::add_to(Scene& scene, std::uint32_t material, int threads) const {
  const std::size_t before = scene.triangles.size(), triangles_a_face = std::size_t{steps_} * steps_;
  scene.triangles.resize(before + triangle_count());
  parallel_for(patches_.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t rank = begin; rank < end; ++rank) {
      std::size_t next = before + rank * triangles_a_face;
      const auto add = [&](LatticePoint a, LatticePoint b, LatticePoint c) {
        ShadedTriangle& triangle = scene.triangles[next++];
        triangle.material = material;
        std::size_t corner = 0;
        for (const LatticePoint p : {a, b, c}) {
          triangle.corner[corner] = shared_position(rank, p);
          triangle.normal[corner++] = normals_[rank * points_a_patch_ + number(p)];
        }
      };
      for (std::uint32_t j = 0; j < steps_; ++j) {
        for (std::uint32_t i = 0; i + j < steps_; ++i) {
          add({i, j}, {i + 1, j}, {i, j + 1});
          if (i + j + 1 < steps_) add({i + 1, j + 1}, {i, j + 1}, {i + 1, j});
        }
      }
    }
  });
}

std::vector<Polyhedron> enclosure_hulls(std::span<const IntervalTriangle> enclosures, const Motion& pose,
                                        const PictureUnits& units, int threads, const WorkMonitor& monitor) {
  std::vector<Polyhedron> hulls(enclosures.size());
  parallel_for(enclosures.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      monitor.checkpoint();
      IntervalTriangle scaled = enclosures[i];
      for (Box3& box : scaled.corner) box = {units.scale().apply(box.lower), units.scale().apply(box.upper)};
      hulls[i] = hull_of_boxes(scaled);
      for (Point3& p : hulls[i].points) p = units.from_scaled(pose, p);
    }
  });
  return hulls;
}

void add_polyhedron(Scene& scene, const Polyhedron& solid, Point3 eye, const SolidStyle& style) {
  const auto& points = solid.points;
  const std::size_t count = points.size();
  std::vector<bool> bordered(count * count, false);  // half-edges of facets towards the eye
  for (const std::vector<std::uint32_t>& facet : solid.facets) {
    // Twice its area: for slivers, too, better than the cross product of two sides.
    Vector3 normal;
    for (std::size_t i = 1; i + 1 < facet.size(); ++i) {
      normal = normal + cross(points[facet[i]] - points[facet[0]], points[facet[i + 1]] - points[facet[0]]);
    }
    if (!(dot(normal, eye - points[facet[0]]) > 0)) continue;
    for (std::size_t i = 0; i < facet.size(); ++i) {
      const std::uint32_t from = facet[i], to = facet[(i + 1) % facet.size()];
      bordered[from * count + to] = true;
      if (i == 0 || i + 1 == facet.size()) continue;
      ShadedTriangle& triangle = scene.triangles.emplace_back();
      triangle.corner[0] = points[facet[0]];
      triangle.corner[1] = points[from];
      triangle.corner[2] = points[to];
      triangle.material = style.material;
    }
  }
  for (std::size_t from = 0; from < count; ++from) {
    for (std::size_t to = 0; to < count; ++to) {
      const bool inner = bordered[to * count + from];
      if (!bordered[from * count + to] || (inner && to < from)) continue;
      scene.lines.push_back(
          {points[from], points[to], (inner ? 0.5 : 1) * style.line_width, style.line_colour});
    }
  }
}

void add_witness(Scene& scene, const std::array<Point3, 2>& points, const PictureUnits& units, double scale) {
  std::array<Point3, 2> drawn;
  for (std::size_t i = 0; i < 2; ++i) {
    drawn[i] = units.from_scaled(Motion{}, units.scale().apply(points[i]));
    if (!(max_abs(drawn[i] - Point3{}) < 1e6)) {
      throw InputError(InputProblem::value,
                       "--witness: a point is too far away for a picture of these meshes");
    }
  }
  scene.lines.push_back({drawn[0], drawn[1], palette::witness_width * scale, palette::signal});
  for (const Point3& p : drawn) scene.lines.push_back({p, p, palette::witness_dot * scale, palette::signal});
}

void add_cage(Scene& scene, const PlacedSurface& part, const PictureUnits& units, double line_width,
              Colour line_colour) {
  const Topology& topology = part.surface->topology();
  const auto place = [&](VertexId v) { return units(part.pose, part.surface->mesh().points[v.index()]); };
  for (std::size_t e = 0; e < topology.edge_count(); ++e) {
    const HalfEdge h = topology.half_of(EdgeId(e));
    scene.lines.push_back({place(topology.from(h)), place(topology.to(h)), line_width, line_colour});
  }
}

}  // namespace snug::command
