#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <snug/patch/patch.h>
#include <snug/shape/point2.h>
#include <snug/shape/ring_decay.h>

namespace snug {

/// One value of the nets at an extraordinary corner, level after level: over powers of about the least eigenvalue, and moved.
/// Source:    derivations/self_contact.md, "All rings at once".
class RingValues {
 public:
  /// Of the kind's control points, each off by `error` at most. `without_largest`: the exact values have nothing of the larger eigenvalue.
  RingValues(const RingDecay& decay, const Stencils& step, std::vector<double> values, double error,
             bool without_largest);
  /// The values of a level, or differences of them; what the exact ones are off, in extents.
  struct Level {
    std::vector<double> values;
    double off = 0, largest = 0;
  };
  [[nodiscard]] const Level& level(std::size_t level) const { return levels_[level]; }
  /// From a level to the next one; of a higher order, from such a step to the next one.
  [[nodiscard]] Level difference(std::size_t level, unsigned order) const;
  /// How many levels it is of use to look at; at least one.
  [[nodiscard]] std::size_t count() const { return further_.size() - 1; }
  /// Makes levels known up to so many.
  void descend_to(std::size_t count);
  /// What all further levels add, in extents: to a level's values, to the growth of a chain, and to that of the larger eigenvalue.
  struct Sums {
    double net = 0, chain = 0, largest = 0;
  };
  [[nodiscard]] const Sums& further(std::size_t level) const {
    return further_[level < count() ? level : count()];
  }

 private:
  void descend();
  [[nodiscard]] double take_off_largest(Level& level);
  struct Lasting {
    double extent, off;
  };
  [[nodiscard]] Lasting lasting(std::size_t level);
  [[nodiscard]] Level step_between(const Level& from, const Level& to) const;
  void add_up(std::vector<double> parts);

  const RingDecay* decay_;
  const Stencils* step_;
  bool larger_, without_largest_;  // do they have a larger part; or is there none, where others have it?
  double least_off_ = 0;           // of that eigenvalue, relative to it
  std::vector<Level> levels_;
  Level next_;
  double all_off_ = 0, growing_off_ = 0;  // sums of what each step was off, as it is and grown
  double largest_off_ = 0;                // of a level, what the largest row may see
  std::vector<Sums> further_;             // of each level, and, last, of those beyond
};

/// The nets of control values (x, y, 0) at an extraordinary corner, level after level, moved, along axes that suit them.
///
/// Requires:  values of the kind's control points, in x and y.
/// Source:    derivations/self_contact.md, "All rings at once".
class CornerRings {
 public:
  CornerRings(const RingDecay& decay, const Patch& values);
  /// How many levels it is of use to look at; at least one.
  [[nodiscard]] std::size_t count() const { return count_; }
  /// What the coordinates of a level's nets are of values: dot products with these, up to `axis_off` in each number, over a positive
  /// factor. They turn left.
  [[nodiscard]] std::array<Point2, 2> axes(std::size_t level) const;
  [[nodiscard]] double axis_off() const { return axis_off_; }  ///< relative to the axis
  /// The net of one level.
  [[nodiscard]] Patch net(std::size_t level) const;
  /// Each net of a level and of all further ones, along that level's axes and over a positive factor, is the first of these plus c times
  /// each other one, its growth, up to their errors, for some c >= 0. Growths are the same for all, and of one row are one net of
  /// numbers times one vector. Of two the first one is that of a chain, whose c is at most 1 more than the other one's.
  [[nodiscard]] std::vector<Patch> all_further(std::size_t level) const;

 private:
  [[nodiscard]] Patch net_of(std::size_t level, unsigned order, double RingValues::Sums::*sum) const;

  const RingDecay* decay_;
  Stencils step_;
  std::uint8_t first_;
  std::array<Point2, 2> axes_{{{1, 0}, {0, 1}}};
  double axis_off_ = 0;
  bool apart_ = false;              // does the first one have nothing of the larger eigenvalue?
  std::vector<RingValues> values_;  // along these
  std::size_t count_ = 0;
};

}  // namespace snug
