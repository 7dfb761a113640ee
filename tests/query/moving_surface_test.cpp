#include <snug/snug.h>

#include <gtest/gtest.h>
#include <snug/search/surface_data.h>
#include <snug/search/workspace.h>
#include <testing/journeys.h>
#include <testing/places.h>

#include <atomic>
#include <optional>
#include <set>
#include <thread>
#include <vector>

namespace snug::moving_surface_test {
namespace {

using testing::Journey;

ControlMesh model(const char* name) { return read_mesh(testing::models_dir() + "/" + name); }

// A wave along x, another one each time.
std::vector<Point3> wave(const std::vector<Point3>& rest, double time) {
  std::vector<Point3> points = rest;
  for (Point3& p : points) p.z += 0.1 * std::sin(3 * p.x + time);
  return points;
}

// All that is asked about a surface, in numbers.
std::vector<double> answers(const Surface& surface, const Surface& other, Workspace& workspace) {
  const PlacedSurface beside = other.at(Motion::translation({0.7 * other.size(), 0, 0}));
  const ClosestPoint closest =
      closest_point(surface, {1, 2, 3}, {.relative = 1e-6}, {.workspace = &workspace});
  const Distance apart = distance(surface, beside, {.relative = 1e-3}, {.workspace = &workspace});
  const Collision contact = collide(surface, beside, {.tolerance = 1e-4}, {.workspace = &workspace});
  const RayHits hits = snug::ray(surface, {{10, 0.1, 0.2}, {-1, 0, 0}}, {}, {.workspace = &workspace});
  return {closest.distance.lower,
          closest.distance.upper,
          closest.point.x,
          apart.distance.lower,
          apart.distance.upper,
          contact.distance.lower,
          contact.distance.upper,
          static_cast<double>(contact.verdict),
          static_cast<double>(hits.hits.size())};
}
std::vector<double> answers(const Surface& surface, const Surface& other) {
  Workspace fresh;
  return answers(surface, other, fresh);
}

void expect_no_contradiction(const std::vector<double>& x, const std::vector<double>& y) {
  for (const std::size_t at : {0u, 3u, 5u}) {
    EXPECT_LE(x[at], y[at + 1]) << at;
    EXPECT_LE(y[at], x[at + 1]) << at;
  }
  const auto verdict = [](const std::vector<double>& of) { return static_cast<Verdict>(of[7]); };
  const bool x_apart = verdict(x) == Verdict::separated, y_apart = verdict(y) == Verdict::separated;
  EXPECT_FALSE(x_apart && verdict(y) == Verdict::intersecting);
  EXPECT_FALSE(y_apart && verdict(x) == Verdict::intersecting);
}

TEST(moving_surface, frames_are_the_surfaces_of_their_points) {
  std::mt19937_64 random(3);
  const Surface other(model("star.obj"));
  for (const char* const name : {"star.obj", "bust.obj", "pawn.obj"}) {
    const ControlMesh mesh = model(name);
    MovingSurface moving{Surface(mesh)};
    EXPECT_EQ(moving.now().mesh().points, mesh.points);
    for (std::size_t j = 0; j < testing::journey_count; ++j) {
      const auto journey = static_cast<Journey>(j);
      SCOPED_TRACE(name + (" " + testing::name_of(journey)));
      ControlMesh there = mesh;
      there.points = testing::start_of(journey, mesh.points, random);
      const Surface& frame = moving.move(there.points);
      EXPECT_EQ(&frame, &moving.now());
      EXPECT_EQ(frame.mesh().points, there.points);
      EXPECT_EQ(frame.mesh().face_vertices, mesh.face_vertices);
      const Surface fresh(there);
      EXPECT_EQ(frame.size(), fresh.size());
      EXPECT_EQ(frame.scheme(), fresh.scheme());
      expect_no_contradiction(answers(frame, other), answers(fresh, other));
    }
  }
}

// Frames are asked in any order, old ones and new ones, through one workspace: each answer has the bits of a
// workspace that knows nothing.
TEST(moving_surface, answers_are_never_those_of_another_frame) {
  std::mt19937_64 random(4);
  const ControlMesh mesh = model("star.obj");
  const Surface other(mesh);
  MovingSurface moving{Surface(mesh)};
  Workspace shared;
  struct Kept {
    std::optional<Surface> surface;
    std::vector<Point3> points;
    std::vector<double> answers;
  };
  std::vector<Kept> kept(4);
  std::set<std::vector<double>> different;
  int asked = 0;
  for (int step = 0; step < 600; ++step) {
    Kept& one = kept[random() % kept.size()];
    switch (random() % 4) {
      case 0:
        one.points = wave(mesh.points, 0.01 * step);
        moving.move(one.points);
        one.surface = moving.now();
        one.answers = answers(*one.surface, other);
        different.insert(one.answers);
        break;
      case 1:
        one.surface.reset();
        break;
      default:
        if (!one.surface) break;
        ++asked;
        EXPECT_EQ(one.surface->mesh().points, one.points);
        EXPECT_EQ(answers(*one.surface, other, shared), one.answers);
    }
    EXPECT_EQ(answers(moving.now(), other, shared), answers(moving.now(), other));
  }
  EXPECT_GT(asked, 100);
  EXPECT_GT(different.size(), 100u);
}

TEST(moving_surface, memory_is_used_again_once_nobody_holds_its_frame) {
  const ControlMesh mesh = model("star.obj");
  MovingSurface moving{Surface(mesh)};
  std::set<const SurfaceData*> places;
  std::set<std::uint64_t> numbers;
  for (int i = 0; i < 10; ++i) {
    moving.move(wave(mesh.points, i));
    places.insert(moving.now().data().get());
    numbers.insert(moving.now().data()->number());
  }
  EXPECT_EQ(places.size(), 2u);
  EXPECT_EQ(numbers.size(), 10u);
  const Surface held = moving.now();
  const std::vector<Point3> points = held.mesh().points;
  for (int i = 0; i < 10; ++i) {
    moving.move(wave(mesh.points, 20 + i));
    places.insert(moving.now().data().get());
    EXPECT_NE(moving.now().data(), held.data());
  }
  EXPECT_EQ(places.size(), 3u);
  EXPECT_EQ(held.mesh().points, points);
}

TEST(moving_surface, stays_as_it_was_where_points_are_refused) {
  const ControlMesh mesh = model("star.obj");
  MovingSurface moving{Surface(mesh)};
  for (int i = 0; i < 4; ++i) {  // as the first, and where memory is used again
    const Surface before = moving.now();
    const std::uint64_t number = before.data()->number();
    const auto expect_refused = [&](std::vector<Point3> points, const std::string& message) {
      try {
        moving.move(points);
        ADD_FAILURE() << "taken";
      } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
      }
      EXPECT_EQ(moving.now().data(), before.data());
      EXPECT_EQ(moving.now().data()->number(), number);
    };
    std::vector<Point3> points = mesh.points;
    points.pop_back();
    expect_refused(points, "give a point for each");
    points = mesh.points;
    points[5].y = NAN;
    expect_refused(points, "vertex 5 has a coordinate that is not finite");
    points[5].y = INFINITY;
    expect_refused(points, "vertex 5");
    expect_refused({}, "vertices, not 0");
    moving.move(wave(mesh.points, i));
  }
}

// Old frames are asked by threads while new ones are made, and are handed back.
TEST(moving_surface, threads_ask_old_frames_while_it_moves) {
  const ControlMesh mesh = model("star.obj");
  const Surface other(mesh);
  MovingSurface moving{Surface(mesh)};
  std::vector<std::vector<double>> expected;
  for (int i = 0; i < 24; ++i) {
    ControlMesh there = mesh;
    there.points = wave(mesh.points, i);
    expected.push_back(answers(Surface(there), other));
  }
  struct Slot {
    std::mutex mutex;
    std::optional<Surface> surface;
    std::size_t frame = 0;
  };
  std::array<Slot, 3> slots;
  std::atomic<bool> done{false};
  std::atomic<int> asked{0};
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 3; ++t) {
    threads.emplace_back([&, t] {
      Workspace own;
      while (!done) {
        std::optional<Surface> mine;
        std::size_t frame = 0;
        {
          const std::lock_guard lock(slots[t].mutex);
          mine.swap(slots[t].surface);
          frame = slots[t].frame;
        }
        if (!mine) {
          std::this_thread::yield();
          continue;
        }
        expect_no_contradiction(answers(*mine, other, own), expected[frame]);
        ++asked;
      }
    });
  }
  for (int round = 0; round < 6 || asked < 50; ++round) {
    for (std::size_t i = 0; i < expected.size(); ++i) {
      moving.move(wave(mesh.points, static_cast<double>(i)));
      Slot& slot = slots[i % slots.size()];
      const std::lock_guard lock(slot.mutex);
      slot.surface = moving.now();
      slot.frame = i;
    }
  }
  done = true;
  for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace snug::moving_surface_test
