// A program of its own, since it counts every allocation; not under sanitizers, which have allocators of
// their own.
#include <gtest/gtest.h>
#include <snug/snug.h>
#include <testing/places.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>
#include <vector>

namespace {
std::atomic<std::size_t> allocations{0};
}  // namespace

#ifdef SNUG_SANITIZED
constexpr bool counting = false;
#else
constexpr bool counting = true;

void* operator new(std::size_t size) {
  ++allocations;
  if (void* const p = std::malloc(size ? size : 1)) return p;
  throw std::bad_alloc();
}
void* operator new[](std::size_t size) { return operator new(size); }
void* operator new(std::size_t size, std::align_val_t align) {
  ++allocations;
  const auto to = static_cast<std::size_t>(align);
  if (void* const p = std::aligned_alloc(to, (size + to - 1) / to * to)) return p;
  throw std::bad_alloc();
}
void* operator new[](std::size_t size, std::align_val_t align) { return operator new(size, align); }
void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }
#endif

namespace snug::moving_allocation_test {
namespace {

class MovingAllocation : public ::testing::Test {
 protected:
  // A cycle of eight frames.
  void frame(const ControlMesh& mesh, MovingSurface& a, MovingSurface& b, int time) {
    const double phase = time % 8 * 0.7853981633974483;
    points_ = mesh.points;
    for (Point3& p : points_) p.z += 0.05 * std::sin(3 * p.x + phase);
    a.move(points_);
    for (Point3& p : points_) p.y += 0.05 * std::cos(2 * p.z + phase);
    b.move(points_);
  }
  std::vector<Point3> points_;
};

// Allocations of a frame beyond those of the same queries about surfaces that stay.
TEST_F(MovingAllocation, a_warm_frame_takes_no_memory) {
  if (!counting) GTEST_SKIP() << "a sanitizer has the allocator";
  for (const char* const name : {"star.obj", "bust.obj", "pawn.obj"}) {
    const ControlMesh mesh = read_mesh(testing::models_dir() + "/" + name);
    const Surface first(mesh);
    MovingSurface a(first), b(first);
    const Motion apart = Motion::translation({1.3 * first.size(), 0, 0}),
                 touching = Motion::translation({0.9 * first.size(), 0, 0});
    double sum = 0;
    std::size_t moves = 0, queries = 0;
    for (int time = 0; time < 48; ++time) {
      std::size_t before = allocations;
      frame(mesh, a, b, time);
      if (time >= 32) moves += allocations - before;
      before = allocations;
      sum += distance(a.now(), b.now().at(apart), {.relative = 0.01}).distance.lower;
      sum += static_cast<double>(collide(a.now(), b.now().at(apart)).verdict);
      sum += static_cast<double>(collide(a.now(), b.now().at(touching), {.tolerance = 1e-3}).verdict);
      sum += closest_point(a.now(), {2, 1, 1}, {.relative = 1e-3}).distance.lower;
      if (time >= 32) queries += allocations - before;
    }
    EXPECT_GT(sum, 0);
    EXPECT_EQ(moves, 0u) << name;
    EXPECT_EQ(queries, 0u) << name;
  }
}

}  // namespace
}  // namespace snug::moving_allocation_test
