#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <vector>

#include <oracle/test_meshes.h>
#include <testing/contact_trials.h>
#include <testing/counts.h>
#include <testing/exact_triangles.h>
#include <testing/surfaces.h>
#include <testing/twins.h>

namespace snug::testing {

namespace {

using oracle::Boundary;
using oracle::Point;
using oracle::TwinMesh;
namespace meshes = oracle::meshes;

/// Trials of a block share the surfaces that are dear to make.
constexpr std::uint64_t trials_a_block = 2000;

double size_of(const TwinMesh& mesh) {
  Point lower = mesh.points[mesh.triangles[0][0]], upper = lower;
  for (const oracle::Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t)
      for (std::size_t x = 0; x < 3; ++x) {
        lower[x] = std::min(lower[x], mesh.points[v][x]);
        upper[x] = std::max(upper[x], mesh.points[v][x]);
      }
  return std::max({upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]});
}

double length(const Point& p) { return std::hypot(p[0], p[1], p[2]); }

struct Dice {
  std::mt19937_64& random;
  double unit() { return static_cast<double>(random() >> 11) * 0x1p-53; }
  double between(double a, double b) { return a + (b - a) * unit(); }
  bool one_in(std::uint64_t n) { return random() % n == 0; }
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); }
  /// From least to most, all sizes alike.
  double size(double least, double most) { return least * std::pow(most / least, unit()); }
  Point point(double half) { return {between(-half, half), between(-half, half), between(-half, half)}; }
};

oracle::Placement random_motion(Dice& dice, const Point& t) {
  oracle::Placement m{1, 0, 0, t[0], 0, 1, 0, t[1], 0, 0, 1, t[2]};
  if (dice.one_in(8)) return m;
  if (dice.one_in(8)) return {0, 1, 0, t[0], 0, 0, 1, t[1], 1, 0, 0, t[2]};
  if (dice.one_in(8)) return {0.6, -0.8, 0, t[0], 0.8, 0.6, 0, t[1], 0, 0, 1, t[2]};
  std::normal_distribution<double> normal;
  double w = normal(dice.random), x = normal(dice.random), y = normal(dice.random), z = normal(dice.random);
  const double s = 1 / std::sqrt(w * w + x * x + y * y + z * z);
  w *= s, x *= s, y *= s, z *= s;
  m = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),     t[0],
       2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),     t[1],
       2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y), t[2]};
  if (dice.one_in(6))  // off from rigid, as far as is allowed
    for (std::size_t i = 0; i < 12; ++i)
      if (i % 4 != 3) m[i] += dice.between(-1e-10, 1e-10);
  return m;
}

/// By how much a placement that is allowed may change lengths, relatively; more than that.
constexpr double stretch = 2e-9;

int random_exponent(Dice& dice) {
  if (!dice.one_in(8)) return 0;
  constexpr int exponents[] = {-664, -498, -100, 100, 498, 664};  // 1e-200 to 1e200
  return exponents[dice.below(6)];
}

ContestantOptions random_options(Dice& dice) {
  ContestantOptions options;
  if (dice.one_in(6)) options.bounds = BoundMethod::table;
  options.tight = dice.one_in(3);
  if (dice.one_in(2)) options.part_level = 1 + dice.below(2);
  return options;
}

Boundary random_boundary(Dice& dice) {
  constexpr Boundary rules[] = {Boundary::edge_and_corner, Boundary::edge_only, Boundary::none};
  return rules[dice.below(3)];
}

TwinMesh joined(TwinMesh a, const TwinMesh& b) {
  const auto count = static_cast<std::uint32_t>(a.points.size());
  a.points.insert(a.points.end(), b.points.begin(), b.points.end());
  for (const oracle::Triangle& t : b.triangles)
    a.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
  return a;
}

template <class Change>
TwinMesh changed(TwinMesh mesh, Change change) {
  for (Point& p : mesh.points) p = change(p);
  return mesh;
}

/// Closed, star-shaped around the origin.
TwinMesh random_shell(Dice& dice) {
  switch (dice.below(5)) {
    case 0:
      return meshes::disturbed(meshes::icosahedron(), static_cast<int>(dice.below(8)), 0.1, dice.random);
    case 1:
      return meshes::disturbed(meshes::octahedron(), 0, 0.15, dice.random);
    case 2:
      return meshes::disturbed(meshes::quartered(meshes::octahedron()), 3, 0.05, dice.random);
    case 3:
      return meshes::disturbed(meshes::bipyramid(3 + dice.below(10)), 0, 0.05, dice.random);
    default:
      return meshes::disturbed(meshes::quartered(meshes::icosahedron()), 0, 0.03, dice.random);
  }
}

TwinMesh random_mesh(Dice& dice) {
  switch (dice.below(4)) {
    case 0:
      return random_shell(dice);
    case 1:
      return changed(meshes::disturbed(meshes::grid(4, 4, random_boundary(dice)), 5, 0.3, dice.random),
                     [](Point p) {
                       return Point{p[0] / 2 - 1, p[1] / 2 - 1, p[2]};
                     });
    case 2:
      return meshes::disturbed(
          meshes::quartered(meshes::wheel(3 + dice.below(10),
                                          dice.one_in(2) ? Boundary::edge_and_corner : Boundary::edge_only)),
          2, 0.15, dice.random);
    default:
      return joined(random_shell(dice), changed(random_shell(dice), [](Point p) {
                      return Point{0.5 * p[0] + 1.5, 0.5 * p[1], 0.5 * p[2] - 0.5};
                    }));
  }
}

/// Flat or needle triangles, points that coincide.
TwinMesh degenerate_mesh(Dice& dice) {
  const TwinMesh mesh = random_mesh(dice);
  switch (dice.below(6)) {
    case 0:
      return changed(mesh, [](Point p) { return Point{p[0], p[1], 0.0}; });
    case 1:
      return changed(mesh, [](Point p) { return Point{p[0], 1e-7 * p[1], 1e-9 * p[2]}; });
    case 2:
      return changed(mesh, [](Point p) { return Point{p[0], 0.3 * p[0], -p[0]}; });
    case 3:
      return changed(mesh, [](Point p) {
        return Point{std::round(2 * p[0]) / 2, std::round(2 * p[1]) / 2, std::round(2 * p[2]) / 2};
      });
    case 4:
      return changed(mesh, [](Point p) { return Point{p[0], p[1], 1e-12 * p[2]}; });
    default:
      return changed(mesh, [](Point p) { return Point{p[0], p[1], p[0] * p[1] > 0.2 ? 5 * p[2] : p[2]}; });
  }
}

/// Points (i, j, 0) over 0..n, with heights. Without a boundary rule it is the graph of a spline over [1, n -
/// 1]^2.
template <class Height>
TwinMesh graph(std::uint32_t n, Boundary rule, Height height) {
  TwinMesh mesh = meshes::grid(n, n, rule);
  for (Point& p : mesh.points)
    p[2] = height(static_cast<int>(std::lround(p[0])), static_cast<int>(std::lround(p[1])));
  return mesh;
}

/// Whole-numbered heights of a grid of n by n squares.
struct Heights {
  int n;
  std::vector<int> at;
  Heights(int side, int range, Dice& dice) : n(side), at(static_cast<std::size_t>((side + 1) * (side + 1))) {
    for (int& h : at) h = static_cast<int>(dice.below(2 * static_cast<std::uint32_t>(range) + 1)) - range;
  }
  int operator()(int i, int j) const { return at[static_cast<std::size_t>(j * (n + 1) + i)]; }
  /// Twelve times the limit over (i, j).
  int limit12(int i, int j) const {
    const Heights& h = *this;
    return 6 * h(i, j) + h(i + 1, j) + h(i - 1, j) + h(i, j + 1) + h(i, j - 1) + h(i + 1, j + 1) +
           h(i - 1, j - 1);
  }
  /// A bound of the gradient of the limit.
  double slope() const {
    int x = 0, y = 0;
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        if (i < n) x = std::max(x, std::abs((*this)(i + 1, j) - (*this)(i, j)));
        if (j < n) y = std::max(y, std::abs((*this)(i, j + 1) - (*this)(i, j)));
      }
    return std::hypot(x, y);
  }
};

}  // namespace

Contestants::Contestants(TwinMesh a, TwinMesh b, int exponent, const ContestantOptions& options)
    : exponent_(exponent), options_(options) {
  make(0, std::move(a));
  make(1, std::move(b));
}

Contestants::Contestants(TwinMesh both, int exponent, const ContestantOptions& options)
    : exponent_(exponent), options_(options) {
  make(0, std::move(both));
  sides_[1].mesh = sides_[0].mesh;
  sides_[1].surface = sides_[0].surface;
}

void Contestants::make(std::size_t side, TwinMesh mesh) {
  Side& s = sides_[side];
  size_ = std::max(size_, size_of(mesh));
  TwinMesh large = mesh;
  for (Point& p : large.points)
    for (double& x : p) x = scaled(x);
  s.mesh = std::make_shared<TwinMesh>(std::move(mesh));
  s.surface = public_surface(control_mesh(large), rules(large), options_);
  s.surface->prepare();
}

PlacedSurface Contestants::placed(std::size_t side, const oracle::Placement& place) const {
  return surface(side).at(scaled(place));
}

oracle::ContactSurface& Contestants::twin(std::size_t side) {
  Side& s = sides_[side];
  if (!s.twin) {
    if (s.mesh == sides_[1 - side].mesh && sides_[1 - side].twin)
      s.twin = sides_[1 - side].twin;
    else
      s.twin = std::make_shared<oracle::ContactSurface>(*s.mesh);
  }
  return *s.twin;
}

Motion Contestants::scaled(const oracle::Placement& place) const {
  oracle::Placement result = place;
  for (const std::size_t i : {3, 7, 11}) result[i] = scaled(place[i]);
  return Motion::from_3x4(result);
}

struct Trials::Pool {
  using Made = std::unique_ptr<Contestants>;
  std::uint64_t block = UINT64_MAX;
  std::vector<Made> random, needles, shells, selves;
  Made latest;  // of the trial that was made last

  void fill(std::uint64_t number) {
    const std::uint64_t wanted = number / trials_a_block;
    if (wanted == block) return;
    block = wanted;
    std::mt19937_64 random_bits(0x5eed + 77 * block);
    Dice dice{random_bits};
    random.clear(), needles.clear(), shells.clear(), selves.clear();
    const auto add = [&](std::vector<Made>& list, TwinMesh a, TwinMesh b) {
      const int exponent = random_exponent(dice);
      list.push_back(
          std::make_unique<Contestants>(std::move(a), std::move(b), exponent, random_options(dice)));
    };
    for (int i = 0; i < 6; ++i) {
      TwinMesh a = random_mesh(dice), b = random_mesh(dice);
      add(random, std::move(a), std::move(b));
    }
    for (int i = 0; i < 4; ++i) {
      TwinMesh a = degenerate_mesh(dice), b = dice.one_in(2) ? random_mesh(dice) : degenerate_mesh(dice);
      add(needles, std::move(a), std::move(b));
      TwinMesh c = random_shell(dice), d = random_shell(dice);
      add(shells, std::move(c), std::move(d));
    }
    for (int i = 0; i < 3; ++i) {
      TwinMesh mesh = random_mesh(dice);
      const int exponent = random_exponent(dice);
      selves.push_back(std::make_unique<Contestants>(std::move(mesh), exponent, random_options(dice)));
    }
  }

  Contestants* keep(TwinMesh a, TwinMesh b, Dice& dice) {
    const int exponent = random_exponent(dice);
    if (dice.one_in(2)) std::swap(a, b);  // no truth depends on the order
    latest = std::make_unique<Contestants>(std::move(a), std::move(b), exponent, random_options(dice));
    return latest.get();
  }

  /// One placement of both: whatever is true of the meshes stays true, up to `stretch`.
  static void place_together(Trial& trial, Dice& dice) {
    Point t = dice.point(2);
    if (dice.one_in(8)) t = dice.point(1e6);
    trial.a = trial.b = random_motion(dice, t);
  }

  /// Along z only, where the placement leaves z alone; exact in real arithmetic as a difference of two
  /// doubles.
  static double hair(Dice& dice) {
    if (dice.one_in(4)) return 0;
    return (dice.one_in(2) ? -1 : 1) *
           std::ldexp(1.0 + dice.below(16) / 16.0, -static_cast<int>(dice.below(44)));
  }

  void sheets(Trial& trial, Dice& dice) {
    trial.family = "sheets";
    double h = hair(dice);
    const double slope_x = dice.below(3) / 4.0, slope_y = dice.below(3) / 4.0;
    if (slope_x == 0 && slope_y == 0 && dice.one_in(3)) h *= 0x1p-30;  // no digits of others in its way
    const std::uint32_t n = 3 + dice.below(3);
    const double shift_x = n > 3 ? dice.below(2) : 0, shift_y = dice.below(2) / 2.0;
    TwinMesh a = meshes::grid(n, n, random_boundary(dice)), b = meshes::grid(n, n, random_boundary(dice));
    if (dice.one_in(3)) a = meshes::disturbed(std::move(a), 4, 0, dice.random);
    const auto flat = [](Point p) {  // few digits, so that heights are exact
      return Point{std::round(p[0] * 64) / 64, std::round(p[1] * 64) / 64, 0};
    };
    a = changed(changed(a, flat), [&](Point p) {
      return Point{p[0], p[1], slope_x * p[0] + slope_y * p[1]};
    });
    b = changed(b, [&](Point p) {
      const double x = p[0] + shift_x, y = p[1] + shift_y;
      return Point{x, y, slope_x * x + slope_y * y + h};
    });
    // Both hold a neighbourhood of the square from 1 to n - 1, once shifted.
    const double gap = std::abs(h) / std::sqrt(1 + slope_x * slope_x + slope_y * slope_y);
    trial.truth.apart = h != 0;
    trial.truth.meet = h == 0;
    trial.truth.lower = gap * (1 - stretch);
    trial.truth.upper = (std::abs(h) < 0.1 ? gap : std::abs(h)) * (1 + stretch);
    trial.pair = keep(std::move(a), std::move(b), dice);
    place_together(trial, dice);
    trial.hair = true;
  }

  void graphs(Trial& trial, Dice& dice) {
    trial.family = "graphs";
    const int n = 4 + static_cast<int>(dice.below(2));
    const Heights f(n, 1 + static_cast<int>(dice.below(4)), dice);
    const double unit = std::ldexp(1.0, -static_cast<int>(dice.below(6)));
    const auto side = static_cast<std::uint32_t>(n);
    TwinMesh a = graph(side, Boundary::none, [&](int i, int j) { return unit * f(i, j); });
    double h = hair(dice);
    const double slope = unit * f.slope();
    TwinMesh b;
    if (dice.one_in(2)) {  // lifted
      b = graph(side, Boundary::none, [&](int i, int j) { return unit * f(i, j) + h; });
      trial.truth.apart = h != 0;
      trial.truth.meet = h == 0;
      trial.truth.lower = std::abs(h) / std::sqrt(1 + slope * slope) * (1 - stretch);
      trial.truth.upper = std::abs(h) * (1 + stretch);
      trial.hair = true;
    } else {  // and bent: the difference is a spline of which limit points are known
      if (h == 0) h = 0.25;
      const Heights w(n, 3, dice);
      b = graph(side, Boundary::none, [&](int i, int j) { return unit * f(i, j) + h * w(i, j); });
      int least = INT32_MAX, most = INT32_MIN, min_control = INT32_MAX, max_control = INT32_MIN;
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
          min_control = std::min(min_control, w(i, j)), max_control = std::max(max_control, w(i, j));
          if (i == 0 || j == 0 || i == n || j == n) continue;
          least = std::min(least, w.limit12(i, j)), most = std::max(most, w.limit12(i, j));
        }
      trial.truth.meet = least <= 0 && most >= 0;
      trial.truth.crossing = least * std::abs(h) / 12 < -0.1 && most * std::abs(h) / 12 > 0.1;
      const int certain = std::max({0, min_control, -max_control});
      trial.truth.apart = certain > 0;
      trial.truth.lower = certain * std::abs(h) / std::sqrt(1 + slope * slope) * (1 - stretch);
      trial.truth.upper =
          trial.truth.meet ? 0 : std::min(std::abs(least), std::abs(most)) * std::abs(h) / 12 * (1 + stretch);
      trial.hair = std::abs(h) < 0.1;
    }
    trial.pair = keep(std::move(a), std::move(b), dice);
    place_together(trial, dice);
  }

  /// The second graph is the first plus q(x - c, y - c) + h, q(x, y) = x^2 - x y + y^2: they touch, cross or
  /// miss at one place. The net of q lies 1/2 below its limit.
  void grazing(Trial& trial, Dice& dice) {
    trial.family = "grazing";
    const int n = 4, c = 2;
    const Heights f(n, 2, dice);
    const double unit = dice.one_in(3) ? 0 : std::ldexp(1.0, -static_cast<int>(dice.below(5))),
                 bend = std::ldexp(1.0, -static_cast<int>(dice.below(5))), h = hair(dice);
    TwinMesh a = graph(n, Boundary::none, [&](int i, int j) { return unit * f(i, j); });
    TwinMesh b = graph(n, Boundary::none, [&](int i, int j) {
      const int x = i - c, y = j - c;
      return unit * f(i, j) + bend * (x * x - x * y + y * y - 0.5) + h;
    });
    const double slope = unit * f.slope();
    trial.truth.apart = h > 0;
    trial.truth.meet = h <= 0 && h > -bend;
    if (!trial.truth.apart && !trial.truth.meet) trial.truth.apart = h < -3 * bend;  // q is at most 3 there
    trial.truth.crossing = h < -0.2 * bend && h > -0.7 * bend && bend > 0.1;
    if (trial.truth.meet) trial.truth.upper = 0;
    if (h > 0) {
      trial.truth.lower = h / std::sqrt(1 + slope * slope) * (1 - stretch);
      trial.truth.upper = h * (1 + stretch);
    }
    trial.pair = keep(std::move(a), std::move(b), dice);
    place_together(trial, dice);
    trial.hair = true;
  }

  void nested(Trial& trial, Dice& dice) {
    trial.family = "nested";
    const TwinMesh a = changed(random_shell(dice), [](Point p) {
      for (double& x : p) x = std::round(x * 0x1p20) * 0x1p-20;
      return p;
    });
    const double by = std::ldexp(1.0, -1 - static_cast<int>(dice.below(28)));
    TwinMesh b = changed(a, [&](Point p) {
      return Point{p[0] + by * p[0], p[1] + by * p[1], p[2] + by * p[2]};
    });
    double radius = 0;
    for (const Point& p : a.points) radius = std::max(radius, length(p));
    trial.truth.apart = true;
    trial.truth.upper = by * radius * (1 + stretch);
    trial.truth.nested = true;
    trial.pair = keep(a, std::move(b), dice);
    place_together(trial, dice);
    trial.hair = by < 0.1;
    trial.solid = dice.one_in(2);
  }

  /// Two surfaces with one boundary curve, or one side of it, in common.
  void seams(Trial& trial, Dice& dice) {
    trial.family = "seams";
    const std::uint32_t n = 3 + dice.below(2);
    const Boundary rule = dice.one_in(2) ? Boundary::edge_and_corner : Boundary::edge_only;
    TwinMesh a = meshes::grid(n, n, rule), b;
    for (Point& p : a.points)
      for (double& x : p) x = std::round((x + dice.between(-0.2, 0.2)) * 1024) / 1024;
    b = a;
    if (dice.one_in(2)) {  // one above the other: inner points alone differ
      const double lift = hair(dice);
      for (std::uint32_t j = 1; j < n; ++j)
        for (std::uint32_t i = 1; i < n; ++i) b.points[j * (n + 1) + i][2] += lift;
    } else {  // side by side: all but the last column is reflected and moved
      for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
          Point& p = b.points[j * (n + 1) + i];
          p = {2 * n - p[0] + dice.below(3) / 8.0, p[1], p[2] + dice.below(3) / 8.0};
        }
    }
    trial.truth.meet = true;
    trial.truth.upper = 0;
    trial.pair = keep(std::move(a), std::move(b), dice);
    place_together(trial, dice);
    trial.hair = true;
  }

  void self(Trial& trial, Dice& dice) {
    trial.family = "self";
    trial.pair = selves[dice.below(static_cast<std::uint32_t>(selves.size()))].get();
    place_together(trial, dice);
    trial.truth.meet = true;
    trial.truth.upper = 0;
    trial.hair = true;
  }

  void planes(Trial& trial, Dice& dice) {
    trial.family = "planes";
    const std::uint32_t n = 4;
    const auto make = [&] {
      const Heights f(static_cast<int>(n), 1, dice);
      const double bump = dice.one_in(2) ? 0 : 0.02;
      TwinMesh mesh = graph(n, random_boundary(dice), [&](int i, int j) { return bump * f(i, j); });
      if (dice.one_in(3)) mesh = meshes::disturbed(std::move(mesh), 3, 0, dice.random);
      return mesh;
    };
    TwinMesh a = make(), b = make();
    trial.pair = keep(std::move(a), std::move(b), dice);
    // A point inside of each, brought together at an angle of half a radian and more.
    const Point on_a{dice.between(1.5, 2.5), dice.between(1.5, 2.5), 0},
        on_b{dice.between(1.5, 2.5), dice.between(1.5, 2.5), 0};
    const Point at = dice.one_in(8) ? dice.point(1e6) : dice.point(1);
    double angle;
    do {
      trial.a = random_motion(dice, {0, 0, 0});
      trial.b = random_motion(dice, {0, 0, 0});
      angle = std::acos(std::min(
          1.0, std::abs(trial.a[2] * trial.b[2] + trial.a[6] * trial.b[6] + trial.a[10] * trial.b[10])));
    } while (angle < 0.5);
    const auto bring = [&](oracle::Placement& m, const Point& p) {
      for (std::size_t r = 0; r < 3; ++r)
        m[4 * r + 3] = at[r] - (m[4 * r] * p[0] + m[4 * r + 1] * p[1] + m[4 * r + 2] * p[2]);
    };
    bring(trial.a, on_a);
    bring(trial.b, on_b);
    trial.truth.meet = trial.truth.crossing = true;
    trial.truth.upper = 0;
  }

  /// A surface and its mirror image in x = 0 under the same placement.
  void mirrored(Trial& trial, Dice& dice) {
    trial.family = "mirrored";
    TwinMesh a = random_shell(dice);
    const double shift = dice.between(-0.5, 2);
    a = changed(a, [&](Point p) { return Point{p[0] + shift, p[1], p[2]}; });
    TwinMesh b = changed(a, [](Point p) { return Point{-p[0], p[1], p[2]}; });
    for (oracle::Triangle& t : b.triangles) std::swap(t[1], t[2]);
    double least = std::numeric_limits<double>::infinity();
    for (const Point& p : a.points) least = std::min(least, p[0]);
    trial.truth.lower = std::max(0.0, 2 * least * (1 - stretch));
    trial.truth.apart = least > 0;
    trial.pair = keep(std::move(a), std::move(b), dice);
    // Limit points on both sides of the mirror: the plane x = 0 cuts both in the same points.
    oracle::ContactSurface& twin = trial.pair->twin(0);
    double lowest = 0, highest = 0;
    for (std::uint32_t face = 0; face < trial.pair->mesh(0).triangles.size(); ++face) {
      const double x = twin.limit_point(face, 0.25, 0.25)[0];
      lowest = std::min(lowest, x), highest = std::max(highest, x);
    }
    trial.truth.meet = lowest < -1e-10 && highest > 1e-10;
    if (trial.truth.meet) trial.truth.upper = 0;
    place_together(trial, dice);
    trial.solid = dice.one_in(4);
    trial.hair = true;
  }

  /// Two half planes at right angles: z = 0, x >= 0 and x = g, z >= h, wide enough in y.
  void borders(Trial& trial, Dice& dice) {
    trial.family = "borders";
    const double g = dice.one_in(3) ? 0.5 : hair(dice), h = hair(dice);
    const auto rule = [&] { return dice.one_in(2) ? Boundary::edge_and_corner : Boundary::edge_only; };
    TwinMesh a = meshes::grid(4, 4, rule()), b = meshes::grid(4, 4, rule());
    if (dice.one_in(3)) a = meshes::disturbed(std::move(a), 3, 0, dice.random);
    const double up = dice.below(3) / 8.0;
    a = changed(a, [&](Point p) { return Point{p[0], p[1] - 2, 0}; });
    b = changed(b, [&](Point p) { return Point{g, p[0] - 2 + up, p[1] + h}; });
    const double over = std::max(h, 0.0), off = std::max(-g, 0.0);
    trial.truth.meet = over == 0 && off == 0 && g < 2 && h > -2;
    trial.truth.apart = over > 0 || off > 0;
    trial.truth.crossing = g > 0.2 && g < 2 && h < -0.2 && h > -2;
    if (trial.truth.meet) trial.truth.upper = 0;
    trial.truth.lower = std::hypot(over, off) * (1 - stretch);
    if (g < 2 && h > -2) trial.truth.upper = std::hypot(over, off) * (1 + stretch);
    trial.pair = keep(std::move(a), std::move(b), dice);
    place_together(trial, dice);
    trial.hair = !trial.truth.crossing;
  }

  /// Extraordinary vertices whose limit points are known, against each other or against a plane: an
  /// octahedron with corners at 55 / 64 has its tips at 24 / 64, two pyramids over a triangle with apexes at
  /// 5 / 8 at 2 / 8.
  void tips(Trial& trial, Dice& dice) {
    trial.family = "tips";
    const double h = hair(dice);
    TwinMesh a;
    double tip;
    if (dice.one_in(2)) {
      tip = 24 / 64.0;
      a = changed(meshes::octahedron(), [](Point p) {
        return Point{p[0] * 55 / 64, p[1] * 55 / 64, p[2] * 55 / 64};
      });
    } else {
      tip = 2 / 8.0;
      a = changed(meshes::bipyramid(3), [](Point p) { return Point{p[0], p[1], p[2] * 5 / 8}; });
    }
    TwinMesh b = dice.one_in(2) ? changed(a,
                                          [&](Point p) {
                                            return Point{p[0], p[1], 2 * tip + h - p[2]};
                                          })
                                : changed(meshes::grid(4, 4, random_boundary(dice)), [&](Point p) {
                                    return Point{p[0] - 2, p[1] - 2, tip + h};
                                  });
    trial.truth.apart = h > 0;
    trial.truth.meet = h <= 0 && h > -tip;
    trial.truth.crossing = h < -0.1 && h > -tip;
    if (trial.truth.meet) trial.truth.upper = 0;
    if (h > 0) {
      trial.truth.lower = h * (1 - stretch);
      trial.truth.upper = h * (1 + stretch);
    }
    trial.pair = keep(std::move(a), std::move(b), dice);
    place_together(trial, dice);
    trial.hair = !trial.truth.crossing;
  }

  /// Components of single triangles: with corners as they are, each is its own limit surface.
  void triangles(Trial& trial, Dice& dice) {
    trial.family = "triangles";
    std::array<std::vector<ExactTriangle>, 2> lists;
    const std::uint32_t range = 2 + dice.below(5);
    for (auto& list : lists) {
      const std::uint32_t count = dice.one_in(3) ? 1 + dice.below(3) : 1;
      while (list.size() < count) {
        ExactTriangle t;
        for (auto& corner : t)
          for (auto& x : corner) x = static_cast<std::int64_t>(dice.below(2 * range + 1)) - range;
        if (dice.one_in(4))  // in a plane with the other ones
          for (auto& corner : t) corner[2] = 0;
        if (has_area(t)) list.push_back(t);
      }
    }
    bool meet = false, crossing = false;
    long double nearest = std::numeric_limits<long double>::infinity();
    for (const ExactTriangle& s : lists[0])
      for (const ExactTriangle& t : lists[1]) {
        meet |= have_common_point(s, t);
        crossing |= pierce(s, t);
        nearest = std::min(nearest, distance(s, t));
      }
    std::array<TwinMesh, 2> both;
    const double unit = std::ldexp(1.0, -static_cast<int>(dice.below(4)));
    for (std::size_t side = 0; side < 2; ++side)
      for (const ExactTriangle& t : lists[side]) {
        TwinMesh one{{}, {{0, 1, 2}}, Boundary::edge_and_corner};
        for (const auto& corner : t)
          one.points.push_back({unit * static_cast<double>(corner[0]), unit * static_cast<double>(corner[1]),
                                unit * static_cast<double>(corner[2])});
        both[side] = joined(std::move(both[side]), one);
      }
    trial.truth.meet = meet;
    trial.truth.apart = !meet;
    trial.truth.crossing = crossing;
    trial.truth.lower = meet ? 0 : unit * static_cast<double>(nearest) * (1 - stretch);
    trial.truth.upper = meet ? 0 : unit * static_cast<double>(nearest) * (1 + stretch);
    trial.pair = keep(std::move(both[0]), std::move(both[1]), dice);
    place_together(trial, dice);
    trial.hair = meet && !crossing;
  }

  /// Placed at random; as near as `reach` sizes.
  static void place_at_random(Trial& trial, Dice& dice, double reach) {
    const double far = dice.one_in(10) ? 1e6 : 1;
    const Point at = dice.point(far);
    trial.a = random_motion(dice, at);
    const Point off = dice.point(reach * trial.pair->size());
    trial.b = random_motion(dice, {at[0] + off[0], at[1] + off[1], at[2] + off[2]});
  }

  void mixed(Trial& trial, Dice& dice) {
    trial.family = "random";
    trial.pair = random[dice.below(static_cast<std::uint32_t>(random.size()))].get();
    place_at_random(trial, dice, 0.8);
  }

  void degenerate(Trial& trial, Dice& dice) {
    trial.family = "needles";
    trial.pair = needles[dice.below(static_cast<std::uint32_t>(needles.size()))].get();
    place_at_random(trial, dice, 0.6);
    trial.hair = true;
  }

  /// Moved along the line of nearest points until the distance is between about half and twice the tolerance.
  void pulled(Trial& trial, Dice& dice) {
    trial.family = "pulled";
    const std::vector<Made>& list = dice.one_in(6) ? needles : random;
    trial.pair = list[dice.below(static_cast<std::uint32_t>(list.size()))].get();
    place_at_random(trial, dice, 1.0);
    const double size = trial.pair->size();
    trial.tolerance = size * (dice.one_in(3) ? 1e-3 : dice.one_in(2) ? 2e-2 : dice.size(1e-7, 0.1));
    trial.margin = dice.one_in(4) ? size * dice.size(1e-5, 0.05) : 0;
    const double target = trial.margin + trial.tolerance * dice.between(0.6, 2);
    oracle::ContactGoal goal;
    goal.precision = {0.15 * target, 0};
    goal.effort = 4000;
    const oracle::ContactBounds found =
        contact_bounds(trial.pair->twin(0), trial.a, trial.pair->twin(1), trial.b, goal);
    if (found.lower > 0 && found.upper > target) {
      // Once in a while by a little too far, and asked for nothing but proofs.
      const double wanted = dice.one_in(6) ? -target : target;
      const double pull = (found.upper - wanted) / found.upper;
      for (std::size_t k = 0; k < 3; ++k) trial.b[4 * k + 3] += pull * (found.on_a[k] - found.on_b[k]);
      if (dice.one_in(6)) {
        trial.family = "grazed";
        trial.tolerance = trial.margin = 0;
        trial.hair = true;
      }
    }
  }

  /// Closed, star-shaped shells brought so near that they often cross; which they do where the twin finds
  /// points of one inside and outside of the other.
  void shells_near(Trial& trial, Dice& dice) {
    trial.family = "shells";
    trial.pair = shells[dice.below(static_cast<std::uint32_t>(shells.size()))].get();
    place_at_random(trial, dice, 0.45);
    trial.solid = dice.one_in(3);
    std::array<bool, 2> inside{}, outside{};
    for (std::size_t side = 0; side < 2; ++side) {
      const oracle::Placement &own = side == 0 ? trial.a : trial.b, &other = side == 0 ? trial.b : trial.a;
      for (int k = 0; k < 4 && !(inside[side] && outside[side]); ++k) {
        const auto face = dice.below(static_cast<std::uint32_t>(trial.pair->mesh(side).triangles.size()));
        const Point p = trial.pair->twin(side).limit_point(face, 0.25, 0.25);
        Point at{}, to_centre{};
        for (std::size_t r = 0; r < 3; ++r) {
          at[r] = own[4 * r] * p[0] + own[4 * r + 1] * p[1] + own[4 * r + 2] * p[2] + own[4 * r + 3];
          to_centre[r] = other[4 * r + 3] - at[r];
        }
        const double off = length(to_centre), size = trial.pair->size();
        // A hundredth of the size deep, each: the segment reaches on beyond the point.
        const auto reached = [&](double t) {
          return Point{at[0] + t * to_centre[0], at[1] + t * to_centre[1], at[2] + t * to_centre[2]};
        };
        if (off < 0.05 * size) {
          inside[side] = true;
          continue;
        }
        const Point centre{other[3], other[7], other[11]};
        if (trial.pair->twin(1 - side).misses(other, reached(-0.01 * size / off), centre))
          inside[side] = true;
        else if (trial.pair->twin(1 - side).misses(other, reached(0.01 * size / off),
                                                   reached(-9 * size / off)))
          outside[side] = true;
      }
    }
    if ((inside[0] && outside[0]) || (inside[1] && outside[1])) {
      trial.truth.meet = trial.truth.crossing = true;
      trial.truth.upper = 0;
    } else if (inside[0] != inside[1]) {
      trial.truth.nested = true;
    } else if (outside[0] && outside[1]) {
      trial.truth.nested = false;
    }
  }
};

Trials::Trials() : pool_(std::make_unique<Pool>()) {}
Trials::~Trials() = default;

Trial Trials::make(std::uint64_t number) {
  pool_->fill(number);
  Trial trial;
  trial.number = number;
  trial.random.seed(0xabcdef + 1'000'003 * number);
  Dice dice{trial.random};
  const bool pull = number % 3 == 0;
  if (pull) {
    pool_->pulled(trial, dice);
  } else {
    using Family = void (Pool::*)(Trial&, Dice&);
    constexpr Family families[] = {
        &Pool::sheets,      &Pool::graphs,  &Pool::grazing,    &Pool::nested,    &Pool::seams,
        &Pool::self,        &Pool::planes,  &Pool::mirrored,   &Pool::triangles, &Pool::triangles,
        &Pool::mixed,       &Pool::mixed,   &Pool::degenerate, &Pool::planes,    &Pool::shells_near,
        &Pool::shells_near, &Pool::borders, &Pool::tips};
    (pool_.get()->*families[dice.below(std::size(families))])(trial, dice);
    const double size = trial.pair->size();
    constexpr double tolerances[] = {0, 0, 1e-12, 1e-6, 1e-3, 2e-2};
    trial.tolerance = size * tolerances[dice.below(6)];
    const double known = trial.truth.lower;
    if (known > 0 && dice.one_in(3)) trial.tolerance = known * dice.between(0.5, 2);
    if (dice.one_in(5)) {
      // About the truth where it is known.
      constexpr double near[] = {0.5, 1 - 1e-7, 1 + 1e-7, 2};
      trial.margin = known > 0 ? known * near[dice.below(4)] : size * dice.size(1e-6, 0.1);
    }
  }
  trial.prove_contact = dice.one_in(3);
  // Where they are a hair apart, or touch, proofs may take for ever.
  const bool tiny = trial.tolerance > 0 && trial.tolerance < 1e-9 * trial.pair->size();
  trial.budget = tiny ? 3000 : 50'000;
  if (trial.hair) trial.budget = dice.one_in(200) ? 20'000 : static_cast<std::uint64_t>(dice.size(30, 1000));
  return trial;
}

std::uint64_t trial_count(std::uint64_t usual) { return number_of("SNUG_PLACEMENTS", usual); }

std::uint64_t first_trial() {
  const char* text = std::getenv("SNUG_FIRST");
  return text ? std::strtoull(text, nullptr, 10) : 0;
}

std::string describe(const Trial& trial) {
  std::string text = "trial " + std::to_string(trial.number) + " (" + trial.family + "), exponent " +
                     std::to_string(trial.pair->exponent());
  char buffer[64];
  const auto number = [&](const char* name, double x) {
    std::snprintf(buffer, sizeof buffer, "%s%.17g", name, x);
    text += buffer;
  };
  const auto placement = [&](const char* name, const oracle::Placement& m) {
    text += name;
    for (const double x : m) number(" ", x);
    text += '"';
  };
  placement(" --place-a \"", trial.a);
  placement(" --place-b \"", trial.b);
  number(" --tolerance ", trial.tolerance);
  number(" --margin ", trial.margin);
  text += " --budget " + std::to_string(trial.budget) + (trial.solid ? " --solid" : "") +
          (trial.prove_contact ? " --prove-contact" : "");
  number("; known: lower ", trial.truth.lower);
  number(" upper ", trial.truth.upper);
  text += std::string(trial.truth.apart ? " apart" : "") + (trial.truth.meet ? " meet" : "") +
          (trial.truth.crossing ? " crossing" : "");
  const ContestantOptions& options = trial.pair->options();
  text += std::string("; ") + (options.bounds == BoundMethod::table ? "tables" : "rows") +
          (options.tight ? ", tight" : "") + (options.part_level > 0 ? ", lazy" : "");
  if (const char* folder = std::getenv("SNUG_DUMP")) {
    for (std::size_t side = 0; side < 2; ++side) {
      std::ofstream file(std::string(folder) + (side == 0 ? "/a.obj" : "/b.obj"));
      file.precision(17);
      for (const Point& p : trial.pair->mesh(side).points)
        file << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
      for (const oracle::Triangle& t : trial.pair->mesh(side).triangles)
        file << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
      text += std::string(side == 0 ? "; a " : ", b ") +
              (trial.pair->mesh(side).boundary == Boundary::none        ? "none"
               : trial.pair->mesh(side).boundary == Boundary::edge_only ? "edge-only"
                                                                        : "edge-and-corner");
    }
  }
  return text;
}

}  // namespace snug::testing
