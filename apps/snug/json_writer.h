#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <support/point.h>

namespace snug::command {

/// Writes one JSON document piece by piece, so that a million enclosures need no gigabytes.
///
/// Guarantee: numbers are the shortest that read back as the same double; text is UTF-8, with U+FFFD for
///            bytes that are none.
/// Requires:  calls in an order that makes a document.
/// Errors:    InputError (unrepresentable) on a number that is not finite.
class JsonWriter {
 public:
  /// Line feeds between the entries of a document and of its lists, or none.
  enum class Lines { many, one };
  /// `sink` receives text in blocks of about 64 KiB.
  explicit JsonWriter(std::function<void(std::string_view)> sink, Lines lines = Lines::many);

  JsonWriter& begin_object();
  JsonWriter& end_object();
  JsonWriter& begin_array();
  JsonWriter& end_array();
  JsonWriter& key(std::string_view name);
  JsonWriter& value(double number);
  template <std::integral Integer>
  JsonWriter& value(Integer number) {
    return raw(std::to_string(number));
  }
  JsonWriter& value(bool truth) { return raw(truth ? "true" : "false"); }
  JsonWriter& value(std::string_view text);
  JsonWriter& value(const char* text) { return value(std::string_view(text)); }
  JsonWriter& value(const Point3& p);
  JsonWriter& value(const Vector3& v);
  JsonWriter& null() { return raw("null"); }

  template <class T>
  JsonWriter& field(std::string_view name, const T& content) {
    return key(name).value(content);
  }

  /// A value that another writer made, of one line.
  JsonWriter& spliced(std::string_view document);

  /// Hands out what stands so far.
  void flush();
  /// Ends the document, with a line feed where it has several lines, and hands out what is left.
  void finish();

 private:
  JsonWriter& raw(std::string_view text);
  void separate();
  void open(char bracket);
  void close(char bracket);
  void flush_if_long();

  std::function<void(std::string_view)> sink_;
  Lines lines_;
  std::string buffer_;
  std::vector<bool> has_items_;  // a level of nesting
  bool after_key_ = false;
};

}  // namespace snug::command
