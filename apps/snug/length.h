#pragma once

#include <stdexcept>
#include <string>

namespace snug::command {

/// A command line that cannot be carried out; ends with status 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A length as users give it: mesh units, percent of a mesh's size ("0.5%", "0.5 %"), or with a unit ("0.1mm", "0.1 mm").
struct Length {
  double number = 0;
  bool percent = false;
  std::string unit{};  ///< mm, cm, m or inch; empty for none
  /// In mesh units, for a mesh whose longest side is `size`, and whose units are these, if they are known.
  /// Errors:    InputError (refused) if that is not a positive, finite double; UsageError for a unit where the mesh's are
  ///            not known.
  [[nodiscard]] double in_mesh_units(double size, const std::string& units = {}) const;
};

/// Errors:    UsageError naming `option` unless the text is a finite number, with or without % or a unit, that is >= 0,
///            or > 0 where zero is not allowed.
[[nodiscard]] Length parse_length(const std::string& text, const std::string& option,
                                  bool zero_allowed = false);

}  // namespace snug::command
