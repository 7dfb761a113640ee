#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <unordered_map>
#include <vector>

#include <snug/patch/neighbourhood.h>
#include <snug/scheme/stencils.h>

namespace snug {

class Kind;
class KindLibrary;

/// A quarter of a patch after one step of subdivision.
struct KindChild {
  const Kind* kind;
  std::uint8_t
      first;          ///< corner of the child, in the parent's order (scheme/refine.h), that its kind calls 0
  Stencils stencils;  ///< its control points from the parent's
};

/// What all patches with equal connectivity share. Immutable; parts that cost much are made on first use.
/// Thread-safe.
class Kind {
 public:
  Kind(KindLibrary& library, KindId id, const KindKey& key);
  Kind(const Kind&) = delete;
  Kind& operator=(const Kind&) = delete;

  [[nodiscard]] KindId id() const { return id_; }
  [[nodiscard]] const KindKey& key() const { return key_; }
  [[nodiscard]] std::size_t control_count() const { return control_count_; }
  [[nodiscard]] const CornerFan& corner(std::size_t i) const { return key_.corners[i]; }

  /// Is the patch one quartic polynomial? Then bezier() gives it.
  [[nodiscard]] bool polynomial() const { return polynomial_; }
  /// Bezier points of the patch: 15 rows, point (i, j) of degree 4 (u^i v^j) at bezier_index(i, j).
  /// Requires:  polynomial().
  [[nodiscard]] const Stencils& bezier() const { return bezier_; }

  /// Limit positions of the corners: three rows.
  [[nodiscard]] const Stencils& corner_limits() const { return corner_limits_; }
  /// Two tangent rows a corner, those of corner i at 2 i and 2 i + 1 (scheme/refine.h).
  [[nodiscard]] const Stencils& corner_tangents() const;

  /// The four children; 0 to 2 keep that corner, 3 is the middle one.
  [[nodiscard]] const std::array<KindChild, 4>& children() const;

 private:
  KindLibrary& library_;
  KindId id_;
  KindKey key_;
  std::size_t control_count_ = 0;
  bool polynomial_ = false;
  Stencils bezier_, corner_limits_;
  mutable std::once_flag tangents_made_, children_made_;
  mutable Stencils corner_tangents_;
  mutable std::unique_ptr<std::array<KindChild, 4>> children_;
};

/// Place of the Bezier point u^i v^j among the 15 of a quartic triangle.
[[nodiscard]] constexpr std::size_t bezier_index(std::size_t i, std::size_t j) {
  return i + j * 5 - j * (j - 1) / 2;
}

/// All kinds met so far. Grows, never forgets; kinds stay where they are as long as the library lives.
///
/// Guarantee: thread-safe; a kind is made once.
/// Cost:      find: one hash look-up; a new kind with its rows 0.05 to 0.5 ms up to valence 12 (bench/).
class KindLibrary {
 public:
  KindLibrary() = default;
  KindLibrary(const KindLibrary&) = delete;
  KindLibrary& operator=(const KindLibrary&) = delete;

  [[nodiscard]] const Kind& find(const KindKey& key);
  [[nodiscard]] std::size_t size() const;

 private:
  mutable std::shared_mutex mutex_;
  std::unordered_map<KindKey, std::unique_ptr<Kind>, KindKeyHash> kinds_;
};

}  // namespace snug
