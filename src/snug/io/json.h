#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace snug {

/// A value of a JSON text.
class Json {
 public:
  enum class Kind : std::uint8_t { null, boolean, number, text, array, object };

  Kind kind = Kind::null;
  bool truth = false;
  double number = 0;
  std::string_view text;                ///< what stands between the quotes, escapes as they are
  std::vector<Json> items;              ///< of an array; of an object, the values of its members
  std::vector<std::string_view> names;  ///< of an object's members

  /// The member of this name, the last one if there are several; nothing if there is none, or no object.
  [[nodiscard]] const Json* find(std::string_view name) const;
  /// A whole number from 0 to 2^53; nothing else.
  [[nodiscard]] std::optional<std::uint64_t> integer() const;
};

/// Reads a JSON text of one value, with blanks around it.
///
/// Requires:  the text outlives the value.
/// Errors:    InputError (unreadable) "name: JSON, byte n: message": another grammar, numbers beyond doubles,
///            values nested deeper than 100.
/// Cost:      linear in the text; some 100 bytes of memory a value.
[[nodiscard]] Json parse_json(std::string_view text, const std::string& name);

}  // namespace snug
