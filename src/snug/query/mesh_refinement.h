#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include <snug/patch/limit_evaluator.h>
#include <snug/query/piece_quadratic.h>
#include <snug/query/tessellate.h>
#include <snug/query/triangle_complex.h>
#include <support/blocks.h>

namespace snug {

/// Tolerances below these, for coordinates from 1 to 2, are refused: rounding would take too much of them.
inline constexpr double min_tolerance = 0x1p-41, min_single_tolerance = 0x1p-21;

/// The limits of a refinement, in scaled units.
struct RefinementLimits {
  double tolerance = INFINITY, max_edge = INFINITY, max_thickness = INFINITY;
  const LocalTolerances* local = nullptr;  ///< instead of that one
  double min_cosine = -2;                  ///< of normals; -2 for none
  Point3 eye;
  double slope = INFINITY;    ///< of a triangle's tolerance over its distance from the eye
  double shortest_turn = 0;   ///< triangles without a longer side are not split for their normals
  bool whole_errors = false;  ///< also those above the tolerance
};

/// Triangles of a surface, split until they keep the limits.
/// Source:    derivations/tessellation.md.
class MeshRefinement {
 public:
  MeshRefinement(const LimitSurface& surface, const TessellateOptions& options,
                 const RefinementLimits& limits, const Run& run)
      : surface_(surface),
        options_(options),
        limits_(limits),
        run_(run),
        complex_(surface),
        written_(complex_.vertex_count()) {}

  /// Refines until all limits hold; false if that would take more than `most` triangles.
  bool run(std::uint64_t most);
  /// After a run that was ended: of triangles whose errors are not known but for being too large.
  void find_errors();
  [[nodiscard]] std::size_t triangle_count() const { return complex_.triangle_count(); }
  /// Upper bound over all triangles, in mesh units.
  [[nodiscard]] double error_bound() const;
  /// Also what is known of each triangle, if asked for. Nothing may be asked afterwards.
  [[nodiscard]] Tessellation take_result(LocalTessellation* local = nullptr);

 private:
  using Index = TriangleComplex::Index;
  using Cut = TriangleComplex::Cut;
  // Corners of a triangle, and then middles of the sides that begin there.
  using FacetPlaces = std::array<TriangleParameter, 6>;
  class Worker;

  // A triangle of the mesh. It is part of a piece, by splits in four, of its root patch. Where the piece's quadratic is
  // coarse the triangle is the whole piece, the error is of that, and it is split in four or not at all.
  struct Facet {
    // Instead of a quadratic: not known yet; coarse; and thick, too.
    static constexpr Index unknown = UINT32_MAX, coarse = UINT32_MAX - 1, thick = UINT32_MAX - 2;
    Index patch;
    Index quadratic = unknown;
    float bound = INFINITY;  // of its distance from the surface, either way

    [[nodiscard]] double error() const { return static_cast<double>(bound); }
    [[nodiscard]] bool is_coarse() const { return quadratic == coarse || quadratic == thick; }
  };

  // The quadratics of pieces that have one, by number.
  class Quadratics {
   public:
    [[nodiscard]] PieceQuadratic& operator[](Index i) { return all_[i]; }
    [[nodiscard]] const PieceQuadratic& operator[](Index i) const { return all_[i]; }
    // Room for one.
    [[nodiscard]] Index add() {
      if (free_.empty()) {
        all_.resize(all_.size() + 1);
        return static_cast<Index>(all_.size() - 1);
      }
      const Index i = free_.back();
      free_.pop_back();
      return i;
    }
    void drop(Index i) { free_.push_back(i); }

   private:
    Blocks<PieceQuadratic> all_;
    std::vector<Index> free_;
  };

  // Where a vertex is evaluated.
  struct OnPatch {
    Index patch = UINT32_MAX;
    TriangleParameter at;
  };

  void place_roots();
  void evaluate(std::size_t first, std::span<const OnPatch> places);
  void examine(std::span<const Index> triangles, bool mark);
  void examine_batch(std::span<const Index> triangles, bool mark);
  void prove(std::span<const Index> triangles, bool mark);
  void mark_coarse(Index t);
  [[nodiscard]] double seen_tolerance(Index t) const;
  [[nodiscard]] static double thickness(const Patch& patch, const BoundingPoints& hull);
  void learn(Worker& worker, Index t, Index room);
  void mark_bent(Index t, const Flatness& flatness);
  void mark_long(Worker& worker, Index t);
  void mark_turning(Worker& worker, Index t);
  void mark_sides(Index t);
  void mark_rest_of_coarse();
  [[nodiscard]] std::uint64_t count_after() const;
  void split(std::vector<Index>& parts);
  void carry_out(const Cut& cut);
  [[nodiscard]] std::size_t choose(Index t, unsigned marks) const;
  [[nodiscard]] FlatTriangle flat(Index t) const;
  [[nodiscard]] FacetPlaces places(Index t) const;
  [[nodiscard]] double tolerance(Index t) const {
    if (limits_.slope < INFINITY) return std::min(limits_.tolerance, seen_tolerance(t));
    if (limits_.local == nullptr) return limits_.tolerance;
    const std::optional<double> all = limits_.local->of_all(PatchId(facets_[t].patch));
    return std::max(surface_.scale().apply(all ? *all : limits_.local->of(part(t))), min_tolerance);
  }
  [[nodiscard]] PatchPart part(Index t) const {
    const FacetPlaces at = places(t);
    return {PatchId(facets_[t].patch), {at[0], at[1], at[2]}};
  }
  [[nodiscard]] PowerOfTwo back() const { return surface_.scale().inverse(); }
  [[nodiscard]] Point3 scaled(Index v) const { return surface_.scale().apply(written_[v]); }
  double finish(Index v, const BoundedPoint& point);
  void refuse_if_stuck() const;
  void add_normals(Tessellation& result, const std::vector<Index>& patches) const;

  const LimitSurface& surface_;
  const TessellateOptions& options_;
  RefinementLimits limits_;
  Run run_;
  TriangleComplex complex_;
  Blocks<Point3> written_;        // of vertices, in mesh units
  Blocks<TriangleParameter> at_;  // of sites
  double vertex_error_ = 0;       // largest of |written - limit point|, a coordinate, in scaled units
  Blocks<Facet> facets_;
  Quadratics quadratics_;
  std::vector<Index> coarse_;  // triangles of whole pieces that are split in four or not at all
  std::atomic<bool> stuck_{false};
};

}  // namespace snug
