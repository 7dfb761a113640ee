// to_brep(): what faces, edges and shells are, that they are as near to the surface as they say, and what is refused.

#include <snug/brep.h>
#include <snug/distance.h>
#include <snug/measure.h>

#include <gtest/gtest.h>
#include <oracle/spline_twin.h>
#include <oracle/tagged_shapes.h>
#include <testing/counts.h>
#include <testing/surfaces.h>
#include <testing/tagged.h>

#include <cmath>
#include <map>
#include <random>
#include <set>

namespace snug::brep_test {
namespace {

namespace meshes = oracle::meshes;

Point3 point_of(const SplineSurface& s, double u, double v) {
  const auto p = oracle::spline_point(s.degree, s.u_knots, s.v_knots, s.points, u, v);
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

double distance_of(const Point3& a, const Point3& b) { return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z); }

// Of a surface by the flux through it, by Gauss points on each span.
double flux(const SplineSurface& s) {
  constexpr double nodes[] = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                              0.8611363115940526};
  constexpr double weights[] = {0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                0.3478548451374538};
  double sum = 0;
  constexpr double h = 1e-5;
  for (std::size_t j = 0; j + 1 < s.v_knots.size(); ++j) {
    for (std::size_t i = 0; i + 1 < s.u_knots.size(); ++i) {
      const double du = s.u_knots[i + 1] - s.u_knots[i], dv = s.v_knots[j + 1] - s.v_knots[j];
      if (du == 0 || dv == 0) continue;
      for (int a = 0; a < 4; ++a) {
        for (int b = 0; b < 4; ++b) {
          const double u = s.u_knots[i] + du * (nodes[a] + 1) / 2, v = s.v_knots[j] + dv * (nodes[b] + 1) / 2;
          const Point3 p = point_of(s, u, v), pu = point_of(s, u + h * du, v),
                       mu = point_of(s, u - h * du, v), pv = point_of(s, u, v + h * dv),
                       mv = point_of(s, u, v - h * dv);
          const double x[] = {(pu.x - mu.x) / (2 * h), (pu.y - mu.y) / (2 * h), (pu.z - mu.z) / (2 * h)};
          const double y[] = {(pv.x - mv.x) / (2 * h), (pv.y - mv.y) / (2 * h), (pv.z - mv.z) / (2 * h)};
          sum += weights[a] * weights[b] / 4 / 3 *
                 (p.x * (x[1] * y[2] - x[2] * y[1]) + p.y * (x[2] * y[0] - x[0] * y[2]) +
                  p.z * (x[0] * y[1] - x[1] * y[0]));
        }
      }
    }
  }
  return sum;
}

// Each edge is used once each way, or once on the border; loops close; ends of curves are vertices.
void expect_joined(const Brep& brep) {
  std::vector<std::array<int, 2>> uses(brep.edges.size(), {0, 0});
  for (const Brep::Face& face : brep.faces) {
    ASSERT_GE(face.loop.size(), 4u);
    std::set<std::uint32_t> own;  // no face is beside itself
    for (const Brep::Side& side : face.loop) EXPECT_TRUE(own.insert(side.edge).second);
    for (std::size_t k = 0; k < face.loop.size(); ++k) {
      const Brep::Side &here = face.loop[k], &next = face.loop[(k + 1) % face.loop.size()];
      ++uses[here.edge][here.reversed ? 1 : 0];
      EXPECT_EQ(brep.edges[here.edge].vertices[here.reversed ? 0 : 1],
                brep.edges[next.edge].vertices[next.reversed ? 1 : 0]);
    }
  }
  for (const Brep::Shell& shell : brep.shells) {
    for (std::uint32_t f = shell.begin; f < shell.end; ++f) {
      for (const Brep::Side& side : brep.faces[f].loop) {
        const auto [forward, backward] = uses[side.edge];
        EXPECT_LE(forward, 1);
        EXPECT_LE(backward, 1);
        if (shell.closed) {
          EXPECT_EQ(forward + backward, 2);
        }
      }
    }
  }
  for (const Brep::Edge& edge : brep.edges) {
    EXPECT_LE(distance_of(edge.curve.points.front(), brep.vertices[edge.vertices[0]]), brep.gap);
    EXPECT_LE(distance_of(edge.curve.points.back(), brep.vertices[edge.vertices[1]]), brep.gap);
  }
}

// Edges lie on the borders of the faces beside them: their middles are found there.
void expect_edges_on_faces(const Brep& brep) {
  for (const Brep::Face& face : brep.faces) {
    const SplineSurface& s = face.surface;
    const double w = s.u_knots.back(), h = s.v_knots.back();
    for (const Brep::Side& side : face.loop) {
      const SplineCurve& curve = brep.edges[side.edge].curve;
      const auto basis = oracle::spline_basis(curve.knots, curve.degree, curve.knots.back() / 2);
      Point3 middle{};
      for (std::size_t i = 0; i < basis.size(); ++i) {
        const auto b = static_cast<double>(basis[i]);
        middle = {middle.x + b * curve.points[i].x, middle.y + b * curve.points[i].y,
                  middle.z + b * curve.points[i].z};
      }
      double nearest = INFINITY;
      for (int k = 0; k <= 32 * 8; ++k) {
        const double t = k / 256.0;
        for (const Point3& p :
             {point_of(s, t * w, 0), point_of(s, t * w, h), point_of(s, 0, t * h), point_of(s, w, t * h)})
          nearest = std::min(nearest, distance_of(p, middle));
      }
      EXPECT_LE(nearest, 0.02);
    }
  }
}

TEST(brep, faces_are_as_near_as_they_say_with_every_tag_and_rule) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t made = 0, refused = 0, complete = 0;
  std::size_t number = 0;
  for (const testing::TaggedCase& c : testing::tagged_cases(oracle::PrimalScheme::catmull_clark, 11)) {
    if (number++ % 3 != 0 && !testing::long_check()) continue;
    SCOPED_TRACE(c.name + ", " + testing::text_of(c.rules));
    std::optional<Surface> surface;
    Brep brep;
    try {
      surface = testing::public_surface(testing::control_mesh(c.mesh, c.rules), testing::options_of(c.rules));
      brep = to_brep(*surface, {.error = 0.002 * surface->size()}, {.threads = 1});
    } catch (const InputError& error) {
      EXPECT_NE(error.problem(), InputProblem::value) << error.what();
      ++refused;
      continue;
    }
    ++made;
    complete += brep.complete ? 1 : 0;
    expect_joined(brep);
    EXPECT_LE(brep.gap, 1e-12) << c.name;
    if (made % 5 == 0) expect_edges_on_faces(brep);
    for (const Brep::Face& face : brep.faces) {
      EXPECT_LE(face.error, brep.error);
      for (int k = 0; k < 2; ++k) {
        const double u = unit(random) * face.surface.u_knots.back(),
                     v = unit(random) * face.surface.v_knots.back();
        const ClosestPoint found = closest_point(*surface, point_of(face.surface, u, v), {.absolute = 1e-7});
        EXPECT_LE(found.distance.lower, face.error + 1e-12);
      }
    }
    if (::testing::Test::HasFailure()) return;
  }
  EXPECT_GE(made, number / 4);
  EXPECT_GE(complete, made * 9 / 10);
  EXPECT_GE(refused, 1u);  // books, moebius strips
}

TEST(brep, of_a_solid_bounds_its_volume) {
  for (const auto& [name, mesh] :
       {std::pair{"cube", meshes::cube()}, {"prism", meshes::prism(5)}, {"pyramid", meshes::pyramid(7)}}) {
    for (const Scheme scheme : {Scheme::catmark, Scheme::doo_sabin, Scheme::bilinear}) {
      SCOPED_TRACE(std::string(name) + ", " + name_of(scheme));
      const Surface surface(testing::control_mesh(mesh), {.scheme = scheme});
      const Brep brep = to_brep(surface, {.error = 5e-3});
      EXPECT_TRUE(brep.complete);
      ASSERT_EQ(brep.shells.size(), 1u);
      EXPECT_TRUE(brep.shells[0].closed);
      EXPECT_EQ(brep.vertices.size() - brep.edges.size() + brep.faces.size(), 2u);
      double volume = 0, area = 0;
      for (const Brep::Face& face : brep.faces) volume += flux(face.surface);
      const Measures exact = measure(surface);
      area = exact.area.upper;
      EXPECT_GE(volume, exact.volume->lower - 2 * brep.error * area - 1e-6);
      EXPECT_LE(volume, exact.volume->upper + 2 * brep.error * area + 1e-6);
      EXPECT_GT(volume, 0);
    }
  }
}

TEST(brep, tips_come_nearer_and_breaks_become_flatter) {
  const Surface surface(testing::control_mesh(meshes::cube()), {.scheme = Scheme::catmark});
  std::size_t spans = 0;
  for (const double error : {1e-2, 1e-3, 1e-4, 1e-6}) {
    const Brep brep = to_brep(surface, {.error = error});
    EXPECT_TRUE(brep.complete);
    EXPECT_LE(brep.error, error);
    EXPECT_GT(brep.spans, spans);
    spans = brep.spans;
  }
  const Brep flat = to_brep(surface, {.error = 1e-2, .max_angle = 0.05});
  EXPECT_TRUE(flat.complete);
  EXPECT_LE(flat.break_angle, 0.05);
  EXPECT_GT(to_brep(surface, {.error = 1e-2}).break_angle, 0.05);
}

// Of a torus of regular quads rows become faces; none is beside itself.
TEST(brep, regular_quads_in_rows_and_columns_are_one_face) {
  ControlMesh torus;
  constexpr std::uint32_t m = 12, n = 8;
  for (std::uint32_t i = 0; i < m; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const double u = 6.283185307179586 * i / m, v = 6.283185307179586 * j / n;
      torus.points.push_back({(3 + std::cos(v)) * std::cos(u), (3 + std::cos(v)) * std::sin(u), std::sin(v)});
    }
  }
  for (std::uint32_t i = 0; i < m; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t k = (i + 1) % m, l = (j + 1) % n;
      torus.add_face(
          std::array{VertexId(i * n + j), VertexId(k * n + j), VertexId(k * n + l), VertexId(i * n + l)});
    }
  }
  const Surface surface(torus, {.scheme = Scheme::catmark});
  const Brep brep = to_brep(surface);
  EXPECT_LE(brep.faces.size(), 6u);
  EXPECT_EQ(brep.spans, std::size_t{m} * n);
  EXPECT_LE(brep.error, 1e-13);
  EXPECT_EQ(brep.vertices.size() + brep.faces.size(), brep.edges.size());
  expect_joined(brep);
}

TEST(brep, hollows_are_told_and_solids_turned_outward) {
  oracle::TaggedMesh cube = meshes::cube(), inner = cube, inside_out = cube;
  for (auto& polygon : inside_out.polygons) std::reverse(polygon.begin(), polygon.end());
  for (auto& p : inner.points) {
    for (auto& x : p) x = 0.4 + 0.2 * x;
  }
  for (auto& polygon : inner.polygons) {
    std::reverse(polygon.begin(), polygon.end());
    for (auto& v : polygon) v += 8;
  }
  oracle::TaggedMesh both = cube;
  both.points.insert(both.points.end(), inner.points.begin(), inner.points.end());
  both.polygons.insert(both.polygons.end(), inner.polygons.begin(), inner.polygons.end());
  const Brep hollow = to_brep(Surface(testing::control_mesh(both), {.scheme = Scheme::catmark}));
  ASSERT_EQ(hollow.shells.size(), 2u);
  EXPECT_FALSE(hollow.shells[0].void_of);
  EXPECT_EQ(hollow.shells[1].void_of, 0u);
  double volume = 0;
  const Brep turned = to_brep(Surface(testing::control_mesh(inside_out), {.scheme = Scheme::catmark}));
  for (const Brep::Face& face : turned.faces) volume += flux(face.surface);
  EXPECT_GT(volume, 0);
  expect_joined(turned);
}

std::string refusal(const oracle::TaggedMesh& mesh, Scheme scheme, const BrepOptions& options = {}) {
  try {
    static_cast<void>(to_brep(Surface(testing::control_mesh(mesh), {.scheme = scheme}), options));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(brep, says_what_it_cannot_do) {
  EXPECT_NE(refusal(meshes::triangulated(meshes::cube()), Scheme::loop).find("schemes of quads"),
            std::string::npos);
  EXPECT_NE(refusal(meshes::book(4), Scheme::catmark).find("an edge"), std::string::npos);
  EXPECT_NE(refusal(meshes::moebius(5), Scheme::catmark).find("same direction"), std::string::npos);
  EXPECT_NE(refusal(meshes::cube(), Scheme::catmark, {.error = 0}).find("not a positive"), std::string::npos);
  EXPECT_NE(refusal(meshes::cube(), Scheme::catmark, {.error = 1e-14}).find("the least is"),
            std::string::npos);
  EXPECT_NE(refusal(meshes::cube(), Scheme::catmark, {.max_angle = 91}).find("degrees"), std::string::npos);
}

TEST(brep, does_not_depend_on_threads) {
  const Surface surface(testing::control_mesh(meshes::prism(5)), {.scheme = Scheme::catmark});
  EXPECT_EQ(format_step(to_brep(surface, {}, {.threads = 1})),
            format_step(to_brep(surface, {}, {.threads = 3})));
}

}  // namespace
}  // namespace snug::brep_test
