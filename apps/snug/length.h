#pragma once

#include <stdexcept>
#include <string>

namespace snug::command {

/// A command line that cannot be carried out; ends with status 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A length as users give it: mesh units, or percent of a mesh's size ("0.5%", "0.5 %").
struct Length {
  double number = 0;
  bool percent = false;
  /// In mesh units, for a mesh whose longest side is `size`.
  /// Errors:    InputError (refused) if that is not a positive, finite double.
  [[nodiscard]] double in_mesh_units(double size) const;
};

/// Errors:    UsageError naming `option` unless the text is a finite number, with or without %, that is >= 0,
///            or > 0 where zero is not allowed.
[[nodiscard]] Length parse_length(const std::string& text, const std::string& option,
                                  bool zero_allowed = false);

}  // namespace snug::command
