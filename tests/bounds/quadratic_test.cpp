// Quadratic triangles are as near their patches as they say, parameter by parameter.

#include <snug/bounds/quadratic.h>

#include <gtest/gtest.h>
#include <oracle/loop_twin.h>
#include <oracle/polygon_twin.h>
#include <snug/bounds/bounding_points.h>
#include <snug/bvh/obb.h>
#include <snug/patch/evaluate.h>
#include <support/scaling.h>
#include <testing/containment.h>
#include <testing/counts.h>
#include <testing/disguises.h>
#include <testing/patches.h>
#include <testing/scheme_surfaces.h>

#include <algorithm>
#include <map>
#include <set>

namespace snug::quadratic_test {
namespace {

using testing::Extended;

Extended point_of(const QuadraticTriangle& q, long double u, long double v) {
  const long double w = 1 - u - v;
  const std::array<long double, 6> weights{w * w, u * u, v * v, 2 * w * u, 2 * u * v, 2 * v * w};
  Extended sum{};
  for (std::size_t k = 0; k < 6; ++k) {
    const Point3& p = k < 3 ? q.corners[k] : q.middles[k - 3];
    for (std::size_t a = 0; a < 3; ++a) sum[a] += weights[k] * p[a];
  }
  return sum;
}

// Between a limit point that is known to `known`, a coordinate, and the quadratic at its parameter.
bool within_error(const QuadraticTriangle& q, long double u, long double v, const Point3& limit,
                  double known) {
  const Extended at = point_of(q, u, v);
  long double sq = 0, size = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    sq += (at[a] - limit[a]) * (at[a] - limit[a]);
    size += std::fabs(at[a]);
  }
  // Along the normal, and along some other directions.
  const auto along = [&](const Vector3& w) {
    long double sum = 0;
    for (std::size_t a = 0; a < 3; ++a) sum += w[a] * (at[a] - limit[a]);
    return std::fabs(sum);
  };
  const long double doubt = 1.8L * known + 1e-18L * size + 1e-160L;
  bool near = std::sqrt(sq) <= q.error + doubt && along(q.normal) <= q.normal_error + doubt;
  for (const Vector3& w : {Vector3{1, 0, 0}, Vector3{0.6, 0, -0.8}, q.normal,
                           cross(q.normal, Vector3{0, 0.8, 0.6}), 0.6 * q.normal + Vector3{0, 0, 0.8}}) {
    near = near && along(w) <= error_along(w, q.normal, q.error, q.normal_error) + doubt;
  }
  return near;
}

class Quadratics {
 public:
  explicit Quadratics(const LimitSurface& surface) : surface_(surface) {}
  const QuadraticTriangle& operator[](PatchId p) {
    const auto [it, fresh] = made_.try_emplace(p.index());
    if (fresh) it->second = quadratic_triangle(surface_.library(), surface_.patch(p));
    return it->second;
  }
  // A sample in mesh units.
  bool near(PatchId p, TriangleParameter at, const oracle::Point& limit, double known) {
    const PowerOfTwo scale = surface_.scale();
    return within_error((*this)[p], at.u, at.v, scale.apply(Point3{limit[0], limit[1], limit[2]}),
                        scale.apply(known) + 0x1p-1000);
  }

 private:
  const LimitSurface& surface_;
  std::map<std::size_t, QuadraticTriangle> made_;
};

std::size_t check(const testing::TaggedCase& c, int levels, const std::shared_ptr<BoundsCache>& library) {
  const LimitSurface surface(testing::control_mesh(c.mesh, c.rules), testing::options_of(c.rules), library);
  Quadratics quadratics(surface);
  const bool loop = surface.options().scheme == Scheme::loop;
  const std::vector<oracle::FaceSample> samples = oracle::sample_faces(c.mesh, c.rules, levels);
  for (const oracle::FaceSample& s : samples) {
    for (unsigned half = 0; half < (loop ? 1u : 2u); ++half) {
      if (!loop && (half == 0 ? s.v > s.u : s.u > s.v)) continue;
      const TriangleParameter at = loop        ? TriangleParameter{s.u, s.v}
                                   : half == 0 ? TriangleParameter{s.u - s.v, s.v}
                                               : TriangleParameter{s.v - s.u, 1 - s.v};
      const PatchId patch(surface.patches_of(s.face).begin + (loop ? 0 : 2 * s.part + half));
      EXPECT_TRUE(quadratics.near(patch, at, s.position, s.error))
          << c.name << ", " << testing::text_of(c.rules) << ", face " << s.face << "." << s.part << " at "
          << s.u << ", " << s.v;
    }
    if (::testing::Test::HasFailure()) break;
  }
  return samples.size();
}

TEST(quadratic_triangle, is_as_near_as_it_says_to_limit_points_of_every_kind) {
  std::size_t samples = 0;
  for (const auto scheme : {oracle::PrimalScheme::catmull_clark, oracle::PrimalScheme::loop}) {
    const auto library = std::make_shared<BoundsCache>();
    for (const testing::TaggedCase& c : testing::tagged_cases(scheme, 81)) {
      samples += check(c, 3, library);
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(samples, 50'000u);
}

TEST(quadratic_triangle, is_as_near_as_it_says_for_disguised_meshes) {
  for (const auto scheme : {oracle::PrimalScheme::catmull_clark, oracle::PrimalScheme::loop}) {
    const auto library = std::make_shared<BoundsCache>();
    const std::vector<testing::TaggedCase> cases = testing::tagged_cases(scheme, 82);
    const std::vector<testing::Disguise> disguises = testing::disguises();
    for (std::size_t i = 0; i < 3 * disguises.size(); ++i) {
      testing::TaggedCase c = cases[(7 * i) % cases.size()];
      const testing::Disguise& disguise = disguises[i % disguises.size()];
      c.name += ", " + disguise.name;
      for (oracle::Point& p : c.mesh.points) p = disguise.change(p);
      check(c, 2, library);
      if (HasFailure()) return;
    }
  }
}

// A grid with a crease through it, of any sharpness: all of it shaken, or flat on one side and far from that beyond the crease.
enum class Crease : std::uint8_t { straight, bent, chaikin, beside_a_plane };
testing::TaggedCase creased_grid(oracle::PrimalScheme scheme, double sharpness, Crease sort,
                                 std::uint64_t seed) {
  const bool bend = sort == Crease::bent, chaikin = sort == Crease::chaikin;
  constexpr std::uint32_t n = 5;
  std::mt19937_64 random(seed);
  oracle::TaggedMesh grid = oracle::meshes::quad_grid(n, n);
  if (scheme == oracle::PrimalScheme::loop) grid = oracle::meshes::triangulated(grid);
  oracle::TaggedMesh mesh = oracle::meshes::shaken(grid, sort == Crease::beside_a_plane ? 0 : 0.8, random);
  if (sort == Crease::beside_a_plane) {
    for (std::size_t v = 0; v < mesh.points.size(); ++v) mesh.points[v][2] = v > 3 * n + 2 ? 1.0 : 0;
  }
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t row = 2, at = row * (n + 1) + k;
    if (bend && k >= 3) {
      mesh.creases.push_back({(row + k - 3) * (n + 1) + 3, (row + k - 2) * (n + 1) + 3, sharpness});
    } else {
      mesh.creases.push_back({at, at + 1, chaikin ? sharpness + 0.3 * k : sharpness});
    }
  }
  return {"sharpness " + std::to_string(sharpness) + (bend ? ", bent" : ""),
          mesh,
          {.scheme = scheme, .chaikin = chaikin}};
}

TEST(quadratic_triangle, is_as_near_as_it_says_beside_creases_of_any_sharpness) {
  std::size_t samples = 0, on_lattices = 0, light = 0;
  const std::vector<testing::Disguise> disguises = testing::disguises();
  for (const auto scheme : {oracle::PrimalScheme::catmull_clark, oracle::PrimalScheme::loop}) {
    const auto library = std::make_shared<BoundsCache>();
    std::uint64_t seed = 84;
    for (const double sharpness : {0.3, 1.0, 1.6, 2.5, 4.0, 6.2}) {
      for (const Crease sort : {Crease::straight, Crease::bent, Crease::chaikin, Crease::beside_a_plane}) {
        testing::TaggedCase c = creased_grid(scheme, sharpness, sort, ++seed);
        samples += check(c, 4, library);
        const testing::Disguise& disguise = disguises[seed % disguises.size()];
        c.name += ", " + disguise.name;
        for (oracle::Point& p : c.mesh.points) p = disguise.change(p);
        check(c, 2, library);
        if (HasFailure()) return;
        const LimitSurface surface(testing::control_mesh(c.mesh, c.rules), testing::options_of(c.rules),
                                   library);
        for (std::size_t p = 0; p < surface.patch_count(); ++p) {
          if (!surface.has_patch(PatchId(p))) continue;
          const Kind& kind = *surface.patch(PatchId(p)).kind;
          if (!kind.transient() || !has_quadratic_rows(kind)) continue;
          const QuadraticRows& rows = library->quadratic_rows(kind);
          on_lattices += !rows.layout().empty();
          light +=
              std::any_of(rows.largest().begin(), rows.largest().end(), [](double w) { return w < 0.02; });
        }
      }
    }
  }
  EXPECT_GT(samples, 20'000u);
  EXPECT_GT(on_lattices, 300u);
  EXPECT_GT(light, 100u);
}

// A lattice with one control point off its plane: the patch is that point's basis function.
TEST(quadratic_rows, bound_every_basis_function_of_a_lattice) {
  std::size_t kinds = 0, others = 0, light = 0;
  for (const auto scheme : {oracle::PrimalScheme::catmull_clark, oracle::PrimalScheme::loop}) {
    const auto library = std::make_shared<BoundsCache>();
    std::set<const Kind*> met;
    for (std::size_t draw = 0; draw < 24; ++draw) {
      const double sharpness = std::array{0.3, 1.0, 1.6, 2.5, 4.0, 6.2}[draw % 6];
      const testing::TaggedCase c = creased_grid(scheme, sharpness, static_cast<Crease>(draw / 6), 86);
      const LimitSurface surface(testing::control_mesh(c.mesh, c.rules), testing::options_of(c.rules),
                                 library);
      for (std::size_t p = 0; p < surface.patch_count(); ++p) {
        Patch patch = surface.patch(PatchId(p));
        const Kind& kind = *patch.kind;
        if (!kind.transient() || !met.insert(&kind).second) continue;
        const QuadraticRows& rows = library->quadratic_rows(kind);
        if (rows.layout().empty()) {
          ++others;
          continue;
        }
        ++kinds;
        patch.first = 0;
        patch.origin = {};
        patch.error = 0;
        patch.largest = 4;
        for (std::size_t i = 0; i < patch.points.size(); ++i) {
          for (std::size_t k = 0; k < patch.points.size(); ++k) {
            patch.points[k] = {rows.layout()[k][0], rows.layout()[k][1], k == i ? 1.0 : 0.0};
          }
          const std::array<Vector3, 6> plane{
              {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0, 0}, {0.5, 0.5, 0}, {0, 0.5, 0}}};
          const Apart bound = rows.distance(kind, patch, plane, {0, 0, 1});
          double most = 0;
          for (int v = 0; v <= 32; ++v) {
            for (int u = 0; u + v <= 32; ++u) {
              const Vector3 limit = limit_point(patch, {u / 32.0, v / 32.0}).from({}).position - Point3{};
              EXPECT_NEAR(limit.x, u / 32.0, 1e-12);
              EXPECT_NEAR(limit.y, v / 32.0, 1e-12);
              most = std::max(most, std::fabs(limit.z));
            }
          }
          EXPECT_GE(bound.along, most) << sharpness << ' ' << i;
          EXPECT_GE(bound.any, most) << sharpness << ' ' << i;
          EXPECT_LE(bound.any, 1 + 1e-9);
          light += bound.any < 0.03 && most > 0.25 * bound.any;
        }
      }
    }
  }
  EXPECT_GT(kinds, 20u);
  EXPECT_GT(others, 20u);
  EXPECT_GT(light, 20u);
}

// What is of use changes how far an error is followed, and no more: pieces of every scheme and tag, and beside creases.
TEST(quadratic_triangle, is_as_near_as_it_says_for_who_asks_for_less) {
  std::size_t finite = 0, useless = 0, looser = 0;
  const auto check_piece = [&](BoundsCache& library, const Patch& patch) {
    const QuadraticTriangle known = quadratic_triangle(library, patch);
    if (!(known.error > 0 && known.error < INFINITY)) return;
    for (const double share : {0.1, 0.7, 1.2, 16.0}) {
      const ErrorUse use{.sufficient = share * known.error / 4, .useless = share * known.error};
      const QuadraticTriangle q = quadratic_triangle(library, patch, use);
      if (share > 1.1) {
        EXPECT_LT(q.error, INFINITY);
      }
      if (q.error == INFINITY) {
        ++useless;
        continue;
      }
      ++finite;
      looser += q.error > known.error;
      EXPECT_LE(q.error, use.useless * (1 + 1e-12) + 1e-15);
      for (int j = 0; j <= 6; ++j) {
        for (int i = 0; i + j <= 6; ++i) {
          const BoundedPoint limit = limit_point(patch, {i / 6.0, j / 6.0}).from(patch.origin);
          EXPECT_TRUE(within_error(q, i / 6.0L, j / 6.0L, limit.position, limit.error));
        }
      }
    }
  };
  std::mt19937_64 random(85);
  const auto check_pieces = [&](const LimitSurface& surface, std::size_t p) {
    if (!surface.has_patch(PatchId(p))) return;
    Patch patch = surface.patch(PatchId(p));
    for (unsigned level = 0; level < 3; ++level, patch = split(patch, static_cast<unsigned>(random() % 4))) {
      check_piece(surface.library(), patch);
    }
  };
  testing::for_each_surface(85, [&](const testing::NamedSurface& named) {
    for (int trial = 0; trial < 2; ++trial)
      check_pieces(named.surface, random() % named.surface.patch_count());
  });
  for (const auto scheme : {oracle::PrimalScheme::catmull_clark, oracle::PrimalScheme::loop}) {
    const testing::TaggedCase c = creased_grid(scheme, 2.6, Crease::bent, 85);
    const LimitSurface surface(testing::control_mesh(c.mesh, c.rules), testing::options_of(c.rules),
                               std::make_shared<BoundsCache>());
    for (std::size_t p = 0; p < surface.patch_count(); ++p) check_pieces(surface, p);
  }
  EXPECT_GT(finite, 1000u);
  EXPECT_GT(useless, 500u);
  EXPECT_GT(looser, 50u);
}

// Limit points ever closer to a corner, and pieces there: levels of nets are left at a tip.
TEST(quadratic_triangle, is_as_near_as_it_says_down_to_extraordinary_corners) {
  for (const std::uint32_t n : {3u, 4u, 5u, 7u, 8u, 12u, 50u, 200u}) {
    std::mt19937_64 random(n);
    const oracle::TwinMesh twin = oracle::meshes::disturbed(oracle::meshes::bipyramid(n), 2, 0.2, random);
    const LimitSurface surface = testing::surface_of(twin);
    Quadratics quadratics(surface);
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      for (const oracle::LimitSample& s : oracle::sample_near_corner(twin, 0, corner, 50)) {
        EXPECT_TRUE(quadratics.near(PatchId(s.face), {s.u, s.v}, s.position, s.error))
            << n << ", " << s.u << ", " << s.v;
      }
    }
  }
}

struct Compared {
  double error, sampled;
};

Compared compare(BoundsCache& library, const Patch& patch, int steps) {
  const QuadraticTriangle q = quadratic_triangle(library, patch);
  Compared result{q.error, 0};
  for (int j = 0; j <= steps; ++j) {
    for (int i = 0; i + j <= steps; ++i) {
      const double u = static_cast<double>(i) / steps, v = static_cast<double>(j) / steps;
      const BoundedPoint limit = limit_point(patch, {u, v}).from(patch.origin);
      EXPECT_TRUE(within_error(q, u, v, limit.position, limit.error)) << u << ", " << v;
      const Extended at = point_of(q, u, v);
      const Vector3 apart = limit.position - Point3{static_cast<double>(at[0]), static_cast<double>(at[1]),
                                                    static_cast<double>(at[2])};
      result.sampled = std::max(result.sampled, length(apart));
    }
  }
  return result;
}

// Pieces have their corners turned, and kinds that whole patches may not have.
TEST(quadratic_triangle, of_pieces_is_as_near_as_it_says) {
  std::mt19937_64 random(83);
  testing::for_each_surface(83, [&](const testing::NamedSurface& named) {
    for (int trial = 0; trial < 6; ++trial) {
      const PatchId p(random() % named.surface.patch_count());
      if (!named.surface.has_patch(p)) continue;
      Patch patch = named.surface.patch(p);
      for (int level = 0; level < 3; ++level) {
        compare(named.surface.library(), patch, 8);
        patch = split(patch, static_cast<unsigned>(random() % 4));
      }
    }
  });
}

TEST(quadratic_triangle, has_an_error_of_the_size_of_the_distance) {
  for (const oracle::TwinMesh& twin : testing::assorted_meshes(84)) {
    const LimitSurface surface = testing::surface_of(twin);
    std::vector<double> ratios;
    for (std::size_t p = 0; p < surface.patch_count(); ++p) {
      if (!surface.has_patch(PatchId(p))) continue;
      const Compared c = compare(surface.library(), surface.patch(PatchId(p)), 16);
      ratios.push_back(c.error / c.sampled);
    }
    std::nth_element(ratios.begin(), ratios.begin() + ratios.size() / 2, ratios.end());
    EXPECT_LT(ratios[ratios.size() / 2], 1.5);
  }
}

// Of patches with extraordinary corners it is made of those of their quarters.
TEST(quadratic_triangle, is_nearer_than_one_through_limit_points) {
  std::mt19937_64 random(87);
  std::vector<double> ratios;
  testing::for_each_surface(87, [&](const testing::NamedSurface& named) {
    for (int trial = 0; trial < 6; ++trial) {
      const PatchId p(random() % named.surface.patch_count());
      if (!named.surface.has_patch(p)) continue;
      const Patch patch = named.surface.patch(p);
      if (patch.kind->polynomial() || patch.kind->transient() || !has_quadratic_rows(*patch.kind)) continue;
      const auto at = [&](double u, double v) { return limit_point(patch, {u, v}).relative; };
      const std::array<Vector3, 3> c{at(0, 0), at(1, 0), at(0, 1)};
      const std::array<Vector3, 3> m{2.0 * at(0.5, 0) - 0.5 * (c[0] + c[1]),
                                     2.0 * at(0.5, 0.5) - 0.5 * (c[1] + c[2]),
                                     2.0 * at(0, 0.5) - 0.5 * (c[2] + c[0])};
      double through = 0;
      for (int j = 0; j <= 16; ++j) {
        for (int i = 0; i + j <= 16; ++i) {
          const double u = i / 16.0, v = j / 16.0, w = 1 - u - v;
          const Vector3 q = w * w * c[0] + u * u * c[1] + v * v * c[2] + 2 * w * u * m[0] + 2 * u * v * m[1] +
                            2 * v * w * m[2];
          through = std::max(through, length(at(u, v) - q));
        }
      }
      if (through < 1e-12) continue;
      ratios.push_back(compare(named.surface.library(), patch, 16).sampled / through);
      EXPECT_LT(ratios.back(), 1.5) << named.name;
    }
  });
  ASSERT_GT(ratios.size(), testing::fewer(300));
  std::nth_element(ratios.begin(), ratios.begin() + ratios.size() / 2, ratios.end());
  EXPECT_LT(ratios[ratios.size() / 2], 1);
}

// Next to a corner that comes again the layout is all there is: patches less their linear interpolation.
TEST(quadratic_rows, bound_a_piece_at_a_corner_by_its_layout_closely) {
  std::mt19937_64 random(86);
  std::size_t compared = 0;
  testing::for_each_surface(86, [&](const testing::NamedSurface& named) {
    BoundsCache& library = named.surface.library();
    for (int trial = 0; trial < 4; ++trial) {
      const PatchId p(random() % named.surface.patch_count());
      if (!named.surface.has_patch(p)) continue;
      for (unsigned corner = 0; corner < 3; ++corner) {
        Patch patch = named.surface.patch(p);
        for (int level = 0; level < 12; ++level) patch = split(patch, corner);
        const Kind& kind = *patch.kind;
        if (!kind.cacheable() || kind.polynomial()) continue;
        patch.first = 0;
        const auto limits = limit_corners(patch);
        std::array<Vector3, 6> linear{limits[0], limits[1], limits[2]};
        for (std::size_t k = 0; k < 3; ++k) linear[3 + k] = 0.5 * (linear[k] + linear[(k + 1) % 3]);
        const double distance = library.quadratic_rows(kind).distance(kind, patch, linear, {}).any;
        double sampled = 0;
        for (int j = 0; j <= 16; ++j) {
          for (int i = 0; i + j <= 16; ++i) {
            const RelativePoint at = limit_point(patch, {i / 16.0, j / 16.0});
            const Vector3 on_plane =
                ((16 - i - j) / 16.0) * linear[0] + (i / 16.0) * linear[1] + (j / 16.0) * linear[2];
            sampled = std::max(sampled, length(at.relative - on_plane));
          }
        }
        EXPECT_LE(sampled, distance * (1 + 1e-9) + 1e-15) << named.name << ", " << corner;
        bool smooth = kind.key().plain();
        for (std::size_t k = 0; k < 3; ++k) smooth = smooth && kind.corner(k).closed && !kind.corner(k).sharp;
        if (!smooth || sampled < 1e-13) continue;
        ++compared;
        EXPECT_LT(distance, 8 * sampled) << named.name << ", " << corner;
      }
    }
  });
  EXPECT_GT(compared, testing::fewer(300));
}

TEST(quadratic_triangle, is_exact_for_bilinear_faces) {
  std::mt19937_64 random(85);
  for (const auto& mesh : {oracle::meshes::quad_grid(3, 2), oracle::meshes::mixed_strip()}) {
    const LimitSurface surface(testing::control_mesh(oracle::meshes::shaken(mesh, 0.3, random)),
                               {Scheme::bilinear}, std::make_shared<BoundsCache>());
    for (std::size_t p = 0; p < surface.patch_count(); ++p) {
      if (!surface.has_patch(PatchId(p))) continue;
      EXPECT_LT(compare(surface.library(), surface.patch(PatchId(p)), 8).error, 1e-13);
    }
  }
}

// Triangles with corners on the surface and off it. A corner taken for another one makes bounds too large: those
// of patches whose kind begins with another corner are tight, too.
TEST(distance_to_triangle, bounds_dense_samples_of_every_kind) {
  std::mt19937_64 random(86);
  std::vector<double> turned;  // bound over sampled distance
  testing::for_each_surface(87, [&](const testing::NamedSurface& named) {
    testing::for_each_patch(named.surface, [&](PatchId p) {
      const Patch patch = named.surface.patch(p);
      if (p.index() % 5 != 0 && patch.first == 0) return;
      const std::array<Vector3, 3> limits = limit_corners(patch);
      Triangle triangle;
      for (std::size_t k = 0; k < 3; ++k) {
        triangle[k] =
            patch.origin + limits[k] + (0.1 * static_cast<double>(random() % 2)) * limits[(k + 1) % 3];
      }
      BoundingPoints hull;
      if (patch.kind->cacheable()) bounding_points(named.surface.library(), patch, hull);
      const double bound = distance_to_triangle(named.surface.library(), patch, hull, triangle);
      double sampled = 0;
      for (int i = 0; i <= 8; ++i) {
        for (int j = 0; i + j <= 8; ++j) {
          const double u = i / 8.0, v = j / 8.0;
          const RelativePoint limit = limit_point(patch, {u, v});
          const Point3 flat =
              triangle[0] + (u * (triangle[1] - triangle[0]) + v * (triangle[2] - triangle[0]));
          const double found = distance(patch.origin + limit.relative, flat);
          EXPECT_LE(found, bound + 2 * limit.error + 1e-14) << named.name << ", patch " << p.index();
          sampled = std::max(sampled, found);
        }
      }
      if (patch.first != 0 && sampled > 1e-6) turned.push_back(bound / sampled);
    });
  });
  std::sort(turned.begin(), turned.end());
  ASSERT_GT(turned.size(), testing::fewer(50));
  EXPECT_LE(turned[turned.size() / 2], 1.3);
  EXPECT_LE(turned[turned.size() * 9 / 10], 2);
}

TEST(quadratic_triangle, of_points_that_are_not_finite_has_an_infinite_error) {
  for (const std::uint32_t n : {5u, 6u}) {
    const LimitSurface surface = testing::surface_of(oracle::meshes::bipyramid(n));
    for (const double bad : {double{NAN}, double{INFINITY}}) {
      Patch patch = surface.patch(PatchId(0));
      for (std::size_t i = 0; i < patch.points.size(); ++i) {
        Patch broken = patch;
        broken.points[i].y = bad;
        EXPECT_EQ(quadratic_triangle(surface.library(), broken).error, INFINITY);
      }
    }
  }
}

}  // namespace
}  // namespace snug::quadratic_test
