#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <snug/bounds/enclosure.h>
#include <snug/bounds/rows_kernel.h>
#include <snug/surface.h>
#include <snug/surface/limit_surface.h>
#include <support/lazy.h>

namespace snug {

/// PatchBounds of bound.h, of all patches of a surface or of some.
/// Requires:  the surface outlives the bounds.
class BatchBounds {
 public:
  /// Makes what the kinds of the surface need: their rows, or their tables.
  explicit BatchBounds(const LimitSurface& surface, BoundMethod method = BoundMethod::rows, int threads = 0);
  /// In any order. InputError (value) for a patch that is not there.
  BatchBounds(const LimitSurface& surface, std::vector<PatchId> patches,
              BoundMethod method = BoundMethod::rows, int threads = 0);

  [[nodiscard]] std::span<const PatchId> patches() const { return patches_; }
  void update(std::span<const Point3> points, std::span<OffsetTriangle> out, int threads = 1);

 private:
  // Patches of one kind, in the order of patches_. A polygon's are apart, part by part: their control points
  // are those of the polygon.
  struct Group {
    const Kind* kind;
    const Kind* polygon;  // none: from control points
    std::uint32_t part;
    const BoundTable* table;                                          // none: from rows
    std::size_t first_place, first_control;                           // in places_ and control_
    std::optional<kernels::RowsWithTips<float>> rows;                 // none: another way
    std::unique_ptr<Lazy<kernels::RowsWithTips<double>>> exact_rows;  // for patches that need more digits
  };
  // Patches [begin, end) of places_, all of one group: what one thread does at once.
  struct Chunk {
    std::uint32_t group, begin, end;
  };
  // Where in patches_ and in the answer, and the corner that the kind calls 0.
  struct Place {
    std::uint32_t position;
    std::uint8_t first;
  };
  [[nodiscard]] static std::size_t control_count(const Group& group);
  void sort_by_kind(const LimitSurface& surface);
  void collect_control(const LimitSurface& surface);
  void fit_by_rows(const Group& group, std::span<const VertexId> control,
                   std::span<OffsetTriangle> answers) const;
  void fit(const Chunk& chunk, PowerOfTwo back, std::span<OffsetTriangle> out) const;

  BoundsCache* library_;
  std::vector<PatchId> patches_;
  std::vector<Group> groups_;
  std::vector<Chunk> chunks_;
  std::vector<Place> places_;
  std::vector<VertexId> control_;
  std::vector<VertexId> unused_;  // vertices that are not in control_
  std::vector<Point3> scaled_;
};

}  // namespace snug
