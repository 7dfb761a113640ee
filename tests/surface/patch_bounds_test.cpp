#include <snug/surface/patch_bounds.h>

#include <gtest/gtest.h>
#include <snug/base/error.h>
#include <snug/enclose/table_triangle.h>
#include <snug/surface/refinement.h>
#include <snug/surface/unscale.h>
#include <testing/patches.h>

#include <cmath>
#include <limits>

namespace snug {
namespace {

// Closed and open meshes with regular patches, extraordinary corners and boundaries.
std::vector<ControlMesh> meshes() {
  std::vector<ControlMesh> all;
  for (const oracle::TwinMesh& mesh :
       {oracle::meshes::icosahedron(), oracle::meshes::torus(7, 6), oracle::meshes::fan(9, 2)}) {
    all.push_back(testing::control_mesh(mesh));
  }
  return all;
}

TEST(patch_bounds, are_those_of_single_patches) {
}

}  // namespace
}  // namespace snug
