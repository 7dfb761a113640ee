#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <experiments/bound_source.h>
#include <experiments/corner_nets.h>
#include <snug/run.h>
#include <snug/surface/limit_surface.h>

/// How fast enclosures shrink as a patch is split towards its extraordinary corner. An experiment: the
/// enclosures are sound, what is said of their speed is measured.
namespace snug {

/// The three largest eigenvalues after 1 of the subdivision matrix at a vertex, of a dual scheme at a face.
/// Inside the mesh the first two are equal and belong to the tangent plane. Loop has there
/// lambda = 3/8 + cos(2 pi/n)/4, and `next` is max(lambda^2, 3/8 + cos(4 pi/n)/4), 1/8 for n = 3.
struct LargestEigenvalues {
  double subdominant, second, next;
};
/// Inside the mesh, in closed form.
/// Errors:    InputError (value) unless n >= 3.
/// Source:    derivations/loop_limits.md, catmark_limits.md, midedge_bezier.md; docs/convergence.md.
[[nodiscard]] LargestEigenvalues corner_eigenvalues(std::size_t n, Scheme scheme = Scheme::loop);
/// In the middle of bent_net(). Elsewhere than inside: sizes of eigenvalues of the corner's matrix
/// (eigenvalues.h).
[[nodiscard]] LargestEigenvalues corner_eigenvalues(Scheme scheme, const NetPlace& place);

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

/// Longest side of the boxes [Wu05, sec. 4.7].
template <std::size_t N>
[[nodiscard]] double thickness(const IntervalSimplex<N>& simplex) {
  double widest = 0;
  for (const Box3& box : simplex.corner) widest = std::max(widest, longest_side(box));
  return widest;
}

/// A thickness level by level, in mesh units; ends where rounding makes up more than a thousandth.
using Thicknesses = std::vector<double>;

/// Thicknesses of the piece that keeps corner 0 of patch p, at level 0, 1, ..., `levels`; in the order of
/// ThicknessMeasure. Without a normal at the corner there are no values of
/// ThicknessMeasure::normal.
///
/// Requires:  tables of surface.library().
/// Errors:    InputError (value) unless surface.has_patch(p) and levels <= PiecePath::max_level.
[[nodiscard]] std::array<Thicknesses, 3> corner_thicknesses(const LimitSurface& surface, PatchId p,
                                                            LayoutTables& tables, BoundSource source,
                                                            unsigned levels);

/// What lemma 12 bounds ThicknessMeasure::interval by: the largest gap between the planes of a table, at a corner of its
/// triangle, times the sum of |d_i|, in the coordinate where it is largest; at the levels of corner_thicknesses().
/// Source:    [Wu05, sec. 4.7].
struct LemmaTwelve {
  double gap = 0;     ///< its constant C
  Thicknesses bound;  ///< C sum |d_i|
};
/// Requires:  as corner_thicknesses(); a table as source.
[[nodiscard]] LemmaTwelve lemma_twelve(const LimitSurface& surface, PatchId p, LayoutTables& tables,
                                       BoundSource source, unsigned levels);

/// The factor a level of the geometric sequence nearest to the second half of `values`: least squares of
/// logarithms. Levels below values.size() / 2 are left out.
/// Requires:  positive values.
/// Errors:    InputError (value) for fewer than three.
[[nodiscard]] double fitted_factor(std::span<const double> values);

/// The factor that theory gives inside the mesh: 1/4 at a regular corner. Else the `next` eigenvalue for the
/// normal measure, for Loop's tables of the characteristic layout, and for bounding rows where the limit stays
/// inside the triangle of its corners; the subdominant one for the others.
/// Source:    docs/convergence.md.
[[nodiscard]] double expected_factor(std::size_t n, BoundSource source, ThicknessMeasure measure,
                                     Scheme scheme = Scheme::loop);
/// The same in the middle of bent_net(). Which eigenvalue it is was found by measuring, where
/// docs/convergence.md says so.
[[nodiscard]] double expected_factor(Scheme scheme, const NetPlace& place, BoundSource source,
                                     ThicknessMeasure measure);

/// Loop inside: bounding rows and tables of both layouts. Elsewhere: bounding rows, and tables, whose two layouts are
/// one there. Faces around the middle: inside Loop's experiment_valences, other schemes up to 12; boundaries
/// and corners 1 to 12, creases and darts 3 to 12; semi-sharp creases on a regular mesh, with the sharpnesses
/// experiment_sharpnesses.
struct RateOptions {
  Scheme scheme = Scheme::loop;
  NetCentre centre = NetCentre::interior;
  std::size_t nets = 25;  ///< bent nets a place
  unsigned levels = 12;
  std::uint64_t seed = 1;
  int threads = 0;
};

inline constexpr std::array experiment_sharpnesses{0.5, 1.5, 2.5, 4.5};

/// One line of the experiment.
struct RateRow {
  NetPlace place;
  BoundSource source;
  ThicknessMeasure measure;
  Thicknesses thickness;    ///< medians over the nets; levels that all nets have
  double factor, expected;  ///< fitted to the medians; of theory
  LemmaTwelve lemma{};      ///< medians; of tables, for ThicknessMeasure::interval
};

/// Rows of all places, sources and measures, in this order; none of the normal measure where there is no
/// normal.
///
/// Guarantee: the same for any number of threads.
/// Errors:    InputError (value) unless nets >= 1; 4 <= levels <= PiecePath::max_level; a primal scheme for
///            all places but the interior.
/// Cost:      some 0.2 ms a net at the default levels.
[[nodiscard]] std::vector<RateRow> measure_rates(const RateOptions& options, const WorkMonitor& monitor = {});

}  // namespace snug
