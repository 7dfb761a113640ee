#pragma once

#include <cstdint>

#include <snug/independence/weight.h>
#include <snug/scheme/creases.h>

namespace snug {

/// Least common multiple of the valences whose cosines masks of this mesh may hold, and of this number; 0 where it exceeds
/// `most`. Masks of Catmull-Clark and Midedge are rational.
[[nodiscard]] std::uint32_t order_of_masks(const RuledMesh& mesh, std::uint32_t order, std::uint32_t most);

/// The exact masks of one step of subdivision, those that refine() encloses.
class ExactStep {
 public:
  /// Weights are of this order, a multiple of order_of_masks().
  ///
  /// Requires:  Loop, Catmull-Clark, Doo-Sabin or Midedge; the mesh outlives it.
  ExactStep(const RuledMesh& mesh, std::uint32_t order) : mesh_(mesh), order_(order) {}

  /// The weights of new vertex `v`, as refine() counts them. Sharpness is a double, exactly; with Chaikin what is left of it is a
  /// double too, and the share of two rules is the exact mean of such.
  [[nodiscard]] WeightRow row(VertexId v) const;

 private:
  class Sum;
  void add_vertex(VertexId v, Sum& sum) const;
  void add_by_rule(VertexId v, const Star& star, std::span<const Spoke> spokes, VertexRule rule,
                   const mpq_class& share, Sum& sum) const;
  void add_smooth_vertex(VertexId v, const Star& star, const mpq_class& share, Sum& sum) const;
  void add_edge(EdgeId e, Sum& sum) const;
  void add_smooth_edge(HalfEdge h, const mpq_class& share, Sum& sum) const;
  [[nodiscard]] bool stays_sharp(EdgeId e) const;
  void add_dual(HalfEdge h, Sum& sum) const;
  void add_mean(FaceId f, const mpq_class& share, Sum& sum) const;

  RuledMesh mesh_;
  std::uint32_t order_;
};

}  // namespace snug
