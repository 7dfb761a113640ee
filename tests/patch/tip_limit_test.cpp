// What the nets at extraordinary corners tend to, against thirty levels of them.

#include <snug/patch/tip_limit.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace snug {
namespace {

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; }

// A patch of random control values (x, y, 0), or of values without a share of the dominant direction in y.
Patch random_values(const Kind& kind, const TipLimit& limit, std::mt19937_64& random) {
  Patch patch;
  patch.kind = &kind;
  patch.points.resize(kind.control_count());
  for (Vector3& p : patch.points) p = {unit(random), unit(random), 0};
  if (!limit.conformal()) {
    const Stencils::Row row = kind.corner_tangents().row(2 * limit.corner() + limit.dominant());
    double share = 0, square = 0;
    for (std::size_t i = 0; i < row.sources.size(); ++i) {
      share += row.weights[i] * patch.points[row.sources[i]].y;
      square += row.weights[i] * row.weights[i];
    }
    for (std::size_t i = 0; i < row.sources.size(); ++i) {
      patch.points[row.sources[i]].y -= share / square * row.weights[i];
    }
  }
  for (const Vector3& p : patch.points) patch.largest = std::max(patch.largest, max_abs(p));
  patch.error = 1e-15;
  return patch;
}

void expect_holds(const Kind& kind, const TipLimit& limit, std::mt19937_64& random) {
  Patch patch = random_values(kind, limit, random);
  for (int begin = 0; begin < 12; begin += 4) {
    const Patch lasting = limit.lasting(patch);
    Patch at = patch;
    for (int level = 0; level < 18; ++level) {
      double widest = 0;
      for (const Vector3& p : at.points) widest = std::max(widest, max_abs(p - at.points[0]));
      if (!(widest > 1e8 * at.error)) break;  // all is rounding
      // Scaled so that it comes nearest: by least squares of what is left without means.
      for (const bool second : {false, true}) {
        std::vector<double> is, was;
        for (std::size_t i = 0; i < at.points.size(); ++i) {
          is.push_back(second ? at.points[i].y : at.points[i].x);
          was.push_back(second ? lasting.points[i].y : lasting.points[i].x);
        }
        const auto centre = [](std::vector<double>& v) {
          const auto [low, high] = std::minmax_element(v.begin(), v.end());
          const double m = 0.5 * (*low + *high);
          for (double& x : v) x -= m;
        };
        centre(is);
        centre(was);
        double product = 0, square = 0;
        for (std::size_t i = 0; i < is.size(); ++i) {
          product += is[i] * was[i];
          square += is[i] * is[i];
        }
        std::vector<double> rest;
        for (std::size_t i = 0; i < is.size(); ++i) rest.push_back(product / square * is[i] - was[i]);
        const auto [low, high] = std::minmax_element(rest.begin(), rest.end());
        const double best = 0.5 * (*high - *low);
        // Least squares is not what comes nearest in extent, and late levels are mostly rounding.
        EXPECT_LE(best, 2 * lasting.error + 1e-6 * lasting.largest)
            << "level " << begin << " + " << level << (second ? " y" : " x") << ", control points "
            << kind.control_count();
      }
      at = split(at, static_cast<unsigned>((limit.corner() + at.first) % 3));
    }
    for (int k = 0; k < 4; ++k)
      patch = split(patch, static_cast<unsigned>((limit.corner() + patch.first) % 3));
  }
}

TEST(tip_limit, holds_all_levels_inside) {
  std::mt19937_64 random(1);
  KindCache kinds;
  std::size_t found = 0;
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark, Scheme::doo_sabin}) {
    const SchemeRules& rules = rules_of(scheme);
    for (std::uint16_t valence = 3; valence <= 14; ++valence) {
      KindKey key;
      key.scheme = scheme;
      for (std::size_t k = 0; k < rules.corners; ++k) {
        key.corners[k] = {0, static_cast<std::uint16_t>((rules.triangular() ? 6 : 4) - 1), true, false,
                          false};
      }
      key.corners[0].after = static_cast<std::uint16_t>(valence - 1);
      const Kind& kind = kinds.find(key);
      if (kind.polynomial()) continue;
      // Triangular kinds are turned to the least key.
      TipLimits limits;
      const TipLimit* limit = limits.find(kind);
      if (limit == nullptr) continue;
      ++found;
      EXPECT_TRUE(limit->conformal());
      for (int i = 0; i < 5; ++i) expect_holds(kind, *limit, random);
    }
  }
  EXPECT_GE(found, 20U);
}

}  // namespace
}  // namespace snug
