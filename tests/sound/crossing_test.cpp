// The prism that a proof of contact rests on, for every sort of kind in every disguise, by rows and by
// tables: no border point of the piece is inside of the strips, no point of it above or below the planes, and
// what is inside of the strips is, seen along the normal, inside of the triangle of the limit corners.

#include <snug/search/crossing.h>

#include <snug/patch/evaluate.h>
#include <testing/disguised_surfaces.h>
#include <testing/pieces.h>

namespace snug::crossing_test {
namespace {

struct Counts {
  std::size_t pieces = 0, possible = 0, inside = 0;
};

Triangle thrice(const Point3& p) { return {p, p, p}; }

// Twice the area of a triangle as seen along n, in extended precision.
long double area(const Vector3& n, const Point3& p, const Point3& q, const Point3& r) {
  using Long = long double;
  const auto part = [&](double ni, double pj, double pk, double qj, double qk, double rj, double rk) {
    return static_cast<Long>(ni) * ((static_cast<Long>(qj) - pj) * (static_cast<Long>(rk) - pk) -
                                    (static_cast<Long>(qk) - pk) * (static_cast<Long>(rj) - pj));
  };
  return part(n.x, p.y, p.z, q.y, q.z, r.y, r.z) + part(n.y, p.z, p.x, q.z, q.x, r.z, r.x) +
         part(n.z, p.x, p.y, q.x, q.y, r.x, r.y);
}

void expect_sound(const testing::KnownPiece& known, std::mt19937_64& random, const std::string& name,
                  Counts& counts) {
  const Piece& piece = known.piece;
  const CrossingTest crossed(piece, known.heights);
  ++counts.pieces;
  if (!crossed.possible()) return;
  ++counts.possible;
  const auto point = [&](TriangleParameter at) {
    const RelativePoint limit = limit_point(piece.patch, at);
    return std::pair{piece.patch.origin + limit.relative,
                     1.75 * limit.error + 0x1p-52 * max_abs(piece.patch.origin - Point3{})};
  };
  for (int i = 0; i < 12; ++i) {
    const double t = i < 2 ? i : testing::unit(random);
    for (const TriangleParameter& at : {TriangleParameter{t, 0}, {1 - t, t}, {0, t}}) {
      const auto [x, error] = point(at);
      // Points within `error` of this one lie on the border: they cannot all be free.
      ASSERT_FALSE(crossed.holds(thrice(x), error)) << name;
    }
    const auto [x, error] = point(testing::random_parameter(random));
    const CrossingTest::Sides sides = crossed.sides(thrice(x), error);
    ASSERT_FALSE(sides.below || sides.above) << name;
  }
  const Triangle corners = limit_triangle(piece.patch).corners;
  const Vector3 normal = unit_normal(piece.offset.base);
  for (int i = 0; i < 12; ++i) {
    // In the triangle and beside it, and far along the normal.
    const double b = 1.6 * testing::unit(random) - 0.3, c = 1.6 * testing::unit(random) - 0.3;
    const Point3 x = corners[0] + b * (corners[1] - corners[0]) + c * (corners[2] - corners[0]) +
                     (testing::unit(random) - 0.5) * normal;
    if (!crossed.holds(thrice(x), 0)) continue;
    ++counts.inside;
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_GT(area(normal, corners[k], corners[(k + 1) % 3], x), 0) << name;
    }
  }
}

TEST(crossing, prisms_of_all_kinds_in_all_disguises_are_what_the_proof_needs) {
  Counts counts;
  testing::for_each_disguised_surface(
      91, [&](const LimitSurface& surface, const std::string& name, std::mt19937_64& random) {
        testing::Pieces rows(surface), tables(surface, BoundMethod::table);
        testing::for_each_patch(surface, [&](PatchId p) {
          if (random() % 6 != 0) return;
          for (testing::Pieces* const pieces : {&rows, &tables}) {
            expect_sound(pieces->below(p, random() % 6, random), random, name, counts);
          }
        });
      });
  std::printf("  %zu pieces, %zu with a prism, %zu points inside\n", counts.pieces, counts.possible,
              counts.inside);
  EXPECT_GT(counts.possible, counts.pieces / 4);
  EXPECT_GT(counts.inside, counts.possible);
}

}  // namespace
}  // namespace snug::crossing_test
