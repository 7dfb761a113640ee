#pragma once

#include <cstddef>
#include <vector>

#include <gmpxx.h>

namespace snug {

/// A basis of the vectors that all rows are orthogonal to: reduced echelon form, by exact arithmetic.
[[nodiscard]] std::vector<std::vector<mpq_class>> null_space(const std::vector<std::vector<mpq_class>>& rows,
                                                             std::size_t columns);

}  // namespace snug
