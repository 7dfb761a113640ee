// Bounds of pieces, in pairs of cases that other tests draw apart: every sort of kind in every
// disguise (scales to the ends of the doubles, far away, flat, needles, lines, points), by rows and by tables
// of both layouts, some levels down.
//
//   SNUG_PLACEMENTS=100000 build/release/bin/tests/sound_test --gtest_filter='pieces.*'
//
// runs it 21 times with other meshes.

#include <snug/surface/control_hull.h>

#include <snug/bvh/wide_node.h>
#include <snug/patch/evaluate.h>
#include <testing/disguised_surfaces.h>
#include <testing/pieces.h>

namespace snug::pieces_test {
namespace {

using Extended = std::array<long double, 3>;

long double dot(const Vector3& d, const Extended& x) {
  return static_cast<long double>(d.x) * x[0] + static_cast<long double>(d.y) * x[1] +
         static_cast<long double>(d.z) * x[2];
}
Extended minus(const Extended& x, const Point3& p) {
  return {x[0] - static_cast<long double>(p.x), x[1] - static_cast<long double>(p.y),
          x[2] - static_cast<long double>(p.z)};
}

// A limit point with a bound of what is wrong with its height along a vector of length 1.
struct Sample {
  Extended x;
  long double error;
};

std::vector<Sample> samples_of(const Patch& patch, std::mt19937_64& random) {
  std::vector<Sample> samples;
  for (int i = 0; i < 9; ++i) {
    TriangleParameter at = testing::random_parameter(random);
    if (i < 3) at = std::array<TriangleParameter, 3>{{{0, 0}, {1, 0}, {0, 1}}}[static_cast<std::size_t>(i)];
    if (i == 3) at.v = 0;
    if (i == 4) at.v = 1 - at.u;
    const RelativePoint point = limit_point(patch, at);
    Sample sample{{}, 1.75L * point.error};
    for (std::size_t k = 0; k < 3; ++k) {
      sample.x[k] = static_cast<long double>(patch.origin[k]) + point.relative[k];
      sample.error += 1e-18L * std::fabs(sample.x[k]);
    }
    samples.push_back(sample);
  }
  return samples;
}

void expect_holds(const testing::KnownPiece& known, const BoundingPoints& hull, const Vector3& direction,
                  const std::vector<Sample>& samples, const std::string& name) {
  const auto& [piece, heights, box] = known;
  const Vector3 normal = unit_normal(piece.offset.base);
  const std::array<Extent, 2> extents{extent_of(hull, direction), extent_of(piece.offset, direction)};
  for (const Sample& sample : samples) {
    const Extended from_box = minus(sample.x, box.centre);
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_LE(std::fabs(dot(box.axes[k], from_box)), box.half[k] + sample.error) << name;
    }
    const long double height = dot(normal, minus(sample.x, piece.offset.base[0]));
    ASSERT_LE(heights.lower, height + sample.error) << name;
    ASSERT_GE(heights.upper, height - sample.error) << name;
    for (const Extent& extent : extents) {
      ASSERT_LE(extent.lower, dot(direction, sample.x) + 2 * sample.error) << name;
      ASSERT_GE(extent.upper, dot(direction, sample.x) - 2 * sample.error) << name;
    }
  }
}

// The set in single precision is not apart from any of the points.
void expect_near(const Obb& box, const std::vector<Sample>& samples, const std::string& name) {
  const WideNode node({&box, 1});
  for (const Sample& sample : samples) {
    WideNode::Distances gaps;
    node.distances(Point3{static_cast<double>(sample.x[0]), static_cast<double>(sample.x[1]),
                          static_cast<double>(sample.x[2])},
                   static_cast<double>(2 * sample.error), gaps);
    ASSERT_LE(gaps[0], 0) << name;
  }
}

void expect_sound(const LimitSurface& surface, std::mt19937_64& random, const std::string& name,
                  std::size_t& pieces) {
  testing::Pieces rows(surface), tables(surface, BoundMethod::table);
  ControlHull hull;
  testing::for_each_patch(surface, [&](PatchId p) {
    if (random() % 6 != 0) return;
    const Vector3 direction{testing::unit(random) - 0.5, testing::unit(random) - 0.5,
                            testing::unit(random) - 0.5};
    const std::vector<Sample> whole = samples_of(surface.patch(p), random);
    hull.assign(surface, {&p, 1});
    const Extent extent = hull.extent(direction);
    for (const Sample& sample : whole) {
      ASSERT_LE(extent.lower, dot(direction, sample.x) + 2 * sample.error) << name;
      ASSERT_GE(extent.upper, dot(direction, sample.x) - 2 * sample.error) << name;
    }
    expect_near(hull.box(), whole, name);
    for (testing::Pieces* const maker : {&rows, &tables}) {
      const testing::KnownPiece known = maker->below(p, random() % 5, random);
      const std::vector<Sample> samples = samples_of(known.piece.patch, random);
      expect_holds(known, maker->hull(known), direction, samples, name);
      expect_near(known.box, samples, name);
      const OffsetTriangle& offset = known.piece.offset;
      expect_near(box_around(principal_axes(offset.base), std::span(&offset, 1)), samples, name);
      ++pieces;
    }
  });
}

TEST(pieces, of_all_kinds_in_all_disguises_are_in_what_queries_know_of_them) {
  std::size_t pieces = 0;
  testing::for_each_disguised_surface(
      81, [&](const LimitSurface& surface, const std::string& name, std::mt19937_64& random) {
        expect_sound(surface, random, name, pieces);
      });
  EXPECT_GT(pieces, 1'500u);
}

}  // namespace
}  // namespace snug::pieces_test
