#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <snug/independence/exact_surface.h>
#include <snug/independence/modular.h>
#include <snug/run.h>

namespace snug {

/// The kernel modulo a prime of functionals of a surface. In reduced echelon form: vector k is 1 at free_columns[k], 0 at the
/// others of these.
struct ModularKernel {
  using Entries = std::vector<std::pair<std::uint32_t, std::uint32_t>>;  ///< by column, in rising order
  std::size_t rank = 0;
  std::vector<std::uint32_t> free_columns;
  std::vector<Entries> vectors;
};

/// Functionals that decide whether the function of each patch is 0, modulo the prime: of regular patches all, of others as
/// many splits as add to their rank.
///
/// Guarantee: `rank` is at most the exact rank of the surface's functions.
/// Requires:  a field with a root of the surface's order, and a prime that divides no denominator: none above 1000 does, but
///            for sharpness, whose denominators are powers of 2.
[[nodiscard]] ModularKernel modular_kernel(const ExactSurface& surface, std::size_t columns,
                                           const ModularField& field, const WorkMonitor& monitor);

}  // namespace snug
