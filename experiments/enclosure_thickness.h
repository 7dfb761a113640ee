#pragma once

#include <cstddef>
#include <vector>

#include <experiments/tightness.h>

/// The bounding prism of [Kobbelt98] beside what encloses a patch. An experiment: the prism is no bound.
namespace snug {

/// Thickness along the prism's normal, which is that of the limit triangle.
struct EnclosureThickness {
  double prism, offset, interval, box;  ///< the last one: of the box around the control points
};

struct PrismRow {
  NetShape shape;
  std::size_t valence;
  std::size_t patches, left;     ///< measured; of which a limit point lies outside of the prism
  double outside;                ///< how far at most, in mesh units: spokes are 1 long
  EnclosureThickness thickness;  ///< medians, in mesh units
};

/// Rows of all shapes and valences: two patches a net, by bounding rows.
///
/// Guarantee: the same for any number of threads.
/// Errors:    InputError (value) unless nets >= 1 and steps >= 1.
[[nodiscard]] std::vector<PrismRow> measure_prisms(const TightnessOptions& options,
                                                   const WorkMonitor& monitor = {});

}  // namespace snug
