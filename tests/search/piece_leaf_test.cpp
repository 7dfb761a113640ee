// Bounds of pieces without their control points: limit points of the library, and of the twins, are
// near base triangles and quadratics as records say, for whole patches and for pieces down to level 20.

#include <snug/search/piece_leaf.h>

#include <gtest/gtest.h>
#include <oracle/polygon_twin.h>
#include <snug/search/piece_cache.h>
#include <testing/containment.h>
#include <testing/counts.h>
#include <testing/disguises.h>
#include <testing/scheme_surfaces.h>

#include <cstdio>

namespace snug::piece_leaf_test {
namespace {

using testing::Extended;

// A limit point that is known to `known`, a length.
struct Sample {
  TriangleParameter at;
  Extended x;
  long double known;
};

struct Counts {
  std::size_t samples = 0, records = 0, near_error = 0, near_extent = 0, distances = 0, narrow = 0,
              sharper = 0;
  unsigned deepest = 0;
};

void expect_known(const Node& node, const Sample& sample, const Vector3& w, const std::string& name,
                  Counts& counts) {
  const PieceBounds& record = PieceCache::bounds_of(node);
  const Point3& origin = node.boxes->origin();
  ++counts.samples;
  if (!std::isfinite(record.radius())) {
    EXPECT_EQ(record.error(), INFINITY) << name;
    return;
  }
  const Extended from = testing::minus(sample.x, testing::extended(origin));
  // Sums in extended precision; coordinates are at most about 2.
  const long double known = sample.known + 0x1p-61L;
  ASSERT_TRUE(testing::within_radius(sample.x, record.base(origin), record.radius() + known))
      << name << ": beyond the radius " << record.radius();
  const Vector3 at = record.at(sample.at);
  const Extended off{from[0] - at.x, from[1] - at.y, from[2] - at.z};
  const long double distance = std::sqrt(testing::inner(off, off));
  ASSERT_LE(distance, record.error() + known) << name << " at " << sample.at.u << ", " << sample.at.v;
  counts.near_error += distance > 0.5L * record.error();
  const long double size =
      std::sqrt(static_cast<long double>(w.x) * w.x + static_cast<long double>(w.y) * w.y +
                static_cast<long double>(w.z) * w.z);
  if (size == 0) return;
  const double along = record.error_along(static_cast<double>(1 / size) * w);
  ASSERT_LE(along, record.error() * (1 + 1e-6)) << name;
  const long double height = w.x * from[0] + w.y * from[1] + w.z * from[2],
                    extent = record.extent(w) + size * along;
  ASSERT_LE(height, extent + size * known) << name << ": beyond the extent";
  ASSERT_LE(std::fabs(w.x * off[0] + w.y * off[1] + w.z * off[2]), size * (along + known)) << name;
  counts.sharper += along < 0.75 * record.error();
  counts.near_extent += extent - height < 0.1L * size * node.size();
}

// From a point beside the piece, on it, or far away: no limit point is nearer than the lower bound, and the quadratic's point is
// as near as the upper one.
void expect_distances(const Node& node, const Sample& sample, std::mt19937_64& random,
                      const std::string& name, Counts& counts) {
  const PieceBounds& record = PieceCache::bounds_of(node);
  if (!std::isfinite(record.radius())) return;
  const Point3& origin = node.boxes->origin();
  const Extended x = testing::minus(sample.x, testing::extended(origin));
  const double away = static_cast<double>(node.size()) * std::array{0.0, 1e-3, 1.0, 30.0, 1e6}[random() % 5];
  Vector3 point;
  for (std::size_t k = 0; k < 3; ++k)
    point[k] = static_cast<double>(x[k]) + away * (testing::unit(random) - 0.5);
  const PieceBounds::QuadraticDistance found = record.distance(point);
  const auto apart = [&](const Extended& p) {
    const Extended off{p[0] - point.x, p[1] - point.y, p[2] - point.z};
    return std::sqrt(testing::inner(off, off));
  };
  ASSERT_LE(found.lower - record.error(), apart(x) + sample.known + 0x1p-58L * (1 + away)) << name;
  const Vector3 at = record.at(found.at);
  const long double quadratic = apart({at.x, at.y, at.z});
  ASSERT_LE(quadratic, found.upper + 0x1p-50L * (1 + away)) << name;
  ASSERT_LE(found.lower, quadratic + 0x1p-50L * (1 + away)) << name;
  ++counts.distances;
  counts.narrow += found.upper - found.lower < 0.05 * static_cast<double>(node.size());
}

// Also along an axis or across the piece: of long and of short vectors.
Vector3 any_direction(std::mt19937_64& random, const Node& node) {
  const double length = std::ldexp(1.0, std::array{0, 0, -40, 30}[random() % 4]);
  switch (random() % 4) {
    case 0:
      return {0, random() % 2 == 0 ? length : -length, 0};
    case 1:
      return (random() % 2 == 0 ? length : -length) *
             unit_normal(PieceCache::bounds_of(node).base(node.boxes->origin()));
    default:
      return length *
             Vector3{testing::unit(random) - 0.5, testing::unit(random) - 0.5, testing::unit(random) - 0.5};
  }
}

void expect_piece_known(PieceCache& workspace, const Node& node, std::mt19937_64& random,
                        const std::string& name, Counts& counts) {
  const Patch& patch = workspace.patch(node);
  ++counts.records;
  counts.deepest = std::max<unsigned>(counts.deepest, patch.path.level());
  for (int i = 0; i < 9; ++i) {
    TriangleParameter at = testing::random_parameter(random);
    if (i < 3) at = std::array<TriangleParameter, 3>{{{0, 0}, {1, 0}, {0, 1}}}[static_cast<std::size_t>(i)];
    if (i == 3) at.v = 0;
    if (i == 4) at = {at.u, 1 - at.u};
    const RelativePoint point = limit_point(patch, at);
    Extended x;
    for (std::size_t k = 0; k < 3; ++k) x[k] = static_cast<long double>(patch.origin[k]) + point.relative[k];
    // Parameters on the far edge are rounded to it.
    const double rounded = i == 4 ? 0x1p-50 * static_cast<double>(node.size()) : 0;
    const Sample sample{at, x, 1.75L * point.error + rounded};
    expect_known(node, sample, any_direction(random, node), name, counts);
    expect_distances(node, sample, random, name, counts);
    if (::testing::Test::HasFatalFailure()) return;
  }
}

// From the root of the tree down to some patch, then so many levels, random children or always towards one corner.
void walk_down(PieceCache& workspace, std::size_t levels, std::mt19937_64& random, const std::string& name,
               Counts& counts) {
  Node node = workspace.root();
  const std::size_t towards = random() % 8;
  for (std::size_t level = 0; !::testing::Test::HasFailure();) {
    if (node.bounded()) {
      expect_piece_known(workspace, node, random, name, counts);
      if (level++ == levels || !PieceCache::can_open(node)) return;
    }
    const bool piece = node.bounded();
    const PieceCache::Opened opened = workspace.open(node);
    node = opened.child(piece && towards < 3 ? towards : random() % opened.count());
  }
}

TEST(piece_record, holds_limit_points_of_every_kind) {
  std::mt19937_64 random(31);
  Counts counts;
  testing::for_each_surface(31, [&](const testing::NamedSurface& named) {
    std::size_t patches = 0;
    testing::for_each_patch(named.surface, [&](PatchId) { ++patches; });
    if (patches == 0) return;
    for (const BoundMethod method : {BoundMethod::rows, BoundMethod::table}) {
      const SurfaceBvh model(named.surface, {.method = method, .tight = random() % 2 == 0, .threads = 1});
      PieceCache workspace(model);
      workspace.begin();
      for (int walk = 0; walk < 3; ++walk) {
        walk_down(workspace, random() % 8 == 0 ? 20 : random() % 6, random, named.name, counts);
      }
    }
  });
  std::printf("  %zu samples of %zu records, to level %u; %zu near the error, %zu near the extent\n",
              counts.samples, counts.records, counts.deepest, counts.near_error, counts.near_extent);
  EXPECT_GT(counts.samples, testing::fewer(20'000));
  EXPECT_GE(counts.deepest, 18u);
  EXPECT_GT(counts.near_error, testing::fewer(200));
  EXPECT_GT(counts.near_extent, testing::fewer(200));
  EXPECT_GT(counts.sharper, counts.samples / 8);
  EXPECT_GT(counts.narrow, counts.distances / 3);
}

// Parameters of a sample in the children that hold it, exact for multiples of powers of two.
std::optional<TriangleParameter> in_child(TriangleParameter p, std::size_t child) {
  const auto [u, v] = p;
  switch (child) {
    case 0:
      return u + v <= 0.5 ? std::optional(TriangleParameter{2 * u, 2 * v}) : std::nullopt;
    case 1:
      return u >= 0.5 ? std::optional(TriangleParameter{2 * u - 1, 2 * v}) : std::nullopt;
    case 2:
      return v >= 0.5 ? std::optional(TriangleParameter{2 * u, 2 * v - 1}) : std::nullopt;
    default:
      return u <= 0.5 && v <= 0.5 && u + v >= 0.5 ? std::optional(TriangleParameter{1 - 2 * u, 1 - 2 * v})
                                                  : std::nullopt;
  }
}

// All samples of the twin in all pieces that hold them.
void expect_samples_known(PieceCache& workspace, const Node& node, const std::vector<Sample>& samples,
                          unsigned levels, std::mt19937_64& random, const std::string& name, Counts& counts) {
  if (samples.empty()) return;
  ++counts.records;
  const Vector3 w = any_direction(random, node);
  for (const Sample& sample : samples) {
    expect_known(node, sample, w, name, counts);
    expect_distances(node, sample, random, name, counts);
    if (::testing::Test::HasFatalFailure()) return;
  }
  if (levels == 0 || !PieceCache::can_open(node)) return;
  const PieceCache::Opened opened = workspace.open(node);
  for (std::size_t child = 0; child < 4; ++child) {
    std::vector<Sample> inside;
    for (const Sample& sample : samples) {
      if (const auto at = in_child(sample.at, child)) inside.push_back({*at, sample.x, sample.known});
    }
    expect_samples_known(workspace, opened.child(child), inside, levels - 1, random, name, counts);
    if (::testing::Test::HasFailure()) return;
  }
}

void expect_twin_known(const testing::TaggedCase& c, const std::shared_ptr<BoundsCache>& library,
                       std::mt19937_64& random, Counts& counts) {
  constexpr unsigned levels = 3;
  const LimitSurface surface(testing::control_mesh(c.mesh, c.rules), testing::options_of(c.rules), library);
  const bool loop = surface.options().scheme == Scheme::loop;
  std::vector<std::vector<Sample>> samples(surface.patch_count());
  for (const oracle::FaceSample& s : oracle::sample_faces(c.mesh, c.rules, levels)) {
    const Point3 x = surface.scale().apply(Point3{s.position[0], s.position[1], s.position[2]});
    const long double known = 1.75L * surface.scale().apply(s.error) + 0x1p-1000L;
    for (unsigned half = 0; half < (loop ? 1u : 2u); ++half) {
      if (!loop && (half == 0 ? s.v > s.u : s.u > s.v)) continue;
      const TriangleParameter at = loop        ? TriangleParameter{s.u, s.v}
                                   : half == 0 ? TriangleParameter{s.u - s.v, s.v}
                                               : TriangleParameter{s.v - s.u, 1 - s.v};
      const std::size_t patch = surface.patches_of(s.face).begin + (loop ? 0 : 2 * s.part + half);
      samples[patch].push_back({at, testing::extended(x), known});
    }
  }
  if (std::ranges::all_of(samples, [](const auto& some) { return some.empty(); })) return;
  const SurfaceBvh model(surface, {.tight = random() % 2 == 0, .threads = 1});
  PieceCache workspace(model);
  workspace.begin();
  std::vector<Node> nodes{workspace.root()};
  while (!nodes.empty() && !::testing::Test::HasFailure()) {
    const Node node = nodes.back();
    nodes.pop_back();
    if (node.bounded()) {
      if (random() % 4 != 0) continue;
      expect_samples_known(workspace, node, samples[workspace.name(node).patch.index()], levels, random,
                           c.name + ", " + testing::text_of(c.rules), counts);
      continue;
    }
    const PieceCache::Opened opened = workspace.open(node);
    for (std::size_t i = 0; i < opened.count(); ++i) nodes.push_back(opened.child(i));
  }
}

TEST(piece_record, holds_samples_of_the_twin) {
  std::mt19937_64 random(32);
  Counts counts;
  for (const auto scheme : {oracle::PrimalScheme::catmull_clark, oracle::PrimalScheme::loop}) {
    const auto library = std::make_shared<BoundsCache>();
    const std::vector<testing::Disguise> disguises = testing::disguises();
    std::size_t number = 0;
    for (testing::TaggedCase c : testing::tagged_cases(scheme, 83)) {
      if (random() % 3 != 0) continue;
      const testing::Disguise& disguise = disguises[number++ % (2 * disguises.size()) / 2];
      if (number % 2 == 0) {
        c.name += ", " + disguise.name;
        for (oracle::Point& p : c.mesh.points) p = disguise.change(p);
      }
      expect_twin_known(c, library, random, counts);
      if (HasFailure()) return;
    }
  }
  std::printf("  %zu samples of %zu records; %zu near the error, %zu near the extent\n", counts.samples,
              counts.records, counts.near_error, counts.near_extent);
  EXPECT_GT(counts.samples, 50'000u);
  EXPECT_GT(counts.near_error, 500u);
}

TEST(piece_record, is_infinite_where_a_number_is_not_finite) {
  OffsetTriangle offset{};
  offset.base = {Point3{0, 0, 0}, Point3{1, 0, 0}, Point3{0, 1, 0}};
  offset.radius = 0.1;
  const QuadraticTriangle flat{{Point3{}, Point3{1, 0, 0}, Point3{0, 1, 0}},
                               {Point3{0.5, 0, 0}, Point3{0.5, 0.5, 0}, Point3{0, 0.5, 0}},
                               0.01};
  const PieceBounds good(offset, flat, {});
  EXPECT_LE(good.radius(), 0.1001);
  EXPECT_LE(good.error(), 0.0101);
  for (const double bad : std::array<double, 3>{NAN, INFINITY, 1e200}) {
    OffsetTriangle radius = offset, corner = offset;
    radius.radius = bad;
    corner.base[1].y = bad;
    QuadraticTriangle error = flat, middle = flat;
    error.error = bad;
    middle.middles[2].z = bad;
    for (const PieceBounds& record :
         {PieceBounds(radius, flat, {}), PieceBounds(corner, flat, {}), PieceBounds(offset, error, {}),
          PieceBounds(offset, middle, {}), PieceBounds(offset, flat, {bad, 0, 0})}) {
      EXPECT_EQ(record.radius(), INFINITY) << bad;
      EXPECT_EQ(record.error(), INFINITY) << bad;
      // Not that much more is known by numbers that are left.
      EXPECT_FALSE(std::isnan(record.extent({1, 2, 3}))) << bad;
    }
  }
}

}  // namespace
}  // namespace snug::piece_leaf_test
