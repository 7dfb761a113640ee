#include <snug/bvh/set_kernel.h>
#include <snug/bvh/wide_bvh.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <random>
#include <thread>
#include <vector>

namespace snug::wide_bvh_test {
namespace {

std::vector<Point3> scattered(std::size_t count) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Point3> points;
  for (std::size_t i = 0; i < count; ++i)
    points.push_back({unit(random), 0.5 * unit(random), 0.1 * unit(random)});
  return points;
}

WideBvh::Fit fit_to(const std::vector<Point3>& points) {
  return [&points](std::size_t leaf, std::span<const std::uint32_t> items, std::vector<Obb>& boxes) {
    // One box for all items of a leaf, or one each.
    const std::size_t together = leaf % 2 == 0 ? items.size() : 1;
    for (std::size_t at = 0; at < items.size(); at += together) {
      std::vector<Point3> own;
      for (const std::uint32_t i : items.subspan(at, together)) own.push_back(points[i]);
      boxes.push_back(fit_box(principal_axes(own), [&](const Vector3& d) {
        Extent extent;
        for (const Point3& p : own) extent.add({dot(d, p - Point3{}) - 1e-15, dot(d, p - Point3{}) + 1e-15});
        return extent;
      }));
    }
  };
}

WideBvh tree_of(const std::vector<Point3>& points, int threads = 1) {
  return {points, threads, fit_to(points)};
}

// Each has its point on its border.
std::vector<Ball> balls_at(const std::vector<Point3>& points) {
  std::vector<Ball> balls;
  for (const Point3& p : points) {
    const Vector3 away = 0.02 * (p - points[balls.size() / 2]);
    balls.push_back({p + away, length(away) * (1 + 1e-15)});
  }
  return balls;
}

WideBvh lazy_tree_of(const std::vector<Point3>& points, unsigned part_level) {
  return {balls_at(points), fit_to(points), part_level};
}

// Counts items below and checks that the child's box is not certainly apart from any of them.
void walk(const WideBvh& tree, const std::vector<Point3>& points, std::uint32_t name, std::size_t depth,
          std::vector<std::uint32_t>& below, std::size_t& deepest) {
  deepest = std::max(deepest, depth);
  if ((name & WideBvh::leaf_bit) != 0) {
    const auto items = tree.leaf(name & ~WideBvh::leaf_bit);
    below.insert(below.end(), items.begin(), items.end());
    return;
  }
  const WideNode& node = tree.node(name);
  for (std::uint32_t l = 0; l < node.count(); ++l) {
    std::vector<std::uint32_t> here;
    walk(tree, points, node.names[l], depth + 1, here, deepest);
    for (const std::uint32_t i : here) {
      WideNode::Distances found;
      node.distances(points[i], 0, found);
      EXPECT_LE(found[l], 0) << i;
    }
    below.insert(below.end(), here.begin(), here.end());
  }
}

void expect_every_item_once(const WideBvh& tree, const std::vector<Point3>& points,
                            std::size_t most_deep = 4) {
  std::vector<std::uint32_t> below;
  std::size_t deepest = 0;
  walk(tree, points, tree.root().names[0], 0, below, deepest);
  std::sort(below.begin(), below.end());
  ASSERT_EQ(below.size(), points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) EXPECT_EQ(below[i], i);
  EXPECT_LE(deepest, most_deep);
  for (const Point3& p : points) {
    EXPECT_LE(distance(p, tree.ball().centre), tree.ball().radius);
    WideNode::Distances found;
    tree.root().distances(p, 0, found);
    EXPECT_LE(found[0], 0);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_LE(std::fabs(dot(tree.box().axes[k], p - tree.box().centre)), tree.box().half[k] + 1e-14);
    }
    for (const Vector3& d : {Vector3{1, 0, 0}, Vector3{-0.3, 0.4, 0.8}}) {
      EXPECT_LE(dot(d, p - tree.dop().centre()), tree.dop().reach(d) * (1 + 1e-12));
    }
  }
}

TEST(bounding_tree, holds_every_item_once_below_boxes_that_contain_it) {
  for (const std::size_t count : {1u, 7u, 8u, 9u, 64u, 65u, 513u, 3000u}) {
    const std::vector<Point3> points = scattered(count);
    expect_every_item_once(tree_of(points), points);
    for (const unsigned part_level : {1u, 2u})
      expect_every_item_once(lazy_tree_of(points, part_level), points);
    // Far from the origin, beside their size.
    std::vector<Point3> far = points;
    for (Point3& p : far) p = Point3{1.5, -0.7, 0.1} + 0x1p-30 * (p - Point3{});
    expect_every_item_once(tree_of(far), far);
    expect_every_item_once(lazy_tree_of(far, 1), far);
  }
}

// A quadratic triangle of any shape, and points within its error of it.
struct AnySet {
  Obb box;
  std::array<Point3, 6> net;
  double error;
  Vector3 normal_of_error{};
  double normal_error = 0;
  std::vector<Point3> points;

  AnySet(const Point3& centre, double size, std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    const auto vector = [&](double length) {
      return length * Vector3{normal(random), normal(random), normal(random)};
    };
    const double bend = std::array{0.0, 0.01, 1.0}[random() % 3] * size;
    error = random() % 5 == 0 ? INFINITY : std::array{0.0, 1e-3, 0.3}[random() % 3] * size;
    for (std::size_t k = 0; k < 3; ++k) net[k] = centre + vector(size);
    for (std::size_t k = 0; k < 3; ++k)
      net[3 + k] = net[k] + 0.5 * (net[(k + 1) % 3] - net[k]) + vector(bend);
    const double off = error < INFINITY ? error : 0;
    const bool flat = random() % 2 == 0;
    if (flat) {
      normal_of_error = vector(1);
      normal_of_error = (1 / length(normal_of_error)) * normal_of_error;
      normal_error = 0.1 * off;
    }
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 12; ++i) {
      double u = unit(random), v = unit(random);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      if (i < 3) u = i == 1, v = i == 2;
      const double r = 1 - u - v;
      Vector3 p;
      const std::array weights{r * r, u * u, v * v, 2 * r * u, 2 * u * v, 2 * r * v};
      for (std::size_t k = 0; k < 6; ++k) p = p + weights[k] * (net[k] - centre);
      Vector3 away = vector(1);
      away = off * (1 - 1e-9) / length(away) * away;
      if (flat) away = away - 0.9 * dot(normal_of_error, away) * normal_of_error;
      points.push_back(centre + p + away);
    }
    // A box that holds these points, and perhaps all of the net.
    std::vector<Point3> held = points;
    if (random() % 2 == 0) held.insert(held.end(), net.begin(), net.end());
    box = fit_box(principal_axes(held), [&](const Vector3& d) {
      Extent extent;
      for (const Point3& p : held) extent.add({dot(d, p - Point3{}) - 1e-14, dot(d, p - Point3{}) + 1e-14});
      return extent;
    });
  }
  [[nodiscard]] FittedSet set() const { return {box, net, error, normal_of_error, normal_error}; }
};

TEST(bounding_tree, extents_of_sets_hold_them_whatever_is_beside) {
  std::mt19937_64 random(10);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 400; ++trial) {
    const std::size_t count = 1 + random() % 20;
    const double size = std::pow(10.0, -static_cast<double>(random() % 8));
    std::vector<AnySet> made;
    std::vector<FittedSet> sets;
    std::vector<std::uint32_t> which;
    for (std::uint32_t i = 0; i < count; ++i) {
      made.emplace_back(Point3{normal(random), normal(random), normal(random)}, size, random);
      if (random() % 16 == 0) made.back().box.half.y = INFINITY;
      sets.push_back(made.back().set());
      which.insert(which.begin(), i);
    }
    const Axes axes = orthonormal_axes({normal(random), normal(random), normal(random)}, {1, 2, 3});
    std::vector<kernels::SetSides> sides(count);
    const std::array<Extent, 3> all = kernels::extents_along(axes, sets, which, sides.data());
    std::array<Extent, 3> one_by_one;
    for (std::size_t place = 0; place < count; ++place) {
      const AnySet& here = made[which[place]];
      const std::array<Extent, 3> own =
          kernels::extents_along(axes, sets, std::span(which).subspan(place, 1), sides.data() + place);
      for (std::size_t k = 0; k < 3; ++k) {
        one_by_one[k].add(own[k]);
        const bool bounded = here.box.half.y < INFINITY;
        Extent points;
        for (const Point3& p : here.points) points.add(dot(axes[k], p - Point3{}));
        EXPECT_LE(own[k].lower, points.lower + 1e-14);
        EXPECT_GE(own[k].upper, points.upper - 1e-14);
        EXPECT_EQ(own[k].upper < INFINITY, bounded);
        if (!bounded) continue;
        EXPECT_NEAR(sides[place].lower(k), own[k].lower, 1e-6);
        EXPECT_NEAR(sides[place].upper(k), own[k].upper, 1e-6);
        // No wider than the box, nor than the net and the error.
        const std::array<Vector3, 3>& box_axes = here.box.axes;
        double reach = 0;
        for (std::size_t a = 0; a < 3; ++a) reach += here.box.half[a] * std::fabs(dot(axes[k], box_axes[a]));
        const double middle = dot(axes[k], here.box.centre - Point3{});
        EXPECT_LE(own[k].upper, middle + reach + 1e-12);
        EXPECT_GE(own[k].lower, middle - reach - 1e-12);
        Extent net;
        for (const Point3& p : here.net) net.add(dot(axes[k], p - Point3{}));
        EXPECT_LE(own[k].upper, net.upper + here.error + 1e-12);
        EXPECT_GE(own[k].lower, net.lower - here.error - 1e-12);
      }
    }
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(all[k].lower, one_by_one[k].lower);
      EXPECT_EQ(all[k].upper, one_by_one[k].upper);
    }
  }
}

TEST(bounding_tree, extents_of_triangles_hold_their_sets) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  std::size_t near = 0, samples = 0;
  for (int trial = 0; trial < 400; ++trial) {
    std::vector<AnySet> made;
    std::vector<kernels::SetTriangle> triangles;
    const double size = std::pow(10.0, -static_cast<double>(random() % 8));
    for (std::size_t count = 1 + random() % 40; count > 0; --count) {
      made.emplace_back(Point3{normal(random), normal(random), normal(random)}, size, random);
      AnySet& set = made.back();
      if (random() % 16 == 0) set.box.half.y = INFINITY;
      if (random() % 4 == 0) {  // bent alike, and nothing beside
        const Vector3 bend = size * Vector3{normal(random), normal(random), normal(random)};
        set.error = 0;
        for (std::size_t k = 0; k < 3; ++k)
          set.net[3 + k] = set.net[k] + 0.5 * (set.net[(k + 1) % 3] - set.net[k]) + bend;
        set.points.assign(set.net.begin(), set.net.begin() + 3);
      }
      triangles.push_back(kernels::triangle_of(set.set()));
    }
    const Axes axes = orthonormal_axes({normal(random), normal(random), normal(random)}, {1, 2, 3});
    std::vector<kernels::SetSides> sides(made.size());
    const std::array<Extent, 3> all = kernels::extents_along(axes, triangles, sides.data());
    std::array<Extent, 3> one_by_one;
    for (std::size_t i = 0; i < made.size(); ++i) {
      const AnySet& set = made[i];
      const std::array<Extent, 3> own =
          kernels::extents_along(axes, std::span(triangles).subspan(i, 1), sides.data() + i);
      for (std::size_t k = 0; k < 3; ++k) {
        one_by_one[k].add(own[k]);
        Extent points;
        double wide = 0;
        for (const Point3& p : made[i].points) points.add(dot(axes[k], p - Point3{}));
        for (const Point3& p : set.net) wide = std::max(wide, length(p - set.net[0]));
        EXPECT_LE(own[k].lower, points.lower);
        EXPECT_GE(own[k].upper, points.upper);
        if (!(set.error < INFINITY) || !(set.box.half.y < INFINITY)) continue;
        ++samples;
        near += own[k].upper < points.upper + 0.1 * (points.upper - points.lower) + 1e-6;
        EXPECT_LE(own[k].upper, points.upper + 2 * wide + 2 * set.error + 1e-4);
      }
    }
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(all[k].lower, one_by_one[k].lower);
      EXPECT_EQ(all[k].upper, one_by_one[k].upper);
    }
  }
  EXPECT_GT(near, samples / 10);
}

TEST(bounding_tree, of_sets_holds_every_set_once_below_boxes_that_contain_it) {
  std::mt19937_64 random(8);
  for (const std::size_t count : {1u, 7u, 8u, 9u, 64u, 65u, 513u, 3000u}) {
    const std::vector<Point3> centres = scattered(count);
    std::vector<FittedSet> sets;
    std::vector<std::vector<Point3>> points(12);
    for (const Point3& centre : centres) {
      const AnySet made(centre, 0.03, random);
      sets.push_back(made.set());
      for (std::size_t i = 0; i < points.size(); ++i) points[i].push_back(made.points[i]);
    }
    const WideBvh tree(sets);
    for (const std::vector<Point3>& some : points) expect_every_item_once(tree, some, 8);
  }
}

// Sets that are ever smaller: the worst there is for a tree that is split by surface.
TEST(bounding_tree, of_sets_is_not_deep) {
  std::mt19937_64 random(9);
  std::vector<FittedSet> sets;
  std::vector<Point3> points;
  for (int i = 0; i < 2000; ++i) {
    const double size = std::pow(0.98, i);
    const AnySet made({size, 0, 0}, 0.1 * size, random);
    sets.push_back(made.set());
    points.push_back(made.points[0]);
  }
  expect_every_item_once(WideBvh(sets), points, 12);
  // Nothing is apart from a set without end, and all others have their boxes.
  sets[5] = FittedSet();
  const WideBvh tree(sets);
  EXPECT_EQ(tree.box().half.x, INFINITY);
  std::vector<std::uint32_t> below;
  std::size_t deepest = 0;
  walk(tree, points, tree.root().names[0], 0, below, deepest);
  EXPECT_EQ(below.size(), points.size());
}

TEST(bounding_tree, narrowed_to_a_hull_holds_every_item_and_no_more_than_the_hull) {
  std::mt19937_64 random(6);
  std::normal_distribution<double> normal;
  for (const std::size_t count : {1u, 9u, 500u}) {
    for (const double spread : {1.0, 0x1p-30}) {
      std::vector<Point3> points = scattered(count), hull;
      for (Point3& p : points) p = Point3{1.5, -0.7, 0.1} + spread * (p - Point3{});
      for (const Point3& p : points) {
        const Vector3 away = 1e-3 * spread * Vector3{normal(random), normal(random), normal(random)};
        hull.push_back(p + away);
        hull.push_back(p - away);
      }
      // Leaves whose boxes are far too large, some without end.
      const auto loose = [&](std::size_t leaf, std::span<const std::uint32_t> items,
                             std::vector<Obb>& boxes) {
        boxes.push_back({points[items[0]], Obb{}.axes, {9, 9, leaf % 7 == 6 ? INFINITY : 9}});
      };
      WideBvh tree(points, 1, loose), tight = tree_of(points);
      tree.narrow(hull);
      tight.narrow(hull);
      expect_every_item_once(tree, points);
      expect_every_item_once(tight, points);
      for (const Vector3& axis : Obb{}.axes) {
        double farthest = -INFINITY;
        for (const Point3& p : hull) farthest = std::max(farthest, dot(axis, p - tree.dop().centre()));
        EXPECT_NEAR(tree.dop().reach(axis), farthest, 1e-12);
      }
      EXPECT_LT(length(tree.box().half), 4 * spread);
      EXPECT_LT(tree.root().size_of(0), 8 * spread);
    }
  }
}

TEST(bounding_tree, is_as_deep_for_items_all_alike) {
  const std::vector<Point3> points(4096, Point3{0.5, 0.5, 0.5});
  const WideBvh tree = tree_of(points);
  std::vector<std::uint32_t> below;
  std::size_t deepest = 0;
  walk(tree, points, tree.root().names[0], 0, below, deepest);
  EXPECT_EQ(below.size(), 4096u);
  EXPECT_EQ(deepest, 3u);
}

void expect_same(const WideBvh& one, const WideBvh& two, const WideNode& x, const WideNode& y) {
  ASSERT_EQ(x.count(), y.count());
  EXPECT_EQ(x.names, y.names);
  EXPECT_EQ(x.origin(), y.origin());
  WideNode::Distances of_x, of_y;
  x.distances(Point3{3, 2, 1}, 0, of_x);
  y.distances(Point3{3, 2, 1}, 0, of_y);
  EXPECT_EQ(of_x, of_y);
  for (std::size_t l = 0; l < x.count(); ++l) {
    EXPECT_EQ(x.size_of(l), y.size_of(l));
    if ((x.names[l] & WideBvh::leaf_bit) != 0) continue;
    expect_same(one, two, one.node(x.names[l]), two.node(y.names[l]));
  }
}

TEST(bounding_tree, is_the_same_for_any_number_of_threads) {
  const std::vector<Point3> points = scattered(20000);
  const WideBvh one = tree_of(points, 1), two = tree_of(points, 4);
  ASSERT_EQ(one.leaf_count(), two.leaf_count());
  for (std::size_t c = 0; c < one.leaf_count(); ++c) {
    EXPECT_TRUE(std::ranges::equal(one.leaf(c), two.leaf(c)));
  }
  expect_same(one, two, one.root(), two.root());
}

TEST(bounding_tree, made_in_parts_is_sorted_as_one_made_at_once) {
  const std::vector<Point3> points = scattered(5000);
  std::vector<Ball> balls;
  for (const Point3& p : points) balls.push_back({p, 0});
  const WideBvh whole = tree_of(points), parts(balls, fit_to(points));
  std::vector<std::uint32_t> below;
  std::size_t deepest = 0;
  walk(parts, points, parts.root().names[0], 0, below, deepest);
  for (std::size_t c = 0; c < whole.leaf_count(); ++c) {
    EXPECT_TRUE(std::ranges::equal(whole.leaf(c), parts.leaf(c)));
  }
  for (std::size_t k = 0; k < 3; ++k) EXPECT_LT(parts.box().half[k], 1.1 * whole.box().half[k]);
  EXPECT_LT(parts.ball().radius, 1.1 * whole.ball().radius);
}

TEST(bounding_tree, made_by_threads_at_once_is_that_of_one) {
  const std::vector<Point3> points = scattered(20000);
  const WideBvh alone = lazy_tree_of(points, 2);
  for (int round = 0; round < 10; ++round) {
    const WideBvh shared = lazy_tree_of(points, 2);
    std::vector<std::vector<std::uint32_t>> found(4);
    std::vector<std::thread> threads;
    for (std::vector<std::uint32_t>& below : found) {
      threads.emplace_back([&] {
        std::size_t deepest = 0;
        walk(shared, points, shared.root().names[0], 0, below, deepest);
      });
    }
    for (std::thread& thread : threads) thread.join();
    for (const std::vector<std::uint32_t>& below : found) EXPECT_EQ(below, found[0]);
    EXPECT_EQ(found[0].size(), points.size());
    expect_same(alone, shared, alone.root(), shared.root());
  }
}

// An interruption while a part is made leaves nothing half made.
TEST(bounding_tree, makes_a_part_again_that_failed) {
  const std::vector<Point3> points = scattered(3000);
  int calls = 0;
  const WideBvh tree(balls_at(points),
                     [&, fit = fit_to(points)](std::size_t leaf, std::span<const std::uint32_t> items,
                                               std::vector<Obb>& boxes) {
                       if (++calls % 100 == 50) throw std::bad_alloc();
                       fit(leaf, items, boxes);
                     });
  int failed = 0;
  std::vector<std::uint32_t> below;
  for (bool done = false; !done;) {
    below.clear();
    std::size_t deepest = 0;
    try {
      walk(tree, points, tree.root().names[0], 0, below, deepest);
      done = true;
    } catch (const std::bad_alloc&) {
      ++failed;
    }
  }
  EXPECT_GT(failed, 2);
  std::sort(below.begin(), below.end());
  ASSERT_EQ(below.size(), points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) EXPECT_EQ(below[i], i);
}

}  // namespace
}  // namespace snug::wide_bvh_test
