#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <snug/caster/caster_kernels.h>
#include <snug/ray.h>
#include <snug/search/piece_set.h>
#include <snug/surface/limit_surface.h>

namespace snug {

/// Of a RayCaster: quadratic triangles near all pieces of a surface, under boxes.
/// Immutable; may be read by many threads.
/// Cost:      about 100 bytes a triangle.
class CasterTree {
 public:
  /// Requires:  the surface outlives it; tolerance > 0, in scaled units.
  /// Errors:    InputError (refused) if no face has a limit surface. Interrupted.
  CasterTree(const LimitSurface& surface, double tolerance, int threads, const WorkMonitor& monitor);

  /// Requires:  a ray that ray.h allows.
  [[nodiscard]] QuickHit cast(const Ray& ray) const;
  [[nodiscard]] bool blocked(const Ray& ray) const;
  /// The same for many; those that follow one another and lie close together are searched at once.
  void cast(std::span<const Ray> rays, std::span<QuickHit> out) const;
  [[nodiscard]] std::size_t bytes() const;

 private:
  /// Which pieces of which patches there are: 4 bytes each where few and shallow, else 8.
  class Places {
   public:
    Places() = default;
    explicit Places(const PieceSet& pieces);  ///< none yet, but room for each of these
    void add(const PieceName& piece);
    void shrink_to_fit() { words_.shrink_to_fit(); }
    /// The piece, or that of level 14 which holds it.
    [[nodiscard]] PieceName operator[](std::size_t i) const;
    [[nodiscard]] std::size_t bytes() const { return words_.capacity() * sizeof(std::uint32_t); }

   private:
    std::vector<std::uint32_t> words_;  // from the lowest bit: the root, the number of digits, the digits
    unsigned root_bits_ = 32;
    bool wide_ = true;  // two words each
  };
  struct Builder;
  struct Approach;
  struct Beam;
  [[nodiscard]] kernels::CasterRay seen(const Approach& approach) const;
  // Of a beam; one ray has a kernel of its own, kernels::cast().
  template <class Visit>
  void walk(const kernels::CasterRay& ray, float grown, float first, float last, const Visit& visit) const;
  [[nodiscard]] QuickHit nearest(const Approach& approach) const;
  [[nodiscard]] QuickHit finished(const Approach& approach, const kernels::CasterHit& hit) const;

  const LimitSurface* surface_;
  std::vector<kernels::CasterNode> nodes_;  // the root first
  std::vector<kernels::CasterBlock> blocks_;
  Places places_;  // caster_width a block
  Point3 centre_;
  double radius_ = 0;   // around everything
  float rounding_ = 0;  // of places across a ray
};

}  // namespace snug
