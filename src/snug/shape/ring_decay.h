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
  const Kind* kind = nullptr;
  std::size_t corner = 0;                           ///< of the kind
  Interval least{1};                                ///< the least eigenvalue of L
  bool larger = false;                              ///< a larger one, of one row of W, beside the least one
  Interval ratio{1};                                ///< of that one to the least one
  std::vector<double> largest_row, largest_column;  ///< about that row of W, and that column of V, W V = 1
  std::vector<double> spike_row,
      spike_column;  ///< the same of a third one, the largest, if nets are known to have nothing of it (make_spike_decay)
  double row_error = 0,
         column_off = 0,  ///< of each row, in sum; of a column, in extents, and as what other rows see of it
      spike_off = 0;      ///< of the spike's column
  std::size_t links =
      0;  ///< nets grow as j times the least one's powers, by so many rows of W: a chain (LastingRows)
  /// Of what W does not see, over powers of the least eigenvalue: at most `most` times as large, and `factor` after `period` steps.
  std::size_t period = 1;
  double factor = 1, most = 1;
  double chain_seen =
      0;  ///< of all that W sees in a chain: what is added at each step, at most so many times as large
  double seen = 0;  ///< of all that W sees: at most so many times as large, times powers of the ratio
};

/// That of limit tangents, if there is a map, else of the rows that last; none where neither is found.
[[nodiscard]] std::optional<RingDecay> make_ring_decay(const Kind& kind, const CharacteristicMap* map);

/// At a vertex inside that is sharp by itself, none or one of its edges being sharp: of nets that have nothing of what grows fastest. All
/// faces of the vertex have one direction of that.
/// Source:    derivations/self_contact.md, "Spikes".
[[nodiscard]] std::optional<RingDecay> make_spike_decay(const Kind& kind);

}  // namespace snug
