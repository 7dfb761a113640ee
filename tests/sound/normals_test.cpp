// Cones of normals contain the normals of refined meshes, of rings around extraordinary corners, and those that
// evaluation gives; and they are not much wider.

#include <snug/bound.h>

#include <gtest/gtest.h>
#include <oracle/normal_twin.h>
#include <snug/patch/evaluate.h>
#include <snug/search/surface_data.h>
#include <testing/counts.h>
#include <testing/scheme_surfaces.h>
#include <testing/surfaces.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <random>

namespace snug::normals_test {
namespace {

using testing::unit;

double angle_between(const Vector3& a, const Vector3& b) {
  return std::atan2(length(cross(a, b)), dot(a, b));
}

enum class Centre { smooth, crease, dart, corner, semi_sharp, boundary };
constexpr std::array centres{Centre::smooth, Centre::crease,     Centre::dart,
                             Centre::corner, Centre::semi_sharp, Centre::boundary};

// n faces around vertex 0, and two rings more; of triangles or quads, crumpled.
oracle::TaggedMesh fan(std::uint32_t n, bool triangles, Centre centre, double amount,
                       std::mt19937_64& random) {
  const bool closed = centre != Centre::boundary;
  const std::uint32_t a_face = triangles ? 1 : 2, around = a_face * n + (closed ? 0 : 1);
  oracle::TaggedMesh mesh;
  const auto add = [&](double x, double y) {
    const double size = std::hypot(x, y) + 0.3;
    const auto noise = [&] { return amount * size * (unit(random) - 0.5); };
    const double curved = 0.3 * std::min(1.0, 4 * amount);
    mesh.points.push_back(
        {x + 0.3 * noise(), y + 0.3 * noise(), curved * (x * x - 0.5 * y * y + 0.4 * x * y) + noise()});
  };
  add(0, 0);
  for (std::uint32_t ring = 1; ring <= 3; ++ring) {
    for (std::uint32_t i = 0; i < around; ++i) {
      const double angle = (closed ? 2 : 0.3 * (n + 1.0) / (n / 2.0 + 1)) * std::numbers::pi * i / (around);
      add(ring * std::cos(angle), ring * std::sin(angle));
    }
  }
  const auto at = [&](std::uint32_t ring, std::uint32_t i) { return 1 + (ring - 1) * around + i % around; };
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t k = a_face * i;
    if (triangles) {
      mesh.polygons.push_back({0, at(1, k), at(1, k + 1)});
    } else {
      mesh.polygons.push_back({0, at(1, k), at(1, k + 1), at(1, k + 2)});
    }
  }
  for (std::uint32_t ring = 1; ring < 3; ++ring) {
    for (std::uint32_t i = 0; i + (closed ? 0 : 1) < around; ++i) {
      if (triangles) {
        mesh.polygons.push_back({at(ring, i), at(ring + 1, i), at(ring + 1, i + 1)});
        mesh.polygons.push_back({at(ring, i), at(ring + 1, i + 1), at(ring, i + 1)});
      } else {
        mesh.polygons.push_back({at(ring, i), at(ring + 1, i), at(ring + 1, i + 1), at(ring, i + 1)});
      }
    }
  }
  // The vertex is any corner of its faces.
  for (auto& face : mesh.polygons) {
    std::rotate(face.begin(), face.begin() + static_cast<std::ptrdiff_t>(random() % face.size()), face.end());
  }
  const double sharpness = centre == Centre::semi_sharp ? 1.5 : 10;
  const std::uint32_t edges = centre == Centre::crease || centre == Centre::semi_sharp ? 2
                              : centre == Centre::dart                                 ? 1
                              : centre == Centre::corner                               ? 3
                                                                                       : 0;
  for (std::uint32_t e = 0; e < edges; ++e) {
    const std::uint32_t i = e * n / std::max(2u, edges) * a_face;
    mesh.creases.push_back({0, at(1, i), sharpness});
    if (centre == Centre::crease) mesh.creases.push_back({at(1, i), at(2, i), sharpness});
  }
  return mesh;
}

struct Cones {
  std::vector<PatchEnclosure> pieces;
  std::size_t found = 0;
};
Cones cones_of(const Surface& surface, unsigned level) {
  Cones cones;
  BoundOptions options;
  options.level = level;
  options.normals = true;
  bound(surface, options,
        [&](const PatchEnclosure& piece) {
          cones.pieces.push_back(piece);
          cones.found += piece.normals ? 1 : 0;
        },
        {.threads = 1});
  return cones;
}

// The parameter of its patch that a place in a quad, or in a triangle, has; outside if it is not there.
TriangleParameter in_patch(bool triangular, std::uint32_t part, double u, double v) {
  if (triangular) return {u, v};
  return part % 2 == 0 ? TriangleParameter{u - v, v} : TriangleParameter{v - u, 1 - v};
}

PiecePath path_of(const std::string& piece) {
  PiecePath path;
  for (const char digit : piece) path = path.child(static_cast<unsigned>(digit - '0'));
  return path;
}

// Is a parameter of a patch in a piece of it? Exact: all are dyadic.
bool in_piece(const PiecePath& path, TriangleParameter p) {
  const TriangleParameter a = to_face(path, {0, 0}), b = to_face(path, {1, 0}), c = to_face(path, {0, 1});
  const double u = ((p.u - a.u) * (c.v - a.v) - (p.v - a.v) * (c.u - a.u)) /
                   ((b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u));
  const double v = ((b.u - a.u) * (p.v - a.v) - (b.v - a.v) * (p.u - a.u)) /
                   ((b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u));
  return u >= 0 && v >= 0 && u + v <= 1;
}

struct Counts {
  std::size_t pieces = 0, cones = 0, samples = 0;
  std::vector<double> used;  // of each cone's angle, by all its samples
};

// All samples lie in the cones of the pieces that they are in.
void expect_contained(const Surface& surface, const Cones& cones,
                      const std::vector<oracle::NormalSample>& samples, const std::string& name,
                      Counts& counts) {
  const bool triangular = surface.traits().triangular;
  for (const PatchEnclosure& piece : cones.pieces) {
    ++counts.pieces;
    if (!piece.normals) continue;
    ++counts.cones;
    const PatchPlace place = piece.patch;
    double widest = 0;
    for (const oracle::NormalSample& sample : samples) {
      if (sample.face != place.owner || (!triangular && sample.part != place.part / 2)) continue;
      if (!in_piece(path_of(piece.piece), in_patch(triangular, place.part, sample.u, sample.v))) continue;
      ++counts.samples;
      const Vector3 normal{sample.normal[0], sample.normal[1], sample.normal[2]};
      const double angle = angle_between(piece.normals->axis, normal);
      widest = std::max(widest, angle);
      EXPECT_LE(angle, piece.normals->angle + sample.error)
          << name << ", face " << place.owner << " part " << place.part << " piece " << piece.piece << " at "
          << sample.u << " " << sample.v;
    }
    if (widest > 0) counts.used.push_back(widest / piece.normals->angle);
    if (::testing::Test::HasFailure()) return;
  }
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

// SNUG_NORMAL_TRIALS: how often each pair of cases is drawn.
TEST(normals, cones_contain_normals_of_refined_meshes_and_rings) {
  const int trials = static_cast<int>(testing::number_of("SNUG_NORMAL_TRIALS", 1));
  std::mt19937_64 random(1);
  constexpr std::array amounts{0.0, 0.1, 0.5, 1.5};
  for (const Centre centre : centres) {
    Counts counts;
    for (const auto scheme : {oracle::PrimalScheme::loop, oracle::PrimalScheme::catmull_clark}) {
      const bool loop = scheme == oracle::PrimalScheme::loop;
      for (std::uint32_t n = centre == Centre::boundary ? 1 : 3; n <= 12; ++n) {
        for (const double amount : amounts) {
          // All pairs of scheme, centre, valence and amount, a quarter of all combinations.
          const std::uint32_t turn = (n + static_cast<std::uint32_t>(centre) + 2 * loop) % 4;
          if (amount != amounts[turn] && trials == 1) continue;
          for (int trial = 0; trial < trials; ++trial) {
            const oracle::TaggedMesh mesh = fan(n, loop, centre, amount, random);
            oracle::Rules rules;
            rules.scheme = scheme;
            const Surface surface =
                testing::public_surface(testing::control_mesh(mesh), testing::options_of(rules));
            auto samples = oracle::sample_normals(mesh, rules, 3);
            const auto near = oracle::sample_normals_near(mesh, rules, 0, 25);
            EXPECT_GE(near.size(), 50U);
            samples.insert(samples.end(), near.begin(), near.end());
            const std::string name = std::string(loop ? "loop " : "catmark ") + std::to_string(n) +
                                     ", centre " + std::to_string(static_cast<int>(centre)) + ", " +
                                     std::to_string(amount);
            for (const unsigned level : {0u, 1u, 2u}) {
              expect_contained(surface, cones_of(surface, level), samples, name, counts);
              if (HasFailure()) return;
            }
          }
        }
      }
    }
    std::printf("centre %d: %zu of %zu pieces have a cone, %zu samples, of the angle %.3f is used\n",
                static_cast<int>(centre), counts.cones, counts.pieces, counts.samples, median(counts.used));
    EXPECT_GT(2 * counts.cones, counts.pieces);
    EXPECT_GT(median(counts.used), 0.8);
  }
}

TEST(normals, cones_contain_normals_of_refined_dual_meshes) {
  namespace meshes = oracle::meshes;
  std::mt19937_64 random(2);
  std::size_t samples = 0, cones = 0;
  for (const auto scheme : {oracle::DualScheme::doo_sabin, oracle::DualScheme::midedge}) {
    for (std::uint32_t n = 3; n <= 12; ++n) {
      for (const double amount : {0.0, 0.1, 0.4}) {
        // Half of the combinations have all pairs.
        const bool odd = (n % 2 == 1) != ((amount == 0.1) != (scheme == oracle::DualScheme::midedge));
        if (odd != (n / 2 % 2 == 1) && !testing::long_check()) continue;
        const oracle::TaggedMesh mesh =
            meshes::shaken(n % 2 == 0 ? meshes::prism(n) : meshes::pyramid(n), amount, random);
        const Surface surface(
            testing::control_mesh(mesh),
            {.scheme = scheme == oracle::DualScheme::doo_sabin ? Scheme::doo_sabin : Scheme::midedge});
        const Cones found = cones_of(surface, 1);
        cones += found.found;
        for (const oracle::DualNormal& sample : oracle::sample_dual_normals(mesh, scheme, 4)) {
          // In a cone of one of its owners, unless one of their pieces has none.
          bool inside = false;
          for (const PatchEnclosure& piece : found.pieces) {
            const std::uint32_t owner = piece.patch.owner;
            if (std::find(sample.owners.begin(), sample.owners.end(), owner) == sample.owners.end()) continue;
            const Vector3 normal{sample.normal[0], sample.normal[1], sample.normal[2]};
            inside =
                inside || !piece.normals ||
                std::min(angle_between(piece.normals->axis, normal),
                         angle_between(piece.normals->axis, -normal)) <= piece.normals->angle + sample.error;
          }
          ++samples;
          EXPECT_TRUE(inside) << n << " " << amount;
        }
        if (HasFailure()) return;
      }
    }
  }
  EXPECT_GT(samples, 5000U);
  EXPECT_GT(cones, 500U);
}

// Every scheme with every tag and boundary rule, by evaluation, towards corners of pieces, too.
TEST(normals, cones_contain_what_evaluation_gives) {
  std::mt19937_64 random(3);
  std::size_t samples = 0, cones = 0;
  testing::for_each_surface(4, [&](const testing::NamedSurface& named) {
    const Surface surface = testing::public_surface(named.surface.mesh(), named.surface.options());
    const LimitSurface& limit = surface.data()->limit();
    const Cones found = cones_of(surface, 1);
    for (const PatchEnclosure& piece : found.pieces) {
      if (!piece.normals) continue;
      ++cones;
      const Patch patch = limit.patch(PatchId(limit.patches_of(piece.patch.owner).begin + piece.patch.part));
      for (int i = 0; i < 24; ++i) {
        TriangleParameter at = testing::random_parameter(random);
        if (i % 2 == 0) {
          const double shrink = std::exp2(-static_cast<double>(random() % 26));
          at = {shrink * at.u, shrink * at.v};
          const auto turns = random() % 3;
          if (turns == 1) at = {1 - at.u - at.v, at.u};
          if (turns == 2) at = {at.v, 1 - at.u - at.v};
        }
        const LimitFrame frame = limit_frame(patch, to_face(path_of(piece.piece), at));
        EXPECT_TRUE(frame.normal || !frame.differentiable) << named.name;
        if (!frame.normal || !frame.normal_error) continue;
        ++samples;
        EXPECT_LE(angle_between(piece.normals->axis, *frame.normal),
                  piece.normals->angle + 2 * *frame.normal_error)
            << named.name << " at " << at.u << " " << at.v;
      }
      if (::testing::Test::HasFailure()) return;
    }
  });
  EXPECT_GT(cones, 1000U);
  EXPECT_GT(samples, 20'000U);
}

// Bodies of triangles, quads and pentagons with borders and creases: at corners, and just beside them, evaluation gives one normal, and
// cones hold it. Tangents there are those of faces that are quads one step on.
TEST(normals, at_creases_and_borders_of_mixed_polygons_are_limits_of_those_beside) {
  namespace meshes = oracle::meshes;
  std::mt19937_64 random(5);
  std::size_t corners = 0, in_cones = 0;
  for (int trial = 0; trial < static_cast<int>(testing::fewer(40)); ++trial) {
    // No sectors of more than three faces: the tangents of wide ones do not span what is near.
    const auto n = static_cast<std::uint32_t>(3 + trial % 5);
    oracle::TaggedMesh mesh =
        meshes::shaken(trial % 2 == 0 ? meshes::prism(n) : meshes::pyramid(3 + n % 2), 0.2, random);
    for (std::size_t k = random() % 3; k > 0; --k)
      mesh.polygons.erase(mesh.polygons.begin() +
                          static_cast<std::ptrdiff_t>(random() % mesh.polygons.size()));
    for (const auto& face : mesh.polygons) {
      for (std::size_t k = 0; k < face.size(); ++k) {
        if (random() % 4 == 0)
          mesh.creases.push_back({face[k], face[(k + 1) % face.size()], random() % 3 == 0 ? 1.5 : 10});
      }
    }
    const Surface surface(testing::control_mesh(mesh),
                          {.scheme = Scheme::catmark, .boundary = BoundaryRule::edge_only});
    const LimitSurface& limit = surface.data()->limit();
    for (const PatchEnclosure& piece : cones_of(surface, 1).pieces) {
      const Patch patch = limit.patch(PatchId(limit.patches_of(piece.patch.owner).begin + piece.patch.part));
      for (const TriangleParameter at : {TriangleParameter{0, 0}, {1, 0}, {0, 1}}) {
        const LimitFrame frame = limit_frame(patch, to_face(path_of(piece.piece), at));
        if (!frame.normal) continue;
        if (piece.normals && frame.normal_error) {
          ++in_cones;
          EXPECT_LE(angle_between(piece.normals->axis, *frame.normal),
                    piece.normals->angle + 2 * *frame.normal_error)
              << "trial " << trial;
        }
        // On a way into the piece normals come nearer, if slowly (1 over the number of rings, at sharp corners of two quads).
        const auto off_at = [&](int level) {
          const double in = std::ldexp(1, -level) / 3;
          const LimitFrame beside = limit_frame(
              patch, to_face(path_of(piece.piece), {at.u + in * (1 - 3 * at.u), at.v + in * (1 - 3 * at.v)}));
          return beside.normal ? angle_between(*beside.normal, *frame.normal) : 0;
        };
        ++corners;
        EXPECT_LE(off_at(20), std::max(1e-3, 0.75 * off_at(8)))
            << "trial " << trial << ", owner " << piece.patch.owner << " at " << at.u << " " << at.v
            << ", piece " << piece.piece;
      }
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(corners, 2000U);
  EXPECT_GT(in_cones, 500U);
}

}  // namespace
}  // namespace snug::normals_test
