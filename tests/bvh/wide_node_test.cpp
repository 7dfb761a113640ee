#include <snug/bvh/wide_node.h>

#include <gtest/gtest.h>
#include <snug/geometry/rounding.h>
#include <support/direction.h>
#include <testing/boxes.h>
#include <testing/counts.h>
#include <testing/instruction_sets.h>
#include <testing/placed_points.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <optional>
#include <random>
#include <set>
#include <span>
#include <tuple>
#include <vector>

namespace snug::wide_node_test {
namespace {

using testing::any_frame;
using testing::any_points;
using testing::box_around;
using testing::distance_from_above;
using testing::Extended;
using testing::image;

// Small beside the unit, squares and then the lengths themselves leave single precision.
TEST(wide_node, distance_of_a_point_holds_for_sets_of_any_size) {
  std::mt19937_64 random(24);
  std::uniform_real_distribution<double> unit(-3, 3);
  int gaps = 0;
  for (int exponent = 0; exponent < 160; ++exponent) {
    const double size = std::ldexp(1.0, -exponent);
    Obb set;
    set.half = {size, size, size / 2};
    const WideNode node({&set, 1});
    for (int trial = 0; trial < 200; ++trial) {
      const Point3 p{size * unit(random), size * unit(random), size * unit(random)};
      WideNode::Distances found;
      node.distances(p, 0, found);
      if (!(found[0] > 0)) continue;
      ++gaps;
      const Vector3 beyond{std::max(0.0, std::fabs(p.x) - size), std::max(0.0, std::fabs(p.y) - size),
                           std::max(0.0, std::fabs(p.z) - size / 2)};
      ASSERT_LE(static_cast<double>(found[0]), std::hypot(beyond.x, beyond.y, beyond.z)) << exponent;
    }
  }
  EXPECT_GT(gaps, 10'000);
}

// A box of the source as the target's frame sees it, made in double precision as queries about points make it.
PlacedBox placed(const Obb& box, const RelativeFrame& frame) {
  PlacedBox seen;
  seen.centre = frame.apply(box.centre);
  const double scale = frame.scale;
  for (std::size_t k = 0; k < 3; ++k) {
    seen.box.half[k] =
        float_up(enlarged(scale * box.half[k]) + 1e-6 * scale * (box.half.x + box.half.y + box.half.z));
    const Vector3 axis = times(frame.rows, (1 / scale) * box.axes[k]);
    for (std::size_t i = 0; i < 3; ++i) seen.box.axes[k][i] = static_cast<float>(axis[i]);
  }
  return seen;
}

TEST(wide_node, sets_around_infinite_ones_are_infinite) {
  std::mt19937_64 random(25);
  const Obb infinite = box_of(Obb{}.axes, {unbounded, unbounded, unbounded}),
            finite = box_around(any_points(random, {0.3, -0.7, 1.1}, 0.1));
  for (const auto& parts : {std::vector{infinite}, {infinite, finite}, {finite, infinite}}) {
    const Obb around = merge(parts);
    EXPECT_EQ(ball_around(around).radius, INFINITY);
    const WideNode node({&around, 1});
    WideNode::Distances found;
    node.distances(Point3{50, 60, -70}, 0, found);
    EXPECT_LE(found[0], 0);
  }
}

// Two nodes near each other as two frames place them, in sizes and scales of their own.
struct TwoNodes {
  explicit TwoNodes(std::mt19937_64& random) : frames{any_frame(random), any_frame(random)} {
    // From 2^-20 to 2^19 times as large.
    if (random() % 2 == 0) {
      frames[1].scale = std::ldexp(frames[0].scale, static_cast<int>(random() % 40) - 20);
    }
    const std::array<Point3, 2> centres{{{0.3, -0.7, 1.1}, {-0.2, 0.4, 0.5}}};
    std::array<double, 2> placed_sizes;
    for (std::size_t s = 0; s < 2; ++s) {
      const double size = s == 1 && random() % 2 == 0 ? std::min(1.0, placed_sizes[0] / frames[1].scale)
                                                      : std::pow(10.0, -static_cast<double>(random() % 10));
      std::uniform_real_distribution<double> unit(-4 * size, 4 * size);
      placed_sizes[s] = size * frames[s].scale;
      for (std::uint32_t l = 0; l < 1 + random() % 8; ++l) {
        // Boxes that are far from cubes or that share axes, too.
        const Point3 centre =
            random() % 8 == 0 ? centres[s] : centres[s] + Vector3{unit(random), unit(random), unit(random)};
        clouds[s].push_back(any_points(random, centre, random() % 4 == 0 ? 0.1 * size : size));
        boxes[s].push_back(box_around(clouds[s].back()));
      }
      nodes[s] = WideNode(boxes[s]);
    }
    // From inside of each other to well apart.
    const double apart =
        std::array{0.1, 0.5, 2.0, 1000.0}[random() % 4] * (placed_sizes[0] + placed_sizes[1]);
    std::uniform_real_distribution<double> unit(-apart, apart);
    const Extended at_a = image(frames[0], centres[0]), at_b = image(frames[1], centres[1]);
    for (std::size_t k = 0; k < 3; ++k) {
      frames[1].translation[k] += static_cast<double>(at_a[k] - at_b[k]) + unit(random);
      // Both far away: their doubles are apart by what is left of them.
      if (random() % 4 == 0) {
        for (PlacedFrame& frame : frames) frame.translation[k] += 0x1p20;
      }
    }
    view = View(RelativeFrame(frames[0], frames[1]));
    switch (random() % 3) {
      case 0:
        break;
      case 1:
        view.look_along({unit(random), unit(random), unit(random)});
        break;
      default:
        // From one of A's points to one of B's, as A's frame sees them.
        view.look_along(view.frame.apply(clouds[1][0][0]) - clouds[0][0][0]);
    }
    prune_distance = static_cast<float>(random() % 3 == 0   ? INFINITY
                                        : random() % 2 == 0 ? 0.0
                                                            : placed_sizes[1] / frames[0].scale);
  }
  // Of images, in extended precision.
  [[nodiscard]] long double rounding() const {
    return 0x1p-60L * (max_abs(frames[0].translation) + max_abs(frames[1].translation));
  }
  [[nodiscard]] std::vector<std::vector<Extended>> images(std::size_t s) const {
    std::vector<std::vector<Extended>> all;
    for (const auto& cloud : clouds[s]) {
      auto& out = all.emplace_back();
      for (const Point3& p : cloud) out.push_back(image(frames[s], p));
    }
    return all;
  }

  std::array<WideNode, 2> nodes;
  std::array<PlacedFrame, 2> frames;
  std::array<std::vector<std::vector<Point3>>, 2> clouds;
  std::array<std::vector<Obb>, 2> boxes;
  View view;
  float prune_distance;
};

// The reported places follow from the gaps.
void expect_agrees(const WideNode::Near& near, const WideNode::Distances& gaps, std::size_t count,
                   float prune) {
  float others = INFINITY;
  for (std::size_t l = 0; l < WideNode::width; ++l) {
    const bool beyond = gaps[l] > prune;
    EXPECT_EQ((near.places >> l & 1u) != 0, l < count && !beyond);
    if (l < count && beyond) others = std::min(others, gaps[l]);
  }
  EXPECT_EQ(near.others, others);
}

constexpr std::array both_gaps{WideNode::Gaps::axes, WideNode::Gaps::lines};

TEST(wide_node, distances_to_a_box_of_another_never_exceed_those_of_the_contents) {
  std::mt19937_64 random(27);
  std::array<std::size_t, 2> gaps{}, tight{};
  std::size_t dropped = 0, total = 0, axis_alone = 0, line_alone = 0;
  for (int trial = 0; trial < static_cast<int>(testing::fewer(3000)); ++trial) {
    const TwoNodes two(random);
    if (!two.view.frame.comparable) continue;
    const auto in_a = two.images(0), in_b = two.images(1);
    for (std::size_t j = 0; j < in_b.size(); ++j) {
      std::array<WideNode::Distances, 2> found;
      for (const std::size_t which : {0u, 1u}) {
        const WideNode::Near near = two.nodes[0].distances(two.nodes[1], j, two.view, two.prune_distance,
                                                           both_gaps[which], found[which]);
        expect_agrees(near, found[which], in_a.size(), two.prune_distance);
        dropped += in_a.size() - static_cast<std::size_t>(std::popcount(near.places));
      }
      for (std::size_t i = 0; i < in_a.size(); ++i) {
        total += 2;
        axis_alone += found[0][i] > 0 && !(found[1][i] > 0);
        line_alone += found[1][i] > 0 && !(found[0][i] > 0);
        if (!(found[0][i] > 0) && !(found[1][i] > 0)) continue;
        const long double exact = distance_from_above(in_a[i], in_b[j], random);
        for (const std::size_t which : {0u, 1u}) {
          if (!(found[which][i] > 0)) continue;
          ++gaps[which];
          const double gap = static_cast<double>(found[which][i]) * two.view.frame.to_world;
          tight[which] += gap > 0.9 * static_cast<double>(exact);
          ASSERT_LE(gap, exact + two.rounding()) << trial << ": " << i << ' ' << j << ", which " << which;
        }
      }
    }
  }
  std::printf("  of %zu pairs %zu gaps, %zu nearly whole; lines %zu, %zu; %zu, %zu the one alone\n",
              total / 2, gaps[0], tight[0], gaps[1], tight[1], axis_alone, line_alone);
  EXPECT_GT(gaps[0], total / 6);
  EXPECT_GT(tight[0], gaps[0] / 20);
  EXPECT_GT(tight[1], gaps[1] / 20);
  EXPECT_GT(dropped, total / 8);
  // Axes find a gap where lines do, but for what axes that are nearly parallel make of roundings.
  EXPECT_LE(line_alone, total / 1000);
}

// What a walk hands out of a node's boxes beside one of another node.
struct Walked {
  std::uint32_t places = 0, first = 0;
  float others = INFINITY;
};
Walked walked(const WideNode& node, const WideNode& other, std::size_t place, const TreeView& view,
              float distance) {
  const std::array<std::uint32_t, 1> name{kernels::leaf_bit};
  const Obb any;
  const WideNode root({&any, 1}, name);
  WideNode leaf = node;
  std::atomic<kernels::NodeBoxes*> leaves{&leaf};
  std::array<kernels::WalkedPair, WideNode::width> waiting;
  kernels::Walk walk;
  walk.trees[0].leaves = &leaves;
  walk.trees[0].view = view;
  walk.trees[0].distance = distance;
  walk.at_hand = {
      {{&root, 0, kernels::WalkedBox::not_patch}, {&other, static_cast<std::uint32_t>(place), 0}}};
  walk.has_pair = true;
  walk.waiting = waiting.data();
  walk.capacity = waiting.size();
  Walked result;
  while (go_on(walk) == kernels::Walk::Halt::patches) {
    const std::uint32_t found = walk.at_hand[0].place;
    if (result.places == 0) result.first = found;
    EXPECT_EQ(result.places >> found & 1u, 0u);
    result.places |= 1u << found;
  }
  EXPECT_EQ(walk.box_tests, node.count());
  result.others = walk.others;
  return result;
}

// What a walk passes over is as far away as it says; and it passes over most of what gaps in double precision do.
TEST(wide_node, a_walk_passes_over_no_box_that_is_near) {
  std::mt19937_64 random(32);
  std::size_t passed = 0, by_gaps = 0, total = 0;
  for (int trial = 0; trial < static_cast<int>(testing::fewer(4000)); ++trial) {
    const TwoNodes two(random);
    if (!two.view.frame.comparable) continue;
    const TreeView view(two.view.frame);
    const auto in_a = two.images(0), in_b = two.images(1);
    for (std::size_t j = 0; j < in_b.size(); ++j) {
      const Walked near = walked(two.nodes[0], two.nodes[1], j, view, two.prune_distance);
      WideNode::Distances gaps;
      const WideNode::Near exact =
          two.nodes[0].distances(two.nodes[1], j, two.view, two.prune_distance, WideNode::Gaps::axes, gaps);
      ASSERT_LT(near.places, 1u << in_a.size());
      for (std::size_t i = 0; i < in_a.size(); ++i) {
        ++total;
        by_gaps += (exact.places >> i & 1u) == 0;
        if ((near.places >> i & 1u) != 0) continue;
        ++passed;
        const long double apart = distance_from_above(in_a[i], in_b[j], random) + two.rounding();
        ASSERT_LT(static_cast<double>(two.prune_distance) * two.view.frame.to_world, apart) << trial;
        ASSERT_LE(static_cast<double>(near.others) * two.view.frame.to_world, apart) << trial;
      }
    }
  }
  std::printf("  of %zu pairs %zu passed over, %zu by gaps\n", total, passed, by_gaps);
  EXPECT_GT(passed, total / 12);
  EXPECT_GT(passed, by_gaps / 2);
}

// Small boxes face to face, at a distance that is known far better than single precision knows places: near each other far from
// their origins, or far apart.
TEST(wide_node, a_walk_tells_no_gap_that_is_wider_than_the_boxes_are_apart) {
  std::mt19937_64 random(33);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
  std::size_t near_passed = 0, far_passed = 0;
  for (int trial = 0; trial < static_cast<int>(testing::fewer(20'000)); ++trial) {
    const bool far = trial % 2 == 0;
    const double half = far ? 0.01 : 1e-3, from_origin = far ? 0.1 : 3;
    std::array<PlacedFrame, 2> frames{any_frame(random), any_frame(random)};
    frames[1].rows = frames[0].rows;
    frames[1].defect = frames[0].defect;
    frames[0].scale = frames[1].scale = 1;
    std::array<Obb, 2> boxes;
    for (Obb& box : boxes) {
      box.centre = {from_origin * unit(), from_origin * unit(), from_origin * unit()};
      box.half = {half * (1.5 + 0.5 * unit()), half * (1.5 + 0.5 * unit()), half * (1.5 + 0.5 * unit())};
    }
    const std::size_t axis = random() % 3;
    const double gap = far ? 500 * (1 + unit()) : 4e-4 * (1 + unit());
    Vector3 between{0.5 * half * unit(), 0.5 * half * unit(), 0.5 * half * unit()};
    between[axis] = (random() % 2 == 0 ? 1 : -1) * (boxes[0].half[axis] + boxes[1].half[axis] + gap);
    frames[0].translation = {unit(), unit(), unit()};
    const Vector3 moved = (boxes[0].centre - Point3{}) + between - (boxes[1].centre - Point3{});
    frames[1].translation = frames[0].translation + times(frames[0].rows, moved);
    const RelativeFrame seen(frames[0], frames[1]);
    const WideNode a({&boxes[0], 1}), b({&boxes[1], 1});
    const Walked near = walked(a, b, 0, TreeView(seen), 0);
    if (near.places != 0) continue;
    ++(far ? far_passed : near_passed);
    // Places in doubles are off by less than the last term; scales of motions by their defects.
    const double known = gap + 4 * (frames[0].defect + frames[1].defect) * (gap + 8) + 1e-12;
    ASSERT_LE(static_cast<double>(near.others) * seen.to_world, known) << trial;
  }
  EXPECT_GT(near_passed, testing::fewer(3000));
  EXPECT_GT(far_passed, testing::fewer(9000));
}

// Every pair of patches of two trees comes once where all are near, and a walk goes on after each halt.
TEST(wide_node, a_walk_goes_on_with_more_room_and_with_nodes_that_were_not_made) {
  const PlacedFrame frame;
  const RelativeFrame seen(frame, frame);
  std::array<Obb, WideNode::width> boxes;
  std::array<std::uint32_t, WideNode::width> names;
  for (std::uint32_t k = 0; k < WideNode::width; ++k) {
    boxes[k].centre = {0.1 * k, 0.05 * k * k, 0};
    boxes[k].half = {0.1, 0.2, 0.1};
    names[k] = kernels::leaf_bit | k;
  }
  const std::array<std::uint32_t, 1> name_of_root{0};
  const WideNode whole({&boxes[0], 1}, name_of_root);
  const WideNode root(boxes, names);
  WideNode leaf(boxes);
  std::atomic<bool> made[2] = {false, false};
  std::array<std::array<std::atomic<kernels::NodeBoxes*>, WideNode::width>, 2> leaves{};
  std::vector<kernels::WalkedPair> waiting(WideNode::width);
  kernels::Walk walk;
  for (std::size_t s = 0; s < 2; ++s) {
    kernels::WalkedTree& tree = walk.trees[s];
    tree.nodes = &root;
    tree.made = &made[s];
    tree.leaves = leaves[s].data();
    tree.view = TreeView(seen);
    tree.distance = 100;
    walk.at_hand[s] = {&whole, 0, kernels::WalkedBox::not_patch};
  }
  walk.has_pair = true;
  walk.waiting = waiting.data();
  walk.capacity = waiting.size();
  std::set<std::array<std::uint32_t, 4>> pairs;
  std::array<std::size_t, 4> halts{};
  for (auto why = go_on(walk); why != kernels::Walk::Halt::end; why = go_on(walk)) {
    ++halts[static_cast<std::size_t>(why)];
    if (why == kernels::Walk::Halt::patches) {
      const auto& [a, b] = walk.at_hand;
      EXPECT_TRUE(pairs.insert({a.leaf, a.place, b.leaf, b.place}).second);
    } else if (why == kernels::Walk::Halt::full) {
      waiting.resize(waiting.size() + 3);
      walk.waiting = waiting.data();
      walk.capacity = waiting.size();
    } else if (walk.name == 0) {
      made[walk.side] = true;
    } else {
      leaves[walk.side][walk.name & ~kernels::leaf_bit] = &leaf;
    }
  }
  EXPECT_EQ(pairs.size(), 4096u);
  EXPECT_EQ(walk.others, INFINITY);
  EXPECT_EQ(halts[static_cast<std::size_t>(kernels::Walk::Halt::not_made)], 18u);
  EXPECT_GT(halts[static_cast<std::size_t>(kernels::Walk::Halt::full)], 2u);
}

// A pair of frames sees each other as either does by itself, to the bit.
TEST(wide_node, frames_that_are_made_together_are_those_made_alone) {
  std::mt19937_64 random(31);
  for (int trial = 0; trial < 200; ++trial) {
    const TwoNodes two(random);
    const auto both = RelativeFrame::both(two.frames[0], two.frames[1]);
    for (std::size_t s = 0; s < 2; ++s) {
      const RelativeFrame alone(two.frames[s], two.frames[1 - s]);
      EXPECT_EQ(both[s].comparable, alone.comparable);
      if (!alone.comparable) continue;
      EXPECT_EQ(both[s].rows, alone.rows);
      EXPECT_EQ(both[s].translation, alone.translation);
      EXPECT_EQ(both[s].slack, alone.slack);
    }
  }
}

// Placed in double precision, or in single as a part of its node.
TEST(wide_node, distances_to_a_placed_box_never_exceed_those_of_the_contents) {
  std::mt19937_64 random(23);
  std::size_t gaps = 0, total = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const TwoNodes two(random);
    if (!two.view.frame.comparable) continue;
    const auto in_a = two.images(0), in_b = two.images(1);
    const PlacedBox seen = placed(two.boxes[1][0], two.view.frame);
    WideNode::Distances found;
    const WideNode::Near near = two.nodes[0].distances(seen, two.view.frame.slack, two.prune_distance, found);
    expect_agrees(near, found, in_a.size(), two.prune_distance);
    for (std::size_t l = 0; l < in_a.size(); ++l) {
      ++total;
      if (!(found[l] > 0)) continue;
      ++gaps;
      ASSERT_LE(static_cast<double>(found[l]) * two.view.frame.to_world,
                distance_from_above(in_a[l], in_b[0], random) + two.rounding())
          << trial;
    }
  }
  EXPECT_GT(gaps, total / 4);
}

TEST(wide_node, extents_are_at_least_those_of_the_contents) {
  std::mt19937_64 random(31);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::size_t close = 0, total = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const TwoNodes two(random);
    for (std::size_t s = 0; s < 2; ++s) {
      Vector3 w{unit(random), unit(random), unit(random)};
      if (random() % 4 == 0) w[random() % 3] *= 1e-30;
      if (random() % 4 == 0) w = two.boxes[s][0].axes[random() % 3];
      w = normalized(w);
      WideNode::Distances found;
      two.nodes[s].extents(w, found);
      for (std::size_t i = 0; i < two.clouds[s].size(); ++i) {
        long double most = -INFINITY, size = 0;
        for (const Point3& p : two.clouds[s][i]) {
          long double height = 0;
          for (std::size_t k = 0; k < 3; ++k) {
            const long double x = static_cast<long double>(p[k]) - two.nodes[s].origin()[k];
            height += w[k] * x;
            size = std::max(size, std::fabs(x));
          }
          most = std::max(most, height);
        }
        ASSERT_GE(static_cast<long double>(found[i]), most) << trial;
        ++total;
        close += found[i] - most < 0.5L * size;
      }
    }
  }
  EXPECT_GT(close, total / 4);
}

TEST(wide_node, distances_are_the_same_on_every_instruction_set) {
  std::mt19937_64 random(28);
  const testing::EachInstructionSet sets;
  for (int trial = 0; trial < 300; ++trial) {
    const TwoNodes two(random);
    const PlacedBox seen = placed(two.boxes[1][0], two.view.frame);
    std::optional<std::vector<float>> first;
    sets.run([&](const char* name) {
      std::vector<float> all;
      WideNode::Distances one;
      const auto add = [&](const WideNode::Near& near) {
        all.push_back(near.others);
        all.push_back(static_cast<float>(near.places));
        all.insert(all.end(), one.begin(), one.end());
      };
      for (std::size_t j = 0; j < two.nodes[1].count() && two.view.frame.comparable; ++j) {
        for (const WideNode::Gaps which : both_gaps) {
          add(two.nodes[0].distances(two.nodes[1], j, two.view, two.prune_distance, which, one));
        }
        const Walked near =
            walked(two.nodes[0], two.nodes[1], j, TreeView(two.view.frame), two.prune_distance);
        all.insert(all.end(), {static_cast<float>(near.places), static_cast<float>(near.first), near.others});
      }
      add(two.nodes[0].distances(seen, two.view.frame.slack, two.prune_distance, one));
      two.nodes[0].distances(two.clouds[0][0][0] + Vector3{0.1, 0.2, 0.3}, 0, one);
      all.insert(all.end(), one.begin(), one.end());
      two.nodes[0].extents({0.6, 0, 0.8}, one);
      all.insert(all.end(), one.begin(), one.end());
      if (!first) first = all;
      EXPECT_EQ(all, *first) << name << ' ' << trial;
    });
  }
}

// A source far smaller than the target, down to where its scale leaves single precision.
TEST(wide_node, distances_hold_for_sources_of_any_smallness) {
  std::mt19937_64 random(29);
  std::size_t gaps = 0;
  for (int exponent = 0; exponent < 1000; exponent += exponent < 160 ? 1 : 40) {
    for (int trial = 0; trial < 20; ++trial) {
      const Point3 centre_a{0.3, -0.7, 1.1}, centre_b{-0.2, 0.4, 0.5};
      const auto a = any_points(random, centre_a, 0.1), b = any_points(random, centre_b, 1);
      const Obb of_a = box_around(a), of_b = box_around(b);
      const PlacedFrame frame_a = any_frame(random);
      PlacedFrame frame_b = any_frame(random);
      frame_b.scale = std::ldexp(1.0, -exponent);
      const Extended at_a = image(frame_a, centre_a), at_b = image(frame_b, centre_b);
      std::uniform_real_distribution<double> unit(-0.5, 0.5);
      for (std::size_t k = 0; k < 3; ++k) {
        frame_b.translation[k] += static_cast<double>(at_a[k] - at_b[k]) + unit(random);
      }
      const WideNode one({&of_a, 1}), other({&of_b, 1});
      const View view(RelativeFrame(frame_a, frame_b));
      ASSERT_TRUE(view.frame.comparable);
      std::vector<Extended> in_a, in_b;
      for (const Point3& p : a) in_a.push_back(image(frame_a, p));
      for (const Point3& p : b) in_b.push_back(image(frame_b, p));
      for (const WideNode::Gaps which : both_gaps) {
        WideNode::Distances found;
        static_cast<void>(one.distances(other, 0, view, 0, which, found));
        gaps += found[0] > 0;
        ASSERT_LE(static_cast<double>(found[0]) * view.frame.to_world,
                  distance_from_above(in_a, in_b, random))
            << exponent;
      }
    }
  }
  EXPECT_GT(gaps, 1000u);
}

TEST(wide_node, distance_to_a_point_never_exceeds_that_of_the_contents) {
  std::mt19937_64 random(24);
  int gaps = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const double size = std::pow(10.0, -static_cast<double>(random() % 7));
    const std::vector<Point3> cloud = any_points(random, {0.4, 0.1, -1}, size);
    const Obb set = box_around(cloud);
    const WideNode node({&set, 1});
    std::uniform_real_distribution<double> unit(-2 * size, 2 * size);
    const Point3 p = cloud[0] + Vector3{unit(random), unit(random), unit(random)};
    WideNode::Distances found;
    node.distances(p, 0, found);
    std::vector<Extended> points;
    for (const Point3& q : cloud) points.push_back(testing::extended(q));
    gaps += found[0] > 0;
    ASSERT_LE(found[0], distance_from_above(points, {testing::extended(p)}, random)) << trial;
  }
  EXPECT_GT(gaps, 1000);
}

PlacedFrame unmoved() {
  PlacedFrame frame;
  frame.rows = {Vector3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  return frame;
}

TEST(wide_node, boxes_side_by_side_are_as_far_as_they_are) {
  const auto cube = [](double x) {
    const Extent unit{0, 1};
    return box_of(Obb{}.axes, {Extent{x, x + 1}, unit, unit});
  };
  const Obb a = cube(0), b = cube(3);
  const WideNode one({&a, 1}), two({&b, 1});
  const View view(RelativeFrame(unmoved(), unmoved()));
  for (const WideNode::Gaps which : both_gaps) {
    WideNode::Distances found;
    static_cast<void>(one.distances(two, 0, view, INFINITY, which, found));
    EXPECT_NEAR(found[0], 2, 0.001);
    EXPECT_LE(found[0], 2);
  }
  WideNode::Distances found;
  static_cast<void>(one.distances(placed(b, view.frame), view.frame.slack, INFINITY, found));
  EXPECT_NEAR(found[0], 2, 0.001);
  EXPECT_LE(found[0], 2);
}

TEST(wide_node, what_is_not_finite_is_apart_from_nothing) {
  for (const double bad : std::array<double, 3>{INFINITY, NAN, 1e300}) {
    const Extent far{-1, bad};
    const Obb a = box_of(Obb{}.axes, {far, far, far}), b = box_around({{9, 9, 9}});
    const std::array both{b, a}, turned{a, b};
    const View view(RelativeFrame(unmoved(), unmoved()));
    for (const WideNode::Gaps which : both_gaps) {
      // A box of a node where another one is not finite is not apart from anything either, or it is.
      for (const auto& [one, other, place] : {std::tuple{WideNode({&a, 1}), WideNode({&b, 1}), 0u},
                                              std::tuple{WideNode({&b, 1}), WideNode({&a, 1}), 0u},
                                              std::tuple{WideNode({&b, 1}), WideNode(both), 1u},
                                              std::tuple{WideNode(turned), WideNode({&b, 1}), 0u}}) {
        WideNode::Distances found;
        const WideNode::Near near = one.distances(other, place, view, 0, which, found);
        EXPECT_FALSE(found[0] > 0) << bad;
        EXPECT_EQ(near.places & 1u, 1u) << bad;
        static_cast<void>(one.distances(other, place, view, INFINITY, which, found));
        EXPECT_FALSE(found[0] > 0) << bad;
      }
    }
    WideNode::Distances found;
    static_cast<void>(WideNode({&a, 1}).distances(placed(b, view.frame), view.frame.slack, INFINITY, found));
    EXPECT_FALSE(found[0] > 0) << bad;
    static_cast<void>(WideNode({&b, 1}).distances(placed(a, view.frame), view.frame.slack, INFINITY, found));
    EXPECT_FALSE(found[0] > 0) << bad;
  }
}

TEST(wide_node, merging_keeps_the_contents) {
  std::mt19937_64 random(25);
  for (int trial = 0; trial < 1000; ++trial) {
    std::vector<Obb> parts;
    std::vector<Point3> points;
    for (int i = 0; i < 5; ++i) {
      const auto cloud = any_points(random, {0.1 * i, 1 - 0.3 * i, 0.5}, 0.2);
      points.insert(points.end(), cloud.begin(), cloud.end());
      parts.push_back(box_around(cloud));
    }
    const Obb all = merge(parts);
    const Ball ball = ball_around(all);
    for (const Point3& p : points) {
      EXPECT_LE(distance(p, ball.centre), ball.radius);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_LE(std::fabs(dot(all.axes[k], p - all.centre)), all.half[k]);
      }
    }
  }
}

}  // namespace
}  // namespace snug::wide_node_test
