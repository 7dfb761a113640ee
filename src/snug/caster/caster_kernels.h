#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// One ray against a tree of boxes and quadratic triangles, eight at once, or against some of them; in single precision, on the
/// widest vectors that the processor has. The same bits on every instruction set.
namespace snug::kernels {

/// Boxes of a node, and quadratic triangles of a block.
inline constexpr std::size_t caster_width = 8;

struct CasterRay {
  std::array<float, 3> origin, direction,
      inverse;       ///< direction of length 1; 1 over its coordinates, none infinite
  float rounding;    ///< error of places across the ray
  std::size_t axis;  ///< the direction's largest coordinate
};
/// Rays close to a first one, coordinate by coordinate; its axis comes last, the one after it first.
struct alignas(32) CasterRays {
  std::array<std::array<float, caster_width>, 3> origin, direction;
  std::array<float, caster_width> inverse;  ///< 1 over the last coordinate of the direction
  std::size_t axis;
};

/// Axis-aligned boxes.
struct alignas(32) CasterBoxes {
  std::array<std::array<float, caster_width>, 3> lower, upper;
};
/// A bit for each box that the ray meets before `to`, when it is larger by `grown` on each side, and where it enters
/// these, not before `from`.
std::uint32_t enter_boxes(const CasterBoxes& boxes, const CasterRay& ray, float grown, float from, float to,
                          float* enter);

/// Quadratic triangles near each other: their Bezier points, coordinate by coordinate, are origin + step net; corners,
/// then middles of the edges 01, 12, 20.
struct alignas(64) CasterBlock {
  std::array<std::array<std::array<std::int16_t, caster_width>, 3>, 6> net;
  std::array<float, 3> origin;
  float step, inverse_step;
  float error;          ///< how far any may be off
  std::uint32_t taken;  ///< a bit each
};
/// A bit for each triangle that is within the error and `grown` of the ray.
std::uint32_t near_ray(const CasterBlock& block, const CasterRay& ray, float grown);

/// A node of a tree: children are other nodes, or blocks with caster_leaf_bit.
struct alignas(64) CasterNode {
  CasterBoxes boxes;
  std::array<std::uint32_t, caster_width> children;

  /// Without children: rays end before their boxes, but for those that begin there.
  static CasterNode empty() {
    CasterNode node{};
    for (std::size_t k = 0; k < 3; ++k) {
      node.boxes.lower[k].fill(1e30F);
      node.boxes.upper[k].fill(1e30F);
    }
    node.children.fill(no_child);
    return node;
  }
  /// Of a tree that is being made; then the name of a block without triangles.
  static constexpr std::uint32_t no_child = 0xffffffffu;
};
inline constexpr std::uint32_t caster_leaf_bit = 0x80000000u;

/// Where a ray meets a triangle; `place` is which of a block.
struct CasterHit {
  std::uint32_t block = 0;
  std::uint32_t place = caster_width;  ///< caster_width: none
  float t = 0, u = 0, v = 0;
};
/// Which hit is looked for: the first, or any.
enum class CasterQuery : std::uint8_t { nearest, any };
/// A place, of `from` to `to` along the ray, where it comes within the error of a triangle of the tree.
CasterHit cast(const CasterNode* nodes, const CasterBlock* blocks, const CasterRay& ray, float from, float to,
               CasterQuery query);
/// One triangle of a block and several rays: where these come within its error, if not behind `to`, which becomes
/// nearer. Returns a bit for each ray that does so.
std::uint32_t hit_piece(const CasterBlock& block, std::size_t place, const CasterRays& rays, float rounding,
                        const float* from, float* to, float* u, float* v);

}  // namespace snug::kernels
