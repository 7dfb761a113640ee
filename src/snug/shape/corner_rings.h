#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <snug/shape/characteristic_map.h>

namespace snug {

/// The nets of control values (x, y, 0) at an extraordinary corner, level after level, moved and scaled: by a
/// positive number for each level, of a map that is not conformal by one for each of the two values.
///
/// Requires:  values of the kind's control points, in x and y. Of a map that is not conformal x belongs to the
///            first tangent and y to the second one: the value that does not belong to the dominant one has no
///            share of it, W x = 0 or W y = 0 for that row, in exact arithmetic.
/// Source:    derivations/self_contact.md, "All rings at once".
class CornerRings {
 public:
  CornerRings(const CharacteristicMap& map, const Patch& values);
  /// How many levels it is of use to look at; at least one.
  [[nodiscard]] std::size_t count() const { return count_; }
  /// The net of one level.
  [[nodiscard]] Patch net(std::size_t level) const;
  /// A net that stands for those of this level and all further ones: they lie within its error.
  [[nodiscard]] Patch all_further(std::size_t level) const;

 private:
  // One value without its part along the tangents' directions, over its eigenvalue's powers. `along` and `fading` bound
  // the exact value less this: its part along V, and the rest of it, as large as the part of level 0 that A makes it of.
  struct Rest {
    std::vector<double> values;
    double extent = 0;
    double along = 0, fading = 0;  // extents
  };
  // One of the two values.
  struct Value {
    std::size_t own = 0;                // the tangent that it belongs to
    std::array<double, 2> m{}, off{};   // W of it, and how far the exact ones are
    std::array<Interval, 2> ratios{};   // of the eigenvalues to its own one
    std::vector<Rest> rests;            // of all levels
    std::vector<double> largest_after;  // extents of the exact rests from a level on
  };
  void decompose(std::size_t c);
  void descend(Value& part) const;
  void remove_directions(Rest& rest) const;
  [[nodiscard]] bool small(const Value& part) const;
  // Points of a value with the shares of its directions, not scaled.
  struct Filled {
    double largest = 0, error = 0;
  };
  [[nodiscard]] Filled fill(std::size_t c, std::size_t level, bool all_further, Patch& net) const;
  [[nodiscard]] Patch made(std::size_t level, bool all_further) const;

  const CharacteristicMap* map_;
  const Patch* values_;
  std::array<Value, 2> parts_;
  std::size_t count_ = 0;
};

}  // namespace snug
