#pragma once

#include <flint/flint.h>

namespace snug {

/// Frees what FLINT keeps for this thread when the scope ends. All of FLINT's numbers in it must be gone by then.
class FlintMemory {
 public:
  FlintMemory() = default;
  ~FlintMemory() { flint_cleanup(); }
  FlintMemory(const FlintMemory&) = delete;
  FlintMemory& operator=(const FlintMemory&) = delete;
};

}  // namespace snug
