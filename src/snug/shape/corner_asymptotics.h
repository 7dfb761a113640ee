#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <snug/patch/kind_cache.h>
#include <snug/shape/characteristic_map.h>
#include <snug/shape/corner_forms.h>
#include <support/lazy.h>

namespace snug {

/// How patches of a kind behave as they are split again and again at their extraordinary corners. Each part is made
/// on first use, then immutable. Thread-safe.
class CornerAsymptotics {
 public:
  /// Requires:  the kind outlives it.
  explicit CornerAsymptotics(const Kind& kind) : kind_(kind) {}

  /// Null where there is none, see make_characteristic_map().
  [[nodiscard]] const CharacteristicMap* characteristic_map() const;

  /// Null where there is none, see make_ring_decay().
  [[nodiscard]] const RingDecay* ring_decay() const;
  /// Null where there is none, see make_spike_decay().
  [[nodiscard]] const RingDecay* spike_decay() const;

  // Upper bounds by d, the diagonal of the box around the control points, for patches and for whole quads that
  // patches are halves of. Infinite where none is found, which happens to Midedge alone, beside a face of very many
  // corners. Cost: that of the kind's step, and some dense products.
  /// A factor c such that the area is at most c d^2.
  /// Source:    derivations/measures.md, "What is left at a corner".
  [[nodiscard]] double area_factor() const { return factor(areas); }
  /// Nearer bounds than that factor's; null where there are none, see make_corner_forms().
  [[nodiscard]] const CornerForms* forms() const;
  /// A factor c such that the distance of any two points along the surface is at most c d.
  /// Source:    derivations/self_contact.md, "Lengths".
  [[nodiscard]] double length_factor() const { return factor(lengths); }

 private:
  class FactorSearch;
  enum Measure : std::uint8_t { areas, lengths };
  [[nodiscard]] double factor(Measure measure) const;

  const Kind& kind_;
  Lazy<std::optional<CharacteristicMap>> map_;
  Lazy<std::optional<RingDecay>> decay_, spike_;
  Lazy<std::optional<CornerForms>> forms_;
  std::array<Lazy<double>, 2> factors_;  // of each Measure
};

/// That of a kind, kept with it. Thread-safe.
[[nodiscard]] const CornerAsymptotics& asymptotics_of(const Kind& kind);

}  // namespace snug
