#pragma once

#include <cstddef>

namespace snug::kernels {

/// Quadratics of pieces and flat triangles on them, one a lane; scaled coordinates.
struct FlatnessLanes {
  static constexpr std::size_t count = 8;
  using Row = double[count];
  alignas(64) Row origin[3], u[3], v[3], uu[3], uv[3], vv[3];
  alignas(64) Row at[3][2], corner[3][3];  // parameters of corners on the piece
  alignas(64) Row error, corner_gap;       // the quadratic's error, and then the triangle's
};

/// Upper bounds of errors, and the largest gaps of corners: Flatness.
/// Guarantee: the same bits on every instruction set; not finite where a coordinate is not.
/// Source:    derivations/tessellation.md.
void flatness(FlatnessLanes& flat);

}  // namespace snug::kernels
