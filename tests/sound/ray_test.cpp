// The promises of ray(): against exact rational hits on sharp polyhedra, and on curved surfaces against refined
// meshes and the hulls of their one-rings.
//
//   SNUG_PLACEMENTS=1000000 build/release/bin/tests/sound_test --gtest_filter=rays.aimed_*
//
// asks so many rays; SNUG_FIRST=N begins with case N.

#include <snug/distance.h>
#include <snug/evaluate.h>
#include <snug/ray.h>

#include <gtest/gtest.h>
#include <oracle/ray_twin.h>
#include <oracle/tagged_shapes.h>
#include <snug/search/surface_data.h>
#include <snug/surface/evaluate.h>
#include <support/error.h>
#include <testing/counts.h>
#include <testing/disguises.h>
#include <testing/places.h>
#include <testing/ray_bundles.h>
#include <testing/solid_cases.h>
#include <testing/surfaces.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <map>
#include <numeric>
#include <set>
#include <sstream>

namespace snug::ray_test {
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

bool is_sorted(const RayHits& answer) {
  return std::is_sorted(answer.hits.begin(), answer.hits.end(),
                        [](const RayHit& x, const RayHit& y) { return x.t.lower < y.t.lower; });
}

std::string text_of(const RayHits& answer) {
  std::ostringstream text;
  text.precision(17);
  for (const RayHit& hit : answer.hits)
    text << "\n  " << hit.t.lower << " .. " << hit.t.upper
         << (hit.certified ? " certified " : " not certified ") << hit.side;
  return text.str() + (answer.outcome != Outcome::budget_spent ? "" : "\n  incomplete");
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

// An answer compared with the exact hits.
struct Hits {
  std::vector<ExactHit> of_line;
  [[nodiscard]] static bool holds(const RayHit& hit, const mpq_class& t) {
    return (hit.t.lower == -INFINITY || mpq_class(hit.t.lower) <= t) &&
           (hit.t.upper == INFINITY || t <= mpq_class(hit.t.upper));
  }
};

struct Counted {
  std::size_t rays = 0, generic = 0, certified = 0, uncertified = 0, incomplete = 0, untold_generic = 0,
              without_side = 0, hits = 0, off_edges = 0;
  double widest = 0;
};

// A ray that lies in a flat face spends all of it.
constexpr std::uint64_t usual_budget = 2000;

void check_flat(const Surface& surface, const FlatFaces& twin, const Ray& ray, const RayOptions& options,
                const Run& run, const std::string& name, Counted& counted) {
  const auto where = [&] { return name + ": " + text_of(ray, options.query); };
  std::vector<ExactHit> truth = twin.hits(plain(ray.origin), plain(ray.direction));
  bool generic = oracle::is_generic(truth);
  std::erase_if(truth, [&](const ExactHit& hit) {
    return hit.t < mpq_class(ray.from) || (ray.to < INFINITY && hit.t > mpq_class(ray.to));
  });
  for (const ExactHit& hit : truth)
    generic = generic && hit.t > mpq_class(ray.from) && (ray.to == INFINITY || hit.t < mpq_class(ray.to));
  const RayHits answer = snug::ray(surface, ray, options, run);
  ++counted.rays;
  const bool usual = !options.absolute && run.max_splits == usual_budget;
  counted.generic += generic && usual;
  counted.hits += truth.size();
  if (answer.outcome == Outcome::budget_spent) ++counted.incomplete;
  const auto held = [&](const ExactHit& hit) {
    return std::any_of(answer.hits.begin(), answer.hits.end(),
                       [&](const RayHit& h) { return Hits::holds(h, hit.t); });
  };
  EXPECT_TRUE(is_sorted(answer)) << where() << text_of(answer);
  int sum = 0;
  bool all_certified = true;
  for (const RayHit& hit : answer.hits) {
    EXPECT_LE(hit.t.lower, hit.t.upper) << where();
    (hit.certified ? counted.certified : counted.uncertified)++;
    all_certified = all_certified && hit.certified;
    sum += hit.certified ? hit.side : 0;
    if (!hit.certified) continue;
    int inside = 0, own = 0;
    bool border = false;
    for (const ExactHit& h : truth) {
      if (!Hits::holds(hit, h.t)) continue;
      ++inside;
      own += h.side;
      border = border || h.border;
    }
    EXPECT_GT(inside, 0) << where() << ": no hit in a certified " << hit.t.lower << ' ' << hit.t.upper;
    if (!border && inside == 1 && hit.side != 0) {
      EXPECT_EQ(hit.side, own) << where();
    }
    counted.without_side += hit.side == 0 ? 1 : 0;  // as ray.h allows
  }
  if (answer.outcome != Outcome::budget_spent) {
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
  if (generic && usual && !(all_certified && answer.outcome != Outcome::budget_spent))
    ++counted.untold_generic;
}

class FlatTrials {
 public:
  FlatTrials(std::uint64_t number, Counted& counted)
      : case_(flat_case(number)),
        random_(number),
        name_("flat " + std::to_string(number) + ", " + name_of(case_.options.scheme)),
        twin_(case_.mesh.points, case_.mesh.polygons),
        surface_(
            testing::public_surface(testing::control_mesh(case_.mesh), case_.options,
                                    {.bounds = random_() % 4 == 0 ? BoundMethod::table : BoundMethod::rows,
                                     .tight = random_() % 4 == 0})),
        counted_(counted) {}

  void run(std::uint64_t rays) {
    for (std::uint64_t i = 0; i < rays && !::testing::Test::HasFailure(); ++i) {
      RayOptions options{.query = static_cast<RayQuery>(random_() % 4 == 0 ? random_() % 3 : 2)};
      if (random_() % 4 == 0)
        options.absolute = std::array{0.0, 1e-9, 1e-3, 10.0, 1e5}[random_() % 5] * surface_.size();
      const Run run{.max_splits = random_() % 16 == 0 ? std::array<std::uint64_t, 3>{0, 1, 10}[random_() % 3]
                                                      : usual_budget};
      check_flat(surface_, twin_, ray(), options, run, name_ + ", ray " + std::to_string(i), counted_);
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
    if (random_() % 3 == 0) {  // beside that, by more or by less than tubes are wide
      const double aside = surface_.size() * std::ldexp(1, -6 - static_cast<int>(random_() % 24));
      for (double& x : q) x += static_cast<double>(static_cast<int>(random_() % 3) - 1) * aside;
      if (q == p) q[0] += aside;
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
  Surface surface_;
  Counted& counted_;
};

TEST(rays, meet_sharp_polyhedra_where_exact_ones_do) {
  constexpr std::uint64_t rays_a_solid = 200;
  const std::uint64_t first = number_of("SNUG_FIRST", 0),
                      solids = (number_of("SNUG_PLACEMENTS", 1000) + rays_a_solid - 1) / rays_a_solid;
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
  EXPECT_LE(counted.untold_generic * 8, counted.generic);
  EXPECT_LE(counted.without_side * 1000, counted.certified);
}

// Just outside of the border, nearer than a piece is known.
TEST(rays, beside_a_border_are_no_certain_hits) {
  TaggedMesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2, 3}}, {}, {}, {}};
  const Surface surface(testing::control_mesh(mesh), {.scheme = Scheme::bilinear});
  for (int k = 20; k < 50; ++k)
    for (const double share : {0.1, 0.37, 0.5, 0.8})
      for (const double precision : {1e-9, 1e-6, 1e-2}) {
        const double off = std::ldexp(1, -k);
        for (const Point3& from : {Point3{-off, share, 1}, Point3{1 + off, share, 1}, Point3{share, -off, 1},
                                   Point3{share, 1 + off, 1}}) {
          EXPECT_FALSE(snug::ray(surface, Ray{from, {0, 0, -1}}, {.absolute = precision}).certain_hit()) << k;
        }
      }
}

// ---- Curved surfaces --------------------------------------------------------------------------------------------

struct CurvedCase {
  std::string name;
  TaggedMesh mesh;
  oracle::WindingScheme scheme;
  SchemeOptions options;
  int levels = 2;  // of the twin
};

// Where on a patch a ray is aimed at: corners are vertices of the mesh or of its first split.
enum class Spot : std::uint8_t { inside, dyadic_inside, side, dyadic_side, corner };
constexpr std::size_t spots = 5;

struct CurvedCounts {
  std::size_t rays = 0, random = 0, aimed = 0, from_inside = 0, from_outside = 0, touching = 0;
  std::size_t uncertified_random = 0, uncertified_aimed = 0, uncertified_touching = 0, incomplete = 0,
              twin_ranges = 0, twin_crossings = 0, even_checks = 0, hits = 0;
  double seconds = 0, slowest = 0;
  std::string slowest_ray;
  std::map<std::string, std::size_t> thrown;

  void print() const {
    std::cout << "  " << rays << " rays: " << random << " random (" << uncertified_random
              << " with answers not certified), " << aimed << " aimed at spots (" << uncertified_aimed
              << "), " << touching << " tangent (" << uncertified_touching << "); " << from_inside
              << " from inside, " << from_outside << " from outside, " << even_checks << " summed up to 0; "
              << hits << " answers; " << incomplete << " ended by a budget; twin: " << twin_ranges
              << " ranges, " << twin_crossings << " crossed; "
              << 1e6 * seconds / static_cast<double>(std::max<std::size_t>(rays, 1)) << " us a ray, slowest "
              << 1e3 * slowest << " ms: " << slowest_ray << '\n';
  }
};

class CurvedTrials {
 public:
  CurvedTrials(CurvedCase c, std::uint64_t seed, CurvedCounts& counts)
      : case_(std::move(c)),
        random_(seed),
        surface_(
            testing::public_surface(control(case_), case_.options,
                                    {.bounds = random_() % 4 == 0 ? BoundMethod::table : BoundMethod::rows,
                                     .tight = random_() % 4 == 0})),
        ball_(surface_.data()->bvh().ball()),
        exponent_(exponent_of(case_.mesh)),
        twin_(scaled(case_.mesh, -exponent_), case_.scheme, case_.levels),
        counts_(counts) {
    const LimitSurface& limit = surface_.data()->limit();
    for (std::size_t p = 0; p < limit.patch_count(); ++p) {
      if (limit.has_patch(PatchId(p))) patches_.emplace_back(p);
    }
    try {
      static_cast<void>(contains(surface_, surface_.mesh().points[0]));
      closed_ = true;
    } catch (const InputError&) {
    }
    find_origins();
  }

  void run(std::uint64_t rays) {
    for (std::uint64_t i = 0; i < rays && !::testing::Test::HasFailure(); ++i) one(i);
  }

  // Lines through two spots of every two sorts.
  // Every third pair of spots: three surfaces in a row have all.
  void run_pairs(std::size_t turn) {
    for (std::size_t a = 0; a < spots; ++a)
      for (std::size_t b = 0; b < spots && !::testing::Test::HasFailure(); ++b) {
        if ((a + b + turn) % 3 != 0) continue;
        const Point3 p = spot(static_cast<Spot>(a)), q = spot(static_cast<Spot>(b));
        if (p == q) continue;
        Ray ray{p, q - p, -1e3, 1e3};
        ask(ray, {.query = RayQuery::all}, {.max_splits = usual_budget}, {}, counts_.uncertified_aimed, true);
        ++counts_.aimed;
      }
  }

  // From near and far, with directions of every length, to and from places on the surface, with every precision
  // and budget.
  void run_extremes(std::uint64_t rays) {
    for (std::uint64_t i = 0; i < rays && !::testing::Test::HasFailure(); ++i) {
      const Point3 p = spot(static_cast<Spot>(random_() % spots)),
                   q = spot(static_cast<Spot>(random_() % spots));
      const auto some = [&] { return between(random_, -1, 1); };
      const Vector3 aside =
          std::array{0.0, 1e-9, 1e-3, 1.0, 1e6}[random_() % 5] * Vector3{some(), some(), some()};
      Ray ray{q + ball_.radius * aside, {}};
      ray.direction = p - ray.origin;
      const double largest = max_abs(ray.direction);
      if (!(largest > 0) || !std::isfinite(largest) || !is_finite(ray.origin)) continue;
      switch (random_() % 5) {
        case 0:
          ray.to = 1;
          break;
        case 1:
          ray.from = random_() % 2 == 0 ? 1 : -1e3;
          break;
        default: {
          // A power of two that leaves the direction as it is, up to subnormal numbers.
          const int exponent = std::array{-600, 0, 600}[random_() % 3] - std::ilogb(largest);
          for (std::size_t k = 0; k < 3; ++k) ray.direction[k] = std::ldexp(ray.direction[k], exponent);
        }
      }
      RayOptions options{.query = static_cast<RayQuery>(random_() % 3)};
      Run run{.max_splits = 500};
      if (random_() % 2 == 0) {
        options.absolute = std::array{0.0, 1e-15, 1e-3, 1e3}[random_() % 4] * surface_.size();
        if (!std::isfinite(*options.absolute)) options.absolute.reset();
      }
      if (random_() % 3 == 0) run.max_splits = std::array<std::uint64_t, 3>{0, 1, 10}[random_() % 3];
      try {
        ask(ray, options, run, {}, counts_.uncertified_aimed, true);
        ++counts_.aimed;
      } catch (const InputError& error) {
        ++counts_.thrown[error.what()];
      }
    }
  }

  [[nodiscard]] bool closed() const { return closed_; }

 private:
  static int exponent_of(const TaggedMesh& mesh) {
    double largest = 0;
    for (const Point& p : mesh.points)
      for (const double x : p) largest = std::max(largest, std::fabs(x));
    return largest > 0 ? std::ilogb(largest) : 0;
  }
  static TaggedMesh scaled(TaggedMesh mesh, int exponent) {
    for (Point& p : mesh.points)
      for (double& x : p) x = std::ldexp(x, exponent);
    return mesh;
  }
  static ControlMesh control(const CurvedCase& c) {
    const oracle::Rules* const rules = std::get_if<oracle::Rules>(&c.scheme);
    return testing::control_mesh(c.mesh, rules ? *rules : oracle::Rules{});
  }
  SurfacePoint on_patch(Spot sort) {
    const PatchId p = patches_[random_() % patches_.size()];
    const double grain = std::ldexp(1, -static_cast<int>(1 + random_() % 6));
    double u = between(random_, 0, 1), v = between(random_, 0, 1);
    if (sort == Spot::dyadic_inside || sort == Spot::dyadic_side) {
      u = std::round(u / grain) * grain;
      v = std::round(v / grain) * grain;
    }
    if (sort == Spot::corner) {
      u = v = 0;
      const auto k = random_() % 3;
      (k == 1 ? u : v) = k == 0 ? 0 : 1;
    } else if (sort == Spot::side || sort == Spot::dyadic_side) {
      const auto k = random_() % 3;
      if (k == 0) v = 0;
      if (k == 1) v = 1 - u;
      if (k == 2) u = 0;
    } else if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    return evaluate(surface_, place_of(surface_.data()->limit(), p, {u, v}));
  }
  Point3 spot(Spot sort) { return on_patch(sort).point; }
  Point3 anywhere(double share) {
    Point3 q = ball_.centre;
    for (std::size_t x = 0; x < 3; ++x) q[x] += between(random_, -share, share) * ball_.radius;
    return q;
  }
  void find_origins() {
    for (int i = 0; i < 40; ++i) {
      Point3 q = anywhere(1.2);
      if (i % 2 == 0) {
        const SurfacePoint p = on_patch(Spot::inside);
        if (!p.normal) continue;
        q = p.point - ball_.radius * std::exp2(-between(random_, 1, i % 4 == 0 ? 6 : 20)) * *p.normal;
      }
      if (!is_finite(q)) continue;
      if (!closed_) {
        outside_.push_back(q);
        continue;
      }
      const std::optional<bool> held = contains(surface_, q);
      if (held) (*held ? inside_ : outside_).push_back(q);
    }
    outside_.push_back(anywhere(0) + 1e6 * ball_.radius * Vector3{0.3, -0.5, 0.7});
  }

  void one(std::uint64_t i) {
    const bool within = !inside_.empty() && random_() % 2 == 0;
    const auto& pool = within ? inside_ : outside_;
    Ray ray{pool[random_() % pool.size()], {}};
    const std::optional<bool> known = closed_ ? std::optional(within) : std::nullopt;
    std::size_t* uncertified = &counts_.uncertified_aimed;
    if (i % 4 == 3) {
      ray.direction = {between(random_, -1, 1), between(random_, -1, 1), between(random_, -1, 1)};
      if (!within) ray.direction = anywhere(1) - ray.origin;
      uncertified = &counts_.uncertified_random;
      ++counts_.random;
    } else if (i % 4 == 2) {
      // Tangent: inside or outside is not known.
      const SurfacePoint p = on_patch(static_cast<Spot>(random_() % spots));
      Vector3 along =
          p.normal
              ? cross(*p.normal, {between(random_, -1, 1), between(random_, -1, 1), between(random_, -1, 1)})
              : p.tangents[0];
      if (along == Vector3{}) along = {1, 0, 0};
      along = (1 / length(along)) * along;
      ray = {p.point - between(random_, 0, 2) * ball_.radius * along, along};
      uncertified = &counts_.uncertified_touching;
      ++counts_.touching;
      const std::optional<bool> held = closed_ ? contains(surface_, ray.origin) : std::nullopt;
      ask(ray, {.query = static_cast<RayQuery>(random_() % 3)}, {.max_splits = usual_budget}, held,
          *uncertified, i % 4 == 0);
      return;
    } else {
      ray.direction = spot(static_cast<Spot>(random_() % spots)) - ray.origin;
      ++counts_.aimed;
    }
    if (ray.direction == Vector3{}) return;
    const RayQuery query = random_() % 2 == 0 ? RayQuery::all : static_cast<RayQuery>(random_() % 2);
    ask(ray, {.query = query}, {.max_splits = 20'000}, known, *uncertified, closed_ ? i % 8 < 2 : true);
  }

  void ask(const Ray& ray, const RayOptions& options, const Run& run, std::optional<bool> within,
           std::size_t& uncertified, bool by_twin) {
    const auto where = [&] { return case_.name + ": " + testing_text(ray, options); };
    const auto before = std::chrono::steady_clock::now();
    const RayHits answer = snug::ray(surface_, ray, options, run);
    const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
    counts_.seconds += took;
    if (took > counts_.slowest) {
      counts_.slowest = took;
      counts_.slowest_ray = where();
    }
    ++counts_.rays;
    counts_.hits += answer.hits.size();
    counts_.incomplete += answer.outcome == Outcome::budget_spent;
    EXPECT_TRUE(is_sorted(answer)) << where() << text_of(answer);
    bool all_certified = answer.outcome != Outcome::budget_spent;
    int sum = 0;
    std::size_t certified = 0;
    for (const RayHit& hit : answer.hits) {
      all_certified = all_certified && hit.certified;
      certified += hit.certified;
      sum += hit.certified ? hit.side : 0;
      EXPECT_LE(hit.t.lower, hit.t.upper) << where();
      if (hit.certified) {
        EXPECT_GE(hit.t.lower, ray.from) << where();
        EXPECT_LE(hit.t.upper, ray.to) << where();
        // Of the first hits of two sheets in one, none is told.
        EXPECT_GE(std::abs(hit.side), options.query == RayQuery::nearest ? 0 : 1) << where();
      }
    }
    uncertified += !all_certified && !answer.certain_hit();
    const bool whole = ray.from == 0 && ray.to == INFINITY;
    if (within) (*within ? counts_.from_inside : counts_.from_outside)++;
    if (within && *within && whole) {
      EXPECT_FALSE(answer.certain_miss()) << where() << ": a miss from inside";
    }
    if (within && whole && options.query == RayQuery::all && all_certified) {
      if (*within) {
        EXPECT_NE(sum, 0) << where() << text_of(answer);
      } else {
        EXPECT_EQ(sum, 0) << where() << text_of(answer);
        EXPECT_EQ(certified % 2, 0u) << where() << text_of(answer);
        ++counts_.even_checks;
      }
    }
    if (by_twin) compare(ray, options, answer, where());
  }

  static std::string testing_text(const Ray& ray, const RayOptions& options) {
    return text_of(ray, options.query);
  }

  // Brings lengths near 1, exactly, and as far as it can.
  void compare(const Ray& ray, const RayOptions& options, const RayHits& answer, const std::string& where) {
    const auto power = [](const Vector3& v) {
      return std::ilogb(std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}));
    };
    const int turned = power(ray.direction);
    const auto by = [](const Point& p, int exponent) {
      return Point{std::ldexp(p[0], exponent), std::ldexp(p[1], exponent), std::ldexp(p[2], exponent)};
    };
    auto ranges = twin_.ranges(by(plain(ray.origin), -exponent_), by(plain(ray.direction), -turned));
    for (auto& range : ranges) {
      range.lower = std::ldexp(range.lower, exponent_ - turned);
      range.upper = std::ldexp(range.upper, exponent_ - turned);
    }
    const auto overlap = [](const Interval& t, const oracle::RefinedRays::Range& range) {
      return t.lower <= range.upper && range.lower <= t.upper;
    };
    counts_.twin_ranges += ranges.size();
    for (const RayHit& hit : answer.hits) {
      if (!hit.certified) continue;
      EXPECT_TRUE(
          std::any_of(ranges.begin(), ranges.end(), [&](const auto& range) { return overlap(hit.t, range); }))
          << where << ": certified where there is no surface" << text_of(answer);
    }
    if (answer.outcome == Outcome::budget_spent) return;
    const double end = options.query == RayQuery::all || !answer.certain_hit() ? INFINITY
                       : options.query == RayQuery::any                        ? -INFINITY
                                                                               : answer.hits.back().t.lower;
    for (const auto& range : ranges) {
      if (range.lower < ray.from || range.upper > std::min(end, ray.to)) continue;
      if (!range.crossings) continue;
      counts_.twin_crossings += *range.crossings != 0;
      bool own = true, any = false;
      int sum = 0;
      for (const RayHit& hit : answer.hits) {
        if (!overlap(hit.t, range)) continue;
        any = true;
        own = own && hit.certified && hit.t.lower >= range.lower && hit.t.upper <= range.upper;
        sum += hit.side;
      }
      if (*range.crossings != 0) {
        EXPECT_TRUE(any) << where << ": lost the crossing in " << range.lower << " .. " << range.upper
                         << text_of(answer);
      }
      if (own && options.query == RayQuery::all) {
        EXPECT_EQ(sum, *range.crossings)
            << where << ": " << range.lower << " .. " << range.upper << text_of(answer);
      }
    }
  }

  CurvedCase case_;
  std::mt19937_64 random_;
  Surface surface_;
  Ball ball_;
  int exponent_;  // coordinates of the twin are smaller by this power of two
  oracle::RefinedRays twin_;
  CurvedCounts& counts_;
  std::vector<PatchId> patches_;
  std::vector<Point3> inside_, outside_;
  bool closed_ = false;
};

TaggedMesh tagged(const ControlMesh& mesh) {
  TaggedMesh twin;
  for (const Point3& p : mesh.points) twin.points.push_back(plain(p));
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    twin.polygons.emplace_back();
    for (const VertexId v : mesh.face(FaceId(f))) twin.polygons.back().push_back(v.value());
  }
  for (const CreaseTag& c : mesh.tags.creases)
    twin.creases.push_back({c.a.value(), c.b.value(), c.sharpness});
  for (const CornerTag& c : mesh.tags.corners) twin.corners.push_back({c.vertex.value(), c.sharpness});
  return twin;
}

CurvedCase model_case(std::size_t i) {
  constexpr std::array names{"bracket", "bust", "demon", "figure", "head", "pawn", "pin", "ring", "star"};
  const std::string name = names[i % names.size()];
  const ControlMesh mesh = read_mesh(testing::models_dir() + "/" + name + ".obj");
  oracle::Rules rules;
  rules.clamp_dart_edges = true;
  rules.scheme =
      natural_scheme(mesh) == Scheme::loop ? oracle::PrimalScheme::loop : oracle::PrimalScheme::catmull_clark;
  rules.chaikin = mesh.tags.crease_method == CreaseMethod::chaikin;
  rules.smooth_triangles = mesh.tags.smooth_triangles == SmoothTriangles::smooth;
  return {name, tagged(mesh), rules, testing::options_of(rules), mesh.face_count() > 2000 ? 0 : 1};
}

// Solids of every scheme; every fourth a vertex of up to 60 faces.
CurvedCase closed_case(std::uint64_t number) {
  if (number % 4 != 3) {
    testing::SolidCase c = testing::solid_case(number);
    const int levels = testing::twin_levels(c.mesh, 600);
    return {c.name, std::move(c.mesh), c.scheme, c.options, levels};
  }
  std::mt19937_64 random(number * 31 + 5);
  const auto n = static_cast<std::uint32_t>(3 + random() % 58);
  oracle::Rules rules;
  rules.clamp_dart_edges = true;
  rules.chaikin = random() % 3 == 0;
  rules.scheme = random() % 2 == 0 ? oracle::PrimalScheme::loop : oracle::PrimalScheme::catmull_clark;
  rules.smooth_triangles = rules.scheme == oracle::PrimalScheme::catmull_clark && random() % 3 == 0;
  TaggedMesh mesh = random() % 2 == 0 ? oracle::meshes::pyramid(n) : oracle::meshes::prism(n);
  if (rules.scheme == oracle::PrimalScheme::loop) mesh = oracle::meshes::triangulated(mesh);
  mesh = oracle::meshes::shaken(mesh, random() % 2 == 0 ? 0 : 0.1, random);
  if (random() % 2 == 0) testing::tag(mesh, random, false);
  return {
      "valence " + std::to_string(n) + ", case " + std::to_string(number) + ", " + testing::text_of(rules),
      mesh, rules, testing::options_of(rules), 2};
}

TEST(rays, aimed_at_closed_surfaces_miss_none) {
  constexpr std::uint64_t rays_a_surface = 100;
  const std::uint64_t first = number_of("SNUG_FIRST", 0),
                      surfaces = (number_of("SNUG_PLACEMENTS", 1000) + rays_a_surface - 1) / rays_a_surface;
  CurvedCounts counts;
  std::uint64_t refused = 0, open = 0;
  for (std::uint64_t i = first; i < first + surfaces && !HasFailure(); ++i) {
    try {
      const bool model = i % 24 == 23;
      CurvedTrials trials(model ? model_case(i / 24) : closed_case(i), i, counts);
      open += !trials.closed();
      trials.run(rays_a_surface);
    } catch (const InputError& error) {
      if (refused++ == 0) std::cout << "  refused " << i << ": " << error.what() << '\n';
    }
  }
  counts.print();
  std::cout << "  " << surfaces << " surfaces, " << refused << " refused, " << open << " not closed\n";
  EXPECT_LE(refused * 50, surfaces);
  EXPECT_LE(counts.uncertified_random * 1000, counts.random);
  EXPECT_GT(counts.from_inside * 4, counts.rays);
}

// Boundaries of every rule, holes, what is not manifold, tags of every sort, all schemes; lines through each two
// sorts of spots.
TEST(rays, cross_open_surfaces_where_the_twins_do) {
  const std::uint64_t rounds = 1 + number_of("SNUG_PLACEMENTS", 0) / 20'000 / 2;
  CurvedCounts counts;
  std::size_t refused = 0, turn = 0, number = 0;
  const auto try_one = [&](CurvedCase c, std::uint64_t seed) {
    try {
      CurvedTrials trials(std::move(c), seed, counts);
      trials.run_pairs(turn++);
      trials.run(20);
    } catch (const InputError&) {
      ++refused;  // no face has a surface
    }
  };
  for (std::uint64_t round = 0; round < rounds && !HasFailure(); ++round) {
    const std::uint64_t seed = 500 + number_of("SNUG_FIRST", 0) + round;
    for (const auto scheme : {oracle::PrimalScheme::catmull_clark, oracle::PrimalScheme::loop}) {
      for (const testing::TaggedCase& c : testing::tagged_cases(scheme, seed)) {
        const std::size_t i = number++;
        // Of each shape's six cases, plain or tagged with each boundary rule, one by turns; or every second one.
        const std::size_t shape = i / 6;
        if (testing::long_check() ? (i + shape) % 2 != 0 : i % 6 != 5 * shape % 6) continue;
        try_one({c.name + ", " + testing::text_of(c.rules), c.mesh, c.rules, testing::options_of(c.rules),
                 testing::twin_levels(c.mesh, 2000)},
                seed);
        if (HasFailure()) return;
      }
    }
    std::mt19937_64 random(seed);
    for (const auto& [scheme, twin] : {std::pair{Scheme::doo_sabin, oracle::DualScheme::doo_sabin},
                                       std::pair{Scheme::midedge, oracle::DualScheme::midedge}}) {
      for (const TaggedMesh& mesh :
           {oracle::meshes::quad_grid(5, 4), oracle::meshes::mixed_strip(), oracle::meshes::pyramid(7),
            oracle::meshes::triangulated(oracle::meshes::quad_grid(4, 4)), oracle::meshes::prism(5)}) {
        try_one({name_of(scheme), oracle::meshes::shaken(mesh, 0.3, random), twin, {scheme}, 4}, seed);
        if (HasFailure()) return;
      }
    }
  }
  std::cout << "  " << refused << " refused\n";
  counts.print();
  EXPECT_GT(counts.twin_crossings * 10, counts.rays);
}

TEST(rays, hold_in_every_disguise) {
  CurvedCounts counts;
  std::size_t refused = 0, number = number_of("SNUG_FIRST", 0);
  const std::uint64_t rays = 4 * (1 + number_of("SNUG_PLACEMENTS", 0) / 20'000);
  for (const auto scheme : {oracle::PrimalScheme::catmull_clark, oracle::PrimalScheme::loop}) {
    for (const testing::TaggedCase& c : testing::tagged_cases(scheme, 800 + number)) {
      if (++number % 11 != 0) continue;
      for (const testing::Disguise& disguise : testing::disguises()) {
        CurvedCase changed{c.name + ", " + testing::text_of(c.rules) + ", " + disguise.name, c.mesh, c.rules,
                           testing::options_of(c.rules), testing::twin_levels(c.mesh, 300)};
        for (Point& p : changed.mesh.points) p = disguise.change(p);
        try {
          CurvedTrials(std::move(changed), number, counts).run_extremes(rays);
        } catch (const InputError& error) {
          ++refused;
          ++counts.thrown[std::string("surface: ") + error.what()];
        }
        if (HasFailure()) return;
      }
    }
  }
  counts.print();
  std::cout << "  " << refused << " refused\n";
  for (const auto& [text, count] : counts.thrown) std::cout << "  " << count << " times: " << text << '\n';
}

TEST(rays, that_lie_together_have_the_answers_of_each_alone) {
  std::mt19937_64 random(88);
  testing::BundleCounts counts;
  const auto ask = [&](const ControlMesh& mesh, const SchemeOptions& rules, const std::string& name) {
    try {
      testing::expect_together_as_alone(testing::public_surface(mesh, rules), name, 1, random, counts);
    } catch (const InputError&) {
      // No face has a surface.
    }
    return !HasFatalFailure();
  };
  for (const auto scheme : {oracle::PrimalScheme::catmull_clark, oracle::PrimalScheme::loop}) {
    for (const testing::TaggedCase& c : testing::tagged_cases(scheme, 89)) {
      const std::string name = c.name + ", " + testing::text_of(c.rules);
      if (!ask(testing::control_mesh(c.mesh, c.rules), testing::options_of(c.rules), name)) return;
    }
  }
  for (const Scheme scheme : {Scheme::doo_sabin, Scheme::midedge, Scheme::bilinear, Scheme::flat}) {
    for (int shape = 0; shape < 6; ++shape) {
      const TaggedMesh plain = shape % 3 == 0   ? oracle::meshes::prism(5)
                               : shape % 3 == 1 ? oracle::meshes::quad_grid(4, 4)
                                                : oracle::meshes::pyramid(7);
      const TaggedMesh mesh = oracle::meshes::shaken(
          scheme == Scheme::flat ? oracle::meshes::triangulated(plain) : plain, 0.3, random);
      if (!ask(testing::control_mesh(mesh), {scheme}, std::string(name_of(scheme)))) return;
    }
  }
  // Surfaces that are lines, where nothing is proved and budgets end.
  for (const Scheme scheme : {Scheme::catmark, Scheme::loop}) {
    for (int shape = 0; shape < 3; ++shape) {
      const TaggedMesh grid = oracle::meshes::quad_grid(4, 4);
      ControlMesh mesh =
          testing::control_mesh(scheme == Scheme::loop ? oracle::meshes::triangulated(grid) : grid);
      for (Point3& p : mesh.points) {
        const double place =
            p.x + (shape % 2 == 0 ? 0.1 : 0.7) * p.y + 0.3 * static_cast<double>(random() % 64) / 64;
        p = {place, 2 * place, -place};
      }
      if (!ask(mesh, {scheme}, "line, " + std::string(name_of(scheme)))) return;
    }
  }
  std::cout << "  " << counts.hits << " hits, " << counts.misses << " misses, " << counts.unsure
            << " unsure\n";
  EXPECT_GT(counts.hits, 4000u);
  EXPECT_GT(counts.misses, 2000u);
}

}  // namespace
}  // namespace snug::ray_test
