#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <snug/geometry/interval.h>
#include <snug/geometry/rounding.h>
#include <snug/patch/patch.h>
#include <snug/shape/ring_decay.h>

namespace snug {

/// The characteristic map of an extraordinary corner where the kind comes again, by its control net, and how fast
/// nets tend to it, level after level.
///
/// Let A make the control points of the child at the corner from those of the patch, and W be the rows of the
/// two limit tangents: W A = L W, L diagonal. Then A^j y = V L^j W y + A^j r for control values y, with the
/// right eigenvectors V of A, W V = 1, and W r = 0. What is below 1 of A beside L contracts r faster than L.
/// Extents are (largest - least) / 2: what conditions on derivatives see of a net.
/// Source:    derivations/self_contact.md, "At extraordinary corners".
class CharacteristicMap {
 public:
  /// Upper bound of the error of a tangent row's entries, in sum: those of creases and boundaries come from
  /// sines in double precision (derivations/self_contact.md, "Rows").
  static double row_error(const Stencils::Row& row) {
    return enlarged(row.error +
                    (64 + 8 * static_cast<double>(row.sources.size())) * unit_roundoff * row.abs_sum);
  }
  [[nodiscard]] std::size_t corner() const { return corner_; }  ///< of the kind
  /// Are both eigenvalues proved to be equal? Then any two directions of space do.
  [[nodiscard]] bool conformal() const { return conformal_; }
  /// Contains that eigenvalue; only of a conformal map.
  [[nodiscard]] Interval eigenvalue() const { return eigenvalues_[0]; }
  /// The tangent whose eigenvalue is larger; only of a map that is not conformal.
  [[nodiscard]] std::size_t dominant() const { return dominant_; }

  /// The parts of a net that rings of all levels come from, in space.
  struct LimitNets {
    Patch net;       ///< of both tangents' parts; its error bounds all that is left out
    Patch dominant;  ///< of the dominant tangent's part alone; of a conformal map the same as `net`
  };
  /// Of a conformal map, nets of all levels over powers of the eigenvalue lie within the error of `net`, moved.
  /// Normals of a ring, scaled by a positive number, are those of `net` but for products of two differences of
  /// which one is at most the error of `net` and the other lies between those of `net` and of `dominant`.
  /// Source:    derivations/normals.md, "At extraordinary corners".
  [[nodiscard]] LimitNets limit_nets(const Patch& patch) const;
  [[nodiscard]] RingDecay decay() const;

 private:
  friend std::optional<CharacteristicMap> make_characteristic_map(const Kind& kind);
  // How much of each direction control values have, and what the exact shares differ by at most.
  struct Shares {
    std::array<double, 2> m, off;
  };
  [[nodiscard]] Shares shares(const std::vector<double>& y, const Patch& values) const;
  [[nodiscard]] double left_out(const std::vector<double>& y, const Shares& shares,
                                const Patch& values) const;
  [[nodiscard]] bool find_eigenvalues(const Kind& kind, const Stencils& step);
  [[nodiscard]] bool find_directions(const Stencils& step);
  [[nodiscard]] bool bound_remainders(const Stencils& step);
  [[nodiscard]] double projection() const;
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
  // Of the extent of A^j r over that of r, over the least eigenvalue's power: at most `growth`; of j = period, `factor`.
  struct Contraction {
    std::size_t period = 1;
    double factor = 1, growth = 1;
  } contraction_;
};

/// None where the kind does not come again at a corner, where the tangents' eigenvalues are not proved to be
/// the largest, and for darts and corners of very many faces.
[[nodiscard]] std::optional<CharacteristicMap> make_characteristic_map(const Kind& kind);

}  // namespace snug
