#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <snug/patch/net_kernels.h>
#include <snug/patch/patch.h>

namespace snug {

/// The control points of a patch, or of a piece of it; of half a quad they are those of all of it.
struct ControlNet {
  const Kind* kind = nullptr;
  std::vector<kernels::NetPoint> points;
  double largest = 0;  ///< |coordinate|
  double error = 0;    ///< upper bound, a coordinate, of |point - exact point|
};
[[nodiscard]] ControlNet control_net(const Patch& patch);

/// A regular piece: lattice[i] is where the i-th point of its basis stands among `points`.
struct LatticeNet {
  std::span<const kernels::NetPoint> points;
  std::span<const std::uint32_t> lattice;
  double largest, error;  ///< as in ControlNet
};

/// The points that the basis functions of a polynomial net weight; ghosts are appended to the net.
/// Requires:  net.kind->polynomial().
[[nodiscard]] LatticeNet with_ghosts(ControlNet& net);

/// A net after one step of subdivision: regular quarters, and the nets of others. Quarter k is the one at corner k of a quad, with
/// corners counted as there, or child k of a triangle.
class NetQuarters {
 public:
  /// Requires:  a patch that is not polynomial, and no polygon.
  explicit NetQuarters(const ControlNet& net);

  [[nodiscard]] static constexpr std::size_t count() { return 4; }
  [[nodiscard]] bool regular(std::size_t k) const { return !step_.pieces[k].lattice.empty(); }
  /// Requires:  regular(k).
  [[nodiscard]] LatticeNet lattice(std::size_t k) const {
    return {points_, step_.pieces[k].lattice, largest_, error_};
  }
  [[nodiscard]] ControlNet net(std::size_t k) const;

 private:
  const KindStep& step_;
  std::vector<kernels::NetPoint> points_;
  double largest_ = 0, error_ = 0, plain_error_ = 0;  // the last one of points that are no ghosts
};

}  // namespace snug
