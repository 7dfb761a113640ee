#pragma once

#include <cstddef>
#include <optional>

#include <snug/query/collide.h>
#include <snug/query/rooms.h>

namespace snug::bench {

/// Two surfaces ready for queries on one thread. All calls of queries in bench/ are in here.
class Queries {
 public:
  Queries(const Surface& a, const Surface& b, std::optional<TableLayout> table = {});

  [[nodiscard]] Collision collide(const PlacedPair& at, double tolerance, double margin = 0);
  /// Do the limit surfaces meet? Nothing where neither is certain.
  [[nodiscard]] std::optional<bool> meet(const PlacedPair& at);
  /// Lower and upper bound of the distance, at most `precision` apart.
  struct Interval {
    double lower, upper;
  };
  [[nodiscard]] Interval distance(const PlacedPair& at, double precision);

 private:
  CollisionModel a_, b_;
  CollideScratch scratch_;
};

}  // namespace snug::bench
