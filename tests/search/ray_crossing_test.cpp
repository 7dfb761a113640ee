// SeenPiece for lines beside a ray, against dense limit points: pieces of every sort of kind,
// lines through them, past them, along them and near their borders, alone and with all lines within a reach.

#include <snug/search/ray_crossing.h>

#include <snug/patch/evaluate.h>
#include <support/direction.h>
#include <testing/counts.h>
#include <testing/disguises.h>
#include <testing/scheme_surfaces.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>

namespace snug::ray_crossing_test {
namespace {

using State = LinePieceCrossing::State;
constexpr int steps = 12;         // of samples along a side
constexpr int border_steps = 48;  // of the border

struct Seen {
  long double x, y, along;
  long double error;
};

class Trial {
 public:
  Trial(const Patch& patch, const PieceBuild& sketch, const Point3& origin)
      : patch_(patch), record_(sketch.offset, sketch.quadratic, origin), origin_(origin) {}

  [[nodiscard]] Seen seen(const RayFrame& ray, TriangleParameter at) const {
    const RelativePoint point = limit_point(patch_, at);
    const auto height = [&](const Vector3& d) {
      long double sum = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        sum += static_cast<long double>(d[k]) *
               ((static_cast<long double>(patch_.origin[k]) - ray.origin[k]) + point.relative[k]);
      }
      return sum;
    };
    Seen result{height(ray.across[0]), height(ray.across[1]), height(ray.along), 1.75L * point.error};
    result.error += 1e-18L * (std::fabs(result.x) + std::fabs(result.y) + std::fabs(result.along));
    return result;
  }
  [[nodiscard]] Point3 point(TriangleParameter at) const {
    return patch_.origin + limit_point(patch_, at).relative;
  }
  [[nodiscard]] SeenPiece piece(const RayFrame& ray) const { return {ray, record_, origin_}; }
  // The border, from corner 0 on.
  [[nodiscard]] std::vector<Seen> border(const RayFrame& ray) const {
    std::vector<Seen> list;
    for (std::size_t k = 0; k < 3; ++k)
      for (int i = 0; i < border_steps; ++i) list.push_back(seen(ray, on_side(k, i)));
    return list;
  }
  [[nodiscard]] static TriangleParameter on_side(std::size_t k, int i) {
    const double t = i / static_cast<double>(border_steps);
    return k == 0   ? TriangleParameter{t, 0}
           : k == 1 ? TriangleParameter{1 - t, t}
                    : TriangleParameter{0, 1 - t};
  }

 private:
  const Patch& patch_;
  PieceBounds record_;
  Point3 origin_;
};

struct Counts {
  std::array<std::size_t, 4> states{};
  std::size_t wound = 0, within = 0, passed = 0, not_passed = 0;
};

long double off(const Seen& s, const Offset2& place) { return std::hypot(s.x - place.x, s.y - place.y); }

// How often the border winds around the place; nothing where it comes too near to tell.
std::optional<int> winding(const std::vector<Seen>& border, const Offset2& place) {
  long double sum = 0;
  for (std::size_t i = 0; i < border.size(); ++i) {
    const Seen &a = border[i], &b = border[(i + 1) % border.size()];
    const long double ax = a.x - place.x, ay = a.y - place.y, bx = b.x - place.x, by = b.y - place.y;
    const long double length = std::hypot(bx - ax, by - ay);
    if (std::hypot(ax, ay) < 2 * length + a.error) return {};
    sum += std::atan2(ax * by - ay * bx, ax * bx + ay * by);
  }
  return static_cast<int>(std::lround(sum / (2 * std::numbers::pi_v<long double>)));
}

void check(const Trial& trial, const RayFrame& ray, const Offset2& place, double reach,
           const std::string& name, Counts& counts) {
  const SeenPiece piece = trial.piece(ray);
  const LinePieceCrossing crossing = piece.crossing(place, reach);
  ++counts.states[static_cast<std::size_t>(crossing.state)];
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; i + j <= steps; ++j) {
      const Seen s = trial.seen(ray, {i / static_cast<double>(steps), j / static_cast<double>(steps)});
      if (!(off(s, place) + 2 * s.error <= static_cast<long double>(reach))) continue;
      ++counts.within;
      EXPECT_NE(crossing.state, State::none)
          << name << ": a point " << static_cast<double>(off(s, place)) << " away";
      EXPECT_LE(crossing.along.lower, static_cast<double>(s.along + s.error)) << name;
      EXPECT_GE(crossing.along.upper, static_cast<double>(s.along - s.error)) << name;
    }
  const std::vector<Seen> border = trial.border(ray);
  if (crossing.state == State::one || crossing.state == State::none) {
    if (const auto wound = winding(border, place)) {
      ++counts.wound;
      EXPECT_EQ(*wound, crossing.state == State::one ? crossing.side : 0) << name;
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const bool passes = piece.passes_side(k, place, reach);
    (passes ? counts.passed : counts.not_passed)++;
    if (!passes) continue;
    for (int i = 0; i <= border_steps; ++i) {
      const Seen s = trial.seen(ray, Trial::on_side(k, i));
      EXPECT_GT(off(s, place) + s.error, static_cast<long double>(reach)) << name << ", side " << k;
    }
  }
}

// Lines at one piece: through one of its points, aside by any part of its size, steep or nearly along it.
void check_piece(const Trial& trial, std::mt19937_64& random, const std::string& name, Counts& counts) {
  const auto some = [&] { return 2 * testing::unit(random) - 1; };
  const double size =
      length(trial.point({1, 0}) - trial.point({0, 1})) + length(trial.point({0, 0}) - trial.point({1, 0}));
  for (int i = 0; i < 6 && !::testing::Test::HasFailure(); ++i) {
    TriangleParameter at = testing::random_parameter(random);
    if (i == 1) at.v = 0;
    if (i == 2) at = {1, 0};
    const Point3 target = trial.point(at);
    Vector3 along{some(), some(), some()};
    if (i >= 4) along = target - trial.point(testing::random_parameter(random)) + 1e-3 * size * along;
    if (!(length(along) > 0) || !std::isfinite(1 / length(along))) continue;
    const double away = std::array{0.0, 1.0, size, 1e3}[random() % 4];
    const Vector3 direction = normalized(along);
    const RayFrame ray(target - away * direction, direction);
    const SeenPiece piece = trial.piece(ray);
    // Its own point is on the line, up to its error and to roundings of the origin.
    const LinePieceCrossing through = piece.crossing({}, 0);
    const Seen own = trial.seen(ray, at);
    EXPECT_NE(through.state, State::none) << name << ", line " << i;
    EXPECT_GE(piece.error(), static_cast<double>(off(own, {}))) << name;
    const double aside = size * std::exp2(-20 * testing::unit(random));
    for (const double reach : {0.0, aside, 1e-3 * aside, piece.error()}) {
      for (const Offset2& place : {Offset2{}, Offset2{aside * some(), aside * some()}}) {
        check(trial, ray, place, reach,
              name + ", line " + std::to_string(i) + ", reach " + std::to_string(reach), counts);
      }
    }
  }
}

TEST(ray_crossing, holds_for_pieces_of_every_sort) {
  std::mt19937_64 random(71);
  Counts counts;
  const auto shapes = testing::disguises(
      {"plain", "far", "flat", "nearly flat", "needle", "line", "a single point", "spiked", "tiny and far"});
  std::size_t number = 0;
  testing::for_each_surface(72, [&](const testing::NamedSurface& named) {
    const testing::Disguise& disguise = shapes[number++ % shapes.size()];
    for (const bool plain : {true, false}) {
      ControlMesh mesh = named.surface.mesh();
      if (!plain) {
        for (Point3& p : mesh.points) {
          const oracle::Point q = disguise.change({p.x, p.y, p.z});
          p = {q[0], q[1], q[2]};
        }
      }
      const LimitSurface surface(std::move(mesh), named.surface.options(), std::make_shared<BoundsCache>());
      std::size_t taken = 0;
      testing::for_each_patch(surface, [&](PatchId p) {
        if (random() % 4 != 0 || ++taken > 2) return;
        Patch patch = surface.patch(p);
        for (auto levels = random() % 12; levels > 0; --levels)
          patch = split(patch, static_cast<unsigned>(random() % 4));
        const PieceBuild known =
            build_piece(surface.library(), patch, random() % 4 == 0 ? BoundMethod::table : BoundMethod::rows);
        check_piece(Trial(patch, known, known.box.centre), random,
                    named.name + ", " + (plain ? "plain" : disguise.name) + ", patch " +
                        std::to_string(p.value()) + " " + patch.path.text(),
                    counts);
      });
    }
  });
  std::cout << "  none " << counts.states[0] << ", one " << counts.states[1] << ", unsure "
            << counts.states[2] << ", bent " << counts.states[3] << "; " << counts.wound << " borders wound, "
            << counts.within << " points within reach, sides passed " << counts.passed << ", not "
            << counts.not_passed << '\n';
  for (const std::size_t count : counts.states) EXPECT_GT(count, testing::fewer(500));
  EXPECT_GT(counts.wound, testing::fewer(2000));
  EXPECT_GT(counts.within, testing::fewer(2000));
}

}  // namespace
}  // namespace snug::ray_crossing_test
