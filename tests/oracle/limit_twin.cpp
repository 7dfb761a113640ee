#include <oracle/limit_kinds.h>
#include <oracle/limit_twin.h>
#include <oracle/patch_tree.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace oracle {

namespace {

using detail::PatchKind;
using detail::PatchKinds;
using detail::TreePatch;
using Id = std::uint32_t;

constexpr double kRoundoff = 0x1p-52;
constexpr std::size_t kMostPatches = 60'000, kMostPoints = 6'000'000;
constexpr Id kDeepest = 46;

Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double length(const Point& a) { return std::sqrt(dot(a, a)); }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

std::vector<Point> applied(const std::vector<detail::WeightRow>& rows, const Point* points) {
  std::vector<Point> result;
  result.reserve(rows.size());
  for (const auto& row : rows) result.push_back(row.apply(points));
  return result;
}

/// Solid angle of a triangle as the origin sees it, signed, by Van Oosterom and Strackee's formula.
double solid_angle(const Point& a, const Point& b, const Point& c) {
  const double x = length(a), y = length(b), z = length(c);
  return 2 * std::atan2(dot(a, cross(b, c)), x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y);
}

}  // namespace

struct LimitRules::Kinds {
  std::unique_ptr<PatchKinds> all;
};
LimitRules::LimitRules(const Rules& rules)
    : kinds_(std::make_unique<Kinds>(Kinds{detail::primal_kinds(rules)})) {}
LimitRules::LimitRules(DualScheme scheme)
    : kinds_(std::make_unique<Kinds>(Kinds{detail::dual_kinds(scheme)})) {}
LimitRules::~LimitRules() = default;

struct LimitTwin::Tree final : detail::PatchTree {
  std::shared_ptr<LimitRules> rules;
  PatchKinds& kinds;
  std::size_t net_size = 1;

  struct Corner {
    Point point;
    double error;
  };
  using Corners = std::vector<std::optional<Corner>>;

  Tree(const TaggedMesh& mesh, std::shared_ptr<LimitRules> with)
      : rules(std::move(with)), kinds(*rules->kinds_->all) {
    deepest = kDeepest;
    for (const auto& polygon : mesh.polygons)
      for (const Id v : polygon)
        for (const double x : mesh.points[v]) largest = std::max(largest, std::abs(x));
    std::map<Id, Corner> limits;  // of control vertices without a formula
    for (const detail::RootPatch& root : kinds.roots(mesh)) {
      std::vector<Point> net;
      for (const Id v : root.vertices) net.push_back(mesh.points[v]);
      Corners known(kinds[root.kind].corners.size());
      for (Id k = 0; k < known.size(); ++k) {
        if (kinds[root.kind].corners[k]) continue;
        const auto at = limits.find(root.vertices[k]);
        known[k] = at != limits.end() ? at->second : limits[root.vertices[k]] = limit_of(root.kind, net, k);
      }
      add_patch(root.kind, net, known, root.owner, 0);
    }
    if (patches.empty()) throw std::invalid_argument("oracle: there is no surface");
    root_count = patches.size();
    root_points = points.size();
  }

  /// `known`: corners that it has from its parent.
  void add_patch(Id kind, const std::vector<Point>& net, const Corners& known, Id face, Id level) {
    TreePatch patch;
    patch.kind = kind;
    patch.face = face;
    patch.level = level;
    patch.net = patch.hull = static_cast<Id>(points.size());
    patch.hull_count = static_cast<Id>(net.size());
    points.insert(points.end(), net.begin(), net.end());
    net_size = std::max(net_size, net.size());
    if (const auto& rows = kinds.hull(kind); !rows.empty()) {
      patch.hull = static_cast<Id>(points.size());
      patch.hull_count = static_cast<Id>(rows.size());
      for (const auto& row : rows) points.push_back(row.apply(net.data()));
    }
    patch.corners = static_cast<Id>(points.size());
    patch.corner_count = static_cast<Id>(kinds[kind].corners.size());
    for (Id k = 0; k < patch.corner_count; ++k) {
      const Corner corner = k < known.size() && known[k] ? *known[k] : limit_of(kind, net, k);
      points.push_back(corner.point);
      patch.corner_error = std::max(patch.corner_error, corner.error);
    }
    append(patch);
  }

  /// Where there is no formula, by going to the child at the corner until there is one, or nothing is left to
  /// go.
  [[nodiscard]] Corner limit_of(Id kind, std::vector<Point> net, Id corner) const {
    double extent = 0;
    for (Id level = 0;; ++level) {
      if (const auto& row = kinds[kind].corners[corner]) return {row->apply(net.data()), 0};
      const auto& children = kinds.split(kind).children;
      const auto child = std::find_if(children.begin(), children.end(), [&](const PatchKind::Child& c) {
        return c.corner_of_parent == corner;
      });
      net = applied(child->rows, net.data());
      kind = child->kind;
      corner = *child->corner;
      extent = 0;
      for (const Point& p : net) extent = std::max(extent, length(p - net[0]));
      if (extent <= 0x1p-50 * largest || level >= 150) return {net[0], extent};
    }
  }

  void trim() { PatchTree::trim(kMostPatches, kMostPoints); }

  [[nodiscard]] double error(Id level) const override {
    return 2 * static_cast<double>((level + 2) * (net_size + 16)) * kRoundoff * largest;
  }

 private:
  void make_children(Id index) override {
    const TreePatch parent = patches[index];
    const std::size_t count = kinds.split(parent.kind).children.size();
    patches[index].child_count = static_cast<Id>(count);
    for (std::size_t k = 0; k < count; ++k) {
      const auto& child = kinds[parent.kind].children[k];
      Corners known;
      if (child.corner) {
        known.resize(*child.corner + 1);
        known.back() = Corner{points[parent.corners + *child.corner_of_parent], parent.corner_error};
      }
      const Id kind = child.kind;
      add_patch(kind, applied(child.rows, points.data() + parent.net), known, parent.face, parent.level + 1);
    }
  }
};

LimitTwin::LimitTwin(const TaggedMesh& mesh, std::shared_ptr<LimitRules> rules)
    : tree_(std::make_unique<Tree>(mesh, std::move(rules))) {}
LimitTwin::~LimitTwin() = default;
LimitTwin::LimitTwin(LimitTwin&&) noexcept = default;
LimitTwin& LimitTwin::operator=(LimitTwin&&) noexcept = default;

ContactBounds contact_bounds(LimitTwin& a, const Placement& place_a, LimitTwin& b, const Placement& place_b,
                             const ContactGoal& goal) {
  a.tree_->trim();
  b.tree_->trim();
  return detail::tree_bounds(*a.tree_, place_a, *b.tree_, place_b, goal);
}

ContactBounds LimitTwin::distance_to(const Placement& placement, const Point& point, const ContactGoal& goal,
                                     std::optional<Id> owner) {
  tree_->trim();
  return detail::tree_distance_to(*tree_, placement, point, goal, owner);
}

bool LimitTwin::on_surface(const Placement& placement, const Point& point, double tolerance,
                           std::optional<Id> owner) {
  ContactGoal goal;
  goal.threshold = tolerance;
  return distance_to(placement, point, goal, owner).upper <= tolerance;
}

Point LimitTwin::limit_point(Id face, Id part, double u, double v) {
  const auto end = tree_->patches.begin() + static_cast<std::ptrdiff_t>(tree_->root_count);
  const auto root =
      std::find_if(tree_->patches.begin(), end, [&](const TreePatch& patch) { return patch.face == face; });
  if (root == end) throw std::invalid_argument("oracle: the face has no surface");
  Id kind = root->kind;
  const Point* first = tree_->points.data() + root->net;
  std::vector<Point> net(first, first + tree_->kinds[kind].point_count);
  const auto descend = [&](std::size_t k) {
    const PatchKind::Child& child = tree_->kinds.split(kind).children[k];
    net = applied(child.rows, net.data());
    kind = child.kind;
  };
  const bool triangles = tree_->kinds.split(kind).children.back().corner_of_parent == std::nullopt;
  if (tree_->kinds.split(kind).children[0].corner == 0 && tree_->kinds[kind].children.size() != 4)
    descend(part);
  for (Id level = 0; level < kDeepest; ++level) {
    std::size_t child = 0;
    if (triangles) {
      child = u >= 0.5 ? 1 : v >= 0.5 ? 2 : u + v <= 0.5 ? 0 : 3;
      if (child == 3)
        u = 1 - 2 * u, v = 1 - 2 * v;
      else
        u = 2 * u - (child == 1 ? 1 : 0), v = 2 * v - (child == 2 ? 1 : 0);
    } else {
      child = v < 0.5 ? (u < 0.5 ? 0 : 1) : (u < 0.5 ? 3 : 2);
      u = 2 * u - (child == 1 || child == 2 ? 1 : 0);
      v = 2 * v - (child >= 2 ? 1 : 0);
    }
    descend(child);
  }
  Point sum{};
  const double weights[2][4] = {{(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v}, {1 - u - v, u, v, 0}};
  for (Id k = 0; k < (triangles ? 3U : 4U); ++k) {
    const Point p = tree_->limit_of(kind, net, k).point;
    for (std::size_t x = 0; x < 3; ++x) sum[x] += weights[triangles ? 1 : 0][k] * p[x];
  }
  return sum;
}

Point LimitTwin::some_limit_point(std::size_t i) const {
  const TreePatch& patch = tree_->patches[i % tree_->root_count];
  return tree_->points[patch.corners + i / tree_->root_count % patch.corner_count];
}

std::optional<int> LimitTwin::winding_number(const Point& point, int max_levels) {
  tree_->trim();
  std::vector<Id> patches(tree_->root_count);
  for (Id i = 0; i < patches.size(); ++i) patches[i] = i;
  const auto beyond = [&](Id i) {  // is the point outside of the hull of a patch?
    const TreePatch& patch = tree_->patches[i];
    const Point away = patch.centre - point;
    const double size = length(away), error = 4 * tree_->error(patch.level) + 0x1p-48 * length(point);
    if (size > patch.radius + error) return true;
    for (Id k = 0; k < patch.hull_count; ++k)
      if (dot(away, tree_->points[patch.hull + k] - point) <= size * error) return false;
    return true;
  };
  for (int level = 0; level <= max_levels; ++level) {
    if (std::all_of(patches.begin(), patches.end(), beyond)) {
      double sum = 0;
      for (const Id i : patches) {
        const TreePatch& patch = tree_->patches[i];
        const Point* corner = tree_->points.data() + patch.corners;
        for (Id k = 1; k + 1 < patch.corner_count; ++k)
          sum += solid_angle(corner[0] - point, corner[k] - point, corner[k + 1] - point);
      }
      const double turns = sum / (4 * std::numbers::pi);
      if (std::abs(turns - std::round(turns)) > 1e-6)
        throw std::invalid_argument("oracle: the surface is not closed");
      return static_cast<int>(std::lround(turns));
    }
    std::vector<Id> finer;
    for (const Id i : patches) {
      const Id first = tree_->split(i);
      for (Id k = 0; k < tree_->patches[i].child_count; ++k) finer.push_back(first + k);
    }
    patches = std::move(finer);
  }
  return {};
}

double LimitTwin::largest() const { return tree_->largest; }

}  // namespace oracle
