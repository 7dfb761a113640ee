#pragma once

#include <array>

#include <snug/search/workspace.h>

namespace snug {

/// The power of two that brings both placed surfaces to about 1.
[[nodiscard]] PowerOfTwo joint_scale(const PlacedBvh& a, const PlacedBvh& b);
/// How a surface is placed, in units of which one mesh unit is `world` many.
[[nodiscard]] PlacedFrame frame_of(const PlacedBvh& placed, PowerOfTwo world);

/// Two placed surfaces as one query sees them. Lengths are in units of its own, powers of two away from mesh units, in which
/// both are at most about 2 large and far.
class PairFrames {
 public:
  /// Errors:    InputError (value) unless each has a workspace of its own.
  PairFrames(const PlacedBvh& a, const PlacedBvh& b);

  /// From mesh units; a lower bound and an upper bound of the exact length.
  [[nodiscard]] double length_down(double mesh_units) const;
  [[nodiscard]] double length_up(double mesh_units) const;
  [[nodiscard]] PowerOfTwo to_mesh_units() const { return world_.inverse(); }

  [[nodiscard]] SurfaceWorkspace& workspace(std::size_t side) const { return *workspace_[side]; }
  [[nodiscard]] const PlacedFrame& frame(std::size_t side) const { return frame_[side]; }
  /// How the other side is seen from the frame of `side`; made on first use.
  [[nodiscard]] const View& view(std::size_t side) {
    if (!viewed_[side]) {
      view_[side] = View(frame_[side], frame_[1 - side]);
      viewed_[side] = true;
    }
    return view_[side];
  }
  /// Gaps are looked for along this direction, of length 1, first, from A to B: one that holds much of both apart.
  void look_along(const Vector3& direction);

 private:
  std::array<SurfaceWorkspace*, 2> workspace_;
  PowerOfTwo world_;
  std::array<PlacedFrame, 2> frame_;
  std::array<View, 2> view_;
  std::array<bool, 2> viewed_{};
};

}  // namespace snug
