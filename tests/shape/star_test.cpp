// Stars of pieces: smooth ones are injective, folded and doubled ones are never said to be.

#include <snug/shape/corner_asymptotics.h>
#include <snug/shape/star.h>

#include <gtest/gtest.h>
#include <oracle/tagged_shapes.h>
#include <snug/patch/evaluate.h>
#include <snug/surface/level_complex.h>
#include <support/direction.h>
#include <testing/counts.h>
#include <testing/tagged.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <set>

namespace snug::star_test {
namespace {

// A disc of triangles around vertex 0, two rings of them, lifted by `height(x, y)`; the inner ring's angles
// are multiplied by `turns`.
oracle::TaggedMesh disc(std::uint32_t n, double turns, const std::function<double(double, double)>& height) {
  oracle::TaggedMesh mesh;
  mesh.points.push_back({0, 0, height(0, 0)});
  for (std::uint32_t ring = 1; ring <= 3; ++ring) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const double angle = turns * 2 * std::numbers::pi * i / n;
      const double x = ring * std::cos(angle), y = ring * std::sin(angle);
      mesh.points.push_back({x, y, height(x, y)});
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t k = (i + 1) % n;
    mesh.polygons.push_back({0, 1 + i, 1 + k});
    for (std::uint32_t ring = 0; ring < 2; ++ring) {
      const std::uint32_t a = 1 + ring * n;
      mesh.polygons.push_back({a + i, a + n + i, a + n + k});
      mesh.polygons.push_back({a + i, a + n + k, a + k});
    }
  }
  return mesh;
}

std::vector<Patch> patches_of(const LimitSurface& surface, const LevelStar& star) {
  std::vector<Patch> patches;
  for (const auto& sector : star.sectors) {
    patches.push_back(surface.patch(sector.piece.patch));
    const PiecePath& path = sector.piece.path;
    for (unsigned k = 0; k < path.level(); ++k) patches.back() = split(patches.back(), path.digit(k));
  }
  return patches;
}

// The star of vertex 0 of a surface after some levels.
struct CentreStar {
  std::vector<Patch> patches;
  std::vector<StarSector> sectors;
  bool closed = false;
};
CentreStar star_at_centre(const LimitSurface& surface, unsigned level) {
  const LevelComplex complex(surface);
  PieceName piece{PatchId(0), {}};
  for (unsigned k = 0; k < level; ++k) piece = piece.child(0);
  const LevelStar star = complex.star(complex.vertices(piece)[0], level);
  EXPECT_TRUE(star.fan);
  CentreStar result;
  result.patches = patches_of(surface, star);
  for (std::size_t s = 0; s < result.patches.size(); ++s) {
    result.sectors.push_back({&result.patches[s], star.sectors[s].centre});
  }
  result.closed = star.closed;
  return result;
}

// All with one cache: what is known of a corner's topology is found once.
LimitSurface surface_of(const oracle::TaggedMesh& mesh, Scheme scheme = Scheme::loop) {
  static const auto cache = std::make_shared<BoundsCache>();
  return LimitSurface(testing::control_mesh(mesh), {scheme}, cache);
}

// Is it proved to be injective?
bool injective_at_centre(const oracle::TaggedMesh& mesh, unsigned level) {
  const LimitSurface surface = surface_of(mesh);
  const CentreStar star = star_at_centre(surface, level);
  return certainly_injective(star.sectors, star.closed);
}

TEST(star, of_any_common_valence_is_injective_where_it_is_smooth) {
  for (std::uint32_t n = 3; n <= 10; ++n) {
    const auto bowl = disc(n, 1, [](double x, double y) { return 0.1 * (x * x + y * y) + 0.05 * x * y; });
    EXPECT_TRUE(injective_at_centre(bowl, 3)) << n;
  }
}

TEST(star, that_winds_twice_is_never_injective) {
  for (std::uint32_t n = 5; n <= 16; ++n) {
    const auto twice = disc(n, 2, [](double x, double y) { return 0.02 * x * y; });
    for (unsigned level = 1; level <= 4; ++level) EXPECT_FALSE(injective_at_centre(twice, level)) << n;
  }
}

// Bilinear quads around a vertex, in a plane: n of them, over an angle of so many turns.
TEST(star, of_flat_quads_is_injective_unless_it_overlaps_itself) {
  int injective = 0;
  for (std::uint32_t n = 3; n <= 16; ++n) {
    for (const bool closed : {true, false}) {
      for (const double turns : {0.4, 0.6, 0.8, 0.9, 1.0, 1.1, 1.4, 2.0, 3.0}) {
        if ((closed && turns != std::floor(turns)) || turns >= 0.45 * n) continue;
        oracle::TaggedMesh mesh;
        mesh.points.push_back({0, 0, 0});
        const std::uint32_t spokes = closed ? n : n + 1;
        for (std::uint32_t i = 0; i < 2 * spokes; ++i) {
          const double angle = turns * std::numbers::pi * i / n, size = i % 2 == 0 ? 1 : 1.2;
          mesh.points.push_back({size * std::cos(angle), size * std::sin(angle), 0});
        }
        for (std::uint32_t i = 0; i < n; ++i) {
          const std::uint32_t a = 1 + 2 * i, b = 1 + 2 * ((i + 1) % spokes);
          mesh.polygons.push_back({0, a, a + 1, b});
        }
        const LimitSurface surface = surface_of(mesh, Scheme::bilinear);
        const CentreStar star = star_at_centre(surface, 0);
        ASSERT_EQ(star.closed, closed);
        const bool proved = certainly_injective(star.sectors, star.closed);
        if (turns > 1 || (turns == 1 && !closed)) {
          EXPECT_FALSE(proved) << n << " over " << turns;
        } else {
          injective += proved ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(injective, 25);
}

// A flat fan around a vertex of its rim, with a low wall there, as CAD triangulates the caps of cylinders.
TEST(star, of_an_uneven_fan_of_many_triangles_is_injective) {
  for (const std::uint32_t sides : {24u, 60u}) {
    oracle::TaggedMesh mesh;
    for (const double z : {0.0, 0.1}) {
      for (std::uint32_t k = 0; k < sides; ++k) {
        const double angle = 2 * std::numbers::pi * k / sides;
        mesh.points.push_back({std::cos(angle), std::sin(angle), z});
      }
    }
    for (std::uint32_t k = 1; k + 1 < sides; ++k) {
      mesh.polygons.push_back({0, k + 1, k});
      mesh.polygons.push_back({sides, sides + k, sides + k + 1});
    }
    for (std::uint32_t k = 0; k < sides; ++k) {
      mesh.polygons.push_back({k, (k + 1) % sides, sides + (k + 1) % sides});
      mesh.polygons.push_back({k, sides + (k + 1) % sides, sides + k});
    }
    EXPECT_TRUE(injective_at_centre(mesh, 5)) << sides;
  }
}

// Quads or triangles around a vertex that is sharp by itself, in a plane: it stays where it is.
TEST(star, of_a_sharp_vertex_in_a_plane_is_injective_where_it_is_in_balance) {
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark}) {
    for (std::uint32_t n = 3; n <= 8; ++n) {
      oracle::TaggedMesh mesh;
      mesh.points.push_back({0, 0, 0});
      const std::uint32_t parts = scheme == Scheme::loop ? n : 2 * n;
      for (std::uint32_t ring = 1; ring <= 3; ++ring) {
        for (std::uint32_t i = 0; i < parts; ++i) {
          const double angle = 2 * std::numbers::pi * i / parts;
          mesh.points.push_back({ring * std::cos(angle), ring * std::sin(angle), 0});
        }
      }
      for (std::uint32_t i = 0; i < parts; ++i) {
        const std::uint32_t a = 1 + i, b = 1 + (i + 1) % parts;
        if (scheme == Scheme::loop) {
          mesh.polygons.push_back({0, a, b});
        } else if (i % 2 == 0) {
          mesh.polygons.push_back({0, a, b, 1 + (i + 2) % parts});
        }
        for (std::uint32_t ring = 0; ring < 2; ++ring) {
          const std::uint32_t out = ring * parts;
          if (scheme == Scheme::loop) {
            mesh.polygons.push_back({out + a, out + parts + a, out + parts + b});
            mesh.polygons.push_back({out + a, out + parts + b, out + b});
          } else {
            mesh.polygons.push_back({out + a, out + parts + a, out + parts + b, out + b});
          }
        }
      }
      mesh.corners.push_back({0, 10});
      const LimitSurface surface = surface_of(mesh, scheme);
      const CentreStar star = star_at_centre(surface, 2);
      EXPECT_FALSE(certainly_injective(star.sectors, star.closed)) << name_of(scheme) << " " << n;
      EXPECT_TRUE(certainly_injective(star.sectors, star.closed, true)) << name_of(scheme) << " " << n;
    }
  }
}

using Plane = std::array<double, 2>;

// Do two convex polygons that turn left have more than their borders in common?
bool overlap(const std::vector<Plane>& a, const std::vector<Plane>& b) {
  for (const auto& [x, y] : {std::pair{&a, &b}, std::pair{&b, &a}}) {
    for (std::size_t k = 0; k < x->size(); ++k) {
      const Plane &p = (*x)[k], &q = (*x)[(k + 1) % x->size()];
      double most = -INFINITY;  // to the left of the edge
      for (const Plane& r : *y) {
        most = std::max(most, (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]));
      }
      if (most < 1e-6) return false;
    }
  }
  return true;
}

TEST(star, whose_quads_overlap_is_never_injective) {
  std::mt19937_64 random(5);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  int injective = 0, overlapping = 0;
  for (int trial = 0; trial < static_cast<int>(testing::fewer(30'000)); ++trial) {
    const auto n = static_cast<std::uint32_t>(2 + random() % 4);
    oracle::TaggedMesh mesh;
    mesh.points.push_back({0, 0, 0});
    double angle = 0;
    const double wide = 0.5 + 1.5 * unit();
    for (std::uint32_t i = 0; i < 2 * n + 1; ++i) {
      const double size = 0.3 + 3 * unit() * unit();
      mesh.points.push_back({size * std::cos(angle), size * std::sin(angle), 0});
      // Outer corners may lie far to the side.
      angle += wide * (unit() - 0.25);
    }
    std::vector<std::vector<Plane>> quads;
    for (std::uint32_t i = 0; i < n; ++i) {
      mesh.polygons.push_back({0, 1 + 2 * i, 2 + 2 * i, 3 + 2 * i});
      std::vector<Plane> quad;
      for (const std::uint32_t v : mesh.polygons.back())
        quad.push_back({mesh.points[v][0], mesh.points[v][1]});
      quads.push_back(quad);
    }
    const bool convex = std::all_of(quads.begin(), quads.end(), [](const auto& q) {
      for (std::size_t k = 0; k < 4; ++k) {
        const Plane &a = q[k], &b = q[(k + 1) % 4], &c = q[(k + 2) % 4];
        if ((b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]) <= 1e-3) return false;
      }
      return true;
    });
    if (!convex) continue;
    bool over = false;
    for (std::size_t i = 0; i < quads.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) over = over || overlap(quads[i], quads[j]);
    }
    const LimitSurface surface = surface_of(mesh, Scheme::bilinear);
    const CentreStar star = star_at_centre(surface, 0);
    const bool proved = certainly_injective(star.sectors, star.closed);
    EXPECT_FALSE(proved && over) << trial;
    injective += proved ? 1 : 0;
    overlapping += over ? 1 : 0;
  }
  EXPECT_GT(injective, static_cast<int>(testing::fewer(20)));
  EXPECT_GT(overlapping, static_cast<int>(testing::fewer(5)));
}

TEST(star, that_is_folded_flat_is_never_injective) {
  for (std::uint32_t n = 3; n <= 12; ++n) {
    auto folded = disc(n, 1, [](double, double) { return 0.0; });
    for (auto& p : folded.points) p[1] = std::fabs(p[1]);
    for (unsigned level = 1; level <= 5; ++level) EXPECT_FALSE(injective_at_centre(folded, level)) << n;
  }
}

// In a plane an injective star has all its normals on one side.
TEST(star, that_turns_over_somewhere_in_a_plane_is_never_injective) {
  std::mt19937_64 random(3);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
  int injective = 0, turned = 0;
  for (std::uint32_t n = 3; n <= 10; ++n) {
    for (int trial = 0; trial < 60; trial += testing::fewer(4) == 4 ? 1 : 4) {
      auto mesh = disc(n, 1, [](double, double) { return 0.0; });
      // Points here and there, or the centre alone, are moved.
      const double amount = 0.05 * trial;
      for (std::size_t v = 0; v < mesh.points.size(); ++v) {
        if (trial % 3 != 0 && v > 0 && random() % 4 != 0) continue;
        if (trial % 3 == 1 && v > 0) break;
        mesh.points[v][0] += amount * unit();
        mesh.points[v][1] += amount * unit();
      }
      const LimitSurface surface = surface_of(mesh);
      for (unsigned level = 0; level <= 2; ++level) {
        const CentreStar star = star_at_centre(surface, level);
        const bool proved = certainly_injective(star.sectors, star.closed);
        bool up = false, down = false;
        for (const Patch& patch : star.patches) {
          for (int i = 0; i <= 12; ++i) {
            for (int j = 0; i + j <= 12; ++j) {
              const LimitFrame frame = limit_frame(patch, {i / 12.0, j / 12.0});
              if (frame.normal) (frame.normal->z > 0 ? up : down) = true;
            }
          }
        }
        injective += proved ? 1 : 0;
        turned += up && down ? 1 : 0;
        EXPECT_FALSE(proved && up && down) << n << " trial " << trial << " level " << level;
      }
    }
  }
  EXPECT_GT(injective, static_cast<int>(testing::fewer(200)));
  EXPECT_GT(turned, static_cast<int>(testing::fewer(100)));
}

// A sector of n faces around vertex 0 on the border, over an angle of so many turns, two rings more around it.
oracle::TaggedMesh half_disc(std::uint32_t n, bool triangles, double turns,
                             const std::function<double(double, double)>& height) {
  oracle::TaggedMesh mesh;
  mesh.points.push_back({0, 0, height(0, 0)});
  // Quads have a corner between two spokes.
  const std::uint32_t steps = triangles ? n : 2 * n, spokes = steps + 1;
  for (std::uint32_t ring = 1; ring <= 3; ++ring) {
    for (std::uint32_t i = 0; i < spokes; ++i) {
      const double angle = turns * 2 * std::numbers::pi * i / steps;
      const double size = ring + (triangles || i % 2 == 0 ? 0 : 0.3);
      const double x = size * std::cos(angle), y = size * std::sin(angle);
      mesh.points.push_back({x, y, height(x, y)});
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    if (triangles) {
      mesh.polygons.push_back({0, 1 + i, 2 + i});
    } else {
      mesh.polygons.push_back({0, 1 + 2 * i, 2 + 2 * i, 3 + 2 * i});
    }
  }
  for (std::uint32_t ring = 0; ring < 2; ++ring) {
    for (std::uint32_t i = 0; i < steps; ++i) {
      const std::uint32_t a = 1 + ring * spokes + i, b = a + spokes;
      if (triangles) {
        mesh.polygons.push_back({a, b, b + 1});
        mesh.polygons.push_back({a, b + 1, a + 1});
      } else {
        mesh.polygons.push_back({a, b, b + 1, a + 1});
      }
    }
  }
  return mesh;
}

TEST(star, at_a_boundary_is_injective) {
  for (const bool triangles : {true, false}) {
    for (std::uint32_t n = 2; n <= 10; ++n) {
      const auto bowl = half_disc(n, triangles, 0.5,
                                  [](double x, double y) { return 0.1 * (x * x + y * y) + 0.05 * x * y; });
      const LimitSurface surface = surface_of(bowl, triangles ? Scheme::loop : Scheme::catmark);
      for (unsigned level = 2; level <= 4; ++level) {
        const CentreStar star = star_at_centre(surface, level);
        EXPECT_TRUE(certainly_injective(star.sectors, star.closed)) << n << " level " << level;
      }
    }
  }
}

// The tangents of a disc of several faces at its vertex 0 on the border: along, and across.
std::array<Vector3, 2> border_tangents(const oracle::TaggedMesh& mesh, const SchemeOptions& options) {
  const LimitSurface surface(testing::control_mesh(mesh), options, std::make_shared<BoundsCache>());
  const Patch patch = surface.patch(PatchId(0));
  const std::size_t corner = patch.to_kind(0);
  const Stencils& rows = patch.kind->corner_tangents();
  return {rows.apply<Vector3>(2 * corner, patch.points), rows.apply<Vector3>(2 * corner + 1, patch.points)};
}

// Both sides of a crease: their tangents across it shrink less than the one along it where they have four faces.
TEST(star, at_a_crease_of_two_wide_sides_is_injective) {
  for (const std::uint32_t n : {4u, 6u, 8u, 10u, 12u, 14u, 18u}) {
    for (const bool around : {false, true}) {
      // Which sector is the first one must not matter.
      auto flat = disc(n, 1, [](double, double) { return 0.0; });
      for (std::uint32_t ring = 0; ring < 3; ++ring) {
        for (const std::uint32_t i : {around ? 1u : 0u, n / 2 + (around ? 1u : 0u)}) {
          const std::uint32_t here = 1 + ring * n + i;
          flat.creases.push_back({ring == 0 ? 0 : here - n, here, 10});
        }
      }
      for (unsigned level = 1; level <= 3; ++level) {
        EXPECT_TRUE(injective_at_centre(flat, level)) << n << " level " << level;
      }
    }
  }
}

// One side wide, the other one not.
TEST(star, at_a_crease_of_two_different_sides_is_injective) {
  for (std::uint32_t narrow = 2; narrow <= 3; ++narrow) {
    for (std::uint32_t wide = 4; wide <= 5; ++wide) {
      const std::uint32_t n = narrow + wide;
      for (std::uint32_t first = 0; first < n; ++first) {
        auto flat = disc(n, 1, [](double x, double y) { return 0.05 * x * y; });
        // Both sides over half a turn, about.
        for (std::uint32_t ring = 0; ring < 3; ++ring) {
          for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t spoke = (i + n - first) % n;
            const double turns =
                spoke <= narrow ? 0.45 * spoke / narrow : 0.45 + 0.55 * (spoke - narrow) / wide;
            auto& p = flat.points[1 + ring * n + i];
            p = {(ring + 1) * std::cos(2 * std::numbers::pi * turns),
                 (ring + 1) * std::sin(2 * std::numbers::pi * turns), p[2]};
            const std::uint32_t here = 1 + ring * n + i;
            if (spoke == 0 || spoke == narrow) flat.creases.push_back({ring == 0 ? 0 : here - n, here, 10});
          }
        }
        for (unsigned level = 2; level <= 4; ++level) {
          EXPECT_TRUE(injective_at_centre(flat, level))
              << narrow << " and " << wide << " faces, first " << first << ", level " << level;
        }
      }
    }
  }
}

// Patches with further extraordinary corners show one with two eigenvalues only after they are split.
TEST(star, whose_boundary_corner_is_met_after_splits_is_proved_before_or_after) {
  for (const std::uint32_t n : {2u, 4u, 5u}) {
    for (int turn = 0; turn < 12; ++turn) {
      for (const double shear : {0.0, 0.3, -0.6}) {
        auto mesh = half_disc(n, true, 0.5, [](double, double) { return 0.0; });
        const double angle = 0.3 + turn * std::numbers::pi / 6;
        for (auto& p : mesh.points) {
          const double x = p[0] + shear * p[1], y = p[1];
          p = {std::cos(angle) * x - std::sin(angle) * y, std::sin(angle) * x + std::cos(angle) * y, 0};
        }
        const LimitSurface surface = surface_of(mesh);
        ASSERT_EQ(asymptotics_of(*surface.patch(PatchId(0)).kind).characteristic_map(), nullptr);
        for (unsigned level = 0; level <= 1; ++level) {
          const CentreStar star = star_at_centre(surface, level);
          EXPECT_TRUE(level == 0 || certainly_injective(star.sectors, star.closed)) << n << " turn " << turn;
        }
      }
    }
  }
}

// The vertex on the border is pushed so that the tangent across is short and turns over, or just does not: so
// does its neighbourhood, a small one at first, below all pieces that are looked at one by one. Patches of the
// first levels have further extraordinary corners, and show that one only after they are split.
TEST(star, that_turns_over_at_a_boundary_in_a_plane_is_never_injective) {
  std::mt19937_64 random(4);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
  int injective = 0, turned = 0;
  for (int trial = 0; trial < static_cast<int>(testing::fewer(400)); ++trial) {
    const bool triangles = trial % 2 == 0;
    const std::uint32_t n = 2 + static_cast<std::uint32_t>(random() % (triangles ? 5 : 3));
    auto mesh = half_disc(n, triangles, 0.1 + 0.2 * (unit() + 1), [](double, double) { return 0.0; });
    const double angle = 4 * unit(), shear = unit();
    for (auto& p : mesh.points) {
      const double x = p[0] + 0.05 * unit() + shear * p[1], y = p[1] + 0.05 * unit();
      p = {std::cos(angle) * x - std::sin(angle) * y, std::sin(angle) * x + std::cos(angle) * y, 0};
    }
    const SchemeOptions options{.scheme = triangles ? Scheme::loop : Scheme::catmark};
    const auto before = border_tangents(mesh, options);
    const double size = length(before[1]) * std::pow(10, 1.5 * (unit() - 1)), turn = 1.5 * unit();
    const Vector3 along = normalized(before[0]), across = {-along.y, along.x, 0};
    const Vector3 wanted =
        size * std::cos(turn) * (trial % 3 == 0 ? 1 : -1) * along + size * std::sin(turn) * across;
    auto moved = mesh;
    moved.points[0][0] += 1;
    const double weight = border_tangents(moved, options)[1].x - before[1].x;
    mesh.points[0][0] += (wanted.x - before[1].x) / weight;
    mesh.points[0][1] += (wanted.y - before[1].y) / weight;
    const LimitSurface surface = surface_of(mesh, options.scheme);
    const auto tangents = border_tangents(mesh, options);
    for (unsigned level = 0; level <= 1; ++level) {
      const CentreStar star = star_at_centre(surface, level);
      const bool proved = certainly_injective(star.sectors, star.closed);
      const bool down = cross(tangents[0], tangents[1]).z < 0;
      // Farther off it is on the other side.
      bool both = false;
      for (std::size_t s = 0; s < star.patches.size() && proved; ++s) {
        for (std::size_t k = 1; k < 3; ++k) {
          const std::size_t corner = (star.sectors[s].centre + k) % 3;
          const LimitFrame frame =
              limit_frame(star.patches[s], {corner == 1 ? 1.0 : 0.0, corner == 2 ? 1.0 : 0.0});
          both = both || (frame.normal && (frame.normal->z < 0) != down);
        }
      }
      injective += proved ? 1 : 0;
      turned += down ? 1 : 0;
      EXPECT_FALSE(proved && both) << name_of(options.scheme) << ", " << n << " faces, trial " << trial
                                   << ", level " << level;
    }
  }
  RecordProperty("injective", injective);
  RecordProperty("turned", turned);
  EXPECT_GT(injective, static_cast<int>(testing::fewer(50)));
  EXPECT_GT(turned, static_cast<int>(testing::fewer(200)));
}

// Is the star of vertex 0 of bilinear quads proved? It is corner 0 or 1 of each: both halves, or one.
bool proved_of_bilinear_quads(const oracle::TaggedMesh& mesh) {
  const LimitSurface surface = surface_of(mesh, Scheme::bilinear);
  const LevelComplex complex(surface);
  const std::size_t corner = mesh.polygons[0][0] == 0 ? 0 : 1;
  const LevelStar star = complex.star(complex.vertices(PieceName{PatchId(0), {}})[corner], 0);
  EXPECT_TRUE(star.fan);
  std::vector<Patch> patches;
  for (const auto& sector : star.sectors) patches.push_back(surface.patch(sector.piece.patch));
  std::vector<StarSector> sectors;
  for (std::size_t s = 0; s < patches.size(); ++s) sectors.push_back({&patches[s], star.sectors[s].centre});
  return certainly_injective(sectors, star.closed);
}

// Convex quads in the plane, whose fourth corners are far out to the side.
TEST(star, of_slanting_quads_is_injective) {
  oracle::TaggedMesh two;
  two.points = {{0, 0, 0},         {0.97, -0.534, 0},  {0.388, 0.322, 0},
                {0.813, 1.128, 0}, {0.934, -0.187, 0}, {0.874, 1.016, 0}};
  two.polygons = {{2, 0, 1, 4}, {0, 2, 5, 3}};
  EXPECT_TRUE(proved_of_bilinear_quads(two));
  oracle::TaggedMesh wide = two;
  wide.points = {{0, 0, 0},           {1.908, 1.432, 0}, {-0.254, 0.926, 0},
                 {-0.403, -0.056, 0}, {3.441, 7.463, 0}, {-0.457, 0.475, 0}};
  EXPECT_TRUE(proved_of_bilinear_quads(wide));
  oracle::TaggedMesh closed;
  closed.points = {{0, 0, 0},          {0.617, 0.012, 0}, {-0.726, 0.431, 0}, {-0.626, -0.301, 0},
                   {-0.036, 0.724, 0}, {-3.598, 0.6, 0},  {-1.184, -0.724, 0}};
  closed.polygons = {{2, 0, 1, 4}, {0, 2, 5, 3}, {0, 3, 6, 1}};
  EXPECT_TRUE(proved_of_bilinear_quads(closed));
}

// Three bilinear quads around a vertex, the halves at it: their outer edges are diagonals, which are parabolas, the
// more curved the farther out the fourth corner is.
TEST(star, whose_border_bulges_is_injective) {
  for (const double out : {1.1, 1.6, 4.0, 6.0, 9.0}) {
    oracle::TaggedMesh mesh;
    mesh.points.push_back({0, 0, 0});
    for (int i = 0; i < 6; ++i) {
      const double angle = 0.1 + std::numbers::pi / 3 * i, size = i % 2 == 0 ? 1 : out;
      mesh.points.push_back({size * std::cos(angle), size * std::sin(angle), 0});
    }
    for (std::uint32_t i = 0; i < 3; ++i) {
      mesh.polygons.push_back({1 + (2 * i + 2) % 6, 0, 1 + 2 * i, 2 + 2 * i});
    }
    EXPECT_TRUE(proved_of_bilinear_quads(mesh)) << out;
  }
}

// A disc of quads around vertex 0, inside.
oracle::TaggedMesh quad_disc(std::uint32_t n, const std::function<double(double, double)>& height) {
  oracle::TaggedMesh mesh;
  mesh.points.push_back({0, 0, height(0, 0)});
  const std::uint32_t steps = 2 * n;
  for (std::uint32_t ring = 1; ring <= 3; ++ring) {
    for (std::uint32_t i = 0; i < steps; ++i) {
      const double angle = 2 * std::numbers::pi * i / steps;
      const double size = ring + (i % 2 == 0 ? 0 : 0.3);
      const double x = size * std::cos(angle), y = size * std::sin(angle);
      mesh.points.push_back({x, y, height(x, y)});
    }
  }
  for (std::uint32_t i = 0; i < n; ++i)
    mesh.polygons.push_back({0, 1 + 2 * i, 2 + 2 * i, 1 + (2 * i + 2) % steps});
  for (std::uint32_t ring = 0; ring < 2; ++ring) {
    for (std::uint32_t i = 0; i < steps; ++i) {
      const std::uint32_t a = 1 + ring * steps, k = (i + 1) % steps;
      mesh.polygons.push_back({a + i, a + steps + i, a + steps + k, a + k});
    }
  }
  return mesh;
}

TEST(star, of_any_valence_to_64_is_injective_where_it_is_smooth) {
  const auto height = [](double x, double y) { return 0.1 * (x * x + y * y) + 0.05 * x * y; };
  for (const std::uint32_t n : {3u, 5u, 6u, 7u, 8u, 9u, 10u, 12u, 16u, 20u, 24u, 32u, 48u, 64u}) {
    for (const Scheme scheme : {Scheme::loop, Scheme::catmark}) {
      const LimitSurface surface =
          surface_of(scheme == Scheme::loop ? disc(n, 1, height) : quad_disc(n, height), scheme);
      const CentreStar star = star_at_centre(surface, 3);
      EXPECT_TRUE(certainly_injective(star.sectors, star.closed)) << name_of(scheme) << " " << n;
    }
  }
}

// A crease ends at vertex 0, inside; or vertex 0 is a sharp corner of the border.
TEST(star, at_a_dart_or_a_sharp_corner_is_injective) {
  const auto height = [](double x, double y) { return 0.05 * (x * x + x * y); };
  for (const bool triangles : {true, false}) {
    const Scheme scheme = triangles ? Scheme::loop : Scheme::catmark;
    for (std::uint32_t n = 3; n <= 16; ++n) {
      auto dart = triangles ? disc(n, 1, height) : quad_disc(n, height);
      const std::uint32_t around = triangles ? n : 2 * n;
      for (std::uint32_t ring = 0; ring < 3; ++ring) {
        const std::uint32_t here = 1 + ring * around;
        dart.creases.push_back({ring == 0 ? 0 : here - around, here, 10});
      }
      const LimitSurface surface = surface_of(dart, scheme);
      const CentreStar star = star_at_centre(surface, 3);
      EXPECT_TRUE(certainly_injective(star.sectors, star.closed)) << name_of(scheme) << " dart of " << n;
    }
    for (std::uint32_t n = 1; n <= 9; ++n) {
      auto corner = half_disc(n, triangles, n < 3 ? 0.3 : 0.5, height);
      corner.corners.push_back({0, 10});
      const LimitSurface surface = surface_of(corner, scheme);
      const CentreStar star = star_at_centre(surface, 4);
      EXPECT_TRUE(certainly_injective(star.sectors, star.closed)) << name_of(scheme) << " corner of " << n;
    }
  }
}

// A fan over less than a whole turn at its centre that winds around further out, and inwards: it crosses its first spoke there. In the
// plane it turns left everywhere, and its border once around points inside, all in all.
TEST(star, that_winds_around_further_out_is_never_injective) {
  int injective = 0;
  for (std::uint32_t n = 3; n <= 5; ++n) {
    for (const double near : {0.4, 0.55, 0.7}) {
      for (const double more : {0.0, 0.1, 0.2, 0.3, 0.45, 0.6, 0.75, 0.9}) {
        auto fan = half_disc(n, true, 0.5, [](double, double) { return 0.0; });
        for (auto& p : fan.points) {
          const double size = std::hypot(p[0], p[1]),
                       part = std::max(0.0, std::atan2(p[1], p[0])) / std::numbers::pi;
          const double angle = 2 * std::numbers::pi * part * (near + more * size),
                       r = size * (1 - 0.4 * part);
          p = {r * std::cos(angle), r * std::sin(angle), 0};
        }
        const LimitSurface surface = surface_of(fan);
        for (unsigned level = 0; level <= 1; ++level) {
          const CentreStar star = star_at_centre(surface, level);
          const bool proved = certainly_injective(star.sectors, star.closed);
          // By the angles of the border's limit points, seen from the centre.
          const Point3 centre = limit_point(star.patches[0], {star.sectors[0].centre == 1 ? 1.0 : 0.0,
                                                              star.sectors[0].centre == 2 ? 1.0 : 0.0})
                                    .from(star.patches[0].origin)
                                    .position;
          double turned = 0;
          std::optional<Vector3> before;
          for (const StarSector& sector : star.sectors) {
            for (int i = 0; i <= 16; ++i) {
              std::array<double, 3> at{};
              at[(sector.centre + 1) % 3] = 1 - i / 16.0;
              at[(sector.centre + 2) % 3] = i / 16.0;
              const Vector3 p =
                  limit_point(*sector.patch, {at[1], at[2]}).from(sector.patch->origin).position - centre;
              if (before) turned += std::atan2(cross(*before, p).z, dot(*before, p));
              before = p;
            }
          }
          injective += proved ? 1 : 0;
          if (turned > 2.05 * std::numbers::pi) {
            EXPECT_FALSE(proved) << n << " over " << near << " and " << more << ", level " << level;
          }
        }
      }
    }
  }
  EXPECT_GT(injective, 10);
}

// Over nearly a whole turn, too.
TEST(star, at_a_boundary_over_a_wide_angle_is_injective) {
  for (const bool triangles : {true, false}) {
    for (std::uint32_t n = 2; n <= 8; ++n) {
      for (const double turns : {0.15, 0.3, 0.5, 0.6}) {
        const auto fan = half_disc(n, triangles, turns, [](double x, double y) { return 0.05 * x * y; });
        const LimitSurface surface = surface_of(fan, triangles ? Scheme::loop : Scheme::catmark);
        const CentreStar star = star_at_centre(surface, 3);
        EXPECT_TRUE(certainly_injective(star.sectors, star.closed))
            << n << (triangles ? " triangles" : " quads") << " over " << turns;
      }
    }
  }
}

// Do normals near the centre of a star in the plane point both ways?
bool turns_over(const std::vector<StarSector>& sectors) {
  constexpr std::array shares{0.0, 1e-6, 1e-3, 0.25, 0.5, 0.75, 1 - 1e-3, 1 - 1e-6, 1.0};
  bool up = false, down = false;
  for (const auto& [patch, centre, mirrored] : sectors) {
    for (int level = 0; level <= 16; ++level) {
      for (const double share : shares) {
        std::array<double, 3> at{};
        const double away = std::ldexp(1, -level);
        at[centre] = 1 - away;
        at[(centre + 1) % 3] = away * share;
        at[(centre + 2) % 3] = away * (1 - share);
        const LimitFrame frame = limit_frame(*patch, {at[1], at[2]});
        if (frame.normal) (frame.normal->z > 0 ? up : down) = true;
      }
    }
  }
  return up && down;
}

// Fans on the border, smooth or with a sharp corner, in the plane. In wide ones the ends shrink faster than all else: they may turn over
// alone, or not be the ones to do so. Of all: scheme, faces, corner, what is moved, how flat it is, how much.
TEST(star, of_a_wide_fan_that_turns_over_in_a_plane_is_never_injective) {
  std::mt19937_64 random(9);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
  int injective = 0, turned = 0, wide = 0;
  for (int trial = 0; trial < static_cast<int>(testing::fewer(300)); ++trial) {
    const bool triangles = random() % 2 == 0;
    const std::uint32_t n = 1 + static_cast<std::uint32_t>(random() % 9),
                        spokes = (triangles ? n : 2 * n) + 1;
    auto mesh = half_disc(n, triangles, 0.1 + 0.2 * (unit() + 1), [](double, double) { return 0.0; });
    const bool corner = random() % 3 == 0;
    if (corner) mesh.corners.push_back({0, 10});
    const double flat = std::array{1.0, 0.3, 0.1}[random() % 3],
                 amount = std::array{0.1, 0.4, 1.0}[random() % 3];
    const std::size_t moved = random() % 4;
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
      auto& p = mesh.points[v];
      const bool end = v == 1 || v == spokes, ring = v > 0 && v <= spokes;
      if (moved == 0 || (moved == 1 && end) || (moved == 2 && ring && !end) || (moved == 3 && v == 0)) {
        for (std::size_t k = 0; k < 2; ++k) p[k] += amount * unit();
      }
    }
    for (auto& p : mesh.points) p[1] = flat * p[1] + 0.5 * p[0];
    const LimitSurface surface = surface_of(mesh, triangles ? Scheme::loop : Scheme::catmark);
    for (unsigned level = 1; level <= 3; level += 2) {
      const CentreStar star = star_at_centre(surface, level);
      const bool proved = certainly_injective(star.sectors, star.closed), over = turns_over(star.sectors);
      EXPECT_FALSE(proved && over) << "trial " << trial << ", " << (triangles ? "triangles" : "quads") << " "
                                   << n << (corner ? ", sharp" : "") << ", level " << level;
      injective += proved ? 1 : 0;
      wide += proved && n > (triangles ? 6 : 4) ? 1 : 0;
      turned += over ? 1 : 0;
    }
  }
  std::printf("injective %d, of wide ones %d, turned %d\n", injective, wide, turned);
  EXPECT_GT(injective, static_cast<int>(testing::fewer(200)));
  EXPECT_GT(wide, static_cast<int>(testing::fewer(60)));
  EXPECT_GT(turned, static_cast<int>(testing::fewer(60)));
}

// A crease between two wide sides, pulled in to nearly nothing, one way or the other: then it turns over, where nothing else does. On the
// border of a star its border would tell.
TEST(star, whose_crease_alone_turns_over_is_never_injective) {
  int injective = 0, turned = 0;
  for (const bool triangles : {true, false}) {
    for (std::uint32_t side = triangles ? 6 : 4; side <= (triangles ? 9 : 7); ++side) {
      const std::uint32_t n = 2 * side, around = triangles ? n : 2 * n;
      for (const bool corner : {true, false}) {
        for (const double near : {0.5, 0.1, 0.01, 1e-3}) {
          for (const auto& [first, last] : {std::pair{1, 1}, {-1, 1}, {-1, -1}}) {
            for (const bool all_along : {true, false}) {
              const auto flat = [](double, double) { return 0.0; };
              auto mesh = triangles ? disc(n, 1, flat) : quad_disc(n, flat);
              if (corner) mesh.corners.push_back({0, 10});
              for (std::uint32_t ring = 0; ring < 3; ++ring) {
                for (const std::uint32_t place : {0U, around / 2}) {
                  const std::uint32_t here = 1 + ring * around + place;
                  mesh.creases.push_back({ring == 0 ? 0 : here - around, here, 10});
                  if (ring > 0 && !all_along) continue;
                  for (std::size_t k = 0; k < 2; ++k)
                    mesh.points[here][k] *= near * (place == 0 ? first : last);
                }
              }
              const LimitSurface surface = surface_of(mesh, triangles ? Scheme::loop : Scheme::catmark);
              const CentreStar star = star_at_centre(surface, 2);
              const bool proved = certainly_injective(star.sectors, star.closed),
                         over = turns_over(star.sectors);
              EXPECT_FALSE(proved && over)
                  << (triangles ? "triangles " : "quads ") << n << (corner ? ", sharp, " : ", ")
                  << first * near << " and " << last * near << (all_along ? "" : ", near it");
              injective += proved ? 1 : 0;
              turned += over ? 1 : 0;
            }
          }
        }
      }
    }
  }
  std::printf("injective %d, turned %d\n", injective, turned);
  EXPECT_GT(injective, 40);
  EXPECT_GT(turned, 100);
}

// A crease between two wide sides, one of which lies over it, near the vertex or farther out: its end alone tells.
TEST(star, whose_side_lies_over_its_crease_is_never_injective) {
  std::mt19937_64 random(13);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
  int injective = 0, turned = 0;
  for (int trial = 0; trial < static_cast<int>(testing::fewer(200)); ++trial) {
    const bool triangles = random() % 3 != 0;
    const auto side = static_cast<std::uint32_t>(triangles ? 6 + random() % 3 : 4 + random() % 2);
    const std::uint32_t n = 2 * side, around = triangles ? n : 2 * n;
    const auto flat = [](double, double) { return 0.0; };
    auto mesh = triangles ? disc(n, 1, flat) : quad_disc(n, flat);
    if (random() % 3 == 0) mesh.corners.push_back({0, 10});
    for (std::uint32_t ring = 0; ring < 3; ++ring) {
      for (const std::uint32_t place : {0U, around / 2}) {
        const std::uint32_t here = 1 + ring * around + place;
        mesh.creases.push_back({ring == 0 ? 0 : here - around, here, 10});
      }
    }
    const double near = std::array{1.0, 1.0, 0.5, 0.1}[random() % 4],
                 amount = std::array{0.02, 0.1, 0.5}[random() % 3];
    const std::uint64_t pulled = random() % 4, beside = 1 + random() % 3;
    for (std::uint32_t ring = 0; ring < 3; ++ring) {
      for (std::size_t k = 0; k < 2; ++k) mesh.points[1 + ring * around][k] *= ring < pulled ? near : 1;
      for (std::uint32_t i = 1; i <= beside; ++i) {
        auto& p = mesh.points[1 + ring * around + i];
        if (random() % 3 > 0) p[1] *= std::array{0.3, 0.05, -0.02, -0.1, -0.3, -0.6}[random() % 6];
        p[0] += amount * unit();
      }
    }
    const LimitSurface surface = surface_of(mesh, triangles ? Scheme::loop : Scheme::catmark);
    for (unsigned level = 1; level <= 2; ++level) {
      const CentreStar star = star_at_centre(surface, level);
      const bool proved = certainly_injective(star.sectors, star.closed),
                 over = (proved || trial % 8 == 0) && turns_over(star.sectors);
      EXPECT_FALSE(proved && over) << "trial " << trial << ", " << (triangles ? "triangles " : "quads ") << n;
      injective += proved ? 1 : 0;
      turned += over ? 1 : 0;
    }
  }
  std::printf("injective %d, turned %d\n", injective, turned);
  EXPECT_GT(injective, static_cast<int>(testing::fewer(100)));
  EXPECT_GT(turned, testing::slow ? 0 : 10);
}

// Triangles of Midedge and other faces of dual schemes: the slowest parts at their middles differ from level to level.
TEST(star, of_a_dual_scheme_that_turns_over_in_the_limit_is_never_injective) {
  std::mt19937_64 random(8);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
  int injective = 0, turned = 0;
  for (int trial = 0; trial < 200; ++trial) {
    auto mesh = disc(3 + static_cast<std::uint32_t>(random() % 4), 1, [](double, double) { return 0.0; });
    const double flat = std::array{1.0, 0.3, 0.1}[random() % 3],
                 amount = std::array{0.3, 0.8, 2.0}[random() % 3];
    for (auto& p : mesh.points) {
      p[0] += amount * unit();
      p[1] = flat * (p[1] + amount * unit()) + 0.5 * p[0];
    }
    const LimitSurface surface = surface_of(mesh, trial % 4 == 0 ? Scheme::doo_sabin : Scheme::midedge);
    const LevelComplex complex(surface);
    const unsigned level = complex.first_level();
    std::set<LevelVertex> seen;
    for (const PieceName& piece : complex.pieces()) {
      for (const LevelVertex& vertex : complex.vertices(piece)) {
        if (seen.size() == 6 || !seen.insert(vertex).second) continue;
        const LevelStar star = complex.star(vertex, level);
        if (!star.fan) continue;
        const std::vector<Patch> patches = patches_of(surface, star);
        std::vector<StarSector> sectors;
        for (std::size_t s = 0; s < patches.size(); ++s)
          sectors.push_back({&patches[s], star.sectors[s].centre});
        const bool proved = certainly_injective(sectors, star.closed);
        const bool over = turns_over(sectors);
        EXPECT_FALSE(proved && over) << "trial " << trial;
        injective += proved ? 1 : 0;
        turned += over ? 1 : 0;
      }
    }
  }
  EXPECT_GT(injective, 300);
  EXPECT_GT(turned, 300);
}

// A vertex inside that is sharp by itself, with one sharp edge or none: a cusp, seen along it.
oracle::TaggedMesh cone(std::uint32_t n, bool triangles, double turns, double steep, bool edge = false) {
  const auto height = [steep](double x, double y) { return -steep * std::hypot(x, y); };
  oracle::TaggedMesh mesh = triangles ? disc(n, turns, height) : quad_disc(n, height);
  mesh.corners.push_back({0, 10});
  const std::uint32_t around = triangles ? n : 2 * n;
  for (std::uint32_t ring = 0; edge && ring < 3; ++ring)
    mesh.creases.push_back({ring == 0 ? 0 : 1 + (ring - 1) * around, 1 + ring * around, 10});
  return mesh;
}

TEST(star, at_a_spike_with_a_sharp_edge_is_injective) {
  for (const bool triangles : {true, false}) {
    for (std::uint32_t n = triangles ? 4 : 3; n <= (triangles ? 8U : 5U); ++n) {
      for (const double steep : {0.3, 1.0, 3.0}) {
        auto mesh = cone(n, triangles, 1, steep, true);
        for (auto& p : mesh.points) p = {p[0] + 0.3 * p[2], 0.7 * p[1] - 0.2 * p[0], p[2] + 0.1 * p[0]};
        const LimitSurface surface = surface_of(mesh, triangles ? Scheme::loop : Scheme::catmark);
        for (unsigned level = 2; level <= 4; ++level) {
          const CentreStar star = star_at_centre(surface, level);
          EXPECT_TRUE(certainly_injective(star.sectors, star.closed))
              << (triangles ? "triangles " : "quads ") << n << ", " << steep << ", level " << level;
        }
      }
    }
  }
}

TEST(star, at_a_spike_is_injective) {
  for (const bool triangles : {true, false}) {
    for (const std::uint32_t n : {3U, 4U, 5U, 6U, 7U, 8U, 9U, 12U, 16U, 24U, 32U}) {
      // Of more quads two growths are too near each other.
      if (!triangles && n > 16) continue;
      for (const double steep : {0.2, 1.0, 3.0}) {
        auto mesh = cone(n, triangles, 1, steep);
        for (auto& p : mesh.points) p = {p[0] + 0.3 * p[2], 0.7 * p[1] - 0.2 * p[0], p[2] + 0.1 * p[0]};
        const LimitSurface surface = surface_of(mesh, triangles ? Scheme::loop : Scheme::catmark);
        for (unsigned level = 2; level <= 4; ++level) {
          const CentreStar star = star_at_centre(surface, level);
          EXPECT_TRUE(certainly_injective(star.sectors, star.closed))
              << (triangles ? "triangles " : "quads ") << n << ", " << steep << ", level " << level;
        }
      }
    }
  }
}

// By samples of normals against the spike's own direction, down to the last ones that can be told.
TEST(star, at_a_spike_that_turns_over_is_never_injective) {
  std::mt19937_64 random(11);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
  int injective = 0, turned = 0;
  for (int trial = 0; trial < static_cast<int>(testing::fewer(200)); ++trial) {
    const bool triangles = random() % 2 == 0;
    const std::uint32_t n = 3 + static_cast<std::uint32_t>(random() % 8);
    auto mesh = cone(n, triangles, triangles && trial % 8 == 0 && n > 4 ? 2 : 1,
                     std::array{0.3, 1.0, 4.0}[random() % 3], random() % 2 == 0);
    const double amount = std::array{0.1, 0.5, 1.0, 2.0}[random() % 4];
    const std::size_t moved = random() % 2 == 0 ? 1 + (triangles ? n : 2 * n) : mesh.points.size();
    for (std::size_t v = 1; v < moved; ++v) {
      for (double& x : mesh.points[v]) x += amount * unit();
    }
    const LimitSurface surface = surface_of(mesh, triangles ? Scheme::loop : Scheme::catmark);
    for (unsigned level = 1; level <= 3; level += 2) {
      const CentreStar star = star_at_centre(surface, level);
      const bool proved = certainly_injective(star.sectors, star.closed);
      // Its direction: from the vertex to the middle of what is around it, far down.
      Vector3 along;
      for (const auto& [patch, centre, mirrored] : star.sectors) {
        Patch deep = *patch;
        Vector3 spoke;
        for (int k = 0; k < 80; ++k) {
          const auto corners = limit_corners(deep);
          spoke = corners[(centre + 1) % 3] - corners[centre];
          double largest = 0;
          for (Vector3& p : deep.points) {
            p = p - corners[centre];
            largest = std::max(largest, max_abs(p));
          }
          for (Vector3& p : deep.points) p = (1 / largest) * p;
          deep.path = {};
          deep = split(deep, static_cast<unsigned>(centre));
        }
        along = along + spoke;
      }
      bool up = false, down = false;
      for (const auto& [patch, centre, mirrored] : star.sectors) {
        for (int step = 0; step <= 14; ++step) {
          for (int i = 0; i <= 8; ++i) {
            std::array<double, 3> at{};
            const double away = std::ldexp(1, -step);
            at[centre] = 1 - away;
            at[(centre + 1) % 3] = away * i / 8;
            at[(centre + 2) % 3] = away * (8 - i) / 8;
            const LimitFrame frame = limit_frame(*patch, {at[1], at[2]});
            const double side = frame.normal ? dot(*frame.normal, normalized(along)) : 0;
            if (std::fabs(side) > 1e-4) (side > 0 ? up : down) = true;
          }
        }
      }
      EXPECT_FALSE(proved && up && down)
          << "trial " << trial << ", " << (triangles ? "triangles " : "quads ") << n;
      injective += proved ? 1 : 0;
      turned += up && down ? 1 : 0;
    }
  }
  std::printf("injective %d, turned %d\n", injective, turned);
  EXPECT_GT(injective, static_cast<int>(testing::fewer(80)));
  EXPECT_GT(turned, static_cast<int>(testing::fewer(80)));
}

// A fold whose one side is much larger than the other: its mean normal is that of the large one.
TEST(star, at_a_fold_of_two_sizes_is_injective) {
  for (const double degrees : {60.0, 100.0, 120.0, 140.0}) {
    for (const double small : {1.0, 0.1, 0.01}) {
      auto mesh = disc(6, 1, [](double, double) { return 0.0; });
      const double angle = degrees * std::numbers::pi / 180;
      for (auto& p : mesh.points) {
        if (p[1] > 1e-9) p = {p[0], small * p[1] * std::cos(angle), small * p[1] * std::sin(angle)};
      }
      for (std::uint32_t ring = 0; ring < 3; ++ring) {
        for (const std::uint32_t i : {0U, 3U}) {
          const std::uint32_t here = 1 + ring * 6 + i;
          mesh.creases.push_back({ring == 0 ? 0 : here - 6, here, 10});
        }
      }
      EXPECT_TRUE(injective_at_centre(mesh, 2)) << degrees << " degrees, " << small;
    }
  }
}

// A vertex of a smooth fan, of a border or of a crease moves, though most of its limit is its own control point; sharp ones stay.
TEST(star, whose_vertex_moves_is_not_told_apart_by_a_plane) {
  for (const bool border : {false, true}) {
    for (const double sharpness : {0.0, 2.5, 9.75, 10.0}) {
      const auto flat = [](double, double) { return 0.0; };
      auto mesh = border ? half_disc(6, true, 0.4, flat) : disc(7, 1, flat);
      mesh.corners.push_back({0, sharpness});
      const LimitSurface surface = surface_of(mesh);
      const CentreStar star = star_at_centre(surface, 1);
      EXPECT_EQ(stays_in_place(star.sectors[0]), sharpness == 10) << border << " " << sharpness;
      if (sharpness < 10) {
        EXPECT_FALSE(certainly_meet_only_at_vertex(star.sectors[0], star.sectors[4]));
      }
    }
  }
}

// Two bent quads at a vertex, against their halves of 8 by 8 parts.
TEST(star, sectors_that_meet_only_at_the_vertex_do_so) {
  std::mt19937_64 random(12);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
  int proved = 0, crossing = 0;
  for (int trial = 0; trial < 400; ++trial) {
    oracle::TaggedMesh mesh;
    mesh.points.push_back({0.5, 0.25, 2});
    for (int quad = 0; quad < 2; ++quad) {
      const Vector3 along{unit(), unit(), unit()};
      for (int k = 0; k < 3; ++k) {
        const double wide = 0.8;
        mesh.points.push_back(
            {0.5 + along.x + wide * unit(), 0.25 + along.y + wide * unit(), 2 + along.z + wide * unit()});
      }
    }
    mesh.polygons = {{0, 1, 2, 3}, {0, 4, 5, 6}};
    const LimitSurface surface = surface_of(mesh, Scheme::bilinear);
    for (std::uint32_t a = 0; a < 2; ++a) {
      for (std::uint32_t b = 2; b < 4; ++b) {
        const Patch first = surface.patch(PatchId(a)), second = surface.patch(PatchId(b));
        // Halves begin at opposite corners of the quad.
        const StarSector of_a{&first, a == 0 ? 0U : 2U}, of_b{&second, b == 2 ? 0U : 2U};
        ASSERT_TRUE(stays_in_place(of_a) && stays_in_place(of_b));
        if (!certainly_meet_only_at_vertex(of_a, of_b)) continue;
        ++proved;
        // Seen from the vertex no direction of the one is one of the other.
        constexpr int parts = 8;
        std::vector<std::vector<Vector3>> rays(2);
        for (const auto& [sector, of] : {std::pair{&of_a, 0}, std::pair{&of_b, 1}}) {
          for (int i = 0; i <= parts; ++i) {
            for (int j = 0; i + j <= parts; ++j) {
              std::array<double, 3> at{static_cast<double>(parts - i - j) / parts,
                                       static_cast<double>(i) / parts, static_cast<double>(j) / parts};
              if (at[sector->centre] == 1) continue;
              const Point3 p =
                  limit_point(*sector->patch, {at[1], at[2]}).from(sector->patch->origin).position;
              rays[static_cast<std::size_t>(of)].push_back(normalized(p - Point3{0.5, 0.25, 2}));
            }
          }
        }
        for (const Vector3& r : rays[0]) {
          for (const Vector3& q : rays[1]) crossing += dot(r, q) > 1 - 1e-12 ? 1 : 0;
        }
      }
    }
  }
  EXPECT_EQ(crossing, 0);
  EXPECT_GT(proved, 300);
}

TEST(star, that_is_a_point_or_a_line_is_never_injective) {
  auto point = disc(7, 1, [](double, double) { return 0.0; });
  auto line = point;
  for (auto& p : point.points) p = {1, 2, 3};
  for (auto& p : line.points) p = {p[0], 0, 0};
  for (unsigned level = 1; level <= 3; ++level) {
    EXPECT_FALSE(injective_at_centre(point, level));
    EXPECT_FALSE(injective_at_centre(line, level));
  }
}

}  // namespace
}  // namespace snug::star_test
