// Agreement of patches of every scheme: names of corners with limit points, children with their parent
// and with each other.

#include <snug/surface/evaluate.h>

#include <gtest/gtest.h>
#include <testing/scheme_surfaces.h>

#include <cmath>
#include <map>

namespace snug::schemes_kinds_test {
namespace {

using testing::NamedSurface;

struct Corner {
  LimitPoint at;
  std::uint32_t name;
};

// Of every patch, in mesh units.
std::vector<Corner> corners_of(const LimitSurface& surface) {
  std::vector<Corner> list;
  testing::for_each_patch(surface, [&](PatchId p) {
    const PatchEvaluator evaluator(surface, p);
    const std::array<std::uint32_t, 3> names = surface.corner_names(p);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_LT(names[k], surface.corner_name_count());
      list.push_back({evaluator(k == 0   ? TriangleParameter{0, 0}
                                : k == 1 ? TriangleParameter{1, 0}
                                         : TriangleParameter{0, 1}),
                      names[k]});
    }
  });
  return list;
}

double largest_difference(const Point3& a, const Point3& b) { return max_abs(a - b); }

TEST(corner_names, that_are_equal_stand_for_equal_limit_points) {
  testing::for_each_surface(101, [&](const NamedSurface& s) {
    std::map<std::uint32_t, LimitPoint> by_name;
    for (const Corner& corner : corners_of(s.surface)) {
      const LimitPoint& first = by_name.try_emplace(corner.name, corner.at).first->second;
      EXPECT_LE(largest_difference(first.point, corner.at.point), first.error + corner.at.error)
          << s.name << ", name " << corner.name;
    }
  });
}

// Where nothing meets by accident, or by edges that are one in space and several to their faces.
TEST(corner_names, are_equal_where_patches_meet) {
  testing::for_each_surface(102, [&](const NamedSurface& s) {
    if (s.name.starts_with("back to back") || s.name.starts_with("valence two") ||
        s.name.starts_with("same ways")) {
      return;
    }
    const std::vector<Corner> corners = corners_of(s.surface);
    for (const Corner& a : corners) {
      for (const Corner& b : corners) {
        if (largest_difference(a.at.point, b.at.point) <= 1e-9 * s.surface.size()) {
          EXPECT_EQ(a.name, b.name) << s.name;
        }
      }
    }
  });
}

// Two limit points of one patch or its pieces, with one origin.
void expect_same(const RelativePoint& a, const RelativePoint& b, const std::string& where) {
  EXPECT_LE(max_abs(a.relative - b.relative), a.error + b.error) << where;
  EXPECT_LT(a.error + b.error, 1e-11) << where;
}

// A corner of a piece by the kind's own row, not by going down.
void check_children(const Patch& patch, int levels, const std::string& where, std::mt19937_64& random) {
  std::array<Patch, 4> child;
  for (unsigned k = 0; k < 4; ++k) {
    child[k] = split(patch, k);
    EXPECT_EQ(child[k].origin, patch.origin);
    EXPECT_EQ(child[k].points.size(), child[k].kind->control_count());
  }
  for (std::size_t k = 0; k < 3; ++k) {
    expect_same(corner_point(child[k], k), corner_point(patch, k), where + ", corner " + std::to_string(k));
    // The middles of the edges: 01, 12, 20.
    const std::size_t next = (k + 1) % 3;
    const RelativePoint middle = corner_point(child[k], next);
    expect_same(corner_point(child[next], k), middle, where + ", edge " + std::to_string(k));
    const std::size_t facing =
        (k + 2) % 3;  // the middle child's corner i lies on the edge that faces corner i
    expect_same(corner_point(child[3], facing), middle, where + ", middle child " + std::to_string(k));
  }
  LimitEvaluator whole(patch);
  const bool quad = !patch.kind->rules().triangular();
  const auto evaluated = [&](LimitEvaluator& evaluator, TriangleParameter at) {
    const LimitFrame frame = evaluator.frame({0, 0, quad ? at.u + at.v : at.u, at.v});
    return frame.point;
  };
  for (unsigned k = 0; k < 4; ++k) {
    LimitEvaluator part(child[k]);
    for (int trial = 0; trial < 3; ++trial) {
      const TriangleParameter q = testing::random_parameter(random);
      // Multiples of 2^-30: the parameter of the whole is exact.
      const TriangleParameter at{std::floor(q.u * 0x1p30) * 0x1p-30, std::floor(q.v * 0x1p30) * 0x1p-30};
      PiecePath path;
      const TriangleParameter on_whole = to_face(path.child(k), at);
      const std::string here = where + ", child " + std::to_string(k) + " at " + std::to_string(at.u) + ", " +
                               std::to_string(at.v);
      const RelativePoint expected = limit_point(patch, on_whole);
      expect_same(limit_point(child[k], at), expected, here);
      expect_same(evaluated(part, at), expected, here);
      expect_same(evaluated(whole, on_whole), expected, here);
    }
  }
  if (levels > 1) check_children(child[random() % 4], levels - 1, where + "'s child", random);
}

TEST(split, makes_pieces_that_tile_the_patch) {
  std::mt19937_64 random(103);
  testing::for_each_surface(103, [&](const NamedSurface& s) {
    testing::for_each_patch(s.surface, [&](PatchId p) {
      check_children(s.surface.patch(p), 3, s.name + ", patch " + std::to_string(p.index()), random);
    });
  });
}

// The quads that a polygon splits into meet at its centre and in the middles of its edges.
TEST(polygons, make_patches_that_meet) {
  std::size_t polygons = 0;
  testing::for_each_surface(104, [&](const NamedSurface& s) {
    for (std::size_t owner = 0; owner < s.surface.owner_count(); ++owner) {
      const auto [begin, end] = s.surface.patches_of(owner);
      if (begin == end || !s.surface.has_patch(PatchId(begin))) continue;
      if (!s.surface.after_first_split(PatchId(begin))) continue;
      ++polygons;
      const std::size_t n = (end - begin) / 2;
      for (std::size_t k = 0; k < n; ++k) {
        const Patch from_corner = s.surface.patch(PatchId(begin + 2 * k)),
                    from_centre = s.surface.patch(PatchId(begin + 2 * k + 1)),
                    next = s.surface.patch(PatchId(begin + 2 * ((k + 1) % n) + 1)),
                    first = s.surface.patch(PatchId(begin));
        const std::string where =
            s.name + ", owner " + std::to_string(owner) + ", corner " + std::to_string(k);
        expect_same(corner_point(from_corner, 0), corner_point(from_centre, 2), where);
        expect_same(corner_point(from_corner, 2), corner_point(from_centre, 0), where);
        expect_same(corner_point(from_corner, 2), corner_point(first, 2), where);
        expect_same(corner_point(from_corner, 1), corner_point(next, 1), where);
        // And all along the edge between two corners' quads: 12 of one, 01 of the other.
        for (const double t : {0.125, 0.5, 0.8}) {
          expect_same(limit_point(from_corner, TriangleParameter{1 - t, t}),
                      limit_point(next, TriangleParameter{1 - t, 0}), where);
          expect_same(limit_point(from_corner, TriangleParameter{0, t}),
                      limit_point(from_centre, TriangleParameter{0, 1 - t}), where);
        }
      }
    }
  });
  EXPECT_GT(polygons, 50u);
}

}  // namespace
}  // namespace snug::schemes_kinds_test
