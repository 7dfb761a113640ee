// Lengths within patches: no sampled way, or distance, is longer than its bound; nor are bounds far from them.

#include <snug/shape/patch_lengths.h>

#include <gtest/gtest.h>
#include <oracle/tagged_shapes.h>
#include <snug/patch/evaluate.h>
#include <snug/shape/star_distortion.h>
#include <snug/surface/level_complex.h>
#include <testing/counts.h>
#include <testing/tagged.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <span>

namespace snug::patch_lengths_test {
namespace {

namespace meshes = oracle::meshes;

LimitSurface surface_of(const oracle::TaggedMesh& mesh, Scheme scheme) {
  return LimitSurface(testing::control_mesh(mesh), {scheme}, std::make_shared<BoundsCache>());
}

constexpr std::array<TriangleParameter, 3> corner_places{TriangleParameter{0, 0}, {1, 0}, {0, 1}};

Point3 at(const Patch& patch, TriangleParameter place) {
  return limit_point(patch, place).from(patch.origin).position;
}

// Along the straight segment of parameters, by chords: a lower bound of its length.
double way(const Patch& patch, TriangleParameter a, TriangleParameter b) {
  constexpr int steps = 20;
  double length = 0;
  Point3 before = at(patch, a);
  for (int i = 1; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    const Point3 next = at(patch, {a.u + t * (b.u - a.u), a.v + t * (b.v - a.v)});
    length += distance(before, next);
    before = next;
  }
  return length;
}

TEST(patch_lengths, bound_samples) {
  std::mt19937_64 random(5);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark, Scheme::doo_sabin, Scheme::midedge}) {
    double widest_regular = 0, widest = 0;
    for (std::uint32_t n = 3; n <= 9; ++n) {
      for (const double amount : {0.0, 0.5}) {
        oracle::TaggedMesh mesh = meshes::shaken(meshes::prism(n), amount, random);
        if (scheme == Scheme::loop) mesh = meshes::triangulated(mesh);
        const LimitSurface surface = surface_of(mesh, scheme);
        for (std::uint32_t p = 0; p < surface.patch_count(); p += 3) {
          if (!surface.has_patch(PatchId(p))) continue;
          Patch patch = surface.patch(PatchId(p));
          for (unsigned level = 0; level < 3; ++level) {
            const PatchLengths lengths = patch_lengths(patch);
            double largest = 0;
            const double slack = 1 + 1e-12;
            for (int i = 0; i < 20; ++i) {
              TriangleParameter a{unit(), unit()}, b{unit(), unit()};
              if (a.u + a.v > 1) a = {1 - a.u, 1 - a.v};
              if (b.u + b.v > 1) b = {1 - b.u, 1 - b.v};
              if (i < 3) a = corner_places[static_cast<std::size_t>(i)];
              const double chord = distance(at(patch, a), at(patch, b));
              EXPECT_LE(chord, lengths.diameter * slack) << name_of(scheme) << " " << n;
              if (patch.kind->polynomial()) {
                EXPECT_LE(way(patch, a, b), lengths.diameter * slack);
              }
              largest = std::max(largest, chord);
            }
            for (std::size_t k = 0; k < 3; ++k) {
              TriangleParameter b{unit(), unit()};
              if (b.u + b.v > 1) b = {1 - b.u, 1 - b.v};
              const auto &from = corner_places[k], &to = corner_places[(k + 1) % 3];
              largest = std::max(largest, distance(at(patch, from), at(patch, to)));
              EXPECT_LE(distance(at(patch, from), at(patch, b)), lengths.from_corner[k] * slack);
              EXPECT_LE(distance(at(patch, from), at(patch, to)), lengths.edge[k] * slack);
              if (!patch.kind->polynomial()) continue;
              EXPECT_LE(way(patch, from, b), lengths.from_corner[k] * slack) << name_of(scheme) << " " << n;
              EXPECT_LE(way(patch, from, to), lengths.edge[k] * slack) << name_of(scheme) << " " << n;
              EXPECT_EQ(lengths.between(k, (k + 1) % 3), lengths.edge[k]);
              EXPECT_EQ(lengths.between((k + 1) % 3, k), lengths.edge[k]);
            }
            if (amount == 0 && level == 2) {
              double& most = patch.kind->polynomial() ? widest_regular : widest;
              most = std::max(most, lengths.diameter / largest);
            }
            patch = split(patch, static_cast<unsigned>(random() % 4));
          }
        }
      }
    }
    EXPECT_LT(widest_regular, 4) << name_of(scheme);
    EXPECT_LT(widest, 400) << name_of(scheme);
    std::printf("%s: %.2f regular, %.2f others\n", name_of(scheme), widest_regular, widest);
  }
}

double stretch_at(const LimitSurface& surface, const LevelVertex& vertex, unsigned level) {
  const LevelComplex complex(surface);
  const LevelStar star = complex.star(vertex, level);
  if (!star.fan) return INFINITY;
  std::vector<Patch> patches;
  for (const auto& sector : star.sectors) {
    patches.push_back(surface.patch(sector.piece.patch));
    const PiecePath& path = sector.piece.path;
    for (unsigned k = 0; k < path.level(); ++k) patches.back() = split(patches.back(), path.digit(k));
  }
  std::vector<StarSector> sectors;
  for (std::size_t s = 0; s < patches.size(); ++s) sectors.push_back({&patches[s], star.sectors[s].centre});
  return star_distortion(sectors, star.closed);
}

TEST(star_distortion, of_smooth_vertices_is_small_and_of_folds_what_their_angle_says) {
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark}) {
    constexpr std::array angles{45.0, 10.0, 90.0, 170.0};
    for (const double degrees : std::span(angles).first(testing::fewer(angles.size()))) {
      oracle::TaggedMesh mesh = meshes::quad_grid(4, 4);
      if (scheme == Scheme::loop) mesh = meshes::triangulated(mesh);
      const double half = degrees / 2 * std::numbers::pi / 180;
      for (auto& p : mesh.points)
        p = {std::fabs(p[0] - 2) * std::cos(half), p[1], (p[0] - 2) * std::sin(half)};
      for (std::uint32_t j = 0; j < 4; ++j) mesh.creases.push_back({5 * j + 2, 5 * j + 7, 10});
      const LimitSurface surface = surface_of(mesh, scheme);
      const LevelComplex complex(surface);
      int found = 0;
      for (PieceName piece : complex.pieces()) {
        piece = piece.child(0).child(3);
        for (const LevelVertex& vertex : complex.vertices(piece)) {
          const double stretch = stretch_at(surface, vertex, complex.level_of(piece));
          EXPECT_GE(stretch, 1);
          if (stretch < 100) ++found;
        }
      }
      EXPECT_GT(found, 20) << name_of(scheme) << " " << degrees;
      // At the middle of the crease chords across it are sin(half) times the way.
      double largest = 0;
      for (PieceName each : complex.pieces()) {
        for (const LevelVertex& vertex : complex.vertices(each)) {
          const LevelStar star = complex.star(vertex, complex.level_of(each));
          if (!star.closed || !star.fan) continue;
          const Patch patch = surface.patch(PatchId(each.patch));
          const auto vertices = complex.vertices(each);
          const auto k = static_cast<std::size_t>(std::find(vertices.begin(), vertices.end(), vertex) -
                                                  vertices.begin());
          const Point3 p = at(patch, corner_places[k]);
          if (std::fabs(p.x) > 1e-9 || std::fabs(p.y * surface.scale().inverse().apply(1.0) - 2) > 0.6)
            continue;
          const double stretch = stretch_at(surface, vertex, complex.level_of(each));
          EXPECT_GE(stretch, (1 - 1e-9) / std::sin(half)) << name_of(scheme) << " " << degrees;
          largest = std::max(largest, stretch);
        }
      }
      EXPECT_GT(largest, 0) << name_of(scheme) << " " << degrees;
      if (degrees > 40) {
        EXPECT_LT(largest, 1.4 / std::sin(half)) << name_of(scheme) << " " << degrees;
      }
    }
  }
  // Extraordinary vertices.
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark}) {
    for (std::uint32_t n = 3; n <= 9; ++n) {
      oracle::TaggedMesh mesh = meshes::prism(n);
      if (scheme == Scheme::loop) mesh = meshes::triangulated(mesh);
      const LimitSurface surface = surface_of(mesh, scheme);
      const LevelComplex complex(surface);
      double largest = 0;
      for (PieceName piece : complex.pieces()) {
        const unsigned level = complex.level_of(piece) + 4;
        for (std::size_t k = 0; k < 3; ++k) {
          PieceName child = piece;
          for (int i = 0; i < 4; ++i) child = child.child(static_cast<unsigned>(k));
          largest = std::max(largest, stretch_at(surface, complex.vertices(child)[k], level));
        }
      }
      EXPECT_GE(largest, 1);
      if (n <= 6) {
        EXPECT_LT(largest, 4) << name_of(scheme) << " " << n;
      }
    }
  }
}

// In a plane: where the surface turns over, places on both sides of the turn have one point.
TEST(star_distortion, of_what_turns_over_is_infinite) {
  std::mt19937_64 random(3);
  int turned = 0;
  for (int trial = 0; trial < 20; ++trial) {
    oracle::TaggedMesh mesh = meshes::shaken(meshes::quad_grid(4, 4), 1.2, random);
    for (auto& p : mesh.points) p[2] = 0;
    const LimitSurface surface = surface_of(mesh, Scheme::catmark);
    const LevelComplex complex(surface);
    for (const PieceName& piece : complex.pieces()) {
      for (const LevelVertex& vertex : complex.vertices(piece)) {
        const LevelStar star = complex.star(vertex, complex.level_of(piece));
        bool left = false, right = false;
        for (const auto& sector : star.sectors) {
          const Patch patch = surface.patch(sector.piece.patch);
          for (const double u : {0.1, 0.4, 0.7}) {
            for (const double v : {0.1, 0.2}) {
              const LimitFrame frame = limit_frame(patch, {u, v});
              const double area = cross(frame.tangents[0], frame.tangents[1]).z;
              left = left || area > 1e-3;
              right = right || area < -1e-3;
            }
          }
        }
        if (!left || !right) continue;
        ++turned;
        EXPECT_EQ(stretch_at(surface, vertex, complex.level_of(piece)), INFINITY) << trial;
      }
    }
  }
  EXPECT_GT(turned, 50);
}

}  // namespace
}  // namespace snug::patch_lengths_test
