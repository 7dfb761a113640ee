#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <snug/bounds/enclosure.h>
#include <snug/bvh/obb.h>
#include <snug/geometry/motion.h>
#include <snug/surface.h>
#include <snug/surface/limit_surface.h>

namespace snug {

struct LeafOptions {
  double tolerance = 0;  ///< > 0, mesh units: a leaf's radius is at most half of it
  BoundMethod method = BoundMethod::rows;
  /// Split until a piece has at most one extraordinary corner, too: the dissertation has bounds for no
  /// others.
  bool one_extraordinary = false;
};

/// The offset triangles of a surface that is split ahead of all questions, in mesh units.
///
/// Guarantee: every limit point is in one of them, rounding included.
/// Requires:  coordinates of about 1: see unit_model (rooms.h).
/// Errors:    InputError (value) for a tolerance that is not positive, (refused) where it is not reached at
///            the last level.
/// Source:    [Wu05, sec. 5.1.2].
[[nodiscard]] std::vector<OffsetTriangle> leaves(const LimitSurface& surface, const LeafOptions& options,
                                                 const WorkMonitor& monitor = {});

/// The dissertation's hierarchy: all leaves made beforehand, a tree of oriented boxes over them, and its own
/// pair test at two leaves. NOT a bound: kept as an experiment; no query may call it.
///
/// Source:    [Wu05, sec. 5.1.1, 5.1.2], [Gottschalk96]: binary, split along the longest axis at the mean.
class PrintedHierarchy {
 public:
  PrintedHierarchy(const LimitSurface& surface, const LeafOptions& options, const WorkMonitor& monitor = {});

  struct Node {
    Obb box;
    std::uint32_t first_child = 0;  // its two children follow each other, and it; 0 for a leaf
    std::uint32_t leaf = 0;
  };
  [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }
  [[nodiscard]] std::span<const OffsetTriangle> leaves() const { return leaves_; }

  /// Does no pair of leaves stop the descent as printed? `epsilon` is what the pair test adds to the radii.
  ///
  /// Guarantee: none: see printed_test_says_separated.
  /// Requires:  coordinates of at most about 4.
  [[nodiscard]] static bool says_separated(const PrintedHierarchy& a, const Motion& place_a,
                                           const PrintedHierarchy& b, const Motion& place_b, double epsilon);

 private:
  [[nodiscard]] static bool apart(const Node& a, const Motion& place_a, const Node& b, const Motion& place_b,
                                  double epsilon);

  std::vector<OffsetTriangle> leaves_;
  std::vector<Node> nodes_;
};

}  // namespace snug
