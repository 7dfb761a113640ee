#pragma once

#include <cstddef>
#include <optional>

#include <experiments/rooms.h>
#include <snug/query/closest.h>
#include <snug/query/pair_queries.h>
#include <snug/search/piece_cache.h>

namespace snug::bench {

/// Two surfaces ready for queries on one thread. All calls of queries in bench/ are in here.
class Queries {
 public:
  Queries(const LimitSurface& a, const LimitSurface& b, const SurfaceBvhOptions& options = {});

  [[nodiscard]] Collision collide(const PosePair& at, double tolerance, double margin = 0,
                                  WitnessKind witness = WitnessKind::exact);
  /// Do the limit surfaces meet? Nothing where neither is certain.
  [[nodiscard]] std::optional<bool> meet(const PosePair& at);
  /// With upper - lower at most `precision`.
  [[nodiscard]] Distance distance(const PosePair& at, double precision);
  /// Models and scratch, without the surfaces.
  [[nodiscard]] std::size_t bytes() const;
  /// Scratch alone.
  void forget() { scratch_a_.renew(a_), scratch_b_.renew(b_); }
  [[nodiscard]] std::size_t scratch_bytes() const { return scratch_a_.bytes() + scratch_b_.bytes(); }

 private:
  SurfaceBvh a_, b_;
  PieceCache scratch_a_, scratch_b_;
};

/// A surface ready for points on one thread.
class PointQueries {
 public:
  explicit PointQueries(const LimitSurface& surface, const SurfaceBvhOptions& options = {});

  /// With upper - lower at most `precision`.
  [[nodiscard]] ClosestPoint closest(const Point3& to, double precision,
                                     WitnessKind witness = WitnessKind::exact);

 private:
  SurfaceBvh model_;
  PieceCache scratch_;
};

/// Work of queries, in all.
class Work {
 public:
  void add(const SearchStats& stats);
  /// Prints "# name, a query: ... box tests, ... triangle tests, ... evaluations, ... splits".
  void print(const char* name) const;

 private:
  double queries_ = 0, box_tests_ = 0, triangle_tests_ = 0, evaluations_ = 0, splits_ = 0;
};

}  // namespace snug::bench
