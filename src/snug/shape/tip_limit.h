#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <shared_mutex>
#include <unordered_map>
#include <vector>

#include <snug/geometry/interval.h>
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
  /// sines in double precision (derivations/self_contact.md, "Rows").
  static double row_error(const Stencils::Row& row) {
    return enlarged(row.error +
                    (64 + 8 * static_cast<double>(row.sources.size())) * unit_roundoff * row.abs_sum);
  }
  [[nodiscard]] std::size_t corner() const { return corner_; }  ///< of the kind
  /// Are both eigenvalues proved to be equal? Then any two directions of space do.
  [[nodiscard]] bool conformal() const { return conformal_; }
  /// Contains that eigenvalue; only of a limit that is conformal.
  [[nodiscard]] Interval eigenvalue() const { return eigenvalues_[0]; }
  /// The tangent whose eigenvalue is larger; only of a limit that is not conformal.
  [[nodiscard]] std::size_t dominant() const { return dominant_; }

  /// What rings of all levels come from, in space.
  struct Lasting {
    Patch net;       ///< of both tangents' parts; its error bounds all that is left out
    Patch dominant;  ///< of the dominant tangent's part alone; of a conformal limit the same as `net`
  };
  /// Of a conformal limit, nets of all levels over powers of the eigenvalue lie within the error of `net`, moved.
  /// Normals of a ring, scaled by a positive number, are those of `net` but for products of two differences of
  /// which one is at most the error of `net` and the other lies between those of `net` and of `dominant`.
  /// Source:    derivations/normals.md, "At extraordinary corners".
  [[nodiscard]] Lasting lasting(const Patch& patch) const;

 private:
  friend std::optional<TipLimit> make_tip_limit(const Kind& kind);
  friend class TipRings;
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
  [[nodiscard]] double off_plane(const std::array<double, 2>& m) const;
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
  std::size_t period_ = 1;  // the extent of A^period r is less than that power of the least eigenvalue
  double growth_ = 1;       // of the extent of A^j r over that of r, over the least eigenvalue's power
};

/// The nets of control values (x, y, 0) at an extraordinary corner, level after level, moved and scaled: by a
/// positive number for each level, of a limit that is not conformal by one for each of the two values.
///
/// Requires:  values of the kind's control points, in x and y. Of a limit that is not conformal x belongs to the
///            first tangent and y to the second one: the value that does not belong to the dominant one has no
///            share of it, W x = 0 or W y = 0 for that row, in exact arithmetic.
/// Source:    derivations/self_contact.md, "All rings at once".
class TipRings {
 public:
  TipRings(const TipLimit& limit, const Patch& values);
  /// How many levels it is of use to look at; at least one.
  [[nodiscard]] std::size_t count() const { return count_; }
  /// The net of one level.
  [[nodiscard]] Patch net(std::size_t level) const;
  /// A net that stands for those of this level and all further ones: they lie within its error.
  [[nodiscard]] Patch lasting(std::size_t level) const;

 private:
  // What is left of one value without the tangents' directions, over its eigenvalue's powers. The exact one less
  // this: along V, and the rest of it, as large as its part of level 0 that A makes it of.
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
  void settle(Rest& rest) const;
  [[nodiscard]] bool small(const Value& part) const;
  // Points of a value with the shares of its directions, not scaled.
  struct Filled {
    double largest = 0, error = 0;
  };
  [[nodiscard]] Filled fill(std::size_t c, std::size_t level, bool all_further, Patch& net) const;
  [[nodiscard]] Patch made(std::size_t level, bool all_further) const;

  const TipLimit* limit_;
  const Patch* values_;
  std::array<Value, 2> parts_;
  std::size_t count_ = 0;
};

/// None where the kind does not come again at a corner, where the tangents' eigenvalues are not proved to be
/// the largest, and for darts and corners of very many faces.
[[nodiscard]] std::optional<TipLimit> make_tip_limit(const Kind& kind);

/// The limits of kinds, each made once; for as long as these live. Thread-safe.
class TipLimits {
 public:
  /// Null where there is none.
  [[nodiscard]] const TipLimit* find(const Kind& kind);

 private:
  std::shared_mutex mutex_;
  std::unordered_map<const Kind*, std::optional<TipLimit>> known_;
};

}  // namespace snug
