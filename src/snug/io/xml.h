#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace snug {

/// Walks over the elements of an XML text: 3MF and URDF need no more. Text between tags, comments and instructions are
/// passed over.
///
/// Guarantee: time and memory linear in the text.
/// Requires:  the text and the name outlive it, and all views it returns.
/// Errors:    InputError (unreadable) "name:line: ..." for what is not well-formed, and for a document type (<!DOCTYPE):
///            nothing is ever replaced but the five entities of XML and numbers of characters.
class XmlReader {
 public:
  XmlReader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  enum class Event : std::uint8_t { begin, end, done };  ///< of an element; of the document
  /// An empty element, <a/>, begins and ends.
  Event next();

  struct Attribute {
    std::string_view prefix, name, value;  ///< the value as it stands in the text
  };
  /// Of the element that has begun or ended.
  [[nodiscard]] std::string_view prefix() const { return prefix_of(element_); }
  [[nodiscard]] std::string_view element() const { return local_name_of(element_); }
  /// Of the element that has begun.
  [[nodiscard]] const std::vector<Attribute>& attributes() const { return attributes_; }
  /// The value of an attribute without a prefix, its entities replaced.
  [[nodiscard]] std::optional<std::string> text(std::string_view name) const;
  [[nodiscard]] std::string required_text(std::string_view name) const;
  /// The same as it stands, for numbers; empty if there is none.
  [[nodiscard]] std::string_view raw(std::string_view name) const;
  [[nodiscard]] double number(
      std::string_view name) const;  ///< fails if there is none, or none that is finite
  [[nodiscard]] std::uint64_t count(std::string_view name) const;  ///< a whole number from 0; likewise
  /// To the end of the element that has just begun.
  void skip();
  /// Calls `visit` for each child of the element that has just begun, up to its end; which goes to the end of the child.
  template <class Visit>
  void each_child(const Visit& visit) {
    while (next() == Event::begin) visit();
  }

  /// Of the tag that was read last, from 1 on.
  [[nodiscard]] std::size_t line() const;
  [[noreturn]] void fail(const std::string& message) const;

 private:
  static std::string_view prefix_of(std::string_view name);
  static std::string_view local_name_of(std::string_view name);
  [[nodiscard]] std::string decoded(std::string_view value) const;
  std::string_view take_name();
  void skip_blanks();
  void skip_past(std::string_view end, const char* what);
  void read_attributes();

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0, tag_ = 0;                 // places in the text: the next byte, the last tag
  mutable std::size_t counted_ = 0, lines_ = 1;  // lines up to a place
  std::string_view element_;
  std::vector<Attribute> attributes_;
  std::vector<std::string_view> open_;
  bool pending_end_ = false, any_ = false;
};

/// Numbers separated by blanks.
/// Errors:    as XmlReader::fail(), with the attribute's name, for another count or what is no finite number.
[[nodiscard]] std::vector<double> numbers_of(const XmlReader& at, std::string_view attribute,
                                             std::string_view text, std::size_t count);

}  // namespace snug
