#pragma once

#include <oracle/twin_mesh.h>

#include <cstdint>
#include <random>

/// Small control meshes to try the twins on, and whatever is compared with them.
namespace oracle::meshes {

[[nodiscard]] TwinMesh octahedron();
[[nodiscard]] TwinMesh icosahedron();  ///< unit circumradius, two corners on the z axis

/// Points (i, j, 0) for 0 <= i <= columns, 0 <= j <= rows; every square is cut along (1, 1).
[[nodiscard]] TwinMesh grid(std::uint32_t columns, std::uint32_t rows,
                            Boundary boundary = Boundary::edge_and_corner);

/// Two apexes (0, 0, +-1), the first and second point, of valence `n` over a ring of radius 1.
[[nodiscard]] TwinMesh bipyramid(std::uint32_t n);

/// One apex and a boundary ring.
[[nodiscard]] TwinMesh wheel(std::uint32_t n, Boundary boundary);

/// Splits `count` random faces in three, then moves every point by up to `amount` along each axis.
[[nodiscard]] TwinMesh disturbed(TwinMesh mesh, int count, double amount, std::mt19937_64& random);

/// Cuts every face in four at its edge midpoints.
[[nodiscard]] TwinMesh quartered(const TwinMesh& mesh);

}  // namespace oracle::meshes
