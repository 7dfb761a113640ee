#include <gtest/gtest.h>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>
#include <oracle/loop_twin.h>
#include <oracle/test_meshes.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

namespace oracle::loop_twin_opensubdiv_test {
namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

/// A position, in the form OpenSubdiv asks for.
struct Primvar {
  Point value{};
  void Clear() { value = {}; }
  void AddWithWeight(const Primvar& other, double weight) {
    for (std::size_t x = 0; x < 3; ++x) value[x] += weight * other.value[x];
  }
};

struct Compared {
  std::size_t count = 0;
  double worst = 0;  // relative to the largest coordinate
};

/// Refines with OpenSubdiv and compares the limit points at equal parameters. A face's children are numbered
/// like ours: corner 0, 1, 2, centre.
Compared compare(const TwinMesh& mesh, int levels) {
  Sdc::Options options;
  options.SetVtxBoundaryInterpolation(
      mesh.boundary == Boundary::edge_only ? Sdc::Options::VTX_BOUNDARY_EDGE_ONLY
      : mesh.boundary == Boundary::none    ? Sdc::Options::VTX_BOUNDARY_NONE
                                           : Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
  std::vector<int> sizes(mesh.triangles.size(), 3), indices;
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) indices.push_back(static_cast<int>(v));
  Far::TopologyDescriptor description;
  description.numVertices = static_cast<int>(mesh.points.size());
  description.numFaces = static_cast<int>(mesh.triangles.size());
  description.numVertsPerFace = sizes.data();
  description.vertIndicesPerFace = indices.data();
  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  const std::unique_ptr<Far::TopologyRefiner> refiner(
      Factory::Create(description, Factory::Options(Sdc::SCHEME_LOOP, options)));
  Far::TopologyRefiner::UniformOptions uniform(levels);
  uniform.fullTopologyInLastLevel = true;
  refiner->RefineUniform(uniform);

  const Far::PrimvarRefinerReal<double> primvars(*refiner);
  std::vector<Primvar> values(mesh.points.size());
  double largest = 0;
  for (std::size_t v = 0; v < values.size(); ++v) {
    values[v].value = mesh.points[v];
    for (const double x : mesh.points[v]) largest = std::max(largest, std::abs(x));
  }
  for (int level = 1; level <= levels; ++level) {
    std::vector<Primvar> fine(static_cast<std::size_t>(refiner->GetLevel(level).GetNumVertices()));
    primvars.Interpolate(level, values, fine);
    values = std::move(fine);
  }
  std::vector<Primvar> limit(values.size());
  primvars.Limit(values, limit);

  Compared compared;
  const std::size_t side = std::size_t{1} << levels;
  const auto samples = sample_uniform(mesh, levels);
  const std::size_t per_face = (side + 1) * (side + 2) / 2;
  for (std::size_t begin = 0; begin < samples.size(); begin += per_face) {
    // The descendants of the control face, with the parameters of their corners.
    struct Leaf {
      int face;
      std::array<std::array<double, 2>, 3> corners;
    };
    std::vector<Leaf> leaves{{static_cast<int>(samples[begin].face), {{{0, 0}, {1, 0}, {0, 1}}}}};
    for (int level = 0; level < levels; ++level) {
      std::vector<Leaf> fine;
      for (const Leaf& leaf : leaves) {
        const auto children = refiner->GetLevel(level).GetFaceChildFaces(leaf.face);
        std::array<std::array<double, 2>, 3> mid;
        for (std::size_t k = 0; k < 3; ++k)
          for (std::size_t x = 0; x < 2; ++x)
            mid[k][x] = (leaf.corners[k][x] + leaf.corners[(k + 1) % 3][x]) / 2;
        fine.push_back({children[0], {leaf.corners[0], mid[0], mid[2]}});
        fine.push_back({children[1], {mid[0], leaf.corners[1], mid[1]}});
        fine.push_back({children[2], {mid[2], mid[1], leaf.corners[2]}});
        fine.push_back({children[3], {mid[1], mid[2], mid[0]}});
      }
      leaves = std::move(fine);
    }
    for (const Leaf& leaf : leaves) {
      const auto vertices = refiner->GetLevel(levels).GetFaceVertices(leaf.face);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto i = static_cast<std::size_t>(leaf.corners[k][0] * static_cast<double>(side));
        const auto j = static_cast<std::size_t>(leaf.corners[k][1] * static_cast<double>(side));
        const LimitSample& sample = samples[begin + j * (side + 1) - j * (j - 1) / 2 + i];
        EXPECT_EQ(sample.u, leaf.corners[k][0]);
        EXPECT_EQ(sample.v, leaf.corners[k][1]);
        const Point& other = limit[static_cast<std::size_t>(vertices[static_cast<int>(k)])].value;
        for (std::size_t x = 0; x < 3; ++x)
          compared.worst = std::max(compared.worst, std::abs(other[x] - sample.position[x]) / largest);
        ++compared.count;
      }
    }
  }
  return compared;
}

TEST(loop_twin_and_opensubdiv, agree_on_closed_meshes) {
  std::mt19937_64 random(11);
  for (const TwinMesh& mesh :
       {meshes::disturbed(meshes::icosahedron(), 20, 0.3, random), meshes::bipyramid(3),
        meshes::disturbed(meshes::bipyramid(30), 10, 0.3, random)}) {
    const Compared compared = compare(mesh, 4);
    EXPECT_EQ(compared.count, mesh.triangles.size() * 256 * 3);
    EXPECT_LE(compared.worst, 1e-12);
  }
}

TEST(loop_twin_and_opensubdiv, agree_on_boundaries) {
  std::mt19937_64 random(12);
  for (const Boundary boundary : {Boundary::edge_and_corner, Boundary::edge_only})
    for (const TwinMesh& mesh :
         {meshes::disturbed(meshes::grid(4, 3, boundary), 12, 0.3, random),
          meshes::disturbed(meshes::wheel(7, boundary), 5, 0.3, random), meshes::grid(1, 1, boundary)}) {
      const Compared compared = compare(mesh, 4);
      EXPECT_EQ(compared.count, mesh.triangles.size() * 256 * 3);
      EXPECT_LE(compared.worst, 1e-12);
    }
}

TEST(loop_twin_and_opensubdiv, agree_inside_where_the_boundary_has_no_rule) {
  std::mt19937_64 random(13);
  const TwinMesh mesh = meshes::disturbed(meshes::grid(5, 4, Boundary::none), 12, 0.3, random);
  const Compared compared = compare(mesh, 3);
  EXPECT_GT(compared.count, 0U);
  EXPECT_LE(compared.worst, 1e-12);
}

}  // namespace
}  // namespace oracle::loop_twin_opensubdiv_test
