#include <oracle/contact_twin.h>
#include <oracle/loop_net.h>

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

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRoundoff = 0x1p-52;
constexpr std::uint32_t kNone = UINT32_MAX;

Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Point operator+(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Point operator*(double s, const Point& a) { return {s * a[0], s * a[1], s * a[2]}; }
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double length(const Point& a) { return std::sqrt(dot(a, a)); }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The 3 x 3 part alone.
struct Turn {
  std::array<Point, 3> row;
  double stretch;  // at least its spectral norm

  explicit Turn(const Placement& m) : row{Point{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}} {
    double largest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      double sum = 0;
      for (std::size_t j = 0; j < 3; ++j)
        sum += std::abs(row[0][i] * row[0][j] + row[1][i] * row[1][j] + row[2][i] * row[2][j]);
      largest = std::max(largest, sum);
    }
    stretch = std::sqrt(largest) * (1 + 1e-14);
  }
  [[nodiscard]] Point apply(const Point& p) const { return {dot(row[0], p), dot(row[1], p), dot(row[2], p)}; }
  [[nodiscard]] Point pull_back(const Point& d) const {
    return d[0] * row[0] + d[1] * row[1] + d[2] * row[2];
  }
};

void check_placement(const Placement& m) {
  for (const double x : m)
    if (!std::isfinite(x)) throw std::invalid_argument("oracle: a placement is not finite");
}

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

/// What splitting a net does, whatever its points: made once for each numbering of a connectivity.
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

  /// Calls use(net, i) with nets whose points i, i + 1 and i + 2 are the unit vectors and whose others are zero.
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

struct Patch {
  std::uint32_t connectivity;
  std::uint32_t net;               // its first point; the net of the limit patch
  std::uint32_t hull, hull_count;  // points whose convex hull contains the limit patch
  std::uint32_t first_child = kNone;
  std::uint32_t face, level;
  Point centre;
  double radius;  // of a ball around the hull
  std::array<Point, 3> corners;
};

void find_ball(const Point* hull, Patch& patch) {
  Point lower = hull[0], upper = hull[0];
  for (std::size_t i = 1; i < patch.hull_count; ++i)
    for (std::size_t x = 0; x < 3; ++x) {
      lower[x] = std::min(lower[x], hull[i][x]);
      upper[x] = std::max(upper[x], hull[i][x]);
    }
  for (std::size_t x = 0; x < 3; ++x) patch.centre[x] = lower[x] + (upper[x] - lower[x]) / 2;
  double largest = 0;
  for (std::size_t i = 0; i < patch.hull_count; ++i) {
    const Point r = hull[i] - patch.centre;
    largest = std::max(largest, dot(r, r));
  }
  patch.radius = std::sqrt(largest) * (1 + 1e-14);
}

/// Of all surfaces of a thread: they hold no coordinates.
Connectivities& known_connectivities() {
  thread_local Connectivities known;
  return known;
}

}  // namespace

struct ContactSurface::Tree {
  Connectivities& connectivities = known_connectivities();
  std::vector<Point> points;
  std::vector<Patch> patches;
  std::size_t root_count = 0, root_points = 0;
  std::size_t net_size = 1;
  double largest = 0;

  Tree(const Point& p, const Point& q) {
    points = {p, q};
    Patch patch{};
    patch.connectivity = kNone;
    patch.hull_count = 2;
    patch.level = kDeepestPatch;
    patch.first_child = kNone;
    patch.corners = {p, q, q};
    find_ball(points.data(), patch);
    patches.push_back(patch);
    root_count = 1;
    root_points = 2;
    for (const Point& point : points)
      for (const double x : point) largest = std::max(largest, std::abs(x));
  }

  explicit Tree(const TwinMesh& mesh) {
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
    Patch patch{};
    patch.connectivity = connectivity;
    patch.net = net;
    patch.hull = static_cast<std::uint32_t>(points.size());
    patch.first_child = kNone;
    patch.face = face;
    patch.level = level;
    net_size = std::max<std::size_t>(net_size, points.size() - net);
    for (std::size_t k = 0; k < 3; ++k)
      patch.corners[k] = connectivities[connectivity].limits[k].apply(points.data() + net);
    for (const Row& row : connectivities.hull(connectivity)) {
      const Point p = row.apply(points.data() + net);
      points.push_back(p);
    }
    patch.hull_count = static_cast<std::uint32_t>(points.size()) - patch.hull;
    find_ball(points.data() + patch.hull, patch);
    patches.push_back(patch);
  }

  /// First of the four children.
  std::uint32_t split(std::uint32_t index) {
    if (patches[index].first_child != kNone) return patches[index].first_child;
    const Patch parent = patches[index];
    const auto first = static_cast<std::uint32_t>(patches.size());
    connectivities.split(parent.connectivity);
    for (std::size_t k = 0; k < 4; ++k) {
      const auto net = static_cast<std::uint32_t>(points.size());
      const Connectivity& how = connectivities[parent.connectivity];
      for (const Row& row : how.rows[k]) {
        const Point p = row.apply(points.data() + parent.net);
        points.push_back(p);
      }
      add_patch(how.child[k], net, parent.face, parent.level + 1);
    }
    patches[index].first_child = first;
    return first;
  }

  void trim() {
    if (patches.size() <= kLargestTree) return;
    patches.resize(root_count);
    points.resize(root_points);
    for (Patch& patch : patches) patch.first_child = kNone;
  }

  /// How far points of a net of this level are off, as vectors.
  [[nodiscard]] double error(std::uint32_t level) const {
    if (root_points == 2) return 0;
    return 2 * static_cast<double>((level + 2) * (net_size + 16)) * kRoundoff * largest;
  }
};

class ContactSearch {
 public:
  using Tree = ContactSurface::Tree;
  static Tree& tree(ContactSurface& surface) { return *surface.tree_; }

  ContactSearch(Tree& a, const Placement& place_a, Tree& b, const Placement& place_b, const ContactGoal& goal)
      : a_(a),
        b_(b),
        turn_a_(place_a),
        turn_b_(place_b),
        origin_{place_a[3], place_a[7], place_a[11]},
        shift_{place_b[3] - place_a[3], place_b[7] - place_a[7], place_b[11] - place_a[11]},
        goal_(goal) {
    for (std::size_t x = 0; x < 3; ++x) shift_size_ = std::max(shift_size_, std::abs(shift_[x]));
    common_error_ =
        32 * kRoundoff * (turn_a_.stretch * a.largest + turn_b_.stretch * b.largest + shift_size_);
  }

  ContactBounds run(std::optional<std::uint32_t> face_a) {
    start(face_a);
    bool spent = false;
    while (!open_.empty() && !reached(std::min(open_.top().lower, left_))) {
      const Pair pair = open_.top();
      const bool can_a = a_.patches[pair.a].level < ContactSurface::kDeepestPatch,
                 can_b = b_.patches[pair.b].level < ContactSurface::kDeepestPatch;
      if (pair.tight && !can_a && !can_b) break;  // no other pair can raise the lower bound
      if (++steps_ > goal_.effort) {
        spent = true;
        break;
      }
      open_.pop();
      if (good_enough(pair.lower))
        left_ = std::min(left_, pair.lower);
      else if (pair.tight)
        split(pair, can_a, can_b);
      else
        consider_closely(pair);
    }
    double lower = std::min(left_, upper_);
    if (!open_.empty()) lower = std::min(lower, open_.top().lower);
    return {std::max(lower, 0.0), upper_, on_a_ + origin_, on_b_ + origin_, spent};
  }

 private:
  struct Pair {
    double lower;
    double guess;  // distance of two points in the hulls: among equal bounds the closest pair goes first
    std::uint32_t a, b;
    bool tight;
    bool operator<(const Pair& other) const {
      return lower != other.lower ? lower > other.lower : guess > other.guess;
    }
  };
  struct Ball {
    std::uint32_t index;
    Point centre;
    double radius;
  };

  // In a frame turned like the world, with its origin where A's origin is.
  [[nodiscard]] Point placed_a(const Point& p) const { return turn_a_.apply(p); }
  [[nodiscard]] Point placed_b(const Point& p) const { return turn_b_.apply(p) + shift_; }
  [[nodiscard]] Ball ball_a(std::uint32_t i) const {
    return {i, placed_a(a_.patches[i].centre), a_.patches[i].radius * turn_a_.stretch};
  }
  [[nodiscard]] Ball ball_b(std::uint32_t i) const {
    return {i, placed_b(b_.patches[i].centre), b_.patches[i].radius * turn_b_.stretch};
  }
  [[nodiscard]] double error(std::uint32_t a, std::uint32_t b) const {
    return turn_a_.stretch * a_.error(a_.patches[a].level) + turn_b_.stretch * b_.error(b_.patches[b].level) +
           common_error_;
  }

  [[nodiscard]] double slackness() const {
    return std::max(goal_.precision.absolute, goal_.precision.relative * upper_);
  }
  [[nodiscard]] bool reached(double lower) const {
    if (goal_.threshold && (upper_ <= *goal_.threshold || lower > *goal_.threshold)) return true;
    return upper_ - lower <= slackness();
  }
  [[nodiscard]] bool good_enough(double lower) const {
    return (goal_.threshold && lower > *goal_.threshold) || lower >= upper_ - slackness();
  }

  void start(std::optional<std::uint32_t> face_a) {
    std::vector<Ball> as, bs;
    for (std::uint32_t i = 0; i < a_.root_count; ++i)
      if (!face_a || a_.patches[i].face == *face_a) as.push_back(ball_a(i));
    if (as.empty()) throw std::invalid_argument("oracle: the face has no surface");
    for (std::uint32_t i = 0; i < b_.root_count; ++i) bs.push_back(ball_b(i));
    // The nearest centres give a first pair of points.
    double nearest = kInfinity;
    std::pair<std::uint32_t, std::uint32_t> first;
    for (const Ball& a : as)
      for (const Ball& b : bs) {
        const Point d = b.centre - a.centre;
        if (const double found = dot(d, d); found < nearest) {
          nearest = found;
          first = {a.index, b.index};
        }
      }
    nearest_corners(first.first, first.second);
    for (const Ball& a : as)
      for (const Ball& b : bs) consider(a, b, 0, true);
  }

  void split(const Pair& pair, bool can_a, bool can_b) {
    const bool split_a = can_a && (!can_b || a_.patches[pair.a].radius * turn_a_.stretch >=
                                                 b_.patches[pair.b].radius * turn_b_.stretch);
    if (split_a) {
      const std::uint32_t first = a_.split(pair.a);
      const Ball b = ball_b(pair.b);
      for (std::uint32_t k = 0; k < 4; ++k) consider(ball_a(first + k), b, pair.lower, false);
    } else {
      const std::uint32_t first = b_.split(pair.b);
      const Ball a = ball_a(pair.a);
      for (std::uint32_t k = 0; k < 4; ++k) consider(a, ball_b(first + k), pair.lower, false);
    }
  }

  /// known: a lower bound of what the two are parts of.
  void consider(const Ball& a, const Ball& b, double known, bool lazily) {
    const Point d = b.centre - a.centre;
    const double between = length(d);
    const double balls = between * (1 - 1e-14) - a.radius - b.radius - error(a.index, b.index);
    const double lower = std::max(known, balls);
    if (good_enough(lower))
      left_ = std::min(left_, lower);
    else if (lower > 0 && !lazily)
      consider_closely({lower, between, a.index, b.index, false});
    else  // in its turn: where the surfaces meet, few of these get one
      open_.push({lower, between, a.index, b.index, false});
  }

  /// From the nearest corner of A to the nearest of B.
  Point nearest_corners(std::uint32_t a, std::uint32_t b) {
    std::array<Point, 3> as, bs;
    for (std::size_t k = 0; k < 3; ++k) {
      as[k] = placed_a(a_.patches[a].corners[k]);
      bs[k] = placed_b(b_.patches[b].corners[k]);
    }
    double shortest = kInfinity;
    Point gap{}, on_a{}, on_b{};
    for (const Point& p : as)
      for (const Point& q : bs) {
        const Point between = q - p;
        if (const double d = dot(between, between); d < shortest) {
          shortest = d;
          gap = between;
          on_a = p;
          on_b = q;
        }
      }
    const double d = std::sqrt(shortest) * (1 + 1e-14) + error(a, b);
    if (d < upper_) {
      upper_ = d;
      on_a_ = on_a;
      on_b_ = on_b;
    }
    normals_ = {cross(as[1] - as[0], as[2] - as[0]), cross(bs[1] - bs[0], bs[2] - bs[0])};
    return gap;
  }

  struct Support {
    double gap;   // of the hulls along a direction
    Point point;  // of hull(b) - hull(a)
  };
  [[nodiscard]] Support support(std::uint32_t a, std::uint32_t b, const Point& direction) const {
    const Point in_a = turn_a_.pull_back(direction), in_b = turn_b_.pull_back(direction);
    const Patch &pa = a_.patches[a], &pb = b_.patches[b];
    const Point* hull_a = a_.points.data() + pa.hull;
    const Point* hull_b = b_.points.data() + pb.hull;
    std::size_t most = 0, least = 0;
    double most_a = -kInfinity, least_b = kInfinity;
    for (std::size_t i = 0; i < pa.hull_count; ++i)
      if (const double h = dot(in_a, hull_a[i]); h > most_a) {
        most_a = h;
        most = i;
      }
    for (std::size_t i = 0; i < pb.hull_count; ++i)
      if (const double h = dot(in_b, hull_b[i]); h < least_b) {
        least_b = h;
        least = i;
      }
    return {least_b - most_a + dot(direction, shift_), placed_b(hull_b[least]) - placed_a(hull_a[most])};
  }

  void consider_closely(Pair pair) {
    pair.tight = true;
    Point gap = nearest_corners(pair.a, pair.b);
    pair.guess = length(gap);
    const double error_here = error(pair.a, pair.b);
    const auto improve = [&](double found) {
      pair.lower = std::max(pair.lower, found * (1 - 1e-14) - error_here);
      return good_enough(pair.lower);
    };
    // Along the normals, then Gilbert's iteration from a point of hull(b) - hull(a) towards the one nearest to 0.
    bool done = false;
    for (Point normal : normals_) {
      const double size = length(normal);
      if (!(size > 0) || done) continue;
      normal = (dot(normal, gap) < 0 ? -1 / size : 1 / size) * normal;
      done = improve(support(pair.a, pair.b, normal).gap);
    }
    constexpr int kSteps = 10;
    for (int step = 0; step < kSteps && !done; ++step) {
      const double size = length(gap);
      pair.guess = std::min(pair.guess, size);
      if (!(size > 0) || size <= pair.lower * (1 + 1e-15)) break;
      const Support found = support(pair.a, pair.b, (1 / size) * gap);
      done = improve(found.gap);
      const Point along = found.point - gap;
      const double squared = dot(along, along);
      if (!(squared > 0)) break;
      const double t = std::clamp(-dot(gap, along) / squared, 0.0, 1.0);
      if (t == 0) break;
      gap = gap + t * along;
    }
    if (good_enough(pair.lower))
      left_ = std::min(left_, pair.lower);
    else
      open_.push(pair);
  }

  Tree &a_, &b_;
  Turn turn_a_, turn_b_;
  Point origin_, shift_;
  double shift_size_ = 0, common_error_ = 0;
  ContactGoal goal_;
  std::priority_queue<Pair> open_;
  std::array<Point, 2> normals_{};
  double upper_ = kInfinity;
  double left_ = kInfinity;  // least bound of the pairs that need no split
  std::size_t steps_ = 0;
  Point on_a_{}, on_b_{};
};

ContactBounds contact_bounds(ContactSurface& a, const Placement& place_a, ContactSurface& b,
                             const Placement& place_b, const ContactGoal& goal) {
  check_placement(place_a);
  check_placement(place_b);
  ContactSearch::tree(a).trim();
  ContactSearch::tree(b).trim();
  return ContactSearch(ContactSearch::tree(a), place_a, ContactSearch::tree(b), place_b, goal).run({});
}

ContactSurface::ContactSurface(const TwinMesh& mesh) : tree_(std::make_unique<Tree>(mesh)) {}
ContactSurface::ContactSurface(const Point& p, const Point& q) : tree_(std::make_unique<Tree>(p, q)) {}
ContactSurface::~ContactSurface() = default;
ContactSurface::ContactSurface(ContactSurface&&) noexcept = default;
ContactSurface& ContactSurface::operator=(ContactSurface&&) noexcept = default;

ContactBounds ContactSurface::distance_to(const Placement& placement, const Point& point,
                                          const ContactGoal& goal, std::optional<std::uint32_t> face) {
  check_placement(placement);
  tree_->trim();
  // The point as a translation: exact, and as near as the translations are.
  Tree origin({0, 0, 0}, {0, 0, 0});
  Placement at = kUnmoved;
  for (std::size_t x = 0; x < 3; ++x) at[4 * x + 3] = point[x];
  return ContactSearch(*tree_, placement, origin, at, goal).run(face);
}

bool ContactSurface::on_surface(const Placement& placement, const Point& point, double tolerance,
                                std::optional<std::uint32_t> face) {
  ContactGoal goal;
  goal.threshold = tolerance;
  return distance_to(placement, point, goal, face).upper <= tolerance;
}

bool ContactSurface::misses(const Placement& placement, const Point& p, const Point& q) {
  check_placement(placement);
  tree_->trim();
  Placement at = kUnmoved;
  Point along{};
  for (std::size_t x = 0; x < 3; ++x) {
    at[4 * x + 3] = p[x];
    along[x] = q[x] - p[x];
  }
  Tree segment({0, 0, 0}, along);
  ContactGoal goal;
  goal.threshold = 0;
  goal.effort = 300;
  return ContactSearch(*tree_, placement, segment, at, goal).run({}).lower > 0;
}

Point ContactSurface::limit_point(std::uint32_t face, double u, double v) {
  const auto end = tree_->patches.begin() + static_cast<std::ptrdiff_t>(tree_->root_count);
  const auto root =
      std::find_if(tree_->patches.begin(), end, [&](const Patch& patch) { return patch.face == face; });
  if (root == end) throw std::invalid_argument("oracle: the face has no surface");
  if (!(u >= 0) || !(v >= 0) || !(u + v <= 1))
    throw std::invalid_argument("oracle: a parameter is out of range");
  std::vector<Point> net(tree_->points.data() + root->net, tree_->points.data() + root->hull), fine;
  std::uint32_t connectivity = root->connectivity;
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
