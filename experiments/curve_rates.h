#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <experiments/convergence.h>
#include <snug/scheme/curve_masks.h>

/// How fast enclosures of curves shrink as a piece is split towards its first end. An experiment, as
/// convergence.h.
namespace snug {

/// Which end of a piece.
enum class CurvePlace : std::uint8_t {
  closed,  ///< a vertex of a closed polyline
  inner,   ///< a vertex of an open polyline, two edges from its end
  end,     ///< the end of an open polyline
};
[[nodiscard]] const char* name_of(CurvePlace place);

/// One line of the experiment.
struct CurveRateRow {
  CurveDegree degree;
  CurvePlace place;
  ThicknessMeasure measure;      ///< radius or interval
  Thicknesses thickness;         ///< medians over the polylines; levels that all of them have
  std::optional<double> factor;  ///< fitted to the medians; absent where there are less than three
  double expected;               ///< of theory; 0 where the curve is straight
};

/// Rows of both degrees, all places and measures, in this order. `nets` are polylines of seven vertices on
/// random cubic curves.
///
/// Errors:    as measure_rates.
/// Source:    docs/derivations/curves.md.
[[nodiscard]] std::vector<CurveRateRow> measure_curve_rates(const RateOptions& options,
                                                            const WorkMonitor& monitor = {});

}  // namespace snug
