#include <snug/query/containment.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include <snug/base/contract.h>
#include <snug/base/error.h>
#include <snug/base/rounding.h>
#include <snug/patch/evaluate.h>

namespace snug {
namespace {

constexpr std::uint64_t most_splits = 20'000;

// Of no particular slope to anything that people model.
constexpr std::array<Vector3, 8> directions{{{0.8236391, 0.2941752, 0.4848613},
                                             {-0.3912744, 0.8123906, 0.4324018},
                                             {0.1748203, -0.5321907, 0.8283922},
                                             {-0.6723481, -0.5610927, -0.4829115},
                                             {0.5519373, 0.7218405, -0.4176331},
                                             {-0.9321904, 0.1293847, 0.3381923},
                                             {0.2639471, -0.8931207, -0.3642918},
                                             {-0.1173952, 0.2387164, -0.9639721}}};

double determinant(const Vector3& a, const Vector3& b, const Vector3& c) { return dot(a, cross(b, c)); }

// A ray from a point, and what it meets.
class Ray {
 public:
  Ray(const Point3& from, double error, const Vector3& direction)
      : from_(from), error_(error), direction_(direction) {}

  // Adds the signed crossing with a triangle whose exact corners lie within `error` of these; false if it is not certain.
  [[nodiscard]] bool add(const Triangle& triangle, double error) {
    std::array<Vector3, 3> v;
    double largest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      v[k] = triangle[k] - from_;
      largest = std::max(largest, max_abs(v[k]));
    }
    // Determinants of three vectors: a sum of six products, each off by its factors' errors and by roundings.
    const double off = enlarged(error + error_);
    const double doubt =
        enlarged(12 * largest * off + 64 * unit_roundoff * largest * largest + 12 * off * off);
    int positive = 0, negative = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double side = determinant(direction_, v[k], v[(k + 1) % 3]);
      positive += side > doubt;
      negative += side < -doubt;
    }
    if (positive > 0 && negative > 0) return true;  // the line passes by
    const double volume = determinant(v[0], v[1], v[2]);
    const double volume_doubt = enlarged(largest * doubt * 4 + 36 * off * off * off);
    // All three alike: the line goes through; ahead if the volume has the same sign.
    if (positive == 3 || negative == 3) {
      if (std::fabs(volume) <= volume_doubt) return false;
      const int sign = positive == 3 ? 1 : -1;
      if ((volume > 0) == (sign > 0)) crossings_ += sign;
      return true;
    }
    // Perhaps through an edge; behind, that does not matter.
    for (const Vector3& corner : v) {
      if (!(dot(corner, direction_) < -(4 * off + 16 * unit_roundoff * largest))) return false;
    }
    return true;
  }
  [[nodiscard]] int crossings() const { return crossings_; }

 private:
  Point3 from_;
  double error_;
  Vector3 direction_;
  int crossings_ = 0;
};

class Winding {
 public:
  Winding(QueryScratch& scratch, const Point3& point, double error, const WorkMonitor& monitor)
      : scratch_(scratch), point_(point), error_(error), monitor_(monitor) {}

  std::optional<int> along(const Vector3& direction) {
    const Ball& ball = scratch_.model().tree().ball();
    const double length = distance(point_, ball.centre) + ball.radius + 1;
    if (!std::isfinite(length)) return std::nullopt;
    segment(direction, length);
    Ray ray(point_, error_, direction);
    stack_.assign(1, scratch_.root());
    std::uint64_t splits = 0;
    while (!stack_.empty()) {
      const Node node = stack_.back();
      stack_.pop_back();
      if (node.piece) {
        monitor_.checkpoint();
        if (++splits > most_splits || !scratch_.can_open(node)) return std::nullopt;
        if (!add_fillers(node, ray)) return std::nullopt;
      }
      const QueryScratch::Opened opened = scratch_.open(node);
      const Blocks& blocks = scratch_.blocks(opened.piece);
      Blocks::Distances to_segment, to_point;
      blocks.distances(opened.block, segment_, error_, 0, to_segment);
      blocks.distances(opened.block, point_, error_, to_point);
      for (std::uint32_t i = 0; i < blocks.count(opened.block); ++i) {
        if (to_segment[i] > 0) continue;
        const Node next{opened.block, static_cast<std::uint8_t>(i), opened.piece};
        if (!opened.piece || !(to_point[i] > 0)) {
          stack_.push_back(next);
        } else if (!add_triangle(scratch_.piece(next), ray)) {
          return std::nullopt;
        }
      }
    }
    return ray.crossings();
  }

 private:
  // The part of the ray that matters, as a set.
  void segment(const Vector3& direction, double length) {
    segment_.centre = point_ + (length / 2) * direction;
    const Vector3 unit = (1 / snug::length(direction)) * direction;
    segment_.box = {};
    segment_.box.half[0] = static_cast<float>(length);
    for (std::size_t k = 0; k < 3; ++k) segment_.box.axes[0][k] = static_cast<float>(unit[k]);
    const auto places = directions_of(scratch_.blocks(false).volume());
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double half = std::fabs(dot(all_directions[places[i]], direction)) * length;
      segment_.lower[i] = -half;
      segment_.upper[i] = half;
    }
  }

  struct Corners {
    Triangle points;
    double error;
  };
  [[nodiscard]] Corners corners(PieceId id) const {
    const Piece& piece = scratch_.pieces()[id];
    Corners result{};
    for (std::size_t k = 0; k < 3; ++k) {
      const LimitPoint corner = corner_point(piece.patch, k);
      result.points[k] = piece.patch.origin + corner.relative;
      result.error =
          std::max(result.error, corner.error + unit_roundoff * max_abs(result.points[k] - Point3{}));
    }
    result.error = spatial_error(result.error);
    return result;
  }

  [[nodiscard]] bool add_triangle(PieceId id, Ray& ray) const {
    const Corners c = corners(id);
    return ray.add(c.points, c.error);
  }

  // A split piece: its children's triangles and these have the same border as its own one.
  [[nodiscard]] bool add_fillers(Node node, Ray& ray) const {
    const PieceId id = scratch_.piece(node), first = scratch_.pieces().split(id);
    const Corners whole = corners(id);
    for (std::size_t k = 0; k < 3; ++k) {
      const Corners child = corners(PieceId(first.index() + k));
      const Point3& middle = child.points[(k + 1) % 3];
      if (!ray.add({whole.points[k], whole.points[(k + 1) % 3], middle},
                   std::max(whole.error, child.error))) {
        return false;
      }
    }
    return true;
  }

  QueryScratch& scratch_;
  Point3 point_;
  double error_;
  const WorkMonitor& monitor_;
  PlacedVolume segment_{};
  std::vector<Node> stack_;
};

// A patch of each connected component.
std::vector<PatchId> component_patches(const Surface& surface) {
  std::vector<std::uint32_t> parent(surface.corner_name_count());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto find = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    const auto names = surface.corner_names(PatchId(p));
    for (std::size_t k = 1; k < 3; ++k) {
      const std::uint32_t x = find(names[0]), y = find(names[k]);
      parent[std::max(x, y)] = std::min(x, y);
    }
  }
  std::vector<bool> seen(parent.size());
  std::vector<PatchId> patches;
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    const std::uint32_t component = find(surface.corner_names(PatchId(p))[0]);
    if (!seen[component]) {
      seen[component] = true;
      patches.emplace_back(p);
    }
  }
  return patches;
}

}  // namespace

std::optional<int> winding_number(QueryScratch& scratch, const Point3& point, double error,
                                  const WorkMonitor& monitor) {
  Winding winding(scratch, point, error, monitor);
  for (const Vector3& direction : directions) {
    if (const std::optional<int> number = winding.along(direction)) return number;
  }
  return std::nullopt;
}

void require_closed(const Surface& surface) {
  const Topology& topology = surface.topology();
  for (std::size_t e = 0; e < topology.edge_count(); ++e) {
    if (!topology.ends_fans(EdgeId(e))) continue;
    const HalfEdge h = topology.half_of(EdgeId(e));
    throw InputError(
        InputProblem::refused,
        "solids are bounded by closed surfaces, and edge (" + std::to_string(topology.from(h).value()) +
            ", " + std::to_string(topology.to(h).value()) + ") of face " +
            std::to_string(topology.face_of(h).value()) +
            " has not two faces that run along it in opposite directions; close the mesh or leave out "
            "--solid");
  }
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    if (surface.has_patch(PatchId(p))) continue;
    throw InputError(InputProblem::refused, "solids are bounded by closed surfaces, and face " +
                                                std::to_string(surface.place(PatchId(p)).owner) +
                                                " is a hole; fill it or leave out --solid");
  }
}

Collision as_solids(const PlacedModel& a, const PlacedModel& b, Collision apart, const WorkMonitor& monitor) {
  require_closed(a.model.surface());
  require_closed(b.model.surface());
  const std::array<const PlacedModel*, 2> side{&a, &b};
  PairSearch search(a, b, rigidity_defects(a, b));
  bool certain = true;
  for (std::size_t s = 0; s < 2; ++s) {
    const Surface& surface = side[s]->model.surface();
    const RelativeFrame& seen = search.seen_from(1 - s);
    for (const PatchId p : component_patches(surface)) {
      const Patch patch = surface.patch(p);
      const LimitPoint corner = corner_point(patch, 0);
      const Point3 local = patch.origin + corner.relative;
      const double error = corner.error + unit_roundoff * max_abs(local - Point3{});
      std::optional<int> number;
      if (seen.comparable) {
        number = winding_number(side[1 - s]->scratch, seen.apply(local),
                                enlarged(2 * seen.scale * spatial_error(error)) + seen.slack, monitor);
      }
      certain = certain && number.has_value();
      if (number.value_or(0) != 0) {
        apart.verdict = Verdict::intersecting;
        return apart;
      }
    }
  }
  if (!certain) apart.verdict = Verdict::undecided;
  return apart;
}

}  // namespace snug
