#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <snug/patch/evaluate.h>
#include <snug/patch/net_kernels.h>
#include <snug/surface.h>

namespace snug {

/// Limit points of one patch, or of the whole quad that it is half of, at many parameters: nets that were
/// refined for one are kept for the others.
///
/// Parameters are those of the patch where the scheme is triangular. Else they run over the quad, u from its
/// corner 0 to corner 1 and v from there to corner 3, corner 0 being that of the patch.
///
/// Guarantee: as limit_point() and limit_frame(); a result does not depend on earlier ones.
/// Errors:    InputError (value) for a parameter that is not on the patch or quad, NaN included.
/// Cost:      a regular patch: 6 to 12 ns a point, 60 with tangents and normal. Near an extraordinary
///            corner a small sparse product, 100 ns, for each level that is met for the first time.
/// Source:    derivations/rounding.md, "Basis functions".
class LimitEvaluator {
 public:
  LimitEvaluator() = default;
  /// Requires:  patch: no polygon.
  explicit LimitEvaluator(const Patch& patch) { reset(patch); }
  /// Begins anew with another patch; keeps its memory.
  void reset(const Patch& patch);

  // Requires, of the next two: a patch. Owners and corners of parameters do not matter.
  /// Requires:  out.size() == at.size().
  void points(std::span<const Place> at, std::span<BoundedPoint> out);
  /// Its point is relative to origin().
  [[nodiscard]] LimitFrame frame(const Place& at);
  [[nodiscard]] const Point3& origin() const { return origin_; }

  [[nodiscard]] std::size_t bytes() const;

 private:
  // Points from `first` on in points_, of at most `largest` and off by `error` a coordinate.
  struct Net {
    std::uint32_t first = 0;
    double largest = 0, error = 0;
  };
  // The whole patch, or a piece of it that is not regular.
  struct Piece {
    const Kind* kind;
    unsigned level;
    std::uint8_t first;
    Net control;
    const KindStep* step = nullptr;  // once it is refined
    Net refined{};                   // after one step, with ghosts; of a regular patch itself with ghosts
    double plain_error = 0;          // of its points that are no ghosts
    double value_error = 0;          // of limit points in its regular children, or in itself
    std::array<std::uint32_t, 4> children{};
  };
  // Where a parameter lies: in a regular piece, or at a corner of one that is not.
  struct Position;
  // Parameters that go down together.
  struct Batch;

  [[nodiscard]] Position start() const;
  [[nodiscard]] TriangleParameter on_patch(const Place& at) const;
  [[nodiscard]] bool stop_at_corner(Position& place, std::size_t corner) const;
  void enter(Position& place, unsigned quarter);
  void answer(const Position& all, std::array<Batch, 2>& room, std::size_t side, std::size_t begin,
              std::size_t end, std::span<BoundedPoint> out);
  void refine(Piece& piece);
  [[nodiscard]] std::uint32_t make_child(std::uint32_t piece, unsigned child);
  Net add_rows(const Stencils& stencils, const Net& from);
  void add_ghosts(const Stencils& ghosts, const Net& from, Net& to);
  [[nodiscard]] RelativePoint corner_point(const Position& place) const;
  [[nodiscard]] LimitFrame corner_frame(const Position& place) const;
  [[nodiscard]] double regular_error(const Position& place) const;
  [[nodiscard]] LimitFrame regular_frame(const Position& place) const;

  Point3 origin_;
  bool triangular_ = false;
  RegularBasis basis_ = RegularBasis::linear;
  const std::uint32_t* lattice_ = nullptr;  // of a regular patch
  std::vector<Piece> pieces_;
  std::vector<kernels::NetPoint> points_;
};

}  // namespace snug
