#include <snug/surface/batch_bounds.h>

#include <gtest/gtest.h>
#include <oracle/loop_twin.h>
#include <oracle/polygon_twin.h>
#include <snug/bounds/table_triangle.h>
#include <snug/search/piece.h>
#include <snug/surface/unscale.h>
#include <support/error.h>
#include <testing/containment.h>
#include <testing/patches.h>
#include <testing/tagged.h>

#include <cmath>
#include <limits>
#include <random>

namespace snug::batch_bounds_test {
namespace {

// Closed and open meshes with regular patches, extraordinary corners and boundaries; some patches flat.
std::vector<oracle::TwinMesh> twins() {
  std::mt19937_64 random(5);
  std::vector<oracle::TwinMesh> all{oracle::meshes::icosahedron(), oracle::meshes::grid(9, 7),
                                    oracle::meshes::bipyramid(9),
                                    oracle::meshes::grid(6, 6, oracle::Boundary::none)};
  all.push_back(oracle::meshes::disturbed(oracle::meshes::grid(9, 9), 12, 0.2, random));
  all.push_back(oracle::meshes::quartered(all[2]));
  return all;
}

void expect_near(const OffsetTriangle& actual, const OffsetTriangle& expected, double size) {
  for (std::size_t k = 0; k < 3; ++k) EXPECT_LT(max_abs(actual.base[k] - expected.base[k]), 1e-14 * size);
  EXPECT_NEAR(actual.radius, expected.radius, 1e-12 * expected.radius + 1e-13 * size);
}

// Tips have boxes in the frame of the patch, and stick out of the rest by up to 15 %, where those of single patches are refined.
// Few do.
class AboutAsWide {
 public:
  void expect(const OffsetTriangle& actual, const OffsetTriangle& single, double size) {
    EXPECT_LE(actual.radius, 1.19 * single.radius + 1e-13 * size);
    EXPECT_GE(actual.radius, 0.9 * single.radius - 1e-13 * size);
    all_ += actual.radius;
    singles_ += single.radius;
  }
  ~AboutAsWide() { EXPECT_LE(all_, 1.02 * singles_); }

 private:
  double all_ = 0, singles_ = 0;
};

TEST(batch_bounds, are_those_of_single_patches) {
  AboutAsWide widths;
  for (const oracle::TwinMesh& twin : twins()) {
    const LimitSurface surface = testing::surface_of(twin);
    for (const BoundMethod method : {BoundMethod::rows, BoundMethod::table}) {
      BatchBounds bounds(surface, method);
      std::vector<OffsetTriangle> out(bounds.patches().size());
      bounds.update(surface.mesh().points, out);
      BoundingPoints scratch;
      for (std::size_t i = 0; i < out.size(); ++i) {
        const PatchId f = bounds.patches()[i];
        const Piece piece = make_piece(surface.library(), f, surface.patch(f), scratch, method);
        const OffsetTriangle single = unscaled(piece.offset, surface.scale().inverse());
        if (method == BoundMethod::table || surface.kind(f).polynomial()) {
          expect_near(out[i], single, surface.size());
        } else {
          widths.expect(out[i], single, surface.size());
        }
      }
    }
  }
}

// Patches with extraordinary corners come in batches, too.
TEST(batch_bounds, of_irregular_patches_are_at_most_a_little_wider_than_of_single_ones) {
  std::mt19937_64 random(7);
  const oracle::TwinMesh twin = oracle::meshes::disturbed(oracle::meshes::grid(60, 60), 300, 0.2, random);
  const LimitSurface surface = testing::surface_of(twin);
  BatchBounds bounds(surface);
  std::vector<OffsetTriangle> out(bounds.patches().size());
  bounds.update(surface.mesh().points, out);
  std::vector<const OffsetTriangle*> of(surface.face_count(), nullptr);
  BoundingPoints scratch;
  AboutAsWide widths;
  std::size_t irregular = 0, same = 0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const PatchId f = bounds.patches()[i];
    of[f.index()] = &out[i];
    if (surface.kind(f).polynomial()) continue;
    const OffsetTriangle single = unscaled(make_piece(surface.library(), f, surface.patch(f), scratch).offset,
                                           surface.scale().inverse());
    widths.expect(out[i], single, surface.size());
    same += out[i].radius == single.radius;
    ++irregular;
  }
  EXPECT_GT(irregular, 1000u);
  EXPECT_LT(same, irregular / 2);  // the batch was there
  for (const oracle::LimitSample& s : oracle::sample_uniform(twin, 3)) {
    if (!of[s.face]) continue;
    const testing::Extended p{s.position[0], s.position[1], s.position[2]};
    ASSERT_TRUE(testing::within_radius(p, of[s.face]->base, of[s.face]->radius + 2 * s.error)) << s.face;
  }
}

TEST(batch_bounds, cover_the_limit_points_at_every_scale_and_place) {
  for (const double size : {1e-300, 1e-290, 1e-5, 1.0, 1e290}) {
    std::size_t count = 0;
    for (oracle::TwinMesh twin : twins()) {
      for (oracle::Point& p : twin.points) p = {size * (p[0] + 7), size * p[1], size * (p[2] - 3)};
      const LimitSurface surface = testing::surface_of(twin);
      for (const BoundMethod method : {BoundMethod::rows, BoundMethod::table}) {
        BatchBounds bounds(surface, method);
        std::vector<OffsetTriangle> out(bounds.patches().size());
        bounds.update(surface.mesh().points, out);
        std::vector<const OffsetTriangle*> of(surface.face_count(), nullptr);
        for (std::size_t i = 0; i < out.size(); ++i) of[bounds.patches()[i].index()] = &out[i];
        for (const oracle::LimitSample& s : oracle::sample_uniform(twin, 2)) {
          if (!of[s.face]) continue;
          const testing::Extended p{s.position[0], s.position[1], s.position[2]};
          EXPECT_TRUE(testing::within_radius(p, of[s.face]->base, of[s.face]->radius + 2 * s.error)) << size;
          ++count;
        }
      }
    }
    EXPECT_GT(count, 10'000u);
  }
}

TEST(batch_bounds, of_chosen_faces_come_in_their_order) {
  const LimitSurface surface = testing::surface_of(oracle::meshes::grid(9, 7));
  BatchBounds all(surface), some(surface, {PatchId(50), PatchId(3), PatchId(51)});
  std::vector<OffsetTriangle> of_all(all.patches().size()), of_some(3);
  all.update(surface.mesh().points, of_all);
  some.update(surface.mesh().points, of_some);
  EXPECT_EQ(of_some[0].base, of_all[50].base);
  EXPECT_EQ(of_some[1].base, of_all[3].base);
  EXPECT_EQ(of_some[2].radius, of_all[51].radius);
}

TEST(batch_bounds, follow_the_control_points_and_do_not_depend_on_threads) {
  std::mt19937_64 random(6);
  oracle::TwinMesh twin = oracle::meshes::disturbed(oracle::meshes::grid(30, 30), 60, 0.2, random);
  const LimitSurface surface = testing::surface_of(twin);
  BatchBounds bounds(surface);
  std::vector<OffsetTriangle> one(bounds.patches().size()), two = one, fresh = one;
  bounds.update(surface.mesh().points, one);
  for (oracle::Point& p : twin.points) p = {p[1] * 5, p[2] + 0.1 * p[0], p[0]};
  const LimitSurface moved = testing::surface_of(twin);
  bounds.update(moved.mesh().points, one, 1);
  bounds.update(moved.mesh().points, two, 2);
  BatchBounds(moved).update(moved.mesh().points, fresh);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].base, fresh[i].base);
    EXPECT_EQ(one[i].radius, fresh[i].radius);
    EXPECT_EQ(one[i].base, two[i].base);
    EXPECT_EQ(one[i].radius, two[i].radius);
  }
}

TEST(batch_bounds, refuse_points_that_are_not_finite) {
  const LimitSurface surface = testing::surface_of(oracle::meshes::grid(3, 3));
  BatchBounds bounds(surface);
  std::vector<OffsetTriangle> out(bounds.patches().size());
  std::vector<Point3> points = surface.mesh().points;
  points[5].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(bounds.update(points, out), InputError);
  points[5].y = std::numeric_limits<double>::infinity();
  EXPECT_THROW(bounds.update(points, out), InputError);
  bounds.update(surface.mesh().points, out);
  EXPECT_LT(out[0].radius, 1);
}

TEST(batch_bounds, pass_over_vertices_without_faces) {
  ControlMesh mesh = testing::control_mesh(oracle::meshes::icosahedron());
  mesh.points.insert(mesh.points.begin(), Point3{1e200, 0, 0});
  for (VertexId& v : mesh.face_vertices) v = VertexId(v.index() + 1);
  mesh.points.push_back({-1e200, 0, 0});
  const LimitSurface surface(mesh, {}, std::make_shared<BoundsCache>());
  BatchBounds bounds(surface);
  std::vector<OffsetTriangle> out(20);
  bounds.update(mesh.points, out);
  EXPECT_LT(out[7].radius, 0.2);
}

// Regular quads come in batches, without the split that single patches have.
TEST(batch_bounds, of_quads_contain_the_limit_and_are_a_little_wider_than_of_single_patches) {
  std::mt19937_64 random(3);
  std::size_t points = 0, wider = 0, patches = 0;
  for (const double amount : {0.0, 0.05, 0.3}) {
    for (const double size : {1e-300, 1.0, 1e300}) {
      oracle::TaggedMesh twin = oracle::meshes::shaken(oracle::meshes::quad_grid(9, 8), amount, random);
      for (oracle::Point& p : twin.points) {
        for (double& x : p) x *= size;
      }
      const oracle::Rules rules;
      const LimitSurface surface(testing::control_mesh(twin), testing::options_of(rules),
                                 std::make_shared<BoundsCache>());
      BatchBounds bounds(surface);
      std::vector<OffsetTriangle> out(bounds.patches().size());
      bounds.update(surface.mesh().points, out);
      BoundingPoints scratch;
      for (std::size_t i = 0; i < out.size(); ++i) {
        const PatchId p = bounds.patches()[i];
        const OffsetTriangle single = unscaled(
            make_piece(surface.library(), p, surface.patch(p), scratch).offset, surface.scale().inverse());
        EXPECT_GE(out[i].radius, single.radius * (1 - 1e-9) - 1e-13 * surface.size());
        EXPECT_LE(out[i].radius, 3 * single.radius + 1e-12 * surface.size());
        wider += out[i].radius > 1.0001 * single.radius;
        ++patches;
      }
      for (const oracle::FaceSample& s : oracle::sample_faces(twin, rules, 3)) {
        const std::size_t patch = 2 * s.face + (s.v <= s.u ? 0 : 1);
        const testing::Extended p{s.position[0], s.position[1], s.position[2]};
        EXPECT_TRUE(testing::within_radius(p, out[patch].base, out[patch].radius + 2 * s.error))
            << s.face << " at " << s.u << ", " << s.v;
        ++points;
      }
    }
  }
  EXPECT_GT(points, 40'000u);
  EXPECT_GT(wider, patches / 10);  // the batch was there
}

}  // namespace
}  // namespace snug::batch_bounds_test
