#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include <snug/geometry/rounding.h>
#include <snug/patch/patch.h>

namespace snug {

/// What the nets at an extraordinary corner tend to, level after level, if their kind comes again there.
///
/// Let A make the control points of the child at the corner from those of the patch, and W be the rows of the
/// two limit tangents: W A = L W, L diagonal. Then A^j y = V L^j W y + A^j r for control values y, with the
/// right eigenvectors V of A, W V = 1, and W r = 0. What is below 1 of A beside L contracts r faster than L.
/// Extents are (largest - least) / 2: what conditions on derivatives see of a net.
/// Source:    derivations/self_contact.md, "At extraordinary corners".
class TipLimit {
 public:
  /// Upper bound of the error of a tangent row's entries, in sum: those of creases and boundaries come from
  /// sines in double precision, and from some ten operations and one sum over the faces each.
  static double row_error(const Stencils::Row& row) {
    return enlarged(row.error + 0x1p12 * unit_roundoff * row.abs_sum);
  }
  [[nodiscard]] std::size_t corner() const { return corner_; }  ///< of the kind
  /// Are both eigenvalues proved to be equal? Then any two directions of space do.
  [[nodiscard]] bool conformal() const { return conformal_; }
  /// Contains that eigenvalue; only of a limit that is conformal.
  [[nodiscard]] Interval eigenvalue() const { return eigenvalues_[0]; }
  /// The tangent whose eigenvalue is larger; only of a limit that is not conformal.
  [[nodiscard]] std::size_t dominant() const { return dominant_; }

  /// A net of control values (x, y, 0) that stands for those of all levels from this patch on, each of its two
  /// values scaled by a positive number and moved: rings of all levels lie within its error.
  ///
  /// Requires:  values of the kind's control points, in x and y. Of a limit that is not conformal y must not
  ///            have a share of the dominant direction: W y = 0 for that row, in exact arithmetic.
  [[nodiscard]] Patch lasting(const Patch& values) const;

 private:
  friend std::optional<TipLimit> make_tip_limit(const Kind& kind);
  [[nodiscard]] bool find_eigenvalues(const Kind& kind, const Stencils& step);
  [[nodiscard]] bool find_directions(const Stencils& step);
  [[nodiscard]] bool bound_remainders(const Stencils& step);
  [[nodiscard]] double largest_rest(std::vector<double> rest, double error) const;
  [[nodiscard]] std::array<double, 2> tangent(const std::vector<double>& values) const;

  const Kind* kind_ = nullptr;
  std::size_t corner_ = 0, size_ = 0;
  bool conformal_ = false;
  std::size_t dominant_ = 0;
  std::array<std::vector<double>, 2> rows_;          // W
  std::array<double, 2> row_errors_{}, row_sums_{};  // of all entries together
  std::array<Interval, 2> eigenvalues_{};
  std::array<std::vector<double>, 2> directions_;  // about V
  std::array<double, 2> extents_{};                // of these
  std::array<double, 2> direction_errors_{};       // extents of V less these
  double growth_ = 1;  // of the extent of A^j r over that of r, over the least eigenvalue's power
};

/// None where the kind does not come again at a corner, where the tangents' eigenvalues are not proved to be
/// the largest, and for darts and corners of very many faces.
[[nodiscard]] std::optional<TipLimit> make_tip_limit(const Kind& kind);

/// The limits of kinds, each made once. For one thread.
class TipLimits {
 public:
  /// Null where there is none.
  [[nodiscard]] const TipLimit* find(const Kind& kind);

 private:
  std::unordered_map<const Kind*, std::optional<TipLimit>> known_;
};

}  // namespace snug
