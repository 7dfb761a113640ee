#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/surface.h>
#include <opensubdiv/far/error.h>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>
#include <peers/opensubdiv_comparison.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <tuple>

namespace oracle {

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

Sdc::Options options_of(const Rules& rules) {
  Sdc::Options options;
  options.SetVtxBoundaryInterpolation(
      rules.boundary == Boundary::edge_only ? Sdc::Options::VTX_BOUNDARY_EDGE_ONLY
      : rules.boundary == Boundary::none    ? Sdc::Options::VTX_BOUNDARY_NONE
                                            : Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
  options.SetCreasingMethod(rules.chaikin ? Sdc::Options::CREASE_CHAIKIN : Sdc::Options::CREASE_UNIFORM);
  options.SetTriangleSubdivision(rules.smooth_triangles ? Sdc::Options::TRI_SUB_SMOOTH
                                                        : Sdc::Options::TRI_SUB_CATMARK);
  return options;
}

std::unique_ptr<Far::TopologyRefiner> refiner_of(const TaggedMesh& mesh, const Rules& rules,
                                                 bool bilinear = false) {
  std::vector<int> sizes, indices, pairs, corners, holes;
  std::vector<float> edge_weights, corner_weights;
  for (const auto& polygon : mesh.polygons) {
    sizes.push_back(static_cast<int>(polygon.size()));
    for (const std::uint32_t v : polygon) indices.push_back(static_cast<int>(v));
  }
  for (const auto& c : mesh.creases) {
    pairs.push_back(static_cast<int>(c.a));
    pairs.push_back(static_cast<int>(c.b));
    edge_weights.push_back(static_cast<float>(c.sharpness));
  }
  for (const auto& c : mesh.corners) {
    corners.push_back(static_cast<int>(c.vertex));
    corner_weights.push_back(static_cast<float>(c.sharpness));
  }
  for (const std::uint32_t f : mesh.holes) holes.push_back(static_cast<int>(f));
  Far::TopologyDescriptor description;
  description.numVertices = static_cast<int>(mesh.points.size());
  description.numFaces = static_cast<int>(mesh.polygons.size());
  description.numVertsPerFace = sizes.data();
  description.vertIndicesPerFace = indices.data();
  description.numCreases = static_cast<int>(edge_weights.size());
  description.creaseVertexIndexPairs = pairs.data();
  description.creaseWeights = edge_weights.data();
  description.numCorners = static_cast<int>(corners.size());
  description.cornerVertexIndices = corners.data();
  description.cornerWeights = corner_weights.data();
  description.numHoles = static_cast<int>(holes.size());
  description.holeIndices = holes.data();
  Far::SetWarningCallback([](const char*) {});  // tags for no edge are passed over
  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  const auto scheme = bilinear                             ? Sdc::SCHEME_BILINEAR
                      : rules.scheme == PrimalScheme::loop ? Sdc::SCHEME_LOOP
                                                           : Sdc::SCHEME_CATMARK;
  return std::unique_ptr<Far::TopologyRefiner>(
      Factory::Create(description, Factory::Options(scheme, options_of(rules))));
}

void note(Compared::Part& part, const Point& a, const Point& b, double largest) {
  for (std::size_t x = 0; x < 3; ++x) part.worst = std::max(part.worst, std::abs(a[x] - b[x]) / largest);
  ++part.count;
}

void compare_faces(const TaggedMesh& mine, const Far::TopologyLevel& level,
                   const std::vector<Primvar>& values, double largest, Compared& compared) {
  compared.same_faces = compared.same_faces &&
                        static_cast<int>(mine.polygons.size()) == level.GetNumFaces() &&
                        static_cast<int>(mine.points.size()) == level.GetNumVertices();
  if (!compared.same_faces) return;
  std::vector<char> hole(mine.polygons.size(), 0);
  for (const std::uint32_t f : mine.holes) hole[f] = 1;
  for (std::size_t f = 0; f < mine.polygons.size(); ++f) {
    const auto corners = level.GetFaceVertices(static_cast<int>(f));
    const auto& polygon = mine.polygons[f];
    compared.same_faces = compared.same_faces && corners.size() == static_cast<int>(polygon.size()) &&
                          level.IsFaceHole(static_cast<int>(f)) == (hole[f] != 0);
    for (std::size_t k = 0; k < polygon.size(); ++k)
      note(compared.refined, mine.points[polygon[k]],
           values[static_cast<std::size_t>(corners[static_cast<int>(k)])].value, largest);
  }
}

using Key = std::tuple<std::uint32_t, std::uint32_t, double, double>;  // face, part, u, v

/// The vertices of the last level by parameter, from OpenSubdiv's lists of children.
class Parameters {
 public:
  Parameters(const Far::TopologyRefiner& refiner, int levels) : refiner_(refiner), levels_(levels) {
    for (int f = 0; f < refiner.GetLevel(0).GetNumFaces(); ++f) start(f);
  }
  [[nodiscard]] const std::map<Key, int>& vertices() const { return vertices_; }

 private:
  using Corner = std::array<double, 2>;
  static Corner mid(const Corner& a, const Corner& b) { return {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2}; }

  void start(int f) {
    const auto face = static_cast<std::uint32_t>(f);
    const int size = refiner_.GetLevel(0).GetFaceVertices(f).size();
    const bool loop = refiner_.GetSchemeType() == Sdc::SCHEME_LOOP;
    const std::vector<Corner> square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    if (loop) {
      descend(f, face, 0, {{0, 0}, {1, 0}, {0, 1}}, 0);
    } else if (size == 4) {
      descend(f, face, 0, square, 0);
    } else {
      const auto children = refiner_.GetLevel(0).GetFaceChildFaces(f);
      for (int k = 0; k < size; ++k) descend(children[k], face, static_cast<std::uint32_t>(k), square, 1);
    }
  }
  void descend(int f, std::uint32_t face, std::uint32_t part, const std::vector<Corner>& c, int level) {
    const Far::TopologyLevel& at = refiner_.GetLevel(level);
    if (level == levels_) {
      for (std::size_t k = 0; k < c.size(); ++k)
        vertices_[{face, part, c[k][0], c[k][1]}] = at.GetFaceVertices(f)[static_cast<int>(k)];
      return;
    }
    const auto children = at.GetFaceChildFaces(f);
    const std::size_t n = c.size();
    for (std::size_t k = 0; k < n; ++k) {
      std::vector<Corner> child = c;
      child[(k + 1) % n] = mid(c[k], c[(k + 1) % n]);
      if (n == 4) child[(k + 2) % n] = mid(c[0], c[2]);
      child[(k + n - 1) % n] = mid(c[k], c[(k + n - 1) % n]);
      descend(children[static_cast<int>(k)], face, part, child, level + 1);
    }
    if (n == 3)
      descend(children[3], face, part, {mid(c[1], c[2]), mid(c[2], c[0]), mid(c[0], c[1])}, level + 1);
  }

  const Far::TopologyRefiner& refiner_;
  int levels_;
  std::map<Key, int> vertices_;
};

bool is_finite_sharpness(float s) { return s > 0 && s < 10; }

/// Where the comparison of a vertex' limit belongs.
Compared::Part& part_of(const Far::TopologyRefiner& refiner, int vertex, int levels, Compared& compared) {
  const Far::TopologyLevel& level = refiner.GetLevel(levels);
  int infinite = 0;
  bool alive = is_finite_sharpness(level.GetVertexSharpness(vertex));
  const auto edges = level.GetVertexEdges(vertex);
  for (int i = 0; i < edges.size(); ++i) {
    const float s = level.GetEdgeSharpness(edges[i]);
    alive = alive || is_finite_sharpness(s);
    infinite += s >= 10 ? 1 : 0;
  }
  if (level.GetVertexSharpness(vertex) >= 10 || infinite > 2) return compared.limit;
  if (alive) return compared.alive;
  if (infinite == 1) return compared.dart;
  if (infinite == 0 && edges.size() == 2 && refiner.GetSchemeType() == Sdc::SCHEME_CATMARK)
    return compared.valence_two;
  return compared.limit;
}

}  // namespace

Compared compare_with_opensubdiv(TaggedMesh mesh, const Rules& rules, int levels) {
  for (auto& c : mesh.creases) c.sharpness = static_cast<double>(static_cast<float>(c.sharpness));
  for (auto& c : mesh.corners) c.sharpness = static_cast<double>(static_cast<float>(c.sharpness));
  Compared compared;
  const auto refiner = refiner_of(mesh, rules);
  if (!refiner) return compared;
  compared.accepted = true;
  Far::TopologyRefiner::UniformOptions uniform(levels);
  uniform.fullTopologyInLastLevel = true;
  refiner->RefineUniform(uniform);

  double largest = 0;
  std::vector<Primvar> values(mesh.points.size());
  for (std::size_t v = 0; v < values.size(); ++v) {
    values[v].value = mesh.points[v];
    for (const double x : mesh.points[v]) largest = std::max(largest, std::abs(x));
  }
  const Far::PrimvarRefinerReal<double> primvars(*refiner);
  for (int level = 1; level <= levels; ++level) {
    std::vector<Primvar> fine(static_cast<std::size_t>(refiner->GetLevel(level).GetNumVertices()));
    primvars.Interpolate(level, values, fine);
    values = std::move(fine);
    compare_faces(refine(mesh, rules, level), refiner->GetLevel(level), values, largest, compared);
  }
  if (!compared.same_faces) return compared;
  std::vector<Primvar> limit(values.size());
  primvars.Limit(values, limit);
  const Parameters parameters(*refiner, levels);
  for (const FaceSample& s : sample_faces(mesh, rules, levels)) {
    const auto at = parameters.vertices().find({s.face, s.part, s.u, s.v});
    if (at == parameters.vertices().end()) {
      compared.same_faces = false;
      continue;
    }
    note(part_of(*refiner, at->second, levels, compared), s.position,
         limit[static_cast<std::size_t>(at->second)].value, largest);
  }
  return compared;
}

OpenSubdivMesh refine_with_opensubdiv(const TaggedMesh& mesh, const Rules& rules, int levels, bool bilinear) {
  OpenSubdivMesh result;
  const auto refiner = refiner_of(mesh, rules, bilinear);
  if (!refiner) return result;
  result.accepted = true;
  Far::TopologyRefiner::UniformOptions uniform(levels);
  uniform.fullTopologyInLastLevel = true;
  refiner->RefineUniform(uniform);
  std::vector<Primvar> values(mesh.points.size());
  for (std::size_t v = 0; v < values.size(); ++v) values[v].value = mesh.points[v];
  const Far::PrimvarRefinerReal<double> primvars(*refiner);
  for (int level = 1; level <= levels; ++level) {
    std::vector<Primvar> fine(static_cast<std::size_t>(refiner->GetLevel(level).GetNumVertices()));
    primvars.Interpolate(level, values, fine);
    values = std::move(fine);
  }
  std::vector<Primvar> limit(values.size());
  primvars.Limit(values, limit);
  const Far::TopologyLevel& last = refiner->GetLevel(levels);
  Compared parts;
  for (int f = 0; f < last.GetNumFaces(); ++f) {
    auto& face = result.faces.emplace_back();
    result.holes.push_back(last.IsFaceHole(f));
    const auto corners = last.GetFaceVertices(f);
    for (int k = 0; k < corners.size(); ++k) {
      const Compared::Part* const part = &part_of(*refiner, corners[k], levels, parts);
      const auto v = static_cast<std::size_t>(corners[k]);
      face.push_back({values[v].value, limit[v].value,
                      part == &parts.dart          ? OpenSubdivMesh::Limit::dart
                      : part == &parts.valence_two ? OpenSubdivMesh::Limit::valence_two
                      : part == &parts.alive       ? OpenSubdivMesh::Limit::alive
                                                   : OpenSubdivMesh::Limit::exact});
    }
  }
  return result;
}

namespace Bfr = OpenSubdiv::Bfr;

struct BfrSurfaces::Parts {
  std::unique_ptr<Far::TopologyRefiner> refiner;
  std::unique_ptr<Bfr::RefinerSurfaceFactory<>> factory;
  std::vector<double> points;
};

BfrSurfaces::BfrSurfaces(const TaggedMesh& mesh, const Rules& rules) : parts_(std::make_unique<Parts>()) {
  parts_->refiner = refiner_of(mesh, rules);
  for (const Point& p : mesh.points) parts_->points.insert(parts_->points.end(), p.begin(), p.end());
  if (!parts_->refiner) return;
  Bfr::SurfaceFactory::Options options;
  options.SetApproxLevelSmooth(6).SetApproxLevelSharp(6);
  parts_->factory = std::make_unique<Bfr::RefinerSurfaceFactory<>>(*parts_->refiner, options);
}
BfrSurfaces::~BfrSurfaces() = default;

std::optional<BfrSurfaces::Face> BfrSurfaces::at(std::size_t face,
                                                 const std::vector<std::array<double, 2>>& uv) const {
  Bfr::Surface<double> surface;
  if (!parts_->factory || !parts_->factory->InitVertexSurface(static_cast<int>(face), &surface)) return {};
  const Bfr::Surface<double>::PointDescriptor three(3);
  std::vector<double> patch_points(3 * static_cast<std::size_t>(surface.GetNumPatchPoints()));
  surface.PreparePatchPoints(parts_->points.data(), three, patch_points.data(), three);
  Face result{surface.IsRegular(), {}};
  for (const auto& at : uv) {
    Point p{};
    surface.Evaluate(at.data(), patch_points.data(), three, p.data());
    result.points.push_back(p);
  }
  return result;
}

}  // namespace oracle
