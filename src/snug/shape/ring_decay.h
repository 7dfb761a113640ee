#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <snug/geometry/interval.h>
#include <snug/patch/patch.h>

namespace snug {

class CharacteristicMap;

/// How the nets at an extraordinary corner change from level to level: W A = L W for the step A and some rows W, those of the two limit
/// tangents or others, and what W does not see shrinks faster, in extents (largest - least) / 2.
/// Source:    derivations/self_contact.md, "At extraordinary corners".
struct RingDecay {
  const Kind* kind;
  std::size_t corner;  ///< of the kind
  Interval least;      ///< the least eigenvalue of L
  Interval ratio{1};   ///< of the largest one to it
  enum class Growth : std::uint8_t { none, of_one, of_some };
  Growth growth = Growth::none;  ///< beside powers of the least one: of one row of W, or more
  /// Of what W does not see, over powers of the least eigenvalue: at most `most` times as large, and `factor` after `period` steps.
  std::size_t period = 1;
  double factor = 1, most = 1;
  double seen = 0;  ///< of all that W sees: at most so many times as large, times powers of the ratio
};

/// That of limit tangents, if there is a map, else of the rows that last; none where neither is found.
[[nodiscard]] std::optional<RingDecay> make_ring_decay(const Kind& kind, const CharacteristicMap* map);

}  // namespace snug
