#include <snug/search/piece_set.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <utility>

#include <snug/bvh/obb.h>
#include <snug/geometry/rounding.h>
#include <snug/patch/evaluate.h>
#include <snug/search/feet.h>
#include <snug/search/piece.h>
#include <snug/surface/evaluate.h>
#include <snug/surface/unscale.h>
#include <support/direction.h>
#include <support/parallel.h>

namespace snug {

// Pieces, and which one each is a part of.
struct PieceSet::Made : Pieces {
  std::vector<std::uint32_t> origins;
};
// A few of them: a block would be larger.
struct PieceSet::FewMade {
  std::vector<QuadraticTriangle> quadratics;
  std::vector<PieceName> names;
  std::vector<std::uint32_t> origins;

  void add(const QuadraticTriangle& quadratic, const PieceName& name) {
    quadratics.push_back(quadratic);
    names.push_back(name);
  }
};

namespace {

// Below this error, in scaled units, roundings are what is left.
constexpr double min_error = 0x1p-46;
// Of points of sets that are given.
constexpr double given_point_error = 0x1p-48;

// How many pieces there are, for all threads.
class Count {
 public:
  explicit Count(std::uint64_t most) : max_(most) {}
  void add() { count_.fetch_add(1, std::memory_order_relaxed); }
  [[nodiscard]] bool too_many() const { return count_.load(std::memory_order_relaxed) > max_; }

 private:
  std::uint64_t max_;
  std::atomic<std::uint64_t> count_{0};
};

// Calls add(quadratic, name) for the parts of a piece, with some of them only once there are too many.
template <class Add>
void split_to(double error, const PieceSet::FinerPieces& finer, const LimitSurface& surface, PatchId root,
              const Patch& patch, Count& count, const Add& add) {
  if (count.too_many()) return;
  const bool last = patch.path.level() >= PiecePath::max_level;
  const double enough = std::max(error, min_error);
  const QuadraticTriangle quadratic = quadratic_triangle(
      surface.library(), patch, {.sufficient = enough / 4, .useless = last ? INFINITY : enough});
  if (quadratic.error <= enough || last) {
    const PieceName name{root, patch.path};
    const auto wanted = finer.find(name);
    if (wanted != finer.end() && wanted->second < error)
      return split_to(wanted->second, finer, surface, root, patch, count, add);
    count.add();
    return add(quadratic, name);
  }
  for (unsigned child = 0; child < 4; ++child) {
    split_to(error, finer, surface, root, split(patch, child), count, add);
  }
}

QuadraticTriangle in_units(const QuadraticTriangle& q, PowerOfTwo units) {
  QuadraticTriangle result;
  for (std::size_t k = 0; k < 3; ++k) {
    result.corners[k] = units.apply(q.corners[k]);
    result.middles[k] = units.apply(q.middles[k]);
  }
  result.error = units.apply(q.error) + 8 * underflow_error;
  result.normal = q.normal;
  result.normal_error = units.apply(q.normal_error) + 8 * underflow_error;
  return result;
}

std::array<Vector3, 3> axes_of(const QuadraticTriangle& q) {
  const Vector3 normal = unit_normal(q.corners);
  if (normal == Vector3{}) return principal_axes(points_of(q));
  Vector3 along;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3 edge = q.corners[(k + 1) % 3] - q.corners[k];
    if (length_sq(edge) > length_sq(along)) along = edge;
  }
  along = normalized(along - dot(along, normal) * normal);
  if (along == Vector3{}) return Obb{}.axes;
  return {along, cross(normal, along), normal};
}

Obb box_of(const QuadraticTriangle& q) {
  return fit_box(axes_of(q), [&](const Vector3& d) { return extent_of(q, d); });
}

}  // namespace

// The pieces that make(i, count, made) adds for each i, in their order.
template <class Make>
PieceSet::Made PieceSet::made_in_order(std::size_t count, std::uint64_t most, int threads,
                                       const WorkMonitor& monitor, const Make& make) {
  Count counted(most);
  constexpr std::size_t block = 64, blocks_at_once = 64;
  Made all;
  std::vector<FewMade> parts(blocks_at_once);
  for (std::size_t first = 0; first < count; first += blocks_at_once * block) {
    parallel_for(std::min(blocks_at_once, (count - first + block - 1) / block), threads,
                 [&](std::size_t begin, std::size_t end) {
                   for (std::size_t b = begin; b < end; ++b) {
                     monitor.checkpoint();
                     const std::size_t from = first + b * block;
                     for (std::size_t i = from; i < std::min(count, from + block); ++i) {
                       if (counted.too_many()) return;
                       make(i, counted, parts[b]);
                       parts[b].origins.resize(parts[b].names.size(), static_cast<std::uint32_t>(i));
                     }
                   }
                 });
    if (counted.too_many()) return {};
    for (FewMade& part : parts) {
      for (const QuadraticTriangle& quadratic : part.quadratics) all.quadratics.push_back(quadratic);
      for (const PieceName& name : part.names) all.names.push_back(name);
      all.origins.insert(all.origins.end(), part.origins.begin(), part.origins.end());
      part = {};
    }
  }
  return all;
}

PieceSet::PieceSet(Blocks<QuadraticTriangle> given)
    : pieces_(std::make_shared<const Pieces>(Pieces{std::move(given), {}})) {}

PieceSet::PieceSet(std::span<const Point3> points, std::span<const std::array<std::uint32_t, 3>> triangles,
                   PowerOfTwo units)
    : points_(points), triangles_(triangles), units_(units) {}

QuadraticTriangle PieceSet::operator[](std::size_t piece) const {
  const QuadraticTriangle* const kept = this->kept(piece);
  return kept != nullptr ? *kept : flat_quadratic(facet(piece));
}

void PieceSet::take(Made&& made) {
  pieces_ = std::make_shared<const Pieces>(static_cast<Pieces&&>(made));
  tree_.reset();
}

PieceSet::PieceSet(const LimitSurface& surface, double error, int threads, const WorkMonitor& monitor,
                   std::uint64_t most, PowerOfTwo units)
    : surface_(&surface), units_(units) {
  const double own_error = units.inverse().apply(error);
  take(made_in_order(
      surface.patch_count(), most, threads, monitor, [&](std::size_t i, Count& count, FewMade& made) {
        const PatchId root(i);
        if (!surface.has_patch(root)) return;
        split_to(
            own_error, {}, surface, root, surface.patch(root), count,
            [&](const QuadraticTriangle& q, const PieceName& name) { made.add(in_units(q, units), name); });
      }));
}

PieceSet::PieceSet(const LimitSurface& surface, std::span<const PatchId> patches, double error,
                   const FinerPieces& finer, int threads, const WorkMonitor& monitor, std::uint64_t most)
    : surface_(&surface) {
  take(made_in_order(patches.size(), most, threads, monitor, [&](std::size_t i, Count& count, FewMade& made) {
    split_to(error, finer, surface, patches[i], surface.patch(patches[i]), count,
             [&](const QuadraticTriangle& q, const PieceName& name) { made.add(q, name); });
  }));
}

std::vector<std::uint32_t> PieceSet::refine(std::span<const std::uint8_t> which, double error, int threads,
                                            const WorkMonitor& monitor, std::uint64_t most) {
  if (surface_ == nullptr) return {};
  if (std::find(which.begin(), which.end(), std::uint8_t{1}) == which.end()) {
    std::vector<std::uint32_t> same(size());
    std::iota(same.begin(), same.end(), 0u);
    return same;
  }
  const double own_error = units_.inverse().apply(error);
  Made made = made_in_order(size(), most, threads, monitor, [&](std::size_t i, Count& count, FewMade& parts) {
    const PieceName& name = pieces_->names[i];
    if (which[i] == 0) {
      count.add();
      parts.add(pieces_->quadratics[i], name);
      return;
    }
    Patch patch = surface_->patch(name.patch);
    for (unsigned k = 0; k < name.path.level(); ++k) patch = split(patch, name.path.digit(k));
    split_to(
        own_error, {}, *surface_, name.patch, patch, count,
        [&](const QuadraticTriangle& q, const PieceName& part) { parts.add(in_units(q, units_), part); });
  });
  std::vector<std::uint32_t> origins = std::move(made.origins);
  if (made.names.size() > 0) take(std::move(made));
  return origins;
}

BoundedPoint PieceSet::point(std::size_t piece, TriangleParameter at) const {
  if (surface_ == nullptr) return {point_of((*this)[piece], at), given_point_error};
  const Patch patch = surface_->patch(name(piece).patch);
  return unscaled(limit_point(patch, to_face(name(piece).path, at)).from(patch.origin), units_);
}

std::optional<Place> PieceSet::place(std::size_t piece, TriangleParameter at) const {
  if (surface_ == nullptr) return std::nullopt;
  return place_of(*surface_, name(piece), at);
}

void PieceSet::prepare(int threads) {
  if (prepared()) return;
  std::vector<Point3> centres;
  centres.reserve(size());
  for (std::size_t i = 0; i < size(); ++i) {
    Vector3 sum;
    for (const Point3& x : (*this)[i].corners) sum = sum + (x - Point3{});
    centres.push_back(Point3{} + (1.0 / 3) * sum);
  }
  std::vector<WideNode> leaves((size() + WideBvh::leaf_size - 1) / WideBvh::leaf_size);
  WideBvh nodes(centres, threads,
                [&](std::size_t leaf, std::span<const std::uint32_t> items, std::vector<Obb>& boxes) {
                  std::array<Obb, WideBvh::leaf_size> of_leaf;
                  for (std::size_t k = 0; k < items.size(); ++k) of_leaf[k] = box_of((*this)[items[k]]);
                  leaves[leaf] = WideNode(std::span(of_leaf).first(items.size()));
                  boxes.push_back(merge(std::span(of_leaf).first(items.size())));
                });
  tree_ = std::make_shared<const Tree>(Tree{std::move(nodes), std::move(leaves)});
}

Box3 PieceSet::box() const {
  Box3 result;
  double error = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    for (const Point3& p : points_of((*this)[i])) result.add(p);
    error = std::max(error, this->error(i));
  }
  for (std::size_t a = 0; a < 3; ++a) {
    result.lower[a] -= enlarged(error) + distance_rounding;
    result.upper[a] += enlarged(error) + distance_rounding;
  }
  return result;
}

std::vector<std::uint32_t> in_order_of_place(std::span<const Point3> centres, int threads) {
  if (centres.empty()) return {};
  const WideBvh tree = WideBvh::in_order(centres, threads);
  std::vector<std::uint32_t> order;
  order.reserve(centres.size());
  for (std::size_t leaf = 0; leaf < tree.leaf_count(); ++leaf) {
    order.insert(order.end(), tree.leaf(leaf).begin(), tree.leaf(leaf).end());
  }
  return order;
}

bool overlap(const Box3& a, const Box3& b) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(a.lower[k] <= b.upper[k] && b.lower[k] <= a.upper[k])) return false;
  }
  return true;
}

PieceSet::SlackBox::SlackBox(const Obb& of)
    : box{of.centre, {}}, slack(0x1p-21 * (of.half.x + of.half.y + of.half.z)) {
  for (std::size_t k = 0; k < 3; ++k) {
    box.box.half[k] = static_cast<float>(of.half[k]);
    for (std::size_t a = 0; a < 3; ++a) box.box.axes[k][a] = static_cast<float>(of.axes[k][a]);
  }
}

}  // namespace snug
