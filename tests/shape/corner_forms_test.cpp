// Forms of pieces at extraordinary corners against sums over what these pieces split into.

#include <snug/shape/corner_forms.h>

#include <gtest/gtest.h>
#include <snug/shape/corner_asymptotics.h>
#include <snug/shape/regular_integrals.h>
#include <testing/scheme_surfaces.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <set>
#include <vector>

namespace snug::corner_forms_test {
namespace {

using Points = std::vector<kernels::NetPoint>;

Points refined(const KindStep& step, const Points& points, std::span<const std::uint32_t> which) {
  Points all(step.stencils.row_count() + step.ghosts.row_count()), result;
  for (std::size_t r = 0; r < all.size(); ++r) {
    const std::size_t count = step.stencils.row_count();
    const Stencils::Row row = r < count ? step.stencils.row(r) : step.ghosts.row(r - count);
    for (std::size_t i = 0; i < row.sources.size(); ++i) {
      for (std::size_t a = 0; a < 3; ++a) all[r][a] += row.weights[i] * points[row.sources[i]][a];
    }
  }
  for (const std::uint32_t i : which) result.push_back(all[i]);
  return result;
}

struct Sums {
  double lower = 0, upper = 0;
  Vector3 flux;
};

// Moments about origins that differ by a unit along an axis differ by that axis times the integral of the normal.
void add_regular(const Kind& kind, const Points& lattice, Sums& sums) {
  RegularPiece piece{kind.rules().basis, {}, 1, 0, {}, 0};
  std::copy(lattice.begin(), lattice.end(), piece.points.begin());
  std::array<RegularPiece, 4> pieces{piece, piece, piece, piece};
  for (std::size_t a = 0; a < 3; ++a) pieces[a].origin[a] = 1;
  std::array<FluxMoments, 4> moments;
  std::vector<AreaPiece> normals;
  integrate(pieces, moments, normals);
  for (std::size_t a = 0; a < 3; ++a) sums.flux[a] += moments[a].value[0] - moments[3].value[0];
  for (std::size_t i = 0; i < normals.size() / 4; ++i) {
    sums.lower += normals[i].area().lower;
    sums.upper += normals[i].area().upper;
  }
}

Vector3 sides_of(const Points& points) {
  Box3 box;
  for (const auto& p : points) box.add(Point3{p[0], p[1], p[2]});
  return box.upper - box.lower;
}

Sums sums_of(const Kind& kind, Points points) {
  Sums sums;
  for (int step = 0; step < 400 && length_sq(sides_of(points)) > 1e-13; ++step) {
    Points next;
    for (const KindStep::Piece& piece : kind.step().pieces) {
      if (piece.lattice.empty()) {
        next = refined(kind.step(), points, piece.control);
      } else {
        add_regular(*piece.kind, refined(kind.step(), points, piece.lattice), sums);
      }
    }
    points = next;
  }
  return sums;
}

// Corners of a cube, anywhere in a needle, or in a plane.
Points some_points(std::size_t count, int sort, std::mt19937_64& random) {
  Points points(count);
  for (auto& p : points) {
    for (std::size_t a = 0; a < 3; ++a)
      p[a] = sort == 0 ? static_cast<double>(random() % 2) : testing::unit(random);
    if (sort == 1) p = {p[0], 1e-4 * p[1], 1e-4 * p[2], 0};
    if (sort == 2) p[2] = 0.25 * p[0] - 0.5 * p[1];
  }
  return points;
}

TEST(corner_forms, hold_what_pieces_split_into) {
  std::mt19937_64 random(17);
  std::size_t kinds = 0, left = 0;
  double nearest = INFINITY, farthest = 0;
  std::set<const Kind*> seen;
  const auto check = [&](const Kind& kind) {
    if (kind.polynomial() || kind.transient() || !seen.insert(&kind).second) return;
    const CornerForms* const forms = asymptotics_of(kind).forms();
    if (forms == nullptr) {
      ++left;
      return;
    }
    ++kinds;
    for (int sort = 0; sort < 3; ++sort) {
      const Points points = some_points(kind.control_count(), sort, random);
      Box3 box;
      for (const auto& p : points) box.add(Point3{p[0], p[1], p[2]});
      const Vector3 sides = box.upper - box.lower;
      const PieceArea area =
          forms->area_of(points, box.lower + 0.5 * sides, 1.000001 * length_sq(sides), 1e-15);
      const Sums sums = sums_of(kind, points);
      EXPECT_LE(area.lower, sums.upper * (1 + 1e-9));
      EXPECT_GE(area.upper, sums.lower * (1 - 1e-9));
      EXPECT_LE(length(area.flux - sums.flux), 1e-12);
      EXPECT_LE(area.flux_error, 1e-5 * length_sq(sides));
      nearest = std::min(nearest, area.upper / sums.upper);
      farthest = std::max(farthest, area.upper / sums.lower);
    }
  };
  testing::for_each_surface(7, [&](const testing::NamedSurface& named) {
    SCOPED_TRACE(named.name);
    testing::for_each_patch(named.surface, [&](PatchId p) {
      const Patch patch = named.surface.patch(p);
      check(*patch.kind);
      if (patch.kind->polynomial() || patch.kind->key().polygon) return;
      for (const KindStep::Piece& piece : patch.kind->step().pieces) check(*piece.kind);
    });
  });
  EXPECT_GT(kinds, 100u);
  std::cout << kinds << " kinds with forms, " << left << " without; " << nearest << " to " << farthest
            << " of what the sums hold\n";
}

}  // namespace
}  // namespace snug::corner_forms_test
