#include <oracle/contact_twin.h>
#include <oracle/loop_net.h>
#include <oracle/patch_tree.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <queue>
#include <stdexcept>
#include <utility>
#include <vector>

namespace oracle {

namespace {

using detail::Kind;
using detail::Net;

constexpr double kRoundoff = 0x1p-52;

Point operator+(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Point operator*(double s, const Point& a) { return {s * a[0], s * a[1], s * a[2]}; }

/// Weights of the points of one net for a point of another.
struct Row {
  std::vector<std::pair<std::uint32_t, double>> weights;
  [[nodiscard]] Point apply(const Point* points) const {
    Point sum{};
    for (const auto& [i, w] : weights)
      for (std::size_t x = 0; x < 3; ++x) sum[x] += w * points[i][x];
    return sum;
  }
};

/// The split of a net, whatever its points: made once for each numbering of a connectivity.
struct Connectivity {
  Net<double> net;  // without meaning in its points
  bool regular;     // the patch is one polynomial
  std::array<Row, 3> limits;
  std::vector<Row> hull;  // the patch lies in the convex hull of these; empty until it is asked for
  bool split = false;
  std::array<std::uint32_t, 4> child{};
  std::array<std::vector<Row>, 4> rows;
};

class Connectivities {
 public:
  const Connectivity& operator[](std::uint32_t i) const { return list_[i]; }

  std::uint32_t find(const Net<double>& net) {
    Key key;
    for (const Kind kind : net.kinds) key.push_back(static_cast<std::uint32_t>(kind));
    for (const Triangle& t : net.triangles) key.insert(key.end(), t.begin(), t.end());
    const auto [at, is_new] = index_.try_emplace(std::move(key), static_cast<std::uint32_t>(list_.size()));
    if (!is_new) return at->second;
    Connectivity made;
    made.net = net;
    made.regular = is_regular(net);
    for_units(net, [&](const Net<double>& units, std::uint32_t first) {
      const auto limit = detail::limit_points(units, weights_);
      for (std::size_t k = 0; k < 3; ++k) add(made.limits[k], limit[k], first);
    });
    list_.push_back(std::move(made));
    return at->second;
  }

  const Connectivity& split(std::uint32_t i) {
    if (list_[i].split) return list_[i];
    const Net<double> net = list_[i].net;
    std::array<std::vector<Row>, 4> rows;
    std::array<Net<double>, 4> pieces;
    for_units(net, [&](const Net<double>& units, std::uint32_t first) {
      const Net<double> fine = detail::refine(units, weights_);
      for (std::size_t k = 0; k < 4; ++k) {
        pieces[k] = detail::neighbourhood(fine, k);
        rows[k].resize(pieces[k].points.size());
        for (std::size_t p = 0; p < rows[k].size(); ++p) add(rows[k][p], pieces[k].points[p], first);
      }
    });
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t child = find(pieces[k]);
      list_[i].child[k] = child;
    }
    list_[i].rows = std::move(rows);
    list_[i].split = true;
    return list_[i];
  }

  /// Of a regular patch its Bezier points, else those of its regular children and the nets of its other ones.
  const std::vector<Row>& hull(std::uint32_t i) {
    if (!list_[i].hull.empty()) return list_[i].hull;
    std::vector<Row> rows;
    if (list_[i].regular) {
      rows = bezier_rows(i);
    } else {
      split(i);
      for (std::size_t k = 0; k < 4; ++k) {
        const std::uint32_t child = list_[i].child[k];
        const std::vector<Row> parts =
            list_[child].regular ? hull(child) : unit_rows(list_[child].net.points.size());
        for (const Row& part : parts) {
          std::map<std::uint32_t, double> sum;
          for (const auto& [p, w] : part.weights)
            for (const auto& [q, x] : list_[i].rows[k][p].weights) sum[q] += w * x;
          Row row;
          row.weights.assign(sum.begin(), sum.end());
          const bool known = std::any_of(rows.begin(), rows.end(), [&](const Row& other) {
            return std::equal(row.weights.begin(), row.weights.end(), other.weights.begin(),
                              other.weights.end(), [](const auto& a, const auto& b) {
                                return a.first == b.first && std::abs(a.second - b.second) < 1e-15;
                              });
          });
          if (!known) rows.push_back(std::move(row));
        }
      }
    }
    list_[i].hull = std::move(rows);
    return list_[i].hull;
  }

 private:
  using Key = std::vector<std::uint32_t>;
  static constexpr std::size_t kDegree = 4, kBezierPoints = 15;

  static bool is_regular(const Net<double>& net) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto faces = std::count_if(net.triangles.begin(), net.triangles.end(), [&](const Triangle& t) {
        return t[0] == k || t[1] == k || t[2] == k;
      });
      if (net.kinds[k] != Kind::interior || faces != 6) return false;
    }
    return true;
  }

  /// Bezier points of a regular patch from its limit points on the lattice of fourths.
  /// Guarantee: exact to a rounding: all weights are multiples of 1/24.
  std::vector<Row> bezier_rows(std::uint32_t i) {
    constexpr std::size_t n = kBezierPoints;
    using Place = std::array<std::uint32_t, 2>;
    const std::size_t columns = list_[i].net.points.size();
    std::vector<std::vector<double>> table(n, std::vector<double>(n + columns));
    const auto number = [](const Place& p) { return p[1] * (2 * kDegree + 3 - p[1]) / 2 + p[0]; };
    const auto halve = [](const Place& a, const Place& b) {
      return Place{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2};
    };
    const std::array<Place, 3> whole{Place{0, 0}, Place{kDegree, 0}, Place{0, kDegree}};
    for (std::uint32_t a = 0; a <= kDegree; ++a)
      for (std::uint32_t b = 0; a + b <= kDegree; ++b) {
        const double u = a / 4.0, v = b / 4.0, factorial[] = {1, 1, 2, 6, 24};
        for (std::uint32_t p = 0; p <= kDegree; ++p)
          for (std::uint32_t q = 0; p + q <= kDegree; ++q)
            table[number({a, b})][number({p, q})] =
                24 / (factorial[p] * factorial[q] * factorial[4 - p - q]) * std::pow(u, p) * std::pow(v, q) *
                std::pow(1 - u - v, 4.0 - p - q);
      }
    split(i);
    for (std::size_t j = 0; j < 4; ++j) {
      const std::uint32_t child = split(i).child[j];
      split(child);
      for (std::size_t k = 0; k < 4; ++k) {
        const auto corners = detail::child_corners(detail::child_corners(whole, j, halve), k, halve);
        for_units(list_[i].net, [&](const Net<double>& units, std::uint32_t first) {
          const std::vector<Point> fine = applied(list_[i].rows[j], units.points);
          const std::vector<Point> finer = applied(list_[child].rows[k], fine);
          for (std::size_t c = 0; c < 3; ++c) {
            const Point at = list_[list_[child].child[k]].limits[c].apply(finer.data());
            for (std::size_t x = 0; x < 3 && first + x < columns; ++x)
              table[number(corners[c])][n + first + x] = at[x];
          }
        });
      }
    }
    for (std::size_t k = 0; k < n; ++k) {
      std::size_t pivot = k;
      for (std::size_t r = k; r < n; ++r)
        if (std::abs(table[r][k]) > std::abs(table[pivot][k])) pivot = r;
      std::swap(table[k], table[pivot]);
      for (std::size_t r = 0; r < n; ++r) {
        if (r == k) continue;
        const double factor = table[r][k] / table[k][k];
        for (std::size_t c = k; c < n + columns; ++c) table[r][c] -= factor * table[k][c];
      }
    }
    std::vector<Row> rows(n);
    for (std::size_t k = 0; k < n; ++k)
      for (std::uint32_t c = 0; c < columns; ++c) {
        const double weight = 24 * table[k][n + c] / table[k][k], whole_weight = std::round(weight);
        if (std::abs(weight - whole_weight) > 1e-9) throw std::logic_error("oracle: no multiple of 1/24");
        if (whole_weight != 0) rows[k].weights.emplace_back(c, whole_weight / 24);
      }
    return rows;
  }

  static std::vector<Point> applied(const std::vector<Row>& rows, const std::vector<Point>& points) {
    std::vector<Point> result;
    for (const Row& row : rows) result.push_back(row.apply(points.data()));
    return result;
  }

  static std::vector<Row> unit_rows(std::size_t count) {
    std::vector<Row> rows(count);
    for (std::uint32_t p = 0; p < count; ++p) rows[p].weights = {{p, 1.0}};
    return rows;
  }

  /// Calls use(net, i) with nets whose points i, i + 1 and i + 2 are the unit vectors and whose others are
  /// zero.
  template <class Use>
  static void for_units(const Net<double>& net, Use use) {
    Net<double> units = net;
    const auto count = static_cast<std::uint32_t>(net.points.size());
    for (std::uint32_t first = 0; first < count; first += 3) {
      for (Point& p : units.points) p = {};
      for (std::uint32_t x = 0; x < 3 && first + x < count; ++x) units.points[first + x][x] = 1;
      use(units, first);
    }
  }
  static void add(Row& row, const Point& image, std::uint32_t first) {
    for (std::uint32_t x = 0; x < 3; ++x)
      if (image[x] != 0) row.weights.emplace_back(first + x, image[x]);
  }

  std::vector<Connectivity> list_;
  std::map<Key, std::uint32_t> index_;
  detail::WeightTable<double> weights_;
};

/// Of all surfaces of a thread: they hold no coordinates.
Connectivities& known_connectivities() {
  thread_local Connectivities known;
  return known;
}

}  // namespace

struct ContactSurface::Tree final : detail::PatchTree {
  Connectivities& connectivities = known_connectivities();
  std::size_t net_size = 1;

  explicit Tree(const TwinMesh& mesh) {
    deepest = kDeepestPatch;
    const Net<double> net = detail::whole_net<double>(mesh);
    for (const Triangle& t : mesh.triangles)
      for (const std::uint32_t v : t)
        for (const double x : mesh.points[v]) largest = std::max(largest, std::abs(x));
    for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
      if (!detail::has_surface(net, f)) continue;
      const Net<double> around = detail::neighbourhood(net, f);
      const auto first = static_cast<std::uint32_t>(points.size());
      points.insert(points.end(), around.points.begin(), around.points.end());
      add_patch(connectivities.find(around), first, f, 0);
    }
    if (patches.empty()) throw std::invalid_argument("oracle: no face has a surface");
    root_count = patches.size();
    root_points = points.size();
  }

  /// Its net is made of the points from `net` on.
  void add_patch(std::uint32_t connectivity, std::uint32_t net, std::uint32_t face, std::uint32_t level) {
    detail::TreePatch patch;
    patch.kind = connectivity;
    patch.net = net;
    patch.hull = static_cast<std::uint32_t>(points.size());
    patch.face = face;
    patch.level = level;
    net_size = std::max<std::size_t>(net_size, points.size() - net);
    for (const Row& row : connectivities.hull(connectivity)) {
      const Point p = row.apply(points.data() + net);
      points.push_back(p);
    }
    patch.hull_count = static_cast<std::uint32_t>(points.size()) - patch.hull;
    patch.corners = static_cast<std::uint32_t>(points.size());
    patch.corner_count = 3;
    for (std::size_t k = 0; k < 3; ++k) {
      const Point p = connectivities[connectivity].limits[k].apply(points.data() + net);
      points.push_back(p);
    }
    append(patch);
  }

  void trim() { PatchTree::trim(kLargestTree, SIZE_MAX); }

  [[nodiscard]] double error(std::uint32_t level) const override {
    return 2 * static_cast<double>((level + 2) * (net_size + 16)) * kRoundoff * largest;
  }

 private:
  void make_children(std::uint32_t index) override {
    const detail::TreePatch parent = patches[index];
    connectivities.split(parent.kind);
    for (std::size_t k = 0; k < 4; ++k) {
      const auto net = static_cast<std::uint32_t>(points.size());
      const Connectivity& how = connectivities[parent.kind];
      for (const Row& row : how.rows[k]) {
        const Point p = row.apply(points.data() + parent.net);
        points.push_back(p);
      }
      add_patch(how.child[k], net, parent.face, parent.level + 1);
    }
  }
};

ContactBounds contact_bounds(ContactSurface& a, const Placement& place_a, ContactSurface& b,
                             const Placement& place_b, const ContactGoal& goal) {
  a.tree_->trim();
  b.tree_->trim();
  return detail::tree_bounds(*a.tree_, place_a, *b.tree_, place_b, goal);
}

ContactSurface::ContactSurface(const TwinMesh& mesh) : tree_(std::make_unique<Tree>(mesh)) {}
ContactSurface::~ContactSurface() = default;
ContactSurface::ContactSurface(ContactSurface&&) noexcept = default;
ContactSurface& ContactSurface::operator=(ContactSurface&&) noexcept = default;

ContactBounds ContactSurface::distance_to(const Placement& placement, const Point& point,
                                          const ContactGoal& goal, std::optional<std::uint32_t> face) {
  tree_->trim();
  return detail::tree_distance_to(*tree_, placement, point, goal, face);
}

bool ContactSurface::on_surface(const Placement& placement, const Point& point, double tolerance,
                                std::optional<std::uint32_t> face) {
  ContactGoal goal;
  goal.threshold = tolerance;
  return distance_to(placement, point, goal, face).upper <= tolerance;
}

bool ContactSurface::misses(const Placement& placement, const Point& p, const Point& q) {
  tree_->trim();
  Placement at = kUnmoved;
  Point along{};
  for (std::size_t x = 0; x < 3; ++x) {
    at[4 * x + 3] = p[x];
    along[x] = q[x] - p[x];
  }
  detail::SegmentTree segment({0, 0, 0}, along);
  ContactGoal goal;
  goal.threshold = 0;
  goal.effort = 300;
  return detail::tree_bounds(*tree_, placement, segment, at, goal).lower > 0;
}

Point ContactSurface::limit_point(std::uint32_t face, double u, double v) {
  const auto end = tree_->patches.begin() + static_cast<std::ptrdiff_t>(tree_->root_count);
  const auto root =
      std::find_if(tree_->patches.begin(), end, [&](const auto& patch) { return patch.face == face; });
  if (root == end) throw std::invalid_argument("oracle: the face has no surface");
  if (!(u >= 0) || !(v >= 0) || !(u + v <= 1))
    throw std::invalid_argument("oracle: a parameter is out of range");
  std::vector<Point> net(tree_->points.data() + root->net, tree_->points.data() + root->hull), fine;
  std::uint32_t connectivity = root->kind;
  for (std::uint32_t level = 0; level < kDeepestPatch; ++level) {
    std::size_t child = 3;
    if (u >= 0.5)
      child = 1, u = 2 * u - 1, v = 2 * v;
    else if (v >= 0.5)
      child = 2, u = 2 * u, v = 2 * v - 1;
    else if (u + v <= 0.5)
      child = 0, u = 2 * u, v = 2 * v;
    else
      u = 1 - 2 * u, v = 1 - 2 * v;
    const Connectivity& how = tree_->connectivities.split(connectivity);
    fine.clear();
    for (const Row& row : how.rows[child]) fine.push_back(row.apply(net.data()));
    net.swap(fine);
    connectivity = how.child[child];
  }
  const auto& limits = tree_->connectivities[connectivity].limits;
  return (1 - u - v) * limits[0].apply(net.data()) + u * limits[1].apply(net.data()) +
         v * limits[2].apply(net.data());
}

double ContactSurface::largest() const { return tree_->largest; }

}  // namespace oracle
