#include "peer_opensubdiv.h"

#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/surface.h>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/stencilTable.h>
#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>
#include <opensubdiv/osd/bufferDescriptor.h>
#include <opensubdiv/osd/cpuEvaluator.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

namespace snug::bench {

namespace Bfr = OpenSubdiv::Bfr;
namespace Far = OpenSubdiv::Far;
namespace Osd = OpenSubdiv::Osd;
namespace Sdc = OpenSubdiv::Sdc;

namespace {

// A position, in the form that Far asks for.
struct Primvar {
  Point3 value;
  void Clear() { value = {}; }
  void AddWithWeight(const Point3& other, double weight) {
    value.x += weight * other.x;
    value.y += weight * other.y;
    value.z += weight * other.z;
  }
  void AddWithWeight(const Primvar& other, double weight) { AddWithWeight(other.value, weight); }
};

std::vector<Primvar> primvars(std::span<const Point3> points) {
  std::vector<Primvar> values(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) values[i].value = points[i];
  return values;
}

std::unique_ptr<Far::TopologyRefiner> make_refiner(const ControlMesh& mesh) {
  std::vector<int> sizes, indices, creased;
  std::vector<float> sharpness;
  for (std::size_t f = 0; f < mesh.face_count(); ++f)
    sizes.push_back(static_cast<int>(mesh.face(FaceId(f)).size()));
  const bool triangles = std::all_of(sizes.begin(), sizes.end(), [](int size) { return size == 3; });
  indices.reserve(mesh.face_vertices.size());
  for (const VertexId v : mesh.face_vertices) indices.push_back(static_cast<int>(v.value()));
  for (const CreaseTag& crease : mesh.tags.creases) {
    creased.insert(creased.end(), {static_cast<int>(crease.a.value()), static_cast<int>(crease.b.value())});
    sharpness.push_back(static_cast<float>(crease.sharpness));
  }
  Far::TopologyDescriptor description;
  description.numVertices = static_cast<int>(mesh.vertex_count());
  description.numFaces = static_cast<int>(mesh.face_count());
  description.numVertsPerFace = sizes.data();
  description.vertIndicesPerFace = indices.data();
  description.numCreases = static_cast<int>(sharpness.size());
  description.creaseVertexIndexPairs = creased.data();
  description.creaseWeights = sharpness.data();
  Sdc::Options options;
  options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  std::unique_ptr<Far::TopologyRefiner> refiner(Factory::Create(
      description, Factory::Options(triangles ? Sdc::SCHEME_LOOP : Sdc::SCHEME_CATMARK, options)));
  if (!refiner) throw std::runtime_error("OpenSubdiv refuses the mesh");
  return refiner;
}

}  // namespace

struct OsdMesh::Impl {
  std::unique_ptr<Far::TopologyRefiner> refiner;
  std::vector<Point3> points;
};

OsdMesh::OsdMesh(const ControlMesh& mesh) : impl_(new Impl{make_refiner(mesh), mesh.points}) {}
OsdMesh::~OsdMesh() = default;

struct OsdSurfaces::Impl {
  using Surface = Bfr::Surface<double>;
  using Points = Surface::PointDescriptor;

  Impl(const OsdMesh& whole, bool cache)
      : mesh(whole.impl()), factory(*mesh.refiner, Bfr::SurfaceFactory::Options().EnableCaching(cache)) {}

  // The surface's patch points, into scratch.
  void prepare(const Surface& surface) {
    const auto size = 3 * static_cast<std::size_t>(surface.GetNumPatchPoints());
    if (scratch.size() < size) scratch.resize(size);
    surface.PreparePatchPoints(&mesh.points.front().x, Points(3), scratch.data(), Points(3));
  }

  const OsdMesh::Impl& mesh;
  Bfr::RefinerSurfaceFactory<> factory;
  std::vector<Surface> surfaces;
  std::vector<double> scratch;
};

OsdSurfaces::OsdSurfaces(const OsdMesh& mesh, std::span<const PatchId> faces, bool cache)
    : impl_(new Impl(mesh, cache)) {
  impl_->surfaces.resize(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (!impl_->factory.InitVertexSurface(static_cast<int>(faces[i].value()), &impl_->surfaces[i])) {
      throw std::runtime_error("OpenSubdiv has no surface for a face");
    }
  }
}
OsdSurfaces::~OsdSurfaces() = default;

double OsdSurfaces::patch_points() const {
  double sum = 0;
  for (const Impl::Surface& surface : impl_->surfaces) sum += surface.GetNumPatchPoints();
  return sum;
}

double OsdSurfaces::box_all() const {
  double sum = 0;
  for (const Impl::Surface& surface : impl_->surfaces) {
    impl_->prepare(surface);
    Box3 box;
    for (int i = 0; i < surface.GetNumPatchPoints(); ++i) {
      const double* p = impl_->scratch.data() + 3 * i;
      box.add(Point3{p[0], p[1], p[2]});
    }
    sum += longest_side(box);
  }
  return sum;
}

void OsdSurfaces::evaluate(std::size_t i, std::span<const TriangleParameter> at, std::span<Point3> out) {
  const Impl::Surface& surface = impl_->surfaces[i];
  impl_->prepare(surface);
  for (std::size_t k = 0; k < at.size(); ++k) {
    const double uv[2] = {at[k].u, at[k].v};
    surface.Evaluate(uv, impl_->scratch.data(), Impl::Points(3), &out[k].x);
  }
}

struct OsdStencils::Impl {
  std::unique_ptr<const Far::StencilTableReal<double>> table;
  std::vector<Primvar> values;
  std::vector<float> weights, points, results;
};

void OsdSurfaces::evaluate(std::size_t i, std::span<const TriangleParameter> at, std::span<Point3> out,
                           std::span<std::array<Vector3, 2>> derivatives) {
  const Impl::Surface& surface = impl_->surfaces[i];
  impl_->prepare(surface);
  for (std::size_t k = 0; k < at.size(); ++k) {
    const double uv[2] = {at[k].u, at[k].v};
    surface.Evaluate(uv, impl_->scratch.data(), Impl::Points(3), &out[k].x, &derivatives[k][0].x,
                     &derivatives[k][1].x);
  }
}

OsdStencils::OsdStencils() : impl_(new Impl) {}
OsdStencils::~OsdStencils() = default;
OsdStencils::OsdStencils(OsdStencils&&) noexcept = default;
OsdStencils& OsdStencils::operator=(OsdStencils&&) noexcept = default;

OsdStencils OsdStencils::limit(const ControlMesh& mesh, std::span<const TriangleParameter> at,
                               int isolation) {
  const auto refiner = make_refiner(mesh);
  refiner->RefineAdaptive(Far::TopologyRefiner::AdaptiveOptions(isolation));
  using Factory = Far::LimitStencilTableFactoryReal<double>;
  std::vector<double> s, t;
  for (const TriangleParameter& p : at) {
    s.push_back(p.u);
    t.push_back(p.v);
  }
  Factory::LocationArrayVec locations(mesh.face_count());
  for (std::size_t f = 0; f < locations.size(); ++f) {
    locations[f].ptexIdx = static_cast<int>(f);
    locations[f].numLocations = static_cast<int>(at.size());
    locations[f].s = s.data();
    locations[f].t = t.data();
  }
  Factory::Options options;
  options.generate1stDerivatives = false;
  OsdStencils result;
  result.impl_->table.reset(Factory::Create(*refiner, locations, nullptr, nullptr, options));
  if (!result.impl_->table) throw std::runtime_error("OpenSubdiv makes no limit stencils");
  result.impl_->values.resize(result.count());
  return result;
}

OsdStencils OsdStencils::refined(const ControlMesh& mesh) {
  const auto refiner = make_refiner(mesh);
  refiner->RefineUniform(Far::TopologyRefiner::UniformOptions(1));
  using Factory = Far::StencilTableFactoryReal<double>;
  Factory::Options options;
  options.generateIntermediateLevels = false;
  options.maxLevel = 1;
  OsdStencils result;
  result.impl_->table.reset(Factory::Create(*refiner, options));
  if (!result.impl_->table) throw std::runtime_error("OpenSubdiv makes no stencils");
  result.impl_->values.resize(result.count());
  return result;
}

std::size_t OsdStencils::count() const { return static_cast<std::size_t>(impl_->table->GetNumStencils()); }
std::size_t OsdStencils::weights() const { return impl_->table->GetWeights().size(); }

double OsdStencils::update(std::span<const Point3> points) {
  impl_->table->UpdateValues(points.data(), impl_->values.data());
  double sum = 0;
  for (const Primvar& value : impl_->values) sum += value.value.x;
  return sum;
}

void OsdStencils::set_float_points(std::span<const Point3> points) {
  impl_->points.clear();
  for (const Point3& p : points) {
    for (std::size_t x = 0; x < 3; ++x) impl_->points.push_back(static_cast<float>(p[x]));
  }
  impl_->weights.clear();
  for (const double w : impl_->table->GetWeights()) impl_->weights.push_back(static_cast<float>(w));
  impl_->results.resize(3 * count());
}

double OsdStencils::update_float() {
  const Osd::BufferDescriptor xyz(0, 3, 3);
  const auto& table = *impl_->table;
  Osd::CpuEvaluator::EvalStencils(impl_->points.data(), xyz, impl_->results.data(), xyz,
                                  table.GetSizes().data(), table.GetOffsets().data(),
                                  table.GetControlIndices().data(), impl_->weights.data(), 0,
                                  static_cast<int>(count()));
  double sum = 0;
  for (std::size_t i = 0; i < impl_->results.size(); i += 3) sum += static_cast<double>(impl_->results[i]);
  return sum;
}

std::vector<OsdLimitSample> osd_limit_samples(const ControlMesh& mesh, int level) {
  const auto refiner = make_refiner(mesh);
  Far::TopologyRefiner::UniformOptions uniform(level);
  uniform.fullTopologyInLastLevel = true;
  refiner->RefineUniform(uniform);
  const Far::PrimvarRefinerReal<double> interpolate(*refiner);
  std::vector<Primvar> values = primvars(mesh.points);
  for (int l = 1; l <= level; ++l) {
    std::vector<Primvar> fine(static_cast<std::size_t>(refiner->GetLevel(l).GetNumVertices()));
    interpolate.Interpolate(l, values, fine);
    values = std::move(fine);
  }
  std::vector<Primvar> limit(values.size());
  interpolate.Limit(values, limit);

  struct Leaf {
    int face;
    std::array<TriangleParameter, 3> corners;
  };
  const auto middle = [](TriangleParameter a, TriangleParameter b) {
    return TriangleParameter{(a.u + b.u) / 2, (a.v + b.v) / 2};
  };
  std::vector<OsdLimitSample> samples;
  std::vector<Leaf> leaves, fine;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    leaves.assign(1, {static_cast<int>(f), {{{0, 0}, {1, 0}, {0, 1}}}});
    for (int l = 0; l < level; ++l) {
      fine.clear();
      for (const auto& [face, c] : leaves) {
        const auto children = refiner->GetLevel(l).GetFaceChildFaces(face);
        const auto m0 = middle(c[0], c[1]), m1 = middle(c[1], c[2]), m2 = middle(c[2], c[0]);
        fine.push_back({children[0], {c[0], m0, m2}});
        fine.push_back({children[1], {m0, c[1], m1}});
        fine.push_back({children[2], {m2, m1, c[2]}});
        fine.push_back({children[3], {m1, m2, m0}});
      }
      leaves.swap(fine);
    }
    for (const auto& [face, corners] : leaves) {
      const auto vertices = refiner->GetLevel(level).GetFaceVertices(face);
      for (int k = 0; k < 3; ++k) {
        samples.push_back({PatchId(f), corners[static_cast<std::size_t>(k)],
                           limit[static_cast<std::size_t>(vertices[k])].value});
      }
    }
  }
  return samples;
}

TriangleMesh osd_uniform(const ControlMesh& mesh, int level, bool snapped) {
  const auto refiner = make_refiner(mesh);
  Far::TopologyRefiner::UniformOptions uniform(level);
  uniform.fullTopologyInLastLevel = snapped;
  refiner->RefineUniform(uniform);
  const Far::PrimvarRefinerReal<double> interpolate(*refiner);
  std::vector<Primvar> values = primvars(mesh.points);
  for (int l = 1; l <= level; ++l) {
    std::vector<Primvar> fine(static_cast<std::size_t>(refiner->GetLevel(l).GetNumVertices()));
    interpolate.Interpolate(l, values, fine);
    values = std::move(fine);
  }
  if (snapped) {
    std::vector<Primvar> limit(values.size());
    interpolate.Limit(values, limit);
    values = std::move(limit);
  }
  TriangleMesh result;
  result.points.reserve(values.size());
  for (const Primvar& value : values) result.points.push_back(value.value);
  const Far::TopologyLevel& last = refiner->GetLevel(level);
  result.triangles.reserve(2 * static_cast<std::size_t>(last.GetNumFaces()));
  for (int f = 0; f < last.GetNumFaces(); ++f) {
    const auto vertices = last.GetFaceVertices(f);
    for (int k = 2; k < vertices.size(); ++k) {
      result.triangles.push_back({static_cast<std::uint32_t>(vertices[0]),
                                  static_cast<std::uint32_t>(vertices[k - 1]),
                                  static_cast<std::uint32_t>(vertices[k])});
    }
  }
  return result;
}

int osd_uniform_level(const ControlMesh& mesh, double tolerance) {
  for (int level = 0; level <= 10; ++level) {
    const std::vector<Point3> points = osd_uniform(mesh, level).points;
    const std::vector<Point3> limit = osd_uniform(mesh, level, true).points;
    double max_sq = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      max_sq = std::max(max_sq, length_sq(limit[i] - points[i]));
    }
    if (4 * max_sq <= tolerance * tolerance) return level;
  }
  throw std::runtime_error("uniform refinement does not reach the tolerance at level 10");
}

int osd_snapped_level(const ControlMesh& mesh, double tolerance) {
  for (int level = 0; level <= 10; ++level) {
    const std::vector<Point3> limit = osd_uniform(mesh, level + 1, true).points;
    const auto refiner = make_refiner(mesh);
    Far::TopologyRefiner::UniformOptions uniform(level + 1);
    uniform.fullTopologyInLastLevel = true;
    refiner->RefineUniform(uniform);
    const Far::TopologyLevel& topology = refiner->GetLevel(level);
    const auto at = [&](int vertex) { return limit[static_cast<std::size_t>(vertex)]; };
    double most = 0;
    for (int e = 0; e < topology.GetNumEdges(); ++e) {
      const auto ends = topology.GetEdgeVertices(e);
      const Point3 a = at(topology.GetVertexChildVertex(ends[0])),
                   b = at(topology.GetVertexChildVertex(ends[1])), p = at(topology.GetEdgeChildVertex(e));
      const double along = std::clamp(dot(p - a, b - a) / length_sq(b - a), 0.0, 1.0);
      most = std::max(most, length(p - (a + along * (b - a))));
    }
    if (most <= tolerance / 2) return level;
  }
  throw std::runtime_error("snapped meshes do not reach the tolerance at level 10");
}

}  // namespace snug::bench
