#include <snug/search/piece_pairs.h>

#include <gtest/gtest.h>
#include <snug/patch/evaluate.h>
#include <support/direction.h>
#include <testing/counts.h>
#include <testing/disguised_surfaces.h>
#include <testing/placements.h>

#include <set>

namespace snug::piece_pairs_test {
namespace {

// A surface in a pose, beside itself.
struct Placed {
  SurfaceBvh model;
  PieceCache workspace, beside;
  PairFrames frames;
  SearchStats stats;
  PiecePairs pieces{frames, stats};

  Placed(const LimitSurface& surface, const Motion& pose)
      : model(surface),
        workspace(model),
        beside(model),
        frames({model, workspace, pose}, {model, beside, Motion()}) {}
};

bool has_patches(const LimitSurface& surface) {
  bool any = false;
  testing::for_each_patch(surface, [&](PatchId) { any = true; });
  return any;
}

// A patch or a piece some levels down.
Node some_node(PieceCache& workspace, std::mt19937_64& random) {
  Node node = workspace.root();
  for (std::size_t levels = random() % 4; !node.bounded() || levels > 0;) {
    if (!PieceCache::can_open(node)) break;
    levels -= node.bounded();
    const PieceCache::Opened opened = workspace.open(node);
    node = opened.child(random() % opened.count());
  }
  return node;
}

using Points = std::array<std::vector<Point3>, 2>;

// Placed limit points, those of corners first, which quadratics need not pass through.
Points points_of(Placed& at, const std::array<Node, 2>& nodes, std::mt19937_64& random) {
  Points points;
  for (std::size_t s = 0; s < 2; ++s) {
    const Patch& patch = at.frames.cache(s).patch(nodes[s]);
    std::vector<TriangleParameter> parameters{{0, 0}, {1, 0}, {0, 1}};
    while (parameters.size() < 12) parameters.push_back(testing::random_parameter(random));
    for (const TriangleParameter& parameter : parameters) {
      const RelativePoint point = limit_point(patch, parameter);
      points[s].push_back(at.frames.frame(s).apply(patch.origin + point.relative));
    }
  }
  return points;
}

Vector3 shortest_way(const Points& points) {
  Vector3 least{INFINITY, INFINITY, INFINITY};
  for (const Point3& p : points[0]) {
    for (const Point3& q : points[1]) {
      if (length(q - p) < length(least)) least = q - p;
    }
  }
  return least;
}

// How far apart planes across w hold the points.
double gap_of(const Points& points, const Vector3& w) {
  double end = -INFINITY, begin = INFINITY;
  for (const Point3& p : points[0]) end = std::max(end, dot(w, p - Point3{}));
  for (const Point3& q : points[1]) begin = std::min(begin, dot(w, q - Point3{}));
  return std::max(begin - end, 0.0);
}

// Planes that hold two pieces apart hold their limit points apart.
TEST(piece_pairs, gaps_are_at_most_those_of_limit_points) {
  std::size_t gaps = 0;
  testing::for_each_disguised_surface(
      42, [&](const LimitSurface& surface, const std::string& name, std::mt19937_64& random) {
        if (random() % 8 != 0 || !has_patches(surface)) return;
        const double far = surface.scale().inverse().apply(random() % 2 == 0 ? 0.5 : 3.0);
        Placed at(surface, testing::random_placement(random, testing::random_vector(random, far)));
        for (int pair = 0; pair < 4; ++pair) {
          const std::array nodes{some_node(at.workspace, random), some_node(at.beside, random)};
          const Points points = points_of(at, nodes, random);
          const Vector3 between = shortest_way(points);
          for (int i = 0; i < 4; ++i) {
            const Vector3 direction = i == 0   ? between
                                      : i == 1 ? testing::random_vector(random, 1)
                                               : points[1][random() % 3] - points[0][random() % 3];
            const double gap = at.pieces.gap_along(nodes, direction);
            at.pieces.look_along(direction);
            EXPECT_EQ(at.pieces.gap_along(nodes), gap) << name;
            EXPECT_EQ(at.pieces.gap_along(nodes), gap) << name << ", again";
            EXPECT_LE(gap, gap_of(points, normalized(direction)) + 1e-12) << name;
            gaps += gap > 0;
          }
          const PiecePair pieces = at.pieces.nearest({nodes, -INFINITY});
          EXPECT_LE(pieces.gap, length(between) + 1e-12) << name;
          EXPECT_LE(at.pieces.nearest_in_double({nodes, -INFINITY}).gap, length(between) + 1e-12) << name;
          PiecePair moved = pieces;
          at.pieces.approach(moved);
          for (const PiecePair& found : {pieces, moved}) {
            const Witness witness = at.pieces.witness(found);
            EXPECT_LE(length(found.points[0] - witness.points[0]), 2 * (found.error + witness.error)) << name;
            EXPECT_GE(found.near_distance, length(witness.points[1] - witness.points[0]) - 1e-12) << name;
            EXPECT_GE(witness.distance, pieces.gap) << name;
          }
        }
      });
  EXPECT_GT(gaps, testing::fewer(2000));
}

}  // namespace
}  // namespace snug::piece_pairs_test
