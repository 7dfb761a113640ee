#pragma once

#include <cstddef>
#include <functional>

namespace snug {

/// Calls body(begin, end) on ranges that cover [0, count), on at most `threads` threads (0: all cores).
///
/// Guarantee: each index is in exactly one range; an exception of a body ends the loop and is thrown again
///            here. Ranges depend on scheduling: results must not.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t, std::size_t)>& body);

/// The number of threads that 0 stands for.
[[nodiscard]] int hardware_threads();

}  // namespace snug
