// The promises of trace(): against exact rational hits on sharp polyhedra, and on curved surfaces against refined
// meshes and the hulls of their one-rings.
//
//   SNUG_PLACEMENTS=1000000 build/release/bin/tests/sound_ray_test --gtest_filter=rays.aimed_*
//
// asks so many rays; SNUG_FIRST=N begins with case N.

#include <snug/query/ray.h>

#include <gtest/gtest.h>
#include <oracle/ray_twin.h>
#include <oracle/tagged_shapes.h>
#include <snug/base/error.h>
#include <testing/solid_cases.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <numeric>
#include <set>

namespace snug {
namespace {

using oracle::ExactHit;
using oracle::FlatFaces;
using oracle::Point;
using oracle::TaggedMesh;
using testing::between;
using testing::number_of;

Point plain(const Point3& p) { return {p.x, p.y, p.z}; }
Point plain(const Vector3& p) { return {p.x, p.y, p.z}; }

std::string text_of(const Ray& ray, RayQuery query) {
  std::ostringstream text;
  text.precision(17);
  text << "from " << ray.origin.x << ' ' << ray.origin.y << ' ' << ray.origin.z << " along "
       << ray.direction.x << ' ' << ray.direction.y << ' ' << ray.direction.z << ", " << ray.from << " to "
       << ray.to << ", query " << static_cast<int>(query);
  return text.str();
}

std::string text_of(const RayHits& answer) {
  std::ostringstream text;
  text.precision(17);
  for (const RayHit& hit : answer.hits)
    text << "\n  " << hit.t.lower << " .. " << hit.t.upper
         << (hit.certified ? " certified " : " not certified ") << hit.side;
  return text.str() + (answer.complete ? "" : "\n  incomplete");
}

// ---- Sharp polyhedra --------------------------------------------------------------------------------------------

std::uint32_t add_point(TaggedMesh& mesh, std::int64_t x, std::int64_t y, std::int64_t z) {
  mesh.points.push_back({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
  return static_cast<std::uint32_t>(mesh.points.size() - 1);
}

// A prism over a convex polygon with whole coordinates, its top moved aside; some of its faces raised to pyramids.
TaggedMesh whole_prism(std::mt19937_64& random) {
  using Step = std::array<std::int64_t, 2>;
  std::vector<Step> steps;
  const auto turn = [](const Step& a, const Step& b) { return a[0] * b[1] - a[1] * b[0]; };
  const auto upper = [](const Step& a) { return a[1] > 0 || (a[1] == 0 && a[0] > 0); };
  for (std::size_t i = 0, count = 2 + random() % 4; i < count; ++i) {
    const Step s{static_cast<std::int64_t>(random() % 9) - 4, 1 + static_cast<std::int64_t>(random() % 4)};
    if (std::any_of(steps.begin(), steps.end(), [&](const Step& other) { return turn(s, other) == 0; }))
      continue;
    steps.push_back(s);
    steps.push_back({-s[0], -s[1]});
  }
  if (steps.size() < 4) steps = {{2, 0}, {0, 3}, {-2, 0}, {0, -3}};
  std::sort(steps.begin(), steps.end(),
            [&](const Step& a, const Step& b) { return upper(a) != upper(b) ? upper(a) : turn(a, b) > 0; });
  std::vector<Step> corners{{0, 0}};
  for (std::size_t i = 0; i + 1 < steps.size(); ++i)
    corners.push_back({corners.back()[0] + steps[i][0], corners.back()[1] + steps[i][1]});
  if (random() % 2 == 0)
    corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(random() % corners.size()));
  const auto n = static_cast<std::uint32_t>(corners.size());
  const auto height = 1 + static_cast<std::int64_t>(random() % 5);
  const Step aside{static_cast<std::int64_t>(random() % 3) - 1, static_cast<std::int64_t>(random() % 3) - 1};
  TaggedMesh mesh;
  for (const Step& c : corners) add_point(mesh, c[0], c[1], 0);
  for (const Step& c : corners) add_point(mesh, c[0] + aside[0], c[1] + aside[1], height);
  mesh.polygons.resize(2);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t k = (i + 1) % n;
    mesh.polygons[0].push_back(n - 1 - i);
    mesh.polygons[1].push_back(n + i);
    mesh.polygons.push_back({i, k, n + k, n + i});
  }
  // The apex of a pyramid over one of the bases, perhaps inwards, perhaps in the plane.
  for (std::size_t f = 0; f < 2; ++f) {
    if (random() % 3 != 0) continue;
    const auto face = mesh.polygons[f];
    const Point p = mesh.points[face[0]], q = mesh.points[face[face.size() / 2]];
    const std::uint32_t apex = add_point(
        mesh, static_cast<std::int64_t>((p[0] + q[0]) / 2), static_cast<std::int64_t>((p[1] + q[1]) / 2),
        static_cast<std::int64_t>(p[2]) + static_cast<std::int64_t>(random() % 7) - 3);
    mesh.polygons[f] = {face.back(), face[0], apex};
    for (std::size_t i = 0; i + 1 < face.size(); ++i) mesh.polygons.push_back({face[i], face[i + 1], apex});
  }
  return mesh;
}

// The surface of some cells of a grid, with non-manifold edges where cells meet at edges only.
TaggedMesh cells(std::mt19937_64& random) {
  constexpr int n = 3;
  std::set<std::array<int, 3>> full;
  std::array<int, 3> at{1, 1, 1};
  for (std::size_t i = 0, count = 2 + random() % 10; i < count; ++i) {
    full.insert(at);
    int& x = at[random() % 3];
    x = std::clamp(x + (random() % 2 ? 1 : -1), 0, n - 1);
    if (random() % 8 == 0) at = {static_cast<int>(random() % n), static_cast<int>(random() % n), 1};
  }
  TaggedMesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> ids;
  const auto vertex = [&](const std::array<int, 3>& p) {
    const auto [it, fresh] = ids.try_emplace(p, 0u);
    if (fresh) it->second = add_point(mesh, p[0], p[1], p[2]);
    return it->second;
  };
  for (const auto& cell : full)
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const int way : {0, 1}) {
        auto beside = cell;
        beside[axis] += way == 0 ? -1 : 1;
        if (full.contains(beside)) continue;
        auto corner = cell;
        corner[axis] += way;
        const std::size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
        std::vector<std::uint32_t> face;
        for (const auto& [i, j] : {std::pair{0, 0}, std::pair{1, 0}, std::pair{1, 1}, std::pair{0, 1}}) {
          auto p = corner;
          p[a] += i;
          p[b] += j;
          face.push_back(vertex(p));
        }
        if (way == 0) std::reverse(face.begin(), face.end());
        mesh.polygons.push_back(face);
      }
  return mesh;
}

TaggedMesh flat_component(std::mt19937_64& random) {
  TaggedMesh mesh;
  switch (random() % 4) {
    case 0:
    case 1:
      mesh = whole_prism(random);
      break;
    case 2:
      mesh = cells(random);
      break;
    default:
      mesh = testing::random_solid(random);
      for (Point& p : mesh.points)
        for (double& x : p) x = std::round(16 * x);
  }
  // Sheared: angles of every size, exactly.
  for (int i = 0; i < 2; ++i) {
    const std::size_t a = random() % 3, b = (a + 1 + random() % 2) % 3;
    const double by = static_cast<double>(random() % 5) - 2;
    for (Point& p : mesh.points) p[a] += by * p[b];
  }
  TaggedMesh flat{mesh.points, {}, {}, {}, {}};
  for (const auto& face : mesh.polygons) {
    if (oracle::is_flat_and_convex(flat.points, face)) {
      flat.polygons.push_back(face);
      continue;
    }
    for (std::size_t k = 1; k + 1 < face.size(); ++k) {
      const std::vector<std::uint32_t> part{face[0], face[k], face[k + 1]};
      if (!oracle::is_flat_and_convex(flat.points, part)) return flat_component(random);  // a line
      flat.polygons.push_back(part);
    }
  }
  return flat;
}

struct FlatCase {
  TaggedMesh mesh;
  SchemeOptions options;
};

FlatCase flat_case(std::uint64_t number) {
  std::mt19937_64 random(number * 6151 + 3);
  FlatCase c{flat_component(random), {}};
  if (random() % 4 ==
      0) {  // another one through it or in it, perhaps inside out, perhaps with faces in its planes
    const TaggedMesh more = flat_component(random);
    const auto first = static_cast<std::uint32_t>(c.mesh.points.size());
    const double x = static_cast<double>(random() % 3), y = static_cast<double>(random() % 3);
    for (const Point& p : more.points) c.mesh.points.push_back({p[0] + x, p[1] + y, p[2]});
    const bool inside_out = random() % 2 == 0;
    for (auto face : more.polygons) {
      for (std::uint32_t& v : face) v += first;
      if (inside_out) std::reverse(face.begin(), face.end());
      c.mesh.polygons.push_back(face);
    }
  }
  if (random() % 8 == 0) c.mesh.polygons.erase(c.mesh.polygons.begin());  // open
  const bool triangles = std::all_of(c.mesh.polygons.begin(), c.mesh.polygons.end(),
                                     [](const auto& face) { return face.size() == 3; });
  const std::uint64_t which = random() % 4;
  c.options.scheme = which == 0   ? Scheme::bilinear
                     : !triangles ? Scheme::catmark
                     : which == 1 ? Scheme::flat
                     : which == 2 ? Scheme::loop
                                  : Scheme::catmark;
  if (c.options.scheme == Scheme::loop || c.options.scheme == Scheme::catmark) {
    for (const auto& face : c.mesh.polygons)
      for (std::size_t k = 0; k < face.size(); ++k) {
        c.mesh.creases.push_back({face[k], face[(k + 1) % face.size()], oracle::kInfinitelySharp});
        c.mesh.corners.push_back({face[k], oracle::kInfinitelySharp});
      }
  }
  const double scale = std::ldexp(1, static_cast<int>(random() % 9) - 4);
  for (Point& p : c.mesh.points)
    for (double& x : p) x *= scale;
  return c;
}

Point mixed(const Point& a, const Point& b, double share) {
  return {a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2])};
}

// What an answer says about the exact hits.
struct Hits {
  std::vector<ExactHit> of_line;
  [[nodiscard]] static bool holds(const RayHit& hit, const mpq_class& t) {
    return (hit.t.lower == -INFINITY || mpq_class(hit.t.lower) <= t) &&
           (hit.t.upper == INFINITY || t <= mpq_class(hit.t.upper));
  }
};

struct Counted {
  std::size_t rays = 0, generic = 0, certified = 0, uncertified = 0, incomplete = 0, untold_generic = 0,
              hits = 0, off_edges = 0;
  double widest = 0;
};

// A ray that lies in a flat face spends all of it.
constexpr std::uint64_t usual_budget = 2000;

void check_flat(SurfaceWorkspace& workspace, const FlatFaces& twin, const Ray& ray, const RayOptions& options,
                const std::string& name, Counted& counted) {
  const auto where = [&] { return name + ": " + text_of(ray, options.query); };
  std::vector<ExactHit> truth = twin.hits(plain(ray.origin), plain(ray.direction));
  bool generic = oracle::is_generic(truth);
  std::erase_if(truth, [&](const ExactHit& hit) {
    return hit.t < mpq_class(ray.from) || (ray.to < INFINITY && hit.t > mpq_class(ray.to));
  });
  for (const ExactHit& hit : truth)
    generic = generic && hit.t > mpq_class(ray.from) && (ray.to == INFINITY || hit.t < mpq_class(ray.to));
  const RayHits answer = trace(workspace, ray, options);
  ++counted.rays;
  const bool usual = !options.precision && options.budget == usual_budget;
  counted.generic += generic && usual;
  counted.hits += truth.size();
  if (!answer.complete) ++counted.incomplete;
  const auto held = [&](const ExactHit& hit) {
    return std::any_of(answer.hits.begin(), answer.hits.end(),
                       [&](const RayHit& h) { return Hits::holds(h, hit.t); });
  };
  int sum = 0;
  bool all_certified = true;
  for (const RayHit& hit : answer.hits) {
    EXPECT_LE(hit.t.lower, hit.t.upper) << where();
    (hit.certified ? counted.certified : counted.uncertified)++;
    all_certified = all_certified && hit.certified;
    sum += hit.certified ? hit.side : 0;
    if (!hit.certified) continue;
    EXPECT_NE(hit.side, 0) << where();
    int inside = 0, own = 0;
    bool border = false;
    for (const ExactHit& h : truth) {
      if (!Hits::holds(hit, h.t)) continue;
      ++inside;
      own += h.side;
      border = border || h.border;
    }
    EXPECT_GT(inside, 0) << where() << ": no hit in a certified " << hit.t.lower << ' ' << hit.t.upper;
    if (!border && inside == 1) {
      EXPECT_EQ(hit.side, own) << where();
    }
  }
  if (answer.complete) {
    if (options.query == RayQuery::all) {
      for (const ExactHit& hit : truth)
        EXPECT_TRUE(held(hit)) << where() << ": lost the hit at " << hit.t.get_d() << " of face " << hit.face;
      if (generic && all_certified) {
        int exact = 0;
        for (const ExactHit& hit : truth) exact += hit.side;
        EXPECT_EQ(sum, exact) << where() << text_of(answer);
      }
    } else if (options.query == RayQuery::nearest) {
      if (!truth.empty()) {
        EXPECT_TRUE(held(truth.front())) << where() << ": lost the first hit, " << truth.front().t.get_d();
      }
      for (std::size_t i = 0; i + 1 < answer.hits.size(); ++i)
        EXPECT_FALSE(answer.hits[i].certified) << where();
    } else if (!answer.certain_hit()) {
      for (const ExactHit& hit : truth) EXPECT_TRUE(held(hit)) << where();
    } else {
      EXPECT_EQ(answer.hits.size(), 1u) << where();
    }
    if (!truth.empty()) {
      EXPECT_FALSE(answer.certain_miss()) << where();
    }
  }
  if (truth.empty()) {
    EXPECT_FALSE(answer.certain_hit()) << where();
  }
  if (generic && usual && !(all_certified && answer.complete)) ++counted.untold_generic;
}

class FlatTrials {
 public:
  FlatTrials(std::uint64_t number, Counted& counted)
      : case_(flat_case(number)),
        random_(number),
        name_("flat " + std::to_string(number) + ", " + name_of(case_.options.scheme)),
        twin_(case_.mesh.points, case_.mesh.polygons),
        surface_(testing::control_mesh(case_.mesh), case_.options, std::make_shared<BoundsCache>()),
        model_(surface_, {.method = random_() % 4 == 0 ? BoundMethod::table : BoundMethod::rows,
                          .tight = random_() % 4 == 0,
                          .threads = 1}),
        workspace_(model_),
        counted_(counted) {}

  void run(std::uint64_t rays) {
    for (std::uint64_t i = 0; i < rays && !::testing::Test::HasFailure(); ++i) {
      RayOptions options{.query = static_cast<RayQuery>(random_() % 4 == 0 ? random_() % 3 : 2)};
      if (random_() % 8 == 0)
        options.precision = std::array{0.0, 1e-9, 1e-3, 10.0, 1e5}[random_() % 5] * surface_.size();
      options.budget = random_() % 16 == 0 ? std::array{0, 1, 10}[random_() % 3] : usual_budget;
      check_flat(workspace_, twin_, ray(), options, name_ + ", ray " + std::to_string(i), counted_);
    }
  }

 private:
  double dyadic() { return static_cast<double>(random_() % 17) / 16; }
  const std::vector<std::uint32_t>& face() {
    return case_.mesh.polygons[random_() % case_.mesh.polygons.size()];
  }
  const Point& vertex() { return case_.mesh.points[face()[0]]; }
  Point on_edge() {
    const auto& f = face();
    const std::size_t k = random_() % f.size();
    return mixed(case_.mesh.points[f[k]], case_.mesh.points[f[(k + 1) % f.size()]], dyadic());
  }
  Point on_face() {
    const auto& f = face();
    const std::size_t k = 1 + random_() % (f.size() - 2);
    const auto at = [&](std::size_t i) { return case_.mesh.points[f[i]]; };
    return mixed(at(0), mixed(at(k), at(k + 1), dyadic()), dyadic());
  }
  Point anywhere() {
    const double share = 1.5 * surface_.size();
    Point p = vertex();
    for (double& x : p) x += random_() % 3 == 0 ? 0 : std::round(64 * between(random_, -1, 1)) / 64 * share;
    return p;
  }
  Point some() {
    switch (random_() % 5) {
      case 0:
        return vertex();
      case 1:
        return on_edge();
      case 2:
        return on_face();
      default:
        return anywhere();
    }
  }
  Ray ray() {
    const Point p = some();
    Point q = p;
    while (q == p) q = some();
    if (random_() % 6 == 0) {  // along a face or an edge
      const auto& f = face();
      const Point &a = case_.mesh.points[f[0]], &b = case_.mesh.points[f[1 + random_() % (f.size() - 1)]];
      for (std::size_t x = 0; x < 3; ++x) q[x] = p[x] + b[x] - a[x];
    }
    Ray ray{{p[0], p[1], p[2]}, {q[0] - p[0], q[1] - p[1], q[2] - p[2]}};
    switch (random_() % 6) {
      case 0:
        ray.from = -8;
        break;
      case 1:
        ray.to = random_() % 2 == 0 ? 1 : 0.5 + dyadic();
        break;
      case 2:
        ray.from = -dyadic();
        ray.to = dyadic();
        break;
      default:
        break;
    }
    const double length = std::ldexp(1, static_cast<int>(random_() % 7) * 100 - 300);
    if (random_() % 8 == 0 && ray.to == INFINITY && ray.from == 0) ray.direction = length * ray.direction;
    return ray;
  }

  FlatCase case_;
  std::mt19937_64 random_;
  std::string name_;
  FlatFaces twin_;
  LimitSurface surface_;
  SurfaceBvh model_;
  SurfaceWorkspace workspace_;
  Counted& counted_;
};

TEST(rays, meet_sharp_polyhedra_where_exact_ones_do) {
  constexpr std::uint64_t rays_a_solid = 200;
  const std::uint64_t first = number_of("SNUG_FIRST", 0),
                      solids = (number_of("SNUG_PLACEMENTS", 40'000) + rays_a_solid - 1) / rays_a_solid;
  Counted counted;
  std::uint64_t refused = 0;
  for (std::uint64_t i = 0; i < solids && !HasFailure(); ++i) {
    try {
      FlatTrials(first + i, counted).run(rays_a_solid);
    } catch (const InputError& error) {
      if (refused++ == 0) std::cout << "  refused " << first + i << ": " << error.what() << '\n';
    }
  }
  std::cout << "  " << counted.rays << " rays, " << counted.generic << " generic, " << counted.hits
            << " exact hits, " << counted.certified << " answers certified, " << counted.uncertified
            << " not; of generic rays " << counted.untold_generic << " not told; " << counted.incomplete
            << " ended by a budget; " << refused << " solids refused\n";
  EXPECT_GT(counted.generic * 10, counted.rays);
  EXPECT_LE(counted.untold_generic * 100, counted.generic);
}

}  // namespace
}  // namespace snug
