#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

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
  std::string unit{};  ///< one of unit_words(); empty for none
  /// In mesh units, for a mesh whose longest side is `size`, and whose unit is so many metres, if that is known.
  /// Errors:    InputError (refused) if that is not a positive, finite double; UsageError for a unit where the mesh's is
  ///            not known.
  [[nodiscard]] double in_mesh_units(double size, std::optional<double> metres_per_unit = {}) const;
};

/// The units of --units.
[[nodiscard]] std::vector<std::string> unit_words();
/// Metres of one of them.
[[nodiscard]] double metres_of(const std::string& unit);
/// "mm"; "units of 0.1 m" for what has no word.
[[nodiscard]] std::string text_of_unit(double metres);
/// The word; nothing if there is none.
[[nodiscard]] std::optional<std::string> unit_of(double metres);

/// Errors:    UsageError naming `option` unless the text is a finite number, with or without % or a unit, that is >= 0,
///            or > 0 where zero is not allowed.
[[nodiscard]] Length parse_length(const std::string& text, const std::string& option,
                                  bool zero_allowed = false);

}  // namespace snug::command
