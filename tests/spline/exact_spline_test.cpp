// Faces in rational numbers: on regular lattices the limit surface at dyadic parameters is known exactly, by the masks alone, and so is
// the B-spline surface that is handed out. Their distance is never above the bound, roundings included.

#include <snug/spline/face_spline.h>
#include <snug/spline/hermite_face.h>
#include <snug/spline/quad_pieces.h>
#include <snug/surface/limit_surface.h>

#include <gtest/gtest.h>
#include <oracle/exact_vector.h>
#include <oracle/spline_twin.h>
#include <testing/counts.h>
#include <testing/tagged.h>

#include <map>
#include <random>

namespace snug::exact_spline_test {
namespace {

using oracle::exact_vectors::operator-;
using oracle::exact_vectors::dot;
using Exact = oracle::exact_vectors::Vector;

void add(Exact& sum, const mpq_class& weight, const Exact& p) {
  for (std::size_t k = 0; k < 3; ++k) sum[k] += weight * p[k];
}

// Control points of a lattice, refined as far as wanted.
class Lattice {
 public:
  enum class Masks { cubic, quadratic, loop };
  Lattice(const oracle::TaggedMesh& mesh, long columns, Masks masks)
      : mesh_(mesh), columns_(columns), masks_(masks) {}

  // After some steps, in steps of 2^-level.
  const Exact& point(int level, long x, long y) {
    const auto [found, added] = points_.try_emplace({level, x, y});
    if (!added) return found->second;
    Exact result{};
    if (level == 0) {
      result = oracle::exact_vectors::exact(mesh_.points[static_cast<std::size_t>(y * (columns_ + 1) + x)]);
    } else if (masks_ == Masks::loop) {
      result = loop_point(level, x, y);
    } else {
      for (const auto& [i, a] : row(x)) {
        for (const auto& [j, b] : row(y)) add(result, a * b, point(level - 1, i, j));
      }
    }
    return points_[{level, x, y}] = result;
  }
  // Of the limit surface.
  Exact limit(int level, long x, long y) {
    Exact sum{};
    if (masks_ == Masks::loop) {
      add(sum, mpq_class(1, 2), point(level, x, y));
      for (const auto& [i, j] : around) add(sum, mpq_class(1, 12), point(level, x + i, y + j));
      return sum;
    }
    // Quadratic: corners of the patch are the middles of four points.
    const std::vector<std::pair<long, mpq_class>> row =
        masks_ == Masks::cubic
            ? std::vector<std::pair<long, mpq_class>>{{-1, {1, 6}}, {0, {2, 3}}, {1, {1, 6}}}
            : std::vector<std::pair<long, mpq_class>>{{-1, {1, 2}}, {0, {1, 2}}};
    for (const auto& [i, a] : row) {
      for (const auto& [j, b] : row) add(sum, a * b, point(level, x + i, y + j));
    }
    return sum;
  }

 private:
  static constexpr std::array<std::array<long, 2>, 6> around{
      {{1, 0}, {1, 1}, {0, 1}, {-1, 0}, {-1, -1}, {0, -1}}};
  // Of one direction.
  [[nodiscard]] std::vector<std::pair<long, mpq_class>> row(long x) const {
    const long half = x >= 0 ? x / 2 : (x - 1) / 2;
    if (masks_ == Masks::quadratic)
      return x % 2 == 0 ? std::vector<std::pair<long, mpq_class>>{{half - 1, {1, 4}}, {half, {3, 4}}}
                        : std::vector<std::pair<long, mpq_class>>{{half, {3, 4}}, {half + 1, {1, 4}}};
    if (x % 2 == 0) return {{half - 1, {1, 8}}, {half, {3, 4}}, {half + 1, {1, 8}}};
    return {{half, {1, 2}}, {half + 1, {1, 2}}};
  }
  Exact loop_point(int level, long x, long y) {
    Exact sum{};
    const long i = x / 2, j = y / 2;
    if (x % 2 == 0 && y % 2 == 0) {
      add(sum, mpq_class(5, 8), point(level - 1, i, j));
      for (const auto& [a, b] : around) add(sum, mpq_class(1, 16), point(level - 1, i + a, j + b));
      return sum;
    }
    const bool right = x % 2 != 0, up = y % 2 != 0;
    const std::array<long, 2> end{right ? 1 : 0, up ? 1 : 0};
    const std::array<std::array<long, 2>, 2> across =
        right && up ? std::array<std::array<long, 2>, 2>{{{1, 0}, {0, 1}}}
        : right     ? std::array<std::array<long, 2>, 2>{{{1, 1}, {0, -1}}}
                    : std::array<std::array<long, 2>, 2>{{{1, 1}, {-1, 0}}};
    add(sum, mpq_class(3, 8), point(level - 1, i, j));
    add(sum, mpq_class(3, 8), point(level - 1, i + end[0], j + end[1]));
    for (const auto& [a, b] : across) add(sum, mpq_class(1, 8), point(level - 1, i + a, j + b));
    return sum;
  }

  const oracle::TaggedMesh& mesh_;
  long columns_;
  Masks masks_;
  std::map<std::array<long, 3>, Exact> points_;
};

Exact exact_point(const SplineSurface& s, const mpq_class& u, const mpq_class& v) {
  Exact sum{};
  const auto a = oracle::spline_basis(s.u_knots, s.degree, u),
             b = oracle::spline_basis(s.v_knots, s.degree, v);
  for (std::size_t j = 0; j < b.size(); ++j) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (a[i] == 0 || b[j] == 0) continue;
      const Point3& p = s.points[i + a.size() * j];
      add(sum, a[i] * b[j], {mpq_class(p.x), mpq_class(p.y), mpq_class(p.z)});
    }
  }
  return sum;
}

constexpr long columns = 6, level = 2, steps = 1 << level;

// Coordinates with all digits, near or far away.
oracle::TaggedMesh lattice_of(bool triangles, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-0.3, 0.3);
  oracle::TaggedMesh mesh = oracle::meshes::quad_grid(columns, columns);
  const double away = random() % 2 == 0 ? 0 : 1234.567;
  for (auto& p : mesh.points) {
    for (double& x : p) x += away + unit(random);
  }
  return triangles ? oracle::meshes::triangulated(mesh) : mesh;
}

std::array<long, 2> place_of(VertexId v) {
  const auto k = static_cast<long>(v.index());
  return {k % (columns + 1), k / (columns + 1)};
}

// Surfaces are scaled by a power of two.
void scale(oracle::TaggedMesh& mesh, double factor) {
  for (auto& p : mesh.points) {
    for (double& x : p) x *= factor;
  }
}

// Away from the boundary, whose rules the lattice does not know.
bool is_inside(const std::array<std::array<long, 2>, 3>& corner) {
  for (const auto& c : corner) {
    for (const long x : c) {
      if (x < 1 || x > columns - 1) return false;
    }
  }
  return true;
}

TEST(exact_spline, regular_quads_are_within_their_bounds) {
  std::mt19937_64 random(13);
  std::size_t points = 0;
  for (std::uint64_t number = 0; number < testing::number_of("SNUG_EXACT_SPLINES", 4); ++number) {
    const bool dual = number % 2 != 0;
    oracle::TaggedMesh mesh = lattice_of(false, random);
    const ControlMesh own = testing::control_mesh(mesh);
    SchemeOptions options;
    options.scheme = dual ? Scheme::doo_sabin : Scheme::catmark;
    const LimitSurface surface(own, options, std::make_shared<BoundsCache>());
    scale(mesh, surface.scale().apply(1.0));
    Lattice lattice(mesh, columns, dual ? Lattice::Masks::quadratic : Lattice::Masks::cubic);
    for (std::size_t p = 0; p < surface.patch_count(); p += 2) {
      if (!surface.has_patch(PatchId(p)) || !surface.kind(PatchId(p)).polynomial()) continue;
      const Patch patch = surface.patch(PatchId(p));
      // Where corners of the patch are: at vertices of its face; of a dual scheme at the middles of the faces around its vertex.
      std::array<std::array<long, 2>, 3> corner;
      const std::size_t owner = surface.place(PatchId(p)).owner;
      if (dual) {
        // Corner (0, 0) is the first face's; the limit of a quadratic lattice at a face's middle is indexed by its last vertex.
        const auto [x, y] = place_of(VertexId(owner));
        corner = {{{x, y}, {x + 1, y}, {x, y + 1}}};
      } else {
        for (std::size_t k = 0; k < 3; ++k) corner[k] = place_of(own.face(FaceId(owner))[k == 2 ? 3 : k]);
      }
      if (!is_inside(corner)) continue;
      QuadPieces quad(patch, {}, 1);
      const std::vector<QuadPiece> pieces = quad.take();
      ASSERT_EQ(pieces.size(), 1u);
      const std::vector<FacePart> parts{{pieces[0].box(), pieces[0].piece, patch.origin, false, 0}};
      SplineSurface spline = spline_of(parts, pieces[0].piece.degree);
      for (const bool moved : {false, true}) {
        if (moved) spline.points[random() % spline.points.size()].x += 0x1p-10;
        const double bound = distance_bound(parts, spline);
        mpq_class farthest = 0;
        for (long i = 0; i <= steps; ++i) {
          for (long j = 0; j <= steps; ++j) {
            const auto at = [&](std::size_t k) {
              return corner[0][k] * steps + i * (corner[1][k] - corner[0][k]) +
                     j * (corner[2][k] - corner[0][k]);
            };
            const Exact off = exact_point(spline, mpq_class(i, steps), mpq_class(j, steps)) -
                              lattice.limit(level, at(0), at(1));
            farthest = std::max(farthest, mpq_class(dot(off, off)));
            ++points;
          }
        }
        ASSERT_LE(farthest, mpq_class(bound) * mpq_class(bound)) << p << ' ' << dual << ' ' << moved;
        if (!moved) {
          EXPECT_LE(bound, 1e-11);
        }
      }
    }
  }
  EXPECT_GT(points, testing::share(2000));
}

TEST(exact_spline, regular_triangles_are_within_their_bounds) {
  std::mt19937_64 random(14);
  std::size_t points = 0;
  double ratio = 0;
  std::size_t faces = 0;
  for (std::uint64_t number = 0; 2 * number < testing::number_of("SNUG_EXACT_SPLINES", 4); ++number) {
    oracle::TaggedMesh mesh = lattice_of(true, random);
    const ControlMesh own = testing::control_mesh(mesh);
    SchemeOptions options;
    options.scheme = Scheme::loop;
    const LimitSurface surface(own, options, std::make_shared<BoundsCache>());
    scale(mesh, surface.scale().apply(1.0));
    Lattice lattice(mesh, columns, Lattice::Masks::loop);
    for (std::size_t p = 0; p < surface.patch_count(); ++p) {
      if (!surface.has_patch(PatchId(p)) || !surface.kind(PatchId(p)).polynomial() || random() % 4 != 0)
        continue;
      const Patch patch = surface.patch(PatchId(p));
      const auto turn = static_cast<unsigned>(random() % 3);
      const auto corners = own.face(FaceId(surface.place(PatchId(p)).owner));
      std::array<std::array<long, 2>, 3> corner;
      for (unsigned k = 0; k < 3; ++k) corner[k] = place_of(corners[(k + turn) % 3]);
      if (!is_inside(corner)) continue;
      std::vector<FaceSquare> squares;
      squares.push_back({{patch, turn, SquareHalf::lower}, {}});
      std::vector<HermiteCurve> border;
      for (unsigned k = 0; k < 3; ++k) {
        TriangleTree tree(patch, turn + k, SquareHalf::lower);
        border.push_back(curve_near(tree, 0.01));
      }
      HermiteFace face(1, 1, std::move(squares), border);
      static_cast<void>(face.refine(0.003, 200));
      const std::vector<FacePart> parts = face.parts();
      const SplineSurface spline = spline_of(parts, 3);
      const double bound = distance_bound(parts, spline);
      mpq_class farthest = 0;
      for (long i = 0; i <= steps; ++i) {
        for (long j = 0; j <= i; ++j) {
          // Corners of the half are (0, 0), (1, 0), (1, 1).
          const auto at = [&](std::size_t k) {
            return (steps - i) * corner[0][k] + (i - j) * corner[1][k] + j * corner[2][k];
          };
          const Exact off = exact_point(spline, mpq_class(i, steps), mpq_class(j, steps)) -
                            lattice.limit(level, at(0), at(1));
          farthest = std::max(farthest, mpq_class(dot(off, off)));
          ++points;
        }
      }
      ASSERT_LE(farthest, mpq_class(bound) * mpq_class(bound)) << p;
      ratio += std::sqrt(farthest.get_d()) / bound;
      ++faces;
    }
  }
  EXPECT_GT(points, testing::share(200));
  EXPECT_GT(ratio, 0.2 * static_cast<double>(faces));  // bounds that say something
}

}  // namespace
}  // namespace snug::exact_spline_test
