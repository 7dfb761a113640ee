#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <snug/bounds/bounding_points.h>
#include <snug/bounds/bounds_cache.h>
#include <snug/bounds/enclosure.h>
#include <snug/bounds/kind_slots.h>

/// How patches are bounded in the experiments: as in the library, or by tables of the layout that lost.
namespace snug {

enum class BoundSource : std::uint8_t {
  rows,            ///< bounding rows
  ngon,            ///< the library's tables: the dissertation's layout, spokes of equal length and angle
  characteristic,  ///< tables over the control net of the characteristic map
};
inline constexpr std::array all_bound_sources{BoundSource::rows, BoundSource::ngon,
                                              BoundSource::characteristic};

/// The control net of the characteristic map of a Loop kind inside the mesh with at most one extraordinary
/// corner: under subdivision towards that corner it shrinks by the subdominant eigenvalue. Other kinds:
/// make_layout().
///
/// Cost:      some 200 products with the stencils of a child.
/// Source:    [Reif95]; derivations/tables.md.
[[nodiscard]] std::vector<LayoutPoint> characteristic_layout(const Kind& kind);

/// Tables of both layouts for the kinds of a library, each made once. Thread-safe.
class LayoutTables {
 public:
  /// Requires:  the library outlives this.
  explicit LayoutTables(BoundsCache& library) : library_(library) {}

  [[nodiscard]] BoundsCache& library() { return library_; }
  /// Errors:    SNUG_EXPECT for BoundSource::rows.
  [[nodiscard]] const BoundTable& get(const Kind& kind, BoundSource source);
  /// The offset triangle of a patch, by any source.
  [[nodiscard]] OffsetTriangle offset(const Patch& patch, BoundSource source, BoundingPoints& scratch);

 private:
  BoundsCache& library_;
  KindSlots<BoundTable> characteristic_;
};

}  // namespace snug
