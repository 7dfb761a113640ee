// Evaluation of Catmull-Clark, creases, boundaries, polygons and the dual schemes: positions against the
// twins and against the general evaluation, derivatives and normals against differences.

#include <snug/surface/evaluate.h>

#include <gtest/gtest.h>
#include <oracle/polygon_twin.h>
#include <snug/surface/unscale.h>
#include <testing/scheme_surfaces.h>

#include <cmath>
#include <iostream>
#include <map>
#include <optional>

namespace snug::schemes_evaluate_test {
namespace {

using testing::for_each_patch;
using testing::for_each_surface;
using testing::NamedSurface;
using testing::random_parameter;
using testing::unit;

TEST(patch_evaluator, positions_agree_with_the_twin) {
  std::size_t count = 0;
  for (const auto scheme : {oracle::PrimalScheme::catmull_clark, oracle::PrimalScheme::loop}) {
    const bool loop = scheme == oracle::PrimalScheme::loop;
    const auto library = std::make_shared<BoundsCache>();
    for (const testing::TaggedCase& c : testing::tagged_cases(scheme, 91)) {
      const LimitSurface surface(testing::control_mesh(c.mesh, c.rules), testing::options_of(c.rules),
                                 library);
      std::map<std::size_t, PatchEvaluator> evaluators;
      SurfaceEvaluator whole(surface);
      for (const oracle::FaceSample& s : oracle::sample_faces(c.mesh, c.rules, 3)) {
        const Place place{s.face, s.part, s.u, s.v};
        std::array<BoundedPoint, 1> alone;
        whole.positions(std::array{place}, alone);
        const SurfacePoint same = whole(place);
        for (const BoundedPoint& point : {alone[0], BoundedPoint{same.point, same.error}}) {
          for (std::size_t k = 0; k < 3; ++k) {
            ASSERT_LE(std::fabs(point.position[k] - s.position[k]), point.error + s.error)
                << c.name << ", " << testing::text_of(c.rules) << ", face " << s.face << "." << s.part
                << " at " << s.u << ", " << s.v;
          }
          ASSERT_LE(point.error, 1e-12 * surface.size()) << c.name;
        }
        for (unsigned half = 0; half < (loop ? 1u : 2u); ++half) {
          if (!loop && (half == 0 ? s.v > s.u : s.u > s.v)) continue;
          const TriangleParameter at = loop        ? TriangleParameter{s.u, s.v}
                                       : half == 0 ? TriangleParameter{s.u - s.v, s.v}
                                                   : TriangleParameter{s.v - s.u, 1 - s.v};
          const std::size_t patch = surface.patches_of(s.face).begin + (loop ? 0 : 2 * s.part + half);
          const PatchEvaluator& evaluator =
              evaluators.try_emplace(patch, surface, PatchId(patch)).first->second;
          const SurfacePoint point = evaluator(at);
          ++count;
          for (std::size_t k = 0; k < 3; ++k) {
            ASSERT_LE(std::fabs(point.point[k] - s.position[k]), point.error + s.error)
                << c.name << ", " << testing::text_of(c.rules) << ", patch " << patch << " at " << at.u
                << ", " << at.v;
          }
          ASSERT_LE(point.error, 1e-12 * surface.size()) << c.name;
        }
      }
    }
  }
  EXPECT_GT(count, 100'000u);
}

// Derivatives of a half along its own parameters by those of its quad, and the other way round.
std::array<Vector3, 2> along_half(const std::array<Vector3, 2>& of_quad, bool triangular) {
  return {of_quad[0], triangular ? of_quad[1] : of_quad[0] + of_quad[1]};
}

void expect_same_frame(const LimitFrame& a, const LimitFrame& b, bool triangular, const std::string& where) {
  ASSERT_LE(max_abs(a.point.relative - b.point.relative), a.point.error + b.point.error) << where;
  ASSERT_EQ(a.differentiable, b.differentiable) << where;
  if (!a.differentiable || !b.tangent_error) return;
  ASSERT_TRUE(a.tangent_error) << where;
  const auto tangents = along_half(a.tangents, triangular);
  for (std::size_t t = 0; t < 2; ++t) {
    ASSERT_LE(max_abs(tangents[t] - b.tangents[t]), 2 * *a.tangent_error + *b.tangent_error) << where;
  }
}

// Steps of whole quads against steps of halves; parameters are multiples of 2^-50, so that those of halves are
// exact.
TEST(limit_evaluator, agrees_with_the_general_evaluation) {
  std::mt19937_64 random(92);
  std::size_t count = 0;
  for_each_surface(92, [&](const NamedSurface& s) {
    const bool triangular = s.surface.rules().triangular();
    for_each_patch(s.surface, [&](PatchId p) {
      const Patch patch = s.surface.patch(p);
      LimitEvaluator kept(patch);
      for (int trial = 0; trial < 16; ++trial) {
        TriangleParameter at = random_parameter(random);
        // Some near a corner, some on an edge.
        if (trial >= 6) at = {std::ldexp(at.u, -static_cast<int>(random() % 48)), at.v * (1 - at.u)};
        if (trial % 4 == 3) at.v = 0;
        const auto rounded = [](double x) { return std::floor(x * 0x1p50) * 0x1p-50; };
        at = {rounded(at.u), rounded(at.v)};
        if (trial % 8 == 7) at = {at.v, 1 - at.v};
        if (!(at.u + at.v <= 1)) continue;
        const std::string where = s.name + ", patch " + std::to_string(p.index()) + " at " +
                                  std::to_string(at.u) + ", " + std::to_string(at.v);
        const LimitFrame frame = kept.frame({0, 0, triangular ? at.u : at.u + at.v, at.v});
        expect_same_frame(frame, limit_frame(patch, at), triangular, where);
        ASSERT_LE(frame.point.error, 1e-12 * s.surface.scale().apply(s.surface.size())) << s.name;
        ++count;
        if (triangular) continue;
        // The other half is turned by half a turn, and may have another origin.
        const Patch other = s.surface.patch(PatchId(p.index() ^ 1));
        LimitFrame turned = kept.frame({0, 0, 1 - (at.u + at.v), 1 - at.v});
        turned.point.relative = turned.point.relative + (patch.origin - other.origin);
        turned.point.error += 4 * unit_roundoff;
        for (Vector3& t : turned.tangents) t = -1.0 * t;
        expect_same_frame(turned, limit_frame(other, at), false, where + ", other half");
      }
    });
  });
  EXPECT_GT(count, testing::share(50'000));
}

// The quad's fourth corner, which neither half counts among its first three, by each of its other corners.
TEST(limit_evaluator, agrees_with_the_other_half_at_the_fourth_corner) {
  std::size_t count = 0;
  for_each_surface(97, [&](const NamedSurface& s) {
    // Two sheets that lie on each other have no common normal.
    if (s.surface.rules().triangular() || s.name.starts_with("same ways")) return;
    for (std::size_t p = 0; p < s.surface.patch_count(); p += 2) {
      if (!s.surface.has_patch(PatchId(p)) || !s.surface.has_patch(PatchId(p + 1))) continue;
      const std::string where = s.name + ", patch " + std::to_string(p);
      LimitEvaluator first(s.surface.patch(PatchId(p))), second(s.surface.patch(PatchId(p + 1)));
      for (const double far : {0.0, 0x1p-20, 0x1p-40, 0x1p-53}) {
        std::array<BoundedPoint, 1> a, b;
        first.points(std::array{Place{0, 0, far, 1 - far}}, a);
        second.points(std::array{Place{0, 0, 1 - far, far}}, b);
        ASSERT_LE(max_abs(a[0].position - b[0].position), a[0].error + b[0].error) << where;
        ++count;
      }
      const auto n = first.frame({0, 0, 0, 1}).normal, m = second.frame({0, 0, 1, 0}).normal;
      ASSERT_EQ(n.has_value(), m.has_value()) << where;
      if (n) {
        ASSERT_LT(length(*n - *m), 1e-8) << where;
      }
    }
  });
  EXPECT_GT(count, testing::share(4'000));
}

Vector3 difference(const SurfacePoint& a, const SurfacePoint& b, double h) {
  return (1 / h) * (a.point - b.point);
}

void expect_near(const Vector3& x, const Vector3& y, double slack, const std::string& where) {
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(x[k], y[k], slack) << where;
}

// Inside a patch, near its corners too; along the patch's own parameters and along those of its quad.
TEST(patch_evaluator, derivatives_agree_with_differences) {
  std::mt19937_64 random(93);
  for_each_surface(93, [&](const NamedSurface& s) {
    for_each_patch(s.surface, [&](PatchId p) {
      const PatchEvaluator evaluator(s.surface, p);
      for (const double distance : {0.5, 0x1p-8}) {
        const double u = distance * (0.1 + 0.4 * unit(random)), v = distance * (0.1 + 0.4 * unit(random));
        const std::size_t corner = random() % 3;
        const double w = 1 - u - v;
        const TriangleParameter at = corner == 0   ? TriangleParameter{u, v}
                                     : corner == 1 ? TriangleParameter{w, u}
                                                   : TriangleParameter{v, w};
        const double h = 1e-6 * distance;
        const SurfacePoint point = evaluator(at);
        const std::string where = s.name + ", patch " + std::to_string(p.index()) + " at " +
                                  std::to_string(at.u) + ", " + std::to_string(at.v);
        ASSERT_TRUE(point.differentiable) << where;
        const double slack = 1e-4 * s.surface.size();
        const auto shifted = [&](double du, double dv) {
          return evaluator(TriangleParameter{at.u + du, at.v + dv});
        };
        expect_near(point.tangents[0], difference(shifted(h, 0), shifted(-h, 0), 2 * h), slack, where);
        expect_near(point.tangents[1], difference(shifted(0, h), shifted(0, -h), 2 * h), slack, where);
        // Nearly parallel tangents lose digits.
        const double area = length(cross(point.tangents[0], point.tangents[1]));
        const bool upright = area > 1e-4 * length(point.tangents[0]) * length(point.tangents[1]);
        if (point.normal && upright) {
          EXPECT_NEAR(length(*point.normal), 1, 1e-12) << where;
          EXPECT_NEAR(dot(*point.normal, point.tangents[0]) / length(point.tangents[0]), 0, 1e-9) << where;
          EXPECT_NEAR(dot(*point.normal, point.tangents[1]) / length(point.tangents[1]), 0, 1e-9) << where;
          EXPECT_GT(dot(*point.normal, cross(point.tangents[0], point.tangents[1])), 0) << where;
        }
        if (s.surface.options().scheme == Scheme::loop) continue;
        // The same place on the quad: part 0 has the corners (0,0), (1,0), (1,1), part 1 (1,1), (0,1), (0,0).
        const auto [owner, part] = s.surface.place(p);
        const bool first = part % 2 == 0;
        const double x = first ? at.u + at.v : 1 - at.u - at.v, y = first ? at.v : 1 - at.v;
        const auto on_quad = [&](double dx, double dy) {
          return evaluate(s.surface, {owner, part / 2, x + dx, y + dy});
        };
        const SurfacePoint same = on_quad(0, 0);
        ASSERT_TRUE(same.differentiable) << where;
        expect_near(same.point - Point3{}, point.point - Point3{}, 1e-12 * s.surface.size(), where);
        expect_near(same.tangents[0], difference(on_quad(h, 0), on_quad(-h, 0), 2 * h), slack, where);
        expect_near(same.tangents[1], difference(on_quad(0, h), on_quad(0, -h), 2 * h), slack, where);
        if (!upright) continue;
        ASSERT_TRUE(same.normal && point.normal) << where;
        expect_near(*same.normal, *point.normal, 1e-7, where);
      }
    });
  });
}

// On the edges of a patch, from its own side: boundaries and creases among them.
TEST(patch_evaluator, derivatives_at_edges_agree_with_one_sided_differences) {
  std::mt19937_64 random(94);
  for_each_surface(94, [&](const NamedSurface& s) {
    for_each_patch(s.surface, [&](PatchId p) {
      const PatchEvaluator evaluator(s.surface, p);
      const double t = 0.1 + 0.8 * unit(random), h = 1e-5;
      const auto at = [&](double across, double along) {  // of the edges 01 and 02
        return std::array{evaluator(TriangleParameter{t + along, across}),
                          evaluator(TriangleParameter{across, t + along})};
      };
      const auto here = at(0, 0), near = at(h, 0), far = at(2 * h, 0), left = at(0, -h), right = at(0, h);
      for (std::size_t edge = 0; edge < 2; ++edge) {
        const std::string where = s.name + ", patch " + std::to_string(p.index()) + ", edge " +
                                  std::to_string(edge) + " at " + std::to_string(t);
        ASSERT_TRUE(here[edge].differentiable) << where;
        const double slack = 1e-3 * s.surface.size();
        const Vector3 across = (1 / (2 * h)) * (4.0 * (near[edge].point - here[edge].point) -
                                                (far[edge].point - here[edge].point));
        expect_near(here[edge].tangents[1 - edge], across, slack, where);
        expect_near(here[edge].tangents[edge], difference(right[edge], left[edge], 2 * h), slack, where);
      }
    });
  });
}

// At corners: what is regular has derivatives; elsewhere the normals beside come near the corner's own, if it
// has one.
TEST(patch_evaluator, corners_agree_with_what_is_beside_them) {
  std::size_t regular = 0, smooth = 0, without = 0;
  for_each_surface(95, [&](const NamedSurface& s) {
    // Left out: where two sheets lie on each other, or two faces share two edges.
    if (s.name.starts_with("same ways") || s.name.starts_with("back to back") ||
        s.name.starts_with("valence two")) {
      return;
    }
    for_each_patch(s.surface, [&](PatchId p) {
      const PatchEvaluator evaluator(s.surface, p);
      const Patch patch = s.surface.patch(p);
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const auto beside = [&](double u, double v) {  // from the corner
          return evaluator(corner == 0   ? TriangleParameter{u, v}
                           : corner == 1 ? TriangleParameter{1 - u - v, u}
                                         : TriangleParameter{v, 1 - u - v});
        };
        const std::string where =
            s.name + ", patch " + std::to_string(p.index()) + ", corner " + std::to_string(corner);
        const SurfacePoint point = beside(0, 0);
        if (point.differentiable) {
          ++regular;
          const double h = 0x1p-20;
          const Vector3 du = difference(beside(h, 0), point, h), dv = difference(beside(0, h), point, h);
          const std::array<Vector3, 2> t = point.tangents;
          const std::array<Vector3, 2> turned = corner == 0   ? t
                                                : corner == 1 ? std::array{t[1] - t[0], -1.0 * t[0]}
                                                              : std::array{-1.0 * t[1], t[0] - t[1]};
          expect_near(turned[0], du, 1e-3 * s.surface.size(), where);
          expect_near(turned[1], dv, 1e-3 * s.surface.size(), where);
          continue;
        }
        const auto normal_at = [&](int level) {
          const double h = std::ldexp(1.0, -level);
          return beside(0.3 * h, 0.4 * h).normal;
        };
        const CornerFan& fan = patch.kind->corner(patch.to_kind(corner));
        const bool slow = fan.faces() > 8;
        const auto near = normal_at(18);
        if (!point.normal) {
          ++without;
          continue;
        }
        ASSERT_TRUE(near) << where;
        ++smooth;
        // Left out: what comes near like 1 / level only, sharp corners of two quads and creases around one;
        // and creases around many, where a mode across shrinks no faster than the crease.
        if (!fan.closed && (fan.faces() > 3 || fan.faces() == (fan.sharp ? 2u : 1u))) continue;
        const double off = length(*near - *point.normal);
        EXPECT_LT(off, slow ? 1.0 : 0.2) << where;
      }
    });
  });
  std::cout << regular << " corners with derivatives, " << smooth << " with a normal, " << without
            << " without\n";
  EXPECT_GT(regular, 1000u);
  EXPECT_GT(smooth, 1000u);
  EXPECT_GT(without, 30u);
}

// The normal at vertex 12, in the middle of 4 by 4 quads, as each face around sees it.
std::vector<std::optional<Vector3>> normals_in_the_middle(oracle::TaggedMesh mesh, Scheme scheme) {
  std::mt19937_64 random(96);
  mesh = oracle::meshes::shaken(std::move(mesh), 0.2, random);
  if (scheme == Scheme::loop) mesh = oracle::meshes::triangulated(mesh);
  const LimitSurface surface(testing::control_mesh(mesh), {scheme}, std::make_shared<BoundsCache>());
  std::vector<std::optional<Vector3>> normals;
  for (std::size_t f = 0; f < surface.face_count(); ++f) {
    const auto face = surface.topology().face(FaceId(f));
    for (std::size_t k = 0; k < face.size(); ++k) {
      if (face[k] != VertexId(12u)) continue;
      const double u = k == 1 || k == 2 ? 1 : 0, v = k >= 2 ? 1 : 0;
      normals.push_back(
          evaluate(surface, {static_cast<std::uint32_t>(f), 0, scheme == Scheme::loop && k == 2 ? 0.0 : u, v})
              .normal);
    }
  }
  return normals;
}

std::size_t count_missing(const std::vector<std::optional<Vector3>>& normals) {
  return static_cast<std::size_t>(std::count(normals.begin(), normals.end(), std::nullopt));
}

TEST(patch_evaluator, says_where_there_is_no_normal) {
  for (const Scheme scheme : {Scheme::catmark, Scheme::loop}) {
    oracle::TaggedMesh mesh = oracle::meshes::quad_grid(4, 4);
    EXPECT_EQ(count_missing(normals_in_the_middle(mesh, scheme)), 0u);
    // A tip of a cone.
    mesh.corners = {{12, 10}};
    auto normals = normals_in_the_middle(mesh, scheme);
    EXPECT_EQ(count_missing(normals), normals.size());
    mesh.corners = {{12, 2.5}};  // smooth in the end
    EXPECT_EQ(count_missing(normals_in_the_middle(mesh, scheme)), 0u);
    mesh.corners.clear();
    mesh.creases = {{12, 13, 10}};  // a dart
    EXPECT_EQ(count_missing(normals_in_the_middle(mesh, scheme)), 0u);
    mesh.creases = {{12, 13, 10}, {11, 12, 10}};  // a crease: one normal on either side
    normals = normals_in_the_middle(mesh, scheme);
    EXPECT_EQ(count_missing(normals), 0u);
    std::size_t different = 0;
    for (const auto& n : normals) different += length(*n - *normals[0]) > 1e-3;
    EXPECT_EQ(different, normals.size() / 2);
    mesh.creases = {{12, 13, 10}, {12, 17, 10}};
    mesh.corners = {{12, 10}};  // sectors of one quad and of three
    if (scheme == Scheme::catmark) {
      EXPECT_EQ(count_missing(normals_in_the_middle(mesh, scheme)), 3u);
    }
  }
}

}  // namespace
}  // namespace snug::schemes_evaluate_test
