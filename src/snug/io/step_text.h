#pragma once

#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>

#include <support/point.h>

namespace snug {

/// Refers to an entity by its number.
struct StepRef {
  std::size_t number;
};

/// Adds a real as ISO 10303-21 writes it, with a decimal point; it is read back as the same double.
void append_step_real(std::string& text, double x);
/// A quoted string; characters outside ASCII become \X2\...\X0\.
[[nodiscard]] std::string step_string(std::string_view utf8);

/// The text of an exchange structure, entity by entity.
class StepText {
 public:
  void begin(const std::string& name, std::string_view schema);
  /// Adds an entity whose text is these parts; returns its number.
  template <class... Parts>
  std::size_t add(const Parts&... parts) {
    text_ += '#';
    text_ += std::to_string(++count_);
    text_ += '=';
    (append(parts), ...);
    text_ += ";\n";
    return count_;
  }
  std::size_t point(const Point3& p);
  std::size_t direction(const Vector3& v);
  /// Appends #number to a comma-separated list.
  static void list(std::string& list, std::size_t number);
  [[nodiscard]] std::string finish();

 private:
  void append(std::string_view part) { text_ += part; }
  template <class Writer>
  requires std::invocable<const Writer&>
  void append(const Writer& part) { part(); }
  void append(StepRef part) {
    text_ += '#';
    text_ += std::to_string(part.number);
  }
  std::size_t triple(std::string_view entity, double x, double y, double z);

  std::string text_;
  std::size_t count_ = 0;
};

}  // namespace snug
