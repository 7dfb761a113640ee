// Limits of the nets at extraordinary corners, against some twenty levels of them.

#include <snug/patch/evaluate.h>
#include <snug/shape/corner_asymptotics.h>
#include <snug/shape/corner_rings.h>
#include <snug/shape/corner_side.h>
#include <snug/surface/limit_surface.h>

#include <gtest/gtest.h>
#include <oracle/quad.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <memory>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace snug::corner_rings_test {
namespace {

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; }

// Control values (x, y, 0).
Patch random_values(const Kind& kind, std::mt19937_64& random) {
  Patch patch;
  patch.kind = &kind;
  patch.points.resize(kind.control_count());
  const double wide = std::exp2(2 * unit(random));
  for (Vector3& p : patch.points) {
    p = {wide * unit(random), unit(random), 0};
    patch.largest = std::max(patch.largest, max_abs(p));
  }
  patch.error = 1e-15;
  return patch;
}

// Both values, less their means; along axes, and over a number.
std::vector<double> centred(Patch patch, const std::array<Point2, 2>& axes = {{{1, 0}, {0, 1}}},
                            double scale = 1) {
  for (Vector3& p : patch.points) p = {dot(axes[0], {p.x, p.y}) / scale, dot(axes[1], {p.x, p.y}) / scale, 0};
  std::vector<double> v;
  Vector3 mean;
  for (const Vector3& p : patch.points) mean = mean + (1 / static_cast<double>(patch.points.size())) * p;
  for (const Vector3& p : patch.points) v.push_back(p.x - mean.x);
  for (const Vector3& p : patch.points) v.push_back(p.y - mean.y);
  return v;
}

// The largest extent of a value.
double widest(const std::vector<double>& v) {
  double most = 0;
  for (const std::size_t begin : {std::size_t{0}, v.size() / 2}) {
    const auto [low, high] =
        std::minmax_element(v.begin() + static_cast<std::ptrdiff_t>(begin),
                            v.begin() + static_cast<std::ptrdiff_t>(begin + v.size() / 2));
    most = std::max(most, 0.5 * (*high - *low));
  }
  return most;
}

// Down to where a level is hardly more than rounding.
void expect_holds(const RingDecay& decay, std::mt19937_64& random) {
  const Kind& kind = *decay.kind;
  Patch values = random_values(kind, random);
  // Of a spike: nothing of it.
  Vector3 seen;
  for (std::size_t i = 0; i < decay.spike_row.size(); ++i)
    seen = seen + decay.spike_row[i] * values.points[i];
  for (std::size_t i = 0; i < decay.spike_row.size(); ++i)
    values.points[i] = values.points[i] - decay.spike_column[i] * seen;
  const CornerRings rings(decay, values);
  Patch at = values;
  std::vector<Patch> direct;
  for (std::size_t level = 0; level < std::min<std::size_t>(rings.count(), 25); ++level) {
    double size = 0;
    for (const Vector3& p : at.points) size = std::max(size, max_abs(p - at.points[0]));
    if (!(size > 1e9 * at.error)) break;
    direct.push_back(at);
    at = split(at, static_cast<unsigned>((decay.corner + at.first) % 3));
  }
  ASSERT_GT(direct.size(), std::min<std::size_t>(rings.count(), 8) - 1);
  // What the one that is split level by level is off.
  const auto off_of = [&](std::size_t level, const std::array<Point2, 2>& axes) {
    double weight = 0;
    for (const Point2& axis : axes) weight = std::max(weight, std::fabs(axis.x) + std::fabs(axis.y));
    return weight * direct[level].error / std::pow(middle(decay.least), static_cast<double>(level));
  };
  const auto scale = [&](std::size_t level) {
    return std::pow(middle(decay.least), static_cast<double>(level));
  };
  for (std::size_t level = 0; level < direct.size(); ++level) {
    const Patch net = rings.net(level);
    std::vector<double> rest = centred(direct[level], rings.axes(level), scale(level));
    const std::vector<double> own = centred(net);
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= own[i];
    EXPECT_LE(widest(rest), 2 * net.error + 1e-6 * net.largest + 2 * off_of(level, rings.axes(level)))
        << "level " << level;
  }
  // One net for some levels.
  for (std::size_t level = 0; level < direct.size(); ++level) {
    for (const std::size_t at_once : {2, 5, 9}) {
      if (at_once > rings.rings_at_once(level) || level + at_once > direct.size()) continue;
      const Patch net = rings.net(level, at_once);
      const std::vector<double> own = centred(net);
      for (std::size_t further = level; further < level + at_once; ++further) {
        std::vector<double> rest = centred(direct[further], rings.axes(level), scale(further));
        for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= own[i];
        EXPECT_LE(widest(rest), 1.001 * net.error + off_of(further, rings.axes(level)) + 1e-9 * net.largest)
            << "level " << level << " and " << further;
      }
    }
  }
  for (std::size_t level = 0; level < direct.size(); ++level) {
    const std::vector<Patch> nets = rings.all_further(level);
    const Patch& net = nets[0];
    EXPECT_EQ(nets.size(), 1U + (decay.larger ? 1 : 0) + (decay.links > 0 ? 1 : 0));
    if (!(net.error < 0.2 * net.largest)) continue;
    // How often each growth is added.
    const double ratio = middle(decay.ratio);
    std::vector<double> times(nets.size(), 0);
    times[0] = 1;
    for (std::size_t further = level; further < direct.size(); ++further) {
      std::vector<double> rest = centred(direct[further], rings.axes(level), scale(further));
      double off = off_of(further, rings.axes(level)), large = 0;
      for (std::size_t n = 0; n < nets.size(); ++n) {
        const std::vector<double> one = centred(nets[n]);
        for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= times[n] * one[i];
        off += times[n] * nets[n].error;
        large += times[n] * nets[n].largest;
      }
      EXPECT_LE(widest(rest), 1.001 * off + 1e-9 * large) << "level " << level << " and " << further;
      if (decay.links > 0) times[1] += decay.larger ? ratio - 1 : 1;
      if (decay.larger) times.back() = (times.back() + 1) * ratio - 1;
    }
  }
}

using oracle::Quad;

// What grows fastest under a step, but for constants, in some 30 digits: its row and column, by powers.
struct FastestPair {
  std::vector<Quad> row, column;
};
FastestPair fastest_pair(const std::vector<Quad>& a) {
  const auto n = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(a.size()))));
  // Without constants: they come with one row, whichever is taken off.
  std::vector<Quad> power = a;
  for (std::size_t r = 0; r < n; ++r) {
    for (std::size_t c = 0; c < n; ++c) power[r * n + c] -= a[c];
  }
  for (int i = 0; i < 14; ++i) {
    std::vector<Quad> square(n * n, 0);
    Quad largest = 0;
    for (std::size_t r = 0; r < n; ++r) {
      for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t c = 0; c < n; ++c) square[r * n + c] += power[r * n + k] * power[k * n + c];
      }
      for (std::size_t c = 0; c < n; ++c)
        largest = std::max(largest, square[r * n + c] < 0 ? -square[r * n + c] : square[r * n + c]);
    }
    for (Quad& x : square) x /= largest;
    power = std::move(square);
  }
  const auto at = static_cast<std::size_t>(
      std::max_element(power.begin(), power.end(), [](Quad x, Quad y) { return x * x < y * y; }) -
      power.begin());
  FastestPair pair;
  Quad product = 0;
  for (std::size_t i = 0; i < n; ++i) {
    pair.row.push_back(power[at / n * n + i]);
    pair.column.push_back(power[i * n + at % n]);
    product += pair.row[i] * pair.column[i];
  }
  for (Quad& x : pair.column) x /= product;
  return pair;
}

// The fastest ones, each without those before.
std::vector<FastestPair> fastest_pairs(const Stencils& step, std::size_t count) {
  const std::size_t n = step.row_count();
  std::vector<Quad> a(n * n, 0);
  for (std::size_t r = 0; r < n; ++r) {
    const Stencils::Row row = step.row(r);
    for (std::size_t i = 0; i < row.sources.size(); ++i) a[r * n + row.sources[i]] += row.weights[i];
  }
  std::vector<FastestPair> pairs;
  while (pairs.size() < count) {
    const FastestPair& pair = pairs.emplace_back(fastest_pair(a));
    std::vector<Quad> image(n, 0);
    for (std::size_t r = 0; r < n; ++r) {
      for (std::size_t c = 0; c < n; ++c) image[r] += a[r * n + c] * pair.column[c];
    }
    for (std::size_t r = 0; r < n; ++r) {
      for (std::size_t c = 0; c < n; ++c) a[r * n + c] -= image[r] * pair.row[c];
    }
  }
  return pairs;
}

Quad extent_of(const std::vector<Quad>& x) {
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  return (*high - *low) / 2;
}

// Levels against exact ones: from values that are off, the more so to what the largest row sees, by one amount or hardly at all.
void expect_levels_hold(const RingDecay& decay, std::mt19937_64& random) {
  const Stencils step = decay.kind->children()[decay.corner].stencils();
  const std::size_t n = step.row_count();
  if (n > 24) return;
  const std::vector<FastestPair> pairs =
      fastest_pairs(step, (decay.larger ? 1U : 0U) + (decay.spike_row.empty() ? 0U : 1U));
  for (const double amount : {0.0, 0x1p-40}) {
    for (int trial = 0; trial < 4; ++trial) {
      std::vector<Quad> exact(n);
      for (Quad& x : exact) x = unit(random);
      // Weights in doubles have not quite the sum 1: constants would leak into the rest.
      const auto take_off = [&] {
        const auto [low, high] = std::minmax_element(exact.begin(), exact.end());
        const Quad middle_of_all = (*low + *high) / 2;
        for (Quad& x : exact) x -= middle_of_all;
        for (const FastestPair& pair : pairs) {
          Quad seen = 0;
          for (std::size_t i = 0; i < n; ++i) seen += pair.row[i] * exact[i];
          for (std::size_t i = 0; i < n; ++i) exact[i] -= seen * pair.column[i];
        }
      };
      take_off();
      std::vector<double> values(n);
      std::vector<Quad> off(n);
      for (std::size_t i = 0; i < n; ++i) {
        const bool up = trial < 2 && trial < static_cast<int>(pairs.size())
                            ? pairs[static_cast<std::size_t>(trial)].row[i] > 0
                            : random() % 2 == 0;
        values[i] = static_cast<double>(exact[i]) + (up ? amount : -amount);
        off[i] = values[i] - exact[i];
      }
      RingValues rings(decay, step, values, static_cast<double>(extent_of(off)));
      const std::size_t count = std::min<std::size_t>(rings.count(), 150);
      rings.descend_to(count);
      for (std::size_t level = 0; level < count; ++level) {
        const RingValues::Level& own = rings.level(level);
        for (std::size_t i = 0; i < n; ++i) off[i] = own.values[i] - exact[i];
        EXPECT_LE(static_cast<double>(extent_of(off)), own.off) << "level " << level << ", trial " << trial;
        if (amount == 0) {
          EXPECT_LT(own.off, 1e-8 * std::max(own.largest, 1.0)) << "level " << level;
        }
        std::vector<Quad> next(n, 0);
        for (std::size_t r = 0; r < n; ++r) {
          const Stencils::Row row = step.row(r);
          for (std::size_t i = 0; i < row.sources.size(); ++i)
            next[r] += row.weights[i] * exact[row.sources[i]];
          next[r] /= middle(decay.least);
        }
        exact = std::move(next);
        take_off();
      }
      if (::testing::Test::HasFailure()) return;
    }
  }
}

KindKey key_of(Scheme scheme) {
  const SchemeRules& rules = rules_of(scheme);
  KindKey key;
  key.scheme = scheme;
  for (std::size_t k = 0; k < rules.corners; ++k) {
    key.corners[k] = {0, static_cast<std::uint16_t>((rules.triangular() ? 6 : 4) - 1), true, false, false};
  }
  return key;
}

// Kinds of triangles are turned to the least key.
const Kind& turned_kind(KindCache& kinds, KindKey key) {
  if (rules_of(key.scheme).triangular()) {
    std::array<KindKey, 3> keys{key, key, key};
    for (std::size_t turn = 1; turn < 3; ++turn) {
      for (std::size_t k = 0; k < 3; ++k) keys[turn].corners[k] = key.corners[(k + turn) % 3];
    }
    key = *std::min_element(keys.begin(), keys.end(),
                            [](const KindKey& a, const KindKey& b) { return a.corners < b.corners; });
  }
  return kinds.find(key);
}

TEST(corner_rings, holds_all_levels_inside) {
  std::mt19937_64 random(1);
  KindCache kinds;
  std::size_t found = 0;
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark, Scheme::doo_sabin}) {
    for (std::uint16_t valence = 3; valence <= 24; ++valence) {
      KindKey key = key_of(scheme);
      key.corners[0].after = static_cast<std::uint16_t>(valence - 1);
      const Kind& kind = turned_kind(kinds, key);
      if (kind.polynomial()) continue;
      const CharacteristicMap* limit = asymptotics_of(kind).characteristic_map();
      if (limit == nullptr) continue;
      ++found;
      EXPECT_TRUE(limit->conformal());
      for (int i = 0; i < 5; ++i) expect_holds(limit->decay(), random);
      expect_levels_hold(limit->decay(), random);
    }
  }
  RecordProperty("kinds", static_cast<int>(found));
  EXPECT_GE(found, 20U);
}

// At boundaries and creases: all places of all numbers of faces that have a tangent plane and two eigenvalues
// that nothing else reaches; none of the others.
TEST(corner_rings, holds_all_levels_at_boundaries) {
  std::mt19937_64 random(2);
  KindCache kinds;
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark}) {
    const bool loop = scheme == Scheme::loop;
    for (std::uint16_t faces = 1; faces <= 12; ++faces) {
      for (std::uint16_t before = 0; before < faces; ++before) {
        KindKey key = key_of(scheme);
        const auto after = static_cast<std::uint16_t>(faces - 1 - before);
        key.corners[0] = {before, after, false, false, false};
        // Its first and last face have the border as an edge, and another corner on it.
        const std::size_t last = loop ? 2 : 3;
        const auto regular = static_cast<std::uint16_t>(loop ? 2 : 1);
        if (before == 0) key.corners[1] = {regular, 0, false, false, false};
        if (after == 0) key.corners[last] = {0, regular, false, false, false};
        const Kind& kind = turned_kind(kinds, key);
        if (kind.polynomial()) continue;
        const CharacteristicMap* limit = asymptotics_of(kind).characteristic_map();
        const bool wanted = loop ? faces <= 5 : faces == 3;
        EXPECT_EQ(limit != nullptr, wanted)
            << name_of(scheme) << " " << faces << " faces, " << before << " before";
        if (limit == nullptr) continue;
        EXPECT_FALSE(limit->conformal());
        EXPECT_EQ(limit->dominant(), faces < 3 ? 0U : 1U);
        for (int i = 0; i < 5; ++i) expect_holds(limit->decay(), random);
        expect_levels_hold(limit->decay(), random);
      }
    }
  }
}

// Vertex 0 of n faces, three rings more around it; `edges` of the spokes are sharp, from it outwards. On the border: half of a turn.
ControlMesh fan(std::uint32_t n, bool triangles, bool border, std::uint32_t edges, bool corner = false) {
  ControlMesh mesh;
  mesh.points.push_back({0, 0, 0});
  const std::uint32_t steps = triangles ? n : 2 * n, around = border ? steps + 1 : steps;
  const auto next = [&](std::uint32_t i) { return border ? i + 1 : (i + 1) % steps; };
  const auto add = [&](std::initializer_list<std::uint32_t> corners) {
    mesh.add_face(std::vector<VertexId>(corners.begin(), corners.end()));
  };
  constexpr std::uint32_t rings = 4;
  for (std::uint32_t ring = 0; ring < rings; ++ring) {
    for (std::uint32_t i = 0; i < around; ++i) {
      const double angle = std::numbers::pi * (border ? 1 : 2) * i / steps;
      mesh.points.push_back({(ring + 1) * std::cos(angle), (ring + 1) * std::sin(angle), 0});
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    if (triangles) {
      add({0, 1 + i, 1 + next(i)});
    } else {
      add({0, 1 + 2 * i, 2 + 2 * i, 1 + next(2 * i + 1)});
    }
  }
  for (std::uint32_t ring = 0; ring + 1 < rings; ++ring) {
    for (std::uint32_t i = 0; i < steps; ++i) {
      const std::uint32_t a = 1 + ring * around + i, b = 1 + ring * around + next(i);
      if (triangles) {
        add({a, a + around, b + around});
        add({a, b + around, b});
      } else {
        add({a, a + around, b + around, b});
      }
    }
  }
  for (std::uint32_t e = 0; e < edges; ++e) {
    const std::uint32_t first = 1 + e * (triangles ? 1 : 2);
    for (std::uint32_t ring = 0; ring < rings; ++ring) {
      const std::uint32_t here = first + ring * around;
      mesh.tags.creases.push_back({VertexId(ring == 0 ? 0 : here - around), VertexId(here), 10});
    }
  }
  if (corner) mesh.tags.corners.push_back({VertexId(0), 10});
  return mesh;
}

// All kinds at vertex 0 that are found to come again, after some levels.
std::size_t expect_all_hold(const ControlMesh& mesh, Scheme scheme, std::mt19937_64& random,
                            bool spike = false) {
  const LimitSurface surface(mesh, {.scheme = scheme}, std::make_shared<BoundsCache>());
  std::set<const Kind*> seen;
  for (std::uint32_t p = 0; p < surface.patch_count(); ++p) {
    Patch patch = surface.patch(PatchId(p));
    for (int level = 0; level < 3; ++level) patch = split(patch, 0);
    if (patch.kind->polynomial() || !seen.insert(patch.kind).second) continue;
    const CornerAsymptotics& own = asymptotics_of(*patch.kind);
    const RingDecay* decay = spike ? own.spike_decay() : own.ring_decay();
    SCOPED_TRACE(std::string(name_of(scheme)) + " patch " + std::to_string(p));
    if (decay == nullptr) {
      seen.erase(patch.kind);
      continue;
    }
    for (int i = 0; i < 5; ++i) expect_holds(*decay, random);
    expect_levels_hold(*decay, random);
  }
  return seen.size();
}

// Where the rows are found, not derived: darts, sharp corners of two faces and more, wide fans on borders, one quad, and Midedge at
// triangles.
TEST(corner_rings, holds_all_levels_by_rows_that_are_found) {
  std::mt19937_64 random(3);
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark}) {
    for (std::uint32_t n = 3; n <= 12; ++n) {
      EXPECT_GT(expect_all_hold(fan(n, scheme == Scheme::loop, false, 1), scheme, random), 2U)
          << name_of(scheme) << " dart of " << n;
    }
    const bool triangles = scheme == Scheme::loop;
    for (std::uint32_t n = 2; n <= 13; ++n) {
      EXPECT_GT(expect_all_hold(fan(n, triangles, true, 0, true), scheme, random), 0U)
          << name_of(scheme) << " corner of " << n;
    }
    for (const std::uint32_t n : {1U, 4U, 5U, 6U, 7U, 8U, 9U, 13U}) {
      if (triangles ? n > 4 : n > 3 || n == 1) {
        EXPECT_GT(expect_all_hold(fan(n, triangles, true, 0), scheme, random), 0U)
            << name_of(scheme) << " border of " << n;
      }
    }
  }
  ControlMesh octahedron;
  octahedron.points = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (std::uint32_t i = 0; i < 4; ++i) {
    const VertexId a(i), b((i + 1) % 4);
    octahedron.add_face(std::vector<VertexId>{a, b, VertexId(4)});
    octahedron.add_face(std::vector<VertexId>{b, a, VertexId(5)});
  }
  EXPECT_GT(expect_all_hold(octahedron, Scheme::midedge, random), 0U);
}

// Sharp vertices inside, none or one of whose edges is sharp: values that have nothing of what grows fastest, and such that have.
TEST(corner_rings, holds_all_levels_at_spikes) {
  std::mt19937_64 random(4);
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark}) {
    for (const bool seen_along : {false, true}) {
      for (const std::uint32_t n : {3U, 4U, 5U, 6U, 7U, 8U, 12U, 16U}) {
        EXPECT_GT(expect_all_hold(fan(n, scheme == Scheme::loop, false, 0, true), scheme, random, seen_along),
                  0U)
            << name_of(scheme) << " spike of " << n;
      }
    }
    for (std::uint32_t n = 3; n <= 9; ++n) {
      // Elsewhere two modes are as large as each other, or three of them larger than the edge's own.
      const bool known = scheme == Scheme::loop ? n > 3 && n < 9 : n < 6;
      const std::size_t found =
          expect_all_hold(fan(n, scheme == Scheme::loop, false, 1, true), scheme, random, true);
      EXPECT_TRUE(!known || found > 0) << name_of(scheme) << " spike with a sharp edge, of " << n;
    }
  }
}

// The least value beside the corner, over the largest one of its ring: of corners and middles of pieces, ring by ring.
double least_beside(Patch patch, unsigned corner, int rings) {
  double least = INFINITY;
  for (int ring = 0; ring < rings; ++ring) {
    const double at_corner = limit_corners(patch)[corner].x;
    patch.largest = 0;
    for (Vector3& p : patch.points) {
      p.x -= at_corner;
      patch.largest = std::max(patch.largest, std::fabs(p.x));
    }
    for (Vector3& p : patch.points) p.x /= patch.largest;
    patch.largest = 1;
    patch.path = {};
    for (unsigned child = 0; child < 4; ++child) {
      if (child == corner) continue;
      const Patch piece = split(patch, child);
      for (unsigned part = 0; part < 4; ++part) {
        for (const Vector3& p : limit_corners(split(piece, part))) least = std::min(least, p.x);
      }
    }
    patch = split(patch, corner);
  }
  return least;
}

// Corners of borders, and of sharp edges inside: values that are positive in most of them, from wholly to hardly, and grow either way.
TEST(corner_side, values_that_are_positive_but_at_a_corner_are_so) {
  std::mt19937_64 random(5);
  int positive = 0, not_so = 0, missed = 0;
  const auto cache = std::make_shared<BoundsCache>();
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark, Scheme::bilinear}) {
    for (std::uint32_t n = 1; n <= 9; ++n) {
      for (const std::uint32_t edges : {0U, 2U, 3U}) {
        // A pair of each.
        if ((edges > 0 && n < std::max(edges, 3U)) || (n + edges + (scheme == Scheme::loop)) % 2 == 0)
          continue;
        const LimitSurface surface(fan(n, scheme == Scheme::loop, edges == 0, edges, true),
                                   {.scheme = scheme}, cache);
        for (std::uint32_t p = 0; p < surface.patch_count(); ++p) {
          Patch patch = surface.patch(PatchId(p));
          unsigned corner = 3;
          for (unsigned k = 0; k < 3; ++k) {
            const Vector3 at = limit_corners(patch)[k];
            if (max_abs(patch.origin + at - Point3{}) < 1e-12) corner = k;
          }
          if (corner == 3) continue;
          const Stencils::Row vertex = patch.kind->corner_limits().row(patch.to_kind(corner));
          ASSERT_EQ(vertex.sources.size(), 1U);
          for (int trial = 0; trial < 5; ++trial) {
            // Down to where values are at the corner's height.
            const double shift = std::array{0.0, 0.3, 0.6, 0.9}[static_cast<std::size_t>(trial % 4)];
            const Vector3 along{unit(random), unit(random), 0};
            const bool plane = trial % 3 == 0;
            for (std::size_t i = 0; i < patch.points.size(); ++i) {
              const Vector3 old = surface.patch(PatchId(p)).points[i] + (patch.origin - Point3{});
              const double own = 0.5 * (unit(random) + 1) - 0.3 * shift;
              patch.points[i] = {i == vertex.sources[0] ? 0.0
                                 : plane                ? dot(along, old) + 0.3 * unit(random)
                                                        : own,
                                 0, 0};
            }
            patch.largest = 0;
            for (const Vector3& q : patch.points) patch.largest = std::max(patch.largest, std::fabs(q.x));
            patch.error = 1e-15;
            const double least = least_beside(patch, corner, 200);
            const bool proved = certainly_positive_but_at_corner(patch, corner);
            EXPECT_FALSE(proved && least < -1e-9)
                << name_of(scheme) << " of " << n << ", " << edges << " sharp edges, patch " << p
                << ", trial " << trial << ": " << least;
            positive += proved ? 1 : 0;
            not_so += least < -1e-9 ? 1 : 0;
            missed += !proved && least > 1e-3 ? 1 : 0;
          }
        }
      }
    }
  }
  std::printf("positive %d, not so %d, missed %d\n", positive, not_so, missed);
  EXPECT_GT(positive, 400);
  EXPECT_GT(not_so, 250);
  EXPECT_LT(10 * missed, positive);
}

// Numbers that are whole multiples of 2^-12 are taken for exact ones. So no weight that is not rational may look so: those of Loop's
// vertices, of all valences but 3, 4 and 6; rational ones have small denominators.
TEST(corner_rings, takes_no_irrational_weight_for_an_exact_one) {
  for (int n = 5; n <= 1000; ++n) {
    if (n == 6) continue;
    const double c = 3 + 2 * std::cos(2 * std::numbers::pi / n);
    const double a = 0.625 - c * c / 64;
    for (const double weight : {a, 1 - a, a / n}) {
      const double by = 4096 * weight;
      EXPECT_GT(std::fabs(by - std::round(by)), 1e-10) << n;
    }
  }
}

}  // namespace
}  // namespace snug::corner_rings_test
