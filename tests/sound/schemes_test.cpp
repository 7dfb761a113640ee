// The promise for Catmull-Clark, creases, boundaries, non-manifold places and the dual schemes: no limit
// point of the twins outside its enclosures, and evaluation within its error.

#include <snug/bound.h>
#include <snug/evaluate.h>
#include <snug/search/surface_data.h>

#include <gtest/gtest.h>
#include <oracle/dual_twin.h>
#include <oracle/polygon_twin.h>
#include <testing/containment.h>
#include <testing/disguises.h>
#include <testing/surfaces.h>
#include <testing/tagged.h>

#include <algorithm>
#include <iostream>
#include <map>
#include <set>

namespace snug::schemes_test {
namespace {

struct Sample {
  oracle::Point position;
  double error;
};

// Results of bound() for one patch, by path.
using Pieces = std::map<std::string, PatchEnclosure>;

bool contains(const PatchEnclosure& piece, const Sample& s, const char*& what) {
  const testing::Extended p{s.position[0], s.position[1], s.position[2]};
  const long double size = std::fabs(p[0]) + std::fabs(p[1]) + std::fabs(p[2]);
  // Extended precision adds 1e-18 of what it works on.
  const long double slack = 1.8L * s.error + 1e-17L * piece.offset.radius + 1e-18L * size;
  what = "offset triangle";
  if (!testing::within_radius(p, piece.offset.base, piece.offset.radius + slack)) return false;
  what = "interval triangle";
  return testing::in_interval_triangle(p, piece.interval, slack);
}

std::vector<BoundOptions> bound_options(const Surface& surface) {
  std::vector<BoundOptions> list(3);
  list[1].level = 2;
  list[2].error = surface.size() > 0 ? 0.2 * surface.size() : 1;
  return list;
}

std::vector<Pieces> pieces_of(const Surface& surface, const BoundOptions& options) {
  const LimitSurface& limit = surface.data()->limit();
  std::vector<Pieces> pieces(limit.patch_count());
  bound(surface, options,
        [&](const PatchEnclosure& e) {
          pieces[limit.patches_of(e.patch.owner).begin + e.patch.part][e.piece] = e;
        },
        {.threads = 1});
  return pieces;
}

// The piece that holds a parameter of the patch.
const PatchEnclosure* find_piece(const Pieces& pieces, double u, double v) {
  std::string path;
  for (int level = 0; level < 60; ++level) {
    if (const auto it = pieces.find(path); it != pieces.end()) return &it->second;
    if (u >= 0.5) {
      path += '1', u = 2 * u - 1, v = 2 * v;
    } else if (v >= 0.5) {
      path += '2', u = 2 * u, v = 2 * v - 1;
    } else if (u + v <= 0.5) {
      path += '0', u = 2 * u, v = 2 * v;
    } else {
      path += '3', u = 1 - 2 * u, v = 1 - 2 * v;
    }
  }
  return nullptr;
}

// Coordinates of a half quad, from those of the quad.
TriangleParameter in_half(double u, double v, unsigned half) {
  return half == 0 ? TriangleParameter{u - v, v} : TriangleParameter{v - u, 1 - v};
}

struct Counted {
  std::size_t samples = 0, checks = 0, patches = 0;
  double worst_error = 0;  // of evaluation, over the size of the mesh
};

// Each sample on each patch that it is on: inside the piece that holds its parameter, and where evaluation
// says.
void check_primal(const testing::TaggedCase& c, int levels, Counted& counted) {
  const std::string name = c.name + ", " + testing::text_of(c.rules);
  const Surface surface =
      testing::public_surface(testing::control_mesh(c.mesh), testing::options_of(c.rules));
  const LimitSurface& limit = surface.data()->limit();
  const bool loop = surface.scheme() == Scheme::loop;
  const std::vector<oracle::FaceSample> samples = oracle::sample_faces(c.mesh, c.rules, levels);
  std::set<std::uint32_t> with_samples;
  for (const oracle::FaceSample& s : samples) with_samples.insert(s.face);
  for (std::size_t p = 0; p < limit.patch_count(); ++p) {
    EXPECT_EQ(limit.has_patch(PatchId(p)), with_samples.contains(limit.place(PatchId(p)).owner))
        << name << ", patch " << p;
    counted.patches += limit.has_patch(PatchId(p));
  }
  if (::testing::Test::HasFailure()) return;
  std::vector<std::vector<Pieces>> pieces;
  for (const BoundOptions& options : bound_options(surface)) pieces.push_back(pieces_of(surface, options));
  for (const oracle::FaceSample& s : samples) {
    ++counted.samples;
    const std::string where = name + ", face " + std::to_string(s.face) + "." + std::to_string(s.part) +
                              " at " + std::to_string(s.u) + ", " + std::to_string(s.v);
    const Place at{s.face, s.part, s.u, s.v};
    ASSERT_TRUE(surface.has(at)) << where;
    const SurfacePoint point = evaluate(surface, at);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_LE(std::fabs(point.point[k] - s.position[k]), point.error + s.error) << where;
    }
    counted.worst_error = std::max(counted.worst_error, point.error / surface.size());
    for (unsigned half = 0; half < (loop ? 1u : 2u); ++half) {
      if (!loop && (half == 0 ? s.v > s.u : s.u > s.v)) continue;
      const TriangleParameter t = loop ? TriangleParameter{s.u, s.v} : in_half(s.u, s.v, half);
      const std::size_t patch = limit.patches_of(s.face).begin + (loop ? 0 : 2 * s.part + half);
      for (std::size_t i = 0; i < pieces.size(); ++i) {
        const PatchEnclosure* piece = find_piece(pieces[i][patch], t.u, t.v);
        ASSERT_TRUE(piece) << where;
        const char* what = "";
        ++counted.checks;
        EXPECT_TRUE(contains(*piece, {s.position, s.error}, what))
            << "outside the " << what << " " << i << ": " << where;
      }
    }
    if (::testing::Test::HasFailure()) return;
  }
}

void print(const char* name, const Counted& counted) {
  std::cout << name << ": " << counted.patches << " patches, " << counted.samples << " limit points, "
            << counted.checks << " checks; evaluation within " << counted.worst_error << " of the size\n";
}

TEST(catmark, limit_points_lie_inside_their_enclosures) {
  Counted counted;
  for (const testing::TaggedCase& c : testing::tagged_cases(oracle::PrimalScheme::catmull_clark, 71)) {
    check_primal(c, 4, counted);
    if (HasFailure()) FAIL() << c.name << ", " << testing::text_of(c.rules);
  }
  print("catmark", counted);
  EXPECT_GT(counted.samples, 100'000u);
}

TEST(loop_with_tags, limit_points_lie_inside_their_enclosures) {
  Counted counted;
  for (const testing::TaggedCase& c : testing::tagged_cases(oracle::PrimalScheme::loop, 72)) {
    check_primal(c, 4, counted);
    if (HasFailure()) FAIL() << c.name << ", " << testing::text_of(c.rules);
  }
  print("loop", counted);
  EXPECT_GT(counted.samples, 100'000u);
}

// Scales to the ends of the doubles, offsets that leave few digits, flat and needle shapes, for the same
// kinds.
TEST(catmark, limit_points_of_disguised_meshes_lie_inside_their_enclosures) {
  const std::vector<testing::Disguise> disguises =
      testing::disguises({"tiny", "huge", "far", "flat and tilted", "needle", "line", "spiked"});
  Counted counted;
  const std::vector<testing::TaggedCase> cases =
      testing::tagged_cases(oracle::PrimalScheme::catmull_clark, 73);
  for (std::size_t i = 0; i < cases.size(); i += 7) {
    for (const auto& [name, change] : disguises) {
      testing::TaggedCase c = cases[i];
      c.name += ", " + name;
      for (oracle::Point& p : c.mesh.points) p = change(p);
      check_primal(c, 2, counted);
      if (HasFailure()) FAIL() << c.name << ", " << testing::text_of(c.rules);
    }
  }
  print("disguised catmark", counted);
}

// Many faces between creases or boundaries: kinds that have no rows of their own.
TEST(high_valence_corners, limit_points_lie_inside_their_enclosures) {
  Counted counted;
  std::mt19937_64 random(74);
  for (const oracle::PrimalScheme scheme :
       {oracle::PrimalScheme::catmull_clark, oracle::PrimalScheme::loop}) {
    const auto check = [&](std::string name, oracle::TaggedMesh mesh) {
      if (scheme == oracle::PrimalScheme::loop) mesh = oracle::meshes::triangulated(mesh);
      oracle::Rules rules;
      rules.scheme = scheme;
      check_primal({std::move(name), oracle::meshes::shaken(mesh, 0.1, random), rules}, 3, counted);
    };
    check("open", oracle::meshes::pole(19, true));
    oracle::TaggedMesh mesh = oracle::meshes::pole(18, false);
    mesh.creases = {{0, 1, 10}};
    check("dart", mesh);
    check("smooth, of very many", oracle::meshes::pole(70, false));
    mesh = oracle::meshes::pole(36, false);
    check("smooth", mesh);
    mesh.creases = {{0, 1, 10}, {0, 37, 10}};
    check("crease", mesh);
    mesh.creases = {{0, 1, 10}, {0, 37, 10}, {0, 39, 1.5}};
    check("crease, and an edge that will be smooth", mesh);
    mesh.creases = {{0, 1, 10}, {0, 3, 10}, {0, 37, 10}};
    check("corner", mesh);
    if (HasFailure()) return;
  }
  print("high-valence corners", counted);
}

// Samples of a dual scheme name their patch, no parameter: each lies in one of the pieces; and the grid of
// parameters meets the samples of the patch, all of them.
void check_dual(const std::string& name, const oracle::TaggedMesh& mesh, Scheme scheme, int levels,
                Counted& counted) {
  const Surface surface(testing::control_mesh(mesh), {.scheme = scheme});
  const LimitSurface& limit = surface.data()->limit();
  const auto twin = scheme == Scheme::doo_sabin ? oracle::DualScheme::doo_sabin : oracle::DualScheme::midedge;
  std::vector<std::vector<Sample>> samples(surface.owner_count());
  for (const oracle::DualSample& s : oracle::sample_dual(mesh, twin, levels)) {
    for (const std::uint32_t owner : s.owners) samples[owner].push_back({s.position, s.error});
  }
  std::vector<std::vector<Pieces>> pieces;
  for (const BoundOptions& options : bound_options(surface)) pieces.push_back(pieces_of(surface, options));
  for (std::uint32_t owner = 0; owner < surface.owner_count(); ++owner) {
    const auto [begin, end] = limit.patches_of(owner);
    const bool there = begin < end && limit.has_patch(PatchId(begin));
    if (!there) continue;  // samples of its neighbours' patches may name it
    counted.patches += end - begin;
    const std::string where = name + ", " + name_of(scheme) + ", vertex " + std::to_string(owner);
    ASSERT_FALSE(samples[owner].empty()) << where;
    for (const Sample& s : samples[owner]) {
      ++counted.samples;
      for (std::size_t i = 0; i < pieces.size(); ++i) {
        ++counted.checks;
        bool found[2]{};
        for (std::size_t p = begin; p < end; ++p) {
          for (const auto& [path, piece] : pieces[i][p]) {
            if (found[0] && found[1]) break;
            const char* what = "";
            const bool inside = contains(piece, s, what);
            found[0] = found[0] || inside || std::string(what) == "interval triangle";
            PatchEnclosure wide = piece;
            wide.offset.radius += 4 * surface.size();
            found[1] = found[1] || contains(wide, s, what);
          }
        }
        EXPECT_TRUE(found[0] && found[1]) << where << ", enclosures " << i;
      }
    }
    const int steps = 1 << (end - begin == 2 ? levels : levels - 1);
    std::vector<bool> met(samples[owner].size(), false);
    for (std::uint32_t corner = 0; corner < (end - begin == 2 ? 1 : (end - begin) / 2); ++corner) {
      for (int j = 0; j <= steps; ++j) {
        for (int i = 0; i <= steps; ++i) {
          const SurfacePoint point = evaluate(
              surface, {owner, corner, static_cast<double>(i) / steps, static_cast<double>(j) / steps});
          counted.worst_error = std::max(counted.worst_error, point.error / surface.size());
          bool any = false;
          for (std::size_t s = 0; s < met.size(); ++s) {
            const Sample& sample = samples[owner][s];
            bool near = true;
            for (std::size_t k = 0; k < 3; ++k) {
              near = near && std::fabs(point.point[k] - sample.position[k]) <= point.error + sample.error;
            }
            if (near) met[s] = any = true;
          }
          EXPECT_TRUE(any) << where << "." << corner << " at " << i << ", " << j << " of " << steps;
        }
      }
    }
    EXPECT_EQ(std::count(met.begin(), met.end(), false), 0) << where;
    if (::testing::Test::HasFailure()) return;
  }
}

TEST(dual_schemes, limit_points_lie_inside_their_enclosures_and_evaluation_meets_them) {
  namespace meshes = oracle::meshes;
  std::mt19937_64 random(74);
  for (const Scheme scheme : {Scheme::doo_sabin, Scheme::midedge}) {
    Counted counted;
    const std::vector<std::pair<std::string, oracle::TaggedMesh>> list{
        {"cube", meshes::cube()},
        {"grid", meshes::quad_grid(5, 4)},
        {"prism 3", meshes::prism(3)},
        {"prism 5", meshes::prism(5)},
        {"pyramid 4", meshes::pyramid(4)},
        {"pyramid 7", meshes::pyramid(7)},
        {"pyramid 24", meshes::pyramid(24)},
        {"mixed strip", meshes::mixed_strip()},
        {"triangles", meshes::triangulated(meshes::quad_grid(4, 4))},
        {"prism of triangles", meshes::triangulated(meshes::prism(6))}};
    for (const auto& [name, plain] : list) {
      check_dual(name, meshes::shaken(plain, 0.3, random), scheme, 3, counted);
      if (HasFailure()) FAIL() << name;
    }
    print(name_of(scheme), counted);
  }
}

}  // namespace
}  // namespace snug::schemes_test
