// No limit point outside what tables give, for all schemes: against the twins' quadruple precision.

#include <gtest/gtest.h>
#include <oracle/dual_twin.h>
#include <oracle/polygon_twin.h>
#include <oracle/tagged_shapes.h>
#include <snug/bound.h>
#include <snug/search/surface_data.h>
#include <testing/containment.h>
#include <testing/disguises.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <tuple>

namespace snug::tables_test {
namespace {

namespace meshes = oracle::meshes;

ControlMesh control_mesh(const oracle::TaggedMesh& twin, const oracle::Rules& rules) {
  ControlMesh mesh;
  for (const oracle::Point& p : twin.points) mesh.points.push_back({p[0], p[1], p[2]});
  for (const auto& polygon : twin.polygons) {
    std::vector<VertexId> corners;
    for (const std::uint32_t v : polygon) corners.push_back(VertexId(v));
    mesh.add_face(corners);
  }
  for (const auto& c : twin.creases) mesh.tags.creases.push_back({VertexId(c.a), VertexId(c.b), c.sharpness});
  for (const auto& c : twin.corners) mesh.tags.corners.push_back({VertexId(c.vertex), c.sharpness});
  mesh.tags.crease_method = rules.chaikin ? CreaseMethod::chaikin : CreaseMethod::uniform;
  mesh.tags.smooth_triangles = rules.smooth_triangles ? SmoothTriangles::smooth : SmoothTriangles::catmark;
  return mesh;
}

BoundaryRule boundary_of(const oracle::Rules& rules) {
  switch (rules.boundary) {
    case oracle::Boundary::none:
      return BoundaryRule::none;
    case oracle::Boundary::edge_only:
      return BoundaryRule::edge_only;
    case oracle::Boundary::edge_and_corner:
      break;
  }
  return BoundaryRule::edge_and_corner;
}

// The piece of `level` digits that contains a parameter of a triangle.
std::string piece_at(double u, double v, unsigned level) {
  std::string digits;
  for (unsigned i = 0; i < level; ++i) {
    if (u >= 0.5) {
      digits += '1', u = 2 * u - 1, v = 2 * v;
    } else if (v >= 0.5) {
      digits += '2', u = 2 * u, v = 2 * v - 1;
    } else if (u + v <= 0.5) {
      digits += '0', u = 2 * u, v = 2 * v;
    } else {
      digits += '3', u = 1 - 2 * u, v = 1 - 2 * v;
    }
  }
  return digits;
}

bool contains(const PatchEnclosure& piece, const oracle::Point& position, double error) {
  const testing::Extended p{position[0], position[1], position[2]};
  const long double size = std::fabs(p[0]) + std::fabs(p[1]) + std::fabs(p[2]);
  const long double slack = 1.8L * error + 1e-17L * piece.offset.radius + 1e-18L * size;
  return testing::within_radius(p, piece.offset.base, piece.offset.radius + slack) &&
         testing::in_interval_triangle(p, piece.interval, slack);
}

using Pieces = std::map<std::tuple<std::uint32_t, std::size_t, std::string>, PatchEnclosure>;

Pieces pieces_of(const Surface& surface, unsigned level) {
  Pieces pieces;
  bound(surface, {.level = level},
        [&](const PatchEnclosure& e) {
          pieces[{e.patch.owner, e.patch.part, e.piece}] = e;
        },
        {.threads = 1});
  return pieces;
}

Surface tabled(ControlMesh mesh, Scheme scheme, BoundaryRule boundary = BoundaryRule::edge_and_corner) {
  return Surface(std::move(mesh), {.scheme = scheme, .boundary = boundary, .bounds = BoundMethod::table},
                 {.threads = 1});
}

// As they are; far away and tiny; flat; snapped to a grid, so that much is exactly on the sides of boxes;
// spiked.
std::vector<testing::Disguise> disguises() {
  return testing::disguises(
      {"plain", "tiny and far", "flat and tilted", "snapped to a coarse grid", "huge and spiked"});
}

struct Case {
  std::string name;
  oracle::TaggedMesh mesh;
  oracle::Rules rules{};
};

void crease_cube(oracle::TaggedMesh& cube) {
  cube.creases = {{0, 1, 2.3}, {1, 3, 0.4}, {4, 5, 10}, {5, 7, 10}, {0, 4, 1}};
  cube.corners = {{6, 1.5}, {3, 10}};
}

std::vector<Case> primal_cases() {
  std::mt19937_64 random(61);
  std::vector<Case> cases;
  oracle::TaggedMesh cube = meshes::cube();
  crease_cube(cube);
  cases.push_back({"creased cube", meshes::shaken(cube, 0.2, random)});
  cases.push_back({"chaikin cube", meshes::shaken(cube, 0.2, random), {.chaikin = true}});
  cases.push_back({"creased Loop cube",
                   meshes::triangulated(meshes::shaken(cube, 0.2, random)),
                   {.scheme = oracle::PrimalScheme::loop}});
  for (const std::uint32_t n : {3u, 5u, 7u, 12u}) {
    cases.push_back({"prism " + std::to_string(n), meshes::shaken(meshes::prism(n), 0.1, random)});
    cases.push_back({"pyramid " + std::to_string(n), meshes::shaken(meshes::pyramid(n), 0.1, random)});
    // All quads: one pole of valence n, the rest of 3 and 4.
    cases.push_back({"quads of pyramid " + std::to_string(n),
                     oracle::refine(meshes::shaken(meshes::pyramid(n), 0.1, random), {}, 1)});
  }
  cases.push_back(
      {"smooth triangles", meshes::shaken(meshes::pyramid(5), 0.1, random), {.smooth_triangles = true}});
  for (const auto rule :
       {oracle::Boundary::edge_and_corner, oracle::Boundary::edge_only, oracle::Boundary::none}) {
    cases.push_back({"grid", meshes::shaken(meshes::quad_grid(4, 3), 0.3, random), {.boundary = rule}});
    cases.push_back({"mixed strip", meshes::shaken(meshes::mixed_strip(), 0.1, random), {.boundary = rule}});
  }
  cases.push_back({"book", meshes::shaken(meshes::book(3), 0.1, random)});
  cases.push_back({"valence two", meshes::shaken(meshes::valence_two_inside(), 0.1, random)});
  return cases;
}

// Which patch of the owner's, and where on its triangle: surface/limit_surface.h says how quads are halved.
struct OnTriangle {
  std::size_t part;
  double u, v;
};
OnTriangle on_triangle(const oracle::FaceSample& s, bool quad) {
  if (!quad) return {s.part, s.u, s.v};
  return s.v <= s.u ? OnTriangle{2 * s.part, s.u - s.v, s.v} : OnTriangle{2 * s.part + 1, s.v - s.u, 1 - s.v};
}

TEST(tables, contain_limit_points_of_faces) {
  std::size_t checked = 0;
  for (const Case& plain : primal_cases()) {
    for (const testing::Disguise& disguise : disguises()) {
      oracle::TaggedMesh twin = plain.mesh;
      for (oracle::Point& p : twin.points) p = disguise.change(p);
      const bool loop = plain.rules.scheme == oracle::PrimalScheme::loop;
      const Surface surface = tabled(control_mesh(twin, plain.rules), loop ? Scheme::loop : Scheme::catmark,
                                     boundary_of(plain.rules));
      const LimitSurface& limit = surface.data()->limit();
      const auto samples = oracle::sample_faces(twin, plain.rules, 4);
      ASSERT_TRUE(!samples.empty() || plain.rules.boundary == oracle::Boundary::none) << plain.name;
      for (const unsigned level : {0u, 2u}) {
        const Pieces pieces = pieces_of(surface, level);
        for (const oracle::FaceSample& s : samples) {
          const OnTriangle at = on_triangle(s, !loop);
          const PatchId patch(limit.patches_of(s.face).begin + at.part);
          // The first split of a polygon is a level of its own.
          const unsigned digits = level - (level > 0 && limit.after_first_split(patch) ? 1 : 0);
          const auto it = pieces.find({s.face, at.part, piece_at(at.u, at.v, digits)});
          ASSERT_NE(it, pieces.end()) << plain.name;
          ASSERT_TRUE(contains(it->second, s.position, s.error))
              << plain.name << ", level " << level << ", face " << s.face << " part " << s.part << " at "
              << s.u << ", " << s.v;
          ++checked;
        }
      }
    }
  }
  std::cout << checked << " limit points\n";
  EXPECT_GT(checked, 100'000u);
}

// A sample is on the patches of several vertices; each has a piece that holds it.
TEST(tables, contain_limit_points_of_dual_schemes) {
  std::mt19937_64 random(62);
  std::vector<Case> cases{{"cube", meshes::shaken(meshes::cube(), 0.2, random)},
                          {"grid", meshes::shaken(meshes::quad_grid(5, 5), 0.3, random)}};
  for (const std::uint32_t n : {3u, 5u, 6u, 9u, 12u}) {
    cases.push_back({"prism " + std::to_string(n), meshes::shaken(meshes::prism(n), 0.1, random)});
    cases.push_back({"pyramid " + std::to_string(n), meshes::shaken(meshes::pyramid(n), 0.1, random)});
  }
  std::size_t checked = 0;
  for (const Case& plain : cases) {
    for (const testing::Disguise& disguise : disguises()) {
      oracle::TaggedMesh twin = plain.mesh;
      for (oracle::Point& p : twin.points) p = disguise.change(p);
      for (const bool midedge : {false, true}) {
        const Surface surface = tabled(control_mesh(twin, {}), midedge ? Scheme::midedge : Scheme::doo_sabin);
        const auto samples = oracle::sample_dual(
            twin, midedge ? oracle::DualScheme::midedge : oracle::DualScheme::doo_sabin, 3);
        ASSERT_FALSE(samples.empty()) << plain.name;
        for (const unsigned level : {0u, 2u}) {
          const Pieces pieces = pieces_of(surface, level);
          for (const oracle::DualSample& s : samples) {
            for (const std::uint32_t owner : s.owners) {
              if (!surface.has({owner, 0, 0.25, 0.25})) continue;
              const auto first = pieces.lower_bound({owner, 0, {}}),
                         last = pieces.lower_bound({owner + 1, 0, {}});
              ASSERT_TRUE(std::any_of(first, last,
                                      [&](const auto& p) { return contains(p.second, s.position, s.error); }))
                  << plain.name << (midedge ? ", midedge" : ", doo-sabin") << ", level " << level
                  << ", vertex " << owner;
              ++checked;
            }
          }
        }
      }
    }
  }
  std::cout << checked << " limit points\n";
  EXPECT_GT(checked, 100'000u);
}

// Patch bounds take another way to the same tables.
TEST(tables, give_patch_bounds_that_contain_limit_points) {
  std::size_t checked = 0;
  for (const Case& c : primal_cases()) {
    for (const testing::Disguise& disguise : disguises()) {
      oracle::TaggedMesh twin = c.mesh;
      for (oracle::Point& p : twin.points) p = disguise.change(p);
      const bool loop = c.rules.scheme == oracle::PrimalScheme::loop;
      const ControlMesh mesh = control_mesh(twin, c.rules);
      PatchBounds bounds(tabled(mesh, loop ? Scheme::loop : Scheme::catmark, boundary_of(c.rules)),
                         {.threads = 1});
      std::vector<OffsetTriangle> found(bounds.patches().size());
      bounds.update(mesh.points, found);
      std::map<std::pair<std::uint32_t, std::size_t>, OffsetTriangle> of_patch;
      for (std::size_t i = 0; i < found.size(); ++i) {
        of_patch[{bounds.patches()[i].owner, bounds.patches()[i].part}] = found[i];
      }
      for (const oracle::FaceSample& s : oracle::sample_faces(twin, c.rules, 3)) {
        const auto it = of_patch.find({s.face, on_triangle(s, !loop).part});
        ASSERT_NE(it, of_patch.end());
        const testing::Extended p{s.position[0], s.position[1], s.position[2]};
        const long double size = std::fabs(p[0]) + std::fabs(p[1]) + std::fabs(p[2]);
        ASSERT_TRUE(testing::within_radius(p, it->second.base,
                                           it->second.radius * (1 + 1e-17L) + 1.8L * s.error + 1e-18L * size))
            << c.name;
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 30'000u);
}

}  // namespace
}  // namespace snug::tables_test
