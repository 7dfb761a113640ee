#include <snug/search/winding.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <snug/geometry/rounding.h>
#include <snug/search/gap.h>
#include <snug/search/precision.h>

namespace snug {
namespace {

constexpr std::uint64_t max_ray_splits = 20'000;

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

// A ray from a point, known up to `error`, and what it meets.
class Ray {
 public:
  Ray(const Point3& from, double error, const Vector3& direction)
      : from_(from), error_(error), direction_(direction) {}

  // Adds the signed crossing with a triangle; false if it is not certain.
  [[nodiscard]] bool add(const LimitTriangle& triangle) {
    std::array<Vector3, 3> v;
    double largest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      v[k] = triangle.corners[k] - from_;
      largest = std::max(largest, max_abs(v[k]));
    }
    // Determinants of three vectors: a sum of six products, each off by its factors' errors and by roundings.
    const double off = enlarged(triangle.error + error_);
    const double doubt = enlarged(12 * largest * off + 64 * unit_roundoff * largest * largest +
                                  12 * off * off + 16 * underflow_error);
    int positive = 0, negative = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double side = determinant(direction_, v[k], v[(k + 1) % 3]);
      positive += side > doubt;
      negative += side < -doubt;
    }
    if (positive > 0 && negative > 0) return true;  // the line passes by
    const double volume = determinant(v[0], v[1], v[2]);
    const double volume_doubt = enlarged(largest * doubt * 4 + 36 * off * off * off + 16 * underflow_error);
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
  Winding(PieceCache& cache, const Point3& point, double error, const WorkMonitor& monitor)
      : cache_(cache), point_(point), error_(error), monitor_(monitor) {}

  std::optional<int> along(const Vector3& direction) {
    const Ball& ball = cache_.model().tree().ball();
    const double length = distance(point_, ball.centre) + ball.radius + 1;
    if (!std::isfinite(length)) return std::nullopt;
    set_segment(direction, length);
    Ray ray(point_, error_, direction);
    if (!add_first_fillers(ray)) return std::nullopt;
    Along question{*this, ray};
    Frontier<NodeGap>& open = cache_.open_nodes();
    open.start(Order::last_first, {cache_.root(), 0});
    search(open, question);
    return question.certain ? std::optional(ray.crossings()) : std::nullopt;
  }

  // Has a direction failed since pieces around the point could not be made small enough? Then all do.
  [[nodiscard]] bool on_surface() const { return on_surface_; }

  // Lower bound of the distance of the surface: the least gap to the sets around pieces, which are split
  // where they hold the point. Not positive if that takes too long.
  double clearance() {
    Clearance question{*this};
    Frontier<NodeGap>& open = cache_.open_nodes();
    open.start(Order::nearest_first, {cache_.root(), -INFINITY});
    search(open, question);
    return question.found;
  }

 private:
  // Crossings of a ray with the surface: pieces that the segment meets, and hold the point, are split.
  struct Along {
    Winding& winding;
    Ray& ray;
    std::uint64_t splits = 0;
    bool certain = true;

    Verb look_at(const NodeGap& at) {
      const Node& node = at.node;
      if (!certain) return Verb::stop;
      if (!node.bounded()) return Verb::open;
      winding.monitor_.checkpoint();
      const bool last = !PieceCache::can_open(node);
      winding.on_surface_ = last ? !(winding.gap_of(node) > 0) : ++splits > max_ray_splits;
      if (winding.on_surface_) return stop();
      if (!(last ? ray.add(winding.corners(node)) : winding.add_fillers(node, ray))) return stop();
      return last ? Verb::drop : Verb::open;
    }
    void open(const NodeGap& at) {
      PieceCache& cache = winding.cache_;
      const PieceCache::Opened opened = cache.open(at.node);
      WideNode::Distances to_segment, to_point;
      opened.boxes->distances(winding.segment_, winding.error_, 0, to_segment);
      opened.boxes->distances(winding.point_, winding.error_, to_point);
      for (std::size_t i = 0; i < opened.count() && certain; ++i) {
        if (to_segment[i] > 0) continue;
        const Node child = opened.child(i);
        if (!child.bounded() || !(to_point[i] > 0)) {
          cache.open_nodes().add({child, 0});
        } else {
          certain = ray.add(winding.corners(child));
        }
      }
    }
    Verb stop() {
      certain = false;
      return Verb::stop;
    }
  };

  struct Clearance {
    Winding& winding;
    std::uint64_t splits = 0;
    double found = 0;

    Verb look_at(const NodeGap& at) {
      const auto& [node, gap] = at;
      if (node.bounded() && gap > 0) {
        found = static_cast<double>(gap);
        return Verb::stop;
      }
      if (!node.bounded()) return Verb::open;
      if (PieceCache::can_open(node)) return ++splits > max_ray_splits ? Verb::stop : Verb::open;
      const float nearer = single_down(winding.gap_of(node));
      if (!(nearer > 0)) return Verb::stop;
      winding.cache_.open_nodes().add({node, nearer});
      return Verb::drop;
    }
    void open(const NodeGap& at) {
      const PieceCache::Opened opened = winding.cache_.open(at.node);
      WideNode::Distances gaps;
      opened.boxes->distances(winding.point_, winding.error_, gaps);
      for (std::size_t i = 0; i < opened.count(); ++i)
        winding.cache_.open_nodes().add({opened.child(i), gaps[i]});
    }
  };

  // Lower bound of the distance of a piece, by its offset triangle: of one that cannot be split this is much
  // nearer to it than the set around it.
  [[nodiscard]] double gap_of(const Node& node) const {
    const OffsetTriangle& offset = cache_.offset(node);
    return snug::gap_of(nearest({point_, point_, point_}, offset.base), offset.radius, spatial_error(error_));
  }

  // The part of the ray that matters, as a set.
  void set_segment(const Vector3& direction, double length) {
    segment_.centre = point_ + (length / 2) * direction;
    const Vector3 unit = (1 / snug::length(direction)) * direction;
    segment_.box = {};
    segment_.box.half[0] = static_cast<float>(length);
    for (std::size_t k = 0; k < 3; ++k) segment_.box.axes[0][k] = static_cast<float>(unit[k]);
  }

  [[nodiscard]] LimitTriangle corners(const Node& node) const { return limit_triangle(cache_.patch(node)); }

  // A split piece: its children's triangles and these have the same border as its own one.
  [[nodiscard]] bool add_fillers(const Node& node, Ray& ray) const {
    const PieceCache::Opened split = cache_.open(node);
    const LimitTriangle whole = corners(node);
    for (std::size_t k = 0, next = 1; k < 3; ++k, next = (k + 1) % 3) {
      const LimitTriangle child = corners(split.child(k));
      const Triangle filler{whole.corners[k], whole.corners[next], child.corners[next]};
      if (!ray.add({filler, std::max(whole.error, child.error)})) return false;
    }
    return true;
  }

  // The fillers of first splits that the segment may meet.
  [[nodiscard]] bool add_first_fillers(Ray& ray) {
    const Solid& solid = cache_.model().solid();
    const WideBvh* const tree = solid.filler_tree();
    if (tree == nullptr) return true;
    std::vector<const WideNode*> open{&tree->root()};
    while (!open.empty()) {
      const WideNode& node = *open.back();
      open.pop_back();
      WideNode::Distances gaps;
      node.distances(segment_, error_, 0, gaps);
      for (std::size_t i = 0; i < node.count(); ++i) {
        if (gaps[i] > 0) continue;
        const std::uint32_t name = node.names[i];
        if ((name & WideBvh::leaf_bit) == 0) {
          open.push_back(&tree->node(name));
          continue;
        }
        for (const std::uint32_t item : tree->leaf(name & ~WideBvh::leaf_bit)) {
          if (!ray.add(solid.fillers()[item])) return false;
        }
      }
    }
    return true;
  }

  PieceCache& cache_;
  Point3 point_;
  double error_;
  const WorkMonitor& monitor_;
  PlacedBox segment_{};
  bool on_surface_ = false;
};

// By the first direction that decides, that away from the middle first.
std::optional<int> along_some_ray(Winding& winding, const Vector3& from_middle) {
  const auto nearer = [&](const Vector3& x, const Vector3& y) {
    return dot(x, from_middle) < dot(y, from_middle);
  };
  auto direction = std::max_element(directions.begin(), directions.end(), nearer);
  for (std::size_t i = 0; i < directions.size() && !winding.on_surface(); ++i) {
    if (const std::optional<int> number = winding.along(*direction)) return number;
    if (++direction == directions.end()) direction = directions.begin();
  }
  return std::nullopt;
}

}  // namespace

std::optional<int> winding_number(PieceCache& cache, const Point3& point, double error,
                                  const WorkMonitor& monitor) {
  const Vector3 from_middle = point - cache.model().tree().ball().centre;
  Winding winding(cache, point, error, monitor);
  if (const std::optional<int> number = along_some_ray(winding, from_middle)) return number;
  if (winding.on_surface()) return std::nullopt;
  // In the plane of a filler no ray decides. All points nearer than the surface have the same number.
  const double clearance = winding.clearance();
  if (!(clearance > 8 * error + 0x1p-45)) return std::nullopt;
  for (const Vector3& direction : directions) {
    Winding beside(cache, point + (clearance / 4) * direction, error, monitor);
    if (const std::optional<int> number = along_some_ray(beside, from_middle)) return number;
  }
  return std::nullopt;
}

}  // namespace snug
