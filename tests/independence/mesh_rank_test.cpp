#include <snug/independence/mesh_rank.h>

#include <gtest/gtest.h>
#include <oracle/dual_twin.h>
#include <oracle/limit_twin.h>
#include <oracle/polygon_twin.h>
#include <testing/closed_meshes.h>
#include <testing/counts.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>

#include <snug/independence/exact_step.h>
#include <snug/independence/exact_surface.h>
#include <snug/independence/flint_memory.h>
#include <snug/independence/mesh_kernel.h>
#include <snug/independence/zero_proof.h>
#include <snug/mesh/topology.h>
#include <snug/run.h>
#include <snug/scheme/refine.h>

// Ranks by elimination against the theorem where it holds, and against ranks of sampled limits, which share nothing with the
// library but the masks' definitions.
namespace snug::mesh_rank_test {
namespace {

using testing::ClosedMesh;

// A mesh with tags, for the library and for the twins.
struct Shape {
  std::string name;
  oracle::TaggedMesh mesh;
  BoundaryRule boundary = BoundaryRule::edge_and_corner;
  bool chaikin = false, smooth_triangles = false;
};

std::uint32_t count(const Shape& shape) { return static_cast<std::uint32_t>(shape.mesh.points.size()); }

std::uint32_t new_vertex(Shape& shape) {
  shape.mesh.points.push_back({});
  return count(shape) - 1;
}

ControlMesh control_mesh_of(const Shape& shape) {
  ControlMesh mesh;
  for (std::size_t v = 0; v < shape.mesh.points.size(); ++v) {
    mesh.points.push_back({std::cos(static_cast<double>(v)), std::sin(2.0 * static_cast<double>(v)), 1});
  }
  for (const auto& face : shape.mesh.polygons) {
    std::vector<VertexId> corners;
    for (const std::uint32_t v : face) corners.emplace_back(v);
    mesh.add_face(corners);
  }
  for (const auto& crease : shape.mesh.creases) {
    mesh.tags.creases.push_back({VertexId(crease.a), VertexId(crease.b), crease.sharpness});
  }
  for (const auto& corner : shape.mesh.corners)
    mesh.tags.corners.push_back({VertexId(corner.vertex), corner.sharpness});
  for (const std::uint32_t hole : shape.mesh.holes) mesh.tags.holes.emplace_back(hole);
  if (shape.smooth_triangles) mesh.tags.smooth_triangles = SmoothTriangles::smooth;
  if (shape.chaikin) mesh.tags.crease_method = CreaseMethod::chaikin;
  return mesh;
}

Shape shape_of(const ClosedMesh& mesh) {
  Shape shape{mesh.name, {}};
  shape.mesh.points.resize(mesh.vertices);
  shape.mesh.polygons = mesh.faces;
  return shape;
}

// Columns: limits of nodal functions at places.
using Columns = std::vector<std::vector<double>>;

Columns sampled(const Shape& shape, Scheme scheme) {
  Columns columns(count(shape));
  oracle::Rules rules;
  rules.scheme = scheme == Scheme::loop ? oracle::PrimalScheme::loop : oracle::PrimalScheme::catmull_clark;
  rules.boundary = static_cast<oracle::Boundary>(shape.boundary == BoundaryRule::none ? oracle::Boundary::none
                                                 : shape.boundary == BoundaryRule::edge_only
                                                     ? oracle::Boundary::edge_only
                                                     : oracle::Boundary::edge_and_corner);
  rules.chaikin = shape.chaikin;
  rules.smooth_triangles = shape.smooth_triangles && scheme == Scheme::catmark;
  rules.clamp_dart_edges = true;
  const auto limits = std::make_shared<oracle::LimitRules>(rules);
  for (std::size_t v = 0; v < columns.size(); v += 3) {  // a coordinate each
    oracle::TaggedMesh mesh = shape.mesh;
    for (auto& p : mesh.points) p = {0, 0, 0};
    for (std::size_t k = 0; k < 3 && v + k < columns.size(); ++k) mesh.points[v + k][k] = 1;
    const auto add = [&](const oracle::Point& p) {
      for (std::size_t k = 0; k < 3 && v + k < columns.size(); ++k) columns[v + k].push_back(p[k]);
    };
    if (scheme == Scheme::catmark) {
      for (const auto& sample : oracle::sample_faces(mesh, rules, 3)) add(sample.position);
    } else if (scheme == Scheme::loop) {
      std::optional<oracle::LimitTwin> twin;
      for (std::uint32_t f = 0; f < mesh.polygons.size(); ++f) {
        try {
          if (!twin) twin.emplace(mesh, limits);
          for (int j = 0; j <= 8; ++j) {
            for (int i = 0; i + j <= 8; ++i) add(twin->limit_point(f, 0, i / 8.0, j / 8.0));
          }
        } catch (const std::invalid_argument&) {
          continue;  // a face without a surface
        }
      }
    } else {
      const auto own =
          scheme == Scheme::doo_sabin ? oracle::DualScheme::doo_sabin : oracle::DualScheme::midedge;
      for (const auto& sample : oracle::sample_dual(mesh, own, 4)) add(sample.position);
    }
  }
  return columns;
}

// Gram and Schmidt, the longest column first; nothing where lengths leave no gap.
std::optional<std::size_t> numerical_rank(Columns columns) {
  const auto dot = [](const auto& a, const auto& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
  };
  for (std::size_t rank = 0; rank < columns.size(); ++rank) {
    std::size_t longest = rank;
    for (std::size_t c = rank; c < columns.size(); ++c) {
      if (dot(columns[c], columns[c]) > dot(columns[longest], columns[longest])) longest = c;
    }
    std::swap(columns[rank], columns[longest]);
    auto& pivot = columns[rank];
    const double length = std::sqrt(dot(pivot, pivot));
    if (length < 1e-11) return rank;
    if (length < 1e-8) return std::nullopt;
    for (double& x : pivot) x /= length;
    for (std::size_t c = rank + 1; c < columns.size(); ++c) {
      for (int twice = 0; twice < 2; ++twice) {
        const double share = dot(pivot, columns[c]);
        for (std::size_t i = 0; i < pivot.size(); ++i) columns[c][i] -= share * pivot[i];
      }
    }
  }
  return columns.size();
}

double value_of(const std::vector<mpq_class>& polynomial, std::uint32_t order) {
  const double t = 2 * std::cos(2 * std::numbers::pi / order);
  double value = 0;
  for (std::size_t i = polynomial.size(); i-- > 0;) value = value * t + polynomial[i].get_d();
  return value;
}

// Each vector makes the samples 0.
void expect_no_limits(const MeshRank& found, const Columns& columns) {
  for (const ExactKernelVector& vector : found.vectors) {
    std::vector<double> sum(columns.front().size(), 0.0);
    double size = 0;
    for (const auto& [v, polynomial] : vector.entries) {
      const double value = value_of(polynomial, vector.order);
      size = std::max(size, std::fabs(value));
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += value * columns[v.index()][i];
    }
    for (const double x : sum) EXPECT_NEAR(x, 0, 1e-11 * size);
  }
}

MeshRank rank_of(const Shape& shape, Scheme scheme) {
  return mesh_rank(control_mesh_of(shape), {.scheme = scheme, .boundary = shape.boundary});
}

struct Tally {
  std::size_t compared = 0, unclear = 0, refused = 0, undecided = 0, dependent = 0, irrational = 0,
              beyond = 0;
};

void compare(const Shape& shape, Scheme scheme, Tally& tally) {
  SCOPED_TRACE(shape.name + ", " + name_of(scheme));
  MeshRank found;
  try {
    found = rank_of(shape, scheme);
  } catch (const InputError&) {
    ++tally.refused;
    return;
  }
  const Columns columns = sampled(shape, scheme);
  const std::optional<std::size_t> rank = numerical_rank(columns);
  tally.undecided += found.decided() ? 0 : 1;
  if (!rank) {
    ++tally.unclear;
    return;
  }
  ++tally.compared;
  tally.dependent += found.most < found.dimension ? 1 : 0;
  tally.irrational += std::any_of(found.vectors.begin(), found.vectors.end(),
                                  [](const ExactKernelVector& vector) { return vector.order > 1; })
                          ? 1
                          : 0;
  EXPECT_LE(*rank, found.most);
  EXPECT_GE(*rank, found.least);
  expect_no_limits(found, columns);
  try {
    const MeshKernel kernel =
        mesh_kernel(control_mesh_of(shape), {.scheme = scheme, .boundary = shape.boundary});
    EXPECT_EQ(found.dimension - kernel.dimension(), found.least);
  } catch (const InputError&) {
    ++tally.beyond;  // the theorem does not reach there
  }
}

// Cases that the theorem leaves out, and their neighbours.
using Feature = std::pair<const char*, std::function<void(Shape&, std::mt19937_64&)>>;

std::uint32_t below(std::size_t n, std::mt19937_64& random) {
  return static_cast<std::uint32_t>(random() % n);
}

std::pair<std::uint32_t, std::uint32_t> some_edge(const Shape& shape, std::mt19937_64& random) {
  const auto& face = shape.mesh.polygons[below(shape.mesh.polygons.size(), random)];
  const std::size_t i = below(face.size(), random);
  return {face[i], face[(i + 1) % face.size()]};
}

void open_one(Shape& shape, std::mt19937_64& random) {
  auto& faces = shape.mesh.polygons;
  if (faces.size() < 3 || !shape.mesh.holes.empty()) return;
  faces.erase(faces.begin() + static_cast<std::ptrdiff_t>(below(faces.size(), random)));
}

std::vector<Feature> features() {
  constexpr std::array sharpnesses{0.5, 0.25, 1.0, 1.5, 2.25, 10.0};
  return {
      {"plain", [](Shape&, std::mt19937_64&) {}},
      {"hole",
       [](Shape& shape, std::mt19937_64& random) {
         for (std::size_t k = 1 + below(shape.mesh.polygons.size() / 2, random); k > 0; --k) {
           shape.mesh.holes.push_back(below(shape.mesh.polygons.size(), random));
         }
       }},
      {"one face that is no hole",
       [](Shape& shape, std::mt19937_64& random) {
         const std::uint32_t kept = below(shape.mesh.polygons.size(), random);
         for (std::uint32_t f = 0; f < shape.mesh.polygons.size(); ++f) {
           if (f != kept) shape.mesh.holes.push_back(f);
         }
       }},
      {"no surface at the boundary",
       [](Shape& shape, std::mt19937_64& random) {
         open_one(shape, random);
         shape.boundary = BoundaryRule::none;
       }},
      {"open", open_one},
      {"smooth boundary corners",
       [](Shape& shape, std::mt19937_64& random) {
         open_one(shape, random);
         if (shape.boundary != BoundaryRule::none) shape.boundary = BoundaryRule::edge_only;
       }},
      {"non-manifold vertex",
       [](Shape& shape, std::mt19937_64& random) {
         const std::uint32_t v = some_edge(shape, random).first, a = new_vertex(shape), b = new_vertex(shape),
                             c = new_vertex(shape);
         shape.mesh.polygons.push_back({v, a, b, c});
       }},
      {"non-manifold edge",
       [](Shape& shape, std::mt19937_64& random) {
         const auto [v, w] = some_edge(shape, random);
         const std::uint32_t a = new_vertex(shape), b = new_vertex(shape);
         shape.mesh.polygons.push_back({v, w, a, b});
       }},
      {"semi-sharp vertices of two edges",
       [](Shape& shape, std::mt19937_64& random) {
         const auto [v, w] = some_edge(shape, random);
         const std::uint32_t a = new_vertex(shape), b = new_vertex(shape);
         for (auto& face : shape.mesh.polygons) {
           for (std::size_t i = 0; i < face.size(); ++i) {
             const std::size_t next = (i + 1) % face.size();
             const auto at = face.begin() + static_cast<std::ptrdiff_t>(i + 1);
             if (face[i] == v && face[next] == w) {
               face.insert(at, {a, b});
               break;
             }
             if (face[i] == w && face[next] == v) {
               face.insert(at, {b, a});
               break;
             }
           }
         }
         for (const auto& [x, y] : {std::pair{v, a}, std::pair{a, b}, std::pair{b, w}}) {
           shape.mesh.creases.push_back({x, y, 0.5});
         }
       }},
      {"large face at the boundary",
       [](Shape& shape,
          std::mt19937_64& random) {  // two faces of eight or nine corners share a vertex inside
         const std::uint32_t n = 7 + below(3, random), first = count(shape);
         for (std::uint32_t i = 0; i < n + 3; ++i) new_vertex(shape);
         std::vector<std::uint32_t> large;
         for (std::uint32_t i = 0; i < n; ++i) large.push_back(first + i);
         shape.mesh.polygons.push_back(large);
         shape.mesh.polygons.push_back({first, first + n - 1, first + n, first + n + 1});
         shape.mesh.polygons.push_back({first, first + n + 1, first + n + 2, first + 1});
       }},
      {"sharpness",
       [=](Shape& shape, std::mt19937_64& random) {
         for (int k = 0; k < 4; ++k) {
           const auto [v, w] = some_edge(shape, random);
           const double s = sharpnesses[random() % sharpnesses.size()];
           if (random() % 4 == 0) {
             shape.mesh.corners.push_back({v, s});
           } else {
             shape.mesh.creases.push_back({v, w, s});
           }
         }
       }},
      {"chaikin",
       [=](Shape& shape, std::mt19937_64& random) {
         shape.chaikin = true;
         const std::uint32_t v = some_edge(shape, random).first;
         for (const auto& face : shape.mesh.polygons) {
           for (std::size_t i = 0; i < face.size(); ++i) {
             if (face[i] == v) {
               shape.mesh.creases.push_back(
                   {v, face[(i + 1) % face.size()], sharpnesses[random() % sharpnesses.size()]});
             }
           }
         }
       }},
      {"chaikin with an edge that stays sharp",  // below 1, between sharper ones
       [](Shape& shape, std::mt19937_64& random) {
         shape.chaikin = true;
         const auto& face = shape.mesh.polygons[below(shape.mesh.polygons.size(), random)];
         for (std::size_t i = 0; i < face.size(); ++i) {
           shape.mesh.creases.push_back({face[i], face[(i + 1) % face.size()], i == 0 ? 0.75 : 4.0});
         }
       }},
      {"smooth triangles", [](Shape& shape, std::mt19937_64&) { shape.smooth_triangles = true; }},
      {"unused vertex", [](Shape& shape, std::mt19937_64&) { new_vertex(shape); }},
  };
}

// A vertex in each face that is no triangle.
Shape triangulated(const Shape& shape) {
  Shape result = shape;
  result.mesh.polygons.clear();
  result.mesh.holes.clear();
  for (std::uint32_t f = 0; f < shape.mesh.polygons.size(); ++f) {
    const auto& face = shape.mesh.polygons[f];
    const bool hole =
        std::find(shape.mesh.holes.begin(), shape.mesh.holes.end(), f) != shape.mesh.holes.end();
    const auto add = [&](std::vector<std::uint32_t> triangle) {
      if (hole) result.mesh.holes.push_back(static_cast<std::uint32_t>(result.mesh.polygons.size()));
      result.mesh.polygons.push_back(std::move(triangle));
    };
    if (face.size() == 3) {
      add(face);
      continue;
    }
    const std::uint32_t middle = new_vertex(result);
    for (std::size_t i = 0; i < face.size(); ++i) add({face[i], face[(i + 1) % face.size()], middle});
  }
  return result;
}

std::vector<ClosedMesh> small_meshes() {
  using namespace testing;
  return {tetrahedron(), prism(3),         prism(4),         prism(5),
          torus(3, 3),   trapezohedron(3), trapezohedron(5), bipyramid(4)};
}

Tally tally_of_pairs(Scheme scheme, int rounds, std::size_t max_vertices) {
  Tally tally;
  std::mt19937_64 random(7);
  const std::vector<ClosedMesh> meshes = small_meshes();
  const std::vector<Feature> all = features();
  const bool some = testing::fewer(4) < 4;  // under sanitizers one round, every other pair
  for (int round = 0; round < (some ? 1 : rounds); ++round) {
    for (std::size_t a = 0; a < all.size(); ++a) {
      for (std::size_t b = a; b < all.size(); b += some ? 2 : 1) {
        Shape shape = shape_of(meshes[random() % meshes.size()]);
        for (const std::size_t k : {a, b}) {
          all[k].second(shape, random);
          shape.name += std::string(", ") + all[k].first;
        }
        if (scheme == Scheme::loop) shape = triangulated(shape);
        if (shape.mesh.points.size() <= max_vertices) compare(shape, scheme, tally);
      }
    }
  }
  return tally;
}

// Exact masks of two steps lie where the library's intervals say.
void expect_masks_of_refine(const Shape& shape, Scheme scheme) {
  SCOPED_TRACE(shape.name + ", " + name_of(scheme));
  const ControlMesh mesh = control_mesh_of(shape);
  const SchemeOptions options = with_tags({.scheme = scheme, .boundary = shape.boundary}, mesh.tags);
  Topology topology(mesh);
  const bool primal = scheme == Scheme::loop || scheme == Scheme::catmark;
  Sharpness sharpness = primal ? sharpness_of(mesh, topology) : Sharpness{};
  const std::uint32_t order = order_of_masks({topology, options, sharpness}, 1, 1'000'000);
  for (int step = 0; step < 2; ++step) {
    RefinedTopology refined = refine(topology, options, sharpness);
    const ExactStep exact({topology, options, sharpness}, order);
    for (std::uint32_t v = 0; v < refined.stencils.row_count(); ++v) {
      if (primal && v < topology.vertex_count() && topology.isolated(VertexId(v))) continue;
      std::map<std::uint32_t, double> weights;
      const Stencils::Row row = refined.stencils.row(v);
      for (std::size_t i = 0; i < row.sources.size(); ++i) weights[row.sources[i]] += row.weights[i];
      for (const auto& [c, weight] : exact.row(VertexId(v))) {
        double value = weight.rational.get_d();
        for (const auto& [index, factor] : weight.cosines) {
          value += factor.get_d() * 2 * std::cos(2 * std::numbers::pi * index / order);
        }
        weights[c] -= value;
      }
      for (const auto& [c, difference] : weights) EXPECT_NEAR(difference, 0, 1e-15) << v << " of " << c;
    }
    topology = std::move(refined.topology);
    sharpness = std::move(refined.sharpness);
  }
}

TEST(mesh_rank, has_the_masks_of_refine) {
  std::mt19937_64 random(12);
  const std::vector<Feature> all = features();
  for (std::size_t a = 0; a < all.size(); ++a) {
    for (std::size_t b = a; b < all.size(); ++b) {
      for (const Scheme scheme : {Scheme::loop, Scheme::catmark, Scheme::doo_sabin, Scheme::midedge}) {
        Shape shape = shape_of(small_meshes()[random() % small_meshes().size()]);
        for (const std::size_t k : {a, b}) all[k].second(shape, random);
        shape.name += std::string(", ") + all[a].first + ", " + all[b].first;
        if (scheme == Scheme::loop) shape = triangulated(shape);
        try {
          static_cast<void>(require_surface(control_mesh_of(shape), {.scheme = scheme}));
        } catch (const InputError&) {
          continue;  // dual schemes: not manifold, or a vertex of two edges
        }
        expect_masks_of_refine(shape, scheme);
      }
    }
  }
}

// Cases that each scheme's pairs must cover.
TEST(mesh_rank, of_pairs_of_features_with_catmark) {
  const Tally tally = tally_of_pairs(Scheme::catmark, 2, 34);
  EXPECT_EQ(tally.refused, 0);
  EXPECT_EQ(tally.undecided, 0);
  EXPECT_GT(tally.compared, testing::fewer(testing::fewer(120)));
  EXPECT_GT(tally.dependent, testing::fewer(testing::fewer(30)));
  EXPECT_GT(tally.beyond, testing::fewer(testing::fewer(60)));
}

TEST(mesh_rank, of_pairs_of_features_with_loop) {
  const Tally tally = tally_of_pairs(Scheme::loop, 1, 26);
  EXPECT_EQ(tally.refused, 0);
  EXPECT_EQ(tally.undecided, 0);
  EXPECT_GT(tally.compared, testing::fewer(testing::fewer(60)));
  EXPECT_GT(tally.dependent, testing::fewer(testing::fewer(10)));
  EXPECT_GT(tally.beyond, testing::fewer(testing::fewer(30)));
}

TEST(mesh_rank, of_pairs_of_features_with_doo_sabin) {
  const Tally tally = tally_of_pairs(Scheme::doo_sabin, 3, 40);
  EXPECT_GT(tally.compared, testing::fewer(testing::fewer(120)));
  EXPECT_GT(tally.dependent, testing::fewer(testing::fewer(40)));
  EXPECT_EQ(tally.undecided, 0);
  EXPECT_GT(tally.irrational, testing::fewer(testing::fewer(20)));
  EXPECT_GT(tally.beyond, testing::fewer(testing::fewer(20)));
}

TEST(mesh_rank, of_pairs_of_features_with_midedge) {
  const Tally tally = tally_of_pairs(Scheme::midedge, 3, 40);
  EXPECT_GT(tally.compared, testing::fewer(testing::fewer(120)));
  EXPECT_GT(tally.dependent, testing::fewer(testing::fewer(50)));
}

// The theorem's vectors are the echelon form's: where it decides, both agree entry by entry.
void expect_as_the_theorem(const ClosedMesh& closed, Scheme scheme) {
  SCOPED_TRACE(closed.name + ", " + name_of(scheme));
  Shape shape = shape_of(closed);
  if (scheme == Scheme::loop) shape = triangulated(shape);
  const MeshKernel kernel = mesh_kernel(control_mesh_of(shape), {.scheme = scheme});
  const MeshRank found = rank_of(shape, scheme);
  EXPECT_TRUE(found.decided());
  ASSERT_EQ(found.vectors.size(), kernel.dimension());
  std::map<std::vector<VertexId>, std::vector<std::int8_t>> signs;
  for (const KernelVector& vector : kernel.vectors) signs[vector.vertices] = vector.signs;
  for (const ExactKernelVector& vector : found.vectors) {
    std::vector<VertexId> vertices;
    for (const auto& [v, value] : vector.entries) vertices.push_back(v);
    ASSERT_TRUE(signs.contains(vertices));
    const auto& expected = signs[vertices];
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      ASSERT_EQ(vector.entries[i].second.size(), 1);
      EXPECT_EQ(vector.entries[i].second[0] * expected.back(), expected[i]);  // 1 at the last vertex
    }
  }
}

TEST(mesh_rank, of_small_closed_meshes_is_the_theorems) {
  using namespace testing;
  std::vector<ClosedMesh> meshes = small_meshes();
  for (std::uint32_t n = 6; n <= 9; ++n) {
    for (const ClosedMesh& mesh : {prism(n), antiprism(n), bipyramid(n), trapezohedron(n)})
      meshes.push_back(mesh);
  }
  for (const ClosedMesh& mesh :
       {truncated(tetrahedron()), torus(4, 4), torus(5, 4), dual(torus(3, 3, true)), dual(torus(4, 4, true)),
        truncated(bipyramid(4)), beside(prism(4), prism(6)), beside(torus(4, 4), prism(8))}) {
    meshes.push_back(mesh);
  }
  for (const ClosedMesh& mesh : meshes) {
    for (const Scheme scheme : {Scheme::loop, Scheme::catmark, Scheme::doo_sabin, Scheme::midedge}) {
      expect_as_the_theorem(mesh, scheme);
    }
  }
}

TEST(mesh_rank, of_random_closed_meshes_is_the_theorems) {
  std::mt19937_64 random(11);
  for (int trial = 0; trial < 60; ++trial) {
    ClosedMesh mesh = small_meshes()[random() % small_meshes().size()];
    for (std::size_t k = random() % 6; k > 0; --k) mesh = changed(mesh, random);
    for (const Scheme scheme : {Scheme::loop, Scheme::catmark, Scheme::doo_sabin, Scheme::midedge}) {
      expect_as_the_theorem(mesh, scheme);
    }
  }
}

// A face of n corners with one vertex inside and two quads.
Shape fan(const std::vector<std::uint32_t>& sizes) {
  Shape shape{"fan", {}};
  for (const std::uint32_t n : sizes) {
    const std::uint32_t first = count(shape);
    std::vector<std::uint32_t> large;
    for (std::uint32_t i = 0; i < n + 3; ++i) new_vertex(shape);
    for (std::uint32_t i = 0; i < n; ++i) large.push_back(first + i);
    shape.mesh.polygons.push_back(large);
    shape.mesh.polygons.push_back({first, first + n - 1, first + n, first + n + 1});
    shape.mesh.polygons.push_back({first, first + n + 1, first + n + 2, first + 1});
  }
  return shape;
}

// docs/independence.md: -1, 1 + t, -(1 + t), 1 with t = 2 cos(2 pi/n).
TEST(mesh_rank, of_a_large_face_at_the_boundary) {
  const MeshRank found = rank_of(fan({7}), Scheme::doo_sabin);
  EXPECT_TRUE(found.decided());
  EXPECT_EQ(found.least, 9);
  ASSERT_EQ(found.vectors.size(), 1);
  EXPECT_EQ(found.vectors[0].order, 7);
  const ExactKernelVector::Entries expected{
      {VertexId(2), {-1}}, {VertexId(3), {1, 1}}, {VertexId(4), {-1, -1}}, {VertexId(5), {1}}};
  EXPECT_EQ(found.vectors[0].entries, expected);
  // Fields of several valences side by side.
  const MeshRank several = rank_of(fan({7, 8, 9, 10, 11, 13}), Scheme::doo_sabin);
  EXPECT_TRUE(several.decided());
  EXPECT_EQ(several.dimension - several.least, 1 + 2 + 3 + 4 + 5 + 7);
}

// Cosines of degree above a hundred: an interval, and no vector that is not shown.
TEST(mesh_rank, says_what_it_does_not_decide) {
  const MeshRank found = rank_of(fan({131}), Scheme::doo_sabin);
  EXPECT_FALSE(found.decided());
  EXPECT_EQ(found.least, 9);
  EXPECT_EQ(found.most, found.dimension);
  EXPECT_TRUE(found.vectors.empty());
}

// The proof alone: what is in the kernel vanishes, what is near it does not.
TEST(mesh_rank, proves_only_what_vanishes) {
  const auto proves = [](const Shape& shape, Scheme scheme, const std::vector<bool>& without_surface,
                         std::uint32_t order, const std::vector<std::vector<mpq_class>>& entries) {
    const FlintMemory memory;
    const ControlMesh mesh = control_mesh_of(shape);
    const Topology topology(mesh);
    const SchemeOptions options{.scheme = scheme};
    const Sharpness none;
    const ExactSurface surface = exact_surface({topology, options, none}, without_surface, order, {});
    const RealField field(order);
    ZeroProof proof(surface, field);
    ZeroProof::Values values;
    for (std::uint32_t v = 0; v < entries.size(); ++v) {
      if (!entries[v].empty()) values.emplace_back(v, FieldNumber(entries[v]));
    }
    return proof.vanishes(values, {});
  };
  const Shape cube = shape_of(testing::prism(4));
  const std::vector<bool> all(6, false);
  std::vector<std::vector<mpq_class>> colours;
  for (const int sign : {1, -1, 1, -1, -1, 1, -1, 1}) colours.push_back({sign});
  EXPECT_TRUE(proves(cube, Scheme::catmark, all, 1, colours));
  for (std::size_t v = 0; v < colours.size(); ++v) {
    auto other = colours;
    other[v][0] += mpq_class(1, 1'000'000);
    EXPECT_FALSE(proves(cube, Scheme::catmark, all, 1, other));
    other[v].clear();
    EXPECT_FALSE(proves(cube, Scheme::catmark, all, 1, other));
    EXPECT_FALSE(proves(cube, Scheme::catmark, {true, true, false, true, true, true}, 1, other));
  }
  // One quad of a torus sees sixteen places.
  const Shape torus = shape_of(testing::torus(6, 6));
  std::vector<bool> without_surface(36, true);
  without_surface[0] = false;
  std::size_t unseen = 0;
  for (std::size_t v = 0; v < 36; ++v) {
    std::vector<std::vector<mpq_class>> one(36);
    one[v] = {1};
    unseen += proves(torus, Scheme::catmark, without_surface, 1, one) ? 1 : 0;
  }
  EXPECT_EQ(unseen, 20);
  const Shape seven = fan({7});
  std::vector<bool> inside(10, true);
  inside[0] = false;
  const std::vector<std::vector<mpq_class>> hidden{{}, {}, {-1}, {1, 1}, {-1, -1}, {1}};
  EXPECT_TRUE(proves(seven, Scheme::doo_sabin, inside, 7, hidden));
  EXPECT_TRUE(proves(seven, Scheme::doo_sabin, std::vector<bool>(10, true), 7, {{1}}));
  for (std::size_t v = 0; v < 10; ++v) {
    auto other = hidden;
    other.resize(10);
    other[v].resize(3);
    other[v][2] = mpq_class(1, 1'000'000);
    EXPECT_FALSE(proves(seven, Scheme::doo_sabin, inside, 7, other)) << v;
  }
}

// Masks with fractions of fifty binary digits.
TEST(mesh_rank, of_any_sharpness) {
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> anything(0, 1);
  Tally tally;
  for (int trial = 0; trial < 60; ++trial) {
    Shape shape = shape_of(small_meshes()[random() % small_meshes().size()]);
    shape.boundary = BoundaryRule::edge_only;
    for (int k = 0; k < 8; ++k) {
      const auto [v, w] = some_edge(shape, random);
      shape.mesh.creases.push_back({v, w, anything(random)});
    }
    const std::uint32_t kept = below(shape.mesh.polygons.size(), random);
    for (std::uint32_t f = 0; f < shape.mesh.polygons.size(); ++f) {
      if (f != kept) shape.mesh.holes.push_back(f);
    }
    compare(shape, Scheme::catmark, tally);
  }
  EXPECT_EQ(tally.undecided, 0);
  EXPECT_GT(tally.compared, 50);
}

// Coefficients grow as binomial ones do: one prime does not tell them.
TEST(mesh_rank, of_long_entries) {
  const MeshRank found = rank_of(fan({73}), Scheme::doo_sabin);
  EXPECT_TRUE(found.decided());
  EXPECT_EQ(found.least, 9);
  mpq_class largest = 0;
  for (const ExactKernelVector& vector : found.vectors) {
    for (const auto& [v, polynomial] : vector.entries) {
      for (const mpq_class& x : polynomial) largest = std::max(largest, mpq_class(abs(x)));
    }
  }
  EXPECT_GT(largest, 1 << 21);
}

std::string message_of(const ControlMesh& mesh, const SchemeOptions& options) {
  try {
    static_cast<void>(mesh_rank(mesh, options));
  } catch (const InputError& error) {
    EXPECT_EQ(error.problem(), InputProblem::refused);
    return error.what();
  }
  return "ranked";
}

TEST(mesh_rank, refuses_what_is_too_large) {
  std::mt19937_64 random(5);
  const ControlMesh large = testing::control_mesh_of(testing::torus(200, 101), random);
  EXPECT_NE(message_of(large, {.scheme = Scheme::catmark}).find("20200 control points"), std::string::npos);
  // 11 * 13 * 17 * 19 * 23 exceeds a million.
  const ControlMesh mixed = control_mesh_of(fan({11, 13, 17, 19, 23}));
  EXPECT_NE(message_of(mixed, {.scheme = Scheme::doo_sabin}).find("least common multiple"),
            std::string::npos);
  EXPECT_EQ(message_of(mixed, {.scheme = Scheme::midedge}), "ranked");
}

TEST(mesh_rank, stops_when_asked) {
  const std::atomic<bool> stop = true;
  WorkMonitor monitor;
  monitor.stop = &stop;
  EXPECT_THROW(
      static_cast<void>(mesh_rank(control_mesh_of(fan({31})), {.scheme = Scheme::doo_sabin}, monitor)),
      Interrupted);
}

// A torus with every third face a hole.
TEST(mesh_rank, of_the_largest_mesh_takes_seconds) {
  std::mt19937_64 random(5);
  ControlMesh mesh = testing::control_mesh_of(testing::torus(200, 100), random);
  for (std::size_t f = 0; f < mesh.face_count(); f += 3) mesh.tags.holes.emplace_back(f);
  const auto start = std::chrono::steady_clock::now();
  const MeshRank found = mesh_rank(mesh, {.scheme = Scheme::catmark});
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(found.dimension, max_ranked_vertices);
  EXPECT_TRUE(found.decided());
  EXPECT_EQ(found.least, found.dimension);
  RecordProperty("seconds", std::to_string(taken.count()));
  EXPECT_LT(taken.count(), 20);
}

}  // namespace
}  // namespace snug::mesh_rank_test
