#include <gtest/gtest.h>
#include <snug/independence/cases.h>
#include <snug/independence/null_space.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <tuple>

#include <snug/evaluate.h>

// Faces at a boundary vertex.
namespace snug::boundary_test {
namespace {

using Kind = IndependenceDomain::Kind;

constexpr ExactScheme loop{Scheme::loop}, catmark{Scheme::catmark};
constexpr std::array schemes{loop, catmark};

bool is_loop(const ExactScheme& scheme) { return scheme.scheme == Scheme::loop; }

// do(scheme, faces, face, corner) for all faces of all fans.
template <class Do>
void for_all_faces(std::uint32_t most, const Do& act) {
  for (const ExactScheme& scheme : schemes) {
    for (std::uint32_t n = 1; n <= most; ++n) {
      for (std::uint32_t i = 1; i <= n; ++i) {
        for (const bool corner : {false, true}) {
          SCOPED_TRACE(std::string(is_loop(scheme) ? "loop " : "catmark ") + std::to_string(i) + " of " +
                       std::to_string(n) + (corner ? " at a corner" : ""));
          act(scheme, n, i, corner);
        }
      }
    }
  }
}

std::vector<IndependenceCase> cases(const ExactScheme& scheme, std::uint32_t n, const BoundaryFace& at,
                                    const std::vector<IndependenceDomain>& domains,
                                    std::uint32_t min_prime = 1U << 30) {
  std::vector<IndependenceRequest> requests;
  for (const IndependenceDomain& domain : domains) requests.push_back({domain, "", std::nullopt});
  return independence_cases(scheme, {n, {}, false, at}, requests, {}, min_prime);
}

// Claims of docs/derivations/independence.md.
std::uint32_t proved_dimension(const ExactScheme& scheme, std::uint32_t n, std::uint32_t i) {
  return (is_loop(scheme) ? n + 7 : 2 * n + 9) - (i == 1 ? 1 : 0) - (i == n ? 1 : 0);
}
std::uint32_t proved_kernel(const ExactScheme& scheme, std::uint32_t n, std::uint32_t i, bool corner,
                            std::uint32_t k) {
  const int m = is_loop(scheme) ? 1 : 2;
  const auto side = [&](std::uint32_t faces) {
    return std::max(0, m * (static_cast<int>(faces) - 1) - static_cast<int>(k));
  };
  return static_cast<std::uint32_t>(std::max(0, side(i - 1) + side(n - i) - (corner ? 0 : 1)));
}

// All faces around the faces of the fan.
NetPart whole_fan(const ExactScheme& scheme, std::uint32_t n) {
  NetPart net;
  const std::uint32_t first = (is_loop(scheme) ? n + 1 : 2 * n + 1) + 1;  // of the outer points
  const auto s = [&](std::uint32_t i) { return first + i; };
  if (is_loop(scheme)) {
    net.points = first + 2 * n + 1;
    for (std::uint32_t j = 0; j <= n; ++j) {
      const std::uint32_t p = 1 + j;
      if (j > 0) net.faces.push_back({p, s(2 * j - 1), s(2 * j)});
      if (j == n) break;
      net.faces.push_back({p, s(2 * j), s(2 * j + 1)});
      net.faces.push_back({0, p, p + 1});
      net.faces.push_back({p + 1, p, s(2 * j + 1)});
    }
    return net;
  }
  net.points = first + 4 * n + 1;
  for (std::uint32_t j = 0; j < n; ++j) {
    const std::uint32_t e = 1 + 2 * j, f = e + 1, next = e + 2;
    net.faces.push_back({0, e, f, next});
    net.faces.push_back({f, e, s(4 * j), s(4 * j + 1)});
    net.faces.push_back({f, s(4 * j + 1), s(4 * j + 2), s(4 * j + 3)});
    net.faces.push_back({f, s(4 * j + 3), s(4 * j + 4), next});
  }
  return net;
}

Point3 combination(const WeightRow& row, const std::vector<Point3>& points) {
  Point3 sum{};
  for (const auto& [p, w] : row) {
    EXPECT_TRUE(w.is_rational());
    const double weight = w.rational.get_d();
    sum = {sum.x + weight * points[p].x, sum.y + weight * points[p].y, sum.z + weight * points[p].z};
  }
  return sum;
}
bool is_among(const Point3& p, const std::vector<Point3>& points) {
  return std::any_of(points.begin(), points.end(), [&](const Point3& q) {
    return std::abs(p.x - q.x) + std::abs(p.y - q.y) + std::abs(p.z - q.z) < 1e-12;
  });
}

// The library's own masks make every point of a step, and of the step after it.
TEST(boundary_step, makes_the_points_of_subdivided_meshes) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> anywhere(-1, 1);
  for_all_faces(7, [&](const ExactScheme& scheme, std::uint32_t n, std::uint32_t i, bool corner) {
    const NetPart fan = whole_fan(scheme, n);
    ControlMesh mesh;
    for (std::uint32_t p = 0; p < fan.points; ++p)
      mesh.points.push_back({anywhere(random), anywhere(random), anywhere(random)});
    for (const auto& face : fan.faces) mesh.add_face(std::vector<VertexId>(face.begin(), face.end()));
    if (corner) mesh.tags.corners.push_back({VertexId(0), infinite_sharpness});
    const SurfaceOptions options{.scheme = scheme.scheme, .boundary = BoundaryRule::edge_only};

    const PieceStep step = boundary_step(scheme, n, {i, corner});
    std::vector<Point3> points;
    for (const std::uint32_t p : embedded(boundary_net(scheme, n, {i, corner}), {0, 1}, fan, {0, 1}))
      points.push_back(mesh.points[p]);
    for (const unsigned level : {1U, 2U}) {
      const ControlMesh fine = subdivided(mesh, level, false, options);
      std::vector<Point3> next;
      for (const WeightRow& row : step.rows) {
        const Point3 p = combination(row, points);
        ASSERT_TRUE(is_among(p, fine.points)) << level;
        if (next.size() < step.kept) next.push_back(p);
      }
      points = std::move(next);
    }
  });
}

// A corner of any angle of the lattice, and a straight boundary, look the same after a step.
TEST(boundary_step, halves_a_lattice) {
  for_all_faces(5, [&](const ExactScheme& scheme, std::uint32_t n, std::uint32_t i, bool corner) {
    const bool straight = n == (is_loop(scheme) ? 3 : 2);
    if ((!corner && !straight) || (!is_loop(scheme) && n > 3)) return;
    const NetPart fan = whole_fan(scheme, n);
    // Around the vertex at the origin: turns of 60 or 90 degrees, in coordinates along two edges.
    std::vector<Point3> lattice{{}};
    const auto turned = [&](double x, double y, std::uint32_t times) {
      for (; times > 0; --times) std::tie(x, y) = is_loop(scheme) ? std::pair(-y, x + y) : std::pair(-y, x);
      return Point3{x, y, 1};
    };
    lattice[0].z = 1;
    if (is_loop(scheme)) {
      for (std::uint32_t j = 0; j <= n; ++j) lattice.push_back(turned(1, 0, j));
      for (std::uint32_t j = 0; j <= 2 * n; ++j) lattice.push_back(turned(j % 2 == 0 ? 2 : 1, j % 2, j / 2));
    } else {
      for (std::uint32_t j = 0; j <= 2 * n; ++j) lattice.push_back(turned(1, j % 2, j / 2));
      constexpr std::array around{std::pair{2, 0}, std::pair{2, 1}, std::pair{2, 2}, std::pair{1, 2}};
      for (std::uint32_t j = 0; j <= 4 * n; ++j)
        lattice.push_back(turned(around[j % 4].first, around[j % 4].second, j / 4));
    }
    const PieceStep step = boundary_step(scheme, n, {i, corner});
    std::vector<Point3> points;
    for (const std::uint32_t p : embedded(boundary_net(scheme, n, {i, corner}), {0, 1}, fan, {0, 1}))
      points.push_back(lattice[p]);
    for (std::uint32_t p = 0; p < step.kept; ++p) {
      const Point3 fine = combination(step.rows[p], points);
      ASSERT_EQ(fine.x, points[p].x / 2) << p;
      ASSERT_EQ(fine.y, points[p].y / 2) << p;
      ASSERT_EQ(fine.z, 1) << p;
    }
  });
}

// 12 or 16, less what is beyond a boundary edge, 3 or 4, or beyond a boundary vertex, 2 at each of Loop's middle piece.
TEST(boundary_step, gives_regular_pieces_the_control_points_that_are_there) {
  for_all_faces(6, [&](const ExactScheme& scheme, std::uint32_t n, std::uint32_t i, bool corner) {
    const PieceStep step = boundary_step(scheme, n, {i, corner});
    const std::size_t first = i == 1 ? 1 : 0, last = i == n ? 1 : 0;
    const std::array<std::size_t, 3> sizes =
        is_loop(scheme) ? std::array{12 - 3 * first, 12 - 2 * (first + last), 12 - 3 * last}
                        : std::array{16 - 4 * first, std::size_t{16}, 16 - 4 * last};
    ASSERT_EQ(step.pieces.size(), 3);
    for (std::size_t piece = 0; piece < 3; ++piece)
      EXPECT_EQ(step.pieces[piece].size(), sizes[piece]) << piece;
    EXPECT_EQ(step.kept, proved_dimension(scheme, n, i));
    EXPECT_EQ(step.dimension, step.kept);
  });
}

// The one thing that the proof computes: ring 1 tells the near points, by masks that reach no others, without the vertex's own.
TEST(boundary_step, masks_of_near_points_tell_them) {
  for_all_faces(8, [&](const ExactScheme& scheme, std::uint32_t n, std::uint32_t i, bool corner) {
    const PieceStep step = boundary_step(scheme, n, {i, corner});
    const std::uint32_t around = is_loop(scheme) ? n + 2 : 2 * n + 2;
    std::set<std::uint32_t> ring, near{0};
    for (const auto& piece : step.pieces) {
      for (const Functional& functional : piece) ring.insert(functional[0].first);
    }
    for (const std::uint32_t r : ring) {
      if (r < around) continue;
      for (const auto& [point, w] : step.rows[r]) near.insert(point);
    }
    std::vector<std::vector<mpq_class>> masks;
    std::size_t others = 0;
    for (const std::uint32_t r : ring) {
      const WeightRow& row = step.rows[r];
      if (r == 0) continue;
      if (!std::all_of(row.begin(), row.end(),
                       [&](const auto& entry) { return near.contains(entry.first); })) {
        ++others;
        continue;
      }
      masks.emplace_back(step.dimension);
      for (const auto& [point, w] : row) masks.back()[point] += w.rational;
    }
    const auto least = [](std::uint32_t a, std::uint32_t b) { return std::min(a, b); };
    const std::uint32_t sides = least(i, 2) + least(n + 1 - i, 2);
    const std::uint32_t outer = (is_loop(scheme) ? 5 : 7) - (i == 1 ? 1 : 0) - (i == n ? 1 : 0);
    EXPECT_EQ(near.size(), 1 + outer + (is_loop(scheme) ? sides : 2 * sides - 1));
    EXPECT_EQ(step.dimension - null_space(masks, step.dimension).size(), near.size());
    EXPECT_EQ(others, (i > 2 ? 1U : 0U) + (n + 1 - i > 2 ? 1U : 0U));
  });
}

TEST(independence_at_boundaries, ranks_on_rings_are_those_of_the_proof) {
  for_all_faces(9, [&](const ExactScheme& scheme, std::uint32_t n, std::uint32_t i, bool corner) {
    std::uint32_t enough = 1;
    while (proved_kernel(scheme, n, i, corner, enough) > 0) ++enough;
    std::vector<IndependenceDomain> domains;
    for (std::uint32_t k = 1; k <= enough + 1; ++k) domains.push_back({Kind::rings, k});
    domains.push_back({Kind::omega});
    for (const IndependenceCase& found : cases(scheme, n, {i, corner}, domains)) {
      const std::uint32_t k = found.domain.kind == Kind::omega ? enough : found.domain.first;
      ASSERT_EQ(found.dimension, proved_dimension(scheme, n, i));
      ASSERT_EQ(found.dimension - found.rank, proved_kernel(scheme, n, i, corner, k))
          << name_of(found.domain);
      if (found.domain.kind == Kind::omega) {
        ASSERT_EQ(found.certificate.rings, enough);
      }
    }
    // The last that adds something.
    const auto all = boundary_domains(scheme, {n, {}, false, BoundaryFace{i, corner}});
    ASSERT_EQ(all.size(), 6 + enough + 1);
    ASSERT_EQ(all[5 + enough], (IndependenceDomain{Kind::rings, enough}));
  });
}

TEST(independence_at_boundaries, mirror_images_have_the_same_ranks) {
  for_all_faces(7, [&](const ExactScheme& scheme, std::uint32_t n, std::uint32_t i, bool corner) {
    const auto found =
                   cases(scheme, n, {i, corner}, {{Kind::piece, 1}, {Kind::pieces, 1, 2}, {Kind::ring, 2}}),
               mirror = cases(scheme, n, {n + 1 - i, corner},
                              {{Kind::piece, 3}, {Kind::pieces, 2, 3}, {Kind::ring, 2}});
    for (std::size_t c = 0; c < found.size(); ++c) ASSERT_EQ(found[c].rank, mirror[c].rank) << c;
  });
}

TEST(independence_at_boundaries, kernels_vanish_on_the_domain_and_leave_nothing_out) {
  for_all_faces(6, [&](const ExactScheme& scheme, std::uint32_t n, std::uint32_t i, bool corner) {
    const PieceCorners corners{n, {}, false, BoundaryFace{i, corner}};
    const std::vector<IndependenceDomain> domains = boundary_domains(scheme, corners);
    const auto right = cases(scheme, n, *corners.boundary, domains),
               unlucky = cases(scheme, n, *corners.boundary, domains, 2);
    for (std::size_t c = 0; c < right.size(); ++c) {
      const RankCertificate& why = right[c].certificate;
      ASSERT_EQ(unlucky[c].rank, right[c].rank);
      ASSERT_EQ(why.root, 0);
      ASSERT_EQ(why.left_out, 0);
      ASSERT_EQ(why.bound == RankCertificate::Bound::full, right[c].independent());
      if (why.bound == RankCertificate::Bound::kernel) {
        ASSERT_EQ(right[c].dimension - why.kernel.size(), right[c].rank);
      }
    }
  });
}

}  // namespace
}  // namespace snug::boundary_test
