#pragma once

#include <string>

namespace snug::testing {

/// Where tests find their inputs: examples/models and tests/corpus.
[[nodiscard]] std::string models_dir();
[[nodiscard]] std::string corpus_dir();

}  // namespace snug::testing
