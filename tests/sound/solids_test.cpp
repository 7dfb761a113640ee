// Inside and outside of random solids whose meshes mix triangles, quads and polygons, against winding numbers
// of refined meshes. A third of the points look along a ray at an edge that the first split of one side alone
// cuts in two.
//
//   SNUG_PLACEMENTS=100000 build/release/bin/tests/sound_test --gtest_filter='solids.*'
//
// asks about so many points; SNUG_FIRST=N begins with solid N.

#include <snug/distance.h>
#include <snug/search/surface_data.h>
#include <snug/search/winding.h>

#include <gtest/gtest.h>
#include <support/error.h>
#include <testing/solid_cases.h>
#include <testing/surfaces.h>

#include <cmath>
#include <iostream>
#include <map>

#include "testing/verdict_only.h"

namespace snug::solids_test {
namespace {

constexpr std::uint64_t points_a_solid = 100;
// The rays that winding_number() tries: points are aimed along them.
constexpr std::array<Vector3, 8> rays{{{0.8236391, 0.2941752, 0.4848613},
                                       {-0.3912744, 0.8123906, 0.4324018},
                                       {0.1748203, -0.5321907, 0.8283922},
                                       {-0.6723481, -0.5610927, -0.4829115},
                                       {0.5519373, 0.7218405, -0.4176331},
                                       {-0.9321904, 0.1293847, 0.3381923},
                                       {0.2639471, -0.8931207, -0.3642918},
                                       {-0.1173952, 0.2387164, -0.9639721}}};

using testing::between;
using testing::number_of;
using testing::SolidCase;

// A ray that is tried first from q: the one that leads away from the middle.
std::size_t first_ray(const Point3& q, const Point3& middle) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < rays.size(); ++k)
    if (dot(rays[k], q - middle) > dot(rays[best], q - middle)) best = k;
  return best;
}

class Trials {
 public:
  Trials(const SolidCase& c, std::uint64_t seed)
      : case_(c),
        random_(seed),
        twin_(c.mesh, c.scheme, testing::twin_levels(c.mesh, 1500)),
        surface_(testing::public_surface(testing::control_mesh(c), c.options)),
        model_(surface_.data()->bvh()),
        scratch_(model_) {}

  void run() {
    for (std::uint64_t i = 0; i < points_a_solid && !::testing::Test::HasFailure(); ++i) {
      std::optional<int> truth;
      Point3 q;
      for (int tries = 0; tries < 60 && !truth; ++tries) {
        aimed_ = false;
        q = i % 8 < 6 ? aimed() : i % 8 == 6 ? near_surface() : anywhere();
        truth = twin_({q.x, q.y, q.z});
      }
      if (!truth) continue;
      aimed_at += aimed_;
      ask(q, *truth, i);
    }
  }

  static inline std::size_t asked = 0, untold = 0, inside = 0, aimed_at = 0;
  static inline std::map<int, std::size_t> numbers;

 private:
  Point3 anywhere() {
    const Ball& ball = model_.ball();
    Point3 q = ball.centre;
    for (std::size_t x = 0; x < 3; ++x) q[x] += between(random_, -1.1, 1.1) * ball.radius;
    return q;
  }
  Point3 near_surface() {
    const auto& points = twin_.mesh().points;
    const oracle::Point& p = points[random_() % points.size()];
    const double away = model_.ball().radius * std::exp2(-between(random_, 1, 7));
    return Point3{p[0], p[1], p[2]} +
           away * Vector3{between(random_, -1, 1), between(random_, -1, 1), between(random_, -1, 1)};
  }
  // Looks from afar at a filler, or beside it.
  Point3 aimed() {
    const auto& fillers = model_.solid().fillers();
    if (fillers.empty()) return near_surface();
    const PowerOfTwo back = model_.surface().scale().inverse();
    const Triangle& t = fillers[random_() % fillers.size()].corners;
    const double b = between(random_, -0.1, 1.1), c = between(random_, -0.1, 1.1);
    const Point3 target = t[0] + (b * (t[1] - t[0]) + c * (t[2] - t[0]));
    const Point3 middle = model_.tree().ball().centre;
    const std::size_t k = first_ray(target, middle);
    for (int tries = 0; tries < 100; ++tries) {
      const Point3 q = target - model_.tree().ball().radius * between(random_, 0.02, 1) * rays[k];
      if (first_ray(q, middle) != k) continue;
      aimed_ = true;
      return back.apply(q);
    }
    return near_surface();
  }

  void ask(const Point3& q, int truth, std::uint64_t i) {
    ++asked;
    ++numbers[truth];
    const Point3 scaled = model_.surface().scale().apply(q);
    const std::optional<int> found = winding_number(scratch_, scaled, 0);
    untold += !found;
    inside += truth != 0;
    const auto where = [&] {
      std::ostringstream text;
      text.precision(17);
      text << case_.name << " (SNUG_FIRST), point " << q.x << ' ' << q.y << ' ' << q.z;
      return text.str();
    };
    if (found) {
      EXPECT_EQ(*found, truth) << where();
    }
    const std::optional<bool> held = contains(surface_, q);
    if (held) {
      EXPECT_EQ(*held, truth != 0) << where();
    }
    if (i % 10 == 0) ask_for_solids(q, truth, where());
  }

  // A small tetrahedron of curved faces around q that does not come near the surface.
  void ask_for_solids(const Point3& q, int truth, const std::string& where) {
    const double r = 1e-4 * model_.ball().radius;
    ControlMesh mesh;
    mesh.points = {q + Vector3{r, r, r}, q + Vector3{r, -r, -r}, q + Vector3{-r, r, -r},
                   q + Vector3{-r, -r, r}};
    for (const std::array<std::uint32_t, 3>& f :
         {std::array<std::uint32_t, 3>{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}) {
      const std::array corners{VertexId(f[0]), VertexId(f[1]), VertexId(f[2])};
      mesh.add_face(corners);
    }
    const Surface small(std::move(mesh), {.scheme = Scheme::loop});
    CollideOptions wanted = testing::verdict_only();
    wanted.solid = true;
    const Collision answer = collide(surface_, small, wanted);
    if (answer.verdict == Verdict::separated) {
      EXPECT_EQ(truth, 0) << where;
    }
    if (answer.verdict == Verdict::intersecting) {
      EXPECT_NE(truth, 0) << where;
      EXPECT_EQ(answer.contained, std::optional<std::size_t>(1)) << where;
      EXPECT_LE(length((*answer.witness)[0].point - q), 4 * r) << where;
    }
    EXPECT_NE(answer.verdict, Verdict::within) << where;
    DistanceOptions precision;
    precision.relative = 0.1;
    precision.solid = true;
    const Distance gap = distance(surface_, small, precision);
    if (truth != 0) {
      EXPECT_EQ(gap.distance.lower, 0) << where;
      if (gap.contained) {
        EXPECT_EQ(gap.distance.upper, 0) << where;
      }
    } else {
      EXPECT_GT(gap.distance.upper, 0) << where;
      EXPECT_FALSE(gap.contained) << where;
    }
  }

  const SolidCase& case_;
  std::mt19937_64 random_;
  bool aimed_ = false;
  oracle::WindingTwin twin_;
  Surface surface_;
  const SurfaceBvh& model_;
  PieceCache scratch_;
};

TEST(solids, winding_numbers_are_those_of_refined_meshes) {
  const std::uint64_t solids = (number_of("SNUG_PLACEMENTS", 4000) + points_a_solid - 1) / points_a_solid;
  const std::uint64_t first = number_of("SNUG_FIRST", 0);
  std::uint64_t refused = 0;
  for (std::uint64_t i = 0; i < solids && !HasFailure(); ++i) {
    const SolidCase c = testing::solid_case(first + i);
    try {
      Trials(c, first + i).run();
    } catch (const InputError&) {
      ++refused;  // the same triangle twice
    }
  }
  std::cout << "  " << Trials::asked << " points, " << Trials::inside << " inside, " << Trials::aimed_at
            << " aimed at edges of first splits, " << Trials::untold << " not told; winding numbers";
  for (const auto& [number, count] : Trials::numbers) std::cout << "  " << number << ": " << count;
  std::cout << "; " << refused << " solids refused\n";
  EXPECT_LE(refused * 100, solids);
  EXPECT_GT(Trials::inside * 10, Trials::asked);
  EXPECT_GT(Trials::aimed_at * 3, Trials::asked);
  EXPECT_LE(Trials::untold * 1000, Trials::asked);
}

}  // namespace
}  // namespace snug::solids_test
