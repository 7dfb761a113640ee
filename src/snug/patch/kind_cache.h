#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

#include <snug/patch/neighbourhood.h>
#include <snug/scheme/rules.h>
#include <support/lazy.h>

namespace snug {

class CornerAsymptotics;
class Kind;
class KindCache;

/// A patch kind in a KindCache.
using KindId = Id<struct KindTag>;

/// A quarter of a patch after one step of subdivision; of a polygon half a quad.
struct KindChild {
  const Kind* kind;
  std::uint8_t
      first;  ///< corner of the child, in the parent's order (scheme/refine.h), that its kind calls 0
  /// New control points from those of the parent, each once: the same for all its children.
  std::shared_ptr<const Stencils> step;
  std::vector<std::uint32_t> control;  ///< its control points among them
  /// Its control points from the parent's, alone.
  [[nodiscard]] Stencils stencils() const;
};

/// One step of subdivision of a whole patch, or of the whole quad that it is half of: each new point once.
struct KindStep {
  struct Piece {
    const Kind* kind;
    std::uint8_t first;                  ///< as in KindChild
    std::vector<std::uint32_t> control;  ///< its control points among the new ones
    std::vector<std::uint32_t> lattice;  ///< if it is polynomial, its lattice likewise
  };
  Stencils stencils;  ///< new control points from those of the patch; of triangles those of children()
  Stencils ghosts;    ///< likewise: points of lattices that are no control points, numbered after these
  /// Of triangles the four children; of quads the quarters at the corners, all corners in their places.
  std::array<Piece, 4> pieces;
};

/// The lattice of a polynomial kind, in the order of its scheme's basis.
struct KindLattice {
  std::vector<std::uint32_t> places;  ///< among the control points and, after them, the ghosts
  Stencils ghosts;                    ///< points beyond boundaries and creases, from control points
};

/// Data that all patches with equal connectivity share. Immutable; expensive parts are made on first use.
/// Thread-safe.
class Kind {
 public:
  Kind(KindCache& library, KindId id, const KindKey& key);
  Kind(const Kind&) = delete;
  Kind& operator=(const Kind&) = delete;

  [[nodiscard]] KindId id() const { return id_; }
  [[nodiscard]] const KindKey& key() const { return key_; }
  [[nodiscard]] Scheme scheme() const { return key_.scheme; }
  [[nodiscard]] const SchemeRules& rules() const { return rules_; }
  [[nodiscard]] std::size_t control_count() const { return control_count_; }
  /// The control vertices of the patch of this kind that begins at a half-edge.
  void control_vertices(const Topology& topology, HalfEdge start, std::vector<VertexId>& out) const {
    order_(topology, start, out);
  }
  [[nodiscard]] const CornerFan& corner(std::size_t i) const { return key_.corners[i]; }
  /// Is the surface near corner 0, 1 or 2 as on a regular lattice, at least a few levels down?
  [[nodiscard]] bool regular_corner(std::size_t i) const { return rules_.regular(key_.corners[i]); }
  /// Not for ever: sharpness decays, or polygons that are no quads lie around it.
  [[nodiscard]] bool transient() const { return transient_; }
  /// Is a corner one of more faces than 64, or than 16 between creases or boundaries? The matrix of points that bound
  /// one of its patches would have as many rows, and more, as the patch has control points: to split the patch takes
  /// fewer operations, but for Doo-Sabin, whose step is such a matrix itself.
  [[nodiscard]] bool high_valence() const;
  /// Is one of them between creases or boundaries, so that each patch at it is of a kind of its own?
  [[nodiscard]] bool high_valence_beside_creases() const;
  /// Do many patches share such kinds, so that rows are cached for them? Others are split first.
  [[nodiscard]] bool cacheable() const { return !transient() && !high_valence(); }

  /// Is the patch polynomial, or made of two polynomials (Midedge)? Only then it has a form.
  /// Guarantee: entries of its rows are small fractions, each rounded once.
  [[nodiscard]] bool polynomial() const { return form_.has_value(); }
  [[nodiscard]] const BezierRows& form() const { return *form_; }
  [[nodiscard]] const Stencils& bezier() const { return form_->rows; }

  // Requires, of the next three: a patch, no polygon.
  /// Limit positions of the corners: three rows.
  [[nodiscard]] const Stencils& corner_limits() const;
  /// Two tangent rows a corner, those of corner i at 2 i and 2 i + 1 (SchemeRules::add_corner_tangents).
  [[nodiscard]] const Stencils& corner_tangents() const;
  /// Upper bound w, over the patch, of the sum of the weights of all control points but those of the face, or
  /// the vertex, that the patch belongs to: it lies in the sum of 1 - w times the hull of the latter and w
  /// times the hull of all.
  [[nodiscard]] double outer_weight() const;

  /// The points that the basis functions of a polynomial kind weight.
  [[nodiscard]] const KindLattice& lattice() const;
  /// The step that evaluation descends by.
  /// Requires:  no polygon; not polynomial.
  [[nodiscard]] const KindStep& step() const;
  /// Of halves of quads: the limit row and the two tangent rows at the quad's fourth corner.
  struct FarCorner {
    Stencils limit, tangents;
  };
  [[nodiscard]] const FarCorner& far_corner() const;

  /// The four children of a patch; 0 to 2 keep that corner, 3 is the middle one. Of a polygon with n corners
  /// 2 n: at corner k the half of its quad that begins there, then the other one, which begins at the centre.
  [[nodiscard]] const std::vector<KindChild>& children() const;

 private:
  friend const CornerAsymptotics& asymptotics_of(const Kind& kind);  // shape/corner_asymptotics.h
  Kind(KindCache& library, KindId id, const KindKey& key, const Neighbourhood& around);

  KindCache& library_;
  const SchemeRules& rules_;
  KindId id_;
  KindKey key_;
  ControlOrder order_;
  bool transient_ = false;
  std::size_t control_count_ = 0;
  std::optional<BezierRows> form_;
  Lazy<double> outer_weight_;
  Lazy<Stencils> corner_limits_, corner_tangents_;
  Lazy<KindLattice> lattice_;
  Lazy<KindStep> step_;
  Lazy<FarCorner> far_corner_;
  Lazy<std::vector<KindChild>> children_;
  Lazy<std::shared_ptr<const CornerAsymptotics>> asymptotics_;
};

/// All kinds met so far. Grows, never forgets; kinds stay where they are as long as the library lives.
/// Guarantee: thread-safe; a kind is made once.
/// Cost:      find: one hash look-up; a new kind with its rows 0.05 to 0.5 ms up to valence 12 (bench/).
class KindCache {
 public:
  KindCache() = default;
  KindCache(const KindCache&) = delete;
  KindCache& operator=(const KindCache&) = delete;

  [[nodiscard]] const Kind& find(const KindKey& key);
  [[nodiscard]] std::size_t size() const;

 private:
  mutable std::mutex mutex_;
  std::unordered_map<KindKey, std::unique_ptr<Kind>, KindKeyHash> kinds_;
};

}  // namespace snug
