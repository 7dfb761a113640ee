// Limits of the nets at extraordinary corners, against some twenty levels of them.

#include <snug/shape/corner_asymptotics.h>
#include <snug/shape/corner_rings.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace snug::corner_rings_test {
namespace {

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; }

// Control values (x, y, 0); of limits with two eigenvalues the value that does not belong to the dominant
// tangent has no share of it.
Patch random_values(const Kind& kind, const CharacteristicMap& limit, std::mt19937_64& random) {
  Patch patch;
  patch.kind = &kind;
  patch.points.resize(kind.control_count());
  const double wide = std::exp2(2 * unit(random));
  for (Vector3& p : patch.points) p = {wide * unit(random), unit(random), 0};
  if (!limit.conformal()) {
    const auto value = [&](std::size_t i) -> double& {
      return limit.dominant() == 1 ? patch.points[i].x : patch.points[i].y;
    };
    const Stencils::Row row = kind.corner_tangents().row(2 * limit.corner() + limit.dominant());
    double share = 0, square = 0;
    for (std::size_t i = 0; i < row.sources.size(); ++i) {
      share += row.weights[i] * value(row.sources[i]);
      square += row.weights[i] * row.weights[i];
    }
    for (std::size_t i = 0; i < row.sources.size(); ++i) {
      value(row.sources[i]) -= share / square * row.weights[i];
    }
  }
  for (const Vector3& p : patch.points) patch.largest = std::max(patch.largest, max_abs(p));
  patch.error = 1e-15;
  return patch;
}

// How far one of the values of a net is from another's, scaled and moved so that it comes near, in extent.
double distance(const Patch& is, const Patch& was, bool second) {
  std::vector<double> a, b;
  for (std::size_t i = 0; i < is.points.size(); ++i) {
    a.push_back(second ? is.points[i].y : is.points[i].x);
    b.push_back(second ? was.points[i].y : was.points[i].x);
  }
  const auto centre = [](std::vector<double>& v) {
    const auto [low, high] = std::minmax_element(v.begin(), v.end());
    const double m = 0.5 * (*low + *high);
    for (double& x : v) x -= m;
  };
  centre(a);
  centre(b);
  double product = 0, square = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    product += a[i] * b[i];
    square += a[i] * a[i];
  }
  EXPECT_GT(product, 0);
  for (std::size_t i = 0; i < a.size(); ++i) b[i] -= product / square * a[i];
  const auto [low, high] = std::minmax_element(b.begin(), b.end());
  return 0.5 * (*high - *low);
}

// Approximate ratio of a level's value to the net's.
double factor(const Patch& net, const Patch& level, bool second) {
  const auto width = [&](const Patch& patch) {
    double low = INFINITY, high = -INFINITY;
    for (const Vector3& p : patch.points) {
      low = std::min(low, second ? p.y : p.x);
      high = std::max(high, second ? p.y : p.x);
    }
    return high - low;
  };
  return width(level) / width(net);
}

// Down to where a level is hardly more than rounding.
void expect_holds(const Kind& kind, const CharacteristicMap& limit, std::mt19937_64& random) {
  const Patch values = random_values(kind, limit, random);
  const CornerRings rings(limit, values);
  Patch at = values;
  std::vector<Patch> direct;
  for (std::size_t level = 0; level < rings.count(); ++level) {
    double widest = 0, narrowest = INFINITY;
    for (std::size_t c = 0; c < 2; ++c) {
      double size = 0;
      for (const Vector3& p : at.points) {
        size = std::max(size, std::fabs(c == 0 ? p.x - at.points[0].x : p.y - at.points[0].y));
      }
      widest = std::max(widest, size);
      narrowest = std::min(narrowest, size);
    }
    if (!(narrowest > 1e9 * at.error) || level > 24) break;
    direct.push_back(at);
    at = split(at, static_cast<unsigned>((limit.corner() + at.first) % 3));
  }
  ASSERT_GT(direct.size(), std::min<std::size_t>(rings.count(), 8) - 1);
  for (std::size_t level = 0; level < direct.size(); ++level) {
    const Patch net = rings.net(level), further_net = rings.all_further(level);
    // Turned axes mix both values.
    if (limit.conformal()) {
      EXPECT_NEAR(factor(net, direct[level], false) / factor(net, direct[level], true), 1, 1e-3)
          << "level " << level;
      if (further_net.error < 1e-4 * further_net.largest) {
        EXPECT_NEAR(factor(further_net, direct[level], false) / factor(further_net, direct[level], true), 1,
                    0.05)
            << "level " << level;
      }
    }
    for (const bool second : {false, true}) {
      // Least squares is not what comes nearest in extent, and late levels are mostly rounding.
      EXPECT_LE(distance(direct[level], net, second), 2 * net.error + 1e-6 * net.largest)
          << "level " << level << (second ? " y" : " x");
      for (std::size_t further = level; further < direct.size(); ++further) {
        if (!(further_net.error < 0.2 * further_net.largest)) break;
        EXPECT_LE(distance(direct[further], further_net, second),
                  2 * further_net.error + 1e-6 * further_net.largest)
            << "level " << level << " and " << further << (second ? " y" : " x");
      }
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
      for (int i = 0; i < 5; ++i) expect_holds(kind, *limit, random);
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
        for (int i = 0; i < 5; ++i) expect_holds(kind, *limit, random);
      }
    }
  }
}

}  // namespace
}  // namespace snug::corner_rings_test
