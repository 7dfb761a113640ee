#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <snug/shape/ring_decay.h>

namespace snug {

/// The nets of control values (x, y, 0) at an extraordinary corner, level after level, moved and scaled: each level by a positive
/// number.
///
/// Requires:  values of the kind's control points, in x and y.
/// Source:    derivations/self_contact.md, "All rings at once".
class CornerRings {
 public:
  CornerRings(const RingDecay& decay, const Patch& values);
  /// How many levels it is of use to look at; at least one.
  [[nodiscard]] std::size_t count() const { return further_.size(); }
  /// The net of one level.
  [[nodiscard]] Patch net(std::size_t level) const;
  /// Each net of a level and of all further ones is `net` and c times `growth`, both up to their errors, for some c >= 0. `growth` is the
  /// same for all; where it is of one row, it is one net of numbers times one vector. None where all eigenvalues are equal, without
  /// chains: then it is `net` up to its error.
  struct Further {
    Patch net;
    std::optional<Patch> growth;
  };
  [[nodiscard]] Further all_further(std::size_t level) const;

 private:
  // The two values over powers of the least eigenvalue, moved; what the exact ones are off, in extents.
  struct Level {
    std::array<std::vector<double>, 2> values;
    double off = 0, largest = 0;
  };
  void descend();
  struct Lasting {
    double extent, off;
  };
  [[nodiscard]] Lasting lasting(std::size_t level) const;
  [[nodiscard]] Patch patch_of(const Level& level) const;
  [[nodiscard]] Level step_of(std::size_t level) const;
  void add_up(std::vector<double> parts);

  const RingDecay* decay_;
  Stencils step_;
  const Patch* values_;
  double least_off_ = 0;  // of that one, relative to it
  std::vector<Level> levels_;
  double all_off_ = 0, growing_off_ = 0;  // sums of what each step was off, as it is and grown
  // Of each level: the extents of what its step and all further ones leave beside `growth`, as sums: plain, for what a net is off, and
  // for what the growth is off.
  struct Sums {
    double once = 0, twice = 0, of_growth = 0;
  };
  std::vector<Sums> further_;
};

}  // namespace snug
