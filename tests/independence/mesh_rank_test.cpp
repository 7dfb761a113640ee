#include <snug/independence/mesh_rank.h>

#include <gtest/gtest.h>
#include <oracle/dual_twin.h>
#include <oracle/limit_twin.h>
#include <oracle/polygon_twin.h>
#include <testing/closed_meshes.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <memory>

#include <snug/error.h>
#include <snug/independence/mesh_kernel.h>
#include <snug/mesh/topology.h>

// Ranks by elimination against the theorem where it holds, and against ranks of sampled limits, which share nothing with the
// library but the masks' definitions.
namespace snug {
namespace {

using testing::ClosedMesh;

// A mesh with tags, for the library and for the twins.
struct Shape {
  std::string name;
  oracle::TaggedMesh mesh;
  BoundaryRule boundary = BoundaryRule::edge_and_corner;
  bool chaikin = false;
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
  for (const auto& corner : shape.mesh.corners) mesh.tags.corners.push_back({VertexId(corner.vertex), corner.sharpness});
  for (const std::uint32_t hole : shape.mesh.holes) mesh.tags.holes.emplace_back(hole);
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
      const auto own = scheme == Scheme::doo_sabin ? oracle::DualScheme::doo_sabin : oracle::DualScheme::midedge;
      for (const auto& sample : oracle::sample_dual(mesh, own, 4)) add(sample.position);
    }
  }
  return columns;
}

// Gram and Schmidt, the longest column first; nothing where lengths leave no gap.
std::optional<std::size_t> numerical_rank(Columns columns) {
  const auto dot = [](const auto& a, const auto& b) { return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); };
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
  const double t = 2 * std::cos(2 * M_PI / order);
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
  std::size_t compared = 0, unclear = 0, refused = 0, undecided = 0, dependent = 0, irrational = 0, beyond = 0;
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

// What the theorem leaves out, and what is beside it.
using Feature = std::pair<const char*, std::function<void(Shape&, std::mt19937_64&)>>;

std::uint32_t below(std::size_t n, std::mt19937_64& random) { return static_cast<std::uint32_t>(random() % n); }

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
       [](Shape& shape, std::mt19937_64& random) {  // two faces of eight or nine corners share a vertex inside
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
    const bool hole = std::find(shape.mesh.holes.begin(), shape.mesh.holes.end(), f) != shape.mesh.holes.end();
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
  return {tetrahedron(), prism(3), prism(4), prism(5), torus(3, 3), trapezohedron(3), trapezohedron(5), bipyramid(4)};
}

Tally tally_of_pairs(Scheme scheme, int rounds, std::size_t most_vertices) {
  Tally tally;
  std::mt19937_64 random(7);
  const std::vector<ClosedMesh> meshes = small_meshes();
  const std::vector<Feature> all = features();
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t a = 0; a < all.size(); ++a) {
      for (std::size_t b = a; b < all.size(); ++b) {
        Shape shape = shape_of(meshes[random() % meshes.size()]);
        for (const std::size_t k : {a, b}) {
          all[k].second(shape, random);
          shape.name += std::string(", ") + all[k].first;
        }
        if (scheme == Scheme::loop) shape = triangulated(shape);
        if (shape.mesh.points.size() <= most_vertices) compare(shape, scheme, tally);
      }
    }
  }
  std::printf("%s: %zu compared, %zu unclear, %zu refused, %zu undecided, %zu dependent, %zu irrational, %zu beyond\n",
              name_of(scheme), tally.compared, tally.unclear, tally.refused, tally.undecided, tally.dependent,
              tally.irrational, tally.beyond);
  return tally;
}

TEST(mesh_rank, of_pairs_of_features_with_catmark) { tally_of_pairs(Scheme::catmark, 1, 30); }
TEST(mesh_rank, of_pairs_of_features_with_loop) { tally_of_pairs(Scheme::loop, 1, 24); }
TEST(mesh_rank, of_pairs_of_features_with_doo_sabin) { tally_of_pairs(Scheme::doo_sabin, 3, 40); }
TEST(mesh_rank, of_pairs_of_features_with_midedge) { tally_of_pairs(Scheme::midedge, 3, 40); }

}  // namespace
}  // namespace snug
