#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <snug/base/progress.h>
#include <snug/query/corner_nets.h>
#include <snug/surface/surface.h>

/// How fast enclosures shrink as a patch is split towards its extraordinary corner. An experiment: the
/// enclosures are sound, what is said of their speed is measured.
namespace snug {

/// Eigenvalues of the subdivision matrix at an interior vertex, of a dual scheme at a face.
struct CornerEigenvalues {
  double subdominant;  ///< Loop: lambda = 3/8 + cos(2 pi/n)/4, twice: the tangent plane
  double next;         ///< the largest after these; Loop: max(lambda^2, 3/8 + cos(4 pi/n)/4), 1/8 for n = 3
};
/// Requires:  n >= 3.
/// Source:    derivations/loop_limits.md, catmark_limits.md, midedge_bezier.md; docs/convergence.md.
[[nodiscard]] CornerEigenvalues corner_eigenvalues(std::size_t n, Scheme scheme = Scheme::loop);

/// Three thicknesses of an enclosure.
enum class ThicknessMeasure : std::uint8_t {
  radius,    ///< of the offset triangle
  interval,  ///< longest side of the interval triangle's boxes [Wu05, sec. 4.7]
  normal,  ///< width of the slab along the limit normal at the corner; of a table, the range of the boxes of
           ///< an interval triangle in axes one of which is this normal
};
inline constexpr std::array all_thickness_measures{ThicknessMeasure::radius, ThicknessMeasure::interval,
                                                   ThicknessMeasure::normal};
[[nodiscard]] const char* name_of(ThicknessMeasure measure);

/// A thickness level by level, in mesh units; ends where rounding makes up more than a thousandth.
using Thicknesses = std::vector<double>;

/// Thicknesses of the piece that keeps corner 0 of patch p, at level 0, 1, ..., `levels`; in the order of
/// ThicknessMeasure.
///
/// Requires:  surface.has_patch(p); a normal at the corner; levels <= PiecePath::max_level.
[[nodiscard]] std::array<Thicknesses, 3> corner_thicknesses(const Surface& surface, PatchId p,
                                                            BoundSource source, unsigned levels);

/// The factor a level of the geometric sequence nearest to the second half of `values`: least squares of
/// logarithms. Levels below values.size() / 2 are left out.
/// Requires:  at least three values, all positive.
[[nodiscard]] double fitted_factor(std::span<const double> values);

/// The factor that theory gives: 1/4 at a regular corner. Else the `next` eigenvalue for the normal measure
/// and for tables of the characteristic layout; for the others this or the subdominant one.
/// Source:    docs/convergence.md.
[[nodiscard]] double expected_factor(std::size_t n, BoundSource source, ThicknessMeasure measure,
                                     Scheme scheme = Scheme::loop);

/// Loop: hull rows and tables of both layouts, all experiment_valences. Other schemes: hull rows alone, valences
/// up to 12.
struct RateOptions {
  Scheme scheme = Scheme::loop;
  std::size_t nets = 25;  ///< bent nets a valence
  unsigned levels = 12;
  std::uint64_t seed = 1;
  int threads = 0;
};

/// One line of the experiment.
struct RateRow {
  std::size_t valence;
  BoundSource source;
  ThicknessMeasure measure;
  Thicknesses thickness;    ///< medians over the nets; levels that all nets have
  double factor, expected;  ///< fitted to the medians; of theory
};

/// Rows of all valences, sources and measures, in this order.
///
/// Guarantee: the same for any number of threads.
/// Requires:  nets >= 1; 4 <= levels <= PiecePath::max_level.
/// Cost:      some 0.2 ms a net at the default levels.
[[nodiscard]] std::vector<RateRow> measure_rates(const RateOptions& options, const WorkMonitor& monitor = {});

}  // namespace snug
