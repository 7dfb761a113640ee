// A program of its own, since it counts every allocation; not under sanitizers, which have allocators of
// their own.
#include <gtest/gtest.h>
#include <snug/surface/batch_bounds.h>
#include <testing/patches.h>
#include <testing/tagged.h>

#include <atomic>
#include <cstdlib>
#include <new>

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
void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }
#endif

namespace snug::allocation_test {
namespace {

// Triangles of many valences under Loop; polygons and creases under Catmull-Clark.
std::vector<LimitSurface> surfaces() {
  std::mt19937_64 random(8);
  std::vector<LimitSurface> list;
  list.push_back(
      testing::surface_of(oracle::meshes::disturbed(oracle::meshes::grid(20, 20), 40, 0.2, random)));
  oracle::TaggedMesh mixed = oracle::meshes::pyramid(7);
  testing::tag(mixed, random, false);
  for (const oracle::TaggedMesh& mesh :
       {mixed, oracle::meshes::mixed_strip(), oracle::meshes::pole(20, true)}) {
    list.emplace_back(testing::control_mesh(mesh), SchemeOptions{Scheme::catmark},
                      std::make_shared<BoundsCache>());
  }
  return list;
}

void expect_none_once_rows_are_known(const LimitSurface& surface) {
  for (const BoundMethod method : {BoundMethod::rows, BoundMethod::table}) {
    BatchBounds bounds(surface, method);
    std::vector<OffsetTriangle> out(bounds.patches().size());
    bounds.update(surface.mesh().points, out);
    std::vector<Point3> points = surface.mesh().points;
    for (Point3& p : points) p.z += p.x * p.x;
    bounds.update(points, out);  // rows of kinds whose patches bend much
    for (Point3& p : points) p.z += 0.25;
    const std::size_t before = allocations;
    bounds.update(points, out);
    EXPECT_EQ(allocations - before, 0u);
    EXPECT_GT(before, 100u);
  }
}

TEST(allocation, patch_bounds_take_none_once_rows_are_known) {
  if (!counting) GTEST_SKIP() << "a sanitizer has the allocator";
  for (const LimitSurface& surface : surfaces()) expect_none_once_rows_are_known(surface);
}

}  // namespace
}  // namespace snug::allocation_test
