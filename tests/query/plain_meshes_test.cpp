// Meshes that are taken as they are: triangles of the flat scheme against exact arithmetic on whole numbers,
// bilinear quads against sampling and against Catmull-Clark with everything infinitely sharp.

#include <gtest/gtest.h>
#include <oracle/dual_twin.h>
#include <oracle/hull_twin.h>
#include <oracle/polygon_twin.h>
#include <oracle/polyhedron_twin.h>
#include <oracle/tagged_shapes.h>
#include <oracle/test_meshes.h>
#include <snug/distance.h>
#include <snug/evaluate.h>
#include <snug/search/surface_data.h>
#include <support/error.h>
#include <testing/counts.h>
#include <testing/exact_triangles.h>
#include <testing/pieces.h>
#include <testing/tagged.h>
#include <testing/twins.h>

#include <iostream>
#include <random>

#include "testing/verdict_only.h"

namespace snug::plain_meshes_test {
namespace {

using testing::ExactPoint;
using testing::ExactTriangle;

ExactPoint random_point(std::mt19937_64& random, std::int64_t extent = 60) {
  std::uniform_int_distribution<std::int64_t> coordinate(-extent, extent);
  return {coordinate(random), coordinate(random), coordinate(random)};
}

// Triangles with area: each with corners of its own, or over a few points that many of them share.
struct Soup {
  std::vector<ExactPoint> points;
  std::vector<std::array<std::uint32_t, 3>> faces;

  Soup(std::mt19937_64& random, std::size_t count, bool shared, std::int64_t extent = 60) {
    const std::size_t all = shared ? 4 + count / 3 : 3 * count;
    while (points.size() < all) points.push_back(random_point(random, extent));
    for (std::uint32_t f = 0; f < count; ++f) {
      const auto corner = [&](std::uint32_t k) {
        return shared ? static_cast<std::uint32_t>(random() % all) : 3 * f + k;
      };
      const std::array face{corner(0), corner(1), corner(2)};
      if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) continue;
      faces.push_back(face);
      if (!testing::has_area(triangle(faces.size() - 1))) faces.pop_back();
    }
  }
  [[nodiscard]] ExactTriangle triangle(std::size_t f, const ExactPoint& moved = {}) const {
    ExactTriangle t;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t x = 0; x < 3; ++x) t[k][x] = points[faces[f][k]][x] + moved[x];
    }
    return t;
  }
  [[nodiscard]] ControlMesh mesh() const {
    ControlMesh mesh;
    for (const auto& [x, y, z] : points) {
      mesh.points.push_back({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
    }
    for (const auto& [a, b, c] : faces) mesh.add_face(std::array{VertexId(a), VertexId(b), VertexId(c)});
    return mesh;
  }
};

// Intersections of all pairs of triangles.
struct Truth {
  bool meet = false, pierce = false;
  long double distance = INFINITY;
};
Truth truth_of(const Soup& a, const Soup& b, const ExactPoint& moved) {
  Truth truth;
  for (std::size_t i = 0; i < a.faces.size(); ++i) {
    for (std::size_t j = 0; j < b.faces.size(); ++j) {
      const ExactTriangle s = a.triangle(i), t = b.triangle(j, moved);
      truth.pierce = truth.pierce || testing::pierce(s, t);
      truth.meet = truth.meet || testing::have_common_point(s, t);
      if (!truth.meet) truth.distance = std::min(truth.distance, testing::distance(s, t));
    }
  }
  return truth;
}

Motion moved_by(const ExactPoint& by) {
  return Motion::translation(
      {static_cast<double>(by[0]), static_cast<double>(by[1]), static_cast<double>(by[2])});
}

TEST(flat, distances_and_verdicts_are_those_of_the_triangles) {
  std::mt19937_64 random(12);
  std::size_t met = 0, pierced = 0, proved = 0, apart = 0;
  for (int trial = 0; trial < static_cast<int>(testing::fewer(4000)) && !HasFailure(); ++trial) {
    const auto some = [&] { return std::size_t{1} + random() % (trial % 3 == 0 ? 1 : 9); };
    const std::int64_t extent = trial % 2 == 0 ? 60 : 3;  // on a small lattice many touch
    const Soup a(random, some(), trial % 8 >= 4, extent), b(random, some(), trial % 16 >= 12, extent);
    if (a.faces.empty() || b.faces.empty()) continue;
    const ExactPoint by = trial % 5 == 0 ? ExactPoint{} : random_point(random, extent);
    const Truth truth = truth_of(a, b, by);
    const Surface one(a.mesh(), {.scheme = Scheme::flat}), other(b.mesh(), {.scheme = Scheme::flat});
    CollideOptions strict = testing::verdict_only(), tolerant = strict;
    tolerant.tolerance = 1e-9;
    const Verdict verdict = collide(one, other.at(moved_by(by)), strict).verdict;
    const Verdict near = collide(one, other.at(moved_by(by)), tolerant).verdict;
    DistanceOptions precision;
    precision.relative = 1e-9;
    precision.absolute = 1e-9;
    const Distance found = distance(one, other.at(moved_by(by)), precision);
    EXPECT_EQ(found.outcome, Outcome::complete) << trial;
    if (truth.meet) {
      ++met;
      pierced += truth.pierce;
      proved += truth.pierce && verdict == Verdict::intersecting;
      EXPECT_NE(verdict, Verdict::separated) << trial;
      EXPECT_TRUE(near == Verdict::within || near == Verdict::intersecting) << trial << name_of(near);
      EXPECT_EQ(found.distance.lower, 0) << trial;
      EXPECT_LE(found.distance.upper, 1e-9) << trial;
    } else {
      ++apart;
      EXPECT_EQ(verdict, Verdict::separated) << trial << ' ' << truth.distance;
      EXPECT_EQ(near, Verdict::separated) << trial;
      const long double slack = 1e-17L * truth.distance;
      EXPECT_LE(found.distance.lower, truth.distance + slack) << trial;
      EXPECT_GE(found.distance.upper, truth.distance - slack) << trial;
    }
  }
  std::cout << "  " << apart << " apart, " << met << " meet, " << pierced
            << " with an edge through a triangle, " << proved << " of these proved\n";
  EXPECT_GT(apart, testing::fewer(500));
  EXPECT_GT(met - pierced, testing::fewer(50));
  EXPECT_GT(20 * proved, 19 * pierced);
}

TEST(flat, closest_points_are_those_of_the_triangles) {
  std::mt19937_64 random(13);
  for (int trial = 0; trial < 300 && !HasFailure(); ++trial) {
    const Soup soup(random, 1 + random() % 12, trial % 2 == 1);
    if (soup.faces.empty()) continue;
    std::vector<oracle::Point> points;
    for (const ExactPoint& p : soup.points) {
      points.push_back({static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
    }
    std::vector<oracle::Triangle> triangles;
    for (const auto& [a, b, c] : soup.faces) triangles.push_back({a, b, c});
    const oracle::PolyhedronTwin twin(points, triangles);
    const Surface body(soup.mesh(), {.scheme = Scheme::flat});
    for (int k = 0; k < 20; ++k) {
      const ExactPoint at = random_point(random);
      const Point3 q{static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])};
      // However little is asked for, all is told that doubles hold.
      const double asked = k % 2 == 0 ? 1e-12 : 100;
      const ClosestPoint found = closest_point(body, q, {.absolute = asked, .relative = asked});
      const mpq_class square = twin.squared_distance({q.x, q.y, q.z});
      EXPECT_EQ(found.outcome, Outcome::complete);
      EXPECT_LE(found.distance.upper - found.distance.lower, 0x1p-45 * 60) << trial;
      EXPECT_LE(distance(found.point, q), found.distance.upper * (1 + 1e-15)) << trial;
      EXPECT_LE(distance(evaluate(body, *found.at).point, q), found.distance.upper + 1e-13) << trial;
      EXPECT_LE(mpq_class(found.distance.lower) * mpq_class(found.distance.lower), square) << trial;
      EXPECT_GE(mpq_class(found.distance.upper) * mpq_class(found.distance.upper), square) << trial;
    }
  }
}

// Of bodies with saddles, spikes and flat corners: signs by the normal of the facet that is named are right, also where corners and
// edges are nearest.
TEST(flat, the_facet_that_is_named_has_the_point_on_its_own_side) {
  std::mt19937_64 random(31);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
  int bodies = 0, corners = 0, asked = 0;
  for (int trial = 0; trial < 120 && !HasFailure(); ++trial) {
    oracle::TwinMesh mesh = trial % 3 == 0   ? oracle::meshes::octahedron()
                            : trial % 3 == 1 ? oracle::meshes::bipyramid(3 + trial % 7)
                                             : oracle::meshes::icosahedron();
    if (trial % 2 == 0) mesh = oracle::meshes::quartered(mesh);
    mesh = oracle::meshes::disturbed(mesh, trial % 5, 0.1 * (trial % 6), random);
    if (!oracle::HullTwin(mesh.points, mesh.triangles).contacts().empty()) continue;
    ++bodies;
    const oracle::PolyhedronTwin twin(mesh.points, mesh.triangles);
    const Surface body(testing::control_mesh(mesh), {.scheme = Scheme::flat});
    for (int k = 0; k < 40; ++k) {
      const auto& near = mesh.points[random() % mesh.points.size()];
      const double by = std::ldexp(1.0, -static_cast<int>(random() % 12));
      const oracle::Point at{near[0] + by * unit(), near[1] + by * unit(), near[2] + by * unit()};
      const ClosestPoint found = closest_point(body, {at[0], at[1], at[2]});
      const std::optional<int> winding = twin.winding(at);
      if (!winding || found.distance.lower < 1e-9) continue;
      const auto& face = mesh.triangles[found.at->owner];
      const auto corner = [&](std::size_t i) {
        return Point3{mesh.points[face[i]][0], mesh.points[face[i]][1], mesh.points[face[i]][2]};
      };
      const Vector3 normal = cross(corner(1) - corner(0), corner(2) - corner(0));
      const double side = dot(normal, Point3{at[0], at[1], at[2]} - corner(0));
      EXPECT_EQ(side > 0, *winding == 0) << trial << ' ' << k;
      ++asked;
      corners += found.at->u + found.at->v == 0 || found.at->u == 1 || found.at->v == 1;
    }
  }
  std::cout << "  " << bodies << " bodies, " << asked << " points, " << corners << " nearest to corners\n";
  EXPECT_GT(bodies, 60);
  EXPECT_GT(corners, asked / 20);
}

// Rings, boundaries and sharpness are nothing to it.
TEST(flat, has_one_kind_whose_bounds_are_rounding_alone) {
  for (auto [name, shape] : testing::plain_shapes()) {
    oracle::TaggedMesh mesh = oracle::meshes::triangulated(shape);
    const auto& first = mesh.polygons[0];
    mesh.creases = {{first[0], first[1], 2.5}, {first[1], first[2], 10}};
    mesh.corners = {{first[2], 1.5}};
    const Surface facets(testing::control_mesh(mesh), {.scheme = Scheme::flat});
    const LimitSurface& surface = facets.data()->limit();
    EXPECT_EQ(surface.kind_count(), 1u) << name;
    EXPECT_EQ(limit_to_faces(facets), 0.0) << name;
    testing::Pieces pieces(surface);
    for (std::size_t f = 0; f < surface.patch_count(); ++f) {
      const testing::KnownPiece known = pieces.root(PatchId(f));
      EXPECT_LE(known.piece.offset.radius, 0x1p-40) << name;
      EXPECT_LE(known.heights.upper - known.heights.lower, 0x1p-40) << name;
      EXPECT_FALSE(known.piece.can_split()) << name;
      const auto face = surface.topology().face(FaceId(f));
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_LE(distance(surface.scale().inverse().apply(known.piece.offset.base[k]),
                           surface.mesh().points[face[k].index()]),
                  1e-14);
      }
    }
  }
}

TEST(flat, refuses_other_faces_and_says_which_scheme_takes_them) {
  try {
    const Surface surface(testing::control_mesh(oracle::meshes::cube()), {.scheme = Scheme::flat});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "face 0 has 4 vertices (6 faces are not triangles); the scheme flat needs triangles: triangulate the "
        "mesh, or use the scheme bilinear");
  }
}

// In exact arithmetic: corners are whole numbers, parameters halves of halves.
TEST(bilinear, points_are_those_of_the_quads) {
  std::mt19937_64 random(14);
  for (const std::size_t size : {4, 3, 5, 6, 7}) {
    std::vector<ExactPoint> corners;
    ControlMesh mesh;
    std::vector<VertexId> face;
    for (std::size_t k = 0; k < size; ++k) {
      const auto [x, y, z] = corners.emplace_back(random_point(random));
      face.emplace_back(k);
      mesh.points.push_back({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
    }
    mesh.add_face(face);
    const Surface surface(mesh, {.scheme = Scheme::bilinear});
    EXPECT_EQ(surface.kind_count(), 1u);
    for (std::uint32_t corner = 0; corner < (size == 4 ? 1 : size); ++corner) {
      // The quad at this corner, by its vertices' coordinates times 2 size.
      std::array<std::array<mpq_class, 3>, 4> quad;
      for (std::size_t x = 0; x < 3; ++x) {
        const auto at = [&](std::size_t k) {
          return mpq_class(static_cast<double>(corners[(corner + k) % size][x]));
        };
        if (size == 4) {
          for (std::size_t k = 0; k < 4; ++k) quad[k][x] = at(k);
          continue;
        }
        mpq_class sum = 0;
        for (std::size_t k = 0; k < size; ++k) sum += at(k);
        quad[0][x] = at(0);
        quad[1][x] = (at(0) + at(1)) / 2;
        quad[2][x] = sum / static_cast<unsigned>(size);
        quad[3][x] = (at(0) + at(size - 1)) / 2;
      }
      for (int i = 0; i < 40; ++i) {
        const double u = static_cast<double>(random() % 65) / 64, v = static_cast<double>(random() % 65) / 64;
        const SurfacePoint point = evaluate(surface, {0, corner, u, v});
        const mpq_class exact_u(u), exact_v(v);
        for (std::size_t x = 0; x < 3; ++x) {
          const mpq_class below = quad[0][x] + exact_u * (quad[1][x] - quad[0][x]),
                          above = quad[3][x] + exact_u * (quad[2][x] - quad[3][x]),
                          exact = below + exact_v * (above - below);
          const double off = std::fabs(mpq_class(exact - mpq_class(point.point[x])).get_d());
          EXPECT_LE(off, point.error) << size << ' ' << corner << ' ' << u << ' ' << v;
          EXPECT_LE(point.error, 1e-11);
          const mpq_class along =
              (quad[1][x] - quad[0][x]) * (1 - exact_v) + (quad[2][x] - quad[3][x]) * exact_v;
          EXPECT_NEAR(along.get_d(), point.tangents[0][x], 1e-10);
        }
      }
    }
  }
}

// A quad with nothing but sharp corners and edges has the bilinear patch as its limit under Catmull-Clark,
// too.
TEST(bilinear, distances_are_those_of_catmark_with_sharp_edges) {
  std::mt19937_64 random(15);
  std::size_t meet = 0;
  for (int trial = 0; trial < 150 && !HasFailure(); ++trial) {
    ControlMesh bilinear[2], sharp[2];
    for (std::size_t s = 0; s < 2; ++s) {
      for (std::uint32_t k = 0; k < 8; ++k) {
        const auto [x, y, z] = random_point(random);
        bilinear[s].points.push_back({static_cast<double>(x) + (s == 0 ? 0 : trial % 90),
                                      static_cast<double>(y), static_cast<double>(z)});
      }
      for (const std::uint32_t f : {0u, 4u}) {
        bilinear[s].add_face(std::array{VertexId(f), VertexId(f + 1), VertexId(f + 2), VertexId(f + 3)});
      }
      sharp[s] = bilinear[s];
      for (std::uint32_t k = 0; k < 8; ++k) {
        sharp[s].tags.creases.push_back({VertexId(k), VertexId(k / 4 * 4 + (k + 1) % 4), 10});
        sharp[s].tags.corners.push_back({VertexId(k), 10});
      }
    }
    DistanceOptions precision;
    precision.absolute = 1e-6;
    Distance found[2];
    Verdict verdicts[2];
    for (const bool use_sharp : {false, true}) {
      const SurfaceOptions options{.scheme = use_sharp ? Scheme::catmark : Scheme::bilinear};
      const Surface a(use_sharp ? sharp[0] : bilinear[0], options),
          b(use_sharp ? sharp[1] : bilinear[1], options);
      found[use_sharp] = distance(a, b, precision);
      CollideOptions wanted = testing::verdict_only();
      wanted.tolerance = 1e-6;
      verdicts[use_sharp] = collide(a, b, wanted).verdict;
    }
    const bool apart = verdicts[0] == Verdict::separated;
    meet += !apart;
    EXPECT_EQ(apart, verdicts[1] == Verdict::separated) << trial;
    EXPECT_LE(found[0].distance.lower, found[1].distance.upper * (1 + 1e-12)) << trial;
    EXPECT_LE(found[1].distance.lower, found[0].distance.upper * (1 + 1e-12)) << trial;
  }
  EXPECT_GT(meet, 20u);
  EXPECT_LT(meet, 130u);
}

// A surface whose limit the twin samples, and how far off a sample may be.
struct Sampled {
  std::string name;
  oracle::TaggedMesh mesh;
  Scheme scheme;
  std::vector<oracle::Point> samples;
  double error = 0;
};

double length_of(const oracle::Point& a, const oracle::Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

std::vector<Sampled> sampled_surfaces(std::mt19937_64& random) {
  namespace meshes = oracle::meshes;
  constexpr int levels = 4;
  std::vector<Sampled> list;
  for (const auto& [name, shape] :
       std::vector<std::pair<std::string, oracle::TaggedMesh>>{{"cube", meshes::cube()},
                                                               {"prism 5", meshes::prism(5)},
                                                               {"pyramid 7", meshes::pyramid(7)},
                                                               {"open strip", meshes::mixed_strip()}}) {
    for (const Scheme scheme : {Scheme::loop, Scheme::catmark, Scheme::doo_sabin, Scheme::midedge}) {
      Sampled s{name + ", " + name_of(scheme), meshes::shaken(shape, 0.3, random), scheme, {}};
      if (scheme == Scheme::loop) s.mesh = meshes::triangulated(s.mesh);
      for (oracle::Point& p : s.mesh.points) {
        for (double& x : p) x *= 30;
      }
      const bool primal = scheme == Scheme::loop || scheme == Scheme::catmark;
      if (primal) s.mesh.creases = {{s.mesh.polygons[0][0], s.mesh.polygons[0][1], 2.5}};
      const auto add = [&](const auto& samples) {
        for (const auto& sample : samples) {
          s.samples.push_back(sample.position);
          s.error = std::max(s.error, 2 * sample.error);
        }
      };
      if (primal) {
        oracle::Rules rules;
        rules.scheme =
            scheme == Scheme::loop ? oracle::PrimalScheme::loop : oracle::PrimalScheme::catmull_clark;
        add(oracle::sample_faces(s.mesh, rules, levels));
      } else {
        add(oracle::sample_dual(
            s.mesh, scheme == Scheme::midedge ? oracle::DualScheme::midedge : oracle::DualScheme::doo_sabin,
            levels));
      }
      if (!s.samples.empty()) list.push_back(std::move(s));
    }
  }
  return list;
}

ControlMesh scaled(ControlMesh mesh, double factor) {
  for (Point3& p : mesh.points) p = {factor * p.x, factor * p.y, factor * p.z};
  return mesh;
}

// The same limit surface by another scheme: every edge and corner infinitely sharp.
ControlMesh with_sharp_edges(ControlMesh mesh) {
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(FaceId(f));
    for (std::size_t k = 0; k < face.size(); ++k) {
      mesh.tags.creases.push_back({face[k], face[(k + 1) % face.size()], 10});
      mesh.tags.corners.push_back({face[k], 10});
    }
  }
  return mesh;
}

// Plain meshes, whose pieces are never split, beside surfaces of every scheme and beside each other.
TEST(plain_meshes, are_as_far_from_surfaces_of_every_scheme_as_their_samples_say) {
  std::mt19937_64 random(16);
  const std::vector<Sampled> others = sampled_surfaces(random);
  std::size_t apart = 0, meet = 0;
  for (int trial = 0; trial < static_cast<int>(testing::fewer(256)) && !HasFailure(); ++trial) {
    const Sampled& other = others[static_cast<std::size_t>(trial) % others.size()];
    const Scheme plain = trial / others.size() % 2 == 0 ? Scheme::flat : Scheme::bilinear;
    const double factor = std::array{1.0, 0x1p-400, 0x1p300}[random() % 3];
    ControlMesh faces;
    std::vector<oracle::Point> points;
    const std::size_t corners = plain == Scheme::flat ? 3 : 4;
    const ExactPoint centre = random_point(random, 45);
    for (std::uint32_t k = 0; k < 3 * corners; ++k) {
      ExactPoint p = random_point(random, 25);
      for (std::size_t x = 0; x < 3; ++x) p[x] += centre[x];
      points.push_back({static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
      faces.points.push_back({points.back()[0], points.back()[1], points.back()[2]});
    }
    for (std::uint32_t f = 0; f < 3; ++f) {
      std::vector<VertexId> face;
      for (std::uint32_t k = 0; k < corners; ++k) face.emplace_back(f * corners + k);
      faces.add_face(face);
    }
    const std::string where = other.name + ", " + name_of(plain) + ", trial " + std::to_string(trial);
    const Surface a(scaled(faces, factor), {.scheme = plain}),
        sharp(scaled(with_sharp_edges(faces), factor),
              {.scheme = plain == Scheme::flat ? Scheme::loop : Scheme::catmark}),
        b(scaled(testing::control_mesh(other.mesh), factor), {.scheme = other.scheme});
    const DistanceOptions precision{.absolute = 1e-4 * factor};
    const Distance found = distance(a, b, precision), same = distance(sharp, b, precision);
    EXPECT_EQ(found.outcome, Outcome::complete) << where;
    EXPECT_LE(found.distance.lower, same.distance.upper * (1 + 1e-12)) << where;
    EXPECT_LE(same.distance.lower, found.distance.upper * (1 + 1e-12)) << where;
    const Verdict verdict = collide(a, b, testing::verdict_only()).verdict;
    (verdict == Verdict::separated ? apart : meet) += 1;
    EXPECT_EQ(verdict == Verdict::separated, found.distance.lower > 0) << where;
    // Against samples: those of the other surface, and triangles or a lattice on the bilinear patches.
    std::vector<oracle::Point> lattice;
    if (plain == Scheme::bilinear) {
      for (std::size_t f = 0; f < 3; ++f) {
        for (int i = 0; i <= 8; ++i) {
          for (int j = 0; j <= 8; ++j) {
            const double u = i / 8.0, v = j / 8.0;
            oracle::Point p;
            for (std::size_t x = 0; x < 3; ++x) {
              p[x] = (1 - v) * ((1 - u) * points[4 * f][x] + u * points[4 * f + 1][x]) +
                     v * ((1 - u) * points[4 * f + 3][x] + u * points[4 * f + 2][x]);
            }
            lattice.push_back(p);
          }
        }
      }
    }
    const oracle::PolyhedronTwin triangles(
        points, plain == Scheme::flat ? std::vector<oracle::Triangle>{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}}
                                      : std::vector<oracle::Triangle>{});
    double least = INFINITY;
    const std::size_t step = 1 + other.samples.size() / 200;
    for (std::size_t i = random() % step; i < other.samples.size(); i += step) {
      const oracle::Point& q = other.samples[i];
      if (plain == Scheme::flat) {
        least = std::min(least, std::sqrt(triangles.squared_distance(q).get_d()));
      } else {
        for (const oracle::Point& p : lattice) least = std::min(least, length_of(p, q));
      }
    }
    EXPECT_LE(found.distance.lower / factor, least * (1 + 1e-14) + other.error + 1e-12) << where;
  }
  std::cout << "  " << apart << " apart, " << meet << " not\n";
  EXPECT_GT(apart, testing::fewer(50));
  EXPECT_GT(meet, testing::fewer(20));
}

// The two plain schemes beside each other, against Loop and Catmull-Clark with everything sharp.
TEST(plain_meshes, of_both_schemes_are_as_far_apart_as_their_sharp_twins) {
  std::mt19937_64 random(17);
  std::size_t apart = 0, meet = 0;
  for (int trial = 0; trial < 200 && !HasFailure(); ++trial) {
    ControlMesh triangle, quad;
    const auto point = [&](double by) {
      const auto [x, y, z] = random_point(random);
      return Point3{static_cast<double>(x) + by, static_cast<double>(y), static_cast<double>(z)};
    };
    for (int k = 0; k < 3; ++k) triangle.points.push_back(point(0));
    for (int k = 0; k < 4; ++k) quad.points.push_back(point(trial % 90));
    triangle.add_face(std::array{VertexId(0), VertexId(1), VertexId(2)});
    quad.add_face(std::array{VertexId(0), VertexId(1), VertexId(2), VertexId(3)});
    const Surface a(triangle, {.scheme = Scheme::flat}), b(quad, {.scheme = Scheme::bilinear}),
        sharp_a(with_sharp_edges(triangle), {.scheme = Scheme::loop}),
        sharp_b(with_sharp_edges(quad), {.scheme = Scheme::catmark});
    const DistanceOptions precision{.absolute = 1e-6};
    const Distance found = distance(a, b, precision), same = distance(sharp_a, sharp_b, precision);
    EXPECT_EQ(found.outcome, Outcome::complete);
    EXPECT_LE(found.distance.lower, same.distance.upper * (1 + 1e-12)) << trial;
    EXPECT_LE(same.distance.lower, found.distance.upper * (1 + 1e-12)) << trial;
    const bool separated = collide(a, b, testing::verdict_only()).verdict == Verdict::separated;
    EXPECT_EQ(separated, found.distance.lower > 0) << trial;
    (separated ? apart : meet) += 1;
  }
  EXPECT_GT(apart, 50u);
  EXPECT_GT(meet, 20u);
}

}  // namespace
}  // namespace snug::plain_meshes_test
