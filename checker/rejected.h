#pragma once

#include <stdexcept>

namespace checker {

/// Something could not be proved; the message says what, in one line.
class Rejected : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace checker
