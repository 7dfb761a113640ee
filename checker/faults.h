#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "bounds_file.h"

namespace checker {

/// A way to spoil a file.
struct Fault {
  std::string name;
  std::function<std::vector<std::byte>(const BoundsFile&)> spoil;
};

/// Faults that a proof must find, each in a file that is otherwise whole; those of tables where there is one.
/// Requires:  a file that is proved and has two kinds at least.
[[nodiscard]] std::vector<Fault> faults(const BoundsFile& file);

/// The kinds of a scheme that faults are planted in, to keep proofs short: a small one inside, and one at a
/// boundary; of a dual scheme two inside.
/// Errors:    Rejected if the file has none of these.
[[nodiscard]] BoundsFile excerpt(const BoundsFile& file, Scheme scheme);

}  // namespace checker
