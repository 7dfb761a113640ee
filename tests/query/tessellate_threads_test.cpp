#include <snug/tessellate.h>

#include <gtest/gtest.h>
#include <testing/places.h>

namespace snug::tessellate_threads_test {
namespace {

TEST(tessellate, does_not_depend_on_threads) {
  for (const char* const file : {"pawn.obj", "ring.obj", "bracket.obj"}) {
    const Surface surface = load(testing::models_dir() + "/" + file, {.scheme = Scheme::catmark});
    TessellateOptions options;
    options.error = 1e-3 * surface.size();
    const Tessellation one = tessellate(surface, options, {.threads = 1});
    const Tessellation three = tessellate(surface, options, {.threads = 3});
    EXPECT_EQ(one.positions, three.positions) << file;
    EXPECT_EQ(one.normals, three.normals) << file;
    EXPECT_EQ(one.triangles, three.triangles) << file;
    EXPECT_EQ(one.owners, three.owners) << file;
    EXPECT_EQ(one.error_bound, three.error_bound) << file;
    EXPECT_EQ(one.position_error, three.position_error) << file;
  }
}

}  // namespace
}  // namespace snug::tessellate_threads_test
