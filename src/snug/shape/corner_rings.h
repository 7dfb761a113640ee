#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <snug/patch/patch.h>
#include <snug/shape/point2.h>
#include <snug/shape/ring_decay.h>

namespace snug {

/// One value of the nets at an extraordinary corner, level after level: over powers of about the least eigenvalue, and moved; without what
/// it has of the larger one.
/// Source:    derivations/self_contact.md, "All rings at once".
class RingValues {
 public:
  /// Of the kind's control points, each off by `error` at most; but for errors nothing of larger eigenvalues is in them.
  RingValues(const RingDecay& decay, const Stencils& step, std::vector<double> values, double error);
  /// The values of a level, or differences of them; what the exact ones are off, in extents.
  struct Level {
    std::vector<double> values;
    double off = 0, largest = 0;
  };
  [[nodiscard]] const Level& level(std::size_t level) const { return levels_[level]; }
  /// From a level to the next one; of order 2, from such a step to the next one.
  [[nodiscard]] Level difference(std::size_t level, unsigned order) const;
  /// How many levels it is of use to look at; at least one.
  [[nodiscard]] std::size_t count() const { return further_.size() - 1; }
  /// Makes levels known up to so many.
  void descend_to(std::size_t count);
  /// Sums over all further levels, in extents: added to a level's values, and to the growth of a chain.
  struct Sums {
    double net = 0, chain = 0;
  };
  [[nodiscard]] const Sums& further(std::size_t level) const {
    return further_[level < count() ? level : count()];
  }
  /// Bound of the sum of the next `steps` levels, where nothing grows. Requires that they are among count().
  [[nodiscard]] double next(std::size_t level, std::size_t steps) const;

 private:
  void descend();
  [[nodiscard]] double take_off_larger(Level& level);
  void difference(std::size_t level, unsigned order, Level& step) const;
  void step_between(const Level& from, const Level& to, Level& step) const;
  [[nodiscard]] double off_of(std::size_t level) const;
  void add_up(std::vector<double> parts);

  const RingDecay* decay_;
  const Stencils* step_;
  double least_off_ = 0;  // of that eigenvalue, relative to it
  double rounding_ = 0;   // of a step, of values of size 1
  std::vector<Level> levels_;
  double all_off_ = 0;         // the sum of what each step was off
  double larger_off_ = 0;      // of a level, what larger rows may see
  std::vector<double> parts_;  // what each level adds
  std::vector<Sums> further_;  // of each level, and, last, of those beyond
};

/// The nets of control values (x, y, 0) at an extraordinary corner, level after level, moved, along axes that suit them.
///
/// Requires:  values of the kind's control points, in x and y; where there is a spike: but for errors nothing of it is in them.
/// Source:    derivations/self_contact.md, "All rings at once".
class CornerRings {
 public:
  CornerRings(const RingDecay& decay, const Patch& values);
  /// How many levels it is of use to look at; at least one.
  [[nodiscard]] std::size_t count() const { return count_; }
  /// The axes of a level's nets: coordinates are dot products of values with these, up to `axis_off` in each number, over a positive
  /// factor. They turn left.
  [[nodiscard]] std::array<Point2, 2> axes(std::size_t level) const;
  [[nodiscard]] double axis_off() const { return axis_off_; }  ///< relative to the axis
  /// The net of one level, or of so many from there on, up to its error: of `rings_at_once(level)` at most.
  [[nodiscard]] Patch net(std::size_t level, std::size_t rings = 1) const;
  /// 1 where nets grow.
  [[nodiscard]] std::size_t rings_at_once(std::size_t level) const;
  /// Each net of a level and of all further ones, along that level's axes and over a positive factor, is the first of these plus c times
  /// each other one, its growth, up to their errors, for some c >= 0. Growths are the same for all, and of one row are one net of
  /// numbers times one vector. Of two the first one is that of a chain, whose c is at most the other one's.
  [[nodiscard]] std::vector<Patch> all_further(std::size_t level) const;

 private:
  // `added` to the values of the level, or to their difference, along each axis.
  [[nodiscard]] Patch net_of(std::size_t level, unsigned order, bool all_further,
                             std::array<double, 2> added) const;
  [[nodiscard]] std::array<double, 2> further(std::size_t level, double RingValues::Sums::*sum) const;
  [[nodiscard]] double scale(std::size_t level, std::size_t coordinate) const;
  [[nodiscard]] Interval larger_part(std::size_t level) const;

  const RingDecay* decay_;
  Stencils step_;
  std::uint8_t first_;
  bool grows_;  // Is there something of the larger eigenvalue?
  std::array<Point2, 2> axes_{{{1, 0}, {0, 1}}};
  double axis_off_ = 0;
  Interval along_{
      0};  // of the larger eigenvalue's vector, along the second one; the first one has nothing of it
  std::vector<RingValues> values_;  // along these
  std::size_t count_ = 0;
};

}  // namespace snug
